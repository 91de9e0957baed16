//! Pages with sliders: what varies, what the page says of it, and what the command says.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

const EXAMPLE: &str = "slider_crank";

/// What a command said, how it ended, and the data of the page that it wrote.
struct Outcome {
    code: i32,
    said: String,
    page: Option<Value>,
    size: usize,
}

fn view_text(text: &str, arguments: &[&str], input: &str) -> Outcome {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.mech"), text).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.args(["view", "a.mech", "-o", "a.html"]).args(arguments).current_dir(folder.path());
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    let html = fs::read_to_string(folder.path().join("a.html")).ok();
    let page = html.as_ref().map(|html| {
        let (_, behind) = html.split_once("id=\"mechc\">").expect("the data");
        serde_json::from_str(behind.split_once("</script>").expect("their end").0).expect("JSON")
    });
    let (code, said) = (output.status.code().expect("a code"), String::from_utf8_lossy(&output.stderr).into_owned());
    Outcome { code, said, page, size: html.map_or(0, |html| html.len()) }
}

fn view(arguments: &[&str]) -> Outcome {
    let path = Path::new("examples").join(EXAMPLE).with_extension("mech");
    view_text(&fs::read_to_string(path).expect("an example"), arguments, "")
}

/// The size of symbols and the extent, which no variant may change.
fn changes_of_size(variant: &Value) -> bool {
    variant["scene"].get("unit").is_some() || variant["scene"].get("extent").is_some()
}

#[test]
fn variants_are_on_the_page_and_its_size_is_reported() {
    let Outcome { code, said, page, size } = view(&["--vary", "rod_length=120mm..180mm:13"]);
    assert_eq!((code, said), (0, format!("13 variants, {} kB\n", size.div_ceil(1000))));
    let page = page.expect("a page");
    assert_eq!(page["vary"][0]["values"][6], 150.0);
    assert_eq!((&page["vary"][0]["nearest"], &page["vary"][0]["own"]), (&6.into(), &Value::Null));
    let variants = page["variants"].as_array().expect("variants");
    assert_eq!(variants.len(), 13);
    assert!(variants[6].get("scene").is_none(), "the page's scene is that of the variant that it begins with");
    for variant in variants {
        assert!(!changes_of_size(variant), "the picture jumps");
        assert_eq!(variant["rows"], 81);
    }
}

#[test]
fn incomplete_variants_are_explained() {
    let Outcome { code, said, page, .. } = view(&["--vary", "rod_length=10mm..200mm:20"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("5 of them cannot be shown whole; the first is that with rod_length=10 mm:\n"), "{said}");
    assert!(said.contains("\n  error[E0601]: the mechanism cannot be assembled at t = 0 s"), "{said}");
    let page = page.expect("a page");
    let (refused, stops, whole) = (&page["variants"][0], &page["variants"][3], &page["variants"][9]);
    assert_eq!((&refused["rows"], &refused["messages"][0]["code"]), (&0.into(), &"E0601".into()));
    assert!(stops["rows"].as_u64().is_some_and(|rows| rows > 1) && stops["messages"][0]["time"].is_f64(), "{stops}");
    assert_eq!((&whole["rows"], whole["messages"].as_array().map(Vec::len)), (&81.into(), Some(0)));
    // programs are told the first reason alone
    let Outcome { code, said, .. } = view(&["--vary", "rod_length=10mm..200mm:20", "--message-format", "json"]);
    assert_eq!((code, said.lines().count()), (0, 1), "{said}");
    assert!(said.contains("E0601"), "{said}");
}

#[test]
fn the_nominal_variant_sets_the_exit_code() {
    let Outcome { code, said, page, .. } = view(&["--vary", "rod_length=10mm..20mm:2"]);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("\nerror[E0601]: the mechanism cannot be assembled"), "{said}");
    let own = page.expect("a page that shows what is the matter")["variants"][1].clone();
    assert_eq!(own["messages"][0]["code"], "E0601");
    assert!(own["drawn"].is_array(), "{own}");
}

#[test]
fn unsound_variants_have_no_picture() {
    let text = "mechanism m {
        param n = 2
        ground { point O = (0, 0) }
        body b { point O = (0, 0) point P = (1 m, 0) }
        joint j: revolute(ground.O, b.O)
        driver d: rotation(j) = step5(t, 0 s, 0 deg, (n - 1) * 1 s, 90 deg)
        analysis from 0 s to n * 1 s every 0.1 s
    }";
    let Outcome { code, said, page, .. } = view_text(text, &["--vary", "n=0..3:4"], "");
    assert_eq!(code, 0, "{said}");
    let variants = page.expect("a page")["variants"].clone();
    assert!(variants[0]["rows"] == 0 && !variants[0]["messages"].as_array().expect("messages").is_empty(), "{said}");
    assert_eq!((&variants[2]["rows"], &variants[3]["rows"]), (&21.into(), &31.into()), "times may vary too");
}

#[test]
fn standard_input_is_read_once() {
    let text = "mechanism m {
        param length = 1 m
        input turn = 0 deg
        ground { point O = (0, 0) }
        body b { point O = (0, 0) point P = (length, 0) }
        joint j: revolute(ground.O, b.O)
        driver d: rotation(j) = turn
        analysis from 0 s to 1 s every 0.1 s
    }";
    let arguments = ["--vary", "length=1m..2m:3", "--samples", "-"];
    let Outcome { code, said, page, .. } = view_text(text, &arguments, "t,turn [deg]\n0,0\n0.5,10\n1,30\n");
    assert_eq!(code, 0, "{said}");
    let variants = page.expect("a page")["variants"].clone();
    assert!(variants.as_array().expect("variants").iter().all(|variant| variant["rows"] == 11), "{said}");
}
