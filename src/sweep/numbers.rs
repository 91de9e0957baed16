//! The numbers of a column of variants, in memory that is used again.

use crate::math::{WIDE, to_next_line};
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Memory of numbers that nobody asks for any more: to be written over it need not be cleared, and is at hand.
#[derive(Debug)]
pub struct Spare {
    kept: Mutex<Kept>,
    /// It is for so many numbers at the most.
    most: usize,
}

#[derive(Debug, Default)]
struct Kept {
    memory: Vec<Vec<f64>>,
    numbers: usize,
}

impl Spare {
    /// None yet, and never for more than so many numbers.
    #[must_use]
    pub fn new(most: usize) -> Spare {
        Spare { kept: Mutex::default(), most }
    }

    /// Memory for so many numbers.
    fn take(&self, capacity: usize) -> Vec<f64> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.memory.pop();
        kept.numbers -= found.as_ref().map_or(0, Vec::capacity);
        found.filter(|memory| memory.capacity() >= capacity).unwrap_or_else(|| Vec::with_capacity(capacity))
    }

    fn give_back(&self, memory: Vec<f64>) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.numbers + memory.capacity() <= self.most {
            kept.numbers += memory.capacity();
            kept.memory.push(memory);
        }
    }
}

/// Numbers of a column, one behind the other. They begin where a line of the processor's memory does: what is written line by line is there
/// at once.
#[derive(Default)]
pub struct Numbers {
    /// All that has been written here. Of it the column has what stands from `begin` on, so many numbers.
    memory: Vec<f64>,
    begin: usize,
    count: usize,
    /// Where its memory goes then, as long as somebody may take it from there.
    spare: Weak<Spare>,
}

impl Numbers {
    /// None yet, with memory for so many.
    #[must_use]
    pub fn with_capacity(capacity: usize, spare: &Arc<Spare>) -> Numbers {
        let mut memory = spare.take(capacity + WIDE);
        let begin = to_next_line(memory.as_ptr());
        if memory.len() < begin {
            memory.resize(begin, 0.0);
        }
        Numbers { memory, begin, count: 0, spare: Arc::downgrade(spare) }
    }

    /// None yet, with memory for so many from where its own comes.
    #[must_use]
    pub fn another(&self, capacity: usize) -> Numbers {
        let new = || Numbers::from(Vec::with_capacity(capacity));
        self.spare.upgrade().map_or_else(new, |spare| Numbers::with_capacity(capacity, &spare))
    }

    /// Makes room for so many more, which are to be written: what stands there is of no use.
    pub fn make_room(&mut self, more: usize) {
        self.count += more;
        let end = self.begin + self.count;
        if self.memory.len() < end {
            self.memory.resize(end, 0.0);
        }
    }

    /// Keeps the first ones, so many.
    pub fn truncate(&mut self, count: usize) {
        self.count = self.count.min(count);
    }
}

impl Drop for Numbers {
    fn drop(&mut self) {
        if let Some(spare) = self.spare.upgrade() {
            spare.give_back(std::mem::take(&mut self.memory));
        }
    }
}

impl Extend<f64> for Numbers {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, more: T) {
        self.memory.truncate(self.begin + self.count);
        self.memory.extend(more);
        self.count = self.memory.len() - self.begin;
    }
}

impl From<Vec<f64>> for Numbers {
    fn from(memory: Vec<f64>) -> Numbers {
        Numbers { begin: 0, count: memory.len(), memory, spare: Weak::new() }
    }
}

impl Deref for Numbers {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.memory[self.begin..self.begin + self.count]
    }
}

impl DerefMut for Numbers {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.memory[self.begin..self.begin + self.count]
    }
}

impl Clone for Numbers {
    fn clone(&self) -> Numbers {
        Numbers::from(self.to_vec())
    }
}

impl PartialEq for Numbers {
    fn eq(&self, other: &Numbers) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::{Numbers, Spare};
    use std::sync::Arc;

    #[test]
    fn memory_is_used_again_and_holds_what_was_written_last() {
        let spare = Arc::new(Spare::new(100));
        let kept = || spare.kept.lock().map(|kept| (kept.memory.len(), kept.numbers >= 20)).expect("nobody has it");
        for round in 0..3 {
            let mut numbers = Numbers::with_capacity(20, &spare);
            assert!(numbers.is_empty());
            let at = numbers.memory.as_ptr() as usize + 8 * numbers.begin;
            assert_eq!(at % 64, 0, "it begins with a line");
            numbers.make_room(10);
            numbers.iter_mut().zip(0..).for_each(|(number, k)| *number = f64::from(10 * round + k));
            numbers.extend([7.0, 8.0]);
            numbers.truncate(11);
            let wanted: Vec<f64> = (0..10).map(|k| f64::from(10 * round + k)).chain([7.0]).collect();
            assert_eq!(*numbers, *wanted);
            assert_eq!(*numbers.clone(), *wanted);
            assert_eq!(kept(), (0, false));
            drop(numbers);
            assert_eq!(kept(), (1, true));
        }
        let many: Vec<Numbers> = (0..9).map(|_| Numbers::with_capacity(20, &spare)).collect();
        drop(many);
        assert_eq!(kept(), (3, true), "no more is kept than it is for");
    }
}
