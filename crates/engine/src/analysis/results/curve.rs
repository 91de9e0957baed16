//! A formula along the motion: its values, time derivatives and rounding at states. `enclosure` bounds it between two states.

mod enclosure;

use super::batch_evaluation::{Computed, SmoothFormula};
use super::extremum_refinement::Sampled;
use super::guards::{Crossing, Guard, GuardState, arguments, guards, slopes};
use super::loads::Loads;
use super::magnitudes::{Largest, Magnitudes};
use super::smooth_parts::Smooth;
use super::state_sampler::StateSampler;
use crate::analysis::state::State;
use crate::limits::curve::{KNOWN, NOTHING, ROUNDING};
use crate::limits::guards::NEAR;
pub(super) use enclosure::{Cell, Verdict};
use mechc_expr::math::log10;
use mechc_expr::{Dependence, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::program::{Inputs, Op, Program, Range, Ranges, Register, Registers, Stage};
use mechc_ir::{ConstraintSystem, CoordinateKind};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Number of significant digits of a double.
const MOST_DIGITS: u32 = 17;
/// The rounding of loads is computed once per this many evaluations of a formula.
const EVERY: usize = 16;
/// Error of velocities and accelerations on a bridge across a singular position, as a part of the largest values so far.
const ON_BRIDGE: f64 = 1e-8;

/// Number of orders of a variation: its value and two time derivatives.
const VARIED_ORDERS: u32 = 3;

/// A formula along the motion.
pub(super) struct Curve {
    program: Program,
    registers: Registers,
    /// The registers of the formula and its available time derivatives.
    roots: Vec<Register>,
    /// The operations that compute these and the loads.
    operations: Vec<Op>,
    /// Ranges of the formula, its loads, the arguments of guards with their slopes, and the formula's time derivatives, in this order.
    ranges: Ranges,
    /// The index of the first time derivative in `ranges`.
    first: usize,
    guards: Vec<Guard>,
    /// The moving quantities in the formula and its derivatives.
    moving: Vec<Moving>,
    /// The smooth parts of the formula, numbered from `coordinates` on: the number of coordinates of the system.
    smooth: Smooth,
    coordinates: usize,
    has_jerk: bool,
    shape: Shape,
    /// True if the formula contains time derivatives or variations of the coordinates, or forces.
    pub holds_rates: bool,
    /// True if the formula contains forces, which have no time derivatives.
    pub holds_forces: bool,
    /// The maximum length (s) of a short cell.
    pub short: f64,
    /// The loads that the forces in the formula come from.
    loads: Loads,
    /// The magnitudes of the moving quantities.
    sizes: Magnitudes,
    /// The largest magnitude of each guard's argument at the ends of steps.
    largest_arguments: Vec<f64>,
    evaluations: usize,
}

/// The shape of a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Shape {
    /// A smooth formula.
    Smooth,
    /// The absolute value or square root of a smooth formula, times a constant.
    Length,
    Other,
}

/// A quantity that changes with the motion.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Moving {
    /// A coordinate of the system, or a smooth part.
    Coordinate(usize),
    /// A variation of a coordinate.
    Varied {
        /// The number of the variation.
        variation: u32,
        /// The number of the coordinate.
        index: usize,
    },
    /// The multiplier of a row; it has no time derivatives.
    Multiplier(usize),
    /// The derivative of a multiplier in a variation; it has no time derivatives.
    VariedMultiplier {
        /// The number of the variation.
        variation: u32,
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

    /// Returns whether the quantity is a force or the variation of one: it has no time derivatives.
    fn is_of_forces(self) -> bool {
        matches!(self, Moving::Multiplier(_) | Moving::VariedMultiplier { .. })
    }

    /// Returns the registers of the quantity and its existing time derivatives, with their orders.
    fn registers(self, inputs: &Inputs) -> impl Iterator<Item = (usize, Register)> + use<> {
        let registers = match self {
            Moving::Coordinate(index) => inputs.coordinates.map(|first| Some(first + index as Register)),
            Moving::Multiplier(row) => [Some(inputs.multipliers + row as Register), None, None, None],
            Moving::VariedMultiplier { variation, row } => {
                [Some(inputs.varied_multipliers(variation) + row as Register), None, None, None]
            }
            Moving::Varied { variation, index } => [0, 1, 2, 3]
                .map(|order| (order < VARIED_ORDERS).then(|| inputs.varied(variation, order) + index as Register)),
        };
        registers.into_iter().enumerate().filter_map(|(order, register)| Some((order, register?)))
    }
}

