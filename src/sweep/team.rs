//! Variants that go side by side, a lane for each: from where the mechanism stands with its own values to their parameters, and from there from
//! time to time. Newton goes from grid point to grid point (`math/grid.rs`), so that rows have the bits that they have alone, as long as the
//! branch is the same. A step is taken where that is beyond doubt; a variant in doubt leaves, and goes alone from the beginning.

use super::each::{Each, LANES, ZERO};
use super::judge::{self, Doubts, Stand};
use super::together::Together;
use crate::cancel::Cancel;
use crate::math::hermite::bend_ahead;
use crate::program::LaneValues;
use crate::solver::{Abreast, Guesses};
use crate::tolerances::solving::variants::{CALM_STEPS, FEWEST_STEPS, NEARLY, PARTS_OF_WAY, PATIENCE};
use crate::tolerances::steps::march::CRUMB;
use std::array::from_fn;
use std::sync::Arc;

/// Rows that are put into columns together: as many as are a line of memory.
const TILE: usize = 8;

/// Variants that go side by side.
pub struct Team {
    together: Arc<Together>,
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
    /// How long steps may be (s), and how many of that length have been taken.
    longest: f64,
    taken: u32,
    /// Those that go on.
    goes: [bool; LANES],
    /// How often each may still ask for shorter steps.
    patience: [u32; LANES],
    /// By wanted column: the last rows.
    tile: Vec<[Each; TILE]>,
    /// By wanted column, by variant: row after row.
    table: Vec<f64>,
}

impl Team {
    /// Of a mechanism.
    #[must_use]
    pub fn new(together: &Arc<Together>) -> Team {
        let rows = together.times.len() as usize;
        Team {
            registers: together.registers(),
            params: together.own.iter().map(|&value| LaneValues([value; LANES])).collect(),
            steps: together.abreast(&together.steps),
            rows: together.abreast(&together.rows),
            now: together.stand(),
            before: together.stand(),
            next: together.stand(),
            guesses: vec![ZERO; together.tears.len()],
            longest: 0.0,
            taken: 0,
            goes: [false; LANES],
            patience: [0; LANES],
            tile: vec![[ZERO; TILE]; together.wanted.len()],
            table: vec![0.0; together.wanted.len() * LANES * rows],
            together: Arc::clone(together),
        }
    }

    /// Follows some of as many variants as there are lanes, by the values of all their parameters (SI); says which have all their rows.
    pub fn follow(&mut self, params: &[Each], those: [bool; LANES], cancel: &Cancel) -> [bool; LANES] {
        (self.goes, self.patience) = (those, [PATIENCE; LANES]);
        (self.longest, self.taken) = (self.together.times.span() / FEWEST_STEPS, 0);
        self.goes = self.lead(params);
        self.begin();
        for number in 0..self.together.times.len() {
            if !self.goes.contains(&true) || cancel.is_cancelled() {
                return [false; LANES];
            }
            self.go_to(number);
        }
        self.goes
    }

