//! Writes the equations `Φ` of a model as a constraint system. `Φ` and the inertia of masses are the only mechanics written by hand.
//!
//! H stands for E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems*, 1989.

mod contact_forces;
mod elements;
mod features;
mod forces;
mod frames;
mod inputs;
mod measured;
mod numbering;
mod param_path;
mod part_derivatives;
mod part_starts;
mod quantities;
mod results;
mod right_limits;
mod size;
mod slopes;
mod switching;
mod used_features;
mod variations;
mod velocities;

use crate::model::{
    self, BodyId, ConditionKind, EquationForm, Frame, JointId, Mechanism, Named, PartId, Placement, PointId, Quantity,
};
use inputs::Imported;
pub use inputs::{InputPath, Inputs, TimeOnPath};
use mechc_expr::{Comparison, Dependence, ExprId, Graph};
use mechc_ir::{
    self as ir, Body, Condition, ConstraintSystem, Coordinate, CoordinateKind, Declaration, DeclarationId,
    DeclarationKind, Fit, Forces, IdVec, Measure, Monitor, OpenContact, Owner, Param, Row, Units, Variations, Written,
};
use mechc_text::vocabulary::Dimension;
use numbering::Numbering;
use rustc_hash::{FxHashMap, FxHashSet};

/// Distance of a frame from its body, in sizes of the body, from which the frame is far away.
const FAR_FRAME: f64 = 10.0;

/// Order of time derivatives in a reduced formula from which its reduction needs third derivatives.
const HOLDS_JERK: u8 = 2;

/// The parts of a model that its constraint system holds, and their form.
#[derive(Clone, Debug, Default)]
pub struct LowerOptions {
    /// The expressions that stand for inputs and time.
    pub inputs: Inputs,
    /// The forces that are tabulated, except those of measures. On a path there are none.
    pub forces: TabulatedForces,
}

/// The forces that are tabulated in addition to those of measures.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct TabulatedForces {
    /// True for the reactions of all joints and the efforts of all drivers.
    pub reactions: bool,
    /// True for the forces of pictures: all loads, and all reactions that are determined, if there are masses or loads.
    pub for_pictures: bool,
}

/// Returns the constraint system of a model. Cannot fail, as `check` has rejected every model that could make it fail. On a path, the system
/// has no outputs and no forces, which have no part in a continuation.
#[must_use]
pub fn lower(model: &Mechanism, options: &LowerOptions) -> ConstraintSystem {
    match &options.inputs {
        Inputs::Inlined | Inputs::Signals => lower_whole(model, options),
        inputs @ (Inputs::AlongPath(_) | Inputs::ParamsAlongPath(_)) => {
            let mut model = model.clone();
            model.strip_outputs();
            lower_whole(&model, &LowerOptions { inputs: inputs.clone(), ..LowerOptions::default() })
        }
    }
}

