//! Solids by formula from any numbers, and of families that meet the grid in awkward ways: no panic, parts that sum to the whole.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::quadric(bytes));
