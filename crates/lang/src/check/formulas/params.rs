//! Params: the numbers and points of a text, with their overrides.

use super::Formulas;
use super::dimensions::require_dimension;
use super::formula_scope::InitialPoint;
use super::overrides::override_matches;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::options::ParamOverride;
use crate::check::suggest::lost_rate;
use crate::model::{ContinuedParam, Declared, Dimension, GuardKind, Param};
use mechc_expr::Symbol;
use mechc_syntax::ast::{Expr, Name};

/// The state of a parameter.
#[derive(Clone, Copy, Default)]
pub(in crate::check) struct ParamState<'a> {
    /// The name and formula in the text; `None` for one of a part that has not been evaluated.
    pub written: Option<(&'a Name, &'a Expr)>,
    /// `None` before evaluation, if it is broken, and if it is a point.
    pub value: Option<Value>,
    /// The value of a point.
    pub drawn: Option<InitialPoint>,
    /// True if it is given in a unit of angle.
    pub is_in_angles: bool,
}

impl<'a> Formulas<'a> {
    pub(super) fn define_param(&mut self, k: usize, name: &Name, docs: &[String], value: &Expr) {
        self.record_angle(name, value);
        if self.scope.point_param(name) == Some(k) {
            self.params[k].drawn = self.point_of_param(name, docs, value);
        } else {
            self.params[k].value = self.param(name, docs, value);
        }
    }

    /// Evaluates a parameter. An independent one becomes a symbol, another one its formula.
    fn param(&mut self, name: &Name, docs: &[String], formula: &Expr) -> Option<Value> {
        let context = Context::constant("a parameter");
        let in_file = self.param_value(formula, context)?;
        if let Some(bound) = self.value_with_binding(name, in_file) {
            return bound;
        }
        let setting = self.settings_of(name).pop();
        let value = match setting {
            None => in_file,
            Some((Some(k), setting)) => {
                self.reporter.report(errors::coordinate_of_number(name, k, setting.value.span));
                return None;
            }
            Some((None, setting)) => {
                let given = self.param_value(&setting.value, Context { names: false, ..context })?;
                if let Some([expected, found]) = in_file.dim.other_than(given.dim) {
                    let place = format!("the parameter `{}{}`", self.scope.path, name.text);
                    let part = lost_rate::Part { span: setting.value.span, dimension: found };
                    let text = self.reporter.text(setting.value.span);
                    self.reporter.report(errors::wrong_dimension(&place, expected, part, text));
                    return None;
                }
                // A zero fits any dimension, and what replaces it has its own.
                Value { dim: if in_file.dim == Dim::Any { given.dim } else { in_file.dim }, ..given }
            }
        };
        self.settable(self.scope.declared(name), &name.text, docs, value)
    }

    /// Returns the value of a numeric parameter, which becomes a parameter of the model if it is independent.
    fn settable(&mut self, declared: Declared, name: &str, docs: &[String], value: Value) -> Option<Value> {
        let is_open = self.is_open(&declared, name);
        if self.follows(value.id) && !is_open {
            return Some(self.with_shift(&declared, value));
        }
        let number = self.number_of(value.id)?;
        // A param that determines the number of declarations cannot change afterwards.
        if self.scope.deciding.contains(name) {
            self.constant_value(value.id);
            return Some(Value { id: self.model.graph.constant(number), dim: value.dim });
        }
        let index = self.model.params.len() as u32;
        self.register_param(&declared, Symbol::Param(index), value.dim);
        let dimension = value.dim.settled();
        if is_open {
            let (declared, param) = (declared.clone(), Some(index));
            self.model.continued.push(ContinuedParam { declared, param, line: [number; 2], dimension });
        }
        self.model.params.push(Param { declared, docs: docs.to_vec(), value: number, dimension });
        let id = self.model.graph.symbol(Symbol::Param(index));
        if value.dim == Dim::Any {
            // Another number does not fit any dimension.
            self.decided(id, GuardKind::Value);
        }
        Some(Value { id, dim: value.dim })
    }

