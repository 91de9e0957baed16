//! A value that is computed on first use. If the computation is cancelled, the next use computes it again.

use std::sync::{Arc, Mutex, PoisonError};

/// A cell for a computed value. A thread that reads it while another thread computes it waits for that.
#[derive(Debug)]
pub(super) struct Memo<T>(Mutex<Option<Arc<T>>>);

impl<T> Memo<T> {
    /// Returns the value, computing it if necessary; `None` if the computation gives none.
    pub fn get_or_compute(&self, compute: impl FnOnce() -> Option<T>) -> Option<Arc<T>> {
        // a computation that panicked has stored nothing
        let mut value = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if value.is_none() {
            *value = compute().map(Arc::new);
        }
        value.clone()
    }

    /// Returns the value if it is computed already.
    pub fn get(&self) -> Option<Arc<T>> {
        // a locked cell is being computed
        self.0.try_lock().ok()?.clone()
    }
}

impl<T> Default for Memo<T> {
    fn default() -> Memo<T> {
        Memo(Mutex::new(None))
    }
}

impl<T> From<Option<Arc<T>>> for Memo<T> {
    fn from(value: Option<Arc<T>>) -> Memo<T> {
        Memo(Mutex::new(value))
    }
}

#[cfg(test)]
mod tests {
    use super::Memo;

    #[test]
    fn a_cancelled_value_is_recomputed() {
        let value = Memo::default();
        assert_eq!(value.get_or_compute(|| None), None);
        assert_eq!(value.get(), None);
        assert_eq!(value.get_or_compute(|| Some(1)).as_deref(), Some(&1));
        assert_eq!(value.get_or_compute(|| Some(2)).as_deref(), Some(&1));
        assert_eq!(value.get().as_deref(), Some(&1));
    }
}
