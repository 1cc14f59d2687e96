//! A flow in the caller's memory has the bits of the host's.

use crate::kit::api::{Api, grid, named, no_fault, zeroed};
use core::ptr::{null, null_mut};
use voidage::flow::{Flow as HostFlow, Scalar, Treatment};
use voidage_capi::Flow;
use voidage_capi::status::{Fault, Status};
use voidage_capi::types::{Boundary, Case, StepReport};
use voidage_core::flow::{Boundary as CoreBoundary, Gas, Primitive};
use voidage_tests::euler::property::Source;

/// A flow and the block that it lies in.
struct Owned<R: Api> {
    flow: *mut Flow<R>,
    cells: usize,
    _block: Vec<u8>,
}

impl<R: Api> Owned<R> {
    fn new(case: &Case<R>) -> Self {
        let bytes = unsafe { R::flow_size(case) };
        let mut block = vec![0xa5; bytes + 65];
        let (mut flow, mut fault) = (null_mut(), no_fault());
        let status = unsafe { R::flow_init(case, block[1..].as_mut_ptr().cast(), bytes, &mut flow, &mut fault) };
        assert_eq!((status, named(&fault), flow.is_null()), (Status::Ok, "", false));
        assert!(block[1 + bytes..].iter().all(|&b| b == 0xa5), "guards");
        Owned { flow, cells: case.grid.nx * case.grid.ny * case.grid.nz, _block: block }
    }

    fn set(&mut self, [rho, u, v, w, p]: &[Vec<R>; 5]) {
        let mut fault = no_fault();
        let status =
            unsafe { R::flow_set(self.flow, rho.as_ptr(), u.as_ptr(), v.as_ptr(), w.as_ptr(), p.as_ptr(), &mut fault) };
        assert_eq!((status, named(&fault), fault.index), (Status::Ok, "", 0));
    }

    /// Gas at rest, of density and pressure 1.
    fn set_at_rest(&mut self) {
        let [one, zero] = [R::ONE, R::ZERO].map(|x| vec![x; self.cells]);
        self.set(&[one.clone(), zero.clone(), zero.clone(), zero, one]);
    }

    fn get(&self) -> [Vec<R>; 5] {
        let mut fields: [Vec<R>; 5] = core::array::from_fn(|_| vec![R::ZERO; self.cells]);
        let [rho, u, v, w, p] = fields.each_mut().map(|f| f.as_mut_ptr());
        assert_eq!(unsafe { R::flow_get(self.flow, rho, u, v, w, p, null_mut()) }, Status::Ok);
        fields
    }

    fn rate(&mut self) -> R {
        let mut rate = R::ZERO;
        assert_eq!(unsafe { R::flow_rate(self.flow, &mut rate, null_mut()) }, Status::Ok);
        rate
    }

    fn step(&mut self, dt: R) -> StepReport<R> {
        let mut report = StepReport::default();
        assert_eq!(unsafe { R::flow_step(self.flow, dt, &mut report, null_mut()) }, Status::Ok);
        report
    }

    fn advance(&mut self, end: f64, most: u64) -> StepReport<R> {
        let (mut report, cfl) = (StepReport::default(), R::from_f64(0.8));
        let status = unsafe { R::flow_advance(self.flow, R::from_f64(end), cfl, most, &mut report, null_mut()) };
        assert_eq!(status, Status::Ok);
        report
    }

    fn totals(&self) -> [R; 5] {
        let mut totals = [R::ZERO; 5];
        assert_eq!(unsafe { R::flow_totals(self.flow, totals.as_mut_ptr(), null_mut()) }, Status::Ok);
        totals
    }
}

fn edges<R: Api>(cells: [usize; 3]) -> [Vec<R>; 3] {
    cells.map(|n| (0..=n).map(|i| R::from_f64(i as f64 / n as f64)).collect())
}

