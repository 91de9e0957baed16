//! What is half done when the user interrupts it is taken away: temporary files, and folders that are still empty.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
#[cfg(unix)]
use std::{fs, process};

/// Files and folders that are not yet what they are meant to be, in the order in which they were made.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The list of them. While it is held nothing is interrupted, so that what is made or moved to its place is on the list or not,
/// and never in between.
pub(super) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on an interruption takes away what is unfinished. What the user has told the process to ignore, as `nohup` does, stays
/// ignored.
#[cfg(unix)]
pub(super) fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let wanted = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) {
        let wait = move || signals.forever().next().map_or((), abandon);
        // without the thread a signal would do nothing at all
        if std::thread::Builder::new().name("interrupts".to_owned()).spawn(wait).is_err() {
            process::abort();
        }
    }
}

/// Nothing is known here that tells of interruptions.
#[cfg(not(unix))]
pub(super) fn watch() {}

/// Whether the process was started with a signal ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let Ok(status) = fs::read_to_string("/proc/self/status") else {
        // where that cannot be told, `nohup` must go on working
        return signal == signal_hook::consts::SIGHUP;
    };
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|set| u64::from_str_radix(set.trim(), 16).ok()).unwrap_or(0);
    ignored >> (signal - 1) & 1 == 1
}

/// Takes away what is unfinished, and ends the process as shells know it of one that a signal has ended.
#[cfg(unix)]
fn abandon(signal: i32) {
    let unfinished = unfinished();
    for path in unfinished.iter().rev() {
        if fs::remove_file(path).is_err() {
            // a folder; if something else is in it, it stays
            let _ = fs::remove_dir(path);
        }
    }
    process::exit(128 + signal);
}
