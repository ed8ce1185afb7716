"""make contest ranks right steps by their errors, and says of all others why
they have no rank.

    python3 lab/try/test_contest.py [FOLDER]       by default build/try"""

import contextlib
import io
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest.mock

import contest
import workshop
from workshop import ROOT

SEED = "20"
FORM = """#include "methods.hpp"
#include <map>
#include <stdexcept>
template <typename G, typename F, typename C>
double my_step(G& g, double t, double dt, F&& force, C&& constraint) {
  %s
  return t + dt;
}
"""
VERLET = "verlet_step(g, t, dt, force, constraint);"
EULER = """for (auto n : nodes(g)) n.position() += dt * n.value().vel;
  constraint(g, t + dt);
  kick(g, t + dt, dt, force);"""
# Heun's method, with two forces in a step.
HEUN = """std::vector<Point> x, v, a;
  for (auto n : nodes(g)) {
    x.push_back(n.position()), v.push_back(n.value().vel);
    a.push_back(force(n, t) / n.value().mass);
  }
  std::size_t i = 0;
  for (auto n : nodes(g)) {
    n.position() += dt * v[i];
    n.value().vel += dt * a[i++];
  }
  constraint(g, t + dt);
  std::vector<Point> b;
  for (auto n : nodes(g)) b.push_back(force(n, t + dt) / n.value().mass);
  i = 0;
  for (auto n : nodes(g)) {
    n.position() = x[i] + dt / 2 * (v[i] + n.value().vel);
    n.value().vel = v[i] + dt / 2 * (a[i] + b[i]), ++i;
  }
  constraint(g, t + dt);"""
# Adams and Bashforth's: of order 2 by one force, and that of the step before.
KEPT = """auto& before = KEPT;
  std::vector<Point> a;
  for (auto n : nodes(g)) a.push_back(force(n, t) / n.value().mass);
  if (before.size() != a.size() || t == 0) before = a;
  std::size_t i = 0;
  for (auto n : nodes(g)) {
    const Point kick = dt * (1.5 * a[i] - .5 * before[i]);
    n.position() += dt * n.value().vel + dt / 2 * kick;
    n.value().vel += kick, ++i;
  }
  before = a;
  constraint(g, t + dt);"""
# Eight steps of Verlet by forces that nobody counts, in what calls itself a
# constraint; and the counted one, of which it makes nothing.
HIDDEN = """for (auto n : nodes(g)) force(n, t);
  auto own = [](auto n, double) {
    Point f(0, 0, -9.81 * n.value().mass);
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
      const Point u = (*it).node2().position() - n.position();
      f += (*it).value().K * (1 - (*it).value().L / norm(u)) * u;
    }
    return f;
  };
  auto hold = [&](auto& g, double at) { constraint(g, at); };
  for (int k = 0; k < 8; ++k) verlet_step(g, t + k * dt / 8, dt / 8, own, hold);
"""
TWICE = """const int m = t > 0.3 ? 3 : 1;
  for (int k = 0; k < m; ++k)
    verlet_step(g, t + k * dt / m, dt / m, force, constraint);"""
COPY = """G own = g;
  auto hold = [&](auto&, double at) { constraint(own, at); };
  verlet_step(own, t, dt, force, hold);
  std::size_t i = 0;
  for (auto n : nodes(g)) {
    n.position() = own.node(i).position();
    n.value().vel = own.node(i++).value().vel;
  }"""
BROKEN = {      # name: (body, what the reason says)
    "compiles not": ("kick(g, t, dt, froce);", r":8: 'froce' was not declared"),
    "crashes": ("std::vector<Point> a; for (auto n : nodes(g)) "
                "a[n.index()] = force(n, t);", r":8: my_step: crashes"),
    "loops": ("for (volatile int k = 0; k >= 0;) k = 1;", "loops for ever"),
    "nan": ("kick(g, t, dt * std::sqrt(-1 - t * t), force);", "writes NaN"),
    "throws": ('throw std::runtime_error("no");', "throws .*: no"),
    "removes": ("g.remove_node(*g.node_begin());", "removes nodes"),
}
CHEATS = {
    "a static": (KEPT.replace("KEPT", "kept") , "keeps something"),
    "by graph": (KEPT.replace("KEPT", "kept_of[&g]"), "keeps something"),
    "in the mass": (VERLET + " for (auto n : nodes(g)) n.value().mass *= 1.01;",
                    "keeps something"),
    "chance": (VERLET + " g.node(0).value().vel *= 1 + 1e-9 * std::rand();",
               "depends on chance"),
    "hidden": (HIDDEN, "looks at the springs itself"),
    "no force": (EULER[:EULER.index("kick")], "asks for 0 forces a step"),
}
GLOBALS = ("static std::vector<Point> kept;\n"
           "static std::map<const void*, std::vector<Point>> kept_of;\n")


def copied(all_scenes, references):
    """A step that knows where the nodes of the two published scenes end."""
    body = VERLET
    for k, (scene, _) in enumerate(all_scenes[:2]):
        x = references[k, 0][0]
        points = ", ".join("Point(" + ", ".join(map(repr, x[i:i + 3])) + ")"
                           for i in range(0, len(x), 3))
        body += f"""
  if (g.num_nodes() == {len(x) // 3} &&
      std::abs(t + dt - {scene.end}) < 1e-9) {{
    const Point at[] = {{{points}}};
    for (auto n : nodes(g)) n.position() = at[n.index()];
  }}"""
    return body


