//! Parts: a mechanism that is used in another one does what it does alone, seen from its own ground.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![allow(clippy::case_sensitive_file_extension_comparisons)] // `.d` ends a column

use crate::support::random::Random;
use crate::support::table::Table;
use crate::support::{Disk, files};
use mechc::{Cancel, Choice, Parsed, Redundant, RunOptions, Sources, Times};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// How far a number of a part may be from what it is alone: of the larger of its range and the distance of the mount.
const SAME: f64 = 1e-10;

/// The name under which a part stands in the tests.
const PART: &str = "p";

/// Runs a mechanism of a text; of one that is refused, or stops, the codes.
fn run(text: &str, file: &Path, mechanism: &str, times: Option<&Times>) -> Result<(Table, Times), String> {
    let choice = Choice { mechanism: Some(mechanism.to_owned()), ..Choice::default() };
    let mut sources = Sources::default();
    let id = sources.add("text", text);
    let parsed = Parsed::from_source(sources, id, file);
    let checked = parsed.check(&choice, &Disk::default());
    let (compiled, messages) = checked.compile(Redundant::LeftOut, &Cancel::default());
    let reported = || {
        let all = checked.diagnostics().iter().chain(messages.iter());
        all.map(|d| format!("{} {}", d.code.as_str(), d.message)).collect::<Vec<_>>().join("; ")
    };
    let compiled = compiled.ok_or_else(reported)?;
    let times = match (times, compiled.analysis()) {
        (Some(times), _) => times.clone(),
        (None, Some([from, to, every])) => Times::grid(from, to, every).ok_or("no grid")?,
        (None, None) => return Err("no analysis".to_owned()),
    };
    let (run, messages) = compiled.run(&times, &RunOptions::default());
    let mut run = run.ok_or_else(|| messages.iter().map(|d| d.code.as_str()).collect::<Vec<_>>().join(" "))?;
    let columns = run.columns().to_vec();
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        rows.push(row.map_err(|why| why.first().expect("an error").code.as_str().to_owned())?.to_vec());
    }
    Ok((Table { columns, rows }, times))
}

/// The names behind a keyword in a text, each with what stands behind it.
fn named<'t>(text: &'t str, keyword: &str) -> Vec<(&'t str, &'t str)> {
    let lines = text.lines().map(str::trim_start).filter_map(|line| line.strip_prefix(keyword)?.strip_prefix(' '));
    lines
        .map(str::trim_start)
        .filter_map(|line| {
            let end = line.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
            Some((&line[..end], &line[end..]))
        })
        .collect()
}

/// A mechanism with measures of all that can be asked of its bodies and joints.
fn measured(text: &str) -> String {
    let mut requested = String::new();
    for (body, rest) in named(text, "body") {
        if !rest.trim_start().starts_with('[') {
            let _ = write!(
                requested,
                "    measure of_x_{body} = x({body}.own_origin)\n    measure of_y_{body} = y({body}.own_origin)\n"
            );
            let _ = write!(
                requested,
                "    measure of_phi_{body} = angle({body})\n    measure of_v_{body} = speed({body}.own_origin)\n"
            );
        }
    }
    for (joint, rest) in named(text, "joint") {
        let kind = rest.trim_start_matches([':', ' ']);
        if kind.starts_with("revolute(") {
            let _ = writeln!(requested, "    measure of_turn_{joint} = rotation({joint})");
        } else if kind.starts_with("translational(") {
            let _ = writeln!(requested, "    measure of_way_{joint} = displacement({joint})");
        }
    }
    let mut changed = String::new();
    for line in text.lines() {
        let is_body = line.trim_start().starts_with("body ") && !line.contains('[');
        match line.find('{').filter(|_| is_body) {
            Some(brace) => {
                let (head, rest) = line.split_at(brace + 1);
                let _ = writeln!(changed, "{head} point own_origin = (0, 0) {rest}");
            }
            None => changed += &format!("{line}\n"),
        }
    }
    let end = changed.rfind('}').expect("a mechanism");
    changed.insert_str(end, &requested);
    changed
}

