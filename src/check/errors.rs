//! What is said of a mechanism that does not pass.

mod forces;
pub mod library;
mod parts;
mod results;
mod variables;

pub use forces::*;
pub use parts::*;
pub use results::{REDUCES, derivative_of_result, outside_reduction, reduction_in, result_in, variation_of_result};
pub use variables::*;

use super::entity::Entity;
use super::mends::{is_bare_number, renamed, with_factors, with_unit};
use super::rates::{Part, polar, rate_mended};
use crate::diag::{Applies, Code, Diagnostic, Edit, Fix, nearest, readable};
use crate::model::Dimension;
use crate::source::Span;
use crate::syntax::ast::{ColumnName, ColumnWord, Name, PathSegment};
use crate::syntax::format::expression;
use crate::vocabulary::{
    Constant, FUNCTIONS, JOINTS, JointKind, JointWord, Place, QUANTITIES, QuantityWord, Synonym, Unit, Word,
};

fn meant(wanted: &Name, names: &[&str]) -> Option<Fix> {
    nearest(&wanted.text, names.iter().copied()).map(|name| Fix::meant(wanted.span, name))
}

// ---- names

pub fn unknown(what: &str, name: &Name, known: &[&str]) -> Diagnostic {
    Diagnostic::new(Code::E0201, format!("there is no {what} `{}`", name.text))
        .at(name.span, "not declared")
        .fix_if(meant(name, known))
}

/// A name in a formula that stands for no number; one letter is rather a name that was forgotten than a unit.
pub fn unknown_number(what: &str, name: &Name, known: &[&str]) -> Diagnostic {
    let diagnostic = unknown(what, name, known);
    // the middle dot is a letter of names
    if let [a, b] = name.text.split('·').collect::<Vec<_>>().as_slice()
        && !a.is_empty()
        && !b.is_empty()
    {
        let written = format!("{a} * {b}");
        let message = format!("a product is written with `*`: `{written}`");
        return diagnostic.instead(Fix::replace(name.span, written, message, Applies::Probably));
    }
    if let Some([only]) = Synonym::of(Place::Number, &name.text).map(|synonym| synonym.means) {
        return diagnostic.instead(Fix::meant(name.span, only));
    }
    match Synonym::of(Place::Unit, &name.text).filter(|_| name.text.len() > 1 && diagnostic.help.is_empty()) {
        Some(synonym) => match synonym.means {
            // `turn` is rather an input that was forgotten than a unit
            [unit @ "rev"] => diagnostic
                .help(format!("the unit is `{unit}`; a number of that name is declared: `param {} = …`", name.text)),
            _ => diagnostic.help(synonym.say(&[])),
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
    Diagnostic::new(Code::E0706, format!("a value of the command line cannot name `{}`", name.text))
        .at(name.span, "a name of the file")
        .help("write it out in numbers and units")
}

/// A name in a formula of time that stands alone.
pub fn names_in_formula(name: &Name) -> Diagnostic {
    let nearest = meant(name, &Constant::in_formulas().collect::<Vec<_>>()).filter(|_| name.text.chars().count() > 1);
    let diagnostic = Diagnostic::new(Code::E0706, format!("a formula of the command line cannot name `{}`", name.text))
        .at(name.span, "not known here");
    let synonym = Synonym::of(Place::Unit, &name.text).filter(|_| name.text.len() > 1);
    match (nearest, synonym) {
        (_, Some(synonym)) => diagnostic.help(synonym.say(&[])),
        (Some(fix), None) => diagnostic.fix(fix),
        (None, None) => diagnostic.help("it is a formula of the time `t`; `pi`, `tau` and the units may stand in it"),
    }
}

pub fn unknown_feature(what: &str, owner: &str, name: &Name, known: &[&str]) -> Diagnostic {
    let listed = match known {
        [] => format!("`{owner}` has none"),
        _ => format!("`{owner}` has {}", list(known)),
    };
    let diagnostic = Diagnostic::new(Code::E0201, format!("`{owner}` has no {what} `{}`", name.text))
        .at(name.span, "not declared there");
    match meant(name, known) {
        Some(fix) => diagnostic.fix(fix),
        None => diagnostic.help(listed),
    }
}

/// With the arguments as they were written.
pub fn unknown_function(name: &Name, own: &[&str], arguments: &[&str]) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(Code::E0201, format!("there is no function `{}`", name.text)).at(name.span, "not known");
    if let Some(said) = said_otherwise(&name.text, arguments) {
        return diagnostic.help(said).fix_if(meant(name, own));
    }
    let mut known: Vec<&str> = own.to_vec();
    known.extend(FUNCTIONS.iter().map(|function| function.word.name));
    known.extend(QUANTITIES.iter().map(|quantity| quantity.word.name));
    diagnostic.fix_if(meant(name, &known))
}

/// How to say what is called as a function, if it is something else here.
fn said_otherwise(name: &str, arguments: &[&str]) -> Option<String> {
    if let Some(synonym) = Synonym::of(Place::Call, name) {
        return Some(synonym.say(arguments));
    }
    if let Some(joint) = JointWord::named(name) {
        let form = joint.word.forms.first().copied().unwrap_or(name);
        return Some(format!("`{name}` is a kind of joint: `joint NAME: {form}`"));
    }
    Unit::named(name).map(|_| match arguments {
        [number] if number.parse::<f64>().is_ok() => format!("a unit follows its number: `{number} {name}`"),
        _ => format!("a unit is a factor: `… * 1 {name}`"),
    })
}

pub fn unknown_joint(kind: &Name, arguments: &[&str]) -> Diagnostic {
    let known: Vec<&str> = JOINTS.iter().map(|joint| joint.word.name).collect();
    let diagnostic = Diagnostic::new(Code::E0201, format!("there is no kind of joint `{}`", kind.text))
        .at(kind.span, "not declared");
    match (Synonym::of(Place::Joint, &kind.text), meant(kind, &known)) {
        (Some(synonym), _) => diagnostic.help(synonym.say(arguments)),
        (None, Some(fix)) => diagnostic.fix(fix),
        (None, None) => diagnostic.help(format!("the joints are {}", list(&known))),
    }
}

/// A word after a number that is no unit.
pub fn not_a_unit(name: &Name, number: &str, is_a_name: bool) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text))
        .at(name.span, "only a unit may follow a number");
    if is_a_name {
        let words = format!("was `{number} * {}` meant?", name.text);
        let diagnostic = diagnostic.fix(Fix::insert(name.span, "* ", words, Applies::Probably));
        // what is a unit elsewhere, and a name here
        return match Synonym::of(Place::Unit, &name.text) {
            Some(synonym) if name.text == "g" => diagnostic.help(synonym.say(&[])),
            _ => diagnostic,
        };
    }
    meant_unit(diagnostic, name)
}

