"""What a run promises: one function each. It gets a Case, and returns nothing
if the promise is kept, or says what was expected and what came; Chaos: there
is no truth to compare with."""
import pathlib
import re
import subprocess
import time
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import nnls

import oracle
from oracle import Array, Chaos, End, Net, Scene, rms
from scenes import options, scaled

# The kind of a broken promise, and what was seen.
Broken = tuple[str, list[str]] | None
EXPLICIT = {"verlet", "symplectic-euler", "rk4", "pefrl", "srkn11b",
            "forward-euler"}


class Run:
    """A run of ./cloth: its status, what it said, the state at its end."""

    def __init__(self, cloth: str, folder: pathlib.Path, arguments: list[str],
                 limit: float = 60):
        self.out = folder / "end.net"
        self.csv_file = folder / "rows.csv"
        for file in (self.out, self.csv_file):
            file.unlink(missing_ok=True)
        done = subprocess.run(
            [cloth, *arguments, "--headless"],
            capture_output=True, text=True, timeout=limit, cwd=folder)
        self.status, self.text = done.returncode, done.stdout
        self.said = [a for a in done.stderr.splitlines()
                     if a.startswith("cloth:")]
        self.bits = self.out.read_text() if self.out.exists() else ""

    @cached_property
    def csv(self) -> dict[str, np.ndarray]:
        """The columns, by name; the last one is that of the measure."""
        names, *rows = self.csv_file.read_text().split()
        table = np.array([[float(a) for a in r.split(",")] for r in rows])
        return dict(zip(names.split(","), table.T)) | {"last": table[:, -1]}

    @cached_property
    def net(self) -> tuple:
        """x, v, masses, springs (i, j, K, L) of the last state."""
        nodes, springs = [], []
        for line in self.bits.splitlines():
            word, *rest = line.split()
            if word == "node":
                at = {w: k for k, w in enumerate(rest)}
                v = at.get("velocity")
                nodes.append([*rest[:3], *(rest[v + 1:v + 4] if v else
                                           "000"), rest[at["mass"] + 1]])
            elif word == "spring":
                springs.append(rest)
        a = np.array(nodes, float).reshape(-1, 7)
        return (a[:, :3], a[:, 3:6], a[:, 6],
                np.array(springs, float).reshape(-1, 4))

    def answer(self) -> list[float] | None:
        """The numbers of the measure, as printed; or None."""
        found = re.findall(r"^[a-z].*?: (.*?)(?: [a-zA-Z]+)? (?:at|until) t = ",
                           self.text, re.M)
        return [float(a) for a in found[-1].split()] if found else None


class Case:
    """A scene, its run and the truth, each computed when it is asked for."""

    def __init__(self, cloth: str, folder: pathlib.Path, scene: Scene):
        self.cloth, self.folder, self.scene = cloth, folder, scene

    def run(self, *more: str, **other: Any) -> Run:
        """A run with other options, and with other values of fields."""
        scene = self.scene | {k.replace("_", "-"): a for k, a in other.items()}
        return Run(self.cloth, self.folder, options(scene, self.folder) + [
            *more, "--out", "end.net"])

    @cached_property
    def base(self) -> Run:
        run = self.run("--csv", "rows.csv", "--every", "1")
        if run.status in (0, 3):
            run.csv, run.net  # read before another run writes them
        return run

    @property
    def fixed(self) -> bool:
        return isinstance(self.scene.get("dt"), float)

    @property
    def contact(self) -> bool:
        return any(f in self.scene for f in oracle.CONTACT)

    @cached_property
    def dt(self) -> float:
        """The mean step [s]."""
        return (self.scene["dt"] if self.fixed else
                self.scene["t-end"] / max(1, len(self.base.csv["t"]) - 1))

    @cached_property
    def _truth(self) -> End | Chaos:
        try:
            return oracle.truth(self.scene, self.scene["t-end"],
                                min(self.dt, self.scene["t-end"] / 50))
        except Chaos as e:
            return e

    @property
    def truth(self) -> End:
        if isinstance(self._truth, Chaos):
            raise self._truth
        return self._truth

    @property
    def size(self) -> float:
        """Of the cloth and of its motion [m]."""
        return max(np.ptp(self.truth.net.start, axis=0).max(), self.truth.way)

    def same_nodes(self, run: Run | None = None) -> tuple:
        """x and v of a run's end; Chaos if other nodes are left."""
        x, v, _, _ = (run or self.base).net
        if len(x) != self.truth.alive.sum():
            raise Chaos("other nodes are left")
        return x, v

    def error(self, run: Run | None = None) -> tuple[float, float]:
        """How far the end of a run is from the truth: of the farthest node, as
        a share of the size; of the energy, as one of the internal energy."""
        truth = self.truth
        x, v = self.same_nodes(run)
        place = np.abs(x - truth.x[truth.alive]).max() / self.size
        if not truth.alive.all() or not np.isfinite(place):
            return place, 0.
        a, b = (sum(truth.net.energies(*state).values()) for state in
                ((x, v), (truth.x, truth.v)))
        return place, abs(a - b) / max(truth.internal, 1e-12)

    def exact(self) -> float:
        """How certain the truth is, as a share of the size."""
        return self.truth.bar / self.size

    @property
    def sound(self) -> bool:
        place, energy = self.error()
        return place < .01 and energy < .01 and self.exact() < .003

    def said_of_run(self) -> list[str]:
        """What the run said that is not about the scene as it was made."""
        if not self.base.said:
            return []
        made = set(self.run(t_end=0.).said)
        return [a for a in self.base.said if a not in made and
                "tunnelled" not in a and "moves up to" not in a]


