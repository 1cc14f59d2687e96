//! Boxes of a common lattice, and prisms of one axis, that are turned, as the parts of a plant stand in a file: corners that lay on edges and sides lie beside them by
//! rounding, and sides that lay in one plane cross at tiny angles. With backs, and without.
//!
//! **Truth.** All parts look outward, so the solid is their union, whose volume no turn changes. In every cell, a file with backs is the file
//! without.

use crate::boxes::{Brick, Scene, bricks};
use crate::random::Random;
use crate::solids::{Triangle, cuboid};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};

/// How far boxes stand beside the lattice where they were placed one by one [m].
const APART: f64 = 1e-9;

/// Parts, turned.
#[derive(Debug, Clone)]
pub struct Turned {
    /// The triangles of all parts, without backs.
    pub one_sided: Vec<Triangle>,
    /// The same and the backs of some, in any order.
    pub triangles: Vec<Triangle>,
    /// Coordinates are those of binary STL.
    pub single: bool,
    /// Of the union, before the turn.
    pub volume: f64,
}

/// The parts of a box around a room: two walls across each axis, between those before; some in two pieces, some left out, and perhaps a part in the
/// room.
fn room(rng: &mut Random, side: i64) -> Vec<Brick> {
    let between = |rng: &mut Random, lo: i64, hi: i64| lo + rng.below((hi - lo) as usize) as i64;
    let inner = [0; 3].map(|_| {
        let lo = between(rng, 1, side - 1);
        [lo, between(rng, lo + 1, side)]
    });
    let mut axes = [0, 1, 2];
    axes.swap(0, rng.below(3));
    axes.swap(1, 1 + rng.below(2));
    let (mut min, mut max, mut walls) = ([0; 3], [side; 3], Vec::new());
    for a in axes {
        let [lo, hi] = inner[a];
        for [from, to] in [[0, lo], [hi, side]] {
            let mut wall = Brick { min, max, inverted: false };
            (wall.min[a], wall.max[a]) = (from, to);
            walls.push(wall);
        }
        (min[a], max[a]) = (lo, hi);
    }
    if rng.below(4) == 0 {
        let mut part = Brick { min, max, inverted: false };
        let a = rng.below(3);
        part.max[a] = between(rng, min[a] + 1, max[a] + 1);
        walls.push(part);
    }
    let mut parts = Vec::new();
    for wall in walls {
        let a = rng.below(3);
        let (lo, hi) = (wall.min[a], wall.max[a]);
        if rng.below(3) > 0 || hi - lo < 2 {
            parts.push(wall);
            continue;
        }
        let at = between(rng, lo + 1, hi);
        let (mut low, mut high) = (wall, wall);
        (low.max[a], high.min[a]) = (at, at);
        parts.extend([low, high]);
    }
    if rng.below(5) == 0 {
        parts.swap_remove(rng.below(parts.len()));
    }
    parts
}

/// A regular prism around the axis z, its corners at a distance `wide` from it.
fn prism(sides: usize, wide: f64, from: f64, to: f64) -> Vec<Triangle> {
    let corner = |n: usize, z: f64| {
        let angle = TAU * (n % sides) as f64 / sides as f64;
        DVec3::new(wide * angle.cos(), wide * angle.sin(), z)
    };
    let mut triangles = Vec::new();
    for n in 0..sides {
        let [a, b] = [n, n + 1].map(|n| [from, to].map(|z| corner(n, z)));
        triangles.extend([[a[0], b[0], b[1]], [a[0], b[1], a[1]]]);
    }
    for n in 1..sides - 1 {
        triangles.extend([[0, n + 1, n].map(|n| corner(n, from)), [0, n, n + 1].map(|n| corner(n, to))]);
    }
    triangles
}

/// What was found of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Seen {
    /// All bounds of cells are closer than rounding.
    pub exact: bool,
    /// What some triangles hold could not be told.
    pub doubtful: bool,
    /// Every triangle has a back.
    pub doubled: bool,
}

impl Turned {
    /// Boxes by some random numbers.
    #[must_use]
    pub fn boxes(rng: &mut Random) -> Self {
        let side = [2, 3, 4, 8][rng.below(4)];
        let bricks = bricks(rng, side, false, false);
        Self::of_bricks(bricks, side, rng)
    }

    /// Parts around a room, by some random numbers.
    #[must_use]
    pub fn room(rng: &mut Random) -> Self {
        let side = [1, 2, 3, 8][rng.below(4)];
        let parts = room(rng, 4 * side as i64);
        Self::of_bricks(parts, side, rng)
    }

    /// Prisms of one axis, some inside or beside others, by some random numbers.
    #[must_use]
    pub fn stack(rng: &mut Random) -> Self {
        let sides = [3, 4, 6, 12, 24][rng.below(5)];
        let mut parts = Vec::new();
        let mut area_of = [0.0_f64; 8];
        for _ in 0..2 + rng.below(4) {
            let (from, to, wide) = (rng.below(7), rng.below(7), 0.5 * (1 + rng.below(3)) as f64);
            let (from, to) = (from.min(to), from.max(to) + 1);
            let area = 0.5 * sides as f64 * (TAU / sides as f64).sin() * wide * wide;
            area_of[from..to].iter_mut().for_each(|most| *most = most.max(area));
            parts.push(prism(sides, wide, 0.5 * from as f64, 0.5 * to as f64));
        }
        Self::of(parts, 0.5 * area_of.iter().sum::<f64>(), rng)
    }

