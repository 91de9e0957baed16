//! The checked mechanism: every name resolved, every quantity in SI, every formula in one graph.
//!
//! Pure data, without meaning for mechanics yet: that a joint has equations is the business of `lower`. What stands
//! here has been found sound; nothing after `check` fails on it.

mod forces;
mod placement;
mod print;
mod quotients;
mod results;

pub use crate::vocabulary::{CompoundUnit, Dimension};
pub use forces::{Force, Load, Mass};
pub use placement::Placement;
pub use quotients::quotient;

pub use results::{Outcome, Reduction, ReductionKind};

use crate::expr::{ExprId, Graph, Symbol, TableId};
use crate::source::Span;
use crate::vocabulary;

/// A name and the place where it is declared.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Declared {
    /// In NFC.
    pub name: String,
    /// The name's place in the text.
    pub span: Span,
}

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident $of:ident $list:ident $add:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub struct $id(u32);

        impl $id {
            /// Position in the mechanism's list, from 0.
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::ops::Index<$id> for Mechanism {
            type Output = $of;
            fn index(&self, id: $id) -> &$of {
                &self.$list[id.index()]
            }
        }

        impl Mechanism {
            #[doc = concat!("Adds to `", stringify!($list), "`.")]
            pub fn $add(&mut self, item: $of) -> $id {
                self.$list.push(item);
                $id(self.$list.len() as u32 - 1)
            }
        }
    )*};
}

ids! {
    /// A part: another mechanism, once more.
    PartId Part parts add_part;
    /// A body of the mechanism.
    BodyId Body bodies add_body;
    /// A point of a body or of the ground.
    PointId Point points add_point;
    /// An axis of a body or of the ground.
    AxisId Axis axes add_axis;
    /// A circle of a body or of the ground.
    CircleId Circle circles add_circle;
    /// A curve of a body or of the ground.
    CurveId Curve curves add_curve;
    /// A joint.
    JointId Joint joints add_joint;
    /// A constraint or driver.
    EquationId Equation equations add_equation;
    /// What a `Symbol::Named` of the graph stands for.
    NamedId Named named add_named;
}

/// A mechanism that has passed `check`.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// Every formula.
    pub graph: Graph,
    /// What the graph's named symbols stand for, by their number.
    pub named: Vec<Named>,
    /// The parameters that depend on no other, by the number of their symbol.
    pub params: Vec<Param>,
    /// In the order in which they need nothing of a later one.
    pub inputs: Vec<Input>,
    /// The inputs and parameters that are led along a line, where the mechanism is led; time goes from 0 to 1 then.
    pub led: Vec<Led>,
    /// Each behind the one that it is a part of.
    pub parts: Vec<Part>,
    /// In order of declaration, those of a part where it is declared.
    /// What derivatives are taken by, by their number.
    pub variables: Vec<Variable>,
    /// Where parts ask for such derivatives in their own texts.
    pub asked_in_parts: Vec<AskedInPart>,
    /// The numbers of those that all columns are differentiated by, in the order of the columns.
    pub by: Vec<u32>,
    /// Whether what all joints exert and all drivers supply is tabulated.
    pub reactions: bool,
    /// Whether pictures are to show forces: then all reactions are tabulated as far as they are determined, and all loads, if there are masses
    /// or loads at all.
    pub pictures_forces: bool,
    /// Whether formulas hold inputs as signals, rather than what these are.
    pub has_signals: bool,
    /// In order of declaration.
    pub bodies: Vec<Body>,
    /// Declared points, and literal ones where they were met.
    pub points: Vec<Point>,
    /// In order of declaration.
    pub axes: Vec<Axis>,
    /// In order of declaration.
    pub circles: Vec<Circle>,
    /// In order of declaration.
    pub curves: Vec<Curve>,
    /// In order of declaration.
    pub joints: Vec<Joint>,
    /// Constraints and drivers, in order of declaration.
    pub equations: Vec<Equation>,
    /// The masses of bodies, in order of declaration.
    pub masses: Vec<Mass>,
    /// The acceleration of free fall (m/s²) in the ground's frame, where the outermost mechanism has it.
    pub gravity: Option<[ExprId; 2]>,
    /// In order of declaration.
    pub loads: Vec<Load>,
    /// In order of declaration.
    pub measures: Vec<Measure>,
    /// Traces, each of which is two of the measures, in order of declaration.
    pub traces: Vec<Trace>,
    /// Results, in order of declaration.
    pub outcomes: Vec<Outcome>,
    /// What they ask of the whole analysis, by the number of its symbol.
    pub reductions: Vec<Reduction>,
    /// Where results are differentiated by the variables of `by` too: the formulas of those ends of the analysis that go with these.
    pub slopes: Option<[Option<ExprId>; 2]>,
    /// So many named symbols stand for what has nothing to do with results.
    pub named_before_results: usize,
    /// Formulas that must stay positive for others to have a meaning.
    pub conditions: Vec<Condition>,
    /// What `run` does unless told otherwise.
    pub analysis: Option<Analysis>,
    /// Formulas of parameters by whose values something was decided when the text was checked: with other values of which nothing else
    /// would be decided the mechanism is the same but for these.
    pub decided: Vec<(ExprId, DecidedBy)>,
}

