//! Triangles to bodies: what may be moved, capped and taken for a cavity, wherever the scene lies.

use glam::{DVec3, dvec3};
use voidage::geometry::bodies::{Bodies, Doubt};
use voidage::geometry::mesh::{Mesh, Solid};
use voidage::grid::Edges;
use voidage::porosity::{Options, porosity};

pub type Triangle = [DVec3; 3];

/// Twelve triangles, outward; `turned` inward.
pub fn cuboid(lo: DVec3, hi: DVec3, turned: bool) -> Vec<Triangle> {
    let corner = |n: usize| lo + (hi - lo) * dvec3((n >> 2) as f64, (n >> 1 & 1) as f64, (n & 1) as f64);
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let halves = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }.map(corner)).collect()
}

/// A file of one solid.
pub fn bodies(parts: &[&[Triangle]]) -> Bodies {
    named(&[("part", parts.concat())])
}

/// A file of named solids.
pub fn named(solids: &[(&str, Vec<Triangle>)]) -> Bodies {
    let triangles: Vec<Triangle> = solids.iter().flat_map(|(_, t)| t.iter().copied()).collect();
    let mut first = 0;
    let solid = |(name, t): &(&str, Vec<Triangle>)| {
        first += t.len();
        Solid { name: (*name).into(), triangles: first - t.len()..first }
    };
    let solids = solids.iter().map(solid).collect();
    let mut bodies = Bodies::default();
    bodies.add(&Mesh { name: "test.stl".into(), solids, ..Mesh::from(triangles) }, 1.0).expect("bodies");
    bodies
}

/// Map coordinates, for one: a step of `f32` is half a metre there, but these are not `f32`.
const SITE: DVec3 = dvec3(450_000.25, 6_700_000.5, 10.0);

#[test]
fn a_hole_far_from_the_origin_does_not_swallow_its_body() {
    let shell = cuboid(SITE, SITE + 1.0, false);
    for open in [&shell[1..], &shell[2..]] {
        let found = bodies(&[open, &cuboid(SITE + 2.0, SITE + dvec3(7.0, 2.02, 2.02), false)]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.holes, d.welded_by), (2, 1, 0.0), "{:?}", found.warnings);
        let volume = 1.0 + 5.0 * 0.02 * 0.02;
        assert!((d.body_volume - volume).abs() < 1e-7, "{}", d.body_volume);
    }
}

/// Every triangle written by itself, its corners a few hundredths of a millimetre off to a metre: they were sheets, and what they hold was open.
#[test]
fn cracks_wider_than_rounding_close_where_edges_meet() {
    let cracked = shaken(cuboid(DVec3::ZERO, DVec3::ONE, false), 8e-6);
    let found = bodies(&[&cracked]);
    let d = &found.diagnoses[0];
    assert_eq!((d.bodies, d.sheets, d.boundary_edges), (1, 0, 0), "{:?}", found.warnings);
    assert!(d.welded_by > 1e-6 && (d.body_volume - 1.0).abs() < 1e-4, "{} {}", d.welded_by, d.body_volume);
    // What was moved is in the bounds.
    assert_eq!(found.bodies[0].rounding, d.welded_by);
    // A triangle is missing besides: the cracks close, and what is left is a hole.
    let found = bodies(&[&cracked[1..]]);
    let d = &found.diagnoses[0];
    assert_eq!((d.bodies, d.sheets, d.boundary_edges, d.holes), (1, 0, 3, 1), "{:?}", found.warnings);
    assert!(d.welded_by > 1e-6 && (d.body_volume - 1.0).abs() < 1e-4, "{} {}", d.welded_by, d.body_volume);
    // Two leaves of an open plate as near to each other keep their distance within.
    let leaf = |z: f64| cuboid(dvec3(0.0, 0.0, z), dvec3(1.0, 1.0, z + 1.0), false)[2..4].to_vec();
    let found = bodies(&[&leaf(0.0), &leaf(1e-3)]);
    assert!(found.diagnoses[0].welded_by == 0.0 && found.bodies.iter().all(|b| b.unknown.is_empty()));
}

