//! Which variants of a sweep may go side by side, a lane for each: those of whose values the check of the text decides nothing else than of
//! others that it has looked at.

use super::families::Families;
use super::options::RunOptions;
use super::{Checked, Variants};
use crate::analysis::Times;
use crate::expr::Symbol;
use crate::model::{DecidedBy, Mechanism};
use crate::program::{Program, Register, Stage};
use crate::sweep::Together;
use std::collections::BTreeSet;

/// What is known of variants that may go side by side.
pub(super) struct Abreast {
    pub together: Together,
    /// All params of one of them (SI).
    values: Vec<f64>,
    /// By param that varies: the numbers of the params that are it.
    places: Vec<Vec<usize>>,
    decided: Decided,
}

/// Formulas of params by whose values something is decided.
struct Decided {
    program: Program,
    /// Where each is left, what of it decides, and its value of one of them.
    all: Vec<(Register, DecidedBy, f64)>,
}

impl Abreast {
    /// Of the variants of a mechanism from one of them on; nothing where they had better go alone.
    pub fn of(
        own: &Checked,
        (variants, first): (&Variants, u64),
        families: &Families,
        wanted: (&Times, &[usize]),
        options: &RunOptions,
    ) -> Option<Abreast> {
        let family = families.only().filter(|_| !own.is_told())?;
        let mut varying = vec![0.0; variants.points().params().len()];
        variants.points().values(first, &mut varying);
        let model_of = |varying: &[f64]| own.model_led_to(variants.read_settings(varying), variants.sources()).0;
        let model = model_of(&varying)?;
        let values = values_of(&model);
        let mut places = Vec::with_capacity(varying.len());
        for k in 0..varying.len() {
            let mut other = varying.clone();
            other[k] = beside(varying[k]);
            let others = values_of(&model_of(&other)?);
            let differs = |&at: &usize| others[at].to_bits() != values[at].to_bits();
            let found: Vec<usize> = (0..values.len()).filter(differs).collect();
            let is_it = |&at: &usize| others[at].to_bits() == other[k].to_bits() && values[at].to_bits() == varying[k].to_bits();
            if others.len() != values.len() || !found.iter().all(is_it) {
                return None;
            }
            places.push(found);
        }
        let led: BTreeSet<u32> = places.iter().flatten().map(|&at| at as u32).collect();
        let led: Vec<u32> = led.into_iter().collect();
        let decided = Decided::of(&model, &led, &values);
        let together = family.from_own.together(&led, wanted, options)?;
        Some(Abreast { together, values, places, decided })
    }

    /// The values of all params of a variant (SI), if what the text's check decides of these is what it decides of others.
    pub fn values(&self, varying: &[f64]) -> Option<Vec<f64>> {
        let mut values = self.values.clone();
        for (places, value) in self.places.iter().zip(varying) {
            places.iter().for_each(|&at| values[at] = *value);
        }
        self.decided.is_the_same(&values).then_some(values)
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
        let mut decided = Decided { program, all };
        let found = decided.found(values);
        decided.all.iter_mut().zip(found).for_each(|(one, value)| one.2 = value);
        decided
    }

    fn found(&self, values: &[f64]) -> Vec<f64> {
        let mut registers = self.program.start(values);
        self.program.run(Stage::Measures, &mut registers);
        self.all.iter().map(|(register, ..)| registers.get(*register)).collect()
    }

    /// Whether the same is decided with other values.
    fn is_the_same(&self, values: &[f64]) -> bool {
        let is_so = |(&(_, by, known), value): (&(Register, DecidedBy, f64), f64)| match by {
            DecidedBy::Finite => value.is_finite(),
            DecidedBy::Sign => value.is_finite() && sign(value) == sign(known),
            DecidedBy::Value => value.to_bits() == known.to_bits(),
        };
        self.all.iter().zip(self.found(values)).all(is_so)
    }
}

/// −1, 0 or 1.
fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}
