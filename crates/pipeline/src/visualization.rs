//! What there is to see of a mechanism: its scene, its motion as a table, its texts. The one door to those who draw.

use crate::lowering::lowered;
use crate::options::RunOptions;
use crate::run::Run;
use crate::{Checked, Compiled};
use mechc_draw::scene::{Declaration, Faults, Joints, Length, Motion, Pose, Scene, drawn_poses};
use mechc_engine::analysis::{self, FreeMotion, Horizon, Link, LinkOf, Stop, StopCause, Times};
use mechc_ir::layout::{self, Column, ColumnKind, ColumnUnit};
use mechc_ir::{BodyId, ConstraintSystem, DeclarationId};
use mechc_lang::check::{self, Library};
use mechc_lang::model::Mechanism;
use mechc_syntax::ast;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::{FileId, Span};
use rustc_hash::FxHashMap;

/// What there is to see of a mechanism.
#[derive(Clone, Debug)]
pub struct Seen {
    /// What there is to draw, at any moment.
    pub scene: Scene,
    /// Where everything is, row by row, and the table itself (its rows), in SI; as it is drawn in the text where there is no row.
    pub motion: Motion,
    /// The names of the table's columns.
    pub columns: Vec<String>,
    /// The units in which they are printed.
    pub units: Vec<ColumnUnit>,
    /// What they hold.
    pub kinds: Vec<ColumnKind>,
    /// How many rows there would be if none had been left out.
    pub all_rows: usize,
    /// Why the motion ended before its last time, if it did.
    pub stopped: Option<Diagnostic>,
    /// What else there is to say of it: why there is no motion, or what was said beside it.
    pub said: Diagnostics,
    /// Results with the units in which they are told, in SI; none where only some times were asked for.
    pub results: Vec<(String, ColumnUnit, Option<f64>)>,
    /// The texts that its declarations stand in, its own first.
    pub texts: Vec<FileId>,
}

impl Seen {
    /// All that there is to say of it, why it ended first.
    pub fn messages(&self) -> impl Iterator<Item = &Diagnostic> {
        self.stopped.iter().chain(self.said.iter())
    }
}

/// The rows of a run, and how it ended.
struct Rows {
    kept: Vec<Vec<f64>>,
    all: usize,
    edges: Vec<f64>,
    stopped: Option<Diagnostic>,
    results: Vec<Option<f64>>,
    said: Diagnostics,
}

impl Checked {
    /// Runs it, and makes a scene of it; of more rows than `most` the motion has some, evenly spread, and the last. With what is to be said
    /// of the run. Nothing where it cannot be assembled.
    #[must_use]
    pub fn seen(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        most: usize,
    ) -> (Option<Seen>, Diagnostics) {
        self.seen_beside(compiled, times, options, most, None)
    }

    /// The same; where something was seen before it, in a picture of the extent of that one, with symbols of its size.
    #[must_use]
    pub fn seen_beside(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        most: usize,
        before: Option<&Seen>,
    ) -> (Option<Seen>, Diagnostics) {
        let Some(model) = self.model() else { return (None, Diagnostics::default()) };
        let (run, mut said) = compiled.run(times, options);
        let Some(run) = run else { return (None, said) };
        let (columns, units) = (run.columns().to_vec(), run.units().to_vec());
        let found = rows(run, most);
        said.extend(found.said);
        let motion = if found.kept.is_empty() {
            Motion::still(drawn_poses(model))
        } else {
            Motion::of_rows(&compiled.columns_of_poses(), &columns, found.kept, found.edges)
        };
        let mut scene = match before.filter(|_| !motion.rows().is_empty()) {
            Some(before) => Scene::with_symbols(model, &motion, before.scene.unit),
            None => Scene::of(model, &motion),
        };
        self.widen_places(&mut scene);
        show_stop(&mut scene, model, &motion, found.stopped.as_ref());
        if let Some(before) = before {
            scene.extent = before.scene.extent;
        }
        let values = found.results.into_iter();
        let results =
            compiled.results().into_iter().zip(values).map(|((name, unit), value)| (name, unit, value)).collect();
        let (all_rows, stopped, texts) = (found.all, found.stopped, self.texts());
        let kinds = layout::columns(compiled.system()).into_iter().map(|column| column.kind).collect();
        (
            Some(Seen { scene, motion, columns, units, kinds, all_rows, stopped, said: said.clone(), results, texts }),
            said,
        )
    }

