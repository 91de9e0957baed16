//! Synonyms: words of other programs and of textbooks, with their equivalents in the language.

use Position::{Call, Declaration, Joint, Number, Unit};

/// Foreign words with one meaning.
#[derive(Debug)]
pub struct Synonym {
    /// Position in a text.
    pub position: Position,
    /// Words in lower case, with spaces between them.
    names: &'static str,
    /// Equivalent words of the language, with spaces between them.
    means: &'static str,
    /// True if the word is an exact equivalent, without a formula around it.
    pub is_same: bool,
    /// Message with the equivalent; empty for "was `WORD` meant?". `{0 a}` is the first argument as written, or `a` if there is none;
    /// `{0 (a)}` is the argument as an operand, with parentheses where necessary, `{0 deg}` a number of degrees, and `{2 ?}` one more
    /// argument, if it exists.
    message: &'static str,
}

/// Position of a word in a text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Position {
    /// Beginning of a declaration.
    Declaration,
    /// Kind of a joint.
    Joint,
    /// Called in a formula.
    Call,
    /// Unit, after a number.
    Unit,
    /// Number in a formula.
    Number,
}

/// Returns whether a foreign word means the ground.
#[must_use]
pub fn is_ground(word: &str) -> bool {
    Synonym::of(Declaration, word).is_some_and(|synonym| synonym.means == "ground")
}

impl Synonym {
    /// Returns the synonym for a word in a position, in upper or lower case; `prismatic_joint` is `prismatic`.
    #[must_use]
    pub fn of(position: Position, word: &str) -> Option<&'static Synonym> {
        let word = word.to_lowercase();
        SYNONYMS.iter().find(|synonym| synonym.position == position && synonym.stands_for(&word))
    }

    /// Returns the synonyms for a word in any position.
    pub fn all_of(word: &str) -> impl Iterator<Item = &'static Synonym> {
        let word = word.to_lowercase();
        SYNONYMS.iter().filter(move |synonym| synonym.stands_for(&word))
    }

    fn stands_for(&self, word: &str) -> bool {
        let stem = word.strip_suffix("joint").filter(|_| self.position == Joint);
        let word = stem.map_or(word, |stem| stem.trim_end_matches('_'));
        self.names().any(|name| name == word)
    }

    /// Returns the foreign words that are exact equivalents of a word of the language.
    pub fn names_for(word: &str) -> impl Iterator<Item = &'static str> {
        let is_one = move |synonym: &&Synonym| synonym.is_same && synonym.means().any(|meaning| meaning == word);
        SYNONYMS.iter().filter(is_one).flat_map(Synonym::names)
    }

    /// Returns the foreign words.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.names.split_whitespace()
    }

    /// Returns the equivalent words of the language.
    pub fn means(&self) -> impl Iterator<Item = &'static str> {
        self.means.split_whitespace()
    }

    /// Returns the word of the language that may replace the foreign one.
    #[must_use]
    pub fn equivalent(&self) -> Option<&'static str> {
        (self.is_same && self.means().count() == 1).then_some(self.means)
    }

    /// Returns the message for arguments as written.
    #[must_use]
    pub fn message(&self, arguments: &[&str]) -> String {
        if self.message.is_empty() {
            return format!("was `{}` meant?", self.means);
        }
        // long arguments would hide the message
        let is_short = arguments.iter().all(|text| text.chars().count() <= LONGEST_ARGUMENT && !text.contains('\n'));
        let arguments = if is_short { arguments } else { &[] };
        let mut pieces = self.message.split(['{', '}']);
        let mut text = pieces.next().unwrap_or_default().to_owned();
        while let (Some(gap), Some(after)) = (pieces.next(), pieces.next()) {
            text += &fill(gap, arguments);
            text += after;
        }
        text
    }
}

/// Length limit of arguments that a message repeats (characters).
const LONGEST_ARGUMENT: usize = 30;

