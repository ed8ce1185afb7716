"""The truth about a scene, by NumPy and SciPy alone. Formulas: lab/scenes'
README. Smooth motion is integrated by DOP853; contact and tearing by a
symplectic rule, in plain loops, with two steps that show how far it converged.
Lengths in m, times in s, masses in kg."""
import itertools
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigvalsh
from scipy.sparse import csr_matrix

Scene = dict[str, Any]
Array = np.ndarray
G = 9.81
# The largest dt omega [1] of a method without drag; no entry: any step.
LIMIT = {"symplectic-euler": 2, "verlet": 2, "rk4": 2.8284, "pefrl": 2.989,
         "srkn11b": 9.07, "forward-euler": 0}


class Chaos(Exception):
    """Two oracles differ: there is no truth to compare with."""


def grid(n: int, m: int) -> tuple[list, list]:
    """Unit points of n x m nodes, and their quads, corners listed around."""
    points = [(i / max(n - 1, 1), j / max(m - 1, 1))
              for i in range(n) for j in range(m)]
    faces = [[i * m + j, i * m + j + 1, (i + 1) * m + j + 1, (i + 1) * m + j]
             for i in range(n - 1) for j in range(m - 1)]
    return points, faces


def near(value: float, wanted: float | None) -> bool:
    return wanted is None or abs(value - wanted) < 1e-9


def turned(arm: Array, turn: Array, time: float) -> Array:
    """Rodrigues: arm, turned by the angular velocity in a time."""
    speed = np.linalg.norm(turn)
    if speed == 0:
        return arm
    k, a = turn / speed, speed * time
    return (np.cos(a) * arm + np.sin(a) * np.cross(k, arm) +
            (1 - np.cos(a)) * np.outer(arm @ k, k))


