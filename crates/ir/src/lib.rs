//! The constraint system: a mechanism as equations, independent of syntax and solver.
//!
//! # Meaning
//!
//! With `n` generalized coordinates `q` (lengths in metres, angles in radians), time `t` (s) and parameters `p`:
//!
//! - position:     `Φ(q, t; p) = 0`, one entry per row;
//! - velocity:     `Φ_q q̇ = ν`, `ν = −Φ_t`;
//! - acceleration: `Φ_q q̈ = γ`, `γ = −(Φ_q q̇)_q q̇ − 2 Φ_qt q̇ − Φ_tt`;
//! - jerk:         `Φ_q q⃛ = ` [`ConstraintSystem::jerk`], where a measure needs it.
//!
//! With inputs as signals `u(t)`, the equations are `Φ(q, u; p) = 0` and time is one of the signals; then also `Φ_q q_u = −Φ_u`.
//!
//! `lower` writes `Φ`; everything else is derived from it by the rules of `expr`. The symbols of the graph are parameters, time or signals,
//! coordinates and multipliers with their derivatives, and named symbols for reductions in results.
//!
//! # Invariants
//!
//! - All expressions belong to one graph; `Φ_q` holds exactly the entries that do not vanish identically.
//! - Every row has the declaration that wrote it, its source span and its unit.
//! - Estimates, and everything else that depends on parameters alone, contain no other symbols.
//!
//! [`ConstraintSystem::validate`] checks these and more.

mod accessors;
mod builder;
mod check_slopes;
mod declarations;
mod domain_boundaries;
mod features;
mod forces;
mod homotopy;
mod ids;
pub mod layout;
pub mod limits;
mod monitors;
mod print;
pub mod program;
mod results;
mod right_sides;
mod rows;
mod sparse;
pub mod structure;
mod validate;
mod variations;

pub use builder::Written;
pub use check_slopes::CheckSlopes;
pub use declarations::{
    Body, Coordinate, CoordinateKind, Declaration, DeclarationKind, Input, Measure, Owner, Param, Units,
};
pub use domain_boundaries::DomainBoundary;
pub use features::{Axis, Circle, Point};
pub use forces::{ContactForce, Forces, LoadForce, Mechanics, Reaction};
pub use homotopy::Homotopy;
pub use ids::{AxisId, BodyId, CircleId, DeclarationId, IdVec, PointId};
pub use mechc_text::vocabulary::JointSpec;
pub use monitors::{
    Check, Condition, ConditionKind, Fit, Monitor, MonitorKind, OpenContact, PartStart, PartWithDerivatives,
};
pub use results::{Bound, Outcome, Reduction, ReductionKind, Requirement, RequirementTimes, Results};
pub use right_sides::{RightSide, With};
pub use rows::Row;
pub use sparse::SparseRows;
pub use variations::{DerivativeColumn, Variable, Variation, Variations};

use mechc_expr::{Dependence, ExprId, Graph, Symbol, TIME_SIGNAL};
use mechc_text::source::Span;

