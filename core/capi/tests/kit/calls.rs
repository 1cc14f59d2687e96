//! Calls with arguments made of any bytes: hostile lengths, NaN, null, misaligned and overlapping pointers, short memory. None panics, none
//! writes outside the memory it was given, and what says that it was done has finite results in order.

use super::api::{Api, body, zeroed};
use core::ptr::{null, null_mut};
use voidage_capi::status::Status;
use voidage_capi::types::{
    Beta, Body, Boundary, Case, Distance, Fractions, Grid, Options, PorosityReport, Scene, StepReport, Surface,
};

/// Numbers from bytes; zeros after their end.
pub struct Source<'a>(&'a [u8]);

impl Source<'_> {
    fn byte(&mut self) -> u8 {
        let [first, rest @ ..] = self.0 else { return 0 };
        self.0 = rest;
        *first
    }

    fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// One in eight or so.
    fn rarely(&mut self) -> bool {
        self.byte() > 224
    }

    /// A length near `n`, or one that no memory holds.
    fn length(&mut self, n: usize) -> usize {
        if self.rarely() {
            let most =
                [usize::MAX, usize::MAX / 8, usize::MAX / 9, isize::MAX as usize / 8, 1 << 40, 0, usize::MAX - 1];
            return most[self.below(7)];
        }
        n
    }

    /// A number of any kind; most are plain.
    fn number<R: Api>(&mut self) -> R {
        let byte = self.byte();
        if self.rarely() {
            let wild = [
                f64::NAN,
                f64::INFINITY,
                -f64::INFINITY,
                1e300,
                -1e300,
                1e-300,
                1e38,
                -1e38,
                1e-40,
                0.0,
                -0.0,
                f64::MAX,
            ];
            return R::from_f64(wild[usize::from(byte) % 12]);
        }
        R::from_f64((f64::from(byte) - 64.0) / 64.0)
    }

    fn positive<R: Api>(&mut self) -> R {
        let number: R = self.number();
        if number < R::ZERO && !self.rarely() { R::from_f64(0.25) - number } else { number }
    }

    fn numbers<R: Api>(&mut self, count: usize) -> Vec<R> {
        (0..count).map(|_| self.number()).collect()
    }

    /// A pointer to something, now and then null or not aligned. It stays inside: the array is one entry longer than it is said to be.
    fn pointer<T>(&mut self, first: *mut T) -> *mut T {
        if !self.rarely() {
            return first;
        }
        match self.byte() % 2 {
            0 => null_mut(),
            _ => first.wrapping_byte_add(1),
        }
    }

    fn kind(&mut self, n: usize) -> i32 {
        if self.rarely() { [i32::MIN, -1, 99, i32::MAX][self.below(4)] } else { self.below(n) as i32 }
    }
}

/// Increasing edges, but for now and then one.
fn edges<R: Api>(s: &mut Source) -> Vec<R> {
    let cells = 1 + s.below(4);
    let mut list: Vec<R> = (0..=cells).map(|i| R::from_f64(i as f64 / cells as f64 - 0.25)).collect();
    if s.rarely() {
        let at = s.below(cells + 1);
        list[at] = s.number();
    }
    list.push(R::ZERO);
    list
}

/// One entry more than is said, for a misaligned pointer.
fn grid<R: Api>(s: &mut Source, lists: &[Vec<R>; 3]) -> Grid<R> {
    let cells = lists.each_ref().map(|l| s.length(l.len() - 2));
    let [x, y, z] = lists.each_ref().map(|l| s.pointer(l.as_ptr().cast_mut()).cast_const());
    // A grid that is smaller than its arrays is none that could harm; a larger one must be refused by its length.
    let [nx, ny, nz] =
        [0, 1, 2].map(|a| if cells[a] > 1 << 20 { cells[a] | 1 << 62 } else { cells[a].min(lists[a].len() - 2) });
    Grid { x, y, z, nx, ny, nz }
}

fn any_body<R: Api>(s: &mut Source, points: &[R]) -> Body<R> {
    let numbers: [R; 12] = core::array::from_fn(|_| s.number());
    let mut made = body(s.kind(11), &numbers);
    if made.kind == 9 && !s.rarely() {
        let zero = R::ZERO;
        made.p[3..12].copy_from_slice(&[numbers[3], zero, zero, zero, numbers[4], zero, zero, zero, numbers[5]]);
    }
    if made.kind == 5 {
        made.p[3] = made.p[3].abs();
    }
    made.points = s.pointer(points.as_ptr().cast_mut());
    let count = s.length(s_count(points));
    made.count = if count > points.len() { count | 1 << 61 } else { count };
    made.round = if s.rarely() { s.number() } else { R::ZERO };
    made
}

/// Points in a list of numbers that is one longer.
fn s_count<R>(points: &[R]) -> usize {
    (points.len() - 1) / 3
}

