"""The numbers of a year's assignment: constants.py [--check]     make constants

[numbers] of tasks.toml has gravity [m/s^2], K [N/m], the height of the floor
[m], the ball's radius [m] and center [m]. This writes them, and what follows
from them, wherever they stand: in the solution (and so in the starter), in
pages, tests, mistakes, figures and scenes. --check names places with others.
Exit status: 0, or 1 with FILE:LINE. What is not computed, it lists."""
import cmath
import math
import pathlib
import re
import sys
from collections.abc import Iterator

import tasks

# FILE..., then lines of it as they are, with a {name} in place of each number.
PLACES = """
mass_spring.hpp
  grav = {gravity};
  double K = {K}
  double height = {floor})
  center = Point({center});
  double radius = {radius};
mass_spring.cpp
  Problem1Force({K}, L)
  add_sphere(Point({center}), {radius})
  add_plane({floor})
course/tasks.toml
  below z = {floor} m
  center ({center}) m and radius {radius} m
  every edge has K = {K} N/m
course/3.2.md
  $g$ = {gravity} m/s
  $K$ = {K} N/m
  Problem1Force({K}, 1)
  grav / {K} * (1 - std::cos({root} * t))
  free fall is {fallen} m
  $\\omega = {root}$
  0.001 s: error {plain} ... 0.0005 s: error {halved}
  small steps: {theory} m
course/requirements.toml
  "$K$ = {K} N/m"
  "$x_z < {floor}$ m"
  "$c = ({center})$ m and $r = {radius}$ m"
course/tests/bodies.hpp
  given_K = {K};
course/4.2.md
  | {K} N/m |
  energy {crumpled} J
course/5.1.md
  $g$ = {gravity} m/s
course/5.2.md
  the value `{{K}, 1}`
  g/{K}$ and $w = \\sqrt{{less}}$
  the error is {damped} m
course/8.md
  Verlet leaves {verlet} m, symplectic Euler {size} m
course/6.1.md
  $x_z < {floor}$ m | $x_z = {floor}$ m
  $c = ({center})$ m and $r = {radius}$ m
  \\sqrt{2 \\cdot {depth}/g}$ = {fall} s
  has {energy} J,
  energy ${floor} \\, g$
course/6.2.md
  Point({x}, {beside}, {over})
  $z$ = {leaves} m
course/tests/3.2.Problem1Force.cpp
  b.m[i] * {gravity})
course/tests/5.1.GravityForce.cpp
  "GravityForce", g, {gravity})
  b.m[i] * {gravity})
course/tests/6.1.PlaneConstraint.cpp
  plane z = {floor} m
  -0.5, {below}, 0., {above}, {under}, -3., 2., {floor}, {below}}
  z < {floor};
  below ? {floor} : double(b.x
course/tests/6.1.SphereConstraint.cpp
  center ({center}) m
  * {radius} m.
  c({center})
  r = {radius};
course/tests/7.2.TearConstraint.cpp
  p - Point({center});
  b.add(Point({center}) + radius
  center({center})
  < {radius} * {radius};
  ({outside} + s)
  {{inside}, {outside}, {part}, {past}, {twice}, {third}}
  at {third} to {twice} m
  0) + {part} * Point(0, 0, 1)
course/tests/7.2.grid1.cpp
  center({center})
  x[i].z < {floor}) x[i].z = {floor},
  norm(r) < {radius})
  center + {radius} /
  Point(0, 0, -{gravity})
  "GravityForce", g, {gravity})
course/tests/7.2.program.cpp
  ball = {radius}, floor = {floor};
  center = Point({center})
  Point a(0, 0, -{gravity})
  w.lowest > {sunk},
  floor at {floor} m
  nearest_to_ball > {deep},
  nearest_to_ball < {touches},
course/tests/cloth_calls.hpp
  plane z = {floor} m
  C({floor})
  1), {floor})
  center({center})
  (center, {radius})
  ({radius}, center)
course/tests/trial.hpp
  -{gravity} * start
course/wrong/cloth.toml
  double K = {K};
  'double K = {K}) {', 'double K = 10 * {K}) {'
  : z({floor} + 0 * height)
course/wrong/forms/mass_spring.hpp
  stiffness = {K};
  gravity = {gravity};
  position().z >= {floor})
  position().z = {floor};
  center({center})
  norm(d) >= {radius})
  ({radius} / norm(d))
  center) < {radius})
course/wrong/program.toml
  Constraint({Point({x}, {y}, {higher}), {radius}})
course/wrong/tables.toml
  Point(0, 0, -{gravity})
  {{below}, {under}, -3.}
  z = {floor},
course/wrong/step.toml
  Point(0, 0, -{gravity})
course/kit/test_programs.py
  2 * -{gravity})
course/pictures/draw.py
  FLOOR = {floor}
course/web/cloth.cpp
  Problem1Force({K}, length_)
  return {{K}, length_};
course/web/figure.js
  low: {floor}, ball
  at: [0.5, 0.5, {floor}]}
  at: [{center}], radius: {radius}}
data/scenes/constraints.toml data/scenes/tear.toml
  at 0 0 {floor}"
  at {x} {y} {z} radius {radius}"
  from 0 -0.4 {floor} to
"""
MEASURED = """\
Not computed: the corners and the drag 1/N, which are none of [numbers], as
tests of 7.2 have nets for them (git grep '1, 0, 0'); and what was measured, for
which look at: make kit-check course-pictures, energies and times below "What
you see" and "Usual mistakes" of course/3.2.md to 6.2.md, course/teaching.md"""
NUMBER = r"-?\d+(?:\.\d*)?(?:e[-+]\d+)?"


