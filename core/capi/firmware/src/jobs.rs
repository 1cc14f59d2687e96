//! What is computed on the host and on the microcontroller, in both precisions: each job gives a hash of the bits of its results.

use crate::api::Api;
use core::ptr::{null, null_mut};
use voidage_capi::status::Status;
use voidage_capi::types::{Beta, Body, Boundary, Case, Distance, Fractions, Grid, Options, Scene, StepReport, Surface};

const CELLS: [usize; 3] = [12, 6, 6];
const COUNT: usize = CELLS[0] * CELLS[1] * CELLS[2];

/// All memory that the jobs take.
pub struct Memory<R> {
    edges: [[R; 13]; 3],
    corners: [[R; 9]; 12],
    beta: [[R; 13 * 36 + 72]; 4],
    state: [[R; COUNT]; 5],
    points: [R; 24],
    case: Case<R>,
    report: StepReport<R>,
    /// Work of the calls.
    pub work: [u64; 32 << 10],
}

/// One number for all bits.
#[derive(Clone, Copy)]
pub struct Hash(pub u64);

impl Hash {
    fn mix(&mut self, bits: u64) {
        self.0 = self.0.rotate_left(7) ^ bits;
    }

    #[inline(never)]
    fn values<R: Api>(&mut self, values: &[R]) {
        values.iter().for_each(|value| self.mix(value.bits()));
    }
}

fn zeroed<T: Copy>() -> T {
    // The structs of the interface hold numbers and pointers only.
    unsafe { core::mem::zeroed() }
}

/// Equal bits everywhere: 24 of them, which either precision holds exactly.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// In [-1, 1).
    fn number<R: Api>(&mut self) -> R {
        R::from_f64((self.bits() >> 40) as f64 / f64::from(1 << 23) - 1.0)
    }
}

/// A body of a kind.
fn any_body<R: Api>(random: &mut Random, kind: i32, points: &mut [R]) -> Body<R> {
    let mut body: Body<R> = zeroed();
    body.kind = kind;
    body.p.iter_mut().for_each(|p| *p = random.number());
    let quarter = R::from_f64(0.25);
    match kind {
        3 => (0..3).for_each(|a| body.p[a + 3] = body.p[a] + quarter),
        4 => {
            points.iter_mut().for_each(|p| *p = random.number());
            (body.points, body.count) = (points.as_ptr(), points.len() / 3);
        }
        5 => body.p[3] = quarter,
        6..=8 => body.p[6] = quarter,
        9 => {
            let axes = [body.p[3].abs(), body.p[4].abs(), body.p[5].abs()];
            body.p[3..].fill(R::ZERO);
            (0..3).for_each(|a| body.p[3 + 4 * a] = axes[a] + quarter);
        }
        _ => {}
    }
    body
}

/// 600 queries whether two bodies meet, and 200 distances, of all kinds.
pub fn gjk<R: Api>(memory: &mut Memory<R>) -> Hash {
    let (mut random, mut hash) = (Random(0x9e37_79b9_7f4a_7c15), Hash(0));
    let (left, right) = memory.points.split_at_mut(12);
    for n in 0..800_u32 {
        let a = any_body(&mut random, (n % 11) as i32, left);
        let mut b = any_body(&mut random, (n / 11 % 11) as i32, right);
        let shift = [R::ZERO, R::ONE, R::TWO][n as usize % 3];
        match b.kind {
            4 => right.iter_mut().step_by(3).for_each(|x| *x += shift),
            9 | 10 | 0 | 5 => b.p[0] += shift,
            2 => [0, 3, 6].into_iter().for_each(|n| b.p[n] += shift),
            _ => [0, 3].into_iter().for_each(|n| b.p[n] += shift),
        }
        if n < 600 {
            let mut contact = -1;
            hash.mix(unsafe { R::meets(&a, &b, null(), &mut contact, null_mut()) } as u64);
            hash.mix(contact as u64);
        } else {
            let mut found = Distance::default();
            hash.mix(unsafe { R::distance(&a, &b, null(), &mut found, null_mut()) } as u64);
            hash.mix(found.contact as u64);
            hash.values(&[found.distance, found.lower, found.upper]);
            hash.values(&found.a);
            hash.values(&found.b);
        }
    }
    hash
}

