//! Arguments that no program should give: each is answered.

use crate::kit::api::{Api, Found, body, grid, named, no_fault, zeroed};
use crate::kit::calls::any_calls;
use core::ptr::{null, null_mut};
use voidage_capi::Flow;
use voidage_capi::status::{Fault, Status};
use voidage_capi::types::{Case, Fractions, Grid, Options, Scene, Surface};
use voidage_tests::random::Random;

fn edges() -> [Vec<f64>; 3] {
    [vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![0.0, 1.0, 2.0, 3.0]]
}

#[test]
fn calls_with_any_arguments_are_answered() {
    for seed in 0..4000 {
        let random = &mut Random::new(seed);
        let bytes: Vec<u8> = (0..random.below(200)).map(|_| random.bits() as u8).collect();
        any_calls::<f64>(&bytes);
        any_calls::<f32>(&bytes);
    }
}

#[test]
fn grids_that_are_none_are_named() {
    let lists = edges();
    let good = grid(&lists);
    let check = |grid: Grid<f64>| {
        let mut fault = no_fault();
        let status = unsafe { f64::grid_check(&grid, &mut fault) };
        (status, named(&fault), fault.axis, fault.index)
    };
    assert_eq!(check(good), (Status::Ok, "", -1, 0));
    assert_eq!(check(Grid { x: null(), ..good }), (Status::Null, "grid.x", 0, 0));
    assert_eq!(check(Grid { y: null(), ny: 0, ..good }), (Status::Grid, "grid", 1, 0));
    assert_eq!(check(Grid { z: good.z.wrapping_byte_add(1), ..good }), (Status::Misaligned, "grid.z", 2, 0));
    for cells in [usize::MAX, usize::MAX - 1, usize::MAX / 8, isize::MAX as usize / 8] {
        assert_eq!(check(Grid { nz: cells, ..good }), (Status::Length, "grid.z", 2, 0));
    }
    for bad in [f64::NAN, f64::INFINITY, 1.0, 0.5] {
        let list = [0.0, 1.0, bad];
        assert_eq!(check(Grid { x: list.as_ptr(), ..good }), (Status::Grid, "grid", 0, 2));
    }
    assert_eq!(unsafe { f64::grid_check(null(), null_mut()) }, Status::Null);
}

/// Status and fault of a porosity with arguments that may be wrong; 1 MB of work.
fn ask(
    surface: &Surface<f64>,
    options: &Options<f64>,
    change: impl Fn(&mut Fractions<f64>, &mut [u8]),
) -> (Status, Fault) {
    let lists = edges();
    let grid = grid(&lists);
    let mut found = Found::new(&grid, 3, true);
    let (mut fractions, mut work, mut fault) = (found.fractions(), vec![0_u8; 1 << 20], no_fault());
    change(&mut fractions, &mut work);
    let (start, bytes) = (work.as_mut_ptr().cast(), work.len());
    let status =
        unsafe { f64::surface_porosity(&grid, surface, options, &fractions, start, bytes, null_mut(), &mut fault) };
    (status, fault)
}

#[test]
fn surfaces_that_are_none_are_named() {
    let mut corners = vec![0.5; 36];
    let first = [0, 2, 4];
    let good = Surface { corners: corners.as_ptr(), triangles: 4, first: first.as_ptr(), bodies: 2, sheets: null() };
    let options = Options { pieces: 4, ..zeroed() };
    let told = |surface: Surface<f64>| {
        let (status, fault) = ask(&surface, &options, |_, _| ());
        (status, named(&fault), fault.index)
    };
    assert_eq!(told(good), (Status::Ok, "", 0));
    assert_eq!(told(Surface { corners: null(), ..good }), (Status::Null, "surface.corners", 0));
    assert_eq!(told(Surface { corners: null(), triangles: 0, first: null(), ..good }), (Status::Ok, "", 0));
    for triangles in [usize::MAX, usize::MAX / 9, isize::MAX as usize / 72 + 1] {
        assert_eq!(told(Surface { triangles, ..good }).0, Status::Length);
    }
    for bodies in [usize::MAX, usize::MAX / 8] {
        assert_eq!(told(Surface { bodies, ..good }).0, Status::Length);
    }
    let (backwards, beyond) = ([0, 3, 2], [0, 2, 5]);
    assert_eq!(told(Surface { first: backwards.as_ptr(), ..good }), (Status::Length, "surface.first", 2));
    assert_eq!(told(Surface { first: beyond.as_ptr(), ..good }), (Status::Length, "surface.first", 2));
    assert_eq!(ask(&good, &Options { tol: f64::NAN, ..options }, |_, _| ()).0, Status::Value);
    assert_eq!(ask(&good, &Options { first_layer: 3, ..options }, |_, _| ()).0, Status::Range);
    assert_eq!(ask(&good, &Options { layers: 4, ..options }, |_, _| ()).0, Status::Range);
    assert_eq!(ask(&good, &Options { layers: usize::MAX, first_layer: 1, ..options }, |_, _| ()).0, Status::Range);
    let (status, fault) = ask(&good, &Options { pieces: u32::MAX, ..options }, |_, _| ());
    assert!(status == Status::Memory && fault.needed > 1 << 40);
    corners[20] = f64::NAN;
    assert_eq!(told(Surface { corners: corners.as_ptr(), ..good }), (Status::Value, "surface.corners", 2));
}