/// Gas at rest but for a dense, hot corner, between walls.
fn burst<R: Api>(cells: [usize; 3]) -> [Vec<R>; 5] {
    let count = cells.iter().product();
    let hot = |cell: usize| cell < count / 3;
    let field =
        |inside: f64, outside: f64| (0..count).map(|c| R::from_f64(if hot(c) { inside } else { outside })).collect();
    [field(2.0, 1.0), field(0.1, 0.0), field(0.0, 0.0), field(-0.1, 0.0), field(3.0, 1.0)]
}

/// Ten steps of the host's flow along the axes `live`, and of this one, in a porous space.
fn as_the_host<R: Api + Scalar, const D: usize>(cells: [usize; 3], live: [usize; D], seed: u64) {
    let (lists, state) = (edges::<R>(cells), burst::<R>(cells));
    let (source, count): (_, usize) = (&mut Source::seeded(seed), cells.iter().product());
    let mut fractions = |n: usize| -> Vec<R> { (0..n).map(|_| R::from_f64(source.fraction())).collect() };
    let volume = fractions(count);
    let faces: [Vec<R>; 3] = [0, 1, 2].map(|axis| fractions(count / cells[axis] * (cells[axis] + 1)));
    let gamma = R::from_f64(1.4);
    let case = Case {
        grid: grid(&lists),
        gamma,
        beta_v: volume.as_ptr(),
        beta: faces.each_ref().map(|f| f.as_ptr()),
        gravity: [R::ZERO, R::ZERO, -R::ONE],
        ..zeroed()
    };
    let mut own = Owned::new(&case);
    own.set(&state);

    let widths = live.map(|axis| lists[axis].windows(2).map(|w| w[1] - w[0]).collect());
    let mut host = HostFlow::<R, D>::new(widths, Gas::Ideal { gamma }, [[CoreBoundary::Wall; 2]; D]);
    host.gravity = live.map(|axis| if axis == 2 { -R::ONE } else { R::ZERO });
    host.set_porosity(volume.clone(), live.map(|axis| faces[axis].clone()), Treatment::default()).expect("fractions");
    for cell in 0..count {
        let velocity = live.map(|axis| state[axis + 1][cell]);
        host.set(cell, &Primitive { density: state[0][cell], velocity, pressure: state[4][cell] });
    }
    for _ in 0..10 {
        let dt = R::from_f64(0.5) / host.rate().expect("a rate");
        assert!(own.rate() == host.rate().expect("a rate"));
        let (own, host) = (own.step(dt), host.step(dt).expect("a step"));
        assert!(own.rate == host.rate && own.steps == 1 && own.floored == host.floored as u64);
    }
    let found = own.get();
    for cell in 0..count {
        let w = host.get(cell);
        assert!(found[0][cell] == w.density && found[4][cell] == w.pressure, "cell {cell}");
        for (d, axis) in live.into_iter().enumerate() {
            assert!(found[axis + 1][cell] == w.velocity[d], "cell {cell} axis {axis}");
        }
    }
    let content = host.content();
    let totals = own.totals();
    let near = |a: R, b: R| (a - b).abs() <= R::from_f64(16.0) * R::EPSILON * (R::ONE + b.abs());
    assert!(near(totals[0], content.density) && near(totals[4], content.energy), "{totals:?} {content:?}");
}

#[test]
fn ten_steps_have_the_bits_of_the_host() {
    for seed in 0..3 {
        as_the_host::<f64, 3>([5, 4, 3], [0, 1, 2], seed);
        as_the_host::<f32, 3>([3, 4, 5], [0, 1, 2], seed);
        as_the_host::<f64, 2>([6, 1, 5], [0, 2], seed);
        as_the_host::<f32, 2>([1, 6, 5], [1, 2], seed);
        as_the_host::<f64, 1>([1, 17, 1], [1], seed);
        as_the_host::<f64, 1>([1, 1, 300], [2], seed);
    }
}

