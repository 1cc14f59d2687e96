//! Tori and pipe bends against Pappus, closed-form sections, quadrature about their axis, meshes, and what must hold whatever the numbers.

use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use voidage::geometry::facets;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};
use voidage_core::convex::shape::{Cylinder, Sphere};
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::number::real::{Real, Vector};
use voidage_core::solids::torus::{TorusShape, TorusSolid};
use voidage_tests::effort::cases;
use voidage_tests::random::Random;
use voidage_tests::solids::{cuboid, formulas, scene};

/// Shares and what they may be off by: cells, x, y, z faces.
pub(super) type Shares = [Vec<[f64; 2]>; 4];

pub(super) fn shares(solid: &TorusSolid, edges: &[Vec<f64>; 3]) -> Shares {
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let [nx, ny, nz] = grid.cells();
    let lengths = [nx * ny * nz, (nx + 1) * ny * nz, nx * (ny + 1) * nz, nx * ny * (nz + 1)];
    let mut fields = lengths.map(|n| vec![[0.0; 2]; n]);
    for k in 0..nz {
        let worst = solid.layer(&grid, k, true, &mut |kind, at, share, error| {
            let (field, first) = match kind {
                RangeKind::Cells => (0, k * nx * ny),
                RangeKind::Faces(0) => (1, k * (nx + 1) * ny),
                RangeKind::Faces(1) => (2, k * nx * (ny + 1)),
                RangeKind::Faces(_) => (3, k * nx * ny),
            };
            fields[field][first + at] = [share, error];
        });
        assert!(worst <= 0.0, "a share leaves 0 to 1 by {worst:e} more than it may");
    }
    solid.plane(&grid, nz, &mut |_, at, share, error| fields[3][nz * nx * ny + at] = [share, error]);
    fields
}

/// Some torus about the middle of a box of 4 by 4 by 4: aligned, nearly aligned, oblique; thin, fat, a horn but for rounding; whole or not.
fn some(random: &mut Random) -> TorusShape<DVec3> {
    let along = DVec3::AXES[random.below(3)];
    let axis = match random.below(4) {
        0 => along,
        1 => along + random.vector::<DVec3>(1.0) * 10_f64.powf(random.between(-14.0, -2.0)),
        _ => random.vector::<DVec3>(1.0),
    };
    let mut start = if random.below(3) == 0 { DVec3::AXES[random.below(3)] } else { random.vector::<DVec3>(1.0) };
    if axis.cross(start).length() < 1e-3 * axis.length() * start.length() {
        start = axis.any_orthogonal_vector();
    }
    let radius = random.between(0.2, 0.9);
    let tube = radius
        * match random.below(4) {
            0 => random.between(0.9, 1.0),
            1 => 0.01,
            _ => random.between(0.1, 0.9),
        };
    let angle = match random.below(4) {
        0 => 360.0,
        1 => 90.0 * (1 + random.below(3)) as f64,
        _ => random.between(1.0, 360.0),
    };
    let center = match random.below(3) {
        0 => DVec3::splat(2.0),
        1 => random.point(DVec3::splat(7.5), DVec3::splat(8.5)).round() * 0.25,
        _ => random.point(DVec3::splat(1.9), DVec3::splat(2.1)),
    };
    TorusShape { center, axis, start, radius, tube, angle }
}

fn even(cells: usize) -> Vec<f64> {
    (0..=cells).map(|i| i as f64 * 4.0 / cells as f64).collect()
}

