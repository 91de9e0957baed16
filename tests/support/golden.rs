//! Golden files: a checked-in file must equal what the program writes now.

use std::fs;
use std::path::Path;

/// Checks that a file has this content, or writes it if `UPDATE_GOLDENS` is set.
pub fn holds(path: impl AsRef<Path>, made: &str) {
    let path = path.as_ref();
    let written = fs::read_to_string(path).unwrap_or_default();
    if written != made && std::env::var_os("UPDATE_GOLDENS").is_some() {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).expect("a folder");
        }
        fs::write(path, made).expect("written");
        return;
    }
    assert!(written == made, "{} is not what is made now; UPDATE_GOLDENS=1 cargo test writes it", path.display());
}
