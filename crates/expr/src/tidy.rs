//! Formulas in the form in which a person would write them.
//!
//! The constructors look at one operation at a time; this file looks at whole sums and products. It gathers equal terms, puts numbers in
//! front, writes equal factors as powers, and begins a sum with a positive term. It cancels nothing against a denominator, and multiplies
//! out only numbers and the result of Horner's rule. Only printed formulas are tidied; computed ones stay as they are.

use super::{ExprId, Graph, Node, number};
use rustc_hash::FxHashMap;

/// Larger exponents are left as they are.
const LARGEST_EXPONENT: i32 = 64;

/// Nesting depth up to which formulas are tidied by recursion.
const DEEPEST: u32 = 50;

/// Larger whole numbers are not exact.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

impl Graph {
    /// Returns the number of nodes of formulas when written out without sharing.
    #[must_use]
    pub fn written_size(&self, roots: &[ExprId]) -> u64 {
        let mut sizes: FxHashMap<ExprId, u64> = FxHashMap::default();
        for id in self.reachable(roots) {
            let children = self.node(id).children();
            let size = children.as_slice().iter().map(|child| sizes[child]).fold(1, u64::saturating_add);
            sizes.insert(id, size);
        }
        roots.iter().map(|root| sizes[root]).fold(0, u64::saturating_add)
    }

    /// Returns the formula with its sums and products in order. Takes time in proportion to the written size, so it is for formulas that
    /// are displayed.
    pub fn tidied(&mut self, root: ExprId) -> ExprId {
        let cuts = self.cuts(root, DEEPEST);
        let mut tidying = Tidying { graph: self, tidied: FxHashMap::default() };
        for id in cuts {
            tidying.tidy(id);
        }
        tidying.tidy(root)
    }

    /// Returns subexpressions at which a formula can be cut, inner ones first, so that at most `deepest` operations are nested between
    /// them; a chain of terms or factors counts as one. Recursive algorithms that handle the cuts in this order need little stack.
    #[must_use]
    pub fn cuts(&self, root: ExprId, deepest: u32) -> Vec<ExprId> {
        let mut heights: FxHashMap<ExprId, u32> = FxHashMap::default();
        let mut cuts = Vec::new();
        for id in self.reachable(&[root]) {
            let node = self.node(id);
            let above = |child: &ExprId| heights[child] + u32::from(!is_one_chain(node, self.node(*child)));
            let height = node.children().as_slice().iter().map(above).max().unwrap_or(0);
            let is_cut = height >= deepest && id != root;
            if is_cut {
                cuts.push(id);
            }
            heights.insert(id, if is_cut { 0 } else { height });
        }
        cuts
    }
}

/// Returns whether an operand belongs to one chain of terms or factors with its operation.
fn is_one_chain(node: Node, operand: Node) -> bool {
    use Node::{Add, Div, Mul, Neg, Sub};
    match node {
        Add(..) | Sub(..) => matches!(operand, Add(..) | Sub(..) | Neg(_)),
        Mul(..) | Div(..) => matches!(operand, Mul(..) | Div(..) | Neg(_)),
        _ => false,
    }
}

struct Tidying<'g> {
    graph: &'g mut Graph,
    tidied: FxHashMap<ExprId, ExprId>,
}

/// Terms with their coefficients, in the order of their first occurrence, and the sum of all numbers.
#[derive(Default)]
struct Sum {
    terms: Vec<(f64, ExprId)>,
    positions: FxHashMap<ExprId, usize>,
    number: f64,
}

/// Factors with their exponents, in the order of their first occurrence, and all numbers as a fraction. Numerator and denominator are kept apart.
struct Product {
    factors: Vec<(ExprId, i32)>,
    above: f64,
    below: f64,
}

