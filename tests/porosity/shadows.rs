//! Shadows in cells: boxes by coordinate compression, convex bodies by a closed relation, anything by lines, walls that no face sees.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::shadows::{cells, faces_of_cell};
use voidage::porosity::{Options, Porosity, porosity, throat};
use voidage_core::grid::Grid;
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::layer::{
    AreaSlices, CellSides, LayerMemory, LayerOptions, LayerSlices, Layers, OpenLayer, ShadowReport,
};
use voidage_core::surface::shadow::{ShadowEdge, ShadowFace, ShadowMemory, ShadowSlices};
use voidage_core::surface::surface_area::{CellSurface, KeptPiece, KeptPieces, PieceMemory, SurfaceCell};
use voidage_core::surface::union::UnionMemory;
use voidage_tests::fields::assert_close;
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, scene, turned_box};

fn edges(cells: usize, lo: f64, hi: f64) -> Edges {
    let axis: Vec<f64> = (0..=cells).map(|n| lo + (hi - lo) * n as f64 / cells as f64).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

fn found(edges: &Edges, bodies: &Bodies) -> (Porosity, Resistance) {
    let (grid, options) = (edges.grid(None).expect("a grid"), Options { resistance: true, ..Options::default() });
    let result = porosity(&grid, bodies, options);
    let resistance = resistance(&grid, bodies, &result, options);
    (result, resistance)
}

/// Solid shares of the two faces of a cell along an axis.
fn blocked(grid: &Grid<f64>, result: &Porosity, axis: usize, at: [usize; 3]) -> [f64; 2] {
    let beta = [&result.beta.x, &result.beta.y, &result.beta.z][axis];
    faces_of_cell(grid, axis, at).map(|face| 1.0 - beta[face])
}

/// Area of a union of rectangles.
fn area_of_union(rectangles: &[[[f64; 2]; 2]]) -> f64 {
    let sorted = |axis: usize| {
        let mut all: Vec<f64> = rectangles.iter().flat_map(|r| r[axis]).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let (u, v) = (sorted(0), sorted(1));
    let mut area = 0.0;
    for u in u.windows(2) {
        for v in v.windows(2) {
            let holds = |r: &[[f64; 2]; 2]| r[0][0] <= u[0] && u[1] <= r[0][1] && r[1][0] <= v[0] && v[1] <= r[1][1];
            if rectangles.iter().any(holds) {
                area += (u[1] - u[0]) * (v[1] - v[0]);
            }
        }
    }
    area
}

/// The share of a cell's section that boxes within it cover, seen along an axis.
fn covered_by_boxes(boxes: &[[DVec3; 2]], [lo, hi]: [DVec3; 2], axis: usize) -> f64 {
    let (iu, iv) = ((axis + 1) % 3, (axis + 2) % 3);
    let inside = boxes.iter().map(|[a, b]| (a.max(lo), b.min(hi))).filter(|(a, b)| a.cmplt(*b).all());
    let rectangles: Vec<_> = inside.map(|(a, b)| [[a[iu], b[iu]], [a[iv], b[iv]]]).collect();
    area_of_union(&rectangles) / ((hi[iu] - lo[iu]) * (hi[iv] - lo[iv]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Boxes that overlap, touch, hold each other and lie in planes of the grid, half-way between and anywhere; far from the origin too.
    #[test]
    fn boxes_cast_the_shadow_of_their_union(
        boxes in prop::collection::vec((prop::array::uniform3(0_u8..9), prop::array::uniform3(1_u8..6)), 1..8),
        cells_along in 2_usize..6,
        on_planes in any::<bool>(),
        far in any::<bool>(),
    ) {
        let offset = DVec3::splat(if far { 4096.0 } else { 0.0 });
        let half = |p: &[u8; 3]| DVec3::from_array(p.map(|c| f64::from(c) * 0.5));
        let boxes: Vec<[DVec3; 2]> =
            boxes.iter().map(|(lo, size)| [offset + half(lo), offset + half(lo) + half(size)]).collect();
        let (lo, hi) = if on_planes { (0.0, 7.0) } else { (-0.317, 7.41) };
        let edges = edges(if on_planes { 7 } else { cells_along }, offset.x + lo, offset.x + hi);
        let bodies = scene(&boxes.iter().map(|[a, b]| cuboid(*a, *b)).collect::<Vec<_>>());
        let (result, found) = found(&edges, &bodies);
        let grid = edges.grid(None).expect("a grid");
        for (n, at) in cells(&grid).enumerate() {
            let cell = grid.cell_box(at).expect("a cell");
            for axis in 0..3 {
                let tau = found.shadows.tau[axis][n];
                let [low, high] = blocked(&grid, &result, axis, at);
                let seen = covered_by_boxes(&boxes, [cell.min, cell.max], axis).max(low).max(high);
                let truth = if result.beta.v[n] > 0.0 { seen } else { 1.0 };
                prop_assert!((tau - truth).abs() < 1e-11, "cell {at:?}, axis {axis}: {tau}, {truth}, {boxes:?}");
            }
        }
        prop_assert_eq!(found.shadows.inexact, ShadowReport::default());
    }
}

/// A turned box by its centre, half sides and turn.
struct Turned(DVec3, DVec3, DMat3);

impl Turned {
    fn random(random: &mut Random, size: f64) -> Self {
        let half = DVec3::from_array([0; 3].map(|_| size * random.between(0.05, 1.0)));
        Turned(random.point(DVec3::splat(0.2), DVec3::splat(2.8)), half, random.turn())
    }

    fn triangles(&self) -> Vec<Triangle> {
        turned_box(self.0, self.1, self.2)
    }

    /// Does the line along `axis` through `p` meet it between two coordinates?
    fn meets(&self, p: DVec3, axis: usize, [lo, hi]: [f64; 2]) -> bool {
        let inverse = self.2.transpose();
        let (q, d) = (inverse * (p - self.0), inverse * DVec3::AXES[axis]);
        let (mut start, mut end) = (lo - p[axis], hi - p[axis]);
        for a in 0..3 {
            let [s, t] = [-self.1[a], self.1[a]].map(|side| (side - q[a]) / d[a]);
            (start, end) = (start.max(s.min(t)), end.min(s.max(t)));
        }
        start < end
    }
}

/// A line enters a convex body once: its shadow is the mean blockage of the faces and the frontal area.
#[test]
fn of_one_convex_body_the_frontal_area_tells() {
    let mut random = Random::new(5);
    for _ in 0..40 {
        let (edges, body) = (edges(4, 0.0, 3.0), Turned::random(&mut random, 1.5));
        let (result, found) = found(&edges, &scene(&[body.triangles()]));
        let grid = edges.grid(None).expect("a grid");
        for (n, at) in cells(&grid).enumerate().filter(|(n, _)| result.beta.v[*n] > 0.0) {
            for axis in 0..3 {
                let [low, high] = blocked(&grid, &result, axis, at);
                let truth = found.a[axis][n] * 0.75 + (low + high) / 2.0;
                let tau = found.shadows.tau[axis][n];
                assert!((tau - truth).abs() < 1e-11, "{at:?} along {axis}: {tau} and {truth}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Boxes turned about the line of sight, in layers of one cell each: the area that they cover does not turn with them.
    #[test]
    fn boxes_turned_about_the_line_of_sight(
        boxes in prop::collection::vec((prop::array::uniform3(0_u8..9), prop::array::uniform3(1_u8..6)), 1..9),
        angle in 0.01_f64..1.5,
        layers in 1_usize..7,
        axis in 0_usize..3,
        thickness in prop::sample::select(vec![1.0, 1.0 / 128.0]),
    ) {
        let half = |p: &[u8; 3]| DVec3::from_array(p.map(|c| f64::from(c) * 0.5)) - DVec3::splat(3.0);
        let boxes: Vec<[DVec3; 2]> = boxes.iter().map(|(lo, size)| {
            let (lo, mut size) = (half(lo), DVec3::from_array(size.map(|c| f64::from(c) * 0.5)));
            size[(axis + 1) % 3] *= thickness;
            [lo, lo + size]
        }).collect();
        let turn = DMat3::from_axis_angle(DVec3::AXES[axis], angle);
        let solids: Vec<Vec<Triangle>> =
            boxes.iter().map(|[a, b]| cuboid(*a, *b).iter().map(|t| t.map(|p| turn * p)).collect()).collect();
        let mut edges = Edges([0; 3].map(|_| vec![-9.0, 9.0]));
        edges.0[axis] = (0..=layers).map(|n| -5.137 + 10.4 * n as f64 / layers as f64).collect();
        let (_, found) = found(&edges, &scene(&solids));
        for (n, ends) in edges.0[axis].windows(2).enumerate() {
            let mut cell = [DVec3::splat(-9.0), DVec3::splat(9.0)];
            (cell[0][axis], cell[1][axis]) = (ends[0], ends[1]);
            let truth = covered_by_boxes(&boxes, cell, axis);
            let tau = found.shadows.tau[axis][n];
            prop_assert!((tau - truth).abs() < 1e-11, "layer {n} along {axis}: {tau}, {truth}, {boxes:?}");
        }
    }
}

/// Two plates of one body, however near: what lies behind the slit does not count again.
#[test]
fn a_slit_within_a_body() {
    let edges = edges(1, 0.0, 1.0);
    for turn in [0.0, 0.3] {
        let turn = DMat3::from_rotation_x(turn);
        let plate = |lo: f64, hi: f64| {
            turned_box(DVec3::new((lo + hi) / 2.0, 0.5, 0.5), DVec3::new((hi - lo) / 2.0, 0.3, 0.2), turn)
        };
        for gap in [0.2, 1e-3, 1e-9, 1e-13, 1e-14, 1e-15, 2.3e-16] {
            let body = [plate(0.2, 0.5), plate(0.5 + gap, 0.8)].concat();
            let (_, found) = found(&edges, &scene(&[body]));
            let tau = found.shadows.tau[0][0];
            assert!((tau - 0.24).abs() < 1e-12, "{gap}: {tau}");
        }
    }
}

/// Frontal areas and shadows of the cells of a single layer, in the precision of the triangles, with room for so many pieces of surface.
fn in_one_layer<V: Vector>(edges: &[V::Scalar], body: Surface<V>, room: usize) -> Vec<[f64; 6]> {
    let zero = V::Scalar::ZERO;
    let ends = [edges[0], edges[edges.len() - 1]];
    let (grid, bodies) = (Grid::new(edges, edges, &ends).expect("a grid"), [body]);
    let needed = Layers::needed(&grid, &bodies);
    let (mut numbers, mut groups) = (vec![0; needed.numbers], vec![Group::default(); needed.groups]);
    let layers = Layers::new(&grid, &bodies, LayerOptions::default(), &mut numbers, &mut groups).expect("memory");
    let (needed, cells) = (layers.memory_needed(), grid.cell_count());
    let (mut reals, mut flags) = (vec![zero; needed.reals], vec![0; needed.flags]);
    let union = UnionMemory::default();
    let mut memory = LayerMemory::new(&grid, &mut reals, &mut flags, &mut [], &mut [], union).expect("memory");
    let field = |axis: usize| vec![zero; grid.face_shape(axis).iter().product()];
    let (mut v, [mut x, mut y, mut z]) = (vec![zero; cells], [field(0), field(1), field(2)]);
    let beta = LayerSlices::of_fields(&grid, 0, &mut v, [&mut x, &mut y, &mut z]).expect("slices");
    let (mut union, mut sides) = (vec![SurfaceCell::default(); cells], vec![CellSides::default(); cells]);
    let mut surface = vec![CellSurface::default(); cells];
    let (mut numbers, mut pieces) = (vec![0; cells], vec![KeptPiece::default(); room]);
    let mut corners = vec![[zero; 3]; 5 * room];
    let memory_of_pieces = PieceMemory { pieces: &mut pieces, corners: &mut corners };
    let areas = AreaSlices {
        union: &mut union,
        sides: &mut sides,
        cells: &mut surface,
        numbers: &mut numbers,
        pieces: memory_of_pieces,
        fractions_known: false,
    };
    let (_, report) = layers.layer_and_areas(0, beta, None, areas, &mut memory, |_, _| ()).expect("a layer");
    let (bottom, top) = z.split_at(cells);
    let open = OpenLayer { cell: &v, x: &x, y: &y, z: bottom, top };
    let (sides, union) = (&sides[..report.sides], &mut union[..report.cells]);
    layers.finish_areas(0, &open, sides, union).expect("areas");
    let (mut edges, mut places) = (vec![ShadowEdge::default(); 9999], vec![0; 3333]);
    let (mut lists, mut faces) = (vec![0; layers.shadow_lists_needed(0)], vec![ShadowFace::default(); 999]);
    let memory = ShadowMemory { edges: &mut edges, places: &mut places, lists: &mut lists, faces: &mut faces };
    let (mut share, mut place) = ([0; 3].map(|_| vec![zero; cells]), [0; 3].map(|_| vec![zero; cells]));
    let slices =
        ShadowSlices { share: share.each_mut().map(|f| &mut f[..]), place: place.each_mut().map(|f| &mut f[..]) };
    let kept = KeptPieces { cells: union, pieces: &pieces, corners: &corners };
    assert_eq!(layers.shadows(0, &open, (kept, sides), slices, memory), Ok(ShadowReport::default()));
    let of = |c: usize| {
        let own = union.iter().find(|own| own.cell as usize == c);
        let ([a, b, c_], [x, y, z]) = (own.map_or([zero; 3], |own| own.area.frontal), share.each_ref().map(|f| f[c]));
        [a, b, c_, x, y, z].map(Real::to_f64)
    };
    (0..cells).map(of).collect()
}

/// Single precision finds what double precision does, to its own rounding.
#[test]
fn in_single_precision() {
    let mut random = Random::new(11);
    let (mut partly, axis) = (0, [0.0, 0.9, 2.1, 3.0]);
    for _ in 0..30 {
        let body = Turned::random(&mut random, 1.2).triangles();
        let single: Vec<[Vec3; 3]> = body.iter().map(|t| t.map(DVec3::as_vec3)).collect();
        let widened: Vec<Triangle> = single.iter().map(|t| t.map(Vec3::as_dvec3)).collect();
        let found = in_one_layer(&axis.map(|e| e as f32), Surface::new(&single), 999);
        let axis = axis.map(|e| f64::from(e as f32));
        let truth = in_one_layer(&axis, Surface::new(&widened), 999);
        // Pieces for which there is no room are cut again.
        for room in [0, 7, 20] {
            let again = in_one_layer(&axis, Surface::new(&widened), room);
            let apart = again.iter().flatten().zip(truth.iter().flatten()).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-13, "{room}");
        }
        for (found, truth) in found.iter().flatten().zip(truth.iter().flatten()) {
            assert!((found - truth).abs() < 3e-5, "{found} {truth}");
            partly += usize::from(*truth > 0.01 && *truth < 0.99);
        }
    }
    assert!(partly > 300, "{partly}");
}

/// Several turned boxes, by lines.
#[test]
fn turned_boxes_against_lines() {
    const LINES: usize = 160;
    let mut random = Random::new(6);
    let mut several = 0;
    for count in [2, 3, 5, 9, 17] {
        let bodies: Vec<Turned> = (0..count).map(|_| Turned::random(&mut random, 0.8)).collect();
        let edges = edges(3, 0.0, 3.0);
        let (result, found) = found(&edges, &scene(&bodies.iter().map(Turned::triangles).collect::<Vec<_>>()));
        let grid = edges.grid(None).expect("a grid");
        for (n, at) in cells(&grid).enumerate().filter(|(n, _)| result.beta.v[*n] > 0.0) {
            let cell = grid.cell_box(at).expect("a cell");
            for axis in 0..3 {
                let (iu, iv) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut met = 0;
                for line in 0..LINES * LINES {
                    let mut p = cell.min;
                    p[iu] += ((line % LINES) as f64 + 0.5) / LINES as f64;
                    p[iv] += ((line / LINES) as f64 + 0.5) / LINES as f64;
                    met += usize::from(bodies.iter().any(|b| b.meets(p, axis, [cell.min[axis], cell.max[axis]])));
                }
                let truth = met as f64 / (LINES * LINES) as f64;
                let tau = found.shadows.tau[axis][n];
                assert!((tau - truth).abs() < 6e-3, "{count} at {at:?} along {axis}: {tau} and {truth}");
                several += usize::from(tau > 0.05 && tau < 0.95);
            }
        }
        assert_eq!(found.shadows.inexact, ShadowReport::default(), "{count}");
    }
    assert!(several > 80, "{several}");
}

/// Needles whose outlines cross more often than is followed: the shadow of a cell is then an estimate. It is the mean over columns of cells, each of
/// which is exact.
#[test]
fn needles_that_cross_too_often() {
    let mut random = Random::new(23);
    let needle = |random: &mut Random| {
        let half = DVec3::new(random.between(0.3, 0.55), 0.002, 0.003);
        Turned(random.point(DVec3::splat(0.6), DVec3::splat(1.4)), half, random.turn()).triangles()
    };
    let bodies = scene(&(0..500).map(|_| needle(&mut random)).collect::<Vec<_>>());
    let whole = edges(1, 0.0, 2.0);
    let (_, estimate) = found(&whole, &bodies);
    assert_eq!(estimate.shadows.inexact, ShadowReport { estimated: 1, too_full: 0 });
    for axis in 0..3 {
        let mut columns = edges(12, 0.0, 2.0);
        columns.0[axis] = whole.0[axis].clone();
        let (_, exact) = found(&columns, &bodies);
        assert_eq!(exact.shadows.inexact, ShadowReport::default());
        let tau = &exact.shadows.tau[axis];
        let (truth, found) = (tau.iter().sum::<f64>() / tau.len() as f64, estimate.shadows.tau[axis][0]);
        assert!(truth > 0.15 && (found - truth).abs() < 1e-4, "along {axis}: {found} {truth}");
    }
}

/// A wall between two planes is told, wherever it lies; in a plane it is blocked already.
#[test]
fn a_thin_wall_is_a_hidden_passage() {
    for (place, expected) in [(0.31, 9), (0.02, 9), (0.9, 9), (0.0, 0)] {
        let wall = cuboid(DVec3::new(1.0 + place, -1.0, -1.0), DVec3::new(1.05 + place, 4.0, 4.0));
        let (_, found) = found(&edges(3, 0.0, 3.0), &scene(&[wall]));
        let hidden = found.shadows.hidden;
        assert_eq!(hidden.map(|h| h.cells), [expected, 0, 0], "{place}");
        assert_eq!(hidden[0].first, (expected > 0).then_some([1, 0, 0]));
        if expected > 0 {
            assert!((0.5 + found.shadows.place[0][1] - place - 0.025).abs() < 1e-12);
            assert_eq!(found.shadows.tau[0][1], 1.0);
        }
    }
}

/// What sheets at random cover in one cell, against lines: they cross each other anyhow.
#[test]
fn crossing_sheets_against_lines() {
    const LINES: usize = 400;
    let mut random = Random::new(8);
    for count in [1, 2, 3, 7, 20, 60] {
        let point = |random: &mut Random| random.point(DVec3::ZERO, DVec3::ONE);
        let sheets: Vec<Triangle> = (0..count).map(|_| [0; 3].map(|_| point(&mut random))).collect();
        let both: Vec<Triangle> = sheets.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b]]).collect();
        let found = [0, 999].map(|room| in_one_layer(&[0.0, 1.0], Surface::sheet(&both), room)[0]);
        for axis in 0..3 {
            let (iu, iv) = ((axis + 1) % 3, (axis + 2) % 3);
            let meets = |[a, b, c]: &Triangle, u: f64, v: f64| {
                let side = |a: DVec3, b: DVec3| (b[iu] - a[iu]) * (v - a[iv]) - (b[iv] - a[iv]) * (u - a[iu]);
                let sides = [side(*a, *b), side(*b, *c), side(*c, *a)];
                sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
            };
            let at = |n: usize| (n as f64 + 0.5) / LINES as f64;
            let met = (0..LINES * LINES).filter(|n| sheets.iter().any(|t| meets(t, at(n % LINES), at(n / LINES))));
            let truth = met.count() as f64 / (LINES * LINES) as f64;
            for share in found.map(|cell| cell[3 + axis]) {
                assert!((share - truth).abs() < 3e-3, "{count} along {axis}: {share} and {truth}");
            }
        }
    }
}

/// A beam that ends within a cell, turned by next to nothing: what it hides is next to nothing, and no face changes by more.
#[test]
fn what_is_hardly_hidden_lowers_no_face() {
    let edges = Edges([(0..=12).map(|n| 0.5 * f64::from(n)).collect(), vec![0.0, 1.0], vec![0.0, 0.5, 1.0]]);
    let (min, max) = (DVec3::new(1.1, -1.0, -1.0), DVec3::new(2.9, 2.0, 0.75));
    let lowered = |angle: f64| {
        let bodies = scene(&[turned_box((min + max) * 0.5, (max - min) * 0.5, DMat3::from_rotation_y(angle))]);
        let (mut result, found) = found(&edges, &bodies);
        throat::lower(&edges.grid(None).expect("a grid"), &mut result, &found.shadows);
        result.beta
    };
    let level = lowered(0.0);
    for angle in [1e-10, -1e-10, 1e-8, -1e-8, 1e-6, -1e-6] {
        assert_close(&level, &lowered(angle), 10.0 * f64::abs(angle) + 1e-9, &format!("turned by {angle}"));
    }
}
