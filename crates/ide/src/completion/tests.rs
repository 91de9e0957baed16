//! Tests of completions in unfinished texts.

use super::completions;
use crate::testing::{FOUR_BAR, TWO_FILES, at_cursor};

/// Lists the first completions at a cursor: rank, label with arguments, description, and the inserted text if it differs from the label.
#[track_caller]
fn proposed(text: &str, count: usize) -> String {
    let (snapshot, position) = at_cursor(text);
    let items = completions(&snapshot, &position).expect("a file").items;
    let line = |item: &super::CompletionItem| {
        let mut written = item.insert.text.clone();
        for hole in item.insert.holes.iter().rev() {
            written.insert(hole.end, '»');
            written.insert(hole.start, '«');
        }
        let written = if written == item.label { String::new() } else { format!(" → {written}") };
        let detail = if item.detail.is_empty() { String::new() } else { format!(" — {}", item.detail) };
        format!("{} {}{}{detail}{written}", item.rank, item.label, item.signature)
    };
    items.iter().take(count).map(line).collect::<Vec<_>>().join("\n")
}

/// Replaces a line of the four-bar.
fn with(from: &str, to: &str) -> String {
    assert!(FOUR_BAR.contains(from), "{from}");
    FOUR_BAR.replacen(from, to, 1)
}

const PIN: &str = "joint pin:   revolute(crank.B, coupler.B)\n";
const KNEE: &str = "joint knee:  revolute(coupler.C, rocker.C)\n";

