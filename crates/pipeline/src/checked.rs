//! The second stage: a mechanism whose names, units and values are known.

use super::again::Again;
use super::asked::Asked;
use super::lead::Leading;
use super::lowered::lowered;
use super::used::{self, Used};
use super::used_at::UsedAt;
use super::{Compiled, Parsed, Redundant};
use mechc_emit as emit;
use mechc_lang::check::{self, Given, Library, Setting, Surroundings, Symbols, TableFiles, UNTIL};
use mechc_lang::model::Mechanism;
use mechc_syntax::{self as syntax, ast};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Applies, Code, Diagnostic, Diagnostics, Fix, nearest};
use mechc_text::source::{FileId, Sources, Span};
use mechc_text::world::{self, World};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// What messages call the settings of what varies.
pub(super) const VARY: &str = "--vary";
pub(super) const TOL: &str = "--tol";

/// What messages call results that the command line adds.
const RESULT: &str = "--result";

/// Which mechanism of a file is meant, and what is set in it from outside.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Its name; needed where there are several.
    pub mechanism: Option<String>,
    /// `NAME=FORMULA`; the last of one name counts.
    pub set: Vec<String>,
    /// Whether it is assembled with the file's own values, and led over to those of `set` along the branch.
    pub lead: bool,
    /// The same of what varies from one run to the next, over those of `set`: messages name it so.
    pub varied: Vec<String>,
    /// The same of how far params may be off, as if they were so large.
    pub off: Vec<String>,
    /// What inputs are: `NAME=FORMULA`, each name once.
    pub inputs: Vec<String>,
    /// A CSV file with samples of inputs.
    pub samples: Option<PathBuf>,
    /// Results beside those of the text: `NAME = FORMULA`, each as if the text held it.
    pub results: Vec<String>,
    /// What a variant is looked for by: a condition over results and params.
    pub until: Option<String>,
    /// Inputs and parameters by which all columns are differentiated, each as columns of its own, behind all others.
    pub by: Vec<String>,
    /// Whether results are differentiated by these too, as further results behind their own; and if so, whether the first and the last time
    /// of the analysis are what the text says, which may go with parameters.
    pub slopes: Option<[bool; 2]>,
    /// Whether what all joints exert and all drivers supply is tabulated.
    pub reactions: bool,
    /// Whether pictures are to show forces, where there are any.
    pub pictures_forces: bool,
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
    pub(super) parsed: Parsed,
    /// Its number in the file.
    pub(super) number: Option<usize>,
    pub(super) library: Library,
    pub(super) model: Option<Arc<Mechanism>>,
    /// What leads it to the inputs that it is told, if it is told any.
    leading: Option<Arc<Leading>>,
    /// Whether it is led to what is set, from the values of its text.
    is_led: bool,
    /// What it was checked with.
    pub(super) surroundings: Arc<Surroundings>,
    diagnostics: Arc<Diagnostics>,
    symbols: Arc<OnceLock<Symbols>>,
    pub(super) asked: Arc<Asked>,
}

impl Parsed {
    /// Checks one of its mechanisms.
    #[must_use]
    pub fn check(&self, choice: &Choice, world: &dyn World) -> Checked {
        Checked::of(self, choice, world)
    }

    /// Checks each of its mechanisms, in order; the files that it uses are read once. One alone without any mechanism where there is none.
    #[must_use]
    pub fn check_each(&self, world: &dyn World) -> Vec<Checked> {
        if self.mechanisms().len() == 0 {
            return vec![self.check(&Choice::default(), world)];
        }
        let used = used::read(self, world);
        let of_number = |number| Checked::of_number(self, &used, number, &Choice::default(), world);
        (0..self.mechanisms().len()).map(of_number).collect()
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
        let used = used::read(self, world);
        let all = (0..self.mechanisms().len())
            .map(|number| Checked::of_number(self, &used, number, &Choice::default(), world));
        all.flat_map(|checked| certain(checked.diagnostics())).collect()
    }
}

impl Checked {
    fn of(parsed: &Parsed, choice: &Choice, world: &dyn World) -> Checked {
        let used = used::read(parsed, world);
        match chosen(parsed, &used, choice.mechanism.as_deref()) {
            Ok(number) => Checked::of_number(parsed, &used, number, choice, world),
            Err(why) => {
                let mut diagnostics = parsed.faults().clone();
                // a mechanism that cannot be read may be the one
                let is_read = diagnostics.is_empty();
                diagnostics.extend(check::check_file(parsed.tree()));
                diagnostics.extend(used.said.clone());
                diagnostics.extend((is_read && !diagnostics.has_errors()).then_some(*why));
                let library = used.library;
                Checked::with(parsed.with_sources(used.sources), None, library, None, diagnostics)
            }
        }
    }

