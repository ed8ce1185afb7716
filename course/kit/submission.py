"""Take a stranger's sources from a folder, from a tag of a git clone, or a file
and what it includes: all that is graded, measured or shown comes in by here.

Nothing of it is run or trusted: no symbolic link is followed, no setting of a
clone is used, a repository takes nothing from another, and what is too large is
not read.
"""

import functools
import itertools
import os
import re
import resource
import signal
import stat
import subprocess
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import NoReturn

MOST_FILES = 200
MOST_ENTRIES = 20000
LARGEST = 1 << 20          # bytes of a file
LARGEST_ALL = 8 << 20
DEEPEST = 5                # folders below DIR
GIT_SECONDS = 30
GIT_MEMORY = 1 << 30       # bytes of address space
GIT_OUTPUT = 16 << 20      # bytes of an answer
PLAIN = re.compile(r"[A-Za-z0-9_+-][A-Za-z0-9_+. -]*")   # a name
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"\n]+)"', re.MULTILINE)
TAG = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
LISTED = re.compile(r"^[.!x]+ (.+)\n", re.MULTILINE)    # by -H of a compiler
EMBED = re.compile(r"^\s{0,99}(?:#|%:|\?\?=)\s{0,99}embed\b", re.MULTILINE)
# Folders of a starter that are not read: the kit has its own.
NOT_LOOKED_INTO = {"CME212", "CS207", "build", "data", "pages", "tests",
                   "tools", "web"}

# What other years hand out in the root; the kit has its own, too.
HANDED_OUT = {"Point.hpp", "BoundingBox.hpp"}

# Words that may show an attempt to cheat. The report lists them for a person to
# read; they cost no points, as most of them have honest uses.
OF_THE_GRADER = "names a part of the grader"
SUSPECT = [
    (r"\basm\b|\b__asm", "writes assembler"),
    (r"\bsyscall\b|\bptrace\b|\bprctl\b|\bseccomp|\bmprotect\b",
     "makes system calls"),
    (r"/proc/|/dev/fd|/autograder", "names a file of the system"),
    (r"\b(_exit|_Exit|quick_exit|at_quick_exit|atexit|on_exit|longjmp"
     r"|siglongjmp)\b", "leaves the program"),
    (r"\b(signal|sigaction|raise|fork|vfork|clone(?!\s*\(\s*\))|execv\w*"
     r"|execl\w*|popen|system|dlopen|dlsym|mmap|dup2?|pipe|socket|environ"
     r"|getenv|setrlimit)"
     r"\s*\(", "calls the system"),
    (r"\bkit\b|check\.hpp|runner\.cpp|\bKIT_\w+|\bTASK\s*\("
     r"|__(a|ub)san_|__sanitizer", OF_THE_GRADER),
    (r"\bno_sanitize|redefine_extname|pragma\s+weak|\b(alias|ifunc"
     r"|constructor|destructor|section|init_priority)\s*\(\s*\"?",
     "has attributes that change how a program is linked or checked"),
    (r"\bkit_missing\b|\bextern\s*\"C",
     "declares names of the kit or of C"),
    (r"##|%:%:|\b_Pragma\b|\bpush_macro\b", "pastes tokens"),
    (r"#\s*define\s+(private|protected|public|class|struct|return|if|while"
     r"|for|static|const|int|main|assert|static_cast|double|float|bool|auto"
     r"|void|operator|template|typename)\b",
     "redefines a keyword"),
    (r"\b(reinterpret|bit)_cast\b|\bstart_lifetime_as"
     r"|\((const |unsigned )*(char|void|long|int|double|(std::)?byte)\s*\*+"
     r"\s*\)[&\w(]", "reads memory as another type"),
]


Folder = str | os.PathLike[str]
Flag = tuple[str, int, str]     # name of a file, line, what it does


class BadInput(Exception):
    """What can't be graded; one sentence that says why."""


