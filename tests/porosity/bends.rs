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

/// A bend flush with a pipe whose axis misses one of the grid by rounding, as programs write it, is the bend without that: its end lies in the plane.
#[test]
fn bends_that_miss_an_axis_by_rounding_end_in_planes() {
    let edges = Edges([even(-1.5, 0.6, 5), even(-1.5, 0.5, 6), even(-1.5, 3.0 / 7.0, 7)]);
    let run = |axis: DVec3, start: DVec3, angle: f64, pipe: [DVec3; 2], moved: DVec3| {
        let bend = TorusShape { center: moved, axis, start, radius: 0.4, tube: 0.25, angle };
        let pipe = Cylinder::new(pipe[0], pipe[1], 0.25);
        let (grid, options) = (edges.grid(None).expect("a grid"), Options { bounds: true, ..Options::default() });
        porosity(&grid, &formulas(&[Form::Torus(bend), Form::Cylinder(pipe)]), options)
    };
    for (angle, pipe) in [
        (180.0, [DVec3::new(0.0, 0.0, -0.4), DVec3::new(0.0, 0.5, -0.4)]),
        (90.0, [DVec3::new(0.0, -0.4, 0.0), DVec3::new(0.0, -0.4, -0.5)]),
    ] {
        let exact = run(DVec3::X, DVec3::Z, angle, pipe, DVec3::ZERO);
        let whole = PI * 0.25 * 0.25 * (0.4 * f64::to_radians(angle) + 0.5);
        assert!((exact.solid_volume - whole).abs() < 1e-9, "{angle}: {}", exact.solid_volume);
        for (tilt, turn) in [(1.1e-15, 0.0), (-7e-16, 2e-16), (3e-16, -1.5e-16)] {
            let (axis, start) = (DVec3::new(1.0, -tilt, 1.7e-17), DVec3::new(-1.7e-17, turn, 1.0));
            let found = run(axis, start, angle, pipe, DVec3::new(0.0, turn, -turn));
            assert!(found.max_gap <= 1e-4, "{angle}, {tilt:e}: {:e}", found.max_gap);
            assert!((found.solid_volume - whole).abs() < 1e-9, "{angle}, {tilt:e}: {}", found.solid_volume);
            assert_close(&found.beta, &exact.beta, 1e-4, "beside the bend on an axis");
        }
    }
}

/// Of a disc that is much wider than thick the ends miss an axis of the grid by more than its axis does.
#[test]
fn thin_discs_askew_are_not_straightened() {
    let (thick, tilt) = (1e-8, 1e-5);
    let half = DVec3::new(1.0, tilt, 0.0).normalize() * (0.5 * thick);
    let edges = Edges([vec![-2.0, -tilt / 4.0, tilt / 3.0, 2.0], vec![-2.0, 0.0, 2.0], vec![-2.0, 2.0]]);
    let disc = formulas(&[Form::Cylinder(Cylinder::new(-half, half, 1.0))]);
    let found = porosity(&edges.grid(None).expect("a grid"), &disc, Options { bounds: true, ..Options::default() });
    // A plane x = c cuts it in the strip |y + c / tilt| < thick / (2 tilt) of the disc, all of which lies on one side of y = 0.
    for (plane, c) in [(1, -tilt / 4.0), (2, tilt / 3.0)] {
        let (y, width) = (-c / tilt, thick / tilt * (1.0 + tilt * tilt).sqrt());
        let strip = 2.0 * (1.0 - y * y).sqrt() * width;
        let faces = [0, 1].map(|row| found.beta.x[4 * row + plane]);
        let expected = if y < 0.0 { [1.0 - strip / 8.0, 1.0] } else { [1.0, 1.0 - strip / 8.0] };
        let miss = (faces[0] - expected[0]).abs().max((faces[1] - expected[1]).abs());
        assert!(miss < 1e-9, "{plane}: {faces:?}, {expected:?}");
    }
}

/// Far from the origin an axis cannot be told better than by rounding: a flange there is as straight as its pipe, and blocks the plane that it ends in.
#[test]
fn thin_discs_far_from_the_origin_are_straight() {
    let corner = DVec3::new(5e5, 5.8e6, 64.0);
    let edges = Edges([0, 1, 2].map(|axis| (0..=4).map(|n| corner[axis] + 0.5 * f64::from(n)).collect()));
    let run = |miss: f64| {
        let from = corner + DVec3::new(1.0, 0.98, 1.1);
        let to = DVec3::new(from.x + miss, corner.y + 1.0, from.z);
        let flange = formulas(&[Form::Cylinder(Cylinder::new(from, to, 0.3))]);
        porosity(&edges.grid(None).expect("a grid"), &flange, Options { bounds: true, ..Options::default() })
    };
    let (straight, blocked) = (run(0.0), |found: &Porosity| found.beta.y.iter().map(|b| 1.0 - b).sum::<f64>());
    // The plane of its end, faces of 0.25 m².
    assert!((0.25 * blocked(&straight) - PI * 0.09).abs() < 1e-8, "{}", blocked(&straight));
    for miss in [6e-11, -6e-11, 1.2e-10] {
        assert_close(&run(miss).beta, &straight.beta, 1e-8, "a flange that misses its axis by rounding");
    }
}