/// The examples and cases with one mechanism that is determined alone, each with its name. Forces are those of the outermost frame, which
/// `crates/engine/tests/engine/force_laws.rs` looks at: here nobody asks for them.
fn mechanisms() -> Vec<(PathBuf, String, String)> {
    let mut found = Vec::new();
    for folder in ["examples", "tests/cases"] {
        for file in files(folder, "mech") {
            let text = std::fs::read_to_string(&file).expect("a text");
            if text.contains("effort(") {
                continue;
            }
            if let [(name, _)] = named(&text, "mechanism")[..] {
                found.push((file, name.to_owned(), measured(&text)));
            }
        }
    }
    assert!(found.len() > 50, "only {}", found.len());
    found
}

/// What stands around a part.
fn around(name: &str, carrier: &str, place: [f64; 3], is_mirrored: bool) -> String {
    let [x, y, phi] = place;
    let on = if carrier.is_empty() { "" } else { " on carrier" };
    let mirrored = if is_mirrored { " mirrored" } else { "" };
    format!(
        "mechanism outer_one {{\n{carrier}\n    part {PART}: {name}(){on} at ({x:?}, {y:?}, {phi:?}){mirrored}\n}}\n"
    )
}

/// A body that goes up to so far and turns as it likes.
fn carrier(size: f64) -> String {
    format!(
        "    body carrier {{ point O = (0, 0) }}
    driver along:  x(carrier.O) = {size:?} * sin(1.3 * t)
    driver across: y(carrier.O) = {size:?} * cos(0.7 * t)
    driver spin:   angle(carrier) = 0.4 + 0.9 * t"
    )
}

/// The largest difference of a part's own numbers from those of the mechanism alone, as a part of what may be.
fn largest_difference(alone: &Table, part: &Table, distance: f64) -> (f64, String) {
    let mut largest = (0.0, String::new());
    let prefix = format!("{PART}.");
    for name in &part.columns {
        let Some(own) = name.strip_prefix(&prefix) else { continue };
        let is_of_a_body = [".x", ".y", ".phi"].iter().any(|end| own.split(".d").next().unwrap().ends_with(end));
        let is_a_derivative = own.ends_with(".d") || own.ends_with(".dd");
        if !alone.columns.iter().any(|column| column == own) || is_of_a_body || is_a_derivative {
            continue;
        }
        let (want, got) = (alone.column(own), part.column(name));
        let (low, high) = want.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let scale = (high - low).max(distance);
        for (want, got) in want.iter().zip(&got) {
            let is_same = want.to_bits() == got.to_bits() || want.is_nan() && got.is_nan();
            let difference = if is_same { 0.0 } else { (want - got).abs() / scale };
            if difference > largest.0 || difference.is_nan() {
                largest = (difference, name.clone());
            }
        }
    }
    largest
}

#[test]
fn parts_match_single_mechanisms_in_their_frame() {
    let mut random = Random::new(20);
    let (mut compared, mut faults) = (0, Vec::new());
    for (file, name, text) in mechanisms() {
        let Ok((alone, times)) = run(&text, &file, &name, None) else { continue };
        let size = alone.columns.iter().filter(|column| column.ends_with(".x") || column.ends_with(".y"));
        let size = size.flat_map(|column| alone.column(column)).map(f64::abs).fold(1e-3, f64::max);
        for (carried, is_mirrored) in [(false, false), (false, true), (true, false), (true, true)] {
            let [x, y] = [0; 2].map(|_| random.between(-10.0 * size, 10.0 * size));
            let place = [x, y, random.between(-3.0, 3.0)];
            let carrier = if carried { carrier(size) } else { String::new() };
            let whole = format!("{text}\n{}", around(&name, &carrier, place, is_mirrored));
            compared += 1;
            match run(&whole, &file, "outer_one", Some(&times)) {
                Err(why) => faults.push(format!("{name} carried {carried} mirrored {is_mirrored}: {why}")),
                Ok((part, _)) => {
                    let distance = mechc_expr::math::hypot(place[0], place[1]) + if carried { size } else { 0.0 };
                    let (difference, column) = largest_difference(&alone, &part, distance);
                    if difference > SAME || difference.is_nan() || part.rows.len() != alone.rows.len() {
                        faults
                            .push(format!("{name} carried {carried} mirrored {is_mirrored}: {column} {difference:e}"));
                    }
                }
            }
        }
    }
    assert!(compared > 150, "only {compared}");
    assert!(faults.is_empty(), "{} of {compared}:\n{}", faults.len(), faults.join("\n"));
}