/// Pairs that touch, or nearly do: rounding cannot tell, exact arithmetic does.
pub fn exact<R: Api>(_: &mut Memory<R>) -> Hash {
    let mut hash = Hash(0);
    let third = R::ONE / R::from_f64(3.0);
    let body = |kind, numbers: &[R]| {
        let mut body: Body<R> = zeroed();
        body.kind = kind;
        body.p[..numbers.len()].copy_from_slice(numbers);
        body
    };
    let (zero, one, two) = (R::ZERO, R::ONE, R::TWO);
    let cube = body(3, &[zero, zero, zero, one, one, one]);
    let others = [
        body(3, &[one, zero, zero, two, one, one]),
        body(3, &[one, one, one, two, two, two]),
        body(2, &[one, zero, third, one, one, third, two, third, third]),
        body(1, &[two, zero, zero, zero, two, two]),
        body(0, &[third + third, third, one]),
    ];
    for other in &others {
        let mut contact = -1;
        hash.mix(unsafe { R::meets(&cube, other, null(), &mut contact, null_mut()) } as u64);
        hash.mix(contact as u64);
    }
    hash
}

impl<R: Api> Memory<R> {
    fn grid(&mut self) -> Grid<R> {
        for edges in &mut self.edges {
            edges.iter_mut().enumerate().for_each(|(i, edge)| *edge = R::from_f64(0.25 * i as f64));
        }
        let [x, y, z] = self.edges.each_ref().map(|edges| edges.as_ptr());
        Grid { x, y, z, nx: CELLS[0], ny: CELLS[1], nz: CELLS[2] }
    }

    fn fractions(&mut self) -> Fractions<R> {
        let [v, x, y, z] = self.beta.each_mut().map(|field| field.as_mut_ptr());
        let none = Beta { v: null_mut(), x: null_mut(), y: null_mut(), z: null_mut() };
        Fractions { value: Beta { v, x, y, z }, lower: none, upper: none }
    }

    #[inline(never)]
    fn beta_hash(&self, status: Status, hash: &mut Hash) {
        hash.mix(status as u64);
        let [nx, ny, nz] = CELLS;
        let lengths = [COUNT, (nx + 1) * ny * nz, nx * (ny + 1) * nz, nx * ny * (nz + 1)];
        for (field, length) in self.beta.iter().zip(lengths) {
            hash.values(&field[..length]);
        }
    }

    #[inline(never)]
    fn cuboid(&mut self) -> Surface<R> {
        const OF: [[usize; 3]; 12] = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let (low, high) = ([0.8, 0.35, 0.35], [1.6, 1.1, 1.1]);
        for (triangle, of) in self.corners.iter_mut().zip(OF) {
            for (corner, n) in triangle.chunks_mut(3).zip(of) {
                (0..3).for_each(|a| corner[a] = R::from_f64(if n >> a & 1 == 1 { high[a] } else { low[a] }));
            }
        }
        Surface { corners: self.corners[0].as_ptr(), triangles: 12, first: null(), bodies: 0, sheets: null() }
    }
}

/// A box of twelve triangles in 12 × 6 × 6 cells.
pub fn porosity<R: Api>(memory: &mut Memory<R>) -> Hash {
    let (grid, surface, fractions) = (memory.grid(), memory.cuboid(), memory.fractions());
    let (work, bytes) = (memory.work.as_mut_ptr().cast(), size_of_val(&memory.work));
    let status =
        unsafe { R::surface_porosity(&grid, &surface, null(), &fractions, work, bytes, null_mut(), null_mut()) };
    let mut hash = Hash(0);
    memory.beta_hash(status, &mut hash);
    hash
}

