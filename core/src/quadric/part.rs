//! One curved surface between flat ends: its sections with grid planes and its share of a cell.
//!
//! The volume in a cell is the flux through the cell's faces and the part's flat ends of a field of divergence 1 that is tangent to the
//! curved surface: of a cylinder (ξ − ξₘ) a / a_ξ with ξ the coordinate along which the axis `a` is longest and ξₘ the cell's middle; of a cone
//! (p − apex) / 3; of balls and ellipsoids see [`super::solid_angle`].

use super::end_line::EndLine;
use super::ends::End;
use super::outline::{Rectangle, Region, Section};
use super::shadow::PlaneOverApex;
use super::solid_angle::PlaneOfUnitBall;
use super::twofold::{Twofold, difference, difference_of_squares};
use super::wall::{Curved, Span, Wall, hypotenuse, others};
use crate::number::real::Real;
use core::f64::consts::PI;

/// A convex part of a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub origin: [f64; 3],
    pub curved: Curved,
    pub ends: [Option<End>; 2],
    /// The axis along which `Curved::axis` is longest.
    pub xi: usize,
}

/// A grid plane as a part sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    n: usize,
    /// Coordinate from the part's origin.
    pub h: Twofold,
    section: Section,
    lines: [Option<EndLine>; 2],
}

/// What a part has of a face: area, and flux of its field along the axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceFlux {
    pub area: f64,
    pub flux: f64,
    /// Of a cone: flux of p/(3 ζ³), ζ the height from the apex; see [`super::shadow`].
    pub shadow: f64,
    pub whole: bool,
}

/// The planes on both sides of a cell along each axis.
pub(super) type Sides<'a> = [[&'a Plane; 2]; 3];

impl Part {
    pub fn new(origin: [f64; 3], curved: Curved, ends: [Option<End>; 2]) -> Self {
        let [x, y, z] = curved.axis.map(f64::abs);
        let xi = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        Part { origin, curved, ends, xi }
    }

    /// A plane across axis `n`.
    #[inline]
    pub fn plane(&self, n: usize, coordinate: f64) -> Plane {
        let h = difference(coordinate, self.origin[n]);
        let (quadratic, linear) = self.curved.conic(n);
        let section = Section { quadratic, linear: linear.map(|l| l * h.value), ellipse: self.curved.ellipse(n, h) };
        let lines = self.ends.map(|end| end.map(|end| end.line(n, coordinate)));
        Plane { n, h, section, lines }
    }

    /// What the line where two planes meet has inside the curved surface; it runs along axis `m`, the planes in the order of [`others`].
    #[inline]
    pub fn span(&self, m: usize, planes: [&Plane; 2]) -> Span {
        self.curved.span(m, planes.map(|p| p.h))
    }

    /// The same inside the ends too.
    pub fn span_between_ends(&self, m: usize, planes: [&Plane; 2]) -> Span {
        let inside = |end: &End| end.span(m, planes.map(|p| p.h.value));
        self.ends.iter().flatten().map(inside).fold(self.span(m, planes), Span::intersection)
    }

    /// Area and flux of a face between planes, `spans` those of its sides in the order of [`Rectangle::corners`].
    #[inline]
    pub fn face(&self, plane: &Plane, u: [&Plane; 2], v: [&Plane; 2], spans: &[Span; 4]) -> FaceFlux {
        let rectangle = Rectangle { u: u.map(|p| p.h.value), v: v.map(|p| p.h.value) };
        let region = plane.section.region(&rectangle, spans, &plane.lines);
        if matches!(region, Region::Empty) {
            return FaceFlux::default();
        }
        let moments = plane.section.moments(&region, &rectangle);
        let (n, h) = (plane.n, plane.h.value);
        let flux = match &self.curved.wall {
            Wall::Cylinder { .. } if n == self.xi => 0.0,
            Wall::Cylinder { .. } => {
                let along = usize::from(others(n)[0] != self.xi);
                moments.first[along] * (self.curved.axis[n] / self.curved.axis[self.xi])
            }
            Wall::Cone { .. } => moments.area * h / 3.0,
            // In a plane through the centre the field has no normal component.
            Wall::Ball { .. } | Wall::Ellipsoid(_) if h == 0.0 => 0.0,
            Wall::Ball { .. } | Wall::Ellipsoid(_) => {
                let angle = self.solid_angle(plane, &region, &rectangle);
                (moments.area * h - angle.copysign(h)) / 3.0
            }
        };
        let shadow = match &self.curved.wall {
            Wall::Cone { slope } => {
                let over = PlaneOverApex { curved: &self.curved, slope: *slope, n, h };
                over.shadow(&plane.section, &region, &rectangle).copysign(h) / 3.0
            }
            _ => 0.0,
        };
        FaceFlux { area: moments.area, flux, shadow, whole: matches!(region, Region::Whole) }
    }

