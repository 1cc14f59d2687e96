//! Where a row of cells breaks: walls (closed faces) and porosity jumps. Slopes beside them, and the fluxes there.
//!
//! A wall is treated as a `wall` boundary of the domain is, to the bit: the gas beside it meets its mirror image, in the slopes
//! and in the Riemann problem. Without the mirror the velocity at the wall would be that of the cell's middle, and a slow flow
//! would stagnate at a pressure wrong by rho c u. At a jump both cells are flat along the axis and the throat map acts.

use crate::flow::boundary::Boundary;
use crate::flow::kernel::rows::{self, Differences, Three, var};
use crate::flow::kernel::sweep::{Row, Sweep};
use crate::flow::limiter::{Slope, wall_slope};
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::flags::{break_high, break_low, marked};
use crate::flow::porosity::fractions::Medium;
use crate::flow::porosity::jump::{JumpFaces, jump_fluxes};
use crate::flow::riemann::Solver;
use crate::flow::state::Primitive;
use crate::flow::step::PressureForm;
use crate::number::real::Real;

/// Jump faces done side by side.
const LANES: usize = 4;

/// Variables of a state in three dimensions.
const MOST: usize = 5;

/// Differences along an axis for a single cell, without gravity towards its mirror images.
struct Single<R> {
    scale: (R, R),
    half_weight: Option<(R, R)>,
}

impl<R: Real> Differences<R> for Single<R> {
    fn scale(&self, _: usize) -> (R, R) {
        self.scale
    }

