#!/usr/bin/env python3
"""Reads what `voidage porosity` and `voidage solve` wrote with NumPy, VTK and PyVista, which share no code with it.

usage: check_outputs.py DIR      DIR holds any of *.vtr, beta_*.npy, *.png, *.json, or the results of a flow
needs: pip install numpy vtk pyvista

Checks that every .vtr agrees with the arrays to the bit (cell values, low-side face vectors, staggered faces, shapes),
that 0 <= lower <= value <= upper <= 1, that pictures and reports load. Of a flow: that the series opens with the times
of the report, that its last frame agrees with the arrays of final/ to the bit, that the log is a table. Exit code 1 and a line for each fault.
"""

import json
import pathlib
import struct
import sys
import zlib

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLRectilinearGridReader

faults = []


def check(holds, what):
    if not holds:
        faults.append(what)


def same_bits(a, b):
    return a.shape == b.shape and a.dtype == b.dtype == np.float64 and a.tobytes("F") == b.tobytes("F")


def face_shape(cells, axis):
    return tuple(n + (a == axis) for a, n in enumerate(cells))


def read_arrays(directory):
    """The beta_*.npy files by name; all Fortran-ordered doubles of matching shapes, within their bounds."""
    arrays = {}
    for path in sorted(directory.glob("beta_*.npy")):
        array = np.load(path, allow_pickle=False)
        check(array.dtype == np.dtype("<f8"), f"{path.name}: type {array.dtype}")
        check(array.ndim == 3 and array.flags.f_contiguous, f"{path.name}: not Fortran-ordered in three dimensions")
        check(np.all((array >= 0) & (array <= 1)), f"{path.name}: values outside 0..1")
        arrays[path.stem] = array
    for name, array in arrays.items():
        axis = "xyz".find(name.split("_")[1])
        if "beta_v" in arrays and array.ndim == 3:
            wanted = face_shape(arrays["beta_v"].shape, axis)
            check(array.shape == wanted, f"{name}.npy: shape {array.shape}, not {wanted}")
    for name, lower in arrays.items():
        value, upper = name.removesuffix("_lower"), name.replace("_lower", "_upper")
        if name.endswith("_lower") and value in arrays and upper in arrays:
            ordered = np.all(lower <= arrays[value]) and np.all(arrays[value] <= arrays[upper])
            check(ordered, f"{value}: not between its bounds")
    return arrays


def read_vtr(path):
    """Cell counts, cell arrays shaped [i, j, k(, component)] and free arrays as stored."""
    reader = vtkXMLRectilinearGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    edges = [getattr(grid, f"Get{axis}Coordinates")() for axis in "XYZ"]
    if reader.GetErrorCode() != 0 or any(e is None for e in edges):
        faults.append(f"{path.name}: VTK cannot read it (error {reader.GetErrorCode()})")
        return (0, 0, 0), {}, {}
    edges = [vtk_to_numpy(e) for e in edges]
    check(all(np.all(np.diff(e) > 0) for e in edges), f"{path.name}: edges do not ascend")
    cells = tuple(len(e) - 1 for e in edges)
    check(grid.GetNumberOfCells() == np.prod(cells), f"{path.name}: {grid.GetNumberOfCells()} cells")

    def numbers(data):
        found = (data.GetArray(n) for n in range(data.GetNumberOfArrays()))  # text arrays are None
        return {array.GetName(): vtk_to_numpy(array) for array in found if array is not None}

    shaped = {name: a.reshape(cells + a.shape[1:], order="F") for name, a in numbers(grid.GetCellData()).items()}
    return cells, shaped, numbers(grid.GetFieldData())


def compare(path, arrays):
    cells, cell_data, free = read_vtr(path)
    expected = dict(cell_data)
    for name, array in free.items():
        axis = "xyz".find(name.split("_")[1]) if name.startswith("beta_") else -1
        shape = face_shape(cells, axis)
        if name.startswith("beta_"):
            check(array.size == np.prod(shape), f"{path.name}: {name} has {array.size} values, not {shape}")
            if array.size == np.prod(shape):
                expected[name] = array.reshape(shape, order="F")
    for name, array in arrays.items():
        if name in expected:
            check(same_bits(expected[name], array), f"{path.name}: {name} differs from {name}.npy")
    check("beta_v" in cell_data, f"{path.name}: no beta_v")
    faces = [expected.get(f"beta_{axis}") for axis in "xyz"]
    if "beta_f" in cell_data and all(f is not None for f in faces):
        nx, ny, nz = cells
        for axis, face in enumerate(faces):
            low = same_bits(np.asfortranarray(cell_data["beta_f"][..., axis]), np.asfortranarray(face[:nx, :ny, :nz]))
            check(low, f"{path.name}: component {axis} of beta_f is not the low face")
    return f"{path.name} {cells} {sorted(expected)}"


