//! The results of variants that go side by side. Their motion is gone through in steps, which tell where extrema are; an extremum that is beyond
//! doubt is settled on a grid of times (`analysis::Settling`), and computed there as it is alone.

// what is done in every lane reads best with the lane's number
#![allow(clippy::needless_range_loop)]

use super::asked::{Asked, Wanted, What};
use super::each::{Each, LANES, ZERO, parts_of};
use super::steps::Steps;
use super::together::Together;
use super::walk::{Solving, Walk};
use crate::analysis::course::{Course, Place, Tower, integral_by_steps};
use crate::analysis::{MOST_LOOKS, Sampled, Settled, Settling, SpectralIntegral, Turning};
use crate::solver::{Abreast, Guesses};
use mechc_ir::tolerances::solving::course::{ALIKE, MOST_STEPS};
use mechc_ir::tolerances::solving::variants::{NEAREST, PART_OF_DISTANCE};
use mechc_text::cancel::Cancel;
use std::array::from_fn;

/// What is found of variants.
pub(super) struct Survey {
    abreast: Abreast<LANES>,
    /// By quantity, by stage: its program's registers.
    registers: Vec<Vec<Vec<Each>>>,
    steps: Steps,
    guesses: Vec<Each>,
    /// What the course of a quantity is, of one variant.
    course: Vec<Tower>,
    /// By what is looked for, by variant: time (s) and value.
    found: Vec<[[f64; 2]; LANES]>,
    /// By variant: its results.
    results: Vec<f64>,
    /// Those that have them.
    pub answered: [bool; LANES],
}

/// Something that is looked for, by its number, on its way to where it is.
struct Looking {
    number: usize,
    /// By variant: the time that is looked at (s).
    times: [f64; LANES],
    /// By variant: the turn that it is, if it is one.
    turns: [Option<Settling>; LANES],
}

impl Looking {
    /// Goes on with a variant, by what the formula is at its time, or at the times of its turn.
    fn go_on(&mut self, lane: usize, samples: &[Sampled]) -> Turning {
        let at = Turning::Settled([self.times[lane], samples[0].value]);
        self.turns[lane].as_mut().map_or(at, |turn| turn.go_on(samples))
    }
}

impl Survey {
    /// For what results ask of a mechanism.
    pub fn new(together: &Together, asked: &Asked) -> Survey {
        Survey {
            abreast: together.abreast(&asked.solver, |_| 1),
            registers: (0..asked.count()).map(|quantity| asked.registers(quantity)).collect(),
            steps: Steps::default(),
            guesses: vec![ZERO; together.tears.len()],
            course: Vec::new(),
            found: vec![[[f64::NAN; 2]; LANES]; asked.wanted.len()],
            results: vec![f64::NAN; LANES * asked.results()],
            answered: [false; LANES],
        }
    }

    /// The results of a variant; nothing where they are not known.
    pub fn results(&self, variant: usize) -> Option<&[f64]> {
        let count = self.results.len() / LANES;
        self.answered[variant].then(|| &self.results[variant * count..(variant + 1) * count])
    }

    /// Finds the results of some variants, by the values of all their parameters (SI), as far as they are beyond doubt.
    pub fn answer(
        &mut self,
        of: (&Together, &Asked),
        walk: &mut Walk,
        (params, those): (&[Each], [bool; LANES]),
        cancel: &Cancel,
    ) {
        let (_, asked) = of;
        self.answered = [false; LANES];
        self.go(of, walk, (params, those));
        let mut open = walk.goes;
        for number in 0..asked.wanted.len() {
            if !open.contains(&true) || cancel.is_cancelled() {
                return;
            }
            self.find(of, (&walk.registers, params), number, &mut open);
        }
        let count = asked.results();
        for lane in (0..LANES).filter(|&lane| open[lane]) {
            let found: Vec<[f64; 2]> = self.found.iter().map(|each| each[lane]).collect();
            let results = &mut self.results[lane * count..(lane + 1) * count];
            asked.write_results(&found, (params, lane), results);
        }
        self.answered = open;
    }

