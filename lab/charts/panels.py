"""Panels of curves, drawn by matplotlib: each curve has its name beside it, in
its color, where it covers least; what belongs to other panels is light gray.
Positions are pixels from the lower left corner of a picture."""
from __future__ import annotations

import importlib.util
import io
import math
import os
import pathlib
import re
import sys
from dataclasses import dataclass, field
from typing import Any

from results import ROOT, ChartError

GRAY, BEHIND, DARK = "#666666", "#c4c4c4", "#222222"
LETTER, LINE = 6.6, 14  # width and height of a letter of size 11 [pixels]
DASHES = {"splitting": "-", "runge-kutta": (0, (5, 1.5)),
          "implicit": (0, (4, 1.2, 1, 1.2))}
# In dark mode light and dark change places, and hues stay.
DARK_MODE = ("<style>@media (prefers-color-scheme: dark) {#figure_1 "
             "{filter: invert(0.92) hue-rotate(180deg)}}</style>\n")
Point = tuple[float, float]
Box = tuple[float, float, float, float]  # left, bottom, right, top


def find_matplotlib() -> None:
    """Go on in Debian's Python if only that one has matplotlib."""
    debian = "/usr/bin/python3"
    if importlib.util.find_spec("matplotlib"):
        return
    if os.environ.get("HAS_MATPLOTLIB") or not os.path.exists(debian):
        raise ChartError("matplotlib is missing, expected python3-matplotlib "
                         "of Debian")
    os.environ["HAS_MATPLOTLIB"] = "no"
    os.execv(debian, [debian, *sys.argv])


def styles() -> dict[str, tuple[str, str]]:
    """{method: (color, family)} of the methods' cards."""
    cards = "".join(path.read_text() for path in sorted(
        (ROOT / "lab/methods").glob("*.hpp")))
    return {name: (color, family) for name, family, color in re.findall(
        r'\.name = "(.+)",\s+\.family = "(.+)",\s+\.color = "(.+)"', cards)}


@dataclass(frozen=True)
class Axis:
    """From lo to hi, which may be smaller; at() maps to 0 ... 1."""
    lo: float
    hi: float
    log: bool = True

    def at(self, value: float) -> float:
        if self.log:
            return math.log(value / self.lo) / math.log(self.hi / self.lo)
        return (value - self.lo) / (self.hi - self.lo)


@dataclass
class Curve:
    name: str
    points: list[Point]
    color: str
    marker: int = 0
    label: str = ""
    rings: list[Point] = field(default_factory=list)  # points with a ring
    width: float = 1.8
    dash: Any = "-"


@dataclass
class Panel:
    """A panel at these pixels of the picture."""
    left: float
    bottom: float
    right: float
    top: float
    x: Axis
    y: Axis
    title: str = ""
    curves: list[Curve] = field(default_factory=list)
    behind: list[Curve] = field(default_factory=list)
    keep_free: list[Box] = field(default_factory=list)
    at_end: bool = False  # names stand where curves end, if they can

    def pixel(self, point: Point) -> Point:
        return (self.left + self.x.at(point[0]) * (self.right - self.left),
                self.bottom + self.y.at(point[1]) * (self.top - self.bottom))


def dense(pixels: list[Point], apart: float) -> list[Point]:
    """Points along a line of pixels, so far apart."""
    found = pixels[:1]
    for (x0, y0), (x1, y1) in zip(pixels, pixels[1:]):
        n = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / apart))
        found += [(x0 + (x1 - x0) * k / n, y0 + (y1 - y0) * k / n)
                  for k in range(1, n + 1)]
    return found


def overlap(a: Box, b: Box) -> float:
    return (max(0, min(a[2], b[2]) - max(a[0], b[0])) *
            max(0, min(a[3], b[3]) - max(a[1], b[1])))


