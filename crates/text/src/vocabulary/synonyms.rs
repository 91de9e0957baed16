//! Synonyms: words of other programs and of textbooks, with their equivalents in the language.

/// Foreign words with one meaning.
#[derive(Debug)]
pub struct Synonym {
    /// Position in a text.
    pub position: Position,
    /// Words in lower case.
    pub names: &'static [&'static str],
    /// Equivalent words of the language.
    pub means: &'static [&'static str],
    /// True if the word is an exact equivalent, without a formula around it.
    pub is_same: bool,
    /// Message with the equivalent. `{0 a}` is the first argument as written, or `a` if there is none; `{0 (a)}` is the argument as an
    /// operand, with parentheses where necessary, `{0 deg}` a number of degrees, and `{2 ?}` one more argument, if it exists.
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
    Synonym::of(Position::Declaration, word).is_some_and(|synonym| synonym.means == ["ground"])
}

impl Synonym {
    /// Returns the synonym for a word in a position, in upper or lower case; `prismatic_joint` is `prismatic`.
    #[must_use]
    pub fn of(position: Position, word: &str) -> Option<&'static Synonym> {
        Synonym::all_of(word).find(|synonym| synonym.position == position)
    }

    /// Returns the synonyms for a word in any position.
    pub fn all_of(word: &str) -> impl Iterator<Item = &'static Synonym> {
        let word = word.to_lowercase();
        SYNONYMS.iter().filter(move |synonym| {
            let word = match synonym.position {
                Position::Joint => word.strip_suffix("joint").map_or(word.as_str(), |stem| stem.trim_end_matches('_')),
                _ => word.as_str(),
            };
            synonym.names.contains(&word)
        })
    }

    /// Returns the foreign words that are exact equivalents of a word of the language.
    pub fn names_for(word: &str) -> impl Iterator<Item = &'static str> {
        SYNONYMS
            .iter()
            .filter(move |synonym| synonym.is_same && synonym.means.contains(&word))
            .flat_map(|synonym| synonym.names)
            .copied()
    }

    /// Returns the message for arguments as written.
    #[must_use]
    pub fn message(&self, arguments: &[&str]) -> String {
        // long arguments would hide the message
        let is_short = arguments.iter().all(|text| text.chars().count() <= LONGEST_ARGUMENT && !text.contains('\n'));
        let arguments = if is_short { arguments } else { &[] };
        let mut text = String::new();
        let mut rest = self.message;
        while let Some((before, after)) = rest.split_once('{') {
            let (gap, after_gap) = after.split_once('}').unwrap_or((after, ""));
            text += before;
            text += &fill(gap, arguments);
            rest = after_gap;
        }
        text + rest
    }
}

/// Length limit of arguments that a message repeats (characters).
const LONGEST_ARGUMENT: usize = 30;

fn fill(gap: &str, arguments: &[&str]) -> String {
    let (number, name) = gap.split_once(' ').unwrap_or((gap, ""));
    let argument = number.parse().ok().and_then(|k: usize| arguments.get(k)).copied();
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let as_operand = |text: &str| {
        let is_one = text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        if is_one { text.to_owned() } else { format!("({text})") }
    };
    match (name, argument) {
        ("?", argument) => argument.map_or(String::new(), |text| format!(", {text}")),
        ("deg", None) => "30 deg".to_owned(),
        ("deg", Some(text)) if is_number(text) => format!("{text} deg"),
        ("deg", Some(text)) => format!("{} * 1 deg", as_operand(text)),
        (name, None) => name.trim_matches(['(', ')']).to_owned(),
        (name, Some(text)) if name.starts_with('(') => as_operand(text),
        (_, Some(text)) => text.to_owned(),
    }
}

const fn synonym(
    position: Position,
    names: &'static [&'static str],
    means: &'static [&'static str],
    message: &'static str,
) -> Synonym {
    Synonym { position, names, means, is_same: true, message }
}

impl Synonym {
    /// Marks a synonym that needs a formula or more than one word.
    const fn with_formula(self) -> Synonym {
        Synonym { is_same: false, ..self }
    }
}

