//! Everything that can be said of one state: residual, correction, velocity, acceleration.

use super::aslant;
use super::linear::{BlockLu, Factored, Singular};
use super::scoped::ScopedLu;
use super::yardstick::is_looked_at_beside;
use crate::cancel::Cancel;
use crate::expr::ExprId;
use crate::ir::{ConstraintSystem, DeclarationKind, Owner, WatchKind};
use crate::layout::{self, Holds};
use crate::program::{Enclosure, Frozen, Op, Program, Register, Registers, Rim, Signal, Stage, Switch};
use crate::solver::{Equations, Pivoting, Solver, Values};
use crate::structure::Determined;
use crate::tolerances::checks::LARGEST_OPENING;
use crate::tolerances::scales::kinematics::{BESIDE, ROUNDING, TRUSTED};
use std::sync::Arc;

/// A time with the coordinates and their derivatives.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// (s)
    pub t: f64,
    /// [m, rad]
    pub q: Vec<f64>,
    /// [m/s, rad/s]
    pub qd: Vec<f64>,
    /// [m/s², rad/s²]
    pub qdd: Vec<f64>,
    /// [m/s³, rad/s³]; zero where no measure needs it.
    pub qddd: Vec<f64>,
}

impl State {
    pub fn new(t: f64, q: Vec<f64>) -> State {
        let zero = vec![0.0; q.len()];
        State { t, q, qd: zero.clone(), qdd: zero.clone(), qddd: zero }
    }

    /// Takes over another state without allocating.
    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        self.q.copy_from_slice(&other.q);
        self.qd.copy_from_slice(&other.qd);
        self.qdd.copy_from_slice(&other.qdd);
        self.qddd.copy_from_slice(&other.qddd);
    }
}

/// Why a state cannot be computed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Fault {
    /// An entry of Φ, Φ_q or a right side is not finite: its row.
    NotFinite { row: usize },
    /// Φ_q is singular, or nearer to it than can be trusted.
    Singular,
    /// Newton does not arrive, or asks for more than the predictor allows.
    TooFar,
    /// A formula that must be positive is not: its number.
    Condition { index: usize },
    /// What is watched changes its sign: its number.
    Watch { index: usize },
    /// An equation that was left out ceases to hold: its number among the checks.
    Check { index: usize },
    /// Derivatives would be more rounding than digits.
    Uncertain,
    /// The step goes over a rim, of which a note has been taken.
    Rim,
    /// The step goes over an edge of a switch, by its number, which lies before a time (s).
    Edge { t: f64, switch: usize },
}

/// A mechanism's program with its registers and factors.
#[derive(Clone)]
pub(super) struct Kinematics {
    determined: Arc<Determined>,
    program: Arc<Program>,
    registers: Registers,
    linear: BlockLu,
    span: f64,
    tolerance: f64,
    cancel: Cancel,
    /// Rows whose slope may vanish though nothing about the mechanism does, as that of `sin(angle(b))`.
    bent: Vec<usize>,
    /// Rows whose slopes are looked at beside a position, these among them.
    looked_at_beside: Vec<usize>,
    beside: Vec<f64>,
    doubt: Doubt,
    /// Where assembly begins, if not where the file says.
    other_estimates: Option<Vec<f64>>,
    variations: Varied,
    /// What the columns of a row hold.
    holds: Vec<Holds>,
}

/// What is needed for derivatives by inputs and parameters.
#[derive(Clone)]
struct Varied {
    /// A variation of all coordinates.
    solution: Vec<f64>,
    /// By column of a row, whether it is such a derivative.
    columns: Vec<bool>,
    /// Those by the equations of a part alone.
    scoped: ScopedLu,
}

impl Varied {
    fn new(system: &ConstraintSystem, holds: &[Holds]) -> Varied {
        let scoped = ScopedLu::new(system);
        if system.variations.is_none() {
            return Varied { solution: Vec::new(), columns: Vec::new(), scoped };
        }
        let n = system.coordinates.len();
        let is_varied = |id: ExprId| system.graph.dependence(id).highest_varied_order().is_some();
        let is_varied_column = |holds: &Holds| match *holds {
            Holds::Time | Holds::Coordinate { .. } => false,
            Holds::Measure { index, order } => system.measures[index].derivative(order).is_some_and(is_varied),
            Holds::Appended(_) => true,
        };
        Varied { solution: vec![0.0; n], columns: holds.iter().map(is_varied_column).collect(), scoped }
    }
}

/// What rounding makes of a state: by coordinate how far off its position, velocity and acceleration may be.
#[derive(Clone, Default)]
struct Doubt {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    /// By row.
    right: Vec<f64>,
}

impl Doubt {
    fn new(n: usize) -> Doubt {
        let zero = vec![0.0; n];
        Doubt { position: zero.clone(), velocity: zero.clone(), acceleration: zero.clone(), right: zero }
    }
}

