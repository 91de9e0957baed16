//! The C interface of a mechanism: a header, and its functions, the only unsafe code of an emitted crate.
//!
//! The caller owns all memory. A state is an opaque array of words that only these functions access; params and inputs are plain
//! structures of the crate with C layout. One list (`functions.rs`) defines the arguments and results of functions,
//! from which both files are generated.

mod functions;
mod header;
mod names;

use super::errors::ERRORS;
use super::names::Case;
use super::rust::Module;
use super::text::{one_line, unit};
use super::{CrateFile, TranslationUnit};
use mechc_ir::layout::{ColumnContent, ColumnUnit, columns, holds};

/// Context of both files.
struct Interface<'i> {
    unit: &'i TranslationUnit<'i>,
    /// Prefix of names: `four_bar`.
    prefix: &'i str,
    /// Line near the top of each file that marks it as emitted.
    mark: &'i str,
    /// Words of 8 bytes that a state takes.
    words: usize,
    /// Upper bounds of the steps of calls, and of their evaluations.
    bounds: &'i [(&'static str, usize)],
}

/// Returns the header and the source file of the functions; all names begin with that of the library.
pub(super) fn files(unit: &TranslationUnit<'_>, module: &Module, library: &str, mark: &str) -> Vec<CrateFile> {
    let interface = Interface { unit, prefix: library, mark, words: module.words + 1, bounds: &module.bounds };
    vec![
        CrateFile { path: format!("include/{library}.h"), text: interface.header() },
        CrateFile { path: "src/unsafe_c.rs".to_owned(), text: interface.functions() },
    ]
}

/// Return code of a function.
struct Code {
    /// `LOCK_UP`
    name: String,
    message: &'static str,
    /// Variant of the Rust error; `None` for errors that only C can cause.
    error: Option<&'static str>,
}

/// First code of the errors that only C can cause; they come after those of `Error`.
const FIRST_C_CODE: i32 = 101;
/// Message of the status that is no error; its code is below 0.
const IN_PROGRESS: &str = "the state is on its way, and the same call goes on";
const C_ERRORS: [(&str, &str); 4] = [
    ("BAD_POINTER", "a pointer is null or not aligned"),
    ("NOT_ASSEMBLED", "the state is not one that was assembled for this mechanism"),
    ("WRONG_LENGTH", "the list has another length"),
    ("NO_SUCH_COLUMN", "there is no such column"),
];

/// Returns all codes with their numbers, including 0 and the status that is no error.
fn codes() -> Vec<(i32, Code)> {
    let fine = Code { name: "OK".to_owned(), message: "all went well", error: None };
    let errors =
        ERRORS.iter().map(|error| Code { name: constant(error.name), message: error.message, error: Some(error.name) });
    let c_errors = C_ERRORS.iter().map(|(name, message)| Code { name: (*name).to_owned(), message, error: None });
    let numbers = (0..).take(ERRORS.len() + 1).chain(FIRST_C_CODE..);
    let in_progress = Code { name: "ON_THE_WAY".to_owned(), message: IN_PROGRESS, error: None };
    let all = numbers.zip(std::iter::once(fine).chain(errors).chain(c_errors));
    std::iter::once((-1, in_progress)).chain(all).collect()
}

/// Converts `NotANumber` to `NOT_A_NUMBER`.
fn constant(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !text.is_empty() {
            text.push('_');
        }
        text.push(c.to_ascii_uppercase());
    }
    text
}

impl Interface<'_> {
    fn has_params(&self) -> bool {
        !self.unit.system.params().is_empty()
    }

    fn has_inputs(&self) -> bool {
        self.unit.following.is_some()
    }

    fn has_sensitivity(&self) -> bool {
        self.has_params() && self.unit.has_sensitivity()
    }

    /// Returns the prefix of constants: `FOUR_BAR`.
    fn constants(&self) -> String {
        self.prefix.to_uppercase()
    }

    /// Returns the columns of a row: their names in C, and their contents with SI units.
    fn columns(&self) -> Vec<(String, String)> {
        let system = self.unit.system;
        // forces have a list of their own
        let columns = columns(system).into_iter().zip(holds(system));
        let columns: Vec<_> = columns.filter(|(_, holds)| !matches!(holds, ColumnContent::Reaction(_))).collect();
        let names = Case::Constant.names(columns.iter().map(|(column, _)| column.name.as_str()));
        let descriptions = columns.iter().map(|(column, holds)| {
            let (name, ColumnUnit { text, .. }) = (one_line(&column.name), &column.unit);
            match *holds {
                ColumnContent::Measure { index, .. }
                    if system.measures()[index].units.si != system.measures()[index].units.printed[0] =>
                {
                    format!("{name} (SI; tables have it in {text})")
                }
                _ => format!("{name} ({})", unit(text)),
            }
        });
        names.into_iter().zip(descriptions).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{FIRST_C_CODE, codes};

    #[test]
    fn codes_have_unique_names_and_numbers() {
        let codes = codes();
        let names: Vec<&str> = codes.iter().map(|(_, code)| code.name.as_str()).collect();
        assert_eq!(names[..4], ["ON_THE_WAY", "OK", "NOT_A_NUMBER", "LOCK_UP"]);
        assert!((-1..8).zip(&codes).all(|(k, (number, _))| k == *number));
        assert_eq!(codes[9].0, FIRST_C_CODE);
    }
}