/// Two balls that overlap, by formula, and by sections where they share cells.
pub fn balls<R: Api>(memory: &mut Memory<R>) -> Hash {
    let (grid, fractions) = (memory.grid(), memory.fractions());
    let solids = [1.1, 1.9].map(|x| {
        let mut body: Body<R> = zeroed();
        body.kind = 5;
        body.p[..4].copy_from_slice(&[x, 0.7, 0.8, 0.5].map(R::from_f64));
        body
    });
    let scene = Scene { surface: null(), solids: solids.as_ptr(), solid_count: 2 };
    let options = Options { tol: R::from_f64(1e-3), depth: 3, pieces: 4, ..zeroed() };
    let (work, bytes) = (memory.work.as_mut_ptr().cast(), size_of_val(&memory.work));
    let status = unsafe { R::scene_porosity(&grid, &scene, &options, &fractions, work, bytes, null_mut(), null_mut()) };
    let mut hash = Hash(0);
    memory.beta_hash(status, &mut hash);
    hash
}

/// A ball by subdivision alone, by the functions of the core.
pub fn subdivision<R: Api>(memory: &mut Memory<R>) -> Hash {
    use voidage_core::convex::shape::Sphere;
    use voidage_core::grid::{Grid, cell_range::CellRange, cell_range::RangeKind};
    use voidage_core::number::real::Vector;
    use voidage_core::subdivide::{Candidate, LeafRule, SubdivisionMemory, SubdivisionRule, subdivide};

    let mut hash = Hash(0);
    memory.grid();
    let [x, y, z] = &memory.edges;
    let Ok(grid) = Grid::new(x, &y[..7], &z[..7]) else { return hash };
    let ball = Sphere { center: R::Vector::from_array([1.1, 0.7, 0.8].map(R::from_f64)), radius: R::HALF };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 3, tol: R::from_f64(1e-3) };
    let mut lists = SubdivisionMemory { candidates: &mut [Candidate::default(); 8], facets: &mut [0; 8] };
    for kind in [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)] {
        let all = CellRange::all(&grid, kind);
        let found =
            subdivide(&grid, kind, all, &[ball], rule, &mut lists, |_, share| hash.values(&[share.lower, share.upper]));
        hash.mix(found.map_or(0, |count| count.queries as u64));
    }
    hash
}

/// 100 steps of gas around the box, in three dimensions.
pub fn flow<R: Api>(memory: &mut Memory<R>) -> Hash {
    let mut hash = porosity(memory);
    let grid = memory.grid();
    let [v, x, y, z] = memory.beta.each_ref().map(|field| field.as_ptr());
    let case = &mut memory.case;
    case.grid = grid;
    case.gamma = R::from_f64(1.4);
    (case.beta_v, case.beta) = (v, [x, y, z]);
    let u = [R::HALF, R::ZERO, R::ZERO];
    case.side[0] = Boundary { kind: 3, rho: R::ONE, u, p: R::ONE, relax: R::ZERO };
    case.side[1] = Boundary { kind: 5, p: R::ONE, ..zeroed() };
    memory.state[0].fill(R::ONE);
    let one = memory.state[0].as_ptr();
    let (work, bytes) = (memory.work.as_mut_ptr().cast(), size_of_val(&memory.work));
    let (mut handle, mut rate) = (null_mut(), R::ZERO);
    unsafe {
        hash.mix(R::flow_init(&memory.case, work, bytes, &mut handle, null_mut()) as u64);
        hash.mix(R::flow_set(handle, one, null(), null(), null(), one, null_mut()) as u64);
        hash.mix(R::flow_rate(handle, &mut rate, null_mut()) as u64);
        for _ in 0..100 {
            hash.mix(R::flow_step(handle, R::HALF / rate, &mut memory.report, null_mut()) as u64);
            rate = memory.report.rate;
        }
        let [rho, u, v, w, p] = memory.state.each_mut().map(|field| field.as_mut_ptr());
        hash.mix(R::flow_get(handle, rho, u, v, w, p, null_mut()) as u64);
    }
    memory.state.iter().for_each(|field| hash.values(field));
    hash
}

/// A job by its name.
pub type Job<R> = (&'static str, fn(&mut Memory<R>) -> Hash);

/// All jobs.
pub const fn all<R: Api>() -> [Job<R>; 6] {
    [
        ("gjk", gjk),
        ("exact", exact),
        ("porosity", porosity),
        ("balls", balls),
        ("subdivision", subdivision),
        ("flow", flow),
    ]
}
