//! Solids by formula in a layer: closed forms, and bounds of the union where two of them truly meet in a cell.
//!
//! Shares of solids that do not meet add up, and that is exact. Which pairs meet is asked of GJK once for each pair of solids whose boxes
//! overlap (`pairs`). Only in a cell or face that two such solids share is what they have in common taken off, by sections or by planes between which they lie
//! (`union`). A solid that closes the cell leaves nothing to find out, and what of one another holds was cut off before (`nested`).

mod capsule;
mod kept;
mod nested;
mod pairs;
mod planar;
mod round;
mod solid;
mod touching;
mod union;

pub use nested::without_nested;
pub use pairs::find_partners;
pub use planar::union_with;
pub use solid::FormulaSolid;

use kept::KeptFaces;
use solid::{BELIEVED, Kind, Pair};
use touching::TOLD;
use union::{box_of, concentric, ends_at, union_of};
use voidage_core::grid::Grid;
use voidage_core::grid::bounds::Bounds;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::grid::fields::Layer;
use voidage_core::solids::enclosure::BoxAround;
use voidage_core::solids::torus::TorusSolid;

/// Sums this near to 1 are 1, as in the core's sums over surfaces.
const FULL: f64 = 1.0 - 256.0 * f64::EPSILON;

/// A share of a place that others may have a share of too: kind of the place, its position, the solid among those at hand, the share
/// and what it may be off by.
type Entry = (u8, u32, u32, [f64; 2]);

/// A solid among those at hand, its share of a place and what that may be off by.
type Share = (usize, [f64; 2]);

/// A thread's memory.
#[derive(Debug, Default)]
pub struct FormulaMemory {
    /// Sums of the shares of cells and x, y, z faces that only solids have which meet no other there.
    sums: [Sums; 4],
    entries: Vec<Entry>,
    kept: KeptFaces,
    /// Layers are those of one grid, the faces between which may be kept.
    pub keeps: bool,
    /// Cells so far in which solids meet.
    pub shared: usize,
}

/// Sums for the places of one kind, block by block: zeros, but in blocks that are marked.
#[derive(Debug, Default)]
struct Sums {
    values: Vec<[f64; BLOCK]>,
    /// How many entries each place has, up to two.
    entries: Vec<[u8; BLOCK]>,
    marked: Vec<bool>,
}

/// Places of a block.
const BLOCK: usize = 8;

impl Sums {
    fn make_room(&mut self, places: usize) {
        let blocks = places.div_ceil(BLOCK);
        if self.values.len() < blocks {
            self.values.resize(blocks, [0.0; BLOCK]);
            self.entries.resize(blocks, [0; BLOCK]);
            self.marked.resize(blocks, false);
        }
    }

    fn value(&self, at: usize) -> f64 {
        self.values[at / BLOCK][at % BLOCK]
    }

    fn add(&mut self, at: usize, share: f64) {
        self.values[at / BLOCK][at % BLOCK] += share;
        self.marked[at / BLOCK] = true;
    }

    /// Counts an entry of a place.
    fn count(&mut self, at: usize) {
        let entries = &mut self.entries[at / BLOCK][at % BLOCK];
        *entries = (*entries + 1).min(2);
        self.marked[at / BLOCK] = true;
    }

    /// Is an entry of a place the only one?
    fn is_single(&self, at: usize) -> bool {
        self.entries[at / BLOCK][at % BLOCK] == 1
    }

    /// Adds them, as the shares of bodies, to lower bounds and sums. A call of its own: its loop is done by vectors because the slices are apart.
    #[inline(never)]
    fn add_to(&self, lower: &mut [f64], sum: &mut [f64]) {
        let ((lower, lower_rest), (sum, sum_rest)) = (lower.as_chunks_mut::<BLOCK>(), sum.as_chunks_mut::<BLOCK>());
        let add = |share: f64, lower: &mut f64, sum: &mut f64| {
            // Zeros change nothing.
            let share = if share > FULL { 1.0 } else { share };
            *lower = if share > *lower { share } else { *lower };
            *sum += share;
        };
        for (n, (shares, _)) in self.values.iter().zip(&self.marked).enumerate().filter(|(_, (_, marked))| **marked) {
            if let (Some(lower), Some(sum)) = (lower.get_mut(n), sum.get_mut(n)) {
                (0..BLOCK).for_each(|at| add(shares[at], &mut lower[at], &mut sum[at]));
            } else {
                let rest = lower_rest.iter_mut().zip(&mut *sum_rest);
                shares.iter().zip(rest).for_each(|(share, (lower, sum))| add(*share, lower, sum));
            }
        }
    }

