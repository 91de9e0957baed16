//! The file to write, and what is drawn in it: by its name and its ending.

use crate::cli::arguments::{ThemeChoice, ViewArguments};
use crate::cli::endings;
use crate::cli::failure::{Failure, unusable};
use std::path::Path;

/// What can be drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Form {
    Page,
    Picture,
    Plots,
    Dxf,
}

/// The forms by their endings.
const FORMS: [(&str, Form); 3] = [("html", Form::Page), ("svg", Form::Picture), ("dxf", Form::Dxf)];

/// An option that says how something is drawn: its name, whether it is given, and the forms that have it.
type Said = (&'static str, fn(&ViewArguments) -> bool, &'static [Form]);

/// All of them; a page that follows a file has none.
const OPTIONS: [Said; 11] = [
    ("--vary", |asked| !asked.vary.is_empty(), &[Form::Page]),
    ("--plots", |asked| asked.plots, &[Form::Plots]),
    ("--at", |asked| !asked.at.is_empty(), &[Form::Page, Form::Picture, Form::Dxf]),
    ("--trace", |asked| !asked.trace.is_empty(), &[Form::Page, Form::Picture, Form::Dxf]),
    ("--vectors", |asked| asked.vectors, &[Form::Page, Form::Picture]),
    ("--forces", |asked| asked.forces, &[Form::Page, Form::Picture, Form::Plots]),
    ("--labels", |asked| asked.labels, &[Form::Page, Form::Picture]),
    ("--size", |asked| asked.size.is_some(), &[Form::Page, Form::Picture, Form::Plots]),
    ("--scale", |asked| asked.scale.is_some(), &[Form::Picture, Form::Dxf]),
    ("--theme", |asked| asked.theme != ThemeChoice::Auto, &[Form::Page, Form::Picture, Form::Plots]),
    ("--body", |asked| asked.body.is_some(), &[Form::Picture, Form::Dxf]),
];

/// The first option that is given and that a form has not; without a form the first that is given at all.
pub(super) fn not_of(form: Option<Form>, arguments: &ViewArguments) -> Option<&'static str> {
    let lacks = |forms: &[Form]| form.is_none_or(|form| !forms.contains(&form));
    OPTIONS.iter().find(|(_, is_given, forms)| is_given(arguments) && lacks(forms)).map(|(option, ..)| *option)
}

/// What is drawn, by the name of a file and its ending.
pub(super) fn form(output: &str, arguments: &ViewArguments) -> Result<Form, Failure> {
    let form = if output == "-" || endings::is_special(output) { Form::Picture } else { form_of_ending(output)? };
    if form != Form::Page && !arguments.vary.is_empty() {
        return Err(unusable(format!("`--vary` is for pages, and `{output}` is none"))
            .help("name a `.html` file, or set the param with `--set`")
            .into());
    }
    let with_plots = arguments.plots || is_called_plots(output);
    let foreign = |form| not_of(Some(form), arguments);
    match form {
        Form::Picture if with_plots => match foreign(Form::Plots) {
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
        Form::Page => match foreign(Form::Page) {
            None => Ok(Form::Page),
            Some(option) => Err(unusable(format!("`{option}` is for pictures and DXF, and `{output}` is a page"))
                .help("name a `.svg` or `.dxf` file")
                .into()),
        },
        Form::Dxf => match foreign(Form::Dxf) {
            None => Ok(Form::Dxf),
            Some(option) => Err(unusable(format!("`{option}` is for what is looked at, and `{output}` is to be cut"))
                .help("leave it out, or name a `.svg` file")
                .into()),
        },
        form => Ok(form),
    }
}

/// Whether a file is called `plots.svg`, or `NAME.plots.svg`.
fn is_called_plots(output: &str) -> bool {
    let stem = Path::new(output).file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    stem.is_some_and(|stem| stem.rsplit('.').next() == Some("plots"))
}

/// Forms that other programs make of what is drawn here: their endings, what is to be drawn for them, and how it becomes one of them.
/// `NAME` stands for the name of the file without its ending, `END` for the ending.
const OF_OTHERS: [(&[&str], &str, &str); 4] = [
    (
        &["png", "pdf", "ps", "eps"],
        "NAME.svg --at T",
        "`rsvg-convert NAME.svg -f END -o NAME.END` or `inkscape NAME.svg -o NAME.END`",
    ),
    (&["jpg", "jpeg", "webp", "tif", "tiff", "bmp"], "NAME.svg --at T", "`magick NAME.svg NAME.END`"),
    (
        &["gif", "mp4", "webm", "apng", "avi", "mov"],
        "NAME/%04d.svg",
        "`rsvg-convert` for each picture, and `ffmpeg -framerate 25 -i NAME/%04d.png NAME.END` for all",
    ),
    (&["dwg"], "NAME.dxf", "any program for drawings, which reads DXF"),
];

/// What a file of such a name holds.
fn form_of_ending(output: &str) -> Result<Form, Failure> {
    endings::known(output, &FORMS).ok_or_else(|| {
        let (path, listed) = (Path::new(output), format!("the endings are {}", endings::listed(&FORMS)));
        let Some(ending) = path.extension().map(|ending| ending.to_string_lossy()) else {
            let said = format!("`{output}` has no ending, and so it is not said what to draw");
            return unusable(said).help(listed).into();
        };
        let said =
            unusable(format!("`{output}` ends in `.{ending}`, which is nothing that `view` writes")).help(listed);
        let made = OF_OTHERS.iter().find(|(endings, ..)| endings.iter().any(|one| ending.eq_ignore_ascii_case(one)));
        let Some((_, drawn, how)) = made else { return said.into() };
        let name = path.with_extension("");
        let filled = |text: &str| text.replace("NAME", &name.to_string_lossy()).replace("END", &ending.to_lowercase());
        said.help(format!("write `-o {}`, and have it converted: {}", filled(drawn), filled(how))).into()
    })
}

#[cfg(test)]
mod tests {
    use super::is_called_plots;

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
