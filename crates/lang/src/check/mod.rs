//! From the tree to the model: names, units, values and elements.
//!
//! The check continues after an error where it can, so that several errors give several messages. What depends on something broken gives
//! none. Formulas, including those of functions, are expanded into one graph at each use. Expansions are cached, so that functions with
//! common subformulas take linear time.

mod bare_names;
mod bindings;
mod branches;
mod builtins;
mod calls;
mod cli_formulas;
mod column_variables;
mod constants;
mod declaration_info;
mod definitions;
mod dimensions;
mod display_units;
mod elements;
mod entity;
mod errors;
mod features;
mod forces;
mod formula;
mod formula_scope;
mod free_names;
mod functions;
mod imports;
mod input_bindings;
mod inputs;
mod instance;
mod instantiation;
mod joints;
mod library;
mod names;
mod options;
mod overrides;
mod params;
mod part_placement;
mod parts;
mod point_kinds;
mod point_names;
mod points;
mod poses;
mod profiles;
mod quantities;
mod repetition;
mod requirements;
mod results;
mod samples;
mod scope;
mod suggest;
mod symbols;
mod table_file;
mod tables;
mod variables;

pub use cli_formulas::{FormulaOfTime, amount, constant, formula_of_time};
pub use declaration_info::{Amount, DeclarationCount, DeclarationInfo, Index, Value as ConstantValue, known, slopes};
pub(crate) use errors::not_finite;
pub use free_names::name_of;
pub use inputs::InputOverrides;
pub use library::{Library, LibraryFile, LibraryMechanism, LookupError};
pub use options::{CheckOptions, ParamOverride};
pub use overrides::override_matches;
pub use results::UNTIL;
pub use samples::{Column, variants};
pub use suggest::missing_unit::usual_unit_of_length;
pub use symbols::{DeclaredName, Meaning, NameId, NameKind, Symbols, Use};
pub use tables::TableFiles;

use crate::model::{Declared, EquationId, Frame, JointId, Mechanism};
use bindings::ExternalBindings;
use branches::Branch;
use calls::Calls;
use elements::MeasureState;
use errors::Reporter;
use formula_scope::FormulaScope;
use functions::Function;
use inputs::InputState;
use mechc_syntax::ast::{self, ItemKind};
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use names::Space;
use params::ParamState;
use parts::{Address, SharedState};
use results::ResultState;
use samples::Samples;
use scope::Scope;
use std::rc::Rc;
use suggest::missing_unit::RecordedLengths;
use tables::TableState;
use variables::Variables;

/// Checks that the mechanisms of a file have different names.
#[must_use]
pub fn check_file(file: &ast::File) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    let mut space: Space<()> = Space::new();
    let named = file.mechanisms.iter().filter(|mechanism| !mechanism.name.text.is_empty());
    for mechanism in named {
        if let Err(first) = space.declare(&mechanism.name, ()) {
            diagnostics.push(errors::second_mechanism(&mechanism.name, first));
        }
    }
    diagnostics
}

/// Checks a mechanism. Returns its model if it has no errors, and all diagnostics.
#[must_use]
pub fn check(tree: &ast::Mechanism, options: &CheckOptions, sources: &Sources) -> (Option<Mechanism>, Diagnostics) {
    let (instance, reported) = instantiation::instance_of(tree, options, sources);
    let mut checker = Checker::from_instance(&instance, options, sources, "", &[]);
    checker.bind_numbers(&options.bound);
    checker.common.variables = Variables::new(&options.by);
    checker.collect_variables();
    checker.run();
    let Checker { reporter: Reporter { mut diagnostics, .. }, mut model, .. } = checker;
    diagnostics.extend(reported);
    model.slopes = options.slopes.map(|is_of_text| {
        let formula = |end: usize| model.analysis.map(|analysis| analysis.formulas[end]).filter(|_| is_of_text[end]);
        [formula(0), formula(1)]
    });
    if instance.is_expanded() {
        diagnostics.dedup_by_span();
    }
    diagnostics.sort_by_span();
    let diagnostics = suggest::names::merge_unknown_names(diagnostics);
    let sound = !diagnostics.has_errors() && !has_broken(instance.tree());
    (sound.then_some(model), diagnostics)
}

