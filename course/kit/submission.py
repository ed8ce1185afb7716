"""Take a submission's sources from a folder, or from a tag of a git clone.

Nothing of the submission is run or trusted here: no symbolic link is followed,
no setting of its clone is used, and what is too large is not read.
"""

import functools
import itertools
import os
import re
import resource
import signal
import stat
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field

MOST_FILES = 200
MOST_ENTRIES = 20000
LARGEST = 1 << 20          # bytes of a file
LARGEST_ALL = 8 << 20
DEEPEST = 5                # folders below DIR
GIT_SECONDS = 30
GIT_MEMORY = 1 << 30       # bytes of address space
GIT_OUTPUT = 16 << 20      # bytes of an answer
PLAIN = re.compile(r"[A-Za-z0-9_+-][A-Za-z0-9_+. -]*")   # a name
TAG = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
# Folders of a starter that are not read: the kit has its own.
NOT_LOOKED_INTO = {"CME212", "build", "data", "pages", "tests", "tools",
                   "web"}

# Words that may show an attempt to cheat. The report lists them for a person to
# read; they cost no points, as most of them have honest uses.
SUSPECT = [
    (r"\basm\b|\b__asm", "writes assembler"),
    (r"\bsyscall\b|\bptrace\b|\bprctl\b|\bseccomp|\bmprotect\b",
     "makes system calls"),
    (r"/proc/|/dev/fd|/autograder", "names a file of the system"),
    (r"\b(_exit|_Exit|quick_exit|at_quick_exit|atexit|on_exit|longjmp"
     r"|siglongjmp)\b", "leaves the program"),
    (r"\b(signal|sigaction|raise|fork|vfork|clone|execv\w*|execl\w*|popen"
     r"|system|dlopen|dlsym|mmap|dup2?|pipe|socket|environ|getenv|setrlimit)"
     r"\s*\(", "calls the system"),
    (r"\bkit\b|check\.hpp|runner\.cpp|\bKIT_\w+|\bTASK\s*\("
     r"|__(a|ub)san_|__sanitizer", "names a part of the grader"),
    (r"\bno_sanitize|redefine_extname|pragma\s+weak|\b(alias|ifunc"
     r"|constructor|destructor|section|init_priority)\s*\(\s*\"?",
     "has attributes that change how a program is linked or checked"),
    (r"\bkit_missing\b|\bextern\s*\"C",
     "declares names of the kit or of C"),
    (r"##|%:%:|\b_Pragma\b|\bpush_macro\b", "pastes tokens"),
    (r"#\s*define\s+(private|protected|public|class|struct|return|if|while"
     r"|for|static|const|int|main|assert|static_cast)\b",
     "redefines a keyword"),
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


@dataclass
class Entry:
    path: str
    problem: str               # why it is not taken, or ""
    size: int
    read: Callable[[], bytes]


def shown(text: object) -> str:
    """Any name as ASCII on one line."""
    return str(text).encode("ascii", "backslashreplace").decode().translate(
        {code: f"\\x{code:02x}" for code in [*range(32), 127]})


def in_folder(folder: Folder) -> list[Entry]:
    """All that stands in a folder, and may be looked at."""
    def read(path):
        def do():
            fd = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            with open(fd, "rb") as file:
                if not stat.S_ISREG(os.fstat(fd).st_mode):
                    raise OSError("it is not a regular file any more")
                return file.read(LARGEST + 1)
        return do

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
            status = entry.stat(follow_symlinks=False)
            problem = "" if stat.S_ISREG(status.st_mode) else (
                "is a symbolic link" if entry.is_symlink() else
                "is not a regular file")
            entries.append(Entry(path, problem, status.st_size,
                                 read(entry.path)))
    return entries


def may_look_into(path: str) -> bool:
    parts = path.split("/")
    return (len(parts) <= DEEPEST and not parts[-1].startswith(".")
            and parts[-1] not in NOT_LOOKED_INTO)


def git(folder: Folder, *words: str) -> bytes:
    """Ask a clone, and let no setting of it run anything."""
    environment = {
        "PATH": "/usr/bin:/bin", "LC_ALL": "C", "HOME": "/nowhere",
        "GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": "/dev/null",
        "GIT_TERMINAL_PROMPT": "0", "GIT_NO_LAZY_FETCH": "1",
        "GIT_NO_REPLACE_OBJECTS": "1", "GIT_ALLOW_PROTOCOL": "none",
        "GIT_OPTIONAL_LOCKS": "0",
        # Not the clone in which the folder happens to stand.
        "GIT_CEILING_DIRECTORIES": os.path.dirname(os.path.realpath(folder))}
    command = ["git", "-c", "safe.directory=*", "-c", "core.fsmonitor=false",
               "-c", "core.hooksPath=/dev/null", "-c", "protocol.allow=never",
               "-C", folder, *words]
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
    total = 0
    for entry in sorted(entries, key=lambda entry: (entry.path.count("/"),
                                                    entry.path)):
        name = entry.path[len(room):]
        if (not entry.path.startswith(room)
                or not name.endswith((".hpp", ".h", ".cpp"))):
            continue
        problem, text = entry.problem, b""
        if not all(map(PLAIN.fullmatch, name.split("/"))):
            problem = problem or "has an unusual name"
        elif not problem and entry.size > LARGEST:
            problem = f"is larger than {LARGEST >> 20} MB"
        elif not problem and total + entry.size > LARGEST_ALL:
            problem = f"comes after the first {LARGEST_ALL >> 20} MB of files"
        elif not problem and len(taken.files) == MOST_FILES:
            problem = f"comes after the first {MOST_FILES} files"
        if not problem:
            try:
                text = entry.read()
            except OSError as error:
                problem = f"can't be read ({error.strerror or error})"
        if not problem:
            taken.files[name] = text
            total += len(text)
            taken.flags += suspects(name, text)
        elif name == "Graph.hpp":
            raise BadInput(f"{shown(folder)}: Graph.hpp {problem}")
        elif len(taken.notes) < 20:
            taken.notes.append(f"{shown(name)} {problem}: left out")
    return taken


def joined(text: str) -> str:
    """C++ without broken lines; as many lines."""
    lines, broken = [], []
    for line in text.split("\n"):
        if line.endswith("\\"):
            broken.append(line[:-1])
        else:
            lines.append(" ".join([*broken, line]))
            lines += [""] * len(broken)
            broken = []
    return "\n".join([*lines, *broken])


# What has no end goes to the end: each character is looked at once.
COMMENT_OR_TEXT = re.compile(
    r"""R"(?P<mark>[^()\\\s]{0,16})\(.*?(?:\)(?P=mark)"|\Z)"""
    r"""|//[^\n]*|/\*.*?(?:\*/|\Z)"""
    r"""|"(?:\\.|[^"\\\n])*+(?:"|\\?\Z|(?=\n))"""
    r"""|'(?:\\.|[^'\\\n])*+(?:'|\\?\Z|(?=\n))""", re.DOTALL)


def without_comments(text: str) -> str:
    """C++ without comments and without broken lines; as many lines."""
    def blank(match):
        found = match[0]
        return " " + "\n" * found.count("\n") if found[0] == "/" else found
    return COMMENT_OR_TEXT.sub(blank, joined(text))


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
