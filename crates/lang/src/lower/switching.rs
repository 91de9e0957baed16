//! Switching functions: formulas at whose zeros another formula jumps or has a kink along the motion, and their derivatives by a variable.
//!
//! A switch whose time does not depend on the variable, such as one of time alone, does not disturb a derivative at fixed time.

use super::Lowering;
use mechc_expr::{Binary, Dependence, ExprId, Graph, Node, Unary};

/// The kind of discontinuity at a switch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Discontinuity {
    /// The value jumps.
    Jump,
    /// The value or its rate jumps.
    Kink,
}

/// A switching function `g`.
#[derive(Clone, Copy)]
pub(super) struct SwitchingFunction {
    pub value: ExprId,
    /// The derivative of `g` by a variable.
    pub derivative: ExprId,
}

impl Lowering<'_> {
    /// Returns the switching functions that depend on a variable and at whose zeros a formula may jump.
    pub(super) fn moving_jumps(&mut self, formula: ExprId, variable: u32) -> Vec<SwitchingFunction> {
        let mut switches = self.moving_switches(&[formula], Discontinuity::Jump, variable);
        switches.extend(self.moving_in_equations(formula, Discontinuity::Jump, variable));
        switches
    }

    /// Returns the switching functions that depend on a variable and at whose zeros a formula or its rate may jump.
    pub(super) fn moving_kinks(&mut self, formula: ExprId, variable: u32) -> Vec<SwitchingFunction> {
        let mut switches = self.moving_switches(&[formula], Discontinuity::Kink, variable);
        switches.extend(self.moving_in_equations(formula, Discontinuity::Kink, variable));
        switches
    }

    /// Returns the switching functions at whose zeros a formula may jump along the motion, or bend if `kinks`.
    pub(super) fn switching_functions(&mut self, formula: ExprId, kinks: bool) -> Vec<ExprId> {
        let kind = if kinks { Discontinuity::Kink } else { Discontinuity::Jump };
        let mut operands = switching_operands(&mut self.graph, &[formula], kind);
        for (roots, kind) in self.equations_affecting(formula, kind) {
            operands.extend(switching_operands(&mut self.graph, &roots, kind));
        }
        operands.sort_unstable();
        operands.dedup();
        operands.retain(|&of| !self.graph.dependence(of).is_constant());
        operands
    }

    /// Returns whether a formula of results has switching functions that depend on reductions.
    pub(super) fn switches_by_results(&mut self, formula: ExprId) -> bool {
        switching_operands(&mut self.graph, &[formula], Discontinuity::Kink)
            .into_iter()
            .any(|of| self.graph.dependence(of).on(Dependence::NAMED))
    }

    /// Returns the switching functions in the equations and loads that affect a formula and depend on a variable. Positions and velocities
    /// do not jump, whatever the equations do.
    fn moving_in_equations(&mut self, formula: ExprId, kind: Discontinuity, variable: u32) -> Vec<SwitchingFunction> {
        let [rows, loads] = self.equations_affecting(formula, kind);
        let mut switches = self.moving_switches(&rows.0, rows.1, variable);
        switches.extend(self.moving_switches(&loads.0, loads.1, variable));
        switches
    }

    /// Returns the equations and the loads that affect a formula, each with the kind of discontinuity in them that matters.
    fn equations_affecting(&mut self, formula: ExprId, kind: Discontinuity) -> [(Vec<ExprId>, Discontinuity); 2] {
        let order = if kind == Discontinuity::Jump { 2 } else { 1 };
        let dependence = self.graph.dependence(formula);
        let holds_forces = dependence.on(Dependence::FORCES);
        let highest = dependence.highest_order().max(dependence.highest_varied_order());
        let mut roots = Vec::new();
        if holds_forces || highest >= Some(order) {
            roots.extend(self.rows.iter().map(|row| row.phi));
        }
        let mut loads: Vec<ExprId> = Vec::new();
        if holds_forces {
            loads.extend(self.model.loads.iter().map(|load| load.force));
            loads = loads.into_iter().map(|force| self.formula(force)).collect();
        }
        [(roots, Discontinuity::Kink), (loads, kind)]
    }

    /// Returns the switching functions of formulas that depend on a variable.
    fn moving_switches(&mut self, roots: &[ExprId], kind: Discontinuity, variable: u32) -> Vec<SwitchingFunction> {
        let mut operands = switching_operands(&mut self.graph, roots, kind);
        operands.sort_unstable();
        operands.dedup();
        let (moves, symbol) = (self.affects_motion(variable), self.model.variables[variable as usize].symbol);
        // A function of parameters alone does not change along the motion.
        operands.retain(|&of| !self.graph.dependence(of).is_constant());
        let switches = operands.into_iter().map(|of| {
            // The derivatives of reductions are not examined here, and a parameter that does not affect the motion stands in formulas
            // directly.
            let holds_reductions = self.graph.dependence(of).on(Dependence::NAMED);
            let by = match moves {
                _ if holds_reductions => self.graph.constant(1.0),
                true => self.derivative_by(of, variable),
                false => self.graph.constant(f64::from(u8::from(self.graph.symbols(of).contains(&symbol)))),
            };
            SwitchingFunction { value: of, derivative: by }
        });
        let mut switches: Vec<SwitchingFunction> = switches.collect();
        switches.retain(|switch| !self.graph.is_zero(switch.derivative));
        switches
    }

    /// Returns whether the motion depends on a variable. Masses and loads do not affect it.
    fn affects_motion(&self, variable: u32) -> bool {
        let rows: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        self.graph.symbols_of_all(&rows).contains(&self.model.variables[variable as usize].symbol)
    }
}

