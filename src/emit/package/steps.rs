// $mark

//! What a step costs: `cargo bench`.

#![allow(clippy::approx_constant, clippy::excessive_precision)]

use $library::{Error, Params, START_TIME, assemble, step};

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Steps of the analysis, the length of each and the time of the last (s).
const STEPS: u32 = $steps;
const EVERY: f64 = $every;
const LAST: f64 = $last;

fn main() -> Result<(), Error> {
    // `cargo test --benches` asks only whether it runs
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    let budget = Duration::from_secs(if is_measured { 1 } else { 0 });
    let start = assemble(&$params)?;
    let (mut fastest, mut rounds) = (f64::INFINITY, 0);
    let began = Instant::now();
    while rounds == 0 || began.elapsed() < budget {
        let mut state = start.clone();
        let round = Instant::now();
        for k in 1..=STEPS {
            let t = f64::min(START_TIME + f64::from(k) * EVERY, LAST);
            step(t, black_box(&mut state))?;
        }
        black_box(&state);
        let seconds = round.elapsed().as_secs_f64();
        fastest = fastest.min(1e9 * seconds / f64::from(STEPS));
        rounds += 1;
    }
    println!("{fastest:.1} ns per step, in the fastest of {rounds} rounds of {STEPS} steps");
    Ok(())
}
