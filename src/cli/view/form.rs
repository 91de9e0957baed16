//! The form of the output of `view`, from the name and extension of the file.

use crate::cli::arguments::{ThemeChoice, ViewArguments};
use crate::cli::failure::{Failure, unusable};
use crate::cli::output_format;
use std::path::Path;

/// A form of output.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Form {
    Page,
    Picture,
    Plots,
    Dxf,
}

/// The forms by extension.
const FORMS: [(&str, Form); 3] = [("html", Form::Page), ("svg", Form::Picture), ("dxf", Form::Dxf)];

/// A drawing option: its name, a predicate that tells if it is given, and the forms that have it.
type DrawingOption = (&'static str, fn(&ViewArguments) -> bool, &'static [Form]);

/// The drawing options; a live page has none of them.
const OPTIONS: [DrawingOption; 11] = [
    ("--vary", |given| !given.vary.is_empty(), &[Form::Page]),
    ("--plots", |given| given.plots, &[Form::Plots]),
    ("--at", |given| !given.at.is_empty(), &[Form::Page, Form::Picture, Form::Dxf]),
    ("--trace", |given| !given.trace.is_empty(), &[Form::Page, Form::Picture, Form::Dxf]),
    ("--vectors", |given| given.vectors, &[Form::Page, Form::Picture]),
    ("--forces", |given| given.forces, &[Form::Page, Form::Picture, Form::Plots]),
    ("--labels", |given| given.labels, &[Form::Page, Form::Picture]),
    ("--size", |given| given.size.is_some(), &[Form::Page, Form::Picture, Form::Plots]),
    ("--scale", |given| given.scale.is_some(), &[Form::Picture, Form::Dxf]),
    ("--theme", |given| given.theme != ThemeChoice::Auto, &[Form::Page, Form::Picture, Form::Plots]),
    ("--body", |given| given.body.is_some(), &[Form::Picture, Form::Dxf]),
];

/// Returns the first given option that a form does not have; for `None`, the first given option.
pub(super) fn unsupported_option(form: Option<Form>, arguments: &ViewArguments) -> Option<&'static str> {
    let lacks = |forms: &[Form]| form.is_none_or(|form| !forms.contains(&form));
    OPTIONS.iter().find(|(_, is_given, forms)| is_given(arguments) && lacks(forms)).map(|(option, ..)| *option)
}

/// Returns the form of a file name; fails if the options do not fit it.
pub(super) fn form(output: &str, arguments: &ViewArguments) -> Result<Form, Failure> {
    let form =
        if output == "-" || output_format::is_special(output) { Form::Picture } else { form_of_extension(output)? };
    if form != Form::Page && !arguments.vary.is_empty() {
        return Err(unusable(format!("`--vary` is for pages, and `{output}` is none"))
            .help("name a `.html` file, or set the param with `--set`")
            .into());
    }
    let with_plots = arguments.plots || is_plots_name(output);
    let unsupported = |form| unsupported_option(Some(form), arguments);
    match form {
        Form::Picture if with_plots => match unsupported(Form::Plots) {
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
        Form::Page => match unsupported(Form::Page) {
            None => Ok(Form::Page),
            Some(option) => Err(unusable(format!("`{option}` is for pictures and DXF, and `{output}` is a page"))
                .help("name a `.svg` or `.dxf` file")
                .into()),
        },
        Form::Dxf => match unsupported(Form::Dxf) {
            None => Ok(Form::Dxf),
            Some(option) => Err(unusable(format!("`{option}` is for what is looked at, and `{output}` is to be cut"))
                .help("leave it out, or name a `.svg` file")
                .into()),
        },
        form => Ok(form),
    }
}

/// Returns whether a file is called `plots.svg` or `NAME.plots.svg`.
fn is_plots_name(output: &str) -> bool {
    let stem = Path::new(output).file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    stem.is_some_and(|stem| stem.rsplit('.').next() == Some("plots"))
}

/// Formats that other programs convert to: their extensions, the output to write, and the command that converts it. `NAME` stands for the
/// name of the file without its extension, `END` for the extension.
const CONVERSIONS: [(&[&str], &str, &str); 4] = [
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

/// Returns the form of a file name's extension.
fn form_of_extension(output: &str) -> Result<Form, Failure> {
    output_format::by_extension(output, &FORMS).ok_or_else(|| {
        let (path, listed) = (Path::new(output), format!("the endings are {}", output_format::list_extensions(&FORMS)));
        let Some(ending) = path.extension().map(|ending| ending.to_string_lossy()) else {
            let message = format!("`{output}` has no ending, and so it is not said what to draw");
            return unusable(message).help(listed).into();
        };
        let refusal =
            unusable(format!("`{output}` ends in `.{ending}`, which is nothing that `view` writes")).help(listed);
        let conversion =
            CONVERSIONS.iter().find(|(endings, ..)| endings.iter().any(|one| ending.eq_ignore_ascii_case(one)));
        let Some((_, drawn, how)) = conversion else { return refusal.into() };
        let name = path.with_extension("");
        let filled = |text: &str| text.replace("NAME", &name.to_string_lossy()).replace("END", &ending.to_lowercase());
        refusal.help(format!("write `-o {}`, and have it converted: {}", filled(drawn), filled(how))).into()
    })
}

#[cfg(test)]
mod tests {
    use super::is_plots_name;

    #[test]
    fn plots_have_their_names() {
        for (output, expected) in [
            ("plots.svg", true),
            ("a/Plots.svg", true),
            ("a.plots.svg", true),
            ("allplots.svg", false),
            ("plots/a.svg", false),
        ] {
            assert_eq!(is_plots_name(output), expected, "{output}");
        }
    }
}