def healthy(c: Case) -> Broken:
    """A run that the oracle calls sound ends with 0, without a warning."""
    if c.base.status not in (0, 3):
        return f"status {c.base.status}", c.base.said
    if c.base.status == 3:  # it ended early: would a finer run do the same?
        if not c.fixed or c.scene.get("method") == "forward-euler":
            return None
        share = c.dt * Net(c.scene).omega() / (
            oracle.LIMIT.get(c.scene.get("method", ""), 2) or 2)
        c.truth  # or Chaos
        if share < .3 and "at" not in c.scene:
            return "stopped", [f"{share:.2f} of the limit", *c.base.said]
        return None
    if c.sound and (said := c.said_of_run()):
        return "warned", [*(f"{a:.1e}" for a in c.error()), *said]
    return None


def sick(c: Case) -> Broken:
    """A run whose positions or energy are far off is not silent."""
    if c.base.status != 0 or c.base.said:
        return None
    place, energy = c.error()
    if c.exact() > .01 or c.truth.growth > 1e4:
        raise Chaos("the truth is known to %.1e" % c.exact())
    if place > .1 or energy > .1:
        return "silent", [f"positions off by {place:.2f} of the size, "
                          f"energy by {energy:.2f}, and nothing said"]
    return None


def end(c: Case) -> Broken:
    """The end converges to the truth with the step."""
    if c.base.status != 0 or not c.fixed:
        return None
    place, _ = c.error()
    floor = 3 * c.exact() + (.005 if c.contact else 1e-6)
    if place > .1 or place < floor:
        return None
    fine = c.run(dt=c.dt / 4)
    if fine.status != 0:
        return None
    better, _ = c.error(fine)
    if better > .6 * place + floor:
        return "off", [f"off by {place:.2e} of the size; with a quarter of "
                       f"the step by {better:.2e}"]
    return None


# The quantities, of a state: x, v and the net with its springs and pins.

def contact_force(net: Net, x: Array, v: Array, t: float) -> list[float]:
    """What the free nodes that touch press with: the least force along the
    outward normals that keeps each from moving in. An inward velocity, which
    the next contact takes, feels no drag."""
    sum_, size = np.zeros(3), np.linalg.norm(x, axis=1).max()
    for k in set(range(net.n)) - set(net.held()):
        outs, u = [], v[k].copy()
        for part, ball in [(p, False) for p in net.scene.get("plane", [])] + [
                (p, True) for p in net.scene.get("sphere", [])]:
            at, out, w = oracle.moved(
                part, (.5, .5, -.5) if ball else (0, 0, -.75), t)
            arm = x[k] - at
            if ball:
                out, at = arm, at + part.get("radius", .15) * (
                    arm / np.linalg.norm(arm))
            out = out / np.linalg.norm(out)
            if abs((x[k] - at) @ out) <= 1e-9 * (size + np.linalg.norm(at)):
                outs.append(out)
                u -= min(0, (u - w) @ out) * out
        if outs:
            f = net.force(x, v)[k] + net.c[k] * (v[k] - u)
            sum_ += np.transpose(outs) @ nnls(np.transpose(outs), -f)[0]
    return [float(np.linalg.norm(sum_))]


def on_sheet(net: Net, x: Array, k: int, u: float, v: float) -> Array:
    first, n, m = net.sheets[k]
    a, b = u * (n - 1), v * (m - 1)
    i, j = min(int(a), max(n - 2, 0)), min(int(b), max(m - 2, 0))
    p, q = a - i, b - j
    corner = lambda d, e: x[first + min(i + d, n - 1) * m + min(j + e, m - 1)]
    return ((1 - p) * ((1 - q) * corner(0, 0) + q * corner(0, 1)) +
            p * ((1 - q) * corner(1, 0) + q * corner(1, 1)))


