//! Typeset formulas read as a person reads them: their values, at a point.

use mechc_expr::{Binary, Unary, binary_value, unary_value};
use std::cell::RefCell;
use std::collections::HashMap;

/// What the symbols of a document stand for.
pub struct Meaning<'m> {
    pub symbols: HashMap<String, f64>,
    /// The right sides of terms, by their names.
    pub terms: HashMap<String, String>,
    /// A table's derivative of some order at an argument, by the table's symbol.
    pub table: &'m dyn Fn(&str, usize, f64) -> Option<f64>,
    /// Terms whose values are known.
    pub known: RefCell<HashMap<String, f64>>,
}

impl Meaning<'_> {
    /// The value of a formula.
    pub fn value(&self, text: &str) -> f64 {
        // what is there for the eye alone
        let text = text.replace(r"\nobreak", " ").replace(r"\allowbreak", " ");
        let mut reader = Reader { meaning: self, rest: &text };
        let value = reader.either();
        assert_eq!(reader.rest.trim(), "", "left over of {text}");
        value
    }

    fn term(&self, name: &str) -> f64 {
        if let Some(value) = self.known.borrow().get(name) {
            return *value;
        }
        let value = self.value(self.terms.get(name).unwrap_or_else(|| panic!("no term {name}")));
        self.known.borrow_mut().insert(name.to_owned(), value);
        value
    }
}

struct Reader<'r> {
    meaning: &'r Meaning<'r>,
    rest: &'r str,
}

const FUNCTIONS: [(&str, Unary); 12] = [
    (r"\sinh", Unary::Sinh),
    (r"\cosh", Unary::Cosh),
    (r"\tanh", Unary::Tanh),
    (r"\sin", Unary::Sin),
    (r"\cos", Unary::Cos),
    (r"\tan", Unary::Tan),
    (r"\arcsin", Unary::Asin),
    (r"\arccos", Unary::Acos),
    (r"\arctan", Unary::Atan),
    (r"\exp", Unary::Exp),
    (r"\ln", Unary::Ln),
    (r"\log_{10}", Unary::Log10),
];

const CLOSING: [&str; 12] = [
    ")",
    "}",
    "&",
    r"\\",
    ",",
    r"\right",
    r"\biggr",
    r"\rvert",
    r"\rfloor",
    r"\end{cases}",
    r"\text{ and }",
    r"\text{ or }",
];

impl<'r> Reader<'r> {
    fn takes(&mut self, word: &str) -> bool {
        self.rest = self.rest.trim_start();
        match self.rest.strip_prefix(word) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn wants(&mut self, word: &str) {
        assert!(self.takes(word), "{word} is wanted before {:?}", self.rest);
    }

    fn stands(&mut self, word: &str) -> bool {
        self.rest = self.rest.trim_start();
        self.rest.starts_with(word)
    }

    /// A group in braces, as it is.
    fn group(&mut self) -> &'r str {
        self.wants("{");
        let (whole, mut depth, mut before) = (self.rest, 1, ' ');
        for (at, c) in whole.char_indices() {
            match c {
                '{' if before != '\\' => depth += 1,
                '}' if before != '\\' => depth -= 1,
                _ => {}
            }
            before = c;
            if depth == 0 {
                self.rest = &whole[at + 1..];
                return &whole[..at];
            }
        }
        panic!("{whole} does not end")
    }

    fn inner(&mut self) -> f64 {
        let text = self.group();
        self.meaning.value(text)
    }

    fn either(&mut self) -> f64 {
        let mut value = self.both();
        while self.takes(r"\text{ or }") {
            let other = self.both();
            value = f64::from(value != 0.0 || other != 0.0);
        }
        value
    }

    fn both(&mut self) -> f64 {
        let mut value = self.relation();
        while self.takes(r"\text{ and }") {
            let other = self.relation();
            value = f64::from(value != 0.0 && other != 0.0);
        }
        value
    }

    fn relation(&mut self) -> f64 {
        if self.takes(r"\text{not }") {
            return f64::from(self.relation() == 0.0);
        }
        let value = self.sum();
        if self.takes("<") {
            f64::from(value < self.sum())
        } else if self.takes(r"\le ") {
            f64::from(value <= self.sum())
        } else if self.takes("=") {
            f64::from(value.total_cmp(&self.sum()).is_eq())
        } else {
            value
        }
    }

