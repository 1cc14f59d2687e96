/* voidage: porosity of geometry on structured grids, convex bodies, and flow of gas through porous space.
 *
 * Every function is there twice: vdg_... works on double, vdgf_... on float.
 *
 * Memory is the caller's. No function allocates, prints, keeps a pointer (but for a flow, which lives in the block it was made in), or has
 * global state. Functions named ..._work and ..._size tell how many bytes the call with the same arguments needs; alignment is seen to
 * inside. Different threads may call with different memory; one flow is for one thread at a time.
 *
 * All structs may begin as zeros: zero stands for the usual choice, a null array for one that is not given or not wanted.
 *
 * A call answers with a status, 0 if it did what was asked. What is wrong with its arguments is told, not computed with: null or misaligned
 * pointers, lengths of any size, arrays that overlap, NaN and infinities, kinds and sides that do not exist, memory that is too small. A
 * pointer to a vdg_fault, if one is given, learns where. Only this is not seen: a pointer that is not null, but not the caller's either,
 * or that points at fewer numbers than it should.
 *
 * Fields over a grid are stored with x fastest, as Fortran does: see vdg_grid. Lengths are in the caller's unit throughout.
 * p[3..6] stands for p[3], p[4] and p[5]. Bodies, cells, axes and sides count from 0.
 *
 * This file is made from the sources of the library: do not edit it. */

#ifndef VOIDAGE_H
#define VOIDAGE_H

#include <stddef.h>
#include <stdint.h>

/* Version of the header: 10000 major + 100 minor + patch. */
#define VDG_VERSION 100

/* What a call answers: 0 if it did what was asked, else why not. A call that refuses has written no results. Numbers are only ever added.
 * vdg_status_text has a sentence for each. */
typedef int32_t vdg_status;
enum {
  /* Done. */
  VDG_STATUS_OK = 0,
  /* A pointer is null that must not be. argument names it. */
  VDG_STATUS_NULL = 1,
  /* A pointer is not aligned as its type asks. argument names it. */
  VDG_STATUS_MISALIGNED = 2,
  /* A number of entries is larger than memory can hold, or does not fit another one. argument names it; index is the entry at fault,
   * if it is one. */
  VDG_STATUS_LENGTH = 3,
  /* An array to be written overlaps another one. argument names it. */
  VDG_STATUS_OVERLAP = 4,
  /* The memory is too small. needed is the number of bytes that would do. */
  VDG_STATUS_MEMORY = 5,
  /* Edges are no grid: fewer than two, not finite, not increasing, or cells too small or too large to compute with. axis and index name
   * the edge; -1 for the axis means the grid as a whole. */
  VDG_STATUS_GRID = 6,
  /* A number is NaN, infinite or out of its range. argument names the array or field; index is the triangle, cell, face, body or side. */
  VDG_STATUS_VALUE = 7,
  /* A kind (of body, side, gas, scheme, ...) has no such number. argument names it; index is the body or side. */
  VDG_STATUS_KIND = 8,
  /* A body is none: no point, a negative radius, axes that are not at right angles, or too far away to compute with. index is the body. */
  VDG_STATUS_BODY = 9,
  /* An axis is periodic on one side only. axis names it. */
  VDG_STATUS_PERIODIC = 10,
  /* Density or pressure of a cell is not positive and finite, so that no step can be taken. index is the cell. */
  VDG_STATUS_UNPHYSICAL = 11,
  /* This is no flow that vdg_flow_init made, or one of the other precision. */
  VDG_STATUS_HANDLE = 12,
  /* There is no such layer, side or number of layers. argument names it. */
  VDG_STATUS_RANGE = 13,
  /* The time step is too small to move the time on. */
  VDG_STATUS_STALLED = 14,
  /* Sizes beyond what 32-bit counts in the library can hold: more than 4e9 bodies, triangles or entries, or 2e9 cells of a flow. */
  VDG_STATUS_TOO_MANY = 15,
};

