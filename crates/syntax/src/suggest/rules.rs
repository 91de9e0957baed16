//! The table of what other programs, languages and textbooks write, with its correction.

use super::pattern::Line;
use super::{Fault, Suggestion};
use crate::grammar::Rule;
use mechc_text::diag::Applicability;

/// One way to write something that is written differently in the language.
pub(super) struct Correction {
    /// Pattern of [`super::pattern`].
    pattern: &'static str,
    /// What stands for the marked part of the pattern, if an edit is offered.
    replacement: Option<&'static str>,
    message: &'static str,
    applies: Applicability,
    /// Rules of which the parser expected one; empty if that does not matter.
    expected: &'static [Rule],
}

const fn words(pattern: &'static str, message: &'static str) -> Correction {
    Correction { pattern, replacement: None, message, applies: Applicability::Probably, expected: &[] }
}

const fn fix(pattern: &'static str, replacement: &'static str, message: &'static str) -> Correction {
    Correction { replacement: Some(replacement), ..words(pattern, message) }
}

/// A fix that is correct in every case.
const fn sure(pattern: &'static str, replacement: &'static str, message: &'static str) -> Correction {
    Correction { applies: Applicability::Always, ..fix(pattern, replacement, message) }
}

impl Correction {
    const fn at(self, expected: &'static [Rule]) -> Correction {
        Correction { expected, ..self }
    }
}

/// Returns the first correction of a table that fits.
pub(super) fn first_of(table: &[Correction], line: &Line<'_>, fault: &Fault<'_>) -> Option<Suggestion> {
    table.iter().find_map(|correction| {
        let is_expected = correction.expected.is_empty() || correction.expected.iter().any(|rule| fault.expects(*rule));
        let found = line.matched(correction.pattern).filter(|_| is_expected)?;
        let fix = |text| line.fix(&found, text, correction.message, correction.applies, fault);
        Some(match correction.replacement.map(fix) {
            Some(Some(fix)) => Suggestion::Fix(fix),
            // a comment stands in between
            Some(None) => return None,
            None => Suggestion::Words(line.filled(correction.message, &found, true)),
        })
    })
}

/// Rules that begin an operand.
pub(super) const OPERAND: &[Rule] = &[Rule::expr, Rule::prefix, Rule::literal, Rule::number, Rule::call];
const OPERATOR: &[Rule] = &[Rule::infix];
const UNIT_AS_FACTOR: &str =
    "a unit follows a number only: `… * 1 {1}` gives it to a pure number, `… / 1 {1}` takes it away";

/// Rules that begin a declaration of a mechanism, and one of a body.
const ITEM: &[Rule] = &[Rule::kw_param, Rule::param];
const FEATURE: &[Rule] = &[Rule::kw_point, Rule::point];

/// What stands where a declaration begins and is none.
#[rustfmt::skip]
pub(super) const BEGINNINGS: &[Correction] = &[
    fix("« import|include|require|from » TEXT", "use", "a file is used by `use \"FILE.mech\"`").at(&[Rule::kw_use, Rule::kw_mechanism]),
    words("use TEXT", "a `use` stands at the top of the file, above the first `mechanism`").at(&[Rule::kw_param, Rule::param, Rule::kw_point, Rule::point]),
    words("inertia", "an inertia stands behind its mass: `mass M inertia I`").at(FEATURE),
    fix("« » FREE = (", "point ", "a point is declared by `point {1} = …`").at(FEATURE),
    fix("« JOINT NAME : » (", "joint {2}: {1}", "a joint is declared by `{=}(…)`").at(ITEM),
    fix("« JOINT NAME » (", "joint {2}: {1}", "a joint is declared by `{=}(…)`").at(ITEM),
    words("JOINT (", "a joint is declared by `joint NAME: {1}(…)`").at(ITEM),
    fix("« » FREE = spline|periodic", "table ", "a table is declared by `table {1} = …`").at(ITEM),
    fix("« » FREE = … QUANTITY|der|x|y (", "measure ", "a measure is declared by `measure {1} = …`").at(ITEM),
    fix("« » FREE =", "param ", "a param is declared by `param {1} = …`").at(ITEM),
    fix("« » FREE : … = … t", "driver ", "a driver is declared by `driver {1}: …`").at(ITEM),
    fix("« » FREE : … =", "constraint ", "a constraint is declared by `constraint {1}: …`").at(ITEM),
    fix("« » FREE : JOINT", "joint ", "a joint is declared by `joint {1}: …`").at(ITEM),
    fix("« » FREE {", "body ", "a body is declared by `body {1} {`").at(ITEM),
];