def check_flow(directory):
    """The results of `voidage solve`."""
    import pyvista

    final = {path.stem: np.load(path, allow_pickle=False) for path in sorted((directory / "final").glob("*.npy"))}
    report = json.loads((directory / "report.json").read_text(encoding="utf-8"))
    for name, array in final.items():
        check(list(array.shape) == report["cells"] and array.flags.f_contiguous, f"final/{name}.npy: shape {array.shape}")
        check(np.all(np.isfinite(array)), f"final/{name}.npy: not finite")
    series = pyvista.get_reader(str(directory / "flow.pvd"))
    check(list(series.time_values) == report["frames"], f"flow.pvd: times {series.time_values}")
    for n, time in enumerate(series.time_values):
        series.set_active_time_value(time)
        grid = series.read()[0]
        check(grid.field_data["TimeValue"][0] == time, f"frame {n}: time {grid.field_data['TimeValue']}")
        check(grid.n_cells == np.prod(report["cells"]), f"frame {n}: {grid.n_cells} cells")
    scalars = ["rho", "p"] + ["beta_v"] * ("beta_v" in grid.cell_data)
    shaped = {name: grid.cell_data[name].reshape(report["cells"], order="F") for name in scalars}
    shaped |= {name: grid.cell_data["velocity"][:, axis].reshape(report["cells"], order="F") for axis, name in enumerate("uvw")}
    check(set(final) == set(shaped), f"final holds {sorted(final)}")
    for name, array in final.items():
        if name in shaped:
            check(same_bits(np.asfortranarray(shaped[name]), array), f"the last frame and final/{name}.npy differ")
    log = np.genfromtxt(directory / "log.csv", delimiter=",", names=True)
    check(log["step"][-1] == report["steps"] and log["time"][-1] == report["time"], "log.csv: its last line is not the end")
    check(np.all(np.isfinite(log["mass"])), "log.csv: the mass is not finite")
    return f"flow: {len(series.time_values)} frames to t = {report['time']}"


def check_picture(path):
    """Chunks, checksums, pixels. By hand: libpng inside VTK crashes on a cut file."""
    rest = path.read_bytes()
    check(rest[:8] == b"\x89PNG\r\n\x1a\n", f"{path.name}: no PNG")
    rest, chunks = rest[8:], []
    while len(rest) >= 12:
        (length,) = struct.unpack(">I", rest[:4])
        kind, data, crc = rest[4:8], rest[8 : 8 + length], rest[8 + length : 12 + length]
        check(crc == struct.pack(">I", zlib.crc32(kind + data)), f"{path.name}: checksum of {kind}")
        chunks.append((kind, data))
        rest = rest[12 + length :]
    if not chunks or chunks[0][0] != b"IHDR" or chunks[-1][0] != b"IEND" or rest:
        faults.append(f"{path.name}: incomplete")
        return path.name
    width, height, depth, colours = struct.unpack(">IIBB", chunks[0][1][:10])
    pixels = zlib.decompress(b"".join(data for kind, data in chunks if kind == b"IDAT"))
    whole = (depth, colours) == (8, 2) and len(pixels) == height * (1 + 3 * width)
    check(whole and len(set(pixels)) > 2, f"{path.name}: not a picture of {width} x {height} pixels")
    return f"{path.name} {width} x {height}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = pathlib.Path(sys.argv[1])
    arrays = read_arrays(directory)
    done = [f"{name}.npy {array.shape}" for name, array in arrays.items()]
    done += [compare(path, arrays) for path in sorted(directory.glob("*.vtr"))]
    pictures = sorted(directory.glob("*.png")) + sorted(directory.glob("frames/*.png"))
    done += [check_picture(path) for path in pictures]
    if (directory / "final").is_dir():
        done.append(check_flow(directory))
    for path in sorted(directory.glob("*.json")):
        json.loads(path.read_text(encoding="utf-8"))
        done.append(path.name)
    check(done, f"{directory}: nothing to check")
    left = [p.name for p in directory.glob(".voidage-*.tmp")]
    check(not left, f"left behind: {left}")
    print("\n".join(done))
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
