//! debug
use glam::DVec3;
use std::hint::black_box;
use voidage_benches::compare;
use voidage_core::{shape::*, support::*};
use voidage_tests::{pairs::*, random::*};
fn main() {
    for n in [2, 4, 6] {
        let sphere = Geodesic::new(n);
        let hull = Hull::new(&sphere.vertices);
        let climb = hull.with_adjacency(sphere.adjacency());
        let mut r = Random::new(3);
        let d: Vec<DVec3> = (0..1000).map(|_| r.vector(1.0)).collect();
        let mut scan = || d.iter().map(|&d| hull.support(black_box(d), 0).index as usize).sum();
        let mut up = || d.iter().map(|&d| climb.support(black_box(d), 0).index as usize).sum();
        let mut far = || d.iter().map(|&d| climb.farthest(black_box(d)).index as usize).sum();
        println!("{n} {:?}", compare(1000, 31, &mut [&mut scan, &mut up, &mut far]));
    }
    let mut r = Random::new(3);
    let c = boxes(3, 1000, Nearness::Near);
    let c: Vec<_> = c.iter().map(|c| c.0.body().corners()).collect();
    let h: Vec<_> = c.iter().map(|c| Hull::new(c)).collect();
    let d: Vec<DVec3> = (0..1000).map(|_| r.vector(1.0)).collect();
    let mut scan = || d.iter().zip(&h).map(|(&d, h)| h.support(black_box(d), 0).index as usize).sum();
    println!("8: {:?}", compare(1000, 31, &mut [&mut scan]));
}
