//! A mechanism at given inputs, params and times, one or many: each from its own start, so that neither order nor company change a bit.

use crate::errors::Said;
use crate::mechanism::{Mechanism, Stages};
use crate::waiting::interruptible;
use mechc::{Adjustable, Adjusting, Cancel, Choice, Diagnostic, Signal, Sources, Times};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::{PyKeyError, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString, PyTuple};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// What was compiled for questions of a kind; so many kinds are remembered.
const KINDS: usize = 16;

/// More elements than this are computed on another thread, while Ctrl-C is looked for.
const AT_ONCE: usize = 32;

/// What is asked for, but for the values: it is compiled once for all of these.
#[derive(Clone, PartialEq)]
pub struct Kind {
    inputs: Vec<String>,
    params: Vec<String>,
    by: Vec<String>,
    reactions: bool,
    tolerance: Option<u64>,
    pass_bifurcations: bool,
}

/// What was compiled for one.
pub struct Compiled {
    adjustable: Adjustable,
    columns: Arc<Columns>,
}

/// The columns of what is found.
pub struct Columns {
    names: Vec<String>,
    units: Vec<mechc::ColumnUnit>,
    places: HashMap<String, usize>,
    /// By derivative by time: the places of the coordinates.
    coordinates: [Vec<usize>; 3],
    /// Whether any column is not in SI.
    is_scaled: bool,
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

    fn add(&self, kind: Kind, compiled: &Arc<Compiled>) {
        if let Ok(mut known) = self.0.try_lock() {
            known.insert(0, (kind, Arc::clone(compiled)));
            known.truncate(KINDS);
        }
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
        let usual = Adjusting::default();
        let adjusting = Adjusting {
            inputs: kind.inputs.clone(),
            params: kind.params.clone(),
            redundant: stages.redundant,
            tolerance: kind.tolerance.map_or(usual.tolerance, f64::from_bits),
            pass_bifurcations: kind.pass_bifurcations,
        };
        let adjustable =
            checked.adjustable(&adjusting, cancel).map_err(|(sources, said)| Said::of(&said, &sources))?;
        let compiled = adjustable.compiled();
        let names = compiled.columns();
        let places: HashMap<String, usize> = names.iter().cloned().zip(0..).collect();
        let place = |name: String| places.get(&name).copied();
        let of_order = |ending: &str| compiled.coordinates().iter().filter_map(|name| place(format!("{name}{ending}"))).collect();
        let units = compiled.units();
        let is_scaled = units.iter().any(|unit| unit.scale() != [1.0; 3]);
        let coordinates = ["", ".d", ".dd"].map(of_order);
        Ok(Compiled { adjustable, columns: Arc::new(Columns { names, units, places, coordinates, is_scaled }) })
    }
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
    strict: bool,
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
}

/// What became of an element.
enum Became {
    Row,
    Not(Box<Diagnostic>),
}

/// Where the mechanism is, by its columns; of many elements each column is an array of their shape.
#[pyclass(frozen, mapping, module = "mechc._mechc")]
pub struct At {
    columns: Arc<Columns>,
    rows: Vec<f64>,
    shape: Option<Vec<usize>>,
    statuses: Vec<&'static str>,
    /// Why the first element that did not get there did not.
    error: Option<Said>,
}

impl Question {
    fn elements(&self) -> usize {
        self.shape.as_ref().map_or(1, |shape| shape.iter().product())
    }

    /// Its answer.
    fn answer(&self, py: Python<'_>, mechanism: &Mechanism) -> PyResult<At> {
        let compiled = match mechanism.known.find(&self.kind) {
            Some(compiled) => compiled,
            None => {
                let made = interruptible(py, |cancel| Compiled::of(&mechanism.stages, &self.kind, cancel))?;
                let compiled = Arc::new(made.map_err(|said| said.raised(py))?);
                mechanism.known.add(self.kind.clone(), &compiled);
                compiled
            }
        };
        let (elements, width) = (self.elements(), compiled.columns.names.len());
        let too_many = |_| PyMemoryError::new_err("so many elements do not fit into memory; ask for fewer at once");
        let mut rows = Vec::new();
        rows.try_reserve_exact(elements.saturating_mul(width)).map_err(too_many)?;
        let became = if elements <= AT_ONCE {
            py.detach(|| self.all(&compiled, &mut rows, &Cancel::default()))
        } else {
            interruptible(py, |cancel| self.all(&compiled, &mut rows, cancel))?
        };
        let mut statuses = Vec::with_capacity(elements);
        let mut error = None;
        for became in became {
            statuses.push(match became {
                Became::Row => "ok",
                Became::Not(why) => {
                    let code = why.code.as_str();
                    error.get_or_insert_with(|| Said::of_one(*why, compiled.adjustable.compiled().sources()));
                    code
                }
            });
        }
        Ok(At { columns: Arc::clone(&compiled.columns), rows, shape: self.shape.clone(), statuses, error })
    }

    fn all(&self, compiled: &Compiled, rows: &mut Vec<f64>, cancel: &Cancel) -> Vec<Became> {
        let Columns { names, units, is_scaled, .. } = &*compiled.columns;
        let mut became = Vec::with_capacity(self.elements());
        for element in 0..self.elements() {
            let before = rows.len();
            let found = self.one(element, &compiled.adjustable, cancel, |row| {
                // of several rows the last one is that of the time
                rows.truncate(before);
                rows.extend_from_slice(&row[..names.len()]);
            });
            became.push(match found {
                Ok(()) if *is_scaled => {
                    rows[before..].iter_mut().zip(units).for_each(|(value, unit)| *value = unit.printed(*value));
                    Became::Row
                }
                Ok(()) => Became::Row,
                Err(why) => {
                    rows.truncate(before);
                    rows.resize(before + names.len(), f64::NAN);
                    Became::Not(why)
                }
            });
            if cancel.is_cancelled() {
                break;
            }
        }
        became
    }

    fn one(
        &self,
        element: usize,
        adjustable: &Adjustable,
        cancel: &Cancel,
        row: impl FnMut(&[f64]),
    ) -> Result<(), Box<Diagnostic>> {
        let signal = |[value, rate, acceleration]: &[Operand; 3]| Signal {
            value: value.at(element),
            rate: rate.at(element),
            acceleration: acceleration.at(element),
        };
        let inputs: Vec<Signal> = self.inputs.iter().map(signal).collect();
        let params: Vec<f64> = self.params.iter().map(|param| param.at(element)).collect();
        let t = self.t.as_ref().map(|t| t.at(element));
        let times = match (t, inputs.is_empty()) {
            (Some(t), true) => adjustable.times_to(t)?,
            (t, _) => {
                let t = t.or(adjustable.compiled().analysis().map(|[from, ..]| from)).unwrap_or(0.0);
                Times::listed(t, vec![t])
            }
        };
        adjustable.follow(&inputs, &params, &times, cancel, row).map(|_| ())
    }
}

/// Reads a question from keywords.
pub struct Reader<'m, 'py> {
    mechanism: &'m Mechanism,
    py: Python<'py>,
    shapes: Vec<Bound<'py, PyAny>>,
}
