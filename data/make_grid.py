#!/usr/bin/env python3
"""Write a square cloth: make_grid.py SIDE BASE makes BASE.nodes and BASE.tets,
SIDE x SIDE nodes over the unit square, x in the outer loop and y in the inner
one. Format: data/README.md.

    data/make_grid.py 5 data/grid0        25 nodes, 16 quads
    data/make_grid.py 1000 data/grid4     1,000,000 nodes, 998,001 quads"""
import os
import sys
from collections.abc import Iterable


def write(name: str, lines: Iterable[str]) -> None:
    """A file that appears when it is complete."""
    part = f"{name}.{os.getpid()}.part"
    try:
        with open(part, "w") as file:
            file.writelines(lines)
        os.replace(part, name)
    finally:
        if os.path.exists(part):
            os.remove(part)


def main() -> None:
    text = sys.argv[1] if len(sys.argv) == 3 else ""
    side = int(text) if text.isascii() and text.isdigit() else 0
    if not 2 <= side <= 30000:
        raise ValueError("usage: make_grid.py SIDE BASE\nwrites BASE.nodes and "
                         "BASE.tets, SIDE x SIDE nodes, SIDE from 2 to 30000")
    base = sys.argv[2]
    # The shortest text that reads back as the number.
    at = [repr(k / (side - 1)).removesuffix(".0") for k in range(side)]
    write(base + ".nodes", (f"{x} {y} 0\n" for x in at for y in at))
    # The corners of a quad: the first, its neighbors along y and x, the last.
    write(base + ".tets",
          (f"{a} {a + 1} {a + side} {a + side + 1}\n"
           for i in range(side - 1)
           for a in range(i * side, i * side + side - 1)))


try:
    main()
except (OSError, ValueError) as error:
    print(error, file=sys.stderr)
    sys.exit(2)
