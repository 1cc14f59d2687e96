//! What passes through the interface. All structs are zero by default: set them to zero, then the fields that matter.

/// Edges of a rectilinear grid. `nx`, `ny`, `nz` are numbers of cells; `x` has `nx + 1` edges, strictly increasing and finite, and so on.
/// Arrays over a grid are stored with x fastest: cell (i, j, k) is entry (k*ny + j)*nx + i, as `a(nx,ny,nz)` in Fortran. Arrays over faces are
/// one longer along their own axis: x faces (k*ny + j)*(nx+1) + i, y faces (k*(ny+1) + j)*nx + i, z faces (k*ny + j)*nx + i.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Grid<R> {
    /// `nx + 1` edges along x.
    pub x: *const R,
    /// `ny + 1` edges along y.
    pub y: *const R,
    /// `nz + 1` edges along z.
    pub z: *const R,
    /// Cells along x.
    pub nx: usize,
    /// Cells along y.
    pub ny: usize,
    /// Cells along z.
    pub nz: usize,
}

/// Bodies of triangles, in the frame and unit of the grid. Corners run counter-clockwise seen from outside, and a body's surface should be
/// closed; how far it is not, the report tells. Bodies may overlap: what they share counts once.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Surface<R> {
    /// Nine numbers a triangle: x, y, z of its three corners.
    pub corners: *const R,
    /// Number of triangles.
    pub triangles: usize,
    /// Body b has the triangles `first[b]` up to but not including `first[b + 1]`: `bodies + 1` entries, not decreasing. Null: all triangles
    /// are one body.
    pub first: *const usize,
    /// Number of bodies; does not count if `first` is null.
    pub bodies: usize,
    /// One entry a body: not zero for a sheet without volume, both sides of it given as triangles, which blocks the faces in whose plane it lies.
    /// Null: there are none.
    pub sheets: *const u8,
}

/// Choices. Zeros stand for the usual ones.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Options<R> {
    /// Cells that bodies share are divided until their bounds are this close, unless a proof is found at once; 0 stands for 1e-4.
    pub tol: R,
    /// How often such a cell may be halved along each axis; 0 stands for 6.
    pub depth: u32,
    /// Pieces of triangles in one cell for which an exact union is attempted; 0 stands for 1024, which takes about 4 MB of work in double
    /// precision. It costs nothing where there is one body.
    pub pieces: u32,
    /// The first layer of cells to compute.
    pub first_layer: usize,
    /// How many layers; 0 stands for all from `first_layer` on.
    pub layers: usize,
}

/// Arrays for open fractions: 1 open, 0 blocked. `x`, `y` and `z` are those of faces; all three are null if faces are not wanted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Beta<R> {
    /// Cells.
    pub v: *mut R,
    /// Faces normal to x.
    pub x: *mut R,
    /// Faces normal to y.
    pub y: *mut R,
    /// Faces normal to z.
    pub z: *mut R,
}

/// Where open fractions go. The arrays hold the layers asked for: with `layers` = n they are those of a grid of n layers, but without the z
/// faces above them unless these are the highest of the grid.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Fractions<R> {
    /// The fractions, in the middle of their bounds.
    pub value: Beta<R>,
    /// Lower bounds of the same; all null if bounds are not wanted.
    pub lower: Beta<R>,
    /// Upper bounds of the same.
    pub upper: Beta<R>,
}

/// What was found.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct PorosityReport<R> {
    /// Volume of the union of all bodies inside the grid (or inside the layers asked for).
    pub solid_volume: R,
    /// Largest distance between the bounds of any cell or face. What is left of it after rounding comes from cells that bodies share.
    pub max_gap: R,
    /// The worst hole of any surface, as a share of the area of a face: a row of cells behind it is wrong by so much. Rounding is below 1e-9.
    pub leak: R,
    /// By how much a body's own share of a cell left 0 to 1 at worst: surfaces that cross themselves or are turned inside out.
    pub winding: R,
    /// The body with the worst hole.
    pub leaky_body: usize,
    /// Cells without solid.
    pub open: usize,
    /// Cells partly solid, or with surface inside.
    pub cut: usize,
    /// Cells all solid.
    pub closed: usize,
    /// Of the cut cells, those whose union had to be found.
    pub shared: usize,
    /// Of these, those divided because no proof was found at once.
    pub divided: usize,
    /// Queries of GJK.
    pub queries: u64,
    /// Of these, the undecided ones, which cost work, never truth.
    pub undecided: u64,
}

