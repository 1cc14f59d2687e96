//! One file of boxes, however they touch and however many sides they have: every value lies within its bounds.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::boxes(bytes));
