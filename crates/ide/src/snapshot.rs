//! A snapshot of the texts, and the stages of each file.

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

/// The texts at one moment. Results are computed once and shared with clones, and with later snapshots as far as edits do not affect them.
#[derive(Clone)]
pub struct Snapshot {
    buffers: Arc<Buffers>,
    /// The stages of each file that the snapshot covers.
    files: BTreeMap<Arc<Path>, Arc<Stages>>,
    cancel: Cancel,
}

/// The stages of a file, as far as they are computed.
#[derive(Default)]
struct Stages {
    /// The tree of the text before the last edit, most of which can be reused.
    before: Option<Arc<Parsed>>,
    parsed: Memo<Parsed>,
    checked: Memo<CheckedFile>,
    proofs: Memo<Vec<Proof>>,
    /// The proofs of mechanisms that are parts of others, each by itself.
    standalone_proofs: Memo<Vec<Proof>>,
    motions: Memo<Vec<MotionOutcome>>,
    /// The motions of an earlier text.
    earlier_motions: Option<Arc<Vec<MotionOutcome>>>,
}

/// A file with its checked mechanisms.
pub struct CheckedFile {
    /// Its mechanisms, in order; an empty one if the file has none.
    pub mechanisms: Vec<Checked>,
    /// The identities of the other files that it uses.
    used_files: BTreeSet<PathBuf>,
}

/// The proof of a mechanism: that it is determined, and its assembly at the first time.
pub struct Proof {
    /// The texts that the diagnostics refer to.
    pub sources: Sources,
    /// The diagnostics of the proof.
    pub diagnostics: Diagnostics,
    /// The compiled mechanism, if it is determined.
    pub compiled: Option<Compiled>,
    /// The assembly, if it exists.
    pub assembly: Option<Assembly>,
    /// The row of the assembly, once it is computed.
    first_row: Memo<Vec<f64>>,
}

/// The outcome of running a mechanism over the times of its analysis.
pub struct MotionOutcome {
    /// The name of the mechanism.
    pub mechanism: String,
    /// The diagnostics of the motion.
    pub diagnostics: Diagnostics,
    /// The results of the motion.
    pub results: Vec<ResultValue>,
    /// True if the motion took too long; the results are then those of an earlier text, if any.
    pub is_cut_short: bool,
}

/// A result of a motion.
#[derive(Clone, PartialEq, Debug)]
pub struct ResultValue {
    /// The name of the result.
    pub name: String,
    /// Its value in `unit`, if it has one.
    pub value: Option<f64>,
    /// The unit in which it is printed.
    pub unit: String,
}

impl Proof {
    fn empty(checked: &Checked) -> Proof {
        let (sources, diagnostics) = (checked.sources().clone(), Diagnostics::default());
        Proof { sources, diagnostics, compiled: None, assembly: None, first_row: Memo::default() }
    }

    /// Returns the row of the assembly in SI, in the order of [`Compiled::columns`]; `None` if there is none.
    #[must_use]
    pub fn first_row(&self) -> Option<Arc<Vec<f64>>> {
        self.first_row.get_or_compute(|| {
            let (compiled, assembly) = (self.compiled.as_ref()?, self.assembly.as_ref()?);
            let (run, _) = compiled.run(&Times::listed(assembly.t, vec![assembly.t]), &RunOptions::default());
            run?.next()?.ok()
        })
    }
}

impl CheckedFile {
    /// Returns the mechanism that contains an offset or ends there.
    #[must_use]
    pub fn mechanism_at(&self, offset: u32) -> Option<&Checked> {
        let holds = |checked: &&Checked| checked.span().is_some_and(|span| (span.start..=span.end).contains(&offset));
        self.mechanisms.iter().find(holds)
    }
}

impl Snapshot {
    /// Creates a snapshot without files.
    #[must_use]
    pub fn new(world: Arc<dyn World>) -> Snapshot {
        let buffers = Arc::new(Buffers::new(world));
        Snapshot { buffers, files: BTreeMap::new(), cancel: Cancel::default() }
    }

