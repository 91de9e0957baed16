/// Leads a state from its inputs to others, along the straight line between them, in as many steps
/// as the branch asks for; their rates and accelerations there decide velocities and accelerations.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one; [`follow_within`] takes as many as it is
/// allowed. A kink of a formula on the way is passed. What a measure makes of more than the
/// accelerations of inputs has no value. [`step`] goes on by the text's formulas: it first leads
/// back to what these say of the inputs at the state's time.
///
/// # Errors
/// Why it cannot get there; the state stays as it was, but for [`Error::TooFar`].
pub fn follow(inputs: &Inputs, state: &mut State) -> Result<(), Error> {
    follow_within(inputs, state, MOST_STEPS)
}

/// As [`follow`], in so many steps at most, for those who have a deadline: each solves the
/// equations about once, and one that has to be made shorter counts as well.
///
/// # Errors
/// Why it cannot get there; the state stays as it was. But after [`Error::TooFar`] it is on its
/// way, and the same call goes on from there.
pub fn follow_within(inputs: &Inputs, state: &mut State, most: usize) -> Result<(), Error> {
    if !inputs.are_finite() {
        return Err(Error::NotANumber);
    }
    let was_led = state.is_led;
    if !was_led {
        let at = state.at();
        let (q, t) = (at.q, at.t);
        state.led.begin(&q, t)?;
    }
    let result = state.led.go(inputs, most, state.steepness);
    if matches!(result, Ok(()) | Err(Error::TooFar)) {
        state.is_led = true;
        let [first, second] = &mut state.solutions;
        let to = if state.is_second { second } else { first };
        state.led.leave_in(to);
    }
    result
}

/// The derivatives of the coordinates by each input, by the numbers in [`input`]: for a constant
/// shift of it, along the branch that the state is on.
//# if left_out
/// Where an input alone cannot change, because an equation that was left out would cease to hold, its
/// derivatives are `NAN`.
//# end
///
/// # Errors
/// The equations cannot be solved with the inputs as signals.
pub fn influence(state: &State) -> Result<[Q; INPUTS], Error> {
//# if !left_out
    let by_signal = if state.is_led {
        state.led.at().by_signal
    } else {
        let mut led = Led::new(state.params());
        led.begin(state.q(), state.t())?;
        led.at().by_signal
    };
//# end
//# if left_out
    let mut led = state.led.clone();
    if !state.is_led {
        led = Led::new(state.params());
        led.begin(state.q(), state.t())?;
    }
    let at = led.at();
    let mut by_signal = at.by_signal;
//# if sides
    let sides = &at.sides;
//# end
    hold_apart_by_signal(&mut by_signal, &at.q, at.t, &led.model.way$sides);
//# end
    let mut by_input = [[0.0; N]; INPUTS];
    by_input.iter_mut().zip(by_signal).for_each(|(to, from)| *to = from);
    Ok(by_input)
}

/// The shortest step, as a part of the way; of a long one, as a change of a signal.
const SMALLEST_STEP: f64 = 1e-12;
//# if of_time

/// A position that changes by more than this at an edge jumps, scaled.
const POSITION_JUMP: f64 = 1e-9;
//# end
//# if motion

/// How often the branches of formulas are chosen anew at one place.
const MOST_BRANCHES: usize = 8;
//# end

/// A way of the signals: a straight line from 0 to 1.
#[derive(Clone, Debug)]
struct Way {
    params: Params,
    from: [f64; SIGNALS],
    to: [f64; SIGNALS],
    rates: [f64; SIGNALS],
    accelerations: [f64; SIGNALS],
}

impl Way {
    fn new(params: &Params) -> Self {
        let zero = [0.0; SIGNALS];
        Self {
            params: *params,
            from: zero,
            to: zero,
            rates: zero,
            accelerations: zero,
        }
    }

    /// The value of a signal at a place of the way.
    #[inline]
    fn value(&self, k: usize, t: f64) -> f64 {
        match (self.from.get(k), self.to.get(k)) {
            (Some(_), Some(to)) if t >= 1.0 => *to,
            (Some(from), Some(to)) => from + t * (to - from),
            _ => f64::NAN,
        }
    }

    fn values(&self, t: f64) -> [f64; SIGNALS] {
        core::array::from_fn(|k| self.value(k, t))
    }

