//# if !led
/// Steps that one call of [`step`] takes at most.
pub const MOST_STEPS: usize = 1_000_000;

/// Trials on the way from the file's parameters to others at most, and the smallest part of it.
const MOST_PARTS: usize = 10_000;
const SMALLEST_PART: f64 = 1e-6;

/// The largest motion of a step, beside the size of a body or 1 rad.
const LARGEST_MOTION: f64 = 0.5;

/// The step before tells of one that is so many times as long at most.
const FARTHEST_BEND: f64 = 4.0;

/// How far velocities may lead elsewhere than positions, likewise: more is another branch.
const LARGEST_GAP: f64 = 1e-3;

/// One over a pivot, scaled: beyond the first the position is looked at more closely, beyond the
/// second it is too near to a singular one.
const STEEP: f64 = 1e3;
const STEEPEST: f64 = 1e6;

/// Rounding may make so much of velocities and accelerations that are given out.
const ACCURACY: f64 = 1e-9;

/// Where steps become too small, this is steep enough for a singular position to be the reason.
const SINGULAR: f64 = 1e2;

/// A dead point is no further off than this part of the span.
const NEAR_FOLD: f64 = 1e-5;
//# if of_time

/// What changes by more than this at an edge jumps: positions, scaled, and velocities beside the
/// fastest one; a speed below that part of one per span is rest.
const POSITION_JUMP: f64 = 1e-9;
const VELOCITY_JUMP: f64 = 1e-6;
const REST: f64 = 1e-3;
//# end
//# if motion

/// How often the branches of formulas are chosen anew at one time.
const MOST_BRANCHES: usize = 8;
//# end

/// Brings the mechanism to its first time with some parameters, along the branch that the file's
/// parameters give.
///
/// # Errors
/// It cannot be assembled with these, or not on that branch.
pub fn assemble(params: &Params) -> Result<State, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
//# if params
    let file = Params::default();
//# end
//# if !params
    let file = Params;
