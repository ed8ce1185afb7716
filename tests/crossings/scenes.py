"""Scenes drawn from the table of fields (lab/scenes/Fields.cpp): how each field
is drawn, written as options of ./cloth, transformed, and made smaller. A scene
is a dict of fields; a part is a dict of its words, each with its numbers."""
import pathlib
import re
import shlex
from collections.abc import Callable
from typing import Any

import numpy as np

import oracle
from oracle import Scene

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
METHODS = [a.split(",")[0] for a in (
    ROOT / "lab/charts/methods.csv").read_text().splitlines() if a[:1] != "#"]
METHODS = [m for m in METHODS if m != "method"]
MESHES = ("sheet", "net", "nodes")
# Dimensions of what is drawn: the powers of length, time and mass.
UNITS = {"at": (1, 0, 0), "u": (1, 0, 0), "v": (1, 0, 0), "from": (1, 0, 0),
         "to": (1, 0, 0), "radius": (1, 0, 0), "thickness": (1, 0, 0),
         "x": (1, 0, 0), "y": (1, 0, 0), "z": (1, 0, 0), "about": (1, 0, 0),
         "velocity": (1, -1, 0), "turn": (0, -1, 0), "until": (0, 1, 0),
         "sides": (0, -2, 1), "diagonals": (0, -2, 1), "bend": (0, -2, 1),
         "stiffness": (0, -2, 1), "modulus": (0, -2, 1), "density": (-2, 0, 1),
         "damping": (0, -1, 1), "drag": (-2, -1, 1), "gravity": (1, -2, 0),
         "t-end": (0, 1, 0), "dt": (0, 1, 0), "tolerance": (1, 0, 0),
         "points": (1, 0, 0), "velocities": (1, -1, 0), "masses": (0, 0, 1)}


def table_of_fields() -> list[str]:
    """The names in the table of fields, in its order."""
    text = (ROOT / "lab/scenes/Fields.cpp").read_text()
    table = text[text.index("return {"):text.index("// ---")]
    return re.findall(r'\{"([a-z-]+)",\s+(?:Role::)?\w+,', table)


