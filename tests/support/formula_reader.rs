//! Reader of printed formulas, which uses the constructors of the graph.

use mechc::Sources;
use mechc_expr::{Binary, Comparison, ExprId, Graph, TableId, Unary};
use mechc_syntax::{self as syntax, ast};

/// Functions of the language with one argument.
pub const UNARIES: [Unary; 15] = [
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
];

/// Functions of the language with two arguments, except `mod`.
pub const BINARIES: [Binary; 4] = [Binary::Atan2, Binary::Hypot, Binary::Min, Binary::Max];

/// Meaning of the words of a formula.
pub trait Names {
    /// Returns the expression of a word.
    fn symbol(&self, graph: &mut Graph, word: &str) -> ExprId;

    /// Returns the table of a call, and the order of its derivative.
    fn table(&self, word: &str) -> Option<(TableId, u8)>;
}

/// Parses a formula.
pub fn parse(text: &str) -> ast::Expr {
    let mut sources = Sources::default();
    let file = sources.add("printed", text);
    syntax::parse_expression(&sources, file).unwrap_or_else(|_| panic!("{text} does not follow the grammar"))
}

/// Converts a tree to an expression.
pub fn read(graph: &mut Graph, e: &ast::Expr, names: &dyn Names) -> ExprId {
    use ast::ExprKind as Kind;
    let mut go = |e: &ast::Expr| read(graph, e, names);
    match &e.kind {
        Kind::Literal { value, .. } => graph.constant(*value),
        Kind::Paren(inner) => go(inner),
        Kind::Name(word) => names.symbol(graph, &word.text),
        Kind::Negate(inner) => {
            let inner = go(inner);
            graph.neg(inner)
        }
        Kind::Not(inner) => {
            let inner = go(inner);
            graph.not(inner)
        }
        Kind::Sum(first, rest) => rest.iter().fold(go(first), |sum, (sign, term)| {
            let term = read(graph, term, names);
            if *sign == ast::Sign::Plus { graph.add(sum, term) } else { graph.sub(sum, term) }
        }),
        Kind::Product(first, rest) => rest.iter().fold(go(first), |product, (factor, term)| {
            let term = read(graph, term, names);
            if *factor == ast::Factor::Times { graph.mul(product, term) } else { graph.div(product, term) }
        }),
        Kind::Power(a, b) => {
            let (a, b) = (go(a), go(b));
            graph.pow(a, b)
        }
        Kind::Compare(a, comparison, b) => {
            let (a, b) = (go(a), go(b));
            let comparison = match comparison {
                ast::ComparisonSign::Less => Comparison::Less,
                ast::ComparisonSign::LessEqual => Comparison::LessEqual,
                _ => Comparison::Equal,
            };
            graph.compare(comparison, a, b)
        }
        Kind::And(list) | Kind::Or(list) => {
            let ids: Vec<ExprId> = list.iter().map(&mut go).collect();
            let is_and = matches!(e.kind, Kind::And(_));
            ids[1..].iter().fold(ids[0], |all, &id| if is_and { graph.and(all, id) } else { graph.or(all, id) })
        }
        Kind::If { arms, otherwise } => {
            let last = go(otherwise);
            arms.iter().rev().fold(last, |rest, (condition, value)| {
                let (condition, value) = (read(graph, condition, names), read(graph, value, names));
                graph.select(condition, value, rest)
            })
        }
        Kind::Call { name, arguments, .. } => {
            let ids: Vec<ExprId> = arguments.iter().map(&mut go).collect();
            call(graph, &name.text, &ids, names)
        }
        Kind::Member { .. } | Kind::Path(_) | Kind::Tuple(_) => panic!("no such thing is printed"),
    }
}

fn call(graph: &mut Graph, word: &str, ids: &[ExprId], names: &dyn Names) -> ExprId {
    if let Some((table, order)) = names.table(word) {
        graph.table(table, order, ids[0])
    } else if let Some(&unary) = UNARIES.iter().find(|unary| unary.word() == word) {
        graph.unary(unary, ids[0])
    } else if let Some(&binary) = BINARIES.iter().find(|binary| binary.word() == word) {
        graph.binary(binary, ids[0], ids[1])
    } else {
        assert_eq!(word, "mod");
        graph.modulo(ids[0], ids[1])
    }
}
