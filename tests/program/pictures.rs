//! Pictures of mechanisms: what is drawn is where the table has it, and nothing lies on what it should not.
//!
//! `UPDATE_GOLDENS=1 cargo test --test program pictures` writes the pictures that a reviewer reads.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod exports;
use crate::support;

use crate::support::random::Random;
use crate::support::{Disk, files, stem};
use mechc::{
    Cancel, Checked, Choice, Code, Compiled, CurveTolerance, Diagnostic, Diagnostics, Parsed, Redundant, RunOptions,
    Sources, Times, Visualization,
};
use mechc_draw::scene::{
    Anchor, Attachment, Catalogue, Look, Motion, Path as Drawn, Pen, Pose, Scene, Segment, Torque, Vector, catalogue,
    distance, dot, minus, plus, polar, times,
};
use mechc_draw::view::svg::{Options, Plot, Theme, animated, has_vectors, plots, still};
use mechc_draw::view::{dxf, first_sentence};
use mechc_engine::analysis::{FreeMotion, Horizon, free_motions};
use mechc_lang::check;
use mechc_lang::lower::LowerOptions;
use mechc_pipeline as lower;
use mechc_syntax as syntax;
use std::fs;
use std::path::Path;

fn compiled(path: &Path, text: &str) -> (Checked, Compiled) {
    let mut sources = Sources::default();
    let file = sources.add(path.display().to_string(), text);
    let parsed = Parsed::from_source(sources, file, path);
    let checked = parsed.check(&Choice::default(), &Disk::default());
    let (compiled, reports) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{}: {reports:?}", path.display()));
    (checked, compiled)
}

fn seen_as(path: &Path, text: &str, times: Option<Times>) -> Visualization {
    let (checked, compiled) = compiled(path, text);
    let times = times.or_else(|| compiled.times()).expect("an analysis");
    let (seen, reports) = checked.visualize(&compiled, &times, &RunOptions::default(), 2000);
    seen.unwrap_or_else(|| panic!("{}: {reports:?}", path.display()))
}

/// A motion that is refined until its curves are within a tolerance; with what is said of those that end early.
fn refined(
    path: &Path,
    text: &str,
    tolerance: impl Fn(&Visualization) -> CurveTolerance,
) -> (Visualization, Diagnostics) {
    let (checked, compiled) = compiled(path, text);
    let (times, options) = (compiled.times().expect("an analysis"), RunOptions::default());
    let (seen, reports) = checked.visualize(&compiled, &times, &options, 2000);
    let mut seen = seen.unwrap_or_else(|| panic!("{}: {reports:?}", path.display()));
    let tolerance = tolerance(&seen);
    let reports = checked.refine_motion(&compiled, &times, &options, &mut seen, &tolerance);
    (seen, reports)
}

/// A motion that is refined, all of whose curves are drawn to their ends.
fn seen_within(path: &Path, text: &str, tolerance: impl Fn(&Visualization) -> CurveTolerance) -> Visualization {
    let (seen, reports) = refined(path, text, tolerance);
    assert!(reports.is_empty(), "{}: {reports:?}", path.display());
    seen
}

/// A text as it is cut at its own size.
fn seen_to_cut(text: &str) -> Visualization {
    seen_within(Path::new("test.mech"), text, |_| CurveTolerance::to_cut(1.0, Vec::new()))
}

fn seen_text(text: &str) -> Visualization {
    seen_as(Path::new("test.mech"), text, None)
}

/// What there is to see of a mechanism that has no motion, and all that is said of it.
fn static_visualization(path: &str) -> (Visualization, Vec<String>) {
    let text = fs::read_to_string(path).expect("a mechanism");
    let mut sources = Sources::default();
    let file = sources.add(path, text);
    let checked = Parsed::from_source(sources, file, Path::new(path)).check(&Choice::default(), &Disk::default());
    let options = RunOptions::default();
    let (compiled, mut reports) = checked.compile(Redundant::Refused, &Cancel::default());
    if let Some(compiled) = &compiled {
        let (seen, why) = checked.visualize(compiled, &compiled.times().expect("an analysis"), &options, 2000);
        assert!(seen.is_none(), "{path} moves");
        reports = why;
    }
    let seen = checked.static_visualization(compiled.as_ref(), (0.0, &options), &reports).expect("it is sound");
    let notes = |reports: &Diagnostic| if reports.code == Code::E0601 { reports.notes.clone() } else { Vec::new() };
    let message = |reports: &Diagnostic| format!("error[{}]: {}", reports.code, reports.message);
    let messages = reports.iter().flat_map(|reports| std::iter::once(message(reports)).chain(notes(reports))).collect();
    (seen, messages)
}

/// All examples, with their names.
fn examples() -> Vec<(String, Visualization)> {
    let read = |path: std::path::PathBuf| {
        let text = fs::read_to_string(&path).expect("an example");
        (stem(&path), seen_as(&path, &text, None))
    };
    files("examples", "mech").into_iter().map(read).collect()
}

fn example(name: &str) -> Visualization {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.mech"));
    let text = fs::read_to_string(&path).expect("an example");
    seen_as(&path, &text, None)
}

/// The value of an attribute in the text of a tag.
fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    let (_, behind) = tag.split_once(&format!(" {name}=\""))?;
    behind.split('"').next()
}

fn numbers(text: &str) -> Vec<f64> {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '-' | '.');
    text.split(|c| !is_part(c)).filter_map(|word| word.parse().ok()).collect()
}

/// The points that a moving picture shows, with what it takes to tell where they are.
struct Read<'f> {
    file: &'f str,
    /// Pixels in a metre, and where the ground's origin is.
    scale: f64,
    origin: Vector,
    /// The path of each point, its place in its group, the group's tag.
    points: Vec<(&'f str, Vector, &'f str)>,
}

