//! A part of a solid in a box, between planes: what its curved surface may bend away from a tangent plane is known exactly, as it is a quadric.

use super::ends::End;
use super::part::Part;
use super::solid::QuadricSolid;
use super::wall::Wall;
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::cell_range::RangeKind;
use crate::number::axis::Axis;
use crate::number::real::Real;
use crate::solids::enclosure::{BoxAround, Constraint, Enclosed, Enclosure};

/// Rounding of the sums below, a few units in the last place of their terms.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A quadratic form by its symmetric matrix: the diagonal, and what is beside it: `yz`, `zx`, `xy`.
struct Quadratic {
    squares: [f64; 3],
    products: [f64; 3],
}

/// Closed forms are off by no more than this, if none left 0 to 1 by more than a thousand times as much; and in boxes that are thin, or small beside
/// the solid, by so many roundings of what cancels there.
const CLOSED_FORM: f64 = 1e-12;
const CANCELLED: f64 = 64.0 * f64::EPSILON;

impl Enclosed for QuadricSolid {
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        self.parts().iter().for_each(|part| tell(part.enclosure(place)));
    }

    /// By the closed form.
    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        let mut sides = place.sides();
        let size = sides.iter().fold(0.0_f64, |most, [lo, hi]| most.max(hi - lo));
        let flat = sides.iter().position(|[lo, hi]| lo == hi);
        if let Some([lo, hi]) = flat.and_then(|axis| sides.get_mut(axis)) {
            // Of a face the cell above.
            *hi = *lo + size;
        }
        let kind = flat.map_or(RangeKind::Cells, RangeKind::Faces);
        let Ok(grid) = Grid::new(&sides[0], &sides[1], &sides[2]) else { return Bounds::UNKNOWN };
        let mut found = 0.0;
        let worst = self.layer(&grid, 0, flat.is_some(), &mut |told, at, share| {
            if told == kind && at == 0 {
                found += share;
            }
        });
        let widths = sides.map(|[lo, hi]| hi - lo);
        let error = self.parts().iter().fold(CLOSED_FORM, |sum, part| sum + part.cancelled(widths));
        if worst <= 1e3 * CLOSED_FORM && error < 1.0 {
            Bounds::around(f64::min(found, 1.0), error)
        } else {
            Bounds::UNKNOWN
        }
    }

    fn price(&self) -> f64 {
        1.0
    }
}

impl Part {
    /// What rounding may leave of what cancels in a box of such widths, as a share of it.
    pub(super) fn cancelled(&self, widths: [f64; 3]) -> f64 {
        let size = widths.iter().fold(0.0_f64, |most, width| most.max(*width));
        let thin = widths.iter().fold(1.0 / size, |product, width| product * (size / width));
        CANCELLED * (thin * (size + self.width()))
    }

    /// How far its surface is from its axis or middle at most; of an ellipsoid, whose map enlarges rounding, times its flatness.
    fn width(&self) -> f64 {
        match &self.curved.wall {
            Wall::Ball { radius } | Wall::Cylinder { radius } => *radius,
            Wall::Cone { radius, .. } => self.ends.iter().flatten().fold(*radius, |most, end| most.max(end.radius)),
            Wall::Ellipsoid(map) => {
                let reach = map.reach.iter().fold(0.0, |sum, x| sum + x * x);
                Real::sqrt(reach) * map.flatness()
            }
        }
    }

    /// What is known of it in a box.
    pub fn enclosure(&self, place: &BoxAround) -> Enclosure {
        let from = Axis::ALL.map(|n| place.middle[n] - self.origin[n]);
        let tip = matches!(self.curved.wall, Wall::Cone { .. }) && self.ends.iter().flatten().count() == 1;
        let ends = self.ends.iter().flatten().filter_map(|end| end.constraint(place));
        let tip = tip.then(|| self.before_tip(place, from));
        Enclosure::new([self.curved_constraint(place, from)].into_iter().chain(ends).chain(tip))
    }