fn bodies<R: Api>(s: &mut Source) {
    let count = 3 * s.below(6) + 1;
    let points = s.numbers(count);
    let (a, b) = (any_body(s, &points), any_body(s, &points));
    let hint: [R; 3] = core::array::from_fn(|_| s.number());
    let hint = if s.rarely() { null() } else { hint.as_ptr() };
    let (mut contact, mut found) = (-1, Distance::default());
    unsafe {
        let told = R::meets(&a, &b, hint, &mut contact, null_mut());
        assert!((told == Status::Ok) == (0..4).contains(&contact), "{told:?} {contact}");
        let told = R::distance(&a, &b, hint, &mut found, null_mut());
        if told == Status::Ok {
            assert!(found.lower <= found.upper && found.distance >= R::ZERO, "{found:?}");
            assert!(contact == 2 || found.contact == 2 || contact == found.contact, "{contact} {found:?}");
        }
    }
}

/// A byte that the library has no reason to write.
const GUARD: u8 = 0x5a;

fn porosity<R: Api>(s: &mut Source) {
    let lists: [Vec<R>; 3] = core::array::from_fn(|_| edges(s));
    let grid = grid(s, &lists);
    let triangles = s.below(12);
    let mut corners: Vec<R> = s.numbers(9 * triangles + 1);
    if s.below(2) == 0 && triangles >= 4 {
        tetrahedron(&mut corners);
    }
    let mut first: Vec<usize> = vec![0, triangles / 2, triangles, 0];
    if s.rarely() {
        let at = s.below(3);
        first[at] = s.length(triangles);
    }
    let sheets = [s.byte() % 2, s.byte() % 2, 0];
    let count = s.length(triangles);
    let surface = Surface {
        corners: s.pointer(corners.as_mut_ptr()),
        triangles: if count > triangles { count | 1 << 60 } else { count },
        first: s.pointer(first.as_mut_ptr()),
        bodies: if s.rarely() { usize::MAX - s.below(3) } else { 2 },
        sheets: if s.rarely() { sheets.as_ptr() } else { null() },
    };
    let solids: Vec<Body<R>> =
        (0..s.below(4)).map(|_| Body { count: 0, round: R::ZERO, ..any_body(s, &[R::ZERO]) }).collect();
    let depth = if s.rarely() { u32::MAX } else { 1 + s.below(2) as u32 };
    let options = Options {
        tol: if s.rarely() { s.number() } else { R::from_f64(0.01) },
        depth: if depth == u32::MAX { 3 } else { depth },
        pieces: if s.rarely() { u32::MAX } else { 1 + s.below(20) as u32 },
        first_layer: if s.rarely() { s.length(1) } else { 0 },
        layers: if s.rarely() { s.length(1) } else { 0 },
    };
    let scene = Scene {
        surface: if s.rarely() { null() } else { &surface },
        solids: solids.as_ptr(),
        solid_count: if s.rarely() { usize::MAX - s.below(3) } else { solids.len() },
    };
    answer(s, &grid, &surface, &scene, &options);
}

/// The first four triangles become a closed surface.
fn tetrahedron<R: Api>(corners: &mut [R]) {
    let points: Vec<[R; 3]> = corners[..12].chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
    for (t, triangle) in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].into_iter().enumerate() {
        for (c, corner) in triangle.into_iter().enumerate() {
            corners[9 * t + 3 * c..][..3].copy_from_slice(&points[corner]);
        }
    }
}

/// Fields of at most 5 × 5 × 5 cells and a little more.
const ROOM: usize = 160;

fn answer<R: Api>(s: &mut Source, grid: &Grid<R>, surface: &Surface<R>, scene: &Scene<R>, options: &Options<R>) {
    let by_scene = s.below(2) == 0;
    let mut sets: Vec<Vec<R>> = vec![vec![R::from_f64(0.5); ROOM]; 12];
    let mut fields = sets.iter_mut().map(|f| f.as_mut_ptr());
    let mut beta = |s: &mut Source, wanted: bool| {
        let mut next = || fields.next().filter(|_| wanted).map_or(null_mut(), |first| s.pointer(first));
        Beta { v: next(), x: next(), y: next(), z: next() }
    };
    let bounds = s.below(2) == 0;
    let mut fractions = Fractions { value: beta(s, true), lower: beta(s, bounds), upper: beta(s, bounds) };
    if s.rarely() {
        fractions.lower.v = fractions.value.x;
    }
    let mut report = PorosityReport::default();
    unsafe {
        let needed =
            if by_scene { R::scene_work(grid, scene, options) } else { R::surface_work(grid, surface, options) };
        let bytes = if s.rarely() { s.length(needed) } else { needed };
        // Memory as large as said, but for a block that no machine has; there the call must refuse.
        let held = needed.min(bytes).min(1 << 22);
        if needed > held && bytes >= needed && needed != usize::MAX {
            return;
        }
        let shift = s.below(16);
        let mut work = vec![GUARD; held + 64];
        let start = work.as_mut_ptr().wrapping_add(shift).cast();
        let told = if by_scene {
            R::scene_porosity(grid, scene, options, &fractions, start, bytes, &mut report, null_mut())
        } else {
            R::surface_porosity(grid, surface, options, &fractions, start, bytes, &mut report, null_mut())
        };
        assert!(work[..shift].iter().chain(&work[held + shift..]).all(|&b| b == GUARD), "work of {held}");
        if told == Status::Ok {
            let (zero, one) = (R::ZERO, R::ONE);
            assert!(sets.iter().flatten().all(|&b| zero <= b && b <= one), "{report:?} {:?}", sets);
        }
    }
}

