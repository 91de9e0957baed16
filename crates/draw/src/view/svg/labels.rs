//! Labels of bodies and pins, and texts of messages at positions. Labels never overlap at any shown moment, and cover lines and other
//! bodies only where there is no other room. A label that could be mistaken for another name has a leader. A label without a position is
//! left out; bodies have their names as titles, too.

use super::picture::{PIXELS, Picture};
use super::style::{COLUMN_WIDTH, letter_size, text_columns};
use crate::scene::{
    Anchor, Attachment, Look, Node, Path, Pose, Vector, bounds, distance, distance_to_segment, dot, hull, minus, plus,
    times,
};
use crate::view::text::{decimal, escape};

/// Length limit of names (characters).
const LONGEST_NAME: usize = 32;
/// Limit of labels.
const MOST_LABELS: usize = 400;

/// Distance of a label from a pin, and from the middle of a body (symbol units).
const TO_PIN: f64 = 0.42;
const TO_BODY: f64 = 0.66;
/// Radius around a pin that labels avoid (symbol units).
const PIN: f64 = 0.34;
/// Rings of candidate positions: their distance in half heights of a label, and its cost.
const RINGS: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.2], [1.0, 0.5], [2.6, 1.2], [5.0, 1.9]];
/// Cost of each direction over the one before it.
const NEXT_DIRECTION: f64 = 0.03;
/// Costs of a label that covers a pin, that is full of lines, and that is full of highlighted lines.
const ON_PIN: f64 = 1.0;
const ON_LINES: f64 = 1.0;
const ON_HIGHLIGHTED_LINES: f64 = 1.5;
/// Cost of a label that is mistaken for another name.
const AMBIGUOUS: f64 = 0.8;
/// Distance from which on a label has a leader, in half heights of a label.
const LEADER_DISTANCE: f64 = 2.5;
/// Least part of a label's width that its letters fill.
const LETTER_WIDTH: f64 = 0.85;
/// Distance of a line that counts as covered (px): between the two sides of a bar there is no room for a name.
const NEAR_LINE: f64 = 3.0;
/// Length of lines that fills a label, in heights of the label.
const FULL_LENGTH: f64 = 2.0;
/// Distance of positions on lines (px), and the limit of positions of all moments together.
const STEP: f64 = 4.0;
const MOST_POSITIONS: usize = 200_000;

/// Looks without lines: thin, pale, or on a shape that has lines.
const LOOKS_WITHOUT_LINES: [Look; 6] = [Look::Pin, Look::Dot, Look::Hatching, Look::Pitch, Look::Cross, Look::Weld];
/// Looks with highlighted lines.
const HIGHLIGHTED: [Look; 7] =
    [Look::Arrow, Look::ArrowHead, Look::Free, Look::FreeHead, Look::Gap, Look::GapEnd, Look::Named];

/// Filled looks, which may have their body's name on them.
const FILLED: [Look; 6] = [Look::Link, Look::Gear, Look::Rack, Look::Cam, Look::Roller, Look::Block];

/// Kind of label.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum LabelKind {
    /// Text of a message.
    Remark,
    Body,
    Point,
}

/// The text of a label, before it has a position.
struct LabelText {
    anchor: Anchor,
    text: String,
    kind: LabelKind,
}

/// A label at its position.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub text: String,
    /// Anchor of what it names.
    pub anchor: Anchor,
    /// Vector from the anchor to the middle of the text (px).
    pub offset: Vector,
    /// Half the width and half the height of its box (px).
    pub half: Vector,
    kind: LabelKind,
    /// True if a line connects it with its anchor.
    has_leader: bool,
}

impl Label {
    /// Returns the corners of the box for an anchor at a position (px).
    pub fn bounds(&self, at: Vector) -> [Vector; 2] {
        let middle = plus(at, self.offset);
        [[middle[0] - self.half[0], middle[1] - self.half[1]], [middle[0] + self.half[0], middle[1] + self.half[1]]]
    }

    /// Writes the element of the label, for an anchor at a position (px).
    fn element(&self, at: Vector, size: f64) -> String {
        let [x, y] = plus(at, self.offset);
        let class = match self.kind {
            LabelKind::Remark => "remark",
            LabelKind::Body => "body-name",
            LabelKind::Point => "point-name",
        };
        let leader = if self.has_leader { self.leader(at) } else { String::new() };
        let (x, y) = (decimal(x, PIXELS), decimal(y + 0.35 * size, PIXELS));
        format!("{leader}<text class=\"{class}\" x=\"{x}\" y=\"{y}\">{}</text>", escape(&self.text))
    }
}