/// Cells and faces are the sums of their parts on a grid with other planes besides, and all together have Pappus' volume.
#[test]
fn parts_sum_to_the_whole_and_to_pappus() {
    let random = &mut Random::new(23);
    for round in 0..60 {
        let shape = some(random);
        let solid = TorusSolid::new(&shape).expect("a torus of ordinary size");
        let n = [4, 5, 8][random.below(3)];
        let coarse = even(n);
        let fine: Vec<f64> =
            (0..=2 * n).map(|i| i as f64 * 2.0 / n as f64 + if i % 2 == 1 { 0.013 } else { 0.0 }).collect();
        let whole = shares(&solid, &[coarse.clone(), coarse.clone(), coarse.clone()]);
        let parts = shares(&solid, &[fine.clone(), fine.clone(), fine.clone()]);
        let cell = 4.0 / n as f64;
        let total: f64 = whole[0].iter().map(|s| s[0]).sum::<f64>() * cell.powi(3);
        let pappus = PI * shape.tube.powi(2) * shape.radius * shape.angle.to_radians();
        assert!((total - pappus).abs() < 1e-10 * cell.powi(3), "{round} {shape:?}: {total}, not {pappus}");
        let width = |i: usize| (fine[i + 1] - fine[i]) / cell;
        for at in 0..n * n * n {
            let [i, j, k] = [at % n, at / n % n, at / n / n];
            let m = 2 * n;
            let mut sums = [0.0; 4];
            for part in 0..8 {
                let [p, q, r] = [2 * i + (part & 1), 2 * j + (part >> 1 & 1), 2 * k + (part >> 2)];
                sums[0] += parts[0][p + m * (q + m * r)][0] * width(p) * width(q) * width(r);
                if part & 1 == 0 {
                    sums[1] += parts[1][p + (m + 1) * (q + m * r)][0] * width(q) * width(r);
                }
                if part >> 1 & 1 == 0 {
                    sums[2] += parts[2][p + m * (q + (m + 1) * r)][0] * width(p) * width(r);
                }
                if part >> 2 == 0 {
                    sums[3] += parts[3][p + m * (q + m * r)][0] * width(p) * width(q);
                }
            }
            let own = [at, i + (n + 1) * (j + n * k), i + n * (j + (n + 1) * k), at];
            for field in 0..4 {
                let ([share, error], sum) = (whole[field][own[field]], sums[field]);
                assert!(error < 1e-8, "{round} {shape:?}: may be off by {error:e}");
                let off = (share - sum).abs();
                assert!(off <= error + 2e-10, "{round} {shape:?}: field {field} at {i} {j} {k}: {share} and {sum}");
            }
        }
    }
}

/// How much of a circle about the axis lies in a box, in radians: between where the planes of its sides and the ends cut it.
fn angle_in_box(shape: &TorusShape<DVec3>, [e, f, a]: [DVec3; 3], rho: f64, z: f64, lo: DVec3, hi: DVec3) -> f64 {
    let base = shape.center + a * z;
    let mut cuts = vec![0.0, shape.angle.to_radians()];
    for n in 0..3 {
        let (x, y) = (rho * e[n], rho * f[n]);
        let (size, phase) = (x.hypot(y), y.atan2(x));
        for side in [lo[n], hi[n]] {
            let cosine = (side - base[n]) / size;
            if cosine.abs() < 1.0 {
                cuts.extend([phase + cosine.acos(), phase - cosine.acos()].map(|c| c.rem_euclid(TAU)));
            }
        }
    }
    cuts.retain(|&c| c <= shape.angle.to_radians());
    cuts.sort_by(f64::total_cmp);
    let inside = |phi: f64| {
        let p = base + (e * phi.cos() + f * phi.sin()) * rho;
        p.cmpge(lo).all() && p.cmple(hi).all()
    };
    cuts.windows(2).filter(|w| inside((w[0] + w[1]) * 0.5)).map(|w| w[1] - w[0]).sum()
}

/// The volume in a box by quadrature over the tube's disc of the way around the axis that lies in the box.
fn volume_about_axis(shape: &TorusShape<DVec3>, lo: DVec3, hi: DVec3, steps: usize) -> f64 {
    let a = shape.axis.normalize();
    let e = (shape.start - a * a.dot(shape.start)).normalize();
    let frame = [e, a.cross(e), a];
    let mut sum = 0.0;
    for i in 0..steps {
        let t = shape.tube * (i as f64 + 0.5) / steps as f64;
        for j in 0..steps {
            let theta = TAU * (j as f64 + 0.5) / steps as f64;
            let rho = shape.radius + t * theta.cos();
            sum += rho * t * angle_in_box(shape, frame, rho, t * theta.sin(), lo, hi);
        }
    }
    sum * shape.tube / steps as f64 * TAU / steps as f64
}

