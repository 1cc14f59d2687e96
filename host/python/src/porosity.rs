//! Porosity of files and of triangles in memory, on all threads.

use glam::DVec3;
use numpy::npyffi::NPY_ORDER;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray3};
use pyo3::exceptions::{PyOSError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::geometry::read::read;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, porosity as measure};

fn wrong(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Triangles from an array of shape (n, 3, 3), or from a file.
fn mesh(source: &Bound<'_, PyAny>) -> PyResult<Mesh> {
    if let Ok(array) = source.extract::<PyReadonlyArray3<f64>>() {
        let array = array.as_array();
        if array.shape()[1..] != [3, 3] {
            return Err(PyValueError::new_err("triangles have the shape (n, 3, 3)"));
        }
        let corner = |t: usize, c: usize| DVec3::new(array[[t, c, 0]], array[[t, c, 1]], array[[t, c, 2]]);
        let triangles: Vec<[DVec3; 3]> = (0..array.shape()[0]).map(|t| [0, 1, 2].map(|c| corner(t, c))).collect();
        if let Some(at) = triangles.iter().position(|t| !t.iter().all(|p| p.is_finite())) {
            return Err(PyValueError::new_err(format!("triangle {at} has a coordinate that is NaN or infinite")));
        }
        return Ok(Mesh::from(triangles));
    }
    let path: PathBuf = source
        .extract()
        .map_err(|_| PyTypeError::new_err("a mesh is a path, or an array of shape (n, 3, 3) of float64"))?;
    read(&path).map_err(|error| PyOSError::new_err(error.to_string()))
}

/// Open fractions as arrays of the shape of their grid, x fastest in memory.
fn fields<'py>(
    py: Python<'py>,
    into: &Bound<'py, PyDict>,
    set: &FieldSet,
    cells: [usize; 3],
    suffix: &str,
) -> PyResult<()> {
    let [nx, ny, nz] = cells;
    let shapes = [cells, [nx + 1, ny, nz], [nx, ny + 1, nz], [nx, ny, nz + 1]];
    for ((name, field), shape) in [("v", &set.v), ("x", &set.x), ("y", &set.y), ("z", &set.z)].into_iter().zip(shapes) {
        if !field.is_empty() {
            let array = PyArray1::from_slice(py, field).reshape_with_order(shape, NPY_ORDER::NPY_FORTRANORDER)?;
            into.set_item(format!("beta_{name}{suffix}"), array)?;
        }
    }
    Ok(())
}

/// Open fractions of cells and faces.
#[pyfunction]
pub fn porosity<'py>(
    py: Python<'py>,
    meshes: Vec<Bound<'py, PyAny>>,
    edges: [PyReadonlyArray1<'py, f64>; 3],
    numbers: (f64, f64, u32),
    wanted: (bool, bool),
) -> PyResult<Bound<'py, PyDict>> {
    let ((scale, tol, depth), (areas, bounds)) = (numbers, wanted);
    let mut bodies = Bodies::default();
    for source in &meshes {
        bodies.add(&mesh(source)?, scale).map_err(wrong)?;
    }
    let edges = Edges(edges.map(|list| list.as_array().to_vec()));
    let grid = edges.grid(None).map_err(wrong)?;
    let options = Options { tol, depth, areas, bounds, ..Options::default() };
    let found = py.detach(|| measure(&grid, &bodies, options));
    let into = PyDict::new(py);
    fields(py, &into, &found.beta, grid.cells(), "")?;
    if let Some([lower, upper]) = &found.bounds {
        fields(py, &into, lower, grid.cells(), "_lower")?;
        fields(py, &into, upper, grid.cells(), "_upper")?;
    }
    into.set_item("solid_volume", found.solid_volume)?;
    into.set_item("max_gap", found.max_gap)?;
    let counts = PyDict::new(py);
    let kinds = found.cells;
    for (name, count) in
        [("open", kinds.open), ("cut", kinds.cut), ("closed", kinds.closed), ("shared", kinds.ambiguous)]
    {
        counts.set_item(name, count)?;
    }
    into.set_item("cells", counts)?;
    into.set_item("bodies", bodies.bodies.len())?;
    into.set_item("warnings", &bodies.warnings)?;
    Ok(into)
}
