//! From triangles as they come to closed shells: welded, cut at T-junctions, oriented, split, freed of copies, capped, resolved where they cross themselves, nested.

pub mod apart;
pub mod boxes;
pub mod clear;
pub mod closed;
pub mod copies;
pub mod cracks;
pub mod crossing;
pub mod edges;
pub mod face;
pub mod frame;
pub mod gaps;
pub mod join;
pub mod junctions;
pub mod lines;
pub mod nesting;
pub mod overlap;
pub mod regions;
pub mod rims;
pub mod rooms;
pub mod separation;
pub mod sets;
pub mod shells;
pub mod tree;
pub mod two_sided;
pub mod weld;
