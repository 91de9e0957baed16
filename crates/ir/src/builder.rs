//! The parts that a constraint system is built from: the equations as lowering writes them, before anything is derived.

use super::{
    Body, BodyId, CheckSlopes, Condition, ConstraintSystem, Coordinate, Declaration, DeclarationId, Fit, Forces, IdVec,
    Measure, Monitor, OpenContact, Param, PartStart, PartWithDerivatives, Point, PointId, Results, Row, SparseRows,
    Variations,
};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// Equations with their metadata, from which [`ConstraintSystem::of`] derives the system.
#[derive(Debug)]
pub struct Written {
    /// The mechanism's name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Every expression.
    pub graph: Graph,
    /// The parameters, by the number of their symbol.
    pub params: Vec<Param>,
    /// True if the equations contain inputs and time as signals rather than by their formulas.
    pub has_signals: bool,
    /// The bodies, with three coordinates each; the coordinates of joints follow them in `coordinates`.
    pub bodies: IdVec<BodyId, Body>,
    /// Points of the bodies and the ground. No equation refers to them; messages and pictures do.
    pub points: IdVec<PointId, Point>,
    /// The generalized coordinates, by their number.
    pub coordinates: Vec<Coordinate>,
    /// The joints, constraints and drivers that wrote the rows.
    pub declarations: IdVec<DeclarationId, Declaration>,
    /// The entries of `Φ`.
    pub rows: Vec<Row>,
    /// Multipliers and reactions, if the model requests forces.
    pub forces: Option<Forces>,
    /// Derivatives with respect to inputs and parameters, if any are requested.
    pub variations: Option<Box<Variations>>,
    /// Quantities that are tabulated in addition to the coordinates.
    pub measures: Vec<Measure>,
    /// Formulas that must stay positive along the motion.
    pub conditions: Vec<Condition>,
    /// Quantities whose signs distinguish the branches of gears and contacts.
    pub watches: Vec<Monitor>,
    /// Contacts whose start has no estimate; empty once the start has been searched for.
    pub open_contacts: Vec<OpenContact>,
    /// Center distances that gears and racks require but do not enforce.
    pub fits: Vec<Fit>,
    /// Sub-mechanisms with what is needed to assemble them separately.
    pub parts: Vec<PartStart>,
    /// Parts whose texts differentiate by inputs or parameters.
    pub parts_with_derivatives: Vec<PartWithDerivatives>,
    /// Characteristic length L (m): the size of the largest body.
    pub length: f64,
    /// The analysis of the file: first time, last time, step (s).
    pub analysis: Option<[f64; 3]>,
}

impl ConstraintSystem {
    /// Derives a system from equations: `Φ_q`, `ν`, `γ`, with `with_jerk` the right side of the jerk equation, the right sides of the
    /// variations, and the domain boundaries. Inputs, features and results are added later.
    #[must_use]
    pub fn of(written: Written, with_jerk: bool) -> ConstraintSystem {
        let mut system = ConstraintSystem {
            name: written.name,
            span: written.span,
            graph: written.graph,
            params: written.params,
            inputs: Vec::new(),
            has_signals: written.has_signals,
            check_slopes: CheckSlopes::default(),
            bodies: written.bodies,
            points: written.points,
            axes: IdVec::default(),
            circles: IdVec::default(),
            coordinates: written.coordinates,
            declarations: written.declarations,
            rows: written.rows,
            phi_q: SparseRows::new(),
            right_sides: Vec::new(),
            forces: written.forces,
            variations: written.variations,
            measures: written.measures,
            results: Results::default(),
            conditions: written.conditions,
            checks: Vec::new(),
            watches: written.watches,
            domain_boundaries: Vec::new(),
            open_contacts: written.open_contacts,
            fits: written.fits,
            parts: written.parts,
            parts_with_derivatives: written.parts_with_derivatives,
            length: written.length,
            analysis: written.analysis,
            analysis_formulas: None,
        };
        system.derive(with_jerk);
        system.derive_variations();
        system.find_domain_boundaries();
        system
    }
}

impl Written {
    /// Replaces symbols by other expressions in all formulas that hold along the motion: rows, conditions and monitors.
    pub fn substitute(&mut self, mut expression: impl FnMut(&mut Graph, Symbol) -> ExprId) {
        let (before, mut copied) = (self.graph.clone(), FxHashMap::default());
        let Written { graph, rows, conditions, watches, .. } = self;
        let rows = rows.iter_mut().map(|row| &mut row.phi);
        let conditions = conditions.iter_mut().map(|condition| &mut condition.positive);
        let watches = watches.iter_mut().map(|watch| &mut watch.value);
        for id in rows.chain(conditions).chain(watches) {
            graph.import(&before, &[*id], &mut copied, &mut expression);
            *id = copied[id];
        }
    }
}
