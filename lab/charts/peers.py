"""The chart of other libraries' methods beside ours."""
from __future__ import annotations

import math
import pathlib
from typing import Iterator

from panels import DARK, LETTER, Axis, Curve, Panel, Picture, digits
from results import (COARSE, TRUSTED, Cost, Run, Table, by_method, cost_at,
                     runs)

# The first word of a method's name: the library, and its color.
LIBRARIES = {"odeint": ("Boost.odeint", "#0072B2"), "gsl": ("GSL", "#D55E00"),
             "cvode": ("SUNDIALS", "#009E73"),
             "arkode": ("SUNDIALS", "#009E73")}
FINE = 1e-6  # the error of which the title speaks [m]
COSTS = (("force evaluations", lambda r: r.evaluations,
          lambda cost: f"{cost:,.0f}"),
         ("times", lambda r: r.seconds, lambda cost: f"{1e3 * cost:.1f} ms"))


def library_of(method: str) -> str:
    """The library's name; '' for ours."""
    return LIBRARIES.get(method.split("-")[0], ("",))[0]


def best(error: float, some: list[Run],
         cost: Cost) -> dict[str, tuple[float, str]]:
    """{library: (cost, method)} of the cheapest at an error, on lines between
    runs; '' is ours. A run without a cost does not count."""
    found: dict[str, tuple[float, str]] = {}
    for method, of in by_method([r for r in some if cost(r)]).items():
        c = cost_at(error, of, cost)
        if c:
            who = library_of(method)
            found[who] = min(found.get(who, (math.inf, "")), (c, method))
    return found


def ladder(some: list[Run]) -> Iterator[float]:
    """Errors from COARSE down to where the reference ends, 20 a decade."""
    error, last = COARSE, TRUSTED * max(r.floor for r in some)
    while error > last:
        yield error
        error /= 10 ** 0.05


def advantage(some: list[Run], cost: Cost) -> tuple[float, float, str]:
    """(share, error, method): by which share of its own cost the best of ours
    is dearer than the best of the libraries, at the error where that is
    largest."""
    most = (0., 0., "")
    for error in ladder(some):
        costs = best(error, some, cost)
        ours = costs.pop("", (math.inf, ""))
        if costs:
            theirs = min(costs.values())
            most = max(most, (1 - theirs[0] / ours[0], error, theirs[1]))
    return most


def factors(error: float, some: list[Run], cost: Cost) -> dict[str, float]:
    """{library: its cost over ours} at an error, of those that reach it."""
    costs = best(error, some, cost)
    ours = costs.pop("", None)
    return {who: c / ours[0] for who, (c, _) in costs.items() if ours}


def message(problems: list[list[Run]]) -> str:
    """The sentence above the chart, by force evaluations."""
    cost = COSTS[0][1]
    share = 100 * max(advantage(some, cost)[0] for some in problems)
    found = [f for some in problems for f in factors(FINE, some, cost).values()]
    less = "fewer" if share < 0.5 else f"over {math.ceil(share)} % fewer"
    return (f"No library needs {less} force evaluations; at "
            f"{digits(FINE)} m they need {min(found):.1f} to "
            f"{max(found):.1f} times as many")


def peers(csv: pathlib.Path, out: pathlib.Path) -> None:
    """Each library's cost over ours against error: force evaluations above,
    time below, a column for a problem."""
    table = Table(csv)
    names = list(dict.fromkeys(row["problem"] for row in table.rows))
    problems = [runs(table.where(problem=name)) for name in names]
    ours = dict.fromkeys(row["method"] for row in table.rows
                         if not library_of(row["method"]))
    picture = Picture(
        out, 800, 640, message(problems),
        "A curve: what a library's cheapest method costs, divided by what the "
        "cheapest of ours costs at the same error. By the thick\nline: which "
        f"of ours ({', '.join(ours)}), and its cost.", table.footer())
    for row, (what, cost, shown) in enumerate(COSTS):
        points = []
        for some in problems:
            found: dict[str, list[tuple[float, float]]] = {}
            for error in ladder(some):
                for who, factor in factors(error, some, cost).items():
                    found.setdefault(who, []).append((error, factor))
            points.append(found)
        ends = [f for found in points for own in found.values() for _, f in own]
        top = 1.4 * max(ends)
        y = Axis(min(0.9 * min(ends), top ** -0.3), top)
        for k, (name, some, found) in enumerate(zip(names, problems, points)):
            x = Axis(COARSE, TRUSTED * some[0].floor)
            panel = Panel(
                72 + 365 * k, 338 - 256 * row, 415 + 365 * k, 538 - 256 * row,
                x, y, f"{name}: {table.note('scene ' + name)}"
                if row == 0 else "",
                [Curve("ours", [(x.lo, 1), (x.hi, 1)], DARK, label="ours",
                       width=3)] +
                [Curve(who, found[who], color, label=who) for who, color in
                 dict(LIBRARIES.values()).items() if who in found])
            for error in (1e-3, 1e-6, 1e-9):
                least, method = best(error, some, cost)[""]
                at, line = panel.pixel((error, 1))
                picture.line(at, line - 5, at, line + 5, DARK, 3)
                middle = max(at, panel.left + 4 + LETTER * len(method) / 2)
                for down, text in ((13, method), (27, shown(least))):
                    picture.text(middle, line - down, text, color=DARK,
                                 at="center")
                panel.keep_free.append((at - 50, line - 34, at + 50, line))
            picture.draw(
                panel, yticks=[v for v in (0.5, 1, 2, 5, 10, 20, 50, 100)
                               if y.lo <= v <= y.hi],
                ynames=k == 0, ylabel="" if k else f"ratio of {what}",
                xlabel="RMS error of the positions [m]" if row else "")
    picture.finish()
