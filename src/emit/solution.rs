//! The solver's operations as a function that solves for position, velocity and acceleration at a time.

use super::code::{Code, Function, Input, MODULE, Out, Scene, absolute};
use super::equations::Equations;
use super::names::Names;
use super::tape::{self, Book, Notes, Shared, Tape};
use super::text::{constant, documented, lines, literal};
use super::{Motion, Unit};
use crate::layout::RowLayout;
use crate::program::{Column, Register};
use crate::solver::{Instruction, Segment, Solver};
use crate::tolerances::solving::lanes::{HALF_A_CELL, ITERATIONS, LARGEST_CORRECTION};
use crate::tolerances::solving::solver::LARGEST_MULTIPLIER;
use crate::tolerances::steps::march::{FEWEST_STEPS, SMALLEST_STEP};
use rustc_hash::FxHashMap;

/// What the solver's function is written from.
pub(super) struct Solution<'s> {
    pub unit: &'s Unit<'s>,
    pub motion: &'s Motion,
    pub equations: &'s Equations<'s>,
    /// Registers of the program that follow from parameters alone, by their places in `known`.
    pub known: FxHashMap<Register, usize>,
    /// Columns of what measures join that is no result, in order.
    pub joined: Vec<u32>,
}

impl<'s> Solution<'s> {
    pub fn new(unit: &'s Unit<'s>, motion: &'s Motion, equations: &'s Equations<'s>) -> Solution<'s> {
        let joined = joined(&motion.solver);
        let mut solution = Solution { unit, motion, equations, known: FxHashMap::default(), joined };
        let instructions = || {
            let sensitive = motion.sensitive.iter().flat_map(Solver::instructions);
            motion.solver.instructions().iter().chain(sensitive)
        };
        for instruction in instructions() {
            if let Some((table, column)) = instruction.column()
                && !equations.is_constant(table, column)
            {
                // one behind the other
                unit.program.tables()[table as usize].column(column).for_each(|cell| solution.know(cell));
            }
        }
        for instruction in instructions() {
            if let Instruction::Load { from, .. } = *instruction
                && from >= unit.program.inputs.time
                && !unit.program.inputs.all_signals().contains(&from)
                && !equations.sides.contains_key(&from)
            {
                solution.know(from);
            }
        }
        solution
    }

    /// Gives a register a place in `known`.
    fn know(&mut self, register: Register) {
        let next = self.known.len();
        self.known.entry(register).or_insert(next);
    }

    /// What a column of a table is called.
    fn column(&self, table: u32, column: Column) -> String {
        if self.equations.is_constant(table, column) {
            return self.equations.table(table, column);
        }
        let cells = self.unit.program.tables()[table as usize].column(column);
        let first = self.known.get(&cells.start).copied().unwrap_or(0);
        format!("m.known[{first}..{}]", first + cells.len())
    }

    /// Whether anything is left to iterate for.
    pub fn has_newton(&self) -> bool {
        !self.motion.solver.tears().is_empty()
    }

    /// The registers that follow from parameters alone, in the order of their places.
    pub fn known_registers(&self) -> Vec<Register> {
        let mut registers: Vec<(usize, Register)> =
            self.known.iter().map(|(&register, &place)| (place, register)).collect();
        registers.sort_unstable();
        registers.into_iter().map(|(_, register)| register).collect()
    }

    /// The function, for one mechanism or for several lanes.
    pub fn function(&self, has_lanes: bool) -> String {
        let solver = &self.motion.solver;
        let code =
            Code { instructions: solver.instructions(), segments: solver.segments(), registers: solver.registers() };
        let names: Vec<String> = solver
            .tears()
            .iter()
            .take(20)
            .map(|&tear| format!("`{}`", self.unit.system.coordinates[tear as usize].name))
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
            out: Out::Given { begin: "at.begin(t);" },
            margin: if has_lanes { MODULE.len() } else { 0 },
        };
        let layout = *solver.layout();
        code.print(&SolverScene { solution: self, solver, layout, has_lanes }, &function)
    }