/// Which unit was meant, or all of them.
fn meant_unit(diagnostic: Diagnostic, name: &Name) -> Diagnostic {
    let units: Vec<&str> = Unit::names().collect();
    match (Synonym::of(Place::Unit, &name.text), Unit::of_multiple(&name.text), meant(name, &units)) {
        (Some(synonym), ..) => diagnostic.help(synonym.say(&[])),
        (None, Some(told), _) => diagnostic.help(format!("`1 {}` is written `{told}`", name.text)),
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

/// With a name that is free instead, and where the name stands besides.
pub fn reserved(name: &Name, instead: Option<&str>, uses: &[Span]) -> Diagnostic {
    let what = match Constant::named(&name.text) {
        Some(constant) => constant.stands_for.noun(),
        None if Unit::named(&name.text).is_some() => "a unit",
        None if QuantityWord::named(&name.text).is_some() => "a kinematic quantity",
        None => "a function of the language",
    };
    Diagnostic::new(Code::E0204, format!("`{}` cannot be declared: it is {what}", name.text))
        .at(name.span, "reserved")
        .fix_if(instead.map(|free| renamed(name, uses, free, format!("choose another name, `{free}` say"))))
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
    let synonym = Synonym::of(Place::Call, &first.text).filter(|_| names.len() == 1);
    names[1..]
        .iter()
        .fold(Diagnostic::new(Code::E0206, message).at(first.span, "needs its own value"), |diagnostic, name| {
            diagnostic.also(name.span, "on the circle")
        })
        .help_if(synonym.map(|synonym| synonym.say(&[])))
}

pub fn hidden_name(argument: &Name, declared: Span, free: Option<&str>, uses: &[Span]) -> Diagnostic {
    Diagnostic::new(Code::E0207, format!("the argument `{}` hides a name of the mechanism", argument.text))
        .at(argument.span, "this argument")
        .also(declared, "declared here")
        .fix_if(free.map(|free| renamed(argument, uses, free, format!("rename the argument: `{free}`, say"))))
}

// ---- kinds and arguments

/// The word is there if it is one of the language.
pub fn argument_count(what: &str, word: Option<&Word>, span: Span, wanted: &str, found: usize) -> Diagnostic {
    Diagnostic::new(Code::E0301, format!("`{what}` takes {wanted}, found {found}"))
        .at(span, format!("found {found}"))
        .help_if(word.map(|word| format!("it is written {}", word.written())))
}

pub fn wrong_kind(span: Span, wanted: &str, found: &str) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("expected {wanted}, found {found}")).at(span, format!("this is {found}"))
}

// ---- points

/// With the points of its body and of the mechanism.
pub fn unknown_point(name: &Name, known: &[&str]) -> Diagnostic {
    let diagnostic = unknown("point", name, known);
    if !diagnostic.help.is_empty() {
        return diagnostic;
    }
    let written = format!("a point of the mechanism is a param: `param {} = (x, y)`", name.text);
    match known {
        [] => diagnostic.help(written),
        _ => diagnostic.help(format!("the points here are {}", list(known))).help(written),
    }
}

/// `point A` alone, of which the mechanism has no point.
pub fn no_point_to_take(name: &Name, other: Option<&str>, known: &[&str]) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0201, format!("the mechanism has no point `{}`", name.text));
    let diagnostic = match other {
        Some(noun) => diagnostic.at(name.span, format!("`{}` is {noun}", name.text)),
        None => diagnostic.at(name.span, "not declared").fix_if(meant(name, known)),
    };
    diagnostic.help(format!("say where it lies: `point {} = (x, y)`", name.text))
}

/// `at A`, without an angle.
pub fn no_angle_of_pose(span: Span, text: &str) -> Diagnostic {
    let fix = Fix::replace(
        span,
        format!("({text}, 0 deg)"),
        format!("a pose has an angle too: `at ({text}, 0 deg)`"),
        Applies::Probably,
    );
    Diagnostic::new(Code::E0301, "a pose is a point and an angle, and this is a point alone")
        .at(span, "no angle")
        .fix(fix)
        .help(format!("or let the body go from there to another point: `at {text} toward Q`"))
}

