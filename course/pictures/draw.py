#!/usr/bin/env python3
"""Draw the pictures of the pages.

    course/pictures/draw.py [NAME...]      make course-pictures

draws NAME.png, or all. Each is a row of panels, and each panel is the
assignment's program as it is, or a copy with a mistake of course/wrong.
Needs what the window needs (make deps) and ffmpeg; no display.
"""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "kit"))
import markers  # noqa: E402
import mistakes  # noqa: E402

HEIGHTS = {2: 416, 3: 330, 4: 300}  # [pixels], by the number of panels

PROGRAM = "mass_spring.cpp"
FLOOR = -0.75  # the plane [m]

# A picture is a row of panels: a mistake or none, the stage, times [s], and the
# lowest z in view [m]. Beside mistakes that look right is the correct cloth.
PICTURES: dict[str, list[tuple[str, str, list[float], float]]] = {
    "3.2": [("", "problem1", [0.3, 0.6], -1.25)],
    "3.2-mistakes": [("sign", "problem1", [0.04], -0.45),
                     ("one loop", "problem1", [0.46], -0.75),
                     ("old positions", "problem1", [0.17], -0.45)],
    "4.2": [("", "diagonals", [0.3, 0.6], -1.15)],
    "4.2-mistakes": [("first length", "diagonals", [0.3], -0.75),
                     ("no length", "diagonals", [0.1], -0.75),
                     ("one diagonal", "diagonals", [0.6], -1.05),
                     ("", "diagonals", [0.6], -1.05)],
    "5.1-mistakes": [("no mass", "forces", [0.006], -1.05),
                     ("+ c v", "forces", [0.85], -1.05),
                     ("c = 1", "forces", [2], -1.05),
                     ("damped", "forces", [2], -1.05)],
    "5.2": [("", "forces", [0.7], -1.15), ("damped", "forces", [5], -1.15)],
    "6.1-mistakes": [("pin by place", "constraints", [0.45], FLOOR),
                     ("ball keeps v", "constraints", [0.37], FLOOR),
                     ("floor keeps v", "constraints", [2.5], FLOOR),
                     ("", "constraints", [2.5], FLOOR)],
    "6.2": [("", "constraints", [0.35, 0.45], FLOOR)],
    "6.2-mistakes": [("ball only", "constraints", [0.35, 0.45, 0.6], FLOOR)],
    "7.2": [("", "tear", [0.45, 0.6], FLOOR)],
}


def compiled(folder: pathlib.Path, mistake: str, stage: str,
             source: str | pathlib.Path,
             *more: str | pathlib.Path) -> pathlib.Path:
    """A program from the sources with a mistake, in the folder: @a source, one
    of these or another file, with more flags. Returns the program's path."""
    for file in markers.SOURCES:
        text = markers.solution(markers.path_of(file).read_text(), file)
        (folder / file).write_text(
            mistakes.with_picture(text, file, mistake))
    program = folder / "program"
    subprocess.run(
        [os.environ.get("CXX", "g++"), "-std=c++20", "-O1", "-pthread",
         f"-DSTAGE={stage}", f"-I{folder}", f"-I{ROOT}", "-o", program,
         folder / source, *more], check=True)
    return program


def build(folder: pathlib.Path, mistake: str, stage: str) -> pathlib.Path:
    """The program that draws the panels of a mistake."""
    viewer = os.environ.get("B", "build") + "/libviewer.a"
    subprocess.run(["make", "-s", viewer], cwd=ROOT, check=True)
    libraries = subprocess.run(
        ["pkg-config", "--libs", "sdl2", "gl", "libpng"],
        check=True, stdout=subprocess.PIPE, text=True).stdout
    return compiled(folder, mistake, stage, HERE / "picture.cpp",
                    "-DMASS_SPRING_VIEWER", ROOT / viewer,
                    *shlex.split(libraries))


def draw(name: str, folder: pathlib.Path) -> None:
    """Run the programs of a picture, and put their panels into a row."""
    count = sum(len(times) for _, _, times, _ in PICTURES[name])
    files: list[str | pathlib.Path] = []
    for mistake, stage, times, low in PICTURES[name]:
        right = mistake in ("", "damped") and "mistakes" in name
        program = build(folder, mistake, stage)
        for time in times:
            out = folder / f"{len(files)}.png"
            files += ["-i", out]
            subprocess.run(
                [program, "data/grid1.nodes", "data/grid1.tets", "0.001",
                 str(time)], cwd=ROOT, stdout=subprocess.DEVNULL, check=True,
                env=os.environ | {
                    "OUT": str(out), "LOW": str(low),
                    "TITLE": "correct" if right else mistake or stage,
                    "WIDTH": str(1026 // count),
                    "HEIGHT": str(HEIGHTS[count])})
    picture = HERE / f"{name}.png"
    subprocess.run(
        ["ffmpeg", "-v", "error", "-y", *files, "-filter_complex",
         f"hstack=inputs={count}", "-update", "1", picture], check=True,
        stdin=subprocess.DEVNULL)
    subprocess.run([ROOT / "tools/shrink_pictures.sh", picture], check=True)
    print(f"course/pictures/{name}.png: {picture.stat().st_size} bytes",
          flush=True)


def main() -> None:
    names = sys.argv[1:] or list(PICTURES)
    for name in names:
        if name not in PICTURES:
            sys.exit(f"there is no picture {name}; there are "
                     + ", ".join(PICTURES))
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            draw(name, pathlib.Path(folder))


if __name__ == "__main__":
    main()
