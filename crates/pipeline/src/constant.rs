//! Numbers that are told from outside.

use mechc_lang::check;
use mechc_lang::model::Dimension;
use mechc_syntax as syntax;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;

/// A time (s) that an option gives: a number of seconds, or a formula with units.
///
/// # Errors
/// It does not follow the grammar, or is no time.
pub fn seconds(option: &str, text: &str, sources: &mut Sources) -> Result<f64, Diagnostics> {
    let file = sources.add_option(option, text);
    let formula = syntax::parse_expression(sources, file)?;
    check::constant(&formula, &format!("the value of `{option}`"), Dimension::TIME, sources)
}
