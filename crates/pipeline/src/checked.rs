//! The second stage: a mechanism whose names, units and values are resolved. Proves nothing about its equations.

use crate::compiled::Origin;
use crate::continuation::StartSolver;
use crate::imports::{self, Imports};
use crate::lowering::lower_model;
use crate::options::spaceless;
use crate::part_backtrace::PartBacktrace;
use crate::{Compiled, Parsed, Redundant};
use mechc_emit as emit;
use mechc_ir::ConstraintSystem;
use mechc_lang::check::{
    self, CheckOptions, DeclarationInfo, InputOverrides, Library, ParamOverride, Symbols, TableFiles, UNTIL,
};
use mechc_lang::lower::{Inputs, LowerOptions, TabulatedForces};
use mechc_lang::model::Mechanism;
use mechc_lang::settable_inputs::SettableInputs;
use mechc_syntax::{self as syntax, ast};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Applicability, Code, Diagnostic, Diagnostics, Fix, nearest};
use mechc_text::source::{FileId, Sources, Span};
use mechc_text::world::{self, World};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Options as messages name them.
pub(crate) const VARY: &str = "--vary";
pub(crate) const TOL: &str = "--tol";

/// The option for results that the command line adds.
const RESULT: &str = "--result";

/// Selects a mechanism of a file, and holds what options set in it.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Its name; required if no mechanism of the file is outermost.
    pub mechanism: Option<String>,
    /// Params: `NAME=FORMULA`; the last setting of a name counts.
    pub set: Vec<String>,
    /// True if the mechanism is assembled with its nominal values, and continued to those of `set` along its branch.
    pub lead: bool,
    /// Params that vary from run to run, set over those of `set`; messages name them so.
    pub varied: Vec<String>,
    /// Deviations of params that have tolerances, set as if they were values.
    pub deviations: Vec<String>,
    /// Inputs: `NAME=FORMULA`, each name once.
    pub inputs: Vec<String>,
    /// A CSV file with samples of inputs.
    pub samples: Option<PathBuf>,
    /// Results in addition to those of the text: `NAME = FORMULA`.
    pub results: Vec<String>,
    /// The search condition of a sweep, over results and params.
    pub until: Option<String>,
    /// Inputs and params by which all columns are differentiated; the derivatives are columns after all others.
    pub by: Vec<String>,
    /// True if results are differentiated by these too, as results after all others. The two flags tell whether the first and the last time of
    /// the analysis are those of the text, which may depend on params.
    pub slopes: Option<[bool; 2]>,
    /// The treatment of the requirements of the text; see [`crate::Run::results`].
    pub requirements: Requirements,
    /// True if the reactions of all joints and the efforts of all drivers are tabulated.
    pub reactions: bool,
    /// True if pictures show forces, if there are any.
    pub pictures_forces: bool,
}

/// The treatment of the requirements of a text.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Requirements {
    /// They are checked for mistakes alone.
    #[default]
    Unjudged,
    /// They are judged with the results.
    Judged,
}

/// Caches what the first query of an editor computes.
#[derive(Debug, Default)]
pub(crate) struct QueryCache {
    /// Facts about its declarations.
    pub facts: OnceLock<DeclarationInfo>,
    /// Its equations; `None` inside if it has errors.
    pub lowered: OnceLock<Option<ConstraintSystem>>,
}

/// A mechanism that was checked, with errors or without.
///
/// ```
/// use mechc::{Choice, Memory, Parsed};
///
/// let parsed = Parsed::new("lever.mech", "mechanism lever { body bar { point P = (1 m, 0) } driver d: angle(bra) = t }");
/// let checked = parsed.check(&Choice::default(), &Memory::default());
/// assert!(!checked.is_sound());
/// assert_eq!(checked.diagnostics().iter().map(|diagnostic| diagnostic.code.as_str()).collect::<Vec<_>>(), ["E0201"]);
/// ```
#[derive(Clone, Debug)]
pub struct Checked {
    pub(crate) parsed: Parsed,
    /// Index of the mechanism in its file; `None` if none was selected.
    pub(crate) index: Option<usize>,
    pub(crate) library: Library,
    pub(crate) model: Option<Arc<Mechanism>>,
    /// True if it is continued from the values of its text to those that are set.
    is_continued: bool,
    /// The options of its check.
    pub(crate) check_options: Arc<CheckOptions>,
    /// The forces that are tabulated in addition to those of measures.
    forces: TabulatedForces,
    /// The inputs that are settable numbers in its models.
    pub(crate) settable_inputs: Option<Arc<SettableInputs>>,
    diagnostics: Arc<Diagnostics>,
    symbols: Arc<OnceLock<Symbols>>,
    pub(crate) query_cache: Arc<QueryCache>,
}