/// What of a formula's value decides something about the text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DecidedBy {
    /// Whether it is a finite number.
    Finite,
    /// Whether it is negative, nothing, or positive.
    Sign,
    /// All of it.
    Value,
}

impl Mechanism {
    /// One without any declaration.
    #[must_use]
    pub fn new(declared: Declared, docs: Vec<String>) -> Mechanism {
        Mechanism {
            declared,
            docs,
            graph: Graph::new(),
            named: Vec::new(),
            params: Vec::new(),
            inputs: Vec::new(),
            led: Vec::new(),
            parts: Vec::new(),
            variables: Vec::new(),
            asked_in_parts: Vec::new(),
            by: Vec::new(),
            reactions: false,
            pictures_forces: false,
            has_signals: false,
            bodies: Vec::new(),
            points: Vec::new(),
            axes: Vec::new(),
            circles: Vec::new(),
            curves: Vec::new(),
            joints: Vec::new(),
            equations: Vec::new(),
            masses: Vec::new(),
            gravity: None,
            loads: Vec::new(),
            measures: Vec::new(),
            traces: Vec::new(),
            outcomes: Vec::new(),
            reductions: Vec::new(),
            slopes: None,
            named_before_results: 0,
            conditions: Vec::new(),
            analysis: None,
            decided: Vec::new(),
        }
    }

    /// Leaves out what a mechanism has no use for while it is led: its analysis is of another time, and forces have no part in it.
    pub fn leave_what_leads(&mut self) {
        self.measures.clear();
        self.masses.clear();
        self.loads.clear();
        self.gravity = None;
        self.outcomes.clear();
        self.reductions.clear();
        self.analysis = None;
    }

    /// The ids of the bodies, in order.
    pub fn body_ids(&self) -> impl Iterator<Item = BodyId> {
        (0..self.bodies.len() as u32).map(BodyId)
    }

    /// The ids of the constraints and drivers, in order.
    pub fn equation_ids(&self) -> impl Iterator<Item = EquationId> + use<> {
        (0..self.equations.len() as u32).map(EquationId)
    }

    /// The ids of the joints, in order.
    pub fn joint_ids(&self) -> impl Iterator<Item = JointId> + use<> {
        (0..self.joints.len() as u32).map(JointId)
    }

    /// The ids of the parts, in order.
    pub fn part_ids(&self) -> impl Iterator<Item = PartId> + use<> {
        (0..self.parts.len() as u32).map(PartId)
    }

    /// The grounds of the parts, in order.
    pub fn part_frames(&self) -> impl Iterator<Item = Frame> {
        (0..self.parts.len() as u32).map(|part| Frame::Part(PartId(part)))
    }

