//! Writes values of params into a text. Only the values change; units, spaces and comments stay.

use super::requests::{ValueChange, WriteRequest};
use mechc_pipeline::{Checked, ParamControl};
use mechc_text::source::Span;

/// The maximum number of copies that a question lists by name.
const MAX_LISTED: usize = 4;

/// The outcome of a request to write values.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum EditOutcome {
    /// The whole text with the new values.
    Text(String),
    /// A question for the user: a formula would be lost, or something else would change too.
    NeedsConfirmation(String),
    /// The reason why the values cannot be written.
    Refused(String),
}

/// Replaces values of params in the text of a mechanism. Units and the spaces before them stay as they are written.
#[must_use]
pub(super) fn apply_changes(checked: &Checked, write: &WriteRequest) -> EditOutcome {
    let params = checked.param_controls();
    let (mut edits, mut questions): (Vec<(Span, String)>, Vec<String>) = (Vec::new(), Vec::new());
    for change in &write.changes {
        let (param, span) = match find_value(checked, &params, change) {
            Ok(value) => value,
            Err(why) => return EditOutcome::Refused(why),
        };
        let here = checked.sources().text(span);
        let value =
            if param.is_half { format_point(&params, param, write) } else { format_value(param, here, change.value) };
        if param.formula.is_some() {
            questions.push(format!("`{}` has the formula `{here}`: replace it by {value}?", param_name(param)));
        }
        let others = other_names_at(&params, param, write);
        if !others.is_empty() {
            let (name, (line, _)) = (param_name(param), checked.sources().get(span.file).position(span.start));
            questions.push(format!(
                "`{name}` stands in line {line}, which is that of {others} too: write {value} for all of them?"
            ));
        }
        edits.push((span, value));
    }
    questions.dedup();
    if !questions.is_empty() && !write.is_confirmed {
        return EditOutcome::NeedsConfirmation(questions.join("; "));
    }
    edits.sort();
    // several params may share one value in the text, and each may be given the same new one
    edits.dedup();
    if edits.windows(2).any(|pair| pair[0].0.end > pair[1].0.start) {
        return EditOutcome::Refused("two of the values stand in the same place".to_owned());
    }
    let mut text = checked.sources().get(checked.file()).text.clone();
    for (span, value) in edits.iter().rev() {
        text.replace_range(span.start as usize..span.end as usize, value);
    }
    EditOutcome::Text(text)
}

/// Finds the param to change and the span of its value in the file. Fails if the text there is not what the page shows.
fn find_value<'k>(
    checked: &Checked,
    params: &'k [ParamControl],
    change: &ValueChange,
) -> Result<(&'k ParamControl, Span), String> {
    let ValueChange { name, old, .. } = change;
    let param = params
        .iter()
        .find(|param| param.name == *name)
        .ok_or_else(|| format!("there is no param `{name}` any more"))?;
    let span = param.editable_span.filter(|span| span.file == checked.file()).ok_or_else(|| {
        let file = &checked.sources().get(checked.file()).name;
        format!("`{name}` has no value of its own in `{file}` that could be replaced")
    })?;
    let here = checked.sources().text(span);
    if here == old {
        Ok((param, span))
    } else {
        Err(format!("`{name}` is `{here}` in the file by now, and was `{old}`"))
    }
}

/// Lists the params whose value is the same text as that of a param and that are not written too: those of other copies of a part.
fn other_names_at(params: &[ParamControl], of: &ParamControl, write: &WriteRequest) -> String {
    let is_changed = |name: &str| write.changes.iter().any(|change| change.name == name);
    let is_other = |param: &&ParamControl| {
        let is_of_all = || params.iter().any(|copy| copy.of.as_deref() == Some(&param.name));
        let is_covered = is_changed(&param.name)
            || param.of.as_deref().is_some_and(is_changed)
            || param_name(param) == param_name(of);
        param.editable_span == of.editable_span && !is_covered && !is_of_all()
    };
    let mut names: Vec<String> =
        params.iter().filter(is_other).map(|param| format!("`{}`", param_name(param))).collect();
    names.dedup();
    match names.len().checked_sub(MAX_LISTED) {
        Some(more @ 1..) => format!("{} and {more} more", names[..MAX_LISTED].join(", ")),
        _ => names.join(", "),
    }
}

