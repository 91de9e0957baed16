//! Params with tolerances that follow other params. The text differentiates along their formulas; a tolerance moves one param and holds all
//! others.

use super::Tolerance;
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{Mechanism, Named, ReductionKind, Variable};

/// The dependence of params with tolerances on each other.
#[derive(Default)]
pub(super) struct Followers {
    /// Params that others follow, those first that are declared last, each with its followers and their derivatives by it. Numbers are those of
    /// the tolerances.
    followed: Vec<(usize, Vec<(usize, f64)>)>,
    /// Names of the measures and results that hold a derivative by what a param with a tolerance follows.
    differentiating: Vec<String>,
}

impl Followers {
    /// Finds the followers among params with tolerances, by which `model` is differentiated.
    pub fn new(model: &Mechanism, tolerances: &[Tolerance]) -> Followers {
        let number = |tolerance: &Tolerance| {
            model.variables.iter().position(|variable| variable.declared.name == tolerance.name)
        };
        let numbers: Vec<Option<usize>> = tolerances.iter().map(number).collect();
        let mut model = model.clone();
        let mut followed = Vec::new();
        for (k, number) in numbers.iter().enumerate() {
            let Some(number) = *number else { continue };
            let others: Vec<(usize, ExprId)> = numbers
                .iter()
                .enumerate()
                .filter_map(|(j, &other)| Some((j, model.variables[other.filter(|&other| other != number)?].value)))
                .collect();
            let values: Vec<ExprId> = others.iter().map(|&(_, value)| value).collect();
            let symbol = model.variables[number].symbol;
            let slopes =
                model.graph.derivatives(&values, |graph, other| (other == symbol).then(|| graph.constant(1.0)));
            let slopes = others.iter().zip(slopes).filter(|(_, slope)| !model.graph.is_zero(*slope));
            let followers: Vec<(usize, f64)> =
                slopes.map(|(&(j, _), slope)| (j, model.value_at(slope, f64::NAN))).collect();
            if !followers.is_empty() {
                followed.push((number, k, followers));
            }
        }
        followed.sort_unstable_by_key(|&(number, ..)| std::cmp::Reverse(number));
        let followed = followed.into_iter().map(|(_, k, followers)| (k, followers)).collect();
        let followers = numbers.iter().flatten().map(|&number| &model.variables[number]);
        let followers: Vec<&Variable> = followers.filter(|of| matches!(of.symbol, Symbol::Shift(_))).collect();
        let differentiating = differentiating(&model, &followers);
        Followers { followed, differentiating }
    }

    /// Turns derivatives along the formulas of the text, by each param with a tolerance, into those that hold all other such params. A derivative
    /// that is not known is NaN.
    pub fn hold_others(&self, slopes: &mut [f64]) {
        for (k, followers) in &self.followed {
            slopes[*k] -= followers.iter().map(|&(j, slope)| slopes[j] * slope).sum::<f64>();
        }
    }

    /// Returns whether no param with a tolerance follows another one.
    pub fn is_empty(&self) -> bool {
        self.followed.is_empty()
    }

    /// Returns whether a measure or result differs in a variant that sets the followers: it is differentiated by what they follow.
    pub fn change(&self, output: &str) -> bool {
        self.differentiating.iter().any(|name| name == output)
    }
}

/// Returns the names of the measures and results that hold a derivative by what some variables follow.
fn differentiating(model: &Mechanism, followers: &[&Variable]) -> Vec<String> {
    let is_followed = |variable: &Variable| {
        let follows = |follower: &&Variable| {
            follower.symbol != variable.symbol && model.graph.symbols(follower.value).contains(&variable.symbol)
        };
        followers.iter().any(follows)
    };
    let holds = |formula: ExprId| {
        let mut open = vec![formula];
        while let Some(formula) = open.pop() {
            for symbol in model.graph.symbols(formula) {
                let Symbol::Named(k) = symbol else { continue };
                match model.named[k as usize] {
                    Named::By(_, variable) if is_followed(&model.variables[variable as usize]) => return true,
                    // A symbol refers to earlier symbols only, so that this ends.
                    Named::By(inner, _) | Named::Derivative(inner) => open.push(inner),
                    Named::Reduction(k) => {
                        let reduction = &model.reductions[k as usize];
                        open.extend([Some(reduction.of)].into_iter().chain(reduction.window).flatten());
                        if let ReductionKind::At(time) = reduction.kind {
                            open.push(time);
                        }
                    }
                    Named::Quantity(..) | Named::Exists(..) | Named::Force(..) | Named::Argument => {}
                }
            }
        }
        false
    };
    let measures = model.measures.iter().map(|measure| (&measure.declared.name, measure.value));
    let results = model.outcomes.iter().map(|outcome| (&outcome.declared.name, outcome.value));
    measures.chain(results).filter(|&(_, value)| holds(value)).map(|(name, _)| name.clone()).collect()
}
