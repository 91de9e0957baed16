//! Masses, gravity and loads, and the efforts and reactions that outputs use.

use super::Checker;
use super::dimensions::require_dimension;
use super::entity::Entity;
use super::errors::{self, LoadTargetError};
use super::features::Feature;
use super::formula::{Context, Dim, Value};
use super::formula_scope::FormulaSite;
use super::quantities::describe;
use super::results::reject_window;
use super::suggest::lost_rate::Part;
use crate::model::{
    BodyId, Declared, Dimension, EquationId, Force, Frame, GuardKind, JointId, Load, Mass, Named, Point, PointId,
    Quantity,
};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{self, Expr, ExprKind, Factor, FeatureKind, ItemKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::QuantityWord;

// ---- masses and gravity

impl<'a> Checker<'a> {
    /// Adds the masses of a body.
    pub(super) fn masses_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        for feature in features {
            let FeatureKind::Mass { mass, at, inertia } = &feature.kind else { continue };
            let Frame::Body(body) = frame else {
                self.reporter.report(errors::mass_of_the_ground(feature.span));
                continue;
            };
            if let Some(mass) = self.mass(body, feature, [Some(mass), at.as_deref(), inertia.as_deref()]) {
                self.model.masses.push(mass);
            }
        }
    }

    fn mass(&mut self, body: BodyId, feature: &ast::Feature, [mass, at, inertia]: [Option<&Expr>; 3]) -> Option<Mass> {
        let frame = Frame::Body(body);
        let mass = self.not_negative(frame, mass, "mass", Dimension::MASS);
        let at = match at {
            Some(at) => self.at_site(FormulaSite::Inside(frame), None, |checker| checker.place(frame, at)),
            None => Some(self.origin_of(frame, feature.span)),
        };
        let inertia = self.not_negative(frame, inertia, "inertia", Dimension::INERTIA);
        Some(Mass { body, amount: mass?, at: at?, inertia: inertia?, span: feature.span })
    }

    fn origin_of(&mut self, frame: Frame, span: Span) -> PointId {
        let zero = self.model.graph.constant(0.0);
        self.model.add_point(Point { frame, name: None, span, at: [zero; 2] })
    }

    /// Returns a constant after a keyword, which must not be negative; zero without a formula.
    fn not_negative(&mut self, frame: Frame, e: Option<&Expr>, keyword: &str, expected: Dimension) -> Option<ExprId> {
        let Some(e) = e else { return Some(self.model.graph.constant(0.0)) };
        let place = format!("what stands behind `{keyword}`");
        let (id, value) = self.at_site(FormulaSite::Inside(frame), None, |checker| {
            checker.constant_by(e, &place, expected, GuardKind::Sign)
        })?;
        if value < 0.0 {
            self.reporter.report(errors::negative_mass(e.span, value, expected));
            return None;
        }
        Some(id)
    }

    /// Sets the acceleration of gravity from the outermost mechanism. Those of parts are only checked.
    pub(super) fn gravity(&mut self) {
        self.model.gravity = self.acceleration_of_gravity();
        if self.declared_gravity().is_none() {
            self.warn_of_gravity_in_parts();
        }
    }

    fn declared_gravity(&self) -> Option<&'a Expr> {
        self.scope.items().iter().find_map(|item| match &item.kind {
            ItemKind::Gravity { acceleration } => Some(acceleration),
            _ => None,
        })
    }

    fn acceleration_of_gravity(&mut self) -> Option<[ExprId; 2]> {
        self.in_parts(|part| {
            // The gravity of a part counts when the part runs alone.
            let _ = part.acceleration_of_gravity();
        });
        let acceleration = self.declared_gravity()?;
        let ExprKind::Tuple(parts) = &acceleration.kind else {
            self.reporter.report(errors::gravity_of_one_number(acceleration.span, describe(acceleration)));
            return None;
        };
        let [x, y] = parts.as_slice() else {
            let found = format!("a list of {}", parts.len());
            self.reporter.report(errors::gravity_of_one_number(acceleration.span, &found));
            return None;
        };
        let context = self.pair_context([x, y], "`gravity`", None);
        let values = [x, y].map(|part| (part, self.formula(part, &context)));
        let mut ids = Vec::new();
        for (part, value) in values {
            let value = value?;
            require_dimension(
                &mut self.reporter,
                "`gravity`",
                Dimension::ACCELERATION,
                part.span,
                value.dim,
                &context,
            )?;
            ids.push(value.id);
        }
        ids.try_into().ok()
    }

    /// Warns that the gravity of a part does not count, once for each mechanism.
    fn warn_of_gravity_in_parts(&mut self) {
        let mut reported = Vec::new();
        for (part, written) in self.parts.iter().zip(&self.part_declarations) {
            if let Some((mechanism, gravity)) = part.gravity_inside().filter(|(_, span)| !reported.contains(span)) {
                reported.push(gravity);
                let warning = errors::gravity_of_a_part(&written.name, mechanism, gravity);
                self.reporter.diagnostics.push(warning);
            }
        }
    }

    /// Returns the mechanism that declares gravity, this one or one of its parts, and where.
    fn gravity_inside(&self) -> Option<(&'a str, Span)> {
        let declared = self.declared_gravity().map(|gravity| (self.scope.tree.name.text.as_str(), gravity.span));
        declared.or_else(|| self.parts.iter().find_map(Checker::gravity_inside))
    }
}

