#!/usr/bin/env python3
"""The tables of lab/fast/README.md, from bench.json and bench-float.json:

    speed_table.py FOLDER     of one machine: medians, and their share of the
                              loop over flat arrays
    speed_table.py machines   of all machines side by side"""
import json
import pathlib
import re
import sys

from results import ROOT, ns_a_node

STEP, SPRINGS = "step: flat arrays", "springs: flat arrays"
ROWS = ((STEP, ""), ("step: SymplecticEuler", STEP),
        ("step: flat arrays, mixed", ""),
        ("step: SymplecticEuler, mixed", STEP),
        ("step: SymplecticEuler, shuffled", STEP), ("step: Verlet", STEP),
        ("step: Rk4", STEP), ("step: symp_euler_step(), functor", STEP),
        ("step: symp_euler_step(), forces", STEP),
        ("step: SymplecticEuler, one at a time", STEP),
        ("step: scene of the assignment", STEP),
        ("step: SymplecticEuler, threads", STEP),
        (SPRINGS, ""), ("springs: Node and Edge", SPRINGS),
        ("springs: flat arrays, torn", ""),
        ("springs: Node and Edge, torn", SPRINGS),
        ("springs: Node and Edge, reindexed", SPRINGS),
        ("springs: virtual call a node", SPRINGS), ("springs: sweep", SPRINGS),
        ("edges: flat arrays", ""), ("edges: Edge", "edges: flat arrays"),
        ("part: drift", ""), ("part: read and write", ""), ("part: floor", ""),
        ("part: ball", ""), ("part: ball that tears", ""),
        ("loading: text to numbers", ""), ("loading: build_cloth()", ""),
        ("loading: build_cloth(), shuffled", ""), ("new layout", ""))


def cell(all_of, nodes, name, beside):
    if (nodes, name) not in all_of:
        return ""
    ns = all_of[nodes, name][1]
    text = f"{ns:.2f}" if ns < 9.95 else f"{ns:.1f}"
    for kind in (", mixed", ", torn", ", reindexed"):
        if name.endswith(kind):
            beside += kind
    other = all_of.get((nodes, beside))
    return f"{text} = {ns / other[1]:.2f}" if other else text


def one_machine(folder):
    double, single = (ns_a_node(folder / name)
                      for name in ("bench.json", "bench-float.json"))
    yield ("| ns a node = share of the loop over flat arrays | 625 | 10,000 "
           "| 1,000,000 | float: 10,000 | 1,000,000 |")
    yield "|---|---|---|---|---|---|"
    for name, beside in ROWS:
        cells = [cell(double, n, name, beside) for n in (625, 10000, 1000000)]
        cells += [cell(single, n, name, beside) for n in (10000, 1000000)]
        yield f"| {name} | {' | '.join(cells)} |"


EULER = "step: SymplecticEuler"
SIDE_BY_SIDE = tuple(
    [(nodes, name, STEP) for nodes in (10000, 1000000) for name in
     (EULER, EULER + ", plain", EULER + ", AVX2", EULER + ", AVX-512",
      EULER + ", mixed", "step: Verlet")] +
    [(10000, "step: scene of the assignment", EULER)] +
    [(nodes, name, EULER) for nodes in (10000, 1000000) for name in
     (EULER + ", one at a time", EULER + ", threads")])


def machines():
    files = sorted(ROOT.glob("lab/bench/results/*/bench.json"))
    all_of = [ns_a_node(file) for file in files]
    about = [re.search("# commit: ([^;]*);", json.loads(
        file.read_text())["about"])[1] for file in files]
    yield "| nodes | time of | over that of | " + " | ".join(
        f"{f.parent.name} ({a})" for f, a in zip(files, about)) + " |"
    yield "|---|---|---|" + "---|" * len(files)
    for nodes, name, beside in SIDE_BY_SIDE:
        cells = []
        for of in all_of:
            other = beside + (", mixed" if name.endswith(", mixed") else "")
            cells.append(f"{of[nodes, name][1] / of[nodes, other][1]:.2f}"
                         if (nodes, name) in of else "")
        yield (f"| {nodes:,} | {name.removeprefix('step: ')} | "
               f"{beside.removeprefix('step: ')} | {' | '.join(cells)} |")


print("\n".join(machines() if sys.argv[1] == "machines"
                else one_machine(pathlib.Path(sys.argv[1]))))
