//! Random mechanisms, each broken in one known way: the diagnosis has the code of that break, and a place on the
//! declaration that was broken.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, is_error, run};
use mechc::Sources;
use mechc_syntax as syntax;
use mechc_syntax::ast::ItemKind;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestRunner};
use std::f64::consts::TAU;

/// So many mechanisms for each way to break one.
const CASES: u32 = 10;

/// No two of them are near enough for one to be taken for the other.
const NAMES: &[&str] = &[
    "anchor",
    "bellows",
    "crosshead",
    "dasher",
    "escapement",
    "fulcrum",
    "governor",
    "hopper",
    "impeller",
    "jigsaw",
    "knuckle",
    "lantern",
    "mandrel",
    "nozzle",
    "oarlock",
    "piston",
    "quadrant",
    "ratchet",
    "spindle",
    "treadle",
    "umbrella",
    "vibrator",
    "windlass",
    "κύλινδρος",
    "yardarm",
    "zeppelin",
    "bügel",
    "fork_tip",
    "shuttle",
    "clamp_2",
];

// ---- mechanisms

#[derive(Clone, Copy, PartialEq, Debug)]
enum Shape {
    /// Cranks on cranks, each with its driver.
    Chain(usize),
    FourBar,
    SliderCrank,
    /// A four-bar whose coupler is a massless link.
    Linked,
}

/// The random choices that define a mechanism.
#[derive(Clone, Debug)]
struct Plan {
    shape: Shape,
    names: Vec<&'static str>,
    /// The short link and three long ones (mm).
    links: [f64; 4],
    /// The first crank's angle at the start, and its speed [deg, deg/s].
    start: f64,
    speed: f64,
    /// The ground's first point (mm).
    origin: [f64; 2],
    /// Decides the order of the declarations.
    order: Vec<u32>,
    /// Decides which of several is broken.
    which: prop::sample::Index,
    other: prop::sample::Index,
}

fn plans(shapes: &'static [Shape]) -> impl Strategy<Value = Plan> {
    let long = 200.0..300.0_f64;
    (
        prop::sample::select(shapes),
        Just(NAMES.to_vec()).prop_shuffle(),
        [(40.0..80.0_f64).boxed(), long.clone().boxed(), long.clone().boxed(), long.boxed()],
        // nowhere near a dead point of the slider's
        (20.0..80.0_f64, prop_oneof![-60.0..-20.0_f64, 20.0..60.0_f64]),
        [-500.0..500.0_f64, -500.0..500.0_f64],
        prop::collection::vec(any::<u32>(), 20),
        any::<(prop::sample::Index, prop::sample::Index)>(),
    )
        .prop_map(|(shape, names, links, (start, speed), origin, order, (which, other))| Plan {
            shape,
            names,
            links,
            start,
            speed,
            origin,
            order,
            which,
            other,
        })
}

impl Plan {
    fn drivers(&self) -> usize {
        if let Shape::Chain(count) = self.shape { count } else { 1 }
    }

    fn joints(&self) -> usize {
        match self.shape {
            Shape::Chain(count) => count,
            Shape::FourBar | Shape::SliderCrank => 4,
            Shape::Linked => 3,
        }
    }

    /// The ground too.
    fn bodies(&self) -> usize {
        match self.shape {
            Shape::Chain(count) => 1 + count,
            Shape::FourBar | Shape::SliderCrank => 4,
            Shape::Linked => 3,
        }
    }
}

/// The ground or a body.
#[derive(Clone, Debug)]
struct Body {
    name: String,
    /// [mm, mm, deg]
    pose: [f64; 3],
    /// True if the body is only referred to.
    is_missing: bool,
    /// Word, name, and what follows the `=`.
    features: Vec<[String; 3]>,
}

/// A joint with what it joins: the numbers of the bodies, and the names of their features.
#[derive(Clone, Debug)]
struct Joint {
    name: String,
    kind: String,
    sides: [(usize, String); 2],
    /// The text after the sides.
    rest: String,
}

/// A driver or constraint.
#[derive(Clone, Debug)]
struct Equation {
    word: String,
    name: String,
    left: String,
    right: String,
}

/// A mechanism in parts.
#[derive(Clone, Debug)]
struct Draft {
    /// The ground first.
    bodies: Vec<Body>,
    joints: Vec<Joint>,
    equations: Vec<Equation>,
    order: Vec<u32>,
    unused: Vec<&'static str>,
}

