//! `mechc view FILE`: a page that follows the file, from a server on this machine.

use super::form;
use super::watch::Watch;
use crate::cli::arguments::{Interval, ViewArguments};
use crate::cli::failure::{Failure, is_of_options, unusable};
use crate::cli::files::{self, Disk, Output};
use crate::cli::report::Reporter;
use crate::cli::times;
use crate::cli::{input, interrupts};
use mechc_engine::analysis::Times;
use mechc_live::{Host, Server, Workshop};
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

/// The port that `ssh` goes to by itself.
const USUAL_OF_SSH: &str = "22";
/// A browser has read the file that leads it to the page when it asks for the page, or after this time; and how often that is looked at.
const READ: Duration = Duration::from_secs(10);
const LOOK: Duration = Duration::from_millis(50);

pub(super) fn view(arguments: &ViewArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let given = &arguments.input;
    if given.file == "-" {
        let help = "name a file, or write a page with `-o OUT.html`";
        return Err(unusable("a live page follows a file, and standard input is none").help(help).into());
    }
    if let Some(option) = form::not_of(None, arguments) {
        let help = "add `-o OUT.html` or another file, or leave it out";
        return Err(unusable(format!("`{option}` is for what is written")).help(help).into());
    }
    let redundant = if arguments.allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    refuse_wrong_options(arguments, redundant, reporter)?;
    let desk = Desk { file: given.file.clone(), interval: arguments.interval.clone() };
    let options = (redundant, arguments.pass_bifurcations);
    let choice = Choice { pictures_forces: true, ..input::choice(given) };
    let workshop = Workshop::new(input::path(given), choice, options, Box::new(desk));
    let workshop = Arc::new(workshop);
    let serving = Server::bind(arguments.port.unwrap_or(0)).and_then(|server| {
        let port = server.port();
        Ok((server.serve(&workshop)?, port))
    });
    let (serving, port) = serving.map_err(|error| {
        let port = arguments.port.map_or_else(String::new, |port| format!(" at port {port}"));
        unusable(format!("nothing can listen{port}: {error}")).help("leave `--port` out, or name another one")
    })?;
    files::print(&format!("{}\n", serving.url()))?;
    Reporter::say(&told(&given.file, port));
    if arguments.open {
        open(serving.url(), serving.seen());
    }
    let mut watch = Watch::new();
    loop {
        watch.wait(&workshop.files());
        workshop.look();
    }
}

/// Refuses what is wrong already with the file, its times and what is chosen of it. A text that is wrong may be mended while the page
/// follows it; what the command says stays as it is.
fn refuse_wrong_options(
    arguments: &ViewArguments,
    redundant: Redundant,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let given = &arguments.input;
    // what is not there at the begin is a mistake; what goes later may come back
    let (file, _) = files::read_to_replace(&given.file, &mut reporter.sources)?;
    let interval = &arguments.interval;
    times::asked((interval, &[]), None, &mut reporter.sources)?;
    let parsed = Parsed::of_source(reporter.sources.clone(), file, input::path(given));
    let checked = parsed.check(&input::choice(given), &Disk);
    if parsed.mechanisms().len() > 0 && is_of_options(checked.diagnostics(), checked.sources()) {
        reporter.sources = checked.sources().clone();
        return Err(checked.diagnostics().clone().into());
    }
    // the file says the rest of what an option says
    if [&interval.from, &interval.to, &interval.every].into_iter().any(Option::is_some)
        && let Some(compiled) = checked.compile(redundant, &Cancel::default()).0
    {
        times::asked((interval, &[]), compiled.analysis(), &mut reporter.sources)?.grid()?;
    }
    Ok(())
}

/// What is said beside the address.
fn told(file: &str, port: u16) -> String {
    // what a name holds for a terminal to obey is only shown to be there
    let file = file.replace(char::is_control, "\u{fffd}");
    let mut told = format!("the page follows {file}; Ctrl-C ends it\n");
    // the last words are the address and the port at which this machine was reached
    let ssh = std::env::var("SSH_CONNECTION").unwrap_or_default();
    if let [_, _, host, at] = ssh.split_whitespace().collect::<Vec<_>>().as_slice() {
        let forwarded = format!("{port}:127.0.0.1:{port}");
        let at = if *at == USUAL_OF_SSH { String::new() } else { format!(" -p {at}") };
        told += &format!("from another machine: ssh -N -L {forwarded}{at} {host}, then open the same address there\n");
    }
    told
}

/// The machine's files, and the options of the command.
struct Desk {
    file: String,
    interval: Interval,
}

impl Host for Desk {
    fn world(&self) -> Arc<dyn World> {
        Arc::new(Disk)
    }

    fn times(&self, compiled: &Compiled, sources: &mut Sources) -> Result<Times, Diagnostics> {
        let times =
            times::asked((&self.interval, &[]), compiled.analysis(), sources).and_then(|asked| Ok(asked.grid()?));
        times.map_err(|why| advised(&said(why)))
    }

    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
        let written = Output::replace_if(&self.file, text, is_due);
        written.map_err(|why| said(why).iter().map(|said| said.message.clone()).collect::<Vec<_>>().join("; "))
    }
}

/// Of times that nobody has said: `--at` is for what is written.
fn advised(said: &Diagnostics) -> Diagnostics {
    let mut advised = Diagnostics::default();
    for one in said.iter() {
        let mut one = one.clone();
        if one.code == Code::E0705 {
            let with = "start `mechc view` with `--from T --to T --every H`";
            one.help = vec![format!("add `analysis from 0 s to 1 s every 10 ms` to the file,\nor {with}")];
        }
        advised.push(one);
    }
    advised
}

fn said(why: Failure) -> Diagnostics {
    match why {
        Failure::Said(said) => said,
        Failure::ReaderGone => Diagnostics::default(),
    }
}

/// Opens the browser, in words where that fails. Its address holds the token, and arguments of a process are for all users of a machine to
/// see: so the browser is given a file that only this user can read, and that leads to the page.
fn open(url: &str, is_seen: Arc<AtomicBool>) {
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
        // a browser that begins here goes on when Ctrl-C ends this
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        thread::Builder::new().name("browser".to_owned()).spawn(move || {
            let began = Instant::now();
            let mut ended = None;
            while !is_seen.load(Ordering::Acquire) && began.elapsed() < READ {
                ended = child.try_wait().ok().flatten();
                if ended.is_some_and(|status| !status.success()) {
                    break;
                }
                thread::sleep(LOOK);
            }
            drop(file);
            let ended = ended.or_else(|| child.wait().ok());
            if let Some(status) = ended.filter(|status| !status.success() && !is_seen.load(Ordering::Acquire)) {
                Reporter::say(&format!("the browser does not open: `{}` ended with {status}\n", opener[0]));
            }
        })
    })();
    if let Err(error) = opened {
        Reporter::say(&format!("the browser does not open: {error}\n"));
    }
}
