//! The native part of the Python module `voidage`; `python/voidage/__init__.py` is what users see, and says what arguments mean.

mod bodies;
mod failure;
mod flow;
mod porosity;

use pyo3::prelude::*;

#[pymodule]
fn _voidage(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<bodies::Body>()?;
    module.add_class::<flow::Flow>()?;
    module.add_function(wrap_pyfunction!(bodies::meets, module)?)?;
    module.add_function(wrap_pyfunction!(bodies::distance, module)?)?;
    module.add_function(wrap_pyfunction!(porosity::porosity, module)?)
}