impl Draft {
    fn new(plan: &Plan) -> Draft {
        let ground = Body { name: "ground".to_owned(), pose: [0.0; 3], is_missing: false, features: Vec::new() };
        let mut draft = Draft {
            bodies: vec![ground],
            joints: Vec::new(),
            equations: Vec::new(),
            order: plan.order.clone(),
            unused: plan.names.clone(),
        };
        let [crank, a, b, c] = plan.links;
        let turned = |[x, y]: [f64; 2], length: f64, degrees: f64| {
            let (sin, cos) = mechc_expr::math::sin_cos(degrees / 360.0 * TAU);
            [x + length * cos, y + length * sin]
        };
        let toward =
            |[x, y]: [f64; 2], [to_x, to_y]: [f64; 2]| mechc_expr::math::atan2(to_y - y, to_x - x) / TAU * 360.0;
        match plan.shape {
            Shape::Chain(count) => {
                let (mut base, mut at) = (0, plan.origin);
                for k in 0..count {
                    let (length, angle) = (plan.links[k % 4], plan.start + 30.0 * k as f64);
                    let body = draft.body(at, angle);
                    let pin = draft.pin(base, body, at);
                    draft.drive(pin, plan.speed + k as f64);
                    (base, at) = (body, turned(at, length, angle));
                }
                draft.point(base, at);
            }
            Shape::FourBar => {
                let pin = turned(plan.origin, crank, plan.start);
                let pivot = turned(plan.origin, a, 0.0);
                // where the coupler's end meets the rocker's
                let (far, line) = (distance(pin, pivot), toward(pin, pivot));
                let inner = mechc_expr::math::acos((b * b + far * far - c * c) / (2.0 * b * far)) / TAU * 360.0;
                let knee = turned(pin, b, line + inner);
                let first = draft.body(plan.origin, plan.start);
                let main = draft.pin(0, first, plan.origin);
                let coupler = draft.body(pin, line + inner);
                draft.pin(first, coupler, pin);
                let rocker = draft.body(pivot, toward(pivot, knee));
                draft.pin(coupler, rocker, knee);
                draft.pin(rocker, 0, pivot);
                draft.drive(main, plan.speed);
            }
            Shape::Linked => {
                let pin = turned(plan.origin, crank, plan.start);
                let (pivot, knee) = (turned(plan.origin, a, 0.0), turned(pin, b, 70.0));
                let first = draft.body(plan.origin, plan.start);
                let main = draft.pin(0, first, plan.origin);
                let rocker = draft.body(pivot, toward(pivot, knee));
                draft.pin(rocker, 0, pivot);
                let (p, q, name) = (draft.point(first, pin), draft.point(rocker, knee), draft.name());
                let (kind, rest) = ("revolute_revolute".to_owned(), format!(", {b} mm"));
                draft.joints.push(Joint { name, kind, sides: [(first, p), (rocker, q)], rest });
                draft.drive(main, plan.speed);
            }
            Shape::SliderCrank => {
                let pin = turned(plan.origin, crank, plan.start);
                let rise = pin[1] - plan.origin[1];
                let wrist = [pin[0] + mechc_expr::math::sqrt(a * a - rise * rise), plan.origin[1]];
                let first = draft.body(plan.origin, plan.start);
                let main = draft.pin(0, first, plan.origin);
                let rod = draft.body(pin, toward(pin, wrist));
                draft.pin(first, rod, pin);
                let slider = draft.body(wrist, 0.0);
                draft.pin(rod, slider, wrist);
                let along = "(0, 0) along (1, 0)".to_owned();
                let ways =
                    [(0, format!("({} mm, {} mm) along (1, 0)", plan.origin[0], plan.origin[1])), (slider, along)];
                let sides = ways.map(|(body, rest)| (body, draft.feature(body, "axis", rest)));
                let name = draft.name();
                draft.joints.push(Joint { name, kind: "translational".to_owned(), sides, rest: String::new() });
                draft.drive(main, plan.speed);
            }
        }
        draft
    }

    fn name(&mut self) -> String {
        self.unused.pop().expect("names enough").to_owned()
    }

    fn body(&mut self, [x, y]: [f64; 2], degrees: f64) -> usize {
        let name = self.name();
        self.bodies.push(Body { name, pose: [x, y, degrees], is_missing: false, features: Vec::new() });
        self.bodies.len() - 1
    }