/// A mechanism as equations `Φ(q, t; p) = 0`, with what is derived from them.
#[derive(Clone, Debug)]
pub struct ConstraintSystem {
    /// The mechanism's name.
    name: String,
    /// Span of the name.
    span: Span,
    /// Graph that holds every expression.
    graph: Graph,
    /// The parameters, by the number of their symbol.
    params: Vec<Param>,
    /// The inputs as declared; with signals, time follows as the last one.
    inputs: Vec<Input>,
    /// True if the equations contain inputs and time as signals rather than by their formulas.
    has_signals: bool,
    /// Slopes of the left-out equations, if there are left-out equations and inputs or parameters to differentiate by.
    check_slopes: CheckSlopes,
    /// The bodies, with three coordinates each; the coordinates of joints follow them in `coordinates`.
    bodies: IdVec<BodyId, Body>,
    /// Points of the bodies and the ground. No equation refers to them; messages and pictures do.
    points: IdVec<PointId, Point>,
    /// Axes of the bodies and the ground.
    axes: IdVec<AxisId, Axis>,
    /// Circles of the bodies and the ground.
    circles: IdVec<CircleId, Circle>,
    /// The generalized coordinates, by their number.
    coordinates: Vec<Coordinate>,
    /// The joints, constraints and drivers that wrote the rows.
    declarations: IdVec<DeclarationId, Declaration>,
    /// The equations, one entry of `Φ` each.
    rows: Vec<Row>,
    /// `Φ_q`, by rows.
    phi_q: SparseRows,
    /// Right sides of the equations that follow from `Φ = 0` by differentiation.
    right_sides: Vec<RightSide>,
    /// Multipliers and reactions, if the model requests forces.
    forces: Option<Forces>,
    /// Derivatives with respect to inputs and parameters, if any are requested.
    variations: Option<Box<Variations>>,
    /// Quantities that are tabulated in addition to the coordinates.
    measures: Vec<Measure>,
    /// Results over the whole analysis.
    results: Results,
    /// Formulas that must stay positive along the motion.
    conditions: Vec<Condition>,
    /// Redundant equations, which are checked instead of solved.
    checks: Vec<Check>,
    /// Quantities whose signs distinguish the branches of gears and contacts.
    watches: Vec<Monitor>,
    /// Boundaries of the domains of functions in the equations.
    domain_boundaries: Vec<DomainBoundary>,
    /// Contacts whose start has no estimate; empty once the start has been searched for.
    open_contacts: Vec<OpenContact>,
    /// Center distances that gears and racks require but do not enforce.
    fits: Vec<Fit>,
    /// Sub-mechanisms with what is needed to assemble them separately.
    parts: Vec<PartStart>,
    /// Parts whose texts differentiate by inputs or parameters.
    parts_with_derivatives: Vec<PartWithDerivatives>,
    /// Characteristic length L (m): the size of the largest body.
    length: f64,
    /// The analysis of the file: first time, last time, step (s).
    analysis: Option<[f64; 3]>,
    /// Formulas of these times over parameters alone, if available.
    analysis_formulas: Option<[ExprId; 3]>,
}

impl ConstraintSystem {
    /// Returns the total time derivatives of expressions, by `t ↦ 1`, `q ↦ q̇` and so on. Derivatives of `q` above the order `highest` are
    /// taken to be zero.
    pub fn time_derivatives(graph: &mut Graph, roots: &[ExprId], highest: u8) -> Vec<ExprId> {
        graph.derivatives(roots, |graph, symbol| match symbol {
            Symbol::Time => Some(graph.constant(1.0)),
            Symbol::Signal { index: TIME_SIGNAL, order: 1.. } => None,
            Symbol::Signal { index, order } => Some(graph.symbol(Symbol::Signal { index, order: order + 1 })),
            Symbol::Coordinate { index, order } if order < highest => {
                Some(graph.symbol(Symbol::Coordinate { index, order: order + 1 }))
            }
            Symbol::Varied { index, order, variation } if order < highest.min(2) => {
                Some(graph.symbol(Symbol::Varied { index, order: order + 1, variation }))
            }
            _ => None,
        })
    }

    /// Derives `Φ_q`, `ν`, `γ`, and with `with_jerk` the right side of the jerk equation.
    fn derive(&mut self, with_jerk: bool) {
        self.phi_q = SparseRows::new();
        for row in self.phi() {
            self.phi_q.push(self.graph.slopes(row, 0));
        }
        self.derive_by_time(with_jerk);
    }

    /// Returns `Φ`, row by row.
    #[must_use]
    pub fn phi(&self) -> Vec<ExprId> {
        self.rows.iter().map(|row| row.phi).collect()
    }

    /// Returns the position of a signal among the inputs; time is the last.
    #[must_use]
    pub(crate) fn signal_position(&self, index: u32) -> usize {
        if index == TIME_SIGNAL { self.inputs.len().saturating_sub(1) } else { index as usize }
    }

    /// Returns the declaration that wrote a row.
    #[must_use]
    pub fn declaration_of(&self, row: usize) -> &Declaration {
        &self.declarations[self.rows[row].declaration]
    }

    /// Returns whether a driver wrote a row.
    #[must_use]
    pub fn is_driver(&self, row: usize) -> bool {
        self.declaration_of(row).kind == DeclarationKind::Driver
    }

