//! Porosity fields of bodies on a grid: the layers of [`voidage_core`] in threads, unions where bodies share cells.
//!
//! A layer of cells depends on no other, and what a thread writes depends only on the layer: the bits are the same for
//! any number of threads.

mod bins;
mod unions;

use crate::bodies::Bodies;
use bins::Bins;
use rayon::prelude::*;
use serde::Serialize;
use unions::Unions;
use voidage_core::grid::Grid;
use voidage_core::layer::{Fields, Layer, gap};
use voidage_core::section::{Side, add_section};
use voidage_core::surface::{Scratch, add_body};

/// What to compute and how far to refine.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Unions are found exactly; where one has no proof, divide the cell until its bounds are this close.
    pub tol: f64,
    /// How often a cell whose union has no proof may be divided by 2 along each axis.
    pub depth: u32,
    /// Keep lower and upper bounds of all fields.
    pub bounds: bool,
    /// Compute the faces; without, their fields stay empty.
    pub areas: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { tol: 1e-4, depth: 5, bounds: false, areas: true }
    }
}

/// A value for every cell and face of a grid, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FieldSet {
    /// Cells, `nx*ny*nz`.
    pub v: Vec<f64>,
    /// x faces, `(nx+1)*ny*nz`.
    pub x: Vec<f64>,
    /// y faces, `nx*(ny+1)*nz`.
    pub y: Vec<f64>,
    /// z faces, `nx*ny*(nz+1)`.
    pub z: Vec<f64>,
}

impl FieldSet {
    /// All zero; without `areas` the face fields are empty.
    fn new(grid: &Grid<f64>, areas: bool) -> Self {
        let faces = |axis| if areas { vec![0.0; grid.face_shape(axis).iter().product()] } else { Vec::new() };
        FieldSet { v: vec![0.0; grid.cell_count()], x: faces(0), y: faces(1), z: faces(2) }
    }
}

/// Cells by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CellCounts {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Shared by several bodies so that their union had to be found, or remained between bounds.
    pub ambiguous: usize,
}

/// Where a body's surface fails to close.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Leak {
    /// The body.
    pub body: usize,
    /// The worst row, as a fraction of a face.
    pub fraction: f64,
    /// Its layer of cells.
    pub layer: usize,
}

/// Porosities of a grid.
#[derive(Debug, Clone, Default)]
pub struct Porosity {
    /// Open fractions: 1 open, 0 blocked.
    pub beta: FieldSet,
    /// Certified lower bounds, if asked for.
    pub lower: Option<FieldSet>,
    /// Certified upper bounds, if asked for.
    pub upper: Option<FieldSet>,
    /// Cells by kind.
    pub cells: CellCounts,
    /// Solid volume within the grid.
    pub solid_volume: f64,
    /// Largest distance of the bounds of any cell or face.
    pub max_gap: f64,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// By how much a body's own share of a cell left 0..1: surface that crosses itself.
    pub winding: f64,
    /// Bodies whose rows did not return to zero, worst first, one entry a body.
    pub leaks: Vec<Leak>,
}

/// Rows that miss zero by more than this fraction of a face leak.
const LEAK: f64 = 1e-9;

