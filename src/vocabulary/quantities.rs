//! The kinematic quantities: numbers that depend on where the bodies are.

use super::{Category, Example, Word};

/// A kinematic quantity.
#[derive(Debug)]
pub struct QuantityWord {
    /// What is told of it.
    pub word: Word,
    /// What it is called with, in words.
    pub takes: &'static str,
}

impl QuantityWord {
    /// The quantity of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static QuantityWord> {
        QUANTITIES.iter().find(|quantity| quantity.word.name == name)
    }
}

/// All of them.
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
    },
    QuantityWord {
        word: Word {
            name: "angle",
            category: Category::Quantity,
            forms: &["angle(b)", "angle(b, c)", "angle(b.u)", "angle(b.u, c.v)"],
            letters: "",
            meaning: "the angle of a body or axis, or that from the first to the second",
            more: "In radians, counted over whole turns: `φ_b`, or `φ_c − φ_b`. That of an axis adds the axis' angle in its body, \
                   in (−π, π].",
            example: Example::Arm("measure turned = angle(arm)"),
        },
        takes: "one body or axis, or two",
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
    },
];
