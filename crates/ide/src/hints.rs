//! Inlay hints: the coordinates and equations that declarations add, and the values of formulas.

use super::numbers::{degrees, in_unit, short, signed, with_unit};
use super::snapshot::Snapshot;
use mechc_lang::check::{Amount, ConstantValue, DeclarationCount, Index};
use mechc_pipeline::Checked;
use std::ops::Range;
use std::path::Path;

/// An inlay hint.
#[derive(Clone, PartialEq, Debug)]
pub struct Hint {
    /// The offset in the file after which it is shown.
    pub offset: u32,
    /// The text of the hint.
    pub label: String,
    /// The explanation of the label.
    pub meaning: String,
}

/// Returns the hints of a range of a file, in order. Each depends on its declaration alone; a value that an error elsewhere leaves open
/// has no hint.
#[must_use]
pub fn hints(snapshot: &Snapshot, path: &Path, range: &Range<u32>) -> Option<Vec<Hint>> {
    let checked = snapshot.checked(path)?;
    let mut hints: Vec<Hint> = checked.mechanisms.iter().flat_map(of_mechanism).collect();
    hints.retain(|hint| range.start <= hint.offset && hint.offset <= range.end);
    hints.sort_by_key(|hint| hint.offset);
    Some(hints)
}

fn of_mechanism(checked: &Checked) -> Vec<Hint> {
    let info = checked.declaration_info();
    let name = checked.symbols().iter().next().map(|(_, mechanism)| mechanism.span.end);
    let mut hints: Vec<Hint> =
        info.freedom.zip(name).map(|(freedom, end)| of_freedom(freedom, end)).into_iter().collect();
    hints.extend(info.counts.iter().map(of_count));
    hints.extend(info.indices.iter().map(of_index));
    hints.extend(info.values.iter().filter_map(of_value));
    hints
}

fn of_freedom(freedom: i64, offset: u32) -> Hint {
    let number = if freedom < 0 { signed(freedom) } else { freedom.to_string() };
    let meaning = match freedom {
        0 => "as many equations as coordinates".to_owned(),
        1.. => format!("{} without an equation", counted(freedom, "coordinate")),
        _ => format!("{} too many", counted(-freedom, "equation")),
    };
    Hint { offset, label: format!("NDOF = {number}"), meaning }
}

fn of_count(count: &DeclarationCount) -> Hint {
    let DeclarationCount { freedom, copies, .. } = *count;
    let label = match copies {
        // copies of a part may differ in their numbers, and then only the total is shown
        Some(copies) if copies > 0 && freedom % copies.cast_signed() as i64 == 0 => {
            format!("{} × {copies}", signed(freedom / copies.cast_signed() as i64))
        }
        _ => signed(freedom),
    };
    let meaning = match freedom {
        0 => "as many equations as coordinates".to_owned(),
        1.. => counted(freedom, "coordinate"),
        _ => format!("{} more than coordinates", counted(-freedom, "equation")),
    };
    let offset = if count.is_body { count.name.end } else { count.declaration.end };
    Hint { offset, label, meaning }
}

