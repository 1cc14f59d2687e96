"""Fills the blocks of docs/link.md from the examples: what stands between `docs: NAME` and `docs: end` in FILE follows `<!-- FILE: NAME -->`."""

import pathlib
import re
import textwrap

root = pathlib.Path(__file__).resolve().parents[2]
page = root / "docs/link.md"


def block(file: str, name: str) -> str:
    lines = (root / file).read_text().splitlines()
    start = next(n for n, line in enumerate(lines) if line.strip(" /*!#") == f"docs: {name}")
    end = next(n for n in range(start, len(lines)) if lines[n].strip(" /*!#") == "docs: end")
    return textwrap.dedent("\n".join(lines[start + 1 : end])).strip("\n")


def filled(match: re.Match) -> str:
    mark, file, name, fence = match.groups()
    return f"{mark}\n{fence}\n{block(file, name)}\n```"


if __name__ == "__main__":
    marked = r"(?s)(<!-- (\S+): (\w+) -->)\n(```\w+)\n.*?```"
    page.write_text(re.sub(marked, filled, page.read_text()))