#[test]
fn cells_agree_with_quadrature_about_the_axis() {
    let random = &mut Random::new(4);
    for round in 0..cases(10) {
        let shape = some(random);
        let solid = TorusSolid::new(&shape).expect("a torus of ordinary size");
        let edges = even(7);
        let found = shares(&solid, &[edges.clone(), edges.clone(), edges.clone()]);
        let size = (4.0_f64 / 7.0).powi(3);
        let cut: Vec<usize> = (0..343).filter(|&n| found[0][n][0] > 0.0 && found[0][n][0] < 1.0).collect();
        for _ in 0..2 {
            let at = cut[random.below(cut.len())];
            let [i, j, k] = [at % 7, at / 7 % 7, at / 49];
            let lo = DVec3::new(edges[i], edges[j], edges[k]);
            let hi = DVec3::new(edges[i + 1], edges[j + 1], edges[k + 1]);
            // Midpoints: circles that touch the sides of the box leave kinks, of which three rules tell.
            let truths = [300, 475, 600].map(|steps| volume_about_axis(&shape, lo, hi, steps) / size);
            let [least, most] =
                [truths.iter().copied().fold(1.0, f64::min), truths.iter().copied().fold(0.0, f64::max)];
            let room = 1e-6 + 2.0 * (most - least);
            assert!(room < 1e-3, "{round} {shape:?}: {truths:?} by quadrature");
            let share = found[0][at][0];
            assert!(least - room < share && share < most + room, "{round} {shape:?}: {share} and {truths:?}");
        }
    }
}

/// The volume in a box near the middle of a horn by quadrature over the heights along the axis and the distances beyond the hole there.
fn volume_by_the_hole(shape: &TorusShape<DVec3>, lo: DVec3, hi: DVec3, steps: usize) -> f64 {
    let a = shape.axis.normalize();
    let e = (shape.start - a * a.dot(shape.start)).normalize();
    let frame = [e, a.cross(e), a];
    let corners = (0..8).map(|n| DVec3::new([lo.x, hi.x][n & 1], [lo.y, hi.y][n >> 1 & 1], [lo.z, hi.z][n >> 2]));
    let (mut top, mut far) = (0.0_f64, 0.0_f64);
    for corner in corners {
        top = top.max(a.dot(corner - shape.center).abs());
        far = far.max((corner - shape.center).length());
    }
    let middle = |i: usize| (i as f64 + 0.5) / steps as f64;
    let mut sum = 0.0;
    for i in 0..steps {
        let z = top * (2.0 * middle(i) - 1.0);
        let hole = shape.radius - (shape.tube * shape.tube - z * z).sqrt();
        for rho in (0..steps).map(|j| hole + (far - hole) * middle(j)) {
            sum += rho * (far - hole) * angle_in_box(shape, frame, rho, z, lo, hi);
        }
    }
    sum * 2.0 * top / steps as f64 / steps as f64
}

/// Lines that pass the axis of a horn, where the azimuth turns at once: the cells by its hole agree with quadrature and with their parts.
#[test]
fn cells_by_the_hole_of_a_horn_are_right() {
    let sides = [-0.3, 0.2, 0.25, 1.1, 2.9, 3.6];
    let parts = [-0.3, -0.1, 0.2, 0.22, 0.25, 0.7, 1.1, 2.0, 2.9, 3.3, 3.6];
    let [coarse, fine] = [&sides[..], &parts].map(|edges| [edges.to_vec(), edges.to_vec(), edges.to_vec()]);
    for (radius, axis) in
        [(176.0, DVec3::new(0.0, 1.0, 1.0)), (3.0, DVec3::new(0.0, 1.0, 1.0)), (3.0, DVec3::new(0.1, 0.9, 1.0))]
    {
        let start = axis.any_orthogonal_vector();
        let shape = TorusShape { center: DVec3::ZERO, axis, start, radius, tube: radius, angle: 360.0 };
        let solid = TorusSolid::new(&shape).expect("a horn");
        let [whole, halves] = [&coarse, &fine].map(|edges| shares(&solid, edges));
        for at in 0..125 {
            let cell = [at % 5, at / 5 % 5, at / 25];
            let [lo, hi] = [0, 1].map(|side| DVec3::from_array(cell.map(|i| sides[i + side])));
            let [share, error] = whole[0][at];
            assert!(error < 1e-7, "{shape:?}: cell {cell:?} may be off by {error:e}");
            let mut sum = 0.0;
            for part in 0..8 {
                let [p, q, r] = [0, 1, 2].map(|n| 2 * cell[n] + (part >> n & 1));
                let size = (parts[p + 1] - parts[p]) * (parts[q + 1] - parts[q]) * (parts[r + 1] - parts[r]);
                sum += halves[0][p + 10 * (q + 10 * r)][0] * size / (hi - lo).element_product();
            }
            assert!((share - sum).abs() <= error + 1e-9, "{shape:?}: cell {cell:?}: {share}, in parts {sum}");
            if radius == 3.0 && share < 1.0 && hi.max_element() < 2.0 {
                let [rough, truth] =
                    [400, 600].map(|steps| volume_by_the_hole(&shape, lo, hi, steps) / (hi - lo).element_product());
                let room = 1e-5 + 2.0 * (truth - rough).abs();
                assert!(room < 1e-3, "{rough} and {truth} by quadrature");
                assert!((share - truth).abs() < room, "{shape:?}: cell {cell:?}: {share}, not {truth} ± {room:e}");
            }
        }
    }
}

