//! Generalized forces of a determined motion: inertia minus weights and loads, which joints and drivers balance (`forces.md`; H 11.3).

use super::frames::Vector;
use super::{Lowering, TabulatedForces};
use crate::model::{
    Declared, EquationForm, EquationId, Force, Frame, JointId, Load, Mass, Mechanism, Named, PartId, Quantity,
};
use mechc_expr::{ExprId, Symbol};
use mechc_ir::{self as ir, ConstraintSystem, DeclarationId, Forces};

/// A distance between two bodies up to this part of the larger body has no direction: rounding would determine it.
const AIMLESS: f64 = 1e-6;

/// The force and moment that a joint exerts on one body, in the ground's frame.
#[derive(Clone, Copy)]
pub(super) struct Reaction {
    /// (N)
    force: Vector,
    /// (N·m)
    moment: ExprId,
}

/// Returns for each named symbol whether it holds forces, which are resolved after all rows.
pub(super) fn symbols_with_forces(model: &Mechanism, tabulated: TabulatedForces) -> Vec<bool> {
    let requires_forces = requires_forces(model, tabulated);
    let mut holds = Vec::with_capacity(model.named.len());
    for named in &model.named {
        let of_others = |inner: ExprId| {
            let symbols = model.graph.symbols(inner);
            symbols.into_iter().any(|symbol| matches!(symbol, Symbol::Named(k) if holds[k as usize]))
        };
        holds.push(match *named {
            Named::Force(..) => true,
            Named::Derivative(inner) | Named::By(inner, _) => requires_forces && of_others(inner),
            Named::Quantity(..) | Named::Exists(..) | Named::Reduction(_) | Named::Argument => false,
        });
    }
    holds
}

/// Returns whether pictures show forces and there are masses or loads.
fn draws_forces(model: &Mechanism, tabulated: TabulatedForces) -> bool {
    tabulated.for_pictures && !(model.masses.is_empty() && model.loads.is_empty())
}

/// Returns whether any output requires forces.
fn requires_forces(model: &Mechanism, tabulated: TabulatedForces) -> bool {
    let is_force = |named: &Named| matches!(named, Named::Force(..));
    tabulated.reactions || draws_forces(model, tabulated) || model.named.iter().any(is_force)
}

