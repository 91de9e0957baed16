//! `run`.

use super::shared::{Following, Input, Interval, vectors};
use clap::{Args, ValueEnum};
use mechc_pipeline::Vectors;

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(in crate::cli) struct RunArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else csv
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<Format>,

    /// Where the results go, as a JSON object of names and numbers in SI; they are printed to standard error in any case
    #[arg(long, value_name = "OUT.json")]
    pub results: Option<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// Only this time, followed from the start of the analysis, without results, which are of all of it. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    /// Only columns of this name, where `*` stands for anything and `?` for one character: `--columns 'rod.*'`; `t` stays. Repeatable
    #[arg(long, value_name = "PATTERN")]
    pub columns: Vec<String>,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA", conflicts_with = "at")]
    pub result: Vec<String>,

    /// Differentiate every column by an input or parameter too: `--by turn` adds `crank.phi.by.turn` and so on. Repeatable
    #[arg(long, value_name = "NAME")]
    pub by: Vec<String>,

    /// Tabulate what every joint exerts and every driver and constraint supplies: `NAME.fx`, `NAME.fy`, `NAME.torque`, `NAME.effort`
    #[arg(long)]
    pub reactions: bool,

    /// Assemble with the file's own values, and go over to those of `--set` along the branch
    #[arg(long)]
    pub lead: bool,

    #[command(flatten)]
    pub following: Following,

    /// The vector instructions that rows are solved for with; the widest that the processor has if not given. For tests: the numbers are
    /// the same
    #[arg(long, hide = true, value_name = "NAME", value_parser = vectors)]
    pub vectors: Option<Vectors>,

    /// Print to standard error where the time went
    #[arg(long)]
    pub timings: bool,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum Format {
    /// A header, then a row per time
    Csv,
    /// {"columns": […], "rows": [[…], …]}
    Json,
    /// Apache Parquet: columns of 64-bit numbers
    Parquet,
}