impl Checker<'_> {
    /// Returns whether the mechanism or one of its parts has a declaration that could not be parsed.
    fn holds_broken(&self) -> bool {
        has_broken(self.scope.tree) || self.parts.iter().any(Checker::holds_broken)
    }
}

/// Returns whether a declaration or feature of a mechanism does not follow the grammar.
fn has_broken(tree: &ast::Mechanism) -> bool {
    tree.items.iter().any(|item| match &item.kind {
        ItemKind::Broken { .. } => true,
        ItemKind::Ground { features } | ItemKind::Body { features, .. } => {
            features.iter().any(|feature| feature.kind == ast::FeatureKind::Broken)
        }
        _ => false,
    })
}

/// Checks one mechanism, or one part of it.
struct Checker<'a> {
    options: &'a CheckOptions,
    reporter: Reporter<'a>,
    model: Mechanism,
    common: SharedState,
    scope: Scope<'a>,
    address: Address,
    bound: ExternalBindings<'a>,
    /// The checked parts.
    parts: Vec<Checker<'a>>,
    /// The declaration of each part.
    part_declarations: Vec<&'a ast::Part>,
    params: Vec<ParamState<'a>>,
    functions: Vec<Function<'a>>,
    tables: Vec<TableState<'a>>,
    inputs: Vec<InputState<'a>>,
    measures: Vec<MeasureState<'a>>,
    results: Vec<ResultState<'a>>,
    /// The orders of dependence of measures and of results.
    measure_order: Vec<usize>,
    result_order: Vec<usize>,
    /// The samples of inputs.
    samples: Option<Rc<Samples>>,
    /// The frames of bodies, then those of the grounds of parts that are named.
    bodies: Vec<Frame>,
    /// The bodies and the ground of this text.
    frames: Vec<(Frame, &'a [ast::Feature])>,
    joints: Vec<Option<JointId>>,
    /// Constraints and drivers; `None` for broken ones.
    equations: Vec<Option<EquationId>>,
    /// The constant lengths met so far.
    lengths: RecordedLengths<'a>,
    /// The site, the calls and the branch of the current formula.
    current: FormulaScope<'a>,
    calls: Calls<'a>,
    branch: Branch,
}

impl<'a> Checker<'a> {
    fn new(tree: &'a ast::Mechanism, options: &'a CheckOptions, sources: &'a Sources) -> Checker<'a> {
        Checker {
            options,
            reporter: Reporter::new(sources),
            model: Mechanism::new(Declared { name: tree.name.text.clone(), span: tree.name.span }, tree.docs.clone()),
            common: SharedState::default(),
            scope: Scope::new(tree),
            address: Address::default(),
            bound: ExternalBindings::default(),
            parts: Vec::new(),
            part_declarations: Vec::new(),
            params: Vec::new(),
            functions: Vec::new(),
            tables: Vec::new(),
            inputs: Vec::new(),
            measures: Vec::new(),
            results: Vec::new(),
            measure_order: Vec::new(),
            result_order: Vec::new(),
            samples: None,
            bodies: Vec::new(),
            frames: Vec::new(),
            joints: Vec::new(),
            equations: Vec::new(),
            lengths: RecordedLengths::default(),
            current: FormulaScope::default(),
            calls: Calls::default(),
            branch: Branch::default(),
        }
    }

    fn run(&mut self) {
        self.check_param_overrides();
        self.check_input_overrides();
        self.samples = self.read_samples().map(Rc::new);
        self.definitions();
        self.resolve_column_variables();
        self.features();
        self.joints();
        self.bind_inputs();
        // Efforts refer to equations, which must then come first. Otherwise measures come first, as the order of symbols affects the last
        // bits of rows.
        let uses_efforts = self.uses_efforts();
        if uses_efforts {
            self.equations();
        }
        self.measure_values();
        self.list_measures();
        if !uses_efforts {
            self.equations();
        }
        self.gravity();
        self.loads();
        self.analysis();
        self.results();
        self.requirements();
        self.reject_derivatives_of_forces();
        self.warn_of_plain_lengths();
        if self.model.bodies.is_empty() && !self.holds_broken() {
            self.reporter.report(errors::empty(&self.scope.tree.name));
        }
    }
}
