//! The functions of single precision, made by `single.py` from `double.rs`.

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

/// As `vdg_grid_check`, in single precision.
///
/// # Safety
/// As of `vdg_grid_check`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_grid_check(grid: *const Grid<f32>, fault: *mut Fault) -> Status {
    unsafe { told(grid::check(grid), fault) }
}

/// As `vdg_surface_work`, in single precision.
///
/// # Safety
/// As of `vdg_surface_work`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_surface_work(
    grid: *const Grid<f32>,
    surface: *const Surface<f32>,
    options: *const Options<f32>,
) -> usize {
    unsafe { surface::work_bytes(&Question { grid, surface, options }) }
}

/// As `vdg_surface_porosity`, in single precision.
///
/// # Safety
/// As of `vdg_surface_porosity`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_surface_porosity(
    grid: *const Grid<f32>,
    surface: *const Surface<f32>,
    options: *const Options<f32>,
    fractions: *const Fractions<f32>,
    work: *mut c_void,
    bytes: usize,
    report: *mut PorosityReport<f32>,
    fault: *mut Fault,
) -> Status {
    let reply = Reply { fractions, work: work.cast(), bytes, report };
    unsafe { told(surface::porosity(&Question { grid, surface, options }, &reply), fault) }
}

/// As `vdg_scene_work`, in single precision.
///
/// # Safety
/// As of `vdg_scene_work`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_scene_work(
    grid: *const Grid<f32>,
    scene: *const Scene<f32>,
    options: *const Options<f32>,
) -> usize {
    unsafe { scene::work_bytes(&Asked { grid, scene, options }) }
}

/// As `vdg_scene_porosity`, in single precision.
///
/// # Safety
/// As of `vdg_scene_porosity`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_scene_porosity(
    grid: *const Grid<f32>,
    scene: *const Scene<f32>,
    options: *const Options<f32>,
    fractions: *const Fractions<f32>,
    work: *mut c_void,
    bytes: usize,
    report: *mut PorosityReport<f32>,
    fault: *mut Fault,
) -> Status {
    let reply = Reply { fractions, work: work.cast(), bytes, report };
    unsafe { told(scene::porosity(&Asked { grid, scene, options }, &reply), fault) }
}

/// As `vdg_meets`, in single precision.
///
/// # Safety
/// As of `vdg_meets`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_meets(
    a: *const Body<f32>,
    b: *const Body<f32>,
    hint: *const f32,
    contact: *mut i32,
    fault: *mut Fault,
) -> Status {
    unsafe { told(body::meets(&Pair { a, b, hint }, contact), fault) }
}

/// As `vdg_distance`, in single precision.
///
/// # Safety
/// As of `vdg_distance`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_distance(
    a: *const Body<f32>,
    b: *const Body<f32>,
    hint: *const f32,
    distance: *mut Distance<f32>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(body::distance(&Pair { a, b, hint }, distance), fault) }
}

/// As `vdg_flow_size`, in single precision.
///
/// # Safety
/// As of `vdg_flow_size`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_size(flow_case: *const Case<f32>) -> usize {
    unsafe { flow::size(flow_case) }
}

/// As `vdg_flow_init`, in single precision.
///
/// # Safety
/// As of `vdg_flow_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_init(
    flow_case: *const Case<f32>,
    memory: *mut c_void,
    bytes: usize,
    flow: *mut *mut Flow<f32>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::init(flow_case, memory.cast(), bytes, flow), fault) }
}

/// As `vdg_flow_set`, in single precision.
///
/// # Safety
/// As of `vdg_flow_set`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_set(
    flow: *mut Flow<f32>,
    rho: *const f32,
    u: *const f32,
    v: *const f32,
    w: *const f32,
    p: *const f32,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::set(flow, Primitives([rho, u, v, w, p])), fault) }
}

/// As `vdg_flow_get`, in single precision.
///
/// # Safety
/// As of `vdg_flow_get`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_get(
    flow: *const Flow<f32>,
    rho: *mut f32,
    u: *mut f32,
    v: *mut f32,
    w: *mut f32,
    p: *mut f32,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::get(flow, Primitives([rho, u, v, w, p])), fault) }
}

/// As `vdg_flow_rate`, in single precision.
///
/// # Safety
/// As of `vdg_flow_rate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_rate(flow: *mut Flow<f32>, rate: *mut f32, fault: *mut Fault) -> Status {
    unsafe { told(flow::rate(flow, rate), fault) }
}

/// As `vdg_flow_step`, in single precision.
///
/// # Safety
/// As of `vdg_flow_step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_step(
    flow: *mut Flow<f32>,
    dt: f32,
    report: *mut StepReport<f32>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::step(flow, dt, report), fault) }
}

/// As `vdg_flow_advance`, in single precision.
///
/// # Safety
/// As of `vdg_flow_advance`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_advance(
    flow: *mut Flow<f32>,
    end: f32,
    cfl: f32,
    max_steps: u64,
    report: *mut StepReport<f32>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::advance(flow, end, cfl, max_steps, report), fault) }
}

/// As `vdg_flow_totals`, in single precision.
///
/// # Safety
/// As of `vdg_flow_totals`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_totals(flow: *const Flow<f32>, totals: *mut f32, fault: *mut Fault) -> Status {
    unsafe { told(flow::totals(flow, totals), fault) }
}

/// As `vdg_flow_set_side`, in single precision.
///
/// # Safety
/// As of `vdg_flow_set_side`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vdgf_flow_set_side(
    flow: *mut Flow<f32>,
    number: i32,
    side: *const Boundary<f32>,
    fault: *mut Fault,
) -> Status {
    unsafe { told(flow::set_side(flow, number, side), fault) }
}
