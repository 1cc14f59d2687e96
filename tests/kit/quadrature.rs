//! Shares of cells and faces of solids by formula, by nested adaptive quadrature of chords: slow, and sharing nothing with closed forms.

use glam::DVec3;
use std::cell::Cell;

thread_local! {
    /// How many chords may still be computed.
    static CHORDS: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// What a quadrature finds with at most so many chords; none if it needs more: where rounding makes chords rough, halving does not converge.
pub fn with_chords<T>(most: u64, work: impl FnOnce() -> T) -> Option<T> {
    CHORDS.set(most);
    let found = work();
    let left = CHORDS.replace(u64::MAX);
    (left > 0).then_some(found)
}

/// A solid, by what a line has inside it.
#[derive(Debug, Clone, Copy)]
pub enum Exact {
    /// Centre, radius.
    Ball(DVec3, f64),
    /// Centre, half axes (orthogonal).
    Ellipsoid(DVec3, [DVec3; 3]),
    /// Centres of the ends, radius.
    Cylinder(DVec3, DVec3, f64),
    /// Ends of the axis, radius.
    Capsule(DVec3, DVec3, f64),
    /// Centre of the base, apex, radius of the base.
    Cone(DVec3, DVec3, f64),
    /// Centres of the ends, radii of the ends.
    Frustum(DVec3, DVec3, [f64; 2]),
}

/// Where `a t² + 2 b t + c <= 0`, for `a > 0`.
fn roots(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let square = b * b - a * c;
    (square > 0.0).then(|| {
        let q = -(b + square.sqrt().copysign(b));
        let (s, t) = (q / a, if q == 0.0 { 0.0 } else { c / q });
        [s.min(t), s.max(t)]
    })
}

fn meet(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    (both[0] < both[1]).then_some(both)
}

impl Exact {
    /// What the line through `p` along axis `m` has inside, as coordinates along it.
    #[must_use]
    pub fn chord(&self, p: DVec3, m: usize) -> Option<[f64; 2]> {
        let e = DVec3::AXES[m];
        let own = p[m];
        let found = match *self {
            Exact::Ball(center, radius) => ball(p, e, center, radius),
            Exact::Ellipsoid(center, axes) => {
                let unit = |v: DVec3| DVec3::from_array(axes.map(|a| a.dot(v) / a.length_squared()));
                let (q, d) = (unit(p - center), unit(e));
                roots(d.dot(d), q.dot(d), q.dot(q) - 1.0)
            }
            Exact::Cylinder(from, to, radius) => tube(p, e, from, to, radius),
            Exact::Capsule(from, to, radius) => {
                let parts = [tube(p, e, from, to, radius), ball(p, e, from, radius), ball(p, e, to, radius)];
                parts.into_iter().flatten().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
            }
            Exact::Cone(base, apex, radius) => cone(p, e, base, apex, radius),
            Exact::Frustum(from, to, radii) => frustum(p, e, from, to, radii),
        };
        found.map(|t| t.map(|t| own + t))
    }

    /// A convex function, negative inside.
    fn depth(&self, p: DVec3) -> f64 {
        let along = |from: DVec3, to: DVec3, radius: f64| {
            let (axis, [q, lost]) = (to - from, apart(p, from));
            let unit = direction(axis);
            (q.dot(unit), beyond([unit.cross(q), unit.cross(lost)], radius), axis.length())
        };
        match *self {
            Exact::Ball(center, radius) => beyond(apart(p, center), radius),
            Exact::Ellipsoid(center, axes) => {
                let unit = axes.map(|a| a.dot(p - center) / a.length_squared());
                (DVec3::from_array(unit).length() - 1.0) * axes[0].length()
            }
            Exact::Cylinder(from, to, radius) => {
                let (at, off, length) = along(from, to, radius);
                off.max(-at).max(at - length)
            }
            Exact::Capsule(from, to, radius) => {
                let axis = to - from;
                let nearest = from + axis * ((p - from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                beyond(apart(p, nearest), radius)
            }
            Exact::Cone(base, apex, radius) => {
                let (at, off, length) = along(apex, base, 0.0);
                (off - at * radius / length).max(at - length)
            }
            Exact::Frustum(from, to, [one, other]) => {
                let (at, _, length) = along(from, to, 0.0);
                let (unit, [q, lost]) = (direction(to - from), apart(p, from));
                let [radius, rest] = grown(one, (other - one) * (at / length));
                // Beyond the apex it grows on, or a search that comes from there would not find the way.
                let off = beyond([unit.cross(q), unit.cross(lost)], radius.max(0.0)) - radius.min(0.0) - rest;
                off.max(-at).max(at - length)
            }
        }
    }

    /// The factor by which tolerances are wider for large solids, whose chords are rough by rounding, so that halving further finds nothing.
    fn roughness(&self) -> f64 {
        let size = match *self {
            Exact::Ball(_, r) => r,
            Exact::Ellipsoid(_, axes) => axes.map(DVec3::length).into_iter().fold(0.0, f64::max),
            Exact::Cylinder(a, b, r) | Exact::Capsule(a, b, r) | Exact::Cone(a, b, r) => r.max(a.distance(b)),
            Exact::Frustum(a, b, [r, s]) => r.max(s).max(a.distance(b)),
        };
        (0.05 * size).max(1.0)
    }

    /// Area that the solid has of a rectangle across axis `n` at a coordinate.
    #[must_use]
    pub fn area(&self, n: usize, at: f64, u: [f64; 2], v: [f64; 2]) -> f64 {
        common_area(std::slice::from_ref(self), n, at, [u, v], 4e-16 * self.roughness())
    }

    /// Volume in a box. Integrated in two orders of the axes; where they disagree the middle of three.
    #[must_use]
    pub fn volume(&self, lo: DVec3, hi: DVec3) -> f64 {
        let whole = (hi - lo).element_product();
        let [one, other] = [2, 0].map(|axis| self.volume_along(axis, lo, hi));
        if (one - other).abs() <= 4e-14 * whole {
            return (one + other) * 0.5;
        }
        let mut three = [one, other, self.volume_along(1, lo, hi)];
        three.sort_by(f64::total_cmp);
        three[1]
    }

    /// The same, the outer integral along an axis.
    fn volume_along(&self, n: usize, lo: DVec3, hi: DVec3) -> f64 {
        let rough = self.roughness();
        common_volume_along(std::slice::from_ref(self), n, [lo, hi], [4e-16 * rough, 1e-14 * rough])
    }
}

/// Area that solids have in common of a rectangle across axis `n` at a coordinate; `tolerance` is a share of the rectangle.
#[must_use]
pub fn common_area(solids: &[Exact], n: usize, at: f64, window: [[f64; 2]; 2], tolerance: f64) -> f64 {
    area_by_chords(Exact::chord, solids, (n, (n + 1) % 3), at, window, tolerance)
}

/// The same, with chords from elsewhere and along either axis `m` of the rectangle; the window's first axis is the one after `n`.
#[must_use]
pub fn area_by_chords(
    chord_of: impl Fn(&Exact, DVec3, usize) -> Option<[f64; 2]>,
    solids: &[Exact],
    (n, m): (usize, usize),
    at: f64,
    [u, v]: [[f64; 2]; 2],
    tolerance: f64,
) -> f64 {
    let [u, v] = if m == (n + 1) % 3 { [u, v] } else { [v, u] };
    let (iu, iv) = (m, 3 - n - m);
    let place = |x: f64, y: f64| {
        let mut p = DVec3::ZERO;
        (p[n], p[iu], p[iv]) = (at, x, y);
        p
    };
    let chord = |y: f64| {
        CHORDS.set(CHORDS.get().saturating_sub(1));
        let common = solids.iter().try_fold(u, |common, s| meet(common, chord_of(s, place(u[0], y), iu)?));
        common.map_or(0.0, |c| c[1] - c[0])
    };
    let depth = |y: f64| least(&|x| depth(solids, place(x, y)), u);
    integral(&chord, &depth, v, tolerance * (u[1] - u[0]) * (v[1] - v[0]), 18)
}

/// Volume that solids have in common in a box; `tolerance` is a share of the box.
#[must_use]
pub fn common_volume(solids: &[Exact], [lo, hi]: [DVec3; 2], tolerance: f64) -> f64 {
    common_volume_along(solids, 0, [lo, hi], [0.1 * tolerance, tolerance])
}

/// The same, the outer integral along an axis; tolerances of the areas and of the volume.
fn common_volume_along(solids: &[Exact], n: usize, [lo, hi]: [DVec3; 2], tolerances: [f64; 2]) -> f64 {
    let (iu, iv) = ((n + 1) % 3, (n + 2) % 3);
    let (u, v) = ([lo[iu], hi[iu]], [lo[iv], hi[iv]]);
    let depth = |at: f64| {
        let place = |x: f64, y: f64| {
            let mut p = DVec3::ZERO;
            (p[n], p[iu], p[iv]) = (at, x, y);
            p
        };
        least(&|y| least(&|x| depth(solids, place(x, y)), u), v)
    };
    integral(
        &|at| common_area(solids, n, at, [u, v], tolerances[0]),
        &depth,
        [lo[n], hi[n]],
        tolerances[1] * (hi - lo).element_product(),
        10,
    )
}

/// A convex function, negative inside all solids.
fn depth(solids: &[Exact], p: DVec3) -> f64 {
    solids.iter().map(|s| s.depth(p)).fold(f64::NEG_INFINITY, f64::max)
}

/// The least value of a convex function on an interval, by the golden section; of negative ones any.
fn least(f: &dyn Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut s, mut t) = (b - (b - a) * GOLDEN, a + (b - a) * GOLDEN);
    let (mut fs, mut ft) = (f(s), f(t));
    let mut least = f(a).min(f(b)).min(fs).min(ft);
    for _ in 0..60 {
        if least < 0.0 {
            break;
        }
        if fs < ft {
            (b, t, ft) = (t, s, fs);
            s = b - (b - a) * GOLDEN;
            fs = f(s);
            least = least.min(fs);
        } else {
            (a, s, fs) = (s, t, ft);
            t = a + (b - a) * GOLDEN;
            ft = f(t);
            least = least.min(ft);
        }
    }
    least
}

/// A point from another, and what the subtraction lost.
fn apart(p: DVec3, from: DVec3) -> [DVec3; 2] {
    let q = p - from;
    let part = q - p;
    [q, (p - (q - part)) - (from + part)]
}

/// By how much a vector, of which `lost` was rounded away, is longer than `r`: from the exact squares, so that a surface that a plane touches but
/// for rounding keeps its digits.
fn beyond([v, lost]: [DVec3; 2], r: f64) -> f64 {
    let mut parts = [(v.x, v.x), (v.y, v.y), (v.z, v.z), (-r, r)].map(|(a, b)| (a * b, a.mul_add(b, -(a * b))));
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let (mut sum, mut rest) = (0.0_f64, 2.0 * v.dot(lost));
    for (square, error) in parts {
        let next = sum + square;
        let part = next - sum;
        rest += ((sum - (next - part)) + (square - part)) + error;
        sum = next;
    }
    if r == 0.0 { v.length() } else { (sum + rest) / (v.length() + r) }
}

/// Where `|b + t a| <= r`: by the distance of the line from the origin, so that lines which nearly touch keep their digits. `lost` is what `b`
/// lacks by rounding.
fn within(a: DVec3, [b, lost]: [DVec3; 2], r: f64) -> Option<[f64; 2]> {
    let (square, normal) = (a.dot(a), a.cross(b));
    let length = square.sqrt();
    let distance = normal.length() / length;
    let rest = if distance > 0.0 { normal.dot(a.cross(lost)) / (normal.length() * length) } else { 0.0 };
    let left = ((r - distance) - rest) * ((r + distance) + rest);
    (left > 0.0).then(|| [-1.0, 1.0].map(|sign| -b.dot(a) / square + sign * left.sqrt() / length))
}

fn ball(p: DVec3, e: DVec3, center: DVec3, radius: f64) -> Option<[f64; 2]> {
    within(e, apart(p, center), radius)
}

/// Between two planes across `axis`, at its ends.
fn between(q: DVec3, e: DVec3, axis: DVec3) -> Option<[f64; 2]> {
    let (at, step, end) = (q.dot(axis), e.dot(axis), axis.dot(axis));
    if step == 0.0 {
        return (at >= 0.0 && at <= end).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let (s, t) = (-at / step, (end - at) / step);
    Some([s.min(t), s.max(t)])
}

/// The unit vector along an axis; divided, as times the reciprocal of its length even one along a coordinate axis is off by its last bit.
fn direction(axis: DVec3) -> DVec3 {
    axis / axis.length()
}

fn tube(p: DVec3, e: DVec3, from: DVec3, to: DVec3, radius: f64) -> Option<[f64; 2]> {
    let (axis, [q, lost]) = (to - from, apart(p, from));
    let slab = between(q, e, axis)?;
    let unit = direction(axis);
    let (a, b) = (unit.cross(e), unit.cross(q));
    if a == DVec3::ZERO {
        return (beyond([b, unit.cross(lost)], radius) <= 0.0).then_some(slab);
    }
    meet(within(a, [b, unit.cross(lost)], radius)?, slab)
}

fn cone(p: DVec3, e: DVec3, base: DVec3, apex: DVec3, radius: f64) -> Option<[f64; 2]> {
    let (axis, q) = (base - apex, p - apex);
    let slab = between(q, e, axis)?;
    let (unit, slope) = (direction(axis), radius / axis.length());
    let (a, b) = (unit.cross(e), unit.cross(q));
    let (s, t) = (unit.dot(e) * slope, unit.dot(q) * slope);
    let (a2, a1, a0) = (a.dot(a) - s * s, a.dot(b) - s * t, b.dot(b) - t * t);
    // Inside is where the quadratic is negative, between the base and the apex.
    let [lo, hi] = slab;
    let inside = |x: f64| (a2 * x + 2.0 * a1) * x + a0 <= 0.0;
    let mut cuts = vec![lo, hi];
    if a2 > 0.0 {
        cuts.extend(roots(a2, a1, a0)?);
    } else if a2 < 0.0 {
        cuts.extend(roots(-a2, -a1, -a0).into_iter().flatten());
    } else if a1 != 0.0 {
        cuts.push(-a0 / (2.0 * a1));
    }
    cuts.retain(|x| *x >= lo && *x <= hi);
    cuts.sort_by(f64::total_cmp);
    let runs = cuts.windows(2).filter(|w| w[0] < w[1] && inside((w[0] + w[1]) * 0.5));
    runs.map(|w| [w[0], w[1]]).reduce(|x, y| [x[0].min(y[0]), x[1].max(y[1])])
}

/// Where |b + t a| <= r + t s, b and r as they are left by roundings `lost` and `rest`: the discriminant is |a r − b s|² − |a × b|².
fn within_growing(a: DVec3, [b, lost]: [DVec3; 2], [r, rest]: [f64; 2], s: f64, slab: [f64; 2]) -> Option<[f64; 2]> {
    let (reach, area) = (a * r - b * s, a.cross(b));
    let (long, wide) = (reach.length(), area.length());
    let slip = |v: DVec3, by: DVec3, length: f64| if length > 0.0 { v.dot(by) / length } else { 0.0 };
    let less = (long - wide) + slip(reach, a * rest - lost * s, long) - slip(area, a.cross(lost), wide);
    let square = less * (long + wide);
    let (a2, a1) = (a.dot(a) - s * s, a.dot(b) - s * r);
    let a0 = (b.length() - r) * (b.length() + r);
    let mut cuts = slab.to_vec();
    if square > 0.0 && a2 != 0.0 {
        let sum = -(a1 + square.sqrt().copysign(a1));
        cuts.extend([sum / a2, if a2 > 0.5 * a.dot(a) { (-a1 - a1 - sum) / a2 } else { a0 / sum }]);
    } else if a2 == 0.0 && a1 != 0.0 {
        cuts.push(-a0 / (2.0 * a1));
    } else if a2 > 0.0 {
        return None;
    }
    let inside = |x: f64| r + x * s >= 0.0 && (b + a * x).length() <= (r + x * s) * (1.0 + 1e-13);
    cuts.retain(|x| *x >= slab[0] && *x <= slab[1]);
    cuts.sort_by(f64::total_cmp);
    let runs = cuts.windows(2).filter(|w| w[0] < w[1] && inside((w[0] + w[1]) * 0.5));
    runs.map(|w| [w[0], w[1]]).reduce(|x, y| [x[0].min(y[0]), x[1].max(y[1])])
}

/// A sum, and what rounding took from it: a radius that changes by less than its last digit still touches a plane or does not.
fn grown(radius: f64, by: f64) -> [f64; 2] {
    let sum = radius + by;
    let part = sum - radius;
    [sum, (radius - (sum - part)) + (by - part)]
}

fn frustum(p: DVec3, e: DVec3, from: DVec3, to: DVec3, [one, other]: [f64; 2]) -> Option<[f64; 2]> {
    let (axis, [q, lost]) = (to - from, apart(p, from));
    let slab = between(q, e, axis)?;
    let (unit, slope) = (direction(axis), (other - one) / axis.length());
    let radius = grown(one, unit.dot(q) * slope);
    within_growing(unit.cross(e), [unit.cross(q), unit.cross(lost)], radius, unit.dot(e) * slope, slab)
}

/// Inner nodes and weights of Gauss and Lobatto, ten points; the ends have the weight 1/45. A kink between an end and the next node shows at
/// the end.
const NODES: [(f64, f64); 4] = [
    (0.165_278_957_666_387_03, 0.327_539_761_183_897_44),
    (0.477_924_949_810_444_5, 0.292_042_683_679_683_8),
    (0.738_773_865_105_505, 0.224_889_342_063_126_44),
    (0.919_533_908_166_458_9, 0.133_305_990_851_070_12),
];

fn gauss(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (middle, half) = ((a + b) * 0.5, (b - a) * 0.5);
    let inner: f64 = NODES.iter().map(|(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum();
    (inner + (f(a) + f(b)) / 45.0) * half
}

/// The integral of a function that is 0 but for an interval, where it is smooth but for kinks and roots; `depth` is convex and negative in
/// that interval.
fn integral(f: &dyn Fn(f64) -> f64, depth: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], tolerance: f64, ends: u32) -> f64 {
    let Some([lo, hi]) = support(depth, a, b) else { return 0.0 };
    // Roots at the ends become smooth: x = lo + (hi − lo) (1 − cos πt) / 2.
    let smooth = |t: f64| {
        let (sin, cos) = (std::f64::consts::PI * t).sin_cos();
        let x = if t < 0.5 {
            lo + (hi - lo) * sin * sin / (2.0 * (1.0 + cos))
        } else {
            hi - (hi - lo) * sin * sin / (2.0 * (1.0 - cos))
        };
        f(x) * sin * std::f64::consts::FRAC_PI_2 * (hi - lo)
    };
    refined(&smooth, [0.0, 1.0], gauss(&smooth, 0.0, 1.0), tolerance, ends, 0)
}

/// Halves until both halves agree with the whole. A kink may lie so near an end that no node sees it: there it is halved further.
fn refined(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], whole: f64, tolerance: f64, ends: u32, depth: u32) -> f64 {
    let middle = (a + b) * 0.5;
    let (left, right) = (gauss(f, a, middle), gauss(f, middle, b));
    let least = if a == 0.0 || b == 1.0 { ends } else { 2 };
    if depth > 30 || CHORDS.get() == 0 || (depth >= least && (left + right - whole).abs() <= tolerance) {
        return left + right;
    }
    refined(f, [a, middle], left, tolerance, ends, depth + 1)
        + refined(f, [middle, b], right, tolerance, ends, depth + 1)
}

/// Where a convex function is negative.
fn support(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> Option<[f64; 2]> {
    let inside = std::cell::Cell::new(None);
    let watched = |x: f64| {
        let value = f(x);
        if value < 0.0 {
            inside.set(Some(x));
        }
        value
    };
    least(&watched, [a, b]);
    let inside = inside.get()?;
    let edge = |outside: f64| {
        if f(outside) < 0.0 {
            return outside;
        }
        let (mut out, mut own) = (outside, inside);
        for _ in 0..60 {
            let middle = (out + own) * 0.5;
            if f(middle) < 0.0 { own = middle } else { out = middle }
        }
        own
    };
    Some([edge(a), edge(b)])
}
