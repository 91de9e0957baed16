//! The way of variants that go side by side, a lane for each: from where the mechanism stands with its own values to their parameters, and from
//! there from time to time. Newton goes from grid point to grid point (`math/grid.rs`), so that what is solved for exactly has the bits that it has
//! alone, as long as the branch is the same. A step is taken where that is beyond doubt; a variant in doubt leaves.

use super::each::{Each, LANES, ZERO};
use super::judge::{self, Doubts, Stand};
use super::together::Together;
use crate::math::hermite::bend_ahead;
use crate::program::LaneValues;
use crate::solver::{Abreast, Guesses, Solver};
use crate::tolerances::solving::variants::{CALM_STEPS, FEWEST_STEPS, NEARLY, PARTS_OF_WAY, PATIENCE};
use crate::tolerances::steps::march::CRUMB;
use std::array::from_fn;

/// Variants on their way.
pub(super) struct Walk {
    /// The program's registers.
    pub registers: Vec<Each>,
    params: Vec<Each>,
    steps: Abreast<LANES>,
    /// Where they are, where they were before, and where they are to be.
    pub now: Stand,
    before: Stand,
    next: Stand,
    guesses: Vec<Each>,
    /// How long steps may be (s), the longest that they may ever be, and how many of that length have been taken.
    length: f64,
    longest: f64,
    taken: u32,
    /// Those that go on.
    pub goes: [bool; LANES],
    /// How often each may still ask for shorter steps.
    patience: [u32; LANES],
}

/// What solves for a place.
pub(super) struct Solving<'s> {
    pub solver: &'s Solver,
    pub abreast: &'s mut Abreast<LANES>,
    /// Whether bits count.
    pub is_exact: bool,
}

impl Walk {
    /// Of a mechanism.
    pub fn new(together: &Together) -> Walk {
        Walk {
            registers: together.registers(),
            params: together.own.iter().map(|&value| LaneValues([value; LANES])).collect(),
            steps: together.abreast(&together.steps),
            now: together.stand(),
            before: together.stand(),
            next: together.stand(),
            guesses: vec![ZERO; together.tears.len()],
            length: 0.0,
            longest: 0.0,
            taken: 0,
            goes: [false; LANES],
            patience: [0; LANES],
        }
    }

    /// Goes to where some of the variants begin that have such parameters (SI), of a motion over a span (s), and solves for that place.
    pub fn begin(
        &mut self,
        of: &Together,
        (params, those): (&[Each], [bool; LANES]),
        span: f64,
        solving: &mut Solving<'_>,
    ) {
        (self.goes, self.patience) = (those, [PATIENCE; LANES]);
        (self.longest, self.taken) = (span / FEWEST_STEPS, 0);
        self.length = self.longest;
        self.goes = self.lead(of, params);
        for (guess, &tear) in self.guesses.iter_mut().zip(&of.tears) {
            *guess = self.now.tracked[tear][0];
        }
        let doubts = self.try_at(of, of.from, None, Some(solving));
        for (k, doubts) in doubts.0.into_iter().enumerate() {
            self.goes[k] &= doubts == 0.0;
        }
        self.advance();
        // no step came before
        self.before.t = f64::NAN;
    }

    /// Leads all variants to their parameters, in as few parts of the way as each needs; says which get there.
    fn lead(&mut self, of: &Together, targets: &[Each]) -> [bool; LANES] {
        let (mut open, mut there) = (self.goes, [false; LANES]);
        let mut reached = of.stand();
        for parts in PARTS_OF_WAY {
            let arrived = self.lead_in(of, parts, targets, open);
            for k in (0..LANES).filter(|&k| arrived[k]) {
                (open[k], there[k]) = (false, true);
                reached.copy_lane(&self.now, k);
            }
            if !open.contains(&true) {
                break;
            }
        }
        self.now = reached;
        self.load(of, targets, 1.0);
        there
    }

