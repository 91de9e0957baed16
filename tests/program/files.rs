//! Files that use each other: each is read once, its mechanisms have their names where it is used, and what is wrong is told where it is.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use mechc::{Checked, Choice, Color, Contents, Format, Memory, Parsed, Sources, Span, World, render};
use mechc_lang::check::{Library, LibraryFile, LookupError};
use mechc_syntax::ast::Name;
use mechc_syntax::parse;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// A mechanism that is determined.
fn mechanism(name: &str) -> String {
    format!(
        "mechanism {name} {{ ground {{ point O = (0, 0) }} body b {{ point O = (0, 0) }} \
         joint j: revolute(ground.O, b.O) driver d: rotation(j) = t }}\n"
    )
}

/// Files, of which the first is the one that is checked.
fn checked(files: &[(&str, String)]) -> Checked {
    let world = files.iter().fold(Memory::default(), |world, (path, text)| world.with(path, text));
    let parsed = Parsed::read(Path::new(files[0].0), &world).expect("it is there");
    parsed.check(&Choice::default(), &world)
}

/// What is said of them, each with its code, its place and its words.
fn messages(files: &[(&str, String)]) -> Vec<String> {
    let checked = checked(files);
    let place = |span: Span| {
        let source = checked.sources().get(span.file);
        let (line, column) = source.position(span.start);
        format!("{}:{line}:{column}", source.name)
    };
    let reported = |messages: &mechc::Diagnostic| {
        let places: Vec<String> = messages.labels.iter().map(|label| place(label.span)).collect();
        // no place is outside of its text
        let _ = render(messages, checked.sources(), Format::Human, Color::Never);
        format!("{} {} {}", messages.code, places.join(" "), messages.message)
    };
    checked.diagnostics().iter().map(reported).collect()
}

#[test]
fn used_files_are_read() {
    let files = [
        ("walker.mech", format!("use \"legs/leg.mech\"\nuse \"wheel.mech\" as w\n{}", mechanism("walker"))),
        ("legs/leg.mech", format!("use \"foot.mech\"\n{}", mechanism("leg"))),
        ("legs/foot.mech", mechanism("foot")),
        ("wheel.mech", mechanism("wheel")),
        ("not_used.mech", "}".to_owned()),
    ];
    let checked = checked(&files);
    assert!(checked.is_sound() && checked.diagnostics().is_empty(), "{:?}", checked.diagnostics());
    let names: Vec<&str> = checked.sources().iter().map(|source| source.name.as_str()).collect();
    assert_eq!(names, ["walker.mech", "legs/leg.mech", "wheel.mech", "legs/foot.mech"]);
    let used: Vec<(&str, &str)> = checked
        .used_files()
        .map(|(span, file)| (checked.sources().text(span), checked.sources().get(file).name.as_str()))
        .collect();
    assert_eq!(used, [("\"legs/leg.mech\"", "legs/leg.mech"), ("\"wheel.mech\"", "wheel.mech")]);
}

/// Counts what is read.
struct Counting(Memory, Mutex<Vec<PathBuf>>);

impl World for Counting {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.1.lock().expect("nobody panicked").push(path.to_owned());
        self.0.read(path)
    }
}

#[test]
fn files_are_read_once() {
    let user = "use \"leg.mech\"\nuse \"./leg.mech\" as a\nuse \"sub/../leg.mech\" as b\nuse \"sub/other.mech\"\n";
    let world = Memory::default()
        .with("dir/walker.mech", format!("{user}{}", mechanism("walker")))
        .with("dir/leg.mech", mechanism("leg"))
        .with(
            "dir/sub/other.mech",
            format!("use \".././leg.mech\"\nuse \"../../dir/leg.mech\"\n{}", mechanism("other")),
        );
    let world = Counting(world, Mutex::default());
    let parsed = Parsed::read(Path::new("dir/walker.mech"), &world).expect("it is there");
    let checked = parsed.check(&Choice::default(), &world);
    assert!(checked.diagnostics().is_empty(), "{:?}", checked.diagnostics());
    let read = world.1.into_inner().expect("nobody panicked");
    assert_eq!(read, ["dir/walker.mech", "dir/leg.mech", "dir/sub/other.mech"].map(PathBuf::from));
}

#[test]
fn texts_without_uses_read_no_files() {
    let world = Counting(Memory::default(), Mutex::default());
    assert!(Parsed::new("a.mech", &mechanism("a")).check(&Choice::default(), &world).is_sound());
    assert!(world.1.into_inner().expect("nobody panicked").is_empty());
}

