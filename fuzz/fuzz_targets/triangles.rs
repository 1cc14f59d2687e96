//! Any triangles, many of them coincident, on an aligned and an odd grid.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::dirty::any_triangles_are_measured(bytes));
