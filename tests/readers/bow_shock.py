#!/usr/bin/env python3
"""Bow shocks before a cylinder and a sphere in a gas of gamma 1.4, as an independent truth for tests/solver/blunt_bodies.rs.

The shock is the outer side of a polar mesh and is moved by the jump conditions: no cell lies across it. Nothing here is shared with voidage.
Usage: bow_shock.py {cylinder|sphere} MACH CELLS TIME; needs numpy. Prints the stand-off in radii and the pressure at the nose over Rayleigh's.
On 12, 24 and 48 cells: cylinder at Mach 3, time 14: 0.6978, 0.6979, 0.6980; sphere at Mach 3, time 8, on 12 and 24 cells: 0.2153, 0.2152.
"""

import sys

import numpy as np

GAMMA = 1.4


def behind_shock(stream, pressure, nx, ny):
    """State behind a shock of normal (nx, ny) into a stream along x of density and pressure 1, from the pressure behind; and how fast it moves."""
    mach_sq = np.maximum((pressure - 1) * (GAMMA + 1) / (2 * GAMMA) + 1, 1.0001)
    relative = np.sqrt(mach_sq * GAMMA)
    speed = stream * nx + relative
    density = (GAMMA + 1) * mach_sq / ((GAMMA - 1) * mach_sq + 2)
    normal, along = speed - relative / density, -stream * ny
    return density, normal * nx - along * ny, normal * ny + along * nx, speed


def flux(left, right, nx, ny, wn):
    """HLLC flux through faces of normal (nx, ny) that move by wn along it (Toro, ch. 10)."""
    sides = []
    for rho, u, v, p in (left, right):
        e = p / (GAMMA - 1) + 0.5 * rho * (u * u + v * v)
        sides.append((rho, u, v, p, e, u * nx + v * ny, np.sqrt(GAMMA * p / rho)))
    (rl, _, _, pl, _, ql, cl), (rr, _, _, pr, _, qr, cr) = sides
    low, high = np.minimum(ql - cl, qr - cr), np.maximum(ql + cl, qr + cr)
    middle = (pr - pl + rl * ql * (low - ql) - rr * qr * (high - qr)) / (rl * (low - ql) - rr * (high - qr))

    def through(rho, u, v, p, e, q):
        return np.array([rho * (q - wn), rho * u * (q - wn) + p * nx, rho * v * (q - wn) + p * ny, e * (q - wn) + p * q])

    def star(side, wave):
        rho, u, v, p, e, q, _ = side
        dense = rho * (wave - q) / (wave - middle)
        pressure = p + rho * (q - wave) * (q - middle)
        energy = dense * (e / rho + (middle - q) * (middle + p / (rho * (wave - q))))
        return through(dense, u + (middle - q) * nx, v + (middle - q) * ny, pressure, energy, middle)

    outer = [through(*side[:6]) for side in sides]
    inner = [star(side, wave) for side, wave in zip(sides, (low, high))]
    return np.where(wn < low, outer[0], np.where(wn < middle, inner[0], np.where(wn < high, inner[1], outer[1])))


def limited(a, b):
    """Slopes by van Albada's mean."""
    least = 1e-12
    return np.where(a * b > 0, (a * (b * b + least) + b * (a * a + least)) / (a * a + b * b + 2 * least), 0)


def conserved(w):
    return np.array([w[0], w[0] * w[1], w[0] * w[2], w[3] / (GAMMA - 1) + 0.5 * w[0] * (w[1] ** 2 + w[2] ** 2)])


def primitive(c):
    u, v = c[1] / c[0], c[2] / c[0]
    return np.array([c[0], u, v, (GAMMA - 1) * (c[3] - 0.5 * c[0] * (u * u + v * v))])


