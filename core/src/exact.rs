//! The exact second stage for bodies given by vertices: disjoint, touching or overlapping, with nothing left open.
//!
//! The same search as in [`crate::gjk`], in exact integers (see [`integer`]): every sign is right, each round comes strictly nearer to the
//! origin, so it ends. Where the nearest point is the origin itself, on a face, an edge or a vertex of the simplex, the question is whether
//! the difference has points on both sides of every plane through that face, edge or vertex; this is answered by turning a plane about it.
//!
//! Signs are of degree 4 at most in the coordinates. Integers are used and not floating-point expansions because a product of expansions is
//! no longer exact once a term underflows. Needs some 30 kB of stack.

use core::cmp::Ordering;

use crate::gjk::{Intersection, intersect};
use crate::real::{Real, Vector};
use crate::shape::Vertices;

pub mod integer;
use integer::{DEGREE_1, DEGREE_2, DEGREE_3, DEGREE_4, Int, Vec3, cross, dot, is_zero, minus, negated, resized};

type V1 = Vec3<DEGREE_1>;
type V2 = Vec3<DEGREE_2>;
type V3 = Vec3<DEGREE_3>;

/// How two closed bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// No point is shared.
    Disjoint,
    /// Points are shared, but no interior point of the difference is the origin: a push however small parts them.
    Touching,
    /// Interiors meet.
    Overlapping,
}

/// How two bodies lie, with the proof.
#[derive(Clone, Copy, Debug)]
pub enum Relation {
    /// No point is shared: the axis separates strictly.
    Disjoint(Axis),
    /// Some point is shared: the axis separates all the rest.
    Touching(Axis),
    /// Interiors meet: these points surround the origin.
    Overlapping(Surround),
}

impl Relation {
    /// Without the proof.
    pub fn contact(&self) -> Contact {
        match self {
            Relation::Disjoint(_) => Contact::Disjoint,
            Relation::Touching(_) => Contact::Touching,
            Relation::Overlapping(_) => Contact::Overlapping,
        }
    }
}

/// A vertex is NaN or infinite, or there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// A direction from the first body to the second, exact.
#[derive(Clone, Copy, Debug)]
pub struct Axis(V3);

impl Axis {
    /// The nearest direction in floating point, its largest component between 1 and 2.
    pub fn to_array(&self) -> [f64; 3] {
        direction(&self.0)
    }

    /// How the least of all differences `b - a` along the axis compares to zero. `Greater` proves the bodies disjoint, `Equal` that they do
    /// not overlap. Looks at every vertex, exactly.
    pub fn gap<A, B>(&self, a: &A, b: &B) -> Result<Ordering, NotFinite>
    where
        A: Vertices,
        B: Vertices<Vector = A::Vector>,
    {
        if is_zero(&self.0) {
            return Ok(Ordering::Less);
        }
        let lattice = Lattice::new(a, b)?;
        let mut least: Option<(Int<DEGREE_4>, Int<DEGREE_4>)> = None;
        let along = |p: A::Vector| dot::<DEGREE_3, DEGREE_1, DEGREE_4>(&self.0, &lattice.point(p));
        for i in 0..a.count() {
            let p = along(a.vertex(i));
            least = Some(match least {
                Some((high, low)) if !p.minus(&high).is_positive() => (high, low),
                Some((_, low)) => (p, low),
                None => (p, along(b.vertex(0))),
            });
        }
        for j in 0..b.count() {
            let p = along(b.vertex(j));
            if let Some((high, low)) = least {
                least = Some((high, if p.minus(&low).is_negative() { p } else { low }));
            }
        }
        Ok(least.map_or(Ordering::Less, |(high, low)| low.minus(&high).sign()))
    }
}

/// Up to six pairs of vertices whose differences surround the origin: no plane through it has them all on one closed side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surround {
    pairs: [(u32, u32); 6],
    count: usize,
}

impl Surround {
    fn of(points: &[&Difference]) -> Self {
        let mut pairs = [(0, 0); 6];
        for (to, p) in pairs.iter_mut().zip(points) {
            *to = p.pair;
        }
        Surround { pairs, count: points.len().min(6) }
    }

