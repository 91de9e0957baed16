//! Files that accompany emitted code, verbatim: those of `runtime` and of the crate `mechc_runtime`, and the limits to which they refer.
//!
//! Writers of code record the items that it uses in [`RuntimeDeps`], which adds transitive dependencies.

use super::limits;
use super::operations::{Callee, callee, callee_of_two};
use super::print::Page;
use mechc_engine::solver::Instruction;
use mechc_ir::program::Op;
use mechc_runtime::sources;
use std::collections::BTreeSet;

/// File that can accompany emitted code.
pub(super) struct File {
    /// Name of the module that it becomes.
    pub name: &'static str,
    /// Text of the source file that holds the module.
    source: &'static str,
    /// Files to which it refers.
    pub needs: &'static [&'static str],
    /// Limits to which it refers.
    pub limits: &'static [&'static str],
}

impl File {
    /// Returns the text of the module: the block `pub mod NAME { … }` of a source that holds several, else the whole source.
    fn text(&self) -> String {
        let block = self.source.split_once(&format!("\npub mod {} {{\n", self.name));
        let Some((block, _)) = block.and_then(|(_, rest)| rest.split_once("\n}\n")) else {
            return self.source.to_owned();
        };
        block.lines().map(|line| line.strip_prefix("    ").unwrap_or(line).to_owned() + "\n").collect()
    }
}

macro_rules! files {
    ($($name:literal is $text:expr; [$($needs:literal),*], [$($limits:ident),*];)*) => {
        /// All files, each after those that it needs.
        pub(super) const FILES: &[File] = &[
            $(File { name: $name, source: $text, needs: &[$($needs),*], limits: &[$(stringify!($limits)),*] },)*
        ];
    };
}

