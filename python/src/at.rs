//! `Mechanism.at`: evaluates a mechanism at given inputs, params and times. Each element starts from the assembled start, so its bits do not
//! depend on the other elements.

use crate::errors::Report;
use crate::exit::detached;
use crate::interrupts::interruptible;
use crate::mechanism::{Mechanism, Stages};
use crate::memory::{self, Computation};
pub use answer::{_unpickle_at, At, Columns};
pub use arguments::{OPTIONS, Options, at};
use mechc::{
    Cancel, Checked, Choice, ColumnUnit, Error, EvaluationPoint, EvaluatorOptions, InputMotion, MechanismEvaluator,
    SettableParam,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyString};
use std::borrow::Cow;
use std::sync::{Arc, Mutex};

mod answer;
mod arguments;

/// Largest number of evaluators in the cache of a mechanism.
const MOST_EVALUATORS: usize = 16;

/// Queries within these limits take at most some hundredths of a second and run on the calling thread; larger ones run on another thread, which
/// Ctrl-C cancels. The last limit is the distance of inputs, params and times from the text's values, relative to these or to 1 (SI).
const MOST_ELEMENTS: usize = 32;
const MOST_COLUMNS: usize = 2000;
const LARGEST_DISTANCE: f64 = 50.0;

/// All of a query but its values; an evaluator is compiled once for each.
#[derive(Clone, PartialEq, Default)]
pub struct EvaluatorKey {
    inputs: Vec<String>,
    /// True if accelerations of inputs are given.
    has_accelerations: bool,
    params: Vec<String>,
    by: Vec<String>,
    reactions: bool,
    tolerance: Option<u64>,
    pass_bifurcations: bool,
}

/// A compiled evaluator with its columns.
pub struct CachedEvaluator {
    evaluator: MechanismEvaluator,
    columns: Arc<Columns>,
    /// The units of the columns; `None` if all are SI.
    units: Option<Vec<ColumnUnit>>,
    /// Ranges near the text's values: of the time, then of the inputs and params in order (SI).
    near: Vec<[f64; 2]>,
}

/// The compiled evaluators of a mechanism, the newest first.
#[derive(Default)]
pub struct EvaluatorCache(Mutex<Vec<(EvaluatorKey, Arc<CachedEvaluator>)>>);

impl EvaluatorCache {
    /// Returns the evaluator for a key; `None` also if the lock is taken, as it stays in a process that was forked meanwhile.
    fn find(&self, key: &EvaluatorKey) -> Option<Arc<CachedEvaluator>> {
        let cache = self.0.try_lock().ok()?;
        cache.iter().find(|(other, _)| other == key).map(|(_, compiled)| Arc::clone(compiled))
    }

    /// Returns the evaluator and its operands if only inputs are given, each as a finite `float`: the fast path of the commonest query.
    fn find_inputs_only(&self, values: &Bound<'_, PyDict>) -> Option<(Arc<CachedEvaluator>, Vec<[Operand; 3]>)> {
        let cache = self.0.try_lock().ok()?;
        cache.iter().find_map(|(key, compiled)| {
            if key.inputs.len() != values.len() || !key.is_inputs_only() {
                return None;
            }
            let mut inputs = Vec::with_capacity(values.len());
            inputs.resize_with(values.len(), || [0.0; 3].map(Operand::One));
            for (name, value) in values.iter() {
                let name = name.cast::<PyString>().ok()?.to_str().ok()?;
                let place = key.inputs.iter().position(|input| input == name)?;
                let value = value.cast_exact::<PyFloat>().ok()?.value();
                inputs[place][0] = Operand::One(Some(value).filter(|value| value.is_finite())?);
            }
            Some((Arc::clone(compiled), inputs))
        })
    }

    fn add(&self, key: EvaluatorKey, compiled: &Arc<CachedEvaluator>) {
        if let Ok(mut cache) = self.0.try_lock() {
            cache.insert(0, (key, Arc::clone(compiled)));
            cache.truncate(MOST_EVALUATORS);
        }
    }
}

impl EvaluatorKey {
    /// Returns whether only inputs are given, without accelerations or options.
    fn is_inputs_only(&self) -> bool {
        let EvaluatorKey { has_accelerations, params, by, reactions, tolerance, pass_bifurcations, .. } = self;
        !has_accelerations
            && params.is_empty()
            && by.is_empty()
            && !reactions
            && tolerance.is_none()
            && !pass_bifurcations
    }
}

