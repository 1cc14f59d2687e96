//! Any bits at all, NaN and infinity among them: no panic, no hang, and the first stage never against the exact one.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::raw(bytes));
