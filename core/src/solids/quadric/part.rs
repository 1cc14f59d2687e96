//! One curved surface between flat ends: its sections with grid planes and its share of a cell.
//!
//! The volume in a cell is the flux through the cell's faces and the part's flat ends of a field of divergence 1 that is tangent to the
//! curved surface: of a cylinder (ξ − ξₘ) a / a_ξ with ξ the coordinate along which the axis `a` is longest and ξₘ the cell's middle; of cones
//! see [`super::cone`], of balls and ellipsoids [`super::solid_angle`]. Of half balls in cells that the whole ball holds, (ξ − ξₘ) along ξ will do, and
//! however large the ball is, no digit is lost.

use super::arc::Moments;
use super::cone::{PlaneOfCone, Reference, along_axis};
use super::end_line::EndLine;
use super::ends::End;
use super::outline::{Pieces, Rectangle, Region, Section};
use super::solid_angle::PlaneOfUnitBall;
use super::twofold::{Twofold, difference, difference_of_squares};
use super::wall::{Curved, Span, Wall, hypotenuse};
use crate::number::axis::Axis;
use crate::number::real::Real;
use core::f64::consts::PI;

/// A convex part of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    pub origin: [f64; 3],
    pub curved: Curved,
    pub ends: [Option<End>; 2],
    /// The axis along which `Curved::axis` is longest.
    pub xi: Axis,
}

/// A grid plane as a part sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    n: Axis,
    /// Its coordinate, and the same from the part's origin.
    coordinate: f64,
    pub h: Twofold,
    section: Section,
    lines: [Option<EndLine>; 2],
}

/// What a part has of a face: area, and flux of its field along the axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceFlux {
    pub area: f64,
    /// Of a cone, of the field that vanishes at the height of the face's middle.
    pub flux: f64,
    pub whole: bool,
}

/// Flat ends of a part.
pub(super) type Ends<'a> = [Option<&'a End>; 2];

/// The planes on both sides of a cell along each axis.
pub(super) type Sides<'a> = [[&'a Plane; 2]; 3];

impl Part {
    pub fn new(origin: [f64; 3], curved: Curved, ends: [Option<End>; 2]) -> Self {
        let [x, y, z] = curved.axis.map(f64::abs);
        let xi = if x >= y && x >= z {
            Axis::X
        } else if y >= z {
            Axis::Y
        } else {
            Axis::Z
        };
        Part { origin, curved, ends, xi }
    }

    /// Its centre and radius, if it is a whole ball.
    pub fn ball(&self) -> Option<([f64; 3], f64)> {
        match (&self.curved.wall, &self.ends) {
            (&Wall::Ball { radius }, [None, None]) => Some((self.origin, radius)),
            _ => None,
        }
    }

