import os
from dataclasses import dataclass
from typing import Any, Literal, Mapping, Sequence, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Grid = Sequence[ArrayLike]
Point = Sequence[float]
Mesh = Union[str, os.PathLike[str], Array]
Contact = Literal["apart", "overlapping", "touching", "undecided"]

def porosity(
    meshes: Union[Mesh, Sequence[Mesh]],
    grid: Grid,
    *,
    scale: float = ...,
    tol: float = ...,
    depth: int = ...,
    areas: bool = ...,
    bounds: bool = ...,
) -> dict[str, Any]: ...

class Body:
    def rounded(self, radius: float) -> Body: ...
    @staticmethod
    def point(at: Point) -> Body: ...
    @staticmethod
    def segment(start: Point, end: Point) -> Body: ...
    @staticmethod
    def triangle(a: Point, b: Point, c: Point) -> Body: ...
    @staticmethod
    def box(low: Point, high: Point) -> Body: ...
    @staticmethod
    def hull(points: Sequence[Point]) -> Body: ...
    @staticmethod
    def sphere(center: Point, radius: float) -> Body: ...
    @staticmethod
    def capsule(start: Point, end: Point, radius: float) -> Body: ...
    @staticmethod
    def cylinder(start: Point, end: Point, radius: float) -> Body: ...
    @staticmethod
    def cone(base: Point, apex: Point, radius: float, top_radius: float = 0.0) -> Body: ...
    @staticmethod
    def ellipsoid(center: Point, half_axes: Sequence[Point]) -> Body: ...
    @staticmethod
    def oriented_box(center: Point, half_axes: Sequence[Point]) -> Body: ...

@dataclass(frozen=True)
class Distance:
    contact: Contact
    distance: float
    lower: float
    upper: float
    a: tuple[float, float, float]
    b: tuple[float, float, float]

def meets(a: Body, b: Body) -> Contact: ...
def distance(a: Body, b: Body) -> Distance: ...

@dataclass(frozen=True)
class Step:
    time: float
    dt: float
    rate: float
    steps: int
    repeated: int
    first_order: int
    floored: int
    inflow: list[list[float]]

class Side(TypedDict, total=False):
    type: Literal["wall", "periodic", "zero-gradient", "far-field", "inlet", "outlet", "reservoir"]
    rho: float
    u: Point
    p: float
    relax: float

class Flow:
    def __init__(
        self,
        grid: Grid,
        *,
        beta: Union[Mapping[str, Any], None] = ...,
        gas: Literal["ideal", "isothermal", "isentropic"] = ...,
        gamma: float = ...,
        sound_speed: float = ...,
        rho0: float = ...,
        p0: float = ...,
        boundary: Union[Mapping[str, Side], None] = ...,
        gravity: Point = ...,
        cr: Sequence[Union[ArrayLike, None]] = ...,
        linear: Sequence[Union[ArrayLike, None]] = ...,
        jump: float = ...,
        riemann: Literal["hllc", "hllc-low-mach", "hlle", "rusanov"] = ...,
        limiter: Literal["steep", "monotonized-central", "mc", "van-leer", "minmod", "unlimited", "none", "first-order", "arora-roe"] = ...,
        pressure: Literal["geometric", "paper"] = ...,
    ) -> None: ...
    def set(
        self,
        rho: ArrayLike,
        u: Union[ArrayLike, None] = ...,
        v: Union[ArrayLike, None] = ...,
        w: Union[ArrayLike, None] = ...,
        p: Union[ArrayLike, None] = ...,
    ) -> None: ...
    def state(self) -> dict[str, Array]: ...
    def rate(self) -> float: ...
    def step(self, dt: float) -> Step: ...
    def advance(self, end: float, *, cfl: float = ..., max_steps: int = ...) -> Step: ...
    def totals(self) -> list[float]: ...
    def set_side(self, name: str, **side: Any) -> None: ...
