"""The right answer of a scene, and its cheapest model, by brute force: runs of
./cloth, of which only what it prints and writes is used.

Cost is counted in spring evaluations: force evaluations and matrix products,
times springs; a Cholesky factor counts as FACTOR of these for each node along a
side. No time decides; a run of more than LONGEST seconds counts as failed."""
import math
import os
import pathlib
import re
import subprocess
from collections.abc import Sequence

import questions
from questions import Cells

LONGEST = 300            # limit of a child process [s]
TRUTH_WORK = 4e8         # spring evaluations of the finest run of the truth
SEARCH_WORK = 3e7        # and of the longest run of the search
FACTOR = 10
FINER = (math.sqrt(2), 2)  # cells along a side, of a check
LADDER = (2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 91, 128)  # cells
# Steps in units of Verlet's limit. The first two tell whether a grid will do;
# the implicit ones are tried where Verlet meets the tolerance.
STEPS = [("verlet", s) for s in (0.95, 0.5, 1.5, 1.2, 0.7, 0.25)] + [
    ("symplectic-euler", s) for s in (0.95, 0.5, 0.25)] + [
    ("pefrl", 1.35)] + [
    (m, s) for m in ("tr-bdf2", "implicit-midpoint", "implicit-euler")
    for s in (300, 100, 30)]
EVALUATIONS = {"verlet": 1, "symplectic-euler": 1, "pefrl": 4}
# The answer, its work, Verlet's limit [s] if it is told, kinetic energy [J].
Trial = tuple[list[float], float, float | None, float]
NUMBER = r"(-?\d[\d.]*(?:e[-+]?\d+)?)"


def found(pattern: str, text: str) -> re.Match[str]:
    """What ./cloth always prints."""
    match = re.search(pattern, text, re.M)
    assert match, f"no {pattern} in {text}"
    return match


def numbers(text: str) -> list[float]:
    return [float(x) for x in re.findall(NUMBER, text)]


def line(h: list[float], answers: list[list[float]],
         order: float) -> tuple[list[float], float, float]:
    """The least-squares fit answer = limit + slope h^order: the limit, twice
    its standard error, and the standard deviation of the answers."""
    t = [x ** order for x in h]
    n, mean = len(t), sum(t) / len(t)
    spread = sum((x - mean) ** 2 for x in t)
    limit, squares = [], 0.
    for values in zip(*answers):
        middle = sum(values) / n
        slope = sum((x - mean) * (v - middle)
                    for x, v in zip(t, values)) / spread
        limit.append(middle - slope * mean)
        squares += sum((v - limit[-1] - slope * x) ** 2
                       for x, v in zip(t, values))
    scatter = math.sqrt(squares / (n - 2))
    return limit, 2 * scatter * math.sqrt(1 / n + mean ** 2 / spread), scatter


def extrapolate(h: list[float],
                answers: list[list[float]]) -> tuple[list[float], float]:
    """The limit of answers on four or more grids of widths h, the widest
    first, and how far it may be off: by its standard error, and by the limits
    that other orders give which fit nearly as well, of all grids and without
    the coarsest (the form of Eca and Hoekstra, 2014). Order 1/2, of a cloth
    held at a point, only if it fits clearly better than 1 and 2."""
    fits: list[tuple[float, list[float], float, float]] = [
        (order, *line(h, answers, order)) for order in (1, 2)]
    rough = line(h, answers, 0.5)
    if rough[2] < 0.5 * min(f[3] for f in fits):
        fits.append((0.5, *rough))
    _, limit, error, scatter = min(fits, key=lambda f: f[3])
    others = [other for order, whole, _, s in fits if s <= 2 * scatter
              for other in (whole, line(h[1:], answers[1:], order)[0])]
    return limit, error + max(math.dist(limit, o) for o in others)


