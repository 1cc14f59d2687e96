//! Porosity of layers: any triangles, grids and memory, NaN and infinity among them: no panic, bounds in order.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::fuzzed::layers(bytes));
