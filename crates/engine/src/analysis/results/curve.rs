//! A formula along the motion: its values and time derivatives at states, and what it can be between two of them.

use super::batch_evaluation::{Computed, SmoothFormula};
use super::extremum_refinement::Sampled;
use super::guards::{Crossing, Guard, GuardState, arguments, guards, slopes};
use super::loads::{Hidden, Loads};
use super::magnitudes::{Largest, Magnitudes};
use super::smooth_parts::Smooth;
use super::state_sampler::StateSampler;
use crate::analysis::state::State;
use crate::limits::curve::{KNOWN, NOTHING, ROUNDING};
use crate::limits::guards::NEAR;
use mechc_expr::math::{between, log10};
use mechc_expr::{Dependence, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::program::{Inputs, Op, Program, Range, Ranges, Register, Registers, Stage};
use mechc_ir::{ConstraintSystem, CoordinateKind};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Number of significant digits of a double.
const MOST_DIGITS: u32 = 17;
/// Largest amplification of the uncertainty of a load by a formula.
const MAX_AMPLIFICATION: f64 = 1e200;
/// Factor by which a second or third derivative may deviate from a straight line between two states, relative to the deviation that
/// follows from the lower derivative at both; a parabola has 1.5.
const SAFETY: f64 = 2.0;
/// Factor of the deviation in a part of a cell, which falls with the square of the part.
const LESS: f64 = 2.0;
/// The rounding of loads is computed once per this many evaluations of a formula.
const EVERY: usize = 16;
/// Error of velocities and accelerations on a bridge across a singular position, as a part of the largest values so far.
const ON_BRIDGE: f64 = 1e-8;

/// A variation is known with two time derivatives.
const VARIED_ORDERS: u32 = 3;

/// A formula along the motion.
pub(super) struct Curve {
    program: Program,
    registers: Registers,
    /// The registers of the formula and its known time derivatives; and the operations behind these and the loads.
    roots: Vec<Register>,
    operations: Vec<Op>,
    /// Ranges of the formula, of the loads behind it, of the arguments of guards with their slopes, and of the formula's time derivatives.
    ranges: Ranges,
    /// The number of the first time derivative among these.
    first: usize,
    guards: Vec<Guard>,
    /// The moving quantities in the formula and its derivatives.
    moving: Vec<Moving>,
    /// The smooth parts of the formula, which follow the `coordinates` coordinates of the system.
    smooth: Smooth,
    coordinates: usize,
    has_jerk: bool,
    shape: Shape,
    holds_rates: bool,
    holds_forces: bool,
    /// No cell is short that is longer than this (s).
    short: f64,
    /// The loads that the forces in the formula come from.
    loads: Loads,
    /// The magnitudes of the moving quantities, and those of the guards' arguments at the ends of steps.
    sizes: Magnitudes,
    largest_arguments: Vec<f64>,
    /// The number of evaluations.
    looks: usize,
}

/// The shape of a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Shape {
    /// A smooth formula.
    Smooth,
    /// The length of something smooth, or a root of it, but for a factor that rests.
    Length,
    Other,
}

/// A quantity that changes with the motion.
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
    /// The derivative of a multiplier in a variation, of which only the value is known.
    VariedMultiplier {
        /// The variation's number.
        variation: u32,
        /// The row's.
        row: usize,
    },
}

