//! Cells divided by thin walls, against the gas itself: whether cells on both sides of a wall are joined by open faces is found by a search of the grid.

use glam::{DMat3, DVec3};
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::divided::{ClosedCells, DividedCells, Division};
use voidage::porosity::resistance::resistance;
use voidage::porosity::shadows::{cells, faces_of_cell};
use voidage::porosity::{FieldSet, Options, porosity, throat};
use voidage_core::convex::shape::Cylinder;
use voidage_core::grid::Grid;
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, formulas, scene, turned_box};

fn edges(count: [usize; 3]) -> Edges {
    Edges(count.map(|n| (0..=n).map(|n| n as f64).collect()))
}

/// Edges of cells that are not alike, none of them more than twice as wide as its neighbour.
fn uneven(count: usize, random: &mut Random) -> Edges {
    Edges([(); 3].map(|()| {
        let widths = (0..count).map(|_| random.between(0.7, 1.4));
        let inner = widths.scan(0.0, |edge, width| {
            *edge += width;
            Some(*edge)
        });
        std::iter::once(0.0).chain(inner).collect()
    }))
}

/// What is told of a scene: hidden passages and divided cells with faces in planes, divided cells with throats, and what is closed of these; and the faces
/// of all three.
struct Told {
    hidden: usize,
    plane: DividedCells,
    throat: DividedCells,
    closed: ClosedCells,
    faces: [FieldSet; 3],
}

fn told(edges: &Edges, bodies: &Bodies) -> Told {
    let (grid, options) = (edges.grid(None).expect("a grid"), Options { resistance: true, ..Options::default() });
    let mut result = porosity(&grid, bodies, options);
    let shadows = resistance(&grid, bodies, &result, options).shadows;
    let division = Division::find(&grid, bodies, &result.beta, &shadows);
    let (plane, in_planes) = (division.told(&grid, &result.beta, Some(&shadows)), result.beta.clone());
    throat::lower(&grid, &mut result, &shadows);
    let (throat, throats) = (division.told(&grid, &result.beta, None), result.beta.clone());
    let closed = division.close(&grid, &mut result, &shadows);
    let hidden = shadows.hidden.iter().map(|hidden| hidden.cells).sum();
    Told { hidden, plane, throat, closed, faces: [in_planes, throats, result.beta] }
}

/// The cells that gas reaches from one by faces that are open by more than `least`.
fn reached(grid: &Grid<f64>, faces: &FieldSet, from: [usize; 3], least: f64) -> Vec<bool> {
    let (mut found, mut stack) = (vec![false; grid.cell_count()], vec![from]);
    while let Some(at) = stack.pop() {
        if std::mem::replace(&mut found[grid.cell_index(at)], true) {
            continue;
        }
        for axis in 0..3 {
            let [low, high] = faces_of_cell(grid, axis, at).map(|face| faces.faces(axis)[face] > least);
            if low && at[axis] > 0 {
                let mut next = at;
                next[axis] -= 1;
                stack.push(next);
            }
            if high && at[axis] + 1 < grid.cells()[axis] {
                let mut next = at;
                next[axis] += 1;
                stack.push(next);
            }
        }
    }
    found
}

/// Does gas come from one side of a wall through `middle`, normal to `normal`, to the other? None if faces hardly open decide it.
fn leaks(grid: &Grid<f64>, faces: &FieldSet, middle: DVec3, normal: DVec3) -> Option<bool> {
    let center = |at: [usize; 3]| grid.cell_box(at).map(|cell| (cell.min + cell.max) / 2.0).expect("a cell");
    let side = |at: [usize; 3]| (center(at) - middle).dot(normal);
    let from = cells(grid).min_by(|a, b| side(*a).total_cmp(&side(*b))).expect("cells");
    let other = cells(grid).max_by(|a, b| side(*a).total_cmp(&side(*b))).expect("cells");
    let joined = |least: f64| reached(grid, faces, from, least)[grid.cell_index(other)];
    match [joined(0.1), joined(1e-9)] {
        [true, true] => Some(true),
        [false, false] => Some(false),
        _ => None,
    }
}

