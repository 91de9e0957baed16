//! The smooth parts of a formula: sums and products of coordinates and of sines of angles, which move as smoothly as the coordinates do.
//!
//! A position relative to a moving body is such a sum, of terms that may be much larger than the sum itself, so that the ranges of the terms in a
//! cell bound it badly. A smooth part is therefore bounded like a coordinate: from its own time derivatives at the ends of the cell.

use super::magnitudes::{Largest, Magnitudes};
use crate::analysis::state::State;
use mechc_expr::{Binary, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::program::{Program, Ranges, Register, Registers, Stage};
use mechc_ir::{ConstraintSystem, CoordinateKind};
use rustc_hash::FxHashMap;

/// Maximum number of factors.
const MOST_FACTORS: u32 = 6;
/// Largest rotation of a body in a cell (rad) for which the sine of the angle is bounded.
const WIDEST_TURN: f64 = 0.25;
/// Largest rotation of any body in a cell (rad) for which positions within are bounded.
const WIDEST_OF_ALL: f64 = 0.5;

/// The kind of a formula.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Kind {
    /// A formula that does not change with the motion.
    Constant,
    /// A sum of angles and constants.
    Turn,
    /// A sum of products of smooth formulas.
    Smooth {
        /// The highest time derivative of a coordinate in it.
        order: u8,
        /// The largest number of moving factors in a product.
        factors: u32,
    },
    Other,
}

/// A smooth part of a formula.
struct SmoothPart {
    /// The node of the formula that the part replaces.
    of: ExprId,
    /// The node itself, or its square if it is a length: a length has a kink at zero, its square has none.
    value: ExprId,
    is_square: bool,
    /// The highest time derivative of a coordinate in the part.
    order: u8,
}

/// The smooth parts of a formula, with their time derivatives.
pub(super) struct Smooth {
    program: Program,
    registers: Registers,
    /// The ranges of the parts and their time derivatives.
    ranges: Ranges,
    /// The magnitudes of the coordinates.
    sizes: Magnitudes,
    /// The registers of each part and its time derivatives, by order, from the order at which the part stands as a coordinate.
    towers: Vec<[Option<Register>; 4]>,
    /// The order at which each part stands, and whether it is a square.
    kinds: Vec<(usize, bool)>,
    /// The coordinates that the parts contain.
    coordinates: Vec<usize>,
    /// The angles among `coordinates`.
    turns: Vec<usize>,
    /// All angles of the mechanism.
    all_turns: Vec<usize>,
}

impl Smooth {
    /// Replaces the smooth parts of a formula by further coordinates, numbered after those of the system. Returns a new graph, the formula and the
    /// unchanged `others` in it, and the smooth parts.
    pub fn extract_from(
        graph: &mut Graph,
        value: ExprId,
        others: &[ExprId],
        system: &ConstraintSystem,
    ) -> (Graph, Vec<ExprId>, Smooth) {
        let kinds = kinds(graph, value, system);
        let parts = largest(graph, value, &kinds);
        let (mut local, mut imported) = (Graph::new(), FxHashMap::default());
        local.import_tables(graph, &mut imported, Graph::symbol);
        let mut towers = Vec::with_capacity(parts.len());
        let first = system.coordinates().len();
        for (k, &SmoothPart { of, value, is_square, order }) in parts.iter().enumerate() {
            let symbol = local.symbol(Symbol::Coordinate { index: (first + k) as u32, order });
            imported.insert(of, if is_square { local.unary(Unary::Sqrt, symbol) } else { symbol });
            towers.push(tower(graph, value, order, system.jerk().is_some()));
        }
        let kinds: Vec<(usize, bool)> = parts.iter().map(|part| (usize::from(part.order), part.is_square)).collect();
        let requested = [&[value], others].concat();
        local.import(graph, &requested, &mut imported, Graph::symbol);
        let formulas = requested.iter().map(|id| imported[id]).collect();
        (local, formulas, Smooth::new(graph, &towers, kinds, system))
    }

    fn new(
        graph: &Graph,
        towers: &[[Option<ExprId>; 4]],
        kinds: Vec<(usize, bool)>,
        system: &ConstraintSystem,
    ) -> Smooth {
        let formulas: Vec<ExprId> = towers.iter().flatten().flatten().copied().collect();
        let (program, all) =
            Program::of_formulas(graph, [system.params().len(), system.coordinates().len(), 0, 0], &formulas);
        let mut roots = all.iter().copied();
        let towers = towers.iter().map(|tower| tower.map(|formula| formula.and_then(|_| roots.next()))).collect();
        let params = system.param_values();
        let registers = program.start(&params);
        let symbols = graph.symbols_of_all(&formulas);
        let mut coordinates: Vec<usize> = symbols.iter().filter_map(|&symbol| coordinate_of(symbol)).collect();
        coordinates.dedup();
        let is_turn = |&k: &usize| system.coordinates()[k].kind == CoordinateKind::Angle;
        let turns = coordinates.iter().copied().filter(is_turn).collect();
        let all_turns = (0..system.coordinates().len()).filter(is_turn).collect();
        let ranges = Ranges::new(&program, &registers, &all, Stage::Measures, false);
        let sizes = Magnitudes::new(coordinates.iter().map(|&k| Some(system.coordinates()[k].kind)).collect());
        Smooth { program, registers, ranges, sizes, towers, kinds, coordinates, turns, all_turns }
    }

