//! Joints as data: what the language, explanations and pictures need to know of each kind. Its equations are in `mechc-lang`.

use super::{Category, Dimension, Example, MeasuredQuantity, QuantityArgument, QuantityWord, Word};

const LENGTH: Dimension = Dimension::LENGTH;

/// A kind of joint. Every stage reads this data; only the rows of `Φ` and new symbols are code.
pub struct JointSpec {
    /// Documentation.
    pub word: Word,
    /// Arguments in words.
    pub takes: &'static str,
    /// The features of the first and of the second body, which are the first two arguments.
    pub features: [FeatureWord; 2],
    /// The arguments that follow the features.
    pub arguments: &'static [ArgumentSpec],
    /// Dimensions of the rows of `Φ`, in order.
    pub rows: &'static [Dimension],
    /// Coordinates of the joint, with descriptions.
    pub coordinates: &'static [(&'static str, &'static str)],
    /// The motion that the joint leaves to its bodies and that has a quantity.
    pub motion: Option<JointMotion>,
    /// The components of the reaction on its bodies.
    pub reaction: ReactionKind,
    /// The distance that the joint needs between its features, and does not hold.
    pub spacing: Option<Spacing>,
    /// Symbol in pictures.
    pub symbol: JointSymbol,
}

/// A kind of feature, in the place of a joint's argument.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FeatureWord {
    /// A point.
    Point,
    /// An axis.
    Axis,
    /// A circle.
    Circle,
    /// A curve, or a circle in its place.
    Curve,
}

impl FeatureWord {
    /// Returns the keyword that declares such a feature.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            FeatureWord::Point => "point",
            FeatureWord::Axis => "axis",
            FeatureWord::Circle => "circle",
            FeatureWord::Curve => "curve",
        }
    }
}

/// An argument of a joint that is not a feature. All but a length may be left out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ArgumentSpec {
    /// An angle with its name in messages; 0 if it is left out.
    Angle(&'static str),
    /// A length of either sign with its name in messages; 0 if it is left out.
    Offset(&'static str),
    /// A positive length with its name in messages; required.
    Length(&'static str),
    /// The phase of a mesh, a length; that of the drawn poses if it is left out.
    Phase,
    /// One of some words, with what it says.
    Word(&'static [&'static str], &'static str),
}

/// A motion that a joint leaves to its bodies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum JointMotion {
    /// A rotation about a common point.
    Rotation,
    /// A displacement along a common line.
    Displacement,
}

impl JointMotion {
    /// Returns the quantity that measures the motion.
    #[must_use]
    pub const fn quantity(self) -> &'static str {
        match self {
            JointMotion::Rotation => "rotation",
            JointMotion::Displacement => "displacement",
        }
    }
}

/// Components of the reaction that a joint exerts on its bodies, at its point of action.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ReactionKind {
    /// A force.
    Force,
    /// A force and a torque.
    ForceAndTorque,
    /// A torque, and a force that the motion does not determine.
    Torque,
}

/// The distance that a joint needs between its features.
#[derive(Clone, Copy, Debug)]
pub struct Spacing {
    /// The features that are apart, in words.
    pub of: &'static str,
    /// The required distance, in words.
    pub wanted: &'static str,
    /// The kind of joint that takes the sum of the radii for their difference, or the other way round.
    pub other: Option<&'static str>,
}

/// The symbol of a joint in pictures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // named like the joints that have them
pub enum JointSymbol {
    Pin,
    Slider,
    Weld,
    Link,
    Slot,
    Gear,
    RingGear,
    Rack,
    Belt,
    Contact,
}