class Draw:
    """One scene. on: the fields that may act."""

    def __init__(self, rng: np.random.Generator, on: set[str]):
        self.rng, self.on = rng, on
        self.s: Scene = {}
        for field in FIELDS:
            if field in on:
                FIELDS[field](self)

    # ------------------------------------------------------------- Numbers

    def number(self, low: float, high: float) -> float:
        """In [low, high], of three digits; by its logarithm if low > 0."""
        rng = self.rng
        a = (np.exp(rng.uniform(np.log(low), np.log(high))) if low > 0
             else rng.uniform(low, high))
        return float(f"{a:.3g}")

    def vector(self, size: float) -> tuple:
        return tuple(self.number(-size, size) for _ in range(3))

    def chance(self, p: float) -> bool:
        return self.rng.random() < p

    def one_of(self, all_: list) -> Any:
        return all_[self.rng.integers(len(all_))]

    def net(self) -> oracle.Net:
        return oracle.Net(self.s)

    # -------------------------------------------------------------- Meshes

    def sheet(self) -> None:
        self.s["sheet"] = [self.one_sheet(k) for k in
                           range(2 if self.chance(.2) else 1)]

    def one_sheet(self, k: int) -> Scene:
        n, m = (int(a) for a in self.rng.integers(2, 5, 2))
        if self.chance(.1) and not self.on & {"density", "modulus", "drag"}:
            m = 1
        part: Scene = {"nodes": (n, m)}
        if k or self.chance(.3):
            part["at"] = (k * 1.5, self.number(-.5, .5), self.number(-.5, .5))
        if self.chance(.4):
            part["u"] = (self.number(.3, 2), 0., self.number(-.5, .5))
        if self.chance(.4):
            part["v"] = (0., self.number(.3, 1.5), self.number(-1, 1))
        if self.chance(.4):
            part["velocity"] = self.vector(3)
        return part

    def jittered(self, triangles: bool) -> Scene:
        n, m = (int(a) for a in self.rng.integers(2, 5, 2))
        points, faces = oracle.grid(n, m)
        points = [(p + self.number(-.1, .1) / n, q + self.number(-.1, .1) / m,
                   self.number(-.1, .1)) for p, q in points]
        if triangles:
            faces = [f for a, b, c, d in faces for f in ([a, b, c], [a, c, d])]
        return {"points": points, "faces": faces}

    def velocities(self, mesh: Scene) -> None:
        if self.chance(.4):
            mesh["velocities"] = [self.vector(2) for _ in mesh["points"]]

    def nodes(self) -> None:
        self.s["nodes"] = self.jittered(self.chance(.4))
        self.velocities(self.s["nodes"])

    def free_net(self) -> None:
        mesh = self.jittered(self.chance(.5))
        points = mesh["points"]
        if not self.on & {"density", "modulus"}:
            if self.chance(.7):
                mesh["faces"] = []
            some = range(len(points))
            pairs = {(k - 1, k) for k in some[1:]} | {
                tuple(sorted(self.rng.choice(len(points), 2, replace=False)))
                for _ in some}
            mesh["springs"] = [(int(i), int(j), *(
                (self.number(10, 1000), self.number(0, 1.5 * float(
                    np.linalg.norm(np.subtract(points[i], points[j])))))
                if self.chance(.5) else (None, None)))
                for i, j in sorted(pairs)]
            if self.chance(.5):
                mesh["masses"] = [self.number(1e-3, 10) if self.chance(.7)
                                  else None for _ in some]
        if self.chance(.6):
            mesh["held"] = [int(k) for k in sorted(set(
                self.rng.integers(0, len(points), 2)))]
        self.velocities(mesh)
        self.s["net"] = mesh

    # ------------------------------------------------------------ Material

    def edges(self) -> None:
        kinds = {"sides": None}
        for k in ("diagonals", "bend"):
            if self.chance(.5):
                kinds[k] = None
        self.s["edges"] = {k: self.number(10, 1000) if self.chance(.3)
                           else None for k in kinds}

    def region(self) -> None:
        parts = []
        for _ in range(2 if self.chance(.3) else 1):
            x = self.net().start
            low, high = x.min(0) - .01, x.max(0) + .01
            cut = int(self.rng.integers(3))
            high[cut] = self.rng.uniform(.5, 1) * (high[cut] - low[cut]) + low[
                cut]
            part: Scene = {"from": round3(low), "to": round3(high),
                    "mass-factor": self.number(.1, 10)}
            if self.chance(.5):
                part["stiffness-factor"] = self.number(.1, 10)
            parts.append(part)
        self.s["region"] = parts

    def wind(self) -> None:
        self.s["wind"] = {"velocity": self.vector(5)}

    def gravity(self) -> None:
        self.s["gravity"] = 0. if self.chance(.3) else self.number(-15, 30)

    # ------------------------------------------------ Pins and obstacles

    def motion(self, turns: bool = False) -> Scene:
        if self.chance(.5):
            return {}
        part: Scene = {"velocity": self.vector(1)}
        if turns and self.chance(.4):
            part |= {"turn": self.vector(3), "about": self.vector(.5)}
        if self.chance(.3):
            part["until"] = self.number(.02, .3)
        return part

    def pin(self) -> None:
        x, pins = self.net().start, []
        for _ in range(int(self.rng.integers(1, 4))):
            k = int(self.rng.integers(len(x)))
            axis = int(self.rng.integers(3))
            part: Scene = {"node": k} if self.chance(.5) else {
                "xyz"[axis]: float(x[k][axis])}
            pins.append(part | self.motion(True))
        if self.chance(.3):
            pins.append(dict(pins[0]))  # the same once more
        self.s["pin"] = pins

    def aim(self) -> tuple[np.ndarray, np.ndarray, float]:
        """A place that a node may reach, the way there, and a time [s]."""
        net = self.net()
        k = int(self.rng.integers(net.n))
        time = self.s["t-end"] * self.rng.uniform(0, 1)
        way = net.v[k] * time + np.array((0, 0, -net.g)) * time**2 / 2
        return net.start[k] + way, way, time

    def plane(self) -> None:
        planes = []
        for _ in range(2 if self.chance(.2) else 1):
            at, way, _ = self.aim()
            normal = self.one_of([(0., 0., 1.), self.vector(1)])
            if np.dot(way, normal) > 0:
                normal = tuple(-a for a in normal)
            part: Scene = {"at": round3(at),
                           "normal": normal} | self.motion()
            if self.chance(.5):
                part["friction"] = self.number(.05, 1)
            planes.append(part)
        if self.chance(.2):
            planes.append(dict(planes[0]))
        self.s["plane"] = planes

    def ball(self, part: Scene) -> Scene:
        at, way, _ = self.aim()
        size = np.ptp(self.net().start, axis=0).max()
        r = self.number(.01 * size, .5 * size)
        l = np.linalg.norm(way)
        out = way / l if l > 0 else np.array((0, 0, -1.))
        return {"at": round3(at + .9 * r * out), "radius": r} | part

    def sphere(self) -> None:
        balls = [self.ball(self.motion() | (
            {"friction": self.number(.05, 1)} if self.chance(.5) else {}))
            for _ in range(2 if self.chance(.2) else 1)]
        self.s["sphere"] = balls + balls[:1] * self.chance(.2)

    def tear(self) -> None:
        self.s["tear"] = [self.ball({})]

    def self_collision(self) -> None:
        x = self.net()
        linked = set(zip(x.i, x.j))
        least = min((np.linalg.norm(x.start[a] - x.start[b])
                     for b in range(x.n) for a in range(b)
                     if (a, b) not in linked), default=0.)
        if least > 1e-3:
            self.s["self-collision"] = {
                "thickness": float(f"{least * self.rng.uniform(.3, .95):.2g}")}
            if self.chance(.5):
                self.s["self-collision"]["friction"] = self.number(.05, 1)

    # ------------------------------------------------------ Step and question

    def method(self) -> None:
        often = ["verlet"] * 5 + ["symplectic-euler"] * 3
        self.s["method"] = self.one_of(METHODS + often)

    def t_end(self) -> None:
        """With the step: shares of the limit from 0.02 to 3."""
        name = self.s.get("method", "symplectic-euler")
        net = self.net()
        scale = max(1, *[float(r.split()[1]) / self.s.get("stiffness", 100)
                         for _, r in self.s.get("at", [])
                         if r.startswith("stiffness")], 1)
        omega = max(net.omega() * scale**.5, .5)
        share = self.number(.02, .7) if self.chance(.75) else self.number(.7, 3)
        dt = float(f"{share * (oracle.LIMIT.get(name) or 2) / omega:.3g}")
        steps = int(self.rng.integers(20, 80 if self.on & set(
            oracle.CONTACT) else 400))
        steps = max(8, min(steps, int(200 / (omega * dt))))
        self.s["dt"], self.s["t-end"] = dt, steps * dt
        self.omega = omega

    def dt(self) -> None:
        if self.chance(.3):
            self.s["dt"] = self.one_of(["auto", "auto", "auto:sharp"])

    def tolerance(self) -> None:
        if self.chance(.15):  # it chooses method and step
            self.s["tolerance"] = self.number(1e-6, 1e-3)
            self.s.pop("dt"), self.s.pop("method", None)

    def at(self) -> None:
        net, all_ = self.net(), []
        dt = self.s["dt"]
        steps = round(self.s["t-end"] / dt)
        for k in sorted(self.rng.integers(1, max(2, steps - 4), 1)):
            e = int(self.rng.integers(len(net.i)))
            requests = [f"cut {net.i[e]} {net.j[e]}",
                        f"gravity {self.number(-10, 20)}"]
            if "modulus" not in self.s:
                requests.append(f"stiffness {self.number(10, 400)}")
            if net.held():
                requests.append(f"unpin {self.one_of(net.held())}")
            all_.append((int(k) * dt, self.one_of(requests)))
        self.s["at"] = all_

    def measure(self) -> None:
        s, axis = self.s, self.one_of(["", " x", " y", " z"])
        all_ = ["com" + axis, "energy", "max-stretch", "kinetic-energy",
                "elastic-energy", "lost-energy"]
        if not self.s.get("sheet") or "tear-strain" in s:
            all_.append("drape-height")
        if oracle.Net(s).held():
            all_ += ["pin-force"] * 3
        if s.get("plane") or s.get("sphere"):
            all_ += ["contact-force"] * 5
        if s.get("tear") or "tear-strain" in s:
            all_ += ["torn-edges", "torn-nodes"]
        elif s.get("sheet"):
            u, v = self.number(0, 1), self.number(0, 1)
            all_ += [f"point u {u} v {v}{axis}",
                     f"distance u {u} v {v} to-u {v} to-v 0.5"]
        name = self.one_of(all_)
        if self.chance(.3) and name != "com" and not name.startswith(
                ("point", "distance", "torn")):
            name = self.one_of(["max", "min", "mean"]) + " " + name.replace(
                "max-", "")
        s["measure"] = name

    def view(self) -> None:
        self.s["view"] = {"from": (-1., -1., -2.), "to": (2., 2., 1.)}

    def nothing(self) -> None:
        """It comes with another field."""


