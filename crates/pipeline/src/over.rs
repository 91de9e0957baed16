//! A mechanism that is led over from the values that its text gives to its params to others: all that such variants share, and one of them.

use super::angles::Angles;
use super::lead::{Told, not_led, passed};
use super::lowered::lowered_on_its_way;
use super::options::RunOptions;
use mechc_engine::analysis::{self, Horizon, LeadOptions, Started, Times};
use mechc_engine::sweep::{Arrived, Base, Lost, Together, WantedOfEach, Whole};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::Program;
use mechc_lang::lower::Clock;
use mechc_lang::model::{self, Mechanism};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, Diagnostics};
use std::sync::{Arc, OnceLock};

/// Where a mechanism begins that was led there, or why it cannot; nothing where no way leads there. With what is to be said of the way.
type Led = (Option<Result<Started, Box<Diagnostic>>>, Diagnostics);

/// Where the values of params lead.
pub(super) enum Reached {
    /// To where they say; it begins there, or cannot.
    There(Result<Box<Started>, Box<Diagnostic>>),
    /// Results refuse the times before anything is led.
    Refused(Diagnostics),
    /// Nowhere; with where the way ends, if it is known that one begins.
    Nowhere(Option<Box<Diagnostic>>),
}

/// A mechanism with its own values: compiled, and where it stands at its own first time.
pub(super) struct Own {
    pub whole: Whole,
    /// It knows the params that may be led.
    pub model: Arc<Mechanism>,
    pub started: Started,
    /// When that is (s).
    pub t: f64,
    /// Whether it has inputs that are set at a time.
    pub sets_inputs: bool,
    /// Whether redundant equations are left out.
    pub leave_out_redundant: bool,
    /// For messages.
    pub angles: Angles,
}

/// Makes a mechanism with its own values; nothing where it does not stand with these.
type MakesOwn = dyn Fn(&RunOptions) -> Option<Own> + Send + Sync;

/// From where a mechanism is led over to others: what it is with its own values is looked at when somebody asks for it.
pub(super) struct FromOwn {
    own: Box<MakesOwn>,
    known: OnceLock<Option<Arc<Over>>>,
}

impl FromOwn {
    /// Of what makes it; nothing where the mechanism does not stand with its own values.
    pub fn new(own: impl Fn(&RunOptions) -> Option<Own> + Send + Sync + 'static) -> FromOwn {
        FromOwn { own: Box::new(own), known: OnceLock::new() }
    }

    /// A system of the same text with its values where it begins, with what is to be said of its way; nothing where none leads there.
    pub fn lead(&self, system: &ConstraintSystem, horizon: Horizon, options: &RunOptions) -> Led {
        self.over(options).map_or_else(Default::default, |over| over.lead(system, horizon, &options.cancel))
    }

    /// The same of the values of all params, without a word of a way that leads there; with what results may ask of the times.
    pub fn lead_values(&self, values: &[f64], times: &Times, options: &RunOptions) -> Reached {
        let lead = |over: Arc<Over>| over.lead_values(values, times, &options.cancel);
        self.over(options).map_or(Reached::Nowhere(None), lead)
    }

    /// What variants share that go side by side, which differ in some of its params, by their numbers; nothing where they had better go alone.
    pub fn together(&self, params: &[u32], wanted: &WantedOfEach<'_>, options: &RunOptions) -> Option<Together> {
        let over = self.over(options)?;
        if wanted.rows.0.from().to_bits() != over.options.t.to_bits() {
            return None;
        }
        let base = over.base(&over.values, wanted.rows.0.from(), &options.cancel)?;
        Together::of(base, &over.own.started, params, wanted, options.vectors)
    }

    fn over(&self, options: &RunOptions) -> Option<Arc<Over>> {
        let new = || (self.own)(options).map(|own| Arc::new(Over::of(own, options)));
        match self.known.get() {
            Some(Some(known)) if !known.is_of(options) => new(),
            Some(known) => known.clone(),
            None => {
                let over = new();
                // what was given up says nothing
                if options.cancel.is_cancelled() { None } else { self.known.get_or_init(|| over).clone() }
            }
        }
    }
}

/// What leads a mechanism over from its own values to others.
struct Over {
    own: Own,
    values: Vec<f64>,
    options: LeadOptions,
    /// For variants that begin at its own first time, and for others.
    bases: [OnceLock<Option<Base>>; 2],
}

impl Over {
    fn of(own: Own, options: &RunOptions) -> Over {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let options = LeadOptions { tolerance, pass_bifurcations, t: own.t, cancel: cancel.clone() };
        let (values, bases) = (own.whole.0.system().values_of_params(), [OnceLock::new(), OnceLock::new()]);
        Over { own, values, options, bases }
    }

