//! Decides which sweep variants may share a batch: those for which every value-dependent decision of the checker equals that of a reference
//! variant.

use crate::options::RunOptions;
use crate::sweep::TopologyGroups;
use crate::{Checked, RequestedTimes, Variants};
use mechc_engine::sweep::{BatchContext, BatchRequest, BatchRunner, CHUNK, LANES, PerLane, RowBuffer};
use mechc_expr::Symbol;
use mechc_ir::program::{LaneMachine, LaneValues, Program, Register, Registers, Stage};
use mechc_lang::model::{GuardKind, Mechanism};
use mechc_text::cancel::Cancel;
use std::array::from_fn;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The data that variants of a sweep share in lanes.
pub(crate) struct BatchPlan {
    batch: Arc<BatchContext>,
    /// All params of the reference variant (SI).
    values: Vec<f64>,
    /// For each param that varies: the indices of the model's params that equal it.
    targets: Vec<Vec<usize>>,
    guards: Guards,
}

/// The rows and results that a sweep computes of each variant.
pub(crate) struct Requested<'r> {
    pub times: &'r RequestedTimes,
    /// The columns of the rows, if rows are requested.
    pub columns: Option<&'r [usize]>,
    pub results: bool,
}

/// Lanes of variants, with the registers of their guards.
pub(crate) struct BatchLanes {
    pub runner: BatchRunner,
    params: Vec<PerLane>,
    registers: Vec<PerLane>,
}

/// Formulas of params by which the checker decides something, evaluated for the reference variant.
struct Guards {
    program: Program,
    /// The registers of the reference variant.
    registers: Registers,
    all: Vec<Guard>,
}

struct Guard {
    register: Register,
    by: GuardKind,
    /// Its value in the reference variant.
    reference: f64,
}

impl BatchPlan {
    /// Makes the plan for the variants of a mechanism from the index `first` on; `None` if they have to be computed alone.
    pub fn new(
        checked: &Checked,
        variants: &Variants,
        first: u64,
        groups: &TopologyGroups,
        requested: &Requested<'_>,
        options: &RunOptions,
    ) -> Option<BatchPlan> {
        let group = groups.only().filter(|_| !checked.has_given_inputs())?;
        let mut varying = vec![0.0; variants.points().params().len()];
        variants.points().values(first, &mut varying);
        // at zero the checker may decide otherwise than anywhere near it
        varying.iter_mut().filter(|value| **value == 0.0).for_each(|value| *value = near(0.0));
        let model_of = |varying: &[f64]| checked.model_with(variants.read_settings(varying), variants.sources()).0;
        let model = model_of(&varying)?;
        let (values, analysis) =
            (values_of(&model), model.analysis.map(|analysis| [analysis.from, analysis.to, analysis.every]));
        let times = requested.times.over(analysis).and_then(|times| times.times()).ok()?;
        let mut targets = Vec::with_capacity(varying.len());
        for k in 0..varying.len() {
            let mut other = varying.clone();
            other[k] = near(varying[k]);
            let others = values_of(&model_of(&other)?);
            let differs = |&at: &usize| others[at].to_bits() != values[at].to_bits();
            let changed: Vec<usize> = (0..values.len()).filter(differs).collect();
            let is_copy = |&at: &usize| {
                others[at].to_bits() == other[k].to_bits() && values[at].to_bits() == varying[k].to_bits()
            };
            if others.len() != values.len() || !changed.iter().all(is_copy) {
                return None;
            }
            targets.push(changed);
        }
        let params: BTreeSet<u32> = targets.iter().flatten().map(|&at| at as u32).collect();
        let params: Vec<u32> = params.into_iter().collect();
        let guards = Guards::new(&model, &params, &values);
        let wanted = BatchRequest { rows: (&times, requested.columns), results: requested.results };
        let batch = Arc::new(group.continuation.batch(&params, &wanted, options)?);
        Some(BatchPlan { batch, values, targets, guards })
    }

