#![no_main]

#[allow(dead_code)]
#[path = "../../core/capi/tests/kit.rs"]
mod kit;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    kit::calls::any_calls::<f64>(bytes);
    kit::calls::any_calls::<f32>(bytes);
});
