//! From the tree to the model: names, units, values, elements.
//!
//! Goes on after a mistake wherever it can, so that several mistakes are several messages; what depends on something
//! broken stays silent. A formula is expanded into the one graph where it stands, the user's functions included, and
//! each expansion is remembered, so that functions that share sub-formulas cost linear time.

mod arguments;
mod bindings;
mod bound_inputs;
mod builtins;
mod calls;
mod columns_by;
mod elements;
mod entity;
mod errors;
mod features;
mod forces;
mod formula;
mod imports;
mod inputs;
mod instance;
mod instances;
mod instead;
mod joints;
mod kinds;
mod known;
mod lead;
mod lengths;
mod library;
mod meaning;
mod meant;
mod mends;
mod mentions;
mod mounts;
mod named_points;
mod names;
mod parts;
mod points;
mod poses;
mod printed;
mod profiles;
mod quantities;
mod rates;
mod repetition;
mod results;
mod samples;
mod set_inputs;
mod sites;
mod symbols;
mod table_file;
mod tables;
mod told;
mod variables;

pub use inputs::Given;
pub use known::{Amount, Count, Index, Known, Value as KnownValue, known, slopes};
pub use lead::Lead;
pub use lengths::usual_unit_of_length;
pub use library::{KnownFile, KnownMechanism, Library, NotKnown};
pub use mentions::name_of;
pub use samples::{Column, variants};
pub use set_inputs::SetInputs;
pub use symbols::{DeclaredName, Meaning, NameId, NameKind, Symbols, Use};
pub use tables::TableFiles;

use crate::diag::{Diagnostic, Diagnostics};
use crate::expr::{Dependence, ExprId, Graph, Symbol};
use crate::model::{
    Condition, DecidedBy, Declared, Dimension, EquationId, Frame, JointId, Mechanism, Named, NamedId, Param, PartId,
    PointId,
};
use crate::source::{Sources, Span};
use crate::syntax::ast::{self, Expr, Item, ItemKind, Name, TableRows, WrittenUnit};
use crate::syntax::normalized;
use bindings::BoundParam;
use calls::{Call, Calls};
use entity::Entity;
use features::Feature;
use formula::{Context, Dim, Value};
use imports::Import;
use lengths::Lengths;
use mentions::mentioned;
use names::{Ordered, Space};
use results::ResultState;
use rustc_hash::{FxHashMap, FxHashSet};
use samples::Samples;
use sites::{Drawn, Scope};
use std::rc::Rc;
use tables::TableState;
use told::is_told_by;
use variables::Variables;

/// How many mistakes of one file are worth a suggestion.
const MOST_SUGGESTIONS: usize = 100;

/// What a mechanism is checked with, beside its own text.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Parameters set from outside.
    pub settings: Vec<Setting>,
    /// The files that it uses.
    pub library: Library,
    /// The files that its tables name.
    pub files: TableFiles,
    /// What inputs are told to be.
    pub given: Given,
    /// Of a part that stands alone: what is bound of its params (SI).
    pub bound: Vec<(String, f64)>,
    /// Where it is led, if that is all that is asked for.
    pub lead: Option<Lead>,
    /// The paths of parameters that may be set elsewhere than the text has them: they are symbols, also where they follow from others there,
    /// and the model says which they are.
    pub open: Vec<String>,
    /// Names by which all columns are differentiated.
    pub by: Vec<String>,
    /// Whether results are differentiated by these too, as further results; and if so, whether the first and the last time of the analysis
    /// are what the text says, which may go with parameters.
    pub slopes: Option<[bool; 2]>,
    /// Whether what all joints exert and all drivers supply is tabulated.
    pub reactions: bool,
    /// Whether pictures are to show forces.
    pub pictures_forces: bool,
    /// Whether inputs stay signals in the model, rather than being replaced by what they are.
    pub has_signals: bool,
    /// Inputs that are numbers which may be set.
    pub set_inputs: Option<SetInputs>,
    /// The paths of parts whose derivatives are by their own equations alone, though they move together with what is around them.
    pub coupled: Vec<String>,
}

/// A parameter's value from outside the file: `--set crank_length=60mm`.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The parameter, or a coordinate of one that is a point, with the parts before it; without a number it is meant in all copies.
    pub path: String,
    /// Its formula, which names nothing of the file.
    pub value: Expr,
}

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

