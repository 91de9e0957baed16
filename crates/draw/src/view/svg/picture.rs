//! Picture under construction: conversion of metres to pixels, and the file around all shapes.

use super::message_block::MessageBlock;
use super::style::{self, StyleUsage};
use super::{Options, Theme};
use crate::scene::{Anchor, Motion, Pen, Pose, Scene, Vector, bounds, distance, is_finite};
use crate::view::text::{decimal, escape};
use std::fmt::Write;

/// Margin without and with labels (px).
const MARGIN: f64 = 14.0;
const LABELLED_MARGIN: f64 = 34.0;
/// Margin with forces, whose arrows reach beyond their points of action (px).
const FORCE_MARGIN: f64 = 90.0;
/// Least and greatest width and height, unless the size is given (px).
const WIDTHS: [f64; 2] = [320.0, 800.0];
const HEIGHTS: [f64; 2] = [220.0, 760.0];
/// Least width with a message below (px).
const WIDTH_WITH_MESSAGE: f64 = 480.0;
/// A trace larger than so many times everything else runs away; it is shown as far as this part of that size.
const RUNAWAY: f64 = 20.0;
const SHOWN_PART: f64 = 0.35;
/// Greatest symbol unit, unless the size is given (px).
const LARGEST_UNIT: f64 = 30.0;

/// Pixels per metre of paper, and millimetres of paper per pixel.
pub(super) const PIXELS_PER_METER: f64 = 96.0 / 0.0254;
const MILLIMETERS_PER_PIXEL: f64 = 25.4 / 96.0;
/// Decimals of pixels, and of degrees.
pub(super) const PIXELS: usize = 2;
pub(super) const DEGREES: usize = 3;
/// Number of significant digits of degrees.
const DIGITS: usize = 17;
/// Decimals of pixels for cutting: 1e-4 px are 0.03 µm of paper.
const PIXELS_TO_CUT: usize = 4;

pub(super) struct Picture<'s> {
    pub scene: &'s Scene,
    pub options: &'s Options,
    pub size: [f64; 2],
    /// Margin (px).
    pub margin: f64,
    /// Messages below the picture.
    pub messages: MessageBlock,
    /// Pixels per metre.
    pub scale: f64,
    /// Decimals of lengths (px); for cutting they resolve 0.03 µm of paper.
    pub pixel_decimals: usize,
    /// Decimals of angles (deg).
    pub degree_decimals: usize,
    /// Position in the middle (m).
    middle: Vector,
    pub styles: StyleUsage,
    pub rules: String,
    pub body: String,
    /// Number of tracks.
    pub tracks: usize,
    pub ids: rustc_hash::FxHashSet<String>,
}

/// Returns the decimals of degrees that rotate a shape of the picture's size (px) exactly to the last decimal of its pixels.
fn degrees_to_cut([width, height]: [f64; 2]) -> usize {
    let mut decimals = DEGREES;
    let mut off = (width * width + height * height).sqrt().to_radians();
    for _ in 0..DEGREES {
        off *= 0.1;
    }
    // shapes farther away than the digits of a number resolve are not exact
    while off > 1e-4 && decimals < DIGITS {
        off *= 0.1;
        decimals += 1;
    }
    decimals
}

