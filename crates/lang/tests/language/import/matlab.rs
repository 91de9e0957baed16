//! MATLAB's meaning of a formula, and the language's, each evaluated on its own; and random formulas to compare them.

use crate::support::random::Random;
use mechc_expr::math;
use mechc_syntax::ast::{ComparisonSign, Expr, ExprKind, Factor, Sign};
use std::f64::consts::PI;

// ---- random formulas

const OPERATORS: &[&str] = &[
    " + ", "-", "*", ".*", "/", "./", "\\", "^", ".^", " < ", "<=", ">", ">=", "==", "~=", "&", "|", "&&", "||", "^-",
    ".^-",
];

/// A formula whose parts stand beside each other with few parentheses, so that precedences decide.
pub fn formula(random: &mut Random, depth: usize) -> String {
    let parts = 1 + random.below(4);
    let mut text = String::new();
    for k in 0..parts {
        if k > 0 {
            text += random.of(OPERATORS);
        }
        if !text.ends_with('-') {
            text += random.of(&["", "", "", "-", "+", "~"]);
        }
        text += &match random.below(if depth == 0 { 4 } else { 7 }) {
            0 => "t".to_owned(),
            1 => random.of(&["1.", ".5", "2", "3", "0", "1d0", "25e-1"]).to_owned(),
            2 => random.of(&["t'", "2'", "t.'"]).to_owned(),
            3 => "pi".to_owned(),
            4 | 5 => format!("({})", formula(random, depth - 1)),
            _ => match random.below(3) {
                0 => format!(
                    "{}({},{})",
                    random.of(&["mod", "max", "power"]),
                    formula(random, depth - 1),
                    random.of(&["3", "2"])
                ),
                _ => format!("{}({})", random.of(&["sin", "floor", "abs", "fix", "round"]), formula(random, depth - 1)),
            },
        };
    }
    text
}

// ---- MATLAB

/// The value of a MATLAB formula, if all on the way to it is finite: a method per precedence, loosest first.
pub fn value(formula: &str, t: f64) -> Option<f64> {
    let text: String = formula.chars().filter(|c| !c.is_whitespace()).collect();
    let mut reader = Reader { rest: &text, t, finite: true };
    let value = reader.level(0);
    assert!(reader.rest.is_empty(), "{formula}: {} is left", reader.rest);
    reader.finite.then_some(value)
}

struct Reader<'a> {
    rest: &'a str,
    t: f64,
    /// Whether every value so far is.
    finite: bool,
}

/// Longer signs first.
const LEVELS: &[&[&str]] = &[
    &["||"],
    &["&&"],
    &["|"],
    &["&"],
    &["<=", ">=", "==", "~=", "<", ">"],
    &["+", "-"],
    &[".*", "./", ".\\", "*", "/", "\\"],
];

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