    /// Returns a snapshot with another text for a file; `None` closes it. The caller should cancel work on this one.
    #[must_use]
    pub fn with_text(&self, path: &Arc<Path>, text: Option<Arc<str>>) -> Snapshot {
        let mut buffers = (*self.buffers).clone();
        let before = text.as_ref().map(|_| self.stages(path).to_be_edited());
        buffers.set(path, text);
        let mut next = Snapshot { buffers: Arc::new(buffers), ..self.invalidated(path) };
        next.files.insert(Arc::clone(path), Arc::new(before.unwrap_or_default()));
        next
    }

    /// Returns a snapshot with another text for a file, to try a change; cancelling this snapshot cancels work on it.
    #[must_use]
    pub fn with_trial_text(&self, path: &Arc<Path>, text: Arc<str>) -> Snapshot {
        Snapshot { cancel: self.cancel.clone(), ..self.with_text(path, Some(text)) }
    }

    /// Returns a snapshot without the results of a file and of those that use it, after the file has changed on disk.
    #[must_use]
    pub fn invalidated(&self, path: &Arc<Path>) -> Snapshot {
        let mut files = BTreeMap::new();
        for (other, stages) in &self.files {
            let uses_it = || stages.checked.get().is_none_or(|checked| checked.used_files.contains(&**path));
            let kept = match other == path {
                true => Arc::new(stages.without_text()),
                false if uses_it() => Arc::new(stages.only_parsed()),
                false => Arc::clone(stages),
            };
            files.insert(Arc::clone(other), kept);
        }
        files.entry(Arc::clone(path)).or_default();
        Snapshot { buffers: Arc::clone(&self.buffers), files, cancel: Cancel::default() }
    }

    /// Returns a snapshot that covers given files besides the open ones, and no others.
    #[must_use]
    pub fn with_files(&self, paths: impl IntoIterator<Item = Arc<Path>>) -> Snapshot {
        let covered: BTreeSet<Arc<Path>> = paths.into_iter().chain(self.buffers.paths().cloned()).collect();
        let entry = |path: Arc<Path>| (Arc::clone(&path), self.files.get(&path).cloned().unwrap_or_default());
        Snapshot { files: covered.into_iter().map(entry).collect(), ..self.clone() }
    }

    /// Cancels all work on it; computations then return `None`.
    pub fn cancel(&self) {
        self.cancel.cancel();
    }

    /// Returns whether it was cancelled.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Returns whether the results of a file in another snapshot still hold in this one.
    #[must_use]
    pub fn shares_results(&self, other: &Snapshot, path: &Path) -> bool {
        let stages = |snapshot: &Snapshot| snapshot.files.get(path).cloned();
        stages(self).zip(stages(other)).is_some_and(|(this, other)| Arc::ptr_eq(&this, &other))
    }

    /// Returns the files of the snapshot.
    #[must_use]
    pub fn buffers(&self) -> &Arc<Buffers> {
        &self.buffers
    }

    /// Returns the files that it covers, by identity.
    pub fn files(&self) -> impl Iterator<Item = &Arc<Path>> {
        self.files.keys()
    }

    /// Parses a file.
    #[must_use]
    pub fn parsed(&self, path: &Path) -> Option<Arc<Parsed>> {
        self.parsed_of(&self.stages(path), path)
    }

    /// Checks a file's mechanisms, which may have errors.
    #[must_use]
    pub fn checked(&self, path: &Path) -> Option<Arc<CheckedFile>> {
        self.checked_of(&self.stages(path), path)
    }

    /// Proves a file's mechanisms, in order. The proof of an unsound mechanism, or of one that is a part of another in the file, is empty.
    #[must_use]
    pub fn proofs(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        self.proofs_of(&self.stages(path), path)
    }

    /// Proves each mechanism that is a part of another in the file by itself; the proofs of the others are empty.
    #[must_use]
    pub fn standalone_proofs(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        let stages = self.stages(path);
        let checked = self.checked_of(&stages, path)?;
        stages.standalone_proofs.get_or_compute(|| {
            self.unless_cancelled(())?;
            let is_part = Checked::is_part_of_another;
            let prove = |checked: &Checked| {
                if is_part(checked) { prove_standalone(checked, &self.cancel) } else { Proof::empty(checked) }
            };
            let proofs = checked.mechanisms.iter().map(prove).collect();
            self.unless_cancelled(proofs)
        })
    }

