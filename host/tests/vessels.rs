//! Bodies with rooms in them: which room belongs to which body, where several hold it or bodies cross.

use crate::bodies::{Triangle, bodies, cuboid, named, shuffled, with_backs};
use glam::{DVec3, dvec3};
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::{Options, porosity};

#[test]
fn cavities_that_overlap_are_open_once() {
    let outside = cuboid(DVec3::ZERO, DVec3::splat(10.0), false);
    let one = cuboid(DVec3::splat(1.0), DVec3::splat(5.0), true);
    let other = cuboid(DVec3::splat(4.0), DVec3::splat(7.0), true);
    let found = bodies(&[&outside, &one, &other]);
    assert_eq!(found.diagnoses[0].cavities, 2);
    assert!((found.bodies[0].volume - (1000.0 - 64.0 - 27.0 + 1.0)).abs() < 1e-9, "{}", found.bodies[0].volume);
}

/// Boxes by their lowest and highest corners.
type Block = ([f64; 3], [f64; 3]);

/// A block and the rooms in it.
type Vessel = (Block, Vec<Block>);

fn shell(&(lo, hi): &Block, turned: bool) -> Vec<Triangle> {
    cuboid(DVec3::from_array(lo), DVec3::from_array(hi), turned)
}

/// What vessels with corners at halves hold together, each without its own rooms.
fn union(vessels: &[Vessel]) -> f64 {
    let holds =
        |(lo, hi): &Block, p: DVec3| DVec3::from_array(*lo).cmplt(p).all() && DVec3::from_array(*hi).cmpgt(p).all();
    let is_solid =
        |p: DVec3| vessels.iter().any(|(outer, rooms)| holds(outer, p) && !rooms.iter().any(|r| holds(r, p)));
    let at = |n: usize| n as f64 * 0.5 - 1.75;
    let places = (0..32).flat_map(|i| (0..32).flat_map(move |j| (0..32).map(move |k| dvec3(at(i), at(j), at(k)))));
    places.filter(|&p| is_solid(p)).count() as f64 / 8.0
}

/// The least and the largest volume that some bodies may hold, by their bounds.
fn volumes(found: &Bodies) -> [f64; 2] {
    let edges = Edges([0; 3].map(|_| (0..9).map(|n| 2.0 * f64::from(n) - 2.25).collect()));
    let porosity = porosity(&edges.grid(None).unwrap(), found, Options { bounds: true, ..Options::default() });
    let [lower, upper] = porosity.bounds.expect("bounds");
    [&upper, &lower].map(|set| set.v.iter().map(|b| 8.0 * (1.0 - b)).sum())
}

/// Rooms were given to the smallest body around them, be it one that only passes through the wall of theirs: what both rooms hold was solid.
#[test]
fn bodies_that_cross_keep_their_own_rooms() {
    let whole = |from: f64, to: f64| ([from; 3], [to; 3]);
    let scenes: [Vec<Vessel>; 4] = [
        // A duct through the wall of a vessel into its room.
        vec![
            (whole(0.0, 10.0), vec![whole(4.0, 6.0)]),
            (([-1.0, 3.0, 3.0], [7.0, 7.0, 7.0]), vec![([-0.5, 3.5, 3.5], [5.0, 6.5, 6.5])]),
        ],
        // A vessel across the room of another, larger than it, its room in that one.
        vec![(whole(0.0, 10.0), vec![whole(2.0, 8.0)]), (([0.5, 2.5, 2.5], [9.5, 7.5, 7.5]), vec![whole(4.0, 6.0)])],
        // The same with a part in its room.
        vec![
            (whole(0.0, 10.0), vec![whole(2.0, 8.0)]),
            (([0.5, 2.5, 2.5], [9.5, 7.5, 7.5]), vec![whole(4.0, 6.0)]),
            (whole(4.5, 5.5), vec![]),
        ],
        // The larger room lies in both, the other in the smaller vessel alone.
        vec![
            (whole(0.0, 10.0), vec![([6.0, 2.0, 2.0], [9.5, 8.0, 8.0])]),
            (([5.0, 1.0, 1.0], [13.0, 9.0, 9.0]), vec![([8.0, 3.0, 3.0], [12.0, 7.0, 7.0])]),
        ],
    ];
    for vessels in &scenes {
        let truth = union(vessels);
        let shells: Vec<Vec<Triangle>> = vessels
            .iter()
            .flat_map(|(outer, rooms)| [shell(outer, false)].into_iter().chain(rooms.iter().map(|r| shell(r, true))))
            .collect();
        let of_vessel = |(outer, rooms): &Vessel| {
            [shell(outer, false)].into_iter().chain(rooms.iter().map(|r| shell(r, true))).flatten().collect()
        };
        let names = ["a", "b", "c"];
        let solids: Vec<(&str, Vec<Triangle>)> = names.into_iter().zip(vessels.iter().map(of_vessel)).collect();
        let backward: Vec<(&str, Vec<Triangle>)> = solids.iter().rev().cloned().collect();
        let mut files = vec![named(&solids), named(&backward)];
        files.extend((0..6).map(|seed| bodies(&[&shuffled(&shells.concat(), seed)])));
        for found in files {
            let [least, most] = volumes(&found);
            let is_right = (least - truth).abs() < 1e-9 && (most - truth).abs() < 1e-9;
            assert!(is_right && found.warnings.is_empty(), "{least} to {most}, not {truth}: {:?}", found.warnings);
        }
        for body in &named(&backward).bodies {
            let own = names.iter().position(|name| *name == body.name).map(|n| union(&vessels[n..=n]));
            assert!(own.is_some_and(|own| (own - body.volume).abs() < 1e-9), "{} holds {}", body.name, body.volume);
        }
    }
}

