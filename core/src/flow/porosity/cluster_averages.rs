//! One state for the cells of a cluster: averages by open volumes, of the starting field and after each step.

use crate::flow::porosity::clusters::Clusters;
use crate::flow::porosity::fractions::{Mesh, least_volume};
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas};
use crate::number::real::Real;

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

/// The open volume of a cell, as it counts in sums. `volume` is `beta_v`.
fn open_volumes<R: Real, const D: usize>(mesh: &Mesh<'_, R, D>, volume: &[R]) -> impl Fn(usize) -> R {
    |cell| R::larger(volume[cell], least_volume()) * mesh.volume(mesh.coordinates(cell))
}

/// The sum of what `of` gives for the cells, times their weights.
fn weighted<R: Real>(cells: impl Iterator<Item = usize>, weight: impl Fn(usize) -> R, of: impl Fn(usize) -> R) -> R {
    let mut sum = Sum::new();
    cells.for_each(|cell| sum.add(weight(cell) * of(cell)));
    sum.value()
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
    let weight = open_volumes(mesh, volume);
    for cells in clusters.groups() {
        if !are_unequal(cells.clone(), gas, &field.as_fields()) {
            continue;
        }
        let sum = |of: &dyn Fn(&Conserved<R, D>) -> R| weighted(cells.clone(), &weight, |cell| of(&field.at(cell)));
        let inv = R::ONE / weighted(cells.clone(), &weight, |_| R::ONE);
        let mean = Conserved {
            density: sum(&|u| u.density) * inv,
            momentum: core::array::from_fn(|c| sum(&|u| u.momentum[c]) * inv),
            energy: sum(&|u| u.energy) * inv,
        };
        for cell in cells {
            field.set(cell, &mean);
        }
    }
}

/// Do some cells differ by more than [`UNEQUAL`]? The same in any order of the cells: the ends of what they have are compared.
fn are_unequal<R: Real, const D: usize>(
    mut cells: impl Iterator<Item = usize>,
    gas: Gas<R>,
    field: &Fields<'_, R, D>,
) -> bool {
    let limit = R::from_f64(UNEQUAL);
    let Some(first) = cells.next() else { return false };
    let own = field.gas_at(gas, first);
    let w = own.primitive(&field.at(first));
    let mut sound = own.sound_speed(&w);
    let (mut pressures, mut velocities) = ([w.pressure; 2], w.velocity.map(|u| [u; 2]));
    let widen = |ends: &mut [R; 2], x: R| *ends = [R::smaller(x, ends[0]), R::larger(x, ends[1])];
    for cell in cells {
        let other = field.gas_at(gas, cell);
        // Gases that differ at all share one: what they carry into each other would not add up.
        if other != own {
            return true;
        }
        let w = other.primitive(&field.at(cell));
        widen(&mut pressures, w.pressure);
        velocities.iter_mut().zip(w.velocity).for_each(|(ends, u)| widen(ends, u));
        sound = R::smaller(other.sound_speed(&w), sound);
    }
    let apart = |[low, high]: [R; 2], most: R| !(high - low <= limit * most);
    apart(pressures, pressures[1]) || velocities.iter().any(|&ends| apart(ends, sound))
}

/// Gives each cluster the mean capacity of its open volumes: where the pressure is one, the energy of all has that pressure still.
pub(in crate::flow) fn apply_capacities<R: Real, const D: usize>(
    clusters: Clusters<'_>,
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    gas: Gas<R>,
    field: &mut FieldsMut<'_, R, D>,
) {
    let weight = open_volumes(mesh, volume);
    for cells in clusters.groups() {
        let Some(first) = cells.clone().next() else { continue };
        if cells.clone().all(|cell| field.capacity[cell] == field.capacity[first]) {
            continue;
        }
        let sum = weighted(cells.clone(), &weight, |cell| field.capacity[cell]);
        // As the energy is divided, so that a pressure of 1 stays 1.
        let mean = gas.within_bounds(sum * (R::ONE / weighted(cells.clone(), &weight, |_| R::ONE)));
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
    fn moves(&self, still: R, gas: Gas<R>) -> bool {
        let (content, largest) = (&self.content, &self.largest);
        // Momentum is measured against mass times a speed: sqrt(E/rho) or, for a barotropic gas, that of sound.
        let momentum_scale = if gas.has_energy() {
            (content.density * content.energy).sqrt()
        } else {
            let density = content.density / self.volume;
            let mean = Conserved { density, momentum: [R::ZERO; D], energy: R::ZERO };
            content.density * gas.sound_speed(&gas.primitive(&mean))
        };
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
    gas: Gas<R>,
    old: &Fields<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
) {
    // Changes below this share of the cluster's content count as none.
    let still = R::larger(R::from_f64(1e-12), R::from_f64(64.0) * R::EPSILON);
    let weight = open_volumes(mesh, volume);
    for cells in clusters.groups() {
        let totals = Totals::new(cells.clone(), &weight, old, new);
        let (moves, inv) = (totals.moves(still, gas), R::ONE / totals.volume);
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