    /// The function that gives the derivatives of the coordinates by parameters too; none where they are not wanted.
    pub fn sensitive_function(&self) -> Option<String> {
        let solver = self.motion.sensitive.as_ref()?;
        let code =
            Code { instructions: solver.instructions(), segments: solver.segments(), registers: solver.registers() };
        let has_sides = !self.equations.sides.is_empty();
        let arguments = [
            ("guess", "&[f64; TEARS]"),
            ("t", "f64"),
            ("m", "&Model"),
            ("sides", "&Sides"),
            ("at", "&mut Solution"),
            ("by", "&mut [Q; PARAMS]"),
        ];
        let arguments = arguments.into_iter().filter(|(name, _)| has_sides || *name != "sides");
        let function = Function {
            name: "solve_by_params",
            docs: format!(
                "As [`solve`], with the derivatives of the coordinates by parameters.\n\n{} operations.",
                code.count()
            ),
            is_public: false,
            arguments: arguments.map(|(name, of)| (name, of.to_owned())).collect(),
            out: Out::Given { begin: "at.begin(t);" },
            margin: 0,
        };
        let layout = *solver.layout();
        Some(code.print(&SolverScene { solution: self, solver, layout, has_lanes: false }, &function))
    }

    /// The function that reads its operations from lists of numbers, with these lists.
    pub fn as_numbers(&self, template: &str, book: &mut Book) -> String {
        template.to_owned() + &self.lists(&self.motion.solver, "", book)
    }

    /// The function that gives the derivatives of the coordinates by parameters too, likewise; none where they are not wanted.
    pub fn sensitive_as_numbers(&self, template: &str, book: &mut Book) -> Option<String> {
        let solver = self.motion.sensitive.as_ref()?;
        let (_, solve) = template.split_once(SOLVE_AS_NUMBERS)?;
        let solve = solve
            .replace("fn solve(", "fn solve_by_params(")
            .replace("at: &mut Solution", "at: &mut Solution, by: &mut [Q; PARAMS]")
            .replace("at.begin(t);", "at.begin(t);\n    let mut all = Derivatives { at, by };")
            .replace("&mut v, at)", "&mut v, &mut all)")
            .replace("at.note(", "all.at.note(");
        let named = |text: String| {
            ["REGISTERS", "SEGMENTS", "SETTLING", "SOLVE"]
                .into_iter()
                .fold(text, |text, name| text.replace(name, &format!("{name}_BY_PARAMS")))
        };
        let results = (self.results() + self.joined.len() as u32).to_string();
        let lists = self.lists(solver, "_BY_PARAMS", book);
        Some(BY_PARAMS.replace("$results", &results) + "/// As [`solve`], with" + &named(solve) + &lists)
    }

