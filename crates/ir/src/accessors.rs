//! The narrow door of a system: what others read of it, and the little that is added once it stands.

use super::{
    AskingPart, Axis, AxisId, Body, BodyId, Check, CheckSlopes, Circle, CircleId, Condition, ConstraintSystem,
    Coordinate, Declaration, DeclarationId, Fit, Forces, IdVec, Input, Measure, OpenContact, Param, PartStart, Point,
    PointId, Results, Rim, Row, SparseRows, Variable, Variations, Watch,
};
use mechc_expr::{ExprId, Graph};
use mechc_text::source::Span;

impl ConstraintSystem {
    /// The mechanism's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The place of that name.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// Every expression.
    #[must_use]
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The parameters, by the number of their symbol.
    #[must_use]
    pub fn params(&self) -> &[Param] {
        &self.params
    }

    /// The inputs, as they are declared; where the equations hold them as signals and time too, this as the last.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Whether the equations hold inputs, and time, as signals rather than by their formulas.
    #[must_use]
    pub fn has_signals(&self) -> bool {
        self.has_signals
    }

    /// How equations that were left out change, where one of the two is there.
    #[must_use]
    pub fn check_slopes(&self) -> &CheckSlopes {
        &self.check_slopes
    }

    /// The bodies, each with three coordinates; those of the joints come after them.
    #[must_use]
    pub fn bodies(&self) -> &IdVec<BodyId, Body> {
        &self.bodies
    }

    /// Their points and the ground's: the equations know of none, but what is said of them does.
    #[must_use]
    pub fn points(&self) -> &IdVec<PointId, Point> {
        &self.points
    }

    /// Their axes, and the ground's.
    #[must_use]
    pub fn axes(&self) -> &IdVec<AxisId, Axis> {
        &self.axes
    }

    /// Their circles, and the ground's.
    #[must_use]
    pub fn circles(&self) -> &IdVec<CircleId, Circle> {
        &self.circles
    }

    /// The generalized coordinates, by their number.
    #[must_use]
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// The joints, constraints and drivers that wrote the rows.
    #[must_use]
    pub fn declarations(&self) -> &IdVec<DeclarationId, Declaration> {
        &self.declarations
    }

    /// The entries of `Φ`.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// `Φ_q`, by rows.
    #[must_use]
    pub fn phi_q(&self) -> &SparseRows {
        &self.phi_q
    }

    /// What holds the motion, where somebody asks for it.
    #[must_use]
    pub fn forces(&self) -> Option<&Forces> {
        self.forces.as_ref()
    }

    /// What is tabulated beside the coordinates.
    #[must_use]
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// What is asked of the whole analysis.
    #[must_use]
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// Formulas that must stay positive.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// Equations that follow from the others, and are looked at instead of solved.
    #[must_use]
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// What tells one branch of a gear or contact from another.
    #[must_use]
    pub fn watches(&self) -> &[Watch] {
        &self.watches
    }

    /// Where formulas of the equations come to the end of what their functions take.
    #[must_use]
    pub fn rims(&self) -> &[Rim] {
        &self.rims
    }

    /// Contacts that begin where nobody said; none once that is searched for.
    #[must_use]
    pub fn open_contacts(&self) -> &[OpenContact] {
        &self.open_contacts
    }

    /// Distances that gears and racks are made for, but do not hold themselves.
    #[must_use]
    pub fn fits(&self) -> &[Fit] {
        &self.fits
    }

    /// The parts of the mechanism, as far as their start asks for it.
    #[must_use]
    pub fn parts(&self) -> &[PartStart] {
        &self.parts
    }

    /// Parts whose texts ask for derivatives by their own equations.
    #[must_use]
    pub fn asking_parts(&self) -> &[AskingPart] {
        &self.asking_parts
    }

    /// Characteristic length L (m): the size of the largest body.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The file's analysis: first time, last time, step (s).
    #[must_use]
    pub fn analysis(&self) -> Option<[f64; 3]> {
        self.analysis
    }

    /// The values of the parameters, in the order of their symbols.
    #[must_use]
    pub fn values_of_params(&self) -> Vec<f64> {
        self.params.iter().map(|param| param.value).collect()
    }

    /// The same mechanism with other values of its parameters, in the order of their symbols. What was found by their values stays as it is:
    /// the scales of coordinates, and the estimates of contacts that were searched for.
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

    /// By what derivatives are asked for, at fixed time.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        self.variations.as_ref().map_or(&[], |variations| &variations.variables)
    }

    /// The derivatives that are asked for, at fixed time, where there are any.
    #[must_use]
    pub fn all_variations(&self) -> Option<&Variations> {
        self.variations.as_deref()
    }

    /// For new expressions: a graph only grows.
    pub fn graph_mut(&mut self) -> &mut Graph {
        &mut self.graph
    }

    /// Gives it the inputs; where the equations hold them as signals, with what follows for these.
    pub fn add_inputs(&mut self, inputs: Vec<Input>) {
        self.inputs = inputs;
        if self.has_signals {
            self.derive_by_inputs();
        }
    }

    /// Gives it the features that joints take hold of, and each joint the place where it does.
    pub fn add_features(
        &mut self,
        axes: IdVec<AxisId, Axis>,
        circles: IdVec<CircleId, Circle>,
        places: impl IntoIterator<Item = (DeclarationId, [ExprId; 2])>,
    ) {
        self.axes = axes;
        self.circles = circles;
        for (joint, place) in places {
            self.declarations[joint].at = Some(place);
        }
    }

    /// Gives it the formulas of the times of the analysis, for other values of the parameters.
    pub fn add_analysis_formulas(&mut self, formulas: [ExprId; 3]) {
        self.analysis_formulas = Some(formulas);
    }

    /// Asks it for results.
    pub fn add_results(&mut self, results: Results) {
        self.results = results;
        self.derive_variations_of_results();
    }

    /// The contacts that are open, for whom closes them by [`ConstraintSystem::set_estimate`].
    pub fn take_open_contacts(&mut self) -> Vec<OpenContact> {
        std::mem::take(&mut self.open_contacts)
    }

    /// Where assembly starts with a coordinate: m, rad or a pure number, by its kind.
    pub fn set_estimate(&mut self, coordinate: usize, value: f64) {
        self.coordinates[coordinate].estimate = self.graph.constant(value);
    }
}