/// A formula at a state.
#[derive(Clone)]
pub(super) struct Point {
    pub state: State,
    /// The moving quantities of the formula, each with three time derivatives; an unavailable one is 0.
    moving: Vec<[f64; 4]>,
    /// The loads, if the formula contains forces.
    loads: Vec<f64>,
    /// The states of the guards.
    guard_states: Vec<GuardState>,
    /// True if the point lies on the bridge over a singular position, whose velocities and accelerations are those of a fitted curve.
    is_on_bridge: bool,
    pub sample: Sampled,
    /// The errors that follow from the uncertainty of the point's time.
    pub shift: Shift,
    /// The error bound (s) of the time at which the guard crosses its threshold near this point.
    pub crossing_error: f64,
}

/// Errors that follow from an uncertain time, in time and in value.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
pub(super) struct Shift {
    /// The difference (s) between the intended time and that of the point.
    pub time: f64,
    pub value: f64,
}

impl Point {
    /// Returns the side of its threshold on which a guard is at the point.
    pub fn side(&self, guard: usize) -> f64 {
        self.guard_states[guard].side
    }

    /// Returns the argument of a guard at the point.
    pub fn argument(&self, guard: usize) -> f64 {
        self.guard_states[guard].argument
    }

    /// Returns whether the formula has a value at the point.
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

    /// Returns the number of certain significant digits; 0 if the value cannot be distinguished from zero.
    pub fn certain_digits(self) -> u32 {
        let part = self.error / self.value.abs();
        if part.is_nan() {
            return 0;
        }
        let digits = (-log10(2.0 * part)).floor();
        // the number lies between 0 and 17
        #[allow(clippy::cast_sign_loss)]
        let digits = digits.clamp(0.0, f64::from(MOST_DIGITS)) as u32;
        digits
    }
}

