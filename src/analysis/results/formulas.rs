//! Formulas that are reduced: their values, derivatives and ranges along the motion.

use super::loads::{Hidden, Loads};
use super::places::Places;
use super::quantity::{Computed, SmoothFormula, moved};
use super::smooth::Smooth;
use super::turn::Sampled;
use crate::analysis::state::State;
use crate::expr::{Dependence, ExprId, Graph, Node, Symbol, Unary};
use crate::ir::{ConstraintSystem, CoordinateKind};
use crate::math::between;
use crate::program::{Inputs, Program, Range, Ranges, Register, Registers, Stage};
use crate::tolerances::results::formulas::{MOVED, SAFETY, WAYS};
use crate::tolerances::results::loads::UNTOLD;
use std::rc::Rc;

/// A variation is known with two time derivatives.
const VARIED_ORDERS: u32 = 3;

/// A formula along the motion.
pub(super) struct Formula {
    program: Program,
    registers: Registers,
    /// Its value and time derivatives, as many as there are.
    roots: Vec<Register>,
    ranges: Ranges,
    /// What moves of all that it or its derivatives hold.
    moving: Vec<Moving>,
    /// What of it stands behind the coordinates of the system, of which there are so many.
    smooth: Smooth,
    coordinates: usize,
    has_jerk: bool,
    shape: Shape,
    holds_rates: bool,
    holds_forces: bool,
    /// Of one that holds forces, what it can be in the cell that is looked at, as its values tell.
    seen: [f64; 2],
    /// Of one that holds forces, the loads that these may come from, and what they may do in the cell that is looked at.
    loads: Loads,
    hidden: Hidden,
}

/// Of what shape a formula is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Shape {
    /// Nothing but what is smooth.
    Smooth,
    /// The length of something smooth, or a root of it, but for a factor that rests.
    Length,
    Other,
}

/// What changes with the motion.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Moving {
    /// A coordinate, or what moves as smoothly.
    Coordinate(usize),
    /// A variation of a coordinate.
    Varied {
        /// The variation's number.
        variation: u32,
        /// The coordinate's.
        index: usize,
    },
    /// The multiplier of a row, of which only the value is known.
    Multiplier(usize),
    /// How that changes, likewise.
    VariedMultiplier {
        /// The variation's number.
        variation: u32,
        /// The row's.
        row: usize,
    },
}

impl Moving {
    fn of(symbol: Symbol) -> Option<Moving> {
        match symbol {
            Symbol::Coordinate { index, .. } => Some(Moving::Coordinate(index as usize)),
            Symbol::Varied { index, variation, .. } => Some(Moving::Varied { variation, index: index as usize }),
            Symbol::Multiplier(row) => Some(Moving::Multiplier(row as usize)),
            Symbol::VariedMultiplier { row, variation } => {
                Some(Moving::VariedMultiplier { variation, row: row as usize })
            }
            _ => None,
        }
    }

    /// Whether it is a force, or how one changes: of these only the value is known.
    fn is_of_forces(self) -> bool {
        matches!(self, Moving::Multiplier(_) | Moving::VariedMultiplier { .. })
    }

    /// Where it and its time derivatives go, as many as there are.
    fn registers(self, inputs: &Inputs) -> [Option<Register>; 4] {
        match self {
            Moving::Coordinate(index) => inputs.coordinates.map(|first| Some(first + index as Register)),
            Moving::Multiplier(row) => [Some(inputs.multipliers + row as Register), None, None, None],
            Moving::VariedMultiplier { variation, row } => {
                [Some(inputs.varied_multipliers(variation) + row as Register), None, None, None]
            }
            Moving::Varied { variation, index } => [0, 1, 2, 3]
                .map(|order| (order < VARIED_ORDERS).then(|| inputs.varied(variation, order) + index as Register)),
        }
    }
}

/// A formula at a state.
pub(super) struct Point {
    pub state: State,
    /// What moves of it, each with three time derivatives; one that there is not is 0.
    moving: Vec<[f64; 4]>,
    /// The loads, of a formula that holds forces.
    loads: Vec<f64>,
    pub sample: Sampled,
}

/// What lies between two points.
#[derive(Clone)]
pub(super) struct Cell {
    pub a: Rc<Point>,
    pub b: Rc<Point>,
    /// By what moves of the formula: how far its second and third derivatives are from a straight line; of a multiplier, how far its
    /// value is. Behind these are the formula itself and the loads, of which that is the value too.
    bends: Rc<[[f64; 2]]>,
}

impl Cell {
    /// Its length (s).
    pub fn length(&self) -> f64 {
        self.b.state.t - self.a.state.t
    }

    /// The time in its middle (s).
    pub fn middle(&self) -> f64 {
        0.5 * self.a.state.t + 0.5 * self.b.state.t
    }

