//! The texts as of now, and what pages ask of them.

use super::answer::framed;
use super::asked::{Jogged, Question, Write};
use super::edit::{Edited, edited};
use super::host::Host;
use super::page;
use super::shelf::Shelf;
use super::solved::{Solved, Solver};
use mechc_pipeline::{Choice, Knob, Parsed, Redundant, size_of_unit};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use mechc_text::source::{Sources, Span};
use mechc_text::world::World;
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Who waits for the file's motion looks so often whether it is still wanted.
const LOOK: Duration = Duration::from_millis(20);
/// The stack of what solves it.
const STACK: usize = 8 << 20;
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
    file: Option<String>,
}

/// Params with what they are set to.
type Settings = Vec<(String, String)>;

/// What pages are told without asking.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct News {
    /// Of the texts.
    pub version: u64,
    /// Where an editor's cursor is (UTF-16), if there is one,
    pub at: Option<u32>,
    /// and in which file, by the name that it has in messages; nothing for the page's own.
    pub file: Option<String>,
}

impl News {
    /// As a page is told them.
    #[must_use]
    pub fn told(&self) -> Value {
        json!({ "version": self.version, "at": self.at, "file": self.file })
    }
}

/// The texts of a version, and what has been made of them.
struct Texts {
    version: u64,
    shelf: Shelf,
    parsed: Result<Parsed, (Sources, Diagnostics)>,
    /// Ends what is made of them, once there are others.
    cancel: Cancel,
    own: Mutex<Own>,
    is_made: Condvar,
    /// What was looked at of the versions before, as long as it is not known what is of this one.
    before: Vec<PathBuf>,
    /// The settings that were asked for last, with what came of them.
    last: Mutex<Option<(Settings, Arc<Solved>)>>,
}

/// A file as it is, which is made once for all pages: as long as one of them waits for it.
#[derive(Default)]
struct Own {
    made: Option<Arc<Solved>>,
    /// Ends its making.
    making: Option<Cancel>,
    waiting: usize,
}

/// How waiting for it ends.
enum Waited {
    Made(Arc<Solved>),
    /// Nobody waited for it.
    GivenUp,
    /// Who waited does not any more.
    Left,
}

impl Texts {
    fn read(version: u64, world: Arc<dyn World>, path: &Path, before: Vec<PathBuf>) -> Texts {
        let shelf = Shelf::new(world);
        let parsed = Parsed::read(path, &shelf);
        let (cancel, own, is_made, last) = Default::default();
        Texts { version, shelf, parsed, cancel, own, is_made, before, last }
    }

    /// The files that are looked at, as far as they are known.
    fn files(&self) -> Vec<PathBuf> {
        let mut files = self.shelf.files();
        if lock(&self.own).made.is_none() {
            files.extend(self.before.iter().filter(|file| !files.contains(file)).cloned().collect::<Vec<_>>());
        }
        files
    }

    /// Waits until the file as it is has been made, or its making has ended.
    fn waited(&self, cancel: &Cancel) -> Waited {
        let mut own = lock(&self.own);
        loop {
            let is_over = cancel.is_cancelled() || self.cancel.is_cancelled();
            if own.making.is_none() || is_over {
                own.waiting -= 1;
                if let Some(work) = own.making.as_ref().filter(|_| own.waiting == 0) {
                    work.cancel();
                }
                return match &own.made {
                    _ if is_over => Waited::Left,
                    Some(made) => Waited::Made(Arc::clone(made)),
                    None => Waited::GivenUp,
                };
            }
            own = self.is_made.wait_timeout(own, LOOK).map_or_else(|error| error.into_inner().0, |(own, _)| own);
        }
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
        let texts = Arc::new(Texts::read(1, host.world(), path, Vec::new()));
        Workshop {
            path: path.to_owned(),
            choice,
            redundant,
            pass_bifurcations,
            host,
            now: Mutex::new(Now { texts, at: None, file: None }),
            has_changed: Condvar::new(),
            looking: Mutex::default(),
            waiting: Mutex::default(),
        }
    }

