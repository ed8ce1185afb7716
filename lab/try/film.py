"""A film of a step of your own beside Verlet:

    make try FILE=mine.hpp RECORD=film.mp4

The step becomes the method "yours" of a ./cloth of its own. Both cloths fall
onto the ball of the assignment, with equal work. Here the file runs outside of
the jail: it has been measured before, and it is yours."""

import math
import os
import pathlib
import subprocess
import tempfile

import judge
from workshop import BUILT, ROOT, BadInput, choose

OMEGA = math.sqrt(12 * 100 * 625)   # of grid1, at most [1/s]
SECONDS = 2                         # of the scene


def recording(verdict: judge.Verdict) -> str:
    """The requests for a run of the scene of section 6.2 on grid1 by both
    methods."""
    most = .8 * verdict.limit / OMEGA if verdict.limit else .001
    dt = min(.001 * max(1, verdict.evaluations), most)
    lines = (ROOT / "data/scenes/constraints.toml").read_text("utf-8")
    keep = [line for line in lines.splitlines() if not line.startswith(
        ("#", "dt", "method", "t-end"))]
    scene = [f'nodes = "{ROOT}/data/grid1.nodes"',
             f'tets = "{ROOT}/data/grid1.tets"', *keep, f"dt = {dt!r}",
             "t-end = 5", 'method = "yours"']
    return "\n".join(["mass_spring input 1", f'0 scene 0 0 "{verdict.step}"',
                      *(f"| {line}" for line in scene),
                      "0 compare verlet 1 equal-work",
                      f"{int(SECONDS / dt)} end", ""])


def record(verdict: judge.Verdict, path: pathlib.Path, out: str) -> int:
    """Build ./cloth with the step, and write its film; its exit status."""
    if choose(path, verdict.step)[1] != 5:
        raise BadInput(f"{path}:1: {verdict.step} takes no constraint, "
                       "expected one: the scene has pins and a ball")
    limit = verdict.limit if math.isfinite(verdict.limit) else "no_limit"
    BUILT.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=BUILT) as name:
        folder = pathlib.Path(name)
        built = subprocess.run(
            ["make", "-s", "try_film"], cwd=ROOT, check=False,
            stdin=subprocess.DEVNULL, timeout=1800,
            env={**os.environ, "TRY_FILE": str(path.resolve()),
                 "TRY_STEP": verdict.step, "TRY_LIMIT": str(limit),
                 "TRY_ORDER": str(verdict.order or 0), "TRY_OUT":
                 str(folder / "cloth"),
                 "TRY_SWEEPS": str(max(1, verdict.evaluations))})
        if built.returncode:
            raise BadInput(f"{path}:1: {verdict.step} does not compile as a "
                           "method of the laboratory")
        (folder / "both.txt").write_text(recording(verdict), "utf-8")
        print(f"white: {verdict.step}; orange: Verlet, with equal work",
              flush=True)
        return subprocess.run(
            [folder / "cloth", "--replay", folder / "both.txt", "--record",
             out], check=False).returncode