@dataclass
class Submission:
    files: dict[str, bytes]    # by relative name
    # Files that were left out, and why.
    notes: list[str] = field(default_factory=list)
    flags: list[Flag] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)  # name: why
    starter: str = ""       # the version with which it was begun, if it says so

    def add(self, name: str, entry: "Entry") -> None:
        """Take a file, or note why not."""
        problem, text = entry.problem, b""
        if not all(map(PLAIN.fullmatch, name.split("/"))):
            problem = problem or "has an unusual name"
        elif not problem and entry.size > LARGEST:
            problem = f"is larger than {LARGEST >> 20} MB"
        elif not problem and entry.size > LARGEST_ALL - sum(
                map(len, self.files.values())):
            problem = f"comes after the first {LARGEST_ALL >> 20} MB of files"
        elif not problem and len(self.files) == MOST_FILES:
            problem = f"comes after the first {MOST_FILES} files"
        if not problem:
            try:
                text = entry.read()
            except OSError as error:
                problem = f"can't be read ({error.strerror or error})"
        if not problem and EMBED.search(
                without_comments(text.decode("utf-8", "replace"))):
            problem = "has an #embed, which reads any file"
        if problem:
            self.left_out[name] = problem
            if len(self.left_out) <= 20:
                self.notes.append(f"{shown(name)} {problem}: left out")
        else:
            self.files[name] = text
            self.flags += suspects(name, text)


@dataclass
class Entry:
    path: str
    problem: str               # why it is not taken, or ""
    size: int
    read: Callable[[], bytes]


def reader(path: Folder) -> Callable[[], bytes]:
    """Reads a regular file, and no more of it than may be taken."""
    def read():
        fd = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with open(fd, "rb") as file:
            if not stat.S_ISREG(os.fstat(fd).st_mode):
                raise OSError("it is not a regular file any more")
            return file.read(LARGEST + 1)
    return read


def shown(text: object) -> str:
    """Any name on one line: what a terminal would obey, or show in another
    order, is written as its code."""
    return "".join(
        sign if sign.isprintable() else
        sign.encode("unicode_escape", "surrogatepass").decode()
        for sign in str(text))


def at(place: str, name: str) -> Entry:
    """What stands at a place, under a name. OSError if nothing does."""
    status = os.lstat(place)
    problem = "" if stat.S_ISREG(status.st_mode) else (
        "is a symbolic link" if stat.S_ISLNK(status.st_mode) else
        "is not a regular file")
    return Entry(name, problem, status.st_size, reader(place))


def in_folder(folder: Folder) -> list[Entry]:
    """All that stands in a folder, and may be looked at."""
    entries, waiting, seen = [], [""], 0
    while waiting:
        inside = waiting.pop()
        try:
            with os.scandir(os.path.join(folder, inside)) as content:
                found = sorted(itertools.islice(content, MOST_ENTRIES + 1),
                               key=lambda entry: os.fsencode(entry.name))
        except OSError as error:
            if not inside:
                raise BadInput(f"{shown(folder)}: {error.strerror}") from None
            continue
        seen += len(found)
        if seen > MOST_ENTRIES:
            raise BadInput(f"{shown(folder)}: holds too many files")
        for entry in found:
            path = os.path.join(inside, entry.name)
            if entry.is_dir(follow_symlinks=False):
                if may_look_into(path):
                    waiting.append(path)
                continue
            entries.append(at(entry.path, path))
    return entries


def may_look_into(path: str) -> bool:
    parts = path.split("/")
    return (len(parts) <= DEEPEST and not parts[-1].startswith(".")
            and parts[-1] not in NOT_LOOKED_INTO)


def repository(folder: Folder) -> str:
    """The repository of a clone, which may lie elsewhere: in_its_own()."""
    inside = os.path.join(os.path.abspath(folder), ".git")
    return inside if os.path.lexists(inside) else os.path.abspath(folder)


def in_its_own(folder: Folder) -> None:
    """Throws BadInput unless all of a clone's repository lies in it."""
    def refuse(what: str) -> NoReturn:
        raise BadInput(f"{shown(folder)}: its repository {what}: clone it")

    place, whole = repository(folder), os.path.realpath(folder) + os.sep
    if os.path.islink(place) or not os.path.isdir(place):
        refuse("lies elsewhere")
    for name in ("commondir", "objects/info/alternates"):
        if os.path.lexists(os.path.join(place, name)):
            refuse(f"takes from another one, by its file {name}")
    for inside, folders, files in os.walk(place):
        for name in (*folders, *files):
            path = os.path.join(inside, name)
            if os.path.islink(path) and not os.path.realpath(path).startswith(
                    whole):
                refuse(f"has a link that leads out of it, {shown(name)}")


