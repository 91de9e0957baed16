//! The model files of a course's planar engine (ADM, ACF) to the tree of a `.mech` file.
//!
//! Both are JSON: `json` gives values with their places, `adm` and `acf` ask for the keys they know, `matlab`
//! translates formulas, and `translate` writes the declarations. This module knows how a model is written, in either
//! form; it touches no files, and it does not know what a mechanism means: whether the result is determined is for
//! `check` and its followers.
//!
//! The places in the tree are those of the model file, so that whatever is said of it later points there.

mod acf;
mod adm;
mod build;
mod errors;
mod features;
mod fields;
mod json;
mod matlab;
mod names;
mod translate;
mod value;

use crate::ast;
use mechc_text::diag::Diagnostics;
use mechc_text::source::{FileId, Sources};

/// Stack that the deepest file may take, in bytes.
const STACK: usize = 16 << 20;

/// Translates a model, and the times of a settings file if there is one.
///
/// The tree is `None` where there are errors; what was changed or left out is told in either case.
#[must_use]
pub fn import(model: FileId, settings: Option<FileId>, sources: &Sources) -> (Option<ast::File>, Diagnostics) {
    stacker::maybe_grow(STACK, STACK, || {
        let mut diagnostics = Diagnostics::default();
        let analysis = settings.and_then(|file| match json::read(file, sources) {
            Ok(value) => acf::read(&value, &mut diagnostics),
            Err(fault) => {
                diagnostics.push(*fault);
                None
            }
        });
        let mut mechanism = match json::read(model, sources) {
            Ok(value) => adm::read(&value, &mut diagnostics).and_then(|read| {
                diagnostics.extend(adm::left_behind(&value));
                translate::mechanism(&read, &sources.get(model).name, &mut diagnostics)
            }),
            Err(fault) => {
                diagnostics.push(*fault);
                None
            }
        };
        if let Some(mechanism) = &mut mechanism {
            mechanism.items.extend(analysis);
        }
        diagnostics.sort_by_place();
        let mechanisms = mechanism.filter(|_| !diagnostics.has_errors()).map(|mechanism| vec![mechanism]);
        (mechanisms.map(|mechanisms| ast::File { uses: Vec::new(), mechanisms }), diagnostics)
    })
}
