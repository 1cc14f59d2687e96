#!/usr/bin/env python3
"""voidage beside PyClaw: error against time on Sod's tube, Shu and Osher's shock, a plane Riemann problem and a plane blast.

    pip install numpy clawpack        # needs gfortran
    cargo build --release -p voidage
    python3 tests/readers/compare_pyclaw.py target/release/voidage [--fine 400]

Both get the same cell averages at the beginning, one thread, the MC limiter and their usual steps (0.8 and 0.9 of the stable one); voidage once more
with the limiter `arora-roe`. The error is
the mean |rho - truth| over the cells. Truth is the exact solution of Sod's tube; else the mean of what both find on `--fine` cells along
each axis, so that neither is measured against itself alone. Seconds are those of stepping, without start and files.
"""
import argparse
import json
import logging
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

GAMMA = 1.4


def sod_exact(x, t):
    """Density of Sod's tube by Newton's method in the pressure (Toro, ch. 4)."""
    left, right = (1.0, 0.0, 1.0), (0.125, 0.0, 0.1)
    sound = lambda s: np.sqrt(GAMMA * s[2] / s[0])

    def change(p, s):
        if p > s[2]:
            a, b = 2 / ((GAMMA + 1) * s[0]), (GAMMA - 1) / (GAMMA + 1) * s[2]
            return (p - s[2]) * np.sqrt(a / (p + b))
        return 2 * sound(s) / (GAMMA - 1) * ((p / s[2]) ** ((GAMMA - 1) / (2 * GAMMA)) - 1)

    low, high = 0.1, 1.0
    for _ in range(200):
        p = 0.5 * (low + high)
        low, high = (low, p) if change(p, left) + change(p, right) > 0 else (p, high)
    u = change(p, right)
    m = (GAMMA - 1) / (GAMMA + 1)
    behind_fan = left[0] * (p / left[2]) ** (1 / GAMMA)
    behind_shock = right[0] * (p / right[2] + m) / (m * p / right[2] + 1)
    shock = sound(right) * np.sqrt((GAMMA + 1) / (2 * GAMMA) * p / right[2] + (GAMMA - 1) / (2 * GAMMA))
    xi = x / t
    head, tail = -sound(left), u - np.sqrt(GAMMA * p / behind_fan)
    fan = left[0] * (2 / (GAMMA + 1) - (GAMMA - 1) / ((GAMMA + 1) * sound(left)) * xi) ** (2 / (GAMMA - 1))
    parts = [xi < head, xi < tail, xi < u, xi < shock]
    return np.select(parts, [left[0], fan, behind_fan, behind_shock], right[0])


def mean_of(parts, f, n):
    """Averages over n cells of a function of points, by points within cells."""
    return f.reshape(sum(((k, parts) for k in n), ())).mean(axis=tuple(range(1, 2 * len(n), 2)))


class Problem:
    """A state at the beginning by points, the domain, the end, and the number of axes."""

    def __init__(self, name, state, domain, end, axes, cells, exact=None):
        self.name, self.state, self.domain, self.end = name, state, domain, end
        self.axes, self.cells, self.exact = axes, cells, exact

    def start(self, n):
        parts, (a, b) = 4, self.domain
        x = a + (b - a) * (np.arange(n * parts) + 0.5) / (n * parts)
        grid = np.meshgrid(*[x] * self.axes, indexing="ij")
        rho, u, v, p = (np.broadcast_to(q, grid[0].shape) for q in self.state(*grid))
        energy = p / (GAMMA - 1) + 0.5 * rho * (u * u + v * v)
        cells = [mean_of(parts, np.ascontiguousarray(q), (n,) * self.axes) for q in (rho, rho * u, rho * v, energy)]
        rho, mu, mv, energy = cells
        return rho, mu / rho, mv / rho, (GAMMA - 1) * (energy - 0.5 * (mu * mu + mv * mv) / rho)


def sod(x):
    return np.where(x < 0.5, 1.0, 0.125), 0 * x, 0 * x, np.where(x < 0.5, 1.0, 0.1)


def shu_osher(x):
    left = x < -4
    return np.where(left, 3.857143, 1 + 0.2 * np.sin(5 * x)), np.where(left, 2.629369, 0), 0 * x, np.where(left, 31 / 3, 1)


def riemann_2d(x, y):
    """Configuration 3 of Lax and Liu: four shocks."""
    def pick(a, b, c, d):
        return np.select([(x >= 0.5) & (y >= 0.5), (x < 0.5) & (y >= 0.5), (x < 0.5) & (y < 0.5)], [a, b, c], d)
    return pick(1.5, 0.5323, 0.138, 0.5323), pick(0, 1.206, 1.206, 0), pick(0, 0, 1.206, 1.206), pick(1.5, 0.3, 0.029, 0.3)


def blast(x, y):
    return 1 + 0 * x, 0 * x, 0 * x, np.where((x - 0.5) ** 2 + (y - 0.5) ** 2 < 0.01, 10.0, 0.1)


