//! Requests of a Modbus client, one after the other: a length, and as many bytes.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| staunch_host::fuzzing::requests(bytes));
