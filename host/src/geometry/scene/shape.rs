//! The shapes of solids: their keys, checks, volumes, and their forms in place.

use super::hull;
use super::placement::{Motion, axis};
use super::table::{self, StrictTable};
use crate::error::Result;
use crate::geometry::form::Form;
use crate::geometry::unit::Unit;
use crate::keys::reader::nearest;
use glam::DVec3;
use std::f64::consts::PI;
use std::path::PathBuf;
use std::sync::Arc;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::torus::{TorusShape, TorusSolid};

/// A shape as the scene describes it, before it is placed. Lengths in metres.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// `center`, `radius`
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius.
        radius: f64,
    },
    /// `center`, `semi_axes`
    Ellipsoid {
        /// Centre.
        center: DVec3,
        /// Half its length along x, y and z.
        semi_axes: DVec3,
    },
    /// `min`, `max`
    Box {
        /// Lowest corner.
        min: DVec3,
        /// Highest corner.
        max: DVec3,
    },
    /// `from`, `to`, `radius`; a cone's `top_radius`
    Round {
        /// Cylinder, capsule or cone.
        kind: Round,
        /// One end of the axis; a cone's base centre.
        from: DVec3,
        /// The other; a cone's top centre or apex.
        to: DVec3,
        /// Radius; a cone's at its base.
        radius: f64,
        /// A cone's at `to`, 0 of an apex; of the others the same.
        top_radius: f64,
    },
    /// `center`, `axis`, `radius`, `tube`; of pipe bends `start`, `angle`
    Torus(TorusShape<DVec3>),
    /// `points`
    Hull(hull::HullSolid),
    /// `path`, `unit`, `scale`
    File {
        /// The file, relative to the scene's directory.
        path: PathBuf,
        /// Metres in one unit of its coordinates.
        scale: f64,
    },
}

/// Bodies of revolution with an axis of given ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Round {
    /// Flat ends.
    Cylinder,
    /// Round ends beyond those of the axis.
    Capsule,
    /// Apex at the end of the axis, or a second flat end.
    Cone,
}

/// The shapes, each with the keys it must have and those it may have.
pub const SHAPES: [(&str, &[&str], &[&str]); 9] = [
    ("sphere", &["center", "radius"], &[]),
    ("ellipsoid", &["center", "semi_axes"], &[]),
    ("box", &["min", "max"], &[]),
    ("cylinder", &["from", "to", "radius"], &[]),
    ("capsule", &["from", "to", "radius"], &[]),
    ("cone", &["from", "to", "radius"], &["top_radius"]),
    ("torus", &["center", "axis", "radius", "tube"], &["start", "angle"]),
    ("hull", &["points"], &[]),
    ("file", &["path"], &["unit", "scale"]),
];

/// Keys that every solid may have.
pub const EVERY: [&str; 8] = ["name", "shape", "porosity", "cd", "cr", "rotate", "translate", "array"];

/// A table has the keys of its shape and no others.
fn check_keys(keys: &StrictTable, shape: &str) -> Result<()> {
    let Some((_, needed, optional)) = SHAPES.iter().find(|(name, ..)| *name == shape) else {
        let names = SHAPES.map(|(name, ..)| name);
        let near = nearest(shape, &names).map_or_else(String::new, |near| format!("; did you mean {near}?"));
        return Err(keys.wrong("shape", format!("\"{shape}\" is not known: {}{near}", names.join(", "))));
    };
    let own = [*needed, *optional].concat();
    let takes = format!("{shape} takes {}", own.join(", "));
    let given = keys.given();
    let wrong: Vec<_> = given.iter().filter(|(key, _)| !own.contains(key) && !EVERY.contains(key)).collect();
    let missing: Vec<&str> = needed.iter().copied().filter(|key| !keys.has(key)).collect();
    match (wrong.first(), &missing[..]) {
        (None, []) => Ok(()),
        (None, missing) => {
            let are = if missing.len() == 1 { "is" } else { "are" };
            Err(keys.fail(format!("{takes}; {} {are} missing", missing.join(", "))))
        }
        (Some((_, span)), _) => {
            let names: Vec<&str> = wrong.iter().map(|(key, _)| if key.is_empty() { "\"\"" } else { *key }).collect();
            Err(keys.error_at(
                span.clone(),
                format!("{takes}; not {} (and every solid takes {})", names.join(", "), EVERY.join(", ")),
            ))
        }
    }
}

