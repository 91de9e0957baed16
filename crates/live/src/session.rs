//! A live session: the current version of the texts, and the responses to pages computed from it.

use super::edit::{EditOutcome, apply_changes};
use super::file_snapshot::FileSnapshot;
use super::host::Host;
use super::page;
use super::requests::{ManualInputs, MotionRequest, WriteRequest};
use super::response::encode;
use super::solution::{Solution, SolutionBuilder};
use mechc_pipeline::{Choice, ParamControl, ParametricMechanism, Parsed, Redundant, size_of_unit};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Error;
use mechc_text::source::Span;
use mechc_text::world::World;
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// The interval at which a thread that waits for the baseline checks whether it is cancelled.
const CANCEL_CHECK: Duration = Duration::from_millis(20);
/// The stack of the thread that computes the baseline (bytes).
const STACK: usize = 8 << 20;
/// The maximum number of pages whose pending requests are remembered; the request of a forgotten page is not superseded.
const MAX_PAGES: usize = 64;

/// A file that pages follow.
pub struct LiveSession {
    path: PathBuf,
    choice: Choice,
    redundant: Redundant,
    pass_bifurcations: bool,
    host: Box<dyn Host>,
    current: Mutex<Current>,
    has_changed: Condvar,
    /// Held while the files are compared with those of the current version.
    reloading: Mutex<()>,
    /// The pending request of each page.
    pending: Mutex<FxHashMap<String, Cancel>>,
}

struct Current {
    texts: Arc<Texts>,
    at: Option<u32>,
    file: Option<String>,
}

/// Params and their values, as `--set` takes them.
type Settings = Vec<(String, String)>;

/// The status that pages are notified of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct LiveStatus {
    /// The version of the texts.
    pub version: u64,
    /// The position of an editor's cursor (UTF-16), if there is one.
    pub at: Option<u32>,
    /// The name of the cursor's file in messages; `None` for the file that the page shows.
    pub file: Option<String>,
}

impl LiveStatus {
    /// Returns the event that pages receive.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({ "version": self.version, "at": self.at, "file": self.file })
    }
}

/// A version of the texts, with the results computed from it.
struct Texts {
    version: u64,
    files: FileSnapshot,
    parsed: Result<Parsed, Error>,
    /// Cancelled when a newer version replaces this one.
    cancel: Cancel,
    baseline: Mutex<Baseline>,
    baseline_changed: Condvar,
    /// Files that earlier versions read; they are watched until it is clear which files this version reads.
    earlier_files: Vec<PathBuf>,
    /// The last settings, with their solution.
    last: Mutex<Option<(Settings, Arc<Solution>)>>,
    /// The mechanism with the params of the last settings as numbers.
    parametric: Mutex<Option<CachedParametric>>,
}

/// The names of params, and the mechanism with these as numbers, if they can take other values.
type CachedParametric = (Vec<String>, Option<Arc<ParametricMechanism>>);

/// The solution of the file as it is written. It is computed once for all pages, as long as one of them waits for it.
#[derive(Default)]
struct Baseline {
    solution: Option<Arc<Solution>>,
    /// Cancels the computation; `None` if none is running.
    computation: Option<Cancel>,
    /// The number of threads that wait for it.
    waiting: usize,
}

/// The outcome of waiting for the baseline.
enum WaitOutcome {
    Ready(Arc<Solution>),
    /// The computation was abandoned because its last waiting thread left, or its thread could not be started.
    Abandoned,
    /// The waiting request was cancelled, or a newer version replaced the texts.
    Cancelled,
}

impl Texts {
    fn read(version: u64, world: Arc<dyn World>, path: &Path, earlier_files: Vec<PathBuf>) -> Texts {
        let files = FileSnapshot::new(world);
        let parsed = Parsed::read(path, &files);
        let (cancel, baseline, baseline_changed, last, parametric) = Default::default();
        Texts { version, files, parsed, cancel, baseline, baseline_changed, earlier_files, last, parametric }
    }

    /// Returns the files to watch, as far as they are determined.
    fn watched_files(&self) -> Vec<PathBuf> {
        let mut files = self.files.files();
        if lock(&self.baseline).solution.is_none() {
            files.extend(self.earlier_files.iter().filter(|file| !files.contains(file)).cloned().collect::<Vec<_>>());
        }
        files
    }

