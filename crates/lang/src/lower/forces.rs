//! What holds a determined motion: what the bodies' inertia asks for, what weights and loads give, and what joints and drivers supply
//! of the rest (`forces.md`; H 11.3).

use super::Lowering;
use super::frames::Vector;
use crate::model::{
    Declared, EquationForm, EquationId, Force, Frame, JointId, Load, Mass, Mechanism, Named, PartId, Quantity,
};
use mechc_expr::{ExprId, Symbol};
use mechc_ir::tolerances::loads::AIMLESS;
use mechc_ir::{self as ir, ConstraintSystem, DeclarationId, Forces};

/// What a joint exerts on one body, in the ground's frame.
#[derive(Clone, Copy)]
pub(super) struct Reaction {
    /// (N)
    force: Vector,
    /// (N·m)
    moment: ExprId,
}

/// By named symbol, whether it holds forces. These are known when all rows are.
pub(super) fn of_forces(model: &Mechanism) -> Vec<bool> {
    let mut holds = Vec::with_capacity(model.named.len());
    for named in &model.named {
        let of_others = |inner: ExprId| {
            let symbols = model.graph.symbols(inner);
            symbols.into_iter().any(|symbol| matches!(symbol, Symbol::Named(k) if holds[k as usize]))
        };
        holds.push(match *named {
            Named::Force(..) => true,
            Named::Derivative(inner) | Named::By(inner, ..) | Named::Held(_, inner) => {
                model.asks_for_forces() && of_others(inner)
            }
            Named::Quantity(..) | Named::Exists(..) | Named::Reduction(_) | Named::Argument => false,
        });
    }
    holds
}

