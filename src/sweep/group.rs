//! Variants that go side by side, a lane for each: from where the mechanism stands with its own values to their parameters, and from there from
//! time to time. Newton goes from grid point to grid point (`math/grid.rs`), so that rows have the bits that they have alone, as long as the
//! branch is the same. A step is taken where that is beyond doubt; a variant in doubt leaves, and goes alone from the beginning.

use super::together::Together;
use crate::cancel::Cancel;
use crate::math::hermite::bend_ahead;
use crate::math::max;
use crate::program::LaneValues;
use crate::solver::{Abreast, Guesses};
use crate::tolerances::solving::variants::{
    FEWEST_STEPS, LARGEST_CHANGE, LARGEST_GAP, LARGEST_MOTION, NEAREST, PARTS_OF_WAY, PART_OF_DISTANCE, PATIENCE,
};
use crate::tolerances::steps::march::CRUMB;
use std::array::from_fn;

/// So many variants go side by side.
pub const LANES: usize = 16;

/// A number for each of them.
type Each = LaneValues<LANES>;

const ZERO: Each = LaneValues([0.0; LANES]);

/// Variants that go side by side.
pub struct Group<'t> {
    together: &'t Together,
    /// The program's registers.
    registers: Vec<Each>,
    params: Vec<Each>,
    steps: Abreast<LANES>,
    rows: Abreast<LANES>,
    /// Where they are, where they were before, and where they are to be.
    now: Stand,
    before: Stand,
    next: Stand,
    guesses: Vec<Each>,
    /// Those that go on.
    goes: [bool; LANES],
    /// How often each may still ask for shorter steps.
    patience: [u32; LANES],
    /// By wanted column, by variant: row after row.
    table: Vec<f64>,
}

/// Where variants stand.
#[derive(Clone)]
struct Stand {
    t: f64,
    /// By coordinate that steps are judged by: value, velocity, acceleration.
    tracked: Vec<[Each; 3]>,
    /// By turn of the solver: one over the determinant.
    determinants: Vec<Each>,
    /// How near to a singular position that is.
    nearness: [f64; LANES],
}

impl Stand {
    fn new(together: &Together) -> Stand {
        Stand {
            t: together.times.from(),
            tracked: together.q.iter().map(|&q| [LaneValues([q; LANES]), ZERO, ZERO]).collect(),
            determinants: together.determinants.iter().map(|&of| LaneValues([of; LANES])).collect(),
            nearness: [together.own_nearness; LANES],
        }
    }

    fn take(&mut self, together: &Together, t: f64, from: &Abreast<LANES>) {
        self.t = t;
        for (tracked, of) in self.tracked.iter_mut().zip(&together.tracked) {
            *tracked = of.columns.map(|column| LaneValues(*from.column(column)));
        }
        self.determinants.copy_from_slice(from.determinants());
        self.nearness = from.steepest().map(|steepest| together.nearness(steepest));
    }
}

