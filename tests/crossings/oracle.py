"""The truth about a scene, by NumPy and SciPy alone. Formulas: lab/scenes'
README. Smooth motion is integrated by DOP853; contact and tearing by a
symplectic rule, in plain loops, with two steps that show how far it converged.
Lengths in m, times in s, masses in kg."""
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.linalg import norm
from scipy.integrate import solve_ivp
from scipy.linalg import eigvalsh

np.seterr(over="ignore", invalid="ignore")  # what explodes has no truth
Scene = dict[str, Any]
Array = np.ndarray
G = 9.81
# The largest dt omega [1] of a method without drag; no entry: any step.
LIMIT = {"symplectic-euler": 2, "verlet": 2, "rk4": 2.8284, "pefrl": 2.989,
         "srkn11b": 9.07, "forward-euler": 0}
CONTACT = ("plane", "sphere", "tear", "tear-strain", "self-collision")
# The usual words of parts, and how a part rests.
USUAL: dict[str, Scene] = {
    "sheet": {"at": (0., 0., 0.), "u": (1., 0., 0.), "v": (0., 1., 0.)},
    "plane": {"at": (0., 0., -.75)}, "pin": {},
    "sphere": {"at": (.5, .5, -.5), "radius": .15},
    "tear": {"at": (.5, .5, -.5), "radius": .15}}
RESTS = {"velocity": (0, 0, 0), "turn": (0, 0, 0), "about": (0, 0, 0),
         "until": np.inf, "normal": (0, 0, 1), "friction": 0}


def parts(s: Scene, field: str) -> list[Scene]:
    """Parts of a scene with each word; vectors as arrays."""
    return [{w: np.array(a, float) if isinstance(a, tuple) else a
             for w, a in (RESTS | USUAL[field] | p).items()}
            for p in s.get(field, [])]


def grid(n: int, m: int) -> tuple[list, list]:
    """Unit points of n x m nodes, and their quads, corners listed around."""
    points = [(i / max(n - 1, 1), j / max(m - 1, 1))
              for i in range(n) for j in range(m)]
    faces = [[i * m + j, i * m + j + 1, (i + 1) * m + j + 1, (i + 1) * m + j]
             for i in range(n - 1) for j in range(m - 1)]
    return points, faces


def gravity(a: Any) -> Array:
    """The acceleration of a vector or of a number, which acts down."""
    a = np.atleast_1d(a)
    return a if len(a) == 3 else np.array([0, 0, -abs(a[0])])


def turned(arm: Array, turn: Array, time: float) -> Array:
    """Rodrigues: arm, turned by the angular velocity in a time."""
    k, a = turn / (norm(turn) or 1), norm(turn) * time
    return (np.cos(a) * arm + np.sin(a) * np.cross(k, arm) +
            (1 - np.cos(a)) * np.outer(arm @ k, k))


def rms(a: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(a * a, axis=1)))) if len(a) else 0.


