"""Read the CSV files of lab/*/results, and answer what is asked of them."""
from __future__ import annotations

import csv
import json
import math
import pathlib
import re
from dataclasses import dataclass
from typing import Any, Callable

ROOT = pathlib.Path(__file__).resolve().parents[2]
COARSE = 0.01  # the largest error that is wanted, of a cloth of 1 m [m]
TIE = 0.9  # a cost of which the least one is more than this share ties with it
TRUSTED = 10  # an error below so many floors says nothing


Cost = Callable[["Run"], float]
Segment = tuple[str, float, float]  # method, from, to


class ChartError(Exception):
    """A chart that can't be drawn, and why, in one line."""


def ns_a_node(path: pathlib.Path) -> dict[tuple[int, str], Any]:
    """{(nodes, figure): (lowest, median, highest)} of a JSON of bench."""
    found = {}
    for f in json.loads(path.read_text())["figures"]:
        if nodes := re.match(r"(\d+) nodes", f["group"]):
            found[int(nodes[1]), f["name"]] = tuple(
                1e9 * f[k] / f["items"]
                for k in ("lowest_s", "median_s", "highest_s"))
    return found


class Table:
    """A CSV file. `rows`: dictionaries by the head of a column, without its
    unit. `notes`: the lines before it that begin with #."""

    def __init__(self, path):
        self.path = ROOT / path
        lines = self.path.read_text().splitlines()
        self.notes = [line[2:] for line in lines if line.startswith("#")]
        head: list[str] = []
        self.rows: list[dict[str, str]] = []
        for number, line in enumerate(lines, 1):
            if line.startswith("#"):
                continue
            row = next(csv.reader([line]))
            if not head:
                head = [re.sub(r" \[.*", "", cell) for cell in row]
            elif len(row) != len(head):
                raise ChartError(f"{path}:{number}: {len(row)} cells, "
                                 f"expected {len(head)}")
            else:
                self.rows.append(dict(zip(head, row)))

    def note(self, what: str) -> str:
        """What stands behind `# what: `; '' if nothing does."""
        return next((note[len(what) + 2:] for note in self.notes
                     if note.startswith(what + ": ")), "")

    def footer(self) -> str:
        """Machine, compiler and commit, for the corner of a chart."""
        if not self.note("commit"):
            return self.notes[0]
        return (f"{self.note('machine')}; {self.note('compiler')}; "
                f"commit {self.note('commit')}")

    def where(self, **wanted: str) -> list[dict[str, str]]:
        """The rows that have these values."""
        return [row for row in self.rows
                if all(row[k] == v for k, v in wanted.items())]


# What methods spend on more than forces, in force evaluations: instructions on
# 25 x 25 nodes, counted once by callgrind, in code that was not kept.
# {method: (cost of a step over its force evaluations, of an inner step)}.
SOLVERS = {"xpbd": (41.1, 0.), "mollified-impulse": (3.65, 0.114)}
# A linear system of Newton's method, a product with its matrix, its factor.
NEWTON = 12.5, 2.64, 83.


@dataclass(frozen=True)
class Run:
    """A run of a method on a problem; what is not known is 0."""
    method: str
    dt: float         # [s]
    tolerance: float  # [m], of a method with error control; or its step, too
    share: float      # dt/(largest stable step)
    evaluations: float
    seconds: float    # least of the repeats: noise only adds
    error: float      # [m]
    floor: float      # [m]: error of the reference
    ok: bool
    median: float = 0  # of the seconds of the repeats
    solves: tuple = (0, 0, 0)  # linear systems, products, factors
    inner: float = 0           # steps

    @property
    def work(self) -> float:
        """Counted, in force evaluations. What a run does besides counts
        by its instructions."""
        if self.method in SOLVERS:
            each, inner = SOLVERS[self.method]
            return self.evaluations * each + self.inner * inner
        return self.evaluations + sum(
            n * cost for n, cost in zip(self.solves, NEWTON))


