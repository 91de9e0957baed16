//! Where a mechanism begins that has parts, or is told other inputs than its own: each part where it comes to alone and is led to what its
//! inputs are; the whole where the inputs that it is told lead it, from where it is with its own.

use crate::analysis::{self, LeadOptions, NotLed};
use crate::check::{self, Given, Lead, Setting, Surroundings};
use crate::diag::{Code, Diagnostic, Diagnostics, readable};
use crate::ir::{ConstraintSystem, PartStart};
use crate::lower;
use crate::model::Led;
use crate::program::Program;
use crate::source::{Sources, Span};
use crate::structure::Determined;
use crate::syntax::{self, ast};
use rustc_hash::FxHashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Inputs that one message tells at most.
const TOLD: usize = 8;

/// What it takes to lead a mechanism to the inputs that it is told, and its parts to theirs.
#[derive(Debug)]
pub(super) struct Leading {
    pub read: Arc<syntax::Parsed>,
    /// Its number in the file.
    pub number: usize,
    pub surroundings: Surroundings,
    pub sources: Sources,
    /// Whether it is told inputs.
    pub is_told: bool,
}

impl Leading {
    /// Where it begins at a time (s), its own inputs being led from the one that the options tell; nothing where its estimates say it, with
    /// what is to be said.
    pub fn begin(
        &self,
        (determined, program): (&Arc<Determined>, &Arc<Program>),
        t: f64,
        leave_out_redundant: bool,
        options: &LeadOptions,
    ) -> (Option<Vec<f64>>, Diagnostics) {
        let mut starts = Starts {
            surroundings: &self.surroundings,
            sources: &self.sources,
            leave_out_redundant,
            options,
            alone: FxHashMap::default(),
            led: FxHashMap::default(),
            said: Diagnostics::default(),
        };
        let led =
            if self.is_told { starts.led_to_what_it_is_told(&self.read.tree.mechanisms[self.number], t) } else { None };
        let system = determined.system();
        let begin = led.or_else(|| {
            let settings = &self.surroundings.settings;
            (!system.parts.is_empty()).then(|| starts.with_parts((determined, program), t, settings))
        });
        (begin, starts.said)
    }
}

/// A mechanism that is compiled.
type Whole = (Arc<Determined>, Arc<Program>);

/// A mechanism that stands alone, with its own inputs.
struct Alone {
    surroundings: Surroundings,
    /// The first time of its own analysis (s).
    t: f64,
    /// Where it is then; where it is drawn if it cannot be assembled.
    q: Vec<f64>,
    is_assembled: bool,
    /// What is to be said of its start.
    remarks: Diagnostics,
}

/// What decides how a part is alone: its text, what its params are, and the path of which something is set from outside.
type Key = (Span, Vec<u64>, String);

struct Starts<'s> {
    surroundings: &'s Surroundings,
    sources: &'s Sources,
    leave_out_redundant: bool,
    options: &'s LeadOptions,
    alone: FxHashMap<Key, Option<Rc<Alone>>>,
    /// With the inputs to which they were led, and the time.
    led: FxHashMap<(Key, Vec<u64>), Vec<f64>>,
    said: Diagnostics,
}

impl<'s> Starts<'s> {
    fn led_to_what_it_is_told(&mut self, tree: &ast::Mechanism, t: f64) -> Option<Vec<f64>> {
        let times = [self.options.t, t];
        let lead = Some(Lead { times, inputs: Vec::new() });
        let led = Surroundings { lead, by: Vec::new(), ..self.surroundings.clone() };
        // of a mechanism whose own inputs have no value there is no way; all else has been said of it
        let (whole, inputs, span) = self.compiled(tree, &led)?;
        let from = if whole.0.system().parts.is_empty() {
            None
        } else {
            let own = Surroundings { given: Given::default(), by: Vec::new(), ..self.surroundings.clone() };
            Some(self.assembled(tree, own)?.q)
        };
        match analysis::lead(&whole.0, &whole.1, from.as_deref(), self.options) {
            Ok(arrived) => {
                self.said.extend(arrived.remarks);
                Some(arrived.q)
            }
            Err(NotLed::Stopped { part, why }) if !self.options.cancel.is_cancelled() => {
                self.said.push(not_led(None, &inputs, times, span, part, &why));
                None
            }
            // alone it is nowhere, so that there is nothing to lead
            Err(_) => None,
        }
    }