impl Moving {
    fn from_symbol(symbol: Symbol) -> Option<Moving> {
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

    /// Returns whether it is a force, or how one changes: of these only the value is known.
    fn is_of_forces(self) -> bool {
        matches!(self, Moving::Multiplier(_) | Moving::VariedMultiplier { .. })
    }

    /// Returns the registers of the quantity and its time derivatives, as far as they exist.
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
#[derive(Clone)]
pub(super) struct Point {
    pub state: State,
    /// The moving quantities of the formula, each with three time derivatives; an unknown one is 0.
    moving: Vec<[f64; 4]>,
    /// The loads, of a formula that holds forces.
    loads: Vec<f64>,
    /// The states of the guards.
    marks: Vec<GuardState>,
    /// True if it lies on the bridge over a singular position, where velocities and accelerations are those of a curve.
    is_on_bridge: bool,
    pub sample: Sampled,
    /// The difference (s) between the intended time and this one, and that of the values.
    pub shift: Shift,
    /// The error bound (s) of the time at which the guard crosses its threshold near this point.
    pub crossing_error: f64,
}

/// Errors that follow from an uncertain time.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
pub(super) struct Shift {
    /// In time (s).
    pub time: f64,
    pub value: f64,
}

impl Point {
    /// The side on which a guard is here.
    pub fn side(&self, guard: usize) -> f64 {
        self.marks[guard].side
    }

    /// The argument of a guard.
    pub fn argument(&self, guard: usize) -> f64 {
        self.marks[guard].argument
    }

    /// Returns whether the formula has a value here.
    pub fn exists(&self) -> bool {
        self.sample.value.is_finite()
    }
}

/// A number with an error bound.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Estimate {
    pub value: f64,
    pub error: f64,
}

impl Estimate {
    /// No value.
    pub const NOTHING: Estimate = Estimate { value: f64::NAN, error: f64::INFINITY };

    /// Returns the number of certain significant digits; 0 if the value cannot be told from zero.
    pub fn certain_digits(self) -> u32 {
        let part = self.error / self.value.abs();
        if part.is_nan() {
            return 0;
        }
        let digits = (-log10(2.0 * part)).floor();
        // between 0 and 17
        #[allow(clippy::cast_sign_loss)]
        let digits = digits.clamp(0.0, f64::from(MOST_DIGITS)) as u32;
        digits
    }
}

/// The interval between two points of a step of the motion.
#[derive(Clone)]
pub(super) struct Cell {
    /// The number of the step.
    pub step: usize,
    pub a: Rc<Point>,
    pub b: Rc<Point>,
    /// By what moves of the formula: how far its second and third derivatives are from a straight line; of a force, how far its value is. Behind
    /// these are the formula itself and the loads, of which that is the value too. `None` where nothing is known yet.
    bends: Option<Rc<[[f64; 2]]>>,
    /// The length (s) of the cell that this is known of, of which this one may be a part.
    bends_length: f64,
    /// The point in its middle, if it has been looked at.
    pub middle: Option<Rc<Point>>,
}

impl Cell {
    /// A cell from one point to another, without bounds of what lies between.
    pub fn new(step: usize, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        Cell { step, a: Rc::clone(a), b: Rc::clone(b), bends: None, bends_length: f64::INFINITY, middle: None }
    }

    /// Returns its length (s).
    pub fn length(&self) -> f64 {
        self.b.state.t - self.a.state.t
    }

    /// Returns the time in its middle (s).
    pub fn middle(&self) -> f64 {
        0.5 * self.a.state.t + 0.5 * self.b.state.t
    }

    /// Returns whether there is no time in it.
    pub fn is_empty(&self) -> bool {
        let middle = self.middle();
        middle <= self.a.state.t || middle >= self.b.state.t
    }

    /// Returns a cell from one point to another, with the bounds of this one.
    pub fn between(&self, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        Cell { bends: self.bends.clone(), bends_length: self.bends_length, ..Cell::new(self.step, a, b) }
    }

    /// Takes the point in its middle, which tells how far values that have no known derivative are from a straight line.
    pub fn take_middle(&mut self, curve: &Curve, middle: Rc<Point>) {
        self.bends = Some(curve.bends_at(self, &middle));
        self.middle = Some(middle);
    }

    /// Returns its parts on both sides of a point in it.
    pub fn cut(&self, curve: &Curve, at: &Rc<Point>) -> [Cell; 2] {
        let bends = Some(curve.bends_at(self, at));
        [(&self.a, at), (at, &self.b)].map(|(a, b)| Cell { bends: bends.clone(), ..self.between(a, b) })
    }
}

/// The classification of a formula in a cell.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Verdict {
    /// No guard crosses its threshold.
    Smooth,
    /// A guard, by its number, is on different sides at both ends.
    Crosses(usize),
    /// The formula has no value.
    Missing,
    /// Rounding alone decides on which side of its threshold a guard is.
    Rounding,
    /// Rounding alone decides on which side a guard is, but the formula has one value on either side.
    Alike,
    /// Too little is known; of a guard, by its number, whether it crosses, if there is one.
    Open(Option<usize>),
}

