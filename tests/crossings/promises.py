"""What a run promises: one function each. It gets a Case, and returns nothing
if the promise is kept, or says what was expected and what came."""
import pathlib
import re
import shlex
import subprocess
import time
import zlib
from functools import cached_property
from resource import RLIMIT_CPU, setrlimit
from signal import SIGXCPU
from typing import Any

import numpy as np
from numpy.linalg import norm
from scipy.optimize import nnls

import oracle
from oracle import LIMIT, Array, End, Net, Scene
from scenes import options, scaled

# The kind of a broken promise, and what was seen.
Broken = tuple[str, list[str]] | None


def joined(text: str) -> str:
    """Lines that were broken for a terminal, whole again."""
    return re.sub(r"\n +", " ", text)


class Run:
    """A run of ./cloth: its status, what it said, the state at its end."""

    def __init__(self, cloth: str, folder: pathlib.Path, *arguments: str):
        files = [folder / "end.net", folder / "rows.csv"]
        for file in files:
            file.unlink(missing_ok=True)
        done = subprocess.run(
            [cloth, *arguments, "--headless", "--out", "end.net"],
            capture_output=True, text=True, timeout=600, cwd=folder,
            preexec_fn=lambda: setrlimit(RLIMIT_CPU, (60, 60)))
        if done.returncode == -SIGXCPU:
            raise subprocess.TimeoutExpired(done.args, 60)
        self.status, self.text = done.returncode, joined(done.stdout)
        # Each with its cure and its place, without how far a slow run is.
        self.said = [" ".join(a.split()) for a in re.findall(
            r"^cloth:.*(?:\n(?!cloth:|t = ).*)*", done.stderr, re.M)]
        self.bits, self.rows = (
            f.read_text() if f.exists() else "" for f in files)

    @cached_property
    def csv(self) -> dict[str, np.ndarray]:
        """The columns, by name."""
        names, *rows = self.rows.split()
        table = np.array([r.split(",") for r in rows], float)
        return dict(zip(names.split(","), table.T))

    @cached_property
    def net(self) -> tuple:
        """x, v, masses, springs (i, j, K, L) of the last state."""
        nodes = [re.sub("mass|velocity|held", "", line + " 0 0 0").split()
                 for line in re.findall("^node (.*)", self.bits, re.M)]
        springs = re.findall(
            "^spring (.*?)(?: cable| strut)?$", self.bits, re.M)
        a = np.array([n[:7] for n in nodes], float).reshape(-1, 7)
        return (a[:, :3], a[:, 4:], a[:, 3],
                np.array([s.split() for s in springs], float).reshape(-1, 4))

    def answer(self) -> list[float] | None:
        """The numbers of the measure, as printed; or None."""
        found = re.findall(r"^[a-z].*?: (.*?)(?: [a-zA-Z]+)? (?:at|until) t = ",
                           self.text, re.M)
        return [float(a) for a in found[-1].split()] if found else None


