//! Derivatives by inputs and parameters at states of the motion: the variations that results use and rows do not.

use crate::analysis::state::{Kinematics, State};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Program, Register, Registers, Stage};

/// The derivatives of coordinates and multipliers by inputs and parameters at a state.
pub(super) struct Sensitivities {
    kinematics: Kinematics,
    /// The check of the equations that were left out as redundant; `None` if there are none.
    dropped: Option<DroppedEquations>,
}

/// The check that equations left out as redundant still hold when inputs and parameters vary.
struct DroppedEquations {
    program: Program,
    registers: Registers,
    /// The condition of each variation, by its number: nonzero if the equations hold.
    hold: Vec<(u32, Register)>,
    /// The variations for which the equations do not hold at the last state.
    broken: Vec<u32>,
}

impl DroppedEquations {
    fn new(system: &ConstraintSystem, variations: usize) -> Option<DroppedEquations> {
        let (numbers, formulas): (Vec<u32>, Vec<_>) = system.results().variation_conditions.iter().copied().unzip();
        let counts = [system.params().len(), system.coordinates().len(), variations, 0];
        let (program, roots) = Program::of_formulas(system.graph(), counts, &formulas);
        let params = system.param_values();
        let registers = program.start(&params);
        let hold: Vec<(u32, Register)> = numbers.into_iter().zip(roots).collect();
        (!hold.is_empty()).then_some(DroppedEquations { program, registers, hold, broken: Vec::new() })
    }

    /// Evaluates the conditions at a state whose variations have been solved for.
    fn check_at(&mut self, state: &State, kinematics: &Kinematics) {
        let inputs = self.program.inputs;
        self.registers.set(inputs.time, state.t);
        for (first, values) in inputs.coordinates.into_iter().zip([&state.q, &state.qd, &state.qdd, &state.qddd]) {
            self.registers.set_all(first, values);
        }
        for number in 0..kinematics.system().variations().len() as u32 {
            for k in 0..state.q.len() {
                for (order, value) in kinematics.variation(number, k).into_iter().enumerate() {
                    self.registers.set(inputs.varied(number, order as u32) + k as Register, value);
                }
            }
        }
        self.program.run(Stage::Measures, &mut self.registers);
        self.broken.clear();
        let broken = self.hold.iter().filter(|(_, register)| self.registers.get(*register) == 0.0);
        self.broken.extend(broken.map(|(number, _)| *number));
    }
}

impl Sensitivities {
    /// Returns the sensitivities along a motion, or `None` if no result needs any.
    pub fn from_motion(motion: &Kinematics) -> Option<Sensitivities> {
        let kinematics = motion.with_variations_of_results()?;
        let dropped = DroppedEquations::new(motion.system(), kinematics.system().variations().len());
        Some(Sensitivities { kinematics, dropped })
    }

    /// Returns the number of variations.
    pub fn count(&self) -> usize {
        self.kinematics.system().variations().len()
    }

    /// Sets the results of the equations' switches.
    pub fn set_switches(&mut self, switches: &[f64]) {
        self.kinematics.freeze(true, true);
        self.kinematics.set_switches(switches);
    }

    /// Solves for all variations at a state. A variation is NaN if it cannot be trusted or if an equation that was left out would cease to hold.
    pub fn solve_at(&mut self, state: &State) {
        self.kinematics.vary_at(state);
        if let Some(dropped) = &mut self.dropped {
            dropped.check_at(state, &self.kinematics);
        }
    }

    /// Returns the derivatives of a coordinate, its velocity and its acceleration in a variation.
    pub fn variation(&self, number: u32, coordinate: usize) -> [f64; 3] {
        if self.is_broken(number) {
            return [f64::NAN; 3];
        }
        self.kinematics.variation(number, coordinate)
    }

    /// Returns the derivative of the multiplier of a row in a variation.
    pub fn varied_multiplier(&self, number: u32, row: usize) -> f64 {
        if self.is_broken(number) { f64::NAN } else { self.kinematics.varied_multiplier(number, row) }
    }

    /// Returns whether an equation that was left out would cease to hold in a variation.
    fn is_broken(&self, number: u32) -> bool {
        self.dropped.as_ref().is_some_and(|dropped| dropped.broken.contains(&number))
    }
}