#[test]
fn unreadable_files_are_reported_at_their_use() {
    let using = |path: &str| ("dir/a.mech", format!("use \"{path}\"\n{}", mechanism("a")));
    let help = |files: &[(&str, String)]| {
        let checked = checked(files);
        let messages = checked.diagnostics().iter().next().expect("a fault").clone();
        (
            messages.help,
            messages.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.text.clone()).collect::<Vec<_>>(),
        )
    };
    let leg = ("dir/sub/legs.mech", mechanism("leg"));
    let missing = [using("sub/leg.mech"), leg.clone()];
    assert_eq!(messages(&missing), ["E0701 dir/a.mech:1:5 cannot read `dir/sub/leg.mech`: entity not found"]);
    assert_eq!(help(&missing), (vec!["was `sub/legs.mech` meant?".into()], vec!["\"sub/legs.mech\"".into()]));
    assert_eq!(help(&[using("sub/legs"), leg.clone()]).0, ["was `sub/legs.mech` meant?"]);
    assert!(help(&[using("sub/wheel.mech"), leg]).0.is_empty());
    // who names it twice is told twice, and reads it once
    let twice = [("a.mech", format!("use \"b\"\nuse \"./b\" as b\n{}", mechanism("a")))];
    assert_eq!(
        messages(&twice),
        ["E0701 a.mech:1:5", "E0701 a.mech:2:5"].map(|place| format!("{place} cannot read `b`: entity not found"))
    );
    assert!(messages(&[using("")])[0].starts_with("E0701 dir/a.mech:1:5 "));
}

#[test]
fn binary_files_are_reported_once() {
    let world = Memory::default()
        .with("a.mech", format!("use \"b.mech\"\n{}", mechanism("a")))
        .with("b.mech", b"mechanism \xb5");
    let checked = Parsed::read(Path::new("a.mech"), &world).expect("it is there").check(&Choice::default(), &world);
    let codes: Vec<&str> = checked.diagnostics().iter().map(|message| message.code.as_str()).collect();
    assert_eq!(codes, ["E0102"]);
    assert!(!checked.is_sound());
}

#[test]
fn faults_of_used_files_are_reported_once() {
    let files = [
        ("a.mech", format!("use \"b.mech\"\nuse \"c.mech\"\n{}", mechanism("a"))),
        ("b.mech", format!("use \"c.mech\"\n{}", mechanism("b"))),
        ("c.mech", "mechanism c {\n  param r = 3 +\n}\nmechanism d {}\nmechanism d {}".to_owned()),
        ("d.mech", String::new()),
    ];
    assert_eq!(
        messages(&files),
        [
            "E0101 c.mech:3:1 expected a formula, found `}`",
            "E0205 c.mech:5:11 c.mech:4:11 there are two mechanisms `d`"
        ]
    );
    let empty = [("a.mech", format!("use \"d.mech\"\n{}", mechanism("a"))), ("d.mech", String::new())];
    assert_eq!(messages(&empty), ["E0101 a.mech:1:5 `d.mech` holds no mechanism"]);
}

#[test]
fn circles_are_shown() {
    let using = |path: &'static str, used: &str| (path, format!("use \"{used}\"\n{}", mechanism(&path[..1])));
    assert_eq!(messages(&[using("a.mech", "a.mech")]), ["E0206 a.mech:1:1 `a.mech` uses itself"]);
    let three = [using("a.mech", "b.mech"), using("b.mech", "./c.mech"), using("c.mech", "x/../a.mech")];
    assert_eq!(
        messages(&three),
        ["E0206 a.mech:1:1 b.mech:1:1 c.mech:1:1 \
          files use each other in a circle: `a.mech` → `b.mech` → `c.mech` → `a.mech`"]
    );
    // a circle to which the file itself does not belong
    let beyond = [using("a.mech", "b.mech"), using("b.mech", "c.mech"), using("c.mech", "b.mech")];
    assert_eq!(
        messages(&beyond),
        ["E0206 b.mech:1:1 c.mech:1:1 files use each other in a circle: `b.mech` → `c.mech` → `b.mech`"]
    );
    // by two ways to one file is no circle
    let diamond = [
        ("a.mech", format!("use \"b.mech\"\nuse \"c.mech\"\n{}", mechanism("a"))),
        using("b.mech", "d.mech"),
        using("c.mech", "d.mech"),
        ("d.mech", mechanism("d")),
    ];
    assert_eq!(messages(&diamond), [""; 0]);
}

#[test]
fn a_long_chain_of_files_is_followed() {
    let files: Vec<(String, String)> = (0..3000)
        .map(|k| (format!("f{k}.mech"), format!("use \"f{}.mech\"\n{}", (k + 1) % 3000, mechanism(&format!("m{k}")))))
        .collect();
    let files: Vec<(&str, String)> = files.iter().map(|(path, text)| (path.as_str(), text.clone())).collect();
    let messages = messages(&files);
    assert_eq!(messages.len(), 1);
    assert!(messages[0].starts_with("E0206 f0.mech:1:1 f1.mech:1:1"), "{}", &messages[0][..80]);
}