    /// Solid angle of a region seen from the centre, where the ball is the unit ball, times the volume's scale.
    #[inline]
    fn solid_angle(&self, plane: &Plane, region: &Region, rectangle: &Rectangle) -> f64 {
        let n = plane.n;
        let [u, v] = others(n);
        let h = plane.h.value;
        let (du, dv) = (rectangle.u[1] - rectangle.u[0], rectangle.v[1] - rectangle.v[0]);
        let place = |p: [f64; 2], height: f64| {
            let mut q = [0.0; 3];
            (q[n], q[u], q[v]) = (height, p[0], p[1]);
            q
        };
        match &self.curved.wall {
            Wall::Ball { radius } => {
                let scale = 1.0 / radius;
                let square = difference_of_squares(*radius, plane.h) * scale * scale;
                let normal = self.normal_of_ball(n);
                let to_unit = |p, height| place(p, height).map(|x| x * scale);
                let far = is_far((du + dv) * scale, to_unit(rectangle.middle(), h));
                let ends = plane.lines.map(|line| line.map_or(0.0, |line| line.aside() * scale));
                let (height, foot, area) = (h * scale, [0.0; 2], scale * scale);
                let plane_of_ball =
                    PlaneOfUnitBall { map: to_unit, at: h, normal, height, square, far, foot, area, ends };
                plane_of_ball.solid_angle(&plane.section, region, rectangle) * radius * radius * radius
            }
            Wall::Ellipsoid(map) => {
                let reach = map.reach[n];
                let square = difference_of_squares(reach, plane.h) / (reach * reach);
                let normal = self.normal_of_ball(n);
                let [columns_u, columns_v] = [u, v].map(|m| map.form[m][m]);
                let to_unit = |p, height| map.map(place(p, height));
                let size = Real::sqrt(columns_u * du * du + columns_v * dv * dv);
                let (far, ends) = (is_far(size, to_unit(rectangle.middle(), h)), [0.0; 2]);
                let (height, outermost) = (h / reach, map.outermost[n]);
                let foot = [outermost[u] * h, outermost[v] * h];
                // The section through the centre becomes a unit circle.
                let area = reach / map.scale;
                let plane_of_ball =
                    PlaneOfUnitBall { map: to_unit, at: h, normal, height, square, far, foot, area, ends };
                plane_of_ball.solid_angle(&plane.section, region, rectangle) * map.scale
            }
            Wall::Cylinder { .. } | Wall::Cone { .. } => 0.0,
        }
    }

    /// Volume in a cell between planes, from the fluxes through its faces: low and high along each axis.
    pub fn volume(&self, sides: &Sides, faces: &[[FaceFlux; 2]; 3]) -> f64 {
        let through = |n: usize| faces[n][1].flux - faces[n][0].flux;
        let fluxes = through(0) + through(1) + through(2);
        let width = |n: usize| sides[n][1].h.value - sides[n][0].h.value;
        match &self.curved.wall {
            Wall::Cylinder { .. } => {
                let along = width(self.xi) * 0.5 * (faces[self.xi][0].area + faces[self.xi][1].area);
                along + fluxes + self.flux_through_ends(sides)
            }
            Wall::Cone { .. } => {
                let reference = self.height_of_middle(sides);
                let cube = reference * reference * reference;
                let shadow = |n: usize| faces[n][1].shadow - faces[n][0].shadow;
                let shadows = if reference > 0.0 { cube * (shadow(0) + shadow(1) + shadow(2)) } else { 0.0 };
                fluxes - shadows + self.flux_through_ends(sides)
            }
            Wall::Ball { radius } => fluxes + radius * radius * radius * self.angle_at_center(sides) / 3.0,
            Wall::Ellipsoid(map) => fluxes + map.scale * self.angle_at_center(sides) / 3.0,
        }
    }

    /// How high the middle of a cell lies over a cone's apex; 0 near the apex, where p/3 is small itself.
    fn height_of_middle(&self, sides: &Sides) -> f64 {
        let (mut height, mut size) = (0.0, 0.0);
        for (n, [low, high]) in sides.iter().enumerate() {
            height += (low.h.value + high.h.value) * 0.5 * self.curved.axis[n];
            size += high.h.value - low.h.value;
        }
        if height > size * 4.0 { height } else { 0.0 }
    }

