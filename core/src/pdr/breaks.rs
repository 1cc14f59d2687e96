//! Where a row of cells breaks: walls (closed faces) and porosity jumps. Slopes beside them, and the fluxes there.
//!
//! A wall is treated as a `wall` boundary of the domain is, to the bit: the gas beside it meets its mirror image, in the slopes
//! and in the Riemann problem. Without the mirror the velocity at the wall would be that of the cell's middle, and a slow flow
//! would stagnate at a pressure wrong by rho c u. At a jump both cells are flat along the axis and the throat map acts.

use super::boundary::Boundary;
use super::flux::flux;
use super::limiter::{Slope, wall_slope};
use super::medium::{BREAKS, Medium, break_high, break_low};
use super::row::{self, Differences, Three};
use super::state::Primitive;
use super::step::PressureForm;
use super::sweep::{Row, Sweep};
use super::throat::{JumpFace, jump_fluxes};
use crate::real::Real;

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
    pub(super) fn slopes_at_breaks<'a, S: Slope>(
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
        let bits = break_low(d) | break_high(d);
        if marks.iter().fold(0, |a, b| a | b) & bits == 0 {
            return;
        }
        for i in (0..n).filter(|&i| marks[i] & bits != 0) {
            let mut at = row.at;
            at[0] = i;
            let (low, high) = medium.openings(d, at);
            let breaks = [marks[i] & break_low(d) != 0, marks[i] & break_high(d) != 0];
            if (breaks[0] && low > R::ZERO) || (breaks[1] && high > R::ZERO) {
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
            row::slopes::<R, S, D>(of, &single, compliance.map(|c| &c[i..=i]), &mut slope, 1);
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
    pub(super) fn slopes_at_boundaries<'a>(
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

    /// Replaces the fluxes at the broken faces of a row. `broken` tells which of the `m` faces are; `at` names the first.
    pub(super) fn fluxes_at_breaks(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        at: [usize; D],
        broken: impl Fn(usize) -> bool,
        (left, right): (&[R], &[R]),
        flux: &mut [R],
        m: usize,
    ) {
        /// Jump faces done side by side.
        const LANES: usize = 8;
        let name = |i: usize| {
            let mut face = at;
            face[0] = i;
            face
        };
        let open = |i: usize| medium.porosity.faces[d][medium.mesh.face(d, name(i))];
        let face_at = |i: usize| {
            let (area_l, area_r) = medium.ducts(d, name(i), self.periodic[d]);
            JumpFace::<R, D> {
                states: [row::face_state(left, m, i), row::face_state(right, m, i)],
                ducts: [area_l, area_r],
                face: open(i),
                references: [left[(D + 2) * m + i], right[(D + 2) * m + i]],
                troubled: self.first_order.is_some_and(|asked| {
                    let beside = medium.beside(d, name(i), self.periodic[d]);
                    beside.iter().flatten().any(|&cell| asked[medium.mesh.index(cell)] != 0)
                }),
            }
        };
        for i in (0..m).filter(|&i| broken(i) && !(open(i) > R::ZERO)) {
            self.wall_flux(medium, d, name(i), &face_at(i), flux, m, i);
        }
        let mut flagged = (0..m).filter(|&i| broken(i) && open(i) > R::ZERO);
        while let Some(first) = flagged.next() {
            // A last group of fewer faces repeats its first one.
            let mut group = [first; LANES];
            let mut count = 1;
            for (place, i) in group[1..].iter_mut().zip(&mut flagged) {
                *place = i;
                count += 1;
            }
            let mut faces = [face_at(first); LANES];
            for (face, &i) in faces.iter_mut().zip(&group[..count]) {
                *face = face_at(i);
            }
            let fluxes = jump_fluxes(self.problem.scheme.riemann, &faces, &self.face_gas, &self.throat);
            for (f, &i) in fluxes.iter().zip(&group[..count]) {
                flux[i] = f.through.mass;
                flux[m + i] = f.left;
                for c in 1..D {
                    flux[(1 + c) * m + i] = f.through.momentum[c];
                }
                flux[(D + 1) * m + i] = f.through.energy;
                flux[(D + 2) * m + i] = f.right;
            }
        }
    }

    /// Flux at the closed face `i` of a row, which `at` names: nothing passes, and each side is pushed by its mirror image.
    fn wall_flux(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        at: [usize; D],
        face: &JumpFace<R, D>,
        out: &mut [R],
        m: usize,
        i: usize,
    ) {
        let beside = medium.beside(d, at, self.periodic[d]);
        let push = |side: usize| {
            let area = beside[side].map_or(R::ZERO, |cell| match self.problem.scheme.pressure {
                PressureForm::Geometric => medium.wall(d, cell),
                PressureForm::Paper => medium.porosity.volume[medium.mesh.index(cell)],
            });
            if !(area > R::ZERO) {
                return R::ZERO;
            }
            let w = face.states[side];
            let image = Boundary::Wall.ghost(&w, d, side == 1, self.problem.gas);
            let pair: [&Primitive<R, D>; 2] = if side == 0 { [&w, &image] } else { [&image, &w] };
            let f = flux(self.problem.scheme.riemann, pair[0], pair[1], &self.face_gas);
            area * (f.momentum[0] - face.references[side])
        };
        for v in 0..D + 2 {
            out[v * m + i] = R::ZERO;
        }
        out[m + i] = push(0);
        out[(D + 2) * m + i] = push(1);
    }
}

/// Whether any face of any of these cells breaks.
pub(super) fn any_breaks(marks: &[u8]) -> bool {
    marks.iter().fold(0, |a, b| a | b) & BREAKS != 0
}
