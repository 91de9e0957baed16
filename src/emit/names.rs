//! Names of the source made safe for the target: valid, of the usual case, and unique.

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

    /// A name for a constant: `CRANK_PHI`.
    pub fn constant(&mut self, source: &str) -> String {
        self.unique(&words(source).to_uppercase(), '_')
    }

    fn unique(&mut self, name: &str, separator: char) -> String {
        let safe = if KEYWORDS.contains(&name) { format!("{name}{separator}") } else { name.to_owned() };
        let mut candidate = safe.clone();
        let mut count = 1;
        while !self.taken.insert(candidate.clone()) {
            count += 1;
            candidate = format!("{}{separator}{count}", safe.trim_end_matches(separator));
        }
        candidate
    }
}

/// ASCII letters, digits and single underscores: `crank.phi` is `crank_phi`, `é` is `u00e9`, `gearA` stays one word.
fn words(source: &str) -> String {
    let mut text = String::new();
    for c in source.chars() {
        if c.is_ascii_alphanumeric() {
            text.push(c);
        } else if c == '_' || c == '.' || c == ' ' {
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
    }
}