    fn half_weight(&self, _: usize) -> Option<(R, R)> {
        self.half_weight
    }
}

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// Slopes along axis `d` of the cells of a row beside breaks, in place of those that looked across: mirrored at walls, none
    /// at jumps. `values` gives a variable in the cells below, here and above.
    pub(in crate::flow) fn slopes_at_breaks<'a, S: Slope>(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        row: Row<D>,
        values: impl Fn(usize) -> Three<'a, R>,
        axis: &impl Differences<R>,
        compliance: Option<&[R]>,
        out: &mut [R],
    ) {
        let n = self.size.n;
        let marks = &medium.porosity.marks[row.start..][..n];
        let ducts = medium.ducts(d, row.at, self.periodic[d]);
        for i in marked(marks, break_low(d) | break_high(d)) {
            let (low, high) = ducts.openings(i);
            let breaks = [ducts.breaks(i, false), ducts.breaks(i, true)];
            if (breaks[0] & (low > R::ZERO)) | (breaks[1] & (high > R::ZERO)) {
                (0..Self::V).for_each(|v| out[v * n + i] = R::ZERO);
                continue;
            }
            let mut three = [[R::ZERO; 3]; MOST];
            for (v, three) in three[..Self::V].iter_mut().enumerate() {
                let (below, here, above) = values(v);
                let image = if v == 1 + d { -here[i] } else { here[i] };
                *three = [if breaks[0] { image } else { below[i] }, here[i], if breaks[1] { image } else { above[i] }];
            }
            let image = |breaks: bool, own: R, mirrored: R| if breaks { mirrored } else { own };
            let ((a, b), weights) = (axis.scale(i), axis.half_weight(i));
            let single = Single {
                scale: (image(breaks[0], a, R::ONE), image(breaks[1], b, R::ONE)),
                half_weight: weights.map(|(a, b)| (image(breaks[0], a, R::ZERO), image(breaks[1], b, R::ZERO))),
            };
            let mut slope = [R::ZERO; MOST];
            let of = |v: usize| (&three[v][..1], &three[v][1..2], &three[v][2..]);
            rows::slopes::<R, S, D>(of, &single, compliance.map(|c| &c[i..=i]), &mut slope, 1);
            slope[1 + d] = match breaks {
                [true, true] => R::ZERO,
                [low, _] => {
                    let (here, away) = (three[1 + d], if low { single.scale.1 } else { single.scale.0 });
                    let [below, here, above] = here;
                    wall_slope(here, away * if low { above - here } else { here - below }, !low)
                }
            };
            (0..Self::V).for_each(|v| out[v * n + i] = slope[v]);
        }
    }

    /// Slopes of the velocity along `d` in the cells of a row beside a `wall` boundary of that axis.
    pub(in crate::flow) fn slopes_at_boundaries<'a>(
        &self,
        d: usize,
        row: Row<D>,
        (below, here, above): Three<'a, R>,
        axis: &impl Differences<R>,
        out: &mut [R],
    ) {
        let n = self.size.n;
        let cells = self.problem.mesh.cells()[d];
        let walls = self.problem.boundaries[d].map(|b| b == Boundary::Wall);
        let out = &mut out[(1 + d) * n..][..n];
        let beside = |side: usize| if side == 0 { 0 } else { cells - 1 };
        for side in [0, 1] {
            let range = match (d, walls[side]) {
                (_, false) => 0..0,
                (0, _) => beside(side)..beside(side) + 1,
                _ if row.at[d] == beside(side) => 0..n,
                _ => 0..0,
            };
            for i in range {
                let (a, b) = axis.scale(i);
                let away = if side == 0 { b * (above[i] - here[i]) } else { a * (here[i] - below[i]) };
                let alone = cells == 1 && walls == [true; 2];
                out[i] = if alone { R::ZERO } else { wall_slope(here[i], away, side == 1) };
            }
        }
    }

    /// Replaces the fluxes at the broken faces of a row, by their places; `at` names the first of the `m` faces.
    pub(in crate::flow) fn fluxes_at_breaks<S: Solver>(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        at: [usize; D],
        broken: impl Iterator<Item = usize>,
        states: [&[R]; 2],
        flux: &mut [R],
        m: usize,
    ) {
        let ducts = medium.ducts(d, at, self.periodic[d]);
        let beside = |i: usize| {
            let mut face = at;
            face[0] = i;
            medium.beside(d, face, self.periodic[d])
        };
        let mut group = [0; LANES];
        let mut count = 0;
        for i in broken {
            if !(ducts.face(i) > R::ZERO) {
                self.wall_flux::<S>(medium, d, beside(i), states, flux, m, i);
                continue;
            }
            group[count] = i;
            count += 1;
            if count == LANES {
                self.flux_group::<S>(&ducts, &group, count, beside, states, flux, m);
                count = 0;
            }
        }
        if count > 0 {
            // A last group of fewer faces repeats its first one.
            let first = group[0];
            group[count..].fill(first);
            self.flux_group::<S>(&ducts, &group, count, beside, states, flux, m);
        }
    }

    /// Fluxes at the first `count` jump faces of a group.
    fn flux_group<S: Solver>(
        &self,
        ducts: &Ducts<'_, R>,
        group: &[usize; LANES],
        count: usize,
        beside: impl Fn(usize) -> [Option<[usize; D]>; 2],
        states: [&[R]; 2],
        flux: &mut [R],
        m: usize,
    ) {
        let gather = |s: usize, v: usize| {
            let values = var(states[s], v, m);
            core::array::from_fn(|l| values[group[l]])
        };
        let side = |s: usize| Primitive {
            density: gather(s, 0),
            velocity: core::array::from_fn(|c| gather(s, 1 + c)),
            pressure: gather(s, D + 1),
        };
        let (mut face, mut areas) = ([R::ZERO; LANES], [[R::ZERO; LANES]; 2]);
        for l in 0..LANES {
            face[l] = ducts.face(group[l]);
            (areas[0][l], areas[1][l]) = ducts.beside(group[l], false);
        }
        let mut calm = [R::ONE; LANES];
        if let Some(asked) = self.first_order {
            let troubled = |i: usize| beside(i).iter().flatten().any(|&c| asked[self.problem.mesh.index(c)] != 0);
            calm = group.map(|i| if troubled(i) { R::ZERO } else { R::ONE });
        }
        let faces = JumpFaces {
            states: [side(0), side(1)],
            ducts: areas,
            face,
            references: [gather(0, D + 2), gather(1, D + 2)],
            calm,
        };
        let f = jump_fluxes::<R, S, D, LANES>(&faces, &self.face_gas, &self.throat);
        let mut scatter = |v: usize, from: &[R; LANES]| {
            let to = &mut flux[v * m..][..m];
            for (value, &i) in from.iter().zip(&group[..count]) {
                to[i] = *value;
            }
        };
        scatter(0, &f.mass);
        scatter(1, &f.normal[0]);
        for c in 1..D {
            scatter(1 + c, &f.momentum[c]);
        }
        scatter(D + 1, &f.energy);
        scatter(D + 2, &f.normal[1]);
    }

    /// Flux at the closed face `i` of a row, between the cells `beside` it: nothing passes, and each side is pushed by its mirror
    /// image.
    fn wall_flux<S: Solver>(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        beside: [Option<[usize; D]>; 2],
        states: [&[R]; 2],
        out: &mut [R],
        m: usize,
        i: usize,
    ) {
        let push = |side: usize| {
            let area = beside[side].map_or(R::ZERO, |cell| match self.problem.scheme.pressure {
                PressureForm::Geometric => medium.ducts(d, cell, self.periodic[d]).wall(0),
                PressureForm::Paper => medium.porosity.volume[medium.mesh.index(cell)],
            });
            if !(area > R::ZERO) {
                return R::ZERO;
            }
            let w = rows::face_state(states[side], m, i);
            let image = Boundary::Wall.ghost(&w, d, side == 1, self.problem.gas);
            let pair: [&Primitive<R, D>; 2] = if side == 0 { [&w, &image] } else { [&image, &w] };
            let f = S::flux::<R, D, false>(pair[0], pair[1], &self.face_gas);
            area * (f.momentum[0] - states[side][(D + 2) * m + i])
        };
        for v in 0..D + 2 {
            out[v * m + i] = R::ZERO;
        }
        out[m + i] = push(0);
        out[(D + 2) * m + i] = push(1);
    }
}
