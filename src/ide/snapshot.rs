//! The texts at one moment, and the stages of each.

use super::buffers::Buffers;
use super::kept::Kept;
use crate::analysis::Times;
use crate::cancel::Cancel;
use crate::diag::Diagnostics;
use crate::source::Sources;
use crate::stages::{Assembly, Checked, Compiled, Parsed, Redundant, RunOptions};
use crate::world::World;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The texts at one moment. A clone is the same; what is made of it is kept, and kept on in the next snapshot where an edit leaves it
/// as it is.
#[derive(Clone)]
pub struct Snapshot {
    buffers: Arc<Buffers>,
    /// What is known of each file that may be asked about.
    files: BTreeMap<Arc<Path>, Arc<Stages>>,
    cancel: Cancel,
}

/// The stages of a file, as far as they were asked for.
#[derive(Default)]
struct Stages {
    parsed: Kept<Parsed>,
    checked: Kept<Analysed>,
    proven: Kept<Vec<Proven>>,
    moved: Kept<Vec<Diagnostics>>,
}

/// A file whose mechanisms were checked.
pub struct Analysed {
    /// Its mechanisms, in order; one alone without any where there is none.
    pub mechanisms: Vec<Checked>,
    /// What tells the files apart that it was made of, beside its own.
    named: BTreeSet<PathBuf>,
}

/// A mechanism as far as it is proven: determined, and assembled at its first time.
pub struct Proven {
    /// The texts that its diagnostics speak of.
    pub sources: Sources,
    /// What is to be said of it.
    pub said: Diagnostics,
    /// Where it is determined.
    pub compiled: Option<Compiled>,
    /// Where it can be assembled.
    pub assembly: Option<Assembly>,
}

impl Analysed {
    /// The mechanism that holds a byte of the file, or ends there.
    #[must_use]
    pub fn mechanism_at(&self, offset: u32) -> Option<&Checked> {
        let holds = |checked: &&Checked| checked.span().is_some_and(|span| (span.start..=span.end).contains(&offset));
        self.mechanisms.iter().find(holds)
    }
}

impl Snapshot {
    /// Without any file.
    #[must_use]
    pub fn new(world: Arc<dyn World>) -> Snapshot {
        let buffers = Arc::new(Buffers::new(world));
        Snapshot { buffers, files: BTreeMap::new(), cancel: Cancel::default() }
    }

    /// The same with another text in a file, or with that behind it where it is `None`. Work on this one is better cancelled.
    #[must_use]
    pub fn with_text(&self, path: &Arc<Path>, text: Option<Arc<str>>) -> Snapshot {
        let mut buffers = (*self.buffers).clone();
        buffers.set(path, text);
        Snapshot { buffers: Arc::new(buffers), ..self.without(path) }
    }

    /// The same without what was known of a file, and of those that were made of it: what is behind it has changed.
    #[must_use]
    pub fn without(&self, path: &Arc<Path>) -> Snapshot {
        let mut files = BTreeMap::new();
        for (other, stages) in &self.files {
            let is_made_of_it = || stages.checked.get().is_none_or(|checked| checked.named.contains(&**path));
            let kept = match other == path {
                true => Arc::default(),
                false if is_made_of_it() => Arc::new(stages.parsed_alone()),
                false => Arc::clone(stages),
            };
            files.insert(Arc::clone(other), kept);
        }
        files.entry(Arc::clone(path)).or_default();
        Snapshot { buffers: Arc::clone(&self.buffers), files, cancel: Cancel::default() }
    }

    /// The same with files that may be asked about, though nobody has opened them.
    #[must_use]
    pub fn with_files(&self, paths: impl IntoIterator<Item = Arc<Path>>) -> Snapshot {
        let mut files = self.files.clone();
        for path in paths {
            files.entry(path).or_default();
        }
        Snapshot { files, ..self.clone() }
    }

    /// Ends all work on it, soon: it gives nothing then.
    pub fn cancel(&self) {
        self.cancel.cancel();
    }

    /// Whether it was cancelled.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Whether all that was known of a file in another snapshot still holds in this one.
    #[must_use]
    pub fn is_same(&self, other: &Snapshot, path: &Path) -> bool {
        let stages = |snapshot: &Snapshot| snapshot.files.get(path).cloned();
        stages(self).zip(stages(other)).is_some_and(|(own, other)| Arc::ptr_eq(&own, &other))
    }

    /// The files as they are in it.
    #[must_use]
    pub fn buffers(&self) -> &Arc<Buffers> {
        &self.buffers
    }

    /// The files that it knows of, by their identity.
    pub fn files(&self) -> impl Iterator<Item = &Arc<Path>> {
        self.files.keys()
    }

