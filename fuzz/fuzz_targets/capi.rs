#![no_main]

// What the tests of the C interface call with hostile arguments.
#[allow(dead_code)]
#[path = "../../core/capi/tests/kit"]
mod kit {
    pub mod api;
    pub mod calls;
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    kit::calls::any_calls::<f64>(bytes);
    kit::calls::any_calls::<f32>(bytes);
});
