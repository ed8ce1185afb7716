"""A step as a table of coefficients, read from what it does with known forces.

Three free masses with velocity 1 along x; the force is 0, or FORCES along y
and z at one of the calls. So an explicit step shows where it evaluates
each force j and how it uses it:
    X_s = x + c_s h v + h^2 sum a_sj f_j/m      V_s = v + h sum w_sj f_j/m
    x_1 = x + C h v + h^2 sum B_j f_j/m         v_1 = V v + h sum b_j f_j/m
and tau_s, the time of call s, in steps.
"""

import re
from dataclasses import dataclass, field

from workshop import ROOT, Lines

Vector = list[float]
EXACT = 1e-11       # round-off of a coefficient
FORCES = (1, 3, 7)  # on the three masses [N]


@dataclass
class Table:
    tau: Vector = field(default_factory=list)
    c: Vector = field(default_factory=list)
    a: list[Vector] = field(default_factory=list)      # rows
    w: list[Vector] = field(default_factory=list)
    b: Vector = field(default_factory=list)
    B: Vector = field(default_factory=list)
    C: float = 1
    V: float = 1

    @property
    def stages(self) -> int:
        return len(self.c)

    def numbers(self) -> Vector:
        """All coefficients but the times."""
        return [*self.c, *sum(self.a, []), *self.b, *self.B, self.C, self.V]

    def row(self) -> Vector:
        """All numbers, as Agree.hpp reads them."""
        return [self.stages, *self.tau, *self.c, *self.b, *self.B,
                *sum(self.a, []), *sum(self.w, []), self.C, self.V]

    def reuses(self) -> bool:
        """Is the last force of a step the first of the next one?"""
        return (self.stages > 1 and near(self.c[0], 0) and near(self.c[-1], 1)
                and all(near(x, 0) for x in self.a[0])
                and all(near(x, y) for x, y in zip(self.a[-1], self.B)))


def near(x: float, y: float, tolerance: float = EXACT) -> bool:
    return abs(x - y) <= tolerance * max(1, abs(x), abs(y))


def same(one: Table, other: Table, tolerance: float = EXACT) -> bool:
    """Equal, but for the times of the calls?"""
    return one.stages == other.stages and all(
        near(x, y, tolerance)
        for x, y in zip(one.numbers(), other.numbers()))


# ---- Known methods

def splitting(parts: list[tuple[str, float]]) -> Table:
    """[("drift" or "kick", coefficient)]"""
    t, kicks = Table(), [k for kind, k in parts if kind == "kick"]
    n = len(kicks)
    at, moved, done = 0.0, [0.0] * n, [0.0] * n
    for kind, k in parts:
        if kind == "drift":
            at += k
            moved = [x + k * v for x, v in zip(moved, done)]
        else:
            t.tau.append(at)
            t.c.append(at)
            t.a.append(list(moved))
            t.w.append(list(done))
            done[len(t.c) - 1] += k
    t.b, t.B, t.C = done, moved, at
    return t


def runge_kutta(A: list[Vector], b: Vector) -> Table:
    n = len(b)
    A = [[*row, *[0.0] * (n - len(row))] for row in A]
    c = [sum(row) for row in A]
    square = [[sum(A[i][k] * A[k][j] for k in range(n)) for j in range(n)]
              for i in range(n)]
    return Table(list(c), c, square, A, list(b),
                 [sum(b[i] * A[i][j] for i in range(n)) for j in range(n)])


def nystroem(c: Vector, a: list[Vector], b: Vector, B: Vector) -> Table:
    n = len(c)
    full = [[*row, *[0.0] * (n - len(row))] for row in a]
    return Table(list(c), list(c), full, full, list(b), list(B))


def alternate(first: str, coefficients: Vector) -> Table:
    kinds = ("drift", "kick") if first == "drift" else ("kick", "drift")
    return splitting([(kinds[k % 2], x) for k, x in enumerate(coefficients)])


def mirrored(half: Vector) -> Vector:
    return [*half, *half[-2::-1]]


def plain_splittings() -> dict[str, Table]:
    """{name: table} of each NAME_parts in methods.hpp."""
    found = {}
    for name, body, kicks in re.findall(
            r"array (\w+)_parts = \[\] {(.*?)\n}.*?\1_parts, (\w+)",
            (ROOT / "methods.hpp").read_text("utf-8"), re.S):
        body, numbers = body.replace("lambda", "lam"), dict[str, float]()
        for one, value in re.findall(r"(\w+) = ([^,;]+)", body):
            numbers[one] = eval(value, {}, numbers)
        found[name] = alternate("kick" if kicks == "true" else "drift", eval(
            "[" + body.split("{")[1].split("}")[0] + "]", {}, numbers))
    return found