/// Porosities of `bodies` on `grid`.
#[must_use]
pub fn porosity(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Porosity {
    let bins = Bins::new(grid, bodies);
    let mut lower = FieldSet::new(grid, options.areas);
    let mut upper = options.bounds.then(|| FieldSet::new(grid, options.areas));
    let mut results = run_layers(grid, &bins, options, &mut lower, upper.as_mut());
    let summary = results.iter_mut().fold(Summary::default(), Summary::join);
    let leaks = worst_leaks(&bins, results);
    // The layers hold solid fractions; the open fraction is what remains.
    let (beta, lower, upper) = match upper {
        None => (lower, None, None),
        Some(upper) => {
            let beta = FieldSet {
                v: middle(&lower.v, &upper.v),
                x: middle(&lower.x, &upper.x),
                y: middle(&lower.y, &upper.y),
                z: middle(&lower.z, &upper.z),
            };
            (beta, Some(open(upper)), Some(open(lower)))
        }
    };
    Porosity {
        beta: open(beta),
        lower,
        upper,
        cells: summary.cells,
        solid_volume: summary.volume,
        max_gap: summary.max_gap,
        divided: summary.divided,
        winding: summary.winding,
        leaks,
    }
}

fn middle(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.par_iter().zip(b).map(|(a, b)| (a + b) * 0.5).collect()
}

/// Solid fractions to open fractions, in place.
fn open(mut solid: FieldSet) -> FieldSet {
    for field in [&mut solid.v, &mut solid.x, &mut solid.y, &mut solid.z] {
        field.par_chunks_mut(1 << 16).for_each(|c| c.iter_mut().for_each(|s| *s = 1.0 - *s));
    }
    solid
}

/// What one layer adds to the totals.
#[derive(Debug, Default)]
struct Summary {
    cells: CellCounts,
    volume: f64,
    max_gap: f64,
    divided: usize,
    winding: f64,
    /// Body and residual of rows that leak.
    leaks: Vec<(u32, f64)>,
    layer: usize,
}

impl Summary {
    /// Join totals in the order of layers (sums keep their bits for any number of threads).
    fn join(mut self, other: &mut Summary) -> Self {
        self.cells.open += other.cells.open;
        self.cells.cut += other.cells.cut;
        self.cells.closed += other.cells.closed;
        self.cells.ambiguous += other.cells.ambiguous;
        self.volume += other.volume;
        self.max_gap = self.max_gap.max(other.max_gap);
        self.divided += other.divided;
        self.winding = self.winding.max(other.winding);
        self
    }
}

fn worst_leaks(bins: &Bins, results: Vec<Summary>) -> Vec<Leak> {
    let mut worst: Vec<Option<Leak>> = vec![None; bins.body_count()];
    for summary in results {
        for (body, fraction) in summary.leaks {
            let slot = &mut worst[body as usize];
            if slot.is_none_or(|l| l.fraction < fraction) {
                *slot = Some(Leak { body: body as usize, fraction, layer: summary.layer });
            }
        }
    }
    let mut leaks: Vec<Leak> = worst.into_iter().flatten().collect();
    leaks.sort_by(|a, b| b.fraction.total_cmp(&a.fraction).then(a.body.cmp(&b.body)));
    leaks
}

/// One layer's share of the result.
struct Slices<'a> {
    v: &'a mut [f64],
    x: &'a mut [f64],
    y: &'a mut [f64],
    z: &'a mut [f64],
    /// The z faces above: only for the topmost layer.
    top: Option<&'a mut [f64]>,
}

/// Cut a field set into layers; empty fields give empty slices.
fn slices<'a>(grid: &Grid<f64>, fields: &'a mut FieldSet) -> Vec<Slices<'a>> {
    let [nx, ny, nz] = grid.cells();
    let FieldSet { v, x, y, z } = fields;
    let (mut v, mut x, mut y, mut z) = (&mut v[..], &mut x[..], &mut y[..], &mut z[..]);
    let layers = (0..nz).map(|k| Slices {
        v: split_off(&mut v, nx * ny),
        x: split_off(&mut x, (nx + 1) * ny),
        y: split_off(&mut y, nx * (ny + 1)),
        z: split_off(&mut z, nx * ny),
        top: (k + 1 == nz).then(|| split_off(&mut z, nx * ny)),
    });
    layers.collect()
}

/// The first `count` entries of a slice, which then begins after them.
fn split_off<'a>(slice: &mut &'a mut [f64], count: usize) -> &'a mut [f64] {
    let whole = std::mem::take(slice);
    let count = count.min(whole.len());
    let (first, rest) = whole.split_at_mut(count);
    *slice = rest;
    first
}

/// Run all layers, in parallel; `lower` and `upper` get solid fractions.
fn run_layers(
    grid: &Grid<f64>,
    bins: &Bins,
    options: Options,
    lower: &mut FieldSet,
    upper: Option<&mut FieldSet>,
) -> Vec<Summary> {
    let nz = grid.cells()[2];
    let lowers = slices(grid, lower);
    let uppers: Vec<Option<Slices>> = match upper {
        Some(upper) => slices(grid, upper).into_iter().map(Some).collect(),
        None => (0..nz).map(|_| None).collect(),
    };
    lowers
        .into_par_iter()
        .zip(uppers)
        .enumerate()
        .map_init(
            || Worker::new(grid, options),
            |worker, (k, (lower, upper))| worker.layer(grid, bins, k, lower, upper),
        )
        .collect()
}

/// A thread's memory.
struct Worker {
    options: Options,
    scratch: Vec<f64>,
    sum: Vec<f64>,
    marks: Vec<u8>,
    /// Stands in for face fields that nobody asked for.
    unasked: Vec<f64>,
    unions: Unions,
}

impl Worker {
    fn new(grid: &Grid<f64>, options: Options) -> Self {
        Worker {
            options,
            scratch: vec![0.0; Scratch::needed(grid)],
            sum: vec![0.0; Fields::<f64>::needed(grid)],
            marks: vec![0; Fields::<u8>::needed(grid)],
            unasked: vec![0.0; if options.areas { 0 } else { Fields::<f64>::needed(grid) }],
            unions: Unions::new(options),
        }
    }

