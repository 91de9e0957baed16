//! Where a mechanism begins that has parts, or is told other inputs than its own: each part where it comes to alone and is led to what its
//! inputs are; the whole where the inputs that it is told lead it, from where it is with its own.

use super::angles::Angles;
use super::lines::{Line, Target, lines};
use super::lowered::lowered;
use super::options::RunOptions;
use mechc_engine::analysis::{self, Horizon, LeadOptions, Request, Solving, Unassembled};
use mechc_expr::Symbol;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_ir::{ConstraintSystem, PartStart};
use mechc_lang::check::{self, Given, Lead, Setting, Surroundings};
use mechc_lang::model::{Led, Mechanism};
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};
use mechc_text::source::{Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;
use std::sync::Arc;

/// Inputs that one message tells at most.
const TOLD: usize = 8;

/// What it takes to lead a mechanism to the inputs that it is told, and its parts to theirs.
#[derive(Debug)]
pub(super) struct Leading {
    pub read: Arc<syntax::ParsedText>,
    /// Its number in the file.
    pub number: usize,
    pub surroundings: Surroundings,
    pub sources: Sources,
    /// Whether it is told inputs.
    pub is_told: bool,
}

/// From where a mechanism is led to the inputs that it is told.
pub(super) enum Outset {
    /// From where its own inputs have it at a time (s).
    Own(f64),
    /// From where it stands at a time (s): its coordinates [m, rad].
    At(f64, Vec<f64>),
    /// From nowhere: the text's estimates are all that is known.
    Estimates,
}

/// What a mechanism is assembled from [m, rad].
pub(super) enum Begin {
    /// The position that it was led to.
    Position(Vec<f64>),
    /// Estimates with its parts where they begin; those of the text, if there is nothing else.
    Estimates(Option<Vec<f64>>),
}

impl Leading {
    /// Where it begins at a time (s), its inputs being led there; with what is to be said.
    pub fn begin(
        &self,
        (determined, program): (&Arc<Determined>, &Arc<Program>),
        horizon: Horizon,
        outset: &Outset,
        leave_out_redundant: bool,
        options: &RunOptions,
    ) -> (Begin, Diagnostics) {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let (t, stands) = match outset {
            Outset::Own(t) => (*t, None),
            Outset::At(t, q) => (*t, Some(q.as_slice())),
            Outset::Estimates => (horizon.from, None),
        };
        let options = &LeadOptions { tolerance, pass_bifurcations, t, cancel: cancel.clone() };
        let mut starts = Starts {
            surroundings: &self.surroundings,
            sources: &self.sources,
            stands,
            leave_out_redundant,
            options,
            alone: FxHashMap::default(),
            led: FxHashMap::default(),
            said: Diagnostics::default(),
        };
        let led = if self.is_told && !matches!(outset, Outset::Estimates) {
            starts.led_to_what_it_is_told(&self.read.tree.mechanisms[self.number], horizon.from)
        } else {
            None
        };
        let begin = led.map_or_else(
            || {
                let settings = &self.surroundings.settings;
                let has_parts = !determined.system().parts().is_empty();
                let drawn = has_parts.then(|| starts.with_parts((determined, program), horizon, settings));
                Begin::Estimates(drawn)
            },
            Begin::Position,
        );
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
    /// What its inputs are then (SI), by their names.
    inputs: FxHashMap<String, f64>,
    /// Where it is then; where it is drawn if it cannot be assembled.
    q: Vec<f64>,
    is_assembled: bool,
    /// What is to be said of its start.
    remarks: Diagnostics,
}

/// A part that is to be led.
struct ToLead<'p> {
    start: &'p PartStart,
    alone: Rc<Alone>,
    /// To these (SI).
    inputs: &'p [f64],
    ends: Ends,
}

impl ToLead<'_> {
    /// What its inputs are alone (SI).
    fn own_inputs(&self) -> Option<Vec<f64>> {
        self.start.inputs.iter().map(|(name, _)| self.alone.inputs.get(name).copied()).collect()
    }
}

/// What a part is alone, and with inputs and a time to which it is led.
type Ends = (Key, Vec<u64>);