def place_labels(panel: Panel) -> dict[str, tuple[Point, Point]]:
    """{curve's name: (middle of its label, the point of the curve that it
    belongs to)}: near its own curve and no other, off all curves and labels,
    inside of the panel."""
    import numpy as np
    lines = {c.name: np.array(dense([panel.pixel(p) for p in c.points], 2))
             for c in panel.curves if c.points}
    taken = panel.keep_free + [
        (x - 9, y - 9, x + 9, y + 9) for c in panel.curves
        for x, y in map(panel.pixel, c.rings)]
    placed: dict[str, tuple[Point, Point]] = {}

    def within(line: Any, box: Box, margin: float = 0) -> int:
        return int(np.sum((line[:, 0] > box[0] - margin) &
                          (line[:, 0] < box[2] + margin) &
                          (line[:, 1] > box[1] - margin) &
                          (line[:, 1] < box[3] + margin)))
    # A short curve has the fewest places, so it comes first.
    for curve in sorted((c for c in panel.curves if c.points and c.label),
                        key=lambda c: len(lines[c.name])):
        half = LETTER * len(curve.label) / 2 + 2, LINE / 2
        own = lines[curve.name]
        other = np.concatenate([np.zeros((0, 2))] + [
            line for name, line in lines.items() if name != curve.name])
        best = 1e9, (own[-1], own[-1]), (0., 0., 0., 0.)
        for k in range(len(own) - 1, -1, -5):
            x, y = own[k]
            for far in (1, 3, 5):
                for dx, dy in ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0),
                               (-1, -1), (0, -1), (1, -1)):
                    u = x + dx * (half[0] + far * 7)
                    v = y + dy * (half[1] + far * 6)
                    box = (u - half[0], v - half[1], u + half[0], v + half[1])
                    if (box[0] < panel.left + 3 or box[2] > panel.right + 6 or
                            box[1] < panel.bottom + 3 or box[3] > panel.top):
                        continue
                    cost = (5 * far + (len(own) - 1 - k) *
                            (0.5 if panel.at_end else 0.05) +
                            4 * sum(overlap(box, b) for b in taken))
                    if cost < best[0]:
                        cost += (10 * within(own, box) + 30 * within(other, box)
                                 + 3 * within(other, box, 9))
                    if cost < best[0]:
                        best = cost, ((u, v), (x, y)), box
        placed[curve.name] = best[1]
        taken.append(best[2])
    return placed


def power(value: float) -> str:
    """A label of a logarithmic axis: 1e-3."""
    return f"1e{round(math.log10(value))}"


def digits(value: float) -> str:
    """A number below 1 in two digits: 1.34e-5 as 1.3e-5, 2e-3 as 2e-3."""
    return f"{value:.1e}".replace(".0e", "e").replace("e-0", "e-")


