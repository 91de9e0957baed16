//! The library for a host that runs WebAssembly: texts in, a table out.
//!
//! A text is handed over byte by byte, and so is the answer: that is slow, and needs nothing but numbers.

#[path = "../../support/deepest.rs"]
mod deepest;

use deepest::{all_ways, deepest, table};
use mechc::check::{self, Surroundings};
use mechc::diag::{Color, Diagnostics, Format, render};
use mechc::source::Sources;
use mechc::syntax;
use std::cell::RefCell;

thread_local! {
    /// The texts that were handed over: a file, and the name and text of each file that its tables name.
    static TEXTS: RefCell<Vec<Vec<u8>>> = const { RefCell::new(Vec::new()) };
    /// What the last call gave.
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Begins a text.
#[unsafe(no_mangle)]
pub extern "C" fn begin_text() {
    TEXTS.with_borrow_mut(|texts| texts.push(Vec::new()));
}

/// Adds a byte to the last text.
#[unsafe(no_mangle)]
pub extern "C" fn put(byte: u8) {
    TEXTS.with_borrow_mut(|texts| texts.last_mut().map(|text| text.push(byte)));
}

/// A byte of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn get(at: usize) -> u8 {
    ANSWER.with_borrow(|answer| answer.as_bytes().get(at).copied().unwrap_or(0))
}

/// The table of what was handed over, or what is wrong with it; gives its length.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> usize {
    let texts = TEXTS.take().into_iter().map(|text| String::from_utf8_lossy(&text).into_owned());
    let mut sources = Sources::default();
    let (Ok(answer) | Err(answer)) = table_of(texts, &mut sources)
        .map_err(|said| said.iter().map(|one| render(one, &sources, Format::Human, Color::Never)).collect());
    answered(answer)
}

fn table_of(mut texts: impl Iterator<Item = String>, sources: &mut Sources) -> Result<String, Diagnostics> {
    let file = sources.add("handed over", texts.next().unwrap_or_default());
    let mut surroundings = Surroundings::default();
    while let (Some(name), Some(text)) = (texts.next(), texts.next()) {
        surroundings.files.insert(name.clone(), Ok(sources.add(name, text)));
    }
    let parsed = syntax::parse(sources, file);
    let said = check::check_file(&parsed.tree);
    let Some(mechanism) = parsed.tree.mechanisms.first().filter(|_| parsed.faults.is_empty() && !said.has_errors())
    else {
        return Err(parsed.faults);
    };
    let (determined, said) = mechc::compile(mechanism, &surroundings, sources);
    table(&determined.ok_or(said)?)
}

/// What becomes of the text that is deep in one of the ways that there are; 0 where there is no such way.
#[unsafe(no_mangle)]
pub extern "C" fn run_deep(way: usize) -> usize {
    deepest().get(way).map_or(0, |deep| {
        answered(match all_ways(deep) {
            Ok(table) => format!("{}: ok\n{table}", deep.name),
            Err(said) => format!("{}: refused\n{said}", deep.name),
        })
    })
}

fn answered(answer: String) -> usize {
    ANSWER.with_borrow_mut(|known| {
        *known = answer;
        known.len()
    })
}
