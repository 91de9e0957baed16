// The quintic through two states of which value, velocity and acceleration are known (Hermite).

/// The coefficients of the third, fourth and fifth power of a curve in the part of its step, by what its parabola at the beginning
/// leaves at the end of value, slope and half the curvature, all by the part of the step.
#[must_use]
#[inline]
pub fn higher_terms([value, slope, bend]: [f64; 3]) -> [f64; 3] {
    let cubic = 10.0 * value - 4.0 * slope + bend;
    let quartic = -15.0 * value + 7.0 * slope - 2.0 * bend;
    let quintic = 6.0 * value - 3.0 * slope + bend;
    [cubic, quartic, quintic]
}

/// What the motion since a state that lies a time `back` before adds to the parabola of now, `u` times as long ahead as that is back. A
/// state is value, velocity and acceleration.
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
