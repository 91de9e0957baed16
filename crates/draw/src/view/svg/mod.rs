//! SVG without scripts: one moment, several as a strobe, or the whole motion as keyframes; and plots of columns over time.
//!
//! Bodies and joints are groups with `data-body` and `data-joint`; shapes of points have `data-point`. One style sheet decides how
//! everything looks, in light and in dark. Coordinates are pixels.

mod curves;
mod forces;
mod keyframes;
mod labels;
mod message_block;
mod nodes;
mod picture;
mod plots;
mod style;
mod torques;
mod vectors;

use crate::scene::{Anchor, Motion, Scene, Vector};
use picture::Picture;

pub use plots::{Plot, plots};
pub use vectors::has_vectors;

/// Colour theme.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Theme {
    /// The reader's setting decides.
    #[default]
    Auto,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

/// Options of a picture.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Width and height (px); without them the mechanism's extent decides.
    pub size: Option<[f64; 2]>,
    /// Length on paper of a length of 1. With it the picture is true to scale, in millimetres of paper, and its size follows from the
    /// extent.
    pub scale: Option<f64>,
    /// Colours.
    pub theme: Theme,
    /// Named points whose paths are drawn in addition to the traces of the text.
    pub traces: Vec<(String, Anchor)>,
    /// True to draw velocities and accelerations, at pins and traced points, or at the other named points of a body that has neither.
    pub vectors: bool,
    /// True to draw reactions, loads and weights whose values are in the motion's table.
    pub forces: bool,
    /// True to draw the names of bodies and pins.
    pub labels: bool,
    /// Captions below positions (m).
    pub captions: Vec<(Vector, String)>,
    /// Messages below the picture.
    pub messages: Vec<String>,
}

/// Writes the mechanism at the rows of `moments`, the last one in full and the others pale, with the traces of the whole motion.
#[must_use]
pub fn still(scene: &Scene, motion: &Motion, moments: &Motion, options: &Options) -> String {
    let mut picture = Picture::new(scene, [motion, moments], options);
    let count = moments.len();
    for row in 0..count {
        picture.add_moment(moments, row, row + 1 == count);
    }
    picture.add_traces(motion);
    if options.vectors && count > 0 {
        picture.add_vectors(moments, motion);
    }
    if options.forces && count > 0 {
        picture.add_forces(moments, motion);
    }
    if count > 0 {
        picture.add_labels(moments.poses(count - 1));
    }
    picture.finish()
}

/// Writes the whole motion as an endless animation, to and fro if it does not end as it begins.
#[must_use]
pub fn animated(scene: &Scene, motion: &Motion, options: &Options) -> String {
    if motion.len() < 2 {
        return still(scene, motion, motion, options);
    }
    let mut picture = Picture::new(scene, [motion, motion], options);
    picture.add_motion(motion);
    picture.finish()
}
