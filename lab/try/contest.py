"""Rank the steps of a class by their error:

    make contest DIR=submissions [OUT=contest] [SEED=1]       lab/try/README.md

DIR holds a file NAME.hpp, or a folder NAME with mine.hpp, of each student. OUT
gets contest.html, contest.json, and gradescope/NAME.json with a leaderboard.
Exit status: 0 there is a table, whatever it says; 2 there is none."""

import concurrent.futures
import html
import json
import math
import os
import pathlib
import random
import re
import shutil
import sys
import tempfile
from dataclasses import dataclass, field

import report
import workshop
from judge import size
from orders import rms
from workshop import ROOT, BadInput, Workshop, choose, progress

sys.path.append(str(ROOT / "course/kit"))

import submission           # noqa: E402  (from course/kit)
from grade import write     # noqa: E402

BUDGETS = (100, 400, 1600)      # force evaluations of a run
LOST = 1.0                      # [m]: a larger error says nothing
COPIED = 10                     # so many times better where it is published
REFERENCE = "srkn11b_step"
workshop.SECONDS["run"] = 20


# ---- Scenes

@dataclass
class Scene:
    """Lines for contest.cpp; the same with its start moved a little."""
    name: str
    end: float                  # [s]
    nodes: list                 # x y z vx vy vz m
    springs: list               # i j K L
    wind: list = field(default_factory=list)    # a, omega
    pins: list = field(default_factory=list)    # i x y z a omega

    def text(self, *commands):
        lines = [("scene",)]
        for what in ("node", "spring", "wind", "pin"):
            lines += [(what, *row) for row in {
                "node": self.nodes, "spring": self.springs,
                "wind": self.wind, "pin": self.pins}[what]]
        return "".join(f"{what} {len(row)} {' '.join(map(repr, row))}\n"
                       for what, *row in (*lines, *commands))

    def moved(self, dice):
        """Each node that is not pinned by up to 5 mm."""
        pinned = {pin[0] for pin in self.pins}
        return Scene(self.name, self.end, [
            [x + (dice.uniform(-.005, .005) if k < 3 and i not in pinned
                  else 0) for k, x in enumerate(row)]
            for i, row in enumerate(self.nodes)],
            self.springs, self.wind, self.pins)


def pin(i, row, a=0.0, omega=1.0):
    """A pin that moves by a sin(omega t) along x; its node starts with it."""
    row[3:6] = a * omega, 0.0, 0.0
    return [i, *row[:3], a, omega]


def rope(name, dice, n, swing, wind):
    """Masses that hang from a pin in an uneven row."""
    nodes, springs = [], []
    for i in range(n):
        nodes.append([.1 * i + dice.uniform(-.02, .02),
                      dice.uniform(-.02, .02), -.15 * i, 0, 0, 0,
                      dice.uniform(.05, .1)])
        if i:
            springs.append([i - 1, i, dice.uniform(60, 120),
                            .9 * math.dist(nodes[i - 1][:3], nodes[i][:3])])
    return Scene(name, 1.0, nodes, springs, wind,
                 [pin(0, nodes[0], swing, 4.0)])


def net(name, dice, n, swing, wind):
    """A sheet that falls between two of its corners."""
    nodes, springs = [], []
    for k in range(n * n):
        i, j = k // n, k % n
        nodes.append([i / (n - 1), j / (n - 1), dice.uniform(-.03, .03),
                      dice.uniform(-.2, .2), 0, 0,
                      dice.uniform(.8, 1.2) / n ** 2])
        for other in ([k - 1] * (j > 0) + [k - n] * (i > 0)
                      + [k - n - 1] * (i > 0 and j > 0)):
            springs.append([other, k, dice.uniform(40, 80),
                            math.dist(nodes[other][:3], nodes[k][:3])])
    last = n * n - n
    return Scene(name, .6, nodes, springs, wind,
                 [pin(0, nodes[0]), pin(last, nodes[last], swing, 3.0)])


