"""Panels of curves for gnuplot: each curve has its name beside it, in its
color, where it covers least; what belongs to other panels is light gray."""
import math
import subprocess
from dataclasses import dataclass, field

from results import ROOT, ChartError

GRAY, BEHIND, DARK = "#666666", "#c4c4c4", "#222222"
LETTER, LINE = 6.6, 14  # width and height of a letter of size 11 [pixels]
CELL = 4                # of the grid that knows where curves are [pixels]


def styles():
    """{method: (color, family)} of methods.csv."""
    lines = (ROOT / "lab/charts/methods.csv").read_text().splitlines()
    cells = [line.split(",") for line in lines if not line.startswith("#")]
    return {c[0]: (c[1], c[2]) for c in cells}


@dataclass(frozen=True)
class Axis:
    """From lo to hi, which may be smaller; at() maps to 0 ... 1."""
    lo: float
    hi: float
    log: bool = True

    def at(self, value):
        if self.log:
            return math.log(value / self.lo) / math.log(self.hi / self.lo)
        return (value - self.lo) / (self.hi - self.lo)


@dataclass
class Curve:
    name: str
    points: list  # (x, y)
    color: str
    marker: int = 0
    label: str = ""
    rings: list = field(default_factory=list)  # points with a ring
    width: float = 1.8


@dataclass
class Panel:
    """A panel at these pixels of the picture, from its lower left corner."""
    left: int
    bottom: int
    right: int
    top: int
    x: Axis
    y: Axis
    title: str = ""
    curves: list = field(default_factory=list)
    behind: list = field(default_factory=list)
    keep_free: list = field(default_factory=list)  # boxes, in pixels
    at_end: bool = False  # names stand where curves end, if they can

    def pixel(self, point):
        return (self.left + self.x.at(point[0]) * (self.right - self.left),
                self.bottom + self.y.at(point[1]) * (self.top - self.bottom))


