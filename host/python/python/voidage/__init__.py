"""Porosity of geometry on structured grids, convex bodies, and flow of gas through porous space.

A grid is three lists of edges, strictly increasing. Fields have the shape (nx, ny, nz), faces one more along their own axis, in Fortran order (x
fastest). Units are the caller's, the same throughout.
"""

import os as _os
from dataclasses import dataclass as _dataclass

import numpy as _np

from . import _voidage

__all__ = ["porosity", "Body", "meets", "distance", "Distance", "Flow", "Step"]

_CONTACTS = ("apart", "overlapping", "undecided", "touching")
_SIDES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")
_KINDS = ("wall", "periodic", "zero-gradient", "far-field", "inlet", "outlet", "reservoir")
_GASES = ("ideal", "isothermal", "isentropic")
_RIEMANN = ("hllc", "hlle", "rusanov", "hllc-low-mach")
_LIMITERS = ("steep", "monotonized-central", "van-leer", "minmod", "unlimited", "first-order", "arora-roe")
# The words of a case file for two of them.
_LIMITERS_OF_CASES = {"mc": "monotonized-central", "none": "unlimited"}
_PRESSURES = ("geometric", "paper")


def _number(word, words, what):
    try:
        return words.index(word)
    except ValueError:
        raise ValueError(f"{what} is one of {', '.join(words)}, not {word!r}") from None


def _edges(grid):
    x, y, z = (_np.ascontiguousarray(edges, dtype=_np.float64) for edges in grid)
    return [x, y, z]


def _point(coordinates, what):
    numbers = [float(c) for c in coordinates]
    if len(numbers) != 3:
        raise ValueError(f"{what} has three coordinates, not {len(numbers)}")
    return numbers


def porosity(meshes, grid, *, scale=1.0, tol=1e-4, depth=6, areas=True, bounds=False):
    """Open fractions of cells and faces, 1 open and 0 blocked; overlaps count once.

    meshes: a path of an STL or OBJ file, an array of triangles (n, 3, 3), or a list of such. grid: edges along x, y, z. scale: multiplies
    coordinates. tol, depth: where a union has no proof its cell is divided until its bounds are so close, or so often. areas: faces too.
    bounds: also arrays with lower and upper bounds, named ..._lower and ..._upper.

    A dict: beta_v, beta_x, beta_y, beta_z, solid_volume, max_gap, cells, bodies, warnings.
    """
    if isinstance(meshes, (str, _os.PathLike, _np.ndarray)):
        meshes = [meshes]
    if not 0.0 <= tol < float("inf"):
        raise ValueError(f"tol is a number from 0 on, not {tol!r}")
    sources = [_np.asarray(m, dtype=_np.float64) if isinstance(m, _np.ndarray) else m for m in meshes]
    return _voidage.porosity(sources, _edges(grid), (scale, tol, depth), (areas, bounds))


def _frame(center, half_axes):
    axes = [_point(axis, "a half axis") for axis in half_axes]
    if len(axes) != 3:
        raise ValueError(f"there are three half axes, not {len(axes)}")
    return [*_point(center, "center"), *(c for axis in axes for c in axis)]


class Body:
    """A convex body, made by one of the functions below."""

    def __init__(self, kind, numbers, points=(), round=0.0):
        self._made = (kind, [float(n) for n in numbers], [_point(p, "a point") for p in points])
        self._round = float(round)
        self._native = _voidage.Body(*self._made, self._round)

    def rounded(self, radius):
        """All points within radius of the body."""
        if not radius >= 0.0:
            raise ValueError(f"radius is a number from 0 on, not {radius!r}")
        return Body(*self._made, self._round + radius)

    @staticmethod
    def point(at):
        return Body(0, _point(at, "at"))

    @staticmethod
    def segment(start, end):
        return Body(1, [*_point(start, "start"), *_point(end, "end")])

    @staticmethod
    def triangle(a, b, c):
        return Body(2, [*_point(a, "a"), *_point(b, "b"), *_point(c, "c")])

    @staticmethod
    def box(low, high):
        """Along the axes, from its lowest to its highest corner."""
        return Body(3, [*_point(low, "low"), *_point(high, "high")])

    @staticmethod
    def hull(points):
        return Body(4, [], points)

    @staticmethod
    def sphere(center, radius):
        return Body(5, [*_point(center, "center"), radius])

    @staticmethod
    def capsule(start, end, radius):
        return Body(6, [*_point(start, "start"), *_point(end, "end"), radius])

    @staticmethod
    def cylinder(start, end, radius):
        return Body(7, [*_point(start, "start"), *_point(end, "end"), radius])

    @staticmethod
    def cone(base, apex, radius, top_radius=0.0):
        """From base to apex; with a radius there it is truncated."""
        return Body(11, [*_point(base, "base"), *_point(apex, "apex"), radius, top_radius])

    @staticmethod
    def ellipsoid(center, half_axes):
        """Three half axes, at right angles."""
        return Body(9, _frame(center, half_axes))

    @staticmethod
    def oriented_box(center, half_axes):
        """From the centre to the middle of three faces."""
        return Body(10, _frame(center, half_axes))