    /// The lists of numbers of a solver's operations, by names with an ending.
    fn lists(&self, solver: &Solver, ending: &str, book: &mut Book) -> String {
        let Shared { instructions, segments, registers } =
            tape::share(solver.instructions(), solver.segments(), solver.registers());
        let notes = Notes {
            pivot: &|number| {
                let pivot = solver.pivots()[number as usize];
                (pivot.turn, pivot.weight)
            },
            weight: &|number| solver.weight(number),
            bound: &|row| self.motion.bounds[row as usize],
        };
        let instructions: Vec<Instruction> = instructions.into_iter().map(|each| self.listed(each)).collect();
        let Tape { words, starts } = book.encode(&instructions, self.equations, &self.known, &notes);
        let (mut list, mut settling) = (String::new(), Vec::new());
        for segment in &segments {
            let (range, tears) = match segment {
                Segment::Once(range) => (range, &[][..]),
                Segment::Newton { instructions, tears } => (instructions, tears.as_slice()),
            };
            let first = settling.len();
            settling.extend(tears.iter().map(|tear| {
                let sizes = [literal(tear.cell), literal(tear.scale)].join(", ");
                format!("([{}, {}], [{sizes}])", tear.x, tear.delta)
            }));
            let code = [starts[range.start], starts[range.end]];
            let tears = format!(", tears: [{first}, {}]", settling.len());
            let tears = if self.has_newton() { tears } else { String::new() };
            list += &format!("    Segment {{ code: {code:?}{tears} }},\n");
        }
        let solve = format!("solve{}", ending.to_lowercase());
        let mut text = format!("/// Registers of [`{solve}`].\nconst REGISTERS{ending}: usize = {registers};\n\n");
        text += &format!("/// What [`{solve}`] runs, in order.\n#[rustfmt::skip]\n");
        text += &format!("static SEGMENTS{ending}: [Segment; {}] = [\n{list}];\n\n", segments.len());
        if self.has_newton() {
            text += "/// Of each coordinate that Newton solves for: the registers of it and of its correction, the width of a cell of its\n\
                /// grid, and what it is judged against.\n#[rustfmt::skip]\n";
            text += &format!(
                "static SETTLING{ending}: [([usize; 2], [f64; 2]); {}] = [\n{}];\n\n",
                settling.len(),
                lines(&settling, "")
            );
        }
        text + &tape::list(&format!("The operations of [`{solve}`]."), &format!("SOLVE{ending}"), &words)
    }

    /// The place behind the lists of results of a solution, one behind the other.
    fn results(&self) -> u32 {
        let inputs = &self.unit.program.inputs;
        self.motion.solver.layout().printed as u32 + inputs.n * inputs.count
    }

    /// An operation whose column is the place in the lists of a solution, one behind the other: what is joined behind the results, and
    /// behind that the derivatives by parameters.
    fn listed(&self, op: Instruction) -> Instruction {
        let (layout, results) = (self.motion.solver.layout(), self.results());
        let place = |column: u32| match self.joined.binary_search(&column) {
            Ok(place) => results + place as u32,
            Err(_) if column >= layout.by_signal => {
                let place = column - layout.by_signal + layout.printed as u32;
                if place < results { place } else { place + self.joined.len() as u32 }
            }
            Err(_) => column,
        };
        match op {
            Instruction::Column { to, column } => Instruction::Column { to, column: place(column) },
            Instruction::Store { column, a } => Instruction::Store { column: place(column), a },
            op => op,
        }
    }

