//! What there is to draw of a mechanism: its bodies as links, its joints and drivers as symbols in the manner of ISO 3952, wheels with
//! teeth that mesh, cams, traces. Everything that is drawn knows its declaration.
//!
//! Lengths are metres and directions those of frames; nothing here knows a pixel, a colour or a file. A [`Scene`] is made once, from the
//! checked mechanism and its whole [`Motion`]: that decides how large symbols are, how long guides and slots have to be, and which way
//! arrows point. A moment is then nothing but the poses of all frames.
//!
//! ```text
//! Mechanism, Motion ──▶ Scene ──view──▶ pictures and pages
//! ```

mod bodies;
mod catalogue;
mod contacts;
mod drawing;
mod drivers;
mod faults;
mod features;
mod forces;
mod gears;
mod guides;
mod joints;
mod lengths;
mod motion;
mod pins;
mod plane;
mod sizes;
mod springs;
mod symbols;
mod teeth;
mod torques;
mod track;
mod whole;

pub use catalogue::catalogue;
pub use faults::{Faults, Joints};
pub use features::drawn_poses;
pub use forces::{ForceKind, ForceValue, ForceVector};
pub use lengths::Length;
pub use motion::{Gaps, Motion, Track};
pub use plane::{
    Contour, Path, Pose, Segment, Vector, bounds, cross, direction, distance, dot, hull, is_finite, left, length,
    minus, plus, polar, times, unit,
};
pub use torques::Torque;
pub use track::{DrawnLine, RETRACE_TOLERANCE, Stroke};

use mechc_lang::model::Mechanism;
use mechc_text::source::Span;

/// Pins of one body that are no farther apart than this, in units, are one.
const SAME_PLACE: f64 = 1e-6;

/// All that there is to draw.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The mechanism's name.
    pub name: String,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// All that can be pointed at.
    pub declarations: Vec<Declaration>,
    /// The declaration of each frame: the ground, then the bodies in their order. What is the ground in a part is folded into what
    /// carries the part.
    pub frames: Vec<usize>,
    /// Points that have a name.
    pub points: Vec<Point>,
    /// What turns about a pin, each body by itself; the ground too.
    pub pins: Vec<Pin>,
    /// From the one that is drawn first, below all others, to the last.
    pub nodes: Vec<Node>,
    /// Paths of points that the text asks for.
    pub traces: Vec<Trace>,
    /// Lines that contacts run along.
    pub profiles: Vec<Profile>,
    /// Where cams move followers.
    pub contacts: Vec<Contact>,
    /// Forces, where the motion's table tells them.
    pub forces: Vec<ForceVector>,
    /// Torques, likewise.
    pub torques: Vec<Torque>,
    /// The circles and lines on which wheels, rings and racks roll. Their teeth are symbols: a text does not say how many there are.
    pub pitch_lines: Vec<PitchLine>,
    /// The size of symbols (m): a pin is a little smaller, a block a little larger.
    pub unit: f64,
    /// The least and the greatest coordinates of all that is drawn along the motion (m).
    pub extent: [Vector; 2],
    /// The declarations that messages name, which stand out.
    pub named: Vec<usize>,
    /// What messages say of places at rest.
    pub remarks: Vec<Remark>,
}

impl Scene {
    /// What there is to draw of a mechanism that moves so; the motion has one row at least.
    #[must_use]
    pub fn of(model: &Mechanism, motion: &Motion) -> Scene {
        whole::scene(model, motion, None)
    }

    /// The same with symbols of a size (m), be the motion as large as it may.
    #[must_use]
    pub fn with_symbols(model: &Mechanism, motion: &Motion, unit: f64) -> Scene {
        whole::scene(model, motion, Some(unit))
    }

    /// Shows what is the matter with the mechanism that it is of; where that has no motion, at its only moment.
    pub fn show_faults(&mut self, model: &Mechanism, motion: &Motion, faults: &Faults) {
        faults::add(self, model, motion, faults);
    }

