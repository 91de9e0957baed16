//! The texts at one moment, and the stages of each.

use super::buffers::Buffers;
use super::memo::Memo;
use mechc_engine::analysis::Times;
use mechc_pipeline::{Assembly, Checked, Compiled, Parsed, Redundant, RunOptions};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use mechc_text::world::{LARGEST, World};
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
    /// The tree of the text before the last edit, of which most is still so.
    before: Option<Arc<Parsed>>,
    parsed: Memo<Parsed>,
    checked: Memo<CheckedFile>,
    proven: Memo<Vec<Proof>>,
    /// What is proven of those that are parts of others, each by itself.
    alone: Memo<Vec<Proof>>,
    moved: Memo<Vec<MotionOutcome>>,
    /// What was known of the motion of a text before this one.
    moved_before: Option<Arc<Vec<MotionOutcome>>>,
}

/// A file whose mechanisms were checked.
pub struct CheckedFile {
    /// Its mechanisms, in order; one alone without any where there is none.
    pub mechanisms: Vec<Checked>,
    /// What tells the files apart that it was made of, beside its own.
    named: BTreeSet<PathBuf>,
}

/// A mechanism as far as it is proven: determined, and assembled at its first time.
pub struct Proof {
    /// The texts that its diagnostics speak of.
    pub sources: Sources,
    /// What is to be said of it.
    pub said: Diagnostics,
    /// Where it is determined.
    pub compiled: Option<Compiled>,
    /// Where it can be assembled.
    pub assembly: Option<Assembly>,
    /// The row of that, once it was asked for.
    first_row: Memo<Vec<f64>>,
}

/// What came of following a mechanism over the times of its analysis.
pub struct MotionOutcome {
    /// Its name.
    pub mechanism: String,
    /// What is to be said of its motion.
    pub said: Diagnostics,
    /// Its results: each with its value, where it has one, in the unit in which it is told.
    pub results: Vec<(String, Option<f64>, String)>,
    /// It took too long: the results are those of a text before this one, if any.
    pub is_cut_short: bool,
}

impl Proof {
    fn nothing(checked: &Checked) -> Proof {
        let (sources, said) = (checked.sources().clone(), Diagnostics::default());
        Proof { sources, said, compiled: None, assembly: None, first_row: Memo::default() }
    }

    /// The row of the position in which it was assembled, in SI, by [`Compiled::columns`]; nothing where it has none.
    #[must_use]
    pub fn first_row(&self) -> Option<Arc<Vec<f64>>> {
        self.first_row.get_or(|| {
            let (compiled, assembly) = (self.compiled.as_ref()?, self.assembly.as_ref()?);
            let (run, _) = compiled.run(&Times::listed(assembly.t, vec![assembly.t]), &RunOptions::default());
            run?.next()?.ok()
        })
    }
}

