//! The order of solution: each line needs only what it and the lines before it solve for.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use mechc_ir::structure::{Determined, order_of_solution, steps};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::sync::Arc;

fn determined(text: &str) -> Arc<Determined> {
    support::compiled("random.mech", text).inside().0
}

/// The coordinates that a line of the printed order names: all of a body, or single ones.
fn named(determined: &Determined, line: &str) -> Vec<usize> {
    let system = determined.system();
    let (head, _) = line.split_once(" from ").expect("a line says from what");
    let head = head.trim().trim_end_matches(" together,").trim_end();
    let of = |name: &str| {
        let found = system.coordinates().iter().enumerate();
        let found = found.filter(|(k, coordinate)| coordinate.name == name || system.owner_name(*k) == name);
        found.map(|(k, _)| k).collect::<Vec<usize>>()
    };
    head.split(", ").flat_map(|name| of(name.trim())).collect()
}

/// Holds the steps to `Φ_q`, and the printed lines to the steps.
fn holds(determined: &Determined) -> Result<(), TestCaseError> {
    let system = determined.system();
    let steps = steps(determined);
    let mut known = vec![false; system.coordinates().len()];
    let mut used = vec![false; system.rows().len()];
    for step in &steps {
        prop_assert_eq!(step.rows.len(), step.columns.len());
        for &column in &step.columns {
            prop_assert!(!std::mem::replace(&mut known[column as usize], true), "solved for twice");
        }
        for &row in &step.rows {
            prop_assert!(!std::mem::replace(&mut used[row as usize], true), "used twice");
            for &(column, _) in system.phi_q().row(row as usize) {
                let name = &system.coordinates()[column as usize].name;
                prop_assert!(known[column as usize], "{name} is needed too early\n{}", order_of_solution(determined));
            }
        }
    }
    prop_assert!(known.iter().chain(&used).all(|seen| *seen), "something is never solved for");
    let text = order_of_solution(determined);
    for (line, step) in text.lines().zip(&steps).filter(|(line, _)| !line.contains('…')) {
        let mut columns = named(determined, line);
        columns.sort_unstable();
        let wanted: Vec<usize> = step.columns.iter().map(|&column| column as usize).collect();
        prop_assert_eq!(columns, wanted, "{}", line);
    }
    Ok(())
}

/// Bodies whose coordinates each follow from others, in an order that is not that of their declarations.
fn chains() -> impl Strategy<Value = String> {
    (1_usize..14).prop_flat_map(|bodies| {
        let order = Just((0..3 * bodies).collect::<Vec<usize>>()).prop_shuffle();
        let needs = prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 0..3), 3 * bodies);
        // equations of one coordinate may also be tied to a later one: what goes in a circle is solved for together
        let circles = prop::collection::vec(prop::bool::weighted(0.1), 3 * bodies);
        let written = Just((0..3 * bodies).collect::<Vec<usize>>()).prop_shuffle();
        (order, needs, circles, written).prop_map(move |(order, needs, circles, written)| {
            let quantity = |k: usize| match k % 3 {
                0 => format!("x(b{}.P) / 1 m", k / 3),
                1 => format!("y(b{}.P) / 1 m", k / 3),
                _ => format!("angle(b{}) / 1 rad", k / 3),
            };
            let mut text = "mechanism m {\n    ground { point O = (0, 0) }\n".to_owned();
            for body in 0..bodies {
                text += &format!("    body b{body} {{ point P = (0, 0) }}\n");
            }
            for k in written {
                let mut right = "0.1".to_owned();
                // together less than 1, so that nothing cancels
                for (need, part) in needs[k].iter().zip([0.13, 0.07]) {
                    let before = if circles[k] { order.len() } else { k };
                    if before > 0 {
                        let other = order[need.index(before)];
                        right += &format!(" + {part} * {}", quantity(other));
                    }
                }
                let own = quantity(order[k]);
                text += &format!("    constraint c{k}: {own} = {right}\n");
            }
            text + "}\n"
        })
    })
}

proptest! {
    #![proptest_config(Config { cases: 200, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default() })]

    #[test]
    fn lines_depend_only_on_earlier_lines(text in chains()) {
        holds(&determined(&text))?;
    }
}

#[test]
fn every_case_has_an_order_that_holds() {
    for path in support::files("tests/cases", "mech").into_iter().chain(support::files("examples", "mech")) {
        let text = std::fs::read_to_string(&path).expect("a text");
        for number in 0..support::mechanisms(&text).len() {
            if let (Some(compiled), _) = support::compile_number(&path, &text, number) {
                holds(&compiled.inside().0).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
            }
        }
    }
}

/// The order of a mechanism, a line each, without the spaces between.
fn order(text: &str) -> Vec<String> {
    let text = order_of_solution(&determined(text));
    text.lines().map(|line| line.split_whitespace().collect::<Vec<&str>>().join(" ")).collect()
}

#[test]
fn dependents_follow_their_bodies() {
    let text = "mechanism m { ground { point A = (0, 0) } body late at (0, 0, 30 deg) { point A = (0, 0) }
        body early at (200 mm, 0, 0) { point C = (0, 0) } joint d1: revolute(ground.A, late.A)
        constraint k: angle(late) = 2 * angle(early) driver dx: x(early.C) = 200 mm + 10 mm/s * t
        driver dy: y(early.C) = 0 mm driver da: angle(early) = 15 deg + 10 deg/s * t }";
    assert_eq!(order(text), ["early from dx, dy, da", "late from d1, k"]);
}

#[test]
fn bodies_that_wait_for_each_other_come_in_parts() {
    let text = "mechanism m { ground { point O = (0, 0) } body a { point P = (0, 0) } body b { point P = (0, 0) }
        driver ax: x(a.P) = 1 mm/s * t constraint bx: x(b.P) = x(a.P) constraint ay: y(a.P) = x(b.P)
        constraint by: y(b.P) = y(a.P) constraint aa: angle(a) = x(b.P) / 1 m constraint ba: angle(b) = angle(a) }";
    assert_eq!(order(text), ["a.x from ax", "b.x from bx", "a.y, a.phi from ay, aa", "b.y, b.phi from by, ba"]);
}