    /// Boxes between 0 and four times a side, turned.
    fn of_bricks(bricks: Vec<Brick>, side: usize, rng: &mut Random) -> Self {
        let far = [0; 3].map(|_| vec![-1, 4 * side as i64 + 1]);
        let scene = Scene { bricks, edges: far, triangles: Vec::new(), offset: 0, unit: 0.25 };
        let open = scene.truth(true).map_or(1.0, |t| t.v[0]);
        let width = 0.25 * (4 * side + 2) as f64;
        let corner = |p: [i64; 3]| DVec3::from_array(p.map(|c| c as f64 * scene.unit));
        let parts = scene.bricks.iter().map(|b| cuboid(corner(b.min), corner(b.max))).collect();
        Self::of(parts, (1.0 - open) * width.powi(3), rng)
    }

    /// Parts that look outward and whose union has a `volume`, turned. Two triangles each that follow each other have backs together.
    fn of(parts: Vec<Vec<Triangle>>, volume: f64, rng: &mut Random) -> Self {
        let most = [1.0, 0.1, 1e-3, 1e-6][rng.below(4)];
        let axis = [DVec3::Z, DVec3::from_array(rng.on_sphere())][rng.below(2)];
        let turn = DQuat::from_axis_angle(axis, most * rng.unit());
        let shift = [DVec3::ZERO, DVec3::new(3.3, -1.7, 0.9), DVec3::new(113.0, 47.0, -9.0)][rng.below(3)];
        let single = rng.below(4) > 0;
        let place = |p: DVec3| {
            let p = turn * p + shift;
            if single { p.as_vec3().as_dvec3() } else { p }
        };
        // Parts that were placed one by one are off by what their placing rounds.
        let apart = [0.0, 0.0, 0.0, APART][rng.below(4)];
        let mut put = |part: Vec<Triangle>| -> Vec<Triangle> {
            let off = DVec3::from_array(rng.on_sphere()) * apart;
            part.into_iter().map(|t| t.map(|p| place(p + off))).collect()
        };
        let parts: Vec<Vec<Triangle>> = parts.into_iter().map(&mut put).collect();
        let one_sided = parts.concat();
        let kind = rng.below(4);
        let mut triangles = one_sided.clone();
        for part in &parts {
            let part_has = kind != 2 || rng.below(2) == 0;
            for pair in part.chunks(2) {
                if part_has && (kind != 3 || rng.below(6) > 0) {
                    triangles.extend(pair.iter().map(|&[a, b, c]| [a, c, b]));
                }
            }
        }
        for n in (1..triangles.len()).rev() {
            triangles.swap(n, rng.below(n + 1));
        }
        Turned { one_sided, triangles, single, volume }
    }

    /// What is found for its triangles, all in one solid without a name.
    fn measured(&self, triangles: &[Triangle]) -> (Bodies, Porosity) {
        let mesh = Mesh { name: "turned".into(), single_precision: self.single, ..Mesh::from(triangles.to_vec()) };
        let mut bodies = Bodies::default();
        bodies.add(&mesh, 1.0).expect("parts have an area");
        let all = || self.one_sided.iter().flatten();
        let (lo, hi) = all().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let (lo, hi) = (lo - 0.013, hi + 0.017);
        let edges = [0, 1, 2].map(|a| {
            let cells = [5, 4, 3][a];
            (0..=cells).map(|i| lo[a] + (hi[a] - lo[a]) * f64::from(i) / f64::from(cells)).collect()
        });
        let options = Options { bounds: true, ..Options::default() };
        let found = porosity(&Edges(edges).grid(None).expect("a grid"), &bodies, options);
        (bodies, found)
    }
}

/// The bounds of every cell hold what the parts without backs have there, and those of all cells the volume of the union.
///
/// # Errors
/// The first value that they do not hold.
pub fn bounds_hold(seed: u64, make: fn(&mut Random) -> Turned) -> Result<Seen, String> {
    let turned = make(&mut Random::new(seed));
    let (_, one) = turned.measured(&turned.one_sided);
    let (bodies, two) = turned.measured(&turned.triangles);
    let slack = if turned.single { 2e-4 } else { 1e-7 };
    let [[a, b], [l, u]] =
        [&one, &two].map(|found| found.bounds.as_ref().expect("bounds").each_ref().map(|set| set.v.to_vec()));
    for n in 0..l.len() {
        if !(l[n] - slack <= b[n] && a[n] - slack <= u[n]) {
            return Err(format!(
                "turned seed {seed}: beta_v[{n}] is {} to {}, its bounds with backs {} and {}\n{:?}",
                a[n], b[n], l[n], u[n], bodies.warnings
            ));
        }
    }
    let all = turned
        .one_sided
        .iter()
        .flatten()
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[lo, hi], p| [lo.min(*p), hi.max(*p)]);
    let cell = (all[1] - all[0] + 0.03).element_product() / l.len() as f64;
    let solid = |beta: &[f64]| beta.iter().map(|b| (1.0 - b) * cell).sum::<f64>();
    let (least, most, truth) = (solid(&u), solid(&l), turned.volume);
    let slack = slack * cell * l.len() as f64;
    if !(least - slack <= truth && truth <= most + slack) {
        return Err(format!("turned seed {seed}: volume {truth}, found {least} to {most}\n{:?}", bodies.warnings));
    }
    Ok(Seen {
        exact: two.max_gap <= 1e-9,
        doubtful: bodies.diagnoses[0].doubtful > 0,
        doubled: turned.triangles.len() == 2 * turned.one_sided.len(),
    })
}
