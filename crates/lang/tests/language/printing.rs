//! What is printed for an expression reads back to the same expression.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::formula_reader::{self, BINARIES, Names, UNARIES, parse};
use mechc_expr::{Comparison, ExprId, Graph, Printer, Symbol, TableId};
use mechc_syntax::ast;
use proptest::prelude::*;
use std::collections::HashMap;

const COMPARISONS: [Comparison; 3] = [Comparison::Less, Comparison::LessEqual, Comparison::Equal];

fn name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Time => "t".to_owned(),
        Symbol::Param(k) => format!("p{k}"),
        other => panic!("{other:?} is not used here"),
    }
}

/// Parameters `p0`, `p1` …, and named parts.
struct Known<'k>(&'k HashMap<String, ExprId>);

impl Names for Known<'_> {
    fn symbol(&self, graph: &mut Graph, word: &str) -> ExprId {
        match word {
            "t" => graph.symbol(Symbol::Time),
            text => {
                self.0.get(text).copied().unwrap_or_else(|| graph.symbol(Symbol::Param(text[1..].parse().unwrap())))
            }
        }
    }

    fn table(&self, _: &str) -> Option<(TableId, u8)> {
        None
    }
}

fn read(graph: &mut Graph, e: &ast::Expr, known: &HashMap<String, ExprId>) -> ExprId {
    formula_reader::read(graph, e, &Known(known))
}

/// A program of constructors for a stack of numbers and a stack of conditions.
fn build(graph: &mut Graph, steps: &[(u8, u8, i8)]) -> ExprId {
    let mut numbers = vec![graph.symbol(Symbol::Time)];
    let mut conditions: Vec<ExprId> = Vec::new();
    for &(what, which, number) in steps {
        let pick = |list: &[ExprId], offset: usize| list[list.len() - 1 - (which as usize + offset) % list.len()];
        let (a, b) = (pick(&numbers, 0), pick(&numbers, usize::from(number.unsigned_abs())));
        let made = match what % 16 {
            0 => graph.symbol(Symbol::Param(u32::from(which % 3))),
            1 => graph.constant(f64::from(number) / 4.0),
            2 | 3 => graph.add(a, b),
            4 | 5 => graph.sub(a, b),
            6 | 7 => graph.mul(a, b),
            8 => graph.div(a, b),
            9 => graph.neg(a),
            10 => graph.power(a, i32::from(number % 6)),
            11 => graph.pow(a, b),
            12 => graph.unary(UNARIES[which as usize % UNARIES.len()], a),
            13 if which % 5 == 4 => graph.modulo(a, b),
            13 => graph.binary(BINARIES[which as usize % 4], a, b),
            14 => {
                let condition = match (which % 6, conditions.as_slice()) {
                    (3, [.., x, y]) => graph.and(*x, *y),
                    (4, [.., x, y]) => graph.or(*x, *y),
                    (5, [.., x]) => graph.not(*x),
                    _ => graph.compare(COMPARISONS[which as usize % 3], a, b),
                };
                conditions.push(condition);
                continue;
            }
            _ => match conditions.last() {
                Some(&condition) => graph.select(condition, a, b),
                None => continue,
            },
        };
        numbers.push(made);
    }
    numbers[numbers.len() - 1]
}

/// Whether an operation on numbers alone was left standing, because its result is no number: `check` refuses those.
fn holds_no_value(graph: &Graph, root: ExprId) -> bool {
    graph.reachable(&[root]).into_iter().any(|id| {
        let children = graph.node(id).children();
        let children = children.as_slice();
        !children.is_empty() && children.iter().all(|&child| graph.as_const(child).is_some())
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, max_global_rejects: 100_000, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn expressions_read_back(steps in prop::collection::vec((any::<u8>(), any::<u8>(), any::<i8>()), 1..24)) {
        let mut graph = Graph::new();
        let root = build(&mut graph, &steps);
        prop_assume!(!holds_no_value(&graph, root));
        let text = Printer::new(&graph, name).text(root);
        prop_assume!(text.len() < 20_000);
        let back = read(&mut graph, &parse(&text), &HashMap::new());
        prop_assert_eq!(back, root, "{} became {}", &text, Printer::new(&graph, name).text(back));
    }

    #[test]
    fn reordered_texts_read_back(steps in prop::collection::vec((any::<u8>(), any::<u8>(), any::<i8>()), 1..24)) {
        let mut graph = Graph::new();
        let built = build(&mut graph, &steps);
        prop_assume!(!holds_no_value(&graph, built) && graph.written_size(&[built]) < 5_000);
        let root = graph.tidied(built);
        prop_assume!(!holds_no_value(&graph, root));
        let text = Printer::new(&graph, name).text(root);
        let back = read(&mut graph, &parse(&text), &HashMap::new());
        prop_assert_eq!(back, root, "{} became {}", &text, Printer::new(&graph, name).text(back));
    }

    #[test]
    fn shared_parts_read_back(steps in prop::collection::vec((any::<u8>(), any::<u8>(), any::<i8>()), 10..60)) {
        let mut graph = Graph::new();
        let root = build(&mut graph, &steps);
        prop_assume!(!holds_no_value(&graph, root));
        let mut printer = Printer::new(&graph, name);
        let shared = printer.name_shared(&[root], |k| format!("k{k}"));
        let parts: Vec<(String, String)> = shared.iter().map(|(name, id)| (name.clone(), printer.definition(*id))).collect();
        let text = printer.text(root);
        let mut known = HashMap::new();
        for (name, text) in parts {
            let id = read(&mut graph, &parse(&text), &known);
            known.insert(name, id);
        }
        let back = read(&mut graph, &parse(&text), &known);
        prop_assert_eq!(back, root, "{} with {:?}", text, shared.iter().map(|(n, i)| format!("{n} = {}", Printer::new(&graph, name).text(*i))).collect::<Vec<_>>());
    }
}

#[test]
fn minimal_parentheses() {
    let cases = [
        "t + p0 * p1^2",
        "(t + p0) * p1",
        "t - (p0 + p1)",
        "t / (p0 * p1)",
        "-t^2 + p0",
        "(-t)^3",
        "t^-2",
        "2 * sin(t) + 1",
        "-2 * t",
        "if t < 1 then 2 * t else p0",
        "1 / (if t < 1 then t else p0)",
        "if not (t < 1 or t < p0) then t else 0",
        "mod(t, p0) - 3",
        "p0^(p1 + 1)",
        "(p0^p1)^t",
    ];
    for text in cases {
        let mut graph = Graph::new();
        // in this order, which is that of the operands
        for k in 0..2 {
            graph.symbol(Symbol::Time);
            graph.symbol(Symbol::Param(k));
        }
        let id = read(&mut graph, &parse(text), &HashMap::new());
        let printed = Printer::new(&graph, name).text(id);
        let count = |text: &str| text.matches('(').count();
        assert!(count(&printed) <= count(text), "{text} is printed as {printed}");
        assert_eq!(read(&mut graph, &parse(&printed), &HashMap::new()), id, "{text} is printed as {printed}");
    }
}
