//! First moment of the motion as SVG for readers without scripts, in the style of the page.

use crate::scene::{Attachment, Motion, Node, Pose, Scene};
use crate::view::path::write_path;
use crate::view::text::decimal;

/// Longer side (px), and decimals of pixels.
const SIZE: f64 = 800.0;
const DECIMALS: usize = 1;
/// Number of tints of bodies (`page/src/picture/figures.ts`).
const TINTS: usize = 8;

/// Writes the picture, or an empty text if nothing is drawn.
pub(super) fn still(scene: &Scene, motion: &Motion) -> String {
    let [[left, bottom], [right, top]] = scene.extent;
    let longer = (right - left).max(top - bottom);
    if motion.is_empty() || !longer.is_finite() || longer <= 0.0 {
        return String::new();
    }
    let scale = SIZE / longer;
    let [width, height] = [right - left, top - bottom].map(|side| decimal(scale * side, DECIMALS));
    let mut svg = format!(
        "<svg class=\"still-picture mechanism\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"the mechanism as the motion begins\">"
    );
    for node in &scene.nodes {
        let is_named = scene.named.contains(&node.declaration);
        add(&mut svg, node, is_named, motion.poses(0), &|[x, y]| [scale * (x - left), scale * (top - y)], scale);
    }
    svg + "</svg>"
}

fn add(
    svg: &mut String,
    node: &Node,
    is_named: bool,
    poses: &[Pose],
    convert: &dyn Fn([f64; 2]) -> [f64; 2],
    scale: f64,
) {
    let (pose, stretch) = node.attachment.pose(poses);
    let frame = match node.attachment {
        Attachment::Fixed(frame) => frame,
        Attachment::Upright(anchor) => anchor.frame,
        Attachment::Between { .. } => 0,
    };
    let tint = frame.checked_sub(1).map_or("ground".to_owned(), |body| (body % TINTS).to_string());
    let wrong = if is_named { " wrong" } else { "" };
    *svg += &format!("<g class=\"node tint-{tint}{wrong}\">");
    for shape in &node.shapes {
        let d = write_path(&shape.path, &|[x, y]| convert(pose.transform([stretch * x, y])), scale, DECIMALS);
        *svg += &format!("<path class=\"look-{}\" d=\"{d}\"/>", shape.look.word());
    }
    *svg += "</g>";
}