// ---- loads

impl Checker<'_> {
    /// Adds the loads in the order of the text, those of a part where it is declared.
    pub(super) fn loads(&mut self) {
        let mut parts = 0..self.parts.len();
        for item in self.scope.items() {
            match &item.kind {
                ItemKind::Load { name, force, on } => {
                    let load = self.load(name, force, on);
                    self.model.loads.extend(load);
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, Checker::loads);
                    }
                }
                _ => {}
            }
        }
    }

    fn load(&mut self, name: &Name, force: &Expr, on: &Expr) -> Option<Load> {
        if let ExprKind::Tuple(_) = &force.bare().kind {
            self.reporter.report(errors::load_of_a_pair(name, force.span));
            return None;
        }
        let judged = self.is_dimensional(force);
        let context = Context { rates: true, ..driven("a load", judged) };
        let conditions = self.model.conditions.len();
        let value = self.formula(force, &context);
        let declared = self.scope.declared(name);
        let conditions = self.conditions_in_time(conditions, &declared.name);
        let quantity = self.quantity_of_load(name, on);
        let (value, quantity) = (value?, quantity?);
        let dimension = Dimension::ENERGY.over(quantity.dimension());
        self.check_load_dimension(name, [force, on], value, quantity, judged)?;
        let written = force.span.to(on.span);
        Some(Load { declared, part: self.address.part, force: value.id, conditions, on: quantity, dimension, written })
    }

    /// Returns the quantity on which a load works, a function of positions.
    fn quantity_of_load(&mut self, name: &Name, on: &Expr) -> Option<Quantity> {
        let bare = on.bare();
        let ExprKind::Call { name: called, arguments, window } = &bare.kind else {
            let fault = match &bare.kind {
                ExprKind::Sum(..) => LoadTargetError::Sum,
                kind => self.quantities_of(kind).map_or(LoadTargetError::Other, LoadTargetError::Suggested),
            };
            self.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        };
        let Some(word) = self.scope.quantity_word(called) else {
            let fault = if called.text == "der" { LoadTargetError::Rate } else { LoadTargetError::Other };
            self.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        };
        let is_angle_of_points = called.text == "angle" && arguments.len() == 3;
        if word.gives_way || is_angle_of_points {
            let fault = LoadTargetError::OfMeasures(&called.text);
            self.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        }
        reject_window(&mut self.reporter, called, window.as_deref())?;
        let value = self.quantity(bare, called, arguments, &driven("a load", true))?;
        if !self.has_moving_body([value.id; 2]) {
            self.reporter.report(errors::load_on_no_body(name, on.span));
            return None;
        }
        self.model.graph.symbols(value.id).into_iter().find_map(|symbol| match symbol {
            Symbol::Named(k) => match self.model.named[k as usize] {
                Named::Quantity(_, quantity) => Some(quantity),
                _ => None,
            },
            _ => None,
        })
    }

    /// Returns the quantities that suit a joint, body or point.
    fn quantities_of(&self, moved: &ExprKind) -> Option<Vec<String>> {
        match moved {
            ExprKind::Name(name) => match self.scope.entity(name)? {
                Entity::Body(_) => Some(vec![format!("angle({})", name.text)]),
                Entity::Joint(k) => {
                    let motion = self.model[self.joints.get(k).copied().flatten()?].spec.motion?;
                    Some(vec![format!("{}({})", motion.quantity(), name.text)])
                }
                _ => None,
            },
            ExprKind::Member { owner, feature } => {
                let Some(Entity::Body(k)) = self.scope.entity(owner) else { return None };
                let space = self.common.features.get(self.bodies.get(k)?)?;
                let is_point = matches!(space.get(&feature.text), Some(Feature::Point(_)));
                let both = || ["x", "y"].map(|axis| format!("{axis}({}.{})", owner.text, feature.text)).to_vec();
                is_point.then(both)
            }
            _ => None,
        }
    }

    /// Requires that a load times its quantity is an energy. A plain load is a torque on an angle; on a length it needs a unit.
    fn check_load_dimension(
        &mut self,
        name: &Name,
        [force, on]: [&Expr; 2],
        value: Value,
        quantity: Quantity,
        judged: bool,
    ) -> Option<()> {
        let (works_on, expected) = (quantity.dimension(), Dimension::ENERGY.over(quantity.dimension()));
        let text = self.reporter.text(force.span);
        match value.dim {
            Dim::Of(dimension) if self.counts(value, &driven("a load", judged)) && !dimension.is(expected) => {
                let parts = [Part { span: force.span, dimension }, Part { span: on.span, dimension: works_on }];
                self.reporter.report(errors::load_of_no_energy(name, parts, expected, text));
                None
            }
            Dim::Of(_) | Dim::Plain { .. } if !judged && !works_on.is(Dimension::PURE) && !self.is_zero(force) => {
                let on = Part { span: on.span, dimension: works_on };
                self.reporter.report(errors::plain_load(name, force.span, text, on, expected));
                None
            }
            _ => Some(()),
        }
    }
}