fn fill(gap: &str, arguments: &[&str]) -> String {
    let (number, name) = gap.split_once(' ').unwrap_or((gap, ""));
    let argument = number.parse().ok().and_then(|k: usize| arguments.get(k)).copied();
    let as_operand = |text: &str| {
        let is_one = text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        if is_one { text.to_owned() } else { format!("({text})") }
    };
    match (name, argument) {
        ("?", argument) => argument.map_or(String::new(), |text| format!(", {text}")),
        ("deg", None) => "30 deg".to_owned(),
        ("deg", Some(text)) if text.parse::<f64>().is_ok() => format!("{text} deg"),
        ("deg", Some(text)) => format!("{} * 1 deg", as_operand(text)),
        (name, None) => name.trim_matches(['(', ')']).to_owned(),
        (name, Some(text)) if name.starts_with('(') => as_operand(text),
        (_, Some(text)) => text.to_owned(),
    }
}

/// Creates a synonym that is an exact equivalent.
const fn same(position: Position, names: &'static str, means: &'static str, message: &'static str) -> Synonym {
    Synonym { position, names, means, is_same: true, message }
}

/// Creates a synonym that may replace the word without a further explanation.
const fn word(position: Position, names: &'static str, means: &'static str) -> Synonym {
    same(position, names, means, "")
}

/// Creates a synonym that needs a formula or more than one word.
const fn formula(position: Position, names: &'static str, means: &'static str, message: &'static str) -> Synonym {
    Synonym { is_same: false, ..same(position, names, means, message) }
}

