//! The limits that emitted code names: those of the engine (`crates/engine/src/limits.rs`), and its own where it differs, since its step
//! control is simpler.

use super::text::{documented, literal};
use mechc_engine::limits::{
    domain_boundaries, edges, error_bound, jumps, lanes, redundancy, singular, solver, step_control,
};

/// Parameters other than those of the file (`crates/emit/src/runtime/assemble.rs`).
pub mod assemble {
    /// Number of trials along the path to them before the file's poses are tried.
    pub const FIRST_PARTS: usize = 4;
    /// Maximum number of trials along the path if the poses have not helped either.
    pub const MOST_PARTS: usize = 200;
    /// Smallest trial, as a part of the path.
    pub const SMALLEST_PART: f64 = 1e-6;
}

/// Closure from far away (`crates/emit/src/runtime/pivoting.rs`).
pub mod close {
    /// Maximum number of corrections.
    pub const MOST_TRIALS: usize = 30;
    /// Maximum number of halvings of a correction before it is accepted.
    pub const MOST_SHORTER: usize = 6;
    /// A correction of at most this size, scaled, is the last one.
    pub const NEAR: f64 = 0.02;
}

/// Steps (`crates/emit/src/runtime/step.rs`).
pub mod step {
    /// Maximum number of steps in one call of `step`: several analyses of the file.
    pub const MOST_STEPS: usize = 10_000;
    /// Largest ratio of a step to the previous one for which the latter predicts it.
    pub const FARTHEST_BEND: f64 = 4.0;
    /// Largest deviation of velocities from the change of positions, scaled: beyond it the step is on another branch.
    pub const LARGEST_GAP: f64 = 1e-3;
}

/// Branches of the motion and of formulas (`crates/emit/src/runtime/reach.rs`).
pub mod reach {
    /// Largest inverse of a pivot, scaled, without a closer examination of the position.
    pub const STEEP: f64 = 1e3;
    /// Largest inverse of a pivot, scaled: beyond it the position is too close to a singular one.
    pub const STEEPEST: f64 = 1e6;
    /// Maximum number of times that the branches of formulas are chosen at one time.
    pub const MOST_BRANCHES: usize = 8;
}

/// Explanations of a motion that ends (`crates/emit/src/runtime/explain.rs`).
pub mod explain {
    /// Inverse of a pivot above which vanishing steps are explained by a singular position.
    pub const SINGULAR: f64 = 1e2;
}

/// Domain boundaries of formulas of time (`crates/emit/src/runtime/domain_boundaries.rs`).
pub mod looks {
    /// Maximum number of examinations of both sides, each at a quarter of the previous distance.
    pub const MOST_LOOKS: usize = 6;
    /// Minimum number of these examinations.
    pub const FEWEST_LOOKS: usize = 3;
    /// A velocity jumps if it changes by more than this part of the fastest motion.
    pub const SPEED_JUMP: f64 = 1e-6;
    /// A speed below this, per span, is rest.
    pub const SLOW: f64 = 1e-3;
    /// Boundaries within this part of the span have been examined.
    pub const PASSED: f64 = 1e-9;
}

/// Paths of inputs (`crates/emit/src/runtime/follow.rs`).
pub mod follow {
    /// Maximum number of steps in one call of `follow`: enough for half a turn, and few enough for a control loop.
    pub const MOST_STEPS_TO_FOLLOW: usize = 64;
    /// Largest change of an angle in a call (rad): beyond half a turn the direction is ambiguous.
    pub const LARGEST_TURN_OF_INPUT: f64 = std::f64::consts::PI;
    /// Largest change of a length in a call, relative to the largest scale of a coordinate.
    pub const LARGEST_SHIFT_OF_INPUT: f64 = 2.0;
    /// A dead point at this change of a signal is not passed while longer steps are rejected.
    pub const NEAREST_TURN: f64 = 1e-6;
    /// Inverse of a pivot above which a rejected step starts a search for a dead point.
    pub const NEAR_TURN: f64 = 10.0;
    /// A position jumps if it moves this many times as far as the slopes predict.
    pub const JUMP: f64 = 100.0;
    /// Shortest step, as a part of the path; for long paths, as a change of a signal.
    pub const SHORTEST_STEP: f64 = 1e-12;
    /// Signals continue straight if the square of the sideways part is at most this part of the square of the whole.
    pub const LARGEST_TURN: f64 = 0.01;
}

