//! `mechc view`: the mechanism as a picture, still or moving, or as a page that follows the file.

mod form;
mod frames;
mod live;
mod variants;
mod wanted;
mod watch;

use super::arguments::ViewArguments;
use super::failure::{Failure, unusable};
use super::files::{self, Disk, Output};
use super::input;
use super::report::Reporter;
use super::spared::refuse_links;
use super::times;
use form::Form;
use frames::Frames;
use mechc_draw::scene::{Motion, Pen};
use mechc_draw::view::dxf;
use mechc_draw::view::svg::{self, Options, Plot};
use mechc_engine::analysis::Times;
use mechc_ir::layout::{ColumnKind, ColumnUnit};
use mechc_live::page;
use mechc_pipeline::{Checked, Choice, Compiled, CurveTolerance, RunOptions, Seen};
use mechc_text::diag::{Diagnostic, Diagnostics};
use std::mem::ManuallyDrop;
use std::path::Path;

/// Of more rows some are left out.
const MOST_ROWS: usize = 2000;

/// What is said where a DXF shows gears.
const NO_TEETH: &str = "gears and racks are drawn as their pitch circles and lines alone: the text does not say how many teeth they have\n";

/// How many places of a plot there are from one time to the next at which the motion is known.
const PLACES_BETWEEN: u32 = 6;

/// What is said where `--forces` has nothing to show.
const NO_FORCES: &str =
    "there are no forces to draw: there are neither masses nor loads, or redundant equations share them in any way\n";

/// What is said where `--vectors` has nothing to show.
const NO_ARROWS: &str = "there are no arrows: no pin, traced point or point that has a name moves\n";

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let Some(output) = &arguments.output else { return live::view(arguments, reporter) };
    let form = form::form(output, arguments)?;
    if !arguments.vary.is_empty() {
        return variants::view(arguments, output, reporter);
    }
    let frames = Frames::of(output)?.filter(|_| form == Form::Picture);
    let given = &arguments.input;
    let parsed = input::parsed(given, reporter)?;
    // see `run`: nothing is taken apart before the process ends
    let choice = Choice { pictures_forces: form == Form::Page || arguments.forces, ..input::choice(given) };
    let checked = ManuallyDrop::new(input::checked_in(&parsed, &choice, &Disk, reporter)?);
    let options = RunOptions { pass_bifurcations: arguments.pass_bifurcations, ..RunOptions::default() };
    let target = Target { arguments, form, output, frames };
    let compiled = match input::proven(&checked, arguments.allow_redundant) {
        (None, said) => {
            let file = target.opened(reporter)?;
            return target.write_at_rest(file, (&checked, None), (0.0, &options), said, reporter);
        }
        (compiled, said) => reporter.settle(compiled, said)?,
    };
    let asked = times::asked((&arguments.interval, &arguments.at), compiled.analysis(), &mut reporter.sources)?;
    // symbols are as large as the whole motion asks for, where it is known
    let (listed, whole) = (asked.listed()?, asked.whole()?);
    let file = target.opened(reporter)?;
    let most = if target.frames.is_some() { usize::MAX } else { MOST_ROWS };
    let mut seen = match checked.seen(&compiled, &whole, &options, most) {
        (None, said) => {
            let at = (whole.from(), &options);
            return target.write_at_rest(file, (&checked, Some(&compiled)), at, said, reporter);
        }
        (seen, said) => reporter.settle(seen, said)?,
    };
    // a film shows the rows, and so does a picture of a single one
    let rows = (target.frames.is_some() || seen.motion.len() == 1).then(|| seen.motion.clone());
    if form != Form::Page {
        let is_still = rows.is_some() || listed.is_some() || arguments.body.is_some();
        let tolerance = CurveTolerance { is_animated: form == Form::Picture && !is_still, ..target.tolerance(&seen)? };
        reporter.print(&checked.refine_motion(&compiled, &whole, &options, &mut seen, &tolerance));
    }
    let is_alone = target.leave_alone(&mut seen)?;
    let (moments, stopped) = match listed.filter(|_| !is_alone && form != Form::Page) {
        None => (rows.filter(|_| !is_alone && form == Form::Picture), seen.stopped.clone()),
        Some(times) => {
            let (motion, stopped) = moments((&checked, &compiled), &times, &options, &seen)?;
            (Some(motion), stopped)
        }
    };
    if stopped.is_none() && seen.stopped.take().is_some() {
        // what was asked for is all there, and nothing is wrong with it
        seen.scene.name_nothing();
    }
    let pictured = wanted::pictured(arguments, &seen)?;
    let drawn = Drawn { seen: &seen, moments: moments.as_ref(), pictured: &pictured };
    target.write(file, &drawn, reporter)?;
    let is_without_arrows = arguments.vectors && !svg::has_vectors(&seen.scene, &pictured.traces, &seen.motion);
    let is_without_forces = arguments.forces && seen.scene.forces.is_empty() && seen.scene.torques.is_empty();
    let is_without_teeth = form == Form::Dxf && !seen.scene.pitch_lines.is_empty();
    let is_picture = form == Form::Picture;
    let remarks = [
        (is_without_arrows && is_picture, NO_ARROWS),
        (is_without_forces && is_picture, NO_FORCES),
        (is_without_teeth, NO_TEETH),
    ];
    for (_, words) in remarks.into_iter().filter(|(is_due, _)| *is_due && !reporter.is_for_programs()) {
        Reporter::say(words);
    }
    stopped.map_or(Ok(()), |why| Err(why.into()))
}

