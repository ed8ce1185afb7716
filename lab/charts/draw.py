"""Draw charts from CSV files, measuring nothing:

    python3 lab/charts/draw.py [NAME...] [--folder DIR] [--to DIR]

NAME: a line of CHARTS below, all of them if none. --folder: where NAME's CSV
is and its pictures go, in place of the results of its room; --to: where the
pictures go. Exit status: 0 done; 2 a chart can't be drawn, and why."""
import argparse
import pathlib
import sys

import decision
import peers
import precision
import rounds
import speed
from panels import gnuplot, quoted
from results import ROOT, ChartError, Table, believed, runs

# In dark mode light and dark change places, and hues stay.
DARK_MODE = ("<style>@media (prefers-color-scheme: dark) {#gnuplot_canvas "
             "{filter: invert(0.92) hue-rotate(180deg)}}</style>\n")

# name: room, CSV, what draws it (a function, or a script of gnuplot).
CHARTS = {
    "work_precision": ("charts", "work_precision.csv",
                       precision.work_precision),
    "decision": ("charts", "work_precision.csv", decision.decision),
    "energy": ("charts", "energy.csv", precision.energy),
    "grid_refinement": ("charts", "grid_refinement.csv",
                        "charts/grid_refinement.gp"),
    **{f"stability_{m}": ("charts", f"stability_{m}.csv",
                          f"charts/stability_{m}.gp")
       for m in ("limits", "growth")},
    "adviser": ("advice", "adviser.csv", "advice/adviser.gp"),
    "rounds": ("bench", "rounds.csv", rounds.rounds),
    "peers": ("bench", "peers.csv", peers.peers),
    "speed": ("bench", "*/bench.json", speed.speed),
}


def pictures(name, csv):
    """(scene, name of the picture) of each picture of a chart; none of a
    scene where all runs failed."""
    if name == "work_precision":
        table = Table(csv)
        scenes = [s for s in dict.fromkeys(r["scene"] for r in table.rows)
                  if s in precision.DRAWN]
        return [(scene, scene) for scene in scenes
                if believed(runs(table.where(scene=scene)))]
    if name == "rounds":
        return [("625", "rounds-625")]
    return [("", name)]


def draw(name, csv, to):
    """Draw the pictures of a chart; yields the files."""
    how = CHARTS[name][2]
    for scene, picture in pictures(name, csv):
        out = to / (picture + ".svg")
        part = out.with_suffix(".part")
        if callable(how):
            how(csv, part, *([scene] if scene else []))
        else:
            gnuplot([f"csv = {quoted(str(csv))}", f"scene = {quoted(scene)}",
                     f"out = {quoted(str(part))}", f"load 'lab/{how}'"], part)
        # Cells of a map stay cells when they are magnified.
        part.write_text(part.read_text().replace(
            "<image ", "<image style='image-rendering:pixelated' ").replace(
                "<g id=\"gnuplot_canvas\">", DARK_MODE +
                "<g id=\"gnuplot_canvas\">", 1))
        part.replace(out)
        yield out


def main():
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
        sys.exit(f"{error}" if isinstance(error, (ChartError, OSError))
                 else f"draw.py: {error!r}")
