//! A field that owns its memory, and sums over fields.

use crate::huge::HugeVec;
use voidage_core::flow::{Conserved, Fields, FieldsMut, Gas};
use voidage_core::number::real::Real;

/// A number that flows are made of: `f32` or `f64`.
pub trait Scalar: Real + bytemuck::Pod {}

impl Scalar for f32 {}
impl Scalar for f64 {}

/// One field of conserved variables.
#[derive(Clone, Debug)]
pub struct Field<R: Scalar, const D: usize> {
    /// Mass per open volume.
    pub density: HugeVec<R>,
    /// Momentum per open volume.
    pub momentum: [HugeVec<R>; D],
    /// Total energy per open volume; empty for a barotropic gas.
    pub energy: HugeVec<R>,
    /// 1/(gamma − 1) of the gas in each cell of a mixed gas; else empty.
    pub capacity: HugeVec<R>,
}

impl<R: Scalar, const D: usize> Field<R, D> {
    /// A field of zeros.
    pub fn new(cells: usize, gas: Gas<R>) -> Self {
        let zeros = || HugeVec::zeros(cells);
        Field {
            density: zeros(),
            momentum: std::array::from_fn(|_| zeros()),
            energy: if gas.has_energy() { zeros() } else { HugeVec::default() },
            capacity: if gas.is_mixed() { zeros() } else { HugeVec::default() },
        }
    }

    /// To be read.
    pub fn view(&self) -> Fields<'_, R, D> {
        Fields {
            density: &self.density,
            momentum: self.momentum.each_ref().map(|m| &**m),
            energy: &self.energy,
            capacity: &self.capacity,
        }
    }

    /// To be written.
    pub fn view_mut(&mut self) -> FieldsMut<'_, R, D> {
        FieldsMut {
            density: &mut self.density,
            momentum: self.momentum.each_mut().map(|m| &mut **m),
            energy: &mut self.energy,
            capacity: &mut self.capacity,
        }
    }
}

/// A sum that carries what its rounding lost: the balance is wanted to rounding whatever the number of cells.
pub(super) struct Compensated<R, const D: usize> {
    pub sum: Conserved<R, D>,
    lost: Conserved<R, D>,
}

impl<R: Real, const D: usize> Default for Compensated<R, D> {
    fn default() -> Self {
        let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        Compensated { sum: zero, lost: zero }
    }
}

impl<R: Real, const D: usize> Compensated<R, D> {
    pub fn add(&mut self, x: &Conserved<R, D>) {
        let add = |sum: &mut R, lost: &mut R, x: R| {
            let y = x - *lost;
            let t = *sum + y;
            *lost = (t - *sum) - y;
            *sum = t;
        };
        let (sum, lost) = (&mut self.sum, &mut self.lost);
        add(&mut sum.density, &mut lost.density, x.density);
        add(&mut sum.energy, &mut lost.energy, x.energy);
        for c in 0..D {
            add(&mut sum.momentum[c], &mut lost.momentum[c], x.momentum[c]);
        }
    }
}