/// The model of one mechanism, if it is sound, and all that is to be said of it.
#[must_use]
pub fn check(
    tree: &ast::Mechanism,
    surroundings: &Surroundings,
    sources: &Sources,
) -> (Option<Mechanism>, Diagnostics) {
    let (instance, told) = instances::instance_of(tree, surroundings, sources);
    let mut checker = Checker::of_instance(&instance, surroundings, sources, "", &[]);
    checker.bind_numbers(&surroundings.bound);
    checker.variables = Variables::told(&surroundings.by);
    checker.ask_for_derivatives();
    checker.run();
    let Checker { mut diagnostics, mut model, .. } = checker;
    diagnostics.extend(told);
    model.slopes = surroundings.slopes.map(|go| {
        let of_text = |end: usize| model.analysis.map(|analysis| analysis.formulas[end]).filter(|_| go[end]);
        [of_text(0), of_text(1)]
    });
    if instance.is_written_out() {
        diagnostics.tell_once();
    }
    diagnostics.sort_by_place();
    let diagnostics = meant::told_once(diagnostics);
    let sound = !diagnostics.has_errors() && !has_broken(instance.tree());
    (sound.then_some(model), diagnostics)
}

impl Checker<'_> {
    /// Whether something of the mechanism, or of its parts, could not be read.
    fn holds_broken(&self) -> bool {
        has_broken(self.tree) || self.parts.iter().any(Checker::holds_broken)
    }
}

/// Whether a declaration of a mechanism, or of its bodies, does not follow the grammar.
fn has_broken(tree: &ast::Mechanism) -> bool {
    tree.items.iter().any(|item| match &item.kind {
        ItemKind::Broken { .. } => true,
        ItemKind::Ground { features } | ItemKind::Body { features, .. } => {
            features.iter().any(|feature| feature.kind == ast::FeatureKind::Broken)
        }
        _ => false,
    })
}

/// The value in SI of a formula that names nothing of any file: a time of the command line.
///
/// # Errors
/// What is wrong with it.
pub fn constant(formula: &Expr, place: &str, wanted: Dimension, sources: &Sources) -> Result<f64, Diagnostics> {
    let tree = nothing(formula.span);
    let surroundings = Surroundings::default();
    let mut checker = Checker::new(&tree, &surroundings, sources);
    match checker.constant(formula, place, wanted) {
        Some((_, value)) if !checker.diagnostics.has_errors() => Ok(value),
        _ => Err(checker.diagnostics),
    }
}

/// A formula of time that names nothing of any file.
#[derive(Clone, Debug)]
pub struct FormulaOfTime {
    /// Holds the formula; its only symbol is time.
    pub graph: Graph,
    /// The formula, in SI.
    pub value: ExprId,
    /// Of its value; `None` for a plain formula, whose dimension says nothing.
    pub dimension: Option<Dimension>,
    /// What must be positive at a time, for the formula to have a meaning there.
    pub conditions: Vec<Condition>,
    /// What is to be said of it all the same.
    pub remarks: Diagnostics,
}

/// A formula alone, over time and the constants and functions of the language.
///
/// # Errors
/// What is wrong with it.
pub fn formula_of_time(formula: &Expr, sources: &Sources) -> Result<FormulaOfTime, Diagnostics> {
    let tree = nothing(formula.span);
    let surroundings = Surroundings::default();
    let mut checker = Checker::new(&tree, &surroundings, sources);
    let judged = checker.is_dimensional(formula);
    let context = Context { judged, time: true, names: false, ..Context::constant("a formula of time") };
    let value = checker.formula(formula, &context);
    let Checker { mut diagnostics, model, .. } = checker;
    diagnostics.sort_by_place();
    match value {
        Some(value) if !diagnostics.has_errors() => Ok(FormulaOfTime {
            graph: model.graph,
            value: value.id,
            dimension: judged.then(|| value.dim.settled()),
            conditions: model.conditions,
            remarks: diagnostics,
        }),
        _ => Err(diagnostics),
    }
}

/// A mechanism without any declaration, as the surroundings of a formula of the command line.
fn nothing(span: Span) -> ast::Mechanism {
    let name = Name { text: String::new(), span };
    ast::Mechanism { docs: Vec::new(), name, span, items: Vec::new() }
}

