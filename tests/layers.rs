//! Who may know whom: each room knows only the rooms before it (`ARCHITECTURE.md`).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

#[path = "layers/links.rs"]
mod links;

use links::{Crate, Names};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use support::files;

/// Each room with the rooms that it may name, as the table of the page has them.
fn rooms() -> Vec<(String, Vec<String>)> {
    rooms_of("room")
}

/// The same of a table whose first column is headed so.
fn rooms_of(what: &str) -> Vec<(String, Vec<String>)> {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md")).expect("the page");
    let head = format!("| {what} | what it is for | may use |\n");
    let (_, behind) = page.split_once(&head).expect("the table of rooms");
    let rows = behind.lines().skip(1).take_while(|line| line.starts_with('|'));
    let room = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let used = cells[2].split(", ").filter(|name| *name != "–").map(str::to_owned);
        (cells[0].trim_matches('`').to_owned(), used.collect())
    };
    rows.map(room).collect()
}

/// What the command line names of rooms behind the façade: all of a room, or single things of it.
const COMMAND_LINE: &[&str] = &[
    "analysis::Answers",
    "analysis::Times",
    "cancel",
    "diag",
    "emit::MARK",
    "emit::NOT_IN_ALL",
    "expr::number",
    "layout",
    "live",
    "lsp",
    "output",
    "scene",
    "source",
    "stages",
    "sweep",
    "view",
    "vocabulary",
    "world",
];

/// Links that close a circle between files of one room: none more, and each that is gone goes from here too.
const CIRCLES: &[(&str, &str)] = &[("syntax/build", "syntax/formula")];

fn read() -> Crate {
    Crate::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &files("src", "rs"))
}

#[test]
fn rooms_know_only_those_that_they_may_use() {
    let (all, rooms) = (read(), rooms());
    let mut unused: Vec<(&str, &str)> =
        rooms.iter().flat_map(|(room, used)| used.iter().map(move |used| (room.as_str(), used.as_str()))).collect();
    let mut seen = 0;
    for (module, file) in all.files.iter().filter(|(module, _)| !module.is_empty() && module[0] != "main") {
        let room = module[0].as_str();
        let known = rooms.iter().find(|(name, _)| name == room);
        let (_, allowed) = known.unwrap_or_else(|| panic!("the room `{room}` is not in the table"));
        seen += 1;
        for line in file.code.lines() {
            let hidden = ["crate::{", "super::super", "mechc::"].iter().find(|form| line.contains(**form));
            assert!(hidden.is_none(), "{}: a room is named as `crate::room::…`, not by {hidden:?}", file.place);
        }
        let used = all.named(module).into_iter().filter_map(|path| path.into_iter().next());
        for used in used.filter(|used| used != room) {
            let is_room = rooms.iter().any(|(name, _)| *name == used);
            // only the command line stands before the façade
            assert!(is_room || room == "cli", "{}: `{used}` is no room", file.place);
            if !is_room {
                continue;
            }
            assert!(allowed.contains(&used), "{}: `{room}` must not know `{used}`", file.place);
            unused.retain(|known| *known != (room, used.as_str()));
        }
    }
    assert!(seen > 100, "only {seen} files were looked at");
    assert!(unused.is_empty(), "the table allows what nobody needs: {unused:?}");
}

/// The same of the rooms within a room.
#[test]
fn rooms_of_analysis_know_only_those_that_they_may_use() {
    let (all, rooms) = (read(), rooms_of("room of `analysis`"));
    let mut unused: Vec<(&str, &str)> =
        rooms.iter().flat_map(|(room, used)| used.iter().map(move |used| (room.as_str(), used.as_str()))).collect();
    let mut seen = 0;
    for (module, file) in all.files.iter().filter(|(module, _)| module.len() > 1 && module[0] == "analysis") {
        let room = module[1].as_str();
        let known = rooms.iter().find(|(name, _)| name == room);
        let (_, allowed) = known.unwrap_or_else(|| panic!("the room `analysis/{room}` is not in the table"));
        seen += 1;
        let links = all.links(module).into_iter().filter(|other| other.first().is_some_and(|room| room == "analysis"));
        for used in links.map(|other| other.get(1).cloned().unwrap_or_default()).filter(|used| used != room) {
            assert!(allowed.contains(&used), "{}: `{room}` must not know `{used}`", file.place);
            unused.retain(|known| *known != (room, used.as_str()));
        }
    }
    assert!(seen > 30, "only {seen} files were looked at");
    assert!(unused.is_empty(), "the table allows what nobody needs: {unused:?}");
}