def swing(g: float, k: float, steps: int, drag: float = 0,
          first: float = 1) -> float:
    """The error [m] after 1 s of 1 kg on a spring that hung at rest, by the
    step of 3.2; Verlet's if half of a drift is done `first`."""
    z = v = 0.0
    for _ in range(steps):
        z += first / steps * v
        v -= (g + k * z + drag * v) / steps
        z += (1 - first) / steps * v
    w = cmath.sqrt(k - drag ** 2 / 4)
    return z + g / k * (1 - math.exp(-drag / 2) * (
        cmath.cos(w) + drag / 2 / w * cmath.sin(w)).real)


def values(text: str) -> dict[str, str]:
    """What [numbers] of tasks.toml, a text, say.  Throws TasksError."""
    tasks.parse(text)
    numbers = tasks.tomllib.loads(text).get("numbers", {})
    try:
        g, k, z, r = (float(numbers.pop(name))
                      for name in ("gravity", "K", "floor", "radius"))
        x, y, c = map(float, numbers.pop("center"))
        if numbers or not 0 < min(g, k, 4e6 - k, -z, r) or not math.isfinite(
                g + k + z + r + x + y + c):
            raise ValueError
    except (KeyError, TypeError, ValueError):
        line = 1 + text.partition("[numbers]")[0].count("\n")
        raise tasks.TasksError([
            f"{tasks.FILE}:{line}: [numbers] has gravity, K and radius > 0, "
            "K < 4e6, floor < 0, center with three numbers, no "
            "others"]) from None
    return {name: f"{a:.12g}" for name, a in {
        "gravity": g, "K": k, "floor": z, "radius": r, "depth": -z, "x": x,
        "y": y, "z": c}.items()} | {name: f"{round(a, 4):g}" for name, a in {
        "root": k ** 0.5, "beside": y + 0.01, "over": c + r - 0.0001,
        "higher": c + 0.05, "leaves": c + 2 * r / 3,
        "below": z - 0.125, "above": z + 0.0001, "under": z - 0.0001,
        "outside": r + 0.001, "inside": r - 0.001, "sunk": z - 0.02,
        "deep": r - 0.01, "touches": r + 0.01, "past": r + 0.05,
        "part": r / 1.5, "twice": 2 * r, "third": r / 3}.items()} | {
        "fall": f"{math.sqrt(-2 * z / g):.3f}", "energy": f"{z * g:.3f}",
        "fallen": f"{0.045 * g:.2f}", "less": f"{k - 1:.12g}",
        "crumpled": f"{k * (math.sqrt(2) - 1) ** 2:.6g}"} | {
        name: f"{error:.2g}".replace("e-0", "e-") for name, error in {
            "plain": swing(g, k, 1000), "halved": swing(g, k, 2000),
            "theory": g / 2000 / k ** 0.5 * math.sin(k ** 0.5),
            "damped": abs(swing(g, k, 1000, 2)),
            "verlet": abs(swing(g, k, 1000, 0, 0.5)),
            "size": abs(swing(g, k, 1000))}.items()}


def places() -> Iterator[tuple[str, list[str]]]:
    every = PLACES.replace("{center}", "{x}, {y}, {z}").strip()
    for block in re.split(r"\n(?=\S)", every):
        files, *lines = block.split("\n")
        yield from ((file, [line[2:] for line in lines])
                    for file in files.split())


def written(text: str, lines: list[str], of: dict[str, str]) -> tuple[str, str]:
    """The text with the numbers in its places; a place that is not there."""
    for line in lines:
        pattern = re.sub(r"\\{\w+\\}", lambda _: NUMBER, re.escape(line))
        new = re.sub(r"{(\w+)}", lambda name: of[name[1]], line)
        text, many = re.subn(pattern, new.replace("\\", r"\\"), text)
        if not many:
            return text, line
    return text, ""


def main(check: bool) -> int:
    try:
        of = values((tasks.ROOT / tasks.FILE).read_text("utf-8"))
    except tasks.TasksError as error:
        sys.exit(str(error))
    wrong = []
    for file, lines in places():
        path = pathlib.Path(tasks.ROOT / file)
        text = path.read_text(encoding="utf-8")
        new, missing = written(text, lines, of)
        if missing:
            wrong.append(f"{file}:1: has no '{missing}'")
        elif new != text and check:
            old = zip(text.splitlines(), new.splitlines())
            line = next(k for k, (a, b) in enumerate(old, 1) if a != b)
            wrong.append(f"{file}:{line}: is not of [numbers] in {tasks.FILE}: "
                         "make constants")
        elif new != text:
            path.write_text(new, encoding="utf-8")
            print("written:", file)
    if not check:
        print(MEASURED)
    print(*wrong, sep="\n", end="\n" * bool(wrong))
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv))