impl Curve {
    /// A formula of a graph over the parameters, coordinates and variations of a system, whose loads stand in that graph too.
    pub fn new(
        graph: &mut Graph,
        value: ExprId,
        loads: &[ExprId],
        system: &ConstraintSystem,
        variations: usize,
    ) -> Curve {
        let has_jerk = system.jerk().is_some();
        let dependence = graph.dependence(value);
        let holds_forces = dependence.on(Dependence::FORCES);
        let holds_rates =
            dependence.highest_order() > Some(0) || dependence.highest_varied_order().is_some() || holds_forces;
        let loads = if holds_forces { loads } else { &[] };
        let (mut graph, found, smooth) = Smooth::extract_from(graph, (value, loads), system);
        let shape = shape(&graph, found[0], system);
        let derivatives = with_derivatives(&mut graph, found[0], has_jerk);
        let local = derivatives.len();
        // ranges are asked for in this order: the formula, its loads, the arguments of guards with their slopes, and the derivatives
        let mut formulas = found.clone();
        let arguments = arguments(&mut graph, &found);
        let slopes = slopes(&mut graph, &arguments, |graph, id| is_known(graph, id, has_jerk));
        let mut witnesses = FxHashMap::default();
        for (&argument, slope) in arguments.iter().zip(slopes) {
            if let Some(slope) = slope {
                witnesses.insert(argument, [formulas.len(), formulas.len() + 1]);
                formulas.extend([argument, slope]);
            }
        }
        let first = formulas.len();
        formulas.extend_from_slice(&derivatives[1..]);
        let mut moving: Vec<Moving> =
            graph.symbols_of_all(&formulas).into_iter().filter_map(Moving::from_symbol).collect();
        moving.sort_unstable();
        moving.dedup();
        let coordinates = system.coordinates().len();
        let kind = |of: &Moving| match *of {
            Moving::Coordinate(k) => system.coordinates().get(k).map(|coordinate| coordinate.kind),
            _ => None,
        };
        let kinds = moving.iter().map(kind).collect();
        let coordinates_and_more = coordinates + smooth.count();
        // as many places for them as there are coordinates, which are no fewer than the rows
        let multipliers = if system.forces().is_some() { coordinates_and_more } else { 0 };
        let counts = [system.params().len(), coordinates_and_more, variations, multipliers];
        let (program, outputs, nodes) = Program::from_formulas_with_nodes(&graph, counts, &formulas);
        let params = system.param_values();
        let registers = program.start(&params);
        let values = &outputs[..found.len()];
        let guards = guards((&mut graph, &program), values, &nodes, &witnesses);
        let loads = Loads::new(&values[1..]);
        let roots: Vec<Register> =
            (0..local).map(|order| outputs[if order == 0 { 0 } else { first + order - 1 }]).collect();
        let operations = program.operations_behind(&[&roots[..], &values[1..]].concat(), Stage::Measures);
        Curve {
            sizes: Magnitudes::new(kinds),
            largest_arguments: vec![0.0; guards.len()],
            ranges: Ranges::new(&program, &registers, &outputs, Stage::Measures, false),
            program,
            registers,
            roots,
            operations,
            first,
            guards,
            moving,
            smooth,
            coordinates,
            has_jerk,
            shape,
            holds_rates,
            holds_forces,
            short: 0.0,
            loads,
            looks: 0,
        }
    }

    /// Sets the length (s) up to which cells count as short.
    pub fn set_short(&mut self, short: f64) {
        self.short = short;
    }

    /// Returns the number of time derivatives: 0 to 2.
    pub fn derivatives(&self) -> usize {
        self.roots.len() - 1
    }

