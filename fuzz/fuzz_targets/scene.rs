//! Scenes of solids with any numbers, and with a fault that the error must name.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| voidage_tests::dirty::scenes_of_solids_are_measured_or_refused(bytes));