impl Kinematics {
    /// Of a mechanism that is looked at for so long (s).
    pub fn new(
        determined: Arc<Determined>,
        program: Arc<Program>,
        span: f64,
        tolerance: f64,
        cancel: Cancel,
    ) -> Kinematics {
        let system = determined.system();
        let params: Vec<f64> = system.params.iter().map(|param| param.value).collect();
        let (registers, linear) = (program.start(&params), BlockLu::new(system, determined.blocks()));
        let bent = (0..system.rows.len()).filter(|&row| is_bent(system, row)).collect();
        let looked_at_beside = (0..system.rows.len()).filter(|&row| is_looked_at_beside(system, row)).collect();
        let n = system.coordinates.len();
        let other_estimates = None;
        let holds = layout::holds(system);
        let (beside, doubt, variations) = (vec![0.0; n], Doubt::new(n), Varied::new(system, &holds));
        Kinematics {
            determined,
            program,
            registers,
            linear,
            span,
            tolerance,
            cancel,
            bent,
            looked_at_beside,
            beside,
            doubt,
            other_estimates,
            variations,
            holds,
        }
    }

    /// Measures the slopes at a position, at the time that was set, by which nearness to a singular position is judged. Those of
    /// some rows are looked at on both sides of it, too: a slope counts for no less than the lesser of these, so that one that
    /// vanishes in between makes a singular position, and one that grows beside a pole does not. Rows that are bent are scaled
    /// by that as well. The position must be set anew.
    pub fn measure_slopes(&mut self, q: &[f64]) {
        if self.linear.yardstick().is_measured() && !self.linear.yardstick().changes() {
            return;
        }
        if !self.looked_at_beside.is_empty() {
            self.look_beside(q);
        }
        self.evaluate(q);
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        let coordinate = |column: usize| registers.get(self.program.inputs.coordinates[0] + column as u32);
        let yardstick = self.linear.yardstick();
        yardstick.turn(coordinate);
        yardstick.measure(|position| registers.get(outputs.phi_q[position]));
    }

    fn look_beside(&mut self, q: &[f64]) {
        let determined = self.determined();
        let pattern = &determined.system().phi_q;
        // where a formula has no value it has no slope
        let lesser = |known: f64, found: f64| if found.is_finite() { f64::min(known, found) } else { known };
        let or_none = |least: f64| if least.is_finite() { least } else { 0.0 };
        for way in [BESIDE, -BESIDE] {
            for (column, beside) in self.beside.iter_mut().enumerate() {
                *beside = q[column] + way * aslant(column) * self.linear.column_scale(column);
            }
            self.registers.set_all(self.program.inputs.coordinates[0], &self.beside);
            self.program.run(Stage::Position, &mut self.registers);
            let is_first = way > 0.0;
            for index in 0..self.looked_at_beside.len() {
                for position in pattern.range(self.looked_at_beside[index]) {
                    let found = self.phi_q(position).abs();
                    let slope = self.linear.yardstick().beside(position);
                    *slope = lesser(if is_first { f64::INFINITY } else { *slope }, found);
                    *slope = if is_first { *slope } else { or_none(*slope) };
                }
            }
            for index in 0..self.bent.len() {
                let row = self.bent[index];
                let known = if is_first { f64::INFINITY } else { self.linear.least_norm(row) };
                let least = lesser(known, self.slope(row));
                self.linear.set_least_norm(row, if is_first { least } else { or_none(least) });
            }
        }
    }

    fn evaluate(&mut self, q: &[f64]) {
        self.registers.set_all(self.program.inputs.coordinates[0], q);
        self.program.run(Stage::Position, &mut self.registers);
    }

    /// The norm of a row of the scaled Φ_q where the position was set.
    fn slope(&self, row: usize) -> f64 {
        let pattern = &self.system().phi_q;
        let scaled = pattern
            .range(row)
            .zip(pattern.row(row))
            .map(|(position, &(column, _))| self.phi_q(position) * self.linear.column_scale(column as usize));
        scaled.map(|x| x * x).sum::<f64>().sqrt()
    }

    pub fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// For how long the mechanism is looked at (s).
    pub fn span(&self) -> f64 {
        self.span
    }

    /// Whether nobody waits for the result any more.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// The mechanism, to be held while the state changes.
    pub fn determined(&self) -> Arc<Determined> {
        Arc::clone(&self.determined)
    }

    pub fn linear(&self) -> &BlockLu {
        &self.linear
    }

    /// The estimates of the file [m, rad].
    pub fn estimates(&self) -> Vec<f64> {
        let of_file = || self.program.outputs.estimates.iter().map(|&register| self.registers.get(register)).collect();
        self.other_estimates.clone().unwrap_or_else(of_file)
    }

    /// Takes other estimates than those of the file.
    pub fn begin_from(&mut self, estimates: &[f64]) {
        self.other_estimates = Some(estimates.to_vec());
    }

    /// Which switches stay as they are from now on.
    pub fn freeze(&mut self, time: bool, motion: bool) {
        self.registers.freeze(Frozen { time, motion });
    }

