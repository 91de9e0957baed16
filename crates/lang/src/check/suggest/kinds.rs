//! Suggestions for arguments of the wrong kind, from the declarations of the mechanism.

use crate::check::errors::{self, list};
use crate::check::formulas::{Feature, Formulas};
use crate::check::scope::Entity;
use crate::model::{Dimension, Frame};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name};
use mechc_text::diag::{Applicability, Code, Diagnostic, Edit, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::{FeatureWord, JointSpec, Position, QuantityWord, Synonym, Unit};

impl Formulas<'_> {
    /// Adds suggestions to a diagnostic of a body where a joint is expected: the joints of that body, and the body's angle.
    pub(in crate::check) fn suggest_joint(&self, quantity: &str, name: &Name, diagnostic: Diagnostic) -> Diagnostic {
        if let (true, Some(Entity::Equation(_))) = (is_force(quantity), self.scope.entity(name)) {
            return diagnostic.help(format!("what it supplies is `effort({})`", name.text));
        }
        let body = match self.scope.entity(name) {
            _ if name.text == "ground" => self.address.ground,
            Some(Entity::Body(k)) => self.bodies[k],
            _ => return diagnostic,
        };
        let joints = self.joints.iter().flatten().map(|&id| &self.model[id]);
        let fitting =
            joints.filter(|joint| joint.spec.has_quantity(quantity) && joint.frames(&self.model).contains(&body));
        let names: Vec<&str> = fitting.map(|joint| joint.declared.name.as_str()).collect();
        let diagnostic = match names[..] {
            [] => diagnostic,
            [only] => diagnostic.fix(Fix::suggest(name.span, only)),
            _ => diagnostic.help(format!("joints of `{}` are {}", name.text, list(&names))),
        };
        if quantity == "rotation" {
            diagnostic.help(format!("the angle of the body is `angle({})`", name.text))
        } else {
            diagnostic
        }
    }

    /// Suggests an effort for other words, such as `moment(main)` and `force(motor)`.
    pub(in crate::check) fn suggest_effort(&self, e: &Expr, called: &Name, arguments: &[Expr]) -> Option<Fix> {
        let [argument] = arguments else { return None };
        let ExprKind::Name(name) = &argument.bare().kind else { return None };
        let means: Vec<&str> = Synonym::of(Position::Call, &called.text)?.means().collect();
        let driver = match self.scope.entity(name)? {
            Entity::Equation(_) if means.iter().any(|word| is_force(word)) => name.text.clone(),
            Entity::Joint(k) if means == ["torque"] || means == ["effort"] => {
                let joint = self.joints.get(k).copied().flatten()?;
                let is_driven = means == ["effort"] || !self.model[joint].spec.has_torque();
                self.scope.driver_of(&name.text).filter(|_| is_driven)?
            }
            _ => return None,
        };
        let text = format!("effort({driver})");
        Some(Fix::probably(e.span, text.clone(), format!("what `{driver}` supplies is `{text}`")))
    }

    /// Suggests a quantity for `crank.phi`, `crank.x` or a point where a number is expected.
    pub(in crate::check) fn suggest_number(&self, span: Span, owner: &Name, feature: &Name) -> Option<Fix> {
        let frame = match self.scope.entity(owner)? {
            Entity::Body(k) => *self.bodies.get(k)?,
            _ => return None,
        };
        let space = self.common.features.get(&frame)?;
        let column = |text: String| {
            let message = format!("a column's name is no formula; it is `{text}`");
            Some(Fix::probably(span, text, message))
        };
        match (feature.text.as_str(), space.get(&feature.text)) {
            (_, Some(Feature::Point(_))) => {
                let [x, y] = ["x", "y"].map(|what| format!("{what}({}.{})", owner.text, feature.text));
                Some(Fix::probably(span, x.clone(), format!("the place of a point is `{x}` and `{y}`")))
            }
            ("phi", None) => column(format!("angle({})", owner.text)),
            (what @ ("x" | "y"), None) => {
                let is_zero = |id| self.model.graph.as_const(id) == Some(0.0);
                let mut points = self.model.points.iter().filter(|point| point.frame == frame);
                let at_origin = points.find(|point| point.name.is_some() && point.at.into_iter().all(is_zero));
                column(format!("{what}({}.{})", owner.text, at_origin?.name.as_ref()?))
            }
            _ => None,
        }
    }

    /// Suggests decimal points for `(50,5 mm, 0)` or `step5(t, 0,5, 0, 1,5, 2)`, if `expected` parts are then left.
    pub(in crate::check) fn suggest_decimal_point(&self, parts: &[Expr], expected: usize) -> Option<Fix> {
        let (mut edits, mut number, mut k) = (Vec::new(), None, 0);
        while k + 1 < parts.len() {
            let (whole, digits) = (self.reporter.text(parts[k].span), self.reporter.text(parts[k + 1].span));
            let gap = Span { start: parts[k].span.end, end: parts[k + 1].span.start, ..parts[k].span };
            let is_number = whole.trim_start_matches('-').chars().all(|c| c.is_ascii_digit());
            let is_split =
                is_number && digits.starts_with(|c: char| c.is_ascii_digit()) && self.reporter.text(gap) == ",";
            if is_split {
                number.get_or_insert_with(|| format!("{whole}.{digits}"));
                edits.push(Edit { span: gap, text: ".".to_owned() });
            }
            k += if is_split { 2 } else { 1 };
        }
        let number = number.filter(|_| parts.len() == expected + edits.len())?;
        let message = format!("decimals are written with a point: `{number}`");
        Some(Fix { message, edits, applies: Applicability::Probably })
    }

    /// Reports a joint whose first two arguments are swapped or belong to another kind of joint.
    pub(in crate::check) fn refuses_arguments(&mut self, kind: &Name, spec: &JointSpec, arguments: &[Expr]) -> bool {
        let [first, second, ..] = arguments else { return false };
        let (Some(a), Some(b)) = (self.feature_of(first), self.feature_of(second)) else { return false };
        let [one, other] = spec.features.map(FeatureWord::word);
        let fix = if !a.is(one) && a.is(other) && b.is(one) {
            self.swapped(first, second)
        } else if spec.features == [FeatureWord::Point, FeatureWord::Curve]
            && matches!(a, Feature::Circle(_))
            && b.is("curve")
        {
            Fix::probably(kind.span, "cam", "a circle on a curve is a `cam`")
        } else {
            return false;
        };
        self.reporter.report(errors::wrong_kind(first.span, Feature::with_article(one), a.noun()).fix(fix));
        true
    }

    fn swapped(&self, first: &Expr, second: &Expr) -> Fix {
        let [one, other] = [first, second].map(|e| self.reporter.text(e.span).to_owned());
        let message = format!("the other way round: `{other}, {one}`");
        let edits = vec![Edit { span: first.span, text: other }, Edit { span: second.span, text: one }];
        Fix { message, edits, applies: Applicability::Probably }
    }

    /// Returns the feature of `owner.feature`, if it is declared.
    fn feature_of(&self, e: &Expr) -> Option<Feature> {
        let ExprKind::Member { owner, feature } = &e.kind else { return None };
        self.common.features.get(&self.frame_of(owner)?)?.get(&feature.text)
    }

    /// Returns the body of a name, or the ground, without diagnostics.
    pub(in crate::check) fn frame_of(&self, owner: &Name) -> Option<Frame> {
        match self.scope.entity(owner) {
            _ if owner.text == "ground" => Some(self.address.ground),
            Some(Entity::Body(k)) => Some(*self.bodies.get(k)?),
            _ => None,
        }
    }

    /// Reports an angle where a length is expected. A plain formula would take it as metres.
    pub(in crate::check) fn reject_angle(&mut self, place: &str, e: &Expr) -> bool {
        let Some((name, declared)) = self.angle_in(e) else { return false };
        let place = format!("{place} must be a length, found an angle");
        let diagnostic = Diagnostic::new(Code::E0402, place).at(e.span, "an angle");
        let diagnostic = match declared {
            Some(declared) => diagnostic.also(declared, format!("`{name}` is given in a unit of angle")),
            None => diagnostic,
        };
        self.reporter.report(diagnostic.help(match declared {
            Some(_) => format!("give `{name}` a unit of length: `mm`, `m`"),
            None => "units of length: `mm`, `m`".to_owned(),
        }));
        true
    }

    /// Returns the literal or parameter that makes a formula an angle, unless another factor may make it a length.
    fn angle_in<'e>(&self, e: &'e Expr) -> Option<(&'e str, Option<Span>)> {
        match &e.bare().kind {
            ExprKind::Literal { unit: Some((unit, 1)), .. } => is_unit_of_angle(&unit.text).then_some(("", None)),
            ExprKind::Negate(inner) => self.angle_in(inner),
            ExprKind::Name(name) => {
                let Some(Entity::Param(k)) = self.scope.entity(name) else { return None };
                let written = self.params.get(k).filter(|param| param.is_in_angles)?.written?;
                Some((name.text.as_str(), Some(written.0.span)))
            }
            ExprKind::Product(first, rest) => {
                // An angle times a radius is the length of an arc, and few radii are whole metres.
                let is_number = |e: &Expr| e.bare_number().is_some_and(|number| number.fract() == 0.0);
                let others = rest.iter().all(|(_, e)| is_number(e));
                match (self.angle_in(first), rest.as_slice()) {
                    (Some(angle), _) if others => Some(angle),
                    (None, [(Factor::Times, factor)]) if is_number(first) => self.angle_in(factor),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Records a parameter that is given in a unit of angle.
    pub(in crate::check) fn record_angle(&mut self, name: &Name, value: &Expr) {
        if let (Some(Entity::Param(k)), Some(_)) = (self.scope.entity(name), self.angle_in(value)) {
            self.params[k].is_in_angles = true;
        }
    }

    /// Reports a wrong number of arguments, with suggestions such as `atan2` for `atan(y, x)`.
    pub(in crate::check) fn report_argument_count(
        &mut self,
        name: &Name,
        diagnostic: Diagnostic,
        arguments: &[Expr],
        most: usize,
    ) {
        let is_atan2 = name.text == "atan" && arguments.len() == 2;
        let fix = is_atan2.then(|| Fix::probably(name.span, "atan2", "the angle of two coordinates is `atan2(y, x)`"));
        self.reporter.report(diagnostic.instead_if(fix.or_else(|| self.suggest_decimal_point(arguments, most))));
    }
}

/// Returns whether a word is a quantity of forces.
fn is_force(word: &str) -> bool {
    QuantityWord::named(word).is_some_and(QuantityWord::is_force)
}

fn is_unit_of_angle(unit: &str) -> bool {
    Unit::named(unit).is_some_and(|unit| unit.dimension.is(Dimension::PURE))
}