class Picture:
    """A picture that is written piece by piece; @a about is of one or more
    lines. Texts have 11 pixels or more at the width of 800 at which pages show
    a picture."""

    def __init__(self, out: pathlib.Path, width: int, height: int, title: str,
                 about: str = "", footer: str = ""):
        import matplotlib
        from matplotlib.figure import Figure
        matplotlib.rcParams.update({
            "svg.fonttype": "none", "svg.hashsalt": "mass_spring",
            "font.family": "DejaVu Sans", "font.size": 11,
            "axes.edgecolor": "#555555", "axes.linewidth": 1,
            "axes.spines.top": False, "axes.spines.right": False,
            "xtick.color": DARK, "ytick.color": DARK, "grid.color": "#eeeeee",
            "mathtext.default": "regular", "text.parse_math": False})
        self.out, self.width, self.height = out, width, height
        self.figure = Figure(figsize=(width / 72, height / 72))
        # Over all panels: texts, lines and boxes, in pixels.
        self.page = self.figure.add_axes((0, 0, 1, 1), zorder=3)
        self.page.set(xlim=(0, width), ylim=(0, height))
        self.page.axis("off")
        self.text(20, height - 22, title, 15, DARK, bold=True)
        for k, line in enumerate(about.splitlines()):
            self.text(20, height - 42 - 15 * k, line)
        self.text(width - 15, 14, footer, at="right")

    def text(self, x: float, y: float, text: str, size: float = 11,
             color: str = GRAY, at: str = "left", bold: bool = False,
             boxed: bool = False, turned: float = 0) -> None:
        if text:
            self.page.text(
                x, y, text, size=size, color=color, ha=at,
                va="center_baseline", rotation=turned, rotation_mode="anchor",
                weight="bold" if bold else "normal", clip_on=False,
                bbox={"fc": "white", "ec": "none", "pad": 0.8, "alpha": 0.8}
                if boxed else None)

    def box(self, x0: float, y0: float, x1: float, y1: float,
            color: str) -> None:
        """A filled rectangle."""
        self.page.fill((x0, x1, x1, x0), (y0, y0, y1, y1), fc=color, lw=0)

    def line(self, x0: float, y0: float, x1: float, y1: float,
             color: str = GRAY, width: float = 1, dash: Any = "-") -> None:
        self.page.plot((x0, x1), (y0, y1), color=color, lw=width, ls=dash,
                       solid_capstyle="butt")

    def axes(self, panel: Panel, xlabel: str = "", ylabel: str = "",
             xticks: Any = None, yticks: Any = None, xnames: bool = True,
             ynames: bool = True) -> Any:
        """Axes of matplotlib for a panel. Ticks: a list of values, or none for
        decades and for what matplotlib chooses."""
        from matplotlib.ticker import NullLocator
        w, h = self.width, self.height
        ax = self.figure.add_axes((
            panel.left / w, panel.bottom / h, (panel.right - panel.left) / w,
            (panel.top - panel.bottom) / h))
        ax.set_axisbelow(True)
        for name, axis, ticks, named in (
                ("x", panel.x, xticks, xnames), ("y", panel.y, yticks, ynames)):
            side = getattr(ax, name + "axis")
            if axis.log:
                getattr(ax, f"set_{name}scale")("log")
                side.set_minor_locator(NullLocator())
                if ticks is None:
                    low, high = sorted((axis.lo, axis.hi))
                    some = range(math.ceil(math.log10(low) - 1e-9),
                                 math.floor(math.log10(high) + 1e-9) + 1)
                    every = max(1, math.ceil(len(some) / 7))
                    side.set_ticks([10.0 ** k for k in some if k % every == 0])
                    side.set_major_formatter(lambda v, _: power(v))
            if ticks is not None:
                side.set_ticks(ticks)
                side.set_major_formatter(lambda v, _: f"{v:g}")
            getattr(ax, f"set_{name}lim")(axis.lo, axis.hi)
            if not named:
                side.set_ticklabels([])
        ax.grid(True, lw=1)
        ax.tick_params(length=3, width=0.8, color="#555555")
        ax.set_xlabel(xlabel, labelpad=4, color=DARK)
        ax.set_ylabel(ylabel, labelpad=4, color=DARK)
        self.text((panel.left + panel.right) / 2, panel.top + 12, panel.title,
                  12, DARK, "center")
        return ax

    def draw(self, panel: Panel, **axes: Any) -> Any:
        """Draw a panel with its curves and their names; @a axes as there."""
        ax = self.axes(panel, **axes)
        for curve in panel.behind:
            ax.plot(*zip(*curve.points or [(math.nan, math.nan)]),
                    color=BEHIND, lw=1.2)
        labels = place_labels(panel)
        for c in panel.curves:
            ax.plot(*zip(*c.points or [(math.nan, math.nan)]), color=c.color,
                    lw=c.width, ls=c.dash, marker="o" if c.marker else None,
                    ms=c.width * 1.7)
            if c.rings:
                ax.plot(*zip(*c.rings), "o", ms=9, mfc="none", mec=c.color)
            if c.name in labels:
                (u, v), (x, y) = labels[c.name]
                half = LETTER * len(c.label) / 2, LINE / 2 - 2
                self.line(x, y, min(max(x, u - half[0]), u + half[0]),
                          min(max(y, v - half[1]), v + half[1]), c.color, 0.8)
                self.text(u, v, c.label, 11, GRAY if c.color == BEHIND
                          else c.color, "center", boxed=True)
        return ax

    def finish(self) -> None:
        """Write the picture: the same bytes for the same data."""
        svg = io.StringIO()
        self.figure.savefig(svg, format="svg", metadata={
            key: None for key in ("Date", "Creator", "Format", "Type")})
        text = re.sub(r"<!--.*?-->\n? *|<metadata>.*?</metadata>\n? *", "",
                      svg.getvalue(), flags=re.S)
        text = re.sub(r'(<svg [^>]*?)width="[\d.]+pt" height="[\d.]+pt"|'
                      r'height="[\d.]+pt" width="[\d.]+pt"', r"\1", text, 1)
        # Cells of a map stay cells when they are magnified.
        text = text.replace("<image ",
                            "<image style=\"image-rendering:pixelated\" ")
        self.out.write_text(text.replace(
            '<g id="figure_1">', DARK_MODE + '<g id="figure_1">', 1))
