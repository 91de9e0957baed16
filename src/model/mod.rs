//! The checked mechanism: every name resolved, every quantity in SI, every formula in one graph.
//!
//! Pure data, without meaning for mechanics yet: that a joint has equations is the business of `lower`. What stands
//! here has been found sound; nothing after `check` fails on it.

mod dimension;
mod print;

pub use dimension::Dimension;

use crate::expr::{ExprId, Graph};
use crate::source::Span;

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
    /// A body of the mechanism.
    BodyId Body bodies add_body;
    /// A point of a body or of the ground.
    PointId Point points add_point;
    /// An axis of a body or of the ground.
    AxisId Axis axes add_axis;
    /// A joint.
    JointId Joint joints add_joint;
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
    /// In order of declaration.
    pub bodies: Vec<Body>,
    /// Declared points, and literal ones where they were met.
    pub points: Vec<Point>,
    /// In order of declaration.
    pub axes: Vec<Axis>,
    /// In order of declaration.
    pub joints: Vec<Joint>,
    /// Constraints and drivers, in order of declaration.
    pub equations: Vec<Equation>,
    /// In order of declaration.
    pub measures: Vec<Measure>,
    /// Formulas that must stay positive for others to have a meaning.
    pub conditions: Vec<Condition>,
    /// What `run` does unless told otherwise.
    pub analysis: Option<Analysis>,
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
            bodies: Vec::new(),
            points: Vec::new(),
            axes: Vec::new(),
            joints: Vec::new(),
            equations: Vec::new(),
            measures: Vec::new(),
            conditions: Vec::new(),
            analysis: None,
        }
    }

    /// The ids of the bodies, in order.
    pub fn body_ids(&self) -> impl Iterator<Item = BodyId> {
        (0..self.bodies.len() as u32).map(BodyId)
    }

    /// A frame's name: the body's, or `ground`.
    #[must_use]
    pub fn frame_name(&self, frame: Frame) -> &str {
        match frame {
            Frame::Ground => "ground",
            Frame::Body(body) => &self[body].declared.name,
        }
    }
}

/// What a feature is fixed to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Frame {
    /// The body without coordinates.
    Ground,
    /// A moving body.
    Body(BodyId),
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

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The pose as written: x (m), y (m), phi (rad).
    pub pose: [ExprId; 3],
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

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
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
}

impl JointKind {
    /// The word of the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            JointKind::Revolute(..) => "revolute",
            JointKind::Translational(..) => "translational",
            JointKind::Weld(..) => "weld",
            JointKind::RevoluteRevolute(..) => "revolute_revolute",
            JointKind::RevoluteTranslational(..) => "revolute_translational",
        }
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
        }
    }
}

/// What a named symbol of the graph stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Named {
    /// A kinematic quantity.
    Quantity(Quantity),
    /// The time derivative of a formula, along the motion.
    Derivative(ExprId),
    /// The argument of a user's function, where its formula is read on its own.
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
}

/// The two ways an equation becomes a row of Φ.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EquationForm {
    /// Left minus right.
    Difference(ExprId, ExprId),
    /// The squared distance of two points, minus the square of a formula without kinematic quantities (m).
    SquaredDistance(PointId, PointId, ExprId),
}

/// A number to tabulate.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub declared: Declared,
    /// Its formula.
    pub value: ExprId,
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
    /// The interval of a motion function.
    Interval,
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
    /// The declaration.
    pub span: Span,
}
