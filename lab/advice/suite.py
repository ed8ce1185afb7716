#!/usr/bin/env python3
"""How often --advise is right: random scenes, each judged by ./cloth alone.

    lab/advice/suite.py --cloth ./cloth --out build/adviser.csv --scenes 75

asks for advice on each scene of questions.py, runs the advised command as
printed, and compares it with the truth and with the cheapest choice that
trials.py finds. A scene counts as answered if brute force finds a robust choice
and knows the truth to a third of the tolerance. A suite that was interrupted
goes on where it was. Exit status: 0 done; 1 a goal of --goals is missed; 2 bad
option, or --out is of another ./cloth."""
import argparse
import concurrent.futures
import csv
import hashlib
import math
import os
import pathlib
import random
import re
import shlex
import statistics
import sys
import tempfile
from typing import Any

import questions
import trials
from trials import NUMBER

Row = dict[str, Any]  # of COLUMNS, before it is written
LONG_RUN = 2e7  # spring evaluations of a run of about 0.2 s
COLUMNS = ("seed", "kind", "measure", "tolerance", "question", "outcome",
           "nodes", "method", "predicted", "uncertainty", "real", "half",
           "next", "twice", "truth_error", "work", "best_work", "best_error",
           "best", "own_work", "advice_work", "alone", "over_alone", "before",
           "warned")
ALONE = ("verlet", "implicit-euler", "tr-bdf2")
# name: goal (at least; at most if negative), in words.
GOALS = {
    "advised": (92, "% of the scenes that brute force answers are advised"),
    "met": (97, "% of these meet the tolerance"),
    "robust": (95, "% also with half the step and on the next two grids"),
    "moves": (98, "% move as the scene at two moments before, too"),
    "warned": (0, "% of the advised commands warn of themselves"),
    "unbeaten": (100, "% cost at most 1.5 times the advice by one method"),
    "cheap": (80, "% cost at most 1.5 times the cheapest robust choice"),
    "fair": (95, "% cost at most 3 times that"),
    "within": (90, "% of the real errors are within the uncertainty"),
    "contradicted": (-5, "% of the refusals are contradicted by brute force"),
    "price": (-1, "times the work of a long run is the advice's, median"),
}


# ---- Judging: from numbers alone

def rates(rows: list[dict[str, str]]) -> dict[str, float]:
    """The figures of the suite from its rows, by name; NaN without a row."""
    def value(r, name):
        return float(r[name] or "nan")

    def meets(r, *names):
        """A run that failed does not; what was not run is not judged."""
        return all(value(r, name) <= value(r, "tolerance")
                   for name in names if r[name])

    def share(part):
        part = list(part)
        return 100 * sum(part) / len(part) if part else math.nan

    def median(values):
        return statistics.median(values) if values else math.nan

    known = [r for r in rows if r["best_work"]]
    advised = [r for r in known if r["outcome"] == "advised"]
    refused = [r for r in rows if r["outcome"] == "refused"]
    cost = [value(r, "work") / value(r, "best_work") for r in advised
            if r["work"]]
    price = [value(r, "advice_work") / value(r, "own_work") for r in rows
             if r["advice_work"] and value(r, "own_work") >= LONG_RUN]
    return {
        "scenes": len(rows), "known": len(known), "given": len(advised),
        "refused": len(refused), "long": len(price),
        "advised": share(r["outcome"] == "advised" for r in known),
        "met": share(meets(r, "real") for r in advised),
        "robust": share(meets(r, "real", "half", "next", "twice")
                        for r in advised),
        "moves": share(value(r, "before") <= 1 for r in rows
                       if r.get("before")),
        "warned": share(value(r, "warned") for r in rows if r.get("warned")),
        "unbeaten": share(value(r, "over_alone") <= 1.5
                          for r in rows if r.get("over_alone")),
        "cheap": share(c <= 1.5 for c in cost),
        "fair": share(c <= 3 for c in cost),
        "within": share(abs(value(r, "real") - value(r, "predicted")) <=
                        value(r, "uncertainty") + value(r, "truth_error")
                        for r in advised),
        "contradicted": share(value(r, "best_error") <=
                              0.6 * value(r, "tolerance") for r in refused),
        "price": median(price)}


def missed(figures: dict[str, float], goals: dict[str, float]) -> list[str]:
    """Those of the goals that are not reached; NaN is not judged."""
    return [name for name, goal in goals.items()
            if (figures[name] < goal if goal > 0 else figures[name] > -goal)]


