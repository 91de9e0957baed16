//! Diagnostics for a text that does not follow the grammar.

use super::grammar::{Rule, keyword_of};
use super::lexer::{LexemeKind, Lexer, is_word_char, tokens, tokens_in};
use super::suggest::{Fault, Suggestion};
use mechc_text::diag::{Applicability, Code, Diagnostic, Edit, Fix};
use mechc_text::source::{FileId, Source, Span};
use mechc_text::vocabulary::Role;
use pest::error::{Error, ErrorVariant};
use std::borrow::Cow;
use std::ops::Range;

/// Reports nesting beyond the limit.
pub fn too_deep(span: Span, deepest: usize) -> Diagnostic {
    Diagnostic::new(Code::E0103, format!("formulas are nested deeper than {deepest}"))
        .at(span, "one level too many")
        .help("give a part of the formula a name, with `param` or `fn`")
}

/// Reports a file without a mechanism.
pub fn no_mechanism(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0104, "the file holds no mechanism")
        .at(span, "the file ends here")
        .help("a file begins with `mechanism NAME {`")
}

/// Reports a `use` behind a mechanism.
pub fn late_use(span: Span) -> Diagnostic {
    misplaced(span, "a `use` stands before the mechanisms", "not expected here")
        .help("move it to the top of the file, above the first `mechanism`")
}

/// Reports an error that the grammar accepts and the tree builder rejects.
pub fn misplaced(span: Span, message: &str, label: &str) -> Diagnostic {
    Diagnostic::new(Code::E0101, message).at(span, label)
}

/// Reports a column number 0, or one that is too large.
pub fn column_number(span: Span) -> Diagnostic {
    misplaced(span, "columns are counted from 1", "there is no such column")
}

/// Reports a quantity as an exponent: `2 ^ 3 s`.
pub fn quantity_as_exponent(span: Span) -> Diagnostic {
    misplaced(span, "a number with a unit cannot be an exponent", "this has a unit")
}

/// Reports a power of a unit that is not a whole number: `50 mm^x`.
pub fn unit_power(span: Span, literal: Span, text: &str) -> Diagnostic {
    let [before, behind] = [(literal.start, "("), (literal.end, ")")]
        .map(|(at, text)| Edit { span: Span { start: at, end: at, ..literal }, text: text.to_owned() });
    misplaced(span, "the power of a unit is a whole number", "after a unit this is the unit's power").fix(Fix {
        message: format!("to raise the whole quantity, write `({text})^…`"),
        edits: vec![before, behind],
        applies: Applicability::Probably,
    })
}

/// Reports a chain of comparisons: `a < b < c`.
pub fn chained_comparison(span: Span, middle: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::E0309, "comparisons do not form chains").at(span, "a second comparison").fix(Fix::append(
        middle,
        format!(" and {text}"),
        "join two comparisons with `and`: `a < b and b < c`",
        Applicability::Probably,
    ))
}

/// Reports a declaration that ends too early.
fn incomplete(what: &str, end: Span, expected: &str) -> Diagnostic {
    misplaced(end, &format!("{what} is not complete: expected {expected}"), &format!("{expected} goes behind this"))
}

/// Adds a suggestion to a diagnostic.
fn with_suggestion(diagnostic: Diagnostic, suggestion: Suggestion) -> Diagnostic {
    match suggestion {
        Suggestion::Words(words) => diagnostic.help(words),
        Suggestion::Fix(fix) => diagnostic.fix(fix),
        Suggestion::Incomplete { what, end, expected, suggestion } => {
            with_suggestion(incomplete(&what, end, expected), *suggestion)
        }
    }
}

/// Reports a declaration of the mechanism within the braces of a body.
pub fn misplaced_in_body(mut fault: Diagnostic, word: &str) -> Diagnostic {
    fault.fixes.clear();
    fault.help = vec![format!("a `{word}` stands in the mechanism: put it behind the `}}` of this body or ground")];
    fault
}

/// Explains a feature outside of all bodies, unless the diagnostic has a suggestion already.
pub fn feature_in_mechanism(mut fault: Box<Diagnostic>, word: &str) -> Box<Diagnostic> {
    if fault.help.is_empty() && fault.fixes.is_empty() {
        let article = if word == "axis" { "an" } else { "a" };
        let of_ground = if word == "mass" { "" } else { " or of the ground" };
        fault.help =
            vec![format!("{article} `{word}` stands between the braces of a body{of_ground}: `body b {{ {word} … }}`")];
    }
    fault
}

