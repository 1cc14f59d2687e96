//! Small cells: open faces in front of hardly any open volume.
//!
//! Alone such a cell would force the time step down with its volume. It is merged with its neighbours, transitively, until
//! the cluster has half the volume that its largest open face asks for; after each step the cluster's cells share one state.
//! Where nothing moves a cluster is left alone, so gas at rest keeps its densities.
//!
//! References: M. Berger, A. Giuliani, J. Comput. Phys. 428 (2021) 109820 (state redistribution and its threshold of one half).

use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE};
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas, sum};
use crate::number::real::Real;

/// Marks the last cell of a cluster in the list.
const LAST: u32 = 1 << 31;

/// Clusters of cells that share one state: their cells one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Clusters<'a>(pub &'a [u32]);

/// Length of the scratch that [`clusters`] needs for a number of cells.
pub const fn cluster_scratch(cells: usize) -> usize {
    6 * cells
}

/// How many cells far the room of a cell is looked at: the sum of what is open around it, near cells counting more often. It tells
/// equal neighbours apart without regard to the side they stand on, so that clusters stay small.
const ROOM: usize = 8;

/// Finds the clusters; returns how many entries of `list` they fill.
///
/// `list` and `parent` are one entry per cell (fewer than 2^31), `scratch` as [`cluster_scratch`]. Clusters grow across their
/// largest open face, of equal ones across that to the larger volume, of equal ones towards more room, of equal ones across all:
/// mirrored porosity gives mirrored clusters.
pub fn clusters<R: Real, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    faces: &[&[R]; D],
    periodic: [bool; D],
    list: &mut [u32],
    parent: &mut [u32],
    scratch: &mut [R],
) -> usize {
    let n = mesh.len();
    let medium = Medium { mesh: *mesh, porosity: Porosity { volume, faces: *faces, marks: &[] } };
    let cells = mesh.cells();
    // Every open face of a cell: its axis, what lies behind it, and its open fraction.
    let each_face = |cell: usize, f: &mut dyn FnMut(usize, Option<usize>, R)| {
        let at = mesh.coordinates(cell);
        for d in 0..D {
            let (low, high) = medium.ducts(d, at, periodic[d]).openings(0);
            for (open, up) in [(low, false), (high, true)] {
                if open > R::ZERO {
                    let edge = if up { cells[d] - 1 } else { 0 };
                    let mut next = at;
                    let behind = if at[d] != edge {
                        next[d] = if up { at[d] + 1 } else { at[d] - 1 };
                        Some(next)
                    } else if periodic[d] {
                        next[d] = cells[d] - 1 - edge;
                        Some(next)
                    } else {
                        None
                    };
                    f(d, behind.map(|b| mesh.index(b)), open);
                }
            }
        }
    };
    let whole = |cell: usize| mesh.volume(mesh.coordinates(cell));
    let open_volume = |cell: usize| volume[cell] * whole(cell);

    let (held, rest) = scratch.split_at_mut(n);
    let (wanted, rest) = rest.split_at_mut(n);
    let (best_open, rest) = rest.split_at_mut(n);
    let (best_volume, rest) = rest.split_at_mut(n);
    let (best_room, room) = rest.split_at_mut(n);
    let room = &mut room[..n];
    for (cell, room) in room.iter_mut().enumerate() {
        *room = open_volume(cell);
    }
    for _ in 0..ROOM {
        best_room.copy_from_slice(room);
        for (cell, room) in room.iter_mut().enumerate() {
            let mut beside = [R::ZERO; D];
            each_face(cell, &mut |d, behind, open| beside[d] += open * behind.map_or(R::ZERO, |b| best_room[b]));
            *room += sum::<R, D>(beside);
        }
    }
    for (i, p) in parent[..n].iter_mut().enumerate() {
        *p = i as u32;
    }
    let root = |parent: &[u32], mut i: u32| {
        while parent[i as usize] != i {
            i = parent[i as usize];
        }
        i
    };
    loop {
        // A fixed picture of the clusters, so that the order of the cells does not count.
        let picture = &mut *list;
        held.fill(R::ZERO);
        wanted.fill(R::ZERO);
        best_open.fill(R::ZERO);
        best_volume.fill(-R::ONE);
        best_room.fill(-R::ONE);
        for i in 0..n {
            let r = root(parent, i as u32);
            picture[i] = r;
            let r = r as usize;
            held[r] += open_volume(i);
            let own = whole(i);
            each_face(i, &mut |_, _, open| wanted[r] = R::larger(open * own, wanted[r]));
        }
        let short = |r: usize| held[r] < R::from_f64(SMALL_SHARE) * wanted[r];
        let outside =
            |picture: &[u32], i: usize, behind: Option<usize>| behind.filter(|&b| b != i && picture[b] != picture[i]);
        for i in 0..n {
            let r = picture[i] as usize;
            if short(r) {
                let own = whole(i);
                each_face(i, &mut |_, behind, open| {
                    let open = open * own;
                    if let Some(b) = outside(picture, i, behind) {
                        let this = [open, held[picture[b] as usize], room[b]];
                        if this > [best_open[r], best_volume[r], best_room[r]] {
                            [best_open[r], best_volume[r], best_room[r]] = this;
                        }
                    }
                });
            }
        }
        let mut grown = false;
        for i in 0..n {
            let r = picture[i] as usize;
            if short(r) {
                let own = whole(i);
                each_face(i, &mut |_, behind, open| {
                    let open = open * own;
                    let best = [best_open[r], best_volume[r], best_room[r]];
                    if let Some(b) =
                        outside(picture, i, behind).filter(|&b| [open, held[picture[b] as usize], room[b]] == best)
                    {
                        let (p, q) = (root(parent, i as u32), root(parent, b as u32));
                        let (low, high) = if p < q { (p, q) } else { (q, p) };
                        parent[high as usize] = low;
                        grown = true;
                    }
                });
            }
        }
        if !grown {
            break;
        }
    }
    for i in 0..n {
        parent[i] = root(parent, i as u32);
    }
    // Cells of clusters with company, ordered by cluster.
    held.fill(R::ZERO);
    for i in 0..n {
        held[parent[i] as usize] += R::ONE;
    }
    let mut count = 0;
    for i in 0..n {
        if held[parent[i] as usize] > R::ONE {
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

impl<'a> Clusters<'a> {
    /// One slice of (possibly flagged) entries per cluster.
    fn each(self) -> impl Iterator<Item = &'a [u32]> {
        self.0.split_inclusive(|e| e & LAST != 0)
    }

    /// The cells of each cluster.
    pub fn groups(self) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone + 'a> {
        self.each().map(|cluster| cluster.iter().map(|e| (e & !LAST) as usize))
    }

    /// The cells of all clusters.
    pub(crate) fn cells(self) -> impl Iterator<Item = usize> + 'a {
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
pub(crate) fn least_volume<R: Real>() -> R {
    R::EPSILON * R::EPSILON
}

/// Clusters whose members differ in pressure by more than this share, or in velocity by this share of the speed of sound,
/// share one state before the first step: a cell of no volume cannot feed the flux that its own state would drive.
const UNEQUAL: f64 = 0.1;

/// Gives the members of unequal clusters of a starting field their common average.
pub(crate) fn settle<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    gas: Gas<R>,
    field: &mut FieldsMut<'_, R, D>,
) {
    for cells in clusters.groups() {
        let Some(first) = cells.clone().next() else { continue };
        let w = gas.primitive(&field.get(first));
        let limit = R::from_f64(UNEQUAL);
        let unequal = cells.clone().any(|cell| {
            let other = gas.primitive(&field.get(cell));
            let c = gas.sound_speed(&w);
            !((other.pressure - w.pressure).abs() <= limit * w.pressure)
                || (0..D).any(|d| !((other.velocity[d] - w.velocity[d]).abs() <= limit * c))
        });
        if !unequal {
            continue;
        }
        let (mut total, mut density, mut energy) = (Sum::new(), Sum::new(), Sum::new());
        let mut momentum = [const { Sum::new() }; D];
        for cell in cells.clone() {
            let v = R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell));
            let u = field.get(cell);
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

/// Shares one state over each cluster. `volume` is `beta_v`.
pub(crate) fn apply<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    old: &Fields<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
) {
    // Changes below this share of the cluster's content count as none.
    let still = R::larger(R::from_f64(1e-12), R::from_f64(64.0) * R::EPSILON);
    let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
    for cluster in clusters.each() {
        let cells = || cluster.iter().map(|e| (e & !LAST) as usize);
        let weight = |cell: usize| R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell));
        // Sums over the members that do not depend on their order: carried exactly enough to round alike.
        let (mut total, mut content, mut change) = (Sum::new(), [const { Sum::new() }; 2], [const { Sum::new() }; 2]);
        let (mut momentum, mut push) = ([const { Sum::new() }; D], [const { Sum::new() }; D]);
        let mut largest = zero;
        for cell in cells() {
            let v = weight(cell);
            let (a, b) = (old.get(cell), new.get(cell));
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
        let total = total.value();
        let whole = |s: [Sum<R>; 2], m: [Sum<R>; D]| Conserved {
            density: s[0].value(),
            momentum: m.map(Sum::value),
            energy: s[1].value(),
        };
        let (content, change) = (whole(content, momentum), whole(change, push));
        let inv = R::ONE / total;
        // Momentum is measured against mass times a speed, sqrt(E/rho) or, for a barotropic gas, its own.
        let momentum_scale = (content.density * content.energy).sqrt();
        let momentum_moves = (0..D).any(|c| {
            let scale = R::larger(momentum_scale, content.momentum[c].abs());
            !(largest.momentum[c] <= still * scale)
        });
        let moves = !(largest.density <= still * content.density)
            || !(largest.energy <= still * content.energy)
            || momentum_moves;
        for cell in cells() {
            let a = old.get(cell);
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