    /// Whether it was made with such options.
    fn is_of(&self, options: &RunOptions) -> bool {
        self.options.tolerance.to_bits() == options.tolerance.to_bits()
            && self.options.pass_bifurcations == options.pass_bifurcations
    }

    /// A system of the same text with its values where it begins, with what is to be said of its way; nothing where none leads there.
    fn lead(&self, system: &ConstraintSystem, horizon: Horizon, cancel: &Cancel) -> Led {
        let mut said = Diagnostics::default();
        let values = system.values_of_params();
        let Some(base) = self.base(&values, horizon.from, cancel) else { return (None, said) };
        let (times, lines) = ([self.options.t, self.end(horizon.from)], || self.lines(system, &values));
        match base.alone(base.variant(&values), horizon, cancel) {
            Ok(Arrived { started, passed: by, said: on_the_way }) => {
                said.extend(self.own.started.far_estimates_at(self.own.t));
                said.extend(by.iter().map(|(part, what)| passed(None, &lines(), times, *part, what)));
                said.extend(on_the_way);
                (Some(Ok(started)), said)
            }
            Err(Lost::There(why)) => (Some(Err(why)), said),
            Err(Lost::OnItsWay(..)) if cancel.is_cancelled() => (None, said),
            Err(Lost::OnItsWay(part, why)) => {
                said.push(not_led(None, &lines(), times, self.own.model.declared.span, part, &why));
                (None, said)
            }
        }
    }

    /// The same of the values of all params, without a word of a way that leads there.
    fn lead_values(&self, values: &[f64], times: &Times, cancel: &Cancel) -> Reached {
        let Some(base) = self.base(values, times.from(), cancel) else { return Reached::Nowhere(None) };
        let variant = base.variant(values);
        let refused = times.interval().map(|interval| analysis::refused_results(variant.system(), interval));
        if let Some(refused) = refused.filter(Diagnostics::has_errors) {
            return Reached::Refused(refused);
        }
        match base.alone(Arc::clone(&variant), Horizon::of(times), cancel) {
            Ok(arrived) => Reached::There(Ok(Box::new(arrived.started))),
            Err(Lost::There(why)) => Reached::There(Err(why)),
            Err(Lost::OnItsWay(..)) if cancel.is_cancelled() => Reached::Nowhere(None),
            Err(Lost::OnItsWay(part, why)) => {
                let (lines, ends) = (self.lines(variant.system(), values), [self.options.t, self.end(times.from())]);
                Reached::Nowhere(Some(Box::new(not_led(None, &lines, ends, self.own.model.declared.span, part, &why))))
            }
        }
    }

    /// When the way ends (s) of variants that are wanted from a time on.
    fn end(&self, from: f64) -> f64 {
        if self.own.sets_inputs { from } else { self.options.t }
    }

    /// What its params are led along.
    fn lines(&self, system: &ConstraintSystem, values: &[f64]) -> Vec<Told> {
        let line = |led: &model::Led| {
            let k = led.param? as usize;
            Some(model::Led {
                line: [self.values[k], values[k]],
                dimension: system.params()[k].dimension,
                ..led.clone()
            })
        };
        let lines: Vec<model::Led> = self.own.model.led.iter().filter_map(line).collect();
        Told::of(&lines, &self.own.angles)
    }

    /// What variants of so many values that begin at a time (s) share.
    fn base(&self, values: &[f64], from: f64, cancel: &Cancel) -> Option<&Base> {
        // inputs that are set have their values at that time, and not before
        let goes = self.own.sets_inputs && from.to_bits() != self.options.t.to_bits();
        let place = &self.bases[usize::from(goes)];
        if place.get().is_none() {
            let base = self.new_base(goes, cancel);
            // what was given up says nothing
            if cancel.is_cancelled() {
                return None;
            }
            let _ = place.set(base);
        }
        place.get()?.as_ref().filter(|_| values.len() == self.values.len())
    }

    fn new_base(&self, goes: bool, cancel: &Cancel) -> Option<Base> {
        let clock = if goes { Clock::Goes } else { Clock::Still(self.options.t) };
        let system = lowered_on_its_way(&self.own.model, clock);
        let leave_out = self.own.leave_out_redundant;
        let (determined, _) = analysis::determine(system, leave_out, Horizon::of_analysis(None)).ok()?;
        let program = Arc::new(Program::new(determined.system()));
        let on_its_way: Whole = (Arc::new(determined), program);
        let led = self.own.model.led.iter().filter_map(|led| led.param).collect();
        let options = LeadOptions { cancel: cancel.clone(), ..self.options.clone() };
        Base::new(self.own.whole.clone(), &self.own.started, on_its_way, (led, goes), options).ok()
    }
}
