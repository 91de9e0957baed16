//! What variants share that go side by side, a lane for each: those of a mechanism whose equations are smooth everywhere, as far as no singular
//! position is near. What is not plain is left to the careful way, which knows all cases.

use super::Base;
use super::asked::Asked;
use super::each::{Each, LANES, PART, ZERO};
use super::judge::{Known, Stand, Tracked, nearness};
use crate::analysis::{Started, Times};
use crate::solver::{Abreast, Guesses, Solver};
use mechc_expr::math::Vectors;
use mechc_ir::CoordinateKind;
use mechc_ir::program::{LaneMachine, LaneValues, Op, Program, Register, Registers, Stage};
use mechc_ir::tolerances::solving::variants::{
    BESIDE, CERTAIN_RESIDUAL, DENSE_MOTION, DENSE_PART_OF_SPAN, NEARLY, RESIDUAL_OF_STEP,
};
use std::sync::Arc;

/// What variants share that go side by side.
pub struct Together {
    pub(super) program: Arc<Program>,
    /// The program's registers with the mechanism's own values.
    pub(super) scalars: Registers,
    /// The operations of parameters alone that solving needs.
    prologue: Vec<Op>,
    /// The mechanism's own values, and the parameters that may have others, by their numbers.
    pub(super) own: Vec<f64>,
    led: Vec<u32>,
    /// For steps between output times.
    pub(super) steps: Solver,
    /// The rows that are wanted; none where nobody asks for any.
    pub(super) rows: Option<Rows>,
    /// What results ask; none where there are none, or where they had better be found alone.
    pub(super) asked: Option<Asked>,
    /// The coordinates that steps are judged by, and what is known of each.
    pub(super) known: Known,
    pub(super) tracked: Vec<Tracked>,
    /// By tear: its place among these.
    pub(super) tears: Vec<usize>,
    /// By row of `Φ`: one over what may be left of it, in steps and in rows.
    pub(super) bounds: [Vec<f64>; 2],
    /// Where it stands with its own values: the coordinates that steps are judged by, and by turn of the solver one over each determinant.
    q: Vec<f64>,
    determinants: Vec<f64>,
    /// By parameter that may have other values: how each tear changes with it there.
    slopes: Vec<Vec<f64>>,
    /// What makes a smallest pivot the nearness to a singular position.
    pub(super) nearness: f64,
    /// That where it stands with its own values.
    own_nearness: f64,
    /// The first time (s).
    pub(super) from: f64,
    pub(super) vectors: Vectors,
}

/// Rows that are wanted.
pub(super) struct Rows {
    pub solver: Solver,
    pub times: Times,
    /// The columns.
    pub wanted: Vec<u32>,
    /// By column but the times: whether it is the same for all variants.
    pub is_alike: Vec<bool>,
}

impl Rows {
    /// Of some times, with some columns beside those that steps are judged by.
    fn of(
        started: &mut Started,
        (times, columns): (&Times, Option<&[usize]>),
        is_tracked: &dyn Fn(u32) -> bool,
        differs: &dyn Fn(Register) -> bool,
    ) -> Option<Rows> {
        let wanted: Vec<u32> = columns.unwrap_or_default().iter().map(|&column| column as u32).collect();
        let solver = started.solver_of_variants(&|column| is_tracked(column) || wanted.contains(&column))?;
        let is_alike = solver.alike(differs);
        Some(Rows { solver, times: times.clone(), wanted, is_alike })
    }
}

/// What is wanted of variants.
pub struct WantedOfEach<'w> {
    /// The times of rows, and their columns; nothing where results alone are wanted.
    pub rows: (&'w Times, Option<&'w [usize]>),
    /// Whether there are results.
    pub results: bool,
}

