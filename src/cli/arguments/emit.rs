//! `emit`.

use super::shared::Input;
use clap::{Args, ValueEnum};

#[derive(Args, Debug)]
pub(in crate::cli) struct EmitArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the code goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// Write a whole crate into this folder, named like it: the module, a page, a test against `mechc run`, a benchmark
    #[arg(long = "crate", value_name = "DIR", conflicts_with = "output")]
    pub folder: Option<String>,

    /// With --crate: a C header and the functions behind it too, for firmware and programs in C or C++
    #[arg(long)]
    pub ffi: bool,

    /// What to write; by the ending of OUT (.tex, .json) if not given, else rust
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<EmitFormat>,

    /// What Rust code can do
    #[arg(long, value_enum, value_name = "WHAT", default_value = "solver")]
    pub with: Content,

    /// Leave redundant equations out; the emitted code checks them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Solve for N variants or times at once too, in vector instructions where the target has them
    #[arg(long, value_name = "N", value_parser = lanes)]
    pub lanes: Option<usize>,
}

/// The maximum number of lanes; the data of more do not fit into a cache.
const MAX_LANES: usize = 256;

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum EmitFormat {
    /// A module without dependencies, for firmware and simulators
    Rust,
    /// A document that typesets Φ, Φ_q, ν and γ, element by element
    Latex,
    /// The whole constraint system as data, formulas as text
    Json,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::cli) enum Content {
    /// Assemble the mechanism and follow its motion, as `mechc run` does
    Solver,
    /// The same, and the derivatives of the coordinates by each parameter
    Sensitivities,
    /// Evaluate its equations only
    Equations,
}

fn lanes(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(lanes) if (1..=MAX_LANES).contains(&lanes) => Ok(lanes),
        _ => Err(format!("a whole number from 1 to {MAX_LANES} is wanted")),
    }
}
