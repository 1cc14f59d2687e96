//! Cells and faces that several bodies share: exact unions, or division until there is one.

use super::bins::{Bins, Group};
use super::convex::{Lists, Road};
use super::fields::FieldSet;
use super::layers::Worker;
use super::{Options, targets};
use glam::DVec3;
use std::ops::Range;
use voidage_core::grid::Grid;
use voidage_core::grid::fields::{Layer, gap};
use voidage_core::number::aabb::Aabb;
use voidage_core::surface::union::{CellUnion, Fragment, Limit, NoProof, Node, Overlap, Part, Piece, Task, Workspace};

/// Pieces of surface that one cell may hold before it is divided: beyond, trees cost more than smaller cells.
const MAX_PIECES: usize = 1024;

/// A thread's memory for unions, made when first needed.
pub struct Unions {
    options: Options,
    /// How often cells may still be halved along some axis.
    halvings: u32,
    memory: Option<Memory>,
    lists: Lists,
    /// For the parts of a divided cell.
    inner: Option<Box<Worker>>,
}

struct Memory {
    pieces: Vec<Piece<f64>>,
    shards: Vec<Piece<f64>>,
    order: Vec<u32>,
    nodes: Vec<Node<f64>>,
    parts: Vec<Part>,
    fragments: Vec<Fragment<f64>>,
    tasks: Vec<Task>,
}

impl Memory {
    fn new() -> Self {
        Memory {
            pieces: vec![Piece::default(); MAX_PIECES],
            shards: vec![Piece::default(); 4 * MAX_PIECES],
            order: vec![0; 4 * MAX_PIECES],
            nodes: vec![Node::default(); 4 * MAX_PIECES],
            parts: vec![Part::default(); MAX_PIECES / 4],
            fragments: vec![Fragment::default(); MAX_PIECES],
            tasks: vec![Task::default(); MAX_PIECES],
        }
    }

    fn workspace(&mut self) -> Workspace<'_, f64> {
        Workspace {
            pieces: &mut self.pieces,
            shards: &mut self.shards,
            order: &mut self.order,
            nodes: &mut self.nodes,
            parts: &mut self.parts,
            fragments: &mut self.fragments,
            tasks: &mut self.tasks,
        }
    }
}

/// Bounds of a solid fraction.
type Bounds = (f64, f64);

/// What is known of a cell after refinement.
struct Refined {
    cell: Bounds,
    low: [Bounds; 3],
    high: [Bounds; 3],
}

impl From<CellUnion<f64>> for Refined {
    fn from(u: CellUnion<f64>) -> Self {
        let known = |v: f64| ((v - u.error).max(0.0), (v + u.error).min(1.0));
        Refined { cell: known(u.cell), low: u.low.map(known), high: u.high.map(known) }
    }
}

/// The triangles that reach one row of a layer, by body.
#[derive(Default)]
struct Row {
    ids: Vec<u32>,
    groups: Vec<(usize, Range<usize>)>,
}

impl Row {
    fn new(bins: &Bins, k: usize, lo: f64, hi: f64) -> Self {
        let mut row = Row::default();
        for (g, group) in bins.groups(k).iter().enumerate() {
            if group.sheet || group.max.y <= lo || group.min.y >= hi {
                continue;
            }
            let first = row.ids.len();
            row.ids.extend(bins.ids(group).iter().filter(|&&t| {
                let [a, b, c] = bins.triangles()[t as usize].map(|p| p.y);
                a.max(b).max(c) > lo && a.min(b).min(c) < hi
            }));
            row.groups.push((g, first..row.ids.len()));
        }
        row
    }
}

/// Planes of different bodies may miss each other by so much, in cells, and be taken for one where that gives a proof:
/// parts that were meant to touch, in coordinates that were rounded.
const BLURS: [f64; 5] = [0.0, 1e-12, 1e-10, 1e-8, 1e-6];

/// What an attempt finds with the least blur that gives a proof and an error within the tolerance. An attempt returns its error as well.
fn with_least_blur<T>(tol: f64, mut attempt: impl FnMut(f64) -> Result<(T, f64), NoProof>) -> Option<T> {
    for blur in BLURS.into_iter().filter(|&blur| blur == 0.0 || blur < tol) {
        match attempt(blur) {
            Ok((found, error)) if blur == 0.0 || 2.0 * error <= tol => return Some(found),
            Err(NoProof::Full) => return None,
            Ok(_) | Err(NoProof::Doubt) => {}
        }
    }
    None
}

