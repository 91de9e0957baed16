//! The command line as a user types it: what a session cannot show; `tests/listed/sessions.rs` runs those of `tests/cli`.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::random::Random;
use assert_cmd::Command;
use std::fs;
use std::io::Write;
use std::path::Path;

fn mechc() -> Command {
    Command::new(env!("CARGO_BIN_EXE_mechc"))
}

const SLIDER_CRANK: &str = "examples/slider_crank.mech";

/// What it printed to standard error, after it ended with an exit code.
fn failure(arguments: &[&str], code: i32) -> String {
    let output = mechc().args(arguments).output().expect("it runs");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[test]
fn unreadable_and_unwritable_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    assert!(failure(&["run", &inside("missing.mech")], 4).contains("E0701"));
    assert!(failure(&["check", &inside("")], 4).contains("E0701"));
    assert!(failure(&["run", SLIDER_CRANK, "-o", &inside("no/such/folder.csv")], 4).contains("there is no folder"));
    assert!(failure(&["run", SLIDER_CRANK, "-o", &inside("")], 4).contains("E0702"));
    fs::write(inside("latin1.mech"), b"mechanism caf\xe9 {}").unwrap();
    assert!(failure(&["check", &inside("latin1.mech")], 1).contains("E0102"));
    fs::write(inside("empty.mech"), b"").unwrap();
    assert!(failure(&["check", &inside("empty.mech")], 1).contains("E0104"));
    let mut random = Random::new(1);
    let noise: Vec<u8> = (0..1_000_000).map(|_| random.below(256) as u8).collect();
    fs::write(inside("noise.mech"), noise).unwrap();
    assert!(failure(&["check", &inside("noise.mech")], 1).contains("E0102"));
}

