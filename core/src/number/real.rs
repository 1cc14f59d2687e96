//! The two scalars, `f32` and `f64`, and their three-dimensional vectors.
//!
//! Only this file and [`words`](super::words) know a precision. [`Real`] and [`Vector`] are sealed and hold what this crate uses, no more.
//!
//! Correctly rounded operations (`sqrt`, `floor`, `abs`) come from std under the feature `std` and from libm or the processor without it;
//! everything that is not correctly rounded always comes from libm. So the feature changes speed, never bits.

#[cfg(not(feature = "std"))]
use crate::number::root;
use crate::number::words::ExactWords;
use core::fmt::{Debug, Display};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
    impl Sealed for glam::Vec3 {}
    impl Sealed for glam::DVec3 {}
}

/// A binary floating-point scalar: `f32` or `f64`.
pub trait Real:
    sealed::Sealed
    + ExactWords
    + Copy
    + Default
    + Debug
    + Display
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Send
    + Sync
    + 'static
{
    /// The vector of three such scalars.
    type Vector: Vector<Scalar = Self>;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// ½.
    const HALF: Self;
    /// Distance from 1 to the next larger number: 2^-23 or 2^-52.
    const EPSILON: Self;
    /// Smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Largest finite number.
    const MAX: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// Below this the first stage of [`crate::convex::gjk`] rescales its input, so that products of four lengths stay normal.
    const SCALE_MIN: Self;
    /// Above this it rescales too, so that products of four lengths stay finite.
    const SCALE_MAX: Self;
    /// Covers every underflow in a product of up to four lengths below [`Real::SCALE_MAX`].
    const UNDERFLOW: Self;

    /// The nearest value of this type.
    fn from_f64(value: f64) -> Self;
    /// This value as an `f64`, exactly.
    fn to_f64(self) -> f64;
    /// The whole number below, 0 of what is negative or NaN, the largest of what is larger.
    fn to_usize(self) -> usize;
    /// A count as a scalar, rounded to nearest above the mantissa's range.
    fn from_usize(value: usize) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root, correctly rounded; NaN for negative arguments.
    fn sqrt(self) -> Self;
    /// e to this power, from libm always.
    fn exp(self) -> Self;
    /// e to this power, less one, exact for small arguments; from libm always.
    fn exp_m1(self) -> Self;
    /// Natural logarithm, from libm always.
    fn ln(self) -> Self;
    /// This value to a power, from libm always.
    fn pow(self, exponent: Self) -> Self;
    /// Largest integer not above the value.
    fn floor(self) -> Self;
    /// The smaller of two values; the other one if one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger of two values; the other one if one is NaN.
    fn max(self, other: Self) -> Self;
    /// The larger of two numbers, by a selection, which is faster than [`Real::max`]; the second if one is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// The smaller of two numbers, by a selection; the second if one is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The limit beyond which this value lies, or itself; limits in the wrong order or NaN are no error, as they are for std's `clamp`.
    #[inline(always)]
    fn limited(self, lo: Self, hi: Self) -> Self {
        if self < lo {
            lo
        } else if self > hi {
            hi
        } else {
            self
        }
    }
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// The largest power of two not above the absolute value of a normal number; 0 of zero and subnormal numbers, infinity of infinities and NaN.
    fn binade(self) -> Self;
    /// The magnitude of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
}

