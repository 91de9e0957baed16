//! A mechanism at given inputs, params and times, one or many: each from its own start, so that neither order nor company change a bit.

use crate::ending::away;
use crate::errors::Said;
use crate::mechanism::{Mechanism, Stages};
use crate::memory::{self, Of};
use crate::waiting::interruptible;
pub use found::{_at_again, At, Columns};
use mechc::{
    Cancel, Checked, Choice, ColumnUnit, Error, EvaluationPoint, EvaluatorOptions, InputMotion, MechanismEvaluator,
    SettableParam,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyString};
pub use reading::{OPTIONS, Options, at};
use std::borrow::Cow;
use std::sync::{Arc, Mutex};

mod found;
mod reading;

/// What was compiled for questions of a kind; so many kinds are remembered.
const KINDS: usize = 16;

/// What takes longer than some hundredths of a second is computed on another thread, while Ctrl-C is looked for: more elements than these, more
/// columns, or a longer way from what the text says: of an input or a param in SI or by its own size, of the time by that of the analysis.
const AT_ONCE: usize = 32;
const MOST_COLUMNS: usize = 2000;
const FARTHEST: f64 = 50.0;

/// What is asked for, but for the values: it is compiled once for all of these.
#[derive(Clone, PartialEq, Default)]
pub struct Kind {
    inputs: Vec<String>,
    /// Whether accelerations of inputs are told.
    bend: bool,
    params: Vec<String>,
    by: Vec<String>,
    reactions: bool,
    tolerance: Option<u64>,
    pass_bifurcations: bool,
}

/// What was compiled for one.
pub struct Compiled {
    adjustable: MechanismEvaluator,
    columns: Arc<Columns>,
    /// The units that columns are printed in, where any is not SI.
    units: Option<Vec<ColumnUnit>>,
    /// From where to where the time, and the inputs and params in order, are near what the text says.
    near: Vec<[f64; 2]>,
}

/// What was compiled of a mechanism by now, the last first.
#[derive(Default)]
pub struct Known(Mutex<Vec<(Kind, Arc<Compiled>)>>);

impl Known {
    /// What is known of a kind. Who cannot look, because another process was forked while somebody did, does without.
    fn find(&self, kind: &Kind) -> Option<Arc<Compiled>> {
        let known = self.0.try_lock().ok()?;
        known.iter().find(|(other, _)| other == kind).map(|(_, compiled)| Arc::clone(compiled))
    }

    /// What is known of numbers for inputs alone, and these in order: what is asked most often is answered without a detour.
    fn find_plain(&self, values: &Bound<'_, PyDict>) -> Option<(Arc<Compiled>, Vec<[Operand; 3]>)> {
        let known = self.0.try_lock().ok()?;
        known.iter().find_map(|(kind, compiled)| {
            if kind.inputs.len() != values.len() || !kind.is_plain() {
                return None;
            }
            let mut inputs = Vec::with_capacity(values.len());
            inputs.resize_with(values.len(), || [0.0; 3].map(Operand::One));
            for (name, value) in values.iter() {
                let name = name.cast::<PyString>().ok()?.to_str().ok()?;
                let place = kind.inputs.iter().position(|input| input == name)?;
                let value = value.cast_exact::<PyFloat>().ok()?.value();
                inputs[place][0] = Operand::One(Some(value).filter(|value| value.is_finite())?);
            }
            Some((Arc::clone(compiled), inputs))
        })
    }

    fn add(&self, kind: Kind, compiled: &Arc<Compiled>) {
        if let Ok(mut known) = self.0.try_lock() {
            known.insert(0, (kind, Arc::clone(compiled)));
            known.truncate(KINDS);
        }
    }
}

impl Kind {
    /// Whether nothing is asked for but where inputs lead.
    fn is_plain(&self) -> bool {
        let Kind { bend, params, by, reactions, tolerance, pass_bifurcations, .. } = self;
        !bend && params.is_empty() && by.is_empty() && !reactions && tolerance.is_none() && !pass_bifurcations
    }
}

impl Compiled {
    fn of(stages: &Stages, kind: &Kind, cancel: &Cancel) -> Result<Compiled, Said> {
        let asked = Choice { by: kind.by.clone(), reactions: kind.reactions, ..stages.choice.clone() };
        let is_plain = kind.by.is_empty() && !kind.reactions;
        let checked = if is_plain {
            stages.checked.clone()
        } else {
            stages.with(&asked, &*stages.files, stages.redundant, cancel)?.0.0
        };
        let usual = EvaluatorOptions::default();
        let adjusting = EvaluatorOptions {
            inputs: kind.inputs.clone(),
            has_accelerations: kind.bend,
            params: kind.params.clone(),
            redundant: stages.redundant,
            tolerance: kind.tolerance.map_or(usual.tolerance, f64::from_bits),
            pass_bifurcations: kind.pass_bifurcations,
        };
        let adjustable = checked.evaluator(&adjusting, cancel)?;
        let compiled = adjustable.compiled();
        let (names, units) = (compiled.columns(), compiled.units());
        let place = |name: String| names.iter().position(|column| *column == name);
        let of_order =
            |ending: &str| compiled.coordinates().iter().filter_map(|name| place(format!("{name}{ending}"))).collect();
        let coordinates = ["", ".d", ".dd"].map(of_order);
        let columns = Columns::new(names, units.iter().map(|unit| unit.text.clone()).collect(), coordinates);
        let units = units.iter().any(|unit| unit.scale() != [1.0; 3]).then_some(units);
        let near = near(&checked, adjustable.compiled(), kind);
        Ok(Compiled { adjustable, columns, units, near })
    }
}

