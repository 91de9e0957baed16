//! Commands with few options.

use super::shared::{Input, Messages};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(in crate::cli) struct CheckArguments {
    #[command(flatten)]
    pub input: Input,

    /// Leave redundant equations out
    #[arg(long)]
    pub allow_redundant: bool,

    /// Write what the text can only have meant into FILE, say what was changed, and check that
    #[arg(long)]
    pub fix: bool,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct FmtArguments {
    /// The .mech files, or folders of them; `-` is standard input, which goes to standard output
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<String>,

    /// Write nothing; print what would change, and exit with 1 if anything would
    #[arg(long)]
    pub check: bool,

    #[command(flatten)]
    pub messages: Messages,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct DumpArguments {
    #[command(flatten)]
    pub input: Input,

    /// What to show
    #[arg(long, value_enum, value_name = "STAGE")]
    pub stage: Stage,

    /// Where the text goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum Stage {
    /// The syntax tree, as it would be written
    Ast,
    /// The checked mechanism
    Model,
    /// The constraint system
    Ir,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct ImportArguments {
    /// The model file; `-` is standard input
    #[arg(value_name = "MODEL.adm")]
    pub model: String,

    /// The settings file with the times of the analysis; `-` is standard input
    #[arg(long, value_name = "FILE")]
    pub acf: Option<String>,

    #[command(flatten)]
    pub messages: Messages,

    /// Where the text goes; `-` is standard output
    #[arg(short, long, value_name = "OUT.mech", default_value = "-")]
    pub output: String,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct FormulaArguments {
    /// A formula of the time `t`, as a driver takes it; it may hold units and functions of the language
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    pub formula: String,

    /// A time to evaluate it at, in seconds or with a unit. Repeatable; sorted, and each printed once
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    #[command(flatten)]
    pub messages: Messages,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct ExplainArguments {
    /// The code, in capitals or not, or the word; without it all codes are listed
    #[arg(value_name = "CODE|NAME")]
    pub name: Option<String>,

    #[command(flatten)]
    pub messages: Messages,
}

/// Options of the language server.
#[cfg(feature = "lsp")]
#[derive(Args, Debug)]
pub(in crate::cli) struct LspArguments {
    /// Write every message with its time, and what the server did, into FILE
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,

    /// What many clients add; it speaks over standard input and output anyway
    #[arg(long, hide = true)]
    pub stdio: bool,
}
