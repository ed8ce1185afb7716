#!/usr/bin/python3
"""What make web and the figures do, in a headless Chromium:
test_web.py BUILD [TEST]... writes all into BUILD/web; its pictures are to be
looked at."""
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in (
    "tools/browsers", "course/kit", "course/pictures")]
import child  # noqa: E402
import draw  # noqa: E402
from browser import run_tests  # noqa: E402

build = pathlib.Path(sys.argv[1]).resolve() / "web"
STAGES = ("problem1", "diagonals", "forces", "constraints", "tear")
# A module, its mistake, and a stage in which it runs for 500 steps.
BITS = [("right", "", stage) for stage in STAGES] + [
    ("first-length", "first length", "diagonals"),
    ("plus-c-v", "+ c v", "forces"),
    ("floor-keeps-v", "floor keeps v", "constraints")]
tests = []


def test(run):
    tests.append(run)


def run(*command, folder=ROOT, status=0):
    """What a command says."""
    done = child.run(command, 300, cwd=folder, text=True, capture_output=True)
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout + done.stderr


@functools.cache
def tree(kind, name, graph=""):
    """A starter or a solution, as a student has it, with web.html."""
    folder = build / name
    shutil.rmtree(folder, ignore_errors=True)
    run("make", "-s", kind, f"OUT={folder}")
    if graph:
        shutil.copy(ROOT / graph, folder)
    said = run("make", "--no-print-directory", "web", folder=folder)
    assert re.fullmatch(r"web.html: \d+ bytes; .*\n", said), said
    return folder


def edit(file, *edits):
    text = file.read_text()
    for old, new in edits:
        assert text.count(old) == 1, f"{file}: {old}"
        text = text.replace(old, new)
    file.write_text(text)


def open_page(b, folder):
    b.open(f"file://{folder}/web.html")
    b.wait("page.cloths[0].readings")


def choose_stage(b, stage, time):
    """Another stage, once it has reached a time [s]."""
    run = b.value("page.cloths[0].run")
    b.value(f"$('stages').value = '{stage}',"
            "$('stages').dispatchEvent(new Event('change'))")
    b.wait(f"page.cloths[0].run > {run} && page.cloths[0].time >= {time}")


def open_figures(b, *figures):
    """A page with figures; each is one of the array `all`."""
    (build / "figures/test.html").write_text(
        "<!doctype html><meta charset=utf-8><meta name=viewport "
        "content='width=device-width'><body style='max-width:800px'>"
        + "<div class=here><p>the still</p></div>" * len(figures)
        + "<script src=figure.js></script><script>const errors = [], all = ["
        + ",".join(f"figure(document.querySelectorAll('.here')[{k}], {words})"
                   for k, words in enumerate(figures)) + "]</script>")
    b.open(f"file://{build}/figures/test.html")


def native(mistake, stage):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = draw.compiled(folder, mistake, stage,
                                ROOT / "course/web/positions.cpp",
                                "-ffp-contract=off")
        child.run([program, "data/grid1.nodes", "data/grid1.tets", "0.001",
                   "0.5"], 120, cwd=ROOT, stdout=subprocess.DEVNULL,
                  env=os.environ | {"POSITIONS": str(folder / "out")})
        return (folder / "out").read_bytes()


@test
def same_bits_as_the_native_program(b):
    """After 500 steps: the solution in each stage, and wrong code."""
    for name, mistake, stage in BITS:
        open_figures(b, f"{{wasm: ['{name}'], stage: '{stage}'}}")
        b.wait("all[0].cloths[0].ready")
        b.value("all[0].setPlaying(false), all[0].start()")
        b.wait("all[0].cloths[0].readings?.steps === 0 &&"
               "!all[0].isWaiting")
        b.value("all[0].cloths[0].post('positions', 500)")
        b.wait("all[0].cloths[0].all")
        ours = b.bytes_of("all[0].cloths[0].all.all")
        theirs = native(mistake, stage)
        assert len(theirs) > 500 * 24, len(theirs)
        assert ours == theirs, f"{name} in {stage}: other bits"


@test
def a_starter_and_a_solution_become_pages(b):
    starter = tree("starter", "starter")
    solution = tree("solution", "solution")
    for folder in (starter, solution):
        text = (folder / "web.html").read_text()
        assert not re.search(r"<(script|link|img)[^>]* (src|href)=\"[^d]", text)
    open_page(b, starter)
    b.wait("page.cloths[0].time > 0.05")
    assert b.value("page.cloths[0].readings.kinetic") == 0  # no step yet
    open_page(b, solution)
    for stage in STAGES:
        choose_stage(b, stage, 0.2)
        assert b.value("page.cloths[0].readings.kinetic") > 0
        assert b.value("page.find('.fault').hidden"), stage
    b.wait("page.cloths[0].readings.nodes < 600")  # torn
    b.screenshot(build / "page.png")
    # A graph of another student, whose removals move all later indices.
    other = tree("solution", "other", "course/starter/open/Graph.hpp")
    open_page(b, other)
    choose_stage(b, "tear", 0.7)
    assert b.value("page.cloths[0].readings.nodes") == 583
    assert b.value("page.sides[0].pins.length") == 2


