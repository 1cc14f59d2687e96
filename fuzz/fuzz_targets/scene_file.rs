//! Any text as a scene file.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::dirty::any_scene_is_measured_or_refused(bytes));