impl JointSpec {
    /// Returns the joint of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static JointSpec> {
        JOINTS.iter().find(|joint| joint.word.name == name)
    }

    /// Returns the word of the language.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.word.name
    }

    /// Returns the numbers of equations and coordinates in words: `2 equations, and 1 coordinate of its own: u, its place`.
    #[must_use]
    pub fn counts(&self) -> String {
        let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let coordinates: Vec<String> =
            self.coordinates.iter().map(|(name, what)| format!("`{name}`, {what}")).collect();
        let equations = count(self.rows.len(), "equation");
        match coordinates.len() {
            0 => equations,
            n => format!("{equations}, and {} of its own: {}", count(n, "coordinate"), coordinates.join("; ")),
        }
    }

    /// Returns whether a quantity such as `rotation`, `slip` or `torque` is defined for the joint.
    #[must_use]
    pub fn has_quantity(&self, quantity: &str) -> bool {
        match quantity {
            "rotation" | "displacement" => self.motion.is_some_and(|motion| motion.quantity() == quantity),
            "torque" => self.has_torque(),
            "force_x" | "force_y" => self.has_force(),
            _ => {
                let measured = QuantityWord::named(quantity).and_then(QuantityWord::measured);
                let is_of_contact = |spec: MeasuredQuantity| spec.arguments.contains(&QuantityArgument::Contact);
                !measured.is_some_and(is_of_contact) || self.has_contact()
            }
        }
    }

    /// Returns whether the joint is a contact of two outlines, or of a point and an outline.
    #[must_use]
    pub fn has_contact(&self) -> bool {
        self.features.contains(&FeatureWord::Curve)
    }

    /// Returns whether the joint is a contact that needs a tangent of its first curve.
    #[must_use]
    pub fn has_tangent(&self) -> bool {
        self.features[0] == FeatureWord::Curve
    }

    /// Returns whether the joint is a contact with a straight face.
    #[must_use]
    pub fn has_face(&self) -> bool {
        self.has_tangent() && self.features[1] == FeatureWord::Axis
    }

    /// Returns whether the joint is of two points.
    #[must_use]
    pub fn is_of_points(&self) -> bool {
        self.features == [FeatureWord::Point; 2]
    }

    /// Returns whether the joint holds two points at a distance, its first value, by the row `dᵀd − L²`.
    #[must_use]
    pub fn holds_distance(&self) -> bool {
        self.is_of_points() && self.rows == [Dimension::AREA]
    }

    /// Returns whether the joint holds two points together.
    #[must_use]
    pub fn holds_points_together(&self) -> bool {
        self.is_of_points() && !self.holds_distance()
    }

    /// Returns whether the joint rolls, at a phase that the drawn poses decide.
    #[must_use]
    pub fn rolls(&self) -> bool {
        self.features[0] == FeatureWord::Circle
    }

    /// Returns whether the joint's reaction can have a moment about its point of action; for the others it is zero.
    #[must_use]
    pub fn has_torque(&self) -> bool {
        self.reaction != ReactionKind::Force
    }

    /// Returns whether the motion determines the force of the joint's reaction.
    #[must_use]
    pub fn has_force(&self) -> bool {
        self.reaction != ReactionKind::Torque
    }
}

/// Kinds of joints are equal if their names are.
impl PartialEq for JointSpec {
    fn eq(&self, other: &JointSpec) -> bool {
        self.name() == other.name()
    }
}

impl Eq for JointSpec {}

impl std::fmt::Debug for JointSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Notation of the equations.
pub const NOTATION: &str = "Here i is the body of the first argument and j that of the second, `r` a place in the ground's frame, `d` \
                            from the first argument's point to the second's, `v` the unit direction of an axis, `v^⊥` that turned \
                            by +90°, `φ` a body's angle and `A` its rotation matrix.";

/// A joint that exerts a force and a torque, and has no arguments but its features.
const PLAIN: JointSpec = JointSpec {
    word: Word {
        name: "",
        category: Category::Joint,
        forms: &[],
        letters: "",
        meaning: "",
        more: "",
        example: Example::Of(""),
    },
    takes: "",
    features: [FeatureWord::Point; 2],
    arguments: &[],
    rows: &[],
    coordinates: &[],
    motion: None,
    reaction: ReactionKind::ForceAndTorque,
    spacing: None,
    symbol: JointSymbol::Pin,
};

