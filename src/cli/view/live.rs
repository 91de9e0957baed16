//! `mechc view FILE`: serves a live page that follows the file.

use super::form;
use super::watch::Watch;
use crate::cli::arguments::{Interval, ViewArguments};
use crate::cli::failure::{Failure, concerns_options, unusable};
use crate::cli::files::{self, Disk, Output};
use crate::cli::report::Reporter;
use crate::cli::{input, interrupts};
use mechc_engine::analysis::Times;
use mechc_live::{Host, LiveSession, Server};
use mechc_pipeline::{Choice, Compiled, Parsed, Redundant};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostics};
use mechc_text::source::Sources;
use mechc_text::world::World;
use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// The default port of `ssh`.
const SSH_PORT: &str = "22";
/// The time that the browser has to request the page.
const BROWSER_TIMEOUT: Duration = Duration::from_secs(10);
/// The interval of checks whether it has.
const BROWSER_CHECK: Duration = Duration::from_millis(50);

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let input = &arguments.input;
    if input.file == "-" {
        let help = "name a file, or write a page with `-o OUT.html`";
        return Err(unusable("a live page follows a file, and standard input is none").help(help).into());
    }
    if let Some(option) = form::unsupported_option(None, arguments) {
        let help = "add `-o OUT.html` or another file, or leave it out";
        return Err(unusable(format!("`{option}` is for what is written")).help(help).into());
    }
    let redundant = if arguments.allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    refuse_wrong_options(arguments, redundant, reporter)?;
    let host = CommandHost { file: input.file.clone(), interval: arguments.interval.clone() };
    let choice = Choice { pictures_forces: true, ..input::choice(input) };
    let pass_bifurcations = arguments.pass_bifurcations;
    let session = LiveSession::new(input::path(input), choice, redundant, pass_bifurcations, Box::new(host));
    let session = Arc::new(session);
    let server = Server::bind(arguments.port.unwrap_or(0)).and_then(|server| {
        let port = server.port();
        Ok((server.serve(&session)?, port))
    });
    let (server, port) = server.map_err(|error| {
        let port = arguments.port.map_or_else(String::new, |port| format!(" at port {port}"));
        unusable(format!("nothing can listen{port}: {error}")).help("leave `--port` out, or name another one")
    })?;
    files::print(&format!("{}\n", server.url()))?;
    Reporter::print_text(&introduction(&input.file, port));
    if arguments.open {
        open(server.url(), server.page_requested());
    }
    let mut watch = Watch::new();
    loop {
        watch.wait(&session.files());
        session.reload();
    }
}

/// Refuses errors of the command: a missing file, invalid times and settings. Errors of the text may be corrected while the page follows
/// it.
fn refuse_wrong_options(
    arguments: &ViewArguments,
    redundant: Redundant,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let input = &arguments.input;
    // a file that is missing at the start is an error; one that disappears later may come back
    let (file, _) = files::read_to_replace(&input.file, &mut reporter.sources)?;
    let interval = &arguments.interval;
    input::requested_times(interval, &[], None, &mut reporter.sources)?;
    let parsed = Parsed::from_source(reporter.sources.clone(), file, input::path(input));
    let checked = parsed.check(&input::choice(input), &Disk);
    if parsed.mechanisms().len() > 0 && concerns_options(checked.diagnostics(), checked.sources()) {
        reporter.sources = checked.sources().clone();
        return Err(checked.diagnostics().clone().into());
    }
    // an option may depend on the times of the file
    if [&interval.from, &interval.to, &interval.every].into_iter().any(Option::is_some)
        && let Some(compiled) = checked.compile(redundant, &Cancel::default()).0
    {
        input::requested_times(interval, &[], compiled.analysis(), &mut reporter.sources)?.grid()?;
    }
    Ok(())
}

