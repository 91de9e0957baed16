//! Where a formula may jump or bend along the motion, and whether that goes with a variable. Edges that stay where they are, as those of
//! time, are none for who differentiates at fixed time.

use super::Lowering;
use mechc_expr::{Binary, Dependence, ExprId, Graph, Node, Unary};

/// What may be wrong with a formula at an edge.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Break {
    /// Its value.
    Jump,
    /// Its value, or its rate.
    Bend,
}

/// What something breaks at where it is nothing.
#[derive(Clone, Copy)]
pub(super) struct Going {
    pub of: ExprId,
    /// Its derivative by the variable that it goes with.
    pub by: ExprId,
}

impl Lowering<'_> {
    /// What a formula may jump at that goes with a variable.
    pub(super) fn jumping_elsewhere(&mut self, formula: ExprId, variable: u32) -> Vec<Going> {
        let mut going = self.going(&[formula], Break::Jump, variable);
        going.extend(self.going_in_equations(formula, Break::Jump, variable));
        going
    }

    /// The same of what it may jump at, or its rate.
    pub(super) fn bending_elsewhere(&mut self, formula: ExprId, variable: u32) -> Vec<Going> {
        let mut going = self.going(&[formula], Break::Bend, variable);
        going.extend(self.going_in_equations(formula, Break::Bend, variable));
        going
    }

    /// What a formula may jump at along the motion, or its rate where bends count, whether that goes with a variable or stays.
    pub(super) fn edges_of(&mut self, formula: ExprId, bends: bool) -> Vec<ExprId> {
        let what = if bends { Break::Bend } else { Break::Jump };
        let mut operands = deciding(&mut self.graph, &[formula], what);
        for (roots, what) in self.equations_behind(formula, what) {
            operands.extend(deciding(&mut self.graph, &roots, what));
        }
        operands.sort_unstable();
        operands.dedup();
        operands.retain(|&of| !self.graph.dependence(of).is_constant());
        operands
    }

    /// Whether a formula of results may jump, or bend, where these decide.
    pub(super) fn may_break_by_results(&mut self, formula: ExprId) -> bool {
        deciding(&mut self.graph, &[formula], Break::Bend)
            .into_iter()
            .any(|of| self.graph.dependence(of).on(Dependence::NAMED))
    }

    /// What of the equations and loads decides about derivatives of this order, and about forces, and goes with a variable. Places and velocities
    /// do not jump, whatever equations do.
    fn going_in_equations(&mut self, formula: ExprId, what: Break, variable: u32) -> Vec<Going> {
        let [rows, loads] = self.equations_behind(formula, what);
        let mut going = self.going(&rows.0, rows.1, variable);
        going.extend(self.going(&loads.0, loads.1, variable));
        going
    }

    /// The equations and the loads that decide about a formula, and what of them does.
    fn equations_behind(&mut self, formula: ExprId, what: Break) -> [(Vec<ExprId>, Break); 2] {
        let order = if what == Break::Jump { 2 } else { 1 };
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
        [(roots, Break::Bend), (loads, what)]
    }

    /// What breaks formulas and goes with a variable.
    fn going(&mut self, roots: &[ExprId], what: Break, variable: u32) -> Vec<Going> {
        let mut operands = deciding(&mut self.graph, roots, what);
        operands.sort_unstable();
        operands.dedup();
        let (moves, symbol) = (self.moves_anything(variable), self.model.variables[variable as usize].symbol);
        // what parameters alone decide does not change on the way
        operands.retain(|&of| !self.graph.dependence(of).is_constant());
        let going = operands.into_iter().map(|of| {
            // how reductions go is not looked at here, nor how a parameter that moves nothing goes into a formula
            let is_untold = self.graph.dependence(of).on(Dependence::NAMED);
            let by = match moves {
                _ if is_untold => self.graph.constant(1.0),
                true => self.derivative_by(of, variable),
                false => self.graph.constant(f64::from(u8::from(self.graph.symbols(of).contains(&symbol)))),
            };
            Going { of, by }
        });
        let mut going: Vec<Going> = going.collect();
        going.retain(|going| !self.graph.is_zero(going.by));
        going
    }

    /// Whether the motion goes with a variable at all: masses and loads do not move it.
    fn moves_anything(&self, variable: u32) -> bool {
        let rows: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        self.graph.symbols_of_all(&rows).contains(&self.model.variables[variable as usize].symbol)
    }
}

/// What must stay for none of some formulas to break elsewhere.
fn deciding(graph: &mut Graph, roots: &[ExprId], what: Break) -> Vec<ExprId> {
    graph.reachable(roots).into_iter().flat_map(|id| decided_by(graph, id, what)).collect()
}

/// What is nothing where a number is whole.
fn at_whole_numbers(graph: &mut Graph, of: ExprId) -> ExprId {
    let half_turn = graph.constant(std::f64::consts::PI);
    let turned = graph.mul(half_turn, of);
    graph.unary(Unary::Sin, turned)
}

/// What must stay for a node not to break elsewhere: it breaks where that is nothing.
fn decided_by(graph: &mut Graph, id: ExprId, what: Break) -> Vec<ExprId> {
    let bends = what == Break::Bend;
    match graph.node(id) {
        Node::Compare(_, a, b) => vec![graph.sub(a, b)],
        Node::Binary(Binary::Min | Binary::Max, a, b) if bends => vec![graph.sub(a, b)],
        Node::Binary(Binary::Hypot, ..) if bends => vec![id],
        Node::Binary(Binary::Pow, a, b) if bends => vec![a, b],
        Node::Binary(Binary::Atan2, a, b) => {
            // nothing where the second is negative and the first is nothing
            let length = graph.binary(Binary::Hypot, a, b);
            vec![graph.add(length, b)]
        }
        Node::Binary(Binary::Mod, a, b) => {
            let turns = graph.div(a, b);
            vec![at_whole_numbers(graph, turns)]
        }
        Node::Unary(Unary::Floor, a) => vec![at_whole_numbers(graph, a)],
        Node::Unary(Unary::Sign, a) => vec![a],
        Node::Unary(Unary::Abs | Unary::Sqrt, a) if bends => vec![a],
        Node::Unary(Unary::Asin | Unary::Acos, a) if bends => {
            let (one, square) = (graph.constant(1.0), graph.power(a, 2));
            vec![graph.sub(one, square)]
        }
        // the third derivative of a spline jumps at its knots, which may go too
        Node::Table(table, order, a) if bends || order == 3 => {
            let knots = graph.tables()[table.index()].knots.clone();
            let going = knots.into_iter().filter(|&knot| graph.as_const(knot).is_none()).collect::<Vec<ExprId>>();
            let behind = going.into_iter().map(|knot| graph.sub(a, knot)).collect::<Vec<ExprId>>();
            [vec![a], behind].concat()
        }
        _ => Vec::new(),
    }
}
