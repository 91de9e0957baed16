//! Changes applied to a copy of a snapshot, to compare the diagnostics before and after.

use super::diagnostics::{DiagnosticStage, EditorDiagnostic, diagnostics};
use super::location::Change;
use super::snapshot::Snapshot;
use mechc_text::cancel::Cancel;
use mechc_text::world::World;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Returns the text of a file, without a byte-order mark.
pub(super) fn text_of(snapshot: &Snapshot, path: &Path) -> Option<String> {
    let parsed = snapshot.parsed(path)?;
    Some(parsed.sources().get(parsed.file()).text.clone())
}

/// Applies changes to a copy of a snapshot; of changes that overlap, only the first is applied.
pub(super) fn apply(snapshot: &Snapshot, changes: &[Change]) -> Option<Snapshot> {
    let mut of_files: BTreeMap<Arc<Path>, Vec<&Change>> = BTreeMap::new();
    for change in changes {
        let path: Arc<Path> = snapshot.buffers().identity(&change.location.path).into();
        of_files.entry(path).or_default().push(change);
    }
    let mut after = snapshot.clone();
    for (path, mut changes) in of_files {
        changes.sort_by_key(|change| change.location.range().start);
        let text = text_of(snapshot, &path)?;
        let (mut changed, mut end) = (String::with_capacity(text.len()), 0);
        for change in changes {
            let range = change.location.start as usize..change.location.end as usize;
            if range.start >= end {
                changed += text.get(end..range.start)?;
                changed += &change.text;
                end = range.end;
            }
        }
        changed += text.get(end..)?;
        after = after.with_trial_text(&path, changed.into());
    }
    Some(after)
}

/// Returns the diagnostics of the first stage for some files, in order.
pub(super) fn word_diagnostics(snapshot: &Snapshot, files: &[Arc<Path>]) -> Vec<EditorDiagnostic> {
    let of =
        |path: &Arc<Path>| diagnostics(snapshot, path, DiagnosticStage::Words, &Cancel::default).unwrap_or_default();
    files.iter().flat_map(of).collect()
}

/// Returns the first diagnostic that is new, or that occurs more often than before.
pub(super) fn first_new<'s>(
    before: &[EditorDiagnostic],
    after: &'s [EditorDiagnostic],
) -> Option<&'s EditorDiagnostic> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for diagnostic in before {
        *counts.entry(diagnostic.code).or_default() += 1;
    }
    after.iter().find(|diagnostic| match counts.get_mut(diagnostic.code) {
        Some(count) if *count > 0 => {
            *count -= 1;
            false
        }
        _ => true,
    })
}
