//! Solids by formula in random places: families that meet the grid in every awkward way, and what must hold for their shares.

use crate::precise::chord;
use crate::quadrature::{Exact, area_by_chords};
use crate::random::Random;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::number::real::{Real, Vector};
use voidage_core::solids::quadric::QuadricSolid;

/// How a solid lies in the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Along an axis.
    Aligned,
    /// Off an axis by 10⁻¹⁵ to 10⁻³.
    NearlyAligned,
    /// Any direction.
    Oblique,
    /// Along an axis, touching a plane from one side but for rounding.
    Tangent,
    /// Ends, centres and apices in planes of the grid.
    Flush,
    /// 10⁻⁶ cells.
    Tiny,
    /// Inside one cell.
    Inside,
    /// Partly beyond the grid.
    Cutting,
    /// 10³ to 10⁴ cells.
    Huge,
}

/// All of them.
pub const FAMILIES: [Family; 9] = [
    Family::Aligned,
    Family::NearlyAligned,
    Family::Oblique,
    Family::Tangent,
    Family::Flush,
    Family::Tiny,
    Family::Inside,
    Family::Cutting,
    Family::Huge,
];

/// Cells along each axis of the grid that solids are put into; edges are i/4 along x, i/5 along y, i/3 along z.
pub const CELLS: [usize; 3] = [9, 8, 7];

/// The edges of that grid.
#[must_use]
pub fn edges() -> [Vec<f64>; 3] {
    let parts = [4.0, 5.0, 3.0];
    [0, 1, 2].map(|a: usize| (0..=CELLS[a]).map(|i| i as f64 / parts[a]).collect())
}

/// A direction of a family.
fn direction(random: &mut Random, family: Family) -> DVec3 {
    let axis = DVec3::AXES[random.below(3)] * if random.below(2) == 0 { 1.0 } else { -1.0 };
    match family {
        Family::Oblique | Family::Inside | Family::Cutting | Family::Huge | Family::Tiny if random.below(4) != 0 => {
            random.vector::<DVec3>(1.0).normalize()
        }
        Family::NearlyAligned => axis + random.vector::<DVec3>(1.0) * 10_f64.powf(random.between(-15.0, -3.0)),
        _ => axis,
    }
}

/// A point of the grid, on its planes if the family asks for it.
fn place(random: &mut Random, family: Family) -> DVec3 {
    let edges = edges();
    let on_plane = family == Family::Flush;
    DVec3::from_array([0, 1, 2].map(|a: usize| {
        let list = &edges[a];
        let n = 2 + random.below(list.len() - 4);
        match family {
            Family::Inside => list[n] + (list[n + 1] - list[n]) * random.between(0.4, 0.6),
            _ if on_plane && random.below(3) != 0 => list[n],
            Family::Cutting => random.between(-0.3, list[list.len() - 1] + 0.3),
            _ => random.between(list[1], list[list.len() - 2]),
        }
    }))
}

/// A solid of a family, and the same for quadrature.
pub fn solid(random: &mut Random, family: Family) -> (QuadricSolid, Exact) {
    solid_of(random, family, Kind::Any)
}

/// Which kinds of solids are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Ball, ellipsoid, cylinder, capsule, cone.
    Any,
    /// Truncated cones.
    Frustum,
    /// Cones, whole and truncated, with a line along an axis of the grid, as reducers between pipes at 45°.
    Leaning,
}

/// Half the angle of a leaning cone, and a direction of its axis.
fn leaning(random: &mut Random) -> (f64, DVec3) {
    let half: f64 = match random.below(4) {
        0 => 45_f64.to_radians(),
        1 => [30_f64, 60.0][random.below(2)].to_radians(),
        2 => [0.5_f64, 0.75][random.below(2)].atan(),
        _ => random.between(0.1, 1.4),
    };
    let (n, sign) = (random.below(3), [1.0, -1.0][random.below(2)]);
    let (u, v) = (DVec3::AXES[(n + 1) % 3], DVec3::AXES[(n + 2) % 3]);
    let around = if random.below(2) == 0 { 0.0 } else { random.between(0.0, 6.2) };
    (half, DVec3::AXES[n] * (sign * half.cos()) + (u * around.cos() + v * around.sin()) * half.sin())
}