class Case:
    """A scene, its run and the truth, each computed when it is asked for."""

    def __init__(self, cloth: str, folder: pathlib.Path, scene: Scene):
        self.cloth, self.folder, self.scene = cloth, folder, scene
        self.fixed = isinstance(scene.get("dt"), float)
        self.contact = any(f in scene for f in oracle.CONTACT)
        self.number = zlib.crc32(str(scene).encode())  # chooses samples

    def run(self, *more: str, **other: Any) -> Run:
        """A run with other options, and with other values of fields."""
        return Run(self.cloth, self.folder, *options(
            self.scene | other, self.folder), *more)

    @cached_property
    def base(self) -> Run:
        return self.run("--csv", "rows.csv", "--every", "1")

    @cached_property
    def made(self) -> Run:
        """The scene before its first step."""
        return self.run(**{"t-end": 0.})

    @cached_property
    def rest(self) -> Run:
        """Where a scene with from-rest begins, before it tears."""
        whole = {f: a for f, a in self.scene.items() if "tear" not in f}
        return Run(self.cloth, self.folder, *options(
            whole | {"t-end": 0.}, self.folder))

    @cached_property
    def truth(self) -> End:
        scene, end = self.scene, self.scene["t-end"]
        if "from-rest" in scene:
            scene = scene | {"rest": self.rest.net[:2]}
        steps = (end / self.scene["dt"] if self.fixed else
                 len(self.base.csv["t"]) - 1)
        return oracle.truth(scene, end, end / float(
            np.clip(steps, 50, 1000)))

    @property
    def exact(self) -> float:
        """How certain the truth is, as a share of the size."""
        return self.truth.bar / self.truth.size

    def nets(self) -> tuple[Net, Net]:
        """At the start, and after the changes."""
        first, last = Net(self.scene), Net(self.scene)
        for _, request in self.scene.get("at", []):
            last.change(request)
        return first, last

    def error(self, run: Run | None = None) -> tuple[float, float]:
        """How far the end of a run is from the truth: of the farthest node, as
        a share of the size; of the energy, as one of the internal energy. Not
        numbers, if other nodes are left."""
        truth, (x, v, _, _) = self.truth, (run or self.base).net
        if len(x) != truth.alive.sum():
            return np.nan, np.nan
        place = np.abs(x - truth.x[truth.alive]).max() / truth.size
        if not np.isfinite(place):
            return place, 0.
        mine, theirs = np.zeros((2, *truth.x.shape)), np.array(
            [truth.x, truth.v]) * truth.alive[:, None]
        mine[:, truth.alive] = x, v
        a, b = (sum(truth.net.energies(*state).values())
                for state in (mine, theirs))
        return place, abs(a - b) / max(truth.internal, 1e-12)

    @property
    def sound(self) -> bool:
        return (max(self.error()) < .01 and self.exact < .003 and
                self.answer_error() < .01)

    def answer_error(self) -> float:
        """How far the answer is from that of the truth, as a share."""
        truth, got = self.truth, self.base.answer()
        net, end = truth.net, self.scene["t-end"]
        wanted = quantity(self.scene["measure"], net, truth.x, truth.v, end)
        if wanted is None or got is None or not truth.alive.all():
            return 0.
        return float(np.abs(got - wanted).max() /
                     max(*np.abs(wanted), truth.internal * 1e-6, 1e-9))


def healthy(c: Case) -> Broken:
    """A run that the oracle calls sound ends with 0, without a warning."""
    if c.base.status not in (0, 3):
        return f"status {c.base.status}", c.base.said
    method = c.scene.get("method", "")
    if c.base.status == 3:  # it ended early: would a finer run do the same?
        if not c.fixed or method == "forward-euler":
            return None
        share = c.scene["dt"] * Net(c.scene).omega() / LIMIT.get(method, 2)
        if share < .3 and "at" not in c.scene and c.exact < .01:
            return "stopped", [f"{share:.2f} of the limit", *c.base.said]
    elif c.base.said and c.sound:
        said = [a for a in c.base.said if a not in c.made.said and
                "tunnelled" not in a and not re.search(
                    "moves .* m a step, more|moves up to", a)]
        if said:
            return "warned", ["off by %.1e, energy by %.1e" % c.error(), *said]
    return None


def sick(c: Case) -> Broken:
    """A run whose positions or energy are far off is not silent: half of its
    step differs by 4 % first, half of an error of order 1. The velocities of
    symplectic-euler are those of a step before."""
    parts = 1 if c.scene.get("method") == "symplectic-euler" else 2
    if not c.base.said and c.exact < .01 and max(c.error()[:parts]) > .15:
        return "silent", ["positions off by %.2f of the size, energy by %.2f, "
                          "and nothing said" % c.error()]
    return None


def end(c: Case) -> Broken:
    """The end converges to the truth with the step."""
    if not c.fixed:
        return None
    place, floor = c.error()[0], 3 * c.exact + (.005 if c.contact else 1e-6)
    if not floor <= place <= .1:
        return None
    better = [c.error(fine)[0] for share in (4, 16) if (
        fine := c.run(dt=c.scene["dt"] / share)).status == 0]
    if better and not min(better) <= .8 * place + floor:
        return "off", [f"off by {place:.2e} of the size; with a quarter and a "
                       "sixteenth of the step by "
                       + " and ".join(f"{a:.2e}" for a in better)]
    return None