/// By how much a union may leave the bounds given by the bodies' own shares and still be rounding.
const ROUNDING: f64 = 1e-9;

/// Narrow the bounds of a cell or face. Both pairs hold, so does their intersection, unless rounding has crossed it; a pair that
/// contradicts the bodies' own shares is not believed.
fn improve(lower: &mut f64, sum: &mut f64, (low, high): Bounds) {
    let (l, u) = (lower.max(low), sum.min(1.0).min(high));
    if l <= u {
        (*lower, *sum) = (l, u);
    } else if l - u <= ROUNDING {
        (*lower, *sum) = (u, l);
    }
}

/// Does a union lie within the bounds given by the bodies' own shares?
fn fits(lower: f64, sum: f64, (low, high): Bounds) -> bool {
    high >= lower - ROUNDING && low <= sum.min(1.0) + ROUNDING
}

impl Unions {
    pub fn new(options: Options) -> Self {
        Unions { options, halvings: 3 * options.depth, memory: None, lists: Lists::default(), inner: None }
    }

    /// Allow that many divisions of cells, counted by axis.
    pub fn may_halve(&mut self, halvings: u32) {
        self.halvings = halvings;
    }

    /// Refine layer `k`: its cells, x and y faces, and the z faces below. Returns the numbers of ambiguous cells and of
    /// divided ones.
    pub fn resolve(
        &mut self,
        grid: &Grid<f64>,
        bins: &Bins,
        convex: &Road,
        k: usize,
        layer: &mut Layer<f64>,
    ) -> (usize, usize) {
        let [nx, ny, _] = grid.cells();
        let areas = self.options.areas;
        let (mut ambiguous, mut divided) = (0, 0);
        let surfaces = bins.groups(k).iter().map(|g| (Aabb { min: g.min, max: g.max }, true));
        let (below, above) = (grid.edges(2)[k], grid.edges(2)[k + 1]);
        let others = convex.boxes().filter(|b| b.min.z <= above && b.max.z >= below).map(|b| (b, false));
        let boxes: Vec<(Aabb<DVec3>, bool)> = surfaces.chain(others).collect();
        for j in shared(grid.edges(1), boxes.iter().map(|(b, surface)| ([b.min.y, b.max.y], *surface))) {
            let [lo, hi] = [grid.edges(1)[j], grid.edges(1)[j + 1]];
            let here = boxes.iter().filter(|(b, _)| b.min.y <= hi && b.max.y >= lo);
            let mut row = None;
            for i in shared(grid.edges(0), here.map(|(b, surface)| ([b.min.x, b.max.x], *surface))) {
                let c = j * nx + i;
                ambiguous += usize::from(gap(layer.lower.cell[c], layer.sum.cell[c]) > 0.0);
                let open = open_gap(layer, nx, ny, i, j);
                if !(open > KNOWN) {
                    continue;
                }
                let row = row.get_or_insert_with(|| Row::new(bins, k, lo, hi));
                let (lo, hi) = grid.cell_box([i, j, k]);
                let refined = match self.union(lo, hi, bins, convex, k, row, |u| agrees(layer, nx, i, j, u, areas)) {
                    None if open > self.options.tol => {
                        divided += 1;
                        self.divide(lo, hi, bins, convex, k)
                    }
                    known => known,
                };
                if let Some(refined) = refined {
                    store(layer, nx, ny, i, j, &refined);
                }
            }
        }
        self.walls(grid, bins, convex, k, layer);
        (ambiguous, divided)
    }

    /// Refine the z faces above layer `k`, held in `layer.…z`.
    pub fn resolve_top(&mut self, grid: &Grid<f64>, bins: &Bins, convex: &Road, k: usize, layer: &mut Layer<f64>) {
        let [nx, ny, _] = grid.cells();
        for j in 0..ny {
            let mut row = None;
            for i in 0..nx {
                let c = j * nx + i;
                let open = gap(layer.lower.z[c], layer.sum.z[c]);
                if !(open > KNOWN) {
                    continue;
                }
                let bounds = if layer.marks.z[c] != 0 {
                    Some(self.wall(grid, bins, convex, 2, [i, j, k + 1]))
                } else {
                    let row = row.get_or_insert_with(|| Row::new(bins, k, grid.edges(1)[j], grid.edges(1)[j + 1]));
                    let (lo, hi) = grid.cell_box([i, j, k]);
                    match self.union(lo, hi, bins, convex, k, row, |_| true) {
                        None if open > self.options.tol => self.divide(lo, hi, bins, convex, k),
                        known => known,
                    }
                    .map(|refined| refined.high[2])
                };
                if let Some(bounds) = bounds {
                    improve(&mut layer.lower.z[c], &mut layer.sum.z[c], bounds);
                }
            }
        }
    }