    /// How the signals change along the whole way.
    fn direction(&self) -> [f64; SIGNALS] {
        core::array::from_fn(|k| self.value(k, 1.0) - self.value(k, 0.0))
    }
//# if large

    /// Value, rate and acceleration of each signal, one behind the other.
    fn list(&self, t: f64) -> [f64; 3 * SIGNALS] {
        let mut list = [0.0; 3 * SIGNALS];
        let rest = self.rates.iter().zip(&self.accelerations);
        let all = self.values(t).into_iter().zip(rest);
        for (places, (value, (rate, acceleration))) in list.chunks_exact_mut(3).zip(all) {
            places.copy_from_slice(&[value, *rate, *acceleration]);
        }
        list
    }
//# end
}

/// What follows signals.
#[derive(Clone, Debug)]
pub(super) struct Led {
    model: Model,
    /// The solution of now and the one before, or the next one in the making; their times are
    /// places of the way.
    solutions: [Solution; 2],
    /// Whether that of now is the second.
    is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    is_smooth: bool,
    /// The change of a signal that goes well in a step.
    stride: f64,
}

impl Led {
    pub(super) fn new(params: &Params) -> Self {
        Self {
            model: Model::new(&Way::new(params)),
            solutions: [Solution::ZERO, Solution::ZERO],
            is_second: false,
            is_smooth: false,
            stride: f64::INFINITY,
        }
    }