impl Parsed {
    /// Checks one of its mechanisms.
    #[must_use]
    pub fn check(&self, choice: &Choice, world: &dyn World) -> Checked {
        Checked::new(self, choice, world)
    }

    /// Checks all its mechanisms, in order, and reads the files that they use once. Returns one stage without a mechanism if there is none.
    #[must_use]
    pub fn check_each(&self, world: &dyn World) -> Vec<Checked> {
        if self.mechanisms().len() == 0 {
            return vec![self.check(&Choice::default(), world)];
        }
        let imports = imports::read(self, world);
        let from_index = |index| Checked::from_index(self, &imports, index, &Choice::default(), world);
        (0..self.mechanisms().len()).map(from_index).collect()
    }

    /// Returns the fixes that always apply: those of syntax errors; if there are none, those of all mechanisms.
    #[must_use]
    pub fn certain_fixes(&self, world: &dyn World) -> Vec<Fix> {
        let certain = |diagnostics: &Diagnostics| -> Vec<Fix> {
            let fixes = diagnostics.iter().flat_map(|diagnostic| &diagnostic.fixes);
            fixes.filter(|fix| fix.applies == Applicability::Always).cloned().collect()
        };
        let of_syntax = certain(self.faults());
        if !of_syntax.is_empty() {
            return of_syntax;
        }
        let imports = imports::read(self, world);
        let all = (0..self.mechanisms().len())
            .map(|index| Checked::from_index(self, &imports, index, &Choice::default(), world));
        all.flat_map(|checked| certain(checked.diagnostics())).collect()
    }
}

impl Checked {
    fn new(parsed: &Parsed, choice: &Choice, world: &dyn World) -> Checked {
        let imports = imports::read(parsed, world);
        match selected_mechanism(parsed, &imports, choice.mechanism.as_deref()) {
            Ok(index) => Checked::from_index(parsed, &imports, index, choice, world),
            Err(why) => {
                let mut diagnostics = parsed.faults().clone();
                // a mechanism that cannot be read may be the selected one
                let is_read = diagnostics.is_empty();
                diagnostics.extend(check::check_file(parsed.tree()));
                diagnostics.extend(imports.diagnostics.clone());
                diagnostics.extend((is_read && !diagnostics.has_errors()).then_some(*why));
                let library = imports.library;
                Checked::from_model(parsed.with_sources(imports.sources), None, library, None, diagnostics)
            }
        }
    }

    /// Checks the mechanism at an index, with what the options set.
    pub(crate) fn from_index(
        parsed: &Parsed,
        imports: &Imports,
        index: usize,
        choice: &Choice,
        world: &dyn World,
    ) -> Checked {
        let (mut sources, library) = (imports.sources.clone(), imports.library.clone());
        let mut diagnostics = parsed.faults().clone();
        diagnostics.extend(check::check_file(parsed.tree()));
        diagnostics.extend(imports.diagnostics.clone());
        let more = option_results(choice, &mut sources).unwrap_or_else(|why| {
            diagnostics.extend(why);
            Vec::new()
        });
        let parsed = &parsed.with_items(index, more);
        let tree = &parsed.tree().mechanisms[index];
        let settings = settings(choice, &mut sources);
        let given = given(choice, world, &mut sources);
        let files = table_files(&library, with_parts(&library, tree, &sources), world, &mut sources);
        let is_continued = choice.lead && !choice.set.is_empty();
        let by = choice.by.iter().map(|name| spaceless(name)).collect();
        match (settings, given) {
            (Err(why), Ok(_)) | (Ok(_), Err(why)) => diagnostics.extend(why),
            (Err(why), Err(more)) => {
                diagnostics.extend(why);
                diagnostics.extend(more);
            }
            (Ok(settings), Ok(given)) => {
                let library = library.clone();
                let Choice { reactions, pictures_forces, slopes, .. } = *choice;
                let check_options = CheckOptions {
                    settings,
                    library,
                    files,
                    given,
                    by,
                    slopes,
                    judges_requirements: choice.requirements == Requirements::Judged,
                    ..CheckOptions::default()
                };
                let parsed = parsed.with_sources(sources);
                let forces = TabulatedForces { reactions, for_pictures: pictures_forces };
                let checked = Checked::with_check_options(parsed, index, check_options, is_continued, diagnostics);
                return Checked { forces, ..checked };
            }
        }
        Checked::from_model(parsed.with_sources(sources), Some(index), library, None, diagnostics)
    }