class Net:
    """Points, springs and what acts on them, of a scene (scenes.py)."""

    def __init__(self, s: Scene):
        self.scene = s
        mesh = s.get("net") or s.get("nodes") or {"points": [], "faces": []}
        x, faces = list(mesh["points"]), list(mesh["faces"])
        v = list(mesh.get("velocities") or [(0, 0, 0)] * len(x))
        listed, masses = list(mesh.get("springs", [])), mesh.get("masses")
        for part in parts(s, "sheet"):
            first, (n, m) = len(x), part["nodes"].astype(int)
            points, quads = grid(n, m)
            x += [part["at"] + p * part["u"] + q * part["v"] for p, q in points]
            v += [part["velocity"]] * len(points)
            faces += [[first + k for k in q] for q in quads]
            if 1 in (n, m):
                listed += [(first + k, first + k + 1, None, None)
                           for k in range(n * m - 1)]
        self.x, self.v = np.array(x, float), np.array(v, float)
        self.n, self.faces = len(x), faces
        self.area = [norm(np.cross(self.x[f[2]] - self.x[f[0]],
                                   self.x[f[-1]] - self.x[f[1]])) / 2
                     for f in faces]
        share = np.zeros(self.n)
        for f, a in zip(faces, self.area):
            share[f] += a / len(f)
        self.m = s["density"] * share if "density" in s else np.array([
            1 / self.n if a is None else a for a in masses or [None] * self.n])
        self.c = (s["drag"] * share if "drag" in s else
                  np.full(self.n, s.get("damping", 0.)))
        self.wind = np.array(s.get("wind", {}).get("velocity", (0, 0, 0)))
        self.g = gravity(s.get("gravity", G))
        self.load = np.zeros((self.n, 3))
        for k, *force in mesh.get("loads", []):
            self.load[k] += force
        self.springs(listed)
        for r in s.get("region", []):
            low, high = np.sort([r["from"], r["to"]], axis=0)
            inside = np.all((self.x > low - 1e-9) & (self.x < high + 1e-9), 1)
            self.m[inside] *= r.get("mass-factor", 1)
            both = inside[self.i] & inside[self.j]
            self.K[both] *= r.get("stiffness-factor", 1)
            self.factor[both] *= r.get("stiffness-factor", 1)
        self.pins = [([k for k, x in enumerate(self.x)
                       if p.get("node", k) == k and all(
                           abs(p.get("xyz"[a], x[a]) - x[a]) < 1e-9
                           for a in range(3))], p) for p in parts(s, "pin")]
        self.pins += [(mesh["held"], RESTS)] if "held" in mesh else []
        self.v[self.held()] = 0
        if "rest" in s:  # where a scene with from-rest begins
            self.x, self.v = np.array(s["rest"])

    def springs(self, listed: list) -> None:
        """The springs of the faces, then those that are listed."""
        s, strips, owned = self.scene, dict[tuple, float](), {}
        kinds = s.get("edges", {"sides": None, "diagonals": None})

        def add(i, j, kind, strip):
            """strip: the area of cloth that the spring stands for [m^2]."""
            key = (min(i, j), max(i, j))
            strips[key] = strips.get(key, 0) + strip
            if kinds[kind] is not None:
                owned[key] = kinds[kind]

        for q, a in zip(self.faces, self.area):
            for k in range(len(q)):
                add(q[k - 1], q[k], "sides", a if len(q) == 3 else a / 2)
            if len(q) == 4 and "diagonals" in kinds:
                add(q[0], q[2], "diagonals", 2 * a)
                add(q[1], q[3], "diagonals", 2 * a)
        springs: dict = {}
        for (i, j), strip in strips.items():
            L = norm(self.x[i] - self.x[j])
            K = (s["modulus"] * strip / L**2 if "modulus" in s else
                 s.get("stiffness", 100.))
            springs[i, j] = (owned.get((i, j), K), L, (i, j) not in owned
                             and "modulus" not in s, 0)
        for i, j, own, L, *way in listed:
            springs[min(i, j), max(i, j)] = (
                s.get("stiffness", 100.) if own is None else own,
                norm(self.x[i] - self.x[j]) if L is None else L, own is None,
                ("cable" in way) - ("strut" in way))
        self.i, self.j = np.array(list(springs), int).reshape(-1, 2).T
        self.K, self.L, free, self.way = np.array(
            list(springs.values())).reshape(-1, 4).T
        self.L = self.L * s.get("rest-length", 1)
        self.free, self.factor = free > 0, np.ones(len(free))
        self.keep(self.L == self.L)

    def keep(self, springs: Array) -> None:
        """Keep these springs alone. C: their incidence with the nodes."""
        for name in ("i", "j", "K", "L", "free", "factor", "way"):
            setattr(self, name, getattr(self, name)[springs])
        node = np.arange(self.n)[:, None]
        self.C = (node == self.i) * 1. - (node == self.j)

    def held(self) -> list[int]:
        return sorted({k for nodes, _ in self.pins for k in nodes})

    def place(self, t: float) -> tuple[list[int], Array, Array]:
        """Positions and velocities of the held nodes; the last pin wins."""
        x, v, ids = self.x.copy(), self.v.copy(), self.held()
        for nodes, p in self.pins:
            velocity, turn, about = (
                np.array(p[w]) for w in ("velocity", "turn", "about"))
            now = min(t, p["until"])
            arm = turned(self.x[nodes] - about, turn, now)
            x[nodes] = about + arm + velocity * now
            v[nodes] = (velocity + np.cross(turn, arm)) * (t < p["until"])
        return ids, x[ids], v[ids]

    def force(self, x: Array, v: Array) -> Array:
        """Forces [N]; of several states, if x has an axis before the nodes."""
        u = x[..., self.j, :] - x[..., self.i, :]
        l = np.maximum(norm(u, axis=-1), 1e-300)
        f = self.C @ ((self.tension(l) / l)[..., None] * u)
        f -= self.c[:, None] * (v - self.wind)
        f += self.m[:, None] * self.g + self.load
        return f

    def tension(self, l: Array) -> Array:
        """Of springs of these lengths [N]; a cable does not push, a strut does
        not pull."""
        return np.where(self.way * (l - self.L) < 0, 0, self.K * (l - self.L))

    def energies(self, x: Array, v: Array) -> dict[str, float]:
        l = norm(x[self.j] - x[self.i], axis=1)
        return {"kinetic": np.sum(self.m * np.sum(v * v, 1)) / 2,
                "elastic": np.sum(self.tension(l) * (l - self.L)) / 2,
                "gravitational": -np.sum(self.m * (x @ self.g)) -
                np.sum(self.load * x)}

    def nearest(self, x: Array, alive: Array) -> float:
        """The least distance of two nodes without a common spring [m]. Where
        such pairs touch there is no truth: the order in which they are pushed
        decides where they end."""
        far = norm(x[:, None] - x, axis=2) + np.where(
            self.C @ self.C.T + np.eye(self.n) == 0, 0, np.inf)
        return far[alive][:, alive].min(initial=np.inf)

    def omega(self) -> float:
        """The largest frequency [1/s] of K on the graph, which bounds those
        of every configuration."""
        free = np.setdiff1d(np.arange(self.n), self.held())
        if len(free) == 0 or len(self.K) == 0:
            return 0.
        C = self.C[free] / np.sqrt(self.m[free, None])
        return np.sqrt(max(0, eigvalsh(C * self.K @ C.T)[-1]))

    def change(self, request: str) -> None:
        """Apply what follows the time in --at."""
        word, *rest = request.split()
        if word == "stiffness":
            self.K[self.free] = float(rest[0]) * self.factor[self.free]
        elif word == "gravity":
            self.g = gravity([float(a) for a in rest])
        elif word == "unpin":
            self.pins = [([k for k in nodes if k != int(rest[0])], p)
                         for nodes, p in self.pins]
        else:  # cut
            i, j = sorted(int(a) for a in rest)
            self.keep(~((self.i == i) & (self.j == j)))

    def pieces(self, t_end: float) -> list[tuple[float, list[str]]]:
        """Times at which something changes, with the changes there."""
        at = [(t, r) for t, r in self.scene.get("at", []) if t < t_end]
        times = {0., t_end, *(t for t, _ in at), *(
            p["until"] for _, p in self.pins if p["until"] < t_end)}
        return [(t, [r for s, r in at if s == t]) for t in sorted(times)]