    /// Sets the switches of time to what they are at a time, and keeps them so.
    pub fn settle_time(&mut self, t: f64) {
        self.freeze(false, true);
        self.set_time(t);
        self.freeze(true, true);
    }

    /// Sets the switches of the motion to what they are at a position, and keeps them so.
    pub fn settle_motion(&mut self, q: &[f64]) {
        self.freeze(true, false);
        // what is wrong with the position itself shows where it is solved for
        let _ = self.set_position(q);
        self.freeze(true, true);
    }

    /// Where the equations may have edges.
    pub fn switches(&self) -> &[Switch] {
        self.program.switches()
    }

    /// The result that a switch has now.
    pub fn switch(&self, switch: &Switch) -> f64 {
        self.registers.get(switch.to)
    }

    /// Gives the switches the results that they had.
    pub fn set_switches(&mut self, kept: &[f64]) {
        for (switch, kept) in self.program.switches().iter().zip(kept) {
            self.registers.set(switch.to, *kept);
        }
    }

    /// Where formulas come to the end of what their functions take.
    pub fn rims(&self) -> &[Rim] {
        &self.program.outputs.rims
    }

    /// Room for proofs about rims of time, and of the motion.
    pub fn enclosures_of_rims(&self) -> [Enclosure; 2] {
        [true, false].map(|on_time| Enclosure::of_rims(&self.program, &self.registers, on_time))
    }

    /// A rim's gauge and its slope where time, position and velocity were set.
    pub fn gauge(&mut self, rim: &Rim) -> [f64; 2] {
        self.program.run(Stage::Rims, &mut self.registers);
        [rim.gauge, rim.slope].map(|register| self.registers.get(register))
    }

    /// The largest term of a gauge, which must just have been asked for.
    pub fn largest_term(&self, rim: &Rim) -> f64 {
        rim.terms.iter().map(|&register| self.registers.get(register).abs()).fold(0.0, f64::max)
    }

    /// Sets the velocity alone.
    pub fn set_velocity(&mut self, qd: &[f64]) {
        self.registers.set_all(self.program.inputs.coordinates[1], qd);
    }

    /// Encloses from one time (s) to another, coordinates and velocities being anywhere in their intervals (middle and reach).
    pub fn enclose_motion(&self, enclosure: &mut Enclosure, times: [f64; 2], [q, qd]: [&[[f64; 2]]; 2]) {
        enclosure.set_all(self.program.inputs.coordinates[0], q);
        enclosure.set_all(self.program.inputs.coordinates[1], qd);
        enclosure.enclose(&self.program, &self.registers, times);
    }

    /// Whether a switch would have another result now if it were not frozen.
    pub fn would_switch(&self, switch: &Switch) -> bool {
        let (live, now) = (self.program.live(switch, &self.registers), self.registers.get(switch.to));
        // what is not a number is told elsewhere
        !live.is_nan() && (live + 0.0).to_bits() != (now + 0.0).to_bits()
    }

    /// What a switch is decided by where time and position were set, and how far that is from its edge.
    pub fn edge(&self, switch: &Switch) -> (f64, f64) {
        self.program.edge(switch, &self.registers)
    }

    /// Whether a switch stands exactly on its edge.
    pub fn is_on_edge(&self, switch: &Switch) -> bool {
        match switch.op {
            Op::Compare { a, b, .. } => self.registers.get(a).total_cmp(&self.registers.get(b)).is_eq(),
            _ => false,
        }
    }

    /// Room for proofs about what time alone decides, and about what the motion decides.
    pub fn enclosures(&self) -> [Enclosure; 2] {
        let of = [Enclosure::of_time, Enclosure::of_motion];
        of.map(|enclosure| enclosure(&self.program, &self.registers))
    }

    /// What time alone decides about the equations, unless it is a straight line.
    pub fn signals(&self) -> Vec<Signal> {
        self.program.signals()
    }

    pub fn read_signals(&self, signals: &[Signal], values: &mut [f64]) {
        for (value, signal) in values.iter_mut().zip(signals) {
            *value = self.registers.get(signal.register);
        }
    }

    pub fn enclosure_of(&self, signals: &[Signal]) -> Enclosure {
        let registers: Vec<Register> = signals.iter().map(|signal| signal.register).collect();
        Enclosure::of_registers(&self.program, &self.registers, &registers)
    }

    /// Encloses signals from one time (s) to another.
    pub fn enclose(&self, enclosure: &mut Enclosure, times: [f64; 2]) {
        enclosure.enclose(&self.program, &self.registers, times);
    }

