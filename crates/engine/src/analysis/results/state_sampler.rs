//! States within a segment of the motion, solved for on request.

use super::NUMBERS;
use super::sensitivities::Sensitivities;
use crate::analysis::follow::{SelectedRows, SingleRow, SmoothSegment, quintic_between, state_of_row};
use crate::analysis::state::{Kinematics, State};
use crate::solver::{Batch, Solver};
use mechc_expr::math::along;
use mechc_ir::program::{Ranges, Register, Stage};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Maximum number of corrections of a position, where the solver cannot be used.
const ITERATIONS: usize = 10;
/// Fraction of a step at which its dense output is verified; no symmetry of the motion maps it to the middle. The output is rejected if
/// a moving quantity deviates by more than `LITTLE` of itself, and by more than a parabola could.
const WITHIN: f64 = 0.381_966;
/// Largest deviation of a state from the dense output of its step, as a part of its size.
const LITTLE: f64 = 1e-9;
/// A position closer to a singular one than this is taken from the bridge across it.
const SOLVABLE: f64 = 4e-3;

/// A solver of states between the ends of segments.
pub(super) struct StateSampler {
    kinematics: Kinematics,
    /// The selected equations, if they differ from those at the start.
    chosen: Option<Arc<SelectedRows>>,
    /// The equations at the start, with their solver.
    first: (Kinematics, Option<Arc<Solver>>),
    solver: Option<(Arc<Solver>, SingleRow)>,
    curve: Vec<[f64; 6]>,
    delta: Vec<f64>,
    /// The reciprocal of the allowed residual of each row of Φ in the segment, if `has_bounds`.
    bounds: Vec<f64>,
    /// True if `bounds` belongs to the segment that was entered last.
    has_bounds: bool,
    /// The first and the last time (s) of the bridge over a singular position, if the segment is one.
    bridge: [f64; 2],
    /// The terms of the equations that depend on time alone.
    signals: Ranges,
    signal_count: usize,
    /// True if the equations are smooth everywhere, so that [`StateSampler::settled`] is available.
    pub is_plain: bool,
    /// The derivatives by inputs and parameters, if results need any.
    sensitivities: Option<Sensitivities>,
    /// The start (s) of the segment.
    start: f64,
    /// The solved states by the start of their segment and by time: several formulas request the same ones.
    solved: FxHashMap<[u64; 2], Solved>,
    /// The key of the state whose multipliers were computed last; `None` if `kinematics` holds them.
    with_multipliers: Option<[u64; 2]>,
}

/// A solved state, with its multipliers once they have been requested.
struct Solved {
    state: State,
    multipliers: Vec<f64>,
}

impl StateSampler {
    pub fn new(kinematics: Kinematics, solver: Option<Arc<Solver>>) -> StateSampler {
        let n = kinematics.system().coordinates().len();
        let registers: Vec<Register> = kinematics.signals().iter().map(|signal| signal.register).collect();
        let (program, values) = kinematics.program();
        let signals = Ranges::new(program, values, &registers, Stage::Time, true);
        let first = (kinematics.clone(), solver.clone());
        let solver = solver.map(|solver| (Arc::clone(&solver), SingleRow::new(&kinematics, &solver)));
        StateSampler {
            curve: vec![[0.0; 6]; n],
            delta: vec![0.0; n],
            bounds: vec![0.0; kinematics.system().rows().len()],
            has_bounds: false,
            bridge: [f64::NAN; 2],
            signals,
            signal_count: registers.len(),
            solver,
            is_plain: kinematics.is_plain(),
            sensitivities: Sensitivities::from_motion(&kinematics),
            chosen: None,
            first,
            start: f64::NAN,
            solved: FxHashMap::default(),
            with_multipliers: None,
            kinematics,
        }
    }

    /// Returns the number of variations that formulas may use.
    pub fn variations(&self) -> usize {
        self.sensitivities.as_ref().map_or(0, Sensitivities::count)
    }

    /// Enters a segment: the states that follow belong to it.
    pub fn enter(&mut self, segment: &SmoothSegment) {
        self.change_equations(segment);
        self.kinematics.freeze(true, true);
        self.kinematics.set_switches(&segment.switches);
        self.has_bounds = false;
        self.start = segment.from.t;
        self.bridge = segment.bridge.as_ref().map_or([f64::NAN; 2], |bridge| [bridge.from.t, bridge.to.t]);
        self.set_variation_switches(&segment.switches);
    }

