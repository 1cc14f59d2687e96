//! The functions of both precisions under one name, and structs that are zero.

use core::ffi::c_void;
use core::ptr::null;
use voidage_capi::status::{Fault, Status};
use voidage_capi::types::{
    Beta, Body, Boundary, Case, Distance, Fractions, Grid, Options, PorosityReport, Scene, StepReport, Surface,
};
use voidage_capi::{Flow, double, single};
use voidage_core::number::real::Real;

macro_rules! api {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty, $double:ident, $single:ident;)*) => {
        /// The functions of one precision.
        pub trait Api: Real {
            $(#[expect(clippy::too_many_arguments, reason = "as in C")] #[allow(unfulfilled_lint_expectations)]
            /// As in the header.
            unsafe fn $name($($argument: $type),*) -> $result;)*
        }
        impl Api for f64 {
            $(unsafe fn $name($($argument: $type),*) -> $result { unsafe { double::$double($($argument),*) } })*
        }
        impl Api for f32 {
            $(unsafe fn $name($($argument: $type),*) -> $result { unsafe { single::$single($($argument),*) } })*
        }
    };
}

api! {
    grid_check(grid: *const Grid<Self>, fault: *mut Fault) -> Status, vdg_grid_check, vdgf_grid_check;
    surface_work(grid: *const Grid<Self>, surface: *const Surface<Self>, options: *const Options<Self>) -> usize,
        vdg_surface_work, vdgf_surface_work;
    surface_porosity(grid: *const Grid<Self>, surface: *const Surface<Self>, options: *const Options<Self>,
        fractions: *const Fractions<Self>, work: *mut c_void, bytes: usize, report: *mut PorosityReport<Self>, fault: *mut Fault)
        -> Status, vdg_surface_porosity, vdgf_surface_porosity;
    scene_work(grid: *const Grid<Self>, scene: *const Scene<Self>, options: *const Options<Self>) -> usize,
        vdg_scene_work, vdgf_scene_work;
    scene_porosity(grid: *const Grid<Self>, scene: *const Scene<Self>, options: *const Options<Self>,
        fractions: *const Fractions<Self>, work: *mut c_void, bytes: usize, report: *mut PorosityReport<Self>, fault: *mut Fault)
        -> Status, vdg_scene_porosity, vdgf_scene_porosity;
    meets(a: *const Body<Self>, b: *const Body<Self>, hint: *const Self, contact: *mut i32, fault: *mut Fault) -> Status,
        vdg_meets, vdgf_meets;
    distance(a: *const Body<Self>, b: *const Body<Self>, hint: *const Self, found: *mut Distance<Self>, fault: *mut Fault) -> Status,
        vdg_distance, vdgf_distance;
    flow_size(flow_case: *const Case<Self>) -> usize, vdg_flow_size, vdgf_flow_size;
    flow_init(flow_case: *const Case<Self>, memory: *mut c_void, bytes: usize, flow: *mut *mut Flow<Self>, fault: *mut Fault)
        -> Status, vdg_flow_init, vdgf_flow_init;
    flow_set(flow: *mut Flow<Self>, rho: *const Self, u: *const Self, v: *const Self, w: *const Self, p: *const Self, fault: *mut Fault)
        -> Status, vdg_flow_set, vdgf_flow_set;
    flow_get(flow: *const Flow<Self>, rho: *mut Self, u: *mut Self, v: *mut Self, w: *mut Self, p: *mut Self, fault: *mut Fault)
        -> Status, vdg_flow_get, vdgf_flow_get;
    flow_rate(flow: *mut Flow<Self>, rate: *mut Self, fault: *mut Fault) -> Status, vdg_flow_rate, vdgf_flow_rate;
    flow_step(flow: *mut Flow<Self>, dt: Self, report: *mut StepReport<Self>, fault: *mut Fault) -> Status,
        vdg_flow_step, vdgf_flow_step;
    flow_advance(flow: *mut Flow<Self>, end: Self, cfl: Self, max_steps: u64, report: *mut StepReport<Self>, fault: *mut Fault)
        -> Status, vdg_flow_advance, vdgf_flow_advance;
    flow_totals(flow: *const Flow<Self>, totals: *mut Self, fault: *mut Fault) -> Status, vdg_flow_totals, vdgf_flow_totals;
    flow_set_side(flow: *mut Flow<Self>, number: i32, side: *const Boundary<Self>, fault: *mut Fault) -> Status,
        vdg_flow_set_side, vdgf_flow_set_side;
}

/// A value all of whose bits are zero, as a C program makes its structs.
pub fn zeroed<T: Copy>() -> T {
    // The structs of the interface hold numbers and pointers only.
    unsafe { core::mem::zeroed() }
}

/// A grid on three lists of edges.
pub fn grid<R>([x, y, z]: &[Vec<R>; 3]) -> Grid<R> {
    let cells = |edges: &[R]| edges.len() - 1;
    Grid { x: x.as_ptr(), y: y.as_ptr(), z: z.as_ptr(), nx: cells(x), ny: cells(y), nz: cells(z) }
}

/// A body without points.
pub fn body<R: Api>(kind: i32, numbers: &[R]) -> Body<R> {
    let mut p = [R::ZERO; 12];
    p[..numbers.len()].copy_from_slice(numbers);
    Body { kind, p, points: null(), count: 0, round: R::ZERO }
}

/// Values, lower and upper bounds of cells, x, y and z faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Found<R> {
    pub sets: [[Vec<R>; 4]; 3],
}

impl<R: Api> Found<R> {
    /// Room for some layers of a grid.
    pub fn new(grid: &Grid<R>, layers: usize, to_top: bool) -> Self {
        let (nx, ny) = (grid.nx, grid.ny);
        let lengths = [
            nx * ny * layers,
            (nx + 1) * ny * layers,
            nx * (ny + 1) * layers,
            nx * ny * (layers + usize::from(to_top)),
        ];
        let set = || lengths.map(|n| vec![R::from_f64(-7.0); n]);
        Found { sets: [set(), set(), set()] }
    }

    /// As the interface takes it.
    pub fn fractions(&mut self) -> Fractions<R> {
        let [value, lower, upper] = self.sets.each_mut().map(|[v, x, y, z]| Beta {
            v: v.as_mut_ptr(),
            x: x.as_mut_ptr(),
            y: y.as_mut_ptr(),
            z: z.as_mut_ptr(),
        });
        Fractions { value, lower, upper }
    }
}

/// Where nothing was told.
pub fn no_fault() -> Fault {
    Fault { argument: null(), axis: 99, index: 99, needed: 99 }
}

/// The name in a fault.
pub fn named(fault: &Fault) -> &'static str {
    // Faults name arguments in static memory.
    unsafe { core::ffi::CStr::from_ptr(fault.argument) }.to_str().expect("a name")
}
