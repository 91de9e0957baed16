//! The texts as of now, and what pages ask of them.

use super::answer::framed;
use super::asked::{Jogged, Question, Write};
use super::edit::{Edited, edited};
use super::host::Host;
use super::page;
use super::shelf::Shelf;
use super::solved::{Solved, Solver};
use crate::cancel::Cancel;
use crate::diag::Diagnostics;
use crate::source::Sources;
use crate::stages::{Choice, Knob, Parsed, Redundant};
use crate::world::World;
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

/// Pages whose questions are remembered; one that is forgotten is only not interrupted.
const MOST_PAGES: usize = 64;

/// What is made of a file.
pub struct Workshop {
    path: PathBuf,
    choice: Choice,
    redundant: Redundant,
    pass_bifurcations: bool,
    host: Box<dyn Host>,
    now: Mutex<Now>,
    has_changed: Condvar,
    /// One at a time looks whether something has changed.
    looking: Mutex<()>,
    waiting: Mutex<FxHashMap<String, Cancel>>,
}

struct Now {
    texts: Arc<Texts>,
    at: Option<u32>,
}

/// Params with what they are set to.
type Settings = Vec<(String, String)>;

/// What pages are told without asking.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct News {
    /// Of the texts.
    pub version: u64,
    /// Where an editor's cursor is in the file (UTF-16), if there is one.
    pub at: Option<u32>,
}

/// The texts of a version, and what has been made of them.
struct Texts {
    version: u64,
    shelf: Shelf,
    parsed: Result<Parsed, (Sources, Diagnostics)>,
    /// Ends what is made of them, once there are others.
    cancel: Cancel,
    own: OnceLock<Arc<Solved>>,
    /// The settings that were asked for last, with what came of them.
    last: Mutex<Option<(Settings, Arc<Solved>)>>,
}

impl Texts {
    fn read(version: u64, world: Arc<dyn World>, path: &Path) -> Texts {
        let shelf = Shelf::new(world);
        let parsed = Parsed::read(path, &shelf);
        Texts { version, shelf, parsed, cancel: Cancel::default(), own: OnceLock::new(), last: Mutex::default() }
    }
}

impl Workshop {
    /// What is made of a file, of which what is chosen is shown.
    #[must_use]
    pub fn new(
        path: &Path,
        choice: Choice,
        (redundant, pass_bifurcations): (Redundant, bool),
        host: Box<dyn Host>,
    ) -> Workshop {
        let texts = Arc::new(Texts::read(1, host.world(), path));
        Workshop {
            path: path.to_owned(),
            choice,
            redundant,
            pass_bifurcations,
            host,
            now: Mutex::new(Now { texts, at: None }),
            has_changed: Condvar::new(),
            looking: Mutex::default(),
            waiting: Mutex::default(),
        }
    }