/// A plane through the axis cuts two discs out, one across it a ring.
#[test]
fn sections_through_and_across_the_axis_are_discs_and_rings() {
    let (radius, tube) = (1.1, 0.4);
    let shape = TorusShape { center: DVec3::splat(2.0), axis: DVec3::Z, start: DVec3::X, radius, tube, angle: 360.0 };
    let solid = TorusSolid::new(&shape).expect("a torus");
    let edges = [even(8), even(8), vec![0.0, 1.7, 2.0, 2.15, 4.0]];
    let found = shares(&solid, &edges);
    let mut discs = [0.0; 2];
    for k in 0..4 {
        let depth = edges[2][k + 1] - edges[2][k];
        for n in 0..8 {
            discs[0] += found[1][4 + 9 * (n + 8 * k)][0] * 0.5 * depth;
            discs[1] += found[2][n + 8 * (4 + 9 * k)][0] * 0.5 * depth;
        }
    }
    assert!(discs.iter().all(|a| (a - 2.0 * PI * tube * tube).abs() < 1e-12), "{discs:?}");
    for (plane, z) in [(1, -0.3_f64), (2, 0.0), (3, 0.15)] {
        let ring: f64 = found[3][64 * plane..64 * (plane + 1)].iter().map(|s| s[0] * 0.25).sum();
        let half = (tube * tube - z * z).sqrt();
        assert!((ring - 4.0 * PI * radius * half).abs() < 1e-12, "plane {plane}: {ring}");
    }
}

/// A plane of the grid that the tube only touches has nothing of it, whatever the height.
#[test]
fn a_plane_that_the_tube_touches_is_open() {
    for height in [1.0, 1.5, 1e6] {
        let (radius, tube) = (1.0, 0.25);
        let center = DVec3::new(2.0, 2.0, height);
        let shape = TorusShape { center, axis: DVec3::Z, start: DVec3::X, radius, tube, angle: 360.0 };
        let solid = TorusSolid::new(&shape).expect("a torus");
        let found = shares(&solid, &[even(8), even(8), vec![height - 0.5, height - 0.25, height + 0.25, height + 0.5]]);
        assert!(found[0][..64].iter().chain(&found[0][128..]).all(|s| s[0] == 0.0));
        assert!(found[3].iter().all(|s| s[0] == 0.0));
        let volume: f64 = found[0].iter().map(|s| s[0] * 0.125).sum();
        assert!((volume - 2.0 * PI * PI * tube * tube * radius).abs() < 1e-9, "{volume}");
    }
}

#[test]
fn the_scalar_of_the_grid_does_not_matter() {
    let single: Vec<f32> = (0..=8).map(|i| i as f32 * 0.3).collect();
    let double: Vec<f64> = single.iter().map(|&x| f64::from(x)).collect();
    let shape = TorusShape {
        center: DVec3::new(0.4, 0.5, 0.6),
        axis: DVec3::new(0.3, -0.4, 1.0),
        start: DVec3::X,
        radius: 0.8,
        tube: 0.3,
        angle: 130.0,
    };
    let solid = TorusSolid::new(&shape).expect("a bend");
    let mut told = [Vec::new(), Vec::new()];
    let (one, other) = (Grid::new(&single, &single, &single), Grid::new(&double, &double, &double));
    for k in 0..8 {
        solid.layer(one.as_ref().expect("a grid"), k, true, &mut |kind, at, s, e| told[0].push((kind, at, s, e)));
        solid.layer(other.as_ref().expect("a grid"), k, true, &mut |kind, at, s, e| told[1].push((kind, at, s, e)));
    }
    assert!(told[0].len() > 50 && told[0] == told[1]);
}

