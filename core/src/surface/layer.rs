//! The door of this room: porosity of the layers of a grid from bodies of triangles, overlaps counted once.
//!
//! [`Layers`] checks bodies and sorts their triangles by layer, once. [`Layers::layer`] then gives the open fractions of one layer of cells
//! and of its faces: each body's share by [`crate::surface::cells`] and [`crate::surface::z_faces`], exact unions where bodies share
//! cells, and where a union has no proof the cell is divided, each part a layer of its own in what is left of the caller's memory. If
//! depth or memory is spent, what remains are bounds, and [`LayerReport::max_gap`] says how wide.
//!
//! A layer needs no result of another, so threads may share [`Layers`]; each has a [`LayerMemory`] of its own.

use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::{Fields, Layer, ShapeMismatch, at_least, exactly};
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, BinsError, BinsNeeded, Group, Surface};
use crate::surface::cell_unions::{self, OtherBodies, Parts, Room, Shared, Site};
use crate::surface::cells::{Defects, Scratch, SurfaceError, add_body};
use crate::surface::union::UnionMemory;
use crate::surface::walls;
use crate::surface::z_faces::{Side, add_section};
use core::fmt;
use core::ops::Range;

/// What to compute and how far to refine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerOptions<R> {
    /// Where a union has no proof, divide the cell until its bounds are this close.
    pub tol: R,
    /// How often such a cell may be divided by 2 along each axis.
    pub depth: u32,
    /// Compute the faces; without, their slices are empty.
    pub areas: bool,
    /// Where between its bounds a value lies: 0 at the open end, 1 at the solid one.
    pub solid_end: R,
}

impl<R: Real> Default for LayerOptions<R> {
    /// Bounds as close as 10⁻⁴, at most 6 divisions, faces, values in the middle of their bounds.
    fn default() -> Self {
        LayerOptions { tol: R::from_f64(1e-4), depth: 6, areas: true, solid_end: R::HALF }
    }
}

/// Cells of a layer by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellKinds {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Of the cut cells: shared by several bodies, so that their union had to be found.
    pub ambiguous: usize,
}

/// What a layer holds, and how well it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerReport<R> {
    /// Cells by kind.
    pub cells: CellKinds,
    /// Solid volume, in the unit of the grid.
    pub solid_volume: R,
    /// Largest distance of the bounds of any cell or face.
    pub max_gap: R,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// The worst of the bodies' surfaces in this layer.
    pub defects: Defects<R>,
}

/// Why there is no porosity of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayerError {
    /// The grid has no such layer.
    NoLayer {
        /// The layer asked for.
        layer: usize,
        /// How many there are.
        layers: usize,
    },
    /// A slice has the wrong length.
    Shape(ShapeMismatch),
    /// The memory was made for a grid with another number of cells along x and y.
    OtherGrid,
}

impl From<ShapeMismatch> for LayerError {
    fn from(error: ShapeMismatch) -> Self {
        LayerError::Shape(error)
    }
}

impl fmt::Display for LayerError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            LayerError::NoLayer { layer, layers } => write!(f, "layer {layer} of a grid of {layers} layers"),
            LayerError::Shape(mismatch) => mismatch.fmt(f),
            LayerError::OtherGrid => f.write_str("memory made for a grid with other numbers of cells along x and y"),
        }
    }
}

impl core::error::Error for LayerError {}

/// Where the values of one layer go: cells `ny*nx`, x faces `ny*(nx+1)`, y faces `(ny+1)*nx`, z faces below the cells `ny*nx`, and
/// for the topmost layer those above it; x fastest. Face slices are empty where faces are not wanted.
#[derive(Debug)]
pub struct LayerSlices<'a, R> {
    cell: &'a mut [R],
    x: &'a mut [R],
    y: &'a mut [R],
    z: &'a mut [R],
    top: &'a mut [R],
}

