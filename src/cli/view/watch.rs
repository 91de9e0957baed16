//! Waiting for changes of files: by notifications of the system, and by polling where it sends none.

use notify::event::{AccessKind, AccessMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// The interval of polling without notifications.
const POLL: Duration = Duration::from_millis(100);
/// The interval of polling with notifications: a network file system sends none for changes by other machines.
const SLOW_POLL: Duration = Duration::from_secs(1);
/// The pause after a notification, for programs that write a file in steps.
const SETTLE: Duration = Duration::from_millis(8);

/// A watcher of folders: a file that is replaced is a different file in the same folder.
pub(super) struct Watch {
    watcher: Option<RecommendedWatcher>,
    notifications: Receiver<()>,
    folders: Vec<WatchedFolder>,
}

/// A folder that is watched.
struct WatchedFolder {
    path: PathBuf,
    /// The identity of the folder when watching began.
    identity: Option<Identity>,
}

impl Watch {
    pub fn new() -> Watch {
        let (sender, notifications) = channel();
        let watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
            if event.is_ok_and(|event| is_only_read(event.kind)) {
                return;
            }
            // the receiver is gone when the process ends
            let _ = sender.send(());
        });
        Watch { watcher: watcher.ok(), notifications, folders: Vec::new() }
    }

    /// Waits until one of some files may have changed. Their folders are watched from now on, so a caller that reads the files after this
    /// call misses no later change.
    pub fn wait(&mut self, files: &[PathBuf]) {
        let has_notifications = self.watch_folders(files);
        match self.notifications.recv_timeout(if has_notifications { SLOW_POLL } else { POLL }) {
            Ok(()) => {
                thread::sleep(SETTLE);
                while self.notifications.try_recv().is_ok() {}
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => thread::sleep(POLL),
        }
    }

    /// Watches the folders of some files, and no others; returns whether all of them can be watched.
    fn watch_folders(&mut self, files: &[PathBuf]) -> bool {
        let Some(watcher) = &mut self.watcher else { return false };
        let mut required: Vec<PathBuf> = files.iter().flat_map(|file| folders_of(file)).collect();
        required.sort();
        required.dedup();
        self.folders.retain(|folder| {
            // a folder may have been removed or replaced, also by a new one at the same path
            let stays =
                required.contains(&folder.path) && folder.path.is_dir() && folder.identity == identity_of(&folder.path);
            if !stays {
                let _ = watcher.unwatch(&folder.path);
            }
            stays
        });
        let mut all = true;
        for path in required {
            if self.folders.iter().any(|folder| folder.path == path) {
                continue;
            }
            // taken before watching, so a replacement meanwhile is noticed the next time
            let identity = identity_of(&path);
            match watcher.watch(&path, RecursiveMode::NonRecursive) {
                Ok(()) => self.folders.push(WatchedFolder { path, identity }),
                Err(_) => all = false,
            }
        }
        all
    }
}

/// The device and inode numbers of a folder.
type Identity = (u64, u64);

/// Returns the identity of the folder at a path, with links resolved, if the platform has one.
#[cfg(unix)]
fn identity_of(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity_of(_: &Path) -> Option<Identity> {
    None
}

/// Returns whether an event is only a read access, such as that of a check for changes.
fn is_only_read(kind: EventKind) -> bool {
    matches!(kind, EventKind::Access(how) if how != AccessKind::Close(AccessMode::Write))
}

/// Returns the folder of a file and, if it is a link, the folder of its target.
fn folders_of(file: &Path) -> Vec<PathBuf> {
    let folder = |path: &Path| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let behind = file.canonicalize().ok().filter(|_| file.is_symlink());
    std::iter::once(folder(file)).chain(behind.as_deref().map(folder)).collect()
}

#[cfg(test)]
mod tests {
    use super::{SLOW_POLL, Watch};
    use std::fs;
    use std::time::Instant;

    #[test]
    fn a_replaced_file_is_noticed_soon() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.mech");
        fs::write(&file, "1").expect("it is written");
        let mut watch = Watch::new();
        watch.watch_folders(std::slice::from_ref(&file));
        for round in 0..5 {
            let new = folder.path().join("b");
            fs::write(&new, format!("{round}")).expect("it is written");
            fs::rename(&new, &file).expect("it is moved");
            let start = Instant::now();
            watch.wait(std::slice::from_ref(&file));
            assert!(start.elapsed() < SLOW_POLL / 2, "{:?}", start.elapsed());
        }
        // read access is not a change
        while watch.notifications.try_recv().is_ok() {}
        fs::read(&file).expect("it is read");
        let start = Instant::now();
        watch.wait(std::slice::from_ref(&file));
        assert!(start.elapsed() >= SLOW_POLL, "{:?}", start.elapsed());
    }

    /// Checks that a save is noticed within half the polling interval.
    #[cfg(unix)]
    fn check_noticed_soon(watch: &mut Watch, file: &std::path::PathBuf) {
        // earlier notifications do not count
        watch.wait(std::slice::from_ref(file));
        while watch.notifications.try_recv().is_ok() {}
        fs::write(file, "another").expect("it is written");
        let start = Instant::now();
        watch.wait(std::slice::from_ref(file));
        assert!(start.elapsed() < SLOW_POLL / 2, "{:?}", start.elapsed());
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_folder_is_watched_anew() {
        let all = tempfile::tempdir().expect("a folder");
        let [now, next, before, link] = ["now", "next", "before", "link"].map(|name| all.path().join(name));
        for folder in [&now, &next] {
            fs::create_dir(folder).and_then(|()| fs::write(folder.join("a.mech"), "1")).expect("it is made");
        }
        let mut watch = Watch::new();
        let file = now.join("a.mech");
        check_noticed_soon(&mut watch, &file);
        fs::rename(&now, &before).and_then(|()| fs::rename(&next, &now)).expect("they are moved");
        check_noticed_soon(&mut watch, &file);
        // a link whose target changes
        let point = |to| std::os::unix::fs::symlink(to, &link).expect("a link");
        point(&now);
        let file = link.join("a.mech");
        check_noticed_soon(&mut watch, &file);
        fs::remove_file(&link).expect("it is gone");
        point(&before);
        check_noticed_soon(&mut watch, &file);
    }
}