fn number(random: &mut Random) -> f64 {
    const EXTREME: [f64; 10] = [0.0, -0.0, 1.0, 1e-300, 1e-29, 1e29, -1e30, f64::MAX, f64::NAN, f64::INFINITY];
    match random.below(8) {
        0 => EXTREME[random.below(EXTREME.len())],
        1 => 10_f64.powf(random.between(-12.0, 12.0)),
        2..=4 => random.below(9) as f64 * 0.25,
        _ => random.between(-1.0, 3.0),
    }
}

/// Any numbers as a torus in a grid of either scalar: no panic, shares from 0 to 1.
fn never_panics<V: Vector>(random: &mut Random) -> bool {
    let mut point = || V::from_array([0; 3].map(|_| V::Scalar::from_f64(number(random))));
    let (center, axis, start) = (point(), point(), point());
    let [radius, tube] = [0; 2].map(|_| V::Scalar::from_f64(number(random)));
    let angle = if random.below(3) == 0 { 360.0 } else { number(random) * 90.0 };
    let list = |random: &mut Random| {
        let (n, first, size) = (1 + random.below(4), random.between(-1.0, 1.0), 10_f64.powf(random.between(-3.0, 3.0)));
        (0..=n).map(|i| V::Scalar::from_f64(first + size * i as f64 / n as f64)).collect::<Vec<_>>()
    };
    let lists = [0; 3].map(|_| list(random));
    let solid = TorusSolid::new(&TorusShape { center, axis, start, radius, tube, angle });
    let (Some(solid), Ok(grid)) = (solid, Grid::new(&lists[0], &lists[1], &lists[2])) else { return false };
    let mut told = |_: RangeKind, _: usize, share: f64, error: f64| {
        assert!(share > 0.0 && share <= 1.0 && error >= 0.0, "{share} {error}");
    };
    for k in 0..=grid.cells()[2] + 1 {
        assert!(!solid.layer(&grid, k, true, &mut told).is_nan());
        solid.plane(&grid, k, &mut told);
    }
    let [lo, hi] = [0; 2].map(|_| [0; 3].map(|_| number(random)));
    tells_of_box(&solid, lo, hi);
    true
}

/// Any box, and faces across axes that there are not: shares from 0 to 1, an error that is a number.
fn tells_of_box(solid: &TorusSolid, lo: [f64; 3], hi: [f64; 3]) {
    let kinds = [0, 1, 2, 3, usize::MAX].map(RangeKind::Faces).into_iter().chain([RangeKind::Cells]);
    for kind in kinds {
        let (share, error) = solid.share(kind, lo, hi);
        assert!((0.0..=1.0).contains(&share) && !error.is_nan(), "{share} {error} of {kind:?} from {lo:?} to {hi:?}");
    }
    let _ = (solid.may_reach(lo, hi), solid.outermost(lo), solid.extent(3));
}

/// Limits of a run without end are not numbers; `f64::clamp` panics of such.
#[test]
fn a_box_without_end_has_an_answer() {
    let center = DVec3::ONE;
    for angle in [110.0, 250.0, 360.0] {
        let (axis, start) = (DVec3::new(0.4, 0.2, 0.9), DVec3::X);
        let solid =
            TorusSolid::new(&TorusShape { center, axis, start, radius: 0.6, tube: 0.2, angle }).expect("a bend");
        for (n, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
            let mut sides = [[0.3; 3], [1.9; 3]];
            sides[side][n] = [f64::NEG_INFINITY, f64::INFINITY][side];
            tells_of_box(&solid, sides[0], sides[1]);
        }
    }
}

#[test]
fn no_numbers_make_it_panic() {
    let random = &mut Random::new(77);
    let mut solids = 0;
    for _ in 0..3000 {
        solids += usize::from(never_panics::<DVec3>(random)) + usize::from(never_panics::<Vec3>(random));
    }
    assert!(solids > 300, "{solids} solids");
}

fn lists(n: usize) -> Edges {
    Edges([0, 1, 2].map(|_| even(n)))
}

fn run(edges: &Edges, forms: &[Form]) -> Porosity {
    porosity(&edges.grid(None).expect("a grid"), &formulas(forms), Options { bounds: true, ..Options::default() })
}

