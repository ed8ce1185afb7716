"""Build what the grader needs once, and test programs of a submission.

A test program is one unit: the bridge, then the tests, one file each. All
files that it reads are listed by the compiler; one from outside of the
submission and the kit is refused.
"""

import fcntl
import hashlib
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field

import sandbox

ROOT = pathlib.Path(__file__).resolve().parents[2]
KIT = ROOT / "course/kit"
TESTS = ROOT / "course/tests"
# What each test program is linked with, of the kit's own.
LINKED = [KIT / "runner.cpp",
          *(path for path in [TESTS / "kit.cpp"] if path.exists())]
# The version that the kit is checked with, if it is there.
CXX = shutil.which("g++-12", path="/usr/bin") or "/usr/bin/g++"
COMMON = ["-std=c++20", "-w", "-pthread",
          "--param", "ggc-min-heapsize=4000000"]    # in kB: faster
# By kind of build. The checks left out cost half of the time to compile; what
# they find, AddressSanitizer finds as well or the course does not ask for.
FLAGS = {
    "checked": ["-O0", "-g1", "-fsanitize=address,undefined",
                "-fno-sanitize-recover=all", "-D_GLIBCXX_ASSERTIONS",
                "-fno-sanitize=null,alignment,object-size,vptr,"
                "pointer-overflow",
                "--param", "asan-instrumentation-with-call-threshold=0"],
    "counted": ["-O1", "-g0", "-fsanitize-coverage=trace-pc"],
}
LINK = {
    "checked": ["-fsanitize=address,undefined"],
    "counted": ["-Wl,--wrap=memmove,--wrap=memcpy,--wrap=memset,"
                "--wrap=memchr,--wrap=memcmp"],
}
# In a comment of a test: how it is built, and names that it wants defined.
WISH = re.compile(r"^(?://| \*) (Build|Define): (\w+)\b", re.MULTILINE)
COMPILING = sandbox.Limits(cpu=60, wall=120, memory=3 << 30, output=64 << 20,
                           size=512 << 20)
SYSTEM = ("/usr/include", "/usr/lib", "/usr/local/include", "/usr/local/lib")
INCLUDED = re.compile(r"^[.!x]+ (.+)\n", re.MULTILINE)


class KitError(Exception):
    """The kit itself can't be built or used here."""


@dataclass
class Unit:
    """A test program, or why there is none."""
    program: pathlib.Path | None
    output: str = ""                 # of the compiler, without its includes
    included: frozenset = frozenset()     # names in the submission's folder
    refused: str = ""                # why it was not even compiled
    tests: list = field(default_factory=list)


@dataclass(frozen=True, order=True)
class Way:
    """How a test is built: tests of one way share a unit."""
    needs: str
    kind: str        # of FLAGS
    defines: tuple


def way_of(test, needs):
    text = (TESTS / f"{test}.cpp").read_text(encoding="utf-8")
    wishes = WISH.findall(text)
    kind = [value for key, value in wishes if key == "Build"] or ["checked"]
    if kind[0] not in FLAGS:
        raise KitError(f"course/tests/{test}.cpp: 'Build: {kind[0]}', expected "
                       + " or ".join(FLAGS))
    return Way(needs, kind[0], tuple(
        value for key, value in wishes if key == "Define"))


