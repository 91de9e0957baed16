//! Work on numbered pieces with borrowed data: each thread takes one range of them, and the call returns when all are done.

use std::ops::Range;
#[cfg(feature = "threads")]
use std::thread;

/// Splits `0..count` into at most `jobs` ranges and returns the results of `work` on them, in order. Each range has a thread of its own,
/// the first one the calling thread.
pub fn scoped_chunks<T: Send>(jobs: usize, count: usize, work: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    let jobs = jobs.min(count);
    if jobs < 2 {
        return vec![work(0..count)];
    }
    let range = |job: usize| job * count / jobs..(job + 1) * count / jobs;
    #[cfg(feature = "threads")]
    let results = thread::scope(|scope| {
        let work = &work;
        let start = |job| thread::Builder::new().spawn_scoped(scope, move || work(range(job)));
        let others: Vec<_> = (1..jobs).map(start).collect();
        let first = work(range(0));
        let others = others.into_iter().zip(1..).map(|(thread, job)| match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // the system refuses another thread
            Err(_) => work(range(job)),
        });
        std::iter::once(first).chain(others).collect()
    });
    #[cfg(not(feature = "threads"))]
    let results = (0..jobs).map(|job| work(range(job))).collect();
    results
}

#[cfg(test)]
mod tests {
    use super::scoped_chunks;

    #[test]
    fn chunks_cover_all_pieces_in_order() {
        for jobs in [1, 2, 3, 8] {
            for count in [0, 1, 2, 7, 100] {
                let all: Vec<usize> = scoped_chunks(jobs, count, Vec::from_iter).concat();
                assert_eq!(all, (0..count).collect::<Vec<_>>(), "{jobs} {count}");
            }
        }
    }
}