    fn sum(&mut self) -> f64 {
        let mut value = if self.takes("-") { -self.product() } else { self.product() };
        loop {
            if self.takes("+") {
                value += self.product();
            } else if self.takes("-") {
                value -= self.product();
            } else {
                return value;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut value = self.factor();
        loop {
            while self.takes(r"\,") || self.takes(r"\by") || self.takes(r"\cdot") {}
            let ends =
                self.rest.trim().is_empty() || ["+", "-", "<", "=", r"\le "].iter().any(|sign| self.stands(sign));
            if ends || CLOSING.iter().any(|sign| self.stands(sign)) {
                return value;
            }
            value *= self.factor();
        }
    }

    fn factor(&mut self) -> f64 {
        let (value, word) = if let Some((word, function)) = FUNCTIONS.iter().find(|(word, _)| self.stands(word)) {
            self.wants(word);
            let exponent = if self.takes("^") { self.inner() } else { 1.0 };
            let argument = self.atom();
            (binary_value(Binary::Pow, unary_value(*function, argument), exponent), *word)
        } else {
            (self.atom(), "")
        };
        if word.is_empty() && self.takes("^") {
            let exponent = self.inner();
            return binary_value(Binary::Pow, value, exponent);
        }
        value
    }

    fn list(&mut self) -> Vec<f64> {
        let close = if self.takes("(") {
            ")"
        } else if self.takes(r"\left(") {
            r"\right)"
        } else {
            self.wants(r"\biggl(");
            r"\biggr)"
        };
        let mut values = vec![self.either()];
        while self.takes(",") {
            while self.takes(r"\,") {}
            values.push(self.either());
        }
        self.wants(close);
        values
    }

    fn between(&mut self, word: &str) -> Option<f64> {
        for (size, end) in [("", ""), (r"\left", r"\right"), (r"\biggl", r"\biggr")] {
            if self.takes(&format!("{size}\\l{word} ")) {
                let value = self.either();
                self.wants(&format!("{end}\\r{word} "));
                return Some(value);
            }
        }
        None
    }

    fn atom(&mut self) -> f64 {
        if self.stands("(") || self.stands(r"\left(") || self.stands(r"\biggl(") {
            let list = self.list();
            assert_eq!(list.len(), 1);
            return list[0];
        }
        if let Some(value) = self.between("vert") {
            return value.abs();
        }
        if let Some(value) = self.between("floor") {
            return unary_value(Unary::Floor, value);
        }
        if self.takes(r"\frac") || self.takes(r"\tfrac") {
            let above = self.inner();
            return above / self.inner();
        }
        if self.takes(r"\sqrt") {
            return unary_value(Unary::Sqrt, self.inner());
        }
        if self.takes(r"\begin{cases}") {
            return self.cases();
        }
        for (word, function) in [
            (r"\operatorname{atan2}", Binary::Atan2),
            (r"\operatorname{mod}", Binary::Mod),
            (r"\min", Binary::Min),
            (r"\max", Binary::Max),
        ] {
            if self.takes(word) {
                let list = self.list();
                return list.into_iter().reduce(|a, b| binary_value(function, a, b)).expect("an argument");
            }
        }
        if self.takes(r"\operatorname{sgn}") {
            return unary_value(Unary::Sign, self.list()[0]);
        }
        let digits = self.rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(self.rest.len());
        if digits > 0 {
            let (number, rest) = self.rest.split_at(digits);
            self.rest = rest;
            return number.parse().expect("a number");
        }
        self.symbol()
    }

    /// Only the row that holds counts.
    fn cases(&mut self) -> f64 {
        let end = self.rest.find(r"\end{cases}").expect("an end");
        let rows: Vec<&str> = self.rest[..end].split(r"\\").collect();
        self.rest = &self.rest[end + r"\end{cases}".len()..];
        for row in rows {
            let (value, condition) = row.split_once('&').expect("a condition");
            let holds = match condition.trim().strip_prefix(r"\text{if }") {
                Some(condition) => self.meaning.value(condition) != 0.0,
                None => condition.trim() == r"\text{otherwise}",
            };
            if holds {
                return self.meaning.value(value);
            }
        }
        panic!("no case holds")
    }

    fn symbol(&mut self) -> f64 {
        let whole = self.rest;
        if let Some(rest) = whole.strip_prefix('\\') {
            let end = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
            self.rest = &rest[end..];
            if self.rest.starts_with('{') {
                self.group();
            }
        } else {
            self.rest = &whole[1..];
        }
        if self.rest.starts_with("_{") {
            self.rest = &self.rest[1..];
            self.group();
        }
        let name = &whole[..whole.len() - self.rest.len()];
        if name.starts_with(r"\mathcal") {
            return self.meaning.term(name);
        }
        if name == r"\pi" && !self.meaning.symbols.contains_key(name) {
            return std::f64::consts::PI;
        }
        if let Some(value) = self.meaning.symbols.get(name) {
            return *value;
        }
        let primes = self.rest.len() - self.rest.trim_start_matches('\'').len();
        self.rest = &self.rest[primes..];
        let argument = self.list()[0];
        (self.meaning.table)(name, primes, argument).unwrap_or_else(|| panic!("what is {name}?"))
    }
}