/// Reports a keyword as a name, with an unused name as a suggestion.
pub fn keyword_as_name(mut fault: Diagnostic, word: &str, instead: Option<&str>) -> Diagnostic {
    fault.fixes.clear();
    let instead = instead.map_or(String::new(), |name| format!("; choose another one, `{name}` say"));
    fault.help = vec![format!("`{word}` is a keyword and cannot be a name{instead}")];
    fault
}

/// Reports `body ground { … }`; the span covers the text before `ground`.
pub fn ground_as_body(fault: Diagnostic, before: Span) -> Diagnostic {
    fault.instead(Fix::replace(
        before,
        "",
        "the ground is no body: it is declared `ground { … }`",
        Applicability::Always,
    ))
}

/// Reports a name that is too long for messages.
pub fn long_name(span: Span, longest: usize) -> Diagnostic {
    Diagnostic::new(Code::E0101, format!("a name has at most {longest} characters"))
        .at(span, "this one is longer")
        .help("choose a shorter name, and say the rest in a `///` comment")
}

/// Reports a syntax error of the parser in the piece of a text that begins at a byte.
///
/// With `with_fix_it` it searches all of the text before the error for suggestions.
pub fn from_pest(error: &Error<Rule>, source: &Source, file: FileId, base: usize, with_fix_it: bool) -> Diagnostic {
    let text = source.text.as_str();
    let offset = match error.location {
        pest::error::InputLocation::Pos(at) | pest::error::InputLocation::Span((at, _)) => base + at,
    };
    if with_fix_it && let Some(other) = comparison_for_equation(error, text, base..offset, file) {
        return other;
    }
    let found = found_at(text, offset);
    if let Some(bracket) = other_bracket(error, text, &found, file) {
        return bracket;
    }
    let rules = expected_rules(error);
    let end = if source.is_option { "the end of the formula" } else { "the end of the file" };
    let expected = expectation(rules, &text[found.clone()], end);
    let diagnostic = match comment_at(text, found.start) {
        Some(at) => {
            let span = Span { file, start: at as u32, end: at as u32 + 2 };
            misplaced(span, "`/*` begins no comment", "not expected here")
        }
        None => unexpected(text, file, found.clone(), &expected, end),
    };
    if !with_fix_it {
        return diagnostic;
    }
    let fault = Fault::new(text, file, found.start, &text[found], rules);
    let diagnostic = match fault.reason() {
        Some((at, text)) => diagnostic.also(Span { file, start: at as u32, end: at as u32 + 1 }, text),
        None => diagnostic,
    };
    // of an option's value the declaration is not there
    if source.is_option && fault.found == "," && source.name.starts_with("--") {
        let option = source.name.split(' ').next().unwrap_or_default();
        return diagnostic.help(format!("give `{option}` once for each"));
    }
    match fault.suggestion() {
        Some(suggestion) => with_suggestion(diagnostic, suggestion),
        None => diagnostic,
    }
}

/// Returns the rules that the parser expected.
fn expected_rules(error: &Error<Rule>) -> &[Rule] {
    match &error.variant {
        // no prefix is called `use`, if a file follows: that is the next one
        ErrorVariant::ParsingError { positives, negatives }
            if positives.is_empty() && negatives.contains(&Rule::kw_use) =>
        {
            &[Rule::use_prefix]
        }
        ErrorVariant::ParsingError { positives, .. } => positives.as_slice(),
        ErrorVariant::CustomError { .. } => &[],
    }
}

/// Reports an unexpected word or character.
fn unexpected(text: &str, file: FileId, found: Range<usize>, expected: &str, end: &str) -> Diagnostic {
    let (word, line) = (&text[found.clone()], text[found.end..].lines().next().unwrap_or_default());
    // a string is marked along its length
    let closing = line.find('"').filter(|_| word.starts_with('"'));
    let length = closing.map_or(word.len(), |inside| word.len() + inside + 1);
    let span = Span { file, start: found.start as u32, end: (found.start + length) as u32 };
    let shown = match word.chars().next() {
        None => end.to_owned(),
        Some('"') if closing.is_some() => "a string".to_owned(),
        Some('"') => "an unclosed string".to_owned(),
        Some(_) if word == "ground" && text[found.end..].trim_start().starts_with([',', ')']) => {
            "`ground` alone".to_owned()
        }
        Some(_) => format!("`{word}`"),
    };
    // a single expected item has a definite position
    let label = if expected.split('`').count() == 3 && expected.starts_with('`') && expected.ends_with('`') {
        format!("{expected} goes here")
    } else {
        "not expected here".to_owned()
    };
    Diagnostic::new(Code::E0101, format!("expected {expected}, found {shown}")).at(span, label)
}