impl<'t> Group<'t> {
    /// Of a mechanism.
    #[must_use]
    pub fn new(together: &'t Together) -> Group<'t> {
        let rows = together.times.len() as usize;
        Group {
            registers: together.registers(),
            params: together.own.iter().map(|&value| LaneValues([value; LANES])).collect(),
            steps: together.abreast(&together.steps),
            rows: together.abreast(&together.rows),
            now: Stand::new(together),
            before: Stand::new(together),
            next: Stand::new(together),
            guesses: vec![ZERO; together.tears.len()],
            goes: [false; LANES],
            patience: [0; LANES],
            table: vec![0.0; together.wanted.len() * LANES * rows],
            together,
        }
    }

    /// Follows as many variants as there are lanes, or fewer, by the values of all their parameters (SI); says which have all their rows.
    pub fn follow(&mut self, variants: &[Option<Vec<f64>>], cancel: &Cancel) -> [bool; LANES] {
        self.goes = from_fn(|k| variants.get(k).is_some_and(Option::is_some));
        self.patience = [PATIENCE; LANES];
        let targets: Vec<Each> = (0..self.params.len())
            .map(|k| {
                let of = |lane: usize| variants.get(lane).and_then(|values| Some(values.as_ref()?[k]));
                LaneValues(from_fn(|lane| of(lane).unwrap_or(self.together.own[k])))
            })
            .collect();
        self.goes = self.lead(&targets);
        self.begin();
        for number in 1..self.together.times.len() {
            if !self.goes.contains(&true) || cancel.is_cancelled() {
                return [false; LANES];
            }
            self.go_to(number);
        }
        self.goes
    }

    /// The rows of a variant in a wanted column, by its place among these.
    #[must_use]
    pub fn column(&self, place: usize, variant: usize) -> &[f64] {
        let rows = self.together.times.len() as usize;
        &self.table[(place * LANES + variant) * rows..][..rows]
    }

    /// Leads all variants to their parameters, in as few parts of the way as each needs; says which get there.
    fn lead(&mut self, targets: &[Each]) -> [bool; LANES] {
        let (mut open, mut there) = (self.goes, [false; LANES]);
        let mut reached = Stand::new(self.together);
        for parts in PARTS_OF_WAY {
            let arrived = self.lead_in(parts, targets, open);
            for k in (0..LANES).filter(|&k| arrived[k]) {
                (open[k], there[k]) = (false, true);
                copy_lane(&mut reached, &self.now, k);
            }
            if !open.contains(&true) {
                break;
            }
        }
        self.now = reached;
        self.load(targets, 1.0);
        there
    }

    /// The same in so many parts; says which of some variants get there.
    fn lead_in(&mut self, parts: u32, targets: &[Each], mut open: [bool; LANES]) -> [bool; LANES] {
        let together = self.together;
        (self.now, self.before) = (Stand::new(together), Stand::new(together));
        for part in 1..=parts {
            self.load(targets, f64::from(part) / f64::from(parts));
            // straight on
            for (guess, &tear) in self.guesses.iter_mut().zip(&together.tears) {
                let (now, before) = (&self.now.tracked[tear][0].0, &self.before.tracked[tear][0].0);
                guess.0 = from_fn(|k| now[k] + (now[k] - before[k]));
            }
            self.solve_step(together.times.from());
            let motion = self.motion();
            for (k, open) in open.iter_mut().enumerate().filter(|(_, open)| **open) {
                *open = self.steps.holds(k) && self.is_near(k, motion[k], self.steps.first_correction(k));
            }
            self.advance();
        }
        open
    }

    /// Loads the parameters at a part of the way to others.
    fn load(&mut self, targets: &[Each], part: f64) {
        let together = self.together;
        for (k, (param, target)) in self.params.iter_mut().zip(targets).enumerate() {
            let own = together.own[k];
            param.0 = target.0.map(|target| if part < 1.0 { own + part * (target - own) } else { target });
        }
        together.load(&mut self.registers, &self.params);
    }

    /// The first rows, where the way has led.
    fn begin(&mut self) {
        for (guess, &tear) in self.guesses.iter_mut().zip(&self.together.tears) {
            *guess = self.now.tracked[tear][0];
        }
        self.solve_row(self.together.times.from());
        let motion = self.motion();
        for k in 0..LANES {
            let is_there = self.rows.holds(k) && self.is_near(k, motion[k], self.rows.first_correction(k));
            self.goes[k] &= is_there && self.conditions_hold(k);
        }
        self.write(0);
        self.advance();
        self.before.t = f64::NAN;
    }

    fn conditions_hold(&self, lane: usize) -> bool {
        self.together.conditions.iter().all(|&register| self.registers[register as usize].0[lane] > 0.0)
    }

    /// Goes on to an output time, by its number, in as many steps as that takes.
    fn go_to(&mut self, number: u64) {
        let t = self.together.times.at(number);
        let longest = self.together.times.span() / FEWEST_STEPS;
        let mut h = longest;
        while self.now.t < t && self.goes.contains(&true) {
            let left = t - self.now.t;
            let is_last = h >= CRUMB * left;
            // equal steps: none is a crumb
            let next = if is_last { t } else { self.now.t + left / (left / h).ceil() };
            let is_taken = self.try_step(next, is_last.then_some(number));
            h = if is_taken { (2.0 * h).min(longest) } else { 0.5 * (next - self.now.t) };
        }
    }

    /// Tries a step, to an output time if it is one; says whether it was taken. Those that stand in its way too often leave.
    fn try_step(&mut self, t: f64, number: Option<u64>) -> bool {
        let h = t - self.now.t;
        self.guess(h);
        let (holds, first): ([bool; LANES], [f64; LANES]) = if number.is_some() {
            self.solve_row(t);
            (from_fn(|k| self.rows.holds(k)), from_fn(|k| self.rows.first_correction(k)))
        } else {
            self.solve_step(t);
            (from_fn(|k| self.steps.holds(k)), from_fn(|k| self.steps.first_correction(k)))
        };
        let (motion, gap) = (self.motion(), self.gap(h));
        let mut is_taken = true;
        for k in 0..LANES {
            if !self.goes[k] || holds[k] && gap[k] <= LARGEST_GAP && self.is_near(k, motion[k], first[k]) {
                continue;
            }
            if self.patience[k] == 0 {
                self.goes[k] = false;
            } else {
                self.patience[k] -= 1;
                is_taken = false;
            }
        }
        if is_taken {
            if let Some(number) = number {
                self.write(number);
            }
            self.advance();
        }
        is_taken
    }

    /// Where Newton begins after a step of length `h`: on the curve that the last step leads on.
    fn guess(&mut self, h: f64) {
        let back = self.now.t - self.before.t;
        for (guess, &tear) in self.guesses.iter_mut().zip(&self.together.tears) {
            let ([x, v, a], [y, w, b]) = (&self.now.tracked[tear], &self.before.tracked[tear]);
            for k in 0..LANES {
                let bend = if back > 0.0 {
                    bend_ahead([x.0[k], v.0[k], a.0[k]], [y.0[k], w.0[k], b.0[k]], back, h / back)
                } else {
                    0.0
                };
                guess.0[k] = x.0[k] + h * (v.0[k] + 0.5 * h * a.0[k]) + bend;
            }
        }
    }

    fn solve_step(&mut self, t: f64) {
        let Group { together, registers, steps, guesses, next, .. } = self;
        let guesses = Guesses { t, tears: guesses, loaded: registers, bounds: &together.bounds };
        steps.run(&together.steps, (&together.program, &together.scalars), &guesses);
        next.take(together, t, steps);
    }

    fn solve_row(&mut self, t: f64) {
        let Group { together, registers, rows, guesses, next, .. } = self;
        let guesses = Guesses { t, tears: guesses, loaded: registers, bounds: &together.bounds };
        rows.run(&together.rows, (&together.program, &together.scalars), &guesses);
        next.take(together, t, rows);
    }

    /// How far each variant would go, scaled.
    fn motion(&self) -> [f64; LANES] {
        let mut motion = [0.0; LANES];
        for ((now, next), of) in self.now.tracked.iter().zip(&self.next.tracked).zip(&self.together.tracked) {
            let per_scale = 1.0 / of.scale;
            for k in 0..LANES {
                motion[k] = max(motion[k], (next[0].0[k] - now[0].0[k]).abs() * per_scale);
            }
        }
        motion
    }

    /// How far positions would be from what both ends' velocities and accelerations make of the way between, scaled.
    fn gap(&self, h: f64) -> [f64; LANES] {
        let mut gap = [0.0; LANES];
        for ((now, next), of) in self.now.tracked.iter().zip(&self.next.tracked).zip(&self.together.tracked) {
            let ([x, v, a], [y, w, b]) = (now, next);
            let per_scale = 1.0 / of.scale;
            for k in 0..LANES {
                let way = 0.5 * h * (v.0[k] + w.0[k]) + h * h * (1.0 / 12.0) * (a.0[k] - b.0[k]);
                gap[k] = max(gap[k], (y.0[k] - x.0[k] - way).abs() * per_scale);
            }
        }
        gap
    }

    /// Whether a variant's next position is beyond doubt on the branch that it is on: both are far from singular positions beside the motion
    /// between, which is small, as is the first correction; no determinant has turned, or changed by much.
    fn is_near(&self, lane: usize, motion: f64, first_correction: f64) -> bool {
        let [from, to] = [self.now.nearness[lane], self.next.nearness[lane]];
        let distance = f64::min(from, to);
        let is_kept = |(now, next): (&Each, &Each)| {
            let change = next.0[lane] / now.0[lane];
            (1.0 / LARGEST_CHANGE..=LARGEST_CHANGE).contains(&change)
        };
        distance >= NEAREST
            && motion <= LARGEST_MOTION.min(f64::max(from, to))
            && first_correction <= PART_OF_DISTANCE * distance
            && self.now.determinants.iter().zip(&self.next.determinants).all(is_kept)
    }

    /// Goes to where they were to be.
    fn advance(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        std::mem::swap(&mut self.now, &mut self.next);
    }

    /// Takes the rows of an output time, by its number.
    fn write(&mut self, number: u64) {
        let Group { together, rows, table, .. } = self;
        let stride = together.times.len() as usize;
        for (columns, &column) in table.chunks_exact_mut(LANES * stride).zip(&together.wanted) {
            let values = if column == 0 { [together.times.at(number); LANES] } else { *rows.column(column) };
            for (column, value) in columns.chunks_exact_mut(stride).zip(values) {
                column[number as usize] = value;
            }
        }
    }
}

/// Takes over where one variant stands.
fn copy_lane(to: &mut Stand, from: &Stand, lane: usize) {
    for (to, from) in to.tracked.iter_mut().zip(&from.tracked) {
        to[0].0[lane] = from[0].0[lane];
    }
    for (to, from) in to.determinants.iter_mut().zip(&from.determinants) {
        to.0[lane] = from.0[lane];
    }
    to.nearness[lane] = from.nearness[lane];
}