    /// Indices of a vertex of the first body and one of the second.
    pub fn pairs(&self) -> &[(u32, u32)] {
        self.pairs.get(..self.count).unwrap_or(&[])
    }

    /// Whether the differences do surround the origin: they span space, and no plane through the origin and two of them has all others on
    /// one side.
    pub fn holds<A, B>(&self, a: &A, b: &B) -> Result<bool, NotFinite>
    where
        A: Vertices,
        B: Vertices<Vector = A::Vector>,
    {
        let lattice = Lattice::new(a, b)?;
        let w = self.pairs.map(|pair| lattice.difference(a, b, pair).w);
        let w = w.get(..self.count).unwrap_or(&[]);
        let mut spans = false;
        for (i, p) in w.iter().enumerate() {
            for q in w.iter().skip(i + 1) {
                let normal: V2 = cross(p, q);
                if is_zero(&normal) {
                    continue;
                }
                let (mut below, mut above) = (false, false);
                for r in w {
                    let side: Int<DEGREE_3> = dot(&normal, r);
                    below |= side.is_negative();
                    above |= side.is_positive();
                }
                if !(below && above) {
                    return Ok(false);
                }
                spans = true;
            }
        }
        Ok(spans)
    }
}

/// Disjoint, touching or overlapping: by [`intersect`] where that can tell, else exactly.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{aabb::Aabb, exact::{Contact, settle}, shape::Triangle};
///
/// let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
/// let (a, b, c) = (DVec3::new(1.0, 0.2, 0.2), DVec3::new(1.0, 0.8, 0.2), DVec3::new(1.5, 0.2, 0.9));
/// assert_eq!(settle(&cell, &Triangle { a, b, c }, None), Ok(Contact::Touching));
/// ```
pub fn settle<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Contact, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    match intersect(a, b, hint) {
        Intersection::Apart { .. } => Ok(Contact::Disjoint),
        Intersection::Overlapping { .. } => Ok(Contact::Overlapping),
        Intersection::Undecided { axis, .. } => relation(a, b, Some(axis)).map(|found| found.contact()),
    }
}

/// How two bodies lie, exactly. `hint` is a direction from `a` to `b` to start with.
pub fn relation<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Relation, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    let pair = Pair { a, b, lattice: Lattice::new(a, b)? };
    let search = pair.search(hint, true);
    if !is_zero(&search.direction) {
        return Ok(Relation::Disjoint(Axis(search.direction)));
    }
    let points = search.simplex.points();
    Ok(match search.weak {
        Some(axis) => Relation::Touching(Axis(axis)),
        None => match points {
            [a, b, c, d] => Relation::Overlapping(Surround::of(&[a, b, c, d])),
            [a, b, c] => pair.about_face(a, b, c),
            [a, b] => pair.about_edge(a, b),
            _ => pair.about_vertex(),
        },
    })
}

/// An exact distance, rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The distance, to a relative error of 16 ε or a step of the subnormal numbers; 0 exactly if a point is shared.
    pub distance: f64,
    /// The nearest point of the first body, to rounding.
    pub a: [f64; 3],
    /// The nearest point of the second body, to rounding.
    pub b: [f64; 3],
}

