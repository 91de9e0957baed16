/// The second if the first is not 0, else the third.
fn select(condition: f64, a: f64, b: f64) -> f64 {
    if condition == 0.0 { b } else { a }
}

/// As `select`, but not a number if either is not.
fn either(condition: f64, a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if condition == 0.0 {
        b
    } else {
        a
    }
}

/// The piece of a table that `x` lies in, counted from 0.
fn piece(x: f64, knots: &[f64]) -> f64 {
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

/// The entry of a column for a piece.
fn pick(column: &[f64], piece: f64) -> f64 {
    if piece.is_nan() {
        return piece;
    }
    column.get(piece as usize).copied().unwrap_or(f64::NAN)
}

/// -1, 0 or 1; 0 at 0.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}

/// The smaller one; not a number if either is not.
fn lesser(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

/// The larger one; not a number if either is not.
fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