    /// Flux of the field through what a cell has of the flat ends.
    fn flux_through_ends(&self, sides: &Sides) -> f64 {
        let [u, v] = others(self.xi);
        let mut flux = 0.0;
        for (number, end) in self.ends.iter().enumerate() {
            let Some(end) = end else { continue };
            let reach = |n: usize| end.radius * self.curved.across[n] * (1.0 + MARGIN) + end.shift[n].abs() * MARGIN;
            let near = |n: usize| {
                sides[n][0].h.value <= end.shift[n] + reach(n) && sides[n][1].h.value >= end.shift[n] - reach(n)
            };
            let [Some(low), Some(high)] = sides[self.xi].map(|side| side.lines[number]) else { continue };
            if !(near(0) && near(1) && near(2)) {
                continue;
            }
            let rectangle = Rectangle { u: sides[u].map(|p| p.h.value), v: sides[v].map(|p| p.h.value) };
            let disc = end.projected(self.xi, &rectangle, [&low, &high]);
            if disc.area == 0.0 {
                continue;
            }
            let (inward, middle) = (end.inward[self.xi], rectangle.middle());
            if let Wall::Cone { .. } = self.curved.wall {
                let height = (0..3).map(|n| end.shift[n] * end.inward[n]).sum::<f64>();
                let ratio = self.height_of_middle(sides) / height;
                flux -= height / 3.0 * (1.0 + ratio * ratio * ratio) * disc.area / inward.abs();
                continue;
            }
            // Height of the end's plane above the cell's middle, over the middle of the rectangle and by its slope.
            let slope = [u, v].map(|n| -end.inward[n] / inward);
            let at_middle = end.shift[self.xi] - (sides[self.xi][0].h.value + sides[self.xi][1].h.value) * 0.5
                + slope[0] * (middle[0] - end.shift[u])
                + slope[1] * (middle[1] - end.shift[v]);
            let moment = at_middle * disc.area + slope[0] * disc.first[0] + slope[1] * disc.first[1];
            flux -= moment * inward / (inward.abs() * inward.abs() * inward.abs());
        }
        flux
    }

    /// The solid angle that the part of a cell between the ends takes up at the centre, which may lie on its sides or corners.
    fn angle_at_center(&self, sides: &Sides) -> f64 {
        let mut normals = heapless::Vec::<[f64; 3], 3>::new();
        for n in 0..3 {
            let (low, high) = (sides[n][0].h.value, sides[n][1].h.value);
            if !(low <= 0.0 && high >= 0.0) {
                return 0.0;
            }
            if low == 0.0 || high == 0.0 {
                let _ = normals.push(self.normal_of_ball(n).map(|x| if low == 0.0 { x } else { -x }));
            }
        }
        match self.ends[0] {
            Some(end) => angle_of_half_space(&normals, end.inward),
            None => angle_of_cone(&normals),
        }
    }

    /// Normal to the planes across axis `n`, where the ball is the unit ball.
    fn normal_of_ball(&self, n: usize) -> [f64; 3] {
        match &self.curved.wall {
            Wall::Ellipsoid(map) => map.map(map.outermost[n]).map(|x| x * map.reach[n]),
            _ => {
                let mut normal = [0.0; 3];
                normal[n] = 1.0;
                normal
            }
        }
    }
}

/// Solid angle of what lies before up to three planes through the centre, by their normals.
fn angle_of_cone(normals: &[[f64; 3]]) -> f64 {
    let dihedral = |a: &[f64; 3], b: &[f64; 3]| {
        let product = |u: usize, v: usize| a[u] * b[v] - a[v] * b[u];
        let sine = hypotenuse(hypotenuse(product(1, 2), product(2, 0)), product(0, 1));
        PI - libm::atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2])
    };
    match normals {
        [] => 4.0 * PI,
        [_] => 2.0 * PI,
        [a, b] => 2.0 * dihedral(a, b),
        [a, b, c, ..] => dihedral(a, b) + dihedral(b, c) + dihedral(c, a) - PI,
    }
}

/// Below this size, in radii, a face farther from the centre than that is taken as far away from it.
const FAR: f64 = 0.25;

fn is_far(size: f64, middle: [f64; 3]) -> bool {
    size < FAR && middle.iter().map(|x| x * x).sum::<f64>() > size * size
}

/// What may have been lost by rounding in the place of an end.
const MARGIN: f64 = 1e-12;

/// The solid angle of what is in front of some coordinate planes through a point, and of another plane.
fn angle_of_half_space(normals: &[[f64; 3]], inward: [f64; 3]) -> f64 {
    let cosine =
        |normal: &[f64; 3]| (normal[0] * inward[0] + normal[1] * inward[1] + normal[2] * inward[2]).clamp(-1.0, 1.0);
    // The angle between two sides whose inner normals have this product.
    let dihedral = |cosine: f64| PI - libm::acos(cosine);
    match normals {
        [] => 2.0 * PI,
        [one] => 2.0 * dihedral(cosine(one)),
        [one, other] => PI * 0.5 + dihedral(cosine(one)) + dihedral(cosine(other)) - PI,
        all => {
            let cosines = [0, 1, 2].map(|n| all.get(n).map_or(1.0, cosine));
            // A corner of the octant beyond the plane is cut off, and a corner alone before it is left.
            let corner = |n: usize, sign: f64| {
                let [u, v] = others(n);
                (PI * 0.5 + dihedral(sign * cosines[u]) + dihedral(sign * cosines[v]) - PI).max(0.0)
            };
            let behind = cosines.iter().filter(|&&c| c < 0.0).count();
            let place = |wanted: bool| cosines.iter().position(|&c| (c < 0.0) == wanted).unwrap_or(0);
            match behind {
                0 => PI * 0.5,
                1 => PI * 0.5 - corner(place(true), -1.0),
                2 => corner(place(false), 1.0),
                _ => 0.0,
            }
        }
    }
}