/// A part as it is alone, and to what it is led, if it is led.
type Found = (Option<Ends>, Rc<Alone>);

/// What decides how a part is alone: its text, what its params are, and the path of which something is set from outside.
type Key = (Span, Vec<u64>, String);

struct Starts<'s> {
    surroundings: &'s Surroundings,
    sources: &'s Sources,
    /// Where it stands before it is led, if that is known [m, rad].
    stands: Option<&'s [f64]>,
    leave_out_redundant: bool,
    options: &'s LeadOptions,
    alone: FxHashMap<Key, Option<Rc<Alone>>>,
    /// With the inputs to which they were led, and the time.
    led: FxHashMap<Ends, Vec<f64>>,
    said: Diagnostics,
}

impl<'s> Starts<'s> {
    fn led_to_what_it_is_told(&mut self, tree: &ast::Mechanism, t: f64) -> Option<Vec<f64>> {
        let times = [self.options.t, t];
        let lead = Some(Lead { times, inputs: Vec::new() });
        let led = Surroundings {
            lead,
            by: Vec::new(),
            slopes: None,
            reactions: false,
            pictures_forces: false,
            ..self.surroundings.clone()
        };
        // of a mechanism whose own inputs have no value there is no way; all else has been said of it
        let (whole, inputs, span) = self.compiled(tree, &led)?;
        let from = if let Some(stands) = self.stands {
            Some(stands.to_vec())
        } else if whole.0.system().parts().is_empty() {
            None
        } else {
            let own = Surroundings {
                given: Given::default(),
                by: Vec::new(),
                reactions: false,
                pictures_forces: false,
                ..self.surroundings.clone()
            };
            Some(self.assembled(tree, own)?.q)
        };
        // if alone it is nowhere, there is nothing to lead
        let way = analysis::lead(&whole.0, &whole.1, from.as_deref(), &[1.0], self.options).ok()?;
        match way.stopped {
            None => {
                self.said.extend(way.remarks);
                let remarks = |(part, what): &_| passed(None, &self.told(&inputs), times, *part, what);
                let passed: Vec<Diagnostic> = way.passed.iter().map(remarks).collect();
                self.said.extend(passed);
            }
            Some(_) if self.options.cancel.is_cancelled() => {}
            Some((part, why)) => self.said.push(not_led(None, &self.told(&inputs), times, span, part, &why)),
        }
        way.reached.into_iter().next()
    }

    /// A mechanism on its way, with the inputs that are led.
    fn compiled(&self, tree: &ast::Mechanism, surroundings: &Surroundings) -> Option<(Whole, Vec<Led>, Span)> {
        let (model, _) = check::check(tree, surroundings, self.sources);
        let model = model?;
        let system = lowered(&model);
        let horizon = Horizon::of_analysis(system.analysis());
        let (determined, _) = analysis::determine(system, self.leave_out_redundant, horizon).ok()?;
        let program = Arc::new(Program::new(determined.system()));
        Some(((Arc::new(determined), program), model.led, model.declared.span))
    }

    /// The estimates of a mechanism, with its parts where they begin.
    fn with_parts(
        &mut self,
        (determined, program): (&Arc<Determined>, &Arc<Program>),
        horizon: Horizon,
        settings: &[Setting],
    ) -> Vec<f64> {
        let system = determined.system();
        let estimates =
            system.coordinates().iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect();
        let cancel = self.options.cancel.clone();
        let mut leader = |asked: &[Request]| self.parts(system, asked, horizon.from, settings);
        analysis::with_parts(determined, program, horizon, estimates, &mut leader, &cancel)
    }

