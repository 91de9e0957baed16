//! Keywords, reserved everywhere or only in some positions.

use super::{Category, Example, Word};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// Length of the longest keyword (bytes).
const LONGEST: usize = 10;

/// Keywords by name; every word of a text is looked up here.
static BY_NAME: LazyLock<FxHashMap<&str, &Keyword>> =
    LazyLock::new(|| KEYWORDS.iter().map(|keyword| (keyword.word.name, keyword)).collect());

/// A keyword of declarations or formulas.
#[derive(Debug)]
pub struct Keyword {
    /// Documentation.
    pub word: Word,
    /// Position.
    pub role: Role,
}

/// Position of a keyword.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Begins a declaration of a file or mechanism; reserved.
    Declaration,
    /// Begins a declaration of a mechanism where one can begin; a name elsewhere.
    Opener,
    /// Begins a declaration in a body or the ground; reserved.
    Feature,
    /// Begins a declaration in a body where one can begin; a name elsewhere.
    FeatureOpener,
    /// Joins parts of a formula; reserved.
    Formula,
    /// Joins parts of a declaration. After a number it is not a unit; a name elsewhere.
    Separator,
    /// Joins parts of a declaration; a name elsewhere.
    Place,
    /// Argument of a joint; a name elsewhere.
    Side,
}

impl Role {
    /// Returns whether it begins a declaration where one can begin, and is a name elsewhere.
    #[must_use]
    pub fn is_opener(self) -> bool {
        matches!(self, Role::Opener | Role::FeatureOpener)
    }
}

impl Keyword {
    /// Returns the keyword of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Keyword> {
        // most words need no lookup
        if name.len() > LONGEST || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            return None;
        }
        BY_NAME.get(name).copied()
    }

    /// Returns whether the keyword cannot be a name.
    #[must_use]
    pub fn is_reserved(&self) -> bool {
        matches!(self.role, Role::Declaration | Role::Feature | Role::Formula)
    }

    /// Returns whether it stands between the parts of a declaration or formula.
    #[must_use]
    pub fn is_joining(&self) -> bool {
        matches!(self.role, Role::Formula | Role::Separator | Role::Place)
    }

    /// Returns whether it begins a declaration in every position, and so ends any formula before it.
    #[must_use]
    pub fn begins_declaration(&self) -> bool {
        matches!(self.role, Role::Declaration | Role::Feature)
    }
}

/// Returns whether a reserved word begins a declaration.
#[must_use]
pub fn is_declaration(word: &str) -> bool {
    Keyword::named(word).is_some_and(Keyword::begins_declaration)
}

/// Returns whether a word begins a declaration in a body or the ground.
#[must_use]
pub fn is_feature(word: &str) -> bool {
    Keyword::named(word).is_some_and(|keyword| matches!(keyword.role, Role::Feature | Role::FeatureOpener))
}

/// Returns whether a name follows the keyword of a declaration.
#[must_use]
pub fn declares_name(keyword: &str) -> bool {
    !matches!(keyword, "ground" | "analysis" | "gravity" | "mass" | "require")
}

/// Returns whether the two tokens behind the keyword of a declaration are those of such a declaration, where the word could also be a name.
#[must_use]
pub fn continues_declaration(keyword: &str, next: &str, second: &str) -> bool {
    match keyword {
        "ground" => next == "{",
        "analysis" => next == "from",
        "fn" | "curve" => second == "(",
        "joint" | "driver" | "constraint" | "part" | "load" => second == ":",
        "mechanism" => second == "{",
        "body" => second == "{" || second == "at",
        // openers without a name are recognized by what stands beside them
        _ => !declares_name(keyword) || second == "=" && next != ")",
    }
}

const fn keyword(
    role: Role,
    name: &'static str,
    form: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: Example,
) -> Keyword {
    let word = Word { name, category: Category::Keyword, forms: form, letters: "", meaning, more, example };
    Keyword { word, role }
}