    fn feature(&mut self, body: usize, word: &str, rest: String) -> String {
        let name = self.name();
        self.bodies[body].features.push([word.to_owned(), name.clone(), rest]);
        name
    }

    fn point(&mut self, body: usize, [x, y]: [f64; 2]) -> String {
        let [ox, oy, degrees] = self.bodies[body].pose;
        let (sin, cos) = mechc_expr::math::sin_cos(degrees / 360.0 * TAU);
        let [x, y] = [x - ox, y - oy];
        self.feature(body, "point", format!("({} mm, {} mm)", cos * x + sin * y, cos * y - sin * x))
    }

    fn pin(&mut self, a: usize, b: usize, at: [f64; 2]) -> usize {
        let sides = [a, b].map(|body| (body, self.point(body, at)));
        let name = self.name();
        self.joints.push(Joint { name, kind: "revolute".to_owned(), sides, rest: String::new() });
        self.joints.len() - 1
    }

    fn drive(&mut self, joint: usize, speed: f64) {
        let [from, to] = [0, 1].map(|side: usize| self.bodies[self.joints[joint].sides[side].0].pose[2]);
        let left = format!("rotation({})", self.joints[joint].name);
        let right = format!("{} deg + {speed} deg/s * t", to - from);
        let name = self.name();
        self.equations.push(Equation { word: "driver".to_owned(), name, left, right });
    }

    fn text(&self) -> String {
        let mut parts: Vec<String> = Vec::new();
        for (k, Body { name, pose: [x, y, phi], features, .. }) in
            self.bodies.iter().enumerate().filter(|(_, body)| !body.is_missing)
        {
            let features: Vec<String> =
                features.iter().map(|[word, name, rest]| format!("{word} {name} = {rest}")).collect();
            let features = features.join("\n        ");
            let head = if k == 0 { name.clone() } else { format!("body {name} at ({x} mm, {y} mm, {phi} deg)") };
            parts.push(format!("{head} {{\n        {features}\n    }}"));
        }
        for Joint { name, kind, sides, rest } in &self.joints {
            let sides = sides.each_ref().map(|(body, feature)| format!("{}.{feature}", self.bodies[*body].name));
            parts.push(format!("joint {name}: {kind}({}{rest})", sides.join(", ")));
        }
        for Equation { word, name, left, right } in &self.equations {
            parts.push(format!("{word} {name}: {left} = {right}"));
        }
        let mut order: Vec<usize> = (0..parts.len()).collect();
        order.sort_by_key(|&k| self.order[k % self.order.len()].rotate_left(k as u32));
        let parts: Vec<&str> = order.into_iter().map(|k| parts[k].as_str()).collect();
        format!("mechanism machine {{\n    {}\n    analysis from 0 s to 0.1 s every 0.05 s\n}}\n", parts.join("\n    "))
    }
}

fn distance([x, y]: [f64; 2], [to_x, to_y]: [f64; 2]) -> f64 {
    mechc_expr::math::hypot(to_x - x, to_y - y)
}

// ---- breaks

/// The diagnostic that a fault must have.
struct Expected {
    code: &'static str,
    /// Names of declarations of which at least one must have a label.
    on: Vec<String>,
    /// Text that the help must contain.
    help: Option<String>,
}

fn expect(code: &'static str, on: &str) -> Expected {
    Expected { code, on: vec![on.to_owned()], help: None }
}

/// The text, after a check of the unbroken one.
fn outcome(draft: &Draft) -> Outcome {
    run("machine.mech", &draft.text(), Span::default())
}

