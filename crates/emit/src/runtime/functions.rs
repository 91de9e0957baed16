//! Functions of numbers. Each inner module is emitted by itself, where an operation calls it.

pub mod sign {
    //! The sign of a number.

    /// Returns -1, 0 or 1; 0 at 0.
    pub fn sign(x: f64) -> f64 {
        if x > 0.0 {
            1.0
        } else if x < 0.0 {
            -1.0
        } else {
            x
        }
    }
}

pub mod lesser {
    //! The smaller of two numbers.

    /// Returns the smaller number; NaN if either is NaN.
    pub fn lesser(a: f64, b: f64) -> f64 {
        if a.is_nan() || a < b { a } else { b }
    }
}

pub mod greater {
    //! The larger of two numbers.

    /// Returns the larger number; NaN if either is NaN.
    pub fn greater(a: f64, b: f64) -> f64 {
        if a.is_nan() || a > b { a } else { b }
    }
}

pub mod select {
    //! A choice.

    /// Returns `a` if the condition is not 0, else `b`.
    pub fn select(condition: f64, a: f64, b: f64) -> f64 {
        if condition == 0.0 { b } else { a }
    }
}

pub mod either {
    //! A choice between two values that must both be numbers.

    /// Selects as `select` does; NaN if either value is NaN.
    pub fn either(condition: f64, a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() {
            f64::NAN
        } else if condition == 0.0 {
            b
        } else {
            a
        }
    }
}

pub mod piece {
    //! Position of a number in a table.

    /// Returns the piece of a table that contains `x`, counted from 0.
    pub fn piece(x: f64, knots: &[f64]) -> f64 {
        if x.is_nan() {
            return x;
        }
        let (mut low, mut high) = (0, knots.len().saturating_sub(1));
        for _ in 0..usize::BITS {
            if high - low <= 1 {
                break;
            }
            let middle = low + (high - low) / 2;
            if knots.get(middle).is_some_and(|knot| *knot <= x) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low as f64
    }
}

pub mod pick {
    //! Entry of a table for a piece.

    /// Returns the entry of a column for a piece.
    pub fn pick(column: &[f64], piece: f64) -> f64 {
        if piece.is_nan() {
            return piece;
        }
        column.get(piece as usize).copied().unwrap_or(f64::NAN)
    }
}
