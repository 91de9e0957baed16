//! Functions of the language, including motion functions.

use super::{Category, Example, Word};

/// A function of numbers.
#[derive(Debug)]
pub struct Function {
    /// Documentation.
    pub word: Word,
    /// Least number of arguments.
    pub least: usize,
    /// Greatest number of arguments.
    pub most: usize,
    /// Rule for the dimensions of the arguments.
    pub group: Group,
    /// True if a function or table of the file with this name replaces it: older texts keep their meaning.
    pub gives_way: bool,
}

/// Rule for the dimensions of a function's arguments.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Group {
    /// The argument and the result are pure numbers.
    Pure,
    /// All arguments have one dimension.
    Alike,
    /// `(u, u0, v0, u1, v1)`: u, u0, u1 of one dimension, v0, v1 of another.
    Motion,
    /// `(u, u0, c0, c1, …)`: `c_k` has the dimension of the result over that of `u^k`.
    Polynomial,
    /// The derivative `der`: by time or, with a second argument, by an input or param.
    Derivative,
    /// Function of points, or a point.
    Points,
}

impl Function {
    /// Returns the function of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Function> {
        FUNCTIONS.iter().find(|function| function.word.name == name)
    }

    /// Returns whether it is a motion function.
    #[must_use]
    pub fn is_motion(&self) -> bool {
        self.word.category == Category::Motion
    }

    /// Returns the number of arguments in words: "two arguments".
    #[must_use]
    pub fn takes(&self) -> String {
        match (self.least, self.most) {
            (1, 1) => "one argument".to_owned(),
            (2, 2) => "two arguments".to_owned(),
            (1, 2) => "one argument or two".to_owned(),
            (least, usize::MAX) => format!("{least} arguments or more"),
            (least, _) => format!("{least} arguments"),
        }
    }
}

const fn word(
    name: &'static str,
    forms: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: &'static str,
) -> Word {
    Word { name, category: Category::Function, forms, letters: "", meaning, more, example: Example::Arm(example) }
}

/// Creates a function of one pure number.
const fn pure(
    name: &'static str,
    forms: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: &'static str,
) -> Function {
    Function {
        word: word(name, forms, meaning, more, example),
        least: 1,
        most: 1,
        group: Group::Pure,
        gives_way: false,
    }
}

/// Creates a function of arguments with one dimension.
const fn alike(least: usize, most: usize, word: Word) -> Function {
    Function { word, least, most, group: Group::Alike, gives_way: false }
}

/// Creates a motion from `v0` at `u0` to `v1` at `u1`.
const fn motion(
    name: &'static str,
    forms: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: &'static str,
) -> Function {
    let word =
        Word { name, category: Category::Motion, forms, letters: "", meaning, more, example: Example::Arm(example) };
    Function { word, least: 5, most: 5, group: Group::Motion, gives_way: false }
}

/// Creates a function of points.
const fn point_function(word: Word) -> Function {
    Function { word, least: 2, most: 2, group: Group::Points, gives_way: true }
}

/// Text for all motion functions except `poly`.
pub const MOTION_NOTES: &str = "With `s = (u − u0)/(u1 − u0)` it is `v0 + (v1 − v0) f(s)`, and flat outside: `v0` before `u0`, `v1` \
                              behind `u1`, which is larger than `u0`. `u`, `u0` and `u1` have one dimension, and `v0` and `v1` \
                              that of the result. `u` may be any formula.";

const TAKES_ANGLE: &str = "The angle is in radians, or has a unit of its own: `30 deg`. Takes and gives a pure number.";
const GIVES_ANGLE: &str = "Takes a pure number and gives an angle in radians.";
const PURE: &str = "Takes and gives a pure number.";

