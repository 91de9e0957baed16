use super::grid::{bound_at_first, going_on, next_point, on_grid};

/// Border of a cell, as in the solver.
const BORDER: f64 = 1.0 / 4096.0;

/// A pseudo-random sequence (`SplitMix64`).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number between −1 and 1.
    fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn choice<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.next() % of.len() as u64) as usize]
    }
}

/// Iterates from `start` on a grid of cells of width 1; returns the end and the number of evaluations. The rounding error of a correction
/// may depend on the whole point, but on nothing else.
fn iterate(solution: &[f64], start: &[f64], error: impl Fn(&[f64], usize) -> f64) -> Option<(Vec<f64>, usize)> {
    let mut x: Vec<f64> = start.iter().map(|x| on_grid(*x, 1.0)).collect();
    let mut bound = bound_at_first(BORDER);
    for evaluation in 1..=8 {
        let delta: Vec<f64> = (0..x.len()).map(|k| (solution[k] - x[k]) + error(&x, k)).collect();
        let largest = delta.iter().fold(0.0, |largest: f64, delta| largest.max(delta.abs()));
        if largest <= bound {
            return Some((x, evaluation));
        }
        let (next, cells) = going_on(largest, bound, BORDER);
        x.iter_mut().zip(&delta).for_each(|(x, delta)| *x = next_point(*x, *delta, 1.0, cells, BORDER));
        bound = next;
    }
    None
}

/// Returns a solution, some of whose coordinates lie near the borders of cells.
fn critical(random: &mut Random) -> Vec<f64> {
    let n = random.choice(&[1, 2, 3]);
    let kind = random.choice(&[0, 1, 2]);
    let coordinate = |_| {
        let inside = 0.25 + 0.24 * random.number();
        let place = match kind {
            0 => random.choice(&[0.5, 0.5, inside]),
            1 => random.choice(&[0.5 - BORDER, 0.5 + BORDER, BORDER - 0.5, inside]),
            _ => 0.5 * random.number(),
        };
        let offset = random.number() * random.choice(&[0.0, 1e-9, 1e-6, BORDER / 8.0]);
        random.choice(&[-5.0, -4.0, -1.0, 0.0, 3.0, 4.0]) + place + offset
    };
    (0..n).map(coordinate).collect()
}

#[test]
fn the_end_does_not_depend_on_the_start() {
    let mut random = Random(2);
    let mut longest = 0;
    for trial in 0..30_000_u64 {
        let solution = critical(&mut random);
        let error = |x: &[f64], k: usize| {
            let point = x.iter().fold(trial, |seed, x| Random(seed ^ x.to_bits()).next());
            BORDER / 8.0 * Random(point.wrapping_add(k as u64)).number()
        };
        let mut ends: Vec<(Vec<f64>, usize)> = Vec::new();
        for _ in 0..10 {
            let start: Vec<f64> = solution.iter().map(|x| x + 3.0 * random.number()).collect();
            let end = iterate(&solution, &start, error);
            ends.push(end.unwrap_or_else(|| panic!("{solution:?} is not found from {start:?}")));
        }
        longest = ends.iter().fold(longest, |longest, (_, evaluations)| longest.max(*evaluations));
        assert!(ends.iter().all(|(end, _)| *end == ends[0].0), "{solution:?}: {ends:?}");
    }
    assert!((3..=5).contains(&longest), "{longest} evaluations");
}

#[test]
fn a_border_is_decided_by_the_even_point() {
    for (solution, end) in [(0.5, 0.0), (1.5, 2.0), (-0.5, 0.0), (-2.5, -2.0)] {
        for start in [solution - 1.6, solution - 0.4, solution + 0.4, solution + 1.6] {
            let (found, _) = iterate(&[solution], &[start], |_, _| 0.0).expect("it settles");
            assert_eq!(found, [end], "{solution} from {start}");
        }
    }
    // beyond the border of the even point the iteration goes to the odd one, whatever the correction there
    let error = |x: &[f64], _: usize| if x[0] == 0.0 { 1e-5 } else { -1e-5 };
    for start in [0.1, 0.9] {
        let (found, _) = iterate(&[0.5], &[start], error).expect("it settles");
        assert_eq!(found, [1.0], "from {start}");
    }
}

#[test]
fn solutions_away_from_borders_take_the_nearest_point_at_once() {
    for k in -49..=49 {
        let solution = [7.0 + 0.01 * f64::from(k), -3.0];
        assert_eq!(iterate(&solution, &[7.0, -3.0], |_, _| 0.0), Some((vec![7.0, -3.0], 1)));
        assert_eq!(iterate(&solution, &[9.0, -3.0], |_, _| 0.0), Some((vec![7.0, -3.0], 2)));
    }
}
