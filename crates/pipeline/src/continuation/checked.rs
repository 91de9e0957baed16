//! Continuation of a checked mechanism: which of its settings a path can change, and the mechanism without them.

use super::context::Nominal;
use super::nominal::Continuation;
use crate::{Checked, Configuration, Redundant, RunOptions};
use mechc_engine::analysis::{Horizon, Solving};
use mechc_engine::sweep::CompiledSystem;
use mechc_lang::check::{CheckOptions, InputOverrides, ParamOverride};
use std::sync::Arc;

impl Checked {
    /// Returns the continuation from nominal values to what is set; all mechanisms whose settings are of the same params have the same one.
    pub(crate) fn continuation(&self, redundant: Redundant) -> Arc<Continuation> {
        let checked = self.clone();
        Arc::new(Continuation::new(move |options| checked.with_nominal_values()?.nominal(redundant, None, options)))
    }

    /// Returns the mechanism with its nominal values, the params of all settings as symbols; settings that decide counts are kept.
    fn with_nominal_values(&self) -> Option<Checked> {
        self.with_symbolic_settings(self.count_settings())
    }

    /// Returns the settings that decide counts of declarations: no path leads from one number of bodies to another.
    pub(crate) fn count_settings(&self) -> Vec<ParamOverride> {
        let counts = self.settings_without_symbol(Vec::new());
        // with other counts there may be more params that a path can change
        if counts.is_empty() { counts } else { self.settings_without_symbol(counts) }
    }

    /// Returns the settings that are no symbols of the model if `set` alone is set; `set` itself if that has errors.
    fn settings_without_symbol(&self, set: Vec<ParamOverride>) -> Vec<ParamOverride> {
        let Some(symbolic) = self.with_symbolic_settings(set.clone()).filter(Checked::is_sound) else { return set };
        let is_symbol =
            |path: &str| ["", ".x", ".y"].iter().any(|axis| symbolic.param_in_part(&format!("{path}{axis}")).is_some());
        self.check_options.settings.iter().filter(|setting| !is_symbol(&setting.path)).cloned().collect()
    }

    /// Returns the mechanism with `settings` in place of its own, and the params of its own settings as symbols of the model.
    fn with_symbolic_settings(&self, settings: Vec<ParamOverride>) -> Option<Checked> {
        let open = self.check_options.settings.iter().map(|setting| setting.path.clone()).collect();
        let options =
            CheckOptions { settings, given: InputOverrides::default(), open, ..(*self.check_options).clone() };
        self.checked_again(options, false)
    }

    /// Returns the mechanism with params of the given names as symbols of the model.
    pub(crate) fn with_symbolic_params(&self, open: Vec<String>) -> Option<Checked> {
        let options = CheckOptions { open, ..(*self.check_options).clone() };
        self.checked_again(options, false)
    }

    /// Compiles the mechanism and assembles it at its first time, or near a configuration; `None` if that fails.
    pub(crate) fn nominal(
        &self,
        redundant: Redundant,
        near: Option<&Configuration>,
        options: &RunOptions,
    ) -> Option<Nominal> {
        let (compiled, model) = (self.compile(redundant, &options.cancel).0?, Arc::clone(self.model.as_ref()?));
        let t = near.map_or_else(|| compiled.first_time(), |near| near.t);
        let horizon = Horizon::of_analysis(compiled.analysis()).beginning(t);
        let started = match near {
            None => compiled.start(horizon, options).0.ok()?,
            Some(near) => compiled.unassembled(horizon, options).assemble_at(&near.q, Solving::New).ok()?,
        };
        let (determined, program) = (Arc::clone(compiled.determined()), Arc::clone(compiled.program()));
        let sets_inputs = self.settable_inputs.as_ref().is_some_and(|inputs| !inputs.names.is_empty());
        let leave_out_redundant = redundant == Redundant::LeftOut;
        Some(Nominal {
            compiled: CompiledSystem { determined, program },
            model,
            started,
            t,
            sets_inputs,
            leave_out_redundant,
        })
    }
}