    /// The solution of now.
    fn at(&self) -> &Solution {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The inputs that have been followed to.
    pub(super) fn inputs(&self) -> Inputs {
        let way = &self.model.way;
        Inputs::of(&self.at().signals, &way.rates, &way.accelerations)
    }

    /// Begins at a position that the text's formulas give at a time (s).
    fn begin(&mut self, q: &Q, t: f64) -> Result<(), Error> {
        let way = &mut self.model.way;
        (way.to, way.rates, way.accelerations) = Inputs::at(t, &way.params).lists();
        way.from = way.to;
        let mut near = Solution::ZERO;
        (near.t, near.q) = (1.0, *q);
//# if motion
        let of_time = sides_at(1.0, &self.model);
        near.sides = sides_of_motion(q, 1.0, &self.model.way, &of_time);
//# end
        self.is_smooth = false;
        let [first, second] = &mut self.solutions;
        let now = if self.is_second { second } else { first };
        reach(&tears(q), &near, 1.0, &self.model, now).map_err(Fault::at_start)?;
        if now.first <= LARGEST_CORRECTION {
            Ok(())
        } else {
            Err(Error::Divergence)
        }
    }

    /// Goes from the signals of now to inputs.
    fn go(&mut self, inputs: &Inputs, most: usize, steepness: f64) -> Result<(), Error> {
        let from = self.at().signals;
        let way = &mut self.model.way;
        let before = (way.from, way.to, way.rates, way.accelerations);
        way.from = from;
        (way.to, way.rates, way.accelerations) = inputs.lists();
        let [first, second] = &mut self.solutions;
        let now = if self.is_second { second } else { first };
        now.t = 0.0;
        let length = way.direction().into_iter().map(f64::abs).fold(0.0, larger);
        // the branch asks for steps of the same change on any way
        let smallest = SMALLEST_STEP / larger(length, 1.0);
        let stride = self.stride;
        // the solution at the beginning, once it is behind the one before
        let mut home = None;
        for _ in 0..most {
            let now = self.at().t;
            let step = f64::max(self.stride / length, smallest);
            // no crumb at the end; a way without length is one step
            let wanted = if step < 0.999 * (1.0 - now) {
                now + step
            } else {
                1.0
            };
//# if of_time
            let next = first_edge(now, wanted, &self.model);
//# end
//# if !of_time
            let next = wanted;
//# end
            let (is_last, size) = (next >= 1.0, next - now);
            match self.advance(next, is_last, steepness) {
                Ok(is_calm) => {
                    if is_calm {
                        self.stride = f64::max(self.stride, 2.0 * size * length);
                    } else if length > 0.0 {
                        self.stride = f64::min(self.stride, size * length);
                    }
                    if is_last {
                        return Ok(());
                    }
                    if home.is_none() {
                        home = Some(self.other().clone());
                    }
                }
                Err(fault) => {
                    let half = 0.5 * size;
                    self.stride = half * length;
                    self.is_smooth = false;
                    if half < smallest || now + half == now {
                        let why = self.explain(fault, next, steepness);
                        self.stride = stride;
                        let way = &mut self.model.way;
                        (way.from, way.to, way.rates, way.accelerations) = before;
                        if let Some(home) = home {
                            let [first, second] = &mut self.solutions;
                            let now = if self.is_second { second } else { first };
                            *now = home;
                        }
                        return Err(why);
                    }
                }
            }
        }
        Err(Error::TooFar)
    }

    /// One step to a place of the way; says whether a longer one would do as well.
    fn advance(&mut self, t: f64, is_wanted: bool, steepness: f64) -> Result<bool, Fault> {
        let [first, second] = &mut self.solutions;
        let (from, at) = if self.is_second {
            (second, first)
        } else {
            (first, second)
        };
        let (from, m) = (&*from, &self.model);
        let h = t - from.t;
        let direction = m.way.direction();
        let change = direction.map(|rate| h * rate);
        let (x, v) = (tears(&from.q), tears_along(from, &change));
        let mut way = if self.is_smooth {
            bend(from, at, &v, &change)
        } else {
            [0.0; TEARS]
        };
        let mut guess = x;
        for ((way, guess), v) in way.iter_mut().zip(&mut guess).zip(&v) {
            *way += v;
            *guess += *way;
        }
        // what is not a number is not small either
        let is_short = largest(&way, &TEAR_SCALES) <= LARGEST_MOTION;
        if !is_short {
            return Err(Fault::TooFar);
        }
        reach(&guess, from, t, m, at)?;
        // what the slopes at both ends make of the way between
        let (y, w) = (tears(&at.q), tears_along(at, &change));
        let mut gaps = [0.0; TEARS];
        let (ways, rates) = (y.iter().zip(&x), v.iter().zip(&w));
        for ((gap, (y, x)), (v, w)) in gaps.iter_mut().zip(ways).zip(rates) {
            *gap = y - x - 0.5 * (v + w);
        }
        let gap = largest(&gaps, &TEAR_SCALES);
        let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
        if !is_near {
            return Err(Fault::TooFar);
        }
//# if watches
        if at.watched != from.watched {
            return Err(Fault::Singular);
        }
//# end
        let steepest = at.steepest / steepness;
        if at.is_negative != from.is_negative || steepest > STEEPEST {
            return Err(Fault::Singular);
        }
//# if varied
        if steepest > STEEP {
            at.measures.leave_varied_out();
        }
//# end
        if is_wanted && steepest > STEEP && steepest * rounding(at, m) > ACCURACY {
            return Err(Fault::Singular);
        }
//# if of_time
        if at.sides != from.sides && jumps(from, at, m) {
            return Err(Fault::NotSmooth);
        }
//# end
//# if sides
        self.is_smooth = at.sides == from.sides;
//# end
//# if !sides
        self.is_smooth = true;
//# end
        self.is_second = !self.is_second;
        Ok(at.first < LARGEST_CORRECTION / 12.0 && gap < LARGEST_GAP / 100.0)
    }

    /// The one before, or the next one in the making.
    fn other(&self) -> &Solution {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Leaves the solution of now for those who ask.
    fn leave_in(&self, to: &mut super::Solution) {
        let at = self.at();
        (to.q, to.qd, to.qdd) = (at.q, at.qd, at.qdd);
//# if measures
        to.measures = at.measures;
//# end
//# if time
        [.., to.t] = at.signals;
//# end
    }

    /// Why even the shortest step towards a place of the way is refused.
    fn explain(&self, fault: Fault, t: f64, steepness: f64) -> Error {
        let (at, m) = (self.at(), &self.model);
        let p = &m.way;
//# if sides
        let sides = &at.sides;
//# end
        let values = $phi(&at.q, t, p$sides);
        if fault == Fault::NotANumber || values.iter().any(|value| !value.is_finite()) {
            return Error::NotANumber;
        }
//# if of_time
        // a position that jumps far is not even found on the other side
        let is_at_edge = sides_at(at.t, m) != sides_at(t, m);
        if fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge) {
            return Error::NotSmooth;
        }
//# end
        if at.steepest < SINGULAR * steepness {
//# if left_out
            if fault == Fault::LeftOut {
                return Error::Inconsistent;
            }
//# end
            // a formula may jump without a branch of its own
            let mut beyond = at.clone();
            let is_there = fault == Fault::TooFar && reach(&tears(&at.q), at, t, m, &mut beyond).is_ok();
            return if is_there {
                Error::NotSmooth
            } else {
                Error::Divergence
            };
        }
        // a motion that comes to a dead point after a way u is as the root of u, whose slope over
        // twice its curvature is u; all by the signal that changes most
        let longest = m.way.direction().into_iter().map(f64::abs).fold(0.0, larger);
        let mut along = m.clone();
        along.way.rates = m.way.direction().map(|change| change / longest);
        along.way.accelerations = [0.0; SIGNALS];
        let mut moving = at.clone();
        solve(&tears(&at.q), at.t, &along$sides, &mut moving);
        let rates = moving.qd.iter().zip(&moving.qdd).zip(&SCALES);
        let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
            if v.abs() / scale > speed {
                (v.abs() / scale, 0.5 * v / a)
            } else {
                (speed, left)
            }
        };
        let (_, left) = rates.fold((0.0, 0.0), sooner);
        // a way may be short itself
        if left > 0.0 && left < NEAR_FOLD * (1.0 + longest) {
            Error::LockUp
        } else {
            Error::Bifurcation
        }
    }
}

