//! A body behind a pointer: what is rare is compiled once for all of them.

use crate::convex::support::{ScalarOf, Support, SupportPoint, delegate_support};
use crate::number::real::Vector;

/// What [`Support`] asks of a body, without what a type must be known for.
trait Points<V: Vector> {
    fn support(&self, direction: V, start: u32) -> SupportPoint<V>;
    fn farther(&self, direction: V, found: u32) -> Option<SupportPoint<V>>;
    fn center(&self) -> V;
    fn extent(&self) -> V::Scalar;
    fn radius(&self) -> V::Scalar;
    fn slack(&self) -> V::Scalar;
}

impl<S: Support> Points<S::Vector> for S {
    fn support(&self, direction: S::Vector, start: u32) -> SupportPoint<S::Vector> {
        Support::support(self, direction, start)
    }
    fn farther(&self, direction: S::Vector, found: u32) -> Option<SupportPoint<S::Vector>> {
        Support::farther(self, direction, found)
    }
    fn center(&self) -> S::Vector {
        Support::center(self)
    }
    fn extent(&self) -> ScalarOf<S> {
        Support::extent(self)
    }
    fn radius(&self) -> ScalarOf<S> {
        Support::radius(self)
    }
    fn slack(&self) -> ScalarOf<S> {
        Support::slack(self)
    }
}

/// A body of a type known only at run time.
pub(crate) struct Opaque<'a, V: Vector>(&'a dyn Points<V>);

impl<'a, V: Vector> Opaque<'a, V> {
    pub(crate) fn new<S: Support<Vector = V>>(body: &'a S) -> Self {
        Opaque(body)
    }
}

impl<V: Vector> Support for Opaque<'_, V> {
    delegate_support!(self, V => self.0);
}