    /// A mechanism on its way, with the inputs that are led.
    fn compiled(&self, tree: &ast::Mechanism, surroundings: &Surroundings) -> Option<(Whole, Vec<Led>, Span)> {
        let (model, _) = check::check(tree, surroundings, self.sources);
        let model = model?;
        let system = lower::lower(&model);
        let (determined, _) = analysis::determine(system, self.leave_out_redundant).ok()?;
        let program = Arc::new(Program::new(determined.system()));
        Some(((Arc::new(determined), program), model.led, model.declared.span))
    }

    /// The estimates of a mechanism, with its parts where they begin.
    fn with_parts(
        &mut self,
        (determined, program): (&Arc<Determined>, &Arc<Program>),
        t: f64,
        settings: &[Setting],
    ) -> Vec<f64> {
        let system = determined.system();
        let estimates = system.coordinates.iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect();
        let cancel = self.options.cancel.clone();
        let mut leader = |part: usize, inputs: Option<&[f64]>| self.part(system, part, inputs, t, settings);
        analysis::with_parts(determined, program, t, estimates, &mut leader, &cancel)
    }

    /// Where a part is alone, with its inputs led to these.
    fn part(
        &mut self,
        system: &ConstraintSystem,
        part: usize,
        inputs: Option<&[f64]>,
        t: f64,
        settings: &[Setting],
    ) -> Option<Vec<f64>> {
        let start = &system.parts[part];
        let params: Vec<(String, f64)> =
            start.params.iter().map(|(name, id)| (name.clone(), system.value_at(*id, &[]))).collect();
        let settings = within(settings, &start.name);
        let path = if settings.is_empty() { String::new() } else { start.name.clone() };
        let key = (start.text, params.iter().map(|(_, value)| value.to_bits()).collect(), path);
        let alone = self.alone(start, &key, params, settings)?;
        let Some(inputs) = inputs.filter(|_| alone.is_assembled) else { return Some(alone.q.clone()) };
        let ends: Vec<u64> = inputs.iter().chain([&t]).map(|value| value.to_bits()).collect();
        if let Some(known) = self.led.get(&(key.clone(), ends.clone())) {
            return Some(known.clone());
        }
        let q = self.led_part(start, &alone, inputs, t).unwrap_or_else(|| alone.q.clone());
        self.led.insert((key, ends), q.clone());
        Some(q)
    }

    fn led_part(&mut self, start: &PartStart, alone: &Alone, inputs: &[f64], t: f64) -> Option<Vec<f64>> {
        let tree = self.text_of(start)?;
        let times = [alone.t, t];
        let targets = start.inputs.iter().zip(inputs).map(|((name, _), value)| (name.clone(), *value)).collect();
        let led = Surroundings { lead: Some(Lead { times, inputs: targets }), ..alone.surroundings.clone() };
        let (whole, inputs, span) = self.compiled(tree, &led)?;
        match analysis::lead(&whole.0, &whole.1, Some(&alone.q), self.options) {
            Ok(arrived) => Some(arrived.q),
            Err(NotLed::Stopped { part, why }) if !self.options.cancel.is_cancelled() => {
                self.said.push(not_led(Some(start), &inputs, times, span, part, &why));
                None
            }
            Err(_) => None,
        }
    }

    fn alone(
        &mut self,
        start: &PartStart,
        key: &Key,
        params: Vec<(String, f64)>,
        settings: Vec<Setting>,
    ) -> Option<Rc<Alone>> {
        if let Some(known) = self.alone.get(key) {
            return known.clone();
        }
        let Surroundings { library, files, .. } = self.surroundings.clone();
        let given = Given::default();
        let by = Vec::new();
        let (lead, has_signals) = (None, false);
        let surroundings = Surroundings { settings, library, files, given, by, bound: params, lead, has_signals };
        let alone = self.text_of(start).and_then(|tree| self.assembled(tree, surroundings)).map(Rc::new);
        if let Some(alone) = &alone {
            self.said.extend(alone.remarks.clone());
        }
        self.alone.insert(key.clone(), alone.clone());
        alone
    }

