//! Monitor of forces: contacts that would have to pull, in rows or between them, and loads that have no value.

use crate::analysis::explain::{Stop, StopCause, Warning, WarningCause};
use crate::analysis::follow::warnings::Warnings;
use crate::analysis::state::{Kinematics, State};
use mechc_expr::ExprId;
use mechc_expr::math::{Halving, about, along, farthest};
use mechc_ir::layout::RowLayout;
use mechc_ir::program::{Program, Ranges, Register, Registers, Stage};
use mechc_ir::{ConstraintSystem, LoadForce};

/// A contact pulls if its force exceeds this part of the largest force of the row; less is rounding.
const PULLS: f64 = 1e-9;
/// Widest part of a step that is examined for contact forces, as a part of the step.
const WIDEST_BETWEEN: f64 = 0.125;
/// Parts are halved where a load may exceed its values at both ends by more than this part of the largest value so far.
const STRIKES: f64 = 0.05;
/// Smallest part, as a part of the step.
const FINEST_BETWEEN: f64 = 1.0 / 256.0;
/// Maximum number of parts of a step.
const MOST_BETWEEN: usize = 128;
/// Corrections of a position on the curve of a step.
const CORRECTIONS: usize = 2;

/// Monitor of a load.
struct LoadMonitor {
    force: Register,
    /// Excess of the distance that the load works on over a length without a direction.
    excess: Option<Register>,
    /// Quantities that must be above zero, in the order of the load's conditions.
    conditions: Vec<Register>,
    is_reported: bool,
}

/// A contact that pulls between rows.
#[derive(Clone, Copy)]
struct Pull {
    /// Time of the strongest pull (s).
    t: f64,
    /// Contact force then, negative for a pull (N).
    pressing: f64,
}

/// Checks the forces of rows, which it computes once more, and those between rows.
pub struct ForceMonitor {
    kinematics: Kinematics,
    program: Program,
    registers: Registers,
    /// By contact.
    presses: Vec<Register>,
    has_pulled: Vec<bool>,
    /// By contact: the side to which it presses, or 0 until a row decides it.
    sides: Vec<f64>,
    /// True if a row has been checked. The motion before the first row is not checked, nor one without rows.
    has_begun: bool,
    /// By contact: its strongest pull between rows.
    between: Vec<Option<Pull>>,
    loads: Vec<LoadMonitor>,
    /// By load: enclosure of its value on a part of the step.
    ranges: Vec<Ranges>,
    /// By load: its value at both ends of that part, and the largest so far.
    ends: Vec<[f64; 2]>,
    largest_load: f64,
    delta: Vec<f64>,
    /// First column of the coordinates in a row, and of their first, second and third derivatives.
    coordinates: [usize; 4],
    state: State,
}

impl LoadMonitor {
    /// Returns the monitor of a load whose formulas are in the next registers.
    fn new(load: &LoadForce, registers: &mut impl Iterator<Item = Register>) -> Option<LoadMonitor> {
        let force = registers.next()?;
        let excess = load.excess.and_then(|_| registers.next());
        let conditions = registers.take(load.conditions.len()).collect();
        Some(LoadMonitor { force, excess, conditions, is_reported: false })
    }

    /// Warns once of a distance that has no direction at a time (s); a load without a value is an error.
    fn look(&mut self, index: usize, registers: &Registers, t: f64, warnings: &mut Warnings) -> Result<(), Box<Stop>> {
        if !registers.get(self.force).is_finite() {
            let holds = |register: &Register| registers.get(*register) > 0.0;
            let broken = self.conditions.iter().position(|condition| !holds(condition));
            return Err(StopCause::Load { index, broken }.at(t));
        }
        if !self.is_reported && self.excess.is_some_and(|excess| registers.get(excess) <= 0.0) {
            self.is_reported = true;
            warnings.push(Warning { t, cause: WarningCause::LoadWithoutDirection { index } });
        }
        Ok(())
    }
}

