//! The server of `mechc view FILE`, over real connections: who is refused learns nothing and writes nothing, and others are answered all the
//! while. What a browser makes of it is tested in `page/test/browser/live.test.mjs`.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const TEXT: &str = "mechanism disc {
    param speed = 90 deg/s
    ground { point O = (0, 0) }
    body wheel { point O = (0, 0) point P = (20 mm, 0) }
    joint axle: revolute(ground.O, wheel.O)
    driver motor: rotation(axle) = speed * t
    analysis from 0 s to 1 s every 10 ms
}
";

/// A server that follows a file in a folder of its own.
struct Served {
    process: Child,
    folder: tempfile::TempDir,
    port: u16,
    token: String,
}

impl Served {
    fn new() -> Served {
        Served::with(TEXT, &[])
    }

    /// Of a text, with other files beside it.
    fn with(text: &str, beside: &[(&str, &str)]) -> Served {
        let folder = tempfile::tempdir().expect("a folder");
        for &(name, text) in beside {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder"))
                .and_then(|()| fs::write(path, text))
                .expect("it is written");
        }
        let file = folder.path().join("disc.mech");
        fs::write(&file, text).expect("it is written");
        let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
        command.arg("view").arg(&file);
        Served::started(command, folder)
    }

    fn started(mut command: Command, folder: tempfile::TempDir) -> Served {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("it starts");
        let mut url = String::new();
        BufReader::new(process.stdout.as_mut().expect("its output")).read_line(&mut url).expect("an address");
        let (address, token) = url.trim().split_once("/#").expect("a token");
        let port = address.rsplit(':').next().expect("a port").parse().expect("a number");
        Served { process, folder, port, token: token.to_owned() }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("disc.mech")
    }

