//! The language server: the features of this crate in the language server protocol.
//!
//! The server is thin: it keeps the open documents, hands each request with a snapshot to a pool of threads, and publishes diagnostics by
//! stage. The meaning of texts is left to the features. The server uses threads, the clock and its pipe, and reaches files only through
//! [`World`].
//!
//! ```text
//! pipe ──transport──▶ server ──▶ pool: handlers ──▶ ide ──▶ server ──transport──▶ pipe
//!                       └─ documents, published (the diagnostics of each)
//! ```

mod apply_edits;
mod capabilities;
mod convert;
mod documents;
mod handlers;
mod lines;
mod live_pages;
mod log;
mod parent;
mod pool;
mod published;
mod server;
mod transport;
mod uri;

pub use log::Log;
pub use server::{SessionEnd, serve};

use mechc_text::world::World;
use std::sync::Arc;

/// Returns the names of all requests that a running session answers.
pub fn methods() -> impl Iterator<Item = &'static str> {
    let pull = std::iter::once(server::PULL);
    handlers::TABLE.iter().map(|method| method.name).chain(pull)
}

/// Serves a client on standard input and output until it ends the session or disappears.
#[must_use]
pub fn serve_pipe(world: Arc<dyn World>, log: Log) -> SessionEnd {
    let (connection, transport) = transport::standard();
    let ended = serve(connection, world, log);
    // after the client's process has ended, a pipe that others hold open would block the writer for ever
    if ended != SessionEnd::Left {
        transport.finish();
    }
    ended
}