impl ForceMonitor {
    /// Returns the monitor of the forces from a state on; `None` without contacts and loads.
    pub fn new(kinematics: &Kinematics, state: &State) -> Option<ForceMonitor> {
        let system = kinematics.system();
        if system.loads().is_empty() && system.contact_forces().is_empty() {
            return None;
        }
        let presses = system.contact_forces().iter().map(|press| press.force);
        let formulas: Vec<ExprId> = presses.chain(system.loads().iter().flat_map(LoadForce::formulas)).collect();
        let counts = [system.params().len(), system.coordinates().len(), 0, system.rows().len()];
        let (program, registers) = Program::of_formulas(system.graph(), counts, &formulas);
        let mut registers = registers.into_iter();
        let presses: Vec<Register> = registers.by_ref().take(system.contact_forces().len()).collect();
        let loads: Vec<LoadMonitor> =
            system.loads().iter().map_while(|load| LoadMonitor::new(load, &mut registers)).collect();
        let params = system.param_values();
        let registers = program.start(&params);
        let range = |load: &LoadMonitor| Ranges::new(&program, &registers, &[load.force], Stage::Measures, false);
        let ranges: Vec<Ranges> = loads.iter().map(range).collect();
        let (between, ends) = (vec![None; presses.len()], vec![[0.0; 2]; loads.len()]);
        let delta = vec![0.0; state.q.len()];
        let coordinates = RowLayout::new(system).coordinates.map(|first| first as usize);
        let has_pulled = vec![false; presses.len()];
        let sides = system.contact_forces().iter().map(|press| f64::from(u8::from(press.is_sided))).collect();
        let (kinematics, state) = (kinematics.clone(), state.clone());
        Some(ForceMonitor {
            kinematics,
            program,
            registers,
            presses,
            has_pulled,
            sides,
            has_begun: false,
            between,
            loads,
            ranges,
            ends,
            largest_load: 0.0,
            delta,
            coordinates,
            state,
        })
    }

    /// Goes on with other equations, which exert the same.
    pub fn change_equations(&mut self, kinematics: &Kinematics) {
        if let Some(other) = ForceMonitor::new(kinematics, &self.state) {
            let reported: Vec<bool> = self.loads.iter().map(|load| load.is_reported).collect();
            let (has_pulled, sides) = (std::mem::take(&mut self.has_pulled), std::mem::take(&mut self.sides));
            let (has_begun, largest_load) = (self.has_begun, self.largest_load);
            let between = std::mem::take(&mut self.between);
            *self = ForceMonitor { has_pulled, sides, has_begun, between, largest_load, ..other };
            for (load, is_reported) in self.loads.iter_mut().zip(reported) {
                load.is_reported = is_reported;
            }
        }
    }

    /// Checks a row of a motion: warns once of each contact that pulls in it, by more than rounding of the row's largest force, or has pulled on the
    /// way to it. If the sign of a contact's force is not declared, the first row decides which sign is a pull. A load without a value is an error.
    pub fn look(&mut self, of: &Kinematics, row: &[f64], warnings: &mut Warnings) -> Result<(), Box<Stop>> {
        self.has_begun = true;
        let is_whole = row.iter().all(|value| value.is_finite());
        if is_whole && self.has_pulled.iter().all(|has_pulled| *has_pulled) {
            return Ok(());
        }
        self.kinematics.take_switches(of);
        self.set_row(row);
        self.compute();
        let system = self.kinematics.system();
        for (index, load) in self.loads.iter_mut().enumerate() {
            load.look(index, &self.registers, row[0], warnings)?;
        }
        let least = PULLS * self.largest(system);
        for k in 0..self.presses.len() {
            let force = self.registers.get(self.presses[k]);
            if self.sides[k] == 0.0 && force.abs() > least {
                self.sides[k] = force.signum();
            }
            let pressing = self.sides[k] * force;
            let in_row = (pressing < -least).then_some(Pull { t: row[0], pressing });
            let before = self.between[k].filter(|pull| pull.t <= row[0]);
            if let Some(Pull { t, pressing }) = in_row.or(before)
                && !self.has_pulled[k]
            {
                self.has_pulled[k] = true;
                warnings.push(Warning { t, cause: WarningCause::ContactPulls { index: k, force: pressing } });
            }
        }
        Ok(())
    }

    /// Checks the forces within a step of length `h` from a time (s), each coordinate being a polynomial of the fraction of the step. Parts
    /// in which a load may leave its values at both ends are halved. The next row reports the pulls that are found.
    pub fn check_interior(&mut self, of: &Kinematics, [from, h]: [f64; 2], curve: &[[f64; 6]]) {
        if !self.has_begun {
            return;
        }
        let is_open = |k: usize| !self.has_pulled[k] && self.sides[k] != 0.0;
        if !(0..self.presses.len()).any(is_open) {
            return;
        }
        self.kinematics.take_switches(of);
        let mut parts = Halving::<32>::new([0.0, 1.0], FINEST_BETWEEN, MOST_BETWEEN);
        self.set_on_curve(curve, [from, h], 0.0);
        self.read_loads(0);
        while let Some(part @ [a, b]) = parts.next_part() {
            if b - a > WIDEST_BETWEEN && parts.halve(part) {
                continue;
            }
            if !self.set_on_curve(curve, [from, h], b) {
                return;
            }
            self.read_loads(1);
            if self.may_strike(curve, [from, h], part) && parts.halve(part) {
                continue;
            }
            self.take_pulls(from + b * h);
            self.ends.iter_mut().for_each(|ends| ends[0] = ends[1]);
        }
    }