impl<'f> Read<'f> {
    fn of(file: &'f str) -> Read<'f> {
        let root = &file[..file.find('>').expect("a root")];
        let scale = attribute(root, "data-scale").expect("a scale").parse().expect("a number");
        let origin = numbers(attribute(root, "data-origin").expect("an origin"));
        let (mut points, mut group) = (Vec::new(), "");
        for tag in file.split('<').filter_map(|tag| tag.split('>').next()) {
            if tag.starts_with("g ") {
                group = tag;
            }
            if let Some(point) = attribute(tag, "data-point") {
                let part = |name| attribute(tag, name).map_or(0.0, |text| text.parse().expect("a number"));
                points.push((point, [part("cx"), part("cy")], group));
            }
        }
        Read { file, scale, origin: [origin[0], origin[1]], points }
    }

    /// Where a place of a group is at a part of the run (px), as the style sheet moves it.
    fn placed(&self, local: Vector, group: &str, part: f64) -> Vector {
        let put = |numbers: &[f64]| {
            let turn = numbers.get(2).copied().unwrap_or(0.0).to_radians();
            Pose { at: [numbers[0], numbers[1]], phi: turn }.transform(local)
        };
        let class = attribute(group, "class").unwrap_or("");
        let Some((_, number)) = class.split_once("m m") else {
            return attribute(group, "transform").map_or(local, |transform| put(&numbers(transform)));
        };
        let (_, rules) = self.file.split_once(&format!("@keyframes k{number}{{")).expect("keyframes");
        let rules = rules.split("}}").next().expect("rules");
        let key = |rule: &str| {
            let (percent, transform) = rule.split_once("%{")?;
            Some((percent.parse::<f64>().ok()? / 100.0, numbers(transform)))
        };
        let keys: Vec<(f64, Vec<f64>)> = rules.split('}').filter_map(key).collect();
        let behind = keys.iter().position(|(at, _)| *at >= part).expect("a key").max(1);
        let ((from, a), (to, b)) = (&keys[behind - 1], &keys[behind]);
        let s = (part - from) / (to - from);
        put(&a.iter().zip(b).map(|(a, b)| a + s * (b - a)).collect::<Vec<_>>())
    }

    /// A place of the ground in pixels.
    fn pixels(&self, [x, y]: Vector) -> Vector {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }
}

/// The farthest that a pin of a moving picture is from its place, at random times (px).
fn farthest_pin(name: &str, seen: &Visualization, file: &str) -> f64 {
    let read = Read::of(file);
    let (mut random, mut poses, mut farthest) = (Random::new(7), Vec::new(), 0.0_f64);
    let (first, last) = (seen.motion.times[0], seen.motion.times[seen.motion.len() - 1]);
    assert!(!read.points.is_empty(), "{name}: no point is shown");
    for k in 0..60 {
        // in rows, where the table has them, and between them, where the quintic has them
        let row = random.below(seen.motion.len());
        let t = if k % 2 == 0 { seen.motion.times[row] } else { first + (last - first) * random.part() };
        seen.motion.write_poses(t, &mut poses);
        for (path, local, group) in &read.points {
            let point = seen.scene.point_named(path).expect("a point of the scene");
            let wanted = read.pixels(poses[point.frame].transform(point.at));
            let found = read.placed(*local, group, (t - first) / (last - first));
            farthest = farthest.max(distance(found, wanted));
        }
    }
    farthest
}

#[test]
fn pins_match_the_table() {
    for (name, seen) in examples() {
        let file = animated(&seen.scene, &seen.motion, &Options::default());
        let farthest = farthest_pin(&name, &seen, &file);
        assert!(farthest < 0.5, "{name}: a pin is {farthest} px from its place");
        let most = if seen.scene.frames.len() <= 5 { 100_000 } else { 250_000 };
        assert!(file.len() < most, "{name}: {} bytes", file.len());
    }
}

#[test]
fn pictures_of_any_size_are_alike() {
    let text = fs::read_to_string("examples/hoeken.mech").expect("an example");
    let mut pictures = Vec::new();
    for length in ["40 mm", "0.4 um", "0.4 km"] {
        let seen = seen_text(&text.replace("crank_length = 40 mm", &format!("crank_length = {length}")));
        let file = animated(&seen.scene, &seen.motion, &Options::default());
        assert!(farthest_pin(length, &seen, &file) < 0.5);
        // but for pixels in a metre, and the last digits of keyframes
        let (_, drawn) = file.split_once("<rect").expect("a background");
        pictures.push((drawn.len(), drawn.matches("<g").count()));
    }
    assert!(
        pictures.iter().all(|picture| picture.1 == pictures[0].1 && picture.0.abs_diff(pictures[0].0) < 40),
        "{pictures:?}"
    );
}

#[test]
fn moment_labels_do_not_overlap() {
    for (name, seen) in examples() {
        for theme in [Theme::Light, Theme::Dark] {
            let options = Options { labels: true, theme, ..Options::default() };
            let file = still(&seen.scene, &seen.motion, &one_row(&seen, seen.motion.len() / 3), &options);
            let boxes = boxes(&file);
            assert!(!boxes.is_empty(), "{name}: nothing is named");
            for (k, (text, [low, high])) in boxes.iter().enumerate() {
                assert!(low[0] >= -0.01 && low[1] >= -0.01, "{name}: {text} is cut off");
                for (other, [other_low, other_high]) in &boxes[k + 1..] {
                    let meet = low[0] < other_high[0]
                        && other_low[0] < high[0]
                        && low[1] < other_high[1]
                        && other_low[1] < high[1];
                    assert!(!meet, "{name}: `{text}` lies on `{other}`");
                }
            }
        }
    }
}

/// A four-bar with a point that is traced, and a cam whose follower has no pin.
const FOUR_BAR: &str = "\
mechanism four_bar {
    ground {
        point A0 = (0, 0)
        point B0 = (100 mm, 0)
    }
    body crank at (0, 0, 60 deg) {
        point A0 = (0, 0)
        point A  = (40 mm, 0)
    }
    body coupler at (20 mm, 35 mm, 20 deg) {
        point A = (0, 0)
        point B = (120 mm, 0)
        point C = (60 mm, 45 mm)
        point D = (60 mm, -10 mm)
    }
    body rocker at (100 mm, 0, 70 deg) {
        point B0 = (0, 0)
        point B  = (80 mm, 0)
    }
    joint J1: revolute(ground.A0, crank.A0)
    joint J2: revolute(crank.A, coupler.A)
    joint J3: revolute(coupler.B, rocker.B)
    joint J4: revolute(ground.B0, rocker.B0)
    driver motor: rotation(J1) = 60 deg + 30 rpm * t
    trace path = coupler.C
    analysis from 0 s to 2 s every 20 ms
}
";
const CAM: &str = "\
mechanism cam {
    ground {
        point O  = (0, 0)
        axis way = O along (0, 1)
    }
    body disc {
        point O = (0, 0)
        circle rim = (10 mm, 0) radius 30 mm
    }
    body follower at (0, 50 mm, 0) {
        circle wheel = (0, 0) radius 8 mm
        axis way = (0, 0) along (0, 1)
        point top = (0, 60 mm)
    }
    joint axle: revolute(ground.O, disc.O)
    joint guide: translational(ground.way, follower.way)
    joint contact: cam(disc.rim, follower.wheel)
    driver motor: rotation(axle) = 60 rpm * t
    analysis from 0 s to 1 s every 10 ms
}
";

#[test]
fn labels_are_near_their_features() {
    let seen = seen_text(FOUR_BAR);
    let options = Options { labels: true, ..Options::default() };
    for row in [0, 13, 30, 77] {
        let file = still(&seen.scene, &seen.motion, &one_row(&seen, row), &options);
        let (read, poses) = (Read::of(&file), seen.motion.poses(row));
        let unit = read.scale * seen.scene.unit;
        let boxes = boxes(&file);
        for name in ["crank.A0", "crank.A", "rocker.B", "rocker.B0"] {
            let point = seen.scene.point_named(name).expect("a point");
            let pin = read.pixels(poses[point.frame].transform(point.at));
            let own = name.rsplit('.').next();
            let (_, [low, high]) = boxes.iter().find(|(text, _)| Some(text.as_str()) == own).expect("a label");
            let nearest = [0, 1].map(|part| pin[part].clamp(low[part], high[part]));
            let off = distance(nearest, pin);
            assert!(off < 1.5 * unit, "row {row}: {name} is {off} px off, and a pin's symbol is of {unit} px");
        }
        for name in ["crank", "rocker"] {
            let ends: Vec<Vector> = seen
                .scene
                .points
                .iter()
                .filter(|point| point.name.starts_with(name))
                .map(|point| read.pixels(poses[point.frame].transform(point.at)))
                .collect();
            let (_, [low, high]) = boxes.iter().find(|(text, _)| text == name).expect("a label");
            let covered = (0..=100).map(|k| plus(ends[0], times(0.01 * f64::from(k), minus(ends[1], ends[0]))));
            let is_covered = |[x, y]: Vector| low[0] < x && x < high[0] && low[1] < y && y < high[1];
            assert!(!covered.into_iter().any(is_covered), "row {row}: the bar goes through its name {name}");
        }
    }
}

/// What has arrows in a picture, by names.
fn with_arrows(file: &str) -> Vec<&str> {
    let arrows = file.split('<').filter(|tag| tag.starts_with("path class=\"vector velocity"));
    let mut names: Vec<&str> = arrows.filter_map(|tag| attribute(tag, "data-name")).collect();
    names.retain(|name| *name != "velocity");
    names.dedup();
    names
}

#[test]
fn arrows_are_at_moving_points() {
    let options = Options { vectors: true, ..Options::default() };
    for (text, wanted) in [(FOUR_BAR, vec!["crank.A", "coupler.B", "coupler.C"]), (CAM, vec!["follower.top"])] {
        let seen = seen_text(text);
        let file = still(&seen.scene, &seen.motion, &one_row(&seen, 20), &options);
        assert_eq!(with_arrows(&file), wanted);
        let file = animated(&seen.scene, &seen.motion, &options);
        assert_eq!(with_arrows(&file), wanted, "moving");
    }
    let seen = seen_text(&CAM.replace("point top = (0, 60 mm)", ""));
    assert!(!has_vectors(&seen.scene, &[], &seen.motion));
    let rim = ("disc.edge".to_owned(), Anchor { frame: 1, at: [0.04, 0.0] });
    assert!(has_vectors(&seen.scene, std::slice::from_ref(&rim), &seen.motion), "a traced point");
    let options = Options { traces: vec![rim], ..options };
    let file = still(&seen.scene, &seen.motion, &one_row(&seen, 20), &options);
    assert_eq!(with_arrows(&file), ["disc.edge"]);
}

