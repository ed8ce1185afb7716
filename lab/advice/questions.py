"""Random scenes, each with a question: what suite.py asks --advise.

draw(seed) is the same on every machine. The seeds take the kinds in turn;
seed -k is line k of by_hand.txt. Units as in ./cloth --help."""
import math
import pathlib
import random
import re
import shlex
from collections.abc import Sequence
from typing import TypeVar

KINDS = ("three-pins", "banner", "late-ball", "pulled", "two-materials",
         "damped", "undamped", "incline", "two-sheets", "thrown", "tearing",
         "landing")

T = TypeVar("T")
Vector = tuple[float, float, float]
Cells = Sequence[Sequence[int]]     # of each sheet, along u and v


class Dice(random.Random):
    """Numbers of two digits, so that a command is short to read."""

    def between(self, low: float, high: float) -> float:
        return float(f"{low + (high - low) * self.random():.2g}")

    def log(self, low: float, high: float) -> float:
        return float(f"{low * (high / low) ** self.random():.2g}")

    def one(self, *of: T) -> T:
        return of[int(len(of) * self.random())]


class Scene:
    """A scene; cells: of each sheet along u and v, as the question has them."""

    def __init__(self, kind: str):
        self.kind = kind
        self.sheets: list[str] = []
        self.sides: list[tuple[float, float]] = []
        self.cells: list[tuple[int, int]] = []
        self.args: list[str] = []
        self.t_end: float = 0
        self.measure = "com"
        self.share: float = 0  # tolerance in shares of the answer's scale
        self.tolerance = ""    # or as it is

    def sheet(self, dice: Dice, u: Vector, v: Vector, at: Vector = (0, 0, 0),
              velocity: Vector | None = None) -> None:
        """Add a sheet of sides u and v; its grid is coarse or fine, and its
        cells are squares or not."""
        words = [word for name, value in (
            ("at", at if any(at) else None), ("u", u), ("v", v),
            ("velocity", velocity)) if value
            for word in (name, *(f"{x:g}" for x in value))]
        sides = math.hypot(*u), math.hypot(*v)
        along = dice.log(6, 90)
        stretched = dice.one(1, 1, 1, 2, 0.5, dice.log(0.4, 2.5))
        size = max(sides) / along
        self.sheets.append(" ".join(words))
        self.sides.append(sides)
        self.cells.append((max(3, round(sides[0] / size)),
                           max(3, round(sides[1] / size * stretched))))

    def add(self, option: str, *words: str | float) -> None:
        self.args += ["--" + option,
                      " ".join(w if isinstance(w, str) else f"{w:.4g}"
                               for w in words)]

    def grid(self, cells: Cells | None = None) -> list[str]:
        """Arguments that name the cloth, on other grids if given."""
        return [arg for words, (n, m) in zip(self.sheets, cells or self.cells)
                for arg in ("--sheet", f"{words} nodes {n + 1} {m + 1}")]


def by_hand(line: str) -> Scene:
    """Sheets, each of sides u and v, then other options."""
    s, words = Scene("by-hand"), iter(shlex.split(line))
    for option, value in zip(words, words):
        if option == "--sheet":
            sheet, _, nodes = value.partition(" nodes ")
            u, v = (math.hypot(*map(float, side.split()))
                    for side in re.findall(r"\b[uv] (\S+ \S+ \S+)", sheet))
            n, m = map(int, nodes.split())
            s.sheets.append(sheet)
            s.sides.append((u, v))
            s.cells.append((n - 1, m - 1))
        elif option == "--measure":
            s.measure = value
        elif option == "--tolerance":
            s.tolerance = value
        else:
            s.args += [option, value]
    s.t_end = float(s.args[s.args.index("--t-end") + 1])
    return s


BY_HAND = (pathlib.Path(__file__).parent / "by_hand.txt").read_text()


