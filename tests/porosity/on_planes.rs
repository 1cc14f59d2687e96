//! Solids by formula whose surfaces, axes, ends and rims lie in planes, edges and corners of the grid, but for rounding: whatever that decides, parts sum to
//! the whole and faces have the areas of quadrature.

use glam::{DMat3, DVec3};
use voidage_core::grid::Grid;
use voidage_core::solids::quadric::QuadricSolid;
use voidage_tests::effort::cases;
use voidage_tests::quadrature::{Exact, with_chords};
use voidage_tests::quadric::{Shares, shares, true_area, true_volume};
use voidage_tests::random::Random;

type Edges = [Vec<f64>; 3];

/// Rounding, in cells and faces.
const CLOSE: f64 = 1e-11;

/// A number with few digits.
fn round(random: &mut Random, lo: f64, hi: f64) -> f64 {
    let parts = [4.0, 8.0, 10.0, 20.0, 3.0][random.below(5)];
    (random.between(lo, hi) * parts).round() / parts
}

/// Along an axis, half between two or three of them, with few digits, or any.
fn direction(random: &mut Random) -> DVec3 {
    const GIVEN: [[f64; 3]; 7] = [
        [1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 1.0, 1.0],
        [2.0, 1.0, 2.0],
        [3.0, 4.0, 0.0],
        [5.0, 1.0, 0.0],
    ];
    let Some(given) = GIVEN.get(random.below(GIVEN.len() + 3)) else { return DVec3::from_array(random.on_sphere()) };
    let turn = random.below(3);
    let signs = DVec3::from_array([0, 1, 2].map(|_| [1.0, -1.0][random.below(2)]));
    DVec3::new(given[turn], given[(turn + 1) % 3], given[(turn + 2) % 3]) * signs
}

/// A unit vector across another one, often along a plane of the grid.
fn aside(random: &mut Random, unit: DVec3) -> DVec3 {
    let near = if random.below(3) == 0 { DVec3::from_array(random.on_sphere()) } else { DVec3::AXES[random.below(3)] };
    let across = if random.below(2) == 0 { near.reject_from_normalized(unit) } else { near.cross(unit) };
    if across.length() > 0.1 { across.normalize() } else { unit.any_orthonormal_vector() }
}

/// A solid, a point on it or in the plane of an end, and how far it reaches from its first centre along each axis.
struct Placed {
    exact: Exact,
    centers: [DVec3; 2],
    point: DVec3,
    reach: DVec3,
}

fn placed(random: &mut Random) -> Placed {
    let from = DVec3::from_array([0, 1, 2].map(|_| round(random, -1.0, 1.0)));
    let radius = round(random, 0.1, 0.7).max(0.1);
    let axis = direction(random) * [0.25, 0.5, 1.0, 0.3, 0.7][random.below(5)];
    match random.below(6) {
        kind @ 0..2 => round_about(random, from, radius, (kind == 1).then_some(axis)),
        kind => along(random, [from, from + axis], radius, kind),
    }
}

/// A ball, or an ellipsoid with an axis.
fn round_about(random: &mut Random, center: DVec3, radius: f64, axis: Option<DVec3>) -> Placed {
    let side = if random.below(3) == 0 { DVec3::from_array(random.on_sphere()) } else { direction(random).normalize() };
    let Some(axis) = axis else {
        let point = center + side * [0.0, radius, radius, 0.5 * radius][random.below(4)];
        return Placed { exact: Exact::Ball(center, radius), centers: [center; 2], point, reach: DVec3::splat(radius) };
    };
    let a = axis.normalize();
    let b = aside(random, a);
    let turn = if random.below(2) == 0 { DMat3::IDENTITY } else { DMat3::from_cols(a, b, a.cross(b)) };
    let half = [radius, radius * [0.5, 0.9][random.below(2)], radius * random.between(0.3, 1.5)];
    let axes = [0, 1, 2].map(|n| turn.col(n) * half[n]);
    let out = axes[0] * side.x + axes[1] * side.y + axes[2] * side.z;
    let reach = DVec3::from_array([0, 1, 2].map(|n| DVec3::new(axes[0][n], axes[1][n], axes[2][n]).length()));
    let point = center + out * [0.0, 1.0, 1.0, 0.5][random.below(4)];
    Placed { exact: Exact::Ellipsoid(center, axes), centers: [center; 2], point, reach }
}

