"""What each layer costs, as bars, and other libraries beside ours; how the
speed of a step went from measurement to measurement."""
import json
import re

from panels import DARK, GRAY, Axis, Curve, Panel, Picture
from results import ROOT, Table, ns_a_node

BLUE, BLACK, ORANGE, GREEN = "#0072B2", "#777777", "#D55E00", "#009E73"
# Of bench.json: (what it says there, what the chart says, color).
STEPS = (("step: symp_euler_step(), forces", "the assignment's step", BLACK),
         ("step: flat arrays", "scalar loop over arrays", BLACK),
         ("step: SymplecticEuler", "the laboratory's step", BLUE),
         ("step: SymplecticEuler, threads", "by two threads", BLUE),
         ("float", "in single precision", BLUE))
LAYERS = (("springs: virtual call a node", "a virtual call a node", BLACK),
          ("springs: Node and Edge", "loop over Node and Edge", BLACK),
          ("springs: flat arrays", "loop over arrays", BLACK),
          ("springs: sweep", "vectorized sweep", BLUE))
PARTS = (("part: ball", "ball"), ("part: drift", "drift"),
         ("part: floor", "floor"))
ROW = 21  # [pixels]


def beside_ours():
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
    """Bars one below the other, from a value of 0 at x [pixels]."""

    def __init__(self, picture, x, y, scale):
        self.picture, self.x, self.y = picture, x, y
        self.scale = scale

    def title(self, text):
        self.y -= 36
        self.picture.text(self.x - 165, self.y, f"{{/:Bold {text}}}", 11,
                          DARK)

    def bar(self, name, low, middle, high, color, text):
        self.y -= ROW
        p, y, end = self.picture, self.y, self.x + self.scale * middle
        p.text(self.x - 6, y, name, 11, DARK, "right", "noenhanced")
        p.box(self.x, y - 7, end, y + 7, color)
        p.line(self.x + self.scale * low, y, self.x + self.scale * high, y,
               "#222222")
        p.text(max(end, self.x + self.scale * high) + 5, y, text, 10, GRAY)


def speed(path, out):
    """Bars from bench.json, bench-float.json beside it, and the peers."""
    single = ns_a_node(path.with_name("bench-float.json"))
    of = {name: times for (nodes, name), times in ns_a_node(path).items()
          if nodes == 10000}
    of["float"] = single[10000, "step: SymplecticEuler"]
    about = json.loads(path.read_text())["about"]
    machine, compiler, commit = (
        re.search(f"# {what}: ([^#]*);", about)[1].replace(";", ",")
        for what in ("machine", "compiler", "commit"))
    ratio = (of["step: symp_euler_step(), forces"][1] /
             of["step: SymplecticEuler"][1])
    proxies = of["springs: Node and Edge"][1] / of["springs: flat arrays"][1]
    text = (ROOT / "lab/bench/peers/README.md").read_text()
    where, when = re.search(r"^([^\n]*\(family \d+, model \d+\)), .*?"
                            r"(commit \w+)", text, re.M | re.S).groups()
    picture = Picture(
        out, 1000, 500, f"The laboratory's step is {ratio:.1f} times as fast "
        f"as the assignment's; the graph adds "
        f"{100 * proxies - 100:.0f} % to a loop",
        "10,000 nodes with diagonals. Bar: median; thin line: lowest to "
        "highest. Right: graph classes of Boost and LEMON.",
        f"{machine}; {compiler}; commit {commit}. Right: {where}; {when}")
    left = Bars(picture, 190, 452, 5.6)
    left.title("One step [ns a node]")
    for key, name, color in STEPS:
        left.bar(name, *of[key], color, f"{of[key][1]:.1f} ns")
    left.title("Its springs alone [ns a node]")
    for key, name, color in LAYERS:
        more = (f", arrays + {100 * proxies - 100:.0f} %"
                if key == "springs: Node and Edge" else "")
        left.bar(name, *of[key], color, f"{of[key][1]:.1f} ns{more}")
    left.title("Other parts of the laboratory's step [ns a node]")
    for key, name in PARTS:
        left.bar(name, *of[key], BLUE, f"{of[key][1]:.2f} ns")
    right = Bars(picture, 690, 452, 17)
    tasks = dict(beside_ours())
    for task, title in (("force on each node", "Springs of each node"),
                        ("build, each edge once", "Build the graph"),
                        ("has_edge", "Look for edges")):
        right.title(title + ": time over ours")
        for library, low, middle, high in tasks[task]:
            right.bar(library, low, middle, high, ORANGE, f"{middle:.2f}")
        ours = right.x + right.scale
        picture.line(ours, right.y - 10, ours, right.y + ROW * len(
            tasks[task]) - 10, BLUE, 1.5)
        picture.text(ours, right.y - 16, "ours: 1", 9, BLUE, "center")
    picture.say("unset border", "unset tics", "set xrange [0:1]",
                "set yrange [0:1]", "plot NaN")
    picture.finish()


SERIES = (("double", "10000", "SymplecticEuler", BLUE, 7),
          ("double", "1000000", "SymplecticEuler", BLUE, 6),
          ("double", "10000", "SymplecticEuler mixed", ORANGE, 9),
          ("double", "1000000", "SymplecticEuler mixed", ORANGE, 8),
          ("float", "10000", "SymplecticEuler", GREEN, 5),
          ("float", "1000000", "SymplecticEuler", GREEN, 4))


def history(csv, out):
    """A step over the scalar loop, from commit to commit."""
    table = Table(csv)
    commits = list(dict.fromkeys(row["commit"] for row in table.rows))
    curves = []
    for real, nodes, step, color, marker in SERIES:
        points = [(commits.index(row["commit"]) + 1, float(row["ratio"]))
                  for row in table.where(real=real, nodes=nodes, step=step)]
        curves.append(Curve(
            real + nodes + step, points, color, marker,
            f"{real}, {int(nodes):,} nodes" +
            step[len("SymplecticEuler"):].replace(" ", ", ")))
    changes = sorted((c.points[-1][1] - c.points[0][1], c.label, c.points)
                     for c in curves)
    words = [f"{'up' if by > 0 else 'down'} from {points[0][1]:.2f} to "
             f"{points[-1][1]:.2f}: {label}"
             for by, label, points in (changes[0], changes[-1])]
    picture = Picture(
        out, 1000, 420, "; ".join(words).capitalize(),
        "A step of symplectic Euler, vectorized: its time over that of a "
        "scalar loop. Mixed: neighbors anywhere in memory.",
        f"{csv.parent.name}; commits at the axis")
    n = len(commits)
    panel = Panel(72, 70, 985, 350, Axis(0.8, n + 0.32 * n, False),
                  Axis(0, 1.1, False), "", curves)
    date = {row["commit"]: row["date"] for row in table.rows}
    tics = ", ".join(f"'{c}, {date[c]}' {k + 1}"
                     for k, c in enumerate(commits))
    picture.draw(panel, f"set xtics ({tics})", "set xlabel 'commit'",
                 "set ylabel 'time over that of the scalar loop'")
    picture.finish()
