"""What each layer costs, as bars, and other libraries beside ours."""
from __future__ import annotations

import json
import re
import pathlib
from typing import Any

from panels import DARK, Picture
from results import ROOT, match, ns_a_node

BLUE, BLACK, ORANGE = "#0072B2", "#777777", "#D55E00"
# Of bench.json: (what it says there, what the chart says, color).
STEPS = (("step: symp_euler_step(), forces", "the assignment's step", BLACK),
         ("step: flat arrays", "scalar loop over arrays", BLACK),
         ("step: SymplecticEuler", "the laboratory's step", BLUE),
         ("step: SymplecticEuler, threads", "by two threads", BLUE))
LAYERS = (("springs: virtual call a node", "a virtual call a node", BLACK),
          ("springs: Node and Edge", "loop over Node and Edge", BLACK),
          ("springs: flat arrays", "loop over arrays", BLACK),
          ("springs: sweep", "vectorized sweep", BLUE))
ROW = 21  # [pixels]


def beside_ours() -> list[Any]:
    """(task, [(library, lowest, ratio, highest)]) of the tables in
    lab/bench/peers/README.md: times ours."""
    head, found = [], []
    for line in (ROOT / "lab/bench/peers/README.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|  | ours"):
            head = cells
        elif line.startswith("| ") and " us |" in line and head:
            rows = []
            for library, cell in zip(head[2:], cells[2:]):
                numbers = [float(x) for x in re.findall(r"[\d.]+", cell)]
                if numbers:
                    rows.append((library, numbers[1], numbers[0], numbers[2]))
            found.append((cells[0], rows))
    return found


class Bars:
    """Bars one below the other, from a value of 0 at x [pixels]; titles
    begin @a indent left of it."""

    def __init__(self, picture, x, y, scale, indent):
        self.picture, self.x, self.y = picture, x, y
        self.scale, self.indent = scale, indent

    def title(self, text: str) -> None:
        self.y -= 36
        self.picture.text(self.x - self.indent, self.y, text, color=DARK,
                          bold=True)

    def bar(self, name: str, low: float, middle: float, high: float, color: str,
            text: str) -> None:
        self.y -= ROW
        p, y, end = self.picture, self.y, self.x + self.scale * middle
        p.text(self.x - 6, y, name, 11, DARK, "right")
        p.box(self.x, y - 7, end, y + 7, color)
        p.line(self.x + self.scale * low, y, self.x + self.scale * high, y,
               "#222222")
        p.text(max(end, self.x + self.scale * high) + 5, y, text)


def speed(path: pathlib.Path, out: pathlib.Path) -> None:
    """Bars from bench.json, and the peers."""
    of = {name: times for (nodes, name), times in ns_a_node(path).items()
          if nodes == 10000}
    about = json.loads(path.read_text())["about"]
    machine, compiler, commit = (
        match(f"# {what}: ([^#]*);", about)[1].replace(";", ",")
        for what in ("machine", "compiler", "commit"))
    ratio = (of["step: symp_euler_step(), forces"][1] /
             of["step: SymplecticEuler"][1])
    proxies = of["springs: Node and Edge"][1] / of["springs: flat arrays"][1]
    text = (ROOT / "lab/bench/peers/README.md").read_text()
    where, when = match(r"^([^\n]*\(family \d+, model \d+\)), .*?"
                            r"(commit \w+)", text, re.M | re.S).groups()
    picture = Picture(
        out, 800, 486, f"The laboratory's step is {ratio:.1f} times as fast "
        "as the assignment's",
        "Left: a sheet of 10,000 nodes with diagonals. Right: graph classes of "
        "Boost and LEMON on a sheet; ours takes 1.\n"
        "Bar: median; thin line: lowest to highest.",
        f"Right: {where}; {when}")
    picture.text(785, 29, f"Left: {machine}; {compiler}; commit {commit}",
                 at="right")
    left = Bars(picture, 185, 440, 4.8, 165)
    left.title("One step [ns a node]")
    for key, name, color in STEPS:
        low, middle, high = of[key]
        left.bar(name, low, middle, high, color, f"{middle:.1f} ns")
    left.title("Its springs alone [ns a node]")
    for key, name, color in LAYERS:
        more = (f", arrays + {100 * proxies - 100:.0f} %"
                if key == "springs: Node and Edge" else "")
        low, middle, high = of[key]
        left.bar(name, low, middle, high, color, f"{middle:.1f} ns{more}")
    right = Bars(picture, 590, 440, 24, 130)
    tasks = dict(beside_ours())
    for task, title in (("force on each node", "Springs of each node"),
                        ("build, each edge once", "Build it"),
                        ("has_edge", "Look for edges")):
        right.title(title + " [time of ours]")
        for library, low, middle, high in tasks[task]:
            right.bar(library, low, middle, high, ORANGE, f"{middle:.2f}")
        ours = right.x + right.scale
        picture.line(ours, right.y - 10, ours, right.y + ROW * len(
            tasks[task]) - 10, BLUE, 1.5)
        picture.text(ours + 5, right.y - 15, "ours", 11, BLUE)
    picture.finish()