class Kit:
    """What is built once: the jail, what is linked with each test, the prelude
    of each kind."""

    def __init__(self, unsafe=False, where=ROOT / "build/kit", probe=True):
        key = hashlib.sha256()
        version = subprocess.run([CXX, "--version"], capture_output=True,
                                 check=False)
        if version.returncode:
            raise KitError("there is no g++: make deps")
        key.update(version.stdout + repr((FLAGS, COMMON, str(ROOT))).encode())
        sources = [KIT / "jail.cpp", *LINKED,
                   *sorted(TESTS.glob("*.hpp")),
                   *sorted((ROOT / "CME212").glob("*.hpp"))]
        for path in sources:
            key.update(path.name.encode() + path.read_bytes())
        self.folder = where / key.hexdigest()[:16]
        where.mkdir(parents=True, exist_ok=True)
        with open(where / "lock", "w", encoding="ascii") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not self.folder.exists():
                self.make(where)
        self.jail = [str(self.folder / "jail")]
        if unsafe:
            self.jail.append("--unsafe")
        elif probe:
            self.probe()

    def make(self, where):
        for old in where.iterdir():
            if old.is_dir():
                shutil.rmtree(old)
        new = pathlib.Path(tempfile.mkdtemp(dir=where))
        new.chmod(0o755)
        self.run(["-O1", "-Wall", "-Wextra", KIT / "jail.cpp", "-o",
                  new / "jail", "-lseccomp"],
                 "jail.cpp can't be built: is libseccomp-dev there? make deps")
        # CME212/ apart from the root, whose Graph.hpp is no submission's.
        (new / "include").mkdir()
        (new / "include/CME212").symlink_to(ROOT / "CME212")
        includes = ["-I", new / "include"]
        for source in LINKED:
            self.run(["-O1", *includes, "-I", TESTS, "-c", source, "-o",
                      new / f"{source.stem}.o"], f"{source.name} can't be built")
        for kind, flags in FLAGS.items():
            (new / kind).mkdir()
            header = new / kind / "prelude.hpp"
            shutil.copy(TESTS / "prelude.hpp", header)
            self.run([*flags, *includes, "-x", "c++-header", header, "-o",
                      f"{header}.gch"], "prelude.hpp can't be built",
                     [new / "jail", "--compiler", "--unsafe",
                      "--size", "1000000000", "--cpu", "300", "--"])
        new.rename(self.folder)

    @staticmethod
    def run(words, complaint, before=()):
        command = [str(word) for word in (*before, CXX, *COMMON, *words)]
        done = subprocess.run(command, capture_output=True, text=True,
                              errors="replace", check=False)
        if done.returncode:
            raise KitError(f"{complaint}\n{done.stderr[:2000]}")

    def probe(self):
        """Without a filter of system calls there is no grading."""
        done = subprocess.run([*self.jail, "--", "/bin/true"],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            raise KitError(
                f"{done.stderr.strip() or 'jail: does not run'}\nWithout it a "
                "submission could do here what it wants. On a machine that may "
                "be thrown away: --unsafe (SAFE=0)")


class Room:
    """A folder with a submission's sources, in which tests are built."""

    def __init__(self, kit, folder, files):
        self.kit, self.files = kit, files
        self.folder = folder
        self.source = folder / "source"
        self.built = folder / "built"
        for path in (self.source, self.built):
            path.mkdir(parents=True)
            path.chmod(0o755)
        for name, text in files.items():
            path = self.source / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)
        self.numbers = itertools.count(1)

    def compile(self, way, tests, link=True):
        """The unit of some tests; without tests just the bridge."""
        name = f"unit{next(self.numbers)}"
        unit = self.built / f"{name}.cpp"
        unit.write_text("".join(f'#include "{header}"\n' for header in
                                [f"{way.needs}.hpp"] + [f"{t}.cpp" for t in tests]),
                        encoding="ascii")
        assembly, program = self.built / f"{name}.s", self.built / name
        prelude = self.kit.folder / way.kind / "prelude.hpp"
        command = [CXX, *COMMON, *FLAGS[way.kind], "-H", "-fmax-errors=200",
                   "-fdiagnostics-plain-output", "-ftemplate-depth=400",
                   "-include", prelude,
                   "-I", TESTS / "headless", "-I", self.kit.folder / "include",
                   "-I", ".", "-I", TESTS, f'-DKIT_TESTS="{TESTS}"',
                   *(f"-D{name}" for name in way.defines),
                   f"-fdebug-prefix-map={self.source}=.",
                   *(["-S", "-o", assembly] if link else ["-fsyntax-only"]),
                   unit]
        done = self.run(command)
        paths, text = self.split(done.output)
        outside, inside = self.sort(paths)
        result = Unit(None, self.plain(text), inside, tests=list(tests))
        if outside:
            result.refused = f"#include of {outside}: it is not yours"
            result.output = ""
            result.included = frozenset(self.files)     # or any other
        elif done.stopped:
            result.refused = {"time": "it takes too long to compile",
                              "output": "it fills the compiler's output"}.get(
                                  done.stopped, "it takes too much to compile")
        elif done.code == 0 and link:
            if reads_files(assembly):
                result.refused = "it writes assembler"
                return result
            done = self.run([CXX, *LINK[way.kind], assembly,
                             *(self.kit.folder / f"{source.stem}.o"
                               for source in LINKED),
                             "-pthread", "-o", program])
            result.output += self.plain(done.output)
            if done.code == 0 and not done.stopped:
                result.program = program
        assembly.unlink(missing_ok=True)
        return result

    def run(self, command):
        read = ["/usr", "/lib", "/lib64", "/bin", "/etc/alternatives",
                "/etc/ld.so.cache", "/proc/self", self.kit.folder, TESTS,
                ROOT / "CME212", self.folder]
        jail = [*self.kit.jail, *flags("--read", read),
                *flags("--write", [self.built, "/dev/null"])]
        done = sandbox.run_compiler(jail, [str(word) for word in command],
                                    self.source, self.built, COMPILING)
        return done

    @staticmethod
    def split(output):
        """The files that were read, and what else the compiler said."""
        paths = INCLUDED.findall(output)
        text = INCLUDED.sub("", output)
        return paths, text.partition("Multiple include guards")[0]

    def sort(self, paths):
        """The first path from outside, and names in the submission."""
        inside, source = set(), os.path.realpath(self.source) + "/"
        kit = tuple(os.path.realpath(path) + "/" for path in (
            TESTS, ROOT / "CME212", self.kit.folder, self.built))
        for path in paths:
            real = os.path.realpath(os.path.join(self.source, path))
            if real.startswith(source):
                inside.add(real[len(source):])
            elif not real.startswith((*kit, *(s + "/" for s in SYSTEM))):
                return path, frozenset()
        return "", frozenset(inside)

    def plain(self, text):
        """Without the names of this machine's folders."""
        for path, name in ((f"{self.source}/", ""), (f"{self.built}/", ""),
                           (f"{TESTS}/", "course/tests/"),
                           (f"{self.kit.folder}/include/", ""),
                           (f"{ROOT}/", "")):
            text = text.replace(path, name)
        return re.sub(r"(?m)(^|(?<=from ))\./", "", text)


def flags(option, values):
    return [word for value in values for word in (option, str(value))]


def reads_files(assembly):
    """Does the compiler's output hold assembler that it did not write?"""
    with open(assembly, "rb") as file:
        text = file.read()
    if b"\n#APP\n" in text:
        return True
    return any(
        not line.lstrip().startswith((b".string", b".ascii"))
        for line in re.findall(rb"[^\n]*\.inc(?:bin|lude)\b[^\n]*", text))


if __name__ == "__main__":
    print(Kit(probe=False).folder)
