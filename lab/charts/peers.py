"""The chart of other libraries' methods beside ours."""
import math

from panels import BEHIND, DARK, LETTER, Axis, Picture, quoted
from precision import STRIP, curve_of, decades, merged, row_of_panels
from results import (COARSE, RULE, TRUSTED, Table, believed, by_method,
                     cost_at, runs, winners)

LIBRARIES = (("odeint", "Boost.odeint"), ("gsl", "GSL"),
             ("cvode arkode", "SUNDIALS"))
OURS = ("symplectic-euler", "verlet", "pefrl", "srkn11b")
THEIR_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
THEIR_MARKERS = (7, 9, 5, 13)


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


def peers(csv, out):
    """Our methods beside those of other libraries, a panel for a library:
    force evaluations against error above, time against error below."""
    table = Table(csv)
    of, _ = merged(by_method(runs(table.rows)))
    some = [r for own in of.values() for r in own]
    x = Axis(0.03, TRUSTED * max(r.floor for r in some))
    libraries = [m for m in of if "-" in m and m != "symplectic-euler"]
    look = {}
    for names, _ in LIBRARIES:
        theirs = [m for m in libraries if m.split("-")[0] in names.split()]
        look |= {m: (c, k) for m, c, k in zip(theirs, THEIR_COLORS,
                                              THEIR_MARKERS, strict=False)}
    look |= {m: ("#222222", 0) for m in OURS}
    costs = (("force evaluations", lambda r: r.evaluations),
             ("time of a run [s]", lambda r: r.seconds))
    most = [advantage(some, libraries, cost) for _, cost in costs]
    share = max(most)[0]
    picture = Picture(
        out, 1000, 808, "At no error is a library cheaper than our methods by "
        f"more than {100 * share:.0f} %", "", table.footer())
    picture.text(20, 765, "grid1 without drag, from rest to 0.25 s; ours in "
                 "black, each library in color. Times are those of the "
                 "machine and commit in the corner, not of the other charts.",
                 11)
    picture.text(20, 749, f"Bar at the bottom: {RULE}; gray: a library of "
                 "another panel.", 10, DARK)
    picture.say(decades(x.hi, x.lo))
    for row, (what, cost) in enumerate(costs):
        good = [r for r in believed(some)
                if r.error < x.lo and r.method in look]
        ends = [f(map(cost, good)) for f in (min, max)]
        y = Axis(ends[0] / 4.5, ends[1] * 1.6)
        curves = {m: curve_of(m, of[m], cost, look[m], m, x, x.lo)
                  for m in look}
        groups = []
        for names, title in LIBRARIES:
            shown = [c for m, c in curves.items()
                     if m in OURS or m.split("-")[0] in names.split()]
            groups.append((title if row == 0 else "", shown, []))
        top = 704 - 332 * row
        picture.say("set xlabel " + quoted(
            "RMS error of the positions [m]" if row else ""))
        # odeint-verlet is verlet: it would win and lose by chance.
        panels = row_of_panels(
            picture, groups, (72, top - 290, 985, top), x, y,
            winners([r for r in some if r.method != "odeint-verlet"], cost),
            lambda m, own: (look.get(m, (BEHIND,))[0] if m in own else BEHIND,
                            m in own))
        for k, panel in enumerate(panels):
            if most[row][0] == share and most[row][2] in (
                    m for m in look if m not in OURS and
                    m.split("-")[0] in LIBRARIES[k][0].split()):
                here(picture, panel, (most[row][1], cost_at(
                    most[row][1], of[most[row][2]], cost)),
                    f"{100 * share:.0f} % cheaper")
            picture.draw(panel, *(
                ["set format y '10^{%T}'",
                 f"set ylabel '{what}' offset 1, 0"] if k == 0
                else ["set format y ''", "unset ylabel"]))
    picture.finish()


def here(picture, panel, point, text):
    """A line from below to a point of a panel, with a text left of it."""
    x, y = panel.pixel(point)
    low = panel.bottom + STRIP + 22
    picture.line(x, low - 4, x, y - 4, DARK)
    picture.text(x - 4, low, text, 10, DARK, "right")
    panel.keep_free.append((x - LETTER * len(text), low - 7, x, y))
