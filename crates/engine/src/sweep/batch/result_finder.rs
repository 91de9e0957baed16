//! Finds the results of a batch: records the motion in steps, which tell where extrema are, and refines each extremum that is beyond doubt on a
//! grid of times (`analysis::Settling`), so that it has the bits that it has alone.

// loops over lane indices read best
#![allow(clippy::needless_range_loop)]

use super::context::BatchContext;
use super::result_queries::{Query, QueryKind, ResultQueries};
use super::step_history::StepHistory;
use super::stepper::{BatchStepper, LaneSolver};
use super::{LANES, NEAREST, PART_OF_DISTANCE, PerLane, ZERO, active_chunks};
use crate::analysis::course::{Course, Place, Tower, integral_by_steps};
use crate::analysis::{MOST_LOOKS, Sampled, Settled, Settling, SpectralIntegral, Turning};
use crate::solver::{VariantBatch, VariantLanes};
use mechc_text::cancel::Cancel;
use std::array::from_fn;

/// Largest difference of an integral from its estimate by the steps, as a part of it; far less than a single variant allows
/// (`ALIKE` in `spectral.rs`), so that a variant accepted here is accepted there.
const ALIKE: f64 = 1e-4;
/// Maximum number of steps.
const MOST_STEPS: usize = 4_096;

/// Finds the results of a batch.
pub(super) struct ResultFinder {
    lanes: VariantLanes<LANES>,
    /// By quantity and stage: the program's registers.
    registers: Vec<Vec<Vec<PerLane>>>,
    history: StepHistory,
    guesses: Vec<PerLane>,
    /// Value and derivatives of one quantity of one lane, by step.
    course: Vec<Tower>,
    /// By query and lane: time (s) and value.
    answers: Vec<[[f64; 2]; LANES]>,
    /// The results, lane after lane.
    results: Vec<f64>,
    /// The lanes with all results.
    pub is_complete: [bool; LANES],
}

/// The inputs of a search: what a batch shares, its queries, and by lane its parameters (SI) and the registers that depend on these alone.
#[derive(Clone, Copy)]
struct Inputs<'i> {
    context: &'i BatchContext,
    queries: &'i ResultQueries,
    params: &'i [PerLane],
    loaded: &'i [PerLane],
}

/// A query whose times are being refined.
struct Search {
    /// The query, as an index.
    query: usize,
    /// By lane: the time that is evaluated (s).
    times: [f64; LANES],
    /// By lane: the refinement of an extremum, if the answer is one.
    extrema: [Option<Settling>; LANES],
}

impl Search {
    /// Continues the refinement in a lane with the samples at its times.
    fn refine(&mut self, lane: usize, samples: &[Sampled]) -> Turning {
        let at_time = Turning::Settled([self.times[lane], samples[0].value]);
        self.extrema[lane].as_mut().map_or(at_time, |extremum| extremum.go_on(samples))
    }
}

impl ResultFinder {
    /// Creates a finder for the queries of a mechanism.
    pub fn new(context: &BatchContext, queries: &ResultQueries) -> ResultFinder {
        ResultFinder {
            lanes: context.new_lanes(&queries.solver, |_| 1),
            registers: (0..queries.quantity_count()).map(|quantity| queries.registers(quantity)).collect(),
            history: StepHistory::default(),
            guesses: vec![ZERO; context.tears.len()],
            course: Vec::new(),
            answers: vec![[[f64::NAN; 2]; LANES]; queries.queries.len()],
            results: vec![f64::NAN; LANES * queries.result_count()],
            is_complete: [false; LANES],
        }
    }

    /// Returns the results (SI) of a lane, or `None` if it is not complete.
    pub fn results(&self, lane: usize) -> Option<&[f64]> {
        let count = self.results.len() / LANES;
        self.is_complete[lane].then(|| &self.results[lane * count..(lane + 1) * count])
    }

    /// Finds the results of the `active` lanes, as far as they are beyond doubt. `params` holds all parameters (SI).
    pub fn find_all(
        &mut self,
        context: &BatchContext,
        queries: &ResultQueries,
        stepper: &mut BatchStepper,
        params: &[PerLane],
        active: [bool; LANES],
        cancel: &Cancel,
    ) {
        self.is_complete = [false; LANES];
        self.record_motion(context, queries, stepper, params, active);
        let inputs = Inputs { context, queries, params, loaded: &stepper.registers };
        let mut open = stepper.active;
        for number in 0..queries.queries.len() {
            if !open.contains(&true) || cancel.is_cancelled() {
                return;
            }
            self.answer(inputs, number, &mut open);
        }
        let count = queries.result_count();
        for lane in (0..LANES).filter(|&lane| open[lane]) {
            let answers: Vec<[f64; 2]> = self.answers.iter().map(|lanes| lanes[lane]).collect();
            let results = &mut self.results[lane * count..(lane + 1) * count];
            queries.write_results(&answers, params, lane, results);
        }
        self.is_complete = open;
    }

