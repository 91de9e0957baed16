//! Derivatives by inputs and parameters at states of the motion: the variations that results hold, of which rows need not know.

use crate::analysis::state::{Kinematics, State};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Program, Register, Registers, Stage};

/// What finds the variations of coordinates at a state.
pub(super) struct Varying {
    kinematics: Kinematics,
    /// Whether equations that were left out go on to hold; none where none was.
    beside: Option<Beside>,
}

/// What tells whether the equations that were left out hold beside a position.
struct Beside {
    program: Program,
    registers: Registers,
    /// By the number of a variation: not zero where they do.
    hold: Vec<(u32, Register)>,
    /// The variations of which they do not.
    broken: Vec<u32>,
}

impl Beside {
    fn of(system: &ConstraintSystem, variations: usize) -> Option<Beside> {
        let (numbers, formulas): (Vec<u32>, Vec<_>) = system.results().variation_conditions.iter().copied().unzip();
        let counts = [system.params().len(), system.coordinates().len(), variations, 0];
        let (program, roots) = Program::of_formulas(system.graph(), counts, &formulas);
        let params = system.param_values();
        let registers = program.start(&params);
        let hold: Vec<(u32, Register)> = numbers.into_iter().zip(roots).collect();
        (!hold.is_empty()).then_some(Beside { program, registers, hold, broken: Vec::new() })
    }

    /// Looks at a state, of which the variations are known.
    fn look(&mut self, state: &State, kinematics: &Kinematics) {
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

impl Varying {
    /// Beside the equations of a motion; none where no result needs any.
    pub fn of(motion: &Kinematics) -> Option<Varying> {
        let kinematics = motion.with_variations_of_results()?;
        let beside = Beside::of(motion.system(), kinematics.system().variations().len());
        Some(Varying { kinematics, beside })
    }

    /// How many variations there are.
    pub fn count(&self) -> usize {
        self.kinematics.system().variations().len()
    }

    /// Goes over to where the switches of the equations have some results.
    pub fn enter(&mut self, switches: &[f64]) {
        self.kinematics.freeze(true, true);
        self.kinematics.set_switches(switches);
    }

    /// Finds all variations at a state; where they cannot be trusted, or an equation that was left out would cease to hold, they are no
    /// numbers.
    pub fn go_to(&mut self, state: &State) {
        self.kinematics.vary_at(state);
        if let Some(beside) = &mut self.beside {
            beside.look(state, &self.kinematics);
        }
    }

    /// How a coordinate, its velocity and its acceleration change in a variation.
    pub fn variation(&self, number: u32, coordinate: usize) -> [f64; 3] {
        if self.is_broken(number) {
            return [f64::NAN; 3];
        }
        self.kinematics.variation(number, coordinate)
    }

    /// How the multiplier of a row changes in a variation.
    pub fn varied_multiplier(&self, number: u32, row: usize) -> f64 {
        if self.is_broken(number) { f64::NAN } else { self.kinematics.varied_multiplier(number, row) }
    }

    fn is_broken(&self, number: u32) -> bool {
        self.beside.as_ref().is_some_and(|beside| beside.broken.contains(&number))
    }
}
