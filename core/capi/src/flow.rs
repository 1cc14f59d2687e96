//! A flow in the caller's memory: the case that it is made of, its storage, and its steps.

mod case;
mod inlet;
mod state;
mod totals;

use crate::input::{Arrays, all, give, given};
use crate::memory::{Cut, Measure, Memory};
use crate::status::{Answer, Status};
use crate::types::{Boundary, Case, StepReport};
use case::Checked;
use core::mem::MaybeUninit;
use state::State;
use voidage_core::number::real::Real;

/// A flow. It lies in memory of the caller and is never freed; different threads may use different flows.
pub struct Flow<R: Real> {
    /// Tells a flow of this precision, at this address, from anything else.
    seal: u64,
    /// The block that it lies in.
    block: *mut u8,
    bytes: usize,
    /// The axes that flow.
    state: AnyState<R>,
}

/// A state by the number of axes that flow.
enum AnyState<R: Real> {
    One(State<R, 1>),
    Two(State<R, 2>),
    Three(State<R, 3>),
}

/// The same expression for each number of axes.
macro_rules! of_state {
    ($state:expr, $name:ident => $value:expr) => {
        match $state {
            AnyState::One($name) => $value,
            AnyState::Two($name) => $value,
            AnyState::Three($name) => $value,
        }
    };
}

/// What the seal of a flow must be.
fn seal<R: Real>(flow: *const Flow<R>) -> u64 {
    0x766f_6964_6167_6521 ^ (flow as usize as u64) ^ size_of::<R>() as u64
}

/// Measures or cuts the memory of a case, and makes the state.
fn make<'a, R: Real, M: Memory<'static>>(
    case: &Checked<'a, R>,
    memory: &mut M,
    cut: bool,
) -> Answer<Option<AnyState<R>>> {
    let axis = |a: usize| case.live.get(a).copied().unwrap_or(0);
    Ok(match case.live.len() {
        1 => State::new(case, [axis(0)], memory, cut)?.map(AnyState::One),
        2 => State::new(case, [axis(0), axis(1)], memory, cut)?.map(AnyState::Two),
        _ => State::new(case, [axis(0), axis(1), axis(2)], memory, cut)?.map(AnyState::Three),
    })
}

fn bytes_for<R: Real>(case: &Checked<R>) -> Answer<usize> {
    let mut measure = Measure::new();
    measure.take(1, |_| MaybeUninit::<Flow<R>>::uninit());
    make(case, &mut measure, false)?;
    Ok(measure.bytes())
}

/// Bytes of memory for a case.
///
/// # Safety
/// `case` is null or can be read, its arrays are as [`Arrays::read`] asks.
pub unsafe fn size<R: Real>(case: *const Case<R>) -> usize {
    let checked = unsafe { given(case, c"case").and_then(|case| Checked::new(&mut Arrays::new(), &case)) };
    checked.and_then(|case| bytes_for(&case)).unwrap_or(usize::MAX)
}

/// Makes a flow in `memory`.
///
/// # Safety
/// As of [`size`]; `memory` is a block of `bytes` that nothing else uses while the flow lives, `flow` is null or can be written.
pub unsafe fn init<R: Real>(case: *const Case<R>, memory: *mut u8, bytes: usize, flow: *mut *mut Flow<R>) -> Answer {
    if flow.is_null() {
        return Err(Status::Null.of(c"flow"));
    }
    unsafe {
        give(flow, core::ptr::null_mut());
        let mut arrays = Arrays::new();
        let case = Checked::new(&mut arrays, &given(case, c"case")?)?;
        let needed = bytes_for(&case)?;
        arrays.work(memory, bytes, needed)?;
        let mut cut = Cut::new(memory, needed);
        let [slot] = cut.take(1, |_| MaybeUninit::<Flow<R>>::uninit()) else {
            return Err(Status::Memory.of(c"memory"));
        };
        let Some(state) = make(&case, &mut cut, true)? else { return Err(Status::Memory.of(c"memory")) };
        let at = slot.as_mut_ptr();
        at.write(Flow { seal: seal(at), block: memory, bytes: needed, state });
        give(flow, at);
    }
    Ok(())
}

/// The flow behind a handle.
///
/// # Safety
/// `flow` is null, or points at memory in which nothing but a flow of [`init`] has been written; no other reference to it lives.
unsafe fn opened<'f, R: Real>(flow: *mut Flow<R>) -> Answer<&'f mut Flow<R>> {
    if flow.is_null() {
        return Err(Status::Null.of(c"flow"));
    }
    if !flow.is_aligned() || unsafe { (*flow).seal } != seal(flow) {
        return Err(Status::Handle.of(c"flow"));
    }
    Ok(unsafe { &mut *flow })
}

impl<R: Real> Flow<R> {
    /// Arrays of a call that may not overlap the flow.
    fn arrays(&self) -> Answer<Arrays> {
        let mut arrays = Arrays::new();
        arrays.work(self.block, self.bytes, self.bytes)?;
        Ok(arrays)
    }

    /// Where a single result goes may not lie in the flow. Called, not inlined: the list of arrays would lie in the frame of a step.
    #[inline(never)]
    fn spares<T>(&self, at: *mut T, name: &'static core::ffi::CStr) -> Answer {
        self.arrays()?.result(at, name)
    }

