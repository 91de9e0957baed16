//! From a file and its options to a determined system: what all commands begin with.

use super::arguments::Input;
use super::failure::Failure;
use super::files;
use super::report::Reporter;
use super::timings::{Phase, Timings};
use crate::analysis;
use crate::check::{self, Setting, Surroundings, TableFiles};
use crate::diag::{Code, Diagnostic, Diagnostics, nearest};
use crate::lower;
use crate::model::{Dimension, Mechanism};
use crate::source::{FileId, Sources};
use crate::structure::Determined;
use crate::syntax::{self, ast};

/// Reads and checks the mechanism of a command, lowers and proves it; prints its warnings.
pub(super) fn determined(
    input: &Input,
    allow_redundant: bool,
    reporter: &mut Reporter,
    timings: &mut Timings,
) -> Result<Determined, Failure> {
    let file = files::read(&input.file, &mut reporter.sources)?;
    determined_text(file, input, allow_redundant, reporter, timings)
}

/// As [`determined`], of a text that has been read.
pub(super) fn determined_text(
    file: FileId,
    input: &Input,
    allow_redundant: bool,
    reporter: &mut Reporter,
    timings: &mut Timings,
) -> Result<Determined, Failure> {
    let file = tree_of(file, reporter)?;
    timings.end(Phase::Parse);
    let model = checked(&file, input, reporter)?;
    timings.end(Phase::Check);
    let (determined, said) = analysis::determine(lower::lower(&model), allow_redundant)?;
    reporter.print(&said);
    timings.end(Phase::Prove);
    Ok(determined)
}

/// Reads and checks the mechanism of a command, which need not be determined; prints its warnings.
pub(super) fn model(input: &Input, reporter: &mut Reporter) -> Result<Mechanism, Failure> {
    let file = tree(input, reporter)?;
    checked(&file, input, reporter)
}

/// The tree of a command's file.
pub(super) fn tree(input: &Input, reporter: &mut Reporter) -> Result<ast::File, Failure> {
    let file = files::read(&input.file, &mut reporter.sources)?;
    tree_of(file, reporter)
}

fn tree_of(file: FileId, reporter: &Reporter) -> Result<ast::File, Failure> {
    let parsed = syntax::parse(&reporter.sources, file);
    if parsed.faults.is_empty() { Ok(parsed.tree) } else { Err(parsed.faults.into()) }
}

fn checked(file: &ast::File, input: &Input, reporter: &mut Reporter) -> Result<Mechanism, Failure> {
    let mut diagnostics = check::check_file(file);
    if diagnostics.has_errors() {
        return Err(diagnostics.into());
    }
    let mechanism = chosen(file, input)?;
    let settings = settings(&input.set, mechanism, &mut reporter.sources)?;
    let files = table_files(mechanism, &input.file, &mut reporter.sources);
    let (model, found) = check::check(mechanism, &Surroundings { settings, files }, &reporter.sources);
    diagnostics.extend(found);
    match model {
        None => Err(diagnostics.into()),
        Some(model) => {
            reporter.print(&diagnostics);
            Ok(model)
        }
    }
}

fn chosen<'t>(tree: &'t ast::File, input: &Input) -> Result<&'t ast::Mechanism, Failure> {
    let names: Vec<&str> = tree.mechanisms.iter().map(|mechanism| mechanism.name.text.as_str()).collect();
    let listed = format!("the mechanisms are {}", names.join(", "));
    let wanted = input.mechanism.as_deref().map(syntax::normalized);
    match (&wanted, tree.mechanisms.as_slice()) {
        (None, [only]) => Ok(only),
        (None, _) => Err(Diagnostic::new(Code::E0704, format!("`{}` holds {} mechanisms", input.file, names.len()))
            .help(format!("choose one with `--mechanism NAME`; {listed}"))
            .into()),
        (Some(name), all) => all.iter().find(|mechanism| mechanism.name.text == *name).ok_or_else(|| {
            let meant = nearest(name, names.iter().copied()).map(|name| format!("was `{name}` meant?"));
            Diagnostic::new(Code::E0704, format!("`{}` holds no mechanism `{name}`", input.file))
                .help(meant.unwrap_or(listed))
                .into()
        }),
    }
}

/// The files that a mechanism's tables name.
pub(super) fn table_files(mechanism: &ast::Mechanism, beside: &str, sources: &mut Sources) -> TableFiles {
    let mut files = TableFiles::default();
    for item in &mechanism.items {
        if let ast::ItemKind::Table { rows: ast::TableRows::File { path, .. }, .. } = &item.kind
            && !files.contains_key(&path.text)
        {
            files.insert(path.text.clone(), files::read_table(&path.text, beside, sources));
        }
    }
    files
}

fn settings(given: &[String], mechanism: &ast::Mechanism, sources: &mut Sources) -> Result<Vec<Setting>, Failure> {
    let params: Vec<&str> = mechanism
        .items
        .iter()
        .filter_map(|item| match &item.kind {
            ast::ItemKind::Param { name, .. } => Some(name.text.as_str()),
            _ => None,
        })
        .collect();
    let mut diagnostics = Diagnostics::default();
    let mut settings = Vec::new();
    for text in given {
        let Some((name, value)) = text.split_once('=') else {
            diagnostics.push(
                Diagnostic::new(Code::E0706, format!("`--set {text}` sets nothing"))
                    .help("write `--set NAME=VALUE`, as in `--set crank_length=60mm`"),
            );
            continue;
        };
        let name = syntax::normalized(name.trim());
        if !params.contains(&name.as_str()) {
            let meant = nearest(&name, params.iter().copied()).map(|name| format!("was `{name}` meant?"));
            let listed = if params.is_empty() {
                "it has no parameters".to_owned()
            } else {
                format!("its parameters are {}", params.join(", "))
            };
            let mechanism = &mechanism.name.text;
            diagnostics.push(
                Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no parameter `{name}`"))
                    .help(meant.unwrap_or(listed)),
            );
            continue;
        }
        let file = sources.add_option(format!("--set {name}"), value);
        match syntax::parse_expression(sources, file) {
            Ok(value) => settings.push(Setting { name, value }),
            Err(faults) => diagnostics.extend(faults),
        }
    }
    if diagnostics.is_empty() { Ok(settings) } else { Err(diagnostics.into()) }
}

/// A time of the command line (s): a number of seconds, or a formula with units.
pub(super) fn time(option: &str, text: &str, sources: &mut Sources) -> Result<f64, Failure> {
    let file = sources.add_option(option, text);
    let formula = syntax::parse_expression(sources, file)?;
    let place = format!("the value of `{option}`");
    Ok(check::constant(&formula, &place, Dimension::TIME, sources)?)
}
