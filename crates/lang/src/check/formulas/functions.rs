//! The user's functions.

use super::Formulas;
use super::value::{Context, Dim, Value};
use crate::check::scope::{Entity, visit_free_names};
use crate::model::Named;
use mechc_syntax::ast::{Expr, Name};
use mechc_text::source::Span;

/// The state of a user's function.
pub(in crate::check) struct Function<'a> {
    pub argument: &'a Name,
    pub value: &'a Expr,
    /// True if it holds a unit, directly or through names.
    pub dimensional: bool,
    /// The location at which it uses time, if it does.
    pub time: Option<Span>,
    /// True if its formula can be read.
    pub sound: bool,
}

impl Formulas<'_> {
    /// Checks a function's formula on its own, so that its errors are found even without calls.
    pub(in crate::check) fn function(&mut self, at: usize) {
        let (argument, value) = (self.functions[at].argument, self.functions[at].value);
        self.functions[at].dimensional = self.is_dimensional_with(Some(&argument.text), value);
        self.functions[at].time = self.time_in(value, argument);
        self.functions[at].sound = true;
        let named = self.name_symbol(Named::Argument, 0);
        let context = Context {
            time: true,
            inputs: true,
            expands: false,
            argument: Some((&argument.text, Value { id: named, dim: Dim::UNFIT })),
            ..Context::constant("a function")
        };
        let before = self.model.conditions.len();
        let sound = self.formula(value, &context).is_some();
        // Conditions apply where the function is called.
        self.model.conditions.truncate(before);
        self.functions[at].sound = sound;
    }

    /// Returns the location at which a formula uses time.
    fn time_in(&self, formula: &Expr, argument: &Name) -> Option<Span> {
        let mut time = None;
        visit_free_names(
            formula,
            |name| self.scope.hides(name),
            |name, _| {
                let through_a_name = match self.scope.entity(name) {
                    Some(Entity::Function(k)) => self.functions[k].time.is_some(),
                    Some(Entity::Input(_)) => true,
                    _ => false,
                };
                if time.is_none() && name.text != argument.text && (name.text == "t" || through_a_name) {
                    time = Some(name.span);
                }
            },
        );
        time
    }
}