    /// How much of the mechanism's size each signal moves an equation by, for each unit of its own; `nudge` is the part of
    /// itself by which it is changed to learn that.
    pub fn effects(&mut self, signals: &[Signal], q: &[f64], nudge: f64) -> Vec<f64> {
        // what is wrong with the position shows where it is solved for
        let _ = self.set_position(q);
        let checks = |kinematics: &Self, k: usize| kinematics.registers.get(kinematics.program.outputs.checks[k]);
        let before: Vec<Vec<f64>> = signals
            .iter()
            .map(|signal| {
                let rows = signal.rows.iter().map(|&row| self.phi(row));
                rows.chain(signal.checks.iter().map(|&k| checks(self, k))).collect()
            })
            .collect();
        let values: Vec<f64> = signals.iter().map(|signal| self.registers.get(signal.register)).collect();
        let step = |value: f64| nudge * f64::max(value.abs(), 1.0);
        for (signal, value) in signals.iter().zip(&values) {
            self.registers.set(signal.register, value + step(*value));
        }
        let _ = self.set_position(q);
        let effects = signals.iter().zip(&before).zip(&values).map(|((signal, before), value)| {
            let rows = signal.rows.iter().map(|&row| (self.phi(row), self.linear.row_norm(row)));
            let scales = &self.system().checks;
            let all = rows.chain(signal.checks.iter().map(|&k| (checks(self, k), scales[k].scale)));
            let changes = all.zip(before).map(|((after, scale), before)| (after - before).abs() / scale);
            changes.fold(0.0, f64::max) / step(*value)
        });
        let effects = effects.collect();
        for (signal, value) in signals.iter().zip(values) {
            self.registers.set(signal.register, value);
        }
        let _ = self.set_position(q);
        effects
    }

    /// Whether nothing happens from one time (s) to another; see [`Enclosure::is_steady`].
    pub fn is_steady(
        &self,
        enclosure: &mut Enclosure,
        times: [f64; 2],
        coordinates: &[[f64; 2]],
        may_change: impl Fn(Register) -> bool,
    ) -> bool {
        enclosure.is_steady(&self.program, &self.registers, times, coordinates, may_change)
    }

    /// What is left of each row's velocity and acceleration equation with the derivatives of another state, scaled; the
    /// derivatives where the position was set must just have been computed.
    pub fn left_open(&self, row: usize, state: &State) -> (f64, f64) {
        let outputs = &self.program.outputs;
        let open = |x: &[f64], right: Register| {
            (self.left(row, x) - self.registers.get(right)).abs() / self.linear.row_norm(row)
        };
        (open(&state.qd, outputs.nu[row]), open(&state.qdd, outputs.gamma[row]))
    }

    pub fn set_time(&mut self, t: f64) {
        self.registers.set(self.program.inputs.time, t);
        self.program.run(Stage::Time, &mut self.registers);
    }

    /// Evaluates Φ and Φ_q at a position.
    pub fn set_position(&mut self, q: &[f64]) -> Result<(), Fault> {
        self.registers.set_all(self.program.inputs.coordinates[0], q);
        self.program.run(Stage::Position, &mut self.registers);
        if let Some(index) = self.broken_condition() {
            return Err(Fault::Condition { index });
        }
        match (0..q.len()).find(|&row| !self.phi(row).is_finite()) {
            Some(row) => Err(Fault::NotFinite { row }),
            None => Ok(()),
        }
    }

    /// An entry of Φ where the position was set.
    pub fn phi(&self, row: usize) -> f64 {
        self.registers.get(self.program.outputs.phi[row])
    }

    /// An entry of Φ_q, by its position in the pattern.
    pub fn phi_q(&self, position: usize) -> f64 {
        self.registers.get(self.program.outputs.phi_q[position])
    }

    /// The value of a register.
    pub fn value(&self, register: Register) -> f64 {
        self.registers.get(register)
    }

    /// The equation that was left out and does not hold where the position was set.
    pub fn broken_check(&self) -> Option<usize> {
        let checks = self.system().checks.iter().zip(&self.program.outputs.checks);
        let mut open = checks.map(|(check, &register)| self.registers.get(register).abs() / check.scale);
        open.position(|open| open.is_nan() || open > LARGEST_OPENING)
    }

    /// A quantity that is watched, against its scale, where the position was set.
    pub fn watched(&self, index: usize) -> f64 {
        self.registers.get(self.program.outputs.watches[index]) / self.system().watches[index].scale
    }

    /// Writes the sign of everything that is watched.
    pub fn sides(&self, sides: &mut [bool]) {
        for (k, side) in sides.iter_mut().enumerate() {
            *side = self.watched(k) > 0.0;
        }
    }

    /// The coordinates `θ` of lines of centres that point away from the other centre, where the position was set.
    pub fn turned_lines(&self) -> Vec<usize> {
        let system = self.system();
        let is_turned = |k: &usize| system.watches[*k].kind == WatchKind::LineOfCenters && self.watched(*k) < 0.0;
        let joints = (0..system.watches.len()).filter(is_turned).map(|k| Owner::Joint(system.watches[k].declaration));
        joints.filter_map(|owner| system.coordinates.iter().position(|c| c.owner == owner)).collect()
    }

    /// What solves for rows, in orders that suit the position that was factored; none where it would be too large.
    pub fn solver(&self) -> Option<Solver> {
        // it solves the equations of the whole
        if self.system().variations().iter().any(|variation| variation.scope.is_some()) {
            return None;
        }
        Solver::new(&self.determined, &self.program, self)
    }

