//! Grids as the interface gives them, and runs of their layers.

use crate::input::{Arrays, given};
use crate::status::{Answer, Status};
use crate::types;
use voidage_core::grid::Grid;
use voidage_core::number::real::Real;

/// The grid of the caller's edges, checked.
///
/// # Safety
/// As of [`Arrays::read`].
pub unsafe fn checked<'a, R: Real>(arrays: &mut Arrays, grid: &types::Grid<R>) -> Answer<Grid<'a, R>> {
    let lists = [(grid.x, grid.nx, c"grid.x"), (grid.y, grid.ny, c"grid.y"), (grid.z, grid.nz, c"grid.z")];
    let mut edges: [&[R]; 3] = [&[]; 3];
    for (axis, ((first, cells, name), edges)) in lists.into_iter().zip(&mut edges).enumerate() {
        if cells == 0 {
            return Err(Status::Grid.of(c"grid").axis(axis));
        }
        let Some(count) = cells.checked_add(1) else { return Err(Status::Length.of(name).axis(axis)) };
        *edges = unsafe { arrays.read(first, count, name) }.map_err(|refusal| refusal.axis(axis))?;
    }
    Ok(Grid::new(edges[0], edges[1], edges[2])?)
}

/// Checks a grid by itself.
///
/// # Safety
/// As of [`Arrays::read`].
pub unsafe fn check<R: Real>(grid: *const types::Grid<R>) -> Answer {
    unsafe { checked(&mut Arrays::new(), &given(grid, c"grid")?) }.map(|_| ())
}

/// Some layers of a grid.
#[derive(Clone, Copy)]
pub struct Window<'a, R> {
    /// These layers, the one below and the one above, as far as there are such. So a face between two layers is found from both, and the
    /// plane above the grid is that of the window only where it is that of the grid: the bits are those of the whole grid.
    pub grid: Grid<'a, R>,
    /// The first layer, counted in the window.
    pub first: usize,
    /// How many layers.
    pub count: usize,
    /// Whether the highest of them is that of the grid.
    pub to_top: bool,
}

impl<'a, R: Real> Window<'a, R> {
    /// The layers from `first` on, `count` of them or, if that is 0, all.
    pub fn new(grid: Grid<'a, R>, first: usize, count: usize) -> Answer<Self> {
        let layers = grid.cells()[2];
        if first >= layers {
            return Err(Status::Range.of(c"options.first_layer"));
        }
        let count = if count == 0 { layers - first } else { count };
        let end = first.checked_add(count).filter(|&end| end <= layers).ok_or(Status::Range.of(c"options.layers"))?;
        let low = first.saturating_sub(1);
        let edges = grid.edges(2).get(low..=(end + 1).min(layers)).unwrap_or_default();
        let window = Grid::new(grid.edges(0), grid.edges(1), edges)?;
        Ok(Window { grid: window, first: first - low, count, to_top: end == layers })
    }

    /// Cells, and faces normal to x, y and z, in the arrays for these layers.
    pub fn lengths(&self) -> [usize; 4] {
        let [nx, ny, _] = self.grid.cells();
        let planes = self.count + usize::from(self.to_top);
        [nx * ny * self.count, (nx + 1) * ny * self.count, nx * (ny + 1) * self.count, nx * ny * planes]
    }
}