/// A slider crank that a spring, a damper, a spiral spring and a brake work on.
const HELD: &str = "mechanism held {
    ground { point O = (0, 0)  point S = (-50 mm, 50 mm)  axis way = O along (1, 0) }
    body crank at (0, 0, 60 deg) {
        point O = (0, 0)  point pin = (30 mm, 0)  axis side = O along (1, 0)
        mass 0.4 kg at (15 mm, 0) inertia 1e-4 kg * m^2
    }
    body rod at (15 mm, 26 mm, -15 deg) {
        point big = (0, 0)  point small = (100 mm, 0)
        mass 0.3 kg at (50 mm, 0) inertia 2e-4 kg * m^2
    }
    body slide at (112 mm, 0, 0) { point wrist = (0, 0)  axis way = wrist along (1, 0)  mass 0.5 kg at (0, 10 mm) }
    gravity (0, -9.81 m/s^2)
    joint main:  revolute(ground.O, crank.O)
    joint big:   revolute(crank.pin, rod.big)
    joint small: revolute(rod.small, slide.wrist)
    joint guide: translational(ground.way, slide.way)
    driver motor: rotation(main) = 60 deg + 300 rpm * t
    load spring: -200 N/m * (distance(ground.S, crank.pin) - 40 mm) on distance(ground.S, crank.pin)
    load damper: -20 N*s/m * der(displacement(guide)) on displacement(guide)
    load spiral: -0.2 N*m * (rotation(big) + 75 deg) on rotation(big)
    load brake:  -0.3 N*m on angle(crank)
    analysis from 0 s to 0.2 s every 5 ms
}";

fn seen_with_forces(text: &str) -> Visualization {
    let choice = Choice { pictures_forces: true, ..Choice::default() };
    let checked = Parsed::new("test.mech", text).check(&choice, &Disk::default());
    let (compiled, reports) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{reports:?} {:?}", checked.diagnostics()));
    let times = compiled.times().expect("an analysis");
    let (seen, reports) = checked.visualize(&compiled, &times, &RunOptions::default(), 2000);
    seen.unwrap_or_else(|| panic!("{reports:?}"))
}

/// The torques of a mechanism in a row, with their names.
fn torques(seen: &Visualization, row: usize) -> Vec<(String, f64)> {
    let named = |torque: &Torque| seen.scene.declarations[torque.declaration].name.clone();
    seen.scene.torques.iter().map(|torque| (named(torque), torque.value(&seen.motion, row))).collect()
}

#[test]
fn arcs_show_size_and_sense_of_torques() {
    let seen = seen_with_forces(HELD);
    let options = Options { forces: true, ..Options::default() };
    let mut scales: Vec<f64> = Vec::new();
    for row in [0, 7, 23] {
        let file = still(&seen.scene, &seen.motion, &one_row(&seen, row), &options);
        let reported = torques(&seen, row);
        let names: Vec<&str> = reported.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["guide", "motor", "spiral", "brake"]);
        for (name, torque) in &reported {
            let paths = file.split('<').filter(|tag| tag.starts_with("path class=\"vector"));
            let own = |tag: &&str| attribute(tag, "data-name") == Some(name) && tag.contains(" 0 1 ");
            let Some(path) = paths.clone().find(own) else { continue };
            let (_, arc) = attribute(path, "d").expect("a path").split_once('A').expect("an arc");
            let arc = numbers(arc);
            assert_eq!(arc[4] > 0.5, *torque < 0.0, "{name} of {torque} N m: {arc:?}");
            scales.push(arc[0] / torque.abs());
        }
        assert!(file.contains("reaction torque, at most") && file.contains("load torque, at most"));
    }
    let (least, most) = scales.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(*s), b.max(*s)));
    assert!(scales.len() > 8 && most < 1.02 * least, "{scales:?}");
    let moving = animated(&seen.scene, &seen.motion, &options);
    for name in ["guide", "motor", "spiral", "brake"] {
        assert!(moving.contains(&format!("data-name=\"{name}\" d=\"M-0.7071 0.7071A1 1 0 1 0")), "{name}");
    }
}

#[test]
fn torque_arcs_do_not_depend_on_notation() {
    let wanted = torques(&seen_with_forces(HELD), 9);
    for (old, new) in [
        ("rotation(main) = 60 deg + 300 rpm * t", "60 deg + 300 rpm * t = rotation(main)"),
        ("rotation(main) = 60", "angle(crank) = 60"),
        ("-0.3 N*m on angle(crank)", "-0.3 N*m on rotation(main)"),
        ("-0.3 N*m on angle(crank)", "0.3 N*m on angle(crank.side, ground.way)"),
    ] {
        let found = torques(&seen_with_forces(&HELD.replace(old, new)), 9);
        for ((name, wanted), (_, found)) in wanted.iter().zip(&found) {
            assert!((wanted - found).abs() < 1e-9, "{new}: {name} is {found}, not {wanted}");
        }
    }
    // turned over with all that is in it, torques are the other way round
    let part = HELD.replace("gravity (0, -9.81 m/s^2)", "");
    let whole = |how: &str| {
        format!(
            "mechanism whole {{ part one: held() at (0, 0, 0){how}\n analysis from 0 s to 0.2 s every 5 ms }}\n{part}"
        )
    };
    let [plain, turned] = ["", " mirrored"].map(|how| torques(&seen_with_forces(&whole(how)), 9));
    assert_eq!(plain.len(), 4);
    for ((name, plain), (_, turned)) in plain.iter().zip(&turned) {
        assert!(plain.abs() > 1e-3 && (plain + turned).abs() < 1e-9, "{name}: {plain} and {turned}");
    }
}

#[test]
fn length_drivers_have_arrows() {
    let text = HELD
        .replace("rotation(main) = 60 deg + 300 rpm * t", "displacement(guide) = 110 mm + 5 mm * sin(10 rad/s * t)");
    let seen = seen_with_forces(&text);
    let is_of = |name: &str, number: usize| seen.scene.declarations[number].name == name;
    let motor = seen.scene.forces.iter().find(|force| is_of("motor", force.declaration)).expect("an arrow");
    let effort = seen.motion.value("motor.effort", 3);
    let [x, y] = motor.value(&seen.motion, 3);
    assert!((x - effort).abs() < 1e-9 && y.abs() < 1e-9 && effort.abs() > 1e-3, "{x}, {y} of {effort}");
}

#[test]
fn the_pale_moments_of_a_strobe_lie_below_the_ground() {
    let seen = seen_text(CAM);
    let moments = seen.motion.moments(&[0, 25, 50, 60]);
    let file = still(&seen.scene, &seen.motion, &moments, &Options::default());
    let ghosts: Vec<usize> = file.match_indices("<g class=\"ghost\"").map(|(at, _)| at).collect();
    let strong = file.find("<g data-t=").expect("the last one");
    assert!(ghosts.len() == 3 && ghosts.iter().all(|ghost| *ghost < strong));
    for look in ["support", "hatching", "ground-line"] {
        let first = file.find(&format!("class=\"{look}\"")).expect("the ground");
        assert!(first > strong, "{look}");
    }
}

