//! Scene of a mechanism: bodies as links, joints and drivers as symbols after ISO 3952, meshing gears, cams and traces. Every shape names
//! its declaration.
//!
//! Lengths are metres, in the coordinates of frames; nothing here depends on pixels, colours or files. A [`Scene`] is built once, from the
//! checked mechanism and its whole [`Motion`], which decides the size of symbols, the length of guides and slots, and the direction of
//! arrows. After that the poses of all frames are enough to draw a moment.
//!
//! ```text
//! Mechanism, Motion ──▶ Scene ──view──▶ pictures and pages
//! ```

mod belts;
mod bodies;
mod builder;
mod catalogue;
mod contacts;
mod drawing;
mod drivers;
mod fault_marks;
mod features;
mod forces;
mod gears;
mod guides;
mod joints;
mod length_marks;
mod motion;
mod pins;
mod plane;
mod sizes;
mod springs;
mod symbols;
mod teeth;
mod torques;
mod track;

pub use catalogue::{Catalogue, catalogue};
pub use fault_marks::{Faults, Joints};
pub use features::drawn_poses;
pub use forces::{ForceKind, ForceValue, ForceVector};
pub use length_marks::Length;
pub use motion::{Gaps, Motion, Track};
pub use plane::{
    Contour, Path, Pose, Segment, Vector, bounds, cross, direction, distance, distance_to_segment, dot, hull,
    is_finite, left, length, minus, plus, polar, times, unit,
};
pub use torques::Torque;
pub use track::{DrawnLine, RETRACE_TOLERANCE, Stroke};

use mechc_lang::model::Mechanism;
use mechc_text::source::Span;

/// Pins of one body closer than this are one pin (symbol units).
const SAME_PIN: f64 = 1e-6;

/// Everything that is drawn of a mechanism.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the mechanism.
    pub name: String,
    /// Documentation comment of the mechanism, by line.
    pub docs: Vec<String>,
    /// Declarations that shapes and the page refer to, by index.
    pub declarations: Vec<Declaration>,
    /// Declaration of each frame: the ground, then the bodies in order. The ground of a part belongs to the frame that carries the part.
    pub frames: Vec<usize>,
    /// Named points.
    pub points: Vec<Point>,
    /// Pins of revolute joints and distances, one per body that turns about them, the ground included.
    pub pins: Vec<Pin>,
    /// Nodes in drawing order, the bottom one first.
    pub nodes: Vec<Node>,
    /// Traces of the text.
    pub traces: Vec<Trace>,
    /// Profiles that contacts run along.
    pub profiles: Vec<Profile>,
    /// Contacts between cams and followers.
    pub contacts: Vec<Contact>,
    /// Forces whose values are in the motion's table.
    pub forces: Vec<ForceVector>,
    /// Torques whose values are in the motion's table.
    pub torques: Vec<Torque>,
    /// Pitch circles and pitch lines of gears and racks. Teeth are only symbols: a text does not say how many there are.
    pub pitch_lines: Vec<PitchLine>,
    /// Size of symbols (m); a pin is a little smaller, a block a little larger.
    pub unit: f64,
    /// Lower and upper corner of the bounding box of everything along the motion (m).
    pub extent: [Vector; 2],
    /// Declarations that messages name; pictures highlight them.
    pub named: Vec<usize>,
    /// Messages at places of the ground, for a mechanism at rest.
    pub remarks: Vec<Remark>,
}

impl Scene {
    /// Builds the scene of a mechanism and its motion, which has at least one row.
    #[must_use]
    pub fn of(model: &Mechanism, motion: &Motion) -> Scene {
        builder::build(model, motion, None)
    }

    /// Builds the scene with symbols of size `unit` (m) instead of one that fits the motion.
    #[must_use]
    pub fn with_symbol_size(model: &Mechanism, motion: &Motion, unit: f64) -> Scene {
        builder::build(model, motion, Some(unit))
    }

    /// Adds the marks of faults, at the first row of the motion.
    pub fn add_fault_marks(&mut self, model: &Mechanism, motion: &Motion, faults: &Faults) {
        fault_marks::add(self, model, motion, faults);
    }