/// Checks that the injected fault is reported.
fn reported(draft: &Draft, expected: &Expected) -> Result<(), TestCaseError> {
    let outcome = outcome(draft);
    let text = draft.text();
    let complaint = |what: &str| TestCaseError::fail(format!("{what}\n{text}\n{}", outcome.text()));
    let found = outcome.diagnostics.iter().filter(|diagnostic| is_error(diagnostic));
    let (of_break, others): (Vec<_>, Vec<_>) = found.partition(|diagnostic| diagnostic.code.as_str() == expected.code);
    if of_break.is_empty() {
        return Err(complaint(&format!("expected {}", expected.code)));
    }
    if !others.is_empty() {
        return Err(complaint(&format!("expected {} alone", expected.code)));
    }
    let places = places(&text, &expected.on);
    let is_reported = of_break.iter().flat_map(|diagnostic| &diagnostic.labels).any(|label| {
        let span = label.span.start as usize..label.span.end as usize;
        places.iter().any(|place| place.start <= span.start && span.end <= place.end)
    });
    if !is_reported {
        return Err(complaint(&format!("expected a label on one of {:?}", expected.on)));
    }
    let help: Vec<&str> = of_break.iter().flat_map(|diagnostic| &diagnostic.help).map(String::as_str).collect();
    match &expected.help {
        Some(wanted) if !help.iter().any(|help| help.contains(wanted)) => {
            Err(complaint(&format!("expected help with {wanted}")))
        }
        _ => Ok(()),
    }
}

/// Returns the ranges of the declarations of some names; `machine` is the mechanism's own name.
fn places(text: &str, names: &[String]) -> Vec<std::ops::Range<usize>> {
    let mut sources = Sources::default();
    let file = sources.add("machine.mech", text);
    let tree = syntax::parse(&sources, file).tree;
    let mechanism = &tree.mechanisms[0];
    let range = |span: mechc::Span| span.start as usize..span.end as usize;
    let items = mechanism.items.iter().filter(|item| {
        let name = match &item.kind {
            ItemKind::Ground { .. } => "ground",
            ItemKind::Body { name, .. } | ItemKind::Joint { name, .. } | ItemKind::Equation { name, .. } => &name.text,
            _ => return false,
        };
        names.iter().any(|wanted| wanted == name)
    });
    let own = names.contains(&mechanism.name.text).then(|| range(mechanism.name.span));
    let places: Vec<_> = items.map(|item| range(item.span)).chain(own).collect();
    assert!(!places.is_empty(), "none of {names:?} is declared");
    places
}

const ALL: &[Shape] =
    &[Shape::Chain(1), Shape::Chain(2), Shape::Chain(3), Shape::FourBar, Shape::SliderCrank, Shape::Linked];
const LOOPS: &[Shape] = &[Shape::FourBar, Shape::SliderCrank, Shape::Linked];
const LINKED: &[Shape] = &[Shape::Linked];
const SLIDERS: &[Shape] = &[Shape::SliderCrank];

/// Breaks random mechanisms and looks at what is said, after a check that nothing is said of the whole ones.
fn broken(shapes: &'static [Shape], spoil: impl Fn(&mut Draft, &Plan) -> Expected) {
    let config = Config { cases: CASES, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..Config::default() };
    let result = TestRunner::new(config).run(&plans(shapes), |plan| {
        let mut draft = Draft::new(&plan);
        let whole = outcome(&draft);
        prop_assert!(whole.diagnostics.is_empty(), "{}\n{}", draft.text(), whole.text());
        let expected = spoil(&mut draft, &plan);
        reported(&draft, &expected)
    });
    if let Err(fault) = result {
        panic!("{fault}");
    }
}

#[test]
fn a_driver_taken_away() {
    broken(ALL, |draft, plan| {
        let gone = draft.equations.remove(plan.which.index(draft.equations.len()));
        // what the help names must mend it
        let outcome = outcome(draft);
        let help: String = outcome.diagnostics.iter().flat_map(|diagnostic| diagnostic.help.clone()).collect();
        let mends = |joint: usize| {
            let mut mended = draft.clone();
            mended.drive(joint, plan.speed);
            help.contains(&format!("rotation({})", draft.joints[joint].name)) && self::outcome(&mended).succeeded()
        };
        let some = (0..draft.joints.len()).any(mends);
        assert!(some, "nothing of the help mends it:\n{}{}", draft.text(), outcome.text());
        let help = matches!(plan.shape, Shape::Chain(1)).then(|| gone.left.clone());
        Expected { help, ..expect("E0502", "machine") }
    });
}

#[test]
fn duplicate_driver() {
    broken(ALL, |draft, plan| {
        let twin = draft.equations[plan.which.index(draft.equations.len())].clone();
        let name = draft.name();
        let on = vec![twin.name.clone(), name.clone()];
        draft.equations.push(Equation { name, ..twin });
        Expected { code: "E0506", on, help: None }
    });
}