def git(folder: Folder, *words: str) -> bytes:
    """Ask a clone, and let no setting of it run anything."""
    environment = {
        "PATH": "/usr/bin:/bin", "LC_ALL": "C", "HOME": "/nowhere",
        "GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": "/dev/null",
        "GIT_TERMINAL_PROMPT": "0", "GIT_NO_LAZY_FETCH": "1",
        "GIT_NO_REPLACE_OBJECTS": "1", "GIT_ALLOW_PROTOCOL": "none",
        "GIT_OPTIONAL_LOCKS": "0"}
    command = ["git", "-c", "safe.directory=*", "-c", "core.fsmonitor=false",
               "-c", "core.hooksPath=/dev/null", "-c", "protocol.allow=never",
               # Not the clone in which the folder happens to stand.
               f"--git-dir={repository(folder)}", *words]
    with subprocess.Popen(
            command, env=environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            preexec_fn=limit_git) as process:
        assert process.stdout and process.stderr
        try:
            output = process.stdout.read(GIT_OUTPUT + 1)
            if len(output) > GIT_OUTPUT:
                raise BadInput(f"{shown(folder)}: holds too many files")
            errors = process.stderr.read(GIT_OUTPUT)
        finally:
            process.kill()
    if process.returncode:
        said = errors.decode("utf-8", "replace").strip().split("\n")[0]
        raise BadInput(f"{shown(folder)}: git says: "
                       + (shown(said) or "nothing, within its limits"))
    return output


def limit_git() -> None:
    for what, most in ((resource.RLIMIT_CPU, GIT_SECONDS),
                       (resource.RLIMIT_AS, GIT_MEMORY),
                       (resource.RLIMIT_CORE, 0)):
        resource.setrlimit(what, (most, most))
    signal.alarm(4 * GIT_SECONDS)       # it may wait, too


def tags(folder: Folder, tag: str) -> list[str]:
    """The tags of a clone, in which `tag` is looked for."""
    if not TAG.fullmatch(tag):
        raise BadInput(f"HW={shown(tag)} is not the name of a tag")
    if not os.path.isdir(folder):
        raise BadInput(f"{shown(folder)}: no such folder")
    in_its_own(folder)
    return git(folder, "for-each-ref", "--format=%(refname:strip=2)",
               "refs/tags").decode("utf-8", "replace").split()


def in_tag(folder: Folder, tag: str) -> list[Entry]:
    """All that a tag of a clone holds."""
    names = tags(folder, tag)
    if tag not in names:
        there = ", ".join(map(shown, names[:20])) or "none"
        raise BadInput(f"{shown(folder)}: has no tag {tag}; tags: {there}")
    listing = git(folder, "ls-tree", "-r", "-l", "-z", "--full-tree",
                  f"refs/tags/{tag}^{{commit}}")
    entries = []
    for line in listing.split(b"\0")[:-1]:
        description, _, place = line.partition(b"\t")
        mode, kind, blob, size = description.decode("ascii",
                                                    "replace").split()
        if kind != "blob":
            continue
        path = os.fsdecode(place)
        folders = path.split("/")[:-1]
        if not all(may_look_into("/".join(folders[:n + 1]))
                   for n in range(len(folders))):
            continue
        problem = ("is a symbolic link" if mode == "120000" else
                   "" if size.isdecimal() else "is not in the clone")
        entries.append(Entry(
            path, problem, int(size) if size.isdecimal() else 0,
            functools.partial(git, folder, "cat-file", "blob", blob)))
    return entries


def room_of(entries: list[Entry], tag: str, folder: Folder) -> str:
    """The folder of the submission that holds its Graph.hpp, as "" or "x/"."""
    rooms = sorted({entry.path[:-len("Graph.hpp")] for entry in entries
                    if os.path.basename(entry.path) == "Graph.hpp"})
    for room in ("", tag + "/", "hw2/", *(rooms if len(rooms) == 1 else [])):
        if room in rooms:
            return room
    if rooms:
        raise BadInput(
            f"{shown(folder)}: Graph.hpp is in several folders; name one "
            "of them: " + ", ".join(map(shown, rooms[:10])))
    raise BadInput(f"{shown(folder)}: holds no Graph.hpp")


