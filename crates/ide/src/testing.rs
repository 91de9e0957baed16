//! Texts with a cursor for tests of features.

use super::location::{FilePosition, FileRange};
use super::snapshot::Snapshot;
use mechc_text::world::Memory;
use std::path::Path;
use std::sync::Arc;

/// The name of the file of a text without `//- NAME` lines.
pub const MAIN: &str = "main.mech";

/// A sound crank-rocker.
pub const FOUR_BAR: &str = "\
mechanism four_bar {
    param crank_length = 30 mm

    ground {
        point A = (0, 0)
        point D = (100 mm, 0)
    }
    body crank at (0, 0, 60 deg) {
        point A = (0, 0)
        point B = (crank_length, 0)
    }
    body coupler at (15 mm, 26 mm, 30 deg) {
        point B = (0, 0)
        point C = (80 mm, 0)
    }
    body rocker at (100 mm, 0, 100 deg) {
        point D = (0, 0)
        point C = (60 mm, 0)
    }

    joint main:  revolute(ground.A, crank.A)
    joint pin:   revolute(crank.B, coupler.B)
    joint knee:  revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = 60 deg + 90 deg/s * t

    analysis from 0 s to 4 s every 0.1 s
}
";

/// A mechanism that uses one from another file.
pub const TWO_FILES: &str = "\
//- main.mech
use \"lever.mech\" as levers

mechanism pair {
    param A = (10 mm, 0)
    ground {
        point A
        point O = (0, 0)
    }
    part front:             levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)
    part side[k in 0..2]:   levers.lever() on front.arm at (front.arm.tip, 0)
    measure way = x(front.arm.tip) + x(side[1].arm.tip)
    analysis from 0 s to 1 s every 0.1 s
}
//- lever.mech
mechanism lever {
    param reach = 80 mm
    input turn = 10 deg * sin(1 rev/s * t)
    ground { point O = (0, 0) }
    body arm {
        point O   = (0, 0)
        point tip = (reach, 0)
    }
    joint pivot: revolute(ground.O, arm.O)
    driver motor: rotation(pivot) = turn
}
";

/// Creates a snapshot with open files, each after a line `//- NAME` (`main.mech` without such a line), and the position of the cursor,
/// `$0`.
pub fn at_cursor(text: &str) -> (Snapshot, FilePosition) {
    let mut snapshot = Snapshot::new(Arc::new(Memory::default()));
    let mut cursor = None;
    for (name, text) in files(text) {
        let path: Arc<Path> = Path::new(&name).into();
        let (before, behind) = text.split_once("$0").unwrap_or((&text, ""));
        if before.len() < text.len() {
            cursor = Some(FilePosition { path: Arc::clone(&path), offset: before.len() as u32 });
        }
        snapshot = snapshot.with_text(&path, Some(format!("{before}{behind}").into()));
    }
    (snapshot, cursor.expect("a cursor"))
}

fn files(text: &str) -> Vec<(String, String)> {
    if !text.starts_with("//- ") {
        return vec![(MAIN.to_owned(), text.to_owned())];
    }
    let parts = text.split("//- ").skip(1).filter_map(|part| part.split_once('\n'));
    parts.map(|(name, text)| (name.trim().to_owned(), text.to_owned())).collect()
}

/// Formats a range as its line, with the range marked below it.
pub fn shown(snapshot: &Snapshot, location: &FileRange) -> String {
    let parsed = snapshot.parsed(&location.path).expect("a file");
    let source = parsed.sources().get(parsed.file());
    let line = source.line_index(location.start as usize);
    let range = source.line_range(line).expect("a line");
    let text = source.text[range.clone()].trim_end();
    let (start, end) =
        (location.start as usize - range.start, (location.end as usize).min(range.start + text.len()) - range.start);
    let (before, inside) = (text[..start].chars().count(), text[start..end].chars().count());
    format!("{}:{}\n{text}\n{}{}", location.path.display(), line + 1, " ".repeat(before), "^".repeat(inside.max(1)))
}
