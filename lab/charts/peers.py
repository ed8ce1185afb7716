"""The chart of other libraries' methods beside ours."""
import math

from panels import DARK, LETTER, Axis, Curve, Panel, Picture, quoted
from precision import decades, merged, points_of
from results import COARSE, TRUSTED, Table, by_method, cost_at, runs

LIBRARIES = (("odeint", "Boost.odeint"), ("gsl", "GSL"),
             ("cvode arkode", "SUNDIALS"))
OURS = ("symplectic-euler", "verlet", "pefrl", "srkn11b")
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")


def advantage(some, libraries, cost):
    """(share, error, library's method): by which share of its own cost the
    best of ours is dearer than the best of theirs, on lines between runs, at
    the error where that is largest."""
    of = by_method(some)
    most, error = (0, 0, ""), COARSE
    last = TRUSTED * max(r.floor for r in some)
    while error > last:
        costs = {m: cost_at(error, runs_, cost) for m, runs_ in of.items()}
        ours, theirs = (min(((c, m) for m, c in costs.items()
                             if c and (m in libraries) == is_library),
                            default=(math.inf, "")) for is_library in (0, 1))
        if theirs[1]:
            most = max(most, (1 - theirs[0] / ours[0], error, theirs[1]))
        error /= 10 ** 0.02
    return most


def best_of(of, methods, cost, x):
    """(error, cost) of the cheapest of some methods, along an axis."""
    found, error = [], x.lo
    while error > x.hi:
        costs = [cost_at(error, of[m], cost) for m in methods]
        found += [(error, min(filter(None, costs)))] if any(costs) else []
        error /= 10 ** 0.05
    return found


def peers(csv, out):
    """The best of our methods beside those of other libraries, a panel for a
    library: force evaluations against error above, time below."""
    table = Table(csv)
    of, _ = merged(by_method(runs(table.rows)))
    some = [r for own in of.values() for r in own]
    x = Axis(0.03, TRUSTED * max(r.floor for r in some))
    libraries = [m for m in of if "-" in m and m != "symplectic-euler"]
    look = {}
    for names, title in LIBRARIES:
        theirs = [m for m in libraries if m.split("-")[0] in names.split()]
        look |= {m: (c, title) for m, c in zip(theirs, COLORS, strict=False)}
    costs = (("force evaluations", lambda r: r.evaluations),
             ("time of a run [s]", lambda r: r.seconds))
    most = [advantage(some, libraries, cost) for _, cost in costs]
    picture = Picture(
        out, 800, 656, "At no error is a library cheaper than our methods by "
        f"more than {100 * max(most)[0]:.0f} %",
        "The cloth grid1 without drag, from rest to 0.25 s. Down is cheaper, "
        "right is more accurate. Thick: the cheapest of\n"
        f"{', '.join(OURS)}; thin: the methods of a library.",
        table.footer())
    picture.say(decades(x.hi, x.lo))
    for row, (what, cost) in enumerate(costs):
        points = {m: points_of(of[m], cost, x.lo) for m in look}
        ours = best_of(of, OURS, cost, x)
        ends = [c for own in (ours, *points.values()) for _, c in own]
        y = Axis(min(ends) / 2.5, max(ends) * 1.6)
        for k, (_, title) in enumerate(LIBRARIES):
            panel = Panel(
                72 + 240 * k, 348 - 256 * row, 302 + 240 * k, 566 - 256 * row,
                x, y, title if row == 0 else "",
                [Curve("ours", ours, DARK, label="ours", width=3)] +
                [Curve(m, points[m], color, label=m)
                 for m, (color, library) in look.items() if library == title])
            share, error, method = most[row]
            if (share, title) == (max(most)[0], look[method][1]):
                at = panel.pixel((error, cost_at(error, of[method], cost)))
                words = f"{100 * share:.0f} % cheaper"
                picture.line(at[0], panel.bottom + 18, at[0], at[1] - 4, DARK)
                picture.text(at[0], panel.bottom + 10, words, color=DARK,
                             at="right")
                panel.keep_free.append((at[0] - LETTER * len(words),
                                        panel.bottom, *at))
            picture.draw(panel, *(
                ["set format y '1e%T'", f"set ylabel '{what}' offset 1, 0"]
                if k == 0 else ["set format y ''", "unset ylabel"]),
                "set xlabel " + quoted("RMS error of the positions [m]"
                                       if row else ""))
    picture.finish()
