//! Kinematics of mechanism `everything`, written by mechc 0.1.0 from `everything.mech`.
//!
//! - coordinates `q`: 21 (m, rad), equations `phi = 0`: 21
//! - `phi_q`: 56 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 4; those that follow from others are worked out
//! - the motion: [`assemble`], then [`step`] from time to time
//! - needs the crate `libm`, for elementary functions with the same bits on every platform
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::blocks::Blocks;
use runtime::blocks::work_of;
use runtime::either::either;
use runtime::equations::Branches;
use runtime::equations::Checks;
use runtime::equations::Equations;
use runtime::error::Fault;
use runtime::grid::on_grid;
use runtime::limits::ITERATIONS;
use runtime::measured::Measured;
use runtime::newton::Newton;
use runtime::pivoting::Pivoting;
use runtime::pivoting::solve_with_pivoting;
use runtime::rims::Rimmed;
use runtime::rims::first_rim;
use runtime::rims::look_at_rim;
use runtime::select::select;
use runtime::sign::sign;
use runtime::sine_and_cosine::sin_cos;
use runtime::solution::Solved;
use runtime::state::Parameters;
use runtime::state::Time;
use runtime::state::Timed;

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `a` (m), line 3
    pub a: f64,
    /// `rate` (1/s), line 5
    pub rate: f64,
    /// `n` (1), line 6
    pub n: f64,
    /// `half` (1), line 7
    pub half: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            a: 1.0,
            rate: 3.141592653589793,
            n: 3.0,
            half: 0.5,
        }
    }
}

impl Parameters for Params {
    #[rustfmt::skip]
    fn towards(&self, other: &Self, part: f64) -> Self {
        Self {
            a: self.a + part * (other.a - self.a),
            rate: self.rate + part * (other.rate - self.rate),
            n: self.n + part * (other.n - self.n),
            half: self.half + part * (other.half - self.half),
        }
    }

    #[rustfmt::skip]
    fn is_finite(&self) -> bool {
        let all = [
            self.a, self.rate, self.n, self.half,
        ];
        all.into_iter().all(f64::is_finite)
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 21;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 56;

/// Coordinates (m, rad).
pub type Q = [f64; N];

/// Velocities (m/s, rad/s).
pub type Qd = [f64; N];

/// Accelerations (m/s^2, rad/s^2).
pub type Qdd = [f64; N];

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `crank.x` (m), line 19
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m), line 19
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad), line 19
    pub const CRANK_PHI: usize = 2;
    /// `plate.x` (m), line 24
    pub const PLATE_X: usize = 3;
    /// `plate.y` (m), line 24
    pub const PLATE_Y: usize = 4;
    /// `plate.phi` (rad), line 24
    pub const PLATE_PHI: usize = 5;
    /// `rocker.x` (m), line 28
    pub const ROCKER_X: usize = 6;
    /// `rocker.y` (m), line 28
    pub const ROCKER_Y: usize = 7;
    /// `rocker.phi` (rad), line 28
    pub const ROCKER_PHI: usize = 8;
    /// `sled.x` (m), line 33
    pub const SLED_X: usize = 9;
    /// `sled.y` (m), line 33
    pub const SLED_Y: usize = 10;
    /// `sled.phi` (rad), line 33
    pub const SLED_PHI: usize = 11;
    /// `stone.x` (m), line 37
    pub const STONE_X: usize = 12;
    /// `stone.y` (m), line 37
    pub const STONE_Y: usize = 13;
    /// `stone.phi` (rad), line 37
    pub const STONE_PHI: usize = 14;
    /// `free.x` (m), line 38
    pub const FREE_X: usize = 15;
    /// `free.y` (m), line 38
    pub const FREE_Y: usize = 16;
    /// `free.phi` (rad), line 38
    pub const FREE_PHI: usize = 17;
    /// `gauge.x` (m), line 39
    pub const GAUGE_X: usize = 18;
    /// `gauge.y` (m), line 39
    pub const GAUGE_Y: usize = 19;
    /// `gauge.phi` (rad), line 39
    pub const GAUGE_PHI: usize = 20;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 41
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 41
    pub const MAIN_2: usize = 1;
    /// joint `seam 1` (m), line 42
    pub const SEAM_1: usize = 2;
    /// joint `seam 2` (m), line 42
    pub const SEAM_2: usize = 3;
    /// joint `seam 3` (rad), line 42
    pub const SEAM_3: usize = 4;
    /// joint `pivot 1` (m), line 43
    pub const PIVOT_1: usize = 5;
    /// joint `pivot 2` (m), line 43
    pub const PIVOT_2: usize = 6;
    /// joint `strut` (m^2), line 44
    pub const STRUT: usize = 7;
    /// joint `guide 1` (m), line 45
    pub const GUIDE_1: usize = 8;
    /// joint `guide 2` (a pure number), line 45
    pub const GUIDE_2: usize = 9;
    /// joint `block` (m), line 46
    pub const BLOCK: usize = 10;
    /// constraint `stone_turn` (rad), line 48
    pub const STONE_TURN: usize = 11;
    /// constraint `stone_lift` (m), line 49
    pub const STONE_LIFT: usize = 12;
    /// constraint `follow` (m), line 50
    pub const FOLLOW: usize = 13;
    /// constraint `hold` (m), line 51
    pub const HOLD: usize = 14;
    /// constraint `turn` (rad), line 52
    pub const TURN: usize = 15;
    /// constraint `sign_free` (rad), line 53
    pub const SIGN_FREE: usize = 16;
    /// driver `motor` (rad), line 55
    pub const MOTOR: usize = 17;
    /// driver `push` (m), line 56
    pub const PUSH: usize = 18;
    /// driver `lift` (m), line 57
    pub const LIFT: usize = 19;
    /// driver `swing` (rad), line 58
    pub const SWING: usize = 20;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 0),
    (2, 2),
    (2, 3),
    (3, 1),
    (3, 2),
    (3, 4),
    (4, 2),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 3),
    (7, 4),
    (7, 5),
    (7, 6),
    (7, 7),
    (7, 8),
    (8, 9),
    (8, 10),
    (9, 11),
    (10, 6),
    (10, 7),
    (10, 8),
    (10, 12),
    (10, 13),
    (11, 8),
    (11, 14),
    (12, 0),
    (12, 2),
    (12, 9),
    (12, 13),
    (13, 0),
    (13, 1),
    (13, 2),
    (13, 6),
    (13, 7),
    (13, 15),
    (13, 17),
    (14, 2),
    (14, 18),
    (14, 19),
    (14, 20),
    (15, 2),
    (15, 18),
    (15, 19),
    (15, 20),
    (16, 2),
    (16, 20),
    (17, 2),
    (18, 9),
    (18, 10),
    (19, 16),
    (19, 17),
    (20, 2),
    (20, 17),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `crank`, line 19
    Crank,
    /// `plate`, line 24
    Plate,
    /// `rocker`, line 28
    Rocker,
    /// `sled`, line 33
    Sled,
    /// `stone`, line 37
    Stone,
    /// `free`, line 38
    Free,
    /// `gauge`, line 39
    Gauge,
}

/// Where a body is, or how its place changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// (m)
    pub x: f64,
    /// (m)
    pub y: f64,
    /// (rad)
    pub phi: f64,
}

impl Pose {
    /// That of a body, out of the coordinates or their derivatives.
    #[rustfmt::skip]
#[must_use]
    pub fn of(q: &[f64; N], body: Body) -> Self {
        match body {
            Body::Crank => Self { x: q[0], y: q[1], phi: q[2] },
            Body::Plate => Self { x: q[3], y: q[4], phi: q[5] },
            Body::Rocker => Self { x: q[6], y: q[7], phi: q[8] },
            Body::Sled => Self { x: q[9], y: q[10], phi: q[11] },
            Body::Stone => Self { x: q[12], y: q[13], phi: q[14] },
            Body::Free => Self { x: q[15], y: q[16], phi: q[17] },
            Body::Gauge => Self { x: q[18], y: q[19], phi: q[20] },
        }
    }
}

/// Where each measure stands among the values, all in SI.
pub mod measure {
    /// `stroke`, line 61
    pub const STROKE: usize = 0;
    /// `speed`, line 62
    pub const SPEED: usize = 1;
    /// `jerk`, line 63
    pub const JERK: usize = 2;
    /// `turns`, line 64
    pub const TURNS: usize = 3;
    /// `reach`, line 65
    pub const REACH: usize = 4;
    /// `width`, line 66
    pub const WIDTH: usize = 5;
}

/// How many they are.
pub const MEASURES: usize = 6;

/// Where the first time derivative of each measure that has one stands among the rates.
pub mod measure_rate {
    /// `stroke`, line 61
    pub const STROKE: usize = 0;
    /// `speed`, line 62
    pub const SPEED: usize = 1;
    /// `turns`, line 64
    pub const TURNS: usize = 2;
    /// `reach`, line 65
    pub const REACH: usize = 3;
    /// `width`, line 66
    pub const WIDTH: usize = 4;
}

/// How many they are.
pub const RATES: usize = 5;

/// Where the second time derivative of each measure that has one stands among the accelerations.
pub mod measure_acceleration {
    /// `stroke`, line 61
    pub const STROKE: usize = 0;
    /// `speed`, line 62
    pub const SPEED: usize = 1;
    /// `turns`, line 64
    pub const TURNS: usize = 2;
    /// `reach`, line 65
    pub const REACH: usize = 3;
    /// `width`, line 66
    pub const WIDTH: usize = 4;
}

/// How many they are.
pub const ACCELERATIONS: usize = 5;

/// The measures with their time derivatives; `NAN` where one has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// By the indices in [`measure`].
    pub values: [f64; MEASURES],
    /// First time derivatives, by the indices in [`measure_rate`].
    pub rates: [f64; RATES],
    /// Second time derivatives, by the indices in [`measure_acceleration`].
    pub accelerations: [f64; ACCELERATIONS],
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 259 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let n = p.n;
    let sled_phi = q[11];
    let sled_x = q[9];
    let sled_y = q[10];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let free_phi = q[17];
    let free_x = q[15];
    let free_y = q[16];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let stone_phi = q[14];

    let v1 = libm::atan2(0.0, a);
    let v2 = v1 + -1.5707963267948966;
    let v3 = a * half;
    let v4 = 4.0 * t;
    let (_, c5) = sin_cos(v4);
    let v6 = c5 / n;
    let v7 = 2.0 * t;
    let (s8, _) = sin_cos(v7);
    let v9 = v6 + s8;
    let v10 = 0.17453292519943295 * v9;
    let v11 = v10 + -1.2217304763960306;
    let v12 = t / 2.0;
    let v13 = 6.0 * v12;
    let v14 = v13 + -15.0;
    let v15 = v12 * v14;
    let v16 = 10.0 + v15;
    let v17 = v12 * v16;
    let v18 = v12 * v17;
    let v19 = v12 * v18;
    let v20 = f64::from(t < 2.0);
    let v21 = select(v20, v19, 1.0);
    let v22 = f64::from(t < 0.0);
    let v23 = select(v22, 0.0, v21);
    let v24 = 0.01 * v23;
    let v25 = -0.1 + t;
    let v26 = v25 / 0.30000000000000004;
    let v27 = -2.0 * v26;
    let v28 = 3.0 + v27;
    let v29 = v26 * v28;
    let v30 = v26 * v29;
    let v31 = f64::from(t < 0.4);
    let v32 = select(v31, v30, 1.0);
    let v33 = f64::from(t < 0.1);
    let v34 = select(v33, 0.0, v32);
    let v35 = 0.1 * v34;
    let v36 = 0.5 + v35;
    let v37 = v24 + v36;
    let v38 = t / 3.0;
    let v39 = 3.141592653589793 * v38;
    let (_, c40) = sin_cos(v39);
    let v41 = 1.0 - c40;
    let v42 = 0.05 * v41;
    let v43 = f64::from(t < 3.0);
    let v44 = select(v43, v42, 0.1);
    let v45 = select(v22, 0.0, v44);
    let v46 = -20.0 * v38;
    let v47 = v46 + 70.0;
    let v48 = v38 * v47;
    let v49 = v48 + -84.0;
    let v50 = v38 * v49;
    let v51 = v50 + 35.0;
    let v52 = v38 * v51;
    let v53 = v38 * v52;
    let v54 = v38 * v53;
    let v55 = v38 * v54;
    let v56 = 0.1 * v55;
    let v57 = select(v43, v56, 0.1);
    let v58 = select(v22, 0.0, v57);
    let v59 = v7 + -3.0;
    let v60 = t + -1.0;
    let v61 = v60 * v60;
    let v62 = f64::from(t == 1.5);
    let v63 = f64::from(v62 == 0.0);
    let v64 = f64::from(t <= 2.0);
    let v65 = f64::from(v63 != 0.0 && v64 != 0.0);
    let v66 = select(v65, v61, v59);
    let v67 = f64::from(t < 1.0);
    let v68 = select(v67, 0.0, v66);
    let v69 = 0.1 * v68;
    let v70 = 1.0 + v69;
    let v71 = v58 + v70;
    let v72 = v45 + v71;
    let v73 = f64::from(7.0 <= t);
    let v74 = f64::from(5.0 < t);
    let v75 = f64::from(v73 != 0.0 || v74 != 0.0);
    let v76 = f64::from(t == t);
    let v77 = f64::from(v76 == 0.0);
    let v78 = f64::from(v75 != 0.0 || v77 != 0.0);
    let v79 = select(v78, 1.0, 0.0);
    let v80 = 1.0 + t;
    let v81 = v80 * v80;
    let v82 = 1.0 / v81;
    let v83 = libm::pow(t, half);
    let v84 = libm::pow(2.0, v38);
    let v85 = t / 4.0;
    let v86 = libm::cosh(v85);
    let v87 = libm::sinh(v38);
    let v88 = v86 * v87;
    let v89 = n * t;
    let v90 = 2.0 + v89;
    let v91 = t * v90;
    let v92 = 1.0 + v91;
    let v93 = v92 / 10.0;
    let v94 = v80 / 6.0;
    let v95 = 12.566370614359172 * v94;
    let (s96, _) = sin_cos(v95);
    let v97 = 0.25 * s96;
    let v98 = 3.141592653589793 * v94;
    let v99 = v98 - v97;
    let v100 = 4.0 + v99;
    let v101 = 4.1887902047863905 * v94;
    let v102 = v101 + 1.0471975511965976;
    let (s103, _) = sin_cos(v102);
    let v104 = 2.25 * s103;
    let v105 = v98 - v104;
    let v106 = 2.0 + v105;
    let v107 = f64::from(v94 < 0.875);
    let v108 = select(v107, v106, v100);
    let v109 = f64::from(v94 < 0.125);
    let v110 = select(v109, v99, v108);
    let v111 = 0.14002478837788934 * v110;
    let v112 = f64::from(t < 5.0);
    let v113 = select(v112, v111, 1.0);
    let v114 = f64::from(t < -1.0);
    let v115 = select(v114, 0.0, v113);
    let v116 = 6.283185307179586 * v94;
    let (s117, _) = sin_cos(v116);
    let v118 = 0.15915494309189535 * s117;
    let v119 = v94 - v118;
    let v120 = select(v112, v119, 1.0);
    let v121 = select(v114, 0.0, v120);
    let v122 = t / 10.0;
    let v123 = libm::floor(v122);
    let v124 = 10.0 * v123;
    let v125 = t - v124;
    let v126 = libm::sqrt(v80);
    let v127 = 2.0 + t;
    let v128 = libm::log10(v127);
    let v129 = libm::log(v80);
    let v130 = v128 * v129;
    let v131 = -t;
    let v132 = libm::exp(v131);
    let v133 = v130 + v132;
    let v134 = v126 + v133;
    let v135 = v125 + v134;
    let v136 = v121 + v135;
    let v137 = v115 + v136;
    let v138 = v93 + v137;
    let v139 = v88 + v138;
    let v140 = v84 + v139;
    let v141 = v83 + v140;
    let v142 = v82 + v141;
    let v143 = v79 + v142;
    let (s144, c144) = sin_cos(sled_phi);
    let v145 = 0.6 * sled_x;
    let v146 = 0.8 * sled_y;
    let v147 = v145 + v146;
    let (s148, c148) = sin_cos(rocker_phi);
    let v149 = a * c148;
    let v150 = 2.0 * v149;
    let v151 = a * s148;
    let v152 = 2.0 * v151;
    let v153 = v150 + rocker_x;
    let v154 = v152 + rocker_y;
    let (s155, c155) = sin_cos(crank_phi);
    let v156 = a * c155;
    let v157 = a * s155;
    let v158 = v156 + crank_x;
    let v159 = v157 + crank_y;
    let (s160, c160) = sin_cos(free_phi);
    let v161 = 0.1 * c160;
    let v162 = 0.1 * s160;
    let v163 = v161 + free_x;
    let v164 = v162 + free_y;
    let v165 = v158 - sled_x;
    let v166 = rocker_x - crank_x;
    let v167 = rocker_y - crank_y;
    let v168 = v166 * v166;
    let v169 = v167 * v167;
    let v170 = v168 + v169;
    let v171 = libm::sqrt(v170);
    let (s172, c172) = sin_cos(gauge_phi);
    let v173 = c172 + gauge_x;
    let v174 = s172 + gauge_y;
    let v175 = crank_phi + v2;
    let v176 = free_phi - crank_phi;
    let v177 = -crank_x;
    let v178 = -crank_y;
    let v179 = plate_phi - crank_phi;
    let v180 = v179 + -0.5235987755982988;
    let (s181, c181) = sin_cos(plate_phi);
    let v182 = v158 - plate_x;
    let v183 = v159 - plate_y;
    let v184 = 4.0 - rocker_x;
    let v185 = -rocker_y;
    let v186 = c181 * v3;
    let v187 = 0.1 * s181;
    let v188 = s181 * v3;
    let v189 = 0.1 * c181;
    let v190 = v186 - v187;
    let v191 = v188 + v189;
    let v192 = plate_x + v190;
    let v193 = plate_y + v191;
    let v194 = v153 - v192;
    let v195 = v154 - v193;
    let v196 = v194 * v194;
    let v197 = v195 * v195;
    let v198 = v196 + v197;
    let v199 = v198 + -9.0;
    let v200 = 0.6 * c144;
    let v201 = 0.8 * s144;
    let v202 = 0.6 * s144;
    let v203 = 0.8 * c144;
    let v204 = v200 - v201;
    let v205 = v202 + v203;
    let v206 = 0.8 * sled_x;
    let v207 = 0.6 * sled_y;
    let v208 = v207 - v206;
    let v209 = 0.8 * v204;
    let v210 = 0.6 * v205;
    let v211 = v210 - v209;
    let v212 = stone_x - rocker_x;
    let v213 = stone_y - rocker_y;
    let v214 = s148 * v212;
    let v215 = c148 * v213;
    let v216 = v215 - v214;
    let v217 = v216 + -0.1;
    let v218 = rocker_phi / 2.0;
    let v219 = stone_phi - v218;
    let v220 = f64::from(v165 < 0.0);
    let v221 = -v165;
    let v222 = select(v220, v221, v165);
    let v223 = v222 / 10.0;
    let v224 = stone_y + v223;
    let v225 = v224 + -0.6;
    let v226 = f64::from(a < v171);
    let v227 = either(v226, a, v171);
    let v228 = f64::from(v159 < v158);
    let v229 = either(v228, v158, v159);
    let v230 = f64::from(0.2 < v229);
    let v231 = either(v230, v229, 0.2);
    let v232 = v227 + v231;
    let v233 = v163 - v232;
    let v234 = libm::hypot(v173, v174);
    let v235 = libm::tanh(crank_phi);
    let v236 = v235 / 10.0;
    let v237 = v236 + 1.2;
    let v238 = v234 - v237;
    let v239 = libm::atan2(v174, v173);
    let v240 = c155 / 3.0;
    let v241 = libm::acos(v240);
    let v242 = v241 / 4.0;
    let v243 = s155 / 2.0;
    let v244 = libm::asin(v243);
    let v245 = v242 + v244;
    let v246 = v239 - v245;
    let v247 = crank_phi / 9.0;
    let v248 = libm::tan(v247);
    let v249 = libm::atan(crank_phi);
    let v250 = sign(v173);
    let v251 = v249 * v250;
    let v252 = v251 / 5.0;
    let v253 = 1.0 + v252;
    let v254 = v248 + v253;
    let v255 = gauge_phi - v254;
    let v256 = v175 - v11;
    let v257 = v147 - v37;
    let v258 = v164 - v72;
    let v259 = v176 - v143;

    out[0] = v177;
    out[1] = v178;
    out[2] = v182;
    out[3] = v183;
    out[4] = v180;
    out[5] = v184;
    out[6] = v185;
    out[7] = v199;
    out[8] = v208;
    out[9] = v211;
    out[10] = v217;
    out[11] = v219;
    out[12] = v225;
    out[13] = v233;
    out[14] = v238;
    out[15] = v246;
    out[16] = v255;
    out[17] = v256;
    out[18] = v257;
    out[19] = v258;
    out[20] = v259;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 151 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let a = p.a;
    let half = p.half;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let free_phi = q[17];
    let sled_x = q[9];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_y = q[13];
    let stone_x = q[12];

    let v1 = a * half;
    let (_, c2) = sin_cos(sled_phi);
    let (s3, c3) = sin_cos(rocker_phi);
    let v4 = a * c3;
    let v5 = 2.0 * v4;
    let v6 = a * s3;
    let v7 = 2.0 * v6;
    let v8 = v5 + rocker_x;
    let v9 = v7 + rocker_y;
    let (s10, c10) = sin_cos(crank_phi);
    let v11 = a * c10;
    let v12 = a * s10;
    let v13 = v11 + crank_x;
    let v14 = v12 + crank_y;
    let (s15, c15) = sin_cos(free_phi);
    let v16 = 0.1 * c15;
    let v17 = v13 - sled_x;
    let v18 = rocker_x - crank_x;
    let v19 = rocker_y - crank_y;
    let v20 = v18 * v18;
    let v21 = v19 * v19;
    let v22 = v20 + v21;
    let v23 = libm::sqrt(v22);
    let (s24, c24) = sin_cos(gauge_phi);
    let v25 = c24 + gauge_x;
    let v26 = s24 + gauge_y;
    let (s27, c27) = sin_cos(plate_phi);
    let v28 = c27 * v1;
    let v29 = 0.1 * s27;
    let v30 = s27 * v1;
    let v31 = 0.1 * c27;
    let v32 = v28 - v29;
    let v33 = v30 + v31;
    let v34 = plate_x + v32;
    let v35 = plate_y + v33;
    let v36 = v8 - v34;
    let v37 = v9 - v35;
    let v38 = stone_y - rocker_y;
    let v39 = f64::from(v17 < 0.0);
    let v40 = f64::from(a < v23);
    let v41 = f64::from(v14 < v13);
    let v42 = either(v41, v13, v14);
    let v43 = f64::from(0.2 < v42);
    let v44 = libm::hypot(v25, v26);
    let v45 = libm::tanh(crank_phi);
    let v46 = c10 / 3.0;
    let v47 = s10 / 2.0;
    let v48 = crank_phi / 9.0;
    let v49 = libm::tan(v48);
    let v50 = sign(v25);
    let v51 = -v12;
    let v52 = 2.0 * v37;
    let v53 = 2.0 * v36;
    let v54 = -2.0 * v37;
    let v55 = -2.0 * v36;
    let v56 = -0.2 * v37;
    let v57 = v1 * v37;
    let v58 = -2.0 * v57;
    let v59 = 0.2 * v36;
    let v60 = v58 + v59;
    let v61 = v1 * v36;
    let v62 = -2.0 * v61;
    let v63 = v56 + v62;
    let v64 = c27 * v60;
    let v65 = s27 * v63;
    let v66 = v64 - v65;
    let v67 = a * v37;
    let v68 = a * v36;
    let v69 = c3 * v67;
    let v70 = 4.0 * v69;
    let v71 = s3 * v68;
    let v72 = -4.0 * v71;
    let v73 = v70 + v72;
    let v74 = rocker_x - stone_x;
    let v75 = -s3;
    let v76 = -c3;
    let v77 = c3 * v74;
    let v78 = s3 * v38;
    let v79 = v77 - v78;
    let v80 = select(v39, -0.1, 0.1);
    let v81 = -v80;
    let v82 = a * v80;
    let v83 = s10 * v82;
    let v84 = -v83;
    let v85 = 2.0 * v18;
    let v86 = -2.0 * v18;
    let v87 = 2.0 * v23;
    let v88 = v86 / v87;
    let v89 = select(v40, 0.0, v88);
    let v90 = select(v41, 1.0, 0.0);
    let v91 = select(v43, v90, 0.0);
    let v92 = v89 + v91;
    let v93 = -v92;
    let v94 = 2.0 * v19;
    let v95 = -2.0 * v19;
    let v96 = v95 / v87;
    let v97 = select(v40, 0.0, v96);
    let v98 = select(v41, 0.0, 1.0);
    let v99 = select(v43, v98, 0.0);
    let v100 = v97 + v99;
    let v101 = -v100;
    let v102 = select(v41, v51, 0.0);
    let v103 = select(v41, 0.0, v11);
    let v104 = v102 + v103;
    let v105 = select(v43, v104, 0.0);
    let v106 = -v105;
    let v107 = v85 / v87;
    let v108 = select(v40, 0.0, v107);
    let v109 = -v108;
    let v110 = v94 / v87;
    let v111 = select(v40, 0.0, v110);
    let v112 = -v111;
    let v113 = -0.1 * s15;
    let v114 = v45 * v45;
    let v115 = 1.0 - v114;
    let v116 = -0.1 * v115;
    let v117 = v25 / v44;
    let v118 = v26 / v44;
    let v119 = c24 * v118;
    let v120 = s24 * v117;
    let v121 = v119 - v120;
    let v122 = v47 * v47;
    let v123 = 1.0 - v122;
    let v124 = libm::sqrt(v123);
    let v125 = -1.0 / v124;
    let v126 = v125 / 2.0;
    let v127 = v46 * v46;
    let v128 = 1.0 - v127;
    let v129 = libm::sqrt(v128);
    let v130 = -0.25 / v129;
    let v131 = v130 / 3.0;
    let v132 = v26 * v26;
    let v133 = v25 * v25;
    let v134 = v132 + v133;
    let v135 = v25 / v134;
    let v136 = v26 / v134;
    let v137 = -v136;
    let v138 = c24 * v135;
    let v139 = s24 * v136;
    let v140 = v138 + v139;
    let v141 = c10 * v126;
    let v142 = s10 * v131;
    let v143 = v141 + v142;
    let v144 = -0.2 * v50;
    let v145 = crank_phi * crank_phi;
    let v146 = 1.0 + v145;
    let v147 = v144 / v146;
    let v148 = v49 * v49;
    let v149 = 1.0 + v148;
    let v150 = v149 / 9.0;
    let v151 = v147 - v150;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v51;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = v11;
    out[7] = -1.0;
    out[8] = -1.0;
    out[9] = 1.0;
    out[10] = -1.0;
    out[11] = -1.0;
    out[12] = v55;
    out[13] = v54;
    out[14] = v66;
    out[15] = v53;
    out[16] = v52;
    out[17] = v73;
    out[18] = -0.8;
    out[19] = 0.6;
    out[20] = c2;
    out[21] = s3;
    out[22] = v76;
    out[23] = v79;
    out[24] = v75;
    out[25] = c3;
    out[26] = -0.5;
    out[27] = 1.0;
    out[28] = v80;
    out[29] = v84;
    out[30] = v81;
    out[31] = 1.0;
    out[32] = v93;
    out[33] = v101;
    out[34] = v106;
    out[35] = v109;
    out[36] = v112;
    out[37] = 1.0;
    out[38] = v113;
    out[39] = v116;
    out[40] = v117;
    out[41] = v118;
    out[42] = v121;
    out[43] = v143;
    out[44] = v137;
    out[45] = v135;
    out[46] = v140;
    out[47] = v151;
    out[48] = 1.0;
    out[49] = 1.0;
    out[50] = 0.6;
    out[51] = 0.8;
    out[52] = 1.0;
    out[53] = v16;
    out[54] = -1.0;
    out[55] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 172 operations.
