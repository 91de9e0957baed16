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
//! Where inputs are signals `u(t)`, `Φ(q, u; p) = 0` and time is one of them; then `Φ_q q_u = −Φ_u` too ([`signals`]).
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

mod equations_of;
mod features;
mod forces;
mod ids;
mod print;
mod results;
mod right_sides;
mod rims;
mod rows;
mod scopes;
mod signals;
mod sparse;
mod validate;
mod variations;

pub use crate::vocabulary::JointKind;
pub use features::{Axis, Circle, Point};
pub use forces::{Forces, LoadForce, Press, Reaction};
pub use ids::{AxisId, BodyId, CircleId, DeclarationId, IdVec, PointId};
pub use results::{Outcome, Reduction, ReductionKind, Results};
pub use right_sides::{RightSide, With};
pub use rims::Rim;
pub use rows::{Row, RowUnit};
pub use scopes::{AskingPart, LEAF_ORDERS, Leaf, Scope, leaf};
pub use signals::CheckSlopes;
pub use sparse::SparseRows;
pub use variations::{Appended, Variable, Variation, Variations};

use crate::expr::{Dependence, ExprId, Graph, Symbol, TIME_SIGNAL, TableId};
use crate::source::Span;
use crate::vocabulary::Dimension;
use std::ops::Range;

/// A mechanism as equations.
#[derive(Clone, Debug)]
pub struct ConstraintSystem {
    /// The mechanism's name.
    pub name: String,
    /// The place of that name.
    pub span: Span,
    /// Every expression.
    pub graph: Graph,
    /// The parameters, by the number of their symbol.
    pub params: Vec<Param>,
    /// The inputs, as they are declared; where the equations hold them as signals and time too, this as the last.
    pub inputs: Vec<Input>,
    /// Whether the equations hold inputs, and time, as signals rather than by their formulas.
    pub has_signals: bool,
    /// How equations that were left out change, where one of the two is there.
    pub check_slopes: CheckSlopes,
    /// The bodies, each with three coordinates; those of the joints come after them.
    pub bodies: IdVec<BodyId, Body>,
    /// Their points and the ground's: the equations know of none, but what is said of them does.
    pub points: IdVec<PointId, Point>,
    /// Their axes, and the ground's.
    pub axes: IdVec<AxisId, Axis>,
    /// Their circles, and the ground's.
    pub circles: IdVec<CircleId, Circle>,
    /// The generalized coordinates, by their number.
    pub coordinates: Vec<Coordinate>,
    /// The joints, constraints and drivers that wrote the rows.
    pub declarations: IdVec<DeclarationId, Declaration>,
    /// The entries of `Φ`.
    pub rows: Vec<Row>,
    /// `Φ_q`, by rows.
    pub phi_q: SparseRows,
    /// The right sides of the equations that follow from `Φ = 0`.
    right_sides: Vec<RightSide>,
    /// What holds the motion, where somebody asks for it.
    pub forces: Option<Forces>,
    /// Derivatives by inputs and parameters, where there are any.
    pub variations: Option<Box<Variations>>,
    /// What is tabulated beside the coordinates.
    pub measures: Vec<Measure>,
    /// What is asked of the whole analysis.
    pub results: Results,
    /// Formulas that must stay positive.
    pub conditions: Vec<Condition>,
    /// Equations that follow from the others, and are looked at instead of solved.
    pub checks: Vec<Check>,
    /// What tells one branch of a gear or contact from another.
    pub watches: Vec<Watch>,
    /// Where formulas of the equations come to the end of what their functions take.
    pub rims: Vec<Rim>,
    /// Contacts that begin where nobody said; none once that is searched for.
    pub open_contacts: Vec<OpenContact>,
    /// Distances that gears and racks are made for, but do not hold themselves.
    pub fits: Vec<Fit>,
    /// The parts of the mechanism, as far as their start asks for it.
    pub parts: Vec<PartStart>,
    /// Parts whose texts ask for derivatives by their own equations.
    pub asking_parts: Vec<AskingPart>,
    /// Characteristic length L (m): the size of the largest body.
    pub length: f64,
    /// The file's analysis: first time, last time, step (s).
    pub analysis: Option<[f64; 3]>,
}

/// A parameter with its value in SI.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// How many bytes of it are the path of its part, the last dot too; 0 of one of the mechanism's own.
    pub part: usize,
    /// Its value in SI.
    pub value: f64,
    /// Of its value; that of a plain number is pure, whatever it stands for.
    pub dimension: Dimension,
    /// The name's place.
    pub span: Span,
}

impl Param {
    /// Its SI unit: `m`, `1/s`, or `1` for a pure number.
    #[must_use]
    pub fn unit(&self) -> String {
        self.dimension.unit()
    }
}

