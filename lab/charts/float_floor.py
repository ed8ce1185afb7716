#!/usr/bin/env python3
"""How far single precision ends from double:

    lab/charts/float_floor.py ENDS FLOAT_ENDS > float_floor.csv

Both are written by work_precision --ends, the second by a build with
REAL=float. The error of the method cancels; round-off is left. The floor of a
scene is the least distance, as no run in single precision is known to be more
accurate."""
import math
import pathlib
import sys

WEIGHT = 9.81  # of the cloth [N]


def ends(text):
    """({(scene, method, steps): (end [s], numbers)}, comments)"""
    found, notes = {}, []
    for line in text.splitlines():
        if line.startswith("#"):
            notes.append(line)
            continue
        scene, method, end, steps, *numbers = line.split()
        found[scene, method, int(steps)] = (float(end),
                                            [float(x) for x in numbers])
    return found, notes


def distance(a, b):
    """As distance() of Problem.hpp [m], and the name of the norm."""
    if len(a) == 4:
        return (math.hypot(math.dist(a[1:], b[1:]), (a[0] - b[0]) / WEIGHT),
                "center of mass and energy/(M g)")
    return (math.dist(a[4:], b[4:]) / math.sqrt((len(a) - 4) / 3),
            "rms position")


def table(text, other):
    (double, notes), (single, _) = ends(text), ends(other)
    if double.keys() != single.keys():
        sys.exit("float_floor.py: expected two files of the same runs")
    rows, floor = [], {}
    for key, (end, numbers) in double.items():
        scene, method, steps = key
        apart, norm = distance(numbers, single[key][1])
        rows.append(f"{scene},{method},{end / steps:.6g},{steps},{apart:.6g},"
                    f"{norm}")
        floor[scene] = min(apart, floor.get(scene, apart))
    yield ("# how far single precision ends from double; columns: "
           "lab/charts/README.md")
    yield from notes[1:]
    for scene, least in sorted(floor.items()):
        yield f"# single precision floor {scene}: {least:.1g} m"
    yield "scene,method,dt [s],steps,distance [m],norm"
    yield from rows


if __name__ == "__main__":
    print("\n".join(table(*(pathlib.Path(path).read_text()
                            for path in sys.argv[1:]))))
