//! Forces beside the rows: contacts that would have to pull, and loads that have no value.

use crate::analysis::explain::errors;
use crate::analysis::follow::remarks::Remarks;
use crate::analysis::state::{Kinematics, State};
use crate::diag::Diagnostic;
use crate::expr::ExprId;
use crate::ir::{ConstraintSystem, LoadForce};
use crate::layout::RowLayout;
use crate::program::{Program, Register, Registers, Stage};
use crate::tolerances::contacts::PULLS;

/// A load, as it is watched.
struct WatchedLoad {
    force: Register,
    /// By how much the distance that it works on is longer than what has no direction.
    excess: Option<Register>,
    /// What must be above zero, in the order of its conditions.
    conditions: Vec<Register>,
    is_told: bool,
}

/// What looks at the forces of rows, once more.
pub struct ForceWatch {
    kinematics: Kinematics,
    program: Program,
    registers: Registers,
    /// By contact.
    presses: Vec<Register>,
    has_pulled: Vec<bool>,
    /// The side to which each presses: 1 where that is known, 0 where the first row will tell.
    sides: Vec<f64>,
    loads: Vec<WatchedLoad>,
    /// Where a row has the coordinates, by their order, and how many there are.
    coordinates: [usize; 4],
    state: State,
}

impl WatchedLoad {
    /// A load whose formulas are in the next registers.
    fn of(load: &LoadForce, registers: &mut impl Iterator<Item = Register>) -> Option<WatchedLoad> {
        let force = registers.next()?;
        let excess = load.excess.and_then(|_| registers.next());
        let conditions = registers.take(load.conditions.len()).collect();
        Some(WatchedLoad { force, excess, conditions, is_told: false })
    }

    /// Warns once of a distance that has no direction at a time (s); a load that has no value is why there is none of anything.
    fn look(
        &mut self,
        of: &LoadForce,
        system: &ConstraintSystem,
        registers: &Registers,
        t: f64,
        remarks: &mut Remarks,
    ) -> Result<(), Box<Diagnostic>> {
        if !registers.get(self.force).is_finite() {
            let holds = |register: &Register| registers.get(*register) > 0.0;
            let broken = self.conditions.iter().position(|condition| !holds(condition)).map(|k| &of.conditions[k]);
            return Err(Box::new(errors::load_not_finite(system, of, broken, t)));
        }
        if !self.is_told && self.excess.is_some_and(|excess| registers.get(excess) <= 0.0) {
            self.is_told = true;
            remarks.push(errors::load_without_direction(of, t));
        }
        Ok(())
    }
}

impl ForceWatch {
    /// Of equations in a state; none where there is nothing to watch.
    pub fn of(kinematics: &Kinematics, state: &State) -> Option<ForceWatch> {
        let system = kinematics.system();
        if system.loads().is_empty() && system.presses().is_empty() {
            return None;
        }
        let presses = system.presses().iter().map(|press| press.force);
        let formulas: Vec<ExprId> = presses.chain(system.loads().iter().flat_map(LoadForce::formulas)).collect();
        let counts = [system.params().len(), system.coordinates().len(), 0, system.rows().len()];
        let (program, registers) = Program::of_formulas(system.graph(), counts, &formulas);
        let mut registers = registers.into_iter();
        let presses: Vec<Register> = registers.by_ref().take(system.presses().len()).collect();
        let loads = system.loads().iter().map_while(|load| WatchedLoad::of(load, &mut registers)).collect();
        let params = system.values_of_params();
        let registers = program.start(&params);
        let coordinates = RowLayout::new(system).coordinates.map(|first| first as usize);
        let has_pulled = vec![false; presses.len()];
        let sides = system.presses().iter().map(|press| f64::from(u8::from(press.is_sided))).collect();
        let (kinematics, state) = (kinematics.clone(), state.clone());
        Some(ForceWatch { kinematics, program, registers, presses, has_pulled, sides, loads, coordinates, state })
    }

    /// Goes on with other equations, which exert the same.
    pub fn change_equations(&mut self, kinematics: &Kinematics) {
        if let Some(other) = ForceWatch::of(kinematics, &self.state) {
            let told: Vec<bool> = self.loads.iter().map(|load| load.is_told).collect();
            let (has_pulled, sides) = (std::mem::take(&mut self.has_pulled), std::mem::take(&mut self.sides));
            *self = ForceWatch { has_pulled, sides, ..other };
            for (load, is_told) in self.loads.iter_mut().zip(told) {
                load.is_told = is_told;
            }
        }
    }

    /// Looks at a row: warns once of each contact that pulls there, with a part of the row's largest force that is no rounding; where no curve
    /// tells its side, of one that presses to the other side than before. A load that has no value is why there is none.
    pub fn look(&mut self, row: &[f64], remarks: &mut Remarks) -> Result<(), Box<Diagnostic>> {
        let is_whole = row.iter().all(|value| value.is_finite());
        if is_whole && self.has_pulled.iter().all(|has_pulled| *has_pulled) {
            return Ok(());
        }
        self.compute(row);
        let system = self.kinematics.system();
        for (load, of) in self.loads.iter_mut().zip(system.loads()) {
            load.look(of, system, &self.registers, row[0], remarks)?;
        }
        let least = PULLS * self.largest(system);
        let contacts = self.presses.iter().zip(&mut self.sides).zip(&mut self.has_pulled).zip(system.presses());
        for (((press, side), told), of) in contacts {
            let force = self.registers.get(*press);
            if *side == 0.0 && force.abs() > least {
                *side = force.signum();
            }
            let pressing = *side * force;
            if !*told && pressing < -least {
                *told = true;
                remarks.push(errors::contact_pulls(system, of, pressing, row[0]));
            }
        }
        Ok(())
    }

    /// The largest of the multipliers.
    fn largest(&self, system: &ConstraintSystem) -> f64 {
        (0..system.rows().len()).map(|row| self.kinematics.multiplier(row).abs()).fold(0.0, f64::max)
    }

    /// Computes what is watched at a row's state.
    fn compute(&mut self, row: &[f64]) {
        let ForceWatch { kinematics, program, registers, state, coordinates, .. } = self;
        let n = state.q.len();
        state.t = row[0];
        let own = [&mut state.q, &mut state.qd, &mut state.qdd];
        for (values, first) in own.into_iter().zip(&*coordinates) {
            values.copy_from_slice(&row[*first..first + n]);
        }
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