    /// Returns the number of parts.
    pub fn count(&self) -> usize {
        self.towers.len()
    }

    /// Returns the order at which a square stands, which is never negative; `None` for any other part.
    pub fn square(&self, k: usize) -> Option<usize> {
        let (order, is_square) = self.kinds[k];
        is_square.then_some(order)
    }

    /// Returns the order at which a part stands as a coordinate; lower orders do not exist.
    pub fn order(&self, k: usize) -> usize {
        self.kinds[k].0
    }

    /// Records the largest magnitudes of the mechanism's coordinates.
    pub fn note_all(&mut self, of_all: Largest) {
        self.sizes.note_all(of_all);
    }

    /// Computes all parts and their time derivatives at a state.
    pub fn evaluate(&mut self, state: &State) {
        let inputs = self.program.inputs;
        for (number, &k) in self.coordinates.iter().enumerate() {
            let tower = state.tower(k);
            self.sizes.note(number, &tower);
            for (first, value) in inputs.coordinates.into_iter().zip(tower) {
                self.registers.set(first + k as Register, value);
            }
        }
        self.program.run(Stage::Measures, &mut self.registers);
    }

    /// Returns a part and its time derivatives, by order, at the state that was evaluated last; 0 for an order that does not exist.
    pub fn tower(&self, k: usize) -> [f64; 4] {
        self.towers[k].map(|register| register.map_or(0.0, |register| self.registers.get(register)))
    }

    /// Computes the ranges of all parts around a state. `parts` are the margins of coordinates and of their time derivatives, as parts of the
    /// largest magnitudes.
    pub fn find_ranges(&mut self, state: &State, parts: [f64; 2]) {
        let inputs = self.program.inputs;
        let towers = self.coordinates.iter().map(|&k| state.tower(k));
        for (&k, ranges) in self.coordinates.iter().zip(self.sizes.around(towers, parts)) {
            for (first, range) in inputs.coordinates.into_iter().zip(ranges) {
                self.ranges.set(first + k as Register, range);
            }
        }
        self.ranges.run_all(&self.program, &self.registers);
    }

    /// Returns the ranges of a part and of its time derivatives, by order, of the last [`Smooth::find_ranges`].
    pub fn ranges(&self, k: usize) -> [[f64; 2]; 4] {
        self.towers[k].map(|register| {
            let [low, high] = register.map_or([0.0; 2], |register| self.ranges.interval(register));
            [low - f64::EPSILON * low.abs(), high + f64::EPSILON * high.abs()]
        })
    }

    /// Returns the program with its registers, and those of each part and its time derivatives, by order.
    pub fn into_towers(self) -> (Program, Registers, Vec<[Option<Register>; 4]>) {
        (self.program, self.registers, self.towers)
    }

    /// Returns whether a body turns too far between two states for these to bound its sine, or whether any body turns too far for them to bound
    /// positions on it: after a whole turn of a driven body the states at both ends are equal.
    pub fn turns_far(&self, [a, b]: [&State; 2]) -> bool {
        let turned = |&k: &usize| {
            let fastest = f64::max(a.qd[k].abs(), b.qd[k].abs());
            f64::max((b.q[k] - a.q[k]).abs(), fastest * (b.t - a.t))
        };
        let are_far = |turns: &[usize], widest: f64| turns.iter().any(|k| turned(k) > widest);
        are_far(&self.turns, WIDEST_TURN) || are_far(&self.all_turns, WIDEST_OF_ALL)
    }
}

fn coordinate_of(symbol: Symbol) -> Option<usize> {
    match symbol {
        Symbol::Coordinate { index, .. } => Some(index as usize),
        _ => None,
    }
}

/// Returns the kinds of all nodes that a formula depends on.
fn kinds(graph: &Graph, value: ExprId, system: &ConstraintSystem) -> FxHashMap<ExprId, Kind> {
    let mut kinds = FxHashMap::default();
    for id in graph.reachable(&[value]) {
        let kind = if graph.dependence(id).is_constant() {
            Kind::Constant
        } else {
            kind_of(graph.node(id), system, |child| kinds[&child])
        };
        kinds.insert(id, kind);
    }
    kinds
}

