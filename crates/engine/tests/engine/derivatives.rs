//! Derivatives against differences: of every function, of every element's Φ, and of whole motions.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::random::Random;
use crate::support::{Span, compile, files, run, stem, text_of};
use mechc_expr::math;
use mechc_expr::{Binary, ExprId, Graph, MotionLaw, Symbol, Unary};
use mechc_ir::ConstraintSystem;
use std::fs;

const X: Symbol = Symbol::Coordinate { index: 0, order: 0 };
const Y: Symbol = Symbol::Coordinate { index: 1, order: 0 };

fn value(graph: &Graph, id: ExprId, x: f64, y: f64) -> f64 {
    graph.value(id, |symbol| if symbol == X { x } else { y })
}

/// Both partial derivatives, forward and backward, and the second ones, against central differences.
fn check_function(name: &str, range: [f64; 2], build: impl Fn(&mut Graph, ExprId, ExprId) -> ExprId) {
    let mut graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    // inside other functions, so that the chain rule takes part
    let (half, third) = (graph.constant(0.5), graph.constant(0.3));
    let (a, b) = (graph.mul(half, y), graph.mul(third, x));
    let (u, v) = (graph.add(x, a), graph.add(y, b));
    let f = build(&mut graph, u, v);
    let along = |graph: &mut Graph, id: ExprId, wanted: Symbol| {
        graph.derivatives(&[id], |graph, symbol| (symbol == wanted).then(|| graph.constant(1.0)))[0]
    };
    let (fx, fy) = (along(&mut graph, f, X), along(&mut graph, f, Y));
    let (fxx, fxy) = (along(&mut graph, fx, X), along(&mut graph, fx, Y));
    let gradient = graph.gradient(f, mechc_expr::Dependence::coordinates(0));
    let mut random = Random::new(7);
    for _ in 0..200 {
        let (x, y) = (random.between(range[0], range[1]), random.between(range[0], range[1]));
        let h = 1e-5;
        let near = |derivative: ExprId, of: ExprId, dx: f64, dy: f64, what: &str| {
            let exact = value(&graph, derivative, x, y);
            let difference =
                (value(&graph, of, x + h * dx, y + h * dy) - value(&graph, of, x - h * dx, y - h * dy)) / (2.0 * h);
            let error = (exact - difference).abs();
            assert!(error < 2e-6 * (1.0 + exact.abs()), "{name} {what} at ({x}, {y}): {exact} and {difference}");
        };
        near(fx, f, 1.0, 0.0, "by x");
        near(fy, f, 0.0, 1.0, "by y");
        near(fxx, fx, 1.0, 0.0, "by x twice");
        near(fxy, fx, 0.0, 1.0, "by x and y");
        for (symbol, backward) in &gradient {
            let forward = if *symbol == X { fx } else { fy };
            let (a, b) = (value(&graph, *backward, x, y), value(&graph, forward, x, y));
            assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()), "{name}: backward {a}, forward {b}");
        }
    }
}

#[test]
fn functions_of_one_argument() {
    let everywhere = [-1.9, 1.9];
    let ranges = [
        (Unary::Sin, everywhere),
        (Unary::Cos, everywhere),
        (Unary::Tan, [-0.6, 0.6]),
        (Unary::Asin, [-0.6, 0.6]),
        (Unary::Acos, [-0.6, 0.6]),
        (Unary::Atan, everywhere),
        (Unary::Sinh, everywhere),
        (Unary::Cosh, everywhere),
        (Unary::Tanh, everywhere),
        (Unary::Exp, everywhere),
        (Unary::Ln, [0.3, 3.0]),
        (Unary::Log10, [0.3, 3.0]),
        (Unary::Sqrt, [0.3, 3.0]),
        (Unary::Abs, [0.3, 3.0]),
        (Unary::Abs, [-3.0, -0.3]),
        (Unary::Sign, [0.3, 3.0]),
        (Unary::Floor, [0.05, 0.6]),
    ];
    for (function, range) in ranges {
        check_function(&format!("{function:?}"), range, |graph, u, _| graph.unary(function, u));
    }
}

