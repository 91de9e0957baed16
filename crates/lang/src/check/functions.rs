//! The user's functions.

use super::Checker;
use super::entity::Entity;
use super::formula::{Context, Dim, Value};
use super::mentions::mentioned;
use crate::model::Named;
use mechc_syntax::ast::{Expr, Name};
use mechc_text::source::Span;

/// What is known of a user's function.
pub(super) struct Function<'a> {
    pub argument: &'a Name,
    pub value: &'a Expr,
    /// Holds a unit, or something that does.
    pub dimensional: bool,
    /// Where time comes in, if it does.
    pub time: Option<Span>,
    /// Whether its formula can be read at all.
    pub sound: bool,
}

impl Checker<'_> {
    /// Reads a function's formula once on its own, so that its mistakes are found even if nobody calls it.
    pub(super) fn function(&mut self, at: usize) {
        let (argument, value) = (self.functions[at].argument, self.functions[at].value);
        self.functions[at].dimensional = self.is_dimensional_over(Some(&argument.text), value);
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
        let known = self.model.conditions.len();
        let sound = self.formula(value, &context).is_some();
        // what must be positive is asked where the function is called
        self.model.conditions.truncate(known);
        self.functions[at].sound = sound;
    }

    /// Where a formula brings time in, if it does.
    fn time_in(&self, formula: &Expr, argument: &Name) -> Option<Span> {
        let mut time = None;
        mentioned(
            formula,
            |name| self.hidden.contains(name),
            |name, _| {
                let through_a_name = match self.entity(name) {
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