    /// Returns the mechanism with the params of settings as numbers that take other values.
    fn parametric(
        &self,
        builder: &SolutionBuilder<'_>,
        baseline: &Solution,
        set: &[(String, String)],
        cancel: &Cancel,
    ) -> Option<Arc<ParametricMechanism>> {
        let mut cached = lock(&self.parametric);
        if let Some((_, parametric)) =
            cached.as_ref().filter(|(names, _)| names.iter().eq(set.iter().map(|(name, _)| name)))
        {
            return parametric.clone();
        }
        let names: Vec<String> = set.iter().map(|(name, _)| name.clone()).collect();
        let parametric = builder.parametric(baseline, &names, cancel).map(Arc::new);
        // the outcome of cancelled work must not be kept
        if !cancel.is_cancelled() {
            *cached = Some((names, parametric.clone()));
        }
        parametric
    }

    /// Waits until the computation of the baseline ends.
    fn wait_for_baseline(&self, cancel: &Cancel) -> WaitOutcome {
        let mut baseline = lock(&self.baseline);
        loop {
            let is_cancelled = cancel.is_cancelled() || self.cancel.is_cancelled();
            if baseline.computation.is_none() || is_cancelled {
                baseline.waiting -= 1;
                if let Some(computation) = baseline.computation.as_ref().filter(|_| baseline.waiting == 0) {
                    computation.cancel();
                }
                return match &baseline.solution {
                    _ if is_cancelled => WaitOutcome::Cancelled,
                    Some(solution) => WaitOutcome::Ready(Arc::clone(solution)),
                    None => WaitOutcome::Abandoned,
                };
            }
            let waited = self.baseline_changed.wait_timeout(baseline, CANCEL_CHECK);
            baseline = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl LiveSession {
    /// Opens a session for a file with the options of the command.
    #[must_use]
    pub fn new(
        path: &Path,
        choice: Choice,
        redundant: Redundant,
        pass_bifurcations: bool,
        host: Box<dyn Host>,
    ) -> LiveSession {
        let texts = Arc::new(Texts::read(1, host.world(), path, Vec::new()));
        LiveSession {
            path: path.to_owned(),
            choice,
            redundant,
            pass_bifurcations,
            host,
            current: Mutex::new(Current { texts, at: None, file: None }),
            has_changed: Condvar::new(),
            reloading: Mutex::default(),
            pending: Mutex::default(),
        }
    }

    /// Returns the files to watch: those that were read and those that were missing.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = self.texts().watched_files();
        if !files.contains(&self.path) {
            files.push(self.path.clone());
        }
        files
    }

    /// Reads the files again if one of them has changed, and notifies all pages; returns whether it did.
    pub fn reload(&self) -> bool {
        let _alone = lock(&self.reloading);
        let before = self.texts();
        if !before.files.is_outdated(&*self.host.world()) {
            return false;
        }
        before.cancel.cancel();
        let texts = Texts::read(before.version + 1, self.host.world(), &self.path, before.watched_files());
        lock(&self.current).texts = Arc::new(texts);
        // pages ask anew once they hear of the new version
        for (_, cancel) in lock(&self.pending).drain() {
            cancel.cancel();
        }
        self.has_changed.notify_all();
        true
    }

    /// Notifies all pages of the position of an editor's cursor (UTF-16). In a file that the session does not read it has no position.
    pub fn set_cursor(&self, path: &Path, at: u32) {
        let world = self.host.world();
        let is_same = |file: &Path| file == path || world.identity(file) == world.identity(path);
        let cursor = if is_same(&self.path) {
            (Some(at), None)
        } else {
            let used = self.files().into_iter().find(|file| is_same(file));
            (used.as_ref().map(|_| at), used.map(|file| world.shown(&file)))
        };
        let mut current = lock(&self.current);
        if (current.at, &current.file) != (cursor.0, &cursor.1) {
            (current.at, current.file) = cursor;
            self.has_changed.notify_all();
        }
    }

    /// Waits until the status differs from the last one that was sent; `None` if it does not change within `at_most`.
    #[must_use]
    pub fn wait_for_change(&self, last: Option<&LiveStatus>, at_most: Duration) -> Option<LiveStatus> {
        let status = |current: &Current| LiveStatus {
            version: current.texts.version,
            at: current.at,
            file: current.file.clone(),
        };
        let is_unchanged = |current: &mut Current| Some(&status(current)) == last;
        let waited = self.has_changed.wait_timeout_while(lock(&self.current), at_most, is_unchanged);
        let (current, time) = waited.unwrap_or_else(PoisonError::into_inner);
        (!time.timed_out()).then(|| status(&current))
    }

    /// Shows a position of the file (UTF-16) in the editor.
    pub fn show(&self, at: u32) {
        self.host.show(at);
    }

    /// Answers a page as long as it waits. A request of the page that is still pending is superseded.
    #[must_use]
    pub fn answer(&self, request: &MotionRequest, cancel: &Cancel) -> Vec<u8> {
        self.supersede(&request.page, cancel);
        let texts = self.texts();
        let (response, columns) = self.respond(&texts, request, cancel).unwrap_or_else(|| {
            // the page will send another request, or has
            (json!({ "live": { "version": texts.version, "superseded": true } }), Vec::new())
        });
        encode(&response, &columns)
    }

    fn respond(&self, texts: &Texts, request: &MotionRequest, cancel: &Cancel) -> Option<Response> {
        let baseline = self.baseline(texts, cancel)?;
        if !baseline.is_sound() {
            return Some((json!({ "live": failure_json(texts.version, &baseline) }), Vec::new()));
        }
        let params = baseline.params();
        let exists = |(name, _): &&(String, String)| params.iter().any(|param| param.name == *name);
        let set: Settings = request.set.iter().filter(exists).cloned().collect();
        let builder = self.builder(texts);
        let solution = if set.is_empty() {
            Arc::clone(&baseline)
        } else {
            cached(texts, &set, || {
                let parametric = texts.parametric(&builder, &baseline, &set, cancel);
                builder.with_params(&baseline, parametric.as_deref(), &set, cancel)
            })?
        };
        let context = RequestContext { version: texts.version, builder, baseline, solution, cancel };
        match (&request.manual, request.at) {
            (Some(manual), _) => context.manual(manual),
            (None, Some(t)) => context.preview(&texts.cancel, t),
            (None, None) => context.motion(&texts.cancel, &params),
        }
    }

    /// Writes values into the file; returns the outcome as JSON.
    #[must_use]
    pub fn write(&self, write: &WriteRequest) -> Value {
        match self.try_write(write) {
            Ok(()) => json!({ "written": true }),
            Err(EditOutcome::NeedsConfirmation(request)) => json!({ "asks": request }),
            Err(EditOutcome::Refused(why)) => json!({ "refused": why }),
            Err(EditOutcome::Text(_)) => json!({ "refused": "nothing was written" }),
        }
    }

    fn try_write(&self, write: &WriteRequest) -> Result<(), EditOutcome> {
        let refused = |why: &str| EditOutcome::Refused(why.to_owned());
        self.reload();
        let texts = self.texts();
        if texts.version != write.version {
            return Err(refused(FILE_CHANGED));
        }
        let baseline = self.baseline(&texts, &Cancel::default()).ok_or_else(|| refused(FILE_CHANGED))?;
        let checked = baseline.checked.as_ref().filter(|_| baseline.is_sound());
        let text = match apply_changes(checked.ok_or_else(|| refused("the text is wrong"))?, write) {
            EditOutcome::Text(text) => text,
            other => return Err(other),
        };
        let parsed = texts.parsed.as_ref().map_err(|_| refused(FILE_CHANGED))?;
        let after = parsed.edited(&text).check(&self.choice, &texts.files);
        if let Some(error) = after.diagnostics().iter().find(|diagnostic| diagnostic.is_error()) {
            return Err(refused(&format!("the text would be wrong with that: {}", error.message)));
        }
        let has_mark =
            texts.files.read(&self.path).is_ok_and(|file| file.bytes.starts_with(BYTE_ORDER_MARK.as_bytes()));
        let text = if has_mark { format!("{BYTE_ORDER_MARK}{text}") } else { text };
        if texts.files.is_outdated(&*self.host.world()) {
            return Err(refused(FILE_CHANGED));
        }
        // the host calls this immediately before it replaces the file, so a late save is not overwritten
        let is_due = || !texts.files.differs(&self.path, &*self.host.world());
        let is_written = self.host.write(&text, &is_due).map_err(EditOutcome::Refused)?;
        self.reload();
        if is_written { Ok(()) } else { Err(refused(FILE_CHANGED)) }
    }

    /// Returns the solution of the file as it is written; `None` if a newer version replaces it or the request is cancelled.
    fn baseline(&self, texts: &Texts, cancel: &Cancel) -> Option<Arc<Solution>> {
        loop {
            let to_start = {
                let mut baseline = lock(&texts.baseline);
                if let Some(solution) = &baseline.solution {
                    return (!texts.cancel.is_cancelled()).then(|| Arc::clone(solution));
                }
                baseline.waiting += 1;
                let is_running = baseline.computation.is_some();
                let computation = baseline.computation.get_or_insert_with(Cancel::default);
                (!is_running).then(|| computation.clone())
            };
            let outcome = thread::scope(|scope| {
                if let Some(computation) = to_start {
                    let compute = move || self.compute_baseline(texts, &computation);
                    let thread = thread::Builder::new().name("live solve".to_owned()).stack_size(STACK);
                    // without a thread the computation counts as abandoned
                    if thread.spawn_scoped(scope, compute).is_err() {
                        lock(&texts.baseline).computation = None;
                    }
                }
                texts.wait_for_baseline(cancel)
            });
            match outcome {
                WaitOutcome::Ready(solution) => return Some(solution),
                WaitOutcome::Cancelled => return None,
                // it was abandoned by other requests while this one arrived: start it anew
                WaitOutcome::Abandoned => {}
            }
        }
    }

    /// Computes the baseline with its motion, unless no request waits for it any more.
    fn compute_baseline(&self, texts: &Texts, computation: &Cancel) {
        let builder = self.builder(texts);
        let solution = builder.baseline(computation);
        builder.motion(&solution, None, computation);
        let mut baseline = lock(&texts.baseline);
        baseline.solution = (!computation.is_cancelled()).then(|| Arc::new(solution));
        baseline.computation = None;
        drop(baseline);
        texts.baseline_changed.notify_all();
    }

    fn builder<'s>(&'s self, texts: &'s Texts) -> SolutionBuilder<'s> {
        SolutionBuilder {
            parsed: &texts.parsed,
            files: &texts.files,
            choice: &self.choice,
            redundant: self.redundant,
            pass_bifurcations: self.pass_bifurcations,
            host: &*self.host,
        }
    }

    fn texts(&self) -> Arc<Texts> {
        Arc::clone(&lock(&self.current).texts)
    }

    /// Makes a request the pending one of its page, and cancels the one before.
    fn supersede(&self, page: &str, cancel: &Cancel) {
        let mut pending = lock(&self.pending);
        if pending.len() >= MAX_PAGES {
            pending.clear();
        }
        if let Some(before) = pending.insert(page.to_owned(), cancel.clone()) {
            before.cancel();
        }
    }
}

/// The JSON of a response, and the columns that follow it.
type Response = (Value, Vec<Vec<f64>>);

/// A request with the solutions that its response is made from.
struct RequestContext<'a> {
    version: u64,
    builder: SolutionBuilder<'a>,
    /// The solution of the file as it is written.
    baseline: Arc<Solution>,
    /// The solution with the params of the request.
    solution: Arc<Solution>,
    cancel: &'a Cancel,
}

impl RequestContext<'_> {
    /// Responds with the row that inputs reach when they are moved by hand.
    fn manual(&self, ManualInputs { time, inputs }: &ManualInputs) -> Option<Response> {
        let outcome = self.builder.move_inputs(&self.solution, *time, inputs, self.cancel)?;
        let input = json!({ "reached": outcome.reached, "said": outcome.message });
        Some((json!({ "live": { "version": self.version, "jog": input } }), outcome.columns))
    }

