"""What the grader builds once: the jail, what is linked with each test, and
the precompiled prelude of each kind of build. It stands in build/kit, each
part under a name that depends on all that it is made from.
"""

import fcntl
import hashlib
import os
import pathlib
import random
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable
from typing import Any

import tasks

ROOT = tasks.ROOT
KIT = ROOT / "course/kit"
TESTS = ROOT / "course/tests"
BUILT = ROOT / "build/kit"
# The version that the kit is checked with, if it is there.
CXX = shutil.which("g++-12", path="/usr/bin") or "/usr/bin/g++"
CHECKED = "12, 13 and 14"
COMMON = ["-std=c++20", "-w", "-pthread",
          "--param", "ggc-min-heapsize=4000000"]    # in kB: faster
# By kind of build. The checks left out cost a third of the time to compile;
# what they find, AddressSanitizer finds as well or the course does not ask for.
FLAGS = {
    "checked": ["-O0", "-g1", "-fsanitize=address,undefined",
                "-fno-sanitize-recover=all", "-D_GLIBCXX_ASSERTIONS",
                "-fno-sanitize=null,alignment,object-size,vptr,"
                "pointer-overflow",
                "--param", "asan-instrumentation-with-call-threshold=0"],
    "counted": ["-O1", "-g0", "-fsanitize-coverage=trace-pc"],
}
LINK: dict[str, list[str]] = {
    "checked": ["-fsanitize=address,undefined"],
    "counted": [],
}
# What each test program is linked with, of the kit's own.
LINKED = [KIT / "runner.cpp", TESTS / "kit.cpp"]
LAW = ROOT / "course/asked/law.cpp"
PATIENCE = 600      # seconds for a step of the kit's own
UNUSED = 3600       # seconds after which a part that is not used is removed


class KitError(Exception):
    """The kit itself can't be built or used here."""


def ended(command: list) -> subprocess.CompletedProcess:
    """The command, which runs nothing of a submission, after it has ended."""
    try:
        return subprocess.run(command, capture_output=True, text=True,
                              errors="replace", timeout=PATIENCE, check=False)
    except FileNotFoundError as error:
        raise KitError(f"there is no {error.filename}: make deps") from None
    except subprocess.TimeoutExpired:
        raise KitError(f"{command[0]} takes more than {PATIENCE} s") from None


def this_system() -> str:
    """What may differ from where the kit was checked, in words."""
    release = pathlib.Path("/etc/os-release")
    name = re.search(r'^PRETTY_NAME="?([^"\n]*)', release.read_text(
        "utf-8", "replace") if release.exists() else "", re.MULTILINE)
    return (f"this system is {name[1] if name else 'unknown'} with "
            + ended([CXX, "--version"]).stdout.partition("\n")[0])


