//! Geometry: triangles of files and solids by formula, put in order until they are bodies that can be measured.
//!
//! In reading order: [`mod@unit`], [`mesh`], [`read`]; [`form`], [`facets`], [`single`], [`repair`], `diagnosis`, `resolve`, `close`, [`bodies`]; [`areas`], [`cut_areas`]; `scene`.

pub mod areas;
pub mod bodies;
mod close;
pub mod cut_areas;
mod diagnosis;
pub mod facets;
pub mod form;
pub mod mesh;
pub mod read;
pub mod repair;
mod resolve;
#[cfg(feature = "scene")]
pub mod scene;
pub mod single;
pub mod unit;
