//! Results of the whole motion.

/// Ranges of formulas (`crates/ir/src/program/range_bounds.rs`).
pub mod ranges {
    /// The argument of a function that is resolved changes by no more than this: its series goes on with the first few terms (rad, or
    /// none).
    pub const WIDEST: f64 = 1.0;
    /// A bounded function that is resolved changes by no more than this.
    pub const WIDEST_VALUE: f64 = 0.5;
    /// What is divided by, or has a root taken of it, changes by no more than this factor.
    pub const WIDEST_RATIO: f64 = 2.0;
    /// A power that is resolved changes by no more than this factor.
    pub const WIDEST_POWER: f64 = 256.0;
    /// An exponential or a high power no larger than this is resolved, whatever its argument does.
    pub const VANISHES: f64 = 1e-40;
    /// From this one on, a power is high.
    pub const HIGH_POWER: u32 = 8;
}

/// Formulas in intervals (`crates/ir/src/program/interval_eval.rs`).
pub mod enclose {
    /// Over more pieces of a table than this nothing is said of its columns.
    pub const MOST_PIECES: f64 = 64.0;
}

/// States within a stretch (`crates/engine/src/analysis/results/places.rs`).
pub mod places {
    /// Corrections of a position at most, where the solver does not serve.
    pub const ITERATIONS: usize = 10;
    /// Whether the motion in a step is what its ends tell is seen at this part of it, at which nothing is that comes back in the middle; where what
    /// moves is farther off than `LITTLE` of itself, and than a parabola could be, it is not.
    pub const WITHIN: f64 = 0.381_966;
    /// A state differs from what its step's ends tell beyond this part of its size.
    pub const LITTLE: f64 = 1e-9;
    /// Parts of a step shorter than this part of it are not cut again.
    pub const SHORTEST: f64 = 1e-2;
    /// A position nearer than this to a singular one is taken from the way over it.
    pub const SOLVABLE: f64 = 4e-3;
}

/// Cells (`crates/engine/src/analysis/results/probe.rs`).
pub mod probe {
    /// Looking at one formula, so many cells are cut at most: what needs more is not meant. One whose middle has to be solved for counts as
    /// so many.
    pub const MOST_CELLS: usize = 400_000;
    /// And so many more for each step of the motion.
    pub const MOST_OF_A_STEP: usize = 4_000;
    /// A cell whose middle has to be solved for counts as so many cells.
    pub const SOLVED: usize = 20;
    /// No cell is shorter than this part of the span.
    pub const SHORTEST: f64 = 4.0 * f64::EPSILON;
    /// A cell is short that is no longer than this part of the span.
    pub const SHORT: f64 = 1e-3;
    /// A guard that rounding decides makes a difference where values on both sides of it differ by more than this part of the range.
    pub const DIFFERENT: f64 = 1e-6;
    /// A stretch in which nothing can be solved for, or in which rounding hides the values of a formula, may be so long, as a part of the span.
    pub const OPAQUE: f64 = 1e-6;
    /// Whether a formula grows towards a time is seen at places that are so many times as far away as the one before, from where its values are off by
    /// no more than that part of themselves or of the range.
    pub const FACTOR: f64 = 16.0;
    /// A value is reliable if rounding changes it by at most this part of itself or of the range.
    pub const RELIABLE: f64 = 1e-3;
    /// The first of these is no farther away than this part of the span.
    pub const FARTHEST: f64 = 1e-5;
    /// Values that differ by no more than this part of the range are the same.
    pub const ALIKE: f64 = 1e-9;
    /// What rounding makes of a value.
    pub const ROUNDING: f64 = 32.0 * f64::EPSILON;
    /// What is as little as this is nothing: rounding makes as much of the root of the least square.
    pub const NOTHING: f64 = 1e-150;
}

/// Guards (`crates/engine/src/analysis/results/guards.rs`).
pub mod guards {
    /// So many times as far from its threshold as rounding of what moves tells, an argument may be on either side.
    pub const NOISE: f64 = 8.0;
    /// An argument goes through its threshold, rather than jump over it, where it is no farther from there than this part of what it usually is.
    pub const NEAR: f64 = 1e-6;
}

