//! Emits a mechanism as Rust: one module as a string, and the files of a crate around it.
//!
//! Without an argument it lists what there is; `cargo run --example emit_code -- DIR` writes the crate into a folder.

use mechc::{
    Cancel, Choice, Color, CrateFile, Diagnostic, Error, Format, Memory, Parsed, Redundant, RustOptions, Sources,
    render,
};
use std::fs;
use std::path::Path;

const FILE: &str = "slider_crank.mech";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let checked = Parsed::new(FILE, include_str!("slider_crank.mech")).check(&Choice::default(), &Memory::default());
    report(checked.diagnostics().iter(), checked.sources());
    let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.ok_or_else(|| Error::new(diagnostics, checked.sources()))?;

    let options = RustOptions::new(FILE);
    let (module, diagnostics) = compiled.rust(&options);
    let module = module.ok_or_else(|| Error::new(diagnostics, compiled.sources()))?;
    println!("functions of the module:");
    // what follows the mechanism's own functions is the solver
    let own = module.lines().take_while(|line| *line != "mod runtime {");
    for signature in own.filter_map(|line| line.strip_prefix("pub fn ")) {
        println!("  {}", signature.trim_end_matches(" {"));
    }

    let (files, diagnostics) = compiled.package("slider_crank", &options);
    println!("files of the crate:");
    for CrateFile { path, text } in files.ok_or_else(|| Error::new(diagnostics, compiled.sources()))? {
        println!("  {path}: {} lines", text.lines().count());
        if let Some(folder) = std::env::args().nth(1) {
            let path = Path::new(&folder).join(path);
            fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
            fs::write(path, text)?;
        }
    }
    Ok(())
}

/// Writes diagnostics to standard error, with the lines of the text that they point to.
fn report<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>, sources: &Sources) {
    for diagnostic in diagnostics {
        eprint!("{}", render(diagnostic, sources, Format::Human, Color::Never));
    }
}
