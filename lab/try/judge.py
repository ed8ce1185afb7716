"""Turn the probe's numbers into a Verdict on a step, in words."""

import cmath
import math
import struct
from collections.abc import Iterable
from dataclasses import dataclass, field

import faults
import orders
import table as tables
from orders import Order, Vector
from workshop import BadInput, Lines

Numbers = dict[str, list[Vector]]
ROUNDOFF = 1e-11


@dataclass
class Verdict:
    step: str
    is_a: str = ""              # what it is, in a sentence
    name: str = ""              # of a known method that it equals
    differs: str = ""           # from it, or from its table, when ...
    faults: list = field(default_factory=list)     # (sentence, advice)
    later: list = field(default_factory=list)      # reported after the others
    notes: list = field(default_factory=list)
    facts: list = field(default_factory=list)      # (what, words)
    advice: str = ""
    table: tables.Table | None = None   # of an explicit step
    evaluations: int = 0        # a step; a force kept counts once
    orders: dict[str, Order] = field(default_factory=dict)
    order: int | None = None
    one_by_one: bool = False    # a force sees some nodes moved, others not
    calls: int = 0              # of the force for a node, in a step
    half_calls: int = 0         # the same of half a step
    ignores_dt: bool = False
    symmetric: bool = False
    symplectic: bool = False
    energy: tuple = (0, "")     # gained in a long run, as a share; words
    limit: float = 0            # dt omega, without drag; inf: none found
    weak: tuple = ()            # (dt omega, growth a step) below the limit
    data: dict = field(default_factory=dict)       # what the charts draw


def by_name(lines: Lines) -> Numbers:
    found: Numbers = {}
    for name, numbers in lines:
        found.setdefault(name, []).append(numbers)
    return found


def size(x: float) -> str:
    return f"{x:.2g}".replace("e-0", "e-").replace("e+0", "e")


# ---- What it is

def distance(one: Vector, other: Vector) -> float:
    far = max(abs(a - b) for a, b in zip(one, other))
    scale = max(1.0, *(abs(x) for x in one))
    return far / scale if math.isfinite(far) else math.inf


def events(where: str, lines: Lines) -> tables.Runs:
    runs = tables.events([(name, numbers) for name, numbers in lines
                          if name in ("begin", "call", "hold", "end")])
    faults.bad_input(where, runs, lines)
    return runs


def trace(verdict: Verdict, where: str, lines: Lines,
          constrained: bool) -> None:
    """Read the table of a step, and the faults that it shows."""
    runs = events(where, lines)
    base = runs[faults.FULL, -1]
    found = faults.counts(base)
    loop = [] if found else faults.loops(base)
    found += loop
    verdict.one_by_one = bool(loop)
    one, two, half = (tables.read(runs, h, node) if not found or loop else None
                      for h, node in ((faults.FULL, 0), (faults.FULL, 1),
                                      (faults.HALF, 0)))
    if one and two and half and one.stages == half.stages and not loop:
        found += faults.own_force(lines) or faults.own_drag(one, half)
        found += faults.masses(one, two)
        if not found:
            found += faults.steps(one, half)
        verdict.table = tables.pruned(tables.merged(one))
    verdict.data["raw"] = one
    verdict.faults += found
    verdict.later += faults.returned(runs)
    if constrained and not faults.counts(base):
        held, notes = faults.constraint(runs)
        verdict.later += held
        verdict.notes += notes
    verdict.calls, verdict.half_calls = (
        sum(e.what == "call" and e.node == 0 for e in runs[h, -1])
        for h in (faults.FULL, faults.HALF))


def keeps_state(where: str, same: Numbers, random: str) -> None:
    """@param random  place and name of a random number in the file, or ''"""
    ends = same["tangle.end"]
    if any(x != x for end in ends for x in end):
        raise BadInput(f"{where}: writes NaN on four masses and springs")
    equal = all(distance(ends[0], end) == 0 for end in ends[1:])
    if random and not equal:
        raise BadInput(f"{random} draws random numbers: two equal runs end "
                       "differently, so nothing can be measured")
    if not equal:
        raise BadInput(f"{where}: keeps something from one run to the next, "
                       "in a global or static variable: the same run ends "
                       "elsewhere after another one")


