//! A file of retained variables, with its checksums or with the right ones.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| staunch_host::fuzzing::retained(bytes));
