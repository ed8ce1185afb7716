"""The report as one HTML file: words, and charts in the laboratory's style."""

import cmath
import html
import math
import pathlib
import re
import sys
import tempfile

import judge
import orders
import table as tables
import teacher
from workshop import ROOT

sys.path.append(str(ROOT / "lab/charts"))

from panels import DARK, GRAY, Axis, Curve, Panel, Picture, styles  # noqa: E402
from results import Table, believed, by_method, runs                # noqa: E402

OWN, INSIDE, OUTSIDE = "#cc0000", "#0072B2", "#cc0000"
SHOWN = ("symplectic-euler", "verlet", "rk4", "pefrl", "srkn11b")
STABLE, WEAK, UNSTABLE = "#cfe6f5", "#fdecc8", "#f7dcdc"
EVALUATIONS = "force evaluations"


# ---- Its dot among the laboratory's methods

def among_methods(verdict: judge.Verdict, out: pathlib.Path) -> None:
    table = Table("lab/charts/results/work_precision.csv")
    picture = Picture(out, 800, 450, "Error against force evaluations: yours "
                      "in red", "Down is cheaper, right is more accurate. "
                      "Gray: other methods of the laboratory.\nWith a force "
                      "kept for the next step if it can be.",
                      table.footer())
    look = styles()
    for k, scene in enumerate(("chain", "curtain")):
        x, y = Axis(1e-1, 1e-12), Axis(10, 1e6)
        own = [(e, n) for _, n, e in verdict.data[f"chart.{scene}"]
               if x.hi < e < x.lo and y.lo < n < y.hi]
        curves, behind = [], []
        for method, some in by_method(believed(runs(
                table.where(scene=scene)))).items():
            points = [(r.error, r.evaluations) for r in some
                      if x.hi < r.error < x.lo and y.lo < r.evaluations < y.hi]
            if method in SHOWN:
                curves.append(Curve(method, points, look[method][0], 0,
                                    method))
            else:
                behind.append(Curve(method, points, GRAY))
        curves.append(Curve("yours", own, OWN, 7, verdict.step))
        about = table.note("scene " + scene).split("; ")[0]
        panel = Panel(72 + 370 * k, 82, 415 + 370 * k, 365, x, y,
                      f"{scene}: {about}", curves, behind)
        picture.draw(panel, xlabel="RMS error of the positions [m]",
                     ylabel="" if k else EVALUATIONS, ynames=k == 0)
    picture.finish()


# ---- Order

def convergence(verdict: judge.Verdict, out: pathlib.Path) -> None:
    look = (("chain", OWN), ("kepler", "#0072B2"), ("driven", "#009E73"),
            ("drag", "#888888"))
    curves, notes = [], []
    for name, color in look:
        o = verdict.orders[name]
        points = [(n, e) for n, _, e in o.points if 1e-15 < e < 10]
        fit = [(n, e) for n, _, e in o.points[o.first:o.last + 1]]
        label = f"{name} {o.order:.2f}" if o.order == o.order else name
        curves.append(Curve(name, points, color, 0, label, rings=[
            p for p in (fit[:1] + fit[-1:]) if p in points]))
        notes.append(f"{name}: {orders.ABOUT[name]}")
    steps = [n for c in curves for n, _ in c.points]
    picture = Picture(out, 1000, 430, "Order: the slope of the error",
                      "Rings: the range that is fitted, above round-off.", "")
    for k, line in enumerate(("; ".join(notes[:2]), "; ".join(notes[2:]))):
        picture.text(20, 30 - 16 * k, line, 10, GRAY)
    panel = Panel(90, 95, 930, 355, Axis(min(steps, default=1) * .8,
                                         max(steps, default=2) * 1.6),
                  Axis(1e-15, 10), "", curves, at_end=True)
    picture.draw(panel, xlabel="steps", ylabel="error [m]")
    picture.finish()


# ---- Where it fails

