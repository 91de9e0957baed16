//! The numbers of coordinates: first those of bodies, then those of joints, in order of declaration. They are fixed before the coordinates
//! exist, as formulas refer to them.

use crate::model::{BodyId, JointId, Mechanism, PartId};
use std::ops::Range;

/// The numbers of all coordinates.
pub(super) struct Numbering {
    /// By body: x, y and phi.
    poses: Vec<[u32; 3]>,
    /// By joint: the coordinates that it adds.
    joints: Vec<Range<u32>>,
}

impl Numbering {
    pub fn new(model: &Mechanism) -> Numbering {
        let mut next = 0;
        let mut take = |count: usize| {
            next += count as u32;
            next - count as u32..next
        };
        let poses = model.bodies.iter().map(|_| {
            let Range { start: x, .. } = take(3);
            [x, x + 1, x + 2]
        });
        let poses = poses.collect();
        let joints = model.joints.iter().map(|joint| take(joint.spec.coordinates.len())).collect();
        Numbering { poses, joints }
    }

    /// Returns the coordinates x, y and phi of a body.
    pub fn pose(&self, body: BodyId) -> [u32; 3] {
        self.poses[body.index()]
    }

    /// Returns the coordinates of a joint.
    pub fn of_joint(&self, joint: JointId) -> Range<u32> {
        self.joints[joint.index()].clone()
    }

    /// Returns the coordinates of the bodies and joints whose part satisfies `belongs`, ascending.
    pub fn of_part(&self, model: &Mechanism, belongs: impl Fn(Option<PartId>) -> bool) -> Vec<u32> {
        let bodies = model.bodies.iter().zip(&self.poses).filter(|(body, _)| belongs(body.part));
        let of_joints = model.joints.iter().zip(&self.joints).filter(|(joint, _)| belongs(joint.part));
        bodies.flat_map(|(_, pose)| *pose).chain(of_joints.flat_map(|(_, range)| range.clone())).collect()
    }
}
