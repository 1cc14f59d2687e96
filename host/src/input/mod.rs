//! Readers of surface meshes.