    /// Checks the mechanism at an index with all options of the checker. `diagnostics` are reported first.
    pub(crate) fn with_check_options(
        parsed: Parsed,
        index: usize,
        check_options: CheckOptions,
        is_continued: bool,
        mut diagnostics: Diagnostics,
    ) -> Checked {
        let (model, of_check) = check::check(&parsed.tree().mechanisms[index], &check_options, parsed.sources());
        diagnostics.extend(of_check);
        let model = model.filter(|_| !diagnostics.has_errors()).map(Arc::new);
        let library = check_options.library.clone();
        let checked = Checked::from_model(parsed, Some(index), library, model, diagnostics);
        Checked { is_continued, check_options: Arc::new(check_options), ..checked }
    }

    /// Checks the mechanism with other options of the checker, to be continued to what is set if `is_continued`.
    pub(crate) fn checked_again(&self, check_options: CheckOptions, is_continued: bool) -> Option<Checked> {
        let checked = Checked::with_check_options(
            self.parsed.clone(),
            self.index?,
            check_options,
            is_continued,
            Diagnostics::default(),
        );
        Some(Checked { forces: self.forces, ..checked })
    }

    /// Returns the mechanism with another model of its text, as `settings` make it, whose formulas are in `sources`.
    pub(crate) fn bound(&self, model: Arc<Mechanism>, settings: Vec<ParamOverride>, sources: Sources) -> Checked {
        let check_options = Arc::new(CheckOptions { settings, ..(*self.check_options).clone() });
        let (parsed, query_cache) = (self.parsed.with_sources(sources), Arc::default());
        Checked { parsed, model: Some(model), is_continued: true, check_options, query_cache, ..self.clone() }
    }

    /// Returns the mechanism assembled with its own values, without continuation.
    pub(crate) fn not_continued(&self) -> Checked {
        Checked { is_continued: false, ..self.clone() }
    }

    /// Returns the mechanism with params of the given names as symbols of its models, too, without a model of its own.
    pub(crate) fn with_open_params(&self, names: &[String]) -> Checked {
        let mut options = (*self.check_options).clone();
        options.open.extend(names.iter().filter(|name| !self.check_options.open.contains(name)).cloned());
        Checked { check_options: Arc::new(options), model: None, ..self.clone() }
    }

    /// Returns the model with more params set, whose formulas are in `sources`.
    pub(crate) fn model_with(
        &self,
        settings: impl IntoIterator<Item = ParamOverride>,
        sources: &Sources,
    ) -> (Option<Mechanism>, Diagnostics) {
        let Some(tree) = self.tree() else { return (None, self.parsed.faults().clone()) };
        let mut check_options = (*self.check_options).clone();
        check_options.settings.extend(settings);
        let (mut model, mut diagnostics) = check::check(tree, &check_options, sources);
        if let (Some(settable), Some(whole)) = (&self.settable_inputs, &mut model)
            && let Err(why) = settable.add_to(whole)
        {
            diagnostics.push(*why);
            model = None;
        }
        (model, diagnostics)
    }

    /// Returns the mechanism with inputs of its models as settable numbers.
    ///
    /// # Errors
    /// An input is not finite at the time of the settable inputs.
    pub(crate) fn with_settable_inputs(mut self, inputs: SettableInputs) -> Result<Checked, Box<Diagnostic>> {
        self.model.as_mut().map_or(Ok(()), |model| inputs.add_to(Arc::make_mut(model)))?;
        Ok(Checked { settable_inputs: Some(Arc::new(inputs)), ..self })
    }

