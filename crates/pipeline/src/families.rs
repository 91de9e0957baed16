//! Variants of a sweep that have the same declarations: what decides how often something is there is the same in all of a family. Each family
//! is compiled once, and its variants begin where it stands with its own values.

use super::over::FromOwn;
use super::{Checked, Compiled, Redundant, Variants};
use mechc_text::cancel::Cancel;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Of so many params that decide all combinations of their least and largest values are looked at.
const MOST_AT_CORNERS: usize = 4;

/// All families of a sweep.
pub(super) struct Families {
    /// The params that decide how often something is there, by their numbers among those that vary.
    counts: Vec<usize>,
    redundant: Redundant,
    /// The columns and the results that are told, by their names.
    told: [Vec<String>; 2],
    /// The one that there is where nothing decides; else one that nobody asks for.
    only: Arc<Family>,
    /// By the values of what decides (the bits).
    known: Mutex<BTreeMap<Vec<u64>, Made>>,
}

/// A family that is made by whoever asks for it first.
type Made = Arc<OnceLock<Arc<Family>>>;

/// One family.
pub(super) struct Family {
    pub from_own: Arc<FromOwn>,
    pub places: Places,
}

/// Where what is told stands among the columns and results of a variant.
pub(super) enum Places {
    /// Where it stands in the mechanism of the text.
    Same,
    /// Elsewhere; nowhere where this variant has no such column or result.
    Others { columns: Vec<Option<usize>>, results: Vec<Option<usize>> },
}

/// The numbers of the params that decide how often something is there in a variant.
fn deciding(one: &Checked, variants: &Variants) -> Vec<usize> {
    let counts = one.counts();
    let decides = |name: &String| counts.iter().any(|count| count.path == *name);
    let names = variants.points().params().iter().enumerate();
    names.filter(|(_, name)| decides(name)).map(|(k, _)| k).collect()
}

/// The mechanism with some params as a variant has them, by their numbers; nothing where that is not determined.
fn compiled_with(
    those: &[usize],
    params: &[f64],
    (own, variants): (&Checked, &Variants),
    redundant: Redundant,
) -> Option<Compiled> {
    let set = variants.read_settings(params).enumerate().filter(|(k, _)| those.contains(k));
    own.led_to(set.map(|(_, setting)| setting), variants.sources()).compile(redundant, &Cancel::default()).0
}

impl Checked {
    /// Where a param that varies decides how often something is there: that of the variants with the most columns, whose names tables of all of
    /// them are to have; what a variant has not is missing there. Nothing where none decides: all have those of the mechanism itself.
    #[must_use]
    pub fn widest(&self, variants: &Variants, redundant: Redundant) -> Option<Compiled> {
        let mut params = variants.values(0);
        let read = || deciding(&self.led_to(variants.read_settings(&params), variants.sources()), variants);
        let counts = variants.deciding.get_or_init(read);
        if counts.is_empty() {
            return None;
        }
        let mut widest: Option<Compiled> = None;
        // most is there where each has its largest value, or one of them its least
        for corner in 0..1_u32 << counts.len().min(MOST_AT_CORNERS) {
            for (k, &count) in counts.iter().enumerate() {
                let [least, most] = variants.points().ends(count);
                params[count] = if k < MOST_AT_CORNERS && corner >> k & 1 == 1 { least } else { most };
            }
            let columns = |compiled: &Compiled| compiled.columns().len() + compiled.results().len();
            if let Some(compiled) = compiled_with(counts, &params, (self, variants), redundant)
                && widest.as_ref().is_none_or(|widest| columns(&compiled) > columns(widest))
            {
                widest = Some(compiled);
            }
        }
        widest
    }
}

impl Families {
    /// Of the variants of a mechanism from one of them on, whose params are those of all.
    pub fn of(
        (own, variants): (&Checked, &Variants),
        redundant: Redundant,
        told: [Vec<String>; 2],
        first: u64,
    ) -> Families {
        let one = own.led_to(variants.read_settings(&variants.values(first)), variants.sources());
        // where tables have been laid out by them, these and no others
        let counts = variants.deciding.get_or_init(|| deciding(&one, variants)).clone();
        let only = Arc::new(Family { from_own: one.begins_at_own(redundant), places: Places::Same });
        Families { counts, redundant, told, only, known: Mutex::default() }
    }

    /// The same of a mechanism that has all but one of the results that are told, by its number.
    pub fn without(&self, result: usize, (own, variants): (&Checked, &Variants), first: u64) -> Families {
        let mut told = self.told.clone();
        told[1].remove(result);
        Families::of((own, variants), self.redundant, told, first)
    }

    /// The only one, where nothing decides.
    pub fn only(&self) -> Option<&Family> {
        self.counts.is_empty().then_some(&*self.only)
    }

    /// The family of a variant, by the values of its params.
    pub fn that_of(&self, params: &[f64], own: &Checked, variants: &Variants) -> Arc<Family> {
        if self.counts.is_empty() {
            return Arc::clone(&self.only);
        }
        let key: Vec<u64> = self.counts.iter().map(|&count| params[count].to_bits()).collect();
        let family = {
            let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(known.entry(key).or_default())
        };
        // others are made meanwhile
        Arc::clone(family.get_or_init(|| Arc::new(self.family(params, own, variants))))
    }

    fn family(&self, params: &[f64], own: &Checked, variants: &Variants) -> Family {
        let one = own.led_to(variants.read_settings(params), variants.sources());
        let compiled = compiled_with(&self.counts, params, (own, variants), self.redundant);
        // of one that is not determined nothing is told
        let places = compiled.map_or(Places::Same, |compiled| self.places_in(&compiled));
        Family { from_own: one.begins_at_own(self.redundant), places }
    }

    /// Where what is told stands in a variant.
    pub fn places_in(&self, compiled: &Compiled) -> Places {
        if self.counts.is_empty() {
            return Places::Same;
        }
        let among = |told: &[String], names: &[String]| -> Vec<Option<usize>> {
            told.iter().map(|name| names.iter().position(|other| other == name)).collect()
        };
        let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
        let [columns_told, results_told] = &self.told;
        let (columns, results) = (among(columns_told, &compiled.columns()), among(results_told, &results));
        Places::Others { columns, results }
    }
}