/// Faults within a declaration; the first that fits applies.
#[rustfmt::skip]
pub(super) const DECLARATIONS: &[Correction] = &[
    // masses, gravity and loads
    fix("mass|gravity « @ =|: » REST", " ", "it is written without `{2}`: `{1} {3}`"),
    fix("mass « NAME @ =|: »", " ", "a mass has no name"),
    fix("mass ANY « @ , » at|inertia", "", "what belongs to a mass stands behind it without commas"),
    fix("mass ANY « inertia ANY @ at ANY » $", "at {3} inertia {2}", "the place of a mass stands before its inertia: `mass M at (x, y) inertia I`"),
    fix("mass ANY « » @ (", " at ", "the place of a mass stands behind `at`: `mass M at (x, y)`").at(&[Rule::at]),
    fix("mass … « @ center|centre|com|COM|cog|cg|CG|centroid »", "at", "was `at` meant?"),
    fix("mass … « @ I|J|Ixx|Iyy|Izz|izz|IZZ|moment|moment_of_inertia »", "inertia", "was `inertia` meant?"),
    fix("gravity « ANY @ , ANY » $", "({1}, {2})", "gravity is a pair in parentheses: `gravity {=}`"),
    fix("load NAME : « QUANTITY|x|y ANY @ = ANY » $", "{4} on {2}{3}", "a load says how much, and on what it works: `{=}`"),
    // repetition, types
    fix("REPEATED NAME [ « NUM|NAME » ]", "{free 1} in 0..{3}", "what is repeated has an index with its range, from 0 on: `{1} {2}[{=}]`"),
    fix("REPEATED NAME [ « NUM|NAME , NUM|NAME » ]", "{free 1} in 0..{3}, {free 2} in 0..{4}", "what is repeated has an index with its range, from 0 on: `{1} {2}[{=}]`"),
    fix("REPEATED NAME [ « NUM ..|..= NUM|NAME » ]", "{free 1} in {3}{4}{5}", "what is repeated has an index with its range: `{1} {2}[{=}]`"),
    fix("EQUALS NAME « : UNIT = NUM » $", " = {4} {3}", "a unit stands behind its number: `{1} {2} {=}`"),
    words("EQUALS NAME : UNIT =", "a unit stands behind each number, and not behind the name"),
    fix("EQUALS NAME « : NAME = »", " = ", "a type is not written, its value has one: `{1} {2} = …`"),
    // names
    sure("COLON NAME « » @ JOINT|rotation|displacement|distance|angle|x|y (|{|[", ": ", "write `:` before `{3}`"),
    sure("joint « KIND @ NAME » (", "{2}: {1}", "the name of a joint stands before its kind: `{=}(…)`"),
    fix("joint « JOINT @ NAME » (", "{2}: {1}", "the name of a joint stands before its kind: `{=}(…)`"),
    words("COLON @ : REST", "a {1} needs a name: `{1} NAME: {2}`"),
    words("EQUALS @ = REST", "a {1} needs a name: `{1} NAME = {2}`"),
    words("EQUALS @ ( …", "a {1} needs a name: `{1} NAME = (…)`").at(&[Rule::name]),
    words("joint JOINT @ ( ANY ) $", "a joint needs a name: `joint NAME: {1}({2})`"),
    words("COLON CALLED ~ @ REST", "a {1} needs a name: `{1} NAME: {2}{3}`"),
    words("EQUALS CALLED|der ~ @ REST", "a {1} needs a name: `{1} NAME = {2}{3}`").at(&[Rule::equals]),
    words("body @ {", "a body needs a name: `body NAME { … }`"),
    fix("DECLARATION « @ STRING »", "{2}", "a name stands without quotes: `{2}`").at(&[Rule::name]),
    fix("body|mechanism « NAME @ WORD » {|at", "{2}_{3}", "a name is one word: write `{=}`"),
    fix("COLON « NAME @ WORD » :", "{2}_{3}", "a name is one word: write `{=}`"),
    fix("EQUALS « NAME @ WORD » =", "{2}_{3}", "a name is one word: write `{=}`"),
    fix("DECLARATION « NAME @ . WORD » :|=|{|at", "{2}_{3}", "a name is one word: write `{=}`"),
    fix("ground « @ NAME » {", "", "the ground has no name: `ground {`"),
    words("DECLARATION NAME @ ²|³", "a name is made of letters, digits and `_`"),
    // functions of one argument
    fix("fn|curve « NAME @ NAME » =", "{2}({3})", "its argument stands behind the name: `{1} {=} = …`"),
    fix("fn|curve « NAME » @ = … ARGUMENT", "{2}({3})", "its argument stands behind the name: `{1} {=} = …`"),
    words("fn|curve NAME @ =", "its argument stands behind the name: `{1} {2}(u) = …`"),
    fix("« param » NAME @ ( NAME )", "fn", "what has an argument is declared by `fn`"),
    words("fn NAME ( NAME @ ,", "a `fn` has one argument: what else it needs can be a `param`"),
    // products and calls
    fix("… « x|y @ NAME . NAME » !(|[|.", "{1}({2}.{3})", "arguments stand in parentheses: `{=}`").at(OPERATOR),
    fix("… « QUANTITY @ PATHS » !(|[", "{1}({2})", "arguments stand in parentheses: `{=}`").at(OPERATOR),
    fix("… NUM « » NAME @ (", " * ", "a product is written with `*`: `{1} * {2}(…)`").at(OPERATOR),
    fix("… « FUNCTION @ NUM UNIT »", "{1}({2} {3})", "what a function is of stands in parentheses: `{=}`").at(OPERATOR),
    fix("… « FUNCTION @ NAME|NUM » !(|[|.", "{1}({2})", "what a function is of stands in parentheses: `{=}`").at(OPERATOR),
    words("… FUNCTION @ NAME|NUM|(", "what a function is of stands in parentheses: `{1}(…)`").at(OPERATOR),
    // joints and equations
    fix("joint NAMED : « @ JOINT PATHS ) » $", "{2}({3})", "arguments stand in parentheses: `{=}`"),
    fix("joint NAMED : « @ JOINT PATHS » $", "{2}({3})", "arguments stand in parentheses: `{=}`"),
    words("joint NAMED : @ JOINT", "what a joint is of stands in parentheses: {form 2}"),
    words("joint NAMED : @ (", "a joint has a kind: `joint {1}: revolute(…)`; `mechc explain joints` has them all"),
    fix("« joint » NAMED : ANY @ = … t", "driver", "an equation is a `driver`: `driver {1}: …`"),
    fix("« joint » NAMED : ANY @ =", "constraint", "an equation is a `constraint`: `constraint {1}: …`"),
    fix("driver NAMED : ANY « @ NAME NUM rpm|Hz » $", "= {4} {5} * t", "a driver is an equation: `{2} {=}`").at(&[Rule::equals]),
    words("driver|constraint NAMED : ANY @ NAME", "a {1} is an equation: `{3} = …`").at(&[Rule::equals]),
    words("part NAMED : … ) … @ on|at|mirrored", "`on`, `at` and `mirrored` stand in this order, each once: `on BODY at (x, y, phi) mirrored`"),
    // `:` and `=`
    sure("COLON NAMED « : @ = »", ": ", "a `:` alone stands behind the name"),
    sure("COLON NAMED « @ = »", ": ", "write `:` instead of `=`").at(&[Rule::colon]),
    sure("EQUALS NAMED « @ : = »", " = ", "write `=` instead of `:=`"),
    sure("EQUALS NAMED « @ : »", " = ", "write `=` instead of `:`").at(&[Rule::equals]),
    sure("table|measure|param|result NAMED « » @ NUM|spline|periodic", " = ", "write `=` before `{3}`").at(&[Rule::equals]),
    sure("param|measure|result NAMED « » @ CALLED|x|y|der (", " = ", "write `=` before `{3}`").at(&[Rule::equals]),
    sure("point NAMED « » @ (", " = ", "write `=` before `(`").at(&[Rule::equals]),
    fix("EQUALS NAMED « » @ (|WORD", " = ", "write `=` before `{3}`").at(&[Rule::equals]),
    sure("fn|curve NAME ( NAME ) « @ : »", " = ", "write `=` instead of `:`"),
    sure("fn|curve NAME ( NAME ) « » @ (|NUM|NAME", " = ", "write `=` before `{4}`").at(&[Rule::equals]),
    fix("COLON NAMED « » @ WORD", ": ", "write `:` before `{3}`").at(&[Rule::colon]),
    sure("… « = ~ @ = »", "=", "an equation is written with one `=`"),
    sure("… « @ == »", "=", "an equation is written with one `=`").at(&[Rule::equals]),
    sure("… « @ = »", "==", "a comparison is written `==`").at(&[Rule::kw_then]),
    // features
    fix("point NAME = « » ANY @ , ANY )", " (", "the `(` before it is missing"),
    fix("body NAMED at « » ANY @ , ANY )", " (", "the `(` before it is missing"),
    fix("axis NAME = ANY along « » @ ANY , ANY )", " (", "the `(` before it is missing"),
    fix("point NAME = « ANY @ , ANY » $", "({2}, {3})", "a point is a pair in parentheses: `{=}`"),
    fix("body NAMED at « ANY @ , ANY » {", "({2}, {3})", "a pose is two lengths and an angle in parentheses: `{=}`"),
    fix("axis NAME = ANY along « @ ANY , ANY » $", "({3}, {4})", "a direction is a pair in parentheses: `{=}`"),
    fix("axis NAME = ANY along « @ ANY » $", "(cos({3}), sin({3}))", "a direction is a pair; that of an angle is `{=}`").at(&[Rule::paren]),
    fix("axis NAME = ANY « @ , » (", " along ", "write `along` instead of the `,`").at(&[Rule::along]),
    fix("axis NAME = ANY « @ , »", " to ", "write `to` instead of the `,`").at(&[Rule::along]),
    sure("body NAMED « » @ (", " at ", "write `at` before `(`").at(&[Rule::at]),
    fix("body NAMED « { @ at ANY »", "at {2} {", "the pose stands before the `{`: `body {1} {=}`"),
    fix("circle NAME = « ( ANY , ANY , ANY ) » $", "({2}, {3}) radius {4}", "the radius stands behind the center: `{=}`").at(&[Rule::radius]),
    fix("circle NAME = ANY « @ diameter|dia|d|Ø ANY » $", "radius {4} / 2", "a circle has a radius: `{=}`"),
    fix("point|axis|circle NAME = « ( NUM , NUM ) @ UNIT »", "({3} {5}, {4} {5})", "each number has its own unit: `{=}`"),
    words("table … [ NUM @ NUM", "a row is a pair in parentheses: `(0, 0), (1, 2)`"),
    words("table … [ NUM UNIT @ NUM", "a row is a pair in parentheses: `(0, 0), (1, 2)`"),
    sure("table … ) « » @ (", ", ", "rows are separated by commas: `(1, 2), (3, 4)`"),
    // values and their units
    fix("measure NAME = « PATH @ , PATH » $", "distance({2}, {3})", "the distance of two points is `{=}`"),
    words("trace NAME = ANY @ , ANY", "a trace is the path of one point: each has its own `trace`"),
    words("measure|result NAME = ANY @ , ANY", "a {1} is one number: each has its own `{1}`"),
    fix("… NUM « @ [ UNITS ] »", " {2}", "a unit follows its number without brackets: `{1} {2}`"),
    words("… NUM UNIT @ deg|rad|rev|mrad", "an angle is no factor of a unit: `… * 1 {3}` gives it to a pure number, `… / 1 {3}` takes it away"),
    fix("… NUM « @ in » UNIT", "", "a unit follows its number without `in`: `{1} {2}`").at(OPERATOR),
    fix("… NUM UNIT « » @ UNIT ^ NUM", "*", "a product of units is written with `*`: `{1} {2}*{3}^{4}`"),
    fix("… NUM UNIT « » @ UNIT", "*", "a product of units is written with `*`: `{1} {2}*{3}`"),
    fix("measure|trace|result NAMED = ANY « @ as|in UNITS » $", " in {5}", "the unit in which it is printed stands behind `in`: `in {5}`"),
    fix("measure|trace|result NAMED = PATH « » @ UNITS $", " in ", "the unit in which it is printed stands behind `in`: `in {4}`"),
    fix("measure|trace|result NAMED = … ) … « » @ UNITS $", " in ", "the unit in which it is printed stands behind `in`: `in {3}`"),
    words("… !t @ UNIT", UNIT_AS_FACTOR).at(OPERATOR),
    words("load NAME : ANY @ =|at|to|NAME", "what a load works on stands behind `on`: `20 N on x(P)`, `3 N*m on rotation(J)`").at(&[Rule::kw_on]),
    // members
    fix("… « NAME . NAME @ . x|y »", "{3}({1}.{2})", "a coordinate of a point is written `{=}`"),
    fix("… NAME « - @ > » NAME", ".", "what belongs to a body is written `{1}.{2}`"),
    fix("… NAME « @ : : » NAME", ".", "what belongs to a body is written `{1}.{2}`"),
    fix("… ( … BODY « » @ NAME", ".", "what belongs to a body is written `{1}.{2}`"),
    fix("… @ ground « - > » NAME", ".", "what belongs to the ground is written `ground.{1}`"),
    fix("… @ ground « : : » NAME", ".", "what belongs to the ground is written `ground.{1}`"),
    fix("… @ ground « » NAME", ".", "what belongs to the ground is written `ground.{1}`"),
    fix("… « @ QUOTE PATH QUOTE »", "{2}", "names stand without quotes: `{2}`"),
    fix("… « @ QUOTED »", "{1}", "names stand without quotes: `{1}`").at(OPERAND),
    // files
    fix("… use « @ GLUED »", "\"{1}\"", "the path of a file stands in quotes").at(&[Rule::string]),
    words("… as $", "a name stands behind `as`: `use \"FILE.mech\" as legs`").at(&[Rule::use_prefix, Rule::name]),
    // windows of reductions
    sure("… REDUCTION ( ANY , from ANY « , » @ to", " ", "no comma stands in a window: `from A to B`"),
    words("… REDUCTION ( ANY , from|to ANY , @", "a window stands behind all arguments"),
    words("… REDUCTION ( … from … @ to", "a sign or a bracket behind `from` stands in parentheses apart from it: `from (-1 s)`").at(&[Rule::comma]),
    sure("… REDUCTION ( ANY « » @ from|to", ", ", "a window stands behind a comma: `max(e, from A to B)`").at(&[Rule::comma]),
    words("… REDUCTION ( from|to @", "a window stands behind a formula: `max(e, from A to B)`").at(&[Rule::comma]),
    // what is superfluous
    fix("DECLARATION ANY « @ , » NAME =|:", " {1} ", "each {1} has its own keyword: `{1} {3} {4} …`"),
    fix("DECLARATION ANY « @ ) »", "", "this `)` closes nothing; leave it out").at(&[Rule::infix, Rule::close, Rule::kw_point, Rule::at]),
    // operators
    sure("… « * ~ @ * »", "^", "a power is written with `^`"),
    sure("… « @ & & »", " and ", "conditions are joined with `and`").at(OPERATOR),
    words("… @ &", "conditions are joined with `and`").at(OPERATOR),
    sure("… « @ BAR BAR »", " or ", "conditions are joined with `or`").at(OPERATOR),
    words("… @ BAR", "an absolute value is written `abs(a)`"),
    sure("… « @ ! »", "not ", "a condition is denied with `not`").at(OPERAND),
    words("… @ ?", "a choice is written `if CONDITION then A else B`").at(OPERATOR),
    words("… ) @ . d|dot|diff", "a time derivative is written `der(…)`, in a measure; `der(der(…))` is the second"),
    sure("… « @ + »", "", "a positive number needs no sign").at(OPERAND),
    words("… @ √", "a square root is written `sqrt(a)`"),
    words("… @ ²|³ (", "the power of a function is `f(x)^2`"),
    sure("… « @ ² »", "^2", "a square is written `^2`").at(OPERATOR),
    sure("… « @ ³ »", "^3", "a cube is written `^3`").at(OPERATOR),
    words("… NUM @ ° ^", "degrees are written `deg`; the power of an angle is `({1} deg)^…`"),
    sure("… NUM « @ ° »", " deg", "degrees are written `{1} deg`"),
    fix("… NAME|) « @ ° »", " * 1 deg", "degrees are written `deg`").at(OPERATOR),
    // numbers
    sure("… « 0 ~ @ , ~ NUM »", "0.{1}", "decimals are written with a point: `0.{1}`").at(OPERATOR),
    fix("… « WHOLE ~ @ , ~ NUM »", "{1}.{2}", "decimals are written with a point: `{=}`").at(OPERATOR),
    words("… WHOLE ~ @ . ~ NAME", "a digit follows the point: `{1}.0`").at(OPERATOR),
    sure("… « WHOLE ~ @ . » !.", "{1}.0", "a digit follows the point: `{1}.0`").at(OPERATOR),
];
