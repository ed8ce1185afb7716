"""Count what a graph costs beside that of the course and flat arrays:

    make try GRAPH=Graph.hpp      lab/try/README.md

Callgrind counts instructions, so the result does not depend on what else the
machine does."""

import concurrent.futures
import math
import re
import shutil

import judge
import sandbox      # from course/kit, found by workshop
from workshop import ROOT, BadInput, Workshop

SIZES = (12, 24, 48)        # nodes along a side
PARTS = ("building", "forces", "removal")
ABOUT = {"building": "building, for a node and its springs",
         "forces": "forces of the springs, for a node",
         "removal": "removal of a node"}
LIMITS = sandbox.Limits(cpu=60, wall=240, memory=2 << 30, size=64 << 20)


def shop_of(path, *flags):
    shop = Workshop(path, "Graph", 0, source="graph.cpp",
                    defines=["-DNDEBUG", *flags])
    shop.prelude = None     # it has the course's own graph
    return shop


def count(shop, n):
    """({part: instructions}, what it printed) for n x n nodes; None if it
    takes too long."""
    folder = shop.folder / f"count-{n}"
    folder.mkdir()
    words = [*shop.jail]
    for name in ("/usr", "/lib", "/lib64", "/bin", "/proc", shop.folder):
        words += ["--read", str(name)]
    for name in (folder, "/dev/null"):
        words += ["--write", str(name)]
    done = sandbox.run_compiler(words, [
        "/bin/sh", shutil.which("valgrind"),    # a script
        "--tool=callgrind", "--vgdb=no", "-q",
        "--toggle-collect=measured", "--dump-after=measured",
        f"--callgrind-out-file={folder}/out", str(shop.programs["fast"]),
        str(n)], folder, folder, LIMITS)
    if done.stopped:
        return None
    counts = []
    for k, part in enumerate(PARTS, 1):
        try:
            text = (folder / f"out.{k}").read_text(encoding="utf-8")
        except OSError:
            raise BadInput(f"{shop.where}: ends under valgrind: "
                           + (done.output.strip().split("\n")[-1]
                              or f"status {done.code}")) from None
        counts.append(int(re.search(r"^summary: (\d+)", text, re.M)[1]))
    counts[2] *= 4              # a quarter of the nodes is removed
    counts = [c / (n * n) for c in counts]
    return dict(zip(PARTS, counts)), done.output.strip()


def counted(shop):
    """{n: count()} of the sizes that do not take too long."""
    found = {}
    for n in SIZES:
        result = count(shop, n)
        if result is None:
            break
        found[n] = result
    return found


def power(of, part):
    """p if the cost of one node grows as N^p, from the two largest sizes."""
    n0, n1 = sorted(of)[-2:]
    a, b = of[n0][0][part], of[n1][0][part]
    return math.log(b / a) / (2 * math.log(n1 / n0)) if a > 0 < b else 0


def judged(v, own, ours, flat):
    largest = max(own)
    printed = own[largest][1], ours[largest][1]
    if printed[0].split()[:4] != printed[1].split()[:4]:
        v.faults.append(("the springs' forces are not those of the course's "
                         f"graph: {printed[0]}, expected {printed[1]}",
                         "Run test_nodes and test_edges first."))
    elif printed[0] != printed[1]:
        v.faults.append((f"after the removal it has {printed[0].split()[-1]} "
                         f"nodes, expected {printed[1].split()[-1]}",
                         "Run test_nodes and test_edges first."))
    for part in PARTS:
        p, a = power(own, part), own[largest][0][part]
        b, c = ours[largest][0][part], flat[largest][0][part]
        words = (f"{a:,.0f} instructions ({largest * largest} nodes), "
                 f"{a / b:.3g} times the course's graph")
        if part != "removal":
            words += f", {a / c:.3g} times flat arrays"
        words += f"; grows as N^{p:.2f}" if p > .05 else \
            "; does not grow with N"
        v.facts.append((ABOUT[part], words))
        if p > .3:
            v.faults.append((f"{ABOUT[part]}: it costs more in a larger graph, "
                             f"as N^{p:.2f}", ADVICE[part]))
    v.is_a = f"it is a graph that runs the cloth of {largest * largest} nodes"
    if largest < SIZES[-1]:
        v.notes.append(f"{SIZES[-1]}^2 nodes take more than {LIMITS.cpu} s "
                       "under valgrind")
    v.advice = v.faults[0][1] if v.faults else (
        "Its costs do not grow with the graph: what is left is a factor, "
        "mostly in how a spring finds its two ends.")
    v.data["costs"] = {name: {n: of[n][0] for n in of} for name, of in (
        ("yours", own), ("course", ours), ("flat arrays", flat))}


ADVICE = {
    "building": "add_edge looks for an edge that may be there: look only at "
    "the edges of one of the two nodes, not at all.",
    "forces": "The edges at a node should be in a list of that node, so that "
    "nobody has to look through all.",
    "removal": "Move the last element into the hole, in place of moving all "
    "that come after it, and look only at the edges of the node."}


def measure(path, say=lambda _: None):
    """The Verdict on a graph, or BadInput."""
    if not shutil.which("valgrind"):
        raise BadInput("make try GRAPH=: valgrind is missing, which counts "
                       "instructions: make try-deps")
    if not path.exists():
        raise BadInput(f"{path}: No such file or directory")
    shops = []
    try:
        for file, *flags in ((path,), (ROOT / "Graph.hpp",),
                             (ROOT / "Graph.hpp", "-DTRY_FLAT")):
            shops.append(shop_of(file, *flags))
            say(f"compiling {len(shops)} of 3 ...")
            shops[-1].compile()
            if len(shops) == 1:
                _, outcome = shops[0].run(str(SIZES[0]))
                if outcome.code or outcome.stopped:
                    raise BadInput(shops[0].why(str(SIZES[0]), outcome))
        say("counting ...")
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            own, ours, flat = pool.map(counted, shops)
        if len(own) < 2:
            raise BadInput(f"{shops[0].where}: {SIZES[1]} x {SIZES[1]} nodes "
                           f"take more than {LIMITS.cpu} s under valgrind")
        v = judge.Verdict("Graph")
        judged(v, own, ours, flat)
        return v
    finally:
        for shop in shops:
            shop.close()