#[test]
fn rooms_are_listed_behind_those_that_they_know() {
    assert!(rooms().len() > 15, "only {} rooms", rooms().len());
    for rooms in [rooms(), rooms_of("room of `analysis`")] {
        for (k, (room, allowed)) in rooms.iter().enumerate() {
            let later = allowed.iter().find(|name| !rooms[..k].iter().any(|(before, _)| before == *name));
            assert!(later.is_none(), "`{room}` knows {later:?}, which does not stand before it");
        }
    }
}

#[test]
fn the_command_line_goes_through_the_facade() {
    let all = read();
    let mut unused = COMMAND_LINE.to_vec();
    for (module, file) in all.files.iter().filter(|(module, _)| module.first().is_some_and(|room| room == "cli")) {
        for path in all.named(module).into_iter().filter(|path| path[0] != "cli") {
            // what is on the façade itself
            if path.len() == 1 && !all.files.contains_key(&path[..1]) {
                continue;
            }
            let path = path.join("::");
            let door = COMMAND_LINE.iter().find(|door| path == **door || path.starts_with(&format!("{door}::")));
            assert!(door.is_some(), "{}: `{path}` is behind the façade", file.place);
            unused.retain(|known| Some(known) != door);
        }
    }
    assert!(unused.is_empty(), "{unused:?} is no longer named, and goes from the list");
}

#[test]
fn files_of_a_room_know_each_other_in_one_direction() {
    let all = read();
    // what `lib.rs` names is no folder of it
    let is_inside = |inner: &Names, outer: &Names| !outer.is_empty() && inner.starts_with(outer);
    let mut links: BTreeMap<Names, Vec<Names>> = BTreeMap::new();
    let mut unused = CIRCLES.to_vec();
    for module in all.files.keys() {
        let others = links.entry(module.clone()).or_default();
        // a file and those in its folder are one
        for other in
            all.links(module).into_iter().filter(|other| !is_inside(other, module) && !is_inside(module, other))
        {
            let link = (module.join("/"), other.join("/"));
            let is_known = unused.iter().position(|(from, to)| *from == link.0 && *to == link.1);
            match is_known {
                Some(at) => drop(unused.remove(at)),
                None => others.push(other),
            }
        }
    }
    let circle = circle(&links);
    assert!(circle.is_empty(), "a circle: {}", circle.iter().map(|m| m.join("/")).collect::<Vec<_>>().join(" → "));
    assert!(unused.is_empty(), "{unused:?}: no such links are left, and they go from the list");
}

/// Modules that each name the next one, and the last one the first; nothing where there are none.
fn circle(links: &BTreeMap<Names, Vec<Names>>) -> Vec<Names> {
    let mut done: Vec<&Names> = Vec::new();
    for start in links.keys() {
        // a way from the start, with how many links of each module on it were followed
        let mut way: Vec<(&Names, usize)> = vec![(start, 0)];
        while let Some(&mut (module, ref mut next)) = way.last_mut() {
            let other = if done.contains(&module) { None } else { links.get(module).and_then(|list| list.get(*next)) };
            *next += 1;
            let Some(other) = other else {
                done.push(module);
                way.pop();
                continue;
            };
            if let Some(at) = way.iter().position(|(known, _)| *known == other) {
                return way[at..].iter().map(|(module, _)| (*module).clone()).chain([other.clone()]).collect();
            }
            way.push((other, 0));
        }
    }
    Vec::new()
}

#[test]
fn a_circle_is_found() {
    let names = |name: &str| vec![name.to_owned()];
    let link = |from: &str, to: &[&str]| (names(from), to.iter().map(|name| names(name)).collect::<Vec<Names>>());
    let links = |list: Vec<(Names, Vec<Names>)>| list.into_iter().collect::<BTreeMap<_, _>>();
    assert!(circle(&links(vec![link("a", &["b", "c"]), link("b", &["c"]), link("c", &[])])).is_empty());
    let found = circle(&links(vec![link("a", &["b"]), link("b", &["c"]), link("c", &["b"])]));
    assert_eq!(found, ["b", "c", "b"].map(names));
}