    /// As [`Kinematics::solver`], to be written as code; by a program for this system with the same registers.
    pub fn solver_for_code_of(&self, program: &Program) -> Option<Solver> {
        Solver::for_code(&self.determined, program, self)
    }

    /// The program with its registers, whose switches stand as they are in this step.
    pub fn program(&self) -> (&Program, &Registers) {
        (&self.program, &self.registers)
    }

    /// By row, one over what may be left of it: its tolerance and what the coordinates' rounding makes, where the position was
    /// set and factored.
    pub fn write_bounds(&self, bounds: &mut [f64]) {
        for (row, bound) in bounds.iter_mut().enumerate() {
            let rounding = ROUNDING * self.steps(row).fold(0.0, f64::max);
            *bound = 1.0 / (self.tolerance * self.linear.row_norm(row) + rounding);
        }
    }

    /// Chooses the orders of elimination by the position that was factored. Allocates.
    pub fn choose_orders(&mut self) {
        self.linear.choose_orders();
    }

    /// Factors Φ_q where the position was set.
    pub fn factor(&mut self) -> Result<(), Fault> {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        let coordinates = self.program.inputs.coordinates[0];
        self.linear.yardstick().turn(|column| registers.get(coordinates + column as u32));
        match self.linear.factor(|position| registers.get(outputs.phi_q[position])) {
            Factored::Regular => Ok(()),
            Factored::Singular => match self.not_finite_slope() {
                Some(row) => Err(Fault::NotFinite { row }),
                None => Err(Fault::Singular),
            },
        }
    }

    fn not_finite_slope(&self) -> Option<usize> {
        let pattern = &self.system().phi_q;
        (0..self.system().rows.len()).find(|&row| pattern.range(row).any(|position| !self.phi_q(position).is_finite()))
    }

    /// Newton's correction of the position, and its largest scaled entry.
    pub fn correction(&mut self, delta: &mut [f64]) -> f64 {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        self.linear.solve(|row| -registers.get(outputs.phi[row]), delta)
    }

    /// Solves `Φ_q x = right` with the factors there are.
    pub fn solve(&mut self, right: &[f64], x: &mut [f64]) {
        self.linear.solve(|row| right[row], x);
    }

    /// The correction of those coordinates that follow without iteration from the others, and its largest scaled entry.
    pub fn explicit_correction(&mut self, delta: &mut [f64]) -> f64 {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        self.linear.solve_explicit(|row| -registers.get(outputs.phi[row]), delta)
    }

    /// Whether some rows hold, to the tolerance.
    pub fn hold(&self, rows: &[u32]) -> bool {
        rows.iter().all(|&row| self.is_met(row as usize))
    }

    /// Whether some rows are open by no more than `limit`, scaled.
    pub fn hold_nearly(&self, rows: &[u32], limit: f64) -> bool {
        rows.iter().all(|&row| self.residual(row as usize) <= limit)
    }

    /// The row that violates its tolerance most, with its scaled residual; `None` if all hold.
    ///
    /// A row's tolerance is `--tolerance` times its norm, plus what rounding alone makes of its terms and of the
    /// coordinates that it depends on.
    pub fn violated(&self) -> Option<(usize, f64)> {
        let n = self.system().rows.len();
        let mut worst: Option<(usize, f64)> = None;
        for row in (0..n).filter(|&row| !self.is_met(row)) {
            let residual = self.residual(row);
            if worst.is_none_or(|(_, known)| residual > known) {
                worst = Some((row, residual));
            }
        }
        worst
    }

    /// Whether a row holds, to the tolerance and rounding; one that is not a number does not.
    fn is_met(&self, row: usize) -> bool {
        let (off, bound) = (self.phi(row).abs(), self.tolerance * self.linear.row_norm(row));
        off <= bound || off <= bound + self.rounding(row)
    }

    /// What is left of a row of Φ, scaled.
    pub fn residual(&self, row: usize) -> f64 {
        self.phi(row).abs() / self.linear.row_norm(row)
    }

    /// What is left of Φ, scaled: the largest of all rows.
    pub fn largest_residual(&self) -> f64 {
        (0..self.system().rows.len()).map(|row| self.residual(row)).fold(0.0, f64::max)
    }

    /// 8 eps times the largest term of a row, the steps of its coordinates included.
    fn rounding(&self, row: usize) -> f64 {
        ROUNDING * self.largest_part(row)
    }

    fn largest_part(&self, row: usize) -> f64 {
        let terms = self.program.outputs.terms[row].iter().map(|&register| self.registers.get(register).abs());
        terms.chain(self.steps(row)).fold(0.0, f64::max)
    }

    /// What each coordinate contributes to a row by its slope.
    fn steps(&self, row: usize) -> impl Iterator<Item = f64> {
        let pattern = &self.system().phi_q;
        pattern.range(row).zip(pattern.row(row)).map(|(position, &(column, _))| {
            let q = self.registers.get(self.program.inputs.coordinates[0] + column);
            (self.phi_q(position) * q).abs()
        })
    }

