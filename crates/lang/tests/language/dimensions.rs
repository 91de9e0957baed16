//! Quantities have dimensions whether or not a unit is written: random formulas against a checker of dimensions of its own.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use mechc::{Choice, Memory, Parsed};

/// Powers of length, time and mass, or any, where a plain number is a factor.
type Dim = Option<[i32; 3]>;

/// Numbers that look random, the same ones every time.
struct Draws(u64);

impl Draws {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % count
    }
}

const QUANTITIES: [(&str, [i32; 3]); 10] = [
    ("x(b.P)", [1, 0, 0]),
    ("distance(b.P, ground.Q)", [1, 0, 0]),
    ("angle(b)", [0, 0, 0]),
    ("rotation(j)", [0, 0, 0]),
    ("der(y(b.P))", [1, -1, 0]),
    ("der(angle(b))", [0, -1, 0]),
    ("speed(b.P)", [1, -1, 0]),
    ("force_x(j)", [1, -2, 1]),
    ("effort(d)", [2, -2, 1]),
    ("lever", [1, 0, 0]),
];

/// A formula of some depth, its dimension, and whether unlike terms meet in it.
fn formula(draws: &mut Draws, depth: u32) -> (String, Dim, bool) {
    if depth == 0 {
        return if draws.below(5) == 0 {
            (["2", "0.5", "k"][draws.below(3) as usize].to_owned(), None, false)
        } else {
            let (text, dim) = QUANTITIES[draws.below(10) as usize];
            (text.to_owned(), Some(dim), false)
        };
    }
    let (a, of_a, wrong_a) = formula(draws, depth - 1);
    let (b, of_b, wrong_b) = formula(draws, depth - 1);
    let wrong = wrong_a || wrong_b;
    let meet = wrong || matches!((of_a, of_b), (Some(a), Some(b)) if a != b);
    match draws.below(8) {
        0 => (format!("({a} + {b})"), of_a.or(of_b), meet),
        1 => (format!("({a} - {b})"), of_a.or(of_b), meet),
        2 => (format!("min({a}, {b})"), of_a.or(of_b), meet),
        3 => (format!("(if {a} < {b} then 1 else 2)"), None, meet),
        4 => (format!("(if t < 1 then {a} else {b})"), of_a.or(of_b), meet),
        5 => {
            let dim = of_a.zip(of_b).map(|(a, b)| [0, 1, 2].map(|k| a[k] + b[k]));
            (format!("{a} * {b}"), dim, wrong)
        }
        6 => (format!("twice({a})"), None, wrong_a),
        _ => (format!("abs({a})"), of_a, wrong_a),
    }
}

/// The codes of what is said of a mechanism with some declarations.
fn codes(declarations: &str) -> Vec<String> {
    let text = format!(
        "mechanism m {{
            param k = 3
            fn twice(u) = 2 * u
            ground {{ point O = (0, 0) point Q = (3, 0) }}
            body b {{ point O = (0, 0) point P = (1, 0) mass 2 inertia 1 }}
            joint j: revolute(ground.O, b.O)
            driver d: rotation(j) = 1.5 * t
            measure lever = y(b.P)
            measure mu = angle(b) in deg
            measure n = der(angle(b)) in rpm
            {declarations}
        }}"
    );
    let checked = Parsed::new("m.mech", &text).check(&Choice::default(), &Memory::default());
    checked.diagnostics().iter().map(|message| message.code.as_str().to_owned()).collect()
}

#[test]
fn unlike_terms_are_found_in_formulas_without_units() {
    assert_eq!(codes(""), [""; 0]);
    let mut draws = Draws(20_261_128);
    let mut verdicts = [0; 2];
    for _ in 0..1500 {
        let depth = 1 + draws.below(3) as u32;
        let (text, _, is_wrong) = formula(&mut draws, depth);
        let messages = codes(&format!("measure e = {text}"));
        assert_eq!(messages.iter().any(|code| code == "E0401"), is_wrong, "{text}: {messages:?}");
        assert!(messages.iter().all(|code| code == "E0401"), "{text}: {messages:?}");
        verdicts[usize::from(is_wrong)] += 1;
    }
    assert!(verdicts.iter().all(|&count| count > 300), "{verdicts:?}");
}

#[test]
fn formulas_of_numbers_and_time_are_in_si() {
    for side in ["2 * cos(t)", "t", "t + t^2", "sin(t) + 3 * t^2", "pi * t", "if t < 1 then t else 1"] {
        let text = format!("driver other: x(b.P) = {side}");
        assert_eq!(codes(&text), [""; 0], "{text}");
    }
    for measure in
        ["x(b.P) - sin(t)", "rotation(j) - t", "3 * x(b.P)^2 + y(b.P)", "x(b.P) + 2", "x(b.P) * t + angle(b)"]
    {
        assert_eq!(codes(&format!("measure e = {measure}")), [""; 0], "{measure}");
    }
    assert_eq!(codes("driver other: angle(b) = 30 deg + 2 * t"), [""; 0]);
    assert_eq!(codes("driver other: x(b.P) = 30 deg + 2 * t"), ["E0401"]);
    // a curve in coordinates, which are numbers of metres
    assert_eq!(codes("constraint c: y(b.P) = x(b.P)^2"), [""; 0]);
    assert_eq!(codes("constraint c: y(b.P) = angle(b)"), ["E0401"]);
}

#[test]
fn bare_numbers_with_degrees_warn() {
    for (formula, is_warned) in [
        ("180 - mu", true),
        ("abs(mu) - 2 * 45", true),
        ("if mu > k then 1 else 2", true),
        ("max(mu, 90)", true),
        ("mod(mu, 360)", true),
        ("60 - n", true),
        ("90 - der(mu)", true),
        ("180 deg - mu", false),
        ("pi - mu", false),
        ("mu - 0", false),
        ("2 * mu", false),
        ("mu * mu - 1", false),
        ("1 - angle(b)", false),
    ] {
        let messages = codes(&format!("measure e = {formula}"));
        assert_eq!(messages, if is_warned { vec!["W0401"] } else { vec![] }, "{formula}");
    }
    let through_a_function = "fn beside(u) = 180 - u measure e = beside(mu) measure f = beside(angle(b))";
    assert_eq!(codes(through_a_function), ["W0401"]);
    assert_eq!(codes("result r = min(min(abs(mu), 180 - abs(mu)))"), ["W0401"]);
}

/// A mechanism whose param `off` is a literal zero, which fits lengths and angles alike.
const ZERO: &str = "mechanism m {
    param off = 0
    param more = off + 3 mm
    body b { point P = (off, 3 mm) }
    driver x: x(b.P) = more + 2 mm/s * t
    driver y: y(b.P) = 10 mm + off
    driver a: angle(b) = 1 rad/s * t + off
}";

#[test]
fn settings_of_a_zero_are_checked_as_in_the_text() {
    let codes = |text: &str, set: &[String]| -> Vec<&str> {
        let choice = Choice { set: set.to_vec(), ..Choice::default() };
        let checked = Parsed::new("m.mech", text).check(&choice, &Memory::default());
        checked.diagnostics().iter().map(|message| message.code.as_str()).collect()
    };
    for value in ["0", "-0", "5", "5 mm", "0 mm", "1e-300", "1 - 1"] {
        let edited = codes(&ZERO.replace("off = 0", &format!("off = {value}")), &[]);
        assert_eq!(codes(ZERO, &[format!("off={value}")]), edited, "{value}");
        assert_eq!(edited.is_empty(), matches!(value, "0" | "-0"), "{value}: {edited:?}");
    }
}
