//! A case as the interface gives it, checked.

use crate::grid::checked;
use crate::input::{Arrays, all};
use crate::status::{Answer, Status};
use crate::types::{self, Case};
use core::ffi::CStr;
use core::ops::Deref;
use voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Riemann, Scheme, Treatment};
use voidage_core::grid::Grid;
use voidage_core::number::real::Real;

/// Axes that flow: those of more than one cell, or x if there are none.
#[derive(Clone, Copy)]
pub struct Live {
    axes: [usize; 3],
    count: usize,
}

impl Live {
    fn of<R: Real>(grid: &Grid<R>) -> Self {
        let (mut axes, mut count) = ([0; 3], 0);
        for (axis, _) in grid.cells().into_iter().enumerate().filter(|&(_, cells)| cells > 1) {
            axes[count] = axis;
            count += 1;
        }
        Live { axes, count: count.max(1) }
    }
}

impl Deref for Live {
    type Target = [usize];
    fn deref(&self) -> &[usize] {
        self.axes.get(..self.count).unwrap_or_default()
    }
}

/// A case whose numbers make sense; its sides are looked at when it is known how many axes flow.
pub struct Checked<'a, R> {
    pub grid: Grid<'a, R>,
    pub live: Live,
    pub gas: Gas<R>,
    pub scheme: Scheme,
    pub gravity: [R; 3],
    pub side: [types::Boundary<R>; 6],
    pub jump: R,
    /// Open fractions of cells, and of x, y and z faces; those of dead axes are empty.
    pub beta: Option<[&'a [R]; 4]>,
    /// Quadratic and linear drag along x, y, z; empty where there is none.
    pub drag: [[&'a [R]; 3]; 2],
}

impl<'a, R: Real> Checked<'a, R> {
    /// # Safety
    /// As of [`Arrays::read`].
    pub unsafe fn new(arrays: &mut Arrays, case: &Case<R>) -> Answer<Self> {
        let grid = unsafe { checked(arrays, &case.grid)? };
        let live = Live::of(&grid);
        if grid.cell_count() >= 1 << 31 {
            return Err(Status::TooMany.of(c"case.grid"));
        }
        all(&case.gravity, Real::is_finite, c"case.gravity")?;
        all(&[case.jump], |jump| jump >= R::ZERO, c"case.jump")?;
        let jump = if case.jump > R::ZERO { case.jump } else { Treatment::default().jump };
        let (beta, drag) = unsafe { (fractions(arrays, case, &grid, live)?, drag(arrays, case, &grid)?) };
        let (gas, scheme, gravity) = (gas(case)?, scheme(case)?, case.gravity);
        Ok(Checked { grid, live, gas, scheme, gravity, side: case.side, jump, beta, drag })
    }
}

/// Open fractions, if there are any.
unsafe fn fractions<'a, R: Real>(
    arrays: &mut Arrays,
    case: &Case<R>,
    grid: &Grid<R>,
    live: Live,
) -> Answer<Option<[&'a [R]; 4]>> {
    if case.beta_v.is_null() {
        return Ok(None);
    }
    let fraction = |b: R| b >= R::ZERO && b <= R::ONE;
    let mut beta: [&[R]; 4] = [&[]; 4];
    beta[0] = unsafe { arrays.read(case.beta_v, grid.cell_count(), c"case.beta_v")? };
    all(beta[0], fraction, c"case.beta_v")?;
    for &axis in &*live {
        let count = grid.face_shape(axis).into_iter().product();
        let faces = unsafe { arrays.read(case.beta[axis], count, c"case.beta") };
        beta[axis + 1] = faces.map_err(|refusal| refusal.axis(axis))?;
        all(beta[axis + 1], fraction, c"case.beta").map_err(|refusal| refusal.axis(axis))?;
    }
    Ok(Some(beta))
}

/// Drag of the axes that have one.
unsafe fn drag<'a, R: Real>(arrays: &mut Arrays, case: &Case<R>, grid: &Grid<R>) -> Answer<[[&'a [R]; 3]; 2]> {
    let mut drag: [[&[R]; 3]; 2] = [[&[]; 3]; 2];
    let given = [(case.cr, c"case.cr"), (case.linear, c"case.linear")];
    for (kind, (first, name)) in drag.iter_mut().zip(given) {
        for (axis, (along, first)) in kind.iter_mut().zip(first).enumerate().filter(|(_, (_, f))| !f.is_null()) {
            let read = unsafe { arrays.read(first, grid.cell_count(), name) };
            *along = read.map_err(|refusal| refusal.axis(axis))?;
            all(along, |c| c >= R::ZERO && c.is_finite(), name).map_err(|refusal| refusal.axis(axis))?;
        }
    }
    Ok(drag)
}