#[test]
fn arrays_that_overlap_or_are_missing_are_named() {
    let corners = vec![0.5; 9];
    let surface = Surface { corners: corners.as_ptr(), triangles: 1, first: null(), bodies: 0, sheets: null() };
    let told = |change: fn(&mut Fractions<f64>, &mut [u8])| {
        let (status, fault) = ask(&surface, &zeroed(), change);
        (status, named(&fault))
    };
    assert_eq!(told(|_, _| ()), (Status::Ok, ""));
    assert_eq!(told(|f, _| f.value.v = null_mut()), (Status::Null, "value.v"));
    assert_eq!(told(|f, _| f.value.y = null_mut()), (Status::Null, "value.y"));
    assert_eq!(told(|f, _| f.upper.v = null_mut()), (Status::Null, "upper.v"));
    assert_eq!(told(|f, _| f.lower = zeroed()), (Status::Null, "lower.v"));
    assert_eq!(told(|f, _| f.lower.x = f.lower.x.wrapping_byte_add(4)), (Status::Misaligned, "lower.x"));
    assert_eq!(told(|f, _| f.upper.v = f.value.v), (Status::Overlap, "upper.v"));
    assert_eq!(told(|f, _| f.value.v = f.value.x.wrapping_add(3)), (Status::Overlap, "value.x"));
    assert_eq!(told(|f, work| f.lower.v = work.as_mut_ptr().wrapping_add(16).cast()), (Status::Overlap, "work"));
    assert_eq!(told(|f, _| f.value.v = (usize::MAX & !7) as *mut f64), (Status::Length, "value.v"));
}

#[test]
fn solids_that_are_none_are_named() {
    let lists = edges();
    let grid = grid(&lists);
    let mut found = Found::new(&grid, 3, true);
    let fractions = found.fractions();
    let told = |bad: voidage_capi::types::Body<f64>, count: usize| {
        let solids = [body(5, &[1.0, 0.5, 1.0, 0.25]), bad];
        let scene = Scene { surface: null(), solids: solids.as_ptr(), solid_count: count };
        let (mut work, mut fault) = (vec![0_u8; 1 << 18], no_fault());
        let (start, bytes) = (work.as_mut_ptr().cast(), work.len());
        let status =
            unsafe { f64::scene_porosity(&grid, &scene, null(), &fractions, start, bytes, null_mut(), &mut fault) };
        (status, named(&fault), fault.index)
    };
    let good = body(5, &[1.0, 0.5, 2.0, 0.25]);
    assert_eq!(told(good, 1), (Status::Ok, "", 0));
    assert_eq!(told(body(5, &[1.0, f64::NAN, 2.0, 0.25]), 2), (Status::Value, "body.p", 1));
    assert_eq!(told(body(3, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]), 2), (Status::Kind, "solids.kind", 1));
    assert_eq!(told(body(77, &[]), 2), (Status::Kind, "body.kind", 1));
    assert_eq!(told(body(5, &[0.0, 0.0, 0.0, 0.0]), 2), (Status::Body, "solids.p", 1));
    assert_eq!(told(body(7, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), 2), (Status::Body, "solids.p", 1));
    assert_eq!(told(good, usize::MAX), (Status::Length, "scene.solids", 0));
}

#[test]
fn handles_that_are_none_are_told() {
    let lists = edges();
    let case = Case { grid: grid(&lists), gamma: 1.4, ..zeroed() };
    let bytes = unsafe { f64::flow_size(&case) };
    let (mut block, mut flow, mut fault) = (vec![0_u8; bytes], null_mut(), no_fault());
    assert_eq!(
        unsafe { f64::flow_init(&case, block.as_mut_ptr().cast(), bytes, null_mut(), &mut fault) },
        Status::Null
    );
    assert_eq!(unsafe { f64::flow_init(&case, null_mut(), bytes, &mut flow, &mut fault) }, Status::Null);
    assert_eq!(
        unsafe { f64::flow_init(&case, block.as_mut_ptr().cast(), bytes - 1, &mut flow, &mut fault) },
        Status::Memory
    );
    assert_eq!(fault.needed, bytes);
    assert_eq!(unsafe { f64::flow_init(&case, block.as_mut_ptr().cast(), bytes, &mut flow, &mut fault) }, Status::Ok);
    let rate = |flow: *mut Flow<f64>| unsafe { f64::flow_rate(flow, null_mut(), null_mut()) };
    assert_eq!(rate(null_mut()), Status::Null);
    assert_eq!(rate(flow.wrapping_byte_add(1)), Status::Handle);
    // One of the other precision, and one that was moved.
    assert_eq!(unsafe { f32::flow_rate(flow.cast(), null_mut(), null_mut()) }, Status::Handle);
    let mut moved = block.clone();
    let at = moved.as_mut_ptr().wrapping_byte_offset(flow.addr() as isize - block.as_ptr().addr() as isize);
    assert_eq!(rate(at.cast()), Status::Handle);
    // Arrays inside the flow's own block.
    let inside = block.as_mut_ptr().wrapping_add((bytes / 2) & !15).cast();
    let status = unsafe { f64::flow_get(flow, inside, null_mut(), null_mut(), null_mut(), null_mut(), &mut fault) };
    assert_eq!((status, named(&fault)), (Status::Overlap, "rho"));
}
