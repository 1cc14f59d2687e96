//! The layers of the core in a thread's memory.

use super::CellCounts;
use super::fields::Slices;
use super::road::{Lists, Road, RoadWithLists};
use glam::DVec3;
use std::sync::{Mutex, PoisonError};
use voidage_core::grid::Grid;
use voidage_core::grid::fields::Fields;
use voidage_core::subdivide::QueryCount;
use voidage_core::surface::bins::Group;
use voidage_core::surface::layer::{
    AreaReport, AreaSlices, CellKinds, CellSides, KnownSurface, LayerMemory, LayerReport, Layers, MemoryNeeded,
};
use voidage_core::surface::surface_area::{CellSurface, KeptPiece, KeptPieces, PieceMemory, SurfaceCell};
use voidage_core::surface::union::{Fragment, Node, Octant, Part, PendingNode, Piece, UnionMemory, UnionNeeded};

/// Rows that miss zero by more than this fraction of a face leak.
const LEAK: f64 = 1e-11;

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
    pub leaks: Vec<(usize, f64)>,
    /// What is told about areas.
    pub areas: AreaReport<f64>,
    /// The surface, with areas.
    pub kept: Kept,
}

/// The surface in a layer, with the pieces that were cut for its areas and serve its shadows.
#[derive(Debug, Clone, Default)]
pub struct Kept {
    /// The cells that have some, in ascending order.
    pub cells: Vec<SurfaceCell<f64>>,
    /// What is told beside the areas of some cells.
    pub sides: Vec<CellSides<f64>>,
    pieces: Vec<KeptPiece>,
    corners: Vec<[f64; 3]>,
}

impl Kept {
    /// As the core takes it.
    #[must_use]
    pub fn known(&self) -> KnownSurface<'_, f64> {
        (KeptPieces { cells: &self.cells, pieces: &self.pieces, corners: &self.corners }, &self.sides)
    }
}

impl Summary {
    fn new(report: LayerReport<f64>, others: &RoadWithLists, leaks: Vec<(usize, f64)>) -> Self {
        let CellKinds { open, cut, closed, ambiguous } = report.cells;
        Summary {
            cells: CellCounts { open, cut, closed, ambiguous: ambiguous.max(others.shared()) },
            volume: report.solid_volume,
            max_gap: report.max_gap,
            divided: report.divided,
            winding: report.defects.winding,
            tally: others.tally(),
            leaks,
            ..Summary::default()
        }
    }

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

/// Where a layer's open fractions go; zeros before.
#[derive(Debug)]
pub struct Target<'a> {
    /// The value: the middle of the bounds.
    pub beta: Slices<'a>,
    /// Lower and upper bounds, if wanted.
    pub bounds: Option<[Slices<'a>; 2]>,
    /// Of what.
    pub wanted: WantedOfLayer,
}

/// What is wanted of a layer. Where it is surface, bodies go by that alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WantedOfLayer {
    /// Open fractions.
    Fractions,
    /// Open fractions and the surface in cells.
    FractionsAndSurface,
    /// The surface in cells; open fractions may be far from the truth.
    Surface,
}

/// Bytes of memory that one layer's sums take.
#[must_use]
pub fn memory_of_a_thread(grid: &Grid<f64>) -> usize {
    size_of::<f64>().saturating_mul(LayerMemory::<DVec3>::needed(grid).reals)
}

/// One worker for each thread of the current pool, made when the thread gets its first layer.
#[derive(Default)]
pub struct Workers(Vec<Mutex<Option<Worker>>>);

impl Workers {
    /// None made yet.
    #[must_use]
    pub fn new() -> Self {
        Workers((0..rayon::current_num_threads()).map(|_| Mutex::new(None)).collect())
    }

    /// Compute layer `k` in the memory of the current thread.
    pub fn layer(&self, grid: &Grid<f64>, layers: &Layers<DVec3>, road: &Road, k: usize, target: Target) -> Summary {
        self.with(layers, |worker| worker.layer(grid, layers, road, k, target))
    }

