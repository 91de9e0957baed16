/// How far before a time at which a formula of time may end its sides are looked at (s), and how
/// often, each time at a quarter of the distance.
const LEAD: f64 = 1e-3 * SPAN;
const MOST_LOOKS: usize = 6;
const FEWEST_LOOKS: usize = 3;

/// Beside the fastest motion a velocity that changes by more than this jumps; a speed below that
/// part of one per span is rest. What grows by so much with each look has no bound.
const SPEED_JUMP: f64 = 1e-6;
const SLOW: f64 = 1e-3;
const GROWTH: f64 = 1.03;

/// A rounding of the time (in units in its last place) that changes a quantity by more than itself
/// shows that it is zero there.
const MOMENT: f64 = 1024.0;

/// The first time of a step at which the quantity of a rim comes to zero and was not looked at yet,
/// with the rim: it changes its sign, or goes down to zero and up again.
fn first_rim(from: f64, to: f64, m: &Model, passed: &[f64; RIMS]) -> Option<(usize, f64)> {
    let p = &m.params;
    let (first, last) = (rims_of_time(from, p), rims_of_time(to, p));
    let ends = first.iter().zip(&last);
    let (gauges, slopes) = (ends.clone().take(RIMS), ends.skip(RIMS));
    let mut found = None;
    for (rim, ((a, b), (slope_a, slope_b))) in gauges.zip(slopes).enumerate() {
        let sign = 1.0_f64.copysign(*a);
        let way = (sign * (to - from)).signum();
        let is_crossed = sign * b < 0.0;
        let comes_and_goes = way * slope_a < 0.0 && way * slope_b > 0.0;
        if !is_crossed && !comes_and_goes {
            continue;
        }
        let (mut near, mut far) = (from, to);
        for _ in 0..MOST_BISECTIONS {
            let middle = 0.5 * (near + far);
            if middle == near || middle == far {
                break;
            }
            let (value, slope) = gauge(rim, middle, p);
            let is_before = if is_crossed {
                sign * value > 0.0
            } else {
                way * slope < 0.0
            };
            if is_before {
                near = middle;
            } else {
                far = middle;
            }
        }
        let is_new = passed
            .get(rim)
            .is_none_or(|passed| (far - passed).abs() > 1e-9 * SPAN);
        let is_first =
            found.is_none_or(|(_, known): (usize, f64)| (far - known) * (to - from) < 0.0);
        if is_new && is_first && is_zero(rim, far, p) {
            found = Some((rim, far));
        }
    }
    found
}

/// Halvings until two times are neighbours.
const MOST_BISECTIONS: usize = 100;

/// The quantity of a rim and its slope.
fn gauge(rim: usize, t: f64, p: &Params) -> (f64, f64) {
    let all = rims_of_time(t, p);
    let of = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
    (of(rim), of(rim + RIMS))
}

/// Whether a quantity is zero at a time, as far as numbers can tell.
fn is_zero(rim: usize, t: f64, p: &Params) -> bool {
    let moment = MOMENT * f64::EPSILON * t.abs() + f64::MIN_POSITIVE;
    let (here, _) = gauge(rim, t, p);
    let changes = |t: f64| {
        let ratio = gauge(rim, t, p).0 / here;
        let is_alike = ratio > 0.5 && ratio < 2.0;
        !is_alike
    };
    here.abs() <= 64.0 * f64::EPSILON || changes(t - moment) || changes(t + moment)
}

/// Looks at both sides of a time at which a formula may end, next to the state: whether the motion
/// goes on smoothly.
fn look_at_rim(state: &mut State, rim: usize, t: f64) -> Result<(), Error> {
    if let Some(passed) = state.passed.get_mut(rim) {
        *passed = t;
    }
    let (mut before, mut after) = (state.at().clone(), state.at().clone());
    let (mut at, mut distance) = (Solution::ZERO, LEAD);
    let (mut looks, mut jumps, mut growths) = (0, 0, [0, 0]);
    let (mut fastest, mut hardest) = (f64::INFINITY, f64::INFINITY);
    let (mut widest, mut rest) = (0.0, 0.0);
    for _ in 0..MOST_LOOKS {
        let found = look(t - distance, &before, &state.model, &mut at);
        if found {
            before.clone_from(&at);
            if looks == 0 {
                after.clone_from(&at);
            }
        }
        if found && look(t + distance, &after, &state.model, &mut at) {
            after.clone_from(&at);
            let speed = larger(largest(&before.qd, &SCALES), largest(&after.qd, &SCALES));
            let force = larger(largest(&before.qdd, &SCALES), largest(&after.qdd, &SCALES));
            let (mut way, mut change) = ([0.0; N], [0.0; N]);
            for k in 0..N {
                let of = |list: &[f64; N]| list.get(k).copied().unwrap_or(0.0);
                let (v, w) = (of(&before.qd), of(&after.qd));
                let (a, b) = (of(&before.qdd), of(&after.qdd));
                if let (Some(way), Some(change)) = (way.get_mut(k), change.get_mut(k)) {
                    let bend = distance * distance * (b - a) / 3.0;
                    *way = of(&after.q) - of(&before.q) - distance * (v + w) + bend;
                    *change = w - v - distance * (a + b);
                }
            }
            rest = larger(largest(&change, &SCALES), largest(&way, &SCALES) / SPAN);
            widest = if looks == 0 { rest } else { widest };
            jumps += usize::from(rest > SPEED_JUMP * larger(speed, SLOW / SPAN));
            let [of_speed, of_force] = &mut growths;
            *of_speed += usize::from(speed > GROWTH * fastest);
            *of_force += usize::from(force > GROWTH * hardest);
            (fastest, hardest) = (speed, force);
            looks += 1;
        }
        distance *= 0.25;
    }
    let [of_speed, of_force] = growths;
    let is_seen = looks >= FEWEST_LOOKS;
    if is_seen && of_speed + 1 == looks && fastest > SLOW / SPAN {
        return Err(Error::NotANumber);
    }
    if is_seen && jumps == looks && rest > 0.5 * widest {
        return Err(Error::NotSmooth);
    }
    if is_seen && looks == MOST_LOOKS && of_force + 1 == looks {
        return Err(Error::NotANumber);
    }
    Ok(())
}

/// Solves at a time close to a solution; whether it could.
fn look(t: f64, near: &Solution, m: &Model, at: &mut Solution) -> bool {
    let h = t - near.t;
    let mut guess = tears(&near.q);
    let rates = tears(&near.qd).into_iter().zip(tears(&near.qdd));
    for (guess, (v, a)) in guess.iter_mut().zip(rates) {
        *guess += h * (v + 0.5 * h * a);
    }
    reach(&guess, near, t, m, at).is_ok()
}
