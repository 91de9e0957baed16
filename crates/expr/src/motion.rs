//! Motion functions of cam and drive design, as formulas.
//!
//! Each rises from `v0` at `u0` to `v1` at `u1` and is constant outside: with `s = (u − u0)/(u1 − u0)` it is `v0 + (v1 − v0) f(s)`. At `u0`
//! and `u1` the piece that begins there is taken.

use super::{Comparison, ExprId, Graph, Unary};
use std::f64::consts::PI;

/// The law `f(s)` of a motion function.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MotionLaw {
    /// Cubic, `3s² − 2s³`.
    Step,
    /// Quintic, `10s³ − 15s⁴ + 6s⁵`.
    Step5,
    /// 4-5-6-7 polynomial, `35s⁴ − 84s⁵ + 70s⁶ − 20s⁷`.
    Step7,
    /// `(1 − cos πs)/2`
    Harmonic,
    /// `s − sin(2πs)/(2π)`
    Cycloidal,
    /// Modified sine: sections of a fast sine at both ends, and of a slow one between.
    ModifiedSine,
}

impl MotionLaw {
    const ALL: [MotionLaw; 6] = [
        MotionLaw::Step,
        MotionLaw::Step5,
        MotionLaw::Step7,
        MotionLaw::Harmonic,
        MotionLaw::Cycloidal,
        MotionLaw::ModifiedSine,
    ];

    /// Returns the word of the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            MotionLaw::Step => "step",
            MotionLaw::Step5 => "step5",
            MotionLaw::Step7 => "step7",
            MotionLaw::Harmonic => "harmonic",
            MotionLaw::Cycloidal => "cycloidal",
            MotionLaw::ModifiedSine => "modsine",
        }
    }

    /// Returns the law of a word.
    #[must_use]
    pub fn named(word: &str) -> Option<MotionLaw> {
        Self::ALL.into_iter().find(|law| law.word() == word)
    }
}

impl Graph {
    /// Returns a motion function from `v0` at `u0` to `v1` at `u1`, with `from = [u0, v0]` and `to = [u1, v1]`.
    pub fn motion(&mut self, law: MotionLaw, u: ExprId, from: [ExprId; 2], to: [ExprId; 2]) -> ExprId {
        let ([u0, v0], [u1, v1]) = (from, to);
        let offset = self.sub(u, u0);
        let length = self.sub(u1, u0);
        let s = self.div(offset, length);
        let f = match law {
            MotionLaw::Step => self.polynomial(s, &[0.0, 0.0, 3.0, -2.0]),
            MotionLaw::Step5 => self.polynomial(s, &[0.0, 0.0, 0.0, 10.0, -15.0, 6.0]),
            MotionLaw::Step7 => self.polynomial(s, &[0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0]),
            MotionLaw::Harmonic => {
                let (one, half) = (self.constant(1.0), self.constant(0.5));
                let cosine = self.wave(Unary::Cos, PI, s);
                let double = self.sub(one, cosine);
                self.mul(half, double)
            }
            MotionLaw::Cycloidal => {
                let scale = self.constant(1.0 / (2.0 * PI));
                let sine = self.wave(Unary::Sin, 2.0 * PI, s);
                let dip = self.mul(scale, sine);
                self.sub(s, dip)
            }
            MotionLaw::ModifiedSine => self.modified_sine(s),
        };
        let rise = self.sub(v1, v0);
        let risen = self.mul(rise, f);
        let between = self.add(v0, risen);
        let before = self.compare(Comparison::Less, u, u0);
        let within = self.compare(Comparison::Less, u, u1);
        let later = self.select(within, between, v1);
        self.select(before, v0, later)
    }

    /// Returns `Σ cₖ uᵏ`, by Horner's rule.
    pub fn polynomial_of(&mut self, u: ExprId, coefficients: &[ExprId]) -> ExprId {
        let zero = self.constant(0.0);
        coefficients.iter().rev().fold(zero, |sum, &c| {
            let raised = self.mul(sum, u);
            self.add(raised, c)
        })
    }

    fn polynomial(&mut self, s: ExprId, coefficients: &[f64]) -> ExprId {
        let ids: Vec<ExprId> = coefficients.iter().map(|&c| self.constant(c)).collect();
        self.polynomial_of(s, &ids)
    }

    /// Returns `f(ω s)`.
    fn wave(&mut self, function: Unary, omega: f64, s: ExprId) -> ExprId {
        let omega = self.constant(omega);
        let angle = self.mul(omega, s);
        self.unary(function, angle)
    }

    /// Returns the modified sine. With `k = 1/(4 + π)` it is `k(πs − sin(4πs)/4)` up to s = 1/8, `k(2 + πs − (9/4) sin((π + 4πs)/3))` up to
    /// 7/8, and then `k(4 + πs − sin(4πs)/4)`.
    fn modified_sine(&mut self, s: ExprId) -> ExprId {
        let [k, quarter, nine_quarters, pi] = [1.0 / (4.0 + PI), 0.25, 2.25, PI].map(|c| self.constant(c));
        let linear = self.mul(pi, s);
        let fast = self.wave(Unary::Sin, 4.0 * PI, s);
        let ripple = self.mul(quarter, fast);
        let ends = self.sub(linear, ripple);
        let [third, four_thirds, two, four] = [PI / 3.0, 4.0 * PI / 3.0, 2.0, 4.0].map(|c| self.constant(c));
        let turned = self.mul(four_thirds, s);
        let angle = self.add(third, turned);
        let slow = self.unary(Unary::Sin, angle);
        let swing = self.mul(nine_quarters, slow);
        let middle = self.sub(linear, swing);
        let middle = self.add(two, middle);
        let end = self.add(four, ends);
        let [eighth, seven_eighths] = [0.125, 0.875].map(|c| self.constant(c));
        let in_start = self.compare(Comparison::Less, s, eighth);
        let in_middle = self.compare(Comparison::Less, s, seven_eighths);
        let later = self.select(in_middle, middle, end);
        let shape = self.select(in_start, ends, later);
        self.mul(k, shape)
    }
}
