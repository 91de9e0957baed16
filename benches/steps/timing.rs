//! Clocks and columns.

use std::time::Instant;

/// Nanoseconds that each of some steps takes, all of them being done at once.
pub fn per_step(steps: u32, work: impl FnOnce()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64() * 1e9 / f64::from(steps)
}

/// The median of some measurements, after one that is not counted.
pub fn median(rounds: usize, mut measure: impl FnMut() -> f64) -> f64 {
    measure();
    let mut all: Vec<f64> = (0..rounds).map(|_| measure()).collect();
    all.sort_by(f64::total_cmp);
    all[rounds / 2]
}

/// The least of several measurements, of what takes as long each time but for what others do meanwhile.
pub fn least(rounds: usize, mut measure: impl FnMut() -> f64) -> f64 {
    (0..rounds).map(|_| measure()).fold(f64::INFINITY, f64::min)
}

/// A table of ways, each in ns and as a multiple of the closed form.
pub struct Table {
    floor: f64,
}

impl Table {
    pub fn new(title: &str, floor: f64) -> Table {
        println!("{title}");
        println!("  {:<16} {:>20} {:>20} {:>20}", "", "mechc", "dense LU (nalgebra)", "sparse LU (faer)");
        Table { floor }
    }

    /// A row; `units` is what a step is divided by.
    pub fn row(&mut self, name: &str, units: f64, ways: &[Option<f64>; 3]) {
        let cell = |way: &Option<f64>| match way {
            Some(time) => format!("{:.0} ns {:>7.2} x", time / units, time / units / self.floor),
            None => "-".to_owned(),
        };
        println!("  {name:<16} {:>20} {:>20} {:>20}", cell(&ways[0]), cell(&ways[1]), cell(&ways[2]));
    }
}

impl Drop for Table {
    fn drop(&mut self) {
        println!();
    }
}
