//! The largest value of a formula and its first time, by leaving out the cells that cannot hold it.
//!
//! What a formula can be within a cell follows from the ranges of its value and derivatives there. A cell is looked at no more
//! where it cannot hold as large a value as is known, or where the formula rises or falls all the way; it is cut in two until that, or until the
//! slope passes zero in it just once, at a place that is then solved for.

use super::formulas::{Cell, Point};
use super::survey::{Scale, Survey};
use super::turn::{MOST_LOOKS, Sampled, Settling, Turning};
use crate::analysis::state::State;
use crate::math::between;
use crate::program::Range;
use crate::tolerances::results::search::{BESIDE, CERTAIN, CLOSER, FARTHEST, FINEST, GAP, GAP_OF_VALUES, ITERATIONS};
use std::rc::Rc;

/// The largest value of a formula, or the largest of its opposite.
#[derive(Clone, Debug)]
pub(super) struct Extreme {
    /// 1, or −1 for the least value.
    sign: f64,
    /// The largest that is known, times the sign.
    best: f64,
    /// Where it may be: extrema, edges and ends, in order of time (s), with their values times the sign.
    extrema: Vec<Extremum>,
    /// The largest of these.
    largest: f64,
}

#[derive(Clone, Copy, Debug)]
struct Extremum {
    t: f64,
    value: f64,
    kind: Kind,
}

/// How much is known of an extremum.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Edge,
    /// Where the slope passes zero.
    Turn,
    /// The largest that was seen of a formula whose slope nobody knows.
    Seen,
}

impl Extreme {
    pub fn new(largest: bool) -> Extreme {
        let sign = if largest { 1.0 } else { -1.0 };
        Extreme { sign, best: f64::NEG_INFINITY, extrema: Vec::new(), largest: f64::NEG_INFINITY }
    }

    /// Takes note of the least and the largest value that there is.
    fn note_all(&mut self, [low, high]: [f64; 2]) {
        self.best = self.best.max(if self.sign > 0.0 { high } else { -low });
    }

    /// Takes note of an edge or an end.
    pub fn note_edge(&mut self, t: f64, value: f64, scale: Scale) {
        self.add(Extremum { t, value: self.sign * value, kind: Kind::Edge }, scale);
    }

    fn add(&mut self, found: Extremum, scale: Scale) {
        if !found.value.is_finite() {
            return;
        }
        self.best = self.best.max(found.value);
        if found.value < self.best - scale.alike() {
            return;
        }
        // what was only seen is not as good as what may be found beside it
        if found.kind != Kind::Seen && found.value > self.largest {
            self.largest = found.value;
            let least = found.value - scale.alike();
            self.extrema.retain(|known| known.value >= least);
        }
        self.extrema.push(found);
    }

    /// Whether what is no larger than this is of no interest any more.
    fn is_above(&self, upper: f64, scale: Scale) -> bool {
        let gap = scale.gap(GAP);
        upper < self.best - scale.alike() - gap || upper <= self.largest + gap
    }

    /// The ends of a range, times the sign, in order.
    fn oriented(&self, Range { low, high, .. }: Range) -> [f64; 2] {
        if self.sign > 0.0 { [low, high] } else { [-high, -low] }
    }

    /// The values at both ends of a cell, times the sign.
    fn values(&self, cell: &Cell) -> [f64; 2] {
        [&cell.a, &cell.b].map(|point| self.sign * point.sample.value)
    }

    /// The largest value: that of an extremum, an edge or an end, unless more was seen than can be of it.
    pub fn value(&self, scale: Scale) -> f64 {
        let is_of_extremum = self.best <= self.largest + scale.gap(GAP);
        self.sign * if is_of_extremum { self.largest } else { self.best }
    }

    /// Its first time (s).
    pub fn time(&self, scale: Scale) -> f64 {
        let least = self.best - scale.alike();
        let alike = || self.extrema.iter().filter(|extremum| extremum.value >= least);
        let known = alike().find(|extremum| extremum.kind != Kind::Seen);
        let Some(first) = known.or_else(|| alike().next()) else { return f64::NAN };
        let is_it = |next: &&Extremum| {
            let is_behind = next.t > first.t && next.t - first.t <= BESIDE * scale.span;
            next.kind == Kind::Edge && first.kind == Kind::Turn && is_behind && next.value >= first.value
        };
        alike().find(is_it).unwrap_or(first).t
    }
}