impl<'a, R: Real> LayerSlices<'a, R> {
    /// Layer `k` of whole fields of the grid: cells `nx*ny*nz`, x faces `(nx+1)*ny*nz`, y faces `nx*(ny+1)*nz`, z faces `nx*ny*(nz+1)`.
    /// Face fields that are not wanted are all empty.
    ///
    /// # Errors
    /// [`LayerError`] for a layer that the grid has not, or the first field of wrong length.
    pub fn of_fields(grid: &Grid<R>, k: usize, cell: &'a mut [R], faces: [&'a mut [R]; 3]) -> Result<Self, LayerError> {
        let [nx, ny, nz] = grid.cells();
        if k >= nz {
            return Err(LayerError::NoLayer { layer: k, layers: nz });
        }
        exactly(nx * ny * nz, cell.len())?;
        if !faces.iter().all(|f| f.is_empty()) {
            for (axis, field) in faces.iter().enumerate() {
                exactly(grid.face_shape(axis).into_iter().product(), field.len())?;
            }
        }
        let [x, y, z] = faces;
        let (z, top) = z.split_at_mut(z.len().min(nx * ny * (k + 1)));
        Ok(LayerSlices {
            cell: nth(cell, k, nx * ny),
            x: nth(x, k, (nx + 1) * ny),
            y: nth(y, k, nx * (ny + 1)),
            z: nth(z, k, nx * ny),
            top: if k + 1 == nz { top } else { &mut [] },
        })
    }

    /// Five slices; what they must hold, [`Layers::layer`] checks.
    #[must_use]
    pub fn new(cell: &'a mut [R], x: &'a mut [R], y: &'a mut [R], z: &'a mut [R], top: &'a mut [R]) -> Self {
        LayerSlices { cell, x, y, z, top }
    }

    /// The faces normal to an axis (0, 1, otherwise 2), but for those above the layer.
    fn faces(&mut self, axis: usize) -> &mut [R] {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    fn check(&self, grid: &Grid<R>, k: usize, areas: bool) -> Result<(), ShapeMismatch> {
        let [nx, ny, nz] = grid.cells();
        let wanted = |count: usize| if areas { count } else { 0 };
        exactly(nx * ny, self.cell.len())?;
        exactly(wanted((nx + 1) * ny), self.x.len())?;
        exactly(wanted(nx * (ny + 1)), self.y.len())?;
        exactly(wanted(nx * ny), self.z.len())?;
        exactly(if k + 1 == nz { wanted(nx * ny) } else { 0 }, self.top.len())
    }
}

/// The slice number `n` of equal slices; empty if there is none.
fn nth<R>(all: &mut [R], n: usize, length: usize) -> &mut [R] {
    all.get_mut(n * length..(n + 1) * length).unwrap_or_default()
}

/// Lengths of the memory that any layer can do with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryNeeded {
    /// Of scalars; must be met.
    pub reals: usize,
    /// Of flags; must be met.
    pub flags: usize,
    /// Of numbers. With less, cells that bodies share may keep their bounds.
    pub numbers: usize,
    /// Of groups. With less, cells that bodies share may keep their bounds.
    pub groups: usize,
}

/// A cell is not halved more often along an axis: its middle would be one of its ends.
const MOST_HALVINGS: u32 = f64::MANTISSA_DIGITS;

/// Scalars and flags that a level of division takes: a layer of 2 × 2 cells, and the sums of one body.
const PART_FIELDS: usize = 4 * 4 + 2 + 2;
/// Scalars of a level: lower bounds, sums, and scratch.
const PART_REALS: usize = 2 * PART_FIELDS + 2 * 4 + 4 + 2 * 4;

/// A thread's memory for layers, cut from the caller's slices.
#[derive(Debug)]
pub struct LayerMemory<'a, V: Vector> {
    cells: [usize; 2],
    /// Sums of shares; all zero between two layers.
    sum: &'a mut [V::Scalar],
    /// Lower bounds of fields that have no slice of their own.
    spare: &'a mut [V::Scalar],
    scratch: &'a mut [V::Scalar],
    has_surface: &'a mut [u8],
    reals: &'a mut [V::Scalar],
    flags: &'a mut [u8],
    numbers: &'a mut [u32],
    groups: &'a mut [Group<V>],
    union: UnionMemory<'a, V::Scalar>,
}