/// Returns where `/*` begins, if the fault is in one of its characters.
fn comment_at(text: &str, at: usize) -> Option<usize> {
    let is_one = |at: &usize| text.get(*at..).is_some_and(|rest| rest.starts_with("/*"));
    [at, at.wrapping_sub(1)].into_iter().find(is_one)
}

/// Reports arguments or coordinates in braces or square brackets: `revolute{A, B}`, `point A = [0, 0]`.
fn other_bracket(error: &Error<Rule>, text: &str, found: &Range<usize>, file: FileId) -> Option<Diagnostic> {
    let is_bracket = |bracket: &&str| ["{", "["].contains(bracket);
    let (rest, is_pair) = match text.get(found.clone()).filter(is_bracket) {
        Some(_) => (&text[found.start..], true),
        None => (text[found.end..].trim_start(), false),
    };
    let bracket = rest.get(..1).filter(is_bracket)?;
    let is_place = || expects(error, Rule::expr) && takes_coordinates(&text[..found.start]);
    let is_expected = if is_pair {
        expects(error, Rule::paren) || is_place()
    } else {
        expects(error, Rule::call) || expects(error, Rule::expr)
    };
    if !is_expected {
        return None;
    }
    let at = text.len() - rest.len();
    let span = |at: usize| Span { file, start: at as u32, end: at as u32 + 1 };
    let words = if is_pair { "coordinates stand in round brackets" } else { "arguments stand in round brackets" };
    let fault = misplaced(span(at), &format!("expected `(`, found `{bracket}`"), "`(` goes here");
    Some(match partner(text, at) {
        Some(end) => {
            let edits = [(at, "("), (end, ")")].map(|(at, text)| Edit { span: span(at), text: text.to_owned() });
            fault.fix(Fix { message: words.to_owned(), edits: edits.into(), applies: Applicability::Always })
        }
        None => fault.help(words),
    })
}

/// Returns whether a text ends where the coordinates of a point or pose are expected.
fn takes_coordinates(before: &str) -> bool {
    let tokens = tokens(before);
    let words: Vec<&str> = tokens.iter().map(|token| token.text).collect();
    matches!(words.as_slice(), [.., "point", _, "="] | [.., "at"])
}

/// Returns the matching closing bracket on the same line, if all brackets in between are closed.
fn partner(text: &str, at: usize) -> Option<usize> {
    let (mut open, line) = (Vec::new(), text[at..].lines().next()?);
    for token in tokens_in(text, at..at + line.len()) {
        match token.text {
            "(" | "[" | "{" => open.push(token.text),
            ")" | "]" | "}" => {
                let is_pair = matches!((open.pop()?, token.text), ("(", ")") | ("[", "]") | ("{", "}"));
                if !is_pair {
                    return None;
                }
            }
            _ => {}
        }
        if open.is_empty() {
            return Some(token.start);
        }
    }
    None
}

/// Reports an equation with `==`, or an inequality: the grammar takes both for a comparison.
fn comparison_for_equation(error: &Error<Rule>, text: &str, before: Range<usize>, file: FileId) -> Option<Diagnostic> {
    if !expects(error, Rule::equals) {
        return None;
    }
    let before = tokens_in(text, before);
    let start = before.iter().rposition(|token| ["driver", "constraint"].contains(&token.text))?;
    // behind an `if` it may be its comparison
    let at = before[start..]
        .iter()
        .take_while(|token| token.text != "if")
        .find(|token| ["==", "<", ">", "<=", ">="].contains(&token.text))?;
    let span = Span { file, start: at.start as u32, end: at.end() as u32 };
    let fault = misplaced(span, &format!("expected `=`, found `{}`", at.text), "this compares");
    Some(match at.text {
        "==" => fault.fix(Fix::replace(span, "=", "an equation is written with one `=`", Applicability::Always)),
        _ => fault.help(format!(
            "a {} is an equation, which holds all the time; how near a limit is can be seen in a `measure`",
            before[start].text
        )),
    })
}