/// From where to where the time, and the inputs and params of a question in order, are near what the text says.
fn near(checked: &Checked, compiled: &mechc::Compiled, kind: &Kind) -> Vec<[f64; 2]> {
    let time = compiled.analysis().map_or([f64::NAN; 2], |[from, to, _]| [from, to + FARTHEST * (to - from)]);
    let around = |list: Vec<SettableParam>, names: &[String]| {
        let of = |name: &String| {
            let own = list.iter().find(|of| of.name == *name).map_or(f64::NAN, |of| of.value);
            let reach = FARTHEST * own.abs().max(1.0);
            [own - reach, own + reach]
        };
        names.iter().map(of).collect::<Vec<_>>()
    };
    let (inputs, params) = (checked.settable_inputs(compiled), checked.settable_params());
    [vec![time], around(inputs, &kind.inputs), around(params, &kind.params)].concat()
}

/// A question, as it was put.
pub struct Question {
    kind: Kind,
    /// The time (s), if it is told, then inputs with their rates and accelerations, then params.
    t: Option<Operand>,
    inputs: Vec<[Operand; 3]>,
    params: Vec<Operand>,
    /// By how many elements.
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

/// What became of elements: their rows one behind the other, and why some are not there.
#[derive(Default)]
struct Became {
    rows: Vec<f64>,
    statuses: Vec<Cow<'static, str>>,
    /// The first of these, by its number.
    first: Option<(usize, Error)>,
}

impl Question {
    fn elements(&self) -> usize {
        self.shape.as_ref().map_or(1, |shape| shape.iter().product())
    }

    /// What it is answered by.
    fn compiled(&self, py: Python<'_>, mechanism: &Mechanism) -> PyResult<Arc<Compiled>> {
        if let Some(compiled) = mechanism.known.find(&self.kind) {
            return Ok(compiled);
        }
        let (stages, kind) = (Arc::clone(&mechanism.stages), self.kind.clone());
        let made = interruptible(py, move |cancel| Compiled::of(&stages, &kind, cancel))?;
        let compiled = Arc::new(made.map_err(|said| said.raised(py))?);
        mechanism.known.add(self.kind.clone(), &compiled);
        Ok(compiled)
    }

    /// Its answer.
    fn answer(self, py: Python<'_>, compiled: Arc<Compiled>) -> PyResult<At> {
        let (elements, width) = (self.elements(), compiled.columns.names.len());
        let size = (elements as u64, width);
        memory::refuse_beyond(py, size, Of::At)?;
        let mut became = Became::default();
        let rows = became.rows.try_reserve_exact(elements.saturating_mul(width));
        rows.and_then(|()| became.statuses.try_reserve_exact(elements))
            .map_err(|_| memory::too_large(py, size, Of::At))?;
        let columns = Arc::clone(&compiled.columns);
        let (shape, became) = if elements <= AT_ONCE && width <= MOST_COLUMNS && self.is_near(&compiled.near) {
            let became = away(py, || self.all(&compiled, became, &Cancel::default()));
            (self.shape, became)
        } else {
            let compiled = Arc::clone(&compiled);
            interruptible(py, move |cancel| (self.all(&compiled, became, cancel), self.shape)).map(|(a, b)| (b, a))?
        };
        let Became { rows, statuses, first } = became;
        let error = first.map(|(element, why)| of_element(why, element, shape.as_deref()).into());
        Ok(At { columns, rows, shape, statuses, error })
    }

    /// Whether all that is told is near what the text says.
    fn is_near(&self, near: &[[f64; 2]]) -> bool {
        let given = self.inputs.iter().map(|[value, ..]| value).chain(&self.params);
        let is_near = |(of, [low, high]): (&Operand, &[f64; 2])| of.all(|value| *low <= value && value <= *high);
        self.t.iter().zip(near).all(is_near) && given.zip(&near[1..]).all(is_near)
    }

    fn all(&self, compiled: &Compiled, mut became: Became, cancel: &Cancel) -> Became {
        let width = compiled.columns.names.len();
        let ask = |element: usize, place: &mut EvaluationPoint| self.write(element, place);
        compiled.adjustable.evaluate_each(self.elements(), ask, cancel, |found| {
            let Became { rows, statuses, first } = &mut became;
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
        became
    }

    /// Writes what an element asks for.
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

/// Why an element is not there; of several it says which one that is, as their array is indexed.
fn of_element(why: Error, element: usize, shape: Option<&[usize]>) -> Error {
    let Some(shape) = shape else { return why };
    let mut rest = element;
    let mut place: Vec<usize> = shape.iter().rev().map(|&of| (rest % of.max(1), rest /= of.max(1)).0).collect();
    place.reverse();
    let index: Vec<String> = place.iter().map(usize::to_string).collect();
    let note = format!("it is element [{}] of those that are asked for", index.join(", "));
    let marked = why.diagnostics.iter().cloned().map(|why| why.note(note.clone()).datum("element", place.clone()));
    Error { diagnostics: marked.collect(), ..why }
}
