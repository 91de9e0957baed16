//! Columns of numbers, in memory that is reused from block to block.

use mechc_expr::math::{WIDE, numbers_to_cache_line};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A pool of memory for columns. Reused memory need not be cleared. It returns to the same column, which often repeats the numbers of the block
/// before, so that they need not be written again.
#[derive(Debug)]
pub struct BufferPool {
    /// Unused memory, by column.
    free: Mutex<BTreeMap<usize, Vec<Memory>>>,
    /// The largest number of entries of each column.
    limit: usize,
}

/// All that was ever written to a piece of memory.
#[derive(Default, Debug)]
struct Memory {
    numbers: Vec<f64>,
    /// The index at which the column begins, aligned to a cache line.
    begin: usize,
    /// The period, if all numbers from there on are guaranteed to repeat with one.
    period: Option<usize>,
}

impl BufferPool {
    /// Creates an empty pool that keeps at most `limit` pieces of memory for each column.
    #[must_use]
    pub fn new(limit: usize) -> BufferPool {
        BufferPool { free: Mutex::default(), limit }
    }

    /// Takes memory for `capacity` numbers of a column.
    fn take(&self, capacity: usize, column: usize) -> Memory {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let memory = free.get_mut(&column).and_then(Vec::pop);
        let new = || Memory { numbers: Vec::with_capacity(capacity), ..Memory::default() };
        memory.filter(|memory| memory.numbers.capacity() >= capacity).unwrap_or_else(new)
    }

    fn give_back(&self, memory: Memory, column: usize) {
        // the lock is held for a moment, or forever in a process that was forked meanwhile: then the memory is dropped
        let Ok(mut free) = self.free.try_lock() else { return };
        let free = free.entry(column).or_default();
        if free.len() < self.limit {
            free.push(memory);
        }
    }
}

/// Numbers of a column. They begin at a cache line, so that whole lines can be written.
#[derive(Default)]
pub struct Numbers {
    /// The column is `count` numbers from `memory.begin` on.
    memory: Memory,
    count: usize,
    /// The pool that receives the memory on drop, as that of `column`.
    pool: Weak<BufferPool>,
    column: usize,
}

impl Numbers {
    /// Creates an empty column with memory for `capacity` numbers from a pool. `column` is its index there.
    #[must_use]
    pub fn with_capacity(capacity: usize, pool: &Arc<BufferPool>, column: usize) -> Numbers {
        let mut memory = pool.take(capacity + WIDE, column);
        let begin = numbers_to_cache_line(memory.numbers.as_ptr());
        if begin != memory.begin {
            (memory.begin, memory.period) = (begin, None);
        }
        if memory.numbers.len() < begin {
            memory.numbers.resize(begin, 0.0);
        }
        Numbers { memory, count: 0, pool: Arc::downgrade(pool), column }
    }

    /// Creates an empty column with memory from the same pool, with another index.
    #[must_use]
    pub fn new_in_pool(&self, capacity: usize, column: usize) -> Numbers {
        let new = || Numbers::from(Vec::with_capacity(capacity));
        self.pool.upgrade().map_or_else(new, |pool| Numbers::with_capacity(capacity, &pool, column))
    }

    /// Appends `more` numbers with unspecified values, which the caller is to write.
    pub fn make_room(&mut self, more: usize) {
        self.count += more;
        let Memory { numbers, begin, period } = &mut self.memory;
        let end = *begin + self.count;
        if numbers.len() < end {
            *period = None;
            numbers.resize(end, 0.0);
        }
    }

    /// Fills all from index `first` on with repetitions of a pattern. Numbers before that repeat it already, or `first` is 0.
    pub fn repeat_from(&mut self, first: usize, pattern: &[f64]) {
        let Memory { numbers, begin, period } = &mut self.memory;
        let is_there = |numbers: &[f64]| *period == Some(numbers.len()) && is_same(numbers, pattern);
        if numbers[*begin..].get(..pattern.len()).is_some_and(is_there) {
            return;
        }
        // with `first` 0 the whole memory is filled, which makes the period valid
        let end = if first == 0 { numbers.len() } else { *begin + self.count };
        for to in numbers[*begin + first..end].chunks_mut(pattern.len()) {
            to.copy_from_slice(&pattern[..to.len()]);
        }
        *period = (first == 0).then_some(pattern.len());
    }

