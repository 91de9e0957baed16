//! The library for a host that runs WebAssembly: texts in, a table out.
//!
//! A text is handed over byte by byte, and so is the answer: that is slow, and needs nothing but numbers.

#[path = "../../support/deep_texts.rs"]
mod deep_texts;

use deep_texts::{deep_texts, run_all_stages, table};
use mechc::{Cancel, Choice, Color, Format, Memory, Parsed, Redundant, render};
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
    let (Ok(answer) | Err(answer)) = table_of(texts);
    answered(answer)
}

fn table_of(mut texts: impl Iterator<Item = String>) -> Result<String, String> {
    let parsed = Parsed::new("handed over", &texts.next().unwrap_or_default());
    let mut world = Memory::default();
    while let (Some(name), Some(text)) = (texts.next(), texts.next()) {
        world = world.with(name, text);
    }
    let checked = parsed.check(&Choice::default(), &world);
    let (compiled, mut said) = checked.compile(Redundant::Refused, &Cancel::default());
    let made = match compiled {
        Some(compiled) => table(&compiled),
        None => {
            said.extend(checked.diagnostics().iter().cloned());
            Err(said)
        }
    };
    made.map_err(|said| said.iter().map(|one| render(one, checked.sources(), Format::Human, Color::Never)).collect())
}

/// What becomes of the text that is deep in one of the ways that there are; 0 where there is no such way.
#[unsafe(no_mangle)]
pub extern "C" fn run_deep(way: usize) -> usize {
    deep_texts().get(way).map_or(0, |deep| {
        answered(match run_all_stages(deep) {
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
