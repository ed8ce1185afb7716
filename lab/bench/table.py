#!/usr/bin/env python3
"""What a step costs, as a table, with ratios: lab/fast/README.md.

    lab/bench/table.py BENCH [--filter REGEX] [--sides N ...] [--json FILE]

Figures are measured in turn, in random order, so that a machine that slows
down slows all."""
from __future__ import annotations

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
from typing import Any

TRIADS = "triad, three arrays of doubles"
MEASURED = os.environ.get("MEASURED", "")  # machine, compiler and commit


def measured(program: str, *options: str) -> tuple[Any, Any]:
    """What a program of Google Benchmark writes: (context, {name: runs}), the
    names in its order, the runs by repetition."""
    with tempfile.NamedTemporaryFile() as file:
        subprocess.run([program, *options,
                        "--benchmark_enable_random_interleaving=true",
                        "--benchmark_min_time=0.05",
                        "--benchmark_out_format=json",
                        f"--benchmark_out={file.name}"],
                       check=True, stdout=subprocess.DEVNULL)
        found = json.load(file)
    runs: dict[str, list[dict[str, Any]]] = {}
    of_repetitions = (r for r in found["benchmarks"]
                      if r["run_type"] == "iteration")
    for run in sorted(of_repetitions, key=lambda r: (r["family_index"],
                                                     r["repetition_index"])):
        runs.setdefault(run["name"], []).append(run)
    return found["context"], runs


def figures(runs: dict[str, list[dict[str, Any]]]) -> dict[Any, Any]:
    """The figures, each with its place in bench.json."""
    found = {}
    for name, some in runs.items():
        group, name = name.split("|")
        times = [1e-9 * run["real_time"] for run in some]
        found[group, name] = {
            "group": group, "name": name, "items": int(some[0]["items"]),
            "median_s": statistics.median_high(times), "lowest_s": min(times),
            "highest_s": max(times), "bytes": some[0].get("bytes", 0),
            "beside": some[0].get("label", "")}
    for figure in found.values():
        other = found.get((figure["group"], figure["beside"]))
        if other:
            figure["ratio"] = (figure["median_s"] / figure["items"] /
                               other["median_s"] * other["items"])
    return found


def print_table(context: dict[str, str], found: dict[Any, Any]) -> None:
    def bandwidth(name):  # [GB/s]
        triad = found.get((TRIADS, name))
        return 24e-9 * triad["items"] / triad["median_s"] if triad else 0

    print(f"{MEASURED}; kernels {context['kernels']}; triad in "
          f"memory {bandwidth('in memory'):.1f} GB/s, by all threads "
          f"{bandwidth('in memory, all threads'):.1f} GB/s")
    last = None
    for (group, name), f in found.items():
        if group != last:
            print(f"\n{group:46} ns a node (lowest-highest)   ratio")
        last = group
        median, low, high = (1e9 * f[k] / f["items"] for k in
                             ("median_s", "lowest_s", "highest_s"))
        line = f"  {name:44} {median:8.2f} ({low:.2f}-{high:.2f})"
        if "ratio" in f:
            line += f"   {f['ratio']:.3f} of {f['beside']}"
        if f["bytes"] and bandwidth("in memory"):
            share = f["bytes"] / median / bandwidth("in memory")
            line += f"; {f['bytes']:.0f} bytes: {share:.2f} of the triad"
        print(line)


def write_json(found: dict[Any, Any], path: pathlib.Path) -> None:
    lines = []
    for f in found.values():
        row = {k: v for k, v in f.items() if k != "bytes" and v != ""}
        if "ratio" not in row:
            row.pop("beside", None)
        lines.append(json.dumps(row))
    path.write_text(f'{{"about": {json.dumps(MEASURED)},\n "figures": [\n  ' +
                    ",\n  ".join(lines) + "\n ]}\n")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("--filter", help="only what has this in its name")
    parser.add_argument("--sides", nargs="+", default=[], metavar="N",
                        help="cloths of N x N nodes; usually 25, 100, 1000")
    parser.add_argument("--repetitions", default="9")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    asked = parser.parse_args()
    options = [f"--benchmark_repetitions={asked.repetitions}"]
    if asked.filter:
        options.append(f"--benchmark_filter=^triad|{asked.filter}")
    context, runs = measured(asked.bench, *asked.sides, *options)
    found = figures(runs)
    print_table(context, found)
    if asked.json:
        write_json(found, asked.json)


if __name__ == "__main__":
    main()