pub fn phi_t(_q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let half = p.half;
    let n = p.n;

    let v1 = half + -1.0;
    let v2 = 4.0 * t;
    let (s3, _) = sin_cos(v2);
    let v4 = 2.0 * t;
    let (_, c5) = sin_cos(v4);
    let v6 = t / 2.0;
    let v7 = 6.0 * v6;
    let v8 = v7 + -15.0;
    let v9 = v6 * v8;
    let v10 = 10.0 + v9;
    let v11 = v6 * v10;
    let v12 = v6 * v11;
    let v13 = f64::from(t < 2.0);
    let v14 = f64::from(t < 0.0);
    let v15 = -0.1 + t;
    let v16 = v15 / 0.30000000000000004;
    let v17 = -2.0 * v16;
    let v18 = 3.0 + v17;
    let v19 = v16 * v18;
    let v20 = f64::from(t < 0.4);
    let v21 = f64::from(t < 0.1);
    let v22 = t / 3.0;
    let v23 = 3.141592653589793 * v22;
    let (s24, _) = sin_cos(v23);
    let v25 = f64::from(t < 3.0);
    let v26 = -20.0 * v22;
    let v27 = v26 + 70.0;
    let v28 = v22 * v27;
    let v29 = v28 + -84.0;
    let v30 = v22 * v29;
    let v31 = v30 + 35.0;
    let v32 = v22 * v31;
    let v33 = v22 * v32;
    let v34 = v22 * v33;
    let v35 = t + -1.0;
    let v36 = f64::from(t == 1.5);
    let v37 = f64::from(v36 == 0.0);
    let v38 = f64::from(t <= 2.0);
    let v39 = f64::from(v37 != 0.0 && v38 != 0.0);
    let v40 = f64::from(t < 1.0);
    let v41 = 1.0 + t;
    let v42 = libm::pow(2.0, v22);
    let v43 = t / 4.0;
    let v44 = libm::cosh(v43);
    let v45 = libm::sinh(v22);
    let v46 = n * t;
    let v47 = 2.0 + v46;
    let v48 = v41 / 6.0;
    let v49 = 12.566370614359172 * v48;
    let (_, c50) = sin_cos(v49);
    let v51 = 4.1887902047863905 * v48;
    let v52 = v51 + 1.0471975511965976;
    let (_, c53) = sin_cos(v52);
    let v54 = f64::from(v48 < 0.875);
    let v55 = f64::from(v48 < 0.125);
    let v56 = f64::from(t < 5.0);
    let v57 = f64::from(t < -1.0);
    let v58 = 6.283185307179586 * v48;
    let (_, c59) = sin_cos(v58);
    let v60 = libm::sqrt(v41);
    let v61 = 2.0 + t;
    let v62 = libm::log10(v61);
    let v63 = libm::log(v41);
    let v64 = -t;
    let v65 = libm::exp(v64);
    let v66 = -4.0 * s3;
    let v67 = v66 / n;
    let v68 = 2.0 * c5;
    let v69 = v67 + v68;
    let v70 = 0.17453292519943295 * v69;
    let v71 = 0.5 * v8;
    let v72 = 3.0 * v6;
    let v73 = v71 + v72;
    let v74 = 0.5 * v10;
    let v75 = v6 * v73;
    let v76 = v74 + v75;
    let v77 = 0.5 * v11;
    let v78 = v6 * v76;
    let v79 = v77 + v78;
    let v80 = 0.5 * v12;
    let v81 = v6 * v79;
    let v82 = v80 + v81;
    let v83 = select(v13, v82, 0.0);
    let v84 = select(v14, 0.0, v83);
    let v85 = 0.01 * v84;
    let v86 = 3.333333333333333 * v18;
    let v87 = -6.666666666666666 * v16;
    let v88 = v86 + v87;
    let v89 = 3.333333333333333 * v19;
    let v90 = v16 * v88;
    let v91 = v89 + v90;
    let v92 = select(v20, v91, 0.0);
    let v93 = select(v21, 0.0, v92);
    let v94 = 0.1 * v93;
    let v95 = v85 + v94;
    let v96 = 0.05235987755982988 * s24;
    let v97 = select(v25, v96, 0.0);
    let v98 = select(v14, 0.0, v97);
    let v99 = 0.3333333333333333 * v27;
    let v100 = -6.666666666666666 * v22;
    let v101 = v99 + v100;
    let v102 = 0.3333333333333333 * v29;
    let v103 = v22 * v101;
    let v104 = v102 + v103;
    let v105 = 0.3333333333333333 * v31;
    let v106 = v22 * v104;
    let v107 = v105 + v106;
    let v108 = 0.3333333333333333 * v32;
    let v109 = v22 * v107;
    let v110 = v108 + v109;
    let v111 = 0.3333333333333333 * v33;
    let v112 = v22 * v110;
    let v113 = v111 + v112;
    let v114 = 0.3333333333333333 * v34;
    let v115 = v22 * v113;
    let v116 = v114 + v115;
    let v117 = 0.1 * v116;
    let v118 = select(v25, v117, 0.0);
    let v119 = select(v14, 0.0, v118);
    let v120 = 2.0 * v35;
    let v121 = select(v39, v120, 2.0);
    let v122 = select(v40, 0.0, v121);
    let v123 = 0.1 * v122;
    let v124 = v119 + v123;
    let v125 = v98 + v124;
    let v126 = v41 * v41;
    let v127 = v126 * v41;
    let v128 = 1.0 / v127;
    let v129 = -2.0 * v128;
    let v130 = libm::pow(t, v1);
    let v131 = half * v130;
    let v132 = 0.23104906018664842 * v42;
    let v133 = libm::sinh(v43);
    let v134 = libm::cosh(v22);
    let v135 = v45 * v133;
    let v136 = 0.25 * v135;
    let v137 = v44 * v134;
    let v138 = 0.3333333333333333 * v137;
    let v139 = v136 + v138;
    let v140 = v46 + v47;
    let v141 = v140 / 10.0;
    let v142 = -0.5235987755982988 * c50;
    let v143 = 0.5235987755982988 + v142;
    let v144 = -1.5707963267948963 * c53;
    let v145 = 0.5235987755982988 + v144;
    let v146 = select(v54, v145, v143);
    let v147 = select(v55, v143, v146);
    let v148 = 0.14002478837788934 * v147;
    let v149 = select(v56, v148, 0.0);
    let v150 = select(v57, 0.0, v149);
    let v151 = -0.16666666666666666 * c59;
    let v152 = 0.16666666666666666 + v151;
    let v153 = select(v56, v152, 0.0);
    let v154 = select(v57, 0.0, v153);
    let v155 = 2.0 * v60;
    let v156 = 1.0 / v155;
    let v157 = 2.302585092994046 * v61;
    let v158 = 1.0 / v157;
    let v159 = 1.0 / v41;
    let v160 = v63 * v158;
    let v161 = v62 * v159;
    let v162 = v160 + v161;
    let v163 = v162 - v65;
    let v164 = v156 + v163;
    let v165 = 1.0 + v164;
    let v166 = v154 + v165;
    let v167 = v150 + v166;
    let v168 = v141 + v167;
    let v169 = v139 + v168;
    let v170 = v132 + v169;
    let v171 = v131 + v170;
    let v172 = v129 + v171;

    out[17] = -v70;
    out[18] = -v95;
    out[19] = -v125;
    out[20] = -v172;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 172 operations.
pub fn nu(_q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let half = p.half;
    let n = p.n;

    let v1 = half + -1.0;
    let v2 = 4.0 * t;
    let (s3, _) = sin_cos(v2);
    let v4 = 2.0 * t;
    let (_, c5) = sin_cos(v4);
    let v6 = t / 2.0;
    let v7 = 6.0 * v6;
    let v8 = v7 + -15.0;
    let v9 = v6 * v8;
    let v10 = 10.0 + v9;
    let v11 = v6 * v10;
    let v12 = v6 * v11;
    let v13 = f64::from(t < 2.0);
    let v14 = f64::from(t < 0.0);
    let v15 = -0.1 + t;
    let v16 = v15 / 0.30000000000000004;
    let v17 = -2.0 * v16;
    let v18 = 3.0 + v17;
    let v19 = v16 * v18;
    let v20 = f64::from(t < 0.4);
    let v21 = f64::from(t < 0.1);
    let v22 = t / 3.0;
    let v23 = 3.141592653589793 * v22;
    let (s24, _) = sin_cos(v23);
    let v25 = f64::from(t < 3.0);
    let v26 = -20.0 * v22;
    let v27 = v26 + 70.0;
    let v28 = v22 * v27;
    let v29 = v28 + -84.0;
    let v30 = v22 * v29;
    let v31 = v30 + 35.0;
    let v32 = v22 * v31;
    let v33 = v22 * v32;
    let v34 = v22 * v33;
    let v35 = t + -1.0;
    let v36 = f64::from(t == 1.5);
    let v37 = f64::from(v36 == 0.0);
    let v38 = f64::from(t <= 2.0);
    let v39 = f64::from(v37 != 0.0 && v38 != 0.0);
    let v40 = f64::from(t < 1.0);
    let v41 = 1.0 + t;
    let v42 = libm::pow(2.0, v22);
    let v43 = t / 4.0;
    let v44 = libm::cosh(v43);
    let v45 = libm::sinh(v22);
    let v46 = n * t;
    let v47 = 2.0 + v46;
    let v48 = v41 / 6.0;
    let v49 = 12.566370614359172 * v48;
    let (_, c50) = sin_cos(v49);
    let v51 = 4.1887902047863905 * v48;
    let v52 = v51 + 1.0471975511965976;
    let (_, c53) = sin_cos(v52);
    let v54 = f64::from(v48 < 0.875);
    let v55 = f64::from(v48 < 0.125);
    let v56 = f64::from(t < 5.0);
    let v57 = f64::from(t < -1.0);
    let v58 = 6.283185307179586 * v48;
    let (_, c59) = sin_cos(v58);
    let v60 = libm::sqrt(v41);
    let v61 = 2.0 + t;
    let v62 = libm::log10(v61);
    let v63 = libm::log(v41);
    let v64 = -t;
    let v65 = libm::exp(v64);
    let v66 = -4.0 * s3;
    let v67 = v66 / n;
    let v68 = 2.0 * c5;
    let v69 = v67 + v68;
    let v70 = 0.17453292519943295 * v69;
    let v71 = 0.5 * v8;
    let v72 = 3.0 * v6;
    let v73 = v71 + v72;
    let v74 = 0.5 * v10;
    let v75 = v6 * v73;
    let v76 = v74 + v75;
    let v77 = 0.5 * v11;
    let v78 = v6 * v76;
    let v79 = v77 + v78;
    let v80 = 0.5 * v12;
    let v81 = v6 * v79;
    let v82 = v80 + v81;
    let v83 = select(v13, v82, 0.0);
    let v84 = select(v14, 0.0, v83);
    let v85 = 0.01 * v84;
    let v86 = 3.333333333333333 * v18;
    let v87 = -6.666666666666666 * v16;
    let v88 = v86 + v87;
    let v89 = 3.333333333333333 * v19;
    let v90 = v16 * v88;
    let v91 = v89 + v90;
    let v92 = select(v20, v91, 0.0);
    let v93 = select(v21, 0.0, v92);
    let v94 = 0.1 * v93;
    let v95 = v85 + v94;
    let v96 = 0.05235987755982988 * s24;
    let v97 = select(v25, v96, 0.0);
    let v98 = select(v14, 0.0, v97);
    let v99 = 0.3333333333333333 * v27;
    let v100 = -6.666666666666666 * v22;
    let v101 = v99 + v100;
    let v102 = 0.3333333333333333 * v29;
    let v103 = v22 * v101;
    let v104 = v102 + v103;
    let v105 = 0.3333333333333333 * v31;
    let v106 = v22 * v104;
    let v107 = v105 + v106;
    let v108 = 0.3333333333333333 * v32;
    let v109 = v22 * v107;
    let v110 = v108 + v109;
    let v111 = 0.3333333333333333 * v33;
    let v112 = v22 * v110;
    let v113 = v111 + v112;
    let v114 = 0.3333333333333333 * v34;
    let v115 = v22 * v113;
    let v116 = v114 + v115;
    let v117 = 0.1 * v116;
    let v118 = select(v25, v117, 0.0);
    let v119 = select(v14, 0.0, v118);
    let v120 = 2.0 * v35;
    let v121 = select(v39, v120, 2.0);
    let v122 = select(v40, 0.0, v121);
    let v123 = 0.1 * v122;
    let v124 = v119 + v123;
    let v125 = v98 + v124;
    let v126 = v41 * v41;
    let v127 = v126 * v41;
    let v128 = 1.0 / v127;
    let v129 = -2.0 * v128;
    let v130 = libm::pow(t, v1);
    let v131 = half * v130;
    let v132 = 0.23104906018664842 * v42;
    let v133 = libm::sinh(v43);
    let v134 = libm::cosh(v22);
    let v135 = v45 * v133;
    let v136 = 0.25 * v135;
    let v137 = v44 * v134;
    let v138 = 0.3333333333333333 * v137;
    let v139 = v136 + v138;
    let v140 = v46 + v47;
    let v141 = v140 / 10.0;
    let v142 = -0.5235987755982988 * c50;
    let v143 = 0.5235987755982988 + v142;
    let v144 = -1.5707963267948963 * c53;
    let v145 = 0.5235987755982988 + v144;
    let v146 = select(v54, v145, v143);
    let v147 = select(v55, v143, v146);
    let v148 = 0.14002478837788934 * v147;
    let v149 = select(v56, v148, 0.0);
    let v150 = select(v57, 0.0, v149);
    let v151 = -0.16666666666666666 * c59;
    let v152 = 0.16666666666666666 + v151;
    let v153 = select(v56, v152, 0.0);
    let v154 = select(v57, 0.0, v153);
    let v155 = 2.0 * v60;
    let v156 = 1.0 / v155;
    let v157 = 2.302585092994046 * v61;
    let v158 = 1.0 / v157;
    let v159 = 1.0 / v41;
    let v160 = v63 * v158;
    let v161 = v62 * v159;
    let v162 = v160 + v161;
    let v163 = v162 - v65;
    let v164 = v156 + v163;
    let v165 = 1.0 + v164;
    let v166 = v154 + v165;
    let v167 = v150 + v166;
    let v168 = v141 + v167;
    let v169 = v139 + v168;
    let v170 = v132 + v169;
    let v171 = v131 + v170;
    let v172 = v129 + v171;

    out[17] = v70;
    out[18] = v95;
    out[19] = v125;
    out[20] = v172;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 477 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let n = p.n;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let free_phi = q[17];
    let sled_x = q[9];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let rocker_phi_d = qd[8];
    let rocker_x_d = qd[6];
    let crank_phi_d = qd[2];
    let free_phi_d = qd[17];
    let sled_phi_d = qd[11];
    let rocker_y_d = qd[7];
    let crank_x_d = qd[0];
    let crank_y_d = qd[1];
    let gauge_phi_d = qd[20];
    let gauge_x_d = qd[18];
    let gauge_y_d = qd[19];
    let plate_phi_d = qd[5];
    let plate_x_d = qd[3];
    let plate_y_d = qd[4];
    let stone_x_d = qd[12];
    let stone_y_d = qd[13];

    let v1 = a * half;
    let v2 = half + -1.0;
    let v3 = -1.0 + v2;
    let v4 = 2.0 * n;
    let v5 = v4 / 10.0;
    let v6 = 4.0 * t;
    let (_, c7) = sin_cos(v6);
    let v8 = 2.0 * t;
    let (s9, _) = sin_cos(v8);
    let v10 = t / 2.0;
    let v11 = 6.0 * v10;
    let v12 = v11 + -15.0;
    let v13 = v10 * v12;
    let v14 = 10.0 + v13;
    let v15 = v10 * v14;
    let v16 = f64::from(t < 2.0);
    let v17 = f64::from(t < 0.0);
    let v18 = -0.1 + t;
    let v19 = v18 / 0.30000000000000004;
    let v20 = -2.0 * v19;
    let v21 = 3.0 + v20;
    let v22 = f64::from(t < 0.4);
    let v23 = f64::from(t < 0.1);
    let v24 = t / 3.0;
    let v25 = 3.141592653589793 * v24;
    let (_, c26) = sin_cos(v25);
    let v27 = f64::from(t < 3.0);
    let v28 = -20.0 * v24;
    let v29 = v28 + 70.0;
    let v30 = v24 * v29;
    let v31 = v30 + -84.0;
    let v32 = v24 * v31;
    let v33 = v32 + 35.0;
    let v34 = v24 * v33;
    let v35 = v24 * v34;
    let v36 = f64::from(t == 1.5);
    let v37 = f64::from(v36 == 0.0);
    let v38 = f64::from(t <= 2.0);
    let v39 = f64::from(v37 != 0.0 && v38 != 0.0);
    let v40 = f64::from(t < 1.0);
    let v41 = 1.0 + t;
    let v42 = libm::pow(2.0, v24);
    let v43 = t / 4.0;
    let v44 = libm::cosh(v43);
    let v45 = libm::sinh(v24);
    let v46 = v44 * v45;
    let v47 = v41 / 6.0;
    let v48 = 12.566370614359172 * v47;
    let (s49, _) = sin_cos(v48);
    let v50 = 4.1887902047863905 * v47;
    let v51 = v50 + 1.0471975511965976;
    let (s52, _) = sin_cos(v51);
    let v53 = f64::from(v47 < 0.875);
    let v54 = f64::from(v47 < 0.125);
    let v55 = f64::from(t < 5.0);
    let v56 = f64::from(t < -1.0);
    let v57 = 6.283185307179586 * v47;
    let (s58, _) = sin_cos(v57);
    let v59 = libm::sqrt(v41);
    let v60 = 2.0 + t;
    let v61 = libm::log10(v60);
    let v62 = libm::log(v41);
    let v63 = -t;
    let v64 = libm::exp(v63);
    let (s65, c65) = sin_cos(sled_phi);
    let (s66, c66) = sin_cos(rocker_phi);
    let v67 = a * c66;
    let v68 = 2.0 * v67;
    let v69 = a * s66;
    let v70 = 2.0 * v69;
    let v71 = v68 + rocker_x;
    let v72 = v70 + rocker_y;
    let (s73, c73) = sin_cos(crank_phi);
    let v74 = a * c73;
    let v75 = a * s73;
    let v76 = v74 + crank_x;
    let v77 = v75 + crank_y;
    let (s78, c78) = sin_cos(free_phi);
    let v79 = v76 - sled_x;
    let v80 = rocker_x - crank_x;
    let v81 = rocker_y - crank_y;
    let v82 = v80 * v80;
    let v83 = v81 * v81;
    let v84 = v82 + v83;
    let v85 = libm::sqrt(v84);
    let (s86, c86) = sin_cos(gauge_phi);
    let v87 = c86 + gauge_x;
    let v88 = s86 + gauge_y;
    let (s89, c89) = sin_cos(plate_phi);
    let v90 = c89 * v1;
    let v91 = 0.1 * s89;
    let v92 = s89 * v1;
    let v93 = 0.1 * c89;
    let v94 = v90 - v91;
    let v95 = v92 + v93;
    let v96 = plate_x + v94;
    let v97 = plate_y + v95;
    let v98 = v71 - v96;
    let v99 = v72 - v97;
    let v100 = stone_x - rocker_x;
    let v101 = stone_y - rocker_y;
    let v102 = f64::from(v79 < 0.0);
    let v103 = f64::from(a < v85);
    let v104 = f64::from(v77 < v76);
    let v105 = either(v104, v76, v77);
    let v106 = f64::from(0.2 < v105);
    let v107 = libm::hypot(v87, v88);
    let v108 = libm::tanh(crank_phi);
    let v109 = c73 / 3.0;
    let v110 = s73 / 2.0;
    let v111 = crank_phi / 9.0;
    let v112 = libm::tan(v111);
    let v113 = sign(v87);
    let v114 = 2.0 * v85;
    let v115 = v108 * v108;
    let v116 = 1.0 - v115;
    let v117 = v87 / v107;
    let v118 = v88 / v107;
    let v119 = v110 * v110;
    let v120 = 1.0 - v119;
    let v121 = libm::sqrt(v120);
    let v122 = v109 * v109;
    let v123 = 1.0 - v122;
    let v124 = libm::sqrt(v123);
    let v125 = v88 * v88;
    let v126 = v87 * v87;
    let v127 = v125 + v126;
    let v128 = v87 / v127;
    let v129 = v88 / v127;
    let v130 = crank_phi * crank_phi;
    let v131 = 1.0 + v130;
    let v132 = v112 * v112;
    let v133 = 1.0 + v132;
    let v134 = 0.5 * v12;
    let v135 = 3.0 * v10;
    let v136 = v134 + v135;
    let v137 = 0.5 * v14;
    let v138 = v10 * v136;
    let v139 = v137 + v138;
    let v140 = 0.5 * v15;
    let v141 = v10 * v139;
    let v142 = v140 + v141;
    let v143 = 3.333333333333333 * v21;
    let v144 = -6.666666666666666 * v19;
    let v145 = v143 + v144;
    let v146 = 0.3333333333333333 * v29;
    let v147 = -6.666666666666666 * v24;
    let v148 = v146 + v147;
    let v149 = 0.3333333333333333 * v31;
    let v150 = v24 * v148;
    let v151 = v149 + v150;
    let v152 = 0.3333333333333333 * v33;
    let v153 = v24 * v151;
    let v154 = v152 + v153;
    let v155 = 0.3333333333333333 * v34;
    let v156 = v24 * v154;
    let v157 = v155 + v156;
    let v158 = 0.3333333333333333 * v35;
    let v159 = v24 * v157;
    let v160 = v158 + v159;
    let v161 = libm::sinh(v43);
    let v162 = libm::cosh(v24);
    let v163 = 2.0 * v59;
    let v164 = 1.0 / v163;
    let v165 = 2.302585092994046 * v60;
    let v166 = 1.0 / v165;
    let v167 = 1.0 / v41;
    let v168 = s66 * rocker_phi_d;
    let v169 = a * v168;
    let v170 = -2.0 * v169;
    let v171 = v170 + rocker_x_d;
    let v172 = c73 * crank_phi_d;
    let v173 = s73 * crank_phi_d;
    let v174 = crank_phi_d * v173;
    let v175 = crank_phi_d * v172;
    let v176 = c66 * rocker_phi_d;
    let v177 = rocker_phi_d * v176;
    let v178 = rocker_phi_d * v168;
    let v179 = s78 * free_phi_d;
    let v180 = c78 * free_phi_d;
    let v181 = free_phi_d * v180;
    let v182 = free_phi_d * v179;
    let v183 = s65 * sled_phi_d;
    let v184 = c65 * sled_phi_d;
    let v185 = a * v176;
    let v186 = 2.0 * v185;
    let v187 = v186 + rocker_y_d;
    let v188 = rocker_x_d - crank_x_d;
    let v189 = rocker_y_d - crank_y_d;
    let v190 = v80 * v188;
    let v191 = 2.0 * v190;
    let v192 = v81 * v189;
    let v193 = 2.0 * v192;
    let v194 = v191 + v193;
    let v195 = v194 / v114;
    let v196 = s86 * gauge_phi_d;
    let v197 = c86 * gauge_phi_d;
    let v198 = gauge_x_d - v196;
    let v199 = v197 + gauge_y_d;
    let v200 = s89 * plate_phi_d;
    let v201 = c89 * plate_phi_d;
    let v202 = v1 * v200;
    let v203 = v1 * v201;
    let v204 = -0.1 * v200;
    let v205 = -0.1 * v201;
    let v206 = v205 - v202;
    let v207 = v203 + v204;
    let v208 = plate_x_d + v206;
    let v209 = plate_y_d + v207;
    let v210 = v171 - v208;
    let v211 = v187 - v209;
    let v212 = stone_x_d - rocker_x_d;
    let v213 = stone_y_d - rocker_y_d;
    let v214 = v117 * v198;
    let v215 = v118 * v199;
    let v216 = v214 + v215;
    let v217 = crank_phi_d * v116;
    let v218 = v173 / 3.0;
    let v219 = v218 / v124;
    let v220 = v172 / 2.0;
    let v221 = v220 / v121;
    let v222 = crank_phi_d / 9.0;
    let v223 = v133 * v222;
    let v224 = crank_phi_d / v131;
    let v225 = a * v177;
    let v226 = -2.0 * v225;
    let v227 = a * v174;
    let v228 = -v227;
    let v229 = -0.1 * v181;
    let v230 = -0.1 * v182;
    let v231 = v108 * v217;
    let v232 = v198 / v107;
    let v233 = v117 / v107;
    let v234 = v216 * v233;
    let v235 = v232 - v234;
    let v236 = v199 / v107;
    let v237 = v118 / v107;
    let v238 = v216 * v237;
    let v239 = v236 - v238;
    let v240 = v110 * v220;
    let v241 = -2.0 * v240;
    let v242 = 2.0 * v121;
    let v243 = v241 / v242;
    let v244 = v109 * v218;
    let v245 = 2.0 * v244;
    let v246 = 2.0 * v124;
    let v247 = v245 / v246;
    let v248 = v88 * v199;
    let v249 = 2.0 * v248;
    let v250 = v87 * v198;
    let v251 = 2.0 * v250;
    let v252 = v249 + v251;
    let v253 = v198 / v127;
    let v254 = v128 / v127;
    let v255 = v252 * v254;
    let v256 = v253 - v255;
    let v257 = v199 / v127;
    let v258 = v129 / v127;
    let v259 = v252 * v258;
    let v260 = v257 - v259;
    let v261 = crank_phi * crank_phi_d;
    let v262 = v112 * v223;
    let v263 = -16.0 * c7;
    let v264 = v263 / n;
    let v265 = -4.0 * s9;
    let v266 = v264 + v265;
    let v267 = 0.5 * v136;
    let v268 = v135 + v267;
    let v269 = v267 + v268;
    let v270 = 0.5 * v139;
    let v271 = v10 * v269;
    let v272 = v270 + v271;
    let v273 = v270 + v272;
    let v274 = 0.5 * v142;
    let v275 = v10 * v273;
    let v276 = v274 + v275;
    let v277 = v274 + v276;
    let v278 = select(v16, v277, 0.0);
    let v279 = select(v17, 0.0, v278);
    let v280 = 0.01 * v279;
    let v281 = 3.333333333333333 * v145;
    let v282 = -44.444444444444436 * v19;
    let v283 = v281 + v282;
    let v284 = v281 + v283;
    let v285 = select(v22, v284, 0.0);
    let v286 = select(v23, 0.0, v285);
    let v287 = 0.1 * v286;
    let v288 = v280 + v287;
    let v289 = 0.054831135561607534 * c26;
    let v290 = select(v27, v289, 0.0);
    let v291 = select(v17, 0.0, v290);
    let v292 = 0.3333333333333333 * v148;
    let v293 = -4.444444444444444 * v24;
    let v294 = v292 + v293;
    let v295 = v292 + v294;
    let v296 = 0.3333333333333333 * v151;
    let v297 = v24 * v295;
    let v298 = v296 + v297;
    let v299 = v296 + v298;
    let v300 = 0.3333333333333333 * v154;
    let v301 = v24 * v299;
    let v302 = v300 + v301;
    let v303 = v300 + v302;
    let v304 = 0.3333333333333333 * v157;
    let v305 = v24 * v303;
    let v306 = v304 + v305;
    let v307 = v304 + v306;
    let v308 = 0.3333333333333333 * v160;
    let v309 = v24 * v307;
    let v310 = v308 + v309;
    let v311 = v308 + v310;
    let v312 = 0.1 * v311;
    let v313 = select(v27, v312, 0.0);
    let v314 = select(v17, 0.0, v313);
    let v315 = select(v39, 2.0, 0.0);
    let v316 = select(v40, 0.0, v315);
    let v317 = 0.1 * v316;
    let v318 = v314 + v317;
    let v319 = v291 + v318;
    let v320 = v41 * v41;
    let v321 = v320 * v320;
    let v322 = 1.0 / v321;
    let v323 = 6.0 * v322;
    let v324 = libm::pow(t, v3);
    let v325 = v2 * v324;
    let v326 = half * v325;
    let v327 = 0.053383668213133485 * v42;
    let v328 = v161 * v162;
    let v329 = 0.3333333333333333 * v328;
    let v330 = 0.25 * v46;
    let v331 = v329 + v330;
    let v332 = 0.25 * v331;
    let v333 = 0.25 * v328;
    let v334 = 0.3333333333333333 * v46;
    let v335 = v333 + v334;
    let v336 = 0.3333333333333333 * v335;
    let v337 = v332 + v336;
    let v338 = 1.0966227112321507 * s49;
    let v339 = 1.0966227112321505 * s52;
    let v340 = select(v53, v339, v338);
    let v341 = select(v54, v338, v340);
    let v342 = 0.14002478837788934 * v341;
    let v343 = select(v55, v342, 0.0);
    let v344 = select(v56, 0.0, v343);
    let v345 = 0.17453292519943292 * s58;
    let v346 = select(v55, v345, 0.0);
    let v347 = select(v56, 0.0, v346);
    let v348 = v164 / v163;
    let v349 = v164 * v348;
    let v350 = -2.0 * v349;
    let v351 = v166 / v165;
    let v352 = v167 / v41;
    let v353 = v166 * v167;
    let v354 = v62 * v351;
    let v355 = -2.302585092994046 * v354;
    let v356 = v353 + v355;
    let v357 = v61 * v352;
    let v358 = v353 - v357;
    let v359 = v356 + v358;
    let v360 = v64 + v359;
    let v361 = v350 + v360;
    let v362 = v347 + v361;
    let v363 = v344 + v362;
    let v364 = v5 + v363;
    let v365 = v337 + v364;
    let v366 = v327 + v365;
    let v367 = v326 + v366;
    let v368 = v323 + v367;
    let v369 = sled_phi_d * v184;
    let v370 = sled_phi_d * v183;
    let v371 = a * v178;
    let v372 = -2.0 * v371;
    let v373 = a * v175;
    let v374 = -v373;
    let v375 = v188 * v188;
    let v376 = 2.0 * v375;
    let v377 = v189 * v189;
    let v378 = 2.0 * v377;
    let v379 = v376 + v378;
    let v380 = v379 / v114;
    let v381 = v195 / v114;
    let v382 = v195 * v381;
    let v383 = -2.0 * v382;
    let v384 = v380 + v383;
    let v385 = gauge_phi_d * v197;
    let v386 = gauge_phi_d * v196;
    let v387 = plate_phi_d * v201;
    let v388 = plate_phi_d * v200;
    let v389 = v1 * v387;
    let v390 = v1 * v388;
    let v391 = -0.1 * v387;
    let v392 = 0.1 * v388;
    let v393 = v389 - v392;
    let v394 = v226 + v393;
    let v395 = v390 - v391;
    let v396 = v372 + v395;
    let v397 = v210 * v210;
    let v398 = v98 * v394;
    let v399 = v397 + v398;
    let v400 = 2.0 * v399;
    let v401 = v211 * v211;
    let v402 = v99 * v396;
    let v403 = v401 + v402;
    let v404 = 2.0 * v403;
    let v405 = v400 + v404;
    let v406 = -0.6 * v369;
    let v407 = -0.6 * v370;
    let v408 = -0.8 * v369;
    let v409 = 0.8 * v370;
    let v410 = v406 + v409;
    let v411 = v407 + v408;
    let v412 = 0.6 * v411;
    let v413 = -0.8 * v410;
    let v414 = v412 + v413;
    let v415 = v176 * v212;
    let v416 = v100 * v178;
    let v417 = v415 - v416;
    let v418 = v415 + v417;
    let v419 = v101 * v177;
    let v420 = v168 * v213;
    let v421 = v419 + v420;
    let v422 = v420 + v421;
    let v423 = v418 + v422;
    let v424 = select(v102, v373, v374);
    let v425 = v424 / 10.0;
    let v426 = select(v103, 0.0, v384);
    let v427 = select(v104, v374, 0.0);
    let v428 = select(v104, 0.0, v228);
    let v429 = v427 + v428;
    let v430 = select(v106, v429, 0.0);
    let v431 = v426 + v430;
    let v432 = v198 * v235;
    let v433 = v117 * v385;
    let v434 = v432 - v433;
    let v435 = v199 * v239;
    let v436 = v118 * v386;
    let v437 = v435 - v436;
    let v438 = v434 + v437;
    let v439 = crank_phi_d * v231;
    let v440 = -2.0 * v439;
    let v441 = v440 / 10.0;
    let v442 = v199 * v256;
    let v443 = v128 * v386;
    let v444 = v442 - v443;
    let v445 = v198 * v260;
    let v446 = v129 * v385;
    let v447 = v446 - v445;
    let v448 = v444 + v447;
    let v449 = v175 / 3.0;
    let v450 = v449 / v124;
    let v451 = v219 / v124;
    let v452 = v247 * v451;
    let v453 = v450 - v452;
    let v454 = v453 / 4.0;
    let v455 = v174 / 2.0;
    let v456 = v455 / v121;
    let v457 = v221 / v121;
    let v458 = v243 * v457;
    let v459 = v456 + v458;
    let v460 = v459 - v454;
    let v461 = v448 + v460;
    let v462 = v222 * v262;
    let v463 = 2.0 * v462;
    let v464 = v224 / v131;
    let v465 = v261 * v464;
    let v466 = v113 * v465;
    let v467 = -2.0 * v466;
    let v468 = v467 / 5.0;
    let v469 = v463 + v468;
    let v470 = -v405;
    let v471 = -v414;
    let v472 = -v425;
    let v473 = v431 - v229;
    let v474 = v441 - v438;
    let v475 = -v461;
    let v476 = 0.17453292519943295 * v266;
    let v477 = v319 - v230;

    out[2] = v373;
    out[3] = v227;
    out[7] = v470;
    out[9] = v471;
    out[10] = v423;
    out[12] = v472;
    out[13] = v473;
    out[14] = v474;
    out[15] = v475;
    out[16] = v469;
    out[17] = v476;
    out[18] = v288;
    out[19] = v477;
    out[20] = v368;
    out
}

/// Right side of the jerk equation `phi_q qddd = jerk`.
///
/// 793 operations.
pub fn jerk(q: &[f64; N], qd: &[f64; N], qdd: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let free_phi = q[17];
    let sled_x = q[9];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let rocker_phi_d = qd[8];
    let rocker_x_d = qd[6];
    let crank_phi_d = qd[2];
    let free_phi_d = qd[17];
    let sled_phi_d = qd[11];
    let rocker_y_d = qd[7];
    let crank_x_d = qd[0];
    let crank_y_d = qd[1];
    let gauge_phi_d = qd[20];
    let gauge_x_d = qd[18];
    let gauge_y_d = qd[19];
    let plate_phi_d = qd[5];
    let plate_x_d = qd[3];
    let plate_y_d = qd[4];
    let stone_x_d = qd[12];
    let stone_y_d = qd[13];
    let crank_phi_dd = qdd[2];
    let rocker_phi_dd = qdd[8];
    let rocker_x_dd = qdd[6];
    let free_phi_dd = qdd[17];
    let sled_phi_dd = qdd[11];
    let rocker_y_dd = qdd[7];
    let crank_x_dd = qdd[0];
    let crank_y_dd = qdd[1];
    let gauge_phi_dd = qdd[20];
    let gauge_x_dd = qdd[18];
    let gauge_y_dd = qdd[19];
    let plate_phi_dd = qdd[5];
    let plate_x_dd = qdd[3];
    let plate_y_dd = qdd[4];
    let stone_x_dd = qdd[12];
    let stone_y_dd = qdd[13];
    let n = p.n;

    let v1 = a * half;
    let v2 = half + -1.0;
    let v3 = -1.0 + v2;
    let v4 = -1.0 + v3;
    let v5 = 4.0 * t;
    let (s6, _) = sin_cos(v5);
    let v7 = 2.0 * t;
    let (_, c8) = sin_cos(v7);
    let v9 = t / 2.0;
    let v10 = 6.0 * v9;
    let v11 = v10 + -15.0;
    let v12 = v9 * v11;
    let v13 = 10.0 + v12;
    let v14 = f64::from(t < 2.0);
    let v15 = f64::from(t < 0.0);
    let v16 = f64::from(t < 0.4);
    let v17 = f64::from(t < 0.1);
    let v18 = t / 3.0;
    let v19 = 3.141592653589793 * v18;
    let (s20, _) = sin_cos(v19);
    let v21 = f64::from(t < 3.0);
    let v22 = -20.0 * v18;
    let v23 = v22 + 70.0;
    let v24 = v18 * v23;
    let v25 = v24 + -84.0;
    let v26 = v18 * v25;
    let v27 = v26 + 35.0;
    let v28 = v18 * v27;
    let v29 = 1.0 + t;
    let v30 = libm::pow(2.0, v18);
    let v31 = t / 4.0;
    let v32 = libm::cosh(v31);
    let v33 = libm::sinh(v18);
    let v34 = v29 / 6.0;
    let v35 = 12.566370614359172 * v34;
    let (_, c36) = sin_cos(v35);
    let v37 = 4.1887902047863905 * v34;
    let v38 = v37 + 1.0471975511965976;
    let (_, c39) = sin_cos(v38);
    let v40 = f64::from(v34 < 0.875);
    let v41 = f64::from(v34 < 0.125);
    let v42 = f64::from(t < 5.0);
    let v43 = f64::from(t < -1.0);
    let v44 = 6.283185307179586 * v34;
    let (_, c45) = sin_cos(v44);
    let v46 = libm::sqrt(v29);
    let v47 = 2.0 + t;
    let v48 = libm::log10(v47);
    let v49 = libm::log(v29);
    let v50 = -t;
    let v51 = libm::exp(v50);
    let (s52, c52) = sin_cos(sled_phi);
    let (s53, c53) = sin_cos(rocker_phi);
    let v54 = a * c53;
    let v55 = 2.0 * v54;
    let v56 = a * s53;
    let v57 = 2.0 * v56;
    let v58 = v55 + rocker_x;
    let v59 = v57 + rocker_y;
    let (s60, c60) = sin_cos(crank_phi);
    let v61 = a * c60;
    let v62 = a * s60;
    let v63 = v61 + crank_x;
    let v64 = v62 + crank_y;
    let (s65, c65) = sin_cos(free_phi);
    let v66 = v63 - sled_x;
    let v67 = rocker_x - crank_x;
    let v68 = rocker_y - crank_y;
    let v69 = v67 * v67;
    let v70 = v68 * v68;
    let v71 = v69 + v70;
    let v72 = libm::sqrt(v71);
    let (s73, c73) = sin_cos(gauge_phi);
    let v74 = c73 + gauge_x;
    let v75 = s73 + gauge_y;
    let (s76, c76) = sin_cos(plate_phi);
    let v77 = c76 * v1;
    let v78 = 0.1 * s76;
    let v79 = s76 * v1;
    let v80 = 0.1 * c76;
    let v81 = v77 - v78;
    let v82 = v79 + v80;
    let v83 = plate_x + v81;
    let v84 = plate_y + v82;
    let v85 = v58 - v83;
    let v86 = v59 - v84;
    let v87 = stone_x - rocker_x;
    let v88 = stone_y - rocker_y;
    let v89 = f64::from(v66 < 0.0);
    let v90 = f64::from(a < v72);
    let v91 = f64::from(v64 < v63);
    let v92 = either(v91, v63, v64);
    let v93 = f64::from(0.2 < v92);
    let v94 = libm::hypot(v74, v75);
    let v95 = libm::tanh(crank_phi);
    let v96 = c60 / 3.0;
    let v97 = s60 / 2.0;
    let v98 = crank_phi / 9.0;
    let v99 = libm::tan(v98);
    let v100 = sign(v74);
    let v101 = 2.0 * v72;
    let v102 = v95 * v95;
    let v103 = 1.0 - v102;
    let v104 = v74 / v94;
    let v105 = v75 / v94;
    let v106 = v97 * v97;
    let v107 = 1.0 - v106;
    let v108 = libm::sqrt(v107);
    let v109 = v96 * v96;
    let v110 = 1.0 - v109;
    let v111 = libm::sqrt(v110);
    let v112 = v75 * v75;
    let v113 = v74 * v74;
    let v114 = v112 + v113;
    let v115 = v74 / v114;
    let v116 = v75 / v114;
    let v117 = crank_phi * crank_phi;
    let v118 = 1.0 + v117;
    let v119 = v99 * v99;
    let v120 = 1.0 + v119;
    let v121 = 0.5 * v11;
    let v122 = 3.0 * v9;
    let v123 = v121 + v122;
    let v124 = 0.5 * v13;
    let v125 = v9 * v123;
    let v126 = v124 + v125;
    let v127 = 0.3333333333333333 * v23;
    let v128 = -6.666666666666666 * v18;
    let v129 = v127 + v128;
    let v130 = 0.3333333333333333 * v25;
    let v131 = v18 * v129;
    let v132 = v130 + v131;
    let v133 = 0.3333333333333333 * v27;
    let v134 = v18 * v132;
    let v135 = v133 + v134;
    let v136 = 0.3333333333333333 * v28;
    let v137 = v18 * v135;
    let v138 = v136 + v137;
    let v139 = libm::sinh(v31);
    let v140 = libm::cosh(v18);
    let v141 = v33 * v139;
    let v142 = 0.25 * v141;
    let v143 = v32 * v140;
    let v144 = 0.3333333333333333 * v143;
    let v145 = v142 + v144;
    let v146 = 2.0 * v46;
    let v147 = 1.0 / v146;
    let v148 = 2.302585092994046 * v47;
    let v149 = 1.0 / v148;
    let v150 = 1.0 / v29;
    let v151 = s53 * rocker_phi_d;
    let v152 = a * v151;
    let v153 = -2.0 * v152;
    let v154 = v153 + rocker_x_d;
    let v155 = c60 * crank_phi_d;
    let v156 = s60 * crank_phi_d;
    let v157 = crank_phi_d * v156;
    let v158 = crank_phi_d * v155;
    let v159 = c53 * rocker_phi_d;
    let v160 = rocker_phi_d * v159;
    let v161 = rocker_phi_d * v151;
    let v162 = s65 * free_phi_d;
    let v163 = c65 * free_phi_d;
    let v164 = free_phi_d * v163;
    let v165 = free_phi_d * v162;
    let v166 = s52 * sled_phi_d;
    let v167 = c52 * sled_phi_d;
    let v168 = a * v159;
    let v169 = 2.0 * v168;
    let v170 = v169 + rocker_y_d;
    let v171 = rocker_x_d - crank_x_d;
    let v172 = rocker_y_d - crank_y_d;
    let v173 = v67 * v171;
    let v174 = 2.0 * v173;
    let v175 = v68 * v172;
    let v176 = 2.0 * v175;
    let v177 = v174 + v176;
    let v178 = v177 / v101;
    let v179 = s73 * gauge_phi_d;
    let v180 = c73 * gauge_phi_d;
    let v181 = gauge_x_d - v179;
    let v182 = v180 + gauge_y_d;
    let v183 = s76 * plate_phi_d;
    let v184 = c76 * plate_phi_d;
    let v185 = v1 * v183;
    let v186 = v1 * v184;
    let v187 = -0.1 * v183;
    let v188 = -0.1 * v184;
    let v189 = v188 - v185;
    let v190 = v186 + v187;
    let v191 = plate_x_d + v189;
    let v192 = plate_y_d + v190;
    let v193 = v154 - v191;
    let v194 = v170 - v192;
    let v195 = stone_x_d - rocker_x_d;
    let v196 = stone_y_d - rocker_y_d;
    let v197 = v104 * v181;
    let v198 = v105 * v182;
    let v199 = v197 + v198;
    let v200 = crank_phi_d * v103;
    let v201 = v156 / 3.0;
    let v202 = v201 / v111;
    let v203 = v155 / 2.0;
    let v204 = v203 / v108;
    let v205 = crank_phi_d / 9.0;
    let v206 = v120 * v205;
    let v207 = crank_phi_d / v118;
    let v208 = v95 * v200;
    let v209 = v181 / v94;
    let v210 = v104 / v94;
    let v211 = v199 * v210;
    let v212 = v209 - v211;
    let v213 = v182 / v94;
    let v214 = v105 / v94;
    let v215 = v199 * v214;
    let v216 = v213 - v215;
    let v217 = v97 * v203;
    let v218 = -2.0 * v217;
    let v219 = 2.0 * v108;
    let v220 = v218 / v219;
    let v221 = v96 * v201;
    let v222 = 2.0 * v221;
    let v223 = 2.0 * v111;
    let v224 = v222 / v223;
    let v225 = v75 * v182;
    let v226 = 2.0 * v225;
    let v227 = v74 * v181;
    let v228 = 2.0 * v227;
    let v229 = v226 + v228;
    let v230 = v181 / v114;
    let v231 = v115 / v114;
    let v232 = v229 * v231;
    let v233 = v230 - v232;
    let v234 = v182 / v114;
    let v235 = v116 / v114;
    let v236 = v229 * v235;
    let v237 = v234 - v236;
    let v238 = crank_phi * crank_phi_d;
    let v239 = v99 * v206;
    let v240 = 0.5 * v123;
    let v241 = v122 + v240;
    let v242 = v240 + v241;
    let v243 = 0.5 * v126;
    let v244 = v9 * v242;
    let v245 = v243 + v244;
    let v246 = v243 + v245;
    let v247 = 0.3333333333333333 * v129;
    let v248 = -4.444444444444444 * v18;
    let v249 = v247 + v248;
    let v250 = v247 + v249;
    let v251 = 0.3333333333333333 * v132;
    let v252 = v18 * v250;
    let v253 = v251 + v252;
    let v254 = v251 + v253;
    let v255 = 0.3333333333333333 * v135;
    let v256 = v18 * v254;
    let v257 = v255 + v256;
    let v258 = v255 + v257;
    let v259 = 0.3333333333333333 * v138;
    let v260 = v18 * v258;
    let v261 = v259 + v260;
    let v262 = v259 + v261;
    let v263 = v147 / v146;
    let v264 = v147 * v263;
    let v265 = -2.0 * v264;
    let v266 = v149 / v148;
    let v267 = v150 / v29;
    let v268 = sled_phi_d * v167;
    let v269 = sled_phi_d * v166;
    let v270 = v171 * v171;
    let v271 = v172 * v172;
    let v272 = v178 / v101;
    let v273 = v178 * v272;
    let v274 = -2.0 * v273;
    let v275 = gauge_phi_d * v180;
    let v276 = gauge_phi_d * v179;
    let v277 = plate_phi_d * v184;
    let v278 = plate_phi_d * v183;
    let v279 = v181 * v212;
    let v280 = v182 * v216;
    let v281 = crank_phi_d * v208;
    let v282 = -2.0 * v281;
    let v283 = v202 / v111;
    let v284 = v224 * v283;
    let v285 = v204 / v108;
    let v286 = v220 * v285;
    let v287 = v205 * v239;
    let v288 = 2.0 * v287;
    let v289 = v207 / v118;
    let v290 = v238 * v289;
    let v291 = c60 * crank_phi_dd;
    let v292 = v291 - v157;
    let v293 = s60 * crank_phi_dd;
    let v294 = v158 + v293;
    let v295 = v156 * crank_phi_dd;
    let v296 = crank_phi_d * v294;
    let v297 = v295 + v296;
    let v298 = s53 * rocker_phi_dd;
    let v299 = v160 + v298;
    let v300 = a * v299;
    let v301 = -2.0 * v300;
    let v302 = v301 + rocker_x_dd;
    let v303 = c53 * rocker_phi_dd;
    let v304 = v303 - v161;
    let v305 = v159 * rocker_phi_dd;
    let v306 = rocker_phi_d * v304;
    let v307 = v305 + v306;
    let v308 = s65 * free_phi_dd;
    let v309 = v164 + v308;
    let v310 = c65 * free_phi_dd;
    let v311 = v310 - v165;
    let v312 = -2.302585092994046 * v266;
    let v313 = -2.0 * v290;
    let v314 = s52 * sled_phi_dd;
    let v315 = v268 + v314;
    let v316 = c52 * sled_phi_dd;
    let v317 = v316 - v269;
    let v318 = a * v304;
    let v319 = 2.0 * v318;
    let v320 = v319 + rocker_y_dd;
    let v321 = rocker_x_dd - crank_x_dd;
    let v322 = rocker_y_dd - crank_y_dd;
    let v323 = v67 * v321;
    let v324 = v270 + v323;
    let v325 = 2.0 * v324;
    let v326 = v68 * v322;
    let v327 = v271 + v326;
    let v328 = 2.0 * v327;
    let v329 = v325 + v328;
    let v330 = v329 / v101;
    let v331 = v274 + v330;
    let v332 = s73 * gauge_phi_dd;
    let v333 = v275 + v332;
    let v334 = c73 * gauge_phi_dd;
    let v335 = v334 - v276;
    let v336 = gauge_x_dd - v333;
    let v337 = v335 + gauge_y_dd;
    let v338 = s76 * plate_phi_dd;
    let v339 = v277 + v338;
    let v340 = c76 * plate_phi_dd;
    let v341 = v340 - v278;
    let v342 = v1 * v339;
    let v343 = v1 * v341;
    let v344 = -0.1 * v339;
    let v345 = -0.1 * v341;
    let v346 = v345 - v342;
    let v347 = v343 + v344;
    let v348 = plate_x_dd + v346;
    let v349 = plate_y_dd + v347;
    let v350 = v302 - v348;
    let v351 = v320 - v349;
    let v352 = stone_x_dd - rocker_x_dd;
    let v353 = stone_y_dd - rocker_y_dd;
    let v354 = v104 * v336;
    let v355 = v279 + v354;
    let v356 = v105 * v337;
    let v357 = v280 + v356;
    let v358 = v355 + v357;
    let v359 = crank_phi_dd * v103;
    let v360 = v282 + v359;
    let v361 = v294 / 3.0;
    let v362 = v361 / v111;
    let v363 = v362 - v284;
    let v364 = v292 / 2.0;
    let v365 = v364 / v108;
    let v366 = v365 - v286;
    let v367 = crank_phi_dd / 9.0;
    let v368 = v120 * v367;
    let v369 = v288 + v368;
    let v370 = crank_phi_dd / v118;
    let v371 = v313 + v370;
    let v372 = v295 + v297;
    let v373 = a * v372;
    let v374 = -v373;
    let v375 = v155 * crank_phi_dd;
    let v376 = crank_phi_d * v292;
    let v377 = v375 + v376;
    let v378 = v375 + v377;
    let v379 = v305 + v307;
    let v380 = a * v379;
    let v381 = -2.0 * v380;
    let v382 = v151 * rocker_phi_dd;
    let v383 = rocker_phi_d * v299;
    let v384 = v382 + v383;
    let v385 = v382 + v384;
    let v386 = v163 * free_phi_dd;
    let v387 = free_phi_d * v311;
    let v388 = v386 + v387;
    let v389 = v386 + v388;
    let v390 = v162 * free_phi_dd;
    let v391 = free_phi_d * v309;
    let v392 = v390 + v391;
    let v393 = v390 + v392;
    let v394 = -0.1 * v389;
    let v395 = -0.1 * v393;
    let v396 = v200 * v200;
    let v397 = v95 * v360;
    let v398 = v396 + v397;
    let v399 = v336 / v94;
    let v400 = v209 / v94;
    let v401 = v199 * v400;
    let v402 = v399 - v401;
    let v403 = v212 / v94;
    let v404 = v210 / v94;
    let v405 = v199 * v404;
    let v406 = v403 - v405;
    let v407 = v210 * v358;
    let v408 = v199 * v406;
    let v409 = v407 + v408;
    let v410 = v402 - v409;
    let v411 = v337 / v94;
    let v412 = v213 / v94;
    let v413 = v199 * v412;
    let v414 = v411 - v413;
    let v415 = v216 / v94;
    let v416 = v214 / v94;
    let v417 = v199 * v416;
    let v418 = v415 - v417;
    let v419 = v214 * v358;
    let v420 = v199 * v418;
    let v421 = v419 + v420;
    let v422 = v414 - v421;
    let v423 = v203 * v203;
    let v424 = v97 * v364;
    let v425 = v423 + v424;
    let v426 = -2.0 * v425;
    let v427 = v426 / v219;
    let v428 = v220 / v219;
    let v429 = v220 * v428;
    let v430 = -2.0 * v429;
    let v431 = v427 + v430;
    let v432 = v201 * v201;
    let v433 = v96 * v361;
    let v434 = v433 - v432;
    let v435 = 2.0 * v434;
    let v436 = v435 / v223;
    let v437 = v224 / v223;
    let v438 = v224 * v437;
    let v439 = -2.0 * v438;
    let v440 = v436 + v439;
    let v441 = v182 * v182;
    let v442 = v75 * v337;
    let v443 = v441 + v442;
    let v444 = 2.0 * v443;
    let v445 = v181 * v181;
    let v446 = v74 * v336;
    let v447 = v445 + v446;
    let v448 = 2.0 * v447;
    let v449 = v444 + v448;
    let v450 = v336 / v114;
    let v451 = v230 / v114;
    let v452 = v229 * v451;
    let v453 = v450 - v452;
    let v454 = v233 / v114;
    let v455 = v231 / v114;
    let v456 = v229 * v455;
    let v457 = v454 - v456;
    let v458 = v231 * v449;
    let v459 = v229 * v457;
    let v460 = v458 + v459;
    let v461 = v453 - v460;
    let v462 = v337 / v114;
    let v463 = v234 / v114;
    let v464 = v229 * v463;
    let v465 = v462 - v464;
    let v466 = v237 / v114;
    let v467 = v235 / v114;
    let v468 = v229 * v467;
    let v469 = v466 - v468;
    let v470 = v235 * v449;
    let v471 = v229 * v469;
    let v472 = v470 + v471;
    let v473 = v465 - v472;
    let v474 = crank_phi_d * crank_phi_d;
    let v475 = crank_phi * crank_phi_dd;
    let v476 = v474 + v475;
    let v477 = v206 * v206;
    let v478 = v99 * v369;
    let v479 = v477 + v478;
    let v480 = 64.0 * s6;
    let v481 = v480 / n;
    let v482 = -8.0 * c8;
    let v483 = v481 + v482;
    let v484 = 0.5 * v242;
    let v485 = 4.5 * v9;
    let v486 = v484 + v485;
    let v487 = v484 + v486;
    let v488 = v484 + v487;
    let v489 = 0.5 * v246;
    let v490 = v9 * v488;
    let v491 = v489 + v490;
    let v492 = v489 + v491;
    let v493 = v489 + v492;
    let v494 = select(v14, v493, 0.0);
    let v495 = select(v15, 0.0, v494);
    let v496 = 0.01 * v495;
    let v497 = select(v16, -444.4444444444443, 0.0);
    let v498 = select(v17, 0.0, v497);
    let v499 = 0.1 * v498;
    let v500 = v496 + v499;
    let v501 = -0.05741903088944409 * s20;
    let v502 = select(v21, v501, 0.0);
    let v503 = select(v15, 0.0, v502);
    let v504 = 0.3333333333333333 * v250;
    let v505 = v248 + v504;
    let v506 = v504 + v505;
    let v507 = v504 + v506;
    let v508 = 0.3333333333333333 * v254;
    let v509 = v18 * v507;
    let v510 = v508 + v509;
    let v511 = v508 + v510;
    let v512 = v508 + v511;
    let v513 = 0.3333333333333333 * v258;
    let v514 = v18 * v512;
    let v515 = v513 + v514;
    let v516 = v513 + v515;
    let v517 = v513 + v516;
    let v518 = 0.3333333333333333 * v262;
    let v519 = v18 * v517;
    let v520 = v518 + v519;
    let v521 = v518 + v520;
    let v522 = v518 + v521;
    let v523 = 0.1 * v522;
    let v524 = select(v21, v523, 0.0);
    let v525 = select(v15, 0.0, v524);
    let v526 = v503 + v525;
    let v527 = v29 * v29;
    let v528 = v527 * v527;
    let v529 = v528 * v29;
    let v530 = 1.0 / v529;
    let v531 = -24.0 * v530;
    let v532 = libm::pow(t, v4);
    let v533 = v3 * v532;
    let v534 = v2 * v533;
    let v535 = half * v534;
    let v536 = 0.012334246369960349 * v30;
    let v537 = 0.25 * v143;
    let v538 = 0.3333333333333333 * v141;
    let v539 = v537 + v538;
    let v540 = 0.3333333333333333 * v539;
    let v541 = 0.25 * v145;
    let v542 = v540 + v541;
    let v543 = 0.25 * v542;
    let v544 = 0.25 * v539;
    let v545 = 0.3333333333333333 * v145;
    let v546 = v544 + v545;
    let v547 = 0.3333333333333333 * v546;
    let v548 = v543 + v547;
    let v549 = 2.2967612355777636 * c36;
    let v550 = 0.765587078525921 * c39;
    let v551 = select(v40, v550, v549);
    let v552 = select(v41, v549, v551);
    let v553 = 0.14002478837788934 * v552;
    let v554 = select(v42, v553, 0.0);
    let v555 = select(v43, 0.0, v554);
    let v556 = 0.1827704518720251 * c45;
    let v557 = select(v42, v556, 0.0);
    let v558 = select(v43, 0.0, v557);
    let v559 = v265 / v146;
    let v560 = v263 / v146;
    let v561 = v147 * v560;
    let v562 = -2.0 * v561;
    let v563 = v559 + v562;
    let v564 = v263 * v264;
    let v565 = -2.0 * v564;
    let v566 = v147 * v563;
    let v567 = v565 + v566;
    let v568 = -2.0 * v567;
    let v569 = v312 / v148;
    let v570 = v266 / v148;
    let v571 = -2.302585092994046 * v570;
    let v572 = v569 + v571;
    let v573 = v267 / v29;
    let v574 = v150 * v266;
    let v575 = -2.302585092994046 * v574;
    let v576 = v149 * v267;
    let v577 = v575 - v576;
    let v578 = v49 * v572;
    let v579 = v574 + v578;
    let v580 = -2.302585092994046 * v579;
    let v581 = v577 + v580;
    let v582 = v48 * v573;
    let v583 = -2.0 * v582;
    let v584 = v576 + v583;
    let v585 = v577 - v584;
    let v586 = v581 + v585;
    let v587 = v586 - v51;
    let v588 = v568 + v587;
    let v589 = v558 + v588;
    let v590 = v555 + v589;
    let v591 = v548 + v590;
    let v592 = v536 + v591;
    let v593 = v535 + v592;
    let v594 = v531 + v593;
    let v595 = v167 * sled_phi_dd;
    let v596 = sled_phi_d * v317;
    let v597 = v595 + v596;
    let v598 = v166 * sled_phi_dd;
    let v599 = sled_phi_d * v315;
    let v600 = v598 + v599;
    let v601 = v171 * v321;
    let v602 = 2.0 * v601;
    let v603 = v172 * v322;
    let v604 = 2.0 * v603;
    let v605 = v331 / v101;
    let v606 = v272 / v101;
    let v607 = v178 * v606;
    let v608 = -2.0 * v607;
    let v609 = v605 + v608;
    let v610 = v272 * v331;
    let v611 = v178 * v609;
    let v612 = v610 + v611;
    let v613 = -2.0 * v612;
    let v614 = v180 * gauge_phi_dd;
    let v615 = gauge_phi_d * v335;
    let v616 = v614 + v615;
    let v617 = v179 * gauge_phi_dd;
    let v618 = gauge_phi_d * v333;
    let v619 = v617 + v618;
    let v620 = v184 * plate_phi_dd;
    let v621 = plate_phi_d * v341;
    let v622 = v620 + v621;
    let v623 = v183 * plate_phi_dd;
    let v624 = plate_phi_d * v339;
    let v625 = v623 + v624;
    let v626 = v193 * v350;
    let v627 = 2.0 * v626;
    let v628 = v194 * v351;
    let v629 = 2.0 * v628;
    let v630 = v304 * v195;
    let v631 = v159 * v352;
    let v632 = v630 + v631;
    let v633 = v299 * v196;
    let v634 = v151 * v353;
    let v635 = v633 + v634;
    let v636 = v212 * v336;
    let v637 = v181 * v410;
    let v638 = v636 + v637;
    let v639 = v216 * v337;
    let v640 = v182 * v422;
    let v641 = v639 + v640;
    let v642 = crank_phi_dd * v208;
    let v643 = crank_phi_d * v398;
    let v644 = v642 + v643;
    let v645 = -2.0 * v644;
    let v646 = v233 * v337;
    let v647 = v182 * v461;
    let v648 = v646 + v647;
    let v649 = v237 * v336;
    let v650 = v181 * v473;
    let v651 = v649 + v650;
    let v652 = v363 / v111;
    let v653 = v283 / v111;
    let v654 = v224 * v653;
    let v655 = v652 - v654;
    let v656 = v283 * v440;
    let v657 = v224 * v655;
    let v658 = v656 + v657;
    let v659 = v366 / v108;
    let v660 = v285 / v108;
    let v661 = v220 * v660;
    let v662 = v659 - v661;
    let v663 = v285 * v431;
    let v664 = v220 * v662;
    let v665 = v663 + v664;
    let v666 = v239 * v367;
    let v667 = v205 * v479;
    let v668 = v666 + v667;
    let v669 = 2.0 * v668;
    let v670 = v371 / v118;
    let v671 = v289 / v118;
    let v672 = v238 * v671;
    let v673 = -2.0 * v672;
    let v674 = v670 + v673;
    let v675 = v289 * v476;
    let v676 = v238 * v674;
    let v677 = v675 + v676;
    let v678 = -2.0 * v677;
    let v679 = v595 + v597;
    let v680 = v598 + v600;
    let v681 = a * v385;
    let v682 = -2.0 * v681;
    let v683 = a * v378;
    let v684 = -v683;
    let v685 = v601 + v602;
    let v686 = 2.0 * v685;
    let v687 = v603 + v604;
    let v688 = 2.0 * v687;
    let v689 = v686 + v688;
    let v690 = v689 / v101;
    let v691 = v330 / v101;
    let v692 = v178 * v691;
    let v693 = -2.0 * v692;
    let v694 = v690 + v693;
    let v695 = v613 + v694;
    let v696 = v614 + v616;
    let v697 = v617 + v619;
    let v698 = v620 + v622;
    let v699 = v623 + v625;
    let v700 = v1 * v698;
    let v701 = v1 * v699;
    let v702 = -0.1 * v698;
    let v703 = 0.1 * v699;
    let v704 = v700 - v703;
    let v705 = v381 + v704;
    let v706 = v701 - v702;
    let v707 = v682 + v706;
    let v708 = v85 * v705;
    let v709 = v626 + v708;
    let v710 = v627 + v709;
    let v711 = 2.0 * v710;
    let v712 = v86 * v707;
    let v713 = v628 + v712;
    let v714 = v629 + v713;
    let v715 = 2.0 * v714;
    let v716 = v711 + v715;
    let v717 = -0.6 * v679;
    let v718 = -0.6 * v680;
    let v719 = -0.8 * v679;
    let v720 = 0.8 * v680;
    let v721 = v717 + v720;
    let v722 = v718 + v719;
    let v723 = 0.6 * v722;
    let v724 = -0.8 * v721;
    let v725 = v723 + v724;
    let v726 = v87 * v385;
    let v727 = v630 - v726;
    let v728 = v632 + v727;
    let v729 = v631 + v632;
    let v730 = v728 + v729;
    let v731 = v88 * v379;
    let v732 = v633 + v731;
    let v733 = v635 + v732;
    let v734 = v634 + v635;
    let v735 = v733 + v734;
    let v736 = v730 + v735;
    let v737 = select(v89, v683, v684);
    let v738 = v737 / 10.0;
    let v739 = select(v90, 0.0, v695);
    let v740 = select(v91, v684, 0.0);
    let v741 = select(v91, 0.0, v374);
    let v742 = v740 + v741;
    let v743 = select(v93, v742, 0.0);
    let v744 = v739 + v743;
    let v745 = v104 * v696;
    let v746 = v636 - v745;
    let v747 = v638 + v746;
    let v748 = v105 * v697;
    let v749 = v639 - v748;
    let v750 = v641 + v749;
    let v751 = v747 + v750;
    let v752 = -2.0 * v642;
    let v753 = v645 + v752;
    let v754 = v753 / 10.0;
    let v755 = v115 * v697;
    let v756 = v646 - v755;
    let v757 = v648 + v756;
    let v758 = v116 * v696;
    let v759 = v649 - v758;
    let v760 = v651 + v759;
    let v761 = v757 - v760;
    let v762 = v378 / 3.0;
    let v763 = v762 / v111;
    let v764 = v362 / v111;
    let v765 = v224 * v764;
    let v766 = v763 - v765;
    let v767 = v766 - v658;
    let v768 = v767 / 4.0;
    let v769 = v372 / 2.0;
    let v770 = v769 / v108;
    let v771 = v365 / v108;
    let v772 = v220 * v771;
    let v773 = v770 + v772;
    let v774 = v665 + v773;
    let v775 = v774 - v768;
    let v776 = v761 + v775;
    let v777 = 2.0 * v666;
    let v778 = v669 + v777;
    let v779 = v370 / v118;
    let v780 = v238 * v779;
    let v781 = -2.0 * v780;
    let v782 = v678 + v781;
    let v783 = v100 * v782;
    let v784 = v783 / 5.0;
    let v785 = v778 + v784;
    let v786 = -v716;
    let v787 = -v725;
    let v788 = -v738;
    let v789 = v744 - v394;
    let v790 = v754 - v751;
    let v791 = -v776;
    let v792 = 0.17453292519943295 * v483;
    let v793 = v526 - v395;

    out[2] = v683;
    out[3] = v373;
    out[7] = v786;
    out[9] = v787;
    out[10] = v736;
    out[12] = v788;
    out[13] = v789;
    out[14] = v790;
    out[15] = v791;
    out[16] = v785;
    out[17] = v792;
    out[18] = v500;
    out[19] = v793;
    out[20] = v594;
    out
}

/// The Jacobian as a full matrix, row by row.
pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {
    let mut full = [[0.0; N]; N];
    for (&(row, column), value) in PHI_Q_PATTERN.iter().zip(phi_q(q, t, p)) {
        if let Some(entry) = full.get_mut(row).and_then(|line| line.get_mut(column)) {
            *entry = value;
        }
    }
    full
}

/// The measures with their time derivatives, from the coordinates, their velocities and
/// accelerations, and their third derivatives.
pub fn measures(q: &Q, qd: &Qd, qdd: &Qdd, qddd: &[f64; N], t: f64, p: &Params) -> Measures {
    let mut all = all_measures(q, qd, qdd, qddd, t, p).into_iter();
    let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;
    Measures {
        values: core::array::from_fn(|_| next()),
        rates: core::array::from_fn(|_| next()),
        accelerations: core::array::from_fn(|_| next()),
    }
}

/// The measures, their rates and their accelerations, one behind the other.
///
/// 102 operations.
fn all_measures(
    q: &[f64; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    qddd: &[f64; N],
    _t: f64,
    p: &Params,
) -> [f64; 16] {
    let mut out = [0.0; 16];
    let sled_x = q[9];
    let sled_y = q[10];
    let rocker_phi = q[8];
    let crank_phi = q[2];
    let free_phi = q[17];
    let free_x = q[15];
    let free_y = q[16];
    let rocker_phi_d = qd[8];
    let a = p.a;
    let rocker_x_d = qd[6];
    let crank_phi_d = qd[2];
    let free_phi_d = qd[17];
    let crank_phi_dd = qdd[2];
    let rocker_phi_dd = qdd[8];
    let rocker_x_dd = qdd[6];
    let free_phi_dd = qdd[17];
    let qddd2 = qddd[2];
    let qddd1 = qddd[1];
    let crank_x = q[0];
    let crank_y = q[1];
    let sled_x_d = qd[9];
    let sled_y_d = qd[10];
    let free_x_d = qd[15];
    let free_y_d = qd[16];
    let crank_x_d = qd[0];
    let crank_y_d = qd[1];
    let sled_x_dd = qdd[9];
    let sled_y_dd = qdd[10];
    let qddd8 = qddd[8];
    let qddd6 = qddd[6];
    let free_x_dd = qdd[15];
    let free_y_dd = qdd[16];
    let crank_x_dd = qdd[0];
    let crank_y_dd = qdd[1];

    let v1 = 0.6 * sled_x;
    let v2 = 0.8 * sled_y;
    let v3 = v1 + v2;
    let (s4, c4) = sin_cos(rocker_phi);
    let (s5, c5) = sin_cos(crank_phi);
    let (s6, c6) = sin_cos(free_phi);
    let v7 = 0.1 * c6;
    let v8 = 0.1 * s6;
    let v9 = v7 + free_x;
    let v10 = v8 + free_y;
    let v11 = s4 * rocker_phi_d;
    let v12 = a * v11;
    let v13 = -2.0 * v12;
    let v14 = v13 + rocker_x_d;
    let v15 = c5 * crank_phi_d;
    let v16 = s5 * crank_phi_d;
    let v17 = crank_phi_d * v15;
    let v18 = c4 * rocker_phi_d;
    let v19 = rocker_phi_d * v18;
    let v20 = rocker_phi_d * v11;
    let v21 = s6 * free_phi_d;
    let v22 = c6 * free_phi_d;
    let v23 = free_phi_d * v22;
    let v24 = free_phi_d * v21;
    let v25 = s5 * crank_phi_dd;
    let v26 = v17 + v25;
    let v27 = v16 * crank_phi_dd;
    let v28 = crank_phi_d * v26;
    let v29 = v27 + v28;
    let v30 = s4 * rocker_phi_dd;
    let v31 = v19 + v30;
    let v32 = a * v31;
    let v33 = -2.0 * v32;
    let v34 = v33 + rocker_x_dd;
    let v35 = c4 * rocker_phi_dd;
    let v36 = v35 - v20;
    let v37 = v18 * rocker_phi_dd;
    let v38 = rocker_phi_d * v36;
    let v39 = v37 + v38;
    let v40 = s6 * free_phi_dd;
    let v41 = v23 + v40;
    let v42 = c6 * free_phi_dd;
    let v43 = v42 - v24;
    let v44 = c5 * qddd2;
    let v45 = v44 - v27;
    let v46 = v45 - v29;
    let v47 = a * v46;
    let v48 = v47 + qddd1;
    let v49 = v9 - crank_x;
    let v50 = v10 - crank_y;
    let v51 = v49 * v49;
    let v52 = v50 * v50;
    let v53 = v51 + v52;
    let v54 = libm::sqrt(v53);
    let v55 = rocker_phi / 6.283185307179586;
    let v56 = 0.6 * sled_x_d;
    let v57 = 0.8 * sled_y_d;
    let v58 = v56 + v57;
    let v59 = rocker_phi_d / 6.283185307179586;
    let v60 = -0.1 * v21;
    let v61 = 0.1 * v22;
    let v62 = v60 + free_x_d;
    let v63 = v61 + free_y_d;
    let v64 = v62 - crank_x_d;
    let v65 = v63 - crank_y_d;
    let v66 = v49 * v64;
    let v67 = 2.0 * v66;
    let v68 = v50 * v65;
    let v69 = 2.0 * v68;
    let v70 = v67 + v69;
    let v71 = 2.0 * v54;
    let v72 = v70 / v71;
    let v73 = 0.6 * sled_x_dd;
    let v74 = 0.8 * sled_y_dd;
    let v75 = v73 + v74;
    let v76 = s4 * qddd8;
    let v77 = v37 + v76;
    let v78 = v39 + v77;
    let v79 = a * v78;
    let v80 = -2.0 * v79;
    let v81 = v80 + qddd6;
    let v82 = rocker_phi_dd / 6.283185307179586;
    let v83 = -0.1 * v41;
    let v84 = 0.1 * v43;
    let v85 = v83 + free_x_dd;
    let v86 = v84 + free_y_dd;
    let v87 = v85 - crank_x_dd;
    let v88 = v86 - crank_y_dd;
    let v89 = v64 * v64;
    let v90 = v49 * v87;
    let v91 = v89 + v90;
    let v92 = 2.0 * v91;
    let v93 = v65 * v65;
    let v94 = v50 * v88;
    let v95 = v93 + v94;
    let v96 = 2.0 * v95;
    let v97 = v92 + v96;
    let v98 = v97 / v71;
    let v99 = v72 / v71;
    let v100 = v72 * v99;
    let v101 = -2.0 * v100;
    let v102 = v98 + v101;

    out[0] = v3;
    out[1] = v14;
    out[2] = v48;
    out[3] = v55;
    out[4] = v54;
    out[5] = v50;
    out[6] = v58;
    out[7] = v34;
    out[8] = v59;
    out[9] = v72;
    out[10] = v65;
    out[11] = v75;
    out[12] = v81;
    out[13] = v82;
    out[14] = v102;
    out[15] = v88;
    out
}

pub use runtime::error::Error;
pub use runtime::limits::MOST_STEPS;

/// The mechanism at a time.
pub type State = runtime::state::State<Model>;

impl State {
    /// Where a body is (m, m, rad).
    #[must_use]
    pub fn pose(&self, body: Body) -> Pose {
        Pose::of(self.q(), body)
    }

    /// How fast a body moves (m/s, m/s, rad/s).
    #[must_use]
    pub fn velocity(&self, body: Body) -> Pose {
        Pose::of(self.qd(), body)
    }

    /// How a body's velocity changes (m/s^2, m/s^2, rad/s^2).
    #[must_use]
    pub fn acceleration(&self, body: Body) -> Pose {
        Pose::of(self.qdd(), body)
    }
}

/// Brings the mechanism to its first time with some parameters, along the branch that the file's
/// parameters give.
///
/// # Errors
/// It cannot be assembled with these, or not on that branch.
pub fn assemble(params: &Params) -> Result<State, Error> {
    runtime::assemble::assemble(params)
}

/// Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
/// and acceleration are those of the branch that it is on, whichever way `t` lies.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one; [`step_within`] takes as many as it is
/// allowed. What a driver does and undoes within a
/// step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].
/// At the end of the file's analysis the formulas of time take their earlier branches, as
/// `mechc run` has it; at any other time where they change, the later ones.
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach.
pub fn step(t: f64, state: &mut State) -> Result<(), Error> {
    step_within(t, state, MOST_STEPS)
}

/// As [`step`], in so many steps at most, for those who have a deadline: each solves the equations
/// about once, and one that has to be made shorter counts as well.
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach. Where that is
/// [`Error::TooFar`] the same call goes on from there.
pub fn step_within(t: f64, state: &mut State, most: usize) -> Result<(), Error> {
    runtime::step::step_within(t, state, most)
}

/// Number of results at a time.
pub const COLUMNS: usize = 80;

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.05;

/// How long the file's analysis takes (s).
const SPAN: f64 = 0.3;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.009375;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 3e-13;

/// What a change of each coordinate is judged against.
#[rustfmt::skip]
static SCALES: [f64; N] = [
    1.0, 1.0, 1.0, 0.5099019513592785,
    0.5099019513592785, 1.0, 2.0, 2.0,
    1.0, 2.0, 2.0, 1.0,
    2.0, 2.0, 1.0, 2.0,
    2.0, 1.0, 2.0, 2.0,
    1.0,
];

/// The assembled position (m, rad).
#[rustfmt::skip]
static START: [f64; N] = [
    0.0, 0.0, 0.42350803087916716, 0.9116528886269452,
    0.4109610816831038, 0.947106806477466, 4.0, 0.0,
    1.6185224440363692, 0.30000090269531243, 0.40000120359375, 0.0,
    3.874149966461081, 0.5388348014068367, 0.8092612220181846, 1.9012734549358443,
    1.0995286607939008, 4.8163705939406425, 0.6453861199758772, -0.28444640349331857,
    1.1272124627296347,
];

impl Measured for Measures {
    const ZERO: Self = Self {
        values: [0.0; MEASURES],
        rates: [0.0; RATES],
        accelerations: [0.0; ACCELERATIONS],
    };

    fn lists(&self) -> [&[f64]; 3] {
        [&self.values, &self.rates, &self.accelerations]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut self.values, &mut self.rates, &mut self.accelerations]
    }
}

/// Number of values that follow from the parameters alone.
const KNOWN: usize = 5;

/// What follows from the parameters alone.
///
/// 7 operations.
fn known(p: &Params) -> [f64; KNOWN] {
    let mut out = [0.0; KNOWN];
    let a = p.a;
    let half = p.half;
    let n = p.n;

    let v1 = libm::atan2(0.0, a);
    let v2 = v1 + -1.5707963267948966;
    let v3 = a * half;
    let v4 = half + -1.0;
    let v5 = -1.0 + v4;
    let v6 = 2.0 * n;
    let v7 = v6 / 10.0;

    out[0] = v2;
    out[1] = v3;
    out[2] = v4;
    out[3] = v7;
    out[4] = v5;
    out
}

/// The mechanism with its parameters, and what follows from these alone.
#[derive(Clone, Debug)]
pub struct Model {
    params: Params,
    known: [f64; KNOWN],
}

/// Number of coordinates that Newton solves for; the others follow.
const TEARS: usize = 5;

/// What a change of each of them is judged against (m, or 1 rad).
#[rustfmt::skip]
static TEAR_SCALES: [f64; TEARS] = [
    1.0, 2.0, 2.0, 2.0,
    1.0,
];

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 4;

/// Whether they are negative where all pivots are positive.
#[rustfmt::skip]
static TURNED: [bool; TURNS] = [
    false, true, false, false,
];

/// Number of places where formulas have branches.
const SIDES: usize = 21;

/// Which branch is taken at each: what a comparison gives, the number of a piece.
type Sides = [f64; SIDES];

/// The branches that time alone decides, the others as 0.
///
/// 19 operations.
fn sides_of_time(t: f64, _p: &Params) -> [f64; SIDES] {
    let mut out = [0.0; SIDES];
    let v1 = f64::from(t < 2.0);
    let v2 = f64::from(t < 0.0);
    let v3 = f64::from(t < 0.4);
    let v4 = f64::from(t < 0.1);
    let v5 = f64::from(t < 3.0);
    let v6 = f64::from(t == 1.5);
    let v7 = f64::from(t <= 2.0);
    let v8 = f64::from(t < 1.0);
    let v9 = f64::from(7.0 <= t);
    let v10 = f64::from(5.0 < t);
    let v11 = f64::from(t == t);
    let v12 = 1.0 + t;
    let v13 = v12 / 6.0;
    let v14 = f64::from(v13 < 0.875);
    let v15 = f64::from(v13 < 0.125);
    let v16 = f64::from(t < 5.0);
    let v17 = f64::from(t < -1.0);
    let v18 = t / 10.0;
    let v19 = libm::floor(v18);

    out[0] = v1;
    out[1] = v2;
    out[2] = v3;
    out[3] = v4;
    out[4] = v5;
    out[5] = v6;
    out[6] = v7;
    out[7] = v8;
    out[8] = v9;
    out[9] = v10;
    out[10] = v11;
    out[11] = v14;
    out[12] = v15;
    out[13] = v16;
    out[14] = v17;
    out[15] = v19;
    out
}

/// Which of them time alone decides.
#[rustfmt::skip]
static IS_OF_TIME: [bool; SIDES] = [
    true, true, true, true,
    true, true, true, true,
    true, true, true, true,
    true, true, true, true,
    false, false, false, false,
    false,
];

/// The branches at a position, those of time being known.
///
/// 20 operations.
fn sides_of_motion(q: &[f64; N], _t: f64, p: &Params, sides: &Sides) -> [f64; SIDES] {
    let mut out = [0.0; SIDES];
    let crank_phi = q[2];
    let a = p.a;
    let crank_x = q[0];
    let crank_y = q[1];
    let sled_x = q[9];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let gauge_phi = q[20];
    let gauge_x = q[18];

    let (s1, c1) = sin_cos(crank_phi);
    let v2 = a * c1;
    let v3 = a * s1;
    let v4 = v2 + crank_x;
    let v5 = v3 + crank_y;
    let v6 = v4 - sled_x;
    let v7 = rocker_x - crank_x;
    let v8 = rocker_y - crank_y;
    let v9 = v7 * v7;
    let v10 = v8 * v8;
    let v11 = v9 + v10;
    let v12 = libm::sqrt(v11);
    let (_, c13) = sin_cos(gauge_phi);
    let v14 = c13 + gauge_x;
    let v15 = f64::from(v6 < 0.0);
    let v16 = f64::from(a < v12);
    let v17 = f64::from(v5 < v4);
    let v18 = either(v17, v4, v5);
    let v19 = f64::from(0.2 < v18);
    let v20 = sign(v14);

    out[0] = sides[0];
    out[1] = sides[1];
    out[2] = sides[2];
    out[3] = sides[3];
    out[4] = sides[4];
    out[5] = sides[5];
    out[6] = sides[6];
    out[7] = sides[7];
    out[8] = sides[8];
    out[9] = sides[9];
    out[10] = sides[10];
    out[11] = sides[11];
    out[12] = sides[12];
    out[13] = sides[13];
    out[14] = sides[14];
    out[15] = sides[15];
    out[16] = v15;
    out[17] = v16;
    out[18] = v17;
    out[19] = v19;
    out[20] = v20;
    out
}

/// What solves the equations at a time.
type Solution = runtime::solution::Solution<Model>;

/// Position, velocity and acceleration at a time. Newton begins with a guess of `rocker.phi`,
/// `sled.y`, `gauge.y`, `gauge.x`, `sled.phi`; all else follows.
///
/// 811 operations.
fn solve(guess: &[f64; TEARS], t: f64, m: &Model, sides: &Sides, at: &mut Solution) {
    at.begin(t);
    let v1 = 2.0 * t;
    let (s2, c2) = sin_cos(v1);
    let v3 = 4.0 * t;
    let (s4, c4) = sin_cos(v3);
    let v5 = c4 / m.params.n;
    let v6 = v5 + s2;
    let v7 = 0.17453292519943295 * v6 + -1.2217304763960306;
    let v8 = m.known[0] - v7;
    let crank_phi = -v8;
    at.q[2] = crank_phi + 0.0;
    let v10 = -4.0 * s4;
    let v11 = v10 / m.params.n;
    let v12 = 2.0 * c2 + v11;
    let crank_phi_d = 0.17453292519943295 * v12;
    at.qd[2] = crank_phi_d + 0.0;
    let v14 = -16.0 * c4;
    let v15 = v14 / m.params.n;
    let v16 = -4.0 * s2 + v15;
    let crank_phi_dd = 0.17453292519943295 * v16;
    at.qdd[2] = crank_phi_dd + 0.0;
    let v18 = 64.0 * s4;
    let v19 = v18 / m.params.n;
    let v20 = -8.0 * c2 + v19;
    let v21 = 0.17453292519943295 * v20;
    let v22 = -v8;
    let (s23, c23) = sin_cos(v22);
    let plate_x = m.params.a * c23;
    at.q[3] = plate_x + 0.0;
    let plate_y = m.params.a * s23;
    let v26 = plate_y * crank_phi_d;
    let plate_x_d = -v26;
    at.qd[3] = plate_x_d + 0.0;
    let v28 = c23 * crank_phi_d;
    let v29 = crank_phi_d * v28;
    let v30 = m.params.a * v29;
    let v31 = plate_y * crank_phi_dd + v30;
    let plate_x_dd = -v31;
    at.qdd[3] = plate_x_dd + 0.0;
    let v33 = s23 * crank_phi_d;
    let v34 = crank_phi_d * v33;
    let v35 = c23 * crank_phi_dd - v34;
    let v36 = v28 * crank_phi_dd;
    let v37 = crank_phi_d * v35 + v36;
    let v38 = v36 + v37;
    let v39 = m.params.a * v38;
    let v40 = plate_y * v21 + v39;
    at.q[4] = plate_y + 0.0;
    let plate_y_d = plate_x * crank_phi_d;
    at.qd[4] = plate_y_d + 0.0;
    let v42 = m.params.a * v34;
    let v43 = v42 - plate_x * crank_phi_dd;
    let plate_y_dd = -v43;
    at.qdd[4] = plate_y_dd + 0.0;
    let v45 = s23 * crank_phi_dd + v29;
    let v46 = v33 * crank_phi_dd;
    let v47 = crank_phi_d * v45 + v46;
    let v48 = v46 + v47;
    let v49 = m.params.a * v48;
    let v50 = v49 - plate_x * v21;
    let v51 = v8 + -0.5235987755982988;
    let plate_phi = -v51;
    at.q[5] = plate_phi + 0.0;
    at.qd[5] = crank_phi_d + 0.0;
    at.qdd[5] = crank_phi_dd + 0.0;
    at.q[6] = 4.0;
    let mut x1 = guess[0];
    let v53 = -v51;
    let (s54, c54) = sin_cos(v53);
    let v55 = c54 * m.known[1];
    let v56 = v55 - 0.1 * s54;
    let v57 = plate_x + v56;
    let v58 = s54 * m.known[1];
    let v59 = 0.1 * c54 + v58;
    let v60 = plate_y + v59;
    let mut s61 = 0.0;
    let mut c61 = 0.0;
    let mut v78 = 0.0;
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x1 = on_grid(x1, 7.450580596923828e-9);
        (s61, c61) = sin_cos(x1);
        let v62 = m.params.a * c61;
        let v63 = 2.0 * v62 + 4.0;
        let v64 = v63 - v57;
        let v65 = m.params.a * v64;
        let v66 = s61 * v65;
        let v67 = m.params.a * s61;
        let v68 = 2.0 * v67 - v60;
        let v69 = m.params.a * v68;
        let v70 = c61 * v69;
        let v71 = 4.0 * v70;
        let v72 = -4.0 * v66 + v71;
        let v73 = 1.0 / v72;
        let v74 = v64 * v64;
        let v75 = v68 * v68 + v74;
        let v76 = v75 + -9.0;
        let v77 = v76 * v73;
        v78 = -v77;
        x1 = newton.corrected(x1, v78, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
    let v79 = 0.5 * v78;
    let v80 = c61 - v79 * s61;
    let v81 = v78 * v80 + s61;
    let v82 = v79 * c61 + s61;
    let v83 = c61 - v78 * v82;
    let v84 = m.params.a * v81;
    let v85 = 2.0 * v84 - v60;
    let v86 = m.params.a * v83;
    let v87 = 2.0 * v86 + 4.0;
    let v88 = v87 - v57;
    let v89 = v88 * v88;
    let v90 = v85 * v85 + v89;
    let v91 = v90 + -9.0;
    at.holds &= v91.abs() <= 1.6956334056335112e-11;
    let v92 = m.params.a * v88;
    let v93 = v81 * v92;
    let v94 = m.params.a * v85;
    let v95 = v83 * v94;
    let v96 = 4.0 * v95;
    let v97 = -4.0 * v93 + v96;
    let v98 = 1.0 / v97;
    at.q[8] = x1 + 0.0;
    at.pivot(0, v98, 16.916798221926335);
    let v99 = -2.0 * v88;
    let v100 = v99 * v26;
    let v101 = -2.0 * v85;
    let v102 = v100 - v101 * plate_y_d;
    let v103 = m.known[1] * v88;
    let v104 = -0.2 * v85;
    let v105 = -2.0 * v103 + v104;
    let v106 = m.known[1] * v85;
    let v107 = -2.0 * v106;
    let v108 = 0.2 * v88 + v107;
    let v109 = c54 * v108;
    let v110 = v109 - s54 * v105;
    let v111 = v102 - v110 * crank_phi_d;
    let rocker_phi_d = v111 * v98;
    at.qd[8] = rocker_phi_d + 0.0;
    let v113 = c54 * crank_phi_d;
    let v114 = crank_phi_d * v113;
    let v115 = s54 * crank_phi_d;
    let v116 = crank_phi_d * v115;
    let v117 = m.known[1] * v116;
    let v118 = v117 - -0.1 * v114;
    let v119 = v81 * rocker_phi_d;
    let v120 = rocker_phi_d * v119;
    let v121 = m.params.a * v120;
    let v122 = -2.0 * v121 + v118;
    let v123 = m.known[1] * v113;
    let v124 = -0.1 * v115 + v123;
    let v125 = plate_y_d + v124;
    let v126 = v83 * rocker_phi_d;
    let v127 = m.params.a * v126;
    let v128 = 2.0 * v127 - v125;
    let v129 = v128 * v128;
    let v130 = v85 * v122 + v129;
    let v131 = m.known[1] * v114;
    let v132 = v131 - 0.1 * v116;
    let v133 = rocker_phi_d * v126;
    let v134 = m.params.a * v133;
    let v135 = -2.0 * v134 + v132;
    let v136 = -0.1 * v113;
    let v137 = v136 - m.known[1] * v115;
    let v138 = v137 - v26;
    let v139 = m.params.a * v119;
    let v140 = -2.0 * v139;
    let v141 = v140 - v138;
    let v142 = v141 * v141;
    let v143 = v88 * v135 + v142;
    let v144 = 2.0 * v143;
    let v145 = 2.0 * v130 + v144;
    let v146 = v99 * v31 - v145;
    let v147 = v101 * v43 + v146;
    let v148 = v147 - v110 * crank_phi_dd;
    let rocker_phi_dd = v148 * v98;
    at.qdd[8] = rocker_phi_dd + 0.0;
    let v150 = c54 * crank_phi_dd - v116;
    let v151 = v113 * crank_phi_dd;
    let v152 = crank_phi_d * v150 + v151;
    let v153 = v151 + v152;
    let v154 = s54 * crank_phi_dd + v114;
    let v155 = v115 * crank_phi_dd;
    let v156 = crank_phi_d * v154 + v155;
    let v157 = v155 + v156;
    let v158 = m.known[1] * v157;
    let v159 = v158 - -0.1 * v153;
    let v160 = v81 * rocker_phi_dd + v133;
    let v161 = v119 * rocker_phi_dd;
    let v162 = rocker_phi_d * v160 + v161;
    let v163 = v161 + v162;
    let v164 = m.params.a * v163;
    let v165 = -2.0 * v164 + v159;
    let v166 = m.known[1] * v150;
    let v167 = -0.1 * v154 + v166;
    let v168 = v167 - v43;
    let v169 = v83 * rocker_phi_dd - v120;
    let v170 = m.params.a * v169;
    let v171 = 2.0 * v170 - v168;
    let v172 = v128 * v171;
    let v173 = v85 * v165 + v172;
    let v174 = 2.0 * v172 + v173;
    let v175 = m.known[1] * v153;
    let v176 = v175 - 0.1 * v157;
    let v177 = v126 * rocker_phi_dd;
    let v178 = rocker_phi_d * v169 + v177;
    let v179 = v177 + v178;
    let v180 = m.params.a * v179;
    let v181 = -2.0 * v180 + v176;
    let v182 = -0.1 * v150;
    let v183 = v182 - m.known[1] * v154;
    let v184 = v183 - v31;
    let v185 = m.params.a * v160;
    let v186 = -2.0 * v185;
    let v187 = v186 - v184;
    let v188 = v141 * v187;
    let v189 = v88 * v181 + v188;
    let v190 = 2.0 * v188 + v189;
    let v191 = 2.0 * v190;
    let v192 = 2.0 * v174 + v191;
    let v193 = v99 * v40 - v192;
    let v194 = v101 * v50 + v193;
    let v195 = v194 - v110 * v21;
    let v196 = v195 * v98;
    let mut x2 = guess[1];
    let v197 = -0.1 + t;
    let v198 = v197 / 0.30000000000000004;
    let v199 = -2.0 * v198 + 3.0;
    let v200 = v198 * v199;
    let v201 = v198 * v200;
    let v202 = select(sides[2], v201, 1.0);
    let v203 = select(sides[3], 0.0, v202);
    let v204 = 0.1 * v203 + 0.5;
    let v205 = t / 2.0;
    let v206 = 6.0 * v205 + -15.0;
    let v207 = v205 * v206 + 10.0;
    let v208 = v205 * v207;
    let v209 = v205 * v208;
    let v210 = v205 * v209;
    let v211 = select(sides[0], v210, 1.0);
    let v212 = select(sides[1], 0.0, v211);
    let v213 = 0.01 * v212 + v204;
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x2 = on_grid(x2, 1.4901161193847656e-8);
        let v214 = 0.6 * x2;
        let v215 = v214 / -0.8;
        let v216 = 0.8 * x2;
        let v217 = v216 - 0.6 * v215;
        let v218 = v217 - v213;
        let v219 = 0.75 * v218;
        let v220 = v219 * -0.8;
        let v221 = 0.6 * v220 + v218;
        let v222 = v221 * 1.25;
        let v223 = -v222;
        x2 = newton.corrected(x2, v223, 1.4901161193847656e-8, 2.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
    let v224 = 0.6 * x2;
    let v225 = v224 / -0.8;
    let v226 = 0.8 * x2;
    let v227 = v226 - 0.6 * v225;
    let v228 = v227 - v213;
    at.holds &= v228.abs() <= 2.0005684358990175e-12;
    let sled_x = -v225;
    at.q[9] = sled_x + 0.0;
    at.q[10] = x2 + 0.0;
    let v230 = 3.333333333333333 * v199;
    let v231 = -6.666666666666666 * v198 + v230;
    let v232 = 3.333333333333333 * v200;
    let v233 = v198 * v231 + v232;
    let v234 = select(sides[2], v233, 0.0);
    let v235 = select(sides[3], 0.0, v234);
    let v236 = 3.0 * v205;
    let v237 = 0.5 * v206 + v236;
    let v238 = 0.5 * v207;
    let v239 = v205 * v237 + v238;
    let v240 = 0.5 * v208;
    let v241 = v205 * v239 + v240;
    let v242 = 0.5 * v209;
    let v243 = v205 * v241 + v242;
    let v244 = select(sides[0], v243, 0.0);
    let v245 = select(sides[1], 0.0, v244);
    let v246 = 0.01 * v245;
    let v247 = 0.1 * v235 + v246;
    let v248 = 0.75 * v247;
    let v249 = v248 * -0.8;
    let v250 = 0.6 * v249 + v247;
    let sled_y_d = v250 * 1.25;
    let sled_x_d = -v249;
    at.qd[9] = sled_x_d + 0.0;
    at.qd[10] = sled_y_d + 0.0;
    let v253 = 3.333333333333333 * v231;
    let v254 = -44.444444444444436 * v198 + v253;
    let v255 = v253 + v254;
    let v256 = select(sides[2], v255, 0.0);
    let v257 = select(sides[3], 0.0, v256);
    let v258 = 0.5 * v237;
    let v259 = v236 + v258;
    let v260 = v258 + v259;
    let v261 = 0.5 * v239;
    let v262 = v205 * v260 + v261;
    let v263 = v261 + v262;
    let v264 = 0.5 * v241;
    let v265 = v205 * v263 + v264;
    let v266 = v264 + v265;
    let v267 = select(sides[0], v266, 0.0);
    let v268 = select(sides[1], 0.0, v267);
    let v269 = 0.01 * v268;
    let v270 = 0.1 * v257 + v269;
    let v271 = 0.75 * v270;
    let v272 = v271 * -0.8;
    let v273 = 0.6 * v272 + v270;
    let sled_y_dd = v273 * 1.25;
    let sled_x_dd = -v272;
    at.qdd[9] = sled_x_dd + 0.0;
    at.qdd[10] = sled_y_dd + 0.0;
    let v276 = plate_x + v225;
    let v277 = -v276;
    let v278 = select(sides[16], v277, v276);
    let v279 = v278 / 10.0;
    let v280 = v279 + -0.6;
    let stone_y = -v280;
    at.q[13] = stone_y + 0.0;
    let v282 = select(sides[16], -0.1, 0.1);
    let v283 = m.params.a * v282;
    let v284 = s23 * v283;
    let v285 = v284 * crank_phi_d;
    let stone_y_d = v285 - v282 * v249;
    at.qd[13] = stone_y_d + 0.0;
    let v287 = -v30;
    let v288 = select(sides[16], v30, v287);
    let v289 = v288 / 10.0;
    let v290 = v284 * crank_phi_dd - v289;
    let stone_y_dd = v290 - v282 * v272;
    at.qdd[13] = stone_y_dd + 0.0;
    let v292 = v83 * v280;
    let v293 = v81 * -4.0 + v292;
    let v294 = -0.1 - v293;
    let stone_x = v294 / v81;
    let v296 = 1.0 / v81;
    at.q[12] = stone_x + 0.0;
    at.pivot(1, v296, 1.4401546075117153);
    let v297 = 4.0 - stone_x;
    let v298 = v83 * v297;
    let v299 = v81 * v280 + v298;
    let v300 = v299 * rocker_phi_d;
    let v301 = v83 * stone_y_d + v300;
    let stone_x_d = v301 * v296;
    at.qd[12] = stone_x_d + 0.0;
    let v303 = v119 * stone_y_d;
    let v304 = v303 - v280 * v133;
    let v305 = v303 + v304;
    let v306 = stone_x + -4.0;
    let v307 = v126 * stone_x_d;
    let v308 = v307 - v306 * v120;
    let v309 = v307 + v308;
    let v310 = v309 + v305;
    let v311 = v310 - v299 * rocker_phi_dd;
    let v312 = v311 - v83 * stone_y_dd;
    let v313 = v312 * v296;
    let stone_x_dd = -v313;
    at.qdd[12] = stone_x_dd + 0.0;
    let stone_phi = x1 / 2.0;
    at.q[14] = stone_phi + 0.0;
    let v316 = -0.5 * rocker_phi_d;
    let stone_phi_d = -v316;
    at.qd[14] = stone_phi_d + 0.0;
    let v318 = -0.5 * rocker_phi_dd;
    let stone_phi_dd = -v318;
    at.qdd[14] = stone_phi_dd + 0.0;
    let v320 = -t;
    let v321 = libm::exp(v320);
    let v322 = 1.0 + t;
    let v323 = libm::log(v322);
    let v324 = 2.0 + t;
    let v325 = libm::log10(v324);
    let v326 = v325 * v323 + v321;
    let v327 = libm::sqrt(v322);
    let v328 = v327 + v326;
    let v329 = t - 10.0 * sides[15];
    let v330 = v329 + v328;
    let v331 = v322 / 6.0;
    let v332 = 6.283185307179586 * v331;
    let (s333, c333) = sin_cos(v332);
    let v334 = v331 - 0.15915494309189535 * s333;
    let v335 = select(sides[13], v334, 1.0);
    let v336 = select(sides[14], 0.0, v335);
    let v337 = v336 + v330;
    let v338 = 12.566370614359172 * v331;
    let (s339, c339) = sin_cos(v338);
    let v340 = 3.141592653589793 * v331;
    let v341 = v340 - 0.25 * s339;
    let v342 = 4.0 + v341;
    let v343 = 4.1887902047863905 * v331 + 1.0471975511965976;
    let (s344, c344) = sin_cos(v343);
    let v345 = v340 - 2.25 * s344;
    let v346 = 2.0 + v345;
    let v347 = select(sides[11], v346, v342);
    let v348 = select(sides[12], v341, v347);
    let v349 = 0.14002478837788934 * v348;
    let v350 = select(sides[13], v349, 1.0);
    let v351 = select(sides[14], 0.0, v350);
    let v352 = v351 + v337;
    let v353 = m.params.n * t;
    let v354 = 2.0 + v353;
    let v355 = t * v354 + 1.0;
    let v356 = v355 / 10.0;
    let v357 = v356 + v352;
    let v358 = t / 3.0;
    let v359 = libm::sinh(v358);
    let v360 = t / 4.0;
    let v361 = libm::cosh(v360);
    let v362 = v361 * v359;
    let v363 = v362 + v357;
    let v364 = libm::pow(2.0, v358);
    let v365 = v364 + v363;
    let v366 = libm::pow(t, m.params.half);
    let v367 = v366 + v365;
    let v368 = v322 * v322;
    let v369 = 1.0 / v368;
    let v370 = v369 + v367;
    let v371 = f64::from(sides[10] == 0.0);
    let v372 = f64::from(sides[8] != 0.0 || sides[9] != 0.0);
    let v373 = f64::from(v372 != 0.0 || v371 != 0.0);
    let v374 = select(v373, 1.0, 0.0);
    let v375 = v374 + v370;
    let v376 = v8 - v375;
    let free_phi = -v376;
    at.q[17] = free_phi + 0.0;
    let v378 = 1.0 / v322;
    let v379 = 2.302585092994046 * v324;
    let v380 = 1.0 / v379;
    let v381 = v323 * v380;
    let v382 = v325 * v378 + v381;
    let v383 = v382 - v321;
    let v384 = 2.0 * v327;
    let v385 = 1.0 / v384;
    let v386 = v385 + v383;
    let v387 = 1.0 + v386;
    let v388 = -0.16666666666666666 * c333 + 0.16666666666666666;
    let v389 = select(sides[13], v388, 0.0);
    let v390 = select(sides[14], 0.0, v389);
    let v391 = v390 + v387;
    let v392 = -0.5235987755982988 * c339 + 0.5235987755982988;
    let v393 = -1.5707963267948963 * c344 + 0.5235987755982988;
    let v394 = select(sides[11], v393, v392);
    let v395 = select(sides[12], v392, v394);
    let v396 = 0.14002478837788934 * v395;
    let v397 = select(sides[13], v396, 0.0);
    let v398 = select(sides[14], 0.0, v397);
    let v399 = v398 + v391;
    let v400 = v353 + v354;
    let v401 = v400 / 10.0;
    let v402 = v401 + v399;
    let v403 = libm::cosh(v358);
    let v404 = v361 * v403;
    let v405 = libm::sinh(v360);
    let v406 = v359 * v405;
    let v407 = 0.25 * v406;
    let v408 = 0.3333333333333333 * v404 + v407;
    let v409 = v408 + v402;
    let v410 = 0.23104906018664842 * v364 + v409;
    let v411 = libm::pow(t, m.known[2]);
    let v412 = m.params.half * v411 + v410;
    let v413 = v322 * v322;
    let v414 = v413 * v322;
    let v415 = 1.0 / v414;
    let v416 = -2.0 * v415 + v412;
    let free_phi_d = v416 + crank_phi_d;
    at.qd[17] = free_phi_d + 0.0;
    let v418 = v378 / v322;
    let v419 = v380 * v378;
    let v420 = v419 - v325 * v418;
    let v421 = v380 / v379;
    let v422 = v323 * v421;
    let v423 = -2.302585092994046 * v422 + v419;
    let v424 = v423 + v420;
    let v425 = v321 + v424;
    let v426 = v385 / v384;
    let v427 = v385 * v426;
    let v428 = -2.0 * v427 + v425;
    let v429 = 0.17453292519943292 * s333;
    let v430 = select(sides[13], v429, 0.0);
    let v431 = select(sides[14], 0.0, v430);
    let v432 = v431 + v428;
    let v433 = 1.0966227112321507 * s339;
    let v434 = 1.0966227112321505 * s344;
    let v435 = select(sides[11], v434, v433);
    let v436 = select(sides[12], v433, v435);
    let v437 = 0.14002478837788934 * v436;
    let v438 = select(sides[13], v437, 0.0);
    let v439 = select(sides[14], 0.0, v438);
    let v440 = v439 + v432;
    let v441 = m.known[3] + v440;
    let v442 = v405 * v403;
    let v443 = 0.25 * v442;
    let v444 = 0.3333333333333333 * v362 + v443;
    let v445 = 0.3333333333333333 * v442;
    let v446 = 0.25 * v362 + v445;
    let v447 = 0.25 * v446;
    let v448 = 0.3333333333333333 * v444 + v447;
    let v449 = v448 + v441;
    let v450 = 0.053383668213133485 * v364 + v449;
    let v451 = libm::pow(t, m.known[4]);
    let v452 = m.known[2] * v451;
    let v453 = m.params.half * v452 + v450;
    let v454 = v322 * v322;
    let v455 = v454 * v454;
    let v456 = 1.0 / v455;
    let v457 = 6.0 * v456 + v453;
    let free_phi_dd = v457 + crank_phi_dd;
    at.qdd[17] = free_phi_dd + 0.0;
    let v459 = -v376;
    let (s460, c460) = sin_cos(v459);
    let v461 = 0.1 * c460;
    let v462 = either(sides[18], plate_x, plate_y);
    let v463 = either(sides[19], v462, 0.2);
    let v464 = libm::sqrt(16.0);
    let v465 = either(sides[17], m.params.a, v464);
    let v466 = v465 + v463;
    let v467 = v461 - v466;
    let free_x = -v467;
    at.q[15] = free_x + 0.0;
    let v469 = select(sides[18], 0.0, plate_x);
    let v470 = -plate_y;
    let v471 = select(sides[18], v470, 0.0);
    let v472 = v471 + v469;
    let v473 = select(sides[19], v472, 0.0);
    let v474 = v473 * crank_phi_d;
    let v475 = -0.1 * s460;
    let free_x_d = v474 - v475 * free_phi_d;
    at.qd[15] = free_x_d + 0.0;
    let v477 = c460 * free_phi_d;
    let v478 = free_phi_d * v477;
    let v479 = -v42;
    let v480 = select(sides[18], 0.0, v479);
    let v481 = -v30;
    let v482 = select(sides[18], v481, 0.0);
    let v483 = v482 + v480;
    let v484 = select(sides[19], v483, 0.0);
    let v485 = select(sides[17], 0.0, 0.0);
    let v486 = v485 + v484;
    let v487 = v486 - -0.1 * v478;
    let v488 = v473 * crank_phi_dd + v487;
    let free_x_dd = v488 - v475 * free_phi_dd;
    at.qdd[15] = free_x_dd + 0.0;
    let v490 = s460 * free_phi_d;
    let v491 = free_phi_d * v490;
    let v492 = c460 * free_phi_dd - v491;
    let v493 = -v8;
    let v494 = libm::atan(v493);
    let v495 = v494 * sides[20];
    let v496 = v495 / 5.0;
    let v497 = 1.0 + v496;
    let v498 = v8 / 9.0;
    let v499 = -v498;
    let v500 = libm::tan(v499);
    let gauge_phi = v500 + v497;
    at.q[20] = gauge_phi + 0.0;
    let v502 = v500 * v500 + 1.0;
    let v503 = v502 / 9.0;
    let v504 = v8 * v8 + 1.0;
    let v505 = -0.2 * sides[20];
    let v506 = v505 / v504;
    let v507 = v506 - v503;
    let v508 = v507 * crank_phi_d;
    let gauge_phi_d = -v508;
    at.qd[20] = gauge_phi_d + 0.0;
    let v510 = crank_phi_d / v504;
    let v511 = v510 / v504;
    let v512 = v8 * crank_phi_d;
    let v513 = v512 * v511;
    let v514 = sides[20] * v513;
    let v515 = -2.0 * v514;
    let v516 = v515 / 5.0;
    let v517 = crank_phi_d / 9.0;
    let v518 = v502 * v517;
    let v519 = v500 * v518;
    let v520 = v517 * v519;
    let v521 = 2.0 * v520 - v516;
    let gauge_phi_dd = v521 - v507 * crank_phi_dd;
    at.qdd[20] = gauge_phi_dd + 0.0;
    let mut x3 = guess[2];
    let mut x4 = guess[3];
    let (s523, c523) = sin_cos(gauge_phi);
    let v524 = -v8;
    let v525 = libm::tanh(v524);
    let v526 = v525 / 10.0;
    let v527 = v526 + 1.2;
    let v528 = s23 / 2.0;
    let v529 = libm::asin(v528);
    let v530 = c23 / 3.0;
    let v531 = libm::acos(v530);
    let v532 = v531 / 4.0;
    let v533 = v532 + v529;
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x3 = on_grid(x3, 1.4901161193847656e-8);
        x4 = on_grid(x4, 1.4901161193847656e-8);
        let v534 = s523 + x3;
        let v535 = c523 + x4;
        let v536 = libm::hypot(v535, v534);
        let v537 = v535 / v536;
        let v538 = v534 / v536;
        let v539 = v534 * v534;
        let v540 = v535 * v535 + v539;
        let v541 = v534 / v540;
        let v542 = v535 / v540;
        let v543 = v537 * v542;
        let v544 = v538 * v541 + v543;
        let v545 = 1.0 / v544;
        let v546 = v536 - v527;
        let v547 = libm::atan2(v534, v535);
        let v548 = v547 - v533;
        let v549 = v538 * v548;
        let v550 = v549 - v542 * v546;
        let v551 = v550 * v545;
        let v552 = v537 * v548;
        let v553 = v541 * v546 + v552;
        let v554 = v553 * v545;
        let v555 = -v554;
        x3 = newton.corrected(x3, v555, 1.4901161193847656e-8, 2.0);
        x4 = newton.corrected(x4, v551, 1.4901161193847656e-8, 2.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
    let v556 = s523 + x3;
    let v557 = c523 + x4;
    let v558 = libm::hypot(v557, v556);
    let v559 = v558 - v527;
    at.holds &= v559.abs() <= 2.082079197638904e-12;
    let v560 = libm::atan2(v556, v557);
    let v561 = v560 - v533;
    at.holds &= v561.abs() <= 1.8160899221873146e-12;
    let v562 = v557 / v558;
    let v563 = v556 / v558;
    let v564 = v556 * v556;
    let v565 = v557 * v557 + v564;
    let v566 = v556 / v565;
    let v567 = v557 / v565;
    let v568 = v562 * v567;
    let v569 = v563 * v566 + v568;
    let v570 = 1.0 / v569;
    at.q[18] = x4 + 0.0;
    at.q[19] = x3 + 0.0;
    at.pivot(2, v570, 0.944102802144833);
    let v571 = 1.0 - v525 * v525;
    let v572 = -0.1 * v571;
    let v573 = c523 * v563;
    let v574 = v573 - s523 * v562;
    let v575 = v574 * v508;
    let v576 = v575 - v572 * crank_phi_d;
    let v577 = 1.0 - v530 * v530;
    let v578 = libm::sqrt(v577);
    let v579 = -0.25 / v578;
    let v580 = v579 / 3.0;
    let v581 = 1.0 - v528 * v528;
    let v582 = libm::sqrt(v581);
    let v583 = -1.0 / v582;
    let v584 = v583 / 2.0;
    let v585 = c23 * v584;
    let v586 = s23 * v580 + v585;
    let v587 = c523 * v567;
    let v588 = s523 * v566 + v587;
    let v589 = v588 * v508;
    let v590 = v589 - v586 * crank_phi_d;
    let v591 = v567 * v576;
    let v592 = v591 - v563 * v590;
    let gauge_x_d = v592 * v570;
    let v594 = v562 * v590;
    let v595 = v566 * v576 + v594;
    let gauge_y_d = v595 * v570;
    at.qd[18] = gauge_x_d + 0.0;
    at.qd[19] = gauge_y_d + 0.0;
    let v597 = s523 * v508;
    let v598 = v508 * v597;
    let v599 = v563 / v558;
    let v600 = c523 * v508;
    let v601 = gauge_y_d - v600;
    let v602 = gauge_x_d + v597;
    let v603 = v562 * v602;
    let v604 = v563 * v601 + v603;
    let v605 = v601 / v558;
    let v606 = v605 - v604 * v599;
    let v607 = v601 * v606;
    let v608 = v607 - v563 * v598;
    let v609 = v508 * v600;
    let v610 = v562 / v558;
    let v611 = v602 / v558;
    let v612 = v611 - v604 * v610;
    let v613 = v602 * v612;
    let v614 = v613 - v562 * v609;
    let v615 = v614 + v608;
    let v616 = crank_phi_d * v571;
    let v617 = v525 * v616;
    let v618 = crank_phi_d * v617;
    let v619 = -2.0 * v618;
    let v620 = v619 / 10.0;
    let v621 = v620 - v615;
    let v622 = v621 - v572 * crank_phi_dd;
    let v623 = v622 - v574 * gauge_phi_dd;
    let v624 = v33 / 3.0;
    let v625 = v624 / v578;
    let v626 = v625 / v578;
    let v627 = 2.0 * v578;
    let v628 = v530 * v624;
    let v629 = 2.0 * v628;
    let v630 = v629 / v627;
    let v631 = v29 / 3.0;
    let v632 = v631 / v578;
    let v633 = v632 - v630 * v626;
    let v634 = v633 / 4.0;
    let v635 = v28 / 2.0;
    let v636 = v635 / v582;
    let v637 = v636 / v582;
    let v638 = 2.0 * v582;
    let v639 = v528 * v635;
    let v640 = -2.0 * v639;
    let v641 = v640 / v638;
    let v642 = v34 / 2.0;
    let v643 = v642 / v582;
    let v644 = v641 * v637 + v643;
    let v645 = v644 - v634;
    let v646 = v566 / v565;
    let v647 = v557 * v602;
    let v648 = v556 * v601;
    let v649 = 2.0 * v648;
    let v650 = 2.0 * v647 + v649;
    let v651 = v601 / v565;
    let v652 = v651 - v650 * v646;
    let v653 = v566 * v609;
    let v654 = v653 - v602 * v652;
    let v655 = v567 / v565;
    let v656 = v602 / v565;
    let v657 = v656 - v650 * v655;
    let v658 = v601 * v657;
    let v659 = v658 - v567 * v598;
    let v660 = v659 + v654;
    let v661 = v660 + v645;
    let v662 = v586 * crank_phi_dd + v661;
    let v663 = v588 * gauge_phi_dd + v662;
    let v664 = v567 * v623;
    let v665 = v563 * v663 + v664;
    let gauge_x_dd = v665 * v570;
    let v667 = v566 * v623;
    let v668 = v667 - v562 * v663;
    let gauge_y_dd = v668 * v570;
    at.qdd[18] = gauge_x_dd + 0.0;
    at.qdd[19] = gauge_y_dd + 0.0;
    let v670 = 0.1 * s460;
    let v671 = v1 + -3.0;
    let v672 = t + -1.0;
    let v673 = v672 * v672;
    let v674 = f64::from(sides[5] == 0.0);
    let v675 = f64::from(v674 != 0.0 && sides[6] != 0.0);
    let v676 = select(v675, v673, v671);
    let v677 = select(sides[7], 0.0, v676);
    let v678 = 0.1 * v677 + 1.0;
    let v679 = -20.0 * v358 + 70.0;
    let v680 = v358 * v679 + -84.0;
    let v681 = v358 * v680 + 35.0;
    let v682 = v358 * v681;
    let v683 = v358 * v682;
    let v684 = v358 * v683;
    let v685 = v358 * v684;
    let v686 = 0.1 * v685;
    let v687 = select(sides[4], v686, 0.1);
    let v688 = select(sides[1], 0.0, v687);
    let v689 = v688 + v678;
    let v690 = 3.141592653589793 * v358;
    let (s691, c691) = sin_cos(v690);
    let v692 = 1.0 - c691;
    let v693 = 0.05 * v692;
    let v694 = select(sides[4], v693, 0.1);
    let v695 = select(sides[1], 0.0, v694);
    let v696 = v695 + v689;
    let v697 = v670 - v696;
    let free_y = -v697;
    at.q[16] = free_y + 0.0;
    let v699 = 2.0 * v672;
    let v700 = select(v675, v699, 2.0);
    let v701 = select(sides[7], 0.0, v700);
    let v702 = 0.3333333333333333 * v679;
    let v703 = -6.666666666666666 * v358 + v702;
    let v704 = 0.3333333333333333 * v680;
    let v705 = v358 * v703 + v704;
    let v706 = 0.3333333333333333 * v681;
    let v707 = v358 * v705 + v706;
    let v708 = 0.3333333333333333 * v682;
    let v709 = v358 * v707 + v708;
    let v710 = 0.3333333333333333 * v683;
    let v711 = v358 * v709 + v710;
    let v712 = 0.3333333333333333 * v684;
    let v713 = v358 * v711 + v712;
    let v714 = 0.1 * v713;
    let v715 = select(sides[4], v714, 0.0);
    let v716 = select(sides[1], 0.0, v715);
    let v717 = 0.1 * v701 + v716;
    let v718 = 0.05235987755982988 * s691;
    let v719 = select(sides[4], v718, 0.0);
    let v720 = select(sides[1], 0.0, v719);
    let v721 = v720 + v717;
    let free_y_d = v721 - v461 * free_phi_d;
    at.qd[16] = free_y_d + 0.0;
    let v723 = select(v675, 2.0, 0.0);
    let v724 = select(sides[7], 0.0, v723);
    let v725 = 0.3333333333333333 * v703;
    let v726 = -4.444444444444444 * v358 + v725;
    let v727 = v725 + v726;
    let v728 = 0.3333333333333333 * v705;
    let v729 = v358 * v727 + v728;
    let v730 = v728 + v729;
    let v731 = 0.3333333333333333 * v707;
    let v732 = v358 * v730 + v731;
    let v733 = v731 + v732;
    let v734 = 0.3333333333333333 * v709;
    let v735 = v358 * v733 + v734;
    let v736 = v734 + v735;
    let v737 = 0.3333333333333333 * v711;
    let v738 = v358 * v736 + v737;
    let v739 = v737 + v738;
    let v740 = 0.1 * v739;
    let v741 = select(sides[4], v740, 0.0);
    let v742 = select(sides[1], 0.0, v741);
    let v743 = 0.1 * v724 + v742;
    let v744 = 0.054831135561607534 * c691;
    let v745 = select(sides[4], v744, 0.0);
    let v746 = select(sides[1], 0.0, v745);
    let v747 = v746 + v743;
    let v748 = v747 - -0.1 * v491;
    let free_y_dd = v748 - v461 * free_phi_dd;
    at.qdd[16] = free_y_dd + 0.0;
    let v750 = s460 * free_phi_dd + v478;
    at.measures.values[0] = v227 + 0.0;
    let v751 = 0.8 * sled_y_d;
    let v752 = v751 - 0.6 * v249;
    at.measures.rates[0] = v752 + 0.0;
    let v753 = 0.8 * sled_y_dd;
    let v754 = v753 - 0.6 * v272;
    at.measures.accelerations[0] = v754 + 0.0;
    at.measures.values[1] = v140 + 0.0;
    at.measures.rates[1] = v186 + 0.0;
    let v755 = v81 * v196 + v177;
    let v756 = v178 + v755;
    let v757 = m.params.a * v756;
    let v758 = -2.0 * v757;
    at.measures.accelerations[1] = v758 + 0.0;
    let v759 = c23 * v21 - v46;
    let v760 = v759 - v47;
    let v761 = m.params.a * v760;
    at.measures.values[2] = v761 + 0.0;
    let v762 = x1 / 6.283185307179586;
    at.measures.values[3] = v762 + 0.0;
    let v763 = rocker_phi_d / 6.283185307179586;
    at.measures.rates[2] = v763 + 0.0;
    let v764 = rocker_phi_dd / 6.283185307179586;
    at.measures.accelerations[2] = v764 + 0.0;
    let v765 = v670 - v697;
    let v766 = v461 - v467;
    let v767 = v766 * v766;
    let v768 = v765 * v765 + v767;
    let v769 = libm::sqrt(v768);
    at.measures.values[4] = v769 + 0.0;
    let v770 = 2.0 * v769;
    let v771 = 0.1 * v477 + free_y_d;
    let v772 = v765 * v771;
    let v773 = -0.1 * v490 + free_x_d;
    let v774 = v766 * v773;
    let v775 = 2.0 * v774;
    let v776 = 2.0 * v772 + v775;
    let v777 = v776 / v770;
    at.measures.rates[3] = v777 + 0.0;
    let v778 = v777 / v770;
    let v779 = v777 * v778;
    let v780 = 0.1 * v492 + free_y_dd;
    let v781 = v771 * v771;
    let v782 = v765 * v780 + v781;
    let v783 = -0.1 * v750 + free_x_dd;
    let v784 = v773 * v773;
    let v785 = v766 * v783 + v784;
    let v786 = 2.0 * v785;
    let v787 = 2.0 * v782 + v786;
    let v788 = v787 / v770;
    let v789 = -2.0 * v779 + v788;
    at.measures.accelerations[3] = v789 + 0.0;
    at.measures.values[5] = v765 + 0.0;
    at.measures.rates[4] = v771 + 0.0;
    at.measures.accelerations[4] = v780 + 0.0;
    let mut x5 = guess[4];
    let mut s790 = 0.0;
    let mut c790 = 0.0;
    let mut v799 = 0.0;
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x5 = on_grid(x5, 7.450580596923828e-9);
        (s790, c790) = sin_cos(x5);
        let v791 = 1.0 / c790;
        let v792 = 0.6 * c790;
        let v793 = v792 - 0.8 * s790;
        let v794 = 0.6 * s790;
        let v795 = 0.8 * c790 + v794;
        let v796 = 0.6 * v795;
        let v797 = v796 - 0.8 * v793;
        let v798 = v797 * v791;
        v799 = -v798;
        x5 = newton.corrected(x5, v799, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
    let v800 = 0.5 * v799;
    let v801 = c790 - v800 * s790;
    let v802 = v799 * v801 + s790;
    let v803 = v800 * c790 + s790;
    let v804 = c790 - v799 * v803;
    let v805 = 0.6 * v804;
    let v806 = v805 - 0.8 * v802;
    let v807 = 0.6 * v802;
    let v808 = 0.8 * v804 + v807;
    let v809 = 0.6 * v808;
    let v810 = v809 - 0.8 * v806;
    at.holds &= v810.abs() <= 1e-12;
    let v811 = 1.0 / v804;
    at.q[11] = x5 + 0.0;
    at.pivot(3, v811, 1.0);
}

/// As [`phi`], on branches of formulas that are given.
///
/// 237 operations.
fn phi_with(q: &[f64; N], t: f64, p: &Params, sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let n = p.n;
    let sled_phi = q[11];
    let sled_x = q[9];
    let sled_y = q[10];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let free_phi = q[17];
    let free_x = q[15];
    let free_y = q[16];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let stone_phi = q[14];

    let v1 = libm::atan2(0.0, a);
    let v2 = v1 + -1.5707963267948966;
    let v3 = a * half;
    let v4 = 4.0 * t;
    let (_, c5) = sin_cos(v4);
    let v6 = c5 / n;
    let v7 = 2.0 * t;
    let (s8, _) = sin_cos(v7);
    let v9 = v6 + s8;
    let v10 = 0.17453292519943295 * v9;
    let v11 = v10 + -1.2217304763960306;
    let v12 = t / 2.0;
    let v13 = 6.0 * v12;
    let v14 = v13 + -15.0;
    let v15 = v12 * v14;
    let v16 = 10.0 + v15;
    let v17 = v12 * v16;
    let v18 = v12 * v17;
    let v19 = v12 * v18;
    let v20 = select(sides[0], v19, 1.0);
    let v21 = select(sides[1], 0.0, v20);
    let v22 = 0.01 * v21;
    let v23 = -0.1 + t;
    let v24 = v23 / 0.30000000000000004;
    let v25 = -2.0 * v24;
    let v26 = 3.0 + v25;
    let v27 = v24 * v26;
    let v28 = v24 * v27;
    let v29 = select(sides[2], v28, 1.0);
    let v30 = select(sides[3], 0.0, v29);
    let v31 = 0.1 * v30;
    let v32 = 0.5 + v31;
    let v33 = v22 + v32;
    let v34 = t / 3.0;
    let v35 = 3.141592653589793 * v34;
    let (_, c36) = sin_cos(v35);
    let v37 = 1.0 - c36;
    let v38 = 0.05 * v37;
    let v39 = select(sides[4], v38, 0.1);
    let v40 = select(sides[1], 0.0, v39);
    let v41 = -20.0 * v34;
    let v42 = v41 + 70.0;
    let v43 = v34 * v42;
    let v44 = v43 + -84.0;
    let v45 = v34 * v44;
    let v46 = v45 + 35.0;
    let v47 = v34 * v46;
    let v48 = v34 * v47;
    let v49 = v34 * v48;
    let v50 = v34 * v49;
    let v51 = 0.1 * v50;
    let v52 = select(sides[4], v51, 0.1);
    let v53 = select(sides[1], 0.0, v52);
    let v54 = v7 + -3.0;
    let v55 = t + -1.0;
    let v56 = v55 * v55;
    let v57 = f64::from(sides[5] == 0.0);
    let v58 = f64::from(v57 != 0.0 && sides[6] != 0.0);
    let v59 = select(v58, v56, v54);
    let v60 = select(sides[7], 0.0, v59);
    let v61 = 0.1 * v60;
    let v62 = 1.0 + v61;
    let v63 = v53 + v62;
    let v64 = v40 + v63;
    let v65 = f64::from(sides[8] != 0.0 || sides[9] != 0.0);
    let v66 = f64::from(sides[10] == 0.0);
    let v67 = f64::from(v65 != 0.0 || v66 != 0.0);
    let v68 = select(v67, 1.0, 0.0);
    let v69 = 1.0 + t;
    let v70 = v69 * v69;
    let v71 = 1.0 / v70;
    let v72 = libm::pow(t, half);
    let v73 = libm::pow(2.0, v34);
    let v74 = t / 4.0;
    let v75 = libm::cosh(v74);
    let v76 = libm::sinh(v34);
    let v77 = v75 * v76;
    let v78 = n * t;
    let v79 = 2.0 + v78;
    let v80 = t * v79;
    let v81 = 1.0 + v80;
    let v82 = v81 / 10.0;
    let v83 = v69 / 6.0;
    let v84 = 12.566370614359172 * v83;
    let (s85, _) = sin_cos(v84);
    let v86 = 0.25 * s85;
    let v87 = 3.141592653589793 * v83;
    let v88 = v87 - v86;
    let v89 = 4.0 + v88;
    let v90 = 4.1887902047863905 * v83;
    let v91 = v90 + 1.0471975511965976;
    let (s92, _) = sin_cos(v91);
    let v93 = 2.25 * s92;
    let v94 = v87 - v93;
    let v95 = 2.0 + v94;
    let v96 = select(sides[11], v95, v89);
    let v97 = select(sides[12], v88, v96);
    let v98 = 0.14002478837788934 * v97;
    let v99 = select(sides[13], v98, 1.0);
    let v100 = select(sides[14], 0.0, v99);
    let v101 = 6.283185307179586 * v83;
    let (s102, _) = sin_cos(v101);
    let v103 = 0.15915494309189535 * s102;
    let v104 = v83 - v103;
    let v105 = select(sides[13], v104, 1.0);
    let v106 = select(sides[14], 0.0, v105);
    let v107 = 10.0 * sides[15];
    let v108 = t - v107;
    let v109 = libm::sqrt(v69);
    let v110 = 2.0 + t;
    let v111 = libm::log10(v110);
    let v112 = libm::log(v69);
    let v113 = v111 * v112;
    let v114 = -t;
    let v115 = libm::exp(v114);
    let v116 = v113 + v115;
    let v117 = v109 + v116;
    let v118 = v108 + v117;
    let v119 = v106 + v118;
    let v120 = v100 + v119;
    let v121 = v82 + v120;
    let v122 = v77 + v121;
    let v123 = v73 + v122;
    let v124 = v72 + v123;
    let v125 = v71 + v124;
    let v126 = v68 + v125;
    let (s127, c127) = sin_cos(sled_phi);
    let v128 = 0.6 * sled_x;
    let v129 = 0.8 * sled_y;
    let v130 = v128 + v129;
    let (s131, c131) = sin_cos(rocker_phi);
    let v132 = a * c131;
    let v133 = 2.0 * v132;
    let v134 = a * s131;
    let v135 = 2.0 * v134;
    let v136 = v133 + rocker_x;
    let v137 = v135 + rocker_y;
    let (s138, c138) = sin_cos(crank_phi);
    let v139 = a * c138;
    let v140 = a * s138;
    let v141 = v139 + crank_x;
    let v142 = v140 + crank_y;
    let (s143, c143) = sin_cos(free_phi);
    let v144 = 0.1 * c143;
    let v145 = 0.1 * s143;
    let v146 = v144 + free_x;
    let v147 = v145 + free_y;
    let v148 = v141 - sled_x;
    let v149 = rocker_x - crank_x;
    let v150 = rocker_y - crank_y;
    let v151 = v149 * v149;
    let v152 = v150 * v150;
    let v153 = v151 + v152;
    let v154 = libm::sqrt(v153);
    let (s155, c155) = sin_cos(gauge_phi);
    let v156 = c155 + gauge_x;
    let v157 = s155 + gauge_y;
    let v158 = crank_phi + v2;
    let v159 = free_phi - crank_phi;
    let v160 = -crank_x;
    let v161 = -crank_y;
    let v162 = plate_phi - crank_phi;
    let v163 = v162 + -0.5235987755982988;
    let (s164, c164) = sin_cos(plate_phi);
    let v165 = v141 - plate_x;
    let v166 = v142 - plate_y;
    let v167 = 4.0 - rocker_x;
    let v168 = -rocker_y;
    let v169 = c164 * v3;
    let v170 = 0.1 * s164;
    let v171 = s164 * v3;
    let v172 = 0.1 * c164;
    let v173 = v169 - v170;
    let v174 = v171 + v172;
    let v175 = plate_x + v173;
    let v176 = plate_y + v174;
    let v177 = v136 - v175;
    let v178 = v137 - v176;
    let v179 = v177 * v177;
    let v180 = v178 * v178;
    let v181 = v179 + v180;
    let v182 = v181 + -9.0;
    let v183 = 0.6 * c127;
    let v184 = 0.8 * s127;
    let v185 = 0.6 * s127;
    let v186 = 0.8 * c127;
    let v187 = v183 - v184;
    let v188 = v185 + v186;
    let v189 = 0.8 * sled_x;
    let v190 = 0.6 * sled_y;
    let v191 = v190 - v189;
    let v192 = 0.8 * v187;
    let v193 = 0.6 * v188;
    let v194 = v193 - v192;
    let v195 = stone_x - rocker_x;
    let v196 = stone_y - rocker_y;
    let v197 = s131 * v195;
    let v198 = c131 * v196;
    let v199 = v198 - v197;
    let v200 = v199 + -0.1;
    let v201 = rocker_phi / 2.0;
    let v202 = stone_phi - v201;
    let v203 = -v148;
    let v204 = select(sides[16], v203, v148);
    let v205 = v204 / 10.0;
    let v206 = stone_y + v205;
    let v207 = v206 + -0.6;
    let v208 = either(sides[17], a, v154);
    let v209 = either(sides[18], v141, v142);
    let v210 = either(sides[19], v209, 0.2);
    let v211 = v208 + v210;
    let v212 = v146 - v211;
    let v213 = libm::hypot(v156, v157);
    let v214 = libm::tanh(crank_phi);
    let v215 = v214 / 10.0;
    let v216 = v215 + 1.2;
    let v217 = v213 - v216;
    let v218 = libm::atan2(v157, v156);
    let v219 = c138 / 3.0;
    let v220 = libm::acos(v219);
    let v221 = v220 / 4.0;
    let v222 = s138 / 2.0;
    let v223 = libm::asin(v222);
    let v224 = v221 + v223;
    let v225 = v218 - v224;
    let v226 = crank_phi / 9.0;
    let v227 = libm::tan(v226);
    let v228 = libm::atan(crank_phi);
    let v229 = v228 * sides[20];
    let v230 = v229 / 5.0;
    let v231 = 1.0 + v230;
    let v232 = v227 + v231;
    let v233 = gauge_phi - v232;
    let v234 = v158 - v11;
    let v235 = v130 - v33;
    let v236 = v147 - v64;
    let v237 = v159 - v126;

    out[0] = v160;
    out[1] = v161;
    out[2] = v165;
    out[3] = v166;
    out[4] = v163;
    out[5] = v167;
    out[6] = v168;
    out[7] = v182;
    out[8] = v191;
    out[9] = v194;
    out[10] = v200;
    out[11] = v202;
    out[12] = v207;
    out[13] = v212;
    out[14] = v217;
    out[15] = v225;
    out[16] = v233;
    out[17] = v234;
    out[18] = v235;
    out[19] = v236;
    out[20] = v237;
    out
}

/// As [`phi_q`], on branches of formulas that are given.
///
/// 142 operations.
fn phi_q_with(q: &[f64; N], _t: f64, p: &Params, sides: &Sides) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let a = p.a;
    let half = p.half;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let free_phi = q[17];
    let crank_x = q[0];
    let crank_y = q[1];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_y = q[13];
    let stone_x = q[12];

    let v1 = a * half;
    let (_, c2) = sin_cos(sled_phi);
    let (s3, c3) = sin_cos(rocker_phi);
    let v4 = a * c3;
    let v5 = 2.0 * v4;
    let v6 = a * s3;
    let v7 = 2.0 * v6;
    let v8 = v5 + rocker_x;
    let v9 = v7 + rocker_y;
    let (s10, c10) = sin_cos(crank_phi);
    let v11 = a * c10;
    let v12 = a * s10;
    let (s13, c13) = sin_cos(free_phi);
    let v14 = 0.1 * c13;
    let v15 = rocker_x - crank_x;
    let v16 = rocker_y - crank_y;
    let v17 = v15 * v15;
    let v18 = v16 * v16;
    let v19 = v17 + v18;
    let v20 = libm::sqrt(v19);
    let (s21, c21) = sin_cos(gauge_phi);
    let v22 = c21 + gauge_x;
    let v23 = s21 + gauge_y;
    let (s24, c24) = sin_cos(plate_phi);
    let v25 = c24 * v1;
    let v26 = 0.1 * s24;
    let v27 = s24 * v1;
    let v28 = 0.1 * c24;
    let v29 = v25 - v26;
    let v30 = v27 + v28;
    let v31 = plate_x + v29;
    let v32 = plate_y + v30;
    let v33 = v8 - v31;
    let v34 = v9 - v32;
    let v35 = stone_y - rocker_y;
    let v36 = libm::hypot(v22, v23);
    let v37 = libm::tanh(crank_phi);
    let v38 = c10 / 3.0;
    let v39 = s10 / 2.0;
    let v40 = crank_phi / 9.0;
    let v41 = libm::tan(v40);
    let v42 = -v12;
    let v43 = 2.0 * v34;
    let v44 = 2.0 * v33;
    let v45 = -2.0 * v34;
    let v46 = -2.0 * v33;
    let v47 = -0.2 * v34;
    let v48 = v1 * v34;
    let v49 = -2.0 * v48;
    let v50 = 0.2 * v33;
    let v51 = v49 + v50;
    let v52 = v1 * v33;
    let v53 = -2.0 * v52;
    let v54 = v47 + v53;
    let v55 = c24 * v51;
    let v56 = s24 * v54;
    let v57 = v55 - v56;
    let v58 = a * v34;
    let v59 = a * v33;
    let v60 = c3 * v58;
    let v61 = 4.0 * v60;
    let v62 = s3 * v59;
    let v63 = -4.0 * v62;
    let v64 = v61 + v63;
    let v65 = rocker_x - stone_x;
    let v66 = -s3;
    let v67 = -c3;
    let v68 = c3 * v65;
    let v69 = s3 * v35;
    let v70 = v68 - v69;
    let v71 = select(sides[16], -0.1, 0.1);
    let v72 = -v71;
    let v73 = a * v71;
    let v74 = s10 * v73;
    let v75 = -v74;
    let v76 = 2.0 * v15;
    let v77 = -2.0 * v15;
    let v78 = 2.0 * v20;
    let v79 = v77 / v78;
    let v80 = select(sides[17], 0.0, v79);
    let v81 = select(sides[18], 1.0, 0.0);
    let v82 = select(sides[19], v81, 0.0);
    let v83 = v80 + v82;
    let v84 = -v83;
    let v85 = 2.0 * v16;
    let v86 = -2.0 * v16;
    let v87 = v86 / v78;
    let v88 = select(sides[17], 0.0, v87);
    let v89 = select(sides[18], 0.0, 1.0);
    let v90 = select(sides[19], v89, 0.0);
    let v91 = v88 + v90;
    let v92 = -v91;
    let v93 = select(sides[18], v42, 0.0);
    let v94 = select(sides[18], 0.0, v11);
    let v95 = v93 + v94;
    let v96 = select(sides[19], v95, 0.0);
    let v97 = -v96;
    let v98 = v76 / v78;
    let v99 = select(sides[17], 0.0, v98);
    let v100 = -v99;
    let v101 = v85 / v78;
    let v102 = select(sides[17], 0.0, v101);
    let v103 = -v102;
    let v104 = -0.1 * s13;
    let v105 = v37 * v37;
    let v106 = 1.0 - v105;
    let v107 = -0.1 * v106;
    let v108 = v22 / v36;
    let v109 = v23 / v36;
    let v110 = c21 * v109;
    let v111 = s21 * v108;
    let v112 = v110 - v111;
    let v113 = v39 * v39;
    let v114 = 1.0 - v113;
    let v115 = libm::sqrt(v114);
    let v116 = -1.0 / v115;
    let v117 = v116 / 2.0;
    let v118 = v38 * v38;
    let v119 = 1.0 - v118;
    let v120 = libm::sqrt(v119);
    let v121 = -0.25 / v120;
    let v122 = v121 / 3.0;
    let v123 = v23 * v23;
    let v124 = v22 * v22;
    let v125 = v123 + v124;
    let v126 = v22 / v125;
    let v127 = v23 / v125;
    let v128 = -v127;
    let v129 = c21 * v126;
    let v130 = s21 * v127;
    let v131 = v129 + v130;
    let v132 = c10 * v117;
    let v133 = s10 * v122;
    let v134 = v132 + v133;
    let v135 = -0.2 * sides[20];
    let v136 = crank_phi * crank_phi;
    let v137 = 1.0 + v136;
    let v138 = v135 / v137;
    let v139 = v41 * v41;
    let v140 = 1.0 + v139;
    let v141 = v140 / 9.0;
    let v142 = v138 - v141;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v42;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = v11;
    out[7] = -1.0;
    out[8] = -1.0;
    out[9] = 1.0;
    out[10] = -1.0;
    out[11] = -1.0;
    out[12] = v46;
    out[13] = v45;
    out[14] = v57;
    out[15] = v44;
    out[16] = v43;
    out[17] = v64;
    out[18] = -0.8;
    out[19] = 0.6;
    out[20] = c2;
    out[21] = s3;
    out[22] = v67;
    out[23] = v70;
    out[24] = v66;
    out[25] = c3;
    out[26] = -0.5;
    out[27] = 1.0;
    out[28] = v71;
    out[29] = v75;
    out[30] = v72;
    out[31] = 1.0;
    out[32] = v84;
    out[33] = v92;
    out[34] = v97;
    out[35] = v100;
    out[36] = v103;
    out[37] = 1.0;
    out[38] = v104;
    out[39] = v107;
    out[40] = v108;
    out[41] = v109;
    out[42] = v112;
    out[43] = v134;
    out[44] = v128;
    out[45] = v126;
    out[46] = v131;
    out[47] = v142;
    out[48] = 1.0;
    out[49] = 1.0;
    out[50] = 0.6;
    out[51] = 0.8;
    out[52] = 1.0;
    out[53] = v14;
    out[54] = -1.0;
    out[55] = 1.0;
    out
}

/// As [`nu`], on branches of formulas that are given.
///
/// 160 operations.
fn nu_with(_q: &[f64; N], t: f64, p: &Params, sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    let half = p.half;
    let n = p.n;

    let v1 = half + -1.0;
    let v2 = 4.0 * t;
    let (s3, _) = sin_cos(v2);
    let v4 = 2.0 * t;
    let (_, c5) = sin_cos(v4);
    let v6 = t / 2.0;
    let v7 = 6.0 * v6;
    let v8 = v7 + -15.0;
    let v9 = v6 * v8;
    let v10 = 10.0 + v9;
    let v11 = v6 * v10;
    let v12 = v6 * v11;
    let v13 = -0.1 + t;
    let v14 = v13 / 0.30000000000000004;
    let v15 = -2.0 * v14;
    let v16 = 3.0 + v15;
    let v17 = v14 * v16;
    let v18 = t / 3.0;
    let v19 = 3.141592653589793 * v18;
    let (s20, _) = sin_cos(v19);
    let v21 = -20.0 * v18;
    let v22 = v21 + 70.0;
    let v23 = v18 * v22;
    let v24 = v23 + -84.0;
    let v25 = v18 * v24;
    let v26 = v25 + 35.0;
    let v27 = v18 * v26;
    let v28 = v18 * v27;
    let v29 = v18 * v28;
    let v30 = t + -1.0;
    let v31 = f64::from(sides[5] == 0.0);
    let v32 = f64::from(v31 != 0.0 && sides[6] != 0.0);
    let v33 = 1.0 + t;
    let v34 = libm::pow(2.0, v18);
    let v35 = t / 4.0;
    let v36 = libm::cosh(v35);
    let v37 = libm::sinh(v18);
    let v38 = n * t;
    let v39 = 2.0 + v38;
    let v40 = v33 / 6.0;
    let v41 = 12.566370614359172 * v40;
    let (_, c42) = sin_cos(v41);
    let v43 = 4.1887902047863905 * v40;
    let v44 = v43 + 1.0471975511965976;
    let (_, c45) = sin_cos(v44);
    let v46 = 6.283185307179586 * v40;
    let (_, c47) = sin_cos(v46);
    let v48 = libm::sqrt(v33);
    let v49 = 2.0 + t;
    let v50 = libm::log10(v49);
    let v51 = libm::log(v33);
    let v52 = -t;
    let v53 = libm::exp(v52);
    let v54 = -4.0 * s3;
    let v55 = v54 / n;
    let v56 = 2.0 * c5;
    let v57 = v55 + v56;
    let v58 = 0.17453292519943295 * v57;
    let v59 = 0.5 * v8;
    let v60 = 3.0 * v6;
    let v61 = v59 + v60;
    let v62 = 0.5 * v10;
    let v63 = v6 * v61;
    let v64 = v62 + v63;
    let v65 = 0.5 * v11;
    let v66 = v6 * v64;
    let v67 = v65 + v66;
    let v68 = 0.5 * v12;
    let v69 = v6 * v67;
    let v70 = v68 + v69;
    let v71 = select(sides[0], v70, 0.0);
    let v72 = select(sides[1], 0.0, v71);
    let v73 = 0.01 * v72;
    let v74 = 3.333333333333333 * v16;
    let v75 = -6.666666666666666 * v14;
    let v76 = v74 + v75;
    let v77 = 3.333333333333333 * v17;
    let v78 = v14 * v76;
    let v79 = v77 + v78;
    let v80 = select(sides[2], v79, 0.0);
    let v81 = select(sides[3], 0.0, v80);
    let v82 = 0.1 * v81;
    let v83 = v73 + v82;
    let v84 = 0.05235987755982988 * s20;
    let v85 = select(sides[4], v84, 0.0);
    let v86 = select(sides[1], 0.0, v85);
    let v87 = 0.3333333333333333 * v22;
    let v88 = -6.666666666666666 * v18;
    let v89 = v87 + v88;
    let v90 = 0.3333333333333333 * v24;
    let v91 = v18 * v89;
    let v92 = v90 + v91;
    let v93 = 0.3333333333333333 * v26;
    let v94 = v18 * v92;
    let v95 = v93 + v94;
    let v96 = 0.3333333333333333 * v27;
    let v97 = v18 * v95;
    let v98 = v96 + v97;
    let v99 = 0.3333333333333333 * v28;
    let v100 = v18 * v98;
    let v101 = v99 + v100;
    let v102 = 0.3333333333333333 * v29;
    let v103 = v18 * v101;
    let v104 = v102 + v103;
    let v105 = 0.1 * v104;
    let v106 = select(sides[4], v105, 0.0);
    let v107 = select(sides[1], 0.0, v106);
    let v108 = 2.0 * v30;
    let v109 = select(v32, v108, 2.0);
    let v110 = select(sides[7], 0.0, v109);
    let v111 = 0.1 * v110;
    let v112 = v107 + v111;
    let v113 = v86 + v112;
    let v114 = v33 * v33;
    let v115 = v114 * v33;
    let v116 = 1.0 / v115;
    let v117 = -2.0 * v116;
    let v118 = libm::pow(t, v1);
    let v119 = half * v118;
    let v120 = 0.23104906018664842 * v34;
    let v121 = libm::sinh(v35);
    let v122 = libm::cosh(v18);
    let v123 = v37 * v121;
    let v124 = 0.25 * v123;
    let v125 = v36 * v122;
    let v126 = 0.3333333333333333 * v125;
    let v127 = v124 + v126;
    let v128 = v38 + v39;
    let v129 = v128 / 10.0;
    let v130 = -0.5235987755982988 * c42;
    let v131 = 0.5235987755982988 + v130;
    let v132 = -1.5707963267948963 * c45;
    let v133 = 0.5235987755982988 + v132;
    let v134 = select(sides[11], v133, v131);
    let v135 = select(sides[12], v131, v134);
    let v136 = 0.14002478837788934 * v135;
    let v137 = select(sides[13], v136, 0.0);
    let v138 = select(sides[14], 0.0, v137);
    let v139 = -0.16666666666666666 * c47;
    let v140 = 0.16666666666666666 + v139;
    let v141 = select(sides[13], v140, 0.0);
    let v142 = select(sides[14], 0.0, v141);
    let v143 = 2.0 * v48;
    let v144 = 1.0 / v143;
    let v145 = 2.302585092994046 * v49;
    let v146 = 1.0 / v145;
    let v147 = 1.0 / v33;
    let v148 = v51 * v146;
    let v149 = v50 * v147;
    let v150 = v148 + v149;
    let v151 = v150 - v53;
    let v152 = v144 + v151;
    let v153 = 1.0 + v152;
    let v154 = v142 + v153;
    let v155 = v138 + v154;
    let v156 = v129 + v155;
    let v157 = v127 + v156;
    let v158 = v120 + v157;
    let v159 = v119 + v158;
    let v160 = v117 + v159;

    out[17] = v58;
    out[18] = v83;
    out[19] = v113;
    out[20] = v160;
    out
}

/// As [`gamma`], on branches of formulas that are given.
///
/// 454 operations.
fn gamma_with(q: &[f64; N], qd: &[f64; N], t: f64, p: &Params, sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let n = p.n;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let free_phi = q[17];
    let crank_x = q[0];
    let crank_y = q[1];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let rocker_phi_d = qd[8];
    let rocker_x_d = qd[6];
    let crank_phi_d = qd[2];
    let free_phi_d = qd[17];
    let sled_phi_d = qd[11];
    let rocker_y_d = qd[7];
    let crank_x_d = qd[0];
    let crank_y_d = qd[1];
    let gauge_phi_d = qd[20];
    let gauge_x_d = qd[18];
    let gauge_y_d = qd[19];
    let plate_phi_d = qd[5];
    let plate_x_d = qd[3];
    let plate_y_d = qd[4];
    let stone_x_d = qd[12];
    let stone_y_d = qd[13];

    let v1 = a * half;
    let v2 = half + -1.0;
    let v3 = -1.0 + v2;
    let v4 = 2.0 * n;
    let v5 = v4 / 10.0;
    let v6 = 4.0 * t;
    let (_, c7) = sin_cos(v6);
    let v8 = 2.0 * t;
    let (s9, _) = sin_cos(v8);
    let v10 = t / 2.0;
    let v11 = 6.0 * v10;
    let v12 = v11 + -15.0;
    let v13 = v10 * v12;
    let v14 = 10.0 + v13;
    let v15 = v10 * v14;
    let v16 = -0.1 + t;
    let v17 = v16 / 0.30000000000000004;
    let v18 = -2.0 * v17;
    let v19 = 3.0 + v18;
    let v20 = t / 3.0;
    let v21 = 3.141592653589793 * v20;
    let (_, c22) = sin_cos(v21);
    let v23 = -20.0 * v20;
    let v24 = v23 + 70.0;
    let v25 = v20 * v24;
    let v26 = v25 + -84.0;
    let v27 = v20 * v26;
    let v28 = v27 + 35.0;
    let v29 = v20 * v28;
    let v30 = v20 * v29;
    let v31 = f64::from(sides[5] == 0.0);
    let v32 = f64::from(v31 != 0.0 && sides[6] != 0.0);
    let v33 = 1.0 + t;
    let v34 = libm::pow(2.0, v20);
    let v35 = t / 4.0;
    let v36 = libm::cosh(v35);
    let v37 = libm::sinh(v20);
    let v38 = v36 * v37;
    let v39 = v33 / 6.0;
    let v40 = 12.566370614359172 * v39;
    let (s41, _) = sin_cos(v40);
    let v42 = 4.1887902047863905 * v39;
    let v43 = v42 + 1.0471975511965976;
    let (s44, _) = sin_cos(v43);
    let v45 = 6.283185307179586 * v39;
    let (s46, _) = sin_cos(v45);
    let v47 = libm::sqrt(v33);
    let v48 = 2.0 + t;
    let v49 = libm::log10(v48);
    let v50 = libm::log(v33);
    let v51 = -t;
    let v52 = libm::exp(v51);
    let (s53, c53) = sin_cos(sled_phi);
    let (s54, c54) = sin_cos(rocker_phi);
    let v55 = a * c54;
    let v56 = 2.0 * v55;
    let v57 = a * s54;
    let v58 = 2.0 * v57;
    let v59 = v56 + rocker_x;
    let v60 = v58 + rocker_y;
    let (s61, c61) = sin_cos(crank_phi);
    let (s62, c62) = sin_cos(free_phi);
    let v63 = rocker_x - crank_x;
    let v64 = rocker_y - crank_y;
    let v65 = v63 * v63;
    let v66 = v64 * v64;
    let v67 = v65 + v66;
    let v68 = libm::sqrt(v67);
    let (s69, c69) = sin_cos(gauge_phi);
    let v70 = c69 + gauge_x;
    let v71 = s69 + gauge_y;
    let (s72, c72) = sin_cos(plate_phi);
    let v73 = c72 * v1;
    let v74 = 0.1 * s72;
    let v75 = s72 * v1;
    let v76 = 0.1 * c72;
    let v77 = v73 - v74;
    let v78 = v75 + v76;
    let v79 = plate_x + v77;
    let v80 = plate_y + v78;
    let v81 = v59 - v79;
    let v82 = v60 - v80;
    let v83 = stone_x - rocker_x;
    let v84 = stone_y - rocker_y;
    let v85 = libm::hypot(v70, v71);
    let v86 = libm::tanh(crank_phi);
    let v87 = c61 / 3.0;
    let v88 = s61 / 2.0;
    let v89 = crank_phi / 9.0;
    let v90 = libm::tan(v89);
    let v91 = 2.0 * v68;
    let v92 = v86 * v86;
    let v93 = 1.0 - v92;
    let v94 = v70 / v85;
    let v95 = v71 / v85;
    let v96 = v88 * v88;
    let v97 = 1.0 - v96;
    let v98 = libm::sqrt(v97);
    let v99 = v87 * v87;
    let v100 = 1.0 - v99;
    let v101 = libm::sqrt(v100);
    let v102 = v71 * v71;
    let v103 = v70 * v70;
    let v104 = v102 + v103;
    let v105 = v70 / v104;
    let v106 = v71 / v104;
    let v107 = crank_phi * crank_phi;
    let v108 = 1.0 + v107;
    let v109 = v90 * v90;
    let v110 = 1.0 + v109;
    let v111 = 0.5 * v12;
    let v112 = 3.0 * v10;
    let v113 = v111 + v112;
    let v114 = 0.5 * v14;
    let v115 = v10 * v113;
    let v116 = v114 + v115;
    let v117 = 0.5 * v15;
    let v118 = v10 * v116;
    let v119 = v117 + v118;
    let v120 = 3.333333333333333 * v19;
    let v121 = -6.666666666666666 * v17;
    let v122 = v120 + v121;
    let v123 = 0.3333333333333333 * v24;
    let v124 = -6.666666666666666 * v20;
    let v125 = v123 + v124;
    let v126 = 0.3333333333333333 * v26;
    let v127 = v20 * v125;
    let v128 = v126 + v127;
    let v129 = 0.3333333333333333 * v28;
    let v130 = v20 * v128;
    let v131 = v129 + v130;
    let v132 = 0.3333333333333333 * v29;
    let v133 = v20 * v131;
    let v134 = v132 + v133;
    let v135 = 0.3333333333333333 * v30;
    let v136 = v20 * v134;
    let v137 = v135 + v136;
    let v138 = libm::sinh(v35);
    let v139 = libm::cosh(v20);
    let v140 = 2.0 * v47;
    let v141 = 1.0 / v140;
    let v142 = 2.302585092994046 * v48;
    let v143 = 1.0 / v142;
    let v144 = 1.0 / v33;
    let v145 = s54 * rocker_phi_d;
    let v146 = a * v145;
    let v147 = -2.0 * v146;
    let v148 = v147 + rocker_x_d;
    let v149 = c61 * crank_phi_d;
    let v150 = s61 * crank_phi_d;
    let v151 = crank_phi_d * v150;
    let v152 = crank_phi_d * v149;
    let v153 = c54 * rocker_phi_d;
    let v154 = rocker_phi_d * v153;
    let v155 = rocker_phi_d * v145;
    let v156 = s62 * free_phi_d;
    let v157 = c62 * free_phi_d;
    let v158 = free_phi_d * v157;
    let v159 = free_phi_d * v156;
    let v160 = s53 * sled_phi_d;
    let v161 = c53 * sled_phi_d;
    let v162 = a * v153;
    let v163 = 2.0 * v162;
    let v164 = v163 + rocker_y_d;
    let v165 = rocker_x_d - crank_x_d;
    let v166 = rocker_y_d - crank_y_d;
    let v167 = v63 * v165;
    let v168 = 2.0 * v167;
    let v169 = v64 * v166;
    let v170 = 2.0 * v169;
    let v171 = v168 + v170;
    let v172 = v171 / v91;
    let v173 = s69 * gauge_phi_d;
    let v174 = c69 * gauge_phi_d;
    let v175 = gauge_x_d - v173;
    let v176 = v174 + gauge_y_d;
    let v177 = s72 * plate_phi_d;
    let v178 = c72 * plate_phi_d;
    let v179 = v1 * v177;
    let v180 = v1 * v178;
    let v181 = -0.1 * v177;
    let v182 = -0.1 * v178;
    let v183 = v182 - v179;
    let v184 = v180 + v181;
    let v185 = plate_x_d + v183;
    let v186 = plate_y_d + v184;
    let v187 = v148 - v185;
    let v188 = v164 - v186;
    let v189 = stone_x_d - rocker_x_d;
    let v190 = stone_y_d - rocker_y_d;
    let v191 = v94 * v175;
    let v192 = v95 * v176;
    let v193 = v191 + v192;
    let v194 = crank_phi_d * v93;
    let v195 = v150 / 3.0;
    let v196 = v195 / v101;
    let v197 = v149 / 2.0;
    let v198 = v197 / v98;
    let v199 = crank_phi_d / 9.0;
    let v200 = v110 * v199;
    let v201 = crank_phi_d / v108;
    let v202 = a * v154;
    let v203 = -2.0 * v202;
    let v204 = a * v151;
    let v205 = -v204;
    let v206 = -0.1 * v158;
    let v207 = -0.1 * v159;
    let v208 = v86 * v194;
    let v209 = v175 / v85;
    let v210 = v94 / v85;
    let v211 = v193 * v210;
    let v212 = v209 - v211;
    let v213 = v176 / v85;
    let v214 = v95 / v85;
    let v215 = v193 * v214;
    let v216 = v213 - v215;
    let v217 = v88 * v197;
    let v218 = -2.0 * v217;
    let v219 = 2.0 * v98;
    let v220 = v218 / v219;
    let v221 = v87 * v195;
    let v222 = 2.0 * v221;
    let v223 = 2.0 * v101;
    let v224 = v222 / v223;
    let v225 = v71 * v176;
    let v226 = 2.0 * v225;
    let v227 = v70 * v175;
    let v228 = 2.0 * v227;
    let v229 = v226 + v228;
    let v230 = v175 / v104;
    let v231 = v105 / v104;
    let v232 = v229 * v231;
    let v233 = v230 - v232;
    let v234 = v176 / v104;
    let v235 = v106 / v104;
    let v236 = v229 * v235;
    let v237 = v234 - v236;
    let v238 = crank_phi * crank_phi_d;
    let v239 = v90 * v200;
    let v240 = -16.0 * c7;
    let v241 = v240 / n;
    let v242 = -4.0 * s9;
    let v243 = v241 + v242;
    let v244 = 0.5 * v113;
    let v245 = v112 + v244;
    let v246 = v244 + v245;
    let v247 = 0.5 * v116;
    let v248 = v10 * v246;
    let v249 = v247 + v248;
    let v250 = v247 + v249;
    let v251 = 0.5 * v119;
    let v252 = v10 * v250;
    let v253 = v251 + v252;
    let v254 = v251 + v253;
    let v255 = select(sides[0], v254, 0.0);
    let v256 = select(sides[1], 0.0, v255);
    let v257 = 0.01 * v256;
    let v258 = 3.333333333333333 * v122;
    let v259 = -44.444444444444436 * v17;
    let v260 = v258 + v259;
    let v261 = v258 + v260;
    let v262 = select(sides[2], v261, 0.0);
    let v263 = select(sides[3], 0.0, v262);
    let v264 = 0.1 * v263;
    let v265 = v257 + v264;
    let v266 = 0.054831135561607534 * c22;
    let v267 = select(sides[4], v266, 0.0);
    let v268 = select(sides[1], 0.0, v267);
    let v269 = 0.3333333333333333 * v125;
    let v270 = -4.444444444444444 * v20;
    let v271 = v269 + v270;
    let v272 = v269 + v271;
    let v273 = 0.3333333333333333 * v128;
    let v274 = v20 * v272;
    let v275 = v273 + v274;
    let v276 = v273 + v275;
    let v277 = 0.3333333333333333 * v131;
    let v278 = v20 * v276;
    let v279 = v277 + v278;
    let v280 = v277 + v279;
    let v281 = 0.3333333333333333 * v134;
    let v282 = v20 * v280;
    let v283 = v281 + v282;
    let v284 = v281 + v283;
    let v285 = 0.3333333333333333 * v137;
    let v286 = v20 * v284;
    let v287 = v285 + v286;
    let v288 = v285 + v287;
    let v289 = 0.1 * v288;
    let v290 = select(sides[4], v289, 0.0);
    let v291 = select(sides[1], 0.0, v290);
    let v292 = select(v32, 2.0, 0.0);
    let v293 = select(sides[7], 0.0, v292);
    let v294 = 0.1 * v293;
    let v295 = v291 + v294;
    let v296 = v268 + v295;
    let v297 = v33 * v33;
    let v298 = v297 * v297;
    let v299 = 1.0 / v298;
    let v300 = 6.0 * v299;
    let v301 = libm::pow(t, v3);
    let v302 = v2 * v301;
    let v303 = half * v302;
    let v304 = 0.053383668213133485 * v34;
    let v305 = v138 * v139;
    let v306 = 0.3333333333333333 * v305;
    let v307 = 0.25 * v38;
    let v308 = v306 + v307;
    let v309 = 0.25 * v308;
    let v310 = 0.25 * v305;
    let v311 = 0.3333333333333333 * v38;
    let v312 = v310 + v311;
    let v313 = 0.3333333333333333 * v312;
    let v314 = v309 + v313;
    let v315 = 1.0966227112321507 * s41;
    let v316 = 1.0966227112321505 * s44;
    let v317 = select(sides[11], v316, v315);
    let v318 = select(sides[12], v315, v317);
    let v319 = 0.14002478837788934 * v318;
    let v320 = select(sides[13], v319, 0.0);
    let v321 = select(sides[14], 0.0, v320);
    let v322 = 0.17453292519943292 * s46;
    let v323 = select(sides[13], v322, 0.0);
    let v324 = select(sides[14], 0.0, v323);
    let v325 = v141 / v140;
    let v326 = v141 * v325;
    let v327 = -2.0 * v326;
    let v328 = v143 / v142;
    let v329 = v144 / v33;
    let v330 = v143 * v144;
    let v331 = v50 * v328;
    let v332 = -2.302585092994046 * v331;
    let v333 = v330 + v332;
    let v334 = v49 * v329;
    let v335 = v330 - v334;
    let v336 = v333 + v335;
    let v337 = v52 + v336;
    let v338 = v327 + v337;
    let v339 = v324 + v338;
    let v340 = v321 + v339;
    let v341 = v5 + v340;
    let v342 = v314 + v341;
    let v343 = v304 + v342;
    let v344 = v303 + v343;
    let v345 = v300 + v344;
    let v346 = sled_phi_d * v161;
    let v347 = sled_phi_d * v160;
    let v348 = a * v155;
    let v349 = -2.0 * v348;
    let v350 = a * v152;
    let v351 = -v350;
    let v352 = v165 * v165;
    let v353 = 2.0 * v352;
    let v354 = v166 * v166;
    let v355 = 2.0 * v354;
    let v356 = v353 + v355;
    let v357 = v356 / v91;
    let v358 = v172 / v91;
    let v359 = v172 * v358;
    let v360 = -2.0 * v359;
    let v361 = v357 + v360;
    let v362 = gauge_phi_d * v174;
    let v363 = gauge_phi_d * v173;
    let v364 = plate_phi_d * v178;
    let v365 = plate_phi_d * v177;
    let v366 = v1 * v364;
    let v367 = v1 * v365;
    let v368 = -0.1 * v364;
    let v369 = 0.1 * v365;
    let v370 = v366 - v369;
    let v371 = v203 + v370;
    let v372 = v367 - v368;
    let v373 = v349 + v372;
    let v374 = v187 * v187;
    let v375 = v81 * v371;
    let v376 = v374 + v375;
    let v377 = 2.0 * v376;
    let v378 = v188 * v188;
    let v379 = v82 * v373;
    let v380 = v378 + v379;
    let v381 = 2.0 * v380;
    let v382 = v377 + v381;
    let v383 = -0.6 * v346;
    let v384 = -0.6 * v347;
    let v385 = -0.8 * v346;
    let v386 = 0.8 * v347;
    let v387 = v383 + v386;
    let v388 = v384 + v385;
    let v389 = 0.6 * v388;
    let v390 = -0.8 * v387;
    let v391 = v389 + v390;
    let v392 = v153 * v189;
    let v393 = v83 * v155;
    let v394 = v392 - v393;
    let v395 = v392 + v394;
    let v396 = v84 * v154;
    let v397 = v145 * v190;
    let v398 = v396 + v397;
    let v399 = v397 + v398;
    let v400 = v395 + v399;
    let v401 = select(sides[16], v350, v351);
    let v402 = v401 / 10.0;
    let v403 = select(sides[17], 0.0, v361);
    let v404 = select(sides[18], v351, 0.0);
    let v405 = select(sides[18], 0.0, v205);
    let v406 = v404 + v405;
    let v407 = select(sides[19], v406, 0.0);
    let v408 = v403 + v407;
    let v409 = v175 * v212;
    let v410 = v94 * v362;
    let v411 = v409 - v410;
    let v412 = v176 * v216;
    let v413 = v95 * v363;
    let v414 = v412 - v413;
    let v415 = v411 + v414;
    let v416 = crank_phi_d * v208;
    let v417 = -2.0 * v416;
    let v418 = v417 / 10.0;
    let v419 = v176 * v233;
    let v420 = v105 * v363;
    let v421 = v419 - v420;
    let v422 = v175 * v237;
    let v423 = v106 * v362;
    let v424 = v423 - v422;
    let v425 = v421 + v424;
    let v426 = v152 / 3.0;
    let v427 = v426 / v101;
    let v428 = v196 / v101;
    let v429 = v224 * v428;
    let v430 = v427 - v429;
    let v431 = v430 / 4.0;
    let v432 = v151 / 2.0;
    let v433 = v432 / v98;
    let v434 = v198 / v98;
    let v435 = v220 * v434;
    let v436 = v433 + v435;
    let v437 = v436 - v431;
    let v438 = v425 + v437;
    let v439 = v199 * v239;
    let v440 = 2.0 * v439;
    let v441 = v201 / v108;
    let v442 = v238 * v441;
    let v443 = sides[20] * v442;
    let v444 = -2.0 * v443;
    let v445 = v444 / 5.0;
    let v446 = v440 + v445;
    let v447 = -v382;
    let v448 = -v391;
    let v449 = -v402;
    let v450 = v408 - v206;
    let v451 = v418 - v415;
    let v452 = -v438;
    let v453 = 0.17453292519943295 * v243;
    let v454 = v296 - v207;

    out[2] = v350;
    out[3] = v204;
    out[7] = v447;
    out[9] = v448;
    out[10] = v400;
    out[12] = v449;
    out[13] = v450;
    out[14] = v451;
    out[15] = v452;
    out[16] = v446;
    out[17] = v453;
    out[18] = v265;
    out[19] = v454;
    out[20] = v345;
    out
}

/// As [`jerk`], on branches of formulas that are given.
///
/// 773 operations.
fn jerk_with(
    q: &[f64; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    t: f64,
    p: &Params,
    sides: &Sides,
) -> [f64; N] {
    let mut out = [0.0; N];
    let a = p.a;
    let half = p.half;
    let sled_phi = q[11];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let crank_phi = q[2];
    let free_phi = q[17];
    let crank_x = q[0];
    let crank_y = q[1];
    let gauge_phi = q[20];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let plate_phi = q[5];
    let plate_x = q[3];
    let plate_y = q[4];
    let stone_x = q[12];
    let stone_y = q[13];
    let rocker_phi_d = qd[8];
    let rocker_x_d = qd[6];
    let crank_phi_d = qd[2];
    let free_phi_d = qd[17];
    let sled_phi_d = qd[11];
    let rocker_y_d = qd[7];
    let crank_x_d = qd[0];
    let crank_y_d = qd[1];
    let gauge_phi_d = qd[20];
    let gauge_x_d = qd[18];
    let gauge_y_d = qd[19];
    let plate_phi_d = qd[5];
    let plate_x_d = qd[3];
    let plate_y_d = qd[4];
    let stone_x_d = qd[12];
    let stone_y_d = qd[13];
    let crank_phi_dd = qdd[2];
    let rocker_phi_dd = qdd[8];
    let rocker_x_dd = qdd[6];
    let free_phi_dd = qdd[17];
    let sled_phi_dd = qdd[11];
    let rocker_y_dd = qdd[7];
    let crank_x_dd = qdd[0];
    let crank_y_dd = qdd[1];
    let gauge_phi_dd = qdd[20];
    let gauge_x_dd = qdd[18];
    let gauge_y_dd = qdd[19];
    let plate_phi_dd = qdd[5];
    let plate_x_dd = qdd[3];
    let plate_y_dd = qdd[4];
    let stone_x_dd = qdd[12];
    let stone_y_dd = qdd[13];
    let n = p.n;

    let v1 = a * half;
    let v2 = half + -1.0;
    let v3 = -1.0 + v2;
    let v4 = -1.0 + v3;
    let v5 = 4.0 * t;
    let (s6, _) = sin_cos(v5);
    let v7 = 2.0 * t;
    let (_, c8) = sin_cos(v7);
    let v9 = t / 2.0;
    let v10 = 6.0 * v9;
    let v11 = v10 + -15.0;
    let v12 = v9 * v11;
    let v13 = 10.0 + v12;
    let v14 = t / 3.0;
    let v15 = 3.141592653589793 * v14;
    let (s16, _) = sin_cos(v15);
    let v17 = -20.0 * v14;
    let v18 = v17 + 70.0;
    let v19 = v14 * v18;
    let v20 = v19 + -84.0;
    let v21 = v14 * v20;
    let v22 = v21 + 35.0;
    let v23 = v14 * v22;
    let v24 = 1.0 + t;
    let v25 = libm::pow(2.0, v14);
    let v26 = t / 4.0;
    let v27 = libm::cosh(v26);
    let v28 = libm::sinh(v14);
    let v29 = v24 / 6.0;
    let v30 = 12.566370614359172 * v29;
    let (_, c31) = sin_cos(v30);
    let v32 = 4.1887902047863905 * v29;
    let v33 = v32 + 1.0471975511965976;
    let (_, c34) = sin_cos(v33);
    let v35 = 6.283185307179586 * v29;
    let (_, c36) = sin_cos(v35);
    let v37 = libm::sqrt(v24);
    let v38 = 2.0 + t;
    let v39 = libm::log10(v38);
    let v40 = libm::log(v24);
    let v41 = -t;
    let v42 = libm::exp(v41);
    let (s43, c43) = sin_cos(sled_phi);
    let (s44, c44) = sin_cos(rocker_phi);
    let v45 = a * c44;
    let v46 = 2.0 * v45;
    let v47 = a * s44;
    let v48 = 2.0 * v47;
    let v49 = v46 + rocker_x;
    let v50 = v48 + rocker_y;
    let (s51, c51) = sin_cos(crank_phi);
    let (s52, c52) = sin_cos(free_phi);
    let v53 = rocker_x - crank_x;
    let v54 = rocker_y - crank_y;
    let v55 = v53 * v53;
    let v56 = v54 * v54;
    let v57 = v55 + v56;
    let v58 = libm::sqrt(v57);
    let (s59, c59) = sin_cos(gauge_phi);
    let v60 = c59 + gauge_x;
    let v61 = s59 + gauge_y;
    let (s62, c62) = sin_cos(plate_phi);
    let v63 = c62 * v1;
    let v64 = 0.1 * s62;
    let v65 = s62 * v1;
    let v66 = 0.1 * c62;
    let v67 = v63 - v64;
    let v68 = v65 + v66;
    let v69 = plate_x + v67;
    let v70 = plate_y + v68;
    let v71 = v49 - v69;
    let v72 = v50 - v70;
    let v73 = stone_x - rocker_x;
    let v74 = stone_y - rocker_y;
    let v75 = libm::hypot(v60, v61);
    let v76 = libm::tanh(crank_phi);
    let v77 = c51 / 3.0;
    let v78 = s51 / 2.0;
    let v79 = crank_phi / 9.0;
    let v80 = libm::tan(v79);
    let v81 = 2.0 * v58;
    let v82 = v76 * v76;
    let v83 = 1.0 - v82;
    let v84 = v60 / v75;
    let v85 = v61 / v75;
    let v86 = v78 * v78;
    let v87 = 1.0 - v86;
    let v88 = libm::sqrt(v87);
    let v89 = v77 * v77;
    let v90 = 1.0 - v89;
    let v91 = libm::sqrt(v90);
    let v92 = v61 * v61;
    let v93 = v60 * v60;
    let v94 = v92 + v93;
    let v95 = v60 / v94;
    let v96 = v61 / v94;
    let v97 = crank_phi * crank_phi;
    let v98 = 1.0 + v97;
    let v99 = v80 * v80;
    let v100 = 1.0 + v99;
    let v101 = 0.5 * v11;
    let v102 = 3.0 * v9;
    let v103 = v101 + v102;
    let v104 = 0.5 * v13;
    let v105 = v9 * v103;
    let v106 = v104 + v105;
    let v107 = 0.3333333333333333 * v18;
    let v108 = -6.666666666666666 * v14;
    let v109 = v107 + v108;
    let v110 = 0.3333333333333333 * v20;
    let v111 = v14 * v109;
    let v112 = v110 + v111;
    let v113 = 0.3333333333333333 * v22;
    let v114 = v14 * v112;
    let v115 = v113 + v114;
    let v116 = 0.3333333333333333 * v23;
    let v117 = v14 * v115;
    let v118 = v116 + v117;
    let v119 = libm::sinh(v26);
    let v120 = libm::cosh(v14);
    let v121 = v28 * v119;
    let v122 = 0.25 * v121;
    let v123 = v27 * v120;
    let v124 = 0.3333333333333333 * v123;
    let v125 = v122 + v124;
    let v126 = 2.0 * v37;
    let v127 = 1.0 / v126;
    let v128 = 2.302585092994046 * v38;
    let v129 = 1.0 / v128;
    let v130 = 1.0 / v24;
    let v131 = s44 * rocker_phi_d;
    let v132 = a * v131;
    let v133 = -2.0 * v132;
    let v134 = v133 + rocker_x_d;
    let v135 = c51 * crank_phi_d;
    let v136 = s51 * crank_phi_d;
    let v137 = crank_phi_d * v136;
    let v138 = crank_phi_d * v135;
    let v139 = c44 * rocker_phi_d;
    let v140 = rocker_phi_d * v139;
    let v141 = rocker_phi_d * v131;
    let v142 = s52 * free_phi_d;
    let v143 = c52 * free_phi_d;
    let v144 = free_phi_d * v143;
    let v145 = free_phi_d * v142;
    let v146 = s43 * sled_phi_d;
    let v147 = c43 * sled_phi_d;
    let v148 = a * v139;
    let v149 = 2.0 * v148;
    let v150 = v149 + rocker_y_d;
    let v151 = rocker_x_d - crank_x_d;
    let v152 = rocker_y_d - crank_y_d;
    let v153 = v53 * v151;
    let v154 = 2.0 * v153;
    let v155 = v54 * v152;
    let v156 = 2.0 * v155;
    let v157 = v154 + v156;
    let v158 = v157 / v81;
    let v159 = s59 * gauge_phi_d;
    let v160 = c59 * gauge_phi_d;
    let v161 = gauge_x_d - v159;
    let v162 = v160 + gauge_y_d;
    let v163 = s62 * plate_phi_d;
    let v164 = c62 * plate_phi_d;
    let v165 = v1 * v163;
    let v166 = v1 * v164;
    let v167 = -0.1 * v163;
    let v168 = -0.1 * v164;
    let v169 = v168 - v165;
    let v170 = v166 + v167;
    let v171 = plate_x_d + v169;
    let v172 = plate_y_d + v170;
    let v173 = v134 - v171;
    let v174 = v150 - v172;
    let v175 = stone_x_d - rocker_x_d;
    let v176 = stone_y_d - rocker_y_d;
    let v177 = v84 * v161;
    let v178 = v85 * v162;
    let v179 = v177 + v178;
    let v180 = crank_phi_d * v83;
    let v181 = v136 / 3.0;
    let v182 = v181 / v91;
    let v183 = v135 / 2.0;
    let v184 = v183 / v88;
    let v185 = crank_phi_d / 9.0;
    let v186 = v100 * v185;
    let v187 = crank_phi_d / v98;
    let v188 = v76 * v180;
    let v189 = v161 / v75;
    let v190 = v84 / v75;
    let v191 = v179 * v190;
    let v192 = v189 - v191;
    let v193 = v162 / v75;
    let v194 = v85 / v75;
    let v195 = v179 * v194;
    let v196 = v193 - v195;
    let v197 = v78 * v183;
    let v198 = -2.0 * v197;
    let v199 = 2.0 * v88;
    let v200 = v198 / v199;
    let v201 = v77 * v181;
    let v202 = 2.0 * v201;
    let v203 = 2.0 * v91;
    let v204 = v202 / v203;
    let v205 = v61 * v162;
    let v206 = 2.0 * v205;
    let v207 = v60 * v161;
    let v208 = 2.0 * v207;
    let v209 = v206 + v208;
    let v210 = v161 / v94;
    let v211 = v95 / v94;
    let v212 = v209 * v211;
    let v213 = v210 - v212;
    let v214 = v162 / v94;
    let v215 = v96 / v94;
    let v216 = v209 * v215;
    let v217 = v214 - v216;
    let v218 = crank_phi * crank_phi_d;
    let v219 = v80 * v186;
    let v220 = 0.5 * v103;
    let v221 = v102 + v220;
    let v222 = v220 + v221;
    let v223 = 0.5 * v106;
    let v224 = v9 * v222;
    let v225 = v223 + v224;
    let v226 = v223 + v225;
    let v227 = 0.3333333333333333 * v109;
    let v228 = -4.444444444444444 * v14;
    let v229 = v227 + v228;
    let v230 = v227 + v229;
    let v231 = 0.3333333333333333 * v112;
    let v232 = v14 * v230;
    let v233 = v231 + v232;
    let v234 = v231 + v233;
    let v235 = 0.3333333333333333 * v115;
    let v236 = v14 * v234;
    let v237 = v235 + v236;
    let v238 = v235 + v237;
    let v239 = 0.3333333333333333 * v118;
    let v240 = v14 * v238;
    let v241 = v239 + v240;
    let v242 = v239 + v241;
    let v243 = v127 / v126;
    let v244 = v127 * v243;
    let v245 = -2.0 * v244;
    let v246 = v129 / v128;
    let v247 = v130 / v24;
    let v248 = sled_phi_d * v147;
    let v249 = sled_phi_d * v146;
    let v250 = v151 * v151;
    let v251 = v152 * v152;
    let v252 = v158 / v81;
    let v253 = v158 * v252;
    let v254 = -2.0 * v253;
    let v255 = gauge_phi_d * v160;
    let v256 = gauge_phi_d * v159;
    let v257 = plate_phi_d * v164;
    let v258 = plate_phi_d * v163;
    let v259 = v161 * v192;
    let v260 = v162 * v196;
    let v261 = crank_phi_d * v188;
    let v262 = -2.0 * v261;
    let v263 = v182 / v91;
    let v264 = v204 * v263;
    let v265 = v184 / v88;
    let v266 = v200 * v265;
    let v267 = v185 * v219;
    let v268 = 2.0 * v267;
    let v269 = v187 / v98;
    let v270 = v218 * v269;
    let v271 = c51 * crank_phi_dd;
    let v272 = v271 - v137;
    let v273 = s51 * crank_phi_dd;
    let v274 = v138 + v273;
    let v275 = v136 * crank_phi_dd;
    let v276 = crank_phi_d * v274;
    let v277 = v275 + v276;
    let v278 = s44 * rocker_phi_dd;
    let v279 = v140 + v278;
    let v280 = a * v279;
    let v281 = -2.0 * v280;
    let v282 = v281 + rocker_x_dd;
    let v283 = c44 * rocker_phi_dd;
    let v284 = v283 - v141;
    let v285 = v139 * rocker_phi_dd;
    let v286 = rocker_phi_d * v284;
    let v287 = v285 + v286;
    let v288 = s52 * free_phi_dd;
    let v289 = v144 + v288;
    let v290 = c52 * free_phi_dd;
    let v291 = v290 - v145;
    let v292 = -2.302585092994046 * v246;
    let v293 = -2.0 * v270;
    let v294 = s43 * sled_phi_dd;
    let v295 = v248 + v294;
    let v296 = c43 * sled_phi_dd;
    let v297 = v296 - v249;
    let v298 = a * v284;
    let v299 = 2.0 * v298;
    let v300 = v299 + rocker_y_dd;
    let v301 = rocker_x_dd - crank_x_dd;
    let v302 = rocker_y_dd - crank_y_dd;
    let v303 = v53 * v301;
    let v304 = v250 + v303;
    let v305 = 2.0 * v304;
    let v306 = v54 * v302;
    let v307 = v251 + v306;
    let v308 = 2.0 * v307;
    let v309 = v305 + v308;
    let v310 = v309 / v81;
    let v311 = v254 + v310;
    let v312 = s59 * gauge_phi_dd;
    let v313 = v255 + v312;
    let v314 = c59 * gauge_phi_dd;
    let v315 = v314 - v256;
    let v316 = gauge_x_dd - v313;
    let v317 = v315 + gauge_y_dd;
    let v318 = s62 * plate_phi_dd;
    let v319 = v257 + v318;
    let v320 = c62 * plate_phi_dd;
    let v321 = v320 - v258;
    let v322 = v1 * v319;
    let v323 = v1 * v321;
    let v324 = -0.1 * v319;
    let v325 = -0.1 * v321;
    let v326 = v325 - v322;
    let v327 = v323 + v324;
    let v328 = plate_x_dd + v326;
    let v329 = plate_y_dd + v327;
    let v330 = v282 - v328;
    let v331 = v300 - v329;
    let v332 = stone_x_dd - rocker_x_dd;
    let v333 = stone_y_dd - rocker_y_dd;
    let v334 = v84 * v316;
    let v335 = v259 + v334;
    let v336 = v85 * v317;
    let v337 = v260 + v336;
    let v338 = v335 + v337;
    let v339 = crank_phi_dd * v83;
    let v340 = v262 + v339;
    let v341 = v274 / 3.0;
    let v342 = v341 / v91;
    let v343 = v342 - v264;
    let v344 = v272 / 2.0;
    let v345 = v344 / v88;
    let v346 = v345 - v266;
    let v347 = crank_phi_dd / 9.0;
    let v348 = v100 * v347;
    let v349 = v268 + v348;
    let v350 = crank_phi_dd / v98;
    let v351 = v293 + v350;
    let v352 = v275 + v277;
    let v353 = a * v352;
    let v354 = -v353;
    let v355 = v135 * crank_phi_dd;
    let v356 = crank_phi_d * v272;
    let v357 = v355 + v356;
    let v358 = v355 + v357;
    let v359 = v285 + v287;
    let v360 = a * v359;
    let v361 = -2.0 * v360;
    let v362 = v131 * rocker_phi_dd;
    let v363 = rocker_phi_d * v279;
    let v364 = v362 + v363;
    let v365 = v362 + v364;
    let v366 = v143 * free_phi_dd;
    let v367 = free_phi_d * v291;
    let v368 = v366 + v367;
    let v369 = v366 + v368;
    let v370 = v142 * free_phi_dd;
    let v371 = free_phi_d * v289;
    let v372 = v370 + v371;
    let v373 = v370 + v372;
    let v374 = -0.1 * v369;
    let v375 = -0.1 * v373;
    let v376 = v180 * v180;
    let v377 = v76 * v340;
    let v378 = v376 + v377;
    let v379 = v316 / v75;
    let v380 = v189 / v75;
    let v381 = v179 * v380;
    let v382 = v379 - v381;
    let v383 = v192 / v75;
    let v384 = v190 / v75;
    let v385 = v179 * v384;
    let v386 = v383 - v385;
    let v387 = v190 * v338;
    let v388 = v179 * v386;
    let v389 = v387 + v388;
    let v390 = v382 - v389;
    let v391 = v317 / v75;
    let v392 = v193 / v75;
    let v393 = v179 * v392;
    let v394 = v391 - v393;
    let v395 = v196 / v75;
    let v396 = v194 / v75;
    let v397 = v179 * v396;
    let v398 = v395 - v397;
    let v399 = v194 * v338;
    let v400 = v179 * v398;
    let v401 = v399 + v400;
    let v402 = v394 - v401;
    let v403 = v183 * v183;
    let v404 = v78 * v344;
    let v405 = v403 + v404;
    let v406 = -2.0 * v405;
    let v407 = v406 / v199;
    let v408 = v200 / v199;
    let v409 = v200 * v408;
    let v410 = -2.0 * v409;
    let v411 = v407 + v410;
    let v412 = v181 * v181;
    let v413 = v77 * v341;
    let v414 = v413 - v412;
    let v415 = 2.0 * v414;
    let v416 = v415 / v203;
    let v417 = v204 / v203;
    let v418 = v204 * v417;
    let v419 = -2.0 * v418;
    let v420 = v416 + v419;
    let v421 = v162 * v162;
    let v422 = v61 * v317;
    let v423 = v421 + v422;
    let v424 = 2.0 * v423;
    let v425 = v161 * v161;
    let v426 = v60 * v316;
    let v427 = v425 + v426;
    let v428 = 2.0 * v427;
    let v429 = v424 + v428;
    let v430 = v316 / v94;
    let v431 = v210 / v94;
    let v432 = v209 * v431;
    let v433 = v430 - v432;
    let v434 = v213 / v94;
    let v435 = v211 / v94;
    let v436 = v209 * v435;
    let v437 = v434 - v436;
    let v438 = v211 * v429;
    let v439 = v209 * v437;
    let v440 = v438 + v439;
    let v441 = v433 - v440;
    let v442 = v317 / v94;
    let v443 = v214 / v94;
    let v444 = v209 * v443;
    let v445 = v442 - v444;
    let v446 = v217 / v94;
    let v447 = v215 / v94;
    let v448 = v209 * v447;
    let v449 = v446 - v448;
    let v450 = v215 * v429;
    let v451 = v209 * v449;
    let v452 = v450 + v451;
    let v453 = v445 - v452;
    let v454 = crank_phi_d * crank_phi_d;
    let v455 = crank_phi * crank_phi_dd;
    let v456 = v454 + v455;
    let v457 = v186 * v186;
    let v458 = v80 * v349;
    let v459 = v457 + v458;
    let v460 = 64.0 * s6;
    let v461 = v460 / n;
    let v462 = -8.0 * c8;
    let v463 = v461 + v462;
    let v464 = 0.5 * v222;
    let v465 = 4.5 * v9;
    let v466 = v464 + v465;
    let v467 = v464 + v466;
    let v468 = v464 + v467;
    let v469 = 0.5 * v226;
    let v470 = v9 * v468;
    let v471 = v469 + v470;
    let v472 = v469 + v471;
    let v473 = v469 + v472;
    let v474 = select(sides[0], v473, 0.0);
    let v475 = select(sides[1], 0.0, v474);
    let v476 = 0.01 * v475;
    let v477 = select(sides[2], -444.4444444444443, 0.0);
    let v478 = select(sides[3], 0.0, v477);
    let v479 = 0.1 * v478;
    let v480 = v476 + v479;
    let v481 = -0.05741903088944409 * s16;
    let v482 = select(sides[4], v481, 0.0);
    let v483 = select(sides[1], 0.0, v482);
    let v484 = 0.3333333333333333 * v230;
    let v485 = v228 + v484;
    let v486 = v484 + v485;
    let v487 = v484 + v486;
    let v488 = 0.3333333333333333 * v234;
    let v489 = v14 * v487;
    let v490 = v488 + v489;
    let v491 = v488 + v490;
    let v492 = v488 + v491;
    let v493 = 0.3333333333333333 * v238;
    let v494 = v14 * v492;
    let v495 = v493 + v494;
    let v496 = v493 + v495;
    let v497 = v493 + v496;
    let v498 = 0.3333333333333333 * v242;
    let v499 = v14 * v497;
    let v500 = v498 + v499;
    let v501 = v498 + v500;
    let v502 = v498 + v501;
    let v503 = 0.1 * v502;
    let v504 = select(sides[4], v503, 0.0);
    let v505 = select(sides[1], 0.0, v504);
    let v506 = v483 + v505;
    let v507 = v24 * v24;
    let v508 = v507 * v507;
    let v509 = v508 * v24;
    let v510 = 1.0 / v509;
    let v511 = -24.0 * v510;
    let v512 = libm::pow(t, v4);
    let v513 = v3 * v512;
    let v514 = v2 * v513;
    let v515 = half * v514;
    let v516 = 0.012334246369960349 * v25;
    let v517 = 0.25 * v123;
    let v518 = 0.3333333333333333 * v121;
    let v519 = v517 + v518;
    let v520 = 0.3333333333333333 * v519;
    let v521 = 0.25 * v125;
    let v522 = v520 + v521;
    let v523 = 0.25 * v522;
    let v524 = 0.25 * v519;
    let v525 = 0.3333333333333333 * v125;
    let v526 = v524 + v525;
    let v527 = 0.3333333333333333 * v526;
    let v528 = v523 + v527;
    let v529 = 2.2967612355777636 * c31;
    let v530 = 0.765587078525921 * c34;
    let v531 = select(sides[11], v530, v529);
    let v532 = select(sides[12], v529, v531);
    let v533 = 0.14002478837788934 * v532;
    let v534 = select(sides[13], v533, 0.0);
    let v535 = select(sides[14], 0.0, v534);
    let v536 = 0.1827704518720251 * c36;
    let v537 = select(sides[13], v536, 0.0);
    let v538 = select(sides[14], 0.0, v537);
    let v539 = v245 / v126;
    let v540 = v243 / v126;
    let v541 = v127 * v540;
    let v542 = -2.0 * v541;
    let v543 = v539 + v542;
    let v544 = v243 * v244;
    let v545 = -2.0 * v544;
    let v546 = v127 * v543;
    let v547 = v545 + v546;
    let v548 = -2.0 * v547;
    let v549 = v292 / v128;
    let v550 = v246 / v128;
    let v551 = -2.302585092994046 * v550;
    let v552 = v549 + v551;
    let v553 = v247 / v24;
    let v554 = v130 * v246;
    let v555 = -2.302585092994046 * v554;
    let v556 = v129 * v247;
    let v557 = v555 - v556;
    let v558 = v40 * v552;
    let v559 = v554 + v558;
    let v560 = -2.302585092994046 * v559;
    let v561 = v557 + v560;
    let v562 = v39 * v553;
    let v563 = -2.0 * v562;
    let v564 = v556 + v563;
    let v565 = v557 - v564;
    let v566 = v561 + v565;
    let v567 = v566 - v42;
    let v568 = v548 + v567;
    let v569 = v538 + v568;
    let v570 = v535 + v569;
    let v571 = v528 + v570;
    let v572 = v516 + v571;
    let v573 = v515 + v572;
    let v574 = v511 + v573;
    let v575 = v147 * sled_phi_dd;
    let v576 = sled_phi_d * v297;
    let v577 = v575 + v576;
    let v578 = v146 * sled_phi_dd;
    let v579 = sled_phi_d * v295;
    let v580 = v578 + v579;
    let v581 = v151 * v301;
    let v582 = 2.0 * v581;
    let v583 = v152 * v302;
    let v584 = 2.0 * v583;
    let v585 = v311 / v81;
    let v586 = v252 / v81;
    let v587 = v158 * v586;
    let v588 = -2.0 * v587;
    let v589 = v585 + v588;
    let v590 = v252 * v311;
    let v591 = v158 * v589;
    let v592 = v590 + v591;
    let v593 = -2.0 * v592;
    let v594 = v160 * gauge_phi_dd;
    let v595 = gauge_phi_d * v315;
    let v596 = v594 + v595;
    let v597 = v159 * gauge_phi_dd;
    let v598 = gauge_phi_d * v313;
    let v599 = v597 + v598;
    let v600 = v164 * plate_phi_dd;
    let v601 = plate_phi_d * v321;
    let v602 = v600 + v601;
    let v603 = v163 * plate_phi_dd;
    let v604 = plate_phi_d * v319;
    let v605 = v603 + v604;
    let v606 = v173 * v330;
    let v607 = 2.0 * v606;
    let v608 = v174 * v331;
    let v609 = 2.0 * v608;
    let v610 = v284 * v175;
    let v611 = v139 * v332;
    let v612 = v610 + v611;
    let v613 = v279 * v176;
    let v614 = v131 * v333;
    let v615 = v613 + v614;
    let v616 = v192 * v316;
    let v617 = v161 * v390;
    let v618 = v616 + v617;
    let v619 = v196 * v317;
    let v620 = v162 * v402;
    let v621 = v619 + v620;
    let v622 = crank_phi_dd * v188;
    let v623 = crank_phi_d * v378;
    let v624 = v622 + v623;
    let v625 = -2.0 * v624;
    let v626 = v213 * v317;
    let v627 = v162 * v441;
    let v628 = v626 + v627;
    let v629 = v217 * v316;
    let v630 = v161 * v453;
    let v631 = v629 + v630;
    let v632 = v343 / v91;
    let v633 = v263 / v91;
    let v634 = v204 * v633;
    let v635 = v632 - v634;
    let v636 = v263 * v420;
    let v637 = v204 * v635;
    let v638 = v636 + v637;
    let v639 = v346 / v88;
    let v640 = v265 / v88;
    let v641 = v200 * v640;
    let v642 = v639 - v641;
    let v643 = v265 * v411;
    let v644 = v200 * v642;
    let v645 = v643 + v644;
    let v646 = v219 * v347;
    let v647 = v185 * v459;
    let v648 = v646 + v647;
    let v649 = 2.0 * v648;
    let v650 = v351 / v98;
    let v651 = v269 / v98;
    let v652 = v218 * v651;
    let v653 = -2.0 * v652;
    let v654 = v650 + v653;
    let v655 = v269 * v456;
    let v656 = v218 * v654;
    let v657 = v655 + v656;
    let v658 = -2.0 * v657;
    let v659 = v575 + v577;
    let v660 = v578 + v580;
    let v661 = a * v365;
    let v662 = -2.0 * v661;
    let v663 = a * v358;
    let v664 = -v663;
    let v665 = v581 + v582;
    let v666 = 2.0 * v665;
    let v667 = v583 + v584;
    let v668 = 2.0 * v667;
    let v669 = v666 + v668;
    let v670 = v669 / v81;
    let v671 = v310 / v81;
    let v672 = v158 * v671;
    let v673 = -2.0 * v672;
    let v674 = v670 + v673;
    let v675 = v593 + v674;
    let v676 = v594 + v596;
    let v677 = v597 + v599;
    let v678 = v600 + v602;
    let v679 = v603 + v605;
    let v680 = v1 * v678;
    let v681 = v1 * v679;
    let v682 = -0.1 * v678;
    let v683 = 0.1 * v679;
    let v684 = v680 - v683;
    let v685 = v361 + v684;
    let v686 = v681 - v682;
    let v687 = v662 + v686;
    let v688 = v71 * v685;
    let v689 = v606 + v688;
    let v690 = v607 + v689;
    let v691 = 2.0 * v690;
    let v692 = v72 * v687;
    let v693 = v608 + v692;
    let v694 = v609 + v693;
    let v695 = 2.0 * v694;
    let v696 = v691 + v695;
    let v697 = -0.6 * v659;
    let v698 = -0.6 * v660;
    let v699 = -0.8 * v659;
    let v700 = 0.8 * v660;
    let v701 = v697 + v700;
    let v702 = v698 + v699;
    let v703 = 0.6 * v702;
    let v704 = -0.8 * v701;
    let v705 = v703 + v704;
    let v706 = v73 * v365;
    let v707 = v610 - v706;
    let v708 = v612 + v707;
    let v709 = v611 + v612;
    let v710 = v708 + v709;
    let v711 = v74 * v359;
    let v712 = v613 + v711;
    let v713 = v615 + v712;
    let v714 = v614 + v615;
    let v715 = v713 + v714;
    let v716 = v710 + v715;
    let v717 = select(sides[16], v663, v664);
    let v718 = v717 / 10.0;
    let v719 = select(sides[17], 0.0, v675);
    let v720 = select(sides[18], v664, 0.0);
    let v721 = select(sides[18], 0.0, v354);
    let v722 = v720 + v721;
    let v723 = select(sides[19], v722, 0.0);
    let v724 = v719 + v723;
    let v725 = v84 * v676;
    let v726 = v616 - v725;
    let v727 = v618 + v726;
    let v728 = v85 * v677;
    let v729 = v619 - v728;
    let v730 = v621 + v729;
    let v731 = v727 + v730;
    let v732 = -2.0 * v622;
    let v733 = v625 + v732;
    let v734 = v733 / 10.0;
    let v735 = v95 * v677;
    let v736 = v626 - v735;
    let v737 = v628 + v736;
    let v738 = v96 * v676;
    let v739 = v629 - v738;
    let v740 = v631 + v739;
    let v741 = v737 - v740;
    let v742 = v358 / 3.0;
    let v743 = v742 / v91;
    let v744 = v342 / v91;
    let v745 = v204 * v744;
    let v746 = v743 - v745;
    let v747 = v746 - v638;
    let v748 = v747 / 4.0;
    let v749 = v352 / 2.0;
    let v750 = v749 / v88;
    let v751 = v345 / v88;
    let v752 = v200 * v751;
    let v753 = v750 + v752;
    let v754 = v645 + v753;
    let v755 = v754 - v748;
    let v756 = v741 + v755;
    let v757 = 2.0 * v646;
    let v758 = v649 + v757;
    let v759 = v350 / v98;
    let v760 = v218 * v759;
    let v761 = -2.0 * v760;
    let v762 = v658 + v761;
    let v763 = sides[20] * v762;
    let v764 = v763 / 5.0;
    let v765 = v758 + v764;
    let v766 = -v696;
    let v767 = -v705;
    let v768 = -v718;
    let v769 = v724 - v374;
    let v770 = v734 - v731;
    let v771 = -v756;
    let v772 = 0.17453292519943295 * v463;
    let v773 = v506 - v375;

    out[2] = v663;
    out[3] = v353;
    out[7] = v766;
    out[9] = v767;
    out[10] = v716;
    out[12] = v768;
    out[13] = v769;
    out[14] = v770;
    out[15] = v771;
    out[16] = v765;
    out[17] = v772;
    out[18] = v480;
    out[19] = v773;
    out[20] = v574;
    out
}

impl Equations for Model {
    type Q = Q;
    type Entries = [f64; ENTRIES];
    type Sides = Sides;

    fn pattern() -> &'static [(usize, usize)] {
        &PHI_Q_PATTERN
    }

    fn scales() -> &'static Q {
        &SCALES
    }

    fn phi(&self, q: &Q, t: f64, sides: &Sides) -> Q {
        phi_with(q, t, &self.params, sides)
    }

    fn phi_q(&self, q: &Q, t: f64, sides: &Sides) -> Self::Entries {
        phi_q_with(q, t, &self.params, sides)
    }

    fn nu(&self, q: &Q, t: f64, sides: &Sides) -> Q {
        nu_with(q, t, &self.params, sides)
    }

    fn gamma(&self, q: &Q, qd: &Qd, t: f64, sides: &Sides) -> Qdd {
        gamma_with(q, qd, t, &self.params, sides)
    }
}

impl Branches for Model {
    const OF_TIME: bool = true;
    const OF_MOTION: bool = true;
    const END: Option<f64> = Some(0.35);

    fn sides_of_time(&self, t: f64) -> Sides {
        sides_of_time(t, &self.params)
    }

    fn is_of_time() -> &'static [bool] {
        &IS_OF_TIME
    }

    fn sides_of_motion(&self, q: &Q, t: f64, sides: &Sides) -> Sides {
        sides_of_motion(q, t, &self.params, sides)
    }
}

impl Checks for Model {
    type Watched = [bool; 0];
}

impl Solved for Model {
    type Tears = [f64; TEARS];
    type Turns = [bool; TURNS];
    type Measures = Measures;
    type Joined = [f64; 0];
    type Along = Time;

    fn tear_scales() -> &'static Self::Tears {
        &TEAR_SCALES
    }

    fn turned() -> &'static Self::Turns {
        &TURNED
    }

    #[rustfmt::skip]
    fn tears(q: &Q) -> Self::Tears {
        [
            q[8], q[10], q[19], q[18],
            q[11],
        ]
    }

    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Sides, at: &mut Solution) {
        solve(guess, t, self, sides, at);
    }

    fn pivoted(&self, q: &Q, t: f64, sides: &Sides, _at: &Solution) -> Result<Solution, Fault> {
        solve_with_pivoting(self, q, t, sides)
    }
}