/// A kind of convex body, and what `p` holds. Points are x, y, z.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `p[0..3]` the point.
    Point = 0,
    /// `p[0..3]`, `p[3..6]` the ends.
    Segment = 1,
    /// `p[0..3]`, `p[3..6]`, `p[6..9]` the corners.
    Triangle = 2,
    /// `p[0..3]` the lowest corner, `p[3..6]` the highest: a box along the axes.
    Box = 3,
    /// The convex hull of `points`.
    Hull = 4,
    /// `p[0..3]` the centre, `p[3]` the radius.
    Sphere = 5,
    /// `p[0..3]`, `p[3..6]` the ends of the core, `p[6]` the radius.
    Capsule = 6,
    /// `p[0..3]`, `p[3..6]` the centres of the flat ends, `p[6]` the radius.
    Cylinder = 7,
    /// `p[0..3]` the centre of the base, `p[3..6]` the apex, `p[6]` the radius of the base.
    Cone = 8,
    /// `p[0..3]` the centre, `p[3..6]`, `p[6..9]`, `p[9..12]` the half axes, at right angles.
    Ellipsoid = 9,
    /// `p[0..3]` the centre, `p[3..6]`, `p[6..9]`, `p[9..12]` from the centre to the middle of three faces.
    OrientedBox = 10,
    /// `p[0..3]` the centre of the base, `p[3..6]` that of the top, `p[6]` the radius of the base, `p[7]` that of the top.
    TruncatedCone = 11,
}

/// A convex body.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Body<R> {
    /// One of `vdg_kind`.
    pub kind: i32,
    /// Its numbers, as the kind says.
    pub p: [R; 12],
    /// Of a hull: three numbers a point.
    pub points: *const R,
    /// Of a hull: how many points.
    pub count: usize,
    /// All points within this distance of the body belong to it; 0 for the body itself.
    pub round: R,
}

/// Bodies of triangles, and solids known by formula: sphere, capsule, cylinder, cone whole or truncated, ellipsoid, not rounded.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Scene<R> {
    /// The triangles; null: there are none.
    pub surface: *const Surface<R>,
    /// The solids.
    pub solids: *const Body<R>,
    /// How many solids.
    pub solid_count: usize,
}

/// How two bodies lie.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// No point is shared, by proof.
    Apart = 0,
    /// An inner point is shared, by proof.
    Overlapping = 1,
    /// Rounding hides it. Never told of bodies given by points: point, segment, triangle, box, hull.
    Undecided = 2,
    /// Points are shared, but no inner one, by proof. Told only of bodies given by points.
    Touching = 3,
}

/// How far apart two bodies are.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Distance<R> {
    /// One of `vdg_contact`.
    pub contact: i32,
    /// The distance; 0 unless they are apart.
    pub distance: R,
    /// The true distance is not less than this.
    pub lower: R,
    /// The true distance is not more than this; infinite if nothing is known.
    pub upper: R,
    /// The point of the first body that is nearest to the second, if they are apart.
    pub a: [R; 3],
    /// The point of the second body that is nearest to the first, if they are apart.
    pub b: [R; 3],
}

/// What stands outside a side of the domain.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// A wall without friction.
    Wall = 0,
    /// The opposite side; must stand on both.
    Periodic = 1,
    /// The same state as inside.
    ZeroGradient = 2,
    /// A given state `rho`, `u`, `p`; waves leave.
    FarField = 3,
    /// Gas enters with `rho` and `u`. The pressure starts at `p` and follows the flow within the time `relax`, so that waves still leave.
    /// An inlet faster than its own sound keeps its pressure.
    Inlet = 4,
    /// Gas leaves against the pressure `p`.
    Outlet = 5,
    /// Gas enters from rest, where density and pressure are `rho` and `p`.
    Reservoir = 6,
}

/// A side of the domain. Of a gas without energy equation the pressure follows from `rho`, except that an outlet is given by `p`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Boundary<R> {
    /// One of `vdg_side`.
    pub kind: i32,
    /// Density.
    pub rho: R,
    /// Velocity along x, y, z.
    pub u: [R; 3],
    /// Pressure.
    pub p: R,
    /// Of an inlet: the time in which the pressure follows; 0 stands for the time that sound takes through the domain.
    pub relax: R,
}