    /// A mechanism at the first time of its own analysis, with its own inputs.
    fn assembled(&mut self, tree: &ast::Mechanism, surroundings: Surroundings) -> Option<Alone> {
        let (model, _) = check::check(tree, &surroundings, self.sources);
        let model = model?;
        let t = model.analysis.map_or(0.0, |analysis| analysis.from);
        let system = lower::lower(&model);
        let drawn = |system: &ConstraintSystem| -> Vec<f64> {
            system.coordinates.iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect()
        };
        let estimates = drawn(&system);
        let mut alone = Alone { surroundings, t, q: estimates, is_assembled: false, remarks: Diagnostics::default() };
        let Ok((determined, _)) = analysis::determine(system, self.leave_out_redundant) else { return Some(alone) };
        let program = Arc::new(Program::new(determined.system()));
        let determined = Arc::new(determined);
        if !determined.system().parts.is_empty() {
            alone.q = self.with_parts((&determined, &program), t, &alone.surroundings.settings);
        }
        let LeadOptions { tolerance, cancel, .. } = self.options;
        let started = analysis::start_from(determined, program, t, Some(&alone.q), *tolerance, cancel);
        if let Ok(started) = started {
            alone.remarks = started.remarks();
            alone.q = started.q().to_vec();
            alone.is_assembled = true;
        }
        Some(alone)
    }

    fn text_of(&self, start: &PartStart) -> Option<&'s ast::Mechanism> {
        let surroundings: &'s Surroundings = self.surroundings;
        surroundings.library.mechanism_at(start.text)
    }
}

/// What is set from outside in a part, by its names.
fn within(settings: &[Setting], part: &str) -> Vec<Setting> {
    let is_it = |owner: &str| owner == part || part.split_once('[').is_some_and(|(base, _)| base == owner);
    let inner = |setting: &Setting| {
        let (owner, path) = setting.path.split_once('.')?;
        is_it(owner.trim()).then(|| Setting { path: path.trim().to_owned(), value: setting.value.clone() })
    };
    settings.iter().filter_map(inner).collect()
}

/// A way that ends before it is gone, at a part of it from 0 to 1, with what happens there; of a mechanism or of a part of it.
fn not_led(
    of: Option<&PartStart>,
    inputs: &[Led],
    times: [f64; 2],
    whole: Span,
    part: f64,
    why: &Diagnostic,
) -> Diagnostic {
    let moving: Vec<&Led> = inputs.iter().filter(|input| input.line[0].total_cmp(&input.line[1]).is_ne()).collect();
    let what = if why.code == Code::E0602 { "a dead point" } else { why.code.title() };
    let here = moving.first().map(|input| format!(" at `{}` = {}", input.declared.name, value_at(input, part)));
    let here = here.unwrap_or_default();
    let message = match of {
        None => format!("on the way to the inputs that are given there is {what}{here}"),
        Some(of) => format!("on the way of the part `{}` to its inputs there is {what}{here}", of.name),
    };
    let mut diagnostic = Diagnostic::new(Code::E0612, message);
    for (k, input) in moving.iter().take(TOLD).enumerate() {
        let [from, to, here] = [0.0, 1.0, part].map(|part| value_at(input, part));
        let text = format!("led from {from} to {to}, and got to {here}");
        let span = input.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    let stop = why.labels.first().map_or(whole, |label| label.span);
    diagnostic = if moving.is_empty() { diagnostic.at(stop, "stops it") } else { diagnostic.also(stop, "stops it") };
    let (tried, mend) = match of {
        None => (
            "the estimates in `at` alone are tried instead, which may mean another branch",
            "give the input a formula of its own from which a way leads to what is given",
        ),
        Some(_) => (
            "the part is assembled with the whole instead, which may mean another branch",
            "give the part's input a formula of its own from which a way leads to what it is bound to",
        ),
    };
    if let Some(of) = of {
        diagnostic = diagnostic.also(of.span, format!("in part `{}`, used here", of.name));
    }
    diagnostic.note(tried).help(mend).datum("part", part).datum("t", times[0] + (times[1] - times[0]) * part)
}

/// The value of an input at a part of its way, with its unit.
fn value_at(input: &Led, part: f64) -> String {
    let [from, to] = input.line;
    let value = from + (to - from) * part;
    let text = readable(format!("{value:.9e}").parse().unwrap_or(value));
    match input.dimension.unit().as_str() {
        "1" => text,
        unit => format!("{text} {unit}"),
    }
}
