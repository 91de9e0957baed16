//! What the compiler's files may name of each other and of the platform. Which crate may name which, Cargo holds.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod links;

use crate::support::{files, sources};
use links::{Crate, Names};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Links that close a circle between files of one crate: none more, and each that is gone goes from here too.
const CIRCLES: &[(&str, &str)] = &[("build", "formula")];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// All crates with their names; the command line is one of them.
fn crates() -> Vec<(String, Crate)> {
    let folders = fs::read_dir(root().join("crates")).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut folders: Vec<PathBuf> = folders.collect();
    folders.sort();
    let inner = folders.into_iter().map(|folder| {
        let name = folder.file_name().expect("a name").to_string_lossy().into_owned();
        let inside = format!("crates/{name}/src");
        let read = Crate::read(&root().join(&inside), &files(&inside, "rs"));
        (name, read)
    });
    let outer = ("mechc".to_owned(), Crate::read(&root().join("src"), &files("src", "rs")));
    inner.chain([outer]).collect()
}

/// What the modules of a crate name of each other.
fn links(of: &Crate) -> BTreeMap<Names, Vec<Names>> {
    let linked = |module: &Names| of.links(module).into_iter().collect::<Vec<_>>();
    of.files.keys().map(|module| (module.clone(), linked(module))).collect()
}

#[test]
fn files_of_a_crate_name_each_other_in_one_direction() {
    let (mut unused, mut visited) = (CIRCLES.to_vec(), 0);
    for (name, of) in crates() {
        // a file and those in its folder are one, and what the root names is no folder of it
        let is_inside = |inner: &Names, outer: &Names| !outer.is_empty() && inner.starts_with(outer);
        let mut links = links(&of);
        for (module, others) in &mut links {
            visited += 1;
            others.retain(|other| {
                let link = (module.join("/"), other.join("/"));
                let is_known = unused.iter().position(|(from, to)| *from == link.0 && *to == link.1);
                is_known.map(|at| unused.remove(at));
                is_known.is_none() && !is_inside(other, module) && !is_inside(module, other) && !other.is_empty()
            });
        }
        let circle = circle(&links);
        let way: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
        assert!(circle.is_empty(), "crates/{name}: a circle: {}", way.join(" → "));
    }
    assert!(visited > 500, "only {visited} files were looked at");
    assert!(unused.is_empty(), "{unused:?}: no such links are left, and they go from the list");
}

/// The same of whole folders: those of a crate that has several at its root, and those within the analysis.
#[test]
fn modules_of_a_crate_name_each_other_in_one_direction() {
    const SEVERAL: [&str; 6] = ["text", "expr", "ir", "lang", "engine", "draw"];
    let mut visited = 0;
    for (name, of) in crates() {
        for (depth, outer) in [(1, None), (2, Some("analysis"))] {
            if !SEVERAL.contains(&name.as_str())
                || outer.is_some_and(|outer| !of.files.contains_key(&vec![outer.to_owned()]))
            {
                continue;
            }
            let is_in = |module: &&Names| module.len() >= depth && outer.is_none_or(|outer| module[0] == outer);
            let mut folders: BTreeMap<Names, Vec<Names>> = BTreeMap::new();
            for (module, others) in links(&of).iter().filter(|(module, _)| is_in(module)) {
                let folder = module[..depth].to_vec();
                let others = others.iter().filter(is_in).map(|other| other[..depth].to_vec());
                let others: Vec<Names> = others.filter(|other| *other != folder).collect();
                // the file of a crate's root and those beside it are one
                let is_folder =
                    |folder: &Names| of.files.keys().any(|module| module.len() > depth && module.starts_with(folder));
                if is_folder(&folder) {
                    visited += 1;
                    folders.entry(folder).or_default().extend(others.into_iter().filter(is_folder));
                }
            }
            let circle = circle(&folders);
            assert!(circle.is_empty(), "crates/{name}: a circle of folders: {circle:?}");
        }
    }
    assert!(visited > 100, "only {visited} files were looked at");
}

/// The layers of the check, the lowest first, by the beginnings of their modules; other modules of the check stand above all of them. The
/// second name is the struct that the layer owns.
const CHECK: &[(&[&str], &str)] = &[
    (&["errors", "library", "options", "suggest/edits", "suggest/lost_rate"], "Reporter"),
    (&["scope"], "Scope"),
    (&["formulas", "suggest"], "Formulas"),
    (&["expansion"], "Expander"),
    (&["build"], "Builder"),
];