/// Returns a context that allows the same as a driver's.
fn driven(place: &str, judged: bool) -> Context<'_> {
    Context { judged, time: true, inputs: true, quantities: true, ..Context::constant(place) }
}

// ---- computed forces

impl Checker<'_> {
    /// Evaluates `effort(D)`, `force_x(J)`, `force_y(J)` or `torque(J)`.
    pub(super) fn force(&mut self, e: &Expr, name: &Name, arguments: &[Expr], context: &Context<'_>) -> Option<Value> {
        if !context.measures {
            self.reporter.report(errors::force_in(context.place, &format!("`{}`", name.text), e.span));
            return None;
        }
        let [argument] = arguments else {
            let word = QuantityWord::named(&name.text)?;
            self.reporter.report(errors::argument_count(
                &name.text,
                Some(&word.word),
                e.span,
                word.takes,
                arguments.len(),
            ));
            return None;
        };
        let force = match name.text.as_str() {
            "effort" => Force::Effort(self.equation_named(argument)?),
            "force_x" => Force::ReactionX(self.joint_with_reaction("force_x", argument)?),
            "force_y" => Force::ReactionY(self.joint_with_reaction("force_y", argument)?),
            _ => Force::ReactionTorque(self.joint_with_reaction("torque", argument)?),
        };
        let dimension = self.model.dimension_of_force(force);
        // A force holds accelerations.
        let id = self.name_symbol(Named::Force(self.address.part, force), 2);
        let is_plain = matches!(force, Force::Effort(equation) if self.common.plain_equations.contains(&equation));
        let dim = if is_plain { Dim::Plain { read: dimension, fits: true } } else { Dim::Of(dimension) };
        Some(Value { id, dim })
    }

    /// Returns a constraint or driver; `None` if it is broken, which has been reported.
    fn equation_named(&mut self, e: &Expr) -> Option<EquationId> {
        let ExprKind::Name(name) = &e.bare().kind else {
            self.reporter.report(errors::wrong_kind(e.span, "a driver or constraint", describe(e)));
            return None;
        };
        match self.scope.resolve(name).ok()? {
            Some(Entity::Equation(k)) => self.equations.get(k).copied().flatten(),
            Some(entity) => {
                let joint = matches!(entity, Entity::Joint(_)).then_some(name.text.as_str());
                let driver = joint.and_then(|joint| self.scope.driver_of(joint));
                self.reporter.report(errors::effort_of_no_equation(name, entity.noun(), joint, driver.as_deref()));
                None
            }
            None => {
                let candidates = self.scope.suggestions(&self.reporter, |entity| matches!(entity, Entity::Equation(_)));
                let diagnostic = errors::unknown("driver or constraint", name, &candidates);
                self.reporter.report(diagnostic);
                None
            }
        }
    }

    /// Returns a joint of a kind whose reaction has a component.
    fn joint_with_reaction(&mut self, component: &str, e: &Expr) -> Option<JointId> {
        let (joint, name) = self.joint_named(component, e)?;
        let kind = self.model[joint].spec;
        if kind.has_quantity(component) {
            return Some(joint);
        }
        let Declared { name: joint_name, span } = self.model[joint].declared.clone();
        let diagnostic = if kind.has_force() {
            let driver = self.scope.driver_of(&name.text);
            errors::no_torque(&joint_name, kind.name(), name.span, span, driver.as_deref())
        } else {
            errors::no_force(&joint_name, kind.name(), name.span, span)
        };
        self.reporter.report(diagnostic);
        None
    }

    /// Returns whether a formula holds a force, also within derivatives.
    pub(super) fn holds_force(&self, id: ExprId) -> bool {
        self.holds_named(id, |named| matches!(named, Named::Force(..)))
    }

    /// Returns whether a formula holds a named symbol of some kind, also within derivatives and held inputs.
    pub(super) fn holds_named(&self, id: ExprId, accepts: impl Fn(&Named) -> bool) -> bool {
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            for symbol in self.model.graph.symbols(id) {
                let Symbol::Named(k) = symbol else { continue };
                match self.model.named.get(k as usize) {
                    Some(named) if accepts(named) => return true,
                    Some(Named::Derivative(inner) | Named::By(inner, _)) => open.push(*inner),
                    _ => {}
                }
            }
        }
        false
    }

    /// Returns whether a measure or result of this text or of a part uses an effort.
    pub(super) fn uses_efforts(&self) -> bool {
        let is_effort = |e: &Expr| matches!(&e.kind, ExprKind::Call { name, .. } if name.text == "effort");
        let asks = |e: &Expr| e.parts().any(is_effort);
        let in_text = self.scope.items().iter().any(|item| match &item.kind {
            ItemKind::Measure { value, .. } | ItemKind::Result { value, .. } | ItemKind::Trace { point: value, .. } => {
                asks(value)
            }
            _ => false,
        });
        in_text || self.parts.iter().any(Checker::uses_efforts)
    }

    /// Returns whether a formula is a torque, as far as it shows; joules are not a unit of torque.
    pub(super) fn is_torque(&self, e: &Expr) -> bool {
        match &e.kind {
            ExprKind::Paren(inner) | ExprKind::Negate(inner) => self.is_torque(inner),
            ExprKind::Call { name, arguments, .. }
                if self.scope.quantity_word(name).is_some_and(|word| word.is_force) =>
            {
                name.text == "torque" || name.text == "effort" && arguments.first().is_some_and(|of| self.turns(of))
            }
            ExprKind::Call { name, arguments, .. } => {
                let keeps = ["abs", "min", "max", "mean", "rms", "first", "last", "at", "hypot"];
                keeps.contains(&name.text.as_str()) && arguments.first().is_some_and(|of| self.is_torque(of))
            }
            ExprKind::Sum(first, _) => self.is_torque(first),
            ExprKind::Product(first, rest) => {
                let factors = || std::iter::once((Factor::Times, &**first)).chain(rest.iter().map(|(f, e)| (*f, e)));
                let torques = factors().filter(|(factor, e)| *factor == Factor::Times && self.is_torque(e)).count();
                let others = factors().filter(|(_, e)| e.bare_number().is_some()).count();
                torques == 1 && torques + others == rest.len() + 1
            }
            ExprKind::Name(name) => match self.scope.entity(name) {
                Some(Entity::Measure(k)) => match self.home_of(Entity::Measure(k)) {
                    (home, Entity::Measure(k)) => home.measures.get(k).is_some_and(|of| home.is_torque(of.value)),
                    _ => false,
                },
                _ => false,
            },
            _ => false,
        }
    }

    /// Returns whether a driver or constraint works on an angle.
    fn turns(&self, e: &Expr) -> bool {
        let ExprKind::Name(name) = &e.bare().kind else { return false };
        let Some(Entity::Equation(k)) = self.scope.entity(name) else { return false };
        let equation = self.equations.get(k).copied().flatten();
        equation.is_some_and(|equation| self.model[equation].dimension.is_angular())
    }
}
