//! Solids by formula as the library measures them: alone, in unions, and their bounds beside those of subdivision.

use glam::DVec3;
use std::f64::consts::PI;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Method, Options, Porosity, porosity};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Sphere};
use voidage_tests::random::Random;
use voidage_tests::solids::formulas;

fn lists(n: usize) -> Edges {
    Edges([0, 1, 2].map(|_| (0..=n).map(|i| i as f64 * 0.25).collect()))
}

fn run(edges: &Edges, forms: &[Form], options: Options) -> Porosity {
    porosity(&edges.grid(None).expect("a grid"), &formulas(forms), Options { bounds: true, ..options })
}

/// Some solids of all kinds in a box of 4 by 4 by 4.
fn some(random: &mut Random, count: usize, size: f64) -> Vec<Form> {
    (0..count)
        .map(|n| {
            let a = random.point(DVec3::splat(0.3), DVec3::splat(3.7));
            let b = random.point(DVec3::splat(0.3), DVec3::splat(3.7));
            let radius = size * random.between(0.3, 1.0);
            match n % 4 {
                0 => Form::Sphere(Sphere { center: a, radius }),
                1 => Form::Cylinder(Cylinder::new(a, b, radius)),
                2 => Form::Capsule(Capsule { from: a, to: b, radius }),
                _ => Form::Cone(Cone::new(a, b, radius)),
            }
        })
        .collect()
}

/// All fields of a result: values, lower and upper bounds.
fn fields(p: &Porosity) -> [Vec<&[f64]>; 3] {
    fn sets(f: &FieldSet) -> Vec<&[f64]> {
        vec![&f.v, &f.x, &f.y, &f.z]
    }
    let [low, high] = p.bounds.as_ref().expect("bounds");
    [sets(&p.beta), sets(low), sets(high)]
}

/// Whatever meets, the bounds of closed forms and of subdivision overlap; and in the end both know the value.
#[test]
fn bounds_agree_with_those_of_subdivision() {
    let mut random = Random::new(71);
    let edges = lists(16);
    for count in [1, 2, 4, 9, 16] {
        let forms = some(&mut random, count, 0.4);
        let tol = 1e-3;
        let auto = run(&edges, &forms, Options { tol, ..Options::default() });
        let gjk = run(&edges, &forms, Options { tol, method: Method::Gjk, ..Options::default() });
        assert!(auto.max_gap <= tol + 1e-12, "{count}: {}", auto.max_gap);
        assert_eq!((auto.by_formula, auto.subdivided), (count, 0));
        let ([_, low, high], [_, least, most]) = (fields(&auto), fields(&gjk));
        for kind in 0..4 {
            for n in 0..low[kind].len() {
                let (l, h) = (low[kind][n].max(least[kind][n]), high[kind][n].min(most[kind][n]));
                assert!(
                    l <= h + 1e-12,
                    "{count}: field {kind} at {n}: {} {} and {} {}",
                    low[kind][n],
                    high[kind][n],
                    least[kind][n],
                    most[kind][n]
                );
            }
        }
    }
}

#[test]
fn one_solid_alone_is_exact_and_needs_no_gjk() {
    let mut random = Random::new(5);
    for form in some(&mut random, 8, 0.4) {
        let found = run(&lists(16), std::slice::from_ref(&form), Options::default());
        assert_eq!((found.max_gap, found.gjk.queries), (0.0, 0));
    }
}

/// Parallel pipes a hundredth apart, in the same cells: apart, so exact.
#[test]
fn pipes_side_by_side_add_up() {
    let pipe = |y: f64| Form::Cylinder(Cylinder::new(DVec3::new(0.1, y, 1.1), DVec3::new(3.9, y + 0.3, 1.4), 0.05));
    let forms: Vec<Form> = (0..8).map(|n| pipe(1.0 + 0.11 * f64::from(n))).collect();
    let found = run(&lists(16), &forms, Options::default());
    let volume = 8.0 * std::f64::consts::PI * 0.0025 * DVec3::new(3.8, 0.3, 0.3).length();
    assert_eq!((found.max_gap, found.gjk.queries), (0.0, 0));
    assert!((found.solid_volume - volume).abs() < 1e-13, "{} and {volume}", found.solid_volume);
}

/// A run of pipes end to end: volumes add up; the faces between them, in planes of the grid, are one disc.
#[test]
fn pipes_end_to_end_are_one_pipe() {
    let at = |x: f64| DVec3::new(x, 2.1, 2.23);
    let pipe = |a: f64, b: f64| Form::Cylinder(Cylinder::new(at(a), at(b), 0.3));
    let parts = run(&lists(16), &[pipe(0.5, 1.5), pipe(1.5, 2.6), pipe(2.6, 3.5)], Options::default());
    let whole = run(&lists(16), &[pipe(0.5, 3.5)], Options::default());
    for (kind, (a, b)) in fields(&parts)[0].iter().zip(&fields(&whole)[0]).enumerate() {
        assert!(a.iter().zip(*b).all(|(a, b)| (a - b).abs() <= 1e-13), "field {kind}");
    }
    assert_eq!((parts.max_gap, parts.gjk.queries), (0.0, 0));
}

