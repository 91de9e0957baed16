//! The language server: what `ide` answers, in the words of the language server protocol.
//!
//! Thin: it keeps the open documents, hands requests to a pool with the snapshot of their moment, and says what is to be said of texts
//! in stages. What a text means is for `ide`. It knows threads, the clock and its own pipe, and nobody else's files: these come through
//! [`World`].
//!
//! ```text
//! pipe ──transport──▶ server ──▶ pool: answers ──▶ ide ──▶ server ──transport──▶ pipe
//!                       └─ documents, stages (what is said of each)
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
pub use server::{Ended, serve};

use mechc_text::world::World;
use std::sync::Arc;

/// The names of all requests that are answered, once a session has begun.
pub fn methods() -> impl Iterator<Item = &'static str> {
    let pull = std::iter::once(server::PULL);
    handlers::TABLE.iter().map(|method| method.name).chain(pull)
}

/// Serves the client at the other end of standard input and output, until that says that it is enough, or is gone.
#[must_use]
pub fn serve_pipe(world: Arc<dyn World>, log: Log) -> Ended {
    let (connection, transport) = transport::standard();
    let ended = serve(connection, world, log);
    // who waits at a pipe that stays open does not come to an end, and what is written there nobody reads
    if ended != Ended::Left {
        transport.finish();
    }
    ended
}
