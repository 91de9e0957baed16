//! Import of model files of a course's planar engine (ADM, ACF) as the tree of a `.mech` file.
//!
//! Both formats are JSON: `json` reads values with their spans, `adm` and `acf` read the keys they know, `matlab` translates formulas, and
//! `translate` builds the declarations. This module opens no files and does not know the meaning of a mechanism: `check` and later stages
//! decide whether the result is determined.
//!
//! Spans in the tree refer to the model file, so that later diagnostics point there.

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

/// Stack that the deepest file may need, in bytes.
const STACK: usize = 16 << 20;

/// Translates a model, and the times of a settings file if given.
///
/// The tree is `None` if there are errors. Diagnostics also report what was changed or left out.
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
        diagnostics.sort_by_span();
        let mechanisms = mechanism.filter(|_| !diagnostics.has_errors()).map(|mechanism| vec![mechanism]);
        (mechanisms.map(|mechanisms| ast::File { uses: Vec::new(), mechanisms }), diagnostics)
    })
}