def around(verdict: judge.Verdict) -> list[tuple]:
    """[(words, dt omega, matrix, color)] just inside and just outside."""
    line, limit = verdict.data["line"], verdict.limit

    def at(z):
        return min(line, key=lambda row: abs(row[0] - z))
    if limit == math.inf:
        return [("the largest tried", 12, at(12)[2:], INSIDE)]
    if limit == 0:
        return [("any step", .1, at(.1)[2:], OUTSIDE)]
    return [("just inside", .98 * limit, at(.98 * limit)[2:], INSIDE),
            ("just outside", 1.02 * limit, at(1.02 * limit)[2:], OUTSIDE)]


def motion(m: orders.Vector, steps: int) -> list[tuple[int, float]]:
    a, c, b, d = m
    x, v, found = 1.0, 0.0, [(0, 1.0)]
    for k in range(steps):
        x, v = a * x + b * v, c * x + d * v
        found.append((k + 1, x))
    return found


def cause(verdict: judge.Verdict) -> str:
    """Why it grows just outside, in words."""
    words, z, m, color = around(verdict)[-1]
    if color == INSIDE:
        return "No step up to dt omega = 12 makes an oscillation grow."
    a, c, b, d = m
    half, det = (a + d) / 2, a * d - b * c
    root = cmath.sqrt(half * half - det)
    worst = max((half + root, half - root), key=abs)
    growth = (f"grows {abs(worst):.3g} times a step" if abs(worst) > 2 else
              f"grows by {abs(worst) - 1:.2%} a step")
    at = f"At dt omega = {z:.2f} an oscillation {growth}"
    if abs(worst.imag) > 1e-9:
        return (f"{at}, and goes on swinging: each step ends a little outside "
                "of the circle of constant energy, as the force belongs to "
                "positions that are too old.")
    if worst.real < 0:
        return (f"{at}, and changes its sign each time: the kick overshoots, "
                "and more so in each step.")
    if z > math.pi:
        return (f"{at}, to one side: a step is longer than half a swing, and "
                "its kicks push the mass on where they should bring it back.")
    return (f"{at}, to one side: the forces push away from the rest "
            "position, as if a spring had the wrong sign.")


def region(verdict: judge.Verdict, out: pathlib.Path) -> None:
    picture = Picture(out, 1000, 430, "Where an oscillator is stable",
                      cause(verdict)[:cause(verdict).find(":")
                                     if ":" in cause(verdict) else None], "")
    end = 12 if 5 < verdict.limit < math.inf else 6
    x, y = Axis(0, end, False), Axis(0, 6, False)
    panel = Panel(80, 100, 460, 350, x, y, "frequency and drag", [])
    rows: dict[float, list] = {}
    for z, drag, r in verdict.data["map"]:
        if z <= end:
            rows.setdefault(drag, []).append((z, r))
    for drag, row in rows.items():
        start, last = 0, None
        for z, r in [*row, (end + .0625, None)]:
            kind = None if r is None else (
                STABLE if r <= 1 + 1e-6 else WEAK if r < 1.02 else UNSTABLE)
            if kind != last:
                if last:
                    (x0, y0), (x1, y1) = (panel.pixel(p) for p in (
                        (start, max(0, drag - .0625)),
                        (min(end, z - .03125), min(6, drag + .0625))))
                    picture.box(x0, y0, x1, y1 + .3, last)
                start, last = max(0, z - .03125), kind
    for k, (color, words) in enumerate(((STABLE, "stable"),
                                        (WEAK, "grows < 2 % a step"),
                                        (UNSTABLE, "unstable"))):
        left = (80, 160, 310)[k]
        picture.box(left, 20, left + 14, 32, color)
        picture.text(left + 18, 26, words, 10, DARK)
    picture.line(*panel.pixel((2, 0)), *panel.pixel((2, 6)), GRAY, 1, "--")
    picture.text(panel.pixel((2.08, 0))[0], panel.top - 10, "Verlet's limit",
                 10, GRAY)
    picture.draw(panel, xlabel="dt omega", ylabel="dt c/m")
    curves = []
    for words, z, m, color in around(verdict):
        points = [(n, max(-4, min(4, u))) for n, u in motion(m, 60)
                  if abs(u) < 40]
        curves.append(Curve(words, points, color, 0,
                            f"{words}: dt omega = {z:.2f}"))
    picture.draw(Panel(560, 100, 970, 350, Axis(0, 60, False),
                       Axis(-4, 4, False), "without drag", curves),
                 xlabel="steps", ylabel="position / position at the start")
    picture.finish()


