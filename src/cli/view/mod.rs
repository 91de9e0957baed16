//! `mechc view`: the mechanism as a picture, still or moving.

mod form;
mod frames;
mod page;
mod wanted;

use super::arguments::ViewArguments;
use super::failure::{Failure, unusable};
use super::files::{self, Output};
use super::input;
use super::report::Reporter;
use super::times::Bounds;
use super::timings::Timings;
use crate::analysis::Times;
use crate::diag::Diagnostic;
use crate::scene::Motion;
use crate::stages::{Checked, Compiled, RunOptions, Seen};
use crate::view::dxf;
use crate::view::svg::{self, Options, Plot};
use form::Form;
use frames::Frames;
use std::io::Write;
use std::path::Path;

/// Of more rows some are left out.
const MOST_ROWS: usize = 2000;

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let output = form::output(arguments)?;
    let form = form::form(output, arguments)?;
    let frames = Frames::of(output).filter(|_| form == Form::Picture);
    let (mut timings, given) = (Timings::new(false), &arguments.input);
    let parsed = input::parsed(given, reporter)?;
    let stages = input::checked_and_compiled(&parsed, (given, &[]), arguments.allow_redundant, reporter, &mut timings)?;
    let (checked, compiled) = (&*stages.0, &stages.1);
    let bounds = Bounds::of(&arguments.interval, compiled.analysis(), &mut reporter.sources)?;
    let listed = bounds.listed(&arguments.at, &mut reporter.sources)?;
    let file = if frames.is_none() { Some(Output::open(output, &reporter.spared())?) } else { None };
    let options = RunOptions { pass_bifurcations: arguments.pass_bifurcations, ..RunOptions::default() };
    // symbols are as large as the whole motion asks for, where it is known
    let whole = match &listed {
        Some(listed) if !bounds.are_known() => listed.clone(),
        _ => bounds.grid()?,
    };
    let most = if frames.is_some() { usize::MAX } else { MOST_ROWS };
    let (seen, said) = checked.seen(compiled, &whole, &options, most);
    let mut seen = reporter.settle(seen, said)?;
    let alone = arguments.body.as_ref().map(|body| wanted::frame(&seen.scene, body)).transpose()?;
    if let Some(frame) = alone {
        (seen.scene, seen.motion) = seen.scene.alone(frame);
    }
    let pictured = wanted::pictured(arguments, &seen.scene)?;
    let (moments, stopped) = match listed.filter(|_| alone.is_none() && form != Form::Page) {
        None => (None, seen.stopped.clone()),
        Some(times) => {
            let (motion, stopped) = moments((checked, compiled), &times, &options)?;
            (Some(motion), stopped)
        }
    };
    let drawn = Drawn { seen: &seen, moments: moments.as_ref(), pictured: &pictured };
    match file {
        Some(mut file) => {
            let text = drawn.text(form, reporter)?;
            file.writer().write_all(text.as_bytes()).map_err(|error| file.failure(&error))?;
            file.close()?;
        }
        None => frames.map_or(Ok(()), |frames| drawn.write_frames(&frames, reporter))?,
    }
    stopped.map_or(Ok(()), |why| Err(why.into()))
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
                    let help = "traces, the lines of cams, the outlines of gears and the places of pins are";
                    unusable("there is nothing to cut".to_owned()).help(help).into()
                })
            }
        }
    }

    /// Plots of all measures.
    fn plots(&self) -> Result<String, Failure> {
        let Seen { scene, motion, columns, units, .. } = self.seen;
        let measures = scene.declarations.iter().filter(|declaration| declaration.kind == "measure");
        let plot = |name: &'_ str| {
            let (column, unit) = columns.iter().zip(units).find(|(column, _)| *column == name)?;
            let values = motion.column(column)?.map(|value| unit.printed(value)).collect();
            Some(Plot { name: column, unit: &unit.text, values })
        };
        let plots: Vec<Plot> = measures.filter_map(|measure| plot(&measure.name)).collect();
        if plots.is_empty() {
            let help = "say what is to be plotted, as in `measure lift = y(slider.P)`; the page, `-o OUT.html`, plots any column";
            return Err(unusable("there is no measure to plot".to_owned()).help(help).into());
        }
        Ok(svg::plots(scene, &motion.times, &plots, self.pictured))
    }

    /// A picture of each row. Each is written whole or not at all, and none if one of them is a file that was read.
    fn write_frames(&self, frames: &Frames, reporter: &Reporter) -> Result<(), Failure> {
        let Seen { scene, motion, .. } = self.seen;
        let moments = self.moments.unwrap_or(motion);
        let spared = reporter.spared();
        for row in 0..moments.len() {
            spared.refuse(&frames.name(row))?;
        }
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

/// The moments that are asked for, and why the last of them are missing, if they are.
fn moments(
    (checked, compiled): (&Checked, &Compiled),
    times: &Times,
    options: &RunOptions,
) -> Result<(Motion, Option<Diagnostic>), Failure> {
    // what there is to remark has been said of the whole motion
    let (found, said) = checked.moments(compiled, times, options);
    let Some((motion, stopped)) = found else { return Err(said.into()) };
    match stopped {
        Some(why) if motion.is_empty() => Err(why.into()),
        stopped => Ok((motion, stopped)),
    }
}