/// Creates a synonym for a call in a formula.
const fn call(names: &'static [&'static str], means: &'static [&'static str], message: &'static str) -> Synonym {
    synonym(Position::Call, names, means, message)
}

const fn joint(names: &'static [&'static str], means: &'static [&'static str], message: &'static str) -> Synonym {
    synonym(Position::Joint, names, means, message)
}

const fn unit(names: &'static [&'static str], means: &'static [&'static str], message: &'static str) -> Synonym {
    synonym(Position::Unit, names, means, message)
}

const fn number(names: &'static [&'static str], means: &'static [&'static str], message: &'static str) -> Synonym {
    synonym(Position::Number, names, means, message)
}

const fn declaration(names: &'static [&'static str], means: &'static [&'static str], message: &'static str) -> Synonym {
    synonym(Position::Declaration, names, means, message)
}

/// All synonyms.
pub static SYNONYMS: &[Synonym] = &[
    // ---- joints
    joint(
        &["pin", "hinge", "pivot", "rotary", "rotational", "turning", "bearing", "coincident", "spherical", "ball"],
        &["revolute"],
        "two points that coincide, as in a pin, are `revolute({0 P}, {1 Q})`",
    ),
    joint(
        &["prismatic", "slider", "slide", "sliding", "linear", "guide", "rail", "cylindrical", "piston", "translation"],
        &["translational"],
        "a body that slides on another is joined by `translational(a, b)`, of an axis on each",
    ),
    joint(
        &["fixed", "rigid", "fix", "lock", "locked", "glue", "welded", "clamp", "bolted"],
        &["weld"],
        "bodies that cannot move against each other are joined by `weld({0 P}, {1 Q}{2 ?})`, of a point on each",
    ),
    joint(
        &["slot", "pin_slot", "pin_in_slot", "slotted", "point_on_line", "point_line", "inline"],
        &["revolute_translational"],
        "a pin in a slot is `revolute_translational(P, a)`, P the pin's point and a the slot's axis",
    ),
    joint(
        &["link", "rod", "bar", "strut", "distance", "fixed_distance", "massless_link"],
        &["revolute_revolute"],
        "a link with a pin at both ends is `revolute_revolute({0 P}, {1 Q}, {2 length})`",
    ),
    joint(
        &["gears", "spur", "spur_gear", "gear_pair", "external_gear", "mesh", "friction_wheel"],
        &["gear"],
        "two wheels that roll on each other are `gear(c, d)`, of a circle on each",
    ),
    joint(
        &["ring_gear", "annulus", "internal", "inner_gear", "gear_internal"],
        &["internal_gear"],
        "a wheel in a ring is `internal_gear(c, d)`, of a circle on each",
    ),
    joint(
        &["rack", "rack_and_pinion", "pinion", "pinion_rack", "rolling"],
        &["rack_pinion"],
        "a wheel that rolls on a straight line is `rack_pinion(c, a)`, of a circle and an axis",
    ),
    joint(
        &["follower", "knife_edge", "point_on_curve", "point_curve", "pin_on_curve", "curve_slot"],
        &["point_follower"],
        "a point on a curve is `point_follower(P, k)`",
    ),
    joint(
        &["cam_follower", "roller", "roller_follower", "curve_curve", "cam_cam", "tangent"],
        &["cam"],
        "two curves that touch are `cam(k, m)`; a roller is a `circle`",
    ),
    joint(
        &["flat", "flat_face", "flat_faced_follower", "mushroom", "tappet"],
        &["flat_follower"],
        "a curve under a flat face is `flat_follower(k, a)`, a the axis of the face",
    ),
    joint(
        &["contact", "touch"],
        &["point_follower", "cam", "flat_follower"],
        "a contact is `point_follower(P, k)`, `cam(k, m)` or `flat_follower(k, a)`",
    ).with_formula(),
    joint(
        &["chain", "pulley", "pulleys", "timing_belt", "toothed_belt", "belt_drive", "chain_drive", "sprocket"],
        &["belt"],
        "a belt or chain around two wheels is `belt(c, d)`, of a circle on each",
    ),
    joint(
        &["coupler", "ratio", "transmission"],
        &["constraint"],
        "two rotations are coupled by an equation: `constraint ratio: rotation(a) = 2 * rotation(b)`, a and b revolute joints",
    ).with_formula(),
    joint(
        &["parallel"],
        &["constraint"],
        "bodies that stay parallel are an equation: `constraint parallel: angle(b, c) = 0`",
    ).with_formula(),
    joint(
        &["perpendicular"],
        &["constraint"],
        "bodies that stay perpendicular are an equation: `constraint perpendicular: angle(b, c) = 90 deg`",
    ).with_formula(),
    joint(
        &["motor", "actuator", "rotation", "displacement"],
        &["driver"],
        "what a motor prescribes is a driver: `driver motor: rotation(joint) = 60 rpm * t`",
    ).with_formula(),
    // ---- quantities
    call(
        &["velocity", "vel"],
        &["der"],
        "a velocity is the time derivative of a place, in a measure: `der(x({0 P}))`, `der(y({0 P}))`",
    ).with_formula(),
    call(
        &["acceleration", "acc", "accel"],
        &["der"],
        "an acceleration is the second time derivative of a place, in a measure: `der(der(x({0 P})))`, `der(der(y({0 P})))`",
    ).with_formula(),
    call(
        &["vx", "v_x", "velx", "vel_x", "xdot", "x_dot"],
        &["der"],
        "the velocity of a point along x is `der(x({0 P}))`, in a measure",
    ).with_formula(),
    call(
        &["vy", "v_y", "vely", "vel_y", "ydot", "y_dot"],
        &["der"],
        "the velocity of a point along y is `der(y({0 P}))`, in a measure",
    ).with_formula(),
    call(
        &["ax", "a_x", "accx", "acc_x", "xddot"],
        &["der"],
        "the acceleration of a point along x is `der(der(x({0 P})))`, in a measure",
    ).with_formula(),
    call(
        &["ay", "a_y", "accy", "acc_y", "yddot"],
        &["der"],
        "the acceleration of a point along y is `der(der(y({0 P})))`, in a measure",
    ).with_formula(),
    call(&["jerk"], &["der"], "a jerk is a third time derivative, in a measure: `der(der(der(x({0 P}))))`").with_formula(),
    call(
        &["position", "pos", "location", "place", "coordinates"],
        &["x", "y"],
        "the place of a point is `x({0 P})` and `y({0 P})`",
    ).with_formula(),
    call(
        &["reaction", "reaction_force", "joint_force", "bearing_force", "force"],
        &["force_x", "force_y"],
        "what a joint exerts is `force_x({0 J})` and `force_y({0 J})`",
    )
    .with_formula(),
    call(&["fx", "reaction_x"], &["force_x"], "what a joint exerts along x is `force_x({0 J})`"),
    call(&["fy", "reaction_y"], &["force_y"], "what a joint exerts along y is `force_y({0 J})`"),
    call(&["moment", "reaction_torque", "reaction_moment"], &["torque"], "the moment that a joint exerts is `torque({0 J})`"),
    call(
        &["motor_torque", "drive_torque", "driving_torque", "actuator_force", "driving_force", "multiplier", "lambda"],
        &["effort"],
        "what a driver or constraint supplies is `effort({0 D})`",
    ),
    call(&["xpos", "pos_x", "x_position", "posx"], &["x"], "the x coordinate of a point is `x({0 P})`"),
    call(&["ypos", "pos_y", "y_position", "posy", "height"], &["y"], "the y coordinate of a point is `y({0 P})`"),
    call(
        &["dist", "separation", "gap", "norm"],
        &["distance"],
        "how far two points are apart is `distance({0 P}, {1 Q})`",
    ),
    call(
        &["theta", "phi", "orientation", "heading", "angle_of", "attitude"],
        &["angle"],
        "the angle of a body or axis is `angle({0 b})`, that of a revolute joint `rotation(joint)`",
    ),
    call(
        &["rot", "rotate", "joint_angle", "revolution", "turns"],
        &["rotation"],
        "the angle of a revolute joint is `rotation({0 joint})`, that of a body `angle(b)`",
    ),
    call(
        &["omega", "angular_velocity", "angvel", "ang_vel", "turning_speed"],
        &["der"],
        "an angular velocity is the time derivative of an angle, in a measure: `der(angle({0 b}))`",
    ).with_formula(),
    call(
        &["alpha", "angular_acceleration", "angacc"],
        &["der"],
        "an angular acceleration is the second time derivative of an angle, in a measure: `der(der(angle({0 b})))`",
    ).with_formula(),
    call(
        &["translation", "travel", "stroke", "slide", "extension", "disp"],
        &["displacement"],
        "how far a translational joint has moved is `displacement({0 joint})`",
    ),
    call(
        &["d", "deriv", "derivative", "diff", "ddt", "d_dt", "dot", "rate"],
        &["der"],
        "the time derivative is `der({0 e})`, in a measure",
    ),
    call(&["ddot", "der2", "diff2"], &["der"], "the second time derivative is `der(der({0 e}))`, in a measure").with_formula(),
    // ---- powers, roots, logarithms
    call(&["sqr", "square"], &[], "a square is written `{0 (a)}^2`").with_formula(),
    call(&["cube"], &[], "a cube is written `{0 (a)}^3`").with_formula(),
    call(&["pow"], &[], "a power is written `{0 (a)} ^ {1 (b)}`").with_formula(),
    call(&["power"], &[], "a power is written `{0 (a)} ^ {1 (b)}`; that of a driver is its `effort` times a `der`")
        .with_formula(),
    call(&["cbrt", "curt", "cuberoot"], &[], "a cube root is `{0 (a)}^(1/3)`, where that is not negative").with_formula(),
    call(&["root", "nthroot"], &[], "a root is a power: `{0 (a)}^(1/{1 (n)})`, where the first is not negative").with_formula(),
    call(&["squareroot", "square_root"], &["sqrt"], "a square root is `sqrt({0 a})`"),
    call(&["log"], &["ln", "log10"], "was `ln` (natural) or `log10` meant?"),
    call(&["loge", "logn"], &["ln"], "the natural logarithm is `ln({0 a})`"),
    call(&["lg"], &["log10"], "the logarithm to the base 10 is `log10({0 a})`"),
    call(&["log2", "ld"], &["ln"], "the logarithm to the base 2 is `ln({0 a}) / ln(2)`").with_formula(),
    call(&["log1p"], &["ln"], "it is written `ln(1 + {0 a})`").with_formula(),
    call(&["expm1"], &["exp"], "it is written `exp({0 a}) - 1`").with_formula(),
    call(&["exp10"], &[], "a power of ten is written `10^{0 (a)}`").with_formula(),
    call(&["exp2"], &[], "a power of two is written `2^{0 (a)}`").with_formula(),
    // ---- angles
    call(&["sind", "sindeg", "sin_deg"], &["sin"], "angles are in radians, or have a unit: `sin({0 deg})`").with_formula(),
    call(&["cosd", "cosdeg", "cos_deg"], &["cos"], "angles are in radians, or have a unit: `cos({0 deg})`").with_formula(),
    call(&["tand", "tandeg", "tan_deg"], &["tan"], "angles are in radians, or have a unit: `tan({0 deg})`").with_formula(),
    call(&["asind"], &["asin"], "`asin({0 a})` is an angle; its number of degrees is `asin({0 a}) / 1 deg`").with_formula(),
    call(&["acosd"], &["acos"], "`acos({0 a})` is an angle; its number of degrees is `acos({0 a}) / 1 deg`").with_formula(),
    call(&["atand"], &["atan"], "`atan({0 a})` is an angle; its number of degrees is `atan({0 a}) / 1 deg`").with_formula(),
    call(
        &["atan2d"],
        &["atan2"],
        "`atan2({0 y}, {1 x})` is an angle; its number of degrees is `atan2({0 y}, {1 x}) / 1 deg`",
    ).with_formula(),
    call(&["arcsin", "arsin"], &["asin"], "was `asin` meant?"),
    call(&["arccos", "arcos"], &["acos"], "was `acos` meant?"),
    call(&["arctan", "arctg", "artan"], &["atan"], "was `atan` meant?"),
    call(&["arctan2", "arctg2"], &["atan2"], "was `atan2` meant?"),
    call(&["tg"], &["tan"], "the tangent is `tan({0 a})`"),
    call(&["cot", "ctg", "cotan"], &["tan"], "the cotangent is `1 / tan({0 a})`").with_formula(),
    call(&["sec"], &["cos"], "the secant is `1 / cos({0 a})`").with_formula(),
    call(&["csc", "cosec"], &["sin"], "the cosecant is `1 / sin({0 a})`").with_formula(),
    call(&["cotd"], &["tan"], "angles are in radians, or have a unit: `1 / tan({0 deg})`").with_formula(),
    call(&["secd"], &["cos"], "angles are in radians, or have a unit: `1 / cos({0 deg})`").with_formula(),
    call(&["cscd"], &["sin"], "angles are in radians, or have a unit: `1 / sin({0 deg})`").with_formula(),
    call(&["acot", "arccot"], &["atan2"], "the arc cotangent, from 0 to pi, is `atan2(1, {0 a})`").with_formula(),
    call(&["asec", "arcsec"], &["acos"], "the arc secant is `acos(1 / {0 (a)})`").with_formula(),
    call(&["acsc", "arccsc"], &["asin"], "the arc cosecant is `asin(1 / {0 (a)})`").with_formula(),
    call(&["coth"], &["tanh"], "the hyperbolic cotangent is `1 / tanh({0 a})`").with_formula(),
    call(&["sech"], &["cosh"], "the hyperbolic secant is `1 / cosh({0 a})`").with_formula(),
    call(&["csch"], &["sinh"], "the hyperbolic cosecant is `1 / sinh({0 a})`").with_formula(),
    call(
        &["asinh", "arsinh", "arcsinh"],
        &["ln", "sqrt"],
        "the inverse of `sinh` is `ln({0 (a)} + sqrt({0 (a)}^2 + 1))`",
    ).with_formula(),
    call(
        &["acosh", "arcosh", "arccosh"],
        &["ln", "sqrt"],
        "the inverse of `cosh` is `ln({0 (a)} + sqrt({0 (a)}^2 - 1))`",
    ).with_formula(),
    call(&["atanh", "artanh", "arctanh"], &["ln"], "the inverse of `tanh` is `ln((1 + {0 (a)}) / (1 - {0 (a)})) / 2`").with_formula(),
    call(
        &["radians", "deg2rad", "torad", "to_rad", "to_radians"],
        &["deg"],
        "an angle in degrees is written with its unit: `{0 deg}`",
    ).with_formula(),
    call(
        &["degrees", "rad2deg", "todeg", "to_deg", "to_degrees"],
        &["deg"],
        "the number of degrees of an angle is `{0 (a)} / 1 deg`",
    ).with_formula(),
    // ---- whole numbers, signs, choices
    call(&["floor"], &["mod"], "the language has no `floor`: use `{0 (a)} - mod({0 a}, 1)`").with_formula(),
    call(&["ceil", "ceiling"], &["mod"], "the language has no `ceil`: use `{0 (a)} + mod(-{0 (a)}, 1)`").with_formula(),
    call(
        &["round", "rint", "nint"],
        &["mod"],
        "the language has no `round`: use `{0 (a)} + 0.5 - mod({0 (a)} + 0.5, 1)`",
    ).with_formula(),
    call(
        &["trunc", "fix", "int", "integer"],
        &["mod"],
        "the language has no `trunc`: use `sign({0 a}) * (abs({0 a}) - mod(abs({0 a}), 1))`",
    ).with_formula(),
    call(&["frac", "fract"], &["mod"], "what is behind the point is `mod({0 a}, 1)`").with_formula(),
    call(
        &["rem", "fmod", "remainder"],
        &["mod"],
        "`mod({0 a}, {1 b})` has the sign of the second; with that of the first: `sign({0 a}) * mod(abs({0 a}), abs({1 b}))`",
    ).with_formula(),
    call(&["modulo", "modulus"], &["mod"], "it is written `mod({0 a}, {1 b})`"),
    call(&["sgn", "signum", "copysign"], &["sign"], "the sign of a number is `sign({0 a})`"),
    call(&["fabs", "absolute", "magnitude", "mag"], &["abs"], "the absolute value is `abs({0 a})`"),
    call(&["minimum", "least", "fmin"], &["min"], "over the motion, in a `result`, the least is `min({0 a})`; of two it is `min({0 a}, {1 b})`"),
    call(
        &["maximum", "largest", "fmax"],
        &["max"],
        "over the motion, in a `result`, the largest is `max({0 a})`; of two it is `max({0 a}, {1 b})`",
    ),
    call(&["average", "avg"], &["mean"], "the average over the motion is `mean({0 a})`, in a `result`"),
    call(
        &["std", "stdev", "stddev", "deviation"],
        &["rms", "mean"],
        "the standard deviation over the motion is `rms({0 (a)} - mean({0 a}))`, in a `result`",
    ).with_formula(),
    call(
        &["clamp", "clip", "limit", "saturate", "sat"],
        &["min", "max"],
        "between two limits it is `max({1 low}, min({2 high}, {0 a}))`",
    ).with_formula(),
    call(
        &["heaviside", "unitstep", "unit_step"],
        &["if"],
        "a jump is written `if {0 t} < 0 then 0 else 1`; a smooth rise is `step5(u, u0, v0, u1, v1)`",
    ).with_formula(),
    call(
        &["iif", "ifelse", "select", "piecewise", "cond", "ite"],
        &["if"],
        "a choice is written `if t < 1 s then 0 else 1`",
    ),
    // ---- motions and tables
    call(
        &["smoothstep", "step3", "havsin", "haversine", "cubic"],
        &["step"],
        "a cubic rise is `step(u, u0, v0, u1, v1)`",
    ),
    call(
        &["poly345", "step345", "poly_345", "quintic", "smootherstep", "minjerk", "minimum_jerk"],
        &["step5"],
        "the 3-4-5 polynomial is `step5(u, u0, v0, u1, v1)`",
    ),
    call(
        &["poly4567", "step4567", "poly_4567", "septic"],
        &["step7"],
        "the 4-5-6-7 polynomial is `step7(u, u0, v0, u1, v1)`",
    ),
    call(
        &["shm", "simple_harmonic", "cosine_rise"],
        &["harmonic"],
        "half a wave of the cosine is `harmonic(u, u0, v0, u1, v1)`",
    ),
    call(&["cycloid", "bestehorn"], &["cycloidal"], "the cycloid is `cycloidal(u, u0, v0, u1, v1)`"),
    call(&["modified_sine", "mod_sine", "neklutin"], &["modsine"], "the modified sine is `modsine(u, u0, v0, u1, v1)`"),
    call(
        &["polynomial", "polyval"],
        &["poly"],
        "a polynomial of u - u0 is `poly(u, u0, c0, c1)`, with as many as it has",
    ),
    call(
        &["interp", "interp1", "interpolate", "lookup", "spline", "akispl", "cubspl", "akima"],
        &["table"],
        "a curve through points is a table, called by its name: `table lift = spline [(0, 0), (1, 2)]`",
    ),
    // ---- units
    unit(&["min", "minute", "minutes"], &["rpm"], "minutes are no unit; `rev/min` is `rpm`, `1 min` is `60 s`").with_formula(),
    unit(&["h", "hour", "hours", "hr"], &["s"], "hours are no unit; `1 h` is `3600 s`").with_formula(),
    unit(&["degree", "degrees", "°"], &["deg"], "was `deg` meant?"),
    unit(&["radian", "radians"], &["rad"], "was `rad` meant?"),
    unit(&["rot", "rots", "turn", "turns", "revolution", "revolutions", "cycle", "cycles"], &["rev"], "was `rev` meant?"),
    unit(&["sec", "second", "seconds"], &["s"], "was `s` meant?"),
    unit(&["msec", "millisecond", "milliseconds"], &["ms"], "was `ms` meant?"),
    unit(&["usec", "microsecond", "microseconds"], &["us"], "was `us` meant?"),
    unit(&["meter", "meters", "metre", "metres"], &["m"], "was `m` meant?"),
    unit(&["millimeter", "millimeters", "millimetre", "millimetres"], &["mm"], "was `mm` meant?"),
    unit(&["centimeter", "centimeters", "centimetre", "centimetres"], &["cm"], "was `cm` meant?"),
    unit(&["micron", "microns", "micrometer", "micrometre"], &["um"], "was `um` meant?"),
    unit(&["inch", "inches"], &["in"], "was `in` meant?"),
    unit(&["foot", "feet"], &["ft"], "was `ft` meant?"),
    unit(&["rps"], &["rev"], "revolutions per second are `rev/s`").with_formula(),
    unit(&["khz", "kilohertz"], &["Hz"], "kilohertz are no unit; `1 kHz` is `1000 Hz`").with_formula(),
    unit(&["mhz"], &["Hz"], "neither megahertz nor millihertz are a unit; write `1e6 Hz` or `0.001 Hz`").with_formula(),
    unit(&["hertz"], &["Hz"], "was `Hz` meant?"),
    unit(&["urad", "µrad"], &["mrad"], "microradians are no unit; `1 urad` is `0.001 mrad`").with_formula(),
    unit(&["u/min", "upm", "rev_min", "revpm"], &["rpm"], "was `rpm` meant?"),
    unit(&["dm"], &["m"], "decimetres are no unit; `1 dm` is `0.1 m`").with_formula(),
    unit(&["nm"], &["N", "m"], "newton metres are `N*m`; `1 nm` is `1e-9 m`").with_formula(),
    unit(&["knm"], &["kN", "m"], "kilonewton metres are `kN*m`").with_formula(),
    unit(&["g", "gram", "grams", "gramme"], &["kg"], "grams are no unit; `1 g` is `0.001 kg`").with_formula(),
    unit(&["t", "tonne", "tonnes", "ton", "tons"], &["kg"], "tonnes are no unit; `1 t` is `1000 kg`").with_formula(),
    unit(&["kilogram", "kilograms", "kilo", "kgs"], &["kg"], "was `kg` meant?"),
    unit(&["lb", "lbs", "pound", "pounds"], &["lbm", "lbf"], "a mass is in `lbm`, a force in `lbf`").with_formula(),
    unit(&["newton", "newtons"], &["N"], "was `N` meant?"),
    unit(&["kgf", "kp"], &["N"], "kilograms are no force; `1 kgf` is `9.80665 N`").with_formula(),
    unit(&["kgm2", "kgm²", "kg·m²", "kg·m2"], &["kg", "m"], "a moment of inertia is in `kg*m^2`").with_formula(),
    unit(&["kgmm2", "kgmm²", "kg·mm²", "kg·mm2"], &["kg", "mm"], "a moment of inertia is in `kg*mm^2`").with_formula(),
    unit(&["joule", "joules"], &["J"], "was `J` meant?"),
    unit(&["kj", "mj"], &["J"], "write `1000 J` for `1 kJ`").with_formula(),
    unit(&["watt", "watts"], &["W"], "was `W` meant?"),
    unit(&["mw"], &["kW"], "neither megawatts nor milliwatts are a unit; write `1000 kW` or `0.001 W`").with_formula(),
    unit(&["hp", "ps"], &["kW"], "horse powers are no unit; `1 hp` is `0.7457 kW`").with_formula(),
    unit(&["pascal", "pascals"], &["Pa"], "was `Pa` meant?"),
    unit(&["gpa"], &["MPa"], "gigapascals are no unit; `1 GPa` is `1000 MPa`").with_formula(),
    unit(&["psi"], &["kPa"], "pounds per square inch are no unit; `1 psi` is `1 lbf/in^2`, `6.895 kPa`").with_formula(),
    unit(&["atm", "mbar"], &["bar"], "`1 atm` is `1.01325 bar`, `1 mbar` is `0.001 bar`").with_formula(),
    unit(&["mil", "thou"], &["in"], "thousandths of an inch are no unit; `1 mil` is `0.001 in`").with_formula(),
    unit(&["yd", "yard", "yards"], &["ft"], "yards are no unit; `1 yd` is `3 ft`").with_formula(),
    unit(&["gon", "grad"], &["deg"], "gons are no unit; `1 gon` is `0.9 deg`").with_formula(),
    unit(&["arcmin"], &["deg"], "minutes of arc are no unit; `1 deg` is 60 of them").with_formula(),
    unit(&["arcsec"], &["deg"], "seconds of arc are no unit; `1 deg` is 3600 of them").with_formula(),
    // ---- names that stand for a number
    number(&["dt"], &["der"], "the time derivative of a formula is `der(…)`, in a measure").with_formula(),
    number(&["time", "zeit", "temps", "tiempo"], &["t"], "was `t` meant?"),
    number(&["π", "𝜋"], &["pi"], "was `pi` meant?"),
    number(&["τ", "two_pi", "twopi"], &["tau"], "was `tau` meant?"),
    // ---- declarations
    declaration(&["model", "assembly", "system", "linkage", "machine"], &["mechanism"], "was `mechanism` meant?"),
    declaration(&["parameter", "const", "constant", "let", "var", "variable", "set"], &["param"], "was `param` meant?"),
    declaration(&["function", "def", "func", "fun"], &["fn"], "was `fn` meant?"),
    declaration(
        &["base", "frame", "frame_ground", "gnd", "grnd", "fixed", "world", "chassis", "foundation", "inertial"],
        &["ground"],
        "was `ground` meant?",
    ),
    declaration(&["link", "bar", "rigid_body", "component", "element", "solid"], &["body"], "was `body` meant?"),
    declaration(&["marker", "node", "vertex"], &["point"], "was `point` meant?"),
    declaration(&["line", "vector", "direction", "ray"], &["axis"], "was `axis` meant?"),
    declaration(&["profile", "path"], &["curve"], "was `curve` meant?"),
    declaration(&["wheel", "disc", "disk"], &["circle"], "was `circle` meant?"),
    declaration(&["motor", "actuator", "motion", "drive"], &["driver"], "was `driver` meant?"),
    declaration(
        &["force", "spring", "damper", "sforce", "applied_force", "external_force", "tsda", "rsda"],
        &["load"],
        "a force of which a formula is known is a `load`: `load spring: -k * K on K`",
    )
    .with_formula(),
    declaration(&["grav", "gravitation"], &["gravity"], "was `gravity` meant?"),
    declaration(&["weight", "point_mass", "pointmass", "mass_properties"], &["mass"], "what a body weighs is its `mass`, in its braces")
        .with_formula(),
    declaration(&["equation", "condition", "coupling"], &["constraint"], "was `constraint` meant?"),
    declaration(&["output", "plot", "print", "sensor", "request"], &["measure"], "was `measure` meant?"),
    declaration(&["simulate", "simulation", "solve", "run", "time"], &["analysis"], "was `analysis` meant?"),
    declaration(&["spline", "lookup", "data"], &["table"], "was `table` meant?"),
    declaration(&["units", "unit", "unitsystem"], &[], "each number has its own unit: `30 mm`, `60 rpm`"),
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
        let means = |word: &str| Synonym::of(Position::Joint, word).map(|synonym| synonym.means[0]);
        assert_eq!(means("Prismatic_Joint"), Some("translational"));
        assert_eq!(means("PinJoint"), Some("revolute"));
        assert_eq!(means("revolute"), None);
    }
}