/// The width of a cell of each coordinate's grid.
#[rustfmt::skip]
static CELLS: [f64; N] = [
    7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9, 3.725290298461914e-9,
    3.725290298461914e-9, 7.450580596923828e-9, 1.4901161193847656e-8, 1.4901161193847656e-8,
    7.450580596923828e-9, 1.4901161193847656e-8, 1.4901161193847656e-8, 7.450580596923828e-9,
    1.4901161193847656e-8, 1.4901161193847656e-8, 7.450580596923828e-9, 1.4901161193847656e-8,
    1.4901161193847656e-8, 7.450580596923828e-9, 1.4901161193847656e-8, 1.4901161193847656e-8,
    7.450580596923828e-9,
];

/// Number of blocks of equations that can be solved one after the other.
const BLOCKS: usize = 19;

/// The blocks whose determinants change.
#[rustfmt::skip]
static TURNING: [usize; TURNS] = [
    8, 12, 17, 10,
];

/// Numbers that the elimination of the largest block works on.
const WORK: usize = work_of(2);

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: Blocks<'static> = Blocks {
    sizes: &[
        1, 1, 1, 1,
        1, 1, 1, 1,
        1, 2, 1, 1,
        1, 1, 1, 1,
        1, 2, 1,
    ],
    rows: &[
        0, 1, 17, 2,
        3, 4, 5, 6,
        7, 8, 18, 9,
        12, 10, 11, 20,
        13, 16, 14, 15,
        19,
    ],
    columns: &[
        0, 1, 2, 3,
        4, 5, 6, 7,
        8, 9, 10, 11,
        13, 12, 14, 17,
        15, 20, 18, 19,
        16,
    ],
    starts: &[
        0, 1, 2, 5,
        8, 10, 11, 12,
        18, 20, 21, 26,
        28, 32, 39, 43,
        47, 49, 50, 52,
        54, 56,
    ],
    entries: &[
        0, 1, 0, 2,
        3, 1, 2, 4,
        2, 5, 6, 7,
        3, 4, 5, 6,
        7, 8, 9, 10,
        11, 6, 7, 8,
        12, 13, 8, 14,
        0, 2, 9, 13,
        0, 1, 2, 6,
        7, 15, 17, 2,
        18, 19, 20, 2,
        18, 19, 20, 2,
        20, 2, 9, 10,
        16, 17, 2, 17,
    ],
    places: &[
        0, 1, 2, 3,
        4, 5, 6, 7,
        8, 9, 10, 11,
        13, 12, 14, 16,
        20, 15, 18, 19,
        17,
    ],
    units: &[
        1.0, 1.0, 1.0, 0.5,
        0.5, 1.0, 2.0, 2.0,
        1.0, 2.0, 2.0, 1.0,
        2.0, 2.0, 1.0, 2.0,
        2.0, 1.0, 2.0, 2.0,
        1.0,
    ],
};

