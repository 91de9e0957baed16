//! The errors of emitted code, for those who write of them: pages, and the codes that C has.

/// An error.
pub(super) struct Told {
    /// Of the enum `Error`.
    pub name: &'static str,
    /// What it says of itself.
    pub says: &'static str,
    /// And what a page adds.
    pub more: &'static str,
}

const fn told(name: &'static str, says: &'static str, more: &'static str) -> Told {
    Told { name, says, more }
}

/// All errors; C has them by their places, counted from 1. A new one comes last.
pub(super) const ERRORS: [Told; 7] = [
    told("NotANumber", "the time, an input, a parameter or a formula is not a number", ""),
    told("LockUp", "the mechanism locks up: its driver cannot go on", ""),
    told("Bifurcation", "two branches of the motion meet", ", and which one goes on is not determined"),
    told("NotSmooth", "a position or velocity jumps", ", where a formula of time goes over to another branch"),
    told("TooFar", "it is too far away: for the steps that are allowed, or for one change of an input", ""),
    told(
        "Inconsistent",
        "an equation that was left out as redundant does not hold, or is needed where the others are singular",
        "",
    ),
    told(
        "Divergence",
        "the mechanism cannot be brought there",
        ": from `assemble`, with these parameters it cannot be put together",
    ),
];

#[cfg(test)]
mod tests {
    use super::ERRORS;
    use crate::runtime::error::Error;

    #[test]
    fn errors_are_told_as_they_tell_themselves() {
        for error in [
            Error::NotANumber,
            Error::LockUp,
            Error::Bifurcation,
            Error::NotSmooth,
            Error::TooFar,
            Error::Inconsistent,
            Error::Divergence,
        ] {
            let told = ERRORS.iter().find(|told| told.name == format!("{error:?}")).expect("it is told");
            assert_eq!(told.says, error.to_string());
        }
    }
}