def single_precision(numbers: Iterable[float]) -> bool:
    return all(struct.unpack("f", struct.pack("f", x))[0] == x
               for x in numbers)


def unchanged(verdict: Verdict, same: Numbers) -> None:
    """Faults of a step that changes masses or springs, or rounds to float."""
    before, *after = same["data"]
    if any(data != before for data in after):
        verdict.faults.append((
            "it changes the masses, or K or L of the springs",
            "A step moves nodes and changes velocities, nothing else."))
    x = same["tangle.end"][0]
    for what, first in (("positions", 0), ("velocities", 3)):
        if single_precision(x[k] for k in range(len(x))
                            if first <= k % 6 < first + 3):
            verdict.faults.append((
                f"it keeps {what} in single precision: errors below about "
                "1e-7 of their size are lost", "Use double, not float."))


# Where a step differs from its table (sweep in Agree.hpp), by the first that
# is found: words for a value above the usual one.
DIFFERS = {
    "x": "x > {} m", "-x": "x < {} m", "y": "y > {} m", "-y": "y < {} m",
    "z": "z > {} m", "-z": "z < {} m", "nodes": "there are {} nodes",
    "speed": "a node is faster than {} m/s", "force": "more than {} N act",
    "length": "nodes on a spring are more than {} L apart",
    "K": "K is more than {} N/m", "mass": "a mass is more than {} kg",
    "t": "t is more than {} s", "place": "a node is near ({}, {}, {})",
    "dt": "dt is more than {} s", "grid1": "grid1 moves by steps of {} s",
    "far": "four masses have moved for {} s"}
BELOW = (("faster", "slower"), ("more", "less"))


def differs(agree: Numbers) -> str:
    """When a step is not what its table says, or ''."""
    for name, words in DIFFERS.items():
        if name not in agree:
            continue
        values, *others = agree[name]
        scale = {"length": 1 / .3}.get(name, 1)
        if name.strip("-") in ("x", "y", "z"):
            values = [.3 - values[0] if name[0] == "-" else values[0] - .3]
        elif name not in ("place", "grid1", "far") and not values[1]:
            for above, below in BELOW:
                words = words.replace(above, below)
        elif name == "speed" and others and abs(
                others[-1][0] / values[0] - values[2] / others[-1][2]) < .01:
            words = "a node moves more than {} m in a step"
            scale = values[2]
        return words.format(*(
            f"{scale * x:{'.0f' if scale * x > 99 else '.2g'}}"
            for x in values))
    return ""


def identify(verdict: Verdict, same: Numbers, agree: Numbers) -> None:
    """Compare with the known methods, by table and by runs."""
    unchanged(verdict, same)
    long, short = (distance(*same["dt"][k:k + 2]) == 0 for k in (0, 2))
    verdict.ignores_dt = long and short
    if long:
        verdict.faults.insert(
            0, faults.IGNORES_DT if short else faults.CUTS_DT)
    t = verdict.table
    off = distance(*agree["slow"]) if t else math.inf
    if t and "rounds" in agree:
        verdict.faults.append(faults.SINGLE)
    elif t and off >= 1e-9 and "usual" in agree:
        verdict.differs = differs(agree)
    raw = verdict.data["raw"]
    verdict.evaluations = verdict.calls
    springs = faults.springs(same["spring"])
    if springs:
        verdict.is_a, found, notes = springs
        verdict.faults = found + [fault for fault in verdict.faults
                                  if fault != faults.NEVER_ASKS]
        verdict.notes += notes
        verdict.name = verdict.is_a.split(":")[0]
        verdict.table, verdict.differs = None, ""
        return
    if t is None or off >= 1e-9 and not verdict.differs:
        if not verdict.faults and off < 1e-5:
            verdict.faults.append(faults.SINGLE)
        elif not verdict.faults:
            verdict.is_a = faults.beside(
                same["reads"], verdict.calls, verdict.half_calls)
            verdict.name = verdict.is_a.split(":")[0]
        verdict.table = None
        return
    verdict.evaluations = t.stages - t.reuses()
    words = f"{verdict.calls} call{'s' * (verdict.calls != 1)} a node and step"
    more = []
    if t.stages < raw.stages:
        more.append(f"{t.stages} at different positions")
    if t.reuses():
        more.append(f"{t.stages - 1} if the last force of a step is kept for "
                    "the next one, as in the charts")
    verdict.facts.append(("force evaluations", "; ".join([words, *more])))
    methods = tables.known()
    verdict.name = next((
        name for name, other in {**methods, **tables.repeated()}.items()
        if tables.same(t, other, ROUNDOFF)), "")
    if verdict.faults:
        return
    verdict.differs = differs(agree)
    if verdict.name:
        verdict.is_a = f"it is equal to {verdict.name} " + (
            "in slow, free motion" if verdict.differs else "to round-off")
    else:
        verdict.faults += faults.coefficients(raw, t, methods)
    if not verdict.faults:
        late, notes = faults.times(t, not faults.second_order(t))
        verdict.faults += late
        verdict.notes += notes


