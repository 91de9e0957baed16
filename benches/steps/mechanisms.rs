//! The mechanisms, as text.

pub use crate::copies::four_bars;
use mechc::{Cancel, Choice, Compiled, Memory, Parsed, Redundant};

pub fn compile(text: &str) -> Compiled {
    compile_as(text, &Choice::default())
}

/// The same with what is chosen.
pub fn compile_as(text: &str, choice: &Choice) -> Compiled {
    let checked = Parsed::new("bench.mech", text).check(choice, &Memory::default());
    let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
    assert!(compiled.is_some(), "{:?} {diagnostics:?}", checked.diagnostics());
    compiled.expect("it is determined")
}

/// Those of `tests/cases`, without their measures.
pub const ANDREWS: &str = include_str!("andrews.mech");
pub const JANSEN: &str = include_str!("jansen.mech");

/// Those of one loop or a few, a turn of the crank each.
pub fn singles() -> Vec<(&'static str, String)> {
    vec![
        ("four-bar", four_bars(1)),
        ("slider-crank", slider_crank()),
        ("Andrews", ANDREWS.to_owned()),
        ("Jansen", JANSEN.to_owned()),
    ]
}

fn slider_crank() -> String {
    "mechanism slider_crank {
        ground { point O = (0, 0) axis way = O along (1, 0) }
        body crank at (0, 0, 0.5) { point O = (0, 0) point pin = (1, 0) }
        body rod at (0.88, 0.48, -0.16) { point pin = (0, 0) point wrist = (3, 0) }
        body slider at (3.84, 0, 0) { point wrist = (0, 0) axis way = wrist along (1, 0) }
        joint main: revolute(ground.O, crank.O)
        joint big: revolute(crank.pin, rod.pin)
        joint small: revolute(rod.wrist, slider.wrist)
        joint guide: translational(ground.way, slider.way)
        driver motor: rotation(main) = 0.5 + 2 * t
        analysis from 0 to pi every 0.01
    }"
    .to_owned()
}

/// Pairs of crossed bars, one on the other, spread at the bottom.
pub fn scissor_lift(cells: usize) -> String {
    let (sin, cos) = mechc_expr::math::sin_cos(0.5);
    let mut text = "mechanism scissor_lift {\n    ground { point O = (0, 0) axis floor = O along (1, 0) }\n".to_owned();
    for k in 0..cells {
        let (x, y) = (0.5 * cos, (k as f64 + 0.5) * sin);
        for (bar, turn) in [("a", 0.5), ("b", -0.5)] {
            text += &format!(
                "    body {bar}{k} at ({x}, {y}, {turn}) {{ point L = (-0.5, 0) point M = (0, 0) point R = (0.5, 0) }}\n"
            );
        }
    }
    text += "    joint base: revolute(ground.O, a0.L)\n    joint roll: revolute_translational(b0.R, ground.floor)\n";
    for k in 0..cells {
        text += &format!("    joint m{k}: revolute(a{k}.M, b{k}.M)\n");
    }
    for k in 1..cells {
        text += &format!(
            "    joint l{k}: revolute(b{}.L, a{k}.L)\n    joint r{k}: revolute(a{}.R, b{k}.R)\n",
            k - 1,
            k - 1
        );
    }
    text + &format!("    driver lift: x(b0.R) = {cos} + 0.1 * sin(t)\n    analysis from 0 to 2 * pi every 0.01\n}}\n")
}
