//! Where two skew walls meet, in cells of unequal widths: gas that runs along both, and gas at rest.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_tests::euler::space::half_space;

const GAMMA: f64 = 1.4;

type Point = [f64; 3];

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|d| a[d] * b[d]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|d| a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3])
}

/// Two planes through the origin; the solid lies behind both (a ridge) or behind either (a corner), where normal · x < 0.
#[derive(Clone, Copy)]
struct TwoWalls {
    normals: [Point; 2],
    ridge: bool,
}

impl TwoWalls {
    /// Open share of a face, a box flat along one axis.
    fn open_face(&self, flat: usize, low: Point, high: Point) -> f64 {
        let [a, b] = self.normals.map(|n| 1.0 - half_space(n, 0.0, low, high));
        let both = self.before_both(flat, low, high);
        (if self.ridge { a + b - both } else { both }).clamp(0.0, 1.0)
    }

    /// Share of a face in front of both planes: a rectangle clipped twice (Sutherland and Hodgman), its area by the shoelace formula.
    fn before_both(&self, flat: usize, low: Point, high: Point) -> f64 {
        let (u, v) = ((flat + 1) % 3, (flat + 2) % 3);
        let corner = |s: f64, t: f64| {
            let mut x = low;
            x[u] += s * (high[u] - low[u]);
            x[v] += t * (high[v] - low[v]);
            x
        };
        let mut polygon = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        for normal in self.normals {
            let mut kept = Vec::new();
            for (i, &p) in polygon.iter().enumerate() {
                let q = polygon[(i + 1) % polygon.len()];
                let (a, b) = (dot(normal, p), dot(normal, q));
                if a >= 0.0 {
                    kept.push(p);
                }
                if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                    kept.push(std::array::from_fn(|d| p[d] + a / (a - b) * (q[d] - p[d])));
                }
            }
            polygon = kept;
        }
        let Some(&first) = polygon.first() else { return 0.0 };
        let from = |p: Point| (p[u] - first[u], p[v] - first[v]);
        let twice = |p: Point, q: Point| from(p).0 * from(q).1 - from(p).1 * from(q).0;
        let area: f64 = polygon.windows(2).map(|w| 0.5 * twice(w[0], w[1])).sum();
        area / ((high[u] - low[u]) * (high[v] - low[v]))
    }
}

/// Widths that grow from cell to cell, with their edges; the origin lies inside, in no corner of the mesh.
fn axis(n: usize, first: f64, growth: f64) -> (Vec<f64>, Vec<f64>) {
    let widths: Vec<f64> = (0..n).map(|i| first * growth.powi(i as i32)).collect();
    let mut edges = vec![0.0];
    widths.iter().for_each(|w| edges.push(edges.last().unwrap() + w));
    let middle = 0.513 * edges[n];
    (widths, edges.iter().map(|e| e - middle).collect())
}

