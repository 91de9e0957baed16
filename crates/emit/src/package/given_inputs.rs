/// Writes inputs, if there are any.
unsafe fn say(to: *mut Inputs, inputs: impl FnOnce() -> Result<Inputs, Status>) -> Result<(), Status> {
    if to.is_null() || !to.is_aligned() {
        return Err(BAD_POINTER);
    }
    // SAFETY: it is a place for them; what it holds yet may be anything
    unsafe { to.write(inputs()?) };
    Ok(())
}

/// A time, which must be a number.
fn number(t: f64) -> Result<f64, Status> {
    if t.is_finite() { Ok(t) } else { Err(Error::NotANumber.into()) }
}

/// Reads as many numbers as there are inputs.
unsafe fn read(
    list: *const f64,
    length: usize,
    set: impl FnOnce([f64; INPUTS]) -> Result<(), Status>,
) -> Result<(), Status> {
    if length != INPUTS {
        return Err(WRONG_LENGTH);
    }
    // SAFETY: it is so long
    let all = *unsafe { given(list.cast::<[f64; INPUTS]>())? };
    if all.iter().any(|value| value.is_nan()) { Err(Error::NotANumber.into()) } else { set(all) }
}