    /// The union in a cell of layer `k`: exact, or with the least blur that gives a proof; of triangles only.
    fn union(
        &mut self,
        lo: [f64; 3],
        hi: [f64; 3],
        bins: &Bins,
        convex: &Road,
        k: usize,
        row: &Row,
        believed: impl Fn(&Refined) -> bool,
    ) -> Option<Refined> {
        if convex.reaches(lo, hi, &mut self.lists) {
            return None;
        }
        with_least_blur(self.options.tol, |blur| {
            let union = self.blurred_union(lo, hi, bins, k, row, blur)?;
            let refined = Refined::from(union);
            if believed(&refined) { Ok((refined, union.error)) } else { Err(NoProof::Doubt) }
        })
    }

    fn blurred_union(
        &mut self,
        lo: [f64; 3],
        hi: [f64; 3],
        bins: &Bins,
        k: usize,
        row: &Row,
        blur: f64,
    ) -> Result<CellUnion<f64>, NoProof> {
        let space = self.memory.get_or_insert_with(Memory::new).workspace();
        let mut overlap = Overlap::new(space, lo, hi, blur);
        for (g, run) in &row.groups {
            let group = &bins.groups(k)[*g];
            if group.max.x > lo[0] && group.min.x < hi[0] {
                overlap.add(lo, hi, false, bins.triangles(), &row.ids[run.clone()])?;
            }
        }
        overlap.cell()
    }

    /// Bounds of a cell of layer `k` from its parts, halves along the axes in which it is longest; none if the depth is spent.
    fn divide(&mut self, lo: [f64; 3], hi: [f64; 3], bins: &Bins, convex: &Road, k: usize) -> Option<Refined> {
        let longest = [0, 1, 2].iter().fold(0.0, |l: f64, &a| l.max(hi[a] - lo[a]));
        let halved = [0, 1, 2].map(|a| hi[a] - lo[a] > longest * 0.5);
        let edges = [0, 1, 2].map(|a| {
            let middle = halved[a].then(|| lo[a] + (hi[a] - lo[a]) * 0.5);
            [Some(lo[a]), middle, Some(hi[a])].into_iter().flatten().collect::<Vec<f64>>()
        });
        let grid = Grid::new(&edges[0], &edges[1], &edges[2]).ok()?;
        let halvings = halved.iter().map(|&h| u32::from(h)).sum();
        let bounds = self.parts(&grid, bins, convex, k..k + 1, halvings)?;
        Some(Refined::from_parts(&grid, &bounds))
    }

    /// Bounds of the open fractions of a small grid within some layers, with less depth by `halvings`; none if that is spent.
    fn parts(
        &mut self,
        grid: &Grid<f64>,
        bins: &Bins,
        convex: &Road,
        layers: Range<usize>,
        halvings: u32,
    ) -> Option<[FieldSet; 2]> {
        let halvings = self.halvings.checked_sub(halvings)?;
        let [x, y, z] = [0, 1, 2].map(|a| grid.edges(a));
        let ends = |pick: fn(&&[f64]) -> Option<f64>| Some(DVec3::new(pick(&x)?, pick(&y)?, pick(&z)?));
        let (min, max) = (ends(|e| e.first().copied())?, ends(|e| e.last().copied())?);
        let meets = |g: &&Group| !g.sheet && g.min.cmple(max).all() && g.max.cmpge(min).all();
        // Rows and columns begin outside: what lies towards lower x or y counts too.
        let before = |t: &&u32| {
            let corners = bins.triangles()[**t as usize];
            corners.iter().any(|p| p.x <= max.x) && corners.iter().any(|p| p.y <= max.y)
        };
        let of_layer = |k| {
            bins.groups(k).iter().filter(meets).flat_map(|g| bins.ids(g).iter().filter(before).map(|&t| (g.body, t)))
        };
        let mut members: Vec<(u32, u32)> = layers.clone().flat_map(of_layer).collect();
        if layers.len() > 1 {
            members.sort_unstable();
            members.dedup();
        }
        let inner = Bins::of(grid, bins.triangles(), members.into_iter());
        let options = Options { bounds: true, areas: true, ..self.options };
        let halves = [0.0, 0.5, 1.0];
        let largest = Grid::new(&halves, &halves, &halves).ok()?;
        let worker = self.inner.get_or_insert_with(|| Box::new(Worker::new(&largest, options)));
        worker.may_halve(halvings);
        let mut beta = FieldSet::new(grid, true);
        let mut bounds = [FieldSet::new(grid, true), FieldSet::new(grid, true)];
        for (k, target) in targets(grid, &mut beta, Some(&mut bounds)).into_iter().enumerate() {
            worker.layer(grid, &inner, convex, k, target);
        }
        Some(bounds)
    }