def report(rows: list[dict[str, str]]) -> dict[str, float]:
    f = rates(rows)
    print(f"{f['scenes']} scenes; brute force answers {f['known']}, of which "
          f"{f['given']} got advice; {f['refused']} refusals; "
          f"{f['long']} long runs")
    for name, (goal, words) in GOALS.items():
        print(f"{name:12} {f[name]:6.3g} {'>=' if goal > 0 else '<='}"
              f"{abs(goal):4} {'MISSED' if missed(f, {name: goal}) else '':6} "
              f"{words}")
    return f


# ---- A scene

def judge(seed: int, cloth: pathlib.Path, ask: list[str]) -> Row | None:
    """The row of a scene; None if its question is none: the scene can't be
    run, or its answer is that at the start."""
    with tempfile.TemporaryDirectory() as folder:
        s = trials.Scene(seed, folder, cloth)
        steps = s.steps(s.cells, 0.6)
        own = s.at(s.cells, "verlet", steps) if steps else None
        start = s.start(s.cells)
        if not own or not start:
            return None
        tolerance = s.tolerance
        if not tolerance:
            scale = math.dist(own[0], start[0])
            if s.measure == "energy":
                scale = max(scale, own[3])  # drag may take little
            if scale < 1e-5:
                return None
            tolerance = f"{s.share * scale:.2g}"
        words = [*s.grid(), *s.args, "--measure", s.measure, "--tolerance",
                 tolerance]
        row: Row = {
            **dict.fromkeys(COLUMNS, ""),
            "seed": seed, "kind": s.kind, "measure": s.measure,
            "tolerance": float(tolerance), "own_work": own[1],
            "question": "./cloth " + shlex.join(words)}
        asked = ["./cloth", *words, "--advise", *ask]
        command = advice_of(s, row, asked)
        ask_alone(s, row, asked)
        right, row["truth_error"] = s.truth() or ([], "")
        if right and row["truth_error"] <= float(tolerance) / 3:
            if command:
                compare(s, row, shlex.split(command)[1:], right)
            look_for_best(s, row, right)
        return {k: f"{v:.6g}" if isinstance(v, float) else v
                for k, v in row.items()}


def advice_of(s: trials.Scene, row: Row, ask: list[str]) -> str:
    """Fill in what is advised; the advised command, '' if none."""
    status, text, _ = s.child(ask)
    work = re.search("pilots took .*?" + NUMBER + " spring evaluations", text)
    row["advice_work"] = float(work[1]) if work else ""
    first = text.partition("\n")[0]
    said = re.search(rf"(\d+) nodes.* error of {re.escape(s.measure)} " +
                     NUMBER + r".*?\+- " + NUMBER, first)
    command = re.search(r"^ *(\./cloth .*)$", text, re.M)
    if not said or not command:
        row["outcome"] = ("refused" if first.startswith("no advice") else
                          f"failed: {status}")
        return ""
    row["outcome"] = "advised"
    row["nodes"], row["predicted"], row["uncertainty"] = map(float,
                                                             said.groups())
    row["over_alone"] = work_of(text)
    return command[1]


def work_of(text: str) -> float:
    """The spring evaluations of an advised run; infinite without advice."""
    work = re.search("^the advised run takes .*?" + NUMBER + " spring", text,
                     re.M)
    return float(work[1]) if work else math.inf


def ask_alone(s: trials.Scene, row: Row, asked: list[str]) -> None:
    """Fill in the cheapest advice under a single --method, and the work of the
    advice over that."""
    work, method = min((work_of(s.child([*asked, "--method", m])[1]), m)
                       for m in ALONE)
    own, row["over_alone"] = row["over_alone"] or math.inf, ""
    if work < math.inf:
        row["alone"], row["over_alone"] = method, own / work