/// Returns the switching functions of formulas.
fn switching_operands(graph: &mut Graph, roots: &[ExprId], kind: Discontinuity) -> Vec<ExprId> {
    graph.reachable(roots).into_iter().flat_map(|id| node_switches(graph, id, kind)).collect()
}

/// Returns a formula that is zero where a number is an integer.
fn zero_at_integers(graph: &mut Graph, of: ExprId) -> ExprId {
    let half_turn = graph.constant(std::f64::consts::PI);
    let turned = graph.mul(half_turn, of);
    graph.unary(Unary::Sin, turned)
}

/// Returns the switching functions of one node.
fn node_switches(graph: &mut Graph, id: ExprId, kind: Discontinuity) -> Vec<ExprId> {
    let kinks = kind == Discontinuity::Kink;
    match graph.node(id) {
        Node::Compare(_, a, b) => vec![graph.sub(a, b)],
        Node::Binary(Binary::Min | Binary::Max, a, b) if kinks => vec![graph.sub(a, b)],
        Node::Binary(Binary::Hypot, ..) if kinks => vec![id],
        Node::Binary(Binary::Pow, a, b) if kinks => vec![a, b],
        Node::Binary(Binary::Atan2, a, b) => {
            // Zero where `b` is negative and `a` is zero.
            let length = graph.binary(Binary::Hypot, a, b);
            vec![graph.add(length, b)]
        }
        Node::Binary(Binary::Mod, a, b) => {
            let turns = graph.div(a, b);
            vec![zero_at_integers(graph, turns)]
        }
        Node::Unary(Unary::Floor, a) => vec![zero_at_integers(graph, a)],
        Node::Unary(Unary::Sign, a) => vec![a],
        Node::Unary(Unary::Abs | Unary::Sqrt, a) if kinks => vec![a],
        Node::Unary(Unary::Asin | Unary::Acos, a) if kinks => {
            let (one, square) = (graph.constant(1.0), graph.power(a, 2));
            vec![graph.sub(one, square)]
        }
        // The third derivative of a spline jumps at its knots, which may depend on parameters.
        Node::Table(table, order, a) if kinks || order == 3 => {
            let knots = graph.tables()[table.index()].knots.clone();
            let moving = knots.into_iter().filter(|&knot| graph.as_const(knot).is_none()).collect::<Vec<ExprId>>();
            let distances = moving.into_iter().map(|knot| graph.sub(a, knot)).collect::<Vec<ExprId>>();
            [vec![a], distances].concat()
        }
        _ => Vec::new(),
    }
}