#[test]
fn walls_keep_mass_and_energy() {
    let lists = edges::<f64>([8, 6, 5]);
    let mut flow = Owned::new(&Case { grid: grid(&lists), gamma: 1.4, ..zeroed() });
    flow.set(&burst([8, 6, 5]));
    let before = flow.totals();
    let report = flow.advance(0.2, u64::MAX);
    let after = flow.totals();
    assert!(report.time == 0.2 && report.steps > 5 && report.floored == 0, "{report:?}");
    assert!((after[0] - before[0]).abs() < 1e-13 && (after[4] - before[4]).abs() < 1e-12);
    let more = flow.advance(1.0, 3);
    assert!(more.steps == 3 && more.time > 0.2 && more.time < 1.0);
}

/// Gas at rest in a channel takes up the velocity of its inlet, whose pressure follows.
#[test]
fn an_inlet_is_met() {
    for gas in [0, 1, 2] {
        let lists = edges::<f64>([40, 1, 1]);
        let mut case = Case { grid: grid(&lists), gas, gamma: 1.4, sound_speed: 1.2, rho0: 1.0, p0: 1.0, ..zeroed() };
        case.side[0] = Boundary { kind: 4, rho: 1.0, u: [0.1, 0.0, 0.0], p: 1.0, ..zeroed() };
        case.side[1] = Boundary { kind: 5, p: if gas == 1 { 1.44 } else { 1.0 }, ..zeroed() };
        let mut flow = Owned::new(&case);
        flow.set_at_rest();
        let report = flow.advance(60.0, u64::MAX);
        let state = flow.get();
        assert!(state[1].iter().all(|u| (u - 0.1).abs() < 2e-3), "gas {gas}: {:?}", &state[1]);
        assert!(report.inflow[0][0] > 5.0 && report.inflow[1][0] < -5.0, "{report:?}");
    }
}

/// A stream faster than sound into slower gas keeps its state, from either side; so does one that a call sets later.
#[test]
fn an_inlet_faster_than_sound_keeps_its_state() {
    for (number, u) in [(0_usize, 2.4), (1, -2.4)] {
        let lists = edges::<f64>([40, 1, 1]);
        let inlet = Boundary { kind: 4, rho: 1.0, u: [u, 0.0, 0.0], p: 1.0, ..zeroed::<Boundary<f64>>() };
        for later in [false, true] {
            let mut case = Case { grid: grid(&lists), gamma: 1.4, ..zeroed() };
            case.side[1 - number] = Boundary { kind: 2, ..zeroed() };
            case.side[number] = if later { Boundary { kind: 0, ..zeroed() } } else { inlet };
            let mut flow = Owned::new(&case);
            flow.set_at_rest();
            if later {
                assert_eq!(unsafe { f64::flow_set_side(flow.flow, number as i32, &inlet, null_mut()) }, Status::Ok);
            }
            flow.advance(4.0, u64::MAX);
            let [rho, along, .., p] = flow.get();
            let off =
                |values: &[f64], wanted: f64| values.iter().fold(0.0, |most: f64, v| most.max((v - wanted).abs()));
            let worst = [off(&rho, 1.0), off(&along, u), off(&p, 1.0)];
            assert!(worst.iter().all(|&w| w < 1e-6), "side {number}, later {later}: {worst:?}");
        }
    }
}

/// A result that would be written into the flow itself is refused, and the flow stays as it is.
#[test]
fn results_do_not_go_into_the_flow() {
    let lists = edges::<f64>([8, 1, 1]);
    let mut flow = Owned::new(&Case { grid: grid(&lists), gamma: 1.4, ..zeroed() });
    flow.set_at_rest();
    let before = flow.get();
    for offset in [64, 512] {
        let at = unsafe { flow.flow.cast::<u8>().add(offset) };
        let (number, report, mut fault) = (at.cast::<f64>(), at.cast::<StepReport<f64>>(), no_fault());
        let refused =
            |status: Status, fault: &Fault, name: &str| assert_eq!((status, named(fault)), (Status::Overlap, name));
        let status = unsafe { f64::flow_rate(flow.flow, number, &mut fault) };
        refused(status, &fault, "rate");
        let status = unsafe { f64::flow_totals(flow.flow, number, &mut fault) };
        refused(status, &fault, "totals");
        let status = unsafe { f64::flow_step(flow.flow, 1e-3, report, &mut fault) };
        refused(status, &fault, "report");
        let status = unsafe { f64::flow_advance(flow.flow, 1.0, 0.5, 3, report, &mut fault) };
        refused(status, &fault, "report");
    }
    assert_eq!(flow.get(), before);
}

