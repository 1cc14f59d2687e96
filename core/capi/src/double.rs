//! The functions of double precision.

use crate::body::{self, Pair};
use crate::flow::{self, Flow, Primitives};
use crate::grid;
use crate::scene::{self, Asked};
use crate::status::{Fault, Status, told};
use crate::surface::{self, Question, Reply};
use crate::types::{
    Body, Boundary, Case, Distance, Fractions, Grid, Options, PorosityReport, Scene, StepReport, Surface,
};
use core::ffi::c_void;

/// Checks a grid.
///
/// # Safety
/// Arrays that are given hold as many numbers as their lengths say; `fault` is null or can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_grid_check(grid: *const Grid<f64>, fault: *mut Fault) -> Status {
    unsafe { told(grid::check(grid), fault) }
}

/// Bytes of work that `vdg_surface_porosity` needs for the same arguments; SIZE_MAX if they are wrong, or there are not so many bytes.
///
/// # Safety
/// Arrays that are given hold as many numbers as their lengths say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_surface_work(
    grid: *const Grid<f64>,
    surface: *const Surface<f64>,
    options: *const Options<f64>,
) -> usize {
    unsafe { surface::work_bytes(&Question { grid, surface, options }) }
}

/// Open fractions of cells and faces from bodies of triangles, exact to rounding; what bodies share counts once.
///
/// All layers of the grid, or some of them, as the options say. Layers do not depend on each other: one at a time, or side by side in threads, they
/// have the same bits, each with work of its own. `options`, `report` and `fault` may be null. `work` is a block of `bytes`, aligned or not.
///
/// # Safety
/// Arrays that are given hold as many numbers as their lengths say, `work` is a block of `bytes`; structs are null or can be read, or written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_surface_porosity(
    grid: *const Grid<f64>,
    surface: *const Surface<f64>,
    options: *const Options<f64>,
    fractions: *const Fractions<f64>,
    work: *mut c_void,
    bytes: usize,
    report: *mut PorosityReport<f64>,
    fault: *mut Fault,
) -> Status {
    let reply = Reply { fractions, work: work.cast(), bytes, report };
    unsafe { told(surface::porosity(&Question { grid, surface, options }, &reply), fault) }
}

/// Bytes of work that `vdg_scene_porosity` needs for the same arguments; SIZE_MAX if they are wrong, or there are not so many bytes.
///
/// # Safety
/// Arrays that are given hold as many numbers as their lengths say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_scene_work(
    grid: *const Grid<f64>,
    scene: *const Scene<f64>,
    options: *const Options<f64>,
) -> usize {
    unsafe { scene::work_bytes(&Asked { grid, scene, options }) }
}

/// As `vdg_surface_porosity`, with solids known by formula. Their fractions are exact to rounding; where solids may share a cell with each other or
/// with a surface, it is divided until its bounds are as close as the options say.
///
/// # Safety
/// As of `vdg_surface_porosity`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_scene_porosity(
    grid: *const Grid<f64>,
    scene: *const Scene<f64>,
    options: *const Options<f64>,
    fractions: *const Fractions<f64>,
    work: *mut c_void,
    bytes: usize,
    report: *mut PorosityReport<f64>,
    fault: *mut Fault,
) -> Status {
    let reply = Reply { fractions, work: work.cast(), bytes, report };
    unsafe { told(scene::porosity(&Asked { grid, scene, options }, &reply), fault) }
}

/// Whether two convex bodies meet, with proof (GJK, and exact arithmetic where rounding could hide it): `contact` becomes one of `vdg_contact`.
/// `hint` is null or zero, or three numbers: a direction from `a` towards `b` to start with, which changes the work, not the answer's truth. `fault` may be
/// null.
///
/// # Safety
/// Structs and `hint` are null or can be read; points of hulls are as many as their counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_meets(
    a: *const Body<f64>,
    b: *const Body<f64>,
    hint: *const f64,
    contact: *mut i32,
    fault: *mut Fault,
) -> Status {
    unsafe { told(body::meets(&Pair { a, b, hint }, contact), fault) }
}