    /// Goes through the motion.
    fn go(&mut self, of: (&Together, &Asked), walk: &mut Walk, which: (&[Each], [bool; LANES])) {
        let (together, asked) = of;
        let Survey { abreast, registers, steps, .. } = self;
        let [_, to] = asked.interval;
        steps.clear(registers.len());
        for (quantity, registers) in registers.iter_mut().enumerate() {
            asked.load(quantity, registers, which.0);
        }
        let mut solving = Solving { solver: &asked.solver, abreast, is_exact: false };
        walk.begin(together, which, asked.longest_step(), &mut solving);
        steps.take(of, walk, solving.abreast, registers);
        walk.go_to(together, to, (&mut solving, true), |walk, abreast| {
            steps.take(of, walk, abreast, registers);
        });
        if steps.times.len() > MOST_STEPS {
            walk.goes = [false; LANES];
        }
    }

    /// Finds something of those that are open, by its number; those of which it is in doubt are closed.
    fn find(
        &mut self,
        of: (&Together, &Asked),
        (loaded, params): (&[Each], &[Each]),
        number: usize,
        open: &mut [bool; LANES],
    ) {
        let (_, asked) = of;
        let (wanted, [from, to]) = (asked.wanted[number], asked.interval);
        if wanted.what == What::Integral {
            self.integrate(of, loaded, number, open);
            return;
        }
        let mut looking = Looking { number, times: [from; LANES], turns: [None; LANES] };
        let mut rest = [false; LANES];
        for lane in 0..LANES {
            let place = if open[lane] { self.place(asked, wanted, params, lane) } else { None };
            match place {
                None => open[lane] = false,
                Some(Place::End(t)) => looking.times[lane] = t,
                Some(Place::Rest) => rest[lane] = true,
                Some(Place::Turn(t)) => {
                    looking.turns[lane] = Settling::near(t, to - from, asked.knows_bends(wanted.quantity));
                    open[lane] = looking.turns[lane].is_some();
                }
            }
        }
        self.settle(of, loaded, looking, open);
        if let What::Extreme { largest } = wanted.what
            && rest.contains(&true)
        {
            self.settle_rest(of, loaded, (number, largest), rest, open);
        }
    }

    /// Finds an integral of those that are open, by its number.
    fn integrate(&mut self, of: (&Together, &Asked), loaded: &[Each], number: usize, open: &mut [bool; LANES]) {
        let asked = of.1;
        let quantity = asked.wanted[number].quantity;
        let mut integrals: Vec<SpectralIntegral> = vec![SpectralIntegral::new(asked.interval); LANES];
        let mut left = *open;
        while let Some(first) = left.iter().position(|&is_left| is_left) {
            for (k, t) in integrals[first].times() {
                let mut solved = left;
                self.solve(of, loaded, &[t; LANES], &mut solved);
                asked.look(quantity, &mut self.registers[quantity], &self.abreast);
                let [values, ..] = asked.tower(quantity, &self.registers[quantity]);
                for (lane, integral) in integrals.iter_mut().enumerate().filter(|(lane, _)| left[*lane]) {
                    integral.take(k, if solved[lane] { values.0[lane] } else { f64::NAN });
                }
            }
            let these = left;
            for lane in (0..LANES).filter(|&lane| these[lane]) {
                let Survey { steps, course, .. } = self;
                let by_steps = || {
                    steps.write_course(quantity, lane, asked.knows_bends(quantity), course);
                    integral_by_steps(&steps.times, course)
                };
                match integrals[lane].go_on(ALIKE, by_steps) {
                    Settled::On => continue,
                    Settled::Known([value, _]) => self.found[number][lane] = [f64::NAN, value],
                    Settled::Lost => open[lane] = false,
                }
                left[lane] = false;
            }
        }
    }