/// The words of a still, with the boxes around them as letters of 0.6 em fill them.
fn boxes(file: &str) -> Vec<(String, [Vector; 2])> {
    let (_, font) = file.split_once("text{font:").expect("a font");
    let size: f64 = font.split("px").next().expect("a size").parse().expect("a number");
    let word = |tag: &str| {
        let (attributes, text) = tag.split_once('>')?;
        let [x, y] =
            ["x", "y"].map(|part| attribute(attributes, part).expect("a place").parse::<f64>().expect("a number"));
        let half = 0.5 * 0.6 * size * text.chars().count() as f64;
        Some((text.to_owned(), [[x - half, y - 0.8 * size], [x + half, y + 0.2 * size]]))
    };
    file.split('<').filter(|tag| tag.starts_with("text")).filter_map(word).collect()
}

/// A single moment of a motion.
fn one_row(seen: &Visualization, row: usize) -> Motion {
    seen.motion.moment(row)
}

/// The corners of a shape at a moment, contour by contour; many for a circle of two arcs.
fn corners(path: &Drawn, pose: &Pose) -> Vec<Vec<Vector>> {
    let Drawn::Lines(contours) = path else { return Vec::new() };
    let of_circle = |start: Vector, radius: f64, end: Vector| {
        let middle = times(0.5, plus(start, end));
        (0..90).map(|k| pose.transform(plus(middle, polar(radius, f64::from(k) * 4_f64.to_radians())))).collect()
    };
    contours
        .iter()
        .map(|one| match one.segments.first() {
            Some(Segment::Arc { to, radius, .. }) => of_circle(one.start, *radius, *to),
            _ => Drawn::Lines(vec![one.clone()]).transform(pose).positions(),
        })
        .collect()
}

/// How deep a place lies in what some closed contours hold, an odd number of times.
fn depth(place: Vector, contours: &[Vec<Vector>]) -> f64 {
    let (mut is_inside, mut nearest) = (false, f64::INFINITY);
    for contour in contours {
        for (k, b) in contour.iter().enumerate() {
            let a = contour[(k + contour.len() - 1) % contour.len()];
            if (a[1] > place[1]) != (b[1] > place[1]) {
                is_inside ^= place[0] < a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            }
            let way = minus(*b, a);
            let part = (dot(minus(place, a), way) / dot(way, way)).clamp(0.0, 1.0);
            nearest = nearest.min(distance(place, plus(a, times(part, way))));
        }
    }
    if is_inside { nearest } else { 0.0 }
}

/// The deepest that a tooth goes into what it meshes with along a motion, as a part of the size of symbols.
fn deepest_overlap(scene: &Scene, motion: &Motion) -> (usize, f64) {
    let toothed = |look| matches!(look, Look::Gear | Look::Rack);
    let wheels: Vec<(&Attachment, &Drawn)> = scene
        .nodes
        .iter()
        .flat_map(|node| {
            node.shapes.iter().filter(|shape| toothed(shape.look)).map(|shape| (&node.attachment, &shape.path))
        })
        .collect();
    let mut deepest = 0.0_f64;
    for row in motion.sampled(25) {
        let placed: Vec<_> =
            wheels.iter().map(|(place, path)| corners(path, &place.pose(motion.poses(row)).0)).collect();
        for (k, first) in placed.iter().enumerate() {
            for second in placed.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, contours)| contours) {
                let into = first.iter().flatten().map(|place| depth(*place, second)).fold(0.0, f64::max);
                deepest = deepest.max(into);
            }
        }
    }
    (wheels.len(), deepest / scene.unit)
}

#[test]
fn teeth_mesh_all_along_the_motion() {
    for (name, wheels) in [("planetary_gear", 3), ("rhombic_drive", 2), ("rack_steering", 2)] {
        let seen = example(name);
        let (count, deepest) = deepest_overlap(&seen.scene, &seen.motion);
        assert_eq!(count, wheels, "{name}");
        assert!(deepest < 0.03, "{name}: teeth overlap by {deepest} of a symbol's size");
    }
}

#[test]
fn wheels_that_no_pitch_fits_have_no_teeth() {
    let train = |radius: &str| {
        seen_text(&format!(
            "mechanism train {{
                param r = {radius}
                ground {{ point O = (0, 0) point P = (10 mm + r, 0) }}
                body a {{ point O = (0, 0) circle c = O radius 10 mm }}
                body b at (10 mm + r, 0, 0.3) {{ point O = (0, 0) circle c = O radius r }}
                joint first: revolute(ground.O, a.O)
                joint second: revolute(ground.P, b.O)
                joint mesh: gear(a.c, b.c)
                driver motor: rotation(first) = 40 * t
                analysis from 0 s to 1 s every 10 ms
            }}"
        ))
    };
    let teeth = |seen: &Visualization| {
        let gears = seen.scene.nodes.iter().flat_map(|node| &node.shapes).filter(|shape| shape.look == Look::Gear);
        gears.map(|shape| shape.path.positions().len()).min().expect("a wheel")
    };
    let fitting = train("25 mm");
    assert!(teeth(&fitting) > 100);
    assert!(deepest_overlap(&fitting.scene, &fitting.motion).1 < 0.03);
    assert!(teeth(&train("10 mm * pi")) <= 8, "the teeth of such wheels would run into each other");
    assert!(teeth(&train("0.7 m")) > 100, "a large one beside a small one");
    assert!(teeth(&train("1.9 m")) <= 8, "nobody could see so many");
}

#[test]
fn guides_span_the_motion() {
    let seen = example("slider_crank");
    let shapes = |look| {
        seen.scene.nodes.iter().flat_map(move |node| {
            node.shapes
                .iter()
                .filter(move |shape| shape.look == look)
                .map(|shape| (node.attachment, shape.path.positions()))
        })
    };
    let longest = |places: &[Vector]| distance(places[0], places[1]);
    let (_, edge) = shapes(Look::GroundLine).max_by(|a, b| longest(&a.1).total_cmp(&longest(&b.1))).expect("a guide");
    let (place, block) = shapes(Look::Block).next().expect("a block");
    for row in 0..seen.motion.len() {
        let (pose, _) = place.pose(seen.motion.poses(row));
        for corner in block.iter().map(|corner| pose.transform(*corner)) {
            assert!(edge[0][0] < corner[0] && corner[0] < edge[1][0], "the block leaves its guide in row {row}");
        }
    }
    assert!(longest(&edge) < 0.1 + 10.0 * seen.scene.unit, "no longer than it takes");
}

#[test]
fn everything_that_is_declared_is_there() {
    for (name, seen) in examples() {
        let file = still(&seen.scene, &seen.motion, &one_row(&seen, 0), &Options::default());
        for declaration in &seen.scene.declarations {
            let what = match declaration.kind {
                "body" => "data-body",
                "joint" => "data-joint",
                "driver" => "data-driver",
                _ => continue,
            };
            let mark = format!("{what}=\"{}\"", declaration.name);
            assert!(file.contains(&mark), "{name}: {mark} is missing");
        }
        let ids: Vec<&str> = file.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let mut distinct = ids.clone();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), ids.len(), "{name}: an id stands twice");
    }
}

#[test]
fn names_are_no_mark_up() {
    let name = format!("größe_{}", "x".repeat(190));
    let text = format!(
        "/// <script>alert(1)</script> & \"so\" on 🚲\nmechanism odd {{
            ground {{ point O = (0, 0) }}
            body {name} {{ point O = (0, 0) point שלום = (1 m, 0) }}
            joint j: revolute(ground.O, {name}.O)
            driver d: rotation(j) = t
            trace ende = {name}.שלום
            analysis from 0 s to 1 s every 0.1 s
        }}"
    );
    let seen = seen_text(&text);
    let options = Options { labels: true, ..Options::default() };
    for file in
        [animated(&seen.scene, &seen.motion, &options), still(&seen.scene, &seen.motion, &one_row(&seen, 0), &options)]
    {
        assert!(!file.contains("<script"), "{file}");
        assert!(file.contains("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;so&quot; on 🚲"));
        assert!(file.contains(&format!("data-body=\"{name}\"")));
        assert!(file.contains("שלום"));
    }
}

