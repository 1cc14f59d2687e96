//! What stands in the way of gas of pipe bends: shadows against lines and their own parts, faces by throat, areas of pipe lines.

use super::torus_points::inside;
use glam::{DVec3, Vec3Swizzles};
use std::f64::consts::PI;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::shadows::{cells, faces_of_cell};
use voidage::porosity::{Options, Porosity, porosity, throat};
use voidage_core::convex::shape::{Cone, Cylinder};
use voidage_core::solids::torus::TorusShape;
use voidage_tests::effort::some;
use voidage_tests::fields::assert_close;
use voidage_tests::solids::formulas;

fn found(edges: &Edges, forms: &[Form]) -> (Porosity, Resistance) {
    let (grid, options) = (edges.grid(None).expect("a grid"), Options { resistance: true, ..Options::default() });
    let bodies = formulas(forms);
    let result = porosity(&grid, &bodies, options);
    let resistance = resistance(&grid, &bodies, &result, options);
    (result, resistance)
}

fn even(from: f64, step: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|n| from + step * n as f64).collect()
}

/// Bends of several angles, starts and axes about the origin, the elbow of the finding first.
fn bends() -> Vec<TorusShape<DVec3>> {
    let bend = |axis, start, angle, tube| TorusShape { center: DVec3::ZERO, axis, start, radius: 0.5, tube, angle };
    let mut all = Vec::new();
    for (axis, start) in [(DVec3::Z, DVec3::X), (DVec3::X, DVec3::Z), (-DVec3::Y, DVec3::X), (DVec3::Z, -DVec3::Y)] {
        all.push(bend(axis, start, 90.0, 0.2));
        all.push(bend(axis, start, 180.0, 0.1));
    }
    all.push(bend(DVec3::new(0.3, -0.5, 0.8), DVec3::X, 45.0, 0.2));
    all.push(bend(DVec3::new(0.0, 1.0, 1.0), DVec3::new(1.0, 1.0, 1.0), 270.0, 0.15));
    all.push(bend(DVec3::new(1.0, -2.0, 0.5), DVec3::Z, 330.0, 0.3));
    all
}

/// The share of the lines along an axis through a box that have a point in a bend.
fn met(bend: &TorusShape<DVec3>, lo: DVec3, hi: DVec3, axis: usize) -> f64 {
    const LINES: usize = 50;
    let (iu, iv) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut count = 0;
    for line in 0..LINES * LINES {
        let mut part = DVec3::ZERO;
        part[iu] = ((line % LINES) as f64 + 0.5) / LINES as f64;
        part[iv] = ((line / LINES) as f64 + 0.5) / LINES as f64;
        count += usize::from((0..60).any(|n| {
            part[axis] = (f64::from(n) + 0.5) / 60.0;
            inside(bend, lo + (hi - lo) * part)
        }));
    }
    count as f64 / (LINES * LINES) as f64
}

#[test]
fn shadows_and_throats_of_bends_agree_with_lines() {
    for bend in some(&bends()) {
        let axis = even(-0.97, 0.4, 5);
        let edges = Edges([axis.clone(), axis.clone(), axis]);
        let grid = edges.grid(None).expect("a grid");
        let (mut result, found) = found(&edges, &[Form::Torus(bend)]);
        let plane = result.clone();
        throat::lower(&grid, &mut result, &found.shadows);
        let all: Vec<[usize; 3]> = cells(&grid).collect();
        let mut several = 0;
        for axis in 0..3 {
            let mut passed = vec![1.0_f64; [&plane.beta.x, &plane.beta.y, &plane.beta.z][axis].len()];
            for (n, at) in all.iter().enumerate() {
                let cell = grid.cell_box(*at).expect("a cell");
                let tau = found.shadows.tau[axis][n];
                let cut = plane.beta.v[n] > 0.0 && plane.beta.v[n] < 1.0;
                let truth = if cut { met(&bend, cell.min, cell.max, axis) } else { 1.0 - plane.beta.v[n] };
                if cut {
                    assert!((tau - truth).abs() < 0.03, "{bend:?} at {at:?} along {axis}: {tau}, by lines {truth}");
                }
                several += usize::from(tau > 0.05 && tau < 0.95);
                for face in faces_of_cell(&grid, axis, *at) {
                    passed[face] = passed[face].min(1.0 - truth);
                }
            }
            let [before, now] = [&plane, &result].map(|r| [&r.beta.x, &r.beta.y, &r.beta.z][axis]);
            for ((now, before), passed) in now.iter().zip(before).zip(passed) {
                let most = before.min(passed);
                assert!(
                    *now <= *before && *now > most - 0.03,
                    "{bend:?} along {axis}: {now}, {before} before, {passed}"
                );
            }
        }
        assert!(several > 10, "{several}");
    }
}

