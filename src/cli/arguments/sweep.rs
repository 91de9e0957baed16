//! `sweep` and `tolerance`.

use super::shared::{Following, Input, Interval, jobs, vectors};
use clap::{Args, ValueEnum};
use mechc_pipeline::Vectors;

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(in crate::cli) struct SweepArguments {
    #[command(flatten)]
    pub input: Input,

    /// What varies: `rod=100mm..200mm:50` (50 values, both ends included), `speed=60rpm,90rpm`, `@variants.csv`, or `rod=100mm..200mm` with
    /// --sample. Repeatable; all are combined
    #[arg(long, value_name = "NAME=A..B:N", required = true, allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// So many points within the ranges that have no number of values
    #[arg(long, value_name = "N")]
    pub sample: Option<u64>,

    /// How the points of a sample are spread; sobol if not given
    #[arg(long, value_enum, value_name = "METHOD")]
    pub method: Option<MethodChoice>,

    /// Which of the samples of its kind it is
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else csv
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<SheetFormat>,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA")]
    pub result: Vec<String>,

    /// A column `digits`: how many digits are certain of all results of a variant. It takes longer, for each is computed on its own
    #[arg(long, conflicts_with = "rows")]
    pub digits: bool,

    /// The whole motion of every variant, rather than its results
    #[arg(long)]
    pub rows: bool,

    /// With --rows: only columns of this name, where `*` stands for anything and `?` for one character; `t` stays. Repeatable
    #[arg(long, value_name = "PATTERN", requires = "rows")]
    pub columns: Vec<String>,

    /// Stop at the first variant that runs to its end with this, a condition over results and params: `--until 'stroke > 80 mm'`
    #[arg(long, value_name = "CONDITION")]
    pub until: Option<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// With --rows: only this time, followed from the start of the analysis. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    /// With --rows: differentiate every column by an input or parameter too. Repeatable
    #[arg(long, value_name = "NAME", requires = "rows")]
    pub by: Vec<String>,

    /// With --rows: tabulate what every joint exerts and every driver and constraint supplies
    #[arg(long, requires = "rows")]
    pub reactions: bool,

    /// Pass over the first K variants
    #[arg(long, value_name = "K", default_value = "0", hide_default_value = true)]
    pub skip: u64,

    /// N variants at the most
    #[arg(long, value_name = "N")]
    pub take: Option<u64>,

    /// So many threads, the one that writes among them; as many as the machine does at once if not given
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub jobs: Option<usize>,

    /// More than 10⁹ variants are meant
    #[arg(long)]
    pub yes: bool,

    #[command(flatten)]
    pub following: Following,

    /// As `run` has it. For tests: the numbers are the same
    #[arg(long, hide = true, value_name = "NAME", value_parser = vectors)]
    pub vectors: Option<Vectors>,
}

/// The form of a table of variants.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum SheetFormat {
    /// A header, then a line per row
    Csv,
    /// An object a line: {"variant": 0, …}
    Json,
    /// Apache Parquet
    Parquet,
}

/// Methods of sampling.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum MethodChoice {
    /// Evenly, by Sobol's sequence: any first part of it fills the ranges
    Sobol,
    /// Each point for itself
    Random,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct ToleranceArguments {
    #[command(flatten)]
    pub input: Input,

    /// How far a param may be off: `rod=0.05mm` for ±0.05 mm, `rod=-0.1mm..0mm` for what it may be below and above; `A.x=0.02mm` for a
    /// coordinate of a point. Repeatable
    #[arg(long, value_name = "NAME=AMOUNT", required = true, allow_hyphen_values = true)]
    pub tol: Vec<String>,

    /// Params are spread normally, and what they may be off is 3 σ; if not given, they are anywhere within alike
    #[arg(long)]
    pub normal: bool,

    /// Run the corners too, and say where derivatives are not enough: all corners of up to 12 params, of more the worst ones and 10,000 samples
    #[arg(long)]
    pub verify: bool,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA")]
    pub result: Vec<String>,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else table
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<ContributionFormat>,

    #[command(flatten)]
    pub interval: Interval,

    /// With --verify: so many threads; as many as the machine does at once if not given
    #[arg(long, value_name = "N", value_parser = jobs, requires = "verify")]
    pub jobs: Option<usize>,

    #[command(flatten)]
    pub following: Following,
}

/// The form of a table of contributions.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum ContributionFormat {
    /// To be read
    Table,
    /// A header, then a line for each contribution and each sum, all numbers in SI
    Csv,
    /// One object, all numbers in SI
    Json,
}
