//! How quick the parser is; alone in its file, so that no other test runs beside it.

mod support;

use std::fs;
use std::time::{Duration, Instant};
use support::{parser, read, texts};

/// Bytes a second.
const SLOWEST: f64 = 5e6;

#[test]
fn five_megabytes_a_second() {
    let text: String = texts().into_iter().filter(|one| read(&one.text).is_valid).map(|one| one.text + "\n").collect();
    let mut parser = parser();
    let speed = (0..20).map(|_| {
        let (begun, busy) = (Instant::now(), busy());
        let tree = parser.parse(&text, None).expect("nothing cancels it");
        let speed = text.len() as f64
            / self::busy().zip(busy).map_or(begun.elapsed(), |(now, before)| now - before).as_secs_f64();
        assert!(!tree.root_node().has_error());
        speed
    });
    let best = speed.fold(0.0, f64::max);
    println!("{:.1} MB/s over {} kB", best / 1e6, text.len() / 1000);
    assert!(best >= SLOWEST, "{best} bytes a second");
}

/// For how long this thread had a processor, where the system tells: others may want it too.
fn busy() -> Option<Duration> {
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    told.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}
