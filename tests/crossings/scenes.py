"""Scenes drawn from the table of fields (lab/scenes/Fields.cpp): how each field
is drawn, written as options of ./cloth, and told in other units. A scene is a
dict of fields; a part is a dict of its words, each with its numbers."""
import collections
import pathlib
import re
import shlex
from collections.abc import Callable, Iterable
from itertools import combinations
from typing import Any

import numpy as np
from numpy.linalg import norm

import oracle
from oracle import CONTACT, USUAL, Net, Scene

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
METHODS = re.findall(r'\.name = "(.+)"', "".join(
    path.read_text() for path in sorted((ROOT / "lab/methods").glob("*.hpp"))))
MESHES = {"sheet", "net", "nodes"}
# Of each of these sets of fields at most one acts.
RIVALS = [MESHES, {"stiffness", "modulus"}, {"damping", "drag"},
          {"tolerance", "method"}, {"tolerance", "dt"},
          {"from-rest", "self-collision"}]
# The powers of length and time in what is drawn; the unit of mass is kept.
UNITS = {word: powers for powers, words in {
    (1, 0): "at u v from to radius x y z about tolerance points thickness",
    (1, -1): "velocity velocities", (0, -1): "turn damping",
    (0, 1): "until t-end dt", (1, -2): "gravity loads", (-2, 0): "density",
    (0, -2): "sides diagonals bend stiffness modulus", (-2, -1): "drag",
}.items() for word in words.split()}


def table_of_fields() -> list[str]:
    """The names in the table of fields, in its order."""
    text = (ROOT / "lab/scenes/Fields.cpp").read_text()
    table = text[text.index("return {"):text.index("// ---")]
    return re.findall(r'\{"([a-z-]+)",\s+(?:Role::)?\w+,', table)


def round3(a: Any) -> tuple:
    return tuple(float(f"{b:.3g}") for b in a)


