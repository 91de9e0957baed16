//! Quantities: numbers that depend on the positions of bodies and on the forces between them.

use super::{Category, Dimension, Example, Word};
use std::hash::{Hash, Hasher};

/// A kinematic quantity.
#[derive(Debug)]
pub struct QuantityWord {
    /// Documentation.
    pub word: Word,
    /// Arguments in words.
    pub takes: &'static str,
    /// What it depends on.
    pub kind: QuantityKind,
}

/// Largest number of arguments of a measured quantity.
pub const MOST_ARGUMENTS: usize = 3;

/// What a quantity depends on.
#[derive(Clone, Copy, Debug)]
pub enum QuantityKind {
    /// Positions alone; it may stand in equations.
    Position,
    /// The motion; it may stand only in measures, traces and results.
    Measured(MeasuredQuantity),
    /// Forces; it may stand only in measures and results.
    Force,
}

/// A quantity of the motion. Its formula is in the lowering, by its name.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredQuantity {
    /// Kinds of its arguments, [`MOST_ARGUMENTS`] at the most.
    pub arguments: &'static [QuantityArgument],
    /// Dimension.
    pub dimension: Dimension,
    /// Highest order of time derivatives of the coordinates in it.
    pub order: u8,
    /// True if it has no value at some positions or velocities.
    pub may_not_exist: bool,
}

impl MeasuredQuantity {
    /// Returns whether it takes so many arguments.
    #[must_use]
    pub fn accepts(&self, count: usize) -> bool {
        let fewest = self.arguments.iter().filter(|kind| **kind != QuantityArgument::BodyOrGround).count();
        (fewest..=self.arguments.len()).contains(&count)
    }
}

/// Kind of an argument of a measured quantity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum QuantityArgument {
    /// A point.
    Point,
    /// A body.
    Body,
    /// A body; the ground if the argument, which is the last, is left out.
    BodyOrGround,
    /// A joint that is a contact.
    Contact,
}

impl PartialEq for QuantityWord {
    fn eq(&self, other: &QuantityWord) -> bool {
        self.word.name == other.word.name
    }
}

impl Eq for QuantityWord {}

impl Hash for QuantityWord {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.word.name.hash(state);
    }
}

impl QuantityWord {
    /// Returns the quantity of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static QuantityWord> {
        QUANTITIES.iter().find(|quantity| quantity.word.name == name)
    }

    /// Returns whether a function or table of the mechanism with this name replaces it, so that texts may use the name.
    #[must_use]
    pub fn gives_way(&self) -> bool {
        !matches!(self.kind, QuantityKind::Position)
    }

    /// Returns whether it depends on forces, not only on positions and their rates.
    #[must_use]
    pub fn is_force(&self) -> bool {
        matches!(self.kind, QuantityKind::Force)
    }

    /// Returns what a measured quantity takes and gives.
    #[must_use]
    pub fn measured(&self) -> Option<MeasuredQuantity> {
        match self.kind {
            QuantityKind::Measured(measured) => Some(measured),
            _ => None,
        }
    }
}

/// Example of an eccentric that lifts a tappet.
const CAM: &str = "\
ground {
    point O   = (0, 0)
    axis  way = (0, 0) along (0, 1)
}
body disc {
    point  O   = (0, 0)
    circle rim = (10 mm, 0) radius 30 mm
}
body tappet at (0, 40 mm, 0) {
    point tip = (0, 0)
    axis  way = (0, 0) along (0, 1)
}
joint axle:  revolute(ground.O, disc.O)
joint guide: translational(ground.way, tappet.way)
joint touch: point_follower(tappet.tip, disc.rim)
driver motor: rotation(axle) = 60 rpm * t + 40 deg
measure steep = pressure_angle(touch, tappet) in deg
measure rub   = slip(touch) in mm/s";