    /// Faces of layer `k` in whose plane surface lies: open where both sides are.
    fn walls(&mut self, grid: &Grid<f64>, bins: &Bins, convex: &Road, k: usize, layer: &mut Layer<f64>) {
        let [nx, ny, _] = grid.cells();
        for (axis, shape) in [(0, [nx + 1, ny]), (1, [nx, ny + 1]), (2, [nx, ny])] {
            let Layer { lower, sum, marks } = layer;
            let (lower, sum, marks) = match axis {
                0 => (&mut *lower.x, &mut *sum.x, &*marks.x),
                1 => (&mut *lower.y, &mut *sum.y, &*marks.y),
                _ => (&mut *lower.z, &mut *sum.z, &*marks.z),
            };
            if !marks.contains(&1) {
                continue;
            }
            for f in 0..shape[0] * shape[1] {
                if marks[f] != 0 && gap(lower[f], sum[f]) > KNOWN {
                    let bounds = self.wall(grid, bins, convex, axis, [f % shape[0], f / shape[0], k]);
                    improve(&mut lower[f], &mut sum[f], bounds);
                }
            }
        }
    }

    /// Bounds of the union on a face from what both its cells see.
    fn wall(&mut self, grid: &Grid<f64>, bins: &Bins, convex: &Road, axis: usize, face: [usize; 3]) -> Bounds {
        let layers = grid.cells()[2] as isize;
        let sides = [true, false].map(|below| {
            let (lo, hi) = side_cell(grid, axis, face, below);
            // Beyond the outer planes the nearest layer knows all that touches them.
            let k = face[2] as isize - isize::from(axis == 2 && below);
            WallSide { lo, hi, k: k.clamp(0, layers - 1) as usize, below }
        });
        // What a sheet blocks beyond the solids is not known here.
        if sides.iter().any(|side| bins.groups(side.k).iter().any(|g| g.sheet && side.touches(g))) {
            return (0.0, 1.0);
        }
        let other = sides.iter().any(|side| convex.reaches(side.lo, side.hi, &mut self.lists));
        let whole = if other { None } else { self.whole_wall(bins, axis, &sides) };
        whole.or_else(|| self.divided_wall(bins, convex, axis, &sides)).unwrap_or((0.0, 1.0))
    }

    /// The union on a face with walls: exact, or with the least blur that gives a proof.
    fn whole_wall(&mut self, bins: &Bins, axis: usize, sides: &[WallSide; 2]) -> Option<Bounds> {
        with_least_blur(self.options.tol, |blur| {
            let (closed, error) = self.wall_union(bins, axis, sides, blur)?;
            Ok((((closed - error).max(0.0), (closed + error).min(1.0)), error))
        })
    }

    /// Bounds of a face with walls from its quarters, each between halves of the cells on both sides; none if the depth is spent.
    fn divided_wall(
        &mut self,
        bins: &Bins,
        convex: &Road,
        axis: usize,
        [below, above]: &[WallSide; 2],
    ) -> Option<Bounds> {
        let middle = |side: &WallSide, a: usize| side.lo[a] + (side.hi[a] - side.lo[a]) * 0.5;
        let edges = [0, 1, 2].map(|a| match a == axis {
            true => [middle(below, a), above.lo[a], middle(above, a)],
            false => [above.lo[a], middle(above, a), above.hi[a]],
        });
        let grid = Grid::new(&edges[0], &edges[1], &edges[2]).ok()?;
        let [lower, upper] = self.parts(&grid, bins, convex, below.k..above.k + 1, 3)?;
        let sum = |set: &FieldSet| -> f64 { faces_of(&grid, axis, 1).map(|f| set.faces(axis)[f]).sum() };
        Some((1.0 - sum(&upper) * 0.25, 1.0 - sum(&lower) * 0.25))
    }