/// The distance of two bodies, from exact signs and exact products: right to the last digits however the vertices lie. A distance beyond
/// the largest number is infinite.
pub fn distance<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Nearest, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    let pair = Pair { a, b, lattice: Lattice::new(a, b)? };
    let search = pair.search(hint, false);
    let points = search.simplex.points();
    let (sq, weights) = match points {
        [p] => (Ratio::new(dot::<_, _, DEGREE_4>(&p.w, &p.w), one()), [one(), Int::ZERO, Int::ZERO]),
        [p, q] => {
            let e = minus(&q.w, &p.w);
            let area: V2 = cross(&p.w, &e);
            let weights = [dot(&q.w, &e), dot::<_, _, DEGREE_4>(&p.w, &e).negated(), Int::ZERO];
            (Ratio::new(dot(&area, &area), dot(&e, &e)), weights)
        }
        [p, q, r] => {
            let n: V2 = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
            let height: Int<DEGREE_3> = dot(&n, &p.w);
            let part = |x: &V1, y: &V1| dot::<_, _, DEGREE_4>(&n, &cross::<_, _, DEGREE_2>(x, y));
            let weights = [part(&q.w, &r.w), part(&r.w, &p.w), part(&p.w, &q.w)];
            (Ratio::square_over(height, dot(&n, &n)), weights)
        }
        _ => (Ratio { m: 0.0, e: 0 }, [one(), Int::ZERO, Int::ZERO]),
    };
    // Only the ratios of the weights count.
    let top = weights.iter().filter(|w| !w.is_zero()).map(|w| w.to_float().1).max().unwrap_or(0);
    let weights = weights.map(|w| {
        let (m, e) = w.to_float();
        times_power(m, e - top)
    });
    let total: f64 = weights.iter().sum();
    // No gap is so small that it may pass for a shared point.
    let least = if is_zero(&search.direction) { 0.0 } else { f64::from_bits(1) };
    let mut nearest = Nearest { distance: Real::max(sq.root(pair.lattice.unit), least), a: [0.0; 3], b: [0.0; 3] };
    for (p, weight) in points.iter().zip(weights) {
        let (i, j) = p.pair;
        let (u, v) = (a.vertex(i as usize).to_array(), b.vertex(j as usize).to_array());
        for k in 0..3 {
            nearest.a[k] += weight / total * u[k].to_f64();
            nearest.b[k] += weight / total * v[k].to_f64();
        }
    }
    Ok(nearest)
}

fn one<const N: usize>() -> Int<N> {
    Int::shifted(false, 1, 0)
}

/// A positive number `m · 2^e`.
struct Ratio {
    m: f64,
    e: i32,
}

impl Ratio {
    fn new(numerator: Int<DEGREE_4>, denominator: Int<DEGREE_4>) -> Self {
        let ((m, e), (n, f)) = (numerator.to_float(), denominator.to_float());
        Ratio { m: m / n, e: e - f }
    }

    fn square_over(root: Int<DEGREE_3>, denominator: Int<DEGREE_4>) -> Self {
        let ((m, e), (n, f)) = (root.to_float(), denominator.to_float());
        Ratio { m: m * m / n, e: 2 * e - f }
    }

    /// Square root, times `2^unit`.
    fn root(&self, unit: i32) -> f64 {
        let odd = self.e & 1;
        let m = if odd == 0 { self.m } else { 2.0 * self.m };
        times_power(Real::sqrt(m), (self.e - odd) / 2 + unit)
    }
}

/// `m · 2^e`, rounded once at most.
fn times_power(m: f64, e: i32) -> f64 {
    let power = |e: i32| f64::from_bits(((e + 1023) as u64) << 52);
    // Two normal factors reach from 2^-2044 to 2^2046; the first leaves a normal number, so only the last one rounds.
    if e > 1000 {
        m * power(1000) * power((e - 1000).min(1000))
    } else if e < -1000 {
        m * power(-1000) * power((e + 1000).max(-1000))
    } else {
        m * power(e)
    }
}

/// Rounded to floating point, the largest component between 1 and 2; each to a relative error of 2⁻⁵², or below 2⁻⁹⁹⁹.
fn direction<const N: usize>(d: &Vec3<N>) -> [f64; 3] {
    let parts = [d[0].to_float(), d[1].to_float(), d[2].to_float()];
    let top = parts.iter().filter(|p| p.0 != 0.0).map(|p| p.1).max().unwrap_or(0);
    parts.map(|(m, e)| if e - top > -1000 { times_power(m, e - top) } else { 0.0 })
}

/// The unit in which all coordinates of a query are integers.
#[derive(Clone, Copy)]
struct Lattice {
    /// Its exponent.
    unit: i32,
    /// Exponent of the largest coordinate.
    top: i32,
}