    /// Compute layer `k`: bounds by body, unions where they differ.
    fn layer(&mut self, grid: &Grid<f64>, bins: &Bins, k: usize, lower: Slices, upper: Option<Slices>) -> Summary {
        let mut out = Summary { layer: k, ..Summary::default() };
        let Slices { v, x, y, z, top } = lower;
        let fits = "slices of a layer fit its grid";
        let lower = if self.options.areas {
            Fields::new(grid, v, x, y, z)
        } else {
            Fields::within(grid, &mut self.unasked).map(|f| Fields { cell: v, ..f })
        };
        let mut layer = Layer {
            lower: lower.expect(fits),
            sum: Fields::within(grid, &mut self.sum).expect(fits),
            marks: Fields::within(grid, &mut self.marks).expect(fits),
        };
        layer.clear();
        let mut scratch = Scratch::new(grid, &mut self.scratch).expect(fits);
        for (body, ids) in bins.layer(k) {
            let mut defects = add_body(grid, k, bins.triangles(), ids, &mut scratch, &mut layer);
            if self.options.areas {
                let leak = add_section(grid, k, Side::Above, bins.triangles(), ids, &mut scratch, &mut layer);
                defects.leak = defects.leak.max(leak);
            }
            out.winding = out.winding.max(defects.winding);
            if !(defects.leak <= LEAK) {
                out.leaks.push((body, defects.leak));
            }
        }
        (out.cells.ambiguous, out.divided) = self.unions.resolve(grid, bins, k, &mut layer);
        tally(grid, k, &layer, &mut out);
        settle(&mut layer, &mut out, upper.is_some());
        let (upper_top, upper) = match upper {
            Some(Slices { v, x, y, z, top }) => (top, Some([v, x, y, z])),
            None => (None, None),
        };
        if let Some(upper) = upper {
            let sums = [&*layer.sum.cell, &*layer.sum.x, &*layer.sum.y, &*layer.sum.z];
            upper.into_iter().zip(sums).filter(|(u, _)| !u.is_empty()).for_each(|(u, s)| u.copy_from_slice(s));
        }
        if let Some(top) = top.filter(|top| !top.is_empty()) {
            self.top(grid, bins, k, top, upper_top, &mut out);
        }
        out
    }

    /// The z faces above the topmost layer.
    fn top(
        &mut self,
        grid: &Grid<f64>,
        bins: &Bins,
        k: usize,
        lower: &mut [f64],
        upper: Option<&mut [f64]>,
        out: &mut Summary,
    ) {
        let fits = "slices of a layer fit its grid";
        let mut own = vec![0.0; Fields::<f64>::needed(grid)];
        let mut layer = Layer {
            lower: Fields::within(grid, &mut own).expect(fits),
            sum: Fields::within(grid, &mut self.sum).expect(fits),
            marks: Fields::within(grid, &mut self.marks).expect(fits),
        };
        layer.clear();
        let mut scratch = Scratch::new(grid, &mut self.scratch).expect(fits);
        for (_, ids) in bins.layer(k) {
            add_section(grid, k + 1, Side::Below, bins.triangles(), ids, &mut scratch, &mut layer);
        }
        self.unions.resolve_top(grid, bins, k, &mut layer);
        settle(&mut layer, out, upper.is_some());
        lower.copy_from_slice(layer.lower.z);
        if let Some(upper) = upper {
            upper.copy_from_slice(layer.sum.z);
        }
    }
}

/// Count the cells of a layer and add up their solid volume.
fn tally(grid: &Grid<f64>, k: usize, layer: &Layer<f64>, out: &mut Summary) {
    let [nx, ny, _] = grid.cells();
    let width = |axis: usize, i: usize| grid.edges(axis)[i + 1] - grid.edges(axis)[i];
    for j in 0..ny {
        let mut row = 0.0;
        for i in 0..nx {
            let c = j * nx + i;
            let (lower, upper) = (layer.lower.cell[c], layer.sum.cell[c].min(1.0));
            row += (lower + upper) * 0.5 * width(0, i);
            match (lower, layer.marks.cell[c]) {
                (1.0, _) => out.cells.closed += 1,
                (_, 0) if upper == 0.0 => out.cells.open += 1,
                _ => out.cells.cut += 1,
            }
        }
        out.volume += row * width(1, j) * width(2, k);
    }
}

/// Note the largest gap and leave in `lower` the value (or the lower bound, with `bounds`), in `sum` the upper bound.
fn settle(layer: &mut Layer<f64>, out: &mut Summary, bounds: bool) {
    let Layer { lower, sum, .. } = layer;
    let pairs = [
        (&mut *lower.cell, &mut *sum.cell),
        (&mut *lower.x, &mut *sum.x),
        (&mut *lower.y, &mut *sum.y),
        (&mut *lower.z, &mut *sum.z),
    ];
    for (lower, sum) in pairs {
        for (l, s) in lower.iter_mut().zip(sum) {
            if *s > 0.0 {
                let g = gap(*l, *s);
                out.max_gap = out.max_gap.max(g);
                *s = s.min(1.0);
                if !bounds {
                    *l += 0.5 * g;
                }
            }
        }
    }
}
