//! The state of a moment as files: NumPy arrays, ParaView frames with their times, pictures.

use crate::error::{Error, Result};
use crate::files::vtr::{CellField, NamedField, Vtr};
use crate::files::{atomically, npy};
use crate::flow::Flow;
use crate::grid::{AXES, Edges};
use std::fmt::Write as _;
use std::path::Path;

/// Primitive variables of all cells, x fastest.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Density.
    pub density: Vec<f64>,
    /// Velocity along x, y, z; 0 along axes of one cell.
    pub velocity: [Vec<f64>; 3],
    /// Pressure.
    pub pressure: Vec<f64>,
    /// Ratio of specific heats of a mixed gas.
    pub gamma: Option<Vec<f64>>,
}

impl Snapshot {
    /// Of the present state.
    #[must_use]
    pub fn of<const D: usize>(flow: &Flow<f64, D>, live: [usize; D]) -> Self {
        let mut velocity: [Vec<f64>; 3] = Default::default();
        let cells = (0..flow.len()).map(|c| flow.get(c));
        let (mut density, mut pressure) = (Vec::with_capacity(flow.len()), Vec::with_capacity(flow.len()));
        for w in cells {
            density.push(w.density);
            pressure.push(w.pressure);
            live.iter().zip(w.velocity).for_each(|(&axis, u)| velocity[axis].push(u));
        }
        velocity.iter_mut().for_each(|v| v.resize(flow.len(), 0.0));
        let gammas = || (0..flow.len()).map(|c| flow.gas_at(c).gamma()).collect();
        let gamma = flow.gas().is_mixed().then(gammas);
        Snapshot { density, velocity, pressure, gamma }
    }

    /// Writes `rho.npy`, `u.npy`, `v.npy`, `w.npy`, `p.npy`, `gamma.npy` of a mixed gas and `beta_v.npy` where not all is open, all or none.
    ///
    /// # Errors
    /// The files cannot be written.
    pub fn arrays(&self, dir: &Path, edges: &Edges, beta_v: Option<&[f64]>) -> Result<()> {
        let [u, v, w] = self.velocity.each_ref().map(|v| &v[..]);
        let named = [("rho", &self.density[..]), ("u", u), ("v", v), ("w", w), ("p", &self.pressure)];
        let some = [("gamma", self.gamma.as_deref()), ("beta_v", beta_v)];
        let given = some.into_iter().filter_map(|(name, values)| Some((name, values?)));
        let arrays: Vec<_> =
            named.into_iter().chain(given).map(|(name, values)| (name.to_owned(), edges.cells(), values)).collect();
        npy::write_fields(dir, edges, &arrays)?;
        // What an earlier run with a mixed gas or with solids has left would speak for this one.
        let mut absent = some.into_iter().filter(|(_, values)| values.is_none());
        absent.try_for_each(|(name, _)| forget(&dir.join(format!("{name}.npy"))))
    }

    /// Writes a frame for ParaView.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn paraview(&self, path: &Path, edges: &Edges, beta_v: Option<&[f64]>, time: f64) -> Result<()> {
        let [x, y, z] = &edges.0;
        let scalar = |name, data| CellField::Values(NamedField { name, components: 1, data });
        let parts = self.velocity.each_ref().map(|v| &v[..]);
        let mut cell = vec![
            scalar("p", &self.pressure),
            scalar("rho", &self.density),
            CellField::Vector { name: "velocity", parts },
        ];
        cell.extend(self.gamma.iter().map(|gamma| scalar("gamma", gamma)));
        cell.extend(beta_v.map(|b| scalar("beta_v", b)));
        let time = [time];
        let field_data = vec![NamedField { name: "TimeValue", components: 1, data: &time }];
        Vtr { x, y, z, cell, field_data, text: vec![], compress: false }.write(path)
    }

    /// Speed of all cells.
    #[must_use]
    pub fn speed(&self) -> Vec<f64> {
        let [u, v, w] = &self.velocity;
        (0..u.len()).map(|c| (u[c] * u[c] + v[c] * v[c] + w[c] * w[c]).sqrt()).collect()
    }
}

