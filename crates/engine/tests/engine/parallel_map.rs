//! Ordered parallel computation: order, end of the work, limit of pieces in advance, and panics of threads.

#![cfg(feature = "threads")]

use mechc_parallel::ParallelMap;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Time after which a test fails.
const PATIENCE: Duration = Duration::from_secs(300);
/// Time in which an event must not happen.
const WHILE: Duration = Duration::from_millis(50);

#[test]
fn pieces_arrive_in_order() {
    for jobs in [1, 2, 7] {
        let work = |piece: u64| {
            // later pieces are done sooner
            (0..(100 - piece) * 1000).for_each(|k| {
                std::hint::black_box(k);
            });
            Some(piece * piece)
        };
        let found: Vec<u64> = ParallelMap::new(jobs, 3..100, move || work).collect();
        assert_eq!(found, (3..100).map(|piece| piece * piece).collect::<Vec<_>>(), "{jobs}");
    }
}

#[test]
fn failed_pieces_end_the_output() {
    for jobs in [1, 3] {
        let mut crew = ParallelMap::new(jobs, 0..100, || |piece| (piece < 20).then_some(piece));
        assert_eq!(crew.by_ref().count(), 20);
        assert_eq!(crew.next(), None);
    }
}

#[test]
fn few_pieces_are_done_ahead() {
    for jobs in [2, 3] {
        let (asker, (reported, begun)) = (thread::current().id(), channel());
        let start = move || {
            let reported = reported.clone();
            move |piece: u64| {
                reported.send(thread::current().id()).ok()?;
                Some(piece)
            }
        };
        let mut crew = ParallelMap::new(jobs, 0..1_000_000, start);
        let begun_are = |count: usize| {
            // who asks for what is there does nothing
            let by_others = |_| begun.recv_timeout(PATIENCE).is_ok_and(|by| by != asker);
            assert!((0..count).all(by_others), "it is not too far ahead, {jobs}");
            assert!(begun.recv_timeout(WHILE).is_err(), "{jobs}");
        };
        begun_are(2 * jobs);
        assert_eq!(crew.next(), Some(0));
        begun_are(1);
        // which waits for nobody that waits
        drop(crew);
    }
}

/// Two threads, whose other one holds the first of some pieces until somebody says so, or is gone; and what is asked of that thread.
struct Held {
    crew: ParallelMap<u64>,
    go: Sender<()>,
    /// The pieces that the other thread begins from then on.
    begun: Receiver<u64>,
}

impl Held {
    /// The one that asks does a piece so.
    fn new(count: u64, own: impl Fn(u64) -> Option<u64> + Clone + Send + Sync + 'static) -> Held {
        let (asker, (reported, begun), (go, wait)) = (thread::current().id(), channel(), channel());
        let wait: Arc<Mutex<Receiver<()>>> = Arc::new(Mutex::new(wait));
        let start = move || {
            let (reported, wait, own) = (reported.clone(), Arc::clone(&wait), own.clone());
            move |piece| {
                if thread::current().id() == asker {
                    return own(piece);
                }
                // of later ones somebody may wait to hear
                let _ = reported.send(piece);
                wait.lock().ok()?.recv_timeout(PATIENCE).ok()?;
                Some(piece)
            }
        };
        let crew = ParallelMap::new(2, 0..count, start);
        assert_eq!(begun.recv_timeout(PATIENCE), Ok(0));
        Held { crew, go, begun }
    }
}

#[test]
fn consumers_work_instead_of_waiting() {
    let go: Arc<Mutex<Option<Sender<()>>>> = Arc::default();
    let let_go = Arc::clone(&go);
    let held = Held::new(2, move |piece| {
        let go = let_go.lock().ok()?.take()?;
        go.send(()).ok().map(|()| piece)
    });
    *go.lock().expect("nobody else has it") = Some(held.go);
    assert_eq!(held.crew.collect::<Vec<_>>(), [0, 1]);
}

