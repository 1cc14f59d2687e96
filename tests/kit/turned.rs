//! Boxes of a common lattice that is turned, as the parts of a plant stand in a file: corners that lay on edges and sides lie beside them by
//! rounding, and sides that lay in one plane cross at tiny angles. With backs, and without.
//!
//! **Truth.** All boxes look outward, so the solid is their union, whose volume no turn changes. In every cell, a file with backs is the file
//! without.

use crate::boxes::{Scene, bricks};
use crate::random::Random;
use crate::solids::{Triangle, cuboid};
use glam::{DQuat, DVec3};
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};

/// How far boxes stand beside the lattice where they were placed one by one [m].
const APART: f64 = 1e-9;

/// Boxes, turned.
#[derive(Debug, Clone)]
pub struct Turned {
    /// The triangles of all boxes, without backs.
    pub one_sided: Vec<Triangle>,
    /// The same and the backs of some, in any order.
    pub triangles: Vec<Triangle>,
    /// Coordinates are those of binary STL.
    pub single: bool,
    /// Of the union, before the turn.
    pub volume: f64,
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
    pub fn new(rng: &mut Random) -> Self {
        let side = [2, 3, 4, 8][rng.below(4)];
        let far = [0; 3].map(|_| vec![-1, 4 * side as i64 + 1]);
        let scene =
            Scene { bricks: bricks(rng, side, false, false), edges: far, triangles: Vec::new(), offset: 0, unit: 0.25 };
        let truth = scene.truth(true).map_or(1.0, |t| t.v[0]);
        let width = 0.25 * (4 * side + 2) as f64;
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
        let mut one_sided = Vec::new();
        for b in &scene.bricks {
            let [lo, hi] = [b.min, b.max].map(|p| DVec3::from_array(p.map(|c| c as f64 * scene.unit)));
            let off = DVec3::from_array(rng.on_sphere()) * apart;
            one_sided.extend(cuboid(lo, hi).into_iter().map(|t| t.map(|p| place(p + off))));
        }
        let kind = rng.below(4);
        let mut triangles = one_sided.clone();
        for of_box in one_sided.chunks_exact(12) {
            let box_has = kind != 2 || rng.below(2) == 0;
            for of_side in of_box.chunks_exact(2) {
                if box_has && (kind != 3 || rng.below(6) > 0) {
                    triangles.extend(of_side.iter().map(|&[a, b, c]| [a, c, b]));
                }
            }
        }
        for n in (1..triangles.len()).rev() {
            triangles.swap(n, rng.below(n + 1));
        }
        Turned { one_sided, triangles, single, volume: (1.0 - truth) * width.powi(3) }
    }

    /// What is found for its triangles, all in one solid without a name.
    fn measured(&self, triangles: &[Triangle]) -> (Bodies, Porosity) {
        let mesh = Mesh { name: "turned".into(), single_precision: self.single, ..Mesh::from(triangles.to_vec()) };
        let mut bodies = Bodies::default();
        bodies.add(&mesh, 1.0).expect("boxes have an area");
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

/// The bounds of every cell hold what the boxes without backs have there, and those of all cells the volume of the union.
///
/// # Errors
/// The first value that they do not hold.
pub fn bounds_hold(seed: u64) -> Result<Seen, String> {
    let turned = Turned::new(&mut Random::new(seed));
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
