use core::ffi::{CStr, c_char};
use core::mem::{MaybeUninit, align_of, size_of};

/// The memory of a state, which the caller has: a word that says whether there is one, and the state itself.
#[repr(C)]
pub struct Memory {
    sign: u64,
    state: MaybeUninit<[u64; WORDS - 1]>,
}

// a state must have room there
const _: () = assert!(size_of::<State>() <= 8 * (WORDS - 1));
const _: () = assert!(align_of::<State>() <= align_of::<Memory>());

impl Memory {
    /// Holds a state from now on; without one, all stays as it is.
    fn hold(&mut self, state: impl FnOnce() -> Result<State, Status>) -> Result<(), Status> {
        let state = state()?;
        // SAFETY: it has room and is aligned, as is said above
        unsafe { self.state.as_mut_ptr().cast::<State>().write(state) };
        self.sign = SIGN;
        Ok(())
    }
}

/// A code for what is wrong, or for a state that is on its way.
struct Status(i32);

/// Whether the end of a way is reached.
fn reached(progress: Progress) -> Result<(), Status> {
    if progress.is_reached() { Ok(()) } else { Err(ON_THE_WAY) }
}

/// What a function answers: 0 if all went well.
fn answer(work: impl FnOnce() -> Result<(), Status>) -> i32 {
    work().map_or_else(|Status(code)| code, |()| 0)
}

/// What a pointer leads to.
unsafe fn given<'g, T>(from: *const T) -> Result<&'g T, Status> {
    // SAFETY: what is neither null nor misaligned is what the header asks for
    if from.is_aligned() { unsafe { from.as_ref() }.ok_or(BAD_POINTER) } else { Err(BAD_POINTER) }
}

/// The same, to be written.
unsafe fn given_to_write<'g, T>(to: *mut T) -> Result<&'g mut T, Status> {
    // SAFETY: likewise
    if to.is_aligned() { unsafe { to.as_mut() }.ok_or(BAD_POINTER) } else { Err(BAD_POINTER) }
}

/// The state in some memory.
unsafe fn state_of<'g>(memory: *const Memory) -> Result<&'g State, Status> {
    // SAFETY: what has the sign was written by `hold`
    unsafe {
        let memory = given(memory)?;
        if memory.sign == SIGN { Ok(&*memory.state.as_ptr().cast::<State>()) } else { Err(NOT_ASSEMBLED) }
    }
}

/// The same, to be written.
unsafe fn state_to_write<'g>(memory: *mut Memory) -> Result<&'g mut State, Status> {
    // SAFETY: likewise
    unsafe {
        let memory = given_to_write(memory)?;
        if memory.sign == SIGN { Ok(&mut *memory.state.as_mut_ptr().cast::<State>()) } else { Err(NOT_ASSEMBLED) }
    }
}

/// Writes numbers to a list of the same length.
unsafe fn write(list: *mut f64, length: usize, values: &[f64]) -> Result<(), Status> {
    if length != values.len() {
        return Err(WRONG_LENGTH);
    }
    if list.is_null() || !list.is_aligned() {
        return Err(BAD_POINTER);
    }
    // SAFETY: it is so long; what it holds yet may be anything
    unsafe { core::ptr::copy(values.as_ptr(), list, length) };
    Ok(())
}

/// Writes a whole number.
unsafe fn write_whole(to: *mut i32, value: i32) -> Result<(), Status> {
    if to.is_null() || !to.is_aligned() {
        return Err(BAD_POINTER);
    }
    // SAFETY: it is a place for one; what it holds yet may be anything
    unsafe { to.write(value) };
    Ok(())
}

/// What a library without the standard library does where Rust would panic, which nothing here does.
#[cfg(all(not(feature = "std"), not(test)))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