#[test]
fn points_of_a_body_come_behind_its_dot() {
    insta::assert_snapshot!(proposed(&with(KNEE, "joint knee: revolute(coupler.$0\n"), 9), @r"
    1 B — point B = (0, 0), of coupler
    1 C — point C = (80 mm, 0), of coupler
    ");
    insta::assert_snapshot!(proposed(&with("rotation(main) = 60 deg + 90 deg/s * t", "x(crank.B$0"), 9), @r"
    1 A — point A = (0, 0), of crank
    1 B — point B = (crank_length, 0), of crank
    ");
    insta::assert_snapshot!(proposed(&with(KNEE, "joint knee: revolute(nobody.$0)\n"), 9), @"");
}

#[test]
fn a_joint_proposes_its_arguments() {
    insta::assert_snapshot!(proposed(&with(KNEE, "joint knee: revolute($0\n"), 20), @r"
    1 ground.A — point A = (0, 0), of ground
    1 ground.D — point D = (100 mm, 0), of ground
    1 crank.A — point A = (0, 0), of crank
    1 crank.B — point B = (crank_length, 0), of crank
    1 coupler.B — point B = (0, 0), of coupler
    1 coupler.C — point C = (80 mm, 0), of coupler
    1 rocker.D — point D = (0, 0), of rocker
    1 rocker.C — point C = (60 mm, 0), of rocker
    ");
    insta::assert_snapshot!(proposed(&with(KNEE, "joint knee: revolute(coupler.C,$0\n"), 3), @r"
    1 ground.A — point A = (0, 0), of ground →  ground.A
    1 ground.D — point D = (100 mm, 0), of ground →  ground.D
    1 crank.A — point A = (0, 0), of crank →  crank.A
    ");
    let axes = with(
        "point A = (0, 0)\n        point D",
        "axis way = (0, 0) along (1, 0)\n        point A = (0, 0)\n        point D",
    );
    insta::assert_snapshot!(proposed(&axes.replacen(KNEE, "joint knee: translational($0)\n", 1), 9), @"1 ground.way — axis way = (0, 0) along (1, 0), of ground");
    insta::assert_snapshot!(proposed(&with(PIN, "joint pin: revolute(coupler.B,$0)\n"), 3), @r"
    0 crank.B — lies on `coupler.B` →  crank.B
    1 ground.A — point A = (0, 0), of ground →  ground.A
    1 ground.D — point D = (100 mm, 0), of ground →  ground.D
    ");
    insta::assert_snapshot!(proposed(&with(PIN, "joint pin: $0\n"), 2), @r"
    0 revolute(crank.B, coupler.B) — these points lie on each other
    1 revolute(P, Q) — two points · 2 equations → revolute(«P», «Q»)
    ");
    insta::assert_snapshot!(proposed(&with(KNEE, "joint knee: $0\n"), 5), @r"
    1 revolute(P, Q) — two points · 2 equations → revolute(«P», «Q»)
    1 translational(a, b) — two axes · 2 equations → translational(«a», «b»)
    1 weld(P, Q) — two points, and an angle if it is not 0 · 3 equations → weld(«P», «Q»)
    1 revolute_revolute(P, Q, length) — two points and a length · 1 equation → revolute_revolute(«P», «Q», «length»)
    1 revolute_translational(P, a) — a point and an axis, and an offset if it is not 0 · 1 equation → revolute_translational(«P», «a»)
    ");
}

#[test]
fn missing_declarations_are_proposed() {
    insta::assert_snapshot!(proposed(&with(PIN, "$0\n"), 5), @r"
    0 driver drive: rotation(pivot) = 100 deg + 60 deg/s * t — this is left free → driver «drive»: rotation(pivot) = «100 deg + 60 deg/s * t»
    0 driver drive: rotation(knee) = 70 deg + 60 deg/s * t — this is left free → driver «drive»: rotation(knee) = «70 deg + 60 deg/s * t»
    0 joint pin: revolute(crank.B, coupler.B) — these points lie on each other → joint «pin»: revolute(crank.B, coupler.B)
    2 param — a constant that has a name, or a point of the drawing → param «NAME» = «FORMULA»
    2 fn — a function of one argument → fn «NAME»(«u») = «FORMULA»
    ");
    insta::assert_snapshot!(proposed(&with(KNEE, "$0\n"), 3), @r"
    0 driver drive: rotation(pivot) = 100 deg + 60 deg/s * t — this is left free → driver «drive»: rotation(pivot) = «100 deg + 60 deg/s * t»
    0 driver drive: rotation(pin) = -30 deg + 60 deg/s * t — this is left free → driver «drive»: rotation(pin) = «-30 deg + 60 deg/s * t»
    2 param — a constant that has a name, or a point of the drawing → param «NAME» = «FORMULA»
    ");
    insta::assert_snapshot!(proposed(&with("driver motor: rotation(main) = 60 deg + 90 deg/s * t", "dri$0"), 3), @r"
    0 driver motor: rotation(main) = 60 deg + 60 deg/s * t — this is left free → driver «motor»: rotation(main) = «60 deg + 60 deg/s * t»
    0 driver motor: rotation(pivot) = 100 deg + 60 deg/s * t — this is left free → driver «motor»: rotation(pivot) = «100 deg + 60 deg/s * t»
    0 driver motor: rotation(pin) = -30 deg + 60 deg/s * t — this is left free → driver «motor»: rotation(pin) = «-30 deg + 60 deg/s * t»
    ");
    insta::assert_snapshot!(proposed(&with("rotation(main) = 60 deg + 90 deg/s * t", "$0"), 3), @r"
    0 rotation(main) = 60 deg + 60 deg/s * t — this is left free → rotation(main) = «60 deg + 60 deg/s * t»
    0 rotation(pivot) = 100 deg + 60 deg/s * t — this is left free → rotation(pivot) = «100 deg + 60 deg/s * t»
    0 rotation(pin) = -30 deg + 60 deg/s * t — this is left free → rotation(pin) = «-30 deg + 60 deg/s * t»
    ");
}

#[test]
fn declarations_come_where_they_can_begin() {
    insta::assert_snapshot!(proposed(&with("    joint main", "    $0\n    joint main"), 30), @r"
    2 param — a constant that has a name, or a point of the drawing → param «NAME» = «FORMULA»
    2 fn — a function of one argument → fn «NAME»(«u») = «FORMULA»
    2 table — a curve through points, called as a function is → table «NAME» = spline [(«u0», «v0»), («u1», «v1»), «»]
    2 ground — the body that does not move, with its points, axes, circles and curves → ground {
        «»
    }
    2 body — a rigid body, with its points, axes, circles and curves → body «NAME» {
        «»
    }
    2 joint — what two bodies are joined by → joint «NAME»: «KIND»(«»)
    2 driver — an equation that holds time: what a motor or actuator prescribes → driver «NAME»: «FORMULA» = «FORMULA»
    2 constraint — an equation between kinematic quantities that always holds → constraint «NAME»: «FORMULA» = «FORMULA»
    2 gravity — the acceleration of free fall, in the outermost frame → gravity («gx», «gy»)
    2 load — a force or torque of which a formula is known: a spring, a damper, a weight, a pressure → load «NAME»: «FORMULA» on «QUANTITY»
    2 measure — a number that is printed for every time, with its first two derivatives where it has them → measure «NAME» = «FORMULA»
    2 trace — the path of a point: the columns `NAME.x` and `NAME.y`, with their first two derivatives → trace «NAME» = «P»
    2 result — one number for the whole analysis → result «NAME» = «FORMULA»
    2 require — a bound that must hold → require «A» <= «FORMULA» <= «B»
    2 input — a signal that comes from outside, as from an encoder → input «NAME» = «FORMULA»
    2 part — the declarations of another mechanism, once more, under a name → part «NAME»: «MECHANISM»(«»)
    2 analysis — the times for which `mechc run` prints rows → analysis from «A» to «B» every «H»
    ");
    insta::assert_snapshot!(proposed(&with("point B = (crank_length, 0)", "po$0"), 9), @r"
    2 point — a point of a body or the ground → point «P» = («x», «y»)
    2 axis — a directed line of a body or the ground → axis «a» = «P» along («dx», «dy»)
    2 circle — a circle of a body or the ground: a gear's pitch circle, a roller, an eccentric → circle «c» = «P» radius «r»
    2 curve — a profile of a body or the ground → curve «k»(«u») = («x», «y»)
    2 mass — a mass of a body, with its centre and its moment of inertia about that → mass «M»
    ");
    insta::assert_snapshot!(proposed(&format!("{FOUR_BAR}\nme$0"), 9), @r#"
    2 use — takes the mechanisms of another file, which may then serve as parts → use "«FILE».mech"
    2 mechanism — a mechanism: bodies, joints, drivers and what is to be known of them → mechanism «NAME» {
        «»
    }
    "#);
    insta::assert_snapshot!(proposed(&with("point B = (crank_length, 0)", "point $0"), 9), @"");
    insta::assert_snapshot!(proposed(&with("point B = (crank_length, 0)", "point B = (crank_length, 0) // po$0"), 9), @"");
}

#[test]
fn units_come_behind_numbers_those_that_fit_first() {
    insta::assert_snapshot!(proposed(&with("30 mm", "30 $0"), 8), @r"
    1 mm — the millimetre
    2 m — the metre
    2 cm — the centimetre
    2 um — the micrometre
    2 µm — the micrometre; with the Greek letter or the micro sign, and also `um`
    2 km — the kilometre
    2 in — the inch, 25.4 mm
    2 ft — the foot, 12 inches
    ");
    insta::assert_snapshot!(proposed(&with("(80 mm, 0)", "(80 m$0, 0)"), 3), @r"
    1 mm — the millimetre
    2 m — the metre
    2 cm — the centimetre
    ");
    insta::assert_snapshot!(proposed(&with("60 deg)", "60 $0)"), 4), @r"
    1 deg — the degree, π/180: an angle is a pure number
    2 rad — the radian, which is the pure number 1
    2 mrad — the milliradian, which is the pure number 0.001
    2 rev — the revolution, 2π: an angle is a pure number
    ");
    insta::assert_snapshot!(proposed(&with("(100 mm, 0, 100 deg)", "(100 mm + 2$0, 0, 100 deg)"), 2), @r"
    0 mm — the millimetre →  mm
    2 m — the metre →  m
    ");
    insta::assert_snapshot!(proposed(&with("every 0.1 s", "every 0.1 $0"), 4), @r"
    1 s — the second
    2 ms — the millisecond
    2 us — the microsecond
    2 µs — the microsecond; with the Greek letter or the micro sign, and also `us`
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = x(crank.B) in $0\n    analysis"), 3), @r"
    1 m — the metre
    1 mm — the millimetre
    1 cm — the centimetre
    ");
}

#[test]
fn formulas_propose_fitting_operands() {
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = $0\n    analysis"), 44), @r"
    1 crank_length — param crank_length = 30 mm
    2 if — one formula or another → if «CONDITION» then «A» else «B»
    3 t — time, in seconds
    3 pi — half a turn, 3.141592653589793
    3 tau — a whole turn, 2π = 6.283185307179586
    4 x(P) — the x coordinate of a point, or that of Q less that of P → x(«P»)
    4 y(P) — the y coordinate of a point, or that of Q less that of P → y(«P»)
    4 angle(b) — the angle of a body or axis, or that from the first to the second → angle(«b»)
    4 distance(P, Q) — the distance between two points → distance(«P», «Q»)
    4 rotation(joint) — how far the second body of a revolute joint is turned against the first → rotation(«joint»)
    4 displacement(joint) — how far the second body of a translational joint has moved along the first one's axis → displacement(«joint»)
    4 curvature(P) — the curvature of the path of a point, in a measure → curvature(«P»)
    4 pole_x(b) — x of the instant centre of b relative to c, or to the ground, in a measure → pole_x(«b»)
    4 pole_y(b) — y of the instant centre of b relative to c, or to the ground, in a measure → pole_y(«b»)
    4 speed(P) — the length of the velocity of a point, in a measure → speed(«P»)
    4 pressure_angle(J, b) — the angle between the common normal at a contact and the velocity of a body's point there, in a measure → pressure_angle(«J», «b»)
    4 slip(J) — the speed at which the two bodies of a contact slide on each other, in a measure → slip(«J»)
    4 effort(D) — what a driver or constraint supplies, in a measure or result → effort(«D»)
    4 force_x(J) — x of what a joint exerts on the body of its second argument, in a measure or result → force_x(«J»)
    4 force_y(J) — y of what a joint exerts on the body of its second argument, in a measure or result → force_y(«J»)
    4 torque(J) — the moment that a joint exerts on the body of its second argument, in a measure or result → torque(«J»)
    4 sin(a) — the sine of an angle → sin(«a»)
    4 cos(a) — the cosine of an angle → cos(«a»)
    4 tan(a) — the tangent of an angle → tan(«a»)
    4 asin(a) — the angle whose sine is a, from −π/2 to π/2 → asin(«a»)
    4 acos(a) — the angle whose cosine is a, from 0 to π → acos(«a»)
    4 atan(a) — the angle whose tangent is a, from −π/2 to π/2 → atan(«a»)
    4 atan2(y, x) — the angle of the direction (x, y), from −π to π → atan2(«y», «x»)
    4 sinh(a) — the hyperbolic sine → sinh(«a»)
    4 cosh(a) — the hyperbolic cosine → cosh(«a»)
    4 tanh(a) — the hyperbolic tangent → tanh(«a»)
    4 exp(a) — e to the power of a → exp(«a»)
    4 ln(a) — the natural logarithm → ln(«a»)
    4 log10(a) — the logarithm to the base 10 → log10(«a»)
    4 sqrt(a) — the square root → sqrt(«a»)
    4 hypot(a, b) — the square root of a² + b² → hypot(«a», «b»)
    4 abs(a) — the absolute value → abs(«a»)
    4 sign(a) — −1, 0 or 1: the sign of a → sign(«a»)
    4 min(a, b) — the least of its arguments → min(«a», «b»)
    4 max(a, b) — the largest of its arguments → max(«a», «b»)
    4 mod(a, b) — what is left of a when b is taken away as often as it fits → mod(«a», «b»)
    4 der(e) — the time derivative of e, along the motion; or its derivative by an input or param → der(«e»)
    4 step(u, u0, v0, u1, v1) — from v0 at u0 to v1 at u1, as a cubic → step(«u», «u0», «v0», «u1», «v1»)
    4 step5(u, u0, v0, u1, v1) — from v0 at u0 to v1 at u1, as a quintic → step5(«u», «u0», «v0», «u1», «v1»)
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    param w = $0\n    analysis"), 6), @r"
    1 crank_length — param crank_length = 30 mm
    2 if — one formula or another → if «CONDITION» then «A» else «B»
    3 pi — half a turn, 3.141592653589793
    3 tau — a whole turn, 2π = 6.283185307179586
    4 sin(a) — the sine of an angle → sin(«a»)
    4 cos(a) — the cosine of an angle → cos(«a»)
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = rotation($0\n    analysis"), 6), @r"
    1 main — joint main: revolute(ground.A, crank.A)
    1 pin — joint pin: revolute(crank.B, coupler.B)
    1 knee — joint knee: revolute(coupler.C, rocker.C)
    1 pivot — joint pivot: revolute(ground.D, rocker.D)
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = angle($0\n    analysis"), 14), @r"
    1 crank — body crank at (0, 0, 60 deg)
    1 coupler — body coupler at (15 mm, 26 mm, 30 deg)
    1 rocker — body rocker at (100 mm, 0, 100 deg)
    1 ground.A — point A = (0, 0), of ground
    1 ground.D — point D = (100 mm, 0), of ground
    1 crank.A — point A = (0, 0), of crank
    1 crank.B — point B = (crank_length, 0), of crank
    1 coupler.B — point B = (0, 0), of coupler
    1 coupler.C — point C = (80 mm, 0), of coupler
    1 rocker.D — point D = (0, 0), of rocker
    1 rocker.C — point C = (60 mm, 0), of rocker
    2 ground — the body that does not move
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = der(x(crank.B), $0\n    analysis"), 6), @"1 crank_length — param crank_length = 30 mm");
    insta::assert_snapshot!(proposed(&with("    analysis", "    fn f(u) = 2 * $0\n    analysis"), 3), @r"
    0 u — of this declaration
    1 crank_length — param crank_length = 30 mm
    2 if — one formula or another → if «CONDITION» then «A» else «B»
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    trace p = $0\n    analysis"), 3), @r"
    1 ground.A — point A = (0, 0), of ground
    1 ground.D — point D = (100 mm, 0), of ground
    1 crank.A — point A = (0, 0), of crank
    ");
}

#[test]
fn words_join_the_parts_of_declarations() {
    insta::assert_snapshot!(proposed(&with("at (0, 0, 60 deg)", "$0"), 6), @"1 at — stands before the pose of a body, or the estimate of a curve's argument → at");
    insta::assert_snapshot!(proposed(&with("point B = (crank_length, 0)", "axis a = A $0"), 6), @r"
    1 along — stands before the direction of an axis → along 
    1 to — stands before the second point of an axis, and the last time of an analysis or of the window of a reduction → to
    ");
    insta::assert_snapshot!(proposed(&with("    analysis", "    measure w = x(crank.B) $0\n    analysis"), 6), @"1 in — stands before the unit in which a measure, trace or result is printed → in");
    insta::assert_snapshot!(proposed(&with("from 0 s to 4 s every 0.1 s", "$0"), 6), @"1 from — stands before the first time of an analysis, or of the window of a reduction → from");
    insta::assert_snapshot!(proposed(&with("from 0 s to 4 s every 0.1 s", "from 0 s $0"), 2), @"1 to — stands before the second point of an axis, and the last time of an analysis or of the window of a reduction → to");
}

#[test]
fn a_window_is_proposed_behind_the_formula_of_a_reduction() {
    let of = |typed: &str| {
        let text = with("    analysis", &format!("    param late = 0.5 s\n    result r = {typed}$0\n    analysis"));
        let (snapshot, position) = at_cursor(&text);
        let labels = completions(&snapshot, &position).expect("a file").items.into_iter().map(|item| item.label);
        labels.filter(|label| ["from", "to", "late"].contains(&label.as_str())).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(of("max(x(crank.B),"), "late from to");
    assert_eq!(of("max(x(crank.B), from "), "late");
    assert_eq!(of("max(x(crank.B), from late "), "late to");
    assert_eq!(of("max(x(crank.B), from 0.1 "), "to");
    assert_eq!(of("max(x(crank.B), to late "), "late");
    assert_eq!(of("at(x(crank.B), "), "late");
    assert_eq!(of("sqrt(4, "), "late");
}

#[test]
fn a_unit_continues_with_units_only() {
    let labels = |text: &str| {
        let (snapshot, position) = at_cursor(text);
        let items = completions(&snapshot, &position).expect("a file").items;
        items.into_iter().map(|item| item.label).collect::<Vec<_>>().join(" ")
    };
    insta::assert_snapshot!(labels(&with("90 deg/s", "90 deg/$0")), @"s ms us µs mm m cm um µm km in ft");
    insta::assert_snapshot!(labels(&with("90 deg/s", "90 deg/s$0")), @"s ms us µs mm m cm um µm km in ft");
    let measure = |rest: &str| labels(&with("    analysis", &format!("    measure v = {rest}$0\n    analysis")));
    insta::assert_snapshot!(measure("der(x(crank.B)) in mm/"), @"s ms us µs deg rad mrad rev");
    insta::assert_snapshot!(measure("der(angle(crank)) in 1/"), @"s ms us µs mm m cm um µm km in ft deg rad mrad rev");
    insta::assert_snapshot!(measure("9.81 m/s^2/"), @"deg rad mrad rev");
    // a quotient of formulas
    assert!(measure("90 deg / ").contains("crank_length"));
    assert!(measure("crank_length/").contains("crank_length"));
}

/// Adds so many bytes of comments that some completions are too slow.
fn long(text: &str, bytes: usize) -> String {
    format!("{text}{}", "// what was tried before\n".repeat(bytes / 25))
}

#[test]
fn long_texts_know_joints_and_units_as_well() {
    let joints = with("    joint pin:   revolute(crank.B, coupler.B)", "    joint pin: $0");
    let best = |text: &str| proposed(text, 1);
    assert_eq!(best(&long(&joints, 30_000)), best(&joints));
    assert_ne!(best(&long(&joints, 70_000)), best(&joints), "beyond the limit");
    let units = with("param crank_length = 30 mm", "param crank_length = 30 $0");
    assert_eq!(best(&long(&units, 30_000)), best(&units));
}

/// Replaces the text of the part in the first of the two files.
fn parts(from: &str, to: &str) -> String {
    assert!(TWO_FILES.contains(from), "{from}");
    TWO_FILES.replacen(from, to, 1)
}

#[test]
fn parts_come_from_their_files() {
    insta::assert_snapshot!(proposed(&parts("levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)", "$0"), 4), @"1 levers.lever → levers.lever(«»)");
    insta::assert_snapshot!(proposed(&parts("levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)", "levers.$0"), 4), @"1 lever → lever(«»)");
    insta::assert_snapshot!(proposed(&parts("levers.lever(turn = 30 deg * t / (1 s), reach = 60 mm)", "levers.lever(reach = 60 mm, $0"), 4), @"1 turn — input turn = 10 deg * sin(1 rev/s * t) → turn = «»");
    insta::assert_snapshot!(proposed(&parts("x(front.arm.tip) + x(side[1].arm.tip)", "x(front.$0"), 9), @r"
    1 arm — body arm
    3 ground — what is fixed in the part
    ");
    insta::assert_snapshot!(proposed(&parts("x(front.arm.tip) + x(side[1].arm.tip)", "x(side[1].arm.$0"), 9), @r"
    1 O — point O   = (0, 0), of arm
    1 tip — point tip = (reach, 0), of arm
    ");
    insta::assert_snapshot!(proposed(&parts("x(front.arm.tip) + x(side[1].arm.tip)", "rotation(front.$0"), 9), @"1 pivot — joint pivot: revolute(ground.O, arm.O)");
    insta::assert_snapshot!(proposed(&parts("on front.arm at", "on front.$0 at"), 9), @r"
    1 arm — body arm
    3 ground — what is fixed in the part
    ");
    insta::assert_snapshot!(proposed(&parts("\"lever.mech\"", "\"$0\""), 9), @"1 lever.mech");
}

#[test]
fn letters_beyond_the_first_plane_are_parts_of_words() {
    let text = with(KNEE, "joint knee: revolute(𝛼𝛽$0γ, rocker.C)\n");
    let (snapshot, position) = at_cursor(&text);
    let items = completions(&snapshot, &position).expect("a file").items;
    let text = text.replacen("$0", "", 1);
    let range = items[0].replaces.clone();
    assert_eq!(&text[range.start as usize..range.end as usize], "𝛼𝛽γ");
}

#[test]
fn every_place_of_every_prefix_has_an_answer() {
    for end in (0..FOUR_BAR.len()).step_by(7) {
        let text = format!("{}$0", &FOUR_BAR[..end]);
        let (snapshot, position) = at_cursor(&text);
        assert!(completions(&snapshot, &position).is_some(), "{text}");
    }
}

#[test]
fn very_many_names_are_filtered_by_the_letters() {
    let params = (0..2_000).map(|k| format!("    param length_{k} = {k} mm\n")).collect::<Vec<_>>().concat();
    let of = |letters: &str| {
        let (snapshot, position) =
            at_cursor(&format!("mechanism many {{\n{params}    measure most = 2 * {letters}$0\n}}"));
        completions(&snapshot, &position).expect("a file")
    };
    let found = of("");
    assert_eq!((found.items.len(), found.is_incomplete), (200, true));
    let found = of("L77");
    assert!(found.is_incomplete, "other letters go with other names");
    let labels: Vec<&str> = found.items.iter().map(|item| item.label.as_str()).collect();
    assert_eq!(labels.len(), labels.iter().filter(|label| label.matches('7').count() >= 2).count(), "{labels:?}");
    assert!(labels.contains(&"length_1797") && found.items[0].docs.contains("param length_"), "{labels:?}");
}
