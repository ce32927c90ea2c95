//! A stimulus file.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| staunch_host::fuzzing::stimulus(bytes));