impl Together {
    /// Of a mechanism that stands with its own values, for variants of some of its params, by their numbers, of which something is wanted; nothing
    /// where they had better go alone.
    #[must_use]
    pub fn of(
        base: &Base,
        started: &Started,
        params: &[u32],
        wanted: &WantedOfEach<'_>,
        vectors: Vectors,
    ) -> Option<Together> {
        let mut started = started.clone();
        let (times, columns) = wanted.rows;
        if times.is_empty() || !started.is_plain() || !base.leads_plainly(params) {
            return None;
        }
        let ((determined, program), own) = base.stands();
        let judged = judged(&started);
        let tracked = tracked(&started, &judged)?;
        let known = known(&mut started, wanted, &judged);
        let is_tracked = |column: u32| tracked.iter().any(|of| of.columns[..known.orders()].contains(&column));
        let asked =
            if wanted.results { Asked::of(determined, &mut started, times, (&is_tracked, vectors)) } else { None };
        // who has all results has got through the motion
        let rows = if columns.is_none() && asked.is_some() {
            None
        } else {
            let differs = differing(program, params);
            Some(Rows::of(&mut started, wanted.rows, &is_tracked, &|register| differs[register as usize])?)
        };
        let steps = started.solver_of_variants(&is_tracked)?;
        let tears = steps.tears().iter().map(|&tear| judged.iter().position(|&k| k == tear as usize));
        let tears = tears.collect::<Option<Vec<usize>>>()?;
        let solvers = [Some(&steps), rows.as_ref().map(|rows| &rows.solver), asked.as_ref().map(|asked| &asked.solver)];
        let loaded: Vec<Register> = solvers.into_iter().flatten().flat_map(Solver::loads).collect();
        let bounds = started.bounds();
        let per_bound = |part: f64| bounds.iter().map(|bound| 1.0 / (part * bound)).collect();
        let mut together = Together {
            prologue: prologue(program, &loaded),
            program: Arc::clone(program),
            scalars: program.start(own),
            own: own.to_vec(),
            led: params.to_vec(),
            steps,
            rows,
            asked,
            known,
            tracked,
            tears,
            bounds: [RESIDUAL_OF_STEP, CERTAIN_RESIDUAL].map(per_bound),
            q: judged.iter().map(|&k| started.q()[k]).collect(),
            determinants: Vec::new(),
            slopes: Vec::new(),
            nearness: 1.0,
            own_nearness: 1.0,
            from: times.from(),
            vectors,
        };
        together.look_at_own(&mut started)?;
        Some(together)
    }

    /// Learns what the solver's pivots tell of nearness to a singular position where it stands with its own values, and how it moves with
    /// parameters there.
    fn look_at_own(&mut self, started: &mut Started) -> Option<()> {
        let (mut abreast, mut loaded) = (self.abreast(&self.steps, |_| 1), self.registers());
        let own: Vec<Each> = self.own.iter().map(|&value| LaneValues([value; LANES])).collect();
        self.solve(&mut abreast, &mut loaded, &own)?;
        self.determinants = abreast.determinants().iter().map(|of| of.0[0]).collect();
        // pivots of rows of unit norm say little more than it is
        self.nearness = f64::min(1.0, started.conditioning() * abreast.steepest().0[0].max(1.0));
        self.own_nearness = nearness(self.nearness, abreast.steepest().0[0]);
        let place = |abreast: &Abreast<LANES>, tear: usize| abreast.column(self.tracked[tear].columns[0]).0[0];
        let here: Vec<f64> = self.tears.iter().map(|&tear| place(&abreast, tear)).collect();
        let mut slopes = Vec::with_capacity(self.led.len());
        for &param in &self.led {
            let (mut beside, own_value) = (own.clone(), self.own[param as usize]);
            let value = if own_value == 0.0 { BESIDE } else { own_value * (1.0 + BESIDE) };
            beside[param as usize].0 = [value; LANES];
            let is_solved = self.solve(&mut abreast, &mut loaded, &beside).is_some();
            let slope = |(&tear, here): (&usize, &f64)| (place(&abreast, tear) - here) / (value - own_value);
            // only a guess is made of it
            let known = |slope: f64| if is_solved && slope.is_finite() { slope } else { 0.0 };
            slopes.push(self.tears.iter().zip(&here).map(slope).map(known).collect());
        }
        self.slopes = slopes;
        Some(())
    }

    /// Solves beside where it stands with its own values, with others; nothing where that does not hold.
    fn solve(&self, abreast: &mut Abreast<LANES>, loaded: &mut [Each], params: &[Each]) -> Option<()> {
        self.load(loaded, params, 1);
        abreast.load(&self.steps, (&self.program, &self.scalars), loaded, 1);
        let tears: Vec<Each> = self.tears.iter().map(|&tear| LaneValues([self.q[tear]; LANES])).collect();
        let [bounds, _] = &self.bounds;
        let guesses = Guesses { times: [self.from; LANES], tears: &tears, loaded, bounds, parts: 1, nearly: NEARLY };
        abreast.run(&self.steps, (&self.program, &self.scalars), &guesses);
        let mut doubts = ZERO;
        abreast.write_doubts(&mut doubts);
        (doubts.0[0] == 0.0).then_some(())
    }

    /// Where all variants come from.
    pub(super) fn stand(&self) -> Box<Stand> {
        Box::new(Stand::of(self.from, &self.q, &self.determinants, self.own_nearness))
    }

