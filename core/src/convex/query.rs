//! Two convex bodies of any kind: do they meet, and how far apart are they? One call, which goes on to the exact stage where it applies.

use crate::convex::any_body::{AnyBody, SharpBody};
use crate::convex::exact::{self, Contact, ExactAxis, Relation, Surround};
use crate::convex::gjk::{self, Distance, Intersection, OverlapProof, Reason};
use crate::convex::support::Support;
use crate::number::real::{Real, Vector};

/// How two bodies lie, with the proof.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Meeting<V: Vector> {
    /// No point is shared.
    Apart(SeparationProof<V>),
    /// Points are shared, but no inner point: along this direction from the first body to the second nothing of the first lies beyond anything
    /// of the second. Told only of bodies given by vertices.
    Touching(ExactAxis<V::Scalar>),
    /// An inner point is shared.
    Overlapping(MeetingProof<V>),
    /// Rounding hides it.
    Undecided(Reason),
}

/// Why two bodies are apart.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum SeparationProof<V: Vector> {
    /// A direction from the first body to the second, of any length, that separates them: see [`gjk::separates`].
    Axis(V),
    /// A direction that separates them, exact: [`ExactAxis::gap`] is `Greater`.
    Exact(ExactAxis<V::Scalar>),
}

/// Why two bodies overlap.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum MeetingProof<V: Vector> {
    /// Points of both bodies.
    Points(OverlapProof<V>),
    /// Vertices of both bodies, exactly: see [`Surround::holds`].
    Exact(Surround),
}

impl<V: Vector> Meeting<V> {
    /// The answer without the proof; none if undecided.
    pub fn contact(&self) -> Option<Contact> {
        match self {
            Meeting::Apart(_) => Some(Contact::Disjoint),
            Meeting::Touching(_) => Some(Contact::Touching),
            Meeting::Overlapping(_) => Some(Contact::Overlapping),
            Meeting::Undecided(_) => None,
        }
    }
}

/// How far apart two bodies are.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Clearance<V: Vector> {
    /// No point is shared.
    Apart {
        /// The distance, within `lower..=upper`.
        distance: V::Scalar,
        /// The point of the first body that is nearest to the second, to rounding.
        a: V,
        /// The point of the second body that is nearest to the first, to rounding.
        b: V,
        /// The true distance is not less than this; positive.
        lower: V::Scalar,
        /// The true distance is not more than this.
        upper: V::Scalar,
    },
    /// The distance is zero, and no inner point is shared; [`meets`] gives the proof.
    Touching,
    /// An inner point is shared; [`meets`] gives the proof.
    Overlapping,
    /// Rounding hides whether they meet.
    Undecided {
        /// The true distance, 0 if they meet, is not less than this.
        lower: V::Scalar,
        /// The true distance is not more than this; infinite if nothing is known.
        upper: V::Scalar,
        /// Why.
        reason: Reason,
    },
}

/// Do two bodies meet? The same as [`BodyQuery::meets`] without a hint.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::convex::{self, AnyBody, exact::Contact, shape::{Hull, Sphere}};
/// use voidage_core::number::aabb::Aabb;
///
/// let cube = AnyBody::new(Aabb { min: DVec3::ZERO, max: DVec3::ONE })?;
/// let corners = [DVec3::X, DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 0.0, 1.0)];
/// // Rounding could not tell that they touch; the exact stage can.
/// assert_eq!(convex::meets(&cube, &AnyBody::new(Hull::new(&corners))?).contact(), Some(Contact::Touching));
///
/// let ball = AnyBody::new(Sphere { center: DVec3::new(1.5, 0.5, 0.5), radius: 0.625 })?;
/// assert_eq!(convex::meets(&cube, &ball).contact(), Some(Contact::Overlapping));
/// # Ok::<(), convex::BodyError>(())
/// ```
pub fn meets<V: Vector>(a: &AnyBody<V>, b: &AnyBody<V>) -> Meeting<V> {
    BodyQuery::new(a, b).meets()
}

/// How far apart are two bodies? The same as [`BodyQuery::distance`] without a hint.
///
/// ```
/// use glam::Vec3;
/// use voidage_core::convex::{self, AnyBody, Clearance, shape::Cylinder};
///
/// let a = AnyBody::new(Cylinder::new(Vec3::ZERO, Vec3::Z, 0.5))?;
/// let b = a.posed([Vec3::X, Vec3::Y, Vec3::Z], Vec3::new(3.0, 0.0, 0.0))?;
/// let Clearance::Apart { distance, lower, upper, .. } = convex::distance(&a, &b) else { panic!("they are apart") };
/// assert!(lower <= 2.0 && 2.0 <= upper && (distance - 2.0).abs() < 1e-5);
/// # Ok::<(), convex::BodyError>(())
/// ```
pub fn distance<V: Vector>(a: &AnyBody<V>, b: &AnyBody<V>) -> Clearance<V> {
    BodyQuery::new(a, b).distance()
}

/// A question about two bodies.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::convex::{AnyBody, BodyQuery, exact::Contact, shape::Sphere};
///
/// let a = AnyBody::new(Sphere { center: DVec3::ZERO, radius: 1.0 })?;
/// let b = AnyBody::new(Sphere { center: DVec3::new(0.0, 3.0, 0.0), radius: 1.0 })?;
/// let last_axis = DVec3::new(0.1, 1.0, 0.0);
/// assert_eq!(BodyQuery::new(&a, &b).hint(last_axis).meets().contact(), Some(Contact::Disjoint));
/// # Ok::<(), voidage_core::convex::BodyError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BodyQuery<'q, 'a, 'b, V: Vector> {
    a: &'q AnyBody<'a, V>,
    b: &'q AnyBody<'b, V>,
    hint: Option<V>,
}

