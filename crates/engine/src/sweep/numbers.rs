//! The numbers of a column of variants, in memory that is used again.

use mechc_expr::math::{WIDE, to_next_line};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Memory of numbers that nobody asks for any more: to be written over it need not be cleared, and is at hand. That of a column is used for that
/// column again: where that has the same numbers for each variant, all is there already.
#[derive(Debug)]
pub struct Spare {
    /// By column.
    kept: Mutex<BTreeMap<usize, Vec<Memory>>>,
    /// Of each so much is kept at the most.
    most: usize,
}

/// All that has been written somewhere.
#[derive(Default, Debug)]
struct Memory {
    numbers: Vec<f64>,
    /// Where the column begins, at a line of the processor's memory.
    begin: usize,
    /// How long the pattern is, if it is known that from there on all numbers repeat the first ones.
    period: Option<usize>,
}

impl Spare {
    /// None yet, and never more than that of so many at once of a column.
    #[must_use]
    pub fn new(most: usize) -> Spare {
        Spare { kept: Mutex::default(), most }
    }

    /// Memory for so many numbers of a column.
    fn take(&self, capacity: usize, column: usize) -> Memory {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.get_mut(&column).and_then(Vec::pop);
        let new = || Memory { numbers: Vec::with_capacity(capacity), ..Memory::default() };
        found.filter(|memory| memory.numbers.capacity() >= capacity).unwrap_or_else(new)
    }

    fn give_back(&self, memory: Memory, column: usize) {
        // who takes some has it for a moment, or for ever, in a process that has forked meanwhile: then it is let go
        let Ok(mut kept) = self.kept.try_lock() else { return };
        let kept = kept.entry(column).or_default();
        if kept.len() < self.most {
            kept.push(memory);
        }
    }
}

/// Numbers of a column, one behind the other. They begin where a line of the processor's memory does: what is written line by line is there
/// at once.
#[derive(Default)]
pub struct Numbers {
    /// Of it the column has so many numbers from where it begins.
    memory: Memory,
    count: usize,
    /// Where its memory goes then, as long as somebody may take it from there, as that of which column.
    spare: Weak<Spare>,
    column: usize,
}

impl Numbers {
    /// None yet, with memory for so many of a column, by its number.
    #[must_use]
    pub fn with_capacity(capacity: usize, spare: &Arc<Spare>, column: usize) -> Numbers {
        let mut memory = spare.take(capacity + WIDE, column);
        let begin = to_next_line(memory.numbers.as_ptr());
        if begin != memory.begin {
            (memory.begin, memory.period) = (begin, None);
        }
        if memory.numbers.len() < begin {
            memory.numbers.resize(begin, 0.0);
        }
        Numbers { memory, count: 0, spare: Arc::downgrade(spare), column }
    }

    /// None yet, with memory for so many of another column from where its own comes.
    #[must_use]
    pub fn another(&self, capacity: usize, column: usize) -> Numbers {
        let new = || Numbers::from(Vec::with_capacity(capacity));
        self.spare.upgrade().map_or_else(new, |spare| Numbers::with_capacity(capacity, &spare, column))
    }

    /// Makes room for so many more, which are to be written: what stands there is of no use.
    pub fn make_room(&mut self, more: usize) {
        self.count += more;
        let Memory { numbers, begin, period } = &mut self.memory;
        let end = *begin + self.count;
        if numbers.len() < end {
            *period = None;
            numbers.resize(end, 0.0);
        }
    }

    /// Makes all from a number on repetitions of some numbers; those before are such too, or there are none.
    pub fn repeat_from(&mut self, first: usize, those: &[f64]) {
        let Memory { numbers, begin, period } = &mut self.memory;
        let is_there = |known: &[f64]| *period == Some(known.len()) && is_same(known, those);
        if numbers[*begin..].get(..those.len()).is_some_and(is_there) {
            return;
        }
        // all that has ever been written, if all of it is the column's own
        let end = if first == 0 { numbers.len() } else { *begin + self.count };
        for to in numbers[*begin + first..end].chunks_mut(those.len()) {
            to.copy_from_slice(&those[..to.len()]);
        }
        *period = (first == 0).then_some(those.len());
    }

    /// Keeps the first ones, so many.
    pub fn truncate(&mut self, count: usize) {
        self.count = self.count.min(count);
    }
}

