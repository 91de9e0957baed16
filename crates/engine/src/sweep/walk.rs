//! The way of variants that go side by side, a lane for each: from where the mechanism stands with its own values to their parameters, and from
//! there from time to time. Newton goes from grid point to grid point (`math/grid.rs`), so that what is solved for exactly has the bits that it has
//! alone, as long as the branch is the same. A step is taken where that is beyond doubt; a variant in doubt leaves.

use super::each::{Each, LANES, PART, ZERO, parts_of};
use super::judge::{self, Doubts, Known, Stand};
use super::table::Table;
use super::together::{Rows, Together};
use crate::solver::{Abreast, Guesses, Solver};
use mechc_expr::math::{weigh, weigh_slopes};
use mechc_ir::program::LaneValues;
use mechc_ir::tolerances::solving::variants::{ALIKE, CALM_STEPS, NEARLY, PARTS_OF_WAY, PATIENCE};
use mechc_ir::tolerances::steps::march::CRUMB;
use std::array::from_fn;

/// A motion is led on from so many places at the most.
const PLACES: usize = 4;

impl Known {
    /// From how many places a motion is led on of which this is known.
    const fn places(self) -> usize {
        match self {
            Known::Velocities => 4,
            Known::Accelerations => 3,
        }
    }
}

/// Variants on their way.
pub(super) struct Walk {
    /// The program's registers.
    pub registers: Vec<Each>,
    params: Vec<Each>,
    steps: Abreast<LANES>,
    /// Where they are, where they were before that, last things first, and where they are to be.
    pub now: Box<Stand>,
    before: [Box<Stand>; PLACES - 1],
    next: Box<Stand>,
    /// How many of these places lie on the motion, with where they are.
    passed: usize,
    ahead: Ahead,
    guesses: Vec<Each>,
    /// How long steps may be (s), the longest that they may ever be, and how many of that length have been taken.
    length: f64,
    longest: f64,
    taken: u32,
    /// Those that go on, and in how many parts of the lanes, the first ones, there are any.
    pub goes: [bool; LANES],
    pub parts: usize,
    /// How often each may still ask for shorter steps.
    patience: [u32; LANES],
}

/// How what is known at the last places leads on.
#[derive(Default)]
struct Ahead {
    /// The step's length, and how long ago the places before were (s).
    spans: [f64; PLACES],
    /// By place: what value, velocity and acceleration weigh.
    weights: [[f64; 3]; PLACES],
}

impl Ahead {
    /// Leads on by a step from so many places, which were some time ago (s).
    fn lead_on(&mut self, known: Known, passed: usize, spans: [f64; PLACES]) {
        let is_alike = |(span, before): (&f64, &f64)| (span - before).abs() <= ALIKE * before;
        // what a guess is off so much is far below a cell of the grid
        if spans.iter().zip(&self.spans).all(is_alike) {
            return;
        }
        let [h, back @ ..] = spans;
        (self.spans, self.weights) = (spans, [[0.0; 3]; PLACES]);
        let mut nodes = [0.0; PLACES];
        nodes[1..].iter_mut().zip(back).for_each(|(node, back)| *node = -back);
        let weigh = match known {
            Known::Velocities => weigh_slopes,
            Known::Accelerations => weigh,
        };
        weigh(&nodes[..passed], h, &mut self.weights);
    }
}

/// What solves for a place.
pub(super) struct Solving<'s> {
    pub solver: &'s Solver,
    pub abreast: &'s mut Abreast<LANES>,
    /// Whether bits count.
    pub is_exact: bool,
}

impl<'s> Solving<'s> {
    /// For rows that are wanted, to the bit.
    pub fn of_rows(rows: &'s Rows, table: &'s mut Table) -> Solving<'s> {
        Solving { solver: &rows.solver, abreast: &mut table.abreast, is_exact: true }
    }
}

impl Walk {
    /// Of a mechanism.
    pub fn new(together: &Together) -> Walk {
        Walk {
            registers: together.registers(),
            params: together.own.iter().map(|&value| LaneValues([value; LANES])).collect(),
            steps: together.abreast(&together.steps, |_| 1),
            now: together.stand(),
            before: from_fn(|_| together.stand()),
            next: together.stand(),
            passed: 0,
            ahead: Ahead::default(),
            guesses: vec![ZERO; together.tears.len()],
            length: 0.0,
            longest: 0.0,
            taken: 0,
            goes: [false; LANES],
            parts: 0,
            patience: [0; LANES],
        }
    }

    /// Goes to where some of the variants begin that have such parameters (SI), of a motion in steps that are no longer (s), and solves for that
    /// place.
    pub fn begin(
        &mut self,
        of: &Together,
        (params, those): (&[Each], [bool; LANES]),
        longest: f64,
        solving: &mut Solving<'_>,
    ) {
        (self.goes, self.patience) = (those, [PATIENCE; LANES]);
        self.parts = parts_of(&those);
        (self.longest, self.taken) = (longest, 0);
        self.length = self.longest;
        self.goes = self.lead(of, params);
        solving.abreast.load(solving.solver, (&of.program, &of.scalars), &self.registers, self.parts);
        for (guess, &tear) in self.guesses.iter_mut().zip(&of.tears) {
            *guess = self.now.tracked[tear][0];
        }
        let doubts = self.try_at(of, of.from, None, Some(solving));
        doubts.lanes().for_each(|k| self.goes[k] = false);
        self.advance();
        self.passed = 1;
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
        (self.now, self.before[0]) = (of.stand(), of.stand());
        for part in 1..=parts {
            self.load(of, targets, f64::from(part) / f64::from(parts));
            if part == 1 {
                of.write_first_guesses(&self.params, &mut self.guesses);
            } else {
                // straight on
                for (guess, &tear) in self.guesses.iter_mut().zip(&of.tears) {
                    let (now, before) = (&self.now.tracked[tear][0].0, &self.before[0].tracked[tear][0].0);
                    guess.0 = from_fn(|k| now[k] + (now[k] - before[k]));
                }
            }
            let doubts = self.try_at(of, of.from, None, None);
            doubts.lanes().for_each(|k| open[k] = false);
            self.advance();
        }
        open
    }

