//! Visualizations of a mechanism: its scene, its motion as a table, its diagnostics. The only source of what is drawn.

use crate::options::RunOptions;
use crate::run::Run;
use crate::{Checked, Compiled};
use mechc_draw::scene::{Declaration, Faults, Joints, Length, Motion, Pose, Scene, drawn_poses};
use mechc_engine::analysis::{self, FaultyLink, FaultyLinkKind, FreeMotion, Horizon, Stop, StopCause, Times};
use mechc_ir::layout::{self, Column, ColumnKind, ColumnUnit};
use mechc_ir::{BodyId, ConstraintSystem, DeclarationId};
use mechc_lang::check::{self, Library};
use mechc_lang::model::Mechanism;
use mechc_syntax::ast;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::{FileId, Span};
use rustc_hash::FxHashMap;

/// All that can be drawn and plotted of a mechanism.
#[derive(Clone, Debug)]
pub struct Visualization {
    /// The scene, at any moment.
    pub scene: Scene,
    /// Poses and rows (SI) of the motion; the poses of the text if there is no row.
    pub motion: Motion,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Units in which the columns are printed.
    pub units: Vec<ColumnUnit>,
    /// Kinds of the columns.
    pub kinds: Vec<ColumnKind>,
    /// Number of rows before some were left out.
    pub all_rows: usize,
    /// Why the motion stopped before its last time, if it did.
    pub stopped: Option<Diagnostic>,
    /// Other diagnostics: why there is no motion, or warnings of it.
    pub diagnostics: Diagnostics,
    /// Name, printed unit and value (SI) of each result; empty if only some times were requested.
    pub results: Vec<(String, ColumnUnit, Option<f64>)>,
    /// The texts of its declarations, its own first.
    pub texts: Vec<FileId>,
}

impl Visualization {
    /// Returns all diagnostics, the reason why the motion stopped first.
    pub fn messages(&self) -> impl Iterator<Item = &Diagnostic> {
        self.stopped.iter().chain(self.diagnostics.iter())
    }
}

/// The rows of a run, and its end.
struct Rows {
    kept: Vec<Vec<f64>>,
    all: usize,
    edges: Vec<f64>,
    stopped: Option<Diagnostic>,
    results: Vec<Option<f64>>,
    diagnostics: Diagnostics,
}

impl Checked {
    /// Runs the mechanism and draws it. A motion of more rows than `most` keeps some, evenly spread, and the last. Returns the diagnostics of the
    /// run, too; `None` if the mechanism cannot be assembled.
    #[must_use]
    pub fn visualize(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        most: usize,
    ) -> (Option<Visualization>, Diagnostics) {
        self.visualization_like(compiled, times, options, most, None)
    }

    /// Runs the mechanism and draws it with the extent and the symbol size of a visualization before it, if there was one.
    #[must_use]
    pub fn visualization_like(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        most: usize,
        before: Option<&Visualization>,
    ) -> (Option<Visualization>, Diagnostics) {
        let Some(model) = self.model() else { return (None, Diagnostics::default()) };
        let (run, mut diagnostics) = compiled.run(times, options);
        let Some(run) = run else { return (None, diagnostics) };
        let (columns, units) = (run.columns().to_vec(), run.units().to_vec());
        let run_rows = rows(run, most);
        diagnostics.extend(run_rows.diagnostics);
        let motion = if run_rows.kept.is_empty() {
            Motion::still(drawn_poses(model))
        } else {
            Motion::of_rows(&compiled.columns_of_poses(), &columns, run_rows.kept, run_rows.edges)
        };
        let mut scene = match before.filter(|_| !motion.rows().is_empty()) {
            Some(before) => Scene::with_symbol_size(model, &motion, before.scene.unit),
            None => Scene::of(model, &motion),
        };
        self.widen_spans(&mut scene);
        highlight_stop(&mut scene, model, &motion, run_rows.stopped.as_ref());
        if let Some(before) = before {
            scene.extent = before.scene.extent;
        }
        let values = run_rows.results.into_iter();
        let results =
            compiled.results().into_iter().zip(values).map(|((name, unit), value)| (name, unit, value)).collect();
        let (all_rows, stopped, texts) = (run_rows.all, run_rows.stopped, self.texts());
        let kinds = layout::columns(compiled.system()).into_iter().map(|column| column.kind).collect();
        let said = diagnostics.clone();
        (
            Some(Visualization {
                scene,
                motion,
                columns,
                units,
                kinds,
                all_rows,
                stopped,
                diagnostics: said,
                results,
                texts,
            }),
            diagnostics,
        )
    }