impl CachedEvaluator {
    fn new(stages: &Stages, key: &EvaluatorKey, cancel: &Cancel) -> Result<CachedEvaluator, Report> {
        let choice = Choice { by: key.by.clone(), reactions: key.reactions, ..stages.choice.clone() };
        let is_inputs_only = key.by.is_empty() && !key.reactions;
        let checked = if is_inputs_only {
            stages.checked.clone()
        } else {
            stages.compile(&choice, &*stages.files, stages.redundant, cancel)?.0.0
        };
        let usual = EvaluatorOptions::default();
        let options = EvaluatorOptions {
            inputs: key.inputs.clone(),
            has_accelerations: key.has_accelerations,
            params: key.params.clone(),
            start: None,
            redundant: stages.redundant,
            tolerance: key.tolerance.map_or(usual.tolerance, f64::from_bits),
            pass_bifurcations: key.pass_bifurcations,
        };
        let evaluator = checked.evaluator(&options, cancel)?;
        let compiled = evaluator.compiled();
        let (names, units) = (compiled.columns(), compiled.units());
        let place = |name: String| names.iter().position(|column| *column == name);
        let of_order =
            |ending: &str| compiled.coordinates().iter().filter_map(|name| place(format!("{name}{ending}"))).collect();
        let coordinates = ["", ".d", ".dd"].map(of_order);
        let columns = Columns::new(names, units.iter().map(|unit| unit.text.clone()).collect(), coordinates);
        let units = units.iter().any(|unit| unit.scale() != [1.0; 3]).then_some(units);
        let near = near(&checked, evaluator.compiled(), key);
        Ok(CachedEvaluator { evaluator, columns, units, near })
    }
}

/// Returns the ranges near the text's values of the time, then of the inputs and params in order (SI).
fn near(checked: &Checked, compiled: &mechc::Compiled, key: &EvaluatorKey) -> Vec<[f64; 2]> {
    let time = compiled.analysis().map_or([f64::NAN; 2], |[from, to, _]| [from, to + LARGEST_DISTANCE * (to - from)]);
    let around = |list: Vec<SettableParam>, names: &[String]| {
        let of = |name: &String| {
            let own = list.iter().find(|of| of.name == *name).map_or(f64::NAN, |of| of.value);
            let reach = LARGEST_DISTANCE * own.abs().max(1.0);
            [own - reach, own + reach]
        };
        names.iter().map(of).collect::<Vec<_>>()
    };
    let (inputs, params) = (checked.settable_inputs(compiled), checked.settable_params());
    [vec![time], around(inputs, &key.inputs), around(params, &key.params)].concat()
}

/// A query with its values.
pub struct Query {
    key: EvaluatorKey,
    /// The time (s), if it is given.
    t: Option<Operand>,
    /// Value, rate and acceleration of each input.
    inputs: Vec<[Operand; 3]>,
    params: Vec<Operand>,
    /// The shape of the elements; `None` for a single one.
    shape: Option<Vec<usize>>,
}

/// A number, or one for each element.
enum Operand {
    One(f64),
    Each(Vec<f64>),
}

impl Operand {
    fn at(&self, element: usize) -> f64 {
        match self {
            Operand::One(value) => *value,
            Operand::Each(values) => values[element],
        }
    }

    fn all(&self, is: impl Fn(f64) -> bool) -> bool {
        match self {
            Operand::One(value) => is(*value),
            Operand::Each(values) => values.iter().all(|value| is(*value)),
        }
    }
}

/// The results of all elements: their rows one behind the other, and a status for each.
#[derive(Default)]
struct Outcomes {
    rows: Vec<f64>,
    statuses: Vec<Cow<'static, str>>,
    /// The first element that failed, with its error.
    first: Option<(usize, Error)>,
}

impl Query {
    fn elements(&self) -> usize {
        self.shape.as_ref().map_or(1, |shape| shape.iter().product())
    }

    /// Returns the evaluator, from the cache or newly compiled.
    fn compiled(&self, py: Python<'_>, mechanism: &Mechanism) -> PyResult<Arc<CachedEvaluator>> {
        if let Some(compiled) = mechanism.evaluators.find(&self.key) {
            return Ok(compiled);
        }
        let (stages, key) = (Arc::clone(&mechanism.stages), self.key.clone());
        let result = interruptible(py, move |cancel| CachedEvaluator::new(&stages, &key, cancel))?;
        let compiled = Arc::new(result.map_err(|report| report.to_exception(py))?);
        mechanism.evaluators.add(self.key.clone(), &compiled);
        Ok(compiled)
    }