    /// The same in so many parts; says which of some variants get there.
    fn lead_in(&mut self, of: &Together, parts: u32, targets: &[Each], mut open: [bool; LANES]) -> [bool; LANES] {
        (self.now, self.before) = (of.stand(), of.stand());
        for part in 1..=parts {
            self.load(of, targets, f64::from(part) / f64::from(parts));
            if part == 1 {
                of.write_first_guesses(&self.params, &mut self.guesses);
            } else {
                // straight on
                for (guess, &tear) in self.guesses.iter_mut().zip(&of.tears) {
                    let (now, before) = (&self.now.tracked[tear][0].0, &self.before.tracked[tear][0].0);
                    guess.0 = from_fn(|k| now[k] + (now[k] - before[k]));
                }
            }
            let doubts = self.try_at(of, of.from, None, None);
            open.iter_mut().zip(doubts.0).for_each(|(open, doubts)| *open &= doubts == 0.0);
            self.advance();
        }
        open
    }

    /// Loads the parameters at a part of the way to others.
    fn load(&mut self, of: &Together, targets: &[Each], part: f64) {
        for ((param, target), &own) in self.params.iter_mut().zip(targets).zip(&of.own) {
            param.0 = if part < 1.0 { target.0.map(|target| own + part * (target - own)) } else { target.0 };
        }
        of.load(&mut self.registers, &self.params);
    }

    /// Goes on to a time (s), in as many steps as that takes, where it is solved for in some way; on the way by that too, if it is wanted
    /// there. Shows each place that was solved for so.
    pub fn go_to(
        &mut self,
        of: &Together,
        t: f64,
        (solving, is_everywhere): (&mut Solving<'_>, bool),
        mut show: impl FnMut(&Walk, &Abreast<LANES>),
    ) {
        while self.now.t < t && self.goes.contains(&true) {
            let left = t - self.now.t;
            let is_last = self.length >= CRUMB * left;
            // equal steps: none is a crumb
            let next = if is_last { t } else { self.now.t + left / -crate::math::floor(-left / self.length) };
            let h = next - self.now.t;
            let is_shown = is_last || is_everywhere;
            if !self.try_step(of, next, is_shown.then_some(&mut *solving)) {
                (self.length, self.taken) = (0.5 * h, 0);
                continue;
            }
            if is_shown {
                show(self, solving.abreast);
            }
            if 2.0 * h > self.length {
                self.taken += 1;
                if self.taken == CALM_STEPS {
                    (self.length, self.taken) = ((2.0 * self.length).min(self.longest), 0);
                }
            }
        }
    }

    /// Tries a step to a time (s); says whether it was taken. Those that stand in its way too often leave.
    fn try_step(&mut self, of: &Together, t: f64, solving: Option<&mut Solving<'_>>) -> bool {
        let h = t - self.now.t;
        self.guess(of, h);
        let doubts = self.try_at(of, t, Some(h), solving);
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
            self.advance();
        }
        is_taken
    }

    /// Where Newton begins after a step of length `h`: on the curve that the last step leads on, which is linear in what both its ends are.
    fn guess(&mut self, of: &Together, h: f64) {
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
        let Walk { now, before, guesses, .. } = self;
        of.vectors.run(
            #[inline(always)]
            || {
                for (guess, &tear) in guesses.iter_mut().zip(&of.tears) {
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

    /// Solves at a time, in some way if one is asked for, and gives what is in doubt of each variant: after a step, if it was one of time.
    fn try_at(&mut self, of: &Together, t: f64, h: Option<f64>, solving: Option<&mut Solving<'_>>) -> Doubts {
        let Walk { registers, steps, guesses, now, next, .. } = self;
        let step = (&of.steps, steps, false);
        let (solver, abreast, is_exact) =
            solving.map_or(step, |solving| (solving.solver, &mut *solving.abreast, solving.is_exact));
        let [of_steps, of_rows] = &of.bounds;
        let (bounds, nearly) = if is_exact { (of_rows, 0.0) } else { (of_steps, NEARLY) };
        let guesses = Guesses { times: [t; LANES], tears: guesses, loaded: registers, bounds, nearly };
        abreast.run(solver, (&of.program, &of.scalars), &guesses);
        let mut doubts = Doubts([0.0; LANES]);
        of.vectors.run(
            #[inline(always)]
            || {
                next.take(&of.tracked, of.nearness, t, abreast);
                abreast.write_doubts(&mut doubts.0);
                judge::of_step(&of.tracked, [now, next], (h, abreast.first_corrections()), &mut doubts);
            },
        );
        doubts
    }

    /// Goes to where they were to be.
    fn advance(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        std::mem::swap(&mut self.now, &mut self.next);
    }
}
