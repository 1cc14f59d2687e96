//! The truth about two small hulls with whole coordinates: everything is tried, in integers of 128 bits.
//!
//! Coordinates stay below 2^24 in size: then differences stay below 2^25, their products of two below 2^51, and products of such products
//! below 2^105.

use voidage_core::convex::exact::Contact;

/// A point with whole coordinates.
pub type WholePoint = [i64; 3];

type Wide = [i128; 3];

fn minus(a: &Wide, b: &Wide) -> Wide {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: &Wide, b: &Wide) -> Wide {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Wide, b: &Wide) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn wide(points: &[WholePoint]) -> Vec<Wide> {
    points.iter().map(|p| p.map(i128::from)).collect()
}

const ZERO: Wide = [0; 3];

/// Disjoint, touching or overlapping: by every direction that can be normal to a facet of the difference, or to an edge of a flat one.
#[must_use]
pub fn contact(a: &[WholePoint], b: &[WholePoint]) -> Contact {
    let (a, b) = (wide(a), wide(b));
    let (normals, flat) = normals(&a, &b);
    let mut touch = flat;
    for n in normals.iter().filter(|n| **n != ZERO) {
        for sign in [1, -1] {
            let high = a.iter().map(|p| sign * dot(n, p)).max();
            let low = b.iter().map(|p| sign * dot(n, p)).min();
            if low > high {
                return Contact::Disjoint;
            }
            touch |= low == high;
        }
    }
    if touch { Contact::Touching } else { Contact::Overlapping }
}

/// The directions to try, and whether the difference has no inner point.
fn normals(a: &[Wide], b: &[Wide]) -> (Vec<Wide>, bool) {
    let of_one = |points: &[Wide]| {
        let all = (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        all.map(|(i, j)| minus(&points[i], &points[j])).filter(|e| *e != ZERO).collect::<Vec<_>>()
    };
    let edges = [of_one(a), of_one(b)].concat();
    let pairs = (0..edges.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let mut normals: Vec<Wide> = pairs.map(|(i, j)| cross(&edges[i], &edges[j])).filter(|n| *n != ZERO).collect();
    let between = minus(&b[0], &a[0]);
    match (normals.first().copied(), edges.first()) {
        (Some(n), _) if edges.iter().all(|e| dot(&n, e) == 0) => {
            // All edges in one plane. Any normal of it will do, the smallest keeps the products small.
            let n = normals.iter().copied().min_by_key(|n| dot(n, n)).unwrap_or(n);
            normals = edges.iter().map(|e| cross(&n, e)).chain([n]).collect();
            (normals, true)
        }
        (Some(_), _) => (normals, false),
        (None, Some(e)) => (vec![*e, cross(e, &cross(&between, e))], true),
        (None, None) => (vec![between], true),
    }
}

/// The distance of two disjoint hulls: the least over all simplices of up to three differences, signs exact, the value to some roundings.
#[must_use]
pub fn distance(a: &[WholePoint], b: &[WholePoint]) -> f64 {
    let (a, b) = (wide(a), wide(b));
    let mut points: Vec<Wide> = a.iter().flat_map(|p| b.iter().map(move |q| minus(q, p))).collect();
    points.sort_unstable();
    points.dedup();
    let mut least_sq = f64::INFINITY;
    for (i, p) in points.iter().enumerate() {
        least_sq = least_sq.min(dot(p, p) as f64);
        for (j, q) in points[..i].iter().enumerate() {
            let e = minus(q, p);
            if dot(p, &e) <= 0 && dot(q, &e) >= 0 {
                let area = cross(p, &e);
                least_sq = least_sq.min(dot(&area, &area) as f64 / dot(&e, &e) as f64);
            }
            for r in &points[..j] {
                let n = cross(&e, &minus(r, p));
                let inside = |x: &Wide, y: &Wide| dot(&n, &cross(x, y)) >= 0;
                if n != ZERO && inside(p, q) && inside(q, r) && inside(r, p) {
                    let height = dot(&n, p) as f64;
                    least_sq = least_sq.min(height * height / dot(&n, &n) as f64);
                }
            }
        }
    }
    least_sq.sqrt()
}