def scenes(seed):
    """[(Scene as published, the one that differs a little)]: the third one is
    hidden, as all of it comes from the seed."""
    dice = random.Random(f"contest {seed}")
    shown = random.Random("published")
    found = [rope("rope", shown, 8, 0.0, []), net("net", shown, 4, .1, [])]
    hidden = net("hidden", dice, dice.choice((4, 5)), dice.uniform(.05, .2),
                 [[dice.uniform(2, 5), dice.uniform(4, 9)]])
    return [(s, s.moved(dice)) for s in (*found, hidden)]


# ---- A step

class Room(Workshop):
    """Where the runs of one step are made."""

    def __init__(self, path, step, arguments):
        super().__init__(path, step, arguments, "contest.cpp")

    def lines(self, text):
        """[(name, numbers)] of the commands in a text; BadInput says why there
        are none."""
        self.given = text.encode()
        found, outcome = self.run("run")
        if not any(name == "done" for name, _ in found):
            raise BadInput(self.why("run", outcome))
        return [line for line in found if line[0] not in ("begun", "done")]


class Cheat(Exception):
    """Why an entry is not ranked, and comes last."""


@dataclass
class Entry:
    name: str
    errors: list = field(default_factory=list)  # [m]: of scenes, of budgets
    score: float = math.inf     # mean of error / Verlet's error
    rank: int = 0               # 0: none
    reason: str = ""
    cheats: bool = False


def run_budgets(room, all_scenes):
    """{(scene, moved?): [positions, or None, by budget]}"""
    text = "".join(one.text(*(("budget", one.end, b) for b in BUDGETS))
                   for pair in all_scenes for one in pair)
    rows = iter(room.lines(text))
    found = {}
    for k, pair in enumerate(all_scenes):
        for moved in range(len(pair)):
            found[k, moved] = [positions(room, *next(rows)) for _ in BUDGETS]
    return found


def positions(room, what, row):
    if what == "over":
        raise BadInput(f"{room.where}: asks for more than {row[0]:g} forces, "
                       f"however long its steps are")
    most, steps, forces, *state = row
    if not state:
        raise BadInput(f"{room.where}: removes nodes")
    if forces < .9 * steps:
        raise Cheat(f"asks for {forces / steps:.2g} forces a step, expected at "
                    "least one: it moves nodes by other means")
    return [x for i in range(0, len(state), 6) for x in state[i:i + 3]]


def keeps_nothing(room, scene):
    """A run that begins in the middle, in a program of its own, has to end as
    the whole one; and one after other runs as the first one."""
    def state(text):
        return [row for what, row in room.lines(text) if what == "steps"]

    h, n = 1 / 128, 6
    first, half, again = state(
        scene.text(("steps", 0, 0, h, 2 * n), ("steps", 0, 0, h, n),
                   ("steps", 0, 0, h, 2 * n)))
    if len(first) != 6 * len(scene.nodes):
        raise BadInput(f"{room.where}: removes nodes")
    if any(x != x for x in first):
        raise BadInput(f"{room.where}: writes NaN")
    nodes = [[*half[6 * i:6 * i + 6], row[6]]
             for i, row in enumerate(scene.nodes)]
    rest = Scene(scene.name, 0, nodes, scene.springs, scene.wind, scene.pins)
    second, = state(rest.text(("steps", 0, n * h, h, n)))
    if first != again:
        raise Cheat("ends elsewhere when it runs again: it keeps something in "
                    "a static variable, or depends on chance")
    if first != second:
        raise Cheat("keeps something from step to step, as in a static "
                    "variable or the masses: a run that begins in the middle "
                    "of another one ends elsewhere")
    blind, = state(scene.text(("steps", 1, 0, h, 2 * n)))
    if first != blind:
        raise Cheat("looks at the springs itself: forces that it computes are "
                    "not counted")


