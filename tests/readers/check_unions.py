#!/usr/bin/env python3
"""Compares porosities of curved and turned bodies with unions by manifold3d, which shares no code with voidage.

usage: check_unions.py VOIDAGE [SCENES]      VOIDAGE is the command; SCENES, 20 if not given, is how many random scenes
needs: pip install numpy manifold3d

A scene has balls, cylinders, tubes and boxes of facets, turned, overlapping and flush, some with every triangle twice, once from behind.
manifold3d joins them, cuts the union by every cell for its volume, and by every z plane for the area in each face. Every value must
lie within the bounds that voidage writes, but for the rounding of manifold3d. Exit code 1 and a line for each fault.
"""

import pathlib
import subprocess
import sys
import tempfile

import manifold3d as m
import numpy as np

CELLS = 4
# manifold3d's sections are rounded to some 1e-8, its volumes are not.
SLACK = {"beta_v": 1e-9, "beta_z": 1e-7}


def bodies(rng):
    """Manifolds within (-2, 2)³."""
    parts = []
    for _ in range(rng.integers(2, 6)):
        size = rng.uniform(0.2, 0.9, 3)
        kind = rng.integers(4)
        if kind == 0:
            part = m.Manifold.sphere(size[0], int(rng.integers(8, 24)))
        elif kind == 1:
            part = m.Manifold.cylinder(2 * size[0], size[1], size[2], int(rng.integers(5, 20)), True)
        elif kind == 2:
            outer = m.Manifold.cylinder(2 * size[0], size[1], circular_segments=12, center=True)
            part = outer - m.Manifold.cylinder(3.0, 0.6 * size[1], circular_segments=12, center=True)
        else:
            part = m.Manifold.cube(2 * size, True)
        turn = rng.uniform(0, 360, 3) if rng.integers(3) else np.zeros(3)
        parts.append(part.rotate(tuple(turn)).translate(tuple(rng.uniform(-0.9, 0.9, 3))))
    if rng.integers(2):
        # Flush: a copy beside the first, a side of their boxes in common.
        box = parts[0].bounding_box()
        parts.append(parts[0].translate((0.5 * (box[3] - box[0]), 0, 0)))
    return parts


def write(path, parts, two_sided):
    """ASCII STL with all digits, a solid a body."""
    with open(path, "w") as out:
        for n, part in enumerate(parts):
            mesh = part.to_mesh64()
            points = np.asarray(mesh.vert_properties)[:, :3]
            out.write(f"solid part{n}\n")
            for a, b, c in np.asarray(mesh.tri_verts):
                for corners in [(a, b, c), (a, c, b)] if two_sided else [(a, b, c)]:
                    out.write("facet normal 0 0 0\nouter loop\n")
                    for v in corners:
                        out.write("vertex " + " ".join(repr(float(x)) for x in points[v]) + "\n")
                    out.write("endloop\nendfacet\n")
            out.write(f"endsolid part{n}\n")


def truth(union, edges):
    """Open fractions of cells and of z faces that lie in no surface."""
    size = edges[1] - edges[0]
    cube = m.Manifold.cube((size, size, size))
    cells = np.empty((CELLS,) * 3)
    faces = np.empty((CELLS, CELLS, CELLS + 1))
    square = m.CrossSection.square((size, size))
    for k in range(CELLS + 1):
        section = union.slice(float(edges[k]))
        for j in range(CELLS):
            for i in range(CELLS):
                at = (float(edges[i]), float(edges[j]))
                faces[i, j, k] = 1 - (section ^ square.translate(at)).area() / size**2
                if k < CELLS:
                    cells[i, j, k] = 1 - (union ^ cube.translate((*at, float(edges[k])))).volume() / size**3
    return {"beta_v": cells, "beta_z": faces}


def main():
    command, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    faults, widest = 0, 0.0
    edges = np.linspace(-2.125, 1.875, CELLS + 1)
    for seed in range(count):
        rng = np.random.default_rng(seed)
        parts, two_sided = bodies(rng), seed % 3 == 2
        expected = truth(m.Manifold.batch_boolean(parts, m.OpType.Add), edges)
        with tempfile.TemporaryDirectory() as directory:
            stl = pathlib.Path(directory, "scene.stl")
            write(stl, parts, two_sided)
            bounds = ",".join(repr(float(e)) for e in [edges[0]] * 3 + [edges[-1]] * 3)
            run = [command, "porosity", str(stl), "--cells", "x".join([str(CELLS)] * 3), f"--bounds={bounds}"]
            subprocess.run([*run, "--bounds-fields", "--npy", directory, "-q"], check=True)
            for name, values in expected.items():
                lower, upper = (np.load(pathlib.Path(directory, f"{name}_{end}.npy")) for end in ("lower", "upper"))
                widest = max(widest, float((upper - lower).max()))
                outside = np.maximum(lower - values, values - upper)
                if outside.max() > SLACK[name]:
                    faults += 1
                    at = np.unravel_index(outside.argmax(), outside.shape)
                    print(f"scene {seed}: {name}{list(map(int, at))} is {values[at]}, its bounds {lower[at]} and {upper[at]}")
    print(f"{count} scenes against manifold3d: {faults} faults, bounds at most {widest:.1e} apart")
    sys.exit(faults > 0)


main()