/// The flow of a gas of pressure 1 and a velocity past two walls, after some steps: the largest error of the pressure in units of `unit`
/// and of the velocity in units of its own size or, at rest, of the speed of sound.
fn error<R: Scalar>(walls: TwoWalls, velocity: Point, unit: f64) -> f64 {
    let axes = [axis(9, 0.1, 1.1), axis(8, 0.04, 1.0), axis(7, 0.31, 0.9)];
    let n: [usize; 3] = std::array::from_fn(|d| axes[d].0.len());
    let to = |x: f64| R::from_f64(x);
    let faces: [Vec<f64>; 3] = std::array::from_fn(|d| {
        let size: [usize; 3] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        let face = |f: usize| {
            let at = [f % size[0], f / size[0] % size[1], f / (size[0] * size[1])];
            let low: Point = std::array::from_fn(|a| axes[a].1[at[a]]);
            let high = std::array::from_fn(|a| if a == d { low[a] } else { axes[a].1[at[a] + 1] });
            walls.open_face(d, low, high)
        };
        (0..size.iter().product()).map(face).collect()
    });
    let cells: usize = n.iter().product();
    let at = |c: usize| [c % n[0], c / n[0] % n[1], c / (n[0] * n[1])];
    // By Gauss from the faces alone: the walls pass through the origin, so x · n vanishes on them.
    let volume = |c: usize| {
        let at = at(c);
        let share = |d: usize| {
            let size: [usize; 3] = std::array::from_fn(|a| n[a] + usize::from(a == d));
            let index = |k: usize| {
                let mut f = at;
                f[d] += k;
                f[0] + size[0] * (f[1] + size[1] * f[2])
            };
            let edge = |k: usize| axes[d].1[at[d] + k];
            (edge(1) * faces[d][index(1)] - edge(0) * faces[d][index(0)]) / (edge(1) - edge(0))
        };
        ((0..3).map(share).sum::<f64>() / 3.0).clamp(0.0, 1.0)
    };
    let open: Vec<f64> = (0..cells).map(volume).collect();
    let w = Primitive { density: R::ONE, velocity: velocity.map(to), pressure: R::ONE };
    let widths = axes.each_ref().map(|a| a.0.iter().map(|&x| to(x)).collect());
    let gas = Gas::Ideal { gamma: to(GAMMA) };
    let mut flow = Flow::<R, 3>::new(widths, gas, [[Boundary::FarField(w); 2]; 3]);
    let fractions = |s: &Vec<f64>| s.iter().map(|&x| to(x)).collect::<Vec<R>>();
    flow.set_porosity(fractions(&open), faces.each_ref().map(fractions), Treatment::default()).unwrap();
    flow.fill(|_| w);
    for _ in 0..20 {
        flow.advance(to(0.8), R::MAX).unwrap();
    }
    assert_eq!(flow.total.floored, 0);
    let size = dot(velocity, velocity).sqrt();
    let speed = if size > 0.0 { size } else { GAMMA.sqrt() };
    (0..cells).filter(|&c| open[c] > 1e-4).fold(0.0, |most: f64, c| {
        let now = flow.get(c);
        let change = |d: usize| (now.velocity[d] - w.velocity[d]).to_f64().abs() / speed;
        let pressure = (now.pressure - w.pressure).to_f64().abs() / unit;
        assert!(pressure.is_finite());
        (0..3).fold(most.max(pressure), |most, d| most.max(change(d)))
    })
}

/// Normals of walls, skew in general and of equal components.
const WALLS: [[Point; 2]; 4] = [
    [[1.0, 2.0, 3.0], [-2.0, 1.0, 0.7]],
    [[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]],
    [[0.3, -1.0, 0.2], [0.2, 0.1, 1.0]],
    [[1.0, 1.0, 0.0], [0.0, -1.0, 1.0]],
];

/// The error came from the walls' areas being compared as shares of the faces: only in cubes is a share of 0.1 along x as large as along y.
#[test]
fn a_stream_along_the_edge_of_two_walls_stays_as_it_is() {
    for normals in WALLS {
        let along = cross(normals[0], normals[1]);
        let length = dot(along, along).sqrt();
        for ridge in [false, true] {
            for mach in [0.001, 0.1, 2.5] {
                let speed = mach * GAMMA.sqrt();
                let velocity = along.map(|x| speed * x / length);
                let found = error::<f64>(TwoWalls { normals, ridge }, velocity, 0.5 * speed * speed);
                assert!(found < 1e-9 / mach, "{normals:?}, ridge {ridge}, Mach {mach}: {found:e}");
            }
            let speed = 0.5 * GAMMA.sqrt();
            let velocity = along.map(|x| speed * x / length);
            let single = error::<f32>(TwoWalls { normals, ridge }, velocity, 0.5 * speed * speed);
            assert!(single < 2e-3, "{normals:?}, ridge {ridge}, in single precision: {single:e}");
            let rest = error::<f64>(TwoWalls { normals, ridge }, [0.0; 3], 1.0);
            assert!(rest < 1e-13, "{normals:?}, ridge {ridge}, at rest: {rest:e}");
        }
    }
}