/// A signal that comes from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// The number of its signal's symbol.
    pub index: u32,
    /// Its SI unit: `m`, `1/s`, or `1` for a pure number.
    pub unit: String,
    /// The name's place.
    pub span: Span,
    /// By the text: its value, rate and acceleration, as formulas of time.
    pub formulas: [ExprId; 3],
}

impl Input {
    /// The symbol of its value.
    #[must_use]
    pub fn symbol(&self) -> Symbol {
        Symbol::Signal { index: self.index, order: 0 }
    }

    /// Whether it is time, which is one where formulas hold it beside inputs.
    #[must_use]
    pub fn is_time(&self) -> bool {
        self.index == TIME_SIGNAL
    }
}

/// A body with its place in the text.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// The name's place.
    pub span: Span,
    /// Where its pose is written, if it is.
    pub pose_span: Option<Span>,
    /// Its coordinates: x, y, phi.
    pub pose: [usize; 3],
}

/// What a coordinate measures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CoordinateKind {
    /// In metres.
    Length,
    /// In radians.
    Angle,
    /// A pure number: the argument of a curve at a contact, or the angle on a circle that serves as one.
    Argument,
}

impl CoordinateKind {
    /// The SI unit; none for a pure number.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            CoordinateKind::Length => "m",
            CoordinateKind::Angle => "rad",
            CoordinateKind::Argument => "",
        }
    }
}

/// Whose a coordinate is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Owner {
    /// A body.
    Body(BodyId),
    /// A joint, by its declaration.
    Joint(DeclarationId),
}

/// A generalized coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// `crank.phi`
    pub name: String,
    /// Whose it is.
    pub owner: Owner,
    /// What it measures.
    pub kind: CoordinateKind,
    /// Where assembly starts; holds parameters only.
    pub estimate: ExprId,
    /// What a change of it is judged against: the size of its body (m), or 1 (rad).
    pub scale: f64,
}

/// What kind of declaration wrote a row.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum DeclarationKind {
    /// A joint.
    Joint(JointKind),
    /// A constraint.
    Constraint,
    /// A driver.
    Driver,
}

impl DeclarationKind {
    /// `joint`, `constraint` or `driver`.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            DeclarationKind::Joint(_) => "joint",
            DeclarationKind::Constraint => "constraint",
            DeclarationKind::Driver => "driver",
        }
    }
}

/// A joint, constraint or driver.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Its name.
    pub name: String,
    /// The name's place.
    pub span: Span,
    /// Which kind.
    pub kind: DeclarationKind,
    /// How many rows it wrote.
    pub rows: usize,
    /// Where it takes hold: one point for each of its two bodies where there is one.
    pub points: Vec<PointId>,
    /// All points that its equations speak of.
    pub features: Vec<PointId>,
    /// The axes that it joins.
    pub axes: Vec<AxisId>,
    /// The circles that it joins.
    pub circles: Vec<CircleId>,
    /// Where a joint takes hold (m), in the ground's frame, as a formula of the coordinates: at its second point, the point of its second
    /// axis, the centre of its second circle, or the contact.
    pub at: Option<[ExprId; 2]>,
    /// Where the two sides of an equation are written.
    pub written: Option<Span>,
    /// Whether formulas speak of this joint: of its rotation or displacement.
    pub is_spoken_of: bool,
}

/// A number to tabulate, with the time derivatives that can be had.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: ExprId,
    /// Its first time derivative, if that needs no fourth derivative of `q`.
    pub first: Option<ExprId>,
    /// Its second time derivative, likewise.
    pub second: Option<ExprId>,
    /// The name's place.
    pub span: Span,
    /// In what it is printed.
    pub units: Units,
}

impl Measure {
    /// Its value (order 0), first or second time derivative, if that can be had.
    #[must_use]
    pub fn derivative(&self, order: usize) -> Option<ExprId> {
        [Some(self.value), self.first, self.second][order]
    }

    /// Whether it has a value (0), a first time derivative (1), a second one (2).
    #[must_use]
    pub fn has(&self, order: usize) -> bool {
        self.derivative(order).is_some()
    }
}

/// The units of a measure and of its derivatives.
#[derive(Clone, Debug)]
pub struct Units {
    /// The SI unit of its value: `m`, `rad/s`, or `1` for a pure number.
    pub si: String,
    /// Those in which it, its first and its second time derivative are printed.
    pub printed: [String; 3],
    /// What SI is divided by, multiplied with and divided by to be in these.
    pub scale: [f64; 3],
}

/// A formula that must be above zero.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The formula.
    pub positive: ExprId,
    /// What it is about.
    pub kind: ConditionKind,
    /// The formula's place.
    pub span: Span,
    /// The declaration that asks for it.
    pub owner: String,
}

