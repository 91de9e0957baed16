//! Sweeps a parameter and prints the results of each variant: how the length of the rod decides the peak acceleration of a piston.
//!
//! The first variant has a rod that is shorter than the crank: its status is the code of the diagnostic that ends its motion.

use mechc::{
    Cancel, Choice, Color, Diagnostic, Error, Format, Memory, Parsed, Redundant, Sources, SweepOptions, VaryOptions,
    render,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let choice = Choice {
        // each variant is reached from the values of the text, on their branch
        lead: true,
        results: vec!["stroke = max(travel) - min(travel)".to_owned(), "peak = max(abs(der(der(travel))))".to_owned()],
        ..Choice::default()
    };
    let world = Memory::default();
    let checked = Parsed::new("slider_crank.mech", include_str!("slider_crank.mech")).check(&choice, &world);
    report(checked.diagnostics().iter(), checked.sources());
    let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.ok_or_else(|| Error::new(diagnostics, checked.sources()))?;

    let vary = VaryOptions { params: vec!["rod_length=40mm..200mm:5".to_owned()], ..VaryOptions::default() };
    let variants = checked.variants(&vary, &choice, &world)?;
    // The closure runs on the threads that compute; a program that keeps little of a block reduces it there.
    let sweep = checked.sweep(&compiled, &variants, &SweepOptions::default(), |block| block)?;

    let params = variants.points().params().iter().cloned();
    let names: Vec<String> = params.chain(compiled.variant_results().into_iter().map(|(name, _)| name)).collect();
    println!("{} status", names.iter().map(|name| format!("{name:>10}")).collect::<Vec<_>>().join(" "));
    for block in sweep {
        for (variant, status) in block.statuses.iter().enumerate() {
            // columns of numbers in SI; a result without a value is NaN
            let values = block.params.iter().chain(&block.results).map(|column| format!("{:10.3}", column[variant]));
            println!("{} {}", values.collect::<Vec<_>>().join(" "), status.as_str());
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