    /// The picture at one time (s) alone, followed from another one, beside a motion that was seen before: guides and slots are as long
    /// as that one asks for, be there other values of params or not. Nothing where it does not get there.
    #[must_use]
    pub fn glimpse(
        &self,
        compiled: &Compiled,
        [from, t]: [f64; 2],
        options: &RunOptions,
        before: &Seen,
    ) -> Option<Seen> {
        let model = self.model()?;
        let (run, _) = compiled.run(&compiled.one_time(from, t), options);
        let row = run?.next()?.ok()?;
        let motion = Motion::of_rows(&compiled.columns_of_poses(), &before.columns, vec![row], Vec::new());
        if motion.frames() != before.motion.frames() {
            return None;
        }
        let mut scene = Scene::with_symbols(model, &before.motion, before.scene.unit);
        self.widen_places(&mut scene);
        scene.extent = before.scene.extent;
        let (columns, units, kinds) = (before.columns.clone(), before.units.clone(), before.kinds.clone());
        let (stopped, said, results, texts) = (None, Diagnostics::default(), Vec::new(), before.texts.clone());
        Some(Seen { scene, motion, columns, units, kinds, all_rows: 1, stopped, said, results, texts })
    }

    /// What there is to draw of a motion that was seen, with symbols of a size (m); nothing where it is not sound.
    #[must_use]
    pub fn drawn_with_symbols(&self, seen: &Seen, unit: f64) -> Option<Scene> {
        let model = self.model()?;
        Some(self.with_places(Scene::with_symbols(model, &seen.motion, unit), seen))
    }

    /// What there is to draw of a motion that was seen; nothing where it is not sound.
    pub(crate) fn drawn_anew(&self, seen: &Seen) -> Option<Scene> {
        let model = self.model()?;
        Some(self.with_places(Scene::of(model, &seen.motion), seen))
    }

    fn with_places(&self, mut scene: Scene, seen: &Seen) -> Scene {
        self.widen_places(&mut scene);
        if let Some(model) = self.model() {
            show_stop(&mut scene, model, &seen.motion, seen.stopped.as_ref());
        }
        scene
    }

