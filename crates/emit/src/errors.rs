//! Errors of emitted code, with the texts for its documentation and for the codes of the C interface.

/// Name and message of an error of emitted code.
pub(super) struct ErrorText {
    /// Name of the variant of `Error`.
    pub name: &'static str,
    /// Message of the error.
    pub message: &'static str,
    /// Text that a page adds to the message.
    pub more: &'static str,
}

const fn error(name: &'static str, message: &'static str, more: &'static str) -> ErrorText {
    ErrorText { name, message, more }
}

/// All errors. Their positions, from 1, are the codes of the C interface, so append new ones at the end.
pub(super) const ERRORS: [ErrorText; 7] = [
    error("NotANumber", "the time, an input, a parameter or a formula is not a number", ""),
    error("LockUp", "the mechanism locks up: its driver cannot go on", ""),
    error("Bifurcation", "two branches of the motion meet", ", and which one goes on is not determined"),
    error("NotSmooth", "a position or velocity jumps", ", where a formula of time goes over to another branch"),
    error("TooFar", "it is too far away: for the steps that are allowed, or for one change of an input", ""),
    error(
        "Inconsistent",
        "an equation that was left out as redundant does not hold, or is needed where the others are singular",
        "",
    ),
    error(
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
    fn error_texts_match_their_display() {
        for error in [
            Error::NotANumber,
            Error::LockUp,
            Error::Bifurcation,
            Error::NotSmooth,
            Error::TooFar,
            Error::Inconsistent,
            Error::Divergence,
        ] {
            let text = ERRORS.iter().find(|text| text.name == format!("{error:?}")).expect("every error has a text");
            assert_eq!(text.message, error.to_string());
        }
    }
}