    /// The formula that must be positive and is not, where time or a position was set.
    pub fn broken_condition(&self) -> Option<usize> {
        // a formula that is not a number is no better
        self.program.outputs.conditions.iter().position(|&register| {
            let value = self.registers.get(register);
            value.is_nan() || value <= 0.0
        })
    }

    /// Velocity, acceleration and, where needed, jerk of a state whose position was set and factored.
    pub fn derivatives(&mut self, state: &mut State) -> Result<(), Fault> {
        let linear = &mut self.linear;
        rates(&self.program, &mut self.registers, state, |registers, right, x| {
            linear.solve(|row| registers.get(right[row]), x);
        });
        self.all_finite(state)
    }

    /// How fast a row asks to be met, scaled (1/s); the derivatives where the position was set must have been computed.
    pub fn asked_speed(&self, row: usize) -> f64 {
        self.registers.get(self.program.outputs.nu[row]).abs() / self.linear.row_norm(row)
    }

    /// How much larger the velocities and accelerations of a state are than the right sides they answer to, scaled; at
    /// least 1. Its derivatives must just have been computed.
    pub fn amplification(&self, state: &State) -> f64 {
        let outputs = &self.program.outputs;
        let largest_right = |right: &[Register]| {
            let scaled =
                |(row, &register): (usize, &Register)| self.registers.get(register).abs() / self.linear.row_norm(row);
            right.iter().enumerate().map(scaled).fold(0.0, f64::max)
        };
        let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
        let velocity = ratio(self.linear.largest(&state.qd), largest_right(&outputs.nu));
        let acceleration = ratio(self.linear.largest(&state.qdd), largest_right(&outputs.gamma));
        velocity.max(acceleration).max(1.0)
    }

    /// Computes how far off velocity and acceleration of a state may be, if it is nearer to a singular position than a limit; says
    /// whether it is. Equations hold but for their rounding, which the position makes up for by moving the more the nearer it
    /// is, and derivatives move with it. The state must just have been computed.
    pub fn take_doubt(&mut self, state: &State, limit: f64) -> bool {
        let mut doubt = std::mem::take(&mut self.doubt);
        let is_near = self.linear.write_weights(limit, &mut doubt.right);
        if is_near {
            self.carry_rounding(state, &mut doubt);
            self.set_state(state);
        }
        self.doubt = doubt;
        is_near
    }

    /// By coordinate, how far off velocity and acceleration may be, which must have been computed [m/s, rad/s; m/s², rad/s²].
    pub fn doubt(&self) -> [&[f64]; 2] {
        [&self.doubt.velocity, &self.doubt.acceleration]
    }

    /// From the weights of the rows in their dependency to what their rounding, all adding up, makes of a state.
    fn carry_rounding(&mut self, state: &State, doubt: &mut Doubt) {
        for (row, weight) in doubt.right.iter_mut().enumerate() {
            *weight = f64::EPSILON * self.largest_part(row).copysign(*weight) * f64::from(u8::from(*weight != 0.0));
        }
        self.solve(&doubt.right, &mut doubt.position);
        for ((beside, q), off) in self.beside.iter_mut().zip(&state.q).zip(&doubt.position) {
            *beside = q + off;
        }
        let program = Arc::clone(&self.program);
        let ([coordinates, qd, ..], outputs) = (program.inputs.coordinates, &program.outputs);
        self.registers.set_all(coordinates, &self.beside);
        program.run(Stage::Position, &mut self.registers);
        program.run(Stage::Velocity, &mut self.registers);
        self.write_open(&outputs.nu, &state.qd, &mut doubt.right);
        self.solve(&doubt.right, &mut doubt.velocity);
        for ((beside, speed), off) in self.beside.iter_mut().zip(&state.qd).zip(&doubt.velocity) {
            *beside = speed - off;
        }
        self.registers.set_all(qd, &self.beside);
        program.run(Stage::Acceleration, &mut self.registers);
        self.write_open(&outputs.gamma, &state.qdd, &mut doubt.right);
        self.solve(&doubt.right, &mut doubt.acceleration);
    }

    /// By row, what is left of `Φ_q x = b`.
    fn write_open(&self, right: &[Register], x: &[f64], open: &mut [f64]) {
        for (row, open) in open.iter_mut().enumerate() {
            *open = self.left(row, x) - self.registers.get(right[row]);
        }
    }

    /// A row of `Φ_q x`.
    fn left(&self, row: usize, x: &[f64]) -> f64 {
        let pattern = &self.system().phi_q;
        pattern.range(row).zip(pattern.row(row)).map(|(at, &(column, _))| self.phi_q(at) * x[column as usize]).sum()
    }