fn gas<R: Real>(case: &Case<R>) -> Answer<Gas<R>> {
    let Case { gamma, sound_speed, rho0: density, p0: pressure, .. } = *case;
    let above = |least: R, value: R, name| all(&[value], |v| v > least && v.is_finite(), name);
    Ok(match case.gas {
        0 => {
            above(R::ONE, gamma, c"case.gamma")?;
            Gas::Ideal { gamma }
        }
        1 => {
            above(R::ZERO, sound_speed, c"case.sound_speed")?;
            Gas::Isothermal { sound_speed }
        }
        2 => {
            above(R::ONE, gamma, c"case.gamma")?;
            above(R::ZERO, density, c"case.rho0")?;
            above(R::ZERO, pressure, c"case.p0")?;
            Gas::Isentropic { gamma, density, pressure }
        }
        _ => return Err(Status::Kind.of(c"case.gas")),
    })
}

/// The entry of a list by its number.
fn choose<T: Copy>(number: i32, list: &[T], name: &'static CStr) -> Answer<T> {
    let found = usize::try_from(number).ok().and_then(|n| list.get(n).copied());
    found.ok_or(Status::Kind.of(name))
}

fn scheme<R>(case: &Case<R>) -> Answer<Scheme> {
    let solvers = [Riemann::Hllc, Riemann::Hlle, Riemann::Rusanov, Riemann::HllcLowMach];
    let limiters = [
        Limiter::Steep,
        Limiter::MonotonizedCentral,
        Limiter::VanLeer,
        Limiter::Minmod,
        Limiter::Unlimited,
        Limiter::FirstOrder,
        Limiter::AroraRoe,
    ];
    let forms = [PressureForm::Geometric, PressureForm::Paper];
    Ok(Scheme {
        riemann: choose(case.riemann, &solvers, c"case.riemann")?,
        limiter: choose(case.limiter, &limiters, c"case.limiter")?,
        pressure: choose(case.pressure, &forms, c"case.pressure")?,
    })
}

/// The low or high side of an axis, and the time in which its pressure follows the flow: 0 if the side does not say, infinite for an inlet faster than its
/// own sound, whose pressure no wave from inside can change.
pub fn boundary<R: Real, const D: usize>(
    side: &types::Boundary<R>,
    axis: usize,
    gas: Gas<R>,
    live: [usize; D],
) -> Answer<(Boundary<R, D>, R)> {
    let positive = |v: R| v > R::ZERO && v.is_finite();
    let wrong = |good: bool, name| if good { Ok(()) } else { Err(Status::Value.of(name)) };
    let density = || wrong(positive(side.rho), c"side.rho");
    let pressure = || wrong(positive(side.p), c"side.p");
    let state = || -> Answer<Primitive<R, D>> {
        density()?;
        all(&side.u, Real::is_finite, c"side.u")?;
        let velocity = live.map(|axis| side.u.get(axis).copied().unwrap_or(R::ZERO));
        if gas.has_energy() {
            pressure()?;
            return Ok(Primitive { density: side.rho, velocity, pressure: side.p });
        }
        Ok(Primitive { density: side.rho, velocity, pressure: gas.pressure(side.rho, R::ZERO) })
    };
    let found = match side.kind {
        0 => Boundary::Wall,
        1 => Boundary::Periodic,
        2 => Boundary::ZeroGradient,
        3 => Boundary::FarField(state()?),
        4 => {
            wrong(side.relax >= R::ZERO && side.relax.is_finite(), c"side.relax")?;
            Boundary::Inlet(state()?)
        }
        5 => {
            pressure()?;
            Boundary::Outlet { pressure: side.p }
        }
        6 => {
            let rest = state()?;
            Boundary::Reservoir { density: rest.density, pressure: rest.pressure }
        }
        _ => return Err(Status::Kind.of(c"side.kind")),
    };
    let relax = match &found {
        Boundary::Inlet(w) if side.u.get(axis).is_some_and(|u| u.abs() > gas.sound_speed(w)) => R::INFINITY,
        Boundary::Inlet(_) => side.relax,
        _ => R::ZERO,
    };
    Ok((found, relax))
}