impl<'a, V: Vector> LayerMemory<'a, V> {
    /// The least lengths: enough for bodies that share no cells.
    #[must_use]
    pub fn needed(grid: &Grid<V::Scalar>) -> MemoryNeeded {
        let fields = Fields::<u8>::needed(grid);
        MemoryNeeded { reals: 2 * fields + Scratch::needed(grid), flags: fields, numbers: 0, groups: 0 }
    }

    /// Cut memory for layers of `grid`; what the slices hold does not matter. [`Layers::memory_needed`] tells lengths that are always
    /// enough. With less of numbers, groups and `union`, cells that bodies share may keep bounds instead of a value.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if there are too few scalars or flags for a single body.
    pub fn new(
        grid: &Grid<V::Scalar>,
        reals: &'a mut [V::Scalar],
        flags: &'a mut [u8],
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
        union: UnionMemory<'a, V::Scalar>,
    ) -> Result<Self, ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        let fields = Fields::<u8>::needed(grid);
        let short = ShapeMismatch { expected: 2 * fields + Scratch::needed(grid), found: reals.len() };
        let (sum, reals) = reals.split_at_mut_checked(fields).ok_or(short)?;
        let (spare, reals) = reals.split_at_mut_checked(fields).ok_or(short)?;
        let (scratch, reals) = reals.split_at_mut_checked(Scratch::needed(grid)).ok_or(short)?;
        at_least(fields, flags.len())?;
        let short = ShapeMismatch { expected: fields, found: flags.len() };
        let (has_surface, flags) = flags.split_at_mut_checked(fields).ok_or(short)?;
        sum.fill(V::Scalar::ZERO);
        Ok(LayerMemory { cells: [nx, ny], sum, spare, scratch, has_surface, reals, flags, numbers, groups, union })
    }
}

/// Bodies in a grid, sorted by layer. Threads may share it.
#[derive(Clone, Copy, Debug)]
pub struct Layers<'a, V: Vector> {
    grid: Grid<'a, V::Scalar>,
    bins: Bins<'a, V>,
    options: LayerOptions<V::Scalar>,
}

impl<'a, V: Vector> Layers<'a, V> {
    /// Memory for [`Layers::new`].
    #[must_use]
    pub fn needed(grid: &Grid<V::Scalar>, bodies: &[Surface<V>]) -> BinsNeeded {
        Bins::needed(grid, bodies)
    }

