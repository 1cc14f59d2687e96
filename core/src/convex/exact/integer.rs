//! Integers of a fixed capacity, and vectors of them.
//!
//! The unit is the lowest bit that occurs in a query; how many words a degree needs is told where the words are, in [`crate::number::words`].
//! Nothing overflows, and nothing underflows. The usual numbers have a few words only, and only those are worked on.

use crate::number::words::{ExactWords, Words};
use core::cmp::Ordering;

/// Words of degree 2.
pub type Degree2<R> = <R as ExactWords>::Degree2;
/// Words of degree 3.
pub type Degree3<R> = <R as ExactWords>::Degree3;
/// Words of degree 4.
pub type Degree4<R> = <R as ExactWords>::Degree4;

/// An integer of degree 1.
pub type Int1<R> = Int<<R as ExactWords>::Degree1>;
/// An integer of degree 2.
pub type Int2<R> = Int<Degree2<R>>;
/// An integer of degree 3.
pub type Int3<R> = Int<Degree3<R>>;
/// An integer of degree 4.
pub type Int4<R> = Int<Degree4<R>>;

/// A vector of degree 1: a difference of vertices.
pub type V1<R> = [Int1<R>; 3];
/// A vector of degree 2: a product of differences.
pub type V2<R> = [Int2<R>; 3];
/// A vector of degree 3: a direction.
pub type V3<R> = [Int3<R>; 3];

/// A signed integer of a fixed capacity.
#[derive(Clone, Copy, Debug)]
pub struct Int<W> {
    negative: bool,
    /// Words in use; the highest of them is not zero.
    len: usize,
    words: W,
}

impl<W: Words> Int<W> {
    /// Zero.
    pub const ZERO: Self = Int { negative: false, len: 0, words: W::ZERO };

    /// `mantissa · 2^shift`; bits above the capacity are lost.
    pub fn shifted(negative: bool, mantissa: u64, shift: u32) -> Self {
        let mut out = Self::ZERO;
        let (skip, bits) = ((shift / 64) as usize, shift % 64);
        let wide = u128::from(mantissa) << bits;
        for (word, part) in out.words.as_mut().iter_mut().skip(skip).zip([wide as u64, (wide >> 64) as u64]) {
            *word = part;
        }
        out.negative = negative;
        out.trimmed(skip + 2)
    }

    /// The same number, its length set to that of its words below `len`.
    fn trimmed(mut self, len: usize) -> Self {
        self.len = 0;
        for (i, &word) in self.words.as_ref().iter().enumerate().take(len) {
            if word != 0 {
                self.len = i + 1;
            }
        }
        self.negative &= self.len > 0;
        self
    }

    /// The same number with another capacity, which must hold it.
    pub fn resized<K: Words>(&self) -> Int<K> {
        let mut out = Int::<K>::ZERO;
        for (to, from) in out.words.as_mut().iter_mut().zip(self.words.as_ref().iter().take(self.len)) {
            *to = *from;
        }
        out.len = self.len.min(out.words.as_ref().len());
        out.negative = self.negative;
        out
    }

    /// How it compares with 0.
    pub fn sign(&self) -> Ordering {
        match (self.len, self.negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }

    /// Greater than 0.
    pub fn is_positive(&self) -> bool {
        self.sign() == Ordering::Greater
    }

    /// Less than 0.
    pub fn is_negative(&self) -> bool {
        self.sign() == Ordering::Less
    }

    /// Equal to 0.
    pub fn is_zero(&self) -> bool {
        self.len == 0
    }

    /// The opposite number.
    pub fn negated(mut self) -> Self {
        self.negative = !self.negative && self.len > 0;
        self
    }

    fn cmp_abs(&self, other: &Self) -> Ordering {
        let mut order = self.len.cmp(&other.len);
        if order == Ordering::Equal {
            for (x, y) in self.words.as_ref().iter().zip(other.words.as_ref()).take(self.len) {
                if x != y {
                    order = x.cmp(y);
                }
            }
        }
        order
    }

    /// The sum.
    pub fn plus(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            let mut out = Self::ZERO;
            let mut carry = false;
            let len = self.len.max(other.len) + 1;
            for (to, (x, y)) in
                out.words.as_mut().iter_mut().zip(self.words.as_ref().iter().zip(other.words.as_ref())).take(len)
            {
                let (sum, first) = x.overflowing_add(*y);
                let (sum, second) = sum.overflowing_add(u64::from(carry));
                *to = sum;
                carry = first | second;
            }
            out.negative = self.negative;
            return out.trimmed(len);
        }
        let (large, small) = if self.cmp_abs(other) == Ordering::Less { (other, self) } else { (self, other) };
        let mut out = Self::ZERO;
        let mut borrow = false;
        for (to, (x, y)) in
            out.words.as_mut().iter_mut().zip(large.words.as_ref().iter().zip(small.words.as_ref())).take(large.len)
        {
            let (difference, first) = x.overflowing_sub(*y);
            let (difference, second) = difference.overflowing_sub(u64::from(borrow));
            *to = difference;
            borrow = first | second;
        }
        out.negative = large.negative;
        out.trimmed(large.len)
    }