#[test]
fn threads_have_separate_memory() {
    for jobs in [1, 3] {
        let (begun, present) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let start = move || {
            let (of, present) = (begun.fetch_add(1, Ordering::Relaxed), Arc::clone(&present));
            let mut done = 0;
            move |_| {
                if done == 0 {
                    present.fetch_add(1, Ordering::Relaxed);
                    let since = Instant::now();
                    while present.load(Ordering::Relaxed) < jobs && since.elapsed() < PATIENCE {
                        thread::yield_now();
                    }
                }
                done += 1;
                Some((of, done))
            }
        };
        let made: Vec<(usize, u64)> = ParallelMap::new(jobs, 0..100, start).collect();
        assert_eq!(made.len(), 100);
        assert_eq!(made.iter().map(|(of, _)| *of).collect::<BTreeSet<_>>(), (0..jobs).collect());
        for of in 0..jobs {
            let counted: Vec<u64> = made.iter().filter(|(by, _)| *by == of).map(|(_, done)| *done).collect();
            assert!(counted.iter().copied().eq(1..=counted.len() as u64), "{jobs} {made:?}");
        }
    }
}

#[test]
fn there_are_no_more_threads_than_pieces() {
    let begun = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&begun);
    let start = move || {
        count.fetch_add(1, Ordering::Relaxed);
        Some
    };
    assert!(ParallelMap::new(64, 5..8, start).eq(5..8));
    assert!(begun.load(Ordering::Relaxed) <= 3);
}

/// Returns the message of a panic.
fn panic_message<T>(what: impl FnOnce() -> T) -> Option<String> {
    let panic = catch_unwind(AssertUnwindSafe(what)).err()?;
    panic.downcast_ref::<&str>().map(|text| (*text).to_owned())
}

#[test]
fn no_piece_starts_after_a_failed_one() {
    let (reported, has_none) = channel();
    let Held { mut crew, go, begun } = Held::new(100, move |piece| {
        // no other piece than the next one
        let _ = reported.send(piece);
        None
    });
    let later = thread::spawn(move || {
        let piece = has_none.recv_timeout(PATIENCE);
        thread::sleep(4 * WHILE);
        (go.send(()).ok(), piece)
    });
    assert_eq!(crew.next(), Some(0));
    assert_eq!(later.join().expect("it is well"), (Some(()), Ok(1)));
    assert!(begun.recv_timeout(WHILE).is_err());
    assert_eq!(crew.next(), None);
}

#[test]
fn ended_maps_start_nothing() {
    let Held { mut crew, go, begun } = Held::new(100, Some);
    crew.end();
    assert!(go.send(()).is_ok());
    assert_eq!(crew.next(), None);
    assert!(begun.recv_timeout(WHILE).is_err());
}

#[test]
fn panics_surface_at_their_piece() {
    let (asker, (reported, begun), (go, wait)) = (thread::current().id(), channel(), channel::<()>());
    let wait = Arc::new(Mutex::new(wait));
    let start = move || {
        let (reported, wait) = (reported.clone(), Arc::clone(&wait));
        move |piece: u64| {
            if thread::current().id() != asker && piece < 2 {
                reported.send(piece).ok()?;
                assert!(piece != 1, "broken");
                wait.lock().ok()?.recv_timeout(PATIENCE).ok()?;
            }
            Some(piece)
        }
    };
    let mut crew = ParallelMap::new(3, 0..100, start);
    let first: BTreeSet<u64> = (0..2).filter_map(|_| begun.recv_timeout(PATIENCE).ok()).collect();
    assert_eq!(first, BTreeSet::from([0, 1]));
    // it breaks down before
    thread::sleep(4 * WHILE);
    assert!(go.send(()).is_ok());
    assert_eq!(crew.next(), Some(0));
    assert_eq!(panic_message(|| crew.next()), Some("broken".to_owned()));
    assert_eq!(crew.next(), None);
}

#[test]
fn consumers_may_panic_and_resume() {
    let Held { mut crew, go, .. } = Held::new(100, |_| panic!("broken here"));
    assert_eq!(panic_message(|| crew.next()), Some("broken here".to_owned()));
    drop(go);
    assert_eq!(crew.next(), None);

    let mut alone = ParallelMap::<u64>::new(1, 0..100, || |_| panic!("broken alone"));
    assert_eq!(panic_message(|| alone.next()), Some("broken alone".to_owned()));
    assert_eq!(alone.next(), None);
}