/// What is known of a user's function.
struct Function<'a> {
    argument: &'a Name,
    value: &'a Expr,
    /// Holds a unit, or something that does.
    dimensional: bool,
    /// Where time comes in, if it does.
    time: Option<Span>,
    /// Whether its formula can be read at all.
    sound: bool,
}

/// What is known of an input.
struct InputState<'a> {
    name: &'a Name,
    formula: &'a Expr,
    /// `None` before its turn, and where it is broken.
    value: Option<Value>,
}

/// What is known of a measure before its turn.
struct MeasureState<'a> {
    name: &'a Name,
    value: &'a Expr,
    /// In what it is printed, if that is said.
    unit: Option<&'a WrittenUnit>,
    dimensional: bool,
    sound: bool,
    /// How often an angle is a factor of it.
    angle: i32,
    /// Whether it holds a number that may stand for anything.
    holds_plain_number: bool,
}

impl<'a> MeasureState<'a> {
    fn of(name: &'a Name, value: &'a Expr, unit: Option<&'a WrittenUnit>) -> MeasureState<'a> {
        MeasureState { name, value, unit, dimensional: false, sound: false, angle: 0, holds_plain_number: false }
    }
}

struct Checker<'a> {
    tree: &'a ast::Mechanism,
    settings: &'a [Setting],
    files: &'a TableFiles,
    given: &'a Given,
    lead: Option<&'a Lead>,
    open: &'a [String],
    set_inputs: Option<&'a SetInputs>,
    by: &'a [String],
    coupled: &'a [String],
    sources: &'a Sources,
    diagnostics: Diagnostics,
    model: Mechanism,
    space: Space<Entity>,
    /// How many of each kind of thing have a name.
    count: names::Count,
    /// What its names begin with in the whole mechanism: `leg[2].`, or nothing.
    path: String,
    /// Of a part: what it is in the model, and what its ground is there.
    part: Option<PartId>,
    ground: Frame,
    /// Of a part: its name and those of the parts around it, and where they stand.
    used_at: Vec<(String, Span)>,
    /// Of a part: what is said of its params and inputs where it is used.
    bound_params: Vec<BoundParam<'a>>,
    bound_inputs: Vec<&'a str>,
    /// Its own parts, each with how it is written, and its names that are known here.
    parts: Vec<Checker<'a>>,
    bindings: Vec<&'a ast::Part>,
    imports: Vec<Vec<Import>>,
    imported: FxHashMap<Entity, (usize, Entity)>,
    /// Of those the params that are points.
    point_paths: FxHashSet<String>,
    /// What derivatives are taken by.
    variables: Variables,
    /// The params that decide what is repeated.
    deciding: Rc<FxHashSet<String>>,
    /// By the parameter's position; `None` where it is broken.
    params: Vec<Option<Value>>,
    /// Those of them that are points, by the same position.
    drawn: Vec<Option<Drawn>>,
    /// The names of params that are points.
    point_params: FxHashSet<&'a str>,
    /// The names of functions and tables that hide a function of the language.
    hidden: FxHashSet<&'a str>,
    /// Where the formula that is being read stands.
    scope: Scope<'a>,
    /// The points whose formulas hold a unit.
    dimensional_points: FxHashSet<PointId>,
    /// As the text has them, by the same position.
    param_formulas: Vec<(&'a Name, &'a Expr)>,
    functions: Vec<Function<'a>>,
    tables: Vec<TableState<'a>>,
    inputs: Vec<InputState<'a>>,
    measures: Vec<MeasureState<'a>>,
    /// The order in which measures need each other, and their values with what these ask for.
    measure_order: Vec<usize>,
    measure_values: Vec<(Option<Value>, Vec<Condition>)>,
    /// The samples that are given.
    samples: Option<Rc<Samples>>,
    /// Of bodies, and of the grounds of parts that are named.
    bodies: Vec<Frame>,
    /// The bodies and the ground of this text.
    frames: Vec<(Frame, &'a [ast::Feature])>,
    results: Vec<ResultState<'a>>,
    result_order: Vec<usize>,
    joints: Vec<Option<JointId>>,
    /// Constraints and drivers; `None` where one is broken.
    equations: Vec<Option<EquationId>>,
    features: FxHashMap<Frame, Space<Feature>>,
    /// The constant lengths come upon.
    lengths: Lengths<'a>,
    /// Bodies whose place in the drawing is not known.
    broken_poses: FxHashSet<Frame>,
    /// How often an angle is a factor of each parameter.
    param_angles: Vec<i32>,
    /// Parameters that are given in a unit of angle, with the places of their names.
    angle_params: FxHashMap<usize, Span>,
    named: FxHashMap<Named, NamedId>,
    /// How many time derivatives a named symbol holds.
    derivative_orders: Vec<u8>,
    /// Values of the graph's nodes, NaN where they are not constant.
    values: Vec<f64>,
    /// Expansions already made.
    known_calls: FxHashMap<Call, Option<Value>>,
    /// What those ask to be positive, where they do.
    conditions_of_calls: FxHashMap<Call, Vec<Condition>>,
    /// Those of the formula that is being read.
    calls: Calls<'a>,
    /// Where the outermost of the formulas being expanded was called.
    caller: Option<Span>,
    /// Parts visited for the current formula.
    visited: usize,
    /// In a branch that is never taken nothing is said of values.
    untaken: bool,
    /// The condition under which the branch that is being read counts.
    guard: Option<ExprId>,
}

impl<'a> Checker<'a> {
    fn new(tree: &'a ast::Mechanism, surroundings: &'a Surroundings, sources: &'a Sources) -> Checker<'a> {
        Checker {
            tree,
            settings: &surroundings.settings,
            files: &surroundings.files,
            given: &surroundings.given,
            lead: surroundings.lead.as_ref(),
            open: &surroundings.open,
            set_inputs: surroundings.set_inputs.as_ref(),
            by: &surroundings.by,
            coupled: &surroundings.coupled,
            sources,
            diagnostics: Diagnostics::default(),
            model: Mechanism {
                has_signals: surroundings.has_signals,
                reactions: surroundings.reactions,
                pictures_forces: surroundings.pictures_forces,
                ..Mechanism::new(Declared { name: tree.name.text.clone(), span: tree.name.span }, tree.docs.clone())
            },
            space: Space::new(),
            count: names::Count::default(),
            path: String::new(),
            part: None,
            ground: Frame::Ground,
            used_at: Vec::new(),
            bound_params: Vec::new(),
            bound_inputs: Vec::new(),
            parts: Vec::new(),
            bindings: Vec::new(),
            imports: Vec::new(),
            imported: FxHashMap::default(),
            point_paths: FxHashSet::default(),
            deciding: Rc::default(),
            variables: Variables::default(),
            params: Vec::new(),
            drawn: Vec::new(),
            point_params: kinds::point_params(tree),
            hidden: kinds::own_functions(tree),
            scope: Scope::default(),
            dimensional_points: FxHashSet::default(),
            param_formulas: Vec::new(),
            functions: Vec::new(),
            tables: Vec::new(),
            inputs: Vec::new(),
            measures: Vec::new(),
            measure_order: Vec::new(),
            measure_values: Vec::new(),
            samples: None,
            results: Vec::new(),
            result_order: Vec::new(),
            bodies: Vec::new(),
            frames: Vec::new(),
            joints: Vec::new(),
            equations: Vec::new(),
            features: FxHashMap::default(),
            lengths: Lengths::default(),
            broken_poses: FxHashSet::default(),
            param_angles: Vec::new(),
            angle_params: FxHashMap::default(),
            named: FxHashMap::default(),
            derivative_orders: Vec::new(),
            values: Vec::new(),
            known_calls: FxHashMap::default(),
            conditions_of_calls: FxHashMap::default(),
            calls: Calls::default(),
            caller: None,
            visited: 0,
            untaken: false,
            guard: None,
        }
    }

    fn run(&mut self) {
        self.look_over_settings();
        self.look_over_given();
        self.samples = self.samples_given().map(Rc::new);
        self.definitions();
        self.look_over_by();
        self.features();
        self.joints();
        self.bind_inputs();
        // an effort is that of an equation which is there; else measures come first, as the order of symbols, and with it the bits of
        // rows, has always been
        let asks_for_efforts = self.asks_for_efforts();
        if asks_for_efforts {
            self.equations();
        }
        self.measure_values();
        self.list_measures();
        if !asks_for_efforts {
            self.equations();
        }
        self.gravity();
        self.loads();
        self.analysis();
        self.results();
        self.refuse_derivatives_of_forces();
        self.leave_what_leads();
        self.warn_of_plain_lengths();
        if self.model.bodies.is_empty() && !self.holds_broken() {
            self.report(errors::empty(&self.tree.name));
        }
    }

    /// Says something, with the place of the call through which it came up.
    fn report(&mut self, diagnostic: Diagnostic) {
        let diagnostic = match self.caller {
            // a formula is judged where it is called
            Some(caller) => diagnostic.raised_by(caller, "brought in here"),
            None => diagnostic,
        };
        let parts = self.used_at.iter();
        self.diagnostics.push(parts.fold(diagnostic, |said, (part, span)| said.in_part(part, *span)));
    }

    /// Names to look for the nearest one among; none once so much is wrong that the search would take long.
    fn suggestions(&self, wanted: impl Fn(Entity) -> bool) -> Vec<&str> {
        self.suggestions_in(&self.space, wanted)
    }

    fn suggestions_in<'s, T: Copy>(&self, space: &'s Space<T>, wanted: impl Fn(T) -> bool) -> Vec<&'s str> {
        if self.diagnostics.len() > MOST_SUGGESTIONS { Vec::new() } else { space.names(wanted).collect() }
    }