fn lower_whole(model: &Mechanism, options: &LowerOptions) -> ConstraintSystem {
    let mut lowering = Lowering::new(model, options);
    let mut written = lowering.build();
    if let Inputs::ParamsAlongPath(clock) = options.inputs {
        param_path::put_on_path(model, clock, &mut written);
    }
    let with_jerk = needs_jerk(model, &written);
    let mut system = ConstraintSystem::of(written, with_jerk);
    // Inputs and results follow the equations, so that neither changes the ids of the equations' expressions.
    lowering.add_inputs(&mut system);
    if !(model.outcomes.is_empty() && model.requirements.is_empty()) {
        lowering.add_results(&mut system);
    }
    lowering.add_features(&mut system);
    lowering.add_analysis_formulas(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// Returns whether measures, results or loads hold third derivatives of the coordinates. Only systems without signals have these.
fn needs_jerk(model: &Mechanism, written: &Written) -> bool {
    let is_third = |id: ExprId| written.graph.dependence(id).highest_order() == Some(3);
    let mut measures = written.measures.iter();
    let is_measured = measures.any(|measure| (0..3).filter_map(|order| measure.derivative(order)).any(is_third));
    let mut of_forces = written.forces.iter().flat_map(Forces::formulas);
    let is_of_forces = of_forces.any(is_third);
    // The slope of an extremum needs two more derivatives.
    let holds = if model.slopes.is_some() { HOLDS_JERK - 1 } else { HOLDS_JERK };
    let is_requested = model.reductions.iter().any(|reduction| reduction.order >= holds);
    (is_measured || is_of_forces || is_requested) && !written.has_signals
}

/// Returns the parameters, each with the length of the part's path in its name.
fn params(model: &Mechanism) -> Vec<Param> {
    let parts: FxHashSet<&str> = model.parts.iter().map(|part| part.declared.name.as_str()).collect();
    let path = |name: &str| {
        let mut ends = name.rmatch_indices('.').map(|(at, _)| at);
        ends.find(|&at| parts.contains(&name[..at])).map_or(0, |at| at + 1)
    };
    let param = |param: &crate::model::Param| Param {
        name: param.declared.name.clone(),
        part: path(&param.declared.name),
        value: param.value,
        dimension: param.dimension,
        span: param.declared.span,
    };
    model.params.iter().map(param).collect()
}

/// Returns the id in the system of a body; both lists have the same order.
fn ir_body(body: BodyId) -> ir::BodyId {
    body.index().into()
}

/// Returns the id in the system of a point; both lists have the same order.
fn ir_point(point: PointId) -> ir::PointId {
    point.index().into()
}

/// Returns the declaration of a joint; declarations begin with the joints.
fn joint_declaration(joint: JointId) -> DeclarationId {
    joint.index().into()
}

struct Lowering<'m> {
    model: &'m Mechanism,
    options: &'m LowerOptions,
    numbering: Numbering,
    graph: Graph,
    imported: Imported,
    /// The model's named symbols as expressions of the coordinates.
    named: Vec<ExprId>,
    /// True while frames have their drawn poses instead of those of the coordinates.
    as_drawn: bool,
    /// The part to whose ground positions are relative; `None` for the ground.
    view: Option<PartId>,
    /// The sizes (m) of each body, of the largest body in each part, and of the largest body.
    sizes: Vec<f64>,
    part_sizes: Vec<f64>,
    largest_size: f64,
    /// Contacts whose arguments have no estimate yet.
    open_contacts: Vec<OpenContact>,
    coordinates: Vec<Coordinate>,
    rows: Vec<Row>,
    declarations: IdVec<DeclarationId, Declaration>,
    /// The declaration of each constraint and driver of the model.
    equation_declarations: Vec<DeclarationId>,
    /// For each named symbol, whether it holds forces; these symbols are resolved after all rows.
    holds_forces: Vec<bool>,
    has_rows: bool,
    /// True if loads hold third derivatives of the coordinates; `None` until it is determined.
    loads_hold_jerks: Option<bool>,
    /// The sums of rates of all coordinates, once needed.
    rate_sums: Option<right_limits::RateSums>,
    /// The reactions of joints, as far as they have been needed.
    reactions: FxHashMap<JointId, forces::Reaction>,
    conditions: Vec<Condition>,
    condition_formulas: FxHashSet<ExprId>,
    watches: Vec<Monitor>,
    fits: Vec<Fit>,
    /// The variables of derivatives other than time, with these derivatives.
    variations: Option<Variations>,
}

fn units(of: &model::Units) -> Units {
    let model::Units { si, printed, scale } = of.clone();
    Units { si, printed, scale }
}

/// Returns a condition of the system on the formula `positive`; `None` for the existence of quantities, which selects between values
/// instead.
fn condition(of: &model::Condition, positive: ExprId) -> Option<Condition> {
    let kind = match of.kind {
        ConditionKind::Distance => ir::ConditionKind::Distance,
        ConditionKind::Interval => ir::ConditionKind::Interval,
        // Tables have the same numbers in both graphs.
        ConditionKind::Range(table) => ir::ConditionKind::Range(table),
        ConditionKind::Samples(table) => ir::ConditionKind::Samples(table),
        ConditionKind::Existence => return None,
    };
    Some(Condition { positive, kind, span: of.span, owner: of.owner.clone() })
}

/// An entry of `Φ` with its dimension.
type Entry = (ExprId, Dimension);

/// Returns the unit of an equation's row: that of its sides; for a distance its square.
fn equation_unit(equation: &model::Equation) -> Dimension {
    match equation.form {
        EquationForm::Equality(..) => equation.dimension,
        EquationForm::Distance(..) => Dimension::AREA,
    }
}

impl<'m> Lowering<'m> {
    fn new(model: &'m Mechanism, options: &'m LowerOptions) -> Lowering<'m> {
        let sizes = size::body_sizes(model);
        Lowering {
            model,
            options,
            numbering: Numbering::new(model),
            graph: Graph::new(),
            imported: Imported::default(),
            named: Vec::new(),
            as_drawn: false,
            view: None,
            part_sizes: size::part_sizes(model, &sizes),
            largest_size: sizes.iter().copied().fold(0.0, f64::max),
            sizes,
            open_contacts: Vec::new(),
            coordinates: Vec::new(),
            rows: Vec::new(),
            declarations: IdVec::default(),
            equation_declarations: vec![DeclarationId::from(0); model.equations.len()],
            holds_forces: forces::symbols_with_forces(model, options.forces),
            has_rows: false,
            loads_hold_jerks: None,
            rate_sums: None,
            reactions: FxHashMap::default(),
            conditions: Vec::new(),
            condition_formulas: FxHashSet::default(),
            watches: Vec::new(),
            fits: Vec::new(),
            variations: variations::variables(model),
        }
    }
}

