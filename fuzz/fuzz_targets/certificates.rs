//! Proofs are refused for what is not so.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::certificates(bytes));
