//! What is to be said of a file, each stage for itself.

use super::location::{Change, FileRange};
use super::snapshot::Snapshot;
use mechc_pipeline::Checked;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Applies, Diagnostic, Diagnostics, Edit, Fix};
use mechc_text::source::{FileId, Sources, Span};
use std::ops::Range;
use std::path::Path;

pub use mechc_text::diag::Severity;

/// The stages in which a file is looked at, from the quickest on.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum DiagnosticStage {
    /// Syntax, names, units and values.
    Words,
    /// Count, structure, rank and assembly.
    Proof,
    /// The motion over the times of the analysis.
    Motion,
}

/// A diagnostic of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct EditorDiagnostic {
    /// Where in the file.
    pub range: Range<u32>,
    /// How grave it is.
    pub severity: Severity,
    /// Its entry in the catalogue.
    pub code: &'static str,
    /// The headline.
    pub message: String,
    /// What stands at the place, and all that is to be said beside: a line each.
    pub more: Vec<String>,
    /// Other places.
    pub related: Vec<Related>,
    /// The changes of texts that are proposed.
    pub fixes: Vec<ProposedFix>,
}

/// A place that helps to understand a diagnostic.
#[derive(Clone, PartialEq, Debug)]
pub struct Related {
    /// Where.
    pub position: FileRange,
    /// What is there.
    pub text: String,
}

/// A change of texts.
#[derive(Clone, PartialEq, Debug)]
pub struct ProposedFix {
    /// What it proposes.
    pub message: String,
    /// Whether it can be made without asking.
    pub is_certain: bool,
    /// What it changes.
    pub changes: Vec<Change>,
}

/// What one stage says of a file; nothing where the snapshot was cancelled. Each motion of the last stage is begun with a flag that ends it.
#[must_use]
pub fn diagnostics(
    snapshot: &Snapshot,
    path: &Path,
    stage: DiagnosticStage,
    begin: &dyn Fn() -> Cancel,
) -> Option<Vec<EditorDiagnostic>> {
    let checked = snapshot.checked(path)?;
    let mut all: Vec<EditorDiagnostic> = Vec::new();
    let mut add = |checked: &Checked, sources: &Sources, diagnostics: &Diagnostics| {
        for said in diagnostics.iter().map(|diagnostic| said(diagnostic, checked, sources)) {
            // what is said of several mechanisms of the file is one thing
            if !all.contains(&said) {
                all.push(said);
            }
        }
    };
    match stage {
        DiagnosticStage::Words => checked.mechanisms.iter().for_each(|one| add(one, one.sources(), one.diagnostics())),
        DiagnosticStage::Proof => {
            let proven = snapshot.proven(path)?;
            for (checked, proven) in checked.mechanisms.iter().zip(proven.iter()) {
                add(checked, &proven.sources, &proven.said);
            }
        }
        DiagnosticStage::Motion => {
            let (proven, moved) = (snapshot.proven(path)?, snapshot.moved(path, begin)?);
            for ((checked, proven), moved) in checked.mechanisms.iter().zip(proven.iter()).zip(moved.iter()) {
                add(checked, &proven.sources, &moved.said);
            }
        }
    }
    all.sort_by_key(|said| (said.range.start, said.range.end));
    Some(all)
}

/// A diagnostic as one of the file of a mechanism: at its own place, or else at the first of its places in that file.
fn said(diagnostic: &Diagnostic, checked: &Checked, sources: &Sources) -> EditorDiagnostic {
    let own = checked.file();
    let labels = &diagnostic.labels;
    let here = labels.iter().position(|label| label.span.file == own);
    let mut more: Vec<String> = Vec::new();
    let mut related = Vec::new();
    for (k, label) in labels.iter().enumerate() {
        match Some(k) == here {
            true if label.text.is_empty() => {}
            true => more.push(label.text.clone()),
            false => related.push(Related { location: FileRange::of(label.span, sources), text: label.text.clone() }),
        }
    }
    more.extend(diagnostic.notes.iter().map(|note| format!("note: {note}")));
    more.extend(diagnostic.help.iter().map(|help| format!("help: {help}")));
    let span =
        here.map_or_else(|| place_of_use(labels.first().map(|label| label.span.file), checked), |k| labels[k].span);
    EditorDiagnostic {
        range: span.start..span.end,
        severity: diagnostic.severity(),
        code: diagnostic.code.as_str(),
        message: diagnostic.message.clone(),
        more,
        related,
        fixes: diagnostic.fixes.iter().map(|fix| proposed(fix, sources)).collect(),
    }
}

fn proposed(fix: &Fix, sources: &Sources) -> ProposedFix {
    let change = |edit: &Edit| Change { location: FileRange::of(edit.span, sources), text: edit.text.clone() };
    ProposedFix {
        message: fix.message.clone(),
        is_certain: fix.applies == Applies::Always,
        changes: fix.edits.iter().map(change).collect(),
    }
}

/// Where a file speaks of another one, or of itself as a whole: where it uses that, or the name of its mechanism.
fn place_of_use(file: Option<FileId>, checked: &Checked) -> Span {
    let used = checked.used_files().find(|(_, used)| Some(*used) == file).map(|(span, _)| span);
    let named = || checked.symbols().iter().next().map(|(_, mechanism)| mechanism.span);
    let own = checked.file();
    used.or_else(named).unwrap_or(Span { file: own, start: 0, end: 0 })
}
