//! One layer of cells after the other, in one thread's memory.

use super::bins::Bins;
use super::convex::{Lists, Road};
use super::fields::Slices;
use super::unions::Unions;
use super::{CellCounts, Options};
use voidage_core::grid::Grid;
use voidage_core::grid::fields::{Fields, Layer};
use voidage_core::subdivide::QueryCount;
use voidage_core::surface::cells::{Scratch, add_body};
use voidage_core::surface::z_faces::{Side, add_section};

/// Rows that miss zero by more than this fraction of a face leak.
const LEAK: f64 = 1e-9;

/// The slices were cut for the grid they are used with.
const FITS: &str = "slices of a layer fit its grid";

/// What one layer adds to the totals.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// Cells by kind.
    pub cells: CellCounts,
    /// Solid volume.
    pub volume: f64,
    /// Largest distance of bounds.
    pub max_gap: f64,
    /// Cells divided.
    pub divided: usize,
    /// By how much a body's share left 0..1.
    pub winding: f64,
    /// Queries of GJK.
    pub tally: QueryCount,
    /// Body and residual of rows that leak.
    pub leaks: Vec<(u32, f64)>,
}

impl Summary {
    /// The same without the work, for a layer that is copied.
    #[must_use]
    pub fn copied(&self) -> Self {
        Summary { divided: 0, tally: QueryCount::default(), ..self.clone() }
    }

    /// Join totals in the order of layers, so that sums keep their bits for any number of threads.
    #[must_use]
    pub fn join(mut self, other: &Summary) -> Self {
        self.cells.open += other.cells.open;
        self.cells.cut += other.cells.cut;
        self.cells.closed += other.cells.closed;
        self.cells.ambiguous += other.cells.ambiguous;
        self.volume += other.volume;
        self.max_gap = self.max_gap.max(other.max_gap);
        self.divided += other.divided;
        self.winding = self.winding.max(other.winding);
        self.tally = self.tally + other.tally;
        self
    }
}

/// Where a layer's open fractions go.
#[derive(Debug)]
pub struct Target<'a> {
    /// The value: the middle of the bounds.
    pub beta: Slices<'a>,
    /// Lower and upper bounds, if wanted.
    pub bounds: Option<[Slices<'a>; 2]>,
}

/// A thread's memory.
pub struct Worker {
    options: Options,
    scratch: Vec<f64>,
    sum: Vec<f64>,
    marks: Vec<u8>,
    /// Lower bounds of fields that have no slice of their own.
    spare: Vec<f64>,
    lists: Lists,
    unions: Unions,
}

impl Worker {
    /// Numbers that a worker holds.
    pub fn needed(grid: &Grid<f64>) -> usize {
        Scratch::needed(grid) + 2 * Fields::<f64>::needed(grid)
    }

    /// For layers of grids with as many cells along x and y.
    #[must_use]
    pub fn new(grid: &Grid<f64>, options: Options) -> Self {
        Worker {
            options,
            scratch: vec![0.0; Scratch::needed(grid)],
            sum: vec![0.0; Fields::<f64>::needed(grid)],
            marks: vec![0; Fields::<u8>::needed(grid)],
            spare: vec![0.0; Fields::<f64>::needed(grid)],
            lists: Lists::default(),
            unions: Unions::new(options),
        }
    }

    /// Allow that many divisions of cells, counted by axis.
    pub fn may_halve(&mut self, halvings: u32) {
        self.unions.may_halve(halvings);
    }

    /// Compute layer `k`: bounds body by body, unions where they differ. `target` holds zeros before.
    pub fn layer(&mut self, grid: &Grid<f64>, bins: &Bins, convex: &Road, k: usize, target: Target) -> Summary {
        let mut out = Summary::default();
        let Target { beta: Slices { v, x, y, z, top }, mut bounds } = target;
        let mut layer = Layer {
            lower: Fields::within(grid, &mut self.spare).expect(FITS),
            sum: Fields::within(grid, &mut self.sum).expect(FITS),
            marks: Fields::within(grid, &mut self.marks).expect(FITS),
        };
        layer.marks.fill(0);
        if self.options.areas {
            layer.lower = Fields::new(grid, v, x, y, z).expect(FITS);
        } else {
            for faces in [&mut layer.lower, &mut layer.sum] {
                [&mut faces.x, &mut faces.y, &mut faces.z].into_iter().for_each(|f| f.fill(0.0));
            }
            layer.lower.cell = v;
        }
        let mut scratch = Scratch::new(grid, &mut self.scratch).expect(FITS);
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
        out.tally = convex.add(grid, k, &mut self.lists, &mut layer);
        if bins.groups(k).len() > usize::from(convex.is_empty()) {
            (out.cells.ambiguous, out.divided) = self.unions.resolve(grid, bins, convex, k, &mut layer);
        }
        let end = self.options.solid_end();
        tally(grid, k, &layer, end, &mut out);
        let Layer { lower, sum, .. } = &mut layer;
        let [mut low, mut high] = split_bounds(&mut bounds);
        settle(lower.cell, sum.cell, low.as_mut().map(|s| &mut *s.v), high.as_mut().map(|s| &mut *s.v), end, &mut out);
        if self.options.areas {
            settle(lower.x, sum.x, low.as_mut().map(|s| &mut *s.x), high.as_mut().map(|s| &mut *s.x), end, &mut out);
            settle(lower.y, sum.y, low.as_mut().map(|s| &mut *s.y), high.as_mut().map(|s| &mut *s.y), end, &mut out);
            settle(lower.z, sum.z, low.as_mut().map(|s| &mut *s.z), high.as_mut().map(|s| &mut *s.z), end, &mut out);
        }
        if !top.is_empty() {
            let low = low.as_mut().map(|s| &mut *s.top);
            let high = high.as_mut().map(|s| &mut *s.top);
            self.top(grid, bins, convex, k, top, low, high, &mut out);
        }
        out
    }

