//! Style sheet in light and in dark. Colours are written out, since not every renderer supports variables.

use super::Theme;
use crate::scene::Look;
use crate::view::text::decimal;
use std::collections::BTreeSet;
use unicode_width::UnicodeWidthChar;

/// Size of letters of the smallest and the largest pictures (px).
const LETTER_SIZES: [f64; 2] = [13.0, 18.0];
/// Size of letters as a part of the picture's shorter side.
const LETTER_SIZE: f64 = 1.0 / 42.0;
/// Width of a column as a part of the size of letters: on average, wide fonts are no wider.
pub(super) const COLUMN_WIDTH: f64 = 0.66;

/// Number of tints of bodies.
pub(super) const TINTS: usize = 8;
/// Number of colours of traces.
pub(super) const TRACE_COLORS: usize = 4;

/// Returns the size of letters (px) for a picture of a size (px).
pub(super) fn letter_size(size: [f64; 2]) -> f64 {
    (LETTER_SIZE * size[0].min(size[1])).clamp(LETTER_SIZES[0], LETTER_SIZES[1])
}

/// Returns the number of columns of a text on a screen.
pub(super) fn text_columns(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0)).sum()
}

/// Contents of a picture that need rules.
#[derive(Default)]
#[allow(clippy::struct_excessive_bools)] // each has rules of its own
pub(super) struct StyleUsage {
    pub looks: BTreeSet<Look>,
    pub tints: BTreeSet<usize>,
    pub traces: BTreeSet<usize>,
    /// Size of letters (px), if there are any.
    pub labels: Option<f64>,
    pub has_ghosts: bool,
    /// True if a filled shape is on the ground.
    pub is_ground_filled: bool,
    pub vectors: BTreeSet<&'static str>,
    /// True if a message names a declaration.
    pub is_named: bool,
    /// True if a message has a position.
    pub has_remarks: bool,
    /// True if a label has a leader.
    pub has_leaders: bool,
    /// Size of letters of the messages below (px), if there are any.
    pub messages: Option<f64>,
}

