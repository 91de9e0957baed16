//! From the model to the constraint system: the only place where mathematics is written by hand, and it writes `Φ`
//! alone (`elements.md`; H stands for E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems*,
//! 1989).

mod contacts;
mod estimates;
mod frames;
mod gears;
mod inputs;
mod joints;
mod quantities;
mod size;
mod uses;
mod velocities;

use crate::expr::{Comparison, ExprId, Graph, Symbol, TIME_SIGNAL};
use crate::ir::{
    self, Body, Condition, ConstraintSystem, Coordinate, CoordinateKind, Declaration, DeclarationKind, Fit, Measure,
    Owner, Param, Row, SparseRows, Units, Watch,
};
use crate::model::{self, AxisId, ConditionKind, EquationForm, Frame, Mechanism, Named, PointId, Quantity};
use rustc_hash::{FxHashMap, FxHashSet};

/// The equations of a mechanism. Cannot fail: what could make it fail has been refused by `check`.
#[must_use]
pub fn lower(model: &Mechanism) -> ConstraintSystem {
    let sizes = size::of_bodies(model);
    let mut lowering = Lowering {
        model,
        graph: Graph::new(),
        known: FxHashMap::default(),
        named: Vec::new(),
        as_drawn: false,
        largest_size: sizes.iter().copied().fold(0.0, f64::max),
        sizes,
        numbers: estimates::Numbers::default(),
        coordinates: Vec::new(),
        rows: Vec::new(),
        declarations: Vec::new(),
        conditions: Vec::new(),
        known_conditions: FxHashSet::default(),
        watches: Vec::new(),
        fits: Vec::new(),
    };
    lowering.tables();
    lowering.named();
    lowering.body_coordinates();
    lowering.joint_rows();
    lowering.equation_rows();
    lowering.conditions();
    let points = lowering.points();
    let measures = lowering.measures();
    let needs_jerk = measures.iter().any(|measure| {
        [Some(measure.value), measure.first, measure.second]
            .into_iter()
            .flatten()
            .any(|id| lowering.graph.dependence(id).highest_order() == Some(3))
    });
    let mut system = ConstraintSystem {
        name: model.declared.name.clone(),
        span: model.declared.span,
        params: model
            .params
            .iter()
            .map(|p| Param {
                name: p.declared.name.clone(),
                value: p.value,
                unit: p.dimension.unit(),
                span: p.declared.span,
            })
            .collect(),
        inputs: Vec::new(),
        has_signals: model.has_signals,
        by_signal: Vec::new(),
        by_param: Vec::new(),
        bodies: model
            .bodies
            .iter()
            .map(|body| Body { name: body.declared.name.clone(), span: body.declared.span, pose_span: body.pose_span })
            .collect(),
        points,
        coordinates: lowering.coordinates,
        declarations: lowering.declarations,
        rows: lowering.rows,
        graph: lowering.graph,
        phi_q: SparseRows::new(),
        nu: Vec::new(),
        gamma: Vec::new(),
        jerk: None,
        measures,
        conditions: lowering.conditions,
        checks: Vec::new(),
        watches: lowering.watches,
        rims: Vec::new(),
        fits: lowering.fits,
        length: lowering.largest_size,
        analysis: model.analysis.map(|analysis| [analysis.from, analysis.to, analysis.every]),
    };
    system.derive(needs_jerk && !model.has_signals);
    system.find_rims();
    // last, so that what is there already is as it would be without
    inputs::add(model, &mut system);
    system
}

struct Lowering<'m> {
    model: &'m Mechanism,
    graph: Graph,
    /// Formulas of the model that have been carried over.
    known: FxHashMap<ExprId, ExprId>,
    /// The model's named symbols as expressions in the coordinates.
    named: Vec<ExprId>,
    /// Whether frames stand in their poses as written, rather than where the coordinates put them.
    as_drawn: bool,
    /// The size of each body (m), and the largest of them.
    sizes: Vec<f64>,
    largest_size: f64,
    /// What the search for contacts knows already.
    numbers: estimates::Numbers,
    coordinates: Vec<Coordinate>,
    rows: Vec<Row>,
    declarations: Vec<Declaration>,
    conditions: Vec<Condition>,
    known_conditions: FxHashSet<ExprId>,
    watches: Vec<Watch>,
    fits: Vec<Fit>,
}

