//! The checked mechanism: every name resolved, every quantity in SI, every formula in one graph.
//!
//! Pure data, without meaning for mechanics yet: that a joint has equations is the business of `lower`. What stands
//! here has been found sound; nothing after `check` fails on it.

mod equations;
mod features;
mod forces;
mod joints;
mod named;
mod params;
mod parts;
mod placement;
mod print;
mod quantities;
mod quotients;
mod results;

pub use equations::{Analysis, Condition, ConditionKind, Equation, EquationForm, Measure, Trace, Units};
pub use features::{Axis, Body, Circle, Curve, Frame, Point, Profile, Side};
pub use forces::{Force, Load, Mass};
pub use joints::{Joint, JointKind};
pub use mechc_text::vocabulary::{CompoundUnit, Dimension};
pub use named::Named;
pub use params::{Input, Led, Param, Variable};
pub use parts::{AskedInPart, Part};
pub use placement::Placement;
pub use quantities::{Direction, Quantity};
pub use quotients::quotient;
pub use results::{Outcome, Reduction, ReductionKind};

use mechc_expr::{ExprId, Graph};
use mechc_text::source::Span;

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
    /// In order of declaration, as all that follows, those of a part where it is declared.
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

    /// Whether forces are to be computed.
    #[must_use]
    pub fn asks_for_forces(&self) -> bool {
        self.reactions || self.draws_forces() || self.named.iter().any(|named| matches!(named, Named::Force(..)))
    }
}
