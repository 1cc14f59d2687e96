//! STL, binary and ASCII.
//!
//! Stored normals are never looked at: exporters write zeros, NaN or another orientation, and the winding says it all.
//! Reference: 3D Systems, *StereoLithography Interface Specification*, 1988; there is no standard.

pub mod ascii;
pub mod binary;
