//! Solids between polytopes in a box, and the share of the box that a union of them has, with bounds.
//!
//! A smooth surface differs from its tangent plane by the square of the distance. So in a small box a solid lies between two polytopes: one
//! whose planes are moved out by as much as the surface may bend away, and one whose planes are moved in. What unions of polytopes have
//! of the box is exact. A box is halved along each axis until its bounds are close enough; only where two surfaces meet does that take many
//! parts, and there each level makes the gap eight times smaller: there are twice as many of such parts, of an eighth of the size, and as a share of it
//! the gap of each is half as large. Where surfaces coincide four times as many parts are cut at each level, and sections serve better ([`crate::solids::quadric`]).
//!
//! 1. `constraint`: an affine function and how far another may be from it
//! 2. `filled`: what affine functions leave of a box
//! 3. `union`: bounds of a union's share of a box
//! 4. `planar`: what lies behind a few planes, as a solid

mod constraint;
mod filled;
mod planar;
mod union;

pub use constraint::{BoxAround, Constraint, Enclosure};
pub use union::{Enclosed, UnionEffort, excess, union_bounds};
