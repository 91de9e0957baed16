//! Waiting until a file may be another: told by the system where it tells, and looking again and again where it does not.

use notify::event::{AccessKind, AccessMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// So often files are looked at that nobody tells of.
const POLL: Duration = Duration::from_millis(100);
/// So often files are looked at all the same: a network's disk tells nothing of what others do.
const SELDOM: Duration = Duration::from_secs(1);
/// Who writes a file in steps is given so long.
const SETTLE: Duration = Duration::from_millis(8);

/// What is watched: folders, for a file that is replaced is another one in the same folder.
pub(super) struct Watch {
    watcher: Option<RecommendedWatcher>,
    told: Receiver<()>,
    folders: Vec<Watched>,
}

/// A folder that is watched.
struct Watched {
    path: PathBuf,
    /// What was at that path then.
    identity: Option<Identity>,
}

impl Watch {
    pub fn new() -> Watch {
        let (tell, told) = channel();
        let watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
            if event.is_ok_and(|event| is_only_read(event.kind)) {
                return;
            }
            // nobody waits any more when the process ends
            let _ = tell.send(());
        });
        Watch { watcher: watcher.ok(), told, folders: Vec::new() }
    }

    /// Waits until one of some files may have changed. Folders are watched from then on, so that who looks at the files after this has
    /// missed nothing that will not be told.
    pub fn wait(&mut self, files: &[PathBuf]) {
        let is_told = self.turn_to(files);
        match self.told.recv_timeout(if is_told { SELDOM } else { POLL }) {
            Ok(()) => {
                thread::sleep(SETTLE);
                while self.told.try_recv().is_ok() {}
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => thread::sleep(POLL),
        }
    }

    /// Watches the folders of some files; says whether all of them are.
    fn turn_to(&mut self, files: &[PathBuf]) -> bool {
        let Some(watcher) = &mut self.watcher else { return false };
        let mut wanted: Vec<PathBuf> = files.iter().flat_map(|file| folders_of(file)).collect();
        wanted.sort();
        wanted.dedup();
        self.folders.retain(|folder| {
            // one that is gone may come back as another, or another one be in its place by now
            let stays =
                wanted.contains(&folder.path) && folder.path.is_dir() && folder.identity == identity_of(&folder.path);
            if !stays {
                let _ = watcher.unwatch(&folder.path);
            }
            stays
        });
        let mut all = true;
        for path in wanted {
            if self.folders.iter().any(|folder| folder.path == path) {
                continue;
            }
            // before it is watched: what takes its place meanwhile is seen the next time
            let identity = identity_of(&path);
            match watcher.watch(&path, RecursiveMode::NonRecursive) {
                Ok(()) => self.folders.push(Watched { path, identity }),
                Err(_) => all = false,
            }
        }
        all
    }
}

/// The number of a folder on a disk, and the number of that.
type Identity = (u64, u64);

/// What is at a path, behind links, where the system numbers it.
#[cfg(unix)]
fn identity_of(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity_of(_: &Path) -> Option<Identity> {
    None
}

/// Whether somebody has only looked at a file, as who looks whether it has changed does.
fn is_only_read(kind: EventKind) -> bool {
    matches!(kind, EventKind::Access(how) if how != AccessKind::Close(AccessMode::Write))
}

/// The folder of a file, and where it is a link, that of what it leads to.
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
    use super::{SELDOM, Watch};
    use std::fs;
    use std::time::Instant;

    #[test]
    fn a_file_that_is_replaced_is_told_soon() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.mech");
        fs::write(&file, "1").expect("it is written");
        let mut watch = Watch::new();
        watch.turn_to(std::slice::from_ref(&file));
        for round in 0..5 {
            let beside = folder.path().join("b");
            fs::write(&beside, format!("{round}")).expect("it is written");
            fs::rename(&beside, &file).expect("it is moved");
            let began = Instant::now();
            watch.wait(std::slice::from_ref(&file));
            assert!(began.elapsed() < SELDOM / 2, "{:?}", began.elapsed());
        }
        // what is only read is no news
        while watch.told.try_recv().is_ok() {}
        fs::read(&file).expect("it is read");
        let began = Instant::now();
        watch.wait(std::slice::from_ref(&file));
        assert!(began.elapsed() >= SELDOM, "{:?}", began.elapsed());
    }

    /// What is told of a save in a folder, within the time that is nobody's patience.
    #[cfg(unix)]
    fn is_told_soon(watch: &mut Watch, file: &std::path::PathBuf) {
        // of what has been done until now
        watch.wait(std::slice::from_ref(file));
        while watch.told.try_recv().is_ok() {}
        fs::write(file, "another").expect("it is written");
        let began = Instant::now();
        watch.wait(std::slice::from_ref(file));
        assert!(began.elapsed() < SELDOM / 2, "{:?}", began.elapsed());
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_that_another_one_replaces_is_watched_anew() {
        let all = tempfile::tempdir().expect("a folder");
        let [now, next, before, link] = ["now", "next", "before", "link"].map(|name| all.path().join(name));
        for folder in [&now, &next] {
            fs::create_dir(folder).and_then(|()| fs::write(folder.join("a.mech"), "1")).expect("it is made");
        }
        let mut watch = Watch::new();
        let file = now.join("a.mech");
        is_told_soon(&mut watch, &file);
        fs::rename(&now, &before).and_then(|()| fs::rename(&next, &now)).expect("they are moved");
        is_told_soon(&mut watch, &file);
        // and a link that leads elsewhere
        let point = |to| std::os::unix::fs::symlink(to, &link).expect("a link");
        point(&now);
        let file = link.join("a.mech");
        is_told_soon(&mut watch, &file);
        fs::remove_file(&link).expect("it is gone");
        point(&before);
        is_told_soon(&mut watch, &file);
    }
}