fn expects(error: &Error<Rule>, rule: Rule) -> bool {
    matches!(&error.variant, ErrorVariant::ParsingError { positives, .. } if positives.contains(&rule))
}

/// Returns the word or character at an offset: `5mm` is one word.
fn found_at(text: &str, offset: usize) -> Range<usize> {
    // the parser may stand before white space or a comment
    let Some(token) = Lexer::new(text, offset).find(|token| !token.is_comment()) else { return text.len()..text.len() };
    let rest = &text[token.start..];
    let length = match token.kind {
        LexemeKind::Word | LexemeKind::Number => rest.find(|c| !is_word_char(c)).unwrap_or(rest.len()).max(1),
        LexemeKind::String => 1,
        LexemeKind::Sign | LexemeKind::Comment => token.text.len(),
    };
    token.start..token.start + length
}

/// Describes the rules that the parser expected.
fn expectation(rules: &[Rule], found: &str, end: &str) -> String {
    let mut words: Vec<Cow<'_, str>> = Vec::new();
    let goes_on = rules.iter().any(|rule| matches!(rule, Rule::infix | Rule::unit_power));
    // a point may end behind its name, but if text follows there, the `=` is missing
    let only_equals = rules.contains(&Rule::equals) && !goes_on;
    for rule in rules.iter().filter(|rule| !only_equals || **rule == Rule::equals) {
        let word = human(*rule, goes_on, end);
        let is_found = word.trim_matches('`') == found;
        if !word.is_empty() && !is_found && !words.contains(&word) {
            words.push(word);
        }
    }
    if words.is_empty() {
        return "the next declaration".to_owned();
    }
    // no other formula stands behind a joint's `:`
    let is_joint = rules.contains(&Rule::call) && !rules.contains(&Rule::literal) && !rules.contains(&Rule::expr);
    if is_joint && words == ["a formula"] {
        return "a kind of joint with its arguments".to_owned();
    }
    // a formula may begin with both
    if words.iter().any(|word| word == "a formula") {
        words.retain(|word| !["`(`", "a name"].contains(&&**word));
    }
    let last = words.pop().unwrap_or_default();
    if words.is_empty() { last.into_owned() } else { format!("{} or {last}", words.join(", ")) }
}

/// Describes a rule; empty if the description of another rule covers it.
fn human(rule: Rule, after_operand: bool, end: &str) -> Cow<'_, str> {
    let words = match rule {
        Rule::file | Rule::mechanism | Rule::mechanism_head | Rule::kw_mechanism => "`mechanism`",
        Rule::EOI if after_operand => "",
        Rule::EOI => end,
        Rule::name | Rule::use_prefix | Rule::word | Rule::ground_word => "a name",
        Rule::expression_only
        | Rule::expr
        | Rule::side
        | Rule::conditional
        | Rule::literal
        | Rule::number
        | Rule::call
        | Rule::member
        | Rule::prefix
        | Rule::kw_if
        | Rule::kw_not => "a formula",
        Rule::infix | Rule::arithmetic => "an operator",
        Rule::comparison => "a comparison",
        Rule::paren | Rule::left => "`(`",
        Rule::equals => "`=`",
        Rule::colon => "`:`",
        Rule::comma => "`,`",
        Rule::right | Rule::call_end => "`)`",
        Rule::open => "`{`",
        Rule::close => "`}`",
        Rule::mechanism_name => "the name of a mechanism",
        Rule::binding => "a binding `NAME = …`",
        Rule::carrier => "a body",
        Rule::periodic | Rule::spline => "`spline`",
        Rule::table_rows => "`[`",
        Rule::table_file | Rule::string => "a file name in quotes",
        Rule::exponent => "a whole number",
        Rule::unit_name | Rule::unit_factor | Rule::unit_product | Rule::reciprocal => "a unit",
        Rule::column | Rule::column_number => "a number or name of a column",
        Rule::kw_use | Rule::kw_as | Rule::kw_in | Rule::kw_columns => "",
        _ => {
            return match keyword_of(rule).map(|keyword| (keyword.role, keyword.word.name)) {
                Some((Role::Declaration | Role::Opener, _)) => "a declaration".into(),
                Some((Role::Feature | Role::FeatureOpener, _)) => "a point, axis, circle, curve or mass".into(),
                Some((_, word)) => format!("`{word}`").into(),
                None => "".into(),
            };
        }
    };
    words.into()
}
