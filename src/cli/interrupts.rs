//! Interruptions: unfinished output, that is temporary files and empty new folders, is removed.

use mechc_text::cancel::Cancel;
use std::fs;
use std::path::PathBuf;
#[cfg(unix)]
use std::process;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporary files and new folders, in the order in which they were created.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The work that the first interruption cancels, so that finished results are kept; the second interruption abandons them.
static GRACEFUL: Mutex<Option<Cancel>> = Mutex::new(None);

/// The signal that was caught, or 0.
static CAUGHT: AtomicI32 = AtomicI32::new(0);

/// Makes the first interruption cancel this work, so that the command ends with the results so far.
pub(super) fn stop_gracefully(work: &Cancel) {
    *GRACEFUL.lock().unwrap_or_else(PoisonError::into_inner) = Some(work.clone());
}

/// Returns the exit code of a command that was interrupted.
pub(super) fn exit_code() -> Option<u8> {
    let signal = CAUGHT.load(Ordering::Relaxed);
    u8::try_from(signal).ok().filter(|signal| *signal > 0).map(|signal| 128 + signal)
}

/// Cancels the work that may end gracefully; returns whether there is any.
fn cancel_work(signal: i32) -> bool {
    let work = GRACEFUL.lock().unwrap_or_else(PoisonError::into_inner).take();
    CAUGHT.store(signal, Ordering::Relaxed);
    work.inspect(Cancel::cancel).is_some()
}

/// Locks the list of unfinished files and folders. While it is locked no interruption is handled, so that creating or moving a file and
/// updating the list are one step.
pub(super) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Handles interruptions from now on by removing unfinished output. Signals that the process ignores, as under `nohup`, stay ignored.
#[cfg(unix)]
pub(super) fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let handled = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    let (is_watching, watches) = std::sync::mpsc::channel();
    let wait = move || {
        let signals = signal_hook::iterator::Signals::new(handled);
        // sending fails only if the receiver does not wait any more
        let _ = is_watching.send(());
        if let Ok(mut signals) = signals {
            signals.forever().filter(|signal| !cancel_work(*signal)).for_each(abandon);
        }
    };
    // without a thread signals keep their default action: a signal that is caught but not handled would be lost
    if std::thread::Builder::new().name("interrupts".to_owned()).spawn(wait).is_ok() {
        // an error means that the thread has ended, and its handlers with it
        let _ = watches.recv();
    }
}

/// Does nothing: only Unix has signals.
#[cfg(not(unix))]
pub(super) fn watch() {}

/// Returns whether the process was started with a signal ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let Ok(status) = fs::read_to_string("/proc/self/status") else {
        // without this file `nohup` must still work
        return signal == signal_hook::consts::SIGHUP;
    };
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|set| u64::from_str_radix(set.trim(), 16).ok()).unwrap_or(0);
    ignored >> (signal - 1) & 1 == 1
}

/// Removes unfinished output, and ends the process with the exit code of a process that a signal has ended.
#[cfg(unix)]
fn abandon(signal: i32) {
    let mut unfinished = unfinished();
    remove(&mut unfinished);
    process::exit(128 + signal);
}

/// Removes unfinished files and empty folders.
pub(super) fn remove(unfinished: &mut Vec<PathBuf>) {
    for path in unfinished.drain(..).rev() {
        if fs::remove_file(&path).is_err() {
            // the path is a folder, which stays if it is not empty
            let _ = fs::remove_dir(&path);
        }
    }
}