    /// Returns lanes for variants to follow.
    pub fn lanes(&self) -> BatchLanes {
        let params = self.values.iter().map(|&value| LaneValues([value; LANES])).collect();
        BatchLanes { runner: BatchRunner::new(&self.batch), params, registers: self.guards.registers_of_lanes() }
    }

    /// Returns the number of rows of each variant.
    pub fn rows(&self) -> usize {
        self.batch.rows()
    }

    /// Follows up to `LANES` variants, given by the values of the varying params, variant by variant, and writes their rows. Returns which of
    /// them have all rows, or all results if no rows are requested. Variants whose guards differ from the reference are not followed.
    pub fn follow(
        &self,
        lanes: &mut BatchLanes,
        varying: &[f64],
        room: RowBuffer<'_>,
        cancel: &Cancel,
    ) -> [bool; LANES] {
        let width = self.targets.len();
        let count = varying.len() / width.max(1);
        for (k, targets) in self.targets.iter().enumerate() {
            // lanes without a variant repeat the last one
            let values: [f64; LANES] = from_fn(|lane| varying[lane.min(count - 1) * width + k]);
            for &at in targets {
                lanes.params[at].0 = values;
            }
        }
        let mut eligible = self.guards.hold(&mut lanes.registers, &lanes.params);
        eligible[count..].fill(false);
        for (eligible, varying) in eligible.iter_mut().zip(varying.chunks_exact(width)) {
            *eligible &= varying.iter().all(|value| value.is_finite() && *value != 0.0);
        }
        lanes.runner.follow(&lanes.params, eligible, room, cancel)
    }
}

fn values_of(model: &Mechanism) -> Vec<f64> {
    model.params.iter().map(|param| param.value).collect()
}

/// Returns another value near the given one.
fn near(value: f64) -> f64 {
    let other = value * (1.0 + f64::from(f32::EPSILON));
    if other.to_bits() == value.to_bits() { f64::from(f32::EPSILON) } else { other }
}

impl Guards {
    /// Collects the decisive formulas of a model that hold one of the given params.
    fn new(model: &Mechanism, params: &[u32], values: &[f64]) -> Guards {
        let varies = |symbol: &Symbol| matches!(symbol, Symbol::Param(k) if params.contains(k));
        let mut formulas = model.guards.clone();
        formulas.sort_unstable_by_key(|&(id, by)| (id.index(), by as u8));
        formulas.dedup();
        formulas.retain(|&(id, _)| model.graph.symbols(id).iter().any(varies));
        let roots: Vec<_> = formulas.iter().map(|&(id, _)| id).collect();
        let (program, outputs) = Program::of_formulas(&model.graph, [model.params.len(), 0, 0, 0], &roots);
        let mut registers = program.start(values);
        program.run(Stage::Measures, &mut registers);
        let guard = |(register, (_, by))| Guard { register, by, reference: registers.get(register) };
        let all = outputs.into_iter().zip(formulas).map(guard).collect();
        Guards { program, registers, all }
    }

    fn registers_of_lanes(&self) -> Vec<PerLane> {
        let all = 0..self.program.registers() as Register;
        all.map(|register| LaneValues([self.registers.get(register); LANES])).collect()
    }

    /// Returns for which lanes all guards decide as for the reference variant.
    fn hold(&self, registers: &mut [PerLane], params: &[PerLane]) -> [bool; LANES] {
        let Guards { program, registers: scalars, all } = self;
        let first = program.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        let mut machine = LaneMachine::<LANES, CHUNK>::new(registers, LANES / CHUNK, (program, scalars));
        let stages = [Stage::Prologue, Stage::Measures];
        stages.into_iter().flat_map(|stage| program.stage(stage)).for_each(|op| op.run(&mut machine));
        from_fn(|lane| {
            all.iter().all(|&Guard { register, by, reference }| {
                let value = registers[register as usize].0[lane];
                match by {
                    GuardKind::Finite => value.is_finite(),
                    GuardKind::Sign => value.is_finite() && sign(value) == sign(reference),
                    GuardKind::Value => value.to_bits() == reference.to_bits(),
                }
            })
        })
    }
}

/// Returns −1, 0 or 1; 0 for NaN.
fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}
