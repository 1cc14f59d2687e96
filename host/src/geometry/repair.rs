//! From triangles as they come to closed shells: welded, oriented, split, capped, nested.

pub mod nesting;
pub mod rims;
pub mod shells;
pub mod weld;