    /// Draws a single time `t` (s) of a motion that is followed from the time `from`, with guides and slots as long as in the visualization
    /// `before`, which may have other params. `None` if the motion does not get there.
    #[must_use]
    pub fn visualize_at(
        &self,
        compiled: &Compiled,
        [from, t]: [f64; 2],
        options: &RunOptions,
        before: &Visualization,
    ) -> Option<Visualization> {
        let model = self.model()?;
        let (run, _) = compiled.run(&compiled.one_time(from, t), options);
        let row = run?.next()?.ok()?;
        let motion = Motion::of_rows(&compiled.columns_of_poses(), &before.columns, vec![row], Vec::new());
        if motion.frames() != before.motion.frames() {
            return None;
        }
        let mut scene = Scene::with_symbol_size(model, &before.motion, before.scene.unit);
        self.widen_spans(&mut scene);
        scene.extent = before.scene.extent;
        let (columns, units, kinds) = (before.columns.clone(), before.units.clone(), before.kinds.clone());
        let (stopped, diagnostics, results, texts) = (None, Diagnostics::default(), Vec::new(), before.texts.clone());
        Some(Visualization { scene, motion, columns, units, kinds, all_rows: 1, stopped, diagnostics, results, texts })
    }

    /// Draws the motion of a visualization anew, with symbols of a size (m); `None` if the mechanism has errors.
    #[must_use]
    pub fn scene_with_symbols(&self, seen: &Visualization, unit: f64) -> Option<Scene> {
        let model = self.model()?;
        Some(self.finished(Scene::with_symbol_size(model, &seen.motion, unit), seen))
    }

    /// Draws the motion of a visualization anew; `None` if the mechanism has errors.
    pub(crate) fn redrawn(&self, seen: &Visualization) -> Option<Scene> {
        let model = self.model()?;
        Some(self.finished(Scene::of(model, &seen.motion), seen))
    }

    fn finished(&self, mut scene: Scene, seen: &Visualization) -> Scene {
        self.widen_spans(&mut scene);
        if let Some(model) = self.model() {
            highlight_stop(&mut scene, model, &seen.motion, seen.stopped.as_ref());
        }
        scene
    }

    /// Draws a mechanism without motion, with its diagnostics. If it is not determined, it has the poses of the text and its free motions as
    /// arrows. If it cannot be assembled at a time (s), it is as near to that as it gets, with gaps. `None` if it has errors.
    #[must_use]
    pub fn static_visualization(
        &self,
        compiled: Option<&Compiled>,
        (t, options): (f64, &RunOptions),
        diagnostics: &Diagnostics,
    ) -> Option<Visualization> {
        let model = self.model()?;
        let lowered = if compiled.is_none() { self.lowered() } else { None };
        let system = compiled.map(Compiled::system).or(lowered.as_ref())?;
        let nearest = compiled.and_then(|compiled| compiled.nearest(t, options));
        let joints = if nearest.is_some() { Joints::Open } else { Joints::Drawn };
        let motion = Motion::still(nearest.map_or_else(|| drawn_poses(model), |q| poses(system, &q)));
        let mut scene = Scene::of(model, &motion);
        self.widen_spans(&mut scene);
        let is_left_free = diagnostics.iter().any(|diagnostic| matches!(diagnostic.code, Code::E0502 | Code::E0503));
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
        let mut named = named_declarations(&scene, diagnostics.iter());
        // a length of the ground is a line of its own, and its declaration is highlighted
        let bodies = lengths.iter().filter_map(|length| length.frame.filter(|frame| *frame > 0));
        named.extend(bodies.filter_map(|frame| scene.frames.get(frame)));
        named.extend(lengths.iter().filter(|length| length.frame.is_none()).map(|length| length.ends[0]));
        named.sort_unstable();
        named.dedup();
        let faults = Faults { named, free, joints, lengths };
        scene.add_fault_marks(model, &motion, &faults);
        let results = layout::results(system).into_iter().map(|(name, unit)| (name, unit, None)).collect();
        let (mut columns, mut units, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for Column { name, unit, kind } in layout::columns(system) {
            columns.push(name);
            units.push(unit);
            kinds.push(kind);
        }
        Some(Visualization {
            scene,
            motion,
            columns,
            units,
            kinds,
            all_rows: 0,
            stopped: None,
            diagnostics: diagnostics.clone(),
            results,
            texts: self.texts(),
        })
    }

    /// Returns the motion at some times, and why it stopped before the last of them, if it did.
    #[must_use]
    pub fn moments(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
    ) -> (Option<(Motion, Option<Diagnostic>)>, Diagnostics) {
        let (run, mut diagnostics) = compiled.run(times, options);
        let Some(run) = run else { return (None, diagnostics) };
        let columns = run.columns().to_vec();
        let run_rows = rows(run, usize::MAX);
        diagnostics.extend(run_rows.diagnostics);
        let motion = Motion::of_rows(&compiled.columns_of_poses(), &columns, run_rows.kept, run_rows.edges);
        (Some((motion, run_rows.stopped)), diagnostics)
    }

    /// Replaces the spans of declarations, which are those of their names, by those of the whole declarations.
    fn widen_spans(&self, scene: &mut Scene) {
        let whole = declaration_spans(self.library());
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

/// Runs to the end, or to where the motion stops.
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
                stopped = why.diagnostics.into_iter().next();
                break;
            }
        }
        all += 1;
    }
    if !last.is_empty() {
        rows.push(last);
    }
    let answers = run.results().unwrap_or_default();
    let mut diagnostics = run.take_warnings();
    diagnostics.extend(answers.notes);
    let (first, end) = (rows.first().map_or(0.0, |row| row[0]), rows.last().map_or(0.0, |row| row[0]));
    let edges = run.edges().into_iter().filter(|edge| first < *edge && *edge < end).collect();
    Rows { kept: rows, all, edges, stopped, results: answers.values, diagnostics }
}

