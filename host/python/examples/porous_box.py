"""Porosity of two boxes made of triangles, ten steps of gas through it, and the distance of two bodies."""

import numpy as np
import voidage

OF = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]


def box(low, high):
    """Twelve triangles, counter-clockwise seen from outside."""
    corners = [[(high if n >> axis & 1 else low)[axis] for axis in range(3)] for n in range(8)]
    return np.array([[corners[n] for n in triangle] for triangle in OF])


def mix(total, array):
    """One number for all bits of some results."""
    for bits in np.asarray(array, dtype=np.float64).ravel(order="F").view(np.uint64).tolist():
        total = ((total << 7 | total >> 57) ^ bits) & 0xFFFF_FFFF_FFFF_FFFF
    return total


boxes = [box([0.8, 0.35, 0.35], [1.6, 1.1, 1.1]), box([1.3, 0.6, 0.2], [1.9, 0.9, 1.3])]
# docs: porosity
x, y, z = 0.25 * np.arange(13), 0.25 * np.arange(7), 0.25 * np.arange(7)
beta = voidage.porosity(boxes, (x, y, z))
print(f"solid volume {beta['solid_volume']:.15f}")
# docs: end

# docs: flow
flow = voidage.Flow((x, y, z), beta=beta, boundary={
    "x_min": {"type": "far-field", "rho": 1, "u": (0.5, 0, 0), "p": 1},
    "x_max": {"type": "outlet", "p": 1},
})
flow.set(rho=1, p=1)
rate = flow.rate()
for _ in range(10):
    rate = flow.step(0.5 / rate).rate
state = flow.state()
# docs: end

# docs: bodies
rod = voidage.Body.capsule((0, 0, 0), (1, 2, 3), 0.25)
block = voidage.Body.box((2, 0, 0), (3, 1, 1))
apart = voidage.distance(rod, block)
# docs: end

hashed = 0
for name in ("beta_v", "beta_x", "beta_y", "beta_z"):
    hashed = mix(hashed, beta[name])
for name in ("rho", "u", "v", "w", "p"):
    hashed = mix(hashed, state[name])
hashed = mix(hashed, [apart.distance, *apart.a, *apart.b])
print(f"hash {hashed:016X}")