    /// A frame's name: the body's, or `ground`.
    #[must_use]
    pub fn frame_name(&self, frame: Frame) -> &str {
        match frame {
            Frame::Ground => "ground",
            Frame::Body(body) => &self[body].declared.name,
            Frame::Part(part) => &self[part].ground_name,
        }
    }

    /// What carries a frame: a body, or the ground.
    #[must_use]
    pub fn carrier(&self, mut frame: Frame) -> Frame {
        while let Frame::Part(part) = frame {
            frame = self[part].mount;
        }
        frame
    }

    /// A frame, what carries it, and so on.
    pub fn carrier_chain(&self, frame: Frame) -> impl Iterator<Item = Frame> {
        std::iter::successors(Some(frame), |frame| match frame {
            Frame::Part(part) => Some(self[*part].mount),
            Frame::Ground | Frame::Body(_) => None,
        })
    }

    /// The part in whose text a frame's features stand.
    #[must_use]
    pub fn part_of(&self, frame: Frame) -> Option<PartId> {
        match frame {
            Frame::Ground => None,
            Frame::Body(body) => self[body].part,
            Frame::Part(part) => Some(part),
        }
    }

    /// A part and those that it stands in, the innermost first.
    pub fn parts_around(&self, part: Option<PartId>) -> impl Iterator<Item = PartId> {
        std::iter::successors(part, |&part| self[part].within)
    }

    /// Whether lengths to the left in the text of a part are lengths to the right in the ground's frame.
    #[must_use]
    pub fn is_mirrored(&self, part: Option<PartId>) -> bool {
        part.is_some_and(|part| self[part].is_mirrored)
    }
}

/// What a feature is fixed to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Frame {
    /// The body without coordinates.
    Ground,
    /// A moving body.
    Body(BodyId),
    /// What is the ground in a part; fixed on what carries the part.
    Part(PartId),
}

/// A parameter that depends on no other one.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// In SI.
    pub value: f64,
    /// Of its value.
    pub dimension: Dimension,
}

/// A signal that comes from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub declared: Declared,
    /// Its place among the inputs as they are declared, which is the number of its signal.
    pub number: usize,
    /// What it is, as a formula of time, in SI.
    pub value: ExprId,
    /// Of its value.
    pub dimension: Dimension,
}

/// An input or a parameter on its way from one value to another.
#[derive(Clone, Debug)]
pub struct Led {
    /// Its name.
    pub declared: Declared,
    /// Which of the mechanism's parameters it is, if it is one: its symbol stands for the first value then.
    pub param: Option<u32>,
    /// From and to, in SI.
    pub line: [f64; 2],
    /// Of its value.
    pub dimension: Dimension,
}

/// The declarations of another mechanism, once more.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its name, with those of the parts around it.
    pub declared: Declared,
    /// The name of its mechanism, in the text of that.
    pub text: Span,
    /// What is bound of its params, by their names there; a coordinate of a point has its own.
    pub params: Vec<(String, ExprId)>,
    /// What its inputs are.
    pub inputs: Vec<(String, ExprId)>,
    /// What its ground is called.
    pub ground_name: String,
    /// The part in whose text it is declared.
    pub within: Option<PartId>,
    /// What its ground is fixed on.
    pub mount: Frame,
    /// Where its frame is in that of the mount: x (m), y (m), phi (rad), in the handedness of the text that declares it.
    pub pose: [ExprId; 3],
    /// Whether its text is mirrored in the text that declares it.
    pub is_turned_over: bool,
    /// Whether its text is mirrored in the end.
    pub is_mirrored: bool,
}

/// A derivative by an input or parameter that the text of a part asks for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AskedInPart {
    /// The part.
    pub part: PartId,
    /// Where it does.
    pub span: Span,
    /// Whether it is that of a force.
    pub is_of_force: bool,
}