class Draw:
    """One scene, s. on: the fields that may act."""

    def __init__(self, rng: np.random.Generator, on: set[str]):
        self.rng, self.on = rng, on
        self.s: Scene = {}
        for field, how in FIELDS.items():
            value = None if field not in on else (
                self.number(*how) if isinstance(how, tuple) else how(self))
            if value is not None:
                self.s[field] = value

    def number(self, low: float, high: float) -> float:
        """In [low, high], of three digits; by its logarithm if low > 0."""
        draw = self.rng.uniform
        return float("%.3g" % (np.exp(draw(np.log(low), np.log(high)))
                               if low > 0 else draw(low, high)))

    def vector(self, size: float) -> tuple:
        return tuple(self.number(-size, size) for _ in range(3))

    def chance(self, p: float) -> bool:
        return bool(self.rng.random() < p)

    def one_of(self, all_: list) -> Any:
        return all_[self.rng.integers(len(all_))]

    def some(self, p: float, **words: Any) -> Scene:
        """These words, by chance."""
        return words if self.chance(p) else {}

    def several(self, one: Callable) -> list:
        """A part or two, and seldom the first once more."""
        all_ = [one() for _ in range(1 + self.chance(.3))]
        return all_ + all_[:1] * self.chance(.2)

    def sheet(self, k: int) -> Scene:
        n, m = (int(a) for a in self.rng.integers(2, 5, 2))
        if self.chance(.1) and not self.on & {"density", "modulus", "drag"}:
            m = 1
        return {"nodes": (n, m)} | self.some(1 if k else .3, at=(
            k * 1.5, self.number(-.5, .5), self.number(-.5, .5))) | self.some(
            .4, u=(self.number(.3, 2), 0., self.number(-.5, .5))) | self.some(
            .4, v=(0., self.number(.3, 1.5), self.number(-1, 1))) | self.some(
            .4, velocity=self.vector(3))

    def mesh(self) -> Scene:
        n, m = (int(a) for a in self.rng.integers(2, 5, 2))
        points, faces = oracle.grid(n, m)
        points = [(p + self.number(-.1, .1) / n, q + self.number(-.1, .1) / m,
                   self.number(-.1, .1)) for p, q in points]
        if self.chance(.4):
            faces = [f for a, b, c, d in faces for f in ([a, b, c], [a, c, d])]
        return {"points": points, "faces": faces} | self.some(
            .4, velocities=[self.vector(2) for _ in points])

    def free_net(self) -> Scene:
        mesh = self.mesh()
        points, n = mesh["points"], len(mesh["points"])
        mesh |= self.some(.6, held=sorted(set(
            self.rng.integers(0, n, 2).tolist())))
        if self.on & {"density", "modulus"}:
            return mesh
        if self.chance(.7):
            mesh["faces"] = []
        pairs = {(k, k + 1) for k in range(n - 1)} | {
            tuple(sorted(self.rng.choice(n, 2, replace=False).tolist()))
            for _ in points}
        ways = ["", "cable", "strut"] if self.chance(.4) else [""]
        mesh["springs"] = [(i, j, *(
            (self.number(10, 1000), self.number(0, 1.5 * float(
                norm(np.subtract(points[i], points[j])))))
            if self.chance(.5) else (None, None)), self.one_of(ways))
            for i, j in sorted(pairs)]
        mesh |= self.some(.3, loads=[(int(k), *self.vector(3)) for k in
                                     self.rng.integers(0, n, 2)])
        return mesh | self.some(.5, masses=[
            self.number(1e-3, 10) if self.chance(.7) else None for _ in points])

    def region(self) -> Scene:
        x = Net(self.s).x
        low, high = x.min(0) - .01, x.max(0) + .01
        cut = int(self.rng.integers(3))
        high[cut] = low[cut] + self.rng.uniform(.5, 1) * (high - low)[cut]
        return {"from": round3(low), "to": round3(high),
                "mass-factor": self.number(.1, 10)} | self.some(
                    .5, **{"stiffness-factor": self.number(.1, 10)})

    def motion(self, pin: bool = False) -> Scene:
        part = self.some(.5, velocity=self.vector(1))
        if part:
            part |= self.some(.3, until=self.number(.02, .3))
        if not pin:
            return part | self.some(.5, friction=self.number(.05, 1))
        return part | self.some(.2, turn=self.vector(3), about=self.vector(.5))

    def pin(self) -> Scene:
        x = Net(self.s).x
        k, axis = int(self.rng.integers(len(x))), int(self.rng.integers(3))
        part: Scene = {"node": k} if self.chance(.5) else {
            "xyz"[axis]: float(x[k][axis])}
        return part | self.motion(True)

    def aim(self) -> tuple[np.ndarray, np.ndarray]:
        """A place that a node may reach, and the way there."""
        net = Net(self.s)
        k = int(self.rng.integers(net.n))
        time = self.s["t-end"] * self.rng.random()
        way = net.v[k] * time + net.g * time**2 / 2
        return net.x[k] + way, way

    def plane(self) -> Scene:
        at, way = self.aim()
        normal = self.one_of([(0., 0., 1.), self.vector(1)])
        if np.dot(way, normal) > 0:
            normal = tuple(-a for a in normal)
        return {"at": round3(at), "normal": normal} | self.motion()

    def ball(self) -> Scene:
        at, way = self.aim()
        size = np.ptp(Net(self.s).x, axis=0).max()
        r, l = self.number(.01 * size, .5 * size), norm(way)
        out = way / l if l > 0 else np.array((0, 0, -1.))
        return {"at": round3(at + .9 * r * out), "radius": r}

    def t_end(self) -> float:
        """Sets the step, too: shares of the limit from 0.02 to 3."""
        omega = max(Net(self.s).omega(), .5)
        share = self.number(.02, .7) if self.chance(.75) else self.number(.7, 3)
        dt = float("%.3g" % (
            share * (oracle.LIMIT.get(self.s["method"]) or 2) / omega))
        steps = int(self.rng.integers(20, 80 if self.on & set(CONTACT) else
                                      400))
        steps = max(8, min(steps, int(200 / (omega * dt))))
        self.s["dt"] = dt
        return steps * dt

    def tolerance(self) -> float | None:
        """It chooses method and step."""
        if self.chance(.75):
            return None
        for field in ("dt", "method"):
            self.s.pop(field, None)
        return self.number(1e-6, 1e-3)

    def thickness(self) -> Scene:
        """Less or more than the nodes are apart, up to a refusal."""
        apart = min(float(norm(a - b))
                    for a, b in combinations(Net(self.s).x, 2))
        far = .2 if self.chance(.7) else 1.2  # touching nodes have no truth
        return {"thickness": self.number(.05 * apart, far * apart)
                } | self.some(.5, friction=self.number(.05, 1))

    def gravity(self) -> Any:  # a number acts down, whatever its sign
        if self.chance(.3):
            return self.vector(15)
        return 0. if self.chance(.3) else self.number(-15, 30)

    def at(self) -> list:
        net, dt = Net(self.s), self.s["dt"]
        k = int(self.rng.integers(1, max(2, self.s["t-end"] / dt - 4)))
        e = int(self.rng.integers(len(net.i)))
        requests = [f"cut {net.i[e]} {net.j[e]}",
                    "gravity " + row(np.atleast_1d(self.gravity()).tolist())]
        if "modulus" not in self.s:
            requests.append(f"stiffness {self.number(10, 400)}")
        if net.held():
            requests.append(f"unpin {self.one_of(net.held())}")
        return [(k * dt, self.one_of(requests))]

    def measure(self) -> str:
        s, axis = self.s, self.one_of(["", " x", " y", " z"])
        all_ = ["com" + axis, "energy", "max-stretch", "kinetic-energy",
                "elastic-energy"]
        if not s.get("sheet") or "tear-strain" in s:
            all_.append("drape-height")
        net = Net(self.s)
        if net.held():
            all_ += ["pin-force"] * 3
        if not s.get("sheet") and len(net.i):
            e = int(self.rng.integers(len(net.i)))
            all_ += ["max-tension", f"tension {net.i[e]} {net.j[e]}"]
        if s.get("plane") or s.get("sphere"):
            all_ += ["contact-force"] * 5
        return self.one_of(all_)