/// Judges a wall that goes through the whole grid, which no longer leaks once it is closed; whether it does with throats.
fn judge(edges: &Edges, bodies: &Bodies, middle: DVec3, normal: DVec3, name: &str) -> Option<bool> {
    let (grid, found) = (edges.grid(None).expect("a grid"), told(edges, bodies));
    let [plane, throat, closed] = [0, 1, 2].map(|n| leaks(&grid, &found.faces[n], middle, normal));
    if let Some(leaks) = plane {
        assert_eq!(found.hidden + found.plane.cells > 0, leaks, "{name}: {:?}", found.plane);
    }
    if let Some(leaks) = throat {
        assert_eq!(found.throat.cells > 0, leaks, "{name}: {:?}", found.throat);
    }
    assert_ne!(closed, Some(true), "{name}: {:?}", found.closed);
    assert_eq!(found.closed.left.cells, 0, "{name}: {:?}", found.closed);
    throat
}

/// A wall turned about z in a layer of cells: it leaks wherever it leaves cells by the faces ahead, and that is told; where it does not leak it is not.
#[test]
fn walls_turned_in_a_plane() {
    let (mut random, mut leaking, mut tight) = (Random::new(16), 0, 0);
    for degrees in (0..=90).step_by(5) {
        for thickness in [0.01, 0.05, 0.1, 0.2, 0.3] {
            let turn = DMat3::from_rotation_z(f64::from(degrees).to_radians());
            let middle = DVec3::new(6.0 + random.unit(), 6.0 + random.unit(), 0.5);
            let wall = scene(&[turned_box(middle, DVec3::new(thickness / 2.0, 30.0, 30.0), turn)]);
            let name = format!("{degrees} degrees, {thickness} thick, {middle}");
            match judge(&edges([13, 13, 1]), &wall, middle, turn.x_axis, &name) {
                Some(true) => leaking += 1,
                Some(false) => tight += 1,
                None => {}
            }
        }
    }
    println!("{leaking} leak, {tight} are tight");
    assert!(leaking > 60 && tight >= 8, "{leaking} {tight}");
}

/// A wall of no thickness: one side of it is read, the other is its cap.
fn sheet(middle: DVec3, turn: DMat3) -> Bodies {
    let corner = |y: f64, z: f64| middle + turn * DVec3::new(0.0, y, z);
    let [a, b, c, d] = [corner(-20.0, -20.0), corner(20.0, -20.0), corner(20.0, 20.0), corner(-20.0, 20.0)];
    scene(&[vec![[a, b, c], [a, c, d]]])
}

/// Walls turned anyhow, as triangles, as discs by formula and as sheets.
#[test]
fn walls_askew_in_space() {
    let (mut random, mut leaking) = (Random::new(17), 0);
    for n in 0..24 {
        let (turn, thickness) = (random.turn(), random.between(0.01, 0.3));
        let middle = random.point(DVec3::splat(3.5), DVec3::splat(4.5));
        let normal = turn.x_axis;
        let bodies = match n % 3 {
            0 => {
                let [a, b] = [-0.5, 0.5].map(|side| middle + normal * (side * thickness));
                formulas(&[Form::Cylinder(Cylinder::new(a, b, 20.0))])
            }
            1 => scene(&[turned_box(middle, DVec3::new(thickness / 2.0, 20.0, 20.0), turn)]),
            _ => sheet(middle, turn),
        };
        let leaks =
            judge(&edges([8, 8, 8]), &bodies, middle, normal, &format!("{n}: {thickness} thick, {middle}, {normal}"));
        leaking += usize::from(leaks == Some(true));
    }
    assert!(leaking > 12, "{leaking}");
}

/// As the coordinates of a file of single-precision numbers.
fn single(triangles: &[Triangle]) -> Bodies {
    let rounded = |t: &Triangle| t.map(|p| p.as_vec3().as_dvec3());
    let mesh = Mesh {
        name: "wall.stl".into(),
        single_precision: true,
        ..Mesh::from(triangles.iter().map(rounded).collect::<Vec<_>>())
    };
    let mut bodies = Bodies::default();
    bodies.add(&mesh, 1.0).expect("a closed surface");
    bodies
}