    /// Responds with the picture at one time.
    fn preview(&self, of_texts: &Cancel, t: f64) -> Option<Response> {
        let baseline = self.builder.motion(&self.baseline, None, of_texts)?;
        let baseline = baseline.visualization.as_ref();
        let preview = baseline.and_then(|baseline| self.builder.preview(&self.solution, baseline, t, self.cancel));
        let live = json!({ "version": self.version, "glimpse": preview.is_some() });
        let page = preview.as_ref().map(|preview| page::single_page(preview, &self.solution.sources));
        let (scene, row) = page.map(|page| page.picture()).unwrap_or_default();
        Some((json!({ "live": live, "scene": scene }), row))
    }

    /// Responds with the whole motion and the controls of the page.
    fn motion(&self, of_texts: &Cancel, params: &[ParamControl]) -> Option<Response> {
        let RequestContext { baseline, solution, .. } = self;
        let mut motion = self.builder.motion(baseline, None, of_texts)?;
        if !Arc::ptr_eq(baseline, solution) {
            motion = self.builder.motion(solution, motion.visualization.as_ref(), self.cancel)?;
        }
        let Some(visualization) = &motion.visualization else {
            let mut live = failure_json(self.version, solution);
            if !Arc::ptr_eq(baseline, solution) {
                // the text is valid and only the params are not, so the page keeps its controls
                live["knobs"] = self.params_json(params);
            }
            return Some((json!({ "live": live }), Vec::new()));
        };
        let (mut data, mut columns) = page::single_page(visualization, &solution.sources).data();
        let times: Vec<f64> = visualization.motion.rows().iter().map(|row| row[0]).collect();
        let inputs = solution.inputs(&times);
        columns.extend(inputs.iter().map(|input| input.values.clone()));
        data["live"] = json!({
            "version": self.version,
            "knobs": self.params_json(params),
            "cranks": solution.cranks().iter().map(|crank| json!({
                "frame": crank.body + 1, "pivot": crank.pivot,
                "input": crank.input.as_ref().map(|input| &input.name), "rate": crank.input.as_ref().map(|input| input.rate),
            })).collect::<Vec<_>>(),
            "jogs": inputs.iter().map(|input| json!({
                "name": input.name, "unit": input.written, "formula": input.formula,
                "si": size_of_unit(&input.written), "dimension": input.dimension,
            })).collect::<Vec<_>>(),
        });
        Some((data, columns))
    }

