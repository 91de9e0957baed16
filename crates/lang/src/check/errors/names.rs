//! Diagnostics of unknown names, and of names of another kind.

use super::{list, nearest_name, wrong_kind};
use crate::check::suggest::edits::suggest_rename;
use mechc_syntax::ast::Name;
use mechc_text::diag::{Applicability, Code, Diagnostic, Edit, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::{
    Constant, FUNCTIONS, JOINTS, JointSpec, Position, QUANTITIES, QuantityWord, Synonym, Unit,
};

pub fn unknown(what: &str, name: &Name, candidates: &[&str]) -> Diagnostic {
    Diagnostic::new(Code::E0201, format!("there is no {what} `{}`", name.text))
        .at(name.span, "not declared")
        .fix_if(nearest_name(name, candidates))
}

/// A name that is not a number. One letter is more likely an undeclared name than a unit.
pub fn unknown_number(what: &str, name: &Name, candidates: &[&str]) -> Diagnostic {
    let diagnostic = unknown(what, name, candidates);
    // The middle dot is a letter of names.
    if let [a, b] = name.text.split('·').collect::<Vec<_>>().as_slice()
        && !a.is_empty()
        && !b.is_empty()
    {
        let written = format!("{a} * {b}");
        let message = format!("a product is written with `*`: `{written}`");
        return diagnostic.instead(Fix::replace(name.span, written, message, Applicability::Probably));
    }
    if let (Some(power), true) = (power_of_a_unit(&name.text), diagnostic.help.is_empty()) {
        return diagnostic.instead(Fix::suggest(name.span, &power));
    }
    if let Some(synonym) = Synonym::of(Position::Number, &name.text) {
        return match synonym.equivalent() {
            Some(word) => diagnostic.instead(Fix::suggest(name.span, word)),
            None => diagnostic.help(synonym.message(&[])),
        };
    }
    match Synonym::of(Position::Unit, &name.text).filter(|_| name.text.len() > 1 && diagnostic.help.is_empty()) {
        Some(synonym) => match synonym.equivalent() {
            // `turn` is more likely an undeclared input than a unit.
            Some("rev") => diagnostic
                .help(format!("the unit is `rev`; a number of that name is declared: `param {} = …`", name.text)),
            _ => diagnostic.help(synonym.message(&[])),
        },
        None => diagnostic,
    }
}

/// `--input turn=leg[0]`: a path in a formula from outside.
pub fn path_from_outside(span: Span, owner: &str, noun: &str, is_whole: bool) -> Diagnostic {
    let found = if is_whole { noun.to_owned() } else { format!("something in {noun}") };
    wrong_kind(span, "a number", &found).help(format!(
        "a formula from outside is of time and of params, functions and tables of the mechanism, not of `{owner}`"
    ))
}

/// A name in the value of an option.
pub fn names_in_option(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0706, format!("a value from outside the file cannot name `{}`", name.text))
        .at(name.span, "a name of the file")
        .fix_if(power_of_a_unit(&name.text).map(|power| Fix::suggest(name.span, &power)))
        .help("write it out in numbers and units")
}

/// A name in a formula of time that stands alone.
pub fn names_in_formula(name: &Name) -> Diagnostic {
    let nearest =
        nearest_name(name, &Constant::in_formulas().collect::<Vec<_>>()).filter(|_| name.text.chars().count() > 1);
    let diagnostic =
        Diagnostic::new(Code::E0706, format!("a formula from outside the file cannot name `{}`", name.text))
            .at(name.span, "not known here");
    let synonym = Synonym::of(Position::Unit, &name.text).filter(|_| name.text.len() > 1);
    if let Some(power) = power_of_a_unit(&name.text) {
        return diagnostic.fix(Fix::suggest(name.span, &power));
    }
    match (nearest, synonym) {
        (_, Some(synonym)) => diagnostic.help(synonym.message(&[])),
        (Some(fix), None) => diagnostic.fix(fix),
        (None, None) => diagnostic.help("it is a formula of the time `t`; `pi`, `tau` and the units may stand in it"),
    }
}

