//! Convex bodies, whether two meet, and how far apart they are.

use crate::failure;
use core::ptr::null;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voidage_capi::double;
use voidage_capi::types;

/// A convex body, by the number of its kind in the C interface.
#[pyclass(frozen)]
pub struct Body {
    kind: i32,
    numbers: [f64; 12],
    points: Vec<[f64; 3]>,
    round: f64,
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (kind, numbers, points, round))]
    fn new(kind: i32, numbers: Vec<f64>, points: Vec<[f64; 3]>, round: f64) -> PyResult<Self> {
        let mut all = [0.0; 12];
        let places = all.get_mut(..numbers.len()).ok_or_else(|| PyValueError::new_err("more than twelve numbers"))?;
        places.copy_from_slice(&numbers);
        Ok(Body { kind, numbers: all, points, round })
    }
}

impl Body {
    fn view(&self) -> types::Body<f64> {
        let points = self.points.as_ptr().cast();
        types::Body { kind: self.kind, p: self.numbers, points, count: self.points.len(), round: self.round }
    }
}

/// The number of the contact in the C interface.
#[pyfunction]
pub fn meets(a: &Body, b: &Body) -> PyResult<i32> {
    let (mut contact, mut fault) = (0, failure::none());
    // The views live as long as the bodies.
    let status = unsafe { double::vdg_meets(&a.view(), &b.view(), null(), &mut contact, &mut fault) };
    failure::done(status, &fault)?;
    Ok(contact)
}

/// Contact, distance, bounds, nearest points.
type Apart = (i32, f64, f64, f64, [f64; 3], [f64; 3]);

/// How far apart two bodies are.
#[pyfunction]
pub fn distance(a: &Body, b: &Body) -> PyResult<Apart> {
    let (mut found, mut fault) = (types::Distance::default(), failure::none());
    // The views live as long as the bodies.
    let status = unsafe { double::vdg_distance(&a.view(), &b.view(), null(), &mut found, &mut fault) };
    failure::done(status, &fault)?;
    Ok((found.contact, found.distance, found.lower, found.upper, found.a, found.b))
}
