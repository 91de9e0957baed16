//! What is made once, when first asked for, and not kept where making it was cancelled.

use std::sync::{Arc, Mutex, PoisonError};

/// A place for it. Who asks while another one is making it waits for that.
#[derive(Debug)]
pub(super) struct Memo<T>(Mutex<Option<Arc<T>>>);

impl<T> Memo<T> {
    /// What is here, or else what is made now; nothing where that gives nothing.
    pub fn get_or(&self, make: impl FnOnce() -> Option<T>) -> Option<Arc<T>> {
        // a maker that panicked has left nothing here
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.is_none() {
            *kept = make().map(Arc::new);
        }
        kept.clone()
    }

    /// What is here already.
    pub fn get(&self) -> Option<Arc<T>> {
        // who is making it has not made it
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
    fn what_was_cancelled_is_made_again_and_the_rest_once() {
        let kept = Memo::default();
        assert_eq!(kept.get_or(|| None), None);
        assert_eq!(kept.get(), None);
        assert_eq!(kept.get_or(|| Some(1)).as_deref(), Some(&1));
        assert_eq!(kept.get_or(|| Some(2)).as_deref(), Some(&1));
        assert_eq!(kept.get().as_deref(), Some(&1));
    }
}