/// Three scalars in space: `glam::Vec3` or `glam::DVec3`.
pub trait Vector:
    sealed::Sealed
    + Copy
    + Default
    + Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<<Self as Vector>::Scalar, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Send
    + Sync
    + 'static
{
    /// The component type.
    type Scalar: Real<Vector = Self>;
    /// The origin.
    const ZERO: Self;

    /// From components.
    fn new(x: Self::Scalar, y: Self::Scalar, z: Self::Scalar) -> Self;
    /// All three components equal.
    fn splat(value: Self::Scalar) -> Self {
        Self::new(value, value, value)
    }
    /// From an array `[x, y, z]`.
    fn from_array(a: [Self::Scalar; 3]) -> Self {
        Self::new(a[0], a[1], a[2])
    }
    /// As an array `[x, y, z]`.
    fn to_array(self) -> [Self::Scalar; 3];
    /// First component.
    fn x(self) -> Self::Scalar;
    /// Second component.
    fn y(self) -> Self::Scalar;
    /// Third component.
    fn z(self) -> Self::Scalar;
    /// Scalar product.
    fn dot(self, other: Self) -> Self::Scalar;
    /// Vector product.
    fn cross(self, other: Self) -> Self;
    /// Component-wise smaller values.
    fn min(self, other: Self) -> Self;
    /// Component-wise larger values.
    fn max(self, other: Self) -> Self;
    /// Component-wise absolute values.
    fn abs(self) -> Self;
    /// All components finite.
    fn is_finite(self) -> bool;
    /// Sum of the absolute components.
    #[inline(always)]
    fn norm_1(self) -> Self::Scalar {
        self.x().abs() + self.y().abs() + self.z().abs()
    }
    /// Largest absolute component; a NaN among them may be passed over.
    #[inline(always)]
    fn norm_max(self) -> Self::Scalar {
        self.x().abs().larger(self.y().abs()).larger(self.z().abs())
    }
    /// The unit vector along the coordinate axis that this vector has the least component of, by size; the first of equals.
    #[inline(always)]
    fn least_axis(self) -> Self {
        let [x, y, z] = self.abs().to_array();
        let (zero, one) = (Self::Scalar::ZERO, Self::Scalar::ONE);
        if x <= y && x <= z {
            Self::new(one, zero, zero)
        } else if y <= z {
            Self::new(zero, one, zero)
        } else {
            Self::new(zero, zero, one)
        }
    }
    /// Length, without overflow or underflow of the squares. Where the largest component is subnormal, infinite or NaN, that component's size.
    fn length(self) -> Self::Scalar {
        let unit = self.norm_max().binade();
        if !(unit > Self::Scalar::ZERO) || !unit.is_finite() {
            return self.norm_max();
        }
        let inv = Self::Scalar::ONE / unit;
        let scaled = self * inv;
        scaled.dot(scaled).sqrt() * unit
    }
}

macro_rules! real {
    ($scalar:ty, $vector:ty, [$sqrt:path, $floor:path, $exp:path, $exp_m1:path, $ln:path, $pow:path], $exponent:expr, $scale:expr, $underflow:expr) => {
        impl Real for $scalar {
            type Vector = $vector;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const HALF: Self = 0.5;
            const EPSILON: Self = <$scalar>::EPSILON;
            const MIN_POSITIVE: Self = <$scalar>::MIN_POSITIVE;
            const MAX: Self = <$scalar>::MAX;
            const INFINITY: Self = <$scalar>::INFINITY;
            const SCALE_MIN: Self = 1.0 / $scale;
            const SCALE_MAX: Self = $scale;
            const UNDERFLOW: Self = <$scalar>::MIN_POSITIVE * $underflow;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $scalar
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn to_usize(self) -> usize {
                self as usize
            }
            #[inline(always)]
            fn from_usize(value: usize) -> Self {
                value as $scalar
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$scalar>::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                #[cfg(feature = "std")]
                return <$scalar>::sqrt(self);
                #[cfg(not(feature = "std"))]
                $sqrt(self)
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline]
            fn exp_m1(self) -> Self {
                $exp_m1(self)
            }
            #[inline]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline]
            fn pow(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                #[cfg(feature = "std")]
                return <$scalar>::floor(self);
                #[cfg(not(feature = "std"))]
                $floor(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                <$scalar>::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                <$scalar>::max(self, other)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                <$scalar>::is_finite(self)
            }
            #[inline(always)]
            fn binade(self) -> Self {
                <$scalar>::from_bits(self.to_bits() & $exponent)
            }
            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                <$scalar>::copysign(self, sign)
            }
        }

        impl Vector for $vector {
            type Scalar = $scalar;
            const ZERO: Self = <$vector>::ZERO;

            #[inline(always)]
            fn new(x: $scalar, y: $scalar, z: $scalar) -> Self {
                <$vector>::new(x, y, z)
            }
            #[inline(always)]
            fn to_array(self) -> [$scalar; 3] {
                <$vector>::to_array(&self)
            }
            #[inline(always)]
            fn x(self) -> $scalar {
                self.x
            }
            #[inline(always)]
            fn y(self) -> $scalar {
                self.y
            }
            #[inline(always)]
            fn z(self) -> $scalar {
                self.z
            }
            #[inline(always)]
            fn dot(self, other: Self) -> $scalar {
                <$vector>::dot(self, other)
            }
            #[inline(always)]
            fn cross(self, other: Self) -> Self {
                <$vector>::cross(self, other)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                <$vector>::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                <$vector>::max(self, other)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$vector>::abs(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                <$vector>::is_finite(self)
            }
        }
    };
}

real!(
    f32,
    glam::Vec3,
    [root::sqrtf, libm::floorf, libm::expf, libm::expm1f, libm::logf, libm::powf],
    0x7f80_0000,
    65536.0,
    65536.0
);
real!(
    f64,
    glam::DVec3,
    [libm::sqrt, libm::floor, libm::exp, libm::expm1, libm::log, libm::pow],
    0x7ff0_0000_0000_0000,
    1.2676506002282294e30,
    2.582249878086909e120
);