    /// Follows the motion of the `active` lanes and records its steps.
    fn record_motion(
        &mut self,
        context: &BatchContext,
        queries: &ResultQueries,
        stepper: &mut BatchStepper,
        params: &[PerLane],
        active: [bool; LANES],
    ) {
        let ResultFinder { lanes, registers, history, .. } = self;
        let [_, to] = queries.interval;
        history.clear(registers.len());
        for (quantity, registers) in registers.iter_mut().enumerate() {
            queries.load(quantity, registers, params);
        }
        let mut solver = LaneSolver { solver: &queries.solver, lanes, is_exact: false };
        stepper.begin(context, params, active, queries.max_step(), &mut solver);
        history.record(context, queries, stepper, solver.lanes, registers);
        stepper.advance_to(context, to, &mut solver, true, |stepper, lanes| {
            history.record(context, queries, stepper, lanes, registers);
        });
        if history.times.len() > MOST_STEPS {
            stepper.active = [false; LANES];
        }
    }

    /// Answers a query, given by its index, in the `open` lanes; closes those in which the answer is in doubt.
    fn answer(&mut self, inputs: Inputs<'_>, number: usize, open: &mut [bool; LANES]) {
        let Inputs { queries, params, .. } = inputs;
        let (query, [from, to]) = (queries.queries[number], queries.interval);
        if query.kind == QueryKind::Integral {
            self.integrate(inputs, number, open);
            return;
        }
        let mut search = Search { query: number, times: [from; LANES], extrema: [None; LANES] };
        let mut is_constant = [false; LANES];
        for lane in 0..LANES {
            let place = if open[lane] { self.locate(queries, query, params, lane) } else { None };
            match place {
                None => open[lane] = false,
                Some(Place::End(t)) => search.times[lane] = t,
                Some(Place::Rest) => is_constant[lane] = true,
                Some(Place::Turn(t)) => {
                    let has_second = queries.has_second_derivative(query.quantity);
                    search.extrema[lane] = Settling::near(t, to - from, has_second);
                    open[lane] = search.extrema[lane].is_some();
                }
            }
        }
        self.settle(inputs, search, open);
        if is_constant.contains(&true) {
            self.settle_constant(inputs, number, is_constant, open);
        }
    }

    /// Answers a query for an integral in the `open` lanes.
    fn integrate(&mut self, inputs: Inputs<'_>, number: usize, open: &mut [bool; LANES]) {
        let queries = inputs.queries;
        let quantity = queries.queries[number].quantity;
        let mut integrals: Vec<SpectralIntegral> = vec![SpectralIntegral::new(queries.interval); LANES];
        let mut left = *open;
        while let Some(first) = left.iter().position(|&is_left| is_left) {
            for (k, t) in integrals[first].times() {
                let mut solved = left;
                self.solve_at(inputs, &[t; LANES], &mut solved);
                queries.evaluate(quantity, &mut self.registers[quantity], &self.lanes);
                let [values, ..] = queries.tower(quantity, &self.registers[quantity]);
                for (lane, integral) in integrals.iter_mut().enumerate().filter(|(lane, _)| left[*lane]) {
                    integral.take(k, if solved[lane] { values.0[lane] } else { f64::NAN });
                }
            }
            let evaluated = left;
            for lane in (0..LANES).filter(|&lane| evaluated[lane]) {
                let ResultFinder { history, course, .. } = self;
                let by_steps = || {
                    history.write_course(quantity, lane, queries.has_second_derivative(quantity), course);
                    integral_by_steps(&history.times, course)
                };
                match integrals[lane].go_on(ALIKE, by_steps) {
                    Settled::On => continue,
                    Settled::Known([value, _]) => self.answers[number][lane] = [f64::NAN, value],
                    Settled::Lost => open[lane] = false,
                }
                left[lane] = false;
            }
        }
    }