    /// Loads the parameters at a part of the way to others.
    fn load(&mut self, of: &Together, targets: &[Each], part: f64) {
        for ((param, target), &own) in self.params.iter_mut().zip(targets).zip(&of.own) {
            param.0 = if part < 1.0 { target.0.map(|target| own + part * (target - own)) } else { target.0 };
        }
        of.load(&mut self.registers, &self.params, self.parts);
        self.steps.load(&of.steps, (&of.program, &of.scalars), &self.registers, self.parts);
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
            let next = if is_last { t } else { self.now.t + left / -mechc_expr::math::floor(-left / self.length) };
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
        for k in doubts.lanes() {
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

    /// Where Newton begins after a step of length `h`: on the curve through the last places, which is linear in what these are.
    fn guess(&mut self, of: &Together, h: f64) {
        let Walk { now, before: [before, earlier, earliest], passed, ahead, guesses, .. } = self;
        let (places, passed) = ([&**now, before, earlier, earliest], (*passed).min(of.known.places()));
        // a place that was not passed is none: what has got lost on the way may stand there
        let places: [&Stand; PLACES] = from_fn(|k| places[if k < passed { k } else { 0 }]);
        ahead.lead_on(of.known, passed, from_fn(|k| if k == 0 { h } else { places[0].t - places[k].t }));
        let weights = ahead.weights;
        of.vectors.run(
            #[inline(always)]
            || {
                for (guess, &tear) in guesses.iter_mut().zip(&of.tears) {
                    let places = places.map(|stand| &stand.tracked[tear]);
                    for part in 0..LANES / PART {
                        *guess.part_mut(part) = match of.known {
                            Known::Velocities => {
                                led_on::<{ Known::Velocities.orders() }, { Known::Velocities.places() }>(
                                    weights, places, part,
                                )
                            }
                            Known::Accelerations => led_on::<
                                { Known::Accelerations.orders() },
                                { Known::Accelerations.places() },
                            >(weights, places, part),
                        };
                    }
                }
            },
        );
    }

    /// Solves at a time, in some way if one is asked for, and gives what is in doubt of each variant: after a step, if it was one of time.
    fn try_at(&mut self, of: &Together, t: f64, h: Option<f64>, solving: Option<&mut Solving<'_>>) -> Doubts {
        let Walk { registers, steps, guesses, now, next, parts, .. } = self;
        let step = (&of.steps, steps, false);
        let (solver, abreast, is_exact) =
            solving.map_or(step, |solving| (solving.solver, &mut *solving.abreast, solving.is_exact));
        let [of_steps, of_rows] = &of.bounds;
        let (bounds, nearly) = if is_exact { (of_rows, 0.0) } else { (of_steps, NEARLY) };
        let parts = *parts;
        let guesses = Guesses { times: [t; LANES], tears: guesses, loaded: registers, bounds, parts, nearly };
        abreast.run(solver, (&of.program, &of.scalars), &guesses);
        let mut doubts = Doubts(ZERO);
        of.vectors.run(
            #[inline(always)]
            || {
                let tracked = (&*of.tracked, of.known);
                next.take(tracked, of.nearness, t, abreast);
                abreast.write_doubts(&mut doubts.0);
                judge::of_step(tracked, [now, next], (h, abreast.first_corrections()), &mut doubts);
            },
        );
        doubts
    }

    /// Goes to where they were to be.
    fn advance(&mut self) {
        self.before.rotate_right(1);
        std::mem::swap(&mut self.before[0], &mut self.now);
        std::mem::swap(&mut self.now, &mut self.next);
        self.passed = (self.passed + 1).min(PLACES);
    }
}

/// Where some of the places lead to by their weights, as far as so many numbers of each are known, in a part of the lanes. What it is made of is
/// its own: else nothing would be done in all lanes at once.
#[inline(always)]
#[allow(clippy::inline_always)] // it is compiled for several kinds of processors
fn led_on<const ORDERS: usize, const OF: usize>(
    weights: [[f64; 3]; PLACES],
    places: [&[Each; 3]; PLACES],
    part: usize,
) -> [f64; PART] {
    let mut sums = [[0.0; PART]; OF];
    for (place, sum) in sums.iter_mut().enumerate() {
        let weighed = |order: usize| {
            let (known, weight) = (*places[place][order].part::<PART>(part), weights[place][order]);
            known.map(|known| weight * known)
        };
        *sum = weighed(0);
        for order in 1..ORDERS {
            let more = weighed(order);
            for k in 0..PART {
                sum[k] += more[k];
            }
        }
    }
    let mut there = sums[0];
    for sum in &sums[1..] {
        for k in 0..PART {
            there[k] += sum[k];
        }
    }
    there
}
