//! Compilation of a constraint system to operations.

use super::{
    BoundaryRegisters, CheckSlopeRegisters, Inputs, Op, Outputs, Program, Register, RightSideRegisters, STAGES, Stage,
    Switch, TableLayout,
};
use crate::{self as ir, ConstraintSystem, RightSide, With};
use mechc_expr::{Binary, Comparison, Dependence, ExprId, Graph, Node, Symbol, TIME_SIGNAL, TableId, Unary};
use rustc_hash::{FxHashMap, FxHashSet};

const NONE: Register = Register::MAX;

/// Placement of a table of the graph in the program.
#[derive(Clone, Copy)]
pub(super) struct TablePlacement {
    /// Number in the program.
    pub number: u32,
    /// Length of the table's range.
    pub period: Register,
}

/// Piece of a table at an argument: the piece, and the offset of the argument from the piece's knot.
#[derive(Clone, Copy)]
pub(super) struct TablePiece {
    pub piece: Register,
    pub offset: Register,
}

impl Program {
    /// Compiles a constraint system.
    #[must_use]
    pub fn new(system: &ConstraintSystem) -> Program {
        let mut layout = Layout::new(system);
        layout.signals(system);
        let mut outputs = Outputs {
            estimates: layout.emit_all(Stage::Prologue, system.coordinates().iter().map(|c| c.estimate)),
            phi: layout.emit_all(Stage::Position, system.rows().iter().map(|row| row.phi)),
            phi_q: layout.emit_all(Stage::Position, system.phi_q().entries().iter().map(|&(_, id)| id)),
            conditions: layout.emit_all(Stage::Position, system.conditions().iter().map(|c| c.positive)),
            checks: layout.emit_all(Stage::Position, system.checks().iter().map(|c| c.phi)),
            watches: layout.emit_all(Stage::Position, system.monitors().iter().map(|w| w.value)),
            ..Outputs::default()
        };
        outputs.terms =
            system.rows().iter().map(|row| layout.emit_all(Stage::Position, system.graph().terms(row.phi))).collect();
        let (at_position, comparisons) = (layout.register_of.clone(), layout.comparisons.clone());
        outputs.right_sides = layout.right_sides(system);
        outputs.forces = layout.emit_all(Stage::Forces, system.required_forces().iter().copied());
        let mut varied = |list: &[ExprId]| layout.emit_all(Stage::Variation, list.iter().copied());
        let slopes = system.check_slopes();
        outputs.check_slopes = CheckSlopeRegisters {
            coordinates: varied(&slopes.by_q),
            inputs: slopes.by_inputs().map(&mut varied).collect(),
            params: slopes.by_params().map(&mut varied).collect(),
        };
        for variation in system.variations() {
            let rights = variation.rights.each_ref();
            outputs.variations.push(rights.map(|rights| layout.emit_all(Stage::Variation, rights.iter().copied())));
            outputs.varied_forces.push(layout.emit_all(Stage::Variation, variation.forces.iter().copied()));
        }
        outputs.reactions = layout.emit_all(Stage::Measures, system.reactions().iter().map(|of| of.value));
        outputs.measures = layout.emit_all(Stage::Measures, system.measures().iter().map(|m| m.value));
        outputs.measures_d = layout.emit_all(Stage::Measures, system.measures().iter().filter_map(|m| m.first));
        outputs.measures_dd = layout.emit_all(Stage::Measures, system.measures().iter().filter_map(|m| m.second));
        outputs.appended =
            layout.emit_all(Stage::Measures, system.derivative_columns().iter().map(|column| column.value));
        // boundaries are evaluated after time and position alone
        (layout.register_of, layout.comparisons) = (at_position, comparisons);
        outputs.domain_boundaries =
            system.domain_boundaries().iter().map(|boundary| layout.domain_boundary(boundary)).collect();
        layout.finish(outputs)
    }
}

/// Returns the stage in which a right side is evaluated.
fn stage_of(with: With) -> Stage {
    match with {
        With::Time(0 | 1) | With::Input(_) => Stage::Velocity,
        With::Time(2) => Stage::Acceleration,
        With::Time(_) => Stage::Jerk,
        // params need no stage of their own: differentiation adds no branches
        With::Param(_) => Stage::Variation,
    }
}

pub(super) struct Layout<'s> {
    pub graph: &'s Graph,
    pub register_of: Vec<Register>,
    /// Angles whose sine and cosine both occur.
    pairs: FxHashSet<ExprId>,
    pub operations: Vec<Vec<Op>>,
    pub constants: Vec<(Register, f64)>,
    /// Comparisons by operands, so that a function and its derivative share one.
    comparisons: FxHashMap<(Comparison, Register, Register), Register>,
    zero: Option<Register>,
    /// Tables of the graph that have been laid out.
    pub tables: FxHashMap<TableId, TablePlacement>,
    pub table_layouts: Vec<TableLayout>,
    /// Pieces of tables, by table and argument.
    pub table_pieces: FxHashMap<(TableId, ExprId), TablePiece>,
    inputs: Inputs,
    next: Register,
}