impl Survey<'_> {
    /// Looks for the extreme in the halves of a stretch, with what the formula can be in them.
    pub(super) fn search(&mut self, parts: &[(Cell, Range)], extreme: &mut Extreme, scale: Scale) {
        extreme.note_all(*self.seen);
        let mut open = Vec::new();
        for (cell, range) in parts {
            open.push((cell.clone(), Some(*range)));
            while let Some((cell, range)) = open.pop() {
                if self.is_done(&cell, range, extreme, scale) {
                    continue;
                }
                let Some(middle) = self.middle(&cell) else { continue };
                extreme.note_all(*self.seen);
                let [left, right] = cell.halves(self.formula, &middle);
                open.push((right, None));
                open.push((left, None));
            }
        }
    }

    /// Whether a cell holds nothing more of interest; what it holds has been noted.
    fn is_done(&mut self, cell: &Cell, known: Option<Range>, extreme: &mut Extreme, scale: Scale) -> bool {
        if known.is_some_and(|range| extreme.is_above(extreme.oriented(range)[1], scale)) {
            return true;
        }
        if !self.goes_on(cell, f64::INFINITY) {
            // an edge of the formula, to neighbouring times
            extreme.note_edge(cell.a.state.t, cell.a.sample.value, scale);
            extreme.note_edge(cell.b.state.t, cell.b.sample.value, scale);
            return true;
        }
        let range = self.range(cell);
        let upper = extreme.oriented(range)[1];
        // ranges need not show of what rests that it does
        if extreme.is_above(upper, scale) || scale.rests() && range.is_resolved && !range.may_switch {
            return true;
        }
        match self.formula.derivatives() {
            _ if range.may_switch => false,
            0 => self.is_done_by_values(cell, upper, extreme, scale),
            _ => self.is_done_by_slopes(cell, upper, extreme, scale),
        }
    }

    /// The same of a cell whose values are no larger than `upper`, by what the formula's derivatives can be in it.
    fn is_done_by_slopes(&mut self, cell: &Cell, upper: f64, extreme: &mut Extreme, scale: Scale) -> bool {
        let sign = extreme.sign;
        let first = self.formula.range(1);
        let slopes @ [falls, rises] = extreme.oriented(first);
        let turns = sign * cell.a.sample.first > 0.0 && sign * cell.b.sample.first <= 0.0;
        // at a kink it may come to rest
        if (falls >= 0.0 || rises <= 0.0) && !(turns && first.may_switch) {
            if turns {
                // it turns where the cell ends, and falls from there on
                self.note_turn(&cell.b, cell.b.state.t, extreme, scale);
            }
            return true;
        }
        let [a, b] = extreme.values(cell);
        let upper = upper.min(between(a, b, slopes, cell.length())[1]);
        if extreme.is_above(upper, scale) {
            return true;
        }
        let is_small = upper <= f64::max(a, b) + scale.gap(GAP);
        let tells_bends = self.formula.derivatives() == 2 && !first.may_switch && !is_small;
        let bends = tells_bends.then(|| self.formula.range(2));
        let [bends_down, bends_up] = bends.map_or([0.0; 2], |range| extreme.oriented(range));
        let turns_once = bends_up < 0.0;
        if turns && (is_small || turns_once) {
            self.solve_for_turn(cell, extreme, scale);
        }
        is_small || turns_once || bends_down > 0.0
    }

    /// Where the slope, times the sign, passes from above zero to zero or below: by Newton between bounds.
    fn solve_for_turn(&mut self, cell: &Cell, extreme: &mut Extreme, scale: Scale) {
        let sign = extreme.sign;
        let slope = |point: &Point| sign * point.sample.first;
        let (mut low, mut high) = (Rc::clone(&cell.a), Rc::clone(&cell.b));
        let mut guess = chord(&low, &high, slope(&low), slope(&high));
        let mut top =
            if sign * low.sample.value > sign * high.sample.value { Rc::clone(&low) } else { Rc::clone(&high) };
        for iteration in 0..ITERATIONS {
            let (from, to) = (low.state.t, high.state.t);
            // where the guesses do not close in the middle does
            let t = if iteration % 3 == 2 || !(guess > from && guess < to) { 0.5 * from + 0.5 * to } else { guess };
            if t <= from || t >= to {
                break;
            }
            let Some(point) = self.point(&[&low, &high], t) else { break };
            if sign * point.sample.value >= sign * top.sample.value {
                top = Rc::clone(&point);
            }
            let next = t - point.sample.first / point.sample.second;
            guess = if next.is_finite() { next } else { f64::NAN };
            if slope(&point) > 0.0 {
                low = point;
            } else {
                high = point;
            }
            if !guess.is_finite() {
                guess = chord(&low, &high, slope(&low), slope(&high));
            }
            let is_inside = guess > low.state.t && guess < high.state.t;
            let is_close = is_inside && (guess - t).abs() <= CERTAIN * scale.span;
            if is_close || high.state.t - low.state.t <= CERTAIN * scale.span {
                break;
            }
        }
        // its time is where the slope turns, whatever the last digits of the values say
        let is_inside = guess > low.state.t && guess < high.state.t;
        let turn = if is_inside { guess } else { high.state.t };
        self.note_turn(&top, turn, extreme, scale);
    }

    /// Takes note of a turn at a time (s), near a point.
    fn note_turn(&mut self, near: &Point, t: f64, extreme: &mut Extreme, scale: Scale) {
        let [t, value] = self.settled_turn(&near.state, t, scale.span).unwrap_or([t, near.sample.value]);
        extreme.add(Extremum { t, value: extreme.sign * value, kind: Kind::Turn }, scale);
    }

    /// The time (s) and the value of a turn that is near a state and a time, as they are whichever way led there; none where it does not settle, or
    /// beyond an edge.
    fn settled_turn(&mut self, near: &State, t: f64, span: f64) -> Option<[f64; 2]> {
        if !self.formula.settles() {
            return None;
        }
        let mut turn = Settling::near(t, span, self.formula.derivatives() == 2)?;
        let mut samples = [Sampled::NOTHING; MOST_LOOKS];
        loop {
            for (look, sample) in samples.iter_mut().enumerate().take(turn.looks()) {
                let t = turn.time(look);
                let is_before = self.stretch.begins_at_edge && t < self.stretch.from.t;
                let is_behind = self.stretch.ends_at_edge && t > self.stretch.to.t;
                if is_before || is_behind {
                    return None;
                }
                let state = self.places.settled(self.stretch, near, t)?;
                *sample = self.formula.at(state, self.places).sample;
            }
            match turn.go_on(&samples[..turn.looks()]) {
                Turning::On => {}
                Turning::Settled(found) => return Some(found),
                Turning::Lost => return None,
            }
        }
    }

    /// Whether a cell whose values are no larger than `upper` holds hardly more than the larger of its ends, which is noted then with the
    /// top beside it: all that is known of a formula without derivatives.
    fn is_done_by_values(&mut self, cell: &Cell, upper: f64, extreme: &mut Extreme, scale: Scale) -> bool {
        let [a, b] = extreme.values(cell);
        let is_small = upper <= f64::max(a, b) + scale.gap(GAP_OF_VALUES);
        if is_small && f64::max(a, b) >= extreme.best - scale.alike() {
            let (point, value) = if b > a { (&cell.b, b) } else { (&cell.a, a) };
            extreme.add(Extremum { t: point.state.t, value, kind: Kind::Seen }, scale);
            if let Some(top) = self.top_beside(cell, point, extreme.sign, scale) {
                extreme.add(top, scale);
            }
        }
        is_small
    }

    /// The top beside one of the ends of a cell; none where it lies farther away, where another cell has it. It is that of a parabola through
    /// three points, as far apart as these ends at first, and then ever closer.
    fn top_beside(&mut self, cell: &Cell, near: &Rc<Point>, sign: f64, scale: Scale) -> Option<Extremum> {
        let [from, to] = [&self.stretch.from, &self.stretch.to].map(|state| state.t);
        let (mut t, mut apart) = (near.state.t, cell.length());
        let (rounding, finest) = (scale.gap(0.0), FINEST * scale.span);
        for fit in 0.. {
            let h = apart.min(0.5 * (to - from));
            let center = t.clamp(from + h, (to - h).max(from + h));
            let [before, middle, behind] = self.values_at([center - h, center, center + h], sign)?;
            let (rise, bend) = (0.5 * (behind - before), behind - 2.0 * middle + before);
            if bend >= -rounding {
                // it rests, or goes on as it comes
                if fit == 0 && rise.abs() > rounding {
                    return None;
                }
                break;
            }
            let off = -rise / bend;
            if off.abs() > FARTHEST {
                return None;
            }
            t = (center + off * h).clamp(from, to);
            if apart <= finest {
                break;
            }
            apart = finest.max(CLOSER * apart);
        }
        let [value] = self.values_at([t], sign)?;
        Some(Extremum { t, value, kind: Kind::Turn })
    }

    /// The formula at some times (s) of the stretch, times the sign.
    fn values_at<const N: usize>(&mut self, times: [f64; N], sign: f64) -> Option<[f64; N]> {
        let [from, to] = [&self.stretch.from, &self.stretch.to].map(|state| state.t);
        let mut values = [0.0; N];
        for (value, t) in values.iter_mut().zip(times) {
            *value = sign * self.point_of_stretch(t.clamp(from, to))?.sample.value;
        }
        Some(values)
    }
}

/// Where the straight line through two slopes is zero (s).
fn chord(low: &Point, high: &Point, a: f64, b: f64) -> f64 {
    low.state.t + (high.state.t - low.state.t) * a / (a - b)
}
