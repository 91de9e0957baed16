//! The live page: what a page asks of a text that somebody is writing, and a server that it asks.
//!
//! ```text
//! page ──▶ server ──guard──▶ asked ──▶ Workshop ──▶ answer ──▶ page
//! ```
//!
//! What is asked and answered is data (`asked.rs`, `answer.rs`), and who may ask is a function (`guard.rs`): both are tested without a
//! socket. A [`Workshop`] has the texts as of a version, and makes of them what is asked; it reaches files only through its [`Host`].
//! `http.rs` and `server.rs` are all that knows of connections.

mod answer;
mod asked;
mod edit;
mod guard;
mod host;
mod http;
pub mod page;
mod server;
mod shelf;
mod solved;
mod workshop;

pub use asked::{Question, Write};
pub use host::Host;
pub use server::{Server, Serving};
pub use workshop::Workshop;