    /// The closed fraction of a face with walls and its error. Each side alone must have a proof, and what both close together lies
    /// between the larger of their shares and the sum.
    fn wall_union(
        &mut self,
        bins: &Bins,
        axis: usize,
        sides: &[WallSide; 2],
        blur: f64,
    ) -> Result<(f64, f64), NoProof> {
        let (mut least, mut most, mut error) = (0.0_f64, 0.0, 0.0_f64);
        for side in sides {
            let union = self.gather(bins, &[*side], blur)?.cell()?;
            let closed = if side.below { union.high[axis] } else { union.low[axis] };
            (least, most, error) = (least.max(closed), most + closed, error.max(union.error));
        }
        let closed = self.gather(bins, sides, blur)?.face(axis, 1.0, Limit::Both)?;
        let slack = error + ROUNDING;
        if closed >= least - slack && closed <= most + slack { Ok((closed, error)) } else { Err(NoProof::Doubt) }
    }

    /// All surface of some boxes beside a face, in the frame of the first.
    fn gather(&mut self, bins: &Bins, sides: &[WallSide], blur: f64) -> Result<Overlap<'_, f64>, NoProof> {
        let space = self.memory.get_or_insert_with(Memory::new).workspace();
        let mut overlap = Overlap::new(space, sides[0].lo, sides[0].hi, blur);
        for side in sides {
            let &WallSide { lo, hi, k, below } = side;
            for group in bins.groups(k).iter().filter(|g| side.touches(g)) {
                overlap.add(lo, hi, below, bins.triangles(), bins.ids(group))?;
            }
        }
        Ok(overlap)
    }
}

/// What one side of a face sees: a box in a layer.
#[derive(Clone, Copy)]
struct WallSide {
    lo: [f64; 3],
    hi: [f64; 3],
    k: usize,
    below: bool,
}

impl WallSide {
    fn touches(&self, group: &Group) -> bool {
        group.min.cmple(DVec3::from_array(self.hi)).all() && group.max.cmpge(DVec3::from_array(self.lo)).all()
    }
}

/// The cell below or above a face; beyond the grid's outer planes, a thin one.
fn side_cell(grid: &Grid<f64>, axis: usize, face: [usize; 3], below: bool) -> ([f64; 3], [f64; 3]) {
    let count = grid.cells()[axis];
    let mut cell = face;
    let at = grid.edges(axis)[face[axis]];
    if below && face[axis] == 0 {
        let (mut lo, mut hi) = grid.cell_box(cell);
        (lo[axis], hi[axis]) = (at - (hi[axis] - at) * OUTSIDE, at);
        return (lo, hi);
    }
    if !below && face[axis] == count {
        cell[axis] -= 1;
        let (mut lo, mut hi) = grid.cell_box(cell);
        (lo[axis], hi[axis]) = (at, at + (at - lo[axis]) * OUTSIDE);
        return (lo, hi);
    }
    cell[axis] -= usize::from(below);
    grid.cell_box(cell)
}

/// How far beyond its outer planes a grid looks for bodies that touch them, in cells.
const OUTSIDE: f64 = 1.0 / 1024.0;

/// Bounds this close are one value: what remains is rounding.
const KNOWN: f64 = 1e-13;

/// The cells along one axis that two bodies or more reach or touch, one of them by its surface: among themselves, bodies that are
/// subdivided have been joined already.
fn shared(edges: &[f64], extents: impl Iterator<Item = ([f64; 2], bool)>) -> Vec<usize> {
    let cells = edges.len() - 1;
    // What the numbers of bodies and of surfaces change by at each cell.
    let mut steps = vec![[0_i32; 2]; cells + 1];
    for ([lo, hi], surface) in extents {
        let first = edges.partition_point(|&e| e < lo).saturating_sub(1);
        let end = edges.partition_point(|&e| e <= hi).min(cells);
        if first < end {
            let step = [1, i32::from(surface)];
            (0..2).for_each(|n| steps[first][n] += step[n]);
            (0..2).for_each(|n| steps[end][n] -= step[n]);
        }
    }
    let (mut bodies, mut surfaces) = (0, 0);
    let shared = steps[..cells].iter().enumerate().filter(|(_, step)| {
        bodies += step[0];
        surfaces += step[1];
        bodies > 1 && surfaces > 0
    });
    shared.map(|(cell, _)| cell).collect()
}