    fn items(&self) -> &'a [Item] {
        &self.tree.items
    }

    /// Params, functions, tables and measures in the order in which they need each other: params and tables are evaluated
    /// and functions looked over; the order of the measures, and that of the results, is kept.
    fn definitions(&mut self) {
        let (mut definitions, mut docs, mut entities) = (Vec::new(), Vec::new(), Vec::new());
        for item in self.items() {
            if let Some((entity, name, formulas)) = self.definition(item, &entities) {
                entities.push(entity);
                definitions.push((name, formulas));
                docs.push(&item.docs);
            }
        }
        self.import_params();
        let uses = self.uses(&definitions, &entities);
        let Ordered { order, on_circles } = self.ordered(&uses);
        self.define_parts_on_circles(on_circles.iter().map(|&at| entities[at]));
        let (mut measures, mut results) = (Vec::new(), Vec::new());
        for at in order {
            let (name, formulas) = &definitions[at];
            match entities[at] {
                Entity::Param(k) => formulas.iter().for_each(|value| self.define_param(k, name, docs[at], value)),
                Entity::Function(k) => self.function(k),
                Entity::Table(k) => self.table(k),
                Entity::Input(k) => self.input(k),
                Entity::Part(k) if k < self.parts.len() => self.definitions_of_part(k),
                Entity::Measure(k) => {
                    self.measures[k].dimensional = formulas.iter().any(|value| self.is_dimensional(value));
                    measures.push(k);
                }
                Entity::Result(k) => {
                    self.results[k].dimensional = formulas.iter().any(|value| self.is_dimensional(value));
                    results.push(k);
                }
                _ => {}
            }
        }
        (self.measure_order, self.result_order) = (measures, results);
    }

    /// What a declaration defines, behind others, with its name and the formulas that it is made of; it gets its place, and no value yet.
    fn definition(&mut self, item: &'a Item, before: &[Entity]) -> Option<(Entity, &'a Name, Vec<&'a Expr>)> {
        Some(match &item.kind {
            ItemKind::Param { name, value } => {
                self.params.push(None);
                self.drawn.push(None);
                self.param_angles.push(0);
                self.param_formulas.push((name, value));
                (Entity::Param(self.params.len() - 1), name, vec![value])
            }
            ItemKind::Function { name, argument, value } => {
                self.functions.push(Function { argument, value, dimensional: false, time: None, sound: false });
                (Entity::Function(self.functions.len() - 1), name, vec![value])
            }
            ItemKind::Input { name, value } => {
                let given = self.given.formulas.iter();
                let own = format!("{}{}", self.path, name.text);
                let told = given.filter(|(told, _)| is_told_by(&own, told)).map(|(_, told)| told);
                let formulas = std::iter::once(value).chain(told).collect();
                self.inputs.push(InputState { name, formula: value, value: None });
                (Entity::Input(self.inputs.len() - 1), name, formulas)
            }
            ItemKind::Measure { name, value, unit } => {
                self.measures.push(MeasureState::of(name, value, unit.as_ref()));
                (Entity::Measure(self.measures.len() - 1), name, vec![value])
            }
            ItemKind::Result { name, value, unit } => {
                self.results.push(ResultState::of(value, unit.as_ref()));
                (Entity::Result(self.results.len() - 1), name, vec![value])
            }
            ItemKind::Table { name, periodic, rows } => {
                let periodic = *periodic;
                self.tables.push(TableState { name, periodic, rows, dimensional: false, made: None });
                let formulas = match rows {
                    TableRows::Listed(rows) => rows.iter().collect(),
                    TableRows::File { .. } => Vec::new(),
                };
                (Entity::Table(self.tables.len() - 1), name, formulas)
            }
            ItemKind::Part(part) => {
                let k = before.iter().filter(|entity| matches!(entity, Entity::Part(_))).count();
                let bindings = part.bindings.iter().filter(|binding| self.binds_definition(k, binding));
                (Entity::Part(k), &part.name, bindings.map(|binding| &binding.value).collect())
            }
            _ => return None,
        })
    }

    fn define_param(&mut self, k: usize, name: &Name, docs: &[String], value: &Expr) {
        self.remember_angle(name, value);
        if self.point_param(name) == Some(k) {
            self.drawn[k] = self.point_of_param(name, docs, value);
        } else {
            self.param_angles[k] = self.angle_power(value);
            self.params[k] = self.param(name, docs, value);
        }
    }

    /// Parts whose definitions go in a circle are what they are alone, so that all that they have is there.
    fn define_parts_on_circles(&mut self, on_circles: impl Iterator<Item = Entity>) {
        for entity in on_circles {
            if let Entity::Part(k) = entity
                && k < self.parts.len()
            {
                self.definitions_of_part_alone(k);
            }
        }
    }

    fn uses<'d>(
        &self,
        definitions: &[(&'d Name, Vec<&Expr>)],
        entities: &[Entity],
    ) -> Vec<(&'d Name, Vec<(usize, Span)>)> {
        let position: FxHashMap<Entity, usize> = entities.iter().enumerate().map(|(k, &e)| (e, k)).collect();
        let arguments: FxHashMap<usize, &str> = entities
            .iter()
            .enumerate()
            .filter_map(|(k, entity)| match entity {
                Entity::Function(f) => Some((k, self.functions[*f].argument.text.as_str())),
                _ => None,
            })
            .collect();
        definitions
            .iter()
            .enumerate()
            .map(|(k, (name, formulas))| {
                let mut uses = Vec::new();
                for formula in formulas {
                    mentioned(
                        formula,
                        |name| self.hidden.contains(name),
                        |used, is_called| {
                            // `speed(P)` is a quantity, whatever else is called `speed`
                            let is_of_motion =
                                self.quantity_word(used).is_some() || self.reduction_word(used, 1).is_some();
                            if is_called && is_of_motion {
                                return;
                            }
                            let hidden = arguments.get(&k) == Some(&used.text.as_str());
                            let is_own = !hidden && !self.is_declared_though_taken(used);
                            let entity = self.entity(used).filter(|_| is_own);
                            // what is in a part is known when the part is, but for what nothing here asks the number of
                            let part = used.text.split_once('.').and_then(|(part, _)| self.space.get(part));
                            let entity = match entity {
                                Some(Entity::Body(_) | Entity::Joint(_) | Entity::Equation(_) | Entity::Ground) => None,
                                entity => part.or(entity),
                            };
                            // no input may stand in what an option says of one, which is told there
                            let is_told = self.sources.get(used.span.file).is_option;
                            let entity = entity.filter(|entity| !(is_told && matches!(entity, Entity::Input(_))));
                            if let Some(&at) = entity.and_then(|e| position.get(&e)) {
                                uses.push((at, used.span));
                            }
                        },
                    );
                }
                (*name, uses)
            })
            .collect()
    }

    /// A parameter: one that depends on no other becomes a symbol, another one its formula.
    fn param(&mut self, name: &Name, docs: &[String], formula: &Expr) -> Option<Value> {
        let context = Context::constant("a parameter");
        let in_file = self.param_value(formula, context)?;
        if let Some(bound) = self.as_bound(name, in_file) {
            return bound;
        }
        let setting = self.settings_of(name).pop();
        let value = match setting {
            None => in_file,
            Some((Some(k), setting)) => {
                self.report(errors::coordinate_of_number(name, k, setting.value.span));
                return None;
            }
            Some((None, setting)) => {
                let given = self.param_value(&setting.value, Context { names: false, ..context })?;
                match (in_file.dim, given.dim) {
                    (Dim::Of(wanted), Dim::Of(found)) if !wanted.is(found) => {
                        let place = format!("the parameter `{}{}`", self.path, name.text);
                        let part = rates::Part { span: setting.value.span, dimension: found };
                        self.report(errors::wrong_dimension(
                            &place,
                            wanted,
                            part,
                            self.sources.text(setting.value.span),
                        ));
                        return None;
                    }
                    (Dim::Of(wanted), _) => Value { dim: Dim::Of(wanted), ..given },
                    (Dim::Any, _) => given,
                }
            }
        };
        self.settable(self.declared(name), &name.text, docs, value)
    }

    /// A number that is a parameter of the model, unless it follows from others.
    fn settable(&mut self, declared: Declared, name: &str, docs: &[String], value: Value) -> Option<Value> {
        let is_open = self.is_open(&declared, name);
        if self.follows(value.id) && !is_open {
            return Some(self.with_shift(&declared, value));
        }
        let number = self.number_of(value.id)?;
        // what decides how many declarations there are is not to be changed afterwards
        if self.deciding.contains(name) {
            self.constant_value(value.id);
            return Some(Value { id: self.model.graph.constant(number), dim: value.dim });
        }
        let index = self.model.params.len() as u32;
        self.note_param(&declared, Symbol::Param(index), value.dim);
        let dimension = match value.dim {
            Dim::Of(dimension) => dimension,
            Dim::Any => Dimension::PURE,
        };
        if is_open {
            self.open_param(&declared, number, dimension);
        }
        self.model.params.push(Param { declared, docs: docs.to_vec(), value: number, dimension });
        Some(Value { id: self.model.graph.symbol(Symbol::Param(index)), dim: value.dim })
    }

    /// A parameter that is a point: each of its coordinates is a parameter of the model, unless it follows from others.
    fn point_of_param(&mut self, name: &Name, docs: &[String], formula: &Expr) -> Option<Drawn> {
        let Drawn { mut at, mut dimensional } = self.point_formula(formula, &Context::constant("a parameter"))?;
        if self.bound_param(name).is_some() {
            Drawn { at, dimensional } = self.point_as_bound(name, Drawn { at, dimensional })?;
        }
        for (coordinate, setting) in self.settings_of(name) {
            let given = self.point_given(name, coordinate, setting, Drawn { at, dimensional })?;
            (at, dimensional) = (given.at, given.dimensional);
        }
        let mut coordinate = |k: usize, axis: &str| {
            let declared = Declared { name: format!("{}{}.{axis}", self.path, name.text), span: name.span };
            // a zero has no sign here: in a direction it would count
            let is_zero = self.decided(at[k], DecidedBy::Sign) == Some(0.0);
            let id = if is_zero && !self.follows(at[k]) { self.model.graph.constant(0.0) } else { at[k] };
            self.settable(declared, &name.text, docs, Value { id, dim: Dim::LENGTH })
        };
        let (x, y) = (coordinate(0, "x")?, coordinate(1, "y")?);
        Some(Drawn { at: [x.id, y.id], dimensional })
    }

    /// What is set of a param from outside, or of which of its coordinates, in the order given.
    fn settings_of(&self, name: &Name) -> Vec<(Option<usize>, &'a Setting)> {
        if self.settings.is_empty() {
            return Vec::new();
        }
        let full = format!("{}{}", self.path, name.text);
        let is_point = self.is_point_name(&name.text);
        let of = |setting: &'a Setting| {
            if is_told_by(&full, &setting.path) {
                return Some((None, setting));
            }
            let axis = ["x", "y"].iter().position(|axis| is_told_by(&format!("{full}.{axis}"), &setting.path));
            axis.filter(|_| is_point || setting.path.contains('.')).map(|axis| (Some(axis), setting))
        };
        self.settings.iter().filter_map(of).collect()
    }

    /// Whether a formula follows from parameters.
    fn follows(&self, id: ExprId) -> bool {
        self.model.graph.dependence(id).on(Dependence::PARAMS)
    }

    /// The point with what is set from outside: `--set A=(12mm,0)`, `--set A.x=12mm`.
    fn point_given(
        &mut self,
        name: &Name,
        coordinate: Option<usize>,
        setting: &Setting,
        before: Drawn,
    ) -> Option<Drawn> {
        let judged = before.dimensional;
        let context = Context { names: false, judged, ..Context::constant("a parameter") };
        let Some(k) = coordinate else {
            if !self.is_point(&setting.value) {
                self.report(errors::point_set_to_number(name, setting.value.span));
                return None;
            }
            return self.point_formula(&setting.value, &context);
        };
        let judged = judged || self.is_dimensional(&setting.value);
        let value = self.formula(&setting.value, &Context { judged, ..context })?;
        let place = format!("the coordinate `{}.{}`", name.text, ["x", "y"][k]);
        self.demand(&place, Dimension::LENGTH, setting.value.span, value.dim, &Context { judged, ..context })?;
        let mut at = before.at;
        at[k] = value.id;
        Some(Drawn { at, dimensional: judged })
    }

    fn param_value(&mut self, formula: &Expr, context: Context<'_>) -> Option<Value> {
        let judged = self.is_dimensional(formula);
        let value = self.formula(formula, &Context { judged, ..context })?;
        let dim = match value.dim {
            _ if self.is_zero(formula) => Dim::Any,
            Dim::Of(dimension) if judged => Dim::Of(dimension),
            _ => Dim::Of(Dimension::PURE),
        };
        Some(Value { dim, ..value })
    }

    /// Reads a function's formula once on its own, so that its mistakes are found even if nobody calls it.
    fn function(&mut self, at: usize) {
        let (argument, value) = (self.functions[at].argument, self.functions[at].value);
        self.functions[at].dimensional = self.is_dimensional_over(Some(&argument.text), value);
        self.functions[at].time = self.time_in(value, argument);
        self.functions[at].sound = true;
        let named = self.name_symbol(Named::Argument, 0);
        let context = Context {
            time: true,
            inputs: true,
            expands: false,
            argument: Some((&argument.text, Value { id: named, dim: Dim::Of(Dimension::PURE) })),
            ..Context::constant("a function")
        };
        let known = self.model.conditions.len();
        let sound = self.formula(value, &context).is_some();
        // what must be positive is asked where the function is called
        self.model.conditions.truncate(known);
        self.functions[at].sound = sound;
    }

    /// Where a formula brings time in, if it does.
    fn time_in(&self, formula: &Expr, argument: &Name) -> Option<Span> {
        let mut time = None;
        mentioned(
            formula,
            |name| self.hidden.contains(name),
            |name, _| {
                let through_a_name = match self.entity(name) {
                    Some(Entity::Function(k)) => self.functions[k].time.is_some(),
                    Some(Entity::Input(_)) => true,
                    _ => false,
                };
                if time.is_none() && name.text != argument.text && (name.text == "t" || through_a_name) {
                    time = Some(name.span);
                }
            },
        );
        time
    }

    /// A named symbol of the graph; the same meaning is the same symbol.
    fn name_symbol(&mut self, meaning: Named, derivative_order: u8) -> ExprId {
        let id = if let Some(&id) = self.named.get(&meaning) {
            id
        } else {
            let id = self.model.add_named(meaning);
            self.named.insert(meaning, id);
            self.derivative_orders.push(derivative_order);
            id
        };
        self.model.graph.symbol(Symbol::Named(id.index() as u32))
    }

    /// The value of a constant formula, under the params' values, by which something is decided.
    fn constant_value(&mut self, id: ExprId) -> Option<f64> {
        self.decided(id, DecidedBy::Value)
    }

    /// The same, where only what it is decides, and not how large.
    fn decided(&mut self, id: ExprId, by: DecidedBy) -> Option<f64> {
        let value = self.number_of(id);
        if value.is_some() {
            self.model.decided.push((id, by));
        }
        value
    }

    /// The value of a constant formula by which nothing is decided.
    fn number_of(&mut self, id: ExprId) -> Option<f64> {
        if !self.model.graph.dependence(id).is_constant() {
            return None;
        }
        let params = &self.model.params;
        self.model.graph.extend_values(&mut self.values, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Shift(_) => 0.0,
            _ => f64::NAN,
        });
        self.values.get(id.index()).copied()
    }
}
