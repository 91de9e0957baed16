//! The solver's operations as a function that solves for position, velocity and acceleration at a time.

use super::code::{Code, CodeContext, Function, Input, MODULE, Out};
use super::equations::{ARRAYS, Access, Equations};
use super::names::{FORCES, Names};
use super::operand::{Arguments, Operand};
use super::text::literal;
use super::{EmittedMotion, TranslationUnit};
use mechc_engine::limits::solver::LARGEST_MULTIPLIER;
use mechc_engine::solver::{Instruction, Segment, Solver};
use mechc_ir::With;
use mechc_ir::layout::{ColumnContent, row_contents};
use mechc_ir::program::{Column, Register};
use rustc_hash::FxHashMap;

/// Source of the solver's function.
pub(super) struct Solution<'s> {
    pub unit: &'s TranslationUnit<'s>,
    pub motion: &'s EmittedMotion,
    pub equations: &'s Equations<'s>,
    /// Registers of the program that follow from parameters alone, with their indices in `derived`.
    pub derived: FxHashMap<Register, usize>,
    /// Columns of values, other than results, that the solver stores and reads again, ascending.
    pub joined: Vec<u32>,
    /// Contents of the columns in which operations leave values.
    holds: Vec<ColumnContent>,
}

impl<'s> Solution<'s> {
    pub fn new(unit: &'s TranslationUnit<'s>, motion: &'s EmittedMotion, equations: &'s Equations<'s>) -> Solution<'s> {
        let joined = joined([Some(&motion.solver), motion.forced.as_ref()].into_iter().flatten());
        let mut solution = Solution {
            unit,
            motion,
            equations,
            derived: FxHashMap::default(),
            joined,
            holds: row_contents(unit.system),
        };
        let instructions = || {
            let more = motion.sensitive.iter().chain(&motion.forced).flat_map(Solver::instructions);
            motion.solver.instructions().iter().chain(more)
        };
        for instruction in instructions() {
            if let Some((table, column)) = instruction.column()
                && !equations.is_constant(table, column)
            {
                // one behind the other
                unit.program.tables()[table as usize].column(column).for_each(|cell| solution.add_derived(cell));
            }
        }
        for instruction in instructions() {
            if let Instruction::Load { from, .. } = *instruction
                && from >= unit.program.inputs.time
                && !unit.program.inputs.all_signals().contains(&from)
                && !equations.sides.contains_key(&from)
            {
                solution.add_derived(from);
            }
        }
        solution
    }

    /// Assigns an index in `derived` to a register.
    fn add_derived(&mut self, register: Register) {
        let next = self.derived.len();
        self.derived.entry(register).or_insert(next);
    }

    /// Returns the name of a column of a table, in a lane or alone.
    fn column(&self, table: u32, column: Column, lane: &str) -> Operand {
        if self.equations.is_constant(table, column) {
            return Operand::local(self.equations.table(table, column));
        }
        let cells = self.unit.program.tables()[table as usize].column(column);
        let first = self.derived.get(&cells.start).copied().unwrap_or(0);
        Operand::new(format!("m{lane}.derived[{first}..{}]", first + cells.len()), &["m"])
    }

    /// Returns whether Newton's method has coordinates to iterate for.
    pub fn has_newton(&self) -> bool {
        !self.motion.solver.tears().is_empty()
    }

    /// Returns the registers that follow from parameters alone, in the order of their indices.
    pub fn derived_registers(&self) -> Vec<Register> {
        let mut registers: Vec<(usize, Register)> =
            self.derived.iter().map(|(&register, &place)| (place, register)).collect();
        registers.sort_unstable();
        registers.into_iter().map(|(_, register)| register).collect()
    }

    /// Returns the solver's function, for one mechanism or for several lanes.
    pub fn function(&self, has_lanes: bool) -> String {
        let solver = &self.motion.solver;
        let code =
            Code { instructions: solver.instructions(), segments: solver.segments(), registers: solver.registers() };
        let names: Vec<String> = solver
            .tears()
            .iter()
            .take(20)
            .map(|&tear| format!("`{}`", self.unit.system.coordinates()[tear as usize].name))
            .collect();
        let more = if solver.tears().len() > names.len() { " and others" } else { "" };
        let how = if names.is_empty() {
            "Every coordinate follows from those before it.".to_owned()
        } else {
            format!("Newton begins with a guess of {}{more}; all else follows.", names.join(", "))
        };
        let types = if has_lanes {
            ["&[Each; TEARS]", "&Each", "&[Model; LANES]", "&[Sides; LANES]", "&mut Solutions"]
        } else {
            ["&[f64; TEARS]", "f64", "&Model", "&Sides", "&mut Solution"]
        };
        let has_sides = !self.equations.sides.is_empty();
        let names = ["guess", "t", "m", "sides", "at"].into_iter().zip(types);
        let arguments =
            names.filter(|(name, _)| has_sides || *name != "sides").map(|(name, of)| (name, of.to_owned())).collect();
        let function = Function {
            name: "solve",
            docs: wrapped(&format!(
                "Position, velocity and acceleration {}. {how}\n\n{} operations{}.",
                if has_lanes { "in every lane" } else { "at a time" },
                code.count(),
                if has_lanes { " a lane" } else { "" },
            )),
            is_public: false,
            arguments,
            out: Out::Given { begin: "at.begin(t);", names: &["at", "t"] },
            margin: if has_lanes { MODULE.len() } else { 0 },
        };
        self.note(solver, has_lanes);
        code.print(&SolverContext { solution: self, solver, has_lanes }, &function)
    }

    /// Records the dependencies of a solver whose operations are emitted as Rust expressions.
    fn note(&self, solver: &Solver, has_lanes: bool) {
        let mut deps = self.equations.deps.borrow_mut();
        deps.instructions(solver.instructions(), has_lanes);
        if !solver.tears().is_empty() {
            deps.name("limits", "ITERATIONS");
            deps.name("grid", "on_grid");
            let (file, name) = if has_lanes { ("lane_newton", "LaneNewton") } else { ("newton", "Newton") };
            deps.name(file, name);
        }
    }

    /// Returns the function that also gives the derivatives of the coordinates by parameters; `None` if they are not requested.
    pub fn sensitive_function(&self) -> Option<String> {
        let what = "the derivatives of the coordinates by parameters";
        Some(self.function_with(self.motion.sensitive.as_ref()?, "solve_by_params", what, ("by", "&mut [Q; PARAMS]")))
    }

    /// Returns the function that also gives what joints exert and drivers supply; `None` without masses and loads.
    pub fn forced_function(&self) -> Option<String> {
        let what = "what joints exert and drivers supply";
        Some(self.function_with(self.motion.forced.as_ref()?, "solve_with_forces", what, (FORCES, "&mut Forces")))
    }

    /// Returns the function of a solver with additional results `more`.
    fn function_with(&self, solver: &Solver, name: &str, what: &str, more: (&'static str, &str)) -> String {
        let code =
            Code { instructions: solver.instructions(), segments: solver.segments(), registers: solver.registers() };
        let has_sides = !self.equations.sides.is_empty();
        let arguments = [
            ("guess", "&[f64; TEARS]"),
            ("t", "f64"),
            ("m", "&Model"),
            ("sides", "&Sides"),
            ("at", "&mut Solution"),
            more,
        ];
        let arguments = arguments.into_iter().filter(|(name, _)| has_sides || *name != "sides");
        let function = Function {
            name,
            docs: format!("As [`solve`], with {what}.\n\n{} operations.", code.count()),
            is_public: false,
            arguments: arguments.map(|(name, of)| (name, of.to_owned())).collect(),
            out: Out::Given { begin: "at.begin(t);", names: &["at", "t"] },
            margin: 0,
        };
        self.note(solver, false);
        code.print(&SolverContext { solution: self, solver, has_lanes: false }, &function)
    }

    /// Returns the content of a column.
    fn holds(&self, column: u32) -> ColumnContent {
        debug_assert!((column as usize) < self.holds.len(), "column {column} is none of a row's");
        self.holds.get(column as usize).copied().unwrap_or(ColumnContent::Time)
    }

    /// Returns the index of a column in `joined`.
    fn joined(&self, column: u32) -> Option<usize> {
        self.joined.binary_search(&column).ok()
    }

    /// Returns the number of columns of a row without reactions.
    pub fn columns(&self) -> u32 {
        (self.motion.solver.layout().printed - self.unit.system.reactions().len()) as u32
    }

    /// Returns the width of a grid cell for each coordinate for which Newton's method solves.
    pub fn cells(&self) -> Vec<f64> {
        let solver = &self.motion.solver;
        let mut cell_of: FxHashMap<Register, f64> = FxHashMap::default();
        for segment in solver.segments() {
            if let Segment::Newton { tears, .. } = segment {
                cell_of.extend(tears.iter().map(|tear| (tear.x, tear.cell)));
            }
        }
        let mut cells = vec![0.0; solver.tears().len()];
        for op in solver.instructions() {
            if let Instruction::Curve { to, tear } = op {
                cells[*tear as usize] = cell_of.get(to).copied().unwrap_or(0.0);
            }
        }
        cells
    }
}

/// Returns the columns, other than results, that solvers store and read again.
fn joined<'s>(solvers: impl Iterator<Item = &'s Solver>) -> Vec<u32> {
    let read = |solver: &'s Solver| {
        let printed = solver.layout().printed as u32;
        solver.instructions().iter().filter_map(move |op| match *op {
            Instruction::Column { column, .. } => Some(column).filter(|column| *column >= printed),
            _ => None,
        })
    };
    let mut columns: Vec<u32> = solvers.flat_map(read).collect();
    columns.sort_unstable();
    columns.dedup();
    columns
}