    /// Returns the scene of one body in its own frame, with everything that is fixed to it, and the motion that draws it.
    #[must_use]
    pub fn alone(&self, frame: usize) -> (Scene, Motion) {
        let mut indices = vec![None; self.points.len()];
        let mut points = Vec::new();
        for (number, point) in self.points.iter().enumerate().filter(|(_, point)| point.frame == frame) {
            indices[number] = Some(points.len());
            points.push(point.clone());
        }
        let mut nodes: Vec<Node> =
            self.nodes.iter().filter(|node| node.attachment == Attachment::Fixed(frame)).cloned().collect();
        for shape in nodes.iter_mut().flat_map(|node| &mut node.shapes) {
            shape.point = shape.point.and_then(|number| indices[number]);
        }
        let pins: Vec<Pin> = self.pins.iter().filter(|pin| pin.anchor.frame == frame).cloned().collect();
        for pin in &pins {
            self.add_pin(&mut nodes, pin, &points);
        }
        let positions = nodes.iter().flat_map(|node| &node.shapes).flat_map(|shape| shape.path.positions());
        let margin = [0.5 * self.unit; 2];
        let extent = bounds(positions).map_or(self.extent, |[low, high]| [minus(low, margin), plus(high, margin)]);
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

    /// Adds a pin that is drawn with another body, unless the body has one at this position.
    fn add_pin(&self, nodes: &mut Vec<Node>, pin: &Pin, points: &[Point]) {
        let Anchor { frame, at } = pin.anchor;
        let is_at = |other: Vector| distance(other, at) <= SAME_PIN * self.unit;
        let is_same_pin = |shape: &Shape| match shape.path {
            Path::Circle { at, .. } => shape.look == Look::Pin && is_at(at),
            Path::Lines(_) => false,
        };
        if nodes.iter().flat_map(|node| &node.shapes).any(is_same_pin) {
            return;
        }
        let point = points.iter().position(|point| is_at(point.at));
        let shape = symbols::Symbols { unit: self.unit }.pin(at, point);
        nodes.push(Node { declaration: pin.declaration, attachment: Attachment::Fixed(frame), shapes: vec![shape] });
    }

    /// Returns the bounding box of everything at the rows of a motion (m), or `None` if nothing is drawn.
    #[must_use]
    pub fn reach(&self, moments: &Motion) -> Option<[Vector; 2]> {
        builder::reach(&self.nodes, moments, self.unit)
    }

    /// Removes the marks and highlights of messages.
    pub fn clear_highlights(&mut self) {
        self.named.clear();
        self.remarks.clear();
        self.nodes.retain(|node| node.shapes.iter().any(|shape| shape.look != Look::Named));
    }

    /// Returns the point with a path such as `crank.pin`.
    #[must_use]
    pub fn point_named(&self, path: &str) -> Option<&Point> {
        self.points.iter().find(|point| point.name == path)
    }
}

/// A declaration of the text.
#[derive(Clone, PartialEq, Debug)]
pub struct Declaration {
    /// Path of the declaration.
    pub name: String,
    /// Kind in words of the language: `body`, `joint`, `driver`, `constraint`, `measure`, `trace`, `point`, …
    pub kind: &'static str,
    /// Span in the text, usually that of the name.
    pub span: Span,
}

/// A named point of a frame.
#[derive(Clone, PartialEq, Debug)]
pub struct Point {
    /// Index of its declaration.
    pub declaration: usize,
    /// Path, such as `crank.pin`.
    pub name: String,
    /// Index of its frame.
    pub frame: usize,
    /// Position in the frame (m).
    pub at: Vector,
    /// True if a joint or a distance acts at the point.
    pub is_pin: bool,
}

/// A pin on one body.
#[derive(Clone, PartialEq, Debug)]
pub struct Pin {
    /// Index of the joint or equation.
    pub declaration: usize,
    /// Position on one of the bodies that it joins.
    pub anchor: Anchor,
}

/// Text of a message at a position.
#[derive(Clone, PartialEq, Debug)]
pub struct Remark {
    /// Position in the ground's frame (m).
    pub at: Vector,
    /// Text.
    pub text: String,
}

/// A position in a frame.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Anchor {
    /// Index of the frame.
    pub frame: usize,
    /// Position in the frame (m).
    pub at: Vector,
}

