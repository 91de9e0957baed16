//! Which number each coordinate has: first those of the bodies, then those that joints bring along, in the order of declaration.
//!
//! Formulas speak of coordinates before these are there, and so the numbers are known from the start.

use crate::model::{BodyId, JointId, Mechanism, PartId};
use std::ops::Range;

/// The numbers of all coordinates.
pub(super) struct Numbering {
    /// By body: x, y, phi.
    poses: Vec<[u32; 3]>,
    /// By joint.
    own: Vec<Range<u32>>,
}

impl Numbering {
    pub fn of(model: &Mechanism) -> Numbering {
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
        let own = model.joints.iter().map(|joint| take(joint.kind.own_coordinates().len())).collect();
        Numbering { poses, own }
    }

    /// x, y and phi of a body.
    pub fn pose(&self, body: BodyId) -> [u32; 3] {
        self.poses[body.index()]
    }

    /// What a joint brings along.
    pub fn own(&self, joint: JointId) -> Range<u32> {
        self.own[joint.index()].clone()
    }

    /// The coordinates of bodies and joints that belong to a part as something tells it, ascending.
    pub fn of_part(&self, model: &Mechanism, belongs: impl Fn(Option<PartId>) -> bool) -> Vec<u32> {
        let bodies = model.bodies.iter().zip(&self.poses).filter(|(body, _)| belongs(body.part));
        let joints = model.joints.iter().zip(&self.own).filter(|(joint, _)| belongs(joint.part));
        bodies.flat_map(|(_, pose)| *pose).chain(joints.flat_map(|(_, own)| own.clone())).collect()
    }
}