impl<'s> Picture<'s> {
    pub fn new(scene: &'s Scene, [motion, moments]: [&Motion; 2], options: &'s Options) -> Picture<'s> {
        let [low, high] = visible_bounds(scene, motion, moments, options);
        let extent = [high[0] - low[0], high[1] - low[1]].map(|side| side.max(4.0 * scene.unit));
        let is_labelled = options.labels || options.vectors || !scene.remarks.is_empty();
        let margin = if options.forces && !(scene.forces.is_empty() && scene.torques.is_empty()) {
            FORCE_MARGIN
        } else if is_labelled {
            LABELLED_MARGIN
        } else {
            MARGIN
        };
        let inner = |side: f64| (side - 2.0 * margin).max(0.2 * side);
        let largest = LARGEST_UNIT / scene.unit;
        let size = options.size.filter(|_| options.scale.is_none()).unwrap_or_else(|| {
            if let Some(scale) = options.scale {
                // whole millimetres of paper
                return extent.map(|side| {
                    -mechc_expr::math::floor(-(side * scale * PIXELS_PER_METER + 2.0 * margin) * MILLIMETERS_PER_PIXEL)
                        / MILLIMETERS_PER_PIXEL
                });
            }
            let scale = (inner(WIDTHS[1]) / extent[0]).min(inner(HEIGHTS[1]) / extent[1]).min(largest);
            let needed = |side: usize, [least, most]: [f64; 2]| {
                mechc_expr::math::floor((extent[side] * scale + 2.0 * margin).clamp(least, most) + 0.5)
            };
            let least = if options.messages.is_empty() { WIDTHS[0] } else { WIDTH_WITH_MESSAGE };
            [needed(0, [least, WIDTHS[1]]), needed(1, HEIGHTS)]
        });
        let is_given = options.size.is_some() && options.scale.is_none();
        let messages = MessageBlock::new(&options.messages, size, margin, is_given);
        let drawn = if is_given { [size[0], size[1] - messages.height] } else { size };
        let size = [drawn[0], drawn[1] + messages.height];
        let fitting = (inner(drawn[0]) / extent[0]).min(inner(drawn[1]) / extent[1]);
        let scale = match options.scale {
            Some(scale) => scale * PIXELS_PER_METER,
            None if options.size.is_some() => fitting,
            None => fitting.min(largest),
        };
        let middle = [0, 1].map(|part| 0.5 * (low[part] + high[part]));
        let (styles, rules, body) = (StyleUsage::default(), String::new(), String::new());
        Picture {
            scene,
            options,
            size,
            margin,
            messages,
            scale,
            pixel_decimals: if options.scale.is_some() { PIXELS_TO_CUT } else { PIXELS },
            degree_decimals: if options.scale.is_some() { degrees_to_cut(size) } else { DEGREES },
            middle,
            styles,
            rules,
            body,
            tracks: 0,
            ids: rustc_hash::FxHashSet::default(),
        }
    }

    /// Returns the size of the picture above the messages (px).
    pub fn drawing_size(&self) -> [f64; 2] {
        [self.size[0], self.size[1] - self.messages.height]
    }

    /// Converts a position (m) to the picture (px).
    pub fn to_pixels(&self, [x, y]: Vector) -> Vector {
        let [width, height] = self.drawing_size();
        [0.5 * width + self.scale * (x - self.middle[0]), 0.5 * height - self.scale * (y - self.middle[1])]
    }

    /// Returns the symbol unit (px).
    pub fn unit(&self) -> f64 {
        self.scale * self.scene.unit
    }

    /// Converts an anchor to the picture (px) at some poses.
    pub fn anchor_to_pixels(&self, anchor: &Anchor, poses: &[Pose]) -> Vector {
        self.to_pixels(anchor.position(poses))
    }

    /// Returns the name of a declaration.
    pub fn name(&self, declaration: usize) -> &'s str {
        self.scene.declarations.get(declaration).map_or("", |declaration| &declaration.name)
    }

    /// Returns a new id for a name.
    pub fn id(&mut self, name: &str) -> String {
        let word = |c: char| if c.is_alphanumeric() || matches!(c, '_' | '-' | '.') { c } else { '_' };
        let mut id: String = name.chars().map(word).collect();
        if !id.starts_with(|c: char| c.is_alphabetic() || c == '_') {
            id.insert(0, '_');
        }
        let free = (1..).map(|k| if k == 1 { id.clone() } else { format!("{id}-{k}") });
        let free_id = free.into_iter().find(|id| !self.ids.contains(id)).unwrap_or(id);
        self.ids.insert(free_id.clone());
        free_id
    }

    fn caption(&self, (at, text): &(Vector, String)) -> String {
        let [x, y] = self.to_pixels(*at).map(|part| decimal(part, 2));
        format!("<text class=\"caption\" x=\"{x}\" y=\"{y}\">{}</text>\n", escape(text))
    }

    /// Writes the whole file.
    pub fn finish(mut self) -> String {
        // size of a pixel in units of the file: pixels, or millimetres of paper
        let (pixel_size, word) = if self.options.scale.is_some() { (MILLIMETERS_PER_PIXEL, "mm") } else { (1.0, "") };
        let [width, height] = self.size.map(|side| decimal(pixel_size * side, 2));
        // position of the ground's origin, for programs that measure the picture: x to the right, y up
        let origin = self.to_pixels([0.0; 2]).map(|part| pixel_size * part);
        let mut file = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}{word}\" height=\"{height}{word}\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
             aria-labelledby=\"title\" data-scale=\"{}\" data-origin=\"{} {}\">\n<title id=\"title\">{}</title>\n",
            if self.options.scale.is_some() { pixel_size * self.scale } else { self.scale },
            decimal(origin[0], self.pixel_decimals + 1),
            decimal(origin[1], self.pixel_decimals + 1),
            escape(&self.scene.name)
        );
        let mut description = self.scene.docs.join("\n").trim().to_owned();
        for message in &self.options.messages {
            description += if description.is_empty() { "" } else { "\n" };
            description += message;
        }
        if !description.is_empty() {
            let _ = writeln!(file, "<desc>{}</desc>", escape(&description));
        }
        self.styles.messages = self.messages.letters();
        if !self.options.captions.is_empty() {
            self.styles.labels = Some(self.letters());
        }
        let theme: Theme = self.options.theme;
        let _ = writeln!(file, "<style>\n{}{}</style>", style::sheet(&self.styles, theme, self.unit()), self.rules);
        let _ = writeln!(file, "<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>");
        let captions: String = self.options.captions.iter().map(|caption| self.caption(caption)).collect();
        let captions = captions + &self.messages.svg(self.size, self.margin);
        if self.options.scale.is_some() {
            return format!(
                "{file}<g transform=\"scale({MILLIMETERS_PER_PIXEL})\">\n{}{captions}</g>\n</svg>\n",
                self.body
            );
        }
        file + &self.body + &captions + "</svg>\n"
    }
}

