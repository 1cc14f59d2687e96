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
    let mut means = Means::new(grid);
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

/// Sums of the bounds of open fractions, lower and upper, by the parts' shares of the whole.
#[derive(Clone, Copy, Debug, Default)]
struct Sum<R> {
    lower: R,
    upper: R,
}

impl<R: Real> Sum<R> {
    fn add(&mut self, share: R, (lower, sum): (&R, &R)) {
        self.lower += share * (R::ONE - sum.min(R::ONE));
        self.upper += share * (R::ONE - *lower);
    }

    /// Bounds of the mean solid fraction.
    fn mean(self) -> Bounds<R> {
        let within = |open: R| open.min(R::ONE);
        Bounds { lower: within(self.lower), upper: within(self.upper) }.complement()
    }
}

/// Sums over a small grid: its cells, and the faces in each plane, `[axis][plane]`.
struct Means<R> {
    /// Shares of the parts along each axis: halves but for rounding, which far from the origin is a share of a small part.
    shares: [[R; 2]; 3],
    cell: Sum<R>,
    planes: [[Sum<R>; 3]; 3],
}

impl<R: Real> Means<R> {
    fn new(grid: &Grid<R>) -> Self {
        let shares = |axis| match *grid.edges(axis) {
            [first, middle, last] => {
                let share = (middle - first) / (last - first);
                // Means of what is alike in all parts are exact by halves.
                let is_half = (share - R::HALF).abs() <= R::from_f64(8.0) * R::EPSILON;
                if is_half { [R::HALF; 2] } else { [share, R::ONE - share] }
            }
            _ => [R::ONE; 2],
        };
        Means { shares: [0, 1, 2].map(shares), cell: Sum::default(), planes: Default::default() }
    }

    fn cells_along_x(layer: &Layer<R>) -> usize {
        layer.lower.cells[0].clamp(1, 2)
    }

    fn add_layer(&mut self, layer: &Layer<R>, k: usize) {
        let nx = Self::cells_along_x(layer);
        for (at, bounds) in layer.lower.cell.iter().zip(&*layer.sum.cell).enumerate() {
            let share = self.share(0, at % nx) * self.share(1, at / nx) * self.share(2, k);
            self.cell.add(share, bounds);
        }
        for (at, bounds) in layer.lower.x.iter().zip(&*layer.sum.x).enumerate() {
            self.add_face(0, at % (nx + 1), [(1, at / (nx + 1)), (2, k)], bounds);
        }
        for (at, bounds) in layer.lower.y.iter().zip(&*layer.sum.y).enumerate() {
            self.add_face(1, at / nx, [(0, at % nx), (2, k)], bounds);
        }
        self.add_plane(layer, k);
    }

    fn add_plane(&mut self, layer: &Layer<R>, plane: usize) {
        let nx = Self::cells_along_x(layer);
        for (at, bounds) in layer.lower.z.iter().zip(&*layer.sum.z).enumerate() {
            self.add_face(2, plane, [(0, at % nx), (1, at / nx)], bounds);
        }
    }

    /// A face in a plane normal to `axis`, with its place along the two other axes.
    fn add_face(&mut self, axis: usize, plane: usize, across: [(usize, usize); 2], bounds: (&R, &R)) {
        let [one, other] = across.map(|(axis, at)| self.share(axis, at));
        if let Some(sum) = self.planes.get_mut(axis).and_then(|planes| planes.get_mut(plane)) {
            sum.add(one * other, bounds);
        }
    }

    /// The share of part `at` along an axis.
    fn share(&self, axis: usize, at: usize) -> R {
        self.shares.get(axis).and_then(|shares| shares.get(at)).copied().unwrap_or_default()
    }

    fn finish(&self) -> Parts<R> {
        Parts { cell: self.cell.mean(), planes: self.planes.map(|planes| planes.map(Sum::mean)) }
    }
}