    /// Sort the triangles of `bodies` into the layers of `grid`, in memory of the caller; what the slices hold does not matter.
    ///
    /// # Errors
    /// [`BinsError`]: a coordinate that is no number, memory that is too small.
    pub fn new(
        grid: &Grid<'a, V::Scalar>,
        bodies: &'a [Surface<'a, V>],
        options: LayerOptions<V::Scalar>,
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
    ) -> Result<Self, BinsError> {
        Ok(Layers { grid: *grid, bins: Bins::new(grid, bodies, numbers, groups)?, options })
    }

    /// Lengths of the memory with which any layer is refined as far as the depth allows.
    #[must_use]
    pub fn memory_needed(&self) -> MemoryNeeded {
        let [nx, ny, nz] = self.grid.cells();
        // A part of a cell takes triangles of one layer, or of two beside a wall, each in at most two layers of its own and in a row.
        let (mut numbers, mut groups) = (0, 0);
        for k in 0..nz {
            let (a, b) = (self.bins.count(k), self.bins.count(k + 1));
            (numbers, groups) = (numbers.max(a.numbers + b.numbers), groups.max(a.groups + b.groups));
        }
        let levels = 3 * self.options.depth.min(MOST_HALVINGS) as usize + 1;
        let each = 3 * levels;
        let least = LayerMemory::<V>::needed(&self.grid);
        MemoryNeeded {
            reals: least.reals + levels * PART_REALS,
            flags: least.flags + levels * PART_FIELDS,
            numbers: 2 * (nx + ny + 2) + numbers.saturating_mul(each) + levels * PART_NUMBERS,
            groups: groups.saturating_mul(each),
        }
    }

    /// How many bodies of triangles reach layer `k`.
    #[must_use]
    pub fn bodies_in(&self, k: usize) -> usize {
        self.bins.groups(k).len()
    }

    /// Open fractions of layer `k`: 1 open, 0 blocked, the value between its bounds as the options say. `bounds` are those of the same
    /// fractions, lower and upper, if wanted.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn layer(
        &self,
        k: usize,
        beta: LayerSlices<V::Scalar>,
        bounds: Option<[LayerSlices<V::Scalar>; 2]>,
        memory: &mut LayerMemory<V>,
    ) -> Result<LayerReport<V::Scalar>, LayerError> {
        for field in [&mut *beta.cell, beta.x, beta.y, beta.z] {
            field.fill(V::Scalar::ZERO);
        }
        self.zeroed_layer(k, beta, bounds, memory, &mut (), |_, _| ())
    }

    /// As [`Layers::layer`], for slices of `beta` that hold zeros; with bodies beside those of triangles, and a function that is told what
    /// is wrong with each body's surface in this layer.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn zeroed_layer<O: OtherBodies<V>>(
        &self,
        k: usize,
        beta: LayerSlices<V::Scalar>,
        mut bounds: Option<[LayerSlices<V::Scalar>; 2]>,
        memory: &mut LayerMemory<V>,
        others: &mut O,
        each_body: impl FnMut(usize, Defects<V::Scalar>),
    ) -> Result<LayerReport<V::Scalar>, LayerError> {
        self.check(k, &beta, bounds.as_ref(), memory)?;
        let LayerSlices { cell, x, y, z, top } = beta;
        let LayerOptions { tol, depth, areas, solid_end } = self.options;
        let LayerMemory { sum, spare, scratch, has_surface, reals, flags, numbers, groups, union, .. } = memory;
        let mut shared = Shared { tol, others, union: union.reborrow(), parts };
        let site = Site { grid: &self.grid, bins: &self.bins, k, halvings: 3 * depth.min(MOST_HALVINGS), areas };
        let mut room = Room { reals, flags, numbers, groups };
        let mut layer = Layer {
            lower: Fields::within(&self.grid, spare)?,
            sum: Fields::within(&self.grid, sum)?,
            has_surface: Fields::within(&self.grid, has_surface)?,
        };
        let mut scratch = Scratch::new(&self.grid, scratch)?;
        layer.has_surface.fill(0);
        let mut wanted = layer.reborrow();
        if areas {
            wanted.lower = Fields::new(&self.grid, cell, x, y, z)?;
        } else {
            (0..3).for_each(|axis| wanted.lower.faces_mut(axis).fill(V::Scalar::ZERO));
            wanted.lower.cell = cell;
        }
        let mut report = solid_bounds(&mut shared, &site, &mut wanted, &mut scratch, room.reborrow(), each_body);
        count_cells(&site, &wanted, solid_end, &mut report);
        to_open_fractions(&mut wanted, areas, bounds.as_mut(), solid_end, &mut report.max_gap);
        if !top.is_empty() {
            solid_bounds_on_top(&mut shared, &site, &mut layer, &mut scratch, room);
            let [low, high] = match &mut bounds {
                Some([low, high]) => [Some(&mut *low.top), Some(&mut *high.top)],
                None => [None, None],
            };
            open_field(layer.lower.z, layer.sum.z, low, high, solid_end, &mut report.max_gap);
            top.iter_mut().zip(&*layer.lower.z).for_each(|(top, z)| *top = *z);
        }
        Ok(report)
    }

    fn check(
        &self,
        k: usize,
        beta: &LayerSlices<V::Scalar>,
        bounds: Option<&[LayerSlices<V::Scalar>; 2]>,
        memory: &LayerMemory<V>,
    ) -> Result<(), LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        if memory.cells != [nx, ny] {
            return Err(LayerError::OtherGrid);
        }
        for slices in core::iter::once(beta).chain(bounds.into_iter().flatten()) {
            slices.check(&self.grid, k, self.options.areas)?;
        }
        Ok(())
    }
}