/// Sign, odd mantissa and exponent; a mantissa of 0 for zero.
fn parts(x: f64) -> (bool, u64, i32) {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    let zeros = if m == 0 { 0 } else { m.trailing_zeros() };
    (x.is_sign_negative(), m >> zeros, e + zeros as i32)
}

impl Lattice {
    fn new<A: Vertices, B: Vertices<Vector = A::Vector>>(a: &A, b: &B) -> Result<Self, NotFinite> {
        let mut lattice = Lattice { unit: i32::MAX, top: i32::MIN };
        if a.count() == 0 || b.count() == 0 {
            return Err(NotFinite);
        }
        let mut include = |p: A::Vector| {
            for x in p.to_array() {
                let x = x.to_f64();
                if !Real::is_finite(x) {
                    return Err(NotFinite);
                }
                let (_, m, e) = parts(x);
                if m != 0 {
                    lattice.unit = lattice.unit.min(e);
                    lattice.top = lattice.top.max(e + 63 - m.leading_zeros() as i32);
                }
            }
            Ok(())
        };
        for i in 0..a.count() {
            include(a.vertex(i))?;
        }
        for j in 0..b.count() {
            include(b.vertex(j))?;
        }
        if lattice.unit > lattice.top {
            lattice = Lattice { unit: 0, top: 0 };
        }
        Ok(lattice)
    }

    fn point<V: Vector>(&self, p: V) -> V1 {
        p.to_array().map(|x| {
            let (negative, m, e) = parts(x.to_f64());
            if m == 0 { Int::ZERO } else { Int::shifted(negative, m, (e - self.unit) as u32) }
        })
    }

    fn difference<A: Vertices, B: Vertices<Vector = A::Vector>>(&self, a: &A, b: &B, pair: (u32, u32)) -> Difference {
        let w = minus(&self.point(b.vertex(pair.1 as usize)), &self.point(a.vertex(pair.0 as usize)));
        Difference { pair, w }
    }
}

/// A point `b - a` of the difference.
#[derive(Clone, Copy)]
struct Difference {
    pair: (u32, u32),
    w: V1,
}

/// Up to four of them.
#[derive(Clone, Copy)]
struct Points {
    items: [Difference; 4],
    count: usize,
}

impl Points {
    fn points(&self) -> &[Difference] {
        self.items.get(..self.count).unwrap_or(&[])
    }

    fn push(&mut self, p: Difference) {
        if let Some(to) = self.items.get_mut(self.count) {
            *to = p;
            self.count += 1;
        }
    }
}

/// Where an exact search ended.
struct Search {
    /// The smallest simplex that holds the nearest point.
    simplex: Points,
    /// Towards it from the origin; zero if it is the origin.
    direction: V3,
    /// An axis along which nothing of the difference lies below the origin, if one came up.
    weak: Option<V3>,
}

struct Pair<'a, A, B> {
    a: &'a A,
    b: &'a B,
    lattice: Lattice,
}

/// Rounding of a scalar product of a rounded direction and a vertex, in units of ε |d|₁ (largest coordinate): three roundings of the product,
/// two of the direction; twice, as two of them are compared; the rest is room.
const FILTER_ROUNDINGS: f64 = 16.0;