/// The name of a point where a number is wanted.
pub fn point_as_number(name: &Name) -> Diagnostic {
    let diagnostic = wrong_kind(name.span, "a number", "a point");
    diagnostic.help(format!("its coordinates are `{0}.x` and `{0}.y`", name.text))
}

/// `A.x` where a point is wanted.
pub fn own_point_with_owner(span: Span, owner: &str, feature: &str) -> Diagnostic {
    let fix = Fix::replace(span, feature, format!("within `{owner}` it is `{feature}`"), Applies::Always);
    Diagnostic::new(Code::E0302, format!("a feature of `{owner}` is named alone in the braces of `{owner}`"))
        .at(span, "with its owner")
        .fix(fix)
}

pub fn coordinate_as_point(span: Span, owner: &Name) -> Diagnostic {
    let diagnostic = wrong_kind(span, "a point", "a number");
    diagnostic.help(format!("the point is `{}`", owner.text))
}

/// `A.z`
pub fn no_coordinate(owner: &Name, feature: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0201, format!("a point has no `{}`", feature.text))
        .at(feature.span, "not a coordinate")
        .help(format!("the coordinates of `{0}` are `{0}.x` and `{0}.y`", owner.text))
}

/// `crank.pin` in a formula of points that stands elsewhere than behind `at`.
pub fn moving_point(span: Span, owner: &str, feature: &str) -> Diagnostic {
    let help = "a point of the drawing is a param: `param A = (x, y)`";
    let diagnostic = wrong_kind(span, "a point of the drawing", &format!("a point of `{owner}`"));
    match owner {
        "ground" => diagnostic.help(format!("{help}, which `point {feature} = A` takes to the ground")),
        _ => diagnostic.help(help),
    }
}

/// `length` of points of bodies, with the texts of its arguments.
pub fn length_of_moving(name: &Name, member: Span, arguments: [&str; 2]) -> Diagnostic {
    let [p, q] = arguments;
    let message = format!("how far points of bodies are from each other is `distance({p}, {q})`");
    wrong_kind(member, "a point of the drawing", "a point of a body").fix(Fix::replace(
        name.span,
        "distance",
        message,
        Applies::Probably,
    ))
}

/// A product of two points, or a quotient by one.
pub fn product_of_points(span: Span, is_divisor: bool) -> Diagnostic {
    let (message, label) = if is_divisor {
        ("a point cannot be divided by", "the divisor is a point")
    } else {
        ("a point cannot be multiplied by a point", "another point")
    };
    Diagnostic::new(Code::E0302, message)
        .at(span, label)
        .help("points are added and subtracted, and multiplied and divided by numbers")
}

/// Names of points in one formula that stand in different frames.
pub fn two_frames(body: &str, own: Span, other: Span) -> Diagnostic {
    Diagnostic::new(Code::E0318, format!("this formula takes a point of `{body}` and one of the mechanism"))
        .at(other, "a point of the mechanism, as it is drawn")
        .also(own, format!("a point of `{body}`, in its own frame"))
        .help(format!(
            "`{body}` is placed with `at`, so its frame is another one: give a length or angle of the mechanism's points a name with \
             `param`, or draw the body in place, without `at`"
        ))
}

/// Two points of which a direction is asked.
pub fn points_coincide(what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0405, format!("{what} needs two points that differ, and these coincide"))
        .at(span, "no direction")
        .help("a direction is that of the way from the first point to the second")
}

/// `--set A=5mm` of a point.
pub fn point_set_to_number(name: &Name, span: Span) -> Diagnostic {
    let name = &name.text;
    wrong_kind(span, "a point", "a number")
        .help(format!("`{name}` is a point: `--set {name}=(12mm,0)`, or one of its coordinates: `--set {name}.x=12mm`"))
}

/// `--set r.x=5mm` of a number.
pub fn coordinate_of_number(name: &Name, k: usize, span: Span) -> Diagnostic {
    let (name, coordinate) = (&name.text, ["x", "y"][k.min(1)]);
    Diagnostic::new(Code::E0703, format!("the parameter `{name}` is a number, and has no `{coordinate}`"))
        .at(span, format!("`{name}` is no point"))
        .help(format!("set the number itself: `--set {name}=…`"))
}

pub fn not_callable(name: &Name, entity: Entity) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("`{}` is {}, and cannot be called", name.text, entity.noun()))
        .at(name.span, "called here")
        .fix(Fix::append(name.span, " * ", "a product is written with `*`", Applies::Probably))
}

pub fn joint_with_itself(joint: &Name, frame: &str, spans: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0303, format!("joint `{}` joins `{frame}` with itself", joint.text))
        .at(spans[1], format!("this is on `{frame}` too"))
        .also(spans[0], format!("on `{frame}`"))
        .help("a joint needs features of two different bodies, or of a body and the ground")
}

pub fn joint_without(
    quantity: &str,
    wanted: &str,
    joint: &str,
    kind: JointKind,
    span: Span,
    declared: Span,
) -> Diagnostic {
    let motions = ["rotation", "displacement"];
    let other = motions.into_iter().filter(|_| motions.contains(&quantity)).find(|other| kind.has_quantity(other));
    Diagnostic::new(Code::E0304, format!("only {wanted} joints have a `{quantity}`"))
        .at(span, format!("`{joint}` is `{}`", kind.word()))
        .also(declared, "declared here")
        .help_if(other.map(|other| format!("was `{other}({joint})` meant?")))
}