    /// Returns whether options give inputs.
    pub(crate) fn has_given_inputs(&self) -> bool {
        !self.check_options.given.is_empty()
    }

    /// Checks the mechanism with more params set over those that are set already, to be continued to them. Their formulas are in `sources`.
    pub(crate) fn continued_to(&self, settings: impl IntoIterator<Item = ParamOverride>, sources: &Sources) -> Checked {
        let mut check_options = (*self.check_options).clone();
        check_options.settings.extend(settings);
        let checked = Checked { parsed: self.parsed.with_sources(sources.clone()), ..self.clone() };
        checked.checked_again(check_options, true).unwrap_or(checked)
    }

    /// Returns the mechanism without the search condition of a sweep.
    pub(crate) fn without_until(&self) -> Checked {
        let Some(index) = self.index else { return self.clone() };
        let is_until =
            |item: &ast::Item| matches!(&item.kind, ast::ItemKind::Result { name, .. } if name.text == UNTIL);
        let parsed = self.parsed.without_items(index, is_until);
        let checked = Checked { parsed, ..self.clone() };
        checked.checked_again((*self.check_options).clone(), self.is_continued).unwrap_or(checked)
    }

    fn from_model(
        parsed: Parsed,
        index: Option<usize>,
        library: Library,
        model: Option<Arc<Mechanism>>,
        mut diagnostics: Diagnostics,
    ) -> Checked {
        diagnostics.sort_by_span();
        let (diagnostics, check_options, symbols) = (Arc::new(diagnostics), Arc::default(), Arc::default());
        let (forces, settable_inputs, is_continued, query_cache) = Default::default();
        Checked {
            parsed,
            index,
            library,
            model,
            is_continued,
            check_options,
            forces,
            settable_inputs,
            diagnostics,
            symbols,
            query_cache,
        }
    }

