//! Convex bodies: point, segment, triangle, boxes, sphere, ellipsoid, capsule, cylinder, cone, hull.
//!
//! Each is a [`Support`](crate::convex::support::Support) mapping. Bodies given by vertices ([`Vertices`]) are exact: their support points are the
//! vertices themselves. The others say by [`Support::slack`](crate::convex::support::Support::slack) how far rounding may have moved a point.

mod adjacency;
mod curved;
mod flat;
mod hull;
mod plane;
mod scan;
pub use adjacency::Adjacency;
pub(crate) use curved::AxisFrame;
pub use curved::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
pub use flat::{OrientedBox, Point, Segment, Triangle, Vertices};
pub use hull::Hull;
pub use plane::FacetPlane;
