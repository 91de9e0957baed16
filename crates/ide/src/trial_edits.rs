//! Changes of texts, made on a copy of what is known, to see what comes of them.

use super::diagnostics::{DiagnosticStage, EditorDiagnostic, diagnostics};
use super::location::Change;
use super::snapshot::Snapshot;
use mechc_text::cancel::Cancel;
use mechc_text::world::World;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The text of a file as it is, without a byte-order mark.
pub(super) fn text_of(snapshot: &Snapshot, path: &Path) -> Option<String> {
    let parsed = snapshot.parsed(path)?;
    Some(parsed.sources().get(parsed.file()).text.clone())
}

/// The texts with changes made in them; of changes that overlap the first one.
pub(super) fn applied(snapshot: &Snapshot, changes: &[Change]) -> Option<Snapshot> {
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
        after = after.supposing(&path, changed.into());
    }
    Some(after)
}

/// What is to be said of some files' words, in order.
pub(super) fn faults(snapshot: &Snapshot, files: &[Arc<Path>]) -> Vec<EditorDiagnostic> {
    let of =
        |path: &Arc<Path>| diagnostics(snapshot, path, DiagnosticStage::Words, &Cancel::default).unwrap_or_default();
    files.iter().flat_map(of).collect()
}

/// The first of some faults that was not there before, or is there once more.
pub(super) fn first_new<'s>(before: &[EditorDiagnostic], after: &'s [EditorDiagnostic]) -> Option<&'s EditorDiagnostic> {
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for said in before {
        *known.entry(said.code).or_default() += 1;
    }
    after.iter().find(|said| match known.get_mut(said.code) {
        Some(count) if *count > 0 => {
            *count -= 1;
            false
        }
        _ => true,
    })
}