impl Shape {
    /// Read `shape` and the keys that it asks for.
    ///
    /// # Errors
    /// A shape that is not known, a key that is missing, of the wrong kind, or that leaves nothing solid.
    pub fn read(keys: &mut StrictTable) -> Result<Self> {
        let round = |kind: Round, keys: &mut StrictTable| {
            let (from, to) = (keys.need("from", table::point)?, keys.need("to", table::point)?);
            let top =
                if kind == Round::Cone { keys.get("top_radius", table::not_negative)?.unwrap_or(0.0) } else { 0.0 };
            let radius = keys.need("radius", |value| match table::number(value)? {
                0.0 if top > 0.0 => Err("must be positive, not 0: a cone has its apex at to; swap from and to".into()),
                _ => table::positive(value),
            })?;
            let top_radius = if kind == Round::Cone { top } else { radius };
            if from == to && kind != Round::Capsule {
                return Err(keys.wrong("to", "is the same point as from"));
            }
            Ok(Shape::Round { kind, from, to, radius, top_radius })
        };
        let shape = keys.need("shape", table::text)?;
        check_keys(keys, &shape)?;
        match shape.as_str() {
            "sphere" => Ok(Shape::Sphere {
                center: keys.need("center", table::point)?,
                radius: keys.need("radius", table::positive)?,
            }),
            "ellipsoid" => Ok(Shape::Ellipsoid {
                center: keys.need("center", table::point)?,
                semi_axes: DVec3::from_array(keys.need("semi_axes", table::three(table::positive))?),
            }),
            "box" => {
                let (min, max) = (keys.need("min", table::point)?, keys.need("max", table::point)?);
                if min.cmplt(max).all() {
                    Ok(Shape::Box { min, max })
                } else {
                    Err(keys.wrong("max", format!("({max}) must lie above min ({min}) along every axis")))
                }
            }
            "cylinder" => round(Round::Cylinder, keys),
            "capsule" => round(Round::Capsule, keys),
            "cone" => round(Round::Cone, keys),
            "torus" => torus(keys),
            "hull" => {
                let points = keys.need("points", table::list(table::point))?;
                hull::HullSolid::new(&points).map(Shape::Hull).map_err(|reason| keys.wrong("points", reason))
            }
            _ => file(keys), // the only one left that is known
        }
    }

    /// The angle that it has, in degrees; 360 of a shape without.
    #[must_use]
    pub fn angle(&self) -> f64 {
        match self {
            Shape::Torus(TorusShape { angle, .. }) => *angle,
            _ => 360.0,
        }
    }

    /// Its name in scene files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Sphere { .. } => "sphere",
            Shape::Ellipsoid { .. } => "ellipsoid",
            Shape::Box { .. } => "box",
            Shape::Round { kind: Round::Cylinder, .. } => "cylinder",
            Shape::Round { kind: Round::Capsule, .. } => "capsule",
            Shape::Round { kind: Round::Cone, .. } => "cone",
            Shape::Torus(_) => "torus",
            Shape::Hull(_) => "hull",
            Shape::File { .. } => "file",
        }
    }

    /// The point that a rotation leaves in place: the middle of the axis or of the box around it; of files, none before they are read.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        match self {
            Shape::Sphere { center, .. }
            | Shape::Ellipsoid { center, .. }
            | Shape::Torus(TorusShape { center, .. }) => *center,
            Shape::Box { min, max } => middle(*min, *max),
            Shape::Round { from, to, .. } => middle(*from, *to),
            Shape::Hull(hull) => {
                let Aabb { min, max } = Aabb::around(&hull.corners);
                middle(min, max)
            }
            Shape::File { .. } => DVec3::ZERO,
        }
    }

    /// Its volume by formula; of files, 0 before they are read.
    #[must_use]
    pub fn volume(&self) -> f64 {
        match self {
            Shape::Sphere { radius, .. } => 4.0 / 3.0 * PI * radius.powi(3),
            Shape::Ellipsoid { semi_axes, .. } => 4.0 / 3.0 * PI * semi_axes.element_product(),
            Shape::Box { min, max } => (max - min).element_product(),
            Shape::Round { kind, from, to, radius, top_radius } => {
                let squares = radius * radius + radius * top_radius + top_radius * top_radius;
                let straight = PI / 3.0 * squares * (to - from).length();
                straight + if *kind == Round::Capsule { 4.0 / 3.0 * PI * radius.powi(3) } else { 0.0 }
            }
            // Pappus: the disc's area times the way of its centre.
            Shape::Torus(TorusShape { radius, tube, angle, .. }) => PI * tube * tube * angle.to_radians() * radius,
            Shape::Hull(hull) => hull.volume(),
            Shape::File { .. } => 0.0,
        }
    }

    /// Where it is after a motion; none for files.
    #[must_use]
    pub fn placed(&self, motion: &Motion) -> Option<Form> {
        let at = |p: &DVec3| motion.apply(*p);
        Some(match self {
            Shape::Sphere { center, radius } => Form::Sphere(Sphere { center: at(center), radius: *radius }),
            Shape::Ellipsoid { center, semi_axes } => {
                let about_origin = Ellipsoid { center: DVec3::ZERO, semi_axes: *semi_axes };
                let turn = motion.matrix();
                let columns = [turn.x_axis, turn.y_axis, turn.z_axis];
                Form::Ellipsoid(Transformed::new(about_origin, columns, DVec3::ONE, at(center)))
            }
            Shape::Box { min, max } if motion.turn.is_none() => Form::Box(Aabb { min: at(min), max: at(max) }),
            Shape::Box { min, max } => Form::Hull(hull::corners_of_box(*min, *max).iter().map(at).collect()),
            Shape::Round { kind, from, to, radius, top_radius } => match kind {
                Round::Cylinder => Form::Cylinder(Cylinder::new(at(from), at(to), *radius)),
                Round::Capsule => Form::Capsule(Capsule { from: at(from), to: at(to), radius: *radius }),
                Round::Cone => Form::Cone(Cone::truncated(at(from), at(to), *radius, *top_radius)),
            },
            Shape::Torus(torus) => {
                let turn = |v: DVec3| if motion.turn.is_some() { motion.matrix() * v } else { v };
                let (axis, start) = (turn(torus.axis), turn(torus.start));
                Form::Torus(TorusShape { center: at(&torus.center), axis, start, ..*torus })
            }
            Shape::Hull(hull) => Form::Hull(hull.corners.iter().map(at).collect::<Arc<[_]>>()),
            Shape::File { .. } => return None,
        })
    }

    /// Triangles of its surface, outward, before it is placed; none if it is round or a file.
    #[must_use]
    pub fn surface(&self) -> Vec<[DVec3; 3]> {
        match self {
            Shape::Box { min, max } => hull::surface_of_box(*min, *max),
            Shape::Hull(hull) => hull.surface(),
            _ => Vec::new(),
        }
    }
}