/// An input or parameter that derivatives are taken by.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name; of a coordinate of a point `A.x`.
    pub declared: Declared,
    /// What of the formulas changes: its own parameter, or a shift that is added to its formula.
    pub symbol: Symbol,
    /// Of its value.
    pub dimension: Dimension,
    /// Whether it is an angle, as far as its words tell.
    pub is_angle: bool,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The pose as written: x (m), y (m), phi (rad), in the frame of the part that declares it.
    pub pose: [ExprId; 3],
    /// Where the pose is written, if it is.
    pub pose_span: Option<Span>,
}

/// A point fixed in a frame.
#[derive(Clone, Debug)]
pub struct Point {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name; a literal point has none.
    pub name: Option<String>,
    /// Where it is written.
    pub span: Span,
    /// In the frame (m).
    pub at: [ExprId; 2],
}

/// A directed line fixed in a frame.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// A point of it.
    pub origin: PointId,
    /// Its direction in the frame, of any length but zero.
    pub direction: [ExprId; 2],
}

/// A circle fixed in a frame.
#[derive(Clone, Debug)]
pub struct Circle {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// Its centre.
    pub center: PointId,
    /// Its radius (m), positive.
    pub radius: ExprId,
}

/// A curve fixed in a frame.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// The name of its argument, a pure number.
    pub argument: String,
    /// Its points in the frame (m), with [`Named::Argument`] for the argument.
    pub at: [ExprId; 2],
    /// First estimate of the argument at a contact.
    pub estimate: Option<ExprId>,
    /// Formulas of the argument that must stay positive for the points to have a meaning.
    pub conditions: Vec<Condition>,
}

/// A line that a contact runs along.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Profile {
    /// A curve, by its argument.
    Curve(CurveId),
    /// A circle, by the angle from the x axis of its body.
    Circle(CircleId),
}

impl Profile {
    /// What it is fixed to.
    #[must_use]
    pub fn frame(self, mechanism: &Mechanism) -> Frame {
        match self {
            Profile::Curve(curve) => mechanism[curve].frame,
            Profile::Circle(circle) => mechanism[circle].frame,
        }
    }

    /// Its own name.
    #[must_use]
    pub fn name(self, mechanism: &Mechanism) -> &str {
        match self {
            Profile::Curve(curve) => &mechanism[curve].name,
            Profile::Circle(circle) => &mechanism[circle].name,
        }
    }
}

/// On which side of a rack its pinion lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// Left of the axis' direction.
    Left,
    /// Right of it.
    Right,
}

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// Its name.
    pub declared: Declared,
    /// What it holds together, and how.
    pub kind: JointKind,
}

/// The joints, with the features they join.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum JointKind {
    /// Two points coincide.
    Revolute(PointId, PointId),
    /// Two axes lie on one line.
    Translational(AxisId, AxisId),
    /// Two points coincide, and the second body keeps an angle (rad) to the first.
    Weld(PointId, PointId, ExprId),
    /// Two points keep a distance (m).
    RevoluteRevolute(PointId, PointId, ExprId),
    /// A point stays on an axis, or at an offset (m) to its left.
    RevoluteTranslational(PointId, AxisId, ExprId),
    /// Two circles roll on each other, with a phase (m) that the drawing gives if nothing else does.
    Gear {
        /// Of the first and of the second body.
        circles: [CircleId; 2],
        /// One is a ring around the other.
        internal: bool,
        /// `κ`
        phase: Option<ExprId>,
    },
    /// A circle rolls on an axis.
    RackPinion {
        /// Of the first body.
        pinion: CircleId,
        /// Of the second body.
        rack: AxisId,
        /// `κ` (m)
        phase: Option<ExprId>,
        /// Where the pinion lies, if the drawing is not to say it.
        side: Option<Side>,
    },
    /// A point stays on a line.
    PointFollower(PointId, Profile),
    /// Two lines touch.
    Cam(Profile, Profile),
    /// A line touches a straight face.
    FlatFollower(Profile, AxisId),
}

