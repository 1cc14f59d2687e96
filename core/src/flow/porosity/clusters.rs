//! Small cells: open faces in front of hardly any open volume.
//!
//! Alone such a cell would force the time step down with its volume. It is merged with its neighbours, transitively, until
//! the cluster has the share [`SMALL_SHARE`] (the reference takes one half) of the volume that its largest open face asks for; after each step the cluster's cells share one state.
//! Where nothing moves a cluster is left alone, so gas at rest keeps its densities.
//!
//! Clusters stay local. Neighbours that are alike in every respect are joined all, so that mirrored porosity gives mirrored clusters, but only
//! where that ends at once: along a wall at 45° each small cell stands between two equal neighbours and each of those between two small cells,
//! and joining all would make one cluster of the whole wall. There the neighbour nearer to the middle of the mesh is taken.
//!
//! References: M. Berger, A. Giuliani, J. Comput. Phys. 428 (2021) 109820 (state redistribution, threshold one half).

use crate::flow::error::{Error, fits};
use crate::flow::porosity::flags::{BORDER, is};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE};
use crate::flow::state::sum;
use crate::number::real::Real;

/// Marks the last cell of a cluster in the list.
const LAST: u32 = 1 << 31;

/// Clusters of cells that share one state: their cells one after the other.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Clusters<'a>(pub(in crate::flow) &'a [u32]);

/// Length of the scratch that the search for clusters needs for a number of cells.
pub const fn cluster_scratch(cells: usize) -> usize {
    cells.saturating_mul(8)
}

/// Passes that make the smoothed volume of a cell: it starts as the open volume, and each pass adds those of the neighbours times the open
/// fraction between. It ranks equal neighbours without regard to the side they stand on, so that clusters stay small.
const SMOOTHING_PASSES: usize = 8;

/// What speaks for growing across a face: its opening times the volume of its cell, the volume of the cluster behind it, the smoothed volume
/// of the cell behind it, and among equals by these the place ([`Search::rank`]).
const REASONS: usize = 4;

/// The number of the reason that is the place. It ranks without tolerance.
const PLACE: usize = 3;

/// Reasons that differ by less than this share are equal: the fractions of mirrored faces agree but for rounding, and where a face touches a curved wall
/// but for rounding by the root of that, times the root of the wall's radius in cells.
const EQUAL: f64 = 1e-5;

/// Are the first `count` reasons of a face as good as the best?
fn equal_up_to<R: Real>(count: usize, this: &[R; REASONS], best: &[R; REASONS]) -> bool {
    let least = R::ONE - R::larger(R::from_f64(EQUAL), R::from_f64(64.0) * R::EPSILON);
    (0..count).all(|r| this[r] >= if r == PLACE { best[r] } else { least * best[r] })
}

/// Finds the clusters; returns how many entries of `list` they fill.
///
/// `list` and `parent` are one entry per cell (fewer than 2^31), `scratch` as [`cluster_scratch`]. Clusters grow across their
/// largest open face, of equal ones across that to the larger volume, of equal ones towards the larger smoothed volume, of equal ones across all whose
/// cluster no other one has to share, and where there is none towards the middle of the mesh: porosity mirrored at the middle gives mirrored clusters.
///
/// # Errors
/// A slice does not fit the mesh, or the mesh has too many cells.
pub(in crate::flow) fn clusters<R: Real, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    porosity: Porosity<'_, R, D>,
    periodic: [bool; D],
    list: &mut [u32],
    parent: &mut [u32],
    scratch: &mut [R],
) -> Result<usize, Error> {
    let n = mesh.len();
    let space = Space::new(mesh, porosity, periodic)?;
    fits(n, list.len())?;
    fits(n, parent.len())?;
    if scratch.len() < cluster_scratch(n) {
        return Err(Error::ShapeMismatch { expected: cluster_scratch(n), found: scratch.len() });
    }
    if n >= LAST as usize {
        return Err(Error::TooManyCells);
    }
    let mut search = Search::new(n, list, parent, scratch);
    search.smooth(&space);
    loop {
        search.take_picture(&space);
        (0..PLACE).for_each(|reason| search.choose(&space, reason));
        search.count_ties(&space);
        search.choose(&space, PLACE);
        if !search.join(&space) {
            return Ok(search.into_list());
        }
    }
}

