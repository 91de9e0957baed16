//! Tests of bisection, secants, golden section and halving. They stand apart from code that may be emitted.

use super::neighbours::{bisect, shortly_after};
use super::search::{GoldenSection, Halving, boundary, enclose_root};
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
fn secants_close_in_on_neighbours() {
    type Root = (fn(f64) -> f64, [f64; 2], u32);
    let cubic = |x: f64| (x - 0.7) * (x - 0.7) * (x - 0.7);
    let roots: [Root; 6] = [
        (|x| x - 0.3, [0.0, 1.0], 6),
        (|x| x * x - 2.0, [0.0, 2.0], 14),
        (cubic, [0.0, 1.0], 130),
        (|x| if x < 0.123 { -1.0 } else { 1e-9 }, [0.0, 1.0], 160),
        (|x| if x < 0.123 { f64::NAN } else { x }, [0.0, 1.0], 60),
        (super::tan, [1.0, 4.0], 14),
    ];
    for (k, (f, ends, most)) in roots.into_iter().enumerate() {
        let mut looks = 0;
        let is_behind = |x: f64| {
            if k == 4 {
                x >= 0.123
            } else if k == 5 {
                x >= std::f64::consts::PI
            } else {
                f(x) >= 0.0
            }
        };
        let ends = ends.map(|x| [x, f(x).abs()]);
        let found = enclose_root(ends, 0.0, |x| {
            looks += 1;
            Some((is_behind(x), f(x).abs()))
        });
        let [low, high] = found.unwrap_or_default();
        assert!(!is_behind(low) && is_behind(high) && low.next_up() >= high, "{k}: {low} {high}");
        assert!(looks <= most, "{k}: {looks}");
    }
    for ends in [[0.0, 1.0], [0.3, 7.0], [-0.1, 0.6]] {
        let ends = ends.map(|x| [x, f64::abs(x - 0.51)]);
        let coarse = enclose_root(ends, 0.25, |x| Some((x >= 0.51, (x - 0.51).abs()))).unwrap_or_default();
        assert_eq!(coarse.to_vec(), [0.5, f64::min(0.75, ends[1][0])], "{ends:?}");
    }
    assert!(enclose_root([[0.0, 1.0], [1.0, 1.0]], 0.0, |_| None).is_none());
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
fn sections_come_in_order_and_no_finer_than_requested() {
    let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 100);
    let mut visited = Vec::new();
    while let Some(part) = parts.next_part() {
        if !parts.halve(part) {
            visited.push(part);
        }
    }
    let eighths: Vec<[f64; 2]> = (0..8).map(|k| [f64::from(k) / 8.0, f64::from(k + 1) / 8.0]).collect();
    assert_eq!(visited, eighths);
    let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 1);
    assert!(parts.next_part().is_some());
    assert!(!parts.halve([0.0, 1.0]) && parts.next_part().is_none(), "the number of visits is limited");
}
