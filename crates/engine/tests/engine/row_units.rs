//! Units of the rows of `Φ` against the dimensions of their formulas, which are derived independently.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{compile_number, compiled, files, mechanisms};
use mechc_expr::{Binary, ExprId, Node, Symbol, Unary};
use mechc_ir::{ConstraintSystem, CoordinateKind};
use mechc_text::vocabulary::Dimension;
use std::collections::HashMap;
use std::fs;

/// None where it may be any: a number may stand for a length, and so may a parameter that was given without a unit.
type Known = Option<Dimension>;

/// The dimension of a formula, as far as its coordinates, and the parameters that have units, tell it. A factor of 1 m leaves no trace in a
/// formula; none of the mechanisms here has one that would be missed.
fn dimension_of(system: &ConstraintSystem, formula: ExprId) -> Known {
    let mut known: HashMap<ExprId, Known> = HashMap::new();
    // children come before their parents
    for id in system.graph().reachable(&[formula]) {
        let found = dimension_of_node(system, system.graph().node(id), &|child| known[&child]);
        known.insert(id, found);
    }
    known[&formula]
}

fn dimension_of_node(system: &ConstraintSystem, node: Node, of: &dyn Fn(ExprId) -> Known) -> Known {
    match node {
        Node::Symbol(symbol) => dimension_of_symbol(system, symbol),
        Node::Neg(a) | Node::Unary(Unary::Abs, a) | Node::Binary(Binary::Mod, a, _) => of(a),
        Node::Add(a, b)
        | Node::Sub(a, b)
        | Node::Binary(Binary::Hypot | Binary::Min | Binary::Max, a, b)
        | Node::Select(_, a, b) => alike(of(a), of(b)),
        Node::Mul(a, b) => Some(of(a)?.times(of(b)?)),
        Node::Div(a, b) => Some(of(a)?.over(of(b)?)),
        Node::Power(a, n) => Some(of(a)?.to_the(f64::from(n))),
        Node::Unary(Unary::Sqrt, a) => Some(of(a)?.to_the(0.5)),
        Node::Binary(Binary::Pow, a, b) => Some(of(a)?.to_the(system.graph().as_const(b)?)),
        Node::Const(_) | Node::Table(..) | Node::Unary(Unary::Floor, _) => None,
        // angles, comparisons and what is made of these
        _ => Some(Dimension::PURE),
    }
}

fn dimension_of_symbol(system: &ConstraintSystem, symbol: Symbol) -> Known {
    match symbol {
        Symbol::Coordinate { index, .. } => match system.coordinates()[index as usize].kind {
            CoordinateKind::Length => Some(Dimension::LENGTH),
            CoordinateKind::Angle | CoordinateKind::Argument => Some(Dimension::PURE),
        },
        Symbol::Time => Some(Dimension::TIME),
        Symbol::Param(k) => Some(system.params()[k as usize].dimension).filter(|own| !own.is(Dimension::PURE)),
        _ => None,
    }
}

/// Returns the dimension of a sum, from any term whose dimension is known; `None` if two differ.
fn alike(a: Known, b: Known) -> Known {
    match (a, b) {
        (Some(a), Some(b)) => a.is(b).then_some(a),
        (one, other) => one.or(other),
    }
}

/// Checks each row whose formula has a known dimension; returns the number of rows, and of checked rows.
fn compared(name: &str, system: &ConstraintSystem) -> [usize; 2] {
    let reported =
        system.rows().iter().enumerate().filter_map(|(k, row)| Some((k, row, dimension_of(system, row.phi)?)));
    let reported = reported.map(|(k, row, dimension)| {
        let (of, found) = (system.row_name(k), dimension.unit());
        assert!(dimension.is(row.unit), "{name}: `{of}` says {}, and is in {found}", row.unit.display_unit());
    });
    [system.rows().len(), reported.count()]
}

#[test]
fn row_units_match_their_formulas() {
    let folders = ["examples", "tests/cases", "tests/cases_composed", "tests/stages", "tests/following"];
    let (mut rows, mut reported) = (0, 0);
    for path in folders.map(|folder| files(folder, "mech")).concat() {
        let text = fs::read_to_string(&path).expect("a text");
        for number in 0..mechanisms(&text).len() {
            let (Some(compiled), _) = compile_number(&path, &text, number) else { continue };
            let [all, compared] = compared(&path.display().to_string(), compiled.inside().0.system());
            (rows, reported) = (rows + all, reported + compared);
        }
    }
    assert!(rows > 1000 && 10 * reported > 9 * rows, "{reported} of {rows}");
}

/// The units of all rows of a mechanism with these declarations.
fn units(declarations: &str) -> Vec<String> {
    let text = format!(
        "mechanism machine {{
            ground {{ point O = (0, 0)  point A = (1, 0)  axis line = O along (1, 0)  circle rim = O radius 0.3 }}
            body one {{ point O = (0, 0)  point P = (0.4, 0)  axis line = O along (1, 0)  circle rim = O radius 0.2 }}
            body two at (0.4, 0, 1.5) {{ point O = (0, 0)  point P = (0.2, 0)  axis line = O along (0, 1)  circle rim = O radius 0.3 }}
            {declarations}
        }}"
    );
    let compiled = compiled("machine", &text);
    compiled.inside().0.system().rows().iter().map(|row| row.unit.display_unit()).collect()
}

#[test]
fn rows_have_the_units_of_the_textbook() {
    let slide = "joint slide: translational(ground.line, one.line)  joint fixed: weld(one.O, two.O, 0)";
    let units = units(&format!("{slide}  driver push: displacement(slide) = 0.1 * t"));
    assert_eq!(units, ["m", "1", "m", "m", "rad", "m"]);
}

#[test]
fn gears_and_distances_have_theirs() {
    let pins = "joint first: revolute(ground.O, one.O)  joint second: revolute(ground.A, two.O)";
    let gears = units(&format!("{pins}  joint mesh: gear(one.rim, two.rim)  driver motor: rotation(first) = t"));
    assert_eq!(gears, ["m", "m", "m", "m", "m", "m", "rad"]);
}

#[test]
fn equations_of_plain_numbers_have_the_units_of_their_quantities() {
    let pins = "joint pin: revolute(ground.O, one.O)  joint other: revolute(one.P, two.O)";
    let of = |left: &str, right: &str| {
        let driver = format!("driver motor: rotation(pin) = t  constraint held: {left} = {right}");
        let mut units = units(&format!("{pins}  {driver}"));
        units.remove(4)
    };
    // constraints come before drivers
    assert_eq!(of("angle(two)", "0.3"), "rad");
    assert_eq!(of("0.3 + angle(one)", "angle(two)"), "rad");
    assert_eq!(of("2 * distance(ground.A, two.P)", "1.26"), "m");
    assert_eq!(of("0.2", "x(two.P)^2 + y(two.P)^2"), "m^2");
    assert_eq!(of("distance(ground.A, two.P)", "0.63"), "m^2");
}