files! {
    "numbers" is include_str!("runtime/numbers.rs"); [], [];
    "error" is include_str!("runtime/error.rs"); [], [];
    "equations" is include_str!("runtime/equations.rs"); ["numbers"], [];
    "measured" is include_str!("runtime/measured.rs"); [], [];
    "work" is include_str!("runtime/work.rs"); ["equations"], [MOST_BRANCHES, MOST_HALVINGS];
    "solution" is include_str!("runtime/solution.rs"); ["numbers", "error", "equations", "measured"], [];
    "track" is include_str!("runtime/track.rs"); ["solution"], [];
    "running_max" is include_str!("runtime/solver_records.rs"); [], [];
    "pivots" is include_str!("runtime/solver_records.rs"); ["running_max", "solution"], [];
    "grid" is sources::GRID; [], [];
    "hermite" is sources::HERMITE; [], [];
    "neighbours" is sources::NEIGHBOURS; [], [];
    "newton" is include_str!("runtime/newton.rs"); ["numbers", "running_max", "solution", "grid"], [BORDER, LARGEST_CORRECTION];
    "branches" is include_str!("runtime/branches.rs"); ["equations", "solution", "neighbours", "work"], [MOST_HALVINGS, SLACK];
    "monitors" is include_str!("runtime/checks.rs"); ["numbers"], [];
    "redundant_rows" is include_str!("runtime/checks.rs"); [], [LARGEST_OPENING];
    "constraint_drift" is include_str!("runtime/checks.rs"); ["numbers", "equations"], [MISSES];
    "reach" is include_str!("runtime/reach.rs"); ["numbers", "error", "measured", "solution", "branches", "work"],
        [ACCURACY, MOST_BRANCHES, STEEP, STEEPEST];
    "state" is include_str!("runtime/state.rs"); ["numbers", "error", "measured", "solution", "track", "work"], [AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD];
    "assemble" is include_str!("runtime/assemble.rs"); ["numbers", "error", "solution", "branches", "reach", "state", "track", "work"],
        [FIRST_PARTS, LARGEST_CORRECTION, MOST_PARTS, MOST_SHORTER, MOST_TRIALS, SMALLEST_PART];
    "explain" is include_str!("runtime/explain.rs"); ["equations", "error", "solution", "branches", "state", "work"], [NEAR_FOLD, SINGULAR];
    "step" is include_str!("runtime/step.rs"); ["numbers", "error", "solution", "hermite", "branches", "reach", "state", "explain", "track", "work"],
        [CALM_BETWEEN, CALM_CORRECTION, CRUMB, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, LEAD,
            POSITION_JUMP, REST, VELOCITY_JUMP];
    "domain_boundaries" is include_str!("runtime/domain_boundaries.rs"); ["numbers", "error", "solution", "neighbours", "reach", "state", "work"],
        [FEWEST_LOOKS, GROWTH, LEAD, MOMENT, MOST_HALVINGS, MOST_LOOKS, PASSED, ROUNDING, SLOW, SPEED_JUMP];
    "blocks" is sources::BLOCKS; [], [];
    "pivoting" is include_str!("runtime/pivoting.rs"); ["numbers", "error", "solution", "branches", "grid", "blocks", "work"],
        [BORDER, ITERATIONS, MOST_SHORTER, MOST_TRIALS, NEAR];
    "pivoted_derivatives" is include_str!("runtime/derivatives.rs"); ["error", "solution", "pivoting"], [];
    "input_path" is include_str!("runtime/input_path.rs"); ["numbers", "equations", "solution", "state"], [FARTHEST_AHEAD];
    "follow" is include_str!("runtime/follow.rs"); ["numbers", "equations", "error", "solution", "branches", "reach", "state", "explain", "step", "input_path", "track", "work"],
        [CRUMB, FARTHEST_BEND, JUMP, LARGEST_CORRECTION, LARGEST_TURN, NEAR_TURN, NEAREST_TURN, POSITION_JUMP, SHORTEST_STEP,
            SINGULAR];
    "sensitivity" is include_str!("runtime/derivatives.rs"); ["numbers", "error", "solution", "state"], [];
    "input_driven_sensitivity" is include_str!("runtime/derivatives.rs"); ["error", "state", "input_path", "follow", "sensitivity"], [];
    "forces" is include_str!("runtime/reactions.rs"); ["numbers", "error", "solution", "state"], [STEEP];
    "input_driven_forces" is include_str!("runtime/reactions.rs"); ["state", "input_path", "follow", "forces"], [];
    "pivoted_forces" is include_str!("runtime/reactions.rs"); ["error", "solution", "pivoting", "forces"], [];
    "lane_solutions" is include_str!("runtime/lane_solutions.rs"); ["measured", "solution", "state"], [];
    "lane_residuals" is include_str!("runtime/solver_records.rs"); ["running_max", "lane_solutions"], [];
    "lane_pivots" is include_str!("runtime/solver_records.rs"); ["running_max", "lane_solutions"], [];
    "lane_newton" is include_str!("runtime/lane_newton.rs"); ["running_max", "lane_solutions", "grid"], [BORDER, LARGEST_CORRECTION];
    "lanes" is include_str!("runtime/lanes.rs"); ["numbers", "running_max", "error", "hermite", "branches", "state", "assemble", "step", "lane_solutions", "track", "work"],
        [CALM_BETWEEN, CALM_CORRECTION, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, MOST_STEPS, STEEP];
    "lane_following" is include_str!("runtime/lane_following.rs"); ["error", "input_path", "follow", "lane_solutions", "lanes", "work"], [MOST_STEPS_TO_FOLLOW];
    "sine_and_cosine" is sources::SINE_AND_COSINE; [], [];
    "without_branches" is sources::WITHOUT_BRANCHES; ["sine_and_cosine"], [];
    "select" is include_str!("runtime/functions.rs"); [], [];
    "either" is include_str!("runtime/functions.rs"); [], [];
    "piece" is include_str!("runtime/functions.rs"); [], [];
    "pick" is include_str!("runtime/functions.rs"); [], [];
    "sign" is include_str!("runtime/functions.rs"); [], [];
    "lesser" is include_str!("runtime/functions.rs"); [], [];
    "greater" is include_str!("runtime/functions.rs"); [], [];
}

/// Runtime dependencies of the code of a module.
#[derive(Clone, Debug, Default)]
pub(super) struct RuntimeDeps {
    files: BTreeSet<&'static str>,
    limits: BTreeSet<&'static str>,
    /// Used names, each with its file.
    names: BTreeSet<(&'static str, &'static str)>,
    libm: bool,
}

impl RuntimeDeps {
    /// Records the use of an item of a file, or of a limit of `limits`.
    pub fn name(&mut self, file: &'static str, name: &'static str) {
        self.names.insert((file, name));
        if file == "limits" {
            self.limits.insert(name);
        } else {
            self.files.insert(file);
        }
    }

    /// Adds a file that extends types of other files.
    pub fn file(&mut self, file: &'static str) {
        self.files.insert(file);
    }

    /// Records the use of a limit by its full path.
    pub fn limit(&mut self, name: &'static str) {
        self.limits.insert(name);
    }

    /// Records a call of the crate `libm`.
    pub fn libm(&mut self) {
        self.libm = true;
    }