impl Lowering<'_> {
    /// Builds the equations with all that depends on them, except for results.
    fn build(&mut self) -> Written {
        let model = self.model;
        self.tables();
        self.resolve_symbols_up_to(model.named_before_results);
        self.body_coordinates();
        self.joint_rows();
        self.equation_rows();
        self.resolve_force_symbols();
        self.conditions();
        let (points, forces, measures) = (self.points(), self.forces(), self.measures());
        let (parts, parts_with_derivatives) = (self.part_starts(), self.parts_with_derivatives());
        self.append_derivatives(forces.as_ref().map_or(&[], |forces| &forces.reactions), &measures);
        Written {
            name: model.declared.name.clone(),
            span: model.declared.span,
            params: params(model),
            has_signals: self.has_signals(),
            bodies: self.bodies(),
            points,
            coordinates: std::mem::take(&mut self.coordinates),
            declarations: std::mem::take(&mut self.declarations),
            rows: std::mem::take(&mut self.rows),
            forces,
            measures,
            parts,
            parts_with_derivatives,
            variations: self.variations.take().map(Box::new),
            conditions: std::mem::take(&mut self.conditions),
            watches: std::mem::take(&mut self.watches),
            open_contacts: std::mem::take(&mut self.open_contacts),
            fits: std::mem::take(&mut self.fits),
            length: self.largest_size,
            analysis: model.analysis.map(|analysis| [analysis.from, analysis.to, analysis.every]),
            graph: std::mem::take(&mut self.graph),
        }
    }

    /// Adds the results to a system. Nothing that is already there changes.
    fn add_results(&mut self, system: &mut ConstraintSystem) {
        self.graph = std::mem::take(system.graph_mut());
        self.coordinates = system.coordinates().to_vec();
        self.rows = system.rows().to_vec();
        self.declarations = system.declarations().clone();
        self.variations = system.all_variations().map(Variations::without_columns);
        let results = self.results();
        *system.graph_mut() = std::mem::take(&mut self.graph);
        system.add_results(results);
    }

    /// Adds the formulas of the analysis' times to a system. Nothing that is already there changes.
    fn add_analysis_formulas(&mut self, system: &mut ConstraintSystem) {
        if let Some(analysis) = self.model.analysis {
            self.graph = std::mem::take(system.graph_mut());
            let formulas = analysis.formulas.map(|formula| self.formula(formula));
            *system.graph_mut() = std::mem::take(&mut self.graph);
            system.add_analysis_formulas(formulas);
        }
    }

    /// Imports a formula of the model.
    fn formula(&mut self, id: ExprId) -> ExprId {
        self.imported.formula(&mut self.graph, self.model, &self.options.inputs, &self.named, id)
    }

    fn tables(&mut self) {
        // Tables hold parameters only.
        self.graph.import_tables(&self.model.graph, &mut self.imported.formulas, Graph::symbol);
    }

    /// Resolves the named symbols before `end` in order; each refers to earlier ones only.
    fn resolve_symbols_up_to(&mut self, end: usize) {
        for k in self.named.len()..end {
            let id = self.resolve_symbol(k);
            self.named.push(id);
        }
    }

    /// Resolves the symbols that hold forces, once all rows exist.
    fn resolve_force_symbols(&mut self) {
        self.has_rows = true;
        for k in (0..self.named.len()).filter(|&k| self.holds_forces[k]).collect::<Vec<usize>>() {
            self.named[k] = self.resolve_symbol(k);
        }
    }

    fn resolve_symbol(&mut self, k: usize) -> ExprId {
        match self.model.named[k] {
            // Nothing uses these before all rows exist.
            _ if self.holds_forces[k] && !self.has_rows => self.graph.constant(0.0),
            Named::Quantity(view, quantity) => self.quantity(view, quantity),
            Named::Force(view, force) => self.force(view, force),
            Named::Exists(view, quantity) => self.relative_to(view, |l| l.existence(quantity)),
            Named::Derivative(inner) => {
                let inner = self.formula(inner);
                ConstraintSystem::time_derivatives(&mut self.graph, &[inner], 3)[0]
            }
            Named::By(inner, variable) => {
                let inner = self.formula(inner);
                self.derivative_by(inner, variable)
            }
            Named::Reduction(k) => self.reduction_number(k),
            // The formulas of a curve are imported for each contact. Elsewhere only unused formulas hold its argument.
            Named::Argument => self.graph.constant(0.0),
        }
    }

    fn bodies(&self) -> IdVec<ir::BodyId, Body> {
        let body = |(id, body): (BodyId, &model::Body)| Body {
            name: body.declared.name.clone(),
            span: body.declared.span,
            pose_span: body.pose_span,
            pose: self.numbering.pose(id).map(|number| number as usize),
        };
        self.model.body_ids().zip(&self.model.bodies).map(body).collect()
    }

    fn points(&mut self) -> IdVec<ir::PointId, ir::Point> {
        let model = self.model;
        let point = |point: &crate::model::Point| ir::Point {
            body: match model.carrier(point.frame) {
                Frame::Body(body) => Some(ir_body(body)),
                Frame::Ground | Frame::Part(_) => None,
            },
            name: point.name.clone(),
            at: self.at_in_carrier(point),
        };
        model.points.iter().map(point).collect()
    }

    /// Returns the position of a point in the frame of the body that carries it (m).
    fn at_in_carrier(&mut self, point: &crate::model::Point) -> [ExprId; 2] {
        let local = point.at.map(|id| self.formula(id));
        if self.model.part_of(point.frame).is_none() {
            return local;
        }
        let placement = self.in_carrier(point.frame);
        placement.placed(&mut self.graph, local)
    }

    /// Returns the drawn pose of a body in the ground's frame: x (m), y (m), phi (rad).
    fn drawn_pose(&mut self, body: BodyId) -> [ExprId; 3] {
        if self.model[body].part.is_none() {
            return self.model[body].pose.map(|id| self.formula(id));
        }
        let Placement { at: [x, y], phi, .. } = self.drawn(None, Frame::Body(body));
        [x, y, phi]
    }

    fn body_coordinates(&mut self) {
        const PARTS: [(&str, CoordinateKind); 3] =
            [("x", CoordinateKind::Length), ("y", CoordinateKind::Length), ("phi", CoordinateKind::Angle)];
        let model = self.model;
        let from_frames = size::frame_offsets(model);
        for (k, (id, body)) in model.body_ids().zip(&model.bodies).enumerate() {
            let is_far = from_frames[k] > FAR_FRAME * self.sizes[k];
            let size = if is_far { from_frames[k] } else { self.sizes[k] };
            let pose = self.drawn_pose(id);
            for ((part, kind), estimate) in PARTS.into_iter().zip(pose) {
                let coordinate = Coordinate {
                    name: format!("{}.{part}", body.declared.name),
                    owner: Owner::Body(ir_body(id)),
                    kind,
                    estimate,
                    scale: if kind == CoordinateKind::Length { size } else { 1.0 },
                };
                self.coordinates.push(coordinate);
            }
        }
    }

    /// Returns the size (m) of a frame's body; for the ground, of the largest body; for a part's ground, of the largest body in the part.
    fn size(&self, frame: Frame) -> f64 {
        let around = match frame {
            Frame::Body(body) => return self.sizes[body.index()],
            Frame::Ground => None,
            Frame::Part(part) => Some(part),
        };
        let mut parts = self.model.parts_around(around).map(|part| self.part_sizes[part.index()]);
        parts.find(|&size| size > 0.0).unwrap_or(self.largest_size)
    }

    /// Runs `work` with frames in their drawn poses.
    fn in_drawn_poses<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        self.as_drawn = true;
        let result = work(self);
        self.as_drawn = false;
        result
    }

    fn declare(&mut self, declared: &crate::model::Declared, kind: DeclarationKind, phi: &[Entry], points: &[PointId]) {
        let declaration = self.declarations.next_id();
        let (name, span) = (declared.name.clone(), declared.span);
        let points: Vec<ir::PointId> = points.iter().copied().map(ir_point).collect();
        self.declarations.push(Declaration {
            name,
            span,
            kind,
            rows: phi.len(),
            features: points.clone(),
            points,
            axes: Vec::new(),
            circles: Vec::new(),
            at: None,
            written: None,
            is_referenced: false,
        });
        self.rows.extend(phi.iter().map(|&(phi, unit)| Row { declaration, phi, unit }));
    }

    fn joint_rows(&mut self) {
        let model = self.model;
        for joint in &model.joints {
            let phi = self.joint(joint);
            self.declare(&joint.declared, DeclarationKind::Joint(joint.spec), &phi, &joint.points(model));
            if let Some(declaration) = self.declarations.last_mut() {
                // Axes and circles have the same order in the model and in the system.
                declaration.axes = joint.axes().map(|axis| axis.index().into()).collect();
                declaration.circles = joint.circles().map(|circle| circle.index().into()).collect();
            }
        }
        for named in &model.named[..model.named_before_results] {
            if let Named::Quantity(_, Quantity::Rotation(joint, _) | Quantity::Displacement(joint, ..)) = named {
                self.declarations[joint_declaration(*joint)].is_referenced = true;
            }
        }
    }

    /// Adds the rows of constraints, then those of drivers.
    fn equation_rows(&mut self) {
        let model = self.model;
        for (drivers, kind) in [(false, DeclarationKind::Constraint), (true, DeclarationKind::Driver)] {
            for (number, equation) in model.equations.iter().enumerate().filter(|(_, one)| one.driver == drivers) {
                let points = match equation.form {
                    EquationForm::Equality(..) => Vec::new(),
                    EquationForm::Distance(p, q, _) => vec![p, q],
                };
                let entry = (self.equation_row(equation.form), equation_unit(equation));
                self.equation_declarations[number] = self.declarations.next_id();
                self.declare(&equation.declared, kind, &[entry], &points);
                if let Some(declaration) = self.declarations.last_mut() {
                    declaration.written = Some(equation.written);
                    declaration.features =
                        used_features::equation_points(model, number).into_iter().map(ir_point).collect();
                }
            }
        }
    }

    /// Returns the row of an equation: left minus right; for a distance `dᵀd − C²` (H 3.2).
    fn equation_row(&mut self, form: EquationForm) -> ExprId {
        match form {
            EquationForm::Equality(left, right) => {
                let (left, right) = (self.formula(left), self.formula(right));
                self.graph.sub(left, right)
            }
            EquationForm::Distance(p, q, distance) => {
                let distance = self.formula(distance);
                let ends = [p, q].map(|point| self.position(point));
                self.squared_distance_row(ends, distance)
            }
        }
    }

    fn conditions(&mut self) {
        let model = self.model;
        for condition in self.conditions_of_inputs().chain(&model.conditions) {
            let positive = self.formula(condition.positive);
            self.condition(condition, positive);
        }
    }

    fn condition(&mut self, of: &crate::model::Condition, positive: ExprId) {
        let Some(condition) = condition(of, positive) else { return };
        if self.condition_formulas.insert(positive) {
            self.conditions.push(condition);
        }
    }

    fn measures(&mut self) -> Vec<Measure> {
        let model = self.model;
        model
            .measures
            .iter()
            .map(|measure| {
                let value = self.formula(measure.value);
                // A force has no rate, not even where it is constantly zero.
                let first = if self.requires_forces(measure.value) { None } else { self.time_derivative(value) };
                let second = first.and_then(|first| self.time_derivative(first));
                let (name, span) = (measure.declared.name.clone(), measure.declared.span);
                let holds = self.all_hold(&measure.conditions);
                let value = self.only_where(holds, value);
                let [first, second] = [first, second].map(|id| id.map(|id| self.only_where(holds, id)));
                Measure { name, value, first, second, span, units: units(&measure.units) }
            })
            .collect()
    }

    /// Returns whether all conditions hold; `None` if there are no conditions.
    fn all_hold(&mut self, conditions: &[crate::model::Condition]) -> Option<ExprId> {
        let mut all = None;
        for condition in conditions {
            let positive = self.formula(condition.positive);
            let holds = self.is_positive(positive);
            all = Some(all.map_or(holds, |all| self.graph.and(all, holds)));
        }
        all
    }

    fn is_positive(&mut self, id: ExprId) -> ExprId {
        let zero = self.graph.constant(0.0);
        self.graph.compare(Comparison::Less, zero, id)
    }

    /// Returns a formula that is not finite where `holds` is false.
    fn only_where(&mut self, holds: Option<ExprId>, id: ExprId) -> ExprId {
        let Some(holds) = holds else {
            return id;
        };
        let none = self.no_value();
        self.graph.select(holds, id, none)
    }

    /// Returns a formula that has no value.
    fn no_value(&mut self) -> ExprId {
        let (one, zero) = (self.graph.constant(1.0), self.graph.constant(0.0));
        self.graph.div(one, zero)
    }

    /// Returns the time derivative of an expression, unless it needs a fourth derivative of `q` or a varied third one.
    fn time_derivative(&mut self, id: ExprId) -> Option<ExprId> {
        let dependence = self.graph.dependence(id);
        if dependence.highest_order() == Some(3) || dependence.highest_varied_order() == Some(2) {
            return None;
        }
        // Forces jump where loads do, and so have no time derivative.
        if dependence.on(Dependence::FORCES) {
            return None;
        }
        Some(ConstraintSystem::time_derivatives(&mut self.graph, &[id], 3)[0])
    }

    /// Returns a quantity relative to the ground of a part. Quantities that do not depend on the observer are written relative to the
    /// ground.
    fn quantity(&mut self, view: Option<PartId>, quantity: Quantity) -> ExprId {
        match quantity {
            Quantity::X(from, to) => self.relative_to(view, |l| l.coordinate_between(from, to, 0)),
            Quantity::Y(from, to) => self.relative_to(view, |l| l.coordinate_between(from, to, 1)),
            Quantity::Angle(from, to) => self.relative_to(view, |l| l.angle_between(from, to)),
            Quantity::Distance(p, q) => self.distance(p, q),
            Quantity::Rotation(joint, axes) => self.relative_to(view, |l| l.rotation(joint, axes)),
            Quantity::Displacement(_, a, b) => self.displacement(a, b),
            Quantity::Corner(points) => self.corner_angle(view, points),
            Quantity::Measured(measured) => self.measured(view, measured),
        }
    }
}
