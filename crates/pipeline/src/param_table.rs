//! Other values of params without another check.
//!
//! A check reads the values of params and decides some things by them: that a radius is positive, in which direction a point lies, how many
//! copies there are. A [`ParamTable`] holds the params of one checked model and its guards, the formulas whose values decided something. Values
//! by which the check would decide nothing differently are bound by evaluating the guards; others are checked anew.

use crate::{Checked, Variants};
use mechc_engine::sweep::{CHUNK, LANES, PerLane};
use mechc_expr::{ExprId, Symbol};
use mechc_ir::program::{LaneMachine, LaneValues, Program, Register, Registers, Stage};
use mechc_lang::check::override_matches;
use mechc_lang::model::{ContinuedParam, GuardKind, Mechanism};
use mechc_text::diag::Error;
use std::array::from_fn;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};

/// Largest number of tables of one mechanism.
const MOST_TABLES: usize = 64;

/// Values of all params of a model (SI), with the analysis that they lead to.
#[derive(Clone, Debug)]
pub(crate) struct Bindings {
    pub values: Vec<f64>,
    /// First time, last time and step (s); `None` without an analysis.
    pub analysis: Option<[f64; 3]>,
}

impl Bindings {
    /// Returns the bindings of a model as it was checked.
    pub fn new(model: &Mechanism) -> Bindings {
        Bindings {
            values: model.params.iter().map(|param| param.value).collect(),
            analysis: model.analysis.map(|analysis| [analysis.from, analysis.to, analysis.every]),
        }
    }
}

/// The params of a checked model that may take other values, and the guards of its check.
#[derive(Debug)]
pub(crate) struct ParamTable {
    checked: Bindings,
    /// The params that may vary, in the order of their names.
    varying: Vec<VaryingParam>,
    /// Evaluates guards and analysis.
    program: Program,
    /// The registers with the values of the check.
    registers: Registers,
    guards: Vec<Guard>,
    /// The registers of the analysis, if it depends on params that vary.
    analysis: Option<[Register; 3]>,
}

#[derive(Debug)]
struct VaryingParam {
    /// The value of the check (SI).
    value: f64,
    /// The indices of the model's params that take the value; empty if the check decides counts by it, which keeps it.
    targets: Vec<usize>,
}

/// A formula by whose value the check decided something.
#[derive(Debug)]
struct Guard {
    register: Register,
    kind: GuardKind,
    /// The value of the check.
    checked: f64,
}

impl Guard {
    fn holds(&self, value: f64) -> bool {
        match self.kind {
            GuardKind::Finite => value.is_finite(),
            GuardKind::Sign => value.is_finite() && sign(value) == sign(self.checked),
            GuardKind::Value => value.to_bits() == self.checked.to_bits(),
        }
    }
}

/// Returns −1, 0 or 1; 0 for NaN.
fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

impl ParamTable {
    /// Makes the table of a model in which the params of the given names are symbols, checked with the given values (SI).
    pub fn new(model: &Mechanism, names: &[String], values: &[f64]) -> ParamTable {
        let targets = |name: &String| {
            let is_named = |param: &&ContinuedParam| override_matches(&param.declared.name, name);
            model.continued.iter().filter(is_named).filter_map(|param| Some(param.param? as usize)).collect()
        };
        let varying: Vec<VaryingParam> =
            names.iter().zip(values).map(|(name, &value)| VaryingParam { value, targets: targets(name) }).collect();
        let varies = |id: ExprId| {
            let is_target = |at: usize| varying.iter().any(|param| param.targets.contains(&at));
            model.graph.symbols(id).iter().any(|symbol| matches!(symbol, Symbol::Param(k) if is_target(*k as usize)))
        };
        let mut guards = model.guards.clone();
        guards.sort_unstable_by_key(|&(id, kind)| (id.index(), kind as u8));
        guards.dedup();
        guards.retain(|&(id, _)| varies(id));
        let analysis =
            model.analysis.map(|analysis| analysis.formulas).filter(|times| times.iter().any(|&id| varies(id)));
        let roots: Vec<ExprId> = guards.iter().map(|&(id, _)| id).chain(analysis.into_iter().flatten()).collect();
        let (program, outputs) = Program::of_formulas(&model.graph, [model.params.len(), 0, 0, 0], &roots);
        let checked = Bindings::new(model);
        let mut registers = program.start(&checked.values);
        program.run(Stage::Measures, &mut registers);
        let guard = |(&register, &(_, kind)): (&Register, &(ExprId, GuardKind))| Guard {
            register,
            kind,
            checked: registers.get(register),
        };
        let all = outputs.iter().zip(&guards).map(guard).collect();
        let analysis = analysis.map(|_| from_fn(|k| outputs[guards.len() + k]));
        ParamTable { checked, varying, program, registers, guards: all, analysis }
    }

    /// Returns the bindings of the check.
    pub fn checked(&self) -> &Bindings {
        &self.checked
    }

    /// Returns, for each param that varies, the indices of the model's params that take its value.
    pub fn targets(&self) -> impl Iterator<Item = &[usize]> {
        self.varying.iter().map(|param| param.targets.as_slice())
    }