/// An equation that follows from the others.
#[derive(Clone, Debug)]
pub struct Check {
    /// The entry of `Φ`.
    pub phi: ExprId,
    /// What that is measured in.
    pub unit: RowUnit,
    /// The declaration that wrote it.
    pub declaration: DeclarationId,
    /// Its norm in the scaled `Φ_q` at the start.
    pub scale: f64,
}

/// A quantity that keeps its sign along a branch of the motion, and only there.
#[derive(Clone, Debug)]
pub struct Watch {
    /// The quantity.
    pub value: ExprId,
    /// What it is.
    pub kind: WatchKind,
    /// What it is judged against.
    pub scale: f64,
    /// The joint's declaration.
    pub declaration: DeclarationId,
}

/// What a [`Watch`] looks at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WatchKind {
    /// The way from centre to centre along the line of centres; it must be positive.
    LineOfCenters,
    /// One tangent at a contact along the other; zero where a tangent vanishes.
    Tangents,
    /// The relative curvature at a contact; zero where the contact is singular.
    Curvature,
}

/// What the start of a part needs: it is assembled alone, led to what its inputs are, and carried to where its mount is.
#[derive(Clone, Debug)]
pub struct PartStart {
    /// Its name.
    pub name: String,
    /// Where that stands.
    pub span: Span,
    /// The name of its mechanism, in the text of that.
    pub text: Span,
    /// What its params are that are bound (SI), by their names there; a coordinate of a point has its own.
    pub params: Vec<(String, ExprId)>,
    /// What its inputs are (SI), over the coordinates and time.
    pub inputs: Vec<(String, ExprId)>,
    /// Where its ground is: x (m), y (m), phi (rad).
    pub mount: [ExprId; 3],
    /// Whether its text is mirrored.
    pub is_mirrored: bool,
    /// Its bodies.
    pub bodies: Vec<BodyId>,
    /// The coordinates of these.
    pub poses: Range<usize>,
    /// The coordinates that its joints bring along.
    pub own: Range<usize>,
}

/// A contact with arguments that no curve gives an estimate of.
#[derive(Clone, Debug)]
pub struct OpenContact {
    /// The joint's declaration.
    pub declaration: DeclarationId,
    /// These arguments, by the numbers of their coordinates.
    pub arguments: Vec<u32>,
    /// What must be positive for its curves to have a point.
    pub conditions: Vec<ExprId>,
}

/// A distance in the assembled start, and what it should be.
#[derive(Clone, Debug)]
pub struct Fit {
    /// As it is (m).
    pub distance: ExprId,
    /// As the radii have it (m).
    pub wanted: ExprId,
    /// The larger radius (m).
    pub radius: ExprId,
    /// The joint's declaration.
    pub declaration: DeclarationId,
}

/// What a condition is about.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// A prescribed distance.
    Distance,
    /// The interval of a motion function.
    Interval,
    /// The range of a table.
    Range(TableId),
    /// The times of the samples of an input.
    Samples(TableId),
}

impl ConstraintSystem {
    /// One with nothing in it, of a name and its place.
    #[must_use]
    pub fn empty(name: String, span: Span) -> ConstraintSystem {
        ConstraintSystem {
            name,
            span,
            graph: Graph::new(),
            params: Vec::new(),
            inputs: Vec::new(),
            has_signals: false,
            check_slopes: CheckSlopes::default(),
            bodies: IdVec::default(),
            points: IdVec::default(),
            axes: IdVec::default(),
            circles: IdVec::default(),
            coordinates: Vec::new(),
            declarations: IdVec::default(),
            rows: Vec::new(),
            phi_q: SparseRows::new(),
            right_sides: Vec::new(),
            forces: None,
            variations: None,
            measures: Vec::new(),
            results: Results::default(),
            conditions: Vec::new(),
            checks: Vec::new(),
            watches: Vec::new(),
            rims: Vec::new(),
            open_contacts: Vec::new(),
            fits: Vec::new(),
            parts: Vec::new(),
            asking_parts: Vec::new(),
            length: 0.0,
            analysis: None,
        }
    }

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
    pub fn derive(&mut self, with_jerk: bool) {
        self.phi_q = SparseRows::new();
        for row in self.phi() {
            let gradient = self.graph.gradient(row, Dependence::coordinates(0));
            self.phi_q.push(gradient.into_iter().filter_map(|(symbol, slope)| match symbol {
                Symbol::Coordinate { index, order: 0 } => Some((index, slope)),
                _ => None,
            }));
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

    /// Takes rows out, which are checked from now on.
    pub fn leave_out(&mut self, rows: &[usize], checks: Vec<Check>) {
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
