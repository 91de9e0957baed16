//! Names of the source made safe for the target: valid, of the usual case, and unique.

use crate::ir::ConstraintSystem;
use rustc_hash::FxHashSet;

/// Words that Rust keeps for itself.
const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn", "else",
    "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
    "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true",
    "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Longer names are cut; the documentation beside them has the whole.
const LONGEST: usize = 40;

/// Names in a body that are its own.
const RESERVED: &[&str] = &[
    "q", "qd", "qdd", "qddd", "t", "p", "m", "w", "x", "at", "out", "guess", "known", "sides", "newton", "sin_cos",
    "select", "either", "sign", "lesser", "greater", "piece", "pick", "on_grid", "libm", "blocks",
];

/// Longer names of variables would make lines that a formatter breaks.
const LONGEST_VARIABLE: usize = 20;

/// The names of a system's parameters and coordinates.
pub(super) struct Names {
    /// Fields of the parameters.
    pub params: Vec<String>,
    /// What they are called in a body.
    pub param_variables: Vec<String>,
    /// What coordinates, velocities and accelerations are called in a body.
    coordinates: [Vec<String>; 3],
}

impl Names {
    pub fn new(system: &ConstraintSystem) -> Names {
        let mut fields = Namer::default();
        // a coordinate of a point gives way to a name that is written so
        let is_path = |k: &usize| system.params[*k].name.contains('.');
        let (paths, plain): (Vec<usize>, Vec<usize>) = (0..system.params.len()).partition(is_path);
        let mut params = vec![String::new(); system.params.len()];
        for k in plain.into_iter().chain(paths) {
            params[k] = fields.snake(&system.params[k].name);
        }
        let mut variables = Namer::default();
        for word in RESERVED {
            variables.snake(word);
        }
        let mut variable = |wanted: String, short: String| {
            // what looks like a numbered one could be mistaken for it
            let is_plain = wanted.len() <= LONGEST_VARIABLE && Names::is_telling(&wanted);
            variables.snake(if is_plain { &wanted } else { &short })
        };
        let param_variables =
            params.iter().enumerate().map(|(k, name)| variable(name.clone(), format!("p{k}"))).collect();
        let coordinates = [("q", ""), ("qd", "_d"), ("qdd", "_dd")].map(|(array, end)| {
            let coordinates = system.coordinates.iter().enumerate();
            coordinates.map(|(k, c)| variable(words(&c.name).to_lowercase() + end, format!("{array}{k}"))).collect()
        });
        Names { params, param_variables, coordinates }
    }

    /// What a coordinate or a derivative of it is called in a body.
    pub fn coordinate(&self, order: usize, k: usize) -> String {
        self.coordinates.get(order).map_or_else(|| format!("qddd{k}"), |names| names[k].clone())
    }

    /// Whether a name is no letter with a number.
    pub fn is_telling(name: &str) -> bool {
        let number = name.trim_start_matches(|c: char| c.is_ascii_lowercase());
        number.is_empty() || !number.chars().all(|c| c.is_ascii_digit()) || name.len() - number.len() > 4
    }
}

/// Hands out names, each once.
#[derive(Default)]
pub(super) struct Namer {
    taken: FxHashSet<String>,
}

impl Namer {
    /// A name for a field or variable: `crank_length`.
    pub fn snake(&mut self, source: &str) -> String {
        self.unique(&words(source).to_lowercase(), '_')
    }

    /// A name for a variant: `CrankPin`.
    pub fn camel(&mut self, source: &str) -> String {
        let words = words(source);
        let capital = |word: &str| {
            let (first, rest) = word.split_at(word.len().min(1));
            first.to_uppercase() + rest
        };
        let name = words.split('_').map(capital).collect::<String>();
        // a number behind it stands without a line, which a variant does not have
        // `Self` is a word of its own
        let name = if name == "Self" { "SelfBody".to_owned() } else { name };
        self.numbered(&name, "")
    }

    /// A name for a constant: `CRANK_PHI`.
    pub fn constant(&mut self, source: &str) -> String {
        self.unique(&words(source).to_uppercase(), '_')
    }

    /// Names for constants, in order. Where two meet, the one that is no path keeps its name: `pen_x` before `pen.x`.
    pub fn constants(&mut self, sources: &[&str]) -> Vec<String> {
        let mut names = vec![String::new(); sources.len()];
        for paths in [false, true] {
            for (name, source) in names.iter_mut().zip(sources).filter(|(_, source)| source.contains('.') == paths) {
                *name = self.constant(source);
            }
        }
        names
    }

    fn unique(&mut self, name: &str, separator: char) -> String {
        let safe = if is_keyword(name) { format!("{name}{separator}") } else { name.to_owned() };
        self.numbered(&safe, &separator.to_string())
    }

    /// The name, with a number if it is taken.
    fn numbered(&mut self, name: &str, separator: &str) -> String {
        let mut candidate = name.to_owned();
        let mut count = 1;
        while !self.taken.insert(candidate.clone()) {
            count += 1;
            candidate = format!("{}{separator}{count}", name.trim_end_matches('_'));
        }
        candidate
    }
}

/// Whether a name is a word of Rust.
pub(super) fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name)
}

/// ASCII letters, digits and single underscores: `crank.phi` is `crank_phi`, `leg[3].x` is `leg_3_x`, `leg[-1]` is `leg_m1`, `é` is
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
    let cut = text.char_indices().nth(LONGEST).map_or(text.len(), |(at, _)| at);
    let text = text[..cut].trim_end_matches('_');
    match text.chars().next() {
        None => "unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{text}"),
        Some(_) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::Namer;

    #[test]
    fn names_are_valid_and_unique() {
        let mut namer = Namer::default();
        let names = ["fn", "type", "Self", "é", "R", "r", "crank.phi", "__", "_1", "R"].map(|name| namer.snake(name));
        assert_eq!(names, ["fn_", "type_", "self_", "u00e9", "r", "r_2", "crank_phi", "unnamed", "n1", "r_3"]);
        let mut namer = Namer::default();
        assert_eq!(["a.x", "A.x"].map(|name| namer.constant(name)), ["A_X", "A_X_2"]);
        let mut namer = Namer::default();
        assert_eq!(namer.constants(&["pen.x", "pen_x", "pen.y"]), ["PEN_X_2", "PEN_X", "PEN_Y"]);
    }
}
