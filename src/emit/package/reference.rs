// $mark

//! The motion, bit for bit as `mechc run` printed it.

#![allow(clippy::approx_constant, clippy::excessive_precision)]

use $library::{COLUMNS, Error, $usesParams, START_TIME, assemble$more, step};

#[test]
fn the_motion_is_that_of_mechc_run() -> Result<(), Error> {
    let mut state = assemble(&$params)?;
    for expected in &ROWS {
        let [t, ..] = *expected;
        step(t, &mut state)?;
        for ((name, value), expected) in NAMES.iter().zip(state.row()).zip(expected) {
            // a measure may have no value
            let is_same =
                value.to_bits() == expected.to_bits() || (value.is_nan() && expected.is_nan());
            assert!(is_same, "{name} at {t} s is {value:?}, not {expected:?}");
        }
    }
    Ok(())
}

#[test]
fn a_time_that_is_no_number_is_an_error() -> Result<(), Error> {
    let mut state = assemble(&$params)?;
    assert_eq!(step(f64::NAN, &mut state), Err(Error::NotANumber));
    assert_eq!(state.t(), START_TIME, "the state stays where it is");
    Ok(())
}

$follow/// What stands in a row.
#[rustfmt::skip]
const NAMES: [&str; COLUMNS] = [
$names];

/// Rows of the analysis, the first and the last among them (s, m, rad).
#[rustfmt::skip]
const ROWS: [[f64; COLUMNS]; $count] = [
$rows];
