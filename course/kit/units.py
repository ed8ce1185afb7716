"""Build test programs of a submission.

A test program is one unit: the bridge, then the tests, one file each, and what
the judge asks beside them (course/asked). All files that it reads are listed by
the compiler; one from outside of the submission and the kit is refused.

The kit's files are named by whole paths, so no file of a submission can stand
for them; and its macros end where the kit's own code begins.
"""

import functools
import itertools
import pathlib
import re
from collections.abc import Collection, Iterable
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
YEARS = ROOT / "course/years"   # what other years hand out, by its names
WORD = re.compile(r"[A-Za-z_]\w*")
SPACE = r"(?:[ \t]|/\*(?:[^*]|\*(?!/)){0,60}+\*/){0,20}+"
MACRO = re.compile(rf"(?:#|%:|\?\?=){SPACE}define{SPACE}([A-Za-z_]\w*)")
DENIED = re.compile(r"fatal error: (.*): Permission denied$", re.MULTILINE)
STANDARD = re.compile(rb"^[ \t]*#[ \t]*include[ \t]*<([\w./+-]+)>",
                      re.MULTILINE)
# A compiler or linker that finds a fault names its place; memory that a source
# needs is the source's. Else the machine is at fault: its disk, who kills it.
PLACE = re.compile(r"^\S+:\d+(?::\d+)?: .*error|undefined (?:reference|symbol)"
                   r"|multiple definition|duplicate symbol|out of memory"
                   r"|memory exhausted", re.MULTILINE)
UNWRITTEN = re.compile(r"fatal error: (?:error writing to|can.t write)", re.I)
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
    right: bool = False              # it compiles
    seconds: float = 0               # of processor time
    paths: list = field(default_factory=list)   # that the compiler read
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
def words_of(*folders: pathlib.Path) -> frozenset[str]:
    """Each word that the C++ in our folders is written with."""
    return frozenset(
        word for folder in folders for path in folder.glob("*.[hc]pp")
        for word in WORD.findall(path.read_text(encoding="utf-8")))


def macros(files: dict[str, bytes], words: Collection[str]) -> list[str]:
    """The macros of a submission that would change code of these words."""
    names = set()
    for text in files.values():
        names |= set(MACRO.findall(
            submission.joined(text.decode("utf-8", "replace"))))
    return sorted(names & set(words))


class Sources:
    """A folder with a stranger's sources, where they are compiled in the jail.

    `own` are the files and folders of ours that they may include; macros that
    would change these words end by the file undefined.hpp."""

    def __init__(self, jail: list[str], folder: pathlib.Path,
                 files: dict[str, bytes], own: Iterable[pathlib.Path],
                 words: Collection[str]):
        self.jail, self.folder, self.files = jail, folder, files
        self.own = [*own]
        self.source = folder / "source"
        self.built = folder / "built"
        for path in (self.source, self.built):
            path.mkdir(parents=True)
            path.chmod(0o755)
        for name, text in files.items():
            path = self.source / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)
        self.undefined = self.built / "undefined.hpp"
        self.undefined.write_text("".join(
            f"#undef {name}\n" for name in macros(files, words))
            + "#include <cassert>\n", encoding="utf-8")

    def compiled(self, command: list,
                 limits: sandbox.Limits = COMPILING) -> Unit:
        """The unit, without a program, that a compiler makes of them."""
        done = self.run([*command, "-H"], limits)
        paths, text = submission.listed(done.output)
        outside, inside = submission.from_where(
            paths, self.source, [*self.own, self.built, *SYSTEM])
        if denied := DENIED.search(text):
            outside = denied[1]
        result = Unit(None, self.plain(text), inside, paths=paths,
                      seconds=done.seconds,
                      right=done.code == 0 and not done.stopped)
        if outside:
            result.refused = (f"#include of {self.plain(outside)}: it is not "
                              "yours")
            result.doubtful = "includes a file that is not its own"
            result.output, result.right = "", False
            result.included = frozenset(self.files)     # or any other
        elif done.stopped:
            result.refused = {"time": "it takes too long to compile",
                              "output": "it fills the compiler's output"}.get(
                                  done.stopped, "it takes too much to compile")
        return result

    def run(self, command: list,
            limits: sandbox.Limits = COMPILING) -> sandbox.Outcome:
        jail = [*self.jail, *flags("--read", [
            "/usr", "/lib", "/lib64", "/bin", "/etc/alternatives",
            "/etc/ld.so.cache", "/proc/self", *self.own, self.folder]),
            *flags("--write", [self.built, "/dev/null"])]
        for _ in range(2):
            done = sandbox.run_compiler(jail, [str(word) for word in command],
                                        self.source, self.built, limits)
            if done.stopped or not done.code or blames_source(done.output):
                return done
        raise once.KitError("the compiler fails without a fault in a source: "
                            + self.plain(done.output).strip()[-200:])

    def plain(self, text: str) -> str:
        """Without the names of this machine's folders."""
        for path in (self.source, self.built, ROOT):
            text = text.replace(f"{path}/", "")
        return re.sub(r"(?m)(^|(?<=from ))\./", "", text)