impl CheckedFile {
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
        let before = text.as_ref().map(|_| self.stages(path).before_an_edit());
        buffers.set(path, text);
        let mut next = Snapshot { buffers: Arc::new(buffers), ..self.without(path) };
        next.files.insert(Arc::clone(path), Arc::new(before.unwrap_or_default()));
        next
    }

    /// The same with another text in a file, to see what would be; work on it ends with that on this one.
    #[must_use]
    pub fn supposing(&self, path: &Arc<Path>, text: Arc<str>) -> Snapshot {
        Snapshot { cancel: self.cancel.clone(), ..self.with_text(path, Some(text)) }
    }

    /// The same without what was known of a file, and of those that were made of it: what is behind it has changed.
    #[must_use]
    pub fn without(&self, path: &Arc<Path>) -> Snapshot {
        let mut files = BTreeMap::new();
        for (other, stages) in &self.files {
            let is_made_of_it = || stages.checked.get().is_none_or(|checked| checked.named.contains(&**path));
            let kept = match other == path {
                true => Arc::new(stages.without_text()),
                false if is_made_of_it() => Arc::new(stages.parsed_alone()),
                false => Arc::clone(stages),
            };
            files.insert(Arc::clone(other), kept);
        }
        files.entry(Arc::clone(path)).or_default();
        Snapshot { buffers: Arc::clone(&self.buffers), files, cancel: Cancel::default() }
    }

    /// The same with files that may be asked about, though nobody has opened them, and without any others of that kind.
    #[must_use]
    pub fn with_files(&self, paths: impl IntoIterator<Item = Arc<Path>>) -> Snapshot {
        let wanted: BTreeSet<Arc<Path>> = paths.into_iter().chain(self.buffers.paths().cloned()).collect();
        let known = |path: Arc<Path>| (Arc::clone(&path), self.files.get(&path).cloned().unwrap_or_default());
        Snapshot { files: wanted.into_iter().map(known).collect(), ..self.clone() }
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
    pub fn checked(&self, path: &Path) -> Option<Arc<CheckedFile>> {
        self.checked_of(&self.stages(path), path)
    }

    /// What is proven of a file's mechanisms, in order. Of one that is not sound, and of one that is a part of another one of the file,
    /// nothing is known by itself.
    #[must_use]
    pub fn proven(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        self.proven_of(&self.stages(path), path)
    }

    /// The same of those mechanisms that are parts of others of the file, each by itself, for who asks what is in them; of the rest nothing.
    #[must_use]
    pub fn proven_alone(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        let stages = self.stages(path);
        let checked = self.checked_of(&stages, path)?;
        stages.alone.get_or(|| {
            self.unless_cancelled(())?;
            let is_part = Checked::is_part_of_another;
            let alone = |checked: &Checked| {
                if is_part(checked) { proven_by_itself(checked, &self.cancel) } else { Proof::nothing(checked) }
            };
            let proven = checked.mechanisms.iter().map(alone).collect();
            self.unless_cancelled(proven)
        })
    }

    /// The motion of each of a file's mechanisms over the times of its analysis. Each is begun with a flag that ends it, it alone.
    #[must_use]
    pub fn moved(&self, path: &Path, begin: &dyn Fn() -> Cancel) -> Option<Arc<Vec<MotionOutcome>>> {
        let stages = self.stages(path);
        let proven = self.proven_of(&stages, path)?;
        let before = |name: &str| stages.moved_before.as_ref()?.iter().find(|before| before.mechanism == name);
        stages.moved.get_or(|| {
            let followed = |proven: &Proof| {
                self.unless_cancelled(())?;
                Some(moved(proven, &begin()).unwrap_or_else(|| MotionOutcome::cut_short(proven, before)))
            };
            let all = proven.iter().map(followed).collect::<Option<_>>()?;
            self.unless_cancelled(all)
        })
    }

    /// What is proven already.
    #[must_use]
    pub fn proven_now(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        self.stages(path).proven.get()
    }

    /// What is known already of the motion, or what was known of that of a text before this one; and which of the two.
    #[must_use]
    pub fn moved_last(&self, path: &Path) -> (Option<Arc<Vec<MotionOutcome>>>, bool) {
        let stages = self.stages(path);
        match stages.moved.get() {
            Some(moved) => (Some(moved), false),
            None => (stages.moved_before.clone(), true),
        }
    }

    /// What is known of a file; of one that nobody spoke of before it is not kept.
    fn stages(&self, path: &Path) -> Arc<Stages> {
        self.files.get(path).cloned().unwrap_or_default()
    }

    fn parsed_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Parsed>> {
        stages.parsed.get_or(|| {
            self.unless_cancelled(())?;
            let before = stages.before.as_ref().zip(self.buffers.open(path));
            let parsed = match before.filter(|(_, text)| text.len() <= LARGEST) {
                Some((before, text)) => before.edited(text),
                None => Parsed::read(path, &*self.buffers).ok()?,
            };
            self.unless_cancelled(parsed)
        })
    }

    /// Whether there is anything to prove of a file.
    #[must_use]
    pub fn may_be_proven(&self, path: &Path) -> Option<bool> {
        let may_be = |checked: &Checked| checked.is_sound() || checked.is_sound_but_for_outputs();
        Some(self.checked(path)?.mechanisms.iter().any(may_be))
    }

    fn checked_of(&self, stages: &Stages, path: &Path) -> Option<Arc<CheckedFile>> {
        let parsed = self.parsed_of(stages, path)?;
        stages.checked.get_or(|| {
            self.unless_cancelled(())?;
            let mechanisms = parsed.check_each(&*self.buffers);
            let named = mechanisms.first().map(Checked::named_files).unwrap_or_default();
            let named = named.iter().map(|path| self.buffers.identity(path)).collect();
            self.unless_cancelled(CheckedFile { mechanisms, named })
        })
    }

    fn proven_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Vec<Proof>>> {
        let checked = self.checked_of(stages, path)?;
        stages.proven.get_or(|| {
            self.unless_cancelled(())?;
            let whole = |checked: &Checked| checked.without_wrong_outputs(&*self.buffers);
            let of = |checked: &Checked| {
                let whole = if checked.is_sound() { None } else { whole(checked) };
                proven(whole.as_ref().unwrap_or(checked), &self.cancel)
            };
            self.unless_cancelled(checked.mechanisms.iter().map(of).collect())
        })
    }

    fn unless_cancelled<T>(&self, made: T) -> Option<T> {
        (!self.cancel.is_cancelled()).then_some(made)
    }
}