/// Where what is drawn goes.
struct Target<'a> {
    arguments: &'a ViewArguments,
    form: Form,
    output: &'a str,
    frames: Option<Frames>,
}

impl Target<'_> {
    /// The file, but for a film, which has many.
    fn opened(&self, reporter: &Reporter) -> Result<Option<Output>, Failure> {
        if self.frames.is_some() { Ok(None) } else { Ok(Some(Output::open(self.output, &reporter.spared())?)) }
    }

    /// That nothing is written, in words.
    fn not_written(&self) -> String {
        if self.output == "-" { "nothing is written".to_owned() } else { format!("`{}` is not written", self.output) }
    }

    /// The curves that are drawn, and what they may be off.
    fn tolerance(&self, seen: &Seen) -> Result<CurveTolerance, Failure> {
        let ViewArguments { scale, trace, .. } = self.arguments;
        let pens = trace.iter().map(|path| Ok(Pen::Point(wanted::trace(&seen.scene, path)?.1)));
        let pens = pens.collect::<Result<_, Failure>>()?;
        let tolerance = match (self.form, scale) {
            (Form::Dxf, _) | (Form::Picture, Some(_)) => CurveTolerance::to_cut(scale.unwrap_or(1.0), pens),
            _ => CurveTolerance::of_picture(seen, pens),
        };
        let plotted = plotted(seen).filter(|_| self.form == Form::Plots);
        Ok(CurveTolerance { columns: plotted.map(|(name, _)| name.clone()).collect(), ..tolerance })
    }

    /// Leaves the one body that was asked for, if one was.
    fn leave_alone(&self, seen: &mut Seen) -> Result<bool, Failure> {
        let Some(body) = &self.arguments.body else { return Ok(false) };
        let frame = wanted::frame(&seen.scene, body)?;
        (seen.scene, seen.motion) = seen.scene.alone(frame);
        Ok(true)
    }

    fn write(&self, file: Option<Output>, drawn: &Drawn, reporter: &Reporter) -> Result<(), Failure> {
        match (file, &self.frames) {
            (Some(file), _) => file.close_with_text(&drawn.text(self.form, reporter)?),
            (None, Some(frames)) => drawn.write_frames(frames, reporter),
            (None, None) => Ok(()),
        }
    }

    /// Draws a mechanism that is refused, or cannot be assembled at a time (s), and ends as for what was said of that. Of one that has no
    /// position nothing can be cut or plotted.
    fn write_at_rest(
        &self,
        file: Option<Output>,
        (checked, compiled): (&Checked, Option<&Compiled>),
        at: (f64, &RunOptions),
        mut said: Diagnostics,
        reporter: &Reporter,
    ) -> Result<(), Failure> {
        let why = match self.form {
            Form::Dxf => Some("a mechanism without a position is not to be cut"),
            Form::Plots => Some("a mechanism without a motion has nothing to plot"),
            Form::Page | Form::Picture => None,
        };
        if let Some(why) = why {
            let help = "name a `.svg` or `.html` file to see what is the matter with it";
            said.push(unusable(format!("{}: {why}", self.not_written())).help(help));
        } else if let Some(mut seen) = checked.seen_at_rest(compiled, at, &said) {
            self.leave_alone(&mut seen)?;
            let pictured = wanted::pictured(self.arguments, &seen)?;
            self.write(file, &Drawn { seen: &seen, moments: None, pictured: &pictured }, reporter)?;
        }
        Err(said.into())
    }
}