    /// Keeps the first `count` numbers.
    pub fn truncate(&mut self, count: usize) {
        self.count = self.count.min(count);
    }
}

fn is_same(some: &[f64], others: &[f64]) -> bool {
    some.iter().map(|number| number.to_bits()).eq(others.iter().map(|number| number.to_bits()))
}

impl Drop for Numbers {
    fn drop(&mut self) {
        if let Some(pool) = self.pool.upgrade() {
            pool.give_back(std::mem::take(&mut self.memory), self.column);
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
        Numbers { count, memory, pool: Weak::new(), column: 0 }
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
    use super::{BufferPool, Numbers};
    use std::sync::Arc;

    #[test]
    fn reused_memory_holds_the_latest_numbers() {
        let pool = Arc::new(BufferPool::new(3));
        let kept = || -> Vec<usize> { pool.free.lock().expect("unlocked").values().map(Vec::len).collect() };
        for round in 0..3 {
            let mut numbers = Numbers::with_capacity(20, &pool, 0);
            assert!(numbers.is_empty());
            let at = numbers.memory.numbers.as_ptr() as usize + 8 * numbers.memory.begin;
            assert_eq!(at % 64, 0, "begins at a cache line");
            numbers.make_room(10);
            numbers.iter_mut().zip(0..).for_each(|(number, k)| *number = f64::from(10 * round + k));
            numbers.extend([7.0, 8.0]);
            numbers.truncate(11);
            let expected: Vec<f64> = (0..10).map(|k| f64::from(10 * round + k)).chain([7.0]).collect();
            assert_eq!(*numbers, *expected);
            assert_eq!(*numbers.clone(), *expected);
            assert_eq!(kept().iter().sum::<usize>(), 0);
            drop(numbers);
            assert_eq!(kept(), [1]);
        }
        let many: Vec<Numbers> = (0..9).map(|_| Numbers::with_capacity(20, &pool, 0)).collect();
        let mut others: Vec<Numbers> = (0..2).map(|_| many[0].new_in_pool(20, 4)).collect();
        drop(many);
        others.truncate(1);
        assert_eq!(kept(), [3, 1], "the limit of a column");
        let had = pool.free.lock().expect("unlocked");
        // while the lock is held, memory is dropped
        drop(others);
        drop(had);
        assert_eq!(kept(), [3, 1]);
    }

    #[test]
    fn period_is_valid_until_numbers_may_have_changed() {
        let pool = Arc::new(BufferPool::new(2));
        let period = |numbers: &Numbers| numbers.memory.period;
        for (number, pattern) in [&[0.0][..], &[2.5], &[1.0, -0.0, 3.0], &[1.0, 0.0, 3.0], &[7.0; 3]].iter().enumerate()
        {
            let expected: Vec<f64> = pattern.iter().copied().cycle().take(9).collect();
            for round in 0..4 {
                let mut numbers = Numbers::with_capacity(20, &pool, 3);
                if round == 3 {
                    assert_eq!(period(&numbers), Some(pattern.len()));
                }
                for before in [0, 3, 6] {
                    numbers.make_room(3);
                    numbers.repeat_from(before, pattern);
                    assert!(super::is_same(&numbers, &expected[..before + 3]), "{pattern:?} {round}");
                }
                // memory that had to grow gets its period in the next round
                assert_eq!(period(&numbers).is_some(), (number, round) != (0, 0));
                if round == 1 {
                    numbers[7] = 8.0;
                    assert_eq!(period(&numbers), None);
                }
            }
        }
        let mut written = Numbers::with_capacity(20, &pool, 3);
        written.extend([1.0, 2.0, 3.0]);
        written.make_room(4);
        written.repeat_from(3, &[0.0, 4.0]);
        assert_eq!(*written, [1.0, 2.0, 3.0, 0.0, 4.0, 0.0, 4.0]);
        assert_eq!(period(&written), None);
        drop(written);
        // memory does not go to another column
        assert!(Numbers::with_capacity(20, &pool, 4).memory.numbers.len() < 20);
    }
}
