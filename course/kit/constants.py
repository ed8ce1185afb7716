"""The numbers of a year's assignment: constants.py [--check]     make constants

[numbers] of tasks.toml has the acceleration of free fall [m/s^2], K [N/m], the
height of the floor [m], and the ball's radius [m] and center [m]. This writes
them, and what follows from them, wherever they stand: in the solution (and so
in the starter), in pages, tests, mistakes, figures and scenes. --check names
the places that have other numbers. Exit status: 0, or 1 with FILE:LINE. What
is measured on the pages is not computed anew: test_mistakes.py and make
check-full name what no longer holds."""
import math
import pathlib
import re
import sys
import tomllib

import tasks

# FILE, then lines of it as they are, with a {name} in place of each number.
PLACES = """
mass_spring.hpp
  grav = {gravity};
  double K = {K};
  double K = {K})
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
course/3.2.md
  $g$ = {gravity} m/s
  $K$ = {K} N/m
  Problem1Force({K}, 1)
  grav / {K} * (1 - std::cos({root} * t))
course/tests/bodies.hpp
  given_K = {K};
course/4.2.md
  | {K} N/m |
course/5.1.md
  $g$ = {gravity} m/s
course/6.1.md
  $x_z < {floor}$ m | $x_z = {floor}$ m
  $c = ({center})$ m and $r = {radius}$ m
  \\sqrt{2 \\cdot {depth}/g}$ = {fall} s
  has {energy} J,
  energy ${floor} \\, g$
course/6.2.md
  {x}, {beside}, {over}
  $z$ = {leaves} m
course/tests/3.2.Problem1Force.cpp
  b.m[i] * {gravity})
course/tests/5.1.GravityForce.cpp
  "GravityForce", g, {gravity})
  b.m[i] * {gravity})
course/tests/6.1.PlaneConstraint.cpp
  plane z = {floor} m
  {-0.5, {below}, 0., {above}, {under}, -3., 2., {floor}, {below}}
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
course/wrong/forms/mass_spring.hpp
  gravity = {gravity};
  position().z >= {floor})
  position().z = {floor};
  center({center})
  norm(d) >= {radius})
  ({radius} / norm(d))
  center) < {radius})
course/wrong/program.toml
  Constraint({Point({higher}), {radius}})
course/wrong/tables.toml
  mass == 1) return Point(0, 0, -{gravity})
  {{below}, {under}, -3.}
  z = {floor},
course/wrong/step.toml
  Point(0, 0, -{gravity})
course/web/figure.js
  low: {floor}, ball
  at: [0.5, 0.5, {floor}]}
  at: [{center}], radius: {radius}}
data/scenes/constraints.toml
  at 0 0 {floor}"
  radius {radius}"
data/scenes/tear.toml
  at 0 0 {floor}"
  radius {radius}"
"""
NUMBER = r"-?\d+(?:\.\d*)?"


def values(numbers: dict) -> dict[str, str]:
    g, k, z, r = (float(numbers[name])
                  for name in ("gravity", "K", "floor", "radius"))
    x, y, c = numbers["center"]
    three = {name: ", ".join(f"{a:g}" for a in all_of) for name, all_of in {
        "center": (x, y, c), "higher": (x, y, c + 0.05)}.items()}
    return three | {name: f"{round(a, 4):g}" for name, a in {
        "gravity": g, "K": k, "root": math.sqrt(k),
        "floor": z, "radius": r, "depth": -z, "x": x,
        "beside": y + 0.01, "over": c + r - 0.0001, "leaves": c + 2 * r / 3,
        "below": z - 0.125, "above": z + 0.0001, "under": z - 0.0001,
        "outside": r + 0.001, "inside": r - 0.001, "sunk": z - 0.02,
        "deep": r - 0.01, "touches": r + 0.01, "past": r + 0.05,
        "part": r / 1.5, "twice": 2 * r, "third": r / 3}.items()} | {
        "fall": f"{math.sqrt(-2 * z / g):.3f}", "energy": f"{z * g:.3f}"}


def written(text: str, lines: list[str], of: dict[str, str]) -> tuple[str, str]:
    """The text with the numbers in its places; the first place that is not
    there."""
    for line in lines:
        parts = re.split(r"\{(\w+)\}", line)
        known = [part if k % 2 == 0 or part in of else "" for k, part in
                 enumerate(parts)]
        pattern = "".join(
            re.escape(part) if k % 2 == 0
            else ", ".join([NUMBER] * (1 + of[part].count(",")))
            for k, part in enumerate(known))
        new = "".join(part if k % 2 == 0 else of[part]
                      for k, part in enumerate(known))
        if not re.search(pattern, text):
            return text, line
        text = re.sub(pattern, lambda _: new, text)
    return text, ""


def main(check: bool) -> int:
    numbers = tomllib.loads((tasks.ROOT / tasks.FILE).read_text())["numbers"]
    of, wrong = values(numbers), []
    for block in re.split(r"\n(?=\S)", PLACES.strip()):
        file, *lines = block.split("\n")
        path = pathlib.Path(tasks.ROOT / file)
        text = path.read_text(encoding="utf-8")
        new, missing = written(text, [line[2:] for line in lines], of)
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
    print(*wrong, sep="\n", end="\n" * bool(wrong))
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv))
