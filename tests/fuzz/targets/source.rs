//! Structured Text as bytes, after one that picks the dialect.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some((first, rest)) = bytes.split_first() {
        staunch_fuzz::held("fuzz.st", rest, staunch_fuzz::dialect(*first));
    }
});