    /// Do something else with layers in the memory of the current thread, which leaves the sums of layers as they are.
    pub fn beside<T>(
        &self,
        grid: &Grid<f64>,
        layers: &Layers<DVec3>,
        work: impl FnOnce(&mut LayerMemory<DVec3>) -> T,
    ) -> T {
        self.with(layers, |worker| work(&mut worker.sums.memory(grid, true)))
    }

    /// Work in the memory of the current thread.
    fn with<T>(&self, layers: &Layers<DVec3>, work: impl FnOnce(&mut Worker) -> T) -> T {
        let slot = rayon::current_thread_index().and_then(|n| self.0.get(n));
        match slot {
            None => work(&mut Worker::new(layers)),
            Some(slot) => {
                let mut worker = slot.lock().unwrap_or_else(PoisonError::into_inner);
                work(worker.get_or_insert_with(|| Worker::new(layers)))
            }
        }
    }
}

/// A thread's memory.
struct Worker {
    sums: SumVecs,
    lists: Lists,
    areas: AreaVecs,
}

/// What a thread needs for areas of surface in a layer.
#[derive(Default)]
struct AreaVecs {
    cells: Vec<CellSurface<f64>>,
    numbers: Vec<u32>,
    kept: Kept,
}

impl AreaVecs {
    /// Room for the cells of a layer, and for as many pieces of each layer.
    fn make_room(&mut self, cells: usize, layers: usize) {
        let pieces = (ALL_PIECES_KEPT / layers.max(1)).min(PIECES_KEPT);
        self.cells.resize(cells, CellSurface::default());
        self.numbers.resize(cells, 0);
        self.kept.cells.resize(cells, SurfaceCell::default());
        self.kept.sides.resize(cells, CellSides::default());
        self.kept.pieces.resize(pieces, KeptPiece::default());
        if self.kept.corners.len() != CORNERS_EACH * pieces {
            // A new list of zeros takes no memory before it is used.
            self.kept.corners = vec![[0.0; 3]; CORNERS_EACH * pieces];
        }
    }

    /// A copy of what has been kept of a layer.
    fn kept(&self, used: &AreaReport<f64>) -> Kept {
        let Kept { cells, sides, pieces, corners } = &self.kept;
        Kept {
            cells: cells[..used.cells].to_vec(),
            sides: sides[..used.sides].to_vec(),
            pieces: pieces[..used.kept.pieces].to_vec(),
            corners: corners[..used.kept.corners].to_vec(),
        }
    }
}

/// Pieces of surface that are kept of a layer, and of all of them: of others, shadows cut them again. The same for any number of threads.
const PIECES_KEPT: usize = 1 << 16;
const ALL_PIECES_KEPT: usize = 1 << 21;

/// Corners that a piece has, or nearly.
const CORNERS_EACH: usize = 5;

/// What a thread needs for sums over surfaces and for unions.
struct SumVecs {
    needed: MemoryNeeded,
    /// Pieces of surface that one cell may hold before it is divided.
    most_pieces: usize,
    reals: Vec<f64>,
    flags: Vec<u8>,
    numbers: Vec<u32>,
    groups: Vec<Group<DVec3>>,
    union: Option<UnionVecs>,
}

impl SumVecs {
    /// As the core takes it; for bodies that share no cells it holds sums alone.
    fn memory(&mut self, grid: &Grid<f64>, shared: bool) -> LayerMemory<'_, DVec3> {
        if shared && self.union.is_none() {
            self.numbers = vec![0; self.needed.numbers];
            self.groups = vec![Group::default(); self.needed.groups];
            self.union = Some(UnionVecs::new(self.most_pieces));
        }
        let SumVecs { reals, flags, numbers, groups, union, .. } = self;
        let union = union.as_mut().map_or_else(UnionMemory::default, UnionVecs::memory);
        debug_assert!(reals.iter().take(Fields::<u8>::needed(grid)).all(|sum| *sum == 0.0), "a layer leaves zeros");
        LayerMemory::of_zero_sums(grid, reals, flags, numbers, groups, union).expect(FITS)
    }
}