    /// The files that it has looked at, and where some were missing.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = self.texts().files();
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
        let texts = Texts::read(before.version + 1, self.host.world(), &self.path, before.files());
        lock(&self.now).texts = Arc::new(texts);
        // of what was asked of the text before nobody wants to know any more
        for (_, cancel) in lock(&self.waiting).drain() {
            cancel.cancel();
        }
        self.has_changed.notify_all();
        true
    }

    /// Tells all pages where an editor's cursor is in a file (UTF-16). One that is not looked at has no place in the page.
    pub fn point(&self, path: &Path, at: u32) {
        let world = self.host.world();
        let is_it = |file: &Path| file == path || world.identity(file) == world.identity(path);
        let place = if is_it(&self.path) {
            (Some(at), None)
        } else {
            let used = self.files().into_iter().find(|file| is_it(file));
            (used.as_ref().map(|_| at), used.map(|file| world.shown(&file)))
        };
        let mut now = lock(&self.now);
        if (now.at, &now.file) != (place.0, &place.1) {
            (now.at, now.file) = place;
            self.has_changed.notify_all();
        }
    }

    /// What is new to who was told that before; nothing if that takes too long.
    #[must_use]
    pub fn news(&self, told: Option<&News>, at_most: Duration) -> Option<News> {
        let news = |now: &Now| News { version: now.texts.version, at: now.at, file: now.file.clone() };
        let is_old = |now: &mut Now| Some(&news(now)) == told;
        let waited = self.has_changed.wait_timeout_while(lock(&self.now), at_most, is_old);
        let (now, time) = waited.unwrap_or_else(PoisonError::into_inner);
        (!time.timed_out()).then(|| news(&now))
    }

    /// Shows a place of the file (UTF-16) in the editor.
    pub fn show(&self, at: u32) {
        self.host.show(at);
    }

    /// Answers a page, as long as it waits. What it had asked before and is waiting for is given up.
    #[must_use]
    pub fn answer(&self, asked: &Question, cancel: &Cancel) -> Vec<u8> {
        self.take_place(&asked.page, cancel);
        let texts = self.texts();
        let (answer, columns) = self.answered(&texts, asked, cancel).unwrap_or_else(|| {
            // the page will ask again, or has
            (json!({ "live": { "version": texts.version, "superseded": true } }), Vec::new())
        });
        framed(&answer, &columns)
    }

    fn answered(&self, texts: &Texts, asked: &Question, cancel: &Cancel) -> Option<Answer> {
        let own = self.own(texts, cancel)?;
        if !own.is_sound() {
            return Some((json!({ "live": wrong(texts.version, &own) }), Vec::new()));
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
        let own = self.own(&texts, &Cancel::default()).ok_or_else(|| refused(OTHER))?;
        let checked = own.checked.as_ref().filter(|_| own.is_sound()).ok_or_else(|| refused("the text is wrong"))?;
        let text = match edited(checked, write) {
            Edited::Text(text) => text,
            other => return Err(other),
        };
        let parsed = texts.parsed.as_ref().map_err(|_| refused(OTHER))?;
        let then = parsed.edited(&text).check(&self.choice, &texts.shelf);
        if let Some(wrong) = then.diagnostics().iter().find(|said| said.is_error()) {
            return Err(refused(&format!("the text would be wrong with that: {}", wrong.message)));
        }
        let has_mark = texts.shelf.read(&self.path).is_ok_and(|file| file.bytes.starts_with(MARK.as_bytes()));
        let text = if has_mark { format!("{MARK}{text}") } else { text };
        if texts.shelf.is_old(&*self.host.world()) {
            return Err(refused(OTHER));
        }
        // and once more when all is done but to put it in its place
        let is_due = || !texts.shelf.is_other(&self.path, &*self.host.world());
        let is_written = self.host.write(&text, &is_due).map_err(Edited::Refused)?;
        self.look();
        if is_written { Ok(()) } else { Err(refused(OTHER)) }
    }

    /// The file as it is; nothing if there is another one, or who asks is gone.
    fn own(&self, texts: &Texts, cancel: &Cancel) -> Option<Arc<Solved>> {
        loop {
            let work = {
                let mut own = lock(&texts.own);
                if let Some(made) = &own.made {
                    return (!texts.cancel.is_cancelled()).then(|| Arc::clone(made));
                }
                own.waiting += 1;
                let is_making = own.making.is_some();
                let work = own.making.get_or_insert_with(Cancel::default);
                (!is_making).then(|| work.clone())
            };
            let waited = thread::scope(|scope| {
                if let Some(work) = work {
                    let make = move || self.make(texts, &work);
                    let maker = thread::Builder::new().name("live solve".to_owned()).stack_size(STACK);
                    // a machine without room for a thread is one on which nobody waits
                    if maker.spawn_scoped(scope, make).is_err() {
                        lock(&texts.own).making = None;
                    }
                }
                texts.waited(cancel)
            });
            match waited {
                Waited::Made(made) => return Some(made),
                Waited::Left => return None,
                // it was another one's, while this one came
                Waited::GivenUp => {}
            }
        }
    }

    /// Makes the file as it is, unless nobody waits for it any more.
    fn make(&self, texts: &Texts, work: &Cancel) {
        let solver = self.solver(texts);
        let made = solver.own(work);
        solver.watched(&made, None, work);
        let mut own = lock(&texts.own);
        own.made = (!work.is_cancelled()).then(|| Arc::new(made));
        own.making = None;
        drop(own);
        texts.is_made.notify_all();
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

    /// An answer to a page begins; ends the one before.
    fn take_place(&self, page: &str, cancel: &Cancel) {
        let mut waiting = lock(&self.waiting);
        if waiting.len() >= MOST_PAGES {
            waiting.clear();
        }
        if let Some(before) = waiting.insert(page.to_owned(), cancel.clone()) {
            before.cancel();
        }
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
            let mut live = wrong(self.version, solved);
            if !Arc::ptr_eq(own, solved) {
                // the text is right
                live["knobs"] = self.told(knobs);
            }
            return Some((json!({ "live": live }), Vec::new()));
        };
        let (mut data, mut columns) = page::of_one(seen, &solved.sources).data();
        let times: Vec<f64> = seen.motion.rows().iter().map(|row| row[0]).collect();
        let jogs = solved.jogs(&times);
        columns.extend(jogs.iter().map(|jog| jog.values.clone()));
        data["live"] = json!({
            "version": self.version,
            "knobs": self.told(knobs),
            "cranks": solved.cranks().iter().map(|crank| json!({
                "frame": crank.body + 1, "pivot": crank.pivot,
                "input": crank.input.as_ref().map(|led| &led.name), "rate": crank.input.as_ref().map(|led| led.rate),
            })).collect::<Vec<_>>(),
            "jogs": jogs.iter().map(|jog| json!({
                "name": jog.name, "unit": jog.written, "formula": jog.formula,
                "si": size_of_unit(&jog.written), "dimension": jog.dimension,
            })).collect::<Vec<_>>(),
        });
        Some((data, columns))
    }

    /// What there is to set.
    fn told(&self, knobs: &[Knob]) -> Value {
        let sources = &self.own.sources;
        let set = self.solved.knobs();
        let set: FxHashMap<&str, f64> = set.iter().map(|knob| (knob.name.as_str(), knob.value)).collect();
        let now = |knob: &Knob| set.get(knob.name.as_str()).filter(|_| knob.formula.is_some() || knob.of.is_some());
        let mut sizes: FxHashMap<&str, f64> = FxHashMap::default();
        let is_here = |place: &Span| self.own.checked.as_ref().is_some_and(|own| own.file() == place.file);
        let told = knobs.iter().map(|knob| {
            let place = |span: Span| {
                let file = sources.get(span.file);
                format!("{}:{}", file.name, file.position(span.start).0)
            };
            json!({
                "name": knob.name, "unit": knob.unit, "value": knob.value, "formula": knob.formula,
                "si": sizes.entry(&knob.unit).or_insert_with(|| size_of_unit(&knob.unit)),
                "dimension": knob.dimension, "held": self.solver.held(&knob.name), "whole": !knob.leads,
                "now": now(knob),
                "of": knob.of,
                "text": knob.place.filter(is_here).map(|place| sources.text(place)),
                "where": knob.stands.filter(|_| knob.place.is_none_or(|place| !is_here(&place))).map(place),
            })
        });
        Value::Array(told.collect())
    }
}