def failure(verdict: judge.Verdict, out: pathlib.Path) -> None:
    low, high, safe = verdict.data["grid1"]
    inside, outside = (verdict.data[k] for k in ("inside", "outside"))
    curves = []
    if inside:
        curves.append(Curve("in", [tuple(r) for r in inside], INSIDE, 0,
                            f"dt = {low:.3g} s"))
    shown = [(t, min(e, .6)) for t, e in outside if math.isfinite(e)]
    if shown:
        curves.append(Curve("out", shown, OUTSIDE, 0,
                            f"dt = {1.02 * high:.3g} s"))
    finite = [e for c in curves for _, e in c.points]
    picture = Picture(out, 1000, 430, "The assignment's cloth grid1, just "
                      "inside and just outside of the largest step",
                      "It starts with 0 J and has no drag: all energy above "
                      "that comes from the step.", "")
    panel = Panel(90, 70, 480, 350, Axis(0, .25, False),
                  Axis(min(-.05, *finite, 0), .6, False), "energy", curves)
    picture.draw(panel, xlabel="time [s]", ylabel="energy [J]")
    if verdict.data["shape.outside"]:
        p = verdict.data["shape.outside"][0]
        n = math.isqrt(len(p) // 3)
        at = [[(p[3 * (i * n + j)], p[3 * (i * n + j) + 2]) for i in range(n)]
              for j in range(n)]
        flat = [q for row in at for q in row if all(map(math.isfinite, q))]
        xs = [min(2, max(-1, q[0])) for q in flat] or [0, 1]
        zs = [min(1, max(-2, q[1])) for q in flat] or [0, 1]
        lines = [Curve(f"r{j}", [q for q in row
                                 if -1 <= q[0] <= 2 and -2 <= q[1] <= 1],
                       OUTSIDE) for j, row in enumerate(at)]
        for c in lines:
            c.label = ""
        picture.draw(Panel(580, 70, 970, 350,
                           Axis(min(xs) - .05, max(xs) + .05, False),
                           Axis(min(zs) - .05, max(zs) + .05, False),
                           "just outside, at the end, from the side",
                           [], lines), xlabel="x [m]", ylabel="z [m]")
    picture.finish()


def long_run(verdict: judge.Verdict, out: pathlib.Path) -> None:
    rows = verdict.data["energy"]
    first = rows[0][1]
    points = [(t, e / first) for t, e, *_ in rows
              if math.isfinite(e) and abs(e) < 5 * abs(first)]
    lo, hi = (f([e for _, e in points]) for f in (min, max))
    margin = max(.02, .2 * (hi - lo))
    picture = Picture(out, 1000, 330, f"Energy: {verdict.energy[1]}",
                      "Four masses and six springs, without drag: the true "
                      "energy stays.", "")
    panel = Panel(90, 70, 960, 250, Axis(0, points[-1][0] or 1, False),
                  Axis(min(1, lo) - margin, max(1, hi) + margin, False), "",
                  [Curve("e", points, OWN)])
    picture.draw(panel, xlabel="time [s]", ylabel="energy / at first")
    picture.finish()


# ---- The page

STYLE = """body{font:16px/1.45 'DejaVu Sans',Arial,sans-serif;color:#222;
max-width:1000px;margin:2em auto;padding:0 1em}h1{font-size:1.5em}
h2{font-size:1.15em;margin-top:2em}svg{width:100%;height:auto}
table{border-collapse:collapse}td,th{padding:.25em .8em .25em 0;
text-align:left;vertical-align:top;border-bottom:1px solid #eee}
th{font-weight:normal;color:#666}.is{font-size:1.1em}.fault{color:#a00}
.next{background:#eef5fb;padding:.7em 1em}code{color:#666}
:root{color-scheme:light dark}@media(prefers-color-scheme:dark){body{
background:#161616;color:#e8e8e8}svg{filter:invert(.92) hue-rotate(180deg)}
.next{background:#1d2b38}.fault{color:#ff8a7a}th,code{color:#a8a8a8}
td,th{border-color:#444}}"""


def inline(text: str, number: int) -> str:
    """An SVG whose ids no other picture of the page has."""
    text = text[text.index("<svg"):]
    text = re.sub(r"\bid=(['\"])", rf"id=\1c{number}-", text)
    text = re.sub(r"(href=['\"]#|url\(['\"]?#)", rf"\1c{number}-", text)
    return text


def coefficients(t: tables.Table) -> str:
    rows = ["<tr><th>force</th><th>at, in dt v</th><th>time, in dt</th>"
            "<th>share in the new velocity</th><th>in the new position</th>"
            "</tr>"]
    for s in range(t.stages):
        rows.append(f"<tr><td>{s + 1}</td>" + "".join(
            f"<td>{x:.10g}</td>" for x in (t.c[s], t.tau[s], t.b[s], t.B[s]))
            + "</tr>")
    return ("<h2>The step as a table</h2><p>Read from what it does with known "
            "forces: v + dt (sum of shares) F/m and x + dt v + dt<sup>2</sup> "
            "(sum of shares) F/m.</p><table>" + "".join(rows) + "</table>")


CHARTS = ((among_methods, "chart.chain", "Among the laboratory's methods"),
          (convergence, "raw", "Order"), (region, "map", "Where it fails"),
          (failure, "grid1", "On the assignment's cloth"),
          (long_run, "energy", "Energy"))


def write(verdict: judge.Verdict, folder: pathlib.Path,
          source: str) -> pathlib.Path:
    """Write folder/report.html; its path."""
    said = html.escape
    head = [f"<p class=is>{said(teacher.first_lines(verdict)[0])}</p>"]
    head += [f"<p class=fault>{said(line)}</p>"
             for line in teacher.first_lines(verdict)[1:]]
    head.append(f"<p class=next>Next: {said(verdict.advice)}</p>")
    rows = "".join(f"<tr><th>{said(what)}</th><td>{said(words)}</td></tr>"
                   for what, words in verdict.facts)
    body = [f"<table>{rows}</table>"]
    body += [f"<p>Note: {said(note)}.</p>" for note in verdict.notes]
    with tempfile.TemporaryDirectory() as drawn:
        for number, (draw, needs, title) in enumerate(CHARTS):
            if needs not in verdict.data:
                continue
            out = pathlib.Path(drawn) / f"{number}.svg"
            draw(verdict, out)
            body.append(f"<h2>{title}</h2>"
                        + inline(out.read_text(encoding="utf-8"), number))
            if draw is region:
                body.append(f"<p>{said(cause(verdict))}</p>")
    if verdict.table:
        body.append(coefficients(tables.pruned(verdict.data["raw"])))
    text = (f"<!doctype html><html lang=en><meta charset=utf-8><title>"
            f"{said(verdict.step)}</title><style>{STYLE}</style>"
            f"<main><h1>{said(verdict.step)} <code>{said(source)}</code></h1>"
            + "\n".join(head + body) + "</main></html>\n")
    folder.mkdir(parents=True, exist_ok=True)
    out = folder / "report.html"
    part = folder / "report.part"
    part.write_text(text, encoding="utf-8")
    part.replace(out)
    return out