impl<'a> Reader<'a> {
    fn sign(&mut self, signs: &[&'a str]) -> Option<&'a str> {
        let sign = *signs.iter().find(|sign| self.rest.starts_with(**sign))?;
        // `a || b` is no `a | |b`
        if matches!(sign, "|" | "&") && self.rest[1..].starts_with(sign) {
            return None;
        }
        self.rest = &self.rest[sign.len()..];
        Some(sign)
    }

    fn level(&mut self, level: usize) -> f64 {
        let Some(signs) = LEVELS.get(level) else {
            return self.prefix();
        };
        let mut a = self.level(level + 1);
        while let Some(sign) = self.sign(signs) {
            let b = self.level(level + 1);
            a = match sign {
                "||" | "|" => truth(a != 0.0 || b != 0.0),
                "&&" | "&" => truth(a != 0.0 && b != 0.0),
                "<=" => truth(a <= b),
                ">=" => truth(a >= b),
                "==" => truth(a == b),
                "~=" => truth(a != b),
                "<" => truth(a < b),
                ">" => truth(a > b),
                "+" => a + b,
                "-" => a - b,
                "*" | ".*" => a * b,
                "/" | "./" => a / b,
                _ => b / a,
            };
            self.finite &= a.is_finite();
        }
        a
    }

    fn prefix(&mut self) -> f64 {
        match self.sign(&["-", "+", "~"]) {
            Some("-") => -self.prefix(),
            Some("+") => self.prefix(),
            Some(_) => truth(self.prefix() == 0.0),
            None => self.power(),
        }
    }

    fn power(&mut self) -> f64 {
        let mut a = self.primary();
        while self.sign(&[".^", "^"]).is_some() {
            let mut signs = Vec::new();
            while let Some(sign) = self.sign(&["-", "+", "~"]) {
                signs.push(sign);
            }
            let exponent = self.primary();
            let exponent = signs.iter().rev().fold(exponent, |e, sign| match *sign {
                "-" => -e,
                "+" => e,
                _ => truth(e == 0.0),
            });
            a = math::pow(a, exponent);
            self.finite &= a.is_finite();
        }
        a
    }

    fn primary(&mut self) -> f64 {
        let value = if self.sign(&["("]).is_some() {
            let value = self.level(0);
            self.sign(&[")"]).expect("`)`");
            value
        } else if self.rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            self.number()
        } else {
            self.word()
        };
        while self.sign(&[".'", "'"]).is_some() {}
        value
    }

    fn number(&mut self) -> f64 {
        let bytes = self.rest.as_bytes();
        let mut end = 0;
        while end < bytes.len() {
            let next = bytes.get(end + 1).copied().unwrap_or(b' ');
            let belongs = match bytes[end] {
                b'0'..=b'9' | b'e' | b'd' => true,
                b'.' => !b"*/\\^'".contains(&next),
                b'-' => matches!(bytes[end - 1], b'e' | b'd'),
                _ => false,
            };
            if !belongs {
                break;
            }
            end += 1;
        }
        let (number, rest) = self.rest.split_at(end);
        self.rest = rest;
        number.replace('d', "e").parse().expect("a number")
    }

    fn word(&mut self) -> f64 {
        let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        if word == "t" {
            return self.t;
        } else if word == "pi" {
            return PI;
        }
        self.sign(&["("]).expect("`(`");
        let a = self.level(0);
        let b = if self.sign(&[","]).is_some() { self.level(0) } else { 0.0 };
        self.sign(&[")"]).expect("`)`");
        let value = match word {
            "sin" => math::sin(a),
            "abs" => a.abs(),
            "floor" => a.floor(),
            "fix" => a.trunc(),
            "round" => a.round(),
            "mod" => a - b * (a / b).floor(),
            "max" => a.max(b),
            "power" => math::pow(a, b),
            _ => panic!("{word}"),
        };
        self.finite &= value.is_finite();
        value
    }
}

// ---- the language

/// The value of a formula of the language; conditions are 1 and 0.
pub fn value_here(e: &Expr, t: f64) -> f64 {
    let of = |e: &Expr| value_here(e, t);
    match &e.kind {
        ExprKind::Literal { value, unit } => {
            let unit = unit.as_ref().map(|(name, _)| name.text.as_str());
            if unit == Some("deg") { value / 180.0 * PI } else { *value }
        }
        ExprKind::Name(name) if name.text == "t" => t,
        ExprKind::Name(name) if name.text == "pi" => PI,
        ExprKind::Paren(inner) => of(inner),
        ExprKind::Negate(inner) => -of(inner),
        ExprKind::Not(inner) => truth(of(inner) == 0.0),
        ExprKind::Sum(first, rest) => rest.iter().fold(of(first), |sum, (sign, e)| match sign {
            Sign::Plus => sum + of(e),
            Sign::Minus => sum - of(e),
        }),
        ExprKind::Product(first, rest) => rest.iter().fold(of(first), |product, (factor, e)| match factor {
            Factor::Times => product * of(e),
            Factor::Divide => product / of(e),
        }),
        ExprKind::Power(base, exponent) => math::pow(of(base), of(exponent)),
        ExprKind::Compare(a, comparison, b) => {
            let (a, b) = (of(a), of(b));
            truth(match comparison {
                ComparisonSign::Less => a < b,
                ComparisonSign::LessEqual => a <= b,
                ComparisonSign::Greater => a > b,
                ComparisonSign::GreaterEqual => a >= b,
                ComparisonSign::Equal => a == b,
                ComparisonSign::NotEqual => a != b,
            })
        }
        ExprKind::And(list) => truth(list.iter().all(|e| of(e) != 0.0)),
        ExprKind::Or(list) => truth(list.iter().any(|e| of(e) != 0.0)),
        ExprKind::If { arms, otherwise } => {
            arms.iter().find(|(condition, _)| of(condition) != 0.0).map_or_else(|| of(otherwise), |(_, e)| of(e))
        }
        ExprKind::Call { name, arguments, .. } => {
            let values: Vec<f64> = arguments.iter().map(of).collect();
            match (name.text.as_str(), values.as_slice()) {
                ("sin", [a]) => math::sin(*a),
                ("abs", [a]) => a.abs(),
                ("sign", [a]) => truth(*a > 0.0) - truth(*a < 0.0) + 0.0 * a,
                ("mod", [a, b]) => a - b * (a / b).floor(),
                ("max", [a, b]) => a.max(*b),
                (name, _) => panic!("{name}"),
            }
        }
        other => panic!("{other:?}"),
    }
}
