"""Tests of make try: steps with planted mistakes (mistakes.toml, and those of
course/wrong with `finds`), methods that nobody has, and those of methods.hpp.

    python3 lab/try/test_try.py [FOLDER]       by default build/try

EVERY=N FIRST=K takes one in N of the mistakes, from number K on; all K < N
together take each of them once. ONLY=WORD: those whose names hold WORD."""

import concurrent.futures
import math
import os
import pathlib
import random
import re
import sys
import tempfile

import measure
import teacher
from workshop import ROOT, BadInput  # it knows the way to course/kit

from tasks import tomllib

sys.path += [str(ROOT / "course/kit"), str(ROOT / "lab/charts")]
import markers  # noqa: E402
import mistakes  # noqa: E402
from results import Table, believed, runs  # noqa: E402

QUICK = ("trace", "same", "order")
FORM = """#include <stdexcept>
#include <vector>
#include "mass_spring.hpp"
template <typename G, typename F, typename C>
double my_step(G& g, double t, double dt, F&& force, C&& constraint) {
  const double end = t + dt;
  auto kick = [&](double h, double at) { for (auto n : nodes(g))
    n.value().vel += h / n.value().mass * force(n, at); };
  auto drift = [&](double h) { for (auto n : nodes(g))
    n.position() += h * n.value().vel; };
  %s%s
  return end;
}
"""
RUNGE_KUTTA = """
const double A[4][4] = {{%s}, {%s}, {%s}, {%s}}, b[] = {%s}, tau[] = {%s};
std::vector<Point> x, v, k[4], s[4];
for (auto n : nodes(g)) x.push_back(n.position()), v.push_back(n.value().vel);
for (int i = 0; i < 5; ++i) {
  std::size_t j = 0;
  for (auto n : nodes(g)) {
    Point dx, dv;
    for (int l = 0; l < (i < 4 ? i : 4); ++l) {
      const double w = i < 4 ? A[i][l] : b[l];
      dx += w * s[l][j], dv += w * k[l][j];
    }
    n.position() = x[j] + dt * dx, n.value().vel = v[j] + dt * dv;
    ++j;
  }
  if (i == 4) break;
  for (auto n : nodes(g)) {
    s[i].push_back(n.value().vel);
    k[i].push_back(force(n, t + tau[i] * dt) / n.value().mass);
  }
}
constraint(g, end);
"""


STEP = re.compile(r"template <typename G, typename F(?:, typename C)?>\n"
                  r"double symp_euler_step\(.*?\n}\n", re.DOTALL)


def of_the_course():
    """The mistakes of course/wrong that make try finds, as cases: each a file
    mine.hpp, or the step of mass_spring.hpp that it changes."""
    found = [one for table in ("cloth", "step")
             for one in mistakes.read(table) if one.finds]
    for one in found:
        right = markers.solution(markers.path_of(one.file).read_text())
        text = one.edited(right)
        if one.file == "mass_spring.hpp":
            step = next(own for own, solved in zip(
                STEP.findall(text), STEP.findall(right)) if own != solved)
            text = ('#include "mass_spring.hpp"\n'
                    + step.replace("symp_euler_step", "my_step"))
        yield {"name": one.name, "file": text, "says": one.finds,
               "status": one.status}


def text_of(case):
    if "file" in case:
        return case["file"]
    if "rk" in case:
        return FORM % ("", RUNGE_KUTTA % tuple(case["rk"]))
    return FORM % (case.get("before", ""), case["body"])


def said_of(text, parts=QUICK, step=""):
    """(status, the first lines, Verdict or None) of a file."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=FOLDER, prefix="case-"))
    path = folder / "mine.hpp"
    path.write_text(text, encoding="utf-8")
    folder.chmod(0o755)
    try:
        verdict = measure.measure(path, step, parts)
        return 0, "\n".join(teacher.first_lines(verdict)), verdict
    except BadInput as error:
        return 2, str(error), None
    finally:
        path.unlink()
        folder.rmdir()


def mistake(case):
    """Faults of the report on one mistake."""
    status, said, _ = said_of(text_of(case), case.get("parts", QUICK))
    found = [] if status == case.get("status", 0) else [f"status {status}"]
    found += [f"does not say '{words}'" for words in case["says"]
              if not re.search(words, said)]
    if status and "\n" in said:
        found.append("says it in more than a line")
    return found and [*found, *said.split("\n")]


def without_constraint(_):
    """The assignment's form of section 3.2."""
    status, said, v = said_of("""
template <typename G, typename F>
double my_step(G& g, double t, double dt, F force) {
  for (auto n : nodes(g)) n.position() += dt * n.value().vel;
  for (auto n : nodes(g)) n.value().vel += dt / n.value().mass * force(n, t);
  return t + dt;
}
""", (*QUICK, "physics", "limits", "contact"))
    if status or v.name != "symplectic Euler" or v.faults or v.order != 1:
        return [said]
    return [] if abs(v.limit - 2) < .02 else [f"limit {v.limit}"]


# ---- A method that nobody has