def take(folder: Folder, tag: str = "") -> Submission:
    """The submission in a folder, or in a tag of the clone in it."""
    entries = in_tag(folder, tag) if tag else in_folder(folder)
    room = room_of(entries, tag or "hw2", folder)
    taken = Submission({})
    if room:
        taken.notes.append(f"the graded folder is {shown(room)}")
    for entry in sorted(entries, key=lambda entry: (entry.path.count("/"),
                                                    entry.path)):
        name = entry.path[len(room):]
        if entry.path == room + ".starter" and not entry.problem:
            taken.starter = shown(entry.read()[:80].decode(
                "ascii", "replace").strip())
        if (entry.path.startswith(room) and name not in HANDED_OUT
                and name.endswith((".hpp", ".h", ".cpp"))):
            taken.add(name, entry)
    if problem := taken.left_out.get("Graph.hpp"):
        raise BadInput(f"{shown(folder)}: Graph.hpp {problem}")
    return taken


def take_file(path: Folder, *more: str) -> Submission:
    """A file, `more` of its folder, and what these include of it; the
    submission's names are those in the folder."""
    folder, first = os.path.split(os.path.abspath(path))
    taken, waiting = Submission({}), [first, *more]
    while waiting:
        name = waiting.pop(0)
        if name in taken.files or name in taken.left_out:
            continue
        there = os.path.join(folder, name)
        try:
            entry = at(there, name)
        except OSError as error:
            if name == first:
                raise BadInput(f"{shown(path)}: {error.strerror}") from None
            continue            # the compiler's, or it says that it is missing
        if os.path.realpath(there) != f"{os.path.realpath(folder)}/{name}":
            entry.problem = entry.problem or "lies behind a symbolic link"
        taken.add(name, entry)
        if problem := taken.left_out.get(name):
            raise BadInput(f"{shown(there)} {problem}")
        for included in INCLUDE.findall(joined(
                taken.files[name].decode("utf-8", "replace"))):
            for base in (os.path.dirname(name), ""):
                found = os.path.normpath(os.path.join(base, included))
                if not found.startswith((".", "/", "CME212/")):
                    waiting.append(found)
    return taken


def listed(output: str) -> tuple[list[str], str]:
    """The files that a compiler with -H has read, and what else it said."""
    return (LISTED.findall(output),
            LISTED.sub("", output).partition("Multiple include guards")[0])


def from_where(paths: list[str], source: Folder,
               own: Iterable[Folder]) -> tuple[str, frozenset[str]]:
    """The first of the paths that is neither in the folder `source`, nor one of
    `own` or below it; and the names in `source`."""
    inside, there = set(), os.path.realpath(source) + "/"
    allowed = tuple(os.path.realpath(path) + "/" for path in own)
    for path in paths:
        real = os.path.realpath(os.path.join(source, path))
        if real.startswith(there):
            inside.add(real[len(there):])
        elif not (real + "/").startswith(allowed):
            return path, frozenset()
    return "", frozenset(inside)


def joined(text: str) -> str:
    """C++ without broken lines; as many lines."""
    lines, broken = [], []
    for line in text.split("\n"):
        if line.rstrip().endswith("\\"):
            broken.append(line.rstrip()[:-1])
        else:
            lines.append("".join([*broken, line]))
            lines += [""] * len(broken)
            broken = []
    return "\n".join([*lines, *broken])


# What has no end goes to the end: each character is looked at once.
COMMENT_OR_TEXT = re.compile(
    r"""R"(?P<mark>[^()\\\s]{0,16})\(.*?(?:\)(?P=mark)"|\Z)"""
    r"""|//[^\n]*|/\*.*?(?:\*/|\Z)"""
    r"""|"(?:\\.|[^"\\\n])*(?:"|\\?\Z|(?=\n))"""
    r"""|'(?:\\.|[^'\\\n])*(?:'|\\?\Z|(?=\n))""", re.DOTALL)


def without_comments(text: str, begins: str = "/") -> str:
    """C++ without broken lines and without comments; '/"R': and strings; as
    many lines."""
    def blank(match):
        found = match[0]
        return " " + "\n" * found.count("\n") if found[0] in begins else found
    return COMMENT_OR_TEXT.sub(blank, joined(text))


def to_look_at(flags: list[Flag]) -> list[str]:
    return [f"look at {file}:{line} by hand: it {what}"
            for file, line, what in flags]


def suspects(name: str, text: bytes) -> list[Flag]:
    """Lines that a person should look at: (name, line, what)."""
    found = []
    lines = without_comments(text.decode("utf-8", "replace")).split("\n")
    for pattern, what in SUSPECT:
        for number, line in enumerate(lines, 1):
            if re.search(pattern, line):
                found.append((name, number, what))
                break
    return found