/// How coordinates change along a direction of the signals.
fn along(by_signal: &[Q; SIGNALS], direction: &[f64; SIGNALS]) -> Q {
    let mut sum = [0.0; N];
    for (slopes, change) in by_signal.iter().zip(direction) {
        sum.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += slope * change);
    }
    sum
}

/// The same of those that Newton solves for.
fn tears_along(at: &Solution, direction: &[f64; SIGNALS]) -> [f64; TEARS] {
    let mut sum = [0.0; TEARS];
    for (slopes, change) in at.by_signal.iter().zip(direction) {
        sum.iter_mut().zip(&tears(slopes)).for_each(|(sum, slope)| *sum += slope * change);
    }
    sum
}

/// What the motion since the solution before adds to the way `v` that the slopes of now make of a
/// change of the signals: values and slopes at two places make a cubic (Hermite). Where the signals
/// turn elsewhere, the change of the slopes counts alone.
fn bend(
    now: &Solution,
    before: &Solution,
    v: &[f64; TEARS],
    change: &[f64; SIGNALS],
) -> [f64; TEARS] {
    let (mut product, mut square, mut size) = (0.0, 0.0, 0.0);
    let mut behind = [0.0; SIGNALS];
    let ends = now.signals.iter().zip(&before.signals);
    for ((behind, (now, before)), change) in behind.iter_mut().zip(ends).zip(change) {
        *behind = now - before;
        product += *behind * change;
        square += *behind * *behind;
        size += change * change;
    }
    let u = product / square;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return [0.0; TEARS];
    }
    let (x, y) = (tears(&now.q), tears(&before.q));
    let is_straight = size - u * product <= LARGEST_TURN * size;
    let mut bend = [0.0; TEARS];
    if is_straight {
        let slopes = tears_along(now, &behind).into_iter().zip(tears_along(before, &behind));
        for ((bend, (x, y)), (v, w)) in bend.iter_mut().zip(x.iter().zip(&y)).zip(slopes) {
            let (value, slope) = (y - x + v, v - w);
            *bend = u * u * (3.0 * value - slope + u * (2.0 * value - slope));
        }
    } else {
        let slopes = v.iter().zip(tears_along(before, change));
        for (bend, (v, w)) in bend.iter_mut().zip(slopes) {
            *bend = 0.5 * u * (v - w);
        }
    }
    bend
}

/// Signals go straight on if the square of what leads aside is no larger part of that of the whole.
const LARGEST_TURN: f64 = 0.01;
//# if of_time

/// Whether a position differs on the two sides of a place at which formulas change their branches:
/// `at` is the later side, and `from` has the branches of the earlier one.
fn jumps(from: &Solution, at: &Solution, m: &Model) -> bool {
    let mut before = at.clone();
    if find(&tears(&at.q), at, at.t, m, &from.sides, &mut before).is_err() {
        return true;
    }
    let mut way = at.q;
    way.iter_mut().zip(&before.q).for_each(|(way, q)| *way -= q);
    largest(&way, &SCALES) > POSITION_JUMP
}
//# end
