//! The constraint system: the mechanism as mathematics, and nothing else.
//!
//! # What it means
//!
//! With `n` generalized coordinates `q` (lengths in metres, angles in radians), time `t` (s) and parameters `p`:
//!
//! - position:     `Φ(q, t; p) = 0`, one entry per row;
//! - velocity:     `Φ_q q̇ = ν`, `ν = −Φ_t`;
//! - acceleration: `Φ_q q̈ = γ`, `γ = −(Φ_q q̇)_q q̇ − 2 Φ_qt q̇ − Φ_tt`;
//! - jerk:         `Φ_q q⃛ = ` [`ConstraintSystem::jerk`], where a measure needs it.
//!
//! Where inputs are signals `u(t)`, `Φ(q, u; p) = 0` and time is one of them; then `Φ_q q_u = −Φ_u` too (`signals`).
//!
//! `Φ` is what `lower` wrote; all else is derived from it by the rules of `expr`. Symbols of the graph are parameters,
//! time, and coordinates with their derivatives; no named symbol is left.
//!
//! # What must hold
//!
//! - Every expression is in the one graph; `Φ_q` holds exactly the entries that do not vanish identically.
//! - Every row knows the declaration that wrote it, with its place in the text, and what it is measured in.
//! - The estimates, and all that depends on parameters alone, hold no other symbol.
//!
//! [`ConstraintSystem::validate`] looks at these and more.

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
mod monitors;
mod print;
pub mod program;
mod results;
mod right_sides;
mod rows;
mod scopes;
mod sparse;
pub mod structure;
pub mod tolerances;
mod validate;
mod variations;

pub use builder::Written;
pub use check_slopes::CheckSlopes;
pub use declarations::{
    Body, Coordinate, CoordinateKind, Declaration, DeclarationKind, Input, Measure, Owner, Param, Units,
};
pub use domain_boundaries::Rim;
pub use features::{Axis, Circle, Point};
pub use forces::{Forces, LoadForce, Mechanics, Press, Reaction};
pub use homotopy::Homotopy;
pub use ids::{AxisId, BodyId, CircleId, DeclarationId, IdVec, PointId};
pub use mechc_text::vocabulary::JointKind;
pub use monitors::{Check, Condition, ConditionKind, Fit, OpenContact, PartStart, Watch, WatchKind};
pub use results::{Outcome, Reduction, ReductionKind, Results};
pub use right_sides::{RightSide, With};
pub use rows::{Row, RowUnit};
pub use scopes::{AskingPart, LEAF_ORDERS, Leaf, Scope, leaf};
pub use sparse::SparseRows;
pub use variations::{Appended, Variable, Variation, Variations};

use mechc_expr::{Dependence, ExprId, Graph, Symbol, TIME_SIGNAL};
use mechc_text::source::Span;

/// A mechanism as equations.
#[derive(Clone, Debug)]
pub struct ConstraintSystem {
    /// The mechanism's name.
    name: String,
    /// The place of that name.
    span: Span,
    /// Every expression.
    graph: Graph,
    /// The parameters, by the number of their symbol.
    params: Vec<Param>,
    /// The inputs, as they are declared; where the equations hold them as signals and time too, this as the last.
    inputs: Vec<Input>,
    /// Whether the equations hold inputs, and time, as signals rather than by their formulas.
    has_signals: bool,
    /// How equations that were left out change, where one of the two is there.
    check_slopes: CheckSlopes,
    /// The bodies, each with three coordinates; those of the joints come after them.
    bodies: IdVec<BodyId, Body>,
    /// Their points and the ground's: the equations know of none, but what is said of them does.
    points: IdVec<PointId, Point>,
    /// Their axes, and the ground's.
    axes: IdVec<AxisId, Axis>,
    /// Their circles, and the ground's.
    circles: IdVec<CircleId, Circle>,
    /// The generalized coordinates, by their number.
    coordinates: Vec<Coordinate>,
    /// The joints, constraints and drivers that wrote the rows.
    declarations: IdVec<DeclarationId, Declaration>,
    /// The entries of `Φ`.
    rows: Vec<Row>,
    /// `Φ_q`, by rows.
    phi_q: SparseRows,
    /// The right sides of the equations that follow from `Φ = 0`.
    right_sides: Vec<RightSide>,
    /// What holds the motion, where somebody asks for it.
    forces: Option<Forces>,
    /// Derivatives by inputs and parameters, where there are any.
    variations: Option<Box<Variations>>,
    /// What is tabulated beside the coordinates.
    measures: Vec<Measure>,
    /// What is asked of the whole analysis.
    results: Results,
    /// Formulas that must stay positive.
    conditions: Vec<Condition>,
    /// Equations that follow from the others, and are looked at instead of solved.
    checks: Vec<Check>,
    /// What tells one branch of a gear or contact from another.
    watches: Vec<Watch>,
    /// Where formulas of the equations come to the end of what their functions take.
    rims: Vec<Rim>,
    /// Contacts that begin where nobody said; none once that is searched for.
    open_contacts: Vec<OpenContact>,
    /// Distances that gears and racks are made for, but do not hold themselves.
    fits: Vec<Fit>,
    /// The parts of the mechanism, as far as their start asks for it.
    parts: Vec<PartStart>,
    /// Parts whose texts ask for derivatives by their own equations.
    asking_parts: Vec<AskingPart>,
    /// Characteristic length L (m): the size of the largest body.
    length: f64,
    /// The file's analysis: first time, last time, step (s).
    analysis: Option<[f64; 3]>,
    /// Their formulas, of parameters alone, where they are known.
    analysis_formulas: Option<[ExprId; 3]>,
}