    /// Whether there is no time in it.
    pub fn is_empty(&self) -> bool {
        let middle = self.middle();
        middle <= self.a.state.t || middle >= self.b.state.t
    }

    /// Its two halves.
    pub fn halves(&self, formula: &Formula, middle: &Rc<Point>) -> [Cell; 2] {
        let bends = formula.bends([&self.a, middle, &self.b]);
        [
            Cell { a: Rc::clone(&self.a), b: Rc::clone(middle), bends: Rc::clone(&bends) },
            Cell { a: Rc::clone(middle), b: Rc::clone(&self.b), bends },
        ]
    }

    /// From one point to another, of which nothing between is known yet.
    pub fn unknown(formula: &Formula, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        let bends = vec![[f64::INFINITY; 2]; formula.moving.len() + 1 + formula.loads.count()].into();
        Cell { a: Rc::clone(a), b: Rc::clone(b), bends }
    }
}

impl Formula {
    /// A formula of a graph over the parameters, coordinates and variations of a system, whose loads stand in that graph too.
    pub fn new(
        graph: &mut Graph,
        value: ExprId,
        loads: &[ExprId],
        system: &ConstraintSystem,
        variations: usize,
    ) -> Formula {
        let has_jerk = system.jerk().is_some();
        let dependence = graph.dependence(value);
        let holds_forces = dependence.on(Dependence::FORCES);
        let holds_rates =
            dependence.highest_order() > Some(0) || dependence.highest_varied_order().is_some() || holds_forces;
        let loads = if holds_forces { loads } else { &[] };
        let (mut graph, found, smooth) = Smooth::out_of(graph, (value, loads), system);
        let shape = shape(&graph, found[0], system);
        let mut formulas = with_derivatives(&mut graph, found[0], has_jerk);
        let own = formulas.len();
        formulas.extend_from_slice(&found[1..]);
        let mut moving: Vec<Moving> = graph.symbols_of_all(&formulas).into_iter().filter_map(Moving::of).collect();
        moving.sort_unstable();
        moving.dedup();
        let coordinates = system.coordinates().len();
        let coordinates_and_more = coordinates + smooth.count();
        // as many places for them as there are coordinates, which are no fewer than the rows
        let multipliers = if system.forces().is_some() { coordinates_and_more } else { 0 };
        let counts = [system.params().len(), coordinates_and_more, variations, multipliers];
        let (program, mut roots) = Program::of_formulas(&graph, counts, &formulas);
        let params = system.values_of_params();
        let registers = program.start(&params);
        let loads = Loads::new(&program, &registers, &roots.split_off(own));
        Formula {
            ranges: Ranges::new(&program, &registers, &roots, Stage::Measures, false),
            program,
            registers,
            roots,
            moving,
            smooth,
            coordinates,
            has_jerk,
            shape,
            holds_rates,
            holds_forces,
            seen: [f64::NEG_INFINITY, f64::INFINITY],
            loads,
            hidden: Hidden::Nothing,
        }
    }

    /// How many time derivatives it has: 0 to 2.
    pub fn derivatives(&self) -> usize {
        self.roots.len() - 1
    }

    /// Whether it changes with the motion, and not with time alone.
    pub fn moves(&self) -> bool {
        !self.moving.is_empty()
    }

    /// Whether it holds derivatives of the coordinates.
    pub fn holds_rates(&self) -> bool {
        self.holds_rates
    }

    /// Whether it is nothing but what is smooth, or a length of that, with a slope: so that its extrema can be settled.
    pub fn settles(&self) -> bool {
        self.derivatives() > 0 && self.shape != Shape::Other
    }

    /// The same for variants side by side; none where it is anything else.
    pub fn into_quantity(self) -> Option<SmoothFormula> {
        if !self.settles() {
            return None;
        }
        let is_length = self.shape == Shape::Length;
        let (own, roots) = (Computed::new(self.program, self.registers, self.coordinates), self.roots);
        if self.smooth.count() == 0 {
            return Some(SmoothFormula::new(vec![own], roots, is_length));
        }
        let ((program, registers), towers) = self.smooth.into_towers();
        let own = own.behind(&towers, (self.coordinates, &roots))?;
        let smooth = Computed::new(program, registers, self.coordinates);
        Some(SmoothFormula::new(vec![smooth, own], roots, is_length))
    }