    /// The difference.
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// The product; `K` words must hold it.
    pub fn times<M: Words, K: Words>(&self, other: &Int<M>) -> Int<K> {
        let mut out = Int::<K>::ZERO;
        for (i, &x) in self.words.as_ref().iter().enumerate().take(self.len) {
            let mut carry = 0;
            let mut row = out.words.as_mut().iter_mut().skip(i);
            for &y in other.words.as_ref().iter().take(other.len) {
                let Some(to) = row.next() else { break };
                let sum = u128::from(x) * u128::from(y) + u128::from(*to) + u128::from(carry);
                *to = sum as u64;
                carry = (sum >> 64) as u64;
            }
            if let Some(to) = row.next() {
                *to = carry;
            }
        }
        out.negative = self.negative != other.negative;
        out.trimmed(self.len + other.len)
    }

    /// As `m · 2^e` with 1 ≤ |m| < 2, to a relative error of 2⁻⁵²; zero is `(0, 0)`.
    pub fn as_float(&self) -> (f64, i32) {
        let (mut high, mut low) = (0, 0);
        for &word in self.words.as_ref().iter().take(self.len) {
            (high, low) = (word, high);
        }
        if self.len == 0 {
            return (0.0, 0);
        }
        let bits = high.leading_zeros();
        let top = ((u128::from(high) << 64 | u128::from(low)) << bits >> 64) as u64;
        // 2^63 ≤ top < 2^64; its eleven lowest bits do not reach the mantissa.
        let m = (top >> 11) as f64 / 4_503_599_627_370_496.0;
        let e = 64 * self.len as i32 - 1 - bits as i32;
        (if self.negative { -m } else { m }, e)
    }
}

/// The difference of two vectors.
pub fn minus<N: Words>(a: &[Int<N>; 3], b: &[Int<N>; 3]) -> [Int<N>; 3] {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    [ax.minus(bx), ay.minus(by), az.minus(bz)]
}

/// The opposite vector.
pub fn negated<N: Words>(a: &[Int<N>; 3]) -> [Int<N>; 3] {
    let [x, y, z] = a;
    [x.negated(), y.negated(), z.negated()]
}

/// The same vector with another capacity.
pub fn resized<N: Words, K: Words>(a: &[Int<N>; 3]) -> [Int<K>; 3] {
    let [x, y, z] = a;
    [x.resized(), y.resized(), z.resized()]
}

/// All components zero.
pub fn is_zero<N: Words>(a: &[Int<N>; 3]) -> bool {
    a.iter().all(Int::is_zero)
}

/// The scalar product.
pub fn dot<N: Words, M: Words, K: Words>(a: &[Int<N>; 3], b: &[Int<M>; 3]) -> Int<K> {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    ax.times::<M, K>(bx).plus(&ay.times(by)).plus(&az.times(bz))
}

/// The vector product.
pub fn cross<N: Words, M: Words, K: Words>(a: &[Int<N>; 3], b: &[Int<M>; 3]) -> [Int<K>; 3] {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    [
        ay.times::<M, K>(bz).minus(&az.times(by)),
        az.times::<M, K>(bx).minus(&ax.times(bz)),
        ax.times::<M, K>(by).minus(&ay.times(bx)),
    ]
}
