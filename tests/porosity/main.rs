//! Porosity of bodies on grids: known solids, oracles, invariances, ground truth.

mod architecture;
mod bends;
mod boxes;
mod common;
mod core_alone;
mod curved;
mod dirty;
mod divided;
mod drag;
mod formulas;
mod holes;
mod hulls;
mod invariance;
mod known;
mod meshes;
mod obstacles;
mod on_planes;
mod overlap;
mod quadric;
mod rings;
mod scenes;
mod shadows;
mod subdivide;
mod torus;
mod torus_points;
mod truth;