/// A file uses its own layer and those below, and adds methods to its own layer's struct only.
#[test]
fn layers_of_the_check_use_those_below() {
    let (_, lang) = crates().into_iter().find(|(name, _)| name == "lang").expect("the crate");
    let layer = |module: &Names| {
        let (root, inner) = module.split_first()?;
        let inner = (root == "check").then(|| inner.join("/"))?;
        let is_in =
            |name: &&&str| inner.strip_prefix(**name).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        let longest = |names: &[&str]| names.iter().filter(is_in).map(|name| name.len()).max();
        let found = CHECK.iter().enumerate().filter_map(|(at, (names, _))| Some((longest(names)?, at)));
        Some(found.max().map_or(CHECK.len(), |(_, at)| at))
    };
    let mut visited = 0;
    for (module, file) in &lang.files {
        let Some(own) = layer(module) else { continue };
        visited += 1;
        // the root of the check is named by visibilities
        for other in lang.links(module).iter().filter(|other| *other != &["check"]) {
            let is_below = layer(other).is_none_or(|other| other <= own);
            assert!(is_below, "{} uses {} of a higher layer", module.join("/"), other.join("/"));
        }
        for (at, (_, owner)) in CHECK.iter().enumerate().filter(|(at, _)| *at != own) {
            let extends = |line: &str| line.starts_with("impl") && line.contains(&format!(" {owner}<"));
            assert!(!file.code.lines().any(extends), "{} adds to `{owner}` of layer {at}", module.join("/"));
        }
    }
    assert!(visited > 60, "only {visited} files were looked at");
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
fn test_code_is_stripped() {
    let text = "mod a;\n#[cfg(test)]\nmod b;\nuse c::C;\n#[cfg(test)]\n#[allow(d)]\nmod d {\n    use e::E;\n}\n\
        mod f {\n    #[cfg(test)]\n    fn g() {\n    }\n    use h::H;\n}";
    assert_eq!(links::without_tests(text.lines()), "mod a;\nuse c::C;\nmod f {\n    use h::H;\n}");
}

/// One thing at the stages of its way has one name: in the tree, in the model, in the equations.
const STAGES: [&str; 3] = ["ir", "lang", "syntax"];

/// Names that several crates export for different types: none more, and each that is gone goes from here too.
const SHARED: &[&str] = &["Column", "Declaration", "Node", "Point", "Profile", "Segment", "Trace"];

#[test]
fn no_two_crates_export_types_of_one_name() {
    let mut known: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (name, of) in crates() {
        let is_public = |module: &[String]| {
            let line = module.first().map(|name| format!("pub mod {name};"));
            line.is_none_or(|line| of.files[&Vec::new()].code.contains(&line))
        };
        let doors = of.files.keys().filter(|module| module.len() <= 1 && is_public(module));
        for (shown, declaring) in doors.flat_map(|door| of.shown(door)) {
            // what is handed on is declared elsewhere
            if of.files.contains_key(&declaring) {
                known.entry(shown).or_default().insert(name.clone());
            }
        }
    }
    assert!(known.len() > 200, "only {} types were looked at", known.len());
    let is_shared = |of: &BTreeSet<String>| of.len() > 1 && !of.iter().all(|name| STAGES.contains(&name.as_str()));
    let shared: Vec<&str> = known.iter().filter(|(_, of)| is_shared(of)).map(|(name, _)| name.as_str()).collect();
    assert_eq!(shared, SHARED);
}

/// What a file may use of the platform: threads, which are gone without their feature; and the server of live pages, which is too, its
/// connections and their limits.
const PLATFORM: &[(&str, &str)] = &[
    ("engine/src/analysis/follow/rows/row_batch.rs", "std::thread"),
    ("parallel/src/lib.rs", "std::thread"),
    ("parallel/src/ordered_pipeline.rs", "std::thread"),
    ("parallel/src/scoped_chunks.rs", "std::thread"),
    ("live/src/http.rs", "std::time"),
    ("live/src/server.rs", "std::net"),
    ("live/src/server.rs", "std::thread"),
    ("live/src/server.rs", "std::time"),
    ("live/src/session.rs", "std::thread"),
    ("live/src/session.rs", "std::time"),
];

#[test]
fn libraries_know_no_files_threads_clock_or_environment() {
    let mut allowed = 0;
    for path in sources("rs") {
        let inside = path.strip_prefix(root()).expect("below the root").to_owned();
        // the command line, the language server, and what becomes part of an emitted crate
        if ["src", "crates/ide/src/lsp", "crates/emit/src/package"].iter().any(|place| inside.starts_with(place)) {
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
    let known = sources("rs").into_iter().filter(|path| fs::read_to_string(path).expect("a text").contains("pulp::"));
    let known: Vec<PathBuf> = known.map(|path| path.strip_prefix(root()).expect("below the root").to_owned()).collect();
    assert_eq!(known, [Path::new("crates/expr/src/math/vectors.rs")]);
}

/// Each stage of the façade shows how it is used.
#[test]
fn every_stage_has_an_example_that_is_run() {
    for stage in ["Parsed", "Checked", "Compiled", "Run"] {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("crates/pipeline/src/{}.rs", stage.to_lowercase()));
        let text = fs::read_to_string(path).expect("a text");
        let (before, _) = text.split_once(&format!("\npub struct {stage} {{")).expect("the stage");
        let docs: Vec<&str> = before.lines().rev().take_while(|line| line.starts_with(['/', '#'])).collect();
        assert_eq!(docs.iter().filter(|line| line.starts_with("/// ```")).count(), 2, "`{stage}` has no example");
        assert!(docs.contains(&"/// ```"), "the example of `{stage}` is not run");
    }
}