#[test]
fn sides_change_between_steps() {
    let lists = edges::<f64>([1, 1, 20]);
    let mut flow = Owned::new(&Case { grid: grid(&lists), gamma: 1.4, ..zeroed() });
    flow.set_at_rest();
    assert!(flow.advance(0.1, u64::MAX).inflow[5][0] == 0.0);
    let blow = Boundary { kind: 3, rho: 1.0, u: [0.0, 0.0, -0.5], p: 1.5, ..zeroed::<Boundary<f64>>() };
    assert_eq!(unsafe { f64::flow_set_side(flow.flow, 5, &blow, null_mut()) }, Status::Ok);
    assert!(flow.advance(0.2, u64::MAX).inflow[5][0] > 0.01);
    let mut fault = no_fault();
    let periodic = Boundary { kind: 1, ..blow };
    assert_eq!(unsafe { f64::flow_set_side(flow.flow, 5, &periodic, &mut fault) }, Status::Periodic);
    assert_eq!((named(&fault), fault.axis), ("side.kind", 2));
    assert_eq!(unsafe { f64::flow_set_side(flow.flow, 6, &blow, &mut fault) }, Status::Range);
    assert_eq!(unsafe { f64::flow_set_side(flow.flow, 4, &Boundary { rho: -1.0, ..blow }, &mut fault) }, Status::Value);
    assert_eq!((named(&fault), fault.index), ("side.rho", 4));
}

#[test]
fn wrong_cases_are_refused_by_name() {
    let lists = edges::<f64>([4, 3, 1]);
    let good = Case { grid: grid(&lists), gamma: 1.4, ..zeroed() };
    let refused = |case: Case<f64>| {
        let (mut block, mut flow, mut fault) = (vec![0_u8; 1 << 16], null_mut(), no_fault());
        assert_eq!(unsafe { f64::flow_size(&case) }, usize::MAX);
        let status = unsafe { f64::flow_init(&case, block.as_mut_ptr().cast(), block.len(), &mut flow, &mut fault) };
        assert!(flow.is_null());
        (status, named(&fault), fault.axis, fault.index)
    };
    let wall = good.side[0];
    let side = |number: usize, side: Boundary<f64>| {
        let mut case = good;
        case.side[number] = side;
        case
    };
    assert_eq!(refused(Case { gamma: f64::NAN, ..good }), (Status::Value, "case.gamma", -1, 0));
    assert_eq!(refused(Case { gamma: 1.0, ..good }), (Status::Value, "case.gamma", -1, 0));
    assert_eq!(refused(Case { gas: 3, ..good }), (Status::Kind, "case.gas", -1, 0));
    assert_eq!(refused(Case { riemann: -1, ..good }), (Status::Kind, "case.riemann", -1, 0));
    assert_eq!(refused(Case { limiter: 7, ..good }), (Status::Kind, "case.limiter", -1, 0));
    assert_eq!(refused(Case { pressure: i32::MAX, ..good }), (Status::Kind, "case.pressure", -1, 0));
    assert_eq!(refused(Case { jump: -1.0, ..good }), (Status::Value, "case.jump", -1, 0));
    assert_eq!(refused(Case { gravity: [0.0, f64::NAN, 0.0], ..good }), (Status::Value, "case.gravity", -1, 1));
    assert_eq!(refused(side(3, Boundary { kind: 1, ..wall })), (Status::Periodic, "side.kind", 1, 0));
    assert_eq!(refused(side(2, Boundary { kind: 9, ..wall })), (Status::Kind, "side.kind", -1, 2));
    assert_eq!(refused(side(1, Boundary { kind: 5, ..wall })), (Status::Value, "side.p", -1, 1));
    let inlet = Boundary { kind: 4, rho: 1.0, u: [1.0, f64::INFINITY, 0.0], p: 1.0, relax: 0.0 };
    assert_eq!(refused(side(0, inlet)), (Status::Value, "side.u", -1, 0));
    let mut beta = vec![1.0; 12];
    beta[7] = f64::NAN;
    assert_eq!(refused(Case { beta_v: beta.as_ptr(), ..good }), (Status::Value, "case.beta_v", -1, 7));
    beta[7] = 1.0;
    let without_faces = Case { beta_v: beta.as_ptr(), ..good };
    assert_eq!(refused(without_faces), (Status::Null, "case.beta", 0, 0));
    let faces = vec![1.5; 16];
    let beta = [faces.as_ptr(), faces.as_ptr(), null()];
    assert_eq!(refused(Case { beta, ..without_faces }), (Status::Value, "case.beta", 0, 0));
    assert_eq!(
        refused(Case { cr: [null(), faces.as_ptr().wrapping_byte_add(2), null()], ..good }).0,
        Status::Misaligned
    );
    let mut huge = good;
    huge.grid.nx = usize::MAX;
    assert_eq!(refused(huge), (Status::Length, "grid.x", 0, 0));
    huge.grid.nx = usize::MAX / 8;
    assert_eq!(refused(huge), (Status::Length, "grid.x", 0, 0));
    let mut none = good;
    none.grid.nz = 0;
    assert_eq!(refused(none), (Status::Grid, "grid", 2, 0));
}