    /// Adds the functions that instructions written as lines call, in lanes or alone.
    pub fn instructions(&mut self, instructions: &[Instruction], has_lanes: bool) {
        for instruction in instructions {
            match instruction {
                Instruction::Compute(Op::SinCos { .. }) if has_lanes => {
                    self.name("without_branches", "sin_cos_below_a_million");
                    self.file("lane_residuals");
                }
                Instruction::Compute(op) => self.operation(*op),
                Instruction::Pivot { .. } => self.file(if has_lanes { "lane_pivots" } else { "pivots" }),
                Instruction::Multiplier { .. } if !has_lanes => self.name("limits", "LARGEST_MULTIPLIER"),
                Instruction::Multiplier { .. } | Instruction::Residual { .. } if has_lanes => {
                    self.file("lane_residuals");
                }
                _ => {}
            }
        }
    }

    fn operation(&mut self, op: Op) {
        match op {
            Op::Unary { function, .. } => self.callee(callee(function)),
            Op::Binary { function, .. } => self.callee(callee_of_two(function)),
            Op::SinCos { .. } => self.name("sine_and_cosine", "sin_cos"),
            Op::Select { .. } => self.name("select", "select"),
            Op::Either { .. } => self.name("either", "either"),
            Op::Piece { .. } => self.name("piece", "piece"),
            Op::Pick { .. } => self.name("pick", "pick"),
            _ => {}
        }
    }

    /// Records a call of a function of numbers.
    fn callee(&mut self, callee: Callee) {
        match callee {
            Callee::Sine | Callee::Cosine => self.name("sine_and_cosine", "sin_cos"),
            Callee::Runtime(name) => self.name(name, name),
            Callee::Libm(_) => self.libm(),
            Callee::Core(_) => {}
        }
    }

    /// Returns whether the crate `libm` is called.
    pub fn needs_libm(&self) -> bool {
        self.libm
    }

    /// Prints the `use` items; `runtime` is the path of the runtime module.
    pub fn print(&self, runtime: &str, page: &mut Page) {
        for (file, name) in &self.names {
            page.line(&format!("use {runtime}::{file}::{name};"));
        }
        if !self.names.is_empty() {
            page.blank();
        }
    }

    /// Adds the dependencies of more code of the same module.
    pub fn add(&mut self, other: &RuntimeDeps) {
        self.include(other);
        self.names.extend(&other.names);
    }

    /// Adds the dependencies of another module of the same file.
    pub fn include(&mut self, other: &RuntimeDeps) {
        self.files.extend(&other.files);
        self.limits.extend(&other.limits);
        self.libm |= other.libm;
    }

    /// Prints the required files as a module, if there are any.
    pub fn print_runtime(&self, page: &mut Page) {
        let (mut wanted, mut limits) = (self.files.clone(), self.limits.clone());
        // dependencies precede the files that need them
        for file in FILES.iter().rev() {
            if wanted.contains(file.name) {
                wanted.extend(file.needs);
                limits.extend(file.limits);
            }
        }
        if wanted.is_empty() && limits.is_empty() {
            return;
        }
        page.docs("What solves the equations and follows the motion, the same for all mechanisms.");
        page.line("#[rustfmt::skip]");
        page.line("mod runtime {");
        for file in FILES.iter().filter(|file| wanted.contains(file.name)) {
            page.line(&format!("pub mod {} {{", file.name));
            page.text(&file.text());
            page.line("}\n");
        }
        if !limits.is_empty() {
            page.line("/// Where to stop, and what counts as large.");
            page.line("pub mod limits {");
            for name in limits {
                page.text(&limits::printed(name));
            }
            page.line("}");
        }
        page.line("}");
    }
}

#[cfg(test)]
mod tests {
    use super::FILES;
    use std::collections::BTreeSet;

    /// Returns the names that follow `super::` in a file, in paths and in braces.
    fn named(text: &str, after: &str) -> BTreeSet<String> {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let of = |rest: &str| match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or_default().to_owned(),
            None => rest.split(|c| !is_part(c)).next().unwrap_or_default().to_owned(),
        };
        let lists = text.split(after).skip(1).map(of);
        lists
            .flat_map(|list| list.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>())
            .filter(|name| !name.is_empty())
            .collect()
    }

    #[test]
    fn files_declare_their_dependencies() {
        for (number, file) in FILES.iter().enumerate() {
            if file.source.starts_with("// ") {
                continue; // of another crate
            }
            let mut needs = named(&file.text(), "super::");
            needs.remove("limits");
            let declared: BTreeSet<String> = file.needs.iter().map(|name| (*name).to_owned()).collect();
            let is_before = |name: &&str| FILES[..number].iter().any(|before| before.name == *name);
            assert!(file.needs.iter().all(is_before), "{} stands too early", file.name);
            assert_eq!(needs, declared, "{}", file.name);
            let limits: BTreeSet<String> = file.limits.iter().map(|name| (*name).to_owned()).collect();
            assert_eq!(named(&file.text(), "limits::"), limits, "{}", file.name);
        }
    }
}
