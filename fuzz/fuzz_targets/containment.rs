//! A box in a hull, and against a triangle.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::containment(bytes));