/// A pipe, capsule, cone or truncated cone.
fn along(random: &mut Random, centers: [DVec3; 2], radius: f64, kind: usize) -> Placed {
    let [a, b] = centers;
    let unit = (b - a).normalize();
    let (out, share) = (aside(random, unit), [0.0, 1.0, 0.5, 0.25, random.unit()][random.below(5)]);
    let taper = [0.5, 0.25, 1.5, 0.9, random.between(0.1, 2.0)][random.below(5)];
    let (exact, other) = match kind {
        2 => (Exact::Cylinder(a, b, radius), radius),
        3 => (Exact::Capsule(a, b, radius), radius),
        4 => (Exact::Cone(a, b, radius), 0.0),
        _ => (Exact::Frustum(a, b, [radius, radius * taper]), radius * taper),
    };
    let point = match random.below(8) {
        0 => a,
        1 => a + (b - a) * share,
        2 => a + out * (radius * [0.5, 1.3, 2.0][random.below(3)]),
        3 if kind == 3 => a + (out * 0.6 - unit * 0.8) * radius,
        3 => a + out * radius,
        _ => a + (b - a) * share + out * (radius + (other - radius) * share),
    };
    let reach = DVec3::from_array(unit.to_array().map(|along| radius * (1.0 - along * along).max(0.0).sqrt()));
    Placed { exact, centers, point, reach }
}

fn solid_of(exact: &Exact) -> QuadricSolid {
    let solid = match *exact {
        Exact::Ball(center, radius) => QuadricSolid::ball(center, radius),
        Exact::Ellipsoid(center, axes) => QuadricSolid::ellipsoid(center, axes),
        Exact::Cylinder(a, b, radius) => QuadricSolid::cylinder(a, b, radius),
        Exact::Capsule(a, b, radius) => QuadricSolid::capsule(a, b, radius),
        Exact::Cone(a, b, radius) => QuadricSolid::cone(a, b, radius),
        Exact::Frustum(a, b, radii) => QuadricSolid::truncated_cone(a, b, radii),
    };
    solid.expect("a solid of ordinary size")
}

/// Edges of two cells along each axis; those between the two pass through the point along some axes, and may touch the solid.
fn edges_at(random: &mut Random, placed: &Placed) -> Edges {
    let through = random.below(8) | if random.below(2) == 0 { 7 } else { 0 };
    [0, 1, 2].map(|n| {
        let middle = match random.below(10) {
            0 => placed.centers[0][n] - placed.reach[n],
            1 => placed.centers[0][n] + placed.reach[n],
            2 => placed.centers[1][n],
            _ if through >> n & 1 == 1 => placed.point[n],
            _ => round(random, -1.2, 1.2),
        };
        let mut width = || [0.5, 1.0, 0.25, random.between(0.1, 1.5), random.between(0.1, 1.5)][random.below(5)];
        vec![middle - width(), middle, middle + width()]
    })
}

fn grid(edges: &Edges) -> Grid<'_, f64> {
    Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid")
}

/// What a cell (field 0), or a face across axis `field - 1`, has along each axis; along that axis nothing.
fn sides(edges: &Edges, field: usize, place: usize) -> [[f64; 2]; 3] {
    let grid = grid(edges);
    let shape = if field == 0 { grid.cells() } else { grid.face_shape(field - 1) };
    let at = [place % shape[0], place / shape[0] % shape[1], place / shape[0] / shape[1]];
    [0, 1, 2].map(|n| [edges[n][at[n]], edges[n][at[n] + usize::from(field != n + 1)]])
}

fn size(sides: &[[f64; 2]; 3]) -> f64 {
    sides.iter().map(|[lo, hi]| hi - lo).filter(|width| *width > 0.0).product()
}