# How each field is drawn, in an order in which each knows what it needs: a
# number between two, or what a function returns; not at all if that is None.
FIELDS: dict[str, Any] = {
    "sheet": lambda d: [d.sheet(k) for k in range(1 + d.chance(.2))],
    "net": Draw.free_net, "nodes": Draw.mesh,
    "tets": lambda d: None,  # they come with nodes
    "edges": lambda d: {k: d.number(10, 1000) if d.chance(.3) else None for k
                        in ["sides", "diagonals"][:1 + d.chance(.5)]},
    "stiffness": (5, 2000), "modulus": (5, 2000),
    "rest-length": (.7, 1.3), "density": (.05, 5), "damping": (1e-3, .3),
    "drag": (1e-3, 3), "region": lambda d: d.several(d.region),
    "wind": lambda d: {"velocity": d.vector(5)},
    "gravity": Draw.gravity,
    "pin": lambda d: d.several(d.pin),
    "from-rest": lambda d: Net(d.s).held() != [] or None,
    "method": lambda d: d.one_of(
        METHODS + ["verlet"] * 5 + ["symplectic-euler"] * 3),
    "t-end": Draw.t_end, "at": Draw.at,
    "plane": lambda d: d.several(d.plane),
    "sphere": lambda d: d.several(lambda: d.ball() | d.motion()),
    "tear": lambda d: [d.ball()], "tear-strain": (.02, 1),
    "self-collision": Draw.thickness,
    "dt": lambda d: d.one_of(  # in place of the step that is set
        [None] * 7 + ["auto", "auto", "auto:sharp"]),
    "measure": Draw.measure, "tolerance": Draw.tolerance,
    "view": lambda d: {"from": (-1., -1., -2.), "to": (2., 2., 1.)}}


def draw(rng: np.random.Generator, pairs: collections.Counter,
         asked: Iterable[str] = ()) -> Scene:
    """A scene; of some sets of fields the one whose pairs were drawn least.
    pairs: how often each was drawn; counts on. asked: what has() is true of."""
    must = {a.partition("=")[0] for a in asked}

    def fields() -> set[str]:
        mesh = str(rng.choice([*MESHES & must] or ["sheet", "sheet", "net",
                                                   "nodes"]))
        on = {f for f in FIELDS if rng.random() < .5} - MESHES
        if rng.random() < .5:
            on -= set(CONTACT)
        on |= {mesh, *must, "t-end", "measure", "method", "dt"}
        for two in RIVALS[1:3] + RIVALS[-1:]:
            if on >= two:
                on.remove(str(rng.choice(sorted(two - must))))
        if "wind" in on and not on & {"damping", "drag"}:
            on.add(str(rng.choice(["damping", "drag"])))
        return on if names_parts(on) else on | {"pin"}
    s: Scene = {}
    while not s or not all(has(s, a) for a in asked):
        s = Draw(rng, min((fields() for _ in range(6)), key=lambda on: np.mean(
            [pairs[two] for two in combinations(sorted(on), 2)]))).s
    pairs.update(combinations(sorted(s), 2))
    return s


def table(pairs: collections.Counter, least: int) -> tuple[str, list[str]]:
    """How often each pair was drawn; and those drawn fewer times than least."""
    names, text, few = [f for f in FIELDS if f != "tets"], "", list[str]()
    for k, f in enumerate(names):
        text += f"{f:15}"
        for g in names[:k]:
            n = pairs[min(f, g), max(f, g)]
            text += f"{n:5}"
            if n < least and not any({f, g} <= rivals for rivals in RIVALS):
                few.append(f"{f} x {g} {n}")
        text += "\n"
    return text + " " * 15 + "".join(f" {f[:4]:4}" for f in names), few