/// How many times as wide a truncated cone is at its other end: nearly equal, nearly a whole cone, anything.
fn taper(random: &mut Random) -> f64 {
    match random.below(4) {
        0 => 1.0 + 10_f64.powf(random.between(-16.0, -0.5)) * if random.below(2) == 0 { 1.0 } else { -1.0 },
        1 => 10_f64.powf(random.between(-12.0, -1.0)),
        _ => random.between(0.05, 1.9),
    }
}

/// A solid of a family and kind.
pub fn solid_of(random: &mut Random, family: Family, kinds: Kind) -> (QuadricSolid, Exact) {
    let size = match family {
        Family::Tiny => 1e-6,
        Family::Inside => 0.03,
        Family::Huge => 10_f64.powf(random.between(2.4, 3.4)),
        _ => random.between(0.1, 0.5),
    };
    let (half, axis) = if kinds == Kind::Leaning { leaning(random) } else { (0.0, direction(random, family)) };
    let mut center = place(random, family);
    let mut radius = size * random.between(0.3, 1.0);
    let kind = match kinds {
        Kind::Any => random.below(5),
        Kind::Frustum => 5,
        Kind::Leaning => 4 + random.below(2),
    };
    let mut length = size * random.between(0.5, 3.0);
    let taper = match (kinds, kind) {
        (Kind::Leaning, 5) => [0.25, 0.5, 0.9][random.below(3)],
        (_, 5) => taper(random),
        _ => 0.0,
    };
    if kinds == Kind::Leaning {
        length = 0.3;
        radius = length * half.tan() / (1.0 - taper);
    }
    match family {
        Family::Tangent => {
            // Beside a plane by one radius, rounded.
            let a = random.below(3);
            let edge = random.below(CELLS[a] - 1) + 1;
            center[a] = edges()[a][edge] + if random.below(2) == 0 { radius } else { -radius };
        }
        Family::Flush => {
            length = axis.abs().dot(DVec3::new(0.5, 0.6, 2.0 / 3.0));
            if random.below(2) == 0 {
                radius = 0.25;
            }
        }
        Family::Huge => {
            // The surface passes through the grid.
            let side = random.vector::<DVec3>(1.0).normalize();
            let along = random.between(-0.4, 0.4);
            center += match kind {
                0 => side * radius,
                // The half axis that has no random factor points along x.
                1 => DVec3::X * radius,
                4 => axis.normalize().any_orthonormal_vector() * (radius * (0.5 - along)) - axis * (length * along),
                5 => {
                    let there = radius * (1.0 + (taper - 1.0) * (along + 0.5));
                    axis.normalize().any_orthonormal_vector() * there - axis.normalize() * (length * along)
                }
                _ => axis.normalize().any_orthonormal_vector() * radius,
            };
        }
        _ => {}
    }
    let (from, to) = if family == Family::Flush {
        (center, center + axis * length)
    } else {
        (center - axis * (length * 0.5), center + axis * (length * 0.5))
    };
    let whole = "a solid of ordinary size";
    match kind {
        0 => (QuadricSolid::ball(center, radius).expect(whole), Exact::Ball(center, radius)),
        1 => {
            let turn = match family {
                Family::Huge => DMat3::from_rotation_x(random.between(0.0, 6.0)),
                Family::Oblique | Family::Inside | Family::Cutting => {
                    DMat3::from_axis_angle(random.vector::<DVec3>(1.0).normalize(), random.between(0.0, 6.0))
                }
                Family::NearlyAligned => DMat3::from_rotation_z(10_f64.powf(random.between(-15.0, -3.0))),
                _ => DMat3::IDENTITY,
            };
            let axes = [0, 1, 2].map(|n| turn.col(n) * if n == 0 { radius } else { radius * random.between(0.3, 1.5) });
            (QuadricSolid::ellipsoid(center, axes).expect(whole), Exact::Ellipsoid(center, axes))
        }
        2 => (QuadricSolid::cylinder(from, to, radius).expect(whole), Exact::Cylinder(from, to, radius)),
        3 => (QuadricSolid::capsule(from, to, radius).expect(whole), Exact::Capsule(from, to, radius)),
        4 => (QuadricSolid::cone(from, to, radius).expect(whole), Exact::Cone(from, to, radius)),
        _ => {
            let radii = [radius, radius * taper];
            (QuadricSolid::truncated_cone(from, to, radii).expect(whole), Exact::Frustum(from, to, radii))
        }
    }
}

