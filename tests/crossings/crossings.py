#!/usr/bin/python3
"""Draw scenes from the table of fields and hold each promise of a run against
an independent oracle; a scene that breaks one is made as small as it can be.
  crossings.py CLOTH [--scenes N] [--seed S] [--promise P] [--field F]
Status 1: a promise is broken that found.toml does not list as known."""
import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np

import scenes
from oracle import Chaos, Scene
from promises import PROMISES, Broken, Case

HERE = pathlib.Path(__file__).resolve().parent


def broken(cloth: str, folder: pathlib.Path, scene: Scene,
           promise: str) -> Broken:
    """What is wrong with a scene: (kind, lines), or None.  Throws Chaos"""
    case = Case(cloth, folder, scene)
    if case.base.status == 2:
        return None
    return PROMISES[promise](case)


def shrink(cloth: str, folder: pathlib.Path, scene: Scene, promise: str,
           kind: str, tries: int) -> Scene:
    """The smallest scene found that breaks the promise in the same way."""
    left = tries
    while left > 0:
        for other in smaller(scene):
            left -= 1
            if left <= 0 or other == scene or not scenes.names_parts(other):
                continue
            try:
                wrong = broken(cloth, folder, other, promise)
            except (Chaos, subprocess.TimeoutExpired, ValueError, KeyError,
                    IndexError, ZeroDivisionError):
                continue
            if wrong and wrong[0] == kind:
                scene = other
                break
        else:
            break
    return scene


KEEP = {"sheet", "net", "nodes", "dt", "t-end", "method", "measure"}


def smaller(s: Scene) -> Iterator[Scene]:
    """Scenes a little smaller than s, the largest cuts first."""
    for field in [f for f in s if f not in KEEP] + (
            ["tolerance"] if "tolerance" in s and "dt" in s else []):
        yield {f: a for f, a in s.items() if f != field}
    for field, value in s.items():
        parts = value if isinstance(value, list) else [value]
        if isinstance(value, list) and len(value) > 1:
            for k in range(len(value)):
                yield s | {field: value[:k] + value[k + 1:]}
        for k, part in enumerate(parts):
            if not isinstance(part, dict) or field in ("net", "nodes"):
                continue
            for word in set(part) - {"nodes"}:
                less = {w: a for w, a in part.items() if w != word}
                if less:
                    yield with_part(s, field, k, less)
            if field == "sheet":
                n, m = part["nodes"]
                for size in ((2, 2), (n - 1, m), (n, m - 1)):
                    if min(size) >= 1 and size != (n, m) and max(
                            size) > 1 and size <= (n, m):
                        yield with_part(s, field, k, part | {"nodes": size})
    for field in ("net", "nodes"):
        for key in ("velocities", "masses", "held"):
            if key in s.get(field, {}):
                yield s | {field: {k: a for k, a in s[field].items()
                                   if k != key}}
        springs = s.get(field, {}).get("springs", [])
        for k in range(len(springs) if len(springs) > 1 else 0):
            yield s | {field: s[field] | {"springs": springs[:k] +
                                          springs[k + 1:]}}
    if s.get("method", "verlet") != "verlet":
        yield s | {"method": "verlet"}
    yield {f: rounded(f, a) for f, a in s.items()}
    for field in s:
        yield s | {field: rounded(field, s[field])}


def with_part(s: Scene, field: str, k: int, part: Scene) -> Scene:
    if not isinstance(s[field], list):
        return s | {field: part}
    return s | {field: s[field][:k] + [part] + s[field][k + 1:]}


def rounded(field: str, a: Any) -> Any:
    if field in ("net", "nodes", "at", "t-end"):
        return a
    if isinstance(a, dict):
        return {w: rounded(w, b) for w, b in a.items()}
    if isinstance(a, (list, tuple)):
        return type(a)(rounded(field, b) for b in a)
    return float(f"{a:.1g}") if isinstance(a, float) and field not in (
        "x", "y", "z") else a


def from_toml(a: Any) -> Any:
    """Lists of numbers as tuples."""
    if isinstance(a, dict):
        return {k: from_toml(b) for k, b in a.items()}
    if isinstance(a, list):
        made = [from_toml(b) for b in a]
        return made if isinstance(a[0], (dict, list)) else tuple(made)
    return a


