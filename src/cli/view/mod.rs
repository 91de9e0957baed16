//! `mechc view`: the mechanism as a picture, still or moving, or as a page that follows the file.

mod form;
mod frames;
mod live;
mod overlays;
mod variants;
mod watch;

use super::arguments::ViewArguments;
use super::failure::{Failure, unusable};
use super::files::{self, Disk, Output};
use super::input;
use super::protected_paths::refuse_links;
use super::report::Reporter;
use form::Form;
use frames::Frames;
use mechc_draw::scene::{Motion, Pen};
use mechc_draw::view::dxf;
use mechc_draw::view::svg::{self, Options, Plot};
use mechc_engine::analysis::Times;
use mechc_ir::layout::{ColumnKind, ColumnUnit};
use mechc_live::page;
use mechc_pipeline::{Checked, Choice, Compiled, CurveTolerance, RunOptions, Visualization};
use mechc_text::diag::{Diagnostic, Diagnostics};
use std::mem::ManuallyDrop;
use std::path::Path;

/// The maximum number of rows; from a longer motion some rows are left out.
const MAX_ROWS: usize = 2000;

/// The note on a DXF that shows gears.
const NO_TEETH: &str = "gears and racks are drawn as their pitch circles and lines alone: the text does not say how many teeth they have\n";

/// The number of points of a plot from one row to the next.
const POINTS_PER_ROW: u32 = 6;

/// The note if `--forces` has nothing to show.
const NO_FORCES: &str =
    "there are no forces to draw: there are neither masses nor loads, or redundant equations share them in any way\n";

/// The note if `--vectors` has nothing to show.
const NO_ARROWS: &str = "there are no arrows: no pin, traced point or point that has a name moves\n";

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let Some(output) = &arguments.output else { return live::view(arguments, reporter) };
    let form = form::form(output, arguments)?;
    if !arguments.vary.is_empty() {
        return variants::view(arguments, output, reporter);
    }
    let frames = Frames::parse(output)?.filter(|_| form == Form::Picture);
    let input_arguments = &arguments.input;
    let parsed = input::parsed(input_arguments, reporter)?;
    // see `run`: nothing is dropped before the process ends
    let choice = Choice { pictures_forces: form == Form::Page || arguments.forces, ..input::choice(input_arguments) };
    let checked = ManuallyDrop::new(input::checked_in(&parsed, &choice, &Disk, reporter)?);
    let options = RunOptions { pass_bifurcations: arguments.pass_bifurcations, ..RunOptions::default() };
    let target = Target { arguments, form, output, frames, run_options: &options };
    let compiled = match input::prove(&checked, arguments.allow_redundant) {
        (None, diagnostics) => {
            let file = target.open(reporter)?;
            return target.write_at_rest(file, &checked, None, 0.0, diagnostics, reporter);
        }
        (compiled, diagnostics) => reporter.require(compiled, diagnostics)?,
    };
    let requested =
        input::requested_times(&arguments.interval, &arguments.at, compiled.analysis(), &mut reporter.sources)?;
    // the size of symbols depends on the whole motion, even if only some moments are drawn
    let (listed, whole) = (requested.listed()?, requested.whole()?);
    let file = target.open(reporter)?;
    let max_rows = if target.frames.is_some() { usize::MAX } else { MAX_ROWS };
    let mut visualization = match checked.visualize(&compiled, &whole, &options, max_rows) {
        (None, diagnostics) => {
            return target.write_at_rest(file, &checked, Some(&compiled), whole.from(), diagnostics, reporter);
        }
        (visualization, diagnostics) => reporter.require(visualization, diagnostics)?,
    };
    // a film and a picture of a single row show the rows themselves
    let rows = (target.frames.is_some() || visualization.motion.len() == 1).then(|| visualization.motion.clone());
    if form != Form::Page {
        let is_still = rows.is_some() || listed.is_some() || arguments.body.is_some();
        let tolerance =
            CurveTolerance { is_animated: form == Form::Picture && !is_still, ..target.tolerance(&visualization)? };
        reporter.print(&checked.refine_motion(&compiled, &whole, &options, &mut visualization, &tolerance));
    }
    let is_isolated = target.isolate_body(&mut visualization)?;
    let (moments, stopped) = match listed.filter(|_| !is_isolated && form != Form::Page) {
        None => (rows.filter(|_| !is_isolated && form == Form::Picture), visualization.stopped.clone()),
        Some(times) => {
            let (motion, stopped) = moments(&checked, &compiled, &times, &options, &visualization)?;
            (Some(motion), stopped)
        }
    };
    if stopped.is_none() && visualization.stopped.take().is_some() {
        // the motion stops after the requested moments, so nothing in the picture is marked
        visualization.scene.clear_highlights();
    }
    let svg_options = overlays::svg_options(arguments, &visualization)?;
    let drawing = Drawing { visualization: &visualization, moments: moments.as_ref(), options: &svg_options };
    target.write(file, &drawing, reporter)?;
    let is_without_arrows =
        arguments.vectors && !svg::has_vectors(&visualization.scene, &svg_options.traces, &visualization.motion);
    let is_without_forces =
        arguments.forces && visualization.scene.forces.is_empty() && visualization.scene.torques.is_empty();
    let is_without_teeth = form == Form::Dxf && !visualization.scene.pitch_lines.is_empty();
    let is_picture = form == Form::Picture;
    let remarks = [
        (is_without_arrows && is_picture, NO_ARROWS),
        (is_without_forces && is_picture, NO_FORCES),
        (is_without_teeth, NO_TEETH),
    ];
    for (_, text) in remarks.into_iter().filter(|(is_due, _)| *is_due && !reporter.is_machine_readable()) {
        Reporter::print_text(text);
    }
    stopped.map_or(Ok(()), |why| Err(why.into()))
}