/// Shares of cells and faces of a whole grid, x fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// Cells, x faces, y faces, z faces.
    pub fields: [Vec<f64>; 4],
    /// By how much a share left 0 to 1.
    pub worst: f64,
}

/// The shares of a solid.
#[must_use]
pub fn shares(solid: &QuadricSolid, grid: &Grid<f64>) -> Shares {
    let [nx, ny, nz] = grid.cells();
    let mut fields = [vec![0.0; nx * ny * nz], vec![0.0; (nx + 1) * ny * nz], vec![0.0; nx * (ny + 1) * nz], vec![]];
    fields[3] = vec![0.0; nx * ny * (nz + 1)];
    let mut worst = 0.0_f64;
    for k in 0..nz {
        let found = solid.layer(grid, k, true, &mut |kind, at, share| match kind {
            RangeKind::Cells => fields[0][k * nx * ny + at] += share,
            RangeKind::Faces(0) => fields[1][k * (nx + 1) * ny + at] += share,
            RangeKind::Faces(1) => fields[2][k * nx * (ny + 1) + at] += share,
            RangeKind::Faces(_) => fields[3][k * nx * ny + at] += share,
        });
        worst = worst.max(found);
    }
    solid.plane(grid, nz, &mut |_, at, share| fields[3][nz * nx * ny + at] += share);
    Shares { fields, worst }
}

/// Volume of a solid.
#[must_use]
pub fn volume(exact: &Exact) -> f64 {
    match *exact {
        Exact::Ball(_, r) => 4.0 / 3.0 * PI * r * r * r,
        Exact::Ellipsoid(_, [a, b, c]) => 4.0 / 3.0 * PI * a.dot(b.cross(c)).abs(),
        Exact::Cylinder(a, b, r) => PI * r * r * a.distance(b),
        Exact::Capsule(a, b, r) => PI * r * r * (a.distance(b) + 4.0 / 3.0 * r),
        Exact::Cone(a, b, r) => PI * r * r * a.distance(b) / 3.0,
        Exact::Frustum(a, b, [r, s]) => PI * (r * r + r * s + s * s) * a.distance(b) / 3.0,
    }
}

/// The worst differences from quadrature: of some cells that are cut, and of faces, as fractions of a cell or face; and where they are.
#[must_use]
pub fn errors(random: &mut Random, family: Family, kinds: Kind, samples: usize) -> (f64, f64, String) {
    let (solid, exact) = solid_of(random, family, kinds);
    let edges = edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let found = shares(&solid, &grid);
    let (mut cell, mut face, mut place) = (found.worst, 0.0_f64, String::new());
    let side = |a: usize, n: usize| [edges[a][n], edges[a][n + 1]];
    for kind in 0..4 {
        let field = &found.fields[kind];
        let cut: Vec<usize> = (0..field.len()).filter(|&n| field[n] > 0.0 && field[n] < 1.0).collect();
        for s in 0..samples {
            // Two of three among those that are cut, the others anywhere.
            let at =
                if s % 3 < 2 && !cut.is_empty() { cut[random.below(cut.len())] } else { random.below(field.len()) };
            let shape = if kind == 0 { grid.cells() } else { grid.face_shape(kind - 1) };
            let [i, j, k] = [at % shape[0], at / shape[0] % shape[1], at / shape[0] / shape[1]];
            let (truth, worst) = if kind == 0 {
                let [x, y, z] = [side(0, i), side(1, j), side(2, k)];
                let (lo, hi) = (DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]));
                let size = (hi - lo).element_product();
                let volume = if family == Family::Huge {
                    exact.volume(lo, hi)
                } else {
                    true_volume(&exact, [lo, hi], field[at])
                };
                (volume / size, &mut cell)
            } else {
                let n = kind - 1;
                let (u, v) = ((n + 1) % 3, (n + 2) % 3);
                let index = [i, j, k];
                let (u, v) = (side(u, index[u]), side(v, index[v]));
                let area = true_area(&exact, n, edges[n][index[n]], [u, v], field[at]);
                (area / ((u[1] - u[0]) * (v[1] - v[0])), &mut face)
            };
            let error = (field[at] - truth).abs();
            if !(error <= *worst) {
                *worst = error;
                place += &format!("{family:?} {exact:?}: field {kind} at {i} {j} {k}: {} and {truth}\n", field[at]);
            }
        }
    }
    (cell, face, place)
}