def draw(seed: int) -> Scene:
    if seed < 0:
        return by_hand(BY_HAND.splitlines()[-seed - 1])
    d = Dice(f"question {seed}")
    s = Scene(KINDS[seed % len(KINDS)])
    w, h = d.between(0.5, 1.6), d.between(0.4, 1.4)
    density, modulus = d.log(0.1, 0.8), d.log(40, 1500)
    drag = d.one(0, 0, density * d.log(0.3, 8))
    s.t_end = d.between(0.15, 0.8)
    flat = ((w, 0, 0), (0, h, 0))
    hanging = ((w, 0, 0), (0, 0, -h))
    measures = ["com", "com", "point u 1 v 1", "max-stretch",
                "drape-height"]
    lossy = False  # energy is lost or gained without drag, too

    if s.kind == "three-pins":
        s.sheet(d, *flat)
        for x, y in ((0, 0), (w, 0), (0, h)):
            s.add("pin", "x", x, "y", y)
    elif s.kind == "banner":
        slope = d.between(0.3, 1.4)
        # Rounded once, as the sheet has it.
        v = (0, float(f"{h * math.cos(slope):g}"),
             float(f"{-h * math.sin(slope):g}"))
        s.sheet(d, (w, 0, 0), v, velocity=d.one(None, (0, d.between(1, 3), 0)))
        s.add("pin", *d.one(("x", 0), ("y", 0)))
    elif s.kind == "late-ball":
        s.sheet(d, *flat)
        s.add("pin", "x", 0)
        s.add("pin", "x", w)
        radius, speed = d.between(0.1, 0.3), d.between(0.8, 2)
        gap = speed * s.t_end * d.between(0.5, 0.9)
        s.add("sphere", "at", w * d.between(0.4, 0.6), h * d.between(0.4, 0.6),
              -gap - radius - 0.05, "radius", radius, "velocity 0 0", speed)
        lossy = True
    elif s.kind == "pulled":
        h = d.one(h, float(f"{w * d.between(0.1, 0.35):.2g}"))
        s.sheet(d, (w, 0, 0), (0, h, 0))
        s.add("pin", "x", 0)
        until = s.t_end * d.between(0.3, 1)
        speed = w * d.between(0.05, 0.4) / until
        s.add("pin", "x", w, "velocity", speed, 0, d.one(0, speed), "until",
              until)
        lossy = True
    elif s.kind == "two-materials":
        s.sheet(d, *d.one(flat, hanging), velocity=(0, d.between(0, 1), 0.1))
        s.add("pin", "x", 0)
        s.add("region", "from -1 -1 -3 to",
              w * d.one(0.5, 0.25), 3, 3,
              *d.one(("stiffness-factor", d.log(2, 30)),
                     ("mass-factor", d.log(2, 6))))
    elif s.kind == "damped":
        s.sheet(d, *d.one(flat, hanging))
        s.add("pin", "x", 0)
        if d.random() < 0.7:
            s.add("pin", "x", w)
        drag = density * d.between(5, 25)
        modulus = d.log(40, 400)
        s.t_end = d.between(1, 3)
    elif s.kind == "undamped":
        s.sheet(d, *hanging, velocity=(0, d.between(0.3, 3), 0))
        s.add("pin", "z", 0)
        drag = 0
    elif s.kind == "incline":
        s.sheet(d, *flat)
        slope = d.between(0.1, 0.6)
        s.add("plane", "at 0 0", -slope * w - d.between(0.01, 0.1), "normal",
              -slope, 0, 1, "friction", d.between(0.05, 0.6))
        lossy = True
    elif s.kind == "two-sheets":
        s.sheet(d, *flat)
        s.sheet(d, (d.between(0.3, 1), 0, 0), (0, d.between(0.3, 1), 0),
                at=(d.one(0, 0.2), 0.1, d.between(0.2, 0.5)))
        s.add("pin", "x", 0)
        s.add("plane", "at 0 0", -d.between(0.1, 0.6))
        lossy = True
    elif s.kind == "thrown":
        s.sheet(d, *d.one(flat, hanging), velocity=(
            d.between(0.5, 3), d.between(-1, 1), d.between(0, 3)))
        if d.random() < 0.6:
            s.add("plane", "at", w + 0.1, "0 0 normal -1 0", d.between(0, 1),
                  "friction", d.between(0, 0.5))
            lossy = True
    elif s.kind == "tearing":
        s.sheet(d, *flat)
        s.add("pin", "x", 0)
        if d.random() < 0.5:
            s.add("pin", "x", w, "velocity", d.between(0.5, 2), 0, 0)
            s.add("tear-strain", d.between(0.1, 0.5))
        else:
            s.add("tear", "at", w / 2, h / 2, -d.between(0.15, 0.4), "radius",
                  d.between(0.1, 0.2))
        measures, lossy = ["com", "com", "drape-height"], True
    elif s.kind == "landing":
        s.sheet(d, *flat)
        if d.random() < 0.5:
            s.add("sphere", "at", w / 2, h / 2, -0.35, "radius", 0.3,
                  "friction", d.between(0, 0.5))
        s.add("plane", "at 0 0", -d.between(0.05, 0.5), "friction",
              d.between(0, 0.5))
        lossy = True

    s.args += ["--density", f"{density:g}", "--modulus", f"{modulus:g}"]
    if drag:
        s.args += ["--drag", f"{drag:.3g}"]
    if drag or lossy:
        measures.append("energy")
    s.args += ["--t-end", f"{s.t_end:g}"]
    s.measure = d.one(*measures)
    s.share = d.log(0.003, 0.1)
    return s
