"""What is wrong with a step, from its table and the order of its calls.

Each fault is (its sentence, what to do about it). The first one is what a
teacher would say first: a later one may follow from it.
"""

import math

from table import Event, Runs, Table, near
from workshop import BadInput, Lines

Faults = list[tuple[str, str]]

NUMBERS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh",
           "eighth", "ninth", "tenth", "eleventh", "twelfth")
FULL, HALF = .25, .125      # the steps of the trace
NEVER_ASKS = ("it never asks for the force", "Call force(n, t) for each node "
              "and add dt/m times it to the velocity.")
IGNORES_DT = (
    "it ignores dt: two steps whose dt differ by 1 % end at the same place",
    "Advance by dt, whatever it is: fixed substeps of h are right only where "
    "dt is a multiple of h.")
CUTS_DT = (
    f"it cuts dt: a step of {HALF} s and one that is longer by 1 % end at the "
    "same place", "Advance by dt, whatever it is: who calls the step has to "
    "know how far it went.")
SINGLE = ("it computes in single precision, with errors of about 1e-7",
          "Use double, not float.")
LOOKS = ("it looks at the springs itself, beside the forces: an implicit or "
         "position-based step")
FRACTIONS = {(p / q): f"{p}/{q}" for q in (8, 6, 4, 3, 2) for p in range(1, q)}


def ordinal(k: int) -> str:
    return NUMBERS[k] if k < len(NUMBERS) else f"{k + 1}th"


def digits(x: float) -> str:
    for value, text in FRACTIONS.items():
        if near(abs(x), value):
            return ("-" if x < 0 else "") + text
    return f"{x:.6g}"


def bad_input(where: str, runs: Runs, lines: Lines) -> None:
    """BadInput if the step can't be measured at all."""
    for what, numbers in lines:
        if what == "nodes" and numbers[0] != 3:
            raise BadInput(f"{where}: changes the number of nodes from 3 to "
                           f"{numbers[0]:.0f}; only the constraint may remove")
    for (h, _), events in runs.items():
        for e in events:
            if e.what == "call" and not -1 <= (e.time - 3) / h <= 2:
                raise BadInput(
                    f"{where}: calls the force with t = {e.time:.6g} in a "
                    f"step from 3 to {3 + h:g}, expected a time of the step")
            if any(x != x or abs(x) > 1e100 for pair in e.x + e.v
                   for x in pair):
                raise BadInput(f"{where}: writes NaN or infinity in a step "
                               "with finite forces")


def loops(events: list[Event]) -> Faults:
    """Are all masses at one stage when a force is asked for?"""
    for e in events:
        if e.what == "call" and any(
                not near(e.x[i][0], e.x[0][0]) for i in (1, 2)):
            return [(
                f"it moves nodes one by one: when the force on node {e.node} "
                "is computed, some nodes have moved and others have not",
                "Use two loops: first move all nodes, then compute the "
                "forces; a force depends on the neighbors' positions.")]
    return []


def counts(events: list[Event]) -> Faults:
    asked = [sum(e.what == "call" and e.node == i for e in events)
             for i in range(3)]
    if len(set(asked)) > 1:
        return [("it asks for "
                 + " and ".join(f"{n} force{'s' * (n != 1)} on node {i}"
                                for i, n in enumerate(asked)),
                 "Each loop has to run over all nodes.")]
    return [] if asked[0] else [NEVER_ASKS]


def beside(reads: list[list[float]], calls: int, half_calls: int) -> str:
    """What a step is that does not follow from the forces it asks for. reads:
    states after a step of two nodes that fly apart, with a soft spring, with a
    stiff one, with none. Calls of the force: of a step and of half of it."""
    soft, stiff, none = reads
    if soft != stiff:
        return LOOKS
    if soft[9] < none[9]:   # the speed of the second
        return ("it brakes nodes along the springs itself, beside the forces: "
                "dashpots of its own")
    if soft != none:
        return "it looks at the springs itself, beside the forces"
    if calls != half_calls:
        return (f"it makes substeps: it asks for {calls} forces in a step of "
                f"{FULL} s, for {half_calls} in one of {HALF} s")
    return "it is no fixed sum of the forces that it asks for"