class Room(Sources):
    """A submission's sources, with which tests are built."""

    def __init__(self, kit: once.Kit, folder: pathlib.Path,
                 files: dict[str, bytes], given: pathlib.Path | None = None):
        super().__init__(kit.jail, folder, files, [
            TESTS, ASKED, YEARS, ROOT / "CME212", kit.preludes, kit.include,
            *([given] if given else []), *kit.linked], words_of(TESTS, ASKED))
        self.kit = kit
        self.given = given      # by an older starter: years.py
        self.names = dict(files)     # those that the student wrote
        self.tests: tuple[pathlib.Path, ...] = (TESTS, ASKED)
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
        command = [*self.compiler(way),
                   "-fmax-errors=200", "-fdiagnostics-plain-output",
                   "-ftemplate-depth=400",
                   *self.of_starter(),
                   "-I", TESTS / "headless", "-I", self.kit.include,
                   *flags("-I", [self.given] * bool(self.given)),
                   "-I", YEARS,
                   # A header of the system is no file of the submission's.
                   "-iquote", ".", "-idirafter", ".",
                   f'-DKIT_UNDEFINED="{self.undefined}"',
                   *(f"-D{name}" for name in way.defines),
                   f"-fdebug-prefix-map={self.source}=.",
                   *(["-S", "-o", assembly] if link else ["-fsyntax-only"]),
                   unit]
        result = self.compiled(command)
        result.tests = list(tests)
        result.stage = next((name.partition("=")[2] for name in way.defines
                             if name.startswith("KIT_STAGE=")), "")
        if result.right and link:
            if reads_files(assembly) or self.writes_assembler(
                    way, assembly, result.paths):
                result.refused = result.doubtful = "it writes assembler"
                return result
            done = self.run([once.CXX, *once.LINK[way.kind], assembly,
                             *self.kit.linked, "-pthread", "-o", program])
            result.output += self.plain(done.output)
            result.seconds += done.seconds
            if done.code == 0 and not done.stopped:
                result.program = program
        assembly.unlink(missing_ok=True)
        return result

    def of_starter(self) -> list:
        """Options for what an older starter gave: its names; and its headers
        before ours, for a graph that is not ours."""
        if not self.given:
            return []
        names = self.given / "names.hpp"
        return (["-include", names] * names.exists()
                + ["-I", self.given] * ("Graph.hpp" in self.names))

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

    def plain(self, text: str) -> str:
        for path, name in ((TESTS, "course/tests/"), (ASKED, "course/tests/"),
                           (self.kit.include, "")):
            text = text.replace(f"{path}/", name)
        return super().plain(text)


def blames_source(output: str) -> bool:
    """Does a compiler that failed name a fault of what it read?"""
    return bool(PLACE.search(output)) and not UNWRITTEN.search(output)


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