#[test]
fn a_body_with_cracks_too_wide_to_close_is_in_doubt() {
    for missing in 0..3 {
        let cracked = shaken(cuboid(DVec3::ZERO, DVec3::ONE, false), 3e-3);
        let found = bodies(&[&cracked[missing..]]);
        let boxes: Vec<_> = found.bodies.iter().flat_map(|b| &b.unknown).collect();
        assert!(boxes.len() == 1 && found.diagnoses[0].welded_by == 0.0, "{:?}", found.warnings);
        let [lo, hi] = *boxes[0];
        assert!((hi - lo - DVec3::ONE).abs().max_element() < 1e-2, "{lo} {hi}");
        assert!(found.warnings.iter().any(|w| w.contains("nearly meet")), "{:?}", found.warnings);
    }
    // Sheets as far apart that hold nothing: the tiles of a floor, whose box is flat.
    let tile = |x: f64| [dvec3(x, 0.0, 0.0), dvec3(x + 0.99, 0.0, 0.0), dvec3(x, 1.0, 0.0)];
    let found = bodies(&[&(0..9).map(|n| tile(f64::from(n))).collect::<Vec<_>>()]);
    assert!(found.bodies.iter().all(|b| b.sheet && b.unknown.is_empty()), "{:?}", found.warnings);
}

/// Corners of their own for every triangle, off by up to so much.
fn shaken(triangles: Vec<Triangle>, by: f64) -> Vec<Triangle> {
    let mut off = 0.0;
    let mut noise = |p: DVec3| {
        off = (off + 0.37) % 1.0;
        p + dvec3(off, (off * 7.0) % 1.0, (off * 13.0) % 1.0) * by
    };
    triangles.into_iter().map(|t| t.map(&mut noise)).collect()
}

#[test]
fn cracks_close_and_nothing_else_moves() {
    // Every corner written anew, a little off; beside it a closed body far smaller than the crack is allowed to be wide.
    let mut off = 0.0;
    let mut noise = || {
        off = (off + 0.37) % 1.0;
        DVec3::splat(off * 2e-7)
    };
    let cracked: Vec<_> =
        cuboid(DVec3::ZERO, DVec3::ONE, false).into_iter().map(|t| t.map(|p| p * 100.0 + noise())).collect();
    let small = cuboid(DVec3::splat(-3e-5), DVec3::ZERO - 1e-5, false);
    let found = bodies(&[&cracked, &small]);
    let d = &found.diagnoses[0];
    assert!(d.welded_by > 0.0 && d.welded_by < 1e-6 && d.boundary_edges == 0, "{:?}", found.warnings);
    assert_eq!(d.bodies, 2);
    assert!((found.bodies[1].volume / 8e-15 - 1.0).abs() < 1e-9, "{}", found.bodies[1].volume);
}

#[test]
fn small_holes_far_apart_are_holes() {
    // In two sides of a large box a triangle each is missing, a thousandth as long as the side.
    let shell = cuboid(DVec3::ZERO, DVec3::splat(100.0), false);
    let around = |t: &Triangle| {
        let middle = (t[0] + t[1] + t[2]) / 3.0;
        let inner = t.map(|p| middle + (p - middle) * 1e-3);
        (0..3)
            .flat_map(|i| {
                let j = (i + 1) % 3;
                [[t[i], t[j], inner[j]], [t[i], inner[j], inner[i]]]
            })
            .collect::<Vec<_>>()
    };
    let found = bodies(&[&shell[1..11], &around(&shell[0]), &around(&shell[11])]);
    let d = &found.diagnoses[0];
    assert_eq!((d.holes, d.boundary_edges, d.t_junction_edges), (2, 6, 0), "{:?}", found.warnings);
    assert!((d.body_volume - 1e6).abs() < 1e-6, "{}", d.body_volume);
}

