//! The model of a mechanism: bodies, features, joints, equations, loads, measures, results and requirements, of the text and of its parts.
//!
//! This layer owns the order in which declarations are read. Values of formulas, and names, are asked of the layers below.

// a method of a type with a lifetime is not general enough in the place of a closure
#![allow(clippy::redundant_closure_for_method_calls)]

mod equations;
mod features;
mod joints;
mod loads;
mod measures;
mod part_placement;
mod parts;
mod poses;
mod profiles;
mod requirements;
mod results;

pub(in crate::check) use parts::formulas_of_instance;

use super::errors;
use super::formulas::Formulas;
use mechc_syntax::ast::{self, Expr, ExprKind, ItemKind};
use std::rc::Rc;

/// Adds everything that a mechanism and its parts declare to the model of its formulas.
pub(in crate::check) fn build(formulas: &mut Formulas<'_>) {
    Builder { formulas }.run();
}

/// Adds the declarations of a mechanism or part to the model.
struct Builder<'b, 'a> {
    formulas: &'b mut Formulas<'a>,
}

impl<'a> Builder<'_, 'a> {
    /// Runs `work` in the builder of a part.
    fn in_part(&mut self, part: usize, work: impl FnOnce(&mut Builder<'_, 'a>)) {
        self.formulas.in_part(part, |formulas| work(&mut Builder { formulas }));
    }

    /// Runs `work` in the builder of every part.
    fn in_parts(&mut self, work: impl Fn(&mut Builder<'_, 'a>)) {
        self.formulas.in_parts(|formulas| work(&mut Builder { formulas }));
    }

    fn run(&mut self) {
        self.formulas.check_param_overrides();
        self.formulas.check_input_overrides();
        self.formulas.samples = self.formulas.read_samples().map(Rc::new);
        self.formulas.definitions();
        self.formulas.resolve_column_variables();
        self.features();
        self.joints();
        self.formulas.bind_inputs();
        // Efforts refer to equations, which must then come first. Otherwise measures come first, as the order of symbols affects the last
        // bits of rows.
        let uses_efforts = uses_efforts(self.formulas);
        if uses_efforts {
            self.equations();
        }
        self.formulas.measure_values();
        self.list_measures();
        if !uses_efforts {
            self.equations();
        }
        self.gravity();
        self.loads();
        self.analysis();
        self.results();
        self.requirements();
        self.formulas.reject_derivatives_of_forces();
        self.formulas.warn_of_plain_lengths();
        if self.formulas.model.bodies.is_empty() && !holds_broken(self.formulas) {
            self.formulas.reporter.report(errors::empty(&self.formulas.scope.tree.name));
        }
    }
}

/// Returns whether a measure or result of this text or of a part uses an effort.
fn uses_efforts(formulas: &Formulas<'_>) -> bool {
    let is_effort = |e: &Expr| matches!(&e.kind, ExprKind::Call { name, .. } if name.text == "effort");
    let asks = |e: &Expr| e.parts().any(is_effort);
    let in_text = formulas.scope.items().iter().any(|item| match &item.kind {
        ItemKind::Measure { value, .. } | ItemKind::Result { value, .. } | ItemKind::Trace { point: value, .. } => {
            asks(value)
        }
        _ => false,
    });
    in_text || formulas.parts.iter().any(uses_efforts)
}

/// Returns whether the mechanism or one of its parts has a declaration that could not be parsed.
fn holds_broken(formulas: &Formulas<'_>) -> bool {
    has_broken(formulas.scope.tree) || formulas.parts.iter().any(holds_broken)
}

/// Returns whether a declaration or feature of a mechanism does not follow the grammar.
pub(in crate::check) fn has_broken(tree: &ast::Mechanism) -> bool {
    tree.items.iter().any(|item| match &item.kind {
        ItemKind::Broken { .. } => true,
        ItemKind::Ground { features } | ItemKind::Body { features, .. } => {
            features.iter().any(|feature| feature.kind == ast::FeatureKind::Broken)
        }
        _ => false,
    })
}