def compare(s: trials.Scene, row: Row, words: list[str],
            right: list[float]) -> None:
    """The real errors of the advised run, by half the step, on finer grids;
    whether it warns, and how far it is off before its end, in tolerances."""
    status, said, errors = s.child(["./cloth", *words])
    row["warned"] = int(status != 0 or "warning" in errors)
    if "--rest" in words:
        row["method"] = "rest"
        last = re.findall(rf"^{re.escape(s.measure)}: (.*) at t", said, re.M)
        row["real"] = math.dist(trials.numbers(last[0]), right)
        return
    given = {"--method": "symplectic-euler", "--dt": "0.001"}
    for name in ("--method", "--dt", "--measure", "--tolerance"):
        if name in words:
            at = words.index(name)
            given[name], words = words[at + 1], words[:at] + words[at + 2:]
    row["method"] = given["--method"]
    words = [w for w in words if w != "--headless"]
    cells = [tuple(int(n) - 1 for n in nodes) for w in words
             for nodes in re.findall(r"nodes (\d+) (\d+)", w)]

    def run(grids, share):
        left = iter(grids)
        on = [re.sub(r"nodes \d+ \d+", lambda _: "nodes {} {}".format(
            *(n + 1 for n in next(left))), w) for w in words]
        trial = s.run(on, row["method"], repr(float(given["--dt"]) * share))
        return s.error(trial, right), trial[1] if trial else math.inf
    def until(arguments, t):
        at = arguments.index("--t-end") + 1
        return [*arguments[:at], repr(min(t, float(arguments[at]))),
                *arguments[at + 1:]]
    row["real"], row["work"] = run(cells, 1)
    fine, off = s.scaled(48), []
    steps = s.steps(fine, 0.5) or 1
    for low in (0.25, 0.5):  # of moments of its own
        t = s.t_end * random.Random(f"{row['seed']} {low}").uniform(
            low, low + low)
        there = s.run(until(s.grid(fine) + s.args, t), "pefrl",
                      repr(s.t_end / steps))
        mine = s.run(until(words, t), row["method"], given["--dt"])
        if there and mine and there[0]:
            off.append(s.error(mine, there[0]) / row["tolerance"])
    row["before"] = max(off, default="")
    row["half"], _ = run(cells, 1 / 2)
    for name, factor in zip(("next", "twice"), trials.FINER):
        if grids := trials.finer(cells, factor):
            row[name], _ = run(grids, 1 / factor)


def look_for_best(s: trials.Scene, row: Row, right: list[float]) -> None:
    """A refusal is contradicted only by a choice that leaves some room."""
    best = None
    if row["outcome"] != "advised":
        best = s.search(right, row["tolerance"], 0.6)
    best = best or s.search(right, row["tolerance"], 1)
    if best:
        row["best_work"], row["best_error"], row["best"] = best


def read(path: pathlib.Path) -> dict[int, dict[str, str]]:
    """The rows of a table, by their seeds."""
    lines = path.read_text().splitlines()
    return {int(r["seed"]): r for r in csv.DictReader(
        x for x in lines if not x.startswith("#"))}


def goals_of(text: str) -> dict[str, float]:
    goals = dict(item.split("=") for item in text.split(","))
    if not goals.keys() <= GOALS.keys():
        raise ValueError
    return {k: math.copysign(float(v), GOALS[k][0]) for k, v in goals.items()}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cloth", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", type=int, default=75)
    parser.add_argument("--first", type=int, default=1, help="its seed")
    parser.add_argument("--by-hand", action="store_true",
                        help="and the scenes of by_hand.txt")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--ask", type=shlex.split, default=[],
                        help="further words for --advise")
    parser.add_argument("--goals", type=goals_of, default={},
                        help="such as met=97,cheap=80")
    options = parser.parse_args()
    if not os.access(options.cloth, os.X_OK):
        parser.error(f"{options.cloth} can't be run, expected ./cloth")
    made_by = "# cloth " + hashlib.sha256(
        options.cloth.read_bytes()).hexdigest()[:12]
    if not options.out.exists():
        options.out.write_text(f"{made_by}\n{','.join(COLUMNS)}\n")
    if made_by not in options.out.read_text().splitlines():
        parser.error(f"{options.out} is of another ./cloth, expected a new "
                     "file")
    seeds = [*range(options.first, options.first + options.scenes)]
    if options.by_hand:
        seeds += range(-len(questions.BY_HAND.splitlines()), 0)
    left = [k for k in seeds if k not in read(options.out)]
    with open(options.out, "a", newline="") as out, \
            concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        table = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        for done in concurrent.futures.as_completed(
                pool.submit(judge, k, options.cloth, options.ask)
                for k in left):
            if row := done.result():
                table.writerow(row)
                out.flush()
    f = report([r for k, r in read(options.out).items() if k in seeds])
    return int(bool(missed(f, options.goals)))


if __name__ == "__main__":
    sys.exit(main())
