//! The progress bar on a terminal, for runs that take more than a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The time before a bar appears.
const DELAY: Duration = Duration::from_secs(1);
/// The number of rows between updates in long runs.
const ROWS: u64 = 64;

pub(super) struct Progress {
    /// The unit that is counted, such as `times`.
    what: &'static str,
    total: u64,
    done: u64,
    is_enabled: bool,
    start: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Creates a bar for a number of rows. It is not drawn if the rows themselves go to the terminal.
    pub fn new(total: u64, to_standard_output: bool) -> Progress {
        Progress::counting("times", total, to_standard_output)
    }

    /// Creates a bar for a number of other units.
    pub fn counting(what: &'static str, total: u64, to_standard_output: bool) -> Progress {
        let rows_on_terminal = to_standard_output && std::io::stdout().is_terminal();
        let is_enabled = std::io::stderr().is_terminal() && !rows_on_terminal;
        Progress { what, total, done: 0, is_enabled, start: Instant::now(), bar: None }
    }

    /// Counts a row.
    pub fn tick(&mut self) {
        self.done += 1;
        let often = self.total < 100 * ROWS;
        if often || self.done.is_multiple_of(ROWS) {
            self.draw();
        }
    }

    /// Counts several units at once.
    pub fn advance(&mut self, count: u64) {
        self.done += count;
        self.draw();
    }

    fn draw(&mut self) {
        if !self.is_enabled {
            return;
        }
        match &self.bar {
            Some(bar) => bar.set_position(self.done),
            None if self.start.elapsed() > DELAY => {
                let bar = ProgressBar::new(self.total);
                let template =
                    format!("{{bar:40}} {{human_pos}} of {{human_len}} {}, {{per_sec}}, {{eta}} left", self.what);
                if let Ok(style) = ProgressStyle::with_template(&template) {
                    bar.set_style(style);
                }
                self.bar = Some(bar.with_elapsed(self.start.elapsed()).with_position(self.done));
            }
            None => {}
        }
    }

    /// Removes the bar from the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
