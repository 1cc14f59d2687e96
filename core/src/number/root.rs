//! The square root of a microcontroller's floating-point unit, which libm leaves alone: on other processors it takes the instruction itself.
//!
//! The only `unsafe` of the crate, and of no other target than ARM with scalars in the registers of its floating-point unit. Such a unit may lack
//! double precision, and no stable compiler tells, so that the root of an `f64` stays libm's. Both are correctly rounded: the bits are the same.

#[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
pub use libm::sqrtf;

/// Square root, correctly rounded.
#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
#[inline(always)]
#[allow(unsafe_code)]
pub fn sqrtf(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // The compiler takes no operands in the registers of a unit of single precision: so by way of a core register, and `s0` is put back.
    // SAFETY: of registers it changes its operands, of the state of the unit the flags of exceptions, which Rust leaves undefined.
    unsafe {
        core::arch::asm!(
            "vmov {kept}, s0",
            "vmov s0, {bits}",
            "vsqrt.f32 s0, s0",
            "vmov {bits}, s0",
            "vmov s0, {kept}",
            bits = inout(reg) bits,
            kept = out(reg) _,
            options(pure, nomem, nostack)
        );
    }
    f32::from_bits(bits)
}
