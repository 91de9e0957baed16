//! The start of a motion.

use super::branches::sides_near;
use super::error::{Error, Fault};
use super::limits::{LARGEST_CORRECTION, MOST_PARTS, SMALLEST_PART};
use super::numbers::Numbers;
use super::reach::reach;
use super::solution::Solution;
use super::state::{Lead, Parameters, State, Timed};

/// Brings the mechanism to its first time with some parameters, along the branch that the file's parameters give.
pub fn assemble<M: Timed>(params: &M::Params) -> Result<State<M>, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let file = M::Params::default();
    let mut at = Solution::ZERO;
    start(M::start(), &M::new(&file), &mut at).map_err(Fault::at_start)?;
    let mut found = at.clone();
    let usual = at.steepest;
    let mut why = Error::Divergence;
    // the part of the way from the file's parameters to those that are wanted
    let (mut done, mut part) = (0.0, 1.0);
    for _ in 0..MOST_PARTS {
        let next = f64::min(done + part, 1.0);
        let params = if next < 1.0 { file.towards(params, next) } else { *params };
        let model = M::new(&params);
        let result = start(&at.q, &model, &mut found);
        if result.is_ok() && found.is_negative == at.is_negative {
            if next >= 1.0 {
                let ratio = found.steepest / usual;
                let mut passed = M::Passed::ZERO;
                passed.as_mut().fill(f64::NEG_INFINITY);
                return Ok(State {
                    steepness: if ratio > 0.0 { ratio } else { 1.0 },
                    lead: M::Lead::new(&params),
                    model,
                    solutions: [found, at],
                    is_second: false,
                    is_smooth: false,
                    step: M::LONGEST_STEP,
                    passed,
                });
            }
            at.clone_from(&found);
            (done, part) = (next, 2.0 * part);
        } else {
            why = result.err().map_or(Error::Divergence, Fault::at_start);
            part *= 0.5;
        }
        if part < SMALLEST_PART {
            break;
        }
    }
    Err(why)
}

/// Solves at the first time, from a position nearby.
fn start<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>) -> Result<(), Fault> {
    let mut near = Solution::near(q, M::START_TIME);
    near.sides = sides_near(q, M::START_TIME, m);
    reach(&M::tears(q), &near, M::START_TIME, m, at)?;
    if at.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Fault::TooFar) }
}