impl Worker {
    fn new(layers: &Layers<DVec3>) -> Self {
        let needed = layers.memory_needed();
        let sums = SumVecs {
            needed,
            most_pieces: layers.union_pieces(),
            reals: vec![0.0; needed.reals],
            flags: vec![0; needed.flags],
            numbers: Vec::new(),
            groups: Vec::new(),
            union: None,
        };
        Worker { sums, lists: Lists::default(), areas: AreaVecs::default() }
    }

    /// Compute layer `k`.
    fn layer(&mut self, grid: &Grid<f64>, layers: &Layers<DVec3>, road: &Road, k: usize, target: Target) -> Summary {
        let Worker { sums, lists, areas: vecs } = self;
        // Only bodies that share cells ask for more than sums.
        let mut memory = sums.memory(grid, layers.bodies_in(k) > usize::from(road.is_empty()));
        let mut others = road.with(grid, lists);
        let mut leaks = Vec::new();
        let note_leak = |body, defects: voidage_core::surface::error::Defects<f64>| {
            if !(defects.leak <= LEAK) {
                leaks.push((body, defects.leak));
            }
        };
        let Target { beta, bounds, wanted } = target;
        let (beta, bounds) = (beta.for_core(), bounds.map(|both| both.map(Slices::for_core)));
        if wanted == WantedOfLayer::Fractions {
            let report = layers.zeroed_layer(k, beta, bounds, &mut memory, &mut others, note_leak).expect(FITS);
            return Summary::new(report, &others, leaks);
        }
        let [nx, ny, nz] = grid.cells();
        vecs.make_room(nx * ny, nz);
        let AreaVecs { cells, numbers, kept: Kept { cells: union, sides, pieces, corners } } = &mut *vecs;
        let (pieces, fractions_known) = (PieceMemory { pieces, corners }, wanted == WantedOfLayer::Surface);
        let areas = AreaSlices { union, sides, cells, numbers, pieces, fractions_known };
        let (report, areas) = layers.layer_and_areas(k, beta, bounds, areas, &mut memory, note_leak).expect(FITS);
        Summary { areas, kept: vecs.kept(&areas), ..Summary::new(report, &others, leaks) }
    }
}

/// Memory for unions.
struct UnionVecs {
    pieces: Vec<Piece<f64>>,
    split_pieces: Vec<Piece<f64>>,
    order: Vec<u32>,
    nodes: Vec<Node<f64>>,
    parts: Vec<Part<f64>>,
    fragments: Vec<Fragment<f64>>,
    pending: Vec<PendingNode>,
    octants: Vec<Octant<f64>>,
    near: Vec<u32>,
}

impl UnionVecs {
    /// For so many pieces of all bodies together.
    fn new(most_pieces: usize) -> Self {
        let UnionNeeded { pieces, split_pieces, order, nodes, fragments, pending, octants, near, .. } =
            UnionMemory::<f64>::needed(most_pieces);
        UnionVecs {
            pieces: vec![Piece::default(); pieces],
            split_pieces: vec![Piece::default(); split_pieces],
            order: vec![0; order],
            nodes: vec![Node::default(); nodes],
            parts: vec![Part::default(); most_pieces / 2],
            fragments: vec![Fragment::default(); fragments],
            pending: vec![PendingNode::default(); pending],
            octants: vec![Octant::default(); octants],
            near: vec![0; near],
        }
    }

    fn memory(&mut self) -> UnionMemory<'_, f64> {
        UnionMemory {
            pieces: &mut self.pieces,
            split_pieces: &mut self.split_pieces,
            order: &mut self.order,
            nodes: &mut self.nodes,
            parts: &mut self.parts,
            fragments: &mut self.fragments,
            pending: &mut self.pending,
            octants: &mut self.octants,
            near: &mut self.near,
        }
    }
}
