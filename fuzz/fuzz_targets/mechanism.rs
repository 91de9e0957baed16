//! Generated mechanisms through the whole pipeline.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mechc_fuzz::{generate, run};

fuzz_target!(|bytes: &[u8]| {
    let text = generate::text(bytes);
    // to be read where a run ends in a crash
    if std::env::var_os("MECHC_FUZZ_SHOW").is_some() {
        eprintln!("{text}");
    }
    let ran = run(&text);
    assert!(ran.is_read, "what is generated follows the grammar:\n{text}");
});