    /// What there is to see of one that is sound and has no motion, for what was said of it. One that is not determined is as it is
    /// drawn in the text, with its free motions as arrows; one that cannot be assembled at a time (s) as it comes nearest to that, with
    /// its gaps. Nothing where it is not sound.
    #[must_use]
    pub fn seen_at_rest(
        &self,
        compiled: Option<&Compiled>,
        (t, options): (f64, &RunOptions),
        said: &Diagnostics,
    ) -> Option<Seen> {
        let model = self.model()?;
        let lowered = if compiled.is_none() { Some(lowered(model)) } else { None };
        let system = compiled.map(Compiled::system).or(lowered.as_ref())?;
        let nearest = compiled.and_then(|compiled| compiled.nearest(t, options));
        let joints = if nearest.is_some() { Joints::Open } else { Joints::Drawn };
        let motion = Motion::still(nearest.map_or_else(|| drawn_poses(model), |q| poses(system, &q)));
        let mut scene = Scene::of(model, &motion);
        self.widen_places(&mut scene);
        let is_left_free = said.iter().any(|said| matches!(said.code, Code::E0502 | Code::E0503));
        let free = if is_left_free {
            analysis::free_motions(system, Horizon::of_analysis(system.analysis()))
        } else {
            Vec::new()
        };
        let free = free.iter().map(of_frames).collect();
        let open = compiled.filter(|_| joints == Joints::Open).and_then(|compiled| {
            let horizon = Horizon::of_analysis(compiled.analysis()).beginning(t);
            compiled.start(horizon, options).0.err()
        });
        let lengths = open.map_or_else(Vec::new, |stop| lengths(&scene, &stop, system));
        let mut named = named(&scene, said.iter());
        // a length of the ground is a line of its own, and a declaration of its own is named
        let bodies = lengths.iter().filter_map(|length| length.frame.filter(|frame| *frame > 0));
        named.extend(bodies.filter_map(|frame| scene.frames.get(frame)));
        named.extend(lengths.iter().filter(|length| length.frame.is_none()).map(|length| length.ends[0]));
        named.sort_unstable();
        named.dedup();
        let faults = Faults { named, free, joints, lengths };
        scene.show_faults(model, &motion, &faults);
        let results = layout::results(system).into_iter().map(|(name, unit)| (name, unit, None)).collect();
        let (mut columns, mut units, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for Column { name, unit, kind } in layout::columns(system) {
            columns.push(name);
            units.push(unit);
            kinds.push(kind);
        }
        Some(Seen {
            scene,
            motion,
            columns,
            units,
            kinds,
            all_rows: 0,
            stopped: None,
            said: said.clone(),
            results,
            texts: self.texts(),
        })
    }

    /// The motion at some times alone, with why it ended before the last of them, if it did.
    #[must_use]
    pub fn moments(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
    ) -> (Option<(Motion, Option<Diagnostic>)>, Diagnostics) {
        let (run, mut said) = compiled.run(times, options);
        let Some(run) = run else { return (None, said) };
        let columns = run.columns().to_vec();
        let found = rows(run, usize::MAX);
        said.extend(found.said);
        let motion = Motion::of_rows(&compiled.columns_of_poses(), &columns, found.kept, found.edges);
        (Some((motion, found.stopped)), said)
    }

    /// Declarations have the places of their names; here they get those of all that is written of them.
    fn widen_places(&self, scene: &mut Scene) {
        let whole = whole_places(self.library());
        for declaration in &mut scene.declarations {
            if let Some(span) = whole.get(&declaration.span) {
                declaration.span = *span;
            }
        }
        let ground = self.tree().and_then(|tree| {
            tree.items.iter().find(|item| matches!(item.kind, ast::ItemKind::Ground { .. })).map(|item| item.span)
        });
        if let (Some(span), Some(declaration)) = (ground, scene.declarations.first_mut()) {
            declaration.span = span;
        }
    }

    fn texts(&self) -> Vec<FileId> {
        let mut texts = vec![self.file()];
        texts.extend(self.library().files().iter().map(|file| file.id).filter(|id| *id != self.file()));
        texts
    }
}

/// Runs to the end, or to where it stops.
fn rows(mut run: Run, most: usize) -> Rows {
    run.keep_edges();
    let count = usize::try_from(run.times().len()).unwrap_or(usize::MAX);
    let most = most.max(2);
    let every = if count > most { (count - 1).div_ceil(most - 1) } else { 1 };
    let (mut rows, mut all, mut stopped) = (Vec::new(), 0, None);
    let mut last: Vec<f64> = Vec::new();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) if all % every == 0 => {
                rows.push(row.to_vec());
                last.clear();
            }
            Ok(row) => {
                last.clear();
                last.extend_from_slice(row);
            }
            Err(why) => {
                stopped = Some(*why);
                break;
            }
        }
        all += 1;
    }
    if !last.is_empty() {
        rows.push(last);
    }
    let answers = run.results().unwrap_or_default();
    let mut said = run.take_remarks();
    said.extend(answers.notes);
    let (first, end) = (rows.first().map_or(0.0, |row| row[0]), rows.last().map_or(0.0, |row| row[0]));
    let edges = run.edges().into_iter().filter(|edge| first < *edge && *edge < end).collect();
    Rows { kept: rows, all, edges, stopped, results: answers.values, said }
}

/// Where frames are by the coordinates [m, rad], the ground first.
fn poses(system: &ConstraintSystem, q: &[f64]) -> Vec<Pose> {
    let of_body = |body: BodyId| {
        let [x, y, phi] = system.pose_of(body).map(|coordinate| q[coordinate]);
        Pose { at: [x, y], phi }
    };
    std::iter::once(Pose::default()).chain(system.bodies().ids().map(of_body)).collect()
}

/// A free motion as one of frames, of which the ground is the first.
fn of_frames(motion: &FreeMotion) -> Vec<(usize, Pose)> {
    let of_body = |&(body, [x, y, phi]): &(BodyId, [f64; 3])| (body.index() + 1, Pose { at: [x, y], phi });
    motion.bodies.iter().map(of_body).collect()
}