#[test]
fn minimal_mechanisms_are_drawn() {
    // one body with one point; one that is nothing but a frame; and a motion of a single row
    for (bodies, joint) in [
        ("body b { point O = (0, 0) }", "joint j: revolute(ground.O, b.O) driver d: angle(b) = t"),
        ("body b {}", "driver x: x(b.O) = t driver y: y(b.O) = 0 m driver d: angle(b) = t"),
    ] {
        let bodies =
            if joint.contains("b.O") { bodies.replace("{}", "{ point O = (0, 0) }") } else { bodies.to_owned() };
        let text = format!("mechanism m {{ ground {{ point O = (0, 0) }} {bodies} {joint} }}");
        for times in [Times::grid(0.0, 1.0, 0.1), Times::grid(0.0, 0.0, 1.0)] {
            let seen = seen_as(Path::new("m.mech"), &text, times);
            let file =
                animated(&seen.scene, &seen.motion, &Options { vectors: true, labels: true, ..Options::default() });
            assert!(!file.contains("NaN") && !file.replace("infinite", "").contains("inf"), "{file}");
            assert!(file.contains("data-body=\"b\""));
        }
    }
}

#[test]
fn edges_of_drivers_are_listed() {
    let seen = seen_text(
        "mechanism m {
            ground { point O = (0, 0) }
            body b { point O = (0, 0) point P = (1 m, 0) }
            joint j: revolute(ground.O, b.O)
            driver d: rotation(j) = if t < 0.35 then 0 else (t - 0.35)^2
            analysis from 0 s to 1 s every 0.1 s
        }",
    );
    assert_eq!(seen.motion.edges.len(), 1, "{:?}", seen.motion.edges);
    assert!((seen.motion.edges[0] - 0.35).abs() < 1e-12);
    let file = animated(&seen.scene, &seen.motion, &Options::default());
    assert!(farthest_pin("m", &seen, &file) < 0.5);
}

/// All measures of what is seen, as the command line plots them.
fn measures(seen: &Visualization) -> Vec<Plot<'_>> {
    let declared = seen.scene.declarations.iter().filter(|declaration| declaration.kind == "measure");
    let plot = |name: &str| {
        let at = seen.columns.iter().position(|column| column == name).expect("a column");
        let values = seen.motion.column(name).expect("values").map(|value| seen.units[at].printed(value)).collect();
        Plot { name: &seen.columns[at], unit: &seen.units[at].text, values }
    };
    declared.map(|measure| plot(&measure.name)).collect()
}

#[test]
fn plots_show_the_columns() {
    let mut seen_any = false;
    for (name, seen) in examples() {
        let measured = measures(&seen);
        if measured.is_empty() {
            continue;
        }
        seen_any = true;
        let file = plots(&seen.scene, &seen.motion.times, &measured, &Options::default());
        let groups: Vec<&str> = file.split("<g data-name=").skip(1).collect();
        assert_eq!(groups.len(), measured.len(), "{name}");
        for (plot, group) in measured.iter().zip(groups) {
            let (_, d) = group.split_once("<path class=\"curve").expect("a curve");
            let d = attribute(d, "d").expect("its line");
            let places: Vec<f64> = d.split(['M', 'L', 'h']).filter_map(|pair| numbers(pair).get(1).copied()).collect();
            assert!(!places.is_empty() && !d.contains("NaN"), "{name}: {}", plot.name);
            // the last value is as far up between the least and the greatest as it is in the table
            let finite: Vec<f64> = plot.values.iter().copied().filter(|value| value.is_finite()).collect();
            let [low, high] = [f64::min, f64::max].map(|of| finite.iter().copied().reduce(of).expect("a value"));
            if high - low > 1e-9 * high.abs().max(low.abs()) {
                let [top, bottom] = [f64::min, f64::max].map(|of| places.iter().copied().reduce(of).expect("a place"));
                let wanted = bottom - (finite[finite.len() - 1] - low) / (high - low) * (bottom - top);
                let found = places[places.len() - 1];
                assert!((found - wanted).abs() < 0.3, "{name}: {} ends at {found}, not {wanted}", plot.name);
            }
        }
    }
    assert!(seen_any);
}

#[test]
fn plots_have_gaps_at_missing_values() {
    let seen = example("slider_crank");
    let values = vec![0.0, 1.0, f64::NAN, 1.0, f64::NAN, 3.0, 2.0];
    let plot = Plot { name: "a<b", unit: "mm", values };
    let times: Vec<f64> = (0..7).map(f64::from).collect();
    let file = plots(&seen.scene, &times, &[plot], &Options::default());
    let (_, d) = file.split_once("<path class=\"curve").expect("a curve");
    let d = attribute(d, "d").expect("its line");
    assert_eq!((d.matches('M').count(), d.matches('L').count(), d.matches('h').count()), (3, 2, 1), "{d}");
    assert!(file.contains("a&lt;b [mm]") && !file.contains("a<b"), "{file}");
}

#[test]
fn pictures_true_to_scale_are_in_millimetres_of_paper() {
    let seen = example("hoeken");
    let options = Options { scale: Some(0.5), ..Options::default() };
    let file = still(&seen.scene, &seen.motion, &one_row(&seen, 0), &options);
    let root = &file[..file.find('>').expect("a root")];
    let [width, height] = ["width", "height"].map(|side| attribute(root, side).expect("a side"));
    let (width, height) = (width.strip_suffix("mm").expect("mm"), height.strip_suffix("mm").expect("mm"));
    assert_eq!(attribute(root, "viewBox"), Some(&*format!("0 0 {width} {height}")));
    let [low, high] = seen.scene.extent;
    assert!(width.parse::<f64>().expect("a number") >= 500.0 * (high[0] - low[0]));
    assert!((Read::of(&file).scale - 500.0).abs() < 1e-9);
    let text = "mechanism arm { ground { point O = (0, 0) } body b { point O = (0, 0)  point tip = (3 m, 0) }
        joint a: revolute(ground.O, b.O) driver d: rotation(a) = 1 rad/s * t  analysis from 0 s to 1 s every 0.1 s }";
    let arm = seen_as(Path::new("arm.mech"), text, None);
    for (seen, scale) in [(seen, 0.6), (arm, 1.0)] {
        for row in 0..seen.motion.len() {
            places_are_true(&seen, row, &Options { scale: Some(scale), ..Options::default() });
        }
    }
}

/// Through the group around all, places are where the scale has them, to a tenth of a micrometre of paper.
fn places_are_true(seen: &Visualization, row: usize, options: &Options) {
    let file = still(&seen.scene, &seen.motion, &one_row(seen, row), options);
    let (_, group) = file.split_once("<g transform=\"scale(").expect("a group");
    let each: f64 = group.split(')').next().expect("a scale").parse().expect("a number");
    let read = Read::of(&file);
    assert!(!read.points.is_empty());
    for (path, local, group) in &read.points {
        let point = seen.scene.point_named(path).expect("a point");
        let wanted = read.pixels(seen.motion.poses(row)[point.frame].transform(point.at));
        let found = times(each, read.placed(*local, group, 0.0));
        assert!(distance(found, wanted) < 1e-4, "{path}: {found:?}, not {wanted:?}");
    }
}

#[test]
fn single_bodies_use_their_frame() {
    let seen = example("slider_crank");
    let (scene, rest) = seen.scene.alone(1);
    let file = animated(&scene, &rest, &Options { labels: true, ..Options::default() });
    assert!(file.contains(&format!("data-body=\"{}\"", scene.declarations[1].name)));
    assert_eq!(file.matches(" data-body=").count(), 1, "{file}");
    assert!(!file.contains("data-driver") && scene.points.iter().all(|point| point.frame == 1));
    let read = Read::of(&file);
    for (path, local, group) in &read.points {
        let point = scene.point_named(path).expect("its own");
        assert!(distance(read.placed(*local, group, 0.0), read.pixels(point.at)) < 0.02, "{path}");
    }
}

/// A layer, places on it (m), and whether they are closed.
type Polyline = (String, Vec<Vector>, bool);