    /// Zeros everywhere.
    fn clear(&mut self) {
        for ((marked, values), entries) in self.marked.iter_mut().zip(&mut self.values).zip(&mut self.entries) {
            if std::mem::take(marked) {
                (*values, *entries) = ([0.0; BLOCK], [0; BLOCK]);
            }
        }
    }
}

const KINDS: [RangeKind; 4] = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];

fn number(kind: RangeKind) -> usize {
    match kind {
        RangeKind::Cells => 0,
        RangeKind::Faces(axis) => 1 + axis.min(2),
    }
}

/// What of a layer is wanted.
#[derive(Debug, Clone, Copy)]
pub enum LayerPart {
    /// Cells, and with true their low faces.
    Layer(usize, bool),
    /// The z faces in a plane.
    Plane(usize),
}

impl LayerPart {
    fn layer(self) -> usize {
        match self {
            LayerPart::Layer(k, _) | LayerPart::Plane(k) => k,
        }
    }

    /// Lowest and highest plane.
    #[must_use]
    pub fn planes(self) -> [usize; 2] {
        match self {
            LayerPart::Layer(k, _) => [k, k + 1],
            LayerPart::Plane(k) => [k, k],
        }
    }
}

/// Adds the union of some solids to a part of a layer. `union` gives bounds of the union of some of them in one cell or face. Returns those
/// whose shares cannot be relied on here; then nothing has been added.
pub fn add(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    memory: &mut FormulaMemory,
    layer: &mut Layer<f64>,
    tol: f64,
) -> Vec<usize> {
    for (sums, kind) in memory.sums.iter_mut().zip(KINDS) {
        sums.make_room(length(layer, kind));
    }
    let doubtful = tell_shares(solids, grid, part, memory);
    if doubtful.is_empty() {
        settle(memory);
        add_alone(&memory.sums, layer);
        add_shared(solids, grid, part, memory, layer, tol);
    }
    memory.sums.iter_mut().for_each(Sums::clear);
    doubtful
}

/// Adds up the shares of solids where they meet no other, and lists the others. Returns those that cannot be relied on.
fn tell_shares(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    FormulaMemory { sums, entries, kept, keeps, .. }: &mut FormulaMemory,
) -> Vec<usize> {
    if let LayerPart::Layer(k, _) = part {
        kept.begin(keeps.then_some(k));
    }
    let mut doubtful = Vec::new();
    entries.clear();
    let rows = KINDS.map(|kind| row_length(grid, kind) as u32);
    let z = part.planes().map(|plane| grid.edges(2)[plane]);
    for (n, s) in solids.iter().enumerate() {
        let worst = match &s.kind {
            Kind::Torus(solid, _) => {
                let first = entries.len();
                tell_torus(solid, grid, part, n as u32, entries);
                entries[first..].iter().for_each(|e| sums[usize::from(e.0)].count(e.1 as usize));
                0.0
            }
            Kind::Quadric(solid, _) => {
                let [columns, lines] = s.shared_with_partners(grid, z);
                let within = rows.map(|row| lines.start * row as usize..lines.end * row as usize);
                let mut visit = |kind: RangeKind, at: usize, share: f64| {
                    let of_kind = number(kind);
                    if within[of_kind].contains(&at) && columns.contains(&((at as u32 % rows[of_kind]) as usize)) {
                        sums[of_kind].count(at);
                        entries.push((of_kind as u8, at as u32, n as u32, [share, 0.0]));
                    } else {
                        sums[of_kind].add(at, share);
                    }
                };
                match part {
                    LayerPart::Layer(k, areas) => {
                        solid.layer_between(grid, k, areas, kept.of_solid(s.number), &mut visit)
                    }
                    LayerPart::Plane(plane) => {
                        solid.plane(grid, plane, &mut visit);
                        0.0
                    }
                }
            }
        };
        if !(worst <= BELIEVED) {
            doubtful.push(n);
        }
    }
    doubtful
}