    /// At a state of the stretch that was entered.
    pub fn at(&mut self, state: State, places: &mut Places) -> Rc<Point> {
        if self.is_varied() {
            places.vary(&state);
        }
        if self.holds_forces {
            places.find_multipliers(&state);
        }
        self.smooth.look(&state, |_| 1.0);
        let tower = |moving: &Moving| match *moving {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.tower(k - self.coordinates),
            Moving::Coordinate(k) => [state.q[k], state.qd[k], state.qdd[k], state.qddd[k]],
            Moving::Varied { variation, index } => {
                let [place, first, second] = places.variation(variation, index);
                [place, first, second, 0.0]
            }
            Moving::Multiplier(row) => [places.multiplier(row), 0.0, 0.0, 0.0],
            Moving::VariedMultiplier { variation, row } => [places.varied_multiplier(variation, row), 0.0, 0.0, 0.0],
        };
        let moving: Vec<[f64; 4]> = self.moving.iter().map(tower).collect();
        self.run(state.t, &moving);
        let value = |order: usize| self.roots.get(order).map_or(f64::NAN, |&root| self.registers.get(root));
        let sample = Sampled { value: value(0), first: value(1), second: value(2) };
        let loads = self.loads_at(state.t, &moving);
        Rc::new(Point { state, moving, loads, sample })
    }

    /// The loads at a time (s), where the formula has just been computed.
    fn loads_at(&mut self, t: f64, moving: &[[f64; 4]]) -> Vec<f64> {
        if self.loads.count() == 0 {
            return Vec::new();
        }
        self.loads.set_times([t; 2]);
        for (of, values) in self.moving.iter().zip(moving) {
            for (register, value) in of.registers(&self.program.inputs).into_iter().zip(values) {
                if let Some(register) = register {
                    self.loads.set(register, [*value; 2]);
                }
            }
        }
        self.loads.values(&self.program, &self.registers)
    }

    /// Computes the formula and its derivatives at a time (s).
    fn run(&mut self, t: f64, moving: &[[f64; 4]]) {
        let inputs = self.program.inputs;
        self.registers.set(inputs.time, t);
        for (of, values) in self.moving.iter().zip(moving) {
            for (register, value) in of.registers(&inputs).into_iter().zip(values) {
                if let Some(register) = register {
                    self.registers.set(register, *value);
                }
            }
        }
        self.program.run(Stage::Measures, &mut self.registers);
    }

    /// How large the numbers are that the value is a sum of, or a difference: the unit of its rounding. Seen from a mount that is far away a
    /// length may be much smaller than what it is made of.
    pub fn weight(&mut self, point: &Point) -> f64 {
        let mut weight = point.sample.value.abs();
        for way in 0..WAYS {
            let moved = |k: usize| moved(k, way);
            self.smooth.look(&point.state, moved);
            let tower = |(moving, tower): (&Moving, &[f64; 4])| match *moving {
                Moving::Coordinate(k) if k >= self.coordinates => self.smooth.tower(k - self.coordinates),
                Moving::Coordinate(k)
                | Moving::Varied { index: k, .. }
                | Moving::Multiplier(k)
                | Moving::VariedMultiplier { row: k, .. } => tower.map(|value| value * moved(k)),
            };
            let moving: Vec<[f64; 4]> = self.moving.iter().zip(&point.moving).map(tower).collect();
            self.run(point.state.t, &moving);
            let change = (self.registers.get(self.roots[0]) - point.sample.value).abs();
            weight = weight.max(if change.is_finite() { change / MOVED } else { 0.0 });
        }
        weight
    }

    /// Of what moves and is never below zero: at which order it stands.
    fn order_of_square(&self, of: Moving) -> Option<usize> {
        match of {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.square(k - self.coordinates),
            _ => None,
        }
    }

    fn is_varied(&self) -> bool {
        self.moving.iter().any(|moving| matches!(moving, Moving::Varied { .. } | Moving::VariedMultiplier { .. }))
    }

    /// Begins to look at the ranges in a cell.
    pub fn look_at(&mut self, cell: &Cell) {
        let h = cell.length();
        let times = [cell.a.state.t, cell.b.state.t];
        self.ranges.set_times(times);
        self.loads.set_times(times);
        let (_, bends) = cell.bends.split_at(self.moving.len());
        self.seen = around(cell.a.sample.value, cell.b.sample.value, bends[0][0]);
        let ends = cell.a.moving.iter().zip(&cell.b.moving);
        for ((of, (a, b)), bends) in self.moving.iter().zip(ends).zip(cell.bends.iter()) {
            let registers = of.registers(&self.program.inputs);
            if of.is_of_forces() {
                registers.into_iter().flatten().for_each(|at| self.ranges.set(at, around(a[0], b[0], bends[0])));
                continue;
            }
            let third = around(a[3], b[3], bends[1]);
            let second = around(a[2], b[2], bends[0]);
            let first = between(a[1], b[1], second, h);
            let place = between(a[0], b[0], first, h);
            let mut ranges = [place, first, second, third];
            if let Some(order) = self.order_of_square(*of) {
                ranges[order][0] = ranges[order][0].max(0.0);
            }
            for (register, range) in registers.into_iter().zip(ranges) {
                if let Some(register) = register {
                    self.ranges.set(register, range);
                    self.loads.set(register, range);
                }
            }
        }
        let told = |k: usize| around(cell.a.loads[k], cell.b.loads[k], bends[1 + k][0]);
        self.hidden = self.loads.hidden(&self.program, &self.registers, told);
    }