/// What is said of the mechanism `whole` of a text, and its rows.
fn messages(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
    let checked = Parsed::new("text", text).check(&choice, &Disk::default());
    let (compiled, of_proof) = checked.compile(Redundant::Refused, &Cancel::default());
    let mut all: Vec<String> = checked.diagnostics().iter().chain(of_proof.iter()).map(|d| d.message.clone()).collect();
    let Some(compiled) = compiled else { return (all, Vec::new()) };
    let (run, of_start) = compiled.run(&compiled.times().expect("an analysis"), &RunOptions::default());
    all.extend(of_start.iter().map(|d| d.message.clone()));
    let mut rows = Vec::new();
    if let Some(mut run) = run {
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => rows.push(row.to_vec()),
                Err(why) => all.extend(why.diagnostics.iter().map(|d| d.message.clone())),
            }
        }
    }
    (all, rows)
}

#[test]
fn bound_inputs_ignore_limits_of_their_formula() {
    let leaf = "mechanism leaf {
        table some = spline [(0, 0), (1, 1)]
        input turn = some(t)
        body b { point O = (0, 0) }
        joint j: revolute((0, 0), b.O)
        driver d: rotation(j) = turn
    }";
    let around = |part: &str| format!("mechanism whole {{ part p: {part} analysis from 0 to 3 every 1 }}\n{leaf}");
    let (bound, rows) = messages(&around("leaf(turn = 0.5 * t)"));
    assert!(bound.is_empty() && rows.len() == 4, "{bound:?}");
    let (own, _) = messages(&around("leaf()"));
    assert_eq!(own, ["table `some` does not reach as far as `p.turn` goes at t = 1 s"]);
}

/// A rocker whose crank cannot go round: there is a dead point in its way to either side.
const LEVER: &str = "mechanism lever {
    input turn = 60 deg
    ground { point O = (0, 0)  point D = (4, 0) }
    body crank at (0, 0, 60 deg) { point O = (0, 0)  point P = (3, 0) }
    body rod at (1.5, 2.6, -10 deg) { point P = (0, 0)  point Q = (1.5, 0) }
    body rocker at (4, 0, 110 deg) { point D = (0, 0)  point Q = (2.5, 0) }
    joint a: revolute(ground.O, crank.O)
    joint b: revolute(crank.P, rod.P)
    joint c: revolute(rod.Q, rocker.Q)
    joint d: revolute(ground.D, rocker.D)
    driver motor: rotation(a) = turn
}";

#[test]
fn repeated_parts_start_as_single_ones() {
    let around = |part: &str| format!("mechanism whole {{ {part} analysis from 0 to 0 every 1 }}\n{LEVER}");
    let turns = [62.0, 40.0, 55.0, 61.0, 60.0, 40.0, 35.0];
    let all: Vec<String> =
        turns.iter().enumerate().map(|(k, turn)| format!("part p{k}: lever(turn = {turn} deg)\n")).collect();
    let (reported, rows) = messages(&around(&all.concat()));
    assert!(reported.is_empty(), "{reported:?}");
    for (k, turn) in turns.iter().enumerate() {
        let (reported, alone) = messages(&around(&format!("part p: lever(turn = {turn} deg)\n")));
        assert!(reported.is_empty(), "{reported:?}");
        assert_eq!(rows[0][1 + 9 * k..][..9], alone[0][1..10], "turn = {turn} deg");
    }
}