    /// Runs each of a file's mechanisms over the times of its analysis; `begin` supplies a flag that cancels that motion only.
    #[must_use]
    pub fn motions(&self, path: &Path, begin: &dyn Fn() -> Cancel) -> Option<Arc<Vec<MotionOutcome>>> {
        let stages = self.stages(path);
        let proofs = self.proofs_of(&stages, path)?;
        let before = |name: &str| stages.earlier_motions.as_ref()?.iter().find(|before| before.mechanism == name);
        stages.motions.get_or_compute(|| {
            let run_or_cut_short = |proof: &Proof| {
                self.unless_cancelled(())?;
                Some(run(proof, &begin()).unwrap_or_else(|| MotionOutcome::cut_short(proof, before)))
            };
            let all = proofs.iter().map(run_or_cut_short).collect::<Option<_>>()?;
            self.unless_cancelled(all)
        })
    }

    /// Returns the proofs of a file if they are computed already.
    #[must_use]
    pub fn cached_proofs(&self, path: &Path) -> Option<Arc<Vec<Proof>>> {
        self.stages(path).proofs.get()
    }

    /// Returns the motions if they are computed already, else those of an earlier text, and whether they are of an earlier text.
    #[must_use]
    pub fn last_motions(&self, path: &Path) -> (Option<Arc<Vec<MotionOutcome>>>, bool) {
        let stages = self.stages(path);
        match stages.motions.get() {
            Some(motions) => (Some(motions), false),
            None => (stages.earlier_motions.clone(), true),
        }
    }

    /// Returns the stages of a file; those of a file that is not covered are not cached.
    fn stages(&self, path: &Path) -> Arc<Stages> {
        self.files.get(path).cloned().unwrap_or_default()
    }

    fn parsed_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Parsed>> {
        stages.parsed.get_or_compute(|| {
            self.unless_cancelled(())?;
            let before = stages.before.as_ref().zip(self.buffers.open(path));
            let parsed = match before.filter(|(_, text)| text.len() <= LARGEST) {
                Some((before, text)) => before.edited(text),
                None => Parsed::read(path, &*self.buffers).ok()?,
            };
            self.unless_cancelled(parsed)
        })
    }

    /// Returns whether any mechanism of a file can be proven.
    #[must_use]
    pub fn may_be_proven(&self, path: &Path) -> Option<bool> {
        let may_be = |checked: &Checked| checked.is_sound() || checked.has_only_output_errors();
        Some(self.checked(path)?.mechanisms.iter().any(may_be))
    }

    fn checked_of(&self, stages: &Stages, path: &Path) -> Option<Arc<CheckedFile>> {
        let parsed = self.parsed_of(stages, path)?;
        stages.checked.get_or_compute(|| {
            self.unless_cancelled(())?;
            let mechanisms = parsed.check_each(&*self.buffers);
            let used_files = mechanisms.first().map(Checked::named_files).unwrap_or_default();
            let used_files = used_files.iter().map(|path| self.buffers.identity(path)).collect();
            self.unless_cancelled(CheckedFile { mechanisms, used_files })
        })
    }

    fn proofs_of(&self, stages: &Stages, path: &Path) -> Option<Arc<Vec<Proof>>> {
        let checked = self.checked_of(stages, path)?;
        stages.proofs.get_or_compute(|| {
            self.unless_cancelled(())?;
            let prove = |checked: &Checked| {
                let reduced = if checked.is_sound() { None } else { checked.without_faulty_outputs(&*self.buffers) };
                prove(reduced.as_ref().unwrap_or(checked), &self.cancel)
            };
            self.unless_cancelled(checked.mechanisms.iter().map(prove).collect())
        })
    }

    fn unless_cancelled<T>(&self, value: T) -> Option<T> {
        (!self.cancel.is_cancelled()).then_some(value)
    }
}

impl Stages {
    /// Returns the stages for an edited text: the old tree, for reuse, and earlier motions.
    fn to_be_edited(&self) -> Stages {
        Stages { before: self.parsed.get().or_else(|| self.before.clone()), ..self.without_text() }
    }