/// Colours of a theme.
struct Palette {
    paper: &'static str,
    ink: &'static str,
    /// Colour of secondary lines.
    quiet: &'static str,
    /// Fill of parts of the ground.
    ground: &'static str,
    /// Colour of drivers.
    driven: &'static str,
    tints: [&'static str; TINTS],
    traces: [&'static str; TRACE_COLORS],
    /// Colour of free motions.
    free: &'static str,
    /// Colour of what a message names.
    wrong: &'static str,
    velocity: &'static str,
    acceleration: &'static str,
    reaction: &'static str,
    load: &'static str,
    weight: &'static str,
}

const LIGHT: Palette = Palette {
    paper: "#fff",
    ink: "#1d2a36",
    quiet: "#6b7785",
    ground: "#e2e7ec",
    driven: "#0d5fb3",
    tints: ["#bcd9f5", "#ffd3a1", "#c4e6bd", "#f6c3cb", "#d9cdf2", "#f5e79e", "#b9e6e4", "#e3d0bd"],
    traces: ["#c2185b", "#1565c0", "#6a1b9a", "#b45309"],
    free: "#7a2fb5",
    wrong: "#c01c28",
    velocity: "#0a7d34",
    acceleration: "#c62828",
    reaction: "#8e24aa",
    load: "#c75000",
    weight: "#5d6b78",
};

const DARK: Palette = Palette {
    paper: "#11181f",
    ink: "#e8eef4",
    quiet: "#8b98a6",
    ground: "#2b3641",
    driven: "#7ab8ff",
    tints: ["#2b5782", "#80551f", "#35703c", "#833b49", "#584687", "#766620", "#2a6f6d", "#66503c"],
    traces: ["#ff6fa5", "#6db3ff", "#c99bff", "#ffb454"],
    free: "#cf9dff",
    wrong: "#ff7b7b",
    velocity: "#5bd98a",
    acceleration: "#ff7b72",
    reaction: "#da8cff",
    load: "#ffa24d",
    weight: "#a9b6c2",
};

/// Returns the rules for everything that is used; `unit` is the symbol unit (px).
pub(super) fn sheet(usage: &StyleUsage, theme: Theme, unit: f64) -> String {
    let strong = (0.1 * unit).clamp(0.5, 2.0);
    themed(shapes(usage, strong), theme, |palette| colors(usage, palette))
}

/// Returns the rules for plots, with a number of curves and a size of letters (px).
pub(super) fn plot_sheet(curves: usize, theme: Theme, letters: f64) -> String {
    let colors = |palette: &Palette| {
        let &Palette { paper, ink, quiet, .. } = palette;
        let mut rules =
            format!(".paper{{fill:{paper}}}\ntext{{fill:{ink}}}\n.grid{{stroke:{quiet}}}\n.axes{{stroke:{ink}}}\n");
        for curve in 0..curves {
            rules += &format!(".t{curve}{{stroke:{}}}\n", palette.traces[curve]);
        }
        rules
    };
    let shared = format!(
        "text{{font:{}px system-ui,sans-serif}}\n.name{{font-weight:600}}\n.beside{{text-anchor:end}}\n.below{{text-anchor:middle}}\n\
         path{{fill:none;stroke-linecap:round;stroke-linejoin:round}}\n.grid{{stroke-width:.5;stroke-opacity:.5}}\n\
         .axes{{stroke-width:1}}\n.curve{{stroke-width:1.8}}\n",
        decimal(letters, 1)
    );
    themed(shared, theme, colors)
}

/// Appends the colours of a theme to a sheet.
fn themed(mut sheet: String, theme: Theme, colors: impl Fn(&Palette) -> String) -> String {
    match theme {
        Theme::Light => sheet += &colors(&LIGHT),
        Theme::Dark => sheet += &colors(&DARK),
        Theme::Auto => {
            sheet += &colors(&LIGHT);
            sheet += &format!("@media (prefers-color-scheme:dark){{\n{}}}\n", colors(&DARK));
        }
    }
    sheet
}

/// Returns widths and dashes, which both themes share.
fn shapes(usage: &StyleUsage, strong: f64) -> String {
    let width = |part: f64| decimal(part * strong, 2);
    let mut rules = format!("path,circle{{stroke-width:{};stroke-linecap:round;stroke-linejoin:round}}\n", width(1.0));
    for look in &usage.looks {
        let rule = match look {
            Look::Hatching => format!("stroke-width:{}", width(0.6)),
            Look::GroundLine | Look::Guide | Look::Track => format!("stroke-width:{}", width(1.25)),
            Look::Pitch => {
                format!("stroke-width:{};stroke-dasharray:{} {} {0} {1}", width(0.6), width(4.0), width(2.5))
            }
            Look::Face => format!("stroke-width:{}", width(3.0)),
            Look::Belt => format!("stroke-width:{}", width(2.2)),
            Look::Arrow => format!("stroke-width:{}", width(1.6)),
            Look::Free => format!("stroke-width:{};stroke-dasharray:{} {}", width(1.6), width(3.2), width(2.6)),
            Look::FreeHead => format!("stroke-width:{}", width(1.3)),
            Look::Gap => format!("stroke-width:{};stroke-dasharray:{} {}", width(1.4), width(2.4), width(2.6)),
            Look::GapEnd => format!("stroke-width:{}", width(1.4)),
            Look::Named => format!("stroke-width:{};stroke-dasharray:{} {}", width(1.8), width(4.5), width(2.6)),
            Look::Spring => format!("stroke-width:{};vector-effect:non-scaling-stroke", width(1.2)),
            Look::Gear | Look::Rack => format!("stroke-width:{};fill-rule:evenodd", width(0.8)),
            _ => continue,
        };
        rules += &format!(".{}{{{rule}}}\n", look.word());
    }
    if !usage.traces.is_empty() {
        rules += &format!(".trace{{fill:none;stroke-width:{}}}\n", width(1.1));
    }
    if let Some(size) = usage.labels {
        rules += &format!(
            "text{{font:{}px system-ui,sans-serif;text-anchor:middle;stroke-width:3;stroke-linejoin:round;paint-order:stroke}}\n\
             .body-name{{font-weight:600}}\n.point-name{{font-style:italic}}\n.legend{{text-anchor:start}}\n",
            decimal(size, 1)
        );
    }
    if usage.has_ghosts {
        rules += ".ghost{opacity:.3}\n";
    }
    if usage.is_named {
        rules += &format!(
            ".named path,.named circle{{stroke-width:{}}}\n.named .link{{stroke-dasharray:{} {}}}\n",
            width(1.7),
            width(5.0),
            width(2.6)
        );
    }
    if let Some(size) = usage.messages {
        rules += &format!(".said{{font:{}px system-ui,sans-serif;text-anchor:start;stroke:none}}\n", decimal(size, 1));
    }
    if !usage.vectors.is_empty() {
        // a velocity stays visible below an acceleration of the same direction
        rules += &format!(
            ".vector{{stroke-width:{};vector-effect:non-scaling-stroke}}\n.velocity{{stroke-width:{}}}\n",
            width(0.9),
            width(1.7)
        );
    }
    rules
}

fn colors(usage: &StyleUsage, palette: &Palette) -> String {
    let &Palette { paper, ink, quiet, driven, free, wrong, .. } = palette;
    let mut rules = format!(".paper{{fill:{paper}}}\n");
    let mut group = |looks: &[Look], rule: &str| {
        let words: Vec<String> =
            looks.iter().filter(|look| usage.looks.contains(look)).map(|look| format!(".{}", look.word())).collect();
        if !words.is_empty() {
            rules += &format!("{}{{{rule}}}\n", words.join(","));
        }
    };
    // the tint of a body comes from its group
    group(&[Look::Link, Look::Cam, Look::Gear, Look::Rack], &format!("stroke:{ink};fill-opacity:.82"));
    group(&[Look::Block], &format!("stroke:{ink}"));
    group(&[Look::Pin, Look::Roller, Look::Slot, Look::Sleeve, Look::Support], &format!("fill:{paper};stroke:{ink}"));
    group(&[Look::MasslessLink, Look::Cylinder, Look::Rod], &format!("fill:{paper};stroke:{ink}"));
    group(&[Look::Weld, Look::Dot], &format!("fill:{ink};stroke:{ink}"));
    group(
        &[Look::Cross, Look::GroundLine, Look::Guide, Look::Track, Look::Spring, Look::Face, Look::Belt],
        &format!("fill:none;stroke:{ink}"),
    );
    group(&[Look::Hatching, Look::Pitch], &format!("fill:none;stroke:{quiet}"));
    group(&[Look::Arrow], &format!("fill:none;stroke:{driven}"));
    group(&[Look::ArrowHead], &format!("fill:{driven};stroke:none"));
    group(&[Look::Free], &format!("fill:none;stroke:{free}"));
    group(&[Look::FreeHead], &format!("fill:{paper};stroke:{free}"));
    group(&[Look::Gap, Look::GapEnd], &format!("fill:none;stroke:{ink}"));
    group(&[Look::Named], &format!("fill:none;stroke:{wrong}"));
    if usage.is_ground_filled {
        rules += &format!(".b-ground{{fill:{}}}\n", palette.ground);
    }
    for tint in &usage.tints {
        rules += &format!(".b{tint}{{fill:{}}}\n", palette.tints[tint % TINTS]);
    }
    for trace in &usage.traces {
        rules += &format!(".t{trace}{{stroke:{}}}\n", palette.traces[trace % TRACE_COLORS]);
    }
    for (word, color) in [
        ("velocity", palette.velocity),
        ("acceleration", palette.acceleration),
        ("reaction", palette.reaction),
        ("load", palette.load),
        ("weight", palette.weight),
    ] {
        if usage.vectors.contains(word) {
            rules += &format!(".{word}{{stroke:{color};fill:{color}}}\n");
        }
    }
    if usage.is_named {
        rules += &format!(
            ".named path,.named circle{{stroke:{wrong}}}\n.named .arrow-head,.named .dot,.named .weld{{fill:{wrong}}}\n"
        );
    }
    if usage.labels.is_some() {
        rules += &format!("text{{fill:{ink};stroke:{paper}}}\n");
    }
    if usage.has_leaders {
        rules += &format!(".leader{{fill:none;stroke:{ink};stroke-width:1}}\n");
    }
    if usage.has_remarks {
        rules += &format!(".remark{{fill:{wrong}}}\n");
    }
    if usage.messages.is_some() {
        rules += &format!(".said{{fill:{wrong}}}\n");
    }
    rules
}
