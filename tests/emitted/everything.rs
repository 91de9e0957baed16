//! Constraint system of mechanism `everything`, written by mechc 0.1.0 from `everything.mech`.
//!
//! - coordinates `q`: 21 (m, rad), equations `phi = 0`: 21
//! - `phi_q`: 56 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 4; those that follow from others are worked out
//! - needs the crate `libm`, for elementary functions with the same bits on every platform

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `a` (m)
    pub a: f64,
    /// `rate` (1/s)
    pub rate: f64,
    /// `n` (1)
    pub n: f64,
    /// `half` (1)
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

/// Number of coordinates, and of equations.
pub const N: usize = 21;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 56;

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `crank.x` (m)
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m)
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad)
    pub const CRANK_PHI: usize = 2;
    /// `plate.x` (m)
    pub const PLATE_X: usize = 3;
    /// `plate.y` (m)
    pub const PLATE_Y: usize = 4;
    /// `plate.phi` (rad)
    pub const PLATE_PHI: usize = 5;
    /// `rocker.x` (m)
    pub const ROCKER_X: usize = 6;
    /// `rocker.y` (m)
    pub const ROCKER_Y: usize = 7;
    /// `rocker.phi` (rad)
    pub const ROCKER_PHI: usize = 8;
    /// `sled.x` (m)
    pub const SLED_X: usize = 9;
    /// `sled.y` (m)
    pub const SLED_Y: usize = 10;
    /// `sled.phi` (rad)
    pub const SLED_PHI: usize = 11;
    /// `stone.x` (m)
    pub const STONE_X: usize = 12;
    /// `stone.y` (m)
    pub const STONE_Y: usize = 13;
    /// `stone.phi` (rad)
    pub const STONE_PHI: usize = 14;
    /// `free.x` (m)
    pub const FREE_X: usize = 15;
    /// `free.y` (m)
    pub const FREE_Y: usize = 16;
    /// `free.phi` (rad)
    pub const FREE_PHI: usize = 17;
    /// `gauge.x` (m)
    pub const GAUGE_X: usize = 18;
    /// `gauge.y` (m)
    pub const GAUGE_Y: usize = 19;
    /// `gauge.phi` (rad)
    pub const GAUGE_PHI: usize = 20;
}