class Net:
    """Points, springs and what acts on them, of a scene (scenes.py)."""

    def __init__(self, s: Scene):
        self.scene = s
        mesh = s.get("net") or s.get("nodes")
        x: list = []
        v: list = []
        faces: list = []
        self.sheets: list = []
        listed, mass, held = [], None, []
        if mesh:
            x, faces = list(mesh["points"]), mesh["faces"]
            v = mesh.get("velocities") or [(0, 0, 0)] * len(x)
            listed, mass = mesh.get("springs", []), mesh.get("masses")
            held = mesh.get("held", [])
        for part in s.get("sheet", []):
            n, m = (int(a) for a in part["nodes"])
            at, u, w = (np.array(part.get(k, d), float) for k, d in
                        (("at", (0, 0, 0)), ("u", (1, 0, 0)), ("v", (0, 1, 0))))
            points, quads = grid(n, m)
            first = len(x)
            self.sheets.append((first, n, m))
            x += [at + p * u + q * w for p, q in points]
            v += [part.get("velocity", (0, 0, 0))] * len(points)
            faces = faces + [[first + k for k in q] for q in quads]
            if n == 1 or m == 1:
                listed = listed + [(first + k, first + k + 1, None, None)
                                   for k in range(n * m - 1)]
        self.x, self.v = np.array(x, float), np.array(v, float)
        self.n, self.faces = len(x), faces
        self.area = [np.linalg.norm(np.cross(self.x[f[2]] - self.x[f[0]],
                                             self.x[f[-1]] - self.x[f[1]])) / 2
                     for f in faces]
        share = np.zeros(self.n)
        for f, a in zip(faces, self.area):
            share[f] += a / len(f)
        self.m = np.full(self.n, 1 / self.n)
        if mass:
            self.m = np.array([1 / self.n if a is None else a for a in mass])
        if "density" in s:
            self.m = s["density"] * share
        self.c = np.full(self.n, s.get("damping", 0.))
        if "drag" in s:
            self.c = s["drag"] * share
        self.wind = np.array(s.get("wind", {}).get("velocity", (0, 0, 0)))
        self.g = s.get("gravity", G)
        self.springs(listed)
        for r in s.get("region", []):
            low, high = np.sort([r["from"], r["to"]], axis=0)
            inside = np.all((self.x > low - 1e-9) & (self.x < high + 1e-9), 1)
            self.m[inside] *= r.get("mass-factor", 1)
            self.K[inside[self.i] & inside[self.j]] *= r.get(
                "stiffness-factor", 1)
            self.factor[inside[self.i] & inside[self.j]] *= r.get(
                "stiffness-factor", 1)
        self.pins = [([k for k in range(self.n) if all(
            near(self.x[k][a], p.get("xyz"[a])) for a in range(3))
            and near(k, p.get("node"))], p) for p in s.get("pin", [])]
        if held:
            self.pins.append((held, {}))
        self.v[self.held()] = 0
        self.start = self.x.copy()

    def springs(self, listed: list) -> None:
        s = self.scene
        all_: dict = {}
        owned: dict = {}
        sides: dict = {}
        kinds = s.get("edges", {"sides": None, "diagonals": None})
        modulus, usual = s.get("modulus"), s.get("stiffness", 100.)

        def add(i, j, own, strip):
            """strip: the area of cloth that the spring stands for [m^2]."""
            key = (min(i, j), max(i, j))
            old = all_.get(key, 0 if modulus is not None else usual)
            l2 = np.sum((self.x[i] - self.x[j])**2)
            all_[key] = old + (modulus * strip / l2 if modulus is not None
                               else 0)
            if own is not None:
                owned[key] = own

        if "bend" in kinds:
            for f, face in enumerate(self.faces):
                for k in range(len(face)):
                    a, b = face[k], face[(k + 1) % len(face)]
                    before, after = face[k - 1], face[(k + 2) % len(face)]
                    rim = {a: before, b: after}
                    sides.setdefault(frozenset((a, b)), []).append((f, rim))
            for pair in sides.values():
                if len(pair) == 2:
                    (f, one), (h, other) = pair
                    three = len(self.faces[f]) == 3
                    for end in list(one)[:1 if three else 2]:
                        if one[end] != other[end]:
                            add(one[end], other[end], kinds["bend"],
                                self.area[f] + self.area[h])
        for q, a in zip(self.faces, self.area):
            for k in range(len(q)):
                add(q[k], q[(k + 1) % len(q)], kinds["sides"],
                    a if len(q) == 3 else a / 2)
            if len(q) == 4 and "diagonals" in kinds:
                add(q[0], q[2], kinds["diagonals"], 2 * a)
                add(q[1], q[3], kinds["diagonals"], 2 * a)
        springs: dict = {}
        for (i, j), K in all_.items():
            own = owned.get((i, j))
            springs[i, j] = [K if own is None else own,
                             np.linalg.norm(self.x[i] - self.x[j]),
                             own is None and modulus is None]
        seen = set()
        for i, j, K, L in listed:
            key = (min(i, j), max(i, j))
            free = K is None
            K = usual if free else K
            L = np.linalg.norm(self.x[i] - self.x[j]) if L is None else L
            if key in seen and K + springs[key][0] > 0:
                k, l, _ = springs[key]
                springs[key] = [k + K, (k * l + K * L) / (k + K), False]
            else:
                springs[key] = [K, L, free]
            seen.add(key)
        ends = np.array(list(springs), int).reshape(-1, 2)
        self.i, self.j = ends[:, 0], ends[:, 1]
        self.K = np.array([a[0] for a in springs.values()])
        self.L = np.array([a[1] for a in springs.values()])
        self.L = self.L * s.get("rest-length", 1)
        self.free = np.array([a[2] for a in springs.values()], bool)
        self.factor = np.ones(len(self.K))

    # ------------------------------------------------------------ What holds

    def held(self) -> list[int]:
        return sorted({k for nodes, _ in self.pins for k in nodes})

    def place(self, t: float) -> tuple[list[int], Array, Array]:
        """Positions and velocities of the held nodes; the last pin wins."""
        x: dict = {}
        v: dict = {}
        for nodes, p in self.pins:
            until = min(t, p.get("until", np.inf))
            vel = np.array(p.get("velocity", (0, 0, 0)), float)
            turn = np.array(p.get("turn", (0, 0, 0)), float)
            about = np.array(p.get("about", (0, 0, 0)), float)
            arm = turned(self.start[nodes] - about, turn, until)
            now = t < p.get("until", np.inf)
            for k, a in zip(nodes, arm):
                x[k] = about + a + vel * until
                v[k] = (vel + np.cross(turn, a)) if now else np.zeros(3)
        ids = sorted(x)
        return (ids, np.array([x[k] for k in ids]).reshape(-1, 3),
                np.array([v[k] for k in ids]).reshape(-1, 3))

    # ---------------------------------------------------------------- Forces

    def prepare(self) -> "Net":
        """The incidence of springs and nodes, after either has changed."""
        e, n = len(self.i), len(self.x)
        at = np.concatenate([self.i, self.j])
        sign = np.concatenate([np.ones(e), -np.ones(e)])
        self.sum = csr_matrix((sign, (at, np.tile(np.arange(e), 2))), (n, e))
        return self

    def force(self, x: Array, v: Array) -> Array:
        u = x[self.j] - x[self.i]
        l = np.sqrt(np.sum(u * u, axis=1, keepdims=True))
        shape = (-1,) + (1,) * (x.ndim - 1)
        K, L, m, c = (a.reshape(shape) for a in
                      (self.K, self.L, self.m, self.c))
        with np.errstate(divide="ignore", invalid="ignore"):
            pull = np.where(l > 0, K * (l - L) / l, 0) * u
        f = self.sum @ pull.reshape(len(u), x[0].size)
        wind = self.wind.reshape((1, 3) + (1,) * (x.ndim - 2))
        f = f.reshape(x.shape) - c * (v - wind)
        f[:, 2] -= self.g * m.reshape(f[:, 2].shape[:1] + (1,) * (x.ndim - 2))
        return f

    def energies(self, x: Array, v: Array) -> dict[str, float]:
        l = np.linalg.norm(x[self.j] - x[self.i], axis=1)
        return {"kinetic": np.sum(self.m * np.sum(v * v, 1)) / 2,
                "elastic": np.sum(self.K * (l - self.L)**2) / 2,
                "gravitational": np.sum(self.m * self.g * x[:, 2])}

    # ---------------------------------------------------------------- Limits

    def omega(self, x: Array | None = None) -> float:
        """The largest frequency [1/s] at x; without x, of K on the graph,
        which bounds it in every configuration."""
        free = np.setdiff1d(np.arange(self.n), self.held())
        d = 3 if x is not None else 1
        if len(free) == 0 or len(self.K) == 0:
            return 0.
        H = np.zeros((self.n, d, self.n, d))
        for i, j, K, L in zip(self.i, self.j, self.K, self.L):
            B = np.array([[K]])
            if x is not None:
                u = x[j] - x[i]
                l = np.linalg.norm(u)
                if l == 0:
                    continue
                P = np.outer(u, u) / l**2
                B = K * (P + (1 - L / l) * (np.eye(3) - P))
            for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                H[a, :, b, :] += sign * B
        H = H[free][:, :, free].reshape(len(free) * d, -1)
        root = np.sqrt(np.repeat(self.m[free], d))
        return np.sqrt(max(eigvalsh(H / root / root[:, None])[-1], 0))

    # ------------------------------------------------------------ The motion

    def change(self, request: str) -> None:
        """Apply what follows the time in --at."""
        word, *rest = request.split()
        if word == "stiffness":
            self.K[self.free] = float(rest[0]) * self.factor[self.free]
        elif word == "gravity":
            self.g = float(rest[0])
        elif word == "unpin":
            self.pins = [([k for k in nodes if k != int(rest[0])], p)
                         for nodes, p in self.pins]
        elif word == "cut":
            i, j = sorted(int(a) for a in rest)
            self.keep(~((self.i == i) & (self.j == j)))
        self.prepare()

    def keep(self, springs: Array) -> None:
        for name in ("i", "j", "K", "L", "free", "factor"):
            setattr(self, name, getattr(self, name)[springs])

    def pieces(self, t_end: float) -> list[tuple[float, list[str]]]:
        """Times at which something changes, with the changes there."""
        cuts: dict[float, list[str]] = {0.: [], t_end: []}
        for _, p in self.pins:
            if 0 < p.get("until", np.inf) < t_end:
                cuts.setdefault(p["until"], [])
        for time, request in self.scene.get("at", []):
            if time < t_end:
                cuts.setdefault(time, []).append(request)
        return sorted(cuts.items())


