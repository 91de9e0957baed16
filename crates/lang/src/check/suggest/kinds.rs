//! Suggestions for arguments of the wrong kind, from the declarations of the mechanism.

use super::edits::with_preferred_fix;
use crate::check::errors::list;
use crate::check::formulas::{Feature, Formulas};
use crate::check::scope::Entity;
use crate::model::{Dimension, Frame};
use mechc_syntax::ast::{Expr, ExprKind, Factor, ItemKind, Name};
use mechc_text::diag::{Applicability, Code, Diagnostic, Edit, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Position, QuantityWord, Synonym, Unit};

impl Formulas<'_> {
    /// Suggests an axis instead of a point: an axis of the body, or a new one through the point.
    pub(in crate::check) fn suggest_axis(&self, frame: Frame, point: &Name) -> Option<Fix> {
        let space = self.common.features.get(&frame)?;
        let owner = self.frame_name(frame);
        if let Some(axis) = space.names(|feature| matches!(feature, Feature::Axis(_))).next() {
            let message = format!("was `{owner}.{axis}` meant?");
            return Some(Fix::replace(point.span, axis, message, Applicability::Probably));
        }
        let name = ["way", "line", "slideway"].into_iter().find(|name| space.get(name).is_none())?;
        let declared = space.span(&point.text)?;
        let features = self.scope.items().iter().filter_map(|item| match &item.kind {
            ItemKind::Ground { features } | ItemKind::Body { features, .. } => Some(features),
            _ => None,
        });
        let feature = features.flatten().find(|feature| feature.name.span == declared)?.span;
        let axis = format!("axis {name} = {} along (1, 0)", point.text);
        let source = self.reporter.sources.get(feature.file);
        let line = source.text[..feature.start as usize].rsplit('\n').next().unwrap_or_default();
        // On a line of its own, or within the line of the body.
        let gap = if line.trim().is_empty() { format!("\n{line}") } else { " ".to_owned() };
        Some(Fix {
            message: format!("an axis is declared in `{owner}`, `{axis}`, and is `{owner}.{name}` here"),
            edits: vec![
                Edit { span: Span { start: feature.end, ..feature }, text: gap + &axis },
                Edit { span: point.span, text: name.to_owned() },
            ],
            applies: Applicability::Probably,
        })
    }

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

    /// Suggests an effort for other words, such as `power(motor)`, `moment(main)` and `force(motor)`.
    pub(in crate::check) fn suggest_effort(&self, e: &Expr, called: &Name, arguments: &[Expr]) -> Option<Fix> {
        let [argument] = arguments else { return None };
        let ExprKind::Name(name) = &argument.bare().kind else { return None };
        let means = Synonym::of(Position::Call, &called.text)?.means;
        let (what, text) = match self.scope.entity(name)? {
            Entity::Equation(_) if called.text == "power" => {
                let moved = self.moved_by(&name.text)?;
                ("the power of a driver is".to_owned(), format!("effort({}) * der({moved})", name.text))
            }
            Entity::Equation(_) if means.iter().any(|word| is_force(word)) => {
                (format!("`{}` supplies", name.text), format!("effort({})", name.text))
            }
            Entity::Joint(k) if means == ["torque"] || means == ["effort"] => {
                let joint = self.joints.get(k).copied().flatten()?;
                let is_driven = means == ["effort"] || !self.model[joint].spec.has_torque();
                let driver = self.scope.driver_of(&name.text).filter(|_| is_driven)?;
                (format!("what drives `{}` supplies", name.text), format!("effort({driver})"))
            }
            _ => return None,
        };
        let message = format!("{what} `{text}`");
        Some(Fix::replace(e.span, text, message, Applicability::Probably))
    }

    /// Returns the text of the quantity that a driver moves, if its left side is one.
    fn moved_by(&self, driver: &str) -> Option<&str> {
        let left = self.scope.items().iter().find_map(|item| match &item.kind {
            ItemKind::Equation { driver: true, name, left, .. } if name.text == driver => Some(left),
            _ => None,
        })?;
        let is_quantity =
            matches!(&left.bare().kind, ExprKind::Call { name, .. } if self.scope.quantity_word(name).is_some());
        is_quantity.then(|| self.reporter.text(left.span))
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
            Some(Fix::replace(span, text, message, Applicability::Probably))
        };
        match (feature.text.as_str(), space.get(&feature.text)) {
            (_, Some(Feature::Point(_))) => {
                let [x, y] = ["x", "y"].map(|what| format!("{what}({}.{})", owner.text, feature.text));
                Some(Fix::replace(
                    span,
                    x.clone(),
                    format!("the place of a point is `{x}` and `{y}`"),
                    Applicability::Probably,
                ))
            }
            ("phi", None) => column(format!("angle({})", owner.text)),
            (what @ ("x" | "y"), None) => {
                let at_origin = self.model.points.iter().find(|point| {
                    let is_zero = |id| self.model.graph.as_const(id) == Some(0.0);
                    point.frame == frame && point.name.is_some() && point.at.into_iter().all(is_zero)
                });
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
        let message = "the angle of two coordinates is `atan2(y, x)`";
        let fix = is_atan2.then(|| Fix::replace(name.span, "atan2", message, Applicability::Probably));
        let fix = fix.or_else(|| self.suggest_decimal_point(arguments, most));
        self.reporter.report(with_preferred_fix(diagnostic, fix));
    }
}

/// Returns whether a word is a quantity of forces.
fn is_force(word: &str) -> bool {
    QuantityWord::named(word).is_some_and(|quantity| quantity.is_force)
}

fn is_unit_of_angle(unit: &str) -> bool {
    Unit::named(unit).is_some_and(|unit| unit.dimension.is(Dimension::PURE))
}
