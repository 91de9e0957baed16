//! Results of the whole motion.

/// Ranges of formulas (`crates/ir/src/program/range_bounds.rs`).
pub mod range_bounds {
    /// Largest change of the argument of a resolved function (rad or a pure number): its series converges with the first few terms.
    pub const WIDEST: f64 = 1.0;
    /// Largest change of a resolved bounded function.
    pub const WIDEST_VALUE: f64 = 0.5;
    /// Largest factor of change of a divisor or radicand.
    pub const WIDEST_RATIO: f64 = 2.0;
    /// Largest factor of change of a resolved power.
    pub const WIDEST_POWER: f64 = 256.0;
    /// An exponential or a high power that is at most this is resolved, whatever its argument does.
    pub const VANISHES: f64 = 1e-40;
    /// Lowest high power.
    pub const HIGH_POWER: u32 = 8;
}

/// Interval evaluation of formulas (`crates/ir/src/program/interval_eval.rs`).
pub mod interval_eval {
    /// Maximum number of table pieces that a range covers; beyond it nothing is known of the columns.
    pub const MOST_PIECES: f64 = 64.0;
}

/// States within a step (`crates/engine/src/analysis/results/state_sampler.rs`).
pub mod places {
    /// Maximum number of corrections of a position, where the solver cannot be used.
    pub const ITERATIONS: usize = 10;
    /// Fraction of a step at which its dense output is verified; no symmetry of the motion maps it to the middle. The output is rejected if
    /// a moving quantity deviates by more than `LITTLE` of itself, and by more than a parabola could.
    pub const WITHIN: f64 = 0.381_966;
    /// Largest deviation of a state from the dense output of its step, as a part of its size.
    pub const LITTLE: f64 = 1e-9;
    /// Parts of a step shorter than this part of it are not divided.
    pub const SHORTEST: f64 = 1e-2;
    /// A position closer to a singular one than this is taken from the bridge across it.
    pub const SOLVABLE: f64 = 4e-3;
}

/// Cells (`crates/engine/src/analysis/results/interval_search.rs`).
pub mod probe {
    /// Maximum number of cells that are divided for one formula; a cell whose middle has to be solved for counts as several.
    pub const MOST_CELLS: usize = 400_000;
    /// Additional cells for each step of the motion.
    pub const MOST_OF_A_STEP: usize = 4_000;
    /// Number of cells that a cell counts as if its middle has to be solved for.
    pub const SOLVED: usize = 20;
    /// Shortest cell, as a part of the span.
    pub const SHORTEST: f64 = 4.0 * f64::EPSILON;
    /// Longest short cell, as a part of the span.
    pub const SHORT: f64 = 1e-3;
    /// A guard within rounding matters if the values on both sides of it differ by more than this part of the range.
    pub const DIFFERENT: f64 = 1e-6;
    /// Longest interval without solution, or with values hidden by rounding, as a part of the span.
    pub const OPAQUE: f64 = 1e-6;
    /// Ratio of successive distances from a time at which the growth of a formula is examined; the first distance is where the values are
    /// accurate to `RELIABLE` of themselves or of the range.
    pub const FACTOR: f64 = 16.0;
    /// A value is reliable if rounding changes it by at most this part of itself or of the range.
    pub const RELIABLE: f64 = 1e-3;
    /// Largest of these distances, as a part of the span.
    pub const FARTHEST: f64 = 1e-5;
    /// Values that differ by at most this part of the range are equal.
    pub const ALIKE: f64 = 1e-9;
    /// Rounding of a value, as a part of it.
    pub const ROUNDING: f64 = 32.0 * f64::EPSILON;
    /// Smaller values are zero: rounding of the root of the smallest square is as large.
    pub const NOTHING: f64 = 1e-150;
}

/// Guards (`crates/engine/src/analysis/results/guards.rs`).
pub mod guards {
    /// An argument may be on either side of its threshold within this many times its rounding.
    pub const NOISE: f64 = 8.0;
    /// An argument crosses its threshold continuously, rather than jumps, if it comes closer to it than this part of its usual size.
    pub const NEAR: f64 = 1e-6;
}