class End:
    """How a motion ended: x, v, net; way: how far it moved [m], and its largest
    internal energy [J]; bar: by how much x may err [m]; growth: of an error at
    the start; alive: the nodes that are left; seen: what contact did."""

    def __init__(self, net: Net, x: Array, v: Array, bar: float, way: float,
                 internal: float, growth: float = 1, alive: Any = None,
                 seen: Iterable[str] = ()):
        self.net, self.x, self.v, self.bar = net, x, v, bar
        self.way, self.internal, self.growth = way, internal, growth
        self.seen = seen
        self.alive = np.ones(len(x), bool) if alive is None else alive


def smooth(scene: Scene, t_end: float, rtol: float = 1e-11) -> End:
    """The motion without contact. A twin that starts 1e-8 of the size away
    shows chaos: an error grows by End.growth."""
    net = Net(scene).prepare()
    x = np.stack([net.x, net.x], axis=2)
    v = np.stack([net.v, net.v], axis=2)
    size = np.ptp(net.x, axis=0).max()
    rng = np.random.default_rng(1)
    eps = 1e-8 * size
    noise = rng.standard_normal(net.x.shape)
    x[:, :, 1] += eps * noise
    way, internal, cuts = 1e-9 * size, 0., net.pieces(t_end)
    start = net.x.copy()
    for (t, requests), (to, _) in itertools.pairwise(cuts):
        for r in requests:
            net.change(r)
        held = net.held()
        free = np.setdiff1d(np.arange(net.n), held)
        shape = (2, len(free), 3, 2)

        def set_held(t, x, v):
            ids, px, pv = net.place(t)
            x[ids], v[ids] = px[:, :, None], pv[:, :, None]

        def rate(t, y):
            y = y.reshape(shape)
            x[free], v[free] = y
            set_held(t, x, v)
            return np.concatenate(
                [y[1].ravel(), (net.force(x, v)[free] /
                                net.m[free, None, None]).ravel()])

        y0 = np.stack([x[free], v[free]])
        out = solve_ivp(rate, (t, to), y0.ravel(), "DOP853", rtol=rtol,
                        atol=rtol * max(size, 1e-3))
        if not out.success:
            raise Chaos(out.message)
        for when, y in list(zip(out.t, out.y.T))[::max(1, len(out.t) // 50)]:
            x[free], v[free] = y.reshape(shape)
            set_held(when, x, v)
            e = net.energies(x[:, :, 0], v[:, :, 0])
            internal = max(internal, e["kinetic"] + e["elastic"])
            way = max(way, rms(x[:, :, 0] - start))
        x[free], v[free] = out.y[:, -1].reshape(shape)
        set_held(to, x, v)
    apart = rms(x[:, :, 1] - x[:, :, 0]) / eps
    return End(net, x[:, :, 0], v[:, :, 0], 1e-10 * size * max(apart, 1), way,
               internal, apart)


def rms(a: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(a * a, axis=1)))) if len(a) else 0.


