//! Free motions in words.

use super::errors;
use crate::limits::explain::SEEN;
use mechc_ir::{ConstraintSystem, CoordinateKind};

/// Describes a motion: how far one body turns for each degree of another.
pub fn motion_in_words(system: &ConstraintSystem, right: &[f64]) -> String {
    let largest = right.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let rate = |k: usize| right[k];
    let of_kind = |kind: CoordinateKind| {
        let mut columns: Vec<usize> = (0..right.len())
            .filter(|&k| system.coordinates()[k].kind == kind && system.body_of(k).is_some())
            .filter(|&k| right[k].abs() > SEEN * largest)
            .collect();
        columns.sort_by(|&a, &b| right[b].abs().total_cmp(&right[a].abs()));
        columns
    };
    let turning = of_kind(CoordinateKind::Angle);
    let name = |k: usize| format!("`{}`", system.owner_name(k));
    let Some((&first, others)) = turning.split_first() else {
        return slide_in_words(system, right, &of_kind(CoordinateKind::Length));
    };
    let others: Vec<String> = others
        .iter()
        .take(3)
        .map(|&k| {
            format!(
                "{} turns {} deg for each degree of {}",
                name(k),
                errors::three_digits(rate(k) / rate(first)),
                name(first)
            )
        })
        .collect();
    if others.is_empty() {
        format!("left free: {} can turn", name(first))
    } else {
        format!("left free: {}", others.join(", "))
    }
}

/// Describes a motion without turning: which bodies move, and in which direction the first of them.
fn slide_in_words(system: &ConstraintSystem, right: &[f64], sliding: &[usize]) -> String {
    let Some(body) = sliding.first().and_then(|&k| system.body_of(k)) else {
        return "left free: the contacts can move".to_owned();
    };
    let [x, y, _] = system.pose_of(body).map(|k| right[k]);
    let largest = f64::max(x.abs(), y.abs());
    let [x, y] = [x, y].map(|way| errors::three_digits(if way.abs() > SEEN * largest { way / largest } else { 0.0 }));
    let mut names: Vec<String> = sliding.iter().map(|&k| format!("`{}`", system.owner_name(k))).collect();
    names.dedup();
    let more = match names.as_slice() {
        [_] => String::new(),
        [_, others @ ..] => format!(", and with it {}", errors::cut_list(others)),
        [] => return String::new(),
    };
    format!("left free: {} can move along ({x}, {y}){more}", names[0])
}