/// Returns the bounding box of the picture: the mechanism along its motion and at the shown moments, and all traces; of those that run away
/// only the part near everything else.
fn visible_bounds(scene: &Scene, motion: &Motion, moments: &Motion, options: &Options) -> [Vector; 2] {
    let visible = scene.reach(moments).into_iter().flatten();
    let mut all = bounds(scene.extent.into_iter().chain(visible)).unwrap_or(scene.extent);
    let pens_of_text = scene.traces.iter().map(|trace| trace.pen.clone());
    let pens: Vec<Pen> = pens_of_text.chain(options.traces.iter().map(|(_, anchor)| Pen::Point(*anchor))).collect();
    let positions = |pen: &Pen| -> Vec<Vector> {
        let track = motion.track(pen);
        (0..motion.len()).map(|row| track.in_row(motion, row)).filter(|position| is_finite(*position)).collect()
    };
    for pen in pens.iter().filter(|pen| matches!(pen, Pen::Point(_))) {
        all = bounds(all.into_iter().chain(positions(pen))).unwrap_or(all);
    }
    let [low, high] = all;
    let size = distance(low, high);
    let around = [low, high]
        .into_iter()
        .zip([-1.0, 1.0])
        .map(|(corner, sign)| corner.map(|part| part + sign * SHOWN_PART * size));
    let around: Vec<Vector> = around.collect();
    for pen in pens.iter().filter(|pen| matches!(pen, Pen::Columns { .. })) {
        let positions = positions(pen);
        let is_near = |position: &Vector| {
            (0..2).all(|part| around[0][part] <= position[part] && position[part] <= around[1][part])
        };
        let runs_away =
            bounds(positions.iter().copied()).is_some_and(|[low, high]| distance(low, high) > RUNAWAY * size);
        let near: Vec<Vector> = positions.iter().copied().filter(|position| !runs_away || is_near(position)).collect();
        all = bounds(all.into_iter().chain(near)).unwrap_or(all);
    }
    all
}