impl Anchor {
    /// Returns the position in the ground's frame (m) at some poses.
    #[must_use]
    pub fn position(&self, poses: &[Pose]) -> Vector {
        poses[self.frame].transform(self.at)
    }
}

/// Shapes of one declaration that move together.
#[derive(Clone, PartialEq, Debug)]
pub struct Node {
    /// Index of the declaration.
    pub declaration: usize,
    /// Placement of the shapes.
    pub attachment: Attachment,
    /// Shapes in drawing order, the bottom one first.
    pub shapes: Vec<Shape>,
}

/// Placement of shapes: what they move with.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Attachment {
    /// In the coordinates of a frame.
    Fixed(usize),
    /// In the ground's directions, around an anchor.
    Upright(Anchor),
    /// The x axis runs from one anchor to another, y to its left.
    Between {
        /// Anchor where x begins.
        from: Anchor,
        /// Anchor where x ends.
        to: Anchor,
        /// Which end holds the shapes when the distance changes.
        alignment: Alignment,
    },
}

/// End that holds shapes between two anchors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Alignment {
    /// Their origin is the first anchor.
    Start,
    /// Their origin is the second anchor.
    End,
    /// They are stretched: x = 1 is the second anchor, y keeps its size (m).
    Stretch,
}

impl Attachment {
    /// Returns whether x runs from 0 to 1 between two anchors.
    #[must_use]
    pub fn is_stretched(&self) -> bool {
        matches!(self, Attachment::Between { alignment: Alignment::Stretch, .. })
    }

    /// Returns the pose of the shapes at some poses of all frames, and the scale of their x coordinate.
    #[must_use]
    pub fn pose(&self, poses: &[Pose]) -> (Pose, f64) {
        match self {
            Attachment::Fixed(frame) => (poses[*frame], 1.0),
            Attachment::Upright(anchor) => (Pose { at: anchor.position(poses), phi: 0.0 }, 1.0),
            Attachment::Between { from, to, alignment } => {
                let (start, end) = (from.position(poses), to.position(poses));
                let axis = minus(end, start);
                let pose = Pose { at: if *alignment == Alignment::End { end } else { start }, phi: direction(axis) };
                (pose, if *alignment == Alignment::Stretch { length(axis) } else { 1.0 })
            }
        }
    }
}

/// A path with its meaning.
#[derive(Clone, PartialEq, Debug)]
pub struct Shape {
    /// Path (m).
    pub path: Path,
    /// Meaning, which decides the style.
    pub look: Look,
    /// Index of the point that the shape shows.
    pub point: Option<usize>,
}

/// Meaning of a shape, which decides its style.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Look {
    /// Outline of a body.
    Link,
    /// Axes of a body that has nothing but its frame.
    Cross,
    /// Bar that is not a body.
    MasslessLink,
    /// Cylinder of a driven distance.
    Cylinder,
    /// Rod of a cylinder.
    Rod,
    /// Pin of a revolute joint.
    Pin,
    /// Point without a pin that a joint uses or a trace follows.
    Dot,
    /// Support of a pin on the ground.
    Support,
    /// Edge of the ground.
    GroundLine,
    /// Hatching of the ground.
    Hatching,
    /// Line that a slider runs along.
    Guide,
    /// Sliding block.
    Block,
    /// Sleeve of a sliding bar.
    Sleeve,
    /// Slot in a body or in the ground.
    Slot,
    /// Weld between two bodies.
    Weld,
    /// Gear or ring gear.
    Gear,
    /// Pitch circle or pitch line.
    Pitch,
    /// Straight row of teeth.
    Rack,
    /// Belt around pulleys.
    Belt,
    /// Filled profile of a contact.
    Cam,
    /// Profile of a contact as a line.
    Track,
    /// Roller on a cam.
    Roller,
    /// Flat face of a follower.
    Face,
    /// Spring or damper.
    Spring,
    /// Line of a driver's arrow.
    Arrow,
    /// Head of a driver's arrow.
    ArrowHead,
    /// Line of an arrow for a free motion.
    Free,
    /// Head of an arrow for a free motion.
    FreeHead,
    /// Line between the two halves of an open joint.
    Gap,
    /// Ring around one half of an open joint.
    GapEnd,
    /// Ring or line that marks what a message names.
    Named,
}

