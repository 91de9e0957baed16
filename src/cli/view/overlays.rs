//! Options of pictures that name elements of the mechanism: traced points and bodies.

use crate::cli::arguments::{ThemeChoice, ViewArguments};
use crate::cli::failure::{Failure, unusable};
use mechc_draw::scene::{Anchor, Scene};
use mechc_draw::view::svg::{Options, Theme};
use mechc_pipeline::Visualization;
use mechc_text::diag::{Code, Diagnostic, nearest};

/// Returns the options of an SVG.
pub(super) fn svg_options(arguments: &ViewArguments, visualization: &Visualization) -> Result<Options, Failure> {
    let scene = &visualization.scene;
    let theme = match arguments.theme {
        ThemeChoice::Auto => Theme::Auto,
        ThemeChoice::Light => Theme::Light,
        ThemeChoice::Dark => Theme::Dark,
    };
    let traces = arguments.trace.iter().map(|path| trace(scene, path)).collect::<Result<Vec<_>, Failure>>()?;
    let errors = visualization.messages().filter(|message| message.is_error());
    let messages = errors.flat_map(message_lines).collect();
    let ViewArguments { size, scale, vectors, forces, labels, .. } = *arguments;
    Ok(Options { size, scale, theme, traces, vectors, forces, labels, captions: Vec::new(), messages })
}

/// Returns the lines of an error below a picture. The notes of E0601 are included, since they name the lengths that do not fit.
fn message_lines(error: &Diagnostic) -> impl Iterator<Item = String> {
    let notes = error.notes.iter().filter(|_| error.code == Code::E0601).cloned();
    std::iter::once(format!("error[{}]: {}", error.code, error.message)).chain(notes)
}

/// Formats a suggestion of a similar name.
fn suggest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    nearest(name, names).map(|suggestion| format!("was `{suggestion}` meant?"))
}

/// Finds a point by its path.
pub(super) fn trace(scene: &Scene, path: &str) -> Result<(String, Anchor), Failure> {
    let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some(point) = scene.point_named(&path) {
        return Ok((path, Anchor { frame: point.frame, at: point.at }));
    }
    let names = || scene.points.iter().filter(|point| point.frame > 0).map(|point| point.name.as_str());
    let help = suggest(&path, names()).unwrap_or_else(|| match names().next() {
        Some(example) => format!("name a point of a body, as in `--trace {example}`"),
        None => "its bodies have no points that have a name".to_owned(),
    });
    Err(unusable(format!("there is no point `{path}` to trace")).help(help).into())
}

/// Finds the frame of a body by its name.
pub(super) fn frame(scene: &Scene, name: &str) -> Result<usize, Failure> {
    let bodies = || scene.frames.iter().skip(1).filter_map(|declaration| scene.declarations.get(*declaration));
    if let Some(number) = bodies().position(|body| body.name == name) {
        return Ok(number + 1);
    }
    let names = || bodies().map(|body| body.name.as_str());
    let help = suggest(name, names()).unwrap_or_else(|| {
        let some: Vec<String> = names().take(8).map(|name| format!("`{name}`")).collect();
        format!("its bodies are {}", some.join(", "))
    });
    Err(unusable(format!("there is no body `{name}` to draw")).help(help).into())
}
