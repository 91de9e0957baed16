//! The start of parts: their coordinates, bound parameters and inputs, and mounts.

use super::Lowering;
use crate::model::{Frame, PartId, Placement};
use mechc_ir::{BodyId, Coordinate, Owner, PartStart};
use std::ops::Range;

impl Lowering<'_> {
    /// Returns the starts of the parts of the outermost mechanism. Parts within these start together with them.
    pub(super) fn part_starts(&mut self) -> Vec<PartStart> {
        let model = self.model;
        if model.parts.is_empty() {
            return Vec::new();
        }
        let outermost: Vec<PartId> = model.part_ids().map(|part| self.outermost(part)).collect();
        let top = |part: Option<PartId>| part.map(|part| outermost[part.index()]);
        let of_bodies: Vec<Option<PartId>> = model.bodies.iter().map(|body| top(body.part)).collect();
        let of_coordinates = |for_bodies: bool| {
            let part = |coordinate: &Coordinate| match coordinate.owner {
                Owner::Body(body) if for_bodies => of_bodies[body.index()],
                Owner::Joint(joint) if !for_bodies => top(model.joints[joint.index()].part),
                _ => None,
            };
            ranges(&self.coordinates.iter().map(part).collect::<Vec<_>>(), model.parts.len())
        };
        let (poses, of_joints) = (of_coordinates(true), of_coordinates(false));
        let bodies = ranges(&of_bodies, model.parts.len());
        let mut starts = Vec::new();
        for id in model.part_ids().filter(|id| model[*id].within.is_none()) {
            let part = &model[id];
            let Placement { at: [x, y], phi, .. } = self.absolute(Frame::Part(id));
            let inputs = part.inputs.iter().map(|(name, value)| (name.clone(), self.formula(*value))).collect();
            let params = part.params.iter().map(|(name, value)| (name.clone(), self.formula(*value))).collect();
            starts.push(PartStart {
                name: part.declared.name.clone(),
                span: part.declared.span,
                text: part.text,
                params,
                inputs,
                mount: [x, y, phi],
                is_mirrored: part.is_mirrored,
                bodies: bodies[id.index()].clone().map(BodyId::from).collect(),
                poses: poses[id.index()].clone(),
                own: of_joints[id.index()].clone(),
            });
        }
        starts
    }

    fn outermost(&self, mut part: PartId) -> PartId {
        while let Some(around) = self.model[part].within {
            part = around;
        }
        part
    }
}

/// Returns the range of each part's elements, which are contiguous.
fn ranges(list: &[Option<PartId>], parts: usize) -> Vec<Range<usize>> {
    let mut ranges = vec![0..0; parts];
    for (k, part) in list.iter().enumerate() {
        if let Some(part) = part {
            let range = &mut ranges[part.index()];
            *range = if range.start == range.end { k..k + 1 } else { range.start..k + 1 };
        }
    }
    ranges
}
