"""Run the cloth with graphs that others could have written:  make graphs

Each folder here has a Graph.hpp with the interface of the assignment and no
more: another way to store a graph. These and the graph of the level open must
run all five stages of mass_spring.cpp, with the energies and the nodes left of
the solution's graph. The motion of grid0 is not chaotic until 2 s; so energies
differ by round-off alone.  ONLY=NAME runs one of them.
"""
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "course/kit"))

import child  # noqa: E402

BUILD = ROOT / os.environ.get("BUILD", "build") / "graphs"
GRID = ["data/grid0.nodes", "data/grid0.tets", "0.001", "2"]
STAGES = ("problem1", "diagonals", "forces", "constraints", "tear")
LIMIT = 300     # seconds
NEAR = 1e-6     # joules
LINE = re.compile(r"t = (\S+) s, energy (\S+) J, (\d+) nodes")


class Fault(Exception):
    pass


def run(graph: pathlib.Path) -> list[list[tuple[str, float, int]]]:
    """For each stage the lines that it prints: (time, energy, nodes)."""
    folder = BUILD / graph.parent.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file in (graph, ROOT / "mass_spring.hpp", ROOT / "mass_spring.cpp",
                 HERE / "stages.cpp"):
        shutil.copy(file, folder)
    command = [*shlex.split(os.environ.get("CXX", "g++")), "-std=c++20", "-O0",
               "-Wall", "-Wextra", "-Werror", "-D_GLIBCXX_ASSERTIONS",
               f"-I{folder}", f"-I{ROOT}", "-o", folder / "stages",
               folder / "stages.cpp"]
    for what, words in (("to compile", command),
                        ("to run", [folder / "stages", *GRID])):
        done = child.run(words, LIMIT, cwd=ROOT, capture_output=True,
                         text=True)
        if done.returncode:
            lines = [line for line in done.stderr.splitlines()
                     if "error:" in line] or done.stderr.splitlines() or [""]
            raise Fault(f"expected {what}, got: {lines[0]}")
    stages: list[list[tuple[str, float, int]]] = []
    for line in done.stdout.splitlines():
        if " steps of " in line:
            stages.append([])
        elif match := LINE.fullmatch(line):
            stages[-1].append((match[1], float(match[2]), int(match[3])))
    return stages


def compare(stages: list[list[tuple[str, float, int]]],
            expected: list[list[tuple[str, float, int]]]) -> float:
    """Throw a Fault at the first line that differs.  The largest difference of
    the energies [J]."""
    largest = 0.0
    for name, ours, theirs in zip(STAGES, expected, stages, strict=True):
        for (t, energy, nodes), other in zip(ours, theirs, strict=True):
            if other[2] != nodes:
                raise Fault(f"{name}: expected {nodes} nodes at {t} s, "
                            f"got {other[2]}")
            apart = abs(other[1] - energy)
            if not apart < NEAR:
                raise Fault(f"{name}: expected the energy {energy} J at {t} s,"
                            f" got {other[1]} J")
            largest = max(largest, apart)
    return largest


def main() -> int:
    graphs = [*sorted(HERE.glob("*/Graph.hpp")),
              ROOT / "course/starter/open/Graph.hpp"][
                  int(os.environ.get("FIRST") or 0)::
                  int(os.environ.get("EVERY") or 1)]
    if only := os.environ.get("ONLY"):
        graphs = [graph for graph in graphs if graph.parent.name == only]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(run, graph)
                for graph in (ROOT / "Graph.hpp", *graphs)]
        expected = runs[0].result()
        left = [stage[-1][2] for stage in expected]
        for graph, of_graph in zip(graphs, runs[1:]):
            name = graph.parent.name
            try:
                apart = compare(of_graph.result(), expected)
                print(f"ok    {name}: {left} nodes left, energies within "
                      f"{apart:.0e} J", flush=True)
            except Fault as fault:
                failed += 1
                print(f"FAIL  {name}: {fault}", flush=True)
    print(f"{len(graphs) - failed} passed, {failed} failed")
    return int(failed != 0 or not graphs)


if __name__ == "__main__":
    sys.exit(main())