/// A pipe, a bend and another pipe, flush at both ends, along the axes and turned: one pipe of known volume, without gap.
#[test]
fn a_bend_between_two_pipes_counts_nothing_twice() {
    for (turned, corner) in
        [(0.0_f64, DVec3::new(2.0, 2.0, 2.0)), (0.0, DVec3::new(2.03, 1.96, 2.01)), (0.7, DVec3::new(2.03, 1.96, 2.01))]
    {
        let turn = |v: DVec3| glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turned) * v;
        let at = |v: DVec3| corner + turn(v);
        let (radius, tube) = (0.5, 0.2);
        let torus = TorusShape {
            center: at(DVec3::ZERO),
            axis: turn(DVec3::Z),
            start: turn(DVec3::X),
            radius,
            tube,
            angle: 90.0,
        };
        let forms = [
            Form::Cylinder(Cylinder::new(at(DVec3::new(radius, -1.0, 0.0)), at(DVec3::new(radius, 0.0, 0.0)), tube)),
            Form::Torus(torus),
            Form::Cylinder(Cylinder::new(at(DVec3::new(0.0, radius, 0.0)), at(DVec3::new(-1.0, radius, 0.0)), tube)),
        ];
        let found = run(&lists(16), &forms);
        let volume = PI * tube * tube * (2.0 + radius * PI / 2.0);
        assert!((found.solid_volume - volume).abs() < 1e-9, "{turned}: {} not {volume}", found.solid_volume);
        assert!(found.max_gap < 1e-7, "{turned}: {}", found.max_gap);
        if turned == 0.0 && corner.y == 2.0 {
            // The joint in the plane y = 2 is one disc.
            let joint: f64 = (0..16 * 16)
                .map(|n| (n % 16, n / 16))
                .filter(|(i, _)| *i >= 8)
                .map(|(i, k)| (1.0 - found.beta.y[i + 16 * (8 + 17 * k)]) * 0.0625)
                .sum();
            assert!((joint - PI * tube * tube).abs() < 1e-9, "{joint}");
        }
    }
}

/// A pipe through a ring, a ball on it: bounds within the tolerance, which hold what ever finer grids say.
#[test]
fn unions_with_a_torus_are_certified() {
    let center = DVec3::new(2.02, 1.97, 2.0);
    let torus =
        TorusShape { center, axis: DVec3::new(0.1, 0.2, 1.0), start: DVec3::X, radius: 1.0, tube: 0.3, angle: 360.0 };
    let pipe = Form::Cylinder(Cylinder::new(DVec3::new(0.4, 1.9, 1.9), DVec3::new(3.7, 2.2, 2.1), 0.2));
    let ball = Form::Sphere(Sphere { center: DVec3::new(2.1, 3.0, 2.1), radius: 0.5 });
    let forms = [Form::Torus(torus), pipe, ball];
    let coarse = run(&lists(6), &forms);
    assert!(coarse.max_gap <= 1e-4, "{}", coarse.max_gap);
    let fine = run(&lists(18), &forms);
    let [low, high] = coarse.bounds.as_ref().expect("bounds");
    let [least, most] = fine.bounds.as_ref().expect("bounds");
    for at in 0..216 {
        let [i, j, k] = [at % 6, at / 6 % 6, at / 36];
        let mut sums = [0.0; 2];
        for part in 0..27 {
            let [p, q, r] = [3 * i + part % 3, 3 * j + part / 3 % 3, 3 * k + part / 9];
            let n = p + 18 * (q + 18 * r);
            sums = [sums[0] + least.v[n] / 27.0, sums[1] + most.v[n] / 27.0];
        }
        assert!(
            sums[0] <= high.v[at] + 1e-9 && sums[1] >= low.v[at] - 1e-9,
            "{at}: {sums:?} {} {}",
            low.v[at],
            high.v[at]
        );
    }
}