def has(s: Scene, asked: str) -> bool:
    """Whether s has the field; or FIELD=WORD, with this word; or FIELD=twice,
    a part twice or a node in two pins."""
    field, _, word = asked.partition("=")
    if word != "twice" or field not in s:
        return field in s and word in str(s[field])
    all_ = [str(p) for p in s[field]] if field != "pin" else [
        str(k) for nodes, _ in Net(s).pins for k in nodes]
    return len(set(all_)) < len(all_)


def names_parts(s: Iterable[str]) -> bool:
    """A mesh without any of these is the assignment's scene."""
    return bool(set(s) & {"sheet", "modulus", "density", "drag", "region",
                          "wind", "pin", *CONTACT})


def row(numbers: Any) -> str:
    return " ".join(repr(a) for a in numbers)


def words(part: Scene) -> str:
    return " ".join(w if a is None else w + " " + row(
        a if isinstance(a, tuple) else (a,)) for w, a in part.items())


def options(s: Scene, folder: pathlib.Path) -> list[str]:
    """The options of ./cloth; writes the files of meshes into the folder."""
    all_: list[str] = []
    for field, value in s.items():
        if value is True:
            all_.append("--" + field)
            continue
        if field in ("net", "nodes"):
            for option, text in mesh_files(field, value):
                (folder / ("a." + option)).write_text(text)
                all_ += ["--" + option.replace("tris", "tets"),
                         str(folder / ("a." + option))]
            continue
        for one in value if isinstance(value, list) else [value]:
            all_ += ["--" + field, words(one) if isinstance(one, dict) else
                     row(one) if field == "gravity" and (
                         isinstance(one, tuple)) else
                     "%r %s" % one if isinstance(one, tuple) else
                     one if isinstance(one, str) else repr(one)]
    return all_


def mesh_files(field: str, mesh: Scene) -> list[tuple[str, str]]:
    """The text of each file, after the end of its name."""
    points, faces = mesh["points"], mesh["faces"]
    v = mesh.get("velocities") or [()] * len(points)
    if field == "nodes":
        three = len(faces[0]) == 3
        return [("nodes", "".join(row((*p, *w)) + "\n" for p, w in
                                  zip(points, v))),
                ("tris" if three else "tets", "".join(
                    row(f if three else (f[0], f[1], f[3], f[2])) + "\n"
                    for f in faces))]
    lines = [f"node {row(p)}" + ("" if m is None else f" mass {m!r}") +
             (" velocity " + row(w) if w else "") +
             " held" * (k in mesh.get("held", [])) for k, (p, w, m) in
             enumerate(zip(points, v, mesh.get("masses") or
                           [None] * len(points)))]
    lines += [f"spring {i} {j}" + ("" if K is None else f" {K!r} {L!r}") +
              "".join(" " + w for w in way if w)
              for i, j, K, L, *way in mesh.get("springs", [])]
    lines += [f"load {row(a)}" for a in mesh.get("loads", [])]
    return [("net", "\n".join(lines + ["face " + row(f) for f in faces]) +
             "\n")]


def command(s: Scene, path: pathlib.Path) -> str:
    """As a command for a shell, after the files of a mesh."""
    files = [f"{name}: {text}" for field in MESHES & {*s} - {"sheet"}
             for name, text in mesh_files(field, s[field])]
    return "".join(files) + "./cloth --headless " + shlex.join(
        a.replace(f"{path}/", "") for a in options(s, path))


def scaled(s: Scene, length: float, time: float) -> Scene:
    """The same scene in other units: a length and a time take these values."""
    def factor(word):
        L, T = UNITS.get(word, (0, 0))
        return length**L * time**T

    def walk(word, a):
        if isinstance(a, dict):
            return {w: walk(w, b) for w, b in a.items()}
        if word == "springs":
            return [(i, j, *((None, None) if K is None else (
                K / time**2, L * length)), *way) for i, j, K, L, *way in a]
        if word == "at" and isinstance(a, list):
            return [(t * time, " ".join([w := r.split()[0], *(
                repr(float(b) * factor(w)) if w in UNITS else b
                for b in r.split()[1:])])) for t, r in a]
        if isinstance(a, (list, tuple)):
            return type(a)(walk(word, b) for b in a)
        return a * factor(word) if isinstance(a, float) else a

    s = {"gravity": oracle.G} | {
        f: [USUAL[f] | part for part in a] if f in USUAL else a
        for f, a in s.items()}
    return walk("", s if "modulus" in s else {"stiffness": 100.} | s)
