//! Groups of nodes, at a moment or moving.

use super::picture::Picture;
use super::style::TINTS;
use crate::scene::{Attachment, Look, Motion, Node, Path, Pose, Shape, Vector};
use crate::view::path::write_path;
use crate::view::text::{decimal, escape};

impl Picture<'_> {
    /// Adds a moment. The one that stands out has ids and the ground, which is above the pale moments.
    pub fn add_moment(&mut self, moments: &Motion, row: usize, is_highlighted: bool) {
        let t = decimal(moments.times[row], 9);
        if is_highlighted {
            self.body += &format!("<g data-t=\"{t}\">\n");
        } else {
            self.styles.has_ghosts = true;
            self.body += &format!("<g class=\"ghost\" data-t=\"{t}\">\n");
        }
        let scene = self.scene;
        for node in scene.nodes.iter().filter(|node| is_highlighted || node.attachment != Attachment::Fixed(0)) {
            self.add_at(node, moments.poses(row), is_highlighted);
        }
        self.body += "</g>\n";
    }

    fn add_at(&mut self, node: &Node, poses: &[Pose], has_ids: bool) {
        let (pose, stretch) = node.attachment.pose(poses);
        let mut transform = String::new();
        if node.attachment != Attachment::Fixed(0) {
            let is_stretched = node.attachment.is_stretched();
            let scale_x = || format!(" scale({} 1)", decimal(stretch * self.scale, self.pixel_decimals));
            let scale = if is_stretched { scale_x() } else { String::new() };
            transform = format!(" transform=\"{}{scale}\"", self.transform_attribute(&pose));
        }
        self.add_group(node, [0.0; 2], &transform, has_ids);
    }

    /// Returns the transform that places shapes around a frame's origin at a pose.
    pub fn transform_attribute(&self, pose: &Pose) -> String {
        let [x, y] = self.to_pixels(pose.at);
        let turn = decimal(degrees(pose.phi), self.degree_decimals);
        let turn = if turn == "0" { String::new() } else { format!(" rotate({turn})") };
        format!("translate({} {}){turn}", decimal(x, self.pixel_decimals), decimal(y, self.pixel_decimals))
    }

    /// Adds the shapes of a node as a group with `attributes`; `origin` is the group's origin in the coordinates of the shapes (m).
    pub fn add_group(&mut self, node: &Node, origin: Vector, attributes: &str, has_id: bool) {
        let scene = self.scene;
        let Some(declaration) = scene.declarations.get(node.declaration) else { return };
        let name = escape(&declaration.name).into_owned();
        let mut opening = String::from("<g");
        let is_body = matches!(declaration.kind, "body" | "ground");
        if is_body && has_id && !self.ids.contains(&declaration.name) {
            let id = self.id(&declaration.name);
            opening += &format!(" id=\"{}\"", escape(&id));
        }
        let attribute = match declaration.kind {
            "body" => "data-body",
            "joint" => "data-joint",
            "driver" | "constraint" => "data-driver",
            _ => "data-name",
        };
        opening += &format!(" {attribute}=\"{name}\"");
        let frame = match node.attachment {
            Attachment::Fixed(frame) => frame,
            Attachment::Upright(anchor) => anchor.frame,
            Attachment::Between { from, .. } => from.frame,
        };
        let mut classes = Vec::new();
        if frame > 0 {
            let tint = (frame - 1) % TINTS;
            self.styles.tints.insert(tint);
            classes.push(format!("b{tint}"));
        } else {
            let is_filled = |shape: &Shape| matches!(shape.look, Look::Gear | Look::Rack | Look::Block);
            if node.shapes.iter().any(is_filled) {
                self.styles.is_ground_filled = true;
                classes.push("b-ground".to_owned());
            }
        }
        let is_free = node.shapes.iter().any(|shape| shape.look == Look::Free);
        if scene.named.contains(&node.declaration) && !is_free {
            self.styles.is_named = true;
            classes.push("named".to_owned());
        }
        let attributes = match attributes.split_once(" class=\"") {
            _ if classes.is_empty() => attributes.to_owned(),
            // the classes of the animation follow those of the body
            Some((before, after)) => format!(" class=\"{} {after}{before}", classes.join(" ")),
            None => format!(" class=\"{}\"{attributes}", classes.join(" ")),
        };
        self.body += &format!("{opening}{attributes}>");
        if is_body {
            self.body += &format!("<title>{name}</title>");
        }
        let is_stretched = node.attachment.is_stretched();
        for shape in &node.shapes {
            self.add_shape(shape, origin, [node.attachment == Attachment::Fixed(0), is_stretched]);
        }
        self.body += "</g>\n";
    }

    fn add_shape(&mut self, shape: &Shape, origin: Vector, [in_picture, is_stretched]: [bool; 2]) {
        self.styles.looks.insert(shape.look);
        let scene = self.scene;
        let point = shape.point.and_then(|number| scene.points.get(number));
        let point = point.map_or(String::new(), |point| format!(" data-point=\"{}\"", escape(&point.name)));
        let class = shape.look.word();
        let scale = self.scale;
        let convert = |[x, y]: Vector| {
            if in_picture {
                self.to_pixels([x, y])
            } else if is_stretched {
                [x, -scale * y]
            } else {
                let [x, y] = [x - origin[0], y - origin[1]];
                [scale * x, -scale * y]
            }
        };
        let text = match &shape.path {
            Path::Circle { at, radius } => {
                let [x, y] = convert(*at).map(|part| decimal(part, self.pixel_decimals));
                let center = if x == "0" && y == "0" { String::new() } else { format!(" cx=\"{x}\" cy=\"{y}\"") };
                format!(
                    "<circle class=\"{class}\"{point}{center} r=\"{}\"/>",
                    decimal(scale * radius, self.pixel_decimals)
                )
            }
            path @ Path::Lines(_) => {
                let d = write_path(path, &convert, scale, self.pixel_decimals);
                format!("<path class=\"{class}\"{point} d=\"{d}\"/>")
            }
        };
        self.body += &text;
    }
}

/// Converts an angle (rad) to degrees in a picture, whose y axis points down.
pub(super) fn degrees(angle: f64) -> f64 {
    -angle.to_degrees()
}
