//! Vector instructions change no bit: of operations, of rows, of results. `.ci/vectors` holds it of the program as it is released, whose
//! loops are compiled otherwise than those of a test.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{compile_number, compiled, files, mechanisms, stem};
use mechc::{Compiled, RunOptions, Times, Vectors};
use mechc_expr::math;
use mechc_expr::{Binary, Comparison, Unary, binary_value, compare, unary_value};
use mechc_ir::program::{LaneMachine, LaneValues, Op, Program, truth};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestRunner};
use std::fs;

const LANES: usize = 16;
/// And lanes that are gone through together.
const PART: usize = 8;

/// All that this processor has; says which it has not.
fn units() -> Vec<(&'static str, Vectors)> {
    let known = Vectors::NAMES.into_iter().filter_map(|name| {
        let vectors = Vectors::named(name);
        if vectors.is_none() {
            println!("this processor has no {name}, which is not tested");
        }
        Some((name, vectors?))
    });
    known.collect()
}

/// The bits of a number; all that are none are alike.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

/// Operations whose operands stand in registers 0 to 2 and whose results in 3 and 4.
fn operations() -> Vec<Op> {
    let (to, a, b, c) = (3, 0, 1, 2);
    let unary = [
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Sinh,
        Unary::Cosh,
        Unary::Tanh,
        Unary::Exp,
        Unary::Ln,
        Unary::Log10,
        Unary::Sqrt,
        Unary::Abs,
        Unary::Sign,
        Unary::Floor,
    ];
    let binary = [Binary::Atan2, Binary::Hypot, Binary::Min, Binary::Max, Binary::Pow, Binary::Mod];
    let comparisons = [Comparison::Less, Comparison::LessEqual, Comparison::Equal];
    let mut all = vec![
        Op::Add { to, a, b },
        Op::Sub { to, a, b },
        Op::Mul { to, a, b },
        Op::Div { to, a, b },
        Op::MulAdd { to, a, b, c },
        Op::MulLess { to, a, b, c },
        Op::LessMul { to, a, b, c },
        Op::ProductOfThree { to, a, b, c },
        Op::SumOfProducts { to, a, b, c, d: a },
        Op::DifferenceOfProducts { to, a, b, c, d: a },
        Op::SumOfProductsTimes { to, a, b, c, d: a, e: b },
        Op::DifferenceOfProductsTimes { to, a, b, c, d: a, e: c },
        Op::Turn { to_sin: 3, to_cos: 4, sin: a, cos: b, half: c, delta: a },
        Op::Neg { to, a },
        Op::Recip { to, a },
        Op::SinCos { sin: 3, cos: 4, a },
        Op::And { to, a, b },
        Op::Or { to, a, b },
        Op::Not { to, a },
        Op::Select { to, condition: a, a: b, b: c },
        Op::Either { to, condition: a, a: b, b: c },
        Op::Copy { to, a },
    ];
    all.extend(unary.map(|function| Op::Unary { function, to, a }));
    all.extend(binary.map(|function| Op::Binary { function, to, a, b }));
    all.extend(comparisons.map(|comparison| Op::Compare { comparison, to, a, b }));
    all
}

/// What an operation gives of numbers.
fn by_hand(op: Op, [a, b, c]: [f64; 3]) -> [f64; 2] {
    let product = a * b;
    let value = match op {
        Op::Add { .. } => a + b,
        Op::Sub { .. } => a - b,
        Op::Mul { .. } => product,
        Op::Div { .. } => a / b,
        Op::MulAdd { .. } => product + c,
        Op::MulLess { .. } => product - c,
        Op::LessMul { .. } => c - product,
        Op::ProductOfThree { .. } => product * c,
        Op::SumOfProducts { .. } => product + c * a,
        Op::DifferenceOfProducts { .. } => product - c * a,
        Op::SumOfProductsTimes { .. } => (product + c * a) * b,
        Op::DifferenceOfProductsTimes { .. } => (product - c * a) * c,
        Op::Turn { .. } => return [a + a * (b - c * a), b - a * (a + c * b)],
        Op::Neg { .. } => -a,
        Op::Recip { .. } => 1.0 / a,
        Op::SinCos { .. } => return math::sin_cos(a).into(),
        Op::Unary { function, .. } => unary_value(function, a),
        Op::Binary { function, .. } => binary_value(function, a, b),
        Op::Compare { comparison, .. } => compare(comparison, a, b),
        Op::And { .. } => truth::and(a, b),
        Op::Or { .. } => truth::or(a, b),
        Op::Not { .. } => truth::not(a),
        Op::Select { .. } => truth::select(a, b, c),
        Op::Either { .. } => truth::either(a, b, c),
        Op::Copy { .. } => a,
        Op::Piece { .. } | Op::Pick { .. } => panic!("what a table holds is looked up lane by lane"),
    };
    [value, 0.0]
}