    /// Returns whether it changes with the motion, and not with time alone.
    pub fn moves(&self) -> bool {
        !self.moving.is_empty()
    }

    /// Returns whether it holds derivatives of the coordinates.
    pub fn holds_rates(&self) -> bool {
        self.holds_rates
    }

    /// Returns whether it holds something of which one order alone is known, so that a cell has to be looked at in its middle.
    pub fn needs_middles(&self) -> bool {
        self.holds_forces || self.moving.iter().map(|of| self.orders(*of)).any(|[from, to]| from == to)
    }

    /// Returns whether it holds forces, of which only values are known.
    pub fn holds_forces(&self) -> bool {
        self.holds_forces
    }

    /// Returns whether it holds what has no bound where the equations are singular: forces, or derivatives by parameters.
    pub fn may_be_singular(&self) -> bool {
        self.holds_forces || self.is_varied()
    }

    /// Returns whether it is nothing but what is smooth, or a length of that, with a slope: so that its extrema can be settled.
    pub fn settles(&self) -> bool {
        self.derivatives() > 0 && self.shape != Shape::Other
    }

    /// Returns the formula for evaluation in batches, or `None` if it does not settle.
    pub fn into_quantity(self) -> Option<SmoothFormula> {
        if !self.settles() {
            return None;
        }
        let is_length = self.shape == Shape::Length;
        let (local, roots) = (Computed::new(self.program, self.registers, self.coordinates, &self.roots), self.roots);
        if self.smooth.count() == 0 {
            return Some(SmoothFormula::new(vec![local], roots, is_length));
        }
        let ((program, registers), towers) = self.smooth.into_towers();
        let local = local.behind(&towers, (self.coordinates, &roots))?;
        let requested: Vec<Register> = towers.iter().flatten().flatten().copied().collect();
        let smooth = Computed::new(program, registers, self.coordinates, &requested);
        Some(SmoothFormula::new(vec![smooth, local], roots, is_length))
    }

    /// Evaluates the formula at a state of the segment that was entered.
    pub fn at(&mut self, state: State, sampler: &mut StateSampler) -> Rc<Point> {
        let is_on_bridge = sampler.is_on_bridge(state.t);
        if self.is_varied() {
            sampler.vary(&state);
        }
        if self.holds_forces {
            sampler.find_multipliers(&state);
        }
        self.smooth.look(&state);
        let tower = |moving: &Moving| match *moving {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.tower(k - self.coordinates),
            Moving::Coordinate(k) => state.tower(k),
            Moving::Varied { variation, index } => {
                let [place, first, second] = sampler.variation(variation, index);
                [place, first, second, 0.0]
            }
            Moving::Multiplier(row) => [sampler.multiplier(row), 0.0, 0.0, 0.0],
            Moving::VariedMultiplier { variation, row } => [sampler.varied_multiplier(variation, row), 0.0, 0.0, 0.0],
        };
        let moving: Vec<[f64; 4]> = self.moving.iter().map(tower).collect();
        self.run(state.t, &moving);
        let value = |order: usize| self.roots.get(order).map_or(f64::NAN, |&root| self.registers.get(root));
        let sample = Sampled { value: value(0), first: value(1), second: value(2) };
        let marks: Vec<GuardState> = self.guards.iter().map(|guard| guard.mark(&self.registers)).collect();
        moving.iter().enumerate().for_each(|(k, tower)| self.sizes.note(k, tower));
        let loads = self.loads.values(&self.registers);
        if self.loads.count() > 0 && self.looks.is_multiple_of(EVERY) {
            self.set_point(&state, &moving, [0.0; 2]);
            self.loads.look_at_rounding((&self.program, &self.registers), &mut self.ranges);
        }
        self.looks += 1;
        Rc::new(Point {
            state,
            moving,
            loads,
            marks,
            is_on_bridge,
            sample,
            shift: Shift::default(),
            crossing_error: 0.0,
        })
    }

