//! What a call of the C interface refused, as an exception.

use core::ffi::CStr;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;
use voidage_capi::status::{Fault, Status};

/// A fault before any call.
pub fn none() -> Fault {
    Fault { argument: c"".as_ptr(), axis: -1, index: 0, needed: 0 }
}

/// The answer of a call.
pub fn done(status: Status, fault: &Fault) -> Result<(), PyErr> {
    if status == Status::Ok {
        return Ok(());
    }
    // Faults name arguments in static memory.
    let argument = unsafe { CStr::from_ptr(fault.argument) }.to_string_lossy();
    let text = Status::text(status as i32).to_string_lossy();
    let axis = ["x", "y", "z"].get(fault.axis as usize).map_or(String::new(), |axis| format!(", axis {axis}"));
    Err(PyValueError::new_err(format!("{text}: {argument}{axis}, entry {}", fault.index)))
}