impl JointKind {
    /// The kind alone, without its features.
    #[must_use]
    pub fn plain(self) -> vocabulary::JointKind {
        use vocabulary::JointKind as Plain;
        match self {
            JointKind::Revolute(..) => Plain::Revolute,
            JointKind::Translational(..) => Plain::Translational,
            JointKind::Weld(..) => Plain::Weld,
            JointKind::RevoluteRevolute(..) => Plain::RevoluteRevolute,
            JointKind::RevoluteTranslational(..) => Plain::RevoluteTranslational,
            JointKind::Gear { internal: false, .. } => Plain::Gear,
            JointKind::Gear { internal: true, .. } => Plain::InternalGear,
            JointKind::RackPinion { .. } => Plain::RackPinion,
            JointKind::PointFollower(..) => Plain::PointFollower,
            JointKind::Cam(..) => Plain::Cam,
            JointKind::FlatFollower(..) => Plain::FlatFollower,
        }
    }

    /// The word of the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.plain().word()
    }

    /// The names of the coordinates that it brings along.
    #[must_use]
    pub fn own_coordinates(self) -> &'static [&'static str] {
        match self {
            JointKind::Gear { .. } => &["theta"],
            JointKind::PointFollower(..) | JointKind::FlatFollower(..) => &["u"],
            JointKind::Cam(..) => &["u", "w"],
            _ => &[],
        }
    }

    /// The points where it takes hold of its bodies; a curve has none.
    #[must_use]
    pub fn points(self, mechanism: &Mechanism) -> Vec<PointId> {
        let on_profile = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(mechanism[circle].center),
            Profile::Curve(_) => None,
        };
        let (first, second) = match self {
            JointKind::Revolute(p, q) | JointKind::Weld(p, q, _) | JointKind::RevoluteRevolute(p, q, _) => {
                (Some(p), Some(q))
            }
            JointKind::Translational(a, b) => (Some(mechanism[a].origin), Some(mechanism[b].origin)),
            JointKind::RevoluteTranslational(p, a, _) => (Some(p), Some(mechanism[a].origin)),
            JointKind::Gear { circles: [c, d], .. } => (Some(mechanism[c].center), Some(mechanism[d].center)),
            JointKind::RackPinion { pinion, rack, .. } => {
                (Some(mechanism[pinion].center), Some(mechanism[rack].origin))
            }
            JointKind::PointFollower(p, profile) => (Some(p), on_profile(profile)),
            JointKind::Cam(k, m) => (on_profile(k), on_profile(m)),
            JointKind::FlatFollower(profile, a) => (on_profile(profile), Some(mechanism[a].origin)),
        };
        first.into_iter().chain(second).collect()
    }

    /// The axes that it joins.
    #[must_use]
    pub fn axes(self) -> Vec<AxisId> {
        match self {
            JointKind::Translational(a, b) => vec![a, b],
            JointKind::RevoluteTranslational(_, a, _)
            | JointKind::RackPinion { rack: a, .. }
            | JointKind::FlatFollower(_, a) => vec![a],
            _ => Vec::new(),
        }
    }

    /// The lines that a contact runs along.
    fn profiles(self) -> Vec<Profile> {
        match self {
            JointKind::PointFollower(_, profile) | JointKind::FlatFollower(profile, _) => vec![profile],
            JointKind::Cam(first, second) => vec![first, second],
            _ => Vec::new(),
        }
    }

    /// The circles that it joins, those that a contact runs along too.
    #[must_use]
    pub fn circles(self) -> Vec<CircleId> {
        let on_circle = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(circle),
            Profile::Curve(_) => None,
        };
        match self {
            JointKind::Gear { circles, .. } => circles.to_vec(),
            JointKind::RackPinion { pinion, .. } => vec![pinion],
            _ => self.profiles().into_iter().filter_map(on_circle).collect(),
        }
    }

    /// The curves that a contact runs along.
    #[must_use]
    pub fn curves(self) -> Vec<CurveId> {
        let on_curve = |profile: Profile| match profile {
            Profile::Curve(curve) => Some(curve),
            Profile::Circle(_) => None,
        };
        self.profiles().into_iter().filter_map(on_curve).collect()
    }

    /// The frames of its first and of its second feature.
    #[must_use]
    pub fn frames(self, mechanism: &Mechanism) -> [Frame; 2] {
        match self {
            JointKind::Revolute(p, q) | JointKind::Weld(p, q, _) | JointKind::RevoluteRevolute(p, q, _) => {
                [mechanism[p].frame, mechanism[q].frame]
            }
            JointKind::Translational(a, b) => [mechanism[a].frame, mechanism[b].frame],
            JointKind::RevoluteTranslational(p, a, _) => [mechanism[p].frame, mechanism[a].frame],
            JointKind::Gear { circles: [c, d], .. } => [mechanism[c].frame, mechanism[d].frame],
            JointKind::RackPinion { pinion, rack, .. } => [mechanism[pinion].frame, mechanism[rack].frame],
            JointKind::PointFollower(p, profile) => [mechanism[p].frame, profile.frame(mechanism)],
            JointKind::Cam(k, m) => [k.frame(mechanism), m.frame(mechanism)],
            JointKind::FlatFollower(profile, a) => [profile.frame(mechanism), mechanism[a].frame],
        }
    }
}

