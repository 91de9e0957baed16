//! Texts and places in them, diagnostics, the trait that gives files, and the words of the language.

pub mod cancel;
pub mod diag;
pub mod source;
pub mod vocabulary;
pub mod world;
