//! The joints' rows of `Φ` (H 3.3). An element is a function of the joint; the vocabulary has all other data of its kind.
//!
//! A new element of features and a symbol that exist is an entry of `JOINTS` in `mechc-text`, its rows here or in a file of this folder,
//! and a line in `ELEMENTS`.

mod contacts;
mod gears;

use super::frames::Vector;
use super::{Entry, Lowering};
use crate::model::{Joint, JointFeature};
use mechc_expr::{ExprId, Symbol};
use mechc_ir::{Coordinate, CoordinateKind, Monitor, MonitorKind, Owner};

/// Returns the rows of a joint and adds its coordinates, monitors and fits. Rows are in the units of the joint's kind.
type Rows = fn(&mut Lowering<'_>, &Joint) -> Vec<ExprId>;

/// The rows of all joints, by name.
const ELEMENTS: &[(&str, Rows)] = &[
    ("revolute", revolute),
    ("translational", translational),
    ("weld", weld),
    ("revolute_revolute", revolute_revolute),
    ("revolute_translational", revolute_translational),
    ("gear", gears::gear),
    ("internal_gear", gears::internal_gear),
    ("belt", gears::belt),
    ("rack_pinion", gears::rack_pinion),
    ("point_follower", contacts::point_follower),
    ("cam", contacts::cam),
    ("flat_follower", contacts::flat_follower),
];

/// Returns `r_i^P − r_j^Q`.
fn revolute(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [p, q] = joint.features.map(|feature| l.place(feature));
    l.difference(p, q).to_vec()
}

/// Returns `[v_i^⊥ᵀ d, v_i^⊥ᵀ v_j]`.
fn translational(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [origin, other] = joint.features.map(|feature| l.place(feature));
    let d = l.difference(other, origin);
    let [v, w] = joint.features.map(|feature| l.along(feature));
    vec![l.left_of(v, d), l.left_of(v, w)]
}

/// Returns `[r_i^P − r_j^Q, φ_j − φ_i − φ_0]`.
fn weld(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [phi_i, phi_j] = joint.frames(l.model).map(|frame| l.frame_coordinate(frame, 2));
    let angle = l.value(joint);
    let turn = l.graph.sub(phi_j, phi_i);
    let turn = l.with_handedness(joint.part, turn);
    let turn = l.graph.sub(turn, angle);
    let mut rows = revolute(l, joint);
    rows.push(turn);
    rows
}

/// Returns `dᵀd − L²`.
fn revolute_revolute(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let length = l.value(joint);
    let [p, q] = joint.features.map(|feature| l.place(feature));
    vec![l.squared_distance_row([p, q], length)]
}

/// Returns `v_j^⊥ᵀ (r_i^P − r_j^a) − c`.
fn revolute_translational(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [point, origin] = joint.features.map(|feature| l.place(feature));
    let d = l.difference(point, origin);
    let v = l.along(joint.features[1]);
    let offset = l.value(joint);
    let left = l.left_of(v, d);
    let left = l.with_handedness(joint.part, left);
    vec![l.graph.sub(left, offset)]
}

impl Lowering<'_> {
    /// Returns the rows of a joint, with their units.
    pub(super) fn joint(&mut self, joint: &Joint) -> Vec<Entry> {
        let element = ELEMENTS.iter().find(|(name, _)| *name == joint.spec.name());
        let rows = element.map_or(Vec::new(), |(_, rows)| rows(self, joint));
        rows.into_iter().zip(joint.spec.rows.iter().copied()).collect()
    }

    /// Returns `dᵀd − C²`, which has no square root and no singularity at the solution.
    pub(super) fn squared_distance_row(&mut self, [p, q]: [Vector; 2], distance: ExprId) -> ExprId {
        let d = self.difference(q, p);
        let square = self.dot(d, d);
        let square_of_distance = self.graph.power(distance, 2);
        self.graph.sub(square, square_of_distance)
    }

    /// Returns the position of a point, of an axis' origin or of a circle's centre (m); of a curve that of its frame.
    fn place(&mut self, feature: JointFeature) -> Vector {
        match feature.point(self.model) {
            Some(point) => self.position(point),
            None => [0, 1].map(|part| self.frame_coordinate(feature.frame(self.model), part)),
        }
    }

    /// Returns the direction of an axis, or the x axis of another feature's frame.
    fn along(&mut self, feature: JointFeature) -> Vector {
        if let Some(axis) = feature.axis() {
            return self.direction(axis);
        }
        let x = [1.0, 0.0].map(|part| self.graph.constant(part));
        self.transform_vector(feature.frame(self.model), x)
    }

    /// Returns the radius of a circle (m), or 0 of another feature.
    fn radius(&mut self, feature: JointFeature) -> ExprId {
        match feature.circle() {
            Some(circle) => self.formula(self.model[circle].radius),
            None => self.graph.constant(0.0),
        }
    }

    /// Returns the joint's angle (rad) or length (m).
    fn value(&mut self, joint: &Joint) -> ExprId {
        match joint.value() {
            Some(value) => self.formula(value),
            None => self.graph.constant(0.0),
        }
    }

    /// Adds the k-th coordinate of a joint.
    fn add_coordinate(&mut self, joint: &Joint, k: usize, kind: CoordinateKind, estimate: ExprId) -> ExprId {
        let index = self.coordinates.len() as u32;
        self.coordinates.push(Coordinate {
            name: format!("{}.{}", joint.declared.name, joint.spec.coordinates[k].0),
            owner: Owner::Joint(self.declarations.next_id()),
            kind,
            estimate,
            scale: 1.0,
        });
        self.graph.symbol(Symbol::Coordinate { index, order: 0 })
    }

    /// Adds a monitor to the joint that is being lowered: a value that keeps its sign along a branch.
    fn add_monitor(&mut self, value: ExprId, kind: MonitorKind, scale: f64) {
        self.watches.push(Monitor { value, kind, scale, declaration: self.declarations.next_id() });
    }
}

#[cfg(test)]
mod tests {
    use super::ELEMENTS;
    use mechc_text::vocabulary::{JOINTS, JointSpec};

    #[test]
    fn every_joint_has_rows() {
        let names: Vec<&str> = ELEMENTS.iter().map(|(name, _)| *name).collect();
        let joints: Vec<&str> = JOINTS.iter().map(JointSpec::name).collect();
        assert_eq!(names, joints, "rows are missing in ELEMENTS, or data in JOINTS");
    }
}
