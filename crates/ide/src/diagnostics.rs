//! The diagnostics of a file, by stage.

use super::location::{Change, FileRange};
use super::snapshot::Snapshot;
use mechc_pipeline::Checked;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Applicability, Diagnostic, Diagnostics, Edit, Fix};
use mechc_text::source::{FileId, Sources, Span};
use std::ops::Range;
use std::path::Path;

pub use mechc_text::diag::Severity;

/// The stages in which a file is analysed, quickest first.
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
    /// The range in the file.
    pub range: Range<u32>,
    /// The severity.
    pub severity: Severity,
    /// The code in the catalogue.
    pub code: &'static str,
    /// The headline.
    pub message: String,
    /// The label, notes and help, one line each.
    pub details: Vec<String>,
    /// Related locations.
    pub related: Vec<Related>,
    /// The proposed fixes.
    pub fixes: Vec<ProposedFix>,
}

/// A location that helps to understand a diagnostic.
#[derive(Clone, PartialEq, Debug)]
pub struct Related {
    /// The range in its file.
    pub location: FileRange,
    /// The label.
    pub text: String,
}

/// A fix that a diagnostic proposes.
#[derive(Clone, PartialEq, Debug)]
pub struct ProposedFix {
    /// The title.
    pub message: String,
    /// True if it may be applied without confirmation.
    pub is_certain: bool,
    /// The changes that it makes.
    pub changes: Vec<Change>,
}

/// Returns the diagnostics of one stage of a file; `None` if the snapshot was cancelled. `begin` supplies a flag that cancels a motion.
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
        for diagnostic in diagnostics.iter().map(|diagnostic| convert(diagnostic, checked, sources)) {
            // several mechanisms of a file may report the same diagnostic
            if !all.contains(&diagnostic) {
                all.push(diagnostic);
            }
        }
    };
    match stage {
        DiagnosticStage::Words => checked.mechanisms.iter().for_each(|one| add(one, one.sources(), one.diagnostics())),
        DiagnosticStage::Proof => {
            let proofs = snapshot.proofs(path)?;
            for (checked, proof) in checked.mechanisms.iter().zip(proofs.iter()) {
                add(checked, &proof.sources, &proof.diagnostics);
            }
        }
        DiagnosticStage::Motion => {
            let (proofs, motions) = (snapshot.proofs(path)?, snapshot.motions(path, begin)?);
            for ((checked, proof), motion) in checked.mechanisms.iter().zip(proofs.iter()).zip(motions.iter()) {
                add(checked, &proof.sources, &motion.diagnostics);
            }
        }
    }
    all.sort_by_key(|diagnostic| (diagnostic.range.start, diagnostic.range.end));
    Some(all)
}

/// Converts a diagnostic of a mechanism to one of its file, at the first label in that file, else where the file uses the labelled one.
fn convert(diagnostic: &Diagnostic, checked: &Checked, sources: &Sources) -> EditorDiagnostic {
    let file = checked.file();
    let labels = &diagnostic.labels;
    let here = labels.iter().position(|label| label.span.file == file);
    let mut details: Vec<String> = Vec::new();
    let mut related = Vec::new();
    for (k, label) in labels.iter().enumerate() {
        match Some(k) == here {
            true if label.text.is_empty() => {}
            true => details.push(label.text.clone()),
            false => {
                related.push(Related { location: FileRange::from_span(label.span, sources), text: label.text.clone() });
            }
        }
    }
    details.extend(diagnostic.notes.iter().map(|note| format!("note: {note}")));
    details.extend(diagnostic.help.iter().map(|help| format!("help: {help}")));
    let span =
        here.map_or_else(|| span_of_use(labels.first().map(|label| label.span.file), checked), |k| labels[k].span);
    EditorDiagnostic {
        range: span.start..span.end,
        severity: diagnostic.severity(),
        code: diagnostic.code.as_str(),
        message: diagnostic.message.clone(),
        details,
        related,
        fixes: diagnostic.fixes.iter().map(|fix| proposed(fix, sources)).collect(),
    }
}

fn proposed(fix: &Fix, sources: &Sources) -> ProposedFix {
    let change = |edit: &Edit| Change { location: FileRange::from_span(edit.span, sources), text: edit.text.clone() };
    ProposedFix {
        message: fix.message.clone(),
        is_certain: fix.applies == Applicability::Always,
        changes: fix.edits.iter().map(change).collect(),
    }
}

/// Returns the span where a file uses another one, else that of the mechanism's name.
fn span_of_use(file: Option<FileId>, checked: &Checked) -> Span {
    let used = checked.used_files().find(|(_, used)| Some(*used) == file).map(|(span, _)| span);
    let named = || checked.symbols().iter().next().map(|(_, mechanism)| mechanism.span);
    used.or_else(named).unwrap_or(Span { file: checked.file(), start: 0, end: 0 })
}
