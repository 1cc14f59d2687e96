//! A flow in memory of its own.

use crate::failure;
use core::ptr::{null, null_mut};
use numpy::npyffi::NPY_ORDER;
use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray3};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use voidage_capi::double;
use voidage_capi::types::{Boundary, Case, Grid, StepReport};

/// Kind, density, velocity, pressure and time of relaxation of a side.
type Side = (i32, f64, [f64; 3], f64, f64);

/// Number of the gas; gamma, speed of sound, density and pressure of reference.
type GasNumbers = (i32, [f64; 4]);

/// A field of cells or faces, x fastest in memory.
type Field<'py> = Option<PyReadonlyArray3<'py, f64>>;

/// A flow of gas through porous space.
#[pyclass]
pub struct Flow {
    handle: *mut voidage_capi::Flow<f64>,
    shape: [usize; 3],
    /// The flow lies here; the block does not move while it lives.
    _block: Vec<u8>,
}

// The block is the flow's own, and a call has it to itself.
unsafe impl Send for Flow {}
unsafe impl Sync for Flow {}

/// The numbers of a field of a shape, which lie in memory as they are.
fn numbers(field: &Field<'_>, shape: [usize; 3], name: &str) -> PyResult<*const f64> {
    let Some(field) = field else { return Ok(null()) };
    let array = field.as_array();
    if array.shape() != shape {
        return Err(PyValueError::new_err(format!("{name} has the shape {:?}, not {shape:?}", array.shape())));
    }
    if !array.t().is_standard_layout() {
        return Err(PyValueError::new_err(format!("{name} is not in Fortran order")));
    }
    Ok(array.as_ptr())
}

