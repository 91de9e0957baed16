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
    folders: Vec<PathBuf>,
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
            // one that is gone may come back as another
            let stays = wanted.contains(folder) && folder.is_dir();
            if !stays {
                let _ = watcher.unwatch(folder);
            }
            stays
        });
        let mut all = true;
        for folder in wanted {
            if self.folders.contains(&folder) {
                continue;
            }
            match watcher.watch(&folder, RecursiveMode::NonRecursive) {
                Ok(()) => self.folders.push(folder),
                Err(_) => all = false,
            }
        }
        all
    }
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
}