@test
def the_hand_pulls_and_cuts(b):
    open_page(b, tree("solution", "solution"))
    choose_stage(b, "forces", 0.01)
    b.click(".play")
    b.wait("!page.isWaiting")

    height = "page.sides[0].points[4 * page.hand.grabbed.node + 2]"
    x, y = b.place_of(624)
    b.mouse("mousePressed", x, y)
    b.wait("page.hand.grabbed")
    before = b.value(height)
    b.value("page.setPlaying(true)")
    b.mouse("mouseMoved", x, y - 150)
    b.wait(f"{height} > {before} + 0.1")
    b.mouse("mouseReleased", x, y - 150)
    b.value("page.setPlaying(false)")
    b.wait("!page.isWaiting")
    edges = b.value("page.cloths[0].readings.edges")
    b.click("[data-tool=cut]")
    b.stroke(b.place_of(300), b.place_of(324))
    b.wait(f"page.cloths[0].readings.edges < {edges} - 20")
    assert b.value("page.cloths[0].readings.nodes") == 625


@test
def the_page_says_what_is_wrong_with_the_code(b):
    folder = tree("solution", "faulty")
    file = folder / "mass_spring.hpp"
    edit(file, ("if (is_corner(n.position())) return Point();", """
    if (same_) throw std::runtime_error("my words");
    for (volatile int k = 0;; k = k + 1) {}"""),
         ("return n.value().mass * Point(0, 0, -gravity);",
          "assert(gravity < 0 && \"my assertion\");\n"
          "return n.value().mass * Point(0, 0, -gravity);"),
         ("    if (n.position().z < z) n.position().z = z,",
          "    if (std::vector<int>()[3] > 0) return;\n"
          "    if (n.position().z < z) n.position().z = z,"))
    run("make", "--no-print-directory", "web", folder=folder)
    open_page(b, folder)
    fault = "page.find('.fault').textContent"
    for stage, words in (
            ("problem1", "my words"),
            ("diagonals", "one step takes more than 10 s"),
            ("forces", r"mass_spring.hpp:\d+: assertion .*my assertion"),
            ("constraints", r"vector\[\] index out of bounds")):
        choose_stage(b, stage, 0)
        b.wait(f"page.cloths[0].failure && /{words}/.test({fault}) &&"
               " !page.find('.fault').hidden")
    b.screenshot(build / "fault.png")
    # It does not compile: the file and the line.
    line = file.read_text()[:file.read_text().index("my words")].count("\n") + 1
    edit(file, ('"my words");', '"my words")'))
    said = run("make", "--no-print-directory", "web", folder=folder, status=2)
    assert re.search(rf"mass_spring\.hpp:{line}:\d+: error: expected ';'",
                     said), said


@test
def figures_run_on_one_clock_and_only_where_they_are_seen(b):
    two = "{wasm: ['right', 'sign'], speed: 0.1, end: 0.3}"
    b.prefer(still=True)
    open_figures(b, two)
    b.wait("all[0].sides.length && !all[0].isWaiting")
    assert not b.value("all[0].playing || all[0].clock")
    b.prefer()
    open_figures(b, two, "{wasm: ['right'], stage: 'tear'}",
                 "{wasm: ['right', 'plus-c-v'], stage: 'forces', beside: true}")
    b.wait("all[0].clock > 0.03")
    assert b.value("all[0].panes.join()") == "1"
    assert not b.value("all[2].view")  # below the screen
    b.wait("all[0].cloths[1].readings.gainAt > 0 && all[0].clock > 0.1")
    b.screenshot(build / "figures.png")
    b.value("all[0].find('.switch').children[0].click()")
    assert b.value("all[0].panes.join()") == "0"
    gaps = b.value("all[0].cloths.map(c => c.failure ? 0 :"
                   " Math.abs(c.time - all[0].clock))")
    # Two steps and a frame of at most 0.05 s, 10 times slower.
    assert max(gaps) < 0.0071, gaps
    b.value("scrollTo(0, 1e5)")
    b.wait("all[2].clock > 0.3 && !all[0].seen")
    assert b.value("all[2].sides.length") == 2
    stands = b.value("all[0].clock")
    b.wait("all[2].clock > 0.5")
    assert b.value("all[0].clock") == stands
    light = b.value("all[2].theme.sky.join()")
    b.prefer(dark=True)
    b.wait(f"all[2].theme.sky.join() !== '{light}'")
    b.resize(360, 700)
    b.wait("document.documentElement.scrollWidth <= 360")
    b.screenshot(build / "figures-360.png")


def main():
    build.mkdir(parents=True, exist_ok=True)
    print(run("python3", "course/web/web.py", "figures", build / "figures",
              *dict.fromkeys([name for name, *_ in BITS] + ["sign"])), end="")
    return run_tests(tests, sys.argv[2:]) != 0


if __name__ == "__main__":
    sys.exit(main())