    /// By coordinate that Newton solves for: the width of a cell of its grid.
    fn cells(&self) -> Vec<f64> {
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

    /// The constants that the functions of the motion use.
    pub fn constants(&self, solve: &str, has_lanes: bool) -> String {
        let Motion { solver, q, from, to, .. } = self.motion;
        let (n, tears) = (q.len(), solver.tears());
        let coordinates = &self.unit.system.coordinates;
        let span = to.map_or(1.0, |to| if to > *from { to - from } else { 1.0 });
        let number = |docs: &str, name: &str, value: f64| {
            format!("{}const {name}: f64 = {};\n\n", documented(docs, ""), literal(value))
        };
        let numbers = |values: &mut dyn Iterator<Item = f64>| values.map(literal).collect::<Vec<String>>();
        let is_led = self.equations.is_led;
        let mut text = String::new();
        if !is_led {
            text += &format!(
                "/// The first time of the file's analysis (s), at which the mechanism is assembled.\n\
                 pub const START_TIME: f64 = {};\n\n",
                literal(*from)
            );
            text += &number("How long the file's analysis takes (s).", "SPAN", span);
            text += &("/// The longest step (s).\npub ".to_owned() + &number("", "LONGEST_STEP", span / FEWEST_STEPS));
            text += &number("The shortest step (s).", "SMALLEST_STEP", SMALLEST_STEP * span);
        }
        let iterates = self.has_newton() || self.motion.blocks.is_some();
        if iterates {
            text += &format!("/// Iterations of Newton at most.\nconst ITERATIONS: usize = {ITERATIONS};\n\n");
        }
        text += &number(
            "Newton's first correction at most, beside the size of a body or 1 rad.",
            "LARGEST_CORRECTION",
            LARGEST_CORRECTION,
        );
        if iterates {
            text += &number(
                "A correction of just half a cell of the grid, to rounding, stays in it.",
                "HALF_A_CELL",
                HALF_A_CELL,
            );
        }
        if solve.contains("LARGEST_MULTIPLIER") {
            text += &number("A multiplier beyond this loses digits.", "LARGEST_MULTIPLIER", LARGEST_MULTIPLIER);
        }
        text += "/// Number of coordinates that Newton solves for; the others follow.\n";
        text += &format!("const TEARS: usize = {};\n\n", tears.len());
        text += &constant(
            "What a change of each of them is judged against (m, or 1 rad).",
            "TEAR_SCALES",
            "f64",
            "TEARS",
            &numbers(&mut tears.iter().map(|&tear| coordinates[tear as usize].scale)),
        );
        if has_lanes {
            text += &constant(
                "The width of a cell of the grid of each of them.",
                "TEAR_CELLS",
                "f64",
                "TEARS",
                &numbers(&mut self.cells().into_iter()),
            );
        }
        if !is_led {
            text += &constant(
                "What a change of each coordinate is judged against.",
                "SCALES",
                "f64",
                "N",
                &numbers(&mut coordinates.iter().map(|coordinate| coordinate.scale)),
            );
            text +=
                &constant("The assembled position (m, rad).", "START", "f64", "N", &numbers(&mut q.iter().copied()));
        }
        text += "/// Number of blocks of equations whose determinants change with the position.\n";
        text += &format!("const TURNS: usize = {};\n\n", solver.turns().len());
        let turned: Vec<String> = solver.turns().iter().map(|turn| turn.is_negative.to_string()).collect();
        text +=
            &constant("Whether they are negative where all pivots are positive.", "TURNED", "bool", "TURNS", &turned);
        if !self.joined.is_empty() {
            text += "/// Number of values that measures join, beside those that are given out.\n";
            text += &format!("const JOINED: usize = {};\n\n", self.joined.len());
        }
        debug_assert_eq!(n, coordinates.len());
        text + &self.tables()
    }

    /// The tables for elimination with partial pivoting.
    fn tables(&self) -> String {
        let Some(tables) = &self.motion.blocks else {
            return String::new();
        };
        let cells: Vec<String> = tables.cells.iter().copied().map(literal).collect();
        let turning: Vec<String> = self.motion.solver.turns().iter().map(|turn| turn.block.to_string()).collect();
        let mut text = constant("The width of a cell of each coordinate's grid.", "CELLS", "f64", "N", &cells);
        text += "/// Number of blocks of equations that can be solved one after the other.\n";
        text += &format!("const BLOCKS: usize = {};\n\n", tables.sizes.len());
        text += &constant("The blocks whose determinants change.", "TURNING", "usize", "TURNS", &turning);
        text += "/// Numbers that the elimination of the largest block works on.\n";
        text += &format!("const WORK: usize = blocks::work_of({});\n\n", tables.largest());
        text += "/// What may be left of an equation, beside the norm of its row.\n";
        text += &format!("const TOLERANCE: f64 = {};\n\n", literal(self.motion.tolerance));
        text += "/// How the equations fall apart into blocks.\n#[rustfmt::skip]\nstatic EQUATIONS: blocks::Blocks<'static> = blocks::Blocks {\n";
        let mut list = |name: &str, values: Vec<String>| {
            text += &format!("    {name}: &[\n{}    ],\n", lines(&values, "    "));
        };
        let whole = |values: &[usize]| values.iter().map(usize::to_string).collect::<Vec<String>>();
        list("sizes", whole(&tables.sizes));
        list("rows", whole(&tables.rows));
        list("columns", whole(&tables.columns));
        list("starts", whole(&tables.starts));
        list("entries", whole(&tables.entries));
        list("places", whole(&tables.places));
        list("units", tables.units.iter().copied().map(literal).collect());
        text + "};\n\n"
    }

    /// The coordinates that Newton solves for, out of all.
    pub fn tears(&self) -> String {
        let tears: Vec<String> = self.motion.solver.tears().iter().map(|tear| format!("q[{tear}]")).collect();
        if tears.len() > MOST_TEARS_IN_LINE {
            let columns: Vec<String> = self.motion.solver.tears().iter().map(u32::to_string).collect();
            return constant("Which coordinates Newton solves for.", "TEAR_COLUMNS", "usize", "TEARS", &columns)
                + TEARS_BY_TABLE;
        }
        let body =
            if tears.is_empty() { "    []\n".to_owned() } else { format!("    [\n{}    ]\n", lines(&tears, "    ")) };
        let q = if tears.is_empty() { "_q" } else { "q" };
        format!(
            "/// Of all coordinates those that Newton solves for.\n#[rustfmt::skip]\nfn tears({q}: &[f64; N]) -> [f64; TEARS] {{\n{body}}}\n\n"
        )
    }
}

/// The columns that a solver stores to read them again, but those of results.
fn joined(solver: &Solver) -> Vec<u32> {
    let printed = solver.layout().printed as u32;
    let read = |op: &Instruction| match *op {
        Instruction::Column { column, .. } => Some(column).filter(|column| *column >= printed),
        _ => None,
    };
    let mut columns: Vec<u32> = solver.instructions().iter().filter_map(read).collect();
    columns.sort_unstable();
    columns.dedup();
    columns
}

/// Where the function begins that reads its operations from lists of numbers.
const SOLVE_AS_NUMBERS: &str = "/// Position, velocity and acceleration at a time, by";

/// What it leaves derivatives by parameters in.
const BY_PARAMS: &str = include_str!("runtime/by_params.rs");

/// More coordinates that Newton solves for are looked up in a table.
const MOST_TEARS_IN_LINE: usize = 64;

const TEARS_BY_TABLE: &str = "/// Of all coordinates those that Newton solves for.
fn tears(q: &[f64; N]) -> [f64; TEARS] {
    let mut tears = [0.0; TEARS];
    for (tear, column) in tears.iter_mut().zip(&TEAR_COLUMNS) {
        *tear = q.get(*column).copied().unwrap_or(f64::NAN);
    }
    tears
}

";

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

struct SolverScene<'s> {
    solution: &'s Solution<'s>,
    solver: &'s Solver,
    layout: RowLayout,
    has_lanes: bool,
}

