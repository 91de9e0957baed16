//! Values that go into a file: an edit of its text, and nothing else of it changes.

use super::asked::{Change, Write};
use mechc_pipeline::{Checked, Knob};
use mechc_text::source::Span;

/// Copies that a question names.
const TOLD: usize = 4;

/// What comes of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Edited {
    /// The whole text with the values in it.
    Text(String),
    /// The page asks its reader first: a formula would go, or something else would change too.
    Asks(String),
    /// It cannot be.
    Refused(String),
}

/// The text of a mechanism with other values of its params. The units and the spaces before them stay as they are written.
#[must_use]
pub(super) fn edited(checked: &Checked, write: &Write) -> Edited {
    let knobs = checked.knobs();
    let (mut edits, mut asks): (Vec<(Span, String)>, Vec<String>) = (Vec::new(), Vec::new());
    for change in &write.changes {
        let (knob, place) = match place_of(checked, &knobs, change) {
            Ok(found) => found,
            Err(why) => return Edited::Refused(why),
        };
        let here = checked.sources().text(place);
        let value = if knob.is_half { point(&knobs, knob, write) } else { written(knob, here, change.value) };
        if knob.formula.is_some() {
            asks.push(format!("`{}` has the formula `{here}`: replace it by {value}?", whole(knob)));
        }
        let others = others(&knobs, knob, write);
        if !others.is_empty() {
            let (name, (line, _)) = (whole(knob), checked.sources().get(place.file).position(place.start));
            asks.push(format!(
                "`{name}` stands in line {line}, which is that of {others} too: write {value} for all of them?"
            ));
        }
        edits.push((place, value));
    }
    asks.dedup();
    if !asks.is_empty() && !write.sure {
        return Edited::Asks(asks.join("; "));
    }
    edits.sort();
    // what is said in one place of several things may be wanted of each of them
    edits.dedup();
    if edits.windows(2).any(|pair| pair[0].0.end > pair[1].0.start) {
        return Edited::Refused("two of the values stand in the same place".to_owned());
    }
    let mut text = checked.sources().get(checked.file()).text.clone();
    for (place, value) in edits.iter().rev() {
        text.replace_range(place.start as usize..place.end as usize, value);
    }
    Edited::Text(text)
}

/// What is to be another value, and where it stands in the file, if that is as the page believes.
fn place_of<'k>(checked: &Checked, knobs: &'k [Knob], change: &Change) -> Result<(&'k Knob, Span), String> {
    let Change { name, old, .. } = change;
    let knob =
        knobs.iter().find(|knob| knob.name == *name).ok_or_else(|| format!("there is no param `{name}` any more"))?;
    let place = knob.place.filter(|place| place.file == checked.file()).ok_or_else(|| {
        let file = &checked.sources().get(checked.file()).name;
        format!("`{name}` has no value of its own in `{file}` that could be replaced")
    })?;
    let here = checked.sources().text(place);
    if here == old {
        Ok((knob, place))
    } else {
        Err(format!("`{name}` is `{here}` in the file by now, and was `{old}`"))
    }
}

/// What else is said where a param is, but for what is to be written too: the same of other copies of a part.
fn others(knobs: &[Knob], of: &Knob, write: &Write) -> String {
    let is_to_be = |name: &str| write.changes.iter().any(|change| change.name == name);
    let is_other = |knob: &&Knob| {
        let is_of_all = || knobs.iter().any(|copy| copy.of.as_deref() == Some(&knob.name));
        let is_in_hand = is_to_be(&knob.name) || knob.of.as_deref().is_some_and(is_to_be) || whole(knob) == whole(of);
        knob.place == of.place && !is_in_hand && !is_of_all()
    };
    let mut names: Vec<String> = knobs.iter().filter(is_other).map(|knob| format!("`{}`", whole(knob))).collect();
    names.dedup();
    match names.len().checked_sub(TOLD) {
        Some(more @ 1..) => format!("{} and {more} more", names[..TOLD].join(", ")),
        _ => names.join(", "),
    }
}

/// What is said in one place: a param, or a point of which this is a coordinate.
fn whole(knob: &Knob) -> &str {
    let point = || knob.name.strip_suffix(".x").or_else(|| knob.name.strip_suffix(".y"));
    point().filter(|_| knob.is_half).unwrap_or(&knob.name)
}