    /// The mechanism of a number, with settings from outside.
    pub(super) fn of_number(
        parsed: &Parsed,
        used: &Used,
        number: usize,
        choice: &Choice,
        world: &dyn World,
    ) -> Checked {
        let (mut sources, library) = (used.sources.clone(), used.library.clone());
        let mut diagnostics = parsed.faults().clone();
        diagnostics.extend(check::check_file(parsed.tree()));
        diagnostics.extend(used.said.clone());
        let more = asked_results(choice, &mut sources).unwrap_or_else(|why| {
            diagnostics.extend(why);
            Vec::new()
        });
        let parsed = &parsed.with_items(number, more);
        let tree = &parsed.tree().mechanisms[number];
        let settings = settings(choice, &mut sources);
        let given = given(choice, world, &mut sources);
        let files = table_files(&library, with_parts(&library, tree, &sources), world, &mut sources);
        let is_led = choice.lead && !choice.set.is_empty();
        let spaceless = |name: &String| syntax::normalized(name).chars().filter(|c| !c.is_whitespace()).collect();
        let by = choice.by.iter().map(spaceless).collect();
        match (settings, given) {
            (Err(why), Ok(_)) | (Ok(_), Err(why)) => diagnostics.extend(why),
            (Err(why), Err(more)) => {
                diagnostics.extend(why);
                diagnostics.extend(more);
            }
            (Ok(settings), Ok(given)) => {
                let library = library.clone();
                let Choice { reactions, pictures_forces, slopes, .. } = *choice;
                let surroundings = Surroundings {
                    settings,
                    library,
                    files,
                    given,
                    by,
                    slopes,
                    reactions,
                    pictures_forces,
                    ..Surroundings::default()
                };
                let parsed = parsed.with_sources(sources);
                return Checked::in_surroundings(parsed, number, surroundings, is_led, diagnostics);
            }
        }
        Checked::with(parsed.with_sources(sources), Some(number), library, None, diagnostics)
    }

    /// The mechanism of a number with all that it is checked with, and whether it is led to its settings; behind what is to be said already.
    pub(super) fn in_surroundings(
        parsed: Parsed,
        number: usize,
        surroundings: Surroundings,
        is_led: bool,
        mut diagnostics: Diagnostics,
    ) -> Checked {
        let (found, said) = check::check(&parsed.tree().mechanisms[number], &surroundings, parsed.sources());
        diagnostics.extend(said);
        let model = found.filter(|_| !diagnostics.has_errors()).map(Arc::new);
        let has_parts = model.as_ref().is_some_and(|model| !model.parts.is_empty());
        let is_told = !surroundings.given.is_empty();
        let leading = (is_told || has_parts).then(|| {
            let (read, sources, surroundings) = (parsed.shared(), parsed.sources().clone(), surroundings.clone());
            Arc::new(Leading { read, number, surroundings, sources, is_told })
        });
        let library = surroundings.library.clone();
        let checked = Checked::with(parsed, Some(number), library, model, diagnostics);
        Checked { leading, is_led, surroundings: Arc::new(surroundings), ..checked }
    }

    /// Its model with more params set, and nothing else; with the texts that say what they are.
    pub(super) fn model_led_to(
        &self,
        settings: impl IntoIterator<Item = Setting>,
        sources: &Sources,
    ) -> (Option<Mechanism>, Diagnostics) {
        let Some(tree) = self.tree() else { return (None, self.parsed.faults().clone()) };
        let mut surroundings = (*self.surroundings).clone();
        surroundings.settings.extend(settings);
        check::check(tree, &surroundings, sources)
    }

    /// Whether it is told inputs.
    pub(super) fn is_told(&self) -> bool {
        !self.surroundings.given.is_empty()
    }

    /// The same with more params set, over those that are set already, to which it is led; with the texts that say what they are.
    pub(super) fn led_to(&self, settings: impl IntoIterator<Item = Setting>, sources: &Sources) -> Checked {
        let Some(number) = self.number else { return self.clone() };
        let mut surroundings = (*self.surroundings).clone();
        surroundings.settings.extend(settings);
        let parsed = self.parsed.with_sources(sources.clone());
        Checked::in_surroundings(parsed, number, surroundings, true, Diagnostics::default())
    }