impl Pivoting for Model {
    type Work = [f64; WORK];
    type Blocks = [bool; BLOCKS];
    type Varied = [f64; 0];
    type Rights = [Q; 0];

    const TOLERANCE: f64 = 1e-12;
    const HAS_JERK: bool = true;

    fn blocks() -> &'static Blocks<'static> {
        &EQUATIONS
    }

    fn turning() -> &'static [usize] {
        &TURNING
    }

    fn cells() -> &'static Q {
        &CELLS
    }

    fn jerk(&self, [q, qd, qdd]: [&Q; 3], t: f64, sides: &Sides) -> Q {
        jerk_with(q, qd, qdd, t, &self.params, sides)
    }

    fn rights(&self, _q: &Q, _t: f64, _sides: &Sides) -> [Q; 0] {
        []
    }

    fn measured(&self, [q, qd, qdd, qddd]: [&Q; 4], _varied: &[f64; 0], t: f64) -> Measures {
        measures(q, qd, qdd, qddd, t, &self.params)
    }
}

/// Number of places where a formula of time may end.
const RIMS: usize = 3;

/// Quantities that are zero where a formula of time may end, and then their slopes.
///
/// 2 operations.
fn rims_of_time(t: f64, _p: &Params) -> [f64; 2 * RIMS] {
    let mut out = [0.0; 2 * RIMS];
    let v1 = 1.0 + t;
    let v2 = 2.0 + t;

    out[0] = v1;
    out[1] = t;
    out[2] = v2;
    out[3] = 1.0;
    out[4] = 1.0;
    out[5] = 1.0;
    out
}