def runs(rows: list[dict[str, str]]) -> list[Run]:
    """The runs in rows of work_precision.csv or of peers.csv."""
    def number(row, name):
        return float(row.get(name) or 0)
    return [Run(row["method"], number(row, "dt"),
                number(row, "tolerance") or number(row, "parameter"),
                number(row, "dt/limit"), number(row, "sweeps"),
                number(row, "seconds_min"), number(row, "error"),
                number(row, "floor"), row.get("status", "ok") == "ok",
                number(row, "seconds_median"),
                tuple(number(row, n) for n in ("systems", "products",
                                               "factors")),
                number(row, "inner")) for row in rows]


def believed(some: list[Run]) -> list[Run]:
    """The runs whose error is their own, not the reference's."""
    return [r for r in some if r.ok and r.error >= TRUSTED * r.floor]


def by_method(some: list[Run]) -> dict[str, list[Run]]:
    """{method: its runs, the coarsest first}."""
    found: dict[str, list[Run]] = {}
    for run in some:
        found.setdefault(run.method, []).append(run)
    return {m: sorted(of, key=lambda r: (-r.tolerance, r.evaluations))
            for m, of in found.items()}


def reliable(of: list[Run]) -> list[tuple[float, Run]]:
    """(error, run) for runs of one method: the error that this run and all
    that cost more keep, or TRUSTED floors if that is more. Largest first. A
    run beyond the stability limit may end well by luck: none of these."""
    kept, worst = [], 0.
    for run in reversed([run for run in of if run.ok and run.share <= 1]):
        worst = max(worst, run.error, TRUSTED * run.floor)
        kept.append((worst, run))
    return kept[::-1]


def cost_at(error: float, of: list[Run], cost: Cost) -> float | None:
    """What runs of one method cost at an error, on the line between the two
    next to it in a log-log chart; None if none is as exact. Down to TRUSTED
    floors only. @a cost: a function of a run."""
    after = None
    for kept, run in reversed(reliable(of)):
        if kept > error:
            if after is None:
                return None
            share = math.log(kept / error) / math.log(kept / after[0])
            return cost(run) * (cost(after[1]) / cost(run)) ** share
        after = kept, run
    return cost(after[1]) if after else None


def cheapest(error: float, some: list[Run], cost: Cost) -> Any:
    """The run that costs least of those that keep an error, as do all finer
    ones of its method; of those that TIE with it the most exact one. None if
    there is none."""
    fit = [(kept, run) for of in by_method(some).values()
           for kept, run in reliable(of) if kept <= error]
    least = min((cost(run) for _, run in fit), default=0)
    return min(((kept, run) for kept, run in fit
                if TIE * cost(run) <= least), default=(0, None),
               key=lambda f: f[0])[1]


def tied(error: float, some: list[Run], cost: Cost) -> list[str]:
    """The other methods that keep an error for at most 1/TIE of the least
    cost, by name."""
    best = cheapest(error, some, cost)
    least = {m: min((cost(r) for kept, r in reliable(of) if kept <= error),
                    default=math.inf) for m, of in by_method(some).items()}
    return sorted(m for m, c in least.items() if best and m != best.method and
                  TIE * c <= min(least.values()))


def winners(some: list[Run], cost: Cost) -> list[Segment]:
    """(method, from, to), from COARSE or less down: whose run is the
    cheapest() at the errors from @a from, which is not one of them, to @a to,
    which is; at the first from it is too."""
    kept = {k for of in by_method(some).values() for k, _ in reliable(of)}
    found: list[Any] = []
    start = min(max(kept, default=0), COARSE)
    # Between two errors that runs keep the choice is the same.
    for error in sorted((k for k in kept if k <= COARSE), reverse=True):
        method = cheapest(error, some, cost).method
        if found and found[-1][0] == method:
            found[-1][2] = error
        else:
            found.append([method, start, error])
        start = error
    return [(method, a, b) for method, a, b in found]