impl Label {
    /// Returns whether the label is too far from what it names at some moment.
    fn is_far(&self, at: &[Vector], field: &Field) -> bool {
        let most = LEADER_DISTANCE * self.half[1];
        at.iter().zip(&field.moments).any(|(at, obstacles)| {
            let regions = obstacles.regions.iter().filter(|region| region.frame == self.anchor.frame);
            let here @ [low, high] = self.bounds(*at);
            let to_position = distance([0, 1].map(|part| at[part].clamp(low[part], high[part])), *at);
            match self.kind {
                LabelKind::Remark => false,
                LabelKind::Point => to_position > most,
                LabelKind::Body => regions.map(|region| region.distance(here)).fold(to_position, f64::min) > most,
            }
        })
    }

    /// Returns the part of the moments at which the label could be mistaken: that of a body lies on another body or nearer to it, that of a
    /// point nearer to another pin.
    fn ambiguity(&self, at: &[Vector], field: &Field) -> f64 {
        let is_ambiguous = |at: &Vector, obstacles: &Obstacles| {
            let here @ [low, high] = self.bounds(*at);
            let away =
                |position: &Vector| distance([0, 1].map(|part| position[part].clamp(low[part], high[part])), *position);
            match self.kind {
                LabelKind::Remark => false,
                LabelKind::Point => {
                    let to_anchor = away(at);
                    obstacles.pins.iter().any(|pin| distance(*pin, *at) > 1.0 && away(pin) < to_anchor)
                }
                LabelKind::Body => {
                    let nearest = |is_of_body: bool| {
                        let regions = obstacles.regions.iter();
                        let regions = regions.filter(|region| (region.frame == self.anchor.frame) == is_of_body);
                        regions.map(|region| region.distance(here)).fold(f64::INFINITY, f64::min)
                    };
                    let (to_body, to_others) = (nearest(true).min(away(at)), nearest(false));
                    to_others <= 0.0 || to_others < to_body
                }
            }
        };
        let count = at.iter().zip(&field.moments).filter(|(at, obstacles)| is_ambiguous(at, obstacles)).count();
        count as f64 / at.len().max(1) as f64
    }

    /// Writes the line from the anchor to the nearest position of the box, unless the anchor lies in it.
    fn leader(&self, at: Vector) -> String {
        let middle = plus(at, self.offset);
        // letters are narrower than their box
        let half = [LETTER_WIDTH * self.half[0], self.half[1]];
        let end = [0, 1].map(|part| at[part].clamp(middle[part] - half[part], middle[part] + half[part]));
        if distance(end, at) <= 0.0 {
            return String::new();
        }
        let [x, y, to_x, to_y] = [at[0], at[1], end[0], end[1]].map(|part| decimal(part, PIXELS));
        format!("<path class=\"leader\" d=\"M{x} {y}L{to_x} {to_y}\"/>")
    }
}

/// Convex hull of a body's filled shapes (px).
struct Region {
    frame: usize,
    corners: Vec<Vector>,
}

impl Region {
    /// Returns the distance of a box, 0 if they meet.
    fn distance(&self, [low, high]: [Vector; 2]) -> f64 {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let sides = |positions: &[Vector]| -> Vec<[Vector; 2]> {
            (0..positions.len()).map(|k| [positions[k], positions[(k + 1) % positions.len()]]).collect()
        };
        let (region_sides, box_sides) = (sides(&self.corners), sides(&corners));
        // separating axis theorem: one side of two disjoint convex shapes separates them
        let is_apart = |sides: &[[Vector; 2]], others: &[Vector], positions: &[Vector]| {
            sides.iter().any(|[from, to]| {
                let across = crate::scene::left(minus(*to, *from));
                let height = |position: &Vector| dot(across, minus(*position, *from));
                let [least, most] =
                    positions.iter().map(height).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| {
                        [low.min(height), high.max(height)]
                    });
                others.iter().all(|position| height(position) > most)
                    || others.iter().all(|position| height(position) < least)
            })
        };
        if !is_apart(&region_sides, &corners, &self.corners) && !is_apart(&box_sides, &self.corners, &corners) {
            return 0.0;
        }
        let to_region =
            corners.iter().flat_map(|position| region_sides.iter().map(|side| distance_to_segment(*position, *side)));
        let to_box =
            self.corners.iter().flat_map(|position| box_sides.iter().map(|side| distance_to_segment(*position, *side)));
        to_region.chain(to_box).fold(f64::INFINITY, f64::min)
    }
}