#[test]
fn functions_of_two_arguments_and_operators() {
    let positive = [0.4, 2.5];
    check_function("atan2", positive, |g, u, v| g.binary(Binary::Atan2, u, v));
    check_function("hypot", positive, |g, u, v| g.binary(Binary::Hypot, u, v));
    check_function("pow", positive, Graph::pow);
    check_function("min", [1.0, 1.2], |g, u, v| {
        let double = g.add(v, v);
        g.binary(Binary::Min, u, double)
    });
    check_function("max", [1.0, 1.2], |g, u, v| {
        let double = g.add(v, v);
        g.binary(Binary::Max, u, double)
    });
    check_function("mod", [0.1, 0.6], |g, u, v| {
        let two = g.constant(2.0);
        let far = g.add(v, two);
        g.modulo(u, far)
    });
    for n in [-3, -2, -1, 2, 3, 5, 7] {
        check_function(&format!("to the {n}"), positive, |g, u, _| g.power(u, n));
    }
    check_function("operators", positive, |g, u, v| {
        let (sum, difference, product) = (g.add(u, v), g.sub(u, v), g.mul(u, v));
        let quotient = g.div(sum, product);
        let turned = g.neg(difference);
        g.mul(quotient, turned)
    });
}

#[test]
fn tables() {
    let rows = [[-2.0, 0.3], [-0.7, 1.1], [0.1, -0.4], [0.9, 0.2], [2.5, 0.8], [4.0, 0.3]];
    for periodic in [false, true] {
        // away from the knots, and for the one that repeats a period on
        for range in [[-0.6, -0.5], [0.25, 0.4], [1.05, 1.2], [if periodic { 3.1 } else { 1.3 }, 3.2]] {
            check_function(&format!("spline, periodic: {periodic}, on {range:?}"), range, |g, u, _| {
                let points = rows.map(|row| row.map(|c| g.constant(c)));
                let table = g.spline("s", periodic, &points);
                g.table(table, 0, u)
            });
        }
    }
}

#[test]
fn tables_are_interpolated_smoothly() {
    let mut g = Graph::new();
    let x = g.symbol(X);
    for periodic in [false, true] {
        // a cosine, sampled; the natural spline bends nowhere at its ends
        let rows: Vec<[f64; 2]> = (0..=24)
            .map(|k| f64::from(k) * std::f64::consts::TAU / 24.0)
            .map(|u| [u, mechc_expr::math::sin(u)])
            .collect();
        let last = rows.len() - 1;
        let points: Vec<[ExprId; 2]> = rows
            .iter()
            .enumerate()
            .map(|(k, row)| [g.constant(row[0]), g.constant(if k == last { 0.0 } else { row[1] })])
            .collect();
        let table = g.spline("sine", periodic, &points);
        let orders = [0, 1, 2].map(|order| g.table(table, order, x));
        for row in &rows[1..last] {
            assert!((value(&g, orders[0], row[0], 0.0) - row[1]).abs() < 1e-15, "at a knot");
            for order in orders {
                let (before, after) = (value(&g, order, row[0].next_down(), 0.0), value(&g, order, row[0], 0.0));
                assert!((before - after).abs() < 1e-13, "smooth at {}", row[0]);
            }
        }
        for (k, order) in orders.into_iter().enumerate() {
            let exact = [mechc_expr::math::sin(1.0), mechc_expr::math::cos(1.0), -mechc_expr::math::sin(1.0)][k];
            assert!((value(&g, order, 1.0, 0.0) - exact).abs() < [2e-5, 2e-4, 1e-2][k], "derivative {k}");
        }
        for u in [0.0, rows[last][0]] {
            assert!(value(&g, orders[2], u, 0.0).abs() < 1e-12, "no curvature at the ends");
        }
        if periodic {
            for turns in [-3.0, 1.0, 100.0] {
                let far = value(&g, orders[1], 1.0 + turns * std::f64::consts::TAU, 0.0);
                assert!((far - value(&g, orders[1], 1.0, 0.0)).abs() < 1e-12, "{turns} turns on");
            }
        }
    }
}

