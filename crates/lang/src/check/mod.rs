//! From the tree to the model: names, units, values and elements.
//!
//! The check continues after an error where it can, so that several errors give several messages. What depends on something broken gives
//! none. Formulas, including those of functions, are expanded into one graph at each use. Expansions are cached, so that functions with
//! common subformulas take linear time.

mod build;
mod declaration_info;
mod errors;
mod expansion;
mod formulas;
mod library;
mod options;
mod scope;
mod suggest;
mod symbols;

pub use declaration_info::{Amount, DeclarationCount, DeclarationInfo, Index, Value as ConstantValue, known, slopes};
pub(crate) use errors::not_finite;
pub use formulas::{Column, FormulaOfTime, UNTIL, amount, constant, formula_of_time, override_matches, variants};
pub use library::{Library, LibraryFile, LibraryMechanism, LookupError};
pub use options::{CheckOptions, InputOverrides, ParamOverride, TableFiles};
pub use scope::name_of;
pub use suggest::missing_unit::usual_unit_of_length;
pub use symbols::{DeclaredName, Meaning, NameId, NameKind, Symbols, Use};

use crate::model::Mechanism;
use build::{build, formulas_of_instance, has_broken};
use errors::Reporter;
use expansion::instance_of;
use formulas::{Formulas, Variables};
use mechc_syntax::ast;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use scope::Space;

/// Checks that the mechanisms of a file have different names.
#[must_use]
pub fn check_file(file: &ast::File) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    let mut space: Space<()> = Space::new();
    let named = file.mechanisms.iter().filter(|mechanism| !mechanism.name.text.is_empty());
    for mechanism in named {
        if let Err(first) = space.declare(&mechanism.name, ()) {
            diagnostics.push(errors::second_mechanism(&mechanism.name, first));
        }
    }
    diagnostics
}

/// Checks a mechanism. Returns its model if it has no errors, and all diagnostics.
#[must_use]
pub fn check(tree: &ast::Mechanism, options: &CheckOptions, sources: &Sources) -> (Option<Mechanism>, Diagnostics) {
    let (instance, reported) = instance_of(tree, options, sources);
    let mut formulas = formulas_of_instance(&instance, options, sources, "", &[]);
    formulas.bind_numbers(&options.bound);
    formulas.common.variables = Variables::new(&options.by);
    formulas.collect_variables();
    build(&mut formulas);
    let Formulas { reporter: Reporter { mut diagnostics, .. }, mut model, .. } = formulas;
    diagnostics.extend(reported);
    model.slopes = options.slopes.map(|is_of_text| {
        let formula = |end: usize| model.analysis.map(|analysis| analysis.formulas[end]).filter(|_| is_of_text[end]);
        [formula(0), formula(1)]
    });
    if instance.is_expanded() {
        diagnostics.dedup_by_span();
    }
    diagnostics.sort_by_span();
    let diagnostics = suggest::names::merge_unknown_names(diagnostics);
    let sound = !diagnostics.has_errors() && !has_broken(instance.tree());
    (sound.then_some(model), diagnostics)
}
