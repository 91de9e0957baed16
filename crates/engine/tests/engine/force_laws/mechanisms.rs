//! Mechanisms with every kind of joint, as data: their texts are written from them, and their free bodies are looked at with them.

/// What a text is made of, all in SI. Paths are `body.point`.
pub struct Skeleton {
    pub name: &'static str,
    /// The ground first.
    pub frames: &'static [Frame],
    pub joints: &'static [Joint],
    pub equations: &'static [Equation],
    /// What loads may work on.
    pub quantities: &'static [Quantity],
}

pub struct Frame {
    pub name: &'static str,
    /// Where it is drawn.
    pub at: [f64; 3],
    pub points: &'static [(&'static str, [f64; 2])],
    /// Each through a point, along a direction.
    pub axes: &'static [(&'static str, &'static str, [f64; 2])],
    /// Each around a point.
    pub circles: &'static [(&'static str, &'static str, f64)],
}

pub struct Joint {
    pub name: &'static str,
    pub call: &'static str,
    /// The frames of its arguments.
    pub on: [&'static str; 2],
    pub reduced_to: Reduced,
    pub has_torque: bool,
}

/// Where a joint's reaction is told.
pub enum Reduced {
    To(&'static str),
    /// The contact: on a circle of a frame around a point, by the joint's own coordinate.
    ToContact {
        point: &'static str,
        radius: f64,
    },
}

/// A driver, or a constraint, whose right side is constant: a sum of quantities is a formula of time.
pub struct Equation {
    pub word: &'static str,
    pub name: &'static str,
    pub left: &'static [(f64, Quantity)],
    pub right: &'static str,
}

#[derive(Clone, Copy)]
pub enum Quantity {
    X(&'static str),
    Y(&'static str),
    Distance(&'static str, &'static str),
    Angle(&'static str),
    AngleBetween(&'static str, &'static str),
    /// Of a joint between two frames.
    Rotation(&'static str, [&'static str; 2]),
    /// Of a joint, along a direction of the frame of its first axis, to the point of its second one.
    Displacement {
        joint: &'static str,
        from: &'static str,
        along: [f64; 2],
        to: &'static str,
    },
}

use Quantity::{Angle, AngleBetween, Displacement, Distance, Rotation, X, Y};
use Reduced::{To, ToContact};

const fn frame(name: &'static str, at: [f64; 3], points: &'static [(&'static str, [f64; 2])]) -> Frame {
    Frame { name, at, points, axes: &[], circles: &[] }
}

const fn pin(name: &'static str, call: &'static str, on: [&'static str; 2], to: &'static str) -> Joint {
    Joint { name, call, on, reduced_to: To(to), has_torque: false }
}

const fn stiff(name: &'static str, call: &'static str, on: [&'static str; 2], to: &'static str) -> Joint {
    Joint { name, call, on, reduced_to: To(to), has_torque: true }
}

const fn driver(name: &'static str, left: &'static [(f64, Quantity)], right: &'static str) -> Equation {
    Equation { word: "driver", name, left, right }
}

const fn constraint(name: &'static str, left: &'static [(f64, Quantity)], right: &'static str) -> Equation {
    Equation { word: "constraint", name, left, right }
}

pub const ALL: &[Skeleton] = &[
    Skeleton {
        name: "four_bar",
        frames: &[
            frame("ground", [0.0; 3], &[("A", [0.0, 0.0]), ("D", [0.1, 0.0])]),
            frame("crank", [0.0, 0.0, 0.52], &[("A", [0.0, 0.0]), ("B", [0.04, 0.0])]),
            frame("coupler", [0.035, 0.02, 0.38], &[("B", [0.0, 0.0]), ("C", [0.12, 0.0]), ("P", [0.05, 0.04])]),
            frame("rocker", [0.1, 0.0, 0.96], &[("D", [0.0, 0.0]), ("C", [0.08, 0.0])]),
        ],
        joints: &[
            pin("a", "revolute(ground.A, crank.A)", ["ground", "crank"], "crank.A"),
            pin("b", "revolute(crank.B, coupler.B)", ["crank", "coupler"], "coupler.B"),
            pin("c", "revolute(coupler.C, rocker.C)", ["coupler", "rocker"], "rocker.C"),
            pin("d", "revolute(rocker.D, ground.D)", ["rocker", "ground"], "ground.D"),
        ],
        equations: &[driver("motor", &[(1.0, Rotation("a", ["ground", "crank"]))], "0.52 + 3 * t + 2 * t^2")],
        quantities: &[
            Distance("ground.D", "coupler.P"),
            Angle("rocker"),
            Rotation("c", ["coupler", "rocker"]),
            X("coupler.P"),
            AngleBetween("crank", "rocker"),
            Distance("crank.B", "rocker.C"),
        ],
    },
    Skeleton {
        name: "slider_crank",
        frames: &[
            Frame {
                name: "ground",
                at: [0.0; 3],
                points: &[("O", [0.0, 0.0]), ("W", [0.02, 0.01])],
                axes: &[("way", "W", [1.0, 0.1])],
                circles: &[],
            },
            frame("crank", [0.0, 0.0, 0.5], &[("O", [0.0, 0.0]), ("pin", [0.05, 0.0])]),
            frame("rod", [0.045, 0.025, -0.15], &[("pin", [0.0, 0.0]), ("wrist", [0.15, 0.0]), ("W", [0.06, 0.03])]),
            frame("plate", [0.1, 0.04, 0.15], &[("W", [0.01, 0.0])]),
            Frame {
                name: "piston",
                at: [0.19, 0.02, 0.1],
                points: &[("wrist", [0.0, 0.0]), ("S", [0.03, 0.004])],
                axes: &[("way", "S", [1.0, 0.0])],
                circles: &[],
            },
        ],
        joints: &[
            pin("main", "revolute(ground.O, crank.O)", ["ground", "crank"], "crank.O"),
            pin("big", "revolute(crank.pin, rod.pin)", ["crank", "rod"], "rod.pin"),
            pin("small", "revolute(rod.wrist, piston.wrist)", ["rod", "piston"], "piston.wrist"),
            stiff("fixed", "weld(rod.W, plate.W, 0.3)", ["rod", "plate"], "plate.W"),
            stiff("barrel", "translational(ground.way, piston.way)", ["ground", "piston"], "piston.S"),
        ],
        equations: &[driver("motor", &[(1.0, Rotation("main", ["ground", "crank"]))], "0.5 + 8 * t - 5 * t^2")],
        quantities: &[
            Displacement { joint: "barrel", from: "ground.W", along: [1.0, 0.1], to: "piston.S" },
            Rotation("big", ["crank", "rod"]),
            Y("plate.W"),
            AngleBetween("plate", "crank"),
            Distance("ground.O", "rod.W"),
        ],
    },
    Skeleton {
        name: "shaper",
        frames: &[
            Frame {
                name: "ground",
                at: [0.0; 3],
                points: &[("O", [0.0, 0.0]), ("Q", [0.0, -0.3]), ("W", [0.0, 0.285])],
                axes: &[("way", "W", [1.0, 0.0])],
                circles: &[],
            },
            frame("crank", [0.0, 0.0, 3.4], &[("O", [0.0, 0.0]), ("pin", [0.1, 0.0])]),
            Frame {
                name: "lever",
                at: [0.0, -0.3, 1.92],
                points: &[("Q", [0.0, 0.0]), ("head", [0.6, 0.0]), ("S", [0.05, 0.01])],
                axes: &[("slot", "S", [1.0, 0.0])],
                circles: &[],
            },
            Frame {
                name: "ram",
                at: [0.0, 0.285, 0.0],
                points: &[("eye", [0.0, 0.0])],
                axes: &[("way", "eye", [1.0, 0.0])],
                circles: &[],
            },
        ],
        joints: &[
            pin("main", "revolute(ground.O, crank.O)", ["ground", "crank"], "crank.O"),
            pin("hinge", "revolute(ground.Q, lever.Q)", ["ground", "lever"], "lever.Q"),
            stiff("block", "revolute_translational(crank.pin, lever.slot, 0.008)", ["crank", "lever"], "lever.S"),
            stiff("guide", "translational(ram.way, ground.way)", ["ram", "ground"], "ground.W"),
            pin("link", "revolute_revolute(lever.head, ram.eye, 0.2)", ["lever", "ram"], "ram.eye"),
        ],
        equations: &[driver("motor", &[(1.0, Rotation("main", ["ground", "crank"]))], "3.48 - 4 * t")],
        quantities: &[
            Displacement { joint: "guide", from: "ram.eye", along: [1.0, 0.0], to: "ground.W" },
            X("ram.eye"),
            Distance("lever.head", "ram.eye"),
            AngleBetween("ram", "lever"),
            Distance("crank.pin", "lever.Q"),
        ],
    },
    Skeleton {
        name: "planets",
        frames: &[
            Frame {
                name: "ground",
                at: [0.0; 3],
                points: &[("O", [-0.3, 0.7])],
                axes: &[],
                circles: &[("sun", "O", 0.4)],
            },
            frame("arm", [-0.3, 0.7, -1.7], &[("O", [0.0, 0.0]), ("P", [0.55, 0.0])]),
            Frame {
                name: "planet",
                at: [-0.4, 0.17, 1.4],
                points: &[("P", [0.01, 0.02]), ("pen", [0.0, -0.15])],
                axes: &[],
                circles: &[("pitch", "P", 0.15)],
            },
            Frame {
                name: "ring",
                at: [-0.3, 0.7, 0.2],
                points: &[("O", [0.0, 0.0]), ("lug", [0.7, 0.1])],
                axes: &[],
                circles: &[("c", "O", 0.7)],
            },
        ],
        joints: &[
            pin("hub", "revolute(ground.O, arm.O)", ["ground", "arm"], "arm.O"),
            pin("p", "revolute(arm.P, planet.P)", ["arm", "planet"], "planet.P"),
            pin("r", "revolute(ring.O, ground.O)", ["ring", "ground"], "ground.O"),
            stiff("fix", "gear(ground.sun, planet.pitch)", ["ground", "planet"], "planet.P"),
            stiff("mesh", "internal_gear(planet.pitch, ring.c)", ["planet", "ring"], "ring.O"),
        ],
        equations: &[driver("motor", &[(1.0, Angle("arm"))], "-1.7 - 0.7 * t + 0.5 * t^2")],
        quantities: &[
            AngleBetween("planet", "ring"),
            Y("planet.pen"),
            Angle("ring"),
            Distance("ground.O", "planet.pen"),
            Rotation("r", ["ring", "ground"]),
        ],
    },
    Skeleton {
        name: "rack",
        frames: &[
            frame("ground", [0.0; 3], &[("N", [0.0, 0.5])]),
            Frame {
                name: "rack",
                at: [0.1, 0.2, 0.44],
                points: &[("O", [0.0, 0.0]), ("L", [0.02, -0.01]), ("R", [0.06, 0.0])],
                axes: &[("line", "L", [3.0, 4.0]), ("rail", "R", [-3.0, -4.0])],
                circles: &[],
            },
            Frame {
                name: "carriage",
                at: [0.15, 0.22, 0.4],
                points: &[("W", [0.0, 0.0]), ("pin", [-0.005, 0.015])],
                axes: &[("way", "W", [0.0, -2.0])],
                circles: &[],
            },
            Frame {
                name: "pinion",
                at: [0.1, 0.23, 1.5],
                points: &[("pin", [0.0, 0.0])],
                axes: &[],
                circles: &[("pitch", "pin", 0.021)],
            },
        ],
        joints: &[
            stiff("guide", "translational(rack.rail, carriage.way)", ["rack", "carriage"], "carriage.W"),
            pin("pin", "revolute(carriage.pin, pinion.pin)", ["carriage", "pinion"], "pinion.pin"),
            stiff("teeth", "rack_pinion(pinion.pitch, rack.line, 0.012, right)", ["pinion", "rack"], "rack.L"),
        ],
        equations: &[
            driver("rx", &[(1.0, X("rack.O"))], "0.1 + 0.05 * sin(2 * t)"),
            driver("ry", &[(1.0, Y("rack.O"))], "0.2 - 0.03 * t"),
            driver("turn", &[(1.0, Angle("rack"))], "0.44 + 1.1 * sin(1.5 * t)^2"),
            driver(
                "feed",
                &[(1.0, Displacement { joint: "guide", from: "rack.R", along: [-3.0, -4.0], to: "carriage.W" })],
                "0.02 + 0.08 * sin(3 * t)",
            ),
        ],
        quantities: &[
            Displacement { joint: "guide", from: "rack.R", along: [-3.0, -4.0], to: "carriage.W" },
            AngleBetween("rack", "pinion"),
            X("pinion.pin"),
            Distance("ground.N", "rack.L"),
        ],
    },
    Skeleton {
        name: "disc_in_ring",
        frames: &[
            Frame {
                name: "ground",
                at: [0.0; 3],
                points: &[("O", [-1.0, 0.5])],
                axes: &[],
                circles: &[("ring", "O", 0.8)],
            },
            Frame {
                name: "disc",
                at: [-0.7, 0.16, -0.5],
                points: &[("C", [0.1, 0.0]), ("T", [0.1, 0.25])],
                axes: &[],
                circles: &[("c", "C", 0.25)],
            },
        ],
        joints: &[Joint {
            name: "contact",
            call: "cam(disc.c, ground.ring)",
            on: ["disc", "ground"],
            reduced_to: ToContact { point: "disc.C", radius: 0.25 },
            has_torque: false,
        }],
        equations: &[
            driver("push", &[(1.0, X("disc.C"))], "-0.6 - 0.25 * sin(1.2 * t)"),
            driver("turn", &[(1.0, Angle("disc"))], "-0.5 + 1.4 * t^2"),
        ],
        quantities: &[Distance("ground.O", "disc.T"), Angle("disc"), Y("disc.T")],
    },
    Skeleton {
        name: "tappets",
        frames: &[
            Frame {
                name: "ground",
                at: [0.0; 3],
                points: &[("O", [0.015, -0.005]), ("W", [0.0, 0.05])],
                axes: &[("way", "W", [-1.0, 4.0])],
                circles: &[],
            },
            Frame {
                name: "disc",
                at: [0.015, -0.005, 0.17],
                points: &[("O", [0.0, 0.0]), ("E", [0.0, 0.008])],
                axes: &[],
                circles: &[("c", "E", 0.022)],
            },
            Frame {
                name: "tappet",
                at: [0.011, 0.028, 0.07],
                points: &[("W", [0.0, 0.0]), ("F", [0.0, -0.003])],
                axes: &[("way", "W", [0.0, 1.0]), ("face", "F", [0.978, 0.208])],
                circles: &[],
            },
            frame("lever", [0.072, -0.024, 2.36], &[("H", [0.0, 0.0]), ("tip", [0.06, 0.003])]),
        ],
        joints: &[
            pin("main", "revolute(ground.O, disc.O)", ["ground", "disc"], "disc.O"),
            stiff("guide", "translational(ground.way, tappet.way)", ["ground", "tappet"], "tappet.W"),
            Joint {
                name: "face",
                call: "flat_follower(disc.c, tappet.face)",
                on: ["disc", "tappet"],
                reduced_to: ToContact { point: "disc.E", radius: 0.022 },
                has_torque: false,
            },
            pin("hinge", "revolute((0.072, -0.024), lever.H)", ["ground", "lever"], "lever.H"),
            pin("touch", "point_follower(lever.tip, disc.c)", ["lever", "disc"], "lever.tip"),
        ],
        equations: &[driver("motor", &[(1.0, Rotation("main", ["ground", "disc"]))], "0.17 + 3 * t")],
        quantities: &[
            Displacement { joint: "guide", from: "ground.W", along: [-1.0, 4.0], to: "tappet.W" },
            Rotation("main", ["ground", "disc"]),
            Angle("lever"),
            Distance("tappet.F", "lever.tip"),
        ],
    },
    Skeleton {
        name: "platform",
        frames: &[
            frame("ground", [0.0; 3], &[("A", [0.0, 0.0]), ("B", [1.0, 0.0]), ("C", [0.4, 0.9])]),
            frame("platform", [0.45, 0.3, 0.1], &[("A", [-0.15, -0.1]), ("B", [0.15, -0.1]), ("C", [0.0, 0.15])]),
        ],
        joints: &[],
        equations: &[
            driver("one", &[(1.0, Distance("ground.A", "platform.A"))], "0.36 + 0.03 * sin(2 * t)"),
            driver("two", &[(1.0, Distance("platform.B", "ground.B"))], "0.45 + 0.05 * t"),
            driver("three", &[(1.0, Distance("ground.C", "platform.C"))], "0.46 - 0.04 * sin(3 * t)"),
        ],
        quantities: &[X("platform.A"), Angle("platform"), Distance("ground.C", "platform.B"), Y("platform.C")],
    },
    Skeleton {
        name: "couplers",
        frames: &[
            frame("ground", [0.0; 3], &[("A", [0.0, 0.0]), ("B", [0.4, 0.1])]),
            frame("first", [0.0, 0.0, 0.6], &[("A", [0.0, 0.0]), ("tip", [0.15, 0.0])]),
            frame("second", [0.4, 0.1, 1.3], &[("B", [0.0, 0.0]), ("tip", [0.12, 0.02])]),
            frame("bar", [0.2, 0.25, 0.9], &[("P", [-0.05, 0.0]), ("Q", [0.1, 0.01])]),
        ],
        joints: &[
            pin("a", "revolute(ground.A, first.A)", ["ground", "first"], "first.A"),
            pin("b", "revolute(second.B, ground.B)", ["second", "ground"], "ground.B"),
        ],
        equations: &[
            constraint(
                "ratio",
                &[(1.0, Rotation("b", ["second", "ground"])), (2.0, Rotation("a", ["ground", "first"]))],
                "-0.1",
            ),
            constraint("lean", &[(1.0, AngleBetween("second", "bar")), (0.5, Angle("first"))], "-0.1"),
            constraint("path", &[(1.0, Y("bar.Q")), (-0.5, X("bar.Q"))], "0.2"),
            constraint("rope", &[(1.0, Distance("first.tip", "bar.P"))], "0.15"),
            driver("motor", &[(1.0, Rotation("a", ["ground", "first"]))], "0.6 + 0.4 * sin(2 * t)"),
        ],
        quantities: &[Distance("second.tip", "bar.Q"), Angle("bar"), X("bar.P"), AngleBetween("first", "second")],
    },
];
