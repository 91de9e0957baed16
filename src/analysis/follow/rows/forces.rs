//! Forces beside the rows: contacts that would have to pull, and loads that have no value.

use crate::analysis::explain::errors;
use crate::analysis::follow::remarks::Remarks;
use crate::analysis::state::{Kinematics, State};
use crate::diag::Diagnostic;
use crate::expr::ExprId;
use crate::ir::ConstraintSystem;
use crate::layout::RowLayout;
use crate::program::{Program, Register, Registers, Stage};
use crate::tolerances::contacts::PULLS;

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
    loads: Vec<Register>,
    /// Where a row has the coordinates, by their order, and how many there are.
    coordinates: [usize; 4],
    state: State,
}

impl ForceWatch {
    /// Of equations in a state; none where there is nothing to watch.
    pub fn of(kinematics: &Kinematics, state: &State) -> Option<ForceWatch> {
        let system = kinematics.system();
        if system.loads().is_empty() && system.presses().is_empty() {
            return None;
        }
        let presses = system.presses().iter().map(|press| press.force);
        let formulas: Vec<ExprId> = presses.chain(system.loads().iter().map(|load| load.force)).collect();
        let counts = [system.params().len(), system.coordinates().len(), 0, system.rows().len()];
        let (program, mut presses) = Program::of_formulas(system.graph(), counts, &formulas);
        let loads = presses.split_off(system.presses().len());
        let params = system.values_of_params();
        let registers = program.start(&params);
        let coordinates = RowLayout::new(system).coordinates.map(|first| first as usize);
        let has_pulled = vec![false; presses.len()];
        let sides = system.presses().iter().map(|press| f64::from(u8::from(press.is_sided))).collect();
        let (kinematics, state) = (kinematics.clone(), state.clone());
        Some(ForceWatch { kinematics, program, registers, presses, has_pulled, sides, loads, coordinates, state })
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
        let value = |register: &Register| self.registers.get(*register);
        if let Some(number) = self.loads.iter().position(|load| !value(load).is_finite()) {
            return Err(Box::new(errors::load_not_finite(&system.loads()[number], row[0])));
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