def presses(net: Net, x: Array, v: Array, t: float) -> tuple[float, float]:
    """What the free nodes that touch press with: the least force along the
    outward normals that keeps each from moving in; and what is left of all
    forces. An inward velocity, which the next contact takes, feels no drag."""
    total, left, all_ = np.zeros(3), 0., net.force(x, v)
    size = norm(x, axis=1).max()
    touch = [(np.abs(depth) <= 1e-9 * (size + norm(p["at"])), out, w)
             for p, depth, out, w in oracle.obstacles(net.scene, x, t)]
    for k in set(range(net.n)) - set(net.held()):
        outs, u = [(out[k], w) for on, out, w in touch if on[k]], v[k]
        for out, w in outs:
            u = u - min(0, (u - w) @ out) * out
        N = np.transpose([out for out, _ in outs] or [np.zeros(3)])
        load = net.c[k] * (u - v[k]) - all_[k]
        press = N @ nnls(N, load)[0]
        total += press
        left = float(np.hypot(left, norm(load - press)))
    return float(norm(total)), left


def quantity(name: str, net: Net, x: Array, v: Array, t: float) -> Any:
    """The numbers of a measure at the end; None: nothing to compare with."""
    word, *rest = name.split()
    only = [k for k in range(3) if "xyz"[k] in rest] or [0, 1, 2]
    e, l = net.energies(x, v), norm(x[net.j] - x[net.i], axis=1)
    some = {"com": lambda: (net.m @ x / net.m.sum())[only],
            "energy": lambda: sum(e.values()),
            "kinetic-energy": lambda: e["kinetic"],
            "elastic-energy": lambda: e["elastic"],
            "tension": lambda: np.sum(net.tension(l)[
                (net.i == min(map(int, rest))) & (
                    net.j == max(map(int, rest)))]),
            "max-tension": lambda: np.max(net.tension(l), initial=0),
            "max-stretch": lambda: np.max(
                (l / net.L - 1)[net.L > 0], initial=0),
            "drape-height": lambda: x[:, 2].min(),
            "pin-force": lambda: norm(net.force(x, v)[net.held()].sum(0)),
            "contact-force": lambda: presses(net, x, v, t)[0]}
    return np.atleast_1d(some[word]()) if word in some else None


def measure(c: Case) -> Broken:
    """Each quantity is that of the state at the end; K, L and masses are those
    of the scene."""
    got, name, net = c.base.answer(), c.scene["measure"], c.nets()[1]
    x, v, m, springs = c.base.net
    late = any("after the end" in a for a in c.base.said)  # a change
    # The forces of xpbd are those of its multipliers.
    force = "force" in name or "tension" in name
    own = force and c.scene.get("method") == "xpbd"
    if got is None or late or own or (len(x), len(springs)) != net.C.shape:
        return None
    theirs, order = np.sort(springs[:, :2], axis=1), np.lexsort((net.j, net.i))
    K, L = springs[np.lexsort((theirs[:, 1], theirs[:, 0])), 2:].T
    for what, a, b in (("mass", m, net.m), ("K", K, net.K[order]),
                       ("L", L, net.L[order])):
        if not np.allclose(a, b, rtol=1e-9):
            return "material", [f"{what}: up to {np.abs(a - b).max():.3g} off"]
    wanted = quantity(name, net, x, v, c.scene["t-end"])
    scale = 1e-3 * np.abs(net.K * net.L).max(initial=0) * force
    if wanted is not None and (len(got) != len(wanted) or np.abs(
            got - wanted).max() > 2e-5 * max(scale, 1e-6, *np.abs(wanted))):
        return name.split()[0], [f"{name}: got {got}, expected {wanted}"]
    return None


