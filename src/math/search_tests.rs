//! Bisection, golden section and halving: tests. Those of what is emitted stand apart from it.

use super::neighbours::{bisect, shortly_after};
use super::search::{GoldenSection, Halving, boundary};
use std::convert::Infallible;

#[test]
fn neighbours_are_found() {
    let [low, high] = bisect([0.0, 2.0], usize::MAX, |x| x * x < 2.0);
    assert_eq!(low.next_up().to_bits(), high.to_bits());
    assert!(low * low < 2.0 && high * high >= 2.0);
    assert!((boundary(0.0, 2.0, |x| x * x >= 2.0) - high).abs() <= high - low);
    assert_eq!(bisect([0.0, 1.0], 2, |_| true).to_vec(), [0.75, 1.0]);
    let [near, far] = bisect([2.0, 0.0], usize::MAX, |x| x * x > 2.0);
    assert_eq!([near, far].to_vec(), [high, low], "from the other side");
    assert_eq!(bisect([0.0, f64::MAX], 3, |_| false).to_vec(), [0.0, f64::MAX / 8.0]);
    assert_eq!(
        bisect([f64::MAX, 0.9 * f64::MAX], 3, |_| true)[0].to_bits(),
        f64::MAX.to_bits(),
        "a middle beyond all numbers"
    );
}

#[test]
fn shortly_after_is_later() {
    for t in [-3.0, 0.0, 1e-300, 2.0, 1e9] {
        assert!(
            shortly_after(t, 4.0) > t && shortly_after(t, 4.0) - t <= 1e-15 * f64::abs(t) + f64::MIN_POSITIVE,
            "{t}"
        );
    }
}

#[test]
fn a_section_keeps_the_least_value() {
    let mut value = |x: f64| Ok::<f64, Infallible>((x - 0.3) * (x - 0.3));
    let Ok(mut section) = GoldenSection::new([0.0, 0.09], [1.0, 0.49], &mut value);
    for _ in 0..40 {
        let Ok(()) = section.narrow(value);
        assert!(section.low[0] <= 0.3 && section.high[0] >= 0.3);
    }
    assert!((section.middle() - 0.3).abs() < 1e-7 && section.least() < 1e-14);
}

#[test]
fn parts_come_in_their_order_and_no_finer_than_is_meant() {
    let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 100);
    let mut seen = Vec::new();
    while let Some(part) = parts.next_part() {
        if !parts.halve(part) {
            seen.push(part);
        }
    }
    let eighths: Vec<[f64; 2]> = (0..8).map(|k| [f64::from(k) / 8.0, f64::from(k + 1) / 8.0]).collect();
    assert_eq!(seen, eighths);
    let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 1);
    assert!(parts.next_part().is_some());
    assert!(!parts.halve([0.0, 1.0]) && parts.next_part().is_none(), "no more are looked at than are meant");
}
