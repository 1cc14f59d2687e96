//! Two bodies of a query, and the power of two that brings them to a size one can compute with.
//!
//! Points stay as the bodies give them, so that a proof names points of the bodies to the last bit; only their differences are scaled.

use super::outcome::Reason;
use crate::convex::opaque::Opaque;
use crate::convex::support::{Support, SupportPoint, lengthened};
use crate::number::real::{Real, Vector};

/// A direction of a size that one can compute with, and its 1-norm; or, if it has none (zero, NaN or infinite), the direction alone.
#[inline(always)]
pub(super) fn sized<V: Vector>(axis: V) -> Result<(V, V::Scalar), V> {
    let size = axis.norm_1();
    if size > V::Scalar::SCALE_MIN {
        return Ok((axis, size));
    }
    let axis = lengthened(axis);
    let size = axis.norm_1();
    if size >= V::Scalar::ONE && size.is_finite() { Ok((axis, size)) } else { Err(axis) }
}

/// The support points of two bodies across a direction: of the first farthest along it, of the second farthest against it.
pub(super) struct Probe<V> {
    pub a: SupportPoint<V>,
    pub b: SupportPoint<V>,
    /// From the first to the second, scaled: the point of the difference that lies lowest along the direction.
    pub w: V,
}

impl<V> Probe<V> {
    /// Where the next search for support points may start.
    #[inline(always)]
    pub fn starts(&self) -> (u32, u32) {
        (self.a.index, self.b.index)
    }
}

/// The power of two to multiply two bodies with, so that their extents add to something near one.
pub(super) enum Scale<R> {
    Keep,
    Multiply(R),
    Refuse(Reason),
}

pub(super) fn scale<R: Real>(extent: R) -> Scale<R> {
    if extent >= R::SCALE_MIN && extent <= R::SCALE_MAX {
        return Scale::Keep;
    }
    if !extent.is_finite() {
        return Scale::Refuse(Reason::NotFinite);
    }
    let unit = extent.binade();
    // 1/unit must be finite, and ε times the extent, as slacks are made of, a thousand times the subnormal step.
    if !(unit >= R::MIN_POSITIVE * R::from_f64(1024.0)) {
        return Scale::Refuse(Reason::TooSmall);
    }
    Scale::Multiply(R::ONE / unit)
}

/// Rounding of `d·(b - a)` against the true least value over both bodies, in units of ε |d|₁ (extents): two scalar products of the scan on
/// each side (3), the difference and its product (2); rounded up for second-order terms and the bound's own rounding.
const SUPPORT_ROUNDINGS: f64 = 8.0;

/// Two bodies. Lengths and differences come in units of `1 / factor`, which is 1 unless `SCALED`.
pub(super) struct BodyPair<'a, A, B, R, const SCALED: bool> {
    a: &'a A,
    b: &'a B,
    factor: R,
    /// No component of a difference exceeds this.
    pub extent: R,
    /// How far a difference may be off in each component, besides one rounding.
    pub slack: R,
}

