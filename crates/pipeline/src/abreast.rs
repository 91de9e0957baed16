//! Which variants of a sweep may go side by side, a lane for each: those of whose values the check of the text decides nothing else than of
//! others that it has looked at.

use super::families::Families;
use super::options::RunOptions;
use super::{AskedTimes, Checked, Variants};
use mechc_engine::sweep::{Each, LANES, PART, Room, Team, Together, WantedOfEach};
use mechc_expr::Symbol;
use mechc_ir::program::{LaneMachine, LaneValues, Program, Register, Registers, Stage};
use mechc_lang::model::{DecidedBy, Mechanism};
use mechc_text::cancel::Cancel;
use std::array::from_fn;
use std::collections::BTreeSet;
use std::sync::Arc;

/// What is known of variants that may go side by side.
pub(super) struct Abreast {
    together: Arc<Together>,
    /// All params of one of them (SI).
    values: Vec<f64>,
    /// By param that varies: the numbers of the params that are it.
    places: Vec<Vec<usize>>,
    decided: Decided,
}

/// Variants side by side, with what is decided of them.
pub(super) struct Side {
    pub team: Team,
    params: Vec<Each>,
    registers: Vec<Each>,
}

/// Formulas of params by whose values something is decided.
struct Decided {
    program: Program,
    /// The registers with the values of one of them.
    registers: Registers,
    /// Where each is left, what of it decides, and its value of that one.
    all: Vec<(Register, DecidedBy, f64)>,
}

impl Abreast {
    /// Of the variants of a mechanism from one of them on; nothing where they had better go alone.
    pub fn of(
        own: &Checked,
        (variants, first): (&Variants, u64),
        families: &Families,
        (asked, columns, results): (&AskedTimes, Option<&[usize]>, bool),
        options: &RunOptions,
    ) -> Option<Abreast> {
        let family = families.only().filter(|_| !own.is_told())?;
        let mut varying = vec![0.0; variants.points().params().len()];
        variants.points().values(first, &mut varying);
        // of a zero other things may be decided than of all others
        varying.iter_mut().filter(|value| **value == 0.0).for_each(|value| *value = beside(0.0));
        let model_of = |varying: &[f64]| own.model_led_to(variants.read_settings(varying), variants.sources()).0;
        let model = model_of(&varying)?;
        let (values, analysis) = (values_of(&model), model.analysis.map(|of| [of.from, of.to, of.every]));
        let times = asked.over(analysis).and_then(|asked| asked.times()).ok()?;
        let mut places = Vec::with_capacity(varying.len());
        for k in 0..varying.len() {
            let mut other = varying.clone();
            other[k] = beside(varying[k]);
            let others = values_of(&model_of(&other)?);
            let differs = |&at: &usize| others[at].to_bits() != values[at].to_bits();
            let found: Vec<usize> = (0..values.len()).filter(differs).collect();
            let is_it = |&at: &usize| {
                others[at].to_bits() == other[k].to_bits() && values[at].to_bits() == varying[k].to_bits()
            };
            if others.len() != values.len() || !found.iter().all(is_it) {
                return None;
            }
            places.push(found);
        }
        let led: BTreeSet<u32> = places.iter().flatten().map(|&at| at as u32).collect();
        let led: Vec<u32> = led.into_iter().collect();
        let decided = Decided::of(&model, &led, &values);
        let together = family.from_own.together(&led, &WantedOfEach { rows: (&times, columns), results }, options)?;
        Some(Abreast { together: Arc::new(together), values, places, decided })
    }

    /// A team, to be followed.
    pub fn side(&self) -> Side {
        let params = self.values.iter().map(|&value| LaneValues([value; LANES])).collect();
        Side { team: Team::new(&self.together), params, registers: self.decided.start() }
    }

    /// How many rows each variant has.
    pub fn rows(&self) -> usize {
        self.together.rows()
    }

    /// Follows as many variants as there are lanes, or fewer, by the values of the params that vary, one variant behind the other; writes their
    /// rows, and says which have all of them, or all their results where no rows are wanted. One of whose values the text's check decides anything
    /// else goes alone.
    pub fn follow(&self, side: &mut Side, varying: &[f64], room: Room<'_>, cancel: &Cancel) -> [bool; LANES] {
        let width = self.places.len();
        let count = varying.len() / width.max(1);
        for (k, places) in self.places.iter().enumerate() {
            // lanes that are left over do the last one again
            let values: [f64; LANES] = from_fn(|lane| varying[lane.min(count - 1) * width + k]);
            for &at in places {
                side.params[at].0 = values;
            }
        }
        let mut those = self.decided.are_the_same(&mut side.registers, &side.params);
        those[count..].fill(false);
        for (those, varying) in those.iter_mut().zip(varying.chunks_exact(width)) {
            *those &= varying.iter().all(|value| value.is_finite() && *value != 0.0);
        }
        side.team.follow(&side.params, those, room, cancel)
    }
}

fn values_of(model: &Mechanism) -> Vec<f64> {
    model.params.iter().map(|param| param.value).collect()
}

/// A value beside another one.
fn beside(value: f64) -> f64 {
    let other = value * (1.0 + f64::from(f32::EPSILON));
    if other.to_bits() == value.to_bits() { f64::from(f32::EPSILON) } else { other }
}

impl Decided {
    /// Those of a mechanism that some of its params enter.
    fn of(model: &Mechanism, led: &[u32], values: &[f64]) -> Decided {
        let enters = |symbol: &Symbol| matches!(symbol, Symbol::Param(k) if led.contains(k));
        let mut formulas = model.decided.clone();
        formulas.sort_unstable_by_key(|&(id, by)| (id.index(), by as u8));
        formulas.dedup();
        formulas.retain(|&(id, _)| model.graph.symbols(id).iter().any(enters));
        let roots: Vec<_> = formulas.iter().map(|&(id, _)| id).collect();
        let (program, registers) = Program::of_formulas(&model.graph, [model.params.len(), 0, 0, 0], &roots);
        let all = registers.into_iter().zip(formulas).map(|(register, (_, by))| (register, by, f64::NAN)).collect();
        let mut values_there = program.start(values);
        program.run(Stage::Measures, &mut values_there);
        let mut decided = Decided { program, registers: values_there, all };
        for (register, _, known) in &mut decided.all {
            *known = decided.registers.get(*register);
        }
        decided
    }

    /// Registers to look at variants with.
    fn start(&self) -> Vec<Each> {
        let all = 0..self.program.registers() as Register;
        all.map(|register| LaneValues([self.registers.get(register); LANES])).collect()
    }

    /// Of which variants the same is decided.
    fn are_the_same(&self, registers: &mut [Each], params: &[Each]) -> [bool; LANES] {
        let Decided { program, registers: scalars, all } = self;
        let first = program.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        let mut machine = LaneMachine::<LANES, PART>::new(registers, LANES / PART, (program, scalars));
        let stages = [Stage::Prologue, Stage::Measures];
        stages.into_iter().flat_map(|stage| program.stage(stage)).for_each(|op| op.run(&mut machine));
        from_fn(|lane| {
            all.iter().all(|&(register, by, known)| {
                let value = registers[register as usize].0[lane];
                match by {
                    DecidedBy::Finite => value.is_finite(),
                    DecidedBy::Sign => value.is_finite() && sign(value) == sign(known),
                    DecidedBy::Value => value.to_bits() == known.to_bits(),
                }
            })
        })
    }
}

/// −1, 0 or 1.
fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}
