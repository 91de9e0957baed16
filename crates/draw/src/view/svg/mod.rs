//! SVG without a script: one moment, several as a strobe, or the whole motion by keyframes; and columns over time.
//!
//! Bodies and joints are groups, which carry `data-body` and `data-joint`; what shows a point carries `data-point`. One style sheet says how
//! everything looks, in light and in dark. Coordinates are pixels.

mod curves;
mod forces;
mod keyframes;
mod labels;
mod letters;
mod nodes;
mod picture;
mod plots;
mod said;
mod style;
mod torques;
mod vectors;

use crate::scene::{Anchor, Motion, Scene, Vector};
use picture::Picture;

pub use plots::{Plot, plots};
pub use vectors::has_vectors;

/// Which colours are used.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Theme {
    /// As the reader's machine is set.
    #[default]
    Auto,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

/// What a picture shows beside the mechanism.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Width and height in pixels; by the mechanism's extent if not given.
    pub size: Option<[f64; 2]>,
    /// True to scale, if given: what a length of 1 is on paper. Then all is in millimetres of paper, and the size follows.
    pub scale: Option<f64>,
    /// Which colours.
    pub theme: Theme,
    /// Points whose paths are drawn beside those that the text asks for, with their names.
    pub traces: Vec<(String, Anchor)>,
    /// Velocities and accelerations at pins and traced points; of a body that has none of these at its points that have a name.
    pub vectors: bool,
    /// What joints exert, loads and weights, where the motion's table tells of them.
    pub forces: bool,
    /// The names of bodies and pins.
    pub labels: bool,
    /// Words below places (m).
    pub captions: Vec<(Vector, String)>,
    /// What is wrong with it, below it.
    pub said: Vec<String>,
}

/// The mechanism at some moments, the rows of `moments`; of several the last one stands out. Traces are those of the whole motion.
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

/// The whole motion, over and over; to and fro where it does not end as it begins.
#[must_use]
pub fn animated(scene: &Scene, motion: &Motion, options: &Options) -> String {
    if motion.len() < 2 {
        return still(scene, motion, motion, options);
    }
    let mut picture = Picture::new(scene, [motion, motion], options);
    picture.add_motion(motion);
    picture.finish()
}