/// The shadow of a cell is the mean of those of its parts across the axis.
#[test]
fn shadows_of_bends_are_the_means_of_their_parts() {
    for bend in some(&bends()) {
        let (coarse, fine) = (even(-0.97, 0.4, 5), even(-0.97, 0.2, 10));
        let (_, whole) = found(&Edges([coarse.clone(), coarse.clone(), coarse.clone()]), &[Form::Torus(bend)]);
        for axis in 0..3 {
            let mut edges = [fine.clone(), fine.clone(), fine.clone()];
            edges[axis] = coarse.clone();
            let (_, parts) = found(&Edges(edges), &[Form::Torus(bend)]);
            let counts = [0, 1, 2].map(|n| if n == axis { 5 } else { 10 });
            let mut means = vec![0.0; 125];
            for (n, tau) in parts.shadows.tau[axis].iter().enumerate() {
                let at = [n % counts[0], n / counts[0] % counts[1], n / counts[0] / counts[1]];
                let [i, j, k] = [0, 1, 2].map(|m| if m == axis { at[m] } else { at[m] / 2 });
                means[i + 5 * (j + 5 * k)] += tau * 0.25;
            }
            for (n, (mean, tau)) in means.iter().zip(&whole.shadows.tau[axis]).enumerate() {
                assert!((mean - tau).abs() < 3e-3, "{bend:?} cell {n} along {axis}: {tau}, of parts {mean}");
            }
        }
    }
}

/// Pipe, elbow, pipe with joints in planes of the grid: the discs of the joints cancel, whatever the spacing and the place.
#[test]
fn joints_in_planes_of_the_grid_are_not_wetted() {
    let (radius, tube, length) = (0.5, 0.2, 0.8);
    let wetted = 2.0 * PI * tube * (2.0 * length + radius * PI / 2.0) + 2.0 * PI * tube * tube;
    for (corner, turned) in [(DVec3::ZERO, false), (DVec3::new(0.2, -0.4, 0.6), false), (DVec3::ZERO, true)] {
        for spacing in [0.2, 0.1] {
            let turn = |v: DVec3| if turned { DVec3::new(v.z, v.x, v.y) } else { v };
            let at = |x: f64, y: f64| corner + turn(DVec3::new(x, y, 0.0));
            let (axis, start) = (turn(DVec3::Z), turn(DVec3::X));
            let bend = TorusShape { center: corner, axis, start, radius, tube, angle: 90.0 };
            let forms = [
                Form::Cylinder(Cylinder::new(at(radius, -length), at(radius, 0.0), tube)),
                Form::Torus(bend),
                Form::Cylinder(Cylinder::new(at(0.0, radius), at(-length, radius), tube)),
            ];
            let count = (2.4 / spacing + 0.5) as usize;
            let edges = Edges([0, 1, 2].map(|n| even(corner[n] - 1.2, spacing, count)));
            let (_, found) = found(&edges, &forms);
            let total = found.totals.wetted_area;
            assert!((total / wetted - 1.0).abs() < 3e-3, "{corner:?} {turned} {spacing}: {total}, not {wetted}");
            let side = 2.0 * tube * (length + radius);
            let lengthwise = found.totals.frontal_area[if turned { 0 } else { 2 }];
            assert!(lengthwise > side && lengthwise < 2.0 * side, "{lengthwise}");
        }
    }
}

/// Edges as a program adds them up: planes miss the ends of pipes, cones and bends by rounding, to either side.
#[test]
fn ends_that_miss_planes_by_rounding_lie_in_them() {
    let exact = Edges::cube(-1.5, 1.5, 20);
    let off = even(-1.5, 0.15, 20);
    assert!(off != exact.0[0], "the same planes");
    let off = Edges([off.clone(), off.clone(), off]);
    let at = |n: i32| 0.15 * f64::from(n);
    let mut forms = Vec::new();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let aside = DVec3::new(0.02, 0.03, 0.04) * (DVec3::ONE - axis);
        for (from, to) in [(1, 3), (-1, 3), (-7, -3)] {
            let [from, to] = [from, to].map(|n| axis * at(n) + aside);
            forms.push(Form::Cylinder(Cylinder::new(from, to, 0.2)));
            forms.push(Form::Cone(Cone::truncated(from, to, 0.2, 0.1)));
        }
        for (start, angle) in [(axis.yzx(), 90.0), (axis.yzx(), 270.0), (axis.zxy(), 242.0), (axis.zxy(), 180.0)] {
            for (radius, tube) in [(0.15, 0.075), (0.6, 0.55), (0.5, 0.18)] {
                forms.push(Form::Torus(TorusShape { center: DVec3::splat(at(1)), axis, start, radius, tube, angle }));
            }
        }
    }
    for form in forms {
        let [one, other] = [&exact, &off].map(|edges| {
            let found = porosity(
                &edges.grid(None).expect("a grid"),
                &formulas(std::slice::from_ref(&form)),
                Options::default(),
            );
            assert!(found.max_gap < 5e-9, "{form:?}: gap {}", found.max_gap);
            found
        });
        assert_close(&one.beta, &other.beta, 1e-9, &format!("{form:?}"));
    }
}