/// All synonyms.
#[rustfmt::skip]
pub static SYNONYMS: &[Synonym] = &[
    // joints
    same(Joint, "pin hinge pivot rotary rotational turning bearing coincident spherical ball", "revolute", "two points that coincide, as in a pin, are `revolute({0 P}, {1 Q})`"),
    same(Joint, "prismatic slider slide sliding linear guide rail cylindrical piston translation", "translational", "a body that slides on another is joined by `translational(a, b)`, of an axis on each"),
    same(Joint, "fixed rigid fix lock locked glue welded clamp bolted", "weld", "bodies that cannot move against each other are joined by `weld({0 P}, {1 Q}{2 ?})`, of a point on each"),
    same(Joint, "slot pin_slot pin_in_slot slotted point_on_line point_line inline", "revolute_translational", "a pin in a slot is `revolute_translational(P, a)`, P the pin's point and a the slot's axis"),
    same(Joint, "link rod bar strut distance fixed_distance massless_link", "revolute_revolute", "a link with a pin at both ends is `revolute_revolute({0 P}, {1 Q}, {2 length})`"),
    same(Joint, "gears spur spur_gear gear_pair external_gear mesh friction_wheel", "gear", "two wheels that roll on each other are `gear(c, d)`, of a circle on each"),
    same(Joint, "ring_gear annulus internal inner_gear gear_internal", "internal_gear", "a wheel in a ring is `internal_gear(c, d)`, of a circle on each"),
    same(Joint, "rack rack_and_pinion pinion pinion_rack rolling", "rack_pinion", "a wheel that rolls on a straight line is `rack_pinion(c, a)`, of a circle and an axis"),
    same(Joint, "follower knife_edge point_on_curve point_curve pin_on_curve curve_slot", "point_follower", "a point on a curve is `point_follower(P, k)`"),
    same(Joint, "cam_follower roller roller_follower curve_curve cam_cam tangent", "cam", "two curves that touch are `cam(k, m)`; a roller is a `circle`"),
    same(Joint, "flat flat_face flat_faced_follower mushroom tappet", "flat_follower", "a curve under a flat face is `flat_follower(k, a)`, a the axis of the face"),
    formula(Joint, "contact touch", "point_follower cam flat_follower", "a contact is `point_follower(P, k)`, `cam(k, m)` or `flat_follower(k, a)`"),
    same(Joint, "chain pulley pulleys timing_belt toothed_belt belt_drive chain_drive sprocket", "belt", "a belt or chain around two wheels is `belt(c, d)`, of a circle on each"),
    formula(Joint, "coupler ratio transmission", "constraint", "two rotations are coupled by an equation: `constraint ratio: rotation(a) = 2 * rotation(b)`, a and b revolute joints"),
    formula(Joint, "parallel", "constraint", "bodies that stay parallel are an equation: `constraint parallel: angle(b, c) = 0`"),
    formula(Joint, "perpendicular", "constraint", "bodies that stay perpendicular are an equation: `constraint perpendicular: angle(b, c) = 90 deg`"),
    formula(Joint, "motor actuator rotation displacement", "driver", "what a motor prescribes is a driver: `driver motor: rotation(joint) = 60 rpm * t`"),
    // quantities
    formula(Call, "velocity vel", "der", "a velocity is the time derivative of a place, in a measure: `der(x({0 P}))`, `der(y({0 P}))`"),
    formula(Call, "acceleration acc accel", "der", "an acceleration is the second time derivative of a place, in a measure: `der(der(x({0 P})))`, `der(der(y({0 P})))`"),
    formula(Call, "vx v_x velx vel_x xdot x_dot", "der", "the velocity of a point along x is `der(x({0 P}))`, in a measure"),
    formula(Call, "vy v_y vely vel_y ydot y_dot", "der", "the velocity of a point along y is `der(y({0 P}))`, in a measure"),
    formula(Call, "ax a_x accx acc_x xddot", "der", "the acceleration of a point along x is `der(der(x({0 P})))`, in a measure"),
    formula(Call, "ay a_y accy acc_y yddot", "der", "the acceleration of a point along y is `der(der(y({0 P})))`, in a measure"),
    formula(Call, "position pos location place coordinates", "x y", "the place of a point is `x({0 P})` and `y({0 P})`"),
    formula(Call, "reaction reaction_force joint_force bearing_force force", "force_x force_y", "what a joint exerts is `force_x({0 J})` and `force_y({0 J})`"),
    same(Call, "fx reaction_x", "force_x", "what a joint exerts along x is `force_x({0 J})`"),
    same(Call, "fy reaction_y", "force_y", "what a joint exerts along y is `force_y({0 J})`"),
    same(Call, "moment reaction_torque reaction_moment", "torque", "the moment that a joint exerts is `torque({0 J})`"),
    same(Call, "motor_torque drive_torque driving_torque actuator_force driving_force multiplier lambda", "effort", "what a driver or constraint supplies is `effort({0 D})`"),
    same(Call, "xpos pos_x x_position posx", "x", "the x coordinate of a point is `x({0 P})`"),
    same(Call, "ypos pos_y y_position posy height", "y", "the y coordinate of a point is `y({0 P})`"),
    same(Call, "dist separation gap norm", "distance", "how far two points are apart is `distance({0 P}, {1 Q})`"),
    same(Call, "theta phi orientation heading angle_of attitude", "angle", "the angle of a body or axis is `angle({0 b})`, that of a revolute joint `rotation(joint)`"),
    same(Call, "rot rotate joint_angle revolution turns", "rotation", "the angle of a revolute joint is `rotation({0 joint})`, that of a body `angle(b)`"),
    formula(Call, "omega angular_velocity angvel ang_vel turning_speed", "der", "an angular velocity is the time derivative of an angle, in a measure: `der(angle({0 b}))`"),
    formula(Call, "alpha angular_acceleration angacc", "der", "an angular acceleration is the second time derivative of an angle, in a measure: `der(der(angle({0 b})))`"),
    same(Call, "translation travel stroke slide extension disp", "displacement", "how far a translational joint has moved is `displacement({0 joint})`"),
    same(Call, "d deriv derivative diff ddt d_dt dot rate", "der", "the time derivative is `der({0 e})`, in a measure"),
    formula(Call, "ddot der2 diff2", "der", "the second time derivative is `der(der({0 e}))`, in a measure"),
    // powers, roots, logarithms
    formula(Call, "sqr square", "", "a square is written `{0 (a)}^2`"),
    formula(Call, "cube", "", "a cube is written `{0 (a)}^3`"),
    formula(Call, "pow", "", "a power is written `{0 (a)} ^ {1 (b)}`"),
    formula(Call, "power", "", "a power is written `{0 (a)} ^ {1 (b)}`; that of a driver is its `effort` times a `der`"),
    formula(Call, "cbrt curt cuberoot", "", "a cube root is `{0 (a)}^(1/3)`, where that is not negative"),
    formula(Call, "root nthroot", "", "a root is a power: `{0 (a)}^(1/{1 (n)})`, where the first is not negative"),
    same(Call, "squareroot square_root", "sqrt", "a square root is `sqrt({0 a})`"),
    same(Call, "log", "ln log10", "was `ln` (natural) or `log10` meant?"),
    same(Call, "loge logn", "ln", "the natural logarithm is `ln({0 a})`"),
    same(Call, "lg", "log10", "the logarithm to the base 10 is `log10({0 a})`"),
    formula(Call, "log2 ld", "ln", "the logarithm to the base 2 is `ln({0 a}) / ln(2)`"),
    formula(Call, "log1p", "ln", "it is written `ln(1 + {0 a})`"),
    formula(Call, "expm1", "exp", "it is written `exp({0 a}) - 1`"),
    formula(Call, "exp10", "", "a power of ten is written `10^{0 (a)}`"),
    formula(Call, "exp2", "", "a power of two is written `2^{0 (a)}`"),
    // angles
    formula(Call, "sind sindeg sin_deg", "sin", "angles are in radians, or have a unit: `sin({0 deg})`"),
    formula(Call, "cosd cosdeg cos_deg", "cos", "angles are in radians, or have a unit: `cos({0 deg})`"),
    formula(Call, "tand tandeg tan_deg", "tan", "angles are in radians, or have a unit: `tan({0 deg})`"),
    formula(Call, "asind", "asin", "`asin({0 a})` is an angle; its number of degrees is `asin({0 a}) / 1 deg`"),
    formula(Call, "acosd", "acos", "`acos({0 a})` is an angle; its number of degrees is `acos({0 a}) / 1 deg`"),
    formula(Call, "atand", "atan", "`atan({0 a})` is an angle; its number of degrees is `atan({0 a}) / 1 deg`"),
    formula(Call, "atan2d", "atan2", "`atan2({0 y}, {1 x})` is an angle; its number of degrees is `atan2({0 y}, {1 x}) / 1 deg`"),
    word(Call, "arcsin arsin", "asin"),
    word(Call, "arccos arcos", "acos"),
    word(Call, "arctan arctg artan", "atan"),
    word(Call, "arctan2 arctg2", "atan2"),
    same(Call, "tg", "tan", "the tangent is `tan({0 a})`"),
    formula(Call, "cot ctg cotan", "tan", "the cotangent is `1 / tan({0 a})`"),
    formula(Call, "sec", "cos", "the secant is `1 / cos({0 a})`"),
    formula(Call, "csc cosec", "sin", "the cosecant is `1 / sin({0 a})`"),
    formula(Call, "cotd", "tan", "angles are in radians, or have a unit: `1 / tan({0 deg})`"),
    formula(Call, "secd", "cos", "angles are in radians, or have a unit: `1 / cos({0 deg})`"),
    formula(Call, "cscd", "sin", "angles are in radians, or have a unit: `1 / sin({0 deg})`"),
    formula(Call, "acot arccot", "atan2", "the arc cotangent, from 0 to pi, is `atan2(1, {0 a})`"),
    formula(Call, "asec arcsec", "acos", "the arc secant is `acos(1 / {0 (a)})`"),
    formula(Call, "acsc arccsc", "asin", "the arc cosecant is `asin(1 / {0 (a)})`"),
    formula(Call, "coth", "tanh", "the hyperbolic cotangent is `1 / tanh({0 a})`"),
    formula(Call, "sech", "cosh", "the hyperbolic secant is `1 / cosh({0 a})`"),
    formula(Call, "csch", "sinh", "the hyperbolic cosecant is `1 / sinh({0 a})`"),
    formula(Call, "asinh arsinh arcsinh", "ln sqrt", "the inverse of `sinh` is `ln({0 (a)} + sqrt({0 (a)}^2 + 1))`"),
    formula(Call, "acosh arcosh arccosh", "ln sqrt", "the inverse of `cosh` is `ln({0 (a)} + sqrt({0 (a)}^2 - 1))`"),
    formula(Call, "atanh artanh arctanh", "ln", "the inverse of `tanh` is `ln((1 + {0 (a)}) / (1 - {0 (a)})) / 2`"),
    formula(Call, "radians deg2rad torad to_rad to_radians", "deg", "an angle in degrees is written with its unit: `{0 deg}`"),
    formula(Call, "degrees rad2deg todeg to_deg to_degrees", "deg", "the number of degrees of an angle is `{0 (a)} / 1 deg`"),
    // whole numbers, signs, choices
    formula(Call, "floor", "mod", "the language has no `floor`: use `{0 (a)} - mod({0 a}, 1)`"),
    formula(Call, "ceil ceiling", "mod", "the language has no `ceil`: use `{0 (a)} + mod(-{0 (a)}, 1)`"),
    formula(Call, "round rint nint", "mod", "the language has no `round`: use `{0 (a)} + 0.5 - mod({0 (a)} + 0.5, 1)`"),
    formula(Call, "trunc fix int integer", "mod", "the language has no `trunc`: use `sign({0 a}) * (abs({0 a}) - mod(abs({0 a}), 1))`"),
    formula(Call, "frac fract", "mod", "what is behind the point is `mod({0 a}, 1)`"),
    formula(Call, "rem fmod remainder", "mod", "`mod({0 a}, {1 b})` has the sign of the second; with that of the first: `sign({0 a}) * mod(abs({0 a}), abs({1 b}))`"),
    same(Call, "modulo modulus", "mod", "it is written `mod({0 a}, {1 b})`"),
    same(Call, "sgn signum copysign", "sign", "the sign of a number is `sign({0 a})`"),
    same(Call, "fabs absolute magnitude mag", "abs", "the absolute value is `abs({0 a})`"),
    same(Call, "minimum least fmin", "min", "over the motion, in a `result`, the least is `min({0 a})`; of two it is `min({0 a}, {1 b})`"),
    same(Call, "maximum largest fmax", "max", "over the motion, in a `result`, the largest is `max({0 a})`; of two it is `max({0 a}, {1 b})`"),
    same(Call, "average avg", "mean", "the average over the motion is `mean({0 a})`, in a `result`"),
    formula(Call, "std stdev stddev deviation", "rms mean", "the standard deviation over the motion is `rms({0 (a)} - mean({0 a}))`, in a `result`"),
    formula(Call, "clamp clip limit saturate sat", "min max", "between two limits it is `max({1 low}, min({2 high}, {0 a}))`"),
    formula(Call, "heaviside unitstep unit_step", "if", "a jump is written `if {0 t} < 0 then 0 else 1`; a smooth rise is `step5(u, u0, v0, u1, v1)`"),
    same(Call, "iif ifelse select piecewise cond ite", "if", "a choice is written `if t < 1 s then 0 else 1`"),
    formula(Call, "jerk", "der", "a jerk is a third time derivative, in a measure: `der(der(der(x({0 P}))))`"),
    // motions and tables
    same(Call, "smoothstep step3 havsin haversine cubic", "step", "a cubic rise is `step(u, u0, v0, u1, v1)`"),
    same(Call, "poly345 step345 poly_345 quintic smootherstep minjerk minimum_jerk", "step5", "the 3-4-5 polynomial is `step5(u, u0, v0, u1, v1)`"),
    same(Call, "poly4567 step4567 poly_4567 septic", "step7", "the 4-5-6-7 polynomial is `step7(u, u0, v0, u1, v1)`"),
    same(Call, "shm simple_harmonic cosine_rise", "harmonic", "half a wave of the cosine is `harmonic(u, u0, v0, u1, v1)`"),
    same(Call, "cycloid bestehorn", "cycloidal", "the cycloid is `cycloidal(u, u0, v0, u1, v1)`"),
    same(Call, "modified_sine mod_sine neklutin", "modsine", "the modified sine is `modsine(u, u0, v0, u1, v1)`"),
    same(Call, "polynomial polyval", "poly", "a polynomial of u - u0 is `poly(u, u0, c0, c1)`, with as many as it has"),
    same(Call, "interp interp1 interpolate lookup spline akispl cubspl akima", "table", "a curve through points is a table, called by its name: `table lift = spline [(0, 0), (1, 2)]`"),
    // units
    formula(Unit, "min minute minutes", "rpm", "minutes are no unit; `rev/min` is `rpm`, `1 min` is `60 s`"),
    formula(Unit, "h hour hours hr", "s", "hours are no unit; `1 h` is `3600 s`"),
    word(Unit, "degree degrees °", "deg"),
    word(Unit, "radian radians", "rad"),
    word(Unit, "rot rots turn turns revolution revolutions cycle cycles", "rev"),
    word(Unit, "sec second seconds", "s"),
    word(Unit, "msec millisecond milliseconds", "ms"),
    word(Unit, "usec microsecond microseconds", "us"),
    word(Unit, "meter meters metre metres", "m"),
    word(Unit, "millimeter millimeters millimetre millimetres", "mm"),
    word(Unit, "centimeter centimeters centimetre centimetres", "cm"),
    word(Unit, "micron microns micrometer micrometre", "um"),
    word(Unit, "inch inches", "in"),
    word(Unit, "foot feet", "ft"),
    formula(Unit, "rps", "rev", "revolutions per second are `rev/s`"),
    word(Unit, "hertz", "Hz"),
    word(Unit, "u/min upm rev_min revpm", "rpm"),
    formula(Unit, "dm", "m", "decimetres are no unit; `1 dm` is `0.1 m`"),
    formula(Unit, "nm", "N m", "newton metres are `N*m`; `1 nm` is `1e-9 m`"),
    formula(Unit, "knm", "kN m", "kilonewton metres are `kN*m`"),
    formula(Unit, "g gram grams gramme", "kg", "grams are no unit; `1 g` is `0.001 kg`"),
    formula(Unit, "t tonne tonnes ton tons", "kg", "tonnes are no unit; `1 t` is `1000 kg`"),
    word(Unit, "kilogram kilograms kilo kgs", "kg"),
    formula(Unit, "lb lbs pound pounds", "lbm lbf", "a mass is in `lbm`, a force in `lbf`"),
    word(Unit, "newton newtons", "N"),
    formula(Unit, "kgf kp", "N", "kilograms are no force; `1 kgf` is `9.80665 N`"),
    formula(Unit, "kgm2 kgm² kg·m² kg·m2", "kg m", "a moment of inertia is in `kg*m^2`"),
    formula(Unit, "kgmm2 kgmm² kg·mm² kg·mm2", "kg mm", "a moment of inertia is in `kg*mm^2`"),
    word(Unit, "joule joules", "J"),
    word(Unit, "watt watts", "W"),
    formula(Unit, "hp ps", "kW", "horse powers are no unit; `1 hp` is `0.7457 kW`"),
    word(Unit, "pascal pascals", "Pa"),
    formula(Unit, "psi", "kPa", "pounds per square inch are no unit; `1 psi` is `1 lbf/in^2`, `6.895 kPa`"),
    formula(Unit, "atm mbar", "bar", "`1 atm` is `1.01325 bar`, `1 mbar` is `0.001 bar`"),
    formula(Unit, "khz kilohertz", "Hz", "kilohertz are no unit; `1 kHz` is `1000 Hz`"),
    formula(Unit, "mhz", "Hz", "neither megahertz nor millihertz are a unit; write `1e6 Hz` or `0.001 Hz`"),
    formula(Unit, "urad µrad", "mrad", "microradians are no unit; `1 urad` is `0.001 mrad`"),
    formula(Unit, "kj mj", "J", "write `1000 J` for `1 kJ`"),
    formula(Unit, "mw", "kW", "neither megawatts nor milliwatts are a unit; write `1000 kW` or `0.001 W`"),
    formula(Unit, "gpa", "MPa", "gigapascals are no unit; `1 GPa` is `1000 MPa`"),
    formula(Unit, "mil thou", "in", "thousandths of an inch are no unit; `1 mil` is `0.001 in`"),
    formula(Unit, "yd yard yards", "ft", "yards are no unit; `1 yd` is `3 ft`"),
    formula(Unit, "gon grad", "deg", "gons are no unit; `1 gon` is `0.9 deg`"),
    // names that stand for a number
    formula(Number, "dt", "der", "the time derivative of a formula is `der(…)`, in a measure"),
    word(Number, "time zeit temps tiempo", "t"),
    word(Number, "π 𝜋", "pi"),
    word(Number, "τ two_pi twopi", "tau"),
    // declarations
    word(Declaration, "model assembly system linkage machine", "mechanism"),
    word(Declaration, "parameter const constant let var variable set", "param"),
    word(Declaration, "function def func fun", "fn"),
    word(Declaration, "base frame frame_ground gnd grnd fixed world chassis foundation inertial", "ground"),
    word(Declaration, "link bar rigid_body component element solid", "body"),
    word(Declaration, "marker node vertex", "point"),
    word(Declaration, "line vector direction ray", "axis"),
    word(Declaration, "profile path", "curve"),
    word(Declaration, "wheel disc disk", "circle"),
    word(Declaration, "motor actuator motion drive", "driver"),
    formula(Declaration, "force spring damper sforce applied_force external_force tsda rsda", "load", "a force of which a formula is known is a `load`: `load spring: -k * K on K`"),
    word(Declaration, "grav gravitation", "gravity"),
    formula(Declaration, "weight point_mass pointmass mass_properties", "mass", "what a body weighs is its `mass`, in its braces"),
    word(Declaration, "equation condition coupling", "constraint"),
    word(Declaration, "output plot print sensor request", "measure"),
    word(Declaration, "simulate simulation solve run time", "analysis"),
    word(Declaration, "spline lookup data", "table"),
    same(Declaration, "units unit unitsystem", "", "each number has its own unit: `30 mm`, `60 rpm`"),
];

#[cfg(test)]
mod tests {
    use super::{Position, Synonym};

    #[test]
    fn synonym_arguments_keep_their_spelling() {
        let message = |word: &str, arguments: &[&str]| Synonym::of(Position::Call, word).unwrap().message(arguments);
        assert!(message("sind", &["30"]).ends_with("`sin(30 deg)`"));
        assert!(message("sind", &["2 * t"]).ends_with("`sin((2 * t) * 1 deg)`"));
        assert!(message("sqr", &["a + b"]).ends_with("`(a + b)^2`"));
        assert!(message("SQR", &["a"]).ends_with("`a^2`"));
        assert!(message("floor", &[]).ends_with("`a - mod(a, 1)`"));
        assert!(message("floor", &["a_very_long_name_of_something + another_one"]).ends_with("`a - mod(a, 1)`"));
    }

    #[test]
    fn a_joint_may_say_that_it_is_one() {
        let means = |word: &str| Synonym::of(Position::Joint, word).map(|synonym| synonym.means);
        assert_eq!(means("Prismatic_Joint"), Some("translational"));
        assert_eq!(means("PinJoint"), Some("revolute"));
        assert_eq!(means("revolute"), None);
    }
}