    /// Records how large the coordinates of the mechanism are.
    pub fn note_all(&mut self, of_all: Largest) {
        self.sizes.note_all(of_all);
        self.smooth.note_all(of_all);
    }

    /// Records how large arguments of guards are at a point that is like others: beside a pole they are not.
    pub fn note_arguments(&mut self, point: &Point) {
        for (largest, mark) in self.largest_arguments.iter_mut().zip(&point.marks) {
            if mark.argument.is_finite() {
                *largest = largest.max(mark.argument.abs());
            }
        }
    }

    /// Sets the ranges to what is at one state, and such parts of the largest beside it: of places, and of their derivatives.
    fn set_point(&mut self, state: &State, moving: &[[f64; 4]], parts: [f64; 2]) {
        self.ranges.release();
        let beside = if parts[0] > 0.0 { f64::EPSILON * state.t.abs() } else { 0.0 };
        self.ranges.set_times([state.t - beside, state.t + beside]);
        self.smooth.look_around(state, parts);
        let inputs = self.program.inputs;
        for (of, ranges) in self.moving.iter().zip(self.sizes.around(moving.iter().copied(), parts)) {
            let ranges = match *of {
                Moving::Coordinate(k) if k >= self.coordinates => self.smooth.ranges(k - self.coordinates),
                _ => ranges,
            };
            for (register, range) in of.registers(&inputs).into_iter().zip(ranges) {
                if let Some(register) = register {
                    self.ranges.set(register, range);
                }
            }
        }
    }

    /// Finds the ranges of all that the formula and its loads are made of at a point, by rounding.
    fn set_rounding(&mut self, point: &Point) {
        let of_rates = if point.is_on_bridge { ON_BRIDGE } else { ROUNDING };
        self.set_point(&point.state, &point.moving, [ROUNDING, of_rates]);
        self.ranges.range(&self.program, &self.registers, self.loads.count());
    }

