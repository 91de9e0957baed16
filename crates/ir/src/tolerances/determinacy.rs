//! Why a mechanism is not determined, or cannot be assembled.

/// The part that is refused (`crates/engine/src/analysis/explain/determine.rs`).
pub mod determine {
    /// Larger parts are not looked at with values: their equations would be a dense matrix.
    pub const LARGEST: usize = 600;
    /// The same where redundant equations are allowed: that takes some seconds.
    pub const LARGEST_ALLOWED: usize = 1500;
}

/// Equations that depend on others (`crates/engine/src/analysis/explain/redundancy.rs`).
pub mod redundancy {
    /// Equations that are this nearly dependent are so: an assembled position is known to the root of rounding.
    pub const DEPENDENT: f64 = 1e-6;
    /// An equation takes part in a dependency if its share is above this.
    pub const TAKES_PART: f64 = 1e-6;
    /// Rows that others depend on with a larger weight than this are taken last: without them the others are far from dependent.
    pub const HEAVY: f64 = 5.0;
    /// Rows are exchanged so many times at most.
    pub const MOST_EXCHANGES: usize = 30;
    /// How much less than the others those equations weigh of which it is asked how far they are off where that is least: the others are off by
    /// the square of this less.
    pub const YIELDING: f64 = 100.0;
    /// Least squares begin anew so many times there.
    pub const PASSES: usize = 4;
    /// What is open by more than this, scaled, does not hold, here as along the motion.
    pub const OPEN: f64 = crate::tolerances::checks::LARGEST_OPENING;
    /// Times at which the equations are looked at beside the first one, as parts of the span.
    pub const NEARBY: [f64; 3] = [1.3e-3, 3.1e-3, 7.7e-3];
}

/// Forces that redundant equations share (`crates/engine/src/analysis/explain/sharing.rs`).
pub mod sharing {
    /// The first step along the motion, as a part of the span.
    pub const FIRST_STEP: f64 = 1e-3;
    /// The longest step, as a part of the span: what rests for a while is waited for.
    pub const LONGEST_STEP: f64 = 1.0 / 32.0;
    /// A step may move no coordinate by more than this, scaled.
    pub const LARGEST_STEP: f64 = 0.3;
    /// A step may end no farther than this, scaled, from where the one before it leads: else it is on another branch.
    pub const APART: f64 = 0.1;
    /// Positions are looked at this far from each other, scaled.
    pub const FRESH: f64 = 0.03;
    /// Steps are no more than this: the whole motion of what turns once or twice.
    pub const MOST_STEPS: usize = 200;
    /// Steps are no more than do this work, which is rows times the square of coordinates: about a second.
    pub const MOST_WORK: usize = 1_000_000_000;
}

/// Free motions, and what is proposed to take them (`crates/engine/src/analysis/explain/freedom.rs`, `crates/engine/src/analysis/explain/proposals.rs`).
pub mod freedom {
    /// A residual above this is not assembled: motions would be told of no position.
    pub const ASSEMBLED: f64 = 1e-8;
    /// A coordinate moves if its share of the free motions is above this.
    pub const MOVES: f64 = 1e-6;
    /// A coordinate with no less than this share is held by nothing at all.
    pub const LOOSE: f64 = 1.0 - 1e-9;
    /// Angles are what free motions are told by, where they have this part of the largest share.
    pub const ANGLE_SHARE: f64 = 0.01;
    /// A driver takes a freedom if it changes at this rate with it.
    pub const TAKEN: f64 = 1e-3;
    /// Points nearer than this as drawn, in sizes of the mechanism, may be meant to coincide.
    pub const COINCIDE: f64 = 0.02;
    /// Likewise, where no joint takes hold of either of them.
    pub const DANGLING: f64 = 0.15;
    /// Motions that are told at most.
    pub const TOLD: usize = 3;
    /// Joints that are suggested at most.
    pub const SUGGESTED: usize = 3;
    /// More points than this are not compared with each other.
    pub const MOST_POINTS: usize = 1000;
}

/// Loops that cannot be closed (`crates/engine/src/analysis/explain/open_loop.rs`).
pub mod open_loop {
    /// So many equations are looked at together at most.
    pub const LARGEST: usize = 600;
    /// A force takes part in a link's balance from this part of the largest of all on.
    pub const PULLS: f64 = 0.1;
    /// An equation is part of the loop if its share of the residual is above this part of the largest.
    pub const TAKES_PART: f64 = 0.01;
    /// How much lighter one joint is made than the others, so that the loop opens there.
    pub const LIGHT: f64 = 1e4;
    /// A link is too short or too long if this part of the force acts along it.
    pub const ALONG: f64 = 0.3;
    /// What is open by more than this, in sizes of the mechanism, is not shown.
    pub const FAR: f64 = 10.0;
    /// A loop is open in length if that is more than this part of what it is open in angles, scaled.
    pub const IN_LENGTH: f64 = 0.1;
    /// A joint may be where a loop is told to be open if it is open by this part of the widest.
    pub const WIDE: f64 = 0.3;
    /// What is open by less than this, scaled, is closed.
    pub const CLOSED: f64 = 1e-6;
}

/// Numbers in words (`crates/engine/src/analysis/explain/errors/mod.rs`).
pub mod words {
    /// A length (m) or angle (rad) below this is told as 0: it is less than an atom.
    pub const NOTHING: f64 = 1e-12;
}

/// What does not move (`crates/lang/src/lower/velocities.rs`).
pub mod velocities {
    /// What is shorter than this part of the mechanism's size, or slower than this part of it in the time of the analysis, is nothing; and
    /// an instant centre that is farther away than so many sizes, the other way round, is nowhere.
    pub const NOTHING: f64 = 1e-9;
    /// Bodies that turn against each other by no more than so many roundings of the fastest motion do not.
    pub const ROUNDING: f64 = 64.0;
}

/// Gears that do not reach each other, and poses that are proposed (`crates/engine/src/analysis/assemble/errors.rs`).
pub mod fits {
    /// A pose is proposed for a body that assembly has moved by more than this, scaled.
    pub const MOVED: f64 = 1e-6;
    /// What is less than this (m, rad) is written as 0.
    pub const NOTHING: f64 = 1e-12;
    /// Gears may be off by this part of the larger radius.
    pub const LARGEST_MISFIT: f64 = 1e-6;
}