    /// Where parts are alone, with their inputs led to what is asked.
    fn parts(
        &mut self,
        system: &ConstraintSystem,
        asked: &[Request],
        t: f64,
        settings: &[Setting],
    ) -> Vec<Option<Vec<f64>>> {
        let mut to_lead: Vec<ToLead<'_>> = Vec::new();
        let mut found: Vec<Option<Found>> = Vec::with_capacity(asked.len());
        let mut is_asked: FxHashSet<Ends> = FxHashSet::default();
        for Request { part, inputs } in asked {
            let start = &system.parts()[*part];
            let Some((key, alone)) = self.part_alone(system, start, settings) else {
                found.push(None);
                continue;
            };
            let inputs = inputs.as_ref().filter(|_| alone.is_assembled);
            let ends = inputs.map(|inputs| (key, inputs.iter().chain([&t]).map(|value| value.to_bits()).collect()));
            if let (Some(inputs), Some(ends)) = (inputs, &ends)
                && !self.led.contains_key(ends)
                && is_asked.insert(ends.clone())
            {
                to_lead.push(ToLead { start, alone: Rc::clone(&alone), inputs, ends: ends.clone() });
            }
            found.push(Some((ends, alone)));
        }
        self.lead_all(&to_lead, t);
        let place = |(ends, alone): Found| {
            let led = ends.and_then(|ends| self.led.get(&ends).cloned());
            led.unwrap_or_else(|| alone.q.clone())
        };
        found.into_iter().map(|found| found.map(place)).collect()
    }

    /// A part as it is alone.
    fn part_alone(
        &mut self,
        system: &ConstraintSystem,
        start: &PartStart,
        settings: &[Setting],
    ) -> Option<(Key, Rc<Alone>)> {
        let params: Vec<(String, f64)> =
            start.params.iter().map(|(name, id)| (name.clone(), system.value_at(*id, &[]))).collect();
        let settings = within(settings, &start.name);
        let path = if settings.is_empty() { String::new() } else { start.name.clone() };
        let key = (start.text, params.iter().map(|(_, value)| value.to_bits()).collect(), path);
        let alone = self.alone(start, &key, params, settings)?;
        Some((key, alone))
    }

