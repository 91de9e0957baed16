//! What stands above declarations: what can be done with a mechanism, and what its results came to.

use super::numbers::with_unit;
use super::snapshot::{MotionOutcome, Snapshot};
use mechc_lang::check::NameKind;
use mechc_pipeline::Checked;
use std::ops::Range;
use std::path::Path;

/// What stands above a declaration.
#[derive(Clone, PartialEq, Debug)]
pub struct Lens {
    /// The name of that.
    pub range: Range<u32>,
    /// What it is.
    pub kind: LensKind,
}

/// The kinds of lenses.
#[derive(Clone, PartialEq, Debug)]
pub enum LensKind {
    /// `mechc run` of a mechanism, by its name.
    Run(String),
    /// `mechc check` of it.
    Check(String),
    /// `mechc view` of it.
    View(String),
    /// What a result came to.
    Result(String),
}

/// The lenses of a file. Nothing is computed for them: results are those of the last motion that was followed to its end, with `…` behind
/// them where the text is another one by now.
#[must_use]
pub fn lenses(snapshot: &Snapshot, path: &Path) -> Option<Vec<Lens>> {
    let checked = snapshot.checked(path)?;
    let (moved, is_of_before) = snapshot.moved_last(path);
    let mut lenses = Vec::new();
    for checked in &checked.mechanisms {
        let Some((_, mechanism)) = checked.symbols().iter().next() else { continue };
        let range = mechanism.span.start..mechanism.span.end;
        let name = &mechanism.name;
        let of = |kind: LensKind| Lens { range: range.clone(), kind };
        let own = [LensKind::View(name.clone()), LensKind::Run(name.clone()), LensKind::Check(name.clone())];
        lenses.extend(own.map(of));
        let moved = moved.iter().flat_map(|all| all.iter()).find(|moved| moved.mechanism == *name);
        lenses.extend(
            moved.map(|moved| of_results(checked, moved, is_of_before || moved.is_cut_short)).unwrap_or_default(),
        );
    }
    Some(lenses)
}

fn of_results(checked: &Checked, moved: &MotionOutcome, is_of_before: bool) -> Vec<Lens> {
    let declared = checked.symbols().iter().filter(|(_, name)| name.kind == NameKind::Result);
    let lens = |name: &str, range: Range<u32>| {
        let copies =
            |result: &str| result.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['));
        let found: Vec<String> = moved.results.iter().filter(|(result, ..)| copies(result)).map(value_of).collect();
        let behind = if is_of_before { " …" } else { "" };
        let title = format!("{}{behind}", found.join(", "));
        (!found.is_empty()).then_some(Lens { range, kind: LensKind::Result(title) })
    };
    declared.filter_map(|(_, name)| lens(&name.name, name.span.start..name.span.end)).collect()
}

fn value_of((_, value, unit): &(String, Option<f64>, String)) -> String {
    value.map_or_else(|| "no value".to_owned(), |value| with_unit(value, unit))
}

#[cfg(test)]
mod tests {
    use super::{Lens, LensKind, lenses};
    use crate::testing::{FOUR_BAR, at_cursor};
    use mechc_text::cancel::Cancel;

    fn shown(lenses: &[Lens]) -> Vec<String> {
        let line = |lens: &Lens| match &lens.kind {
            LensKind::View(name) => format!("view {name}"),
            LensKind::Run(name) => format!("run {name}"),
            LensKind::Check(name) => format!("check {name}"),
            LensKind::Result(title) => title.clone(),
        };
        lenses.iter().map(line).collect()
    }

    #[test]
    fn results_come_behind_the_motion_and_stay_while_the_text_is_edited() {
        let results =
            "    result swing = max(angle(rocker)) - min(angle(rocker)) in deg\n    result none = 1 / (max(t) - 4 s)\n";
        let text = FOUR_BAR.replacen("    analysis", &format!("{results}    analysis"), 1);
        let (snapshot, position) = at_cursor(&format!("{text}$0"));
        let now = |snapshot: &crate::Snapshot| shown(&lenses(snapshot, &position.path).expect("lenses"));
        assert_eq!(now(&snapshot), ["view four_bar", "run four_bar", "check four_bar"]);
        snapshot.moved(&position.path, &Cancel::default).expect("it moves");
        assert_eq!(now(&snapshot), ["view four_bar", "run four_bar", "check four_bar", "60.4876 deg", "no value"]);
        let edited = snapshot.with_text(&position.path, Some(text.replacen("swing", "swung", 1).into()));
        assert_eq!(now(&edited), ["view four_bar", "run four_bar", "check four_bar", "no value …"]);
        let edited = edited.with_text(&position.path, Some(text.replacen("60 deg +", "60 dg +", 1).into()));
        assert_eq!(now(&edited), ["view four_bar", "run four_bar", "check four_bar", "60.4876 deg …", "no value …"]);
    }
}