    /// Where tears are, by how they change with parameters where it stands with its own values.
    pub(super) fn write_first_guesses(&self, params: &[Each], guesses: &mut [Each]) {
        for (place, (guess, &tear)) in guesses.iter_mut().zip(&self.tears).enumerate() {
            guess.0 = [self.q[tear]; LANES];
            for (&param, slopes) in self.led.iter().zip(&self.slopes) {
                let (own, values) = (self.own[param as usize], &params[param as usize].0);
                guess.0.iter_mut().zip(values).for_each(|(guess, value)| *guess += slopes[place] * (value - own));
            }
        }
    }

    /// How many rows each variant has.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.as_ref().map_or(0, |rows| rows.times.len() as usize)
    }

    /// Registers for one of its solvers, which keeps so many rows of a column that it leaves something in.
    pub(super) fn abreast(&self, solver: &Solver, rows: impl Fn(u32) -> u32) -> Abreast<LANES> {
        let is_kept = solver.keeps();
        Abreast::new(solver, |column| if is_kept(column) { rows(column) } else { 0 }, self.vectors)
    }

    /// The program's registers, a lane for each variant.
    pub(super) fn registers(&self) -> Vec<Each> {
        let mut registers = vec![LaneValues([0.0; LANES]); self.program.registers()];
        for &(register, value) in self.program.constants() {
            registers[register as usize].0 = [value; LANES];
        }
        registers
    }

    /// Computes what depends on parameters alone, of so many parts of the lanes.
    pub(super) fn load(&self, registers: &mut [Each], params: &[Each], parts: usize) {
        let first = self.program.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        let mut machine = LaneMachine::<LANES, PART>::new(registers, parts, (&self.program, &self.scalars));
        self.prologue.iter().for_each(|op| op.run(&mut machine));
    }
}

/// The coordinates that steps are judged by: all angles, and what Newton solves for.
fn judged(started: &Started) -> Vec<usize> {
    let coordinates = started.system().coordinates();
    let is_tear = |k: usize| started.solver().is_some_and(|solver| solver.tears().contains(&(k as u32)));
    let is_judged = |&k: &usize| is_tear(k) || coordinates[k].kind != CoordinateKind::Length;
    (0..coordinates.len()).filter(is_judged).collect()
}

/// What of these is known at each step: what is cheapest, where nothing but near rows is wanted.
fn known(started: &mut Started, wanted: &WantedOfEach<'_>, judged: &[usize]) -> Known {
    let (times, columns) = (wanted.rows.0, wanted.rows.1.unwrap_or_default());
    let apart = times.widest_gap();
    if wanted.results || columns.is_empty() || apart > DENSE_PART_OF_SPAN * times.span() {
        return Known::Accelerations;
    }
    // asked last: it takes a factoring
    let Some(velocities) = started.velocities() else { return Known::Accelerations };
    let coordinates = started.system().coordinates();
    let fastest = judged.iter().map(|&k| velocities[k].abs() / coordinates[k].scale).fold(0.0, f64::max);
    if apart * fastest <= DENSE_MOTION { Known::Velocities } else { Known::Accelerations }
}

/// The same with their columns.
fn tracked(started: &Started, judged: &[usize]) -> Option<Vec<Tracked>> {
    let layout = *started.solver()?.layout();
    let tracked = |&k: &usize| Tracked {
        columns: [0, 1, 2].map(|order| layout.coordinate(k as u32, order)),
        per_scale: 1.0 / started.system().coordinates()[k].scale,
    };
    Some(judged.iter().map(tracked).collect())
}

/// By register: whether it depends on some parameters, by their numbers, before any time is known.
fn differing(program: &Program, params: &[u32]) -> Vec<bool> {
    let mut differs = vec![false; program.registers()];
    for param in params {
        differs[(program.inputs.params + param) as usize] = true;
    }
    for &op in program.stage(Stage::Prologue) {
        let is_one = program.reads(op).any(|register| differs[register as usize]);
        op.writes().iter().for_each(|&to| differs[to as usize] |= is_one);
    }
    differs
}

/// The operations of parameters alone that lead to some registers.
fn prologue(program: &Program, wanted: &[Register]) -> Vec<Op> {
    let mut is_read = vec![false; program.registers()];
    for &register in wanted {
        is_read[register as usize] = true;
    }
    let mut kept = Vec::new();
    for &op in program.stage(Stage::Prologue).iter().rev() {
        if op.writes().iter().any(|&to| is_read[to as usize]) {
            program.reads(op).for_each(|register| is_read[register as usize] = true);
            kept.push(op);
        }
    }
    kept.reverse();
    kept
}