    /// Leads parts to what is asked, and says which did not get there, in their order.
    fn lead_all(&mut self, parts: &[ToLead<'_>], t: f64) {
        let own: Vec<Option<Vec<f64>>> = parts.iter().map(ToLead::own_inputs).collect();
        let targets: Vec<Target<'_, Key>> = parts
            .iter()
            .zip(&own)
            .map(|(part, own)| {
                let is_later = part.alone.t.total_cmp(&t).is_ne();
                Target { key: &part.ends.0, own: own.as_deref(), inputs: part.inputs, is_later }
            })
            .collect();
        let mut said: Vec<(usize, Diagnostic)> = Vec::new();
        for line in lines(&targets) {
            self.lead_along(&line, parts, t, &mut said);
        }
        said.sort_by_key(|(part, _)| *part);
        self.said.extend(said.into_iter().map(|(_, diagnostic)| diagnostic));
    }

    /// Leads parts that lie on one line.
    fn lead_along(&mut self, line: &Line, parts: &[ToLead<'_>], t: f64, said: &mut Vec<(usize, Diagnostic)>) {
        let ToLead { start, ref alone, inputs, .. } = parts[line.farthest];
        let times = [alone.t, t];
        let targets = start.inputs.iter().zip(inputs).map(|((name, _), value)| (name.clone(), *value)).collect();
        let led = Surroundings { lead: Some(Lead { times, inputs: targets }), ..alone.surroundings.clone() };
        let Some((whole, inputs, span)) = self.text_of(start).and_then(|tree| self.compiled(tree, &led)) else {
            return;
        };
        let stops: Vec<f64> = line.stops.iter().map(|(part, _)| *part).collect();
        let Ok(way) = analysis::lead(&whole.0, &whole.1, Some(&alone.q), &stops, self.options) else { return };
        let mut reached = way.reached.into_iter();
        for (part_of_line, numbers) in &line.stops {
            let q = reached.next();
            for &number in numbers {
                let ToLead { start, ends, .. } = &parts[number];
                match (&q, &way.stopped) {
                    (Some(q), _) => {
                        self.led.insert(ends.clone(), q.clone());
                        let inputs = shortened(&inputs, *part_of_line);
                        let before = way.passed.iter().filter(|(part, _)| part <= part_of_line);
                        said.extend(before.map(|(part, what)| {
                            (number, passed(Some(start), &self.told(&inputs), times, part / part_of_line, what))
                        }));
                    }
                    (None, Some((part, why))) if !self.options.cancel.is_cancelled() => {
                        let inputs = self.told(&shortened(&inputs, *part_of_line));
                        said.push((number, not_led(Some(start), &inputs, times, span, part / part_of_line, why)));
                    }
                    (None, _) => {}
                }
            }
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
        let surroundings = Surroundings {
            settings,
            library,
            files,
            given: Given::default(),
            by: Vec::new(),
            slopes: None,
            reactions: false,
            pictures_forces: false,
            bound: params,
            lead: None,
            open: Vec::new(),
            set_inputs: None,
            has_signals: false,
            coupled: Vec::new(),
        };
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
        let inputs = own_inputs(&model, t);
        let system = lowered(&model);
        let drawn = |system: &ConstraintSystem| -> Vec<f64> {
            system.coordinates().iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect()
        };
        let estimates = drawn(&system);
        let remarks = Diagnostics::default();
        let mut alone = Alone { surroundings, t, inputs, q: estimates, is_assembled: false, remarks };
        let horizon = Horizon::of_analysis(system.analysis()).beginning(t);
        let Ok((determined, _)) = analysis::determine(system, self.leave_out_redundant, horizon) else {
            return Some(alone);
        };
        let program = Arc::new(Program::new(determined.system()));
        let determined = Arc::new(determined);
        if !determined.system().parts().is_empty() {
            alone.q = self.with_parts((&determined, &program), horizon, &alone.surroundings.settings);
        }
        let LeadOptions { tolerance, pass_bifurcations, ref cancel, .. } = *self.options;
        let cancel = cancel.clone();
        let whole = Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel };
        if let Ok(started) = analysis::start_from(&whole, Some(&alone.q), Solving::With(None)) {
            alone.remarks = started.remarks();
            alone.q = started.q().to_vec();
            alone.is_assembled = true;
        }
        Some(alone)
    }

    /// What is led, as messages tell it.
    fn told(&self, inputs: &[Led]) -> Vec<Told> {
        Told::of(inputs, &Angles::of(&self.surroundings.library, self.sources))
    }

    fn text_of(&self, start: &PartStart) -> Option<&'s ast::Mechanism> {
        let surroundings: &'s Surroundings = self.surroundings;
        surroundings.library.mechanism_at(start.text)
    }
}

/// What the inputs of a mechanism are at a time (SI), by their names.
fn own_inputs(model: &Mechanism, t: f64) -> FxHashMap<String, f64> {
    let value = |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        Symbol::Time => t,
        _ => f64::NAN,
    };
    model.inputs.iter().map(|input| (input.declared.name.clone(), model.graph.value(input.value, value))).collect()
}

/// The lines of inputs, up to a part of them.
fn shortened(inputs: &[Led], part: f64) -> Vec<Led> {
    let shorter = |input: &Led| {
        let [from, to] = input.line;
        Led { line: [from, from + (to - from) * part], ..input.clone() }
    };
    inputs.iter().map(shorter).collect()
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

/// What is led, as messages tell it.
pub(super) struct Told {
    led: Led,
    /// Its SI unit; empty for a pure number.
    unit: String,
}

impl Told {
    /// What has another value at the end of the way.
    pub fn of(inputs: &[Led], angles: &Angles) -> Vec<Told> {
        let moving = inputs.iter().filter(|input| input.line[0].total_cmp(&input.line[1]).is_ne());
        let told = |led: &Led| {
            let unit = match led.dimension.unit().as_str() {
                "1" if angles.has(led.declared.span) => "rad".to_owned(),
                "1" => String::new(),
                unit => unit.to_owned(),
            };
            Told { led: led.clone(), unit }
        };
        moving.map(told).collect()
    }

    /// The value at a part of the way, with its unit.
    fn value_at(&self, part: f64) -> String {
        let [from, to] = self.led.line;
        let value = from + (to - from) * part;
        let text = readable(format!("{value:.9e}").parse().unwrap_or(value));
        if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) }
    }
}