/// The polylines of a DXF with their layers, in metres, and which are closed; and its points.
fn read_dxf(text: &str) -> (Vec<Polyline>, Vec<(String, Vector)>) {
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len().is_multiple_of(2) && text.ends_with("0\nEOF\n"), "codes and values stand in pairs");
    let (mut polylines, mut points, mut of) = (Vec::new(), Vec::new(), "");
    let mut place = [0.0; 2];
    let mut layer = "";
    for pair in lines.chunks(2) {
        let number = || 1e-3 * pair[1].parse::<f64>().expect("a number");
        match pair[0] {
            "0" => of = pair[1],
            "8" => layer = pair[1],
            "70" if of == "POLYLINE" => polylines.push((layer.to_owned(), Vec::new(), pair[1] == "1")),
            "10" => place[0] = number(),
            "20" => place[1] = number(),
            "30" if of == "VERTEX" => polylines.last_mut().expect("a polyline").1.push(place),
            "30" if of == "POINT" => points.push((layer.to_owned(), place)),
            _ => {}
        }
    }
    (polylines, points)
}

/// The farthest that a closed polyline's corners and the middles of its sides are from a circle (m).
fn off_circle(places: &[Vector], center: Vector, radius: f64) -> f64 {
    let sides = places.iter().zip(places.iter().cycle().skip(1));
    sides
        .flat_map(|(a, b)| [*a, times(0.5, plus(*a, *b))])
        .map(|at| (distance(at, center) - radius).abs())
        .fold(0.0, f64::max)
}

#[test]
fn cut_outlines_match_their_shapes() {
    let seen = example("eccentric_tappet");
    let text = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(20), &[], 1.0).expect("something");
    assert!(text.contains("9\n$INSUNITS\n70\n4\n"));
    let (polylines, points) = read_dxf(&text);
    let of = |layer: &str| polylines.iter().find(|(own, _, _)| own == layer).expect("a layer");
    let center = seen.scene.point_named("disc.C").expect("the centre");
    let center = seen.motion.poses(20)[center.frame].transform(center.at);
    let (_, rim, is_closed) = of("disc_rim");
    assert!(*is_closed && off_circle(rim, center, 0.025) < 1e-6, "{}", off_circle(rim, center, 0.025));
    assert!(points.iter().any(|(layer, at)| layer == "disc_O" && distance(*at, [0.0; 2]) < 1e-9), "{points:?}");
    // half as large, and alone
    let (scene, rest) = seen.scene.alone(1);
    let text = dxf::written(&scene, &rest, rest.poses(0), &[], 0.5).expect("something");
    let (polylines, _) = read_dxf(&text);
    assert_eq!(polylines.len(), 1, "the disc alone");
    assert!(off_circle(&polylines[0].1, [0.0045, 0.0], 0.0125) < 1e-6);
    // as exact on paper where it is cut larger than it is
    let text = dxf::written(&scene, &rest, rest.poses(0), &[], 40.0).expect("something");
    let (polylines, _) = read_dxf(&text);
    assert!(off_circle(&polylines[0].1, [0.36, 0.0], 1.0) < 1e-6);
    // one that is given by a formula, too: chords of both sizes are alike
    let seen = example("cam_with_dwells");
    let count = |scale: f64| {
        let text = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(0), &[], scale).expect("something");
        read_dxf(&text).0.iter().map(|(_, places, _)| places.len()).max().expect("a polyline")
    };
    let counts = [count(1.0), count(100.0)];
    assert!((8 * counts[0]..12 * counts[0]).contains(&counts[1]), "chords for a hundredth of the height: {counts:?}");
}

#[test]
fn traces_are_cut_between_rows_too() {
    let seen = seen_text(
        "mechanism m {
            ground { point O = (0, 0) }
            body b { point O = (0, 0) point P = (80 mm, 0) }
            joint j: revolute(ground.O, b.O)
            driver d: rotation(j) = 1 rad/s * t
            trace path = b.P
            analysis from 0 s to 6 s every 0.2 s
        }",
    );
    let text = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(0), &[], 1.0).expect("something");
    let (polylines, points) = read_dxf(&text);
    let (layer, places, is_closed) = &polylines[0];
    assert!(layer == "path" && !is_closed && polylines.len() == 1 && !points.is_empty());
    let open = &places[..places.len() - 1];
    let off = open.iter().zip(&places[1..]).flat_map(|(a, b)| [*a, times(0.5, plus(*a, *b))]);
    let farthest = off.map(|at| (distance(at, [0.0; 2]) - 0.08).abs()).fold(0.0, f64::max);
    assert!(farthest < 1e-6 && places.len() < 20_000, "{farthest} with {} places", places.len());
}

#[test]
fn gears_are_cut_as_pitch_circles() {
    let seen = example("planetary_gear");
    let text = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(0), &[], 1.0).expect("something");
    let (polylines, _) = read_dxf(&text);
    let wheels = polylines.iter().filter(|(layer, _, is_closed)| *is_closed && layer != "path");
    let mut radii: Vec<f64> = wheels
        .map(|(layer, places, _)| {
            let [low, high] = places.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], at| {
                [[low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])]]
            });
            let (center, radius) = (times(0.5, plus(low, high)), 0.5 * (high[0] - low[0]));
            let off = off_circle(places, center, radius);
            assert!(off < 1e-6, "{layer} is {off} m off a circle");
            radius
        })
        .collect();
    radii.sort_by(f64::total_cmp);
    let circles = seen.scene.pitch_lines.iter().map(|line| match line.path {
        Drawn::Circle { radius, .. } => radius,
        Drawn::Lines(_) => panic!("a line among {:?}", seen.scene.pitch_lines),
    });
    let mut wanted: Vec<f64> = circles.collect();
    wanted.sort_by(f64::total_cmp);
    assert!(radii.len() == wanted.len() && radii.len() >= 3, "{radii:?}, not {wanted:?}");
    assert!(radii.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-6), "{radii:?}");
}

/// Runs `mechc view` in a folder of its own, which holds `a.mech`.
fn view(folder: &Path, arguments: &[&str]) -> (i32, String) {
    fs::copy("examples/slider_crank.mech", folder.join("a.mech")).expect("a copy");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_mechc"));
    let output = command.arg("view").arg("a.mech").args(arguments).current_dir(folder).output().expect("it runs");
    (output.status.code().expect("a code"), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_film_has_a_picture_of_each_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let times = ["--from", "0", "--to", "0.04", "--every", "10ms"];
    let with = |output| [&["-o", output][..], &times].concat();
    let (code, reports) = view(folder.path(), &with("film/%03d.svg"));
    assert_eq!(code, 0, "{reports}");
    let mut names: Vec<String> = fs::read_dir(folder.path().join("film"))
        .expect("the folder")
        .map(|entry| entry.expect("a file").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["000.svg", "001.svg", "002.svg", "003.svg", "004.svg"]);
    let read = |name: &str| fs::read_to_string(folder.path().join("film").join(name)).expect("a picture");
    assert_ne!(read("000.svg"), read("004.svg"));
    assert!(read("003.svg").contains("data-t=\"0.03\""));
    // where a picture would be, there is a link to what was read
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../a.mech", folder.path().join("film/x2.svg")).expect("a link");
        let (code, reports) = view(folder.path(), &with("film/x%d.svg"));
        assert!(code == 2 && reports.contains("would be written over"), "{code}: {reports}");
        assert!(!folder.path().join("film/x0.svg").exists(), "none of them is written");
    }
    let (code, reports) = view(folder.path(), &with("no/such/%d.svg"));
    assert!(code != 0 && reports.contains("there is no folder `no`"), "{code}: {reports}");
}

/// What the pictures of some examples show beside what these ask for: the point that an example is there for.
const TRACED: [(&str, &str); 5] = [
    ("hoeken", "coupler.pen"),
    ("pantograph", "lower.pen"),
    ("peaucellier", "side_PD.P"),
    ("planetary_gear", "planet.pen"),
    ("trammel", "bar.pen"),
];

/// Where the gallery's pictures are.
const GALLERY: &str = "docs/gallery";

/// What the pictures of the gallery weigh together at the most (bytes).
const HEAVIEST_GALLERY: usize = 2_000_000;