    /// Binds values of the params that vary (SI), in the order of their names; `None` if the check may decide otherwise with them.
    pub fn bind(&self, varying: &[f64]) -> Option<Bindings> {
        let mut bindings = self.checked.clone();
        for (param, &value) in self.varying.iter().zip(varying) {
            if !param.admits(value) {
                return None;
            }
            for &at in &param.targets {
                bindings.values[at] = value;
            }
        }
        let mut registers = self.program.start(&bindings.values);
        self.program.run(Stage::Measures, &mut registers);
        if !self.guards.iter().all(|guard| guard.holds(registers.get(guard.register))) {
            return None;
        }
        if let Some(analysis) = self.analysis {
            let times @ [from, to, every] = analysis.map(|register| registers.get(register));
            if !(times.iter().all(|t| t.is_finite()) && from <= to && every > 0.0) {
                return None;
            }
            bindings.analysis = Some(times);
        }
        Some(bindings)
    }

    /// Returns registers for [`ParamTable::admits_lanes`].
    pub fn lane_registers(&self) -> Vec<PerLane> {
        let all = 0..self.program.registers() as Register;
        all.map(|register| LaneValues([self.registers.get(register); LANES])).collect()
    }

    /// Returns for which lanes the check decides as it did, and leads to the same analysis. `params` are all params of the model, `varying` those
    /// that vary, lane by lane.
    pub fn admits_lanes(&self, registers: &mut [PerLane], params: &[PerLane], varying: &[f64]) -> [bool; LANES] {
        let first = self.program.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        let mut machine = LaneMachine::<LANES, CHUNK>::new(registers, LANES / CHUNK, (&self.program, &self.registers));
        let stages = [Stage::Prologue, Stage::Measures];
        stages.into_iter().flat_map(|stage| self.program.stage(stage)).for_each(|op| op.run(&mut machine));
        let analysis = self.analysis.zip(self.checked.analysis);
        let is_admitted = |lane: usize| {
            let value = |register: Register| registers[register as usize].0[lane];
            self.guards.iter().all(|guard| guard.holds(value(guard.register)))
                && analysis
                    .is_none_or(|(registers, times)| registers.map(value).map(f64::to_bits) == times.map(f64::to_bits))
        };
        let mut lanes = varying.chunks_exact(self.varying.len().max(1));
        from_fn(|lane| {
            let values = lanes.next();
            let admits = |values: &[f64]| self.varying.iter().zip(values).all(|(param, &value)| param.admits(value));
            values.is_some_and(admits) && is_admitted(lane)
        })
    }
}

impl VaryingParam {
    /// Returns whether the param may take a value. A zero may decide otherwise than any other value: it fits any dimension.
    fn admits(&self, value: f64) -> bool {
        if self.targets.is_empty() {
            value.to_bits() == self.value.to_bits()
        } else {
            value.is_finite() && value != 0.0
        }
    }
}

/// Binds values of params of one mechanism; checks it anew for values by which its check decides otherwise than before.
#[derive(Debug)]
pub(crate) struct Binder {
    checked: Checked,
    variants: Variants,
    /// A table for each way in which the check has decided.
    tables: RwLock<Vec<Arc<ParamTable>>>,
}

impl Binder {
    /// Creates a binder of the params that vary among variants.
    pub fn new(checked: &Checked, variants: &Variants) -> Binder {
        let checked = checked.with_open_params(variants.points().params());
        Binder { checked, variants: variants.clone(), tables: RwLock::default() }
    }

    /// Binds values of the params (SI), in the order of their names.
    ///
    /// # Errors
    /// The mechanism has errors with these values.
    pub fn bind(&self, varying: &[f64]) -> Result<Bindings, Error> {
        let bound = self.tables().iter().find_map(|table| table.bind(varying));
        if let Some(bindings) = bound {
            return Ok(bindings);
        }
        let model = self.model(varying)?;
        let has_room = self.tables().len() < MOST_TABLES;
        if has_room && varying.iter().all(|value| value.is_finite() && *value != 0.0) {
            self.add(ParamTable::new(&model, self.variants.points().params(), varying));
        }
        Ok(Bindings::new(&model))
    }

    /// Returns the table of the check with the given values, or with values near to those that are zero; `None` if the mechanism has errors
    /// with them.
    pub fn table(&self, varying: &[f64]) -> Option<Arc<ParamTable>> {
        let nonzero = |value: &f64| if *value == 0.0 { f64::from(f32::EPSILON) } else { *value };
        let varying: Vec<f64> = varying.iter().map(nonzero).collect();
        let model = self.model(&varying).ok()?;
        Some(self.add(ParamTable::new(&model, self.variants.points().params(), &varying)))
    }

    fn model(&self, varying: &[f64]) -> Result<Mechanism, Error> {
        let settings = self.variants.read_settings(varying);
        let (model, diagnostics) = self.checked.model_with(settings, self.variants.sources());
        model.ok_or_else(|| Error::new(diagnostics, self.variants.sources()))
    }

    fn tables(&self) -> RwLockReadGuard<'_, Vec<Arc<ParamTable>>> {
        self.tables.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, table: ParamTable) -> Arc<ParamTable> {
        let table = Arc::new(table);
        let mut tables = self.tables.write().unwrap_or_else(PoisonError::into_inner);
        if tables.len() < MOST_TABLES {
            tables.push(Arc::clone(&table));
        }
        table
    }
}