impl<'s> Layout<'s> {
    fn new(system: &'s ConstraintSystem) -> Layout<'s> {
        let signals = if system.has_signals() { system.inputs().len() } else { 0 };
        let counts = [
            system.params().len(),
            system.coordinates().len(),
            signals,
            system.slopes().len(),
            system.variations().len(),
            if system.forces().is_some() { system.rows().len() } else { 0 },
        ];
        Layout::of(system.graph(), counts.map(|count| count as u32))
    }

    /// Creates a layout for formulas of a graph, by the numbers of parameters, coordinates, signals, variables that coordinates are
    /// differentiated by, variations, and multipliers.
    pub fn of(graph: &'s Graph, [params, n, signals, slopes, variations, multipliers]: [u32; 6]) -> Layout<'s> {
        let coordinates = [0, 1, 2, 3].map(|order| params + 1 + order * n);
        let signals_at = params + 1 + 4 * n;
        let slopes_at = signals_at + 3 * signals;
        let varied = slopes_at + n * slopes;
        let multipliers_at = varied + 3 * n * variations;
        Layout {
            graph,
            register_of: vec![NONE; graph.len()],
            pairs: pairs(graph),
            operations: STAGES.map(|_| Vec::new()).to_vec(),
            constants: Vec::new(),
            comparisons: FxHashMap::default(),
            zero: None,
            tables: FxHashMap::default(),
            table_layouts: Vec::new(),
            table_pieces: FxHashMap::default(),
            inputs: Inputs {
                params: 0,
                time: params,
                coordinates,
                n,
                signals: signals_at,
                slopes: slopes_at,
                count: signals,
                varied,
                multipliers: multipliers_at,
            },
            next: multipliers_at + multipliers * (1 + variations),
        }
    }

    /// Lays out all right sides, in the order of their stages.
    fn right_sides(&mut self, system: &ConstraintSystem) -> Vec<RightSideRegisters> {
        let mut sides: Vec<(Stage, &RightSide)> =
            system.right_sides().iter().map(|side| (stage_of(side.with), side)).collect();
        sides.sort_by_key(|(stage, side)| (*stage, side.with));
        let mut placed: Vec<RightSideRegisters> = Vec::with_capacity(sides.len());
        for (stage, RightSide { with, entries }) in sides {
            placed.push(RightSideRegisters { with: *with, entries: self.emit_all(stage, entries.iter().copied()) });
        }
        placed.sort_by_key(|side| side.with);
        placed
    }

    /// Emits the operations for roots that have no register yet, and returns the registers of all roots.
    pub fn emit_all(&mut self, stage: Stage, roots: impl IntoIterator<Item = ExprId>) -> Vec<Register> {
        let roots: Vec<ExprId> = roots.into_iter().collect();
        let mut needed: Vec<ExprId> = Vec::new();
        let mut visited: FxHashSet<ExprId> = FxHashSet::default();
        let mut open = roots.clone();
        while let Some(id) = open.pop() {
            if self.register_of[id.index()] == NONE && visited.insert(id) {
                needed.push(id);
                open.extend_from_slice(self.graph.node(id).children().as_slice());
            }
        }
        // children have smaller ids than their parents
        needed.sort_unstable();
        for id in needed {
            if self.register_of[id.index()] == NONE {
                self.emit(stage, id);
            }
        }
        roots.iter().map(|id| self.register_of[id.index()]).collect()
    }

    /// Emits the default formulas of signals, for callers that do not set signals.
    fn signals(&mut self, system: &ConstraintSystem) {
        for (signal, input) in system.inputs().iter().enumerate().take(self.inputs.count as usize) {
            let formulas = self.emit_all(Stage::Time, input.formulas);
            for (order, a) in formulas.into_iter().enumerate() {
                let to = self.inputs.signal(signal as u32, order as u32);
                self.operations[Stage::Time as usize].push(Op::Copy { to, a });
            }
        }
    }

    fn domain_boundary(&mut self, boundary: &ir::DomainBoundary) -> BoundaryRegisters {
        let terms = self.emit_all(Stage::DomainBoundaries, self.graph.terms(boundary.gauge));
        let registers = self.emit_all(Stage::DomainBoundaries, [boundary.gauge].into_iter().chain(boundary.slope));
        BoundaryRegisters { gauge: registers[0], slope: registers.get(1).copied(), terms }
    }

    /// Returns the stage in which a node is computed when stage `needed_in` needs it first.
    fn stage_of(&self, needed_in: Stage, id: ExprId) -> Stage {
        let dependence = self.graph.dependence(id);
        if dependence.is_constant() {
            Stage::Prologue
        } else if needed_in == Stage::Position && !dependence.on(Dependence::coordinates(0)) {
            Stage::Time
        } else {
            needed_in
        }
    }

    fn emit(&mut self, needed_in: Stage, id: ExprId) {
        let stage = self.stage_of(needed_in, id);
        let register = match self.graph.node(id) {
            Node::Const(bits) => self.constant(f64::from_bits(bits)),
            Node::Symbol(symbol) => self.input(symbol),
            Node::Power(a, n) => {
                let register = self.power(stage, self.register(a), n.unsigned_abs());
                if n < 0 { self.push(stage, |to| Op::Recip { to, a: register }) } else { register }
            }
            Node::Unary(function @ (Unary::Sin | Unary::Cos), a) if self.pairs.contains(&a) => {
                self.sine_and_cosine(stage, id, function, a)
            }
            Node::Unary(Unary::Abs, a) if stage.can_switch() => self.absolute(stage, self.register(a)),
            Node::Binary(Binary::Min, a, b) if stage.can_switch() => {
                let (a, b) = (self.register(a), self.register(b));
                let condition = self.comparison(stage, Comparison::Less, a, b);
                self.push(stage, |to| Op::Either { to, condition, a, b })
            }
            Node::Binary(Binary::Max, a, b) if stage.can_switch() => {
                let (a, b) = (self.register(a), self.register(b));
                let condition = self.comparison(stage, Comparison::Less, b, a);
                self.push(stage, |to| Op::Either { to, condition, a, b })
            }
            Node::Binary(Binary::Mod, a, b) => self.modulo(stage, self.register(a), self.register(b)),
            Node::Compare(comparison, a, b) => self.comparison(stage, comparison, self.register(a), self.register(b)),
            Node::Table(table, order, x) => self.table(stage, table, order, x),
            node => self.operation(stage, node),
        };
        self.register_of[id.index()] = register;
    }

    /// Returns the register of a node that has been laid out.
    pub fn register(&self, id: ExprId) -> Register {
        self.register_of[id.index()]
    }

    /// Adds an operation that writes a new register, and returns the register.
    pub fn push(&mut self, stage: Stage, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.fresh();
        self.operations[stage as usize].push(op(to));
        to
    }

    pub fn constant(&mut self, value: f64) -> Register {
        let to = self.fresh();
        self.constants.push((to, value));
        to
    }

    /// Emits `|a|` as a selection, so that it can be frozen.
    fn absolute(&mut self, stage: Stage, a: Register) -> Register {
        let zero = if let Some(zero) = self.zero {
            zero
        } else {
            let zero = self.constant(0.0);
            self.zero = Some(zero);
            zero
        };
        let condition = self.comparison(stage, Comparison::Less, a, zero);
        let turned = self.push(stage, |to| Op::Neg { to, a });
        self.push(stage, |to| Op::Select { to, condition, a: turned, b: a })
    }

    /// Emits `a − b·⌊a/b⌋` with the operations of `math::modulo`.
    fn modulo(&mut self, stage: Stage, a: Register, b: Register) -> Register {
        let quotient = self.push(stage, |to| Op::Div { to, a, b });
        let whole = self.push(stage, |to| Op::Unary { function: Unary::Floor, to, a: quotient });
        let multiple = self.push(stage, |to| Op::Mul { to, a: b, b: whole });
        self.push(stage, |to| Op::Sub { to, a, b: multiple })
    }

    fn comparison(&mut self, stage: Stage, comparison: Comparison, a: Register, b: Register) -> Register {
        // all registers that hold zero are equivalent here
        let b = self.zero.filter(|_| self.is_zero(b)).unwrap_or(b);
        if self.is_zero(b) {
            self.zero.get_or_insert(b);
        }
        if let Some(&register) = self.comparisons.get(&(comparison, a, b)) {
            return register;
        }
        let register = self.push(stage, |to| Op::Compare { comparison, to, a, b });
        self.comparisons.insert((comparison, a, b), register);
        register
    }

    fn is_zero(&self, register: Register) -> bool {
        // constants are sorted by register
        let position = self.constants.binary_search_by_key(&register, |&(register, _)| register);
        position.is_ok_and(|at| self.constants[at].1 == 0.0)
    }

    /// Emits an operation that corresponds to a node of the graph.
    fn operation(&mut self, stage: Stage, node: Node) -> Register {
        let r = |child: ExprId| self.register_of[child.index()];
        let op = match node {
            Node::Add(a, b) => Op::Add { to: self.next, a: r(a), b: r(b) },
            Node::Sub(a, b) => Op::Sub { to: self.next, a: r(a), b: r(b) },
            Node::Mul(a, b) => Op::Mul { to: self.next, a: r(a), b: r(b) },
            Node::Div(a, b) => Op::Div { to: self.next, a: r(a), b: r(b) },
            Node::Neg(a) => Op::Neg { to: self.next, a: r(a) },
            Node::Unary(function, a) => Op::Unary { function, to: self.next, a: r(a) },
            Node::Binary(function, a, b) => Op::Binary { function, to: self.next, a: r(a), b: r(b) },
            Node::And(a, b) => Op::And { to: self.next, a: r(a), b: r(b) },
            Node::Or(a, b) => Op::Or { to: self.next, a: r(a), b: r(b) },
            Node::Not(a) => Op::Not { to: self.next, a: r(a) },
            Node::Select(c, a, b) => Op::Select { to: self.next, condition: r(c), a: r(a), b: r(b) },
            Node::Const(_) | Node::Symbol(_) | Node::Power(..) | Node::Compare(..) | Node::Table(..) => {
                unreachable!("these have layouts of their own")
            }
        };
        self.operations[stage as usize].push(op);
        self.fresh()
    }

    /// Emits sine and cosine together when either is needed first.
    fn sine_and_cosine(&mut self, stage: Stage, id: ExprId, function: Unary, angle: ExprId) -> Register {
        let (sin, cos) = (self.fresh(), self.fresh());
        let a = self.register_of[angle.index()];
        self.operations[stage as usize].push(Op::SinCos { sin, cos, a });
        let other = if function == Unary::Sin { Unary::Cos } else { Unary::Sin };
        let (this_register, other_register) = if function == Unary::Sin { (sin, cos) } else { (cos, sin) };
        self.register_of[id.index()] = this_register;
        if let Some(partner) = self.graph.find_unary(other, angle) {
            self.register_of[partner.index()] = other_register;
        }
        this_register
    }

    /// Emits `baseⁿ` for n ≥ 1 with the products of `math::whole_power`.
    fn power(&mut self, stage: Stage, base: Register, n: u32) -> Register {
        if n == 1 {
            return base;
        }
        let half = self.power(stage, base, n / 2);
        let square = self.fresh();
        self.operations[stage as usize].push(Op::Mul { to: square, a: half, b: half });
        if n.is_multiple_of(2) {
            return square;
        }
        let to = self.fresh();
        self.operations[stage as usize].push(Op::Mul { to, a: square, b: base });
        to
    }

    pub fn fresh(&mut self) -> Register {
        self.next += 1;
        self.next - 1
    }

    fn input(&mut self, symbol: Symbol) -> Register {
        match symbol {
            Symbol::Param(k) => self.inputs.params + k,
            Symbol::Time => self.inputs.time,
            Symbol::Signal { index, order } => {
                let signal = if index == TIME_SIGNAL { self.inputs.count - 1 } else { index };
                self.inputs.signal(signal, u32::from(order))
            }
            Symbol::Coordinate { index, order } => self.inputs.coordinates[order as usize] + index,
            Symbol::Shift(_) => self.constant(0.0),
            Symbol::Varied { index, order, variation } => self.inputs.varied(variation, u32::from(order)) + index,
            Symbol::Multiplier(row) => self.inputs.multipliers + row,
            Symbol::VariedMultiplier { row, variation } => self.inputs.varied_multipliers(variation) + row,
            Symbol::Named(_) => unreachable!("lowering leaves no named symbol"),
        }
    }

    pub fn finish(self, outputs: Outputs) -> Program {
        let switches = self
            .operations
            .iter()
            .zip(STAGES)
            .filter(|(_, stage)| stage.can_switch())
            .flat_map(|(operations, stage)| {
                let switches = operations.iter().filter_map(move |&op| Some((op, op.switched()?)));
                switches.map(move |(op, to)| Switch { op, to, on_time: stage == Stage::Time })
            })
            .collect();
        Program {
            switches,
            tables: self.table_layouts,
            operations: self.operations,
            constants: self.constants,
            registers: self.next as usize,
            inputs: self.inputs,
            outputs,
        }
    }
}

fn pairs(graph: &Graph) -> FxHashSet<ExprId> {
    let arguments = |searched: Unary| -> FxHashSet<ExprId> {
        graph
            .nodes()
            .filter_map(|(_, node)| match node {
                Node::Unary(function, a) if function == searched => Some(a),
                _ => None,
            })
            .collect()
    };
    let cosines = arguments(Unary::Cos);
    arguments(Unary::Sin).into_iter().filter(|a| cosines.contains(a)).collect()
}