/// Obstacles for labels at one moment (px).
#[derive(Default)]
struct Obstacles {
    pins: Vec<Vector>,
    regions: Vec<Region>,
    /// Positions on lines, evenly spaced.
    lines: Vec<Vector>,
    highlighted_lines: Vec<Vector>,
}

impl Obstacles {
    /// Returns the obstacles in a box.
    fn within(&self, [low, high]: [Vector; 2]) -> Obstacles {
        let inside = |positions: &[Vector]| -> Vec<Vector> {
            positions.iter().copied().filter(|position| is_within(*position, [low, high])).collect()
        };
        let meets = |region: &&Region| {
            bounds(region.corners.iter().copied())
                .is_some_and(|[least, most]| (0..2).all(|part| low[part] <= most[part] && least[part] <= high[part]))
        };
        let regions = self
            .regions
            .iter()
            .filter(meets)
            .map(|Region { frame, corners }| Region { frame: *frame, corners: corners.clone() });
        Obstacles {
            pins: inside(&self.pins),
            regions: regions.collect(),
            lines: inside(&self.lines),
            highlighted_lines: inside(&self.highlighted_lines),
        }
    }
}

fn is_within([x, y]: Vector, [low, high]: [Vector; 2]) -> bool {
    low[0] <= x && x <= high[0] && low[1] <= y && y <= high[1]
}

/// Obstacles at all moments, and the length of line that a position stands for (px).
struct Field {
    moments: Vec<Obstacles>,
    step: f64,
}