const GALLERY_INTRODUCTION: &str = "\
# Gallery

The mechanisms of `examples/` as `mechc view` draws them, with the command below each. The pictures are plain SVG without a script: they
move wherever a browser shows them, this page included, in light and in dark. With `-o NAME.html` in place of `-o NAME.svg` one gets a page
to play with.
";

/// The page of all examples, and their pictures.
fn gallery() -> Vec<(String, String)> {
    let (mut page, mut pictures) = (GALLERY_INTRODUCTION.to_owned(), Vec::new());
    for path in files("examples", "mech") {
        let name = stem(&path);
        let traced = TRACED.iter().find(|(example, _)| *example == name).map(|(_, path)| *path);
        let anchor = |seen: &Visualization| {
            let point = seen.scene.point_named(traced?).expect("a point of the example");
            Some(Anchor { frame: point.frame, at: point.at })
        };
        let text = fs::read_to_string(&path).expect("an example");
        let seen = seen_within(&path, &text, |seen| {
            CurveTolerance::of_picture(seen, anchor(seen).map(Pen::Point).into_iter().collect())
        });
        let anchored = anchor(&seen).zip(traced).map(|(anchor, path)| (path.to_owned(), anchor));
        let options = Options { traces: anchored.into_iter().collect(), ..Options::default() };
        pictures.push((format!("{GALLERY}/{name}.svg"), animated(&seen.scene, &seen.motion, &options)));
        let title = name[..1].to_uppercase() + &name[1..].replace('_', " ");
        let docs = seen.scene.docs.join("\n");
        let (first, _) = first_sentence(&docs);
        let trace = traced.map_or(String::new(), |path| format!(" --trace {path}"));
        let text = format!("[`{name}.mech`](../examples/{name}.mech)");
        let command = format!("`mechc view examples/{name}.mech{trace} -o {name}.svg`");
        page += &format!("\n## {title}\n\n{first}\n\n![{title}, moving](gallery/{name}.svg)\n\n{text}: {command}\n");
    }
    pictures.push(("docs/gallery.md".to_owned(), page));
    pictures
}

#[test]
fn the_gallery_has_exactly_the_examples() {
    let gallery = gallery();
    let pictures = || gallery.iter().filter(|(path, _)| Path::new(path).starts_with(GALLERY));
    let weight: usize = pictures().map(|(_, drawn)| drawn.len()).sum();
    assert!(weight <= HEAVIEST_GALLERY, "{weight} bytes");
    for path in files(GALLERY, "svg") {
        let name = format!("{GALLERY}/{}.svg", stem(&path));
        assert!(pictures().any(|(known, _)| *known == name), "{name} is of no example");
    }
}

/// The free motions of a mechanism, by the names of bodies.
fn free(text: &str) -> Vec<Vec<(String, [f64; 3])>> {
    let mut sources = Sources::default();
    let file = sources.add("free.mech", text);
    let tree = syntax::parse(&sources, file).tree;
    let (model, reports) = check::check(&tree.mechanisms[0], &check::CheckOptions::default(), &sources);
    let system = lower::lower_model(&model.unwrap_or_else(|| panic!("{reports:?}")), &LowerOptions::default());
    let named = |FreeMotion { bodies }: FreeMotion| {
        bodies.into_iter().map(|(body, velocity)| (system.bodies()[body].name.clone(), velocity)).collect()
    };
    free_motions(&system, Horizon::of_analysis(None)).into_iter().map(named).collect()
}

#[test]
fn free_motions_match_manual_ones() {
    // two links between two pivots, and a bar between their tips; as drawn it nearly closes, which changes no slope
    let [first, bar, second] = [60.0_f64, 20.0, 80.0].map(f64::to_radians);
    let four_bar = "mechanism four_bar {
        ground { point O = (0, 0)  point C = (100 mm, 0) }
        body crank at (0, 0, 60 deg) { point O = (0, 0)  point A = (40 mm, 0) }
        body coupler at (20 mm, 34.6 mm, 20 deg) { point A = (0, 0)  point B = (100 mm, 0) }
        body rocker at (100 mm, 0, 80 deg) { point C = (0, 0)  point B = (70 mm, 0) }
        joint main: revolute(ground.O, crank.O)
        joint front: revolute(crank.A, coupler.A)
        joint back: revolute(coupler.B, rocker.B)
        joint swing: revolute(ground.C, rocker.C)
    }";
    let motions = free(four_bar);
    let [motion] = motions.as_slice() else { panic!("{motions:?}") };
    let of = |name: &str| motion.iter().find(|(known, _)| known == name).expect("it moves").1;
    let [crank, coupler, rocker] = ["crank", "coupler", "rocker"].map(of);
    // along the bar both its ends are as fast, and across the other link it is the bar that turns
    let turns = |wanted: f64, found: f64| assert!((wanted - found / crank[2]).abs() < 1e-9, "{found}, not {wanted}");
    let sin = |angle: f64| polar(1.0, angle)[1];
    turns(0.04 * sin(first - bar) / (0.07 * sin(second - bar)), rocker[2]);
    turns(0.04 * sin(first - second) / (0.1 * sin(second - bar)), coupler[2]);
    // the origins of crank and rocker are pivots; that of the coupler goes with the crank's tip
    assert!([crank[0], crank[1], rocker[0], rocker[1]].iter().all(|speed| speed.abs() < 1e-9));
    let [x, y] = times(crank[2], polar(0.04, first));
    let tip = [-y, x];
    assert!(distance([coupler[0], coupler[1]], tip) < 1e-9);
    let fastest = [crank, coupler, rocker].iter().fold(0.0, |most: f64, [.., turn]| most.max(turn.abs()));
    assert!((fastest - 1.0).abs() < 1e-9, "{fastest}");

    let block = free(
        "mechanism block { ground { point O = (0, 0) } body block at (1 m, 2 m, 30 deg) { point P = (0, 0)  point Q = (50 mm, 0) } }",
    );
    let turn = block.iter().filter(|motion| motion[0].1[2] != 0.0).count();
    let mut parts: Vec<usize> =
        block.iter().map(|motion| motion[0].1.iter().position(|x| *x != 0.0).expect("it moves")).collect();
    parts.sort_unstable();
    assert!(block.iter().all(|motion| motion.len() == 1 && motion[0].1.iter().filter(|x| **x != 0.0).count() == 1));
    assert_eq!((turn, parts), (1, vec![0, 1, 2]), "one turn, one motion along either axis");

    let slide = "mechanism slide {
        ground { point O = (0, 0)  axis way = O along (3, 4) }
        body block { point P = (0, 0)  axis way = P along (3, 4) }
        joint guide: translational(ground.way, block.way)
    }";
    let [motion] = <[_; 1]>::try_from(free(slide)).expect("one motion");
    let [x, y, turn] = motion[0].1;
    assert!((y / x - 4.0 / 3.0).abs() < 1e-9 && turn == 0.0, "{motion:?}");
}

/// The places of nodes that have a shape of some look, with their declarations.
fn looking(seen: &Visualization, look: Look) -> Vec<(&str, Vector)> {
    let nodes = seen.scene.nodes.iter().filter(|node| node.shapes.iter().any(|shape| shape.look == look));
    let poses = seen.motion.poses(0);
    nodes
        .map(|node| (seen.scene.declarations[node.declaration].name.as_str(), node.attachment.pose(poses).0.at))
        .collect()
}

#[test]
fn free_motions_have_arrows() {
    let (seen, reports) = static_visualization("tests/ui/ndof/three_cranks_without_driver.mech");
    assert!(reports[0].starts_with("error[E0503]"), "{reports:?}");
    let mut arrows = looking(&seen, Look::Free);
    arrows.sort_by(|a, b| a.0.cmp(b.0));
    let names: Vec<&str> = arrows.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["bar", "first", "second", "third"]);
    for (k, (_, at)) in arrows[1..].iter().enumerate() {
        assert!(distance(*at, [0.1 * k as f64, 0.0]) < 1e-9, "it turns about {at:?}");
    }
    let named: Vec<&str> = seen.scene.named.iter().map(|k| seen.scene.declarations[*k].name.as_str()).collect();
    assert_eq!(named, ["b3"], "what is redundant");
    assert_eq!(looking(&seen, Look::Named).len(), 1);
    // as it is drawn in the text
    assert_eq!(seen.motion.poses(0)[4].at, [0.025, 0.043]);
    assert!(seen.motion.rows().is_empty() && looking(&seen, Look::Gap).is_empty());
}