/// All functions.
pub static FUNCTIONS: &[Function] = &[
    pure(
        "sin",
        &["sin(a)"],
        "the sine of an angle",
        TAKES_ANGLE,
        "driver motor: rotation(main) = 30 deg * sin(2 rad/s * t)",
    ),
    pure(
        "cos",
        &["cos(a)"],
        "the cosine of an angle",
        TAKES_ANGLE,
        "driver motor: rotation(main) = 30 deg * cos(2 rad/s * t)",
    ),
    pure(
        "tan",
        &["tan(a)"],
        "the tangent of an angle",
        TAKES_ANGLE,
        "param  slope  = tan(15 deg)\nmeasure height = y(arm.tip) - slope * x(arm.tip)",
    ),
    pure(
        "asin",
        &["asin(a)"],
        "the angle whose sine is a, from −π/2 to π/2",
        GIVES_ANGLE,
        "measure lean = asin(y(arm.tip) / 200 mm)",
    ),
    pure(
        "acos",
        &["acos(a)"],
        "the angle whose cosine is a, from 0 to π",
        GIVES_ANGLE,
        "measure lean = acos(x(arm.tip) / 200 mm)",
    ),
    pure(
        "atan",
        &["atan(a)"],
        "the angle whose tangent is a, from −π/2 to π/2",
        "Takes a pure number and gives an angle in radians. Of two lengths, in all four quadrants, it is `atan2`.",
        "measure lean = atan(y(arm.tip) / 200 mm)",
    ),
    alike(
        2,
        2,
        word(
            "atan2",
            &["atan2(y, x)"],
            "the angle of the direction (x, y), from −π to π",
            "Takes two arguments of one dimension and gives an angle in radians. It jumps where the direction passes −x.",
            "measure bearing = atan2(y(arm.tip), 200 mm + x(arm.tip))",
        ),
    ),
    pure("sinh", &["sinh(a)"], "the hyperbolic sine", PURE, "driver motor: rotation(main) = sinh(0.1 * t)"),
    pure("cosh", &["cosh(a)"], "the hyperbolic cosine", PURE, "driver motor: rotation(main) = cosh(0.1 * t)"),
    pure("tanh", &["tanh(a)"], "the hyperbolic tangent", PURE, "driver motor: rotation(main) = 30 deg * tanh(t / 1 s)"),
    pure(
        "exp",
        &["exp(a)"],
        "e to the power of a",
        PURE,
        "driver motor: rotation(main) = 30 deg * (1 - exp(-t / 1 s))",
    ),
    pure(
        "ln",
        &["ln(a)"],
        "the natural logarithm",
        "Takes a positive pure number and gives a pure number. To the base 10 it is `log10`, to another `ln(a) / ln(b)`.",
        "driver motor: rotation(main) = 30 deg * ln(1 + t / 1 s)",
    ),
    pure(
        "log10",
        &["log10(a)"],
        "the logarithm to the base 10",
        "Takes a positive pure number and gives a pure number.",
        "driver motor: rotation(main) = 30 deg * log10(1 + t / 1 s)",
    ),
    alike(
        1,
        1,
        word(
            "sqrt",
            &["sqrt(a)"],
            "the square root",
            "Takes what is not negative; of an area it is a length. It has no slope at 0.",
            "param side = sqrt((30 mm)^2 + (40 mm)^2)\nmeasure beyond = x(arm.tip) - side",
        ),
    ),
    alike(
        2,
        2,
        word(
            "hypot",
            &["hypot(a, b)"],
            "the square root of a² + b²",
            "Keeps the dimension, which is the same for both. Between two points it is `distance(P, Q)`.",
            "measure speed = hypot(der(x(arm.tip)), der(y(arm.tip)))",
        ),
    ),
    alike(
        1,
        1,
        word(
            "abs",
            &["abs(a)"],
            "the absolute value",
            "Keeps the dimension. Its slope jumps at 0.",
            "measure deviation = abs(y(arm.tip))",
        ),
    ),
    alike(
        1,
        1,
        word(
            "sign",
            &["sign(a)"],
            "−1, 0 or 1: the sign of a",
            "Gives a pure number; `sign(0)` is 0. It jumps at 0.",
            "measure side = sign(y(arm.tip))",
        ),
    ),
    alike(
        2,
        usize::MAX,
        word(
            "min",
            &["min(a, b)", "min(a, b, c, …)"],
            "the least of its arguments",
            "Keeps the dimension, which is the same for all. Its slope jumps where two of them meet.",
            "measure lower = min(y(arm.tip), 50 mm)",
        ),
    ),
    alike(
        2,
        usize::MAX,
        word(
            "max",
            &["max(a, b)", "max(a, b, c, …)"],
            "the largest of its arguments",
            "Keeps the dimension, which is the same for all. Its slope jumps where two of them meet.",
            "measure upper = max(y(arm.tip), 0, 20 mm - x(arm.tip))",
        ),
    ),
    alike(
        2,
        2,
        word(
            "mod",
            &["mod(a, b)"],
            "what is left of a when b is taken away as often as it fits",
            "`a − b·⌊a/b⌋`; of a positive b it is from 0 up to b, for a negative a too. Keeps the dimension, which is the same for \
             both. It jumps from b to 0; `a - mod(a, 1)` is a rounded down.",
            "measure in_the_turn = mod(angle(arm), tau)",
        ),
    ),
    Function {
        word: word(
            "der",
            &["der(e)", "der(e, NAME)"],
            "the time derivative of e, along the motion; or its derivative by an input or param",
            "It stands in measures, in results, and by time in loads. By time it may be nested up to the third derivative, the jerk: `der(der(der(x(P))))`. By an \
             input it is the velocity ratio, `der(rotation(rocker), turn)`, by a param the sensitivity, `der(x(P), crank_length)`; two \
             of these may be nested, with up to two by time. Divides the dimension by that of what it is taken by.",
            "measure speed = hypot(der(x(arm.tip)), der(y(arm.tip)))",
        ),
        least: 1,
        most: 2,
        group: Group::Derivative,
        gives_way: false,
    },
    point_function(word(
        "polar",
        &["polar(r, angle)"],
        "the point at a distance r from the origin, in the direction of an angle",
        "`(r * cos(angle), r * sin(angle))`. Added to a point it leads away from there: `A + polar(20 mm, 30 deg)`.",
        "param handle = polar(40 mm, 30 deg)\nmeasure reach = distance(handle, arm.tip)",
    )),
    point_function(word(
        "mid",
        &["mid(P, Q)"],
        "the point halfway between two points",
        "`(P + Q) / 2`.",
        "param A = (20 mm, 0)\nparam B = (60 mm, 40 mm)\nmeasure reach = distance(mid(A, B), arm.tip)",
    )),
    point_function(word(
        "length",
        &["length(P, Q)"],
        "how far two drawn points are from each other",
        "A length, and a constant: P and Q are formulas of points. Of points that move it is `distance(P, Q)`.",
        "param A = (20 mm, 0)\nparam B = (60 mm, 30 mm)\nmeasure beyond = x(arm.tip) - length(A, B)",
    )),
    point_function(word(
        "direction",
        &["direction(P, Q)"],
        "the angle of the way from one drawn point to another, in (−π, π]",
        "In radians, and a constant: P and Q are formulas of points, and do not coincide. The angle of a body is `angle(b)`.",
        "param A = (20 mm, 0)\nparam B = (60 mm, 40 mm)\ndriver motor: rotation(main) = direction(A, B) + 90 deg/s * t",
    )),
    motion(
        "step",
        &["step(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as a cubic",
        "`f(s) = 3s² − 2s³`. Smooth to: velocity.",
        "driver motor: rotation(main) = step(t, 0 s, 0, 2 s, 90 deg)",
    ),
    motion(
        "step5",
        &["step5(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as a quintic",
        "`f(s) = 10s³ − 15s⁴ + 6s⁵`. Smooth to: acceleration.",
        "driver motor: rotation(main) = step5(t, 0 s, 0, 2 s, 90 deg)",
    ),
    motion(
        "step7",
        &["step7(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as the 4-5-6-7 polynomial",
        "`f(s) = 35s⁴ − 84s⁵ + 70s⁶ − 20s⁷`. Smooth to: jerk.",
        "driver motor: rotation(main) = step7(t, 0 s, 0, 2 s, 90 deg)",
    ),
    motion(
        "harmonic",
        &["harmonic(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as half a wave of the cosine",
        "`f(s) = (1 − cos πs)/2`. Smooth to: velocity.",
        "driver motor: rotation(main) = harmonic(t, 0 s, 0, 2 s, 90 deg)",
    ),
    motion(
        "cycloidal",
        &["cycloidal(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as a cycloid",
        "`f(s) = s − sin(2πs)/(2π)`. Smooth to: acceleration.",
        "driver motor: rotation(main) = cycloidal(t, 0 s, 0, 2 s, 90 deg)",
    ),
    motion(
        "modsine",
        &["modsine(u, u0, v0, u1, v1)"],
        "from v0 at u0 to v1 at u1, as the modified sine",
        "With `k = 1/(4 + π)`: `f(s) = k(πs − sin(4πs)/4)` to s = 1/8, `k(2 + πs − (9/4) sin((π + 4πs)/3))` to 7/8, \
         `k(4 + πs − sin(4πs)/4)` to 1. Smooth to: acceleration.",
        "driver motor: rotation(main) = modsine(t, 0 s, 0, 2 s, 90 deg)",
    ),
    Function {
        word: Word {
            name: "poly",
            category: Category::Motion,
            forms: &["poly(u, u0, c0, c1, …)"],
            letters: "",
            meaning: "a polynomial of u − u0",
            more: "`Σ c_k (u − u0)^k`, with as many coefficients as are given; it goes on beyond any interval. Smooth to: all. `c_k` \
                   has the dimension of the result over that of `u^k`.",
            example: Example::Arm("driver motor: rotation(main) = poly(t, 1 s, 30 deg, 90 deg/s, -10 deg/s^2)"),
        },
        least: 3,
        most: usize::MAX,
        group: Group::Polynomial,
        gives_way: false,
    },
];