def number_of(field: str, low: float, high: float) -> Callable:
    def draw(self: Draw) -> None:
        self.s[field] = self.number(low, high)
    return draw


def round3(a: Any) -> tuple:
    return tuple(float(f"{b:.3g}") for b in a)


# How each field is drawn, in an order in which each knows what it needs.
FIELDS: dict[str, Callable] = {
    "sheet": Draw.sheet, "net": Draw.free_net, "nodes": Draw.nodes,
    "tets": Draw.nothing, "edges": Draw.edges,
    "stiffness": number_of("stiffness", 5, 2000),
    "modulus": number_of("modulus", 5, 2000),
    "rest-length": number_of("rest-length", .7, 1.3),
    "density": number_of("density", .05, 5),
    "damping": number_of("damping", 1e-3, .3),
    "drag": number_of("drag", 1e-3, 3), "region": Draw.region,
    "wind": Draw.wind, "gravity": Draw.gravity, "pin": Draw.pin,
    "method": Draw.method, "t-end": Draw.t_end, "at": Draw.at,
    "plane": Draw.plane, "sphere": Draw.sphere, "tear": Draw.tear,
    "tear-strain": number_of("tear-strain", .02, 1),
    "self-collision": Draw.self_collision, "dt": Draw.dt,
    "measure": Draw.measure, "tolerance": Draw.tolerance, "view": Draw.view}