/* A kind of convex body, and what p holds. Points are x, y, z. */
typedef int32_t vdg_kind;
enum {
  /* p[0..3] the point. */
  VDG_KIND_POINT = 0,
  /* p[0..3], p[3..6] the ends. */
  VDG_KIND_SEGMENT = 1,
  /* p[0..3], p[3..6], p[6..9] the corners. */
  VDG_KIND_TRIANGLE = 2,
  /* p[0..3] the lowest corner, p[3..6] the highest: a box along the axes. */
  VDG_KIND_BOX = 3,
  /* The convex hull of points. */
  VDG_KIND_HULL = 4,
  /* p[0..3] the centre, p[3] the radius. */
  VDG_KIND_SPHERE = 5,
  /* p[0..3], p[3..6] the ends of the core, p[6] the radius. */
  VDG_KIND_CAPSULE = 6,
  /* p[0..3], p[3..6] the centres of the flat ends, p[6] the radius. */
  VDG_KIND_CYLINDER = 7,
  /* p[0..3] the centre of the base, p[3..6] the apex, p[6] the radius of the base. */
  VDG_KIND_CONE = 8,
  /* p[0..3] the centre, p[3..6], p[6..9], p[9..12] the half axes, at right angles. */
  VDG_KIND_ELLIPSOID = 9,
  /* p[0..3] the centre, p[3..6], p[6..9], p[9..12] from the centre to the middle of three faces. */
  VDG_KIND_ORIENTED_BOX = 10,
  /* p[0..3] the centre of the base, p[3..6] that of the top, p[6] the radius of the base, p[7] that of the top. */
  VDG_KIND_TRUNCATED_CONE = 11,
};

/* How two bodies lie. */
typedef int32_t vdg_contact;
enum {
  /* No point is shared, by proof. */
  VDG_CONTACT_APART = 0,
  /* An inner point is shared, by proof. */
  VDG_CONTACT_OVERLAPPING = 1,
  /* Rounding hides it. Never told of bodies given by points: point, segment, triangle, box, hull. */
  VDG_CONTACT_UNDECIDED = 2,
  /* Points are shared, but no inner one, by proof. Told only of bodies given by points. */
  VDG_CONTACT_TOUCHING = 3,
};

/* What stands outside a side of the domain. */
typedef int32_t vdg_side;
enum {
  /* A wall without friction. */
  VDG_SIDE_WALL = 0,
  /* The opposite side; must stand on both. */
  VDG_SIDE_PERIODIC = 1,
  /* The same state as inside. */
  VDG_SIDE_ZERO_GRADIENT = 2,
  /* A given state rho, u, p; waves leave. */
  VDG_SIDE_FAR_FIELD = 3,
  /* Gas enters with rho and u. The pressure starts at p and follows the flow within the time relax, so that waves still leave.
   * An inlet faster than its own sound keeps its pressure. */
  VDG_SIDE_INLET = 4,
  /* Gas leaves against the pressure p. */
  VDG_SIDE_OUTLET = 5,
  /* Gas enters from rest, where density and pressure are rho and p. */
  VDG_SIDE_RESERVOIR = 6,
};

/* Where the pressure comes from. */
typedef int32_t vdg_gas;
enum {
  /* p = (gamma - 1) rho e, with an energy equation; needs gamma. */
  VDG_GAS_IDEAL = 0,
  /* p = c^2 rho; needs sound_speed. */
  VDG_GAS_ISOTHERMAL = 1,
  /* p = p0 (rho/rho0)^gamma; needs gamma, rho0, p0. */
  VDG_GAS_ISENTROPIC = 2,
};

/* Riemann solver at the faces. */
typedef int32_t vdg_riemann;
enum {
  /* Three waves. */
  VDG_RIEMANN_HLLC = 0,
  /* Two waves. */
  VDG_RIEMANN_HLLE = 1,
  /* One speed. */
  VDG_RIEMANN_RUSANOV = 2,
  /* Three waves, softened where the gas is slow and no sound passes, so that slow vortices live; along one axis as HLLC. */
  VDG_RIEMANN_HLLC_LOW_MACH = 3,
};