/// Which equation each joint, constraint or driver wrote.
pub mod row {
    /// joint `main 1`
    pub const MAIN_1: usize = 0;
    /// joint `main 2`
    pub const MAIN_2: usize = 1;
    /// joint `seam 1`
    pub const SEAM_1: usize = 2;
    /// joint `seam 2`
    pub const SEAM_2: usize = 3;
    /// joint `seam 3`
    pub const SEAM_3: usize = 4;
    /// joint `pivot 1`
    pub const PIVOT_1: usize = 5;
    /// joint `pivot 2`
    pub const PIVOT_2: usize = 6;
    /// joint `strut`
    pub const STRUT: usize = 7;
    /// joint `guide 1`
    pub const GUIDE_1: usize = 8;
    /// joint `guide 2`
    pub const GUIDE_2: usize = 9;
    /// joint `block`
    pub const BLOCK: usize = 10;
    /// constraint `stone_turn`
    pub const STONE_TURN: usize = 11;
    /// constraint `stone_lift`
    pub const STONE_LIFT: usize = 12;
    /// constraint `follow`
    pub const FOLLOW: usize = 13;
    /// constraint `hold`
    pub const HOLD: usize = 14;
    /// constraint `turn`
    pub const TURN: usize = 15;
    /// constraint `sign_free`
    pub const SIGN_FREE: usize = 16;
    /// driver `motor`
    pub const MOTOR: usize = 17;
    /// driver `push`
    pub const PUSH: usize = 18;
    /// driver `lift`
    pub const LIFT: usize = 19;
    /// driver `swing`
    pub const SWING: usize = 20;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub const PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
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

/// The residual of the equations (m, m^2 or rad).
///
/// 259 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let a = p.a;
    let n = p.n;
    let half = p.half;
    let q0 = q[0];
    let q1 = q[1];
    let q2 = q[2];
    let plate_x = q[3];
    let plate_y = q[4];
    let plate_phi = q[5];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let rocker_phi = q[8];
    let q9 = q[9];
    let q10 = q[10];
    let q11 = q[11];
    let q12 = q[12];
    let q13 = q[13];
    let q14 = q[14];
    let free_x = q[15];
    let free_y = q[16];
    let free_phi = q[17];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let gauge_phi = q[20];
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
    let v123 = f64::floor(v122);
    let v124 = 10.0 * v123;
    let v125 = t - v124;
    let v126 = f64::sqrt(v80);
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
    let (s144, c144) = sin_cos(q11);
    let v145 = 0.6 * q9;
    let v146 = 0.8 * q10;
    let v147 = v145 + v146;
    let (s148, c148) = sin_cos(rocker_phi);
    let v149 = a * c148;
    let v150 = 2.0 * v149;
    let v151 = a * s148;
    let v152 = 2.0 * v151;
    let v153 = v150 + rocker_x;
    let v154 = v152 + rocker_y;
    let (s155, c155) = sin_cos(q2);
    let v156 = a * c155;
    let v157 = a * s155;
    let v158 = v156 + q0;
    let v159 = v157 + q1;
    let (s160, c160) = sin_cos(free_phi);
    let v161 = 0.1 * c160;
    let v162 = 0.1 * s160;
    let v163 = v161 + free_x;
    let v164 = v162 + free_y;
    let v165 = v158 - q9;
    let v166 = rocker_x - q0;
    let v167 = rocker_y - q1;
    let v168 = v166 * v166;
    let v169 = v167 * v167;
    let v170 = v168 + v169;
    let v171 = f64::sqrt(v170);
    let (s172, c172) = sin_cos(gauge_phi);
    let v173 = c172 + gauge_x;
    let v174 = s172 + gauge_y;
    let v175 = q2 + v2;
    let v176 = free_phi - q2;
    let v177 = -q0;
    let v178 = -q1;
    let v179 = plate_phi - q2;
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
    let v206 = 0.8 * q9;
    let v207 = 0.6 * q10;
    let v208 = v207 - v206;
    let v209 = 0.8 * v204;
    let v210 = 0.6 * v205;
    let v211 = v210 - v209;
    let v212 = q12 - rocker_x;
    let v213 = q13 - rocker_y;
    let v214 = s148 * v212;
    let v215 = c148 * v213;
    let v216 = v215 - v214;
    let v217 = v216 + -0.1;
    let v218 = rocker_phi / 2.0;
    let v219 = q14 - v218;
    let v220 = f64::from(v165 < 0.0);
    let v221 = -v165;
    let v222 = select(v220, v221, v165);
    let v223 = v222 / 10.0;
    let v224 = q13 + v223;
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
    let v235 = libm::tanh(q2);
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
    let v247 = q2 / 9.0;
    let v248 = libm::tan(v247);
    let v249 = libm::atan(q2);
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
    let mut out = [0.0; N];
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

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`].
///
/// 151 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let a = p.a;
    let half = p.half;
    let q0 = q[0];
    let q1 = q[1];
    let q2 = q[2];
    let plate_x = q[3];
    let plate_y = q[4];
    let plate_phi = q[5];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let rocker_phi = q[8];
    let q9 = q[9];
    let q11 = q[11];
    let q12 = q[12];
    let q13 = q[13];
    let free_phi = q[17];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let gauge_phi = q[20];
    let v1 = a * half;
    let (_, c2) = sin_cos(q11);
    let (s3, c3) = sin_cos(rocker_phi);
    let v4 = a * c3;
    let v5 = 2.0 * v4;
    let v6 = a * s3;
    let v7 = 2.0 * v6;
    let v8 = v5 + rocker_x;
    let v9 = v7 + rocker_y;
    let (s10, c10) = sin_cos(q2);
    let v11 = a * c10;
    let v12 = a * s10;
    let v13 = v11 + q0;
    let v14 = v12 + q1;
    let (s15, c15) = sin_cos(free_phi);
    let v16 = 0.1 * c15;
    let v17 = v13 - q9;
    let v18 = rocker_x - q0;
    let v19 = rocker_y - q1;
    let v20 = v18 * v18;
    let v21 = v19 * v19;
    let v22 = v20 + v21;
    let v23 = f64::sqrt(v22);
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
    let v38 = q13 - rocker_y;
    let v39 = f64::from(v17 < 0.0);
    let v40 = f64::from(a < v23);
    let v41 = f64::from(v14 < v13);
    let v42 = either(v41, v13, v14);
    let v43 = f64::from(0.2 < v42);
    let v44 = libm::hypot(v25, v26);
    let v45 = libm::tanh(q2);
    let v46 = c10 / 3.0;
    let v47 = s10 / 2.0;
    let v48 = q2 / 9.0;
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
    let v74 = rocker_x - q12;
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
    let v124 = f64::sqrt(v123);
    let v125 = -1.0 / v124;
    let v126 = v125 / 2.0;
    let v127 = v46 * v46;
    let v128 = 1.0 - v127;
    let v129 = f64::sqrt(v128);
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
    let v145 = q2 * q2;
    let v146 = 1.0 + v145;
    let v147 = v144 / v146;
    let v148 = v49 * v49;
    let v149 = 1.0 + v148;
    let v150 = v149 / 9.0;
    let v151 = v147 - v150;
    let mut out = [0.0; ENTRIES];
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

/// The partial derivative of `phi` by time.
///
/// 172 operations.
pub fn phi_t(_q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let n = p.n;
    let half = p.half;
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
    let v60 = f64::sqrt(v41);
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
    let mut out = [0.0; N];
    out[17] = -v70;
    out[18] = -v95;
    out[19] = -v125;
    out[20] = -v172;
    out
}

/// Right side of the velocity equation `phi_q qd = nu`.
///
/// 172 operations.
pub fn nu(_q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let n = p.n;
    let half = p.half;
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
    let v60 = f64::sqrt(v41);
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
    let mut out = [0.0; N];
    out[17] = v70;
    out[18] = v95;
    out[19] = v125;
    out[20] = v172;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma`.
///
/// 477 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let a = p.a;
    let n = p.n;
    let half = p.half;
    let q0 = q[0];
    let q1 = q[1];
    let q2 = q[2];
    let plate_x = q[3];
    let plate_y = q[4];
    let plate_phi = q[5];
    let rocker_x = q[6];
    let rocker_y = q[7];
    let rocker_phi = q[8];
    let q9 = q[9];
    let q11 = q[11];
    let q12 = q[12];
    let q13 = q[13];
    let free_phi = q[17];
    let gauge_x = q[18];
    let gauge_y = q[19];
    let gauge_phi = q[20];
    let qd0 = qd[0];
    let qd1 = qd[1];
    let qd2 = qd[2];
    let plate_x_d = qd[3];
    let plate_y_d = qd[4];
    let plate_phi_d = qd[5];
    let rocker_x_d = qd[6];
    let rocker_y_d = qd[7];
    let rocker_phi_d = qd[8];
    let qd11 = qd[11];
    let qd12 = qd[12];
    let qd13 = qd[13];
    let free_phi_d = qd[17];
    let gauge_x_d = qd[18];
    let gauge_y_d = qd[19];
    let gauge_phi_d = qd[20];
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
    let v59 = f64::sqrt(v41);
    let v60 = 2.0 + t;
    let v61 = libm::log10(v60);
    let v62 = libm::log(v41);
    let v63 = -t;
    let v64 = libm::exp(v63);
    let (s65, c65) = sin_cos(q11);
    let (s66, c66) = sin_cos(rocker_phi);
    let v67 = a * c66;
    let v68 = 2.0 * v67;
    let v69 = a * s66;
    let v70 = 2.0 * v69;
    let v71 = v68 + rocker_x;
    let v72 = v70 + rocker_y;
    let (s73, c73) = sin_cos(q2);
    let v74 = a * c73;
    let v75 = a * s73;
    let v76 = v74 + q0;
    let v77 = v75 + q1;
    let (s78, c78) = sin_cos(free_phi);
    let v79 = v76 - q9;
    let v80 = rocker_x - q0;
    let v81 = rocker_y - q1;
    let v82 = v80 * v80;
    let v83 = v81 * v81;
    let v84 = v82 + v83;
    let v85 = f64::sqrt(v84);
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
    let v100 = q12 - rocker_x;
    let v101 = q13 - rocker_y;
    let v102 = f64::from(v79 < 0.0);
    let v103 = f64::from(a < v85);
    let v104 = f64::from(v77 < v76);
    let v105 = either(v104, v76, v77);
    let v106 = f64::from(0.2 < v105);
    let v107 = libm::hypot(v87, v88);
    let v108 = libm::tanh(q2);
    let v109 = c73 / 3.0;
    let v110 = s73 / 2.0;
    let v111 = q2 / 9.0;
    let v112 = libm::tan(v111);
    let v113 = sign(v87);
    let v114 = 2.0 * v85;
    let v115 = v108 * v108;
    let v116 = 1.0 - v115;
    let v117 = v87 / v107;
    let v118 = v88 / v107;
    let v119 = v110 * v110;
    let v120 = 1.0 - v119;
    let v121 = f64::sqrt(v120);
    let v122 = v109 * v109;
    let v123 = 1.0 - v122;
    let v124 = f64::sqrt(v123);
    let v125 = v88 * v88;
    let v126 = v87 * v87;
    let v127 = v125 + v126;
    let v128 = v87 / v127;
    let v129 = v88 / v127;
    let v130 = q2 * q2;
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
    let v172 = c73 * qd2;
    let v173 = s73 * qd2;
    let v174 = qd2 * v173;
    let v175 = qd2 * v172;
    let v176 = c66 * rocker_phi_d;
    let v177 = rocker_phi_d * v176;
    let v178 = rocker_phi_d * v168;
    let v179 = s78 * free_phi_d;
    let v180 = c78 * free_phi_d;
    let v181 = free_phi_d * v180;
    let v182 = free_phi_d * v179;
    let v183 = s65 * qd11;
    let v184 = c65 * qd11;
    let v185 = a * v176;
    let v186 = 2.0 * v185;
    let v187 = v186 + rocker_y_d;
    let v188 = rocker_x_d - qd0;
    let v189 = rocker_y_d - qd1;
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
    let v212 = qd12 - rocker_x_d;
    let v213 = qd13 - rocker_y_d;
    let v214 = v117 * v198;
    let v215 = v118 * v199;
    let v216 = v214 + v215;
    let v217 = qd2 * v116;
    let v218 = v173 / 3.0;
    let v219 = v218 / v124;
    let v220 = v172 / 2.0;
    let v221 = v220 / v121;
    let v222 = qd2 / 9.0;
    let v223 = v133 * v222;
    let v224 = qd2 / v131;
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
    let v261 = q2 * qd2;
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
    let v369 = qd11 * v184;
    let v370 = qd11 * v183;
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
    let v439 = qd2 * v231;
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
    let mut out = [0.0; N];
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

/// The Jacobian as a full matrix, row by row.
pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {
    let mut full = [[0.0; N]; N];
    for ((row, column), value) in PHI_Q_PATTERN.into_iter().zip(phi_q(q, t, p)) {
        full[row][column] = value;
    }
    full
}

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

use sine_and_cosine::sin_cos;

#[rustfmt::skip]
mod sine_and_cosine {

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
    let cube = z * r;
    let higher = 8.333_333_333_322_49e-3
        + z * (-1.984_126_982_985_795e-4
            + z * (2.755_731_370_707_006_8e-6 + z * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10)));
    r - ((z * (0.5 * tail - cube * higher) - tail) + cube * 1.666_666_666_666_663_2e-1)
}

/// `cos(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn cos_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let higher = z
        * (4.166_666_666_666_66e-2
            + z * (-1.388_888_888_887_411e-3
                + z * (2.480_158_728_947_673e-5
                    + z * (-2.755_731_435_139_066_3e-7
                        + z * (2.087_572_321_298_175e-9 - z * 1.135_964_755_778_819_5e-11)))));
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
