//! What goes along with emitted code: files of `runtime` and of `math`, to the letter, and the limits that they name.
//!
//! Who writes code that calls something says so here ([`Uses`]); what else that needs follows.

use super::limits;
use super::operations::{Callee, callee, callee_of_two};
use super::print::Page;
use mechc_engine::solver::Instruction;
use mechc_ir::program::Op;
use mechc_runtime::sources;
use std::collections::BTreeSet;

/// A file that can go along.
pub(super) struct File {
    /// The module that it becomes.
    pub name: &'static str,
    pub text: &'static str,
    /// The files that it names.
    pub needs: &'static [&'static str],
    /// The limits that it names.
    pub limits: &'static [&'static str],
}

macro_rules! files {
    ($($name:literal is $text:expr; [$($needs:literal),*], [$($limits:ident),*];)*) => {
        /// All files, each behind those that it needs.
        pub(super) const FILES: &[File] = &[
            $(File { name: $name, text: $text, needs: &[$($needs),*], limits: &[$(stringify!($limits)),*] },)*
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
    "so_far" is include_str!("runtime/so_far.rs"); [], [];
    "pivots" is include_str!("runtime/pivots.rs"); ["so_far", "solution"], [];
    "grid" is sources::GRID; [], [];
    "hermite" is sources::HERMITE; [], [];
    "neighbours" is sources::NEIGHBOURS; [], [];
    "newton" is include_str!("runtime/newton.rs"); ["numbers", "so_far", "solution", "grid"], [BORDER, LARGEST_CORRECTION];
    "branches" is include_str!("runtime/branches.rs"); ["equations", "solution", "neighbours", "work"], [MOST_HALVINGS, SLACK];
    "watched" is include_str!("runtime/watched.rs"); ["numbers"], [];
    "left_out" is include_str!("runtime/left_out.rs"); [], [LARGEST_OPENING];
    "hold_apart" is include_str!("runtime/hold_apart.rs"); ["numbers", "equations"], [MISSES];
    "reach" is include_str!("runtime/reach.rs"); ["numbers", "error", "measured", "solution", "branches", "work"],
        [ACCURACY, MOST_BRANCHES, STEEP, STEEPEST];
    "state" is include_str!("runtime/state.rs"); ["numbers", "error", "measured", "solution", "track", "work"], [AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD];
    "assemble" is include_str!("runtime/assemble.rs"); ["numbers", "error", "solution", "branches", "reach", "state", "track", "work"],
        [FIRST_PARTS, LARGEST_CORRECTION, MOST_PARTS, MOST_SHORTER, MOST_TRIALS, SMALLEST_PART];
    "explain" is include_str!("runtime/explain.rs"); ["equations", "error", "solution", "branches", "state", "work"], [NEAR_FOLD, SINGULAR];
    "step" is include_str!("runtime/step.rs"); ["numbers", "error", "solution", "hermite", "branches", "reach", "state", "explain", "track", "work"],
        [CALM_BETWEEN, CALM_CORRECTION, CRUMB, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, LEAD,
            POSITION_JUMP, REST, VELOCITY_JUMP];
    "rims" is include_str!("runtime/rims.rs"); ["numbers", "error", "solution", "neighbours", "reach", "state", "work"],
        [FEWEST_LOOKS, GROWTH, LEAD, MOMENT, MOST_HALVINGS, MOST_LOOKS, PASSED, ROUNDING, SLOW, SPEED_JUMP];
    "blocks" is sources::BLOCKS; [], [];
    "pivoting" is include_str!("runtime/pivoting.rs"); ["numbers", "error", "solution", "branches", "grid", "blocks", "work"],
        [BORDER, ITERATIONS, MOST_SHORTER, MOST_TRIALS, NEAR];
    "pivoted_slopes" is include_str!("runtime/pivoted_slopes.rs"); ["error", "solution", "pivoting"], [];
    "way" is include_str!("runtime/way.rs"); ["numbers", "equations", "solution", "state"], [FARTHEST_AHEAD];
    "way_list" is include_str!("runtime/way_list.rs"); ["state", "way"], [];
    "follow" is include_str!("runtime/follow.rs"); ["numbers", "equations", "error", "solution", "branches", "reach", "state", "explain", "step", "way", "track", "work"],
        [CRUMB, FARTHEST_BEND, JUMP, LARGEST_CORRECTION, LARGEST_TURN, NEAR_TURN, NEAREST_TURN, POSITION_JUMP, SHORTEST_STEP,
            SINGULAR];
    "sensitivity" is include_str!("runtime/sensitivity.rs"); ["numbers", "error", "solution", "state"], [];
    "sensitivity_led" is include_str!("runtime/sensitivity_led.rs"); ["error", "state", "way", "follow", "sensitivity"], [];
    "forces" is include_str!("runtime/forces.rs"); ["numbers", "error", "solution", "state"], [STEEP];
    "forces_led" is include_str!("runtime/forces_led.rs"); ["state", "way", "follow", "forces"], [];
    "pivoted_forces" is include_str!("runtime/pivoted_forces.rs"); ["error", "solution", "pivoting", "forces"], [];
    "lane_solutions" is include_str!("runtime/lane_solutions.rs"); ["measured", "solution", "state"], [];
    "lane_strain" is include_str!("runtime/lane_strain.rs"); ["so_far", "lane_solutions"], [];
    "lane_pivots" is include_str!("runtime/lane_pivots.rs"); ["so_far", "lane_solutions"], [];
    "lane_newton" is include_str!("runtime/lane_newton.rs"); ["so_far", "lane_solutions", "grid"], [BORDER, LARGEST_CORRECTION];
    "lanes" is include_str!("runtime/lanes.rs"); ["numbers", "so_far", "error", "hermite", "branches", "state", "assemble", "step", "lane_solutions", "track", "work"],
        [CALM_BETWEEN, CALM_CORRECTION, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, MOST_STEPS, STEEP];
    "lane_follow" is include_str!("runtime/lane_follow.rs"); ["error", "way", "follow", "lane_solutions", "lanes", "work"], [MOST_STEPS_TO_FOLLOW];
    "sine_and_cosine" is sources::SINE_AND_COSINE; [], [];
    "without_branches" is sources::WITHOUT_BRANCHES; ["sine_and_cosine"], [];
    "select" is include_str!("runtime/functions/select.rs"); [], [];
    "either" is include_str!("runtime/functions/either.rs"); [], [];
    "piece" is include_str!("runtime/functions/piece.rs"); [], [];
    "pick" is include_str!("runtime/functions/pick.rs"); [], [];
    "sign" is include_str!("runtime/functions/sign.rs"); [], [];
    "lesser" is include_str!("runtime/functions/lesser.rs"); [], [];
    "greater" is include_str!("runtime/functions/greater.rs"); [], [];
    "codes" is mechc_ir::program::CODES; [], [];
    "tables" is include_str!("runtime/tables.rs"); ["codes", "sine_and_cosine", "select", "either", "piece", "pick"], [];
    "listed" is include_str!("runtime/listed.rs"); ["measured", "solution", "pivots", "grid", "newton", "tables"], [ITERATIONS];
    "listed_more" is include_str!("runtime/listed_more.rs"); ["solution", "newton", "tables", "listed"], [];
}

/// What the code of a module uses.
#[derive(Clone, Debug, Default)]
pub(super) struct Uses {
    files: BTreeSet<&'static str>,
    limits: BTreeSet<&'static str>,
    /// What it names, with the file.
    names: BTreeSet<(&'static str, &'static str)>,
    libm: bool,
}

impl Uses {
    /// A thing of a file, or a limit of `limits`, is named.
    pub fn name(&mut self, file: &'static str, name: &'static str) {
        self.names.insert((file, name));
        if file == "limits" {
            self.limits.insert(name);
        } else {
            self.files.insert(file);
        }
    }

    /// A file goes along that extends what others have.
    pub fn file(&mut self, file: &'static str) {
        self.files.insert(file);
    }

    /// A limit is named by its whole path.
    pub fn limit(&mut self, name: &'static str) {
        self.limits.insert(name);
    }

    /// The crate `libm` is called.
    pub fn libm(&mut self) {
        self.libm = true;
    }

    /// What instructions written as lines call, in lanes or alone.
    pub fn instructions(&mut self, instructions: &[Instruction], has_lanes: bool) {
        for instruction in instructions {
            match instruction {
                Instruction::Compute(Op::SinCos { .. }) if has_lanes => {
                    self.name("without_branches", "sin_cos_below_a_million");
                    self.file("lane_strain");
                }
                Instruction::Compute(op) => self.operation(*op),
                Instruction::Pivot { .. } => self.file(if has_lanes { "lane_pivots" } else { "pivots" }),
                Instruction::Multiplier { .. } if !has_lanes => self.name("limits", "LARGEST_MULTIPLIER"),
                Instruction::Multiplier { .. } | Instruction::Residual { .. } if has_lanes => self.file("lane_strain"),
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

    /// A function of numbers is called.
    pub fn callee(&mut self, callee: Callee) {
        match callee {
            Callee::Sine | Callee::Cosine => self.name("sine_and_cosine", "sin_cos"),
            Callee::Own(name) => self.name(name, name),
            Callee::Libm(_) => self.libm(),
            Callee::Core(_) => {}
        }
    }

    /// Whether the crate `libm` is called.
    pub fn needs_libm(&self) -> bool {
        self.libm
    }

    /// The lines that name what is used, of a module from which `runtime` is reached so.
    pub fn print(&self, runtime: &str, page: &mut Page) {
        for (file, name) in &self.names {
            page.line(&format!("use {runtime}::{file}::{name};"));
        }
        if !self.names.is_empty() {
            page.blank();
        }
    }

    /// More that the same module uses.
    pub fn add(&mut self, other: &Uses) {
        self.include(other);
        self.names.extend(&other.names);
    }

    /// What another module of the same file uses goes along too.
    pub fn include(&mut self, other: &Uses) {
        self.files.extend(&other.files);
        self.limits.extend(&other.limits);
        self.libm |= other.libm;
    }

    /// What goes along, as a module; nothing where that is nothing.
    pub fn goods(&self, page: &mut Page) {
        let (mut wanted, mut limits) = (self.files.clone(), self.limits.clone());
        // those that are needed stand before those that need them
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
            page.text(file.text);
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

    /// The names that follow `super::` in a file, in paths and in braces.
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
    fn files_name_what_goes_along_with_them() {
        for (number, file) in FILES.iter().enumerate() {
            if file.text.starts_with("// ") {
                continue; // of another crate
            }
            let mut needs = named(file.text, "super::");
            needs.remove("limits");
            let said: BTreeSet<String> = file.needs.iter().map(|name| (*name).to_owned()).collect();
            let is_before = |name: &&str| FILES[..number].iter().any(|before| before.name == *name);
            assert!(file.needs.iter().all(is_before), "{} stands too early", file.name);
            // what extends a type is not named
            assert!(
                needs.is_subset(&said) && said.difference(&needs).all(|name| name == "pivots"),
                "{}: {needs:?}",
                file.name
            );
            let limits: BTreeSet<String> = file.limits.iter().map(|name| (*name).to_owned()).collect();
            assert_eq!(named(file.text, "limits::"), limits, "{}", file.name);
        }
    }
}
