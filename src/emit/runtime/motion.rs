/// How far the motion is looked ahead to tell on which side of an edge it goes on (s, scaled).
const AHEAD: f64 = 1e-9;
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