pub fn axes_elsewhere(joint: &str, axis: &str, span: Span, wanted: &str) -> Diagnostic {
    Diagnostic::new(Code::E0305, format!("axis `{axis}` is not on `{wanted}`, which joint `{joint}` asks for here"))
        .at(span, format!("an axis of `{wanted}` is wanted"))
        .help(format!("the first axis is of the first body of `{joint}`, the second of its second"))
}

pub fn time_in(place: &str, span: Span, through: Option<(&str, Span)>) -> Diagnostic {
    let diagnostic = match through {
        None => Diagnostic::new(Code::E0306, format!("time `t` may not stand in {place}")).at(span, "depends on time"),
        Some((function, at)) => {
            Diagnostic::new(Code::E0306, format!("`{function}` depends on time, which may not stand in {place}"))
                .at(span, "brings time in")
                .also(at, "time comes in here")
        }
    };
    match place {
        "a constraint" => diagnostic.help("an equation that holds time is a `driver`"),
        "the second argument of `at`" => diagnostic.help("it is a constant, as `0.5 s`"),
        _ => diagnostic.help("what moves with time is prescribed by a `driver`, of a joint, a body or a point"),
    }
}

/// Time may stand where an input may not only in the formula of an input.
pub fn input_in(place: &str, name: &Name, in_an_input: bool) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0306, format!("the input `{}` may not stand in {place}", name.text))
        .at(name.span, "changes with time");
    match (in_an_input, place) {
        (true, _) => diagnostic.help("an input is a signal of its own; what several hold in common is an `fn` of `t`"),
        (false, "a constraint") => diagnostic.help("an equation that holds an input is a `driver`"),
        (false, _) => diagnostic.help("an input may stand in drivers, loads and measures; a constant is a `param`"),
    }
}

/// A param or input that is told from outside.
pub fn no_such_name(noun: &str, mechanism: &str, name: &str, known: &[&str], meant: Option<&str>) -> Diagnostic {
    let listed = match known {
        [] => format!("it has no {noun}s"),
        _ => format!("its {noun}s are {}", some_of(known)),
    };
    Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no {noun} `{name}`"))
        .help(meant.map_or(listed, |name| format!("was `{name}` meant?")))
}

/// A column of samples whose header is no input, and was meant to be one with a unit.
pub fn column_of_no_input(mechanism: &str, header: &str, span: Span, meant: &str) -> Diagnostic {
    Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no input `{header}`"))
        .at(span, "the header of a column")
        .help(meant)
}

pub fn input_told_twice(name: &str, places: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0706, format!("the input `{name}` is told twice"))
        .at(places[0], "told here")
        .also(places[1], "and here")
        .help("an input is what one of `--input` and `--samples` says")
}

pub fn quantity_in(place: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0307, format!("the kinematic quantity `{name}` may not stand in {place}"))
        .at(span, "depends on the motion")
        .help("kinematic quantities stand in constraints, drivers, loads and measures")
}

/// A quantity that measures and traces alone may hold.
pub fn quantity_of_measures(place: &str, name: &str, span: Span) -> Diagnostic {
    let what = if name == "angle" { "angle(P, Q, R)" } else { name };
    Diagnostic::new(Code::E0307, format!("the kinematic quantity `{what}` may not stand in {place}"))
        .at(span, "for measures and traces alone")
        .help(match place {
            "a load" => "loads are made of `x`, `y`, `angle`, `distance`, `rotation`, `displacement` and their `der`",
            _ => "drivers and constraints are made of `x`, `y`, `angle`, `distance`, `rotation` and `displacement`",
        })
}

pub fn no_quantity(driver: bool, name: &Name, span: Span) -> Diagnostic {
    let what = if driver { "driver" } else { "constraint" };
    Diagnostic::new(Code::E0308, format!("{what} `{}` holds no kinematic quantity", name.text))
        .at(span, "an equation about no body")
        .help("say what it is about: `rotation(joint) = …`, `x(body.point) = …`")
}

pub fn nobody_moves(driver: bool, name: &Name, span: Span) -> Diagnostic {
    let what = if driver { "driver" } else { "constraint" };
    Diagnostic::new(Code::E0311, format!("no body takes part in {what} `{}`", name.text))
        .at(span, "nothing in it moves, or all that moves cancels")
        .help("an equation needs a point, axis or angle of a body")
}

pub fn condition_as_number(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0309, "a condition cannot stand where a number is wanted")
        .at(span, "true or false")
        .help("choose a number by it: `if … then 1 else 0`")
}

pub fn number_as_condition(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0309, "a number cannot stand where a condition is wanted")
        .at(span, "expected a comparison")
        .help("compare it: `… > 0`")
}

pub fn derivative_in(place: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("`der` may not stand in {place}"))
        .at(span, "a time derivative along the motion")
        .help("`der` stands in measures only; a driver prescribes a speed by its formula: `rotation(joint) = 2 rad/s * t`")
}

pub fn derivative_by_in(place: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("`der(e, NAME)` may not stand in {place}"))
        .at(span, "a derivative by an input or parameter")
        .help("it stands in measures, traces and results")
}

pub fn derivative_too_high(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "`der` is nested deeper than three")
        .at(span, "a fourth time derivative")
        .help("the third derivative (jerk) is the last that is computed")
}

// ---- dimensions and values

/// Places of one kind that are shown beside the first one, at most.
const MOST_PLACES: usize = 4;