    fn connection(&self) -> TcpStream {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_secs(120))).expect("a limit");
        stream
    }

    /// What is answered to some bytes, until the connection ends.
    fn answer(&self, sent: &[u8]) -> String {
        let mut stream = self.connection();
        // it may be refused before all of it is sent
        let _ = stream.write_all(sent);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// What is answered to a request with some headers.
    fn asked(&self, line: &str, headers: &[(&str, &str)], body: &str) -> String {
        let headers: String = headers.iter().flat_map(|&(name, value)| [name, ": ", value, "\r\n"]).collect();
        let length = body.len();
        let sent = format!("{line} HTTP/1.1\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n{body}");
        self.answer(sent.as_bytes())
    }

    /// As a page of its own asks.
    fn asked_well(&self, path: &str, body: &str) -> String {
        let host = format!("127.0.0.1:{}", self.port);
        let origin = format!("http://{host}");
        let headers = [("Host", host.as_str()), ("Origin", &origin), ("X-Mechc-Token", &self.token)];
        self.asked(&format!("POST {path}"), &headers, body)
    }

    fn is_well(&self) {
        let answer = self.asked_well("/motion", r#"{"page":"test"}"#);
        assert!(answer.starts_with("HTTP/1.1 200") && answer.contains("wheel.phi"), "{answer}");
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

const WRITE: &str = r#"{"version":1,"changes":[{"name":"speed","old":"90 deg/s","value":1}],"sure":true}"#;

#[test]
fn foreign_pages_have_no_access() {
    let served = Served::new();
    let host = format!("127.0.0.1:{}", served.port);
    let origin = format!("http://{host}");
    let good = [("Host", host.as_str()), ("Origin", origin.as_str()), ("X-Mechc-Token", served.token.as_str())];
    let wrong_token = "0".repeat(served.token.len());
    for path in ["/motion", "/write", "/events"] {
        let line = format!("POST {path}");
        for headers in [
            &[("Host", "evil.example"), good[1], good[2]][..],
            &[("Host", "127.0.0.1"), good[1], good[2]],
            &[good[0], ("Origin", "http://evil.example"), good[2]],
            &[good[0], ("Origin", "null"), good[2]],
            &[good[0], good[2]],
            &[good[0], good[1]],
            &[good[0], good[1], ("X-Mechc-Token", &wrong_token)],
            &[good[0], good[1], ("X-Mechc-Token", "")],
            &[],
        ] {
            let answer = served.asked(&line, headers, WRITE);
            assert!(answer.starts_with("HTTP/1.1 403"), "{path} {headers:?}: {answer}");
            let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
            assert!(body.is_empty(), "{body}");
            assert!(head.contains("nosniff") && head.contains("frame-ancestors 'none'"), "{head}");
            assert!(!head.to_lowercase().contains("access-control"), "{head}");
        }
        let answer = served.asked(&format!("OPTIONS {path}"), &[good[0], ("Origin", "http://evil.example")], "");
        assert!(answer.starts_with("HTTP/1.1 405"), "{answer}");
    }
    assert_eq!(fs::read_to_string(served.file()).expect("it is there"), TEXT);
    served.is_well();
}

#[test]
fn no_file_is_served() {
    let served = Served::new();
    let host = format!("127.0.0.1:{}", served.port);
    for target in ["/..", "/../disc.mech", "/disc.mech", "/%2e%2e/disc.mech", "//etc/passwd", "/./", "/favicon.ico"] {
        let answer = served.asked(&format!("GET {target}"), &[("Host", &host)], "");
        assert!(answer.starts_with("HTTP/1.1 404"), "{target}: {answer}");
    }
    let page = served.asked("GET /", &[("Host", &host)], "");
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("connect-src 'self'"));
    assert!(!page.contains("axle") && !page.contains("disc.mech"), "the page holds something of the text");
}

#[test]
fn long_and_slow_requests_are_ended() {
    let served = Served::new();
    let host = format!("127.0.0.1:{}", served.port);
    let long = served.asked(&format!("GET /{}", "a".repeat(1 << 20)), &[("Host", &host)], "");
    assert!(long.is_empty() || long.starts_with("HTTP/1.1 431"), "{long}");
    let many = served.answer(format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(10_000)).as_bytes());
    assert!(many.is_empty() || many.starts_with("HTTP/1.1 431"), "{many}");
    let body = served.answer(
        format!(
            "POST /write HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nX-Mechc-Token: {}\r\nContent-Length: 99999999999\r\n\r\n",
            served.token
        )
        .as_bytes(),
    );
    assert!(body.starts_with("HTTP/1.1 413"), "{body}");
    // a byte now and then does not keep a connection
    let mut slow = served.connection();
    let began = Instant::now();
    for byte in b"GET / HTTP/1.1\r\nHost: 127".iter().cycle() {
        if slow.write_all(&[*byte]).is_err() || began.elapsed() > Duration::from_secs(240) {
            break;
        }
        std::thread::sleep(Duration::from_millis(200));
        served_is_quick(&served);
    }
    assert!(began.elapsed() < Duration::from_secs(240), "{:?}", began.elapsed());
}

fn served_is_quick(served: &Served) {
    let began = Instant::now();
    served.is_well();
    assert!(began.elapsed() < Duration::from_secs(120));
}

#[test]
fn the_server_survives_many_connections() {
    let served = Served::new();
    let held: Vec<TcpStream> =
        (0..1000).filter_map(|_| TcpStream::connect((Ipv4Addr::LOCALHOST, served.port)).ok()).collect();
    assert!(held.len() > 64, "{}", held.len());
    // those that are beyond its number are sent away at once
    let ended = held.iter().rev().take(100).filter(|stream| {
        let mut stream: &TcpStream = stream;
        stream.set_read_timeout(Some(Duration::from_secs(5))).expect("a limit");
        matches!(stream.read(&mut [0; 1]), Ok(0) | Err(_))
    });
    assert_eq!(ended.count(), 100);
    drop(held);
    let began = Instant::now();
    while !served.asked_well("/motion", r#"{"page":"a"}"#).starts_with("HTTP/1.1 200") {
        assert!(began.elapsed() < Duration::from_secs(120), "it does not come back");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn the_server_listens_locally() {
    let served = Served::new();
    let listening = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let port = format!(":{:04X} ", served.port);
    let both = listening("/proc/net/tcp") + &listening("/proc/net/tcp6");
    let local: Vec<&str> = both
        .lines()
        .filter_map(|line| line.split_whitespace().nth(1).filter(|_| line.contains(" 0A ")))
        .filter(|local| format!("{local} ").contains(&port))
        .collect();
    for address in &local {
        assert!(
            address.starts_with("0100007F:") || address.starts_with("00000000000000000000000001000000:"),
            "{address}"
        );
    }
    if TcpStream::connect_timeout(&SocketAddr::from((Ipv6Addr::LOCALHOST, served.port)), Duration::from_secs(1)).is_ok()
    {
        let host = format!("[::1]:{}", served.port);
        let mut stream = TcpStream::connect((Ipv6Addr::LOCALHOST, served.port)).expect("it listens");
        write!(stream, "GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").expect("it is sent");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("an answer");
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }
}

#[test]
fn values_are_written_with_their_unit_and_once_for_a_version() {
    let served = Served::new();
    let answer = served.asked_well("/write", WRITE);
    assert!(answer.contains(r#"{"written":true}"#), "{answer}");
    assert_eq!(fs::read_to_string(served.file()).expect("it is there"), TEXT.replace("90 deg/s", "1 deg/s"));
    let again = served.asked_well("/write", WRITE);
    assert!(again.contains("another by now"), "{again}");
    let files: Vec<_> = fs::read_dir(served.folder.path()).expect("a folder").collect();
    assert_eq!(files.len(), 1, "{files:?}");
}

#[test]
fn invalid_edits_are_not_written() {
    let text = TEXT.replace("    ground", "    param wheels = 2\n    ground").replace("wheel {", "more[k in 0..wheels] { point O = (0, 0) }\n    joint fixed[k in 0..wheels]: weld(ground.O, more[k].O)\n    body wheel {");
    let served = Served::with(&text, &[]);
    let write = |value: &str| {
        let body = format!(r#"{{"version":1,"changes":[{{"name":"wheels","old":"2","value":{value}}}],"sure":true}}"#);
        served.asked_well("/write", &body)
    };
    let answer = write("2.5");
    assert!(answer.contains("the text would be wrong") && answer.contains("whole number"), "{answer}");
    assert_eq!(fs::read_to_string(served.file()).expect("it is there"), text);
    let answer = write("3");
    assert!(answer.contains(r#"{"written":true}"#), "{answer}");
}

#[test]
fn ssh_sessions_print_port_forwarding() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("disc.mech");
    fs::write(&file, TEXT).expect("it is written");
    for (connection, wanted) in [
        ("192.0.2.1 50022 192.0.2.7 22", Some(" 192.0.2.7,")),
        ("2001:db8::1 50022 2001:db8::7 2222", Some(" -p 2222 2001:db8::7,")),
        ("", None),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
        command.arg("view").arg(&file).env("SSH_CONNECTION", connection);
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
        let mut url = String::new();
        BufReader::new(process.stdout.take().expect("its output")).read_line(&mut url).expect("an address");
        let port = url.trim_start_matches("http://127.0.0.1:").split('/').next().unwrap_or_default();
        let mut diagnostics = BufReader::new(process.stderr.take().expect("what it says"));
        let (mut follows, mut forwards) = (String::new(), String::new());
        diagnostics.read_line(&mut follows).expect("a line");
        assert!(follows.starts_with("the page follows "), "{follows}");
        if let Some(wanted) = wanted {
            diagnostics.read_line(&mut forwards).expect("a line");
            let line = format!("from another machine: ssh -N -L {port}:127.0.0.1:{port}{wanted}");
            assert!(forwards.starts_with(&line), "{forwards}");
        }
        process.kill().and_then(|()| process.wait()).expect("it ends");
        diagnostics.read_to_string(&mut forwards).expect("its end");
        assert_eq!(forwards.lines().count(), usize::from(wanted.is_some()), "{forwards}");
    }
}

#[test]
fn unsupported_live_options_are_refused() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/slider_crank.mech");
    for options in [&["-"][..], &[file, "--labels"], &[file, "--vary", "rod_length=1mm..2mm:3"], &[file, "--at", "0"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
        let output = command.arg("view").args(options).stdin(Stdio::null()).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(output.stdout.is_empty());
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    let output = command.args(["view", "there_is_none.mech"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(4));
}

#[cfg(target_os = "linux")]
impl Served {
    /// How long the process has worked (ticks).
    fn worked(&self) -> u64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("it runs");
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        fields[11].parse::<u64>().expect("a number") + fields[12].parse::<u64>().expect("a number")
    }

    /// Waits until it rests: it works no more over a while.
    fn comes_to_rest(&self) {
        let began = Instant::now();
        loop {
            let before = self.worked();
            std::thread::sleep(Duration::from_secs(1));
            if self.worked() - before <= 2 {
                return;
            }
            assert!(began.elapsed() < Duration::from_secs(240), "it works on for nobody");
        }
    }
}

/// A motion that takes minutes.
#[cfg(target_os = "linux")]
fn endless() -> String {
    TEXT.replace("every 10 ms", "every 0.001 ms").replace("to 1 s", "to 100 s")
}

#[cfg(target_os = "linux")]
#[test]
fn abandoned_requests_are_dropped() {
    let served = Served::with(&endless(), &[]);
    let ask = |body: &str| {
        let mut stream = served.connection();
        let host = format!("127.0.0.1:{}", served.port);
        let token = &served.token;
        let head = format!("Host: {host}\r\nOrigin: http://{host}\r\nX-Mechc-Token: {token}");
        write!(stream, "POST /motion HTTP/1.1\r\n{head}\r\nContent-Length: {}\r\n\r\n{body}", body.len())
            .expect("it is sent");
        stream
    };
    let works = || {
        let before = served.worked();
        std::thread::sleep(Duration::from_secs(2));
        served.worked() - before > 5
    };
    // the page is closed
    let first = ask(r#"{"page":"a"}"#);
    assert!(works(), "it does not take long");
    drop(first);
    served.comes_to_rest();
    // of two pages one is closed
    let (first, second) = (ask(r#"{"page":"a"}"#), ask(r#"{"page":"b"}"#));
    assert!(works());
    drop(first);
    std::thread::sleep(Duration::from_millis(500));
    assert!(works(), "the other one waits for it");
    // another text is saved
    fs::write(served.file(), TEXT).expect("it is written");
    served.comes_to_rest();
    drop(second);
    served.is_well();
}

#[test]
fn invalid_options_are_refused_at_the_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("disc.mech");
    fs::write(&file, TEXT).expect("it is written");
    let started = |options: &[&str], file: &std::path::Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
        let mut process = command
            .arg("view")
            .arg(file)
            .args(options)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        let mut line = String::new();
        BufReader::new(process.stdout.take().expect("its output")).read_line(&mut line).expect("a line, or its end");
        if !line.is_empty() {
            let _ = process.kill();
        }
        (line, process.wait().expect("it ends").code())
    };
    for (options, code) in [
        (&["--mechanism", "zzz"][..], 2),
        (&["--set", "nope=1"], 2),
        (&["--set", "speed=1 mm"], 2),
        (&["--input", "q=1"], 2),
        (&["--samples", "there_is_none.csv"], 4),
        (&["--theme", "dark"], 2),
        (&["--from", "2 s", "--to", "1 s"], 2),
        (&["--from", "2 s"], 2),
        (&["--every", "0 s"], 2),
    ] {
        assert_eq!(started(options, &file), (String::new(), Some(code)), "{options:?}");
    }
    // a text that is wrong may be mended
    fs::write(&file, TEXT.replace("wheel.O)", "wheel.Z)")).expect("it is written");
    assert!(started(&[], &file).0.starts_with("http://"));
    assert!(started(&["--set", "speed=1 rpm"], &file).0.starts_with("http://"));
    fs::write(&file, "").expect("it is written");
    assert!(started(&[], &file).0.starts_with("http://"));
    assert_eq!(started(&[], folder.path()), (String::new(), Some(4)));
    #[cfg(unix)]
    {
        let pipe = folder.path().join("pipe.mech");
        let made = Command::new("mkfifo").arg(&pipe).status().expect("it runs");
        assert!(made.success());
        assert_eq!(started(&[], &pipe), (String::new(), Some(4)));
    }
}

#[cfg(unix)]
#[test]
fn the_owner_of_a_file_stays() {
    use std::os::unix::fs::{MetadataExt, chown};
    let served = Served::new();
    // only who may do so can give a file away
    if chown(served.file(), Some(12345), Some(12346)).is_err() {
        return;
    }
    let answer = served.asked_well("/write", WRITE);
    assert!(answer.contains(r#"{"written":true}"#), "{answer}");
    let found = fs::metadata(served.file()).expect("it is there");
    assert_eq!((found.uid(), found.gid()), (12345, 12346));
}

#[cfg(unix)]
#[test]
fn writes_keep_the_file_mode_under_any_mask() {
    use std::os::unix::fs::PermissionsExt;
    for (mask, mode) in [("022", 0o664), ("077", 0o644), ("077", 0o2775), ("022", 0o600), ("000", 0o640)] {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("disc.mech");
        fs::write(&file, TEXT).expect("it is written");
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).expect("a mode");
        let mut command = Command::new("sh");
        let script = format!("umask {mask}; exec \"$0\" view \"$1\"");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_mechc")]).arg(&file);
        let served = Served::started(command, folder);
        let answer = served.asked_well("/write", WRITE);
        assert!(answer.contains(r#"{"written":true}"#), "{answer}");
        let found = fs::metadata(served.file()).expect("it is there").permissions().mode() & 0o7777;
        assert_eq!(found, mode, "mask {mask}: {found:o} in the place of {mode:o}");
    }
}

/// What is said beside the address of a file with a name, by a command with options and a browser that ends with a code.
#[cfg(unix)]
fn said_of(name: &str, options: &[&str], code: u8, wanted: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let (file, opener) = (folder.path().join(name), folder.path().join("xdg-open"));
    fs::write(&file, TEXT).expect("it is written");
    fs::write(&opener, format!("#!/bin/sh\nexit {code}\n")).expect("it is written");
    fs::set_permissions(&opener, fs::Permissions::from_mode(0o755)).expect("it can run");
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.arg("view").arg(&file).args(options).env("PATH", path).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut process = command.spawn().expect("it starts");
    let mut diagnostics = String::new();
    for line in BufReader::new(process.stderr.take().expect("its messages")).lines() {
        diagnostics += &line.expect("a text");
        diagnostics += "\n";
        if diagnostics.contains(wanted) {
            break;
        }
    }
    let _ = process.kill();
    let _ = process.wait();
    diagnostics
}

#[cfg(unix)]
#[test]
fn a_browser_that_does_not_open_is_reported() {
    let diagnostics = said_of("disc.mech", &["--open"], 3, "browser");
    assert!(diagnostics.contains("the browser does not open: `xdg-open` ended with exit status: 3"), "{diagnostics}");
}

#[cfg(unix)]
#[test]
fn a_name_gives_no_orders_to_a_terminal() {
    let diagnostics = said_of("a\u{1b}[31mb.mech", &[], 0, "Ctrl-C");
    assert!(!diagnostics.contains('\u{1b}') && diagnostics.contains("a\u{fffd}[31mb.mech"), "{diagnostics:?}");
}

#[test]
fn refused_options_are_not_suggested() {
    let served = Served::with(&TEXT.replace("    analysis from 0 s to 1 s every 10 ms\n", ""), &[]);
    let answer = served.asked_well("/motion", r#"{"page":"test"}"#);
    assert!(answer.contains("E0705") && answer.contains("--from T"), "{answer}");
    assert!(!answer.contains("--at"), "{answer}");
}

#[cfg(unix)]
#[test]
fn the_redirect_file_is_removed_after_use() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let (file, bin, scratch) = ["disc.mech", "bin", "scratch"].map(|name| folder.path().join(name)).into();
    fs::write(&file, TEXT).expect("it is written");
    fs::create_dir(&bin).and_then(|()| fs::create_dir(&scratch)).expect("folders");
    // a browser that does nothing
    let opener = bin.join("xdg-open");
    fs::write(&opener, "#!/bin/sh\nexit 0\n").expect("it is written");
    fs::set_permissions(&opener, fs::Permissions::from_mode(0o755)).expect("it can run");
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.arg("view").arg(&file).arg("--open").env("PATH", path).env("TMPDIR", &scratch);
    let served = Served::started(command, folder);
    let files = || fs::read_dir(&scratch).expect("a folder").count();
    let began = Instant::now();
    while files() == 0 {
        assert!(began.elapsed() < Duration::from_secs(120), "there is none");
        std::thread::sleep(Duration::from_millis(5));
    }
    let came = Instant::now();
    let page = served.asked("GET /", &[("Host", &format!("127.0.0.1:{}", served.port))], "");
    assert!(page.starts_with("HTTP/1.1 200"));
    while files() > 0 {
        assert!(came.elapsed() < Duration::from_secs(120), "it is there still");
        std::thread::sleep(Duration::from_millis(20));
    }
}