/// Walls on cells that are not alike, of single-precision numbers, and far from the origin: each is told where it leaks, and by any number of threads alike.
#[test]
fn walls_on_other_grids_and_of_other_numbers() {
    let (mut random, mut leaking) = (Random::new(19), [0; 3]);
    let pools = [1, 2].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads"));
    for n in 0..36 {
        let (turn, thickness) = (random.turn(), random.between(0.02, 0.3));
        let normal = turn.x_axis;
        let cells = if n % 3 == 0 { uneven(8, &mut random) } else { edges([8; 3]) };
        let end = DVec3::from_array([0, 1, 2].map(|axis| cells.0[axis][8]));
        let middle = end * 0.5 + random.point(DVec3::splat(-0.5), DVec3::splat(0.5));
        let wall = turned_box(middle, DVec3::new(thickness / 2.0, 20.0, 20.0), turn);
        let far = if n % 3 == 2 { DVec3::new(448_262.0, 5_411_932.0, 113.0) } else { DVec3::ZERO };
        let moved: Vec<Triangle> = wall.iter().map(|t| t.map(|p| p + far)).collect();
        let bodies = if n % 3 == 1 { single(&moved) } else { scene(&[moved]) };
        let grid = Edges([0, 1, 2].map(|axis| cells.0[axis].iter().map(|edge| edge + far[axis]).collect()));
        let name = format!("{n}: {thickness} thick, {middle}, {normal}");
        let leaks = judge(&grid, &bodies, middle + far, normal, &name);
        leaking[n % 3] += usize::from(leaks == Some(true));
        let [one, two] = pools.each_ref().map(|pool| pool.install(|| told(&grid, &bodies)));
        assert_eq!((one.plane, one.throat, one.faces), (two.plane, two.throat, two.faces), "{name}");
        if n % 3 == 2 {
            let near = told(&cells, &scene(&[wall]));
            assert_eq!((one.plane.cells, one.throat.cells), (near.plane.cells, near.throat.cells), "{name}");
        }
    }
    println!("{leaking:?} leak");
    assert!(leaking.iter().all(|&n| n >= 5), "{leaking:?}");
}

/// What divides no gas: pipes thinner and thicker than a cell, corners of boxes, walls that close whole cells, walls that end.
#[test]
fn what_gas_goes_around_divides_nothing() {
    let mut random = Random::new(18);
    let none = |bodies: &Bodies, name: &str| {
        let found = told(&edges([8; 3]), bodies);
        assert_eq!((found.plane, found.throat), Default::default(), "{name}");
    };
    for n in 0..12 {
        let (middle, radius) = (random.point(DVec3::splat(3.0), DVec3::splat(5.0)), random.between(0.1, 1.2));
        let along = random.turn().x_axis * 20.0;
        let pipe = formulas(&[Form::Cylinder(Cylinder::new(middle - along, middle + along, radius))]);
        none(&pipe, &format!("pipe {n}: {middle}, {along}, {radius}"));
        let half = random.point(DVec3::splat(0.2), DVec3::splat(2.0));
        none(&scene(&[turned_box(middle, half, random.turn())]), &format!("box {n}: {middle} {half}"));
        let thick = DVec3::new(random.between(1.0, 1.5), 20.0, 20.0);
        none(&scene(&[turned_box(middle, thick, random.turn())]), &format!("thick wall {n}: {middle} {thick}"));
    }
    none(&scene(&[cuboid(DVec3::new(4.3, -1.0, -1.0), DVec3::new(4.35, 5.5, 9.0))]), "a wall along the grid that ends");
}

