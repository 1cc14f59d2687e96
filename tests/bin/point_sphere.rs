//! Prints a sphere of evenly spread points as OBJ: `cargo run -p voidage-tests --bin point-sphere -- 360 > sphere_360.obj`.

fn main() {
    let count = std::env::args().nth(1).and_then(|n| n.parse().ok()).filter(|n| *n >= 4);
    match count {
        Some(count) => print!("{}", voidage_tests::solids::obj(&voidage_tests::solids::point_sphere(count))),
        None => {
            eprintln!("usage: point-sphere COUNT (at least 4)");
            std::process::exit(2);
        }
    }
}