    /// Switches to the equations of a segment.
    fn change_equations(&mut self, segment: &SmoothSegment) {
        let is_same = match (&self.chosen, &segment.chosen) {
            (Some(local), Some(other)) => Arc::ptr_eq(local, other),
            (None, None) => true,
            _ => false,
        };
        if is_same {
            return;
        }
        let (first, solver) = self.first.clone();
        let other = match &segment.chosen {
            Some(chosen) => {
                let mut kinematics = chosen.kinematics(&first);
                kinematics.restore(&segment.from);
                kinematics.choose_orders();
                StateSampler::new(kinematics, chosen.solver.clone())
            }
            None => StateSampler::new(first.clone(), solver.clone()),
        };
        *self = StateSampler { chosen: segment.chosen.clone(), first: (first, solver), ..other };
    }

    /// Sets the results of the equations' switches for variations only.
    pub fn set_variation_switches(&mut self, switches: &[f64]) {
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.set_switches(switches);
        }
    }

    /// Returns whether a time (s) lies on the segment's bridge over a singular position.
    pub fn is_on_bridge(&self, t: f64) -> bool {
        let [from, to] = self.bridge;
        from <= t && t <= to
    }

    /// Solves for the variations at a state of the segment.
    pub fn vary(&mut self, state: &State) {
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.solve_at(state);
        }
    }

    /// Computes the multipliers at a state of the segment.
    pub fn find_multipliers(&mut self, state: &State) {
        let key = self.key(state.t);
        let cached = self.solved.get_mut(&key).filter(|solved| solved.state == *state);
        self.with_multipliers = cached.is_some().then_some(key);
        if cached.as_ref().is_none_or(|solved| solved.multipliers.is_empty()) {
            self.kinematics.vary_at(state);
        }
        if let Some(solved) = cached.filter(|solved| solved.multipliers.is_empty()) {
            let rows = 0..self.kinematics.system().rows().len();
            solved.multipliers = rows.map(|row| self.kinematics.multiplier(row)).collect();
        }
    }

    /// Returns the multiplier of a row of the equations at the start, after [`StateSampler::find_multipliers`]; 0 for a row that is left out.
    pub fn multiplier(&self, row: usize) -> f64 {
        let cached = self.with_multipliers.and_then(|key| self.solved.get(&key));
        let of = |row: usize| cached.map_or_else(|| self.kinematics.multiplier(row), |cached| cached.multipliers[row]);
        self.row(row).map_or(0.0, of)
    }

    fn key(&self, t: f64) -> [u64; 2] {
        [self.start, t].map(f64::to_bits)
    }

    /// Returns the row of the selected equations for a row of those at the start, or `None` if it is left out.
    fn row(&self, row: usize) -> Option<usize> {
        let first = self.first.0.determined();
        self.chosen.as_ref().map_or(Some(row), |chosen| chosen.row_in_place_of(row, &first))
    }

    /// Returns the derivative of the multiplier of a row in a variation that has been solved for.
    pub fn varied_multiplier(&self, number: u32, row: usize) -> f64 {
        let of = |sensitivities: &Sensitivities| {
            self.row(row).map_or(0.0, |row| sensitivities.varied_multiplier(number, row))
        };
        self.sensitivities.as_ref().map_or(f64::NAN, of)
    }

    /// Returns the derivatives of a coordinate, its velocity and its acceleration in a variation that has been solved for.
    pub fn variation(&self, number: u32, coordinate: usize) -> [f64; 3] {
        self.sensitivities.as_ref().map_or([f64::NAN; 3], |sensitivities| sensitivities.variation(number, coordinate))
    }

    /// Returns whether the terms that depend on time alone change so little between two times (s) that the states there determine the motion.
    pub fn signals_are_resolved(&mut self, times: [f64; 2]) -> bool {
        self.signals.set_times(times);
        let (program, registers) = self.kinematics.program();
        (0..self.signal_count).all(|k| self.signals.range(program, registers, k).is_resolved)
    }

    /// Returns whether the equations have terms that depend on time alone, other than linear ones.
    pub fn has_signals(&self) -> bool {
        self.signal_count > 0
    }

    /// Returns a state within a segment if it differs from the dense output between both ends, or else `None`.
    pub fn deviating_state(&mut self, segment: &SmoothSegment) -> Option<State> {
        let SmoothSegment { from, to, bridge: None, .. } = segment else { return None };
        let h = to.t - from.t;
        self.enter(segment);
        let within = self.solve(segment, [from, to], from.t + WITHIN * h)?;
        let x = (within.t - from.t) / h;
        let deviates = |k: usize| {
            let (a, b) = (from.tower(k), to.tower(k));
            let error = |order: usize| ((b[order - 1] - a[order - 1]) / h - 0.5 * (a[order] + b[order])).abs();
            // a coordinate at rest at zero is as accurate as one of the usual size
            let size = self.kinematics.system().coordinates()[k].scale.max(a[0].abs()).max(b[0].abs());
            let allowed = h * h * error(2) + LITTLE * size;
            (within.q[k] - along(&quintic_between(from, to, k, h), x)).abs() > allowed
        };
        (0..within.q.len()).any(deviates).then_some(within)
    }

    /// Returns the state at a time (s) between two states of a segment, or `None` if it cannot be solved for.
    pub fn solve(&mut self, segment: &SmoothSegment, [a, b]: [&State; 2], t: f64) -> Option<State> {
        if let Some(bridge) = segment.bridge.as_ref().filter(|bridge| t > bridge.from.t) {
            let on_bridge = bridge.best_state_at(t);
            return self.solve_from(on_bridge.clone(), Some(SOLVABLE)).or(Some(on_bridge));
        }
        if let Some(state) = self.solve_exactly(segment, [a, b], t) {
            return Some(state);
        }
        let h = b.t - a.t;
        let mut state = a.clone();
        state.t = t;
        for (q, curve) in state.q.iter_mut().zip(&self.curve) {
            *q = along(curve, (t - a.t) / h);
        }
        self.solve_from(state, None)
    }

    /// Returns the state at a time (s) between two states of a segment with exactly the bits of a row, or `None` if the solver of rows fails.
    pub fn solve_exactly(&mut self, segment: &SmoothSegment, [a, b]: [&State; 2], t: f64) -> Option<State> {
        let key = self.key(t);
        if let Some(cached) = self.solved.get(&key) {
            return Some(cached.state.clone());
        }
        let h = b.t - a.t;
        for (k, curve) in self.curve.iter_mut().enumerate() {
            *curve = quintic_between(a, b, k, h);
        }
        let state = self.solve_row(segment, a, t, h)?;
        if self.solved.len() * (1 + state.q.len()) > NUMBERS {
            self.solved.clear();
        }
        self.solved.insert(key, Solved { state: state.clone(), multipliers: Vec::new() });
        Some(state)
    }

    /// Returns the state at a time (s) close to that of a state of the segment, with bits that depend on the time only and not on that state, as
    /// those of rows do. Returns `None` if the equations are not smooth everywhere, on a bridge, or if the solver of rows fails.
    pub fn settled(&mut self, segment: &SmoothSegment, near: &State, t: f64) -> Option<State> {
        if !self.is_plain || segment.bridge.is_some() {
            return None;
        }
        // the curve is a parabola, so that its length is arbitrary
        let h = 1.0;
        for (k, curve) in self.curve.iter_mut().enumerate() {
            *curve = [near.q[k], near.qd[k] * h, 0.5 * near.qdd[k] * h * h, 0.0, 0.0, 0.0];
        }
        self.solve_row(segment, near, t, h)
    }

    /// Solves for the state at a time (s) of the segment as rows do, from `curve`, which begins at a state and has the length `h` (s). Returns
    /// `None` if the equations do not hold there.
    fn solve_row(&mut self, segment: &SmoothSegment, from: &State, t: f64, h: f64) -> Option<State> {
        if !self.has_bounds {
            self.kinematics.restore(&segment.from);
            self.kinematics.write_bounds(&mut self.bounds);
            self.has_bounds = true;
        }
        let (solver, single) = self.solver.as_mut()?;
        let batch = Batch { times: [t], from: from.t, length: h, curve: &self.curve, bends: &[], bounds: &self.bounds };
        let holds = single.solve(&self.kinematics, solver, &batch);
        let layout = solver.layout();
        let is_finite = layout.position(single.row()).iter().all(|x| x.is_finite());
        (holds && is_finite).then(|| state_of_row(layout, single.row(), from, t))
    }

    /// Solves for a state by Newton's method from a position. Returns `None` if it does not converge, or if the nearness to a singular position is
    /// below the limit.
    fn solve_from(&mut self, mut state: State, limit: Option<f64>) -> Option<State> {
        self.kinematics.set_time(state.t);
        self.kinematics.set_position(&state.q).ok()?;
        for _ in 0..ITERATIONS {
            self.kinematics.factor().ok()?;
            if limit.is_some_and(|limit| self.kinematics.nearness(limit) < limit) {
                return None;
            }
            self.kinematics.correction(&mut self.delta);
            for (q, delta) in state.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            self.kinematics.set_position(&state.q).ok()?;
            if self.kinematics.violated().is_none() {
                self.kinematics.factor().ok()?;
                self.kinematics.derivatives(&mut state).ok()?;
                return Some(state);
            }
        }
        None
    }
}
