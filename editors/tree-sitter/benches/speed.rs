//! How quick the parser is, beside the language's own reader on the same text: `cargo bench`.

#[path = "../tests/support/mod.rs"]
mod support;

use mechc::Sources;
use mechc_syntax::parse;
use std::fs;
use std::time::{Duration, Instant};
use support::{parser, read, texts};

const ROUNDS: usize = 20;

fn main() {
    let text: String = texts().into_iter().filter(|one| read(&one.text).is_valid).map(|one| one.text + "\n").collect();
    let mut parser = parser();
    let tree_sitter = best(text.len(), || {
        let tree = parser.parse(&text, None).expect("nothing cancels it");
        assert!(!tree.root_node().has_error());
    });
    let own = best(text.len(), || {
        let mut sources = Sources::default();
        let source = sources.add("bench.mech", &text);
        drop(parse(&sources, source));
    });
    println!(
        "{} kB of .mech, best of {ROUNDS}: tree-sitter {tree_sitter:.1} MB/s, mechc {own:.1} MB/s",
        text.len() / 1000
    );
}

/// Megabytes a second, in the quickest round.
fn best(bytes: usize, mut work: impl FnMut()) -> f64 {
    let speed = (0..ROUNDS).map(|_| {
        let (begun, before) = (Instant::now(), busy());
        work();
        let spent = busy().zip(before).map_or(begun.elapsed(), |(now, before)| now - before);
        bytes as f64 / spent.as_secs_f64() / 1e6
    });
    speed.fold(0.0, f64::max)
}

/// For how long this thread had a processor, where the system tells: others may want it too.
fn busy() -> Option<Duration> {
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    told.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}
