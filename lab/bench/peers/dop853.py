#!/usr/bin/env python3
"""scipy's DOP853 beside the methods of peers.cpp:

    lab/bench/peers/dop853.py PEERS CSV

adds its runs to the CSV file of the program PEERS, which evaluates the forces:
so the kernel and the reference are those of all others. Force evaluations are
counted; there are no times, as most of the time is that of Python. Needs numpy
and scipy; without them it says so and adds nothing."""
import subprocess
import sys

try:
    import numpy as np
    from scipy.integrate import solve_ivp
except ImportError as missing:
    print(f"dop853.py: {missing}: runs of scipy's DOP853 are left out; make "
          "peers-deps installs numpy and scipy", file=sys.stderr)
    sys.exit(0)


class Problem:
    """A problem of PEERS, whose process lives as long as this. start, right:
    positions [m]. floor: error of the right ones [m]."""

    def __init__(self, program, name):
        self.process = subprocess.Popen([program, name], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE)
        size, end, floor = self.process.stdout.readline().split()
        self.size, self.end, self.floor = int(size), float(end), float(floor)
        self.start, self.right = self.read(), self.read()

    def read(self):
        return np.frombuffer(self.process.stdout.read(8 * self.size))

    def derivative(self, _, y):
        """(x, v)' for y = (x, v)"""
        self.process.stdin.write(y[:self.size].tobytes())
        self.process.stdin.flush()
        return np.concatenate((y[self.size:], self.read()))

    def run(self, tolerance):
        """(force evaluations, error [m])"""
        start = np.concatenate((self.start, np.zeros(self.size)))
        found = solve_ivp(self.derivative, (0, self.end), start, "DOP853",
                          rtol=tolerance, atol=tolerance)
        if not found.success:
            sys.exit(f"dop853.py: {found.message}")
        off = found.y[:self.size, -1] - self.right
        return found.nfev, np.sqrt(3 * np.mean(off ** 2))


def main():
    program, path = sys.argv[1:]
    with open(path, encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    with open(path, "a", encoding="utf-8") as file:
        for name in dict.fromkeys(line.split(",")[0] for line in lines[1:]):
            problem, tolerance, error = Problem(program, name), 1e-2, 1
            while error > 10 * problem.floor and tolerance > 1e-13:
                evaluations, error = problem.run(tolerance)
                file.write(f"{name},scipy-dop853,{tolerance:g},{evaluations},"
                           f",,{error:g},{problem.floor:g}\n")
                tolerance /= 2
            problem.process.communicate()


if __name__ == "__main__":
    main()