/// All joints.
pub static JOINTS: &[JointSpec] = &[
    JointSpec {
        word: Word {
            name: "revolute",
            forms: &["revolute(P, Q)"],
            meaning: "two points coincide, and the bodies turn about them",
            more: "`Φ = r_i^P − r_j^Q`",
            example: Example::Arm("driver motor: rotation(main) = 60 rpm * t"),
            ..PLAIN.word
        },
        takes: "two points",
        features: [FeatureWord::Point, FeatureWord::Point],
        rows: &[LENGTH, LENGTH],
        motion: Some(JointMotion::Rotation),
        reaction: ReactionKind::Force,
        symbol: JointSymbol::Pin,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "translational",
            forms: &["translational(a, b)"],
            letters: "a and b axes",
            meaning: "two axes lie on one line, and the bodies slide along it without turning",
            more: "`Φ = [v_i^⊥ᵀ d, v_i^⊥ᵀ v_j]`. Parallel and antiparallel axes both satisfy it; the poses in `at` decide which.",
            example: Example::Whole(
                "\
ground {
    axis way = (0, 0) along (1, 0)
}
body slide {
    axis way = (0, 0) along (1, 0)
}
joint guide: translational(ground.way, slide.way)
driver piston: displacement(guide) = 50 mm + 20 mm/s * t",
            ),
            ..PLAIN.word
        },
        takes: "two axes",
        features: [FeatureWord::Axis, FeatureWord::Axis],
        rows: &[LENGTH, Dimension::PURE],
        motion: Some(JointMotion::Displacement),
        symbol: JointSymbol::Slider,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "weld",
            forms: &["weld(P, Q)", "weld(P, Q, angle)"],
            meaning: "two points coincide, and the bodies do not turn against each other",
            more: "`Φ = [r_i^P − r_j^Q, φ_j − φ_i − φ_0]`, `φ_0` the angle, 0 if it is not given.",
            example: Example::Whole(
                "\
ground {
    point O = (0, 0)
}
body arm {
    point O   = (0, 0)
    point tip = (100 mm, 0)
}
body tool at (100 mm, 0, 30 deg) {
    point O = (0, 0)
}
joint main: revolute(ground.O, arm.O)
joint seat: weld(arm.tip, tool.O, 30 deg)
driver motor: rotation(main) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two points, and an angle if it is not 0",
        features: [FeatureWord::Point, FeatureWord::Point],
        arguments: &[ArgumentSpec::Angle("the angle of a weld")],
        rows: &[LENGTH, LENGTH, Dimension::ANGLE],
        symbol: JointSymbol::Weld,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "revolute_revolute",
            forms: &["revolute_revolute(P, Q, length)"],
            meaning: "two points stay at a distance, as if a massless link with a pin at both ends joined them",
            more: "`Φ = dᵀd − L²`, L the length, which is positive.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point D = (200 mm, 0)
}
body crank at (0, 0, 90 deg) {
    point A = (0, 0)
    point B = (50 mm, 0)
}
body rocker at (200 mm, 0, 90 deg) {
    point D = (0, 0)
    point C = (120 mm, 0)
}
joint main: revolute(ground.A, crank.A)
joint pivot: revolute(ground.D, rocker.D)
joint rod: revolute_revolute(crank.B, rocker.C, 210 mm)
driver motor: rotation(main) = 90 deg + 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two points and a length",
        features: [FeatureWord::Point, FeatureWord::Point],
        arguments: &[ArgumentSpec::Length("the length of the link")],
        rows: &[Dimension::AREA],
        reaction: ReactionKind::Force,
        symbol: JointSymbol::Link,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "revolute_translational",
            forms: &["revolute_translational(P, a)", "revolute_translational(P, a, offset)"],
            meaning: "a point stays on an axis, as a pin in a slot",
            more: "`Φ = v_j^⊥ᵀ (r_i^P − r_j^a) − c`, c the offset to the left of the axis, 0 if it is not given.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point B = (0, -150 mm)
}
body crank {
    point A   = (0, 0)
    point pin = (50 mm, 0)
}
body arm at (0, -150 mm, 70 deg) {
    point B   = (0, 0)
    axis slot = B along (1, 0)
}
joint main: revolute(ground.A, crank.A)
joint pivot: revolute(ground.B, arm.B)
joint guide: revolute_translational(crank.pin, arm.slot)
driver motor: rotation(main) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "a point and an axis, and an offset if it is not 0",
        features: [FeatureWord::Point, FeatureWord::Axis],
        arguments: &[ArgumentSpec::Offset("the offset from the axis")],
        rows: &[LENGTH],
        symbol: JointSymbol::Slot,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "gear",
            forms: &["gear(c, d)", "gear(c, d, phase)"],
            letters: "c and d circles",
            meaning: "two circles roll on each other from outside",
            more: "`Φ = [−dx sin θ + dy cos θ, R_i(φ_i − θ) + R_j(φ_j − θ) − κ]`, (dx, dy) from centre to centre. The phase `κ`, a \
                   length, is taken from the poses in `at` if it is not given. Gears do not hold their centres apart: the \
                   bodies' other joints do.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point B = (90 mm, 0)
}
body pinion {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body wheel at (90 mm, 0, 0) {
    circle pitch = (0, 0) radius 60 mm
    point O      = (0, 0)
}
joint axle: revolute(ground.A, pinion.O)
joint shaft: revolute(ground.B, wheel.O)
joint mesh: gear(pinion.pitch, wheel.pitch)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two circles, and a phase if the drawing does not give it",
        features: [FeatureWord::Circle, FeatureWord::Circle],
        arguments: &[ArgumentSpec::Phase],
        rows: &[LENGTH, LENGTH],
        coordinates: &[("theta", "the direction of the line of centres")],
        spacing: Some(Spacing { of: "centres", wanted: "the sum of the radii", other: Some("internal_gear") }),
        symbol: JointSymbol::Gear,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "internal_gear",
            forms: &["internal_gear(c, d)", "internal_gear(c, d, phase)"],
            letters: "c and d circles",
            meaning: "two circles roll on each other, one of them a ring around the other",
            more: "`Φ = [−dx sin θ + dy cos θ, R_i(φ_i − θ) − R_j(φ_j − θ) − κ]`, (dx, dy) from centre to centre. The phase `κ`, a \
                   length, is taken from the poses in `at` if it is not given. Gears do not hold their centres apart: the \
                   bodies' other joints do.",
            example: Example::Whole(
                "\
ground {
    point A = (60 mm, 0)
    point B = (0, 0)
}
body pinion at (60 mm, 0, 0) {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body ring {
    circle pitch = (0, 0) radius 90 mm
    point O      = (0, 0)
}
joint axle: revolute(ground.A, pinion.O)
joint shaft: revolute(ground.B, ring.O)
joint mesh: internal_gear(pinion.pitch, ring.pitch)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two circles, and a phase if the drawing does not give it",
        features: [FeatureWord::Circle, FeatureWord::Circle],
        arguments: &[ArgumentSpec::Phase],
        rows: &[LENGTH, LENGTH],
        coordinates: &[("theta", "the direction of the line of centres")],
        spacing: Some(Spacing { of: "centres", wanted: "the difference of the radii", other: Some("gear") }),
        symbol: JointSymbol::RingGear,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "belt",
            forms: &["belt(c, d)", "belt(c, d, crossed)"],
            letters: "c and d circles",
            meaning: "a belt or chain runs around two circles without slip",
            more: "`Φ = [−dx sin θ + dy cos θ, R_i(φ_i − θ) ∓ R_j(φ_j − θ) − κ]`, (dx, dy) from centre to centre, plus for a crossed belt, \
                   whose pulleys turn against each other. `κ` is taken from the poses in `at`. A belt does not hold the centres of its \
                   pulleys apart: the bodies' other joints do, and a warning says where their distance changes. It pulls them \
                   together as hard as it was tightened, which no motion tells: it has a `torque`, but no `force_x` and `force_y`.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point B = (150 mm, 0)
    point C = (150 mm, 120 mm)
}
body pulley {
    circle rim = (0, 0) radius 20 mm
    point O    = (0, 0)
}
body drum at (150 mm, 0, 0) {
    circle rim = (0, 0) radius 50 mm
    point O    = (0, 0)
}
body fan at (150 mm, 120 mm, 0) {
    circle rim = (0, 0) radius 15 mm
    point O    = (0, 0)
}
joint axle: revolute(ground.A, pulley.O)
joint shaft: revolute(ground.B, drum.O)
joint pivot: revolute(ground.C, fan.O)
joint drive: belt(pulley.rim, drum.rim)
joint back: belt(drum.rim, fan.rim, crossed)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two circles, and `crossed` if the belt crosses itself",
        features: [FeatureWord::Circle, FeatureWord::Circle],
        arguments: &[ArgumentSpec::Word(&["crossed"], "a belt that crosses itself")],
        rows: &[LENGTH, LENGTH],
        coordinates: &[("theta", "the direction of the line of centres")],
        reaction: ReactionKind::Torque,
        symbol: JointSymbol::Belt,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "rack_pinion",
            forms: &["rack_pinion(c, a)", "rack_pinion(c, a, phase)", "rack_pinion(c, a, phase, left)"],
            letters: "c a circle and a an axis",
            meaning: "a circle rolls on an axis",
            more: "`Φ = v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j) − κ`, σ = +1 if the centre lies to the left of the axis, −1 to the \
                   right. The side and the phase `κ`, a length, are taken from the poses in `at` if they are not given. The \
                   pinion is not held at its distance: the bodies' other joints do that.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 30 mm)
    axis way = (0, 0) along (1, 0)
}
body pinion at (0, 30 mm, 0) {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body rack {
    axis way = (0, 0) along (1, 0)
}
joint axle: revolute(ground.O, pinion.O)
joint guide: translational(ground.way, rack.way)
joint mesh: rack_pinion(pinion.pitch, rack.way)
driver motor: rotation(axle) = 30 deg/s * t",
            ),
            ..PLAIN.word
        },
        takes: "a circle and an axis, and a phase and a side if the drawing does not give them",
        features: [FeatureWord::Circle, FeatureWord::Axis],
        arguments: &[
            ArgumentSpec::Phase,
            ArgumentSpec::Word(
                &["left", "right"],
                "the side of the axis on which the pinion lies, seen along the axis",
            ),
        ],
        rows: &[LENGTH],
        spacing: Some(Spacing { of: "centre and axis", wanted: "the radius", other: None }),
        symbol: JointSymbol::Rack,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "point_follower",
            forms: &["point_follower(P, k)"],
            letters: "k a curve or circle",
            meaning: "a point stays on a curve",
            more: "`Φ = r_j + A_j k(u) − r_i^P`",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 40 mm, 0) {
    point tip = (0, 0)
    axis way  = tip along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: point_follower(rod.tip, disc.profile)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "a point and a curve",
        features: [FeatureWord::Point, FeatureWord::Curve],
        rows: &[LENGTH, LENGTH],
        coordinates: &[("u", "the argument of the curve at the point")],
        reaction: ReactionKind::Force,
        symbol: JointSymbol::Contact,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "cam",
            forms: &["cam(k, m)"],
            letters: "k and m curves or circles",
            meaning: "two curves touch",
            more: "`Φ = [r_i + A_i k(u) − r_j − A_j m(w), (A_i k'(u))^⊥ᵀ (A_j m'(w))]`: the points meet, and the tangents are \
                   parallel.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 50 mm, 0) {
    circle roller = (0, 0) radius 10 mm
    axis way      = (0, 0) along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: cam(disc.profile, rod.roller)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "two curves",
        features: [FeatureWord::Curve, FeatureWord::Curve],
        rows: &[LENGTH, LENGTH, Dimension::AREA],
        coordinates: &[
            ("u", "the argument of the first curve at the contact"),
            ("w", "the argument of the second curve there"),
        ],
        reaction: ReactionKind::Force,
        symbol: JointSymbol::Contact,
        ..PLAIN
    },
    JointSpec {
        word: Word {
            name: "flat_follower",
            forms: &["flat_follower(k, a)"],
            letters: "k a curve or circle and a an axis",
            meaning: "a curve touches a straight face",
            more: "`Φ = [v_j^⊥ᵀ(r_i + A_i k(u) − r_j^a), v_j^⊥ᵀ A_i k'(u)]`: the point is on the face, and so is the tangent.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 40 mm, 0) {
    axis face = (0, 0) along (1, 0)
    axis way  = (0, 0) along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: flat_follower(disc.profile, rod.face)
driver motor: rotation(axle) = 60 rpm * t",
            ),
            ..PLAIN.word
        },
        takes: "a curve and an axis",
        features: [FeatureWord::Curve, FeatureWord::Axis],
        rows: &[LENGTH, LENGTH],
        coordinates: &[("u", "the argument of the curve at the contact")],
        reaction: ReactionKind::Force,
        symbol: JointSymbol::Contact,
        ..PLAIN
    },
];