@_dataclass(frozen=True)
class Distance:
    """How far apart two bodies are; a and b are the nearest points if they are apart."""

    contact: str
    distance: float
    lower: float
    upper: float
    a: tuple
    b: tuple


def meets(a, b):
    """How two bodies lie: "apart", "overlapping", "touching" or, if rounding hides it, "undecided"."""
    return _CONTACTS[_voidage.meets(a._native, b._native)]


def distance(a, b):
    """How far apart two bodies are, with certified bounds."""
    contact, between, lower, upper, on_a, on_b = _voidage.distance(a._native, b._native)
    return Distance(_CONTACTS[contact], between, lower, upper, tuple(on_a), tuple(on_b))


@_dataclass(frozen=True)
class Step:
    """What steps did: sums, and the last dt and rate. inflow: by side; mass, momentum along x, y, z, energy."""

    time: float
    dt: float
    rate: float
    steps: int
    repeated: int
    first_order: int
    floored: int
    inflow: list


def _side(type="wall", rho=0.0, u=(0.0, 0.0, 0.0), p=0.0, relax=0.0):
    return _number(type, _KINDS, "the type of a side"), rho, [float(c) for c in u], p, relax


class Flow:
    """A flow of gas through porous space. An axis of one cell is dead.

    beta: the dict of porosity(), or None. boundary: a dict of sides, x_min to z_max, each a dict with type (wall, periodic, zero-gradient,
    far-field, inlet, outlet, reservoir) and rho, u, p, relax as it needs; sides that are not named are walls. cr, linear: arrays of drag along x, y, z,
    or None. riemann: hllc, hllc-low-mach, hlle, rusanov. limiter: steep, monotonized-central, van-leer, minmod, arora-roe, unlimited or first-order; a case file's
    mc is monotonized-central, its none is unlimited. pressure: geometric, paper.
    """

    def __init__(self, grid, *, beta=None, gas="ideal", gamma=1.4, sound_speed=0.0, rho0=0.0, p0=0.0, boundary=None, gravity=(0.0, 0.0, 0.0),
                 cr=(None, None, None), linear=(None, None, None), jump=0.0, riemann="hllc", limiter="steep", pressure="geometric"):
        boundary = dict(boundary or {})
        sides = [_side(**boundary.pop(name, {})) for name in _SIDES]
        if boundary:
            raise ValueError(f"no side is called {next(iter(boundary))!r}: {', '.join(_SIDES)}")
        arrays = [_field(None if beta is None else beta[name]) for name in ("beta_v", "beta_x", "beta_y", "beta_z")]
        drag = [[_field(c) for c in along] for along in (cr, linear)]
        limiter = _LIMITERS_OF_CASES.get(limiter, limiter)
        scheme = [_number(riemann, _RIEMANN, "riemann"), _number(limiter, _LIMITERS, "limiter"), _number(pressure, _PRESSURES, "pressure")]
        numbers = (_number(gas, _GASES, "gas"), [gamma, sound_speed, rho0, p0])
        edges = _edges(grid)
        self._shape = tuple(len(e) - 1 for e in edges)
        self._native = _voidage.Flow(edges, numbers, sides, arrays, drag, ([float(g) for g in gravity], jump), scheme)

    def _whole(self, value):
        return None if value is None else _field(_np.broadcast_to(_np.asarray(value, dtype=_np.float64), self._shape))

    def set(self, rho, u=None, v=None, w=None, p=None):
        """The state of all cells: arrays of the shape of the grid, or numbers; a velocity that is None is 0."""
        self._native.set([self._whole(value) for value in (rho, u, v, w, p)])

    def state(self):
        """A dict of arrays: rho, u, v, w, p."""
        return dict(zip(("rho", "u", "v", "w", "p"), self._native.get()))

    def rate(self):
        """The largest signal rate: a step of a CFL number (0.8, say) over it is stable."""
        return self._native.rate()

    def step(self, dt):
        """One step, whatever its stability."""
        return self._step(self._native.step(dt))

    def advance(self, end, *, cfl=0.8, max_steps=2**64 - 1):
        """Stable steps until a time."""
        return self._step(self._native.advance(end, cfl, max_steps))

    def totals(self):
        """Mass, momentum along x, y, z and energy in the domain."""
        return self._native.totals()

    def set_side(self, name, **side):
        """Changes what stands outside a side; as in boundary."""
        self._native.set_side(_number(name, _SIDES, "a side"), _side(**side))

    @staticmethod
    def _step(done):
        time, dt, rate, counts, inflow = done
        return Step(time, dt, rate, *counts, inflow)


def _field(array):
    """As the native part takes it: not copied if it lies so."""
    return None if array is None else _np.asfortranarray(array, dtype=_np.float64)