def error(found, reference):
    if found is None or not all(map(math.isfinite, found)):
        return LOST
    return min(LOST, max(rms(found, reference[0]), reference[1]))


def errors(room, all_scenes, references):
    """[m] by scene and budget: the larger one of the scene as published and of
    that with its start moved."""
    keeps_nothing(room, all_scenes[2][0])
    found, rows = run_budgets(room, all_scenes), []
    for k, (scene, _) in enumerate(all_scenes):
        pair = [[error(x, references[k, moved]) for x in found[k, moved]]
                for moved in (0, 1)]
        # An unstable run differs as much, but not by every budget.
        if k < 2 and all(moved > max(1e-11, COPIED * shown)
                         for shown, moved in zip(*pair)):
            raise Cheat(f"knows the scene '{scene.name}': its error there is "
                        f"{size(pair[0][0])} m, and {size(pair[1][0])} m where "
                        "the nodes start up to 5 mm elsewhere")
        rows.append([max(both) for both in zip(*pair)])
    return rows


def exact(all_scenes):
    """{(scene, moved?): (positions at its end, their error)}, by a method of
    order 6 with 2,000 and 4,000 steps."""
    room = Room(ROOT / "methods.hpp", REFERENCE, 5)
    try:
        room.compile()
        rows = room.lines("".join(
            one.text(*(("budget", one.end, 11 * steps)
                       for steps in (2000, 4000)))
            for pair in all_scenes for one in pair))
        ends = [positions(room, *row) for row in rows]
    finally:
        room.close()
    return {(k, moved): (ends[4 * k + 2 * moved + 1], max(1e-13, rms(
        ends[4 * k + 2 * moved], ends[4 * k + 2 * moved + 1])))
        for k in range(len(all_scenes)) for moved in (0, 1)}


# ---- Entries

def files_of(path):
    """{name: text} of an entry: its mine.hpp, and headers beside that."""
    if path.is_symlink():
        raise BadInput(f"{path.name}:1: is a symbolic link")
    if not path.is_dir():
        if path.stat().st_size > submission.LARGEST:
            raise BadInput(f"{path.name}:1: is larger than 1 MB")
        return {"mine.hpp": path.read_bytes()}
    found = {}
    for entry in submission.in_folder(path):
        # The classes are the course's, whatever else is there.
        if re.fullmatch(r"\w+\.h(pp)?", entry.path) and entry.path not in (
                "Graph.hpp", "mass_spring.hpp", "methods.hpp"):
            if entry.problem or entry.size > submission.LARGEST:
                raise BadInput(f"{path.name}/{entry.path}:1: "
                               + (entry.problem or "is larger than 1 MB"))
            found[entry.path] = entry.read()
    if "mine.hpp" not in found:
        raise BadInput(f"{path.name}: has no mine.hpp")
    return found


def judged(path, all_scenes, references):
    """The Entry of a file or folder."""
    alone = not path.with_suffix("").is_dir()
    entry = Entry(submission.shown(
        path.name.removesuffix(".hpp") if alone or path.is_dir()
        else path.name))
    folder = pathlib.Path(tempfile.mkdtemp(dir=workshop.BUILT, prefix="entry-"))
    folder.chmod(0o755)
    room = None
    try:
        for name, text in files_of(path).items():
            (folder / name).write_bytes(text)
        file = folder / "mine.hpp"
        steps = workshop.steps_in(file.read_text("utf-8", "replace"))
        step, arguments = choose(file, "my_step" if "my_step" in steps else "")
        if arguments != 5:
            raise BadInput(f"{file}:1: {step} takes no constraint, expected "
                           f"{step}(g, t, dt, force, constraint)")
        room = Room(file, step, arguments)
        room.compile()
        entry.errors = errors(room, all_scenes, references)
    except BadInput as error_:
        entry.reason = str(error_).replace(f"{folder}/", f"{entry.name}/")
    except Cheat as error_:
        entry.reason, entry.cheats = str(error_), True
    except OSError as error_:
        entry.reason = f"{entry.name}: {error_.strerror}"
    finally:
        if room:
            room.close()
        shutil.rmtree(folder, ignore_errors=True)
    return entry