impl ConstraintSystem {
    /// The total time derivative of expressions: `t ↦ 1`, `q ↦ q̇` and so on, up to the given order of `q`, the
    /// derivatives above which are taken to be zero.
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

    /// `Φ_q`, `ν`, `γ`, and the jerk's right side if wanted, of rows of `Φ`.
    fn derive(&mut self, with_jerk: bool) {
        self.phi_q = SparseRows::new();
        for row in self.phi() {
            self.phi_q.push(self.graph.slopes(row, 0));
        }
        self.derive_by_time(with_jerk);
    }

    /// `Φ`, row by row.
    #[must_use]
    pub fn phi(&self) -> Vec<ExprId> {
        self.rows.iter().map(|row| row.phi).collect()
    }

    /// Where a signal stands among the inputs: time is the last.
    #[must_use]
    pub fn signal_place(&self, index: u32) -> usize {
        if index == TIME_SIGNAL { self.inputs.len().saturating_sub(1) } else { index as usize }
    }

    /// The declaration behind a row.
    #[must_use]
    pub fn declaration_of(&self, row: usize) -> &Declaration {
        &self.declarations[self.rows[row].declaration]
    }

    /// Whether a row is a driver's.
    #[must_use]
    pub fn is_driver(&self, row: usize) -> bool {
        self.declaration_of(row).kind == DeclarationKind::Driver
    }

    /// Whether an equation moves the mechanism: one of a driver does, and one that holds time.
    #[must_use]
    pub fn drives(&self, declaration: DeclarationId, phi: ExprId) -> bool {
        let is_driver = self.declarations[declaration].kind == DeclarationKind::Driver;
        is_driver || self.graph.dependence(phi).on(Dependence::TIME)
    }

    /// Takes rows out, given ascending, which are checked from now on.
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

    /// What some rows are checked by, judged by their slopes at the estimates.
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

    /// The body that a coordinate is of, if it is of a body.
    #[must_use]
    pub fn body_of(&self, coordinate: usize) -> Option<BodyId> {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => Some(body),
            Owner::Joint(_) => None,
        }
    }

    /// The coordinates of a body: x, y, phi.
    #[must_use]
    pub fn pose_of(&self, body: BodyId) -> [usize; 3] {
        self.bodies[body].pose
    }

    /// The size of a body (m): what a change of its place is judged against.
    #[must_use]
    pub fn size_of(&self, body: BodyId) -> f64 {
        let [x, ..] = self.pose_of(body);
        self.coordinates[x].scale
    }

    /// How a point is written, `rod.pin`; a literal one has no name.
    #[must_use]
    pub fn point_name(&self, point: PointId) -> Option<String> {
        let point = &self.points[point];
        let owner = point.body.map_or("ground", |body| self.bodies[body].name.as_str());
        point.name.as_ref().map(|name| format!("{owner}.{name}"))
    }

    /// The name of the body or joint that a coordinate is of.
    #[must_use]
    pub fn owner_name(&self, coordinate: usize) -> &str {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => &self.bodies[body].name,
            Owner::Joint(joint) => &self.declarations[joint].name,
        }
    }

    /// The place of the body or joint that a coordinate is of.
    #[must_use]
    pub fn owner_span(&self, coordinate: usize) -> Span {
        match self.coordinates[coordinate].owner {
            Owner::Body(body) => self.bodies[body].span,
            Owner::Joint(joint) => self.declarations[joint].span,
        }
    }

    /// The value of a formula of parameters and coordinates, at a position. Walks the graph: not for the time loop.
    #[must_use]
    pub fn value_at(&self, formula: ExprId, q: &[f64]) -> f64 {
        self.graph.value(formula, |symbol| match symbol {
            Symbol::Param(k) => self.params[k as usize].value,
            Symbol::Shift(_) => 0.0,
            Symbol::Coordinate { index, order: 0 } => q[index as usize],
            _ => f64::NAN,
        })
    }

    /// Coordinates minus equations.
    #[must_use]
    pub fn ndof(&self) -> isize {
        self.coordinates.len().cast_signed() - self.rows.len().cast_signed()
    }
}
