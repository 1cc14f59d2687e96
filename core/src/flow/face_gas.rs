//! The gas on both sides of a face, as a Riemann solver needs it: one gas, or one on each side.
//!
//! A solver is one text for both. Where there is one gas the sides are the same value, and the compiler leaves no trace of the choice.

use crate::flow::state::{Gas, Primitive};
use crate::number::real::Real;

/// The constants of a gas that a face needs.
#[derive(Clone, Copy, Debug)]
pub struct FaceGas<R> {
    gamma: R,
    half_gamma_minus_one: R,
    inv_gamma_minus_one: R,
}

impl<R: Real> FaceGas<R> {
    /// From a gas; the energy constants of a barotropic gas are never used.
    pub fn new(gas: Gas<R>) -> Self {
        let gamma = gas.gamma();
        FaceGas {
            gamma,
            half_gamma_minus_one: R::HALF * (gamma - R::ONE),
            inv_gamma_minus_one: R::ONE / (gamma - R::ONE),
        }
    }

    /// Of a gas of this capacity, 1/(gamma − 1).
    #[inline(always)]
    pub fn of_capacity(capacity: R) -> Self {
        let gamma_minus_one = R::ONE / capacity;
        FaceGas {
            gamma: R::ONE + gamma_minus_one,
            half_gamma_minus_one: R::HALF * gamma_minus_one,
            inv_gamma_minus_one: capacity,
        }
    }

    /// Square of the speed of sound.
    #[inline(always)]
    pub(in crate::flow) fn sound_speed_sq<const D: usize>(&self, w: &Primitive<R, D>) -> R {
        self.gamma * w.pressure / w.density
    }

    /// Speed of sound.
    #[inline(always)]
    pub(in crate::flow) fn sound_speed<const D: usize>(&self, w: &Primitive<R, D>) -> R {
        self.sound_speed_sq(w).sqrt()
    }

    /// Total energy per volume.
    #[inline(always)]
    pub(in crate::flow) fn energy<const D: usize>(&self, w: &Primitive<R, D>) -> R {
        let v = &w.velocity;
        let tangential = if D == 1 {
            R::ZERO
        } else if D == 2 {
            v[1] * v[1]
        } else {
            v[1] * v[1] + v[2] * v[2]
        };
        w.pressure * self.inv_gamma_minus_one + R::HALF * w.density * (v[0] * v[0] + tangential)
    }

    /// Total enthalpy per volume.
    #[inline(always)]
    pub(in crate::flow) fn enthalpy<const D: usize>(&self, w: &Primitive<R, D>) -> R {
        self.energy(w) + w.pressure
    }

    /// 1/gamma.
    #[inline(always)]
    pub(in crate::flow) fn inv_gamma(&self) -> R {
        R::ONE / self.gamma
    }

    /// 1/(gamma − 1).
    #[inline(always)]
    pub(in crate::flow) fn capacity(&self) -> R {
        self.inv_gamma_minus_one
    }
}

mod sealed {
    pub trait Sealed {}
}

/// What stands on the left and on the right of a face: a [`FaceGas`], or two of them, a [`MixedFace`].
pub trait FaceGases<R: Real>: sealed::Sealed {
    /// On the left.
    fn left(&self) -> &FaceGas<R>;
    /// On the right.
    fn right(&self) -> &FaceGas<R>;
    /// What comes from the left, or from the right.
    fn upwind(&self, from_left: bool) -> FaceGas<R>;
    /// ½(gamma − 1) by which a jump of velocity raises the mean of the squared speeds of sound; the larger one.
    fn half_gamma_minus_one(&self) -> R;
    /// Are there two?
    fn is_mixed(&self) -> bool;
}

impl<R> sealed::Sealed for FaceGas<R> {}

impl<R: Real> FaceGases<R> for FaceGas<R> {
    #[inline(always)]
    fn left(&self) -> &FaceGas<R> {
        self
    }

    #[inline(always)]
    fn right(&self) -> &FaceGas<R> {
        self
    }

    #[inline(always)]
    fn upwind(&self, _: bool) -> FaceGas<R> {
        *self
    }

    #[inline(always)]
    fn half_gamma_minus_one(&self) -> R {
        self.half_gamma_minus_one
    }

    #[inline(always)]
    fn is_mixed(&self) -> bool {
        false
    }
}

/// A gas on each side of a face, left and right.
#[derive(Clone, Copy, Debug)]
pub struct MixedFace<R>(pub [FaceGas<R>; 2]);

impl<R: Real> MixedFace<R> {
    /// Of gases of these capacities.
    #[inline(always)]
    pub fn of_capacities([left, right]: [R; 2]) -> Self {
        MixedFace([FaceGas::of_capacity(left), FaceGas::of_capacity(right)])
    }
}

impl<R> sealed::Sealed for MixedFace<R> {}

impl<R: Real> FaceGases<R> for MixedFace<R> {
    #[inline(always)]
    fn left(&self) -> &FaceGas<R> {
        &self.0[0]
    }

    #[inline(always)]
    fn right(&self) -> &FaceGas<R> {
        &self.0[1]
    }

    #[inline(always)]
    fn upwind(&self, from_left: bool) -> FaceGas<R> {
        let [l, r] = &self.0;
        let pick = |a: R, b: R| core::hint::select_unpredictable(from_left, a, b);
        FaceGas {
            gamma: pick(l.gamma, r.gamma),
            half_gamma_minus_one: pick(l.half_gamma_minus_one, r.half_gamma_minus_one),
            inv_gamma_minus_one: pick(l.inv_gamma_minus_one, r.inv_gamma_minus_one),
        }
    }

    #[inline(always)]
    fn half_gamma_minus_one(&self) -> R {
        R::larger(self.0[0].half_gamma_minus_one, self.0[1].half_gamma_minus_one)
    }

    #[inline(always)]
    fn is_mixed(&self) -> bool {
        true
    }
}