/// Returns the name of the param, or of the point of which it is a coordinate.
fn param_name(param: &ParamControl) -> &str {
    let point_name = || param.name.strip_suffix(".x").or_else(|| param.name.strip_suffix(".y"));
    point_name().filter(|_| param.is_half).unwrap_or(&param.name)
}

/// Formats both coordinates of a point, of which at least one is changed.
fn format_point(params: &[ParamControl], of: &ParamControl, write: &WriteRequest) -> String {
    let [x, y] = ["x", "y"].map(|axis| {
        let name = format!("{}.{axis}", param_name(of));
        let param = params.iter().find(|param| param.name == name).unwrap_or(of);
        let change = write.changes.iter().find(|change| change.name == name);
        format_value(param, "", change.map_or(param.value, |change| change.value))
    });
    format!("({x}, {y})")
}

/// Formats a value in the unit of its param, with the spacing of the text.
fn format_value(param: &ParamControl, here: &str, value: f64) -> String {
    let number = number(value);
    let unit = &param.unit;
    if param.formula.is_none() && !unit.is_empty() {
        // a plain 0 is written without a unit and needs one now
        let gap = here.strip_suffix(unit.as_str()).map_or(" ", |number| &number[number.trim_end().len()..]);
        return format!("{number}{gap}{unit}");
    }
    if unit.is_empty() || unit.starts_with('/') { format!("{number}{unit}") } else { format!("{number} {unit}") }
}