/// The output of a drawing.
struct Target<'a> {
    arguments: &'a ViewArguments,
    form: Form,
    output: &'a str,
    frames: Option<Frames>,
    /// The options for the motion.
    run_options: &'a RunOptions,
}

impl Target<'_> {
    /// Opens the file, except for a film, which has many.
    fn open(&self, reporter: &Reporter) -> Result<Option<Output>, Failure> {
        if self.frames.is_some() { Ok(None) } else { Ok(Some(Output::open(self.output, &reporter.protected())?)) }
    }

    /// Formats that nothing is written.
    fn not_written(&self) -> String {
        if self.output == "-" { "nothing is written".to_owned() } else { format!("`{}` is not written", self.output) }
    }

    /// Returns the curves to draw and their tolerance.
    fn tolerance(&self, visualization: &Visualization) -> Result<CurveTolerance, Failure> {
        let ViewArguments { scale, trace, .. } = self.arguments;
        let pens = trace.iter().map(|path| Ok(Pen::Point(overlays::trace(&visualization.scene, path)?.1)));
        let pens = pens.collect::<Result<_, Failure>>()?;
        let tolerance = match (self.form, scale) {
            (Form::Dxf, _) | (Form::Picture, Some(_)) => CurveTolerance::to_cut(scale.unwrap_or(1.0), pens),
            _ => CurveTolerance::of_picture(visualization, pens),
        };
        let plotted = plotted_columns(visualization).filter(|_| self.form == Form::Plots);
        Ok(CurveTolerance { columns: plotted.map(|(name, _)| name.clone()).collect(), ..tolerance })
    }

    /// Removes all but the body of `--body`; returns whether the option is given.
    fn isolate_body(&self, visualization: &mut Visualization) -> Result<bool, Failure> {
        let Some(body) = &self.arguments.body else { return Ok(false) };
        let frame = overlays::frame(&visualization.scene, body)?;
        (visualization.scene, visualization.motion) = visualization.scene.alone(frame);
        Ok(true)
    }

    fn write(&self, file: Option<Output>, drawing: &Drawing, reporter: &Reporter) -> Result<(), Failure> {
        match (file, &self.frames) {
            (Some(file), _) => file.close_with_text(&drawing.text(self.form, reporter)?),
            (None, Some(frames)) => drawing.write_frames(frames, reporter),
            (None, None) => Ok(()),
        }
    }

    /// Draws a mechanism that is refused, or cannot be assembled at a time (s), and fails with its diagnostics. Without a position there is
    /// no DXF and no plot.
    fn write_at_rest(
        &self,
        file: Option<Output>,
        checked: &Checked,
        compiled: Option<&Compiled>,
        t: f64,
        mut diagnostics: Diagnostics,
        reporter: &Reporter,
    ) -> Result<(), Failure> {
        let why = match self.form {
            Form::Dxf => Some("a mechanism without a position is not to be cut"),
            Form::Plots => Some("a mechanism without a motion has nothing to plot"),
            Form::Page | Form::Picture => None,
        };
        if let Some(why) = why {
            let help = "name a `.svg` or `.html` file to see what is the matter with it";
            diagnostics.push(unusable(format!("{}: {why}", self.not_written())).help(help));
        } else if let Some(mut still) = checked.static_visualization(compiled, (t, self.run_options), &diagnostics) {
            self.isolate_body(&mut still)?;
            let options = overlays::svg_options(self.arguments, &still)?;
            self.write(file, &Drawing { visualization: &still, moments: None, options: &options }, reporter)?;
        }
        Err(diagnostics.into())
    }
}

