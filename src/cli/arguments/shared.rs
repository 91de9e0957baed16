//! Arguments that several commands share.

use clap::{Args, ValueEnum};
use mechc_pipeline::Vectors;
use std::path::PathBuf;

/// Options of all commands that read a `.mech` file.
#[derive(Args, Debug)]
pub(in crate::cli) struct Input {
    /// The .mech file; `-` is standard input
    #[arg(value_name = "FILE")]
    pub file: String,

    /// Which mechanism, where the file holds several
    #[arg(long, value_name = "NAME")]
    pub mechanism: Option<String>,

    /// Set a parameter, with its unit: `--set crank_length=60mm`; a point as `--set 'A=(12mm,0)'` or `--set A.x=12mm`. Repeatable; the last
    /// of one name counts
    #[arg(long, value_name = "NAME=EXPR", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// What an input of the mechanism is, as a formula of `t`: `--input turn='30 deg + 2 rad/s * t'`. Repeatable, once for each
    #[arg(long = "input", value_name = "NAME=FORMULA", allow_hyphen_values = true)]
    pub signals: Vec<String>,

    /// Samples of inputs: a CSV file with a column `t` and one for each input, units in brackets (`turn [deg]`), joined by natural
    /// cubic splines; `-` is standard input
    #[arg(long, value_name = "FILE.csv")]
    pub samples: Option<PathBuf>,

    #[command(flatten)]
    pub messages: Messages,
}

/// Options for the messages of a command.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct Messages {
    /// How diagnostics are written
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,

    /// Whether diagnostics are coloured
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub color: When,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::cli) enum MessageFormat {
    /// With the lines they speak of
    #[default]
    Human,
    /// One line each
    Short,
    /// One JSON object a line
    Json,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::cli) enum When {
    /// On a terminal, unless `NO_COLOR` is set
    #[default]
    Auto,
    Always,
    Never,
}

/// Interval of an analysis, which overrides that of the file.
#[derive(Args, Clone, Debug, Default)]
pub(in crate::cli) struct Interval {
    /// First time, in seconds or with a unit; the motion is followed to it from the start of the file's analysis, or from 0 s
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub from: Option<String>,

    /// Last time
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub to: Option<String>,

    /// Step from one output time to the next
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub every: Option<String>,
}

/// Options for following a motion.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct Following {
    /// Bounds the residual of every equation, relative to the mechanism's size
    #[arg(long, value_name = "X", default_value = "1e-12", value_parser = tolerance)]
    pub tolerance: f64,

    /// Leave redundant equations out, and check them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Go on beyond a bifurcation, along the branch that continues smoothly
    #[arg(long)]
    pub pass_bifurcations: bool,
}

/// The maximum number of threads.
const MAX_JOBS: usize = 1024;

pub(super) fn jobs(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(jobs) if (1..=MAX_JOBS).contains(&jobs) => Ok(jobs),
        _ => Err(format!("a whole number from 1 to {MAX_JOBS} is wanted")),
    }
}

/// Parses a tolerance, which double precision bounds from below.
fn tolerance(text: &str) -> Result<f64, String> {
    match positive(text)? {
        value if value >= 1e-15 => Ok(value),
        _ => Err("no equation can be held to less than 1e-15 in numbers of sixteen digits".to_owned()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is wanted".to_owned()),
    }
}

pub(super) fn vectors(name: &str) -> Result<Vectors, String> {
    let names = Vectors::NAMES.join("`, `");
    Vectors::named(name).ok_or_else(|| format!("one of `{names}` is wanted that this processor has"))
}