    /// The files that it has looked at, and where some were missing.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = self.texts().shelf.files();
        if !files.contains(&self.path) {
            files.push(self.path.clone());
        }
        files
    }

    /// Looks whether a file is another by now, and tells all pages if so.
    pub fn look(&self) -> bool {
        let _alone = lock(&self.looking);
        let before = self.texts();
        if !before.shelf.is_old(&*self.host.world()) {
            return false;
        }
        before.cancel.cancel();
        let texts = Texts::read(before.version + 1, self.host.world(), &self.path);
        lock(&self.now).texts = Arc::new(texts);
        self.has_changed.notify_all();
        true
    }

    /// Tells all pages where an editor's cursor is in the file (UTF-16).
    pub fn point(&self, at: Option<u32>) {
        lock(&self.now).at = at;
        self.has_changed.notify_all();
    }

    /// What is new to who was told that before; nothing if that takes too long.
    #[must_use]
    pub fn news(&self, told: Option<&News>, at_most: Duration) -> Option<News> {
        let news = |now: &Now| News { version: now.texts.version, at: now.at };
        let is_old = |now: &mut Now| Some(&news(now)) == told;
        let waited = self.has_changed.wait_timeout_while(lock(&self.now), at_most, is_old);
        let (now, time) = waited.unwrap_or_else(PoisonError::into_inner);
        (!time.timed_out()).then(|| news(&now))
    }

    /// Shows a place of the file (UTF-16) in the editor.
    pub fn show(&self, at: u32) {
        self.host.show(at);
    }

    /// Answers a page. What it had asked before and is waiting for is given up.
    #[must_use]
    pub fn answer(&self, asked: &Question) -> Vec<u8> {
        let cancel = self.cancel_for(&asked.page);
        let texts = self.texts();
        let (answer, columns) = self.answered(&texts, asked, &cancel).unwrap_or_else(|| {
            // the page will ask again, or has
            (json!({ "live": { "version": texts.version, "superseded": true } }), Vec::new())
        });
        framed(&answer, &columns)
    }

    fn answered(&self, texts: &Texts, asked: &Question, cancel: &Cancel) -> Option<Answer> {
        let own = self.own(texts)?;
        if !own.is_sound() {
            return Some((wrong(texts.version, &own), Vec::new()));
        }
        let knobs = own.knobs();
        let known = |(name, _): &&(String, String)| knobs.iter().any(|knob| knob.name == *name);
        let set: Settings = asked.set.iter().filter(known).cloned().collect();
        let solver = self.solver(texts);
        let solved =
            if set.is_empty() { Arc::clone(&own) } else { remembered(texts, &set, || solver.set(&own, &set, cancel))? };
        let what = Asked { version: texts.version, solver, own, solved, cancel };
        match (&asked.jog, asked.at) {
            (Some(jog), _) => what.jogged(&set, jog),
            (None, Some(t)) => what.glimpse(&texts.cancel, t),
            (None, None) => what.motion(&texts.cancel, &knobs),
        }
    }

    /// Writes values into the file, or says why not.
    #[must_use]
    pub fn write(&self, write: &Write) -> Value {
        match self.written(write) {
            Ok(()) => json!({ "written": true }),
            Err(Edited::Asks(asks)) => json!({ "asks": asks }),
            Err(Edited::Refused(why)) => json!({ "refused": why }),
            Err(Edited::Text(_)) => json!({ "refused": "nothing was written" }),
        }
    }

    fn written(&self, write: &Write) -> Result<(), Edited> {
        let refused = |why: &str| Edited::Refused(why.to_owned());
        self.look();
        let texts = self.texts();
        if texts.version != write.version {
            return Err(refused(OTHER));
        }
        let own = self.own(&texts).ok_or_else(|| refused(OTHER))?;
        let checked = own.checked.as_ref().filter(|_| own.is_sound()).ok_or_else(|| refused("the text is wrong"))?;
        let text = match edited(checked, write) {
            Edited::Text(text) => text,
            other => return Err(other),
        };
        let has_mark = texts.shelf.read(&self.path).is_ok_and(|file| file.bytes.starts_with(MARK.as_bytes()));
        let text = if has_mark { format!("{MARK}{text}") } else { text };
        // as late as can be
        if texts.shelf.is_old(&*self.host.world()) {
            return Err(refused(OTHER));
        }
        self.host.write(&text).map_err(Edited::Refused)?;
        self.look();
        Ok(())
    }

    /// The file as it is.
    fn own(&self, texts: &Texts) -> Option<Arc<Solved>> {
        let make = || {
            let solver = self.solver(texts);
            let own = solver.own(&texts.cancel);
            // once for all pages, which wait for it
            solver.watched(&own, None, &texts.cancel);
            Arc::new(own)
        };
        let own = texts.own.get_or_init(make);
        (!texts.cancel.is_cancelled()).then(|| Arc::clone(own))
    }

    fn solver<'s>(&'s self, texts: &'s Texts) -> Solver<'s> {
        Solver {
            parsed: &texts.parsed,
            shelf: &texts.shelf,
            choice: &self.choice,
            redundant: self.redundant,
            pass_bifurcations: self.pass_bifurcations,
            host: &*self.host,
        }
    }

    fn texts(&self) -> Arc<Texts> {
        Arc::clone(&lock(&self.now).texts)
    }

    /// What ends the answer to a page; ends the one before.
    fn cancel_for(&self, page: &str) -> Cancel {
        let mut waiting = lock(&self.waiting);
        if waiting.len() >= MOST_PAGES {
            waiting.clear();
        }
        let cancel = Cancel::default();
        if let Some(before) = waiting.insert(page.to_owned(), cancel.clone()) {
            before.cancel();
        }
        cancel
    }
}