#[test]
fn states_that_are_none_are_refused() {
    let lists = edges::<f64>([4, 1, 1]);
    let mut flow = Owned::new(&Case { grid: grid(&lists), gamma: 1.4, ..zeroed() });
    let mut fault = no_fault();
    let step = |flow: &mut Owned<f64>, dt, fault: &mut _| unsafe { f64::flow_step(flow.flow, dt, null_mut(), fault) };
    // No state has been set.
    assert_eq!((step(&mut flow, 0.1, &mut fault), fault.index), (Status::Unphysical, 0));
    let (one, mut bad) = (vec![1.0; 4], vec![1.0; 4]);
    for (value, expected) in [(0.0, "rho"), (-1.0, "rho"), (f64::NAN, "rho"), (f64::INFINITY, "rho")] {
        bad[2] = value;
        let status =
            unsafe { f64::flow_set(flow.flow, bad.as_ptr(), null(), null(), null(), one.as_ptr(), &mut fault) };
        assert_eq!((status, named(&fault), fault.index), (Status::Unphysical, expected, 2));
    }
    let status =
        unsafe { f64::flow_set(flow.flow, one.as_ptr(), bad.as_ptr(), null(), null(), one.as_ptr(), &mut fault) };
    assert_eq!((status, named(&fault), fault.index), (Status::Value, "u", 2));
    bad[2] = 1e200;
    let status =
        unsafe { f64::flow_set(flow.flow, one.as_ptr(), bad.as_ptr(), null(), null(), one.as_ptr(), &mut fault) };
    assert_eq!((status, named(&fault), fault.index), (Status::Unphysical, "state", 2));
    let status = unsafe { f64::flow_set(flow.flow, one.as_ptr(), null(), null(), null(), null(), &mut fault) };
    assert_eq!((status, named(&fault)), (Status::Null, "p"));
    flow.set(&[one.clone(), one.clone(), one.clone(), one.clone(), one.clone()]);
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!((step(&mut flow, dt, &mut fault), named(&fault)), (Status::Value, "dt"));
    }
    let advance = |end, cfl, fault: &mut _| unsafe { f64::flow_advance(flow.flow, end, cfl, 9, null_mut(), fault) };
    assert_eq!((advance(f64::NAN, 0.8, &mut fault), named(&fault)), (Status::Value, "end"));
    assert_eq!((advance(1.0, 1.5, &mut fault), named(&fault)), (Status::Value, "cfl"));
    assert_eq!(advance(-1.0, 0.8, &mut fault), Status::Ok);
    assert_eq!(advance(1.0, 1e-300, &mut fault), Status::Ok);
}