impl Look {
    /// All looks.
    pub const ALL: [Look; 31] = [
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
        Look::Belt,
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

    /// Returns its name in lower case with hyphens; style sheets use it as a class.
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
            Look::Belt => "belt",
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

/// A trace of the text.
#[derive(Clone, PartialEq, Debug)]
pub struct Trace {
    /// Index of its declaration.
    pub declaration: usize,
    /// Source of its positions.
    pub pen: Pen,
}

/// Source of a trace's positions.
#[derive(Clone, PartialEq, Debug)]
pub enum Pen {
    /// Point of a frame.
    Point(Anchor),
    /// Two formulas, whose values are the columns `NAME.x` and `NAME.y` of the table, in SI.
    Columns {
        /// Path of the trace, `NAME`.
        name: String,
        /// Index of the frame that carries the coordinates.
        frame: usize,
        /// Pose of the coordinates in that frame.
        pose: Pose,
        /// True if y points to the right of x.
        is_mirrored: bool,
    },
}

/// Pitch circle or pitch line of a gear, ring gear or rack.
#[derive(Clone, PartialEq, Debug)]
pub struct PitchLine {
    /// Index of the declaration.
    pub declaration: usize,
    /// Index of the frame.
    pub frame: usize,
    /// Path in the frame (m).
    pub path: Path,
}

/// A line that contacts run along.
#[derive(Clone, PartialEq, Debug)]
pub struct Profile {
    /// Index of the declaration of the curve or circle.
    pub declaration: usize,
    /// Index of the frame.
    pub frame: usize,
    /// True if the profile ends where it begins.
    pub is_closed: bool,
    /// Samples in order of their argument.
    pub samples: Vec<Sample>,
}

/// A contact of a cam and its follower.
#[derive(Clone, PartialEq, Debug)]
pub struct Contact {
    /// Index of the joint's declaration.
    pub declaration: usize,
    /// Index of the cam's frame.
    pub cam: usize,
    /// Index of the follower's frame.
    pub follower: usize,
    /// Part of the follower that touches the cam.
    pub touch: Touch,
}

/// Part of a follower that touches a cam, in the follower's frame (m).
#[derive(Clone, PartialEq, Debug)]
pub enum Touch {
    /// Point.
    Tip(Vector),
    /// Circle with the positions `centre + cos(w) arms[0] + sin(w) arms[1]`.
    Roller {
        /// Centre.
        centre: Vector,
        /// Vectors from the centre to the circle at w = 0 and at w = π/2.
        arms: [Vector; 2],
        /// Name of the joint coordinate that is w.
        argument: String,
    },
    /// Straight face: a point on it, and its direction.
    Face(Vector, Vector),
}

/// A point of a profile.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sample {
    /// Argument.
    pub u: f64,
    /// Position in the frame (m).
    pub at: Vector,
    /// Derivative of the position by the argument (m).
    pub tangent: Vector,
}

impl Sample {
    /// Returns the position at `part` ∈ [0, 1] of the way to `other`, on the cubic Hermite curve.
    #[must_use]
    pub fn between(&self, other: &Sample, part: f64) -> Vector {
        let (h, rest) = (other.u - self.u, 1.0 - part);
        let ends =
            plus(times(rest * rest * (1.0 + 2.0 * part), self.at), times(part * part * (1.0 + 2.0 * rest), other.at));
        let tangents = plus(times(rest, self.tangent), times(-part, other.tangent));
        plus(ends, times(h * part * rest, tangents))
    }
}