/// The text of a part is told where it is a bare number.
pub fn unlike(what: &str, first: Part, second: Part, texts: [&str; 2], has_time: bool) -> Diagnostic {
    let [one, other] = [(first, texts[0]), (second, texts[1])];
    let fix = [(one, other), (other, one)].into_iter().find_map(|((one, text), (other, other_text))| {
        if !one.dimension.is(Dimension::PURE) {
            return None;
        }
        if is_bare_number(text) {
            return with_unit(one.span, text, &usual_unit(other.dimension));
        }
        let words = "a rate times a time is a pure number, as an angle is: `… * t`";
        other.dimension.is(Dimension::RATE).then(|| with_factors(other.span, other_text, ["", " * t"], words))
    });
    let mended =
        rate_mended(first.dimension, second, texts[1]).or_else(|| rate_mended(second.dimension, first, texts[0]));
    let fix = mended.filter(|_| has_time).or(fix);
    let polar = polar(first, second, texts).filter(|_| what.starts_with("the coordinates"));
    // where time may not stand it is no more than an explanation
    let is_factor = fix.as_ref().is_some_and(|fix| fix.message.ends_with("t`"));
    let (fix, help) = if is_factor && !has_time { (None, fix.map(|fix| fix.message)) } else { (fix, None) };
    Diagnostic::new(Code::E0401, format!("{what} {} and {}", first.dimension.in_words(), second.dimension.in_words()))
        .at(second.span, second.dimension.in_words())
        .also(first.span, first.dimension.in_words())
        .fix_if(fix)
        .help_if(help)
        .help_if(polar)
}

/// What a quantity is usually written in.
fn usual_unit(dimension: Dimension) -> String {
    if dimension.is(Dimension::LENGTH) { "mm".to_owned() } else { dimension.unit().replace("1/s", "rad/s") }
}

/// A value (SI) as a reader wants it, without the rounding of its last digits.
pub fn told(value: f64, dimension: Dimension) -> String {
    let (value, unit) = if dimension.is(Dimension::LENGTH) && value.abs() < 1.0 {
        (value * 1e3, "mm".to_owned())
    } else if dimension.is(Dimension::PURE) {
        (value, String::new())
    } else {
        (value, dimension.unit())
    };
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    format!("{} {unit}", readable(rounded)).trim_end().to_owned()
}

/// The text is that of the part.
pub fn wrong_dimension(place: &str, wanted: Dimension, found: Part, text: &str) -> Diagnostic {
    let units = |d: Dimension| {
        if d.is(Dimension::LENGTH) {
            Some("`mm`, `m`")
        } else if d.is(Dimension::TIME) {
            Some("`s`, `ms`")
        } else {
            None
        }
    };
    let is_angle =
        place.contains("angle") || place.contains("`sin`") || place.contains("`cos`") || place.contains("`tan`");
    let factors = |factors: [&str; 2], words: &str| Some(with_factors(found.span, text, factors, words));
    let mut fix = None;
    let help = if wanted.is(Dimension::PURE) && is_angle && found.dimension.is(Dimension::TIME) {
        let words = "an angular speed makes an angle of a time: `1 rad/s * t`";
        fix = factors(["1 rad/s * ", ""], words);
        Some(words.to_owned())
    } else if wanted.is(Dimension::PURE) && is_angle {
        Some("units of angle: `deg`, `rad`".to_owned())
    } else if wanted.is(Dimension::PURE) {
        let words = format!("divide it by {} to get a pure number", one(found.dimension));
        let unit = one(found.dimension).trim_matches('`').to_owned();
        let unit = if unit.contains('/') { format!("({unit})") } else { unit };
        // an exponent binds more tightly than what divides it
        let [open, close] = if place.contains("exponent") { ["(", ")"] } else { ["", ""] };
        fix = factors([open, &format!(" / {unit}{close}")], &words);
        Some(words)
    } else if place.contains("phase") {
        Some("it is measured along the pitch circles: an angle times a radius, as `30 deg * 20 mm`".to_owned())
    } else {
        if found.dimension.is(Dimension::PURE) && units(wanted).is_some() {
            fix = with_unit(found.span, text, &usual_unit(wanted));
        }
        units(wanted).map(|units| format!("units of {}: {units}", wanted.in_words().trim_start_matches("a ")))
    };
    Diagnostic::new(Code::E0402, format!("{place} must be {}, found {}", wanted.in_words(), found.dimension.in_words()))
        .at(found.span, found.dimension.in_words())
        .help_if(help)
        .change(fix)
}

/// `1 s`, `1 m`, `1 m/s`.
fn one(dimension: Dimension) -> String {
    let unit = dimension.unit();
    if unit.starts_with('1') { format!("`{unit}`") } else { format!("`1 {unit}`") }
}

pub fn exponent(span: Span, base: Part) -> Diagnostic {
    Diagnostic::new(Code::E0403, format!("{} takes a constant exponent only", base.dimension.in_words()))
        .at(span, "not constant")
        .also(base.span, base.dimension.in_words())
        .help("divide the base by a unit first: `(… / 1 mm)^…`")
}

pub fn not_finite(span: Span, value: f64) -> Diagnostic {
    let what = if value.is_nan() { "not a number" } else { "infinite" };
    Diagnostic::new(Code::E0404, format!("this constant is {what}"))
        .at(span, what)
        .help("look for a division by zero, a root or logarithm of what is not positive, or a number beyond 1.8e308")
}

pub fn zero_direction(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0405, "an axis needs a direction, and this one has length zero")
        .at(span, "no direction")
        .help("take two points that differ, or a direction: `along (1, 0)` is that of x, `along (0, 1)` that of y")
}