/// A wall across a cell, as four boxes around a window that are one body each: what is open is one part; without the window there are two.
#[test]
fn a_window_is_a_way() {
    let slab = |low: [f64; 2], high: [f64; 2]| -> Vec<Triangle> {
        let turn = DMat3::from_rotation_z(0.3);
        let corners = cuboid(DVec3::new(-0.02, low[0], low[1]), DVec3::new(0.02, high[0], high[1]));
        corners.into_iter().map(|t| t.map(|p| turn * p + 0.5)).collect()
    };
    let around = |half: f64| {
        let (half, far) = (half, 2.0);
        [
            slab([-far, -far], [-half, far]),
            slab([half, -far], [far, far]),
            slab([-half, -far], [half, -half]),
            slab([-half, half], [half, far]),
        ]
    };
    let one = edges([1; 3]);
    for half in [0.12, 0.2, 0.4] {
        assert_eq!(told(&one, &scene(&around(half))).throat.cells, 0, "{half}");
    }
    let [a, b, ..] = around(0.0);
    let closed = told(&one, &scene(&[a, b]));
    assert_eq!(closed.hidden + closed.plane.cells, 1);
}

/// Rooms of thin walls along the grid: where two walls meet within a cell, no throat makes both of them tight. Wherever gas gets out, that is told; a wall that
/// crosses a plane of the grid divides no cell beside the corner, and was taken for a way around it. Closed, they are tight.
#[test]
fn corners_of_rooms() {
    let mut random = Random::new(31);
    let (mut leaky, mut tight) = (0, 0);
    for thickness in [0.2, 0.5, 0.8, 1.05] {
        for _ in 0..40 {
            let (lo, hi) = (
                random.point(DVec3::splat(1.2), DVec3::splat(2.8)),
                random.point(DVec3::splat(6.2), DVec3::splat(7.8)),
            );
            let walls = [0, 1].into_iter().flat_map(|axis| {
                [lo[axis] - thickness, hi[axis]].map(|at| {
                    let (mut low, mut high) = (lo - thickness, hi + thickness);
                    (low[axis], high[axis]) = (at, at + thickness);
                    (low.z, high.z) = (-1.0, 2.0);
                    cuboid(low, high)
                })
            });
            let edges = edges([9, 9, 1]);
            let grid = edges.grid(None).expect("a grid");
            let found = told(&edges, &scene(&walls.collect::<Vec<_>>()));
            let outside = |faces: &FieldSet, least| reached(&grid, faces, [4, 4, 0], least)[0];
            let closed = (outside(&found.faces[2], 0.05), found.closed.left.cells);
            assert_eq!(closed, (false, 0), "{thickness}: {lo} {hi}");
            let outside = outside(&found.faces[1], 0.05);
            assert!(!outside || found.throat.cells > 0, "{thickness}: {lo} {hi}");
            leaky += usize::from(outside);
            tight += usize::from(!outside && found.throat.cells == 0);
        }
    }
    assert!(leaky > 20 && tight > 20, "{leaky} {tight}");
}

/// Six walls around a box, each a body of its own, turned about its middle; the first has a door of half of its width.
fn room(middle: DVec3, half: DVec3, thickness: f64, turn: DMat3, door: bool) -> Bodies {
    let walls = (0..6).flat_map(|n| {
        let (axis, high) = (n / 2, n % 2 == 1);
        let (mut lo, mut hi) = (-half - thickness, half + thickness);
        if high {
            lo[axis] = half[axis];
        } else {
            hi[axis] = -half[axis];
        }
        let sides = if door && n == 0 {
            let ([mut a, mut b], far) = ([hi, lo], 0.5 * half.y);
            (a.y, b.y) = (-far, far);
            vec![[lo, a], [b, hi]]
        } else {
            vec![[lo, hi]]
        };
        let turned = move |[lo, hi]: [DVec3; 2]| -> Vec<Triangle> {
            cuboid(lo, hi).into_iter().map(|t| t.map(|p| middle + turn * p)).collect()
        };
        sides.into_iter().map(turned)
    });
    scene(&walls.collect::<Vec<_>>())
}