def springs(rows: list[list[float]]) -> tuple[str, Faults, list[str]] | None:
    """(what it is, faults, notes) of a step that moves the ends of springs
    itself, whether in one go or so that a larger K moves them by less than
    in proportion; else None. rows: those of same() in probe.cpp."""
    soft, stiff, short, shortest, longer = rows
    if max(abs(soft[2]), abs(soft[3])) < 1e-12 or (
            abs(stiff[2] - 4 * soft[2]) < 1e-3 * abs(stiff[2])):
        return None
    found, notes = [], []
    words = LOOKS
    if abs(shortest[2]) > .1 * abs(stiff[2]):
        ratio = (1 + shortest[3] - shortest[2]) / .7
        words = ("it is position-based: it moves the ends of each spring " + (
            f"itself, to {ratio:.3g} times its rest length, if it is longer"
            if abs(longer[2]) < 1e-9 else "to its rest length itself"
            if ratio < 1.001 else "towards its rest length itself"))
        if near(short[2], shortest[2]):
            words += ", whatever K is"
        notes.append(
            "it asks for the force, which has the springs, too: they act "
            "twice, unless the step subtracts them" if soft[5] else
            "it never asks for the force: gravity and drag of the scene do "
            "not act" + ("" if soft[4] == 0 else
                         ", it has a gravity of its own: a step of "
                         f"{soft[0]} s moves a node at rest by "
                         f"{soft[4]:.3g} m"))
    if near(soft[2], -soft[3]):
        found.append((
            "masses are ignored: both ends of a spring move by the same "
            "length, whatever their masses",
            "Move the ends by w1/(w1 + w2) and w2/(w1 + w2) of the way, w = "
            "1/m: so the momentum is kept."))
    return words, found, notes


def masses(one: Table, two: Table) -> Faults:
    """Tables of mass 1 and of mass 2, each times its mass."""
    pairs = [("the velocity", one.b, two.b), ("the position", one.B, two.B)]
    for what, b1, b2 in pairs:
        for j, (x, y) in enumerate(zip(b1, b2)):
            if near(x, y):
                continue
            kick = (f"the {ordinal(j)} force" if one.stages > 1
                    else "the force")
            if any(near(x, k) for k in (3, 7)) and any(
                    near(y, k / 3) for k in (1, 7)):
                return [(f"{what} gets the force on another node",
                         "Call force(n, t) with the node that moves.")]
            if near(y, 2 * x) and near(sum(b1), 1):
                return [("the force is divided by the mass of another node",
                         "Divide by the mass of the node that moves: a = "
                         "force(n, t) / n.value().mass.")]
            if near(y, 2 * x):
                return [(f"the mass is forgotten: {what} gets {kick} itself, "
                         "in place of force/mass",
                         "Divide the force by n.value().mass: a = F/m.")]
            if near(2 * y, x):
                return [(f"{kick} is divided by the mass twice",
                         "Divide the force by n.value().mass once: a = F/m.")]
            return [(f"what {kick} adds to {what} is not in proportion to "
                     "1/mass", "Newton: a = F/m, for each node its own m.")]
    return []


def steps(full: Table, half: Table) -> Faults:
    """Tables of steps 1/4 and 1/8: all coefficients should be the same."""
    def ratio(x, y):
        return x / y if abs(y) > 1e-9 else 1
    for what, x, y, power in (("the drift", full.C, half.C, 1),
                              ("the kick", sum(full.b), sum(half.b), 1),
                              ("the force's part of the position",
                               sum(full.B), sum(half.B), 2)):
        r = ratio(x, y)
        if near(r, 1):
            continue
        if near(r, 2) or near(r, 4):
            return [(f"dt enters {what} {power + round(r / 2)} times, "
                     f"expected {'once' if power == 1 else 'twice'}",
                     "Look at the units: x += dt v, v += dt F/m.")]
        if near(r, .5):
            return [(f"dt is forgotten in {what}",
                     "Look at the units: x += dt v, v += dt F/m.")]
        return [(f"{what} is not in proportion to dt",
                 "Look at the units: x += dt v, v += dt F/m.")]
    return []


def own_force(lines: Lines) -> Faults:
    """Is there a force of the step's own, or one along y alone?"""
    for h, impulse, y, z in (row for what, row in lines if what == "along"):
        if impulse < 0 and max(abs(y), abs(z)) > 1e-12:
            return [(f"without any force a step accelerates nodes by "
                     f"{max(y, z, key=abs) / h:.4g} m/s^2",
                     "Leave all forces to force(n, t), also gravity.")]
        if impulse >= 0 and not near(y, z):
            return [("a force along z does not move a node as one along y "
                     f"does: after a step the velocities are {z:.4g} and "
                     f"{y:.4g} m/s", "Use the whole Point: v += dt/m F.")]
    return []