ALWAYS = {"t-end", "measure", "method", "dt"}


def draw(rng: np.random.Generator, pairs: dict,
         must: str | None = None) -> Scene:
    """A scene; of some sets of fields the one whose pairs were drawn least.
    pairs: how often each was drawn; counts on."""
    def fields() -> set[str]:
        on = {f for f in FIELDS if rng.random() < .5} | ALWAYS
        if rng.random() < .5:
            on -= set(oracle.CONTACT)
        mesh = MESHES[rng.choice(3, p=(.5, .25, .25))]
        on -= set(MESHES) | {"tets"}
        on |= {mesh} | ({"tets"} if mesh == "nodes" else set())
        if must:
            on |= {must} if must not in MESHES + ("tets",) else set()
        for one, other in (("stiffness", "modulus"), ("damping", "drag")):
            if {one, other} <= on:
                on.discard(one if other == must or (
                    rng.random() < .5 and one != must) else other)
        if "wind" in on and not on & {"damping", "drag"}:
            on.add("damping" if rng.random() < .5 else "drag")
        return on
    best = min((fields() for _ in range(6)), key=lambda on: np.mean(
        [pairs.get((a, b), 0) for a in on for b in on if a < b]))
    s: Scene = {}
    while not names_parts(s):
        try:
            s = Draw(rng, best).s
        except (ValueError, IndexError):
            continue
    count_pairs(s, pairs)
    return s


def names_parts(s: Scene) -> bool:
    """A mesh without any of these is the assignment's scene."""
    return bool(set(s) & {"sheet", "modulus", "density", "drag", "region",
                          "wind", "pin", *oracle.CONTACT})