#[test]
fn repeated_parts_report_failures_separately() {
    let parts = "part near: lever(turn = 66 deg)  part far: lever(turn = 200 deg)  part farther: lever(turn = 250 deg)";
    let (reported, _) = messages(&format!("mechanism whole {{ {parts} analysis from 0 to 0 every 1 }}\n{LEVER}"));
    let not_led: Vec<&String> =
        reported.iter().filter(|message| message.starts_with("on the way of the part")).collect();
    let place = |message: &str| message.split(" = ").nth(1).map(str::to_owned);
    assert_eq!(not_led.len(), 2, "{reported:?}");
    assert!(not_led[0].contains("`far`") && not_led[1].contains("`farther`"), "{reported:?}");
    assert_eq!(place(not_led[0]), place(not_led[1]), "the dead point is where it is");
    // where the rod and the rocker are in line, at acos(9/24)
    assert_eq!(place(not_led[0]).as_deref(), Some("1.186399552 rad"));
}

#[test]
fn parts_on_turning_bodies_match_single_ones() {
    // a body without extent, whose size is that of what it is joined to
    let part = "mechanism guided {
        ground { point D = (60 mm, 0) }
        body arm { point O = (0, 0)  point P = (30 mm, 0) }
        body eye at (30 mm, 0, 0) { point c = (0, 0)  axis along_slot = c along (1, 0) }
        joint main: revolute((0, 0), arm.O)
        joint pin: revolute(arm.P, eye.c)
        joint slot: revolute_translational(ground.D, eye.along_slot, 1 mm)
        driver motor: rotation(main) = 5 rad/s * t
        measure turned = angle(eye)
        analysis from 0 s to 1 s every 0.1 s
    }";
    let (_, alone) = messages(&part.replace("mechanism guided", "mechanism whole"));
    for distance in ["45 m", "100 m", "10 km", "100 km"] {
        let distance = distance.replace(" km", "000 m");
        let text = format!(
            "mechanism whole {{
                body base {{ point h = (0, 0) }}
                driver across: x(base.h) = 0
                driver up: y(base.h) = 0
                driver turn: angle(base) = 10 rad/s * t
                part p: guided() on base at ({distance}, 0, 0)
                measure turned = p.turned
                analysis from 0 s to 1 s every 0.1 s
            }}
            {part}"
        );
        let (reported, rows) = messages(&text);
        assert!(reported.is_empty(), "{distance}: {reported:?}");
        assert_eq!(rows.len(), alone.len(), "{distance}");
    }
}

/// A carrier that turns, an arm that is turned over, and a part of one text somewhere.
fn placed(place: &str, measures: &str) -> Vec<Vec<f64>> {
    let text = format!(
        "mechanism whole {{
    param A = (7 mm, 8 mm)
    ground {{ point G = (100 mm, 50 mm) }}
    body f at (10 mm, 20 mm, 90 deg) {{ point O = (0, 0)  point P = (30 mm, 5 mm) }}
    joint j: revolute((10 mm, 20 mm), f.O)
    driver d: rotation(j) = 90 deg + 1 rad/s * t
    part k: arm() on f at (A, 20 deg) mirrored
    part p: arm() {place}
    {measures}
    analysis from 0 s to 1 s every 0.5 s
}}
mechanism arm {{
    ground {{ point O = (0, 0)  point B = (3 mm, 4 mm) }}
    body arm at (0, 0, 10 deg) {{ point O = (0, 0)  point P = (80 mm, 9 mm) }}
    joint pivot: revolute(ground.O, arm.O)
    driver motor: rotation(pivot) = 10 deg + 2 rad/s * t
}}"
    );
    let (reported, rows) = messages(&text);
    assert!(reported.is_empty() && rows.len() == 3, "{place}: {reported:?}");
    rows
}