    /// One body by itself in its own frame, with all that is fixed to it, and the moment at which it is drawn.
    #[must_use]
    pub fn alone(&self, frame: usize) -> (Scene, Motion) {
        let mut numbers = vec![None; self.points.len()];
        let mut points = Vec::new();
        for (number, point) in self.points.iter().enumerate().filter(|(_, point)| point.frame == frame) {
            numbers[number] = Some(points.len());
            points.push(point.clone());
        }
        let mut nodes: Vec<Node> =
            self.nodes.iter().filter(|node| node.place == Place::Fixed(frame)).cloned().collect();
        for shape in nodes.iter_mut().flat_map(|node| &mut node.shapes) {
            shape.point = shape.point.and_then(|number| numbers[number]);
        }
        let pins: Vec<Pin> = self.pins.iter().filter(|pin| pin.anchor.frame == frame).cloned().collect();
        for pin in &pins {
            self.add_pin(&mut nodes, pin, &points);
        }
        let places = nodes.iter().flat_map(|node| &node.shapes).flat_map(|shape| shape.path.places());
        let margin = [0.5 * self.unit; 2];
        let extent = bounds(places).map_or(self.extent, |[low, high]| [minus(low, margin), plus(high, margin)]);
        let profiles = self.profiles.iter().filter(|profile| profile.frame == frame).cloned().collect();
        let pitch_lines = self.pitch_lines.iter().filter(|line| line.frame == frame).cloned().collect();
        let (traces, contacts, forces, torques) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (named, remarks) = (Vec::new(), Vec::new());
        let scene = Scene {
            points,
            pins,
            nodes,
            traces,
            profiles,
            contacts,
            forces,
            torques,
            pitch_lines,
            extent,
            named,
            remarks,
            ..self.clone()
        };
        (scene, Motion::still(vec![Pose::default(); self.frames.len()]))
    }

    /// Adds a pin that is drawn with another body, unless there is one in its place.
    fn add_pin(&self, nodes: &mut Vec<Node>, pin: &Pin, points: &[Point]) {
        let Anchor { frame, at } = pin.anchor;
        let is_here = |other: Vector| distance(other, at) <= SAME_PLACE * self.unit;
        let is_there = |shape: &Shape| match shape.path {
            Path::Circle { at, .. } => shape.look == Look::Pin && is_here(at),
            Path::Lines(_) => false,
        };
        if nodes.iter().flat_map(|node| &node.shapes).any(is_there) {
            return;
        }
        let point = points.iter().position(|point| is_here(point.at));
        let shape = symbols::Symbols { unit: self.unit }.pin(at, point);
        nodes.push(Node { declaration: pin.declaration, place: Place::Fixed(frame), shapes: vec![shape] });
    }

    /// The least and the greatest coordinates of all that is drawn at the moments of a motion (m); none where there is nothing.
    #[must_use]
    pub fn reach(&self, moments: &Motion) -> Option<[Vector; 2]> {
        whole::reach(&self.nodes, moments, self.unit)
    }

    /// Takes away what shows what messages name.
    pub fn name_nothing(&mut self) {
        self.named.clear();
        self.remarks.clear();
        self.nodes.retain(|node| node.shapes.iter().any(|shape| shape.look != Look::Named));
    }

    /// The point of a path such as `crank.pin`.
    #[must_use]
    pub fn point_named(&self, path: &str) -> Option<&Point> {
        self.points.iter().find(|point| point.name == path)
    }
}

/// Something of the text.
#[derive(Clone, PartialEq, Debug)]
pub struct Declaration {
    /// Its path.
    pub name: String,
    /// The word of the language: `body`, `joint`, `driver`, `constraint`, `measure`, `trace`, `point`, …
    pub kind: &'static str,
    /// Its place: that of its name, unless more is known.
    pub span: Span,
}

/// A point of a frame that has a name.
#[derive(Clone, PartialEq, Debug)]
pub struct Point {
    /// Which declaration it is.
    pub declaration: usize,
    /// Its path, `crank.pin`.
    pub name: String,
    /// The number of its frame.
    pub frame: usize,
    /// In that frame (m).
    pub at: Vector,
    /// Whether a joint takes hold there.
    pub is_pin: bool,
}

/// A place in which a pin is.
#[derive(Clone, PartialEq, Debug)]
pub struct Pin {
    /// The joint or equation.
    pub declaration: usize,
    /// Where it is in one of those that it joins.
    pub anchor: Anchor,
}

/// Words of a message that belong to a place.
#[derive(Clone, PartialEq, Debug)]
pub struct Remark {
    /// Of the ground (m).
    pub at: Vector,
    /// What is said of it.
    pub text: String,
}

/// A place in a frame.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Anchor {
    /// The number of the frame.
    pub frame: usize,
    /// In the frame (m).
    pub at: Vector,
}

impl Anchor {
    /// Where it is at a moment (m).
    #[must_use]
    pub fn placed(&self, poses: &[Pose]) -> Vector {
        poses[self.frame].placed(self.at)
    }
}

