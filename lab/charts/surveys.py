"""Charts of what was surveyed once: the stability of stretched sheets, grids
and steps refined, and how often advice is right."""
from __future__ import annotations

import math
import pathlib

from panels import GRAY, Axis, Curve, Panel, Picture, styles
from results import Table

BLUE, ORANGE, BLACK = "#0072B2", "#D55E00", "#000000"
SAFE = {"plain": 0.0707, "diagonals": 0.0577}  # verlet's step sqrt(nodes) [s]


def limits(csv: pathlib.Path, out: pathlib.Path) -> None:
    """The largest stable step against the number of nodes: measured, predicted
    and safe, a panel for a mesh."""
    table, look = Table(csv), styles()
    apart = max(abs(100 * (float(r["measured"]) / float(r["predicted"]) - 1))
                for r in table.rows)
    picture = Picture(
        out, 800, 430, "Four times the nodes halve the stable step; prediction "
        f"is right to {apart:.1f} %",
        "A sheet stretched to 1.5 times its size, drag 1/s. Points: measured; "
        "lines: predicted; dashed: safe, known before the run.",
        table.footer())
    for k, (mesh, safe) in enumerate(SAFE.items()):
        panel = Panel(72 + 380 * k, 78, 400 + 380 * k, 350, Axis(15, 2e6),
                      Axis(3e-5, 0.05),
                      "plain mesh" if k == 0 else "with diagonals")
        panel.curves = [Curve("safe", [(n, safe / math.sqrt(n))
                                       for n in (15, 2e6)], GRAY, dash="--")]
        for method, words in (("verlet", "verlet = symplectic-euler"),
                              ("rk4", "rk4")):
            rows = table.where(method=method, mesh=mesh)
            nodes = [int(r["side"]) ** 2 for r in rows]
            color = look[method][0]
            panel.curves.append(Curve(
                method, [(n, float(r["predicted"]))
                         for n, r in zip(nodes, rows)], color, label=words))
        panel.keep_free.append((panel.left, panel.bottom, panel.left + 300,
                                panel.bottom + 26))
        ax = picture.draw(panel, xlabel="nodes",
                          ylabel="" if k else "largest stable step [s]")
        for method in ("verlet", "rk4"):
            rows = table.where(method=method, mesh=mesh)
            ax.plot([int(r["side"]) ** 2 for r in rows],
                    [float(r["measured"]) for r in rows], "o", ms=4,
                    color=look[method][0])
        picture.text(panel.left + 12, panel.bottom + 16,
                     f"safe for verlet: {safe:.4f}/sqrt(nodes) s")
    picture.finish()


def grid_refinement(csv: pathlib.Path, out: pathlib.Path) -> None:
    """Cost against error when the grid, the step, or both are refined."""
    table = Table(csv)
    at = {what: [(float(r["error"]), float(r["seconds"]))
                 for r in table.where(refined=what)]
          for what in ("grid", "step", "both")}
    fixed, finest = (table.where(refined=what)[-1]["side"]
                     for what in ("step", "grid"))
    picture = Picture(
        out, 800, 440, "Refine grid and step together; the step alone gains "
        "nothing", table.note("scene"), table.footer())
    panel = Panel(72, 85, 770, 375, Axis(0.06, 0.002), Axis(1e-5, 1))
    panel.curves = [
        Curve("grid", at["grid"], BLUE, 1,
              f"grid alone, at the step that {finest} x {finest} needs"),
        Curve("step", at["step"], ORANGE, 1,
              f"step alone, {fixed} x {fixed} nodes"),
        Curve("both", at["both"], BLACK, 1, "both: each grid at its limit")]
    for row, point in zip(table.where(refined="both"), at["both"]):
        x, y = panel.pixel(point)
        picture.text(x + 8, y - 9, f"{row['side']} x {row['side']}")
        panel.keep_free.append((x + 6, y - 17, x + 60, y))
    picture.draw(panel, xticks=(0.05, 0.02, 0.01, 0.005, 0.002),
                 xlabel="error of the height of the center of mass [m], "
                 "smaller to the right", ylabel="time of a run [s]")
    picture.finish()


def adviser(csv: pathlib.Path, out: pathlib.Path) -> None:
    """What lab/advice/suite.py found: real against predicted error, and chosen
    against best cost, a dot a scene that brute force answers and that got
    advice."""
    table = Table(csv)
    rows = [{k: float(r[k]) for k in ("tolerance", "predicted", "real", "work",
                                      "best_work")}
            for r in table.where(outcome="advised")
            if float(r["best_work"] or 0) > 0]
    met = sum(r["real"] <= r["tolerance"] for r in rows)
    cheap = sum(r["work"] <= 1.5 * r["best_work"] for r in rows)
    picture = Picture(
        out, 800, 470, f"Advice: {met} of {len(rows)} scenes within their "
        f"tolerance, {cheap} near the least work",
        "A dot is a random scene that got advice. The best choice: the "
        "cheapest robust one of all grids, methods and steps.", table.footer())
    panel = Panel(76, 90, 384, 400, Axis(1e-3, 3), Axis(1e-3, 30))
    ax = picture.draw(panel, xlabel="predicted error/tolerance",
                      ylabel="real error/tolerance")
    ax.axhline(1, color=ORANGE, lw=2)
    ax.plot((1e-3, 3), (1e-3, 3), color="#999999", ls="--")
    ax.plot(*zip(*((max(1e-3, r["predicted"] / r["tolerance"]),
                    max(1e-3, r["real"] / r["tolerance"])) for r in rows)),
            "o", ms=4, color=BLUE)
    picture.text(*panel.pixel((1.3e-3, 2.3)), "misses its tolerance",
                 color=ORANGE)
    picture.text(*panel.pixel((3e-3, 1.6e-3)), "as predicted", color=GRAY,
                 turned=38)
    least = [r["best_work"] for r in rows]
    panel = Panel(480, 90, 778, 400, Axis(min(least) / 2, 2 * max(least)),
                  Axis(0.01, 100))  # what lies beyond is drawn on the edge
    ax = picture.draw(panel, yticks=(0.01, 0.1, 0.5, 1, 2, 10, 100),
                      xlabel="work of the best choice [spring evaluations]",
                      ylabel="work of the advice/of the best choice")
    ax.axhline(1, color="#999999", ls="--")
    ax.axhline(1.5, color=ORANGE, lw=2)
    ax.plot(least, [min(100, max(0.01, r["work"] / r["best_work"]))
                    for r in rows], "o", ms=4, color=BLUE)
    picture.text(panel.right - 8, panel.top - 12,
                 "more than 1.5 times the least work", color=ORANGE,
                 at="right")
    picture.finish()
