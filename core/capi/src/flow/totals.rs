//! Contents of the domain.

use super::state::Setup;
use voidage_core::flow::{Conserved, Error, Fields};
use voidage_core::number::real::Real;

/// A sum that carries its rounding error, after Neumaier.
#[derive(Clone, Copy)]
struct Sum<R> {
    sum: R,
    lost: R,
}

impl<R: Real> Sum<R> {
    const ZERO: Self = Sum { sum: R::ZERO, lost: R::ZERO };

    fn add(&mut self, x: R) {
        let sum = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - sum) + x } else { (x - sum) + self.sum };
        self.sum = sum;
    }

    fn value(self) -> R {
        self.sum + self.lost
    }
}

/// What all cells hold, times their open volumes.
pub(super) fn totals<R: Real, const D: usize>(
    setup: &Setup<R, D>,
    field: &Fields<'_, R, D>,
) -> Result<Conserved<R, D>, Error> {
    let (mesh, openings) = (setup.mesh()?, setup.openings());
    let (mut density, mut momentum, mut energy) = (Sum::ZERO, [Sum::ZERO; D], Sum::ZERO);
    for cell in 0..mesh.len() {
        let open = openings.map_or(Some(R::ONE), |(volume, _)| volume.get(cell).copied());
        let (Some(u), Some(open)) = (field.get(cell), open) else { continue };
        let volume = open * mesh.volume(mesh.coordinates(cell));
        density.add(volume * u.density);
        energy.add(volume * u.energy);
        momentum.iter_mut().zip(u.momentum).for_each(|(sum, m)| sum.add(volume * m));
    }
    Ok(Conserved { density: density.value(), momentum: momentum.map(Sum::value), energy: energy.value() })
}
