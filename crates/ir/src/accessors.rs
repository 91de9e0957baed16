//! Accessors of a system, and the few additions that are made after it has been built.

use super::{
    Axis, AxisId, Body, BodyId, Check, CheckSlopes, Circle, CircleId, Condition, ConstraintSystem, Coordinate,
    Declaration, DeclarationId, DomainBoundary, Fit, Forces, IdVec, Input, Measure, Monitor, OpenContact, Param,
    PartStart, PartWithDerivatives, Point, PointId, Results, Row, SparseRows, Variable, Variations,
};
use mechc_expr::{ExprId, Graph};
use mechc_text::source::Span;

impl ConstraintSystem {
    /// Returns the mechanism's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the span of the name.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// Returns the graph that holds every expression.
    #[must_use]
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Returns the parameters, by the number of their symbol.
    #[must_use]
    pub fn params(&self) -> &[Param] {
        &self.params
    }

    /// Returns the inputs as declared; with signals, time follows as the last one.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Returns whether the equations contain inputs and time as signals rather than by their formulas.
    #[must_use]
    pub fn has_signals(&self) -> bool {
        self.has_signals
    }

    /// Returns the slopes of the left-out equations; empty without left-out equations, or without variables to differentiate by.
    #[must_use]
    pub fn check_slopes(&self) -> &CheckSlopes {
        &self.check_slopes
    }

    /// Returns the bodies, with three coordinates each; the coordinates of joints follow them.
    #[must_use]
    pub fn bodies(&self) -> &IdVec<BodyId, Body> {
        &self.bodies
    }

    /// Returns the points of the bodies and the ground. No equation refers to them; messages and pictures do.
    #[must_use]
    pub fn points(&self) -> &IdVec<PointId, Point> {
        &self.points
    }

    /// Returns the axes of the bodies and the ground.
    #[must_use]
    pub fn axes(&self) -> &IdVec<AxisId, Axis> {
        &self.axes
    }

    /// Returns the circles of the bodies and the ground.
    #[must_use]
    pub fn circles(&self) -> &IdVec<CircleId, Circle> {
        &self.circles
    }

    /// Returns the generalized coordinates, by number.
    #[must_use]
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// Returns the joints, constraints and drivers that wrote the rows.
    #[must_use]
    pub fn declarations(&self) -> &IdVec<DeclarationId, Declaration> {
        &self.declarations
    }

    /// Returns the equations, one entry of `Φ` each.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Returns `Φ_q`, by rows.
    #[must_use]
    pub fn phi_q(&self) -> &SparseRows {
        &self.phi_q
    }

    /// Returns the multipliers and reactions; `None` if the model requests no forces.
    #[must_use]
    pub fn forces(&self) -> Option<&Forces> {
        self.forces.as_ref()
    }

    /// Returns the quantities that are tabulated in addition to the coordinates.
    #[must_use]
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// Returns the results over the whole analysis.
    #[must_use]
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// Returns the formulas that must stay positive along the motion.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// Returns the redundant equations that are checked instead of solved.
    #[must_use]
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// Returns the quantities whose signs distinguish the branches of gears and contacts.
    #[must_use]
    pub fn monitors(&self) -> &[Monitor] {
        &self.watches
    }

    /// Returns the boundaries of the domains of functions in the equations.
    #[must_use]
    pub fn domain_boundaries(&self) -> &[DomainBoundary] {
        &self.domain_boundaries
    }

    /// Returns the contacts whose start has no estimate; empty once the start has been searched for.
    #[must_use]
    pub fn open_contacts(&self) -> &[OpenContact] {
        &self.open_contacts
    }

    /// Returns the center distances that gears and racks require but do not enforce.
    #[must_use]
    pub fn fits(&self) -> &[Fit] {
        &self.fits
    }

    /// Returns the sub-mechanisms with what is needed to assemble them separately.
    #[must_use]
    pub fn parts(&self) -> &[PartStart] {
        &self.parts
    }

    /// Returns the parts whose texts differentiate by inputs or parameters.
    #[must_use]
    pub fn parts_with_derivatives(&self) -> &[PartWithDerivatives] {
        &self.parts_with_derivatives
    }

    /// Returns the characteristic length L (m): the size of the largest body.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the analysis of the file: first time, last time, step (s).
    #[must_use]
    pub fn analysis(&self) -> Option<[f64; 3]> {
        self.analysis
    }

    /// Returns the values of the parameters, in the order of their symbols.
    #[must_use]
    pub fn param_values(&self) -> Vec<f64> {
        self.params.iter().map(|param| param.value).collect()
    }

    /// Returns the same mechanism with other parameter values, in the order of their symbols. The scales of coordinates, and estimates of
    /// contacts that were searched for, keep the values of the old parameters.
    #[must_use]
    pub fn with_values(&self, values: &[f64]) -> ConstraintSystem {
        let mut system = self.clone();
        for (param, value) in system.params.iter_mut().zip(values) {
            param.value = *value;
        }
        if let Some(formulas) = system.analysis_formulas {
            system.analysis = Some(formulas.map(|formula| system.value_at(formula, &[])));
        }
        system
    }

    /// Returns the variables of the requested derivatives at fixed time.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        self.variations.as_ref().map_or(&[], |variations| &variations.variables)
    }

    /// Returns the requested derivatives at fixed time; `None` if there are none.
    #[must_use]
    pub fn all_variations(&self) -> Option<&Variations> {
        self.variations.as_deref()
    }

    /// Returns the graph, to add expressions: a graph only grows.
    pub fn graph_mut(&mut self) -> &mut Graph {
        &mut self.graph
    }

    /// Sets the inputs; if the equations contain them as signals, also derives the right sides for them.
    pub fn add_inputs(&mut self, inputs: Vec<Input>) {
        self.inputs = inputs;
        if self.has_signals {
            self.derive_by_inputs();
        }
    }

    /// Sets the axes and circles that joints connect, and the location of each joint.
    pub fn add_features(
        &mut self,
        axes: IdVec<AxisId, Axis>,
        circles: IdVec<CircleId, Circle>,
        locations: impl IntoIterator<Item = (DeclarationId, [ExprId; 2])>,
    ) {
        self.axes = axes;
        self.circles = circles;
        for (joint, location) in locations {
            self.declarations[joint].at = Some(location);
        }
    }

    /// Sets the formulas of the times of the analysis, which [`ConstraintSystem::with_values`] evaluates.
    pub fn add_analysis_formulas(&mut self, formulas: [ExprId; 3]) {
        self.analysis_formulas = Some(formulas);
    }

    /// Sets the results, and derives the variations that they need.
    pub fn add_results(&mut self, results: Results) {
        self.results = results;
        self.derive_variations_of_results();
    }

    /// Takes the open contacts out, for the caller to close by [`ConstraintSystem::set_estimate`].
    pub fn take_open_contacts(&mut self) -> Vec<OpenContact> {
        std::mem::take(&mut self.open_contacts)
    }

    /// Sets the starting value of a coordinate for assembly (m, rad or a pure number, by its kind).
    pub fn set_estimate(&mut self, coordinate: usize, value: f64) {
        self.coordinates[coordinate].estimate = self.graph.constant(value);
    }
}
