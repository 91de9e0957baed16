//! The formulas of a mechanism: params, functions, tables, inputs, measures and results by name, points and references to features, and
//! their values in the graph.
//!
//! This layer owns `Formulas`: what a formula is evaluated with, and the model as far as it is built. It declares no body, joint or
//! equation; the layer above does, and makes them known here.

// a method of a type with a lifetime is not general enough in the place of a closure
#![allow(clippy::redundant_closure_for_method_calls)]

mod bindings;
mod branches;
mod builtins;
mod calls;
mod cli_formulas;
mod column_variables;
mod constants;
mod definitions;
mod dimensions;
mod display_units;
mod drawing;
mod forces;
mod formula;
mod formula_scope;
mod functions;
mod imports;
mod input_bindings;
mod inputs;
mod measures;
mod overrides;
mod params;
mod parts;
mod places;
mod point_names;
mod points;
mod poses;
mod quantities;
mod reductions;
mod references;
mod samples;
mod table_file;
mod tables;
mod value;
mod variables;

pub(in crate::check) use bindings::BoundParam;
pub use cli_formulas::{FormulaOfTime, amount, constant, formula_of_time};
pub(in crate::check) use dimensions::require_dimension;
pub(in crate::check) use display_units::determined_dimension;
pub(in crate::check) use formula_scope::{FormulaSite, InitialPoint};
pub(in crate::check) use measures::measure_context;
pub use overrides::override_matches;
pub(in crate::check) use params::ParamState;
pub(in crate::check) use quantities::describe;
pub use reductions::UNTIL;
pub(in crate::check) use reductions::reject_window;
pub(in crate::check) use references::Feature;
pub use samples::{Column, variants};
pub(in crate::check) use value::{Context, Dim, Value};
pub(in crate::check) use variables::Variables;

use super::errors::Reporter;
use super::options::CheckOptions;
use super::scope::Scope;
use crate::model::{Declared, EquationId, Frame, JointId, Mechanism};
use bindings::ExternalBindings;
use branches::Branch;
use calls::Calls;
use constants::RecordedLengths;
use formula_scope::FormulaScope;
use functions::Function;
use inputs::InputState;
use measures::MeasureState;
use mechc_syntax::ast;
use mechc_text::source::Sources;
use parts::{Address, SharedState};
use reductions::ResultState;
use samples::Samples;
use std::rc::Rc;
use tables::TableState;

/// The formulas of one mechanism or part, and what they are evaluated with.
pub(in crate::check) struct Formulas<'a> {
    pub options: &'a CheckOptions,
    pub reporter: Reporter<'a>,
    pub model: Mechanism,
    pub common: SharedState,
    pub scope: Scope<'a>,
    pub address: Address,
    pub bound: ExternalBindings<'a>,
    /// The formulas of the parts.
    pub parts: Vec<Formulas<'a>>,
    /// The declaration of each part.
    pub part_declarations: Vec<&'a ast::Part>,
    pub params: Vec<ParamState<'a>>,
    pub functions: Vec<Function<'a>>,
    tables: Vec<TableState<'a>>,
    inputs: Vec<InputState<'a>>,
    pub measures: Vec<MeasureState<'a>>,
    pub results: Vec<ResultState<'a>>,
    /// The orders of dependence of measures and of results.
    measure_order: Vec<usize>,
    result_order: Vec<usize>,
    /// The samples of inputs.
    pub samples: Option<Rc<Samples>>,
    /// The frames of bodies, then those of the grounds of parts that are named.
    pub bodies: Vec<Frame>,
    pub joints: Vec<Option<JointId>>,
    /// Constraints and drivers; `None` for broken ones.
    pub equations: Vec<Option<EquationId>>,
    /// The constant lengths met so far.
    pub lengths: RecordedLengths<'a>,
    /// The site, the calls and the branch of the current formula.
    current: FormulaScope<'a>,
    calls: Calls<'a>,
    branch: Branch,
}

impl<'a> Formulas<'a> {
    /// Returns the formulas of a mechanism, without parts and before its names are declared.
    pub fn new(tree: &'a ast::Mechanism, options: &'a CheckOptions, sources: &'a Sources) -> Formulas<'a> {
        Formulas {
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
            joints: Vec::new(),
            equations: Vec::new(),
            lengths: RecordedLengths::default(),
            current: FormulaScope::default(),
            calls: Calls::default(),
            branch: Branch::default(),
        }
    }
}