/// The porous space as the search for clusters sees it.
struct Space<'a, R, const D: usize> {
    medium: Medium<'a, R, D>,
}

impl<'a, R: Real, const D: usize> Space<'a, R, D> {
    fn new(mesh: &Mesh<'a, R, D>, porosity: Porosity<'a, R, D>, periodic: [bool; D]) -> Result<Self, Error> {
        fits(mesh.len(), porosity.volume.len())?;
        for d in 0..D {
            fits(mesh.faces(d), porosity.faces[d].len())?;
        }
        Ok(Space { medium: Medium { mesh: *mesh, porosity, periodic } })
    }

    /// Every open face of a cell: its axis, what lies behind it, and its open fraction.
    fn each_face(&self, cell: usize, mut f: impl FnMut(usize, Option<usize>, R)) {
        let mesh = &self.medium.mesh;
        let (at, cells) = (mesh.coordinates(cell), mesh.cells());
        for d in 0..D {
            let (low, high) = self.medium.ducts(d, at).openings(0);
            for (open, up) in [(low, false), (high, true)] {
                if !(open > R::ZERO) {
                    continue;
                }
                let edge = if up { cells[d] - 1 } else { 0 };
                let mut next = at;
                let behind = if at[d] != edge {
                    next[d] = if up { at[d] + 1 } else { at[d] - 1 };
                    Some(next)
                } else if self.medium.periodic[d] {
                    next[d] = cells[d] - 1 - edge;
                    Some(next)
                } else {
                    None
                };
                f(d, behind.map(|b| mesh.index(b)), open);
            }
        }
    }

    /// Volume of a cell, its obstacles included.
    fn whole(&self, cell: usize) -> R {
        self.medium.mesh.volume(self.medium.mesh.coordinates(cell))
    }

    fn open_volume(&self, cell: usize) -> R {
        self.medium.porosity.volume[cell] * self.whole(cell)
    }

    /// Steps from a cell to its mirror image in the middle of the mesh, axis by axis.
    fn steps_off_middle(&self, cell: usize) -> [usize; D] {
        let (at, cells) = (self.medium.mesh.coordinates(cell), self.medium.mesh.cells());
        core::array::from_fn(|d| (2 * at[d] + 1).abs_diff(cells[d]))
    }

    /// How near a cell is to the middle of the mesh: above 0, and 1 in the middle itself. Walls at 45° have different values on both sides
    /// of each of their cells but one.
    fn nearness(&self, cell: usize) -> R {
        let most = self.medium.mesh.cells().into_iter().max().unwrap_or(1).max(1);
        let scale = R::ONE / R::from_usize(most);
        let squares = self.steps_off_middle(cell).map(|x| {
            let x = scale * R::from_usize(x);
            x * x
        });
        R::ONE / (R::ONE + sum::<R, D>(squares))
    }

    /// A number below 1 that looks drawn by chance, the same in mirrored cells.
    fn lot(&self, cell: usize) -> R {
        // The finish of a hash: T. Wang's, as others use it, with 32 bits.
        let mixed = self.steps_off_middle(cell).into_iter().fold(0u32, |all, x| {
            let x = (x as u32 ^ 61 ^ (x as u32 >> 16)).wrapping_mul(9);
            let x = (x ^ (x >> 4)).wrapping_mul(0x27d4_eb2d);
            all.wrapping_add(x ^ (x >> 15))
        });
        R::from_f64(f64::from(mixed >> 8) / f64::from(1 << 24))
    }
}

/// The cells behind the open faces of a cell, and what speaks for each.
type WaysOut<R> = heapless::Vec<(usize, [R; REASONS]), 6>;

