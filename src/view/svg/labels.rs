//! The names of bodies and pins, beside what they name: no label lies on another at any moment that is shown. One that finds no place is
//! left out; bodies tell their names as titles too.

use super::letters::{COLUMN, columns, letters};
use super::picture::PIXELS;
use super::picture::Picture;
use crate::scene::{Anchor, Look, Path, Place, Pose, Vector, bounds, distance, plus, times};
use crate::view::text::{escaped, number};

/// Longer names are cut.
const LONGEST: usize = 32;
/// More names than this are not looked at.
const MOST: usize = 400;

/// What labels leave free beside pins, if they can.
const TAKEN: [Look; 7] =
    [Look::Arrow, Look::ArrowHead, Look::Support, Look::Free, Look::FreeHead, Look::GapEnd, Look::Named];

/// A name in its place.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub text: String,
    /// What it names.
    pub anchor: Anchor,
    /// From there to the middle of the text (px).
    pub offset: Vector,
    /// Half the width and the height of its box (px).
    pub half: Vector,
    is_body: bool,
}

impl Label {
    /// Its corners, where what it names is there.
    pub fn bounds(&self, at: Vector) -> [Vector; 2] {
        let middle = plus(at, self.offset);
        [[middle[0] - self.half[0], middle[1] - self.half[1]], [middle[0] + self.half[0], middle[1] + self.half[1]]]
    }

    /// The element that shows it, around its anchor.
    fn element(&self, at: Vector, size: f64) -> String {
        let [x, y] = plus(at, self.offset);
        let class = if self.is_body { "body-name" } else { "point-name" };
        let (x, y) = (number(x, PIXELS), number(y + 0.35 * size, PIXELS));
        format!("<text class=\"{class}\" x=\"{x}\" y=\"{y}\">{}</text>", escaped(&self.text))
    }
}