    /// The same without what a variant is looked for by.
    pub(super) fn without_until(&self) -> Checked {
        let Some(number) = self.number else { return self.clone() };
        let is_until =
            |item: &ast::Item| matches!(&item.kind, ast::ItemKind::Result { name, .. } if name.text == UNTIL);
        let parsed = self.parsed.without_items(number, is_until);
        Checked::in_surroundings(parsed, number, (*self.surroundings).clone(), self.is_led, Diagnostics::default())
    }

    /// What it takes to have the mechanism once more.
    fn again(&self) -> Option<Again> {
        Some(Again::new(self.parsed.clone(), self.number?, Arc::clone(&self.surroundings)))
    }

    fn with(
        parsed: Parsed,
        number: Option<usize>,
        library: Library,
        model: Option<Arc<Mechanism>>,
        mut diagnostics: Diagnostics,
    ) -> Checked {
        diagnostics.sort_by_place();
        let (diagnostics, surroundings, symbols) = (Arc::new(diagnostics), Arc::default(), Arc::default());
        let (leading, is_led, asked) = Default::default();
        Checked { parsed, number, library, model, leading, is_led, surroundings, diagnostics, symbols, asked }
    }

    /// The texts that its diagnostics speak of.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        self.parsed.sources()
    }

    /// Its own text among them.
    #[must_use]
    pub fn file(&self) -> FileId {
        self.parsed.file()
    }

    /// The place of the mechanism: from its keyword to the brace that closes it.
    #[must_use]
    pub fn span(&self) -> Option<Span> {
        Some(self.tree()?.span)
    }

    /// Whether another mechanism of its text has it for a part.
    #[must_use]
    pub fn is_part_of_another(&self) -> bool {
        let Some(own) = self.tree() else { return false };
        let is_it = |name: &ast::MechanismName| name.prefix.is_none() && name.name.text == own.name.text;
        self.parsed.tree().mechanisms.iter().any(|other| other.name != own.name && parts(other).any(is_it))
    }

    /// What it means; nothing where it is not sound.
    pub(super) fn model(&self) -> Option<&Mechanism> {
        self.model.as_deref()
    }

    /// What was written of it.
    #[must_use]
    pub fn tree(&self) -> Option<&ast::Mechanism> {
        self.parsed.tree().mechanisms.get(self.number?)
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
                let tree = self.parsed.tree();
                Symbols::of(&tree.mechanisms[number], &tree.uses, &self.sources().get(self.parsed.file()).text)
            }
        })
    }

    /// The files that its text uses, as far as they can be read: each with the place that names it.
    pub fn used_files(&self) -> impl Iterator<Item = (Span, FileId)> {
        let files = self.library.files();
        let own = files.iter().take(1).flat_map(|own| own.read.tree.uses.iter().zip(&own.uses));
        own.filter_map(|(used, number)| Some((used.path.as_ref()?.span, files[(*number)?].id)))
    }

    /// Which mechanisms its text may name; its own file is the first.
    #[must_use]
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// The files that its text names, and those that these name, whether or not its mechanism needs them: texts that are used, and
    /// tables.
    #[must_use]
    pub fn named_files(&self) -> Vec<PathBuf> {
        used::named_files(&self.library)
    }

    /// The mechanism with its names resolved, as a text; nothing where it is not sound.
    #[must_use]
    pub fn model_text(&self) -> Option<String> {
        self.model.as_ref().map(ToString::to_string)
    }

    /// Every equation with its derivatives, as a text, be they too many or too few; nothing where it is not sound.
    #[must_use]
    pub fn equations_text(&self) -> Option<String> {
        self.model.as_ref().map(|model| lowered(model).to_string())
    }

    /// The equations typeset for a report, be they too many or too few; nothing where it is not sound. The file is named in it.
    #[must_use]
    pub fn latex(&self, file: &str) -> Option<String> {
        let mut system = lowered(self.model.as_ref()?);
        let mechanics = system.mechanics();
        Some(emit::latex(&system, mechanics.as_ref(), false, file))
    }

    /// Its constraint system as data for other programs, likewise.
    #[must_use]
    pub fn json(&self, file: &str) -> Option<String> {
        let mut system = lowered(self.model.as_ref()?);
        let mechanics = system.mechanics();
        Some(emit::json(&system, mechanics.as_ref(), false, self.sources(), file))
    }

    /// Proves that it is determined, and compiles it; with what is to be said of that. Nothing where it is not sound, or not
    /// determined, or cancelled.
    #[must_use]
    pub fn compile(&self, redundant: Redundant, cancel: &Cancel) -> (Option<Compiled>, Diagnostics) {
        match &self.model {
            None => (None, Diagnostics::default()),
            Some(model) => {
                let (compiled, said) = self.compiled(model, redundant, cancel);
                let coupled = compiled.as_ref().map_or(Ok(Vec::new()), Compiled::coupled_parts);
                let (compiled, said) = match coupled {
                    Ok(coupled) if coupled.is_empty() => (compiled, said),
                    Ok(coupled) => match self.model_with_coupled(coupled) {
                        Some(model) => by_own_equations(self.compiled(&model, redundant, cancel)),
                        None => (None, said),
                    },
                    Err(more) => {
                        let mut said = said;
                        said.extend(more);
                        (None, said)
                    }
                };
                let over = self.is_led.then(|| self.begins_at_own(redundant));
                (compiled.map(|compiled| compiled.with_again(self.again()).led_over(over)), said)
            }
        }
    }

    fn compiled(&self, model: &Mechanism, redundant: Redundant, cancel: &Cancel) -> (Option<Compiled>, Diagnostics) {
        let (leading, used_at) = (self.leading.clone(), UsedAt::of(model));
        Compiled::of(self.sources().clone(), lowered(model), redundant, leading, used_at, cancel)
    }

    /// The model in which some parts ask for derivatives by their own equations though they move together with what is around them.
    fn model_with_coupled(&self, coupled: Vec<String>) -> Option<Mechanism> {
        let tree = &self.parsed.tree().mechanisms[self.number?];
        let surroundings = Surroundings { coupled, ..(*self.surroundings).clone() };
        check::check(tree, &surroundings, self.sources()).0
    }
}

