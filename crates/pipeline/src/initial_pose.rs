//! Initial poses: where a mechanism is drawn before it is assembled, by the poses in its text.

use crate::Checked;
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{Frame, Joint, Mechanism, Placement, Point};

/// A mechanism in its initial pose.
pub struct InitialPose {
    /// Named points.
    pub points: Vec<InitialPoint>,
    /// Joints whose position is one number.
    pub joints: Vec<InitialJoint>,
    /// Name of each body, with its angle (rad).
    pub angles: Vec<(String, f64)>,
}

/// A point of a body or of the ground.
pub struct InitialPoint {
    /// Path of the body.
    pub body: String,
    /// Name of the point.
    pub name: String,
    /// Position (m).
    pub at: [f64; 2],
}

/// A joint whose position is one number.
pub struct InitialJoint {
    /// Path of the joint.
    pub name: String,
    /// The quantity: `rotation` or `displacement`.
    pub quantity: &'static str,
    /// Value (SI).
    pub value: f64,
}

impl Checked {
    /// Returns the initial pose; `None` if the mechanism has errors. A number that is unknown before the motion is NaN.
    #[must_use]
    pub fn initial_pose(&self) -> Option<InitialPose> {
        Some(drawn(self.model()?))
    }
}

fn drawn(model: &Mechanism) -> InitialPose {
    let mut graph = model.graph.clone();
    let mut place = |frame: Frame| model.drawn(&mut graph, &mut |_, e| e, None, frame);
    let placed_points: Vec<_> = model.points.iter().map(|point| (point, place(point.frame))).collect();
    let placed_bodies: Vec<_> = model.body_ids().map(|body| (body, place(Frame::Body(body)))).collect();
    let placed_axes: Vec<_> = model.axes.iter().map(|axis| place(axis.frame)).collect();
    let points: Vec<_> =
        placed_points.iter().map(|(point, placement)| placement.placed(&mut graph, point.at)).collect();
    let directions: Vec<_> = model
        .axes
        .iter()
        .zip(&placed_axes)
        .map(|(axis, placement)| placement.turned(&mut graph, axis.direction))
        .collect();
    let mut values = Vec::new();
    graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params.get(k as usize).map_or(f64::NAN, |param| param.value),
        Symbol::Time | Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    });
    let value = |id: ExprId| values[id.index()];
    let angle = |frame: Frame| match frame {
        Frame::Ground => 0.0,
        frame => placed_points
            .iter()
            .find(|(point, _)| point.frame == frame)
            .map_or(f64::NAN, |(_, placement)| value(placement.phi)),
    };
    let position = |joint: &Joint| {
        if let Some([p, q]) = joint.pin() {
            return Some(angle(model[q].frame) - angle(model[p].frame));
        }
        let guide = joint.guide()?;
        let [from, to] = guide.map(|axis| points[model[axis].origin.index()].map(value));
        let [x, y] = directions[guide[0].index()].map(value);
        Some(((to[0] - from[0]) * x + (to[1] - from[1]) * y) / (x * x + y * y).sqrt())
    };
    let point = |((point, _), at): (&(&Point, Placement), &[ExprId; 2])| {
        let body = model.frame_name(point.frame).to_owned();
        Some(InitialPoint { body, name: point.name.clone()?, at: at.map(value) })
    };
    let joint = |joint: &Joint| {
        let (quantity, value) = (joint.spec.motion?.quantity(), position(joint)?);
        Some(InitialJoint { name: joint.declared.name.clone(), quantity, value })
    };
    InitialPose {
        points: placed_points.iter().zip(&points).filter_map(point).collect(),
        joints: model.joints.iter().filter_map(joint).collect(),
        angles: placed_bodies
            .iter()
            .map(|(id, placement)| (model[*id].declared.name.clone(), value(placement.phi)))
            .collect(),
    }
}