    /// Returns the texts that its diagnostics point into.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        self.parsed.sources()
    }

    /// Returns the id of its own text.
    #[must_use]
    pub fn file(&self) -> FileId {
        self.parsed.file()
    }

    /// Returns the span of the mechanism, from its keyword to its closing brace.
    #[must_use]
    pub fn span(&self) -> Option<Span> {
        Some(self.tree()?.span)
    }

    /// Returns whether another mechanism of its text uses it as a part.
    #[must_use]
    pub fn is_part_of_another(&self) -> bool {
        let Some(tree) = self.tree() else { return false };
        let is_part = |name: &ast::MechanismName| name.prefix.is_none() && name.name.text == tree.name.text;
        self.parsed.tree().mechanisms.iter().any(|other| other.name != tree.name && parts(other).any(is_part))
    }

    /// Returns the model; `None` if the mechanism has errors.
    pub(crate) fn model(&self) -> Option<&Mechanism> {
        self.model.as_deref()
    }

    /// Returns the syntax tree of the mechanism.
    #[must_use]
    pub fn tree(&self) -> Option<&ast::Mechanism> {
        self.parsed.tree().mechanisms.get(self.index?)
    }

    /// Returns the diagnostics of all stages so far, those of the syntax included.
    #[must_use]
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Returns whether it has no errors, and can be compiled.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.model.is_some()
    }

    /// Returns its names, each with its declaration and its uses.
    #[must_use]
    pub fn symbols(&self) -> &Symbols {
        self.symbols.get_or_init(|| match self.index {
            None => Symbols::default(),
            Some(index) => {
                let tree = self.parsed.tree();
                Symbols::of(&tree.mechanisms[index], &tree.uses, &self.sources().get(self.parsed.file()).text)
            }
        })
    }

    /// Returns the files that its text uses and that can be read, each with the span that names it.
    pub fn used_files(&self) -> impl Iterator<Item = (Span, FileId)> {
        let files = self.library.files();
        let imports = files.iter().take(1).flat_map(|file| file.read.tree.uses.iter().zip(&file.uses));
        imports.filter_map(|(import, index)| Some((import.path.as_ref()?.span, files[(*index)?].id)))
    }

    /// Returns the files whose mechanisms its text may name; its own file is the first.
    #[must_use]
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// Returns the paths of all files that its text names, directly or through others: `use`d texts, and tables. Files that the mechanism does
    /// not need are included.
    #[must_use]
    pub fn named_files(&self) -> Vec<PathBuf> {
        imports::named_files(&self.library)
    }

    /// Returns the model as a text; `None` if the mechanism has errors.
    #[must_use]
    pub fn model_text(&self) -> Option<String> {
        self.model.as_ref().map(ToString::to_string)
    }

    /// Returns all equations with their derivatives as a text, even if the mechanism is not determined; `None` if it has errors.
    #[must_use]
    pub fn equations_text(&self) -> Option<String> {
        self.lowered().map(|system| system.to_string())
    }

    /// Returns the equations as LaTeX, even if the mechanism is not determined; `None` if it has errors. `file` is named in the output.
    #[must_use]
    pub fn latex(&self, file: &str) -> Option<String> {
        let mut system = self.lowered()?;
        let mechanics = system.mechanics();
        Some(emit::latex(&system, mechanics.as_ref(), false, file))
    }

    /// Returns the constraint system as JSON, even if the mechanism is not determined; `None` if it has errors.
    #[must_use]
    pub fn json(&self, file: &str) -> Option<String> {
        let mut system = self.lowered()?;
        let mechanics = system.mechanics();
        Some(emit::json(&system, mechanics.as_ref(), false, self.sources(), file))
    }

    /// Returns its equations, even if the mechanism is not determined; `None` if it has errors.
    pub(crate) fn lowered(&self) -> Option<ConstraintSystem> {
        let options = LowerOptions { forces: self.forces, ..LowerOptions::default() };
        self.model.as_ref().map(|model| lower_model(model, &options))
    }

    /// Returns what finds the starting position of its model, if that has parts or is given inputs.
    fn start_solver(&self, model: &Arc<Mechanism>) -> Option<Arc<StartSolver>> {
        let has_given_inputs = self.has_given_inputs();
        (has_given_inputs || !model.parts.is_empty()).then(|| {
            let (model, check_options) = (Arc::clone(model), Arc::clone(&self.check_options));
            Arc::new(StartSolver { model, check_options, sources: self.sources().clone(), has_given_inputs })
        })
    }

    /// Returns what its model is compiled from.
    pub(crate) fn origin(&self, model: &Arc<Mechanism>, redundant: Redundant) -> Origin {
        Origin {
            sources: self.sources().clone(),
            model: Arc::clone(model),
            forces: self.forces,
            start_solver: self.start_solver(model),
            backtrace: PartBacktrace::new(model),
            redundant,
        }
    }

    /// Proves that the mechanism is determined, and compiles it; returns the diagnostics of that. `None` if it has errors, is not determined, or
    /// the work is cancelled.
    #[must_use]
    pub fn compile(&self, redundant: Redundant, cancel: &Cancel) -> (Option<Compiled>, Diagnostics) {
        match &self.model {
            None => (None, Diagnostics::default()),
            Some(model) => {
                let origin = self.origin(model, redundant);
                let system = origin.lowered(Inputs::Inlined);
                let (mut compiled, mut diagnostics) = origin.compile(system, cancel);
                if let Some(Err(why)) = compiled.as_ref().map(|compiled| compiled.determined().check_part_derivatives())
                {
                    diagnostics.extend(why);
                    compiled = None;
                }
                let continuation = self.is_continued.then(|| self.continuation(redundant));
                (compiled.map(|compiled| compiled.with_continuation(continuation)), diagnostics)
            }
        }
    }
}

/// Returns the index of the only mechanism that is no part of another one; each is given with the names of its parts. If all are parts, one
/// that contains itself, so that the cycle is reported.
fn outermost(mechanisms: &[(&str, Vec<&str>)]) -> Option<usize> {
    let user = |name: &str| mechanisms.iter().position(|(other, parts)| *other != name && parts.contains(&name));
    let mut others = (0..mechanisms.len()).filter(|&index| user(mechanisms[index].0).is_none());
    match (others.next(), others.next()) {
        (Some(only), None) => Some(only),
        (Some(_), Some(_)) => None,
        // as many steps as there are mechanisms, from part to user, end in a cycle
        (None, _) if mechanisms.is_empty() => None,
        (None, _) => (0..mechanisms.len()).try_fold(0, |at, _| user(mechanisms[at].0)),
    }
}

