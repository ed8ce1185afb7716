#!/usr/bin/env python3
"""The tables of graphs in README.md:  lab/bench/peers/graphs.py GRAPH_PEERS

Our column has our median; the others have the ratio of the medians, and in
parentheses the lowest and the highest ratio of a repetition."""
from __future__ import annotations

import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from table import measured  # noqa: E402


def cell(ours: list[float], theirs: list[float] | None) -> str:
    if not theirs:
        return ""
    ratios = [b / a for a, b in zip(ours, theirs)]
    middle = statistics.median(theirs) / statistics.median(ours)
    return f"{middle:.2f} ({min(ratios):.2f}-{max(ratios):.2f})"


def main() -> None:
    _, runs = measured(*sys.argv[1:], "--benchmark_repetitions=15")
    names = list(dict.fromkeys(key.split("/")[1] for key in runs))
    times = {key: [1e-3 * run["cpu_time"] for run in some]  # [us]
             for key, some in runs.items()}
    print("\n|  | " + " | ".join(names) + " |\n" + "|---" * (len(names) + 1)
          + "|")
    for row in dict.fromkeys(key.split("/")[0] for key in runs):
        if row == "bytes":
            continue
        ours = times[f"{row}/{names[0]}"]
        cells = [f"{statistics.median(ours):.0f} us"]
        cells += [cell(ours, times.get(f"{row}/{name}")) for name in names[1:]]
        print(f"| {row} | {' | '.join(cells)} |")
    print("\n| bytes | " + " | ".join(names) + " |\n"
          + "|---" * (len(names) + 1) + "|")
    for what in ("a node", "an edge"):
        print(f"| {what} | " + " | ".join(
            f"{runs['bytes/' + name][0][what]:.0f}" for name in names) + " |")


if __name__ == "__main__":
    main()
