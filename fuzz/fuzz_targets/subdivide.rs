//! Scenes of up to six convex bodies: the bounds of subdivision hold the exact shares of their union.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::subdivide(bytes));