#[test]
fn a_parquet_table_holds_the_numbers_of_the_csv() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    mechc().args(["run", SLIDER_CRANK, "-o", &inside("out.csv")]).assert().success();
    mechc().args(["run", SLIDER_CRANK, "-o", &inside("out.parquet")]).assert().success().stdout("");
    mechc().args(["run", SLIDER_CRANK, "--format", "parquet", "-o", &inside("plain")]).assert().success();
    assert_eq!(
        fs::read(inside("out.parquet")).unwrap(),
        fs::read(inside("plain")).unwrap(),
        "by its ending or by name"
    );
    let piped = mechc().args(["run", SLIDER_CRANK, "--format", "parquet"]).output().unwrap().stdout;
    assert_eq!(piped, fs::read(inside("plain")).unwrap());
    let text = fs::read_to_string(inside("out.csv")).unwrap();
    let mut lines = text.lines();
    let reader = SerializedFileReader::new(fs::File::open(inside("out.parquet")).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    let names: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
    assert_eq!(names.join(","), lines.next().expect("a header"));
    for row in reader.get_row_iter(None).unwrap() {
        let row = row.unwrap();
        let numbers: Vec<f64> = lines.next().expect("a row").split(',').map(|n| n.parse().unwrap()).collect();
        for (k, number) in numbers.iter().enumerate() {
            assert_eq!(row.get_double(k).unwrap().to_bits(), number.to_bits(), "{}", names[k]);
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn a_result_is_replaced_whole_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.csv");
    fs::write(&out, "precious").unwrap();
    let out_name = out.to_string_lossy().into_owned();
    failure(&["run", SLIDER_CRANK, "--set", "rod_length=1 s", "-o", &out_name], 2);
    assert_eq!(fs::read_to_string(&out).unwrap(), "precious");
    mechc().args(["run", SLIDER_CRANK, "-o", &out_name]).assert().success().stdout("");
    let table = fs::read_to_string(&out).unwrap();
    assert!(table.starts_with("t,crank.x,"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left behind");
}

#[test]
fn rows_before_a_lock_up_are_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.csv").to_string_lossy().into_owned();
    let text = failure(&["run", "tests/ui/run/four_bar_into_lock_up.mech", "-o", &out], 3);
    assert!(text.contains("E0602") && text.contains("motor"), "{text}");
    let rows = fs::read_to_string(Path::new(&out)).unwrap().lines().count();
    assert!(rows > 10, "{rows} rows");
}

#[test]
fn closed_pipes_are_no_error() {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_mechc"))
        .args(["run", "tests/cases/four_bar.mech", "--every", "1e-5"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it runs");
    // closes the pipe without reading
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// What a message says, without the lines that it quotes.
fn messages(text: &str) -> String {
    let is_quoted = |line: &&str| line.contains(" │ ") && line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    text.lines().filter(|line| !is_quoted(line)).collect::<Vec<&str>>().join("\n")
}

#[test]
fn numbers_in_messages_are_not_written_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("numbers.mech").to_string_lossy().into_owned();
    let run = |text: &str, options: &[&str], code: i32| {
        fs::write(&file, format!("mechanism m {{ {text} }}")).unwrap();
        let text = messages(&failure(&[&["run", &file], options].concat(), code));
        assert!(!text.contains("000000"), "{text}");
        text
    };
    let disc = "ground { point O = (0, 0) } body b { point O = (0, 0) } joint j: revolute(ground.O, b.O)
        driver d: rotation(j) = t / 1 s";
    for tiny in ["1e-300", "3e-7", "2.5e-12"] {
        let negative = &format!("-{tiny}");
        assert!(run(disc, &["--from", "0", "--to", "1", "--every", negative], 2).contains(&format!("{negative} s")));
        assert!(
            run(disc, &["--from", "1e200", "--to", tiny, "--every", "1"], 2).contains(&format!("at {tiny} s, before"))
        );
        assert!(run(disc, &["--from", tiny, "--at", negative], 2).contains(&format!("`--at` {negative} s")));
        assert!(run(&format!("{disc} analysis from 0 s to 1 s every -{tiny} s"), &[], 1).contains("E0407"));
        let backwards = run(&format!("{disc} analysis from 1e30 s to {tiny} s every 1 s"), &[], 1);
        assert!(
            backwards.contains("E0408") && backwards.contains(&format!("`from {tiny} s to 1e30 s`")),
            "{backwards}"
        );
        assert!(
            run(&format!("{disc} table f = spline [(0, 0), ({tiny}, 1), (-{tiny}, 2)]"), &[], 1)
                .contains(&format!("-{tiny} follows {tiny}"))
        );
        assert!(run(&format!("ground {{ circle c = (0, 0) radius -{tiny} m }} {disc}"), &[], 1).contains("E04"));
    }
    assert!(run(disc, &["--from", "0", "--to", "1e300", "--every", "1e-300"], 2).contains("1e-300 s is too small"));
    // a warning in its words
    fs::write(&file, format!("mechanism m {{ {disc} measure s = sin(1e30) analysis from 0 s to 1 s every 1 s }}"))
        .unwrap();
    let output = mechc().args(["run", &file]).output().expect("it runs");
    let text = messages(&String::from_utf8_lossy(&output.stderr));
    assert!(!text.contains("000000"), "{text}");
}

#[test]
fn emitted_code_omits_redundant_equations() {
    let door = "tests/ui/ndof/same_pin_twice.mech";
    assert!(failure(&["emit", door], 1).contains("--allow-redundant"));
    let emitted = |more: &[&str]| {
        let output = mechc().args(["emit", door, "--allow-redundant"]).args(more).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0));
        assert!(String::from_utf8_lossy(&output.stderr).contains("W0502"));
        String::from_utf8(output.stdout).expect("text")
    };
    for form in [&[][..], &["--with", "equations"]] {
        let rust = emitted(form);
        assert!(rust.contains("pub const LEFT_OUT: usize = 2;") && rust.contains("joint `lower`: 2"), "{rust}");
        assert!(rust.contains("pub fn left_out("), "{rust}");
    }
    assert!(emitted(&["--format", "latex"]).contains("left out: 2 of \\textbf{lower}"));
    let json: serde_json::Value = serde_json::from_str(&emitted(&["--format", "json"])).expect("JSON");
    assert_eq!(json["left_out"].as_array().expect("a list").len(), 2);
}

#[test]
fn standard_input_and_json() {
    let text = fs::read_to_string(SLIDER_CRANK).unwrap();
    let output =
        mechc().args(["run", "-", "--format", "json", "--at", "0"]).write_stdin(text.as_str()).output().unwrap();
    let table: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let rows = table["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0].as_array().expect("a row").len(), table["columns"].as_array().expect("columns").len());
}

#[test]
fn json_diagnostics_have_character_positions() {
    let text = "/// é\nmechanism ü { body µ at (0, 0, 9) {} driver d: angle(µ) = lenght }";
    let output = mechc().args(["check", "-", "--message-format", "json"]).write_stdin(text).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    let diagnostics: Vec<serde_json::Value> =
        text.lines().map(|line| serde_json::from_str(line).expect("an object a line")).collect();
    assert_eq!(diagnostics.len(), 2, "{text}");
    assert_eq!(diagnostics[0]["code"], "W0401");
    assert_eq!(diagnostics[0]["severity"], "warning");
    let label = &diagnostics[0]["labels"][0];
    assert_eq!(label["primary"], true);
    assert_eq!((&label["start"]["line"], &label["start"]["column"]), (&2.into(), &32.into()));
    assert_eq!(label["end"]["column"], 33);
    assert_eq!(diagnostics[1]["code"], "E0201");
    assert!(diagnostics[1]["data"].is_object());
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn settings_are_checked() {
    assert!(failure(&["run", SLIDER_CRANK, "--set", "rod_lenght=1 m"], 2).contains("was `rod_length` meant?"));
    assert!(failure(&["run", SLIDER_CRANK, "--set", "rod_length"], 2).contains("E0706"));
    assert!(failure(&["run", SLIDER_CRANK, "--set", "rod_length=60"], 2).contains("E0402"));
    assert!(failure(&["run", SLIDER_CRANK, "--mechanism", "slyder"], 2).contains("E0704"));
    assert!(failure(&["run", SLIDER_CRANK, "--every", "0"], 2).contains("E0706"));
    assert!(failure(&["run", SLIDER_CRANK, "--every", "0", "--at", "0.1"], 2).contains("must be positive"));
    assert!(failure(&["run", SLIDER_CRANK, "--every", "1 mm"], 2).contains("E0402"));
    assert!(failure(&["run", SLIDER_CRANK, "--from", "1", "--to", "0.5"], 2).contains("before its start"));
    assert!(failure(&["run", SLIDER_CRANK, "--at=-1"], 2).contains("before the start"));
    let timeless = fs::read_to_string(SLIDER_CRANK).unwrap().replace("analysis", "// analysis");
    let output = mechc().args(["run", "-", "--from", "0"]).write_stdin(timeless).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("E0705"));
    assert!(failure(&["run", SLIDER_CRANK, "--set", "rod_length=crank_length"], 2).contains("cannot name"));
    let run = |arguments: &[&str]| -> String {
        let output = mechc().args(["run", SLIDER_CRANK, "--at", "0"]).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(run(&["--set", "rod_length=20 cm"]), run(&["--set", "rod_length=1 m", "--set", "rod_length=0.2 m"]));
    assert_ne!(run(&[]), run(&["--set", "rod_length=20 cm"]));
}

#[test]
fn colour_only_on_request() {
    let colored = |arguments: &[&str]| -> bool {
        let mut command = mechc();
        command.args(["check", "-"]).args(arguments);
        let output = command.write_stdin("mechanism").output().unwrap();
        output.stderr.contains(&0x1b)
    };
    assert!(!colored(&[]), "standard error is no terminal here");
    assert!(colored(&["--color", "always"]));
    assert!(!colored(&["--color", "never"]));
    std::io::stderr().flush().unwrap();
}

#[test]
fn timings_are_on_standard_error() {
    let output = mechc().args(["run", SLIDER_CRANK, "--timings"]).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    let words: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(words[..6], ["parse", "check", "prove", "program", "solve", "write"], "{text}");
    let last = text.lines().last().expect("a line");
    assert!(last.ends_with("ns per step"), "{last}");
    assert!(output.status.success());
    let without = mechc().args(["run", SLIDER_CRANK]).output().unwrap();
    assert_eq!(output.stdout, without.stdout, "the table is the same");
}

/// A block that is moved by a table in a file.
const BLOCK: &str = "mechanism block {
    table way = spline \"way.csv\" (ms, mm)
    ground { axis rail = (0, 0) along (1, 0) }
    body block { axis rail = (0, 0) along (1, 0) }
    joint guide: translational(ground.rail, block.rail)
    driver push: displacement(guide) = way(t)
    analysis from 0 s to 20 ms every 10 ms
}";

#[test]
fn tables_are_read_relative_to_their_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    fs::write(inside("block.mech"), BLOCK).unwrap();
    let plain = "0,0\n10,1.5\n20,4\n";
    fs::write(inside("way.csv"), plain).unwrap();
    let run = |file: &str| mechc().args(["run", file]).output().expect("it runs");
    let wanted = run(&inside("block.mech"));
    assert!(wanted.status.success(), "{}", String::from_utf8_lossy(&wanted.stderr));
    let table = String::from_utf8(wanted.stdout.clone()).expect("text");
    assert!(table.lines().nth(2).expect("rows").starts_with("0.01,0.0015,0.0,0.0,"), "{table}");
    // as Windows and spreadsheets write it
    for text in [
        "\u{feff}time,way\r\n0,0\r\n10,1.5\r\n20,4\r\n",
        "0 , 0\n 10,1.5e0\n\n2e1,+4",
        "time in ms,way in mm\n0,0\n10.0,1.50\n20,4.\n\n",
    ] {
        fs::write(inside("way.csv"), text).unwrap();
        assert_eq!(run(&inside("block.mech")).stdout, wanted.stdout, "{text:?}");
    }
    // from standard input the current folder counts
    fs::write(inside("way.csv"), plain).unwrap();
    let piped = mechc().current_dir(folder.path()).args(["run", "-"]).write_stdin(BLOCK).output().expect("it runs");
    assert_eq!(piped.stdout, wanted.stdout);
}

#[test]
fn a_table_that_cannot_be_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    fs::write(inside("block.mech"), BLOCK).unwrap();
    let missing = failure(&["run", &inside("block.mech")], 1);
    assert!(missing.contains("E0701") && missing.contains("block.mech:2:24"), "{missing}");
    fs::create_dir(inside("way.csv")).unwrap();
    assert!(failure(&["check", &inside("block.mech")], 1).contains("E0701"));
    fs::remove_dir(inside("way.csv")).unwrap();
    fs::write(inside("way.csv"), b"0,0\n10,1.5\n20,\xb5\n").unwrap();
    let latin = failure(&["run", &inside("block.mech")], 1);
    assert!(latin.contains("E0102") && latin.contains("way.csv:3:4"), "{latin}");
    fs::write(inside("way.csv"), "time,way\n0,0\n1,000,5\n").unwrap();
    let thousands = failure(&["run", &inside("block.mech")], 1);
    assert!(thousands.contains("E0416") && thousands.contains("way.csv:3:1"), "{thousands}");
    assert!(thousands.contains("without separators between their thousands"), "{thousands}");
}

/// A mechanism with mistakes that leave no doubt of what is meant, in a file of another system.
const DRAFT: &str = "\u{feff}mechanism disc {\r\n    # the wheel\r\n    param r = 2 ** 3;\r\n    ground { point O = (0, 0) }\r\n    \
    body wheel {   point O = (0, 0   }\r\n    joint axle: revolute(ground.O, wheel.O)\r\n    driver motor: rotation(axle) == r * t\r\n}";

fn mended_draft() -> String {
    let mended = DRAFT.replace("# the", "// the").replace("**", "^").replace(';', "").replace("(0, 0 ", "(0, 0) ");
    mended.replace("==", "=")
}

#[test]
fn mistakes_without_doubt_are_mended_in_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("disc.mech");
    let name = file.to_string_lossy().into_owned();
    fs::write(&file, DRAFT).unwrap();
    let output = mechc().args(["check", &name, "--fix"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("mechanism disc is determined"));
    let reported = String::from_utf8(output.stderr).unwrap();
    let lines: Vec<&str> = reported.lines().map(|line| line.trim_start_matches(name.as_str())).collect();
    let last = format!("fixed 5 in `{name}`");
    let wanted = [
        ":2:5: a comment begins with `//`: `#` → `//`",
        ":3:17: a power is written with `^`: `**` → `^`",
        ":3:20: declarations need no terminator; leave the `;` out: `;` taken out",
        ":5:35: close it with `)`: `)` put in",
        ":7:34: an equation is written with one `=`: `==` → `=`",
        &last,
    ];
    assert_eq!(lines, wanted);
    assert_eq!(fs::read_to_string(&file).unwrap(), mended_draft());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left behind");
    // nothing is left to do: the file is not even written
    let written = fs::metadata(&file).unwrap().modified().unwrap();
    mechc().args(["check", &name, "--fix"]).assert().success().stderr(format!("nothing to fix in `{name}`\n"));
    assert_eq!(fs::metadata(&file).unwrap().modified().unwrap(), written);
}

#[test]
fn remaining_mistakes_set_the_exit_code() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("disc.mech");
    let name = file.to_string_lossy().into_owned();
    fs::write(&file, DRAFT.replace("wheel.O)", "wheel.P)")).unwrap();
    let reported = failure(&["check", &name, "--fix", "--message-format", "short"], 1);
    assert!(
        reported.contains("`wheel` has no point `P`")
            && reported.contains(":7:34: an equation is written with one `=`"),
        "{reported}"
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), mended_draft().replace("wheel.O)", "wheel.P)"));
    fs::write(&file, DRAFT).unwrap();
    let reported = mechc().args(["check", &name, "--fix", "--message-format", "json"]).output().unwrap().stderr;
    let lines: Vec<serde_json::Value> = String::from_utf8(reported)
        .unwrap()
        .lines()
        .map(|line| serde_json::from_str(line).expect("an object"))
        .collect();
    assert!(lines.iter().all(|line| line["fixed"]["applies"] == "always"), "{lines:?}");
    assert_eq!(lines[0]["fixed"]["edits"][0]["start"]["line"], 2);
}