fn kind_of(node: Node, system: &ConstraintSystem, of: impl Fn(ExprId) -> Kind) -> Kind {
    match node {
        Node::Symbol(Symbol::Coordinate { index, order }) => match (system.coordinates()[index as usize].kind, order) {
            (CoordinateKind::Angle, 0) => Kind::Turn,
            (CoordinateKind::Angle | CoordinateKind::Length, _) => Kind::Smooth { order, factors: 1 },
            (CoordinateKind::Argument, _) => Kind::Other,
        },
        Node::Add(a, b) | Node::Sub(a, b) => of(a).plus(of(b)),
        Node::Mul(a, b) => of(a).times(of(b)),
        Node::Div(a, b) if of(b) == Kind::Constant => of(a).times(Kind::Constant),
        Node::Power(a, 2) => of(a).times(of(a)),
        Node::Neg(a) => of(a),
        Node::Unary(Unary::Sin | Unary::Cos, a) if of(a) == Kind::Turn => Kind::Smooth { order: 0, factors: 1 },
        _ => Kind::Other,
    }
}

impl Kind {
    /// Returns the highest time derivative and the number of factors of a smooth formula.
    fn smooth(self) -> Option<(u8, u32)> {
        match self {
            Kind::Constant => Some((0, 0)),
            Kind::Turn => Some((0, 1)),
            Kind::Smooth { order, factors } => Some((order, factors)),
            Kind::Other => None,
        }
    }

    fn plus(self, other: Kind) -> Kind {
        let is_turn = |kind| matches!(kind, Kind::Constant | Kind::Turn);
        match (self.smooth(), other.smooth()) {
            _ if is_turn(self) && is_turn(other) => Kind::Turn,
            (Some(a), Some(b)) => Kind::Smooth { order: a.0.max(b.0), factors: a.1.max(b.1) },
            _ => Kind::Other,
        }
    }

    fn times(self, other: Kind) -> Kind {
        match (self.smooth(), other.smooth()) {
            (Some(a), Some(b)) if a.1 + b.1 <= MOST_FACTORS => Kind::Smooth { order: a.0.max(b.0), factors: a.1 + b.1 },
            _ => Kind::Other,
        }
    }
}

/// Returns the largest smooth parts of a formula, other than single coordinates.
fn largest(graph: &mut Graph, value: ExprId, kinds: &FxHashMap<ExprId, Kind>) -> Vec<SmoothPart> {
    let (mut parts, mut open) = (Vec::new(), vec![value]);
    let mut visited = rustc_hash::FxHashSet::default();
    while let Some(id) = open.pop() {
        let node = graph.node(id);
        if !visited.insert(id) || matches!(node, Node::Symbol(_)) {
            continue;
        }
        let whole = |order: u8| SmoothPart { of: id, value: id, is_square: false, order };
        match kinds[&id] {
            Kind::Constant => {}
            Kind::Turn => parts.push(whole(0)),
            Kind::Smooth { order, .. } => parts.push(whole(order)),
            Kind::Other => match square(graph, node, kinds) {
                Some((value, order)) => parts.push(SmoothPart { value, is_square: true, ..whole(order) }),
                None => open.extend_from_slice(node.children().as_slice()),
            },
        }
    }
    parts.sort_unstable_by_key(|part| part.of);
    parts
}

/// Returns the square of a length and its order, if the square is smooth.
fn square(graph: &mut Graph, length: Node, kinds: &FxHashMap<ExprId, Kind>) -> Option<(ExprId, u8)> {
    let (value, kind) = match length {
        Node::Unary(Unary::Sqrt, a) if is_sum_of_squares(graph, a) => (a, kinds[&a]),
        Node::Binary(Binary::Hypot, a, b) => {
            let squared = |leg: ExprId| kinds[&leg].times(kinds[&leg]);
            let kind = squared(a).plus(squared(b));
            let [a, b] = [a, b].map(|leg| graph.power(leg, 2));
            (graph.add(a, b), kind)
        }
        _ => return None,
    };
    match kind {
        Kind::Smooth { order, .. } => Some((value, order)),
        _ => None,
    }
}

/// Returns whether a formula is syntactically a sum of squares.
fn is_sum_of_squares(graph: &Graph, formula: ExprId) -> bool {
    match graph.node(formula) {
        Node::Add(a, b) => is_sum_of_squares(graph, a) && is_sum_of_squares(graph, b),
        Node::Mul(a, b) => a == b,
        Node::Power(_, n) => n % 2 == 0,
        Node::Const(_) => graph.as_const(formula).is_some_and(|value| value >= 0.0),
        _ => false,
    }
}

/// Returns a formula of some order and its available time derivatives, by order.
fn tower(graph: &mut Graph, value: ExprId, order: u8, has_jerk: bool) -> [Option<ExprId>; 4] {
    let mut tower = [None; 4];
    tower[usize::from(order)] = Some(value);
    for next in usize::from(order) + 1..4 {
        let last = tower[next - 1].into_iter().collect::<Vec<_>>();
        let formula = ConstraintSystem::time_derivatives(graph, &last, 3).pop();
        let is_available = |&formula: &ExprId| has_jerk || graph.dependence(formula).highest_order() != Some(3);
        tower[next] = formula.filter(is_available);
        if tower[next].is_none() {
            break;
        }
    }
    tower
}
