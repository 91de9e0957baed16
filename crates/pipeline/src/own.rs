//! A mechanism with the values of its own text, from which it is led over to others.

use super::angles::Angles;
use super::over::{FromOwn, Own};
use super::{Checked, Redundant, RunOptions};
use mechc_engine::analysis::Horizon;
use mechc_lang::check::{Given, Setting, Surroundings};
use mechc_text::diag::Diagnostics;
use std::sync::Arc;

impl Checked {
    /// From where it is led to what is set: of all mechanisms whose settings are of the same params, it is the same one.
    pub(super) fn begins_at_own(&self, redundant: Redundant) -> Arc<FromOwn> {
        let led = self.clone();
        Arc::new(FromOwn::new(move |options| led.at_own_values()?.stands(redundant, options)))
    }

    /// The same with its own values, of which those that are set may be others; but what decides how often something is there is as it is set.
    fn at_own_values(&self) -> Option<Checked> {
        self.opened_with(self.counts())
    }

    /// Those of its settings that decide how often something is there: nothing leads from one number of bodies to another.
    pub(super) fn counts(&self) -> Vec<Setting> {
        let counts = self.not_led_with(Vec::new());
        // with more bodies there may be more that is led
        if counts.is_empty() { counts } else { self.not_led_with(counts) }
    }

    /// Those of its settings that are no params of the mechanism with some of them; these, if it is none.
    fn not_led_with(&self, set: Vec<Setting>) -> Vec<Setting> {
        let Some(opened) = self.opened_with(set.clone()).filter(Checked::is_sound) else { return set };
        let is_led =
            |path: &str| ["", ".x", ".y"].iter().any(|axis| opened.param_in_part(&format!("{path}{axis}")).is_some());
        self.surroundings.settings.iter().filter(|setting| !is_led(&setting.path)).cloned().collect()
    }

    /// The same with its own values but for some settings, and with the params of all settings as symbols of the model.
    fn opened_with(&self, settings: Vec<Setting>) -> Option<Checked> {
        let open = self.surroundings.settings.iter().map(|setting| setting.path.clone()).collect();
        let surroundings = Surroundings { settings, given: Given::default(), open, ..(*self.surroundings).clone() };
        Some(Checked::in_surroundings(self.parsed.clone(), self.number?, surroundings, false, Diagnostics::default()))
    }

    /// The same with params of some names as symbols of the model, which says what they are.
    pub(super) fn with_open(&self, open: Vec<String>) -> Option<Checked> {
        let surroundings = Surroundings { open, ..(*self.surroundings).clone() };
        Some(Checked::in_surroundings(self.parsed.clone(), self.number?, surroundings, false, Diagnostics::default()))
    }

    /// Where it stands at its own first time; nothing where it does not.
    pub(super) fn stands(&self, redundant: Redundant, options: &RunOptions) -> Option<Own> {
        let (compiled, model) = (self.compile(redundant, &options.cancel).0?, Arc::clone(self.model.as_ref()?));
        let t = compiled.analysis().map_or(0.0, |[from, ..]| from);
        let horizon = Horizon::of_analysis(compiled.analysis()).beginning(t);
        let started = compiled.start(horizon, &RunOptions { stand: None, ..options.clone() }).0.ok()?;
        let whole = (Arc::clone(compiled.determined()), Arc::clone(compiled.program()));
        let angles = Angles::of(self.library(), self.sources());
        let sets_inputs = self.surroundings.set_inputs.as_ref().is_some_and(|set| !set.names.is_empty());
        Some(Own {
            whole,
            model,
            started,
            t,
            sets_inputs,
            leave_out_redundant: redundant == Redundant::LeftOut,
            angles,
        })
    }
}