    /// Returns whether an equation moves the mechanism: it belongs to a driver or contains time.
    #[must_use]
    pub fn drives(&self, declaration: DeclarationId, phi: ExprId) -> bool {
        let is_driver = self.declarations[declaration].kind == DeclarationKind::Driver;
        is_driver || self.graph.dependence(phi).on(Dependence::TIME)
    }

    /// Removes rows, given in ascending order, and checks them from now on instead of solving them.
    pub fn leave_out(&mut self, rows: &[usize]) {
        let checks = self.checks_of(rows);
        let stays = |k: &usize| rows.binary_search(k).is_err();
        let kept: Vec<usize> = (0..self.rows.len()).filter(stays).collect();
        self.renumber_multipliers(&kept);
        self.rows = kept.iter().map(|&row| self.rows[row]).collect();
        self.phi_q = self.phi_q.of_rows(&kept);
        self.right_sides.iter_mut().for_each(|side| side.keep(&kept));
        for check in &checks {
            self.declarations[check.declaration].rows -= 1;
        }
        self.checks = checks;
        self.leave_out_of_variations(&kept);
        self.derive_checks();
        debug_assert_eq!(self.validate(), Ok(()));
    }

    /// Returns the checks for some rows. Their scales are the norms of the scaled slopes at the estimates.
    fn checks_of(&self, rows: &[usize]) -> Vec<Check> {
        let q: Vec<f64> = self.coordinates.iter().map(|coordinate| self.value_at(coordinate.estimate, &[])).collect();
        let check = |&row: &usize| {
            let slopes = self
                .phi_q
                .row(row)
                .iter()
                .map(|&(column, slope)| self.value_at(slope, &q) * self.coordinates[column as usize].scale);
            let norm = slopes.filter(|slope| slope.is_finite()).map(|slope| slope * slope).sum::<f64>().sqrt();
            let scale = if norm > 0.0 { norm } else { 1.0 };
            let Row { declaration, phi, unit } = self.rows[row];
            Check { phi, unit, declaration, scale }
        };
        rows.iter().map(check).collect()
    }

    /// Returns the body that a coordinate belongs to; `None` for a coordinate of a joint.
    #[must_use]
    pub fn body_of(&self, coordinate: usize) -> Option<BodyId> {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => Some(body),
            Owner::Joint(_) => None,
        }
    }

    /// Returns the coordinates of a body: x, y, phi.
    #[must_use]
    pub fn pose_of(&self, body: BodyId) -> [usize; 3] {
        self.bodies[body].pose
    }

    /// Returns the size of a body (m), the scale for changes of its position.
    #[must_use]
    pub fn size_of(&self, body: BodyId) -> f64 {
        let [x, ..] = self.pose_of(body);
        self.coordinates[x].scale
    }

    /// Returns the full name of a point, such as `rod.pin`; `None` for an unnamed point.
    #[must_use]
    pub fn point_name(&self, point: PointId) -> Option<String> {
        let point = &self.points[point];
        let owner = point.body.map_or("ground", |body| self.bodies[body].name.as_str());
        point.name.as_ref().map(|name| format!("{owner}.{name}"))
    }

    /// Returns the name of the body or joint that a coordinate belongs to.
    #[must_use]
    pub fn owner_name(&self, coordinate: usize) -> &str {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => &self.bodies[body].name,
            Owner::Joint(joint) => &self.declarations[joint].name,
        }
    }

    /// Returns the span of the name of the body or joint that a coordinate belongs to.
    #[must_use]
    pub fn owner_span(&self, coordinate: usize) -> Span {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => self.bodies[body].span,
            Owner::Joint(joint) => self.declarations[joint].span,
        }
    }

    /// Returns the value of a formula of parameters and coordinates at a position `q`. Walks the graph, so it is too slow for the time loop.
    #[must_use]
    pub fn value_at(&self, formula: ExprId, q: &[f64]) -> f64 {
        self.graph.value(formula, |symbol| match symbol {
            Symbol::Param(k) => self.params[k as usize].value,
            Symbol::Shift(_) => 0.0,
            Symbol::Coordinate { index, order: 0 } => q[index as usize],
            _ => f64::NAN,
        })
    }

    /// Returns the number of degrees of freedom: coordinates minus equations.
    #[must_use]
    pub fn ndof(&self) -> isize {
        self.coordinates.len().cast_signed() - self.rows.len().cast_signed()
    }
}
