#![no_main]

use voidage_tests::euler::hostile::{Calls, any_calls_from_bytes};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| any_calls_from_bytes(bytes, &mut Calls::default()));