    /// Returns whether a parameter, or a coordinate of one that is a point, may change after the check, so that it is independent.
    fn is_open(&self, declared: &Declared, name: &str) -> bool {
        if self.options.open.is_empty() {
            return false;
        }
        let full = format!("{}{name}", self.scope.path);
        self.options.open.iter().any(|path| override_matches(&full, path) || override_matches(&declared.name, path))
    }

    /// Evaluates a parameter that is a point. Each independent coordinate becomes a parameter of the model.
    fn point_of_param(&mut self, name: &Name, docs: &[String], formula: &Expr) -> Option<InitialPoint> {
        let InitialPoint { mut at, mut dimensional } =
            self.point_formula(formula, &Context::constant("a parameter"))?;
        if self.bound_param(name).is_some() {
            InitialPoint { at, dimensional } = self.point_with_binding(name, InitialPoint { at, dimensional })?;
        }
        for (coordinate, setting) in self.settings_of(name) {
            let given = self.point_given(name, coordinate, setting, InitialPoint { at, dimensional })?;
            (at, dimensional) = (given.at, given.dimensional);
        }
        let mut coordinate = |k: usize, axis: &str| {
            let declared = Declared { name: format!("{}{}.{axis}", self.scope.path, name.text), span: name.span };
            // A zero loses its sign, which would count in a direction.
            let is_zero = self.decided(at[k], GuardKind::Sign) == Some(0.0);
            let id = if is_zero && !self.follows(at[k]) { self.model.graph.constant(0.0) } else { at[k] };
            self.settable(declared, &name.text, docs, Value { id, dim: Dim::LENGTH })
        };
        let (x, y) = (coordinate(0, "x")?, coordinate(1, "y")?);
        Some(InitialPoint { at: [x.id, y.id], dimensional })
    }

    /// Returns the overrides of a param, or of one of its coordinates, in their order.
    pub(in crate::check) fn settings_of(&self, name: &Name) -> Vec<(Option<usize>, &'a ParamOverride)> {
        if self.options.settings.is_empty() {
            return Vec::new();
        }
        let full = format!("{}{}", self.scope.path, name.text);
        let is_point = self.scope.is_point_name(&name.text);
        let of = |setting: &'a ParamOverride| {
            if override_matches(&full, &setting.path) {
                return Some((None, setting));
            }
            let axis = ["x", "y"].iter().position(|axis| override_matches(&format!("{full}.{axis}"), &setting.path));
            axis.filter(|_| is_point || setting.path.contains('.')).map(|axis| (Some(axis), setting))
        };
        self.options.settings.iter().filter_map(of).collect()
    }

    /// Returns a point with its overrides: `--set A=(12mm,0)`, `--set A.x=12mm`.
    fn point_given(
        &mut self,
        name: &Name,
        coordinate: Option<usize>,
        setting: &ParamOverride,
        before: InitialPoint,
    ) -> Option<InitialPoint> {
        let judged = before.dimensional;
        let context = Context { names: false, judged, ..Context::constant("a parameter") };
        let Some(k) = coordinate else {
            if !self.is_point(&setting.value) {
                self.reporter.report(errors::point_set_to_number(name, setting.value.span));
                return None;
            }
            return self.point_formula(&setting.value, &context);
        };
        let judged = judged || self.is_dimensional(&setting.value);
        let value = self.formula(&setting.value, &Context { judged, ..context })?;
        let place = format!("the coordinate `{}.{}`", name.text, ["x", "y"][k]);
        require_dimension(
            &mut self.reporter,
            &place,
            Dimension::LENGTH,
            setting.value.span,
            value.dim,
            &Context { judged, ..context },
        )?;
        let mut at = before.at;
        at[k] = value.id;
        Some(InitialPoint { at, dimensional: judged })
    }

    fn param_value(&mut self, formula: &Expr, context: Context<'_>) -> Option<Value> {
        let judged = self.is_dimensional(formula);
        let value = self.formula(formula, &Context { judged, ..context })?;
        let dim = match value.dim {
            _ if self.is_zero(formula) => Dim::Any,
            Dim::Any => Dim::PLAIN.when_judged(judged),
            dim => dim,
        };
        Some(Value { dim, ..value })
    }
}
