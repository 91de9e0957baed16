//! The nominal mechanism, with the values of its text, and continuation from there to other values.

use super::context::{ContinuationContext, ContinuedStart, Nominal, Outcome};
use crate::options::RunOptions;
use mechc_engine::analysis::{Horizon, Times};
use mechc_engine::sweep::{BatchContext, BatchRequest};
use mechc_ir::ConstraintSystem;
use std::sync::{Arc, OnceLock};

/// Makes the nominal mechanism; `None` if it cannot be assembled.
type NominalFactory = dyn Fn(&RunOptions) -> Option<Nominal> + Send + Sync;

/// Continuation from the nominal mechanism, which is made and cached at the first use.
pub(crate) struct Continuation {
    make_nominal: Box<NominalFactory>,
    /// `None` inside if the mechanism cannot be assembled with its nominal values.
    context: OnceLock<Option<Arc<ContinuationContext>>>,
}

impl Continuation {
    pub fn new(make_nominal: impl Fn(&RunOptions) -> Option<Nominal> + Send + Sync + 'static) -> Continuation {
        Continuation { make_nominal: Box::new(make_nominal), context: OnceLock::new() }
    }

    /// Continues to the param values of a system of the same text.
    pub fn start_system(&self, system: &ConstraintSystem, horizon: Horizon, options: &RunOptions) -> ContinuedStart {
        let start = |context: Arc<ContinuationContext>| context.start_system(system, horizon, &options.cancel);
        self.context(options).map_or_else(Default::default, start)
    }

    /// Continues to values of all params (SI); results may refuse the times.
    pub fn start_values(&self, values: &[f64], times: &Times, options: &RunOptions) -> Outcome {
        let start = |context: Arc<ContinuationContext>| context.start_values(values, times, &options.cancel);
        self.context(options).map_or(Outcome::NoPath(None), start)
    }

    /// Returns what a batch of variants shares; `None` if such variants have to be computed alone.
    pub fn batch(&self, wanted: &BatchRequest<'_>, options: &RunOptions) -> Option<BatchContext> {
        let context = self.context(options)?;
        // a variant that begins at another time without inputs set there is followed to that time
        let is_at_start = wanted.rows.0.from().to_bits() == context.options.t.to_bits();
        if !is_at_start && !context.nominal.sets_inputs {
            return None;
        }
        let base = context.base(&context.values, wanted.rows.0.from(), &options.cancel)?;
        BatchContext::of(base, &context.nominal.started, wanted, options.vectors)
    }

    fn context(&self, options: &RunOptions) -> Option<Arc<ContinuationContext>> {
        let make = || (self.make_nominal)(options).map(|nominal| Arc::new(ContinuationContext::new(nominal, options)));
        match self.context.get() {
            Some(Some(cached)) if !cached.has_options(options) => make(),
            Some(cached) => cached.clone(),
            None => {
                let context = make();
                // the outcome of cancelled work must not be kept
                if options.cancel.is_cancelled() { None } else { self.context.get_or_init(|| context).clone() }
            }
        }
    }
}
