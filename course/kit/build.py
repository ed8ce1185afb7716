"""Build test programs of a submission.

A test program is one unit: the bridge, then the tests, one file each, and what
the judge asks beside them (course/asked). All files that it reads are listed by
the compiler; one from outside of the submission and the kit is refused.

The kit's files are named by whole paths, so no file of a submission can stand
for them; and its macros end where the kit's own code begins.
"""

import functools
import itertools
import os
import pathlib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

import once
import sandbox
import submission
from once import ROOT, TESTS

# In a comment of a test: how it is built, and names that it wants defined.
WISH = re.compile(r"^(?://| \*) (Build|Define): (\w+)\b", re.MULTILINE)
COMPILING = sandbox.Limits(cpu=60, wall=900, memory=3 << 30, output=64 << 20,
                           size=512 << 20)
SYSTEM = ("/usr/include", "/usr/lib", "/usr/local/include", "/usr/local/lib")
ASKED = ROOT / "course/asked"
WORD = re.compile(r"[A-Za-z_]\w*")
SPACE = r"(?:[ \t]|/\*(?:[^*]|\*(?!/)){0,60}+\*/){0,20}+"
MACRO = re.compile(rf"(?:#|%:|\?\?=){SPACE}define{SPACE}([A-Za-z_]\w*)")
DENIED = re.compile(r"fatal error: (.*): Permission denied$", re.MULTILINE)
INCLUDED = re.compile(r"^[.!x]+ (.+)\n", re.MULTILINE)
STANDARD = re.compile(rb"^[ \t]*#[ \t]*include[ \t]*<([\w./+-]+)>",
                      re.MULTILINE)
# Assembler written in the source, as it appears in the compiler's output.
ASSEMBLER = re.compile(rb"^#APP\n.*?^#NO_APP\n", re.MULTILINE | re.DOTALL)
BORDER = re.compile(rb"^#(?:NO_)?APP\b", re.MULTILINE)


@dataclass
class Unit:
    """A test program, or why there is none."""
    program: pathlib.Path | None
    output: str = ""                 # of the compiler, without its includes
    included: frozenset = frozenset()     # names in the submission's folder
    refused: str = ""                # why it was not even compiled
    doubtful: str = ""               # what a person should look at
    tests: list = field(default_factory=list)
    stage: str = ""                  # the only one of main(); "": all


@dataclass(frozen=True, order=True)
class Way:
    """How a test is built: tests of one way share a unit."""
    needs: str
    kind: str        # of FLAGS
    defines: tuple


def way_of(test: str, needs: str) -> Way:
    text = (TESTS / f"{test}.cpp").read_text(encoding="utf-8")
    wishes = WISH.findall(text)
    kind = [value for key, value in wishes if key == "Build"] or ["checked"]
    if kind[0] not in once.FLAGS:
        raise once.KitError(
            f"course/tests/{test}.cpp: 'Build: {kind[0]}', expected "
            + " or ".join(once.FLAGS))
    return Way(needs, kind[0], tuple(
        value for key, value in wishes if key == "Define"))


def all_stages(way: Way) -> bool:
    """Is main() compiled in all of its stages?"""
    return {"KIT_STAGES", "KIT_PROGRAM"} <= set(way.defines)


@functools.cache
def words_of_tests() -> set[str]:
    """Each word that the kit's own code is written with."""
    sources = [*TESTS.glob("*.[hc]pp"), *ASKED.glob("*.[hc]pp")]
    return {word for path in sources
            for word in WORD.findall(path.read_text(encoding="utf-8"))}


def macros(files: dict[str, bytes]) -> list[str]:
    """The macros of a submission that would change the kit's code."""
    names = set()
    for text in files.values():
        names |= set(MACRO.findall(
            submission.joined(text.decode("utf-8", "replace"))))
    return sorted(names & words_of_tests())