impl<'a, A, B, V, const SCALED: bool> BodyPair<'a, A, B, V::Scalar, SCALED>
where
    V: Vector,
    A: Support<Vector = V>,
    B: Support<Vector = V>,
{
    #[inline(always)]
    pub fn new(a: &'a A, b: &'a B, extent: V::Scalar, factor: V::Scalar) -> Self {
        let factor = if SCALED { factor } else { V::Scalar::ONE };
        let slack = a.slack() + b.slack();
        if SCALED {
            BodyPair { a, b, factor, extent: extent * factor, slack: slack * factor }
        } else {
            BodyPair { a, b, factor, extent, slack }
        }
    }

    /// Rounding of a least value `d·(b - a)`, for each unit of |d|₁.
    #[inline(always)]
    pub fn margin(&self) -> V::Scalar {
        V::Scalar::from_f64(SUPPORT_ROUNDINGS) * V::Scalar::EPSILON * self.extent + self.slack + V::Scalar::UNDERFLOW
    }

    /// Sum of the radii.
    #[inline(always)]
    pub fn radii(&self) -> V::Scalar {
        self.scaled(self.a.radius() + self.b.radius())
    }

    #[inline(always)]
    fn scaled(&self, length: V::Scalar) -> V::Scalar {
        if SCALED { length * self.factor } else { length }
    }

    /// A scaled length in the unit of the bodies.
    #[inline(always)]
    pub fn unscaled(&self, length: V::Scalar) -> V::Scalar {
        if SCALED { length * (V::Scalar::ONE / self.factor) } else { length }
    }

    /// From a point of the first body to one of the second. By components: a vector of `f32` chosen as a whole would be kept as integers.
    #[inline(always)]
    pub fn difference(&self, a: V, b: V) -> V {
        let part = |a, b| self.scaled(b) - self.scaled(a);
        V::new(part(a.x(), b.x()), part(a.y(), b.y()), part(a.z(), b.z()))
    }

    /// `direction` times a power of two of about `factor`, clamped to the scalar's range: then `d·p` is of order one for points of size `1 / factor`,
    /// and neither overflows nor underflows. The direction itself unless `SCALED`.
    #[inline(always)]
    fn fitted(&self, direction: V) -> V {
        let one = V::Scalar::ONE;
        let (to_one, stretch) = if SCALED {
            let longest = V::Scalar::EPSILON / V::Scalar::MIN_POSITIVE;
            (one / direction.norm_max().binade(), self.factor.min(longest).max(one / longest))
        } else {
            (one, one)
        };
        direction * to_one * stretch
    }

    /// The support points across `axis`. They may be farthest only among their neighbours: see [`BodyPair::probe_surely`].
    #[inline(always)]
    pub fn probe(&self, axis: V, starts: (u32, u32)) -> Probe<V> {
        let along = self.fitted(axis);
        let (a, b) = (self.a.support(along, starts.0), self.b.support(-along, starts.1));
        Probe { a, b, w: self.difference(a.point, b.point) }
    }

    /// The same points made sure of, for a proof.
    #[inline(always)]
    pub fn probe_surely(&self, axis: V, Probe { a, b, .. }: Probe<V>) -> Probe<V> {
        let along = self.fitted(axis);
        let a = self.a.farther(along, a.index).unwrap_or(a);
        let b = self.b.farther(-along, b.index).unwrap_or(b);
        Probe { a, b, w: self.difference(a.point, b.point) }
    }

    /// The first direction of a search, from `a` to `b`: the hint, or along the centres; never zero, always finite.
    #[inline(always)]
    pub fn seed(&self, hint: Option<V>) -> V {
        let direction = match hint {
            Some(hint) => hint,
            None => self.difference(self.a.center(), self.b.center()),
        };
        let size = direction.norm_1();
        let usual = size > V::Scalar::SCALE_MIN && size < V::Scalar::SCALE_MAX;
        if usual { direction } else { unusual_seed(direction) }
    }

    /// The same of the two bodies behind pointers.
    pub fn opaque<'o>(
        &self,
        [a, b]: [&'o Opaque<'o, V>; 2],
    ) -> BodyPair<'o, Opaque<'o, V>, Opaque<'o, V>, V::Scalar, SCALED> {
        BodyPair { a, b, factor: self.factor, extent: self.extent, slack: self.slack }
    }

    /// The two bodies.
    pub fn bodies(&self) -> (&'a A, &'a B) {
        (self.a, self.b)
    }

    /// A lower bound of the distance, by the support planes across `axis`.
    pub fn gap(&self, axis: V) -> Option<V::Scalar> {
        let axis = lengthened(axis);
        let size = axis.norm_1();
        if !(size >= V::Scalar::ONE) || !size.is_finite() {
            return None;
        }
        let found = self.probe_surely(axis, self.probe(axis, (0, 0)));
        let along = found.w.dot(axis) - self.margin() * size;
        let relative = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
        let less = along - along.abs() * relative;
        Some(less / axis.dot(axis).sqrt() - self.radii() * (V::Scalar::ONE + relative))
    }
}

#[cold]
fn unusual_seed<V: Vector>(direction: V) -> V {
    let direction = lengthened(direction);
    let fine = direction.is_finite() && direction.norm_1() > V::Scalar::SCALE_MIN;
    if fine { direction } else { V::new(V::Scalar::ONE, V::Scalar::ZERO, V::Scalar::ZERO) }
}