pub fn not_positive_length(what: &str, span: Span, value: f64) -> Diagnostic {
    let value = told(value, Dimension::LENGTH);
    Diagnostic::new(Code::E0406, format!("{what} must be positive, it is {value}"))
        .at(span, value)
        .help("a direction is given by the order of points, or by an angle; a length has no sign")
}

pub fn curve_is_a_point(name: &Name, argument: &str, at: Span) -> Diagnostic {
    Diagnostic::new(Code::E0411, format!("curve `{}` does not depend on its argument `{argument}`", name.text))
        .at(at, "the same point for every value")
        .help(format!("a circle of radius r about the origin is `(r * cos({argument}), r * sin({argument}))`"))
}

// ---- tables

pub fn not_a_unit_of_a_column(name: &Name) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text)).at(name.span, "the unit of a column");
    meant_unit(diagnostic, name)
}

pub fn not_a_unit_to_print_in(name: &Name) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text))
        .at(name.span, "only units, `*`, `/` and powers may stand behind `in`");
    meant_unit(diagnostic, name)
}

/// A unit behind `in` that is of another dimension than the formula: with the places and dimensions of the two.
pub fn not_printed_in(unit: &str, [at, formula]: [Span; 2], [own, found]: [Dimension; 2]) -> Diagnostic {
    let wanted = if own.is(Dimension::PURE) { "an angle".to_owned() } else { own.in_words() };
    Diagnostic::new(Code::E0402, format!("what is printed in `{unit}` must be {wanted}, found {}", found.in_words()))
        .at(at, wanted)
        .also(formula, found.in_words())
        .help(if found.is(Dimension::PURE) {
            "leave `in` out, or name a unit of angle: `in deg`".to_owned()
        } else {
            format!("name a unit of its dimension: `in {}`", usual_unit(found))
        })
}

/// A turning speed in hertz.
pub fn turning_in_hertz(at: Span, formula: Span) -> Diagnostic {
    Diagnostic::new(Code::E0402, "a turning speed is not printed in `Hz`")
        .at(at, "1 per second")
        .also(formula, "radians per second")
        .help("name a unit of turning speed: `in rpm` or `in rev/s`")
}

/// A column that a file does not have.
pub fn no_column(path: &Name, column: &ColumnName, header: &[&str]) -> Diagnostic {
    let (message, wanted) = match &column.kind {
        ColumnWord::Number(number) => (format!("`{}` has no column {number}", path.text), None),
        ColumnWord::Named(name) => (format!("`{}` has no column `{name}`", path.text), Some(name)),
    };
    let diagnostic = Diagnostic::new(Code::E0201, message).at(column.span, "not in its first line");
    let Some(name) = wanted else {
        return diagnostic.help(match header.len() {
            1 => "it has 1 column; columns are separated by commas".to_owned(),
            count => format!("it has {count} columns"),
        });
    };
    match nearest(name, header.iter().copied()) {
        Some(meant) => diagnostic.fix(Fix::replace(
            column.span,
            format!("\"{meant}\""),
            format!("did you mean `{meant}`?"),
            Applies::Probably,
        )),
        None => diagnostic.help(format!("its first line has {}", list(header))),
    }
}

/// A name of a column that stands twice in a file's first line.
pub fn column_twice(path: &Name, span: Span, name: &str, [first, second]: [usize; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0203, format!("`{}` has two columns `{name}`", path.text))
        .at(span, "which of them?")
        .help(format!("take one by its number: {} or {}", first + 1, second + 1))
}

pub fn row_of(span: Span, found: usize) -> Diagnostic {
    Diagnostic::new(Code::E0301, format!("a row of a table is an argument and a value, found {found} parts"))
        .at(span, format!("found {found}"))
        .help("a row is written `(argument, value)`")
}

/// A file that nobody has tried to read: the mechanism was checked without its files.
pub fn no_table_file(path: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0701, format!("cannot read `{}`: there is no such file", path.text))
        .at(path.span, "named here")
}

pub fn empty_table_file(path: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0413, format!("the file `{}` holds no row", path.text))
        .at(path.span, "named here")
        .help("a row is an argument and a value, separated by a comma")
}

pub fn too_few_rows(name: &Name, periodic: bool, least: usize, found: usize) -> Diagnostic {
    let what = if periodic { "a periodic table" } else { "a table" };
    Diagnostic::new(Code::E0413, format!("table `{}` has too few rows: {what} needs {least}, found {found}", name.text))
        .at(name.span, format!("found {found}"))
}

pub fn not_rising(name: &Name, [here, before]: [f64; 2], rows: [Span; 2]) -> Diagnostic {
    let (this, last) = (readable(here), readable(before));
    let message = format!("the arguments of table `{}` do not rise: {this} follows {last}", name.text);
    let text = if here < before { "smaller than the one before" } else { "the same as the one before" };
    Diagnostic::new(Code::E0414, message)
        .at(rows[0], text)
        .also(rows[1], "the row before")
        .help("arguments must rise from row to row")
}

pub fn ends_differ(name: &Name, ends: [Span; 2], [last, first]: [f64; 2], dimension: Dimension) -> Diagnostic {
    let [last, first] = [last, first].map(|value| told(value, dimension));
    let message = format!("periodic table `{}` ends with {last}, and begins with {first}", name.text);
    let diagnostic = Diagnostic::new(Code::E0415, message).at(ends[0], "the last row");
    diagnostic.also(ends[1], "the first row").help("its last row repeats the first value, one period on")
}

