//! The checked mechanism: names are resolved, quantities are in SI units, and all formulas share one graph.
//!
//! The model is plain data. It must not know the equations of a joint, which `lower` writes. `check` has validated everything in it, so
//! that later stages do not fail on it.

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
pub use features::{Axis, Body, Circle, Curve, Frame, Point, Profile};
pub use forces::{Force, Load, Mass};
pub use joints::{Argument, Joint, JointFeature};
pub use mechc_text::vocabulary::{CompoundUnit, Dimension};
pub use named::Named;
pub use params::{ContinuedParam, Input, Param, TimeFormula, Variable};
pub use parts::{Part, PartDerivative};
pub use placement::Placement;
pub use quantities::{Direction, Measured, MeasuredArgument, Quantity};
pub use quotients::quotient;
pub use results::{Bound, Outcome, Reduction, ReductionKind, Requirement, RequirementTimes};

use mechc_expr::{ExprId, Graph, Symbol};
use mechc_text::source::Span;

/// The name of a declaration and its location.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Declared {
    /// The name, in Unicode normalization form NFC.
    pub name: String,
    /// The location of the name in the text.
    pub span: Span,
}

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident $of:ident $list:ident $add:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub struct $id(u32);

        impl $id {
            /// Returns the position in the mechanism's list, from 0.
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
            #[doc = concat!("Appends to `", stringify!($list), "` and returns the id.")]
            pub fn $add(&mut self, item: $of) -> $id {
                self.$list.push(item);
                $id(self.$list.len() as u32 - 1)
            }
        }
    )*};
}

ids! {
    /// An instance of another mechanism.
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
    /// A named symbol (`Symbol::Named`) of the graph.
    NamedId Named named add_named;
}

/// A mechanism that has passed `check`.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// The mechanism's name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The graph that holds every formula.
    pub graph: Graph,
    /// The meanings of the graph's named symbols, by their number.
    pub named: Vec<Named>,
    /// The independent parameters, by the number of their symbol.
    pub params: Vec<Param>,
    /// The inputs, by the number of their symbol.
    pub inputs: Vec<Input>,
    /// The parameters that may vary along a continuation path.
    pub continued: Vec<ContinuedParam>,
    /// The parts; a part within another one follows it.
    pub parts: Vec<Part>,
    /// The variables of derivatives, by their number.
    pub variables: Vec<Variable>,
    /// The derivatives by such variables in the texts of parts.
    pub part_derivatives: Vec<PartDerivative>,
    /// The numbers of the variables by which all columns are differentiated, in the order of the columns.
    pub by: Vec<u32>,
    /// The bodies, in order of declaration like all lists below; those of a part stand where the part is declared.
    pub bodies: Vec<Body>,
    /// The declared points, and literal points in the order in which they occur.
    pub points: Vec<Point>,
    /// The axes, in order of declaration.
    pub axes: Vec<Axis>,
    /// The circles, in order of declaration.
    pub circles: Vec<Circle>,
    /// The curves, in order of declaration.
    pub curves: Vec<Curve>,
    /// The joints, in order of declaration.
    pub joints: Vec<Joint>,
    /// Constraints and drivers, in order of declaration.
    pub equations: Vec<Equation>,
    /// The masses of bodies, in order of declaration.
    pub masses: Vec<Mass>,
    /// The acceleration of gravity (m/s²) in the ground's frame, if the outermost mechanism declares it.
    pub gravity: Option<[ExprId; 2]>,
    /// The loads, in order of declaration.
    pub loads: Vec<Load>,
    /// The measures, in order of declaration.
    pub measures: Vec<Measure>,
    /// The traces, in order of declaration; each refers to two of the measures.
    pub traces: Vec<Trace>,
    /// Results, in order of declaration.
    pub outcomes: Vec<Outcome>,
    /// The requirements that are judged, in order of declaration.
    pub requirements: Vec<Requirement>,
    /// The reductions that results and requirements use, by the number of their symbol.
    pub reductions: Vec<Reduction>,
    /// Present if results are differentiated by the variables of `by` too: the formulas of the analysis' start and end, if they depend on
    /// these variables.
    pub slopes: Option<[Option<ExprId>; 2]>,
    /// The number of named symbols that precede those of results.
    pub named_before_results: usize,
    /// Formulas that must be positive for other formulas to be defined. Those of inputs are with the inputs.
    pub conditions: Vec<Condition>,
    /// The times that `run` computes by default.
    pub analysis: Option<Analysis>,
    /// Parameter formulas whose values decided something in `check`. With other parameter values that decide nothing differently, the
    /// mechanism differs from this one in these values only.
    pub guards: Vec<(ExprId, GuardKind)>,
}

