//! Diagnostics of results and reductions.

use mechc_syntax::ast::{ComparisonSign, Name};
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix, readable};
use mechc_text::source::Span;
use mechc_text::vocabulary::ReductionWord;

/// The explanation of `max` and `min` with a wrong number of arguments.
pub const REDUCES: &str = "with one argument it takes the whole analysis, in a `result`";

/// A reduction outside results.
pub fn reduction_in(place: &str, word: &ReductionWord, span: Span) -> Diagnostic {
    let name = word.word.name;
    Diagnostic::new(Code::E0322, format!("the reduction `{name}` may not stand in {place}"))
        .at(span, "known only when the motion is over")
        .help(format!("reductions stand in results: `result NAME = {}`", word.word.forms.first().unwrap_or(&name)))
}

/// A result where results are not allowed.
pub fn result_in(place: &str, name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0322, format!("the result `{}` may not stand in {place}", name.text))
        .at(name.span, "known only when the motion is over")
        .help("results stand in other results")
}

/// A value that varies with time in a result, but outside a reduction.
pub fn outside_reduction(what: &str, span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::E0322, format!("{what} stands outside a reduction"))
        .at(span, "changes with time, and a result is one number")
        .help(format!("say which number of it is meant: `max({text})`, `mean({text})`, `last({text})`"))
}

/// A window of a call that is not a reduction.
pub fn window_of_no_reduction(called: &Name, span: Span) -> Diagnostic {
    let name = &called.text;
    let (why, help) = match name.as_str() {
        "max" | "min" => {
            ("of several values takes", format!("with one argument it reduces: `{name}({name}(a, b), from A to B)`"))
        }
        "at" => ("takes a time and", "the value at the beginning of a window is `first(e, from A)`".to_owned()),
        _ => ("takes", "reductions take windows: `max(e, from A to B)`, `mean(e, from A)`".to_owned()),
    };
    Diagnostic::new(Code::E0322, format!("`{name}` {why} no window")).at(span, "a part of the analysis").help(help)
}

/// The help for `from` and `to` that are read as names before an operator.
pub fn signed_bound(word: &str) -> String {
    format!("a time of a window that begins with a sign stands in parentheses: `{word} (-1 s)`")
}

/// A window that ends before it starts (s).
pub fn window_ends_early(word: &ReductionWord, span: Span, [from, to]: [f64; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0422, format!("the window of `{}` ends before it begins", word.word.name))
        .at(span, format!("from {} s to {} s", readable(from), readable(to)))
        .help("a window goes from the earlier to the later time")
}

/// `der` of a number of the whole analysis.
pub fn derivative_of_result(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "a result has no time derivative")
        .at(span, "one number for the whole analysis")
        .help("take the derivative inside: `max(der(e))`")
}

/// `der` by an input or parameter of a formula with such a number.
pub fn variation_of_result(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "a result has no derivative by an input or parameter")
        .at(span, "holds a number of the whole analysis")
        .help("take the derivative inside the reduction, or run it with another value: `--set`")
}

/// A requirement over results as well as over what changes with time.
pub fn requirement_of_both(moving: Span, reduced: Span) -> Diagnostic {
    Diagnostic::new(Code::E0423, "a requirement is over results or over quantities, not over both")
        .at(moving, "changes with time")
        .also(reduced, "one number for the whole analysis")
        .help("reduce what changes with time, `max(e)`, or leave reductions and results out")
}

/// An equality without a tolerance.
pub fn equal_without_tolerance(sign: Span, wanted: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::E0423, "an equality needs a tolerance")
        .at(sign, "computed numbers are hardly ever equal")
        .help(format!("say how near it must come: `== {text} within TOLERANCE`"))
        .also(wanted, "how near must it come?")
}

/// `within` behind another comparison than `==`.
pub fn tolerance_of_no_equality(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0423, "`within` belongs to an equality")
        .at(span, "a tolerance of a bound")
        .help("write `e == F within D`, or add the tolerance to the bound")
}

/// A tolerance below zero.
pub fn negative_tolerance(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0423, "a tolerance is not negative").at(span, "below zero")
}

/// Comparisons that set no bound: `<`, `!=`, or two that do not enclose a formula.
pub fn no_bound(sign: ComparisonSign, at: Span) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0423, "this comparison sets no bound");
    let closed = match sign {
        ComparisonSign::Less => "<=",
        ComparisonSign::Greater => ">=",
        _ => {
            return diagnostic
                .at(at, "not one of the forms of a requirement")
                .help("write `A <= e <= B`, `e <= B`, `e >= A`, or `e == F within D`");
        }
    };
    let words = format!("a bound may be reached: `{closed}`");
    diagnostic.at(at, "excludes the bound itself").fix(Fix::replace(at, closed, words, Applicability::Always))
}
