"""Frontal and wetted area of turned boxes, pipes and balls that overlap, against the union of an independent program, manifold3d.

Usage: check_obstacles.py VOIDAGE [SCENES]
"""

import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import manifold3d
import numpy as np


def triangles(body):
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties)[:, :3][np.array(mesh.tri_verts)]


def random_body(rng):
    kind = rng.choice("bps")
    if kind == "b":
        body = manifold3d.Manifold.cube([rng.uniform(0.2, 3.0) for _ in range(3)], True)
    elif kind == "p":
        body = manifold3d.Manifold.cylinder(rng.uniform(1.0, 5.0), rng.uniform(0.1, 0.6), -1.0, rng.choice([8, 24, 48]), True)
    else:
        body = manifold3d.Manifold.sphere(rng.uniform(0.3, 1.2), rng.choice([12, 24]))
    turn = [rng.uniform(0.0, 360.0) for _ in range(3)]
    return body.rotate(turn).translate([rng.uniform(-1.5, 1.5) for _ in range(3)])


def write(path, faces):
    with open(path, "w") as out:
        out.write("solid body\n")
        for face in faces:
            corners = "".join("vertex %r %r %r\n" % tuple(map(float, p)) for p in face)
            out.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        out.write("endsolid body\n")


def check(voidage, seed, directory):
    rng = random.Random(seed)
    bodies = [random_body(rng) for _ in range(rng.randint(1, 7))]
    files = [directory / f"{n}.stl" for n in range(len(bodies))]
    for body, path in zip(bodies, files):
        write(path, triangles(body))
    union = triangles(manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add))
    normals = np.cross(union[:, 1] - union[:, 0], union[:, 2] - union[:, 0])
    wetted = np.linalg.norm(normals, axis=1).sum() / 2
    frontal = np.abs(normals).sum(axis=0) / 4
    cells = rng.choice(["7x9x6", "3x2x4", "1x1x1", "17x13x11"])
    report = directory / "report.json"
    grid = ["--cells", cells, "--bounds=-4.637,-4.711,-4.293,4.19,4.77,4.13"]
    subprocess.run([voidage, "porosity", *files, *grid, "--resistance", "--report", report, "-q"], check=True)
    found = json.loads(report.read_text())["obstacles"]
    error = max(abs(found["wetted_area"] - wetted), *abs(np.array(found["frontal_area"]) - frontal)) / wetted
    assert error < 1e-12, f"scene {seed}, {cells} cells: {found}, by manifold3d {wetted}, {frontal}"
    return error


def main():
    voidage, scenes = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 40
    with tempfile.TemporaryDirectory() as directory:
        worst = max(check(voidage, seed, Path(directory)) for seed in range(scenes))
    print(f"obstacles: {scenes} scenes as by manifold3d, largest difference {worst:.1e} of the area")


if __name__ == "__main__":
    main()
