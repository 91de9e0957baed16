//! The process of the client: the session ends with it, even if another process holds the pipe open.

use serde_json::Value;
#[cfg(unix)]
use std::os::unix::process::parent_id;
use std::time::Duration;

/// The interval of checks whether it has ended.
pub(super) const CHECK_INTERVAL: Duration = Duration::from_secs(1);

/// The parent process, if it is the client.
pub(super) struct Parent(u32);

impl Parent {
    /// Reads the client's process id from the params of `initialize`; `None` if it is not the parent of this process.
    pub fn from_params(params: &Value) -> Option<Parent> {
        let id = params.get("processId").and_then(Value::as_u64).and_then(|id| u32::try_from(id).ok())?;
        (id > 0 && parent_id() == id).then_some(Parent(id))
    }

    /// Returns whether it has ended, which gives this process another parent.
    pub fn has_ended(&self) -> bool {
        parent_id() != self.0
    }
}

/// Returns 0, which is no client's id: other platforms do not tell the parent.
#[cfg(not(unix))]
fn parent_id() -> u32 {
    0
}
