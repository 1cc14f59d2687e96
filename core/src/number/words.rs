//! Words for exact integers: how many a scalar asks for.
//!
//! In units of the lowest bit that a format has, a finite `f64` has at most 2098 bits (from 2⁻¹⁰⁷⁴ to below 2¹⁰²⁴) and a finite `f32` at most 277
//! (from 2⁻¹⁴⁹ to below 2¹²⁸); a difference of two differences has two more. A number of degree `k` is a sum of at most six products of `k` such
//! values: for the degrees 2, 3 and 4 it is at most 2⁴²⁰², 2⁶³⁰³, 2⁸⁴⁰⁴ in `f64`, and 2⁵⁶⁰, 2⁸⁴⁰, 2¹¹¹⁹ in `f32`. So `33 k` words hold the one and `5 k`
//! words the other.

use core::fmt::Debug;

/// An array of words of 64 bits, the lowest first.
pub trait Words: Copy + Debug + AsRef<[u64]> + AsMut<[u64]> + 'static {
    /// All zero.
    const ZERO: Self;
}

impl<const N: usize> Words for [u64; N] {
    const ZERO: Self = [0; N];
}

/// What holds exact integers made of a scalar's finite values.
pub trait ExactWords {
    /// A difference of two differences of values.
    type Degree1: Words;
    /// A sum of six products of two such differences.
    type Degree2: Words;
    /// The same of three.
    type Degree3: Words;
    /// The same of four.
    type Degree4: Words;
}

impl ExactWords for f32 {
    type Degree1 = [u64; 5];
    type Degree2 = [u64; 2 * 5];
    type Degree3 = [u64; 3 * 5];
    type Degree4 = [u64; 4 * 5];
}

impl ExactWords for f64 {
    type Degree1 = [u64; 33];
    type Degree2 = [u64; 2 * 33];
    type Degree3 = [u64; 3 * 33];
    type Degree4 = [u64; 4 * 33];
}