/// The volume of a solid in a box, the more carefully if its share is not what was `found`.
#[must_use]
pub fn true_volume(exact: &Exact, [lo, hi]: [DVec3; 2], found: f64) -> f64 {
    let truth = exact.volume(lo, hi);
    // Rarely a kink hides from the nodes of the quadrature; from those of the cell's parts it does not.
    let hidden = (found - truth / (hi - lo).element_product()).abs() > 3e-13;
    if hidden { volume_of_parts(exact, lo, hi) } else { truth }
}

/// The area that a solid has of a rectangle across axis `n` at a coordinate, the more carefully if its share is not what was `found`.
#[must_use]
pub fn true_area(exact: &Exact, n: usize, at: f64, [u, v]: [[f64; 2]; 2], found: f64) -> f64 {
    let size = (u[1] - u[0]) * (v[1] - v[0]);
    let truth = closed_area(exact, n, at, |at| exact.area(n, at, u, v));
    // Chords are rounded, which weighs the more the larger a solid is and the flatter its surface cuts the face.
    let off = |truth: f64| (found - truth / size).abs() > 3e-13;
    let precise = |m: usize| {
        let area = |at: f64| area_by_chords(chord, &[*exact], (n, m), at, [u, v], 1e-15);
        closed_area(exact, n, at, area)
    };
    let truth = if off(truth) { precise((n + 1) % 3) } else { truth };
    // A kink that hides from the nodes of one order of the axes does not from those of the other.
    if off(truth) { precise((n + 2) % 3) } else { truth }
}

/// The volume of a solid in a box, from 4 × 4 × 4 uneven parts.
fn volume_of_parts(exact: &Exact, lo: DVec3, hi: DVec3) -> f64 {
    const CUTS: [f64; 5] = [0.0, 0.231, 0.517, 0.743, 1.0];
    let at = |i: usize, j: usize, k: usize| lo + (hi - lo) * DVec3::new(CUTS[i], CUTS[j], CUTS[k]);
    (0..64)
        .map(|n| [n % 4, n / 4 % 4, n / 16])
        .map(|[i, j, k]| exact.volume(at(i, j, k), at(i + 1, j + 1, k + 1)))
        .sum()
}

/// A plane so far from another is another, wherever in the grid it lies.
const BESIDE: f64 = 1e-15;

/// The area that a solid has of a face, by its `area` in a plane; a flat end in the plane belongs to the solid.
fn closed_area(exact: &Exact, n: usize, at: f64, area: impl Fn(f64) -> f64) -> f64 {
    let ends = match *exact {
        Exact::Cylinder(a, b, _) => vec![(a, b), (b, a)],
        Exact::Capsule(..) | Exact::Ball(..) | Exact::Ellipsoid(..) => vec![],
        Exact::Cone(base, apex, _) => vec![(base, apex)],
        Exact::Frustum(a, b, _) => vec![(a, b), (b, a)],
    };
    let flush =
        ends.iter().find(|(end, other)| end[n] == at && (other - end).abs() == DVec3::AXES[n] * (other[n] - at).abs());
    match flush {
        Some((_, other)) if other[n] > at => area(at + BESIDE),
        Some(_) => area(at - BESIDE),
        None => area(at),
    }
}

/// A box around a solid, not too small.
#[must_use]
pub fn bounds(exact: &Exact) -> [DVec3; 2] {
    match *exact {
        Exact::Ball(c, r) => [c - r, c + r],
        Exact::Ellipsoid(c, axes) => {
            let reach = axes[0].abs() + axes[1].abs() + axes[2].abs();
            [c - reach, c + reach]
        }
        Exact::Cylinder(a, b, r) | Exact::Capsule(a, b, r) | Exact::Cone(a, b, r) => [a.min(b) - r, a.max(b) + r],
        Exact::Frustum(a, b, [r, s]) => [a.min(b) - r.max(s), a.max(b) + r.max(s)],
    }
}

