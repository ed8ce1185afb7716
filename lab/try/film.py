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


def scene_of(verdict: judge.Verdict) -> str:
    """The scene of section 6.2 on grid1, run by both methods."""
    most = .8 * verdict.limit / OMEGA if verdict.limit else .001
    dt = min(.001 * max(1, verdict.evaluations), most)
    lines = (ROOT / "data/scenes/constraints.toml").read_text("utf-8")
    keep = [line for line in lines.splitlines() if not line.startswith(
        ("#", "dt", "method", "t-end"))]
    scene = [f'nodes = "{ROOT}/data/grid1.nodes"',
             f'tets = "{ROOT}/data/grid1.tets"', *keep, f"dt = {dt!r}",
             f"t-end = {SECONDS}", 'method = "yours"']
    share = dt / max(1, verdict.evaluations) * OMEGA / 2
    return "\n".join([*scene, f'change = "0 compare verlet {share!r}"', ""])


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
        scene = folder / f"{verdict.step}.toml"
        scene.write_text(scene_of(verdict), "utf-8")
        print(f"white: {verdict.step}; orange: Verlet, with equal work",
              flush=True)
        return subprocess.run(
            [folder / "cloth", "--config", scene, "--record", out],
            check=False).returncode
