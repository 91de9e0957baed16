//! What there is to see of a mechanism: its scene, its motion as a table, its texts. The one door to those who draw.

use super::run::{Run, RunOptions};
use super::{Checked, Compiled};
use crate::analysis::{ColumnUnit, Times};
use crate::check::{self, Library};
use crate::diag::{Diagnostic, Diagnostics};
use crate::scene::{Motion, Scene, drawn_poses};
use crate::source::{FileId, Span};
use crate::syntax::ast;
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
    /// How many rows there would be if none had been left out.
    pub all_rows: usize,
    /// Why the motion ended before its last time, if it did.
    pub stopped: Option<Diagnostic>,
    /// Results with the units in which they are told, in SI; none where only some times were asked for.
    pub results: Vec<(String, ColumnUnit, Option<f64>)>,
    /// The texts that its declarations stand in, its own first.
    pub texts: Vec<FileId>,
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
        let Some(model) = self.model() else { return (None, Diagnostics::default()) };
        let (run, mut said) = compiled.run(times, options);
        let Some(run) = run else { return (None, said) };
        let (columns, units) = (run.columns().to_vec(), run.units().to_vec());
        let found = rows(run, most);
        said.extend(found.said);
        let motion = if found.kept.is_empty() {
            Motion::still(drawn_poses(model))
        } else {
            Motion::of_rows(model.bodies.len(), &columns, found.kept, found.edges)
        };
        let mut scene = Scene::of(model, &motion);
        self.widen_places(&mut scene);
        let values = found.results.into_iter();
        let results =
            compiled.results().into_iter().zip(values).map(|((name, unit), value)| (name, unit, value)).collect();
        let (all_rows, stopped, texts) = (found.all, found.stopped, self.texts());
        (Some(Seen { scene, motion, columns, units, all_rows, stopped, results, texts }), said)
    }

    /// What there is to draw of a motion of it with symbols of a size (m); nothing where it is not sound.
    #[must_use]
    pub fn drawn_with_symbols(&self, motion: &Motion, unit: f64) -> Option<Scene> {
        let mut scene = Scene::with_symbols(self.model()?, motion, unit);
        self.widen_places(&mut scene);
        Some(scene)
    }

    /// A scene of what is drawn in the text, without any motion; nothing where it is not sound.
    #[must_use]
    pub fn seen_as_drawn(&self) -> Option<(Scene, Motion)> {
        let model = self.model()?;
        let motion = Motion::still(drawn_poses(model));
        let mut scene = Scene::of(model, &motion);
        self.widen_places(&mut scene);
        Some((scene, motion))
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
        let (Some(run), Some(model)) = (run, self.model()) else { return (None, said) };
        let columns = run.columns().to_vec();
        let found = rows(run, usize::MAX);
        said.extend(found.said);
        (Some((Motion::of_rows(model.bodies.len(), &columns, found.kept, found.edges), found.stopped)), said)
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
