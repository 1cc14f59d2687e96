//! A cell divided: its parts are layers of their own, and their means are the bounds of the whole.

use super::memory::MemoryNeeded;
use super::solid_bounds::{solid_bounds, solid_bounds_on_top};
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::{Fields, Layer};
use crate::number::real::{Real, Vector};
use crate::surface::bins::Bins;
use crate::surface::cells::Scratch;
use crate::surface::division::{Shared, Site, SpareMemory};
use crate::surface::other_bodies::OtherBodies;
use crate::surface::refined::Parts;
use core::ops::Range;

/// Scalars and flags that a level of division takes: a layer of 2 × 2 cells, and the sums of one body.
const FIELDS: usize = 4 * 4 + 2 + 2;

/// Memory that a level of division takes, beside triangles: fields twice and scratch; flags; steps along rows and columns, and the book
/// of its layers.
pub(super) const LEVEL: MemoryNeeded = MemoryNeeded {
    reals: 2 * FIELDS + 2 * 4 + 4 + 2 * 4,
    flags: FIELDS,
    numbers: 2 * (2 + 2 + 2) + 3 * 2 + 2,
    groups: 0,
};

/// A small grid within some layers of a site: its triangles, sums for one of its layers, and the memory left over.
pub(super) struct SmallGrid<'m, V: Vector> {
    pub bins: Bins<'m, V>,
    pub layer: Layer<'m, V::Scalar>,
    pub scratch: Scratch<'m, V::Scalar>,
    pub spare: SpareMemory<'m, V>,
}

impl<'m, V: Vector> SmallGrid<'m, V> {
    /// None if memory is spent.
    pub fn new(
        site: &Site<'m, V>,
        grid: &Grid<V::Scalar>,
        layers: Range<usize>,
        spare: SpareMemory<'m, V>,
    ) -> Option<Self> {
        let SpareMemory { reals, flags, numbers, groups } = spare;
        let (bins, (numbers, groups)) = site.bins.part(grid, layers, numbers, groups).ok()?;
        let fields = Fields::<u8>::needed(grid);
        let (lower, reals) = reals.split_at_mut_checked(fields)?;
        let (sum, reals) = reals.split_at_mut_checked(fields)?;
        let (scratch, reals) = reals.split_at_mut_checked(Scratch::needed(grid))?;
        let (has_surface, flags) = flags.split_at_mut_checked(fields)?;
        let spare = SpareMemory { reals, flags, numbers, groups };
        let scratch = Scratch::new(grid, scratch).ok()?;
        let (lower, sum) = (Fields::within(grid, lower).ok()?, Fields::within(grid, sum).ok()?);
        let layer = Layer::new(lower, sum, Fields::within(grid, has_surface).ok()?).ok()?;
        Some(SmallGrid { bins, layer, scratch, spare })
    }
}

/// Bounds of the parts of a small grid within some layers of a site; none if memory is spent.
pub(super) fn parts<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    grid: &Grid<V::Scalar>,
    layers: Range<usize>,
    spare: SpareMemory<V>,
) -> Option<Parts<V::Scalar>> {
    let SmallGrid { bins, mut layer, mut scratch, mut spare } = SmallGrid::new(site, grid, layers, spare)?;
    let mut means = Means::default();
    let count = grid.cells()[2];
    for k in 0..count {
        let part = Site { grid, bins: &bins, k, areas: true, ..*site };
        layer.clear();
        solid_bounds(shared, &part, &mut layer, &mut scratch, spare.reborrow(), &mut (), |_, _| ());
        means.add_layer(&layer, k);
        if k + 1 == count {
            layer.sum.z.fill(V::Scalar::ZERO);
            solid_bounds_on_top(shared, &part, &mut layer, &mut scratch, spare.reborrow());
            means.add_plane(&layer, count);
        }
    }
    Some(means.finish())
}

/// Sums of the bounds of open fractions, lower and upper, and their number.
#[derive(Clone, Copy, Debug, Default)]
struct Sum<R> {
    lower: R,
    upper: R,
    count: usize,
}

impl<R: Real> Sum<R> {
    fn add(&mut self, (lower, sum): (&R, &R)) {
        self.lower += R::ONE - sum.min(R::ONE);
        self.upper += R::ONE - *lower;
        self.count += 1;
    }

    /// Bounds of the mean solid fraction.
    fn mean(self) -> Bounds<R> {
        let count = R::from_usize(self.count.max(1));
        Bounds { lower: self.lower / count, upper: self.upper / count }.complement()
    }
}

/// Sums over a small grid: its cells, and the faces in each plane, `[axis][plane]`.
#[derive(Default)]
struct Means<R> {
    cell: Sum<R>,
    planes: [[Sum<R>; 3]; 3],
}

impl<R: Real> Means<R> {
    fn add_layer(&mut self, layer: &Layer<R>, k: usize) {
        let [nx, _] = layer.lower.cells;
        layer.lower.cell.iter().zip(&*layer.sum.cell).for_each(|share| self.cell.add(share));
        for (at, share) in layer.lower.x.iter().zip(&*layer.sum.x).enumerate() {
            self.add_face(0, at.checked_rem(nx + 1).unwrap_or(0), share);
        }
        for (at, share) in layer.lower.y.iter().zip(&*layer.sum.y).enumerate() {
            self.add_face(1, at / nx.max(1), share);
        }
        self.add_plane(layer, k);
    }

    fn add_plane(&mut self, layer: &Layer<R>, plane: usize) {
        layer.lower.z.iter().zip(&*layer.sum.z).for_each(|share| self.add_face(2, plane, share));
    }

    fn add_face(&mut self, axis: usize, plane: usize, share: (&R, &R)) {
        if let Some(sum) = self.planes.get_mut(axis).and_then(|planes| planes.get_mut(plane)) {
            sum.add(share);
        }
    }

    fn finish(&self) -> Parts<R> {
        Parts { cell: self.cell.mean(), planes: self.planes.map(|planes| planes.map(Sum::mean)) }
    }
}