/* Limiter of the slopes. */
typedef int32_t vdg_limiter;
enum {
  /* The usual one: monotonised central, and a steeper slope for the part of the density that is no sound, so that contacts stay sharp. */
  VDG_LIMITER_STEEP = 0,
  /* Monotonised central. */
  VDG_LIMITER_MONOTONIZED_CENTRAL = 1,
  /* The harmonic mean of van Leer. */
  VDG_LIMITER_VAN_LEER = 2,
  /* The smaller of the two one-sided slopes. */
  VDG_LIMITER_MINMOD = 3,
  /* The central slope as it is; for smooth flow only. */
  VDG_LIMITER_UNLIMITED = 4,
  /* First order. */
  VDG_LIMITER_FIRST_ORDER = 5,
  /* Sound by its waves, as far as the Courant number of each allows (Arora and Roe); the rest as by the usual one. */
  VDG_LIMITER_ARORA_ROE = 6,
};

/* How the pressure acts in a cell whose faces are not as open as its volume. */
typedef int32_t vdg_pressure;
enum {
  /* On the open faces, and the cell's own pressure on the walls inside it. */
  VDG_PRESSURE_GEOMETRIC = 0,
  /* -beta_v grad p. */
  VDG_PRESSURE_PAPER = 1,
};

/* As vdg_flow, in single precision. */
typedef struct vdgf_flow vdgf_flow;

/* A flow. It lies in memory of the caller and is never freed; different threads may use different flows. */
typedef struct vdg_flow vdg_flow;

/* Edges of a rectilinear grid. nx, ny, nz are numbers of cells; x has nx + 1 edges, strictly increasing and finite, and so on.
 * Arrays over a grid are stored with x fastest: cell (i, j, k) is entry (k*ny + j)*nx + i, as a(nx,ny,nz) in Fortran. Arrays over faces are
 * one longer along their own axis: x faces (k*ny + j)*(nx+1) + i, y faces (k*(ny+1) + j)*nx + i, z faces (k*ny + j)*nx + i. */
typedef struct {
  /* nx + 1 edges along x. */
  const double *x;
  /* ny + 1 edges along y. */
  const double *y;
  /* nz + 1 edges along z. */
  const double *z;
  /* Cells along x. */
  size_t nx;
  /* Cells along y. */
  size_t ny;
  /* Cells along z. */
  size_t nz;
} vdg_grid;

/* Where a fault lies. The status says which of its entries count; the others are -1 and 0. */
typedef struct {
  /* Name of the argument or of its field, in static memory; never null, empty if there is none to name. */
  const char *argument;
  /* 0, 1, 2 for x, y, z; else -1. */
  int32_t axis;
  /* The edge, triangle, cell, face, body or side at fault, counted from 0 in its array. */
  size_t index;
  /* Bytes of memory that would do. */
  size_t needed;
} vdg_fault;

/* Bodies of triangles, in the frame and unit of the grid. Corners run counter-clockwise seen from outside, and a body's surface should be
 * closed; how far it is not, the report tells. Bodies may overlap: what they share counts once. */
typedef struct {
  /* Nine numbers a triangle: x, y, z of its three corners. */
  const double *corners;
  /* Number of triangles. */
  size_t triangles;
  /* Body b has the triangles first[b] up to but not including first[b + 1]: bodies + 1 entries, not decreasing. Null: all triangles
   * are one body. */
  const size_t *first;
  /* Number of bodies; does not count if first is null. */
  size_t bodies;
  /* One entry a body: not zero for a sheet without volume, both sides of it given as triangles, which blocks the faces in whose plane it lies.
   * Null: there are none. */
  const uint8_t *sheets;
} vdg_surface;

/* Choices. Zeros stand for the usual ones. */
typedef struct {
  /* Cells that bodies share are divided until their bounds are this close, unless a proof is found at once; 0 stands for 1e-4. */
  double tol;
  /* How often such a cell may be halved along each axis; 0 stands for 6. */
  uint32_t depth;
  /* Pieces of triangles in one cell for which an exact union is attempted; 0 stands for 1024, which takes about 4 MB of work in double
   * precision. It costs nothing where there is one body. */
  uint32_t pieces;
  /* The first layer of cells to compute. */
  size_t first_layer;
  /* How many layers; 0 stands for all from first_layer on. */
  size_t layers;
} vdg_options;

/* Arrays for open fractions: 1 open, 0 blocked. x, y and z are those of faces; all three are null if faces are not wanted. */
typedef struct {
  /* Cells. */
  double *v;
  /* Faces normal to x. */
  double *x;
  /* Faces normal to y. */
  double *y;
  /* Faces normal to z. */
  double *z;
} vdg_beta;