def ranked(entries, verlet):
    """In order: the mean ratio of its errors to Verlet's; then what can't be
    run; then cheats. Equal to three digits is equal."""
    for entry in entries:
        if entry.errors:
            entry.score = math.exp(sum(
                math.log(e / v) for row, other in zip(entry.errors, verlet)
                for e, v in zip(row, other)) / (3 * len(BUDGETS)))
    entries = sorted(entries, key=lambda e: (
        e.cheats, bool(e.reason), float(f"{e.score:.2e}"), e.name))
    for place, entry in enumerate(entries, 1):
        if not entry.reason:
            before = entries[place - 2] if place > 1 else None
            entry.rank = before.rank if before and (
                f"{before.score:.2e}" == f"{entry.score:.2e}") else place
    return entries


# ---- What is written

HEAD = ("rank", "name", "error / Verlet's",
        *(f"{scene}, {b}" for scene in ("rope", "net", "hidden")
          for b in BUDGETS))
ABOUT = ("Errors [m]: RMS distance of the nodes from the exact positions, "
         f"after {', '.join(map(str, BUDGETS))} force evaluations. The mean of "
         "the ratios to Verlet's errors decides.")


def cells(entry):
    place = str(entry.rank or ("out" if entry.cheats else "-"))
    if entry.reason:
        return [place, entry.name, entry.reason]
    return [place, entry.name, f"{entry.score:.3g}",
            *(size(e) for row in entry.errors for e in row)]


def as_words(entries):
    wide = max(len(e.name) for e in entries)
    return "\n".join(f"{c[0]:>6}  {c[1]:{wide}}  {c[2]}"
                     for c in map(cells, entries))


def as_html(entries, verlet, drawn):
    said = html.escape
    rows = ["<tr>" + "".join(f"<th>{said(h)}</th>" for h in HEAD) + "</tr>"]
    for entry in [*entries, Entry("Verlet", verlet, 1.0)]:
        c = cells(entry)
        last = (f"<td colspan={len(HEAD) - 2} class=fault>" if entry.reason
                else "<td>")
        rows.append("<tr>" + "".join(f"<td>{said(x)}</td>" for x in c[:-1])
                    + f"{last}{said(c[-1])}</td></tr>")
    return ("<!doctype html><html lang=en><meta charset=utf-8><title>Contest"
            f"</title><style>{report.STYLE}</style><h1>Steps in order of their "
            f"error</h1><p>{said(ABOUT)}</p>" + report.inline(drawn, 0)
            + "<table>" + "\n".join(rows) + "</table></html>\n")


def picture(entries, verlet, out):
    """Error against evaluations on each scene: the best three have names."""
    from panels import GRAY, Axis, Curve, Panel, Picture
    p = Picture(out, 1000, 400, "Error against force evaluations",
                "The best three in color, Verlet black, the others gray.", "")
    best = [e for e in entries if e.rank][:3]
    floor = min((e for one in best for row in one.errors for e in row),
                default=1e-6)
    y = Axis(10.0 ** math.floor(math.log10(min(floor, 1e-6))), 2)
    for k, scene in enumerate(("rope", "net", "hidden")):
        curves = [Curve(e.name, list(zip(BUDGETS, e.errors[k])), color, 7,
                        e.name[:16])
                  for e, color in zip(best, ("#cc0000", "#0072B2", "#009E73"))]
        curves.append(Curve("Verlet's", list(zip(BUDGETS, verlet[k])),
                            "#222222", 0, "Verlet"))
        behind = [Curve(e.name, list(zip(BUDGETS, e.errors[k])), GRAY)
                  for e in entries if e.rank and e not in best]
        panel = Panel(80 + 310 * k, 70, 350 + 310 * k, 320,
                      Axis(80, 2000), y, scene, curves, behind)
        p.draw(panel, "set xtics (100, 400, 1600)", "set format x '%g'",
               "set xlabel 'force evaluations'",
               *(["set format y '10^{%T}'", "set ylabel 'error [m]'"]
                 if k == 0 else ["set format y ''", "unset ylabel"]))
    p.finish()