def known() -> dict[str, Table]:
    """{name: table}"""
    theta = 1 / (2 - 2 ** (1 / 3))
    yoshida = mirrored([theta / 2, theta, (1 - theta) / 2, 1 - 2 * theta])
    third = [7 / 24, 2 / 3, 3 / 4, -2 / 3, -1 / 24, 1]
    dp: list[Vector] = [
        [], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656]]
    return {
        "forward Euler": runge_kutta([[]], [1.0]),
        "symplectic Euler": alternate("drift", [1.0, 1.0]),
        "symplectic Euler, velocities first": alternate("kick", [1.0, 1.0]),
        "Verlet": alternate("kick", [.5, 1.0, .5]),
        "Verlet, positions first": alternate("drift", [.5, 1.0, .5]),
        "a Taylor step, x + h v + h^2 a/2 and v + h a":
            nystroem([0.0], [[]], [1.0], [.5]),
        "the midpoint rule": runge_kutta([[], [.5]], [0.0, 1.0]),
        "Heun's method": runge_kutta([[], [1.0]], [.5, .5]),
        "Ralston's method": runge_kutta([[], [2 / 3]], [.25, .75]),
        "Kutta's method of order 3": runge_kutta(
            [[], [.5], [-1.0, 2.0]], [1 / 6, 2 / 3, 1 / 6]),
        "RK4": runge_kutta([[], [.5], [0, .5], [0, 0, 1.0]],
                           [1 / 6, 1 / 3, 1 / 3, 1 / 6]),
        "the 3/8 rule": runge_kutta(
            [[], [1 / 3], [-1 / 3, 1.0], [1.0, -1.0, 1.0]],
            [1 / 8, 3 / 8, 3 / 8, 1 / 8]),
        "Nystroem's method of order 4": nystroem(
            [0.0, .5, 1.0], [[], [1 / 8], [0, .5]],
            [1 / 6, 2 / 3, 1 / 6], [1 / 6, 1 / 3, 0.0]),
        "Dormand-Prince": runge_kutta(
            dp, [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]),
        "Ruth's method of order 3": alternate("kick", third),
        "Yoshida 4": alternate("kick", yoshida),
        "Yoshida 4, positions first": alternate("drift", yoshida),
        **plain_splittings(),
    }


def repeated() -> dict[str, Table]:
    """{name: table} of steps that consist of shorter steps of a method."""
    steps = {}
    for k in (2, 3, 4):
        each = f", {k} steps of dt/{k}"
        steps["symplectic Euler" + each] = alternate("drift", [1 / k] * 2 * k)
        steps["symplectic Euler, velocities first" + each] = alternate(
            "kick", [1 / k] * 2 * k)
        steps["Verlet" + each] = alternate(
            "kick", [.5 / k, *[1 / k] * (2 * k - 1), .5 / k])
    return steps


def merged(table: Table) -> Table:
    """The table with calls at the same place and time merged into one."""
    groups: list[list[int]] = []
    for s in range(table.stages):
        twin = next((g for g in groups if near(table.c[g[0]], table.c[s])
                     and all(near(x, y) for x, y in zip(
                         table.a[g[0]], table.a[s]))
                     and near(table.tau[g[0]], table.tau[s])), None)
        if twin:
            twin.append(s)
        else:
            groups.append([s])

    def folded(row):
        return [sum(row[s] for s in g) for g in groups]
    first = [g[0] for g in groups]
    return Table([table.tau[s] for s in first], [table.c[s] for s in first],
                 [folded(table.a[s]) for s in first],
                 [folded(table.w[s]) for s in first],
                 folded(table.b), folded(table.B), table.C, table.V)


def pruned(table: Table) -> Table:
    """The table without forces that nothing depends on."""
    keep = [j for j in range(table.stages) if not (
        near(table.b[j], 0) and near(table.B[j], 0)
        and all(near(row[j], 0) for row in table.a))]

    def of(row):
        return [row[j] for j in keep]
    return Table(of(table.tau), of(table.c), [of(table.a[s]) for s in keep],
                 [of(table.w[s]) for s in keep], of(table.b), of(table.B),
                 table.C, table.V)


# ---- Reading the trace

@dataclass
class Event:
    what: str       # begin, call, hold, end
    node: int
    time: float
    x: list         # (along v, along the force) of the three masses
    v: list


Runs = dict[tuple[float, int], list[Event]]     # by step and impulse


def events(trace: Lines) -> Runs:
    """{(h, impulse): events in their order}; from lines in their order."""
    found: Runs = {}
    for what, numbers in trace:
        h, impulse, node, time, *rest = numbers
        x = [(rest[4 * i], rest[4 * i + 1]) for i in range(len(rest) // 4)]
        v = [(rest[4 * i + 2], rest[4 * i + 3]) for i in range(len(rest) // 4)]
        found.setdefault((h, int(impulse)), []).append(
            Event(what, int(node), time, x, v))
    return found


def read(runs: Runs, h: float, node: int) -> Table | None:
    """The table of one of the masses, at a step h."""
    mass = 2.0 ** (node - 1) / FORCES[node]
    base = runs[h, -1]
    calls = [e for e in base if e.what == "call" and e.node == node]
    n = len(calls)
    t = Table([(e.time - base[0].time) / h for e in calls],
              [e.x[node][0] / h for e in calls])
    t.a = [[0.0] * n for _ in range(n)]
    t.w = [[0.0] * n for _ in range(n)]
    t.b, t.B = [0.0] * n, [0.0] * n
    t.C, t.V = base[-1].x[node][0] / h, base[-1].v[node][0]
    for j in range(n):
        run = runs.get((h, j))
        if not run:
            return None
        own = [e for e in run if e.what == "call" and e.node == node]
        if len(own) != n:
            return None
        for s, e in enumerate(own):
            t.a[s][j] = mass * e.x[node][1] / h ** 2
            t.w[s][j] = mass * e.v[node][1] / h
        t.B[j] = mass * run[-1].x[node][1] / h ** 2
        t.b[j] = mass * run[-1].v[node][1] / h
    return t