fn boundary<R: Api>(s: &mut Source) -> Boundary<R> {
    let kind = s.kind(7);
    Boundary { kind, rho: s.positive(), u: core::array::from_fn(|_| s.number()), p: s.positive(), relax: s.positive() }
}

fn flow<R: Api>(s: &mut Source) {
    let lists: [Vec<R>; 3] = core::array::from_fn(|_| edges(s));
    let grid = grid(s, &lists);
    let fraction = |s: &mut Source| -> Vec<R> {
        let wild = s.rarely();
        (0..ROOM).map(|_| if wild { s.number() } else { R::from_f64((s.byte() % 5) as f64 / 4.0) }).collect()
    };
    let fields: [Vec<R>; 4] = core::array::from_fn(|_| fraction(s));
    let porous = s.below(2) == 0;
    let array = |s: &mut Source, n: usize, wanted: bool| {
        if wanted { s.pointer(fields[n].as_ptr().cast_mut()).cast_const() } else { null() }
    };
    let mut case = Case {
        grid,
        gas: s.kind(3),
        gamma: R::from_f64(1.4),
        sound_speed: s.positive(),
        rho0: s.positive(),
        p0: s.positive(),
        side: core::array::from_fn(|_| boundary(s)),
        beta_v: array(s, 0, porous),
        beta: [array(s, 1, porous), array(s, 2, porous), array(s, 3, porous)],
        jump: if s.rarely() { s.number() } else { R::ZERO },
        gravity: core::array::from_fn(|_| s.number()),
        cr: [array(s, 1, porous), null(), array(s, 2, porous)],
        linear: [null(), array(s, 1, porous), null()],
        riemann: s.kind(4),
        limiter: s.kind(7),
        pressure: s.kind(2),
    };
    for axis in 0..3 {
        let periodic = case.side[2 * axis].kind == 1 || case.side[2 * axis + 1].kind == 1;
        if periodic && !s.rarely() {
            (case.side[2 * axis].kind, case.side[2 * axis + 1].kind) = (1, 1);
        }
    }
    let bytes = unsafe { R::flow_size(&case) };
    let held = bytes.min(1 << 22);
    let mut block = vec![GUARD; held + 64];
    let (shift, mut handle) = (s.below(16), null_mut());
    let start = block.as_mut_ptr().wrapping_add(shift);
    let given = if s.rarely() { held / 2 } else { held };
    let told = unsafe { R::flow_init(&case, start.cast(), given, &mut handle, null_mut()) };
    assert_eq!(told == Status::Ok, !handle.is_null());
    if told == Status::Ok {
        steps(s, handle);
    }
    assert!(block[..shift].iter().chain(&block[held + shift..]).all(|&b| b == GUARD), "block of {held}");
}

fn steps<R: Api>(s: &mut Source, flow: *mut voidage_capi::Flow<R>) {
    let mut fields: [Vec<R>; 5] =
        core::array::from_fn(|n| (0..ROOM).map(|_| if n % 4 == 0 { s.positive() } else { s.number() }).collect());
    let [rho, u, v, w, p] = fields.each_mut().map(|f| s.pointer(f.as_mut_ptr()));
    let mut report = StepReport::default();
    unsafe {
        R::flow_set(flow, rho, u, v, w, p, null_mut());
        for _ in 0..1 + s.below(4) {
            match s.below(5) {
                0 => {
                    R::flow_step(flow, s.positive(), &mut report, null_mut());
                }
                1 => {
                    let side = boundary(s);
                    R::flow_set_side(flow, s.kind(6), &side, null_mut());
                }
                2 => {
                    let mut totals: [R; 5] = zeroed();
                    R::flow_totals(flow, totals.as_mut_ptr(), null_mut());
                }
                _ => {
                    R::flow_advance(flow, s.number(), R::from_f64(0.8), s.below(4) as u64, &mut report, null_mut());
                }
            }
        }
        R::flow_get(flow, rho, u, v, w, p, null_mut());
    }
}

/// Some calls.
pub fn any_calls<R: Api>(bytes: &[u8]) {
    let s = &mut Source(bytes);
    match s.byte() % 3 {
        0 => bodies::<R>(s),
        1 => porosity::<R>(s),
        _ => flow::<R>(s),
    }
}
