//! Definitions, references and highlights of names, and links to files.

use super::location::{FilePosition, FileRange};
use super::occurrences::{Occurrence, Role, Target, files_containing, name_at, occurrence_at, occurrences};
use super::snapshot::Snapshot;
use mechc_text::world::World;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A link from a name to its declaration.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Link {
    /// The range of the name.
    pub from: FileRange,
    /// The range of the declared name, or the beginning of a file.
    pub to: FileRange,
}

/// An occurrence of a name in its file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Highlight {
    /// The range of the name.
    pub range: Range<u32>,
    /// True if it is the declaration.
    pub declares: bool,
}

/// A name of a file in a text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FileLink {
    /// The range of the name in the text.
    pub range: Range<u32>,
    /// The file.
    pub file: Arc<Path>,
}

/// Returns the declaration of the name at a position. A name that both uses and declares, as in `point A`, leads to the used one.
#[must_use]
pub fn definition(snapshot: &Snapshot, position: &FilePosition) -> Option<Link> {
    let all = occurrences(snapshot, &position.path)?;
    let at = occurrence_at(&all, position.offset)?;
    let is_use = |other: &&Occurrence| other.range == at.range && other.role == Role::Uses;
    let at = all.iter().find(is_use).unwrap_or(at);
    let to = match &at.target {
        Target::Name(name) => name.clone(),
        Target::File(path) => FileRange { path: Arc::clone(path), start: 0, end: 0 },
    };
    // a missing file has no location
    snapshot.buffers().read(&to.path).ok()?;
    Some(Link { from: at.location(&position.path), to })
}

/// Returns the uses of the name at a position in all files of the snapshot, and its declaration if requested.
#[must_use]
pub fn references(snapshot: &Snapshot, position: &FilePosition, with_declaration: bool) -> Option<Vec<FileRange>> {
    let at = name_at(snapshot, position)?;
    let mut references = Vec::new();
    for path in files_containing(snapshot, &position.path, &[&search_word(snapshot, &at, position)?]) {
        let matches = |one: &Occurrence| one.target == at.target && (with_declaration || one.role == Role::Uses);
        let here = occurrences(snapshot, &path).unwrap_or_default();
        references.extend(here.iter().filter(|one| matches(one)).map(|one| one.location(&path)));
    }
    Some(references)
}

/// Returns the occurrences of the name at a position in its file.
#[must_use]
pub fn highlights(snapshot: &Snapshot, position: &FilePosition) -> Option<Vec<Highlight>> {
    let all = occurrences(snapshot, &position.path)?;
    let at = occurrence_at(&all, position.offset)?;
    let same = all.iter().filter(|one| one.target == at.target);
    Some(same.map(|one| Highlight { range: one.range.range(), declares: one.role == Role::Declares }).collect())
}

/// Returns the existing files that a text names.
#[must_use]
pub fn file_links(snapshot: &Snapshot, path: &Path) -> Option<Vec<FileLink>> {
    let link = |one: Occurrence| match one.target {
        Target::File(file) if snapshot.buffers().read(&file).is_ok() => {
            Some(FileLink { range: one.range.range(), file })
        }
        _ => None,
    };
    Some(occurrences(snapshot, path)?.into_iter().filter_map(link).collect())
}

