//! From the model to the constraint system: the only place where mathematics is written by hand, and it writes `Φ`
//! alone (H stands for E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems*,
//! 1989).

mod contacts;
mod edges;
mod features;
mod forces;
mod frames;
mod gears;
mod inputs;
mod joints;
mod later;
mod led;
mod numbering;
mod parts;
mod presses;
mod quantities;
mod results;
mod scopes;
mod size;
mod slopes;
mod uses;
mod variations;
mod velocities;

use crate::model::{
    self, BodyId, ConditionKind, EquationForm, Frame, JointId, Mechanism, Named, PartId, Placement, PointId, Quantity,
};
pub use led::{Clock, lower_on_its_way};
use mechc_expr::{Comparison, Dependence, ExprId, Graph, Symbol, TIME_SIGNAL};
use mechc_ir::tolerances::scales::size::FAR_FRAME;
use mechc_ir::{
    self as ir, Body, Condition, ConstraintSystem, Coordinate, CoordinateKind, Declaration, DeclarationId,
    DeclarationKind, Fit, Forces, IdVec, Measure, OpenContact, Owner, Param, Row, RowUnit, Units, Variations, Watch,
    Written,
};
use numbering::Numbering;
use rustc_hash::{FxHashMap, FxHashSet};

/// What holds so many time derivatives of the coordinates has one that holds a third derivative.
const HOLDS_JERK: u8 = 2;