/// What is drawn of a declaration in one place.
#[derive(Clone, PartialEq, Debug)]
pub struct Node {
    /// Whose it is.
    pub declaration: usize,
    /// What its shapes move with.
    pub place: Place,
    /// From the first to the last that is drawn.
    pub shapes: Vec<Shape>,
}

/// What shapes move with.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Place {
    /// They are in the frame's own coordinates.
    Fixed(usize),
    /// They keep the ground's directions, around a place.
    Upright(Anchor),
    /// x runs from one place to another, y to the left of that way.
    Between {
        /// The one.
        from: Anchor,
        /// The other.
        to: Anchor,
        /// What happens where the two come nearer.
        held: Held,
    },
}

/// Which end a shape between two places is held at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Held {
    /// Its origin is where the way begins.
    From,
    /// Its origin is where the way ends.
    To,
    /// It is stretched along the way, whose length is 1 to it; across it keeps its size (m).
    Stretched,
}

impl Place {
    /// Whether x runs from 0 to 1 between its two places.
    #[must_use]
    pub fn is_stretched(&self) -> bool {
        matches!(self, Place::Between { held: Held::Stretched, .. })
    }

    /// Where its shapes are at a moment, and by what x is stretched.
    #[must_use]
    pub fn pose(&self, poses: &[Pose]) -> (Pose, f64) {
        match self {
            Place::Fixed(frame) => (poses[*frame], 1.0),
            Place::Upright(anchor) => (Pose { at: anchor.placed(poses), phi: 0.0 }, 1.0),
            Place::Between { from, to, held } => {
                let (start, end) = (from.placed(poses), to.placed(poses));
                let way = minus(end, start);
                let pose = Pose { at: if *held == Held::To { end } else { start }, phi: direction(way) };
                (pose, if *held == Held::Stretched { length(way) } else { 1.0 })
            }
        }
    }
}

/// A path and what it stands for.
#[derive(Clone, PartialEq, Debug)]
pub struct Shape {
    /// In metres.
    pub path: Path,
    /// What it stands for.
    pub look: Look,
    /// The point that it shows, by its number.
    pub point: Option<usize>,
}

/// What a shape stands for, which decides how it is drawn.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Look {
    /// A body.
    Link,
    /// A body of which nothing is known but its frame.
    Cross,
    /// A bar that is no body of its own.
    MasslessLink,
    /// Of a driven distance: the cylinder, and its rod.
    Cylinder,
    /// The rod in a cylinder.
    Rod,
    /// Bodies can turn about it.
    Pin,
    /// A place that a joint takes hold of without a pin, or that draws a trace.
    Dot,
    /// What holds a pin on the ground.
    Support,
    /// The edge of the ground.
    GroundLine,
    /// What tells the ground from bodies.
    Hatching,
    /// A line that something slides along.
    Guide,
    /// What slides.
    Block,
    /// What holds a bar that slides.
    Sleeve,
    /// A slot in a body or in the ground.
    Slot,
    /// Bodies are fixed to each other.
    Weld,
    /// A wheel with teeth, or a ring.
    Gear,
    /// A circle or line on which wheels roll.
    Pitch,
    /// A straight row of teeth.
    Rack,
    /// What a contact runs along, filled.
    Cam,
    /// What a contact runs along, as a line.
    Track,
    /// What runs on a cam.
    Roller,
    /// A flat face on a cam.
    Face,
    /// A spring, or a damper.
    Spring,
    /// What a driver does: the line of an arrow.
    Arrow,
    /// The head of an arrow.
    ArrowHead,
    /// What nothing holds: the line of an arrow.
    Free,
    /// The head of such an arrow.
    FreeHead,
    /// From one half of an open joint to the other.
    Gap,
    /// A half of an open joint.
    GapEnd,
    /// A ring around what a message names.
    Named,
}

impl Look {
    /// All of them.
    pub const ALL: [Look; 30] = [
        Look::Link,
        Look::Cross,
        Look::MasslessLink,
        Look::Cylinder,
        Look::Rod,
        Look::Pin,
        Look::Dot,
        Look::Support,
        Look::GroundLine,
        Look::Hatching,
        Look::Guide,
        Look::Block,
        Look::Sleeve,
        Look::Slot,
        Look::Weld,
        Look::Gear,
        Look::Pitch,
        Look::Rack,
        Look::Cam,
        Look::Track,
        Look::Roller,
        Look::Face,
        Look::Spring,
        Look::Arrow,
        Look::ArrowHead,
        Look::Free,
        Look::FreeHead,
        Look::Gap,
        Look::GapEnd,
        Look::Named,
    ];