/// The growing clusters. Each is a tree of cells; what belongs to a cluster stands at the index of its root.
struct Search<'s, R> {
    /// The next cell towards the root; the root is its own.
    parent: &'s mut [u32],
    /// The root of each cell at the last [`Search::take_picture`].
    root: &'s mut [u32],
    /// Open volume of each cluster, and the largest of its open faces times the volume of its cell.
    held: &'s mut [R],
    wanted: &'s mut [R],
    /// Best face to grow across, reason by reason.
    best: [&'s mut [R]; REASONS],
    /// Faces to each cluster that are tied with others of the cluster that would grow across them.
    tied: &'s mut [R],
    /// Smoothed volume of each cell, see [`SMOOTHING_PASSES`].
    smoothed: &'s mut [R],
}

impl<'s, R: Real> Search<'s, R> {
    fn new(n: usize, root: &'s mut [u32], parent: &'s mut [u32], scratch: &'s mut [R]) -> Self {
        let mut rest = scratch;
        let mut take = || {
            let (piece, after) = core::mem::take(&mut rest).split_at_mut(n);
            rest = after;
            piece
        };
        let (held, wanted) = (take(), take());
        let best = [take(), take(), take(), take()];
        for (i, p) in parent.iter_mut().enumerate() {
            *p = i as u32;
        }
        Search { parent, root, held, wanted, best, tied: take(), smoothed: take() }
    }