/// A point from one to three numbers; along axes that are left out, which have one cell, it lies in its middle.
///
/// # Errors
/// It has no numbers or too many, leaves an axis with several cells out, or is outside the grid: which of the numbers, as a key's ending, and the reason.
pub fn point(edges: &Edges, given: &[f64]) -> std::result::Result<[f64; 3], (String, String)> {
    let all = |reason| Err((String::new(), reason));
    if !(1..=3).contains(&given.len()) {
        return all(format!("needs one to three numbers, not {}", given.len()));
    }
    let mut point = [0.0; 3];
    for (axis, name) in AXES.into_iter().enumerate() {
        let (number, cells) = (format!("[{axis}]"), edges.cells()[axis]);
        point[axis] = match given.get(axis) {
            Some(x) if x.is_nan() => return Err((number, "is not a number".to_owned())),
            Some(&x) => x,
            None if cells == 1 => edges.0[axis][0] + 0.5 * (edges.0[axis][1] - edges.0[axis][0]),
            None => return all(format!("needs a place along {name}, where the grid has {cells} cells")),
        };
        if let Some(reaches) = edges.misses(axis, point[axis]) {
            return Err((number, format!("{name} = {} is outside the grid: {reaches}", point[axis])));
        }
    }
    Ok(point)
}

/// Indices of the cell that holds a point.
#[must_use]
pub fn cell_at(edges: &Edges, point: [f64; 3]) -> Option<[usize; 3]> {
    let mut at = [0; 3];
    for a in 0..3 {
        let e = &edges.0[a];
        let inside = e.first().is_some_and(|&low| low <= point[a]) && e.last().is_some_and(|&high| point[a] <= high);
        if !inside {
            return None;
        }
        at[a] = e.partition_point(|&x| x <= point[a]).clamp(1, e.len() - 1) - 1;
    }
    Some(at)
}

/// Removes a file that an earlier run may have left.
///
/// # Errors
/// It cannot be removed.
pub fn forget(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io(path, "remove", &e)),
        _ => Ok(()),
    }
}

/// A directory, made if need be.
///
/// # Errors
/// It cannot be made.
pub fn create(dir: &Path) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(|e| Error::io(dir, "create the directory", &e))
}

/// Name of the directory in `frames` that holds the planes of pictures.
pub const SLICES: &str = "slices";

/// Removes the planes of pictures that are kept in `dir`.
///
/// # Errors
/// They cannot be removed.
pub fn forget_planes(dir: &Path) -> Result<()> {
    let path = dir.join("frames").join(SLICES);
    match std::fs::remove_dir_all(&path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io(&path, "remove", &e)),
        _ => Ok(()),
    }
}

/// Removes the frames that an earlier run has left in `dir`, and nothing else.
///
/// # Errors
/// One cannot be removed.
pub fn remove_old(dir: &Path) -> Result<()> {
    let Ok(entries) = std::fs::read_dir(dir.join("frames")) else { return Ok(()) };
    for path in entries.filter_map(|entry| entry.ok().map(|e| e.path())) {
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let number = stem.rsplit('_').next().unwrap_or_default();
        let numbered = number.len() >= 4 && number.bytes().all(|b| b.is_ascii_digit());
        let ours = matches!(stem.strip_suffix(number), Some("flow_" | "speed_" | "pressure_" | "gamma_" | ""));
        if numbered && ours || stem == SLICES && path.is_dir() {
            let removed = if path.is_dir() { std::fs::remove_dir_all(&path) } else { std::fs::remove_file(&path) };
            removed.map_err(|e| Error::io(&path, "remove", &e))?;
        }
    }
    Ok(())
}

/// Name of the list of frames.
pub const SERIES: &str = "flow.pvd";

/// Writes the list of frames with their times that ParaView opens as one series; a run that went on with other formats has none of some times.
///
/// # Errors
/// The file cannot be written.
pub fn series(path: &Path, times: &[f64]) -> Result<()> {
    let mut text =
        String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
    let frames = path.with_file_name("frames");
    let there = |n: &usize| frames.join(frame_name(*n, "vtr")).exists();
    for (n, time) in times.iter().enumerate().filter(|(n, _)| there(n)) {
        let file = frame_name(n, "vtr");
        let _ = writeln!(text, "    <DataSet timestep=\"{time}\" part=\"0\" file=\"frames/{file}\"/>"); // a String takes anything
    }
    text += "  </Collection>\n</VTKFile>\n";
    atomically(path, |out| out.write_all(text.as_bytes()))
}

/// Name of a frame's file in `frames/`.
#[must_use]
pub fn frame_name(n: usize, extension: &str) -> String {
    format!("flow_{n:04}.{extension}")
}