#[test]
fn an_edge_divided_on_one_side_only_is_no_hole() {
    // The point in the middle of an edge is off it by the rounding of f32, as far from the origin as may be.
    for at in [DVec3::ZERO, DVec3::splat(1000.0)] {
        let mut shell = cuboid(at, at + 1.0, false);
        let [a, b, c] = shell[0];
        let middle = ((a + b) * 0.5).as_vec3().as_dvec3() + DVec3::splat(f64::from(f32::EPSILON) * (at.x + 1.0));
        shell[0] = [a, middle, c];
        shell.push([middle, b, c]);
        let mut found = Bodies::default();
        found.add(&Mesh { single_precision: true, ..Mesh::from(shell) }, 1.0).expect("a body");
        let d = &found.diagnoses[0];
        assert_eq!((d.holes, d.t_junction_edges), (0, 3), "{at}: {:?}", found.warnings);
    }
}

#[test]
fn a_cavity_may_touch_the_wall_of_its_body() {
    // Turned inward and inside, with a side in the wall of the body: a pocket, wherever rounding puts the two.
    for n in 0..50 {
        let at = SITE * (f64::from(n) * 0.013_7) - 0.1;
        let at = dvec3(at.x % 10.0, at.y % 10.0, at.z);
        let pocket = cuboid(at + dvec3(0.25, 0.25, 0.0), at + 0.75, true);
        let found = bodies(&[&cuboid(at, at + 1.0, false), &pocket]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.cavities), (1, 1), "{at}: {:?}", found.warnings);
        assert!((d.body_volume - 0.8125).abs() < 1e-12, "{}", d.body_volume);
    }
}

#[test]
fn beside_another_body_or_in_its_place_is_no_cavity() {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE, false);
    let same = cuboid(DVec3::ZERO, DVec3::ONE, true);
    assert_eq!(bodies(&[&cube, &same]).diagnoses[0].cavities, 0);
    // In the notch of a body like an L, its box around it.
    let plate = cuboid(DVec3::ZERO, dvec3(3.0, 3.0, 1.0), false);
    let wall = cuboid(DVec3::ZERO, dvec3(1.0, 3.0, 3.0), false);
    let notch = cuboid(dvec3(1.0, 0.0, 1.0), dvec3(2.0, 1.0, 2.0), true);
    assert_eq!(bodies(&[&plate, &wall, &notch]).diagnoses[0].cavities, 0);
}

/// The same triangles in another order.
pub fn shuffled(triangles: &[Triangle], seed: usize) -> Vec<Triangle> {
    let mut left = triangles.to_vec();
    (0..left.len()).map(|n| left.swap_remove((seed * 7919 + n * 104_729) % left.len())).collect()
}

/// Each triangle followed by its back.
pub fn with_backs(triangles: &[Triangle]) -> Vec<Triangle> {
    triangles.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b]]).collect()
}

/// A prism over a regular polygon about the x axis, `sides` corners.
fn pipe(from: f64, to: f64, sides: usize) -> Vec<Triangle> {
    let at = |x: f64, n: usize| {
        let (sin, cos) = (std::f64::consts::TAU * (n % sides) as f64 / sides as f64).sin_cos();
        dvec3(x, cos, sin)
    };
    let side = |n| [[at(from, n), at(to, n + 1), at(to, n)], [at(from, n), at(from, n + 1), at(to, n + 1)]];
    let end = |n| [[at(to, 0), at(to, n), at(to, n + 1)], [at(from, 0), at(from, n + 1), at(from, n)]];
    (0..sides).flat_map(side).chain((1..sides - 1).flat_map(end)).collect()
}

