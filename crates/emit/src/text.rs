//! Pieces of Rust text, formatted as rustfmt does.

/// Largest length of a line.
pub(super) const LONGEST_LINE: usize = 100;

/// Numbers on a line of an array.
const ON_A_LINE: usize = 4;

/// Returns a literal that reads back to the same bits.
pub(super) fn literal(value: f64) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else if value.is_nan() {
        "f64::NAN".to_owned()
    } else if value > 0.0 {
        "f64::INFINITY".to_owned()
    } else {
        "f64::NEG_INFINITY".to_owned()
    }
}

/// Returns a foreign text fit for a comment, without line breaks and bidirectional controls.
pub(super) fn one_line(text: &str) -> String {
    let is_unfit =
        |c: char| c.is_control() || c == '`' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    text.replace(is_unfit, " ")
}

/// Returns the display form of an SI unit.
pub(super) fn unit(unit: &str) -> &str {
    if matches!(unit, "" | "1") { "a pure number" } else { unit }
}

/// Returns documentation as `///` lines.
pub(super) fn documented(docs: &str, indent: &str) -> String {
    docs.lines().map(|line| format!("{indent}/// {line}").trim_end().to_owned() + "\n").collect()
}

/// Returns the head of a function that is later indented by `margin` columns; unused arguments begin with `_`.
pub(super) fn signature(
    visibility: &str,
    name: &str,
    arguments: &[(&str, &str)],
    result: &str,
    is_used: &dyn Fn(&str) -> bool,
    margin: usize,
) -> String {
    let mark = |name: &str| if is_used(name) { name.to_owned() } else { format!("_{name}") };
    let arguments: Vec<String> = arguments.iter().map(|(name, of)| format!("{}: {of}", mark(name))).collect();
    let result = if result.is_empty() { String::new() } else { format!(" -> {result}") };
    let line = format!("{visibility}fn {name}({}){result} {{\n", arguments.join(", "));
    if line.len() + margin <= LONGEST_LINE + 1 {
        return line;
    }
    format!("{visibility}fn {name}(\n    {},\n){result} {{\n", arguments.join(",\n    "))
}

/// Returns the values of an array as lines.
pub(super) fn lines(values: &[String], indent: &str) -> String {
    let lines: Vec<String> =
        values.chunks(ON_A_LINE).map(|line| format!("{indent}    {},\n", line.join(", "))).collect();
    lines.concat()
}

/// Returns a constant array of numbers.
pub(super) fn constant(docs: &str, name: &str, of: &str, length: &str, values: &[String]) -> String {
    let docs = documented(docs, "");
    if values.is_empty() {
        return format!("{docs}static {name}: [{of}; {length}] = [];\n\n");
    }
    format!("{docs}#[rustfmt::skip]\nstatic {name}: [{of}; {length}] = [\n{}];\n\n", lines(values, ""))
}

#[cfg(test)]
mod tests {
    use super::signature;

    #[test]
    fn unused_arguments_are_marked_and_long_heads_break() {
        assert_eq!(
            signature("pub ", "f", &[("q", "f64"), ("t", "f64")], "f64", &|name| name == "t", 0),
            "pub fn f(_q: f64, t: f64) -> f64 {\n"
        );
        let long = [
            ("first", "&mut [f64; 12345678901234]"),
            ("second", "&mut [f64; 123456789]"),
            ("third", "&mut [f64; 12345678901234]"),
        ];
        assert!(signature("", "long", &long, "", &|_| true, 0).starts_with("fn long(\n    first: "));
    }
}