/// Where the pressure comes from.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gas {
    /// p = (gamma - 1) rho e, with an energy equation; needs `gamma`.
    Ideal = 0,
    /// p = c^2 rho; needs `sound_speed`.
    Isothermal = 1,
    /// p = p0 (rho/rho0)^gamma; needs `gamma`, `rho0`, `p0`.
    Isentropic = 2,
}

/// Riemann solver at the faces.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Riemann {
    /// Three waves.
    Hllc = 0,
    /// Two waves.
    Hlle = 1,
    /// One speed.
    Rusanov = 2,
    /// Three waves, softened where the gas is slow and no sound passes, so that slow vortices live; along one axis as HLLC.
    HllcLowMach = 3,
}

/// Limiter of the slopes.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limiter {
    /// The usual one: monotonised central, and a steeper slope for the part of the density that is no sound, so that contacts stay sharp.
    Steep = 0,
    /// Monotonised central.
    MonotonizedCentral = 1,
    /// The harmonic mean of van Leer.
    VanLeer = 2,
    /// The smaller of the two one-sided slopes.
    Minmod = 3,
    /// The central slope as it is; for smooth flow only.
    Unlimited = 4,
    /// First order.
    FirstOrder = 5,
    /// Sound by its waves, as far as the Courant number of each allows (Arora and Roe); the rest as by the usual one.
    AroraRoe = 6,
}

/// How the pressure acts in a cell whose faces are not as open as its volume.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressure {
    /// On the open faces, and the cell's own pressure on the walls inside it.
    Geometric = 0,
    /// -beta_v grad p.
    Paper = 1,
}

/// A flow, before it starts. An axis of one cell is dead: nothing moves along it. All arrays are copied.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Case<R> {
    /// The grid.
    pub grid: Grid<R>,
    /// One of `vdg_gas`.
    pub gas: i32,
    /// Ratio of specific heats, above 1.
    pub gamma: R,
    /// Speed of sound of an isothermal gas.
    pub sound_speed: R,
    /// Density of the reference state of an isentropic gas.
    pub rho0: R,
    /// Pressure of the reference state of an isentropic gas.
    pub p0: R,
    /// x low, x high, y low, y high, z low, z high.
    pub side: [Boundary<R>; 6],
    /// Open fractions of the cells, 0 to 1; null: all is open.
    pub beta_v: *const R,
    /// Open fractions of the faces normal to x, y, z; needed with `beta_v` along axes that are not dead.
    pub beta: [*const R; 3],
    /// Differences of open area above this share of the wider duct, at one face or over many in a row, are jumps, and conserve total pressure; 0 stands for 0.1, infinity for none.
    pub jump: R,
    /// Acceleration along x, y, z.
    pub gravity: [R; 3],
    /// Quadratic drag of the cells along x, y, z, 1/length: the force is -rho/2 cr |u| u. Null: none along that axis.
    pub cr: [*const R; 3],
    /// Linear drag of the cells along x, y, z, 1/time: the force is -rho a u. Null: none along that axis.
    pub linear: [*const R; 3],
    /// One of `vdg_riemann`.
    pub riemann: i32,
    /// One of `vdg_limiter`.
    pub limiter: i32,
    /// One of `vdg_pressure`.
    pub pressure: i32,
}

/// What a step did; of several steps sums, and the last `dt` and `rate`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct StepReport<R> {
    /// Time reached since the flow began.
    pub time: R,
    /// The step taken.
    pub dt: R,
    /// Largest signal rate of the new state; the next stable step is a CFL number (0.8, say) over it.
    pub rate: R,
    /// Steps done.
    pub steps: u64,
    /// Steps repeated with half the time because they would have needed floors.
    pub repeated: u64,
    /// Cells whose reconstruction fell back to first order.
    pub first_order: u64,
    /// Cells whose density or pressure had to be raised to a floor: such a flow is not to be relied on.
    pub floored: u64,
    /// What came in through each side (x low, x high, y low, ...): mass, momentum along x, y, z, energy.
    pub inflow: [[R; 5]; 6],
}