    /// Whether a cell is too wide for anything to be known of what is smooth in it.
    pub fn turns_far(&self, cell: &Cell) -> bool {
        self.smooth.turns_far([&cell.a.state, &cell.b.state])
    }

    /// The range of the value (0) or of a derivative in the cell that is looked at; in order. Of forces only values are known, and so a
    /// formula that holds some narrows no faster than the cell; where it is resolved it goes on as its own values do.
    pub fn range(&mut self, order: usize) -> Range {
        let range = self.ranges.range(&self.program, &self.registers, order);
        if order > 0 || !self.holds_forces {
            return range;
        }
        let up_to = |most: f64| Range { low: -most, high: most, may_switch: true, is_resolved: false, ..range };
        let [low, high] = self.seen;
        match self.hidden {
            Hidden::Anything => up_to(f64::INFINITY),
            Hidden::Something => up_to(UNTOLD),
            Hidden::Nothing if range.is_resolved => {
                Range { low: range.low.max(low), high: range.high.min(high), ..range }
            }
            Hidden::Nothing => range,
        }
    }

    /// How far the last derivatives are from a straight line in the middle of three points.
    fn bends(&self, [a, middle, b]: [&Point; 3]) -> Rc<[[f64; 2]]> {
        let off = |of: &dyn Fn(&Point) -> f64| (of(middle) - 0.5 * of(a) - 0.5 * of(b)).abs();
        let of = |(k, moving): (usize, &Moving)| {
            let off = |order: usize| off(&|point: &Point| point.moving[k][order]);
            match moving {
                _ if moving.is_of_forces() => [off(0), 0.0],
                _ => [off(2), if self.has_jerk { off(3) } else { 0.0 }],
            }
        };
        let own = [off(&|point: &Point| point.sample.value), 0.0];
        let loads = (0..self.loads.count()).map(|k| [off(&|point: &Point| point.loads[k]), 0.0]);
        self.moving.iter().enumerate().map(of).chain([own]).chain(loads).collect()
    }
}

/// Of what shape a formula over coordinates of a system is, behind which further smooth ones stand.
fn shape(graph: &Graph, formula: ExprId, system: &ConstraintSystem) -> Shape {
    let moving = |id: ExprId| match graph.node(id) {
        Node::Symbol(Symbol::Coordinate { index, .. }) => Some(index as usize),
        _ => None,
    };
    let is_own = |k: &usize| *k < system.coordinates().len();
    let is_smooth = |k: usize| !is_own(&k) || system.coordinates()[k].kind != CoordinateKind::Argument;
    let length_if = |is_one: bool| if is_one { Shape::Length } else { Shape::Other };
    let of_factor = |other: ExprId| match shape(graph, other, system) {
        // a factor stands within what is smooth
        Shape::Smooth => Shape::Other,
        shape => shape,
    };
    let rests = |id: ExprId| graph.dependence(id).is_constant();
    match graph.node(formula) {
        _ if moving(formula).is_some_and(is_smooth) => Shape::Smooth,
        // its square is smooth, be it of a length or not
        Node::Unary(Unary::Sqrt, a) => length_if(moving(a).is_some_and(|k| !is_own(&k))),
        Node::Unary(Unary::Abs, a) => length_if(moving(a).is_some_and(is_smooth)),
        Node::Neg(a) => of_factor(a),
        Node::Mul(a, b) | Node::Div(b, a) if rests(a) => of_factor(b),
        Node::Mul(a, b) if rests(b) => of_factor(a),
        _ => Shape::Other,
    }
}

/// A formula and its time derivatives, as many as are known along the motion, two at most: none of one that holds forces.
fn with_derivatives(graph: &mut Graph, value: ExprId, has_jerk: bool) -> Vec<ExprId> {
    let mut formulas = vec![value];
    while formulas.len() < 3 {
        let last = formulas[formulas.len() - 1];
        let dependence = graph.dependence(last);
        let is_last = dependence.highest_order() == Some(3) || dependence.highest_varied_order() == Some(2);
        if is_last || dependence.on(Dependence::FORCES) {
            break;
        }
        let next = ConstraintSystem::time_derivatives(graph, &[last], 3)[0];
        if graph.dependence(next).highest_order() == Some(3) && !has_jerk {
            break;
        }
        formulas.push(next);
    }
    formulas
}

/// Both values and what lies between, and so much beyond.
fn around(a: f64, b: f64, bend: f64) -> [f64; 2] {
    let beyond = SAFETY * bend;
    [a.min(b) - beyond, a.max(b) + beyond]
}
