//! Support mappings: the point of a convex body farthest along a direction.
//!
//! A body enters [`crate::convex::gjk`] only through [`Support`]. Besides the point it states how far rounding may have moved that point, so that
//! an answer can be proved. Adaptors compose bodies from bodies.
//!
//! Reference: G. van den Bergen, *Collision Detection in Interactive 3D Environments*, 2003, section 3.2.

use crate::number::real::{Real, Vector};

/// Scalar of a body.
pub type ScalarOf<S> = <<S as Support>::Vector as Vector>::Scalar;

/// A support point, and where a search for the next one should start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportPoint<V> {
    /// The point.
    pub point: V,
    /// Index of the vertex, for bodies that have any.
    pub index: u32,
}

/// The point of a body that has no numbered vertices.
#[inline(always)]
pub(crate) fn only<V>(point: V) -> SupportPoint<V> {
    SupportPoint { point, index: 0 }
}

/// A convex body: a core, given by its support mapping, thickened by a radius.
///
/// For any finite direction `d` that is not zero, with `p` the point of the core that [`Support::farthest`] returns:
/// - some point of the core lies within `slack` of `p` in every component;
/// - no point of the core lies farther along `d` than `d·p + |d|₁ (4 ε extent + slack)`.
pub trait Support {
    /// The vectors of the space.
    type Vector: Vector;
    /// Whether [`Support::radius`] may be other than zero.
    const ROUNDED: bool = false;

    /// A point of the core farthest along `direction`, of any length but zero. `start` is the index of an earlier answer, or 0; it may
    /// shorten the search. A search that climbs from vertex to vertex may stop at one that is only above its neighbours:
    /// [`Support::farther`] checks.
    fn support(&self, direction: Self::Vector, start: u32) -> SupportPoint<Self::Vector>;

    /// Checks an answer of [`Support::support`], by its index `found`, against the whole body: a point farther along `direction`, or none.
    /// Called before a proof is built on the answer.
    fn farther(&self, direction: Self::Vector, found: u32) -> Option<SupportPoint<Self::Vector>> {
        let _ = (direction, found);
        None
    }

    /// The point of the core farthest along `direction`.
    fn farthest(&self, direction: Self::Vector) -> SupportPoint<Self::Vector> {
        let found = self.support(direction, 0);
        self.farther(direction, found.index).unwrap_or(found)
    }

    /// Some point well inside, to start from.
    fn center(&self) -> Self::Vector;

    /// No coordinate of the body exceeds this in absolute value. NaN or infinite if anything in the body is.
    fn extent(&self) -> ScalarOf<Self>;

    /// Radius of the balls around the core's points which, together, are the body.
    fn radius(&self) -> ScalarOf<Self> {
        Real::ZERO
    }

    /// How far rounding may have moved a support point, in each component. Zero for bodies given by their vertices.
    fn slack(&self) -> ScalarOf<Self> {
        Real::ZERO
    }
}

/// The methods of [`Support`] for a body that wraps another one: `delegate_support!(self, V => self.inner)` inside its `impl`.
/// [`Support::ROUNDED`] is not forwarded.
macro_rules! delegate_support {
    ($self:ident, $vector:ty => $inner:expr) => {
        type Vector = $vector;
        #[inline(always)]
        fn support(&$self, direction: $vector, start: u32) -> $crate::convex::support::SupportPoint<$vector> {
            $inner.support(direction, start)
        }
        #[inline(always)]
        fn farther(&$self, direction: $vector, found: u32) -> Option<$crate::convex::support::SupportPoint<$vector>> {
            $inner.farther(direction, found)
        }
        #[inline(always)]
        fn center(&$self) -> $vector {
            $inner.center()
        }
        #[inline(always)]
        fn extent(&$self) -> <$vector as $crate::number::real::Vector>::Scalar {
            $inner.extent()
        }
        #[inline(always)]
        fn radius(&$self) -> <$vector as $crate::number::real::Vector>::Scalar {
            $inner.radius()
        }
        #[inline(always)]
        fn slack(&$self) -> <$vector as $crate::number::real::Vector>::Scalar {
            $inner.slack()
        }
    };
}
pub(crate) use delegate_support;