class Kit:
    """The parts, built if they are not there; `jail` starts a command."""

    def __init__(self, unsafe: bool = False, probe: bool = True):
        # CME212/ apart from the root, whose Graph.hpp is no submission's.
        os.umask(0o022)     # another user may run what is built here
        self.include = BUILT / "include"
        self.include.mkdir(parents=True, exist_ok=True)
        course = sorted((ROOT / "CME212").rglob("*.hpp"))
        link = self.include / "CME212"
        # A folder that was copied has the link to the old place.
        if not link.is_symlink() or os.readlink(link) != str(ROOT / "CME212"):
            link.unlink(missing_ok=True)
            link.symlink_to(ROOT / "CME212")
        self.jail = self.only_jail()
        tests = sorted(TESTS.glob("*.hpp"))
        linked = self.locked_part(
            "linked", [*LINKED, LAW, KIT.parent / "asked/law.hpp", *tests,
                       *course], self.make_linked)
        self.law = linked / "law"
        self.preludes = self.locked_part(
            "prelude", [TESTS / "prelude.hpp", *course], self.make_preludes)
        # The solution sets these: judge.prepare() grades it first.
        self.secret = b""
        self.answers: Any = None
        self.usual: Any = None      # to the usual numbers
        self.data: Any = None       # a folder
        self.assembler: dict = {}   # of standard headers: units.Room
        self.linked = sorted(linked.glob("*.o"))
        if unsafe:
            self.jail.append("--unsafe")
        elif probe:
            self.probe()

    @classmethod
    def only_jail(cls) -> list[str]:
        """The jail, for who needs nothing else of a kit."""
        BUILT.mkdir(parents=True, exist_ok=True)
        return [str(cls.locked_part("jail", [KIT / "jail.cpp"],
                                    cls.make_jail) / "jail")]

    @classmethod
    def locked_part(cls, name: str, sources: Iterable[pathlib.Path],
                    make: Callable[[pathlib.Path], None],
                    more: tuple = ()) -> pathlib.Path:
        """The same part for all graders that run at a time."""
        with open(BUILT / "lock", "w", encoding="ascii") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            return cls.part(name, sources, make, more)

    @staticmethod
    def part(name: str, sources: Iterable[pathlib.Path],
             make: Callable[[pathlib.Path], None],
             more: tuple = ()) -> pathlib.Path:
        """The folder of a part, which is made if its sources are new."""
        version = ended([CXX, "--version"])
        if version.returncode:
            raise KitError("there is no g++: make deps")
        key = hashlib.sha256(version.stdout.encode())
        key.update(repr((FLAGS, COMMON, str(ROOT), more)).encode())
        for path in sorted(sources):
            key.update(path.name.encode() + b"\0" + path.read_bytes())
        folder = BUILT / f"{name}-{key.hexdigest()[:16]}"
        if not folder.exists():
            for old in BUILT.glob("*-*"):
                if time.time() - old.stat().st_mtime > UNUSED:
                    shutil.rmtree(old)
            new = pathlib.Path(tempfile.mkdtemp(dir=BUILT, prefix="new-"))
            new.chmod(0o755)
            try:
                make(new)
                new.rename(folder)
            except BaseException:
                shutil.rmtree(new, ignore_errors=True)
                raise
        os.utime(folder)
        return folder

    @classmethod
    def make_jail(cls, folder: pathlib.Path) -> None:
        cls.run(["-O1", KIT / "jail.cpp", "-o", folder / "jail", "-lseccomp"],
                 "jail.cpp can't be built: is libseccomp-dev there? "
                 "tools/deps.sh grade")

    def make_linked(self, folder: pathlib.Path) -> None:
        for source in LINKED:
            self.run(["-O1", "-I", self.include, "-I", TESTS, "-c", source,
                      "-o", folder / f"{source.stem}.o"],
                     f"{source.name} can't be built")
        self.run(["-O1", "-I", self.include, "-I", TESTS, LAW,
                  folder / "kit.o", "-o", folder / "law"],
                 f"{LAW.name} can't be built")

    def make_preludes(self, folder: pathlib.Path) -> None:
        # In the jail, where addresses are not by chance: it is used there.
        jail = [*self.jail, "--compiler", "--cpu", "300", "--size",
                str(1 << 30), "--"]
        for kind, flags in FLAGS.items():
            (folder / kind).mkdir()
            header = folder / kind / "prelude.hpp"
            # The variable ends what the headers have of assembler: the compiler
            # marks that end before a variable, but not before a constant.
            header.write_text((TESTS / "prelude.hpp").read_text("utf-8")
                              + "[[gnu::used]] static const char kit_after = 0;"
                              "\n", "utf-8")
            self.run([*flags, "-I", self.include, "-x", "c++-header", header,
                      "-o", f"{header}.gch"], "prelude.hpp can't be built",
                     jail)

    @staticmethod
    def run(words: list, complaint: str, before: Iterable = ()) -> None:
        command = [str(word) for word in (*before, CXX, *COMMON, *words)]
        done = ended(command)
        if done.returncode:
            raise KitError(f"{complaint}\n{done.stderr[:2000]}")

    def has(self) -> list[str]:
        """What the kernel has for the jail beside the filter of calls."""
        return ended([*self.jail, "--has"]).stdout.split()

    def probe(self) -> None:
        """Without a filter of system calls there is no grading."""
        done = ended([*self.jail, "--", "/bin/true"])
        if done.returncode:
            raise KitError(
                f"{done.stderr.strip() or 'jail: does not run'}\nWithout it a "
                "submission could do here what it wants. On a machine that may "
                "be thrown away: make grade SAFE=0 DIR=...")


CORNERS = ("0 0 0", "1 0 0")


def draw_cloth(folder: pathlib.Path, kit: Kit) -> None:
    """The kit's small cloth, each node but the corners moved a little, least
    in z."""
    shutil.copytree(TESTS / "data", folder)
    nodes = folder / "cloth.nodes"
    lines = nodes.read_text("ascii").splitlines()
    dice = random.Random(kit.secret)
    for at, line in enumerate(lines):
        if line not in CORNERS:
            x, y, z = map(float, line.split())
            lines[at] = (f"{x + dice.uniform(-0.02, 0.02):.6f} "
                         f"{y + dice.uniform(-0.02, 0.02):.6f} "
                         f"{z + dice.uniform(-0.004, 0.004):.6f}")
    nodes.write_text("\n".join(lines) + "\n", "ascii")


if __name__ == "__main__":
    Kit(probe=False)
