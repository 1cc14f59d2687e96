//! Flat parts of surfaces.

use crate::convex::support::{Support, normalized};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A flat part of a body's surface: no point of the body has `normal·p > offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetPlane<V: Vector> {
    /// Outward, of length one.
    pub normal: V,
    /// Where it stands along the normal.
    pub offset: V::Scalar,
    /// Along a coordinate axis, so that neither normal nor offset are rounded, and the flat part lies exactly in it.
    pub exact: bool,
}

impl<V: Vector> FacetPlane<V> {
    /// Across `normal`, of any length, through a point farthest along it.
    pub fn new(normal: V, through: V) -> Self {
        let [x, y, z] = normal.to_array();
        let zero = V::Scalar::ZERO;
        let exact = [x, y, z].iter().filter(|&&c| c != zero).count() == 1;
        let sign = |c: V::Scalar| if c == zero { zero } else { V::Scalar::ONE.copysign(c) };
        let normal = if exact { V::new(sign(x), sign(y), sign(z)) } else { normalized(normal) };
        FacetPlane { normal, offset: normal.dot(through), exact }
    }

    /// Lowest and highest `normal·p - offset` over a box, rounded unless the plane is exact.
    #[inline(always)]
    pub fn range(&self, cell: &Aabb<V>) -> [V::Scalar; 2] {
        if self.exact {
            let high = cell.support(self.normal, 0).point;
            let low = cell.support(-self.normal, 0).point;
            return [low.dot(self.normal) - self.offset, high.dot(self.normal) - self.offset];
        }
        let middle = (cell.min + cell.max).dot(self.normal) * V::Scalar::HALF - self.offset;
        let reach = (cell.max - cell.min).dot(self.normal.abs()) * V::Scalar::HALF;
        [middle - reach, middle + reach]
    }

    /// Shortens the piece `t` of a line to the inner side of the plane moved outward by `grow`; false if nothing remains.
    #[inline(always)]
    pub(crate) fn clip(&self, origin: V, direction: V, grow: V::Scalar, t: &mut [V::Scalar; 2]) -> bool {
        let zero = V::Scalar::ZERO;
        let distance = self.offset + if self.exact { zero } else { grow } - self.normal.dot(origin);
        let rate = self.normal.dot(direction);
        if rate > zero {
            t[1] = t[1].min(distance / rate);
        } else if rate < zero {
            t[0] = t[0].max(distance / rate);
        } else if distance < zero {
            return false;
        }
        t[0] <= t[1]
    }
}