#[test]
fn parts_that_share_all_edges_of_a_face_count_once() {
    let long = cuboid(DVec3::ZERO, dvec3(1.0, 2.0, 1.0), false);
    let short = cuboid(DVec3::ZERO, DVec3::ONE, false);
    let area = 12.0 * (std::f64::consts::TAU / 24.0).sin();
    let (far, near) = (pipe(0.0, 2.0, 24), pipe(0.0, 1.0, 24));
    for (parts, union) in [([&long, &short], 2.0), ([&far, &near], 2.0 * area)] {
        let both = [parts[0].clone(), parts[1].clone()].concat();
        for seed in 0..20 {
            let found = bodies(&[&shuffled(&both, seed)]);
            // Two bodies, one in the other, or their union.
            let largest = found.bodies.iter().map(|b| b.volume).fold(0.0, f64::max);
            assert!((largest - union).abs() < 1e-12, "{largest}, not {union}: {:?}", found.warnings);
            assert!(found.bodies.iter().all(|b| b.doubt == Doubt::None && b.volume <= union + 1e-12));
            assert_eq!(found.diagnoses[0].holes, 0);
        }
    }
}

#[test]
fn touching_parts_stay_apart() {
    // In a face, in an edge, in a corner.
    for at in [dvec3(1.0, 0.0, 0.0), dvec3(1.0, 1.0, 0.0), DVec3::ONE] {
        let both = [cuboid(DVec3::ZERO, DVec3::ONE, false), cuboid(at, at + 1.0, false)].concat();
        for seed in 0..10 {
            let found = bodies(&[&shuffled(&both, seed)]);
            let volumes: Vec<f64> = found.bodies.iter().map(|b| b.volume).collect();
            assert_eq!((volumes, found.warnings.len()), (vec![1.0, 1.0], 0), "{at}: {:?}", found.warnings);
        }
    }
}

#[test]
fn a_double_sided_surface_counts_once() {
    let one = cuboid(DVec3::ZERO, DVec3::ONE, false);
    let beside = cuboid(dvec3(1.0, 0.0, 0.0), dvec3(3.0, 1.0, 1.0), false);
    for (parts, volumes) in [(one.clone(), vec![1.0]), ([one.clone(), beside].concat(), vec![1.0, 2.0])] {
        let doubled = with_backs(&parts);
        for seed in 0..10 {
            let found = bodies(&[&shuffled(&doubled, seed)]);
            let mut volume: Vec<f64> = found.bodies.iter().map(|b| b.volume).collect();
            volume.sort_by(f64::total_cmp);
            assert_eq!(volume, volumes, "{:?}", found.warnings);
            assert!(found.bodies.iter().all(|b| !b.sheet && b.doubt == Doubt::None), "{:?}", found.warnings);
        }
    }
}

#[test]
fn backs_of_some_faces_are_dropped() {
    let shell = cuboid(DVec3::ZERO, DVec3::ONE, false);
    for backs in [0..2, 0..1, 3..9, 0..12] {
        let some = with_backs(&shell[backs.clone()]);
        let found = bodies(&[&shell[..backs.start], &some, &shell[backs.end..]]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.doubled, d.holes, d.body_volume), (1, backs.len(), 0, 1.0), "{:?}", found.warnings);
    }
}

#[test]
fn a_panel_with_two_sides_is_a_sheet() {
    // Flat, and bent along a line.
    let quad = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| [[a, b, c], [a, c, d]];
    let flat = quad(DVec3::ZERO, DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Y);
    let bent = quad(DVec3::X, dvec3(1.0, 0.0, 1.0), DVec3::ONE, dvec3(1.0, 1.0, 0.0));
    for panel in [flat.to_vec(), [flat, bent].concat()] {
        let found = bodies(&[&with_backs(&panel)]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.sheets, d.holes, d.body_volume), (1, 1, 0, 0.0), "{:?}", found.warnings);
    }
}

/// A closed bar through sections of four corners each.
fn bar(sections: &[[DVec3; 4]]) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for pair in sections.windows(2) {
        for i in 0..4 {
            let (j, [a, b]) = ((i + 1) % 4, [pair[0], pair[1]]);
            triangles.extend([[a[i], a[j], b[j]], [a[i], b[j], b[i]]]);
        }
    }
    let (a, b) = (sections[0], sections[sections.len() - 1]);
    triangles.extend([[a[0], a[2], a[1]], [a[0], a[3], a[2]], [b[0], b[1], b[2]], [b[0], b[2], b[3]]]);
    triangles
}

