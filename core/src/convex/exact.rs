//! The exact second stage for bodies given by vertices: disjoint, touching or overlapping, never undecided.
//!
//! The same search as in [`crate::convex::gjk`], in exact integers: every sign is right, and each iteration comes strictly nearer to the
//! origin, so the search ends. Where the nearest point is the origin itself, on a face, an edge or a vertex of the simplex, the question is whether
//! the difference has points on both sides of every plane through that face, edge or vertex; this is answered by turning a plane about it.
//!
//! `integer` holds the numbers, `lattice` brings coordinates to them, `simplex` has the signs, `search` finds the nearest point, `touch`
//! decides where the origin lies on the simplex, `distance` rounds the result.
//!
//! Signs are of degree 4 at most in the coordinates. Integers are used and not floating-point expansions because a product of expansions is
//! no longer exact once a term underflows. How many words they have follows from the scalar.

use crate::convex::gjk::{Intersection, intersect};
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;

mod distance;
mod integer;
mod lattice;
mod relation;
mod search;
mod simplex;
mod touch;

pub use distance::{ExactDistance, distance};
use integer::is_zero;
use lattice::CoordinateLattice;
pub use lattice::NotFinite;
pub use relation::{Contact, ExactAxis, Relation, Surround};
use search::LatticePair;

/// Disjoint, touching or overlapping: by [`intersect`] where that can tell, else exactly.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{number::aabb::Aabb, convex::exact::{Contact, contact}, convex::shape::Triangle};
///
/// let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
/// let (a, b, c) = (DVec3::new(1.0, 0.2, 0.2), DVec3::new(1.0, 0.8, 0.2), DVec3::new(1.5, 0.2, 0.9));
/// assert_eq!(contact(&cell, &Triangle { a, b, c }, None), Ok(Contact::Touching));
/// ```
pub fn contact<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Contact, NotFinite>
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
pub fn relation<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Relation<ScalarOf<A>>, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    let pair = LatticePair { a, b, lattice: CoordinateLattice::new(a, b)? };
    let search = pair.search(hint, true);
    if !is_zero(&search.direction) {
        return Ok(Relation::Disjoint(ExactAxis::new(search.direction)));
    }
    let points = search.simplex.as_slice();
    Ok(match search.weak {
        Some(axis) => Relation::Touching(ExactAxis::new(axis)),
        None => match points {
            [a, b, c, d] => Relation::Overlapping(Surround::of(&[a, b, c, d])),
            [a, b, c] => pair.about_face(a, b, c),
            [a, b] => pair.about_edge(a, b),
            _ => pair.about_vertex(),
        },
    })
}