def balance(c: Case) -> Broken:
    """energy - work + drag is constant where nothing touches, and never
    rises, as the step goes to 0; a chosen step may gain 10 %."""
    def off(run: Run) -> float:
        rows = run.csv
        internal = max((rows["kinetic"] + rows["elastic"]).max(), 1e-12)
        return rows["balance"][-1] / internal

    def bad(share: float) -> bool:
        most = .02 if c.fixed else .1
        return share > most or (share < -most and not c.contact)

    if any("obstacles give" in a for a in c.base.said):
        return None  # planes that contradict each other push at each step
    if not c.sound or not bad(first := off(c.base)):
        return None
    if c.fixed:  # work is a quadrature: a pin turns by 0.1 rad a step then
        turns = [norm(p.get("turn", 0)) for p in c.scene.get("pin", [])]
        fine = c.run("--csv", "rows.csv", "--every", "1", dt=min(
            c.scene["dt"] / 4, .1 / max(turns + [1e-9])))
        if fine.status or abs(off(fine)) < .5 * abs(first):
            return None
    return "off", [f"{first:.3f} of the internal energy; the motion is "
                   "right to {:.1e} {:.1e}".format(*c.error())]


def limit(c: Case) -> Broken:
    """The named limit is near the bound, of the stiffest stretch."""
    named = re.search(r"% of the stability limit \((\S+) s, (\S+)\)",
                      c.base.text)
    largest = LIMIT.get(named[2], 0) if named else 0
    if not named or not largest or {"damping", "drag"} & set(c.scene):
        return None
    got, bound = float(named[1]), max(n.omega() for n in c.nets()) / largest
    torn = "tear" in c.scene or (  # the limit is that of what is left
        "tear-strain" in c.scene and
        len(c.base.net[3]) < len(c.nets()[1].K))
    if not torn and bound and not .85 < got * bound < 1.02:
        return "other", [f"{got} s, expected {1 / bound:.4g} s"]
    return None


def rest(c: Case) -> Broken:
    """A scene from rest begins where no force is left, with velocities 0 if
    no obstacle hits it."""
    if "from-rest" not in c.scene:
        return None
    net, (x, v, _, _) = Net(c.scene), c.rest.net
    free = np.setdiff1d(np.arange(net.n), net.held())
    load = (norm(net.m[:, None] * net.g + net.load) + (net.K * net.L).max(
        initial=0) + norm(net.c) * norm(net.wind))
    left = presses(net, x, 0 * v, 0.)[1]
    hit = any("velocity" in p for field in ("plane", "sphere")
              for p in c.scene.get(field, []))
    if (np.any(v[free]) and not hit) or not left <= 1e-8 * load:
        return "moves", [f"{left:.2g} N of {load:.2g} N are left; the largest "
                         f"velocity is {norm(v[free], axis=1).max()} m/s"]
    return None


def restart(c: Case) -> Broken:
    """Stopped or killed somewhere and continued from a checkpoint: the same
    bits and rows."""
    file, rows = c.folder / "a.check", c.folder / "a.csv"
    for old in (file, rows):
        old.unlink(missing_ok=True)
    table = "--csv", "a.csv", "--every", "1"
    with subprocess.Popen(
            [c.cloth, *options(c.scene, c.folder), "--headless",
             "--checkpoint", file, "--every-seconds", "0", *table],
            cwd=c.folder, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE) as first:
        seen: set[int] = set()  # it is ended after so many checkpoints
        while first.poll() is None and len(seen) <= c.number // 2 % 16:
            time.sleep(.001)
            if file.exists():
                seen.add(file.stat().st_mtime_ns)
        (first.kill if c.number % 2 else first.terminate)()
        said = first.communicate(timeout=600)[1].decode().splitlines()
    if not file.exists() or first.returncode not in (0, 3, 143, -9):
        return "refused", [f"status {first.returncode}", *said]
    run = Run(c.cloth, c.folder, "--restart", "a.check", *table)
    return differs("bits", c, run) or (
        None if rows.read_text() == c.base.rows else ("rows", run.said))


def differs(kind: str, c: Case, run: Run) -> Broken:
    if run.bits == c.base.bits:
        return None
    return kind, [f"status {run.status}", *run.said]