#[test]
fn two_drivers_of_unlike_speeds() {
    broken(ALL, |draft, plan| {
        let twin = draft.equations[plan.which.index(draft.equations.len())].clone();
        let (name, right) = (draft.name(), format!("{} + 10 deg/s * t", twin.right));
        let on = vec![twin.name.clone(), name.clone()];
        draft.equations.push(Equation { name, right, ..twin });
        Expected { code: "E0507", on, help: None }
    });
}

#[test]
fn two_drivers_of_unlike_starts() {
    broken(ALL, |draft, plan| {
        let twin = draft.equations[plan.which.index(draft.equations.len())].clone();
        let (name, right) = (draft.name(), format!("{} + 5 deg", twin.right));
        let on = vec![twin.name.clone(), name.clone()];
        draft.equations.push(Equation { name, right, ..twin });
        Expected { code: "E0507", on, help: None }
    });
}

#[test]
fn duplicate_joint() {
    broken(ALL, |draft, plan| {
        let twin = draft.joints[plan.which.index(draft.joints.len())].clone();
        let name = draft.name();
        let on = vec![twin.name.clone(), name.clone()];
        draft.joints.push(Joint { name, ..twin });
        Expected { code: "E0506", on, help: None }
    });
}

#[test]
fn a_joint_that_is_driven_taken_away() {
    broken(ALL, |draft, plan| {
        let driver = &draft.equations[plan.which.index(draft.equations.len())];
        draft.joints.retain(|joint| !driver.left.contains(&joint.name));
        expect("E0201", &driver.name)
    });
}

#[test]
fn a_joint_of_a_loop_taken_away() {
    broken(LOOPS, |draft, plan| {
        // the first is driven
        let gone = draft.joints.remove(1 + plan.which.index(draft.joints.len() - 1));
        let free: Vec<String> = outcome(draft)
            .diagnostics
            .iter()
            .filter_map(|diagnostic| diagnostic.data.get("free")?.as_array())
            .flatten()
            .filter_map(|name| Some(name.as_str()?.to_owned()))
            .collect();
        let of_joint = |name: &String| {
            gone.sides.iter().any(|(body, _)| *body != 0 && name.starts_with(&format!("{}.", draft.bodies[*body].name)))
        };
        assert!(free.iter().any(of_joint), "{free:?} has no body of {gone:?}\n{}", draft.text());
        expect("E0502", "machine")
    });
}

#[test]
fn a_body_that_is_much_too_long() {
    broken(&[Shape::FourBar, Shape::SliderCrank], |draft, plan| {
        // a rod of a slider is never too long
        let body = if plan.shape == Shape::SliderCrank { 1 } else { 1 + plan.which.index(3) };
        let length = 20.0 * plan.links.iter().sum::<f64>();
        // the point that is not at the body's origin
        draft.bodies[body].features[1][2] = format!("({length} mm, 0)");
        // the loop does not close, and where it gapes is where the search has left it
        let on = draft.joints.iter().map(|joint| joint.name.clone()).collect();
        Expected { code: "E0601", on, help: None }
    });
}

#[test]
fn a_link_that_is_much_too_long() {
    broken(LINKED, |draft, plan| {
        let Joint { name, rest, .. } = draft.joints.last_mut().expect("the link");
        *rest = format!(", {} mm", 20.0 * plan.links.iter().sum::<f64>());
        expect("E0601", name)
    });
}

#[test]
fn a_link_of_no_length() {
    broken(LINKED, |draft, _| {
        let Joint { name, rest, .. } = draft.joints.last_mut().expect("the link");
        ", 0 mm".clone_into(rest);
        expect("E0406", name)
    });
}

#[test]
fn a_link_without_a_length() {
    broken(LINKED, |draft, _| {
        let Joint { name, rest, .. } = draft.joints.last_mut().expect("the link");
        rest.clear();
        expect("E0301", name)
    });
}

#[test]
fn a_body_misspelt() {
    misspelt(|name| format!("{name}s"));
    misspelt(|name| {
        let mut letters: Vec<char> = name.chars().collect();
        letters.swap(1, 2);
        letters.into_iter().collect()
    });
}

