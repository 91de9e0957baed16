//! What forces cost beside position, velocity and acceleration: the same mechanisms with masses and gravity, with and without
//! `--reactions`, in turns.

use crate::mechanisms;
use crate::timing::per_step;
use mechc::{Choice, Compiled, RunOptions, Times};
use std::hint::black_box;

/// Output times of a turn, both ends counted.
const STEPS: u32 = 201;

/// Every body of a text with a mass off its origin, and gravity.
fn heavy(text: &str) -> String {
    let mut heavy = String::new();
    for line in text.lines() {
        match line.strip_suffix('}').filter(|_| line.trim_start().starts_with("body ")) {
            Some(open) => heavy += &format!("{open} mass 2 at (0.3, 0.1) inertia 0.2 }}\n"),
            None => heavy += &format!("{line}\n"),
        }
    }
    heavy.replacen("{\n", "{\n    gravity (0, -9.81)\n", 1)
}

fn compile(text: &str, reactions: bool) -> Compiled {
    mechanisms::compile_as(text, &Choice { reactions, ..Choice::default() })
}

/// ns a row.
fn a_row(compiled: &Compiled) -> f64 {
    let [from, to, _] = compiled.analysis().expect("an analysis");
    let times = Times::grid(from, to, (to - from) / f64::from(STEPS - 1)).expect("a grid");
    let mut motion = compiled.run(&times, &RunOptions::default()).0.expect("it assembles");
    per_step(STEPS, || {
        while let Some(row) = motion.next_row() {
            black_box(row.expect("it moves"));
        }
    })
}

/// ns a row of the motion, and what forces add to it: in turns, of which the middle one counts, as a machine has faster and slower times.
fn in_turns(text: &str, rounds: usize) -> [f64; 2] {
    let [plain, forced] = [false, true].map(|reactions| compile(text, reactions));
    let mut turns: Vec<[f64; 2]> = (0..rounds)
        .map(|_| {
            let motion = a_row(&plain);
            [motion, a_row(&forced) - motion]
        })
        .collect();
    turns.sort_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
    turns[rounds / 2]
}

/// Prints the table.
pub fn forces() {
    println!("forces: all reactions and efforts, beside position, velocity and acceleration");
    println!("  {:<28} {:>12} {:>12} {:>8}", "", "motion", "forces", "ratio");
    let mut per_row = Vec::new();
    for (name, text) in [
        ("four-bar", mechanisms::four_bars(1)),
        ("1,000 bodies: scissor lift", mechanisms::scissor_lift(500)),
        ("10,000 bodies: scissor lift", mechanisms::scissor_lift(5_000)),
        ("999 bodies: four-bars", mechanisms::four_bars(333)),
        ("9,999 bodies: four-bars", mechanisms::four_bars(3_333)),
    ] {
        let rounds = if text.len() > 200_000 { 7 } else { 25 };
        let [motion, forces] = in_turns(&heavy(&text), rounds);
        per_row.push(forces);
        println!("  {name:<28} {motion:>9.0} ns {forces:>9.0} ns {:>6.2} x", forces / motion);
    }
    println!(
        "  ten times the lift takes {:.1} times as long, ten times the four-bars {:.1}\n",
        per_row[2] / per_row[1],
        per_row[4] / per_row[3]
    );
}
