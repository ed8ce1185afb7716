"""Find a step in a file, build the probe with it and run the probe's parts.

The file is a stranger's: it is compiled and run in the grader's jail
(course/kit/jail.cpp), with limits on time, memory and output.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "course/kit"))

import diagnosis   # noqa: E402  (from course/kit)
import once        # noqa: E402
import sandbox     # noqa: E402
import submission  # noqa: E402
import units       # noqa: E402
from submission import BadInput  # noqa: E402: why a file can't be measured

BUILT = ROOT / "build/try"
PARTS = ("trace", "same", "order", "physics", "limits", "contact", "chart")
SECONDS = {"limits": 25, "contact": 20, "chart": 20, "trace": 4}
COMPILING = sandbox.Limits(cpu=60, wall=120, memory=3 << 30, output=8 << 20,
                           size=256 << 20)
FLAGS = {"fast": ["-O2", "-g1"],
         "checked": ["-O1", "-g1", "-fsanitize=address,undefined",
                     "-fno-sanitize-recover=all", "-D_GLIBCXX_ASSERTIONS"]}


# Headers of every probe, precompiled once for each kind of build.
PRELUDE = "".join(f"#include {name}\n" for name in (
    "<algorithm>", "<cmath>", "<functional>", "<map>", "<string>",
    "<vector>", '"mass_spring.hpp"'))
COMMON = ["-std=c++20", "-w", "-pthread", "-I", str(ROOT)]

Lines = list[tuple[str, list[float]]]   # of the probe: name, numbers


def progress(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


# ---- The step's name

def arguments(text: str, at: int) -> tuple[list[str], int] | None:
    """The arguments in the bracket at `at`, and where it closes; or None."""
    depth, start, found = 0, at + 1, []
    for k in range(at, len(text)):
        if text[k] in "([{<":
            depth += 1
        elif text[k] in ")]}>":
            depth -= 1
        if (text[k] == "," and depth == 1) or (text[k] == ")" and depth == 0):
            found.append(" ".join(text[start:k].split()))
            start = k + 1
        if depth == 0:
            return found, k
    return None


def steps_in(text: str) -> dict[str, int]:
    """{name: number of arguments} of functions of the step's form. If two have
    one name, the one with a constraint counts."""
    text = submission.without_comments(text, '/"R')
    found: dict[str, int] = {}
    for match in re.finditer(r"\bdouble\s+(\w+)\s*(\()", text):
        read = arguments(text, match.start(2))
        if not read or not re.match(r"\s*(noexcept\s*)?\{", text[read[1] + 1:]):
            continue
        words = [word for word in read[0] if "=" not in word]
        if len(words) in (4, 5) and "&" in words[0] and all(
                re.fullmatch(r"(const )?double( const)?( \w+)?", word)
                for word in words[1:3]):
            found[match[1]] = max(found.get(match[1], 0), len(words))
    named = {name: n for name, n in found.items() if name.endswith("step")}
    return named or found


MEASURES = ("make try measures steps: make test and make grade judge forces "
            "and constraints")


def choose(path: pathlib.Path, wanted: str) -> tuple[str, int]:
    """(name, number of arguments) of the step in a file."""
    taken = submission.take_file(path)
    found = steps_in(taken.files[path.name].decode("utf-8", "replace"))
    form = ("template <typename G, typename F, typename C> double NAME(G& g, "
            "double t, double dt, F&& force, C&& constraint)")
    if not found:
        raise BadInput(f"{path}:1: has no step, expected {form}; {MEASURES}")
    if wanted:
        if wanted not in found:
            raise BadInput(f"{path}:1: has no step {wanted}; it has "
                           + ", ".join(found) + f"; {MEASURES}")
        return wanted, found[wanted]
    if len(found) > 1:
        raise BadInput(f"{path}:1: has {len(found)} steps: choose one by STEP="
                       + " or STEP=".join(found))
    return next(iter(found.items()))


# ---- Building and running

class Workshop:
    """A folder in which the probe of one step is built."""

    def __init__(self, path: pathlib.Path, step: str, arguments_: int) -> None:
        self.path, self.step = path.absolute(), step
        self.arguments = arguments_
        self.taken = submission.take_file(path, "Graph.hpp", "mass_spring.hpp")
        files = self.taken.files
        # Those of the course are no files of the stranger's.
        own = {"Graph.hpp", "mass_spring.hpp", "methods.hpp"} - {path.name}
        for name in own:
            if files.get(name) == (ROOT / name).read_bytes():
                del files[name]
        BUILT.mkdir(parents=True, exist_ok=True)
        try:
            self.jail = once.Kit.only_jail()
            self.prelude = once.Kit.locked_part(
                "try", [ROOT / "Graph.hpp", ROOT / "mass_spring.hpp",
                        *(ROOT / "CME212").glob("*.hpp")], self.make_prelude,
                (PRELUDE, COMMON, FLAGS))
        except once.KitError as error:
            raise BadInput(str(error)) from None
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=BUILT, prefix="room-"))
        self.folder.chmod(0o755)
        self.sources = units.Sources(  # type: ignore[attr-defined]
            self.jail, self.folder, files, [
                ROOT / "CME212", ROOT / "Graph.hpp", ROOT / "mass_spring.hpp",
                ROOT / "methods.hpp", ROOT / "lab/try", self.prelude],
            units.words_of(ROOT / "lab/try"))  # type: ignore[attr-defined]
        self.where = f"{self.path}:1: {step}"
        self.programs: dict[str, pathlib.Path] = {}
        self.slow: list[str] = []   # parts that took too long

    def make_prelude(self, folder: pathlib.Path) -> None:
        """Precompile in the jail: addresses are not random there, nor where the
        header is used."""
        jail = [*self.jail, "--compiler", "--cpu", "300", "--size",
                str(1 << 30), "--"]
        for kind, flags in FLAGS.items():
            header = folder / f"{kind}.hpp"
            header.write_text(PRELUDE, encoding="utf-8")
            once.Kit.run([*COMMON, *flags, "-x", "c++-header", header, "-o",
                          f"{header}.gch"], "the course's classes can't be "
                         "built", jail)

    def of_the_course(self) -> bool:
        """Are Graph.hpp and mass_spring.hpp those of the course?"""
        return not {"Graph.hpp", "mass_spring.hpp"} & self.taken.files.keys()

    def compile(self, kind: str = "fast") -> pathlib.Path:
        """The probe; BadInput names the first error of the file."""
        if kind in self.programs:
            return self.programs[kind]
        program = self.sources.built / kind
        command = [once.CXX, *COMMON, *FLAGS[kind],
                   "-fmax-errors=20", "-fdiagnostics-plain-output",
                   "-iquote", self.sources.source,
                   f"-ffile-prefix-map={self.sources.source}="
                   + str(self.path.parent),
                   *(["-include", self.prelude / f"{kind}.hpp"]
                     if self.of_the_course() else []),
                   f'-DTRY_FILE="{self.sources.source}/{self.path.name}"',
                   f'-DTRY_UNDEFINED="{self.sources.undefined}"',
                   f"-DTRY_STEP={self.step}",
                   f"-DTRY_ARGUMENTS={self.arguments}",
                   ROOT / "lab/try/probe.cpp", "-o", program]
        unit = self.sources.compiled(command, COMPILING)
        if unit.refused:
            raise BadInput(f"{self.path}:1: {unit.refused}")
        if not unit.right:
            raise BadInput(self.first_error(unit.output))
        self.programs[kind] = program
        return program

    def first_error(self, output: str) -> str:
        """The first error in the stranger's own file, else the first of all."""
        errors = diagnosis.compile_errors(output)
        own = [e for e in errors if e.file == self.path.name]
        if own:
            return f"{self.path}:{own[0].line}: {diagnosis.short(own[0].text)}"
        # An error in a class of the course; the file's line led to it.
        place = re.search(r"(?m)(?:^|from )" + re.escape(self.path.name)
                          + r":(\d+)", output)
        text = errors[0].text if errors else diagnosis.link_message(output)
        return (f"{self.path}:{place[1] if place else 1}: "
                + diagnosis.short(text))

    def run(self, part: str, kind: str = "fast",
            *more: object) -> tuple[Lines, sandbox.Outcome]:
        """(its lines, name and numbers; outcome) of a part of the probe, in the
        jail, which reads the folder and the system's libraries."""
        seconds = SECONDS.get(part, 8) * (1 if kind == "fast" else 8)
        limits = sandbox.Limits(cpu=seconds, wall=4 * seconds)
        spoken = sandbox.Output(limits.output, limits.output)
        written = sandbox.Output(limits.output)
        from_read, from_write = os.pipe()
        command = self.programs[kind], part, from_write, *more
        process = subprocess.Popen(
            [*self.jail, "--cpu", str(limits.cpu),
             *units.flags("--read", [  # type: ignore[attr-defined]
                 self.folder, "/usr/lib", "/lib", "/lib64", "/etc/ld.so.cache",
                 "/proc/self"]),
             "--", *map(str, command)], cwd="/",
            env=sandbox.clean_environment("/nowhere"), pass_fds=[from_write],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, start_new_session=True)
        os.close(from_write)
        assert process.stderr
        try:
            with process.stderr as pipe:
                stopped, _ = sandbox.watch(process, limits, {
                    pipe.fileno(): written.add, from_read: spoken.add})
        finally:
            os.close(from_read)
        outcome = sandbox.Outcome(stopped, process.returncode, written.text())
        found: Lines = []
        for line in spoken.first.decode("ascii", "replace").splitlines():
            name, *numbers = line.split(" ")
            try:
                found.append((name, [float(x) for x in numbers]))
            except ValueError:      # a line that was cut
                pass
        outcome.begun = bool(found)
        return found, outcome

    def close(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)

    def random(self) -> str:
        """FILE:LINE: STEP: NAME of the first random number in the file's
        text, or ''."""
        text = submission.without_comments(
            self.path.read_text("utf-8", "replace"), '/"R')
        found = re.search(r"\b(rand|rand_r|random|[ed]rand48|random_device|"
                          r"mt19937\w*|minstd_rand0?|default_random_engine)\b"
                          r"(?=\s*[\w({;])", text)
        if not found:
            return ""
        line = text.count("\n", 0, found.start()) + 1
        return f"{self.path}:{line}: {self.step}: {found[1]}"

    def why(self, part: str, outcome: sandbox.Outcome,
            *more: object) -> str:
        """Why a part of the probe did not end, in words."""
        name = self.where
        if outcome.stopped == "time":
            return (f"{name}: loops for ever, or takes too long: "
                    f"stopped after {SECONDS.get(part, 8)} s")
        if outcome.stopped:
            return f"{name}: uses too much {outcome.stopped}"
        # The sanitizers name the line.
        self.compile("checked")
        _, checked = self.run(part, "checked", *more)
        said = checked if checked.code and not checked.stopped else outcome
        thrown = re.search(r"terminate called after throwing an instance of "
                           r"'(.*)'(?:\n *what\(\): +(.*))?", said.output)
        if thrown:
            what = f": {diagnosis.short(thrown[2])}" if thrown[2] else ""
            return f"{name}: throws {thrown[1]}{what}"
        text = diagnosis.crash(said, {str(self.path)})
        place = re.search(rf" at {re.escape(str(self.path))}:(\d+)", text)
        if place:
            return (f"{self.path}:{place[1]}: {self.step}: crashes: "
                    + text.replace(place[0], ""))
        return f"{name}: crashes: {text}"
