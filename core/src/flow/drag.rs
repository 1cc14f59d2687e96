//! Drag of the sub-grid obstacles, diagonal per cell, linear and quadratic.
//!
//! ```text
//! d(rho u_i)/dt = F_i − rho (a_i + ½ CR_i |u|) u_i
//! ```
//!
//! The obstacles rest, so drag does no work: lost kinetic energy stays in the cell as heat and the energy equation has no
//! term for it. One step is
//!
//! ```text
//! m' = (e^(−a dt) m + φ F) / (1 + ½ CR s φ),   φ = (1 − e^(−a dt))/a   (dt, if a = 0)
//! ```
//!
//! with s = |u| while the flow slows down and s = |u'| (implicit) while it speeds up. It is exact at any dt for decay
//! (F = 0) by linear drag alone, and by quadratic drag alone that is alike along all axes; else of first order. It keeps every steady
//! state (F = rho (a + ½ CR |u|) u) whatever the step, never turns the sign, and does not swing when a resting, nearly rigid cell is pushed.

use crate::flow::state::sum;
use crate::number::real::Real;

/// Drag coefficients of all cells; an empty slice stands for zero.
#[derive(Clone, Copy, Debug)]
pub struct Drag<'a, R, const D: usize> {
    /// CR of each axis, 1/length.
    pub quadratic: [&'a [R]; D],
    /// a of each axis, 1/time.
    pub linear: [&'a [R]; D],
}

impl<R: Real, const D: usize> Drag<'_, R, D> {
    /// The coefficients of one cell.
    #[inline(always)]
    pub fn at(&self, cell: usize) -> DragCell<R, D> {
        let read = |s: &[R]| s.get(cell).copied().unwrap_or(R::ZERO);
        DragCell { half_quadratic: self.quadratic.map(|s| R::HALF * read(s)), linear: self.linear.map(read) }
    }
}

/// Drag coefficients of one cell.
#[derive(Clone, Copy, Debug)]
pub struct DragCell<R, const D: usize> {
    /// ½ CR.
    pub half_quadratic: [R; D],
    /// a.
    pub linear: [R; D],
}

/// Steps of the search for the new speed under unequal coefficients; each at least halves the bracket.
const MAX_STEPS: usize = 60;

impl<R: Real, const D: usize> DragCell<R, D> {
    /// No drag at all.
    pub fn is_free(&self) -> bool {
        (0..D).all(|c| self.half_quadratic[c] == R::ZERO && self.linear[c] == R::ZERO)
    }

    /// Velocity after `dt`, from the velocity `u` before and the velocity `pushed` that the other forces alone would give.
    pub fn step(&self, u: [R; D], pushed: [R; D], dt: R) -> [R; D] {
        let mut free = [R::ZERO; D];
        let mut stiffness = [R::ZERO; D];
        for c in 0..D {
            let a = self.linear[c];
            // What is lost in a step as a share; none of no drag, and of one too small to tell.
            let loss = if a > R::ZERO { -(-(a * dt)).exp_m1() } else { R::ZERO };
            let (is_lost, push) = (loss > R::ZERO, pushed[c] - u[c]);
            // φ/dt of the push; decay alone where nothing pushes.
            let phi = if is_lost { loss / a } else { dt };
            free[c] = if is_lost { (-(a * dt)).exp() * u[c] + push * (phi / dt) } else { pushed[c] };
            stiffness[c] = self.half_quadratic[c] * phi;
        }
        let speed = |s: R| {
            let v: [R; D] = core::array::from_fn(|c| free[c] / (R::ONE + stiffness[c] * s));
            (v, norm(v))
        };
        let before = norm(u);
        let (v, after) = speed(before);
        if !(after > before) {
            return v;
        }
        // s = |v(s)|, the right side falling in s: between the speed before and the one just found.
        if (1..D).all(|c| stiffness[c] == stiffness[0]) {
            let q = norm(free);
            let root = (R::ONE + R::from_f64(4.0) * stiffness[0] * q).sqrt();
            return speed((q + q) / (R::ONE + root)).0;
        }
        let (mut low, mut high) = (before, after);
        for _ in 0..MAX_STEPS {
            let middle = R::HALF * (low + high);
            if !(middle > low && middle < high) {
                break;
            }
            if speed(middle).1 > middle { low = middle } else { high = middle }
        }
        speed(low).0
    }
}

/// Length of a vector, without overflow of the squares.
pub(crate) fn norm<R: Real, const D: usize>(v: [R; D]) -> R {
    let largest = v.iter().fold(R::ZERO, |m, x| R::larger(x.abs(), m));
    if D == 1 || !(largest > R::ZERO) {
        return largest;
    }
    largest * sum::<R, D>(v.map(|x| (x / largest) * (x / largest))).sqrt()
}