    /// Returns the params that the page may set.
    fn params_json(&self, params: &[ParamControl]) -> Value {
        let sources = &self.baseline.sources;
        // only these follow from values of others, which takes a check
        let has_followers = params.iter().any(|param| param.formula.is_some() || param.of.is_some());
        let set = if has_followers { self.solution.params() } else { Vec::new() };
        let set: FxHashMap<&str, f64> = set.iter().map(|param| (param.name.as_str(), param.value)).collect();
        let now = |param: &ParamControl| {
            set.get(param.name.as_str()).filter(|_| param.formula.is_some() || param.of.is_some())
        };
        let mut sizes: FxHashMap<&str, f64> = FxHashMap::default();
        let is_here = |span: &Span| self.baseline.checked.as_ref().is_some_and(|checked| checked.file() == span.file);
        let params = params.iter().map(|param| {
            let line = |span: Span| {
                let file = sources.get(span.file);
                format!("{}:{}", file.name, file.position(span.start).0)
            };
            json!({
                "name": param.name, "unit": param.unit, "value": param.value, "formula": param.formula,
                "si": sizes.entry(&param.unit).or_insert_with(|| size_of_unit(&param.unit)),
                "dimension": param.dimension, "held": self.builder.command_setting(&param.name), "whole": !param.is_continuous,
                "now": now(param),
                "of": param.of,
                "text": param.editable_span.filter(is_here).map(|span| sources.text(span)),
                "where": param.formula_span.filter(|_| param.editable_span.is_none_or(|span| !is_here(&span))).map(line),
            })
        });
        Value::Array(params.collect())
    }
}