    /// Returns the stages that depend on the file's text alone.
    fn only_parsed(&self) -> Stages {
        Stages { parsed: self.parsed.get().into(), ..self.without_text() }
    }

    /// Returns only the results that are shown until they are computed anew.
    fn without_text(&self) -> Stages {
        // motions that were not computed keep the earlier ones
        Stages { earlier_motions: self.motions.get().or_else(|| self.earlier_motions.clone()), ..Stages::default() }
    }
}

/// Builds the list of names of each mechanism of a file, so that later requests find it cached.
pub fn index_names(snapshot: &Snapshot, path: &Path) {
    let checked = snapshot.checked(path);
    for mechanism in checked.iter().flat_map(|checked| &checked.mechanisms).take_while(|_| !snapshot.is_cancelled()) {
        let _ = mechanism.symbols();
    }
}

/// Proves and assembles a mechanism, unless it is a part of another one.
fn prove(checked: &Checked, cancel: &Cancel) -> Proof {
    if checked.is_part_of_another() { Proof::empty(checked) } else { prove_standalone(checked, cancel) }
}

fn prove_standalone(checked: &Checked, cancel: &Cancel) -> Proof {
    let mut proof = Proof::empty(checked);
    let (compiled, diagnostics) = checked.compile(Redundant::Refused, cancel);
    proof.diagnostics = diagnostics;
    let Some(compiled) = compiled else { return proof };
    let refused = compiled.analysis().map(|[from, to, _]| compiled.refused_results([from, to]));
    proof.diagnostics.extend(refused.unwrap_or_default());
    let options = RunOptions { cancel: cancel.clone(), ..RunOptions::default() };
    let (assembly, diagnostics) = compiled.assemble_at(compiled.first_time(), &options);
    proof.diagnostics.extend(diagnostics);
    proof.assembly = assembly;
    proof.sources = compiled.sources().clone();
    proof.compiled = Some(compiled);
    proof
}

impl MotionOutcome {
    fn empty() -> MotionOutcome {
        let (mechanism, diagnostics, results) = Default::default();
        MotionOutcome { mechanism, diagnostics, results, is_cut_short: false }
    }

    /// Returns the outcome of a cancelled motion: the results of an earlier text.
    fn cut_short<'b>(proof: &Proof, before: impl Fn(&str) -> Option<&'b MotionOutcome>) -> MotionOutcome {
        let mechanism = proof.compiled.as_ref().map(|compiled| compiled.name().to_owned()).unwrap_or_default();
        let results = before(&mechanism).map(|before| before.results.clone()).unwrap_or_default();
        MotionOutcome { mechanism, results, is_cut_short: true, ..MotionOutcome::empty() }
    }
}

/// Runs a motion to its end; `None` if it is cancelled.
fn run(proof: &Proof, cancel: &Cancel) -> Option<MotionOutcome> {
    let mut outcome = MotionOutcome::empty();
    let compiled = proof.compiled.as_ref().filter(|_| !proof.diagnostics.has_errors());
    let Some((compiled, times)) = compiled.and_then(|compiled| Some((compiled, compiled.times()?))) else {
        return Some(outcome);
    };
    compiled.name().clone_into(&mut outcome.mechanism);
    let (run, _) = compiled.run(&times, &RunOptions { cancel: cancel.clone(), ..RunOptions::default() });
    let Some(mut run) = run else { return (!cancel.is_cancelled()).then_some(outcome) };
    while let Some(row) = run.next_row() {
        if let Err(why) = row {
            outcome.diagnostics.extend(why.diagnostics);
        }
        outcome.diagnostics.extend(run.take_warnings());
    }
    let names = compiled.results();
    let answers = if cancel.is_cancelled() { None } else { run.results() }.unwrap_or_default();
    let results = names.into_iter().zip(&answers.values);
    let results = results.map(|((name, unit), value)| ResultValue {
        value: value.map(|v| unit.printed(v)),
        name,
        unit: unit.text,
    });
    outcome.results = results.collect();
    (!cancel.is_cancelled()).then_some(outcome)
}