/// What a named symbol of the graph stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Named {
    /// A kinematic quantity, as it is seen from the ground of a part.
    Quantity(Option<PartId>, Quantity),
    /// The time derivative of a formula, along the motion.
    Derivative(ExprId),
    /// The derivative of a formula by a variable, by its number, at fixed time.
    /// Inside a part that moves together with what is around it, by the equations of that part.
    By(ExprId, u32, Option<PartId>),
    /// An input of such a part, which is held where these derivatives are taken: what it is bound to.
    Held(PartId, ExprId),
    /// Above zero where a quantity of measures exists.
    Exists(Option<PartId>, Quantity),
    /// A number for the whole analysis, by its place among the reductions.
    Reduction(u32),
    /// A force or torque, as it is seen from the ground of a part.
    Force(Option<PartId>, Force),
    /// The argument of a curve; or of a user's function, where its formula is read on its own.
    Argument,
}

/// A scalar function of the coordinates (`elements.md`, "Kinematic quantities").
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Quantity {
    /// Global x of a point, or from one point to another (m).
    X(Option<PointId>, PointId),
    /// Global y of a point, or from one point to another (m).
    Y(Option<PointId>, PointId),
    /// Direction of a body or axis, or the angle from one to another (rad).
    Angle(Option<Direction>, Direction),
    /// Distance of two points (m).
    Distance(PointId, PointId),
    /// Angle of a revolute joint (rad), between axes if given.
    Rotation(JointId, Option<(AxisId, AxisId)>),
    /// Way of a translational joint along its first axis, to its second (m).
    Displacement(JointId, AxisId, AxisId),
    /// The angle at the second of three points, from the first to the third, in (−π, π] (rad); this and the following stand in measures
    /// alone.
    Corner([PointId; 3]),
    /// Curvature of a point's path, positive to the left (1/m).
    Curvature(PointId),
    /// x (part 0) or y (part 1) of the instant centre of a frame relative to another (m).
    Pole(Frame, Frame, u32),
    /// Length of a point's velocity (m/s).
    Speed(PointId),
    /// Between the common normal at a contact and the velocity of a frame's point there, 0 to π/2 (rad).
    PressureAngle(JointId, Frame),
    /// Sliding speed at a contact (m/s).
    Slip(JointId),
}

impl Quantity {
    /// How many time derivatives of the coordinates it holds.
    #[must_use]
    pub fn order(self) -> u8 {
        match self {
            Quantity::Curvature(_) => 2,
            Quantity::Pole(..) | Quantity::Speed(_) | Quantity::PressureAngle(..) | Quantity::Slip(_) => 1,
            _ => 0,
        }
    }

    /// Whether there are positions or velocities at which it has no value.
    #[must_use]
    pub fn may_not_exist(self) -> bool {
        matches!(self, Quantity::Corner(_) | Quantity::Curvature(_) | Quantity::Pole(..) | Quantity::PressureAngle(..))
    }