/// A bar of width and height ½, bent in the plane z = 0 so that it crosses itself in (2, 0): (0, 0), (4, 0), (4, 3), (2, 3), (2, −2). At its
/// end it is `end` high.
fn bent_bar(end: f64) -> Vec<Triangle> {
    let section = |left: [f64; 2], right: [f64; 2], h: f64| {
        let corner = |[x, y]: [f64; 2], z: f64| dvec3(x, y, z);
        [corner(left, -h), corner(right, -h), corner(right, h), corner(left, h)]
    };
    bar(&[
        section([0.0, 0.25], [0.0, -0.25], 0.25),
        section([3.75, 0.25], [4.25, -0.25], 0.25),
        section([3.75, 2.75], [4.25, 3.25], 0.25),
        section([2.25, 2.75], [1.75, 3.25], 0.25),
        section([2.25, 2.0], [1.75, 2.0], 0.25),
        section([2.25, -2.0], [1.75, -2.0], 0.5 * end),
    ])
}

#[test]
fn a_bar_that_crosses_itself_counts_its_overlap_once() {
    // With flush sides, and through the inner part of others; turned too, and inside out.
    for (end, overlap) in [(0.5, 0.125), (0.2, 0.25 * 0.35)] {
        let plain = bent_bar(end);
        let twice = bodies(&[&plain]).diagnoses[0].signed_volume.abs();
        let turn = glam::DMat3::from_axis_angle(dvec3(1.0, 2.0, 3.0).normalize(), 0.7);
        let turned: Vec<Triangle> = plain.iter().map(|t| t.map(|p| turn * p + dvec3(3.0, -7.0, 11.0))).collect();
        let inward: Vec<Triangle> = turned.iter().map(|&[a, b, c]| [a, c, b]).collect();
        for bar in [plain, turned, inward] {
            let found = bodies(&[&bar]);
            let d = &found.diagnoses[0];
            assert_eq!((d.bodies, d.crossing, d.doubtful), (1, 1, 0), "{:?}", found.warnings);
            assert!((d.body_volume - (twice - overlap)).abs() < 1e-12, "{} of {twice}", d.body_volume);
            assert!(
                found.warnings.iter().any(|w| w.contains("1 surface crosses itself (the first near ")),
                "{:?}",
                found.warnings
            );
        }
    }
}

#[test]
fn double_sided_parts_that_overlap_flush_count_once() {
    let both = [cuboid(DVec3::ZERO, dvec3(1.0, 2.0, 1.0), false), cuboid(DVec3::ZERO, DVec3::ONE, false)].concat();
    for seed in 0..10 {
        let found = bodies(&[&shuffled(&with_backs(&both), seed)]);
        let volumes: Vec<f64> = found.bodies.iter().map(|b| b.volume).collect();
        assert_eq!((found.diagnoses[0].doubtful, volumes), (0, vec![2.0]), "{:?}", found.warnings);
    }
}

#[test]
fn a_room_of_double_sided_parts_stays_open() {
    // Six parts that share whole edges with their neighbours, around a room of a cube.
    let walls = [
        ([0.0, 0.0, 0.0], [3.0, 3.0, 1.0]),
        ([0.0, 0.0, 2.0], [3.0, 3.0, 3.0]),
        ([0.0, 0.0, 1.0], [3.0, 1.0, 2.0]),
        ([0.0, 2.0, 1.0], [3.0, 3.0, 2.0]),
        ([0.0, 1.0, 1.0], [1.0, 2.0, 2.0]),
        ([2.0, 1.0, 1.0], [3.0, 2.0, 2.0]),
    ];
    let part = |(lo, hi): ([f64; 3], [f64; 3])| cuboid(DVec3::from_array(lo), DVec3::from_array(hi), false);
    let room: Vec<Triangle> = walls.into_iter().flat_map(part).collect();
    for seed in 0..10 {
        let found = bodies(&[&shuffled(&with_backs(&room), seed)]);
        let volume: f64 = found.bodies.iter().map(|b| b.volume).sum();
        assert!((volume - 26.0).abs() < 1e-12 && found.diagnoses[0].doubtful == 0, "{volume} {:?}", found.warnings);
    }
}