impl SolverScene<'_> {
    /// What picks a lane.
    fn lane(&self) -> &'static str {
        if self.has_lanes { "[k]" } else { "" }
    }

    /// The place of a column among those that are joined.
    fn joined(&self, column: u32) -> Option<usize> {
        self.solution.joined.binary_search(&column).ok()
    }

    /// The kind of a column, its order and its number there.
    fn kind(&self, column: u32) -> (bool, usize, usize) {
        let n = self.solution.unit.program.inputs.n;
        for order in (0..4).rev() {
            let first = self.layout.coordinates[order];
            if column >= first && column < first + n {
                return (true, order, (column - first) as usize);
            }
            if order < 3 && column >= self.layout.measures[order] {
                return (false, order, (column - self.layout.measures[order]) as usize);
            }
        }
        (true, 0, 0)
    }
}

impl Scene for SolverScene<'_> {
    fn input(&self, register: Register) -> Input {
        debug_assert!(false, "register {register} has no operation");
        Input::Text("f64::NAN".to_owned())
    }

    fn load(&self, register: Register) -> String {
        if let Some(place) = self.solution.known.get(&register) {
            return format!("m{}.known[{place}]", self.lane());
        }
        match self.solution.equations.input(register) {
            Input::Bound { value, .. } => {
                let of = if self.solution.equations.is_led { "way." } else { "params." };
                format!("m{}.{}", self.lane(), value.replacen("p.", of, 1))
            }
            Input::Text(text) if text.starts_with("sides") => {
                text.replacen("sides", &format!("sides{}", self.lane()), 1)
            }
            Input::Text(text) => text,
        }
    }

    fn place(&self, column: u32) -> String {
        if let Some(place) = self.joined(column) {
            return format!("at.joined[{place}]{}", self.lane());
        }
        if let Some(k) = column.checked_sub(self.layout.by_signal) {
            let inputs = &self.solution.unit.program.inputs;
            let (number, k) = (k / inputs.n, k % inputs.n);
            return match number.checked_sub(inputs.count) {
                None => format!("at.by_signal[{number}][{k}]"),
                Some(param) => format!("by[{param}][{k}]"),
            };
        }
        match self.kind(column) {
            (true, order, k) => format!("at.{}[{k}]{}", super::equations::ARRAYS[order], self.lane()),
            (false, order, k) => {
                let of = if self.has_lanes { "" } else { "measures." };
                format!("at.{of}{}[{k}]{}", ["values", "rates", "accelerations"][order], self.lane())
            }
        }
    }

    fn name(&self, column: u32) -> Option<String> {
        let names: &Names = self.solution.equations.names;
        match self.kind(column) {
            _ if column >= self.layout.by_signal || self.joined(column).is_some() => None,
            (true, order, k) if order < 3 => Some(names.coordinate(order, k)).filter(|name| Names::is_telling(name)),
            _ => None,
        }
    }

    fn table(&self, table: u32, column: Column) -> String {
        let column = self.solution.column(table, column);
        column.strip_prefix("m.").map_or(column.clone(), |known| format!("m{}.{known}", self.lane()))
    }

    fn cells(&self, _: u32, _: Column) -> Vec<Register> {
        Vec::new()
    }

    fn store(&self, column: u32, value: &str) -> Option<String> {
        match self.kind(column) {
            (true, 3, _) if column < self.layout.by_signal && self.joined(column).is_none() => None,
            _ => match value.parse::<f64>() {
                // +0 where it is −0
                Ok(number) => Some(number + 0.0)
                    .filter(|number| number.to_bits() != 0)
                    .map(|number| format!("{} = {};", self.place(column), literal(number))),
                Err(_) => Some(format!("{} = {value} + 0.0;", self.place(column))),
            },
        }
    }

    fn act(&self, op: Instruction, value: &str) -> String {
        let (solver, bounds) = (self.solver, &self.solution.motion.bounds);
        match (op, self.has_lanes) {
            (Instruction::Pivot { pivot, .. }, has_lanes) => {
                let pivot = solver.pivots()[pivot as usize];
                let lane = if has_lanes { "k, " } else { "" };
                format!("at.pivot({lane}{}, {value}, {});", pivot.turn, literal(pivot.weight))
            }
            (Instruction::Residual { row, .. }, false) => {
                format!("at.holds &= {} <= {};", absolute(value), literal(bounds[row as usize]))
            }
            (Instruction::Residual { row, .. }, true) => strain(value, 1.0 / bounds[row as usize]),
            _ => String::new(),
        }
    }

    fn watch(&self, weight: u32, value: &str) -> String {
        let weight = self.solver.weight(weight);
        if self.has_lanes {
            return strain(value, weight / LARGEST_MULTIPLIER);
        }
        format!("at.holds &= {value}.abs() * {} <= LARGEST_MULTIPLIER;", literal(weight))
    }

    fn has_lanes(&self) -> bool {
        self.has_lanes
    }
}

/// The line that watches a value of a lane, which must not be above 1 when it is multiplied by a factor.
fn strain(value: &str, factor: f64) -> String {
    format!("at.watch(k, {value}, {});", literal(factor))
}