def run(folder, out, **more):
    """(status, output) of the program itself."""
    done = subprocess.run(
        [sys.executable, ROOT / "lab/try/contest.py"], capture_output=True,
        env={**os.environ, "DIR": str(folder), "OUT": str(out), "SEED": SEED,
             **more}, text=True, timeout=600, check=False)
    return done.returncode, done.stdout + done.stderr


def run_with(references, folder, out):
    """The output of the same in this process, by exact solutions that are
    known; what loops is stopped sooner."""
    said = io.StringIO()
    with unittest.mock.patch("contest.exact", lambda _: references), \
            unittest.mock.patch.dict(workshop.SECONDS, run=6), \
            unittest.mock.patch.dict(os.environ, DIR=str(folder),
                                     OUT=str(out), SEED=SEED), \
            contextlib.redirect_stdout(said):
        contest.main()
    return said.getvalue()


def main():
    passed = failed = 0

    def ok(name, holds, why=""):
        nonlocal passed, failed
        passed, failed = passed + bool(holds), failed + (not holds)
        print(f"{'ok  ' if holds else 'FAIL'}  {name}"
              + (f": {why}" if why and not holds else ""), flush=True)

    place = pathlib.Path(sys.argv[1] if len(sys.argv) > 1
                         else ROOT / "build/try").resolve()
    place.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=place) as name:
        top = pathlib.Path(name)
        folder, few = top / "class", top / "few"
        folder.mkdir()
        all_scenes = contest.scenes(SEED)
        references = contest.exact(all_scenes)
        ok("the exact solutions are exact", all(
            e < 1e-8 for _, e in references.values()))
        for entry, body in {
                "pefrl": "pefrl_step(g, t, dt, force, constraint);",
                "verlet": VERLET, "by a copy": COPY, "euler": EULER,
                "heun": HEUN, "substeps": TWICE,
                "answers": copied(all_scenes, references),
                **{n: body for n, (body, _) in (BROKEN | CHEATS).items()}
                }.items():
            (folder / f"{entry}.hpp").write_text(GLOBALS + FORM % body)
        os.symlink(folder / "verlet.hpp", folder / "link.hpp")
        (folder / "empty").mkdir()
        said = run_with(references, folder, top / "out")
        found = json.loads((top / "out/contest.json").read_text())["entries"]
        by_name = {e["name"]: e for e in found}
        ranks = [(e["rank"], e["name"]) for e in found if e["rank"]]
        ok("the ranks", ranks[0] == (1, "pefrl") and ranks[1:3] == [
            (2, "by a copy"), (2, "verlet")] and {
                n for _, n in ranks[3:]} == {"substeps", "heun", "euler"},
           str(ranks))
        ok("Verlet is Verlet", by_name["verlet"]["score"] == 1)
        euler = by_name["euler"]["errors"]["net"]
        ok("symplectic Euler has order 1", all(
            abs(math.log(a / b, 4) - 1) < .2
            for a, b in zip(euler, euler[1:])), str(euler))
        broken = dict(BROKEN) | {"link": ("", "is a symbolic link"),
                                 "empty": ("", "has no mine.hpp")}
        cheats = dict(CHEATS) | {"answers": ("", "knows the scene 'rope'")}
        for kind, cases in ((False, broken), (True, cheats)):
            for entry, (_, says) in cases.items():
                e = by_name[entry]
                ok(entry, e["cheats"] == kind and not e["rank"]
                   and re.search(says, e["reason"]), str(e))
        order = [e["cheats"] + (not e["rank"]) for e in found]
        ok("cheats come last", order == sorted(order), str(order))
        board = json.loads((top / "out/gradescope/pefrl.json").read_text())
        ok("a leaderboard", board["leaderboard"][0] == {
            "name": "error / Verlet's", "value": by_name["pefrl"]["score"],
            "order": "asc"}, str(board))
        ok("who has no rank is on none", "leaderboard" not in json.loads(
            (top / "out/gradescope/hidden.json").read_text()))
        page = (top / "out/contest.html").read_text()
        ok("no path of this machine", str(top) not in page
           and "/entry-" not in page + said, said)

        few.mkdir()
        for entry in ("verlet", "euler", "a static"):
            (few / f"{entry}.hpp").write_text(
                (folder / f"{entry}.hpp").read_text())
        for k in (1, 2):
            run_with(references, few, top / f"out{k}")
        files = [{p.name: p.read_bytes() for p in (top / f"out{k}").rglob("*.*")
                  if p.is_file()} for k in (1, 2)]
        ok("the same bytes twice", files[0] == files[1] and len(files[0]) == 5)
        first = json.loads(files[0]["contest.json"])["entries"]
        ok("an error does not depend on the others", all(
            e == {**by_name[e["name"]], "rank": e["rank"]} for e in first))
        status, other = run(few, top / "out3", SEED="21")
        ok("it ends with 0", status == 0, other)
        third = json.loads((top / "out3/contest.json").read_text())["entries"]
        ok("another seed hides another scene",
           first[0]["errors"]["hidden"] != third[0]["errors"]["hidden"])
        for what, more, says in (
                ("no DIR", {"DIR": ""}, "DIR is missing"),
                ("an empty DIR", {"DIR": str(folder / "empty")}, "no entry"),
                ("no such DIR", {"DIR": "/nowhere"}, "No such file")):
            status, said = run(few, top / "out4", **more)
            ok(what, status == 2 and says in said, said)
    print(f"{passed} passed, {failed} failed")
    return failed != 0


if __name__ == "__main__":
    sys.exit(main())