    /// A word for it, of small letters and hyphens.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Look::Link => "link",
            Look::Cross => "cross",
            Look::MasslessLink => "massless",
            Look::Cylinder => "cylinder",
            Look::Rod => "rod",
            Look::Pin => "pin",
            Look::Dot => "dot",
            Look::Support => "support",
            Look::GroundLine => "ground-line",
            Look::Hatching => "hatching",
            Look::Guide => "guide",
            Look::Block => "block",
            Look::Sleeve => "sleeve",
            Look::Slot => "slot",
            Look::Weld => "weld",
            Look::Gear => "gear",
            Look::Pitch => "pitch",
            Look::Rack => "rack",
            Look::Cam => "cam",
            Look::Track => "track",
            Look::Roller => "roller",
            Look::Face => "face",
            Look::Spring => "spring",
            Look::Arrow => "arrow",
            Look::ArrowHead => "arrow-head",
            Look::Free => "free",
            Look::FreeHead => "free-head",
            Look::Gap => "gap",
            Look::GapEnd => "gap-end",
            Look::Named => "named-ring",
        }
    }
}

/// The path of a point that the text asks for.
#[derive(Clone, PartialEq, Debug)]
pub struct Trace {
    /// Which declaration it is.
    pub declaration: usize,
    /// What draws it.
    pub pen: Pen,
}

/// What draws a trace.
#[derive(Clone, PartialEq, Debug)]
pub enum Pen {
    /// A point of a frame.
    Point(Anchor),
    /// Two formulas, whose values are the columns `NAME.x` and `NAME.y` of the table, in SI.
    Columns {
        /// The trace's path, `NAME`.
        name: String,
        /// What their frame is fixed to.
        frame: usize,
        /// Where their frame is in that one.
        pose: Pose,
        /// Whether their y axis points to the right of their x axis.
        is_mirrored: bool,
    },
}

/// What a wheel, ring or rack rolls on.
#[derive(Clone, PartialEq, Debug)]
pub struct PitchLine {
    /// Whose it is.
    pub declaration: usize,
    /// The number of its frame.
    pub frame: usize,
    /// In the frame (m).
    pub path: Path,
}

/// A line that contacts run along.
#[derive(Clone, PartialEq, Debug)]
pub struct Profile {
    /// Which declaration it is: the curve or circle.
    pub declaration: usize,
    /// The number of its frame.
    pub frame: usize,
    /// Whether it ends where it begins.
    pub is_closed: bool,
    /// Places on it, by rising argument.
    pub samples: Vec<Sample>,
}

/// A cam and what it moves.
#[derive(Clone, PartialEq, Debug)]
pub struct Contact {
    /// The joint.
    pub declaration: usize,
    /// The number of the cam's frame.
    pub cam: usize,
    /// The number of the follower's frame.
    pub follower: usize,
    /// What of the follower touches the cam.
    pub touch: Touch,
}

/// What of a follower touches a cam, in the follower's frame (m).
#[derive(Clone, PartialEq, Debug)]
pub enum Touch {
    /// A point.
    Tip(Vector),
    /// A circle, at the place `centre + cos(w) arms[0] + sin(w) arms[1]`.
    Roller {
        /// Its centre.
        centre: Vector,
        /// From the centre to the circle where the argument is 0, and where it is a quarter of a turn.
        arms: [Vector; 2],
        /// The name of the joint's coordinate that is the argument.
        argument: String,
    },
    /// A straight face: a place of it, and its direction.
    Face(Vector, Vector),
}

/// A place on a profile.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sample {
    /// The argument.
    pub u: f64,
    /// In the frame (m).
    pub at: Vector,
    /// How that changes with the argument (m).
    pub tangent: Vector,
}

impl Sample {
    /// A place between this one and another, on the cubic through both with their tangents.
    #[must_use]
    pub fn between(&self, other: &Sample, part: f64) -> Vector {
        let (h, rest) = (other.u - self.u, 1.0 - part);
        let ends =
            plus(times(rest * rest * (1.0 + 2.0 * part), self.at), times(part * part * (1.0 + 2.0 * rest), other.at));
        let ways = plus(times(rest, self.tangent), times(-part, other.tangent));
        plus(ends, times(h * part * rest, ways))
    }
}
