//! Edits of a text one after another: what is known afterwards is what is known of the last text alone.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mechc::{Cancel, Memory, Sources};
use mechc_ide::{self as ide, DiagnosticStage, FilePosition, Snapshot};
use mechc_syntax as syntax;
use std::path::Path;
use std::sync::Arc;

/// Longer texts find nothing that these do not.
const LONGEST: usize = 4096;

const TEXTS: [&str; 5] = [
    "",
    include_str!("../../examples/slider_crank.mech"),
    include_str!("../../examples/table_driven.mech"),
    include_str!("../../tests/format/everything.mech"),
    include_str!("../../examples/parallel_robot.mech"),
];

const TYPED: [&str; 32] = [
    "",
    "",
    "",
    " ",
    "\n",
    "\r\n",
    "\r",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "\"",
    "//",
    "///",
    ".",
    ",",
    "=",
    ":",
    "0",
    "1 mm",
    "a",
    "𝛼",
    "in ",
    "body b {",
    "param p = 1",
    "point P = (1, 2)",
    "ground {",
    "joint ",
    "mechanism m {",
    "use \"b.mech\"",
];

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, edits)) = bytes.split_first() else { return };
    let original = TEXTS[first as usize % TEXTS.len()];
    let path: Arc<Path> = Path::new("text.mech").into();
    let mut snapshot = opened(&path, original);
    let mut text = original.to_owned();
    let mut old = parsed(&text);
    for edit in edits.chunks_exact(5).take(40) {
        let new = edited(&text, edit);
        if new.len() > LONGEST {
            return;
        }
        let mut sources = Sources::default();
        let file = sources.add("text.mech", new.as_str());
        let reread = syntax::reparse(&old, &text, &sources, file);
        assert!(reread == parsed(&new), "from\n{text}\nto\n{new}");
        (old, text) = (reread, new);
        snapshot = snapshot.with_text(&path, Some(text.as_str().into()));
        // now and then nobody asks before the next edit
        if edit[4] % 3 == 0 {
            let _ = snapshot.checked(&path);
        }
    }
    let fresh = opened(&path, &text);
    for stage in [DiagnosticStage::Words, DiagnosticStage::Proof] {
        let of = |snapshot: &Snapshot| ide::diagnostics(snapshot, &path, stage, &Cancel::default);
        let [own, other] = [&snapshot, &fresh].map(of);
        assert!(own == other, "{stage:?} of\n{text}\n{own:?}\n{other:?}");
    }
    assert!(ide::outline(&snapshot, &path) == ide::outline(&fresh, &path), "{text}");
    for offset in (0..text.len() as u32).step_by(7) {
        let place = FilePosition { path: Arc::clone(&path), offset };
        assert!(ide::hover(&snapshot, &place) == ide::hover(&fresh, &place), "{offset} of\n{text}");
    }
});

fn opened(path: &Arc<Path>, text: &str) -> Snapshot {
    Snapshot::new(Arc::new(Memory::default())).with_text(path, Some(text.into()))
}

fn parsed(text: &str) -> syntax::ParsedText {
    let mut sources = Sources::default();
    let file = sources.add("text.mech", text);
    syntax::parse(&sources, file)
}

/// A stretch goes, and something comes: of a list, or from elsewhere in the text.
fn edited(text: &str, edit: &[u8]) -> String {
    let boundary = |at: usize| (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let start = boundary((usize::from(edit[0]) << 8 | usize::from(edit[1])) % (text.len() + 1));
    let end = boundary(start + usize::from(edit[2]) % 64);
    let chosen = usize::from(edit[3]);
    let new = if chosen < 2 * TYPED.len() {
        TYPED[chosen % TYPED.len()]
    } else {
        let from = boundary(chosen * 31 % (text.len() + 1));
        &text[from..boundary(from + usize::from(edit[4]) % 64)]
    };
    format!("{}{new}{}", &text[..start], &text[end..])
}