/// Long pipes in small cells that overlap by about a billionth of their length are one pipe, which the bounds hold; pipes flush but for rounding have no gap.
#[test]
fn pipes_that_overlap_by_next_to_nothing_are_one_pipe() {
    let mut random = Random::new(71);
    for (n, overlap) in [0.0, 1e-13, 1e-11, 1e-10, 4e-10, 9e-10, 3e-9, 1e-7].into_iter().cycle().take(96).enumerate() {
        let turned = DVec3::from_array(random.on_sphere());
        let along = [DVec3::X, DVec3::Y, DVec3::Z, turned][random.below(4)];
        let (length, radius) = ([3.0, 30.0, 1000.0][random.below(3)], random.between(0.1, 0.7));
        // Every other joint lies in planes of the grid.
        let middle =
            if n / 8 % 2 == 0 { DVec3::splat(2.0) } else { random.point(DVec3::splat(1.9), DVec3::splat(2.1)) };
        let pipe = |a: f64, b: f64| Form::Cylinder(Cylinder::new(middle + along * a, middle + along * b, radius));
        let common = overlap * length;
        let parts = run(&lists(16), &[pipe(-length, 0.5 * common), pipe(-0.5 * common, length)], Options::default());
        let whole = run(&lists(16), &[pipe(-length, length)], Options::default());
        let what = format!("{n}: {overlap} of {length} along {along}, radius {radius}");
        let ([_, low, high], [exact, ..]) = (fields(&parts), fields(&whole));
        for ((low, high), exact) in low.iter().zip(high).zip(exact) {
            for ((low, high), exact) in low.iter().zip(high).zip(exact) {
                assert!(low - 2e-11 <= *exact && *exact <= high + 2e-11, "{exact} not in {low} to {high}: {what}");
            }
        }
        let told = 8.0 * common / 0.25;
        assert!(
            parts.max_gap <= told.max(1e-9) || overlap > 1e-9 && parts.max_gap <= 1e-4,
            "{}: {what}",
            parts.max_gap
        );
    }
}

/// Two balls: the volume of their union is known.
#[test]
fn balls_that_meet_lie_within_their_bounds() {
    let (r, d) = (0.7_f64, 0.9);
    let ball = |x: f64| Form::Sphere(Sphere { center: DVec3::new(x, 2.03, 1.98), radius: r });
    let found = run(&lists(16), &[ball(1.4), ball(1.4 + d)], Options::default());
    let pi = std::f64::consts::PI;
    let lens = pi * (2.0 * r - d).powi(2) * (d * d + 4.0 * d * r) / (12.0 * d);
    let union = 8.0 / 3.0 * pi * r.powi(3) - lens;
    let [low, high] = found.bounds.as_ref().expect("bounds");
    let solid = |f: &[f64]| f.iter().map(|b| 1.0 - b).sum::<f64>() / 64.0;
    assert!(solid(&high.v) <= union + 1e-12 && union - 1e-12 <= solid(&low.v), "{union}");
    // The circle in which they meet keeps cells and faces from the tolerance at the default depth, but not by much.
    assert!(found.max_gap <= 1e-3 && (found.solid_volume - union).abs() < 1e-4, "{}", found.max_gap);
}

/// Hundreds of tubes through a header, all in one cell: more than a list of solids that meet used to hold.
#[test]
fn tubes_through_a_header_in_one_cell() {
    let (small, large, step) = (0.01, 0.25, 2.0 / 30.0);
    let lines = |n: i32, middle: f64| (0..n).map(move |i| middle + step * (f64::from(i) - f64::from(n - 1) / 2.0));
    let tubes = lines(30, 1.75).flat_map(|x| lines(9, 1.75).map(move |y| DVec3::new(x, y, 0.6)));
    let tube = |from: DVec3| Form::Cylinder(Cylinder::new(from, from.with_z(3.0), small));
    let mut forms: Vec<Form> = tubes.map(tube).collect();
    let header = Cylinder::new(DVec3::new(0.3, 1.75, 0.9), DVec3::new(3.2, 1.75, 0.9), large);
    forms.push(Form::Cylinder(header));
    let edges = Edges([0, 1, 2].map(|_| vec![0.0, 3.5]));
    let found = run(&edges, &forms, Options::default());
    // What a tube has in common with the header, by its slices along the header.
    let common = |aside: f64| -> f64 {
        let slices = 20_000;
        let slice = |n: i32| {
            let t = PI * ((f64::from(n) + 0.5) / f64::from(slices) - 0.5);
            let y = aside + small * t.sin();
            4.0 * (small * t.cos()).powi(2) * (large * large - y * y).max(0.0).sqrt()
        };
        (0..slices).map(slice).sum::<f64>() * PI / f64::from(slices)
    };
    let of_tubes = 270.0 * PI * small * small * 2.4 - 30.0 * lines(9, 0.0).map(common).sum::<f64>();
    let solid = (of_tubes + PI * large * large * 2.9) / 3.5_f64.powi(3);
    let [low, high] = found.bounds.as_ref().expect("bounds");
    let (low, high) = (1.0 - high.v[0], 1.0 - low.v[0]);
    assert!(low - 1e-9 <= solid && solid <= high + 1e-9, "{low} to {high}, not {solid}");
    assert!(found.max_gap <= 1e-4, "{:e} apart", found.max_gap);
}

#[test]
fn a_ball_within_a_ball_is_not_seen() {
    let ball = |radius| Form::Sphere(Sphere { center: DVec3::splat(2.0), radius });
    let both = run(&lists(16), &[ball(1.0), ball(0.4)], Options::default());
    let one = run(&lists(16), &[ball(1.0)], Options::default());
    assert!(both.beta == one.beta && both.max_gap == 0.0);
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let forms = some(&mut Random::new(8), 12, 0.3);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(&lists(12), &forms, Options { tol: 1e-3, ..Options::default() }))
    };
    assert!(with(1) == with(3));
}
