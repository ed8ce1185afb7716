#!/usr/bin/env python3
"""How near rounds come to the step of implicit Euler, and for how much work:

    lab/bench/rounds.py PROGRAM > rounds.csv

PROGRAM is bench_rounds. Instructions are counted by callgrind (valgrind, which
has no AVX-512) in one step of each method with one and with two rounds: a
constant, a multiple of the rounds and one of the products with the matrix."""
from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

STIFFNESS = dict.fromkeys((25, 81), ("1e2", "1e4", "1e6", "1e8"))  # [N/m]
METHODS = ("xpbd", "newton-gradients", "newton-factor")
# 1/60 s is Verlet's limit on 25 x 25 nodes of this K [N/m].
AT_LIMIT = "1.92"


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, check=True, text=True, capture_output=True,
                          timeout=3600)


def counted(program: str, side: int, K: str, method: str,
            rounds: int) -> tuple[int, int]:
    """(instructions, products) of a step, after a first one."""
    with tempfile.TemporaryDirectory() as folder:
        done = run("valgrind", "--tool=callgrind", "--collect-atstart=no",
                   "--toggle-collect=*measured*",
                   f"--callgrind-out-file={folder}/out", program, str(side), K,
                   method, str(rounds))
    return (int(re.findall(r"Collected : (\d+)", done.stderr)[0]),
            int(done.stdout))


def model(one: tuple[int, int], two: tuple[int, int],
          soft: tuple[int, int]) -> tuple[float, float, float]:
    """(once a step, for a round, for a product) [instructions], from steps of
    one and of two rounds, and of one round with other products."""
    product = ((one[0] - soft[0]) / (one[1] - soft[1])
               if one[1] != soft[1] else 0)
    each = two[0] - one[0] - (two[1] - one[1]) * product
    return one[0] - each - one[1] * product, each, product


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = sys.argv[1]
    with ThreadPoolExecutor(4) as pool:
        def later(*job):
            return pool.submit(counted, program, *job)
        errors = {(side, K): pool.submit(run, program, str(side), K)
                  for side in sorted(STIFFNESS, reverse=True)
                  for K in STIFFNESS[side]}
        force = {side: [later(side, AT_LIMIT, "verlet", n) for n in (1, 33)]
                 for side in STIFFNESS}
        step = later(25, AT_LIMIT, "xpbd", 10)
        parts = [later(25, "mixed", m, n) for m, n in (
            ("verlet", 1), ("verlet", 33), ("mollified-impulse", 1),
            ("mollified-impulse", 101))]
        cost = {(side, m): [later(side, "1e4", m, 1), later(side, "1e4", m, 2),
                            later(side, "1e2", m, 1)]
                for side in STIFFNESS for m in METHODS}
    unit = {side: (more.result()[0] - one.result()[0]) / 32
            for side, (one, more) in force.items()}
    print("# instructions are told in steps of verlet, of " + " and ".join(
        f"{u:,.0f} on {side} x {side} nodes" for side, u in unit.items()))
    print(f"# a step at verlet's limit xpbd: {step.result()[0] / unit[25]:.3g}")
    least, most, one, more = (job.result()[0] for job in parts)
    inner, force = (more - one) / 100, (most - least) / 32
    step = one - inner - (least - force)  # without what a call takes
    print(f"# mollified-impulse on mixed: {step / force:.3g} a step, "
          f"{inner / force:.3g} an inner step")
    for (side, m), jobs in cost.items():
        cost[side, m] = [c / unit[side]
                         for c in model(*(job.result() for job in jobs))]
        print("# {0} x {0} {1}: {2:.3g} once, {3:.3g} a round, {4:.3g} a "
              "product".format(side, m, *cost[side, m]))
    print("nodes,K [N/m],method,rounds,products,work [verlet steps],"
          "from step [m],from motion [m],moved [m]")
    for side, some in STIFFNESS.items():
        for K in some:
            for line in errors[side, K].result().stdout.splitlines():
                nodes, _, m, rounds, products, *rest = line.split(",")
                once, each, product = cost[side, m]
                work = once + int(rounds) * each + int(products) * product
                print(",".join((nodes, K, m, rounds, products, f"{work:.4g}",
                                *rest)))


if __name__ == "__main__":
    main()
