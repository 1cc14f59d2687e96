#!/usr/bin/env python3
"""Writes the tables of docs/study.md from the results beside this file, between `<!-- table: NAME -->` and `<!-- end -->`.

python3 docs/study/tables.py, after `voidage study host/examples/study/NAME.toml -o docs/study/NAME` for those that were taken again.
"""
import csv
import pathlib
import re

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parent / "study.md"
LEFT_OUT = ["skid", "platform", "solids", "unions", "flow"]


def table(head, rows):
    """Markdown; what is right of the first three columns is numbers."""
    rule = ["---:" if n > 2 else "---" for n in range(len(head))]
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, rule, *rows]) + "\n"


def rows_of(name, file="study.csv"):
    with open(HERE / name / file, newline="") as text:
        return list(csv.DictReader(text))


def listed(name, title):
    """The cells of a table of a study's own page, below a heading or a head that begins so."""
    lines = (HERE / name / "study.md").read_text().split(title, 1)[1].splitlines()
    start = next(n for n, line in enumerate(lines) if line.startswith("| ---"))
    end = next((n for n, line in enumerate(lines) if n > start and not line.startswith("|")), len(lines))
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines[start + 1 : end]]


def points(name):
    """Rows of the results, with the full name of each method."""
    rows = rows_of(name)
    names = [row[3] for row in listed(name, "## All points")]
    assert len(rows) == len(names), f"{name}: its page and its table are of two runs"
    return [{**row, "method": full} for row, full in zip(rows, names)]


def share(text):
    value = abs(float(text))
    return "exact to rounding" if value < 1e-13 else f"{float(text):+.1e}"


def plain(name):
    rows = []
    for point in points(name):
        if point["threads"] == "1":
            itself = point["cells_from"].endswith("(itself)")
            cell = "the reference itself" if itself else f"{float(point['cell_error']):.1e}" if point["cell_error"] else "–"
            seconds = f"{float(point['seconds']):.3g}"
            rows.append([point["scene"], point["cells"], point["method"], seconds, share(point["error"]), cell])
    return table(["scene", "cells", "method", "s", "error of the volume", "largest error of a cell"], rows)


def spheres():
    found = {}
    for point in points("spheres"):
        if point["threads"] == "1":
            found.setdefault(point["scene"], {})[point["cells"], point["road"], point["leaf"]] = point
    rows = []
    for scene, of in found.items():
        row = [scene]
        for cells in ["10x10x10", "100x100x100"]:
            exact, paper = of[cells, "surface", "plane"], of[cells, "gjk", "solid"]
            row += [f"{float(p['seconds']):.3g}" for p in (exact, paper)] + [f"{100 * float(paper['error']):+.2f} %"]
        rows.append(row + [f"{100 * float(of[cells, 'gjk', 'half']['error']):+.2f} %"])
    paper = "the paper's point, s"
    head = ["scene", "10³: surface, s", f"10³: {paper}", "its error", "100³: surface, s", f"100³: {paper}", "its error", "100³: half leaf, error"]
    return table(head, rows)


def left_out():
    rows = []
    for name in LEFT_OUT:
        for row in rows_of(name, "study_left_out.csv"):
            times = [f"{float(row[key]):.3g}" for key in ("seconds", "with_it")]
            rows.append([row["scene"], row["cells"], row["left_out"], *times, f"{100 * float(row['saves']):.0f} %"])
    return table(["scene", "cells", "left out", "s without", "s with it", "saves"], rows)


def growth():
    return "".join(line + "\n" for line in (HERE / "growth" / "study.md").read_text().splitlines() if " goes as the power " in line)


def orders():
    return table(["flow", "quantity", "runs", "fitted order", "standard error"], listed("flow", "fitted order"))


TABLES = {"spheres": spheres, "growth": growth, "flow": orders, "left out": left_out}

page = PAGE.read_text()
for name in re.findall(r"<!-- table: (.*?) -->", page):
    text = TABLES[name]() if name in TABLES else plain(name)
    page = re.sub(rf"(<!-- table: {name} -->\n).*?(<!-- end -->)", lambda m: m[1] + text + m[2], page, flags=re.S)
PAGE.write_text(page)
