//! What is half done when the user interrupts it is taken away: temporary files, and folders that are still empty.

use mechc_text::cancel::Cancel;
use std::fs;
use std::path::PathBuf;
#[cfg(unix)]
use std::process;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files and folders that are not yet what they are meant to be, in the order in which they were made.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What the first interruption ends, so that what is done is kept; the second one takes it away.
static GRACEFUL: Mutex<Option<Cancel>> = Mutex::new(None);

/// The signal that has ended it, or 0.
static CAUGHT: AtomicI32 = AtomicI32::new(0);

/// From here on the first interruption ends this work, and the command comes to its end with what is done.
pub(super) fn end_gracefully(work: &Cancel) {
    *GRACEFUL.lock().unwrap_or_else(PoisonError::into_inner) = Some(work.clone());
}

/// The exit code of a command that an interruption has brought to its end.
pub(super) fn caught() -> Option<u8> {
    let signal = CAUGHT.load(Ordering::Relaxed);
    u8::try_from(signal).ok().filter(|signal| *signal > 0).map(|signal| 128 + signal)
}

/// Ends the work that may come to its end; whether there was any.
fn end(signal: i32) -> bool {
    let work = GRACEFUL.lock().unwrap_or_else(PoisonError::into_inner).take();
    CAUGHT.store(signal, Ordering::Relaxed);
    work.inspect(Cancel::cancel).is_some()
}

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
    let (is_watching, watches) = std::sync::mpsc::channel();
    let wait = move || {
        let signals = signal_hook::iterator::Signals::new(wanted);
        // nobody waits for what cannot be sent
        let _ = is_watching.send(());
        if let Ok(mut signals) = signals {
            signals.forever().filter(|signal| !end(*signal)).for_each(abandon);
        }
    };
    // where the system gives no thread, signals do what they do to any process: a signal that is caught and not seen to would do nothing
    if std::thread::Builder::new().name("interrupts".to_owned()).spawn(wait).is_ok() {
        // an error says that it ended, and with it what it watched
        let _ = watches.recv();
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
    let mut unfinished = unfinished();
    take_away(&mut unfinished);
    process::exit(128 + signal);
}

/// Takes away what is unfinished.
pub(super) fn take_away(unfinished: &mut Vec<PathBuf>) {
    for path in unfinished.drain(..).rev() {
        if fs::remove_file(&path).is_err() {
            // a folder; if something else is in it, it stays
            let _ = fs::remove_dir(&path);
        }
    }
}