# ---- Order

def order(verdict: Verdict, numbers: Numbers) -> None:
    for name in orders.END:
        rows = numbers.get(name, [])
        verdict.orders[name] = orders.measured(rows, name)
    smooth = [verdict.orders[n] for n in orders.SMOOTH]
    if not all(o.order == o.order for o in smooth):
        verdict.facts.append(("order", "not measurable: no run with a small "
                              "step comes close to the exact solution"))
        return
    least = min(smooth, key=lambda o: o.order)
    verdict.order = least.whole
    words = []
    for name in orders.SMOOTH:
        o = verdict.orders[name]
        n0, n1 = o.points[o.first][0], o.points[o.last][0]
        words.append(f"{o.order:.2f} for {orders.ABOUT[name]} ({n0} to {n1} "
                     "steps)")
        if o.coarser == o.coarser:
            words[-1] += (f", {o.coarser:.1f} only down to an error of "
                          f"{size(o.ends)}")
    verdict.facts.append(("order", "; ".join(words)))
    d = verdict.orders["drag"]
    if d.order == d.order:
        verdict.facts.append(("order with drag in the force",
                              f"{d.order:.2f}"))
    apart = numbers.get("apart")
    if apart and any(distance(x[2:], y[2:]) > 1e-13
                     for x, y in zip(apart, numbers["drag"])):
        o = orders.measured(apart, "drag")
        verdict.facts.append(("order with drag given apart (WithDrag)",
                              f"{o.order:.2f}"))


# ---- What it keeps

def physics(verdict: Verdict, numbers: Numbers) -> None:
    there = numbers["there"][0]
    back = distance(there, numbers["back"][0])
    turned = distance(there, numbers["reversed"][0])
    verdict.symmetric = back < 1e-10
    verdict.facts.append(("symmetric", f"{yes(back < 1e-10)}: a step and one "
                          f"back by -dt end {size(back)} m from the start"))
    verdict.facts.append(("reversible", f"{yes(turned < 1e-10)}: with reversed "
                          f"velocities it ends {size(turned)} m from the "
                          "start"))
    off = symplectic(numbers["jacobian"])
    verdict.symplectic = off < 1e-7
    verdict.facts.append(("symplectic", f"{yes(verdict.symplectic)}: the "
                          f"Jacobian of a step misses J^T S J = S by "
                          f"{size(off)}"))
    rows = numbers["invariants"]
    p = drift(rows, slice(2, 5))
    spin = drift(rows, slice(5, 8))
    verdict.facts.append(("momentum", kept(p)))
    verdict.facts.append(("angular momentum", kept(spin)))
    verdict.energy = energy(rows)
    verdict.facts.append(("energy", verdict.energy[1]))
    if sum(math.isfinite(r[1]) and r[1] < 5 * rows[0][1] for r in rows) > 9:
        verdict.data["energy"] = rows


def yes(is_it: bool) -> str:
    return "yes" if is_it else "no"


def kept(off: float) -> str:
    if off != off:
        return "lost: the run diverges"
    return (f"kept to {size(off)} in 20,000 steps" if off < 1e-9
            else f"changes by {size(off)} of its size in 20,000 steps")