    fn all_finite(&self, state: &State) -> Result<(), Fault> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        if finite(&state.qd) && finite(&state.qdd) && finite(&state.qddd) {
            return Ok(());
        }
        let outputs = &self.program.outputs;
        let row = [&outputs.nu, &outputs.gamma, &outputs.jerk]
            .into_iter()
            .find_map(|list| list.iter().position(|&register| !self.registers.get(register).is_finite()));
        Err(row.map_or(Fault::Singular, |row| Fault::NotFinite { row }))
    }

    /// Writes a result row of a state whose derivatives were just computed.
    pub fn write_row(&mut self, state: &State, row: &mut [f64]) {
        self.vary(state);
        self.write_columns(state, row);
    }

    /// Whether a column of a row is a derivative by an input or parameter.
    pub fn is_varied(&self, column: usize) -> bool {
        self.variations.columns.get(column).copied().unwrap_or(false)
    }

    /// The same equations and scales, whose variations are those that results need; none where they need none.
    pub fn with_variations_of_results(&self) -> Option<Kinematics> {
        let determined = Arc::new(self.determined.for_variations_of_results()?);
        let program = Arc::new(Program::new(determined.system()));
        let params: Vec<f64> = determined.system().params.iter().map(|param| param.value).collect();
        let holds = layout::holds(determined.system());
        let (registers, variations) = (program.start(&params), Varied::new(determined.system(), &holds));
        Some(Kinematics { determined, program, registers, variations, holds, ..self.clone() })
    }

    /// Computes the variations of a state that was solved for, where they can be trusted.
    pub fn vary_at(&mut self, state: &State) {
        self.set_time(state.t);
        let is_regular = self.set_position(&state.q).is_ok() && self.factor().is_ok();
        self.set_derivatives(state);
        if is_regular {
            self.vary(state);
        } else {
            self.leave_variations_out();
        }
    }

    /// How a coordinate, its velocity and its acceleration change in a variation.
    pub fn variation(&self, number: u32, coordinate: usize) -> [f64; 3] {
        [0, 1, 2].map(|order| self.registers.get(self.program.inputs.varied(number, order) + coordinate as u32))
    }

    /// Computes the variations of a state whose derivatives were just computed, where they can be trusted.
    fn vary(&mut self, state: &State) {
        if self.system().variations().is_empty() {
            return;
        }
        self.registers.set_all(self.program.inputs.coordinates[2], &state.qdd);
        if self.linear.nearness(TRUSTED) < TRUSTED {
            self.leave_variations_out();
            return;
        }
        let (linear, varied) = (&mut self.linear, &mut self.variations);
        vary(&self.determined, &self.program, &mut self.registers, varied, |registers, right, x| {
            linear.solve(|row| registers.get(right[row]), x);
        });
    }

    /// There are no variations at this position.
    fn leave_variations_out(&mut self) {
        let inputs = self.program.inputs;
        for register in inputs.varied..inputs.varied(self.system().variations().len() as u32, 0) {
            self.registers.set(register, f64::NAN);
        }
        // what measures share with the right sides is computed there
        self.program.run(Stage::Variation, &mut self.registers);
    }

    fn write_columns(&mut self, state: &State, row: &mut [f64]) {
        let (program, registers) = (&*self.program, &mut self.registers);
        let [_, _, qdd, _] = program.inputs.coordinates;
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Measures, registers);
        let outputs = &program.outputs;
        let lists =
            [(&state.q, &outputs.measures), (&state.qd, &outputs.measures_d), (&state.qdd, &outputs.measures_dd)];
        let mut cells = row.iter_mut();
        let mut put = |value: f64| {
            if let Some(cell) = cells.next() {
                // −0 would surprise a reader
                *cell = value + 0.0;
            }
        };
        put(state.t);
        for (coordinates, measures) in lists {
            for &value in coordinates {
                put(value);
            }
            for &register in measures {
                put(registers.get(register));
            }
        }
        for &register in &outputs.appended {
            put(registers.get(register));
        }
    }

    /// Solves for a row with partial pivoting, from the position that it holds (m, rad); says whether it holds.
    pub fn pivoted_row(&mut self, pivoting: &mut Pivoting, state: &mut State, row: &mut [f64]) -> bool {
        self.set_time(state.t);
        if !pivoting.position(self, &mut state.q) || self.violated().is_some() {
            return false;
        }
        rates(&self.program, &mut self.registers, state, |registers, right, x| {
            pivoting.solve(|row| registers.get(right[row]), x);
        });
        let is_finite = self.all_finite(state).is_ok();
        if is_finite {
            self.registers.set_all(self.program.inputs.coordinates[2], &state.qdd);
            let varied = &mut self.variations;
            vary(&self.determined, &self.program, &mut self.registers, varied, |registers, right, x| {
                pivoting.solve(|row| registers.get(right[row]), x);
            });
            self.write_columns(state, row);
        }
        is_finite
    }

    /// Writes a result row of a state whose derivatives were found otherwise than by solving; its position must have been set.
    pub fn write_given_row(&mut self, state: &State, row: &mut [f64]) {
        self.set_derivatives(state);
        if !self.system().variations().is_empty() {
            match self.factor() {
                Ok(()) => self.vary(state),
                Err(_) => self.leave_variations_out(),
            }
        }
        self.write_columns(state, row);
    }

    /// Sets a state that was computed before.
    fn set_state(&mut self, state: &State) {
        self.registers.set_all(self.program.inputs.coordinates[0], &state.q);
        self.program.run(Stage::Position, &mut self.registers);
        self.set_derivatives(state);
    }

    fn set_derivatives(&mut self, state: &State) {
        let (program, registers) = (&*self.program, &mut self.registers);
        let [_, qd, qdd, qddd] = program.inputs.coordinates;
        // what measures share with the right sides is computed there, and has to be of these derivatives
        program.run(Stage::Velocity, registers);
        registers.set_all(qd, &state.qd);
        program.run(Stage::Acceleration, registers);
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Jerk, registers);
        registers.set_all(qddd, &state.qddd);
    }

    /// The measure behind a column of a result row, which must be one of a measure; behind the last one follow the variables, for the
    /// columns of derivatives by them.
    pub fn measure_of_column(&self, column: usize) -> usize {
        let system = self.system();
        match self.holds.get(column) {
            Some(&Holds::Measure { index, .. }) => index,
            Some(&Holds::Appended(k)) => system.measures.len() + system.appended()[k].variable as usize,
            _ => 0,
        }
    }

    /// Length of a result row.
    pub fn row_length(&self) -> usize {
        self.holds.len()
    }

    /// Evaluates and factors at a state again.
    pub fn restore(&mut self, state: &State) {
        self.set_time(state.t);
        // the state was computed once, so that neither can fail now
        let _ = self.set_position(&state.q);
        let _ = self.factor();
    }

    /// How near to a singular position, where that is below `limit`.
    pub fn nearness(&mut self, limit: f64) -> f64 {
        self.linear.nearness(limit)
    }

    /// The most nearly singular block where Φ_q was factored.
    pub fn worst(&mut self) -> Singular {
        self.linear.worst()
    }
}