impl Picture<'_> {
    /// The size of letters (px).
    pub fn letters(&self) -> f64 {
        letters(self.room())
    }

    /// Writes the names of a moment.
    pub fn add_labels(&mut self, poses: &[Pose]) {
        for label in self.labels(&[poses]) {
            let at = self.anchored(&label.anchor, poses);
            self.add_label(&label, at, None);
        }
    }

    /// Writes one, in a group with attributes if there are any.
    pub fn add_label(&mut self, label: &Label, at: Vector, attributes: Option<&str>) {
        self.used.labels = Some(self.letters());
        let size = self.letters();
        self.body += &match attributes {
            None => format!("{}\n", label.element(at, size)),
            Some(attributes) => format!("<g{attributes}>{}</g>\n", label.element([0.0; 2], size)),
        };
    }

    /// The names with their places, which hold at all of some moments.
    pub fn labels(&self, moments: &[&[Pose]]) -> Vec<Label> {
        let size = self.letters();
        let placed =
            |anchor: &Anchor| -> Vec<Vector> { moments.iter().map(|poses| self.anchored(anchor, poses)).collect() };
        let pins: Vec<Vec<Vector>> = self
            .pins()
            .iter()
            .map(|(place, at)| moments.iter().map(|poses| self.placed(place.pose(poses).0.placed(*at))).collect())
            .collect();
        let mut found: Vec<(Label, Vec<Vector>)> = Vec::new();
        for (anchor, text, is_body) in self.named() {
            let wide = (COLUMN * columns(&text) as f64).max(1.0);
            let half = [0.5 * size * wide + 2.0, 0.6 * size + 1.0];
            let at = placed(&anchor);
            // the same name at the same place is that of a pin that bodies share
            let is_told = |(known, places): &(Label, Vec<Vector>)| {
                known.is_body == is_body && places.iter().zip(&at).all(|(a, b)| distance(*a, *b) < 1.0)
            };
            if !is_body && found.iter().any(is_told) {
                continue;
            }
            let mut best: Option<(f64, Label)> = None;
            for (rank, offset) in offsets(half, 0.42 * self.unit() + 2.0).enumerate() {
                let label = Label { text: text.clone(), anchor, offset, half, is_body };
                let Some(cost) = self.cost(&label, &at, &found, &pins) else { continue };
                let cost = cost + 0.05 * rank as f64;
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, label));
                }
            }
            if let Some((_, label)) = best {
                found.push((label, at));
            }
        }
        found.into_iter().map(|(label, _)| label).collect()
    }

    /// What is wrong with a label's place; nothing where it cannot be there.
    fn cost(&self, label: &Label, at: &[Vector], found: &[(Label, Vec<Vector>)], pins: &[Vec<Vector>]) -> Option<f64> {
        let reach = 0.34 * self.unit();
        let mut cost = 0.0;
        for (moment, at) in at.iter().enumerate() {
            let [low, high] = label.bounds(*at);
            let [width, height] = self.room();
            if low[0] < 0.0 || low[1] < 0.0 || high[0] > width || high[1] > height {
                return None;
            }
            let meets = |[other_low, other_high]: [Vector; 2]| {
                low[0] < other_high[0] && other_low[0] < high[0] && low[1] < other_high[1] && other_low[1] < high[1]
            };
            if found.iter().any(|(other, places)| meets(other.bounds(places[moment]))) {
                return None;
            }
            let covered = pins.iter().filter(|places| {
                let [x, y] = places[moment];
                meets([[x - reach, y - reach], [x + reach, y + reach]])
            });
            cost += covered.count() as f64;
        }
        Some(cost / at.len().max(1) as f64)
    }

    /// What has a name: bodies first.
    fn named(&self) -> Vec<(Anchor, String, bool)> {
        let scene = self.scene;
        let mut named = Vec::new();
        for node in &scene.nodes {
            let Place::Fixed(frame) = node.place else { continue };
            let is_own = scene.declarations.get(node.declaration).is_some_and(|declaration| declaration.kind == "body");
            let is_told = named.iter().any(|(anchor, _, _): &(Anchor, String, bool)| anchor.frame == frame);
            if frame == 0 || !is_own || is_told {
                continue;
            }
            let places = node.shapes.iter().flat_map(|shape| shape.path.places());
            if let Some([low, high]) = bounds(places) {
                let at = times(0.5, plus(low, high));
                named.push((Anchor { frame, at }, cut(self.name(node.declaration)), true));
            }
        }
        let shown = scene.nodes.iter().flat_map(|node| &node.shapes).filter_map(|shape| scene.points.get(shape.point?));
        for point in shown {
            let own = point.name.rsplit('.').next().unwrap_or(&point.name);
            named.push((Anchor { frame: point.frame, at: point.at }, cut(own), false));
        }
        named.truncate(MOST);
        named
    }

    /// What labels leave free if they can: pins and the heads of arrows.
    fn pins(&self) -> Vec<(Place, Vector)> {
        let mut taken = Vec::new();
        for node in &self.scene.nodes {
            for shape in &node.shapes {
                match (&shape.path, shape.look) {
                    (Path::Circle { at, .. }, Look::Pin | Look::Dot) => taken.push((node.place, *at)),
                    (path, look) if TAKEN.contains(&look) => {
                        taken.extend(path.places().into_iter().map(|at| (node.place, at)));
                    }
                    _ => {}
                }
            }
        }
        taken
    }
}

/// Places around what is named, the best first: from its middle to that of the text.
fn offsets(half: Vector, reach: f64) -> impl Iterator<Item = Vector> {
    let [x, y] = half;
    [0.0, 1.0, 2.6].into_iter().flat_map(move |farther| {
        let (dx, dy) = (x + reach + farther * y, y + reach + farther * y);
        let (sx, sy) = (0.7 * reach + x + farther * y, 0.7 * reach + y + farther * y);
        [[sx, -sy], [dx, 0.0], [sx, sy], [0.0, -dy], [0.0, dy], [-sx, -sy], [-dx, 0.0], [-sx, sy]]
    })
}

fn cut(name: &str) -> String {
    if name.chars().count() <= LONGEST {
        return name.to_owned();
    }
    name.chars().take(LONGEST - 1).chain(['…']).collect()
}