/// By how much the parts of a cell or face do not sum to it, where the middle edges along some axes are left out.
fn unlike_sums(exact: &Exact, fine: &Shares, edges: &Edges, without: usize) -> f64 {
    let mut coarse = edges.clone();
    for n in 0..3 {
        if without >> n & 1 == 1 {
            coarse[n].remove(1);
        }
    }
    let found = shares(&solid_of(exact), &grid(&coarse));
    let mut worst = found.worst;
    for field in 0..4 {
        let parts: Vec<([[f64; 2]; 3], f64)> =
            fine.fields[field].iter().enumerate().map(|(n, share)| (sides(edges, field, n), *share)).collect();
        for (n, share) in found.fields[field].iter().enumerate() {
            let whole = sides(&coarse, field, n);
            let within = |part: &[[f64; 2]; 3]| (0..3).all(|n| whole[n][0] <= part[n][0] && part[n][1] <= whole[n][1]);
            let sum: f64 = parts.iter().filter(|(part, _)| within(part)).map(|(part, share)| share * size(part)).sum();
            worst = worst.max((sum / size(&whole) - share).abs());
        }
    }
    worst
}

/// By how much the share of a cell or face is not that of quadrature, if that comes to an end. A plane that all but touches a solid may be beside it.
fn unlike_quadrature(exact: &Exact, found: &Shares, edges: &Edges, [field, place]: [usize; 2]) -> Option<f64> {
    let (sides, share) = (sides(edges, field, place), found.fields[field][place]);
    let [lo, hi] = [0, 1].map(|end| DVec3::from_array(sides.map(|side| side[end])));
    let off = with_chords(if field == 0 { 100_000_000 } else { 2_000_000 }, || {
        if field == 0 {
            return share - true_volume(exact, [lo, hi], share) / size(&sides);
        }
        let (n, u, v) = (field - 1, field % 3, (field + 1) % 3);
        let area = |by: f64| true_area(exact, n, sides[n][0] + by, [sides[u], sides[v]], share) / size(&sides);
        let truth = area(0.0);
        if (share - truth).abs() <= CLOSE {
            return 0.0;
        }
        let [least, most] = [area(-1e-13), area(1e-13)]
            .map(|a| [a.min(truth), a.max(truth)])
            .into_iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], [a, b]| [least.min(a), most.max(b)]);
        (least - share).max(share - most).max(0.0)
    });
    off.map(f64::abs)
}

/// Corners, edges and planes of the grid on the surface of a solid, on its axis, in the planes of its ends and on their rims.
#[test]
fn parts_sum_to_the_whole_where_the_grid_meets_the_surface() {
    for seed in 0..6000 {
        let random = &mut Random::new(seed);
        let placed = placed(random);
        let edges = edges_at(random, &placed);
        let found = shares(&solid_of(&placed.exact), &grid(&edges));
        let worst = (1..8).map(|n| unlike_sums(&placed.exact, &found, &edges, n)).fold(found.worst, f64::max);
        assert!(worst <= CLOSE, "seed {seed}: {worst:e}, {:?} {edges:?}", placed.exact);
    }
}

#[test]
fn faces_have_their_areas_where_the_grid_meets_the_surface() {
    let mut known = 0;
    for seed in 0..3000 {
        let random = &mut Random::new(seed);
        let placed = placed(random);
        let edges = edges_at(random, &placed);
        let found = shares(&solid_of(&placed.exact), &grid(&edges));
        let field = 1 + random.below(3);
        let place = random.below(found.fields[field].len());
        let Some(off) = unlike_quadrature(&placed.exact, &found, &edges, [field, place]) else { continue };
        assert!(off <= CLOSE, "seed {seed}: {off:e} at {place} of {field}, {:?} {edges:?}", placed.exact);
        known += 1;
    }
    assert!(known > 2900, "{known} faces");
}