/// Three hollow vessels at random places, no two sides in one plane: they cross, hold each other, and their rooms overlap.
fn vessels_that_cross(seed: u64) -> Vec<Vessel> {
    let mut state = seed;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let mut vessels = vec![(([0.0; 3], [0.0; 3]), vec![([0.0; 3], [0.0; 3])]); 3];
    for axis in 0..3 {
        let mut free: Vec<f64> = (0..30).map(|n| f64::from(n) * 0.5 - 1.0).collect();
        for ((lo, hi), rooms) in &mut vessels {
            let mut own = [0; 4].map(|_| free.swap_remove(below(free.len())));
            own.sort_by(f64::total_cmp);
            (lo[axis], rooms[0].0[axis], rooms[0].1[axis], hi[axis]) = (own[0], own[1], own[2], own[3]);
        }
    }
    vessels
}

#[test]
fn vessels_at_random_keep_their_own_rooms() {
    for seed in 0..150 {
        let vessels = vessels_that_cross(seed);
        let truth = union(&vessels);
        let shells = vessels.iter().flat_map(|(outer, rooms)| [shell(outer, false), shell(&rooms[0], true)]);
        let all: Vec<Triangle> = shells.flatten().collect();
        let found = bodies(&[&shuffled(&all, seed as usize)]);
        let [least, most] = volumes(&found);
        let is_right = (least - truth).abs() < 1e-9 && (most - truth).abs() < 1e-9;
        assert!(
            is_right && found.warnings.is_empty(),
            "seed {seed}: {least} to {most}, not {truth}: {:?}",
            found.warnings
        );
    }
}

#[test]
fn cavities_that_overlap_in_several_bodies_are_in_doubt() {
    // Three for two bodies: two of them are of one.
    let outer = [([0.0; 3], [10.0; 3]), ([0.5; 3], [9.5; 3])];
    let rooms =
        [([1.0, 2.0, 2.0], [6.0, 6.0, 6.0]), ([4.0, 3.0, 3.0], [9.0, 7.0, 7.0]), ([3.0, 4.0, 4.0], [7.0, 9.0, 9.0])];
    let of = |owners: [usize; 3]| -> Vec<Vessel> {
        let own = |n: usize| (0..3).filter(|&r| owners[r] == n).map(|r| rooms[r]).collect();
        (0..2).map(|n| (outer[n], own(n))).collect()
    };
    let all: Vec<Triangle> =
        outer.iter().flat_map(|b| shell(b, false)).chain(rooms.iter().flat_map(|r| shell(r, true))).collect();
    let found = bodies(&[&all]);
    let [least, most] = volumes(&found);
    for owners in [[0, 0, 1], [0, 1, 0], [1, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]] {
        let truth = union(&of(owners));
        assert!(least <= truth && truth <= most, "{least} to {most}, not {truth}");
    }
    assert!(
        found.warnings.iter().any(|w| w.contains("cavities overlap within several bodies")),
        "{:?}",
        found.warnings
    );
    // By their names the rooms overlap in one body, and the other covers what they have in common; by the number of surfaces around it that is open.
    let (small, cover) = (([1.0; 3], [6.0; 3]), ([2.5; 3], [8.5; 3]));
    let room = ([3.0; 3], [7.0; 3]);
    let of_one = [shell(&outer[0], false), shell(&small, true), shell(&room, true)].concat();
    let found = named(&[("a", of_one), ("b", shell(&cover, false))]);
    let [least, most] = volumes(&found);
    for vessels in [[(outer[0], vec![small, room]), (cover, vec![])], [(outer[0], vec![small]), (cover, vec![room])]] {
        let truth = union(&vessels);
        assert!(least <= truth && truth <= most, "{least} to {most}, not {truth}");
    }
    assert!(!found.warnings.is_empty());
}

/// Where every triangle has a back, nothing tells a room from a part: it was solid, with a gap of 0.
#[test]
fn a_double_sided_shell_in_another_is_a_room_or_a_part() {
    let (outer, inner, part) = (([0.0; 3], [10.0; 3]), ([2.0; 3], [8.0; 3]), ([3.0; 3], [4.0; 3]));
    let both = [shell(&outer, false), shell(&inner, false)].concat();
    let all = [both.clone(), shell(&part, false)].concat();
    for seed in 0..4 {
        let found = bodies(&[&shuffled(&with_backs(&both), seed)]);
        let [least, most] = volumes(&found);
        assert!((least - 784.0).abs() < 1e-9 && (most - 1000.0).abs() < 1e-9, "{least} to {most}");
        let told = "1 closed surface with two sides lies within another";
        assert!(found.warnings.iter().any(|w| w.contains(told) && w.contains("2.16")), "{:?}", found.warnings);
        // A part in what may be a room may itself be hollow.
        let [least, most] = volumes(&bodies(&[&shuffled(&with_backs(&all), seed)]));
        assert!((least - 784.0).abs() < 1e-9 && (most - 1000.0).abs() < 1e-9, "{least} to {most}");
        // With one side it is a part.
        let [least, most] = volumes(&bodies(&[&with_backs(&both), &shell(&part, false)]));
        assert!((least - 785.0).abs() < 1e-9 && (most - 1000.0).abs() < 1e-9, "{least} to {most}");
        // Inward it is a room.
        let found = bodies(&[&with_backs(&shell(&outer, false)), &shell(&inner, true)]);
        assert_eq!(volumes(&found).map(f64::round), [784.0; 2], "{:?}", found.warnings);
    }
}