def by_voidage(program, problem, n, limiter="mc"):
    """Density and seconds of `voidage solve`."""
    with tempfile.TemporaryDirectory() as there:
        there = pathlib.Path(there)
        (there / "start").mkdir()
        shape = (n,) * problem.axes + (1,) * (3 - problem.axes)
        rho, u, v, p = problem.start(n)
        for name, q in (("rho", rho), ("u", u), ("v", v), ("w", 0 * u), ("p", p)):
            np.save(there / "start" / f"{name}.npy", np.asfortranarray(q.reshape(shape)))
        a, b = problem.domain
        axes = "xyz"[: problem.axes]
        text = "[grid]\n" + "".join(f"{d} = {{ points = [{a}, {b}], cells = [{n}] }}\n" for d in axes)
        text += '[gas]\nmodel = "ideal"\ngamma = 1.4\n[initial]\nfrom = "start"\n[boundary]\n'
        text += "".join(f'{d}_{side} = "zero-gradient"\n' for d in axes for side in ("min", "max"))
        text += f'[scheme]\nlimiter = "{limiter}"\n'
        text += f"[time]\nend = {problem.end}\n[output]\nformats = []\nlog_every = 1000000\n"
        (there / "case.toml").write_text(text)
        subprocess.run([program, "solve", there / "case.toml", "-o", there / "out", "--threads", "1", "-q"], check=True)
        report = json.loads((there / "out" / "report.json").read_text())
        return np.load(there / "out" / "final" / "rho.npy").reshape((n,) * problem.axes, order="F"), report["seconds"]


def by_pyclaw(problem, n):
    """Density and seconds of PyClaw's classic solver."""
    from clawpack import pyclaw, riemann

    if problem.axes == 1:
        solver = pyclaw.ClawSolver1D(riemann.euler_with_efix_1D)
    else:
        solver = pyclaw.ClawSolver2D(riemann.euler_4wave_2D)
    solver.limiters = pyclaw.limiters.tvd.MC
    solver.cfl_desired, solver.cfl_max = 0.9, 1.0
    solver.all_bcs = pyclaw.BC.extrap
    a, b = problem.domain
    domain = pyclaw.Domain([pyclaw.Dimension(a, b, n, name=d) for d in "xy"[: problem.axes]])
    state = pyclaw.State(domain, solver.num_eqn)
    state.problem_data.update(gamma=GAMMA, gamma1=GAMMA - 1, efix=True)
    rho, u, v, p = problem.start(n)
    velocities = (u,) if problem.axes == 1 else (u, v)
    state.q[0] = rho
    for d, w in enumerate(velocities):
        state.q[1 + d] = rho * w
    state.q[1 + problem.axes] = p / (GAMMA - 1) + 0.5 * rho * sum(w * w for w in velocities)
    control = pyclaw.Controller()
    control.solution, control.solver = pyclaw.Solution(state, domain), solver
    control.tfinal, control.num_output_times, control.output_format = problem.end, 1, None
    control.keep_copy, control.verbosity = False, 0
    solver.dt_initial = 0.1 * (b - a) / n / 5
    solver.max_steps = 1_000_000
    begin = time.perf_counter()
    control.run()
    return control.solution.state.q[0].copy(), time.perf_counter() - begin


def coarse(q, n):
    return mean_of(q.shape[0] // n, q, (n,) * q.ndim)


def main():
    args = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    args.add_argument("program")
    args.add_argument("--fine", type=int, default=400, help="cells along each axis of the truth in the plane")
    args = args.parse_args()
    logging.disable(logging.INFO)
    args.program = str(pathlib.Path(args.program).resolve())
    # PyClaw leaves a log where it is run.
    elsewhere = tempfile.TemporaryDirectory()
    os.chdir(elsewhere.name)
    problems = [
        Problem("Sod", sod, (0, 1), 0.2, 1, [100, 200, 400, 800], lambda x: sod_exact(x - 0.5, 0.2)),
        Problem("Shu-Osher", shu_osher, (-5, 5), 1.8, 1, [200, 400, 800]),
        Problem("Riemann 2D", riemann_2d, (0, 1), 0.3, 2, [50, 100]),
        Problem("blast 2D", blast, (0, 1), 0.1, 2, [50, 100]),
    ]
    runs = {
        "voidage error": lambda problem, n: by_voidage(args.program, problem, n),
        "by arora-roe": lambda problem, n: by_voidage(args.program, problem, n, "arora-roe"),
        "PyClaw error": by_pyclaw,
    }
    print(f"{'problem':12} {'cells':>6} " + " ".join(f"{name:>13} {'seconds':>9}" for name in runs))
    for problem in problems:
        if problem.exact is None:
            n = args.fine if problem.axes == 2 else 6400
            truth = 0.5 * (by_voidage(args.program, problem, n)[0] + by_pyclaw(problem, n)[0])
        for n in problem.cells:
            if problem.exact is None:
                exact = coarse(truth, n)
            else:
                (a, b), parts = problem.domain, 64
                exact = coarse(problem.exact(a + (b - a) * (np.arange(n * parts) + 0.5) / (n * parts)), n)
            row = [f"{problem.name:12} {n:6}"]
            for run in runs.values():
                rho, seconds = run(problem, n)
                row.append(f"{np.abs(rho - exact).mean():13.3e} {seconds:9.3f}")
            print(" ".join(row), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