/// Of entries that turned out to be the only one of their place, and are exact, the share joins those that meet no other.
fn settle(FormulaMemory { sums, entries, .. }: &mut FormulaMemory) {
    entries.retain(|&(kind, at, _, [share, error])| {
        let (sums, at) = (&mut sums[usize::from(kind)], at as usize);
        let alone = sums.is_single(at) && error == 0.0;
        if alone {
            sums.add(at, share);
        }
        !alone
    });
}

/// Adds the shares of solids that meet no other.
fn add_alone(sums: &[Sums; 4], layer: &mut Layer<f64>) {
    for (sums, kind) in sums.iter().zip(KINDS) {
        let (lower, sum) = values(layer, kind);
        sums.add_to(lower, sum);
    }
}

/// The shares of a torus, with what each may be off by.
fn tell_torus(solid: &TorusSolid, grid: &Grid<f64>, part: LayerPart, n: u32, entries: &mut Vec<Entry>) {
    let first = entries.len();
    let mut visit = |kind: RangeKind, at: usize, share: f64, error: f64| {
        entries.push((number(kind) as u8, at as u32, n, [share, error]));
    };
    match part {
        LayerPart::Layer(k, areas) => {
            let worst = solid.layer(grid, k, areas, &mut visit);
            if worst > 0.0 {
                entries[first..].iter_mut().for_each(|e| e.3[1] += worst);
            }
        }
        LayerPart::Plane(plane) => solid.plane(grid, plane, &mut visit),
    }
}

/// Adds the places that solids with partners have shares of; those of the others have been added.
fn add_shared(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    memory: &mut FormulaMemory,
    layer: &mut Layer<f64>,
    tol: f64,
) {
    let FormulaMemory { sums, entries, shared, .. } = memory;
    entries.sort_unstable_by_key(|e| (e.0, e.1, e.2));
    let mut shares: Vec<Share> = Vec::new();
    let mut bodies: Vec<&FormulaSolid> = Vec::new();
    for place in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (kind, at) = (KINDS[usize::from(place[0].0)], place[0].1 as usize);
        shares.clear();
        place.iter().for_each(|entry| add_share(&mut shares, entry));
        let place = Place { solids, grid, kind, range: cell(grid, kind, at, part), shares: &shares, tol };
        let alone = sums[number(kind)].value(at);
        let (mut found, known) = place.apart_and_meeting(alone, &mut bodies);
        if !bodies.is_empty() {
            *shared += usize::from(kind == RangeKind::Cells);
            let known = place.together(&bodies, known);
            (found.lower, found.upper) = (found.lower + known.lower, found.upper + known.upper);
        }
        found.lower -= place.common();
        let (lower, sum) = values(layer, kind);
        if found.lower > FULL {
            found = Bounds::CLOSED;
        }
        // The shares of those that meet nothing stand there already.
        lower[at] = lower[at].max(found.lower);
        sum[at] += found.upper - alone;
    }
}

/// A cell or face, and the shares of it that solids with partners have, with their errors.
struct Place<'a, 's> {
    solids: &'a [&'a FormulaSolid],
    grid: &'a Grid<'a, f64>,
    kind: RangeKind,
    range: CellRange,
    shares: &'s [Share],
    tol: f64,
}

