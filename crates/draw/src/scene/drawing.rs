//! Scene under construction: the state and helpers that all symbols share.

use super::features::{Features, PartFrame};
use super::plane::{Path, Vector, bounds, distance};
use super::{Anchor, Attachment, Look, Motion, Node, Pen, Profile, Sample, Shape, Trace};
use mechc_lang::model::{self, PointId};
use std::f64::consts::PI;

/// Drawing order, the bottom layer first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Layer {
    Ground,
    Wheels,
    /// Supports of pins, in front of wheels.
    Feet,
    Bodies,
    Slots,
    Links,
    Blocks,
    Pins,
    Arrows,
}

/// Radius of a dot (symbol units).
pub(super) const DOT: f64 = 0.17;
/// Number of rows that are sampled for the range of a motion.
pub(super) const SAMPLED_ROWS: usize = 400;
/// Number of intervals of a profile.
const PROFILE_INTERVALS: u32 = 360;
/// Tolerance (m) of the cubic between two samples of a profile, and the limit of halvings to meet it.
const CUBIC_TOLERANCE: f64 = 1e-9;
const DEEPEST: u32 = 8;
/// A profile is closed if its ends are closer than this part of its size.
const CLOSED: f64 = 1e-6;

/// Outline of a body under construction.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    /// Positions in the frame that the outline encloses (m).
    pub positions: Vec<Vector>,
    /// True if other shapes show the body, so that a single position needs no link.
    pub is_shown: bool,
    /// True if it has a slot, for which it has to be wider.
    pub is_slotted: bool,
    /// Discs of the body, with centres and radii (m): positions in one of them need no link.
    pub discs: Vec<(Vector, f64)>,
}

pub(super) struct Drawing<'m> {
    pub features: Features<'m>,
    pub motion: &'m Motion,
    pub unit: f64,
    /// Outlines by frame.
    pub outlines: Vec<Outline>,
    /// Positions of supports on the ground (m).
    pub feet: Vec<Vector>,
    pub pins: Vec<super::Pin>,
    pub profiles: Vec<Profile>,
    /// Pitch lines of gears, ring gears and racks.
    pub pitch_lines: Vec<super::PitchLine>,
    /// For each point of the model its index among the points of the scene.
    pub point_indices: Vec<Option<usize>>,
    /// First declaration of each kind.
    pub first: First,
    pub nodes: Vec<(Layer, Node)>,
}

/// Indices of the first declarations of each kind.
#[derive(Clone, Copy, Default)]
pub(super) struct First {
    pub circles: usize,
    pub curves: usize,
    pub joints: usize,
    pub equations: usize,
    pub traces: usize,
    pub loads: usize,
}

