//! Mechanisms as text that no file holds: with rims, with equations that follow from others, and a large one.

use std::f64::consts::TAU;

/// A scissor lift of so many cells, driven at its upper end: one block, whose loop is too long for one function.
pub fn scissor_lift(cells: usize) -> String {
    let (sin, cos) = mechc_expr::math::sin_cos(0.5);
    let mut text = "mechanism lift {\n ground { point O = (0, 0) axis floor = O along (1, 0) }\n".to_owned();
    for k in 0..cells {
        let y = (k as f64 + 0.5) * sin;
        for (bar, x, phi) in [("a", 0.5 * cos + 0.003, 0.5), ("b", 0.5 * cos, -0.5)] {
            text += &format!(
                " body {bar}{k} at ({x}, {y}, {phi}) {{ point L = (-0.5, 0) point M = (0, 0) point R = (0.5, 0) }}\n"
            );
        }
        text += &format!(" joint m{k}: revolute(a{k}.M, b{k}.M)\n");
    }
    for (k, next) in (1..cells).enumerate() {
        text += &format!(" joint l{k}: revolute(b{k}.L, a{next}.L)\n joint r{k}: revolute(a{k}.R, b{next}.R)\n");
    }
    text += " joint base: revolute(ground.O, a0.L)\n joint roll: revolute_translational(b0.R, ground.floor)\n";
    let (top, height) = (cells - 1, cells as f64 * sin);
    text + &format!(" driver lift: y(a{top}.R) = {height} + 0.1 * sin(t)\n analysis from 0 to 1 every 0.1\n}}")
}

/// Formulas that come to the end of what their functions take, smoothly and not, and measures that have no value at times.
pub fn with_rims() -> Vec<(String, String)> {
    let formulas = [
        ("root", "0.3 * sqrt((t - 0.70013)^2)"),
        ("arc", "0.1 * acos(cos(3 * (t - 0.70013)))"),
        ("cusp", "((t - 0.70013)^2)^0.25"),
        ("hidden", "(t - 0.70013) * sqrt((t - 0.70013)^2 + 1e-6)"),
        ("smooth", "sqrt((t - 0.70013)^4) + 0.1 * hypot((t - 1.1)^2, (t - 1.10007)^3)"),
        ("steep", "if t < 0.5 then 0.2 * abs(t - 1) else 0.1 + 0.2 * (0.5 - t) + (t - 0.5)^2 * sqrt((t - 0.9001)^2)"),
    ];
    let all = formulas.iter().map(|(name, formula)| {
        let text = format!(
            "mechanism slide {{
                ground {{ axis way = (0, 0) along (1, 0) }}
                body block {{ axis way = (0, 0) along (1, 0) }}
                joint guide: translational(ground.way, block.way)
                table bend = spline [(0, 0), (0.5, 1), (0.95, 0)]
                driver push: displacement(guide) = {formula}
                measure left = bend(t)
                measure pole = 1 / (t - 0.5)
                analysis from 0 s to 2 s every 0.1 s
            }}"
        );
        (format!("rim_{name}"), text)
    });
    all.collect()
}

/// A cam whose curve begins a new part just where the analysis ends: the last row is one of the part before it.
pub fn ends_at_an_edge() -> String {
    let lift = "40 mm + harmonic(mod(-u, 360 deg), 90 deg, 0 mm, 180 deg, 20 mm) \
                - harmonic(mod(-u, 360 deg), 270 deg, 0 mm, 360 deg, 20 mm)";
    format!(
        "mechanism ends_at_an_edge {{
    ground {{ point O = (0, 0)  axis way = O along (0, 1) }}
    body cam {{ point O = (0, 0)  curve pitch(u) = (({lift}) * -sin(u), ({lift}) * cos(u)) at 0 deg }}
    body rod at (0, 40 mm, 0) {{ point c = (0, 0)  axis way = c along (0, 1) }}
    joint axle: revolute(ground.O, cam.O)
    joint guide: translational(ground.way, rod.way)
    joint touch: point_follower(rod.c, cam.pitch)
    driver motor: rotation(axle) = 1 rev/s * t
    analysis from 0 s to 1 s every 0.05 s
}}"
    )
}

/// A planetary gear with so many planets, of which one would do.
pub fn planets(count: usize, random: &[f64]) -> String {
    let (sun, planet, turn) = (24.0 + 8.0 * random[0], 18.0 + 6.0 * random[1], 40.0 * random[2]);
    let (arm, ring) = (sun + planet, sun + 2.0 * planet);
    let mut text = format!(
        "mechanism planets {{\n ground {{ point O = (0, 0) circle ring = O radius {ring} mm }}
 body sun at (0, 0, {turn} deg) {{ point O = (0, 0) circle c = O radius {sun} mm }}
 joint axle: revolute(ground.O, sun.O)\n joint hub: revolute(ground.O, carrier.O)
 driver motor: rotation(axle) = {turn} deg + 300 deg/s * t + 20 deg * sin(7 rad/s * t)
 measure spin = angle(p0) - angle(carrier)\n analysis from 0 s to 0.6 s every 50 ms\n"
    );
    let mut pins = String::new();
    for k in 0..count {
        let (sin, cos) = mechc_expr::math::sin_cos(TAU * k as f64 / count as f64);
        let (x, y) = (arm * cos, arm * sin);
        pins += &format!(" point pin{k} = ({x} mm, {y} mm)");
        text += &format!(
            " body p{k} at ({x} mm, {y} mm, {} deg) {{ point O = (0, 0) circle c = O radius {planet} mm }}
 joint pin{k}: revolute(carrier.pin{k}, p{k}.O)
 joint outer{k}: gear(sun.c, p{k}.c)\n joint inner{k}: internal_gear(ground.ring, p{k}.c)\n",
            90.0 * random[3 + k]
        );
    }
    text + &format!(" body carrier at (0, 0, 0) {{ point O = (0, 0){pins} }}\n}}\n")
}

/// A seat on so many parallel cranks, of which two would do.
pub fn cranks(count: usize, random: &[f64]) -> String {
    let (length, turn) = (0.3 + 0.1 * random[0], 60.0 + 10.0 * random[1]);
    let (mut ground, mut seat, mut rest) = (String::new(), String::new(), String::new());
    let (sin, cos) = mechc_expr::math::sin_cos(turn.to_radians());
    for k in 0..count {
        let (x, y) = (k as f64 + 0.3 * random[2 + k], 0.4 * random[7 - k]);
        ground += &format!(" point P{k} = ({x} m, {y} m)");
        seat += &format!(" point P{k} = ({x} m, {y} m)");
        rest += &format!(
            " body c{k} at ({x} m, {y} m, {turn} deg) {{ point O = (0, 0) point P = (r, 0) }}
 joint low{k}: revolute(ground.P{k}, c{k}.O)\n joint high{k}: revolute(c{k}.P, seat.P{k})\n"
        );
    }
    format!(
        "mechanism cranks {{\n param r = {length} m\n ground {{{ground} }}
 body seat at ({} m, {} m, 0) {{{seat} }}\n{rest} driver motor: rotation(low0) = {turn} deg + 50 deg * sin(3 rad/s * t)
 analysis from 0 s to 1 s every 0.1 s\n}}\n",
        length * cos,
        length * sin,
    )
}
