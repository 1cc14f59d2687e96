//! Axis-aligned bounding boxes.

use crate::number::real::{Real, Vector};

/// An axis-aligned box, closed: `min <= p <= max` in every component. Empty if any `min` exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<V> {
    /// Lowest corner.
    pub min: V,
    /// Highest corner.
    pub max: V,
}

impl<V: Vector> Aabb<V> {
    /// The empty box: the neutral element of [`Aabb::union`].
    #[must_use]
    pub fn empty() -> Self {
        let inf = V::Scalar::INFINITY;
        Aabb { min: V::splat(inf), max: V::splat(-inf) }
    }

    /// The smallest box around some points; [`Aabb::empty`] for none.
    #[must_use]
    pub fn around(points: &[V]) -> Self {
        points.iter().fold(Self::empty(), |b, &p| Aabb { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Holds no point. A NaN does not make a box empty.
    #[must_use]
    pub fn is_empty(self) -> bool {
        let [a, b] = [self.min.to_array(), self.max.to_array()];
        a[0] > b[0] || a[1] > b[1] || a[2] > b[2]
    }

    /// The closed boxes share at least one point.
    #[must_use]
    pub fn touches(self, other: Self) -> bool {
        !Aabb { min: self.min.max(other.min), max: self.max.min(other.max) }.is_empty()
    }

    /// Edge lengths.
    #[must_use]
    pub fn size(self) -> V {
        self.max - self.min
    }

    /// Centre.
    #[must_use]
    pub fn center(self) -> V {
        (self.min + self.max) * V::Scalar::HALF
    }
}
