//! `mechc --licenses`: what the licences of all that the program carries ask to be said.

use super::failure::Failure;
use super::files;
use mechc_draw::view::page;

/// Of the crates (`tests/program/licenses.rs` writes it).
const OF_CRATES: &str = include_str!("licenses.txt");

pub(super) fn print() -> Result<(), Failure> {
    let own = concat!("mechc ", env!("CARGO_PKG_VERSION"), ": ", env!("CARGO_PKG_LICENSE"));
    let pages = page::NOTICES.trim_end();
    let library = "It is built with the standard library of Rust: MIT OR Apache-2.0, https://github.com/rust-lang/rust";
    files::print(&format!("{own}\n{library}\n\n\nIn the pages that `mechc view` writes\n\n{pages}\n\n\n{OF_CRATES}"))
}