/// How far apart two convex bodies are, with certified bounds. `hint` and `fault` as in `vdg_meets`.
///
/// # Safety
/// As of `vdg_meets`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_distance(
    a: *const Body<f64>,
    b: *const Body<f64>,
    hint: *const f64,
    distance: *mut Distance<f64>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(body::distance(&Pair { a, b, hint }, distance), fault) }
}

/// Bytes of memory for a flow; SIZE_MAX if the case is wrong, or there are not so many bytes.
///
/// # Safety
/// `flow_case` is null or can be read; its arrays hold as many numbers as its grid says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_size(flow_case: *const Case<f64>) -> usize {
    unsafe { flow::size(flow_case) }
}

/// Makes a flow in `memory`, a block of `bytes` that need not be aligned. The flow lives there until the block is used for something else; it
/// must not be moved. Set its state before the first step. `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_size`; nothing else uses the block while the flow lives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_init(
    flow_case: *const Case<f64>,
    memory: *mut c_void,
    bytes: usize,
    flow: *mut *mut Flow<f64>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::init(flow_case, memory.cast(), bytes, flow), fault) }
}

/// Sets the state of all cells: density, velocity and pressure in the pores. A velocity that is null is 0; the pressure does not count for a gas
/// without energy equation. `fault` may be null.
///
/// # Safety
/// `flow` is of `vdg_flow_init` and no other call uses it meanwhile; arrays that are given have one entry a cell.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_set(
    flow: *mut Flow<f64>,
    rho: *const f64,
    u: *const f64,
    v: *const f64,
    w: *const f64,
    p: *const f64,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::set(flow, Primitives([rho, u, v, w, p])), fault) }
}

/// Tells the state of all cells; arrays that are null are left out. `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_set`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_get(
    flow: *const Flow<f64>,
    rho: *mut f64,
    u: *mut f64,
    v: *mut f64,
    w: *mut f64,
    p: *mut f64,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::get(flow, Primitives([rho, u, v, w, p])), fault) }
}

/// The largest signal rate of the present state: a step of a CFL number (0.8, say) over it is stable. `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_set`; `rate` is null or can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_rate(flow: *mut Flow<f64>, rate: *mut f64, fault: *mut Fault) -> Status {
    unsafe { told(flow::rate(flow, rate), fault) }
}

/// One step of `dt`, whatever its stability. `report` and `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_set`; `report` is null or can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_step(
    flow: *mut Flow<f64>,
    dt: f64,
    report: *mut StepReport<f64>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::step(flow, dt, report), fault) }
}

/// Stable steps at the CFL number `cfl` (above 0, at most 1) until the time `end`, or until `max_steps` have been done; none, if that is not
/// after the time reached. A step that would need floors is repeated with half the time. The report tells what was done even if the call ends early.
/// `report` and `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_advance(
    flow: *mut Flow<f64>,
    end: f64,
    cfl: f64,
    max_steps: u64,
    report: *mut StepReport<f64>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::advance(flow, end, cfl, max_steps, report), fault) }
}

/// Five sums over all cells, times their open volumes: mass, momentum along x, y, z, energy. `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_set`; `totals` is null or five numbers can be written there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_totals(flow: *const Flow<f64>, totals: *mut f64, fault: *mut Fault) -> Status {
    unsafe { told(flow::totals(flow, totals), fault) }
}

/// Changes what stands outside a side, `number` 0 to 5: x low, x high, y low, y high, z low, z high. Periodic sides stay so. `fault` may be null.
///
/// # Safety
/// As of `vdg_flow_set`; `side` is null or can be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdg_flow_set_side(
    flow: *mut Flow<f64>,
    number: i32,
    side: *const Boundary<f64>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::set_side(flow, number, side), fault) }
}
