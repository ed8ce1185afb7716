#!/usr/bin/env python3
"""Print the table of lab/fast/README.md from bench.json: the medians, and
their share of the loop over flat arrays:

    speed_table.py FOLDER"""
from __future__ import annotations

import pathlib
import sys
from typing import Iterator

from results import ns_a_node

STEP, SPRINGS = "step: flat arrays", "springs: flat arrays"
ROWS = ((STEP, ""), ("step: SymplecticEuler", STEP),
        ("step: SymplecticEuler, mixed", STEP),
        ("step: SymplecticEuler, shuffled", STEP), ("step: Verlet", STEP),
        ("step: Rk4", STEP), ("step: symp_euler_step(), functor", STEP),
        ("step: SymplecticEuler, one at a time", STEP),
        ("step: scene of the assignment", STEP),
        ("step: SymplecticEuler, threads", STEP),
        (SPRINGS, ""), ("springs: Node and Edge", SPRINGS),
        ("springs: flat arrays, torn", ""),
        ("springs: Node and Edge, torn", SPRINGS),
        ("springs: Node and Edge, reindexed", SPRINGS),
        ("springs: sweep", SPRINGS), ("new layout", ""))


def cell(all_of: dict[tuple[int, str], tuple[float, ...]], nodes: int,
         name: str, beside: str) -> str:
    if (nodes, name) not in all_of:
        return ""
    ns = all_of[nodes, name][1]
    text = f"{ns:.2f}" if ns < 9.95 else f"{ns:.1f}"
    for kind in (", mixed", ", torn", ", reindexed"):
        if name.endswith(kind):
            beside += kind
    other = all_of.get((nodes, beside))
    return f"{text} = {ns / other[1]:.2f}" if other else text


def table(folder: pathlib.Path) -> Iterator[str]:
    all_of = ns_a_node(folder / "bench.json")
    yield ("| ns a node = share of the loop over flat arrays | 625 | 10,000 "
           "| 1,000,000 |")
    yield "|---|---|---|---|"
    for name, beside in ROWS:
        cells = [cell(all_of, n, name, beside) for n in (625, 10000, 1000000)]
        yield f"| {name} | {' | '.join(cells)} |"


print("\n".join(table(pathlib.Path(sys.argv[1]))))