impl<'a> Place<'a, '_> {
    fn meets(&self, a: usize) -> bool {
        self.shares.iter().any(|&(b, _)| self.meet(a, b))
    }

    /// May two solids share more of it than is told?
    fn meet(&self, a: usize, b: usize) -> bool {
        let beside = |n: usize| ends_at(&self.solids[n].bounds, self.grid, self.kind, self.range);
        match self.solids[a].pair_with(self.solids[b]) {
            None => false,
            Some(Pair::Meeting) => true,
            Some(Pair::Touching) => (beside(a) && beside(b)) || self.common_of(a, b) > TOLD * self.tol,
        }
    }

    /// No less than the share that two solids have in common if they touch.
    fn common_of(&self, a: usize, b: usize) -> f64 {
        let place = || box_of(self.grid, self.kind, self.range);
        match self.solids[a].pair_with(self.solids[b]) {
            Some(Pair::Touching) => place().map_or(1.0, |cell| {
                let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
                self.solids[a].common_with(self.solids[b], &BoxAround::new(sides))
            }),
            _ => 0.0,
        }
    }

    /// The same of all that touch here; in faces those that meet have been found out.
    fn common(&self) -> f64 {
        let pairs = self.shares.iter().enumerate().flat_map(|(n, a)| self.shares[..n].iter().map(move |b| (a, b)));
        let is_left = |a: usize, b: usize| self.kind == RangeKind::Cells || !self.meet(a, b);
        // No more than one of them has.
        let common = |(&(a, of_a), &(b, of_b)): (&Share, &Share)| {
            let most = of_a.iter().sum::<f64>().min(of_b.iter().sum());
            if is_left(a, b) { self.common_of(a, b).min(most) } else { 0.0 }
        };
        pairs.map(common).sum()
    }

    /// The sum of `alone` and the shares of solids that meet no other here; and of those that meet, which go to `bodies`, each once, the largest
    /// share and the sum of all.
    fn apart_and_meeting(&self, alone: f64, bodies: &mut Vec<&'a FormulaSolid>) -> (Bounds<f64>, (f64, Bounds<f64>)) {
        let mut apart = Bounds { lower: alone, upper: alone };
        let (mut largest, mut sum) = (0.0_f64, Bounds { lower: 0.0, upper: 0.0 });
        bodies.clear();
        for &(n, [share, error]) in self.shares {
            let share = if share > FULL { 1.0 } else { share };
            let (low, high) = ((share - error).max(0.0), share + error);
            if bodies.iter().any(|other| other.is_same(self.solids[n])) {
                continue;
            }
            if self.shares.len() > 1 && self.meets(n) {
                bodies.push(self.solids[n]);
                (largest, sum) = (largest.max(low), Bounds { lower: sum.lower + low, upper: sum.upper + high });
            } else {
                (apart.lower, apart.upper) = (apart.lower + low, apart.upper + high);
            }
        }
        (apart, (largest, sum))
    }

    /// The share of the union of solids that meet here, from the largest share and the sum.
    fn together(&self, bodies: &[&FormulaSolid], (largest, sum): (f64, Bounds<f64>)) -> Bounds<f64> {
        let Place { grid, kind, range, shares, tol, .. } = *self;
        let known = Bounds { lower: largest, upper: sum.upper.min(1.0) };
        let all_meet = shares.iter().all(|&(n, _)| self.meets(n));
        let ends = all_meet.then(|| concentric(bodies, grid, kind, range)).flatten();
        match ends {
            _ if largest == 1.0 => known,
            Some(apart) => {
                let errors: f64 = shares.iter().map(|(_, [_, error])| 2.0 * error).sum();
                Bounds { lower: largest, upper: (largest + errors + apart).min(1.0) }
            }
            None => {
                let Some(cell) = box_of(grid, kind, range) else { return known };
                union_of(bodies, cell, (known, sum), tol)
            }
        }
    }
}

/// Adds an entry to the shares of a place, ordered by solids.
fn add_share(shares: &mut Vec<Share>, &(_, _, n, share): &Entry) {
    match shares.last_mut() {
        // The parts of a capsule.
        Some((last, sum)) if *last == n as usize => *sum = [sum[0] + share[0], sum[1] + share[1]],
        _ => shares.push((n as usize, share)),
    }
}

/// Places of a kind along x.
fn row_length(grid: &Grid<f64>, kind: RangeKind) -> usize {
    match kind {
        RangeKind::Cells => grid.cells()[0],
        RangeKind::Faces(axis) => grid.face_shape(axis)[0],
    }
}

/// A single cell or face of a layer.
fn cell(grid: &Grid<f64>, kind: RangeKind, at: usize, part: LayerPart) -> CellRange {
    let row = row_length(grid, kind);
    let lo = [at % row, at / row, part.layer()].map(|n| n as u32);
    CellRange { lo, hi: lo.map(|n| n + 1) }
}

fn values<'l>(layer: &'l mut Layer<f64>, kind: RangeKind) -> (&'l mut [f64], &'l mut [f64]) {
    match kind {
        RangeKind::Cells => layer.cells_mut(),
        RangeKind::Faces(axis) => layer.faces_mut(axis),
    }
}

fn length(layer: &Layer<f64>, kind: RangeKind) -> usize {
    match kind {
        RangeKind::Cells => layer.sum().cells().len(),
        RangeKind::Faces(axis) => layer.sum().faces(axis).len(),
    }
}
