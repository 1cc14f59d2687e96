//! What the programs share: their precision, single on a microcontroller, and numbers that no compiler knows.
#![no_std]

pub mod flow;

use core::hint::black_box;

/// The scalar.
#[cfg(target_os = "none")]
pub type Real = f32;
/// The scalar.
#[cfg(not(target_os = "none"))]
pub type Real = f64;
/// Three of them.
#[cfg(target_os = "none")]
pub type Vector = glam::Vec3;
/// Three of them.
#[cfg(not(target_os = "none"))]
pub type Vector = glam::DVec3;

/// A number that no compiler knows.
pub fn any() -> Real {
    black_box(1.0)
}

/// A point that no compiler knows.
pub fn point() -> Vector {
    black_box(Vector::ONE)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// The entry of a program.
#[macro_export]
macro_rules! program {
    ($use:expr) => {
        #[unsafe(no_mangle)]
        extern "C" fn _start() -> ! {
            core::hint::black_box($use());
            loop {}
        }
    };
}
