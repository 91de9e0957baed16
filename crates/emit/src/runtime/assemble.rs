//! Assembly at the start of a motion.

use super::branches::sides_near;
use super::error::{Error, Fault};
use super::limits::{FIRST_PARTS, LARGEST_CORRECTION, MOST_PARTS, MOST_SHORTER, MOST_TRIALS, SMALLEST_PART};
use super::numbers::Numbers;
use super::reach::reach;
use super::solution::Solution;
use super::state::{Assembly, Continuation, Parameters, State, Timed};
use super::track::Track;
use super::work::{Work, of_reaching, of_sides};

/// Largest number of evaluations of an assembly.
pub const fn most_work<M: Timed>() -> usize {
    let of_start = of_sides::<M>() + of_reaching::<M>();
    (2 + FIRST_PARTS + MOST_PARTS) * (of_start + of_sides::<M>() + 1)
        + of_sides::<M>()
        + (1 + MOST_SHORTER) * MOST_TRIALS
}

/// Assembles the mechanism at its first time with the given parameters: along the branch of the file's parameters if a
/// short path leads there, else from the poses that the file draws with these parameters, and only then along a long path.
pub fn assemble<M: Timed>(params: &M::Params, work: &mut Work) -> Result<State<M>, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let mut path = ParameterPath::<M>::new(work)?;
    let model = M::new(params);
    match path.advance(params, FIRST_PARTS, work) {
        Ok(at) => return Ok(path.state(model, at, Assembly::Led)),
        Err(Error::NotANumber) => return Err(Error::NotANumber),
        Err(_) => {}
    }
    let mut at = path.at;
    let drawn = model.closed(&model.drawn(), M::START_TIME, work);
    if drawn.is_some_and(|q| start(&q, &model, &mut at, work).is_ok()) {
        return Ok(path.state(model, at, Assembly::Drawn));
    }
    let at = path.advance(params, MOST_PARTS, work)?;
    Ok(path.state(model, at, Assembly::Led))
}

/// The path from the file's parameters to others.
struct ParameterPath<M: Timed> {
    /// Steepness of the equations with the file's parameters.
    usual: f64,
    /// Solution at the present position.
    at: Solution<M>,
    /// Fraction that is done, and the next increment to try.
    done: f64,
    part: f64,
}

impl<M: Timed> ParameterPath<M> {
    /// Creates the path at its beginning.
    fn new(work: &mut Work) -> Result<Self, Error> {
        let mut at = Solution::ZERO;
        start(M::start(), &M::new(&M::Params::default()), &mut at, work).map_err(Fault::at_start)?;
        Ok(Self { usual: at.steepest, at, done: 0.0, part: 1.0 })
    }

    /// Continues to the end in at most `most` trials.
    fn advance(&mut self, params: &M::Params, most: usize, work: &mut Work) -> Result<Solution<M>, Error> {
        let (file, mut found, mut why) = (M::Params::default(), self.at, Error::Divergence);
        for _ in 0..most {
            let next = f64::min(self.done + self.part, 1.0);
            let is_last = next >= 1.0;
            let params = if is_last { *params } else { file.towards(params, next) };
            let model = M::new(&params);
            let is_far = self.part < 1.0 && is_far(&self.at.q, &model, &mut found, work);
            let result = if is_far { Err(Fault::TooFar) } else { start(&self.at.q, &model, &mut found, work) };
            if result.is_ok() && found.is_negative == self.at.is_negative {
                if is_last {
                    return Ok(found);
                }
                (self.at, self.done, self.part) = (found, next, 2.0 * self.part);
            } else {
                why = result.err().map_or(Error::Divergence, Fault::at_start);
                self.part *= 0.5;
            }
            if self.part < SMALLEST_PART {
                break;
            }
        }
        Err(why)
    }

    /// Creates the state at a solution.
    fn state(&self, model: M, at: Solution<M>, assembly: Assembly) -> State<M> {
        let ratio = at.steepest / self.usual;
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        State {
            steepness: if ratio > 0.0 { ratio } else { 1.0 },
            continuation: M::Continuation::new(model.params()),
            model,
            track: Track { solutions: [at, self.at], is_second: false, is_smooth: false, stride: M::LONGEST_STEP },
            assembly,
            passed,
        }
    }
}

/// Returns whether a position is too far away to solve from by the operations alone; pivoting would cost many times as
/// much.
fn is_far<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> bool {
    let sides = sides_near(q, M::START_TIME, m, work);
    work.add(1);
    m.solve(&M::tears(q), M::START_TIME, &sides, at);
    !at.is_settled && at.first > LARGEST_CORRECTION
}

/// Solves at the first time from a position nearby.
fn start<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> Result<(), Fault> {
    let mut near = Solution::near(q, M::START_TIME);
    near.sides = sides_near(q, M::START_TIME, m, work);
    reach(&M::tears(q), &near, M::START_TIME, m, at, work)?;
    if at.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Fault::TooFar) }
}
