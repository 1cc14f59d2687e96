! Porosity of two boxes made of triangles, ten steps of gas through it, and the distance of two bodies.
program porous_box
  use, intrinsic :: iso_fortran_env, only: int64, error_unit
  use voidage
  implicit none
  integer, parameter :: nx = 12, ny = 6, nz = 6, cells = nx*ny*nz
  integer(int64) :: hash = 0
  real(c_double), target :: x(0:nx), y(0:ny), z(0:nz), corners(3, 3, 24)
  real(c_double), target :: beta_v(nx, ny, nz), beta_x(nx + 1, ny, nz), beta_y(nx, ny + 1, nz), beta_z(nx, ny, nz + 1)
  real(c_double) :: rho(nx, ny, nz), u(nx, ny, nz), v(nx, ny, nz), w(nx, ny, nz), p(nx, ny, nz), rate
  integer(c_size_t), target :: first(3) = [0, 12, 24]
  integer(c_size_t) :: bytes
  integer :: i, step
  type(vdg_fault) :: fault

  x = [(0.25_c_double*i, i=0, nx)]
  y = [(0.25_c_double*i, i=0, ny)]
  z = y
  corners(:, :, 1:12) = box([0.8_c_double, 0.35_c_double, 0.35_c_double], [1.6_c_double, 1.1_c_double, 1.1_c_double])
  corners(:, :, 13:24) = box([1.3_c_double, 0.6_c_double, 0.2_c_double], [1.9_c_double, 0.9_c_double, 1.3_c_double])
  call porosity()
  call flow_through()
  call bodies()
  write (*, '(a, z16.16)') 'hash ', hash

contains

  ! docs: porosity
  subroutine porosity()
    type(vdg_grid) :: grid
    type(vdg_surface) :: surface
    type(vdg_options) :: options
    type(vdg_fractions) :: beta
    type(vdg_porosity_report) :: found
    integer(c_int8_t), allocatable, target :: work(:)

    grid = vdg_grid(c_loc(x), c_loc(y), c_loc(z), nx, ny, nz)
    surface = vdg_surface(corners=c_loc(corners), triangles=24, first=c_loc(first), bodies=2)
    beta%value = vdg_beta(c_loc(beta_v), c_loc(beta_x), c_loc(beta_y), c_loc(beta_z))

    bytes = surface_work(grid, surface, options)
    allocate (work(bytes))
    call check(surface_porosity(grid, surface, options, beta, c_loc(work), bytes, found, fault))
    write (*, '(a, f17.15)') 'solid volume ', found%solid_volume
    ! docs: end
    call mix(reshape(beta_v, [size(beta_v)]))
    call mix(reshape(beta_x, [size(beta_x)]))
    call mix(reshape(beta_y, [size(beta_y)]))
    call mix(reshape(beta_z, [size(beta_z)]))
  end subroutine

  ! docs: flow
  subroutine flow_through()
    type(vdg_case) :: flow_case
    type(vdg_flow) :: flow
    type(vdg_step_report) :: report
    integer(c_int8_t), allocatable, target :: memory(:)

    flow_case%grid = vdg_grid(c_loc(x), c_loc(y), c_loc(z), nx, ny, nz)
    flow_case%gamma = 1.4_c_double
    flow_case%beta_v = c_loc(beta_v)
    flow_case%beta = [c_loc(beta_x), c_loc(beta_y), c_loc(beta_z)]
    flow_case%side(1)%kind = vdg_side_far_field
    flow_case%side(1)%rho = 1
    flow_case%side(1)%u(1) = 0.5_c_double
    flow_case%side(1)%p = 1
    flow_case%side(2)%kind = vdg_side_outlet
    flow_case%side(2)%p = 1

    bytes = flow_size(flow_case)
    allocate (memory(bytes))
    call check(vdg_flow_init(flow_case, c_loc(memory), bytes, flow, fault))
    rho = 1
    p = 1
    u = 0
    call check(vdg_flow_set(flow, rho, u, u, u, p, fault))

    call check(flow_rate(flow, rate, fault))
    do step = 1, 10
      call check(flow_step(flow, 0.5_c_double/rate, report, fault))
      rate = report%rate
    end do
    call check(vdg_flow_get(flow, rho, u, v, w, p, fault))
    ! docs: end
    call mix(reshape(rho, [cells]))
    call mix(reshape(u, [cells]))
    call mix(reshape(v, [cells]))
    call mix(reshape(w, [cells]))
    call mix(reshape(p, [cells]))
  end subroutine

  ! docs: bodies
  subroutine bodies()
    type(vdg_body) :: rod, block
    type(vdg_distance_report) :: apart
    real(c_double), parameter :: no_hint(3) = 0

    rod%kind = vdg_kind_capsule
    rod%p(1:7) = [real(c_double) :: 0, 0, 0, 1, 2, 3, 0.25]
    block%kind = vdg_kind_box
    block%p(1:6) = [real(c_double) :: 2, 0, 0, 3, 1, 1]
    call check(distance(rod, block, no_hint, apart, fault))
    ! docs: end
    call mix([apart%distance])
    call mix(apart%a)
    call mix(apart%b)
    call single_precision()
  end subroutine

  ! The same names serve both kinds.
  subroutine single_precision()
    type(vdgf_body) :: rod, block
    type(vdgf_distance_report) :: apart
    real(c_float), parameter :: no_hint(3) = 0

    rod%kind = vdg_kind_sphere
    rod%p(4) = 0.5_c_float
    block%kind = vdg_kind_point
    block%p(1) = 2
    call check(distance(rod, block, no_hint, apart, fault))
    if (abs(apart%distance - 1.5_c_float) > 1e-6_c_float) error stop 'distance in single precision'
  end subroutine

  ! Twelve triangles, counter-clockwise seen from outside.
  pure function box(low, high) result(triangles)
    real(c_double), intent(in) :: low(3), high(3)
    real(c_double) :: triangles(3, 3, 12)
    integer, parameter :: of(3, 12) = reshape([0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, &
                                               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5], [3, 12])
    integer :: t, c, axis
    do concurrent(t=1:12, c=1:3, axis=1:3)
      triangles(axis, c, t) = merge(high(axis), low(axis), btest(of(c, t), axis - 1))
    end do
  end function

  ! Stops with a sentence if a call refused.
  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == vdg_status_ok) return
    write (error_unit, '(4a, i0, a, i0)') vdg_status_text(status), ': ', c_text(fault%argument), &
      ', entry ', fault%index, ', bytes needed ', fault%needed
    error stop 1
  end subroutine

  ! One number for all bits of some results.
  subroutine mix(values)
    real(c_double), intent(in) :: values(:)
    integer :: n
    do n = 1, size(values)
      hash = ieor(ishftc(hash, 7), transfer(values(n), hash))
    end do
  end subroutine
end program porous_box