/// Rooms turned anyhow: gas stays within once they are closed, and a door stays a door.
#[test]
fn rooms_turned_anyhow() {
    let mut random = Random::new(32);
    let mut leaky = 0;
    for n in 0..40 {
        let (middle, half) =
            (random.point(DVec3::splat(6.5), DVec3::splat(7.5)), random.point(DVec3::splat(2.0), DVec3::splat(3.0)));
        let (thickness, turn) = (random.between(0.02, 0.6), if n % 4 == 0 { DMat3::IDENTITY } else { random.turn() });
        let edges = edges([14; 3]);
        let grid = edges.grid(None).expect("a grid");
        let name = format!("{n}: {middle}, {half}, {thickness} thick, {turn}");
        for door in [false, true] {
            let found = told(&edges, &room(middle, half, thickness, turn, door));
            let outside = |faces: &FieldSet, least| reached(&grid, faces, [7; 3], least)[0];
            assert_eq!(found.closed.left.cells, 0, "{name}: {:?}", found.closed);
            assert_eq!(outside(&found.faces[2], if door { 0.1 } else { 0.05 }), door, "{name}: {:?}", found.closed);
            leaky += usize::from(!door && outside(&found.faces[1], 0.05));
        }
    }
    assert!(leaky > 20, "{leaky}");
}

/// Walls of bars with ways between them that are too narrow for points: none is closed.
#[test]
fn ways_between_bars_stay() {
    let edges = edges([5, 5, 5]);
    for (gap, turn) in [(0.04, 0.0), (0.06, 0.3), (0.1, 0.0), (0.15, 0.5)] {
        let turn = DMat3::from_rotation_y(turn);
        let bars = (0..60).map(|n| {
            let y = -1.0 + 0.2 * f64::from(n);
            let bar = cuboid(DVec3::new(-0.05, y, -9.0), DVec3::new(0.05, y + 0.2 - gap, 9.0));
            bar.into_iter().map(|t| t.map(|p| DVec3::new(2.4, 0.0, 2.6) + turn * p)).collect()
        });
        let found = told(&edges, &scene(&bars.collect::<Vec<Vec<Triangle>>>()));
        assert_eq!(found.closed.faces, 0, "{gap}: {:?}", found.closed);
        assert_eq!(found.faces[1], found.faces[2], "{gap}");
    }
}

/// A room as one body, its inside a cavity: where a side of a wall lies in a plane of the grid, the cells beside the wall that divides one are cut by one
/// patch of its outside, and what of them is open counts for what is closed. As tight as six walls, with the same faces where these are aligned.
#[test]
fn rooms_of_one_surface() {
    let mut random = Random::new(33);
    for n in 0..60 {
        let spacing = [0.2, 0.25, 0.5][n % 3];
        let round = |x: f64| (x * 20.0).round() / 20.0;
        let point = |random: &mut Random, lo: f64, hi: f64| random.point(DVec3::splat(lo), DVec3::splat(hi));
        let (low, high) = (point(&mut random, 0.6, 1.4), point(&mut random, 3.4, 4.4));
        let [low, high] = [low, high].map(|p| DVec3::new(round(p.x), round(p.y), round(p.z)));
        let thickness = [0.05, 0.1, 0.2][random.below(3)];
        let count = (5.0 / spacing) as usize;
        let edges = Edges([(); 3].map(|()| (0..=count).map(|n| n as f64 * spacing).collect()));
        let grid = edges.grid(None).expect("a grid");
        let inside = cuboid(low + thickness, high - thickness).into_iter().map(|[a, b, c]| [a, c, b]);
        let found = told(&edges, &scene(&[cuboid(low, high).into_iter().chain(inside).collect::<Vec<Triangle>>()]));
        let middle = (low + high) / 2.0;
        let from = [0, 1, 2].map(|axis| (middle[axis] / spacing) as usize);
        let name = format!("{n}: {low} {high} {thickness} thick, cells of {spacing}");
        assert!(!reached(&grid, &found.faces[2], from, 0.05)[0], "{name}: {:?}", found.closed);
        let half = (high - low) / 2.0 - thickness;
        let walls = told(&edges, &room(middle, half, thickness, DMat3::IDENTITY, false));
        assert_eq!(found.closed.faces, walls.closed.faces, "{name}");
    }
}