/// The property of a formula's value on which a decision of `check` depends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum GuardKind {
    /// The value is finite.
    Finite,
    /// The sign: negative, zero or positive.
    Sign,
    /// The whole value.
    Value,
}
impl Mechanism {
    /// Sets the values of all params (SI), and the first time, last time and step of the analysis (s) that they lead to.
    pub fn set_values(&mut self, values: &[f64], analysis: Option<[f64; 3]>) {
        for (param, &value) in self.params.iter_mut().zip(values) {
            param.value = value;
        }
        if let Some((own, [from, to, every])) = self.analysis.as_mut().zip(analysis) {
            (own.from, own.to, own.every) = (from, to, every);
        }
    }

    /// Returns a mechanism without declarations.
    #[must_use]
    pub fn new(declared: Declared, docs: Vec<String>) -> Mechanism {
        Mechanism {
            declared,
            docs,
            graph: Graph::new(),
            named: Vec::new(),
            params: Vec::new(),
            inputs: Vec::new(),
            continued: Vec::new(),
            parts: Vec::new(),
            variables: Vec::new(),
            part_derivatives: Vec::new(),
            by: Vec::new(),
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
            requirements: Vec::new(),
            reductions: Vec::new(),
            slopes: None,
            named_before_results: 0,
            conditions: Vec::new(),
            analysis: None,
            guards: Vec::new(),
        }
    }

    /// Removes the outputs with their derivatives, and the forces, which have no part in a continuation.
    pub fn strip_outputs(&mut self) {
        self.measures.clear();
        self.masses.clear();
        self.loads.clear();
        self.gravity = None;
        self.outcomes.clear();
        self.requirements.clear();
        self.reductions.clear();
        self.analysis = None;
        self.slopes = None;
        self.by.clear();
        self.variables.clear();
    }

    /// Returns the ids of the bodies, in order.
    pub fn body_ids(&self) -> impl Iterator<Item = BodyId> {
        (0..self.bodies.len() as u32).map(BodyId)
    }

    /// Returns the ids of the constraints and drivers, in order.
    pub fn equation_ids(&self) -> impl Iterator<Item = EquationId> + use<> {
        (0..self.equations.len() as u32).map(EquationId)
    }

    /// Returns the ids of the joints, in order.
    pub fn joint_ids(&self) -> impl Iterator<Item = JointId> + use<> {
        (0..self.joints.len() as u32).map(JointId)
    }

    /// Returns the ids of the parts, in order.
    pub fn part_ids(&self) -> impl Iterator<Item = PartId> + use<> {
        (0..self.parts.len() as u32).map(PartId)
    }

    /// Returns the ground frames of the parts, in order.
    pub fn part_frames(&self) -> impl Iterator<Item = Frame> {
        (0..self.parts.len() as u32).map(|part| Frame::Part(PartId(part)))
    }

    /// Returns the name of a frame: the body's name, `ground`, or the name of a part's ground.
    #[must_use]
    pub fn frame_name(&self, frame: Frame) -> &str {
        match frame {
            Frame::Ground => "ground",
            Frame::Body(body) => &self[body].declared.name,
            Frame::Part(part) => &self[part].ground_name,
        }
    }

    /// Returns the frame that carries a frame: a body or the ground.
    #[must_use]
    pub fn carrier(&self, mut frame: Frame) -> Frame {
        while let Frame::Part(part) = frame {
            frame = self[part].mount;
        }
        frame
    }

    /// Returns a frame, the frame on which it is mounted, and so on.
    pub fn carrier_chain(&self, frame: Frame) -> impl Iterator<Item = Frame> {
        std::iter::successors(Some(frame), |frame| match frame {
            Frame::Part(part) => Some(self[*part].mount),
            Frame::Ground | Frame::Body(_) => None,
        })
    }

    /// Returns the part in whose text the features of a frame are declared.
    #[must_use]
    pub fn part_of(&self, frame: Frame) -> Option<PartId> {
        match frame {
            Frame::Ground => None,
            Frame::Body(body) => self[body].part,
            Frame::Part(part) => Some(part),
        }
    }

    /// Returns a part and the parts that enclose it, the innermost first.
    pub fn parts_around(&self, part: Option<PartId>) -> impl Iterator<Item = PartId> {
        std::iter::successors(part, |&part| self[part].within)
    }

    /// Returns whether the text of a part is mirrored in the ground's frame, so that its left is the ground's right.
    #[must_use]
    pub fn is_mirrored(&self, part: Option<PartId>) -> bool {
        part.is_some_and(|part| self[part].is_mirrored)
    }

    /// Returns the first time of the analysis (s), or 0.
    #[must_use]
    pub fn first_time(&self) -> f64 {
        self.analysis.map_or(0.0, |analysis| analysis.from)
    }

    /// Returns the value of a formula of parameters and time at a time (s).
    #[must_use]
    pub fn value_at(&self, formula: ExprId, t: f64) -> f64 {
        self.graph.value(formula, |symbol| match symbol {
            Symbol::Param(k) => self.params[k as usize].value,
            Symbol::Shift(_) => 0.0,
            Symbol::Time => t,
            _ => f64::NAN,
        })
    }
}
