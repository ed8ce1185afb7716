"""Orders of convergence, from runs with n, 2n, 4n, ... steps."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

Vector = list[float]
Point = tuple[int, float, float]    # steps, calls a step, error
FLOOR = 2e-13       # relative; round-off adds up with the steps
COARSE = 0.1        # relative: larger errors are ignored
STRAIGHT = 0.15     # slopes that differ by less belong to one range


@dataclass
class Order:
    """An order of convergence, fitted to the errors of runs."""
    points: list[Point]
    order: float = math.nan     # the slope at the finest steps
    first: int = 0          # its range, in points
    last: int = 0
    coarser: float = math.nan   # a higher order that ends above round-off
    ends: float = 0         # the error at which that one ends

    @property
    def whole(self) -> int | None:
        """The order as a whole number, or None."""
        near = round(self.order) if self.order == self.order else None
        return near if near is not None and abs(self.order - near) < 0.3 \
            else None


def fit(points: list[Point], scale: float = 1.0) -> Order:
    """The slope of the finest range above round-off in which it is
    straight."""
    found = Order([p for p in points if math.isfinite(p[2])])
    good = [k for k, (n, _, e) in enumerate(found.points)
            if FLOOR * scale * (1 + math.sqrt(n) / 30) < e < COARSE * scale]
    slopes = {}
    for k, following in zip(good, good[1:]):
        if following == k + 1:
            (n0, _, e0), (n1, _, e1) = found.points[k], found.points[k + 1]
            slopes[k] = math.log(e0 / e1) / math.log(n1 / n0)
    if not slopes:
        return found
    last = max(slopes)
    # The last one may touch round-off: it counts if the one before agrees.
    if (last - 1 in slopes and found.points[last + 1][2] < 30 * FLOOR * scale
            and slopes[last] < slopes[last - 1] - STRAIGHT):
        last -= 1
    found.order, found.last, first = slopes[last], last + 1, last
    while first - 1 in slopes and abs(
            slopes[first - 1] - slopes[last]) < STRAIGHT:
        first -= 1
    found.first = first
    steep = [k for k in slopes if k < first and slopes[k] > found.order + 0.7
             and (k + 1 not in slopes or slopes[k + 1] <= slopes[k] + 0.2)]
    steep = [k for k in steep if k - 1 in steep or k + 1 in steep]
    if steep and found.points[last + 1][2] > 1e3 * FLOOR * scale:
        found.coarser = sorted(slopes[k] for k in steep)[len(steep) // 2]
        found.ends = found.points[max(steep) + 1][2]
    return found


# ---- Exact solutions of the problems of probe.cpp

def chain(t: float) -> Vector:
    """Eight masses of 0.25 kg, K = 1 N/m, between two walls."""
    x = []
    for j in range(10):
        u = 0.0
        for k, amplitude in ((1, .2), (3, .1)):
            omega = 2 * math.sqrt(1 / .25) * math.sin(k * math.pi / 18)
            u += (amplitude * math.sin(k * math.pi * j / 9)
                  * math.cos(omega * t))
        x += [j + .5 + u, .5, 0]
    return x


def kepler(t: float, e: float = 0.3) -> Vector:
    """An orbit of period 2 pi, from its nearest point on."""
    E = t
    for _ in range(60):
        E -= (E - e * math.sin(E) - t) / (1 - e * math.cos(E))
    return [math.cos(E) - e, math.sqrt(1 - e * e) * math.sin(E), 0]


def driven(t: float, t0: float = .4, x0: float = .5, v0: float = .6,
           omega: float = 2, a: float = 1.5, rate: float = 3) -> Vector:
    """x'' = -omega^2 x + a cos(rate t)"""
    def forced(s):
        return a / (omega ** 2 - rate ** 2) * math.cos(rate * s)

    def speed(s):
        return -rate * a / (omega ** 2 - rate ** 2) * math.sin(rate * s)
    s, x, v = t - t0, x0 - forced(t0), v0 - speed(t0)
    return [0, 0, 0, forced(t) + x * math.cos(omega * s)
            + v / omega * math.sin(omega * s), 0, 0]


def drag(t: float, x0: float = .5, v0: float = .6, omega: float = 2,
         gamma: float = .7) -> Vector:
    root = cmath.sqrt(gamma ** 2 / 4 - omega ** 2)
    r, s = -gamma / 2 + root, -gamma / 2 - root
    A = (v0 - s * x0) / (r - s)
    return [0, 0, 0, (A * cmath.exp(r * t)
                      + (x0 - A) * cmath.exp(s * t)).real, 0, 0]


# Solution, and its time [s] at the end of a run.
END: dict[str, tuple[Callable[[float], Vector], float]] = {
    "chain": (chain, 2.3), "kepler": (kepler, 3), "driven": (driven, 2.4),
    "drag": (drag, 2)}
SMOOTH = ("chain", "kepler", "driven")
ABOUT = {"chain": "eight masses between two walls",
         "kepler": "a planet, eccentricity 0.3",
         "driven": "an oscillator and a force that depends on time",
         "drag": "an oscillator with drag in the force"}


def rms(x: Vector, y: Vector) -> float:
    """RMS distance of points, as lists of coordinates."""
    total = sum((a - b) * (a - b) for a, b in zip(x, y))
    return math.sqrt(total / (len(x) / 3)) if math.isfinite(total) else math.inf


def measured(rows: list[Vector], name: str) -> Order:
    """The Order of a problem; rows: steps, calls, positions."""
    solution, end = END[name]
    exact = solution(end)
    return fit([(int(n), calls / n, rms(x, exact)) for n, calls, *x in rows])


def by_differences(rows: list[Vector]) -> Order:
    """The Order without an exact solution: the error of a run is its distance
    from the next one, which has half the step."""
    return fit([(int(n), calls / n, rms(x, y)) for (n, calls, *x), (_, _, *y)
                in zip(rows, rows[1:])])


# ---- The charts' problems with an exact solution: lab/charts/Problems.cpp

def chart_chain(t: float = .8, n: int = 20, K: float = 100) -> Vector:
    x = []
    for j in range(n + 2):
        p = j / (n + 1)
        if 0 < j <= n:
            for k, amplitude in ((1, .02), (2, .01), (5, .005)):
                omega = 2 * math.sqrt(K * n) * math.sin(
                    k * math.pi / (n + 1) / 2)
                p += (amplitude * math.sin(k * math.pi / (n + 1) * j)
                      * math.cos(omega * t))
        x += [p, 0, 0]
    return x


def chart_curtain(t: float = 1, n: int = 16, K: float = 100) -> Vector:
    m, width = 1 / n ** 2, 1 / (n - 1)
    hangs = [0.0]
    for j in range(1, n):
        hangs.append(hangs[-1] + (n - j) * m * 9.81 / K)
    z = [-j * width - hangs[j] for j in range(n)]
    for k in range(1, n):
        angle = (2 * k - 1) * math.pi / (2 * n - 1)
        amplitude = sum(4 / (2 * n - 1) * hangs[j] * math.sin(angle * j)
                        for j in range(1, n))
        omega = 2 * math.sqrt(K / m) * math.sin(angle / 2)
        for j in range(1, n):
            z[j] += amplitude * math.sin(angle * j) * math.cos(omega * t)
    return [x for i in range(n) for j in range(n)
            for x in (i * width, 0, z[j])]