    /// Goes on with what rests, in some variants, and was computed at the first time: of both ends the larger value is it, or the smaller one.
    fn settle_rest(
        &mut self,
        of: (&Together, &Asked),
        loaded: &[Each],
        (number, largest): (usize, bool),
        rest: [bool; LANES],
        open: &mut [bool; LANES],
    ) {
        let begun = self.found[number];
        let [_, to] = of.1.interval;
        let mut those = from_fn(|lane| rest[lane] && open[lane]);
        self.settle(of, loaded, Looking { number, times: [to; LANES], turns: [None; LANES] }, &mut those);
        for lane in (0..LANES).filter(|&lane| rest[lane]) {
            let ([t, begun], [_, ended]) = (begun[lane], self.found[number][lane]);
            let is_other = if largest { ended > begun } else { ended < begun };
            self.found[number][lane] = [t, if is_other { ended } else { begun }];
            open[lane] = those[lane];
        }
    }

    /// Where something is of one variant; nothing where that is in doubt.
    fn place(&mut self, asked: &Asked, wanted: Wanted, params: &[Each], lane: usize) -> Option<Place> {
        let [from, to] = asked.interval;
        match wanted.what {
            What::First => Some(Place::End(from)),
            What::Last => Some(Place::End(to)),
            What::At(at) => {
                let t = asked.value(at, params, lane);
                (from <= t && t <= to).then_some(Place::End(t))
            }
            What::Integral => None,
            What::Extreme { largest } => {
                let Survey { steps, course, .. } = self;
                let (quantity, is_length) = (wanted.quantity, asked.is_length(wanted.quantity));
                let [weight, nearness] = steps.write_course(quantity, lane, asked.knows_bends(quantity), course);
                Course { times: &steps.times, towers: course, is_length, weight, nearness }.extreme(largest)
            }
        }
    }

    /// Goes on with turns until they are settled, and computes what is looked for there, and at the times of the others.
    fn settle(&mut self, of: (&Together, &Asked), loaded: &[Each], mut looking: Looking, open: &mut [bool; LANES]) {
        let quantity = of.1.wanted[looking.number].quantity;
        let mut is_left = *open;
        while is_left.contains(&true) {
            let looks = looking.turns.iter().flatten().map(Settling::looks).max().unwrap_or(1);
            let mut samples = [[Sampled::NOTHING; MOST_LOOKS]; LANES];
            for look in 0..looks {
                for (t, turn) in looking.times.iter_mut().zip(&looking.turns) {
                    *t = turn.map_or(*t, |turn| turn.time(look));
                }
                self.solve(of, loaded, &looking.times, open);
                of.1.look(quantity, &mut self.registers[quantity], &self.abreast);
                for (lane, samples) in samples.iter_mut().enumerate() {
                    samples[look] = of.1.sample(quantity, &self.registers[quantity], lane);
                }
            }
            for lane in 0..LANES {
                is_left[lane] &= open[lane];
                if is_left[lane] {
                    match looking.go_on(lane, &samples[lane][..looks]) {
                        Turning::On => {}
                        Turning::Settled(found) => {
                            self.found[looking.number][lane] = found;
                            is_left[lane] = false;
                        }
                        Turning::Lost => (open[lane], is_left[lane]) = (false, false),
                    }
                }
            }
        }
    }

    /// Solves at a time of each (s), between its steps; those of which that is in doubt are closed.
    fn solve(
        &mut self,
        (of, asked): (&Together, &Asked),
        loaded: &[Each],
        times: &[f64; LANES],
        open: &mut [bool; LANES],
    ) {
        let Survey { abreast, steps, guesses, .. } = self;
        steps.write_guesses(times, guesses);
        let guesses = Guesses {
            times: *times,
            tears: guesses,
            loaded,
            bounds: &of.bounds[1],
            parts: parts_of(open),
            nearly: 0.0,
        };
        abreast.run(&asked.solver, (&of.program, &of.scalars), &guesses);
        let mut doubts = ZERO;
        abreast.write_doubts(&mut doubts);
        for (lane, open) in open.iter_mut().enumerate() {
            // between its steps a variant is far from singular positions
            let is_near = abreast.first_corrections().0[lane] <= PART_OF_DISTANCE * NEAREST;
            *open &= doubts.0[lane] == 0.0 && is_near;
        }
    }
}
