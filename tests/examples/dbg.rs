//! debug
use glam::DVec3;
use voidage_core::{exact, gjk::*, shape::Hull};
use voidage_tests::corpus::*;
fn main() {
    let cases = read(&std::fs::read_to_string("/work/shared/gjk/public.jsonl").unwrap()).unwrap();
    let f = 2f64.powi(-500) * 2f64.powi(-500);
    for c in cases.iter().filter(|c| c.kind.starts_with("far_origin_1e8") && c.scales_exactly::<DVec3>(f)) {
        let s = score::<DVec3>(c, f);
        if s.wrong > 0 {
            let a: Vec<DVec3> = c.a.iter().map(|p| DVec3::from_array(*p) * f).collect();
            let b: Vec<DVec3> = c.b.iter().map(|p| DVec3::from_array(*p) * f).collect();
            let (a, b) = (Hull::new(&a), Hull::new(&b));
            let i = intersect(&a, &b, None);
            println!("{:?} {:?}", c.contact, exact::settle(&a, &b, None));
            if let Intersection::Overlapping { proof: Overlap::Inside(s) } = i {
                println!(
                    "{} {:?}",
                    s.holds_origin(0.0),
                    s.a.iter().map(|p| a.vertices().contains(p)).collect::<Vec<_>>()
                );
                println!("{:?}", s);
            }
        }
    }
    let f = 2f64.powi(510) * 2f64.powi(505);
    for c in cases.iter().filter(|c| c.kind.starts_with("") && c.scales_exactly::<DVec3>(f)) {
        let s = score::<DVec3>(c, f);
        if s.distance_failures > 0 {
            let a: Vec<DVec3> = c.a.iter().map(|p| DVec3::from_array(*p) * f).collect();
            let b: Vec<DVec3> = c.b.iter().map(|p| DVec3::from_array(*p) * f).collect();
            let (a, b) = (Hull::new(&a), Hull::new(&b));
            println!("{} {:?} {:?}", c.distance * f, distance(&a, &b, None), exact::distance(&a, &b, None));
        }
    }
}