/// Does a solid lie within the grid?
#[must_use]
pub fn is_within_grid(exact: &Exact) -> bool {
    let [lo, hi] = bounds(exact);
    let end = DVec3::from_array(edges().map(|e| e[e.len() - 1]));
    lo.min_element() > 0.0 && hi.cmplt(end).all()
}

/// What no caller should write, and what callers do write.
fn number(random: &mut Random) -> f64 {
    const EXTREME: [f64; 12] =
        [0.0, -0.0, 1.0, 1e-300, -1e-310, 1e-59, 1e59, -1e30, 1e300, f64::MAX, f64::NAN, f64::NEG_INFINITY];
    match random.below(8) {
        0 => EXTREME[random.below(EXTREME.len())],
        1 => 10_f64.powf(random.between(-20.0, 20.0)),
        2..=4 => random.below(9) as f64 * 0.25,
        _ => random.between(-1.0, 3.0),
    }
}

/// Any numbers as a solid in a grid of either scalar: no panic, positions in range, shares from 0 to 1. Whether there was a solid.
pub fn never_panics<V: Vector>(seed: u64) -> bool {
    let random = &mut Random::new(seed);
    let mut point = || V::from_array([0; 3].map(|_| V::Scalar::from_f64(number(random))));
    let (a, b, c, d) = (point(), point(), point(), point());
    let radius = V::Scalar::from_f64(number(random));
    let lists = [0, 1, 2].map(|_| {
        let (n, first, size) = (1 + random.below(5), random.between(-1.0, 1.0), 10_f64.powf(random.between(-3.0, 3.0)));
        (0..=n).map(|i| V::Scalar::from_f64(first + size * i as f64 / n as f64)).collect::<Vec<_>>()
    });
    let solid = match random.below(6) {
        5 => QuadricSolid::truncated_cone(a, b, [radius, V::Scalar::from_f64(number(random))]),
        0 => QuadricSolid::ball(a, radius),
        1 => QuadricSolid::cylinder(a, b, radius),
        2 => QuadricSolid::capsule(a, b, radius),
        3 => QuadricSolid::cone(a, b, radius),
        _ => QuadricSolid::ellipsoid(a, [b, c, d]),
    };
    let (Some(solid), Ok(grid)) = (solid, Grid::new(&lists[0], &lists[1], &lists[2])) else { return false };
    let count = |kind: RangeKind| {
        let [nx, ny, _] = grid.cells();
        match kind {
            RangeKind::Cells | RangeKind::Faces(2..) => nx * ny,
            RangeKind::Faces(0) => (nx + 1) * ny,
            RangeKind::Faces(1) => nx * (ny + 1),
        }
    };
    let mut told = |kind: RangeKind, at: usize, share: f64| {
        assert!(at < count(kind) && share > 0.0 && share <= 1.0, "{kind:?} {at}: {share}");
    };
    for k in 0..=grid.cells()[2] + 1 {
        let worst = solid.layer(&grid, k, random.below(2) == 0, &mut told);
        assert!(!worst.is_nan());
        solid.plane(&grid, k, &mut told);
    }
    true
}

/// The shares of a solid within the grid sum to its volume, and none leaves 0 to 1.
///
/// # Panics
/// If not.
pub fn parts_sum_to_the_whole(seed: u64) {
    let random = &mut Random::new(seed);
    let family = FAMILIES[random.below(FAMILIES.len())];
    let kinds = if seed.is_multiple_of(5) { Kind::Frustum } else { Kind::Any };
    let (solid, exact) = solid_of(random, family, kinds);
    let edges = edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let found = shares(&solid, &grid);
    let room = if family == Family::Huge { 1e-9 } else { 1e-12 };
    assert!(found.worst <= room, "{family:?} {exact:?}: a share leaves 0 to 1 by {:e}", found.worst);
    if is_within_grid(&exact) {
        // All cells are a sixtieth.
        let error = (found.fields[0].iter().sum::<f64>() - volume(&exact) * 60.0).abs();
        assert!(error <= 4e-12, "{family:?} {exact:?}: the sum is off by {error:e} cells");
    }
}
