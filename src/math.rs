//! The only home of the elementary functions.
//!
//! Every number on its way to a table passes through these and through `+ - * /`, which IEEE 754 fixes to the bit;
//! the standard library's `sin` and its like do not give the same bits on every platform, so they are forbidden
//! elsewhere (`clippy.toml`). Angles are in radians.

/// Sine and cosine of one angle.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Sine.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Tangent.
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Arc sine, in [−π/2, π/2].
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Arc cosine, in [0, π].
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Arc tangent, in (−π/2, π/2).
#[must_use]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// Direction of the vector (x, y), in (−π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Hyperbolic sine.
#[must_use]
pub fn sinh(x: f64) -> f64 {
    libm::sinh(x)
}

/// Hyperbolic cosine.
#[must_use]
pub fn cosh(x: f64) -> f64 {
    libm::cosh(x)
}

/// Hyperbolic tangent.
#[must_use]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// Exponential function.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Logarithm to base 10.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// Square root; IEEE 754 fixes it to the bit.
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Length of the vector (x, y), without overflow on the way.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// `x` to the power `y`.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// `x` to a whole power by repeated squaring: the sequence of products that programs and emitted code use too.
#[must_use]
pub fn whole_power(x: f64, n: u32) -> f64 {
    if n == 0 {
        return 1.0;
    }
    let half = whole_power(x, n / 2);
    let square = half * half;
    match (n, n % 2) {
        (1, _) => x,
        (_, 0) => square,
        _ => square * x,
    }
}

/// The largest whole number not above `x`.
#[must_use]
pub fn floor(x: f64) -> f64 {
    x.floor()
}

/// −1, 0 or 1; 0 at 0.
#[must_use]
pub fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}

/// The smaller one; not a number if either is not.
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

/// The larger one; not a number if either is not.
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
