"""A film of a step of your own:

    make try FILE=mine.hpp RECORD=film.mp4

A cloth falls onto the ball of the assignment. The step is the method "yours" of
a ./cloth in the jail, without a window. That writes where its nodes are;
another ./cloth, which draws, puts them there."""

import math
import os
import pathlib
import subprocess

import judge
from workshop import ROOT, BadInput, Workshop, choose, sandbox

OMEGA = math.sqrt(12 * 100 * 625)   # of grid1, at most [1/s]
SECONDS = 2                         # of the scene
LIMITS = sandbox.Limits(cpu=60, wall=240, memory=1 << 30, output=1 << 20)
MOST = 1 << 30                      # bytes of states


def scene_of(verdict: judge.Verdict) -> str:
    """The scene of section 6.2 on grid1, run by "yours"."""
    most = .8 * verdict.limit / OMEGA if verdict.limit else .001
    dt = min(.001 * max(1, verdict.evaluations), most)
    lines = (ROOT / "data/scenes/constraints.toml").read_text("utf-8")
    keep = [line for line in lines.splitlines() if not line.startswith(
        ("#", "dt", "method", "t-end"))]
    return "\n".join([
        f'nodes = "{ROOT}/data/grid1.nodes"',
        f'tets = "{ROOT}/data/grid1.tets"', *keep, f"dt = {dt!r}",
        f"t-end = {SECONDS}", 'method = "yours"', ""])


def programs(shop: Workshop, verdict: judge.Verdict) -> tuple[
        pathlib.Path, pathlib.Path]:
    """(the ./cloth that draws, the one in the jail)"""
    limit = verdict.limit if math.isfinite(verdict.limit) else "no_limit"
    defines = [f"-DTRY_ORDER={verdict.order or 0}", f"-DTRY_LIMIT={limit}",
               f"-DTRY_SWEEPS={max(1, verdict.evaluations)}"]
    draws = shop.folder / "cloth"
    made = subprocess.run(
        ["make", "-s", "try_film"], cwd=ROOT, check=False, text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, timeout=1800,
        env={"B": os.environ.get("BUILD", "build"), **os.environ,
             "TRY_DEFINES": " ".join(defines), "TRY_OUT": str(draws)})
    if made.returncode:
        raise BadInput("make try: ./cloth can't be built")
    words: list[str | pathlib.Path] = []
    for word in made.stdout.split("\n")[-2].split():
        words.append(f"-I{ROOT}" if word == "-I." else word if not
                     word.endswith((".o", ".a")) else ROOT / word)
    shop.sources.own += [ROOT / "lab", *(
        word for word in words if isinstance(word, pathlib.Path))]
    return draws, shop.compile("film", ROOT / "lab/try/film.cpp",
                               [*words, "-w", *defines])


def states(shop: Workshop, program: pathlib.Path, scene: pathlib.Path,
           file: pathlib.Path) -> None:
    """Run the step in the jail; the file gets where the nodes are."""
    with open(file, "wb") as out:
        ended = shop.jailed(
            lambda _: [program, "--config", scene, "--headless"], LIMITS,
            lambda data: bool(out.write(data)) and out.tell() <= MOST,
            [ROOT / "data", "/usr"])
    if ended.stopped or ended.code not in (0, 3):     # 3: it diverges
        raise BadInput(f"{shop.where}: no film: its scene ends by "
                       + (f"too much {ended.stopped}" if ended.stopped else
                          f"status {ended.code}"))


def record(verdict: judge.Verdict, path: pathlib.Path, out: str) -> int:
    """Write the film; the exit status of the ./cloth that draws."""
    if choose(path, verdict.step)[1] != 5:
        raise BadInput(f"{path}:1: {verdict.step} takes no constraint, "
                       "expected one: the scene has pins and a ball")
    shop = Workshop(path, verdict.step, 5)
    try:
        draws, steps = programs(shop, verdict)
        scene = shop.folder / f"{verdict.step}.toml"
        scene.write_text(scene_of(verdict), "utf-8")
        file = shop.folder / "states"
        states(shop, steps, scene, file)
        return subprocess.run(
            [draws, "--config", scene, "--record", out], check=False,
            env={**os.environ, "TRY_STATES": str(file)}).returncode
    finally:
        shop.close()
