//! What was said and done, with the time, for who wants to know why an editor shows what it shows.

use lsp_server::Message;
use std::io::Write;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Where it is written, if anywhere. Its clones write to one place.
#[derive(Clone)]
pub struct Log {
    to: Option<Arc<Mutex<dyn Write + Send>>>,
    start: Instant,
}

impl Log {
    /// Nowhere.
    #[must_use]
    pub fn none() -> Log {
        Log { to: None, start: Instant::now() }
    }

    /// Into a file, say.
    #[must_use]
    pub fn to(writer: impl Write + Send + 'static) -> Log {
        Log { to: Some(Arc::new(Mutex::new(writer))), start: Instant::now() }
    }

    /// A message that came (`<`) or goes (`>`).
    pub(super) fn message(&self, direction: char, message: &Message) {
        if self.to.is_some() {
            let text = serde_json::to_string(message).unwrap_or_default();
            self.line(direction, &text);
        }
    }

    /// What the server did.
    pub(super) fn did(&self, what: impl FnOnce() -> String) {
        if self.to.is_some() {
            self.line('·', &what());
        }
    }

    fn line(&self, mark: char, text: &str) {
        let Some(Ok(mut to)) = self.to.as_ref().map(|to| to.lock()) else { return };
        // who cannot write its log serves all the same
        let _ = writeln!(to, "{:12.6} {mark} {text}", self.start.elapsed().as_secs_f64()).and_then(|()| to.flush());
    }
}