fn is_same(some: &[f64], others: &[f64]) -> bool {
    some.iter().map(|number| number.to_bits()).eq(others.iter().map(|number| number.to_bits()))
}

impl Drop for Numbers {
    fn drop(&mut self) {
        if let Some(spare) = self.spare.upgrade() {
            spare.give_back(std::mem::take(&mut self.memory), self.column);
        }
    }
}

impl Extend<f64> for Numbers {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, more: T) {
        self.memory.period = None;
        self.memory.numbers.truncate(self.memory.begin + self.count);
        self.memory.numbers.extend(more);
        self.count = self.memory.numbers.len() - self.memory.begin;
    }
}

impl From<Vec<f64>> for Numbers {
    fn from(numbers: Vec<f64>) -> Numbers {
        let (count, memory) = (numbers.len(), Memory { numbers, begin: 0, period: None });
        Numbers { count, memory, spare: Weak::new(), column: 0 }
    }
}

impl Deref for Numbers {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.memory.numbers[self.memory.begin..][..self.count]
    }
}

impl DerefMut for Numbers {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        self.memory.period = None;
        &mut self.memory.numbers[self.memory.begin..][..self.count]
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
        let spare = Arc::new(Spare::new(3));
        let kept = || -> Vec<usize> { spare.kept.lock().expect("nobody has it").values().map(Vec::len).collect() };
        for round in 0..3 {
            let mut numbers = Numbers::with_capacity(20, &spare, 0);
            assert!(numbers.is_empty());
            let at = numbers.memory.numbers.as_ptr() as usize + 8 * numbers.memory.begin;
            assert_eq!(at % 64, 0, "it begins with a line");
            numbers.make_room(10);
            numbers.iter_mut().zip(0..).for_each(|(number, k)| *number = f64::from(10 * round + k));
            numbers.extend([7.0, 8.0]);
            numbers.truncate(11);
            let wanted: Vec<f64> = (0..10).map(|k| f64::from(10 * round + k)).chain([7.0]).collect();
            assert_eq!(*numbers, *wanted);
            assert_eq!(*numbers.clone(), *wanted);
            assert_eq!(kept().iter().sum::<usize>(), 0);
            drop(numbers);
            assert_eq!(kept(), [1]);
        }
        let many: Vec<Numbers> = (0..9).map(|_| Numbers::with_capacity(20, &spare, 0)).collect();
        let mut others: Vec<Numbers> = (0..2).map(|_| many[0].another(20, 4)).collect();
        drop(many);
        others.truncate(1);
        assert_eq!(kept(), [3, 1], "no more of a column is kept than is said");
        let had = spare.kept.lock().expect("nobody has it");
        // who would have to wait lets it go
        drop(others);
        drop(had);
        assert_eq!(kept(), [3, 1]);
    }

    #[test]
    fn what_is_repeated_stays_there_until_somebody_may_have_written() {
        let spare = Arc::new(Spare::new(2));
        let period = |numbers: &Numbers| numbers.memory.period;
        for (number, those) in [&[0.0][..], &[2.5], &[1.0, -0.0, 3.0], &[1.0, 0.0, 3.0], &[7.0; 3]].iter().enumerate() {
            let wanted: Vec<f64> = those.iter().copied().cycle().take(9).collect();
            for round in 0..4 {
                let mut numbers = Numbers::with_capacity(20, &spare, 3);
                if round == 3 {
                    assert_eq!(period(&numbers), Some(those.len()));
                }
                for before in [0, 3, 6] {
                    numbers.make_room(3);
                    numbers.repeat_from(before, those);
                    assert!(super::is_same(&numbers, &wanted[..before + 3]), "{those:?} {round}");
                }
                // memory that had to grow is known the next time
                assert_eq!(period(&numbers).is_some(), (number, round) != (0, 0));
                if round == 1 {
                    numbers[7] = 8.0;
                    assert_eq!(period(&numbers), None);
                }
            }
        }
        let mut written = Numbers::with_capacity(20, &spare, 3);
        written.extend([1.0, 2.0, 3.0]);
        written.make_room(4);
        written.repeat_from(3, &[0.0, 4.0]);
        assert_eq!(*written, [1.0, 2.0, 3.0, 0.0, 4.0, 0.0, 4.0]);
        assert_eq!(period(&written), None);
        drop(written);
        // another column has nothing of it
        assert!(Numbers::with_capacity(20, &spare, 4).memory.numbers.len() < 20);
    }
}