    /// Returns a bound of the error of the value at a point.
    pub fn uncertainty(&mut self, point: &Point) -> f64 {
        self.set_rounding(point);
        for (guard, mark) in self.guards.iter().zip(&point.marks) {
            // the value is that of its own side
            if guard.crossing(&self.ranges, [*mark; 2]) != Crossing::Never {
                guard.hold(mark.side, &mut self.ranges);
            }
        }
        let Range { low, high, .. } = self.ranges.range(&self.program, &self.registers, 0);
        let error = 0.5 * (high - low) + point.shift.value;
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// Returns the value at a point, with its error bound.
    pub fn estimate(&mut self, point: &Point) -> Estimate {
        Estimate { value: point.sample.value, error: self.uncertainty(point) }
    }

    /// Returns whether rounding alone decides at a point on which side of its threshold a guard is.
    pub fn is_rounding(&mut self, guard: usize, point: &Point) -> bool {
        self.set_rounding(point);
        self.guards[guard].is_within_rounding(&self.ranges, point.marks[guard])
    }

    /// Returns whether rounding alone decides on which side of its threshold some guard is at a point.
    pub fn is_undecided(&mut self, point: &Point) -> bool {
        if self.guards.is_empty() {
            return false;
        }
        self.set_rounding(point);
        let mut guards = self.guards.iter().zip(&point.marks);
        guards.any(|(guard, mark)| guard.is_within_rounding(&self.ranges, *mark))
    }

    /// Returns a bound of the error of a guard's argument at a point.
    pub fn rounding_of_argument(&mut self, guard: usize, point: &Point) -> f64 {
        self.set_rounding(point);
        let [low, high] = self.guards[guard].argument(&self.ranges);
        0.5 * (high - low)
    }

    /// Returns whether the argument of a guard is known at a point, beside what it usually is.
    fn knows_argument(&mut self, guard: usize, point: &Point) -> bool {
        2.0 * self.rounding_of_argument(guard, point) <= NEAR * self.largest_arguments[guard]
    }

    /// Returns whether a guard of the formula is exactly at its threshold, and not so at another point beside: the formula may have a value of its own there.
    pub fn is_at_threshold(&self, point: &Point, beside: &Point) -> bool {
        let marks = point.marks.iter().zip(&beside.marks);
        self.guards
            .iter()
            .zip(marks)
            .any(|(guard, (mark, beside))| guard.is_at_threshold(*mark) && mark.differs_from(beside))
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
        self.program.run_operations(&self.operations, &mut self.registers);
    }

    /// Returns the order at which a quantity stands that is a square, and so never below zero.
    fn order_of_square(&self, of: Moving) -> Option<usize> {
        match of {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.square(k - self.coordinates),
            _ => None,
        }
    }

    fn is_varied(&self) -> bool {
        self.moving.iter().any(|moving| matches!(moving, Moving::Varied { .. } | Moving::VariedMultiplier { .. }))
    }

    /// Returns whether a cell is too wide for anything to be known of what is smooth in it.
    pub fn turns_far(&self, cell: &Cell) -> bool {
        self.smooth.turns_far([&cell.a.state, &cell.b.state])
    }

    /// Encloses the formula in a cell: what it can be there, and whether it is smooth, but for some guards.
    pub fn enclose(&mut self, cell: &mut Cell, ignored: &[usize]) -> (Verdict, Range) {
        (cell.bends, cell.bends_length) = (Some(self.bends_of(cell)), cell.length());
        self.set_cell(cell);
        let mut held = vec![false; self.guards.len()];
        for &guard in ignored {
            held[guard] = true;
        }
        loop {
            let range = self.value(cell, false);
            if range.low == f64::INFINITY {
                return (Verdict::Missing, range);
            }
            if !self.guards.is_empty() {
                self.ranges.find_live(&self.program, 0);
            }
            let exists = cell.a.exists() || cell.b.exists();
            let (mut verdict, mut monotone) = (Verdict::Smooth, Vec::new());
            for (k, held) in held.iter_mut().enumerate() {
                // a load decides what a force is, although the formula does not hold it
                if *held || !(self.holds_forces || self.guards[k].is_live(&self.ranges)) {
                    continue;
                }
                let marks = [&cell.a, &cell.b].map(|point| point.marks[k]);
                match self.guards[k].crossing(&self.ranges, marks) {
                    // and so nothing is known of what is made of it
                    Crossing::Never if !exists && self.guards[k].is_beyond_end(marks[0]) => {
                        return (Verdict::Missing, range);
                    }
                    Crossing::Never => {}
                    Crossing::Sure => return (Verdict::Crosses(k), range),
                    Crossing::Possible if self.is_monotone(k) => {
                        *held = true;
                        monotone.push((k, marks[0].side));
                    }
                    Crossing::Possible => verdict = Verdict::Open(Some(k)),
                }
            }
            if monotone.is_empty() {
                return match verdict {
                    Verdict::Smooth if exists => (verdict, self.value(cell, true)),
                    Verdict::Smooth => (Verdict::Missing, range),
                    _ => (verdict, range),
                };
            }
            // what follows from these guards is decided anew
            for (k, side) in monotone {
                self.guards[k].hold(side, &mut self.ranges);
            }
        }
    }

    /// Returns whether the argument of a guard rises or falls all the way through the cell.
    fn is_monotone(&mut self, guard: usize) -> bool {
        let Some([argument, slope]) = self.guards[guard].witness else { return false };
        let argument = self.ranges.range(&self.program, &self.registers, argument);
        let slope = self.ranges.range(&self.program, &self.registers, slope);
        !argument.may_switch && !slope.may_switch && (slope.low >= 0.0 || slope.high <= 0.0)
    }

    /// The range of the value in the cell that was set. Of forces only values are known, and so a formula that holds some narrows no faster than
    /// the cell; where it is resolved, and no guard crosses, it goes on as its own values do.
    fn value(&mut self, cell: &Cell, is_smooth: bool) -> Range {
        let Curve { ranges, program, registers, loads, .. } = self;
        let range = ranges.range(program, registers, 0);
        let is_resolved = range.is_resolved && is_smooth;
        let Some(bends) = cell.bends.as_ref().map(|bends| &bends[self.moving.len()..]) else { return range };
        let by_values = || {
            let [low, high] = around(cell.a.sample.value, cell.b.sample.value, bends[0][0]);
            Range { low: range.low.max(low), high: range.high.min(high), ..range }
        };
        if !self.holds_forces {
            // over short cells terms that cancel each other leave intervals that are much too wide
            let is_short = cell.length() <= self.short && cell.a.exists() && cell.b.exists();
            return if is_short && is_resolved { by_values() } else { range };
        }
        let bounds = |k: usize| around(cell.a.loads[k], cell.b.loads[k], bends[1 + k][0]);
        let up_to = |most: f64| Range { low: -most, high: most, is_resolved: false, ..range };
        match loads.hidden((program, registers), ranges, bounds) {
            Hidden::Unbounded => up_to(f64::INFINITY),
            Hidden::AtMost(beyond) => up_to(f64::min(MAX_AMPLIFICATION * beyond, f64::MAX)),
            Hidden::Nothing if is_resolved => by_values(),
            Hidden::Nothing => range,
        }
    }

    /// Returns the range of a time derivative (1 or 2) in the cell that was enclosed last.
    pub fn derivative(&mut self, order: usize) -> Range {
        self.ranges.range(&self.program, &self.registers, self.first + order - 1)
    }

    /// Sets the ranges to what may be in a cell.
    fn set_cell(&mut self, cell: &Cell) {
        let h = cell.length();
        self.ranges.release();
        self.ranges.set_times([cell.a.state.t, cell.b.state.t]);
        let Some(bends) = &cell.bends else { return };
        let ends = cell.a.moving.iter().zip(&cell.b.moving);
        for ((of, (a, b)), bends) in self.moving.iter().zip(ends).zip(bends.iter()) {
            let registers = of.registers(&self.program.inputs);
            if of.is_of_forces() {
                registers.into_iter().flatten().for_each(|at| self.ranges.set(at, around(a[0], b[0], bends[0])));
                continue;
            }
            let third = around(a[3], b[3], bends[1]);
            let second = around(a[2], b[2], bends[0]);
            let first = between(a[1], b[1], second, h);
            let mut ranges = [between(a[0], b[0], first, h), first, second, third];
            if let Some(order) = self.order_of_square(*of) {
                ranges[order][0] = ranges[order][0].max(0.0);
            }
            for (register, range) in registers.into_iter().zip(ranges) {
                if let Some(register) = register {
                    self.ranges.set(register, range);
                }
            }
        }
    }

    /// Returns the first and the last known order of a moving quantity.
    fn orders(&self, of: Moving) -> [usize; 2] {
        match of {
            Moving::Coordinate(k) => {
                let first = if k >= self.coordinates { self.smooth.order(k - self.coordinates) } else { 0 };
                [first, if self.has_jerk { 3 } else { 2 }]
            }
            Moving::Varied { .. } => [0, 2],
            Moving::Multiplier(_) | Moving::VariedMultiplier { .. } => [0, 0],
        }
    }

    /// How far second and third derivatives in a cell are from a straight line, as far as the derivatives before them at both ends tell.
    fn bends_of(&self, cell: &Cell) -> Rc<[[f64; 2]]> {
        let h = cell.length();
        let known = |k: usize| cell.bends.as_ref().map_or([f64::INFINITY; 2], |bends| bends[k]);
        // over very short cells differences are rounding, and what is known of the longer one becomes less with the square of the length
        let part = h / cell.bends_length;
        let less = f64::min(LESS * part * part, 1.0);
        let of = |(k, of): (usize, &Moving)| {
            let (a, b) = (&cell.a.moving[k], &cell.b.moving[k]);
            let error = |order: usize| ((b[order - 1] - a[order - 1]) / h - 0.5 * (a[order] + b[order])).abs();
            let bends = match self.orders(*of) {
                [from, to] if from == to => return known(k),
                [2, _] => [h * (0.125 * (b[3] - a[3]).abs() + error(3)), 2.0 * error(3)],
                [_, 3] => [error(2) + h * (0.125 * (b[3] - a[3]).abs() + error(3)), 2.0 * error(3)],
                _ => [2.0 * error(2), 0.0],
            };
            [0, 1].map(|order| f64::min(bends[order], if less > 0.0 { less * known(k)[order] } else { f64::INFINITY }))
        };
        let values = (self.moving.len()..self.moving.len() + 1 + self.loads.count()).map(known);
        self.moving.iter().enumerate().map(of).chain(values).collect()
    }

    /// The bends of both parts of a cell that is cut at a point, with those of which only one order is known as they are there.
    fn bends_at(&self, cell: &Cell, at: &Point) -> Rc<[[f64; 2]]> {
        let (a, b) = (&*cell.a, &*cell.b);
        let x = (at.state.t - a.state.t) / (b.state.t - a.state.t);
        let error = |of: &dyn Fn(&Point) -> f64| (of(at) - (1.0 - x) * of(a) - x * of(b)).abs();
        let of_moving = |(k, of): (usize, &Moving)| match self.orders(*of) {
            [order, to] if order == to => [error(&|point: &Point| point.moving[k][order]); 2],
            _ => cell.bends.as_ref().map_or([f64::INFINITY; 2], |bends| bends[k]),
        };
        let local = [error(&|point: &Point| point.sample.value); 2];
        let of_loads = (0..self.loads.count()).map(|k| [error(&|point: &Point| point.loads[k]); 2]);
        self.moving.iter().enumerate().map(of_moving).chain([local]).chain(of_loads).collect()
    }

    /// Returns the distances of a guard's argument from the threshold between two points.
    pub fn distances(&self, guard: usize, [a, b]: [&Point; 2]) -> [f64; 2] {
        self.guards[guard].distances([a.marks[guard], b.marks[guard]], &self.registers)
    }

    /// The values where an argument of a function that is not smooth somewhere is just there, between two points beside each other or at one
    /// where rounding alone tells it from that, as far as they are known.
    pub fn between_points(&mut self, a: &Point, b: &Point) -> Vec<f64> {
        if !(a.exists() || b.exists()) {
            return Vec::new();
        }
        let there = if a.exists() { a } else { b };
        let mut found = Vec::new();
        for k in 0..self.guards.len() {
            let usual = self.largest_arguments[k];
            let between = self.guards[k].value_between([a.marks[k], b.marks[k]], usual).map(|value| (there, value));
            let touched = || {
                [a, b].into_iter().filter(|point| point.exists()).find_map(|point| {
                    let value = self.guards[k].value_near(point.marks[k], usual)?;
                    self.is_rounding(k, point).then_some((point, value))
                })
            };
            let Some((point, value)) = between.or_else(touched) else { continue };
            if !self.knows_argument(k, point) {
                continue;
            }
            self.set_point(&point.state, &point.moving, [0.0; 2]);
            self.guards[k].hold_at(value, &mut self.ranges);
            let Range { low, high, .. } = self.ranges.range(&self.program, &self.registers, 0);
            let is_finite = low.is_finite() && high.is_finite();
            if is_finite && high - low <= KNOWN * f64::max(low.abs(), high.abs()) + NOTHING {
                found.push(if low <= 0.0 && high >= 0.0 { 0.0 } else { 0.5 * low + 0.5 * high });
            }
        }
        found
    }
}

/// Returns whether all that a formula holds is known along the motion.
fn is_known(graph: &Graph, formula: ExprId, has_jerk: bool) -> bool {
    let dependence = graph.dependence(formula);
    !dependence.on(Dependence::FORCES) && (has_jerk || dependence.highest_order() != Some(3))
}

/// Returns the shape of a formula over the coordinates of a system and further smooth ones.
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
        if is_last || !is_known(graph, last, has_jerk) {
            break;
        }
        let next = ConstraintSystem::time_derivatives(graph, &[last], 3)[0];
        if !is_known(graph, next, has_jerk) {
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
