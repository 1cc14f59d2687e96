//! Clusters of small cells stay local, whatever is equal to what: where a wall repeats itself from cell to cell, too.

use glam::DVec3;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{Options, porosity};
use voidage_core::convex::shape::Cylinder;
use voidage_core::flow::{Fractions, Merging, Mesh, Treatment, cluster_scratch, prepare};
use voidage_core::number::real::Real;
use voidage_tests::euler::space::{OpenFractions, half_space, open_fractions};
use voidage_tests::solids::formulas;

/// The clusters of open fractions of a mesh of equal cells, each a sorted list of cells.
fn clusters<R: Real, const D: usize>(n: [usize; D], open: &OpenFractions<D>) -> Vec<Vec<usize>> {
    let widths = n.map(|n| vec![R::ONE; n]);
    let mesh = Mesh::new(widths.each_ref().map(|w| &w[..])).unwrap();
    let to = |s: &Vec<f64>| s.iter().map(|&x| R::from_f64(x)).collect::<Vec<R>>();
    let of = Fractions { volume: to(&open.volume), faces: open.faces.each_ref().map(to), flags: vec![0; mesh.len()] };
    let merging = |cells| Merging {
        list: vec![0; cells],
        parent: vec![0; cells],
        scratch: vec![R::ZERO; cluster_scratch(cells)],
    };
    let space = prepare(&mesh, [false; D], of, Treatment::default(), merging).unwrap();
    let mut all: Vec<Vec<usize>> = space.view::<R>().clusters().map(|c| c.collect()).collect();
    all.iter_mut().for_each(|c| c.sort_unstable());
    all.sort();
    all
}

fn at<const D: usize>(n: [usize; D], mut cell: usize) -> [usize; D] {
    n.map(|n| {
        let i = cell % n;
        cell /= n;
        i
    })
}

/// Cells along the longest side of the box around any cluster.
fn longest<const D: usize>(n: [usize; D], clusters: &[Vec<usize>]) -> usize {
    let length = |c: &Vec<usize>, d: usize| {
        let along = || c.iter().map(|&cell| at(n, cell)[d]);
        along().max().unwrap() - along().min().unwrap() + 1
    };
    clusters.iter().flat_map(|c| (0..D).map(|d| length(c, d))).max().unwrap_or(0)
}

#[test]
fn clusters_along_walls_with_equal_components_stay_local() {
    let n = [40, 40];
    for normal in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, 2.0], [3.0, -1.0]] {
        for shift in [0.1, 0.25, 0.3, 0.5, 0.6] {
            let offset = 20.0 * (normal[0] + normal[1]) + shift;
            let open = open_fractions(n, [0.0; 2], 1.0, |low, high| half_space(normal, offset, low, high));
            for found in [clusters::<f64, 2>(n, &open), clusters::<f32, 2>(n, &open)] {
                assert!(longest(n, &found) <= 3, "{normal:?} {shift}: {} cells", longest(n, &found));
            }
        }
    }
    let n = [16, 16, 16];
    for normal in
        [[1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [2.0, 1.0, 1.0]]
    {
        for shift in [0.2, 0.5, 0.7] {
            let offset = 8.0 * normal.iter().sum::<f64>() + shift;
            let open = open_fractions(n, [0.0; 3], 1.0, |low, high| half_space(normal, offset, low, high));
            for found in [clusters::<f64, 3>(n, &open), clusters::<f32, 3>(n, &open)] {
                assert!(longest(n, &found) <= 4, "{normal:?} {shift}: {} cells", longest(n, &found));
            }
        }
    }
}