/// Extrema (`crates/engine/src/analysis/results/extremum.rs`).
pub mod extremum {
    /// A cell that can improve the extremum by at most this part of the range is not divided.
    pub const GAP: f64 = 1e-11;
    /// Bound like `GAP` for formulas without derivative.
    pub const GAP_OF_VALUES: f64 = 1e-9;
    /// Accuracy of a time, as a part of the span.
    pub const CERTAIN: f64 = 1e-13;
    /// The vertex of a parabola through three points is accepted up to this many point distances from the middle point.
    pub const FARTHEST: f64 = 2.0;
    /// Factor by which the three points approach each other in each step.
    pub const CLOSER: f64 = 0.1;
    /// Smallest distance of the three points, as a part of the span.
    pub const FINEST: f64 = 1e-4;
    /// Maximum number of corrections of a time.
    pub const ITERATIONS: usize = 100;
    /// Largest error of the time of an extremum, as a part of the span, for a formula with a known slope.
    pub const TIMES: f64 = 1e-11;
    /// Bound like `TIMES` for a formula whose slope is unknown.
    pub const TIMES_OF_VALUES: f64 = 1e-6;
    /// A value at a threshold differs from the limit of one side if the difference exceeds this part of the range.
    pub const APART: f64 = 1e-6;
    /// A formula is unbounded if its gain between successive positions, whose distances shrink by equal factors, does not shrink by this
    /// factor; it converges if its distance from the limit does.
    pub const CONVERGES: f64 = 0.97;
    /// An edge this close behind an extremum with the same value, as a part of the span, is the extremum.
    pub const BESIDE: f64 = 1e-7;
}

/// Refinement of extrema (`crates/engine/src/analysis/results/extremum_refinement.rs`).
pub mod turns {
    /// Width of a cell of the time grid, as a part of the span, rounded down to a power of two.
    pub const CELL: f64 = 1.0 / 16_777_216.0;
    /// Times farther from 0 than this many cells have no grid.
    pub const MOST_CELLS: f64 = 1_125_899_906_842_624.0;
    /// A correction within this distance of half a cell, in cells, leads to a border of two cells: the rounding of corrections is smaller.
    pub const BORDER: f64 = 1.0 / 4_096.0;
    /// Maximum number of corrections, two of which may be at a border.
    pub const ITERATIONS: u32 = 8;
    /// Largest distance of the refined extremum from the start, in cells.
    pub const FARTHEST: f64 = 4_096.0;
    /// Distance on both sides at which slopes are taken for an unknown second derivative, in cells.
    pub const APART: f64 = 64.0;
}

/// Products that are treated like coordinates (`crates/engine/src/analysis/results/smooth_parts.rs`).
pub mod smooth {
    /// Maximum number of factors.
    pub const MOST_FACTORS: u32 = 6;
    /// Largest rotation of a body in a cell (rad) for which the sine of the angle is bounded.
    pub const WIDEST_TURN: f64 = 0.25;
    /// Largest rotation of any body in a cell (rad) for which positions within are bounded.
    pub const WIDEST_OF_ALL: f64 = 0.5;
}

/// Processing of the motion in chunks of steps (`crates/engine/src/analysis/results`).
pub mod stretches {
    /// Number of steps in a chunk.
    pub const CHUNK: usize = 4096;
    /// Maximum number of coordinates of all steps in a chunk.
    pub const NUMBERS: usize = 4_000_000;
    /// Number of certain digits below which the accuracy is reported.
    pub const FEW: u32 = 6;
    /// A value without certain digits is 0 if its error is at most this part of the largest value so far.
    pub const SMALL: f64 = 1e-6;
    /// Number of significant digits of a double.
    pub const MOST_DIGITS: u32 = 17;
    /// Larger values overflow.
    pub const LARGEST: f64 = 1e300;
}

/// Integrals (`crates/engine/src/analysis/results/quadrature.rs`).
pub mod quadrature {
    /// Largest error of an integral, as a part of range times time.
    pub const ACCURACY: f64 = 1e-11;
    /// Safety factor of the error of a cell, relative to the improvement by halving it.
    pub const SAFETY: f64 = 8.0;
    /// The error of the finer of two rules is smaller than that of the coarser by the square root of this many times their difference,
    /// relative to the variation in the cell.
    pub const SURER: f64 = 1e4;
    /// The total error is computed each time this many cells have been divided.
    pub const LOOKS: usize = 16;
    /// An integral diverges if the shortest cells hold this part of it, and the formula grows fast enough towards them.
    pub const DIVERGES: f64 = 1e-9;
    /// Distances from a shortest cell at which the growth of a formula is examined, in lengths of the cell.
    pub const FARTHER: [f64; 2] = [64.0, 256.0];
    /// An integral diverges if the formula grows like a power of the distance from a pole with at least this exponent.
    pub const STEEPEST: f64 = 0.95;
    /// Largest distance from a pole, as a part of the span, at which a formula is a single power of the distance: halving the distance
    /// changes the growth factor, which is at least `LEAST_GROWTH`, by at most `ALIKE`. At smaller distances the rounding of times shows.
    pub const POLE_DISTANCE: f64 = 1e-8;
    /// Two growth factors that differ by at most this belong to one power.
    pub const ALIKE: f64 = 1e-5;
    /// Smallest growth factor at a pole when the distance is halved.
    pub const LEAST_GROWTH: f64 = 1.03;
    /// Uncertainty of an integral near a pole, as a part of what the shortest cell may hold.
    pub const PART_OF_POLE: f64 = 0.02;
    /// Smaller values are zero.
    pub const NOTHING: f64 = 1e-290;
    /// Rounding of a value, as a part of it.
    pub const ROUNDING: f64 = 4.0 * f64::EPSILON;
}

