//! Renames a declaration everywhere, if every name then still refers to the same declaration.
//!
//! This module contains no scoping rules: it applies the changes to a copy, checks the files again, and refuses if there are new
//! diagnostics or if a name refers to something else.

use super::location::{Change, FilePosition, FileRange};
use super::occurrences::{Bytes, Occurrence, Role, Target, files_containing, occurrences};
use super::snapshot::Snapshot;
use super::trial_edits::{apply, first_new, word_diagnostics};
use mechc_lang::check::Meaning;
use mechc_syntax::is_name;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Returns the range of the name at a position, if it can be renamed.
///
/// # Errors
/// The reason why it cannot, for the user.
pub fn prepare_rename(snapshot: &Snapshot, position: &FilePosition) -> Result<FileRange, String> {
    renamable_name(snapshot, position).map(|at| at.location(&position.path))
}

/// Returns the changes that rename the name at a position.
///
/// # Errors
/// The reason why they cannot be made, for the user.
pub fn rename(snapshot: &Snapshot, position: &FilePosition, new: &str) -> Result<Vec<Change>, String> {
    let at = renamable_name(snapshot, position)?;
    let old = text_at(snapshot, &at.location(&position.path));
    if !is_name(new) {
        return Err(format!("`{new}` is not a name: letters, digits and `_`, no digit first, and no keyword"));
    }
    let files = files_containing(snapshot, &position.path, &search_words(&old, new, &at.target));
    let renaming = Renaming::new(snapshot, &at.target, &old, new, &files);
    let changes = renaming.changes();
    let after = apply(snapshot, &changes).ok_or("a file cannot be read any more")?;
    if let Some(error) = first_new(&word_diagnostics(snapshot, &files), &word_diagnostics(&after, &files)) {
        return Err(format!("`{old}` cannot be called `{new}`: {}", error.message));
    }
    match files.iter().find_map(|path| renaming.changed_name(&after, path)) {
        Some(word) => Err(format!("`{old}` cannot be called `{new}`: `{word}` would mean something else somewhere")),
        None => Ok(changes),
    }
}

/// Returns the words by which affected files are found: both names, and the name of the declaring file, which other files use.
fn search_words<'w>(old: &'w str, new: &'w str, target: &'w Target) -> Vec<&'w str> {
    let Target::Name(declared) = target else { return vec![old, new] };
    let file = declared.path.file_name().and_then(|name| name.to_str());
    [Some(old), Some(new), file].into_iter().flatten().collect()
}

/// Returns the name at a position, if it can be renamed.
fn renamable_name(snapshot: &Snapshot, position: &FilePosition) -> Result<Occurrence, String> {
    match super::occurrences::name_at(snapshot, position) {
        Some(at) => match &at.target {
            Target::File(_) => Err("this is the name of a file".to_owned()),
            Target::Name(declared) if text_at(snapshot, declared) == "ground" => {
                Err("`ground` is a word of the language".to_owned())
            }
            Target::Name(_) => Ok(at),
        },
        None => Err(word_at(snapshot, position)
            .map_or("there is no name here".to_owned(), |word| format!("`{word}` is a word of the language"))),
    }
}

fn word_at(snapshot: &Snapshot, position: &FilePosition) -> Option<&'static str> {
    let file = snapshot.checked(&position.path)?;
    let checked = file.mechanism_at(position.offset)?;
    match checked.symbols().at(checked.file(), position.offset)?.meaning {
        Meaning::Word(word) => Some(word.name),
        Meaning::Declared(_) => None,
    }
}

fn text_at(snapshot: &Snapshot, location: &FileRange) -> String {
    let text = super::trial_edits::text_of(snapshot, &location.path).unwrap_or_default();
    text.get(location.start as usize..location.end as usize).unwrap_or_default().to_owned()
}

/// A renaming in all affected files.
struct Renaming {
    /// The occurrences of each file before the change.
    before: BTreeMap<Arc<Path>, Vec<Occurrence>>,
    /// The edits of each file, in order.
    edits: BTreeMap<Arc<Path>, Vec<Edit>>,
}

