//! Formulas that are reduced: their values, derivatives and ranges along the motion.

use crate::analysis::kinematics::State;
use crate::expr::{ExprId, Graph, Symbol};
use crate::ir::ConstraintSystem;
use crate::program::{Program, Range, Ranges, Register, Registers, Stage};
use std::rc::Rc;

/// How much farther from a straight line a coordinate's last derivative may go between two states than it did in the middle of the
/// stretch that they are a half of: four times as far as a parabola would.
const SAFETY: f64 = 1.0;

/// A formula along the motion.
pub(super) struct Formula {
    program: Program,
    registers: Registers,
    /// Its value and time derivatives, as many as there are.
    roots: Vec<Register>,
    ranges: Ranges,
    /// The coordinates that it or its derivatives hold.
    coordinates: Vec<usize>,
    has_jerk: bool,
}

/// A formula at a time: its value and time derivatives; those that it has not are no numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub value: f64,
    pub first: f64,
    pub second: f64,
}

/// A formula at a state.
pub(super) struct Point {
    pub state: State,
    pub sample: Sample,
}

/// What lies between two points.
#[derive(Clone)]
pub(super) struct Cell {
    pub a: Rc<Point>,
    pub b: Rc<Point>,
    /// By coordinate that the formula holds: how far its second and third derivatives are from a straight line.
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
        let bends = formula.bends([&self.a.state, &middle.state, &self.b.state]);
        [
            Cell { a: Rc::clone(&self.a), b: Rc::clone(middle), bends: Rc::clone(&bends) },
            Cell { a: Rc::clone(middle), b: Rc::clone(&self.b), bends },
        ]
    }

    /// From one point to another, of which nothing between is known yet.
    pub fn unknown(formula: &Formula, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        let bends = formula.coordinates.iter().map(|_| [f64::INFINITY; 2]).collect();
        Cell { a: Rc::clone(a), b: Rc::clone(b), bends }
    }
}

impl Formula {
    /// A formula of a graph over the parameters and coordinates of a system.
    pub fn new(graph: &mut Graph, value: ExprId, system: &ConstraintSystem) -> Formula {
        let has_jerk = system.jerk.is_some();
        let mut formulas = vec![value];
        while formulas.len() < 3 {
            let last = formulas[formulas.len() - 1];
            if graph.dependence(last).highest_order() == Some(3) {
                break;
            }
            let next = ConstraintSystem::time_derivatives(graph, &[last], 3)[0];
            if graph.dependence(next).highest_order() == Some(3) && !has_jerk {
                break;
            }
            formulas.push(next);
        }
        let mut coordinates: Vec<usize> = graph
            .symbols_of_all(&formulas)
            .into_iter()
            .filter_map(|symbol| match symbol {
                Symbol::Coordinate { index, .. } => Some(index as usize),
                _ => None,
            })
            .collect();
        coordinates.sort_unstable();
        coordinates.dedup();
        let (program, roots) = Program::of_formulas(graph, system.params.len(), system.coordinates.len(), &formulas);
        let params: Vec<f64> = system.params.iter().map(|param| param.value).collect();
        let registers = program.start(&params);
        let ranges = Ranges::new(&program, &registers, &roots, Stage::Measures, false);
        Formula { program, registers, roots, ranges, coordinates, has_jerk }
    }

    /// How many time derivatives it has: 0 to 2.
    pub fn derivatives(&self) -> usize {
        self.roots.len() - 1
    }

    /// Whether it changes with the motion, and not with time alone.
    pub fn moves(&self) -> bool {
        !self.coordinates.is_empty()
    }

    /// At a state.
    pub fn at(&mut self, state: State) -> Rc<Point> {
        let inputs = self.program.inputs;
        self.registers.set(inputs.time, state.t);
        for &k in &self.coordinates {
            for (first, values) in inputs.coordinates.into_iter().zip([&state.q, &state.qd, &state.qdd, &state.qddd]) {
                self.registers.set(first + k as u32, values[k]);
            }
        }
        self.program.run(Stage::Measures, &mut self.registers);
        let value = |order: usize| self.roots.get(order).map_or(f64::NAN, |&root| self.registers.get(root));
        let sample = Sample { value: value(0), first: value(1), second: value(2) };
        Rc::new(Point { state, sample })
    }

    /// Begins to look at the ranges in a cell.
    pub fn look_at(&mut self, cell: &Cell) {
        let (a, b, h) = (&cell.a.state, &cell.b.state, cell.length());
        self.ranges.set_times([a.t, b.t]);
        for (&k, bends) in self.coordinates.iter().zip(cell.bends.iter()) {
            let third = around(a.qddd[k], b.qddd[k], bends[1]);
            let second = around(a.qdd[k], b.qdd[k], bends[0]);
            let first = between(a.qd[k], b.qd[k], second, h);
            let place = between(a.q[k], b.q[k], first, h);
            for (order, range) in [place, first, second, third].into_iter().enumerate() {
                self.ranges.set(order, k, range);
            }
        }
    }

    /// The range of the value (0) or of a derivative in the cell that is looked at; in order.
    pub fn range(&mut self, order: usize) -> Range {
        self.ranges.range(&self.program, &self.registers, order)
    }

    /// How far the last derivatives are from a straight line in the middle of three states.
    fn bends(&self, [a, middle, b]: [&State; 3]) -> Rc<[[f64; 2]]> {
        let off = |a: &[f64], middle: &[f64], b: &[f64], k: usize| (middle[k] - 0.5 * a[k] - 0.5 * b[k]).abs();
        let of = |&k: &usize| {
            let third = if self.has_jerk { off(&a.qddd, &middle.qddd, &b.qddd, k) } else { 0.0 };
            [off(&a.qdd, &middle.qdd, &b.qdd, k), third]
        };
        self.coordinates.iter().map(of).collect()
    }
}

/// Both values and what lies between, and so much beyond.
fn around(a: f64, b: f64, bend: f64) -> [f64; 2] {
    let beyond = SAFETY * bend;
    [a.min(b) - beyond, a.max(b) + beyond]
}

/// What a quantity can be between two values a time `h` (s) apart, its slope being in a range.
pub(super) fn between(a: f64, b: f64, [least, most]: [f64; 2], h: f64) -> [f64; 2] {
    let (low, high) = (a.min(b), a.max(b));
    if least >= 0.0 || most <= 0.0 {
        return [low, high];
    }
    if !(least.is_finite() && most.is_finite()) {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let up = ((b - a - least * h) / (most - least)).clamp(0.0, h);
    let down = ((b - a - most * h) / (least - most)).clamp(0.0, h);
    [low.min(a + least * down), high.max(a + most * up)]
}