#[test]
fn standard_input_is_mended_to_standard_output() {
    let output = mechc().args(["check", "-", "--fix"]).write_stdin(DRAFT).output().unwrap();
    assert_eq!((output.status.code(), String::from_utf8(output.stdout).unwrap()), (Some(0), mended_draft()));
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(
        reported.contains("<stdin>:2:5: a comment") && reported.contains("mechanism disc is determined"),
        "{reported}"
    );
    // what has no mistake comes out as it is, and so does what cannot be mended
    for (text, code) in [(mended_draft(), 0), (mended_draft().replace("wheel.O)", "wheel.P)"), 1)] {
        let output = mechc().args(["check", "-", "--fix"]).write_stdin(text.clone()).output().unwrap();
        assert_eq!((output.status.code(), String::from_utf8(output.stdout).unwrap()), (Some(code), text));
    }
}

#[cfg(unix)]
#[test]
fn fixed_files_are_replaced_like_results() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let (file, link) = (folder.path().join("disc.mech"), folder.path().join("link.mech"));
    let (name, link_name) = (file.to_string_lossy().into_owned(), link.to_string_lossy().into_owned());
    fs::write(&file, DRAFT).unwrap();
    std::os::unix::fs::symlink("disc.mech", &link).unwrap();
    let with_mode = |mode| fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
    with_mode(0o444);
    let reported = failure(&["check", &name, "--fix"], 4);
    assert!(
        reported.contains("E0702") && reported.contains("E0101"),
        "it may not be written, and what is wrong with it is told: {reported}"
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), DRAFT);
    with_mode(0o640);
    mechc().args(["check", &link_name, "--fix"]).assert().success();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&file).unwrap(), mended_draft());
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_used_is_that_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let mechanism = |name: &str| {
        format!(
            "mechanism {name} {{ ground {{ point O = (0, 0) }} body b {{ point O = (0, 0) }} \
             joint j: revolute(ground.O, b.O) driver d: rotation(j) = t }}\n"
        )
    };
    std::os::unix::fs::symlink("leg.mech", inside("link.mech")).unwrap();
    std::os::unix::fs::symlink(".", inside("here")).unwrap();
    fs::write(inside("leg.mech"), mechanism("leg")).unwrap();
    fs::write(inside("walker.mech"), format!("use \"leg.mech\"\nuse \"link.mech\"\n{}", mechanism("walker"))).unwrap();
    mechc().args(["check", &inside("walker.mech")]).assert().success();
    // each link leads one folder deeper, and to the same file
    fs::write(inside("leg.mech"), format!("use \"here/leg.mech\"\n{}", mechanism("leg"))).unwrap();
    let circle = failure(&["check", &inside("walker.mech")], 1);
    assert!(circle.contains("E0206") && circle.contains("uses itself"), "{circle}");
}
