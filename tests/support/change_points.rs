//! Texts of linkages that pass change points.

use mechc_expr::math;

/// Returns a crank and a rod of equal length with a driver and measures.
pub fn equal_rods(length: f64, angle: &str, start: f64, analysis: &str) -> String {
    let (sin, cos) = math::sin_cos(start);
    let (x, y) = (length * cos, length * sin);
    format!(
        "mechanism equal {{
            ground {{ point O = (0, 0) axis way = O along (1, 0) }}
            body crank at (0, 0, {start}) {{ point O = (0, 0) point P = ({length}, 0) }}
            body rod at ({x}, {y}, {}) {{ point P = (0, 0) point W = ({length}, 0) point side = (0.3, 0.2) }}
            body slider at ({}, 0, 0) {{ point W = (0, 0) axis way = W along (1, 0) }}
            joint A: revolute(ground.O, crank.O)
            joint B: revolute(crank.P, rod.P)
            joint C: revolute(rod.W, slider.W)
            joint D: translational(ground.way, slider.way)
            driver turn: rotation(A) = {angle}
            {analysis}
        }}",
        -start,
        2.0 * x
    )
}

/// Returns a parallelogram with a driver.
pub fn parallelogram(length: f64, base: f64, angle: &str, start: f64, analysis: &str) -> String {
    let (sin, cos) = math::sin_cos(start);
    format!(
        "mechanism parallelogram {{
            ground {{ point A = (0, 0) point B = ({base}, 0) }}
            body crank at (0, 0, {start}) {{ point A = (0, 0) point C = ({length}, 0) }}
            body coupler at ({}, {}, 0) {{ point C = (0, 0) point D = ({base}, 0) point side = (0.3, 0.2) }}
            body rocker at ({base}, 0, {start}) {{ point B = (0, 0) point D = ({length}, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint C: revolute(crank.C, coupler.C)
            joint D: revolute(coupler.D, rocker.D)
            joint B: revolute(ground.B, rocker.B)
            driver turn: rotation(A) = {angle}
            {analysis}
        }}",
        length * cos,
        length * sin
    )
}

/// Returns a parallelogram whose crank is a param and whose rotation is an input: it folds 1.5 s after its start, at half a turn.
pub fn parallelogram_of_names(declarations: &str) -> String {
    format!(
        "mechanism m {{
    param crank_length = 1 m
    input turn = 45 deg + 90 deg/s * t
    ground {{ point A = (0, 0)  point B = (2 m, 0) }}
    body crank at (0, 0, 45 deg) {{ point A = (0, 0)  point C = (crank_length, 0) }}
    body coupler at (0.7 m, 0.7 m, 0) {{ point C = (0, 0)  point D = (2 m, 0) }}
    body rocker at (2 m, 0, 45 deg) {{ point B = (0, 0)  point D = (1 m, 0) }}
    joint A: revolute(ground.A, crank.A)
    joint C: revolute(crank.C, coupler.C)
    joint D: revolute(coupler.D, rocker.D)
    joint B: revolute(ground.B, rocker.B)
    driver motor: rotation(A) = turn
    {declarations}
}}"
    )
}