impl Tidying<'_> {
    fn tidy(&mut self, id: ExprId) -> ExprId {
        if let Some(&tidied) = self.tidied.get(&id) {
            return tidied;
        }
        let tidied = self.tidy_node(id);
        self.tidied.insert(id, tidied);
        tidied
    }

    fn tidy_node(&mut self, id: ExprId) -> ExprId {
        let gathered = match self.graph.node(id) {
            Node::Add(..) | Node::Sub(..) | Node::Neg(_) => {
                let sum = self.sum(id);
                self.build_sum(sum)
            }
            Node::Mul(..) | Node::Div(..) | Node::Power(..) => {
                self.product(id).and_then(|product| self.build_product(product))
            }
            _ => None,
        };
        gathered.unwrap_or_else(|| self.rebuilt(id))
    }

    /// Returns the operation on tidied operands.
    fn rebuilt(&mut self, id: ExprId) -> ExprId {
        let node = self.graph.node(id);
        for &child in node.children().as_slice() {
            self.tidy(child);
        }
        let tidied = &self.tidied;
        self.graph.rebuild(node, |child| tidied.get(&child).copied().unwrap_or(child))
    }

    fn sum(&mut self, root: ExprId) -> Sum {
        let mut sum = self.terms_of(root);
        // a number is multiplied into a sum where that lets terms be gathered
        while let Some(at) = self.worth_multiplying_out(&sum) {
            let (c, term) = sum.take(at);
            let (scale, inner) = self.scaled_sum(term).unwrap_or((1.0, term));
            let parts = self.terms_of(inner);
            sum.number += c * scale * parts.number;
            for (part, id) in parts.terms {
                sum.put(c * scale * part, id);
            }
        }
        sum.terms.retain(|&(c, _)| c != 0.0);
        sum
    }

    /// Returns the tidied terms of the outermost sum.
    fn terms_of(&mut self, root: ExprId) -> Sum {
        let mut sum = Sum::default();
        // each with its coefficient, and whether it has been tidied
        let mut open = vec![(root, 1.0, self.tidied.get(&root) == Some(&root))];
        while let Some((id, c, is_tidy)) = open.pop() {
            match self.graph.node(id) {
                Node::Add(a, b) => open.extend([(b, c, is_tidy), (a, c, is_tidy)]),
                Node::Sub(a, b) => open.extend([(b, -c, is_tidy), (a, c, is_tidy)]),
                Node::Neg(a) => open.push((a, -c, is_tidy)),
                Node::Const(bits) => sum.number += c * f64::from_bits(bits),
                _ if !is_tidy => open.push((self.tidy(id), c, true)),
                _ => {
                    let (scale, term) = self.split(id);
                    sum.put(c * scale, term);
                }
            }
        }
        sum
    }

    /// Splits a term into a sum and its factor: 1, or the inverse of a divisor if it is exact.
    fn scaled_sum(&self, term: ExprId) -> Option<(f64, ExprId)> {
        let (scale, sum) = match self.graph.node(term) {
            Node::Div(a, b) => (1.0 / self.graph.as_const(b)?, a),
            _ => (1.0, term),
        };
        // a power of two has no fraction bits
        let is_exact = scale.is_normal() && scale.to_bits().trailing_zeros() >= 52;
        let is_sum = matches!(self.graph.node(sum), Node::Add(..) | Node::Sub(..));
        (is_exact && is_sum).then_some((scale, sum))
    }

    /// Returns the position of a term that is a sum and shares one of its terms with another one.
    fn worth_multiplying_out(&mut self, sum: &Sum) -> Option<usize> {
        let parts: Vec<Vec<ExprId>> = sum
            .terms
            .iter()
            .map(|&(_, term)| match self.scaled_sum(term) {
                Some((_, inner)) => self.terms_of(inner).terms.into_iter().map(|(_, id)| id).collect(),
                None => vec![term],
            })
            .collect();
        let mut uses: FxHashMap<ExprId, u32> = FxHashMap::default();
        for &part in parts.iter().flatten() {
            *uses.entry(part).or_default() += 1;
        }
        let shares = |part: &ExprId| uses.get(part).is_some_and(|&uses| uses > 1);
        sum.terms
            .iter()
            .zip(&parts)
            .position(|(&(_, term), parts)| self.scaled_sum(term).is_some() && parts.iter().any(shares))
    }

    /// Splits a term into a number and the rest; from a quotient only the sign is taken.
    fn split(&mut self, id: ExprId) -> (f64, ExprId) {
        match self.graph.node(id) {
            Node::Mul(a, b) => match self.graph.as_const(a) {
                Some(c) => (c, b),
                None => (1.0, id),
            },
            Node::Div(a, b) => {
                let (c, _) = match self.graph.as_const(a) {
                    Some(c) => (c, a),
                    None => self.split(a),
                };
                if c < 0.0 {
                    let above = self.graph.neg(a);
                    (-1.0, self.graph.div(above, b))
                } else {
                    (1.0, id)
                }
            }
            _ => (1.0, id),
        }
    }

    /// Builds a sum; `None` if a number has overflowed.
    fn build_sum(&mut self, mut sum: Sum) -> Option<ExprId> {
        if !sum.number.is_finite() || sum.terms.iter().any(|(c, _)| !c.is_finite()) {
            return None;
        }
        if let Some(quotient) = self.over_one_line(&sum) {
            return Some(quotient);
        }
        let first = sum.terms.iter().position(|&(c, _)| c > 0.0);
        if let Some(first) = first {
            sum.terms[..=first].rotate_right(1);
        }
        let number = self.graph.constant(sum.number);
        // `6 - t` rather than `-t + 6`
        let leads = first.is_none() && sum.number > 0.0;
        let mut total = if leads { number } else { self.graph.constant(0.0) };
        for (c, term) in sum.terms {
            let size = self.graph.constant(c.abs());
            let mut term = self.graph.mul(size, term);
            if matches!(self.graph.node(term), Node::Mul(_, b) if matches!(self.graph.node(b), Node::Div(..))) {
                // `2 * t / 3` rather than `2 * (t / 3)`
                term = self.tidy(term);
            }
            total = match (c < 0.0, self.graph.as_const(total)) {
                (false, _) => self.graph.add(total, term),
                (true, Some(0.0)) => self.negated(term),
                (true, _) => self.graph.sub(total, term),
            };
        }
        Some(if leads { total } else { self.graph.add(total, number) })
    }

    /// Returns a sum of quotients with one divisor as a single quotient.
    fn over_one_line(&mut self, sum: &Sum) -> Option<ExprId> {
        let divisor = |id: ExprId| match self.graph.node(id) {
            Node::Div(_, b) => Some(b),
            _ => None,
        };
        let below = divisor(sum.terms.first()?.1)?;
        if sum.terms.len() < 2 || sum.number != 0.0 || sum.terms.iter().any(|&(_, id)| divisor(id) != Some(below)) {
            return None;
        }
        let mut above = self.graph.constant(0.0);
        for &(c, id) in &sum.terms {
            let Node::Div(term, _) = self.graph.node(id) else { return None };
            let c = self.graph.constant(c);
            let term = self.graph.mul(c, term);
            above = self.graph.add(above, term);
        }
        let above = self.tidy(above);
        let quotient = self.graph.div(above, below);
        // the tidied numerator may have a numeric factor
        Some(self.tidy(quotient))
    }

    /// Returns `-1 / t` rather than `-(1 / t)`.
    fn negated(&mut self, id: ExprId) -> ExprId {
        match self.graph.node(id) {
            Node::Div(a, b) if self.graph.as_const(a).is_some() || self.split(a).1 != a => {
                let above = self.graph.neg(a);
                self.graph.div(above, b)
            }
            _ => self.graph.neg(id),
        }
    }

    /// Returns the factors of a product; `None` if it is better left as it is.
    fn product(&mut self, root: ExprId) -> Option<Product> {
        let mut product = Product { factors: Vec::new(), above: 1.0, below: 1.0 };
        // each with its exponent, and whether it has been tidied
        let mut open = vec![(root, 1_i32, false)];
        while let Some((id, e, is_tidy)) = open.pop() {
            match self.graph.node(id) {
                Node::Mul(a, b) if e.abs() == 1 || self.has_whole_number(id) => {
                    open.extend([(b, e, is_tidy), (a, e, is_tidy)]);
                }
                Node::Div(a, b) if e > 0 => open.extend([(b, -e, is_tidy), (a, e, is_tidy)]),
                Node::Neg(a) => {
                    product.above *= if e % 2 == 0 { 1.0 } else { -1.0 };
                    open.push((a, e, is_tidy));
                }
                Node::Power(a, n) if e == 1 || n > 0 => open.push((a, e * n, is_tidy)),
                Node::Const(bits) => {
                    let size = crate::math::whole_power(f64::from_bits(bits), e.unsigned_abs());
                    *(if e > 0 { &mut product.above } else { &mut product.below }) *= size;
                }
                _ if !is_tidy => open.push((self.tidy(id), e, true)),
                _ => product.put(id, e),
            }
            if open.iter().any(|&(_, e, _)| e.abs() > LARGEST_EXPONENT) {
                return None;
            }
        }
        product.is_sound().then_some(product)
    }

    /// Returns whether a product contains a number whose powers are easy to read.
    fn has_whole_number(&self, id: ExprId) -> bool {
        match self.graph.node(id) {
            Node::Mul(a, _) => self.graph.as_const(a).is_some_and(|c| c.fract() == 0.0 && c.abs() < 1e3),
            _ => false,
        }
    }

    /// Multiplies a power into a polynomial of the same base, as Horner's rule leaves it.
    fn build_polynomial(&mut self, product: &Product) -> Option<ExprId> {
        let &[(x, e), (y, f)] = product.factors.as_slice() else { return None };
        let is_sum = |id: ExprId| matches!(self.graph.node(id), Node::Add(..) | Node::Sub(..));
        let (base, e, sum) = match (e, f) {
            (e, 1) if e > 0 && is_sum(y) => (x, e, y),
            (1, f) if f > 0 && is_sum(x) => (y, f, x),
            _ => return None,
        };
        let terms = self.terms_of(sum);
        let is_power =
            |id: ExprId| id == base || matches!(self.graph.node(id), Node::Power(x, n) if x == base && n > 0);
        let is_whole = product.below.to_bits() == 1.0_f64.to_bits();
        if !is_whole || terms.terms.is_empty() || !terms.terms.iter().all(|&(_, id)| is_power(id)) {
            return None;
        }
        let power = self.graph.power(base, e);
        let mut raised = Sum::default();
        for (c, id) in terms.terms {
            let id = self.graph.mul(id, power);
            raised.put(c * product.above, id);
        }
        raised.put(terms.number * product.above, power);
        raised.terms.retain(|&(c, _)| c != 0.0);
        self.build_sum(raised)
    }

    fn build_product(&mut self, mut product: Product) -> Option<ExprId> {
        product.reduce();
        if let Some(polynomial) = self.build_polynomial(&product) {
            return Some(polynomial);
        }
        let graph = &*self.graph;
        // long factors come last
        product.factors.sort_by_key(|&(id, _)| match graph.node(id) {
            Node::Symbol(_) => 0,
            Node::Add(..) | Node::Sub(..) | Node::Select(..) => 2,
            _ => 1,
        });
        let above = self.row(&product, true)?;
        let below = self.row(&product, false)?;
        let (number, divisor) = (self.graph.constant(product.above), self.graph.constant(product.below));
        let above = self.graph.mul(number, above);
        let below = self.graph.mul(divisor, below);
        Some(self.graph.div(above, below))
    }

    /// Returns the product of the factors of the numerator or of the denominator.
    fn row(&mut self, product: &Product, above: bool) -> Option<ExprId> {
        let mut row = self.graph.constant(1.0);
        for &(id, e) in product.factors.iter().filter(|(_, e)| (*e > 0) == above) {
            if e.abs() > LARGEST_EXPONENT {
                return None;
            }
            let power = self.graph.power(id, e.abs());
            row = self.graph.mul(row, power);
        }
        Some(row)
    }
}