def count_pairs(s: Scene, pairs: dict) -> None:
    on = set(s) | ({"tets"} if "nodes" in s else set())
    for a in on:
        for b in on:
            if a < b:
                pairs[a, b] = pairs.get((a, b), 0) + 1


# ------------------------------------------------------------------ As text

def words(part: Scene) -> str:
    def numbers(a):
        if a is None:
            return []
        return [repr(k) for k in (a if isinstance(a, tuple) else (a,))]
    return " ".join(" ".join([w, *numbers(a)]) for w, a in part.items())


def options(s: Scene, folder: pathlib.Path) -> list[str]:
    """The options of ./cloth; writes the files of meshes into the folder."""
    all_: list[str] = []
    for field, value in s.items():
        if field == "net":
            (folder / "a.net").write_text(net_text(value))
            all_ += ["--net", str(folder / "a.net")]
        elif field == "nodes":
            all_ += mesh_files(value, folder)
        elif field == "at":
            for t, request in value:
                all_ += ["--at", f"{t!r} {request}"]
        else:
            for one in value if isinstance(value, list) else [value]:
                all_ += ["--" + field, words(one) if isinstance(one, dict)
                         else one if isinstance(one, str) else repr(one)]
    return all_


def net_text(mesh: Scene) -> str:
    lines = []
    for k, p in enumerate(mesh["points"]):
        m, v = mesh.get("masses"), mesh.get("velocities")
        lines.append("node " + row(p) +
                     (f" mass {m[k]!r}" if m and m[k] is not None else "") +
                     (" velocity " + row(v[k]) if v else "") +
                     (" held" if k in mesh.get("held", []) else ""))
    for i, j, K, L in mesh.get("springs", []):
        lines.append(f"spring {i} {j}" + ("" if K is None else f" {K!r} {L!r}"))
    lines += ["face " + row(f) for f in mesh["faces"]]
    return "\n".join(lines) + "\n"


def row(numbers: Any) -> str:
    return " ".join(repr(a) for a in numbers)


def mesh_files(mesh: Scene, folder: pathlib.Path) -> list[str]:
    v = mesh.get("velocities") or [()] * len(mesh["points"])
    (folder / "a.nodes").write_text("".join(
        row(tuple(p) + tuple(w)) + "\n" for p, w in zip(mesh["points"], v)))
    three = len(mesh["faces"][0]) == 3
    name = folder / ("a.tris" if three else "a.tets")
    name.write_text("".join(row(f if three else [f[0], f[1], f[3], f[2]]) +
                            "\n" for f in mesh["faces"]))
    return ["--nodes", str(folder / "a.nodes"), "--tets", str(name)]


def command(s: Scene, path: pathlib.Path) -> str:
    """As one line for a shell; the files of a mesh come before it."""
    return "./cloth " + " ".join(
        shlex.quote(a.replace(str(path) + "/", "")) for a in
        options(s, path)) + " --headless"


# ------------------------------------------------------------------ Symmetry

def scaled(s: Scene, length: float, time: float) -> Scene:
    """The same scene in other units: a length and a time take these values."""
    def factor(word):
        L, T, _ = UNITS.get(word, (0, 0, 0))
        return length**L * time**T

    def walk(word, a):
        if isinstance(a, dict):
            return {w: walk(w, b) for w, b in a.items()}
        if word == "springs":
            return [(i, j, K if K is None else K / time**2,
                     L if L is None else L * length) for i, j, K, L in a]
        if word == "at" and isinstance(a, list):
            return [(t * time, " ".join([w := r.split()[0], *(
                repr(float(b) * factor(w)) if w in UNITS else b
                for b in r.split()[1:])])) for t, r in a]
        if isinstance(a, (list, tuple)):
            return type(a)(walk(word, b) for b in a)
        return a * factor(word) if isinstance(a, float) and factor(
            word) != 1 else a
    out = {f: walk(f, a) for f, a in s.items()}
    if "gravity" not in s:
        out["gravity"] = oracle.G * factor("gravity")
    if "stiffness" not in s and "modulus" not in s:
        out["stiffness"] = 100. * factor("stiffness")
    for part in out.get("sheet", []):
        part.setdefault("u", (length, 0., 0.))
        part.setdefault("v", (0., length, 0.))
    return out
