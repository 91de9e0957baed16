//! The second stage: a mechanism whose names, units and values are known.

use super::signals::WithSignals;
use super::{Compiled, Parsed, Redundant};
use crate::cancel::Cancel;
use crate::check::{self, Given, Setting, Surroundings, Symbols, TableFiles};
use crate::diag::{Applies, Code, Diagnostic, Diagnostics, Fix, nearest};
use crate::lower;
use crate::model::Mechanism;
use crate::source::Sources;
use crate::syntax::{self, ast};
use crate::world::{self, World};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Which mechanism of a file is meant, and what is set in it from outside.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Its name; needed where there are several.
    pub mechanism: Option<String>,
    /// `NAME=FORMULA`; the last of one name counts.
    pub set: Vec<String>,
    /// What inputs are: `NAME=FORMULA`, each name once.
    pub inputs: Vec<String>,
    /// A CSV file with samples of inputs.
    pub samples: Option<PathBuf>,
}

/// A mechanism that was checked, whatever is wrong with it.
///
/// ```
/// use mechc::{Choice, Memory, Parsed};
///
/// let parsed = Parsed::of("lever.mech", "mechanism lever { body bar { point P = (1 m, 0) } driver d: angle(bra) = t }");
/// let checked = parsed.check(&Choice::default(), &Memory::default());
/// assert!(!checked.is_sound());
/// assert_eq!(checked.diagnostics().iter().map(|said| said.code.as_str()).collect::<Vec<_>>(), ["E0201"]);
/// ```
#[derive(Clone, Debug)]
pub struct Checked {
    parsed: Parsed,
    /// Its number in the file.
    number: Option<usize>,
    model: Option<Arc<Mechanism>>,
    /// What it was checked with.
    surroundings: Arc<Surroundings>,
    diagnostics: Arc<Diagnostics>,
    symbols: Arc<OnceLock<Symbols>>,
}

impl Parsed {
    /// Checks one of its mechanisms.
    #[must_use]
    pub fn check(&self, choice: &Choice, world: &dyn World) -> Checked {
        Checked::of(self, choice, world)
    }

    /// The changes of its text that its diagnostics propose and that always apply: those of the syntax, and where there are none, those of
    /// what the declarations of all its mechanisms mean.
    #[must_use]
    pub fn certain_fixes(&self, world: &dyn World) -> Vec<Fix> {
        let certain = |found: &Diagnostics| -> Vec<Fix> {
            let fixes = found.iter().flat_map(|diagnostic| &diagnostic.fixes);
            fixes.filter(|fix| fix.applies == Applies::Always).cloned().collect()
        };
        let of_syntax = certain(self.faults());
        if !of_syntax.is_empty() {
            return of_syntax;
        }
        let all =
            (0..self.mechanisms().len()).map(|number| Checked::of_number(self, number, &Choice::default(), world));
        all.flat_map(|checked| certain(checked.diagnostics())).collect()
    }
}

impl Checked {
    fn of(parsed: &Parsed, choice: &Choice, world: &dyn World) -> Checked {
        match chosen(parsed, choice.mechanism.as_deref()) {
            Ok(number) => Checked::of_number(parsed, number, choice, world),
            Err(why) => {
                let mut diagnostics = parsed.faults().clone();
                // a mechanism that cannot be read may be the one
                let is_read = diagnostics.is_empty();
                diagnostics.extend(check::check_file(parsed.tree()));
                diagnostics.extend((is_read && !diagnostics.has_errors()).then_some(*why));
                Checked::with(parsed.clone(), None, None, diagnostics)
            }
        }
    }

    /// The mechanism of a number, with settings from outside.
    fn of_number(parsed: &Parsed, number: usize, choice: &Choice, world: &dyn World) -> Checked {
        let mut sources = parsed.sources().clone();
        let mut diagnostics = parsed.faults().clone();
        diagnostics.extend(check::check_file(parsed.tree()));
        let tree = &parsed.tree().mechanisms[number];
        let settings = settings(&choice.set, tree, &mut sources);
        let given = given(choice, tree, world, &mut sources);
        let files = table_files(parsed, tree, world, &mut sources);
        let (mut model, mut surroundings) = (None, Surroundings::default());
        match (settings, given) {
            (Err(why), Ok(_)) | (Ok(_), Err(why)) => diagnostics.extend(why),
            (Err(why), Err(more)) => {
                diagnostics.extend(why);
                diagnostics.extend(more);
            }
            (Ok(settings), Ok(given)) => {
                surroundings = Surroundings { settings, files, given, has_signals: false };
                let (found, said) = check::check(tree, &surroundings, &sources);
                diagnostics.extend(said);
                model = found.filter(|_| !diagnostics.has_errors()).map(Arc::new);
            }
        }
        let checked = Checked::with(parsed.with_sources(sources), Some(number), model, diagnostics);
        Checked { surroundings: Arc::new(surroundings), ..checked }
    }

