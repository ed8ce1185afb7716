"""Draw charts from CSV files, measuring nothing:

    python3 lab/charts/draw.py [NAME...] [--folder DIR] [--to DIR]

NAME: a line of CHARTS below, all of them if none. --folder: where NAME's CSV
is and its pictures go, in place of the results of its room; --to: where the
pictures go. Needs matplotlib; if this Python has none, /usr/bin/python3 is
tried. Exit status: 0 done; 2 a chart can't be drawn, and why."""
from __future__ import annotations

import argparse
import pathlib
import sys
from typing import Callable, Iterator

import decision
import peers
import precision
import surveys
from panels import find_matplotlib
from results import ROOT, ChartError, Table, believed, runs

# name: room, CSV, the function that draws it.
CHARTS: dict[str, tuple[str, str, Callable[..., None]]] = {
    "work_precision": ("charts", "work_precision.csv",
                       precision.work_precision),
    "decision": ("charts", "work_precision.csv", decision.decision),
    "grid_refinement": ("charts", "grid_refinement.csv",
                        surveys.grid_refinement),
    "stability_limits": ("charts", "stability_limits.csv", surveys.limits),
    "adviser": ("advice", "adviser.csv", surveys.adviser),
    "peers": ("bench", "peers.csv", peers.peers),
}


def pictures(name: str, csv: pathlib.Path) -> list[tuple[str, ...]]:
    """(name of the picture, scene if there is more than one) of each picture
    of a chart; none of a scene where all runs failed."""
    if name == "work_precision":
        table = Table(csv)
        return [(scene, scene) for scene in precision.DRAWN
                if believed(runs(table.where(scene=scene)))]
    return [(name,)]


def draw(name: str, csv: pathlib.Path,
         to: pathlib.Path) -> Iterator[pathlib.Path]:
    """Draw the pictures of a chart; yields the files."""
    for picture, *scene in pictures(name, csv):
        out = to / (picture + ".svg")
        part = out.with_suffix(".part")
        CHARTS[name][2](csv, part, *scene)
        part.replace(out)
        yield out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME",
                        help=" ".join(CHARTS))
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--to", type=pathlib.Path)
    options = parser.parse_args()
    for name in options.names or CHARTS:
        if name not in CHARTS:
            raise ChartError(f"draw.py: no chart {name}, expected one of "
                             f"{' '.join(CHARTS)}")
    find_matplotlib()
    for name in options.names or CHARTS:
        room, pattern, _ = CHARTS[name]
        folder = options.folder or ROOT / "lab" / room / "results"
        found = sorted(folder.resolve().glob(pattern))
        if not found:
            raise ChartError(f"{folder}/{pattern}: is not there")
        for csv in found:
            to = (options.to or csv.parent).resolve()
            to.mkdir(parents=True, exist_ok=True)
            for picture in draw(name, csv, to):
                print(picture.relative_to(ROOT)
                      if picture.is_relative_to(ROOT) else picture)


if __name__ == "__main__":
    try:
        main()
    except (ChartError, OSError, ValueError, KeyError) as error:
        print(error if isinstance(error, (ChartError, OSError))
              else f"draw.py: {error!r}", file=sys.stderr)
        sys.exit(2)