pub fn out_of_table(name: &Name, value: f64, ends: [f64; 2], dimension: Dimension, span: Span) -> Diagnostic {
    let [value, first, last] = [value, ends[0], ends[1]].map(|value| told(value, dimension));
    let message = format!("{value} is not in the range of table `{}`, {first} to {last}", name.text);
    Diagnostic::new(Code::E0417, message).at(span, "out of range").help("a `periodic spline` repeats; a spline ends")
}

// ---- as drawn

/// Gears of which nothing says in which direction they lie from each other.
pub fn centers_coincide(circles: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0412, "the centres of these gears coincide as the bodies are drawn")
        .at(circles[1], "its centre is that of the other one")
        .also(circles[0], "the other one")
        .help("give the bodies poses in `at` that show in which direction one gear lies from the other")
}

/// A pinion of which nothing says on which side of its rack it lies.
pub fn center_on_the_rack(arguments: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0412, "the centre of this pinion lies on the axis of its rack as the bodies are drawn")
        .at(arguments[0], "on neither side")
        .also(arguments[1], "of this axis")
        .help("give poses in `at` that show the side, or say it: `rack_pinion(c, a, phase, left)`")
}

pub fn side_without_phase(side: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("expected a phase before `{side}`"))
        .at(span, "the third argument is a length")
        .fix(Fix::insert(
            span,
            "0 mm, ",
            format!("write the phase too: `rack_pinion(c, a, 0 mm, {side})`"),
            Applies::Probably,
        ))
}

pub fn no_side(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0302, "expected `left` or `right`")
        .at(span, "the side of the axis on which the pinion lies")
        .help("left and right are seen along the direction of the axis")
}

pub fn step_not_positive(span: Span, value: f64) -> Diagnostic {
    let value = readable(value);
    Diagnostic::new(Code::E0407, format!("the analysis needs a positive step, it is {value} s"))
        .at(span, format!("{value} s"))
        .help("`every` is the time from one row to the next")
}

/// With the places and the texts of the start and the end.
pub fn ends_before_start(spans: [Span; 2], texts: [&str; 2], from: f64, to: f64) -> Diagnostic {
    let is_duration = to > 0.0;
    let after = readable(from + to);
    let [from, to] = [from, to].map(readable);
    let edit = |k: usize, text: &str| Edit { span: spans[k], text: text.to_owned() };
    let message = format!("the other way round: `from {to} s to {from} s`");
    let edits = vec![edit(0, texts[1]), edit(1, texts[0])];
    let other_way = Fix { message, edits, applies: Applies::Probably };
    let unit = if texts.iter().all(|text| is_bare_number(text)) { "" } else { " s" };
    let end = Fix::replace(
        spans[1],
        format!("{after}{unit}"),
        format!("`to` is a time, and no duration: `from {from} s to {after} s`"),
        Applies::Probably,
    );
    Diagnostic::new(Code::E0408, format!("the analysis ends at {to} s, before its start at {from} s"))
        .at(spans[1], "the end")
        .change(is_duration.then_some(end))
        .change(Some(other_way))
        .help(if is_duration {
            format!("`to` is a time, and no duration: `from {from} s to {after} s`; or the other way round: `from {to} s to {from} s`")
        } else {
            format!("the other way round: `from {to} s to {from} s`")
        })
}

pub fn empty_interval(function: &str, span: Span, ends: [f64; 2], dimension: Dimension) -> Diagnostic {
    let [from, to] = ends.map(|end| told(end, dimension));
    Diagnostic::new(
        Code::E0409,
        format!("`{function}` needs an interval that goes forward, this one is from {from} to {to}"),
    )
    .at(span, "the end of the interval")
    .help("the arguments are `(u, u0, v0, u1, v1)`, with `u0 < u1`")
}

pub fn too_large(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0410, "written out, this formula is too large")
        .at(span, "more than a million parts")
        .help("functions that call each other several times with different arguments multiply; name common parts")
}

/// The text is that of the number.
pub fn degrees(span: Span, value: f64, text: &str) -> Diagnostic {
    let value = readable(value);
    let words = format!("write `{value} deg`, or `{value} rad` if radians are meant");
    let unit = |unit: &str| Fix::append(span, format!(" {unit}"), format!("write `{value} {unit}`"), Applies::Probably);
    let is_bare = is_bare_number(text);
    Diagnostic::new(Code::W0401, format!("{value} rad is more than a turn; degrees were probably meant"))
        .at(span, "a bare number is in radians")
        .help(words)
        .change(is_bare.then(|| unit("deg")))
        .change(is_bare.then(|| unit("rad")))
}

/// A length whose formula holds no unit, and where that would be written.
#[derive(Clone, Copy)]
pub struct Plain<'a> {
    /// In metres, without its sign.
    pub value: f64,
    pub span: Span,
    /// Of the parameter that it is.
    pub name: Option<&'a str>,
    /// Whether a number stands there, behind which the unit can be written.
    pub is_number: bool,
}