/// Where surveys count from the equator and a meridian [m].
const FAR: DVec3 = dvec3(500_000.0, 5_800_000.0, 0.0);

#[test]
fn thin_plates_far_from_the_origin_keep_their_thickness() {
    let origin = FAR + dvec3(1.0, 1.0, 1.0);
    for axis in 0..3 {
        let mut end = origin + 1.0;
        end[axis] = origin[axis] + 3e-7;
        let thickness = end[axis] - origin[axis];
        let found = bodies(&[&cuboid(origin, end, false)]);
        let edges = Edges([0, 1, 2].map(|a| (0..4).map(|n| FAR[a] + f64::from(n)).collect()));
        let options = Options { bounds: true, ..Options::default() };
        let porosity = porosity(&edges.grid(None).unwrap(), &found, options);
        let blocked: f64 = porosity.beta.v.iter().map(|b| 1.0 - b).sum();
        assert!(
            (blocked - thickness).abs() < 1e-12 && porosity.max_gap <= 1e-12,
            "axis {axis}: {blocked}, not {thickness}"
        );
    }
}

#[test]
fn a_slot_far_from_the_origin_is_a_hole() {
    // A box without a strip of 5 cm of its top.
    let (lo, hi) = (FAR, FAR + dvec3(10.0, 10.0, 4.0));
    let mut open: Vec<Triangle> = cuboid(lo, hi, false);
    open.retain(|t| !t.iter().all(|p| p.z == hi.z));
    let strip = |y0: f64, y1: f64| {
        let [a, b, c, d] = [dvec3(lo.x, y0, hi.z), dvec3(hi.x, y0, hi.z), dvec3(hi.x, y1, hi.z), dvec3(lo.x, y1, hi.z)];
        [[a, b, c], [a, c, d]]
    };
    open.extend(strip(lo.y, lo.y + 5.0));
    open.extend(strip(lo.y + 5.05, hi.y));
    let found = bodies(&[&open]);
    let d = &found.diagnoses[0];
    assert!(d.holes == 1 && d.t_junction_edges == 0, "{:?}", found.warnings);
    assert!((d.body_volume - 400.0).abs() < 1e-6 && d.welded_by == 0.0, "{} {:?}", d.body_volume, found.warnings);
}

#[test]
fn a_room_turned_inward_is_told_from_a_body_with_cavities() {
    let part = cuboid(DVec3::splat(1.0), DVec3::splat(2.0), false);
    let room = bodies(&[&cuboid(DVec3::ZERO, DVec3::splat(10.0), true), &part]);
    assert!(
        room.warnings.iter().any(|w| w.contains("1 shell that looks outward became a cavity")),
        "{:?}",
        room.warnings
    );
    let inner: Vec<Triangle> = part.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let hollow = bodies(&[&cuboid(DVec3::ZERO, DVec3::splat(10.0), false), &inner]);
    assert_eq!((hollow.diagnoses[0].cavities, hollow.warnings.len()), (1, 0), "{:?}", hollow.warnings);
}

#[test]
fn backs_of_touching_parts_are_called_backs() {
    let one = cuboid(DVec3::ZERO, DVec3::ONE, false);
    let beside = cuboid(DVec3::X, DVec3::new(2.0, 1.0, 1.0), false);
    let found = bodies(&[&with_backs(&[one, beside].concat())]);
    let said = |what: &str| found.warnings.iter().any(|w| w.contains(what));
    assert!(said("are the backs of others") && !said("repeat others"), "{:?}", found.warnings);
}
