#!/usr/bin/env python3
"""Hold what the pages say about usual mistakes to the program that makes them.

    course/pictures/test_mistakes.py

Each passage below has to be in its page once {start} and {energy} [J] are the
energies that the program of that mistake prints first and last, and {end} [s]
is the time at which it stops because it has diverged. The last line counts the
passages. Exit status: 0 if all are right, else 1."""
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import draw  # noqa: E402

DIVERGED = "`diverged: at t = {end:g} s it gains energy from nothing`"
# A page, what it says, the mistake, the stage, and the end [s].
PASSAGES = [
    ("4.2", "`t = 0 s, energy {start:.4f} J`", "first length", "diagonals",
     0.1),
    ("4.2", "{start:.0f} J at the start", "no length", "diagonals",
     0.1),
    ("5.1", DIVERGED, "no mass", "forces", 5),
    ("5.1", "rises to {energy:.0f} J within 0.3 s", "gravity twice", "forces",
     0.3),
    ("5.1", "{energy:.0f} J at 1.2 s", "+ c v", "forces", 1.2),
    ("5.1", "the energy falls to {energy:.1f} J at 3 s", "damped", "forces", 3),
    ("6.1", "it falls to {energy:.1f} J", "", "constraints", 3),
    ("6.1", "the energy rises to {energy:.0f} J at 3 s", "floor keeps v",
     "constraints", 3),
    ("6.1", DIVERGED, "ball keeps v", "constraints", 5),
]


def words(program, end):
    """What a program says: {"start": [J], "energy": [J], "end": [s]}."""
    out = subprocess.run(
        [program, "data/grid1.nodes", "data/grid1.tets", "0.001", str(end)],
        cwd=draw.ROOT, timeout=300, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT).stdout
    energy = re.findall(r"energy (\S+) J", out)
    stop = re.findall(r"diverged: at t = (\S+) s", out)
    return {"start": float(energy[0]), "energy": float(energy[-1]),
            "end": float((stop or [end])[-1])}


def main():
    wrong = 0
    for page, passage, mistake, stage, end in PASSAGES:
        text = " ".join((draw.HERE.parent / f"{page}.md").read_text().split())
        with tempfile.TemporaryDirectory() as folder:
            program = draw.compiled(pathlib.Path(folder), mistake, stage,
                                    draw.PROGRAM)
            expected = passage.format(**words(program, end))
        if expected not in text:
            print(f"course/{page}.md:1: {mistake or 'the solution'}: expected "
                  f"{expected!r}")
            wrong += 1
    print(f"{len(PASSAGES) - wrong} passed, {wrong} failed")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