/// Text for the words of windows.
const WINDOW_WORDS: &str = "A window stands behind the formula of a reduction in a `result`: `max(e, from A to B)`, `max(e, from A)`, `max(e, to B)`. \
                            Elsewhere the word is a name, as it is in a call before an operator, a comma or a bracket that does not \
                            stand apart.";

/// Example of a lever that is used twice.
const TWO_LEVERS: Example = Example::Using(
    "\
mechanism lever {
    param reach = 80 mm
    input turn = 30 deg * sin(1 rev/s * t)
    ground { point O = (0, 0) }
    body arm {
        point O   = (0, 0)
        point tip = (reach, 0)
    }
    joint pivot: revolute(ground.O, arm.O)
    driver motor: rotation(pivot) = turn
}
",
    "\
part front: lever()
part back:  lever(reach = 60 mm, turn = angle(front.arm)) on front.arm at (80 mm, 0, 90 deg) mirrored
trace tip = back.arm.tip
analysis from 0 s to 1 s every 0.1 s",
);

/// Example of an arm with a mass.
const WEIGHING: Example = Example::Whole(
    "\
ground { point O = (0, 0) }
body arm {
    point O = (0, 0)
    mass 0.8 kg at (60 mm, 0) inertia 2.1e-3 kg * m^2
}
gravity (0, -9.81 m/s^2)
joint main: revolute(ground.O, arm.O)
driver motor: rotation(main) = 60 rpm * t
measure torque = effort(motor)",
);

/// Example of a rack and pinion whose poses do not decide on which side of the axis the pinion lies.
const ON_THE_LEFT: Example = Example::Whole(
    "\
ground {
    point O  = (0, 30 mm)
    axis way = (0, 0) along (1, 0)
}
body pinion {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body rack {
    axis way = (0, 0) along (1, 0)
}
joint axle: revolute(ground.O, pinion.O)
joint guide: translational(ground.way, rack.way)
joint mesh: rack_pinion(pinion.pitch, rack.way, 0 mm, left)
driver motor: rotation(axle) = 30 deg/s * t",
);

/// Example of a rack and pinion with the pinion on the right.
const ON_THE_RIGHT: Example = Example::Whole(
    "\
ground {
    point O  = (0, -30 mm)
    axis way = (0, 0) along (1, 0)
}
body pinion {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body rack {
    axis way = (0, 0) along (1, 0)
}
joint axle: revolute(ground.O, pinion.O)
joint guide: translational(ground.way, rack.way)
joint mesh: rack_pinion(pinion.pitch, rack.way, 0 mm, right)
driver motor: rotation(axle) = 30 deg/s * t",
);