/* Where open fractions go. The arrays hold the layers asked for: with layers = n they are those of a grid of n layers, but without the z
 * faces above them unless these are the highest of the grid. */
typedef struct {
  /* The fractions, in the middle of their bounds. */
  vdg_beta value;
  /* Lower bounds of the same; all null if bounds are not wanted. */
  vdg_beta lower;
  /* Upper bounds of the same. */
  vdg_beta upper;
} vdg_fractions;

/* What was found. */
typedef struct {
  /* Volume of the union of all bodies inside the grid (or inside the layers asked for). */
  double solid_volume;
  /* Largest distance between the bounds of any cell or face. What is left of it after rounding comes from cells that bodies share. */
  double max_gap;
  /* The worst hole of any surface, as a share of the area of a face: a row of cells behind it is wrong by so much. Rounding is below 1e-9. */
  double leak;
  /* By how much a body's own share of a cell left 0 to 1 at worst: surfaces that cross themselves or are turned inside out. */
  double winding;
  /* The body with the worst hole. */
  size_t leaky_body;
  /* Cells without solid. */
  size_t open;
  /* Cells partly solid, or with surface inside. */
  size_t cut;
  /* Cells all solid. */
  size_t closed;
  /* Of the cut cells, those whose union had to be found. */
  size_t shared;
  /* Of these, those divided because no proof was found at once. */
  size_t divided;
  /* Queries of GJK. */
  uint64_t queries;
  /* Of these, the undecided ones, which cost work, never truth. */
  uint64_t undecided;
} vdg_porosity_report;

/* A convex body. */
typedef struct {
  /* One of vdg_kind. */
  int32_t kind;
  /* Its numbers, as the kind says. */
  double p[12];
  /* Of a hull: three numbers a point. */
  const double *points;
  /* Of a hull: how many points. */
  size_t count;
  /* All points within this distance of the body belong to it; 0 for the body itself. */
  double round;
} vdg_body;

/* Bodies of triangles, and solids known by formula: sphere, capsule, cylinder, cone whole or truncated, ellipsoid, not rounded. */
typedef struct {
  /* The triangles; null: there are none. */
  const vdg_surface *surface;
  /* The solids. */
  const vdg_body *solids;
  /* How many solids. */
  size_t solid_count;
} vdg_scene;

/* How far apart two bodies are. */
typedef struct {
  /* One of vdg_contact. */
  int32_t contact;
  /* The distance; 0 unless they are apart. */
  double distance;
  /* The true distance is not less than this. */
  double lower;
  /* The true distance is not more than this; infinite if nothing is known. */
  double upper;
  /* The point of the first body that is nearest to the second, if they are apart. */
  double a[3];
  /* The point of the second body that is nearest to the first, if they are apart. */
  double b[3];
} vdg_distance_report;

/* A side of the domain. Of a gas without energy equation the pressure follows from rho, except that an outlet is given by p. */
typedef struct {
  /* One of vdg_side. */
  int32_t kind;
  /* Density. */
  double rho;
  /* Velocity along x, y, z. */
  double u[3];
  /* Pressure. */
  double p;
  /* Of an inlet: the time in which the pressure follows; 0 stands for the time that sound takes through the domain. */
  double relax;
} vdg_boundary;

/* A flow, before it starts. An axis of one cell is dead: nothing moves along it. All arrays are copied. */
typedef struct {
  /* The grid. */
  vdg_grid grid;
  /* One of vdg_gas. */
  int32_t gas;
  /* Ratio of specific heats, above 1. */
  double gamma;
  /* Speed of sound of an isothermal gas. */
  double sound_speed;
  /* Density of the reference state of an isentropic gas. */
  double rho0;
  /* Pressure of the reference state of an isentropic gas. */
  double p0;
  /* x low, x high, y low, y high, z low, z high. */
  vdg_boundary side[6];
  /* Open fractions of the cells, 0 to 1; null: all is open. */
  const double *beta_v;
  /* Open fractions of the faces normal to x, y, z; needed with beta_v along axes that are not dead. */
  const double *beta[3];
  /* Differences of open area above this share of the wider duct, at one face or over many in a row, are jumps, and conserve total pressure; 0 stands for 0.1, infinity for none. */
  double jump;
  /* Acceleration along x, y, z. */
  double gravity[3];
  /* Quadratic drag of the cells along x, y, z, 1/length: the force is -rho/2 cr |u| u. Null: none along that axis. */
  const double *cr[3];
  /* Linear drag of the cells along x, y, z, 1/time: the force is -rho a u. Null: none along that axis. */
  const double *linear[3];
  /* One of vdg_riemann. */
  int32_t riemann;
  /* One of vdg_limiter. */
  int32_t limiter;
  /* One of vdg_pressure. */
  int32_t pressure;
} vdg_case;