    /// A file's tree.
    #[must_use]
    pub fn parsed(&self, path: &Path) -> Option<Arc<Parsed>> {
        self.parsed_of(&self.stages(path), path)
    }

    /// A file's mechanisms, whatever is wrong with them.
    #[must_use]
    pub fn checked(&self, path: &Path) -> Option<Arc<Analysed>> {
        self.checked_of(&self.stages(path), path)
    }

    /// What is proven of a file's mechanisms, in order. Of one that is not sound, and of one that is a part of another one of the file,
    /// nothing is known by itself.
    #[must_use]
    pub fn proven(&self, path: &Path) -> Option<Arc<Vec<Proven>>> {
        self.proven_of(&self.stages(path), path)
    }

    /// What is to be said of the motion of each of a file's mechanisms over the times of its analysis. The flag ends it as well; what was found
    /// up to there is lost.
    #[must_use]
    pub fn moved(&self, path: &Path, cancel: &Cancel) -> Option<Arc<Vec<Diagnostics>>> {
        let stages = self.stages(path);
        let proven = self.proven_of(&stages, path)?;
        stages.moved.get_or(|| {
            let said = proven.iter().map(|proven| moved(proven, cancel)).collect::<Option<_>>()?;
            self.unless_cancelled(said)
        })
    }

    /// What is known of a file; of one that nobody spoke of before it is not kept.
    fn stages(&self, path: &Path) -> Arc<Stages> {
        self.files.get(path).cloned().unwrap_or_default()
    }

    fn parsed_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Parsed>> {
        stages.parsed.get_or(|| {
            let parsed = Parsed::read(path, &*self.buffers).ok()?;
            self.unless_cancelled(parsed)
        })
    }

    fn checked_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Analysed>> {
        let parsed = self.parsed_of(stages, path)?;
        stages.checked.get_or(|| {
            let mechanisms = parsed.check_each(&*self.buffers);
            let named = mechanisms.first().map(Checked::named_files).unwrap_or_default();
            let named = named.iter().map(|path| self.buffers.identity(path)).collect();
            self.unless_cancelled(Analysed { mechanisms, named })
        })
    }

    fn proven_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Vec<Proven>>> {
        let checked = self.checked_of(stages, path)?;
        stages.proven.get_or(|| {
            let proven = checked.mechanisms.iter().map(|checked| proven(checked, &self.cancel)).collect();
            self.unless_cancelled(proven)
        })
    }

    fn unless_cancelled<T>(&self, made: T) -> Option<T> {
        (!self.cancel.is_cancelled()).then_some(made)
    }
}

impl Stages {
    /// What is known by a file's own text.
    fn parsed_alone(&self) -> Stages {
        Stages { parsed: self.parsed.get().into(), ..Stages::default() }
    }
}

/// Proves a mechanism and assembles it.
fn proven(checked: &Checked, cancel: &Cancel) -> Proven {
    let mut proven =
        Proven { sources: checked.sources().clone(), said: Diagnostics::default(), compiled: None, assembly: None };
    if checked.is_part_of_another() {
        return proven;
    }
    let (compiled, said) = checked.compile(Redundant::Refused, cancel);
    proven.said = said;
    let Some(compiled) = compiled else { return proven };
    let refused = compiled.analysis().map(|[from, to, _]| compiled.refused_results([from, to]));
    proven.said.extend(refused.unwrap_or_default());
    let options = RunOptions { cancel: cancel.clone(), ..RunOptions::default() };
    let from = compiled.analysis().map_or(0.0, |[from, ..]| from);
    let (run, said) = compiled.run(&Times::listed(from, vec![from]), &options);
    proven.said.extend(said);
    proven.assembly = run.map(|run| run.assembly().clone());
    proven.sources = compiled.sources().clone();
    proven.compiled = Some(compiled);
    proven
}

/// Follows a motion to its end; nothing where it is cancelled on the way.
fn moved(proven: &Proven, cancel: &Cancel) -> Option<Diagnostics> {
    let mut said = Diagnostics::default();
    let compiled = proven.compiled.as_ref().filter(|_| !proven.said.has_errors());
    let Some((compiled, times)) = compiled.and_then(|compiled| Some((compiled, compiled.times()?))) else {
        return Some(said);
    };
    let (run, _) = compiled.run(&times, &RunOptions { cancel: cancel.clone(), ..RunOptions::default() });
    let Some(mut run) = run else { return (!cancel.is_cancelled()).then_some(said) };
    while let Some(row) = run.next_row() {
        if let Err(why) = row {
            said.push(*why);
        }
        said.extend(run.take_remarks());
    }
    (!cancel.is_cancelled()).then_some(said)
}