/// The visualization to draw, the moments to show, and the options.
struct Drawing<'d> {
    visualization: &'d Visualization,
    moments: Option<&'d Motion>,
    options: &'d Options,
}

impl Drawing<'_> {
    fn text(&self, form: Form, reporter: &Reporter) -> Result<String, Failure> {
        let Drawing { visualization, moments, options } = *self;
        let Visualization { scene, motion, .. } = visualization;
        match (form, moments) {
            (Form::Page, _) => Ok(page::render(visualization, &reporter.sources)),
            (Form::Plots, _) => self.plots(),
            (Form::Picture, None) => Ok(svg::animated(scene, motion, options)),
            (Form::Picture, Some(moments)) => Ok(svg::still(scene, motion, moments, options)),
            (Form::Dxf, _) => {
                let poses = moments.unwrap_or(motion).poses(0);
                dxf::written(scene, motion, poses, &options.traces, options.scale.unwrap_or(1.0)).ok_or_else(|| {
                    let help = "traces, the lines of cams, the pitch circles of gears and the places of pins are";
                    unusable("there is nothing to cut".to_owned()).help(help).into()
                })
            }
        }
    }

    /// Draws plots of all measures, followed by efforts, reactions and loads if these are requested.
    fn plots<'s>(&'s self) -> Result<String, Failure> {
        let Visualization { scene, motion, .. } = self.visualization;
        let times = motion.times_between(POINTS_PER_ROW);
        let plot = |(name, unit): (&'s String, &'s ColumnUnit)| Plot {
            name,
            unit: &unit.text,
            values: motion.column_at(name, &times).into_iter().map(|value| unit.printed(value)).collect(),
        };
        let plots: Vec<Plot> = plotted_columns(self.visualization).map(plot).collect();
        if plots.is_empty() {
            let help = "say what is to be plotted, as in `measure lift = y(slider.P)`; the page, `-o OUT.html`, plots any column";
            return Err(unusable("there is no measure to plot".to_owned()).help(help).into());
        }
        Ok(svg::plots(scene, &times, &plots, self.options))
    }

    /// Writes a picture of each row, each whole or not at all; none is written if one of them would overwrite an input.
    fn write_frames(&self, frames: &Frames, reporter: &Reporter) -> Result<(), Failure> {
        let Visualization { scene, motion, .. } = self.visualization;
        let moments = self.moments.unwrap_or(motion);
        let protected = reporter.protected();
        for row in 0..moments.len() {
            protected.refuse(&frames.name(row))?;
        }
        refuse_links((0..moments.len()).map(|row| frames.name(row).into()))?;
        if let Some(folder) = Path::new(&frames.name(0)).parent().filter(|folder| !folder.as_os_str().is_empty()) {
            files::create_folder(folder).map_err(|error| files::cannot_write(&folder.to_string_lossy(), &error))?;
        }
        for row in 0..moments.len() {
            let text = svg::still(scene, motion, &moments.moment(row), self.options);
            Output::write(&frames.name(row), &text, &protected)?;
        }
        Ok(())
    }
}

/// Returns the columns to plot with their units: all measures, and the requested forces.
fn plotted_columns(visualization: &Visualization) -> impl Iterator<Item = (&String, &ColumnUnit)> {
    let Visualization { scene, columns, units, kinds, .. } = visualization;
    let measures = scene.declarations.iter().filter(|declaration| declaration.kind == "measure");
    let named = move |name: &String| columns.iter().zip(units).find(|(column, _)| *column == name);
    let measures = measures.filter_map(move |measure| named(&measure.name));
    let forces = columns.iter().zip(units).zip(kinds).filter(|(_, kind)| **kind == ColumnKind::Reaction);
    measures.chain(forces.map(|(column, _)| column))
}

/// Computes the requested moments, and why the last of them are missing, if they are. If the motion stops, its last row is appended.
fn moments(
    checked: &Checked,
    compiled: &Compiled,
    times: &Times,
    options: &RunOptions,
    visualization: &Visualization,
) -> Result<(Motion, Option<Diagnostic>), Failure> {
    // warnings were printed for the whole motion already
    let (found, diagnostics) = checked.moments(compiled, times, options);
    let Some((mut motion, stopped)) = found else { return Err(diagnostics.into()) };
    if stopped.is_some() && motion.times.last() < visualization.motion.times.last() {
        motion.append_last_row(&visualization.motion);
    }
    Ok((motion, stopped))
}