/// Both coordinates of a point of which one is to be another.
fn point(knobs: &[Knob], of: &Knob, write: &Write) -> String {
    let [x, y] = ["x", "y"].map(|axis| {
        let name = format!("{}.{axis}", whole(of));
        let knob = knobs.iter().find(|knob| knob.name == name).unwrap_or(of);
        let change = write.changes.iter().find(|change| change.name == name);
        written(knob, "", change.map_or(knob.value, |change| change.value))
    });
    format!("({x}, {y})")
}

/// A value in the unit of its param, as the text has it.
fn written(knob: &Knob, here: &str, value: f64) -> String {
    let number = number(value);
    let unit = &knob.unit;
    if knob.formula.is_none() && !unit.is_empty() {
        // a plain 0 has no unit yet
        let gap = here.strip_suffix(unit.as_str()).map_or(" ", |number| &number[number.trim_end().len()..]);
        return format!("{number}{gap}{unit}");
    }
    if unit.is_empty() || unit.starts_with('/') { format!("{number}{unit}") } else { format!("{number} {unit}") }
}

/// A number without more zeros than a reader can count.
fn number(value: f64) -> String {
    // −0 would surprise a reader
    let value = value + 0.0;
    if value == 0.0 || (1e-6..1e15).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::{Change, Edited, Write, edited};
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
        assert_eq!(both, Edited::Text(TEXT.replacen("10 mm", "1e-7 mm", 1).replacen("50mm", "1mm", 1)));
    }

    #[test]
    fn a_point_with_a_formula_becomes_one_of_two_numbers() {
        let old = "A + (5 mm, B.y)";
        let Edited::Asks(asks) = with(&[("C.x", old, 16.0)], false) else { panic!("it did not ask") };
        assert_eq!(asks, "`C` has the formula `A + (5 mm, B.y)`: replace it by (16 mm, 0 mm)?");
        assert_eq!(with(&[("C.x", old, 16.0)], true), Edited::Text(TEXT.replacen(old, "(16 mm, 0 mm)", 1)));
        let both = Edited::Text(TEXT.replacen(old, "(16 mm, 2 mm)", 1));
        assert_eq!(with(&[("C.y", old, 2.0), ("C.x", old, 16.0)], true), both);
    }

    #[test]
    fn a_formula_goes_only_if_its_writer_is_sure() {
        let Edited::Asks(asks) = with(&[("half", "length / 2", 30.0)], false) else { panic!("it did not ask") };
        assert!(asks.contains("`length / 2`"), "{asks}");
        assert_eq!(with(&[("half", "length / 2", 30.0)], true), Edited::Text(TEXT.replacen("length / 2", "30 mm", 1)));
    }

    #[test]
    fn what_copies_share_goes_only_if_its_writer_is_sure() {
        const LEGS: &str = "mechanism legs {
    part leg[k in 0..2]: leg() at (k * 1 m, 0, 0)
    part other: leg()
}
mechanism leg { param rod = 40 mm  ground { point O = (0, 0) }  body bar { point O = (0, 0)  point P = (rod, 0) } }";
        let with = |changes: &[(&str, f64)], sure| {
            let choice = Choice { mechanism: Some("legs".to_owned()), ..Choice::default() };
            let checked = Parsed::of("legs.mech", LEGS).check(&choice, &Memory::default());
            let changes = changes.iter().map(|&(name, value)| Change { name: name.into(), old: "40 mm".into(), value });
            edited(&checked, &Write { version: 1, changes: changes.collect(), sure })
        };
        let asks = |changes: &[(&str, f64)]| match with(changes, false) {
            Edited::Asks(asks) => asks,
            other => panic!("{other:?}"),
        };
        let of_one = asks(&[("leg[1].rod", 45.0)]);
        assert_eq!(
            of_one,
            "`leg[1].rod` stands in line 5, which is that of `leg[0].rod`, `other.rod` too: write 45 mm for all of them?"
        );
        assert!(asks(&[("leg.rod", 45.0)]).contains("of `other.rod` too"));
        let text = Edited::Text(LEGS.replace("40 mm", "45 mm"));
        assert_eq!(with(&[("leg.rod", 45.0)], true), text);
        // of all that it is said of the same is wanted
        assert_eq!(with(&[("leg.rod", 45.0), ("other.rod", 45.0)], false), text);
        assert!(matches!(with(&[("leg.rod", 45.0), ("other.rod", 46.0)], true), Edited::Refused(_)));
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