def own_method(seed):
    """A symmetric splitting with three kicks of random sizes: of order 2, and
    its limit is where half the trace of its matrix leaves [-1, 1]."""
    chance = random.Random(seed)
    a1, b1 = chance.uniform(.1, .4), chance.uniform(.2, .45)
    drifts, kicks = [a1, .5 - a1, .5 - a1, a1], [b1, 1 - 2 * b1, b1]
    body, at = "", 0.0
    for k, a in enumerate(drifts):
        at += a
        body += f"drift({a!r} * dt);\n"
        if k < 3:
            body += f"kick({kicks[k]!r} * dt, t + {at!r} * dt);\n"
    _, said, v = said_of(FORM % ("", body + "constraint(g, end);"),
                         (*QUICK, "physics", "limits"))
    limit = next(z / 1000 for z in range(1, 10000)
                 if abs(half_trace(drifts, kicks, z / 1000)) > 1 + 1e-9)
    found = []
    if v is None:
        return [said]
    if v.faults or v.name or "none of the methods known" not in said:
        found.append("does not say that nobody has it")
    if v.order != 2:
        found.append(f"order {v.order}, expected 2")
    if v.evaluations != 3:
        found.append(f"{v.evaluations} evaluations, expected 3")
    if abs(v.limit / limit - 1) > .02:
        found.append(f"limit {v.limit}, expected {limit}")
    if not (v.symplectic and v.symmetric):
        found.append("is not symplectic and symmetric")
    return found and [*found, said]


def half_trace(drifts, kicks, z):
    """Half the trace of the matrix of a step for x'' = -z^2 x, dt = 1."""
    columns = []
    for x, v in ((1.0, 0.0), (0.0, 1.0)):
        for k, a in enumerate(drifts):
            x += a * v
            if k < len(kicks):
                v -= kicks[k] * z * z * x
        columns.append((x, v))
    return (columns[0][0] + columns[1][1]) / 2


# ---- What methods.hpp declares: (name, order, evaluations, limit, and what
# its curve is called in the charts)

DECLARED = [
    ("forward_euler_step", "forward Euler", 1, 1, 0, "forward-euler"),
    ("verlet_step", "Verlet", 2, 1, 2, "verlet"),
    ("yoshida4_step", "Yoshida 4", 4, 3, 1.573, ""),
    ("pefrl_step", "pefrl", 4, 4, 2.989, "pefrl"),
    ("srkn11b_step", "srkn11b", 6, 11, 9.074, "srkn11b"),
    ("rk4_step", "RK4", 4, 4, 2.828, "rk4"),
    ("implicit_euler_step", "it looks at the springs itself, beside the forces",
     1, 1, math.inf, ""),
]


def declared(row):
    step, name, order, evaluations, limit, method = row
    try:
        v = measure.measure(ROOT / "methods.hpp", step,
                            (*QUICK, "limits", "chart"))
    except BadInput as error:
        return [str(error)]
    found = [f"{what}: {got}, expected {wanted}" for what, got, wanted in (
        ("name", v.name, name), ("order", v.order, order),
        ("evaluations", v.evaluations, evaluations),
        ("differs", v.differs, "")) if got != wanted]
    if v.limit != limit and not abs(v.limit - limit) < .02 * limit:
        found.append(f"limit: {v.limit}, expected {limit}")
    if v.faults:
        found.append(f"fault: {v.faults[0][0]}")
    off, met = off_the_curve(v, method) if method else (0, 3)
    if off > .001 or met < 3:
        found.append(f"{off:.1%} off the curve of {method}, {met} dots")
    return found


def off_the_curve(v, method):
    """(the largest share by which the error of a step lies off a dot of the
    laboratory's curve, with as many steps; dots met). Evaluations have to be
    the same. Errors near round-off are left out, and so are runs of more than
    3,000 steps: they take long."""
    table = Table("lab/charts/results/work_precision.csv")
    rows = [(scene, int(row["steps"]), run)
            for scene in ("chain", "curtain")
            for row in table.where(scene=scene, method=method)
            for run in believed(runs([row]))
            if run.error > 1e-11 and int(row["steps"]) < 3000]
    counts = sorted({steps for _, steps, _ in rows})
    own = measure.dots(ROOT / "methods.hpp", v.step, counts)
    first = v.table.reuses()
    worst = 0
    for scene, steps, run in rows:
        off = abs(own[steps][scene] / run.error - 1)
        if steps * v.evaluations + first != run.evaluations:
            off = math.inf
        worst = max(worst, off)
    return worst, len(rows)


class Check:
    def __init__(self):
        self.passed = self.failed = 0

    def all(self, cases):
        """cases: (name, function, argument)"""
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            waiting = [(name, pool.submit(function, argument))
                       for name, function, argument in cases]
            for name, future in waiting:
                faults = future.result()
                self.passed += not faults
                self.failed += bool(faults)
                print(f"{'FAIL' if faults else 'ok  '}  {name}", flush=True)
                for fault in faults:
                    print(f"      {fault}", flush=True)


def main():
    only = os.environ.get("ONLY", "")
    sample = slice(int(os.environ.get("FIRST") or 0), None,
                   int(os.environ.get("EVERY") or 1))
    toml = (ROOT / "lab/try/mistakes.toml").read_text(encoding="utf-8")
    cases = [(case["name"], mistake, case) for case in
             [*of_the_course(), *({"name": name, **one} for name, one
                                  in tomllib.loads(toml).items())][sample]]
    cases += [("without constraint", without_constraint, None)]
    cases += [(f"own method {seed}", own_method, seed) for seed in (1, 2)]
    cases += [(row[0], declared, row) for row in DECLARED[sample]]
    check = Check()
    check.all([case for case in cases if only in case[0]])
    print(f"{check.passed} passed, {check.failed} failed")
    return check.failed != 0


FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1
                      else ROOT / "build/try").resolve()

if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    sys.exit(main())