/// The largest gap of a cell and of the faces that it decides.
fn open_gap(layer: &Layer<f64>, nx: usize, ny: usize, i: usize, j: usize) -> f64 {
    let of = |lower: &[f64], sum: &[f64], marks: &[u8], at: usize| {
        if marks[at] == 0 { gap(lower[at], sum[at]) } else { 0.0 }
    };
    let x = |at| of(layer.lower.x, layer.sum.x, layer.marks.x, at);
    let y = |at| of(layer.lower.y, layer.sum.y, layer.marks.y, at);
    let c = j * nx + i;
    let mut open = gap(layer.lower.cell[c], layer.sum.cell[c]).max(x(j * (nx + 1) + i)).max(y(c));
    open = open.max(of(layer.lower.z, layer.sum.z, layer.marks.z, c));
    if i + 1 == nx {
        open = open.max(x(j * (nx + 1) + nx));
    }
    if j + 1 == ny {
        open = open.max(y(c + nx));
    }
    open
}

/// Does a union agree with the bodies' own shares of the cell and of those low faces that lie in no wall?
/// Without `areas` nothing is known of z faces.
fn agrees(layer: &Layer<f64>, nx: usize, i: usize, j: usize, u: &Refined, areas: bool) -> bool {
    let Layer { lower, sum, marks } = layer;
    let (c, x) = (j * nx + i, j * (nx + 1) + i);
    fits(lower.cell[c], sum.cell[c], u.cell)
        && (marks.x[x] != 0 || fits(lower.x[x], sum.x[x], u.low[0]))
        && (marks.y[c] != 0 || fits(lower.y[c], sum.y[c], u.low[1]))
        && (!areas || marks.z[c] != 0 || fits(lower.z[c], sum.z[c], u.low[2]))
}

/// Store what is known of a cell and of those of its faces that it decides.
fn store(layer: &mut Layer<f64>, nx: usize, ny: usize, i: usize, j: usize, refined: &Refined) {
    let Layer { lower, sum, marks } = layer;
    let c = j * nx + i;
    improve(&mut lower.cell[c], &mut sum.cell[c], refined.cell);
    let face = |lower: &mut [f64], sum: &mut [f64], marks: &[u8], at: usize, bounds: Bounds| {
        if marks[at] == 0 && gap(lower[at], sum[at]) > 0.0 {
            improve(&mut lower[at], &mut sum[at], bounds);
        }
    };
    let x = j * (nx + 1) + i;
    face(lower.x, sum.x, marks.x, x, refined.low[0]);
    face(lower.y, sum.y, marks.y, c, refined.low[1]);
    face(lower.z, sum.z, marks.z, c, refined.low[2]);
    if i + 1 == nx {
        face(lower.x, sum.x, marks.x, x + 1, refined.high[0]);
    }
    if j + 1 == ny {
        face(lower.y, sum.y, marks.y, c + nx, refined.high[1]);
    }
}

impl Refined {
    /// From the bounds of the open fractions of a cell's parts, equal in size.
    fn from_parts(grid: &Grid<f64>, [lower, upper]: &[FieldSet; 2]) -> Self {
        let mean = |set: &[f64], at: &[usize]| at.iter().map(|&n| set[n]).sum::<f64>() / at.len() as f64;
        let side = |axis: usize, plane: usize| {
            let faces: Vec<usize> = faces_of(grid, axis, plane).collect();
            (1.0 - mean(upper.faces(axis), &faces), 1.0 - mean(lower.faces(axis), &faces))
        };
        let cells: Vec<usize> = (0..grid.cell_count()).collect();
        Refined {
            cell: (1.0 - mean(&upper.v, &cells), 1.0 - mean(&lower.v, &cells)),
            low: [0, 1, 2].map(|axis| side(axis, 0)),
            high: [0, 1, 2].map(|axis| side(axis, grid.cells()[axis])),
        }
    }
}

/// Positions of all faces in one plane of a grid.
fn faces_of(grid: &Grid<f64>, axis: usize, plane: usize) -> impl Iterator<Item = usize> {
    let mut count = grid.cells();
    count[axis] = 1;
    (0..count[0] * count[1] * count[2]).map(move |n| {
        let mut face = [n % count[0], n / count[0] % count[1], n / count[0] / count[1]];
        face[axis] = plane;
        grid.face_index(axis, face)
    })
}