@dataclass
class End:
    """How a motion ended. alive: the nodes that are left; way: how far it
    moved [m]; internal: its largest internal energy [J]; bar: by how much x
    may err [m], inf in chaos."""
    net: Net
    x: Array
    v: Array
    alive: Array
    way: float
    internal: float
    bar: float = 0.

    @property
    def size(self) -> float:  # of the cloth and of its motion [m]
        return max(np.ptp(self.net.x, axis=0).max(), self.way)


def smooth(scene: Scene, t_end: float) -> End:
    """The motion without contact. A twin that starts 1e-8 of the size away
    shows chaos."""
    net = Net(scene)
    size = np.ptp(net.x, axis=0).max()
    noise = 1e-8 * size * np.random.default_rng(1).standard_normal(net.x.shape)
    x, v = np.stack([net.x, net.x + noise]), np.stack([net.v, net.v])
    way, internal, solved = 1e-9 * size, 0., True
    for (t, requests), (to, _) in itertools.pairwise(net.pieces(t_end)):
        for r in requests:
            net.change(r)
        free = np.setdiff1d(np.arange(net.n), net.held())

        def take(t, y):  # sets the free nodes to y, the held to their place
            x[:, free], v[:, free] = y.reshape(2, 2, len(free), 3)
            ids, px, pv = net.place(t)
            x[:, ids], v[:, ids] = px, pv

        def rate(t, y):
            take(t, y)
            a = net.force(x, v) / net.m[:, None]
            return np.stack([v[:, free], a[:, free]]).ravel()

        out = solve_ivp(rate, (t, to),
                        np.stack([x[:, free], v[:, free]]).ravel(), "DOP853",
                        rtol=1e-11, atol=1e-11 * max(size, 1e-3))
        solved = solved and out.success
        for k in [*range(0, len(out.t), max(1, len(out.t) // 50)), -1]:
            take(out.t[k], out.y[:, k])
            e = net.energies(x[0], v[0])
            internal = max(internal, e["kinetic"] + e["elastic"])
            way = max(way, rms(x[0] - net.x))
    growth = rms(x[1] - x[0]) / (1e-8 * size)
    bar = 1e-10 * size * max(growth, 1) if solved and growth < 1e4 else np.inf
    return End(net, x[0], v[0], np.ones(net.n, bool), way, internal, bar)


def kick(u: Array, out: Array, friction: float) -> Array:
    """The change of a relative velocity u in a contact."""
    inward, along = max(-u @ out, 0), u - (u @ out) * out
    slide = norm(along) or 1
    return inward * out - along * min(friction * inward / slide, 1)


def obstacles(scene: Scene, x: Array, t: float) -> Iterator:
    """Each obstacle: its part, how deep each point is in it [m], the outward
    normals there, and its velocity."""
    for field in ("plane", "sphere"):
        for p in parts(scene, field):
            w = np.array(p["velocity"])
            arm = x - (p["at"] + w * min(t, p["until"]))
            out = arm if field == "sphere" else np.array(p["normal"]) + 0 * x
            out = out / np.maximum(norm(out, axis=1), 1e-300)[:, None]
            yield (p, p.get("radius", 0) - np.sum(arm * out, axis=1), out,
                   w * (t < p["until"]))


def loops(scene: Scene, t_end: float, h: float) -> End:
    """The motion with contact and tearing, by steps of h."""
    net = Net(scene)
    x, v, t = net.x.copy(), net.v.copy(), 0.
    alive = np.ones(net.n, bool)
    way, internal, changes = 1e-9, 0., list(scene.get("at", []))
    thickness = scene.get("self-collision", {}).get("thickness", 0)

    def constrain(t):
        for b in parts(scene, "tear"):
            alive[norm(x - b["at"], axis=1) < b["radius"]] = False
        whole = alive[net.i] & alive[net.j]
        if "tear-strain" in scene:
            whole &= norm(x[net.j] - x[net.i], axis=1) <= (
                1 + scene["tear-strain"]) * net.L
        if not whole.all():
            net.keep(whole)
        ids, px, pv = net.place(t)
        for p, depth, out, w in obstacles(scene, x, t):
            for k in set(np.nonzero((depth > 0) & alive)[0]) - set(ids):
                change = kick(v[k] - w, out[k], p["friction"])
                inward = change @ out[k]
                x[k] += depth[k] * (change / inward if inward > 0 else out[k])
                v[k] += change
        x[ids], v[ids] = px, pv

    steps = max(1, round(t_end / h))
    h = t_end / steps
    constrain(0)
    y = net.c / net.m * h  # drag is solved exactly
    decay = np.exp(-y)[:, None]
    gain = h * np.where(y > 1e-12, -np.expm1(-y) / np.maximum(y, 1e-300), 1)
    for step in range(steps):
        while changes and changes[0][0] <= t + 1e-9 * h:
            net.change(changes.pop(0)[1])
        f = net.force(x, v) + net.c[:, None] * v
        v[:] = v * decay + f * (gain / net.m)[:, None]
        t = (step + 1) * h
        x += h * v
        constrain(t)
        if thickness and net.nearest(x, alive) < 1.01 * thickness:
            return End(net, x, v, alive, way, internal, np.inf)
        if step % 16 == 0:
            e = net.energies(x, np.where(alive[:, None], v, 0))
            internal = max(internal, e["kinetic"] + e["elastic"])
            way = max(way, rms((x - net.x)[alive]))
    return End(net, x, v, alive, way, internal)


def truth(scene: Scene, t_end: float, dt: float) -> End:
    """How the scene ends."""
    if not any(f in scene for f in CONTACT):
        return smooth(scene, t_end)
    coarse, fine = loops(scene, t_end, dt / 10), loops(scene, t_end, dt / 20)
    bar = 2 * rms((coarse.x - fine.x)[fine.alive]) + coarse.bar + fine.bar
    same = len(coarse.net.i) == len(fine.net.i) and (
        coarse.alive == fine.alive).all()  # what tears
    fine.bar = bar if same and bar < .05 * fine.way else np.inf
    return fine