    /// How many rows each variant has.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.together.rows()
    }

    /// The rows of some variants, which stand next to each other, in a wanted column, by its place among these.
    #[must_use]
    pub fn column(&self, place: usize, variants: std::ops::Range<usize>) -> &[f64] {
        let rows = self.together.times.len() as usize;
        &self.table[(place * LANES + variants.start) * rows..(place * LANES + variants.end) * rows]
    }

    /// Leads all variants to their parameters, in as few parts of the way as each needs; says which get there.
    fn lead(&mut self, targets: &[Each]) -> [bool; LANES] {
        let (mut open, mut there) = (self.goes, [false; LANES]);
        let mut reached = self.together.stand();
        for parts in PARTS_OF_WAY {
            let arrived = self.lead_in(parts, targets, open);
            for k in (0..LANES).filter(|&k| arrived[k]) {
                (open[k], there[k]) = (false, true);
                reached.copy_lane(&self.now, k);
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
        let together = Arc::clone(&self.together);
        (self.now, self.before) = (together.stand(), together.stand());
        for part in 1..=parts {
            self.load(targets, f64::from(part) / f64::from(parts));
            if part == 1 {
                together.write_first_guesses(&self.params, &mut self.guesses);
            } else {
                // straight on
                for (guess, &tear) in self.guesses.iter_mut().zip(&together.tears) {
                    let (now, before) = (&self.now.tracked[tear][0].0, &self.before.tracked[tear][0].0);
                    guess.0 = from_fn(|k| now[k] + (now[k] - before[k]));
                }
            }
            let doubts = self.try_at(together.times.from(), None, false);
            open.iter_mut().zip(doubts.0).for_each(|(open, doubts)| *open &= doubts == 0.0);
            self.advance();
        }
        open
    }

    /// Loads the parameters at a part of the way to others.
    fn load(&mut self, targets: &[Each], part: f64) {
        let together = &*self.together;
        for ((param, target), &own) in self.params.iter_mut().zip(targets).zip(&together.own) {
            param.0 = if part < 1.0 { target.0.map(|target| own + part * (target - own)) } else { target.0 };
        }
        together.load(&mut self.registers, &self.params);
    }

    /// Solves where the way has led, like a row.
    fn begin(&mut self) {
        for (guess, &tear) in self.guesses.iter_mut().zip(&self.together.tears) {
            *guess = self.now.tracked[tear][0];
        }
        let doubts = self.try_at(self.together.times.from(), None, true);
        for (k, doubts) in doubts.0.into_iter().enumerate() {
            self.goes[k] &= doubts == 0.0;
        }
        self.advance();
        // no step came before
        self.before.t = f64::NAN;
    }

    /// Goes on to an output time, by its number, in as many steps as that takes.
    fn go_to(&mut self, number: u64) {
        let t = self.together.times.at(number);
        if self.now.t >= t {
            // where it begins
            self.write(number);
        }
        while self.now.t < t && self.goes.contains(&true) {
            let left = t - self.now.t;
            let is_last = self.longest >= CRUMB * left;
            // equal steps: none is a crumb
            let next = if is_last { t } else { self.now.t + left / -crate::math::floor(-left / self.longest) };
            let h = next - self.now.t;
            if !self.try_step(next, is_last.then_some(number)) {
                (self.longest, self.taken) = (0.5 * h, 0);
            } else if 2.0 * h > self.longest {
                self.taken += 1;
                if self.taken == CALM_STEPS {
                    let most = self.together.times.span() / FEWEST_STEPS;
                    (self.longest, self.taken) = ((2.0 * self.longest).min(most), 0);
                }
            }
        }
    }

    /// Tries a step, to an output time if it is one; says whether it was taken. Those that stand in its way too often leave.
    fn try_step(&mut self, t: f64, number: Option<u64>) -> bool {
        let h = t - self.now.t;
        self.guess(h);
        let doubts = self.try_at(t, Some(h), number.is_some());
        let mut is_taken = true;
        for k in (0..LANES).filter(|&k| doubts.0[k] != 0.0) {
            if self.goes[k] && self.patience[k] > 0 {
                self.patience[k] -= 1;
                is_taken = false;
            } else {
                self.goes[k] = false;
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

    /// Where Newton begins after a step of length `h`: on the curve that the last step leads on, which is linear in what both its ends are.
    fn guess(&mut self, h: f64) {
        let back = self.now.t - self.before.t;
        let share = |of: usize, is_before: bool| {
            let unit: [f64; 3] = from_fn(|k| if k == of { 1.0 } else { 0.0 });
            let ends = if is_before { [[0.0; 3], unit] } else { [unit, [0.0; 3]] };
            // no step came before
            if back > 0.0 { bend_ahead(ends[0], ends[1], back, h / back) } else { 0.0 }
        };
        let straight = [1.0, h, 0.5 * h * h];
        let now_share: [f64; 3] = from_fn(|of| straight[of] + share(of, false));
        let before_share: [f64; 3] = from_fn(|of| share(of, true));
        let Team { together, now, before, guesses, .. } = self;
        together.vectors.run(
            #[inline(always)]
            || {
                for (guess, &tear) in guesses.iter_mut().zip(&together.tears) {
                    let ([x, v, a], [y, w, b]) = (&now.tracked[tear], &before.tracked[tear]);
                    for k in 0..LANES {
                        let ahead = now_share[0] * x.0[k] + now_share[1] * v.0[k] + now_share[2] * a.0[k];
                        let bend = before_share[0] * y.0[k] + before_share[1] * w.0[k] + before_share[2] * b.0[k];
                        guess.0[k] = ahead + bend;
                    }
                }
            },
        );
    }

    /// Solves at a time, with rows if they are wanted, and gives what is in doubt of each variant: after a step, if it was one of time.
    fn try_at(&mut self, t: f64, h: Option<f64>, is_of_rows: bool) -> Doubts {
        let Team { together, registers, steps, rows, guesses, now, next, .. } = self;
        let [of_steps, of_rows] = &together.bounds;
        let (bounds, nearly) = if is_of_rows { (of_rows, 0.0) } else { (of_steps, NEARLY) };
        let guesses = Guesses { t, tears: guesses, loaded: registers, bounds, nearly };
        let (solver, abreast) = if is_of_rows { (&together.rows, rows) } else { (&together.steps, steps) };
        abreast.run(solver, (&together.program, &together.scalars), &guesses);
        let mut doubts = Doubts([0.0; LANES]);
        together.vectors.run(
            #[inline(always)]
            || {
                next.take(&together.tracked, together.nearness, t, abreast);
                abreast.write_doubts(&mut doubts.0);
                judge::of_step(&together.tracked, [now, next], (h, abreast.first_corrections()), &mut doubts);
            },
        );
        doubts
    }

    /// Goes to where they were to be.
    fn advance(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        std::mem::swap(&mut self.now, &mut self.next);
    }

    /// Takes the rows of an output time, by its number.
    fn write(&mut self, number: u64) {
        let Team { together, rows, tile, table, .. } = self;
        let at = number as usize % TILE;
        for (tile, &column) in tile.iter_mut().zip(&together.wanted) {
            tile[at] = if column == 0 { LaneValues([together.times.at(number); LANES]) } else { *rows.column(column) };
        }
        if at + 1 == TILE || number + 1 == together.times.len() {
            let (stride, first) = (together.times.len() as usize, number as usize - at);
            for (columns, tile) in table.chunks_exact_mut(LANES * stride).zip(tile) {
                for (lane, column) in columns.chunks_exact_mut(stride).enumerate() {
                    for (value, each) in column[first..=first + at].iter_mut().zip(tile.iter()) {
                        *value = each.0[lane];
                    }
                }
            }
        }
    }
}