impl Stages {
    /// What helps to know the file once it is edited.
    fn before_an_edit(&self) -> Stages {
        Stages { before: self.parsed.get().or_else(|| self.before.clone()), ..self.without_text() }
    }

    /// What is known by a file's own text.
    fn parsed_alone(&self) -> Stages {
        Stages { parsed: self.parsed.get().into(), ..self.without_text() }
    }

    /// What was known and may be shown until it is known anew.
    fn without_text(&self) -> Stages {
        // of a motion that could not be followed to its end the one before it stays
        Stages { moved_before: self.moved.get().or_else(|| self.moved_before.clone()), ..Stages::default() }
    }
}

/// Makes the list of names of each mechanism of a file, which is kept.
pub fn index_names(snapshot: &Snapshot, path: &Path) {
    let checked = snapshot.checked(path);
    for mechanism in checked.iter().flat_map(|checked| &checked.mechanisms).take_while(|_| !snapshot.is_cancelled()) {
        let _ = mechanism.symbols();
    }
}

/// Proves a mechanism that is no part of another one, and assembles it.
fn proven(checked: &Checked, cancel: &Cancel) -> Proof {
    if checked.is_part_of_another() { Proof::nothing(checked) } else { proven_by_itself(checked, cancel) }
}

fn proven_by_itself(checked: &Checked, cancel: &Cancel) -> Proof {
    let mut proven = Proof::nothing(checked);
    let (compiled, said) = checked.compile(Redundant::Refused, cancel);
    proven.said = said;
    let Some(compiled) = compiled else { return proven };
    let refused = compiled.analysis().map(|[from, to, _]| compiled.refused_results([from, to]));
    proven.said.extend(refused.unwrap_or_default());
    let options = RunOptions { cancel: cancel.clone(), ..RunOptions::default() };
    let from = compiled.analysis().map_or(0.0, |[from, ..]| from);
    let (assembly, said) = compiled.assembled(from, &options);
    proven.said.extend(said);
    proven.assembly = assembly;
    proven.sources = compiled.sources().clone();
    proven.compiled = Some(compiled);
    proven
}

impl MotionOutcome {
    fn nothing() -> MotionOutcome {
        MotionOutcome { mechanism: String::new(), said: Diagnostics::default(), results: Vec::new(), is_cut_short: false }
    }

    /// Of a motion that was ended on its way only what was known of it before.
    fn cut_short<'b>(proven: &Proof, before: impl Fn(&str) -> Option<&'b MotionOutcome>) -> MotionOutcome {
        let mechanism = proven.compiled.as_ref().map(|compiled| compiled.name().to_owned()).unwrap_or_default();
        let results = before(&mechanism).map(|before| before.results.clone()).unwrap_or_default();
        MotionOutcome { mechanism, results, is_cut_short: true, ..MotionOutcome::nothing() }
    }
}

/// Follows a motion to its end; nothing where it is cancelled on the way.
fn moved(proven: &Proof, cancel: &Cancel) -> Option<MotionOutcome> {
    let mut moved = MotionOutcome::nothing();
    let compiled = proven.compiled.as_ref().filter(|_| !proven.said.has_errors());
    let Some((compiled, times)) = compiled.and_then(|compiled| Some((compiled, compiled.times()?))) else {
        return Some(moved);
    };
    compiled.name().clone_into(&mut moved.mechanism);
    let (run, _) = compiled.run(&times, &RunOptions { cancel: cancel.clone(), ..RunOptions::default() });
    let Some(mut run) = run else { return (!cancel.is_cancelled()).then_some(moved) };
    while let Some(row) = run.next_row() {
        if let Err(why) = row {
            moved.said.push(*why);
        }
        moved.said.extend(run.take_remarks());
    }
    let names = compiled.results();
    let answers = if cancel.is_cancelled() { None } else { run.results() }.unwrap_or_default();
    let results = names.into_iter().zip(&answers.values);
    moved.results =
        results.map(|((name, unit), value)| (name, value.map(|value| unit.printed(value)), unit.text)).collect();
    (!cancel.is_cancelled()).then_some(moved)
}