    /// The z faces above the topmost layer.
    fn top(
        &mut self,
        grid: &Grid<f64>,
        bins: &Bins,
        convex: &Road,
        k: usize,
        beta: &mut [f64],
        low: Option<&mut [f64]>,
        high: Option<&mut [f64]>,
        out: &mut Summary,
    ) {
        let mut layer = Layer {
            lower: Fields::within(grid, &mut self.spare).expect(FITS),
            sum: Fields::within(grid, &mut self.sum).expect(FITS),
            marks: Fields::within(grid, &mut self.marks).expect(FITS),
        };
        layer.lower.z.fill(0.0);
        layer.marks.z.fill(0);
        let mut scratch = Scratch::new(grid, &mut self.scratch).expect(FITS);
        for (_, ids) in bins.layer(k) {
            add_section(grid, k + 1, Side::Below, bins.triangles(), ids, &mut scratch, &mut layer);
        }
        out.tally = out.tally + convex.add_top(grid, k + 1, &mut self.lists, &mut layer);
        self.unions.resolve_top(grid, bins, convex, k, &mut layer);
        settle(layer.lower.z, layer.sum.z, low, high, self.options.solid_end(), out);
        beta.copy_from_slice(layer.lower.z);
    }
}

/// The lower and the upper slices, each if there are any.
fn split_bounds<'b, 'a>(bounds: &'b mut Option<[Slices<'a>; 2]>) -> [Option<&'b mut Slices<'a>>; 2] {
    match bounds {
        Some([low, high]) => [Some(low), Some(high)],
        None => [None, None],
    }
}

/// Count the cells of a layer and add up their solid volume.
fn tally(grid: &Grid<f64>, k: usize, layer: &Layer<f64>, end: f64, out: &mut Summary) {
    let [nx, ny, _] = grid.cells();
    let width = |axis: usize, i: usize| grid.edges(axis)[i + 1] - grid.edges(axis)[i];
    for j in 0..ny {
        let row = j * nx..(j + 1) * nx;
        let (lower, sum, marks) =
            (&layer.lower.cell[row.clone()], &layer.sum.cell[row.clone()], &layer.marks.cell[row]);
        if marks.iter().all(|&m| m == 0) && sum.iter().all(|&s| s == 0.0) {
            out.cells.open += nx;
            continue;
        }
        let mut volume = 0.0;
        for i in 0..nx {
            let upper = sum[i].min(1.0);
            volume += (lower[i] * (1.0 - end) + upper * end) * width(0, i);
            if lower[i] == 1.0 {
                out.cells.closed += 1;
            } else if upper == 0.0 && marks[i] == 0 {
                out.cells.open += 1;
            } else {
                out.cells.cut += 1;
            }
        }
        out.volume += volume * width(1, j) * width(2, k);
    }
}

/// Turn solid bounds into open fractions: the value, a share `end` of the way between them, goes to `lower`, the bounds to `low` and
/// `high` if wanted. Leaves zeros in `sum` for the next layer.
fn settle(
    lower: &mut [f64],
    sum: &mut [f64],
    low: Option<&mut [f64]>,
    high: Option<&mut [f64]>,
    end: f64,
    out: &mut Summary,
) {
    if let Some(low) = low {
        low.iter_mut().zip(&*sum).for_each(|(low, sum)| *low = 1.0 - sum.min(1.0));
    }
    if let Some(high) = high {
        high.iter_mut().zip(&*lower).for_each(|(high, lower)| *high = 1.0 - lower);
    }
    let settle = |l: &mut f64, s: &mut f64, widest: &mut f64| {
        let upper = if *s < 1.0 { *s } else { 1.0 };
        let gap = upper - *l;
        *widest = if gap > *widest { gap } else { *widest };
        (*l, *s) = (1.0 - (*l * (1.0 - end) + upper * end), 0.0);
    };
    // Eight running maxima need no order, so the loop is done by vectors.
    let mut widest = [0.0_f64; 8];
    let ((lower, lower_rest), (sum, sum_rest)) = (lower.as_chunks_mut::<8>(), sum.as_chunks_mut::<8>());
    for (l, s) in lower.iter_mut().zip(sum) {
        for n in 0..8 {
            settle(&mut l[n], &mut s[n], &mut widest[n]);
        }
    }
    for (l, s) in lower_rest.iter_mut().zip(sum_rest) {
        settle(l, s, &mut widest[0]);
    }
    out.max_gap = widest.into_iter().fold(out.max_gap, f64::max);
}
