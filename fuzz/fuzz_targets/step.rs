#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::euler::property::step_from_bytes(bytes));
