//! Elementary functions, and numerics that several crates share.
//!
//! Every number on its way to a table passes through these functions and `+ - * /`, which IEEE 754 fixes to the bit. The standard library's
//! `sin` and the like differ between platforms, so they are forbidden elsewhere (`clippy.toml`). Angles are in radians. The numerics are
//! curves between the ends of a step, searches in an interval, and linear equations in blocks.

mod curve;
#[cfg(test)]
mod curve_tests;
#[cfg(test)]
mod grid_tests;
mod hermite_weights;
mod search;
#[cfg(test)]
mod search_tests;
mod sin_cos_lanes;
mod vectors;

pub use curve::{
    about, along, between, cubic, farthest, integral_of_quintic, parabola, predicted, quintic, value_and_derivatives,
};
pub use hermite_weights::{slope_weights, weigh};
pub use mechc_runtime::neighbours::bisect;
pub use mechc_runtime::sine_and_cosine::{A_MILLION, sin_cos};
pub use mechc_runtime::{blocks, grid, hermite, neighbours};
pub use search::{GOLDEN, GoldenSection, Halving, boundary, enclose_root, median};
pub use sin_cos_lanes::sin_cos_lanes;
pub use vectors::{Vectors, WIDE, numbers_to_cache_line};

/// Returns the largest power of two that is not above a positive number.
#[must_use]
pub fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
}

/// Returns the sine of an angle (rad).
#[must_use]
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// Returns the cosine of an angle (rad).
#[must_use]
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// Returns the tangent of an angle (rad).
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Returns the arc sine, in [−π/2, π/2].
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Returns the arc cosine, in [0, π].
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Returns the arc tangent, in (−π/2, π/2).
#[must_use]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// Returns the direction of the vector (x, y), in (−π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Returns the hyperbolic sine.
#[must_use]
pub fn sinh(x: f64) -> f64 {
    libm::sinh(x)
}

/// Returns the hyperbolic cosine.
#[must_use]
pub fn cosh(x: f64) -> f64 {
    libm::cosh(x)
}

/// Returns the hyperbolic tangent.
#[must_use]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// Returns the exponential function.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Returns the natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Returns the logarithm to base 10.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// Returns the square root, which IEEE 754 fixes to the bit.
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Returns the length of the vector (x, y), without intermediate overflow.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// Returns `x` to the power `y`.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// Returns `x` to a whole power by repeated squaring, with the same sequence of products as programs and emitted code.
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

/// Returns the largest whole number not above `x`.
#[must_use]
pub fn floor(x: f64) -> f64 {
    x.floor()
}

/// Returns `a − b·⌊a/b⌋`.
#[must_use]
pub fn modulo(a: f64, b: f64) -> f64 {
    a - b * floor(a / b)
}

/// Returns the sign of `x`: −1, 0 or 1; NaN for NaN.
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

/// Returns the smaller number; NaN if either is NaN.
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

/// Returns the larger number; NaN if either is NaN.
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    /// Returns the distance in units of the last place of `b`.
    fn ulps(a: f64, b: f64) -> f64 {
        let ulp = f64::from_bits((b.abs().max(f64::MIN_POSITIVE)).to_bits() + 1) - b.abs();
        ((a - b) / ulp).abs()
    }

    #[test]
    fn sine_and_cosine_are_within_an_ulp_of_another_implementation() {
        let mut state = 1_u64;
        for k in 0..400_000_u32 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let x = match k % 4 {
                // near multiples of a quarter turn, of everyday size, up to a few million, of any size
                0 => f64::from(k / 4) * std::f64::consts::FRAC_PI_2,
                1 => (state >> 11) as f64 / (1_u64 << 53) as f64 * 20.0 - 10.0,
                2 => (state >> 11) as f64 / (1_u64 << 53) as f64 * 4e6 - 2e6,
                _ => f64::from_bits(state),
            };
            if !x.is_finite() {
                continue;
            }
            let (sin, cos) = sin_cos(x);
            // both implementations are within one ulp of the true value
            assert!(ulps(sin, libm::sin(x)) <= 2.0, "sin({x:e}): {sin:e} and {:e}", libm::sin(x));
            assert!(ulps(cos, libm::cos(x)) <= 2.0, "cos({x:e}): {cos:e} and {:e}", libm::cos(x));
        }
    }

    #[test]
    fn angles_that_are_not_finite_give_nan() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(x).0.is_nan() && sin_cos(x).1.is_nan());
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }
}