impl Picture<'_> {
    /// Returns the size of letters (px).
    pub fn letters(&self) -> f64 {
        letter_size(self.drawing_size())
    }

    /// Adds the labels of a moment.
    pub fn add_labels(&mut self, poses: &[Pose]) {
        for label in self.labels(&[poses]) {
            let at = self.anchor_to_pixels(&label.anchor, poses);
            self.add_label(&label, at, None);
        }
    }

    /// Adds a label, in a group if there are attributes.
    pub fn add_label(&mut self, label: &Label, at: Vector, attributes: Option<&str>) {
        self.styles.labels = Some(self.letters());
        self.styles.has_remarks |= label.kind == LabelKind::Remark;
        self.styles.has_leaders |= label.has_leader;
        let size = self.letters();
        self.body += &match attributes {
            None => format!("{}\n", label.element(at, size)),
            Some(attributes) => format!("<g{attributes}>{}</g>\n", label.element([0.0; 2], size)),
        };
    }

    /// Returns the labels with positions that hold at all moments.
    pub fn labels(&self, moments: &[&[Pose]]) -> Vec<Label> {
        let texts = self.label_texts();
        if texts.is_empty() {
            return Vec::new();
        }
        let size = self.letters();
        let field = self.field(moments);
        let mut labels: Vec<(Label, Vec<Vector>)> = Vec::new();
        for LabelText { anchor, text, kind } in texts {
            let wide = (COLUMN_WIDTH * text_columns(&text) as f64).max(1.0);
            let half = [0.5 * size * wide + 2.0, 0.6 * size + 1.0];
            let at: Vec<Vector> = moments.iter().map(|poses| self.anchor_to_pixels(&anchor, poses)).collect();
            // bodies that share a pin share its name
            let is_labelled = |(label, positions): &(Label, Vec<Vector>)| {
                label.kind == kind && positions.iter().zip(&at).all(|(a, b)| distance(*a, *b) < 1.0)
            };
            if kind == LabelKind::Point && labels.iter().any(is_labelled) {
                continue;
            }
            let distance_to_label = if kind == LabelKind::Point { TO_PIN } else { TO_BODY };
            let reach = distance_to_label * self.unit() + 2.0;
            let near = self.near(&field, &at, half, reach);
            let mut best: Option<(f64, Label)> = None;
            for (offset_cost, offset) in offsets(half, reach, kind != LabelKind::Point) {
                let mut label = Label { text: text.clone(), anchor, offset, half, kind, has_leader: false };
                let Some(cost) = self.cost(&label, &at, &labels, &near) else { continue };
                let ambiguity = label.ambiguity(&at, &near);
                label.has_leader = ambiguity > 0.0 || label.is_far(&at, &near);
                let cost = cost + offset_cost + AMBIGUOUS * ambiguity;
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, label));
                }
            }
            if let Some((_, label)) = best {
                labels.push((label, at));
            }
        }
        labels.into_iter().map(|(label, _)| label).collect()
    }

    /// Returns the obstacles that a label near some positions, one for each moment, can meet.
    fn near(&self, field: &Field, at: &[Vector], half: Vector, reach: f64) -> Field {
        let farthest = RINGS[RINGS.len() - 1][0] * half[1] + reach + PIN * self.unit() + NEAR_LINE;
        let around = half.map(|half| 2.0 * half + farthest);
        let moments = at.iter().zip(&field.moments).map(|([x, y], obstacles)| {
            obstacles.within([[x - around[0], y - around[1]], [x + around[0], y + around[1]]])
        });
        Field { moments: moments.collect(), step: field.step }
    }

    /// Returns the cost of a label's position, or `None` if it is not possible.
    fn cost(&self, label: &Label, at: &[Vector], labels: &[(Label, Vec<Vector>)], field: &Field) -> Option<f64> {
        let reach = PIN * self.unit();
        let mut cost = 0.0;
        for (moment, (at, obstacles)) in at.iter().zip(&field.moments).enumerate() {
            let [low, high] = label.bounds(*at);
            let [width, height] = self.drawing_size();
            if low[0] < 0.0 || low[1] < 0.0 || high[0] > width || high[1] > height {
                return None;
            }
            let meets = |[other_low, other_high]: [Vector; 2]| {
                low[0] < other_high[0] && other_low[0] < high[0] && low[1] < other_high[1] && other_low[1] < high[1]
            };
            if labels.iter().any(|(other, positions)| meets(other.bounds(positions[moment]))) {
                return None;
            }
            let covered =
                obstacles.pins.iter().filter(|[x, y]| meets([[x - reach, y - reach], [x + reach, y + reach]]));
            let around = [low.map(|part| part - NEAR_LINE), high.map(|part| part + NEAR_LINE)];
            let full = |positions: &[Vector]| {
                let long =
                    field.step * positions.iter().filter(|position| is_within(**position, around)).count() as f64;
                (long / (FULL_LENGTH * 2.0 * label.half[1])).min(1.0)
            };
            cost += ON_PIN * covered.count() as f64;
            cost += ON_LINES * full(&obstacles.lines) + ON_HIGHLIGHTED_LINES * full(&obstacles.highlighted_lines);
        }
        Some(cost / at.len().max(1) as f64)
    }

    /// Returns what has a label: messages, then bodies, then points.
    fn label_texts(&self) -> Vec<LabelText> {
        let scene = self.scene;
        let on_ground = |at| Anchor { frame: 0, at };
        let remarks = scene.remarks.iter().map(|remark| LabelText {
            anchor: on_ground(remark.at),
            text: cut(&remark.text),
            kind: LabelKind::Remark,
        });
        let mut texts: Vec<LabelText> = remarks.collect();
        if self.options.labels {
            texts.extend(self.bodies());
            let points =
                scene.nodes.iter().flat_map(|node| &node.shapes).filter_map(|shape| scene.points.get(shape.point?));
            for point in points {
                let name = point.name.rsplit('.').next().unwrap_or(&point.name);
                let anchor = Anchor { frame: point.frame, at: point.at };
                texts.push(LabelText { anchor, text: cut(name), kind: LabelKind::Point });
            }
        }
        texts.truncate(MOST_LABELS);
        texts
    }

    /// Returns the bodies, each with the middle of its first shapes.
    fn bodies(&self) -> Vec<LabelText> {
        let scene = self.scene;
        let mut texts: Vec<LabelText> = Vec::new();
        for node in &scene.nodes {
            let Attachment::Fixed(frame) = node.attachment else { continue };
            let is_body =
                scene.declarations.get(node.declaration).is_some_and(|declaration| declaration.kind == "body");
            let is_labelled = texts.iter().any(|label| label.anchor.frame == frame);
            if frame == 0 || !is_body || is_labelled {
                continue;
            }
            let positions: Vec<Vector> = node.shapes.iter().flat_map(|shape| shape.path.positions()).collect();
            let corners = hull(&positions, 1.0 / self.scale);
            if !corners.is_empty() {
                // the middle lies on the body, even on a thin and slanting one
                let sum = corners.iter().copied().fold([0.0; 2], plus);
                let at = times(1.0 / corners.len() as f64, sum);
                let text = cut(self.name(node.declaration));
                texts.push(LabelText { anchor: Anchor { frame, at }, text, kind: LabelKind::Body });
            }
        }
        texts
    }

    /// Returns the obstacles for labels.
    fn field(&self, moments: &[&[Pose]]) -> Field {
        let shapes: Vec<ShapeSamples> = self.scene.nodes.iter().flat_map(|node| self.samples(node)).collect();
        let filled: Vec<(usize, Vec<Vector>)> = self.scene.nodes.iter().flat_map(|node| self.filled(node)).collect();
        let count: usize = shapes.iter().map(|samples| samples.positions.len()).sum();
        let every = (count * moments.len()).div_ceil(MOST_POSITIONS).max(1);
        let at = |poses: &&[Pose]| {
            let mut obstacles = Obstacles::default();
            for ShapeSamples { attachment, look, positions } in &shapes {
                let (pose, stretch) = attachment.pose(poses);
                let to_picture = |[x, y]: Vector| self.to_pixels(pose.transform([stretch * x, y]));
                match look {
                    Look::Pin | Look::Dot => obstacles.pins.extend(positions.iter().copied().map(to_picture)),
                    look if HIGHLIGHTED.contains(look) => {
                        obstacles.highlighted_lines.extend(positions.iter().step_by(every).copied().map(to_picture));
                    }
                    _ => obstacles.lines.extend(positions.iter().step_by(every).copied().map(to_picture)),
                }
            }
            let corners = |(frame, corners): &(usize, Vec<Vector>)| Region {
                frame: *frame,
                corners: corners.iter().map(|corner| self.to_pixels(poses[*frame].transform(*corner))).collect(),
            };
            obstacles.regions = filled.iter().map(corners).collect();
            obstacles
        };
        Field { moments: moments.iter().map(at).collect(), step: STEP * every as f64 }
    }

    /// Returns the filled parts of a body by their corners in its frame (m). A ring is not filled: there is room in it.
    fn filled(&self, node: &Node) -> Vec<(usize, Vec<Vector>)> {
        let Attachment::Fixed(frame) = node.attachment else { return Vec::new() };
        let is_filled = |path: &Path| !matches!(path, Path::Lines(contours) if contours.len() != 1);
        let shapes = node.shapes.iter().filter(|shape| FILLED.contains(&shape.look) && is_filled(&shape.path));
        let corners = shapes.map(|shape| (frame, hull(&shape.path.positions(), 1.0 / self.scale)));
        corners.filter(|(frame, corners)| *frame > 0 && corners.len() > 2).collect()
    }

    /// Returns the pins of a node by their centres, and its lines by positions on them.
    fn samples(&self, node: &Node) -> Vec<ShapeSamples> {
        let is_stretched = node.attachment.is_stretched();
        let sampled = |(path, look): (&Path, Look)| {
            let positions = match (path, look) {
                (Path::Circle { at, .. }, Look::Pin | Look::Dot) => vec![*at],
                (_, look) if LOOKS_WITHOUT_LINES.contains(&look) || is_stretched => return None,
                (path, _) => path.sampled(STEP / self.scale),
            };
            Some(ShapeSamples { attachment: node.attachment, look, positions })
        };
        node.shapes.iter().filter_map(|shape| sampled((&shape.path, shape.look))).collect()
    }
}

/// A pin or a line by its positions (m).
struct ShapeSamples {
    attachment: Attachment,
    look: Look,
    positions: Vec<Vector>,
}

/// Returns candidate offsets from the middle of what is named to the middle of the text, with their costs. With `has_inside` the middle
/// itself is the first.
fn offsets(half: Vector, reach: f64, has_inside: bool) -> impl Iterator<Item = (f64, Vector)> {
    let [x, y] = half;
    let around = RINGS.into_iter().flat_map(move |[farther, cost]| {
        let (dx, dy) = (x + reach + farther * y, y + reach + farther * y);
        let (sx, sy) = (0.7 * reach + x + farther * y, 0.7 * reach + y + farther * y);
        let directions = [[sx, -sy], [dx, 0.0], [sx, sy], [0.0, -dy], [0.0, dy], [-sx, -sy], [-dx, 0.0], [-sx, sy]];
        directions.into_iter().enumerate().map(move |(k, offset)| (cost + NEXT_DIRECTION * k as f64, offset))
    });
    has_inside.then_some((0.0, [0.0; 2])).into_iter().chain(around)
}

fn cut(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    name.chars().take(LONGEST_NAME - 1).chain(['…']).collect()
}