    /// The model in which inputs are signals, where there are any.
    fn with_signals(&self) -> Option<WithSignals> {
        let has_inputs = self.model.as_ref().is_some_and(|model| !model.inputs.is_empty());
        let surroundings = Surroundings { has_signals: true, ..(*self.surroundings).clone() };
        let number = self.number.filter(|_| has_inputs)?;
        Some(WithSignals::new(self.parsed.clone(), number, surroundings))
    }

    fn with(
        parsed: Parsed,
        number: Option<usize>,
        model: Option<Arc<Mechanism>>,
        mut diagnostics: Diagnostics,
    ) -> Checked {
        diagnostics.sort_by_place();
        let (diagnostics, surroundings, symbols) = (Arc::new(diagnostics), Arc::default(), Arc::default());
        Checked { parsed, number, model, surroundings, diagnostics, symbols }
    }

    /// The texts that its diagnostics speak of.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        self.parsed.sources()
    }

    /// All that is to be said of the text up to here, its faults included.
    #[must_use]
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Whether it can be compiled.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.model.is_some()
    }

    /// Its names, each with its declaration and its uses.
    #[must_use]
    pub fn symbols(&self) -> &Symbols {
        self.symbols.get_or_init(|| match self.number {
            None => Symbols::default(),
            Some(number) => {
                Symbols::of(&self.parsed.tree().mechanisms[number], &self.sources().get(self.parsed.file()).text)
            }
        })
    }

    /// The mechanism with its names resolved, as a text; nothing where it is not sound.
    #[must_use]
    pub fn model_text(&self) -> Option<String> {
        self.model.as_ref().map(ToString::to_string)
    }

    /// Every equation with its derivatives, as a text, be they too many or too few; nothing where it is not sound.
    #[must_use]
    pub fn equations_text(&self) -> Option<String> {
        self.model.as_ref().map(|model| lower::lower(model).to_string())
    }

    /// Proves that it is determined, and compiles it; with what is to be said of that. Nothing where it is not sound, or not
    /// determined, or cancelled.
    #[must_use]
    pub fn compile(&self, redundant: Redundant, cancel: &Cancel) -> (Option<Compiled>, Diagnostics) {
        match &self.model {
            None => (None, Diagnostics::default()),
            Some(model) => {
                let (compiled, said) = Compiled::of(self.sources().clone(), lower::lower(model), redundant, cancel);
                (compiled.map(|compiled| compiled.with_signals(self.with_signals())), said)
            }
        }
    }
}

fn chosen(parsed: &Parsed, wanted: Option<&str>) -> Result<usize, Box<Diagnostic>> {
    let names: Vec<&str> = parsed.mechanisms().collect();
    let listed = format!("the mechanisms are {}", names.join(", "));
    let file = &parsed.sources().get(parsed.file()).name;
    match wanted.map(syntax::normalized) {
        None if names.len() == 1 => Ok(0),
        None => Err(Box::new(
            Diagnostic::new(Code::E0704, format!("`{file}` holds {} mechanisms", names.len()))
                .help(format!("choose one with `--mechanism NAME`; {listed}")),
        )),
        Some(name) => names.iter().position(|known| *known == name).ok_or_else(|| {
            let meant = nearest(&name, names.iter().copied()).map(|name| format!("was `{name}` meant?"));
            let said = Diagnostic::new(Code::E0704, format!("`{file}` holds no mechanism `{name}`"));
            Box::new(said.help(meant.unwrap_or(listed)))
        }),
    }
}