    /// Evaluates all elements.
    fn answer(self, py: Python<'_>, compiled: Arc<CachedEvaluator>) -> PyResult<At> {
        let (elements, width) = (self.elements(), compiled.columns.names.len());
        let size = (elements as u64, width);
        memory::refuse_beyond(py, size, Computation::At)?;
        let mut outcomes = Outcomes::default();
        let rows = outcomes.rows.try_reserve_exact(elements.saturating_mul(width));
        rows.and_then(|()| outcomes.statuses.try_reserve_exact(elements))
            .map_err(|_| memory::too_large(py, size, Computation::At))?;
        let columns = Arc::clone(&compiled.columns);
        let (shape, outcomes) = if elements <= MOST_ELEMENTS && width <= MOST_COLUMNS && self.is_near(&compiled.near) {
            let outcomes = detached(py, || self.all(&compiled, outcomes, &Cancel::default()));
            (self.shape, outcomes)
        } else {
            let compiled = Arc::clone(&compiled);
            interruptible(py, move |cancel| (self.all(&compiled, outcomes, cancel), self.shape)).map(|(a, b)| (b, a))?
        };
        let Outcomes { rows, statuses, first } = outcomes;
        let error = first.map(|(element, why)| with_element(why, element, shape.as_deref()).into());
        Ok(At { columns, rows, shape, statuses, error })
    }

    /// Returns whether all values are within the ranges near the text's values.
    fn is_near(&self, near: &[[f64; 2]]) -> bool {
        let given = self.inputs.iter().map(|[value, ..]| value).chain(&self.params);
        let is_near = |(of, [low, high]): (&Operand, &[f64; 2])| of.all(|value| *low <= value && value <= *high);
        self.t.iter().zip(near).all(is_near) && given.zip(&near[1..]).all(is_near)
    }

    fn all(&self, compiled: &CachedEvaluator, mut outcomes: Outcomes, cancel: &Cancel) -> Outcomes {
        let width = compiled.columns.names.len();
        let ask = |element: usize, place: &mut EvaluationPoint| self.write(element, place);
        compiled.evaluator.evaluate_each(self.elements(), ask, cancel, |found| {
            let Outcomes { rows, statuses, first } = &mut outcomes;
            match found {
                Ok(row) => {
                    let before = rows.len();
                    rows.extend_from_slice(row);
                    let units = compiled.units.iter().flatten();
                    rows[before..].iter_mut().zip(units).for_each(|(value, unit)| *value = unit.printed(*value));
                    statuses.push(Cow::Borrowed("ok"));
                }
                Err(why) => {
                    rows.resize(rows.len() + width, f64::NAN);
                    let element = statuses.len();
                    statuses.push(Cow::Borrowed(why.first().map_or("cancelled", |why| why.code.as_str())));
                    first.get_or_insert((element, why));
                }
            }
        });
        outcomes
    }

    /// Writes the values of an element.
    fn write(&self, element: usize, place: &mut EvaluationPoint) {
        let motion = |[value, rate, acceleration]: &[Operand; 3]| InputMotion {
            value: value.at(element),
            rate: rate.at(element),
            acceleration: acceleration.at(element),
        };
        place.t = self.t.as_ref().map(|t| t.at(element));
        place.inputs.clear();
        place.inputs.extend(self.inputs.iter().map(motion));
        place.params.clear();
        place.params.extend(self.params.iter().map(|param| param.at(element)));
    }
}

/// Returns the error of an element, with its index in the array if there are several.
fn with_element(why: Error, element: usize, shape: Option<&[usize]>) -> Error {
    let Some(shape) = shape else { return why };
    let mut rest = element;
    let mut place: Vec<usize> = shape.iter().rev().map(|&of| (rest % of.max(1), rest /= of.max(1)).0).collect();
    place.reverse();
    let index: Vec<String> = place.iter().map(usize::to_string).collect();
    let note = format!("it is element [{}] of those that are asked for", index.join(", "));
    let marked = why.diagnostics.iter().cloned().map(|why| why.note(note.clone()).datum("element", place.clone()));
    Error { diagnostics: marked.collect(), ..why }
}