#[test]
fn parts_are_placed_at_drawn_points() {
    // A stands on f, which is turned by a quarter: at (2, 27) mm; and k is turned over there
    for (by_point, by_numbers) in [
        ("at (ground.G, 30 deg)", "at (100 mm, 50 mm, 30 deg)"),
        ("at (f.P, 0)", "at (5 mm, 50 mm, 0)"),
        ("at (f.P + (1 mm, 0), 0) mirrored", "at (6 mm, 50 mm, 0) mirrored"),
        ("at (mid(f.P, f.O), -1 deg)", "at (7.5 mm, 35 mm, -1 deg)"),
        ("at (length(f.O, f.P), 0, direction(f.O, f.P))", "at (hypot(30 mm, 5 mm), 0, 90 deg + atan2(5, 30))"),
        ("on f at (f.P, 30 deg)", "on f at (30 mm, 5 mm, 30 deg)"),
        ("on f at (f.P + (1 mm, 0), 0)", "on f at (31 mm, 5 mm, 0)"),
        ("on f at (ground.G, 30 deg) mirrored", "on f at (30 mm, -90 mm, 30 deg) mirrored"),
        ("on f at (0, 0, direction(f.O, f.P))", "on f at (0, 0, atan2(5, 30))"),
        ("at (k.ground.O, 0)", "at (2 mm, 27 mm, 0)"),
        ("on f at (k.ground.O, 0)", "on f at (A, 0)"),
        ("on f at (k.ground.B, 0)", "on f at (A + polar(3 mm, 20 deg) + polar(4 mm, -70 deg), 0)"),
        ("on k.ground at (k.ground.B, 0)", "on k.ground at (3 mm, -4 mm, 0)"),
        ("on k.arm at (k.arm.P, 5 deg)", "on k.arm at (80 mm, -9 mm, 5 deg)"),
        ("on k.arm at (f.O, 0)", "on k.arm at (-polar(7 mm, -10 deg) - polar(8 mm, 80 deg), 0)"),
        ("on k.arm at (k.ground.B, 0)", "on k.arm at (polar(3 mm, 10 deg) + polar(4 mm, -80 deg), 0)"),
    ] {
        for (point, number) in
            placed(by_point, "").into_iter().flatten().zip(placed(by_numbers, "").into_iter().flatten())
        {
            assert!((point - number).abs() <= 1e-12 * number.abs().max(1.0), "{by_point}: {point}, not {number}");
        }
    }
}

#[test]
fn parts_stay_at_their_mount_point() {
    for (on, point) in [("f", "f.P"), ("k.arm", "k.arm.P"), ("f", "k.ground.B"), ("k.ground", "k.ground.B")] {
        let measures = format!("measure dx = x(p.ground.O) - x({point})  measure dy = y(p.ground.O) - y({point})");
        for row in placed(&format!("on {on} at ({point}, 30 deg)"), &measures) {
            // positions, velocities and accelerations, the two measures last in each
            for group in row[1..].chunks((row.len() - 1) / 3) {
                assert!(group[group.len() - 2..].iter().all(|difference| difference.abs() < 1e-12), "{point}: {row:?}");
            }
        }
    }
}

/// The last row of parts of a text with two inputs, as they are used.
fn last_row(parts: &str) -> Vec<f64> {
    let text = format!(
        "mechanism whole {{
    {parts}
    analysis from 0 s to 1 s every 0.5 s
}}
mechanism pair {{
    input feed = 0
    part first: two(u = second.v)
    part second: two(v = feed)
}}
mechanism two {{
    param length = 80 mm
    param A = (1 mm, 2 mm)
    input u = 0.3 * sin(t / 1 s)
    input v = 0.2 * t / 1 s
    ground {{ point O = A  point P = (1 m, 0) }}
    body p {{ point O = (0, 0)  point tip = (length, 0) }}
    body q at (1 m, 0, 0) {{ point O = (0, 0) }}
    joint jp: revolute(ground.O, p.O)
    joint jq: revolute(ground.P, q.O)
    driver dp: rotation(jp) = u
    driver dq: rotation(jq) = v
}}"
    );
    let (reported, rows) = messages(&text);
    assert!(reported.is_empty(), "{parts}: {reported:?}");
    rows.last().expect("rows").clone()
}

