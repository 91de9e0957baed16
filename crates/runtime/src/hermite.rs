// The quintic through two states of which value, velocity and acceleration are known (Hermite).

/// Returns the coefficients of the third, fourth and fifth power of the quintic in the fraction of its step. The arguments are what the
/// initial parabola lacks at the end in value, slope and half the curvature, with respect to that fraction.
#[must_use]
#[inline]
pub fn higher_terms([value, slope, bend]: [f64; 3]) -> [f64; 3] {
    let cubic = 10.0 * value - 4.0 * slope + bend;
    let quartic = -15.0 * value + 7.0 * slope - 2.0 * bend;
    let quintic = 6.0 * value - 3.0 * slope + bend;
    [cubic, quartic, quintic]
}

/// Returns what the quintic through the current state and the one a time `back` before adds to the current parabola, a time `u * back`
/// ahead. A state is value, velocity and acceleration.
#[must_use]
#[inline]
pub fn bend_ahead([x, v, a]: [f64; 3], [y, w, b]: [f64; 3], back: f64, u: f64) -> f64 {
    // the curve leads back from now
    let value = y - x + back * (v - 0.5 * back * a);
    let slope = back * (v - back * a - w);
    let bend = 0.5 * back * back * (b - a);
    let [cubic, quartic, quintic] = higher_terms([value, slope, bend]);
    u * u * u * (u * (quartic - u * quintic) - cubic)
}
