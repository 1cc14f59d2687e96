//! Small cells: open faces in front of hardly any open volume.
//!
//! Alone such a cell would force the time step down with its volume. It is merged with its neighbours, transitively, until
//! the cluster has the share [`SMALL_SHARE`] (the reference takes one half) of the volume that its largest open face asks for; after each step the cluster's cells share one state.
//! Where nothing moves a cluster is left alone, so gas at rest keeps its densities.
//!
//! References: M. Berger, A. Giuliani, J. Comput. Phys. 428 (2021) 109820 (state redistribution, threshold one half).

use crate::flow::error::{Error, fits};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE};
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas, sum};
use crate::number::real::Real;

/// Marks the last cell of a cluster in the list.
const LAST: u32 = 1 << 31;

/// Clusters of cells that share one state: their cells one after the other.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Clusters<'a>(pub(in crate::flow) &'a [u32]);

/// Length of the scratch that the search for clusters needs for a number of cells.
pub const fn cluster_scratch(cells: usize) -> usize {
    cells.saturating_mul(6)
}

/// Smoothing passes of the room of a cell: it starts as the open volume, and each pass adds the neighbours' values times the open
/// fraction between. It ranks equal neighbours without regard to the side they stand on, so that clusters stay small.
const SMOOTHING_PASSES: usize = 8;

/// Finds the clusters; returns how many entries of `list` they fill.
///
/// `list` and `parent` are one entry per cell (fewer than 2^31), `scratch` as [`cluster_scratch`]. Clusters grow across their
/// largest open face, of equal ones across that to the larger volume, of equal ones towards more room, of equal ones across all:
/// mirrored porosity gives mirrored clusters.
///
/// # Errors
/// A slice does not fit the mesh, or the mesh has too many cells.
pub(in crate::flow) fn clusters<R: Real, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    (volume, faces): (&[R], &[&[R]; D]),
    periodic: [bool; D],
    list: &mut [u32],
    parent: &mut [u32],
    scratch: &mut [R],
) -> Result<usize, Error> {
    let n = mesh.len();
    let space = Space::new(mesh, volume, faces, periodic)?;
    fits(n, list.len())?;
    fits(n, parent.len())?;
    if scratch.len() < cluster_scratch(n) {
        return Err(Error::ShapeMismatch { expected: cluster_scratch(n), found: scratch.len() });
    }
    if n >= LAST as usize {
        return Err(Error::TooManyCells);
    }
    let mut search = Search::new(n, list, parent, scratch);
    search.find_room(&space);
    loop {
        search.take_picture(&space);
        search.choose(&space);
        if !search.join(&space) {
            return Ok(search.into_list());
        }
    }
}

/// The porous space as the search for clusters sees it.
struct Space<'a, R, const D: usize> {
    medium: Medium<'a, R, D>,
    periodic: [bool; D],
}