def own_drag(t: Table, half: Table) -> Faults:
    """Does the step change the velocity without any force? Tables of steps 1/4
    and 1/8."""
    if near(t.V, 1):
        return []
    if abs(t.V) > 1:
        return [(f"without any force a step of {FULL} s multiplies the "
                 f"velocity by {t.V:.4g}: a drag of the wrong sign, which "
                 "adds energy",
                 "An implicit drag divides by (1 + dt c/m); better leave "
                 "drag to the force.")]
    if near(t.V, 0):
        return [("it forgets the velocity: without any force v becomes 0",
                 "v += dt F/m, not v = dt F/m.")]
    if near(t.V, half.V):
        return [(f"each step multiplies the velocity by {t.V:.4g}, however "
                 "long it is: it has a drag of its own by a factor per step, "
                 "so twice as many steps brake twice as much",
                 "Leave drag to the force; or make it a factor per second: "
                 "v *= exp(-dt c/m).")]
    words = ""
    if near(t.V, half.V ** 2):
        words = f", a factor per second: exp({math.log(t.V) / FULL:.4g} dt)"
    elif near(1 - t.V, 2 - 2 * half.V):
        words = f", a factor per second: 1 - {(1 - t.V) / FULL:.4g} dt"
    return [(f"without any force a step of {FULL} s multiplies the velocity "
             f"by {t.V:.4g}: the step has a drag of its own{words}",
             "Leave drag to the force, or to a function of its own: a step "
             "should do nothing that the forces do not say.")]


def times(t: Table, order_one: bool) -> tuple[Faults, list[str]]:
    """(faults, notes) on the times at which forces are asked for."""
    for s, (tau, c) in enumerate(zip(t.tau, t.c)):
        if near(tau, c):
            continue
        which = f"the {ordinal(s)} force" if t.stages > 1 else "the force"
        names = {0: "t", .5: "t + dt/2", 1: "t + dt"}
        got = names.get(round(tau, 9), f"t + {tau:.4g} dt")
        due = names.get(round(c, 9), f"t + {c:.4g} dt")
        words = (f"{which} is asked for at time {got}, but the positions are "
                 f"those of {due}")
        if order_one:
            return [], [words + ": as in the assignment; of order 1 both are"]
        return [(words, f"Call force(n, {due}) there: a force that depends on "
                 "time lowers the order otherwise.")], []
    return [], []


def constraint(runs: Runs, h: float = FULL) -> tuple[Faults, list[str]]:
    """(faults, notes) on where the constraint is applied."""
    events = runs[h, -1]
    holds = [e for e in events if e.what == "hold"]
    if not holds:
        return [("the constraint is never called", "Call constraint(g, t + "
                 "dt) when all positions have moved.")], []
    start = events[0]
    impulses = [run for (step, j), run in runs.items() if step == h]

    def at_end(k):
        """Are positions at event k, in all runs, those of the end?"""
        return all(len(run) > k and all(
            near(p, q) for x, y in zip(run[k].x, run[-1].x)
            for p, q in zip(x, y)) for run in impulses)
    last = max(k for k, e in enumerate(events) if e.what == "hold")
    notes: list[str] = []
    if not at_end(last):
        first = all(near(e.x[0][0], start.x[0][0]) for e in holds)
        return [("the constraint is applied before the positions move"
                 + ("" if first else " for the last time")
                 + ": a node may end a step inside of an obstacle",
                 "Call the constraint after the last change of positions, "
                 "before the force there.")], notes
    calls = [k for k, e in enumerate(events) if e.what == "call"]
    firsts = [k for k, e in enumerate(events)
              if e.what == "hold" and at_end(k)]
    early = [k for k in calls if k < firsts[0] and at_end(k)
             and not near(events[k].x[0][0], start.x[0][0])]
    if early:
        return [("the constraint comes after the velocities: the force at the "
                 "new positions sees nodes that violate it",
                 "Order: move, constrain, then compute the force.")], notes
    tau = (holds[-1].time - start.time) / h
    if near(tau, 0):
        notes.append("the constraint gets the time t, as in the assignment, "
                     "at positions of t + dt: pins that move lag one step")
    elif not near(tau, 1):
        return [(f"the constraint at the end of a step gets the time t + "
                 f"{tau:.4g} dt", "Call constraint(g, t + dt).")], notes
    return [], notes


def returned(runs: Runs) -> Faults:
    end = runs[FULL, -1][-1].time
    return [] if near(end, 3 + FULL) else [(
        f"it returns {end:.6g} after a step from 3 to {3 + FULL:g}",
        "return t + dt;")]


def differences(t: Table, other: Table) -> tuple[list, list]:
    """Two lists of (words, ours, the other's): coefficients that stand in the
    code, and those that follow from them."""
    read: list[tuple] = []
    follows: list[tuple] = []
    found = read

    def compare(words, x, y):
        if not near(x, y):
            found.append((words, x, y))
    n = range(t.stages)
    for j in n:
        compare(f"weight of the {ordinal(j)} force", t.b[j], other.b[j])
    for s in n:
        compare(f"place of the {ordinal(s)} force, in dt v", t.c[s],
                other.c[s])
        for j in range(s):
            compare(f"share of the {ordinal(j)} force in the velocity at the "
                    f"{ordinal(s)}", t.w[s][j], other.w[s][j])
    compare("drift of the step", t.C, other.C)
    found = follows
    for s in n:
        for j in range(s):
            compare(f"share of the {ordinal(j)} force in the place of the "
                    f"{ordinal(s)}", t.a[s][j], other.a[s][j])
    for j in n:
        compare(f"share of the {ordinal(j)} force in the new position",
                t.B[j], other.B[j])
    return read, follows