fn selected_mechanism(parsed: &Parsed, imports: &Imports, requested: Option<&str>) -> Result<usize, Box<Diagnostic>> {
    let names: Vec<&str> = parsed.mechanisms().collect();
    let with_parts: Vec<(&str, Vec<&str>)> = parsed.tree().mechanisms.iter().map(with_local_parts).collect();
    let listed = format!("the mechanisms are {}", names.join(", "));
    let file = &parsed.sources().get(parsed.file()).name;
    match requested.map(syntax::normalized) {
        None => outermost(&with_parts).ok_or_else(|| {
            let diagnostic = Diagnostic::new(Code::E0704, format!("`{file}` holds {} mechanisms", names.len()));
            Box::new(diagnostic.help(format!("choose one with `--mechanism NAME`; {listed}")))
        }),
        Some(name) => names.iter().position(|other| *other == name).ok_or_else(|| {
            let suggestion = nearest(&name, names.iter().copied()).map(|name| format!("was `{name}` meant?"));
            let diagnostic = Diagnostic::new(Code::E0704, format!("`{file}` holds no mechanism `{name}`"));
            let elsewhere = imports.library.file_of(&name).map(|other| &imports.sources.get(other).name);
            let elsewhere = elsewhere.map(|other| format!("`{other}`, which it uses, holds it: name that file"));
            Box::new(diagnostic.help(elsewhere.or(suggestion).unwrap_or(listed)))
        }),
    }
}

/// Returns the name of a mechanism, and those of its parts that are declared in the same text.
fn with_local_parts(tree: &ast::Mechanism) -> (&str, Vec<&str>) {
    let local = parts(tree).filter(|name| name.prefix.is_none());
    (&tree.name.text, local.map(|name| name.name.text.as_str()).collect())
}

/// Returns the mechanisms that a mechanism uses as parts.
fn parts(tree: &ast::Mechanism) -> impl Iterator<Item = &ast::MechanismName> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ast::ItemKind::Part(part) => Some(&part.mechanism),
        _ => None,
    })
}

/// Returns a mechanism and all its parts at all levels, each once.
fn with_parts<'t>(library: &'t Library, tree: &'t ast::Mechanism, sources: &Sources) -> Vec<&'t ast::Mechanism> {
    let (mut trees, mut next) = (vec![tree], 0);
    while let Some(tree) = trees.get(next).copied() {
        next += 1;
        for name in parts(tree) {
            if let Ok(place) = library.find(name.prefix.as_ref(), &name.name, sources) {
                let part = library.tree(place);
                if !trees.iter().any(|tree| tree.name.span == part.name.span) {
                    trees.push(part);
                }
            }
        }
    }
    trees
}

/// Reads the files that the tables of some mechanisms name.
fn table_files<'t>(
    library: &Library,
    trees: impl IntoIterator<Item = &'t ast::Mechanism>,
    world: &dyn World,
    sources: &mut Sources,
) -> TableFiles {
    let mut files = TableFiles::default();
    for item in trees.into_iter().flat_map(|tree| &tree.items) {
        let ast::ItemKind::Table { rows: ast::TableRows::File { path, .. }, .. } = &item.kind else { continue };
        files.entry((path.span.file, path.text.clone())).or_insert_with(|| {
            let path = world::beside(&library.path_of(path.span.file).to_string_lossy(), &path.text);
            world::text_of(world, &path, sources)
        });
    }
    files
}

fn settings(choice: &Choice, sources: &mut Sources) -> Result<Vec<ParamOverride>, Diagnostics> {
    let option = |option| NamedFormulas { option, example: "crank_length=60mm" };
    let mut formulas = option("--set").read(&choice.set, sources)?;
    formulas.extend(option(VARY).read(&choice.varied, sources)?);
    formulas.extend(option(TOL).read(&choice.deviations, sources)?);
    Ok(formulas.into_iter().map(|(path, value)| ParamOverride { path, value }).collect())
}

