//! A mechanism whose params take other values without another check, as sliders set them: it is compiled once, and continued from its nominal
//! values to others along its branch.

use crate::continuation::Continuation;
use crate::param_table::ParamTable;
use crate::{Checked, Compiled, Redundant, SettableParam};
use mechc_lang::check::{CheckOptions, ParamOverride};
use mechc_syntax::{self as syntax, ast};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use std::sync::Arc;

/// The option that sets params, as messages name it.
const SET: &str = "--set";

/// A mechanism with params that take values.
pub struct ParametricMechanism {
    /// The mechanism with the values of its text, these params as symbols.
    nominal: Checked,
    /// Continued from its own values to those that are bound.
    compiled: Compiled,
    /// The diagnostics of the check and of the proof.
    diagnostics: Diagnostics,
    table: ParamTable,
    /// The params that are asked for. In the table they follow those that options set.
    params: Vec<SettableParam>,
    /// The settings of the options, and the values (SI) of their params.
    settings: Vec<ParamOverride>,
    set: Vec<f64>,
}

impl Checked {
    /// Returns the mechanism with the given params, and those that options set, as numbers that take other values. `None` if it has errors or
    /// is not determined, if one of them decides how many declarations there are, if inputs are given, or if the work is cancelled.
    #[must_use]
    pub fn parametric(&self, params: &[String], redundant: Redundant, cancel: &Cancel) -> Option<ParametricMechanism> {
        if self.has_given_inputs() {
            return None;
        }
        let mut open: Vec<String> = Vec::new();
        for ParamOverride { path, .. } in &self.check_options.settings {
            if !params.contains(path) && !open.contains(path) {
                open.push(path.clone());
            }
        }
        let set = open.iter().map(|path| Some(self.param_in_part(path)?.0)).collect::<Option<Vec<f64>>>()?;
        open.extend_from_slice(params);
        let options = CheckOptions { settings: Vec::new(), open: open.clone(), ..(*self.check_options).clone() };
        let nominal = self.checked_again(options, false)?;
        let (compiled, more) = nominal.compile(redundant, cancel);
        let mut diagnostics = nominal.diagnostics().clone();
        diagnostics.extend(more);
        let source = nominal.clone();
        let continuation = Arc::new(Continuation::new(move |options| source.nominal(redundant, None, options)));
        let compiled = compiled?.with_continuation(Some(continuation));
        let param = |path: &String| {
            let (value, dimension) = nominal.param_in_part(path)?;
            Some(SettableParam { name: path.clone(), unit: String::new(), value, dimension })
        };
        let mut all = open.iter().map(param).collect::<Option<Vec<SettableParam>>>()?;
        let values: Vec<f64> = all.iter().map(|param| param.value).collect();
        let (params, settings) = (all.split_off(set.len()), self.check_options.settings.clone());
        let table = ParamTable::new(nominal.model()?, &open, &values);
        if table.targets().any(<[usize]>::is_empty) {
            return None;
        }
        Some(ParametricMechanism { nominal, compiled, diagnostics, table, params, settings, set })
    }
}

impl ParametricMechanism {
    /// Returns the mechanism with values of its params, formulas as `--set` takes them, to which it is continued, and the diagnostics of its
    /// check and proof. `None` if a formula is wrong, or if the mechanism has to be checked anew because other values decide otherwise.
    #[must_use]
    pub fn with(&self, formulas: &[&str]) -> Option<(Checked, Compiled, Diagnostics)> {
        let mut sources = self.nominal.sources().clone();
        let (mut values, mut settings) = (self.set.clone(), self.settings.clone());
        for (param, formula) in self.params.iter().zip(formulas) {
            values.push(param.read(SET, "the parameter", formula, &mut sources).ok()?);
            settings.push(setting(&param.name, formula, &mut sources)?);
        }
        let bindings = self.table.bind(&values)?;
        let origin = self.compiled.origin();
        let mut model = (*origin.model).clone();
        model.set_values(&bindings.values, bindings.analysis);
        let model = Arc::new(model);
        let checked = self.nominal.bound(Arc::clone(&model), settings, sources);
        let compiled = self.compiled.bound(checked.origin(&model, origin.redundant), &bindings.values);
        Some((checked, compiled, self.diagnostics.clone()))
    }
}

/// Returns the setting of a param to a formula.
fn setting(name: &str, formula: &str, sources: &mut Sources) -> Option<ParamOverride> {
    let file = sources.add_option(format!("{SET} {name}"), formula);
    let value: ast::Expr = syntax::parse_expression(sources, file).ok()?;
    Some(ParamOverride { path: name.to_owned(), value })
}