//# end
    let mut at = Solution::ZERO;
    start(&START, &Model::new(&file), &mut at).map_err(Fault::at_start)?;
    let mut found = at.clone();
    let usual = at.steepest;
    let mut why = Error::Divergence;
    // the part of the way from the file's parameters to those that are wanted
    let (mut done, mut part) = (0.0, 1.0);
    for _ in 0..MOST_PARTS {
        let next = f64::min(done + part, 1.0);
        let params = if next < 1.0 {
            file.towards(params, next)
        } else {
            *params
        };
        let model = Model::new(&params);
        let result = start(&at.q, &model, &mut found);
        if result.is_ok() && found.is_negative == at.is_negative {
            if next >= 1.0 {
                let ratio = found.steepest / usual;
                let steepness = if ratio > 0.0 { ratio } else { 1.0 };
//# if inputs
                let led = following::Led::new(&params);
//# end
                return Ok(State {
                    steepness,
                    model,
//# if inputs
                    led,
                    is_led: false,
//# end
                    solutions: [found, at],
                    is_second: false,
                    is_smooth: false,
                    step: LONGEST_STEP,
//# if rims
                    passed: [f64::NEG_INFINITY; RIMS],
//# end
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
fn start(q: &Q, m: &Model, at: &mut Solution) -> Result<(), Fault> {
    let mut near = Solution::ZERO;
    (near.t, near.q) = (START_TIME, *q);
//# if motion
    near.sides = sides_of_motion(q, START_TIME, &m.params, &sides_at(START_TIME, m));
//# end
    reach(&tears(q), &near, START_TIME, m, at)?;
    if at.first <= LARGEST_CORRECTION {
        Ok(())
    } else {
        Err(Fault::TooFar)
    }
}

//# if inputs
/// Brings a mechanism that inputs have led back to what the formulas of its inputs say at its
/// time, on the way that [`follow`] takes.
fn take_up_time(state: &mut State, most: usize) -> Result<(), Error> {
    let t = state.at().t;
    let inputs = Inputs::at(t, &state.model.params);
    following::follow_within(&inputs, state, most)?;
    let q = state.at().q;
    let mut near = Solution::ZERO;
    (near.t, near.q) = (t, q);
//# if motion
    near.sides = sides_of_motion(&q, t, &state.model.params, &sides_at(t, &state.model));
//# end
    let [first, second] = &mut state.solutions;
    let at = if state.is_second { second } else { first };
    reach(&tears(&q), &near, t, &state.model, at).map_err(Fault::at_start)?;
    (state.is_led, state.is_smooth) = (false, false);
    Ok(())
}

//# end
/// Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
/// and acceleration are those of the branch that it is on, whichever way `t` lies.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one; [`step_within`] takes as many as it is
/// allowed. What a driver does and undoes within a
/// step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].
//# if end
/// At the end of the file's analysis the formulas of time take their earlier branches, as
/// `mechc run` has it; at any other time where they change, the later ones.
//# end
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach.
pub fn step(t: f64, state: &mut State) -> Result<(), Error> {
    step_within(t, state, MOST_STEPS)
}

/// As [`step`], in so many steps at most, for those who have a deadline: each solves the equations
/// about once, and one that has to be made shorter counts as well.
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach. Where that is
/// [`Error::TooFar`] the same call goes on from there.
pub fn step_within(t: f64, state: &mut State, most: usize) -> Result<(), Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
//# if inputs
    if state.is_led {
        take_up_time(state, most)?;
    }
//# end
    for _ in 0..most {
        let now = state.at().t;
        let left = t - now;
        if left == 0.0 {
            return Ok(());
        }
        // no crumb at the end
        let $wanted = if state.step >= 0.999 * left.abs() {
            t
        } else {
            now + state.step.copysign(left)
        };
//# if of_time
        // what is fast may be over before the step's end
        let $rimmed = first_edge(now, wanted, &state.model);
//# end
//# if rims
        let next = match first_rim(now, $rim_end, &state.model, &state.passed) {
            None => $rim_end,
            Some((rim, at)) => {
                let before = at - LEAD.copysign(left);
                if (before - now) * left <= 0.0 {
                    look_at_rim(state, rim, at)?;
                    continue;
                }
                before
            }
        };
//# end
        let (is_last, size) = (next == t, (next - now).abs());
        match advance(state, next, is_last) {
            Ok(is_calm) => {
                let longest = if is_calm {
                    state.step.max(2.0 * size)
                } else {
                    state.step.min(size)
                };
                state.step = longest.min(LONGEST_STEP);
                if is_last {
                    return Ok(());
                }
            }
            Err(fault) => {
                state.step = 0.5 * size;
                state.is_smooth = false;
                if state.step < SMALLEST_STEP || now + state.step == now {
                    state.step = SMALLEST_STEP;
                    return Err(explain(state, fault, next));
                }
            }
        }
    }
    if state.at().t == t {
        Ok(())
    } else {
        Err(Error::TooFar)
    }
}

//# end
/// Why a step is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// Something is not a number.
    NotANumber,
    /// The step is too long for the motion.
    TooFar,
    /// The position is on another branch, or too near to one.
    Singular,
//# if of_time
    /// A position or velocity jumps.
    NotSmooth,
//# end
//# if left_out
    /// An equation that was left out does not hold.
    LeftOut,
//# end
}

impl Fault {
    /// Why a mechanism cannot be assembled.
    fn at_start(self) -> Error {
        match self {
            Self::NotANumber => Error::NotANumber,
//# if left_out
            Self::LeftOut => Error::Inconsistent,
//# end
            _ => Error::Divergence,
        }
    }
}

//# if !led
/// One step to a time; says whether a longer one would do as well.
fn advance(state: &mut State, t: f64, is_wanted: bool) -> Result<bool, Fault> {
    let [first, second] = &mut state.solutions;
    let (from, at) = if state.is_second {
        (second, first)
    } else {
        (first, second)
    };
    let from = &*from;
    let h = t - from.t;
    let (x, v, a) = (tears(&from.q), tears(&from.qd), tears(&from.qdd));
    let mut way = if state.is_smooth {
        bend(from, at, h)
    } else {
        [0.0; TEARS]
    };
    let mut guess = x;
    let rates = v.iter().zip(&a);
    for ((way, guess), (v, a)) in way.iter_mut().zip(&mut guess).zip(rates) {
        // Taylor
        *way += h * (v + 0.5 * h * a);
        *guess += *way;
    }
    // what is not a number is not small either
    let is_short = largest(&way, &TEAR_SCALES) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    reach(&guess, from, t, &state.model, at)?;
    // what both ends' velocities and accelerations make of the way between (Hermite)
    let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
    let mut gaps = [0.0; TEARS];
    let (ways, rates, bends) = (y.iter().zip(&x), v.iter().zip(&w), a.iter().zip(&b));
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.iter_mut().zip(ways).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
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
    let steepest = at.steepest / state.steepness;
    if at.is_negative != from.is_negative || steepest > STEEPEST {
        return Err(Fault::Singular);
    }
//# if varied
    if steepest > STEEP {
        at.measures.leave_varied_out();
    }
//# end
    if is_wanted && steepest > STEEP && steepest * rounding(at, &state.model) > ACCURACY {
        return Err(Fault::Singular);
    }
//# if of_time
    if at.sides != from.sides && jumps(from, at, &state.model) {
        return Err(Fault::NotSmooth);
    }
//# end
//# if sides
    state.is_smooth = at.sides == from.sides;
//# end
//# if !sides
    state.is_smooth = true;
//# end
    state.is_second = !state.is_second;
    Ok(at.first < LARGEST_CORRECTION / 12.0 && gap < LARGEST_GAP / 100.0)
}

/// What the motion since the solution before adds to Taylor's way over a time `h` (s): value,
/// velocity and acceleration at two times make a polynomial of degree 5 (Hermite).
fn bend(now: &Solution, before: &Solution, h: f64) -> [f64; TEARS] {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return [0.0; TEARS];
    }
    let (x, v, a) = (tears(&now.q), tears(&now.qd), tears(&now.qdd));
    let (y, w, b) = (tears(&before.q), tears(&before.qd), tears(&before.qdd));
    let mut bend = [0.0; TEARS];
    let (ways, rates, bends) = (x.iter().zip(&y), v.iter().zip(&w), a.iter().zip(&b));
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.iter_mut().zip(ways).zip(rates.zip(bends)) {
        let value = y - x + back * (v - 0.5 * back * a);
        let slope = back * (v - back * a - w);
        let curvature = 0.5 * back * back * (b - a);
        let cubic = 4.0 * slope - 10.0 * value - curvature;
        let quartic = 7.0 * slope - 15.0 * value - 2.0 * curvature;
        let quintic = 3.0 * slope - 6.0 * value - curvature;
        *bend = u * u * u * (cubic + u * (quartic + u * quintic));
    }
    bend
}
//# if of_time

/// Whether position or velocity differ on the two sides of a time at which formulas change their
/// branches: `at` is the later side, and `from` has the branches of the earlier one.
fn jumps(from: &Solution, at: &Solution, m: &Model) -> bool {
    let mut before = at.clone();
    if find(&tears(&at.q), at, at.t, m, &from.sides, &mut before).is_err() {
        return true;
    }
    let (mut way, mut change) = (at.q, at.qd);
    for (way, q) in way.iter_mut().zip(&before.q) {
        *way -= q;
    }
    for (change, qd) in change.iter_mut().zip(&before.qd) {
        *change -= qd;
    }
    let fastest = largest(&at.qd, &SCALES) + largest(&before.qd, &SCALES) + REST / SPAN;
    largest(&way, &SCALES) > POSITION_JUMP || largest(&change, &SCALES) > VELOCITY_JUMP * fastest
}
//# end

/// The largest value beside its scale; what is not a number wins.
fn largest<const K: usize>(values: &[f64; K], scales: &[f64; K]) -> f64 {
    let pairs = values.iter().zip(scales);
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// The larger one; what is not a number wins.
fn larger(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

//# end
//# if sides
/// Solves at a time, from a guess; `from` is where the motion comes from.
fn reach(
    guess: &[f64; TEARS],
    from: &Solution,
    t: f64,
    m: &Model,
    at: &mut Solution,
) -> Result<(), Fault> {
//# if motion
    let of_time = sides_at(t, m);
    let mut sides = from.sides;
    for _ in 0..MOST_BRANCHES {
        sides = with_time(&sides, &of_time);
        find(guess, from, t, m, &sides, at)?;
        let now = sides_ahead(at, m);
        if now == sides {
            return Ok(());
        }
        sides = now;
    }
    Err(Fault::TooFar)
//# end
//# if !motion
    find(guess, from, t, m, &sides_at(t, m), at)
//# end
}

/// Solves with branches of formulas that are known.
fn find(
//# end
//# if !sides
/// Solves at a time, from a guess; `from` is where the motion comes from.
fn reach(
//# end
    guess: &[f64; TEARS],
    $from: &Solution,
    t: f64,
    m: &Model,
//# if sides
    sides: &Sides,
//# end
    at: &mut Solution,
) -> Result<(), Fault> {
    solve(guess, t, m$sides, at);
    if !at.is_settled || !at.holds {
//# if pivoting
        // once more from a position that is known, and if that does not help either, that
        let h = t - from.t;
        let mut q = from.q;
//# if led
        for (q, rate) in q.iter_mut().zip(along(&from.by_signal, &m.way.direction())) {
            *q += h * rate;
        }
//# end
//# if !led
        for ((q, qd), qdd) in q.iter_mut().zip(&from.qd).zip(&from.qdd) {
            *q += h * (qd + 0.5 * h * qdd);
        }
//# end
        let pivoted = solve_with_pivoting(&q, t, m$sides)?;
        solve(&tears(&pivoted.q), t, m$sides, at);
        let first = pivoted.first;
        if !at.is_settled || !at.holds {
            *at = pivoted;
        }
        at.first = first;
//# end
//# if !pivoting
        return Err(at.fault());
//# end
    }
//# if conditions
    if !conditions_hold(&at.q, t, &m.params$sides) {
        return Err(Fault::NotANumber);
    }
//# end
//# if left_out
    if !left_out_holds(&at.q, t, &m.params$sides) {
        return Err(Fault::LeftOut);
    }
//# end
//# if watches
    at.watched = watched(&at.q, t, &m.params$sides).map(|value| value > 0.0);
//# end
//# if sides
    at.sides = *sides;
//# end
//# if led
    at.signals = m.way.values(t);
//# end
//# if measures
    at.measures.leave_out();
//# end
    if at.is_finite() {
        Ok(())
    } else {
        Err(Fault::NotANumber)
    }
}

//# if left_out
/// Whether the equations that were left out hold.
fn left_out_holds(q: &Q, t: f64, p: &Params$sides_argument) -> bool {
    let left = $left_out(q, t, p$sides);
    let mut pairs = left.iter().zip(&LEFT_OUT_SCALES);
    pairs.all(|(value, scale)| value.abs() / scale <= LARGEST_OPENING)
}

//# end
/// What rounding makes of the velocities and accelerations, for every unit of steepness: they are
/// amplified by as much as the position is near to a singular one.
fn rounding(at: &Solution, m: &Model) -> f64 {
    let p = &m.params;
//# if sides
    let sides = &at.sides;
//# end
    let slopes = $phi_q(&at.q, at.t, p$sides);
    let mut norms = [f64::MIN_POSITIVE; N];
    for (&(row, column), slope) in PHI_Q_PATTERN.iter().zip(slopes) {
        if let (Some(norm), Some(scale)) = (norms.get_mut(row), SCALES.get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
    let nu = $nu(&at.q, at.t, p$sides);
    let velocity = ratio(largest(&at.qd, &SCALES), largest(&nu, &norms));
    let gamma = $gamma(&at.q, &at.qd, at.t, p$sides);
    let acceleration = ratio(largest(&at.qdd, &SCALES), largest(&gamma, &norms));
    let amplified = larger(larger(velocity, acceleration), 1.0);
    f64::EPSILON * amplified
}

//# if !led
/// Why even the shortest step from a state towards a time is refused.
fn explain(state: &State, fault: Fault, t: f64) -> Error {
    let (at, p) = (state.at(), &state.model.params);
//# if sides
    let sides = &at.sides;
//# end
    let values = $phi(&at.q, t, p$sides);
    if fault == Fault::NotANumber || values.iter().any(|value| !value.is_finite()) {
        return Error::NotANumber;
    }
//# if of_time
    // a position that jumps far is not even found on the other side
    let is_at_edge = sides_at(at.t, &state.model) != sides_at(t, &state.model);
    if fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge) {
        return Error::NotSmooth;
    }
//# end
    if at.steepest < SINGULAR * state.steepness {
//# if left_out
        if fault == Fault::LeftOut {
            return Error::Inconsistent;
        }
//# end
        return Error::Divergence;
    }
    // a motion that comes to a dead point after a time u is as the root of u, whose slope over
    // twice its curvature is u
    let rates = at.qd.iter().zip(&at.qdd).zip(&SCALES);
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed {
            (v.abs() / scale, 0.5 * v / a)
        } else {
            (speed, left)
        }
    };
    let (_, left) = rates.fold((0.0, 0.0), sooner);
    let left = if t < at.t { -left } else { left };
    if left > 0.0 && left < NEAR_FOLD * SPAN {
        Error::LockUp
    } else {
        Error::Bifurcation
    }
}

//# end
/// What solves the equations at a time.
#[derive(Clone, Debug)]
struct Solution {
    t: f64,
    q: Q,
    qd: Qd,
    qdd: Qdd,
//# if led
    /// The derivatives of the coordinates by each signal, and what these are.
    by_signal: [Q; SIGNALS],
    signals: [f64; SIGNALS],
//# end
//# if measures
    measures: Measures,
//# end
//# if joined
    /// What only measures need.
    joined: [f64; JOINED],
//# end
//# if sides
    /// The branches of formulas.
    sides: Sides,
//# end
//# if watches
    /// Which quantities that must keep their signs are positive.
    watched: [bool; WATCHES],
//# end
    /// By block of equations: whether its determinant is negative.
    is_negative: [bool; TURNS],
    /// Whether Newton has arrived.
    is_settled: bool,
    /// Whether no digits were lost, and the equations hold.
    holds: bool,
    /// Newton's largest first correction, scaled.
    first: f64,
    /// One over the smallest pivot, scaled.
    steepest: f64,
}

impl Solution {
    const ZERO: Self = Self {
        t: 0.0,
        q: [0.0; N],
        qd: [0.0; N],
        qdd: [0.0; N],
//# if led
        by_signal: [[0.0; N]; SIGNALS],
        signals: [0.0; SIGNALS],
//# end
//# if measures
        measures: Measures::ZERO,
//# end
//# if joined
        joined: [0.0; JOINED],
//# end
//# if sides
        sides: [0.0; SIDES],
//# end
//# if watches
        watched: [false; WATCHES],
//# end
        is_negative: [false; TURNS],
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Makes ready for being solved for.
    fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = TURNED;
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }
//# if newton

    /// Takes over how an iteration went.
    fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
//# end
//# if pivots

    /// Takes note of one over a pivot, and of what makes that a pure number.
    fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger(self.steepest, inverse.abs() * weight);
    }
//# end

    /// Why it cannot be used.
    fn fault(&self) -> Fault {
        if self.is_finite() {
            Fault::TooFar
        } else {
            Fault::NotANumber
        }
    }

    fn is_finite(&self) -> bool {
        let mut all = self.q.iter().chain(&self.qd).chain(&self.qdd);
//# if led
        let is_finite = all.all(|value| value.is_finite());
        is_finite && self.by_signal.iter().flatten().all(|value| value.is_finite())
//# end
//# if !led
        all.all(|value| value.is_finite())
//# end
    }
}
//# if newton

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace
/// in where it ends.
struct Newton {
    is_first: bool,
    is_open: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
}

impl Newton {
    fn new() -> Self {
        Self {
            is_first: true,
            is_open: false,
            is_lost: false,
            has_settled: false,
            first: 0.0,
        }
    }

    /// A coordinate with its correction; its grid has cells so wide, and it is judged against `scale`.
    fn corrected(&mut self, x: f64, delta: f64, cell: f64, scale: f64) -> f64 {
        let size = delta.abs();
        if self.is_first {
            self.first = larger(self.first, size / scale);
        }
        self.is_open |= size > HALF_A_CELL * cell;
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
        x + delta
    }

    /// Whether no further iteration is needed, or none helps.
    fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_open && !self.is_lost;
        let is_done = self.has_settled || self.is_lost;
        (self.is_first, self.is_open) = (false, false);
        is_done
    }
}

//# end
//# if grid
/// The grid point next to a value.
fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}
//# end
//# if pivoting

/// The solution by elimination with partial pivoting, where the order that [`solve`] has loses
/// digits. All coordinates lie on a grid while Newton goes on.
fn solve_with_pivoting(q: &Q, t: f64, m: &Model$sides_argument) -> Result<Solution, Fault> {
    let p = &m.params;
    let mut at = Solution::ZERO;
    (at.t, at.q) = (t, *q);
    let mut elimination = Elimination::new();
    let mut is_settled = false;
    for iteration in 0..ITERATIONS {
        for (q, cell) in at.q.iter_mut().zip(&CELLS) {
            *q = on_grid(*q, *cell);
        }
        let slopes = $phi_q(&at.q, t, p$sides);
        let right = $phi(&at.q, t, p$sides).map(|value| -value);
        let (x, _) = elimination.solve(&slopes, &right);
        if iteration == 0 {
            at.first = largest(&x, &SCALES);
        }
        is_settled = largest(&x, &CELLS) <= HALF_A_CELL;
        at.q.iter_mut().zip(&x).for_each(|(q, x)| *q += x);
        if is_settled {
            break;
        }
    }
    if !is_settled {
        return Err(at.fault());
    }
    let slopes = $phi_q(&at.q, t, p$sides);
    let (qd, pivot) = elimination.solve(&slopes, &$nu(&at.q, t, p$sides));
    let (qdd, _) = elimination.solve(&slopes, &$gamma(&at.q, &qd, t, p$sides));
//# if jerk
    let (qddd, _) = elimination.solve(&slopes, &$jerk(&at.q, &qd, &qdd, t, p$sides));
//# end
//# if led
    for (slopes_by, right) in at.by_signal.iter_mut().zip(&rights_by_signal(&at.q, t, p$sides)) {
        *slopes_by = elimination.solve(&slopes, right).0.map(|x| x + 0.0);
    }
//# end
    (at.qd, at.qdd) = (qd.map(|x| x + 0.0), qdd.map(|x| x + 0.0));
//# if varied
    let varied = vary(&mut elimination, &slopes, [&at.q, &qd, &qdd], t, p$sides);
//# end
//# if measures
    at.measures = measures(&at.q, &qd, &qdd$qddd$varied, t, p);
//# end
    let values = $phi(&at.q, t, p$sides);
    at.holds = is_next_to_nothing(&values, &slopes, &at.q);
    at.q = at.q.map(|x| x + 0.0);
    at.steepest = 1.0 / pivot;
    let negative = &elimination.is_negative;
    for (turned, block) in at.is_negative.iter_mut().zip(&TURNING) {
        *turned = negative.get(*block).copied().unwrap_or(false);
    }
    if at.holds { Ok(at) } else { Err(Fault::TooFar) }
}

//# if varied
/// The derivatives of the coordinates, their velocities and accelerations by inputs and parameters:
/// those by one before those by two, each order from those before.
#[rustfmt::skip]
fn vary(
    elimination: &mut Elimination,
    slopes: &[f64; ENTRIES],
    [q, qd, qdd]: [&Q; 3],
    t: f64,
    p: &Params$sides_argument,
) -> [f64; VARIED] {
    let mut varied = [0.0; VARIED];
    for by_two in [false, true] {
        for order in 0..3 {
            let rights = $varied_right(q, qd, qdd, &varied, t, p$sides);
            for (number, _) in IS_BY_TWO.iter().enumerate().filter(|(_, of)| **of == by_two) {
                let first = (3 * number + order) * N;
                let right = core::array::from_fn(|k| rights.get(first + k).copied().unwrap_or(f64::NAN));
                let (x, _) = elimination.solve(slopes, &right);
                for (k, x) in x.into_iter().enumerate() {
                    if let Some(place) = varied.get_mut(first + k) {
                        *place = x;
                    }
                }
            }
        }
    }
    varied
}

//# end
/// The work of solving linear equations in blocks.
struct Elimination {
    work: [f64; WORK],
    is_negative: [bool; BLOCKS],
}

impl Elimination {
    fn new() -> Self {
        Self {
            work: [0.0; WORK],
            is_negative: [false; BLOCKS],
        }
    }

    /// The solution for a right side, and the smallest pivot.
    fn solve(&mut self, slopes: &[f64; ENTRIES], right: &[f64; N]) -> ([f64; N], f64) {
        let mut x = [0.0; N];
        let (work, is_negative) = (&mut self.work, &mut self.is_negative);
        let pivot = blocks::solve(&EQUATIONS, slopes, right, &mut x, work, is_negative);
        (x, pivot)
    }
}

/// Whether what is left of the equations is within their tolerance, and what rounding makes of
/// the coordinates.
fn is_next_to_nothing(values: &[f64; N], slopes: &[f64; ENTRIES], q: &Q) -> bool {
    let mut bounds = [0.0; N];
    for (&(row, column), slope) in PHI_Q_PATTERN.iter().zip(slopes) {
        let sizes = (SCALES.get(column), q.get(column), bounds.get_mut(row));
        if let (Some(scale), Some(q), Some(bound)) = sizes {
            *bound += TOLERANCE * (slope * scale).abs() + 8.0 * f64::EPSILON * (slope * q).abs();
        }
    }
    let mut pairs = values.iter().zip(&bounds);
    pairs.all(|(value, bound)| value.abs() <= *bound)
}
//# end