/// Extrema (`crates/engine/src/analysis/results/extremum.rs`).
pub mod extremum {
    /// A cell that can gain no more than this part of the range is not cut.
    pub const GAP: f64 = 1e-11;
    /// The same, where the formula has no derivative.
    pub const GAP_OF_VALUES: f64 = 1e-9;
    /// A time is certain to this part of the span.
    pub const CERTAIN: f64 = 1e-13;
    /// The top of a parabola is that of the formula, where it lies no farther from the middle of its three points than so many times what
    /// these are apart.
    pub const FARTHEST: f64 = 2.0;
    /// Its three points come closer by this factor, until they are this part of the span apart.
    pub const CLOSER: f64 = 0.1;
    /// The three points of a parabola come no closer together than this part of the span.
    pub const FINEST: f64 = 1e-4;
    /// Corrections of a time at most.
    pub const ITERATIONS: usize = 100;
    /// How far off the time of an extremum may be, as a part of the span: of a formula whose slope is known, and of any other one.
    pub const TIMES: f64 = 1e-11;
    /// The same bound for a formula whose slope is unknown.
    pub const TIMES_OF_VALUES: f64 = 1e-6;
    /// A value at a threshold is that of one side where it differs from that of this side by no more than this part of the range.
    pub const APART: f64 = 1e-6;
    /// A formula grows without bound where what it gains from one place to the next, which come nearer by equal factors, does not become less than by
    /// this factor; and it goes to a value where it comes nearer to that by this factor.
    pub const CONVERGES: f64 = 0.97;
    /// An edge so little behind an extremum, as a part of the span, is the extremum, where the value is the same.
    pub const BESIDE: f64 = 1e-7;
}

/// Turns that are settled (`crates/engine/src/analysis/results/turn.rs`).
pub mod turns {
    /// The width of a cell of times, as a part of the span or of the power of two below it.
    pub const CELL: f64 = 1.0 / 16_777_216.0;
    /// Times that are farther from 0 than so many cells have no grid.
    pub const MOST_CELLS: f64 = 1_125_899_906_842_624.0;
    /// A correction that is no farther from half a cell than this, in cells, leads to the border of two: rounding makes less of corrections.
    pub const BORDER: f64 = 1.0 / 4_096.0;
    /// Corrections at most, two of which may be at a border.
    pub const ITERATIONS: u32 = 8;
    /// How many cells from where it begins a turn may settle.
    pub const FARTHEST: f64 = 4_096.0;
    /// How many cells to both sides slopes tell the second derivative of a formula of which it is not known.
    pub const APART: f64 = 64.0;
}

/// What is looked at as a coordinate is (`crates/engine/src/analysis/results/smooth.rs`).
pub mod smooth {
    /// Of no more factors than this.
    pub const MOST_FACTORS: u32 = 6;
    /// A cell in which a body turns farther than this (rad) says nothing of the sine of the turn.
    pub const WIDEST_TURN: f64 = 0.25;
    /// A cell in which any body turns farther than this (rad) says nothing of where places are within.
    pub const WIDEST_OF_ALL: f64 = 0.5;
}

/// Stretches (`crates/engine/src/analysis/results`).
pub mod stretches {
    /// So many stretches are looked at together.
    pub const CHUNK: usize = 4096;
    /// But no more of them than have so many coordinates.
    pub const NUMBERS: usize = 4_000_000;
    /// Fewer certain digits than this are told of; more than the other there are not.
    pub const FEW: u32 = 6;
    /// A value of which nothing is certain is 0, where it may be off by no more than this part of the largest that was seen.
    pub const SMALL: f64 = 1e-6;
    /// A double has no more significant digits than this.
    pub const MOST_DIGITS: u32 = 17;
    /// What is larger goes on to where there are no numbers.
    pub const LARGEST: f64 = 1e300;
}

/// Integrals (`crates/engine/src/analysis/results/quadrature.rs`).
pub mod quadrature {
    /// An integral may be off by this part of range times time.
    pub const ACCURACY: f64 = 1e-11;
    /// The integral over a cell may be so many times farther off than what its halves make better.
    pub const SAFETY: f64 = 8.0;
    /// The finer one of two rules is better than the other by the root of so many times what these differ, as a part of how far values in a cell differ.
    pub const SURER: f64 = 1e4;
    /// How far off all cells are together is looked at whenever one of so many has been cut.
    pub const LOOKS: usize = 16;
    /// An integral of which shortest cells hold such a part has no end, if the formula grows fast enough into these.
    pub const DIVERGES: f64 = 1e-9;
    /// How a formula grows towards a shortest cell is looked at so many of its lengths away.
    pub const FARTHER: [f64; 2] = [64.0, 256.0];
    /// An integral has no end where the formula goes with a power of the distance from a pole that is no lower than this.
    pub const STEEPEST: f64 = 0.95;
    /// So near to a pole, as a part of the span, a formula goes with one power of the distance: halving that changes the factor by no more than
    /// `ALIKE`, which is no less than `LEAST_GROWTH`. Nearer by, rounding of times shows.
    pub const BESIDE_POLE: f64 = 1e-8;
    /// Two factors of growth differ by at most this if one power of the distance makes both.
    pub const ALIKE: f64 = 1e-5;
    /// The factor by which a formula grows at a pole when the distance is halved, at least.
    pub const LEAST_GROWTH: f64 = 1.03;
    /// What is unknown of an integral beside a pole, as a part of what the shortest cell may hold.
    pub const PART_OF_POLE: f64 = 0.02;
    /// As little as that is nothing.
    pub const NOTHING: f64 = 1e-290;
    /// What rounding makes of a value.
    pub const ROUNDING: f64 = 4.0 * f64::EPSILON;
}

