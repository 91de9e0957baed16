//! `mechc --licenses`: the notices that the licences of dependencies require.

use super::failure::Failure;
use super::files;
use mechc_draw::view::page;

/// The licences of the crates (`tests/program/licenses.rs` writes the file).
const CRATE_LICENSES: &str = include_str!("licenses.txt");

pub(super) fn print() -> Result<(), Failure> {
    let program = concat!("mechc ", env!("CARGO_PKG_VERSION"), ": ", env!("CARGO_PKG_LICENSE"));
    let pages = page::NOTICES.trim_end();
    let library = "It is built with the standard library of Rust: MIT OR Apache-2.0, https://github.com/rust-lang/rust";
    files::print(&format!(
        "{program}\n{library}\n\n\nIn the pages that `mechc view` writes\n\n{pages}\n\n\n{CRATE_LICENSES}"
    ))
}
