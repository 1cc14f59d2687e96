//! What happens where a new state leaves the physical set: first order around it, then fluxes that keep any state physical, at last a floor. A
//! shorter step is the caller's.

use crate::flow::error::{Error, fits};
use crate::flow::problem::Problem;
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas, Primitive, sum};
use crate::flow::step_report::Report;
use crate::number::real::Real;

/// Share of the density and pressure around a cell that a floor leaves in it at least. Smaller: hotter or emptier cells, shorter
/// steps.
const FLOOR_SHARE: f64 = 1e-3;

/// Most repetitions of a step by the fallback. Before each, troubled cells and their neighbours are marked for first order; a troubled cell that has
/// this mark already is marked for positive fluxes.
pub(in crate::flow) const FALLBACKS: usize = 6;

/// Mark of a cell whose reconstruction is of first order.
pub const FIRST_ORDER: u8 = 1;
/// Mark of a cell whose faces also have the flux that keeps any state physical, without the throat map.
pub const POSITIVE: u8 = 2;

impl<R: Real, const D: usize> Problem<'_, R, D> {
    /// The cells beside a cell: the axis, whether on its high side, and the flat index of each.
    fn each_beside(&self, cell: usize, mut f: impl FnMut(usize, bool, usize)) {
        let (cells, periodic, at) = (self.mesh.cells(), self.periodic(), self.mesh.coordinates(cell));
        for d in 0..D {
            for (high, edge, step) in [(false, 0, cells[d] - 1), (true, cells[d] - 1, 1)] {
                if at[d] != edge || periodic[d] {
                    let mut next = at;
                    next[d] = (at[d] + step) % cells[d];
                    f(d, high, self.mesh.index(next));
                }
            }
        }
    }

    /// Marks every unphysical cell of a new field and its neighbours for a first-order step, and those that had such a mark for fluxes that
    /// keep any state physical; returns how many marks are new.
    ///
    /// # Errors
    /// A slice does not fit the mesh.
    pub fn mark_troubled(&self, new: &Fields<'_, R, D>, first_order: &mut [u8]) -> Result<usize, Error> {
        self.check_fields(new)?;
        fits(self.mesh.len(), first_order.len())?;
        let mut added = 0;
        let mut raise = |first_order: &mut [u8], i: usize, to: u8| {
            added += usize::from(first_order[i] < to);
            first_order[i] = to.max(first_order[i]);
        };
        // First each troubled cell by itself, so that the order of the cells does not count.
        let troubled = |cell: &usize| !self.holds(new, *cell);
        for cell in (0..self.mesh.len()).filter(troubled) {
            let marked = first_order[cell] > 0;
            raise(first_order, cell, if marked { POSITIVE } else { FIRST_ORDER });
        }
        for cell in (0..self.mesh.len()).filter(troubled) {
            self.each_beside(cell, |_, _, beside| raise(first_order, beside, FIRST_ORDER));
        }
        Ok(added)
    }

    /// Mean density and pressure of the cell and of those behind its open faces.
    fn surroundings(&self, field: &Fields<'_, R, D>, cell: usize) -> (R, R) {
        let at = self.mesh.coordinates(cell);
        let (mut density, mut pressure, mut count) = (R::ZERO, R::ZERO, R::ZERO);
        let mut add = |cell: usize| {
            let w = field.gas_at(self.gas, cell).primitive(&field.at(cell));
            density += w.density;
            pressure += w.pressure;
            count += R::ONE;
        };
        add(cell);
        self.each_beside(cell, |d, high, beside| {
            let face = self.mesh.face(d, at) + if high { self.mesh.face_stride(d) } else { 0 };
            if self.porosity.is_none_or(|p| p.faces[d][face] > R::ZERO) {
                add(beside);
            }
        });
        (density / count, pressure / count)
    }

    /// The state that takes the place of an unphysical one, `u`, in a cell where there was `before`.
    ///
    /// Density and pressure become at least a share of those around. Mass and energy are kept where they are more: if the kinetic
    /// energy does not leave enough of the total, the gas loses speed rather than winning energy.
    fn floored(
        u: &Conserved<R, D>,
        gas: Gas<R>,
        before: &Primitive<R, D>,
        (density, pressure): (R, R),
    ) -> Conserved<R, D> {
        let least = |around: R| R::larger(R::from_f64(FLOOR_SHARE) * around, R::MIN_POSITIVE);
        // The largest number that stays finite when a step multiplies it.
        let fits = |x: R| x.abs() < R::MAX * R::EPSILON;
        let kinetic_of = |rho: R, v: [R; D]| R::HALF * rho * sum::<R, D>(v.map(|v| v * v));
        let sound =
            u.density > R::ZERO && fits(u.density) && fits(kinetic_of(u.density, u.momentum.map(|m| m / u.density)));
        let density = if sound { R::larger(u.density, least(density)) } else { least(density) };
        let velocity = if sound { u.momentum.map(|m| m / density) } else { before.velocity };
        let Gas::Ideal { gamma } = gas else {
            return gas.conserved(&Primitive { density, velocity, pressure });
        };
        let total = if fits(u.energy) { R::larger(u.energy, R::ZERO) } else { R::ZERO };
        // Above the rounding of the total energy that it is a part of.
        let internal = R::larger(least(pressure) / (gamma - R::ONE), R::from_f64(64.0) * R::EPSILON * total);
        let energy = R::larger(total, internal);
        let (kinetic, most) = (kinetic_of(density, velocity), energy - internal);
        let slower = if kinetic > most { (most / kinetic).sqrt() } else { R::ONE };
        Conserved { density, momentum: velocity.map(|v| density * (slower * v)), energy }
    }

    /// Puts the capacity of a cell of a mixed gas within its bounds; that before the step takes the place of one that is no number.
    fn bound_capacity(&self, old: &Fields<'_, R, D>, new: &mut FieldsMut<'_, R, D>, cell: usize) {
        let [least, most] = self.gas.capacities();
        if let Some((own, before)) = new.capacity.get_mut(cell).zip(old.capacity.get(cell)) {
            let finite = if own.is_finite() { *own } else { *before };
            *own = finite.limited(least, most);
        }
    }

    /// The last resort: gives every unphysical cell a positive state, scaled to the old states around it. Adds to the report how many
    /// these are, and what of mass, momentum and energy they changed.
    ///
    /// # Errors
    /// A slice does not fit the mesh.
    pub fn apply_floors(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        report: &mut Report<R, D>,
    ) -> Result<(), Error> {
        self.check_fields(old)?;
        self.fits(&new.as_fields(), self.mesh.len())?;
        let mut any = false;
        for cell in 0..self.mesh.len() {
            if self.holds(&new.as_fields(), cell) {
                continue;
            }
            self.bound_capacity(old, new, cell);
            let (u, before) = (new.at(cell), old.at(cell));
            let floored = if self.is_physical(&u) {
                u
            } else {
                let gas = new.as_fields().gas_at(self.gas, cell);
                let was = old.gas_at(self.gas, cell).primitive(&before);
                Self::floored(&u, gas, &was, self.surroundings(old, cell))
            };
            new.set(cell, &floored);
            let open = self.porosity.map_or(R::ONE, |p| p.volume[cell]);
            let volume = open * self.mesh.volume(self.mesh.coordinates(cell));
            // What cannot be counted with counts as if the cell had kept its old state.
            let change = |now: R, was: R, old: R| volume * (now - if was.is_finite() { was } else { old }).abs();
            report.floor_change.add(&Conserved {
                density: change(floored.density, u.density, before.density),
                momentum: core::array::from_fn(|c| change(floored.momentum[c], u.momentum[c], before.momentum[c])),
                energy: change(floored.energy, u.energy, before.energy),
            });
            report.floored += 1;
            report.floored_cell = Some(cell);
            any = true;
        }
        if any {
            // The rate so far is that of the states before them, too. Where a floor made no state of the gas, it stays.
            report.rate = self.rate(&new.as_fields()).unwrap_or(report.rate);
        }
        report.unphysical = 0;
        Ok(())
    }
}
