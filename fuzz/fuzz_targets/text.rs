//! Any text through the whole pipeline.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use mechc_fuzz::{LONGEST, run};

fuzz_target!(|text: &str| -> Corpus {
    if text.len() > LONGEST {
        return Corpus::Reject;
    }
    run(text);
    Corpus::Keep
});
