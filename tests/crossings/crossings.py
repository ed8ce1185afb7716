#!/usr/bin/python3
"""Draw scenes from the table of fields and hold each promise of a run against
an independent oracle; a scene that breaks one is made as small as it can be.
  crossings.py CLOTH [--scenes N] [--seed S] [--promise P] [--field F]...
  [--least N]
Status 1: a promise is broken that found.toml does not list as known, or a pair
of fields was drawn fewer than --least times."""
import argparse
import collections
import pathlib
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np

import scenes
from oracle import Scene
from promises import PROMISES, Broken, Case, broken

HERE = pathlib.Path(__file__).resolve().parent
# No smaller scene leaves these out.
KEEP = {"sheet", "net", "nodes", "points", "faces", "dt", "t-end", "method",
        "measure", "tolerance"}


def smaller(a: Any) -> Iterator[Any]:
    """A scene, part or list a with one thing less, the largest first."""
    if isinstance(a, dict):
        for w in set(a) - KEEP if len(a) > 1 else ():
            yield {v: b for v, b in a.items() if v != w}
        for w, b in a.items():
            if w == "nodes" and isinstance(b, tuple):
                for n, m in ((2, 2), (b[0] - 1, b[1]), (b[0], b[1] - 1)):
                    if 1 <= n <= b[0] and 1 <= m <= b[1] and 1 < n * m:
                        yield a | {w: (n, m)}
            elif w not in ("points", "faces", "velocities", "masses"):
                yield from (a | {w: c} for c in smaller(b))
    elif isinstance(a, list):
        for k in range(len(a)):
            if len(a) > 1:
                yield a[:k] + a[k + 1:]
            yield from (a[:k] + [c] + a[k + 1:] for c in smaller(a[k]))


def shrink(case: Case, promise: str, wrong: Broken) -> tuple[Case, Broken]:
    """The smallest scene found that breaks the promise in the same way."""
    others = smaller(case.scene)
    for _ in range(150):
        scene = next(others, case.scene)
        other = Case(case.cloth, case.folder, scene)
        try:
            now = broken(other, promise) if scene != case.scene and (
                scenes.names_parts(scene)) else None
        except (subprocess.TimeoutExpired, ValueError, LookupError):
            continue
        if now and wrong and now[0] == wrong[0]:
            case, wrong, others = other, now, smaller(scene)
    return case, wrong


def from_toml(a: Any) -> Any:  # lists of numbers as tuples
    if isinstance(a, dict):
        return {k: from_toml(b) for k, b in a.items()}
    if isinstance(a, list) and isinstance(a[0], (dict, list)):
        return [from_toml(b) for b in a]
    return tuple(a) if isinstance(a, list) else a


def known(rows: list[dict], scene: Scene, promise: str, kind: str) -> str:
    """Why the scene breaks the promise in this kind; empty: not known."""
    return next((row["known"] for row in rows if "known" in row and
                 row["promise"] == promise and row["kind"] == kind and
                 set(row.get("fields", [])) <= set(scene) and
                 all(row.get(word, "") in str(scene.get(word))
                     for word in ("dt", "method"))), "")


def show(title: str, promise: str, case: Case, wrong: Broken) -> None:
    kind, lines = wrong or ("", [])
    print(f"\n{title}: {promise}, {kind}: {PROMISES[promise].__doc__}")
    for line in [scenes.command(case.scene, case.folder), *lines]:
        print("  " + line, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cloth", type=lambda a: str(pathlib.Path(a).resolve()))
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--seed", type=int, default=time.time_ns() % 10**8)
    parser.add_argument("--promise", choices=PROMISES)
    parser.add_argument("--field", action="append", default=[],
                        help="that acts: F, F=WORD or F=twice")
    parser.add_argument("--least", type=int, default=0, help="print how often "
                        "each pair of fields was drawn; 1 if fewer times")
    a = parser.parse_args()
    if missing := set(scenes.table_of_fields()) ^ set(scenes.FIELDS):
        sys.exit(f"{HERE}/scenes.py:1: no way to draw, or no field: {missing}")
    memory = pathlib.Path("/dev/shm")  # a checkpoint waits for its disk
    with tempfile.TemporaryDirectory(
            dir=memory if memory.is_dir() else None) as folder:
        sys.exit(hold(a, pathlib.Path(folder)))


def hold(a: argparse.Namespace, folder: pathlib.Path) -> bool:
    """Hold the promises of the found scenes and of drawn ones."""
    rng = np.random.default_rng(a.seed)
    rows = tomllib.loads((HERE / "found.toml").read_text())["found"]
    kinds: dict[tuple[str, str, str], list[str]] = {}
    pairs: collections.Counter = collections.Counter()
    count: collections.Counter = collections.Counter()

    def one(title: str, case: Case, promise: str) -> Broken:
        try:
            wrong = broken(case, promise)
        except subprocess.TimeoutExpired:
            wrong = "too long", ["a run took more than a minute"]
        if wrong:
            why = known(rows, case.scene, promise, wrong[0])
            numbers = kinds.setdefault((promise, wrong[0], why), [])
            numbers.append(title)
            if not why and len(numbers) <= 3:
                show(title, promise, *(
                    (case, wrong) if wrong[0] == "too long" else
                    shrink(case, promise, wrong)))
        return wrong

    for number, row in enumerate(rows, 1):
        if "scene" in row and a.promise in (None, row["promise"]):
            case = Case(a.cloth, folder, from_toml(row["scene"]))
            kept = not one(f"row {number}", case, row["promise"])
            if kept and "known" in row:
                print(f"mended: {row['known']}")
    for number in range(1, a.scenes + 1):
        case = Case(a.cloth, folder, scenes.draw(rng, pairs, a.field))
        for promise in [a.promise] if a.promise else PROMISES:
            one(f"scene {number}", case, promise)
        refused = case.base.status == 2
        count["refused: " + " ".join(case.base.said)[:100] if refused else
              "held"] += 1
        count["without a truth"] += "truth" in vars(case) and (
            not case.exact < .01)
    print(f"seed {a.seed}: {a.scenes} scenes")
    for text, n in count.most_common():
        print(f"{n} {text}")
    text, few = scenes.table(pairs, a.least)
    if a.least:
        print(text + f"\npairs drawn fewer than {a.least} times: " +
              (", ".join(few) or "none"))
    for (promise, kind, why), titles in sorted(kinds.items()):
        print(f"{promise}, {kind}: {len(titles)} scenes, first {titles[0]}" +
              f" (known: {why})" * bool(why))
    return bool(few) or any(not why for _, _, why in kinds)


if __name__ == "__main__":
    main()