def nearest(ours: tuple[Table, Table],
            methods: dict[str, Table]) -> tuple | None:
    """The known method closest to one of the tables, or None: (is a difference
    large, number of differences, name, differences, stages)."""
    best = None
    for t in ours:
        for name, other in methods.items():
            if other.stages == t.stages > 1:
                read, follows = differences(t, other)
                found = read or follows
                far = max((abs(x - y) for _, x, y in found), default=0)
                # One that follows from others counts half.
                key = (far > .02, (len(read) + len(follows) / 2) / t.stages,
                       name, found, t.stages)
                if best is None or key[:2] < best[:2]:
                    best = key
    return best


def small(close: tuple | None) -> Faults:
    """A known method with one slightly wrong coefficient?"""
    if not close or close[0] or not close[3]:
        return []
    _, _, name, ((what, own, right), *_), _ = close
    return [(f"it is {name} with a wrong coefficient: the {what} is "
             f"{own:.8g}, in {name} {right:.8g}",
             f"Copy the coefficients of {name} again, with all digits.")]


def few(close: tuple | None) -> Faults:
    """A known method with a few other coefficients?"""
    if not close or not 0 < len(close[3]) <= .75 * close[4]:
        return []
    _, _, name, ((what, own, right), *_), _ = close
    return [(f"it is close to {name}, but the {what} is {digits(own)}, in "
             f"{name} {digits(right)}",
             f"Compare your step with {name}, stage by stage.")]


def velocities(t: Table, methods: dict[str, Table]) -> Faults:
    """Do the positions move as in a known method, and the velocities not?"""
    for name, other in methods.items():
        if other.stages == t.stages > 1 and all(map(near, [
                *t.c, *sum(t.a, []), *t.B, t.C], [
                *other.c, *sum(other.a, []), *other.B, other.C])):
            own, right = (" and ".join(map(digits, x)) for x in (t.b, other.b))
            return [(f"the positions move as in {name}, but the weights of "
                     f"the forces in the velocity are {own}, in {name} "
                     f"{right}", "Use the same weights as there.")]
    return []


def sums(t: Table) -> Faults:
    total = sum(t.b)
    if near(t.C, 0):
        return [("the positions do not move with the velocities",
                 "x += dt v, for all nodes.")]
    if near(total, .5):
        return [("half a kick is forgotten: the velocities get dt/2 times "
                 "F/m in a step, expected dt",
                 "A kick of dt/2 before the drift needs another one after "
                 "it.")]
    if near(total, -1):
        return [("the force has the wrong sign", "v += dt F/m.")]
    if not near(total, 1):
        return [(f"the kicks of a step add up to {digits(total)} dt, "
                 "expected dt", "The weights of the forces have to add up "
                 "to 1.")]
    if not near(t.C, 1):
        return [(f"the drifts of a step add up to {digits(t.C)} dt, expected "
                 "dt", "The weights of the velocities have to add up to 1.")]
    return []


def position(t: Table) -> Faults:
    B = sum(t.B)
    if t.stages > 1 and not near(B, .5):
        return [(f"the forces move the positions by {digits(B)} dt^2 F/m, "
                 "expected 1/2: of order 1 whatever the rest",
                 "A symmetric sequence of kicks and drifts has 1/2.")]
    return []


def at_start(t: Table) -> Faults:
    """Are all forces computed at the start?"""
    if t.stages > 1 and all(near(c, 0) for c in t.c) and all(
            near(x, 0) for x in sum(t.a, [])):
        return [("all forces are computed at the old positions",
                 "Move the nodes before you compute the next force.")]
    return []


def coefficients(raw: Table, t: Table, methods: dict[str, Table]) -> Faults:
    """What is wrong with the coefficients of a step that equals no known
    method."""
    close = nearest((raw, t), methods)
    return (at_start(t) or small(close) or sums(t)
            or velocities(t, methods) or few(close) or position(t))


def second_order(t: Table) -> bool:
    """Does it meet the conditions of order 2 for one mass and forces that
    depend on positions?"""
    return (near(sum(t.b), 1) and near(sum(t.B), .5) and
            near(sum(b * c for b, c in zip(t.b, t.c)), .5))
