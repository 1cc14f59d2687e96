//! The layers of solid bodies, with curved ones as facets.

use crate::geometry::bodies::Bodies;
use glam::DVec3;
use voidage_core::surface::layer::Layers;

/// Solid bodies in the layers of a grid.
pub struct SolidLayers<'a> {
    /// The bodies, numbered as in the layers.
    pub bodies: &'a Bodies,
    /// Their triangles; of curved bodies, facets.
    pub layers: &'a Layers<'a, DVec3>,
    /// The largest share by which facets miss one of the areas of a whole curved body; 0 without such bodies.
    pub facet_error: f64,
}
