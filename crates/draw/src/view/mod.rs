//! Writers of a scene and its motion: SVG, HTML pages and DXF. They return texts; none of them reads or writes a file.

pub mod dxf;
pub mod page;
mod path;
pub mod svg;
mod text;

pub use text::first_sentence;
