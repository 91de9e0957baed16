//! Generated texts with parts and repetition: through the whole pipeline, against what they are by hand, and against their parts alone.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mechc_fuzz::{composed, oracles, run};

fuzz_target!(|bytes: &[u8]| {
    let composed = composed::composed(bytes);
    // to be read where a run ends in a crash
    if std::env::var_os("MECHC_FUZZ_SHOW").is_some() {
        eprintln!("{}\n---- the part:\n{}", composed.text, composed.part.text);
    }
    let ran = run(&composed.text);
    assert!(ran.is_read, "what is generated follows the grammar:\n{}", composed.text);
    oracles::repetition_is_what_is_written_out(&composed);
    oracles::a_part_is_what_it_is_alone(&composed.part);
});