def is_known(row: dict, scene: Scene, promise: str, kind: str) -> bool:
    return (row["promise"] == promise and row.get("kind", kind) == kind and
            set(row.get("fields", [])) <= set(scene) and
            bool(re.search(row.get("method", ""), scene.get("method", ""))) and
            row.get("dt", "") in str(scene.get("dt")))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cloth")
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--seed", type=int, default=time.time_ns() % 10**8)
    parser.add_argument("--promise", choices=PROMISES)
    parser.add_argument("--field")
    parser.add_argument("--tries", type=int, default=150)
    parser.add_argument("--all", action="store_true", help="show the known")
    a = parser.parse_args()
    cloth = str(pathlib.Path(a.cloth).resolve())
    missing = set(scenes.table_of_fields()) ^ set(scenes.FIELDS)
    if missing:
        sys.exit(f"{HERE}/scenes.py:1: no way to draw, or no field: {missing}")
    rng = np.random.default_rng(a.seed)
    rows = tomllib.loads((HERE / "found.toml").read_text()).get("found", [])
    pairs: dict[tuple[str, str], int] = {}
    kinds: dict[tuple[str, str, str], list[int]] = {}
    count: collections.Counter = collections.Counter()
    refused: collections.Counter = collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for row in rows:
            if "scene" not in row or a.promise not in (None, row["promise"]):
                continue
            scene = from_toml(row["scene"])
            try:
                wrong = broken(cloth, folder, scene, row["promise"])
            except Chaos as e:
                wrong = "undecided", [str(e)]
            if wrong and "known" not in row:
                show(0, row["promise"], wrong[0], scene, folder, wrong)
                kinds[row["promise"], wrong[0], ""] = [0]
            elif "known" in row and not wrong:
                print(f"mended: {row['known']}")
        for number in range(1, a.scenes + 1):
            scene = scenes.draw(rng, pairs, a.field)
            case = Case(cloth, folder, scene)
            try:
                case.base
            except subprocess.TimeoutExpired:
                count["too long"] += 1
                continue
            if case.base.status == 2:
                refused[case.base.said[0][:100] if case.base.said else ""] += 1
                continue
            count["scenes"] += 1
            for promise in [a.promise] if a.promise else PROMISES:
                try:
                    wrong = PROMISES[promise](case)
                except Chaos:
                    count["undecided " + promise] += 1
                    continue
                except subprocess.TimeoutExpired:
                    wrong = "too long", ["a run took more than a minute"]
                count[promise] += 1
                if not wrong:
                    continue
                kind, lines = wrong
                known = [r for r in rows if "known" in r and
                         is_known(r, scene, promise, kind)]
                key = promise, kind, known[0]["known"] if known else ""
                kinds.setdefault(key, []).append(number)
                if known and not a.all or len(kinds[key]) > 3:
                    continue
                small = shrink(cloth, folder, scene, promise, kind, a.tries)
                show(number, promise, kind, small, folder,
                     broken(cloth, folder, small, promise))
    print(f"seed {a.seed}")
    report(count, refused, kinds, pairs)
    sys.exit(any(not known for _, _, known in kinds))


def show(number: int, promise: str, kind: str, scene: Scene,
         folder: pathlib.Path, wrong: Broken) -> None:
    print(f"\nscene {number}: {promise}, {kind}: {PROMISES[promise].__doc__}")
    print("  " + scenes.command(scene, folder))
    if "net" in scene:
        print("  a.net: " + scenes.net_text(scene["net"]).replace("\n", "; "))
    elif "nodes" in scene:
        print("  " + repr(scene["nodes"]))
    for line in (wrong or (0, []))[1]:
        print("  " + line[:400])
    sys.stdout.flush()


def report(count: collections.Counter, refused: collections.Counter,
           kinds: dict, pairs: dict) -> None:
    print("\n" + ", ".join(f"{k} {n}" for k, n in count.items()))
    for text, n in refused.most_common():
        print(f"refused {n} times: {text}")
    least = sorted((n, p) for p, n in pairs.items())[:5]
    print("pairs drawn least:", *(f"{a} x {b} {n}" for n, (a, b) in least))
    for (promise, kind, known), numbers in sorted(kinds.items()):
        print(f"{promise}, {kind}: {len(numbers)} scenes, first {numbers[0]}" +
              (f" (known: {known})" if known else ""))


if __name__ == "__main__":
    main()