fn counted(n: i64, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn of_index(index: &Index) -> Hint {
    let Index { range, name, ends: [first, last] } = index;
    let numbers = if first == last { first.to_string() } else { format!("{first} … {last}") };
    Hint { offset: range.end, label: format!("{name} = {numbers}"), meaning: "the numbers of the copies".to_owned() }
}

/// Returns a hint with the value of a formula; `None` if the formula is that value.
fn of_value(value: &ConstantValue) -> Option<Hint> {
    let label = match &value.amount {
        Amount::Point(_) if value.is_number => return None,
        Amount::Point([x, y]) => format!("= ({}, {}) m", short(*x), short(*y)),
        Amount::Number { si, .. } if *si == 0.0 && value.is_number => return None,
        Amount::Number { si, dimension, unit } => {
            let in_si = with_unit(*si, &dimension.display_unit());
            let written = unit.as_ref().and_then(|unit| in_unit(*si, unit));
            let is_in_degrees = unit.as_ref().is_some_and(|unit| unit.per_second(0) == "deg");
            let in_degrees = (dimension.is_angle() && !is_in_degrees).then(|| degrees(*si));
            let mut forms: Vec<String> = Vec::new();
            // a number already shows its value in the written unit
            forms.extend((!value.is_number || written.is_some()).then_some(in_si));
            forms.extend(written.filter(|_| !value.is_number));
            forms.extend(in_degrees);
            forms.dedup();
            forms.first()?;
            format!("= {}", forms.join(" = "))
        }
    };
    Some(Hint { offset: value.formula.end, label, meaning: "its value".to_owned() })
}

#[cfg(test)]
mod tests {
    use super::hints;
    use crate::testing::{FOUR_BAR, at_cursor};

    /// Returns the lines with hints, each hint in brackets.
    fn shown(text: &str) -> String {
        let (snapshot, position) = at_cursor(&format!("{text}$0"));
        let found = hints(&snapshot, &position.path, &(0..u32::MAX)).expect("hints");
        let parsed = snapshot.parsed(&position.path).expect("a file");
        let mut text = parsed.sources().get(parsed.file()).text.clone();
        for hint in found.iter().rev() {
            text.insert_str(hint.offset as usize, &format!("⟨{}⟩", hint.label));
        }
        text.lines().filter(|line| line.contains('⟨')).map(str::trim).collect::<Vec<&str>>().join("\n")
    }

    #[test]
    fn declarations_show_their_counts() {
        insta::assert_snapshot!(shown(FOUR_BAR), @r"
        mechanism four_bar⟨NDOF = 0⟩ {
        param crank_length = 30 mm⟨= 0.03 m⟩
        body crank⟨+3⟩ at (0, 0, 60 deg) {
        body coupler⟨+3⟩ at (15 mm, 26 mm, 30 deg) {
        body rocker⟨+3⟩ at (100 mm, 0, 100 deg) {
        joint main:  revolute(ground.A, crank.A)⟨−2⟩
        joint pin:   revolute(crank.B, coupler.B)⟨−2⟩
        joint knee:  revolute(coupler.C, rocker.C)⟨−2⟩
        joint pivot: revolute(ground.D, rocker.D)⟨−2⟩
        driver motor: rotation(main) = 60 deg + 90 deg/s * t⟨−1⟩
        ");
    }

    #[test]
    fn the_count_is_live_while_something_else_is_broken() {
        let of = |from: &str, to: &str| {
            assert!(FOUR_BAR.contains(from), "{from}");
            let shown = shown(&FOUR_BAR.replacen(from, to, 1));
            shown.lines().find(|line| line.contains("mechanism")).unwrap_or("nothing").to_owned()
        };
        assert_eq!(of("driver motor: rotation(main) = 60 deg + 90 deg/s * t", ""), "mechanism four_bar⟨NDOF = 1⟩ {");
        assert_eq!(of("rocker.C)", "rocker.X)"), "mechanism four_bar⟨NDOF = 0⟩ {");
        assert_eq!(of("60 deg + 90", "60 deg + nothing + 90"), "mechanism four_bar⟨NDOF = 0⟩ {");
        assert_eq!(of("    analysis", "    measure half = 2 *\n\n    analysis"), "mechanism four_bar⟨NDOF = 0⟩ {");
        assert_eq!(of("= 30 mm", "= 30 mm +"), "mechanism four_bar⟨NDOF = 0⟩ {");
        // without a kind the joint's equations cannot be counted
        assert_eq!(of("joint pin:   revolute(", "joint pin:   ("), "nothing");
        assert_eq!(of("revolute(crank.B", "pinned(crank.B"), "nothing");
        let twice = "joint pivot: revolute(ground.D, rocker.D)";
        let both = format!("{twice}\n joint again: revolute(ground.D, rocker.D)");
        assert_eq!(of(twice, &both), "mechanism four_bar⟨NDOF = −2⟩ {");
    }

    #[test]
    fn values_are_shown_where_they_are_not_written() {
        insta::assert_snapshot!(shown("\
mechanism m {
    param a = 5 mm
    param b = 2
    param c = 2 m
    param d = 3 * a + 1 mm
    param e = a / 2
    param f = -90 deg
    param g = 0.5 rad
    param h = f / 3
    param i = 60 rpm
    param j = 0 mm
    param k = a * b * nothing
    param P = (a, 5 mm)
    param Q = (1 mm, 2 mm)
    param s = d / a
    body arm at (0, 0, pi / 3) { point O = (0, 0) }
    body leg at (0, 0, 30 deg) { point O = (0, 0) }
    body toe at (P, f + 1) { point O = (0, 0) }
}
"), @r"
        mechanism m⟨NDOF = 9⟩ {
        param a = 5 mm⟨= 0.005 m⟩
        param d = 3 * a + 1 mm⟨= 0.016 m = 16 mm⟩
        param e = a / 2⟨= 0.0025 m⟩
        param f = -90 deg⟨= -1.5708 rad⟩
        param g = 0.5 rad⟨= 28.6479°⟩
        param h = f / 3⟨= -0.523599 rad = -30°⟩
        param i = 60 rpm⟨= 6.28319 rad/s⟩
        param P = (a, 5 mm)⟨= (0.005, 0.005) m⟩
        param s = d / a⟨= 3.2⟩
        body arm⟨+3⟩ at (0, 0, pi / 3⟨= 1.0472 rad = 60°⟩) { point O = (0, 0) }
        body leg⟨+3⟩ at (0, 0, 30 deg) { point O = (0, 0) }
        body toe⟨+3⟩ at (P, f + 1⟨= -0.570796 rad = -32.7042°⟩) { point O = (0, 0) }
        ");
    }

    #[test]
    fn copies_and_parts_are_counted_in_total() {
        insta::assert_snapshot!(shown("\
mechanism leg {
    param n = 3
    ground { point O = (0, 0) }
    body rod[k in 0..n] at (k * 100 mm, 0, 0) { point O = (0, 0) point P = (100 mm, 0) }
    joint first: revolute(ground.O, rod[0].O)
    joint pin[k in 1..n]: revolute(rod[k - 1].P, rod[k].O)
    driver turn[k in 0..n]: angle(rod[k]) = 10 deg * t
}
mechanism walker {
    body base at (0, 0, 0) { circle rim = (0, 0) radius 10 mm  axis way = (0, 0) along (1, 0)  point O = (0, 0) }
    body wheel at (0, 30 mm, 0) { circle rim = (0, 0) radius 20 mm  point P = (0, 0) }
    part legs[k in 0..4]: leg()
    part long: leg(n = 8) on base at (0, 0, pi)
    part odd[k in 1..3]: leg(n = k)
    joint fixed: weld(ground.O, base.O)
    joint mesh: gear(base.rim, wheel.rim)
    joint touch: cam(base.rim, wheel.rim)
    joint slide: point_follower(wheel.P, base.rim)
    ground { point O = (0, 0) }
}
"), @r"
        mechanism leg⟨NDOF = 0⟩ {
        body rod⟨+3 × 3⟩[k in 0..n⟨k = 0 … 2⟩] at (k * 100 mm, 0, 0) { point O = (0, 0) point P = (100 mm, 0) }
        joint first: revolute(ground.O, rod[0].O)⟨−2⟩
        joint pin[k in 1..n⟨k = 1 … 2⟩]: revolute(rod[k - 1].P, rod[k].O)⟨−2 × 2⟩
        driver turn[k in 0..n⟨k = 0 … 2⟩]: angle(rod[k]) = 10 deg * t⟨−1 × 3⟩
        mechanism walker⟨NDOF = 0⟩ {
        body base⟨+3⟩ at (0, 0, 0) { circle rim = (0, 0) radius 10 mm  axis way = (0, 0) along (1, 0)  point O = (0, 0) }
        body wheel⟨+3⟩ at (0, 30 mm, 0) { circle rim = (0, 0) radius 20 mm  point P = (0, 0) }
        part legs[k in 0..4⟨k = 0 … 3⟩]: leg()⟨±0 × 4⟩
        part long: leg(n = 8) on base at (0, 0, pi⟨= 3.14159 rad = 180°⟩)⟨±0⟩
        part odd[k in 1..3⟨k = 1 … 2⟩]: leg(n = k)⟨±0 × 2⟩
        joint fixed: weld(ground.O, base.O)⟨−3⟩
        joint mesh: gear(base.rim, wheel.rim)⟨−1⟩
        joint touch: cam(base.rim, wheel.rim)⟨−1⟩
        joint slide: point_follower(wheel.P, base.rim)⟨−1⟩
        ");
    }

    #[test]
    fn only_hints_in_the_range_are_returned() {
        let (snapshot, position) = at_cursor(&format!("{FOUR_BAR}$0"));
        let start = FOUR_BAR.find("joint pin").expect("a joint") as u32;
        let found = hints(&snapshot, &position.path, &(start..start + 45)).expect("hints");
        assert_eq!(found.iter().map(|hint| hint.label.as_str()).collect::<Vec<_>>(), ["−2"]);
    }
}