/// All keywords, in the order of the grammar.
pub static KEYWORDS: &[Keyword] = &[
    keyword(
        Role::Opener,
        "use",
        &["use \"FILE.mech\"", "use \"FILE.mech\" as PREFIX"],
        "takes the mechanisms of another file, which may then serve as parts",
        "At the top of a file, before its mechanisms. The path is relative to the file that says so. Mechanisms have their names, or \
         behind `as` these names with a prefix, `PREFIX.NAME`. What the other file uses is not passed on.",
        Example::Arm("// at the top of the file: use \"legs.mech\" as walkers\nmeasure reach = x(arm.tip)"),
    ),
    keyword(
        Role::Declaration,
        "mechanism",
        &["mechanism NAME { … }"],
        "a mechanism: bodies, joints, drivers and what is to be known of them",
        "A file holds one or more, of different names. The declarations inside may stand in any order.",
        Example::Arm(""),
    ),
    keyword(
        Role::Declaration,
        "param",
        &["param NAME = FORMULA", "param NAME = (x, y)"],
        "a constant that has a name, or a point of the drawing",
        "Over other params, functions and tables, without `t`. It may be set from outside: `--set reach=60mm`. A point stands wherever \
         a literal point may, its coordinates are `NAME.x` and `NAME.y`, and it is set as `--set 'A=(12mm,0)'` or `--set A.x=12mm`.",
        Example::Arm("param reach = 80 mm\nmeasure beyond = x(arm.tip) - reach"),
    ),
    keyword(
        Role::Declaration,
        "fn",
        &["fn NAME(u) = FORMULA"],
        "a function of one argument",
        "Over its argument, `t`, params, other functions and tables, but not itself, and without kinematic quantities.",
        Example::Arm("fn swing(u) = 30 deg * sin(u)^2\ndriver motor: rotation(main) = swing(2 rad/s * t)"),
    ),
    keyword(
        Role::Declaration,
        "table",
        &[
            "table NAME = spline [(u0, v0), (u1, v1), …]",
            "table NAME = periodic spline […]",
            "table NAME = spline \"FILE.csv\" (UNIT, UNIT)",
            "table NAME = spline \"FILE.csv\" columns 1, 3 (UNIT, UNIT)",
        ],
        "a curve through points, called as a function is",
        "The natural cubic spline; its arguments rise, and what lies outside of them is an error at the time when it happens. With \
         `periodic` it repeats, and its last row has the value of the first, one period on.",
        Example::Arm(
            "table swing = spline [(0 s, 0 deg), (1 s, 30 deg), (2 s, 20 deg)]\ndriver motor: rotation(main) = swing(t)",
        ),
    ),
    keyword(
        Role::Declaration,
        "ground",
        &["ground { … }"],
        "the body that does not move, with its points, axes, circles and curves",
        "It has no coordinates; a mechanism has one. Its features are `ground.P`.",
        Example::Arm("measure reach = distance(ground.O, arm.tip)"),
    ),
    keyword(
        Role::Declaration,
        "body",
        &[
            "body NAME { … }",
            "body NAME at (x, y, phi) { … }",
            "body NAME at (P, phi) { … }",
            "body NAME at P toward Q { … }",
        ],
        "a rigid body, with its points, axes, circles and curves",
        "It has three coordinates: the place of its frame's origin, and its angle. The pose behind `at` is where the assembly begins \
         to look for it, `(0, 0, 0)` if it is not given; the features inside are in the body's own frame. P and Q are formulas of \
         points, with points of other bodies too, which are taken where these are drawn: `at (crank.pin, 30 deg)`.",
        Example::Arm("measure reach = x(arm.tip)"),
    ),
    keyword(
        Role::Feature,
        "point",
        &["point P = (x, y)", "point P = FORMULA", "point A"],
        "a point of a body or the ground",
        "Two lengths, in the frame of the body, or a formula of points: of the body's own, or of params that are points. `point A` \
         alone is the param A.",
        Example::Arm("measure height = y(arm.tip)"),
    ),
    keyword(
        Role::Feature,
        "axis",
        &["axis a = P along (dx, dy)", "axis a = P to Q"],
        "a directed line of a body or the ground",
        "P and Q are points of the body, or literal; only the direction of `(dx, dy)` counts.",
        Example::Of("translational"),
    ),
    keyword(
        Role::Feature,
        "circle",
        &["circle c = P radius r"],
        "a circle of a body or the ground: a gear's pitch circle, a roller, an eccentric",
        "P is a point of the body, or literal; the radius is positive.",
        Example::Of("gear"),
    ),
    keyword(
        Role::Feature,
        "curve",
        &["curve k(u) = (x, y)", "curve k(u) = (x, y) at ESTIMATE"],
        "a profile of a body or the ground",
        "x and y are lengths over the pure number u. The estimate is where on the curve the contact is looked for first; without it, \
         the best of one turn, −π to π.",
        Example::Of("point_follower"),
    ),
    keyword(
        Role::FeatureOpener,
        "mass",
        &["mass M", "mass M at P", "mass M at P inertia I"],
        "a mass of a body, with its centre and its moment of inertia about that",
        "P is `(x, y)` in the frame of the body, or a point of it; the body's origin if it is not given. All are constants over params, \
         none is negative, and several masses of a body add up. The ground has none. The word begins a declaration only where one begins \
         in a body, and is a name elsewhere.",
        WEIGHING,
    ),
    keyword(
        Role::Declaration,
        "joint",
        &["joint NAME: KIND(…)"],
        "what two bodies are joined by",
        "It brings equations, and its kind says which: `mechc explain joints`.",
        Example::Arm("measure turned = rotation(main)"),
    ),
    keyword(
        Role::Declaration,
        "driver",
        &["driver NAME: FORMULA = FORMULA"],
        "an equation that holds time: what a motor or actuator prescribes",
        "Between kinematic quantities on one side, mostly, and a formula of `t` on the other. Each takes one degree of freedom.",
        Example::Arm("driver motor: rotation(main) = 60 rpm * t + 30 deg"),
    ),
    keyword(
        Role::Declaration,
        "constraint",
        &["constraint NAME: FORMULA = FORMULA"],
        "an equation between kinematic quantities that always holds",
        "Time may not stand in it: that is a `driver`. Each takes one degree of freedom.",
        Example::Arm(
            "body hand at (100 mm, 0, 0) {\n    point O = (0, 0)\n}\njoint wrist: revolute(arm.tip, hand.O)\n\
         constraint level: angle(hand) = 0",
        ),
    ),
    keyword(
        Role::Opener,
        "gravity",
        &["gravity (gx, gy)"],
        "the acceleration of free fall, in the outermost frame",
        "Constants over params; there is none without it. That of a mechanism that serves as a part counts only when it runs alone. The word \
         begins a declaration only where one begins, and is a name elsewhere.",
        WEIGHING,
    ),
    keyword(
        Role::Opener,
        "load",
        &["load NAME: FORMULA on QUANTITY"],
        "a force or torque of which a formula is known: a spring, a damper, a weight, a pressure",
        "The formula holds `t`, inputs, params, kinematic quantities and their `der(…)`. The quantity is one of `x`, `y`, `distance`, `angle`, \
         `rotation` and `displacement`: on a length works a force, on an angle a torque, positive where the quantity grows. The word begins \
         a declaration only where one begins, and is a name elsewhere.",
        Example::Arm(
            "load spring: -3 N * 1 m * rotation(main) on rotation(main)\nload push:   20 N on x(arm.tip)\nmeasure torque = effort(motor)",
        ),
    ),
    keyword(
        Role::Declaration,
        "measure",
        &["measure NAME = FORMULA", "measure NAME = FORMULA in UNIT"],
        "a number that is printed for every time, with its first two derivatives where it has them",
        "Over kinematic quantities, params, functions, tables, other measures, `t` and `der(…)`. It is printed in SI, or in the unit \
         behind `in`; formulas that use it see SI.",
        Example::Arm("measure height = y(arm.tip) in mm\nmeasure speed  = hypot(der(x(arm.tip)), der(y(arm.tip)))"),
    ),
    keyword(
        Role::Opener,
        "trace",
        &["trace NAME = P", "trace NAME = P in UNIT"],
        "the path of a point: the columns `NAME.x` and `NAME.y`, with their first two derivatives",
        "P is a point of a body or the ground, `body.P`, or two lengths `(x, y)` as formulas of a measure. The word begins a \
         declaration only where one begins, and is a name elsewhere.",
        Example::Arm("trace path = arm.tip in mm"),
    ),
    keyword(
        Role::Opener,
        "result",
        &["result NAME = FORMULA", "result NAME = FORMULA in UNIT"],
        "one number for the whole analysis",
        "Over `max(e)`, `min(e)`, `argmax(e)`, `argmin(e)`, `mean(e)`, `rms(e)`, `integral(e)`, `first(e)`, `last(e)` and `at(e, T)`, where \
         e is a formula of a measure, and over params, functions, tables and other results. `mechc run` tells it, and \
         `--results OUT.json` writes it. It depends on no output step. The word begins a declaration only where one begins, \
         and is a name elsewhere.",
        Example::Arm(
            "result reach = max(x(arm.tip)) - min(x(arm.tip)) in mm\nresult when  = argmax(y(arm.tip))\nanalysis from 0 s to 1 s every 10 ms",
        ),
    ),
    keyword(
        Role::Opener,
        "require",
        &["require A <= FORMULA <= B", "require FORMULA == F within D", "require NAME: FORMULA <= B"],
        "a bound that must hold",
        "Over results and reductions, which are one number, or over measures and quantities, and then at all times of the analysis; not \
         over both. `mechc run` judges it, and says what the value is and, of quantities, at which time it first fails; the exit code is \
         1 then. Times at which a formula has no value do not count. The word begins a declaration only where one begins, and is a \
         name elsewhere.",
        Example::Arm(
            "result reach = max(x(arm.tip))\nrequire reach <= 101 mm\nrequire 99 mm <= distance(ground.O, arm.tip) <= 101 mm\n\
             analysis from 0 s to 1 s every 10 ms",
        ),
    ),
    keyword(
        Role::Opener,
        "input",
        &["input NAME = FORMULA"],
        "a signal that comes from outside, as from an encoder",
        "The formula, of `t`, params, functions and tables, is what it is when nobody says otherwise, and gives it its dimension; \
         `--input NAME=FORMULA` and `--samples FILE.csv` say otherwise. It may stand wherever `t` may.",
        Example::Whole(
            "\
input turn = 30 deg * sin(1 rev/s * t)
ground { point O = (0, 0) }
body arm { point O = (0, 0) }
joint pivot: revolute(ground.O, arm.O)
driver motor: rotation(pivot) = turn",
        ),
    ),
    keyword(
        Role::Opener,
        "part",
        &["part NAME: MECHANISM(BINDING, …)", "part NAME: MECHANISM(BINDING, …) on BODY at (x, y, phi) mirrored"],
        "the declarations of another mechanism, once more, under a name",
        "A binding `NAME = FORMULA` says what a param or input of it is. What is its ground is fixed on the body, the ground if none is \
         named, at a place in that body's frame. Everything in it is reached by its path: `NAME.crank.pin`, `NAME.stroke`.",
        TWO_LEVERS,
    ),
    keyword(
        Role::Declaration,
        "analysis",
        &["analysis from A to B every H"],
        "the times for which `mechc run` prints rows",
        "Three times; `--from --to --every` on the command line stand over it.",
        Example::Arm("analysis from 0 s to 2 s every 10 ms"),
    ),
    keyword(
        Role::Formula,
        "if",
        &["if CONDITION then A else B"],
        "one formula or another",
        "Both have the same dimension. Inside an operator it needs parentheses: `2 * (if t < 1 s then 0 else 1)`. Where a formula of \
         time jumps there is no motion; where its slope jumps no acceleration.",
        Example::Arm("driver motor: rotation(main) = if t < 1 s then 0 else 30 deg/s^2 * (t - 1 s)^2"),
    ),
    keyword(
        Role::Formula,
        "then",
        &["if CONDITION then A else B"],
        "stands before what counts if the condition holds",
        "",
        Example::Arm("driver motor: rotation(main) = if t < 1 s then 0 else 30 deg/s^2 * (t - 1 s)^2"),
    ),
    keyword(
        Role::Formula,
        "else",
        &["if CONDITION then A else B", "if CONDITION then A else if CONDITION then B else C"],
        "stands before what counts if the condition does not hold",
        "",
        Example::Arm("driver motor: rotation(main) = if t < 1 s then 0 else 30 deg/s^2 * (t - 1 s)^2"),
    ),
    keyword(
        Role::Formula,
        "and",
        &["CONDITION and CONDITION"],
        "whether both conditions hold",
        "Between `if` and `then`. It binds tighter than `or`.",
        Example::Arm("measure inside = if x(arm.tip) > 0 and y(arm.tip) > 0 then 1 else 0"),
    ),
    keyword(
        Role::Formula,
        "or",
        &["CONDITION or CONDITION"],
        "whether one of two conditions holds",
        "Between `if` and `then`.",
        Example::Arm("measure outside = if x(arm.tip) < 0 or y(arm.tip) < 0 then 1 else 0"),
    ),
    keyword(
        Role::Formula,
        "not",
        &["not CONDITION"],
        "whether a condition does not hold",
        "Between `if` and `then`.",
        Example::Arm("measure outside = if not (x(arm.tip) > 0 and y(arm.tip) > 0) then 1 else 0"),
    ),
    keyword(
        Role::Separator,
        "to",
        &["axis a = P to Q", "analysis from A to B every H", "max(e, from A to B)"],
        "stands before the second point of an axis, and the last time of an analysis or of the window of a reduction",
        WINDOW_WORDS,
        Example::Arm("analysis from 0 s to 2 s every 10 ms"),
    ),
    keyword(
        Role::Separator,
        "every",
        &["analysis from A to B every H"],
        "stands before the time from one row to the next",
        "It is positive.",
        Example::Arm("analysis from 0 s to 2 s every 10 ms"),
    ),
    keyword(
        Role::Separator,
        "within",
        &["require FORMULA == F within D"],
        "stands before the tolerance of an equality that is required",
        "It is not negative.",
        Example::Arm("require distance(ground.O, arm.tip) == 100 mm within 1 um\nanalysis from 0 s to 1 s every 10 ms"),
    ),
    keyword(
        Role::Separator,
        "along",
        &["along (dx, dy)"],
        "stands before the direction of an axis",
        "Its length does not count.",
        Example::Of("translational"),
    ),
    keyword(
        Role::Separator,
        "at",
        &["at (x, y, phi)", "at (P, phi)", "at P toward Q"],
        "stands before the pose of a body, or the estimate of a curve's argument",
        "The pose of `body NAME at (x, y, phi)` is two lengths and an angle, or a point and an angle: where the assembly begins to look \
         for the body. Gears and racks mesh as they stand there.",
        Example::Of("weld"),
    ),
    keyword(
        Role::Separator,
        "toward",
        &["body NAME at P toward Q { … }"],
        "stands before the point that a body's x axis goes to as it is drawn",
        "The body's frame begins at P, and its angle is `direction(P, Q)`. The two points do not coincide.",
        Example::Whole(
            "\
param A     = (20 mm, 10 mm)
param B     = (60 mm, 40 mm)
param reach = length(A, B)
ground {
    point A
}
body crank at A toward B {
    point A   = (0, 0)
    point pin = (reach, 0)
}
joint main: revolute(ground.A, crank.A)
driver motor: rotation(main) = direction(A, B) + 90 deg/s * t",
        ),
    ),
    keyword(
        Role::Separator,
        "radius",
        &["circle c = P radius r"],
        "stands before the radius of a circle",
        "",
        Example::Of("gear"),
    ),
    keyword(
        Role::Separator,
        "inertia",
        &["mass M at P inertia I"],
        "stands before the moment of inertia of a mass, about the centre of that mass",
        "It is 0 if it is not given.",
        WEIGHING,
    ),
    keyword(
        Role::Separator,
        "from",
        &["analysis from A to B every H", "max(e, from A to B)"],
        "stands before the first time of an analysis, or of the window of a reduction",
        WINDOW_WORDS,
        Example::Arm("analysis from 0 s to 2 s every 10 ms"),
    ),
    keyword(
        Role::Separator,
        "on",
        &["part NAME: MECHANISM(…) on BODY", "load NAME: FORMULA on QUANTITY"],
        "stands before the body that carries a part, and before what a load works on",
        "Any body, by its path: `on front.arm`. What is ground in the part is fixed on it. A load works on one kinematic quantity of \
         positions, and its virtual work is the product of both.",
        TWO_LEVERS,
    ),
    keyword(
        Role::Place,
        "spline",
        &["table NAME = spline [(u0, v0), (u1, v1), …]", "table NAME = spline \"FILE.csv\" (UNIT, UNIT)"],
        "stands before the rows or the file of a table",
        "",
        Example::Arm(
            "table swing = spline [(0 s, 0 deg), (1 s, 30 deg), (2 s, 20 deg)]\ndriver motor: rotation(main) = swing(t)",
        ),
    ),
    keyword(
        Role::Place,
        "in",
        &["measure NAME = FORMULA in UNIT", "trace NAME = P in UNIT", "result NAME = FORMULA in UNIT"],
        "stands before the unit in which a measure, trace or result is printed",
        "Units with powers, joined by `*` and `/`: `in mm/s^2`. The columns of the derivatives are in that unit per second. Formulas \
         and emitted code see SI. Behind a number `in` is the inch, unless a unit follows it.",
        Example::Arm("measure height = y(arm.tip) / 2 in mm\nmeasure tilt   = rotation(main) in deg"),
    ),
    keyword(
        Role::Place,
        "mirrored",
        &["part NAME: MECHANISM(…) mirrored"],
        "turns y of a part's frame over, before it is placed",
        "What the part measures is the same as without it.",
        TWO_LEVERS,
    ),
    keyword(
        Role::Place,
        "as",
        &["use \"FILE.mech\" as PREFIX"],
        "stands before the prefix that the mechanisms of a used file have",
        "Two files that hold mechanisms of one name can both be used, one of them at least with a prefix.",
        Example::Arm("// at the top of the file: use \"legs.mech\" as walkers\nmeasure reach = x(arm.tip)"),
    ),
    keyword(
        Role::Place,
        "columns",
        &["spline \"FILE.csv\" columns 1, 3 (UNIT, UNIT)", "spline \"FILE.csv\" columns \"NAME\", \"NAME\""],
        "stands before the two columns of a file that a table takes",
        "By their numbers, from 1, or by the names that the file's header line gives them; a file may have others beside them.",
        Example::Arm(
            "// with a file: table swing = spline \"log.csv\" columns 1, 3 (s, deg)\n\
             table swing = spline [(0 s, 0 deg), (1 s, 30 deg), (2 s, 20 deg)]\ndriver motor: rotation(main) = swing(t)",
        ),
    ),
    keyword(
        Role::Place,
        "periodic",
        &["table NAME = periodic spline [(u0, v0), (u1, v1), …]"],
        "a table that repeats",
        "Its last row has the value of the first, one period on.",
        Example::Arm(
            "table swing = periodic spline [(0 s, 0 deg), (1 s, 30 deg), (2 s, 0 deg)]\n\
         driver motor: rotation(main) = swing(t)",
        ),
    ),
    keyword(
        Role::Side,
        "left",
        &["rack_pinion(c, a, phase, left)"],
        "the pinion lies to the left of the axis, seen along it",
        "",
        ON_THE_LEFT,
    ),
    keyword(
        Role::Side,
        "right",
        &["rack_pinion(c, a, phase, right)"],
        "the pinion lies to the right of the axis, seen along it",
        "",
        ON_THE_RIGHT,
    ),
    keyword(
        Role::Side,
        "crossed",
        &["belt(c, d, crossed)"],
        "the belt crosses itself between its pulleys, which turn against each other",
        "",
        Example::Of("belt"),
    ),
];

#[cfg(test)]
mod tests {
    use super::{KEYWORDS, Keyword, LONGEST};

    #[test]
    fn every_keyword_is_found_by_its_name() {
        assert_eq!(KEYWORDS.iter().map(|keyword| keyword.word.name.len()).max(), Some(LONGEST));
        for keyword in KEYWORDS {
            assert!(Keyword::named(keyword.word.name).is_some(), "{}", keyword.word.name);
        }
    }
}