/// Integrals of formulas that are smooth over the whole analysis (`crates/engine/src/analysis/results/spectral.rs`).
pub mod spectral {
    /// Smallest number of intervals of the rule, as a power of two.
    pub const FIRST: usize = 6;
    /// Largest number of intervals of the rule, as a power of two.
    pub const LAST: usize = 12;
    /// The rule converges if doubling the intervals changes it by at most this part of the previous change.
    pub const LESS: f64 = 0.1;
    /// Largest difference from the integral of the dense output, as a part of it: beyond it something narrow has been missed.
    pub const ALIKE: f64 = 1e-2;
}

/// Loads between two states (`crates/engine/src/analysis/results/loads.rs`).
pub mod loads {
    /// A smooth load may exceed its predicted range between two states by this part of the largest value so far.
    pub const SEEN: f64 = 0.25;
    /// Margin for a load of which only its bounds are known, as a part of the largest value so far.
    pub const LITTLE: f64 = 1e-12;
    /// Rounding of a load between states, in multiples of its rounding at states.
    pub const ROUNDINGS: f64 = 4.0;
    /// Largest amplification of the uncertainty of a load by a formula.
    pub const MAX_AMPLIFICATION: f64 = 1e200;
}

/// Second derivatives between states, and rounding of values (`crates/engine/src/analysis/results/curve.rs`).
pub mod curve {
    /// Factor by which a second or third derivative may deviate from a straight line between two states, relative to the deviation that
    /// follows from the lower derivative at both; a parabola has 1.5.
    pub const SAFETY: f64 = 2.0;
    /// Factor of the deviation in a part of a cell, which falls with the square of the part.
    pub const LESS: f64 = 2.0;
    /// Relative perturbation of moving quantities that shows how a formula amplifies their rounding.
    pub const MOVED: f64 = 1.0 / 1_048_576.0;
    /// The rounding of loads is computed once per this many evaluations of a formula.
    pub const EVERY: usize = 16;
    /// A value between two adjacent points is resolved if its interval is at most this part of it, or at most `NOTHING`.
    pub const KNOWN: f64 = 1e-12;
    /// Smaller numbers count as zero.
    pub const NOTHING: f64 = 1e-290;
    /// Rounding of a moving quantity, as a part of the largest value so far.
    pub const ROUNDING: f64 = 8.0 * f64::EPSILON;
    /// Error of velocities and accelerations on a bridge across a singular position, as a part of the largest values so far.
    pub const ON_BRIDGE: f64 = 1e-8;
}

/// Derivatives of results (`crates/lang/src/lower/slopes.rs`).
pub mod slopes {
    /// A formula has the value of an extremum at its time if it differs by at most this part of its range.
    pub const SAME: f64 = 1e-6;
    /// Bound like `SAME` for a formula at rest, as a part of its size.
    pub const DIGITS: f64 = 1e-9;
    /// An extremum is flat if its rate would change it over the analysis by at most this part of its range.
    pub const FLAT: f64 = 1e-3;
    /// Distance from its extremum at which a formula without rate is examined, as a part of the analysis.
    pub const BESIDE: f64 = 3e-4;
    /// An extremum is isolated if a move by this part of its range changes it alike on both sides.
    pub const MOVED: f64 = 1e-6;
    /// Largest difference between both sides of an isolated extremum, as a part of the change.
    pub const ALONE: f64 = 0.01;
    /// Range of a formula, in standard deviations.
    pub const DEVIATIONS: f64 = 4.0;
    /// A formula of results is smooth if halving the step reduces its deviation from a straight line to at most this part: a quarter for a
    /// smooth one, half at a kink.
    pub const LEFT_OF_HALF: f64 = 0.35;
    /// Smallest change of a parameter, as the change of the formula that this part of the parameter's size causes.
    pub const LEAST_STEP: f64 = 1e-9;
    /// Changes below this part of a value are rounding.
    pub const LAST_DIGITS: f64 = 1e-13;
    /// A parameter does not affect a formula if doubling it would change the formula by at most this part of its range.
    pub const NOTHING: f64 = 1e-12;
}
