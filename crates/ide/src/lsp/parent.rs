//! The process of the client: when it is gone nobody speaks any more, whoever else may hold the pipe open.

use serde_json::Value;
#[cfg(unix)]
use std::os::unix::process::parent_id;
use std::time::Duration;

/// So often it is looked whether it is still there.
pub(super) const TICK: Duration = Duration::from_secs(1);

/// The process that began this one, and says that it is the client's.
pub(super) struct Parent(u32);

impl Parent {
    /// By the params of `initialize`; nothing where something else stands between the two.
    pub fn of(params: &Value) -> Option<Parent> {
        let told = params.get("processId").and_then(Value::as_u64).and_then(|id| u32::try_from(id).ok())?;
        (told > 0 && parent_id() == told).then_some(Parent(told))
    }

    /// Whether it has ended: then this process has another parent.
    pub fn is_gone(&self) -> bool {
        parent_id() != self.0
    }
}

/// Where nobody tells of parents there is none to be seen.
#[cfg(not(unix))]
fn parent_id() -> u32 {
    0
}