#[test]
fn what_only_tests_need_is_left_out() {
    let text = "mod a;\n#[cfg(test)]\nmod b;\nuse c::C;\n#[cfg(test)]\n#[allow(d)]\nmod d {\n    use e::E;\n}\n\
        mod f {\n    #[cfg(test)]\n    fn g() {\n    }\n    use h::H;\n}";
    assert_eq!(links::without_tests(text.lines()), "mod a;\nuse c::C;\nmod f {\n    use h::H;\n}");
}

/// One thing at the stations of its way has one name: in the tree, in the model, in the equations.
const STATIONS: [&str; 3] = ["syntax", "model", "ir"];

/// Names that several rooms show for different types: none more, and each that is gone goes from here too.
const SHARED: &[&str] =
    &["Column", "Declaration", "JointKind", "Node", "Place", "Point", "Profile", "Segment", "Trace"];

#[test]
fn no_two_rooms_show_types_of_one_name() {
    let all = read();
    let mut known: BTreeMap<String, BTreeSet<Names>> = BTreeMap::new();
    for (name, declaring) in all.files.keys().filter(|module| module.len() == 1).flat_map(|room| all.shown(room)) {
        known.entry(name).or_default().insert(declaring);
    }
    assert!(known.len() > 200, "only {} types were looked at", known.len());
    let is_shared = |modules: &BTreeSet<Names>| {
        let rooms: BTreeSet<&str> = modules.iter().map(|module| module[0].as_str()).collect();
        rooms.len() > 1 && !rooms.iter().all(|room| STATIONS.contains(room))
    };
    let shared: Vec<&str> =
        known.iter().filter(|(_, modules)| is_shared(modules)).map(|(name, _)| name.as_str()).collect();
    assert_eq!(shared, SHARED);
}

/// What a file may use of the platform: threads, which are gone without their feature; and the server of live pages, which is too, its
/// connections and their limits.
const PLATFORM: &[(&str, &str)] = &[
    ("analysis/follow/rows/leap.rs", "std::thread"),
    ("crew/mod.rs", "std::thread"),
    ("crew/relay.rs", "std::thread"),
    ("crew/shares.rs", "std::thread"),
    ("live/http.rs", "std::time"),
    ("live/server.rs", "std::net"),
    ("live/server.rs", "std::thread"),
    ("live/server.rs", "std::time"),
    ("live/workshop.rs", "std::thread"),
    ("live/workshop.rs", "std::time"),
];

#[test]
fn rooms_know_no_files_threads_clock_or_environment() {
    let mut allowed = 0;
    for path in files("src", "rs") {
        let inside = path.strip_prefix(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).expect("below src").to_owned();
        // the command line, the language server, and what becomes part of an emitted crate
        if ["cli", "lsp", "emit/package", "main.rs"].iter().any(|place| inside.starts_with(place)) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a text");
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            assert!(!line.contains("std::{"), "{}: modules of `std` are named one by one", inside.display());
            for used in ["fs", "thread", "time", "env", "net", "process", "io::stdout", "io::stderr", "io::stdin"] {
                let used = format!("std::{used}");
                let is_allowed = PLATFORM.iter().any(|&(place, known)| inside.ends_with(place) && used == known);
                allowed += usize::from(is_allowed && line.contains(&used));
                assert!(is_allowed || !line.contains(&used), "{}: {used} is for the command line", inside.display());
            }
        }
    }
    assert!(allowed > 0, "nothing was found where something is");
}

/// What chooses code by the processor is behind one door.
#[test]
fn one_file_knows_the_library_of_vector_instructions() {
    let known: Vec<String> = files("src", "rs")
        .into_iter()
        .filter(|path| fs::read_to_string(path).expect("a text").contains("pulp::"))
        .map(|path| {
            path.strip_prefix(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).expect("below src").display().to_string()
        })
        .collect();
    assert_eq!(known, ["math/vectors.rs"]);
}

/// Each stage of the façade shows how it is used.
#[test]
fn every_stage_has_an_example_that_is_run() {
    for stage in ["Parsed", "Checked", "Compiled", "Run"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("src/stages/{}.rs", stage.to_lowercase()));
        let text = fs::read_to_string(path).expect("a text");
        let (before, _) = text.split_once(&format!("\npub struct {stage} {{")).expect("the stage");
        let docs: Vec<&str> = before.lines().rev().take_while(|line| line.starts_with(['/', '#'])).collect();
        assert_eq!(docs.iter().filter(|line| line.starts_with("/// ```")).count(), 2, "`{stage}` has no example");
        assert!(docs.contains(&"/// ```"), "the example of `{stage}` is not run");
    }
}