/// A ring, or a bend of a pipe.
fn torus(keys: &mut StrictTable) -> Result<Shape> {
    let center = keys.need("center", table::point)?;
    let axis = keys.need("axis", axis)?;
    let (radius, tube) = (keys.need("radius", table::positive)?, keys.need("tube", table::positive)?);
    let start = keys.get("start", self::axis)?;
    let angle = keys.get("angle", table::positive)?;
    if tube > radius {
        return Err(keys.wrong(
            "tube",
            format!("({tube}) must not be above radius ({radius}): the ring would run through its own axis"),
        ));
    }
    if angle.is_some_and(|angle| angle > 360.0) {
        return Err(keys.wrong("angle", "must not be above 360 degrees"));
    }
    if !(axis.abs().max_element() > 0.0) {
        return Err(keys.wrong("axis", "has no direction"));
    }
    if angle.is_some() != start.is_some() {
        let (given, other) = if angle.is_some() { ("angle", "start") } else { ("start", "angle") };
        return Err(keys.wrong(given, format!("needs {other}: a bend begins at start and goes on for angle degrees")));
    }
    let start = start.unwrap_or_else(|| axis.any_orthonormal_vector());
    let shape = TorusShape { center, axis, start, radius, tube, angle: angle.unwrap_or(360.0) };
    let scaled = |v: DVec3| v / v.abs().max_element();
    if scaled(start).cross(scaled(axis)) == DVec3::ZERO {
        return Err(keys.wrong("start", "points along the axis: a bend begins where start points away from the axis"));
    }
    if TorusSolid::new(&shape).is_none() {
        let key = if angle.is_some() { "start" } else { "axis" };
        return Err(keys.wrong(
            key,
            "and the other keys leave no ring: start must point away from the axis, lengths lie between 1e-30 and 1e30",
        ));
    }
    Ok(Shape::Torus(shape))
}

fn middle(a: DVec3, b: DVec3) -> DVec3 {
    a * 0.5 + b * 0.5
}

fn file(keys: &mut StrictTable) -> Result<Shape> {
    let path = keys.need("path", |value| match table::text(value)? {
        path if path.is_empty() => Err("is empty: it names an STL or OBJ file".to_owned()),
        path => Ok(PathBuf::from(path)),
    })?;
    let unit = keys.get("unit", table::unit)?;
    let scale = keys.get("scale", table::positive)?.unwrap_or(1.0);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
        return Err(keys.wrong("path", "names a scene, but scenes do not hold scenes: only STL and OBJ files"));
    }
    Ok(Shape::File { path, scale: scale * unit.unwrap_or(Unit::M).metres() })
}