impl Curve {
    /// Compiles a formula of a graph over the parameters, coordinates and `variations` variations of a system. `loads` are the system's loads
    /// in the same graph.
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
        let (mut graph, extracted, smooth) = Smooth::extract_from(graph, value, loads, system);
        let shape = shape(&graph, extracted[0], system);
        let derivatives = with_derivatives(&mut graph, extracted[0], has_jerk);
        let local = derivatives.len();
        // `ranges` numbers formulas in this order: the formula, its loads, the arguments of guards with their slopes, and the derivatives
        let mut formulas = extracted.clone();
        let arguments = arguments(&mut graph, &extracted);
        let slopes = slopes(&mut graph, &arguments, |graph, id| is_available(graph, id, has_jerk));
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
        // a multiplier per coordinate is enough: there are no fewer coordinates than rows
        let multipliers = if system.forces().is_some() { coordinates_and_more } else { 0 };
        let counts = [system.params().len(), coordinates_and_more, variations, multipliers];
        let (program, outputs, nodes) = Program::from_formulas_with_nodes(&graph, counts, &formulas);
        let params = system.param_values();
        let registers = program.start(&params);
        let values = &outputs[..extracted.len()];
        let guards = guards(&mut graph, &program, values, &nodes, &witnesses);
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
            evaluations: 0,
        }
    }

    /// Returns the number of available time derivatives: 0 to 2.
    pub fn derivatives(&self) -> usize {
        self.roots.len() - 1
    }

    /// Returns whether the formula depends on the motion, and not on time alone.
    pub fn moves(&self) -> bool {
        !self.moving.is_empty()
    }

    /// Returns whether a moving quantity has a single available order, so that its bounds in a cell need the point in the middle.
    pub fn needs_middles(&self) -> bool {
        self.holds_forces || self.moving.iter().map(|of| self.orders(*of)).any(|[from, to]| from == to)
    }

    /// Returns whether the formula may grow without bound towards a singular position: it contains forces or derivatives by parameters.
    pub fn may_be_singular(&self) -> bool {
        self.holds_forces || self.is_varied()
    }

    /// Returns whether the formula is smooth, or the length of something smooth, with an available slope: its extrema can be refined on a grid.
    pub fn settles(&self) -> bool {
        self.derivatives() > 0 && self.shape != Shape::Other
    }

    /// Returns the formula for evaluation in batches, or `None` unless [`Curve::settles`].
    pub fn into_smooth_formula(self) -> Option<SmoothFormula> {
        if !self.settles() {
            return None;
        }
        let is_length = self.shape == Shape::Length;
        let (local, roots) = (Computed::new(self.program, self.registers, self.coordinates, &self.roots), self.roots);
        if self.smooth.count() == 0 {
            return Some(SmoothFormula::new(vec![local], roots, is_length));
        }
        let (program, registers, towers) = self.smooth.into_towers();
        let local = local.behind(&towers, self.coordinates, &roots)?;
        let requested: Vec<Register> = towers.iter().flatten().flatten().copied().collect();
        let smooth = Computed::new(program, registers, self.coordinates, &requested);
        Some(SmoothFormula::new(vec![smooth, local], roots, is_length))
    }

    /// Evaluates the formula at a state of the segment that the sampler has entered.
    pub fn at(&mut self, state: State, sampler: &mut StateSampler) -> Rc<Point> {
        let is_on_bridge = sampler.is_on_bridge(state.t);
        if self.is_varied() {
            sampler.vary(&state);
        }
        if self.holds_forces {
            sampler.find_multipliers(&state);
        }
        self.smooth.evaluate(&state);
        let tower = |moving: &Moving| match *moving {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.tower(k - self.coordinates),
            Moving::Coordinate(k) => state.tower(k),
            Moving::Varied { variation, index } => {
                let [value, first, second] = sampler.variation(variation, index);
                [value, first, second, 0.0]
            }
            Moving::Multiplier(row) => [sampler.multiplier(row), 0.0, 0.0, 0.0],
            Moving::VariedMultiplier { variation, row } => [sampler.varied_multiplier(variation, row), 0.0, 0.0, 0.0],
        };
        let moving: Vec<[f64; 4]> = self.moving.iter().map(tower).collect();
        self.run(state.t, &moving);
        let value = |order: usize| self.roots.get(order).map_or(f64::NAN, |&root| self.registers.get(root));
        let sample = Sampled { value: value(0), first: value(1), second: value(2) };
        let guard_states: Vec<GuardState> = self.guards.iter().map(|guard| guard.state(&self.registers)).collect();
        moving.iter().enumerate().for_each(|(k, tower)| self.sizes.note(k, tower));
        let loads = self.loads.values(&self.registers);
        if self.loads.count() > 0 && self.evaluations.is_multiple_of(EVERY) {
            self.set_point(&state, &moving, [0.0; 2]);
            self.loads.record_rounding(&self.program, &self.registers, &mut self.ranges);
        }
        self.evaluations += 1;
        Rc::new(Point {
            state,
            moving,
            loads,
            guard_states,
            is_on_bridge,
            sample,
            shift: Shift::default(),
            crossing_error: 0.0,
        })
    }

    /// Records the largest magnitudes of the mechanism's coordinates.
    pub fn note_all(&mut self, of_all: Largest) {
        self.sizes.note_all(of_all);
        self.smooth.note_all(of_all);
    }

    /// Records the magnitudes of the guards' arguments at a typical point: near a pole they are not typical.
    pub fn note_arguments(&mut self, point: &Point) {
        for (largest, state) in self.largest_arguments.iter_mut().zip(&point.guard_states) {
            if state.argument.is_finite() {
                *largest = largest.max(state.argument.abs());
            }
        }
    }

    /// Sets the ranges around one state. `parts` are the margins of values and of their time derivatives, as parts of the largest magnitudes.
    fn set_point(&mut self, state: &State, moving: &[[f64; 4]], parts: [f64; 2]) {
        self.ranges.release();
        let margin = if parts[0] > 0.0 { f64::EPSILON * state.t.abs() } else { 0.0 };
        self.ranges.set_times([state.t - margin, state.t + margin]);
        self.smooth.find_ranges(state, parts);
        let inputs = self.program.inputs;
        for (of, ranges) in self.moving.iter().zip(self.sizes.around(moving.iter().copied(), parts)) {
            let ranges = match *of {
                Moving::Coordinate(k) if k >= self.coordinates => self.smooth.ranges(k - self.coordinates),
                _ => ranges,
            };
            of.registers(&inputs).for_each(|(order, register)| self.ranges.set(register, ranges[order]));
        }
    }

    /// Computes the ranges of the formula, its loads and all their terms at a point, as far as rounding may change them.
    fn set_rounding(&mut self, point: &Point) {
        let of_rates = if point.is_on_bridge { ON_BRIDGE } else { ROUNDING };
        self.set_point(&point.state, &point.moving, [ROUNDING, of_rates]);
        self.ranges.range(&self.program, &self.registers, self.loads.count());
    }

    /// Returns a bound of the error of the value at a point.
    pub fn uncertainty(&mut self, point: &Point) -> f64 {
        self.set_rounding(point);
        for (guard, state) in self.guards.iter().zip(&point.guard_states) {
            // the value belongs to the side of the point
            if guard.crossing(&self.ranges, [*state; 2]) != Crossing::Never {
                guard.hold(state.side, &mut self.ranges);
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

    /// Returns whether rounding alone decides on which side of its threshold a guard is at a point.
    pub fn is_rounding(&mut self, guard: usize, point: &Point) -> bool {
        self.set_rounding(point);
        self.guards[guard].is_within_rounding(&self.ranges, point.guard_states[guard])
    }

    /// Returns whether rounding alone decides on which side of its threshold some guard is at a point.
    pub fn is_undecided(&mut self, point: &Point) -> bool {
        if self.guards.is_empty() {
            return false;
        }
        self.set_rounding(point);
        let mut guards = self.guards.iter().zip(&point.guard_states);
        guards.any(|(guard, state)| guard.is_within_rounding(&self.ranges, *state))
    }

    /// Returns a bound of the error of a guard's argument at a point.
    pub fn rounding_of_argument(&mut self, guard: usize, point: &Point) -> f64 {
        self.set_rounding(point);
        let [low, high] = self.guards[guard].argument(&self.ranges);
        0.5 * (high - low)
    }

    /// Returns whether the rounding of a guard's argument at a point is small, relative to its largest magnitude.
    fn resolves_argument(&mut self, guard: usize, point: &Point) -> bool {
        2.0 * self.rounding_of_argument(guard, point) <= NEAR * self.largest_arguments[guard]
    }

    /// Returns whether a guard is exactly at its threshold at a point, but not at an adjacent one: the value may be that of neither side.
    pub fn is_at_threshold(&self, point: &Point, adjacent: &Point) -> bool {
        let states = point.guard_states.iter().zip(&adjacent.guard_states);
        self.guards
            .iter()
            .zip(states)
            .any(|(guard, (state, adjacent))| guard.is_at_threshold(*state) && state.differs_from(adjacent))
    }

    /// Computes the formula and its derivatives from the moving quantities at a time (s).
    fn run(&mut self, t: f64, moving: &[[f64; 4]]) {
        let inputs = self.program.inputs;
        self.registers.set(inputs.time, t);
        for (of, values) in self.moving.iter().zip(moving) {
            of.registers(&inputs).for_each(|(order, register)| self.registers.set(register, values[order]));
        }
        self.program.run_operations(&self.operations, &mut self.registers);
    }

    /// Returns whether the formula contains derivatives by parameters.
    fn is_varied(&self) -> bool {
        self.moving.iter().any(|moving| matches!(moving, Moving::Varied { .. } | Moving::VariedMultiplier { .. }))
    }

    /// Returns the first and the last available order of a moving quantity.
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

    /// Returns the distances of a guard's argument at two points from the threshold between them.
    pub fn distances(&self, guard: usize, [a, b]: [&Point; 2]) -> [f64; 2] {
        self.guards[guard].distances([a.guard_states[guard], b.guard_states[guard]], &self.registers)
    }

    /// Returns the resolved values of the formula where the argument of a function is exactly at a point at which the function is not smooth:
    /// between two adjacent points, or at one of them if rounding alone separates the argument from there.
    pub fn between_points(&mut self, a: &Point, b: &Point) -> Vec<f64> {
        if !(a.exists() || b.exists()) {
            return Vec::new();
        }
        let there = if a.exists() { a } else { b };
        let mut values = Vec::new();
        for k in 0..self.guards.len() {
            let usual = self.largest_arguments[k];
            let between =
                self.guards[k].value_between([a.guard_states[k], b.guard_states[k]], usual).map(|value| (there, value));
            let touched = || {
                [a, b].into_iter().filter(|point| point.exists()).find_map(|point| {
                    let value = self.guards[k].value_near(point.guard_states[k], usual)?;
                    self.is_rounding(k, point).then_some((point, value))
                })
            };
            let Some((point, value)) = between.or_else(touched) else { continue };
            if !self.resolves_argument(k, point) {
                continue;
            }
            self.set_point(&point.state, &point.moving, [0.0; 2]);
            self.guards[k].hold_at(value, &mut self.ranges);
            let Range { low, high, .. } = self.ranges.range(&self.program, &self.registers, 0);
            let is_finite = low.is_finite() && high.is_finite();
            if is_finite && high - low <= KNOWN * f64::max(low.abs(), high.abs()) + NOTHING {
                values.push(if low <= 0.0 && high >= 0.0 { 0.0 } else { 0.5 * low + 0.5 * high });
            }
        }
        values
    }
}

/// Returns whether every quantity in a formula is available between states of the motion: forces are not, and jerks only if solved for.
fn is_available(graph: &Graph, formula: ExprId, has_jerk: bool) -> bool {
    let dependence = graph.dependence(formula);
    !dependence.on(Dependence::FORCES) && (has_jerk || dependence.highest_order() != Some(3))
}

/// Returns the shape of a formula over the coordinates of a system and the smooth parts numbered after them.
fn shape(graph: &Graph, formula: ExprId, system: &ConstraintSystem) -> Shape {
    let moving = |id: ExprId| match graph.node(id) {
        Node::Symbol(Symbol::Coordinate { index, .. }) => Some(index as usize),
        _ => None,
    };
    let is_coordinate = |k: usize| k < system.coordinates().len();
    let is_smooth = |k: usize| !is_coordinate(k) || system.coordinates()[k].kind != CoordinateKind::Argument;
    let length_if = |is_one: bool| if is_one { Shape::Length } else { Shape::Other };
    let of_factor = |other: ExprId| match shape(graph, other, system) {
        // a multiple of a smooth formula would itself be a smooth part
        Shape::Smooth => Shape::Other,
        shape => shape,
    };
    let rests = |id: ExprId| graph.dependence(id).is_constant();
    match graph.node(formula) {
        _ if moving(formula).is_some_and(is_smooth) => Shape::Smooth,
        // the radicand is a smooth part, whether or not it is the square of a length
        Node::Unary(Unary::Sqrt, a) => length_if(moving(a).is_some_and(|k| !is_coordinate(k))),
        Node::Unary(Unary::Abs, a) => length_if(moving(a).is_some_and(is_smooth)),
        Node::Neg(a) => of_factor(a),
        Node::Mul(a, b) | Node::Div(b, a) if rests(a) => of_factor(b),
        Node::Mul(a, b) if rests(b) => of_factor(a),
        _ => Shape::Other,
    }
}

/// Returns a formula and its available time derivatives: two at most, none if it contains forces.
fn with_derivatives(graph: &mut Graph, value: ExprId, has_jerk: bool) -> Vec<ExprId> {
    let mut formulas = vec![value];
    while formulas.len() < 3 {
        let last = formulas[formulas.len() - 1];
        let dependence = graph.dependence(last);
        let is_last = dependence.highest_order() == Some(3) || dependence.highest_varied_order() == Some(2);
        if is_last || !is_available(graph, last, has_jerk) {
            break;
        }
        let next = ConstraintSystem::time_derivatives(graph, &[last], 3)[0];
        if !is_available(graph, next, has_jerk) {
            break;
        }
        formulas.push(next);
    }
    formulas
}
