//! Errors of emitted code.

/// The reason why a mechanism could not be moved to a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The time, an input, a parameter or a formula is not a number.
    NotANumber,
    /// A driver has come to a position beyond which the mechanism cannot follow it: a dead point.
    LockUp,
    /// Two branches of the motion meet: which one goes on is not determined.
    Bifurcation,
    /// Newton's iteration does not arrive, however short the step.
    Divergence,
    /// The steps that are allowed do not lead so far, or an input changes by more than is allowed.
    TooFar,
    /// At a time where a formula of time goes over to another branch, a position or velocity jumps.
    NotSmooth,
    /// An equation that was left out as redundant does not hold beside the others, or is needed where these are singular.
    Inconsistent,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Error::NotANumber => "the time, an input, a parameter or a formula is not a number",
            Error::LockUp => "the mechanism locks up: its driver cannot go on",
            Error::Bifurcation => "two branches of the motion meet",
            Error::Divergence => "the mechanism cannot be brought there",
            Error::TooFar => "it is too far away: for the steps that are allowed, or for one change of an input",
            Error::NotSmooth => "a position or velocity jumps",
            Error::Inconsistent => {
                "an equation that was left out as redundant does not hold, or is needed where the others are singular"
            }
        })
    }
}

impl core::error::Error for Error {}

/// The reason why a step is refused.
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
    /// Returns the error of a mechanism that cannot be assembled.
    pub fn at_start(self) -> Error {
        match self {
            Self::NotANumber => Error::NotANumber,
            Self::LeftOut => Error::Inconsistent,
            _ => Error::Divergence,
        }
    }
}