/* What a step did; of several steps sums, and the last dt and rate. */
typedef struct {
  /* Time reached since the flow began. */
  double time;
  /* The step taken. */
  double dt;
  /* Largest signal rate of the new state; the next stable step is a CFL number (0.8, say) over it. */
  double rate;
  /* Steps done. */
  uint64_t steps;
  /* Steps repeated with half the time because they would have needed floors. */
  uint64_t repeated;
  /* Cells whose reconstruction fell back to first order. */
  uint64_t first_order;
  /* Cells whose density or pressure had to be raised to a floor: such a flow is not to be relied on. */
  uint64_t floored;
  /* What came in through each side (x low, x high, y low, ...): mass, momentum along x, y, z, energy. */
  double inflow[6][5];
} vdg_step_report;

/* As vdg_grid, in single precision. */
typedef struct {
  const float *x;
  const float *y;
  const float *z;
  size_t nx;
  size_t ny;
  size_t nz;
} vdgf_grid;

/* As vdg_surface, in single precision. */
typedef struct {
  const float *corners;
  size_t triangles;
  const size_t *first;
  size_t bodies;
  const uint8_t *sheets;
} vdgf_surface;

/* As vdg_options, in single precision. */
typedef struct {
  float tol;
  uint32_t depth;
  uint32_t pieces;
  size_t first_layer;
  size_t layers;
} vdgf_options;

/* As vdg_beta, in single precision. */
typedef struct {
  float *v;
  float *x;
  float *y;
  float *z;
} vdgf_beta;

/* As vdg_fractions, in single precision. */
typedef struct {
  vdgf_beta value;
  vdgf_beta lower;
  vdgf_beta upper;
} vdgf_fractions;

/* As vdg_porosity_report, in single precision. */
typedef struct {
  float solid_volume;
  float max_gap;
  float leak;
  float winding;
  size_t leaky_body;
  size_t open;
  size_t cut;
  size_t closed;
  size_t shared;
  size_t divided;
  uint64_t queries;
  uint64_t undecided;
} vdgf_porosity_report;

/* As vdg_body, in single precision. */
typedef struct {
  int32_t kind;
  float p[12];
  const float *points;
  size_t count;
  float round;
} vdgf_body;

/* As vdg_scene, in single precision. */
typedef struct {
  const vdgf_surface *surface;
  const vdgf_body *solids;
  size_t solid_count;
} vdgf_scene;

/* As vdg_distance_report, in single precision. */
typedef struct {
  int32_t contact;
  float distance;
  float lower;
  float upper;
  float a[3];
  float b[3];
} vdgf_distance_report;

/* As vdg_boundary, in single precision. */
typedef struct {
  int32_t kind;
  float rho;
  float u[3];
  float p;
  float relax;
} vdgf_boundary;

/* As vdg_case, in single precision. */
typedef struct {
  vdgf_grid grid;
  int32_t gas;
  float gamma;
  float sound_speed;
  float rho0;
  float p0;
  vdgf_boundary side[6];
  const float *beta_v;
  const float *beta[3];
  float jump;
  float gravity[3];
  const float *cr[3];
  const float *linear[3];
  int32_t riemann;
  int32_t limiter;
  int32_t pressure;
} vdgf_case;

/* As vdg_step_report, in single precision. */
typedef struct {
  float time;
  float dt;
  float rate;
  uint64_t steps;
  uint64_t repeated;
  uint64_t first_order;
  uint64_t floored;
  float inflow[6][5];
} vdgf_step_report;