impl Lowering<'_> {
    /// Whether a formula of the model asks for forces.
    pub(super) fn asks_for_forces(&self, formula: ExprId) -> bool {
        let is_force = |symbol: Symbol| matches!(symbol, Symbol::Named(k) if self.of_forces[k as usize]);
        self.model.graph.symbols(formula).into_iter().any(is_force)
    }

    /// `p` of `Φ_qᵀ λ = p`; none where nobody asks for forces.
    pub(super) fn forces(&mut self) -> Option<Forces> {
        let model = self.model;
        if !model.asks_for_forces() {
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
        let are_pictured = model.draws_forces() && !model.reactions;
        let mut reactions = if model.reactions || are_pictured { self.reactions() } else { Vec::new() };
        if model.draws_forces() {
            reactions.extend(model.loads.iter().map(|load| self.column_of_load(load)));
        }
        let loads = model.loads.iter().map(|load| self.given(load)).collect();
        Some(Forces { needed, reactions, are_pictured, loads, presses: self.presses() })
    }

    /// What a load is.
    fn given(&mut self, load: &Load) -> ir::LoadForce {
        let conditions = load.conditions.iter().filter_map(|condition| {
            let positive = self.formula(condition.positive);
            super::condition(condition, positive)
        });
        let conditions = conditions.collect();
        let (force, excess) = (self.value_of(load), self.excess(load));
        ir::LoadForce { name: load.declared.name.clone(), span: load.declared.span, force, excess, conditions }
    }

    /// By how much the distance that a load works on is longer than what has no direction (m).
    fn excess(&mut self, load: &Load) -> Option<ExprId> {
        let Quantity::Distance(p, q) = load.on else { return None };
        let size = [p, q].map(|point| self.size(self.model[point].frame)).into_iter().fold(0.0, f64::max);
        let distance = self.quantity(load.part, load.on);
        let least = self.graph.constant(AIMLESS * size);
        Some(self.graph.sub(distance, least))
    }

    /// The same, for those who draw it.
    fn column_of_load(&mut self, load: &Load) -> ir::Reaction {
        let Declared { name, span } = &load.declared;
        ir::Reaction {
            name: format!("{name}.load"),
            value: self.value_of(load),
            unit: load.dimension.unit(),
            span: *span,
        }
    }

    /// A column for all that each joint exerts, as far as it is not zero by its kind, and then for what each constraint or driver supplies.
    fn reactions(&mut self) -> Vec<ir::Reaction> {
        let model = self.model;
        let mut columns = Vec::new();
        for (joint, id) in model.joints.iter().zip(model.joint_ids()) {
            let all =
                [("fx", Force::ReactionX(id)), ("fy", Force::ReactionY(id)), ("torque", Force::ReactionTorque(id))];
            let asked = if joint.kind.plain().has_torque() { &all[..] } else { &all[..2] };
            columns.extend(asked.iter().map(|&(ending, force)| self.column(&joint.declared, ending, force)));
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

    /// What a mass asks for, less its weight: `m (c̈ − g)ᵀ ∂c/∂q + I φ̈ ∂φ/∂q`, c its centre. These are Lagrange's
    /// `d/dt ∂T/∂q̇ − ∂T/∂q + ∂V/∂q` of `T = ½ m ċᵀċ + ½ I φ̇²` and `V = −m gᵀc`, without the terms that cancel.
    fn add_mass(&mut self, of: &Mass, needed: &mut [ExprId]) {
        let frame = Frame::Body(of.body);
        let (mass, inertia) = (self.formula(of.amount), self.formula(of.inertia));
        let gravity = self.model.gravity.map(|gravity| gravity.map(|part| self.formula(part)));
        let (center, phi) = (self.global(of.at), self.frame_coordinate(frame, 2));
        for (part, place) in center.into_iter().enumerate() {
            let mut asked = self.second_rate(place);
            if let Some(gravity) = gravity {
                asked = self.graph.sub(asked, gravity[part]);
            }
            let asked = self.graph.mul(mass, asked);
            self.add_work(place, asked, needed);
        }
        let turning = self.second_rate(phi);
        let asked = self.graph.mul(inertia, turning);
        self.add_work(phi, asked, needed);
    }

    fn second_rate(&mut self, of: ExprId) -> ExprId {
        let first = ConstraintSystem::time_derivatives(&mut self.graph, &[of], 2);
        ConstraintSystem::time_derivatives(&mut self.graph, &first, 2)[0]
    }

    /// A load is not asked for but given: `−F ∂K/∂q`. Between points in one place there is no direction for it.
    fn add_load(&mut self, load: &Load, needed: &mut [ExprId]) {
        let mut force = self.value_of(load);
        if let Some(excess) = self.excess(load) {
            let is_aimed = self.is_positive(excess);
            force = self.only_where(Some(is_aimed), force);
        }
        let on = self.quantity(load.part, load.on);
        let asked = self.graph.neg(force);
        self.add_work(on, asked, needed);
    }

    fn value_of(&mut self, load: &Load) -> ExprId {
        let force = self.formula(load.force);
        let force = self.later_side(force);
        let holds = self.all_hold(&load.conditions);
        self.only_where(holds, force)
    }

    /// A force on what changes with the coordinates works on each of them.
    fn add_work(&mut self, on: ExprId, force: ExprId, needed: &mut [ExprId]) {
        for (column, slope) in self.graph.slopes(on, 0) {
            let column = column as usize;
            let work = self.graph.mul(force, slope);
            needed[column] = self.graph.add(needed[column], work);
        }
    }

    /// A force that is asked for, as it is seen from the ground of a part.
    pub(super) fn force(&mut self, view: Option<PartId>, force: Force) -> ExprId {
        match force {
            Force::Effort(equation) => self.effort(equation),
            Force::ReactionX(joint) => self.reaction_in(view, joint, 0),
            Force::ReactionY(joint) => self.reaction_in(view, joint, 1),
            Force::ReactionTorque(joint) => {
                let moment = self.reaction(joint).moment;
                self.handed(view, moment)
            }
        }
    }

    /// What a joint exerts on its second body, or on the ground, in the ground's frame (N).
    pub(super) fn reaction_on_second(&mut self, joint: JointId) -> Vector {
        self.reaction(joint).force
    }

    fn reaction_in(&mut self, view: Option<PartId>, joint: JointId, part: usize) -> ExprId {
        let force = self.reaction(joint).force;
        self.seen_from(view, |l| l.seen(force))[part]
    }

    /// What a constraint or driver supplies: `λ ∂Φ/∂(left − right)`.
    fn effort(&mut self, equation: EquationId) -> ExprId {
        let row = self.first_row(self.of_equations[equation.index()]);
        let multiplier = self.graph.symbol(Symbol::Multiplier(row as u32));
        match self.model[equation].form {
            EquationForm::Equality(..) => multiplier,
            // d² − C² changes with d by 2 d, and d is C
            EquationForm::Distance(_, _, distance) => {
                let (two, distance) = (self.graph.constant(2.0), self.formula(distance));
                let slope = self.graph.mul(two, distance);
                self.graph.mul(slope, multiplier)
            }
        }
    }

    /// What a joint's own equations exert on the body of its second argument, about the point that it is reduced to. On the ground it is
    /// the opposite of what they exert on the first body.
    fn reaction(&mut self, joint: JointId) -> Reaction {
        if let Some(&known) = self.reactions.get(&joint) {
            return known;
        }
        let point = match self.seen_from(None, |l| l.place(joint)) {
            Some(point) => point,
            None => [0.0; 2].map(|zero| self.graph.constant(zero)),
        };
        let [first, second] = self.model[joint].kind.frames(self.model).map(|frame| self.model.carrier(frame));
        let frame = if second == Frame::Ground { first } else { second };
        let [x, y, about_origin] = self.exerted(joint, frame);
        let origin = self.seen_from(None, |l| [0, 1].map(|part| l.frame_coordinate(frame, part)));
        let arm = self.minus(point, origin);
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

    /// What the equations of a joint exert on the coordinates of a body: `Σ λ ∂Φ/∂q`.
    fn exerted(&mut self, joint: JointId, frame: Frame) -> [ExprId; 3] {
        let mut sums = [0.0; 3].map(|zero| self.graph.constant(zero));
        let Frame::Body(body) = frame else { return sums };
        let pose = self.numbering.pose(body);
        let declaration = super::of_joint(joint);
        let first = self.first_row(declaration);
        for row in first..first + self.declarations[declaration].rows {
            let multiplier = self.graph.symbol(Symbol::Multiplier(row as u32));
            for (column, slope) in self.graph.slopes(self.rows[row].phi, 0) {
                if let Some(part) = pose.iter().position(|&own| own == column) {
                    let product = self.graph.mul(multiplier, slope);
                    sums[part] = self.graph.add(sums[part], product);
                }
            }
        }
        sums
    }

    /// The number of a declaration's first row.
    fn first_row(&self, declaration: DeclarationId) -> usize {
        self.rows.partition_point(|row| row.declaration.index() < declaration.index())
    }
}
