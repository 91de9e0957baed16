//! `mechc view`: the mechanism as a picture, still or moving.

use super::arguments::{ThemeChoice, ViewArguments};
use super::failure::Failure;
use super::files::Output;
use super::input;
use super::page;
use super::report::Reporter;
use super::times::Bounds;
use super::timings::Timings;
use crate::analysis::Times;
use crate::diag::{Code, Diagnostic, nearest};
use crate::scene::{Anchor, Motion, Scene};
use crate::stages::{Checked, Compiled, RunOptions};
use crate::view::svg::{self, Options, Theme};
use std::io::Write;
use std::path::Path;

/// Of more rows some are left out.
const MOST_ROWS: usize = 2000;

/// What can be drawn, by the endings of files.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    Html,
    Svg,
}

/// The forms by their endings.
const FORMS: [(&str, Form); 2] = [("html", Form::Html), ("svg", Form::Svg)];

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let output = output(arguments)?;
    let form = form(output)?;
    let (mut timings, given) = (Timings::new(false), &arguments.input);
    let parsed = input::parsed(given, reporter)?;
    let stages = input::checked_and_compiled(&parsed, (given, &[]), arguments.allow_redundant, reporter, &mut timings)?;
    let (checked, compiled) = (&*stages.0, &stages.1);
    let bounds = Bounds::of(&arguments.interval, compiled.analysis(), &mut reporter.sources)?;
    let listed = bounds.listed(&arguments.at, &mut reporter.sources)?;
    let mut file = Output::open(output, &reporter.spared())?;
    let options = RunOptions { pass_bifurcations: arguments.pass_bifurcations, ..RunOptions::default() };
    // symbols are as large as the whole motion asks for, where it is known
    let whole = match &listed {
        Some(listed) if !bounds.are_known() => listed.clone(),
        _ => bounds.grid()?,
    };
    let (seen, said) = checked.seen(compiled, &whole, &options, MOST_ROWS);
    let seen = reporter.settle(seen, said)?;
    let pictured = pictured(arguments, &seen.scene)?;
    let (text, stopped) = match listed {
        _ if form == Form::Html => (page::written(&seen, &reporter.sources), seen.stopped),
        None => (svg::animated(&seen.scene, &seen.motion, &pictured), seen.stopped),
        Some(times) => {
            let (motion, stopped) = moments((checked, compiled), &times, &options)?;
            (svg::still(&seen.scene, &seen.motion, &motion, &pictured), stopped)
        }
    };
    file.writer().write_all(text.as_bytes()).map_err(|error| file.failure(&error))?;
    file.close()?;
    stopped.map_or(Ok(()), |why| Err(why.into()))
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

/// What is asked for beside the mechanism.
fn pictured(arguments: &ViewArguments, scene: &Scene) -> Result<Options, Failure> {
    let theme = match arguments.theme {
        ThemeChoice::Auto => Theme::Auto,
        ThemeChoice::Light => Theme::Light,
        ThemeChoice::Dark => Theme::Dark,
    };
    let traces = arguments.trace.iter().map(|path| trace(scene, path)).collect::<Result<Vec<_>, Failure>>()?;
    let ViewArguments { size, vectors, labels, .. } = *arguments;
    Ok(Options { size, theme, traces, vectors, labels, captions: Vec::new() })
}

/// A point by its path.
fn trace(scene: &Scene, path: &str) -> Result<(String, Anchor), Failure> {
    let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some(point) = scene.point_named(&path) {
        return Ok((path, Anchor { frame: point.frame, at: point.at }));
    }
    let names = || scene.points.iter().filter(|point| point.frame > 0).map(|point| point.name.as_str());
    let help = match nearest(&path, names()) {
        Some(meant) => format!("was `{meant}` meant?"),
        None => match names().next() {
            Some(example) => format!("name a point of a body, as in `--trace {example}`"),
            None => "its bodies have no points that have a name".to_owned(),
        },
    };
    Err(unusable(format!("there is no point `{path}` to trace")).help(help).into())
}

/// The file to write.
fn output(arguments: &ViewArguments) -> Result<&str, Failure> {
    arguments.output.as_deref().ok_or_else(|| {
        let file = if arguments.input.file == "-" { "mechanism.mech" } else { &arguments.input.file };
        let picture = Path::new(file).with_extension("svg");
        let example = picture.file_name().map_or("picture.svg".into(), |name| name.to_string_lossy());
        unusable("it is not said where the picture goes".to_owned())
            .help(format!("name a file, as in `-o {example}`"))
            .into()
    })
}

/// What is drawn, by the ending of a file.
fn form(output: &str) -> Result<Form, Failure> {
    // standard output, a pipe, a device
    let is_special = || Path::new(output).metadata().is_ok_and(|found| !found.is_file() && !found.is_dir());
    if output == "-" || is_special() {
        return Ok(Form::Svg);
    }
    let ending = Path::new(output).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let known = ending.as_ref().and_then(|ending| FORMS.iter().find(|(known, _)| known == ending));
    known.map(|(_, form)| *form).ok_or_else(|| {
        let listed: Vec<String> = FORMS.iter().map(|(ending, _)| format!("`.{ending}`")).collect();
        let said = match &ending {
            Some(ending) => format!("`{output}` ends in `.{ending}`, which is nothing that `view` writes"),
            None => format!("`{output}` has no ending, and so it is not said what to draw"),
        };
        unusable(said).help(format!("the endings are {}", listed.join(", "))).into()
    })
}

fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}