class Crowd:
    """How much of curves is in a box: sums over a grid of cells."""

    def __init__(self, panel, curves):
        self.left, self.bottom = panel.left, panel.bottom
        self.columns = (panel.right - panel.left) // CELL + 2
        self.rows = (panel.top - panel.bottom) // CELL + 2
        there = set()
        for curve in curves:
            for x, y in dense([panel.pixel(p) for p in curve.points]):
                there.add((int(x - self.left) // CELL,
                           int(y - self.bottom) // CELL))
        self.sums = [[0] * (self.columns + 1)]
        for row in range(self.rows):
            sums, last = [0], self.sums[-1]
            for column in range(self.columns):
                sums.append(sums[-1] + last[column + 1] - last[column] +
                            ((column, row) in there))
            self.sums.append(sums)

    def within(self, box, margin=0):
        def clamp(value, most):
            return min(max(int(value) // CELL, 0), most)
        c0 = clamp(box[0] - margin - self.left, self.columns)
        c1 = clamp(box[2] + margin - self.left + CELL, self.columns)
        r0 = clamp(box[1] - margin - self.bottom, self.rows)
        r1 = clamp(box[3] + margin - self.bottom + CELL, self.rows)
        return (self.sums[r1][c1] - self.sums[r0][c1] - self.sums[r1][c0] +
                self.sums[r0][c0])


def dense(pixels, apart=CELL / 2):
    """Points along a line of pixels, so far apart."""
    found = pixels[:1]
    for (x0, y0), (x1, y1) in zip(pixels, pixels[1:]):
        n = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / apart))
        found += [(x0 + (x1 - x0) * k / n, y0 + (y1 - y0) * k / n)
                  for k in range(1, n + 1)]
    return found


def toward(middle, point, letters):
    """The place in a label of so many letters that is nearest to a point."""
    half = LETTER * letters / 2, LINE / 2 - 2
    return [min(max(p, m - h), m + h)
            for p, m, h in zip(point, middle, half)]


def overlap(a, b):
    return (max(0, min(a[2], b[2]) - max(a[0], b[0])) *
            max(0, min(a[3], b[3]) - max(a[1], b[1])))


def place_labels(panel):
    """{curve's name: (middle of its label, the point of the curve that it
    belongs to), in pixels}: near its own curve and no other, off all curves
    and labels, inside of the panel."""
    behind = Crowd(panel, panel.behind)
    crowds = {c.name: Crowd(panel, [c]) for c in panel.curves}
    everyone = Crowd(panel, panel.curves)
    taken = panel.keep_free + [
        (x - 9, y - 9, x + 9, y + 9) for c in panel.curves
        for x, y in map(panel.pixel, c.rings)]

    def in_turn(curves):
        """The sum of the costs, and the places, one curve after the other."""
        placed, boxes, total = {}, list(taken), 0
        for curve in curves:
            best = best_place(curve, boxes)
            total += best[0]
            placed[curve.name] = best[1]
            boxes.append(best[2])
        return total, placed

    def best_place(curve, boxes):
        half = LETTER * len(curve.label) / 2 + 2, LINE / 2
        ways = [(dx * (half[0] + far * 7), dy * (half[1] + far * 6), 4 * far)
                for dx in (1, 0, -1) for dy in (1, 0, -1) if dx or dy
                for far in (1, 3, 5)]
        line = dense([panel.pixel(p) for p in curve.points], 12)
        best = 1e6, (line[-1], line[-1]), (0, 0, 0, 0)
        for k, (x, y) in enumerate(line):
            for dx, dy, away in ways:
                box = (x + dx - half[0], y + dy - half[1],
                       x + dx + half[0], y + dy + half[1])
                if (box[0] < panel.left + 3 or box[2] > panel.right + 6 or
                        box[1] < panel.bottom + 3 or box[3] > panel.top):
                    continue
                cost = (20 * everyone.within(box) + away +
                        (3 * (len(line) - 1 - k) if panel.at_end else
                         0.3 * min(k + 20, len(line) - 1 - k)))
                if cost >= best[0]:
                    continue
                own = crowds[curve.name]
                cost += (5 * (everyone.within(box, 15) - own.within(box, 15)) +
                         0.15 * behind.within(box) +
                         sum(overlap(box, other) for other in boxes))
                best = min(best, (cost, ((x + dx, y + dy), (x, y)), box))
        return best

    # Who comes first has the best place: so some orders are tried.
    named = [c for c in panel.curves if c.points and c.label]
    orders = [sorted(named, key=key, reverse=down) for down in (0, 1)
              for key in (lambda c: len(c.points),
                          lambda c: panel.pixel(c.points[-1])[0])]
    return min((in_turn(o) for o in orders), key=lambda t: t[0])[1]


class Picture:
    """A script for gnuplot, that is written piece by piece; @a about is of
    one or more lines. Texts have 11 pixels or more at the width of 800 at which
    pages show a picture."""

    def __init__(self, out, width, height, title, about, footer):
        self.out, self.width, self.height = out, width, height
        self.lines = [f"width = {width}; height = {height}",
                      f"out = {quoted(str(out))}",
                      "load 'lab/charts/terminal.gp'"]
        self.count = 0
        self.say("set multiplot", "unset key")
        self.text(20, height - 22, f"{{/:Bold=15 {title}}}", color=DARK)
        for k, line in enumerate(about.splitlines()):
            self.text(20, height - 42 - 15 * k, line)
        self.text(width - 15, 14, footer, at="right", more="noenhanced")

    def say(self, *lines):
        self.lines += lines

    def screen(self, x, y):
        return f"screen {x / self.width:.5f}, screen {y / self.height:.5f}"

    def text(self, x, y, text, size=11, color=GRAY, at="left", more=""):
        if not text:
            return
        self.count += 1
        self.say(f"set label {self.count} {quoted(text)} at "
                 f"{self.screen(x, y)} {at} front font ',{size}' "
                 f"textcolor rgb '{color}' {more}")

    def box(self, x0, y0, x1, y1, color, more="behind"):
        """A filled rectangle."""
        self.count += 1
        self.say(f"set object {self.count} rectangle from "
                 f"{self.screen(x0, y0)} to {self.screen(x1, y1)} fc rgb "
                 f"'{color}' fs solid noborder {more}")

    def line(self, x0, y0, x1, y1, color=GRAY, width=1, dash=1):
        self.count += 1
        self.say(f"set arrow {self.count} from {self.screen(x0, y0)} to "
                 f"{self.screen(x1, y1)} nohead front lc rgb '{color}' "
                 f"lw {width} dt {dash}")

    def block(self, points):
        """Points as data of gnuplot; returns its name."""
        self.count += 1
        self.say(f"$d{self.count} << E",
                 *(f"{x:.5g},{y:.5g}" for x, y in points), "E")
        return f"$d{self.count}"

    def draw(self, panel, *settings):
        """Draw a panel; what was said before it is drawn with it."""
        w, h = self.width, self.height
        self.say(f"set lmargin at screen {panel.left / w:.5f}",
                 f"set rmargin at screen {panel.right / w:.5f}",
                 f"set bmargin at screen {panel.bottom / h:.5f}",
                 f"set tmargin at screen {panel.top / h:.5f}")
        for name, axis in (("x", panel.x), ("y", panel.y)):
            self.say(f"set {name}range [{axis.lo:.6g}:{axis.hi:.6g}]",
                     f"{'set' if axis.log else 'unset'} logscale {name}")
        self.text((panel.left + panel.right) / 2, panel.top + 12,
                  panel.title, 12, DARK, "center")
        labels = place_labels(panel)
        plots = []
        for curve in panel.behind:
            plots.append(f"{self.block(curve.points)} with lines "
                         f"lc rgb '{BEHIND}' lw 1.2")
        for c in panel.curves:
            style = f"lc rgb '{c.color}' pt {c.marker}"
            plots.append(
                f"{self.block(c.points)} with " +
                (f"linespoints {style} ps {c.width / 3:g} lw {c.width}"
                 if c.marker
                 else f"lines lc rgb '{c.color}' lw {c.width}"))
            if c.rings:
                plots.append(f"{self.block(c.rings)} with points "
                             f"lc rgb '{c.color}' pt 6 ps 1.8 lw 1.4")
            if c.name in labels:
                middle, point = labels[c.name]
                self.line(*point, *toward(middle, point, len(c.label)),
                          c.color, 0.8)
                self.text(*middle, c.label, 11,
                          GRAY if c.color == BEHIND else c.color, "center",
                          "boxed noenhanced")
        self.say(*settings, "plot " + ", ".join(plots or ["NaN"]))
        self.say("unset label", "unset object", "unset arrow")

    def finish(self):
        """Let gnuplot write the picture. What it complains of goes to
        standard error, and no picture is left."""
        self.say("unset multiplot", "unset output")
        gnuplot(self.lines, self.out)


def quoted(text):
    return "'" + text.replace("'", "''") + "'"


def gnuplot(lines, out):
    """Run gnuplot; @a out is there, whole, or CalledProcessError."""
    done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n",
                          text=True, capture_output=True, cwd=ROOT)
    # gnuplot repeats the command, points at a place, and then says what.
    said = next((line.strip() for line in done.stderr.splitlines()
                 if "line " in line and "no valid points" not in line), "")
    if done.returncode or said:
        out.unlink(missing_ok=True)
        raise ChartError(f"{out}: gnuplot: {said}")
