//! `mechc view`: the mechanism as a picture, still or moving.

use super::arguments::{ThemeChoice, ViewArguments};
use super::failure::Failure;
use super::files::{self, Output};
use super::input;
use super::page;
use super::report::Reporter;
use super::times::Bounds;
use super::timings::Timings;
use crate::analysis::Times;
use crate::diag::{Code, Diagnostic, nearest};
use crate::scene::{Anchor, Motion, Scene};
use crate::stages::{Checked, Compiled, RunOptions, Seen};
use crate::view::dxf;
use crate::view::svg::{self, Options, Plot, Theme};
use std::io::Write;
use std::path::Path;

/// Of more rows some are left out.
const MOST_ROWS: usize = 2000;

/// What can be drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    Page,
    Picture,
    Plots,
    Dxf,
}

/// The forms by their endings.
const FORMS: [(&str, Form); 3] = [("html", Form::Page), ("svg", Form::Picture), ("dxf", Form::Dxf)];

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let output = output(arguments)?;
    let form = form(output, arguments)?;
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
    let alone = arguments.body.as_ref().map(|body| frame(&seen.scene, body)).transpose()?;
    if let Some(frame) = alone {
        (seen.scene, seen.motion) = seen.scene.alone(frame);
    }
    let pictured = pictured(arguments, &seen.scene)?;
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

/// The names of a film's pictures: what stands before and behind the number, which has so many digits at least.
struct Frames {
    before: String,
    behind: String,
    digits: usize,
}

impl Frames {
    /// Of a file's name with one `%d`, or `%04d`, in it.
    fn of(output: &str) -> Option<Frames> {
        let (before, rest) = output.rsplit_once('%')?;
        let (digits, behind) = rest.split_once('d')?;
        let has_digits = digits.is_empty() || (digits.starts_with('0') && digits.bytes().all(|c| c.is_ascii_digit()));
        let digits = if digits.is_empty() { 1 } else { digits.parse().ok()? };
        let is_in_name = !behind.contains(std::path::is_separator);
        (has_digits && is_in_name && digits <= 20).then(|| Frames {
            before: before.to_owned(),
            behind: behind.to_owned(),
            digits,
        })
    }

    fn name(&self, row: usize) -> String {
        format!("{}{row:0digits$}{}", self.before, self.behind, digits = self.digits)
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

/// What is asked for beside the mechanism.
fn pictured(arguments: &ViewArguments, scene: &Scene) -> Result<Options, Failure> {
    let theme = match arguments.theme {
        ThemeChoice::Auto => Theme::Auto,
        ThemeChoice::Light => Theme::Light,
        ThemeChoice::Dark => Theme::Dark,
    };
    let traces = arguments.trace.iter().map(|path| trace(scene, path)).collect::<Result<Vec<_>, Failure>>()?;
    let ViewArguments { size, scale, vectors, labels, .. } = *arguments;
    Ok(Options { size, scale, theme, traces, vectors, labels, captions: Vec::new() })
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

/// The frame of a body by its name.
fn frame(scene: &Scene, name: &str) -> Result<usize, Failure> {
    let bodies = || scene.frames.iter().skip(1).filter_map(|declaration| scene.declarations.get(*declaration));
    if let Some(number) = bodies().position(|body| body.name == name) {
        return Ok(number + 1);
    }
    let names: Vec<&str> = bodies().map(|body| body.name.as_str()).collect();
    let help = match nearest(name, names.iter().copied()) {
        Some(meant) => format!("was `{meant}` meant?"),
        None => format!(
            "its bodies are {}",
            names.iter().take(8).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        ),
    };
    Err(unusable(format!("there is no body `{name}` to draw")).help(help).into())
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

/// What is drawn, by the name of a file and its ending.
fn form(output: &str, arguments: &ViewArguments) -> Result<Form, Failure> {
    // standard output, a pipe, a device
    let is_special = || Path::new(output).metadata().is_ok_and(|found| !found.is_file() && !found.is_dir());
    let form = if output == "-" || is_special() { Form::Picture } else { form_of_ending(output)? };
    let with_plots = arguments.plots || is_called_plots(output);
    match form {
        Form::Picture if with_plots => match not_of_plots(arguments) {
            None => Ok(Form::Plots),
            Some(option) => Err(unusable(format!("`{option}` is for pictures, and `{output}` is to hold plots"))
                .help("name it otherwise: `plots.svg` and `NAME.plots.svg` hold plots of all measures over time")
                .into()),
        },
        Form::Dxf if arguments.at.len() > 1 => {
            Err(unusable("a DXF shows one moment".to_owned()).help("give `--at` once").into())
        }
        Form::Page | Form::Dxf if arguments.plots => {
            Err(unusable(format!("`--plots` asks for a picture, and `{output}` is none"))
                .help("name a `.svg` file")
                .into())
        }
        Form::Page if arguments.scale.is_some() || arguments.body.is_some() => {
            let option = if arguments.scale.is_some() { "--scale" } else { "--body" };
            Err(unusable(format!("`{option}` is for pictures and DXF, and `{output}` is a page"))
                .help("name a `.svg` or `.dxf` file")
                .into())
        }
        form => Ok(form),
    }
}

/// What is asked for that plots do not have.
fn not_of_plots(arguments: &ViewArguments) -> Option<&'static str> {
    let ViewArguments { at, trace, vectors, labels, scale, body, .. } = arguments;
    let asked = [
        ("--at", !at.is_empty()),
        ("--trace", !trace.is_empty()),
        ("--vectors", *vectors),
        ("--labels", *labels),
        ("--scale", scale.is_some()),
        ("--body", body.is_some()),
    ];
    asked.into_iter().find(|(_, is_asked)| *is_asked).map(|(option, _)| option)
}

/// Whether a file is called `plots.svg`, or `NAME.plots.svg`.
fn is_called_plots(output: &str) -> bool {
    let stem = Path::new(output).file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    stem.is_some_and(|stem| stem.rsplit('.').next() == Some("plots"))
}

fn form_of_ending(output: &str) -> Result<Form, Failure> {
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

#[cfg(test)]
mod tests {
    use super::{Frames, is_called_plots};

    #[test]
    fn names_of_frames_have_a_number() {
        for (output, wanted) in [
            ("frames/%04d.svg", Some("frames/0007.svg")),
            ("f%d.svg", Some("f7.svg")),
            ("100%-%03d.svg", Some("100%-007.svg")),
            ("100%.svg", None),
            ("%4d.svg", None),
            ("%s.svg", None),
            ("%02d/a.svg", None),
            ("a.svg", None),
        ] {
            assert_eq!(Frames::of(output).map(|frames| frames.name(7)).as_deref(), wanted, "{output}");
        }
        assert_eq!(Frames::of("%02d.svg").map(|frames| frames.name(12_345)).as_deref(), Some("12345.svg"));
    }

    #[test]
    fn plots_are_called_so() {
        for (output, wanted) in [
            ("plots.svg", true),
            ("a/Plots.svg", true),
            ("a.plots.svg", true),
            ("allplots.svg", false),
            ("plots/a.svg", false),
        ] {
            assert_eq!(is_called_plots(output), wanted, "{output}");
        }
    }
}