/// Bounds of the solid fractions of a layer: body by body, narrowed where bodies share cells. `layer` holds zeros before.
fn solid_bounds<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
    mut room: Room<V>,
    mut each_body: impl FnMut(usize, Defects<V::Scalar>),
) -> LayerReport<V::Scalar> {
    let mut report = LayerReport::default();
    let groups = site.bins.groups(site.k);
    for group in groups {
        // All that could be refused has been checked; if it were not, the body would be told as broken.
        let broken = Defects { leak: V::Scalar::INFINITY, winding: V::Scalar::INFINITY };
        let defects = add_group(site, group, layer, scratch).unwrap_or(broken);
        report.defects = report.defects.worst(defects);
        each_body(group.body as usize, defects);
    }
    shared.others.add(site.grid, site.k, site.areas, layer);
    if groups.len() > usize::from(shared.others.is_empty()) {
        let resolved = cell_unions::resolve(shared, site, layer, room.reborrow());
        walls::resolve(shared, site, layer, room);
        (report.cells.ambiguous, report.divided) = (resolved.ambiguous, resolved.divided);
    }
    report
}

/// Add a body to the cells and faces of a layer.
fn add_group<V: Vector>(
    site: &Site<V>,
    group: &Group<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
) -> Result<Defects<V::Scalar>, SurfaceError> {
    let (triangles, ids) = (site.bins.triangles(group), site.bins.ids(group));
    let mut defects = add_body(site.grid, site.k, triangles, ids, scratch, layer)?;
    if site.areas {
        let leak = add_section(site.grid, site.k, Side::Above, triangles, ids, scratch, layer)?;
        defects.leak = defects.leak.max(leak);
    }
    Ok(defects)
}

/// Bounds of the solid fractions of the z faces above a layer, as the z faces of `layer`, whose sums hold zeros before.
fn solid_bounds_on_top<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
    mut room: Room<V>,
) {
    layer.lower.z.fill(V::Scalar::ZERO);
    layer.has_surface.z.fill(0);
    for group in site.bins.groups(site.k) {
        let (triangles, ids) = (site.bins.triangles(group), site.bins.ids(group));
        // What it leaks the section below told, or the one above the grid, which is not asked.
        let _ = add_section(site.grid, site.k + 1, Side::Below, triangles, ids, scratch, layer);
    }
    shared.others.add_plane(site.grid, site.k + 1, layer);
    cell_unions::resolve_top(shared, site, layer, room.reborrow());
    walls::resolve_top(shared, site, layer, room);
}

/// Numbers that a level of division takes beside triangles: steps along rows and columns, and the book of its layers.
const PART_NUMBERS: usize = 2 * (2 + 2 + 2) + 3 * 2 + 2;