impl Rimmed for Model {
    type Gauges = [f64; 2 * RIMS];

    fn gauges(&self, t: f64) -> Self::Gauges {
        rims_of_time(t, &self.params)
    }
}

impl Timed for Model {
    type Params = Params;
    type Lead = ();
    type Passed = [f64; RIMS];
    type Row = [f64; COLUMNS];

    const START_TIME: f64 = START_TIME;
    const SPAN: f64 = SPAN;
    const LONGEST_STEP: f64 = LONGEST_STEP;
    const SMALLEST_STEP: f64 = SMALLEST_STEP;

    fn new(params: &Params) -> Self {
        Self {
            params: *params,
            known: known(params),
        }
    }

    fn params(&self) -> &Params {
        &self.params
    }

    fn start() -> &'static Q {
        &START
    }

    fn first_rim(&self, from: f64, to: f64, passed: &Self::Passed) -> Option<(usize, f64)> {
        first_rim(self, from, to, passed)
    }

    fn look_at_rim(state: &mut State, rim: usize, t: f64) -> Result<(), Error> {
        look_at_rim(state, rim, t)
    }
}

/// What solves the equations and follows the motion, the same for all mechanisms.
#[rustfmt::skip]
mod runtime {
pub mod numbers {
//! Numbers by place, and how large they are.

use core::fmt::Debug;

/// So many numbers.
pub trait Numbers: Copy + Debug + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// All of them 0.
    const ZERO: Self;
}

impl<const K: usize> Numbers for [f64; K] {
    const ZERO: Self = [0.0; K];
}

/// So many answers.
pub trait Flags: Copy + Debug + PartialEq + 'static + AsRef<[bool]> + AsMut<[bool]> {
    /// All of them no.
    const NONE: Self;
}