impl Equations for Kinematics {
    fn set_position(&mut self, q: &[f64]) -> bool {
        Kinematics::set_position(self, q).is_ok()
    }

    fn phi(&self, row: usize) -> f64 {
        Kinematics::phi(self, row)
    }

    fn slope(&self, position: usize) -> f64 {
        self.phi_q(position)
    }
}

impl Values for Kinematics {
    fn entry(&self, position: usize) -> f64 {
        let pattern = &self.system().phi_q;
        let column = pattern.entries()[position].0 as usize;
        self.phi_q(position) * self.linear.column_scale(column) / self.linear.row_norm(pattern.row_of(position))
    }

    fn row_norm(&self, row: usize) -> f64 {
        self.linear.row_norm(row)
    }
}

/// Velocity, acceleration and, where needed, jerk of a state whose position was set, by what solves `Φ_q x = b` for a right side.
fn rates(
    program: &Program,
    registers: &mut Registers,
    state: &mut State,
    mut solve: impl FnMut(&Registers, &[Register], &mut [f64]),
) {
    let [_, qd, qdd, qddd] = program.inputs.coordinates;
    let outputs = &program.outputs;
    program.run(Stage::Velocity, registers);
    solve(registers, &outputs.nu, &mut state.qd);
    registers.set_all(qd, &state.qd);
    program.run(Stage::Acceleration, registers);
    solve(registers, &outputs.gamma, &mut state.qdd);
    if !outputs.jerk.is_empty() {
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Jerk, registers);
        solve(registers, &outputs.jerk, &mut state.qddd);
        registers.set_all(qddd, &state.qddd);
    }
}

/// The variations of a state whose derivatives are set, by what solves `Φ_q x = b` for a right side: those by one variable, then those
/// by two, each order from those before. They are left in their registers.
fn vary(
    determined: &Determined,
    program: &Program,
    registers: &mut Registers,
    Varied { solution, scoped, .. }: &mut Varied,
    mut solve: impl FnMut(&Registers, &[Register], &mut [f64]),
) {
    let variations = determined.system().variations();
    for by_two in [false, true] {
        for order in 0..3 {
            let of_kind = || (0..variations.len()).filter(|&k| variations[k].by.1.is_some() == by_two);
            if of_kind().next().is_none() {
                break;
            }
            program.run(Stage::Variation, registers);
            if order == 0 && !by_two {
                scoped.factor(program, registers, TRUSTED);
            }
            for k in of_kind() {
                let right = &program.outputs.variations[k][order];
                match variations[k].scope {
                    None => solve(registers, right, solution),
                    Some(scope) => scoped.solve(scope, registers, right, solution),
                }
                registers.set_all(program.inputs.varied(k as u32, order as u32), solution);
            }
        }
    }
}

/// Whether a row may lose its slope by its formula alone: it is written by hand, of no distance, and no slope is constant.
fn is_bent(system: &ConstraintSystem, row: usize) -> bool {
    let declaration = system.declaration_of(row);
    let by_hand = !matches!(declaration.kind, DeclarationKind::Joint(_)) && declaration.points.is_empty();
    by_hand && !system.phi_q.row(row).iter().any(|&(_, slope)| system.graph.dependence(slope).is_constant())
}
