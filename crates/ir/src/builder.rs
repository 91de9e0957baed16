//! What a system is made of: the equations as they are written, of which nothing is derived.

use super::{
    AskingPart, Body, BodyId, CheckSlopes, Condition, ConstraintSystem, Coordinate, Declaration, DeclarationId, Fit,
    Forces, IdVec, Measure, OpenContact, Param, PartStart, Point, PointId, Results, Row, SparseRows, Variations, Watch,
};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// Equations with all that is said of them.
#[derive(Debug)]
pub struct Written {
    /// The mechanism's name.
    pub name: String,
    /// The place of that name.
    pub span: Span,
    /// Every expression.
    pub graph: Graph,
    /// The parameters, by the number of their symbol.
    pub params: Vec<Param>,
    /// Whether the equations hold inputs, and time, as signals rather than by their formulas.
    pub has_signals: bool,
    /// The bodies, each with three coordinates; those of the joints come after them.
    pub bodies: IdVec<BodyId, Body>,
    /// Their points and the ground's: the equations know of none, but what is said of them does.
    pub points: IdVec<PointId, Point>,
    /// The generalized coordinates, by their number.
    pub coordinates: Vec<Coordinate>,
    /// The joints, constraints and drivers that wrote the rows.
    pub declarations: IdVec<DeclarationId, Declaration>,
    /// The entries of `Φ`.
    pub rows: Vec<Row>,
    /// What holds the motion, where somebody asks for it.
    pub forces: Option<Forces>,
    /// Derivatives by inputs and parameters, where there are any.
    pub variations: Option<Box<Variations>>,
    /// What is tabulated beside the coordinates.
    pub measures: Vec<Measure>,
    /// Formulas that must stay positive.
    pub conditions: Vec<Condition>,
    /// What tells one branch of a gear or contact from another.
    pub watches: Vec<Watch>,
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

impl ConstraintSystem {
    /// The system of these equations, with `Φ_q`, `ν`, `γ`, the jerk's right side where that is wanted, the right sides of the
    /// derivatives by inputs and parameters, and the rims. It has no inputs, features and results yet.
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
            rims: Vec::new(),
            open_contacts: written.open_contacts,
            fits: written.fits,
            parts: written.parts,
            asking_parts: written.asking_parts,
            length: written.length,
            analysis: written.analysis,
            analysis_formulas: None,
        };
        system.derive(with_jerk);
        system.derive_variations();
        system.find_rims();
        system
    }
}

impl Written {
    /// Puts other expressions in the place of symbols, in all that holds on a motion: rows, conditions and watches.
    pub fn substitute(&mut self, mut expression: impl FnMut(&mut Graph, Symbol) -> ExprId) {
        let (before, mut known) = (self.graph.clone(), FxHashMap::default());
        let Written { graph, rows, conditions, watches, .. } = self;
        let rows = rows.iter_mut().map(|row| &mut row.phi);
        let conditions = conditions.iter_mut().map(|condition| &mut condition.positive);
        let watches = watches.iter_mut().map(|watch| &mut watch.value);
        for id in rows.chain(conditions).chain(watches) {
            graph.import(&before, &[*id], &mut known, &mut expression);
            *id = known[id];
        }
    }
}
