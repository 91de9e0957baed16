//! Where a mechanism begins that is told other inputs than its own: where these lead it, from where it is with its own.

use crate::analysis::{self, LeadOptions, NotLed};
use crate::check::{self, Lead, Surroundings};
use crate::diag::{Code, Diagnostic, Diagnostics, readable};
use crate::lower;
use crate::model::Led;
use crate::program::Program;
use crate::source::{Sources, Span};
use crate::syntax;
use std::sync::Arc;

/// Inputs that one message tells at most.
const TOLD: usize = 8;

/// What it takes to lead a mechanism to the inputs that it is told.
#[derive(Debug)]
pub(super) struct Leading {
    pub read: Arc<syntax::Parsed>,
    /// Its number in the file.
    pub number: usize,
    pub surroundings: Surroundings,
    pub sources: Sources,
}

impl Leading {
    /// Where it comes to at a time (s), from the one that the options tell; nothing where it cannot be led, with what is to be said.
    pub fn lead(&self, t: f64, leave_out_redundant: bool, options: &LeadOptions) -> (Option<Vec<f64>>, Diagnostics) {
        let times = [options.t, t];
        let surroundings = Surroundings { lead: Some(Lead { times, inputs: Vec::new() }), ..self.surroundings.clone() };
        let tree = &self.read.tree.mechanisms[self.number];
        // of a mechanism whose own inputs have no value there is no way; all else has been said of it
        let (Some(model), _) = check::check(tree, &surroundings, &self.sources) else {
            return (None, Diagnostics::default());
        };
        let Ok((determined, _)) = analysis::determine(lower::lower(&model), leave_out_redundant) else {
            return (None, Diagnostics::default());
        };
        let program = Arc::new(Program::new(determined.system()));
        match analysis::lead(&Arc::new(determined), &program, options) {
            Ok(arrived) => (Some(arrived.q), arrived.remarks),
            Err(NotLed::Stopped { part, why }) if !options.cancel.is_cancelled() => {
                (None, not_led(&model.led, times, model.declared.span, part, &why).into())
            }
            // alone it is nowhere, so that there is nothing to lead
            Err(_) => (None, Diagnostics::default()),
        }
    }
}

/// A way that ends before it is gone, at a part of it from 0 to 1, with what happens there.
fn not_led(inputs: &[Led], times: [f64; 2], whole: Span, part: f64, why: &Diagnostic) -> Diagnostic {
    let moving: Vec<&Led> = inputs.iter().filter(|input| input.line[0].total_cmp(&input.line[1]).is_ne()).collect();
    let what = if why.code == Code::E0602 { "a dead point" } else { why.code.title() };
    let here = moving.first().map(|input| format!(" at `{}` = {}", input.declared.name, value_at(input, part)));
    let here = here.unwrap_or_default();
    let mut diagnostic =
        Diagnostic::new(Code::E0612, format!("on the way to the inputs that are given there is {what}{here}"));
    for (k, input) in moving.iter().take(TOLD).enumerate() {
        let [from, to, here] = [0.0, 1.0, part].map(|part| value_at(input, part));
        let text = format!("led from {from} to {to}, and got to {here}");
        let span = input.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    let stop = why.labels.first().map_or(whole, |label| label.span);
    diagnostic = if moving.is_empty() { diagnostic.at(stop, "stops it") } else { diagnostic.also(stop, "stops it") };
    diagnostic
        .note("the estimates in `at` alone are tried instead, which may mean another branch")
        .help("give the input a formula of its own from which a way leads to what is given")
        .datum("part", part)
        .datum("t", times[0] + (times[1] - times[0]) * part)
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