/// Rounding of an exact distance, in units of ε of the caller's precision: 16 of `f64` in the distance itself, and one conversion.
const EXACT_ROUNDINGS: f64 = 32.0;

impl<'q, 'a, 'b, V: Vector> BodyQuery<'q, 'a, 'b, V> {
    /// About these two.
    pub fn new(a: &'q AnyBody<'a, V>, b: &'q AnyBody<'b, V>) -> Self {
        BodyQuery { a, b, hint: None }
    }

    /// A direction from the first body towards the second, of any length, to start with: the axis of a similar query, say. It changes the work,
    /// not the truth.
    #[must_use]
    pub fn hint(self, axis: V) -> Self {
        BodyQuery { hint: Some(axis), ..self }
    }

    /// Do the bodies meet? Interiors decide: bodies that only touch are [`Meeting::Touching`] if both are given by vertices, and else undecided.
    pub fn meets(&self) -> Meeting<V> {
        let found = match self.sharp() {
            Some((a, b)) => gjk::intersect(&a, &b, self.hint),
            None => gjk::intersect(self.a, self.b, self.hint),
        };
        match found {
            Intersection::Apart { axis } => Meeting::Apart(SeparationProof::Axis(axis)),
            Intersection::Overlapping { proof } => Meeting::Overlapping(MeetingProof::Points(proof)),
            Intersection::Undecided { reason, axis } => self.exactly(axis).unwrap_or(Meeting::Undecided(reason)),
        }
    }

    /// The answer of [`BodyQuery::meets`] without its proof; none if undecided. Proofs of the exact stage are large: where rounding can tell, this
    /// takes far less stack.
    pub fn contact(&self) -> Option<Contact> {
        let found = match self.sharp() {
            Some((a, b)) => gjk::intersect(&a, &b, self.hint),
            None => gjk::intersect(self.a, self.b, self.hint),
        };
        match found {
            Intersection::Apart { .. } => Some(Contact::Disjoint),
            Intersection::Overlapping { .. } => Some(Contact::Overlapping),
            Intersection::Undecided { axis, .. } => self.exact_contact(axis),
        }
    }

    /// In a frame of its own, so that queries which do not come here have none of its memory.
    #[inline(never)]
    fn exact_contact(&self, axis: V) -> Option<Contact> {
        self.exactly(axis)?.contact()
    }

    /// How far apart are the bodies?
    pub fn distance(&self) -> Clearance<V> {
        let found = match self.sharp() {
            Some((a, b)) => gjk::distance(&a, &b, self.hint),
            None => gjk::distance(self.a, self.b, self.hint),
        };
        match found {
            Distance::Separated { distance, a, b, lower, upper, .. } => {
                Clearance::Apart { distance, a, b, lower, upper }
            }
            Distance::Overlapping { .. } => Clearance::Overlapping,
            Distance::Undecided { lower, upper, reason } => {
                self.exact_distance().unwrap_or(Clearance::Undecided { lower, upper, reason })
            }
        }
    }

    /// Both bodies without radii, if both are.
    fn sharp(&self) -> Option<(SharpBody<'q, 'a, V>, SharpBody<'q, 'b, V>)> {
        (self.a.is_sharp() && self.b.is_sharp()).then_some((SharpBody(self.a), SharpBody(self.b)))
    }

    /// The exact answer, if both bodies are given by vertices.
    fn exactly(&self, axis: V) -> Option<Meeting<V>> {
        let (a, b) = (self.a.as_vertices()?, self.b.as_vertices()?);
        Some(match exact::relation(&a, &b, Some(axis)).ok()? {
            Relation::Disjoint(axis) => Meeting::Apart(SeparationProof::Exact(axis)),
            Relation::Touching(axis) => Meeting::Touching(axis),
            Relation::Overlapping(points) => Meeting::Overlapping(MeetingProof::Exact(points)),
        })
    }

    /// The exact distance, if both bodies are given by vertices.
    #[inline(never)]
    fn exact_distance(&self) -> Option<Clearance<V>> {
        let axis = self.hint.unwrap_or(self.b.center() - self.a.center());
        match self.exact_contact(axis)? {
            Contact::Touching => return Some(Clearance::Touching),
            Contact::Overlapping => return Some(Clearance::Overlapping),
            Contact::Disjoint => {}
        }
        let (a, b) = (self.a.as_vertices()?, self.b.as_vertices()?);
        let found = exact::distance(&a, &b, Some(axis)).ok()?;
        let real = V::Scalar::from_f64;
        let distance = real(found.distance);
        let relative = real(EXACT_ROUNDINGS) * V::Scalar::EPSILON;
        let step = V::Scalar::MIN_POSITIVE * V::Scalar::EPSILON;
        Some(Clearance::Apart {
            distance: distance.max(step),
            a: V::from_array(found.a.map(real)),
            b: V::from_array(found.b.map(real)),
            lower: (distance * (V::Scalar::ONE - relative) - step).max(step),
            upper: distance * (V::Scalar::ONE + relative) + step,
        })
    }
}