fn are_the_same(one: &str, other: &str) {
    let (found, wanted) = (last_row(one), last_row(other));
    assert_eq!(found.len(), wanted.len(), "{one}");
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!((found - wanted).abs() <= 1e-12 * wanted.abs().max(1.0), "{one}: {found}, not {wanted}");
    }
}

#[test]
fn bindings_of_inputs_may_name_parts_in_any_order() {
    let (sine, rising) = ("0.3 * sin(t / 1 s)", "1 rad/s * t");
    for (written, meant) in [
        ("part a: two(u = b.u) part b: two(u = T)", "part a: two(u = T) part b: two(u = T)"),
        ("part a: two(v = a.u)", "part a: two(v = S)"),
        ("part a: two(v = 2 * angle(a.p))", "part a: two(v = 2 * S)"),
        (
            "part a: two(v = angle(b.p)) part b: two(v = angle(a.p), u = T)",
            "part a: two(v = T) part b: two(v = S, u = T)",
        ),
        ("part a: two(v = b.u) part b: two(v = a.u, u = T)", "part a: two(v = T) part b: two(v = S, u = T)"),
        (
            "part a: two(u = g(2)) part b: two(u = T) fn f(x) = b.u fn g(x) = x * f(x)",
            "part a: two(u = 2 * T) part b: two(u = T)",
        ),
        ("part a: two(u = a.length / 1 m)", "part a: two(u = 0.08)"),
        ("part a: two(v = c.first.u) part c: pair(feed = T)", "part a: two(v = T) part c: pair(feed = T)"),
        ("part c: pair(feed = a.u) part a: two(u = T)", "part c: pair(feed = T) part a: two(u = T)"),
    ] {
        let filled = |text: &str| text.replace('S', sine).replace('T', rising);
        are_the_same(&filled(written), &filled(meant));
    }
}

#[test]
fn part_params_are_allowed_as_constants() {
    for (written, meant) in [
        (
            "param n = 2 * a.length part a: two(length = 30 mm) measure m1 = n",
            "part a: two(length = 30 mm) measure m1 = 60 mm",
        ),
        ("fn f(u) = u * b.length part b: two() measure m1 = f(3)", "part b: two() measure m1 = 240 mm"),
        (
            "part a: two(length = 2 * b.length) part b: two(length = 1 mm)",
            "part a: two(length = 2 mm) part b: two(length = 1 mm)",
        ),
        ("part a: two(A = b.A + (b.length, 0)) part b: two()", "part a: two(A = (81 mm, 2 mm)) part b: two()"),
        ("param n = c.first.length part c: pair() measure m1 = n", "part c: pair() measure m1 = 80 mm"),
        (
            "param n = d[1].length part d[k in 0..2]: two(length = k * 1 m) measure m1 = n",
            "part d[k in 0..2]: two(length = k * 1 m) measure m1 = 1 m",
        ),
        (
            "table c = spline [(0, a.length), (1, 1 m)] part a: two() measure m1 = c(0.5)",
            "table c = spline [(0, 80 mm), (1, 1 m)] part a: two() measure m1 = c(0.5)",
        ),
        (
            "part a: two() ground { point G = (a.length, 0) } body b at (0, 0, a.length / 1 m) { point O = (0, 0) } joint j: weld(ground.G, b.O, 0)",
            "part a: two() ground { point G = (80 mm, 0) } body b at (0, 0, 0.08) { point O = (0, 0) } joint j: weld(ground.G, b.O, 0)",
        ),
    ] {
        are_the_same(written, meant);
    }
}