/// Breaks documentation into lines.
pub(super) fn wrapped(text: &str) -> String {
    let mut lines = Vec::new();
    for paragraph in text.split('\n') {
        let mut line = String::new();
        for word in paragraph.split(' ') {
            if line.len() + word.len() > 92 && !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += word;
        }
        lines.push(line);
    }
    lines.join("\n")
}

struct SolverContext<'s> {
    solution: &'s Solution<'s>,
    solver: &'s Solver,
    has_lanes: bool,
}

impl SolverContext<'_> {
    /// Returns the index that selects a lane.
    fn lane(&self) -> &'static str {
        if self.has_lanes { "[k]" } else { "" }
    }
}

impl CodeContext for SolverContext<'_> {
    fn input(&self, register: Register) -> Input {
        debug_assert!(false, "register {register} has no operation");
        Input::Is(Operand::Number(f64::NAN))
    }

    fn load(&self, register: Register) -> Operand {
        let lane = self.lane();
        if let Some(place) = self.solution.derived.get(&register) {
            return Operand::new(format!("m{lane}.derived[{place}]"), &["m"]);
        }
        let of = if self.solution.equations.is_input_driven { "path" } else { "params" };
        let given = format!("m{lane}.{of}");
        let access = Access { given, names: &["m"], names_with_time: &["m", "t"], lane };
        match self.solution.equations.input(register, &access) {
            Input::Bound { value, .. } | Input::Is(value) => value,
        }
    }

    fn place(&self, column: u32) -> Operand {
        let at = |text: String| Operand::new(text, &["at"]);
        if let Some(place) = self.solution.joined(column) {
            return at(format!("at.joined[{place}]{}", self.lane()));
        }
        let held = self.solution.holds(column);
        match held {
            ColumnContent::Coordinate { index, order } => at(format!("at.{}[{index}]{}", ARRAYS[order], self.lane())),
            ColumnContent::Measure { order, .. } => {
                let of = if self.has_lanes { "" } else { "measures." };
                let place = column - self.solver.layout().measures[order];
                at(format!("at.{of}{}[{place}]{}", ["values", "rates", "accelerations"][order], self.lane()))
            }
            ColumnContent::Slope { of, by: With::Input(input) } => at(format!("at.along.by_signal[{input}][{of}]")),
            ColumnContent::Slope { of, by: With::Param(param) } => Operand::new(format!("by[{param}][{of}]"), &["by"]),
            ColumnContent::Reaction(k) => Operand::new(format!("{FORCES}[{k}]"), &[FORCES]),
            ColumnContent::Time
            | ColumnContent::Slope { by: With::Time(_), .. }
            | ColumnContent::DerivativeColumn(_)
            | ColumnContent::Varied
            | ColumnContent::Multiplier => {
                debug_assert!(false, "no code has a place for {held:?}");
                Operand::Number(f64::NAN)
            }
        }
    }

    fn name(&self, column: u32) -> Option<String> {
        let names: &Names = self.solution.equations.names;
        match self.solution.holds(column) {
            ColumnContent::Coordinate { index, order } if order < 3 => {
                Some(names.coordinate(order, index)).filter(|name| Names::is_descriptive(name))
            }
            _ => None,
        }
    }

    fn table(&self, table: u32, column: Column) -> Operand {
        self.solution.column(table, column, self.lane())
    }

    fn cells(&self, _: u32, _: Column) -> Vec<Register> {
        Vec::new()
    }

    fn stores(&self, column: u32) -> bool {
        // third derivatives are no results
        let is_third = matches!(self.solution.holds(column), ColumnContent::Coordinate { order: 3, .. });
        !is_third || self.solution.joined(column).is_some()
    }

    fn store(&self, column: u32, value: &Operand) -> Option<(String, Arguments)> {
        let place = self.place(column);
        let line = match value {
            // +0 where it is −0
            Operand::Number(value) if value.to_bits() << 1 == 0 => return None,
            Operand::Number(_) => format!("{place} = {value};"),
            Operand::Held { .. } => format!("{place} = {value} + 0.0;"),
        };
        Some((line, place.arguments()))
    }

    fn act(&self, op: Instruction, value: &Operand) -> (String, Arguments) {
        let (solver, bounds) = (self.solver, &self.solution.motion.bounds);
        let line = match (op, self.has_lanes) {
            (Instruction::Pivot { pivot, .. }, has_lanes) => {
                let pivot = solver.pivots()[pivot as usize];
                let lane = if has_lanes { "k, " } else { "" };
                format!("at.pivot({lane}{}, {value}, {});", pivot.turn, literal(pivot.weight))
            }
            (Instruction::Residual { row, .. }, false) => {
                format!("at.holds &= {} <= {};", value.absolute(), literal(bounds[row as usize]))
            }
            (Instruction::Residual { row, .. }, true) => strain(value, 1.0 / bounds[row as usize]),
            _ => String::new(),
        };
        (line, &["at"])
    }

    fn watch(&self, weight: u32, value: &Operand) -> (String, Arguments) {
        let weight = self.solver.weight(weight);
        let line = if self.has_lanes {
            strain(value, weight / LARGEST_MULTIPLIER)
        } else {
            format!("at.holds &= {value}.abs() * {} <= LARGEST_MULTIPLIER;", literal(weight))
        };
        (line, &["at"])
    }

    fn has_lanes(&self) -> bool {
        self.has_lanes
    }
}

/// Returns the line that monitors a value of a lane, whose product with `factor` must not exceed 1.
fn strain(value: &Operand, factor: f64) -> String {
    format!("at.watch(k, {value}, {});", literal(factor))
}