impl<const K: usize> Flags for [bool; K] {
    const NONE: Self = [false; K];
}

/// The largest value beside its scale; not a number if one is not.
pub fn largest<N: Numbers>(values: &N, scales: &N) -> f64 {
    let pairs = values.as_ref().iter().zip(scales.as_ref());
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// The larger one; not a number if one is not.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// What is the largest so far, in the loops that solve, which have time for one comparison: a value that is not a number wins, but only
/// until the next. What it comes from is not a number either, and is asked for that.
pub fn larger_so_far(largest: f64, value: f64) -> f64 {
    if value <= largest { largest } else { value }
}

/// What leads from some numbers to others.
pub fn difference<N: Numbers>(to: &N, from: &N) -> N {
    let mut way = *to;
    way.as_mut().iter_mut().zip(from.as_ref()).for_each(|(way, from)| *way -= from);
    way
}

/// Coordinates after a time `h` (s), by their velocities and accelerations now.
pub fn predicted<N: Numbers>(q: &N, qd: &N, qdd: &N, h: f64) -> N {
    let mut later = *q;
    let rates = qd.as_ref().iter().zip(qdd.as_ref());
    for (q, (qd, qdd)) in later.as_mut().iter_mut().zip(rates) {
        *q += h * (qd + 0.5 * h * qdd);
    }
    later
}
}