/// Pipes with a grid corner on their side or in the plane of an end, of which a whole ellipse of a face was too much, or an end was not seen; by
/// quadrature.
#[test]
fn known_cells_with_a_corner_on_the_surface() {
    let pipe = |a: [f64; 3], b: [f64; 3], r: f64| Exact::Cylinder(DVec3::from_array(a), DVec3::from_array(b), r);
    let on_side = pipe([0.5, 1.75, 0.75], [1.0, 2.0, 1.25], 0.25);
    let end = pipe([1.25, 0.0, 0.75], [5.25, 4.0, 4.75], 0.25);
    for (exact, edges) in [
        (on_side, [vec![0.6, 1.1], vec![1.0, 2.0], vec![0.5, 1.0]]),
        (end, [vec![0.5, 1.5], vec![-0.5, 0.6], vec![0.0, 1.0]]),
    ] {
        let found = shares(&solid_of(&exact), &grid(&edges));
        for place in [[0, 0], [1, 0], [1, 1], [2, 0], [2, 1], [3, 0], [3, 1]] {
            let off = unlike_quadrature(&exact, &found, &edges, place).expect("a quadrature that ends");
            assert!(off <= CLOSE, "{exact:?} {place:?}: {off:e}");
        }
    }
    let lying = pipe([0.4, 0.3, 0.27], [2.4, 4.3, 0.27], 0.2);
    let wide = |lo: i32, hi: i32| (lo..=hi).map(|i| f64::from(i) * 0.5).collect::<Vec<_>>();
    let found = shares(&solid_of(&lying), &grid(&[wide(-2, 6), wide(-4, 10), vec![-0.23, 0.07]]));
    let below = found.fields.iter().flatten().copied().fold(0.0, f64::max);
    assert!(below < 1e-7, "{below} below a pipe");
}

/// Slices of 10⁻⁵ to 10⁻¹⁰, through solids and beside the ends of aligned ones: the mean of their sections. By the fluxes through their faces alone they were
/// off by as much as rounding in shares of their width, 10⁻⁶.
#[test]
fn thin_cells_have_the_mean_of_their_sections() {
    let mut cut = 0;
    for seed in 0..cases(2000) as u64 {
        let random = &mut Random::new(seed);
        let exact = placed(random).exact;
        let (n, width) = (random.below(3), 10_f64.powf(random.between(-10.0, -5.0)));
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        let mut edges = [0, 1, 2].map(|_| vec![random.between(-1.5, 0.0), random.between(0.0, 1.5)]);
        let low = random.between(-1.0, 1.0);
        edges[n] = vec![low, low + width];
        let found = shares(&solid_of(&exact), &grid(&edges));
        let share = found.fields[0][0];
        let window = [[edges[u][0], edges[u][1]], [edges[v][0], edges[v][1]]];
        let whole = (window[0][1] - window[0][0]) * (window[1][1] - window[1][0]);
        // Gauss, two points.
        let at = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9].map(|t| low + t * (edges[n][1] - low));
        let truth = at.map(|at| true_area(&exact, n, at, window, share) / whole).iter().sum::<f64>() * 0.5;
        assert!(
            (share - truth).abs() <= CLOSE && found.worst <= CLOSE,
            "seed {seed}: {share} not {truth}, {exact:?} {edges:?}"
        );
        cut += usize::from(truth > 0.0 && truth < 1.0);
    }
    assert!(cut * 4 > cases(2000), "{cut} slices");
    // A half ball of a capsule ends in the plane, and the pipe above it begins there.
    let capsule = Exact::Capsule(DVec3::new(0.75, 0.45, 0.75), DVec3::new(0.75, 0.45, 1.75), 0.25);
    let found =
        shares(&solid_of(&capsule), &grid(&[vec![0.25, 0.75], vec![0.2, 0.45], vec![0.75 - 1e-9, 0.75, 0.75 + 1e-9]]));
    let quarter = std::f64::consts::PI / 64.0 / (0.5 * (0.45 - 0.2));
    assert!(
        found.fields[0].iter().all(|share| (share - quarter).abs() <= CLOSE),
        "{:?}, not {quarter}",
        found.fields[0]
    );
}

