//! Groups for nodes: at a moment, or moving.

use super::picture::Picture;
use super::style::TINTS;
use crate::scene::{Look, Motion, Node, Path, Place, Pose, Shape, Vector};
use crate::view::path::written;
use crate::view::text::{escaped, number};

impl Picture<'_> {
    /// A moment; with ids and the ground if it is the one that stands out. The ground, which all share, is above the pale ones.
    pub fn add_moment(&mut self, moments: &Motion, row: usize, stands_out: bool) {
        let t = number(moments.times[row], 9);
        if stands_out {
            self.body += &format!("<g data-t=\"{t}\">\n");
        } else {
            self.used.has_ghosts = true;
            self.body += &format!("<g class=\"ghost\" data-t=\"{t}\">\n");
        }
        let scene = self.scene;
        for node in scene.nodes.iter().filter(|node| stands_out || node.place != Place::Fixed(0)) {
            self.add_at(node, moments.poses(row), stands_out);
        }
        self.body += "</g>\n";
    }

    fn add_at(&mut self, node: &Node, poses: &[Pose], with_ids: bool) {
        let (pose, stretch) = node.place.pose(poses);
        let mut transform = String::new();
        if node.place != Place::Fixed(0) {
            let is_stretched = node.place.is_stretched();
            let stretched = || format!(" scale({} 1)", number(stretch * self.scale, self.pixels));
            let scale = if is_stretched { stretched() } else { String::new() };
            transform = format!(" transform=\"{}{scale}\"", self.transform(&pose));
        }
        self.add_group(node, [0.0; 2], &transform, with_ids);
    }

    /// The attribute that puts what is drawn around a frame's origin in its place.
    pub fn transform(&self, pose: &Pose) -> String {
        let [x, y] = self.placed(pose.at);
        let turn = number(degrees(pose.phi), self.degrees);
        let turn = if turn == "0" { String::new() } else { format!(" rotate({turn})") };
        format!("translate({} {}){turn}", number(x, self.pixels), number(y, self.pixels))
    }

    /// A node's shapes in a group, which is where `attributes` say; `origin` (m) is where the group's own origin is among them.
    pub fn add_group(&mut self, node: &Node, origin: Vector, attributes: &str, with_id: bool) {
        let scene = self.scene;
        let Some(declaration) = scene.declarations.get(node.declaration) else { return };
        let name = escaped(&declaration.name).into_owned();
        let mut opening = String::from("<g");
        let is_body = matches!(declaration.kind, "body" | "ground");
        if is_body && with_id && !self.ids.contains(&declaration.name) {
            let id = self.id(&declaration.name);
            opening += &format!(" id=\"{}\"", escaped(&id));
        }
        let what = match declaration.kind {
            "body" => "data-body",
            "joint" => "data-joint",
            "driver" | "constraint" => "data-driver",
            _ => "data-name",
        };
        opening += &format!(" {what}=\"{name}\"");
        let frame = match node.place {
            Place::Fixed(frame) => frame,
            Place::Upright(anchor) => anchor.frame,
            Place::Between { from, .. } => from.frame,
        };
        let mut classes = Vec::new();
        if frame > 0 {
            let tint = (frame - 1) % TINTS;
            self.used.tints.insert(tint);
            classes.push(format!("b{tint}"));
        } else {
            let is_filled = |shape: &Shape| matches!(shape.look, Look::Gear | Look::Rack | Look::Block);
            if node.shapes.iter().any(is_filled) {
                self.used.is_ground_filled = true;
                classes.push("b-ground".to_owned());
            }
        }
        let is_free = node.shapes.iter().any(|shape| shape.look == Look::Free);
        if scene.named.contains(&node.declaration) && !is_free {
            self.used.is_named = true;
            classes.push("named".to_owned());
        }
        let attributes = match attributes.split_once(" class=\"") {
            _ if classes.is_empty() => attributes.to_owned(),
            // classes of a motion stand with those of the body
            Some((before, behind)) => format!(" class=\"{} {behind}{before}", classes.join(" ")),
            None => format!(" class=\"{}\"{attributes}", classes.join(" ")),
        };
        self.body += &format!("{opening}{attributes}>");
        if is_body {
            self.body += &format!("<title>{name}</title>");
        }
        let is_stretched = node.place.is_stretched();
        for shape in &node.shapes {
            self.add_shape(shape, origin, [node.place == Place::Fixed(0), is_stretched]);
        }
        self.body += "</g>\n";
    }

    fn add_shape(&mut self, shape: &Shape, origin: Vector, [in_picture, is_stretched]: [bool; 2]) {
        self.used.looks.insert(shape.look);
        let scene = self.scene;
        let point = shape.point.and_then(|number| scene.points.get(number));
        let point = point.map_or(String::new(), |point| format!(" data-point=\"{}\"", escaped(&point.name)));
        let class = shape.look.word();
        let scale = self.scale;
        let placed = |[x, y]: Vector| {
            if in_picture {
                self.placed([x, y])
            } else if is_stretched {
                [x, -scale * y]
            } else {
                let [x, y] = [x - origin[0], y - origin[1]];
                [scale * x, -scale * y]
            }
        };
        let text = match &shape.path {
            Path::Circle { at, radius } => {
                let [x, y] = placed(*at).map(|part| number(part, self.pixels));
                let center = if x == "0" && y == "0" { String::new() } else { format!(" cx=\"{x}\" cy=\"{y}\"") };
                format!("<circle class=\"{class}\"{point}{center} r=\"{}\"/>", number(scale * radius, self.pixels))
            }
            path @ Path::Lines(_) => {
                let d = written(path, &placed, scale, self.pixels);
                format!("<path class=\"{class}\"{point} d=\"{d}\"/>")
            }
        };
        self.body += &text;
    }
}

/// An angle (rad) as a picture has it, whose y axis points down.
pub(super) fn degrees(angle: f64) -> f64 {
    -angle.to_degrees()
}
