//! Size of symbols: it follows the extent of the mechanism along its motion, limited by the lengths of its links.

use super::drawing::Outline;
use super::features::Features;
use super::plane::{Vector, bounds, distance};
use super::{Anchor, Motion};

/// Size of symbols as a part of the mechanism's extent, if links are long enough.
const PART_OF_EXTENT: f64 = 1.0 / 46.0;
/// Limit of the size as a part of a short link's length.
const PART_OF_LINK: f64 = 0.2;
/// Least size as a part of the extent.
const LEAST_PART_OF_EXTENT: f64 = 1.0 / 400.0;
/// Number of rows that are sampled for the extent.
const SAMPLED_ROWS: usize = 60;

/// Returns the size of symbols (m), which is positive.
pub(super) fn unit(features: &Features, motion: &Motion, outlines: &[Outline]) -> f64 {
    let anchors = anchors(features, outlines);
    let corners = motion.sampled(SAMPLED_ROWS).filter_map(|row| {
        let poses = motion.poses(row);
        bounds(anchors.iter().map(|anchor| anchor.position(poses)))
    });
    let extent = bounds(corners.flatten()).map_or(0.0, |[low, high]| distance(low, high));
    if !(extent.is_finite() && extent > 0.0) {
        // a single position at rest
        return 1.0;
    }
    let short = short_link(features, outlines).map_or(f64::INFINITY, |length| PART_OF_LINK * length);
    (PART_OF_EXTENT * extent).min(short.max(LEAST_PART_OF_EXTENT * extent))
}

/// Returns the positions that a picture has to show.
fn anchors(features: &Features, outlines: &[Outline]) -> Vec<Anchor> {
    let model = features.model;
    let outline_anchors = outlines
        .iter()
        .enumerate()
        .flat_map(|(frame, outline)| outline.positions.iter().map(move |at| Anchor { frame, at: *at }));
    let mut anchors: Vec<Anchor> = outline_anchors.collect();
    for joint in &model.joints {
        anchors.extend(joint.points(model).into_iter().map(|point| features.point(point)));
        for profile in joint.profiles() {
            anchors.extend((0..8).map(|k| features.on_profile(profile, f64::from(k) * std::f64::consts::FRAC_PI_4)));
        }
    }
    anchors
}

/// Returns the lower quartile of the links' lengths.
fn short_link(features: &Features, outlines: &[Outline]) -> Option<f64> {
    let widest = |positions: &[Vector]| bounds(positions.iter().copied()).map(|[low, high]| distance(low, high));
    let mut lengths: Vec<f64> = outlines.iter().filter_map(|outline| widest(&outline.positions)).collect();
    let links = features.model.joints.iter().filter(|joint| joint.spec.holds_distance());
    lengths.extend(links.filter_map(|joint| joint.value().map(|length| features.value(length))));
    lengths.retain(|length| length.is_finite() && *length > 0.0);
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 4).copied()
}