def quantity(name: str, net: Net, x: Array, v: Array,
             t: float) -> list[float] | None:
    """The numbers of a measure at the end; None: nothing to compare with."""
    word, *rest = name.split()
    only = [k for k in range(3) if "xyz"[k] in rest] or range(3)
    e = net.energies(x, v)
    if word == "com":
        com = net.m @ x / net.m.sum()
        return [com[k] for k in only]
    if word == "energy":
        return [sum(e.values())]
    if word in ("kinetic-energy", "elastic-energy"):
        return [e[word[:-7]]]
    l = np.linalg.norm(x[net.j] - x[net.i], axis=1)
    if word in ("max-stretch", "stretch"):
        return [max([0., *(l / L - 1 for l, L in zip(l, net.L) if L > 0)])]
    if word == "drape-height":
        return [x[:, 2].min()]
    if word == "pin-force":
        return [float(np.linalg.norm(net.force(x, v)[net.held()].sum(0)))]
    if word == "contact-force":
        return contact_force(net, x, v, t)
    numbers = {w: float(rest[k + 1]) for k, w in enumerate(rest)
               if w in ("u", "v", "to-u", "to-v")}
    if word == "point":
        p = on_sheet(net, x, 0, numbers["u"], numbers["v"])
        return [p[k] for k in only]
    if word == "distance":
        return [float(np.linalg.norm(
            on_sheet(net, x, 0, numbers["u"], numbers["v"]) -
            on_sheet(net, x, 0, numbers["to-u"], numbers["to-v"])))]
    return None


def measure(c: Case) -> Broken:
    """Each quantity is that of the state at the end; K, L and masses are those
    of the scene; over time it is that of the rows."""
    if c.base.status != 0 or (got := c.base.answer()) is None:
        return None
    over, _, name = c.scene["measure"].partition(" ")
    rows = c.base.csv["last"]
    if over in ("max", "min", "mean"):
        if name.split()[0] in ("com", "energy", "kinetic-energy",
                               "elastic-energy", "lost-energy"):
            return None  # the last column is another
        want = {"max": np.max, "min": np.min}.get(over, lambda a: None)(rows)
        wanted = None if want is None else [want]
    else:
        x, v, m, springs = c.base.net
        net = Net(c.scene).prepare()
        for _, request in c.scene.get("at", []):
            net.change(request)
        if len(x) != net.n or len(springs) != len(net.i):
            return None
        order = np.lexsort((net.j, net.i))
        ends = np.sort(springs[:, :2].astype(int), axis=1)
        mine = np.lexsort((ends[:, 1], ends[:, 0]))
        for what, a, b in (("mass", m, net.m),
                           ("K", springs[mine, 2], net.K[order]),
                           ("L", springs[mine, 3], net.L[order])):
            if not np.allclose(a, b, rtol=1e-9):
                return "material", [f"{what} differs by up to "
                                    f"{np.abs(a - b).max():.3g}"]
        wanted = quantity(c.scene["measure"], net, x, v, c.scene["t-end"])
    if wanted is None:
        return None
    scale = max(np.abs(wanted).max(), 1e-6)
    if over not in ("max", "min") and "force" in c.scene["measure"]:
        scale = max(scale, 1e-3 * np.abs(net.K * net.L).max(initial=0))
    if len(got) != len(wanted) or np.abs(
            np.subtract(got, wanted)).max() > 2e-5 * scale:
        return c.scene["measure"].split()[0], [
            f"{c.scene['measure']}: got {got}, expected {wanted}"]
    return None


def balance(c: Case) -> Broken:
    """energy - work + drag is constant where nothing touches, and never rises;
    the printed share is that of the rows."""
    if c.base.status != 0:
        return None
    rows = c.base.csv
    internal = (rows["kinetic"] + rows["elastic"]).max()
    found = re.search(r"energy off by (\S+) J \((\S+) % of the largest "
                      "internal energy", c.base.text)
    if found and internal > 0:
        off, share = (abs(float(a)) for a in found.groups())
        if share < .3 * 100 * off / internal - .05:
            return "share", [f"{found.group(0)}; the rows: "
                             f"{100 * off / internal:.3g} %"]
    if not c.sound:
        return None
    off = rows["balance"][-1] / max(internal, 1e-12)
    if off > .02 or (off < -.02 and not c.contact):
        return "off", [f"{off:.3f} of the internal energy; the motion is "
                       "right to {:.1e} {:.1e}".format(*c.error())]
    return None


