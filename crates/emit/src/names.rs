//! Names of the source made safe for the target: valid, of the usual case, and unique.

use mechc_ir::{ConstraintSystem, Input};
use rustc_hash::FxHashSet;

/// Keywords of Rust.
const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn", "else",
    "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
    "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true",
    "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Length beyond which names are cut, except paths; the adjacent documentation has the full name.
const LONGEST: usize = 40;

/// Names that emitted function bodies use themselves.
const RESERVED: &[&str] = &[
    "q", "qd", "qdd", "qddd", "t", "p", "m", "w", "x", "at", "out", "guess", "derived", "sides", "newton", "sin_cos",
    "select", "either", "sign", "lesser", "greater", "piece", "pick", "on_grid", "libm", "blocks",
];

/// Name of time, also among inputs.
pub(super) const TIME: &str = "t";

/// Name of the array of derivatives by inputs and parameters.
pub(super) const VARIED: &str = "varied";

/// Name of the array that forces are written to.
pub(super) const FORCES: &str = "forces";

/// Name of the array of multipliers, emitted if forces are requested.
pub(super) const MULTIPLIERS: &str = "multipliers";

/// Length of a variable's name beyond which rustfmt would break its lines.
const LONGEST_VARIABLE: usize = 20;

/// Names of a system's parameters and coordinates.
pub(super) struct Names {
    /// Paths of the parameters: `leg[1].shank`.
    pub params: Vec<String>,
    /// Names of the parameters in a body.
    pub param_variables: Vec<String>,
    /// Names of coordinates, velocities and accelerations in a body.
    coordinates: [Vec<String>; 3],
    /// Fields of the inputs, where they are signals.
    pub inputs: Vec<String>,
    /// Names of the inputs' values, rates and accelerations in a body.
    signals: [Vec<String>; 3],
}

impl Names {
    /// Creates the names for a system, given the paths of its parameters. `arrays` are names that bodies use too.
    pub fn new(system: &ConstraintSystem, paths: Vec<String>, arrays: &[String]) -> Names {
        let params: Vec<String> = Case::Snake.names(system.params().iter().map(|param| param.name.as_str()));
        let mut variables = Namer::default();
        for word in RESERVED {
            variables.snake(word);
        }
        if !system.variations().is_empty() {
            variables.snake(VARIED);
        }
        if system.forces().is_some() {
            variables.snake(MULTIPLIERS);
            variables.snake(FORCES);
        }
        for array in arrays {
            variables.snake(array);
        }
        let mut variable = |wanted: String, short: String| {
            // a name that looks like a numbered one could be mistaken for it
            let is_plain = wanted.len() <= LONGEST_VARIABLE && Names::is_descriptive(&wanted);
            variables.snake(if is_plain { &wanted } else { &short })
        };
        let param_variables =
            params.iter().enumerate().map(|(k, name)| variable(name.clone(), format!("p{k}"))).collect();
        let coordinates = [("q", ""), ("qd", "_d"), ("qdd", "_dd")].map(|(array, end)| {
            let coordinates = system.coordinates().iter().enumerate();
            coordinates.map(|(k, c)| variable(words(&c.name).to_lowercase() + end, format!("{array}{k}"))).collect()
        });
        let inputs = Case::Snake.names_of_inputs(system.inputs());
        let signals = ["", "_d", "_dd"].map(|end| {
            let signals = inputs.iter().enumerate();
            signals
                .map(|(k, name)| variable(name.trim_end_matches('_').to_owned() + end, format!("u{k}{end}")))
                .collect()
        });
        Names { params: paths, param_variables, coordinates, inputs, signals }
    }

    /// Returns the name of a signal or of a derivative of it in a body.
    pub fn signal(&self, signal: usize, order: usize) -> &str {
        self.signals.get(order).and_then(|names| names.get(signal)).map_or("u", String::as_str)
    }

    /// Returns the name of a coordinate or of a derivative of it in a body.
    pub fn coordinate(&self, order: usize, k: usize) -> String {
        self.coordinates.get(order).map_or_else(|| format!("qddd{k}"), |names| names[k].clone())
    }

    /// Returns whether a name is more than lower-case letters with a number.
    pub fn is_descriptive(name: &str) -> bool {
        let number = name.trim_start_matches(|c: char| c.is_ascii_lowercase());
        number.is_empty() || !number.chars().all(|c| c.is_ascii_digit()) || name.len() - number.len() > 4
    }
}

/// Case of an identifier.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Case {
    /// Case of fields: `crank_length`.
    Snake,
    /// Case of variants: `CrankPin`.
    Camel,
    /// Case of constants: `CRANK_PHI`.
    Constant,
}

