//! The C interface of `voidage-core`. `include/voidage.h` is its manual, made from the comments in [`types`], [`status`], [`double`] and
//! [`single`].
//!
//! The caller owns all memory. Nothing is allocated, printed or kept beyond the life of a flow; there is no global state. What a caller may get
//! wrong is answered by a status: null and misaligned pointers, lengths of any size, overlapping arrays, NaN, infinities, unknown kinds. Not
//! even a checked call can see whether a pointer points at as many numbers as it should.
//!
//! A file uses only those above it in this list:
//!
//! 1. [`status`]: what a call answers; [`types`]: the structs that pass through the interface
//! 2. `input`: pointers and lengths, checked; `memory`: the caller's memory, measured and cut by one text
//! 3. `grid`: grids, and runs of their layers; `body`: convex bodies, GJK
//! 4. `surface`: porosity of triangles; `scene`: and of solids by formula
//! 5. `flow`: a flow in the caller's memory
//! 6. [`double`]: the functions of double precision; [`single`]: the same text in single precision
#![cfg_attr(not(feature = "std"), no_std)]

mod body;
pub mod double;
mod flow;
#[cfg(not(feature = "std"))]
mod freestanding;
mod grid;
mod input;
mod memory;
mod scene;
pub mod single;
pub mod status;
mod surface;
pub mod types;

pub use flow::Flow;
