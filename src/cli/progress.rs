//! A progress bar on a terminal, for runs that take more than a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// How long a run stays without a bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// Rows between two looks at the clock, where there are many.
const ROWS: u64 = 64;

pub(super) struct Progress {
    /// What is counted, as `times`.
    what: &'static str,
    total: u64,
    done: u64,
    wanted: bool,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// For so many rows; none is drawn where the rows themselves go to the terminal.
    pub fn new(total: u64, to_standard_output: bool) -> Progress {
        Progress::of("times", total, to_standard_output)
    }

    /// For so many of anything.
    pub fn of(what: &'static str, total: u64, to_standard_output: bool) -> Progress {
        let rows_on_terminal = to_standard_output && std::io::stdout().is_terminal();
        let wanted = std::io::stderr().is_terminal() && !rows_on_terminal;
        Progress { what, total, done: 0, wanted, began: Instant::now(), bar: None }
    }

    /// A row is done.
    pub fn tick(&mut self) {
        self.done += 1;
        let often = self.total < 100 * ROWS;
        if often || self.done.is_multiple_of(ROWS) {
            self.draw();
        }
    }

    /// So many are done at once.
    pub fn advance(&mut self, count: u64) {
        self.done += count;
        self.draw();
    }

    fn draw(&mut self) {
        if !self.wanted {
            return;
        }
        match &self.bar {
            Some(bar) => bar.set_position(self.done),
            None if self.began.elapsed() > PATIENCE => {
                let bar = ProgressBar::new(self.total);
                let template =
                    format!("{{bar:40}} {{human_pos}} of {{human_len}} {}, {{per_sec}}, {{eta}} left", self.what);
                if let Ok(style) = ProgressStyle::with_template(&template) {
                    bar.set_style(style);
                }
                self.bar = Some(bar.with_elapsed(self.began.elapsed()).with_position(self.done));
            }
            None => {}
        }
    }

    /// Takes the bar away, so that nothing of it is left on the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
