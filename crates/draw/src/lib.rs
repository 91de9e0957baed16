//! Pictures: what there is to draw of a mechanism and its motion, and how that is written.

pub mod scene;
pub mod view;