impl Case {
    /// Returns unique names, in the order of their sources. Of colliding names the one with fewer path separators stays (`pen_x` before
    /// `pen.x`, `leg_0.x` before `leg[0].x`), and among equals the first; the others get numbers that collide with no third name. So a
    /// later declaration takes a name only from a path that spells it.
    pub fn names<'s>(self, sources: impl IntoIterator<Item = &'s str>) -> Vec<String> {
        let sources: Vec<&str> = sources.into_iter().collect();
        let mut order: Vec<usize> = (0..sources.len()).collect();
        let is_path = |c: &char| ".[ ".contains(*c);
        order.sort_by_key(|&k| sources[k].chars().filter(is_path).count());
        let (mut namer, mut names) = (Namer::default(), vec![String::new(); sources.len()]);
        let mut colliding = Vec::new();
        for k in order {
            names[k] = self.name(sources[k]);
            if !namer.taken.insert(names[k].clone()) {
                colliding.push(k);
            }
        }
        for k in colliding {
            names[k] = namer.name(self, sources[k]);
        }
        names
    }

    /// Converts a source to an identifier, which may not be unique.
    fn name(self, source: &str) -> String {
        let words = words(source);
        match self {
            Case::Snake => safe(words.to_lowercase()),
            Case::Camel => {
                let capital = |word: &str| {
                    let (first, rest) = word.split_at(word.len().min(1));
                    first.to_uppercase() + rest
                };
                let name = words.split('_').map(capital).collect::<String>();
                // `Self` is a word of its own
                if name == "Self" { "SelfBody".to_owned() } else { name }
            }
            Case::Constant => words.to_uppercase(),
        }
    }

    /// Returns the names of inputs; time comes last if it is an input. The name `t` is reserved for time even if no formula contains
    /// it, so that a formula with time changes no name of an input.
    pub fn names_of_inputs(self, inputs: &[Input]) -> Vec<String> {
        let named = inputs.iter().filter(|input| !input.is_time()).map(|input| input.name.as_str());
        let mut names = self.names(std::iter::once(TIME).chain(named));
        names.rotate_left(1);
        names.truncate(inputs.len());
        names
    }
}

/// Allocator of unique names.
#[derive(Default)]
pub(super) struct Namer {
    taken: FxHashSet<String>,
}

impl Namer {
    /// Returns a unique name for a field or variable: `crank_length`.
    pub fn snake(&mut self, source: &str) -> String {
        self.name(Case::Snake, source)
    }

    /// Returns a unique name for a constant: `CRANK_PHI`.
    pub fn constant(&mut self, source: &str) -> String {
        self.name(Case::Constant, source)
    }

    /// Returns a unique name, with a number if the plain one is taken.
    fn name(&mut self, case: Case, source: &str) -> String {
        // a number behind it stands without a line in a variant
        let separator = if case == Case::Camel { "" } else { "_" };
        let name = case.name(source);
        let mut candidate = name.clone();
        let mut count = 1;
        while !self.taken.insert(candidate.clone()) {
            count += 1;
            candidate = format!("{}{separator}{count}", name.trim_end_matches('_'));
        }
        candidate
    }
}

/// Returns the name, with `_` appended if it is a keyword of Rust.
fn safe(name: String) -> String {
    if is_keyword(&name) { name + "_" } else { name }
}

/// Returns whether a name is a keyword of Rust.
pub(super) fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name)
}

/// Returns ASCII letters, digits and single underscores: `crank.phi` is `crank_phi`, `leg[3].x` is `leg_3_x`, `leg[-1]` is `leg_m1`, `é` is
/// `u00e9`, `gearA` stays one word.
fn words(source: &str) -> String {
    let mut text = String::new();
    for c in source.chars() {
        if c.is_ascii_alphanumeric() {
            text.push(c);
        } else if c == '-' && text.ends_with('_') {
            text.push('m');
        } else if "_. [],".contains(c) {
            if !text.is_empty() && !text.ends_with('_') {
                text.push('_');
            }
        } else {
            text += &format!("u{:04x}", u32::from(c));
        }
    }
    // cut paths could not be distinguished
    let longest = if source.contains(['.', '[']) { usize::MAX } else { LONGEST };
    let cut = text.char_indices().nth(longest).map_or(text.len(), |(at, _)| at);
    let text = text[..cut].trim_end_matches('_');
    match text.chars().next() {
        None => "unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{text}"),
        Some(_) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Case, Namer};

    #[test]
    fn names_are_valid_and_unique() {
        let mut namer = Namer::default();
        let names = ["fn", "type", "Self", "é", "R", "r", "crank.phi", "__", "_1", "R"].map(|name| namer.snake(name));
        assert_eq!(names, ["fn_", "type_", "self_", "u00e9", "r", "r_2", "crank_phi", "unnamed", "n1", "r_3"]);
        let mut namer = Namer::default();
        assert_eq!(["a.x", "A.x"].map(|name| namer.constant(name)), ["A_X", "A_X_2"]);
    }

    #[test]
    fn plainer_names_win_collisions() {
        let names = |sources: [&'static str; 3]| Case::Constant.names(sources);
        assert_eq!(names(["pen.x", "pen_x", "pen.y"]), ["PEN_X_2", "PEN_X", "PEN_Y"]);
        assert_eq!(names(["leg[0].x", "leg[1].x", "leg_0.x"]), ["LEG_0_X_2", "LEG_1_X", "LEG_0_X"]);
        assert_eq!(Case::Snake.names(["R", "r", "s"]), ["r", "r_2", "s"]);
        assert_eq!(Case::Snake.names(["R", "r", "r_2"]), ["r", "r_3", "r_2"]);
        assert_eq!(Case::Snake.names(["Fn", "fn", "r"]), ["fn_", "fn_2", "r"]);
        assert_eq!(Case::Camel.names(["leg[0]", "leg_0"]), ["Leg02", "Leg0"]);
    }

    #[test]
    fn paths_are_not_cut() {
        let path = format!("front.{}.x", "a".repeat(60));
        assert_eq!(Case::Snake.names([path.as_str()]), [path.replace('.', "_")]);
        assert_eq!(Case::Snake.names(["a".repeat(60).as_str()]), ["a".repeat(40)]);
    }
}