/// All lengths without a unit, in their order in the text, which dwarf the largest one with a unit (m).
pub fn no_unit_of_length(lengths: &[Plain<'_>], largest: f64, unit: &str) -> Diagnostic {
    let taken = |plain: &Plain<'_>| format!("taken as {}", told(plain.value, Dimension::LENGTH));
    let first = &lengths[0];
    let (what, largest) =
        (first.name.map_or("a length".to_owned(), |name| format!("`{name}`")), told(largest, Dimension::LENGTH));
    let message = format!("{what} has no unit and is {}; the largest length with a unit is {largest}", taken(first));
    let mut diagnostic = Diagnostic::new(Code::W0402, message).at(first.span, "no unit, so in metres");
    for plain in lengths.iter().skip(1).take(MOST_PLACES) {
        diagnostic = diagnostic.also(plain.span, taken(plain));
    }
    // where a formula wants its unit is known to whoever wrote it
    let written = |unit: &str| match lengths {
        [only] if only.is_number => format!("`{} {unit}`", readable(only.value)),
        _ => format!("`{unit}` behind the numbers that have no unit"),
    };
    let numbers: Vec<Span> = lengths.iter().filter(|plain| plain.is_number).map(|plain| plain.span).collect();
    let with = |unit: &str| {
        let edit = |span: &Span| Edit { span: Span { start: span.end, ..*span }, text: format!(" {unit}") };
        let message = format!("write {}", written(unit));
        Fix { message, edits: numbers.iter().map(edit).collect(), applies: Applies::Probably }
    };
    let can_be_written = !numbers.is_empty();
    diagnostic
        .help(format!("write {}; if metres are meant, `m`", written(unit)))
        .change(can_be_written.then(|| with(unit)))
        .change(can_be_written.then(|| with("m")))
}

// ---- repetition

/// `for k = 2`, of the copy in which something is wrong.
fn of_copy(diagnostic: Diagnostic, numbers: &[(&str, i64)]) -> Diagnostic {
    if numbers.is_empty() {
        return diagnostic;
    }
    let numbers: Vec<String> = numbers.iter().map(|(index, k)| format!("`{index}` = {k}")).collect();
    diagnostic.note(format!("for {}", numbers.join(", ")))
}

pub fn not_whole(place: &str, span: Span, value: f64, numbers: &[(&str, i64)]) -> Diagnostic {
    let value = readable(value);
    let diagnostic = Diagnostic::new(Code::E0208, format!("{place} must be a whole number, it is {value}"));
    of_copy(diagnostic.at(span, value), numbers)
}

pub fn no_such_copy(copy: &str, span: Span, ends: [Option<String>; 2], numbers: &[(&str, i64)]) -> Diagnostic {
    let known = match ends {
        [Some(first), Some(last)] => format!("they go from `{first}` to `{last}`"),
        _ => "its range is empty".to_owned(),
    };
    of_copy(Diagnostic::new(Code::E0208, format!("there is no `{copy}`")).at(span, known), numbers)
}

pub fn which_copy(name: &Name, first: Option<&str>) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0208, format!("`{}` is repeated: this does not say which one", name.text));
    let help = first.map(|first| format!("write its number behind it: `{first}`"));
    diagnostic.at(name.span, "one of several").help_if(help)
}

pub fn not_repeated(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0208, format!("`{}` is not repeated, there is only one", name.text))
        .at(name.span, "takes no number in brackets")
        .help("what is repeated is declared with a range: `body link[k in 0..3] …`")
}

/// `arm.tip.x`, or a number behind what is not repeated, the first name being known or not.
pub fn path_of_nothing(span: Span, segments: &[PathSegment], is_known: bool) -> Diagnostic {
    match segments {
        [owner, point, coordinate] if ["x", "y"].contains(&coordinate.name.text.as_str()) => {
            let indices: Vec<String> = owner.indices.iter().map(expression).collect();
            let brackets = if indices.is_empty() { String::new() } else { format!("[{}]", indices.join(", ")) };
            let text = format!("{}({}{brackets}.{})", coordinate.name.text, owner.name.text, point.name.text);
            let message = format!("a coordinate of a point is written `{text}`");
            Diagnostic::new(Code::E0302, "expected a number, found a path that goes on behind a point")
                .at(span, "a body has points, and they have nothing of their own")
                .fix(Fix::replace(span, text, message, Applies::Probably))
        }
        [_, _, _, ..] => Diagnostic::new(Code::E0208, "a path is a body, and a feature of it")
            .at(span, "goes on")
            .help("the number stands behind what is repeated: `link[2].pin`"),
        [_, feature] if !feature.indices.is_empty() => {
            Diagnostic::new(Code::E0208, format!("`{}` is not repeated, there is only one", feature.name.text))
                .at(feature.name.span, "takes no number in brackets")
                .help("a body is repeated with all its features, and the number stands behind it: `link[2].pin`")
        }
        [owner, ..] if is_known => not_repeated(&owner.name),
        _ => Diagnostic::new(Code::E0208, "nothing of this name is repeated")
            .at(span, "this takes one of several")
            .help("what is repeated is declared with a range: `body link[k in 0..3] …`"),
    }
}

pub fn index_is_taken(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0207, format!("the index `{}` hides what has that name already", name.text))
        .at(name.span, "not free")
        .help("choose a name that nothing else has: `i`, `j`, `k`")
}

pub fn too_many_declarations(span: Span, most: usize, label: &str) -> Diagnostic {
    Diagnostic::new(Code::E0208, format!("written out, the mechanism has more than {most} declarations"))
        .at(span, label)
}

// ---- the whole

pub fn empty(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0501, format!("mechanism `{}` has no body that could move", name.text))
        .at(name.span, "empty")
        .help("declare a body: `body crank at (0, 0, 0) { … }`")
}

/// As many names as a message has room for.
fn some_of(names: &[&str]) -> String {
    const MOST: usize = 24;
    match names.get(..MOST) {
        Some(first) if names.len() > MOST => format!("{}, … ({} in all)", first.join(", "), names.len()),
        _ => names.join(", "),
    }
}

/// `a`, `b` and `c`.
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}