/// Formats a number without long rows of zeros.
fn number(value: f64) -> String {
    // −0 would surprise a reader
    let value = value + 0.0;
    if value == 0.0 || (1e-6..1e15).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::{EditOutcome, ValueChange, WriteRequest, apply_changes};
    use mechc_pipeline::{Choice, Parsed};
    use mechc_text::world::Memory;

    const TEXT: &str = "mechanism lever {\r
    param length = 50mm // a comment: 50mm
    param half   = length / 2
    param speed  =  -60  rpm
    param count  = 2
    param A = (10 mm, 0)
    param B = (0, 0)
    param C = A + (5 mm, B.y)
    ground { point O = A }
    body bar[k in 0..count] at (0, 0, k * 1 deg) { point O = (half, 0) point P = (length, 0) }
}";

    fn apply(changes: &[(&str, &str, f64)], is_confirmed: bool) -> EditOutcome {
        let checked = Parsed::new("lever.mech", TEXT).check(&Choice::default(), &Memory::default());
        let change =
            |&(name, old, value): &(&str, &str, f64)| ValueChange { name: name.into(), old: old.into(), value };
        apply_changes(
            &checked,
            &WriteRequest { version: 1, changes: changes.iter().map(change).collect(), is_confirmed },
        )
    }

    fn check(changes: &[(&str, &str, f64)], from: &str, to: &str) {
        assert_eq!(apply(changes, false), EditOutcome::Text(TEXT.replacen(from, to, 1)));
    }

    #[test]
    fn only_the_number_changes() {
        check(&[("length", "50mm", 62.5)], "50mm", "62.5mm");
        check(&[("speed", "-60  rpm", 30.0)], "-60  rpm", "30  rpm");
        check(&[("count", "2", 3.0)], "= 2", "= 3");
        check(&[("A.x", "10 mm", -0.0)], "10 mm", "0 mm");
        check(&[("B.x", "0", 3.0)], "B = (0, 0)", "B = (3 mm, 0)");
        check(&[("A.y", "0", 3.0)], "10 mm, 0", "10 mm, 3 mm");
        let both = apply(&[("A.x", "10 mm", 1e-7), ("length", "50mm", 1.0)], false);
        assert_eq!(both, EditOutcome::Text(TEXT.replacen("10 mm", "1e-7 mm", 1).replacen("50mm", "1mm", 1)));
    }

    #[test]
    fn a_point_with_a_formula_becomes_two_numbers() {
        let old = "A + (5 mm, B.y)";
        let EditOutcome::NeedsConfirmation(asks) = apply(&[("C.x", old, 16.0)], false) else {
            panic!("it did not ask")
        };
        assert_eq!(asks, "`C` has the formula `A + (5 mm, B.y)`: replace it by (16 mm, 0 mm)?");
        assert_eq!(apply(&[("C.x", old, 16.0)], true), EditOutcome::Text(TEXT.replacen(old, "(16 mm, 0 mm)", 1)));
        let both = EditOutcome::Text(TEXT.replacen(old, "(16 mm, 2 mm)", 1));
        assert_eq!(apply(&[("C.y", old, 2.0), ("C.x", old, 16.0)], true), both);
    }

    #[test]
    fn replacing_a_formula_needs_confirmation() {
        let EditOutcome::NeedsConfirmation(asks) = apply(&[("half", "length / 2", 30.0)], false) else {
            panic!("it did not ask")
        };
        assert!(asks.contains("`length / 2`"), "{asks}");
        assert_eq!(
            apply(&[("half", "length / 2", 30.0)], true),
            EditOutcome::Text(TEXT.replacen("length / 2", "30 mm", 1))
        );
    }

    #[test]
    fn replacing_a_shared_value_needs_confirmation() {
        const LEGS: &str = "mechanism legs {
    part leg[k in 0..2]: leg() at (k * 1 m, 0, 0)
    part other: leg()
}
mechanism leg { param rod = 40 mm  ground { point O = (0, 0) }  body bar { point O = (0, 0)  point P = (rod, 0) } }";
        let apply = |changes: &[(&str, f64)], is_confirmed| {
            let choice = Choice { mechanism: Some("legs".to_owned()), ..Choice::default() };
            let checked = Parsed::new("legs.mech", LEGS).check(&choice, &Memory::default());
            let changes =
                changes.iter().map(|&(name, value)| ValueChange { name: name.into(), old: "40 mm".into(), value });
            apply_changes(&checked, &WriteRequest { version: 1, changes: changes.collect(), is_confirmed })
        };
        let asks = |changes: &[(&str, f64)]| match apply(changes, false) {
            EditOutcome::NeedsConfirmation(asks) => asks,
            other => panic!("{other:?}"),
        };
        let of_one = asks(&[("leg[1].rod", 45.0)]);
        assert_eq!(
            of_one,
            "`leg[1].rod` stands in line 5, which is that of `leg[0].rod`, `other.rod` too: write 45 mm for all of them?"
        );
        assert!(asks(&[("leg.rod", 45.0)]).contains("of `other.rod` too"));
        let text = EditOutcome::Text(LEGS.replace("40 mm", "45 mm"));
        assert_eq!(apply(&[("leg.rod", 45.0)], true), text);
        // every param that shares the value is given the same new one
        assert_eq!(apply(&[("leg.rod", 45.0), ("other.rod", 45.0)], false), text);
        assert!(matches!(apply(&[("leg.rod", 45.0), ("other.rod", 46.0)], true), EditOutcome::Refused(_)));
    }

    #[test]
    fn a_value_that_differs_from_the_page_is_refused() {
        for (name, old) in [("length", "51mm"), ("width", "50mm"), ("half", "50mm"), ("A", "(10 mm, 0)")] {
            assert!(matches!(apply(&[(name, old, 1.0)], true), EditOutcome::Refused(_)), "{name}");
        }
        let twice = [("length", "50mm", 1.0), ("length", "50mm", 2.0)];
        assert!(matches!(apply(&twice, true), EditOutcome::Refused(_)));
    }
}