/// Limit to which emitted code refers.
struct Limit {
    name: &'static str,
    docs: &'static str,
    value: Value,
}

enum Value {
    Number(f64),
    Count(usize),
}

macro_rules! limits {
    ($($kind:ident $name:ident = $value:expr, $docs:literal;)*) => {
        const LIMITS: &[Limit] =
            &[$(Limit { name: stringify!($name), docs: $docs, value: Value::$kind($value) },)*];

        /// Limits as constants, for the runtime files that this crate itself compiles.
        #[cfg(test)]
        #[allow(dead_code)] // one is named by code that is printed, and by no file
        pub(super) mod values {
            use super::*;
            $(limits!(@constant $kind $name = $value);)*
        }
    };
    (@constant Number $name:ident = $value:expr) => { pub const $name: f64 = $value; };
    (@constant Count $name:ident = $value:expr) => { pub const $name: usize = $value; };
}

limits! {
    Number ACCURACY = error_bound::ACCURACY, "Rounding may make so much of velocities and accelerations that are given out.";
    Number AHEAD = edges::AHEAD,
        "How far the motion is looked ahead to tell on which side of an edge it goes on, as a part of the span.";
    Number LONGEST_AHEAD = edges::LONGEST_AHEAD, "And at most (s).";
    Number BORDER = lanes::BORDER,
        "A correction that is no farther from half a cell of the grid than this, in cells, leads to the border of two.";
    Number CALM_BETWEEN = step_control::CALM_BETWEEN,
        "A step is calm, so that a longer one would do as well, if its gap is so many times less than the largest.";
    Number CALM_CORRECTION = step_control::CALM_CORRECTION, "And if its first correction is so many times less.";
    Number CRUMB = step_control::CRUMB, "A step that makes this part of what is left makes all of it.";
    Number FARTHEST_AHEAD = edges::FARTHEST_AHEAD, "Nothing may move farther than this meanwhile, scaled.";
    Number FARTHEST_BEND = step::FARTHEST_BEND,
        "The step before tells of one that is so many times as long at most.";
    Count FIRST_PARTS = assemble::FIRST_PARTS,
        "Trials on the way from the file's parameters to others before its poses are tried.";
    Count FEWEST_LOOKS = looks::FEWEST_LOOKS, "How often both sides of a rim are looked at at least.";
    Number GROWTH = domain_boundaries::GROWTH, "What grows by so much with each look has no bound.";
    Count ITERATIONS = lanes::ITERATIONS, "Iterations of Newton at most.";
    Number JUMP = follow::JUMP, "A position jumps that is so many times farther away than slopes lead.";
    Number LARGEST_CORRECTION = step_control::LARGEST_CORRECTION,
        "Newton's first correction at most, beside the size of a body or 1 rad.";
    Number LARGEST_GAP = step::LARGEST_GAP,
        "How far velocities may lead elsewhere than positions, likewise: more is another branch.";
    Number LARGEST_MOTION = step_control::LARGEST_MOTION, "The largest motion of a step, beside the size of a body or 1 rad.";
    Number LARGEST_MULTIPLIER = solver::LARGEST_MULTIPLIER, "A multiplier beyond this loses digits.";
    Number LARGEST_OPENING = redundancy::LARGEST_OPENING,
        "How far equations that were left out may be open, beside their scales.";
    Number LARGEST_TURN = follow::LARGEST_TURN,
        "Signals go straight on if the square of what leads aside is no larger part of that of the whole.";
    Number LEAD = domain_boundaries::FARTHEST, "How far before a rim its sides are looked at, as a part of the span.";
    Number MISSES = mechc_ir::limits::MISSES,
        "What equations that were left out may miss by, beside how much everything changes with a parameter, scaled.";
    Number MOMENT = domain_boundaries::MOMENT,
        "A rounding of the time, in units in its last place, that changes a gauge by more than itself shows that it is zero there.";
    Count MOST_BRANCHES = reach::MOST_BRANCHES, "How often the branches of formulas are chosen anew at one time.";
    Count MOST_HALVINGS = domain_boundaries::MOST_HALVINGS, "Halvings until two times are neighbours.";
    Count MOST_LOOKS = looks::MOST_LOOKS,
        "How often both sides of a rim are looked at, each time at a quarter of the distance.";
    Count MOST_PARTS = assemble::MOST_PARTS, "Trials on it at most where these have not helped either.";
    Count MOST_SHORTER = close::MOST_SHORTER, "How often a correction is made half as long before it is taken as it is.";
    Count MOST_STEPS = step::MOST_STEPS, "Steps that `step` takes at most.";
    Count MOST_STEPS_TO_FOLLOW = follow::MOST_STEPS_TO_FOLLOW, "Steps that `follow` takes at most.";
    Count MOST_TRIALS = close::MOST_TRIALS, "Corrections at most from far away.";
    Number NEAR = close::NEAR, "A correction that is so small, scaled, is the last one from far away.";
    Number NEAREST_TURN = follow::NEAREST_TURN,
        "A dead point that is so near by a signal's change, while a longer step is refused, is not passed.";
    Number NEAR_TURN = follow::NEAR_TURN, "Where a step is refused, this is steep enough for a dead point to be looked for.";
    Number NEAR_FOLD = singular::NEAR_FOLD, "A dead point is no further off than this part of the span.";
    Number PASSED = looks::PASSED, "A rim within this part of the span is one that was looked at.";
    Number POSITION_JUMP = jumps::POSITION_JUMP, "A position that changes by more than this at an edge jumps, scaled.";
    Number REST = jumps::REST, "A speed below this part of one per span is rest, scaled.";
    Number ROUNDING = domain_boundaries::ROUNDING, "A gauge is zero that is no more than so many units in the last place.";
    Number SHORTEST_STEP = follow::SHORTEST_STEP,
        "The shortest step, as a part of the way of signals; of a long one, as a change of a signal.";
    Number SINGULAR = explain::SINGULAR,
        "Where steps become too small, this is steep enough for a singular position to be the reason.";
    Number SLACK = edges::SLACK,
        "So many units in the last place of a time it may be off from what is meant to happen then.";
    Number SLOW = looks::SLOW, "A speed below this part of one per span is rest, beside a rim.";
    Number SMALLEST_PART = assemble::SMALLEST_PART, "The smallest part of the way to other parameters.";
    Number SPEED_JUMP = looks::SPEED_JUMP,
        "A velocity that changes at a rim by more than this jumps, beside the fastest motion.";
    Number STEEP = reach::STEEP, "One over a pivot, scaled: beyond this the position is looked at more closely.";
    Number STEEPEST = reach::STEEPEST, "One over a pivot, scaled: beyond this it is too near to a singular one.";
    Number VELOCITY_JUMP = jumps::VELOCITY_JUMP,
        "A velocity that changes by more than this part of the fastest at an edge jumps.";
}

/// Returns the declaration of a limit.
pub(super) fn printed(name: &str) -> String {
    let limit = LIMITS.iter().find(|limit| limit.name == name);
    debug_assert!(limit.is_some(), "`{name}` is no limit");
    limit.map_or_else(String::new, |limit| {
        let value = match limit.value {
            Value::Number(value) => format!("f64 = {}", literal(value)),
            Value::Count(value) => format!("usize = {}", grouped(value)),
        };
        format!("{}pub const {}: {value};\n", documented(limit.docs, ""), limit.name)
    })
}

/// Returns a count with separated thousands.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) && digits.len() > 4 {
            text.push('_');
        }
        text.push(digit);
    }
    text
}
