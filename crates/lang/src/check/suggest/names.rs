//! Suggestions for names: the declaration or quantity that a wrong name probably stands for.

use crate::check::errors;
use crate::check::formulas::{Context, Dim, Feature, Formulas};
use crate::check::scope::Entity;
use crate::model::Dimension;
use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Name};
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Edit, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Position, Synonym, Unit, is_ground};
use rustc_hash::FxHashMap;

impl Formulas<'_> {
    /// Returns the quantity of a joint that a driver can prescribe.
    fn quantity_of(&self, name: &Name) -> Option<String> {
        let Some(Entity::Joint(k)) = self.scope.entity(name) else { return None };
        let motion = self.model[self.joints.get(k).copied().flatten()?].spec.motion?;
        Some(format!("{}({})", motion.quantity(), name.text))
    }

    /// Adds a suggestion to a diagnostic of a joint or body where a number is expected.
    pub(in crate::check) fn suggest_quantity(&self, name: &Name, diagnostic: Diagnostic) -> Diagnostic {
        if let Some(Entity::Body(_)) = self.scope.entity(name) {
            return diagnostic.help(format!("the angle of a body is `angle({})`", name.text));
        }
        let quantity = self.quantity_of(name);
        diagnostic.fix_if(quantity.map(|quantity| self.replace_in_equation(name.span, &quantity)))
    }

    /// Suggests a quantity for `speed(j)` with a joint `j`: in a driver its angle over time, in a measure the derivative of its angle.
    pub(in crate::check) fn suggest_joint_rate(
        &self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Fix> {
        let [argument] = arguments else { return None };
        let ExprKind::Name(joint) = &argument.bare().kind else { return None };
        let synonym = Synonym::of(Position::Call, &name.text);
        let is_rate = name.text == "speed" || synonym.is_some_and(|synonym| synonym.means().any(|word| word == "der"));
        let quantity = self.quantity_of(joint).filter(|_| is_rate)?;
        if !context.rates {
            return Some(self.replace_in_equation(e.span, &quantity));
        }
        let order = synonym?.message(&[]).matches("der(").count().clamp(1, 2);
        let written = format!("{}{quantity}{}", "der(".repeat(order), ")".repeat(order));
        Some(Fix::probably(e.span, written.clone(), format!("of a joint it is `{written}`")))
    }

    /// Replaces a formula by a quantity. If the other side of its driver is a rate, that is multiplied with the time.
    fn replace_in_equation(&self, span: Span, quantity: &str) -> Fix {
        let other = self.scope.items().iter().find_map(|item| match &item.kind {
            ItemKind::Equation { driver: true, left, right, .. } if left.span == span => Some(right),
            ItemKind::Equation { driver: true, left, right, .. } if right.span == span => Some(left),
            _ => None,
        });
        let Some(other) = other else {
            return Fix::probably(span, quantity, format!("of a joint it is `{quantity}`"));
        };
        let mut fix = Fix::probably(span, quantity, format!("a driver gives the motion over time: `{quantity} = …`"));
        if self.is_rate(other) {
            let law = format!("{} * t", self.reporter.text(other.span));
            fix.message = format!("a driver gives the motion over time: `{quantity} = {law}`");
            fix.edits.push(Edit { span: other.span, text: law });
        }
        fix
    }

    /// Returns whether a formula is a number with a unit of rate, or a parameter of this dimension.
    fn is_rate(&self, e: &Expr) -> bool {
        match &e.bare().kind {
            ExprKind::Literal { unit: Some((unit, 1)), .. } => {
                Unit::named(&unit.text).is_some_and(|unit| unit.dimension.is(Dimension::RATE))
            }
            ExprKind::Name(name) => match self.scope.entity(name) {
                Some(Entity::Param(k)) => {
                    self.params[k].value.is_some_and(|value| matches!(value.dim, Dim::Of(d) if d.is(Dimension::RATE)))
                }
                _ => false,
            },
            _ => false,
        }
    }

    /// Reports an unknown body. Other words for the ground are suggestions for it.
    pub(in crate::check) fn unknown_body(&mut self, name: &Name) {
        let mut candidates = self.scope.suggestions(&self.reporter, |entity| matches!(entity, Entity::Body(_)));
        candidates.push("ground");
        let diagnostic = errors::unknown("body", name, &candidates);
        let is_ground = diagnostic.help.is_empty() && is_ground(&name.text);
        self.reporter.report(diagnostic.fix_if(is_ground.then(|| Fix::suggest(name.span, "ground"))));
    }

    /// Returns the features of a body that `expected` accepts, as they are written outside the body.
    pub(in crate::check) fn features_of(&self, body: &Name, expected: impl Fn(Feature) -> bool) -> Vec<String> {
        let Some(Entity::Body(k)) = self.scope.entity(body) else { return Vec::new() };
        let space = self.bodies.get(k).and_then(|id| self.common.features.get(id));
        let names = space.into_iter().flat_map(|space| space.suggestions(&self.reporter, &expected));
        names.take(MOST_PLACES).map(|name| format!("`{}.{name}`", body.text)).collect()
    }

    /// Suggests a feature that fits instead of the one that `owner.feature` names.
    pub(in crate::check) fn suggest_feature(&self, e: &Expr, expected: impl Fn(Feature) -> bool) -> Option<Fix> {
        let ExprKind::Member { owner, feature } = &e.kind else { return None };
        let name = self.common.features.get(&self.frame_of(owner)?)?.names(expected).next()?;
        Some(Fix::probably(feature.span, name, format!("was `{}.{name}` meant?", owner.text)))
    }

    /// Returns the bodies named in the other arguments of a joint, which cannot own the name.
    pub(in crate::check) fn owners_in_arguments(&self, name: Span) -> Vec<&str> {
        let arguments = self.scope.items().iter().find_map(|item| match &item.kind {
            ItemKind::Joint { arguments, .. } if arguments.iter().any(|e| e.span == name) => Some(arguments),
            _ => None,
        });
        let owner = |e: &Expr| match &e.kind {
            ExprKind::Member { owner, .. } => Some(self.reporter.text(owner.span)),
            _ => None,
        };
        arguments.map(|arguments| arguments.iter().filter_map(owner).collect()).unwrap_or_default()
    }
}

/// The largest number of further locations that one message shows.
const MOST_PLACES: usize = 4;

/// Merges the diagnostics of one undeclared name into one with all locations.
pub(in crate::check) fn merge_unknown_names(all: Diagnostics) -> Diagnostics {
    let mut merged: Vec<Diagnostic> = Vec::new();
    let mut positions = FxHashMap::default();
    for diagnostic in all {
        // Messages that depend on the arguments differ, and stay separate.
        let key = (diagnostic.message.clone(), diagnostic.help.clone());
        let at = *positions.entry(key).or_insert(merged.len());
        let Some(first) = merged.get_mut(at).filter(|_| diagnostic.code == Code::E0201) else {
            merged.push(diagnostic);
            continue;
        };
        let place = diagnostic.labels.iter().find(|label| label.primary).map(|label| label.span);
        if let Some(span) = place.filter(|_| first.labels.len() <= MOST_PLACES) {
            *first = first.clone().also(span, "and here");
        }
        // One fix changes all locations.
        for fix in diagnostic.fixes {
            if let Some(same) = first.fixes.iter_mut().find(|other| other.message == fix.message) {
                same.edits.extend(fix.edits);
            }
        }
    }
    let mut diagnostics = Diagnostics::default();
    diagnostics.extend(merged);
    diagnostics
}
