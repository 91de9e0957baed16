//! Params, functions, tables, inputs, measures and results, in their order of dependence.

use super::Formulas;
use super::functions::Function;
use super::inputs::InputState;
use super::measures::MeasureState;
use super::overrides::override_matches;
use super::params::ParamState;
use super::reductions::ResultState;
use super::tables::TableState;
use crate::check::scope::{DefinitionOrder, Entity, ordered, visit_free_names};
use mechc_syntax::ast::{Expr, Item, ItemKind, Name, TableRows};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

impl<'a> Formulas<'a> {
    /// Evaluates params and tables and checks functions in order of dependence, and records the order of measures and of results.
    pub(in crate::check) fn definitions(&mut self) {
        let (mut definitions, mut docs, mut entities) = (Vec::new(), Vec::new(), Vec::new());
        for item in self.scope.items() {
            if let Some((entity, name, formulas)) = self.definition(item, &entities) {
                entities.push(entity);
                definitions.push((name, formulas));
                docs.push(&item.docs);
            }
        }
        self.import_params();
        let uses = self.uses(&definitions, &entities);
        let DefinitionOrder { order, on_cycles } = ordered(&mut self.reporter, &uses);
        self.define_parts_on_cycles(on_cycles.iter().map(|&at| entities[at]));
        let (mut measures, mut results) = (Vec::new(), Vec::new());
        for at in order {
            let (name, formulas) = &definitions[at];
            match entities[at] {
                Entity::Param(k) => formulas.iter().for_each(|value| self.define_param(k, name, docs[at], value)),
                Entity::Function(k) => self.function(k),
                Entity::Table(k) => self.table(k),
                Entity::Input(k) => self.input(k),
                Entity::Part(k) if k < self.parts.len() => self.definitions_of_part(k),
                Entity::Measure(k) => {
                    self.measures[k].dimensional = formulas.iter().any(|value| self.is_dimensional(value));
                    measures.push(k);
                }
                Entity::Result(k) => {
                    self.results[k].dimensional = formulas.iter().any(|value| self.is_dimensional(value));
                    results.push(k);
                }
                _ => {}
            }
        }
        (self.measure_order, self.result_order) = (measures, results);
    }

    /// Returns the entity that a declaration defines, with its name and formulas. It is added without a value.
    fn definition(&mut self, item: &'a Item, before: &[Entity]) -> Option<(Entity, &'a Name, Vec<&'a Expr>)> {
        Some(match &item.kind {
            ItemKind::Param { name, value } => {
                self.params.push(ParamState { written: Some((name, value)), ..ParamState::default() });
                (Entity::Param(self.params.len() - 1), name, vec![value])
            }
            ItemKind::Function { name, argument, value } => {
                self.functions.push(Function { argument, value, dimensional: false, time: None, sound: false });
                (Entity::Function(self.functions.len() - 1), name, vec![value])
            }
            ItemKind::Input { name, value } => {
                let given = self.options.given.formulas.iter();
                let path = format!("{}{}", self.scope.path, name.text);
                let override_formula =
                    given.filter(|(full, _)| override_matches(&path, full)).map(|(_, formula)| formula);
                let formulas = std::iter::once(value).chain(override_formula).collect();
                self.inputs.push(InputState { name, formula: value, value: None });
                (Entity::Input(self.inputs.len() - 1), name, formulas)
            }
            ItemKind::Measure { name, value, unit } => {
                self.measures.push(MeasureState::new(name, value, unit.as_ref()));
                (Entity::Measure(self.measures.len() - 1), name, vec![value])
            }
            ItemKind::Result { name, value, unit } => {
                self.results.push(ResultState::new(value, unit.as_ref()));
                (Entity::Result(self.results.len() - 1), name, vec![value])
            }
            ItemKind::Table { name, periodic, rows } => {
                let periodic = *periodic;
                self.tables.push(TableState { name, periodic, rows, dimensional: false, made: None });
                let formulas = match rows {
                    TableRows::Listed(rows) => rows.iter().collect(),
                    TableRows::File { .. } => Vec::new(),
                };
                (Entity::Table(self.tables.len() - 1), name, formulas)
            }
            ItemKind::Part(part) => {
                let k = before.iter().filter(|entity| matches!(entity, Entity::Part(_))).count();
                let bindings = part.bindings.iter().filter(|binding| self.binds_definition(k, binding));
                (Entity::Part(k), &part.name, bindings.map(|binding| &binding.value).collect())
            }
            _ => return None,
        })
    }

    /// Evaluates parts on a cycle of definitions without bindings, so that all that they declare exists.
    fn define_parts_on_cycles(&mut self, on_cycles: impl Iterator<Item = Entity>) {
        for entity in on_cycles {
            if let Entity::Part(k) = entity
                && k < self.parts.len()
            {
                self.definitions_of_unbound_part(k);
            }
        }
    }

    fn uses<'d>(
        &self,
        definitions: &[(&'d Name, Vec<&Expr>)],
        entities: &[Entity],
    ) -> Vec<(&'d Name, Vec<(usize, Span)>)> {
        let position: FxHashMap<Entity, usize> = entities.iter().enumerate().map(|(k, &e)| (e, k)).collect();
        let arguments: FxHashMap<usize, &str> = entities
            .iter()
            .enumerate()
            .filter_map(|(k, entity)| match entity {
                Entity::Function(f) => Some((k, self.functions[*f].argument.text.as_str())),
                _ => None,
            })
            .collect();
        definitions
            .iter()
            .enumerate()
            .map(|(k, (name, formulas))| {
                let mut uses = Vec::new();
                for formula in formulas {
                    visit_free_names(
                        formula,
                        |name| self.scope.hides(name),
                        |used, is_called| {
                            // `speed(P)` is a quantity, whatever else is called `speed`.
                            let is_of_motion = self.scope.quantity_word(used).is_some()
                                || self.scope.reduction_word(used, 1).is_some();
                            if is_called && is_of_motion {
                                return;
                            }
                            let hidden = arguments.get(&k) == Some(&used.text.as_str());
                            let is_user_name = !hidden && !self.scope.is_reserved_but_declared(used);
                            let entity = self.scope.entity(used).filter(|_| is_user_name);
                            // A name in a part depends on the part, unless no number of it is used here.
                            let part = used.text.split_once('.').and_then(|(part, _)| self.scope.get(part));
                            let entity = match entity {
                                Some(Entity::Body(_) | Entity::Joint(_) | Entity::Equation(_) | Entity::Ground) => None,
                                entity => part.or(entity),
                            };
                            // An input in an option's formula is reported with that option.
                            let is_from_option = self.reporter.sources.get(used.span.file).is_option;
                            let entity =
                                entity.filter(|entity| !(is_from_option && matches!(entity, Entity::Input(_))));
                            if let Some(&at) = entity.and_then(|e| position.get(&e)) {
                                uses.push((at, used.span));
                            }
                        },
                    );
                }
                (*name, uses)
            })
            .collect()
    }
}