    /// All of its ends.
    fn all_ends(&self) -> Ends<'_> {
        let [one, other] = &self.ends;
        [one.as_ref(), other.as_ref()]
    }

    /// Its ends; of a pipe without those that are far from a box: all of it is on their inner sides.
    pub fn ends_near(&self, place: [[f64; 2]; 3]) -> Ends<'_> {
        let [one, other] = self.all_ends();
        if !matches!(self.curved.wall, Wall::Cylinder { .. }) {
            return [one, other];
        }
        let is_near = |end: &&End| {
            let (mut least, mut size) = (0.0, 0.0);
            for n in Axis::ALL {
                let [low, high] = place[n].map(|x| end.inward[n] * (x - end.center[n]));
                (least, size) = (least + low.min(high), size + low.abs() + high.abs());
            }
            !(least > FAR_END * size)
        };
        [one.filter(is_near), other.filter(is_near)]
    }

    /// A plane across axis `n`.
    pub fn plane(&self, n: Axis, coordinate: f64) -> Plane {
        self.plane_with(self.all_ends(), n, coordinate)
    }

    /// The same where only some of its ends matter.
    #[inline]
    pub fn plane_with(&self, [low, high]: Ends, n: Axis, coordinate: f64) -> Plane {
        let h = difference(coordinate, self.origin[n]);
        let section = Section { conic: self.curved.conic(n, h), ellipse: self.curved.ellipse(n, h) };
        // Written out: `map` of an array of these is not inlined.
        let line = |end: Option<&End>| end.map(|end| end.line(n, coordinate));
        Plane { n, coordinate, h, section, lines: [line(low), line(high)] }
    }

    /// What the line where two planes meet has inside the curved surface; it runs along axis `m`, the planes in the order of [`Axis::others`].
    #[inline]
    pub fn span(&self, m: Axis, planes: [&Plane; 2]) -> Span {
        self.curved.span(m, planes.map(|p| p.h))
    }

    /// Area and flux of a face, `spans` those of its sides in the order of [`Rectangle::corners`].
    #[inline(always)]
    pub fn face(&self, plane: &Plane, rectangle: &Rectangle, spans: &[Span; 4]) -> FaceFlux {
        if plane.section.misses(rectangle, spans) {
            return FaceFlux::default();
        }
        self.face_of(plane, rectangle, spans)
    }

    /// The same of a face that the curved surface may reach.
    fn face_of(&self, plane: &Plane, rectangle: &Rectangle, spans: &[Span; 4]) -> FaceFlux {
        let mut pieces = Pieces::new();
        let chord = |end: usize| self.ends.get(end)?.as_ref()?.chord(plane.n, plane.coordinate);
        let region = plane.section.region(rectangle, spans, (&plane.lines, chord), &mut pieces);
        if matches!(region, Region::Empty) {
            return FaceFlux::default();
        }
        let (n, h, whole) = (plane.n, plane.h.value, matches!(region, Region::Whole));
        if matches!(self.curved.wall, Wall::Cylinder { .. }) && n != self.xi {
            let moments = plane.section.moments(&region, rectangle);
            let along = usize::from(n.others()[0] != self.xi);
            let flux = moments.first[along] * (self.curved.axis[n] / self.curved.axis[self.xi]);
            return FaceFlux { area: moments.area, flux, whole };
        }
        let area = plane.section.area(&region, rectangle);
        let flux = match &self.curved.wall {
            Wall::Cylinder { .. } => 0.0,
            Wall::Cone { radius, slope } => {
                let plane_of = PlaneOfCone { curved: &self.curved, radius: *radius, slope: *slope, n, h };
                plane_of.flux(&plane.section, &region, rectangle)
            }
            // In a plane through the centre the field has no normal component.
            Wall::Ball { .. } | Wall::Ellipsoid(_) if h == 0.0 => 0.0,
            Wall::Ball { .. } | Wall::Ellipsoid(_) => {
                let angle = self.solid_angle(plane, &region, rectangle);
                (area * h - angle.copysign(h)) / 3.0
            }
        };
        FaceFlux { area, flux, whole }
    }

    /// Solid angle of a region seen from the centre, where the ball is the unit ball, times the volume's scale.
    #[inline]
    fn solid_angle(&self, plane: &Plane, region: &Region, rectangle: &Rectangle) -> f64 {
        let n = plane.n;
        let [u, v] = n.others();
        let h = plane.h.value;
        let (du, dv) = (rectangle.u[1] - rectangle.u[0], rectangle.v[1] - rectangle.v[0]);
        match &self.curved.wall {
            Wall::Ball { radius } => {
                let scale = 1.0 / radius;
                let square = difference_of_squares(*radius, plane.h) * scale * scale;
                // In the plane's own coordinates and its height: a turned ball is the same.
                let normal = [0.0, 0.0, 1.0];
                let to_unit = |p: [f64; 2], height: f64| [p[0] * scale, p[1] * scale, height * scale];
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
                let to_unit = |p: [f64; 2], height: f64| {
                    let mut q = [0.0; 3];
                    (q[n], q[u], q[v]) = (height, p[0], p[1]);
                    map.map(q)
                };
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

    /// Volume in a cell between planes, from the fluxes through its faces: low and high along each axis. Not a number where the faces contradict each
    /// other.
    pub fn volume(&self, sides: &Sides, faces: &[[FaceFlux; 2]; 3]) -> f64 {
        let widths = sides.map(|[low, high]| high.h.value - low.h.value);
        let size = widths[0] + widths[1] + widths[2];
        if widths.iter().any(|width| *width < THIN * size)
            && let Some(volume) = self.volume_of_slice(sides, faces)
        {
            return volume;
        }
        self.volume_by_fluxes(sides, faces, size)
    }

    /// The same of a cell that is thin along one axis, where the fluxes through its large faces all but cancel: by the areas beside these and of the section
    /// in its middle, if that is closer. The root of the area of a convex solid's section is concave along the axis (Brunn and Minkowski), so it is off what it
    /// is linearly between the three by less than its own second difference, and their mean by Simpson's rule is off by less than half that of the area.
    #[cold]
    fn volume_of_slice(&self, sides: &Sides, faces: &[[FaceFlux; 2]; 3]) -> Option<f64> {
        let widths = sides.map(|[low, high]| high.h.value - low.h.value);
        let thinner = |a: Axis, b: Axis| if widths[b] < widths[a] { b } else { a };
        let n = thinner(thinner(Axis::X, Axis::Y), Axis::Z);
        let [u, v] = n.others();
        let [z0, z1] = sides[n].map(|plane| plane.coordinate);
        // Beside the faces themselves, in which ends may lie.
        let [low, area, high] =
            [z0.next_up(), (z0 + z1) * 0.5, z1.next_down()].map(|z| self.area_across(n, z, [sides[u], sides[v]]));
        if low == 0.0 && area == 0.0 && high == 0.0 {
            // It begins beyond a face in which an end lies.
            return faces[n].iter().any(|face| face.area > 0.0).then_some(0.0);
        }
        if !(low > 0.0 && high > 0.0) {
            return None;
        }
        let bend = (low - 2.0 * area + high).abs() / (widths[u] * widths[v]);
        let rounding = f64::EPSILON * widths[u].max(widths[v]) / widths[n];
        (bend <= (ROUNDING * rounding).max(STRAIGHT)).then_some(widths[n] * (low + 4.0 * area + high) / 6.0)
    }

    /// Its area in the plane across axis `n` at a coordinate, between planes along the two axes after that one.
    fn area_across(&self, n: Axis, coordinate: f64, [[left, right], [front, back]]: [[&Plane; 2]; 2]) -> f64 {
        // With the ends that the planes around it have.
        let [one, other] = self.all_ends();
        let [has_one, has_other] = left.lines.each_ref().map(Option::is_some);
        let ends = [one.filter(|_| has_one), other.filter(|_| has_other)];
        let ([u, v], plane) = (n.others(), self.plane_with(ends, n, coordinate));
        let rectangle = Rectangle { u: [left, right].map(|p| p.h.value), v: [front, back].map(|p| p.h.value) };
        // Planes in the order of the axes after the line's.
        let u_line = |side: &Plane| self.span(u, [side, &plane]);
        let v_line = |side: &Plane| self.span(v, [&plane, side]);
        self.face(&plane, &rectangle, &[u_line(front), v_line(right), u_line(back), v_line(left)]).area
    }

    /// The same by the fluxes alone; `size` is the sum of the cell's widths.
    #[inline(always)]
    fn volume_by_fluxes(&self, sides: &Sides, faces: &[[FaceFlux; 2]; 3], size: f64) -> f64 {
        let through = |n: Axis| faces[n][1].flux - faces[n][0].flux;
        let fluxes = through(Axis::X) + through(Axis::Y) + through(Axis::Z);
        let width = |n: Axis| sides[n][1].h.value - sides[n][0].h.value;
        match &self.curved.wall {
            Wall::Cylinder { .. } => {
                let along = width(self.xi) * 0.5 * (faces[self.xi][0].area + faces[self.xi][1].area);
                let (flux, carried) = self.flux_through_ends(sides);
                let [x, y, z] = Axis::ALL.map(|n| self.curved.axis[n] * (faces[n][1].area - faces[n][0].area));
                // Along the axis nothing passes through the wall: what enters through faces and ends leaves through others.
                let closed = (x + y + z + carried).abs() <= CLOSED * (size * size);
                if closed { along + fluxes + flux } else { f64::NAN }
            }
            Wall::Cone { radius, slope } => self.volume_of_cone(*radius, *slope, sides, faces),
            Wall::Ball { radius } if self.ends[0].is_some() && ball_holds(*radius, sides) => {
                let along = width(self.xi) * 0.5 * (faces[self.xi][0].area + faces[self.xi][1].area);
                along + self.flux_along_through_ends(sides)
            }
            Wall::Ball { radius } => fluxes + radius * radius * radius * self.angle_at_center(sides) / 3.0,
            Wall::Ellipsoid(map) => fluxes + map.scale * self.angle_at_center(sides) / 3.0,
        }
    }

    /// The same of a cone; near its apex the field is (p − apex) / 3.
    fn volume_of_cone(&self, radius: f64, slope: f64, sides: &Sides, faces: &[[FaceFlux; 2]; 3]) -> f64 {
        let (mut height, mut size) = (0.0, 0.0);
        let middle = sides.map(|[low, high]| (low.h.value + high.h.value) * 0.5);
        for (n, [low, high]) in Axis::ALL.into_iter().zip(sides) {
            height += middle[n] * self.curved.axis[n];
            size += high.h.value - low.h.value;
        }
        let reference = Reference { height, radius: radius + slope * height };
        let far = reference.is_far(slope, size, 4.0);
        let mut volume = 0.0;
        for n in Axis::ALL {
            let [u, v] = n.others();
            let rectangle = Rectangle { u: sides[u].map(|p| p.h.value), v: sides[v].map(|p| p.h.value) };
            for ((face, plane), sign) in faces[n].iter().zip(sides[n]).zip([-1.0, 1.0]) {
                let h = plane.h.value;
                if face.area == 0.0 {
                    continue;
                }
                let plane_of = PlaneOfCone { curved: &self.curved, radius, slope, n, h };
                let flux = if far {
                    let shift = self.curved.axis[n] * (middle[n] - h);
                    plane_of.moved(face.flux, face.area, &plane_of.reference(&rectangle), &reference, shift)
                } else {
                    plane_of.of_apex(face.area)
                };
                volume += sign * flux;
            }
        }
        let ends = self.flux_through_ends_of_cone(-radius / slope, far.then_some((middle, reference)), sides);
        volume + ends
    }

    /// What a cell has of the flat ends, each seen along `xi` over the cell's rectangle.
    fn discs<'a>(&'a self, sides: &'a Sides) -> impl Iterator<Item = (&'a End, Rectangle, Moments)> {
        let [u, v] = self.xi.others();
        let rectangle = Rectangle { u: sides[u].map(|p| p.h.value), v: sides[v].map(|p| p.h.value) };
        // The planes across `xi` hold a line for each end.
        let [low, high] = sides[self.xi].map(|plane| plane.lines.iter());
        self.ends.iter().zip(low.zip(high)).filter_map(move |(end, (low, high))| {
            let (end, low, high) = (end.as_ref()?, low.as_ref()?, high.as_ref()?);
            let reach = |n: Axis| end.radius * self.curved.across[n] * (1.0 + MARGIN) + end.shift[n].abs() * MARGIN;
            let near = |n: Axis| {
                sides[n][0].h.value <= end.shift[n] + reach(n) && sides[n][1].h.value >= end.shift[n] - reach(n)
            };
            if !(near(Axis::X) && near(Axis::Y) && near(Axis::Z)) {
                return None;
            }
            let disc = end.projected(self.xi, &rectangle, [low, high]);
            (disc.area != 0.0).then_some((end, rectangle, disc))
        })
    }

    /// Flux of the field through what a cell has of the flat ends of a cylinder, and of the unit vector along the axis.
    fn flux_through_ends(&self, sides: &Sides) -> (f64, f64) {
        let (mut flux, mut carried) = (0.0, 0.0);
        let axis = self.curved.axis[self.xi];
        self.moments_of_ends(sides, |inward, moment, area| {
            flux -= moment * inward / (inward.abs() * inward.abs() * inward.abs());
            carried -= area / if axis * inward > 0.0 { inward.abs() } else { -inward.abs() };
        });
        (flux, carried)
    }

    /// Flux of (ξ − ξₘ) along ξ through what a cell has of the flat ends.
    fn flux_along_through_ends(&self, sides: &Sides) -> f64 {
        let mut flux = 0.0;
        self.moments_of_ends(sides, |inward, moment, _| flux -= if inward > 0.0 { moment } else { -moment });
        flux
    }

    /// Tells of each flat end in a cell what its inward normal has along ξ, the integral of ξ − ξₘ over the end as seen along ξ, and its area so.
    fn moments_of_ends(&self, sides: &Sides, mut tell: impl FnMut(f64, f64, f64)) {
        if sides[self.xi][0].lines.iter().all(Option::is_none) {
            return;
        }
        let [u, v] = self.xi.others();
        for (end, rectangle, disc) in self.discs(sides) {
            let (inward, middle) = (end.inward[self.xi], rectangle.middle());
            // Height of the end's plane above the cell's middle, over the middle of the rectangle and by its slope.
            let slope = [u, v].map(|n| -end.inward[n] / inward);
            let at_middle = end.shift[self.xi] - (sides[self.xi][0].h.value + sides[self.xi][1].h.value) * 0.5
                + slope[0] * (middle[0] - end.shift[u])
                + slope[1] * (middle[1] - end.shift[v]);
            tell(inward, at_middle * disc.area + slope[0] * disc.first[0] + slope[1] * disc.first[1], disc.area);
        }
    }

    /// The same of a cone whose field vanishes at the height of the cell's middle, or with none at its apex.
    fn flux_through_ends_of_cone(&self, apex: f64, middle: Option<([f64; 3], Reference)>, sides: &Sides) -> f64 {
        let axis = &self.curved.axis;
        let dot = |a: [f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let mut flux = 0.0;
        for (end, _, disc) in self.discs(sides) {
            let field = match &middle {
                Some((place, reference)) => {
                    let above = dot(Axis::ALL.map(|n| end.shift[n] - place[n]), axis);
                    along_axis(above, reference, end.radius)
                }
                None => (dot(end.shift, axis) - apex) / 3.0,
            };
            flux -= dot(end.inward, axis) * field * disc.area / end.inward[self.xi].abs();
        }
        flux
    }

    /// The solid angle that the part of a cell between the ends takes up at the centre, which may lie on its sides or corners.
    fn angle_at_center(&self, sides: &Sides) -> f64 {
        let mut normals = heapless::Vec::<[f64; 3], 3>::new();
        for n in Axis::ALL {
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
    fn normal_of_ball(&self, n: Axis) -> [f64; 3] {
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

/// What the line where two planes meet has between some ends too, by what it has inside the curved surface; arguments as those of [`Part::span`].
pub(super) fn span_between(ends: &Ends, m: Axis, planes: [&Plane; 2], span: Span) -> Span {
    let inside = |end: &&End| end.span(m, planes.map(|p| p.coordinate));
    ends.iter().flatten().map(inside).fold(span, Span::intersection)
}

/// By how much of the square of a cell's size a pipe in it may fail to close: rounding is far below, and a section more or less is beyond.
const CLOSED: f64 = 1e-9;

/// A cell is thin if its least width is less than this share of all three together.
const THIN: f64 = 1e-4;

/// By how many roundings of coordinates, in widths, fluxes through the large faces of a thin cell may be off.
const ROUNDING: f64 = 8.0;

/// Sections bend by so little of a face that the mean of three is as good as rounding.
const STRAIGHT: f64 = 1e-13;

/// Does a ball hold all of a cell?
fn ball_holds(radius: f64, sides: &Sides) -> bool {
    let far = sides.map(|[low, high]| low.h.value.abs().max(high.h.value.abs()));
    far[0] * far[0] + far[1] * far[1] + far[2] * far[2] <= radius * radius
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

/// A face counts as far from the centre if its size, in radii, is below this and its middle is farther from the centre than that size. Its solid angle
/// is then summed over triangles from one of its own points, else over triangles from the foot of the centre in its plane.
const FAR: f64 = 0.25;

fn is_far(size: f64, middle: [f64; 3]) -> bool {
    size < FAR && middle.iter().map(|x| x * x).sum::<f64>() > size * size
}

/// Share of the distances along the axes by which a box is to be off a flat end, against rounding.
const FAR_END: f64 = 1e-9;

/// Share of its radius and of its distance by which the reach of an end's disc is enlarged, against rounding of its place.
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
            let corner = |n: Axis, sign: f64| {
                let [u, v] = n.others();
                (PI * 0.5 + dihedral(sign * cosines[u]) + dihedral(sign * cosines[v]) - PI).max(0.0)
            };
            let behind = cosines.iter().filter(|&&c| c < 0.0).count();
            let place = |wanted: bool| Axis::ALL.into_iter().find(|&n| (cosines[n] < 0.0) == wanted).unwrap_or(Axis::X);
            match behind {
                0 => PI * 0.5,
                1 => PI * 0.5 - corner(place(true), -1.0),
                2 => corner(place(false), 1.0),
                _ => 0.0,
            }
        }
    }
}