impl<S: Support> Support for &S {
    const ROUNDED: bool = S::ROUNDED;
    delegate_support!(self, S::Vector => (**self));
}

/// Largest absolute component; NaN if any component is NaN or infinite.
#[inline(always)]
pub(crate) fn magnitude<V: Vector>(v: V) -> V::Scalar {
    v.norm_max() + v.norm_1() * V::Scalar::ZERO
}

/// A body thickened by a radius: all points within `radius` of it. The radius is finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<S: Support> {
    /// What is thickened.
    pub core: S,
    /// By how much.
    pub radius: ScalarOf<S>,
}

impl<S: Support> Support for Rounded<S> {
    type Vector = S::Vector;
    const ROUNDED: bool = true;
    #[inline(always)]
    fn support(&self, direction: S::Vector, start: u32) -> SupportPoint<S::Vector> {
        self.core.support(direction, start)
    }
    #[inline(always)]
    fn farther(&self, direction: S::Vector, found: u32) -> Option<SupportPoint<S::Vector>> {
        self.core.farther(direction, found)
    }
    #[inline(always)]
    fn center(&self) -> S::Vector {
        self.core.center()
    }
    #[inline(always)]
    fn extent(&self) -> ScalarOf<S> {
        let radius = if self.radius >= Real::ZERO { self.radius } else { Real::INFINITY };
        (self.core.extent() + radius) * (ScalarOf::<S>::ONE + ScalarOf::<S>::EPSILON)
    }
    #[inline(always)]
    fn radius(&self) -> ScalarOf<S> {
        self.core.radius() + self.radius
    }
    #[inline(always)]
    fn slack(&self) -> ScalarOf<S> {
        self.core.slack()
    }
}

/// A body scaled along its own axes, then rotated, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transformed<S: Support> {
    pub(crate) shape: S,
    pub(crate) columns: [S::Vector; 3],
    pub(crate) translation: S::Vector,
    norm: ScalarOf<S>,
    /// Scale of the radius; zero if the scale differs by axis and the ball becomes an ellipsoid.
    radius_scale: ScalarOf<S>,
}

impl<S: Support> Transformed<S> {
    /// Maps a point `p` to `translation + rotation (scale ∘ p)`; `rotation` holds the images of the three axes, orthonormal.
    pub fn new(shape: S, rotation: [S::Vector; 3], scale: S::Vector, translation: S::Vector) -> Self {
        let [sx, sy, sz] = scale.to_array();
        let columns = [rotation[0] * sx, rotation[1] * sy, rotation[2] * sz];
        let rows = columns[0].abs() + columns[1].abs() + columns[2].abs();
        let even = sx.abs() == sy.abs() && sy.abs() == sz.abs();
        let radius_scale = if even { sx.abs() } else { Real::ZERO };
        Transformed { shape, columns, translation, norm: magnitude(rows), radius_scale }
    }

    /// The same elsewhere.
    #[must_use]
    pub fn moved(self, by: S::Vector) -> Self {
        Transformed { translation: self.translation + by, ..self }
    }

    /// What is mapped.
    pub fn shape(&self) -> &S {
        &self.shape
    }

    /// The image of a point.
    #[inline(always)]
    pub fn apply(&self, p: S::Vector) -> S::Vector {
        self.columns[0] * p.x() + self.columns[1] * p.y() + self.columns[2] * p.z() + self.translation
    }

    #[inline(always)]
    fn local(&self, direction: S::Vector) -> S::Vector {
        let [x, y, z] = self.columns;
        S::Vector::new(x.dot(direction), y.dot(direction), z.dot(direction))
    }

    /// A point of the shape as one of ours; `local` is the direction it was found in.
    #[inline(always)]
    fn image(&self, found: SupportPoint<S::Vector>, local: S::Vector) -> SupportPoint<S::Vector> {
        let mut point = found.point;
        if S::ROUNDED && self.radius_scale == Real::ZERO {
            let length = local.length();
            if length > Real::ZERO {
                // Divided first: the quotient is below one whatever the scale.
                let unit = S::Vector::new(local.x() / length, local.y() / length, local.z() / length);
                point += unit * self.shape.radius();
            }
        }
        SupportPoint { point: self.apply(point), index: found.index }
    }
}

