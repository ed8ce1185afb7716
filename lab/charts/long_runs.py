#!/usr/bin/env python3
"""What survives chaos: averages over runs of 60 s without drag, by method.

    lab/charts/long_runs.py CLOTH > lab/charts/results/long_runs.csv

CLOTH: the program. Positions are predictable for some seconds only. Columns:
for each quantity the mean over 10 to 60 s, its uncertainty (the standard error
of the means of ten blocks of 5 s) and the spread (the standard deviation in
time); the error of the energy at the end, all in J and m."""
from __future__ import annotations

import csv
import math
import statistics
import subprocess
import sys
import tempfile
from typing import Iterator

OMEGA = 305  # the highest frequency of this cloth [1/s]
EXPLICIT = {"symplectic-euler": 2, "verlet": 2, "pefrl": 2.99,
            "srkn11b": 9.07, "rk4": 2.83}  # their limits
IMPLICIT = ("implicit-euler", "tr-bdf2", "xpbd")
SCENE = ("--sheet", "nodes 9 9", "--pin", "x 0 y 0", "--pin", "x 1 y 0",
         "--headless", "--t-end", "60")
START, BLOCK = 10, 5  # [s]
QUANTITIES = {"kinetic": "kinetic", "elastic": "elastic", "height": "com_z"}


def steps() -> Iterator[tuple[str, list[str]]]:
    """(method, options) of each run: half of the limit; 1e-6 m; 1/60 s."""
    for method, limit in EXPLICIT.items():
        yield method, ["--dt", f"{limit / OMEGA / 2:.6g}"]
    yield "rkn64", ["--dt", "0.03"]
    for method in IMPLICIT:
        yield method, ["--dt", f"{1 / 60:.6g}"]


def averages(times: list[float],
             values: list[float]) -> tuple[float, float, float]:
    """(mean, its uncertainty, spread) from START on."""
    found: dict[int, list[float]] = {}
    for t, value in zip(times, values):
        if t >= START:
            found.setdefault(int((t - START) / BLOCK), []).append(value)
    blocks = [some for some in found.values() if len(some) > 5]
    means = [statistics.fmean(some) for some in blocks]
    return (statistics.fmean(means),
            statistics.stdev(means) / math.sqrt(len(means)),
            statistics.pstdev([v for some in blocks for v in some]))


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("method,dt [s],evaluations," + ",".join(
        f"{name},{name} uncertainty,{name} spread" for name in QUANTITIES)
        + ",off [J],status")
    for method, options in steps():
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            done = subprocess.run(
                [sys.argv[1], *SCENE, "--method", method, *options, "--every",
                 "1", "--csv", file.name],
                text=True, capture_output=True, timeout=3600)
            rows = list(csv.DictReader(open(file.name)))
        times = [float(row["t"]) for row in rows]
        dt = options[options.index("--dt") + 1]
        cells: list = []
        for column in QUANTITIES.values():
            cells += averages(times, [float(row[column]) for row in rows]
                              ) if done.returncode == 0 else [""] * 3
        if not rows:
            print(f"{method},{dt}" + "," * 11 + "failed")
            continue
        print(",".join([method, dt, rows[-1]["evaluations"]] + [
            c if c == "" else f"{c:.4g}" for c in cells] + [
            f"{float(rows[-1]['balance']):.4g}",
            "ok" if done.returncode == 0 else "failed"]), flush=True)


if __name__ == "__main__":
    main()
