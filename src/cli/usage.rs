//! Tips for options that a command does not have.

use clap::Error;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue};

/// Options of other commands or programs, with their counterparts.
const TIPS: &[(&str, &str)] = &[
    ("--format", "diagnostics are written for other programs with '--message-format json'"),
    ("--json", "diagnostics are written for other programs with '--message-format json'"),
    ("--fix", "'mechc check FILE --fix' mends a file"),
    ("--step", "the time from row to row is '--every'"),
    ("--start", "the first time is '--from'"),
    ("--end", "the last time is '--to'"),
    ("--param", "a parameter is set with '--set NAME=VALUE'"),
];

/// Replaces the general tip of an error by a specific one, if there is one.
pub(super) fn with_tip(mut error: Error) -> Error {
    let Some(ContextValue::String(argument)) = error.get(ContextKind::InvalidArg) else { return error };
    let option = argument.split(['=', ' ']).next().unwrap_or_default();
    let is_unknown = error.kind() == clap::error::ErrorKind::UnknownArgument;
    let tip = TIPS.iter().find(|(other, _)| is_unknown && *other == option).map(|(_, tip)| StyledStr::from(*tip));
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
        error.remove(ContextKind::SuggestedArg);
    }
    error
}
