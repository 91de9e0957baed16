//! The file to write, and what is drawn in it: by its name and its ending.

use crate::cli::arguments::ViewArguments;
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

/// What is drawn, by the name of a file and its ending.
pub(super) fn form(output: &str, arguments: &ViewArguments) -> Result<Form, Failure> {
    let form = if output == "-" || endings::is_special(output) { Form::Picture } else { form_of_ending(output)? };
    if form != Form::Page && !arguments.vary.is_empty() {
        return Err(unusable(format!("`--vary` is for pages, and `{output}` is none"))
            .help("name a `.html` file, or set the param with `--set`")
            .into());
    }
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

/// What a file of such a name holds.
fn form_of_ending(output: &str) -> Result<Form, Failure> {
    endings::known(output, &FORMS).ok_or_else(|| {
        let said = match Path::new(output).extension() {
            Some(ending) => {
                format!("`{output}` ends in `.{}`, which is nothing that `view` writes", ending.to_string_lossy())
            }
            None => format!("`{output}` has no ending, and so it is not said what to draw"),
        };
        unusable(said).help(format!("the endings are {}", endings::listed(&FORMS))).into()
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