pub fn unknown_feature(what: &str, owner: &str, name: &Name, candidates: &[&str]) -> Diagnostic {
    let listed = match candidates {
        [] => format!("`{owner}` has none"),
        _ => format!("`{owner}` has {}", list(candidates)),
    };
    let diagnostic = Diagnostic::new(Code::E0201, format!("`{owner}` has no {what} `{}`", name.text))
        .at(name.span, "not declared there");
    match nearest_name(name, candidates) {
        Some(fix) => diagnostic.fix(fix),
        None => diagnostic.help(listed),
    }
}

/// Takes the texts of the arguments.
pub fn unknown_function(name: &Name, local_names: &[&str], arguments: &[&str]) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(Code::E0201, format!("there is no function `{}`", name.text)).at(name.span, "not known");
    if let Some(help) = suggest_other_form(&name.text, arguments) {
        return diagnostic.help(help).fix_if(nearest_name(name, local_names));
    }
    let mut candidates: Vec<&str> = local_names.to_vec();
    candidates.extend(FUNCTIONS.iter().map(|function| function.word.name));
    candidates.extend(QUANTITIES.iter().map(|quantity| quantity.word.name));
    diagnostic.fix_if(nearest_name(name, &candidates))
}

/// Suggests how to write an entity that is called like a function.
fn suggest_other_form(name: &str, arguments: &[&str]) -> Option<String> {
    if let Some(synonym) = Synonym::of(Position::Call, name) {
        return Some(synonym.message(arguments));
    }
    if let Some(joint) = JointSpec::named(name) {
        let form = joint.word.forms.first().copied().unwrap_or(name);
        return Some(format!("`{name}` is a kind of joint: `joint NAME: {form}`"));
    }
    Unit::named(name).map(|_| match arguments {
        [number] if number.parse::<f64>().is_ok() => format!("a unit follows its number: `{number} {name}`"),
        _ => format!("a unit is a factor: `… * 1 {name}`"),
    })
}

pub fn unknown_joint(kind: &Name, arguments: &[&str]) -> Diagnostic {
    let candidates: Vec<&str> = JOINTS.iter().map(|joint| joint.word.name).collect();
    let diagnostic = Diagnostic::new(Code::E0201, format!("there is no kind of joint `{}`", kind.text))
        .at(kind.span, "not declared");
    match (Synonym::of(Position::Joint, &kind.text), nearest_name(kind, &candidates)) {
        (Some(synonym), _) => diagnostic.help(synonym.message(arguments)),
        (None, Some(fix)) => diagnostic.fix(fix),
        (None, None) => diagnostic.help(format!("the joints are {}", list(&candidates))),
    }
}

/// A word after a number that is not a unit, with the number and the power after the word.
pub fn not_a_unit(name: &Name, [number, power]: [&str; 2], is_a_name: bool) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text))
        .at(name.span, "only a unit may follow a number");
    if is_a_name {
        let words = format!("was `{number} * {}{power}` meant?", name.text);
        let diagnostic = diagnostic.fix(Fix::insert(name.span, "* ", words, Applicability::Probably));
        // A unit in other formulas, and a name here.
        return match Synonym::of(Position::Unit, &name.text) {
            Some(synonym) if name.text == "g" => diagnostic.help(synonym.message(&[])),
            _ => diagnostic,
        };
    }
    suggest_unit(diagnostic, name)
}

/// A factor of a product that begins with a number and its unit, where `declared` is what its name stands for in the mechanism.
pub fn name_or_unit(
    name: &Name,
    (number, written): (Span, &str),
    product: &str,
    declared: &str,
    is_number: bool,
) -> Diagnostic {
    let unit = format!("(1 {})", name.text);
    let message = format!("the unit is meant: `{unit}`");
    let unit = Fix::replace(name.span, unit, message, Applicability::Probably);
    let around = |at: u32, text: &str| Edit { span: Span { start: at, end: at, ..number }, text: text.to_owned() };
    let declaration = Fix {
        message: format!("the name is meant: `({written})`"),
        edits: vec![around(number.start, "("), around(number.end, ")")],
        applies: Applicability::Probably,
    };
    Diagnostic::new(Code::E0210, format!("`{}` in `{product}` is both a unit and the name of {declared}", name.text))
        .at(name.span, "which of the two is meant?")
        .fix(unit)
        .fix_if(is_number.then_some(declaration))
}