/// The files that a mechanism's tables name.
fn table_files(parsed: &Parsed, tree: &ast::Mechanism, world: &dyn World, sources: &mut Sources) -> TableFiles {
    let mut files = TableFiles::default();
    for item in &tree.items {
        if let ast::ItemKind::Table { rows: ast::TableRows::File { path, .. }, .. } = &item.kind
            && !files.contains_key(&path.text)
        {
            files.insert(path.text.clone(), world::text_of(world, &parsed.beside(&path.text), sources));
        }
    }
    files
}

fn settings(given: &[String], tree: &ast::Mechanism, sources: &mut Sources) -> Result<Vec<Setting>, Diagnostics> {
    let params: Vec<&str> = tree
        .items
        .iter()
        .filter_map(|item| match &item.kind {
            ast::ItemKind::Param { name, .. } => Some(name.text.as_str()),
            _ => None,
        })
        .collect();
    let option =
        NamedFormulas { option: "--set", noun: "parameter", example: "crank_length=60mm", names: Some(&params) };
    let formulas = option.read(given, tree, sources)?;
    let setting = |(path, value): (String, ast::Expr)| {
        let (name, coordinate) = name_and_coordinate(&path);
        Setting { name: name.to_owned(), coordinate, value }
    };
    Ok(formulas.into_iter().map(setting).collect())
}

/// What `NAME`, `NAME.x` or `NAME.y` names, and which of its coordinates.
fn name_and_coordinate(path: &str) -> (&str, Option<usize>) {
    let parts = path.split_once('.').map(|(name, coordinate)| (name.trim_end(), coordinate.trim_start()));
    let coordinate = parts.and_then(|(_, coordinate)| ["x", "y"].iter().position(|axis| coordinate == *axis));
    match (parts, coordinate) {
        (Some((name, _)), Some(_)) => (name, coordinate),
        _ => (path, None),
    }
}

/// What inputs are told to be.
fn given(
    choice: &Choice,
    tree: &ast::Mechanism,
    world: &dyn World,
    sources: &mut Sources,
) -> Result<Given, Diagnostics> {
    let option = NamedFormulas { option: "--input", noun: "input", example: "turn='90 deg * t'", names: None };
    let formulas = option.read(&choice.inputs, tree, sources)?;
    let samples = match &choice.samples {
        None => None,
        Some(path) => Some(world::text_of(world, path, sources).map_err(|why| *why)?),
    };
    Ok(Given { formulas, samples })
}

/// An option that gives formulas to names, each as `NAME=FORMULA`.
struct NamedFormulas<'n> {
    option: &'n str,
    /// What the names are of.
    noun: &'n str,
    example: &'n str,
    /// Those that there are, unless `check` asks for them.
    names: Option<&'n [&'n str]>,
}

impl NamedFormulas<'_> {
    fn read(
        &self,
        given: &[String],
        tree: &ast::Mechanism,
        sources: &mut Sources,
    ) -> Result<Vec<(String, ast::Expr)>, Diagnostics> {
        let (mut diagnostics, mut formulas) = (Diagnostics::default(), Vec::new());
        for text in given {
            let Some((name, value)) = text.split_once('=') else {
                let &NamedFormulas { option, example, .. } = self;
                diagnostics.push(
                    Diagnostic::new(Code::E0706, format!("`{option} {text}` sets nothing"))
                        .help(format!("write `{option} NAME=VALUE`, as in `{option} {example}`")),
                );
                continue;
            };
            let name = syntax::normalized(name.trim());
            if let Some(names) = self.names.filter(|names| !names.contains(&name_and_coordinate(&name).0)) {
                diagnostics.push(self.no_such_name(names, &tree.name.text, &name));
                continue;
            }
            let file = sources.add_option(format!("{} {name}", self.option), value);
            match syntax::parse_expression(sources, file) {
                Ok(value) => formulas.push((name, value)),
                Err(faults) => diagnostics.extend(faults),
            }
        }
        if diagnostics.is_empty() { Ok(formulas) } else { Err(diagnostics) }
    }

    fn no_such_name(&self, names: &[&str], mechanism: &str, name: &str) -> Diagnostic {
        let noun = self.noun;
        let meant = nearest(name, names.iter().copied()).map(|name| format!("was `{name}` meant?"));
        let listed = match names {
            [] => format!("it has no {noun}s"),
            _ => format!("its {noun}s are {}", names.join(", ")),
        };
        Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no {noun} `{name}`"))
            .help(meant.unwrap_or(listed))
    }
}