impl Lowering<'_> {
    /// A formula of the model in this graph.
    fn formula(&mut self, id: ExprId) -> ExprId {
        let (named, has_signals) = (&self.named, self.model.has_signals);
        self.graph.import(&self.model.graph, &[id], &mut self.known, |graph, symbol| match symbol {
            Symbol::Named(k) => named[k as usize],
            Symbol::Time if has_signals => graph.symbol(Symbol::Signal { index: TIME_SIGNAL, order: 0 }),
            other => graph.symbol(other),
        });
        self.known[&id]
    }

    fn tables(&mut self) {
        // a table holds parameters and nothing else
        self.graph.import_tables(&self.model.graph, &mut self.known, Graph::symbol);
    }

    /// Named symbols in their order: each speaks only of those before it.
    fn named(&mut self) {
        for k in 0..self.model.named.len() {
            let id = match self.model.named[k] {
                Named::Quantity(quantity) => self.quantity(quantity),
                Named::Exists(quantity) => self.existence(quantity),
                Named::Derivative(inner) => {
                    let inner = self.formula(inner);
                    ConstraintSystem::time_derivatives(&mut self.graph, &[inner], 3)[0]
                }
                // a curve's formulas are carried over for each contact; else only formulas that nobody uses hold it
                Named::Argument => self.graph.constant(0.0),
            };
            self.named.push(id);
        }
    }

    fn points(&mut self) -> Vec<ir::Point> {
        let model = self.model;
        let point = |point: &crate::model::Point| ir::Point {
            body: match point.frame {
                Frame::Ground => None,
                Frame::Body(body) => Some(body.index()),
            },
            name: point.name.clone(),
            at: point.at.map(|id| self.formula(id)),
        };
        model.points.iter().map(point).collect()
    }

    fn body_coordinates(&mut self) {
        const PARTS: [(&str, CoordinateKind); 3] =
            [("x", CoordinateKind::Length), ("y", CoordinateKind::Length), ("phi", CoordinateKind::Angle)];
        let model = self.model;
        let from_frames = size::of_frames(model);
        for (k, body) in model.bodies.iter().enumerate() {
            let is_far = from_frames[k] > size::FAR_FRAME * self.sizes[k];
            let size = if is_far { from_frames[k] } else { self.sizes[k] };
            for ((part, kind), estimate) in PARTS.into_iter().zip(body.pose) {
                let coordinate = Coordinate {
                    name: format!("{}.{part}", body.declared.name),
                    owner: Owner::Body(k),
                    kind,
                    estimate: self.formula(estimate),
                    scale: if kind == CoordinateKind::Length { size } else { 1.0 },
                };
                self.coordinates.push(coordinate);
            }
        }
    }

    /// The size of a frame's body (m), that of the largest for the ground.
    fn size(&self, frame: Frame) -> f64 {
        match frame {
            Frame::Ground => self.largest_size,
            Frame::Body(body) => self.sizes[body.index()],
        }
    }

    /// What frames are in their poses as written.
    fn as_drawn<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        self.as_drawn = true;
        let result = work(self);
        self.as_drawn = false;
        result
    }

    fn declare(
        &mut self,
        declared: &crate::model::Declared,
        kind: DeclarationKind,
        phi: &[ExprId],
        points: &[PointId],
        axes: &[AxisId],
    ) {
        let declaration = self.declarations.len();
        let (name, span) = (declared.name.clone(), declared.span);
        let points: Vec<usize> = points.iter().map(|point| point.index()).collect();
        let written = |&axis: &AxisId| {
            let axis = &self.model[axis];
            format!("{}.{}", self.model.frame_name(axis.frame), axis.name)
        };
        let axes = axes.iter().map(written).collect();
        self.declarations.push(Declaration {
            name,
            span,
            kind,
            rows: phi.len(),
            features: points.clone(),
            points,
            axes,
            written: None,
            is_spoken_of: false,
        });
        self.rows.extend(phi.iter().map(|&phi| Row { declaration, phi }));
    }

    fn joint_rows(&mut self) {
        let model = self.model;
        for joint in &model.joints {
            let phi = self.joint(joint);
            let kind = DeclarationKind::Joint(joint.kind.word());
            self.declare(&joint.declared, kind, &phi, &joint.kind.points(model), &joint.kind.axes());
        }
        for named in &model.named {
            if let Named::Quantity(Quantity::Rotation(joint, _) | Quantity::Displacement(joint, ..)) = named {
                self.declarations[joint.index()].is_spoken_of = true;
            }
        }
    }

    /// Constraints, then drivers.
    fn equation_rows(&mut self) {
        let model = self.model;
        for (drivers, kind) in [(false, DeclarationKind::Constraint), (true, DeclarationKind::Driver)] {
            for (number, equation) in model.equations.iter().enumerate().filter(|(_, one)| one.driver == drivers) {
                let (phi, points) = match equation.form {
                    EquationForm::Difference(left, right) => {
                        let (left, right) = (self.formula(left), self.formula(right));
                        (self.graph.sub(left, right), Vec::new())
                    }
                    EquationForm::SquaredDistance(p, q, distance) => {
                        let distance = self.formula(distance);
                        (self.squared_distance_row(p, q, distance), vec![p, q])
                    }
                };
                self.declare(&equation.declared, kind, &[phi], &points, &[]);
                if let Some(declaration) = self.declarations.last_mut() {
                    declaration.written = Some(equation.written);
                    declaration.features = uses::of_equation(model, number).iter().map(|point| point.index()).collect();
                }
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

    fn condition(&mut self, condition: &crate::model::Condition, positive: ExprId) {
        let kind = match condition.kind {
            ConditionKind::Distance => ir::ConditionKind::Distance,
            ConditionKind::Interval => ir::ConditionKind::Interval,
            // tables keep their numbers
            ConditionKind::Range(table) => ir::ConditionKind::Range(table),
            ConditionKind::Samples(table) => ir::ConditionKind::Samples(table),
            // of a measure, in a branch that is never taken
            ConditionKind::Existence => return,
        };
        if !self.known_conditions.insert(positive) {
            return;
        }
        self.conditions.push(Condition { positive, kind, span: condition.span, owner: condition.owner.clone() });
    }

    fn measures(&mut self) -> Vec<Measure> {
        let model = self.model;
        model
            .measures
            .iter()
            .map(|measure| {
                let value = self.formula(measure.value);
                let first = self.along_the_motion(value);
                let second = first.and_then(|first| self.along_the_motion(first));
                let (name, span) = (measure.declared.name.clone(), measure.declared.span);
                let holds = self.all_hold(&measure.conditions);
                let value = self.only_where(holds, value);
                let [first, second] = [first, second].map(|id| id.map(|id| self.only_where(holds, id)));
                let model::Units { si, printed, scale } = measure.units.clone();
                Measure { name, value, first, second, span, units: Units { si, printed, scale } }
            })
            .collect()
    }

    /// Whether all of some conditions hold; none where there are none.
    fn all_hold(&mut self, conditions: &[crate::model::Condition]) -> Option<ExprId> {
        let mut all = None;
        for condition in conditions {
            let positive = self.formula(condition.positive);
            let zero = self.graph.constant(0.0);
            let holds = self.graph.compare(Comparison::Less, zero, positive);
            all = Some(all.map_or(holds, |all| self.graph.and(all, holds)));
        }
        all
    }

    /// A formula where something holds, elsewhere nothing finite.
    fn only_where(&mut self, holds: Option<ExprId>, id: ExprId) -> ExprId {
        let Some(holds) = holds else {
            return id;
        };
        let (one, zero) = (self.graph.constant(1.0), self.graph.constant(0.0));
        let none = self.graph.div(one, zero);
        self.graph.select(holds, id, none)
    }

    /// The time derivative of an expression, unless that needs a fourth derivative of `q`.
    fn along_the_motion(&mut self, id: ExprId) -> Option<ExprId> {
        if self.graph.dependence(id).highest_order() == Some(3) {
            return None;
        }
        Some(ConstraintSystem::time_derivatives(&mut self.graph, &[id], 3)[0])
    }

    fn quantity(&mut self, quantity: Quantity) -> ExprId {
        match quantity {
            Quantity::X(from, to) => self.coordinate_between(from, to, 0),
            Quantity::Y(from, to) => self.coordinate_between(from, to, 1),
            Quantity::Angle(from, to) => self.angle_between(from, to),
            Quantity::Distance(p, q) => self.distance(p, q),
            Quantity::Rotation(joint, axes) => self.rotation(joint, axes),
            Quantity::Displacement(_, a, b) => self.displacement(a, b),
            Quantity::Corner(points) => self.corner(points),
            Quantity::Curvature(point) => self.path_curvature(point),
            Quantity::Pole(of, from, part) => self.pole(of, from, part),
            Quantity::Speed(point) => self.speed(point),
            Quantity::PressureAngle(joint, frame) => self.pressure_angle(joint, frame),
            Quantity::Slip(joint) => self.slip(joint),
        }
    }
}
