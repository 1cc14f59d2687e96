//! The problem: mesh, gas, boundaries, porosity, drag and the choices of the scheme; its contracts, and the rate of its signals.

use crate::flow::boundary::{Boundary, Feed, Patch};
use crate::flow::drag::Drag;
use crate::flow::error::{Error, fits};
use crate::flow::limiter::Limiter;
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::clusters::Clusters;
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE, least_volume};
use crate::flow::porosity::prepare::PreparedView;
use crate::flow::riemann::Riemann;
use crate::flow::state::{Conserved, Fields, Gas, sum};
use crate::number::real::Real;

/// How the pressure acts in a cell whose faces are not as open as its volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PressureForm {
    /// `beta_f p` on the faces and the cell's own pressure on the walls inside it; in smooth media −beta_f grad p.
    Geometric,
    /// The paper's −beta_v grad p. Where `beta_v` differs from the faces it makes entropy at the rate (beta_v − beta_f) u dp/dx.
    Paper,
}

/// The choices of the scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// Riemann solver at the faces.
    pub riemann: Riemann,
    /// Limiter of the slopes.
    pub limiter: Limiter,
    /// Form of the pressure force in a porous medium.
    pub pressure: PressureForm,
}

impl Default for Scheme {
    fn default() -> Self {
        Scheme { riemann: Riemann::Hllc, limiter: Limiter::Steep, pressure: PressureForm::Geometric }
    }
}

/// Everything that stays the same during a step. What it is made of has been checked: a step only looks at its fields.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a, R, const D: usize> {
    pub(in crate::flow) mesh: Mesh<'a, R, D>,
    pub(in crate::flow) gas: Gas<R>,
    /// Low and high side of each axis.
    pub(in crate::flow) boundaries: [[Boundary<R, D>; 2]; D],
    /// Parts of sides where something else stands; of those that overlap, the last.
    pub(in crate::flow) patches: &'a [Patch<R, D>],
    /// What sides and patches feed of a mixed gas.
    pub(in crate::flow) feed: Feed<'a, R, D>,
    pub(in crate::flow) scheme: Scheme,
    /// Open fractions; without them nothing is read.
    pub(in crate::flow) porosity: Option<Porosity<'a, R, D>>,
    /// Clusters of small cells.
    pub(in crate::flow) clusters: Clusters<'a>,
    pub(in crate::flow) drag: Option<Drag<'a, R, D>>,
    pub(in crate::flow) gravity: [R; D],
}

impl<'a, R: Real, const D: usize> Problem<'a, R, D> {
    /// Gas in an open space between its sides, low and high along each axis; the default scheme, no drag, no gravity. Of a mixed gas the sides feed
    /// that of the lowest ratio of specific heats; see [`Problem::with_feed`].
    ///
    /// # Errors
    /// An axis is periodic on one side only, a number of the gas makes no sense, or what stands outside a side is no state of it.
    pub fn new(mesh: Mesh<'a, R, D>, gas: Gas<R>, boundaries: [[Boundary<R, D>; 2]; D]) -> Result<Self, Error> {
        for (axis, [low, high]) in boundaries.iter().enumerate() {
            if low.is_periodic() != high.is_periodic() {
                return Err(Error::HalfPeriodic { axis });
            }
        }
        if !gas.is_sound() {
            return Err(Error::Gas);
        }
        let scheme = Scheme::default();
        let gravity = [R::ZERO; D];
        let (patches, clusters) = (&[][..], Clusters(&[]));
        let feed = Feed { sides: [[gas.gamma(); 2]; D], patches: &[] };
        let problem =
            Problem { mesh, gas, boundaries, patches, feed, scheme, porosity: None, clusters, drag: None, gravity };
        let sides = boundaries.iter().flatten().enumerate().map(|(number, side)| (number / 2, side));
        problem.with_sound_sides(sides)
    }