/// A way that ends before it is gone, at a part of it from 0 to 1, with what happens there; of a mechanism or of a part of it.
pub(super) fn not_led(
    of: Option<&PartStart>,
    moving: &[Told],
    times: [f64; 2],
    whole: Span,
    part: f64,
    why: &Diagnostic,
) -> Diagnostic {
    let what = if why.code == Code::E0602 { "a dead point" } else { why.code.title() };
    let here = moving.first().map(|input| format!(" at `{}` = {}", input.led.declared.name, input.value_at(part)));
    let here = here.unwrap_or_default();
    let message = match of {
        None => format!("on the way to {} there is {what}{here}", aim(moving)),
        Some(of) => format!("on the way of the part `{}` to its inputs there is {what}{here}", of.name),
    };
    let mut diagnostic = Diagnostic::new(Code::E0612, message);
    for (k, input) in moving.iter().take(TOLD).enumerate() {
        let [from, to, here] = [0.0, 1.0, part].map(|part| input.value_at(part));
        let text = format!("{}led from {from} to {to}, and got to {here}", named(input, moving));
        let span = input.led.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    let stop = why.labels.first().map_or(whole, |label| label.span);
    diagnostic = if moving.is_empty() { diagnostic.at(stop, "stops it") } else { diagnostic.also(stop, "stops it") };
    let (tried, mend) = match of {
        None => (
            "the estimates in `at` alone are tried instead, which may mean another branch",
            if is_of_params(moving) {
                "set a value from before that"
            } else {
                "give the input a formula of its own from which a way leads to what is given"
            },
        ),
        Some(_) => (
            "the part is assembled with the whole instead, which may mean another branch",
            "give the part's input a formula of its own from which a way leads to what it is bound to",
        ),
    };
    if let Some(of) = of {
        diagnostic = diagnostic.in_part(&of.name, of.span);
    }
    diagnostic.note(tried).help(mend).datum("part", part).datum("t", times[0] + (times[1] - times[0]) * part)
}

/// Which one is spoken of, where several stand in one place: the coordinates of a point.
fn named(input: &Told, moving: &[Told]) -> String {
    let Told { led, .. } = input;
    let beside = moving.iter().filter(|other| other.led.declared.span == led.declared.span).count();
    if beside > 1 { format!("`{}` ", led.declared.name) } else { String::new() }
}

/// A bifurcation that was passed at a part of a way, from 0 to 1; of a mechanism or of a part of it.
pub(super) fn passed(
    of: Option<&PartStart>,
    moving: &[Told],
    times: [f64; 2],
    part: f64,
    what: &Diagnostic,
) -> Diagnostic {
    let here = moving.first().map(|input| format!(" at `{}` = {}", input.led.declared.name, input.value_at(part)));
    let way = match of {
        None => format!("on the way to {}", aim(moving)),
        Some(of) => format!("on the way of the part `{}` to its inputs", of.name),
    };
    let message = format!(
        "{way} two branches of the motion meet{}; the one that continues smoothly was taken",
        here.unwrap_or_default()
    );
    let mut diagnostic = Diagnostic::new(Code::W0602, message);
    for (k, input) in moving.iter().take(TOLD).enumerate() {
        let [from, to, here] = [0.0, 1.0, part].map(|part| input.value_at(part));
        let text = format!("{}led from {from} to {to}, by way of {here}", named(input, moving));
        let span = input.led.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    for (k, label) in what.labels.iter().enumerate() {
        let is_first = k == 0 && moving.is_empty();
        let text = label.text.clone();
        diagnostic = if is_first { diagnostic.at(label.span, text) } else { diagnostic.also(label.span, text) };
    }
    if let Some(of) = of {
        diagnostic = diagnostic.in_part(&of.name, of.span);
    }
    diagnostic = what.notes.iter().cloned().fold(diagnostic, Diagnostic::note);
    diagnostic.datum("part", part).datum("t", times[0] + (times[1] - times[0]) * part)
}

fn is_of_params(moving: &[Told]) -> bool {
    moving.iter().any(|told| told.led.param.is_some())
}

/// What a mechanism is led to.
fn aim(moving: &[Told]) -> &'static str {
    if is_of_params(moving) { "the values that are set" } else { "the inputs that are given" }
}