/// A joint names a body that does not exist.
fn misspelt(spell: fn(&str) -> String) {
    broken(ALL, |draft, plan| {
        let joint = plan.which.index(draft.joints.len());
        let side = plan.other.index(2);
        let Joint { name, mut sides, .. } = draft.joints[joint].clone();
        // one of the two is not the ground
        let body = sides[side].0.max(sides[1 - side].0);
        let meant = draft.bodies[body].name.clone();
        draft.bodies.push(Body { name: spell(&meant), pose: [0.0; 3], is_missing: true, features: Vec::new() });
        sides[side].0 = draft.bodies.len() - 1;
        draft.joints[joint].sides = sides;
        Expected { help: Some(format!("`{meant}`")), ..expect("E0201", &name) }
    });
}

#[test]
fn a_point_misspelt() {
    broken(ALL, |draft, plan| {
        let joint = plan.which.index(draft.joints.len());
        let (_, feature) = &mut draft.joints[joint].sides[plan.other.index(2)];
        let meant = feature.clone();
        *feature = feature.chars().enumerate().filter_map(|(k, letter)| (k != 1).then_some(letter)).collect();
        Expected { help: Some(format!("`{meant}`")), ..expect("E0201", &draft.joints[joint].name) }
    });
}

#[test]
fn a_driven_joint_misspelt() {
    broken(ALL, |draft, plan| {
        let driver = plan.which.index(draft.equations.len());
        let Equation { name, left, .. } = &mut draft.equations[driver];
        let meant = left.trim_start_matches("rotation(").trim_end_matches(')').to_owned();
        *left = left.replace(')', "e)");
        Expected { help: Some(format!("`{meant}`")), ..expect("E0201", name) }
    });
}

#[test]
fn a_kind_of_joint_misspelt() {
    broken(ALL, |draft, plan| {
        let joint = plan.which.index(draft.joints.len());
        let Joint { name, kind, .. } = &mut draft.joints[joint];
        let meant = std::mem::replace(kind, kind.replace('l', ""));
        Expected { help: Some(format!("`{meant}`")), ..expect("E0201", name) }
    });
}

#[test]
fn a_place_in_seconds() {
    broken(ALL, |draft, plan| {
        let body = plan.which.index(draft.bodies.len());
        let Body { name, features, .. } = &mut draft.bodies[body];
        let points: Vec<usize> = (0..features.len()).filter(|&k| features[k][0] == "point").collect();
        let point = points[plan.other.index(points.len())];
        features[point][2] = features[point][2].replace(" mm", " s");
        expect("E0402", name)
    });
}

#[test]
fn a_place_half_in_seconds() {
    broken(ALL, |draft, plan| {
        let body = plan.which.index(draft.bodies.len());
        let Body { name, features, .. } = &mut draft.bodies[body];
        features[0][2] = features[0][2].replacen(" mm", " s", 1);
        expect("E0401", name)
    });
}