def as_gradescope(entry):
    """results.json of a Gradescope autograder: no points, a leaderboard."""
    result = {"score": 0.0, "output": entry.reason or (
        f"rank {entry.rank}; the mean error is {entry.score:.3g} of Verlet's"),
        "output_format": "text", "visibility": "visible"}
    if entry.rank:
        result["leaderboard"] = [
            {"name": "error / Verlet's", "value": float(f"{entry.score:.3g}"),
             "order": "asc"},
            *({"name": f"error [m], {scene}", "value": float(f"{row[-1]:.2e}"),
               "order": "asc"} for scene, row in zip(
                   ("rope", "net", "hidden"), entry.errors))]
    return json.dumps(result, indent=1) + "\n"


def as_json(entries, seed):
    return json.dumps({
        "version": 1, "seed": seed, "budgets": BUDGETS, "entries": [
        {"name": e.name, "rank": e.rank or None,
         "score": float(f"{e.score:.3g}") if e.rank else None,
         "errors": {scene: [float(f"{x:.2e}") for x in row] for scene, row in
                    zip(("rope", "net", "hidden"), e.errors)},
         "cheats": e.cheats, "reason": e.reason} for e in entries]},
        indent=1) + "\n"


def paths_in(folder):
    try:
        found = sorted(p for p in pathlib.Path(folder).iterdir()
                       if not p.name.startswith(".")
                       and (p.is_dir() or p.suffix == ".hpp"))
    except OSError as error_:
        raise BadInput(f"{folder}: {error_.strerror}") from None
    if not found:
        raise BadInput(f"{folder}: has no entry, expected files NAME.hpp or "
                       "folders NAME with mine.hpp")
    return found


def contest(folder, seed, say=lambda _: None):
    """(entries in order, Verlet's errors)"""
    paths = paths_in(folder)
    say("the exact solutions ...")
    workshop.BUILT.mkdir(parents=True, exist_ok=True)
    all_scenes = scenes(seed)
    references = exact(all_scenes)
    room = Room(ROOT / "methods.hpp", "verlet_step", 5)
    try:
        room.compile()
        verlet = errors(room, all_scenes, references)
    finally:
        room.close()
    entries = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for entry in pool.map(lambda p: judged(p, all_scenes, references),
                              paths):
            entries.append(entry)
            say(f"{len(entries)} of {len(paths)}: {entry.name} ...")
    return ranked(entries, verlet), verlet


def main():
    get = os.environ.get
    folder, out = get("DIR"), pathlib.Path(get("OUT") or "contest")
    if not folder:
        raise BadInput("DIR is missing: make contest DIR=submissions")
    entries, verlet = contest(folder, get("SEED") or "1", progress)
    progress("")
    try:
        (out / "gradescope").mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as drawn:
            svg = pathlib.Path(drawn) / "contest.svg"
            picture(entries, verlet, svg)
            write(out / "contest.html",
                  as_html(entries, verlet, svg.read_text("utf-8")))
        write(out / "contest.json", as_json(entries, get("SEED") or "1"))
        for entry in entries:
            write(out / f"gradescope/{entry.name}.json", as_gradescope(entry))
    except OSError as error_:
        raise BadInput(f"{error_.filename}: {error_.strerror}") from None
    print(as_words(entries))
    print(f"{out}/contest.html, {out}/contest.json, {out}/gradescope/")


if __name__ == "__main__":
    try:
        main()
    except BadInput as error_:
        print(error_, file=sys.stderr)
        sys.exit(2)
