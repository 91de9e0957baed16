//! Values that go into a file: an edit of its text, and nothing else of it changes.

use super::asked::{Change, Write};
use crate::source::Span;
use crate::stages::{Checked, Knob};

/// What comes of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Edited {
    /// The whole text with the values in it.
    Text(String),
    /// The page asks its reader first: a formula would go.
    Asks(String),
    /// It cannot be.
    Refused(String),
}

/// The text of a mechanism with other values of its params. The units and the spaces before them stay as they are written.
#[must_use]
pub(super) fn edited(checked: &Checked, write: &Write) -> Edited {
    let knobs = checked.knobs();
    let own = checked.sources().get(checked.file());
    let (mut edits, mut formulas): (Vec<(Span, String)>, Vec<String>) = (Vec::new(), Vec::new());
    for Change { name, old, value } in &write.changes {
        let Some(knob) = knobs.iter().find(|knob| knob.name == *name) else {
            return Edited::Refused(format!("there is no param `{name}` any more"));
        };
        let Some(place) = knob.place.filter(|place| place.file == checked.file()) else {
            return Edited::Refused(format!(
                "`{name}` has no value of its own in `{}` that could be replaced",
                own.name
            ));
        };
        let here = checked.sources().text(place);
        if here != old {
            return Edited::Refused(format!("`{name}` is `{here}` in the file by now, and was `{old}`"));
        }
        if knob.formula.is_some() {
            formulas.push(format!("`{name}` has the formula `{here}`"));
        }
        edits.push((place, written(knob, here, *value)));
    }
    if !formulas.is_empty() && !write.sure {
        let those = if formulas.len() == 1 { "it" } else { "them" };
        return Edited::Asks(format!("{}. Replace {those} by a number?", formulas.join(", ")));
    }
    edits.sort_by_key(|(place, _)| *place);
    if edits.windows(2).any(|pair| pair[0].0.end > pair[1].0.start) {
        return Edited::Refused("two of the values stand in the same place".to_owned());
    }
    let mut text = own.text.clone();
    for (place, value) in edits.iter().rev() {
        text.replace_range(place.start as usize..place.end as usize, value);
    }
    Edited::Text(text)
}

/// A value in the unit of its param, as the text has it.
fn written(knob: &Knob, here: &str, value: f64) -> String {
    // −0 would surprise a reader
    let number = value + 0.0;
    let unit = &knob.unit;
    if knob.formula.is_none() && !unit.is_empty() {
        // a plain 0 has no unit yet
        let gap = here.strip_suffix(unit.as_str()).map_or(" ", |number| &number[number.trim_end().len()..]);
        return format!("{number}{gap}{unit}");
    }
    if unit.is_empty() || unit.starts_with('/') { format!("{number}{unit}") } else { format!("{number} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::{Change, Edited, Write, edited};
    use crate::stages::{Choice, Parsed};
    use crate::world::Memory;

    const TEXT: &str = "mechanism lever {\r
    param length = 50mm // a comment: 50mm
    param half   = length / 2
    param speed  =  -60  rpm
    param count  = 2
    param A = (10 mm, 0)
    param B = (0, 0)
    ground { point O = A }
    body bar[k in 0..count] at (0, 0, k * 1 deg) { point O = (half, 0) point P = (length, 0) }
}";

    fn with(changes: &[(&str, &str, f64)], sure: bool) -> Edited {
        let checked = Parsed::of("lever.mech", TEXT).check(&Choice::default(), &Memory::default());
        let change = |&(name, old, value): &(&str, &str, f64)| Change { name: name.into(), old: old.into(), value };
        edited(&checked, &Write { version: 1, changes: changes.iter().map(change).collect(), sure })
    }

    fn becomes(changes: &[(&str, &str, f64)], from: &str, to: &str) {
        assert_eq!(with(changes, false), Edited::Text(TEXT.replacen(from, to, 1)));
    }

    #[test]
    fn the_written_unit_stays_and_nothing_else_changes() {
        becomes(&[("length", "50mm", 62.5)], "50mm", "62.5mm");
        becomes(&[("speed", "-60  rpm", 30.0)], "-60  rpm", "30  rpm");
        becomes(&[("count", "2", 3.0)], "= 2", "= 3");
        becomes(&[("A.x", "10 mm", -0.0)], "10 mm", "0 mm");
        becomes(&[("B.x", "0", 3.0)], "B = (0, 0)", "B = (3 mm, 0)");
        becomes(&[("A.y", "0", 3.0)], "10 mm, 0", "10 mm, 3 mm");
        let both = with(&[("A.x", "10 mm", 1e-7), ("length", "50mm", 1.0)], false);
        assert_eq!(both, Edited::Text(TEXT.replacen("10 mm", "0.0000001 mm", 1).replacen("50mm", "1mm", 1)));
    }

    #[test]
    fn a_formula_goes_only_if_its_writer_is_sure() {
        let Edited::Asks(asks) = with(&[("half", "length / 2", 30.0)], false) else { panic!("it did not ask") };
        assert!(asks.contains("`length / 2`"), "{asks}");
        assert_eq!(with(&[("half", "length / 2", 30.0)], true), Edited::Text(TEXT.replacen("length / 2", "30 mm", 1)));
    }

    #[test]
    fn what_is_not_as_the_page_believes_is_refused() {
        for (name, old) in [("length", "51mm"), ("width", "50mm"), ("half", "50mm"), ("A", "(10 mm, 0)")] {
            assert!(matches!(with(&[(name, old, 1.0)], true), Edited::Refused(_)), "{name}");
        }
        let twice = [("length", "50mm", 1.0), ("length", "50mm", 2.0)];
        assert!(matches!(with(&twice, true), Edited::Refused(_)));
    }
}