impl Lowering<'_> {
    /// Returns whether a formula of the model holds forces.
    pub(super) fn requires_forces(&self, formula: ExprId) -> bool {
        let is_force = |symbol: Symbol| matches!(symbol, Symbol::Named(k) if self.holds_forces[k as usize]);
        self.model.graph.symbols(formula).into_iter().any(is_force)
    }

    /// Returns the right side `p` of `Φ_qᵀ λ = p`; `None` if no output requires forces.
    pub(super) fn forces(&mut self) -> Option<Forces> {
        let model = self.model;
        let tabulated = self.options.forces;
        if !requires_forces(model, tabulated) {
            return None;
        }
        let zero = self.graph.constant(0.0);
        let mut needed = vec![zero; self.coordinates.len()];
        for mass in &model.masses {
            self.add_mass(mass, &mut needed);
        }
        for load in &model.loads {
            self.add_load(load, &mut needed);
        }
        let draws_forces = draws_forces(model, tabulated);
        let only_for_drawing = draws_forces && !tabulated.reactions;
        let mut reactions = if tabulated.reactions || only_for_drawing { self.reactions() } else { Vec::new() };
        if draws_forces {
            reactions.extend(model.loads.iter().map(|load| self.load_column(load)));
        }
        let loads = model.loads.iter().map(|load| self.load_force(load)).collect();
        Some(Forces { needed, reactions, only_for_drawing, loads, presses: self.contact_forces() })
    }

    /// Returns a load as the system has it.
    fn load_force(&mut self, load: &Load) -> ir::LoadForce {
        let conditions = load.conditions.iter().filter_map(|condition| {
            let positive = self.formula(condition.positive);
            super::condition(condition, positive)
        });
        let conditions = conditions.collect();
        let (force, excess) = (self.load_value(load), self.excess(load));
        ir::LoadForce { name: load.declared.name.clone(), span: load.declared.span, force, excess, conditions }
    }

    /// Returns the excess (m) of the distance on which a load works over the shortest distance that has a direction.
    fn excess(&mut self, load: &Load) -> Option<ExprId> {
        let Quantity::Distance(p, q) = load.on else { return None };
        let size = [p, q].map(|point| self.size(self.model[point].frame)).into_iter().fold(0.0, f64::max);
        let distance = self.quantity(load.part, load.on);
        let least = self.graph.constant(AIMLESS * size);
        Some(self.graph.sub(distance, least))
    }

    /// Returns the column of a load, for pictures.
    fn load_column(&mut self, load: &Load) -> ir::Reaction {
        let Declared { name, span } = &load.declared;
        ir::Reaction {
            name: format!("{name}.load"),
            value: self.load_value(load),
            unit: load.dimension.unit(),
            span: *span,
        }
    }

    /// Returns the columns of all joints' reactions, without components that are zero by the joint's kind, then those of all efforts.
    fn reactions(&mut self) -> Vec<ir::Reaction> {
        let model = self.model;
        let mut columns = Vec::new();
        for (joint, id) in model.joints.iter().zip(model.joint_ids()) {
            let all =
                [("fx", Force::ReactionX(id)), ("fy", Force::ReactionY(id)), ("torque", Force::ReactionTorque(id))];
            let from = if joint.spec.has_force() { 0 } else { 2 };
            let to = if joint.spec.has_torque() { 3 } else { 2 };
            columns.extend(all[from..to].iter().map(|&(ending, force)| self.column(&joint.declared, ending, force)));
        }
        for (equation, id) in model.equations.iter().zip(model.equation_ids()) {
            columns.push(self.column(&equation.declared, "effort", Force::Effort(id)));
        }
        columns
    }

    fn column(&mut self, of: &Declared, ending: &str, force: Force) -> ir::Reaction {
        let unit = self.model.dimension_of_force(force).unit();
        ir::Reaction { name: format!("{}.{ending}", of.name), value: self.force(None, force), unit, span: of.span }
    }

    /// Adds a mass' inertia minus its weight: `m (c̈ − g)ᵀ ∂c/∂q + I φ̈ ∂φ/∂q` with the centre of mass c. These are Lagrange's
    /// `d/dt ∂T/∂q̇ − ∂T/∂q + ∂V/∂q` of `T = ½ m ċᵀċ + ½ I φ̇²` and `V = −m gᵀc`, without the terms that cancel.
    fn add_mass(&mut self, of: &Mass, needed: &mut [ExprId]) {
        let frame = Frame::Body(of.body);
        let (mass, inertia) = (self.formula(of.amount), self.formula(of.inertia));
        let gravity = self.model.gravity.map(|gravity| gravity.map(|part| self.formula(part)));
        let (center, phi) = (self.position(of.at), self.frame_coordinate(frame, 2));
        for (part, place) in center.into_iter().enumerate() {
            let mut required = self.second_rate(place);
            if let Some(gravity) = gravity {
                required = self.graph.sub(required, gravity[part]);
            }
            let required = self.graph.mul(mass, required);
            self.add_work(place, required, needed);
        }
        let turning = self.second_rate(phi);
        let required = self.graph.mul(inertia, turning);
        self.add_work(phi, required, needed);
    }

    fn second_rate(&mut self, of: ExprId) -> ExprId {
        let first = ConstraintSystem::time_derivatives(&mut self.graph, &[of], 2);
        ConstraintSystem::time_derivatives(&mut self.graph, &first, 2)[0]
    }

    /// Adds a load: `−F ∂K/∂q`. A load between coincident points has no direction and no value.
    fn add_load(&mut self, load: &Load, needed: &mut [ExprId]) {
        let mut force = self.load_value(load);
        if let Some(excess) = self.excess(load) {
            let is_aimed = self.is_positive(excess);
            force = self.only_where(Some(is_aimed), force);
        }
        let on = self.quantity(load.part, load.on);
        let required = self.graph.neg(force);
        self.add_work(on, required, needed);
    }

    fn load_value(&mut self, load: &Load) -> ExprId {
        let force = self.formula(load.force);
        let force = self.right_limit(force);
        let holds = self.all_hold(&load.conditions);
        self.only_where(holds, force)
    }

    /// Adds the generalized forces of a force that works on `on`: `F ∂K/∂q`.
    fn add_work(&mut self, on: ExprId, force: ExprId, needed: &mut [ExprId]) {
        for (column, slope) in self.graph.slopes(on, 0) {
            let column = column as usize;
            let work = self.graph.mul(force, slope);
            needed[column] = self.graph.add(needed[column], work);
        }
    }

    /// Returns a computed force relative to the ground of a part.
    pub(super) fn force(&mut self, view: Option<PartId>, force: Force) -> ExprId {
        match force {
            Force::Effort(equation) => self.effort(equation),
            Force::ReactionX(joint) => self.reaction_in(view, joint, 0),
            Force::ReactionY(joint) => self.reaction_in(view, joint, 1),
            Force::ReactionTorque(joint) => {
                let moment = self.reaction(joint).moment;
                self.with_handedness(view, moment)
            }
        }
    }

    /// Returns the force that a joint exerts on its second body or on the ground (N), in the ground's frame.
    pub(super) fn reaction_on_second(&mut self, joint: JointId) -> Vector {
        self.reaction(joint).force
    }

    fn reaction_in(&mut self, view: Option<PartId>, joint: JointId, part: usize) -> ExprId {
        let force = self.reaction(joint).force;
        self.relative_to(view, |l| l.vector_in_view(force))[part]
    }

    /// Returns the effort of a constraint or driver: `λ ∂Φ/∂(left − right)`.
    fn effort(&mut self, equation: EquationId) -> ExprId {
        let row = self.first_row(self.equation_declarations[equation.index()]);
        let multiplier = self.graph.symbol(Symbol::Multiplier(row as u32));
        match self.model[equation].form {
            EquationForm::Equality(..) => multiplier,
            // d² − C² has the derivative 2 d by d, and d equals C.
            EquationForm::Distance(_, _, distance) => {
                let (two, distance) = (self.graph.constant(2.0), self.formula(distance));
                let slope = self.graph.mul(two, distance);
                self.graph.mul(slope, multiplier)
            }
        }
    }

    /// Returns the force and moment that a joint's equations exert on the body of its second argument, about the attachment point. On the
    /// ground they are the opposite of those on the first body.
    fn reaction(&mut self, joint: JointId) -> Reaction {
        if let Some(&cached) = self.reactions.get(&joint) {
            return cached;
        }
        let point = match self.relative_to(None, |l| l.attachment_point(joint)) {
            Some(point) => point,
            None => [0.0; 2].map(|zero| self.graph.constant(zero)),
        };
        let [first, second] = self.model[joint].frames(self.model).map(|frame| self.model.carrier(frame));
        let frame = if second == Frame::Ground { first } else { second };
        let [x, y, about_origin] = self.exerted(joint, frame);
        let origin = self.relative_to(None, |l| [0, 1].map(|part| l.frame_coordinate(frame, part)));
        let arm = self.difference(point, origin);
        let about_point = self.left_of(arm, [x, y]);
        let moment = self.graph.sub(about_origin, about_point);
        let mut reaction = Reaction { force: [x, y], moment };
        if second == Frame::Ground {
            reaction.force = [x, y].map(|part| self.graph.neg(part));
            reaction.moment = self.graph.neg(moment);
        }
        self.reactions.insert(joint, reaction);
        reaction
    }

    /// Returns the generalized forces that the equations of a joint exert on a body: `Σ λ ∂Φ/∂q`.
    fn exerted(&mut self, joint: JointId, frame: Frame) -> [ExprId; 3] {
        let mut sums = [0.0; 3].map(|zero| self.graph.constant(zero));
        let Frame::Body(body) = frame else { return sums };
        let pose = self.numbering.pose(body);
        let declaration = super::joint_declaration(joint);
        let first = self.first_row(declaration);
        for row in first..first + self.declarations[declaration].rows {
            let multiplier = self.graph.symbol(Symbol::Multiplier(row as u32));
            for (column, slope) in self.graph.slopes(self.rows[row].phi, 0) {
                if let Some(part) = pose.iter().position(|&number| number == column) {
                    let product = self.graph.mul(multiplier, slope);
                    sums[part] = self.graph.add(sums[part], product);
                }
            }
        }
        sums
    }

    /// Returns the index of a declaration's first row.
    fn first_row(&self, declaration: DeclarationId) -> usize {
        self.rows.partition_point(|row| row.declaration.index() < declaration.index())
    }
}