def finer(cells: Cells, factor: float) -> Cells | None:
    """Some so many times the cells, of the same shape: cells of another one
    are another material. None if there are no such grids near."""
    common = math.gcd(*(n for sheet in cells for n in sheet))
    times = round(factor * common)
    return None if times == common else tuple(
        tuple(n // common * times for n in sheet) for sheet in cells)


def springs(cells: Cells) -> int:
    return sum(4 * n * m for n, m in cells)


class Scene(questions.Scene):
    """A scene in a folder of its own, where ./cloth is, and what its runs
    gave: a Trial, or None if it failed."""

    def __init__(self, seed: int, folder: str, cloth: pathlib.Path):
        self.__dict__ = questions.draw(seed).__dict__
        self.folder = pathlib.Path(folder)
        self.memo: dict[tuple, Trial | None] = {}
        (self.folder / "cloth").symlink_to(cloth.resolve())

    def child(self, command: str | list[str]) -> tuple[int, str, str]:
        """(exit status, output, errors) of words, or of a line for a shell."""
        env = {k: v for k, v in os.environ.items()
               if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        try:
            done = subprocess.run(
                command, shell=isinstance(command, str), cwd=self.folder,
                env=env, capture_output=True, text=True, timeout=LONGEST)
        except subprocess.TimeoutExpired:
            return 124, "", f"more than {LONGEST} s"
        return done.returncode, done.stdout, done.stderr

    def run(self, words: list[str], method: str, dt: str) -> Trial | None:
        key = tuple(words), method, dt
        if key not in self.memo:
            self.memo[key] = self.fresh_run(*key)
        return self.memo[key]

    def fresh_run(self, words: Sequence[str], method: str,
                  dt: str) -> Trial | None:
        status, text, _ = self.child(
            ["./cloth", *words, "--measure", self.measure, "--headless",
             "--threads", "1", "--method", method, "--dt", dt])
        if status:
            return None
        text = re.sub(r"\n +", " ", text)  # lines broken for a terminal
        nodes, edges = map(int, found(r"^(\d+) nodes, (\d+) edges$",
                                      text).groups())
        evaluations = sum(
            int(k) * (FACTOR * math.sqrt(nodes) if what == "Cholesky" else 1)
            for k, what in re.findall(
                r"(\d+) (force evaluation|matrix product|Cholesky)",
                found("^work: .*", text)[0]))
        limit = re.search(NUMBER + " s, verlet|of verlet " + r"\(" + NUMBER,
                          text)
        said = rf"^{re.escape(self.measure)}: (.*?)(?: (?:at|until) t|$)"
        answer = numbers(found(said, text)[1])
        return (answer, edges * evaluations,
                float(limit[1] or limit[2]) if limit else None,
                float(found(NUMBER + " kinetic", text)[1]))

    def at(self, cells: Cells, method: str, steps: int) -> Trial | None:
        """The trial on a grid, in so many equal steps."""
        return self.run(self.grid(cells) + self.args, method,
                        repr(self.t_end / steps))

    def start(self, cells: Cells) -> Trial | None:
        """The trial of no time: its answer at the start, and the limit."""
        args = list(self.args)
        args[args.index("--t-end") + 1] = "1e-7"
        measure = self.measure
        if self.tolerance:  # what is asked may not happen at once
            self.measure = "com"
        trial = self.run(self.grid(cells) + args, "verlet", "auto")
        self.measure = measure
        return trial

    def steps(self, cells: Cells, share: float) -> int | None:
        """Steps of at most that share of Verlet's limit; None if no scene."""
        start = self.start(cells)
        if not start:
            return None
        limit = start[2]
        assert limit, "Verlet has a limit"
        return max(1, math.ceil(self.t_end / (share * limit) - 1e-9))

    def error(self, trial: Trial | None, right: Sequence[float]) -> float:
        # An event need not happen on each grid: then there is no time.
        if not trial or len(trial[0]) != len(right):
            return math.inf
        return math.dist(trial[0], right)

    def scaled(self, along: float) -> Cells:
        """The scene's own grids with so many cells along the longest side."""
        longest = max(n for sheet in self.cells for n in sheet)
        return tuple(tuple(max(2, round(n * along / longest))
                           for n in sheet) for sheet in self.cells)

    def truth(self) -> tuple[list[float], float] | None:
        """(the right answer, how far it may be off), None if unknown: the limit
        of grids by pefrl at half of Verlet's limit."""
        coarse = self.scaled(8)
        steps = self.steps(coarse, 0.5)
        if not steps:
            return None
        # Work increases with the third power of cells along a side.
        most = min(200, 8 * (TRUTH_WORK / (4 * steps * springs(coarse))) **
                   (1 / 3))
        grids = list(dict.fromkeys(self.scaled(most / 2 ** (k / 4))
                                   for k in range(6, -1, -1)))
        runs = [(g, self.steps(g, 0.5) or 1) for g in grids]
        widths = [sum(n * m for n, m in g) ** -0.5 for g in grids]
        trials = [t for g, n in runs if (t := self.at(g, "pefrl", n))]
        if len(trials) < max(4, len(runs)):
            return None
        right, doubt = extrapolate(widths, [t[0] for t in trials])
        grid, n = runs[-3]
        again = self.at(grid, "pefrl", 2 * n)
        return right, doubt + self.error(again, trials[-3][0])

    def robust(self, cells: Cells, method: str, steps: int,
               right: Sequence[float], tolerance: float) -> bool:
        """Does it hold with half the step, and on the next two grids?"""
        others: list[tuple[Cells, int]] = [(cells, 2 * steps)]
        others += [(grids, math.ceil(f * steps)) for f in FINER
                   if (grids := finer(cells, f))]
        return all(self.error(self.at(g, method, n), right) <= tolerance
                   for g, n in others)

    def search(self, right: Sequence[float], tolerance: float,
               most: float) -> tuple[float, float, str] | None:
        """The cheapest of all choices within @a most of the tolerance that is
        robust: (work, error, words); None if there is none."""
        work = SEARCH_WORK
        best: tuple[float, float, str] | None = None
        for predicted, cells in self.choices():
            if predicted / 1.5 >= work:
                break
            errors: list[float] = []
            count = springs(cells)
            for method, share in STEPS:
                steps = self.steps(cells, share)
                if not steps or (len(errors) == 2
                                 and min(errors) > 3 * tolerance):
                    break  # no scene, or too coarse
                if share > 2.5 and min(errors, default=0) > tolerance:
                    break
                # An implicit step takes more than 40 evaluations.
                if count * steps * EVALUATIONS.get(method, 40) >= work and (
                        best or share > 2.5):
                    continue
                trial = self.at(cells, method, steps)
                errors.append(self.error(trial, right))
                if trial and errors[-1] <= most * tolerance and (
                        trial[1] < work and self.robust(
                            cells, method, steps, right, tolerance)):
                    work = trial[1]
                    best = work, errors[-1], f"{method} {share:g} " + " ".join(
                        f"{n}x{m}" for n, m in cells)
        return best

    def choices(self) -> list[tuple[float, tuple[tuple[int, int], ...]]]:
        """(predicted work by Verlet, cells), the cheapest first: both sides
        of a sheet are refined on their own, a second sheet as the first."""
        (u, v), *_ = self.sides
        coarse = self.scaled(8)
        steps = self.steps(coarse, 1)
        if not steps:
            return []
        pace = steps / math.hypot(coarse[0][0] / u, coarse[0][1] / v)
        found = []
        for n in LADDER:
            for m in LADDER:
                if 1 / 9 < (u / n) / (v / m) < 9:
                    cells = tuple((max(1, round(n * a / u)),
                                   max(1, round(m * b / v)))
                                  for a, b in self.sides)
                    found.append((springs(cells) * pace *
                                  math.hypot(n / u, m / v), cells))
        return sorted(found)