/// A torus, a pipe and a ball that all meet in one cell, against points: along many lines, where each enters and leaves the union.
#[test]
fn a_union_with_a_torus_agrees_with_lines_of_points() {
    let center = DVec3::new(0.4, 0.45, 0.5);
    let axis = DVec3::new(0.2, -0.1, 1.0).normalize();
    let torus = TorusShape { center, axis, start: DVec3::X, radius: 0.35, tube: 0.12, angle: 360.0 };
    let [from, to, thick] = [DVec3::new(-0.5, 0.3, 0.4), DVec3::new(1.5, 0.6, 0.6), DVec3::splat(0.1)];
    let (ball, size) = (DVec3::new(0.75, 0.45, 0.55), 0.2);
    let inside = |p: DVec3| {
        let d = p - center;
        let z = d.dot(axis);
        let in_torus = ((d - axis * z).length() - 0.35).hypot(z) <= 0.12;
        let along = (to - from).normalize();
        in_torus || (p - from).reject_from(along).length() <= thick.x || p.distance(ball) <= size
    };
    const LINES: usize = 240;
    const STEPS: usize = 120;
    let mut sum = 0.0;
    for n in 0..LINES * LINES {
        let [y, z] = [n % LINES, n / LINES].map(|i| (i as f64 + 0.5) / LINES as f64);
        let at = |x: f64| inside(DVec3::new(x, y, z));
        for step in 0..STEPS {
            let [mut low, mut high] = [step, step + 1].map(|s| s as f64 / STEPS as f64);
            let (first, last) = (at(low), at(high));
            if first == last {
                sum += if first { high - low } else { 0.0 };
                continue;
            }
            let start = low;
            for _ in 0..20 {
                let middle = 0.5 * (low + high);
                if at(middle) == first { low = middle } else { high = middle }
            }
            sum += if first { low - start } else { (step + 1) as f64 / STEPS as f64 - low };
        }
    }
    let truth = sum / (LINES * LINES) as f64;
    let pipe = Form::Cylinder(Cylinder::new(from, to, thick.x));
    let forms = [Form::Torus(torus), pipe, Form::Sphere(Sphere { center: ball, radius: size })];
    let edges = Edges([0, 1, 2].map(|_| vec![0.0, 1.0]));
    let lines = 1e-4;
    for tol in [1e-3, 1e-6] {
        let options = Options { tol, bounds: true, ..Options::default() };
        let found = porosity(&edges.grid(None).expect("a grid"), &formulas(&forms), options);
        let [low, high] = found.bounds.as_ref().expect("bounds");
        assert!(high.v[0] - low.v[0] <= tol, "{} apart", high.v[0] - low.v[0]);
        let open = 1.0 - truth;
        assert!(low.v[0] - lines <= open && open <= high.v[0] + lines, "{} to {}: {open}", low.v[0], high.v[0]);
    }
}

/// By its own facets through the surface road the same, as far as facets go; and beside a mesh that it crosses.
#[test]
fn meshes_of_a_torus_agree() {
    let center = DVec3::new(2.0, 2.1, 1.9);
    let shape =
        TorusShape { center, axis: DVec3::new(0.5, 0.2, 1.0), start: DVec3::X, radius: 1.0, tube: 0.4, angle: 200.0 };
    let by_formula = run(&lists(12), &[Form::Torus(shape)]);
    let facets = facets::triangles(&Form::Torus(shape));
    let edges = lists(12);
    let grid = edges.grid(None).expect("a grid");
    let by_surface = porosity(&grid, &scene(&[facets]), Options::default());
    for (a, b) in [(&by_formula.beta.v, &by_surface.beta.v), (&by_formula.beta.x, &by_surface.beta.x)] {
        let worst = a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 6e-3, "{worst}");
    }
    assert!(by_formula.max_gap < 1e-8);
}

/// A bend through the wall of a mesh: certified within the tolerance, and the part within the box counts once.
#[test]
fn a_bend_through_the_wall_of_a_mesh() {
    let shape = TorusShape {
        center: DVec3::new(2.0, 2.0, 2.03),
        axis: DVec3::Z,
        start: DVec3::X,
        radius: 1.0,
        tube: 0.25,
        angle: 180.0,
    };
    // Half of the bend lies in the box, in x.
    let block = cuboid(DVec3::new(2.0, 1.0, 1.0), DVec3::new(3.7, 3.7, 3.0));
    let mut bodies = scene(&[block]);
    bodies.bodies.extend(formulas(&[Form::Torus(shape)]).bodies);
    let edges = lists(10);
    let found = porosity(&edges.grid(None).expect("a grid"), &bodies, Options { bounds: true, ..Options::default() });
    let half = PI * 0.0625 * PI / 2.0;
    let volume = 1.7 * 2.7 * 2.0 + half;
    assert!(found.max_gap <= 1e-4, "{}", found.max_gap);
    let [low, high] = found.bounds.as_ref().expect("bounds");
    let solid = |f: &[f64]| f.iter().map(|b| 1.0 - b).sum::<f64>() * 0.064;
    assert!(solid(&high.v) <= volume + 1e-9 && volume - 1e-9 <= solid(&low.v), "{volume}: {}", found.solid_volume);
}