#[test]
fn duplicate_mechanisms_are_reported_at_the_use() {
    let files = |uses: &str| {
        [
            ("a.mech", format!("{uses}{}", mechanism("a"))),
            ("b.mech", mechanism("leg") + &mechanism("foot") + &mechanism("b")),
            ("c.mech", mechanism("foot") + &mechanism("leg") + &mechanism("c")),
            ("d.mech", mechanism("a")),
        ]
    };
    assert_eq!(
        messages(&files("use \"b.mech\"\nuse \"c.mech\"\n")),
        ["E0205 a.mech:2:1 a.mech:1:1 `b.mech` and `c.mech` both hold mechanisms `foot`, `leg`"]
    );
    assert_eq!(
        messages(&files("use \"d.mech\"\n")),
        ["E0205 a.mech:1:1 a.mech:2:11 `a.mech` and `d.mech` both hold a mechanism `a`"]
    );
    for uses in [
        "use \"b.mech\" as b\nuse \"c.mech\"\n",
        "use \"b.mech\" as leg\nuse \"c.mech\" as a\n",
        "use \"d.mech\" as a\n",
        "use \"b.mech\"\nuse \"b.mech\"\n",
    ] {
        assert_eq!(messages(&files(uses)), [""; 0], "{uses}");
    }
    assert_eq!(
        messages(&files("use \"b.mech\" as x\nuse \"d.mech\" as x\n")),
        ["E0203 a.mech:2:17 a.mech:1:17 two files are used as `x`"]
    );
    // what is proposed mends it
    let [(_, text), rest @ ..] = files("use \"b.mech\"\nuse \"c.mech\"\n");
    let checked = checked(&[&[("a.mech", text.clone())][..], &rest].concat());
    let fixes: Vec<_> = checked.diagnostics().iter().flat_map(|message| &message.fixes).collect();
    let (mended, _) = mechc::fixed(checked.sources(), fixes[0].edits[0].span.file, fixes);
    assert!(mended.contains("use \"c.mech\" as c\n"), "{mended}");
    assert_eq!(messages(&[&[("a.mech", mended)][..], &rest].concat()), [""; 0]);
}

#[test]
fn faulty_uses_do_not_affect_others() {
    let text = format!("use b.mech\nuse \"c.mech\" as\nuse \"d.mech\" as x y\n{}", mechanism("a"));
    let files = [("a.mech", text), ("c.mech", mechanism("c")), ("d.mech", mechanism("c"))];
    assert_eq!(
        messages(&files),
        [
            "E0101 a.mech:1:5 expected a file name in quotes, found `b`",
            "E0101 a.mech:3:1 expected a name, found `use`",
            "E0101 a.mech:3:19 expected `mechanism`, found `y`",
        ]
    );
}

#[test]
fn mechanisms_are_named_only_if_ambiguous() {
    let two = [("a.mech", format!("use \"b.mech\"\n{}{}", mechanism("a"), mechanism("c"))), ("b.mech", mechanism("b"))];
    assert_eq!(messages(&two), ["E0704  `a.mech` holds 2 mechanisms"]);
    let choose = |name: &str| {
        let world = two.iter().fold(Memory::default(), |world, (path, text)| world.with(path, text));
        let choice = Choice { mechanism: Some(name.to_owned()), ..Choice::default() };
        Parsed::read(Path::new("a.mech"), &world).expect("it is there").check(&choice, &world).is_sound()
    };
    assert!(choose("c"));
    assert!(!choose("b"), "a command takes a mechanism of the named file itself");
}

#[test]
fn tables_are_relative_to_their_file() {
    let table = "table way = spline \"way.csv\"\n";
    let files = [
        ("dir/a.mech", format!("use \"../b.mech\"\n{}", mechanism("a").replacen('{', &format!("{{ {table}"), 1))),
        ("dir/way.csv", "0,0\n1,1\n".to_owned()),
        ("b.mech", mechanism("b")),
    ];
    assert_eq!(messages(&files), [""; 0]);
    let named = checked(&files).named_files();
    let named: Vec<_> = named.iter().map(|path| path.to_string_lossy()).collect();
    assert_eq!(named, ["dir/../b.mech", "dir/way.csv"]);
}

// ---- names

/// A library of files, whose uses are told by their numbers, with a name for each place at which one could be written.
fn library(files: &[(&str, String, &[Option<usize>])]) -> (Library, Sources) {
    let mut sources = Sources::default();
    let known = files.iter().map(|(path, text, uses)| {
        let id = sources.add(*path, text);
        let read = Arc::new(parse(&sources, id));
        LibraryFile { id, path: PathBuf::from(path), read, uses: uses.to_vec() }
    });
    let known = known.collect();
    (Library::new(known), sources)
}

