//! debug
use glam::DVec3;
use voidage_core::{aabb::Aabb, exact, gjk::*, shape::*};
use voidage_tests::pairs::*;
fn main() {
    let sphere = Geodesic::new(6);
    let hull = Hull::new(&sphere.vertices).with_adjacency(sphere.adjacency());
    let mut n = std::collections::BTreeMap::new();
    let mut shown = 0;
    for code in 0..1u32 << 15 {
        let bits = |shift: u32| (0..5).map(|i| (code >> (3 * i + shift) & 1) << i).sum::<u32>();
        let min = DVec3::new(bits(0).into(), bits(1).into(), bits(2).into()) / 16.0 * 1.2 - DVec3::splat(1.2);
        let c = Aabb { min, max: min + DVec3::splat(1.2 / 16.0) };
        let r = intersect(&c, &hull, None);
        if let Intersection::Undecided { reason, axis } = r {
            let e = exact::settle(&c, &hull, None).unwrap();
            *n.entry(format!("{reason:?} {e:?}")).or_insert(0) += 1;
            if shown < 5 && e == exact::Contact::Overlapping {
                shown += 1;
                println!("{c:?} {axis:?}");
            }
        }
    }
    println!("{n:?}");
}