    /// Takes note of contacts that pull at a place that was computed, at a time (s).
    fn take_pulls(&mut self, t: f64) {
        let least = PULLS * self.largest(self.kinematics.system());
        for (k, press) in self.presses.iter().enumerate() {
            let pressing = self.sides[k] * self.registers.get(*press);
            let is_most = self.between[k].is_none_or(|pull| pressing < pull.pressing);
            if pressing < -least && is_most {
                self.between[k] = Some(Pull { t, pressing });
            }
        }
    }

    fn read_loads(&mut self, end: usize) {
        for (load, ends) in self.loads.iter().zip(&mut self.ends) {
            ends[end] = self.registers.get(load.force);
            self.largest_load = self.largest_load.max(ends[end].abs());
        }
    }

    /// Returns whether a load may leave the values that it has at both ends of a part of a step.
    fn may_strike(&mut self, curve: &[[f64; 6]], [from, h]: [f64; 2], [a, b]: [f64; 2]) -> bool {
        let ForceMonitor { program, registers, ranges, ends, .. } = self;
        let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a));
        let least = STRIKES * self.largest_load;
        ranges.iter_mut().zip(ends).any(|(ranges, ends)| {
            ranges.set_times([from + a * h, from + b * h]);
            for (k, curve) in curve.iter().enumerate() {
                let mut along = *curve;
                for first in &program.inputs.coordinates[..3] {
                    let taylor = about(&along, middle);
                    let far = farthest(&taylor[1..], reach);
                    ranges.set(first + k as Register, [taylor[0] - far, taylor[0] + far]);
                    along = slope(&along, h);
                }
            }
            let range = ranges.range(program, registers, 0);
            let beyond = f64::max(range.high - ends[0].max(ends[1]), ends[0].min(ends[1]) - range.low);
            beyond.is_nan() || beyond > least
        })
    }

    /// Solves for a place of the curve of a step and computes the forces there; returns whether it could.
    fn set_on_curve(&mut self, curve: &[[f64; 6]], [from, h]: [f64; 2], x: f64) -> bool {
        let ForceMonitor { kinematics, state, delta, .. } = self;
        state.t = from + x * h;
        for (q, curve) in state.q.iter_mut().zip(curve) {
            *q = along(curve, x);
        }
        kinematics.set_time(state.t);
        for _ in 0..CORRECTIONS {
            if kinematics.set_position(&state.q).is_err() || kinematics.factor().is_err() {
                return false;
            }
            kinematics.correction(delta);
            state.q.iter_mut().zip(&*delta).for_each(|(q, delta)| *q += delta);
        }
        let is_solved = kinematics.set_position(&state.q).is_ok()
            && kinematics.factor().is_ok()
            && kinematics.derivatives(state).is_ok();
        if is_solved {
            self.compute();
        }
        is_solved
    }

    /// Returns the largest absolute multiplier.
    fn largest(&self, system: &ConstraintSystem) -> f64 {
        (0..system.rows().len()).map(|row| self.kinematics.multiplier(row).abs()).fold(0.0, f64::max)
    }

    /// Takes the state of a row.
    fn set_row(&mut self, row: &[f64]) {
        let ForceMonitor { state, coordinates, .. } = self;
        let n = state.q.len();
        state.t = row[0];
        let parts = [&mut state.q, &mut state.qd, &mut state.qdd];
        for (values, first) in parts.into_iter().zip(&*coordinates) {
            values.copy_from_slice(&row[*first..first + n]);
        }
    }

    /// Computes the forces at the state.
    fn compute(&mut self) {
        let ForceMonitor { kinematics, program, registers, state, .. } = self;
        kinematics.vary_at(state);
        let inputs = program.inputs;
        registers.set(inputs.time, state.t);
        for (first, values) in inputs.coordinates.into_iter().zip([&state.q, &state.qd, &state.qdd]) {
            registers.set_all(first, values);
        }
        for row in 0..kinematics.system().rows().len() {
            registers.set(inputs.multipliers + row as Register, kinematics.multiplier(row));
        }
        program.run(Stage::Measures, registers);
    }
}

/// Returns the time derivative of a polynomial of the fraction of a step of length `h` (s), as such a polynomial.
fn slope(&[_, a, b, c, d, e]: &[f64; 6], h: f64) -> [f64; 6] {
    [a / h, 2.0 * b / h, 3.0 * c / h, 4.0 * d / h, 5.0 * e / h, 0.0]
}