/// Pipes and cones whose axis misses one of the grid by an ulp of its coordinates: flat ends in planes of the grid block them whole.
#[test]
fn ends_of_axes_that_are_off_by_an_ulp() {
    let edges: Edges = [vec![-1.0, 0.0, 1.0, 2.0], vec![-1.0, 20.0], vec![-1.0, 20.0]];
    for place in [0.0_f64, 0.37, 7.3, 0.1] {
        let beside = if place == 0.0 { 6.123_233_995_736_766e-17 } else { f64::from_bits(place.to_bits() + 1) };
        for (from, to) in [(place, beside), (beside, place)] {
            let ends = [DVec3::new(0.0, from, 0.21), DVec3::new(1.0, to, 0.21)];
            let disc = std::f64::consts::PI * 0.09;
            let solids = [
                QuadricSolid::cylinder(ends[0], ends[1], 0.3),
                QuadricSolid::cylinder(ends[1], ends[0], 0.3),
                QuadricSolid::truncated_cone(ends[0], ends[1], [0.3, 0.29]),
            ];
            for (solid, last) in solids.into_iter().zip([0.09, 0.09, 0.0841]) {
                let found = shares(&solid.expect("a solid"), &grid(&edges));
                let faces: Vec<f64> = found.fields[1].iter().map(|share| share * 441.0).collect();
                let expected = [0.0, disc, std::f64::consts::PI * last, 0.0];
                let near = faces.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-11);
                assert!(near, "{place} {from} {to}: {faces:?}");
            }
        }
    }
}

/// Shares of thin boxes, and of those small beside the solid, are within what they say to be off by.
#[test]
fn shares_of_thin_boxes_are_within_their_bounds() {
    use voidage_core::solids::enclosure::{BoxAround, Enclosed};
    let random = &mut Random::new(2311);
    for n in 0..cases(4000) {
        let radius = if random.below(2) == 0 { random.between(10.0, 1000.0) } else { random.between(0.3, 3.0) };
        let out = DVec3::from_array(random.on_sphere());
        let along = out.any_orthonormal_vector();
        let low = DVec3::from_array([0, 1, 2].map(|_| random.between(-0.5, 0.0)));
        let width = |random: &mut Random| match random.below(5) {
            0 => 10_f64.powf(random.between(-4.0, -1.0)),
            _ => random.between(0.1, 1.0),
        };
        let high = low + DVec3::from_array([0, 1, 2].map(|_| width(random)));
        let center = out * (random.between(-0.3, 0.3) - radius);
        let solid = match n % 4 {
            0 => QuadricSolid::ball(center, radius),
            1 => QuadricSolid::cylinder(center - along * 3.0, center + along * 3.0, radius),
            2 => QuadricSolid::capsule(center, center + along, radius),
            _ => {
                let [a, b] = [0, 1].map(|_| radius * random.between(0.5, 2.0));
                QuadricSolid::ellipsoid(center, [out * radius, along * a, out.cross(along) * b])
            }
        };
        let solid = solid.expect("a solid");
        let share = |low: DVec3, high: DVec3| solid.share(&BoxAround::new([0, 1, 2].map(|k| [low[k], high[k]])));
        let whole = share(low, high);
        let cut = DVec3::from_array([0, 1, 2].map(|k| random.between(low[k], high[k])));
        let (mut least, mut most) = (0.0, 0.0);
        for part in 0..8 {
            let above = [0, 1, 2].map(|k| part >> k & 1 == 1);
            let pick = |k: usize, a: DVec3, b: DVec3| if above[k] { a[k] } else { b[k] };
            let from = DVec3::from_array([0, 1, 2].map(|k| pick(k, cut, low)));
            let to = DVec3::from_array([0, 1, 2].map(|k| pick(k, high, cut)));
            let (weight, found) = (((to - from) / (high - low)).element_product(), share(from, to));
            (least, most) = (least + found.lower * weight, most + found.upper * weight);
        }
        assert!(least <= whole.upper && whole.lower <= most, "{solid:?} {low} {high} {cut}: {whole:?} {least} {most}");
    }
}