def drift(rows: list[Vector], columns: slice) -> float:
    first = rows[0][columns]
    if not all(math.isfinite(x) for r in rows for x in r[columns]):
        return math.nan
    scale = max(1e-3, math.sqrt(sum(x * x for x in first)))
    return max(math.dist(first, r[columns]) for r in rows) / scale


def energy(rows: list[Vector]) -> tuple[float, str]:
    """(gained share a step, words)"""
    e = [r[1] for r in rows]
    first = e[0]
    for k, value in enumerate(e):
        if not math.isfinite(value) or abs(value) > 100 * abs(first):
            return math.inf, (f"grows without bound: more than 100 times as "
                              f"much after {20 * k} steps")
    begin, late = (sum(part) / len(part) for part in (
        e[:len(e) // 50], e[-len(e) // 4:]))
    swing = (max(e) - min(e)) / first
    gained = (late - begin) / first
    if max(e[-len(e) // 4:]) < .5 * first:      # most of it at once
        gained = late / first - 1
    if abs(gained) > .05 or abs(gained) > .5 * swing > 1e-6:
        return gained, (f"{'gains' if gained > 0 else 'loses'} "
                        f"{size(100 * abs(gained))} % in 20,000 steps at a "
                        "quarter of Verlet's limit: it drifts")
    return 0, (f"oscillates by {size(100 * swing)} % without drift, in 20,000 "
               "steps at a quarter of Verlet's limit")


def symplectic(columns: list[Vector]) -> float:
    """|J^T S J - S| with S of the masses of the tangle."""
    n = len(columns)
    mass = [.5 + .25 * (i // 6) for i in range(n)]

    def form(a, b):
        return sum(mass[i] * (a[i] * b[i + 3] - a[i + 3] * b[i])
                   for i in range(n) if i % 6 < 3)
    units = [[float(i == k) for i in range(n)] for k in range(n)]
    worst: float = 0
    for k in range(n):
        for j in range(k):
            off = abs(form(columns[j], columns[k]) - form(units[j], units[k]))
            worst = max(worst, off if off == off else math.inf)
    return worst


# ---- Limits

def radius(m: Vector) -> float:
    """The largest |eigenvalue| of a step; m: its matrix by columns."""
    a, c, b, d = m
    if not all(abs(x) < 1e100 for x in m):      # nor NaN
        return math.inf
    half, det = (a + d) / 2, a * d - b * c
    root = cmath.sqrt(half * half - det)
    return max(abs(half + root), abs(half - root))


def limits(verdict: Verdict, numbers: Numbers) -> None:
    line = [(row[0], radius(row[2:])) for row in numbers["line"]]
    stable = [(z, r <= 1 + 1e-6) for z, r in line]
    weak: tuple = ()
    limit, k = math.inf, 0
    while k < len(line):
        if stable[k][1]:
            k += 1
            continue
        end = next((j for j in range(k, len(line)) if stable[j][1]), None)
        growth = max(r for _, r in line[k:end or len(line)])
        if end is None or growth > 1.02:
            limit = line[k - 1][0] if k else 0
            break
        weak = weak or (line[k][0], growth)
        k = end
    verdict.limit, verdict.weak = limit, weak
    verdict.data["line"] = numbers["line"]
    if verdict.ignores_dt:
        words = "not judged: the step ignores dt"
    elif limit == 0:
        words = "none: an oscillation grows at any step, without drag"
    elif limit == math.inf:
        words = "none found: stable for all dt omega up to 12"
    else:
        share = limit / max(1, verdict.evaluations)
        words = f"dt omega < {limit:.3f}"
        if verdict.table:
            words += (f", {share:.2f} for each force evaluation; no explicit "
                      "step has more than 2")
    if weak:
        words += (f"; from {weak[0]:.2f} on there are gaps in which it grows "
                  f"by up to {size(100 * (weak[1] - 1))} % a step")
    verdict.facts.append(("limit on an oscillator", words))
    verdict.data["map"] = [(r[0], r[1], radius(r[2:])) for r in numbers["map"]]
    if 0 < limit < math.inf:
        limits_with_drag = []
        for drag in (.5, 1, 2):
            z = next((r[0] for r in numbers["drag"] if r[1] == drag
                      and radius(r[2:]) > 1 + 1e-6), 6.01)
            least = ("6 or more" if z > 6 else f"{z - .01:.2f}" if z > .015
                     else "0: at no step")
            limits_with_drag.append(f"{least} where dt c/m = {drag:g}")
        verdict.facts.append(("limit with drag as a force", "dt omega < "
                              + ", ".join(limits_with_drag)))
    for gamma, low, high, first in numbers.get("grid1", []):
        what = "grid1" + (f", drag {gamma:g} 1/s" if gamma else "")
        if low == 0:
            words = (f"gains energy already at {high:.3g} s, 1/16 of "
                     "Verlet's safe step")
        else:
            words = (f"{low:.4g} s, {low / first:.2f} times Verlet's safe step"
                     f"{', or more' if low > 15.8 * first else ''} (it gains "
                     "less than 0.5 J in 0.25 s)")
        verdict.facts.append((f"largest step on {what}", words))
        if gamma == 0:
            verdict.data["grid1"] = low, high, first
    for name in ("inside", "outside", "shape.outside"):
        verdict.data[name] = numbers.get(name, [])


# ---- Contact, tearing, pins

def tearing(verdict: Verdict, numbers: Numbers) -> None:
    runs: dict[float, dict[float, Vector]] = {}
    for removing, mass, *state in numbers["torn"]:
        runs.setdefault(removing, {})[mass] = state
    whole, last = runs.pop(0), runs.pop(-1)
    by_order = any(distance(whole[m], last[m]) > 1e-12 for m in whole)
    mixed = any(m not in torn or distance(whole[m], torn[m]) > 1e-12
                for torn in runs.values() for m in whole if m != 100)
    words = "the others move as if nothing had been removed"
    if mixed and by_order:
        words = "not judged: the order of the nodes changes the motion"
    elif mixed:
        words = "the nodes that stay get positions or velocities of others"
        verdict.faults.append((
            "after the constraint removes a node it mixes up the others",
            "Indices change when a node is removed: store nothing by index "
            "across a call of the constraint."))
    for removing, in numbers.get("torn.throws", []):
        words += ("; it throws if the constraint removes one at its "
                  f"{faults.ordinal(int(removing) - 1)} call in a step")
    verdict.facts.append(("removal of nodes", words))


def contact(verdict: Verdict, numbers: Numbers) -> None:
    if "torn" not in numbers:
        return
    deep, off = numbers["deepest"][0]
    verdict.facts.append(("obstacles", "no node is inside at the end of a step"
                          if deep < 1e-12 else f"nodes are up to {size(deep)} "
                          "m inside at the end of a step"))
    if off > 1e-12:
        verdict.facts.append(("pins", f"they leave their place by {size(off)} "
                              "m"))
    tearing(verdict, numbers)
    base = verdict.orders["chain"].order
    for name, what in (("still", "order with a pin at rest"),
                       ("pins", "order with a moving pin"),
                       ("ball", "order with contact")):
        o = orders.by_differences(numbers.get(name, []))
        verdict.data[name] = o
        if o.order != o.order:
            continue
        words = f"{o.order:.2f}"
        if o.order < base - .3:
            words += f": it loses {base - o.order:.1f}"
        verdict.facts.append((what, words))


# ---- Among the laboratory's methods

CHARTED = {"chain": orders.chart_chain(), "curtain": orders.chart_curtain()}


def chart(verdict: Verdict, numbers: Numbers) -> None:
    # A force that is kept from step to step is computed once at the start.
    first = bool(verdict.table and verdict.table.reuses())
    for scene, solution in CHARTED.items():
        verdict.data[f"chart.{scene}"] = [
            (steps, steps * verdict.evaluations + first,
             orders.rms(x, solution))
            for steps, _, *x in numbers[f"chart.{scene}"]]
    own, verlet = numbers["times"][0]
    ratio = own / max(1, verlet)
    verdict.facts.append(("time of a step", f"{ratio:.2g} times that of "
                          "Verlet, both by plain loops on grid1"))
