//! The functions of both precisions under one name.

use core::ffi::c_void;
use voidage_capi::status::{Fault, Status};
use voidage_capi::types::{Body, Case, Distance, Fractions, Grid, Options, PorosityReport, Scene, StepReport, Surface};
use voidage_capi::{Flow, double, single};
use voidage_core::number::real::Real;

macro_rules! api {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty, $double:ident, $single:ident;)*) => {
        /// The functions of one precision.
        pub trait Api: Real {
            /// The bits of a value.
            fn bits(self) -> u64;
            $(/// As in the header.
            unsafe fn $name($($argument: $type),*) -> $result;)*
        }
        impl Api for f64 {
            fn bits(self) -> u64 { self.to_bits() }
            $(unsafe fn $name($($argument: $type),*) -> $result { unsafe { double::$double($($argument),*) } })*
        }
        impl Api for f32 {
            fn bits(self) -> u64 { u64::from(self.to_bits()) }
            $(unsafe fn $name($($argument: $type),*) -> $result { unsafe { single::$single($($argument),*) } })*
        }
    };
}

api! {
    surface_porosity(grid: *const Grid<Self>, surface: *const Surface<Self>, options: *const Options<Self>,
        fractions: *const Fractions<Self>, work: *mut c_void, bytes: usize, report: *mut PorosityReport<Self>, fault: *mut Fault)
        -> Status, vdg_surface_porosity, vdgf_surface_porosity;
    scene_porosity(grid: *const Grid<Self>, scene: *const Scene<Self>, options: *const Options<Self>,
        fractions: *const Fractions<Self>, work: *mut c_void, bytes: usize, report: *mut PorosityReport<Self>, fault: *mut Fault)
        -> Status, vdg_scene_porosity, vdgf_scene_porosity;
    meets(a: *const Body<Self>, b: *const Body<Self>, hint: *const Self, contact: *mut i32, fault: *mut Fault) -> Status,
        vdg_meets, vdgf_meets;
    distance(a: *const Body<Self>, b: *const Body<Self>, hint: *const Self, found: *mut Distance<Self>, fault: *mut Fault) -> Status,
        vdg_distance, vdgf_distance;
    flow_init(flow_case: *const Case<Self>, memory: *mut c_void, bytes: usize, flow: *mut *mut Flow<Self>, fault: *mut Fault)
        -> Status, vdg_flow_init, vdgf_flow_init;
    flow_set(flow: *mut Flow<Self>, rho: *const Self, u: *const Self, v: *const Self, w: *const Self, p: *const Self, fault: *mut Fault)
        -> Status, vdg_flow_set, vdgf_flow_set;
    flow_get(flow: *const Flow<Self>, rho: *mut Self, u: *mut Self, v: *mut Self, w: *mut Self, p: *mut Self, fault: *mut Fault)
        -> Status, vdg_flow_get, vdgf_flow_get;
    flow_rate(flow: *mut Flow<Self>, rate: *mut Self, fault: *mut Fault) -> Status, vdg_flow_rate, vdgf_flow_rate;
    flow_step(flow: *mut Flow<Self>, dt: Self, report: *mut StepReport<Self>, fault: *mut Fault) -> Status,
        vdg_flow_step, vdgf_flow_step;
}