impl<A, B> Pair<'_, A, B>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    /// The vertex farthest along a direction; a filter in floating point leaves few to compare exactly.
    fn farthest<S: Vertices>(&self, shape: &S, d: &V3) -> u32 {
        let rounded = direction(d);
        let norm = rounded[0].abs() + rounded[1].abs() + rounded[2].abs();
        // In units of the largest coordinate's power of two.
        let along = |i: usize| {
            let p = shape.vertex(i).to_array();
            let x = |k: usize| times_power(p[k].to_f64(), -self.lattice.top);
            rounded[0] * x(0) + rounded[1] * x(1) + rounded[2] * x(2)
        };
        let close = FILTER_ROUNDINGS * f64::EPSILON * norm * 2.0;
        let mut highest = f64::NEG_INFINITY;
        for i in 0..shape.count() {
            highest = Real::max(highest, along(i));
        }
        let mut best: Option<(u32, Int<DEGREE_4>)> = None;
        let mut single = None;
        for i in 0..shape.count() {
            if along(i) < highest - close {
                continue;
            }
            let i = i as u32;
            if best.is_none() {
                match single {
                    None => {
                        single = Some(i);
                        continue;
                    }
                    Some(first) => best = Some((first, self.along(shape, d, first))),
                }
            }
            let here = self.along(shape, d, i);
            if best.is_some_and(|(_, there)| here.minus(&there).is_positive()) {
                best = Some((i, here));
            }
        }
        best.map(|b| b.0).or(single).unwrap_or(0)
    }

    fn along<S: Vertices>(&self, shape: &S, d: &V3, i: u32) -> Int<DEGREE_4> {
        dot(d, &self.lattice.point(shape.vertex(i as usize)))
    }

    /// The point of the difference that lies lowest along a direction.
    fn lowest(&self, d: &V3) -> Difference {
        let pair = (self.farthest(self.a, d), self.farthest(self.b, &negated(d)));
        self.lattice.difference(self.a, self.b, pair)
    }

    /// Towards the nearest point. With `any` the search ends at the first axis that separates strictly.
    fn search(&self, hint: Option<A::Vector>, any: bool) -> Search {
        let first = match hint {
            Some(hint) if hint.is_finite() => {
                let d = hint.to_array().map(|x| {
                    let (m, e) = (x.to_f64(), 60 - exponent(hint));
                    let (negative, m, e) = parts(if (-2000..2000).contains(&e) { times_power(m, e) } else { 0.0 });
                    // Below the unit it does not matter: a hint need not be exact.
                    if m == 0 || e < 0 { Int::ZERO } else { Int::shifted(negative, m, e as u32) }
                });
                self.lowest(&d)
            }
            _ => self.lattice.difference(self.a, self.b, (0, 0)),
        };
        let mut simplex = Points { items: [first; 4], count: 1 };
        let mut weak = None;
        loop {
            let (kept, direction) = nearest(&simplex);
            simplex = kept;
            if is_zero(&direction) {
                return Search { simplex, direction, weak };
            }
            let new = self.lowest(&direction);
            let along: Int<DEGREE_4> = dot(&direction, &new.w);
            match along.sign() {
                Ordering::Greater if any => return Search { simplex, direction, weak },
                Ordering::Equal => weak = Some(direction),
                _ => {}
            }
            let start = simplex.items[0].w;
            let progress: Int<DEGREE_4> = dot(&direction, &minus(&new.w, &start));
            if !progress.is_negative() {
                return Search { simplex, direction, weak };
            }
            simplex.push(new);
        }
    }

    /// The origin is inside the triangle: are there points on both sides of its plane?
    fn about_face(&self, p: &Difference, q: &Difference, r: &Difference) -> Relation {
        let normal: V2 = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
        match self.both_sides(&resized(&normal)) {
            Ok((low, high)) => Relation::Overlapping(Surround::of(&[p, q, r, &low, &high])),
            Err(axis) => Relation::Touching(axis),
        }
    }

    /// Points strictly on both sides of the plane through the origin across `d`, or the axis that has none below.
    #[expect(clippy::result_large_err, reason = "as large as the other outcome")]
    fn both_sides(&self, d: &V3) -> Result<(Difference, Difference), Axis> {
        let low = self.lowest(d);
        if !dot::<_, _, DEGREE_4>(d, &low.w).is_negative() {
            return Err(Axis(*d));
        }
        let opposite = negated(d);
        let high = self.lowest(&opposite);
        if !dot::<_, _, DEGREE_4>(&opposite, &high.w).is_negative() {
            return Err(Axis(opposite));
        }
        Ok((low, high))
    }

    /// The origin is between two points: seen along that edge, are there points in every half plane?
    fn about_edge(&self, p: &Difference, q: &Difference) -> Relation {
        let e = minus(&q.w, &p.w);
        let (mut first, mut last) = match self.both_sides(&across(&e)) {
            Ok(found) => found,
            Err(axis) => return Relation::Touching(axis),
        };
        // Turns `last` away from `first` until the sector between them is all, a half plane, or cannot grow.
        if turn(&e, &first.w, &last.w) == Ordering::Less {
            (first, last) = (last, first);
        }
        loop {
            let outward: V2 = cross(&e, &last.w);
            if turn(&e, &first.w, &last.w) == Ordering::Equal {
                return match self.both_sides(&resized(&outward)) {
                    Ok((low, high)) => Relation::Overlapping(Surround::of(&[p, q, &first, &last, &low, &high])),
                    Err(axis) => Relation::Touching(axis),
                };
            }
            let inward = negated(&resized(&outward));
            let new = self.lowest(&inward);
            if !dot::<_, _, DEGREE_4>(&inward, &new.w).is_negative() {
                return Relation::Touching(Axis(inward));
            }
            if turn(&e, &first.w, &new.w) == Ordering::Less {
                return Relation::Overlapping(Surround::of(&[p, q, &first, &last, &new]));
            }
            last = new;
        }
    }

    /// The origin is a vertex of the difference. Some other point is taken, and the cone of all points searched for its opposite.
    fn about_vertex(&self) -> Relation {
        let axis = [one(), Int::ZERO, Int::ZERO];
        let anchor = match self.both_sides(&axis) {
            Ok((low, _)) => low,
            Err(axis) => return Relation::Touching(axis),
        };
        let target = negated(&anchor.w);
        let mut cone = Points { items: [anchor; 4], count: 0 };
        loop {
            let (kept, residual) = nearest_in_cone(&target, &cone);
            cone = kept;
            if is_zero(&residual) {
                return match cone.points() {
                    [p] => self.about_edge(&anchor, p),
                    [p, q] => self.about_face(&anchor, p, q),
                    [p, q, r] => Relation::Overlapping(Surround::of(&[&anchor, p, q, r])),
                    _ => Relation::Touching(Axis(axis)),
                };
            }
            let down = negated(&residual);
            let new = self.lowest(&down);
            if !dot::<_, _, DEGREE_4>(&down, &new.w).is_negative() {
                return Relation::Touching(Axis(down));
            }
            cone.push(new);
        }
    }
}

