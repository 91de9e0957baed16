//! Masses, gravity and loads, and the efforts and reactions that outputs use.

use super::Builder;
use crate::check::errors::{self, LoadTargetError};
use crate::check::formulas::{
    Context, Dim, Feature, FormulaSite, Formulas, Value, describe, reject_window, require_dimension,
};
use crate::check::scope::{Entity, Scope};
use crate::check::suggest::lost_rate::Part;
use crate::model::{BodyId, Dimension, Frame, GuardKind, Load, Mass, Named, Point, PointId, Quantity};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{self, Expr, ExprKind, FeatureKind, ItemKind, Name};
use mechc_text::source::Span;

// ---- masses and gravity

impl<'a> Builder<'_, 'a> {
    /// Adds the masses of a body.
    pub(super) fn masses_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        for feature in features {
            let FeatureKind::Mass { mass, at, inertia } = &feature.kind else { continue };
            let Frame::Body(body) = frame else {
                self.formulas.reporter.report(errors::mass_of_the_ground(feature.span));
                continue;
            };
            if let Some(mass) = self.mass(body, feature, [Some(mass), at.as_deref(), inertia.as_deref()]) {
                self.formulas.model.masses.push(mass);
            }
        }
    }

    fn mass(&mut self, body: BodyId, feature: &ast::Feature, [mass, at, inertia]: [Option<&Expr>; 3]) -> Option<Mass> {
        let frame = Frame::Body(body);
        let mass = self.not_negative(frame, mass, "mass", Dimension::MASS);
        let at = match at {
            Some(at) => self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| formulas.place(frame, at)),
            None => Some(self.origin_of(frame, feature.span)),
        };
        let inertia = self.not_negative(frame, inertia, "inertia", Dimension::INERTIA);
        Some(Mass { body, amount: mass?, at: at?, inertia: inertia?, span: feature.span })
    }

    fn origin_of(&mut self, frame: Frame, span: Span) -> PointId {
        let zero = self.formulas.model.graph.constant(0.0);
        self.formulas.model.add_point(Point { frame, name: None, span, at: [zero; 2] })
    }

    /// Returns a constant after a keyword, which must not be negative; zero without a formula.
    fn not_negative(&mut self, frame: Frame, e: Option<&Expr>, keyword: &str, expected: Dimension) -> Option<ExprId> {
        let Some(e) = e else { return Some(self.formulas.model.graph.constant(0.0)) };
        let place = format!("what stands behind `{keyword}`");
        let (id, value) = self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| {
            formulas.constant_by(e, &place, expected, GuardKind::Sign)
        })?;
        if value < 0.0 {
            self.formulas.reporter.report(errors::negative_mass(e.span, value, expected));
            return None;
        }
        Some(id)
    }

    /// Sets the acceleration of gravity from the outermost mechanism. Those of parts are only checked.
    pub(in crate::check) fn gravity(&mut self) {
        self.formulas.model.gravity = self.acceleration_of_gravity();
        if declared_gravity(&self.formulas.scope).is_none() {
            self.warn_of_gravity_in_parts();
        }
    }

    fn acceleration_of_gravity(&mut self) -> Option<[ExprId; 2]> {
        self.in_parts(|part| {
            // The gravity of a part counts when the part runs alone.
            let _ = part.acceleration_of_gravity();
        });
        let acceleration = declared_gravity(&self.formulas.scope)?;
        let ExprKind::Tuple(parts) = &acceleration.kind else {
            self.formulas.reporter.report(errors::gravity_of_one_number(acceleration.span, describe(acceleration)));
            return None;
        };
        let [x, y] = parts.as_slice() else {
            let found = format!("a list of {}", parts.len());
            self.formulas.reporter.report(errors::gravity_of_one_number(acceleration.span, &found));
            return None;
        };
        let context = self.formulas.pair_context([x, y], "`gravity`", None);
        let values = [x, y].map(|part| (part, self.formulas.formula(part, &context)));
        let mut ids = Vec::new();
        for (part, value) in values {
            let value = value?;
            require_dimension(
                &mut self.formulas.reporter,
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
        for (part, written) in self.formulas.parts.iter().zip(&self.formulas.part_declarations) {
            if let Some((mechanism, gravity)) = gravity_inside(part).filter(|(_, span)| !reported.contains(span)) {
                reported.push(gravity);
                let warning = errors::gravity_of_a_part(&written.name, mechanism, gravity);
                self.formulas.reporter.diagnostics.push(warning);
            }
        }
    }
}

// ---- loads

impl Builder<'_, '_> {
    /// Adds the loads in the order of the text, those of a part where it is declared.
    pub(in crate::check) fn loads(&mut self) {
        let mut parts = 0..self.formulas.parts.len();
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Load { name, force, on } => {
                    let load = self.load(name, force, on);
                    self.formulas.model.loads.extend(load);
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.loads());
                    }
                }
                _ => {}
            }
        }
    }

    fn load(&mut self, name: &Name, force: &Expr, on: &Expr) -> Option<Load> {
        if let ExprKind::Tuple(_) = &force.bare().kind {
            self.formulas.reporter.report(errors::load_of_a_pair(name, force.span));
            return None;
        }
        let judged = self.formulas.is_dimensional(force);
        let context = Context { rates: true, ..driven("a load", judged) };
        let conditions = self.formulas.model.conditions.len();
        let value = self.formulas.formula(force, &context);
        let declared = self.formulas.scope.declared(name);
        let conditions = self.formulas.conditions_in_time(conditions, &declared.name);
        let quantity = self.quantity_of_load(name, on);
        let (value, quantity) = (value?, quantity?);
        let dimension = Dimension::ENERGY.over(quantity.dimension());
        self.check_load_dimension(name, [force, on], value, quantity, judged)?;
        let written = force.span.to(on.span);
        Some(Load {
            declared,
            part: self.formulas.address.part,
            force: value.id,
            conditions,
            on: quantity,
            dimension,
            written,
        })
    }

    /// Returns the quantity on which a load works, a function of positions.
    fn quantity_of_load(&mut self, name: &Name, on: &Expr) -> Option<Quantity> {
        let bare = on.bare();
        let ExprKind::Call { name: called, arguments, window } = &bare.kind else {
            let fault = match &bare.kind {
                ExprKind::Sum(..) => LoadTargetError::Sum,
                kind => self.quantities_of(kind).map_or(LoadTargetError::Other, LoadTargetError::Suggested),
            };
            self.formulas.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        };
        let Some(word) = self.formulas.scope.quantity_word(called) else {
            let fault = if called.text == "der" { LoadTargetError::Rate } else { LoadTargetError::Other };
            self.formulas.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        };
        let is_angle_of_points = called.text == "angle" && arguments.len() == 3;
        if word.gives_way() || is_angle_of_points {
            let fault = LoadTargetError::OfMeasures(&called.text);
            self.formulas.reporter.report(errors::load_on_no_quantity(name, on.span, &fault));
            return None;
        }
        reject_window(&mut self.formulas.reporter, called, window.as_deref())?;
        let value = self.formulas.quantity(bare, called, arguments, &driven("a load", true))?;
        if !self.has_moving_body([value.id; 2]) {
            self.formulas.reporter.report(errors::load_on_no_body(name, on.span));
            return None;
        }
        self.formulas.model.graph.symbols(value.id).into_iter().find_map(|symbol| match symbol {
            Symbol::Named(k) => match self.formulas.model.named[k as usize] {
                Named::Quantity(_, quantity) => Some(quantity),
                _ => None,
            },
            _ => None,
        })
    }

    /// Returns the quantities that suit a joint, body or point.
    fn quantities_of(&self, moved: &ExprKind) -> Option<Vec<String>> {
        match moved {
            ExprKind::Name(name) => match self.formulas.scope.entity(name)? {
                Entity::Body(_) => Some(vec![format!("angle({})", name.text)]),
                Entity::Joint(k) => {
                    let motion = self.formulas.model[self.formulas.joints.get(k).copied().flatten()?].spec.motion?;
                    Some(vec![format!("{}({})", motion.quantity(), name.text)])
                }
                _ => None,
            },
            ExprKind::Member { owner, feature } => {
                let Some(Entity::Body(k)) = self.formulas.scope.entity(owner) else { return None };
                let space = self.formulas.common.features.get(self.formulas.bodies.get(k)?)?;
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
        let text = self.formulas.reporter.text(force.span);
        match value.dim {
            Dim::Of(dimension) if self.formulas.counts(value, &driven("a load", judged)) && !dimension.is(expected) => {
                let parts = [Part { span: force.span, dimension }, Part { span: on.span, dimension: works_on }];
                self.formulas.reporter.report(errors::load_of_no_energy(name, parts, expected, text));
                None
            }
            Dim::Of(_) | Dim::Plain { .. }
                if !judged && !works_on.is(Dimension::PURE) && !self.formulas.is_zero(force) =>
            {
                let on = Part { span: on.span, dimension: works_on };
                self.formulas.reporter.report(errors::plain_load(name, force.span, text, on, expected));
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

impl Builder<'_, '_> {}

fn declared_gravity<'a>(scope: &Scope<'a>) -> Option<&'a Expr> {
    scope.items().iter().find_map(|item| match &item.kind {
        ItemKind::Gravity { acceleration } => Some(acceleration),
        _ => None,
    })
}

/// Returns the mechanism that declares gravity, this one or one of its parts, and where.
fn gravity_inside<'a>(formulas: &Formulas<'a>) -> Option<(&'a str, Span)> {
    let declared =
        declared_gravity(&formulas.scope).map(|gravity| (formulas.scope.tree.name.text.as_str(), gravity.span));
    declared.or_else(|| formulas.parts.iter().find_map(gravity_inside))
}