/// Returns the results that options add to those of the text.
fn option_results(choice: &Choice, sources: &mut Sources) -> Result<Vec<ast::Item>, Diagnostics> {
    let (mut diagnostics, mut items) = (Diagnostics::default(), Vec::new());
    for text in &choice.results {
        let file = sources.add_option(RESULT, format!("result {}", text.trim()));
        match syntax::parse_declaration(sources, file) {
            Ok(item) => items.push(item),
            Err(why) => diagnostics.extend(why),
        }
    }
    if let Some(condition) = &choice.until {
        let file = sources.add_option(UNTIL, condition.trim());
        match syntax::parse_expression(sources, file) {
            Ok(condition) => items.push(until(condition)),
            Err(why) => diagnostics.extend(why),
        }
    }
    if diagnostics.has_errors() { Err(diagnostics) } else { Ok(items) }
}

/// Returns the result that is 1 for the variant that is searched for; its name is not valid in a text.
fn until(condition: ast::Expr) -> ast::Item {
    let span = condition.span;
    let number = |value| ast::Expr { kind: ast::ExprKind::Literal { value, unit: None }, span };
    let kind = ast::ExprKind::If { arms: vec![(condition, number(1.0))], otherwise: Box::new(number(0.0)) };
    let name = ast::Name { text: UNTIL.to_owned(), span };
    let kind = ast::ItemKind::Result { name, value: ast::Expr { kind, span }, unit: None };
    ast::Item { docs: Vec::new(), span, ranges: Vec::new(), kind }
}

/// Returns the inputs that options give.
fn given(choice: &Choice, world: &dyn World, sources: &mut Sources) -> Result<InputOverrides, Diagnostics> {
    let option = NamedFormulas { option: "--input", example: "turn='90 deg * t'" };
    let formulas = option.read(&choice.inputs, sources)?;
    let samples = match &choice.samples {
        None => None,
        Some(path) => Some(world::read_rows(world, path, sources).map_err(|why| *why)?),
    };
    Ok(InputOverrides { formulas, samples })
}

/// An option that gives formulas to names, as `NAME=FORMULA`; `check` decides which names exist.
struct NamedFormulas {
    option: &'static str,
    example: &'static str,
}

impl NamedFormulas {
    fn read(&self, given: &[String], sources: &mut Sources) -> Result<Vec<(String, ast::Expr)>, Diagnostics> {
        let (mut diagnostics, mut formulas) = (Diagnostics::default(), Vec::new());
        for text in given {
            let Some((name, value)) = text.split_once('=') else {
                let &NamedFormulas { option, example } = self;
                diagnostics.push(
                    Diagnostic::new(Code::E0706, format!("`{option} {text}` sets nothing"))
                        .help(format!("write `{option} NAME=VALUE`, as in `{option} {example}`")),
                );
                continue;
            };
            let name = syntax::normalized(name.trim());
            let file = sources.add_option(format!("{} {name}", self.option), value);
            match syntax::parse_expression(sources, file) {
                Ok(value) => formulas.push((name, value)),
                Err(faults) => diagnostics.extend(faults),
            }
        }
        if diagnostics.is_empty() { Ok(formulas) } else { Err(diagnostics) }
    }
}

#[cfg(test)]
mod tests {
    use super::outermost;

    #[test]
    fn the_outermost_mechanism_is_the_one_that_is_no_part_of_another() {
        let outermost_of = |mechanisms: &[(&str, &[&str])]| {
            let mechanisms: Vec<_> = mechanisms.iter().map(|(name, parts)| (*name, parts.to_vec())).collect();
            outermost(&mechanisms)
        };
        assert_eq!(outermost_of(&[("leg", &[])]), Some(0));
        assert_eq!(outermost_of(&[("leg", &[]), ("walker", &[])]), None);
        assert_eq!(outermost_of(&[("leg", &["foot"]), ("walker", &["leg", "leg"]), ("foot", &[])]), Some(1));
        assert_eq!(outermost_of(&[("leg", &[]), ("walker", &["leg"]), ("runner", &["leg"])]), None);
        // a mechanism that contains itself is no part of another; of a cycle one is taken, which reports it
        assert_eq!(outermost_of(&[("leg", &["leg"])]), Some(0));
        assert_eq!(outermost_of(&[("leg", &["foot"]), ("foot", &["leg"])]), Some(0));
        assert_eq!(outermost_of(&[("foot", &[]), ("egg", &["hen", "foot"]), ("hen", &["egg"])]), Some(1));
        assert_eq!(outermost_of(&[]), None);
    }
}