/// The refusal to overwrite a change that the page does not show.
const FILE_CHANGED: &str = "the file is another by now than the one that this page shows";

/// The UTF-8 byte-order mark.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Returns the diagnostics of a mechanism that cannot be shown.
fn failure_json(version: u64, solution: &Solution) -> Value {
    json!({ "version": version, "wrong": solution.rendered() })
}

/// Returns the solution of some settings, which is computed unless they are those of the last request.
fn cached(
    texts: &Texts,
    set: &[(String, String)],
    compute: impl FnOnce() -> Option<Solution>,
) -> Option<Arc<Solution>> {
    if let Some((_, solution)) = lock(&texts.last).as_ref().filter(|(last, _)| last == set) {
        return Some(Arc::clone(solution));
    }
    let solution = Arc::new(compute()?);
    *lock(&texts.last) = Some((set.to_vec(), Arc::clone(&solution)));
    Some(solution)
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::{LiveSession, MotionRequest, WriteRequest};
    use crate::host::Host;
    use crate::requests::ValueChange;
    use mechc_engine::analysis::Times;
    use mechc_pipeline::{Choice, Compiled, Redundant};
    use mechc_text::cancel::Cancel;
    use mechc_text::diag::Diagnostics;
    use mechc_text::source::Sources;
    use mechc_text::world::{Contents, Memory, World};
    use std::io;
    use std::path::{Path, PathBuf};
    use std::sync::{Arc, Mutex};

    const MAIN: &str = "use \"lib/arm.mech\"
mechanism disc {
    param speed = 1 rad/s
    part one: arm()
    driver motor: rotation(one.axle) = speed * t
    analysis from 0 s to 1 s every 100 ms
}
";
    const ARM: &str = "mechanism arm {
    ground { point O = (0, 0) }
    body bar { point O = (0, 0) point P = (20 mm, 0) }
    joint axle: revolute(ground.O, bar.O)
}
";

    /// Files that a test changes.
    #[derive(Default)]
    struct TestFiles {
        files: Mutex<Memory>,
        /// Files that another program saves immediately before a text is written.
        late_save: Mutex<Option<Memory>>,
        written: Mutex<Vec<String>>,
    }

    impl World for TestFiles {
        fn read(&self, path: &Path) -> io::Result<Contents> {
            self.files.lock().expect("a lock").read(path)
        }
    }

    struct TestHost(Arc<TestFiles>);

    impl Host for TestHost {
        fn world(&self) -> Arc<dyn World> {
            Arc::clone(&self.0) as Arc<dyn World>
        }

        fn times(&self, compiled: &Compiled, _: &mut Sources) -> Result<Times, Diagnostics> {
            compiled.times().ok_or_else(Diagnostics::default)
        }

        fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
            if let Some(files) = self.0.late_save.lock().expect("a lock").take() {
                *self.0.files.lock().expect("a lock") = files;
            }
            let is_due = is_due();
            if is_due {
                self.0.written.lock().expect("a lock").push(text.to_owned());
            }
            Ok(is_due)
        }
    }

    fn session() -> (Arc<TestFiles>, LiveSession) {
        let disk = Arc::new(TestFiles::default());
        disk.has(MAIN);
        let host = Box::new(TestHost(Arc::clone(&disk)));
        let session = LiveSession::new(Path::new("disc.mech"), Choice::default(), Redundant::Refused, false, host);
        (disk, session)
    }

    impl TestFiles {
        fn has(&self, main: &str) {
            *self.files.lock().expect("a lock") = files(main);
        }
    }

    fn files(main: &str) -> Memory {
        Memory::default().with("disc.mech", main).with("lib/arm.mech", ARM)
    }

    #[test]
    fn files_are_watched_until_the_new_version_is_solved() {
        let (disk, session) = session();
        let used = PathBuf::from("lib/arm.mech");
        let ask =
            || session.answer(&MotionRequest { page: "a".to_owned(), ..MotionRequest::default() }, &Cancel::default());
        assert!(String::from_utf8_lossy(&ask()).contains("one.bar.phi"));
        assert!(session.files().contains(&used));
        for round in 0..2 {
            disk.has(&format!("{MAIN}// {round}"));
            assert!(session.reload());
            assert!(session.files().contains(&used), "the new version is not solved yet");
        }
        disk.has(&MAIN.replace("use", "// use"));
        assert!(session.reload());
        ask();
        assert_eq!(session.files(), [PathBuf::from("disc.mech")]);
    }

    #[test]
    fn a_late_save_is_not_overwritten() {
        let (disk, session) = session();
        let change = ValueChange { name: "speed".to_owned(), old: "1 rad/s".to_owned(), value: 2.0 };
        let write = |version| WriteRequest { version, changes: vec![change.clone()], is_confirmed: false };
        *disk.late_save.lock().expect("a lock") = Some(files(&format!("{MAIN}// another hand")));
        let response = session.write(&write(1)).to_string();
        assert!(response.contains("another by now"), "{response}");
        assert!(disk.written.lock().expect("a lock").is_empty());
        let response = session.write(&write(2)).to_string();
        assert!(response.contains("written\":true"), "{response}");
        let expected = MAIN.replace("1 rad/s", "2 rad/s") + "// another hand";
        assert_eq!(*disk.written.lock().expect("a lock"), [expected]);
    }

    #[test]
    fn a_cancelled_request_does_not_affect_the_next() {
        let (_, session) = session();
        let cancelled = Cancel::default();
        cancelled.cancel();
        let request = MotionRequest { page: "a".to_owned(), ..MotionRequest::default() };
        let response = session.answer(&request, &cancelled);
        assert!(String::from_utf8_lossy(&response).contains("superseded"));
        let response = session.answer(&request, &Cancel::default());
        assert!(String::from_utf8_lossy(&response).contains("one.bar.phi"));
    }
}