fn walker() -> (Library, Sources) {
    let uses = "use \"lib/leg.mech\"\nuse \"lib/wheel.mech\" as w\nuse \"lib/wheel.mech\" as z\n";
    library(&[
        ("walker.mech", format!("{uses}{}", mechanism("walker")), &[Some(1), Some(2), Some(2)]),
        ("lib/leg.mech", format!("use \"../other/foot.mech\"\n{}{}", mechanism("leg"), mechanism("arm")), &[Some(3)]),
        ("lib/wheel.mech", mechanism("wheel") + &mechanism("leg"), &[]),
        ("other/foot.mech", mechanism("foot"), &[]),
    ])
}

/// The mechanism that a path means in a file, or what is said of it.
fn found((library, sources): &(Library, Sources), file: usize, path: &str) -> Result<String, String> {
    let span = Span { file: library.files()[file].id, start: 0, end: 0 };
    let name = |text: &str| Name { text: text.to_owned(), span };
    let (prefix, last) = match path.split_once('.') {
        Some((prefix, last)) => (Some(name(prefix)), name(last)),
        None => (None, name(path)),
    };
    match library.find(prefix.as_ref(), &last, sources) {
        Ok(known) => Ok(format!("{}:{}", known.file, library.tree(known).name.text)),
        Err(LookupError::Told(messages)) => Err(format!("{}; {}", messages.message, messages.help.join("; "))),
        Err(LookupError::Said) => Err(String::new()),
    }
}

#[test]
fn names_include_used_files() {
    let walker = walker();
    let found = |file, path| found(&walker, file, path);
    for (file, path, wanted) in [
        (0, "walker", "0:walker"),
        (0, "leg", "1:leg"),
        (0, "arm", "1:arm"),
        (0, "w.wheel", "2:wheel"),
        (0, "z.leg", "2:leg"),
        (1, "leg", "1:leg"),
        (1, "foot", "3:foot"),
        (2, "leg", "2:leg"),
    ] {
        assert_eq!(found(file, path).as_deref(), Ok(wanted));
    }
    for (file, path, wanted) in [
        // what a used file uses is not passed on
        (
            0,
            "foot",
            "there is no mechanism `foot`; `other/foot.mech` holds it: `use \"other/foot.mech\"` at the top of the file",
        ),
        (
            2,
            "foot",
            "there is no mechanism `foot`; `other/foot.mech` holds it: `use \"../other/foot.mech\"` at the top of the file",
        ),
        (
            3,
            "arm",
            "there is no mechanism `arm`; `lib/leg.mech` holds it: `use \"../lib/leg.mech\"` at the top of the file",
        ),
        // nor is it the other way round
        (
            1,
            "walker",
            "there is no mechanism `walker`; `walker.mech` holds it: `use \"../walker.mech\"` at the top of the file",
        ),
        // with a prefix they are there only under it
        (0, "wheel", "there is no mechanism `wheel`; it is there as `w.wheel`"),
        (0, "w.arm", "there is no mechanism `arm` in `w`; it is there as `arm`"),
        (0, "legs", "there is no mechanism `legs`; was `leg` meant?"),
        (0, "w.weel", "there is no mechanism `weel` in `w`; was `wheel` meant?"),
        (0, "hovercraft", "there is no mechanism `hovercraft`; the mechanisms are walker, leg, arm"),
        (0, "q.leg", "no file is used as `q`; the prefixes are w, z"),
        (1, "w.leg", "no file is used as `w`; say so at the top of the file: `use \"FILE.mech\" as w`"),
    ] {
        assert_eq!(found(file, path), Err(wanted.to_owned()), "{path}");
    }
}

#[test]
fn unreadable_files_are_reported_without_followups() {
    let silent = Err(String::new());
    let missing =
        library(&[("a.mech", format!("use \"b.mech\"\nuse \"c.mech\" as c\n{}", mechanism("a")), &[None, None])]);
    assert_eq!(found(&missing, 0, "leg"), silent);
    assert_eq!(found(&missing, 0, "c.leg"), silent);
    assert!(found(&missing, 0, "a").is_ok());
    let broken = library(&[
        ("a.mech", format!("use \"b.mech\"\n{}", mechanism("a")), &[Some(1)]),
        ("b.mech", format!("{}mechanims leg {{}}", mechanism("b")), &[]),
    ]);
    assert_eq!(found(&broken, 0, "foot"), silent);
    assert!(found(&broken, 0, "b").is_ok());
    let broken = library(&[("a.mech", format!("use b.mech as w\n{}", mechanism("a")), &[None])]);
    assert_eq!(found(&broken, 0, "w.leg"), silent);
}