/// Shows what is named by the message of a motion that stops.
fn show_stop(scene: &mut Scene, model: &Mechanism, motion: &Motion, stopped: Option<&Diagnostic>) {
    if let Some(why) = stopped {
        let faults = Faults { named: named(scene, std::iter::once(why)), ..Faults::default() };
        scene.show_faults(model, motion, &faults);
    }
}

/// Returns the lengths that are too short or too long for a loop to close.
fn lengths(scene: &Scene, stop: &Stop, system: &ConstraintSystem) -> Vec<Length> {
    match &stop.cause {
        StopCause::OpenLoop(open) if !open.is_unreachable(system) => {
            open.links.iter().filter_map(|link| faulty_length(scene, link, system)).collect()
        }
        _ => Vec::new(),
    }
}

fn faulty_length(scene: &Scene, link: &Link, system: &ConstraintSystem) -> Option<Length> {
    let declaration = |id: DeclarationId| {
        let name = &system.declarations()[id].name;
        let is_it = |one: &Declaration| matches!(one.kind, "joint" | "constraint" | "driver") && one.name == *name;
        scene.declarations.iter().position(is_it)
    };
    let fault = if link.too_short { "too short" } else { "too long" };
    let text = format!("{}: {fault}", analysis::length_in_words(link.length));
    match link.of {
        LinkOf::Body(body, [from, to]) => {
            let name = body.map_or("ground", |body| &system.bodies()[body].name);
            let frame = scene.frames.iter().position(|declaration| scene.declarations[*declaration].name == name)?;
            Some(Length { frame: Some(frame), ends: [declaration(from)?, declaration(to)?], text })
        }
        LinkOf::Declaration(id) => Some(Length { frame: None, ends: [declaration(id)?; 2], text }),
    }
}

/// The declarations that errors name: those that they call redundant, else those that their places are in.
fn named<'d>(scene: &Scene, said: impl Iterator<Item = &'d Diagnostic>) -> Vec<usize> {
    let mut named: Vec<usize> = Vec::new();
    for error in said.filter(|said| said.is_error()) {
        let redundant = Some(&error.redundant).filter(|names| !names.is_empty());
        match redundant {
            Some(names) => {
                let is_redundant = |name: &String| names.contains(name);
                let all = scene.declarations.iter().enumerate();
                named.extend(all.filter(|(_, one)| is_redundant(&one.name)).map(|(number, _)| number));
            }
            None => error.labels.iter().for_each(|label| named.extend(innermost(scene, label.span, error))),
        }
    }
    named.sort_unstable();
    named.dedup();
    named
}

/// The smallest declarations around a place; of copies of one text those whose names a message tells, if it tells any.
fn innermost(scene: &Scene, place: Span, told: &Diagnostic) -> Vec<usize> {
    let holds = |span: Span| span.file == place.file && span.start <= place.start && place.end <= span.end;
    let around = || scene.declarations.iter().enumerate().filter(|(_, one)| holds(one.span));
    let size = |span: Span| span.end - span.start;
    let Some(least) = around().map(|(_, one)| size(one.span)).min() else { return Vec::new() };
    let copies: Vec<usize> = around().filter(|(_, one)| size(one.span) == least).map(|(number, _)| number).collect();
    let texts = || std::iter::once(&told.message).chain(&told.notes).chain(told.labels.iter().map(|label| &label.text));
    let has_given_inputs = |number: &usize| {
        let name = format!("`{}`", scene.declarations[*number].name);
        texts().any(|text| text.contains(&name))
    };
    let told: Vec<usize> = copies.iter().copied().filter(has_given_inputs).collect();
    if told.is_empty() { copies } else { told }
}

/// The places of declarations, by those of their names.
fn whole_places(library: &Library) -> FxHashMap<Span, Span> {
    let mechanisms = library.files().iter().flat_map(|file| &file.read.tree.mechanisms);
    let mut places = FxHashMap::default();
    for item in mechanisms.flat_map(|mechanism| &mechanism.items) {
        if let Some(name) = check::name_of(item) {
            places.insert(name.span, item.span);
        }
        if let ast::ItemKind::Ground { features } | ast::ItemKind::Body { features, .. } = &item.kind {
            places.extend(features.iter().map(|feature| (feature.name.span, feature.span)));
        }
    }
    places
}