/// A mechanism whose parts are held to their own equations, unless these do not determine them.
fn by_own_equations((compiled, mut said): (Option<Compiled>, Diagnostics)) -> (Option<Compiled>, Diagnostics) {
    match compiled.as_ref().map(Compiled::coupled_parts) {
        Some(Err(more)) => {
            said.extend(more);
            (None, said)
        }
        _ => (compiled, said),
    }
}

/// The only mechanism of some that is not a part of another one of them; each with the names of its parts. Where all are, one that
/// contains itself, of which that is to be told.
fn outermost(mechanisms: &[(&str, Vec<&str>)]) -> Option<usize> {
    let user = |name: &str| mechanisms.iter().position(|(other, parts)| *other != name && parts.contains(&name));
    let mut others = (0..mechanisms.len()).filter(|&number| user(mechanisms[number].0).is_none());
    match (others.next(), others.next()) {
        (Some(only), None) => Some(only),
        (Some(_), Some(_)) => None,
        // who goes from part to user so often has come round
        (None, _) if mechanisms.is_empty() => None,
        (None, _) => (0..mechanisms.len()).try_fold(0, |at, _| user(mechanisms[at].0)),
    }
}

fn chosen(parsed: &Parsed, used: &Used, wanted: Option<&str>) -> Result<usize, Box<Diagnostic>> {
    let names: Vec<&str> = parsed.mechanisms().collect();
    let with_parts: Vec<(&str, Vec<&str>)> = parsed.tree().mechanisms.iter().map(with_own_parts).collect();
    let listed = format!("the mechanisms are {}", names.join(", "));
    let file = &parsed.sources().get(parsed.file()).name;
    match wanted.map(syntax::normalized) {
        None => outermost(&with_parts).ok_or_else(|| {
            let said = Diagnostic::new(Code::E0704, format!("`{file}` holds {} mechanisms", names.len()));
            Box::new(said.help(format!("choose one with `--mechanism NAME`; {listed}")))
        }),
        Some(name) => names.iter().position(|known| *known == name).ok_or_else(|| {
            let meant = nearest(&name, names.iter().copied()).map(|name| format!("was `{name}` meant?"));
            let said = Diagnostic::new(Code::E0704, format!("`{file}` holds no mechanism `{name}`"));
            let elsewhere = used.library.file_of(&name).map(|other| &used.sources.get(other).name);
            let elsewhere = elsewhere.map(|other| format!("`{other}`, which it uses, holds it: name that file"));
            Box::new(said.help(elsewhere.or(meant).unwrap_or(listed)))
        }),
    }
}

/// The name of a mechanism, with the mechanisms of its own text that it has for parts.
fn with_own_parts(tree: &ast::Mechanism) -> (&str, Vec<&str>) {
    let own = parts(tree).filter(|name| name.prefix.is_none());
    (&tree.name.text, own.map(|name| name.name.text.as_str()).collect())
}

