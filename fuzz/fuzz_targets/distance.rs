//! Distances of both stages against an exact one.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::distance(bytes));