#ifdef __cplusplus
extern "C" {
#endif

/* Checks a grid. */
vdg_status vdg_grid_check(const vdg_grid *grid, vdg_fault *fault);

/* Bytes of work that vdg_surface_porosity needs for the same arguments; SIZE_MAX if they are wrong, or there are not so many bytes. */
size_t vdg_surface_work(const vdg_grid *grid,
                        const vdg_surface *surface,
                        const vdg_options *options);

/* Open fractions of cells and faces from bodies of triangles, exact to rounding; what bodies share counts once.
 *
 * All layers of the grid, or some of them, as the options say. Layers do not depend on each other: one at a time, or side by side in threads, they
 * have the same bits, each with work of its own. options, report and fault may be null. work is a block of bytes, aligned or not. */
vdg_status vdg_surface_porosity(const vdg_grid *grid,
                                const vdg_surface *surface,
                                const vdg_options *options,
                                const vdg_fractions *fractions,
                                void *work,
                                size_t bytes,
                                vdg_porosity_report *report,
                                vdg_fault *fault);

/* Bytes of work that vdg_scene_porosity needs for the same arguments; SIZE_MAX if they are wrong, or there are not so many bytes. */
size_t vdg_scene_work(const vdg_grid *grid,
                      const vdg_scene *scene,
                      const vdg_options *options);

/* As vdg_surface_porosity, with solids known by formula. Their fractions are exact to rounding; where solids may share a cell with each other or
 * with a surface, it is divided until its bounds are as close as the options say. */
vdg_status vdg_scene_porosity(const vdg_grid *grid,
                              const vdg_scene *scene,
                              const vdg_options *options,
                              const vdg_fractions *fractions,
                              void *work,
                              size_t bytes,
                              vdg_porosity_report *report,
                              vdg_fault *fault);

/* Whether two convex bodies meet, with proof (GJK, and exact arithmetic where rounding could hide it): contact becomes one of vdg_contact.
 * hint is null or zero, or three numbers: a direction from a towards b to start with, which changes the work, not the answer's truth. fault may be
 * null. */
vdg_status vdg_meets(const vdg_body *a,
                     const vdg_body *b,
                     const double *hint,
                     int32_t *contact,
                     vdg_fault *fault);

/* How far apart two convex bodies are, with certified bounds. hint and fault as in vdg_meets. */
vdg_status vdg_distance(const vdg_body *a,
                        const vdg_body *b,
                        const double *hint,
                        vdg_distance_report *distance,
                        vdg_fault *fault);

/* Bytes of memory for a flow; SIZE_MAX if the case is wrong, or there are not so many bytes. */
size_t vdg_flow_size(const vdg_case *flow_case);

/* Makes a flow in memory, a block of bytes that need not be aligned. The flow lives there until the block is used for something else; it
 * must not be moved. Set its state before the first step. fault may be null. */
vdg_status vdg_flow_init(const vdg_case *flow_case,
                         void *memory,
                         size_t bytes,
                         vdg_flow **flow,
                         vdg_fault *fault);

/* Sets the state of all cells: density, velocity and pressure in the pores. A velocity that is null is 0; the pressure does not count for a gas
 * without energy equation. fault may be null. */
vdg_status vdg_flow_set(vdg_flow *flow,
                        const double *rho,
                        const double *u,
                        const double *v,
                        const double *w,
                        const double *p,
                        vdg_fault *fault);

/* Tells the state of all cells; arrays that are null are left out. fault may be null. */
vdg_status vdg_flow_get(const vdg_flow *flow,
                        double *rho,
                        double *u,
                        double *v,
                        double *w,
                        double *p,
                        vdg_fault *fault);

/* The largest signal rate of the present state: a step of a CFL number (0.8, say) over it is stable. fault may be null. */
vdg_status vdg_flow_rate(vdg_flow *flow, double *rate, vdg_fault *fault);

/* One step of dt, whatever its stability. report and fault may be null. */
vdg_status vdg_flow_step(vdg_flow *flow, double dt, vdg_step_report *report, vdg_fault *fault);

/* Stable steps at the CFL number cfl (above 0, at most 1) until the time end, or until max_steps have been done; none, if that is not
 * after the time reached. A step that would need floors is repeated with half the time. The report tells what was done even if the call ends early.
 * report and fault may be null. */
vdg_status vdg_flow_advance(vdg_flow *flow,
                            double end,
                            double cfl,
                            uint64_t max_steps,
                            vdg_step_report *report,
                            vdg_fault *fault);

/* Five sums over all cells, times their open volumes: mass, momentum along x, y, z, energy. fault may be null. */
vdg_status vdg_flow_totals(const vdg_flow *flow, double *totals, vdg_fault *fault);

/* Changes what stands outside a side, number 0 to 5: x low, x high, y low, y high, z low, z high. Periodic sides stay so. fault may be null. */
vdg_status vdg_flow_set_side(vdg_flow *flow,
                             int32_t number,
                             const vdg_boundary *side,
                             vdg_fault *fault);

/* As vdg_grid_check, in single precision. */
vdg_status vdgf_grid_check(const vdgf_grid *grid, vdg_fault *fault);

/* As vdg_surface_work, in single precision. */
size_t vdgf_surface_work(const vdgf_grid *grid, const vdgf_surface *surface, const vdgf_options *options);

/* As vdg_surface_porosity, in single precision. */
vdg_status vdgf_surface_porosity(const vdgf_grid *grid,
                                 const vdgf_surface *surface,
                                 const vdgf_options *options,
                                 const vdgf_fractions *fractions,
                                 void *work,
                                 size_t bytes,
                                 vdgf_porosity_report *report,
                                 vdg_fault *fault);

/* As vdg_scene_work, in single precision. */
size_t vdgf_scene_work(const vdgf_grid *grid, const vdgf_scene *scene, const vdgf_options *options);

/* As vdg_scene_porosity, in single precision. */
vdg_status vdgf_scene_porosity(const vdgf_grid *grid,
                               const vdgf_scene *scene,
                               const vdgf_options *options,
                               const vdgf_fractions *fractions,
                               void *work,
                               size_t bytes,
                               vdgf_porosity_report *report,
                               vdg_fault *fault);

/* As vdg_meets, in single precision. */
vdg_status vdgf_meets(const vdgf_body *a, const vdgf_body *b, const float *hint, int32_t *contact, vdg_fault *fault);

/* As vdg_distance, in single precision. */
vdg_status vdgf_distance(const vdgf_body *a,
                         const vdgf_body *b,
                         const float *hint,
                         vdgf_distance_report *distance,
                         vdg_fault *fault);

/* As vdg_flow_size, in single precision. */
size_t vdgf_flow_size(const vdgf_case *flow_case);

/* As vdg_flow_init, in single precision. */
vdg_status vdgf_flow_init(const vdgf_case *flow_case, void *memory, size_t bytes, vdgf_flow **flow, vdg_fault *fault);

/* As vdg_flow_set, in single precision. */
vdg_status vdgf_flow_set(vdgf_flow *flow,
                         const float *rho,
                         const float *u,
                         const float *v,
                         const float *w,
                         const float *p,
                         vdg_fault *fault);

/* As vdg_flow_get, in single precision. */
vdg_status vdgf_flow_get(const vdgf_flow *flow, float *rho, float *u, float *v, float *w, float *p, vdg_fault *fault);

/* As vdg_flow_rate, in single precision. */
vdg_status vdgf_flow_rate(vdgf_flow *flow, float *rate, vdg_fault *fault);

/* As vdg_flow_step, in single precision. */
vdg_status vdgf_flow_step(vdgf_flow *flow, float dt, vdgf_step_report *report, vdg_fault *fault);

/* As vdg_flow_advance, in single precision. */
vdg_status vdgf_flow_advance(vdgf_flow *flow,
                             float end,
                             float cfl,
                             uint64_t max_steps,
                             vdgf_step_report *report,
                             vdg_fault *fault);

/* As vdg_flow_totals, in single precision. */
vdg_status vdgf_flow_totals(const vdgf_flow *flow, float *totals, vdg_fault *fault);

/* As vdg_flow_set_side, in single precision. */
vdg_status vdgf_flow_set_side(vdgf_flow *flow, int32_t number, const vdgf_boundary *side, vdg_fault *fault);

/* Version of the library: 10000 major + 100 minor + patch, to be compared with VDG_VERSION of the header. */
uint32_t vdg_version(void);

/* A sentence for a status, in static memory; never null. */
const char *vdg_status_text(int32_t status);

#ifdef __cplusplus
}
#endif

#endif  /* VOIDAGE_H */