impl Drawing<'_> {
    pub fn add(&mut self, layer: Layer, node: Node) {
        self.nodes.push((layer, node));
    }

    /// Adds shapes that move with a frame.
    pub fn add_fixed(&mut self, layer: Layer, declaration: usize, frame: usize, shapes: Vec<Shape>) {
        self.add(layer, Node { declaration, attachment: Attachment::Fixed(frame), shapes });
    }

    /// Returns the index of a point in the scene: the first one that has a name, preferably on a body.
    pub fn point_index(&self, points: &[PointId]) -> Option<usize> {
        let on_body = points.iter().find(|id| self.features.frame(self.features.model[**id].frame) > 0);
        let named = |id: &PointId| self.point_indices[id.index()];
        on_body.and_then(named).or_else(|| points.iter().find_map(named))
    }

    /// Returns the least and the greatest finite value over sampled rows of the motion.
    pub fn range(&self, of: impl Fn(usize) -> f64) -> [f64; 2] {
        let values = self.motion.sampled(SAMPLED_ROWS).map(of).filter(|value| value.is_finite());
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    }

    /// Returns the position of an anchor in another frame, in a row.
    pub fn position_in(&self, anchor: Anchor, frame: usize, row: usize) -> Vector {
        let poses = self.motion.poses(row);
        poses[frame].inverse_transform(anchor.position(poses))
    }

    /// Returns the values by row of a joint's coordinate `u`, `w` or `theta`.
    pub fn joint_coordinate(&self, joint: usize, part: &str) -> Option<Vec<f64>> {
        let name = &self.features.model.joints[joint].declared.name;
        Some(self.motion.column(&format!("{name}.{part}"))?.collect())
    }

    /// Adds a profile, if it is new, and returns its index. An open one covers the arguments of the range `used`.
    pub fn profile(&mut self, profile: model::Profile, used: Option<[f64; 2]>) -> usize {
        let declaration = match profile {
            model::Profile::Curve(id) => self.first.curves + id.index(),
            model::Profile::Circle(id) => self.first.circles + id.index(),
        };
        if let Some(existing) = self.profiles.iter().position(|existing| existing.declaration == declaration) {
            return existing;
        }
        let frame = self.features.frame(profile.frame(self.features.model));
        let sampled = |from: f64, to: f64| -> Vec<Sample> {
            let position = |k: u32| from + (to - from) * f64::from(k) / f64::from(PROFILE_INTERVALS);
            let samples = (0..=PROFILE_INTERVALS).map(|k| self.features.sample(profile, position(k)));
            samples.filter(|sample| super::is_finite(sample.at)).collect()
        };
        let turn = sampled(-PI, PI);
        let size = bounds(turn.iter().map(|sample| sample.at)).map_or(0.0, |[low, high]| distance(low, high));
        let is_closed = turn.len() == PROFILE_INTERVALS as usize + 1
            && distance(turn[0].at, turn[PROFILE_INTERVALS as usize].at) <= CLOSED * size;
        let samples = match used {
            Some([from, to]) if !is_closed => {
                let beyond = (0.05 * (to - from)).max(1e-3);
                sampled(from - beyond, to + beyond)
            }
            _ => turn,
        };
        let samples = refine(samples, |u| self.features.sample(profile, u));
        self.profiles.push(Profile { declaration, frame, is_closed, samples });
        self.profiles.len() - 1
    }

    /// Adds a dot at each point that draws a trace.
    pub fn mark_pens(&mut self, traces: &[Trace]) {
        for trace in traces {
            let Pen::Point(Anchor { frame, at }) = trace.pen else { continue };
            let model = self.features.model;
            let number = trace.declaration - self.first.traces;
            let point = model.traces.get(number).and_then(|trace| self.point_index(&[trace.point?]));
            let path = Path::Circle { at, radius: DOT * self.unit };
            self.add_fixed(Layer::Pins, trace.declaration, frame, vec![Shape { path, look: Look::Dot, point }]);
        }
    }

    /// Returns whether a declaration has a node.
    pub fn has_node(&self, declaration: usize) -> bool {
        self.nodes.iter().any(|(_, node)| node.declaration == declaration)
    }

    /// Makes the body the declaration of the first block of its frame. Returns whether there is one.
    pub fn declare_block(&mut self, frame: usize) -> bool {
        let is_block = |node: &Node| {
            node.attachment == Attachment::Fixed(frame) && node.shapes.iter().any(|shape| shape.look == Look::Block)
        };
        match self.nodes.iter_mut().find(|(_, node)| is_block(node)) {
            Some((_, node)) => {
                node.declaration = frame;
                true
            }
            None => false,
        }
    }

    /// Returns the number of arrows around a position.
    pub fn arrows_at(&self, anchor: Anchor) -> usize {
        let poses = self.motion.poses(0);
        let at = anchor.position(poses);
        let is_at = |node: &Node| match node.attachment {
            Attachment::Upright(other) => distance(other.position(poses), at) < 0.5 * self.unit,
            _ => false,
        };
        self.nodes.iter().filter(|(layer, node)| *layer == Layer::Arrows && is_at(node)).count()
    }

    pub fn traces(&self) -> Vec<Trace> {
        let model = self.features.model;
        let pen = |trace: &model::Trace| {
            if let Some(point) = trace.point {
                return Pen::Point(self.features.point(point));
            }
            let PartFrame { frame, pose, is_mirrored } = self.features.part_frame(trace.part);
            Pen::Columns { name: trace.declared.name.clone(), frame, pose, is_mirrored }
        };
        let numbered = model.traces.iter().enumerate();
        numbered.map(|(k, trace)| Trace { declaration: self.first.traces + k, pen: pen(trace) }).collect()
    }
}

/// Adds samples where the cubic between two of them misses the profile.
fn refine(samples: Vec<Sample>, of: impl Fn(f64) -> Sample) -> Vec<Sample> {
    let mut refined: Vec<Sample> = Vec::with_capacity(samples.len());
    // stack of samples to come, with the number of halvings before each
    let mut pending: Vec<(Sample, u32)> = samples.into_iter().rev().map(|sample| (sample, 0)).collect();
    while let Some((next, depth)) = pending.pop() {
        if let Some(last) = refined.last().filter(|_| depth < DEEPEST) {
            let is_off = |part: f64| {
                distance(last.between(&next, part), of(last.u + part * (next.u - last.u)).at) > CUBIC_TOLERANCE
            };
            if is_off(0.5) || is_off(0.25) {
                pending.extend([(next, depth + 1), (of(0.5 * (last.u + next.u)), depth + 1)]);
                continue;
            }
        }
        refined.push(next);
    }
    refined
}

/// Creates a shape that shows no point.
pub(super) fn shape(look: Look, path: Path) -> Shape {
    Shape { path, look, point: None }
}