/// The JSON of an answer, and the numbers behind it.
type Answer = (Value, Vec<Vec<f64>>);

/// What is asked, with what is known by then.
struct Asked<'a> {
    version: u64,
    solver: Solver<'a>,
    /// The file as it is.
    own: Arc<Solved>,
    /// With the params that are set.
    solved: Arc<Solved>,
    cancel: &'a Cancel,
}

impl Asked<'_> {
    fn jogged(&self, set: &[(String, String)], Jogged { time, inputs }: &Jogged) -> Option<Answer> {
        let (reached, said, row) = self.solver.jogged(&self.solved, set, *time, inputs, self.cancel)?;
        let jog = json!({ "reached": reached, "said": said });
        Some((json!({ "live": { "version": self.version, "jog": jog } }), row))
    }

    /// The picture at a time alone.
    fn glimpse(&self, of_texts: &Cancel, t: f64) -> Option<Answer> {
        let before = self.solver.watched(&self.own, None, of_texts)?;
        let seen = before.seen.as_ref().and_then(|own| self.solver.glimpse(&self.solved, own, t, self.cancel));
        let live = json!({ "version": self.version, "glimpse": seen.is_some() });
        let page = seen.as_ref().map(|seen| page::of_one(seen, &self.solved.sources));
        let (scene, row) = page.map(|page| page.picture()).unwrap_or_default();
        Some((json!({ "live": live, "scene": scene }), row))
    }

    /// The whole motion, and what there is to turn.
    fn motion(&self, of_texts: &Cancel, knobs: &[Knob]) -> Option<Answer> {
        let Asked { own, solved, .. } = self;
        let mut watched = self.solver.watched(own, None, of_texts)?;
        if !Arc::ptr_eq(own, solved) {
            watched = self.solver.watched(solved, watched.seen.as_ref(), self.cancel)?;
        }
        let Some(seen) = &watched.seen else {
            return Some((wrong(self.version, solved), Vec::new()));
        };
        let (mut data, mut columns) = page::of_one(seen, &solved.sources).data();
        let times: Vec<f64> = seen.motion.rows().iter().map(|row| row[0]).collect();
        let jogs = solved.jogs(&times);
        columns.extend(jogs.iter().map(|jog| jog.values.clone()));
        let set = solved.knobs();
        let now = |knob: &Knob| set.iter().find(|set| set.name == knob.name).map(|set| set.value);
        data["live"] = json!({
            "version": self.version,
            "knobs": knobs.iter().map(|knob| json!({
                "name": knob.name, "unit": knob.unit, "value": knob.value, "formula": knob.formula,
                "whole": !knob.leads,
                "now": knob.formula.as_ref().and_then(|_| now(knob)),
                "text": knob.place.map(|place| own.sources.text(place)),
            })).collect::<Vec<_>>(),
            "cranks": solved.cranks().iter().map(|crank| json!({
                "frame": crank.body + 1, "pivot": crank.pivot, "input": crank.input,
            })).collect::<Vec<_>>(),
            "jogs": jogs.iter().map(|jog| json!({
                "name": jog.name, "unit": jog.unit, "formula": jog.formula,
            })).collect::<Vec<_>>(),
        });
        Some((data, columns))
    }
}

/// Why nothing is written onto what another hand wrote.
const OTHER: &str = "the file is another by now than the one that this page shows";

/// A byte-order mark.
const MARK: &str = "\u{feff}";

/// What is said where there is nothing to show.
fn wrong(version: u64, solved: &Solved) -> Value {
    json!({ "live": { "version": version, "wrong": solved.rendered() } })
}

/// What came of some settings, which is made unless they are those of the last time.
fn remembered(texts: &Texts, set: &[(String, String)], make: impl FnOnce() -> Option<Solved>) -> Option<Arc<Solved>> {
    if let Some((_, solved)) = lock(&texts.last).as_ref().filter(|(known, _)| known == set) {
        return Some(Arc::clone(solved));
    }
    let solved = Arc::new(make()?);
    *lock(&texts.last) = Some((set.to_vec(), Arc::clone(&solved)));
    Some(solved)
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
