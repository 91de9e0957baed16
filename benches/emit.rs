//! Emits the modules that are measured.

use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RustOptions};
use std::error::Error;
use std::path::Path;

/// What becomes of each text: the name of the module, the text, and how many lanes it has.
const MODULES: [(&str, &str, Option<usize>); 4] = [
    ("four_bar", "steps/four_bar.mech", Some(16)),
    ("followed", "../tests/following/four_bar.mech", None),
    ("andrews", "steps/andrews.mech", None),
    ("jansen", "steps/jansen.mech", None),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::var("OUT_DIR")?;
    for (name, path, lanes) in MODULES {
        println!("cargo::rerun-if-changed={path}");
        let parsed = Parsed::new(path, &std::fs::read_to_string(path)?);
        let checked = parsed.check(&Choice::default(), &Memory::default());
        let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
        let compiled = compiled.ok_or_else(|| format!("{path} is not determined"))?;
        let (module, _) = compiled.rust(&RustOptions { lanes, ..RustOptions::new(path.to_owned()) });
        let module = module.ok_or_else(|| format!("{path} cannot be emitted"))?;
        // what is included may not begin with attributes of a file
        let is_inside = |line: &&str| !line.starts_with("//!") && !line.starts_with("#![");
        let lines: Vec<&str> = module.lines().filter(is_inside).collect();
        std::fs::write(Path::new(&folder).join(format!("{name}.rs")), lines.join("\n"))?;
    }
    Ok(())
}