impl<S: Support> Support for Transformed<S> {
    type Vector = S::Vector;
    const ROUNDED: bool = S::ROUNDED;
    #[inline(always)]
    fn support(&self, direction: S::Vector, start: u32) -> SupportPoint<S::Vector> {
        let local = self.local(direction);
        self.image(self.shape.support(local, start), local)
    }
    #[inline(always)]
    fn farther(&self, direction: S::Vector, found: u32) -> Option<SupportPoint<S::Vector>> {
        let local = self.local(direction);
        self.shape.farther(local, found).map(|found| self.image(found, local))
    }
    #[inline(always)]
    fn center(&self) -> S::Vector {
        self.apply(self.shape.center())
    }
    #[inline(always)]
    fn extent(&self) -> ScalarOf<S> {
        let one = ScalarOf::<S>::ONE;
        // The rotation may be off by some roundings: a little more than the sum.
        (self.norm * self.shape.extent() + magnitude(self.translation))
            * (one + ScalarOf::<S>::from_f64(64.0) * ScalarOf::<S>::EPSILON)
    }
    #[inline(always)]
    fn radius(&self) -> ScalarOf<S> {
        self.shape.radius() * self.radius_scale
    }
    #[inline(always)]
    fn slack(&self) -> ScalarOf<S> {
        // Mapping the direction and the point, each with some roundings of its terms; what the shape itself is off by is mapped too.
        self.norm * self.shape.slack() + ScalarOf::<S>::from_f64(32.0) * ScalarOf::<S>::EPSILON * self.extent()
    }
}

/// All differences `b - a` of points of two bodies. It holds the origin if and only if they meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinkowskiDifference<A, B> {
    /// What is subtracted.
    pub a: A,
    /// What it is subtracted from.
    pub b: B,
}

impl<A: Support, B: Support<Vector = A::Vector>> Support for MinkowskiDifference<A, B> {
    type Vector = A::Vector;
    const ROUNDED: bool = A::ROUNDED || B::ROUNDED;
    #[inline(always)]
    fn support(&self, direction: A::Vector, _: u32) -> SupportPoint<A::Vector> {
        // One index cannot name two vertices, so both are made sure of at once.
        let point = self.b.farthest(direction).point - self.a.farthest(-direction).point;
        SupportPoint { point, index: 0 }
    }
    #[inline(always)]
    fn center(&self) -> A::Vector {
        self.b.center() - self.a.center()
    }
    #[inline(always)]
    fn extent(&self) -> ScalarOf<A> {
        (self.a.extent() + self.b.extent()) * (ScalarOf::<A>::ONE + ScalarOf::<A>::EPSILON)
    }
    #[inline(always)]
    fn radius(&self) -> ScalarOf<A> {
        self.a.radius() + self.b.radius()
    }
    #[inline(always)]
    fn slack(&self) -> ScalarOf<A> {
        self.a.slack() + self.b.slack() + ScalarOf::<A>::EPSILON * self.extent()
    }
}

/// Scaled up or down by a power of two, so that the largest component is between 1 and 2; zero and non-finite vectors as they are.
#[inline(always)]
pub(crate) fn lengthened<V: Vector>(direction: V) -> V {
    // Subnormal numbers have no power of two of their own to divide by.
    let subnormal = direction.norm_max() < V::Scalar::MIN_POSITIVE;
    let direction = if subnormal { direction * (V::Scalar::ONE / V::Scalar::EPSILON) } else { direction };
    let unit = direction.norm_max().binade();
    if unit > V::Scalar::ZERO && unit.is_finite() { direction * (V::Scalar::ONE / unit) } else { direction }
}

/// A vector divided by its length; zero for zero, for vectors of subnormal numbers, and for infinite ones. A NaN stays one.
pub(crate) fn normalized<V: Vector>(v: V) -> V {
    let unit = v.norm_max().binade();
    if !(unit > V::Scalar::ZERO) || !unit.is_finite() {
        return V::ZERO;
    }
    let v = v * (V::Scalar::ONE / unit);
    v * (V::Scalar::ONE / v.dot(v).sqrt())
}