    /// Its dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Angle(..) | Quantity::Rotation(..) | Quantity::Corner(_) | Quantity::PressureAngle(..) => {
                Dimension::PURE
            }
            Quantity::Curvature(_) => Dimension::PURE.over(Dimension::LENGTH),
            Quantity::Speed(_) | Quantity::Slip(_) => Dimension::LENGTH.over(Dimension::TIME),
            Quantity::X(..)
            | Quantity::Y(..)
            | Quantity::Distance(..)
            | Quantity::Displacement(..)
            | Quantity::Pole(..) => Dimension::LENGTH,
        }
    }
}

/// A body's x axis, or an axis.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Direction {
    /// The x axis of a frame.
    Frame(Frame),
    /// An axis.
    Axis(AxisId),
}

/// A constraint or driver.
#[derive(Clone, Debug)]
pub struct Equation {
    /// Its name.
    pub declared: Declared,
    /// A driver, rather than a constraint.
    pub driver: bool,
    /// What it demands.
    pub form: EquationForm,
    /// Of both sides; as far as that is known where plain numbers stand for anything.
    pub dimension: Dimension,
    /// Whether an angle is a factor of them, as far as their words tell.
    pub is_angle: bool,
    /// Where both sides are written.
    pub written: Span,
}

/// What an equation says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EquationForm {
    /// Two formulas are equal.
    Equality(ExprId, ExprId),
    /// Two points have a distance, which is a formula without kinematic quantities (m).
    Distance(PointId, PointId, ExprId),
}

/// A number to tabulate.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub declared: Declared,
    /// Its formula.
    pub value: ExprId,
    /// What must be positive for it to have a value.
    pub conditions: Vec<Condition>,
    /// In what it is printed.
    pub units: Units,
}

/// The path of a point: two measures, `NAME.x` and `NAME.y`.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Its name.
    pub declared: Declared,
    /// The part in whose text it is declared, and in whose frame its measures are.
    pub part: Option<PartId>,
    /// The point, if it is one that is fixed to a frame.
    pub point: Option<PointId>,
    /// The place of its first measure among the measures.
    pub measure: usize,
}

/// The units of a measure and of its derivatives.
#[derive(Clone, PartialEq, Debug)]
pub struct Units {
    /// The SI unit of its value.
    pub si: String,
    /// Those in which it, its first and its second time derivative are printed.
    pub printed: [String; 3],
    /// What SI is divided by, multiplied with and divided by to be in these.
    pub scale: [f64; 3],
}

impl Units {
    /// SI; angles are told from other pure numbers.
    #[must_use]
    pub fn si(dimension: Dimension, is_angle: bool) -> Units {
        let printed = [0.0, 1.0, 2.0].map(|times| dimension.over(Dimension::TIME.to_the(times)).unit_of(is_angle));
        Units { si: printed[0].clone(), printed, scale: [1.0; 3] }
    }

    /// Another unit.
    #[must_use]
    pub fn of(unit: &CompoundUnit, is_angle: bool) -> Units {
        let printed = [0, 1, 2].map(|times| unit.per_second(times));
        Units { si: unit.dimension().unit_of(is_angle), printed, scale: unit.scale() }
    }
}

/// A formula that must be positive, for others to have a meaning.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Must be above zero.
    pub positive: ExprId,
    /// What it is.
    pub kind: ConditionKind,
    /// The formula's place.
    pub span: Span,
    /// The declaration that asks for it.
    pub owner: String,
}

/// What a condition is about.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// A prescribed distance.
    Distance,
    /// A quantity of measures; where it does not exist, they have no value.
    Existence,
    /// The interval of a motion function.
    Interval,
    /// The range of a table.
    Range(TableId),
    /// The times of the samples of an input.
    Samples(TableId),
}

/// Which times to compute.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Analysis {
    /// First time (s).
    pub from: f64,
    /// Last time (s).
    pub to: f64,
    /// Step (s).
    pub every: f64,
    /// The formulas of these three, of parameters alone.
    pub formulas: [ExprId; 3],
    /// The declaration.
    pub span: Span,
}