/// Returns the poses of frames for coordinates [m, rad], the ground first.
fn poses(system: &ConstraintSystem, q: &[f64]) -> Vec<Pose> {
    let of_body = |body: BodyId| {
        let [x, y, phi] = system.pose_of(body).map(|coordinate| q[coordinate]);
        Pose { at: [x, y], phi }
    };
    std::iter::once(Pose::default()).chain(system.bodies().ids().map(of_body)).collect()
}

/// Returns a free motion by frames, of which the ground is the first.
fn of_frames(motion: &FreeMotion) -> Vec<(usize, Pose)> {
    let of_body = |&(body, [x, y, phi]): &(BodyId, [f64; 3])| (body.index() + 1, Pose { at: [x, y], phi });
    motion.bodies.iter().map(of_body).collect()
}

/// Highlights the declarations in the diagnostic of a motion that stops.
fn highlight_stop(scene: &mut Scene, model: &Mechanism, motion: &Motion, stopped: Option<&Diagnostic>) {
    if let Some(why) = stopped {
        let faults = Faults { named: named_declarations(scene, std::iter::once(why)), ..Faults::default() };
        scene.add_fault_marks(model, motion, &faults);
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

fn faulty_length(scene: &Scene, link: &FaultyLink, system: &ConstraintSystem) -> Option<Length> {
    let declaration = |id: DeclarationId| {
        let name = &system.declarations()[id].name;
        let is_it =
            |other: &Declaration| matches!(other.kind, "joint" | "constraint" | "driver") && other.name == *name;
        scene.declarations.iter().position(is_it)
    };
    let fault = if link.too_short { "too short" } else { "too long" };
    let text = format!("{}: {fault}", analysis::length_in_words(link.length));
    match link.of {
        FaultyLinkKind::Body(body, [from, to]) => {
            let name = body.map_or("ground", |body| &system.bodies()[body].name);
            let frame = scene.frames.iter().position(|declaration| scene.declarations[*declaration].name == name)?;
            Some(Length { frame: Some(frame), ends: [declaration(from)?, declaration(to)?], text })
        }
        FaultyLinkKind::Declaration(id) => Some(Length { frame: None, ends: [declaration(id)?; 2], text }),
    }
}

/// Returns the declarations that errors call redundant, or else those around their spans.
fn named_declarations<'d>(scene: &Scene, diagnostics: impl Iterator<Item = &'d Diagnostic>) -> Vec<usize> {
    let mut named: Vec<usize> = Vec::new();
    for error in diagnostics.filter(|diagnostic| diagnostic.is_error()) {
        let redundant = Some(&error.redundant).filter(|names| !names.is_empty());
        match redundant {
            Some(names) => {
                let is_redundant = |name: &String| names.contains(name);
                let all = scene.declarations.iter().enumerate();
                named.extend(all.filter(|(_, declaration)| is_redundant(&declaration.name)).map(|(index, _)| index));
            }
            None => error.labels.iter().for_each(|label| named.extend(innermost(scene, label.span, error))),
        }
    }
    named.sort_unstable();
    named.dedup();
    named
}

/// Returns the smallest declarations around a span; of copies of one text those that the diagnostic names, if it names any.
fn innermost(scene: &Scene, inner: Span, diagnostic: &Diagnostic) -> Vec<usize> {
    let holds = |span: Span| span.file == inner.file && span.start <= inner.start && inner.end <= span.end;
    let around = || scene.declarations.iter().enumerate().filter(|(_, declaration)| holds(declaration.span));
    let size = |span: Span| span.end - span.start;
    let Some(least) = around().map(|(_, declaration)| size(declaration.span)).min() else { return Vec::new() };
    let copies: Vec<usize> =
        around().filter(|(_, declaration)| size(declaration.span) == least).map(|(index, _)| index).collect();
    let texts = || {
        std::iter::once(&diagnostic.message)
            .chain(&diagnostic.notes)
            .chain(diagnostic.labels.iter().map(|label| &label.text))
    };
    let is_named = |index: &usize| {
        let name = format!("`{}`", scene.declarations[*index].name);
        texts().any(|text| text.contains(&name))
    };
    let named: Vec<usize> = copies.iter().copied().filter(is_named).collect();
    if named.is_empty() { copies } else { named }
}

/// Returns the span of each declaration, by the span of its name.
fn declaration_spans(library: &Library) -> FxHashMap<Span, Span> {
    let mechanisms = library.files().iter().flat_map(|file| &file.read.tree.mechanisms);
    let mut spans = FxHashMap::default();
    for item in mechanisms.flat_map(|mechanism| &mechanism.items) {
        if let Some(name) = check::name_of(item) {
            spans.insert(name.span, item.span);
        }
        if let ast::ItemKind::Ground { features } | ast::ItemKind::Body { features, .. } = &item.kind {
            spans.extend(features.iter().map(|feature| (feature.name.span, feature.span)));
        }
    }
    spans
}
