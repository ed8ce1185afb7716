"""Time against error, with the methods that are the cheapest at some error in
color and a bar along the lower edge that says where."""
from __future__ import annotations

import math
import pathlib
from typing import Any

from panels import (BEHIND, DASHES, LETTER, Axis, Curve, Panel, Picture,
                    digits, styles)
from results import (COARSE, TRUSTED, Cost, Run, Segment, Table, believed,
                     by_method, runs, winners)

NORMS = {"rms position": "RMS error of the positions [m]",
         "center of mass and energy/(M g)":
         "error of center of mass and energy/(M g) [m]"}
# Scenes with a chart of their own; the decision chart has all.
DRAWN = ("chain", "curtain", "grid0", "grid1", "mixed")
STRIP = 20  # height of the bar of winners [pixels]
NARROW = 0.1  # what a title passes over [decades]


def points_of(some: list[Run], cost: Cost,
              coarsest: float) -> list[tuple[float, float]]:
    """(error, cost) of a method's runs, from its largest stable step on, to
    the first one whose error is less than the axis shows."""
    good = [r for r in some if r.ok and r.share <= 1 and r.error < coarsest]
    shown = len(believed(good)) + 1
    return [(max(r.error, TRUSTED * r.floor), cost(r)) for r in good[:shown]]


def strip(picture: Picture, panel: Panel, segments: list[Segment],
          colors: dict[str, str]) -> None:
    """The winners along the lower edge of a panel, (method, from, to), each
    with its name if there is room for it."""
    y = panel.bottom
    for method, start, end in segments:
        x0, x1 = (panel.pixel((error, panel.y.lo))[0]
                  for error in (start, end))
        picture.box(x0 + 0.5, y + 2, max(x1 - 0.5, x0 + 1), y + STRIP - 2,
                    colors.get(method, BEHIND))
        if method in colors and len(method) * LETTER < x1 - x0:
            picture.text((x0 + x1) / 2, y + STRIP / 2, method, 11, "white",
                         "center")
    panel.keep_free.append((panel.left, y, panel.right, y + STRIP))


def message(segments: list[Segment]) -> str:
    """Who is cheapest, in words: at coarse errors, and at most of the finer
    ones."""
    wide: list[Any] = []
    for method, start, end in segments:
        if wide and wide[-1][0] == method:
            wide[-1][2] = end
        elif start / end >= 10 ** NARROW:
            wide.append([method, start, end])
    if not wide:
        return "No run is stable and above the reference's own error"
    (first, _, bound), *finer = wide
    if not finer:
        return f"{first} is the fastest at every error"
    decades_of: dict[str, float] = {}
    for method, start, end in finer:
        decades_of[method] = (decades_of.get(method, 0) +
                              math.log10(start / end))
    most = max(decades_of, key=lambda m: decades_of[m])
    if most == first:
        return f"{first} is the fastest at most errors"
    return (f"Least time: {first} above {digits(bound)} m, below it "
            f"{'mostly ' if len(decades_of) > 1 else ''}{most}")


def work_precision(csv: pathlib.Path, out: pathlib.Path, scene: str) -> None:
    """Time against error for one scene; some of its runs are believed."""
    table, look = Table(csv), styles()
    some = runs(table.where(scene=scene))
    of = by_method(some)
    floor, norm = some[0].floor, table.where(scene=scene)[0]["norm"]

    def seconds(run):
        return run.seconds
    segments = winners(some, seconds)
    colors = {m: look[m][0] for m, start, end in segments
              if start / end >= 10 ** NARROW}
    x = Axis(10 * COARSE, TRUSTED * floor)
    points = {m: points_of(own, seconds, x.lo) for m, own in of.items()}
    times = [t for own in points.values() for _, t in own]
    y = Axis(min(times) / 4, max(times) * 1.5)
    about = table.note("scene " + scene).split("; error")[0]
    about = about.replace("; exact", "; against the exact solution")
    picture = Picture(
        out, 800, 560, message(segments),
        "Down is faster, right is more accurate. A method is a curve: smaller "
        "and smaller steps, from its largest stable one on.\n"
        "In color: the methods that are the fastest at some error, as the bar "
        "at the bottom says; in gray: all others.", table.footer())
    picture.text(20, 485, f"{scene}: {about}")
    panel = Panel(72, 82, 785, 466, x, y, "", [
        Curve(m, own, colors.get(m, BEHIND), 1, m,
              width=2.1 if m in colors else 1.2, dash=DASHES[look[m][1]])
        for m, own in sorted(points.items(), key=lambda p: p[0] in colors)
        if own])
    strip(picture, panel, segments, colors)
    never = [m for m, own in of.items() if not any(r.ok for r in own)]
    if never:
        picture.text(20, 14, f"{', '.join(never)}: no step succeeded.")
    picture.draw(panel, ylabel="time of a run [s]", xlabel=NORMS[norm])
    picture.finish()