impl<'a, R: Real, const D: usize> Space<'a, R, D> {
    fn new(mesh: &Mesh<'a, R, D>, volume: &'a [R], faces: &[&'a [R]; D], periodic: [bool; D]) -> Result<Self, Error> {
        fits(mesh.len(), volume.len())?;
        for d in 0..D {
            fits(mesh.faces(d), faces[d].len())?;
        }
        let porosity = Porosity { volume, faces: *faces, marks: &[] };
        Ok(Space { medium: Medium { mesh: *mesh, porosity }, periodic })
    }

    /// Every open face of a cell: its axis, what lies behind it, and its open fraction.
    fn each_face(&self, cell: usize, mut f: impl FnMut(usize, Option<usize>, R)) {
        let mesh = &self.medium.mesh;
        let (at, cells) = (mesh.coordinates(cell), mesh.cells());
        for d in 0..D {
            let (low, high) = self.medium.ducts(d, at, self.periodic[d]).openings(0);
            for (open, up) in [(low, false), (high, true)] {
                if !(open > R::ZERO) {
                    continue;
                }
                let edge = if up { cells[d] - 1 } else { 0 };
                let mut next = at;
                let behind = if at[d] != edge {
                    next[d] = if up { at[d] + 1 } else { at[d] - 1 };
                    Some(next)
                } else if self.periodic[d] {
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
}

/// The growing clusters. Each is a tree of cells; what belongs to a cluster stands at the index of its root.
struct Search<'s, R> {
    /// The next cell towards the root; the root is its own.
    parent: &'s mut [u32],
    /// The root of each cell when the last picture was taken.
    root: &'s mut [u32],
    /// Open volume of each cluster, and the largest of its open faces times the volume of its cell.
    held: &'s mut [R],
    wanted: &'s mut [R],
    /// Best face to grow across: its opening, the volume of the cluster behind it, and the room there.
    best: [&'s mut [R]; 3],
    /// Room of each cell.
    room: &'s mut [R],
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
        let best = [take(), take(), take()];
        for (i, p) in parent.iter_mut().enumerate() {
            *p = i as u32;
        }
        Search { parent, root, held, wanted, best, room: take() }
    }

    /// Finds the room of every cell.
    fn find_room<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        let (room, before) = (&mut *self.room, &mut *self.best[2]);
        for (cell, room) in room.iter_mut().enumerate() {
            *room = space.open_volume(cell);
        }
        for _ in 0..SMOOTHING_PASSES {
            before.copy_from_slice(room);
            for (cell, room) in room.iter_mut().enumerate() {
                let mut beside = [R::ZERO; D];
                space.each_face(cell, |d, behind, open| beside[d] += open * behind.map_or(R::ZERO, |b| before[b]));
                *room += sum::<R, D>(beside);
            }
        }
    }

    fn root_of(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    /// Takes a picture of the clusters, so that the order of the cells does not count while they grow.
    fn take_picture<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        self.held.fill(R::ZERO);
        self.wanted.fill(R::ZERO);
        for i in 0..self.parent.len() {
            let r = self.root_of(i as u32);
            self.root[i] = r;
            let r = r as usize;
            self.held[r] += space.open_volume(i);
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

    /// Every open face of a cell to another cluster: the cell behind it, and what speaks for growing across it.
    fn each_way_out<const D: usize>(&self, space: &Space<'_, R, D>, i: usize, mut f: impl FnMut(usize, [R; 3])) {
        let own = space.whole(i);
        space.each_face(i, |_, behind, open| {
            if let Some(b) = behind.filter(|&b| b != i && self.root[b] != self.root[i]) {
                f(b, [open * own, self.held[self.root[b] as usize], self.room[b]]);
            }
        });
    }

    /// Chooses where each short cluster grows.
    fn choose<const D: usize>(&mut self, space: &Space<'_, R, D>) {
        self.best[0].fill(R::ZERO);
        self.best[1].fill(-R::ONE);
        self.best[2].fill(-R::ONE);
        for i in 0..self.root.len() {
            let Some(r) = self.short(i) else { continue };
            let mut best = self.best.each_ref().map(|b| b[r]);
            self.each_way_out(space, i, |_, this| {
                if this > best {
                    best = this;
                }
            });
            for (to, value) in self.best.iter_mut().zip(best) {
                to[r] = value;
            }
        }
    }

    /// Joins short clusters with those across their best faces; false if none grew.
    fn join<const D: usize>(&mut self, space: &Space<'_, R, D>) -> bool {
        let mut grown = false;
        for i in 0..self.root.len() {
            let Some(r) = self.short(i) else { continue };
            let best = self.best.each_ref().map(|b| b[r]);
            // A cell has at most six faces.
            let (mut joined, mut count) = ([0; 6], 0);
            self.each_way_out(space, i, |b, this| {
                if this == best {
                    joined[count] = b as u32;
                    count += 1;
                }
            });
            for &b in &joined[..count] {
                let (p, q) = (self.root_of(i as u32), self.root_of(b));
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

/// A sum with its rounding errors, and theirs: three words that all but never let the order of the terms show.
#[derive(Clone, Copy)]
struct Sum<R>([R; 3]);

impl<R: Real> Sum<R> {
    const fn new() -> Self {
        Sum([R::ZERO; 3])
    }

    /// Knuth's exact sum of two numbers, twice.
    fn add(&mut self, x: R) {
        let two = |a: R, b: R| {
            let s = a + b;
            let t = s - a;
            (s, (a - (s - t)) + (b - t))
        };
        let (high, e) = two(self.0[0], x);
        let (middle, e) = two(self.0[1], e);
        self.0 = [high, middle, self.0[2] + e];
    }

    fn value(self) -> R {
        self.0[0] + (self.0[1] + self.0[2])
    }
}

/// The least volume a cell is counted with. Its change is its flux over this volume: huge, and undone by the averaging.
pub(in crate::flow) fn least_volume<R: Real>() -> R {
    R::EPSILON * R::EPSILON
}

/// Clusters whose members differ in pressure by more than this share, or in velocity by this share of the speed of sound,
/// share one state before the first step: a cell of no volume cannot feed the flux that its own state would drive.
const UNEQUAL: f64 = 0.1;

/// Gives the members of unequal clusters of a starting field their common average.
pub(in crate::flow) fn average_unequal<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    gas: Gas<R>,
    field: &mut FieldsMut<'_, R, D>,
) {
    for cells in clusters.groups() {
        let Some(first) = cells.clone().next() else { continue };
        let gas_of = |field: &FieldsMut<'_, R, D>, cell: usize| field.as_fields().gas_at(gas, cell);
        let own = gas_of(field, first);
        let w = own.primitive(&field.at(first));
        let limit = R::from_f64(UNEQUAL);
        let unequal = cells.clone().any(|cell| {
            let (other_gas, c) = (gas_of(field, cell), own.sound_speed(&w));
            let other = other_gas.primitive(&field.at(cell));
            // Gases that differ at all share one: what they carry into each other would not add up.
            other_gas != own
                || !((other.pressure - w.pressure).abs() <= limit * w.pressure)
                || (0..D).any(|d| !((other.velocity[d] - w.velocity[d]).abs() <= limit * c))
        });
        if !unequal {
            continue;
        }
        let (mut total, mut density, mut energy) = (Sum::new(), Sum::new(), Sum::new());
        let mut momentum = [const { Sum::new() }; D];
        for cell in cells.clone() {
            let v = R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell));
            let u = field.at(cell);
            total.add(v);
            density.add(v * u.density);
            energy.add(v * u.energy);
            for c in 0..D {
                momentum[c].add(v * u.momentum[c]);
            }
        }
        let inv = R::ONE / total.value();
        let mean = Conserved {
            density: density.value() * inv,
            momentum: momentum.map(|m| m.value() * inv),
            energy: energy.value() * inv,
        };
        for cell in cells {
            field.set(cell, &mean);
        }
    }
}

/// Gives each cluster the mean capacity of its open volumes: where the pressure is one, the energy of all has that pressure still.
pub(in crate::flow) fn apply_capacities<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    gas: Gas<R>,
    field: &mut FieldsMut<'_, R, D>,
) {
    for cells in clusters.groups() {
        let Some(first) = cells.clone().next() else { continue };
        if cells.clone().all(|cell| field.capacity[cell] == field.capacity[first]) {
            continue;
        }
        let (mut total, mut sum) = (Sum::new(), Sum::new());
        for cell in cells.clone() {
            let v = R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell));
            total.add(v);
            sum.add(v * field.capacity[cell]);
        }
        // As the energy is divided, so that a pressure of 1 stays 1.
        let mean = gas.settled(sum.value() * (R::ONE / total.value()));
        cells.for_each(|cell| field.capacity[cell] = mean);
    }
}

/// Sums over the cells of a cluster, open volumes included.
struct Totals<R, const D: usize> {
    volume: R,
    /// Before the step, and what the step added.
    content: Conserved<R, D>,
    change: Conserved<R, D>,
    /// The largest size of what it added to one cell.
    largest: Conserved<R, D>,
}

impl<R: Real, const D: usize> Totals<R, D> {
    /// Sums of the `cells`, each of the open volume that `weight` gives. They do not depend on the order of the cells: carried exactly
    /// enough to round alike.
    fn new(
        cells: impl Iterator<Item = usize>,
        weight: impl Fn(usize) -> R,
        old: &Fields<'_, R, D>,
        new: &FieldsMut<'_, R, D>,
    ) -> Self {
        let (mut total, mut content, mut change) = (Sum::new(), [const { Sum::new() }; 2], [const { Sum::new() }; 2]);
        let (mut momentum, mut push) = ([const { Sum::new() }; D], [const { Sum::new() }; D]);
        let mut largest = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        for cell in cells {
            let v = weight(cell);
            let (a, b) = (old.at(cell), new.at(cell));
            total.add(v);
            content[0].add(v * a.density);
            content[1].add(v * a.energy);
            let step = v * (b.density - a.density);
            change[0].add(step);
            largest.density = R::larger(step.abs(), largest.density);
            let step = v * (b.energy - a.energy);
            change[1].add(step);
            largest.energy = R::larger(step.abs(), largest.energy);
            for c in 0..D {
                momentum[c].add(v * a.momentum[c]);
                let step = v * (b.momentum[c] - a.momentum[c]);
                push[c].add(step);
                largest.momentum[c] = R::larger(step.abs(), largest.momentum[c]);
            }
        }
        let whole = |s: [Sum<R>; 2], m: [Sum<R>; D]| Conserved {
            density: s[0].value(),
            momentum: m.map(Sum::value),
            energy: s[1].value(),
        };
        Totals { volume: total.value(), content: whole(content, momentum), change: whole(change, push), largest }
    }

    /// Whether anything changes by more than the share `still` of what there is.
    fn moves(&self, still: R) -> bool {
        let (content, largest) = (&self.content, &self.largest);
        // Momentum is measured against mass times a speed, sqrt(E/rho) or, for a barotropic gas, its own.
        let momentum_scale = (content.density * content.energy).sqrt();
        let momentum_moves = (0..D).any(|c| {
            let scale = R::larger(momentum_scale, content.momentum[c].abs());
            !(largest.momentum[c] <= still * scale)
        });
        !(largest.density <= still * content.density) || !(largest.energy <= still * content.energy) || momentum_moves
    }
}

/// Shares one state over each cluster. `volume` is `beta_v`.
pub(in crate::flow) fn apply<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    old: &Fields<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
) {
    // Changes below this share of the cluster's content count as none.
    let still = R::larger(R::from_f64(1e-12), R::from_f64(64.0) * R::EPSILON);
    let weight = |cell: usize| R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell));
    for cells in clusters.groups() {
        let totals = Totals::new(cells.clone(), weight, old, new);
        let (moves, inv) = (totals.moves(still), R::ONE / totals.volume);
        let Totals { content, change, .. } = totals;
        for cell in cells {
            let a = old.at(cell);
            let base = |own: R, all: R| if moves { all * inv } else { own };
            let mut momentum = [R::ZERO; D];
            for c in 0..D {
                momentum[c] = base(a.momentum[c], content.momentum[c]) + change.momentum[c] * inv;
            }
            new.set(
                cell,
                &Conserved {
                    density: base(a.density, content.density) + change.density * inv,
                    momentum,
                    energy: base(a.energy, content.energy) + change.energy * inv,
                },
            );
        }
    }
}