#[test]
fn inactive_branches_have_no_effect() {
    // left of zero the root and the logarithm of the other branch have no value
    for range in [[0.4, 2.5], [-2.5, -0.4]] {
        check_function(&format!("if on {range:?}"), range, |g, u, v| {
            let zero = g.constant(0.0);
            let positive = g.compare(mechc_expr::Comparison::Less, zero, u);
            let (root, logarithm) = (g.unary(Unary::Sqrt, u), g.unary(Unary::Ln, u));
            let (there, here) = (g.mul(root, logarithm), g.mul(u, v));
            let choice = g.select(positive, there, here);
            g.mul(choice, v)
        });
        check_function(&format!("max of a root on {range:?}"), range, |g, u, _| {
            let zero = g.constant(0.0);
            let positive = g.binary(Binary::Max, u, zero);
            let root = g.unary(Unary::Sqrt, positive);
            let ten = g.constant(10.0);
            let sum = g.add(u, ten);
            g.binary(Binary::Max, sum, root)
        });
    }
}

#[test]
fn motion_functions() {
    let motions = [
        MotionLaw::Step,
        MotionLaw::Step5,
        MotionLaw::Step7,
        MotionLaw::Harmonic,
        MotionLaw::Cycloidal,
        MotionLaw::ModifiedSine,
    ];
    for motion in motions {
        // the ranges keep clear of the edges of the pieces
        for range in [[-2.0, -1.0], [0.01, 0.13], [0.3, 1.0], [1.86, 1.95], [3.0, 4.0]] {
            check_function(&format!("{motion:?} on {range:?}"), range, |g, u, _| {
                let [u0, v0, u1, v1] = [0.0, 0.3, 3.0, 1.1].map(|c| g.constant(c));
                g.motion(motion, u, [u0, v0], [u1, v1])
            });
        }
    }
}

#[test]
fn motion_functions_reach_their_ends_smoothly() {
    // how many derivatives vanish at both ends
    let smooth = [
        (MotionLaw::Step, 1),
        (MotionLaw::Step5, 2),
        (MotionLaw::Step7, 3),
        (MotionLaw::Harmonic, 1),
        (MotionLaw::Cycloidal, 2),
        (MotionLaw::ModifiedSine, 2),
    ];
    for (motion, orders) in smooth {
        let mut g = Graph::new();
        let u = g.symbol(X);
        let [u0, v0, u1, v1] = [1.0, -2.0, 3.0, 5.0].map(|c| g.constant(c));
        let mut f = g.motion(motion, u, [u0, v0], [u1, v1]);
        for (u, v) in [(0.0, -2.0), (1.0, -2.0), (3.0, 5.0), (9.0, 5.0)] {
            assert!((value(&g, f, u, 0.0) - v).abs() < 1e-14, "{motion:?} at {u}");
        }
        for order in 1..=orders {
            f = g.derivatives(&[f], |g, _| Some(g.constant(1.0)))[0];
            for u in [1.0, 3.0 - 1e-12] {
                assert!(value(&g, f, u, 0.0).abs() < 1e-9, "{motion:?}, derivative {order} at {u}");
            }
        }
    }
}

/// Systems of all examples and cases.
fn systems() -> Vec<(String, ConstraintSystem)> {
    let paths = [files("examples", "mech"), files("tests/cases", "mech")].concat();
    let systems: Vec<_> = paths
        .iter()
        .filter_map(|path| {
            let text = fs::read_to_string(path).expect("a text");
            let (compiled, _) = compile(&stem(path), &text);
            compiled.map(|compiled| (stem(path), compiled.inside().0.system().clone()))
        })
        .collect();
    assert!(systems.len() >= 30);
    systems
}

