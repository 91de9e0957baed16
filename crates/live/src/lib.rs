//! The live page: a server for pages that follow a text while it is edited.
//!
//! ```text
//! page ──▶ server ──auth──▶ requests ──▶ LiveSession ──▶ response ──▶ page
//! ```
//!
//! Requests and responses are data (`requests.rs`, `response.rs`) and authorization is a function (`auth.rs`): both are tested without a
//! socket. A [`LiveSession`] holds the current version of the texts and computes responses; it reaches files only through its [`Host`].
//! Only `http.rs` and `server.rs` know connections.

mod auth;
mod edit;
mod file_snapshot;
mod host;
mod http;
pub mod page;
mod requests;
mod response;
mod server;
mod session;
mod solution;

pub use host::Host;
pub use requests::{MotionRequest, WriteRequest};
pub use server::{RunningServer, Server};
pub use session::LiveSession;
