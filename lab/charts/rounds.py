"""How near the rounds of an implicit step come to the converged step, and to
the true motion, for how much work a frame."""
from __future__ import annotations

import math
import pathlib

from panels import GRAY, Axis, Curve, Panel, Picture, styles
from results import Table

# In the CSV, in the chart, whose color, and dash.
CURVES = (("fast-mass-spring", "fast-mass-spring", "fast-mass-spring", "-"),
          ("local-global", "dotted: not accelerated", "fast-mass-spring", ":"),
          ("xpbd", "xpbd (substeps)", "xpbd", "-"),
          ("newton-factor", "Newton, Cholesky factor", "implicit-euler", "-"),
          ("newton-gradients", "dotted: by gradients", "implicit-euler", ":"))
TARGETS = (("from step", "off implicit Euler"),
           ("from motion", "off the true motion"))
WITHIN = 0.01  # of the distance moved: what the title asks for
LEAST = 1e-4  # what is closer is drawn here


def cheapest_within(rows: list[dict[str, str]],
                    share: float = WITHIN) -> tuple[str, float] | None:
    """(method, work) of the least work that keeps a share of the motion, of
    the converged step; None if no row does."""
    good = [(float(r["work"]), r["method"]) for r in rows
            if float(r["from step"]) <= share * float(r["moved"])]
    return min(good)[::-1] if good else None


def message(table: Table, nodes: str) -> str:
    """Which method comes within WITHIN of the converged step for least work,
    by stiffness."""
    names = {name: name for name, *_ in CURVES} | {
        "newton-gradients": "conjugate gradients",
        "newton-factor": "a factor"}
    words = []
    for K in dict.fromkeys(r["K"] for r in table.rows):
        best = cheapest_within(table.where(nodes=nodes, K=K))
        words.append((names[best[0]] if best else "none", K))
    parts: list[str] = []
    for name in dict.fromkeys(n for n, _ in words):
        at = [K for n, K in words if n == name]
        parts.append(f"{name} at {'K = ' * (not parts)}{', '.join(at)}")
    return (f"To {100 * WITHIN:.0f} % of implicit Euler: "
            f"{'; '.join(parts)}")


def verlet(nodes: str, K: str) -> float:
    """The force evaluations of a frame by Verlet at its limit, on a sheet
    with diagonals."""
    return math.sqrt(12 * float(K) * int(nodes)) / 2 / 60


def rounds(csv: pathlib.Path, out: pathlib.Path, nodes: str = "625") -> None:
    """A row of panels for each target, a column for each stiffness."""
    table, look = Table(csv), styles()
    some = table.where(nodes=nodes)
    stiffness = list(dict.fromkeys(r["K"] for r in some))
    picture = Picture(
        out, 800, 560, message(table, nodes),
        f"One step of 1/60 s of a falling sheet of {int(nodes):,} nodes: down "
        "is nearer, as a share of the way that it falls.\nPoints: 1, 2, 5, "
        "10, 20 rounds. Dashed: the work of verlet's steps in that time, which "
        "make the true motion.", "")
    x = 20.
    for _, label, like, _ in CURVES:
        picture.text(x, 485, label, 11, look[like][0])
        x += 6.3 * len(label) + 14
    work = [float(r["work"]) for r in some] + [
        verlet(nodes, K) for K in stiffness]
    ax = Axis(min(work) / 1.5, max(work) * 1.5)
    width = (800 - 76 - 16) // len(stiffness)
    for row, (column, what) in enumerate(TARGETS):
        for k, K in enumerate(stiffness):
            of = [r for r in some if r["K"] == K]
            share = {m: [(float(r["work"]),
                          max(float(r[column]) / float(r["moved"]), LEAST))
                         for r in of if r["method"] == m]
                     for m, *_ in CURVES}
            curves = [Curve(m, share[m], look[like][0], 1, dash=dash)
                      for m, _, like, dash in CURVES]
            left = 76 + width * k
            panel = Panel(left, 266 - 204 * row, left + width - 10,
                          444 - 204 * row, ax, Axis(LEAST / 2, 0.5),
                          f"K = {K} N/m" if row == 0 else "", curves)
            at = panel.pixel((verlet(nodes, K), 1))[0]
            picture.line(at, panel.bottom, at, panel.top, GRAY, 1, "--")
            at = panel.pixel((1, WITHIN))[1]
            picture.line(panel.left, at, panel.right, at, GRAY, 1, ":")
            picture.text(panel.right - 4, at + 8,
                         f"{100 * WITHIN:.0f} %" if k == 0 else "", at="right")
            picture.draw(panel, xticks=(10, 100, 1000), ynames=k == 0,
                         xlabel="work [steps of verlet]" if row else "",
                         ylabel="" if k else what)
    picture.finish()