/// Integrals of what is smooth all over the analysis (`crates/engine/src/analysis/results/spectral.rs`).
pub mod spectral {
    /// With how many intervals between the times, as a power of two, the rule begins and ends.
    pub const FIRST: usize = 6;
    /// The largest power of two of intervals between the times.
    pub const LAST: usize = 12;
    /// The rule converges where twice as many times change it by no more than this part of the change before.
    pub const LESS: f64 = 0.1;
    /// What the steps of the motion tell of an integral differs from it by no more than this part: else something narrow has been missed.
    pub const ALIKE: f64 = 1e-2;
}

/// Loads between two states (`crates/engine/src/analysis/results/loads.rs`).
pub mod loads {
    /// A load that is smooth between two states may go beyond what is told of it by this part of the largest that was seen of it.
    pub const SEEN: f64 = 0.25;
    /// The same of one of which nothing is known but what it can be.
    pub const LITTLE: f64 = 1e-12;
    /// What rounding may make of a load, beside what it makes of it at states.
    pub const ROUNDINGS: f64 = 4.0;
    /// A formula may be as large as this times what a load may do beyond what is told of it.
    pub const UNTOLD: f64 = 1e200;
}

/// Bends, and how large a value's rounding is (`crates/engine/src/analysis/results/curve.rs`).
pub mod curve {
    /// How many times farther from a straight line a second or third derivative may go between two states than the first or second one at both
    /// of them tells that it does on average: a parabola goes 1.5 times as far.
    pub const SAFETY: f64 = 2.0;
    /// In a part of a cell they go no farther than in the whole, times this and the square of how long the part is against the whole.
    pub const LESS: f64 = 2.0;
    /// What moves is moved by this part of itself to see how much a formula makes of its rounding.
    pub const MOVED: f64 = 1.0 / 1_048_576.0;
    /// What rounding makes of loads is looked at whenever a formula has been computed so often.
    pub const EVERY: usize = 16;
    /// A value between two points beside each other is known where what it may be is no wider than this part of it, or than nothing.
    pub const KNOWN: f64 = 1e-12;
    /// A number smaller than this counts as zero.
    pub const NOTHING: f64 = 1e-290;
    /// What rounding may make of what moves, as a part of the largest that was seen of it.
    pub const ROUNDING: f64 = 8.0 * f64::EPSILON;
    /// Velocities and accelerations on the way over a singular position may be so far off, likewise.
    pub const ON_BRIDGE: f64 = 1e-8;
}

/// Derivatives of results (`crates/lang/src/lower/slopes.rs`).
pub mod slopes {
    /// A formula has the value of an extremum at its time, if it is away from it by no more than this part of its range; or by this part
    /// of its size, where it rests.
    pub const SAME: f64 = 1e-6;
    /// The same bound, as a part of the size of a formula that rests.
    pub const DIGITS: f64 = 1e-9;
    /// An extremum is flat, if its rate would change it over the analysis by no more than this part of its range.
    pub const FLAT: f64 = 1e-3;
    /// What has no rate is looked at so far beside its extremum, as a part of the analysis.
    pub const BESIDE: f64 = 3e-4;
    /// An extremum is alone, if it goes with what moves the formula by the first part of its range as much to one side as to the other, but for
    /// the second part of that; or for the last digits of its value.
    pub const MOVED: f64 = 1e-6;
    /// An extremum is alone if both sides of it change alike, up to this part of the change.
    pub const ALONE: f64 = 0.01;
    /// A formula has a range of no more than so many standard deviations.
    pub const DEVIATIONS: f64 = 4.0;
    /// Half a step leaves no more than this part of what a whole one ends off the straight line, where a formula of results is smooth: a quarter,
    /// and at a kink half.
    pub const LEFT_OF_HALF: f64 = 0.35;
    /// It is moved by what this part of a parameter's size makes of the formula at least, which may have no range.
    pub const LEAST_STEP: f64 = 1e-9;
    /// Changes below this part of a value are its last digits, which decide nothing.
    pub const LAST_DIGITS: f64 = 1e-13;
    /// A parameter that as much again would change a formula by no more than this part of its range does not change it.
    pub const NOTHING: f64 = 1e-12;
}
