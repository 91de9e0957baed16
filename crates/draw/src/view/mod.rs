//! Writers: a scene and its motion as files for those who look. Each form has a file of its own; none reads or writes a file.

pub mod dxf;
pub mod page;
mod path;
pub mod svg;
mod text;

pub use path::data;
pub use text::{escaped, first_sentence, number};