#[test]
fn an_angle_in_millimetres() {
    broken(ALL, |draft, plan| {
        let Equation { name, right, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        *right = right.replace("deg", "mm");
        expect("E0401", name)
    });
}

#[test]
fn a_time_for_an_angle() {
    broken(ALL, |draft, plan| {
        let Equation { name, right, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        *right = right.replace("deg/s", "deg");
        right.push_str(" * 1 s");
        expect("E0401", name)
    });
}

#[test]
fn joint_within_one_body() {
    broken(ALL, |draft, plan| {
        let Joint { name, sides, .. } = &mut draft.joints[plan.which.index(plan.joints())];
        let side = plan.other.index(2);
        sides[side] = sides[1 - side].clone();
        expect("E0303", name)
    });
}

#[test]
fn time_in_a_constraint() {
    broken(ALL, |draft, plan| {
        let Equation { word, name, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        "constraint".clone_into(word);
        expect("E0306", name)
    });
}

#[test]
fn an_axis_of_no_length() {
    broken(SLIDERS, |draft, plan| {
        let Joint { sides, .. } = draft.joints.last().expect("the guide");
        let (body, axis) = &sides[plan.which.index(2)];
        let Body { name, features, .. } = &mut draft.bodies[*body];
        let feature = features.iter_mut().find(|[_, name, _]| name == axis).expect("the axis");
        feature[2] = feature[2].replace("(1, 0)", "(0, 0)");
        expect("E0405", name)
    });
}

#[test]
fn a_point_for_an_axis() {
    broken(SLIDERS, |draft, plan| {
        let (bodies, joint) = (&draft.bodies, draft.joints.last_mut().expect("the guide"));
        let (body, feature) = &mut joint.sides[plan.which.index(2)];
        let point = bodies[*body].features.iter().find(|[word, ..]| word == "point").expect("a point");
        feature.clone_from(&point[1]);
        expect("E0302", &joint.name)
    });
}

#[test]
fn the_turn_of_a_guide() {
    broken(SLIDERS, |draft, _| {
        draft.equations[0].left = format!("rotation({})", draft.joints.last().expect("the guide").name);
        expect("E0304", &draft.equations[0].name)
    });
}

#[test]
fn a_name_given_twice() {
    broken(LOOPS, |draft, plan| {
        // the first is driven, and its driver would not find it any more
        let twin = draft.joints[1 + plan.which.index(plan.joints() - 1)].name.clone();
        draft.equations[0].name.clone_from(&twin);
        expect("E0203", &twin)
    });
}

#[test]
fn a_point_declared_twice() {
    broken(ALL, |draft, plan| {
        let Body { name, features, .. } = &mut draft.bodies[plan.which.index(plan.bodies())];
        let twin = features[plan.other.index(features.len())][1].clone();
        features.push(["point".to_owned(), twin, "(0, 0)".to_owned()]);
        expect("E0203", name)
    });
}

#[test]
fn driver_without_quantity() {
    broken(ALL, |draft, plan| {
        let Equation { name, left, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        "30 deg".clone_into(left);
        expect("E0308", name)
    });
}

#[test]
fn a_place_that_is_infinite() {
    broken(ALL, |draft, plan| {
        let Body { name, features, .. } = &mut draft.bodies[plan.which.index(plan.bodies())];
        features[0][2] = features[0][2].replacen(" mm", " mm / (1 - 1)", 1);
        expect("E0404", name)
    });
}

#[test]
fn a_driver_that_jumps() {
    broken(ALL, |draft, plan| {
        let Equation { name, right, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        right.push_str(" + 3 deg * sign(t / 0.07 s - 1)");
        expect("E0609", name)
    });
}

#[test]
fn a_driver_whose_formula_ends() {
    broken(ALL, |draft, plan| {
        let Equation { name, right, .. } = &mut draft.equations[plan.which.index(plan.drivers())];
        right.push_str(" + 3 deg * (sqrt(1 - t / 0.07 s) - 1)");
        expect("E0605", name)
    });
}

/// Loops that have nothing to do with each other, one of which cannot close: so many that they are assembled one by one.
#[test]
fn one_faulty_loop_of_many_is_reported_as_alone() {
    let four_bar = |k: usize, rod: f64| {
        let x = 10.0 * k as f64;
        format!(
            "body crank{k} at ({x}, 0, 0.5) {{ point A = (0, 0) point C = (1, 0) }}
            body coupler{k} at ({}, 0.48, 0.78) {{ point C = (0, 0) point D = ({rod}, 0) }}
            body rocker{k} at ({}, 1.5, 1.8) {{ point B = (-1.5, 0) point D = (1.5, 0) }}
            joint main{k}: revolute(ground.A{k}, crank{k}.A)
            joint pin{k}: revolute(crank{k}.C, coupler{k}.C)
            joint knee{k}: revolute(coupler{k}.D, rocker{k}.D)
            joint pivot{k}: revolute(ground.B{k}, rocker{k}.B)
            driver motor{k}: rotation(main{k}) = 0.5 + 2 * t\n",
            x + 0.88,
            x + 3.7
        )
    };
    let reported = |loops: std::ops::Range<usize>| {
        let bars: String = loops.clone().map(|k| four_bar(k, if k == 70 { 0.05 } else { 3.5 })).collect();
        let points = loops.map(|k| format!("point A{k} = ({}, 0) point B{k} = ({}, 0)", 10 * k, 10 * k + 4));
        let points = points.collect::<Vec<_>>().join(" ");
        let outcome = run(
            "many",
            &format!("mechanism many {{ ground {{ {points} }}\n{bars} analysis from 0 to 1 every 0.5 }}"),
            Span::default(),
        );
        let errors = outcome.diagnostics.iter().filter(|message| message.is_error());
        errors
            .map(|message| (message.code.as_str(), message.message.clone(), message.notes.clone()))
            .collect::<Vec<_>>()
    };
    let (alone, among) = (reported(70..71), reported(0..110));
    assert_eq!(alone.len(), 1);
    assert_eq!(alone[0].0, "E0601");
    assert_eq!(among, alone);
}
