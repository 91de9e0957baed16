//! The time loop allocates nothing.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use mechc::{RunOptions, Times};
use std::fs;
use support::compiled;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

#[test]
fn following_a_motion_allocates_nothing() {
    for name in ["four_bar", "andrews", "jansen", "digger", "derivatives", "three_rpr"] {
        let text = fs::read_to_string(format!("tests/cases/{name}.mech")).expect("a text");
        follow(name, &text);
    }
}

#[test]
fn contacts_tables_and_edges_allocate_nothing() {
    for name in ["cam_point_follower", "gear_pair", "cam_roller", "flat_swing", "table_list", "edges_pulse"] {
        let text = fs::read_to_string(format!("tests/cases/{name}.mech")).expect("a text");
        follow(name, &text);
    }
}

#[test]
fn passing_near_a_dead_point_allocates_nothing() {
    follow(
        "slider_crank",
        "mechanism slider_crank {
            ground { point O = (0, 0) axis way = O along (1, 0) }
            body crank at (0, 0, 0.3) { point O = (0, 0) point pin = (1, 0) }
            body rod at (0.95, 0.3, -0.3) { point pin = (0, 0) point wrist = (1.0001, 0) }
            body slider at (1.9, 0, 0) { point wrist = (0, 0) axis way = wrist along (1, 0) }
            joint main: revolute(ground.O, crank.O)
            joint big: revolute(crank.pin, rod.pin)
            joint small: revolute(rod.wrist, slider.wrist)
            joint guide: translational(ground.way, slider.way)
            driver motor: rotation(main) = t + 0.3
            analysis from 0 to 3 every 0.01
        }",
    );
}

#[test]
fn derivatives_by_inputs_and_parameters_allocate_nothing() {
    let text = fs::read_to_string("tests/cases/sensitivities.mech").expect("a text");
    follow("sensitivities", &text);
    follow(
        "near",
        "mechanism slider_crank {
            param long = 1.0001
            input turn = t + 0.3
            ground { point O = (0, 0) axis way = O along (1, 0) }
            body crank at (0, 0, 0.3) { point O = (0, 0) point pin = (1, 0) }
            body rod at (0.95, 0.3, -0.3) { point pin = (0, 0) point wrist = (long, 0) }
            body slider at (1.9, 0, 0) { point wrist = (0, 0) axis way = wrist along (1, 0) }
            joint main: revolute(ground.O, crank.O)
            joint big: revolute(crank.pin, rod.pin)
            joint small: revolute(rod.wrist, slider.wrist)
            joint guide: translational(ground.way, slider.way)
            driver motor: rotation(main) = turn
            measure both = der(der(x(slider.wrist), long), turn)
            analysis from 0 to 3 every 0.01
        }",
    );
}

fn follow(name: &str, text: &str) {
    let compiled = compiled(name, text);
    let [from, to, every] = compiled.analysis().expect("an analysis");
    // coarser steps are cut by the solver, so that rejected ones take part too
    for times in [Times::grid(from, to, every), Times::grid(from, to, 20.0 * every)] {
        let (run, _) = compiled.run(&times.expect("a grid"), &RunOptions::default());
        let mut run = run.expect("it assembles");
        let mut sum = 0.0;
        assert_no_alloc(|| {
            while let Some(row) = run.next_row() {
                match row {
                    Ok(row) => sum += row[1],
                    Err(_) => sum = f64::NAN,
                }
            }
        });
        assert!(sum.is_finite(), "{name}");
    }
}