pub mod error {
//! Why something cannot be done.

/// Why a mechanism could not be brought to a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The time, a parameter or a formula is not a number.
    NotANumber,
    /// A driver has come to a position beyond which the mechanism cannot follow it: a dead point.
    LockUp,
    /// Two branches of the motion meet: which one goes on is not determined.
    Bifurcation,
    /// Newton's iteration does not arrive, however short the step.
    Divergence,
    /// The steps that were allowed do not lead so far; nothing is wrong with the motion up to here.
    TooFar,
    /// At a time where a formula of time goes over to another branch, a position or velocity jumps.
    NotSmooth,
    /// An equation that was left out as redundant does not hold beside the others.
    Inconsistent,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Error::NotANumber => "the time, a parameter or a formula is not a number",
            Error::LockUp => "the mechanism locks up: its driver cannot go on",
            Error::Bifurcation => "two branches of the motion meet",
            Error::Divergence => "the motion cannot be followed",
            Error::TooFar => "the time is too far away for so few steps",
            Error::NotSmooth => "a position or velocity jumps",
            Error::Inconsistent => "an equation that was left out as redundant does not hold",
        })
    }
}

impl core::error::Error for Error {}

/// Why a step is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Something is not a number.
    NotANumber,
    /// The step is too long for the motion.
    TooFar,
    /// The position is on another branch, or too near to one.
    Singular,
    /// A position or velocity jumps.
    NotSmooth,
    /// An equation that was left out does not hold.
    LeftOut,
}

impl Fault {
    /// Why a mechanism cannot be assembled.
    pub fn at_start(self) -> Error {
        match self {
            Self::NotANumber => Error::NotANumber,
            Self::LeftOut => Error::Inconsistent,
            _ => Error::Divergence,
        }
    }
}
}

pub mod equations {
//! What is asked of a mechanism with its parameters: its equations, their branches, and what must hold beside them.

use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// The equations `phi = 0` and what follows from them.
pub trait Equations: Clone + Debug {
    /// A number for each coordinate, and for each equation.
    type Q: Numbers;
    /// One for each entry of `phi_q` that does not vanish.
    type Entries: Numbers;
    /// Which branch formulas take, by place: what a comparison gives, the number of a piece.
    type Sides: Numbers + PartialEq;

    /// Row and column of each entry of `phi_q`.
    fn pattern() -> &'static [(usize, usize)];

    /// What a change of each coordinate is judged against.
    fn scales() -> &'static Self::Q;

    /// What is left of the equations.
    fn phi(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The entries of their Jacobian.
    fn phi_q(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Entries;

    /// The right side of the velocity equation.
    fn nu(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The right side of the acceleration equation.
    fn gamma(&self, q: &Self::Q, qd: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;
}

/// What decides the branches of formulas. Where formulas have none, all of this is nothing.
pub trait Branches: Equations {
    /// Whether time alone decides some.
    const OF_TIME: bool = false;

    /// Whether the motion decides some.
    const OF_MOTION: bool = false;

    /// The last time of the file's analysis (s), at which formulas of time take their earlier branches.
    const END: Option<f64> = None;

    /// Which of them time alone decides.
    fn is_of_time() -> &'static [bool] {
        &[]
    }

    /// The branches that time alone decides, the others as 0.
    fn sides_of_time(&self, _t: f64) -> Self::Sides {
        Self::Sides::ZERO
    }

    /// The branches at a position, those of time being known.
    fn sides_of_motion(&self, _q: &Self::Q, _t: f64, sides: &Self::Sides) -> Self::Sides {
        *sides
    }
}

/// What must hold beside the equations; of most mechanisms nothing.
pub trait Checks: Equations {
    /// Which quantities that keep their signs along a branch are positive.
    type Watched: Flags;

    /// Whether distances are positive, and places within their intervals and tables.
    fn conditions_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Whether the equations that were left out hold.
    fn left_out_holds(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// What keeps its sign along a branch of the motion.
    fn watched(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> Self::Watched {
        Self::Watched::NONE
    }
}
}

pub mod measured {
//! What is measured.

use core::fmt::Debug;

/// Measures with their first and second time derivatives.
pub trait Measured: Copy + Debug {
    /// Nothing is measured yet.
    const ZERO: Self;

    /// Which of them, in the order of [`lists`](Measured::lists), are derivatives by inputs or parameters.
    const IS_VARIED: &'static [bool] = &[];

    /// Values, rates and accelerations.
    fn lists(&self) -> [&[f64]; 3];

    /// The same, to be written.
    fn lists_mut(&mut self) -> [&mut [f64]; 3];

    /// What is not finite is no number.
    fn leave_out(&mut self) {
        for list in self.lists_mut() {
            for value in list.iter_mut().filter(|value| !value.is_finite()) {
                *value = f64::NAN;
            }
        }
    }

    /// Close to a singular position derivatives by inputs and parameters have no value.
    fn leave_varied_out(&mut self) {
        let mut rest = Self::IS_VARIED.iter();
        for list in self.lists_mut() {
            for (value, _) in list.iter_mut().zip(&mut rest).filter(|(_, is_varied)| **is_varied) {
                *value = f64::NAN;
            }
        }
    }
}

/// Where nothing is measured.
impl Measured for () {
    const ZERO: Self = ();

    fn lists(&self) -> [&[f64]; 3] {
        [&[]; 3]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut [], &mut [], &mut []]
    }
}
}

pub mod solution {
//! What solves the equations at a time, and what that is found by.

use super::equations::{Branches, Checks};
use super::error::Fault;
use super::measured::Measured;
use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// Equations with the operations that solve them.
pub trait Solved: Branches + Checks {
    /// A number for each coordinate that Newton solves for; the others follow.
    type Tears: Numbers;
    /// An answer for each block of equations whose determinant changes with the position.
    type Turns: Flags;
    /// What is measured.
    type Measures: Measured;
    /// Values that only measures need.
    type Joined: Numbers;
    /// What the motion goes along: time, or signals.
    type Along: Along<Self>;

    /// What a change of each coordinate that Newton solves for is judged against.
    fn tear_scales() -> &'static Self::Tears;

    /// Whether determinants are negative where all pivots are positive.
    fn turned() -> &'static Self::Turns;

    /// Of all coordinates those that Newton solves for.
    fn tears(q: &Self::Q) -> Self::Tears;

    /// Position, velocity and acceleration at a time.
    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Self::Sides, at: &mut Solution<Self>);

    /// The same by elimination with partial pivoting from a position nearby, where [`solve`](Solved::solve) has failed with `at`;
    /// a fault where blocks are too large for that.
    fn pivoted(
        &self,
        _q: &Self::Q,
        _t: f64,
        _sides: &Self::Sides,
        at: &Solution<Self>,
    ) -> Result<Solution<Self>, Fault> {
        Err(at.fault())
    }
}

/// What a motion goes along, with what a solution holds of that.
pub trait Along<M: Solved>: Clone + Debug {
    /// Nothing is known yet.
    const ZERO: Self;

    /// Coordinates at a distance `h` from a solution.
    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q;

    /// A place a little ahead, at which the branches of formulas tell those on which the motion goes on.
    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64);

    /// Takes down what a solution has been found for.
    fn note(&mut self, _m: &M, _t: f64) {}

    /// The derivatives of the coordinates, by what the motion goes along.
    fn slopes(&self) -> &[M::Q] {
        &[]
    }

    /// The same, to be written.
    #[allow(dead_code)] // what is neither pivoted nor listed knows them by their names
    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut []
    }
}

/// What solves the equations at a time.
#[derive(Clone, Debug)]
pub struct Solution<M: Solved> {
    /// The time (s), or the place on a way.
    pub t: f64,
    /// Coordinates.
    pub q: M::Q,
    /// Velocities.
    pub qd: M::Q,
    /// Accelerations.
    pub qdd: M::Q,
    /// Measures.
    pub measures: M::Measures,
    /// What only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::Joined,
    /// What it holds of what the motion goes along.
    pub along: M::Along,
    /// The branches of formulas.
    pub sides: M::Sides,
    /// Which quantities that must keep their signs are positive.
    pub watched: M::Watched,
    /// By block of equations: whether its determinant is negative.
    pub is_negative: M::Turns,
    /// Whether Newton has arrived.
    pub is_settled: bool,
    /// Whether no digits were lost, and the equations hold.
    pub holds: bool,
    /// Newton's largest first correction, scaled.
    pub first: f64,
    /// One over the smallest pivot, scaled.
    pub steepest: f64,
}

impl<M: Solved> Solution<M> {
    /// Nothing is solved yet.
    pub const ZERO: Self = Self {
        t: 0.0,
        q: M::Q::ZERO,
        qd: M::Q::ZERO,
        qdd: M::Q::ZERO,
        measures: M::Measures::ZERO,
        joined: M::Joined::ZERO,
        along: M::Along::ZERO,
        sides: M::Sides::ZERO,
        watched: M::Watched::NONE,
        is_negative: M::Turns::NONE,
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Nothing but a position and its time.
    pub fn near(q: &M::Q, t: f64) -> Self {
        let mut near = Self::ZERO;
        (near.t, near.q) = (t, *q);
        near
    }

    /// Makes ready for being solved for.
    pub fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = *M::turned();
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Why it cannot be used.
    pub fn fault(&self) -> Fault {
        if self.is_finite() { Fault::TooFar } else { Fault::NotANumber }
    }

    /// Whether all of it is numbers; measures may be none.
    pub fn is_finite(&self) -> bool {
        let are_finite = |list: &M::Q| list.as_ref().iter().all(|value| value.is_finite());
        let lists = are_finite(&self.q) && are_finite(&self.qd) && are_finite(&self.qdd);
        lists && self.along.slopes().iter().all(are_finite)
    }
}
}

pub mod pivots {
//! What pivots tell of a position.

use super::numbers::larger_so_far;
use super::solution::{Solution, Solved};

impl<M: Solved> Solution<M> {
    /// Takes note of one over a pivot, and of what makes that a pure number.
    pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger_so_far(self.steepest, inverse.abs() * weight);
    }
}
}

pub mod grid {
//! The grid on which Newton's iteration goes from point to point.

/// The grid point next to a value.
pub fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}
}

pub mod newton {
//! Newton's iteration.

use super::limits::{HALF_A_CELL, LARGEST_CORRECTION};
use super::numbers::{larger, larger_so_far};
use super::solution::{Solution, Solved};

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace in where it ends.
#[allow(clippy::struct_excessive_bools)] // each is an answer of its own
pub struct Newton {
    is_first: bool,
    is_open: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
}

impl Newton {
    /// It has not begun.
    pub fn new() -> Self {
        Self { is_first: true, is_open: false, is_lost: false, has_settled: false, first: 0.0 }
    }

    /// A coordinate with its correction; its grid has cells so wide, and it is judged against `scale`.
    pub fn corrected(&mut self, x: f64, delta: f64, cell: f64, scale: f64) -> f64 {
        let size = delta.abs();
        if self.is_first {
            self.first = larger_so_far(self.first, size / scale);
        }
        self.is_open |= size > HALF_A_CELL * cell;
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
        x + delta
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_open && !self.is_lost;
        let is_done = self.has_settled || self.is_lost;
        (self.is_first, self.is_open) = (false, false);
        is_done
    }
}

impl<M: Solved> Solution<M> {
    /// Takes over how an iteration went.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
}

pub mod branches {
//! The branches of formulas along the motion.

use super::equations::Branches;
use super::limits::{MOST_HALVINGS, SLACK};
use super::solution::{Along, Solution, Solved};

/// A time on the later side of whatever is meant to happen at `t` (s).
fn shortly_after(t: f64) -> f64 {
    t + SLACK * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}

/// The branches of formulas of time at a time: the later ones where they change just then, but at the end of the file's analysis
/// the earlier ones.
pub fn sides_at<M: Branches>(t: f64, m: &M) -> M::Sides {
    match M::END {
        Some(end) if t <= end && shortly_after(t) >= end => m.sides_of_time(end - 2.0 * (shortly_after(end) - end)),
        _ => m.sides_of_time(shortly_after(t)),
    }
}

/// The first time of a step at which formulas of time take other branches than at its beginning; its end if they do not.
pub fn first_edge<M: Branches>(from: f64, to: f64, m: &M) -> f64 {
    let here = sides_at(from, m);
    if sides_at(to, m) == here {
        return to;
    }
    let (mut near, mut far) = (from, to);
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            break;
        }
        if sides_at(middle, m) == here {
            near = middle;
        } else {
            far = middle;
        }
    }
    far
}

/// The branches at a position that is next to one that is looked for.
pub fn sides_near<M: Branches>(q: &M::Q, t: f64, m: &M) -> M::Sides {
    m.sides_of_motion(q, t, &sides_at(t, m))
}

/// The branches with those of time exchanged.
pub fn with_time<M: Branches>(sides: &M::Sides, of_time: &M::Sides) -> M::Sides {
    let mut all = *sides;
    let pairs = of_time.as_ref().iter().zip(M::is_of_time());
    for (side, (of_time, is_of_time)) in all.as_mut().iter_mut().zip(pairs) {
        if *is_of_time {
            *side = *of_time;
        }
    }
    all
}

/// The branches of formulas of the motion that lie ahead of a position.
pub fn sides_ahead<M: Solved>(at: &Solution<M>, m: &M) -> M::Sides {
    let (q, t) = M::Along::ahead(m, at);
    m.sides_of_motion(&q, t, &at.sides)
}
}

pub mod reach {
//! Solving at a time, on the branches that are there.

use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Fault;
use super::limits::{ACCURACY, MOST_BRANCHES, STEEP, STEEPEST};
use super::measured::Measured;
use super::numbers::{larger, largest};
use super::solution::{Along, Solution, Solved};

/// Solves at a time, from a guess; `from` is where the motion comes from.
pub fn reach<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
) -> Result<(), Fault> {
    let of_time = sides_at(t, m);
    if !M::OF_MOTION {
        return find(guess, from, t, m, &of_time, at);
    }
    let mut sides = from.sides;
    for _ in 0..MOST_BRANCHES {
        sides = with_time::<M>(&sides, &of_time);
        find(guess, from, t, m, &sides, at)?;
        let now = sides_ahead(at, m);
        if now == sides {
            return Ok(());
        }
        sides = now;
    }
    Err(Fault::TooFar)
}

/// Solves with branches of formulas that are known.
pub fn find<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
) -> Result<(), Fault> {
    m.solve(guess, t, sides, at);
    if !at.is_settled || !at.holds {
        find_with_pivoting(from, t, m, sides, at)?;
    }
    if !m.conditions_hold(&at.q, t, sides) {
        return Err(Fault::NotANumber);
    }
    if !m.left_out_holds(&at.q, t, sides) {
        return Err(Fault::LeftOut);
    }
    at.watched = m.watched(&at.q, t, sides);
    at.sides = *sides;
    at.along.note(m, t);
    at.measures.leave_out();
    if at.is_finite() { Ok(()) } else { Err(Fault::NotANumber) }
}

/// Solves once more from a position that is known, and if that does not help either, takes that.
#[cold]
#[inline(never)]
fn find_with_pivoting<M: Solved>(
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
) -> Result<(), Fault> {
    let q = M::Along::predicted(m, from, t - from.t);
    let pivoted = m.pivoted(&q, t, sides, at)?;
    m.solve(&M::tears(&pivoted.q), t, sides, at);
    let first = pivoted.first;
    if !at.is_settled || !at.holds {
        *at = pivoted;
    }
    at.first = first;
    Ok(())
}

/// What rounding makes of the velocities and accelerations, for every unit of steepness: they are amplified by as much as the
/// position is near to a singular one.
pub fn rounding<M: Solved>(at: &Solution<M>, m: &M) -> f64 {
    let (t, sides, scales) = (at.t, &at.sides, M::scales());
    let slopes = m.phi_q(&at.q, t, sides);
    let mut norms = at.q;
    norms.as_mut().fill(f64::MIN_POSITIVE);
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let norm = norms.as_mut().get_mut(row);
        if let (Some(norm), Some(scale)) = (norm, scales.as_ref().get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
    let nu = m.nu(&at.q, t, sides);
    let velocity = ratio(largest(&at.qd, scales), largest(&nu, &norms));
    let gamma = m.gamma(&at.q, &at.qd, t, sides);
    let acceleration = ratio(largest(&at.qdd, scales), largest(&gamma, &norms));
    let amplified = larger(larger(velocity, acceleration), 1.0);
    f64::EPSILON * amplified
}

/// Whether a position that is reached lies on the branch of the motion that it comes from, whose equations are so steep.
pub fn stays_on_branch<M: Solved>(
    from: &Solution<M>,
    at: &mut Solution<M>,
    m: &M,
    is_wanted: bool,
    steepness: f64,
) -> bool {
    let steepest = at.steepest / steepness;
    if at.watched != from.watched || at.is_negative != from.is_negative || steepest > STEEPEST {
        return false;
    }
    if steepest > STEEP {
        at.measures.leave_varied_out();
    }
    let is_in_doubt = is_wanted && steepest > STEEP && steepest * rounding(at, m) > ACCURACY;
    !is_in_doubt
}
}

pub mod state {
//! A mechanism that moves with time, and where it is.

use super::error::Error;
use super::limits::{AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD};
use super::measured::Measured;
use super::numbers::{Numbers, largest, predicted};
use super::solution::{Along, Solution, Solved};
use core::fmt::Debug;

/// What can be set of a mechanism.
pub trait Parameters: Copy + Debug + Default {
    /// Part of the way from these to others.
    #[must_use]
    fn towards(&self, other: &Self, part: f64) -> Self;

    /// Whether all are numbers.
    fn is_finite(&self) -> bool;
}

/// A mechanism whose motion goes along time.
pub trait Timed: Solved<Along = Time> {
    /// Its parameters.
    type Params: Parameters;
    /// What leads it by its inputs; `()` where it has none.
    type Lead: Lead<Self>;
    /// By rim, where formulas of time may end: the time at which it was looked at last (s).
    type Passed: Numbers;
    /// A number for each result.
    type Row: Numbers;

    /// The first time of the file's analysis (s), at which the mechanism is assembled.
    const START_TIME: f64;
    /// How long the file's analysis takes (s).
    const SPAN: f64;
    /// The longest step (s).
    const LONGEST_STEP: f64;
    /// The shortest step (s).
    const SMALLEST_STEP: f64;

    /// The mechanism with some parameters.
    fn new(params: &Self::Params) -> Self;

    /// Its parameters.
    fn params(&self) -> &Self::Params;

    /// The assembled position with the file's parameters.
    fn start() -> &'static Self::Q;

    /// The first rim of a step that was not looked at yet, with its time.
    fn first_rim(&self, _from: f64, _to: f64, _passed: &Self::Passed) -> Option<(usize, f64)> {
        None
    }

    /// Looks at both sides of a rim next to the state.
    fn look_at_rim(_state: &mut State<Self>, _rim: usize, _t: f64) -> Result<(), Error> {
        Ok(())
    }
}

/// What leads a mechanism by its inputs.
pub trait Lead<M: Timed>: Clone + Debug {
    /// Nothing is led yet.
    fn new(params: &M::Params) -> Self;

    /// Whether inputs have led to where the mechanism is, rather than the time.
    fn is_leading(&self) -> bool;

    /// Brings a mechanism that inputs have led back to what the formulas of its inputs say at its time.
    fn take_up_time(state: &mut State<M>, most: usize) -> Result<(), Error>;
}

impl<M: Timed> Lead<M> for () {
    fn new(_: &M::Params) -> Self {}

    fn is_leading(&self) -> bool {
        false
    }

    fn take_up_time(_: &mut State<M>, _: usize) -> Result<(), Error> {
        Ok(())
    }
}

/// The motion goes along time.
#[derive(Clone, Copy, Debug)]
pub struct Time;

impl<M: Timed> Along<M> for Time {
    const ZERO: Self = Self;

    fn predicted(_: &M, from: &Solution<M>, h: f64) -> M::Q {
        predicted(&from.q, &from.qd, &from.qdd, h)
    }

    fn ahead(_: &M, at: &Solution<M>) -> (M::Q, f64) {
        let (speed, acceleration) = (largest(&at.qd, M::scales()), largest(&at.qdd, M::scales()));
        let mut ahead = f64::min(f64::min(AHEAD * M::SPAN, LONGEST_AHEAD), FARTHEST_AHEAD / speed);
        ahead = f64::min(ahead, FARTHEST_AHEAD / (acceleration * ahead));
        (predicted(&at.q, &at.qd, &at.qdd, ahead), at.t + ahead)
    }
}

/// A mechanism at a time.
#[derive(Clone, Debug)]
pub struct State<M: Timed> {
    pub(super) model: M,
    /// The solution of now and the one before, or the next one in the making.
    pub(super) solutions: [Solution<M>; 2],
    /// Whether that of now is the second.
    pub(super) is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    pub(super) is_smooth: bool,
    /// How much steeper these parameters make the equations than the file's.
    pub(super) steepness: f64,
    /// The step that goes well (s).
    pub(super) step: f64,
    /// What leads by inputs.
    pub(super) lead: M::Lead,
    /// By rim: the time at which it was looked at last (s).
    pub(super) passed: M::Passed,
}

impl<M: Timed> State<M> {
    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &M::Params {
        self.model.params()
    }

    /// The coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Q {
        &self.at().q
    }

    /// Their velocities (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Q {
        &self.at().qd
    }

    /// Their accelerations (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Q {
        &self.at().qdd
    }

    /// The measures, by their indices, and their first and second time derivatives; `NAN` where one has no value, and no step fails
    /// for that.
    #[must_use]
    pub fn measures(&self) -> &M::Measures {
        &self.at().measures
    }

    /// Whether inputs have led here, rather than the time.
    pub(super) fn is_led(&self) -> bool {
        self.lead.is_leading()
    }

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures, then their first and their second
    /// derivatives.
    #[must_use]
    pub fn row(&self) -> M::Row {
        let at = self.at();
        let [values, rates, accelerations] = at.measures.lists();
        let zeroth = at.q.as_ref().iter().chain(values);
        let first = at.qd.as_ref().iter().chain(rates);
        let second = at.qdd.as_ref().iter().chain(accelerations);
        let all = [at.t].into_iter().chain(zeroth.chain(first).chain(second).copied());
        let mut row = M::Row::ZERO;
        row.as_mut().iter_mut().zip(all).for_each(|(cell, value)| *cell = value);
        row
    }
}
}

pub mod assemble {
//! The start of a motion.

use super::branches::sides_near;
use super::error::{Error, Fault};
use super::limits::{LARGEST_CORRECTION, MOST_PARTS, SMALLEST_PART};
use super::numbers::Numbers;
use super::reach::reach;
use super::solution::Solution;
use super::state::{Lead, Parameters, State, Timed};

/// Brings the mechanism to its first time with some parameters, along the branch that the file's parameters give.
pub fn assemble<M: Timed>(params: &M::Params) -> Result<State<M>, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let file = M::Params::default();
    let mut at = Solution::ZERO;
    start(M::start(), &M::new(&file), &mut at).map_err(Fault::at_start)?;
    let mut found = at.clone();
    let usual = at.steepest;
    let mut why = Error::Divergence;
    // the part of the way from the file's parameters to those that are wanted
    let (mut done, mut part) = (0.0, 1.0);
    for _ in 0..MOST_PARTS {
        let next = f64::min(done + part, 1.0);
        let params = if next < 1.0 { file.towards(params, next) } else { *params };
        let model = M::new(&params);
        let result = start(&at.q, &model, &mut found);
        if result.is_ok() && found.is_negative == at.is_negative {
            if next >= 1.0 {
                let ratio = found.steepest / usual;
                let mut passed = M::Passed::ZERO;
                passed.as_mut().fill(f64::NEG_INFINITY);
                return Ok(State {
                    steepness: if ratio > 0.0 { ratio } else { 1.0 },
                    lead: M::Lead::new(&params),
                    model,
                    solutions: [found, at],
                    is_second: false,
                    is_smooth: false,
                    step: M::LONGEST_STEP,
                    passed,
                });
            }
            at.clone_from(&found);
            (done, part) = (next, 2.0 * part);
        } else {
            why = result.err().map_or(Error::Divergence, Fault::at_start);
            part *= 0.5;
        }
        if part < SMALLEST_PART {
            break;
        }
    }
    Err(why)
}

/// Solves at the first time, from a position nearby.
fn start<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>) -> Result<(), Fault> {
    let mut near = Solution::near(q, M::START_TIME);
    near.sides = sides_near(q, M::START_TIME, m);
    reach(&M::tears(q), &near, M::START_TIME, m, at)?;
    if at.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Fault::TooFar) }
}
}

pub mod explain {
//! Why a motion cannot go on.

use super::branches::sides_at;
use super::error::{Error, Fault};
use super::limits::{NEAR_FOLD, SINGULAR};
use super::solution::{Solution, Solved};
use super::state::{State, Timed};

/// Why even the shortest step from a state towards a time is refused.
pub fn explain<M: Timed>(state: &State<M>, fault: Fault, t: f64) -> Error {
    let at = state.at();
    if let Some(error) = regular(at, fault, t, &state.model) {
        return error;
    }
    if at.steepest < SINGULAR * state.steepness {
        return if fault == Fault::LeftOut { Error::Inconsistent } else { Error::Divergence };
    }
    let left = until_turn(at);
    meeting(if t < at.t { -left } else { left }, M::SPAN)
}

/// Why it is, if that has nothing to do with how near the position is to a singular one.
pub fn regular<M: Solved>(at: &Solution<M>, fault: Fault, t: f64, m: &M) -> Option<Error> {
    let values = m.phi(&at.q, t, &at.sides);
    if fault == Fault::NotANumber || values.as_ref().iter().any(|value| !value.is_finite()) {
        return Some(Error::NotANumber);
    }
    // a position that jumps far is not even found on the other side
    let is_at_edge = || sides_at(at.t, m) != sides_at(t, m);
    let jumps = fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge());
    jumps.then_some(Error::NotSmooth)
}

