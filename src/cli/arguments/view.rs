//! `view`.

use super::shared::{Input, Interval};
use clap::{Args, ValueEnum};

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(in crate::cli) struct ViewArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the picture goes; without it a page is served that follows the file. Its ending says what is drawn (.svg, .html, .dxf), `%04d` in its name a film's pictures, `plots.svg` plots
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<String>,

    /// Open the page that follows the file in the browser
    #[arg(long, conflicts_with = "output")]
    pub open: bool,

    /// The port of the page that follows the file; one that is free if not given
    #[arg(long, value_name = "PORT", conflicts_with = "output")]
    pub port: Option<u16>,

    /// A slider on the page for a parameter: N values from A to B, each solved beforehand: `--vary rod_length=120mm..180mm:13`. Twice
    /// at most
    #[arg(long, value_name = "NAME=A..B:N", allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// Plots of all measures over time, whatever OUT.svg is called
    #[arg(long, conflicts_with_all = ["at", "trace", "vectors", "labels", "scale", "body"])]
    pub plots: bool,

    /// The mechanism at this time, in seconds or with a unit. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// The path of a point too: `--trace coupler.pen`. Repeatable
    #[arg(long, value_name = "P")]
    pub trace: Vec<String>,

    /// Velocities and accelerations at pins and traced points, as arrows
    #[arg(long)]
    pub vectors: bool,

    /// What joints exert, loads and weights, as arrows to one scale; with `--plots` plots of these, and of what drivers supply
    #[arg(long)]
    pub forces: bool,

    /// The names of bodies and pins
    #[arg(long)]
    pub labels: bool,

    /// Width and height in pixels: `--size 1280x720`; 800 wide at most, and as high as it takes, if not given
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[f64; 2]>,

    /// True to scale, in millimetres of paper: `--scale 1:2` is half as large as the mechanism
    #[arg(long, value_name = "A:B", value_parser = scale, conflicts_with = "size")]
    pub scale: Option<f64>,

    /// One body alone, in its own frame, with all that is fixed to it
    #[arg(long, value_name = "NAME", conflicts_with_all = ["at", "trace", "vectors", "forces"])]
    pub body: Option<String>,

    /// Which colours
    #[arg(long, value_enum, default_value_t, value_name = "THEME")]
    pub theme: ThemeChoice,

    /// Leave redundant equations out, and check them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Go on beyond a bifurcation, along the branch that continues smoothly
    #[arg(long)]
    pub pass_bifurcations: bool,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::cli) enum ThemeChoice {
    /// As the reader's machine is set
    #[default]
    Auto,
    /// Dark on light
    Light,
    /// Light on dark
    Dark,
}

/// Pictures are no smaller and no larger than this (px).
const SIDES: [f64; 2] = [16.0, 16_384.0];

/// Scales are no smaller and no larger than this.
const SCALES: [f64; 2] = [1e-6, 1e6];

fn scale(text: &str) -> Result<f64, String> {
    let parts = text.split_once(':').map(|(on_paper, real)| [on_paper, real].map(|part| part.trim().parse::<f64>()));
    match parts {
        Some([Ok(on_paper), Ok(real)]) if (SCALES[0]..=SCALES[1]).contains(&(on_paper / real)) => Ok(on_paper / real),
        _ => Err("what a length is on paper and what it is are wanted, as in `1:2` or `10:1`".to_owned()),
    }
}

fn size(text: &str) -> Result<[f64; 2], String> {
    let sides =
        text.split_once(['x', '×']).map(|(width, height)| [width, height].map(|side| side.trim().parse::<f64>()));
    match sides {
        Some([Ok(width), Ok(height)]) if [width, height].iter().all(|side| (SIDES[0]..=SIDES[1]).contains(side)) => {
            Ok([width, height])
        }
        _ => Err(format!("width and height in pixels are wanted, from {} to {}, as in `1280x720`", SIDES[0], SIDES[1])),
    }
}