/// Bounds of the parts of a small grid within some layers of a site; none if memory is spent.
fn parts<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    grid: &Grid<V::Scalar>,
    layers: Range<usize>,
    room: Room<V>,
) -> Option<Parts<V::Scalar>> {
    let Room { reals, flags, numbers, groups } = room;
    let (bins, (numbers, groups)) = site.bins.part(grid, layers, numbers, groups).ok()?;
    let fields = Fields::<u8>::needed(grid);
    let (lower, reals) = reals.split_at_mut_checked(fields)?;
    let (sum, reals) = reals.split_at_mut_checked(fields)?;
    let (scratch, reals) = reals.split_at_mut_checked(Scratch::needed(grid))?;
    let (has_surface, flags) = flags.split_at_mut_checked(fields)?;
    let mut room = Room { reals, flags, numbers, groups };
    let mut scratch = Scratch::new(grid, scratch).ok()?;
    let fields = (Fields::within(grid, lower).ok()?, Fields::within(grid, sum).ok()?);
    let mut layer = Layer::new(fields.0, fields.1, Fields::within(grid, has_surface).ok()?).ok()?;
    let mut means = Means::default();
    let count = grid.cells()[2];
    for k in 0..count {
        let part = Site { grid, bins: &bins, k, areas: true, ..*site };
        layer.clear();
        solid_bounds(shared, &part, &mut layer, &mut scratch, room.reborrow(), |_, _| ());
        means.add_layer(&layer, k);
        if k + 1 == count {
            layer.sum.z.fill(V::Scalar::ZERO);
            solid_bounds_on_top(shared, &part, &mut layer, &mut scratch, room.reborrow());
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
            self.add_face(0, at % (nx + 1), share);
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

/// Count the cells of a layer and add up their solid volume.
fn count_cells<V: Vector>(
    site: &Site<V>,
    layer: &Layer<V::Scalar>,
    end: V::Scalar,
    report: &mut LayerReport<V::Scalar>,
) {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let [nx, _, _] = site.grid.cells();
    let [x, y, z] = [0, 1, 2].map(|axis| site.grid.edges(axis).windows(2));
    let width = |pair: &[V::Scalar]| if let [lo, hi] = pair { *hi - *lo } else { zero };
    let height = z.skip(site.k).map(width).next().unwrap_or(zero);
    let Layer { lower, sum, has_surface } = layer;
    let rows = lower.cell.chunks_exact(nx).zip(sum.cell.chunks_exact(nx)).zip(has_surface.cell.chunks_exact(nx));
    for (((lower, sum), has_surface), depth) in rows.zip(y.map(width)) {
        if has_surface.iter().all(|&s| s == 0) && sum.iter().all(|&s| s == zero) {
            report.cells.open += nx;
            continue;
        }
        let mut volume = zero;
        for (((&lower, &sum), &has_surface), width) in lower.iter().zip(sum).zip(has_surface).zip(x.clone().map(width))
        {
            let upper = sum.min(one);
            volume += (lower * (one - end) + upper * end) * width;
            if lower == one {
                report.cells.closed += 1;
            } else if upper == zero && has_surface == 0 {
                report.cells.open += 1;
            } else {
                report.cells.cut += 1;
            }
        }
        report.solid_volume += volume * depth * height;
    }
}

/// Turn the solid bounds of a layer into open fractions, but for the faces above it. Leaves zeros in the sums.
fn to_open_fractions<R: Real>(
    layer: &mut Layer<R>,
    areas: bool,
    bounds: Option<&mut [LayerSlices<R>; 2]>,
    end: R,
    max_gap: &mut R,
) {
    let (mut low, mut high) = match bounds {
        Some([low, high]) => (Some(low), Some(high)),
        None => (None, None),
    };
    let (lower, sum) = layer.cells_mut();
    open_field(lower, sum, low.as_mut().map(|s| &mut *s.cell), high.as_mut().map(|s| &mut *s.cell), end, max_gap);
    for axis in 0..3 {
        let (lower, sum) = layer.faces_mut(axis);
        if areas {
            let (low, high) = (low.as_mut().map(|s| s.faces(axis)), high.as_mut().map(|s| s.faces(axis)));
            open_field(lower, sum, low, high, end, max_gap);
        } else {
            sum.fill(R::ZERO);
        }
    }
}

/// Turn solid bounds into open fractions: the value, a share `end` of the way between them, goes to `lower`, the bounds to `low` and
/// `high` if wanted. Leaves zeros in `sum` for the next layer.
fn open_field<R: Real>(
    lower: &mut [R],
    sum: &mut [R],
    low: Option<&mut [R]>,
    high: Option<&mut [R]>,
    end: R,
    max_gap: &mut R,
) {
    if let Some(low) = low {
        low.iter_mut().zip(&*sum).for_each(|(low, sum)| *low = R::ONE - sum.min(R::ONE));
    }
    if let Some(high) = high {
        high.iter_mut().zip(&*lower).for_each(|(high, lower)| *high = R::ONE - *lower);
    }
    let open = |l: &mut R, s: &mut R, widest: &mut R| {
        let upper = s.smaller(R::ONE);
        *widest = (upper - *l).larger(*widest);
        (*l, *s) = (R::ONE - (*l * (R::ONE - end) + upper * end), R::ZERO);
    };
    // Eight running maxima need no order, so the loop is done by vectors.
    let mut widest = [R::ZERO; 8];
    let ((lower, lower_rest), (sum, sum_rest)) = (lower.as_chunks_mut::<8>(), sum.as_chunks_mut::<8>());
    for (l, s) in lower.iter_mut().zip(sum) {
        for n in 0..8 {
            open(&mut l[n], &mut s[n], &mut widest[n]);
        }
    }
    for (l, s) in lower_rest.iter_mut().zip(sum_rest) {
        open(l, s, &mut widest[0]);
    }
    *max_gap = widest.into_iter().fold(*max_gap, R::max);
}
