//! Weights of Hermite interpolation, to extrapolate a motion that is known at several times.

/// Computes the weights of value, slope and second derivative at distinct times (s) for the value at time `t`, on the polynomial of least
/// degree through all of them (C. Hermite, Sur la formule d'interpolation de Lagrange, 1878).
///
/// With `d` the time since a node, and `s` and `r` the first and second derivative of its Lagrange polynomial `L` at the node, the weights
/// are `L³ (1 − 3 s d + (6 s² − 3/2 r) d²)`, `L³ (d − 3 s d²)` and `L³ d² / 2`.
pub fn weigh(nodes: &[f64], t: f64, weights: &mut [[f64; 3]]) {
    for (k, (&node, weights)) in nodes.iter().zip(weights).enumerate() {
        let (d, [lagrange, s, r]) = (t - node, lagrange_polynomial(nodes, k, t));
        let (cube, bend) = (lagrange * lagrange * lagrange, 6.0 * s * s - 1.5 * r);
        *weights = [cube * (1.0 + d * (d * bend - 3.0 * s)), cube * d * (1.0 - 3.0 * s * d), 0.5 * cube * d * d];
    }
}

/// Computes the weights without second derivatives: `L² (1 − 2 s d)` for the value, `L² d` for the slope and 0; see [`weigh`].
pub fn slope_weights(nodes: &[f64], t: f64, weights: &mut [[f64; 3]]) {
    for (k, (&node, weights)) in nodes.iter().zip(weights).enumerate() {
        let (d, [lagrange, s, _]) = (t - node, lagrange_polynomial(nodes, k, t));
        let square = lagrange * lagrange;
        *weights = [square * (1.0 - 2.0 * s * d), square * d, 0.0];
    }
}

/// Returns the Lagrange polynomial of a node at time `t`, and its first and second derivative at the node.
fn lagrange_polynomial(nodes: &[f64], k: usize, t: f64) -> [f64; 3] {
    let (mut lagrange, mut s, mut squares) = (1.0, 0.0, 0.0);
    for (_, &other) in nodes.iter().enumerate().filter(|&(other, _)| other != k) {
        let per = 1.0 / (nodes[k] - other);
        lagrange *= (t - other) * per;
        s += per;
        squares += per * per;
    }
    [lagrange, s, s * s - squares]
}

#[cfg(test)]
mod tests {
    use super::{slope_weights, weigh};

    /// Returns a polynomial of some degree with its first and second derivative.
    fn polynomial(degree: u32, t: f64) -> [f64; 3] {
        let [mut value, mut slope, mut half_bend] = [0.0; 3];
        for k in (0..=degree).rev() {
            half_bend = half_bend * t + slope;
            slope = slope * t + value;
            value = value * t + 1.0 / f64::from(k + 2);
        }
        [value, slope, 2.0 * half_bend]
    }

    #[test]
    fn polynomials_are_extrapolated_exactly() {
        for (nodes, t) in
            [(&[0.3][..], 0.7), (&[0.0, -0.4], 0.3), (&[0.1, -0.2, -0.45], 0.32), (&[0.0, -1.0, 0.5], -0.7)]
        {
            let mut weights = [[0.0; 3]; 3];
            weigh(nodes, t, &mut weights);
            check_polynomial(nodes, t, 3, &weights);
        }
        for (nodes, t) in [(&[0.3][..], 0.7), (&[0.0, -0.4], 0.3), (&[0.1, -0.2, -0.3, -0.45], 0.22)] {
            let mut weights = [[0.0; 3]; 4];
            slope_weights(nodes, t, &mut weights);
            check_polynomial(nodes, t, 2, &weights);
        }
    }

    /// Checks that the weights reproduce a polynomial of the largest degree that the data at the nodes determine.
    fn check_polynomial(nodes: &[f64], t: f64, data_per_node: u32, weights: &[[f64; 3]]) {
        let degree = data_per_node * nodes.len() as u32 - 1;
        let at_nodes = nodes.iter().map(|&node| polynomial(degree, node));
        let extrapolated: f64 =
            at_nodes.zip(weights).map(|(of, by)| of.into_iter().zip(by).map(|(x, w)| x * w).sum::<f64>()).sum();
        let exact = polynomial(degree, t)[0];
        assert!((extrapolated - exact).abs() <= 1e-12 * exact.abs().max(1.0), "{nodes:?}: {extrapolated} and {exact}");
    }
}
