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