    /// Evaluates constant quantities, whose values at the first time are settled, at the last time as well: the larger value of both ends is
    /// the answer, or the smaller one.
    fn settle_constant(
        &mut self,
        inputs: Inputs<'_>,
        number: usize,
        is_constant: [bool; LANES],
        open: &mut [bool; LANES],
    ) {
        let queries = inputs.queries;
        let QueryKind::Extreme { largest } = queries.queries[number].kind else { return };
        let at_first = self.answers[number];
        let [_, to] = queries.interval;
        let mut evaluated = from_fn(|lane| is_constant[lane] && open[lane]);
        let search = Search { query: number, times: [to; LANES], extrema: [None; LANES] };
        self.settle(inputs, search, &mut evaluated);
        for lane in (0..LANES).filter(|&lane| is_constant[lane]) {
            let ([t, first], [_, last]) = (at_first[lane], self.answers[number][lane]);
            let is_last = if largest { last > first } else { last < first };
            self.answers[number][lane] = [t, if is_last { last } else { first }];
            open[lane] = evaluated[lane];
        }
    }

    /// Returns where the answer of a query is in one lane, or `None` if that is in doubt.
    fn locate(&mut self, queries: &ResultQueries, query: Query, params: &[PerLane], lane: usize) -> Option<Place> {
        let [from, to] = queries.interval;
        match query.kind {
            QueryKind::First => Some(Place::End(from)),
            QueryKind::Last => Some(Place::End(to)),
            QueryKind::At(at) => {
                let t = queries.value(at, params, lane);
                (from <= t && t <= to).then_some(Place::End(t))
            }
            QueryKind::Integral => None,
            QueryKind::Extreme { largest } => {
                let ResultFinder { history, course, .. } = self;
                let (quantity, is_length) = (query.quantity, queries.is_length(query.quantity));
                let has_second = queries.has_second_derivative(quantity);
                let [weight, nearness] = history.write_course(quantity, lane, has_second, course);
                Course { times: &history.times, towers: course, is_length, weight, nearness }.extreme(largest)
            }
        }
    }

    /// Refines the extrema of a search until they are settled, and evaluates its query there, or at the given times of the other lanes.
    fn settle(&mut self, inputs: Inputs<'_>, mut search: Search, open: &mut [bool; LANES]) {
        let queries = inputs.queries;
        let quantity = queries.queries[search.query].quantity;
        let mut is_left = *open;
        while is_left.contains(&true) {
            let count = search.extrema.iter().flatten().map(Settling::looks).max().unwrap_or(1);
            let mut samples = [[Sampled::NOTHING; MOST_LOOKS]; LANES];
            for sample in 0..count {
                for (t, extremum) in search.times.iter_mut().zip(&search.extrema) {
                    *t = extremum.map_or(*t, |extremum| extremum.time(sample));
                }
                self.solve_at(inputs, &search.times, open);
                queries.evaluate(quantity, &mut self.registers[quantity], &self.lanes);
                for (lane, samples) in samples.iter_mut().enumerate() {
                    samples[sample] = queries.sample(quantity, &self.registers[quantity], lane);
                }
            }
            for lane in 0..LANES {
                is_left[lane] &= open[lane];
                if is_left[lane] {
                    match search.refine(lane, &samples[lane][..count]) {
                        Turning::On => {}
                        Turning::Settled(answer) => {
                            self.answers[search.query][lane] = answer;
                            is_left[lane] = false;
                        }
                        Turning::Lost => (open[lane], is_left[lane]) = (false, false),
                    }
                }
            }
        }
    }

    /// Solves exactly at a time of each lane (s), between its steps; closes the lanes in which the solution is rejected.
    fn solve_at(&mut self, inputs: Inputs<'_>, times: &[f64; LANES], open: &mut [bool; LANES]) {
        let Inputs { context, queries, loaded, .. } = inputs;
        let ResultFinder { lanes, history, guesses, .. } = self;
        history.write_guesses(times, guesses);
        let batch = VariantBatch {
            times: *times,
            tears: guesses,
            loaded,
            bounds: &context.bounds[1],
            chunks: active_chunks(open),
            loose_bound: 0.0,
        };
        lanes.run(&queries.solver, context.program.parts(), &batch);
        let mut rejections = ZERO;
        lanes.add_rejections(&mut rejections);
        for (lane, open) in open.iter_mut().enumerate() {
            // accepted steps are farther from singular positions than `NEAREST`, and so is the motion between them
            let is_near_guess = lanes.first_corrections().0[lane] <= PART_OF_DISTANCE * NEAREST;
            *open &= rejections.0[lane] == 0.0 && is_near_guess;
        }
    }
}
