//! debug
use glam::DVec3;
use voidage_core::{exact, gjk::*, shape::*};
use voidage_tests::corpus::*;
fn main() {
    let cases = read(&std::fs::read_to_string("tests/fixtures/gjk.jsonl").unwrap()).unwrap();
    for c in cases.iter() {
        let s = score::<DVec3>(c, 1.0);
        if s.distance_failures > 0 {
            let a: Vec<DVec3> = vectors(&c.a);
            let b: Vec<DVec3> = vectors(&c.b);
            println!("{:?} {:?}\n {:?}", a, b, c.contact);
            let (a, b) = (Hull::new(&a), Hull::new(&b));
            println!("{:e} {:?} {:?}", c.distance, distance(&a, &b, None), exact::distance(&a, &b, None));
        }
    }
}