def files(c: Case) -> Broken:
    """Written and read again, and by other threads: the same bits."""
    c.run("--write-config", "a.toml")
    return differs("config", c, Run(c.cloth, c.folder, "--config", "a.toml")
                   ) or differs("threads", c, c.run("--threads", "3"))


def symmetry(c: Case) -> Broken:
    """In other units the numbers are the same, scaled: to the bit for the
    explicit methods by fixed steps."""
    other = c.run(**scaled(c.scene, 4., .5))
    x, y = c.base.net[0], other.net[0]
    if other.status or len(x) != len(y):
        return "status", [f"status {other.status}, {len(y)} nodes, not "
                          f"{len(x)}", *other.said]
    size = np.ptp(x, axis=0).max(initial=1e-9)
    off = np.abs(y / 4 - x).max(initial=0) / size
    exact = c.fixed and c.scene.get("method") in LIMIT
    if off > (0 if exact else 1e-6):
        return "units", [f"positions differ by {off:.1e} of the size"]
    return None


def remedy(c: Case) -> Broken:
    """What is named works, run as it stands."""
    named = re.search(r"((?:--(?:dt|method) \S+ ?(?:and )?)+)works",
                      " ".join(c.base.said))
    if named:
        cure = {word: value if word == "method" else float(value) for
                word, value in re.findall(r"--(dt|method) (\S+)", named[1])}
        if c.scene["t-end"] / cure.get("dt", np.inf) > 2e5:
            return None
        again = c.run(**cure)
        if again.status != 0:
            return "fails", [named[0], *again.said]
    return None


def tolerance(c: Case) -> Broken:
    """A tolerance that is said to be kept is kept; only in chaos it is not."""
    said = re.search(r"^positions to (\S+) m: (kept;|kept to|predictable to)",
                     c.base.text, re.M)
    if not said or not c.exact < .01:
        return None
    x, truth = c.base.net[0], c.truth
    if len(x) != truth.alive.sum():
        return None
    asked, off = float(said[1]), oracle.rms(x - truth.x[truth.alive])
    if said[2] == "kept;" and off > asked + 3 * truth.bar:
        return "kept", [f"asked for {asked:g} m, off by {off:.2e} m"]
    if said[2] != "kept;" and not c.contact and c.exact < 1e-8:
        return "horizon", [said[0], "and a twin of the motion stays near"]
    return None


def advice(c: Case) -> Broken:
    """(A sample) The advised run, as it stands, warns of nothing and meets the
    tolerance; what a coarser or finer sheet does is no question here."""
    got, name = c.base.answer(), c.scene["measure"]
    if c.number % 16 or not got or not any(got) or not (
            c.fixed and c.exact < 1e-4):
        return None
    asked = .05 * max(np.abs(got))
    text = c.run("--advise", "--advise-work", "2e7",
                 "--tolerance", repr(asked)).text
    if not (found := re.search(r"\./cloth (.*? --headless)", text)):
        return None
    run = Run(c.cloth, c.folder, *shlex.split(found[1]))
    usual = [a.split()[2:4] for a in c.made.said]
    said = [a for a in run.said if a.split()[2:4] not in usual]
    if run.status or said:
        return ("refused" if run.status == 2 else "warns"), [
            found[0], f"status {run.status}", *said]
    wanted = None if "sheet" in c.scene or (
        c.contact and "force" in name) else quantity(
            name, c.truth.net, c.truth.x, c.truth.v, c.scene["t-end"])
    if wanted is not None and not np.abs(
            np.subtract(run.answer() or np.nan, wanted)).max() <= asked:
        return "off", [found[0], f"{run.answer()}, expected {wanted}, to "
                       f"{asked:.2g}"]
    return None


PROMISES = {f.__name__: f for f in (
    healthy, sick, end, measure, balance, limit, rest, restart, files, symmetry,
    remedy, tolerance, advice)}


def broken(c: Case, promise: str) -> Broken:
    """What is wrong with a run that was not refused."""
    early = ("healthy", "limit", "remedy")
    if c.base.status == 2 or (c.base.status and promise not in early):
        return None
    return PROMISES[promise](c)
