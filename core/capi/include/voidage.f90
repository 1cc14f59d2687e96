! voidage: porosity of geometry on structured grids, convex bodies, and flow of gas through porous space.
!
! include/voidage.h is the manual. Types and functions have the names they have there, vdg_ for real64
! and vdgf_ for real32; every pair of functions has in addition one generic name without prefix:
! flow_step(flow, dt, report, fault). Fields may be arrays of any rank where the full name is called;
! under a generic name Fortran wants them of rank one. Structs are zero by default and may not be left
! out, nor may arrays that the manual lets be null; pointers in structs come from c_loc. Numbers of bodies, cells,
! axes and sides in arguments and faults count from 0, as there; arrays in structs count from 1.
! This file is made from the header by packaging/fortran.py: do not edit it.
module voidage
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int32_t), parameter :: vdg_header_version = 100
  integer(c_int32_t), parameter :: vdg_status_ok = 0
  integer(c_int32_t), parameter :: vdg_status_null = 1
  integer(c_int32_t), parameter :: vdg_status_misaligned = 2
  integer(c_int32_t), parameter :: vdg_status_length = 3
  integer(c_int32_t), parameter :: vdg_status_overlap = 4
  integer(c_int32_t), parameter :: vdg_status_memory = 5
  integer(c_int32_t), parameter :: vdg_status_grid = 6
  integer(c_int32_t), parameter :: vdg_status_value = 7
  integer(c_int32_t), parameter :: vdg_status_kind = 8
  integer(c_int32_t), parameter :: vdg_status_body = 9
  integer(c_int32_t), parameter :: vdg_status_periodic = 10
  integer(c_int32_t), parameter :: vdg_status_unphysical = 11
  integer(c_int32_t), parameter :: vdg_status_handle = 12
  integer(c_int32_t), parameter :: vdg_status_range = 13
  integer(c_int32_t), parameter :: vdg_status_stalled = 14
  integer(c_int32_t), parameter :: vdg_status_too_many = 15
  integer(c_int32_t), parameter :: vdg_kind_point = 0
  integer(c_int32_t), parameter :: vdg_kind_segment = 1
  integer(c_int32_t), parameter :: vdg_kind_triangle = 2
  integer(c_int32_t), parameter :: vdg_kind_box = 3
  integer(c_int32_t), parameter :: vdg_kind_hull = 4
  integer(c_int32_t), parameter :: vdg_kind_sphere = 5
  integer(c_int32_t), parameter :: vdg_kind_capsule = 6
  integer(c_int32_t), parameter :: vdg_kind_cylinder = 7
  integer(c_int32_t), parameter :: vdg_kind_cone = 8
  integer(c_int32_t), parameter :: vdg_kind_ellipsoid = 9
  integer(c_int32_t), parameter :: vdg_kind_oriented_box = 10
  integer(c_int32_t), parameter :: vdg_kind_truncated_cone = 11
  integer(c_int32_t), parameter :: vdg_contact_apart = 0
  integer(c_int32_t), parameter :: vdg_contact_overlapping = 1
  integer(c_int32_t), parameter :: vdg_contact_undecided = 2
  integer(c_int32_t), parameter :: vdg_contact_touching = 3
  integer(c_int32_t), parameter :: vdg_side_wall = 0
  integer(c_int32_t), parameter :: vdg_side_periodic = 1
  integer(c_int32_t), parameter :: vdg_side_zero_gradient = 2
  integer(c_int32_t), parameter :: vdg_side_far_field = 3
  integer(c_int32_t), parameter :: vdg_side_inlet = 4
  integer(c_int32_t), parameter :: vdg_side_outlet = 5
  integer(c_int32_t), parameter :: vdg_side_reservoir = 6
  integer(c_int32_t), parameter :: vdg_gas_ideal = 0
  integer(c_int32_t), parameter :: vdg_gas_isothermal = 1
  integer(c_int32_t), parameter :: vdg_gas_isentropic = 2
  integer(c_int32_t), parameter :: vdg_riemann_hllc = 0
  integer(c_int32_t), parameter :: vdg_riemann_hlle = 1
  integer(c_int32_t), parameter :: vdg_riemann_rusanov = 2
  integer(c_int32_t), parameter :: vdg_riemann_hllc_low_mach = 3
  integer(c_int32_t), parameter :: vdg_limiter_steep = 0
  integer(c_int32_t), parameter :: vdg_limiter_monotonized_central = 1
  integer(c_int32_t), parameter :: vdg_limiter_van_leer = 2
  integer(c_int32_t), parameter :: vdg_limiter_minmod = 3
  integer(c_int32_t), parameter :: vdg_limiter_unlimited = 4
  integer(c_int32_t), parameter :: vdg_limiter_first_order = 5
  integer(c_int32_t), parameter :: vdg_limiter_arora_roe = 6
  integer(c_int32_t), parameter :: vdg_pressure_geometric = 0
  integer(c_int32_t), parameter :: vdg_pressure_paper = 1

  type, bind(c) :: vdg_flow
    type(c_ptr) :: at = c_null_ptr
  end type

  type, bind(c) :: vdgf_flow
    type(c_ptr) :: at = c_null_ptr
  end type

  type, bind(c) :: vdg_grid
    type(c_ptr) :: x = c_null_ptr
    type(c_ptr) :: y = c_null_ptr
    type(c_ptr) :: z = c_null_ptr
    integer(c_size_t) :: nx = 0
    integer(c_size_t) :: ny = 0
    integer(c_size_t) :: nz = 0
  end type

  type, bind(c) :: vdg_fault
    type(c_ptr) :: argument = c_null_ptr
    integer(c_int32_t) :: axis = 0
    integer(c_size_t) :: index = 0
    integer(c_size_t) :: needed = 0
  end type

  type, bind(c) :: vdg_surface
    type(c_ptr) :: corners = c_null_ptr
    integer(c_size_t) :: triangles = 0
    type(c_ptr) :: first = c_null_ptr
    integer(c_size_t) :: bodies = 0
    type(c_ptr) :: sheets = c_null_ptr
  end type

  type, bind(c) :: vdg_options
    real(c_double) :: tol = 0.0_c_double
    integer(c_int32_t) :: depth = 0
    integer(c_int32_t) :: pieces = 0
    integer(c_size_t) :: first_layer = 0
    integer(c_size_t) :: layers = 0
  end type

  type, bind(c) :: vdg_beta
    type(c_ptr) :: v = c_null_ptr
    type(c_ptr) :: x = c_null_ptr
    type(c_ptr) :: y = c_null_ptr
    type(c_ptr) :: z = c_null_ptr
  end type

  type, bind(c) :: vdg_fractions
    type(vdg_beta) :: value
    type(vdg_beta) :: lower
    type(vdg_beta) :: upper
  end type

  type, bind(c) :: vdg_porosity_report
    real(c_double) :: solid_volume = 0.0_c_double
    real(c_double) :: max_gap = 0.0_c_double
    real(c_double) :: leak = 0.0_c_double
    real(c_double) :: winding = 0.0_c_double
    integer(c_size_t) :: leaky_body = 0
    integer(c_size_t) :: open_cells = 0
    integer(c_size_t) :: cut_cells = 0
    integer(c_size_t) :: closed_cells = 0
    integer(c_size_t) :: shared = 0
    integer(c_size_t) :: divided = 0
    integer(c_int64_t) :: queries = 0
    integer(c_int64_t) :: undecided = 0
  end type

  type, bind(c) :: vdg_body
    integer(c_int32_t) :: kind = 0
    real(c_double) :: p(12) = 0.0_c_double
    type(c_ptr) :: points = c_null_ptr
    integer(c_size_t) :: count = 0
    real(c_double) :: round = 0.0_c_double
  end type

  type, bind(c) :: vdg_scene
    type(c_ptr) :: surface = c_null_ptr
    type(c_ptr) :: solids = c_null_ptr
    integer(c_size_t) :: solid_count = 0
  end type

  type, bind(c) :: vdg_distance_report
    integer(c_int32_t) :: contact = 0
    real(c_double) :: distance = 0.0_c_double
    real(c_double) :: lower = 0.0_c_double
    real(c_double) :: upper = 0.0_c_double
    real(c_double) :: a(3) = 0.0_c_double
    real(c_double) :: b(3) = 0.0_c_double
  end type

  type, bind(c) :: vdg_boundary
    integer(c_int32_t) :: kind = 0
    real(c_double) :: rho = 0.0_c_double
    real(c_double) :: u(3) = 0.0_c_double
    real(c_double) :: p = 0.0_c_double
    real(c_double) :: relax = 0.0_c_double
  end type

  type, bind(c) :: vdg_case
    type(vdg_grid) :: grid
    integer(c_int32_t) :: gas = 0
    real(c_double) :: gamma = 0.0_c_double
    real(c_double) :: sound_speed = 0.0_c_double
    real(c_double) :: rho0 = 0.0_c_double
    real(c_double) :: p0 = 0.0_c_double
    type(vdg_boundary) :: side(6)
    type(c_ptr) :: beta_v = c_null_ptr
    type(c_ptr) :: beta(3) = c_null_ptr
    real(c_double) :: jump = 0.0_c_double
    real(c_double) :: gravity(3) = 0.0_c_double
    type(c_ptr) :: cr(3) = c_null_ptr
    type(c_ptr) :: linear(3) = c_null_ptr
    integer(c_int32_t) :: riemann = 0
    integer(c_int32_t) :: limiter = 0
    integer(c_int32_t) :: pressure = 0
  end type

  type, bind(c) :: vdg_step_report
    real(c_double) :: time = 0.0_c_double
    real(c_double) :: dt = 0.0_c_double
    real(c_double) :: rate = 0.0_c_double
    integer(c_int64_t) :: steps = 0
    integer(c_int64_t) :: repeated = 0
    integer(c_int64_t) :: first_order = 0
    integer(c_int64_t) :: floored = 0
    real(c_double) :: inflow(5, 6) = 0.0_c_double
  end type

  type, bind(c) :: vdgf_grid
    type(c_ptr) :: x = c_null_ptr
    type(c_ptr) :: y = c_null_ptr
    type(c_ptr) :: z = c_null_ptr
    integer(c_size_t) :: nx = 0
    integer(c_size_t) :: ny = 0
    integer(c_size_t) :: nz = 0
  end type

  type, bind(c) :: vdgf_surface
    type(c_ptr) :: corners = c_null_ptr
    integer(c_size_t) :: triangles = 0
    type(c_ptr) :: first = c_null_ptr
    integer(c_size_t) :: bodies = 0
    type(c_ptr) :: sheets = c_null_ptr
  end type

  type, bind(c) :: vdgf_options
    real(c_float) :: tol = 0.0_c_float
    integer(c_int32_t) :: depth = 0
    integer(c_int32_t) :: pieces = 0
    integer(c_size_t) :: first_layer = 0
    integer(c_size_t) :: layers = 0
  end type

  type, bind(c) :: vdgf_beta
    type(c_ptr) :: v = c_null_ptr
    type(c_ptr) :: x = c_null_ptr
    type(c_ptr) :: y = c_null_ptr
    type(c_ptr) :: z = c_null_ptr
  end type

  type, bind(c) :: vdgf_fractions
    type(vdgf_beta) :: value
    type(vdgf_beta) :: lower
    type(vdgf_beta) :: upper
  end type

  type, bind(c) :: vdgf_porosity_report
    real(c_float) :: solid_volume = 0.0_c_float
    real(c_float) :: max_gap = 0.0_c_float
    real(c_float) :: leak = 0.0_c_float
    real(c_float) :: winding = 0.0_c_float
    integer(c_size_t) :: leaky_body = 0
    integer(c_size_t) :: open_cells = 0
    integer(c_size_t) :: cut_cells = 0
    integer(c_size_t) :: closed_cells = 0
    integer(c_size_t) :: shared = 0
    integer(c_size_t) :: divided = 0
    integer(c_int64_t) :: queries = 0
    integer(c_int64_t) :: undecided = 0
  end type

  type, bind(c) :: vdgf_body
    integer(c_int32_t) :: kind = 0
    real(c_float) :: p(12) = 0.0_c_float
    type(c_ptr) :: points = c_null_ptr
    integer(c_size_t) :: count = 0
    real(c_float) :: round = 0.0_c_float
  end type

  type, bind(c) :: vdgf_scene
    type(c_ptr) :: surface = c_null_ptr
    type(c_ptr) :: solids = c_null_ptr
    integer(c_size_t) :: solid_count = 0
  end type

  type, bind(c) :: vdgf_distance_report
    integer(c_int32_t) :: contact = 0
    real(c_float) :: distance = 0.0_c_float
    real(c_float) :: lower = 0.0_c_float
    real(c_float) :: upper = 0.0_c_float
    real(c_float) :: a(3) = 0.0_c_float
    real(c_float) :: b(3) = 0.0_c_float
  end type

  type, bind(c) :: vdgf_boundary
    integer(c_int32_t) :: kind = 0
    real(c_float) :: rho = 0.0_c_float
    real(c_float) :: u(3) = 0.0_c_float
    real(c_float) :: p = 0.0_c_float
    real(c_float) :: relax = 0.0_c_float
  end type

  type, bind(c) :: vdgf_case
    type(vdgf_grid) :: grid
    integer(c_int32_t) :: gas = 0
    real(c_float) :: gamma = 0.0_c_float
    real(c_float) :: sound_speed = 0.0_c_float
    real(c_float) :: rho0 = 0.0_c_float
    real(c_float) :: p0 = 0.0_c_float
    type(vdgf_boundary) :: side(6)
    type(c_ptr) :: beta_v = c_null_ptr
    type(c_ptr) :: beta(3) = c_null_ptr
    real(c_float) :: jump = 0.0_c_float
    real(c_float) :: gravity(3) = 0.0_c_float
    type(c_ptr) :: cr(3) = c_null_ptr
    type(c_ptr) :: linear(3) = c_null_ptr
    integer(c_int32_t) :: riemann = 0
    integer(c_int32_t) :: limiter = 0
    integer(c_int32_t) :: pressure = 0
  end type

  type, bind(c) :: vdgf_step_report
    real(c_float) :: time = 0.0_c_float
    real(c_float) :: dt = 0.0_c_float
    real(c_float) :: rate = 0.0_c_float
    integer(c_int64_t) :: steps = 0
    integer(c_int64_t) :: repeated = 0
    integer(c_int64_t) :: first_order = 0
    integer(c_int64_t) :: floored = 0
    real(c_float) :: inflow(5, 6) = 0.0_c_float
  end type

  interface
    function vdg_grid_check(grid, fault) result(answer) bind(c)
      import
      type(vdg_grid), intent(in) :: grid
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_surface_work(grid, surface, options) result(answer) bind(c)
      import
      type(vdg_grid), intent(in) :: grid
      type(vdg_surface), intent(in) :: surface
      type(vdg_options), intent(in) :: options
      integer(c_size_t) :: answer
    end function
    function vdg_surface_porosity(grid, surface, options, fractions, work, bytes, report, fault) &
        result(answer) bind(c)
      import
      type(vdg_grid), intent(in) :: grid
      type(vdg_surface), intent(in) :: surface
      type(vdg_options), intent(in) :: options
      type(vdg_fractions), intent(in) :: fractions
      type(c_ptr), value :: work
      integer(c_size_t), value :: bytes
      type(vdg_porosity_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_scene_work(grid, scene, options) result(answer) bind(c)
      import
      type(vdg_grid), intent(in) :: grid
      type(vdg_scene), intent(in) :: scene
      type(vdg_options), intent(in) :: options
      integer(c_size_t) :: answer
    end function
    function vdg_scene_porosity(grid, scene, options, fractions, work, bytes, report, fault) &
        result(answer) bind(c)
      import
      type(vdg_grid), intent(in) :: grid
      type(vdg_scene), intent(in) :: scene
      type(vdg_options), intent(in) :: options
      type(vdg_fractions), intent(in) :: fractions
      type(c_ptr), value :: work
      integer(c_size_t), value :: bytes
      type(vdg_porosity_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_meets(a, b, hint, contact, fault) result(answer) bind(c)
      import
      type(vdg_body), intent(in) :: a
      type(vdg_body), intent(in) :: b
      real(c_double), intent(in) :: hint(*)
      integer(c_int32_t), intent(out) :: contact
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_distance(a, b, hint, distance, fault) result(answer) bind(c)
      import
      type(vdg_body), intent(in) :: a
      type(vdg_body), intent(in) :: b
      real(c_double), intent(in) :: hint(*)
      type(vdg_distance_report), intent(inout) :: distance
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_size(flow_case) result(answer) bind(c)
      import
      type(vdg_case), intent(in) :: flow_case
      integer(c_size_t) :: answer
    end function
    function vdg_flow_init(flow_case, memory, bytes, flow, fault) result(answer) bind(c)
      import
      type(vdg_case), intent(in) :: flow_case
      type(c_ptr), value :: memory
      integer(c_size_t), value :: bytes
      type(vdg_flow), intent(out) :: flow
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_set(flow, rho, u, v, w, p, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), intent(in) :: rho(*)
      real(c_double), intent(in) :: u(*)
      real(c_double), intent(in) :: v(*)
      real(c_double), intent(in) :: w(*)
      real(c_double), intent(in) :: p(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_get(flow, rho, u, v, w, p, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), intent(inout) :: rho(*)
      real(c_double), intent(inout) :: u(*)
      real(c_double), intent(inout) :: v(*)
      real(c_double), intent(inout) :: w(*)
      real(c_double), intent(inout) :: p(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_rate(flow, rate, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), intent(out) :: rate
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_step(flow, dt, report, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), value :: dt
      type(vdg_step_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_advance(flow, end, cfl, max_steps, report, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), value :: end
      real(c_double), value :: cfl
      integer(c_int64_t), value :: max_steps
      type(vdg_step_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_totals(flow, totals, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      real(c_double), intent(inout) :: totals(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_flow_set_side(flow, number, side, fault) result(answer) bind(c)
      import
      type(vdg_flow), value :: flow
      integer(c_int32_t), value :: number
      type(vdg_boundary), intent(in) :: side
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_grid_check(grid, fault) result(answer) bind(c)
      import
      type(vdgf_grid), intent(in) :: grid
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_surface_work(grid, surface, options) result(answer) bind(c)
      import
      type(vdgf_grid), intent(in) :: grid
      type(vdgf_surface), intent(in) :: surface
      type(vdgf_options), intent(in) :: options
      integer(c_size_t) :: answer
    end function
    function vdgf_surface_porosity(grid, surface, options, fractions, work, bytes, report, fault) &
        result(answer) bind(c)
      import
      type(vdgf_grid), intent(in) :: grid
      type(vdgf_surface), intent(in) :: surface
      type(vdgf_options), intent(in) :: options
      type(vdgf_fractions), intent(in) :: fractions
      type(c_ptr), value :: work
      integer(c_size_t), value :: bytes
      type(vdgf_porosity_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_scene_work(grid, scene, options) result(answer) bind(c)
      import
      type(vdgf_grid), intent(in) :: grid
      type(vdgf_scene), intent(in) :: scene
      type(vdgf_options), intent(in) :: options
      integer(c_size_t) :: answer
    end function
    function vdgf_scene_porosity(grid, scene, options, fractions, work, bytes, report, fault) &
        result(answer) bind(c)
      import
      type(vdgf_grid), intent(in) :: grid
      type(vdgf_scene), intent(in) :: scene
      type(vdgf_options), intent(in) :: options
      type(vdgf_fractions), intent(in) :: fractions
      type(c_ptr), value :: work
      integer(c_size_t), value :: bytes
      type(vdgf_porosity_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_meets(a, b, hint, contact, fault) result(answer) bind(c)
      import
      type(vdgf_body), intent(in) :: a
      type(vdgf_body), intent(in) :: b
      real(c_float), intent(in) :: hint(*)
      integer(c_int32_t), intent(out) :: contact
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_distance(a, b, hint, distance, fault) result(answer) bind(c)
      import
      type(vdgf_body), intent(in) :: a
      type(vdgf_body), intent(in) :: b
      real(c_float), intent(in) :: hint(*)
      type(vdgf_distance_report), intent(inout) :: distance
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_size(flow_case) result(answer) bind(c)
      import
      type(vdgf_case), intent(in) :: flow_case
      integer(c_size_t) :: answer
    end function
    function vdgf_flow_init(flow_case, memory, bytes, flow, fault) result(answer) bind(c)
      import
      type(vdgf_case), intent(in) :: flow_case
      type(c_ptr), value :: memory
      integer(c_size_t), value :: bytes
      type(vdgf_flow), intent(out) :: flow
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_set(flow, rho, u, v, w, p, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), intent(in) :: rho(*)
      real(c_float), intent(in) :: u(*)
      real(c_float), intent(in) :: v(*)
      real(c_float), intent(in) :: w(*)
      real(c_float), intent(in) :: p(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_get(flow, rho, u, v, w, p, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), intent(inout) :: rho(*)
      real(c_float), intent(inout) :: u(*)
      real(c_float), intent(inout) :: v(*)
      real(c_float), intent(inout) :: w(*)
      real(c_float), intent(inout) :: p(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_rate(flow, rate, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), intent(out) :: rate
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_step(flow, dt, report, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), value :: dt
      type(vdgf_step_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_advance(flow, end, cfl, max_steps, report, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), value :: end
      real(c_float), value :: cfl
      integer(c_int64_t), value :: max_steps
      type(vdgf_step_report), intent(inout) :: report
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_totals(flow, totals, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      real(c_float), intent(inout) :: totals(*)
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdgf_flow_set_side(flow, number, side, fault) result(answer) bind(c)
      import
      type(vdgf_flow), value :: flow
      integer(c_int32_t), value :: number
      type(vdgf_boundary), intent(in) :: side
      type(vdg_fault), intent(inout) :: fault
      integer(c_int32_t) :: answer
    end function
    function vdg_version() result(answer) bind(c)
      import
      integer(c_int32_t) :: answer
    end function
    function vdg_status_text_at(code) result(answer) bind(c, name="vdg_status_text")
      import
      integer(c_int32_t), value :: code
      type(c_ptr) :: answer
    end function
  end interface

  interface grid_check
    procedure vdg_grid_check, vdgf_grid_check
  end interface

  interface surface_work
    procedure vdg_surface_work, vdgf_surface_work
  end interface

  interface surface_porosity
    procedure vdg_surface_porosity, vdgf_surface_porosity
  end interface

  interface scene_work
    procedure vdg_scene_work, vdgf_scene_work
  end interface

  interface scene_porosity
    procedure vdg_scene_porosity, vdgf_scene_porosity
  end interface

  interface meets
    procedure vdg_meets, vdgf_meets
  end interface

  interface distance
    procedure vdg_distance, vdgf_distance
  end interface

  interface flow_size
    procedure vdg_flow_size, vdgf_flow_size
  end interface

  interface flow_init
    procedure vdg_flow_init, vdgf_flow_init
  end interface

  interface flow_set
    procedure vdg_flow_set, vdgf_flow_set
  end interface

  interface flow_get
    procedure vdg_flow_get, vdgf_flow_get
  end interface

  interface flow_rate
    procedure vdg_flow_rate, vdgf_flow_rate
  end interface

  interface flow_step
    procedure vdg_flow_step, vdgf_flow_step
  end interface

  interface flow_advance
    procedure vdg_flow_advance, vdgf_flow_advance
  end interface

  interface flow_totals
    procedure vdg_flow_totals, vdgf_flow_totals
  end interface

  interface flow_set_side
    procedure vdg_flow_set_side, vdgf_flow_set_side
  end interface

contains

  ! A sentence for a status.
  function vdg_status_text(code) result(text)
    integer(c_int32_t), intent(in) :: code
    character(len=:), allocatable :: text
    text = c_text(vdg_status_text_at(code))
  end function

  ! A text in C's memory: the argument that a fault names.
  function c_text(at) result(text)
    type(c_ptr), intent(in) :: at
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: all(:)
    integer :: length
    text = ""
    if (.not. c_associated(at)) return
    call c_f_pointer(at, all, [256])
    do length = 1, 256
      if (all(length) == c_null_char) exit
      text = text // all(length)
    end do
  end function
end module voidage