class Layer:
    """The gas between a body of radius 1 and its shock, whose distance `gap` stands at the nodes of the angle from the axis."""

    def __init__(self, round_about, mach, n, widest=1.2):
        self.round_about, self.stream, self.n = round_about, mach * np.sqrt(GAMMA), n
        self.angle, self.share = np.linspace(0, widest, n + 1), np.linspace(0, 1, n + 1)
        self.middle = 0.5 * (self.angle[1:] + self.angle[:-1])
        self.gap = (0.22 if round_about else 0.7) * (1 + 0.55 * self.angle**2) * (0.65 if mach > 5 else 1)
        nx, ny = self.normals(*self.nodes(self.gap))[:2]
        pressure = 1 + 2 * GAMMA / (GAMMA + 1) * ((mach * nx[-1]) ** 2 - 1)
        rho, u, v, _ = behind_shock(self.stream, pressure, nx[-1], ny[-1])
        part = ((np.arange(n) + 0.5) / n)[:, None]
        slip = 0.6 * self.stream * np.sin(self.middle)
        ones = np.ones((n, 1))
        self.w = np.array([
            ones * rho, part * u + (1 - part) * slip * np.sin(self.middle),
            part * v + (1 - part) * slip * np.cos(self.middle), ones * pressure,
        ])

    def nodes(self, gap):
        radius = 1 + self.share[:, None] * gap
        return -radius * np.cos(self.angle), radius * np.sin(self.angle)

    @staticmethod
    def normals(x, y):
        """Outward normals and lengths of the faces around the body."""
        dx, dy = x[:, 1:] - x[:, :-1], y[:, 1:] - y[:, :-1]
        length = np.hypot(dx, dy)
        return -dy / length, dx / length, length

    def sizes(self, gap):
        """Areas of the cells, and their volumes (round the axis: per radian, by Pappus)."""
        x, y = self.nodes(gap)
        corners = [(x[a, b], y[a, b]) for a, b in (
            (slice(None, -1), slice(None, -1)), (slice(1, None), slice(None, -1)),
            (slice(1, None), slice(1, None)), (slice(None, -1), slice(1, None)))]
        area, volume = 0, 0
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            (xa, ya), (xb, yb), (xc, yc) = corners[a], corners[b], corners[c]
            part = 0.5 * np.abs((xb - xa) * (yc - ya) - (xc - xa) * (yb - ya))
            area, volume = area + part, volume + part * ((ya + yb + yc) / 3 if self.round_about else 1)
        return area, volume

    def changes(self, w, gap):
        """Rates of the content of the cells and of the distance of the shock."""
        x, y = self.nodes(gap)
        across = np.diff(w, axis=1)
        out = np.concatenate([across[:, :1], limited(across[:, :-1], across[:, 1:]), across[:, -1:]], axis=1)
        mirror = w[:, :, :1] * np.array([1, 1, -1, 1])[:, None, None]
        beside = np.diff(np.concatenate([mirror, w, 2 * w[:, :, -1:] - w[:, :, -2:-1]], axis=2), axis=2)
        turn = limited(beside[:, :, :-1], beside[:, :, 1:])
        nx, ny, length = self.normals(x, y)
        *_, speed = behind_shock(self.stream, w[3, -1] + 0.5 * out[3, -1], nx[-1], ny[-1])
        radial = speed / (-nx[-1] * np.cos(self.middle) + ny[-1] * np.sin(self.middle))
        ends = [(9 * radial[0] - radial[1]) / 8], [1.5 * radial[-1] - 0.5 * radial[-2]]
        rate = np.concatenate([ends[0], 0.5 * (radial[1:] + radial[:-1]), ends[1]])
        vx, vy = -self.share[:, None] * rate * np.cos(self.angle), self.share[:, None] * rate * np.sin(self.angle)

        moves = 0.5 * ((vx[:, 1:] + vx[:, :-1]) * nx + (vy[:, 1:] + vy[:, :-1]) * ny)
        around = np.zeros((4, self.n + 1, self.n))
        low, high = w - 0.5 * out, w + 0.5 * out
        around[:, 1:-1] = flux(high[:, :-1], low[:, 1:], nx[1:-1], ny[1:-1], moves[1:-1])
        wall = low[:, 0]
        push = wall[3] - np.sqrt(GAMMA * wall[3] * wall[0]) * (wall[1] * nx[0] + wall[2] * ny[0])
        around[:, 0] = [0 * push, push * nx[0], push * ny[0], 0 * push]
        arrives, energy = self.stream * nx[-1] - moves[-1], 1 / (GAMMA - 1) + 0.5 * self.stream**2
        around[:, -1] = [arrives, self.stream * arrives + nx[-1], ny[-1], energy * arrives + self.stream * nx[-1]]
        around *= length * (0.5 * (y[:, 1:] + y[:, :-1]) if self.round_about else 1)

        dx, dy = x[1:] - x[:-1], y[1:] - y[:-1]
        length = np.hypot(dx, dy)
        nx, ny = dy / length, -dx / length
        moves = 0.5 * ((vx[1:] + vx[:-1]) * nx + (vy[1:] + vy[:-1]) * ny)
        along = np.zeros((4, self.n, self.n + 1))
        low, high = w - 0.5 * turn, w + 0.5 * turn
        along[:, :, 1:-1] = flux(high[:, :, :-1], low[:, :, 1:], nx[:, 1:-1], ny[:, 1:-1], moves[:, 1:-1])
        axis = low[3, :, 0]
        along[:, :, 0] = [0 * axis, axis * nx[:, 0], axis * ny[:, 0], 0 * axis]
        last = high[:, :, -1]
        along[:, :, -1] = flux(last, last, nx[:, -1], ny[:, -1], moves[:, -1])
        along *= length * (0.5 * (y[1:] + y[:-1]) if self.round_about else 1)

        change = -np.diff(around, axis=1) - np.diff(along, axis=2)
        if self.round_about:
            change[2] += w[3] * self.sizes(gap)[0]
        return change, rate

    def step(self):
        """One step of Heun's method; returns its length."""
        fastest = (np.hypot(self.w[1], self.w[2]) + np.sqrt(GAMMA * self.w[3] / self.w[0])).max()
        dt = 0.35 * min(self.gap.min() / self.n, self.angle[1]) / fastest
        content = self.sizes(self.gap)[1] * conserved(self.w)
        first, rate = self.changes(self.w, self.gap)
        gap = self.gap + dt * rate
        second, rate_after = self.changes(primitive((content + dt * first) / self.sizes(gap)[1]), gap)
        self.gap = self.gap + 0.5 * dt * (rate + rate_after)
        self.w = primitive((content + 0.5 * dt * (first + second)) / self.sizes(self.gap)[1])
        return dt


def main():
    body, mach, n, end = sys.argv[1], float(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
    layer, time = Layer({"cylinder": False, "sphere": True}[body], mach, n), 0.0
    while time < end:
        time += layer.step()
    m = mach**2
    behind = (1 + 0.2 * m) / (GAMMA * m - 0.2)
    rayleigh = (1 + 2 * GAMMA / (GAMMA + 1) * (m - 1)) * (1 + 0.2 * behind) ** 3.5
    print(f"{body} at Mach {mach}, {n} cells: {layer.gap[0]:.5f} radii, pressure at the nose {layer.w[3, 0, 0] / rayleigh:.5f}")


if __name__ == "__main__":
    main()
