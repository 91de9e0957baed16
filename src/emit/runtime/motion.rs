/// How far the motion is looked ahead to tell on which side of an edge it goes on (s, scaled).
//# if !led
const AHEAD: f64 = 1e-9;
//# end
const FARTHEST_AHEAD: f64 = 1e-7;

/// The branches with those of time exchanged.
fn with_time(sides: &Sides, of_time: &Sides) -> Sides {
    let mut all = *sides;
    for ((side, of_time), is_of_time) in all.iter_mut().zip(of_time).zip(&IS_OF_TIME) {
        if *is_of_time {
            *side = *of_time;
        }
    }
    all
}

//# if !led
/// The branches of formulas of the motion that lie ahead of a position.
fn sides_ahead(at: &Solution, m: &Model) -> Sides {
    let (speed, acceleration) = (largest(&at.qd, &SCALES), largest(&at.qdd, &SCALES));
    let mut ahead = f64::min(f64::min(AHEAD * SPAN, AHEAD), FARTHEST_AHEAD / speed);
    ahead = f64::min(ahead, FARTHEST_AHEAD / (acceleration * ahead));
    let mut q = at.q;
    for ((q, qd), qdd) in q.iter_mut().zip(&at.qd).zip(&at.qdd) {
        *q += ahead * (qd + 0.5 * ahead * qdd);
    }
    sides_of_motion(&q, at.t + ahead, &m.params, &at.sides)
}
//# end
//# if led
/// The branches of formulas of the motion that lie ahead of a position on the way.
fn sides_ahead(at: &Solution, m: &Model) -> Sides {
    let rates = along(&at.by_signal, &m.way.direction());
    let ahead = f64::min(FARTHEST_AHEAD, FARTHEST_AHEAD / largest(&rates, &SCALES));
    let mut q = at.q;
    for (q, rate) in q.iter_mut().zip(&rates) {
        *q += ahead * rate;
    }
    sides_of_motion(&q, at.t, &m.way, &at.sides)
}
//# end