    /// Finds the smoothed volume of every cell.
    fn smooth<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        let (smoothed, before) = (&mut *self.smoothed, &mut *self.best[2]);
        for (cell, volume) in smoothed.iter_mut().enumerate() {
            *volume = space.open_volume(cell);
        }
        for _ in 0..SMOOTHING_PASSES {
            before.copy_from_slice(smoothed);
            for (cell, volume) in smoothed.iter_mut().enumerate() {
                let mut beside = [R::ZERO; D];
                space.each_face(cell, |d, behind, open| beside[d] += open * behind.map_or(R::ZERO, |b| before[b]));
                *volume += sum::<R, D>(beside);
            }
        }
    }

    fn root_of(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    /// Records root, open volume and wanted volume of every cluster. `choose` and `join` judge by this record alone, so that the order of the
    /// cells does not count while clusters grow.
    fn take_picture<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        self.held.fill(R::ZERO);
        self.wanted.fill(R::ZERO);
        for i in 0..self.parent.len() {
            let r = self.root_of(i as u32);
            self.root[i] = r;
            let r = r as usize;
            self.held[r] += space.open_volume(i);
            // What the border of a porous body leaves is enough.
            if space.medium.porosity.marks.get(i).is_some_and(|&m| is(m, BORDER)) {
                continue;
            }
            let own = space.whole(i);
            let wanted = &mut self.wanted[r];
            space.each_face(i, |_, _, open| *wanted = R::larger(open * own, *wanted));
        }
    }

    /// The cluster of a cell, if it holds too little.
    fn short(&self, i: usize) -> Option<usize> {
        let r = self.root[i] as usize;
        (self.held[r] < R::from_f64(SMALL_SHARE) * self.wanted[r]).then_some(r)
    }

    /// What the place of a cell behind a face says for growing there, once [`Search::count_ties`] has counted: most where no other tie leads to its
    /// cluster; then where the cluster holds enough, the nearer to the middle of the mesh the better; among clusters that are short themselves a
    /// lot decides, for whatever leads on from cell to cell would lead all of them to one place.
    fn rank<const D: usize>(&self, space: &Space<'_, R, D>, cell: usize) -> R {
        if self.tied[self.root[cell] as usize] <= R::ONE {
            R::TWO
        } else if self.short(cell).is_none() {
            R::ONE + space.nearness(cell)
        } else {
            space.lot(cell)
        }
    }

    /// Every open face of a cell to another cluster: the cell behind it, and what speaks for growing across it.
    ///
    /// Called, not inlined: three passes go over them, and their code would stand in each.
    #[inline(never)]
    fn ways_out<const D: usize>(&self, space: &Space<'_, R, D>, i: usize) -> WaysOut<R> {
        let (own, mut ways) = (space.whole(i), WaysOut::new());
        space.each_face(i, |_, behind, open| {
            if let Some(b) = behind.filter(|&b| b != i && self.root[b] != self.root[i]) {
                // By rising smoothed volumes short clusters would join one after the other, so they count only where the cluster behind
                // is large enough.
                let smoothed = if self.short(b).is_some() { R::ZERO } else { self.smoothed[b] };
                // A cell has at most six faces, so there is a place.
                let _ = ways.push((b, [open * own, self.held[self.root[b] as usize], smoothed, self.rank(space, b)]));
            }
        });
        ways
    }

    /// Chooses where each short cluster grows: the best of a reason among the faces that are equal by all reasons before it.
    #[inline(never)]
    fn choose<const D: usize>(&mut self, space: &Space<'_, R, D>, reason: usize) {
        self.best[reason].fill(-R::ONE);
        for i in 0..self.root.len() {
            let Some(r) = self.short(i) else { continue };
            let known = self.best.each_ref().map(|b| b[r]);
            let mut best = known[reason];
            for (_, this) in self.ways_out(space, i) {
                if equal_up_to(reason, &this, &known) {
                    best = R::larger(this[reason], best);
                }
            }
            self.best[reason][r] = best;
        }
    }

    /// Counts the ties by all reasons but the place that lead to each cluster.
    fn count_ties<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        self.tied.fill(R::ZERO);
        // The best place is not known yet: until then its slice holds the number of equal ways out of each cluster.
        self.best[PLACE].fill(R::ZERO);
        for counted in [false, true] {
            for i in 0..self.root.len() {
                let Some(r) = self.short(i) else { continue };
                let best = self.best.each_ref().map(|b| b[r]);
                for (b, _) in self.ways_out(space, i).iter().filter(|way| equal_up_to(PLACE, &way.1, &best)) {
                    if !counted {
                        self.best[PLACE][r] += R::ONE;
                    } else if best[PLACE] > R::ONE {
                        self.tied[self.root[*b] as usize] += R::ONE;
                    }
                }
            }
        }
    }

    /// Joins short clusters with those across their best faces; false if none grew.
    fn join<const D: usize>(&mut self, space: &Space<'_, R, D>) -> bool {
        let mut grown = false;
        for i in 0..self.root.len() {
            let Some(r) = self.short(i) else { continue };
            let best = self.best.each_ref().map(|b| b[r]);
            let ways = self.ways_out(space, i);
            for (b, _) in ways.into_iter().filter(|way| equal_up_to(REASONS, &way.1, &best)) {
                let (p, q) = (self.root_of(i as u32), self.root_of(b as u32));
                self.parent[p.max(q) as usize] = p.min(q);
                grown = true;
            }
        }
        grown
    }

    /// Lists the cells of clusters with company, ordered by cluster; returns how many.
    fn into_list(self) -> usize {
        let n = self.parent.len();
        for i in 0..n {
            self.parent[i] = self.root_of(i as u32);
        }
        let Search { parent, root: list, held: members, .. } = self;
        members.fill(R::ZERO);
        for &root in &*parent {
            members[root as usize] += R::ONE;
        }
        let mut count = 0;
        for i in 0..n {
            if members[parent[i] as usize] > R::ONE {
                list[count] = i as u32;
                count += 1;
            }
        }
        list[..count].sort_unstable_by_key(|&i| (parent[i as usize], i));
        for e in 0..count {
            let last = e + 1 == count || parent[(list[e + 1] & !LAST) as usize] != parent[list[e] as usize];
            if last {
                list[e] |= LAST;
            }
        }
        count
    }
}

impl<'a> Clusters<'a> {
    /// One slice of (possibly flagged) entries per cluster.
    fn each(self) -> impl Iterator<Item = &'a [u32]> {
        self.0.split_inclusive(|e| e & LAST != 0)
    }

    /// The cells of each cluster.
    pub(in crate::flow) fn groups(self) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone + 'a> {
        self.each().map(|cluster| cluster.iter().map(|e| (e & !LAST) as usize))
    }

    /// The cells of all clusters.
    pub(in crate::flow) fn cells(self) -> impl Iterator<Item = usize> + 'a {
        self.0.iter().map(|e| (e & !LAST) as usize)
    }
}