def limit(c: Case) -> Broken:
    """0.98 of the named limit holds on small oscillations, and it is near the
    bound of every configuration, of the stiffest stretch."""
    s = c.scene
    named = re.search(r"% of the stability limit \((\S+) s, (\S+)\)",
                      c.base.text)
    if not named or {"damping", "drag"} & set(s):
        return None
    largest = oracle.LIMIT.get(named.group(2), 0)
    omega = stretch = 0.
    net = Net(s).prepare()
    for request in [None, *(r for _, r in s.get("at", []))]:
        if request:
            net.change(request)
        omega = max(omega, net.omega())
        stretch = max(stretch, net.omega(net.start))
    if not omega > 0 or largest == 0:
        return None
    got = float(named.group(1))
    if got > 1.001 * largest / stretch:
        return "too long", [f"{got} s, but {largest / stretch:.4g} s at the "
                            "start or after a change"]
    if "tear" in s:
        return None  # what starts inside is gone
    if got < .85 * largest / omega or got > 1.02 * largest / omega:
        return "other", [f"{got} s, expected {largest / omega:.4g} s"]
    return None


def restart(c: Case) -> Broken:
    """Stopped somewhere and continued from a checkpoint: the same bits."""
    if c.base.status != 0:
        return None
    file = c.folder / "a.check"
    file.unlink(missing_ok=True)
    with subprocess.Popen(
            [c.cloth, *options(c.scene, c.folder), "--headless",
             "--checkpoint", file, "--every-seconds", "0"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as first:
        while first.poll() is None and not file.exists():
            time.sleep(.001)
        first.terminate()
        said = first.communicate(timeout=60)[1].decode().splitlines()
    if not file.exists() or first.returncode not in (0, 3, 143):
        return "refused", said
    again = Run(c.cloth, c.folder, ["--restart", "a.check", "--out",
                                    "end.net"])
    if again.bits != c.base.bits:
        return "bits", [f"status {again.status}", *again.said]
    return None


def files(c: Case) -> Broken:
    """A scene that was written and read again runs to the same bits; so a net
    that was written is read as it is."""
    if c.base.status != 0:
        return None
    wrote = c.run("--write-config", "a.toml")
    again = Run(c.cloth, c.folder, ["--config", "a.toml", "--out", "end.net"])
    if wrote.status or again.bits != c.base.bits:
        return "config", [f"status {again.status}", *again.said]
    if "nan" in c.base.bits or any(f in c.scene for f in ("tear", "pin")):
        return None
    (c.folder / "b.net").write_text(c.base.bits)
    same = Run(c.cloth, c.folder, ["b.net", "--t-end", "0", "--gravity", "0",
                                   "--out", "end.net"])
    if same.status or sorted(same.bits.split("\n")) != sorted(
            c.base.bits.split("\n")):
        return "net", [f"status {same.status}", *same.said]
    return None


def same_bits(c: Case) -> Broken:
    """Threads change no bit."""
    if c.base.status != 0:
        return None
    other = c.run("--threads", "3")
    return None if other.bits == c.base.bits else ("threads", other.said)


def symmetry(c: Case) -> Broken:
    """In other units the numbers are the same, scaled: to the bit for the
    explicit methods by fixed steps."""
    if c.base.status != 0:
        return None
    length, time = 4., .5
    other = c.run(**scaled(c.scene, length, time))
    if other.status != 0:
        return "status", [f"status {other.status}", *other.said]
    x, v, _, _ = c.base.net
    y, w, _, _ = other.net
    if len(x) != len(y):
        return "nodes", [f"{len(x)} and {len(y)} nodes are left"]
    off = max(np.abs(y / length - x).max(initial=0) / np.ptp(x, axis=0).max(
        initial=1e-9), 0)
    exact = c.fixed and c.scene.get("method", "") in EXPLICIT
    if off > (0 if exact else 1e-6):
        return "units", [f"positions differ by {off:.1e} of the size"]
    return None


def tolerance(c: Case) -> Broken:
    """Kept is true; a horizon is told only in chaos."""
    if "tolerance" not in c.scene or "dt" in c.scene:
        return None
    wanted = c.scene["tolerance"]
    if c.truth.bar > .1 * wanted:
        raise Chaos("the truth is known to %.1e m" % c.truth.bar)
    if c.base.status == 3 and c.truth.growth < 1e3:
        return "refused", c.base.said
    if c.base.status == 0:
        off = rms(c.same_nodes()[0] - c.truth.x[c.truth.alive])
        if off > wanted:
            return "not kept", [f"{off:.2e} m for {wanted} m"]
    return None


def remedy(c: Case) -> Broken:
    """What is named works, run as it stands."""
    named = re.search(r"((?:--(?:dt|method) \S+ ?(?:and )?)+)works",
                      " ".join(c.base.said))
    if not named:
        return None
    words = re.findall(r"(--dt|--method) (\S+)", named.group(1))
    again = c.run(**{option[2:]: value if option == "--method" else
                     float(value) for option, value in words})
    if again.status != 0:
        return "fails", [named.group(0), *again.said]
    return None


PROMISES = {f.__name__: f for f in (
    healthy, sick, end, measure, balance, limit, restart, files, symmetry,
    tolerance, same_bits, remedy)}