    fn cells(&self) -> usize {
        of_state!(&self.state, s => s.len())
    }
}

/// Density, velocity along x, y, z, and pressure of all cells.
#[derive(Clone, Copy)]
pub struct Primitives<P>(pub [P; 5]);

const NAMES: [&core::ffi::CStr; 5] = [c"rho", c"u", c"v", c"w", c"p"];

/// Sets all cells.
///
/// # Safety
/// As of [`opened`] and [`Arrays::read`].
pub unsafe fn set<R: Real>(flow: *mut Flow<R>, values: Primitives<*const R>) -> Answer {
    let flow = unsafe { opened(flow)? };
    let (mut arrays, cells) = (flow.arrays()?, flow.cells());
    let mut fields: [&[R]; 5] = [&[]; 5];
    let has_energy = of_state!(&flow.state, s => s.has_energy());
    for (n, ((field, first), name)) in fields.iter_mut().zip(values.0).zip(NAMES).enumerate() {
        let needed = n == 0 || n == 4 && has_energy;
        let wanted = n < 4 || has_energy;
        if needed || wanted && !first.is_null() {
            *field = unsafe { arrays.read(first, cells, name)? };
            let positive = |v: R| v.is_finite() && (!needed || v > R::ZERO);
            let status = if needed { Status::Unphysical } else { Status::Value };
            all(field, positive, name).map_err(|refusal| status.of(name).index(refusal.fault.index))?;
        }
    }
    of_state!(&mut flow.state, s => s.set(fields))
}

/// Tells all cells; arrays that are null are left out.
///
/// # Safety
/// As of [`opened`] and [`Arrays::write`].
pub unsafe fn get<R: Real>(flow: *const Flow<R>, values: Primitives<*mut R>) -> Answer {
    let flow = unsafe { opened(flow.cast_mut())? };
    let (mut arrays, cells) = (flow.arrays()?, flow.cells());
    let mut fields = [const { None }; 5];
    for ((field, first), name) in fields.iter_mut().zip(values.0).zip(NAMES) {
        if !first.is_null() {
            *field = Some(unsafe { arrays.write(first, cells, name)? });
        }
    }
    of_state!(&flow.state, s => s.get(fields));
    Ok(())
}

/// The largest signal rate.
///
/// # Safety
/// As of [`opened`]; `rate` is null or can be written.
pub unsafe fn rate<R: Real>(flow: *mut Flow<R>, rate: *mut R) -> Answer {
    let flow = unsafe { opened(flow)? };
    flow.spares(rate, c"rate")?;
    let found = of_state!(&mut flow.state, s => s.rate()?);
    unsafe { give(rate, found) };
    Ok(())
}

/// One step.
///
/// # Safety
/// As of [`opened`]; `report` is null or can be written.
pub unsafe fn step<R: Real>(flow: *mut Flow<R>, dt: R, report: *mut StepReport<R>) -> Answer {
    let flow = unsafe { opened(flow)? };
    flow.spares(report, c"report")?;
    all(&[dt], |dt| dt > R::ZERO && dt.is_finite(), c"dt")?;
    let mut found = StepReport::default();
    of_state!(&mut flow.state, s => s.step(dt, &mut found)?);
    unsafe { give(report, found) };
    Ok(())
}

/// Stable steps until a time, or until so many have been done.
///
/// # Safety
/// As of [`step`].
pub unsafe fn advance<R: Real>(
    flow: *mut Flow<R>,
    end: R,
    cfl: R,
    max_steps: u64,
    report: *mut StepReport<R>,
) -> Answer {
    let flow = unsafe { opened(flow)? };
    flow.spares(report, c"report")?;
    all(&[end], Real::is_finite, c"end")?;
    all(&[cfl], |cfl| cfl > R::ZERO && cfl <= R::ONE, c"cfl")?;
    let (found, answer) = of_state!(&mut flow.state, s => s.advance(end, cfl, max_steps));
    unsafe { give(report, found) };
    answer
}

/// Mass, momentum along x, y, z and energy in the domain.
///
/// # Safety
/// As of [`opened`]; `totals` is null or five numbers can be written there.
pub unsafe fn totals<R: Real>(flow: *const Flow<R>, totals: *mut R) -> Answer {
    let flow = unsafe { opened(flow.cast_mut())? };
    if totals.is_null() {
        return Err(Status::Null.of(c"totals"));
    }
    flow.spares(totals.cast::<[R; 5]>(), c"totals")?;
    let found = of_state!(&flow.state, s => s.totals());
    unsafe { give(totals.cast::<[R; 5]>(), found) };
    Ok(())
}

/// Changes a side.
///
/// # Safety
/// As of [`opened`]; `side` is null or can be read.
pub unsafe fn set_side<R: Real>(flow: *mut Flow<R>, number: i32, side: *const Boundary<R>) -> Answer {
    let flow = unsafe { opened(flow)? };
    let side = unsafe { given(side, c"side")? };
    let number = usize::try_from(number).ok().filter(|&n| n < 6).ok_or(Status::Range.of(c"number"))?;
    of_state!(&mut flow.state, s => s.set_side(number, &side))
}