/// A value of an expression at `q + a τ + b τ²/2 + c τ³/6` and `t + τ`.
fn along(system: &ConstraintSystem, id: ExprId, t: f64, path: [&[f64]; 4], tau: f64) -> f64 {
    let [q, a, b, c] = path;
    system.graph().value(id, |symbol| match symbol {
        Symbol::Param(k) => system.params()[k as usize].value,
        Symbol::Time => t + tau,
        Symbol::Coordinate { index, order } => {
            let k = index as usize;
            match order {
                0 => q[k] + tau * (a[k] + tau * (b[k] / 2.0 + tau * c[k] / 6.0)),
                1 => a[k] + tau * (b[k] + tau * c[k] / 2.0),
                2 => b[k] + tau * c[k],
                _ => c[k],
            }
        }
        Symbol::Shift(_) | Symbol::Multiplier(_) | Symbol::VariedMultiplier { .. } => 0.0,
        Symbol::Varied { index, order, variation } => {
            // anything whose rates are its derivatives
            let rate = |order: u32| math::sin(1.3 * f64::from(index) + 0.7 * f64::from(variation) + f64::from(order));
            match order {
                0 => rate(0) + tau * (rate(1) + tau * rate(2) / 2.0),
                1 => rate(1) + tau * rate(2),
                _ => rate(2),
            }
        }
        Symbol::Named(_) | Symbol::Signal { .. } => unreachable!("no named symbol is left, and no signal"),
    })
}

#[test]
fn jacobians_and_right_sides_of_every_element() {
    let mut random = Random::new(11);
    // 1000 km from the origin a difference is nothing but rounding
    for (name, system) in systems().into_iter().filter(|(name, _)| name != "far_away") {
        let n = system.coordinates().len();
        let zero = vec![0.0; n];
        // in the mechanism's own time
        let span = system.analysis().map_or(1.0, |[from, to, _]| f64::min(to - from, 1.0));
        let h = 2e-4 * span;
        for _ in 0..3 {
            let scale = |k: usize| match system.coordinates()[k].kind {
                mechc_ir::CoordinateKind::Length => system.length().max(1e-3),
                mechc_ir::CoordinateKind::Angle | mechc_ir::CoordinateKind::Argument => 1.0,
            };
            let q: Vec<f64> = (0..n)
                .map(|k| along(&system, system.coordinates()[k].estimate, 0.0, [&zero; 4], 0.0))
                .enumerate()
                .map(|(k, q)| q + 0.05 * scale(k) * random.between(-1.0, 1.0))
                .collect();
            let mut random_vector = |order: i32| -> Vec<f64> {
                (0..n)
                    .map(|k| scale(k) * random.between(-1.0, 1.0) / mechc_expr::math::pow(span, f64::from(order)))
                    .collect()
            };
            let (a, b, c) = (random_vector(1), random_vector(2), random_vector(3));
            let t = 0.123 * span;
            for row in 0..n {
                let phi = system.rows()[row].phi;
                let size = 1.0 + along(&system, phi, t, [&q, &zero, &zero, &zero], 0.0).abs() + system.length();
                let near = |exact: f64, difference: f64, tolerance: f64, order: i32, what: &str| {
                    let bound = tolerance
                        * (size / mechc_expr::math::pow(span, f64::from(order)) + exact.abs() + difference.abs());
                    assert!((exact - difference).abs() <= bound, "{name}, row {row}, {what}: {exact} and {difference}");
                };
                // Φ_q a + Φ_t = dΦ/dτ, with Φ_t = −ν
                let at = |tau: f64| along(&system, phi, t, [&q, &a, &b, &c], tau);
                let first = (at(-2.0 * h) - 8.0 * at(-h) + 8.0 * at(h) - at(2.0 * h)) / (12.0 * h);
                let now = |id: ExprId| along(&system, id, t, [&q, &a, &b, &c], 0.0);
                let times = |v: &[f64]| -> f64 {
                    system.phi_q().row(row).iter().map(|&(column, slope)| now(slope) * v[column as usize]).sum()
                };
                near(times(&a) - now(system.nu()[row]), first, 1e-8, 1, "ν");
                // Φ_q b − γ = d²Φ/dτ²
                let second =
                    (-at(-2.0 * h) + 16.0 * at(-h) - 30.0 * at(0.0) + 16.0 * at(h) - at(2.0 * h)) / (12.0 * h * h);
                near(times(&b) - now(system.gamma()[row]), second, 1e-5, 2, "γ");
                if let Some(jerk) = system.jerk() {
                    let third = (at(2.0 * h) - 2.0 * at(h) + 2.0 * at(-h) - at(-2.0 * h)) / (2.0 * h * h * h);
                    near(times(&c) - now(jerk[row]), third, 1e-2, 3, "jerk");
                }
            }
        }
    }
}