/// Numbers of every kind: of every day's size, with many digits, of any size, at the ends of what there is.
fn number() -> impl Strategy<Value = f64> {
    let odd = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN_POSITIVE,
        -f64::MIN_POSITIVE / 3.0,
        5e-324,
        1e6,
        -1e6,
        4_503_599_627_370_497.5,
    ];
    prop_oneof![
        4 => -10.0..10.0_f64,
        2 => prop::sample::select(odd.to_vec()),
        1 => any::<f64>(),
        1 => (-20_i32..20).prop_map(f64::from),
    ]
}

#[test]
fn an_operation_has_the_same_bits_in_all_lanes() {
    let disc = "mechanism disc { ground { point O = (0, 0) } body wheel { point O = (0, 0) }
        joint axle: revolute(ground.O, wheel.O) driver motor: rotation(axle) = t analysis from 0 to 1 every 0.1 }";
    let (_, program) = compiled("disc", disc).inside();
    let scalars = program.start(&[]);
    let (units, mut differing) = (units(), 0);
    let operands = prop::collection::vec([number(), number(), number()], LANES);
    // the same numbers each time
    let mut runner = TestRunner::new_with_rng(
        Config::with_cases(300),
        prop::test_runner::TestRng::deterministic_rng(prop::test_runner::RngAlgorithm::ChaCha),
    );
    let tested = runner.run(&operands, |operands| {
        for op in operations() {
            for &(name, vectors) in &units {
                let mut v = [LaneValues([0.0; LANES]); 5];
                for (k, operand) in v.iter_mut().take(3).enumerate() {
                    operand.0 = std::array::from_fn(|lane| operands[lane][k]);
                }
                carry_out(op, vectors, &mut v, &program, &scalars);
                for (lane, &operands) in operands.iter().enumerate() {
                    let want = by_hand(op, operands).map(bits);
                    let got = [v[3].0[lane], v[4].0[lane]].map(bits);
                    prop_assert_eq!(got, want, "{:?} of {:?} by {}", op, operands, name);
                }
            }
        }
        Ok(())
    });
    tested.expect("the same bits");
    // a fused product would have been seen
    let mut runner = TestRunner::deterministic();
    for _ in 0..1000 {
        let [a, b, c] =
            [number(), number(), number()].map(|numbers| numbers.new_tree(&mut runner).expect("a number").current());
        #[allow(clippy::disallowed_methods)] // what is not to be
        let fused = a.mul_add(b, c);
        differing += usize::from(bits(fused) != bits(a * b + c));
    }
    assert!(differing > 50, "only {differing} of 1000 products would differ if they were fused");
}

/// One operation, as loops have it.
fn carry_out(
    op: Op,
    vectors: Vectors,
    v: &mut [LaneValues<LANES>],
    program: &Program,
    scalars: &mechc_ir::program::Registers,
) {
    let mut lanes = LaneMachine::<LANES, PART>::new(v, LANES / PART, (program, scalars));
    vectors.run(
        #[inline(always)]
        || op.run(&mut lanes),
    );
}

/// The bits of all rows, why there are no more, and the results.
fn outcome(compiled: &Compiled, times: &Times, vectors: Vectors) -> (Vec<Vec<u64>>, Option<String>, Vec<Option<u64>>) {
    let options = RunOptions { vectors, ..RunOptions::default() };
    let Some(mut run) = compiled.run(times, &options).0 else { return (Vec::new(), None, Vec::new()) };
    let (mut rows, mut why) = (Vec::new(), None);
    for row in run.by_ref() {
        match row {
            Ok(row) => rows.push(row.into_iter().map(bits).collect()),
            Err(stop) => why = Some(stop.first().expect("an error").message.clone()),
        }
    }
    let results = run.results().map(|answers| answers.values).unwrap_or_default();
    (rows, why, results.into_iter().map(|value| value.map(bits)).collect())
}

#[test]
fn rows_and_results_have_the_same_bits_with_all_vector_instructions() {
    let (units, mut seen) = (units(), 0);
    let folders = ["tests/cases", "tests/cases_composed", "tests/cases_forces", "examples"];
    for path in folders.iter().flat_map(|folder| files(folder, "mech")) {
        let text = fs::read_to_string(&path).expect("a text");
        for number in 0..mechanisms(&text).len() {
            let (Some(compiled), _) = compile_number(&path, &text, number) else { continue };
            let Some(times) = compiled.times() else { continue };
            let want = outcome(&compiled, &times, Vectors::BASE);
            for &(name, vectors) in units.iter().skip(1) {
                let got = outcome(&compiled, &times, vectors);
                assert!(got == want, "{} differs by {name}", stem(&path));
            }
            seen += usize::from(want.0.len() > 10);
        }
    }
    assert!(seen > 60, "only {seen} motions");
}