/// The replacement of a name.
struct Edit {
    at: Bytes,
    text: String,
    /// The range of the declared name in `text`.
    declared: Bytes,
    /// The range of the used name in `text`.
    used: Bytes,
}

impl Renaming {
    fn new(snapshot: &Snapshot, target: &Target, old: &str, new: &str, files: &[Arc<Path>]) -> Renaming {
        let names = |path: &Arc<Path>| Some((Arc::clone(path), occurrences(snapshot, path)?));
        let before: BTreeMap<_, _> = files.iter().filter_map(names).collect();
        let edits_of = |all: &Vec<Occurrence>| {
            let same = all.iter().filter(|one| one.target == *target);
            same.map(|one| edit(one, all, old, new)).collect()
        };
        let edits = before.iter().map(|(path, all)| (Arc::clone(path), edits_of(all))).collect();
        Renaming { before, edits }
    }

    fn changes(&self) -> Vec<Change> {
        let of = |(path, edits): (&Arc<Path>, &Vec<Edit>)| {
            let change = |edit: &Edit| Change {
                location: FileRange { path: Arc::clone(path), start: edit.at.start, end: edit.at.end },
                text: edit.text.clone(),
            };
            edits.iter().map(change).collect::<Vec<_>>()
        };
        self.edits.iter().flat_map(of).collect()
    }

    /// Returns a name of a file that refers to something else after the changes, has disappeared or is new.
    fn changed_name(&self, after: &Snapshot, path: &Arc<Path>) -> Option<String> {
        let mut expected: Vec<Occurrence> = self.before.get(path)?.iter().map(|one| self.moved(one, path)).collect();
        expected.sort();
        let found = occurrences(after, path).unwrap_or_default();
        let other = found.iter().find(|one| expected.binary_search(one).is_err());
        let missing = expected.iter().find(|one| found.binary_search(one).is_err());
        other.or(missing).map(|one| text_at(after, &one.location(path)))
    }

    fn moved(&self, one: &Occurrence, path: &Arc<Path>) -> Occurrence {
        let target = match &one.target {
            Target::Name(declared) => {
                let at = Bytes { start: declared.start, end: declared.end };
                let Bytes { start, end } = self.bytes(at, Role::Declares, &declared.path);
                Target::Name(FileRange { path: Arc::clone(&declared.path), start, end })
            }
            file @ Target::File(_) => file.clone(),
        };
        Occurrence { range: self.bytes(one.range, one.role, path), role: one.role, target }
    }

    fn bytes(&self, at: Bytes, role: Role, path: &Path) -> Bytes {
        let edits = self.edits.get(path).map(Vec::as_slice).unwrap_or_default();
        let before = edits.iter().take_while(|edit| edit.at.end <= at.start && edit.at != at);
        let (added, removed) = before.fold((0, 0), |(added, removed), edit| {
            (added + edit.text.len() as u32, removed + (edit.at.end - edit.at.start))
        });
        let start = at.start + added - removed;
        let within = match edits.iter().find(|edit| edit.at == at) {
            None => Bytes { start: 0, end: at.end - at.start },
            Some(edit) if role == Role::Declares => edit.declared,
            Some(edit) => edit.used,
        };
        Bytes { start: start + within.start, end: start + within.end }
    }
}

/// Returns the replacement of an occurrence. `point A` both declares a point and uses another one; if only one of them is renamed, it is
/// written out as `point B = A`.
fn edit(one: &Occurrence, all: &[Occurrence], old: &str, new: &str) -> Edit {
    let bytes = |start: usize, length: usize| Bytes { start: start as u32, end: (start + length) as u32 };
    let is_both = all.iter().any(|other| other.range == one.range && other.role != one.role);
    let [declared, used] = match one.role {
        Role::Declares => [new, old],
        Role::Uses => [old, new],
    };
    if is_both {
        let text = format!("{declared} = {used}");
        let second = declared.len() + " = ".len();
        return Edit { at: one.range, text, declared: bytes(0, declared.len()), used: bytes(second, used.len()) };
    }
    Edit { at: one.range, text: new.to_owned(), declared: bytes(0, new.len()), used: bytes(0, new.len()) }
}