/// Slices between open cells, and a space of small cells only: each is as good a neighbour as the next.
#[test]
fn clusters_of_cells_that_are_all_alike_stay_local() {
    let n = [64];
    for every in [2, 3, 1] {
        let volume = (0..64).map(|i| if i % every == 0 { 0.1 } else { 1.0 }).collect();
        let open = OpenFractions { volume, faces: [vec![1.0; 65]] };
        for found in [clusters::<f64, 1>(n, &open), clusters::<f32, 1>(n, &open)] {
            assert!(!found.is_empty() && longest(n, &found) <= 16, "every {every}: {} cells", longest(n, &found));
        }
    }
    let n = [24, 24];
    let open = OpenFractions { volume: vec![0.1; 576], faces: [vec![1.0; 600], vec![1.0; 600]] };
    let found = clusters::<f64, 2>(n, &open);
    assert!(longest(n, &found) <= 12, "{} cells", longest(n, &found));
}

/// Clusters with each cell moved elsewhere.
fn moved<const D: usize>(
    n: [usize; D],
    clusters: &[Vec<usize>],
    to: impl Fn([usize; D]) -> [usize; D],
) -> Vec<Vec<usize>> {
    let number = |at: [usize; D]| at.iter().zip(n).rev().fold(0, |number, (i, n)| number * n + i);
    let mut all: Vec<Vec<usize>> =
        clusters.iter().map(|c| c.iter().map(|&cell| number(to(at(n, cell)))).collect()).collect();
    all.iter_mut().for_each(|c| c.sort_unstable());
    all.sort();
    all
}

/// Pipes that touch planes of the grid but for rounding: the face in front is open but for a slit as wide as the root of that, on one side and not on the other.
#[test]
fn mirrored_pipes_give_mirrored_clusters() {
    let n = [6, 20, 20];
    let mut found = 0;
    for (radius, length) in [(0.1, 2.0), (0.2, 2.0), (0.3, 2.0), (1e4, 2e5), (3e-4, 2e-3)] {
        let edges = Edges::uniform(DVec3::ZERO, DVec3::new(0.3 * length, length, length), n);
        for (y, z) in [(0.5, 0.25), (0.35, 0.3), (0.3, 0.5), (0.25, 0.65)] {
            let pipe = |y: f64| {
                let end = |x: f64| DVec3::new(x, y, z) * length;
                Form::Cylinder(Cylinder::new(end(-0.1), end(0.5), radius))
            };
            let scene = formulas(&[pipe(y), pipe(1.0 - y)][usize::from(y == 0.5)..]);
            let beta = porosity(&edges.grid(None).unwrap(), &scene, Options::default()).beta;
            let faces = [0, 1, 2].map(|axis| beta.faces(axis).to_vec());
            let clusters = clusters::<f64, 3>(n, &OpenFractions { volume: beta.v.to_vec(), faces });
            let mirrored = moved(n, &clusters, |[i, j, k]| [i, n[1] - 1 - j, k]);
            assert_eq!(mirrored, clusters, "radius {radius} at {y}, {z}");
            found += clusters.len();
        }
    }
    assert!(found > 100, "{found} clusters");
}

#[test]
fn mirrored_and_exchanged_porosity_gives_mirrored_and_exchanged_clusters() {
    let n = [30, 30];
    let wall = |normal: [f64; 2], offset: f64| {
        clusters::<f64, 2>(n, &open_fractions(n, [-15.0; 2], 1.0, |low, high| half_space(normal, offset, low, high)))
    };
    let seen = |clusters: &[Vec<usize>], to: fn([usize; 2]) -> [usize; 2]| moved(n, clusters, to);
    let mut found = 0;
    for (a, b) in [(1.0, 1.0), (1.0, 2.0), (1.0, 0.3)] {
        for offset in [0.5, 0.7, 3.6] {
            let one = wall([a, b], offset);
            found += one.len();
            assert_eq!(seen(&one, |[i, j]| [29 - i, j]), wall([-a, b], offset), "mirrored {a} {b} {offset}");
            assert_eq!(seen(&one, |[i, j]| [i, 29 - j]), wall([a, -b], offset), "mirrored {a} {b} {offset}");
            assert_eq!(seen(&one, |[i, j]| [j, i]), wall([b, a], offset), "exchanged {a} {b} {offset}");
        }
    }
    assert!(found > 100, "{found} clusters");
}
