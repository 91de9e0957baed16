//! The time loop allocates nothing.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use mechc::analysis::{self, Times};
use mechc::program::Program;
use mechc::source::Sources;
use std::fs;
use support::compile;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

#[test]
fn following_a_motion_allocates_nothing() {
    for name in ["four_bar", "andrews", "jansen", "digger", "derivatives", "three_rpr"] {
        let mut sources = Sources::default();
        let text = fs::read_to_string(format!("tests/cases/{name}.mech")).expect("a text");
        let (determined, _) = compile(&mut sources, name, &text);
        let determined = determined.expect("determined");
        let [from, to, every] = determined.system().analysis.expect("an analysis");
        // coarser steps are cut by the solver, so that rejected ones take part too
        for times in [Times::grid(from, to, every), Times::grid(from, to, 20.0 * every)] {
            let times = times.expect("a grid");
            let program = Program::new(determined.system());
            let mut started = analysis::start(&determined, &program, from, analysis::TOLERANCE).expect("it assembles");
            let mut motion = started.motion(times.span());
            let mut sum = 0.0;
            assert_no_alloc(|| {
                for t in times.iter() {
                    match motion.row_at(t) {
                        Ok(row) => sum += row[1],
                        Err(_) => sum = f64::NAN,
                    }
                }
            });
            assert!(sum.is_finite(), "{name}");
        }
    }
}
