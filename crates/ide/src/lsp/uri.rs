//! Conversion between paths of files and URIs.
//!
//! It works on text alone, so that it is the same on every platform: a path has `/` and may begin with a drive.

use std::path::{Path, PathBuf};

/// Converts a URI to a path. A URI of another scheme (`untitled:…`) becomes a path of its own text.
pub(super) fn path_of(uri: &str) -> PathBuf {
    let Some(rest) = strip_scheme(uri) else {
        return PathBuf::from(uri);
    };
    let rest = rest.split(['?', '#']).next().unwrap_or(rest);
    let (host, path) = match rest.strip_prefix("//") {
        Some(rest) => rest.split_at(rest.find('/').unwrap_or(rest.len())),
        None => ("", rest),
    };
    let path = decoded(path);
    let is_here = host.is_empty() || host.eq_ignore_ascii_case("localhost");
    match path.strip_prefix('/').and_then(with_drive) {
        Some(path) => PathBuf::from(path),
        None if is_here => PathBuf::from(path),
        // another host means a network share
        None => PathBuf::from(format!("//{}{path}", decoded(host))),
    }
}

/// Converts an absolute path to a URI.
pub(super) fn uri_of(path: &Path) -> String {
    let text = path.to_string_lossy();
    let text = if cfg!(windows) { text.replace('\\', "/") } else { text.into_owned() };
    // Windows has a long form for shares and another for other paths
    let share = text.strip_prefix("//?/UNC/");
    let text = text.strip_prefix("//?/").unwrap_or(&text);
    match (share.or_else(|| text.strip_prefix("//")), with_drive(text)) {
        (Some(share), _) => format!("file://{}", encoded(share)),
        (None, Some(path)) => format!("file:///{}", encoded(&path)),
        (None, None) => format!("file://{}", encoded(text)),
    }
}

fn strip_scheme(uri: &str) -> Option<&str> {
    let (scheme, rest) = uri.split_once(':')?;
    scheme.eq_ignore_ascii_case("file").then_some(rest)
}

/// Returns a path that begins with a drive, with the letter in upper case.
fn with_drive(path: &str) -> Option<String> {
    let mut chars = path.chars();
    let letter = chars.next().filter(char::is_ascii_alphabetic)?;
    let rest = chars.as_str().strip_prefix(':')?;
    (rest.is_empty() || rest.starts_with('/')).then(|| format!("{}:{rest}", letter.to_ascii_uppercase()))
}

/// Decodes percent encoding; an invalid sequence stays as it is.
fn decoded(text: &str) -> String {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let is_hex = |two: &&str| two.bytes().all(|digit| digit.is_ascii_hexdigit());
        let byte = digits.filter(|two| first == b'%' && is_hex(two)).and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(byte.unwrap_or(first));
        rest = &rest[if byte.is_some() { 3 } else { 1 }..];
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn encoded(text: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    text.bytes()
        .map(|byte| if is_plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{path_of, uri_of};
    use std::path::Path;

    #[track_caller]
    fn both_ways(uri: &str, path: &str) {
        assert_eq!(path_of(uri), Path::new(path));
        assert_eq!(uri_of(Path::new(path)), uri);
    }

    #[track_caller]
    fn reads(uri: &str, path: &str) {
        assert_eq!(path_of(uri), Path::new(path));
    }

    #[test]
    fn paths_and_uris_round_trip() {
        both_ways("file:///home/ann/four_bar.mech", "/home/ann/four_bar.mech");
        both_ways("file:///home/ann/my%20files/100%25%20%23%3F.mech", "/home/ann/my files/100% #?.mech");
        both_ways("file:///tmp/%C3%9Cbung/%F0%9D%9B%BC.mech", "/tmp/Übung/𝛼.mech");
        both_ways("file:///C%3A/Users/Ann/a.mech", "C:/Users/Ann/a.mech");
        both_ways("file://server/share/a.mech", "//server/share/a.mech");
    }

    #[test]
    fn other_forms_are_read() {
        reads("file:///c%3A/Users/Ann/a.mech", "C:/Users/Ann/a.mech");
        reads("file:///c:/a.mech", "C:/a.mech");
        reads("file:/home/a.mech", "/home/a.mech");
        reads("FILE://localhost/home/a.mech", "/home/a.mech");
        reads("file:///a.mech?version=1#L3", "/a.mech");
        reads("file:///100%/%zz.mech", "/100%/%zz.mech");
        reads("untitled:Untitled-1", "untitled:Untitled-1");
        reads("vscode-vfs://github/a/b.mech", "vscode-vfs://github/a/b.mech");
    }

    #[test]
    fn long_forms_are_those_of_the_plain_path() {
        assert_eq!(uri_of(Path::new("//?/C:/a.mech")), "file:///C%3A/a.mech");
        assert_eq!(uri_of(Path::new("//?/UNC/server/share/a.mech")), "file://server/share/a.mech");
    }

    #[test]
    fn names_keep_their_case_and_their_form() {
        // whether composed and decomposed names are the same file depends on the file system
        both_ways("file:///a/%C3%A9.mech", "/a/é.mech");
        both_ways("file:///a/e%CC%81.mech", "/a/e\u{301}.mech");
        both_ways("file:///a/A.MECH", "/a/A.MECH");
    }

    #[test]
    fn long_paths_are_paths() {
        let path = format!("/{}/a.mech", vec!["folder"; 1_000].join("/"));
        assert_eq!(path_of(&uri_of(Path::new(&path))), Path::new(&path));
        assert_eq!(uri_of(Path::new("//?/C:/a.mech")), "file:///C%3A/a.mech");
    }
}
