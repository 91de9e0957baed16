//! Texts and spans, diagnostics, access to files, and the words of the language.

pub mod cancel;
pub mod diag;
pub mod source;
pub mod vocabulary;
pub mod world;