    /// The same, unless what stands outside one of these sides of axes is no state, or the gas is mixed and it is a reservoir.
    fn with_sound_sides<'b>(self, sides: impl Iterator<Item = (usize, &'b Boundary<R, D>)>) -> Result<Self, Error>
    where
        R: 'b,
    {
        for (axis, side) in sides {
            if !side.is_sound(self.gas) {
                return Err(Error::Side { axis });
            }
            if self.gas.is_mixed() && matches!(side, Boundary::Reservoir { .. }) {
                return Err(Error::MixedReservoir);
            }
        }
        Ok(self)
    }

    /// The same where far fields and inlets feed gases of these ratios of specific heats: of each side, and of each patch that there is.
    ///
    /// # Errors
    /// The gas is not mixed, or one of the ratios is not between its lowest and highest; those of patches are not one for each patch.
    pub fn with_feed(self, feed: Feed<'a, R, D>) -> Result<Self, Error> {
        let Gas::Mixed { gammas: [low, high] } = self.gas else { return Err(Error::Gas) };
        if feed.sides.iter().flatten().chain(feed.patches).any(|gamma| !(*gamma >= low && *gamma <= high)) {
            return Err(Error::Gas);
        }
        if !feed.patches.is_empty() {
            fits(self.patches.len(), feed.patches.len())?;
        }
        Ok(Problem { feed, ..self })
    }

    /// The same with patches on the sides; of those that overlap, the last counts.
    ///
    /// # Errors
    /// A patch names no axis, stands on a periodic side, or is periodic itself; the mesh is a line, whose sides have no parts; what stands outside a patch
    /// is no state of the gas; [`Problem::with_feed`] has told of patches, but not of as many.
    pub fn with_patches(self, patches: &'a [Patch<R, D>]) -> Result<Self, Error> {
        let wrong = |p: &Patch<R, D>| {
            let side = self.boundaries.get(p.axis).map(|sides| sides[usize::from(p.high)]);
            D < 2 || p.boundary.is_periodic() || side.is_none_or(|side| side.is_periodic())
        };
        if !self.feed.patches.is_empty() {
            fits(patches.len(), self.feed.patches.len())?;
        }
        match patches.iter().position(wrong) {
            Some(number) => Err(Error::Patch { number }),
            None => Problem { patches, ..self }.with_sound_sides(patches.iter().map(|p| (p.axis, &p.boundary))),
        }
    }

    /// What stands on a side of an axis beside a cell.
    pub(in crate::flow) fn side(&self, d: usize, high: bool, at: [usize; D]) -> &Boundary<R, D> {
        let patch = self.patches.iter().rev().find(|p| p.covers(d, high, at));
        patch.map_or(&self.boundaries[d][usize::from(high)], |p| &p.boundary)
    }

    /// Capacity of the gas beyond a side (an axis, and whether it is the high one) beside a cell: what the side feeds, else that `inside`.
    pub(in crate::flow) fn capacity_beyond(&self, (d, high): (usize, bool), at: [usize; D], inside: R) -> R {
        if !self.side(d, high, at).feeds() {
            return inside;
        }
        let patch = self.patches.iter().rposition(|p| p.covers(d, high, at));
        let of_patch = patch.map(|n| self.feed.patches.get(n).copied().unwrap_or(self.gas.gamma()));
        let gamma = of_patch.unwrap_or(self.feed.sides[d][usize::from(high)]);
        Gas::Ideal { gamma }.capacity()
    }

    /// The same by other choices of the scheme.
    #[must_use]
    pub const fn with_scheme(self, scheme: Scheme) -> Self {
        Problem { scheme, ..self }
    }

    /// The same under an acceleration of gravity; zero costs nothing.
    #[must_use]
    pub const fn with_gravity(self, gravity: [R; D]) -> Self {
        Problem { gravity, ..self }
    }

    /// The same in a porous space.
    ///
    /// # Errors
    /// The space was prepared for another mesh, or for other periodic axes.
    pub fn with_porosity(self, space: PreparedView<'a, R, D>) -> Result<Self, Error> {
        if space.cells != self.mesh.cells() || space.periodic != self.periodic() {
            return Err(Error::OtherMesh);
        }
        Ok(Problem { porosity: Some(space.porosity), clusters: space.clusters, ..self })
    }

    /// The same with drag of sub-grid obstacles.
    ///
    /// # Errors
    /// A slice of coefficients that is not empty does not fit the mesh.
    pub fn with_drag(self, drag: Drag<'a, R, D>) -> Result<Self, Error> {
        for s in drag.quadratic.iter().chain(&drag.linear).filter(|s| !s.is_empty()) {
            fits(self.mesh.len(), s.len())?;
        }
        Ok(Problem { drag: Some(drag), ..self })
    }

    /// Cells and widths.
    pub const fn mesh(&self) -> Mesh<'a, R, D> {
        self.mesh
    }

    /// The gas.
    pub const fn gas(&self) -> Gas<R> {
        self.gas
    }

    /// The cell at a flat index of a field that fits is physical, and of a mixed gas its capacity within the bounds.
    pub(in crate::flow) fn holds(&self, field: &Fields<'_, R, D>, cell: usize) -> bool {
        let [least, most] = self.gas.capacities();
        let mixed = self.gas.is_mixed();
        let within = !mixed || field.capacity.get(cell).is_some_and(|c| *c >= least && *c <= most);
        within && self.is_physical(&field.at(cell))
    }

    /// Positive density and pressure, all finite.
    pub fn is_physical(&self, u: &Conserved<R, D>) -> bool {
        let w = self.gas.primitive(u);
        let finite = u.momentum.iter().all(|m| m.is_finite()) && u.density.is_finite() && w.pressure.is_finite();
        finite && u.density > R::ZERO && w.pressure > R::ZERO
    }

    /// The axis has periodic ends.
    pub fn periodic(&self) -> [bool; D] {
        self.boundaries.map(|b| b[0].is_periodic())
    }

    pub(in crate::flow) fn check_fields(&self, old: &Fields<'_, R, D>) -> Result<(), Error> {
        self.fits(old, self.mesh.len())
    }

    pub(in crate::flow) fn fits(&self, f: &Fields<'_, R, D>, expected: usize) -> Result<(), Error> {
        let energy = if self.gas.has_energy() { f.energy.len() } else { expected };
        let capacity = if self.gas.is_mixed() { f.capacity.len() } else { expected };
        let lengths = f.momentum.iter().map(|m| m.len()).chain([f.density.len(), energy, capacity]);
        lengths.into_iter().try_for_each(|found| fits(expected, found))
    }

    /// The porous space, if it is one.
    pub(in crate::flow) fn medium(&self) -> Option<Medium<'_, R, D>> {
        let porosity = self.porosity?;
        Some(Medium { mesh: self.mesh, porosity, periodic: self.periodic() })
    }

    /// Signal rate of one cell, jumps and merging included.
    pub(in crate::flow) fn cell_rate(&self, field: &Fields<'_, R, D>, cell: usize) -> R {
        let gas = field.gas_at(self.gas, cell);
        let w = gas.primitive(&field.at(cell));
        let c = gas.sound_speed(&w);
        let at = self.mesh.coordinates(cell);
        sum::<R, D>(core::array::from_fn(|d| {
            let t = (w.velocity[d].abs() + c) / self.mesh.widths[d][at[d]];
            match self.medium() {
                None => t,
                Some(medium) => t * self.openness(&medium.ducts(d, at), 0),
            }
        }))
    }

    /// Open area over open volume of a cell along the axis of its ducts, as far as it limits the step.
    #[inline(always)]
    pub(in crate::flow) fn openness(&self, ducts: &Ducts<'_, R>, i: usize) -> R {
        let (low, high) = ducts.passages(i);
        // Rounded as in the step, which has the inverse at hand.
        let ratio = R::larger(low, high) * (R::ONE / R::larger(ducts.volume(i), least_volume()));
        if self.clusters.0.is_empty() || !ducts.is_small(i) {
            return ratio;
        }
        // A cluster holds its share of the volume that its widest face asks for; a throat may be wider than its face.
        let widening = if ducts.breaks(i, false) || ducts.breaks(i, true) { R::TWO } else { R::ONE };
        R::smaller(ratio, widening * R::from_f64(1.0 / SMALL_SHARE))
    }

    /// Largest signal rate of a field, for the first step; refuses an unphysical cell.
    pub fn rate(&self, field: &Fields<'_, R, D>) -> Result<R, Error> {
        self.check_fields(field)?;
        let mut rate = R::ZERO;
        for cell in 0..self.mesh.len() {
            if !self.holds(field, cell) {
                return Err(Error::Unphysical { cell });
            }
            rate = R::larger(self.cell_rate(field, cell), rate);
        }
        Ok(rate)
    }
}