/// The mechanisms that a mechanism has for parts.
fn parts(tree: &ast::Mechanism) -> impl Iterator<Item = &ast::MechanismName> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ast::ItemKind::Part(part) => Some(&part.mechanism),
        _ => None,
    })
}

/// A mechanism and all that it has for parts, directly or by way of others, each once.
fn with_parts<'t>(library: &'t Library, tree: &'t ast::Mechanism, sources: &Sources) -> Vec<&'t ast::Mechanism> {
    let (mut found, mut next) = (vec![tree], 0);
    while let Some(tree) = found.get(next).copied() {
        next += 1;
        for name in parts(tree) {
            if let Ok(known) = library.find(name.prefix.as_ref(), &name.name, sources) {
                let part = library.tree(known);
                if !found.iter().any(|tree| tree.name.span == part.name.span) {
                    found.push(part);
                }
            }
        }
    }
    found
}

/// The files that the tables of some mechanisms name.
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

fn settings(choice: &Choice, sources: &mut Sources) -> Result<Vec<Setting>, Diagnostics> {
    let option = |option| NamedFormulas { option, example: "crank_length=60mm" };
    let mut formulas = option("--set").read(&choice.set, sources)?;
    formulas.extend(option(VARY).read(&choice.varied, sources)?);
    formulas.extend(option(TOL).read(&choice.off, sources)?);
    Ok(formulas.into_iter().map(|(path, value)| Setting { path, value }).collect())
}

/// The results that are asked for beside those of the text.
fn asked_results(choice: &Choice, sources: &mut Sources) -> Result<Vec<ast::Item>, Diagnostics> {
    let (mut said, mut items) = (Diagnostics::default(), Vec::new());
    for text in &choice.results {
        let file = sources.add_option(RESULT, format!("result {}", text.trim()));
        match syntax::parse_declaration(sources, file) {
            Ok(item) => items.push(item),
            Err(why) => said.extend(why),
        }
    }
    if let Some(condition) = &choice.until {
        let file = sources.add_option(UNTIL, condition.trim());
        match syntax::parse_expression(sources, file) {
            Ok(condition) => items.push(until(condition)),
            Err(why) => said.extend(why),
        }
    }
    if said.has_errors() { Err(said) } else { Ok(items) }
}

/// The result that is 1 for the variant that is looked for; no text can name it.
fn until(condition: ast::Expr) -> ast::Item {
    let span = condition.span;
    let number = |value| ast::Expr { kind: ast::ExprKind::Literal { value, unit: None }, span };
    let kind = ast::ExprKind::If { arms: vec![(condition, number(1.0))], otherwise: Box::new(number(0.0)) };
    let name = ast::Name { text: UNTIL.to_owned(), span };
    let kind = ast::ItemKind::Result { name, value: ast::Expr { kind, span }, unit: None };
    ast::Item { docs: Vec::new(), span, ranges: Vec::new(), kind }
}

/// What inputs are told to be.
fn given(choice: &Choice, world: &dyn World, sources: &mut Sources) -> Result<Given, Diagnostics> {
    let option = NamedFormulas { option: "--input", example: "turn='90 deg * t'" };
    let formulas = option.read(&choice.inputs, sources)?;
    let samples = match &choice.samples {
        None => None,
        Some(path) => Some(world::rows_given(world, path, sources).map_err(|why| *why)?),
    };
    Ok(Given { formulas, samples })
}

/// An option that gives formulas to names, each as `NAME=FORMULA`; `check` knows which names there are.
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
        let of = |mechanisms: &[(&str, &[&str])]| {
            let mechanisms: Vec<_> = mechanisms.iter().map(|(name, parts)| (*name, parts.to_vec())).collect();
            outermost(&mechanisms)
        };
        assert_eq!(of(&[("leg", &[])]), Some(0));
        assert_eq!(of(&[("leg", &[]), ("walker", &[])]), None);
        assert_eq!(of(&[("leg", &["foot"]), ("walker", &["leg", "leg"]), ("foot", &[])]), Some(1));
        assert_eq!(of(&[("leg", &[]), ("walker", &["leg"]), ("runner", &["leg"])]), None);
        // one that contains itself is no part of another; of those that contain each other one is taken, which tells it
        assert_eq!(of(&[("leg", &["leg"])]), Some(0));
        assert_eq!(of(&[("leg", &["foot"]), ("foot", &["leg"])]), Some(0));
        assert_eq!(of(&[("foot", &[]), ("egg", &["hen", "foot"]), ("hen", &["egg"])]), Some(1));
        assert_eq!(of(&[]), None);
    }
}