impl Sum {
    fn put(&mut self, c: f64, term: ExprId) {
        let present = self.positions.get(&term).and_then(|&position| self.terms.get_mut(position));
        if let Some((coefficient, _)) = present {
            *coefficient += c;
        } else {
            self.positions.insert(term, self.terms.len());
            self.terms.push((c, term));
        }
    }

    /// Removes a term and returns it with its coefficient.
    fn take(&mut self, at: usize) -> (f64, ExprId) {
        let taken = self.terms.remove(at);
        self.positions = self.terms.iter().enumerate().map(|(k, &(_, term))| (term, k)).collect();
        taken
    }
}

impl Product {
    fn put(&mut self, id: ExprId, exponent: i32) {
        // a factor of the numerator may be zero where one of the denominator is, so they are not cancelled
        let same = |&&mut (factor, e): &&mut (ExprId, i32)| factor == id && (e > 0) == (exponent > 0);
        match self.factors.iter_mut().find(same) {
            Some((_, e)) => *e += exponent,
            None => self.factors.push((id, exponent)),
        }
    }

    fn is_sound(&self) -> bool {
        let is_number = |x: f64| x.is_finite() && x != 0.0;
        is_number(self.above) && is_number(self.below)
    }

    /// Reduces the fraction of numbers: to one number if that is as short, and exact.
    fn reduce(&mut self) {
        if self.below < 0.0 {
            (self.above, self.below) = (-self.above, -self.below);
        }
        self.reduce_whole();
        let quotient = self.above / self.below;
        let as_short = number(quotient).len() <= number(self.above).len() + number(self.below).len();
        if (quotient * self.below).to_bits() == self.above.to_bits() && as_short && quotient.is_normal() {
            (self.above, self.below) = (quotient, 1.0);
        }
    }

    /// Reduces `2 / 6` to `1 / 3`.
    fn reduce_whole(&mut self) {
        let is_whole = |x: f64| x.fract() == 0.0 && x.abs() < LARGEST_WHOLE;
        if !is_whole(self.above) || !is_whole(self.below) {
            return;
        }
        let (mut a, mut b) = (self.above.abs(), self.below);
        while b != 0.0 {
            (a, b) = (b, a % b);
        }
        (self.above, self.below) = (self.above / a, self.below / a);
    }
}
