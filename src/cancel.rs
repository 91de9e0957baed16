//! A flag that ends long work: who starts the work keeps one end, and the long loops look at the other.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Says that nobody waits for the result any more. Its clones are one flag.
///
/// What was cancelled gives nothing, and says nothing.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<Flag>);

#[derive(Debug, Default)]
struct Flag {
    is_raised: AtomicBool,
    /// After so many looks more it is raised by itself; never where it is 0.
    looks: AtomicU64,
}

impl Cancel {
    /// One that is raised by itself once it was looked at so often, as it is in each step of a motion: for who has time for so much work, and
    /// does more of it in another way.
    #[must_use]
    pub fn after(looks: u64) -> Cancel {
        let flag = Flag { is_raised: AtomicBool::new(looks == 0), looks: AtomicU64::new(looks) };
        Cancel(Arc::new(flag))
    }

    /// Ends all work that looks at this flag, soon.
    pub fn cancel(&self) {
        self.0.is_raised.store(true, Ordering::Relaxed);
    }

    /// Whether the work is to end.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        let Flag { is_raised, looks } = &*self.0;
        if looks.load(Ordering::Relaxed) > 0 && looks.fetch_sub(1, Ordering::Relaxed) <= 1 {
            is_raised.store(true, Ordering::Relaxed);
        }
        is_raised.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::Cancel;

    #[test]
    fn one_with_so_many_looks_is_raised_by_the_last_of_them() {
        let cancel = Cancel::after(3);
        let looks: Vec<bool> = (0..5).map(|_| cancel.clone().is_cancelled()).collect();
        assert_eq!(looks, [false, false, true, true, true]);
        assert!(Cancel::after(0).is_cancelled());
        let usual = Cancel::default();
        assert!((0..5).all(|_| !usual.is_cancelled()));
        usual.cancel();
        assert!(usual.is_cancelled());
    }
}