    /// The curved surface: where a quadratic function is not positive. `from` leads from the part's origin to the middle of the box.
    fn curved_constraint(&self, place: &BoxAround, from: [f64; 3]) -> Constraint {
        let square = from[0] * from[0] + from[1] * from[1] + from[2] * from[2];
        let a = self.curved.axis;
        let along = a[0] * from[0] + a[1] * from[1] + a[2] * from[2];
        // The function in the middle, the sizes of its terms, half its gradient there, and half its second derivatives.
        let (middle, terms, gradient, second) = match &self.curved.wall {
            Wall::Ball { radius } => {
                let unit = Quadratic { squares: [1.0; 3], products: [0.0; 3] };
                (square - radius * radius, square + radius * radius, from, unit)
            }
            Wall::Cylinder { radius } => {
                let gradient = Axis::ALL.map(|n| from[n] - along * a[n]);
                let middle = square - along * along - radius * radius;
                (middle, 2.0 * square + radius * radius, gradient, Quadratic::about_axis(a, 1.0))
            }
            Wall::Cone { radius, slope } => {
                let wide = radius + slope * along;
                let gradient = Axis::ALL.map(|n| from[n] - (along + slope * wide) * a[n]);
                let terms = 2.0 * square + radius * radius + 2.0 * slope * slope * along * along + wide * wide;
                (square - along * along - wide * wide, terms, gradient, Quadratic::about_axis(a, 1.0 + slope * slope))
            }
            Wall::Ellipsoid(map) => {
                let gradient = map.form.map(|row| row[0] * from[0] + row[1] * from[1] + row[2] * from[2]);
                let value = gradient[0] * from[0] + gradient[1] * from[1] + gradient[2] * from[2];
                let size = Axis::ALL.into_iter().fold(1.0, |sum, n| sum + 3.0 * map.form[n][n] * from[n] * from[n]);
                let products = Axis::ALL.map(|n| {
                    let [u, v] = n.others();
                    map.form[u][v]
                });
                (value - 1.0, size, gradient, Quadratic { squares: Axis::ALL.map(|n| map.form[n][n]), products })
            }
        };
        let slope = Axis::ALL.map(|n| 2.0 * gradient[n] * place.half[n]);
        let shifted = 2.0 * gradient.iter().map(|g| g.abs()).sum::<f64>() * place.rounding();
        let rounding = ROUNDING * (terms + slope.iter().map(|s| s.abs()).sum::<f64>()) + shifted;
        let [low, high] = second.range(place.half);
        Constraint { middle, slope, rest: [low - rounding, high + rounding] }
    }

    /// Of a cone that ends in its tip, all on the side of the tip on which the cone is: the other half of the double cone is none of it.
    fn before_tip(&self, place: &BoxAround, from: [f64; 3]) -> Constraint {
        let Wall::Cone { radius, slope: growth } = self.curved.wall else {
            return Constraint { middle: -1.0, slope: [0.0; 3], rest: [0.0; 2] };
        };
        let a = self.curved.axis;
        let slope = Axis::ALL.map(|n| -growth * a[n] * place.half[n]);
        let terms = Axis::ALL.map(|n| -growth * a[n] * from[n]);
        let sizes = radius.abs() + terms.iter().chain(&slope).map(|t| t.abs()).sum::<f64>();
        let rounding = ROUNDING * sizes + growth.abs() * place.rounding();
        Constraint { middle: terms[0] + terms[1] + terms[2] - radius, slope, rest: [-rounding, rounding] }
    }
}

impl End {
    /// Beyond its plane; none if the box lies in that plane, and points of it belong to the solid.
    fn constraint(&self, place: &BoxAround) -> Option<Constraint> {
        let from = Axis::ALL.map(|n| place.middle[n] - self.center[n]);
        let side = Constraint::side_of_plane(place, self.inward, from, ROUNDING);
        side.or_else(|| (!self.closed).then(Constraint::nowhere))
    }
}

impl Quadratic {
    /// The square of the distance from an axis, for a factor of 1.
    fn about_axis(a: [f64; 3], factor: f64) -> Self {
        let squares = a.map(|x| 1.0 - factor * x * x);
        let products = Axis::ALL.map(|n| {
            let [u, v] = n.others();
            -factor * a[u] * a[v]
        });
        Quadratic { squares, products }
    }

    /// Bounds of the form in a box about 0, given by half of its size.
    fn range(&self, half: [f64; 3]) -> [f64; 2] {
        let mut range = [0.0_f64; 2];
        for n in Axis::ALL {
            let [u, v] = n.others();
            let square = self.squares[n] * half[n] * half[n];
            let product = 2.0 * (self.products[n] * half[u] * half[v]).abs();
            range = [range[0] + square.min(0.0) - product, range[1] + square.max(0.0) + product];
        }
        range
    }
}
