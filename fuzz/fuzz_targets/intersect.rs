//! Booleans of both stages, in both precisions, against the oracle, under every change that must not matter.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::intersect(bytes));