/// How long it takes to a dead point: a motion that comes to one after a time u is as the root of u, whose slope over twice its
/// curvature is u. That of the fastest coordinate counts.
pub fn until_turn<M: Solved>(at: &Solution<M>) -> f64 {
    let rates = at.qd.as_ref().iter().zip(at.qdd.as_ref()).zip(M::scales().as_ref());
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed { (v.abs() / scale, 0.5 * v / a) } else { (speed, left) }
    };
    rates.fold((0.0, 0.0), sooner).1
}

/// What the motion meets at a singular position: a dead point if that is so little of a span ahead.
pub fn meeting(left: f64, span: f64) -> Error {
    if left > 0.0 && left < NEAR_FOLD * span { Error::LockUp } else { Error::Bifurcation }
}
}

pub mod step {
//! Steps from time to time.

use super::branches::first_edge;
use super::error::{Error, Fault};
use super::explain::explain;
use super::limits::{
    FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, LEAD, POSITION_JUMP, REST, VELOCITY_JUMP,
};
use super::numbers::{Numbers, difference, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Lead, State, Timed};

/// Moves a state to time `t` (s) in so many steps at most, each as short as the motion asks for: position, velocity and acceleration
/// are those of the branch that it is on, whichever way `t` lies.
pub fn step_within<M: Timed>(t: f64, state: &mut State<M>, most: usize) -> Result<(), Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    if state.is_led() {
        M::Lead::take_up_time(state, most)?;
    }
    for _ in 0..most {
        let now = state.at().t;
        let left = t - now;
        if left == 0.0 {
            return Ok(());
        }
        // no crumb at the end
        let wanted = if state.step >= 0.999 * left.abs() { t } else { now + state.step.copysign(left) };
        // what is fast may be over before the step's end
        let edge = first_edge(now, wanted, &state.model);
        let next = match state.model.first_rim(now, edge, &state.passed) {
            None => edge,
            Some((rim, at)) => {
                let before = at - (LEAD * M::SPAN).copysign(left);
                if (before - now) * left <= 0.0 {
                    M::look_at_rim(state, rim, at)?;
                    continue;
                }
                before
            }
        };
        let (is_last, size) = (next == t, (next - now).abs());
        match advance(state, next, is_last) {
            Ok(is_calm) => {
                let longest = if is_calm { state.step.max(2.0 * size) } else { state.step.min(size) };
                state.step = longest.min(M::LONGEST_STEP);
                if is_last {
                    return Ok(());
                }
            }
            Err(fault) => {
                state.step = 0.5 * size;
                state.is_smooth = false;
                if state.step < M::SMALLEST_STEP || now + state.step == now {
                    state.step = M::SMALLEST_STEP;
                    return Err(explain(state, fault, next));
                }
            }
        }
    }
    if state.at().t == t { Ok(()) } else { Err(Error::TooFar) }
}

/// One step to a time; says whether a longer one would do as well.
fn advance<M: Timed>(state: &mut State<M>, t: f64, is_wanted: bool) -> Result<bool, Fault> {
    let [first, second] = &mut state.solutions;
    let (from, at) = if state.is_second { (second, first) } else { (first, second) };
    let from = &*from;
    let h = t - from.t;
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let mut way = if state.is_smooth { bend(from, at, h) } else { M::Tears::ZERO };
    let mut guess = x;
    let rates = v.as_ref().iter().zip(a.as_ref());
    for ((way, guess), (v, a)) in way.as_mut().iter_mut().zip(guess.as_mut()).zip(rates) {
        // Taylor
        *way += h * (v + 0.5 * h * a);
        *guess += *way;
    }
    // what is not a number is not small either
    let is_short = largest(&way, M::tear_scales()) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    reach(&guess, from, t, &state.model, at)?;
    let gap = gap(from, at, h);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    if !stays_on_branch(from, at, &state.model, is_wanted, state.steepness) {
        return Err(Fault::Singular);
    }
    if M::OF_TIME && at.sides != from.sides && jumps(from, at, &state.model) {
        return Err(Fault::NotSmooth);
    }
    state.is_smooth = at.sides == from.sides;
    state.is_second = !state.is_second;
    Ok(at.first < LARGEST_CORRECTION / 12.0 && gap < LARGEST_GAP / 100.0)
}

/// How far positions are from what both ends' velocities and accelerations make of the way between (Hermite), scaled.
fn gap<M: Solved>(from: &Solution<M>, at: &Solution<M>, h: f64) -> f64 {
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let (y, w, b) = (M::tears(&at.q), M::tears(&at.qd), M::tears(&at.qdd));
    let mut gaps = M::Tears::ZERO;
    let ways = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    largest(&gaps, M::tear_scales())
}

/// What the motion since the solution before adds to Taylor's way over a time `h` (s): value, velocity and acceleration at two times
/// make a polynomial of degree 5 (Hermite).
fn bend<M: Solved>(now: &Solution<M>, before: &Solution<M>, h: f64) -> M::Tears {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return M::Tears::ZERO;
    }
    let (x, v, a) = (M::tears(&now.q), M::tears(&now.qd), M::tears(&now.qdd));
    let (y, w, b) = (M::tears(&before.q), M::tears(&before.qd), M::tears(&before.qdd));
    let mut bend = M::Tears::ZERO;
    let ways = x.as_ref().iter().zip(y.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        let value = y - x + back * (v - 0.5 * back * a);
        let slope = back * (v - back * a - w);
        let curvature = 0.5 * back * back * (b - a);
        let cubic = 4.0 * slope - 10.0 * value - curvature;
        let quartic = 7.0 * slope - 15.0 * value - 2.0 * curvature;
        let quintic = 3.0 * slope - 6.0 * value - curvature;
        *bend = u * u * u * (cubic + u * (quartic + u * quintic));
    }
    bend
}

/// Whether position or velocity differ on the two sides of a time at which formulas change their branches: `at` is the later side, and
/// `from` has the branches of the earlier one.
fn jumps<M: Timed>(from: &Solution<M>, at: &Solution<M>, m: &M) -> bool {
    let mut before = at.clone();
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before).is_err() {
        return true;
    }
    let (way, change) = (difference(&at.q, &before.q), difference(&at.qd, &before.qd));
    let scales = M::scales();
    let fastest = largest(&at.qd, scales) + largest(&before.qd, scales) + REST / M::SPAN;
    largest(&way, scales) > POSITION_JUMP || largest(&change, scales) > VELOCITY_JUMP * fastest
}
}

pub mod rims {
//! Times at which formulas of time come to the end of what their functions take.

use super::error::Error;
use super::limits::{
    FEWEST_LOOKS, GROWTH, LEAD, MOMENT, MOST_HALVINGS, MOST_LOOKS, PASSED, ROUNDING, SLOW, SPEED_JUMP,
};
use super::numbers::{Numbers, difference, larger, largest, predicted};
use super::reach::reach;
use super::solution::Solution;
use super::state::{State, Timed};

/// A mechanism whose formulas of time may end.
pub trait Rimmed: Timed {
    /// By rim a number for its gauge, and then one for the slope of each.
    type Gauges: Numbers;

    /// Quantities that are zero where a formula of time may end, and then their slopes.
    fn gauges(&self, t: f64) -> Self::Gauges;
}

/// The first time of a step at which the gauge of a rim comes to zero and was not looked at yet, with the rim: it changes its sign, or
/// goes down to zero and up again.
pub fn first_rim<M: Rimmed>(m: &M, from: f64, to: f64, passed: &M::Passed) -> Option<(usize, f64)> {
    let (first, last) = (m.gauges(from), m.gauges(to));
    let rims = passed.as_ref().len();
    let ends = first.as_ref().iter().zip(last.as_ref());
    let (gauges, slopes) = (ends.clone().take(rims), ends.skip(rims));
    let mut found = None;
    for ((rim, passed), ((a, b), slopes)) in passed.as_ref().iter().enumerate().zip(gauges.zip(slopes)) {
        let sign = 1.0_f64.copysign(*a);
        let way = (sign * (to - from)).signum();
        let is_crossed = sign * b < 0.0;
        let comes_and_goes = way * slopes.0 < 0.0 && way * slopes.1 > 0.0;
        if !is_crossed && !comes_and_goes {
            continue;
        }
        let is_before = |t: f64| {
            let (value, slope) = gauge(rim, t, m);
            if is_crossed { sign * value > 0.0 } else { way * slope < 0.0 }
        };
        let at = last_halving(from, to, is_before);
        let is_new = (at - passed).abs() > PASSED * M::SPAN;
        let is_first = found.is_none_or(|(_, known): (usize, f64)| (at - known) * (to - from) < 0.0);
        if is_new && is_first && is_zero(rim, at, m) {
            found = Some((rim, at));
        }
    }
    found
}

/// The first time of two neighbours, found by halving, that is no longer before something.
fn last_halving(from: f64, to: f64, is_before: impl Fn(f64) -> bool) -> f64 {
    let (mut near, mut far) = (from, to);
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            break;
        }
        if is_before(middle) {
            near = middle;
        } else {
            far = middle;
        }
    }
    far
}

/// The gauge of a rim and its slope.
fn gauge<M: Rimmed>(rim: usize, t: f64, m: &M) -> (f64, f64) {
    let all = m.gauges(t);
    let all = all.as_ref();
    let of = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
    (of(rim), of(rim + all.len() / 2))
}

/// Whether a gauge is zero at a time, as far as numbers can tell.
fn is_zero<M: Rimmed>(rim: usize, t: f64, m: &M) -> bool {
    let moment = MOMENT * f64::EPSILON * t.abs() + f64::MIN_POSITIVE;
    let (here, _) = gauge(rim, t, m);
    let changes = |t: f64| {
        let ratio = gauge(rim, t, m).0 / here;
        let is_alike = ratio > 0.5 && ratio < 2.0;
        !is_alike
    };
    here.abs() <= ROUNDING * f64::EPSILON || changes(t - moment) || changes(t + moment)
}

/// What is seen of both sides of a rim, the nearer the later.
struct Looks {
    count: usize,
    /// How many of them show a jump.
    jumps: usize,
    /// In how many velocities and accelerations have grown.
    growths: [usize; 2],
    fastest: f64,
    hardest: f64,
    /// What no smooth motion explains: at first, and now.
    widest: f64,
    rest: f64,
}

impl Looks {
    /// One more look, a distance on both sides.
    fn add<M: Timed>(&mut self, before: &Solution<M>, after: &Solution<M>, distance: f64) {
        let scales = M::scales();
        let speed = larger(largest(&before.qd, scales), largest(&after.qd, scales));
        let force = larger(largest(&before.qdd, scales), largest(&after.qdd, scales));
        let (mut way, mut change) = (difference(&after.q, &before.q), difference(&after.qd, &before.qd));
        let rates = before.qd.as_ref().iter().zip(after.qd.as_ref());
        let bends = before.qdd.as_ref().iter().zip(after.qdd.as_ref());
        let parts = way.as_mut().iter_mut().zip(change.as_mut());
        for ((way, change), ((v, w), (a, b))) in parts.zip(rates.zip(bends)) {
            let bend = distance * distance * (b - a) / 3.0;
            *way = *way - distance * (v + w) + bend;
            *change -= distance * (a + b);
        }
        self.rest = larger(largest(&change, scales), largest(&way, scales) / M::SPAN);
        if self.count == 0 {
            self.widest = self.rest;
        }
        self.jumps += usize::from(self.rest > SPEED_JUMP * larger(speed, SLOW / M::SPAN));
        let [of_speed, of_force] = &mut self.growths;
        *of_speed += usize::from(speed > GROWTH * self.fastest);
        *of_force += usize::from(force > GROWTH * self.hardest);
        (self.fastest, self.hardest) = (speed, force);
        self.count += 1;
    }

    /// Whether the motion goes on smoothly.
    fn verdict<M: Timed>(&self) -> Result<(), Error> {
        let [of_speed, of_force] = self.growths;
        let is_seen = self.count >= FEWEST_LOOKS;
        if is_seen && of_speed + 1 == self.count && self.fastest > SLOW / M::SPAN {
            return Err(Error::NotANumber);
        }
        if is_seen && self.jumps == self.count && self.rest > 0.5 * self.widest {
            return Err(Error::NotSmooth);
        }
        if is_seen && self.count == MOST_LOOKS && of_force + 1 == self.count {
            return Err(Error::NotANumber);
        }
        Ok(())
    }
}

/// Looks at both sides of a rim, next to the state: whether the motion goes on smoothly.
pub fn look_at_rim<M: Timed>(state: &mut State<M>, rim: usize, t: f64) -> Result<(), Error> {
    if let Some(passed) = state.passed.as_mut().get_mut(rim) {
        *passed = t;
    }
    let (mut before, mut after) = (state.at().clone(), state.at().clone());
    let (mut at, mut distance) = (Solution::ZERO, LEAD * M::SPAN);
    let mut looks = Looks {
        count: 0,
        jumps: 0,
        growths: [0, 0],
        fastest: f64::INFINITY,
        hardest: f64::INFINITY,
        widest: 0.0,
        rest: 0.0,
    };
    for _ in 0..MOST_LOOKS {
        let found = look(t - distance, &before, &state.model, &mut at);
        if found {
            before.clone_from(&at);
            if looks.count == 0 {
                after.clone_from(&at);
            }
        }
        if found && look(t + distance, &after, &state.model, &mut at) {
            after.clone_from(&at);
            looks.add(&before, &after, distance);
        }
        distance *= 0.25;
    }
    looks.verdict::<M>()
}

/// Solves at a time close to a solution; whether it could.
fn look<M: Timed>(t: f64, near: &Solution<M>, m: &M, at: &mut Solution<M>) -> bool {
    let tears = [&near.q, &near.qd, &near.qdd].map(M::tears);
    let guess = predicted(&tears[0], &tears[1], &tears[2], t - near.t);
    reach(&guess, near, t, m, at).is_ok()
}
}

pub mod blocks {
// Sparse linear equations that fall apart into blocks, each solved by elimination with partial pivoting.
//
// For places where an order of elimination that was fixed beforehand loses digits. All scaling is by powers of two, which
// round nothing.

/// Equations for as many unknowns, and how they fall apart: a block's equations hold its own unknowns and those of the blocks
/// before it.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'b> {
    /// How many equations each block has.
    pub sizes: &'b [usize],
    /// The equations, block by block.
    pub rows: &'b [usize],
    /// The unknowns, block by block.
    pub columns: &'b [usize],
    /// Where the entries of each equation begin, and where those of the last one end.
    pub starts: &'b [usize],
    /// The unknown of each entry.
    pub entries: &'b [usize],
    /// By unknown: its place in `columns`.
    pub places: &'b [usize],
    /// By unknown: the power of two that it is measured by.
    pub units: &'b [f64],
}

/// Solves for `x`: the values of the entries times `x` are `right`, which is given by equation.
///
/// `work` holds as many numbers as the largest block has entries, and one more for each of its equations. Writes for each block
/// whether its determinant is negative, and gives the smallest pivot, beside rows whose largest entry is about 1; what is not a
/// number wins.
pub fn solve(
    blocks: &Blocks<'_>,
    values: &[f64],
    right: &[f64],
    x: &mut [f64],
    work: &mut [f64],
    is_negative: &mut [bool],
) -> f64 {
    let (mut smallest, mut at) = (f64::INFINITY, 0);
    for (&size, is_negative) in blocks.sizes.iter().zip(is_negative) {
        let places = at..at + size;
        at += size;
        let (Some(rows), Some(columns)) = (blocks.rows.get(places.clone()), blocks.columns.get(places.clone())) else {
            break;
        };
        let Some((matrix, solution)) = work.split_at_mut_checked(size * (size + 1)) else {
            break;
        };
        for (line, &row) in lines(matrix, size + 1).zip(rows) {
            fill(blocks, row, places.start, values, right, x, line);
        }
        let Some(solution) = solution.get_mut(..size) else {
            break;
        };
        let pivot;
        (pivot, *is_negative) = eliminate(matrix, solution);
        smallest = if pivot >= smallest { smallest } else { pivot };
        for (&column, &value) in columns.iter().zip(&*solution) {
            if let (Some(x), Some(unit)) = (x.get_mut(column), blocks.units.get(column)) {
                *x = value * unit;
            }
        }
    }
    smallest
}

/// How many numbers the work for a block of a size takes.
#[must_use]
pub const fn work_of(size: usize) -> usize {
    size * (size + 2)
}

/// A matrix row by row.
fn lines(matrix: &mut [f64], width: usize) -> impl Iterator<Item = &mut [f64]> {
    let mut left = matrix;
    core::iter::from_fn(move || {
        let (line, rest) = core::mem::take(&mut left).split_at_mut_checked(width)?;
        left = rest;
        Some(line)
    })
}

/// One equation of the block whose unknowns begin at a place, scaled, with what is known brought to the right.
fn fill(blocks: &Blocks<'_>, row: usize, first: usize, values: &[f64], right: &[f64], x: &[f64], line: &mut [f64]) {
    line.fill(0.0);
    let (mut sum, mut largest) = (right.get(row).copied().unwrap_or(f64::NAN), 0.0);
    let ends = (blocks.starts.get(row), blocks.starts.get(row + 1));
    let (Some(&from), Some(&to)) = ends else {
        return;
    };
    let entries = blocks.entries.iter().zip(values).take(to).skip(from);
    let size = line.len() - 1;
    for (&column, &value) in entries {
        let place = blocks.places.get(column).map_or(usize::MAX, |place| place.wrapping_sub(first));
        let unit = blocks.units.get(column).copied().unwrap_or(1.0);
        match line.get_mut(place).filter(|_| place < size) {
            Some(entry) => {
                *entry = value * unit;
                largest = if entry.abs() > largest { entry.abs() } else { largest };
            }
            None => sum -= value * x.get(column).copied().unwrap_or(0.0),
        }
    }
    if let Some(last) = line.last_mut() {
        *last = sum;
    }
    if largest > 0.0 && largest.is_finite() {
        // two over the power of two that is not above it
        let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
        for entry in line {
            *entry *= factor;
        }
    }
}

/// Elimination with partial pivoting of rows that end with their right sides; gives the smallest pivot, and whether the
/// determinant is negative.
fn eliminate(matrix: &mut [f64], x: &mut [f64]) -> (f64, bool) {
    let width = x.len() + 1;
    let (mut smallest, mut is_negative) = (f64::INFINITY, false);
    let mut left = &mut *matrix;
    for k in 0..x.len() {
        let Some((first, below)) = core::mem::take(&mut left).split_at_mut_checked(width) else {
            break;
        };
        let entry = |line: &[f64]| line.get(k).copied().unwrap_or(0.0);
        for line in lines(below, width) {
            if entry(line).abs() > entry(first).abs() {
                is_negative = !is_negative;
                for (a, b) in first.iter_mut().zip(line) {
                    core::mem::swap(a, b);
                }
            }
        }
        let pivot = entry(first);
        is_negative ^= pivot < 0.0;
        smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
        for line in lines(below, width) {
            let factor = entry(line) / pivot;
            if factor != 0.0 {
                for (a, b) in line.iter_mut().zip(&*first).skip(k) {
                    *a -= factor * b;
                }
            }
        }
        left = below;
    }
    let mut rest = &*matrix;
    for k in (0..x.len()).rev() {
        let Some((before, line)) = rest.split_at_checked(k * width) else {
            break;
        };
        rest = before;
        let sum = line.get(width - 1).copied().unwrap_or(f64::NAN);
        let sum = line.iter().zip(&*x).skip(k + 1).fold(sum, |sum, (a, x)| sum - a * x);
        if let (Some(x), Some(pivot)) = (x.get_mut(k), line.get(k)) {
            *x = sum / pivot;
        }
    }
    (smallest, is_negative)
}
}

pub mod pivoting {
//! Solving by elimination with partial pivoting, where the order that `solve` has loses digits.

use super::blocks::{self, Blocks};
use super::error::Fault;
use super::grid::on_grid;
use super::limits::{HALF_A_CELL, ITERATIONS};
use super::numbers::{Flags, Numbers, largest};
use super::solution::{Along, Solution, Solved};

/// Equations that can be solved by elimination with partial pivoting.
pub trait Pivoting: Solved {
    /// Numbers that the elimination of the largest block works on.
    type Work: Numbers;
    /// An answer for each block of equations.
    type Blocks: Flags;
    /// The derivatives of coordinates, velocities and accelerations by inputs and parameters that measures hold.
    type Varied: Numbers;
    /// A right side for each derivative by what the motion goes along.
    type Rights: AsRef<[Self::Q]>;

    /// What may be left of an equation, beside the norm of its row.
    const TOLERANCE: f64;
    /// Whether measures hold third derivatives of the coordinates.
    const HAS_JERK: bool = false;
    /// By derivative by inputs and parameters: whether it is one by two.
    const IS_BY_TWO: &'static [bool] = &[];

    /// How the equations fall apart into blocks.
    fn blocks() -> &'static Blocks<'static>;

    /// The blocks whose determinants change.
    fn turning() -> &'static [usize];

    /// The width of a cell of each coordinate's grid.
    fn cells() -> &'static Self::Q;

    /// The right side of the jerk equation.
    fn jerk(&self, _orders: [&Self::Q; 3], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// The right sides for the derivatives by inputs and parameters, as far as those before them are found.
    fn varied_right(
        &self,
        _orders: [&Self::Q; 3],
        _varied: &Self::Varied,
        _t: f64,
        _sides: &Self::Sides,
    ) -> Self::Varied {
        Self::Varied::ZERO
    }

    /// The right sides for the derivatives by what the motion goes along.
    fn rights(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Rights;

    /// What is measured, from the coordinates with their first three derivatives.
    fn measured(&self, orders: [&Self::Q; 4], varied: &Self::Varied, t: f64) -> Self::Measures;
}

/// The solution from a position nearby. All coordinates lie on a grid while Newton goes on.
pub fn solve_with_pivoting<M: Pivoting>(m: &M, q: &M::Q, t: f64, sides: &M::Sides) -> Result<Solution<M>, Fault> {
    let mut at = Solution::near(q, t);
    let mut elimination = Elimination::<M>::new();
    if !settle(m, &mut at, sides, &mut elimination) {
        return Err(at.fault());
    }
    let slopes = m.phi_q(&at.q, t, sides);
    let (qd, pivot) = elimination.solve(&slopes, &m.nu(&at.q, t, sides));
    let (qdd, _) = elimination.solve(&slopes, &m.gamma(&at.q, &qd, t, sides));
    let orders = [&at.q, &qd, &qdd];
    let qddd = if M::HAS_JERK { elimination.solve(&slopes, &m.jerk(orders, t, sides)).0 } else { M::Q::ZERO };
    let rights = m.rights(&at.q, t, sides);
    for (slopes_by, right) in at.along.slopes_mut().iter_mut().zip(rights.as_ref()) {
        *slopes_by = without_signs_of_zero(elimination.solve(&slopes, right).0);
    }
    let varied = vary(m, &mut elimination, &slopes, orders, t, sides);
    at.measures = m.measured([&at.q, &qd, &qdd, &qddd], &varied, t);
    (at.qd, at.qdd) = (without_signs_of_zero(qd), without_signs_of_zero(qdd));
    at.holds = is_next_to_nothing::<M>(&m.phi(&at.q, t, sides), &slopes, &at.q);
    at.q = without_signs_of_zero(at.q);
    at.steepest = 1.0 / pivot;
    let negative = elimination.is_negative.as_ref();
    for (turned, block) in at.is_negative.as_mut().iter_mut().zip(M::turning()) {
        *turned = negative.get(*block).copied().unwrap_or(false);
    }
    if at.holds { Ok(at) } else { Err(Fault::TooFar) }
}

/// Newton's iteration; whether it has arrived.
fn settle<M: Pivoting>(m: &M, at: &mut Solution<M>, sides: &M::Sides, elimination: &mut Elimination<M>) -> bool {
    for iteration in 0..ITERATIONS {
        for (q, cell) in at.q.as_mut().iter_mut().zip(M::cells().as_ref()) {
            *q = on_grid(*q, *cell);
        }
        let slopes = m.phi_q(&at.q, at.t, sides);
        let mut right = m.phi(&at.q, at.t, sides);
        right.as_mut().iter_mut().for_each(|value| *value = -*value);
        let (x, _) = elimination.solve(&slopes, &right);
        if iteration == 0 {
            at.first = largest(&x, M::scales());
        }
        at.q.as_mut().iter_mut().zip(x.as_ref()).for_each(|(q, x)| *q += x);
        if largest(&x, M::cells()) <= HALF_A_CELL {
            return true;
        }
    }
    false
}

/// The derivatives of the coordinates, their velocities and accelerations by inputs and parameters: those by one before those by two,
/// each order from those before.
fn vary<M: Pivoting>(
    m: &M,
    elimination: &mut Elimination<M>,
    slopes: &M::Entries,
    orders: [&M::Q; 3],
    t: f64,
    sides: &M::Sides,
) -> M::Varied {
    let mut varied = M::Varied::ZERO;
    let n = M::scales().as_ref().len();
    for by_two in [false, true] {
        for order in 0..3 {
            let rights = m.varied_right(orders, &varied, t, sides);
            for (number, _) in M::IS_BY_TWO.iter().enumerate().filter(|(_, of)| **of == by_two) {
                let first = (3 * number + order) * n;
                let mut right = M::Q::ZERO;
                let given = rights.as_ref().iter().skip(first);
                right.as_mut().iter_mut().zip(given).for_each(|(to, from)| *to = *from);
                let (x, _) = elimination.solve(slopes, &right);
                let places = varied.as_mut().iter_mut().skip(first);
                places.zip(x.as_ref()).for_each(|(place, x)| *place = *x);
            }
        }
    }
    varied
}

/// The work of solving linear equations in blocks.
pub struct Elimination<M: Pivoting> {
    work: M::Work,
    is_negative: M::Blocks,
}

impl<M: Pivoting> Elimination<M> {
    /// Room for the work.
    pub fn new() -> Self {
        Self { work: M::Work::ZERO, is_negative: M::Blocks::NONE }
    }

    /// The solution for a right side, and the smallest pivot.
    pub fn solve(&mut self, slopes: &M::Entries, right: &M::Q) -> (M::Q, f64) {
        let mut x = M::Q::ZERO;
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let pivot = blocks::solve(M::blocks(), slopes.as_ref(), right.as_ref(), x.as_mut(), work, is_negative);
        (x, pivot)
    }
}

/// Whether what is left of the equations is within their tolerance, and what rounding makes of the coordinates.
fn is_next_to_nothing<M: Pivoting>(values: &M::Q, slopes: &M::Entries, q: &M::Q) -> bool {
    let mut bounds = M::Q::ZERO;
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let bound = bounds.as_mut().get_mut(row);
        let sizes = (M::scales().as_ref().get(column), q.as_ref().get(column), bound);
        if let (Some(scale), Some(q), Some(bound)) = sizes {
            *bound += M::TOLERANCE * (slope * scale).abs() + 8.0 * f64::EPSILON * (slope * q).abs();
        }
    }
    let mut pairs = values.as_ref().iter().zip(bounds.as_ref());
    pairs.all(|(value, bound)| value.abs() <= *bound)
}

/// No number is -0.
pub fn without_signs_of_zero<N: Numbers>(mut values: N) -> N {
    values.as_mut().iter_mut().for_each(|value| *value += 0.0);
    values
}
}

pub mod sine_and_cosine {
// Sine and cosine of one angle (rad), together: the same bits on every platform, within 1 ulp, for arguments of any size.
//
// The angle is reduced to |r + tail| <= pi/4 with `angle = n pi/2 + r + tail`: up to a million by subtracting n times
// pi/2 in pieces of 33 bits, whose products are exact (W. Cody and W. Waite, Software Manual for the Elementary
// Functions, 1980); above by as many bits of 2/pi as the angle asks for (M. Payne and R. Hanek, Radian Reduction for
// Trigonometric Functions, 1983). The coefficients of the two polynomials are those of Sun's fdlibm.

/// Sine and cosine of an angle in radians; not a number for an angle that is not finite.
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let (quarter, r, tail) = if angle.abs() < 1e6 { reduce_small(angle) } else { reduce_large(angle) };
    let (sin, cos) = (sin_near_zero(r, tail), cos_near_zero(r, tail));
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// `sin(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn sin_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let (cube, square) = (z * r, z * z);
    // in halves that do not wait for each other (G. Estrin, 1960)
    let lower = 8.333_333_333_322_49e-3 - z * 1.984_126_982_985_795e-4;
    let upper = (2.755_731_370_707_006_8e-6 - z * 2.505_076_025_340_686_3e-8) + square * 1.589_690_995_211_55e-10;
    let higher = lower + square * upper;
    r - ((z * (0.5 * tail - cube * higher) - tail) + cube * 1.666_666_666_666_663_2e-1)
}

/// `cos(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn cos_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let square = z * z;
    let lower = 4.166_666_666_666_66e-2 - z * 1.388_888_888_887_411e-3;
    let middle = 2.480_158_728_947_673e-5 - z * 2.755_731_435_139_066_3e-7;
    let upper = 2.087_572_321_298_175e-9 - z * 1.135_964_755_778_819_5e-11;
    let higher = z * (lower + square * (middle + square * upper));
    let half = 0.5 * z;
    let most = 1.0 - half;
    most + (((1.0 - most) - half) + (z * higher - r * tail))
}

/// `a + b` as its rounded value and what the rounding lost.
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// The nearest whole number of quarter turns, by its last bits, and what is left of an angle below a million.
#[inline]
pub(super) fn reduce_small(angle: f64) -> (u64, f64, f64) {
    // pi/2 in three pieces of 33 bits and a rest
    const PIECES: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_711_166_5e-21];
    const REST: f64 = 8.478_427_660_368_9e-32;
    // adding and taking away 1.5 * 2^52 rounds to a whole number, which the last bits of the sum are
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    let sum = angle * core::f64::consts::FRAC_2_PI + ROUNDING;
    let quarters = sum - ROUNDING;
    let first = angle - quarters * PIECES[0];
    let (second, lost_second) = two_sum(first, -(quarters * PIECES[1]));
    let (third, lost_third) = two_sum(second, -(quarters * PIECES[2]));
    let lost = (lost_second + lost_third) - quarters * REST;
    let r = third + lost;
    (sum.to_bits(), r, (third - r) + lost)
}

/// The bits of 2/pi after the binary point.
const TWO_OVER_PI: [u64; 20] = [
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
];

/// 64 bits of 2/pi from a bit on, the first bit after the point being bit 1.
fn bits_from(bit: i64) -> u64 {
    let word = |k: i64| usize::try_from(k).ok().and_then(|k| TWO_OVER_PI.get(k)).copied().unwrap_or(0);
    let (at, shift) = ((bit - 1).div_euclid(64), (bit - 1).rem_euclid(64));
    if shift == 0 { word(at) } else { (word(at) << shift) | (word(at + 1) >> (64 - shift)) }
}

/// The whole number of quarter turns modulo 4, and what is left of an angle of a million or more.
#[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap, clippy::cast_sign_loss)] // bits are cut on purpose
#[allow(clippy::cast_precision_loss)] // what is lost is taken up by the next part
fn reduce_large(angle: f64) -> (u64, f64, f64) {
    let bits = angle.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64 - 1075;
    let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    // bits of 2/pi before these make whole turns; of the product only what is below four quarters counts
    let start = exponent - 1;
    let [high, middle, low] = [bits_from(start), bits_from(start + 64), bits_from(start + 128)];
    let low = mantissa * u128::from(low);
    let middle = mantissa * u128::from(middle) + (low >> 64);
    let high = (mantissa * u128::from(high) + (middle >> 64)) as u64;
    // two bits of quarters, then the fraction of a quarter
    let mut quarter = (high >> 62) as i64;
    let fraction = (u128::from(high) << 66) | (u128::from(middle as u64) << 2) | u128::from((low as u64) >> 62);
    // to the nearest quarter: a fraction above a half counts back from the next one
    let back = fraction >> 127 == 1;
    let size = if back { fraction.wrapping_neg() } else { fraction };
    quarter += i64::from(back);
    // 53 bits from the first that is set, and the 53 after those
    let leading = size.leading_zeros();
    let digits = size.checked_shl(leading).unwrap_or(0);
    let power_of_two = |power: i64| f64::from_bits(((1023 + power) as u64) << 52);
    let upper = (digits >> 75) as f64 * power_of_two(-53 - i64::from(leading));
    let lower = ((digits >> 22) as u64 & ((1 << 53) - 1)) as f64 * power_of_two(-106 - i64::from(leading));
    let (r, tail) = times_half_pi(upper, lower);
    let sign = if back == (angle < 0.0) { 1.0 } else { -1.0 };
    ((if angle < 0.0 { -quarter } else { quarter }) as u64, sign * r, sign * tail)
}

/// `(a + b) pi/2` as a value and its tail.
fn times_half_pi(a: f64, b: f64) -> (f64, f64) {
    // 2^27 + 1 splits a number into two halves whose products are exact (T. Dekker, 1971)
    let split = |x: f64| {
        let shifted = x * 134_217_729.0;
        let high = shifted - (shifted - x);
        (high, x - high)
    };
    let (half_pi, rest) = (core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
    let product = a * half_pi;
    let ((a_high, a_low), (p_high, p_low)) = (split(a), split(half_pi));
    let lost = ((a_high * p_high - product) + a_high * p_low + a_low * p_high) + a_low * p_low;
    let tail = lost + (a * rest + b * half_pi);
    let r = product + tail;
    (r, (product - r) + tail)
}
}

pub mod select {
//! A choice.

/// The second if the first is not 0, else the third.
pub fn select(condition: f64, a: f64, b: f64) -> f64 {
    if condition == 0.0 { b } else { a }
}
}

pub mod either {
//! A choice of which both sides are numbers.

/// As `select`, but not a number if either is not.
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

pub mod sign {
//! The sign of a number.

/// -1, 0 or 1; 0 at 0.
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

/// Where to stop, and what counts as large.
pub mod limits {
/// Rounding may make so much of velocities and accelerations that are given out.
pub const ACCURACY: f64 = 1e-9;
/// How far the motion is looked ahead to tell on which side of an edge it goes on, as a part of the span.
pub const AHEAD: f64 = 1e-9;
/// Nothing may move farther than this meanwhile, scaled.
pub const FARTHEST_AHEAD: f64 = 1e-7;
/// The step before tells of one that is so many times as long at most.
pub const FARTHEST_BEND: f64 = 4.0;
/// How often both sides of a rim are looked at at least.
pub const FEWEST_LOOKS: usize = 3;
/// What grows by so much with each look has no bound.
pub const GROWTH: f64 = 1.03;
/// A correction of just half a cell of the grid, to rounding, stays in it.
pub const HALF_A_CELL: f64 = 0.500001;
/// Iterations of Newton at most.
pub const ITERATIONS: usize = 6;
/// Newton's first correction at most, beside the size of a body or 1 rad.
pub const LARGEST_CORRECTION: f64 = 0.05;
/// How far velocities may lead elsewhere than positions, likewise: more is another branch.
pub const LARGEST_GAP: f64 = 0.001;
/// The largest motion of a step, beside the size of a body or 1 rad.
pub const LARGEST_MOTION: f64 = 0.5;
/// How far before a rim its sides are looked at, as a part of the span.
pub const LEAD: f64 = 0.001;
/// And at most (s).
pub const LONGEST_AHEAD: f64 = 1e-9;
/// A rounding of the time, in units in its last place, that changes a gauge by more than itself shows that it is zero there.
pub const MOMENT: f64 = 1024.0;
/// How often the branches of formulas are chosen anew at one time.
pub const MOST_BRANCHES: usize = 8;
/// Halvings until two times are neighbours.
pub const MOST_HALVINGS: usize = 100;
/// How often both sides of a rim are looked at, each time at a quarter of the distance.
pub const MOST_LOOKS: usize = 6;
/// Trials on the way from the file's parameters to others at most.
pub const MOST_PARTS: usize = 10_000;
/// Steps that one call takes at most that has no bound of its own.
pub const MOST_STEPS: usize = 1_000_000;
/// A dead point is no further off than this part of the span.
pub const NEAR_FOLD: f64 = 1e-5;
/// A rim within this part of the span is one that was looked at.
pub const PASSED: f64 = 1e-9;
/// A position that changes by more than this at an edge jumps, scaled.
pub const POSITION_JUMP: f64 = 1e-9;
/// A speed below this part of one per span is rest, scaled.
pub const REST: f64 = 0.001;
/// A gauge is zero that is no more than so many units in the last place.
pub const ROUNDING: f64 = 64.0;
/// Where steps become too small, this is steep enough for a singular position to be the reason.
pub const SINGULAR: f64 = 100.0;
/// So many units in the last place of a time it may be off from what is meant to happen then.
pub const SLACK: f64 = 4.0;
/// A speed below this part of one per span is rest, beside a rim.
pub const SLOW: f64 = 0.001;
/// The smallest part of the way to other parameters.
pub const SMALLEST_PART: f64 = 1e-6;
/// A velocity that changes at a rim by more than this jumps, beside the fastest motion.
pub const SPEED_JUMP: f64 = 1e-6;
/// One over a pivot, scaled: beyond this the position is looked at more closely.
pub const STEEP: f64 = 1000.0;
/// One over a pivot, scaled: beyond this it is too near to a singular one.
pub const STEEPEST: f64 = 1000000.0;
/// A velocity that changes by more than this part of the fastest at an edge jumps.
pub const VELOCITY_JUMP: f64 = 1e-7;
}
}