/// Cases without any edge, so that differences may reach across every time.
const SMOOTH: &[&str] = &[
    "pendulum",
    "slider_crank",
    "four_bar",
    "free_body",
    "three_rpr",
    "relative_xy",
    "translational_driver",
    "quick_return",
    "andrews",
    "coupler_constraint",
    "jansen",
    "revolute_offsets",
    "stephenson",
    "derivatives",
    "rough",
];

#[test]
fn velocities_and_accelerations_match_differences() {
    for name in SMOOTH {
        let text = text_of(format!("tests/cases/{name}.mech"));
        let times = run(name, &text, Span::default()).expect_success().column("t");
        let (first, last) = (times[0], times[times.len() - 1]);
        let h = (last - first) * 1e-4;
        let outcome =
            run(name, &text, Span { every: Some(h), to: Some(first + 0.1 * (last - first)) }).expect_success();
        for column in outcome.columns.iter().filter(|column| outcome.columns.contains(&format!("{column}.d"))) {
            for (of, derivative) in
                [(column.clone(), format!("{column}.d")), (format!("{column}.d"), format!("{column}.dd"))]
            {
                if !outcome.columns.contains(&derivative) {
                    continue;
                }
                let (f, d) = (outcome.column(&of), outcome.column(&derivative));
                let size = d.iter().chain(&f).fold(0.0, |m: f64, v| m.max(v.abs()));
                for k in (2..f.len() - 2).step_by(7) {
                    let difference = (f[k - 2] - 8.0 * f[k - 1] + 8.0 * f[k + 1] - f[k + 2]) / (12.0 * h);
                    let error = (difference - d[k]).abs();
                    assert!(
                        error <= 1e-7 * size + 1e-11 * size / h,
                        "{name}: {derivative} at row {k}: {} and {difference}",
                        d[k]
                    );
                }
            }
        }
    }
}

/// A param as exponent: a derivative that its factors make zero is zero where the power has a pole.
#[test]
fn powers_of_params_have_the_derivatives_of_powers_of_numbers() {
    let text = |exponent: &str, n: u32| {
        format!(
            "mechanism m {{
                param n = {n}
                body b {{ point P = (0, 0) }}
                driver dx: x(b.P) = (t - 0.3)^{exponent}
                driver dy: y(b.P) = 0
                driver da: angle(b) = t
                measure a = der(der(x(b.P)))
                measure c = x(b.P)^{exponent}
                result r = max(a)
                analysis from 0 to 0.9 every 0.3
            }}"
        )
    };
    // the cubic gets a warning more: its acceleration passes zero where the derivative is chosen by the exponent
    for n in [0, 1, 2, 4, 5] {
        let [by_number, by_param] =
            [n.to_string(), "n".to_owned()].map(|exponent| run("m", &text(&exponent, n), Span::default()));
        assert_eq!(by_param.codes(), by_number.codes(), "n = {n}");
        assert_eq!(by_param.columns, by_number.columns);
        assert_eq!(by_param.rows.len(), 4, "n = {n}: {}", by_param.text());
        for (found, wanted) in by_param.rows.iter().zip(&by_number.rows) {
            for (k, (found, wanted)) in found.iter().zip(wanted).enumerate() {
                assert!((found - wanted).abs() < 1e-12, "n = {n}, {}: {found}, not {wanted}", by_param.columns[k]);
            }
        }
    }
}