/// Returns the power that is intended by `mm2`, such as `mm^2`.
pub(super) fn power_of_a_unit(name: &str) -> Option<String> {
    let unit = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let power = &name[unit.len()..];
    (!power.is_empty() && Unit::named(unit).is_some()).then(|| format!("{unit}^{power}"))
}

/// Adds the probable unit to a diagnostic, or lists all units.
pub(super) fn suggest_unit(diagnostic: Diagnostic, name: &Name) -> Diagnostic {
    if let Some(power) = power_of_a_unit(&name.text) {
        return diagnostic.fix(Fix::suggest(name.span, &power));
    }
    let units: Vec<&str> = Unit::names().collect();
    match (Synonym::of(Position::Unit, &name.text), Unit::prefixed_value(&name.text), nearest_name(name, &units)) {
        (Some(synonym), ..) => diagnostic.help(synonym.message(&[])),
        (None, Some(text), _) => diagnostic.help(format!("`1 {}` is written `{text}`", name.text)),
        (None, None, Some(fix)) => diagnostic.fix(fix),
        (None, None, None) => diagnostic.help(format!("the units are {}", units.join(" "))),
    }
}

pub fn declared_twice(name: &Name, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0203, format!("`{}` is declared twice", name.text))
        .at(name.span, "declared again")
        .also(first, "first declared here")
        .help("give one of the two another name")
}

/// Takes a free name instead, and the uses of the name.
pub fn reserved(name: &Name, instead: Option<&str>, uses: &[Span]) -> Diagnostic {
    let what = match Constant::named(&name.text) {
        Some(constant) => constant.stands_for.noun(),
        None if Unit::named(&name.text).is_some() => "a unit",
        None if QuantityWord::named(&name.text).is_some() => "a kinematic quantity",
        None => "a function of the language",
    };
    Diagnostic::new(Code::E0204, format!("`{}` cannot be declared: it is {what}", name.text))
        .at(name.span, "reserved")
        .fix_if(instead.map(|free| suggest_rename(name, uses, free, format!("choose another name, `{free}` say"))))
}

pub fn second(word: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0205, format!("a mechanism has one `{word}`"))
        .at(span, "the second one")
        .also(first, "the first one")
        .help(if word == "ground" { "put both into one declaration" } else { "leave one of the two out" })
}

pub fn second_mechanism(name: &Name, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0205, format!("there are two mechanisms `{}`", name.text))
        .at(name.span, "the second one")
        .also(first, "the first one")
        .help("give one of them another name")
}

pub fn circle(names: &[&Name]) -> Diagnostic {
    let first = names[0];
    let mut chain: Vec<String> = names.iter().map(|name| format!("`{}`", name.text)).collect();
    chain.push(format!("`{}`", first.text));
    let message = match names {
        [only] => format!("`{}` is defined by itself", only.text),
        _ => format!("definitions go in a circle: {} needs {}", chain[0], chain[1..].join(", which needs ")),
    };
    // `measure power = power(motor)`
    let synonym = Synonym::of(Position::Call, &first.text).filter(|_| names.len() == 1);
    names[1..]
        .iter()
        .fold(Diagnostic::new(Code::E0206, message).at(first.span, "needs its own value"), |diagnostic, name| {
            diagnostic.also(name.span, "on the circle")
        })
        .help_if(synonym.map(|synonym| synonym.message(&[])))
}

pub fn hidden_name(argument: &Name, declared: Span, free: Option<&str>, uses: &[Span]) -> Diagnostic {
    Diagnostic::new(Code::E0207, format!("the argument `{}` hides a name of the mechanism", argument.text))
        .at(argument.span, "this argument")
        .also(declared, "declared here")
        .fix_if(free.map(|free| suggest_rename(argument, uses, free, format!("rename the argument: `{free}`, say"))))
}
