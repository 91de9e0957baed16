//! Groups of sweep variants with equal topology: the params that decide counts of declarations have equal values. Each group is compiled
//! once, and its variants are continued from one nominal mechanism.

use crate::continuation::Continuation;
use crate::{Checked, Compiled, Redundant, Variants};
use mechc_text::cancel::Cancel;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Up to this many params that decide counts, all combinations of their least and largest values are compiled to find the widest table.
const MAX_PARAMS_AT_CORNERS: usize = 4;

/// All groups of a sweep.
pub(crate) struct TopologyGroups {
    /// Indices, among the params that vary, of those that decide counts.
    count_params: Vec<usize>,
    redundant: Redundant,
    output_names: OutputNames,
    /// The only group if no param decides counts; otherwise unused.
    only: Arc<TopologyGroup>,
    /// By the bits of the params that decide.
    groups: Mutex<BTreeMap<Vec<u64>, LazyGroup>>,
}

/// Names of the columns and results that a sweep tabulates.
#[derive(Clone)]
pub(crate) struct OutputNames {
    pub columns: Vec<String>,
    pub results: Vec<String>,
}

/// A group that the first thread to need it makes.
type LazyGroup = Arc<OnceLock<Arc<TopologyGroup>>>;

/// One group.
pub(crate) struct TopologyGroup {
    pub continuation: Arc<Continuation>,
    pub outputs: OutputMapping,
}

/// The places of the tabulated columns and results among those of a variant.
pub(crate) enum OutputMapping {
    /// The same places as in the mechanism of the text.
    Identity,
    /// At these indices; `None` if a variant has no such column or result.
    ByName { columns: Vec<Option<usize>>, results: Vec<Option<usize>> },
}

/// Returns the indices of the varying params that decide counts in a variant.
fn count_params(variant: &Checked, variants: &Variants) -> Vec<usize> {
    let counts = variant.count_settings();
    let decides = |name: &String| counts.iter().any(|count| count.path == *name);
    let names = variants.points().params().iter().enumerate();
    names.filter(|(_, name)| decides(name)).map(|(k, _)| k).collect()
}

/// Compiles the mechanism with the params at `indices` as a variant has them; `None` if that is not determined.
fn compiled_with(
    indices: &[usize],
    params: &[f64],
    checked: &Checked,
    variants: &Variants,
    redundant: Redundant,
) -> Option<Compiled> {
    let set = variants.read_settings(params).enumerate().filter(|(k, _)| indices.contains(k));
    let variant = checked.continued_to(set.map(|(_, setting)| setting), variants.sources());
    variant.compile(redundant, &Cancel::default()).0
}

impl Checked {
    /// Returns the variant with the most columns, whose names the table has for all variants: a variant that lacks a column has missing
    /// values there. `None` if no varying param decides counts, and all variants have the columns of the mechanism itself.
    #[must_use]
    pub fn widest(&self, variants: &Variants, redundant: Redundant) -> Option<Compiled> {
        let mut params = variants.values(0);
        let find = || count_params(&self.continued_to(variants.read_settings(&params), variants.sources()), variants);
        let counts = variants.count_params.get_or_init(find);
        if counts.is_empty() {
            return None;
        }
        let mut widest: Option<Compiled> = None;
        // most params add declarations as they grow, some as they shrink
        for corner in 0..1_u32 << counts.len().min(MAX_PARAMS_AT_CORNERS) {
            for (k, &count) in counts.iter().enumerate() {
                let [least, most] = variants.points().ends(count);
                params[count] = if k < MAX_PARAMS_AT_CORNERS && corner >> k & 1 == 1 { least } else { most };
            }
            let columns = |compiled: &Compiled| compiled.columns().len() + compiled.results().len();
            if let Some(compiled) = compiled_with(counts, &params, self, variants, redundant)
                && widest.as_ref().is_none_or(|widest| columns(&compiled) > columns(widest))
            {
                widest = Some(compiled);
            }
        }
        widest
    }
}

impl TopologyGroups {
    /// Groups the variants of a mechanism from the index `first` on.
    pub fn new(
        checked: &Checked,
        variants: &Variants,
        redundant: Redundant,
        output_names: OutputNames,
        first: u64,
    ) -> TopologyGroups {
        let variant = checked.continued_to(variants.read_settings(&variants.values(first)), variants.sources());
        // a table that is laid out by these params must keep to them
        let counts = variants.count_params.get_or_init(|| count_params(&variant, variants)).clone();
        let continuation = variant.continuation(redundant);
        let only = Arc::new(TopologyGroup { continuation, outputs: OutputMapping::Identity });
        TopologyGroups { count_params: counts, redundant, output_names, only, groups: Mutex::default() }
    }

    /// Returns the groups of a mechanism that lacks one of the results, given by its index.
    pub fn without_result(&self, result: usize, checked: &Checked, variants: &Variants, first: u64) -> TopologyGroups {
        let mut output_names = self.output_names.clone();
        output_names.results.remove(result);
        TopologyGroups::new(checked, variants, self.redundant, output_names, first)
    }

    /// Returns the only group; `None` if params decide counts.
    pub fn only(&self) -> Option<&TopologyGroup> {
        self.count_params.is_empty().then_some(&*self.only)
    }

    /// Returns the group of a variant, given by the values of its params.
    pub fn group_of(&self, params: &[f64], checked: &Checked, variants: &Variants) -> Arc<TopologyGroup> {
        if self.count_params.is_empty() {
            return Arc::clone(&self.only);
        }
        let key: Vec<u64> = self.count_params.iter().map(|&count| params[count].to_bits()).collect();
        let group = {
            let mut groups = self.groups.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(groups.entry(key).or_default())
        };
        // outside the lock, so that other threads make other groups meanwhile
        Arc::clone(group.get_or_init(|| Arc::new(self.new_group(params, checked, variants))))
    }

    fn new_group(&self, params: &[f64], checked: &Checked, variants: &Variants) -> TopologyGroup {
        let variant = checked.continued_to(variants.read_settings(params), variants.sources());
        let compiled = compiled_with(&self.count_params, params, checked, variants, self.redundant);
        // a variant that is not determined has no outputs
        let outputs = compiled.map_or(OutputMapping::Identity, |compiled| self.outputs_of(&compiled));
        TopologyGroup { continuation: variant.continuation(self.redundant), outputs }
    }

    /// Returns where the tabulated outputs are in a variant.
    pub fn outputs_of(&self, compiled: &Compiled) -> OutputMapping {
        if self.count_params.is_empty() {
            return OutputMapping::Identity;
        }
        let among = |tabulated: &[String], names: &[String]| -> Vec<Option<usize>> {
            tabulated.iter().map(|name| names.iter().position(|other| other == name)).collect()
        };
        let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
        let columns = among(&self.output_names.columns, &compiled.columns());
        OutputMapping::ByName { columns, results: among(&self.output_names.results, &results) }
    }
}
