//! Solids by closed forms, tori by quadrature, and solids as bodies of a layer.

use glam::{DVec3, Vec3};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::grid::bounds::Bounds;
use voidage_core::grid::fields::{Fields, Layer};
use voidage_core::grid::{Grid, cell_range::RangeKind};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::solids::quadric::{AsQuadric, QuadricSolid, excess, share_of_union};
use voidage_core::solids::torus::{TorusShape, TorusSolid};
use voidage_core::solids::{RoundMemory, RoundShape, RoundSolid, RoundSolids};
use voidage_core::subdivide::{Candidate, LeafRule, SubdivisionMemory, SubdivisionRule};
use voidage_core::surface::OtherBodies;

/// What a visitor of shares is told, and what it is not told, as one number.
fn told(kind: RangeKind, at: usize, share: f64) -> usize {
    let axis = match kind {
        RangeKind::Cells => 3,
        RangeKind::Faces(axis) => axis,
    };
    axis ^ at ^ share as usize
}

/// Every solid by closed forms, in layers, planes and pairs.
fn quadrics<V: Vector>(grid: &Grid<V::Scalar>, p: [V; 3], r: [V::Scalar; 2], cell: [[f64; 2]; 3], k: usize) -> usize {
    let [a, b, c] = p;
    let ellipsoid = Ellipsoid { center: a, semi_axes: b };
    let solids = [
        QuadricSolid::ball(a, r[0]),
        QuadricSolid::cylinder(a, b, r[0]),
        QuadricSolid::capsule(a, b, r[0]),
        QuadricSolid::cone(a, b, r[0]),
        QuadricSolid::truncated_cone(a, b, r),
        QuadricSolid::ellipsoid(a, p),
        Transformed::new(ellipsoid, p, b, c).quadric(),
    ];
    let mut sum = 0;
    for solid in solids.iter().flatten() {
        let worst = solid.layer(grid, k, r[0] > r[1], &mut |kind, at, share| sum ^= told(kind, at, share));
        solid.plane(grid, k, &mut |kind, at, share| sum ^= told(kind, at, share));
        sum ^= worst as usize ^ solid.ends_in_plane(k, worst).count();
    }
    let [enough, tol] = r.map(Real::to_f64);
    let excess = excess(solids.iter().flatten(), cell, enough).map_or(1, |[low, high]| (low + high) as usize);
    let sum_of_shares = Bounds { lower: enough, upper: tol };
    let union =
        share_of_union(solids.iter().flatten(), cell, sum_of_shares, tol, k).map_or(2, |found| found.lower as usize);
    sum ^ excess ^ union
}

/// A torus or a part of one.
fn torus<V: Vector>(grid: &Grid<V::Scalar>, p: [V; 3], r: [V::Scalar; 2], cell: [[f64; 2]; 3], k: usize) -> usize {
    let shape = TorusShape { center: p[0], axis: p[1], start: p[2], radius: r[0], tube: r[1], angle: cell[0][0] };
    let Some(solid) = TorusSolid::new(&shape) else { return 3 };
    let mut sum = 0;
    let worst = solid.layer(grid, k, r[0] > r[1], &mut |kind, at, share, error| sum ^= told(kind, at, share + error));
    solid.plane(grid, k, &mut |kind, at, share, error| sum ^= told(kind, at, share + error));
    let (lo, hi) = (cell.map(|side| side[0]), cell.map(|side| side[1]));
    let of_cell = solid.share(RangeKind::Cells, lo, hi).0;
    let pieces = solid.pieces(k as u32).map(|piece| piece.share(RangeKind::Faces(k), lo, hi).0).sum::<f64>();
    let ends = solid.ends().map(|(center, inward, radius)| center[0] + inward[0] + radius).sum::<f64>();
    let places = solid.middle()[0] + solid.size() + solid.outermost(lo)[0] + solid.extent(k)[0];
    sum ^ (worst + of_cell + pieces + ends + places) as usize ^ usize::from(solid.may_reach(lo, hi))
}

/// Solids of all kinds as bodies of a layer, in a layer's fields.
fn solids<V: Vector>(grid: &Grid<V::Scalar>, p: [V; 3], r: [V::Scalar; 2], k: usize) -> usize {
    let ([a, b, c], [radius, tol]) = (p, r);
    let shapes = [
        RoundShape::Sphere(Sphere { center: a, radius }),
        RoundShape::Ellipsoid(Transformed::new(Ellipsoid { center: a, semi_axes: b }, p, b, c)),
        RoundShape::Capsule(Capsule { from: a, to: b, radius }),
        RoundShape::Cylinder(Cylinder::new(a, b, radius)),
        RoundShape::Cone(Cone::new(a, b, radius)),
    ];
    let made = shapes.map(RoundSolid::new);
    let [Some(one), Some(two), Some(three), Some(four), Some(five)] = made else { return 4 };
    let solids = [one, two, three, four, five];
    let (mut sums, mut owners, mut near) = ([V::Scalar::ZERO; 99], [0; 99], [RoundShape::default(); 9]);
    let (mut candidates, mut facets) = ([Candidate::default(); 99], [0; 99]);
    let lists = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
    let memory = RoundMemory { sums: &mut sums, owners: &mut owners, near: &mut near, lists };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: k as u32, tol };
    let needed = RoundSolids::<V>::needed(grid, k);
    let of = solids.get(k..).unwrap_or(&solids);
    let Ok(mut bodies) = RoundSolids::new(grid, of, rule, memory) else { return needed.places };
    let (mut lower, mut sum, mut flags) = ([V::Scalar::ZERO; 99], [V::Scalar::ZERO; 99], [0; 99]);
    let fields = (Fields::within(grid, &mut lower), Fields::within(grid, &mut sum), Fields::within(grid, &mut flags));
    let (Ok(lower), Ok(sum), Ok(flags)) = fields else { return 5 };
    let Ok(mut layer) = Layer::new(lower, sum, flags) else { return 6 };
    bodies.add(grid, k, radius > tol, &mut layer);
    bodies.add_plane(grid, k, &mut layer);
    let reached = bodies.reach(Aabb { min: a, max: b });
    let boxes = bodies.boxes().filter(|b| b.is_empty()).count();
    usize::from(reached || bodies.is_empty()) ^ boxes ^ bodies.queries().queries as usize
}

fn asked<V: Vector>(edges: &[V::Scalar], p: [V; 3], r: [V::Scalar; 2], cell: [[f64; 2]; 3], k: usize) -> usize {
    let Ok(grid) = Grid::new(edges, edges, edges) else { return 7 };
    quadrics(&grid, p, r, cell, k) ^ torus(&grid, p, r, cell, k) ^ solids(&grid, p, r, k)
}

/// In double precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_round_f64(
    edges: &[f64; 9],
    n: usize,
    p: &[DVec3; 3],
    r: &[f64; 2],
    cell: &[[f64; 2]; 3],
) -> usize {
    asked(edges.get(..n).unwrap_or(edges), *p, *r, *cell, n)
}

/// In single precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_round_f32(
    edges: &[f32; 9],
    n: usize,
    p: &[Vec3; 3],
    r: &[f32; 2],
    cell: &[[f64; 2]; 3],
) -> usize {
    asked(edges.get(..n).unwrap_or(edges), *p, *r, *cell, n)
}