/// What there is to draw, and of which moments.
struct Drawn<'d> {
    seen: &'d Seen,
    moments: Option<&'d Motion>,
    pictured: &'d Options,
}

impl Drawn<'_> {
    fn text(&self, form: Form, reporter: &Reporter) -> Result<String, Failure> {
        let Drawn { seen, moments, pictured } = *self;
        let Seen { scene, motion, .. } = seen;
        match (form, moments) {
            (Form::Page, _) => Ok(page::written(seen, &reporter.sources)),
            (Form::Plots, _) => self.plots(),
            (Form::Picture, None) => Ok(svg::animated(scene, motion, pictured)),
            (Form::Picture, Some(moments)) => Ok(svg::still(scene, motion, moments, pictured)),
            (Form::Dxf, _) => {
                let poses = moments.unwrap_or(motion).poses(0);
                dxf::written(scene, motion, poses, &pictured.traces, pictured.scale.unwrap_or(1.0)).ok_or_else(|| {
                    let help = "traces, the lines of cams, the pitch circles of gears and the places of pins are";
                    unusable("there is nothing to cut".to_owned()).help(help).into()
                })
            }
        }
    }

    /// Plots of all measures; of efforts, reactions and loads behind them, where these are asked for.
    fn plots<'s>(&'s self) -> Result<String, Failure> {
        let Seen { scene, motion, .. } = self.seen;
        let times = motion.times_between(PLACES_BETWEEN);
        let plot = |(name, unit): (&'s String, &'s ColumnUnit)| Plot {
            name,
            unit: &unit.text,
            values: motion.column_at(name, &times).into_iter().map(|value| unit.printed(value)).collect(),
        };
        let plots: Vec<Plot> = plotted(self.seen).map(plot).collect();
        if plots.is_empty() {
            let help = "say what is to be plotted, as in `measure lift = y(slider.P)`; the page, `-o OUT.html`, plots any column";
            return Err(unusable("there is no measure to plot".to_owned()).help(help).into());
        }
        Ok(svg::plots(scene, &times, &plots, self.pictured))
    }

    /// A picture of each row. Each is written whole or not at all, and none if one of them is a file that was read.
    fn write_frames(&self, frames: &Frames, reporter: &Reporter) -> Result<(), Failure> {
        let Seen { scene, motion, .. } = self.seen;
        let moments = self.moments.unwrap_or(motion);
        let spared = reporter.spared();
        for row in 0..moments.len() {
            spared.refuse(&frames.name(row))?;
        }
        refuse_links((0..moments.len()).map(|row| frames.name(row).into()))?;
        if let Some(folder) = Path::new(&frames.name(0)).parent().filter(|folder| !folder.as_os_str().is_empty()) {
            files::make_folder(folder).map_err(|error| files::cannot_write(&folder.to_string_lossy(), &error))?;
        }
        for row in 0..moments.len() {
            let text = svg::still(scene, motion, &moments.moment(row), self.pictured);
            Output::write(&frames.name(row), &text, &spared)?;
        }
        Ok(())
    }
}

/// The columns that are plotted, with their units: all measures, and what forces are asked for.
fn plotted(seen: &Seen) -> impl Iterator<Item = (&String, &ColumnUnit)> {
    let Seen { scene, columns, units, kinds, .. } = seen;
    let measures = scene.declarations.iter().filter(|declaration| declaration.kind == "measure");
    let named = move |name: &String| columns.iter().zip(units).find(|(column, _)| *column == name);
    let measures = measures.filter_map(move |measure| named(&measure.name));
    let forces = columns.iter().zip(units).zip(kinds).filter(|(_, kind)| **kind == ColumnKind::Reaction);
    measures.chain(forces.map(|(column, _)| column))
}

/// The moments that are asked for, and why the last of them are missing, if they are; where all are, the last one before that.
fn moments(
    (checked, compiled): (&Checked, &Compiled),
    times: &Times,
    options: &RunOptions,
    seen: &Seen,
) -> Result<(Motion, Option<Diagnostic>), Failure> {
    // what there is to remark has been said of the whole motion
    let (found, said) = checked.moments(compiled, times, options);
    let Some((mut motion, stopped)) = found else { return Err(said.into()) };
    if stopped.is_some() && motion.times.last() < seen.motion.times.last() {
        // it is shown up to where it stops
        motion.append_last(&seen.motion);
    }
    Ok((motion, stopped))
}
