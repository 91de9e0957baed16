//! The four-bar by hand: the floor.

use mechc_expr::math;

/// The crank at the start [rad], and how fast it turns [rad/s].
const START: f64 = 0.5;
const SPEED: f64 = 2.0;
// lengths [m]
const GROUND: f64 = 4.0;
const CRANK: f64 = 1.0;
const COUPLER: f64 = 3.5;
const ROCKER: f64 = 3.0;

/// q, q̇, q̈ of crank, coupler and rocker: the columns of a row but for the time.
pub type Row = [f64; 27];

/// The two circles about the crank's pin and the rocker's pivot meet at the knee; the rates follow from two equations.
pub fn closed_form(t: f64) -> Row {
    let theta = START + SPEED * t;
    let (sin, cos) = math::sin_cos(theta);
    let [cx, cy] = [CRANK * cos, CRANK * sin];
    let [cxd, cyd] = [-SPEED * cy, SPEED * cx];
    let [cxdd, cydd] = [-SPEED * SPEED * cx, -SPEED * SPEED * cy];
    // from the pin to the pivot
    let [dx, dy] = [GROUND - cx, -cy];
    let square = dx * dx + dy * dy;
    let along = (COUPLER * COUPLER - ROCKER * ROCKER + square) / (2.0 * square);
    let aside = math::sqrt(COUPLER * COUPLER / square - along * along);
    // from the pin to the knee, and from the pivot to it
    let [ux, uy] = [along * dx - aside * dy, along * dy + aside * dx];
    let [wx, wy] = [ux - dx, uy - dy];
    let coupler = math::atan2(uy, ux);
    let rocker = math::atan2(wy, wx);
    let scale = 1.0 / (ux * wy - uy * wx);
    let coupler_d = -(cxd * wx + cyd * wy) * scale;
    let rocker_d = -(cxd * ux + cyd * uy) * scale;
    let ex = cxdd - coupler_d * coupler_d * ux + rocker_d * rocker_d * wx;
    let ey = cydd - coupler_d * coupler_d * uy + rocker_d * rocker_d * wy;
    let coupler_dd = -(ex * wx + ey * wy) * scale;
    let rocker_dd = -(ex * ux + ey * uy) * scale;
    // the rocker's frame is in the middle of the bar
    let [mx, my] = [0.5 * wx, 0.5 * wy];
    [
        [0.0, 0.0, theta, cx, cy, coupler, GROUND + mx, my, rocker],
        [0.0, 0.0, SPEED, cxd, cyd, coupler_d, -rocker_d * my, rocker_d * mx, rocker_d],
        [
            0.0,
            0.0,
            0.0,
            cxdd,
            cydd,
            coupler_dd,
            -rocker_dd * my - rocker_d * rocker_d * mx,
            rocker_dd * mx - rocker_d * rocker_d * my,
            rocker_dd,
        ],
    ]
    .as_flattened()
    .try_into()
    .expect("three times nine")
}