/// Why nothing is written onto what another hand wrote.
const OTHER: &str = "the file is another by now than the one that this page shows";

/// A byte-order mark.
const MARK: &str = "\u{feff}";

/// What is said where there is nothing to show.
fn wrong(version: u64, solved: &Solved) -> Value {
    json!({ "version": version, "wrong": solved.rendered() })
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

#[cfg(test)]
mod tests {
    use super::{Question, Workshop, Write};
    use crate::asked::Change;
    use crate::host::Host;
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
    struct Desk {
        files: Mutex<Memory>,
        /// What another hand writes while a text is about to be put in its place.
        beside: Mutex<Option<Memory>>,
        written: Mutex<Vec<String>>,
    }

    impl World for Desk {
        fn read(&self, path: &Path) -> io::Result<Contents> {
            self.files.lock().expect("a lock").read(path)
        }
    }

    struct Held(Arc<Desk>);

    impl Host for Held {
        fn world(&self) -> Arc<dyn World> {
            Arc::clone(&self.0) as Arc<dyn World>
        }

        fn times(&self, compiled: &Compiled, _: &mut Sources) -> Result<Times, Diagnostics> {
            compiled.times().ok_or_else(Diagnostics::default)
        }

        fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
            if let Some(files) = self.0.beside.lock().expect("a lock").take() {
                *self.0.files.lock().expect("a lock") = files;
            }
            let is_due = is_due();
            if is_due {
                self.0.written.lock().expect("a lock").push(text.to_owned());
            }
            Ok(is_due)
        }
    }

    fn workshop() -> (Arc<Desk>, Workshop) {
        let desk = Arc::new(Desk::default());
        desk.has(MAIN);
        let options = (Redundant::Refused, false);
        let made = Workshop::new(Path::new("disc.mech"), Choice::default(), options, Box::new(Held(Arc::clone(&desk))));
        (desk, made)
    }

    impl Desk {
        fn has(&self, main: &str) {
            *self.files.lock().expect("a lock") = files(main);
        }
    }

    fn files(main: &str) -> Memory {
        Memory::default().with("disc.mech", main).with("lib/arm.mech", ARM)
    }

    #[test]
    fn what_was_looked_at_is_looked_at_until_it_is_known_what_is() {
        let (desk, workshop) = workshop();
        let used = PathBuf::from("lib/arm.mech");
        let ask = || workshop.answer(&Question { page: "a".to_owned(), ..Question::default() }, &Cancel::default());
        assert!(String::from_utf8_lossy(&ask()).contains("one.bar.phi"));
        assert!(workshop.files().contains(&used));
        for round in 0..2 {
            desk.has(&format!("{MAIN}// {round}"));
            assert!(workshop.look());
            assert!(workshop.files().contains(&used), "nobody has asked for the new version yet");
        }
        desk.has(&MAIN.replace("use", "// use"));
        assert!(workshop.look());
        ask();
        assert_eq!(workshop.files(), [PathBuf::from("disc.mech")]);
    }

    #[test]
    fn a_save_that_comes_as_late_as_can_be_is_not_overwritten() {
        let (desk, workshop) = workshop();
        let change = Change { name: "speed".to_owned(), old: "1 rad/s".to_owned(), value: 2.0 };
        let write = |version| Write { version, changes: vec![change.clone()], sure: false };
        *desk.beside.lock().expect("a lock") = Some(files(&format!("{MAIN}// another hand")));
        let told = workshop.write(&write(1)).to_string();
        assert!(told.contains("another by now"), "{told}");
        assert!(desk.written.lock().expect("a lock").is_empty());
        let told = workshop.write(&write(2)).to_string();
        assert!(told.contains("written\":true"), "{told}");
        let wanted = MAIN.replace("1 rad/s", "2 rad/s") + "// another hand";
        assert_eq!(*desk.written.lock().expect("a lock"), [wanted]);
    }

    #[test]
    fn who_is_gone_gets_nothing_and_the_next_one_all() {
        let (_, workshop) = workshop();
        let gone = Cancel::default();
        gone.cancel();
        let question = Question { page: "a".to_owned(), ..Question::default() };
        let told = workshop.answer(&question, &gone);
        assert!(String::from_utf8_lossy(&told).contains("superseded"));
        let told = workshop.answer(&question, &Cancel::default());
        assert!(String::from_utf8_lossy(&told).contains("one.bar.phi"));
    }
}