#[test]
fn unassembled_joints_are_drawn_open() {
    let (seen, reports) = static_visualization("tests/ui/run/loop_that_never_closes.mech");
    assert!(reports[0].ends_with("joint `swing` stays open by 8.88 mm"), "{reports:?}");
    let open = seen.scene.nodes.iter().filter(|node| node.shapes.iter().any(|shape| shape.look == Look::GapEnd));
    let [open] = open.collect::<Vec<_>>()[..] else { panic!("one joint is open") };
    assert_eq!(seen.scene.declarations[open.declaration].name, "swing");
    let halves: Vec<Vector> = open
        .shapes
        .iter()
        .filter_map(|shape| if let Drawn::Circle { at, .. } = shape.path { Some(at) } else { None })
        .collect();
    assert!((distance(halves[0], halves[1]) - 8.88e-3).abs() < 5e-6, "{halves:?}");
    assert!(seen.scene.named.contains(&open.declaration));
}

#[test]
fn blamed_lengths_are_labelled() {
    let path = "tests/ui/run/loop_that_never_closes.mech";
    let (seen, reports) = static_visualization(path);
    let remarks: Vec<&str> = seen.scene.remarks.iter().map(|remark| remark.text.as_str()).collect();
    assert_eq!(remarks, ["100 mm: too long", "10 mm: too short", "70 mm: too short"]);
    assert_eq!(seen.scene.remarks[0].at, [0.05, 0.0], "the middle of the ground's length");
    let named: Vec<&str> = seen.scene.named.iter().map(|k| seen.scene.declarations[*k].name.as_str()).collect();
    for body in ["coupler", "rocker"] {
        assert!(named.contains(&body), "{named:?}");
    }
    assert!(!named.contains(&"crank") && !named.contains(&"ground"), "{named:?}");
    let file = still(&seen.scene, &seen.motion, &seen.motion, &Options { messages: reports, ..Options::default() });
    assert_eq!(file.matches("<text class=\"remark\"").count(), 3);
    // the command tells them below it, and breaks no number off its unit
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(path, folder.path().join("b.mech")).expect("a copy");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_mechc"));
    let status = command.args(["view", "b.mech", "-o", "b.svg"]).current_dir(folder.path()).output().expect("it runs");
    assert_eq!(status.status.code(), Some(3));
    let file = fs::read_to_string(folder.path().join("b.svg")).expect("a picture");
    let lines: Vec<&str> =
        file.split("<text class=\"said\"").skip(1).filter_map(|tag| tag.split_once('>')?.1.split('<').next()).collect();
    assert!(lines.iter().any(|line| line.starts_with("too short: `coupler` (10 mm")), "{lines:?}");
    assert!(lines.iter().any(|line| line.starts_with("too long: the ground (100 mm")), "{lines:?}");
    assert!(lines.iter().any(|line| line.contains("t = 0 s")), "{lines:?}");
}

#[test]
fn stopped_motions_are_shown_partially() {
    let seen = stopped();
    let why = seen.stopped.as_ref().expect("it locks up");
    let t = why.data["t"].as_f64().expect("a time");
    let last = *seen.motion.times.last().expect("rows");
    assert!(last < t && t < last + 0.01);
    let names: Vec<&str> = seen.scene.named.iter().map(|k| seen.scene.declarations[*k].name.as_str()).collect();
    assert!(names.contains(&"motor"), "{names:?}");
    let file =
        animated(&seen.scene, &seen.motion, &Options { messages: vec![why.message.clone()], ..Options::default() });
    assert!(file.contains("class=\"said\"") && file.contains("named m m") && file.contains("locks up"));
    assert!(farthest_pin("four_bar", &seen, &file) < 0.5);
}

fn stopped() -> Visualization {
    let path = Path::new("tests/ui/run/four_bar_into_lock_up.mech");
    seen_as(path, &fs::read_to_string(path).expect("a mechanism"), None)
}

#[test]
fn messages_take_no_room_from_the_picture() {
    let (seen, reports) = static_visualization("tests/ui/run/loop_that_never_closes.mech");
    for size in [None, Some([400.0, 300.0]), Some([1280.0, 720.0])] {
        let options = Options { messages: reports.clone(), labels: true, size, ..Options::default() };
        let file = still(&seen.scene, &seen.motion, &seen.motion, &options);
        let lines: Vec<f64> = file
            .split("<text class=\"said\"")
            .skip(1)
            .map(|tag| attribute(tag, "y").expect("a place").parse().expect("a number"))
            .collect();
        let root = &file[..file.find('>').expect("a root")];
        let height: f64 = attribute(root, "height").expect("a height").parse().expect("a number");
        assert!(!lines.is_empty() && lines.iter().all(|y| *y < height), "{lines:?} of {height}");
        let read = Read::of(&file);
        for point in &seen.scene.points {
            let [x, y] = read.pixels(seen.motion.poses(0)[point.frame].transform(point.at));
            assert!(
                x > 0.0 && y > 0.0 && y < lines[0] - 13.0,
                "{} is at {x}, {y}, and words at {}",
                point.name,
                lines[0]
            );
        }
    }
}

/// Pictures that a reviewer reads, and those of the docs.
fn goldens() -> Vec<(String, String)> {
    let span = mechc::Span { file: Sources::default().add("", ""), start: 0, end: 0 };
    let Catalogue { scene: symbols, motion: rest, captions } = catalogue(span);
    let of_symbols = Options { captions, ..Options::default() };
    let (hoeken, slider_crank) = (example("hoeken"), example("slider_crank"));
    let pen = hoeken.scene.point_named("coupler.pen").expect("the pen");
    let pen = ("coupler.pen".to_owned(), Anchor { frame: pen.frame, at: pen.at });
    let of_broken = |path: &str| {
        let (seen, reports) = static_visualization(path);
        still(&seen.scene, &seen.motion, &seen.motion, &Options { messages: reports, ..Options::default() })
    };
    let stopped = stopped();
    let why = stopped.stopped.as_ref().map(|why| why.message.clone());
    let at_the_end = Options { messages: why.into_iter().collect(), ..Options::default() };
    let last = stopped.motion.moment(stopped.motion.len() - 1);
    let labelled = Options { labels: true, traces: vec![pen], ..Options::default() };
    let held = seen_with_forces(HELD);
    let with_forces = Options { forces: true, labels: true, ..Options::default() };
    let others = [
        ("tests/pictures/forces.svg", still(&held.scene, &held.motion, &one_row(&held, 0), &with_forces)),
        ("docs/symbols.svg", still(&symbols, &rest, &rest, &of_symbols)),
        ("tests/pictures/hoeken.svg", still(&hoeken.scene, &hoeken.motion, &one_row(&hoeken, 0), &labelled)),
        (
            "tests/pictures/slider_crank.plots.svg",
            plots(&slider_crank.scene, &slider_crank.motion.times, &measures(&slider_crank), &Options::default()),
        ),
        ("tests/pictures/refused.svg", of_broken("tests/ui/ndof/three_cranks_without_driver.mech")),
        ("tests/pictures/open.svg", of_broken("tests/ui/run/loop_that_never_closes.mech")),
        ("tests/pictures/stopped.svg", still(&stopped.scene, &stopped.motion, &last, &at_the_end)),
    ];
    gallery().into_iter().chain(others.map(|(path, drawn)| (path.to_owned(), drawn))).collect()
}

#[test]
fn goldens_match_pictures() {
    for (path, drawn) in goldens() {
        support::golden::holds(path, &drawn);
    }
}
