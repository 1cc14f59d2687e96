//! Slow and certain answers about pairs of hulls, in unbounded integers and fractions, by trying everything.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use voidage_core::convex::exact::Contact;

type P = [BigInt; 3];

/// Coordinates as integers in a common unit `2^unit`.
fn integers(points: &[&[[f64; 3]]]) -> (Vec<Vec<P>>, i32) {
    let parts = |x: f64| {
        let bits = x.to_bits();
        let field = (bits >> 52 & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
        (if x < 0.0 { -m } else { m }, e)
    };
    let all = points.iter().flat_map(|p| p.iter()).flatten();
    let unit = all.map(|&x| parts(x)).filter(|p| p.0 != 0).map(|p| p.1).min().unwrap_or(0);
    let integer = |x: &f64| {
        let (m, e) = parts(*x);
        if m == 0 { BigInt::zero() } else { BigInt::from(m) << (e - unit) as usize }
    };
    (points.iter().map(|p| p.iter().map(|q| q.each_ref().map(integer)).collect()).collect(), unit)
}

fn sub(a: &P, b: &P) -> P {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn cross(a: &P, b: &P) -> P {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

fn dot(a: &P, b: &P) -> BigInt {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn is_zero(a: &P) -> bool {
    a.iter().all(Zero::is_zero)
}

/// Disjoint, touching or overlapping: by every direction that can be normal to a facet of the difference, or to an edge of a flat one.
pub fn contact(a: &[[f64; 3]], b: &[[f64; 3]]) -> Contact {
    let (points, _) = integers(&[a, b]);
    let (a, b) = (&points[0], &points[1]);
    let edges: Vec<P> = [a, b]
        .iter()
        .flat_map(|p| (0..p.len()).flat_map(move |i| (0..i).map(move |j| sub(&p[i], &p[j]))))
        .filter(|e| !is_zero(e))
        .collect();
    let first = sub(&b[0], &a[0]);
    let mut normals = Vec::new();
    for (i, e) in edges.iter().enumerate() {
        normals.extend(edges[..i].iter().map(|f| cross(e, f)).filter(|n| !is_zero(n)));
    }
    let flat = {
        let plane = normals.first().cloned();
        plane.filter(|n| edges.iter().all(|e| dot(n, e).is_zero()))
    };
    if let Some(n) = &flat {
        normals.extend(edges.iter().map(|e| cross(n, e)));
        normals.push(n.clone());
    } else if normals.is_empty() {
        // On a line, or a single point.
        match edges.first() {
            Some(e) => normals.extend([e.clone(), cross(e, &cross(&first, e))]),
            None => normals.push(first.clone()),
        }
    }
    let thin = flat.is_some() || edges.is_empty() || normals.len() == 2;
    let mut weak = thin;
    for n in normals.iter().filter(|n| !is_zero(n)) {
        for sign in [1, -1] {
            let along = |p: &P| dot(n, p) * sign;
            let high = a.iter().map(along).max().expect("a vertex");
            let low = b.iter().map(along).min().expect("a vertex");
            if low > high {
                return Contact::Disjoint;
            }
            weak |= low == high;
        }
    }
    if weak { Contact::Touching } else { Contact::Overlapping }
}

/// The squared distance of two small hulls, as a fraction and its unit's exponent: the least over all simplices of up to three differences.
pub fn distance_sq(a: &[[f64; 3]], b: &[[f64; 3]]) -> (BigRational, i32) {
    let (points, unit) = integers(&[a, b]);
    let mut w: Vec<P> = points[0].iter().flat_map(|p| points[1].iter().map(|q| sub(q, p))).collect();
    w.sort();
    w.dedup();
    let ratio = |n: BigInt, d: BigInt| BigRational::new(n, d);
    let mut best = ratio(dot(&w[0], &w[0]), BigInt::from(1));
    let mut offer = |candidate: BigRational| {
        if candidate < best {
            best = candidate;
        }
    };
    for (i, p) in w.iter().enumerate() {
        offer(ratio(dot(p, p), BigInt::from(1)));
        for (j, q) in w.iter().enumerate().take(i) {
            let e = sub(q, p);
            if !dot(p, &e).is_positive() && !dot(q, &e).is_negative() {
                let area = cross(p, &e);
                offer(ratio(dot(&area, &area), dot(&e, &e)));
            }
            for r in &w[..j] {
                let n = cross(&e, &sub(r, p));
                if is_zero(&n) {
                    continue;
                }
                let inside = [(p, q), (q, r), (r, p)].iter().all(|(x, y)| !dot(&n, &cross(x, y)).is_negative());
                if inside {
                    let height = dot(&n, p);
                    offer(ratio(&height * &height, dot(&n, &n)));
                }
            }
        }
    }
    (if contact(a, b) == Contact::Disjoint { best } else { BigRational::zero() }, 2 * unit)
}

/// How a distance compares to the root of a squared one: `(distance² - truth) / truth`, or the distance itself if the truth is zero.
pub fn relative_error_sq(distance: f64, truth: &(BigRational, i32)) -> f64 {
    let (sq, unit) = truth;
    if sq.is_zero() {
        return distance;
    }
    let Some(d) = BigRational::from_float(distance) else { return f64::INFINITY };
    let two = BigRational::from_integer(BigInt::from(2));
    let scaled = sq * num_traits::pow::Pow::pow(two, *unit);
    ((&d * &d - &scaled) / scaled).to_f64().unwrap_or(f64::INFINITY)
}

/// The distance of two small hulls, rounded: coordinates must be of ordinary size.
pub fn distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let (sq, unit) = distance_sq(a, b);
    // Room for sixty-four bits before the root.
    let shift = 2 * ((sq.denom().bits() as i64 - sq.numer().bits() as i64 + 140) / 2).max(0);
    let root = ((sq.numer() << shift as usize) / sq.denom()).sqrt();
    let spare = root.bits().saturating_sub(70) as i32;
    let e = unit / 2 - shift as i32 / 2 + spare;
    let m = (root >> spare as usize).to_f64().unwrap_or(f64::INFINITY);
    m * 2f64.powi(e / 2) * 2f64.powi(e - e / 2)
}
