//! Solution with partial pivoting, for positions in which the order of elimination loses digits.

use super::Writer;
use crate::equations::{FunctionSpec, Given};
use crate::print::{Head, Page};
use crate::solution::Solution;
use crate::text::{constant, literal};
use mechc_engine::solver::BlockTables;
use mechc_ir::program::Register;

impl Writer<'_> {
    /// Prints the code for partial pivoting, unless a block is too large for it.
    pub fn pivoting(&self, solution: &Solution<'_>, page: &mut Page) {
        let Some(tables) = &solution.motion.blocks else {
            return;
        };
        self.requires("pivoting", "Pivoting");
        self.blocks(solution, tables, page);
        let is_input_driven = self.equations.is_input_driven;
        if is_input_driven {
            self.measures("fn", page);
            self.rights("signal", self.unit.program.outputs.by_inputs(), "SIGNALS", page);
        }
        self.transposed(tables, page);
        let has_varied = self.equations.has_varied();
        page.item("impl Pivoting for Model", |page| {
            page.line("type Work = [f64; WORK];");
            page.line("type Blocks = [bool; BLOCKS];");
            page.line(&format!("type Varied = [f64; {}];", if has_varied { "VARIED" } else { "0" }));
            page.line(&format!("type Rights = [Q; {}];\n", if is_input_driven { "SIGNALS" } else { "0" }));
            page.line(&format!("const TOLERANCE: f64 = {};", literal(solution.motion.tolerance)));
            if self.has_jerk() {
                page.line("const HAS_JERK: bool = true;");
            }
            if has_varied {
                let variations = self.unit.system.variations();
                let by_two: Vec<String> = variations.iter().map(|of| of.by.1.is_some().to_string()).collect();
                page.line("#[rustfmt::skip]");
                page.list("const IS_BY_TWO: &'static [bool] = &[", &by_two, "];");
            }
            page.blank();
            let all = [
                ("blocks", "Blocks<'static>", "EQUATIONS"),
                ("turning", "[usize]", "TURNING"),
                ("cells", "Q", "CELLS"),
            ];
            for (name, of, value) in all {
                let head = Head { kind: "fn", name, arguments: &[], result: &format!("&'static {of}") };
                page.function(&head, |page| page.line(&format!("&{value}")));
            }
            self.right_sides(page);
            self.pivoted_multipliers(page);
            self.measured_by(page);
        });
    }

    /// Returns whether measures hold third derivatives that are solved for.
    fn has_jerk(&self) -> bool {
        !self.unit.program.outputs.jerk().is_empty() && self.unit.system.jerk().is_some()
    }

    /// Prints the methods for right sides.
    fn right_sides(&self, page: &mut Page) {
        let orders = ("[q, qd, qdd]", "[&Q; 3]");
        if self.has_jerk() {
            self.right_side(page, "jerk", &[orders], &["q", "qd", "qdd"], "Q");
        }
        if self.equations.has_varied() {
            let arguments = [orders, ("varied", "&[f64; VARIED]")];
            self.right_side(page, "varied_right", &arguments, &["q", "qd", "qdd", "varied"], "[f64; VARIED]");
        }
        if self.equations.is_input_driven {
            self.method(page, "rights", "rights_by_signal", &[("q", "&Q")], "[Q; SIGNALS]", Given::All);
        } else {
            let arguments = [("&self", ""), ("_q", "&Q"), ("_t", "f64"), ("_sides", "&Sides")];
            let head = Head { kind: "fn", name: "rights", arguments: &arguments, result: "[Q; 0]" };
            page.function(&head, |page| page.line("[]"));
        }
    }

    pub fn right_side(&self, page: &mut Page, name: &str, more: &[(&str, &str)], names: &[&str], result: &str) {
        let sides = if self.has_sides() { "sides" } else { "_sides" };
        let mut arguments = vec![("&self", "")];
        arguments.extend(more);
        arguments.extend([("t", "f64"), (sides, "&Sides")]);
        page.function(&Head { kind: "fn", name, arguments: &arguments, result }, |page| {
            page.line(&self.call(&self.on_sides(name), names, Given::All));
        });
    }

    /// Prints the measures of the result.
    fn measured_by(&self, page: &mut Page) {
        let (has_measures, has_varied) = (!self.unit.system.measures().is_empty(), self.equations.has_varied());
        let has_forces = self.measures_hold_forces();
        let has_jerk = self.unit.system.jerk().is_some();
        let varied = if has_varied { "&[f64; VARIED]" } else { "&[f64; 0]" };
        let head = |arguments, result| Head { kind: "fn", name: "measured", arguments, result };
        if !has_measures {
            let arguments =
                [("&self", ""), ("_orders", "[&Q; 4]"), ("_varied", varied), ("_multipliers", "&Q"), ("_t", "f64")];
            page.line(&format!(
                "fn measured(&self, {}) {{}}\n",
                arguments[1..].iter().map(|(name, of)| format!("{name}: {of}")).collect::<Vec<_>>().join(", ")
            ));
            return;
        }
        let orders = if has_jerk { "[q, qd, qdd, qddd]" } else { "[q, qd, qdd, _]" };
        let name = if has_varied { "varied" } else { "_varied" };
        let multipliers = if has_forces { "multipliers" } else { "_multipliers" };
        let arguments = [("&self", ""), (orders, "[&Q; 4]"), (name, varied), (multipliers, "&Q"), ("t", "f64")];
        let mut names = vec!["q", "qd", "qdd"];
        names.extend(has_jerk.then_some("qddd"));
        names.extend(has_varied.then_some("varied"));
        names.extend(has_forces.then_some("multipliers"));
        page.function(&head(&arguments, "Measures"), |page| page.line(&self.call("measures", &names, Given::None)));
    }

    /// Prints the fallback for the case that solving fails.
    pub fn pivoted(&self, page: &mut Page) {
        self.requires("pivoting", "solve_with_pivoting");
        self.requires("error", "Fault");
        let arguments = [("&self", ""), ("q", "&Q"), ("t", "f64"), ("sides", "&Sides"), ("_at", "&Solution")];
        let head = Head { kind: "fn", name: "pivoted", arguments: &arguments, result: "Result<Solution, Fault>" };
        page.function(&head, |page| page.line("solve_with_pivoting(self, q, t, sides)"));
    }

    /// Prints the partition of the equations into blocks.
    fn blocks(&self, solution: &Solution<'_>, tables: &BlockTables, page: &mut Page) {
        self.requires("blocks", "Blocks");
        self.requires("blocks", "work_of");
        let cells: Vec<String> = tables.cells.iter().copied().map(literal).collect();
        page.text(&constant("The width of a cell of each coordinate's grid.", "CELLS", "f64", "N", &cells));
        let docs = "Number of blocks of equations that can be solved one after the other.";
        page.constant(docs, "const BLOCKS: usize", &tables.sizes.len().to_string());
        let turning: Vec<String> = solution.motion.solver.turns().iter().map(|turn| turn.block.to_string()).collect();
        page.text(&constant("The blocks whose determinants change.", "TURNING", "usize", "TURNS", &turning));
        let docs = "Numbers that the elimination of the largest block works on.";
        page.constant(docs, "const WORK: usize", &format!("work_of({})", tables.largest()));
        Self::table_of_blocks("EQUATIONS", "How the equations fall apart into blocks.", tables, page);
    }

    /// Prints the static that describes the blocks of equations.
    pub fn table_of_blocks(name: &str, docs: &str, tables: &BlockTables, page: &mut Page) {
        let whole = |values: &[usize]| values.iter().map(usize::to_string).collect::<Vec<String>>();
        let lists = [
            ("sizes", whole(&tables.sizes)),
            ("rows", whole(&tables.rows)),
            ("columns", whole(&tables.columns)),
            ("starts", whole(&tables.starts)),
            ("entries", whole(&tables.entries)),
            ("places", whole(&tables.places)),
            ("units", tables.units.iter().copied().map(literal).collect()),
        ];
        page.docs(docs);
        page.line("#[rustfmt::skip]");
        page.block(&format!("static {name}: Blocks<'static> = Blocks"), |page| {
            for (name, values) in &lists {
                page.list(&format!("{name}: &["), values, "],");
            }
        });
        page.end_statement();
    }

    /// Prints the right sides for the derivatives of the coordinates by signals or parameters.
    pub fn rights<'l>(&self, by: &str, lists: impl Iterator<Item = &'l [Register]>, count: &str, page: &mut Page) {
        let all: Vec<Register> = lists.flatten().copied().collect();
        let name = format!("all_rights_by_{by}");
        page.docs(&format!("The right sides of the equations for the derivatives of the coordinates by each {by}."));
        let of = if self.equations.is_input_driven { "&Path" } else { "&Params" };
        let mut arguments = vec![("q", "&Q"), ("t", "f64"), ("p", of)];
        arguments.extend(self.has_sides().then_some(("sides", "&Sides")));
        let result = format!("[Q; {count}]");
        let head = Head { kind: "fn", name: &format!("rights_by_{by}"), arguments: &arguments, result: &result };
        page.function(&head, |page| {
            let names: Vec<&str> = arguments.iter().map(|(name, _)| *name).collect();
            page.line(&format!("let mut all = {name}({}).into_iter();", names.join(", ")));
            page.line("let mut next = || all.next().unwrap_or(f64::NAN);");
            page.line("core::array::from_fn(|_| core::array::from_fn(|_| next()))");
        });
        self.equations.function(
            &FunctionSpec {
                orders: 1,
                ..FunctionSpec::new(
                    &name,
                    &format!("The partial derivatives of the equations by each {by}, negated, one behind the other."),
                    &all,
                    &format!("N * {count}"),
                )
            },
            page,
        );
    }
}