/// All quantities.
pub static QUANTITIES: &[QuantityWord] = &[
    QuantityWord {
        word: Word {
            name: "x",
            category: Category::Quantity,
            forms: &["x(P)", "x(P, Q)"],
            letters: "",
            meaning: "the x coordinate of a point, or that of Q less that of P",
            more: "A length, along the ground's x axis: `x^P`, or `x^Q − x^P`.",
            example: Example::Arm("measure reach = x(arm.tip)"),
        },
        takes: "one point, or two",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "y",
            category: Category::Quantity,
            forms: &["y(P)", "y(P, Q)"],
            letters: "",
            meaning: "the y coordinate of a point, or that of Q less that of P",
            more: "A length, along the ground's y axis: `y^P`, or `y^Q − y^P`.",
            example: Example::Arm("measure height = y(ground.O, arm.tip)"),
        },
        takes: "one point, or two",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "angle",
            category: Category::Quantity,
            forms: &["angle(b)", "angle(b, c)", "angle(b.u)", "angle(b.u, c.v)", "angle(P, Q, R)"],
            letters: "",
            meaning: "the angle of a body or axis, or that from the first to the second",
            more: "In radians, counted over whole turns: `φ_b`, or `φ_c − φ_b`. That of an axis adds the axis' angle in its body, \
                   in (−π, π]. In measures and traces alone, `angle(P, Q, R)` is the angle at the point Q, from P to R, in (−π, π]: a \
                   transmission angle. Where Q coincides with P or R it has no value.",
            example: Example::Arm(
                "measure turned = angle(arm)\nmeasure seen   = angle((100 mm, 0), ground.O, arm.tip)",
            ),
        },
        takes: "one body or axis, or two; in a measure three points too",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "distance",
            category: Category::Quantity,
            forms: &["distance(P, Q)"],
            letters: "",
            meaning: "the distance between two points",
            more: "`√(dᵀd)`, d from P to Q. Alone on the left of `=`, with no kinematic quantity on the right, it becomes the \
                   equation `dᵀd − C² = 0`, where C, the right side, is the distance and must be positive.",
            example: Example::Arm("measure reach = distance((200 mm, 50 mm), arm.tip)"),
        },
        takes: "two points",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "rotation",
            category: Category::Quantity,
            forms: &["rotation(joint)", "rotation(joint, b.u, c.v)"],
            letters: "",
            meaning: "how far the second body of a revolute joint is turned against the first",
            more: "In radians, counted over whole turns: `(φ_j + θ_j) − (φ_i + θ_i)`, θ the angles of the axes u and v in their \
                   bodies, 0 if they are not given. u is an axis of the joint's first body, v of its second.",
            example: Example::Arm("driver motor: rotation(main) = 60 rpm * t"),
        },
        takes: "a joint, or a joint and two axes",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "displacement",
            category: Category::Quantity,
            forms: &["displacement(joint)"],
            letters: "",
            meaning: "how far the second body of a translational joint has moved along the first one's axis",
            more: "A length: `v_iᵀ d`, v_i the unit direction of the first axis, d from its point to that of the second axis.",
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
        },
        takes: "one argument, a joint",
        kind: QuantityKind::Position,
    },
    QuantityWord {
        word: Word {
            name: "curvature",
            category: Category::Quantity,
            forms: &["curvature(P)"],
            letters: "",
            meaning: "the curvature of the path of a point, in a measure",
            more: "In 1/m, positive where the path bends to the left: `(v^⊥)ᵀ a / |v|³`. Where the point is slower than 1e-9·L/T, L the mechanism's \
                   size and T the length of the analysis, it has no value.",
            example: Example::Arm("measure bend = curvature(arm.tip)"),
        },
        takes: "one point",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Point],
            dimension: Dimension::CURVATURE,
            order: 2,
            may_not_exist: true,
        }),
    },
    QuantityWord {
        word: Word {
            name: "pole_x",
            category: Category::Quantity,
            forms: &["pole_x(b)", "pole_x(b, c)"],
            letters: "b and c bodies",
            meaning: "x of the instant centre of b relative to c, or to the ground, in a measure",
            more: "In the ground's frame: where the points of both have the same velocity. Where the bodies do not turn against each other \
                   it has no value.",
            example: Example::Arm("measure centre = pole_x(arm)"),
        },
        takes: "one body, or two",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Body, QuantityArgument::BodyOrGround],
            dimension: Dimension::LENGTH,
            order: 1,
            may_not_exist: true,
        }),
    },
    QuantityWord {
        word: Word {
            name: "pole_y",
            category: Category::Quantity,
            forms: &["pole_y(b)", "pole_y(b, c)"],
            letters: "b and c bodies",
            meaning: "y of the instant centre of b relative to c, or to the ground, in a measure",
            more: "In the ground's frame: where the points of both have the same velocity. Where the bodies do not turn against each other \
                   it has no value.",
            example: Example::Arm("measure centre = pole_y(arm)"),
        },
        takes: "one body, or two",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Body, QuantityArgument::BodyOrGround],
            dimension: Dimension::LENGTH,
            order: 1,
            may_not_exist: true,
        }),
    },
    QuantityWord {
        word: Word {
            name: "speed",
            category: Category::Quantity,
            forms: &["speed(P)"],
            letters: "",
            meaning: "the length of the velocity of a point, in a measure",
            more: "In m/s, never negative.",
            example: Example::Arm("measure fast = speed(arm.tip) in mm/s"),
        },
        takes: "one point",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Point],
            dimension: Dimension::SPEED,
            order: 1,
            may_not_exist: false,
        }),
    },
    QuantityWord {
        word: Word {
            name: "pressure_angle",
            category: Category::Quantity,
            forms: &["pressure_angle(J, b)"],
            letters: "J a `point_follower`, `cam` or `flat_follower`, b a body",
            meaning: "the angle between the common normal at a contact and the velocity of a body's point there, in a measure",
            more: "In radians, 0 to 90 deg. Where that point is slower than 1e-9·L/T, L the mechanism's size and T the length of the \
                   analysis, it has no value.",
            example: Example::Whole(CAM),
        },
        takes: "a joint and a body",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Contact, QuantityArgument::Body],
            dimension: Dimension::ANGLE,
            order: 1,
            may_not_exist: true,
        }),
    },
    QuantityWord {
        word: Word {
            name: "slip",
            category: Category::Quantity,
            forms: &["slip(J)"],
            letters: "J a `point_follower`, `cam` or `flat_follower`",
            meaning: "the speed at which the two bodies of a contact slide on each other, in a measure",
            more: "In m/s, never negative.",
            example: Example::Whole(CAM),
        },
        takes: "one argument, a joint",
        kind: QuantityKind::Measured(MeasuredQuantity {
            arguments: &[QuantityArgument::Contact],
            dimension: Dimension::SPEED,
            order: 1,
            may_not_exist: false,
        }),
    },
    force(
        "effort",
        &["effort(D)"],
        "D a driver or constraint",
        "what a driver or constraint supplies, in a measure or result",
        "It works on the left side less the right side of D as written: a torque (N·m) on an angle, a force (N) on a length. For a driver \
         `K = C(t)`, `effort(D) * der(K)` is its power.",
        "one argument, a driver or constraint",
        "measure torque = effort(motor)\nmeasure power  = effort(motor) * der(rotation(main)) in W",
    ),
    force(
        "force_x",
        &["force_x(J)"],
        "J a joint",
        "x of what a joint exerts on the body of its second argument, in a measure or result",
        "In N, in the frame of who asks, and on the ground where that is the second. It is what the joint's own equations exert: no driver's \
         effort, no load on its rotation or displacement.",
        "one argument, a joint",
        "measure bearing = hypot(force_x(main), force_y(main))",
    ),
    force(
        "force_y",
        &["force_y(J)"],
        "J a joint",
        "y of what a joint exerts on the body of its second argument, in a measure or result",
        "In N, in the frame of who asks, and on the ground where that is the second. It is what the joint's own equations exert: no driver's \
         effort, no load on its rotation or displacement.",
        "one argument, a joint",
        "measure bearing = hypot(force_x(main), force_y(main))",
    ),
    QuantityWord {
        word: Word {
            example: Example::Whole(
                "\
ground { axis way = (0, 0) along (1, 0) }
body slide {
    axis way = (0, 0) along (1, 0)
    mass 2 kg at (0, 50 mm)
}
joint guide: translational(ground.way, slide.way)
driver piston: displacement(guide) = 50 mm * sin(3 rad/s * t)
measure tilt = torque(guide)",
            ),
            ..TORQUE.word
        },
        ..TORQUE
    },
];

const TORQUE: QuantityWord = force(
    "torque",
    &["torque(J)"],
    "J a joint that keeps its bodies from turning, a gear, a belt or a rack",
    "the moment that a joint exerts on the body of its second argument, in a measure or result",
    "In N·m, positive counter-clockwise: about the point of a `weld`, the second axis' point of `translational`, \
     `revolute_translational` and `rack_pinion`, the second circle's centre of gears and belts. That of a `revolute` is zero by its kind: what a \
     motor supplies there is `effort(motor)`.",
    "one argument, a joint",
    "",
);

/// Creates a quantity of forces.
const fn force(
    name: &'static str,
    forms: &'static [&'static str],
    letters: &'static str,
    meaning: &'static str,
    more: &'static str,
    takes: &'static str,
    example: &'static str,
) -> QuantityWord {
    let example = Example::Arm(example);
    let word = Word { name, category: Category::Quantity, forms, letters, meaning, more, example };
    QuantityWord { word, takes, kind: QuantityKind::Force }
}