#[pymethods]
impl Flow {
    #[new]
    fn new(
        edges: [PyReadonlyArray1<'_, f64>; 3],
        gas: GasNumbers,
        sides: [Side; 6],
        beta: [Field<'_>; 4],
        drag: [[Field<'_>; 3]; 2],
        forces: ([f64; 3], f64),
        scheme: [i32; 3],
    ) -> PyResult<Self> {
        let [x, y, z] = edges.each_ref().map(|list| list.as_array().to_vec());
        let shape = [&x, &y, &z].map(|list| list.len().saturating_sub(1));
        let [nx, ny, nz] = shape;
        let faces = |axis: usize| [0, 1, 2].map(|a| shape[a] + usize::from(a == axis));
        let mut case: Case<f64> = unsafe { core::mem::zeroed() };
        case.grid = Grid { x: x.as_ptr(), y: y.as_ptr(), z: z.as_ptr(), nx, ny, nz };
        case.gas = gas.0;
        [case.gamma, case.sound_speed, case.rho0, case.p0] = gas.1;
        case.side = sides.map(|(kind, rho, u, p, relax)| Boundary { kind, rho, u, p, relax });
        case.beta_v = numbers(&beta[0], shape, "beta_v")?;
        for axis in 0..3 {
            case.beta[axis] = numbers(&beta[axis + 1], faces(axis), ["beta_x", "beta_y", "beta_z"][axis])?;
            case.cr[axis] = numbers(&drag[0][axis], shape, "cr")?;
            case.linear[axis] = numbers(&drag[1][axis], shape, "linear")?;
        }
        (case.gravity, case.jump) = forces;
        [case.riemann, case.limiter, case.pressure] = scheme;
        Self::of(&case, shape)
    }

    /// Sets all cells.
    fn set(&mut self, state: [Field<'_>; 5]) -> PyResult<()> {
        let names = ["rho", "u", "v", "w", "p"];
        let mut fields = [null(); 5];
        for n in 0..5 {
            fields[n] = numbers(&state[n], self.shape, names[n])?;
        }
        let ([rho, u, v, w, p], mut fault) = (fields, failure::none());
        // The arrays have one entry a cell and live as long as `state`.
        let status = unsafe { double::vdg_flow_set(self.handle, rho, u, v, w, p, &mut fault) };
        failure::done(status, &fault)
    }

    /// Density, velocity along x, y, z, and pressure.
    fn get<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray3<f64>>>> {
        let mut fields: [Vec<f64>; 5] = core::array::from_fn(|_| vec![0.0; self.shape.iter().product()]);
        let ([rho, u, v, w, p], mut fault) = (fields.each_mut().map(|f| f.as_mut_ptr()), failure::none());
        // The vectors have one entry a cell.
        let status = unsafe { double::vdg_flow_get(self.handle, rho, u, v, w, p, &mut fault) };
        failure::done(status, &fault)?;
        // Numpy takes the vectors over as they are.
        let array = |field| PyArray1::from_vec(py, field).reshape_with_order(self.shape, NPY_ORDER::NPY_FORTRANORDER);
        fields.into_iter().map(array).collect()
    }

    /// The largest signal rate.
    fn rate(&mut self) -> PyResult<f64> {
        let (mut rate, mut fault) = (0.0, failure::none());
        let status = unsafe { double::vdg_flow_rate(self.handle, &mut rate, &mut fault) };
        failure::done(status, &fault).map(|()| rate)
    }

    /// One step.
    fn step(&mut self, py: Python<'_>, dt: f64) -> PyResult<Done> {
        self.report(py, |flow, report, fault| unsafe { double::vdg_flow_step(flow, dt, report, fault) })
    }

    /// Stable steps.
    fn advance(&mut self, py: Python<'_>, end: f64, cfl: f64, most: u64) -> PyResult<Done> {
        self.report(py, |flow, report, fault| unsafe { double::vdg_flow_advance(flow, end, cfl, most, report, fault) })
    }

    /// Mass, momentum and energy.
    fn totals(&self) -> PyResult<[f64; 5]> {
        let (mut totals, mut fault) = ([0.0; 5], failure::none());
        let status = unsafe { double::vdg_flow_totals(self.handle, totals.as_mut_ptr(), &mut fault) };
        failure::done(status, &fault).map(|()| totals)
    }

    /// Changes a side.
    fn set_side(&mut self, number: i32, side: Side) -> PyResult<()> {
        let ((kind, rho, u, p, relax), mut fault) = (side, failure::none());
        let side = Boundary { kind, rho, u, p, relax };
        let status = unsafe { double::vdg_flow_set_side(self.handle, number, &side, &mut fault) };
        failure::done(status, &fault)
    }
}

/// Time, dt, rate; steps, repeated, first order, floored; inflow.
type Done = (f64, f64, f64, [u64; 4], [[f64; 5]; 6]);

/// A handle that another thread may use for the length of a call.
struct Handle(*mut voidage_capi::Flow<f64>);
unsafe impl Send for Handle {}

impl Flow {
    fn of(case: &Case<f64>, shape: [usize; 3]) -> PyResult<Self> {
        let (mut handle, mut fault) = (null_mut(), failure::none());
        let bytes = unsafe { double::vdg_flow_size(case) };
        // Of a wrong case the size is unknown: the call with no memory says what is wrong.
        let held = if bytes == usize::MAX { 0 } else { bytes };
        let mut block: Vec<u8> = Vec::new();
        block.try_reserve_exact(held).map_err(|_| PyMemoryError::new_err(format!("{held} bytes for the flow")))?;
        let status = unsafe { double::vdg_flow_init(case, block.as_mut_ptr().cast(), held, &mut handle, &mut fault) };
        failure::done(status, &fault)?;
        Ok(Flow { handle, shape, _block: block })
    }

    /// Steps without Python's lock.
    fn report(
        &mut self,
        py: Python<'_>,
        call: impl FnOnce(
            *mut voidage_capi::Flow<f64>,
            *mut StepReport<f64>,
            *mut voidage_capi::status::Fault,
        ) -> voidage_capi::status::Status
        + Send,
    ) -> PyResult<Done> {
        let handle = Handle(self.handle);
        let (status, report, argument, axis, index) = py.detach(move || {
            let Handle(flow) = { handle };
            let (mut report, mut fault) = (StepReport::default(), failure::none());
            let status = call(flow, &mut report, &mut fault);
            (status, report, fault.argument as usize, fault.axis, fault.index)
        });
        let fault = voidage_capi::status::Fault { argument: argument as *const _, axis, index, needed: 0 };
        failure::done(status, &fault)?;
        let counts = [report.steps, report.repeated, report.first_order, report.floored];
        Ok((report.time, report.dt, report.rate, counts, report.inflow))
    }
}