/// Exponent of the largest component of a finite vector.
fn exponent<V: Vector>(v: V) -> i32 {
    let largest = v.norm_max().to_f64();
    let (_, m, e) = parts(largest);
    if m == 0 { 0 } else { e + 63 - m.leading_zeros() as i32 }
}

/// Whether `q` follows `p` by less than a half turn about `e` (`Greater`), by more (`Less`), or neither.
fn turn(e: &V1, p: &V1, q: &V1) -> Ordering {
    dot::<_, _, DEGREE_3>(e, &cross::<_, _, DEGREE_2>(p, q)).sign()
}

/// Some vector across `e`, not zero.
fn across(e: &V1) -> V3 {
    let [x, y, _] = resized(e);
    let zero = Int::ZERO;
    if x.is_zero() { [one(), zero, zero] } else { [y.negated(), x, zero] }
}

/// All subsets of four, small ones first.
const SUBSETS: [&[usize]; 15] = [
    &[0],
    &[1],
    &[2],
    &[3],
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 3],
    &[2, 3],
    &[0, 1, 2],
    &[0, 1, 3],
    &[0, 2, 3],
    &[1, 2, 3],
    &[0, 1, 2, 3],
];

/// The smallest part of a simplex that holds its point nearest to the origin, and the direction of that point: the one part with positive
/// weights whose support plane has all other vertices on the far side.
fn nearest(simplex: &Points) -> (Points, V3) {
    for subset in SUBSETS {
        let Some(part) = chosen(simplex, subset) else { continue };
        let Some(direction) = towards(part.points()) else { continue };
        let start = part.items[0].w;
        let beyond = |p: &Difference| dot::<_, _, DEGREE_4>(&direction, &minus(&p.w, &start)).is_negative();
        if !simplex.points().iter().any(beyond) {
            return (part, direction);
        }
    }
    // Exact arithmetic always finds one.
    debug_assert!(false, "a simplex without a nearest point");
    (*simplex, [Int::ZERO; 3])
}