/// Returns the text printed with the address.
fn introduction(file: &str, port: u16) -> String {
    // a name must not contain control sequences for the terminal
    let file = file.replace(char::is_control, "\u{fffd}");
    let mut text = format!("the page follows {file}; Ctrl-C ends it\n");
    // the last two words are the address and the port of this machine
    let ssh = std::env::var("SSH_CONNECTION").unwrap_or_default();
    if let [_, _, host, at] = ssh.split_whitespace().collect::<Vec<_>>().as_slice() {
        let forwarded = format!("{port}:127.0.0.1:{port}");
        let at = if *at == SSH_PORT { String::new() } else { format!(" -p {at}") };
        text += &format!("from another machine: ssh -N -L {forwarded}{at} {host}, then open the same address there\n");
    }
    text
}

/// The command line as the host of a page: the files of this machine, and the command's options.
struct CommandHost {
    file: String,
    interval: Interval,
}

impl Host for CommandHost {
    fn world(&self) -> Arc<dyn World> {
        Arc::new(Disk)
    }

    fn times(&self, compiled: &Compiled, sources: &mut Sources) -> Result<Times, Diagnostics> {
        let times = input::requested_times(&self.interval, &[], compiled.analysis(), sources)
            .and_then(|times| Ok(times.grid()?));
        times.map_err(|why| with_advice(&why.into_diagnostics()))
    }

    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
        let written = Output::replace_if(&self.file, text, is_due);
        written.map_err(|why| {
            why.into_diagnostics().iter().map(|diagnostic| diagnostic.message.clone()).collect::<Vec<_>>().join("; ")
        })
    }
}

/// Replaces the help of a diagnostic about missing times, which suggests `--at`: a live page does not have this option.
fn with_advice(diagnostics: &Diagnostics) -> Diagnostics {
    let mut all = Diagnostics::default();
    for one in diagnostics.iter() {
        let mut one = one.clone();
        if one.code == Code::E0705 {
            let with = "start `mechc view` with `--from T --to T --every H`";
            one.help = vec![format!("add `analysis from 0 s to 1 s every 10 ms` to the file,\nor {with}")];
        }
        all.push(one);
    }
    all
}

/// Opens the browser, and prints an error if that fails. The address contains the token, and all users of a machine can see the arguments
/// of a process; so the browser gets a file that only this user can read and that redirects to the page.
fn open(url: &str, page_requested: Arc<AtomicBool>) {
    const OPENERS: [&[&str]; 3] = [&["xdg-open"], &["open"], &["cmd", "/c", "start", ""]];
    let opener = match std::env::consts::OS {
        "macos" => OPENERS[1],
        "windows" => OPENERS[2],
        _ => OPENERS[0],
    };
    let opened = (|| {
        let mut unfinished = interrupts::unfinished();
        let mut file = tempfile::Builder::new().prefix("mechc-").suffix(".html").tempfile()?;
        unfinished.push(file.path().to_owned());
        drop(unfinished);
        write!(file, "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url={url}\">")?;
        let mut command = Command::new(opener[0]);
        command.args(&opener[1..]).arg(file.path()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        // Ctrl-C must not end a browser that is started here
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        thread::Builder::new().name("browser".to_owned()).spawn(move || {
            let start = Instant::now();
            let mut exit = None;
            while !page_requested.load(Ordering::Acquire) && start.elapsed() < BROWSER_TIMEOUT {
                exit = child.try_wait().ok().flatten();
                if exit.is_some_and(|status| !status.success()) {
                    break;
                }
                thread::sleep(BROWSER_CHECK);
            }
            drop(file);
            let exit = exit.or_else(|| child.wait().ok());
            if let Some(status) = exit.filter(|status| !status.success() && !page_requested.load(Ordering::Acquire)) {
                Reporter::print_text(&format!("the browser does not open: `{}` ended with {status}\n", opener[0]));
            }
        })
    })();
    if let Err(error) = opened {
        Reporter::print_text(&format!("the browser does not open: {error}\n"));
    }
}
