//! The log of messages and actions, with times.

use lsp_server::Message;
use std::io::Write;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// A log that is written somewhere, or nowhere. Clones write to the same place.
#[derive(Clone)]
pub struct Log {
    to: Option<Arc<Mutex<dyn Write + Send>>>,
    start: Instant,
}

impl Log {
    /// Creates a log that is not written.
    #[must_use]
    pub fn none() -> Log {
        Log { to: None, start: Instant::now() }
    }

    /// Creates a log that is written to a file or another writer.
    #[must_use]
    pub fn to(writer: impl Write + Send + 'static) -> Log {
        Log { to: Some(Arc::new(Mutex::new(writer))), start: Instant::now() }
    }

    /// Logs a message that was received (`<`) or sent (`>`).
    pub(super) fn message(&self, direction: char, message: &Message) {
        if self.to.is_some() {
            let text = serde_json::to_string(message).unwrap_or_default();
            self.line(direction, &text);
        }
    }

    /// Logs an action of the server.
    pub(super) fn action(&self, what: impl FnOnce() -> String) {
        if self.to.is_some() {
            self.line('·', &what());
        }
    }

    fn line(&self, mark: char, text: &str) {
        let Some(Ok(mut to)) = self.to.as_ref().map(|to| to.lock()) else { return };
        // the server goes on if the log cannot be written
        let _ = writeln!(to, "{:12.6} {mark} {text}", self.start.elapsed().as_secs_f64()).and_then(|()| to.flush());
    }
}