def kick(u: Array, out: Array, friction: float) -> Array:
    """The change of a relative velocity u in a contact."""
    inward = -u @ out
    if inward <= 0:
        return np.zeros(3)
    along = u + inward * out
    slide = np.linalg.norm(along)
    return inward * out - along * (min(friction * inward, slide) /
                                   slide if slide > 0 else 0)


def loops(scene: Scene, t_end: float, h: float) -> End:
    """The motion with contact and tearing, by steps of h."""
    net = Net(scene).prepare()
    x, v, t = net.x.copy(), net.v.copy(), 0.
    alive = np.ones(net.n, bool)
    start, way, internal, seen = x.copy(), 1e-9, 0., set()
    changes = list(scene.get("at", []))
    thick, pushes = scene.get("self-collision", {}), 0

    def obstacles(t: float) -> Iterator:
        for p in scene.get("plane", []):
            at, n, w = moved(p, (0, 0, -.75), t)
            n = n / np.linalg.norm(n)
            depth = (at - x) @ n
            yield p, depth, n + np.zeros_like(x), w
        for p in scene.get("sphere", []):
            at, _, w = moved(p, (.5, .5, -.5), t)
            arm = x - at
            d = np.linalg.norm(arm, axis=1)
            yield p, p.get("radius", .15) - d, arm / np.maximum(
                d, 1e-300)[:, None], w

    def constrain(t):
        for b in scene.get("tear", []):
            gone = alive & (np.linalg.norm(
                x - np.array(b.get("at", (.5, .5, -.5))), axis=1)
                < b.get("radius", .15))
            if gone.any():
                alive[gone] = False
                seen.add("torn")
                net.keep(alive[net.i] & alive[net.j])
                net.prepare()
        if "tear-strain" in scene:
            l = np.linalg.norm(x[net.j] - x[net.i], axis=1)
            whole = l <= (1 + scene["tear-strain"]) * net.L
            if not whole.all():
                seen.add("torn")
                net.keep(whole)
                net.prepare()
        fixed = np.zeros(net.n, bool)
        ids, px, pv = net.place(t)
        fixed[ids] = True
        for p, depth, out, w in obstacles(t):
            for k in np.nonzero((depth > 0) & alive & ~fixed)[0]:
                seen.add("touched")
                change = kick(v[k] - w, out[k], p.get("friction", 0))
                inward = change @ out[k]
                x[k] += depth[k] * (change / inward if inward > 0 else out[k])
                v[k] += change
        x[ids], v[ids] = px, pv
        if thick:
            apart(fixed)

    def apart(fixed):
        D, linked = thick["thickness"], set(zip(net.i, net.j))
        for _ in range(60):
            nonlocal pushes
            d = np.linalg.norm(x[:, None] - x[None], axis=2)
            pairs = [(a, b) for a, b in zip(*np.nonzero(d < D * (1 - 1e-12)))
                     if a < b and (a, b) not in linked and alive[a]
                     and alive[b] and not (fixed[a] and fixed[b])]
            for a, b in pairs:
                if (pushes := pushes + 1) > 20000:
                    raise Chaos("too many collisions")
                seen.add("touched")
                u = x[b] - x[a]
                l = np.linalg.norm(u)
                out = u / l if l > 0 else np.array((0, 0, 1.))
                wa, wb = ((0 if fixed[k] else 1 / net.m[k]) for k in (a, b))
                push = max(D - l, 0) * out / (wa + wb)
                dv = kick(v[b] - v[a], out, thick.get("friction", 0)) / (
                    wa + wb)
                x[a], x[b] = x[a] - wa * push, x[b] + wb * push
                v[a], v[b] = v[a] - wa * dv, v[b] + wb * dv
            if not pairs:
                return

    steps = max(1, round(t_end / h))
    h = t_end / steps
    constrain(0)
    for step in range(steps):
        while changes and changes[0][0] <= t + 1e-9 * h:
            net.change(changes.pop(0)[1])
        f = net.force(x, v) + net.c[:, None] * v  # drag is solved exactly
        y = net.c / net.m * h
        v[:] = v * np.exp(-y)[:, None] + f / net.m[:, None] * h * np.where(
            y > 1e-12, -np.expm1(-y) / np.maximum(y, 1e-300), 1)[:, None]
        t = (step + 1) * h
        x += h * v
        constrain(t)
        if step % 16 == 0:
            e = net.energies(x, np.where(alive[:, None], v, 0))
            internal = max(internal, e["kinetic"] + e["elastic"])
            way = max(way, rms((x - start)[alive]))
    return End(net, x, v, 0, way, internal, 1, alive, seen)


def moved(p: Scene, at: tuple, t: float) -> tuple[Array, Array, Array]:
    until = p.get("until", np.inf)
    w = np.array(p.get("velocity", (0, 0, 0)), float)
    return (np.array(p.get("at", at), float) + w * min(t, until),
            np.array(p.get("normal", (0, 0, 1)), float),
            w if t < until else np.zeros(3))


CONTACT = ("plane", "sphere", "tear", "tear-strain", "self-collision")


def truth(scene: Scene, t_end: float, dt: float) -> End:
    """How the scene ends. Throws Chaos."""
    if not any(f in scene for f in CONTACT):
        end = smooth(scene, t_end)
        if end.growth > 1e5:
            raise Chaos("an error grows by %.0e" % end.growth)
        return end
    coarse, fine = loops(scene, t_end, dt / 10), loops(scene, t_end, dt / 20)
    if (coarse.alive != fine.alive).any() or len(coarse.net.i) != len(
            fine.net.i):
        raise Chaos("what tears depends on the step")
    fine.bar = 2 * rms((coarse.x - fine.x)[fine.alive])
    if not fine.bar < 0.05 * fine.way:
        raise Chaos("two steps differ by %.1e m" % fine.bar)
    return fine