/// Returns the text by which files with references are found: the name, or the file name.
fn search_word(snapshot: &Snapshot, at: &Occurrence, position: &FilePosition) -> Option<String> {
    match &at.target {
        Target::Name(_) => {
            let parsed = snapshot.parsed(&position.path)?;
            let text = &parsed.sources().get(parsed.file()).text;
            text.get(at.range.start as usize..at.range.end as usize).map(str::to_owned)
        }
        Target::File(path) => Some(path.file_name()?.to_string_lossy().into_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::{definition, file_links, highlights, references};
    use crate::testing::{FOUR_BAR, TWO_FILES, at_cursor, shown};

    fn defined(from: &str, to: &str, text: &str) -> String {
        assert!(text.contains(from), "{from}");
        let (snapshot, position) = at_cursor(&text.replacen(from, to, 1));
        definition(&snapshot, &position).map_or("nothing".to_owned(), |link| shown(&snapshot, &link.to))
    }

    #[test]
    fn names_lead_to_their_declarations() {
        insta::assert_snapshot!(defined("crank.B, c", "crank.$0B, c", FOUR_BAR), @r"
        main.mech:10
                point B = (crank_length, 0)
                      ^
        ");
        insta::assert_snapshot!(defined("rotation(main)", "rotation(main$0)", FOUR_BAR), @r"
        main.mech:21
            joint main:  revolute(ground.A, crank.A)
                  ^^^^
        ");
        insta::assert_snapshot!(defined("revolute(ground", "$0revolute(ground", FOUR_BAR), @"nothing");
        insta::assert_snapshot!(defined("    point A\n", "    point $0A\n", TWO_FILES), @r"
        main.mech:4
            param A = (10 mm, 0)
                  ^
        ");
    }

    #[test]
    fn names_lead_into_parts_and_other_files() {
        insta::assert_snapshot!(defined("front.arm.tip", "front.arm.$0tip", TWO_FILES), @r"
        lever.mech:7
                point tip = (reach, 0)
                      ^^^
        ");
        insta::assert_snapshot!(defined("front.arm.tip", "front.$0arm.tip", TWO_FILES), @r"
        lever.mech:5
            body arm {
                 ^^^
        ");
        insta::assert_snapshot!(defined("side[1].arm.tip", "side[1].arm.$0tip", TWO_FILES), @r"
        lever.mech:7
                point tip = (reach, 0)
                      ^^^
        ");
        insta::assert_snapshot!(defined("reach = 60", "re$0ach = 60", TWO_FILES), @r"
        lever.mech:2
            param reach = 80 mm
                  ^^^^^
        ");
        insta::assert_snapshot!(defined("levers.lever(turn", "levers.$0lever(turn", TWO_FILES), @r"
        lever.mech:1
        mechanism lever {
                  ^^^^^
        ");
        insta::assert_snapshot!(defined("levers.lever(turn", "$0levers.lever(turn", TWO_FILES), @r#"
        main.mech:1
        use "lever.mech" as levers
                            ^^^^^^
        "#);
        insta::assert_snapshot!(defined("\"lever.mech\"", "\"lever$0.mech\"", TWO_FILES), @r"
        lever.mech:1
        mechanism lever {
        ^
        ");
    }

    fn used(from: &str, to: &str) -> String {
        let (snapshot, position) = at_cursor(&TWO_FILES.replacen(from, to, 1));
        let found = references(&snapshot, &position, true).unwrap_or_default();
        found.iter().map(|position| shown(&snapshot, position)).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn uses_are_found_in_all_files() {
        insta::assert_snapshot!(used("point tip =", "point $0tip ="), @r"
        lever.mech:7
                point tip = (reach, 0)
                      ^^^
        main.mech:10
            part side[k in 0..2]:   levers.lever() on front.arm at (front.arm.tip, 0)
                                                                              ^^^
        main.mech:11
            measure way = x(front.arm.tip) + x(side[1].arm.tip)
                                      ^^^
        main.mech:11
            measure way = x(front.arm.tip) + x(side[1].arm.tip)
                                                           ^^^
        ");
        insta::assert_snapshot!(used("reach = 60", "reach$0 = 60"), @r"
        lever.mech:2
            param reach = 80 mm
                  ^^^^^
        lever.mech:7
                point tip = (reach, 0)
                             ^^^^^
        main.mech:9
            part front:             levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)
                                                                            ^^^^^
        ");
        insta::assert_snapshot!(used("mechanism lever", "mechanism lev$0er"), @r"
        lever.mech:1
        mechanism lever {
                  ^^^^^
        main.mech:9
            part front:             levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)
                                           ^^^^^
        main.mech:10
            part side[k in 0..2]:   levers.lever() on front.arm at (front.arm.tip, 0)
                                           ^^^^^
        ");
    }

    #[test]
    fn a_name_is_shown_in_its_file() {
        let (snapshot, position) = at_cursor(&FOUR_BAR.replacen("rotation(main)", "rotation($0main)", 1));
        let found = highlights(&snapshot, &position).expect("a name");
        let text =
            |range: &std::ops::Range<u32>| FOUR_BAR.get(range.start as usize - 4..range.end as usize).expect("it");
        let found: Vec<_> = found.iter().map(|one| (text(&one.range), one.declares)).collect();
        assert_eq!(found, [("int main", true), ("ion(main", false)]);
    }

    #[test]
    fn files_that_are_there_are_linked() {
        let (snapshot, position) =
            at_cursor(&TWO_FILES.replacen("use \"lever.mech\"", "$0use \"none.mech\" as n\nuse \"lever.mech\"", 1));
        let links = file_links(&snapshot, &position.path).expect("a file");
        let files: Vec<_> = links.iter().map(|link| link.file.display().to_string()).collect();
        assert_eq!(files, ["lever.mech"]);
    }
}