#[cfg(test)]
mod tests {
    use super::{prepare_rename, rename};
    use crate::testing::{FOUR_BAR, TWO_FILES, at_cursor};
    use crate::trial_edits::{apply, text_of};

    /// Lists the lines that a new name changes, or why it is refused.
    fn renamed(text: &str, from: &str, to: &str, new: &str) -> String {
        assert!(text.contains(from), "{from}");
        let (snapshot, position) = at_cursor(&text.replacen(from, to, 1));
        let changes = match rename(&snapshot, &position, new) {
            Ok(changes) => changes,
            Err(why) => return why,
        };
        let after = apply(&snapshot, &changes).expect("it can be made");
        let mut lines = Vec::new();
        for path in snapshot.files() {
            let texts = [&snapshot, &after].map(|snapshot| text_of(snapshot, path).expect("a text"));
            let changed = texts[0].lines().zip(texts[1].lines()).filter(|(old, new)| old != new);
            lines.extend(changed.map(|(_, new)| format!("{}: {}", path.display(), new.trim())));
        }
        lines.join("\n")
    }

    #[test]
    fn a_name_changes_in_all_places() {
        insta::assert_snapshot!(renamed(FOUR_BAR, "body crank", "body cra$0nk", "arm"), @r"
        main.mech: body arm at (0, 0, 60 deg) {
        main.mech: joint main:  revolute(ground.A, arm.A)
        main.mech: joint pin:   revolute(arm.B, coupler.B)
        ");
        insta::assert_snapshot!(renamed(FOUR_BAR, "coupler.C, ", "coupler.C$0, ", "tip"), @r"
        main.mech: point tip = (80 mm, 0)
        main.mech: joint knee:  revolute(coupler.tip, rocker.C)
        ");
        insta::assert_snapshot!(renamed(FOUR_BAR, "mechanism four", "mechanism $0four", "linkage"), @"main.mech: mechanism linkage {");
    }

    #[test]
    fn it_changes_in_all_files() {
        insta::assert_snapshot!(renamed(TWO_FILES, "front.arm.tip", "front.$0arm.tip", "rod"), @r"
        lever.mech: body rod {
        lever.mech: joint pivot: revolute(ground.O, rod.O)
        main.mech: part side[k in 0..2]:   levers.lever() on front.rod at (front.rod.tip, 0)
        main.mech: measure way = x(front.rod.tip) + x(side[1].rod.tip)
        ");
        insta::assert_snapshot!(renamed(TWO_FILES, "param reach", "param $0reach", "length_of_arm"), @r"
        lever.mech: param length_of_arm = 80 mm
        lever.mech: point tip = (length_of_arm, 0)
        main.mech: part front:             levers.lever(turn = 30 deg * t / (1 s), length_of_arm = 60 mm)
        ");
        insta::assert_snapshot!(renamed(TWO_FILES, "as levers", "as $0levers", "l"), @r#"
        main.mech: use "lever.mech" as l
        main.mech: part front:             l.lever(turn = 30 deg * t / (1 s), reach = 60 mm)
        main.mech: part side[k in 0..2]:   l.lever() on front.arm at (front.arm.tip, 0)
        "#);
        insta::assert_snapshot!(renamed(TWO_FILES, "mechanism lever", "mechanism lever$0", "arm"), @r"
        lever.mech: mechanism arm {
        main.mech: part front:             levers.arm(turn = 30 deg * t / (1 s), reach = 60 mm)
        main.mech: part side[k in 0..2]:   levers.arm() on front.arm at (front.arm.tip, 0)
        ");
    }

    #[test]
    fn a_name_that_uses_and_declares_is_written_out() {
        insta::assert_snapshot!(renamed(TWO_FILES, "param A", "param $0A", "B"), @r"
        main.mech: param B = (10 mm, 0)
        main.mech: point A = B
        ");
        insta::assert_snapshot!(renamed(TWO_FILES, "point A", "point $0A", "B"), @"main.mech: point B = A");
    }

    #[test]
    fn letters_of_any_length_are_names() {
        insta::assert_snapshot!(renamed(&FOUR_BAR.replace("crank", "𝛼"), "driver motor: rotation(main) = 6", "driver motor: rotation(m$0ain) = 6", "Gelenk_ä"), @r"
        main.mech: joint Gelenk_ä:  revolute(ground.A, 𝛼.A)
        main.mech: driver motor: rotation(Gelenk_ä) = 60 deg + 90 deg/s * t
        ");
        insta::assert_snapshot!(renamed(&FOUR_BAR.replace("crank", "𝛼"), "body 𝛼", "body 𝛼$0", "µ"), @r"
        main.mech: body µ at (0, 0, 60 deg) {
        main.mech: joint main:  revolute(ground.A, µ.A)
        main.mech: joint pin:   revolute(µ.B, coupler.B)
        ");
    }

    #[test]
    fn clashing_names_are_refused() {
        let crank = |new| renamed(FOUR_BAR, "body crank", "body cra$0nk", new);
        insta::assert_snapshot!(crank("rocker"), @"`crank` cannot be called `rocker`: `rocker` is declared twice");
        insta::assert_snapshot!(crank("crank_length"), @"`crank` cannot be called `crank_length`: `crank_length` is declared twice");
        insta::assert_snapshot!(crank("body"), @"`body` is not a name: letters, digits and `_`, no digit first, and no keyword");
        insta::assert_snapshot!(crank("3x"), @"`3x` is not a name: letters, digits and `_`, no digit first, and no keyword");
        insta::assert_snapshot!(crank("t"), @"`crank` cannot be called `t`: `t` cannot be declared: it is time");
        insta::assert_snapshot!(renamed(FOUR_BAR, "point B = (c", "point $0B = (c", "A"), @"`B` cannot be called `A`: `A` is declared twice");
        insta::assert_snapshot!(renamed(TWO_FILES, "point O = (0, 0)\n    }\n    part", "point $0O = (0, 0)\n    }\n    part", "A"), @"`O` cannot be called `A`: `A` is declared twice");
        let hides = "mechanism m {\n fn f(u) = u^2\n param k = 2\n body b { point P = (1 m, 0) }\n driver d: angle(b) = k * t / (1 s)\n measure s1 = speed(b.P) + f(2) * 1 m/s\n}";
        insta::assert_snapshot!(renamed(hides, "fn f", "fn $0f", "speed"), @"`f` cannot be called `speed`: expected a number, found a point");
        let unit =
            "mechanism m {\n param k = 2\n body b { point P = (k * mm, 0) }\n driver d: angle(b) = 2 rad/s * t\n}";
        insta::assert_snapshot!(renamed(unit, "param k", "param $0k", "mm"), @"`k` cannot be called `mm`: `mm` would mean something else somewhere");
        insta::assert_snapshot!(renamed(unit, "param k", "param $0k", "s"), @"`k` cannot be called `s`: `s` in `2 rad/s` is both a unit and the name of a parameter");
        insta::assert_snapshot!(renamed(hides, "param k", "param $0k", "u"), @"`k` cannot be called `u`: the argument `u` hides a name of the mechanism");
    }

    #[test]
    fn words_and_files_cannot_be_renamed() {
        let why = |from: &str, to: &str| {
            let (snapshot, position) = at_cursor(&TWO_FILES.replacen(from, to, 1));
            prepare_rename(&snapshot, &position).expect_err("it stays")
        };
        insta::assert_snapshot!(why("part front", "pa$0rt front"), @"`part` is a word of the language");
        insta::assert_snapshot!(why("ground", "gro$0und"), @"`ground` is a word of the language");
        insta::assert_snapshot!(why("30 deg", "30$0 deg"), @"there is no name here");
        insta::assert_snapshot!(why("\"lever.mech\"", "\"lev$0er.mech\""), @"this is the name of a file");
    }
}