fn chosen(from: &Points, subset: &[usize]) -> Option<Points> {
    let mut part = Points { items: from.items, count: 0 };
    for &i in subset {
        part.push(*from.points().get(i)?);
    }
    Some(part)
}

/// From the origin to the nearest point of the hull of some points, if that lies strictly inside it.
fn towards(points: &[Difference]) -> Option<V3> {
    match points {
        [p] => Some(resized(&p.w)),
        [p, q] => {
            let e = minus(&q.w, &p.w);
            let before: Int<DEGREE_2> = dot(&p.w, &e);
            let after: Int<DEGREE_2> = dot(&q.w, &e);
            let area: V2 = cross(&p.w, &e);
            (before.is_negative() && after.is_positive()).then(|| cross(&e, &area))
        }
        [p, q, r] => {
            let normal: V2 = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
            let weight = |x: &V1, y: &V1| dot::<_, _, DEGREE_4>(&normal, &cross::<_, _, DEGREE_2>(x, y)).is_positive();
            if !(weight(&p.w, &q.w) && weight(&q.w, &r.w) && weight(&r.w, &p.w)) {
                return None;
            }
            let height: Int<DEGREE_3> = dot(&normal, &p.w);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r, s] => {
            let volume = |x: &V1, y: &V1, z: &V1| turn(x, y, z);
            let signs = [
                volume(&q.w, &r.w, &s.w),
                volume(&p.w, &r.w, &s.w).reverse(),
                volume(&p.w, &q.w, &s.w),
                volume(&p.w, &q.w, &r.w).reverse(),
            ];
            let inside = signs[0] != Ordering::Equal && signs.iter().all(|&s| s == signs[0]);
            inside.then_some([Int::ZERO; 3])
        }
        _ => None,
    }
}

/// The part of a cone nearest to `target`, and what remains from there to the target.
fn nearest_in_cone(target: &V1, cone: &Points) -> (Points, V3) {
    let none = Points { items: cone.items, count: 0 };
    let fits = |residual: &V3| !cone.points().iter().any(|p| dot::<_, _, DEGREE_4>(residual, &p.w).is_positive());
    let whole = resized(target);
    if fits(&whole) {
        return (none, whole);
    }
    for subset in SUBSETS {
        let Some(part) = chosen(cone, subset) else { continue };
        let Some(residual) = beside(target, part.points()) else { continue };
        if fits(&residual) {
            return (part, residual);
        }
    }
    debug_assert!(false, "a cone without a nearest point");
    (none, [Int::ZERO; 3])
}

/// What remains of `target` across the cone of some points, if its foot lies strictly inside that cone.
fn beside(target: &V1, points: &[Difference]) -> Option<V3> {
    match points {
        [p] => {
            let along: Int<DEGREE_2> = dot(target, &p.w);
            along.is_positive().then(|| cross(&p.w, &cross::<_, _, DEGREE_2>(target, &p.w)))
        }
        [p, q] => {
            let normal: V2 = cross(&p.w, &q.w);
            let weight = |x: &V1, y: &V1| dot::<_, _, DEGREE_4>(&normal, &cross::<_, _, DEGREE_2>(x, y)).is_positive();
            if !(weight(target, &q.w) && weight(&p.w, target)) {
                return None;
            }
            let height: Int<DEGREE_3> = dot(&normal, target);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r] => {
            let volume = turn(&p.w, &q.w, &r.w);
            let signs = [turn(target, &q.w, &r.w), turn(&p.w, target, &r.w), turn(&p.w, &q.w, target)];
            (volume != Ordering::Equal && signs.iter().all(|&s| s == volume)).then_some([Int::ZERO; 3])
        }
        _ => None,
    }
}