class Room:
    """A folder with a submission's sources, in which tests are built."""

    def __init__(self, kit: once.Kit, folder: pathlib.Path,
                 files: dict[str, bytes]):
        self.kit, self.files = kit, files
        self.names = set(files)     # of those that the student wrote
        self.folder = folder
        self.tests: tuple[pathlib.Path, ...] = (TESTS, ASKED)
        self.source = folder / "source"
        self.built = folder / "built"
        for path in (self.source, self.built):
            path.mkdir(parents=True)
            path.chmod(0o755)
        for name, text in files.items():
            path = self.source / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)
        (self.built / "undefined.hpp").write_text("".join(
            f"#undef {name}\n" for name in macros(files))
            + "#include <cassert>\n", encoding="utf-8")
        self.numbers = itertools.count(1)

    def compile(self, way: Way, tests: Iterable[str],
                link: bool = True) -> Unit:
        """The unit of some tests; without tests just the bridge."""
        name = f"unit{next(self.numbers)}"
        unit = self.built / f"{name}.cpp"
        headers = [TESTS / f"{way.needs}.hpp"]
        for test in tests:
            headers += [folder / f"{test}.cpp" for folder in self.tests
                        if (folder / f"{test}.cpp").exists()]
        unit.write_text("".join(f'#include "{header}"\n' for header in headers),
                        encoding="utf-8")
        assembly, program = self.built / f"{name}.s", self.built / name
        command = [*self.compiler(way), "-H",
                   "-fmax-errors=200", "-fdiagnostics-plain-output",
                   "-ftemplate-depth=400",
                   "-I", TESTS / "headless", "-I", self.kit.include,
                   # A header of the system is no file of the submission's.
                   "-iquote", ".", "-idirafter", ".",
                   f'-DKIT_UNDEFINED="{self.built}/undefined.hpp"',
                   *(f"-D{name}" for name in way.defines),
                   f"-fdebug-prefix-map={self.source}=.",
                   *(["-S", "-o", assembly] if link else ["-fsyntax-only"]),
                   unit]
        done = self.run(command)
        paths, text = self.split(done.output)
        outside, inside = self.sort(paths)
        if denied := DENIED.search(text):
            outside = denied[1]
        result = Unit(None, self.plain(text), inside, tests=list(tests))
        result.stage = next((name.partition("=")[2] for name in way.defines
                             if name.startswith("KIT_STAGE=")), "")
        if outside:
            result.refused = (f"#include of {self.plain(outside)}: it is not "
                              "yours")
            result.doubtful = "includes a file that is not its own"
            result.output = ""
            result.included = frozenset(self.files)     # or any other
        elif done.stopped:
            result.refused = {"time": "it takes too long to compile",
                              "output": "it fills the compiler's output"}.get(
                                  done.stopped, "it takes too much to compile")
        elif done.code == 0 and link:
            if reads_files(assembly) or self.writes_assembler(
                    way, assembly, paths):
                result.refused = result.doubtful = "it writes assembler"
                return result
            done = self.run([once.CXX, *once.LINK[way.kind], assembly,
                             *self.kit.linked, "-pthread", "-o", program])
            result.output += self.plain(done.output)
            if done.code == 0 and not done.stopped:
                result.program = program
        assembly.unlink(missing_ok=True)
        return result

    def compiler(self, way: Way) -> list:
        return [once.CXX, *once.COMMON, *once.FLAGS[way.kind], "-include",
                self.kit.preludes / way.kind / "prelude.hpp"]

    def writes_assembler(self, way: Way, assembly: pathlib.Path,
                         paths: list[str]) -> bool:
        """Does a unit hold assembler that the standard headers it includes do
        not make by themselves? <iostream> of libstdc++ 13 makes some."""
        found = assembler(assembly)
        if not found[1]:
            return False
        named = {name.decode() for text in self.files.values()
                 for name in STANDARD.findall(text)}
        names = tuple(sorted(name for name in named if any(
            path.startswith(SYSTEM) and path.endswith(f"/{name}")
            for path in paths)))
        known = self.kit.assembler
        if (way.kind, names) not in known:
            number = next(self.numbers)
            source = self.built / f"headers{number}.cpp"
            made = self.built / f"headers{number}.s"
            source.write_text("".join(f"#include <{name}>\n" for name in names),
                              encoding="utf-8")
            done = self.run([*self.compiler(way), "-S", "-o", made, source])
            if done.code != 0 or done.stopped:
                return True
            known[way.kind, names] = assembler(made)
        return found != known[way.kind, names]

    def run(self, command: list) -> sandbox.Outcome:
        read = ["/usr", "/lib", "/lib64", "/bin", "/etc/alternatives",
                "/etc/ld.so.cache", "/proc/self", self.kit.preludes,
                self.kit.include, TESTS, ASKED, ROOT / "CME212", self.folder,
                *self.kit.linked]
        jail = [*self.kit.jail, *flags("--read", read),
                *flags("--write", [self.built, "/dev/null"])]
        done = sandbox.run_compiler(jail, [str(word) for word in command],
                                    self.source, self.built, COMPILING)
        return done

    @staticmethod
    def split(output: str) -> tuple[list[str], str]:
        """The files that were read, and what else the compiler said."""
        paths = INCLUDED.findall(output)
        text = INCLUDED.sub("", output)
        return paths, text.partition("Multiple include guards")[0]

    def sort(self, paths: list[str]) -> tuple[str, frozenset[str]]:
        """The first path from outside, and names in the submission."""
        inside, source = set(), os.path.realpath(self.source) + "/"
        kit = tuple(os.path.realpath(path) + "/" for path in (
            TESTS, ASKED, ROOT / "CME212", self.kit.preludes, self.built))
        for path in paths:
            real = os.path.realpath(os.path.join(self.source, path))
            if real.startswith(source):
                inside.add(real[len(source):])
            elif not real.startswith((*kit, *(s + "/" for s in SYSTEM))):
                return path, frozenset()
        return "", frozenset(inside)

    def plain(self, text: str) -> str:
        """Without the names of this machine's folders."""
        for path, name in ((f"{self.source}/", ""), (f"{self.built}/", ""),
                           (f"{TESTS}/", "course/tests/"),
                           (f"{ASKED}/", "course/tests/"),
                           (f"{self.kit.include}/", ""),
                           (f"{ROOT}/", "")):
            text = text.replace(path, name)
        return re.sub(r"(?m)(^|(?<=from ))\./", "", text)


def flags(option: str, values: Iterable) -> list[str]:
    return [word for value in values for word in (option, str(value))]


def assembler(assembly: pathlib.Path) -> tuple[list[bytes], int]:
    """The parts that were assembler in the source, and how many borders parts
    have: text that holds a border of its own makes that number another."""
    text = assembly.read_bytes()
    return sorted(ASSEMBLER.findall(text)), len(BORDER.findall(text))


def reads_files(assembly: pathlib.Path) -> bool:
    """Does the compiler's output take in files?"""
    return any(
        not line.lstrip().startswith((b".string", b".ascii"))
        for line in re.findall(rb"[^\n]*\.inc(?:bin|lude)\b[^\n]*",
                               assembly.read_bytes()))