/// The equations of a mechanism. Cannot fail: what could make it fail has been refused by `check`.
#[must_use]
pub fn lower(model: &Mechanism) -> ConstraintSystem {
    let mut lowering = Lowering::of(model);
    let written = lowering.written();
    let with_jerk = needs_jerk(model, &written);
    let mut system = ConstraintSystem::of(written, with_jerk);
    // late, so that what is there already is as it would be without
    inputs::add(model, &mut system);
    if !model.outcomes.is_empty() {
        lowering.ask_of_the_whole(&mut system);
    }
    lowering.add_features(&mut system);
    lowering.add_analysis_formulas(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// Whether measures, results or loads hold third derivatives of the coordinates, which only a system of time alone has.
fn needs_jerk(model: &Mechanism, written: &Written) -> bool {
    let is_third = |id: ExprId| written.graph.dependence(id).highest_order() == Some(3);
    let mut measures = written.measures.iter();
    let is_measured = measures.any(|measure| (0..3).filter_map(|order| measure.derivative(order)).any(is_third));
    let mut of_forces = written.forces.iter().flat_map(Forces::formulas);
    let is_of_forces = of_forces.any(is_third);
    // where an extremum goes is seen by two more
    let holds = if model.slopes.is_some() { HOLDS_JERK - 1 } else { HOLDS_JERK };
    let is_asked_for = model.reductions.iter().any(|reduction| reduction.order >= holds);
    (is_measured || is_of_forces || is_asked_for) && !model.has_signals
}

/// The parameters; of each, how much of its name says in which part it is.
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

/// A body of the model in the system: both have the same, in the same order.
fn same_body(body: BodyId) -> ir::BodyId {
    body.index().into()
}

/// Likewise a point.
fn same_point(point: PointId) -> ir::PointId {
    point.index().into()
}

/// The declaration of a joint: joints are the first.
fn of_joint(joint: JointId) -> DeclarationId {
    joint.index().into()
}

struct Lowering<'m> {
    model: &'m Mechanism,
    numbering: Numbering,
    graph: Graph,
    /// Formulas of the model that have been carried over.
    known: FxHashMap<ExprId, ExprId>,
    /// The model's named symbols as expressions in the coordinates.
    named: Vec<ExprId>,
    /// Whether frames stand in their poses as written, rather than where the coordinates put them.
    as_drawn: bool,
    /// The part from whose ground things are seen; the ground of all if there is none.
    view: Option<PartId>,
    /// The size of each body (m), of the largest in each part, and of the largest of all.
    sizes: Vec<f64>,
    part_sizes: Vec<f64>,
    largest_size: f64,
    /// Contacts that begin where nobody said.
    open_contacts: Vec<OpenContact>,
    coordinates: Vec<Coordinate>,
    rows: Vec<Row>,
    declarations: IdVec<DeclarationId, Declaration>,
    /// By constraint or driver of the model, its declaration.
    of_equations: Vec<DeclarationId>,
    /// By named symbol, whether it holds forces: these are named when there are rows.
    of_forces: Vec<bool>,
    has_rows: bool,
    /// Whether loads hold third derivatives of the coordinates, once that has been asked.
    loads_hold_jerks: Option<bool>,
    /// How fast everything moves, as far as it has been asked for.
    pace: Option<later::Pace>,
    /// What joints exert, as far as it has been asked for.
    reactions: FxHashMap<JointId, forces::Reaction>,
    conditions: Vec<Condition>,
    known_conditions: FxHashSet<ExprId>,
    watches: Vec<Watch>,
    fits: Vec<Fit>,
    /// Where derivatives are taken by something else than time.
    variations: Option<Variations>,
    /// Where parts may hold their inputs.
    over_leaves: scopes::OverLeaves,
}

/// A formula of the model in another graph.
fn carry(
    graph: &mut Graph,
    model: &Mechanism,
    known: &mut FxHashMap<ExprId, ExprId>,
    named: &[ExprId],
    id: ExprId,
) -> ExprId {
    graph.import(&model.graph, &[id], known, |graph, symbol| match symbol {
        Symbol::Named(k) => named[k as usize],
        Symbol::Time if model.has_signals => graph.symbol(Symbol::Signal { index: TIME_SIGNAL, order: 0 }),
        other => graph.symbol(other),
    });
    known[&id]
}

fn units(of: &model::Units) -> Units {
    let model::Units { si, printed, scale } = of.clone();
    Units { si, printed, scale }
}

/// A condition, by the formula that must be above zero; none where it is about a branch of a measure that is never taken.
fn condition(of: &model::Condition, positive: ExprId) -> Option<Condition> {
    let kind = match of.kind {
        ConditionKind::Distance => ir::ConditionKind::Distance,
        ConditionKind::Interval => ir::ConditionKind::Interval,
        // tables keep their numbers
        ConditionKind::Range(table) => ir::ConditionKind::Range(table),
        ConditionKind::Samples(table) => ir::ConditionKind::Samples(table),
        ConditionKind::Existence => return None,
    };
    Some(Condition { positive, kind, span: of.span, owner: of.owner.clone() })
}

/// An entry of `Φ`, and what it is measured in.
type Entry = (ExprId, RowUnit);

/// Some that are measured in the same.
fn entries<const N: usize>(unit: RowUnit, phi: [ExprId; N]) -> Vec<Entry> {
    phi.map(|phi| (phi, unit)).to_vec()
}

/// What the row of an equation is measured in: as its sides, but of a distance the squares.
fn unit_of(equation: &model::Equation) -> RowUnit {
    match equation.form {
        EquationForm::Equality(..) => RowUnit { dimension: equation.dimension, is_angle: equation.is_angle },
        EquationForm::Distance(..) => RowUnit::AREA,
    }
}

impl<'m> Lowering<'m> {
    fn of(model: &'m Mechanism) -> Lowering<'m> {
        let sizes = size::of_bodies(model);
        Lowering {
            model,
            numbering: Numbering::of(model),
            graph: Graph::new(),
            known: FxHashMap::default(),
            named: Vec::new(),
            as_drawn: false,
            view: None,
            part_sizes: size::of_parts(model, &sizes),
            largest_size: sizes.iter().copied().fold(0.0, f64::max),
            sizes,
            open_contacts: Vec::new(),
            coordinates: Vec::new(),
            rows: Vec::new(),
            declarations: IdVec::default(),
            of_equations: vec![DeclarationId::from(0); model.equations.len()],
            of_forces: forces::of_forces(model),
            has_rows: false,
            loads_hold_jerks: None,
            pace: None,
            reactions: FxHashMap::default(),
            conditions: Vec::new(),
            known_conditions: FxHashSet::default(),
            watches: Vec::new(),
            fits: Vec::new(),
            variations: variations::variables(model),
            over_leaves: scopes::OverLeaves::default(),
        }
    }
}

impl Lowering<'_> {
    /// The equations, with what is said of them.
    fn written(&mut self) -> Written {
        let model = self.model;
        self.tables();
        self.open_scopes();
        self.named_up_to(model.named_before_results);
        self.body_coordinates();
        self.joint_rows();
        self.equation_rows();
        self.name_forces();
        self.rows_of_scopes();
        self.conditions();
        let (points, forces, measures) = (self.points(), self.forces(), self.measures());
        let (parts, asking_parts) = (self.part_starts(), self.asking_parts());
        self.append_derivatives(forces.as_ref().map_or(&[], |forces| &forces.reactions), &measures);
        Written {
            name: model.declared.name.clone(),
            span: model.declared.span,
            params: params(model),
            has_signals: model.has_signals,
            bodies: self.bodies(),
            points,
            coordinates: std::mem::take(&mut self.coordinates),
            declarations: std::mem::take(&mut self.declarations),
            rows: std::mem::take(&mut self.rows),
            forces,
            measures,
            parts,
            asking_parts,
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

    /// What is asked of the whole analysis, which changes nothing of what is there.
    fn ask_of_the_whole(&mut self, system: &mut ConstraintSystem) {
        self.graph = std::mem::take(system.graph_mut());
        self.coordinates = system.coordinates().to_vec();
        self.rows = system.rows().to_vec();
        self.declarations = system.declarations().clone();
        self.variations = system.all_variations().map(Variations::without_columns);
        let results = self.results();
        *system.graph_mut() = std::mem::take(&mut self.graph);
        system.add_results(results);
    }

    /// Gives a system the formulas of the times of its analysis. They change nothing of what is there.
    fn add_analysis_formulas(&mut self, system: &mut ConstraintSystem) {
        if let Some(analysis) = self.model.analysis {
            self.graph = std::mem::take(system.graph_mut());
            let formulas = analysis.formulas.map(|formula| self.formula(formula));
            *system.graph_mut() = std::mem::take(&mut self.graph);
            system.add_analysis_formulas(formulas);
        }
    }

    /// A formula of the model in this graph.
    fn formula(&mut self, id: ExprId) -> ExprId {
        carry(&mut self.graph, self.model, &mut self.known, &self.named, id)
    }

    fn tables(&mut self) {
        // a table holds parameters and nothing else
        self.graph.import_tables(&self.model.graph, &mut self.known, Graph::symbol);
    }

    /// Named symbols up to one, in their order: each speaks only of those before it.
    fn named_up_to(&mut self, end: usize) {
        for k in self.named.len()..end {
            let id = self.named(k);
            self.named.push(id);
        }
    }

    /// Names what holds forces, as there are rows now.
    fn name_forces(&mut self) {
        self.has_rows = true;
        for k in (0..self.named.len()).filter(|&k| self.of_forces[k]).collect::<Vec<usize>>() {
            self.named[k] = self.named(k);
        }
    }

    fn named(&mut self, k: usize) -> ExprId {
        match self.model.named[k] {
            // of these nothing is asked before there are rows
            _ if self.of_forces[k] && !self.has_rows => self.graph.constant(0.0),
            Named::Quantity(view, quantity) => self.quantity(view, quantity),
            Named::Force(view, force) => self.force(view, force),
            Named::Exists(view, quantity) => self.seen_from(view, |l| l.existence(quantity)),
            Named::Derivative(inner) => {
                let inner = self.formula(inner);
                ConstraintSystem::time_derivatives(&mut self.graph, &[inner], 3)[0]
            }
            Named::By(inner, variable, part) => self.derivative_within(k, inner, variable, part),
            Named::Held(part, bound) => self.held(part, bound),
            Named::Reduction(k) => self.reduced(k),
            // a curve's formulas are carried over for each contact; else only formulas that nobody uses hold it
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
                Frame::Body(body) => Some(same_body(body)),
                Frame::Ground | Frame::Part(_) => None,
            },
            name: point.name.clone(),
            at: self.at_in_carrier(point),
        };
        model.points.iter().map(point).collect()
    }

    /// The place of a point in the frame of the body that carries it (m).
    fn at_in_carrier(&mut self, point: &crate::model::Point) -> [ExprId; 2] {
        let local = point.at.map(|id| self.formula(id));
        if self.model.part_of(point.frame).is_none() {
            return local;
        }
        let placement = self.in_carrier(point.frame);
        placement.placed(&mut self.graph, local)
    }

    /// Where a body is drawn in the ground's frame.
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
        let from_frames = size::of_frames(model);
        for (k, (id, body)) in model.body_ids().zip(&model.bodies).enumerate() {
            let is_far = from_frames[k] > FAR_FRAME * self.sizes[k];
            let size = if is_far { from_frames[k] } else { self.sizes[k] };
            let pose = self.drawn_pose(id);
            for ((part, kind), estimate) in PARTS.into_iter().zip(pose) {
                let coordinate = Coordinate {
                    name: format!("{}.{part}", body.declared.name),
                    owner: Owner::Body(same_body(id)),
                    kind,
                    estimate,
                    scale: if kind == CoordinateKind::Length { size } else { 1.0 },
                };
                self.coordinates.push(coordinate);
            }
        }
    }

    /// The size of a frame's body (m), that of the largest for the ground; for what carries a part, of the largest in the part.
    fn size(&self, frame: Frame) -> f64 {
        let around = match frame {
            Frame::Body(body) => return self.sizes[body.index()],
            Frame::Ground => None,
            Frame::Part(part) => Some(part),
        };
        let mut parts = self.model.parts_around(around).map(|part| self.part_sizes[part.index()]);
        parts.find(|&size| size > 0.0).unwrap_or(self.largest_size)
    }

    /// What frames are in their poses as written.
    fn as_drawn<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        self.as_drawn = true;
        let result = work(self);
        self.as_drawn = false;
        result
    }

    fn declare(&mut self, declared: &crate::model::Declared, kind: DeclarationKind, phi: &[Entry], points: &[PointId]) {
        let declaration = self.declarations.next_id();
        let (name, span) = (declared.name.clone(), declared.span);
        let points: Vec<ir::PointId> = points.iter().copied().map(same_point).collect();
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
            is_spoken_of: false,
        });
        self.rows.extend(phi.iter().map(|&(phi, unit)| Row { declaration, phi, unit }));
    }

    fn joint_rows(&mut self) {
        let model = self.model;
        for joint in &model.joints {
            let phi = self.joint(joint);
            let kind = DeclarationKind::Joint(joint.kind.plain());
            self.declare(&joint.declared, kind, &phi, &joint.kind.points(model));
            if let Some(declaration) = self.declarations.last_mut() {
                // both have the same, in the same order
                declaration.axes = joint.kind.axes().into_iter().map(|axis| axis.index().into()).collect();
                declaration.circles = joint.kind.circles().into_iter().map(|circle| circle.index().into()).collect();
            }
        }
        for named in &model.named[..model.named_before_results] {
            if let Named::Quantity(_, Quantity::Rotation(joint, _) | Quantity::Displacement(joint, ..)) = named {
                self.declarations[of_joint(*joint)].is_spoken_of = true;
            }
        }
    }

    /// Constraints, then drivers.
    fn equation_rows(&mut self) {
        let model = self.model;
        for (drivers, kind) in [(false, DeclarationKind::Constraint), (true, DeclarationKind::Driver)] {
            for (number, equation) in model.equations.iter().enumerate().filter(|(_, one)| one.driver == drivers) {
                let points = match equation.form {
                    EquationForm::Equality(..) => Vec::new(),
                    EquationForm::Distance(p, q, _) => vec![p, q],
                };
                let entry = (self.equation_row(equation.form), unit_of(equation));
                self.of_equations[number] = self.declarations.next_id();
                self.declare(&equation.declared, kind, &[entry], &points);
                if let Some(declaration) = self.declarations.last_mut() {
                    declaration.written = Some(equation.written);
                    declaration.features = uses::of_equation(model, number).into_iter().map(same_point).collect();
                }
            }
        }
    }

    /// The row of an equation: left minus right, but of a distance the squares (H 3.2).
    fn equation_row(&mut self, form: EquationForm) -> ExprId {
        match form {
            EquationForm::Equality(left, right) => {
                let (left, right) = (self.formula(left), self.formula(right));
                self.graph.sub(left, right)
            }
            EquationForm::Distance(p, q, distance) => {
                let distance = self.formula(distance);
                self.squared_distance_row(p, q, distance)
            }
        }
    }

    fn conditions(&mut self) {
        let model = self.model;
        for condition in &model.conditions {
            let positive = self.formula(condition.positive);
            self.condition(condition, positive);
        }
    }

    fn condition(&mut self, of: &crate::model::Condition, positive: ExprId) {
        let Some(condition) = condition(of, positive) else { return };
        if self.known_conditions.insert(positive) {
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
                // a force has no rate, also where it is nothing
                let first = if self.asks_for_forces(measure.value) { None } else { self.along_the_motion(value) };
                let second = first.and_then(|first| self.along_the_motion(first));
                let (name, span) = (measure.declared.name.clone(), measure.declared.span);
                let holds = self.all_hold(&measure.conditions);
                let value = self.only_where(holds, value);
                let [first, second] = [first, second].map(|id| id.map(|id| self.only_where(holds, id)));
                Measure { name, value, first, second, span, units: units(&measure.units) }
            })
            .collect()
    }

    /// Whether all of some conditions hold; none where there are none.
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

    /// A formula where something holds, elsewhere nothing finite.
    fn only_where(&mut self, holds: Option<ExprId>, id: ExprId) -> ExprId {
        let Some(holds) = holds else {
            return id;
        };
        let none = self.no_value();
        self.graph.select(holds, id, none)
    }

    /// A formula that has no value.
    fn no_value(&mut self) -> ExprId {
        let (one, zero) = (self.graph.constant(1.0), self.graph.constant(0.0));
        self.graph.div(one, zero)
    }

    /// The time derivative of an expression, unless that needs a fourth derivative of `q`, or a third one that is varied.
    fn along_the_motion(&mut self, id: ExprId) -> Option<ExprId> {
        let dependence = self.graph.dependence(id);
        if dependence.highest_order() == Some(3) || dependence.highest_varied_order() == Some(2) {
            return None;
        }
        // forces jump where loads do, and nobody differentiates them
        if dependence.on(Dependence::FORCES) {
            return None;
        }
        Some(ConstraintSystem::time_derivatives(&mut self.graph, &[id], 3)[0])
    }

    /// A quantity as it is seen from the ground of a part. What is the same from everywhere is written as it is seen from the ground.
    fn quantity(&mut self, view: Option<PartId>, quantity: Quantity) -> ExprId {
        match quantity {
            Quantity::X(from, to) => self.seen_from(view, |l| l.coordinate_between(from, to, 0)),
            Quantity::Y(from, to) => self.seen_from(view, |l| l.coordinate_between(from, to, 1)),
            Quantity::Angle(from, to) => self.seen_from(view, |l| l.angle_between(from, to)),
            Quantity::Distance(p, q) => self.distance(p, q),
            Quantity::Rotation(joint, axes) => self.seen_from(view, |l| l.rotation(joint, axes)),
            Quantity::Displacement(_, a, b) => self.displacement(a, b),
            Quantity::Corner(points) => self.corner(view, points),
            Quantity::Curvature(point) => self.seen_from(view, |l| l.path_curvature(point)),
            Quantity::Pole(of, from, part) => self.seen_from(view, |l| l.pole(of, from, part)),
            Quantity::Speed(point) => self.seen_from(view, |l| l.speed(point)),
            Quantity::PressureAngle(joint, frame) => self.seen_from(view, |l| l.pressure_angle(joint, frame)),
            Quantity::Slip(joint) => self.slip(joint),
        }
    }
}
