//! Code lenses: commands for mechanisms, and values of results.

use super::numbers::with_unit;
use super::snapshot::{MotionOutcome, ResultValue, Snapshot};
use mechc_lang::check::NameKind;
use mechc_pipeline::Checked;
use std::ops::Range;
use std::path::Path;

/// A line above a declaration.
#[derive(Clone, PartialEq, Debug)]
pub struct Lens {
    /// The range of the declaration's name.
    pub range: Range<u32>,
    /// The kind of lens.
    pub kind: LensKind,
}

/// The kinds of lenses.
#[derive(Clone, PartialEq, Debug)]
pub enum LensKind {
    /// `mechc run` of a mechanism, by its name.
    Run(String),
    /// `mechc check` of a mechanism.
    Check(String),
    /// `mechc view` of a mechanism.
    View(String),
    /// The values of a result.
    Result(String),
}

/// Returns the lenses of a file. They compute nothing: results are those of the last complete motion, followed by `…` if the text has
/// changed since.
#[must_use]
pub fn lenses(snapshot: &Snapshot, path: &Path) -> Option<Vec<Lens>> {
    let checked = snapshot.checked(path)?;
    let (motions, is_outdated) = snapshot.last_motions(path);
    let mut lenses = Vec::new();
    for checked in &checked.mechanisms {
        let Some((_, mechanism)) = checked.symbols().iter().next() else { continue };
        let range = mechanism.span.start..mechanism.span.end;
        let name = &mechanism.name;
        let of = |kind: LensKind| Lens { range: range.clone(), kind };
        let commands = [LensKind::View(name.clone()), LensKind::Run(name.clone()), LensKind::Check(name.clone())];
        lenses.extend(commands.map(of));
        let motion = motions.iter().flat_map(|all| all.iter()).find(|motion| motion.mechanism == *name);
        lenses.extend(
            motion.map(|motion| of_results(checked, motion, is_outdated || motion.is_cut_short)).unwrap_or_default(),
        );
    }
    Some(lenses)
}

fn of_results(checked: &Checked, motion: &MotionOutcome, is_outdated: bool) -> Vec<Lens> {
    let declared = checked.symbols().iter().filter(|(_, name)| name.kind == NameKind::Result);
    let lens = |name: &str, range: Range<u32>| {
        let is_copy =
            |result: &str| result.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['));
        let values: Vec<String> = motion.results.iter().filter(|result| is_copy(&result.name)).map(value_of).collect();
        let behind = if is_outdated { " …" } else { "" };
        let title = format!("{}{behind}", values.join(", "));
        (!values.is_empty()).then_some(Lens { range, kind: LensKind::Result(title) })
    };
    declared.filter_map(|(_, name)| lens(&name.name, name.span.start..name.span.end)).collect()
}

fn value_of(result: &ResultValue) -> String {
    result.value.map_or_else(|| "no value".to_owned(), |value| with_unit(value, &result.unit))
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
    fn results_stay_while_the_text_is_edited() {
        let results =
            "    result swing = max(angle(rocker)) - min(angle(rocker)) in deg\n    result none = 1 / (max(t) - 4 s)\n";
        let text = FOUR_BAR.replacen("    analysis", &format!("{results}    analysis"), 1);
        let (snapshot, position) = at_cursor(&format!("{text}$0"));
        let now = |snapshot: &crate::Snapshot| shown(&lenses(snapshot, &position.path).expect("lenses"));
        assert_eq!(now(&snapshot), ["view four_bar", "run four_bar", "check four_bar"]);
        snapshot.motions(&position.path, &Cancel::default).expect("it moves");
        assert_eq!(now(&snapshot), ["view four_bar", "run four_bar", "check four_bar", "60.4876 deg", "no value"]);
        let edited = snapshot.with_text(&position.path, Some(text.replacen("swing", "swung", 1).into()));
        assert_eq!(now(&edited), ["view four_bar", "run four_bar", "check four_bar", "no value …"]);
        let edited = edited.with_text(&position.path, Some(text.replacen("60 deg +", "60 dg +", 1).into()));
        assert_eq!(now(&edited), ["view four_bar", "run four_bar", "check four_bar", "60.4876 deg …", "no value …"]);
    }
}
