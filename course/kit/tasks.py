"""Read and check course/tasks.toml: the tasks of the assignment as data."""
import pathlib
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass

try:
    import tomllib
except ImportError:     # Python 3.10
    try:
        import tomli as tomllib  # type: ignore[no-redef]
    except ImportError:
        sys.exit("Python before 3.11 needs tomli: apt-get install "
                 "python3-tomli, or pip install tomli")

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = "course/tasks.toml"

NEEDS = ("graph", "cloth", "step")
SECTION_ID = re.compile(r"[A-Za-z0-9]+(\.[A-Za-z0-9]+)*")
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
TEST = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*")
NO_CONTROLS = re.compile(r"[^\x00-\x1f\x7f]+")


class Faults(Exception):
    """Each of `faults` is `FILE:LINE: what is wrong`."""

    def __init__(self, faults):
        super().__init__("\n".join(faults))
        self.faults = faults


class TasksError(Faults):
    """Of tasks.toml."""


@dataclass(frozen=True)
class Section:
    id: str
    title: str
    page: str | None  # a file in course/
    line: int


@dataclass(frozen=True)
class Task:
    id: str
    title: str
    points: int
    needs: str  # "graph": Graph.hpp alone; "cloth": mass_spring.*, too;
    #             "step": mine.hpp, too
    says: str
    hint: str
    tests: tuple  # names in course/tests, without .cpp: all must pass
    extra: bool  # shown, never counted
    section: Section
    line: int

    @property
    def counted(self) -> int:
        return 0 if self.extra else self.points

    @property
    def worth(self) -> str:
        return f"{self.points} point" + ("" if self.points == 1 else "s")


@dataclass(frozen=True)
class Course:
    title: str
    tag: str
    sections: tuple  # in the order of the file; without those dropped
    tasks: dict  # id -> Task, in the order of the file; likewise
    dropped: frozenset  # ids of tasks that are not asked for

    @property
    def points(self) -> int:
        return sum(task.counted for task in self.tasks.values())

    def tasks_of(self, section: Section) -> list[Task]:
        return [t for t in self.tasks.values() if t.section == section]


# The keys of a table: key -> (type, is it required?)
COURSE_KEYS = {"title": (str, True), "tag": (str, True)}
SECTION_KEYS = {"id": (str, True), "title": (str, True), "page": (str, False),
                "dropped": (bool, False)}
TASK_KEYS = {"id": (str, True), "title": (str, True), "points": (int, True),
             "needs": (str, True), "says": (str, True), "hint": (str, True),
             "tests": (list, False), "extra": (bool, False),
             "dropped": (bool, False)}
TYPES = {str: "a text", int: "a whole number", bool: "true or false",
         list: "a list"}


class Reader:
    """Collects faults, so that one look shows them all."""

    def __init__(self, text: str, name: str):
        self.name = name
        self.faults: list[str] = []
        # header -> the lines it stands on
        self.lines: dict[str, list[int]] = {}
        for number, line in enumerate(text.splitlines(), 1):
            header = line.split("#")[0].strip()
            if header in ("[course]", "[[section]]", "[[task]]"):
                self.lines.setdefault(header.strip("[]"), []).append(number)

    def fault(self, line: int, what: str) -> None:
        self.faults.append(f"{self.name}:{line}: {what}")

    def line_of(self, kind: str, index: int = 0) -> int:
        lines = self.lines.get(kind, [])
        return lines[index] if index < len(lines) else 1

    def keys(self, table: dict, keys: dict, line: int) -> bool:
        """True if all that must be there is there, and of its type."""
        before = len(self.faults)
        for key in table:
            if key not in keys:
                self.fault(line, f"unknown key '{key}', expected one of: "
                           + " ".join(keys))
        for key, (kind, needed) in keys.items():
            if key not in table:
                if needed:
                    self.fault(line, f"'{key}' is missing")
            elif type(table[key]) is not kind:
                self.fault(line, f"'{key}' is not {TYPES[kind]}")
            elif kind is str and not NO_CONTROLS.fullmatch(table[key]):
                self.fault(line, f"'{key}' is not a text of one line")
        return len(self.faults) == before

    def tables(self, data: dict, kind: str) -> Iterator[tuple[int, dict]]:
        """Each table of the list `kind` with its line."""
        found = data.get(kind, [])
        if not isinstance(found, list) or not found or not all(
                isinstance(table, dict) for table in found):
            self.fault(1, f"expected [[{kind}]]")
            return
        for index, table in enumerate(found):
            yield self.line_of(kind, index), table


def parse(text: str, name: str = FILE) -> Course:
    """The Course that `text` says.  Throws TasksError."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"at line (\d+)", str(error))
        raise TasksError([f"{name}:{line[1] if line else 1}: {error}"]) \
            from None
    read = Reader(text, name)
    for key in data:
        if key not in ("course", "section", "task"):
            read.fault(1, f"unknown table '{key}', expected: "
                       "[course] [[section]] [[task]]")
    head = data.get("course")
    if not isinstance(head, dict):
        read.fault(1, "expected [course]")
    else:
        read.keys(head, COURSE_KEYS, read.line_of("course"))
    sections, unasked = sections_of(data, read)
    tasks, dropped = tasks_of(data, read, sections, unasked)
    if read.faults or not isinstance(head, dict):
        raise TasksError(read.faults)
    return Course(head["title"], head["tag"],
                  tuple(s for s in sections.values() if s.id not in unasked),
                  tasks, frozenset(dropped))


def sections_of(data: dict, read: Reader) -> tuple[
        dict[str, Section], set[str]]:
    """The sections by id, and the ids of those dropped."""
    sections: dict[str, Section] = {}
    dropped: set[str] = set()
    for line, table in read.tables(data, "section"):
        if not read.keys(table, SECTION_KEYS, line):
            continue
        section = Section(table["id"], table["title"], table.get("page"), line)
        if not SECTION_ID.fullmatch(section.id):
            read.fault(line, f"'{section.id}' is no id of a section, "
                       "expected one as 7.1")
        if section.id in sections:
            read.fault(line, f"section {section.id} was there before: line "
                       f"{sections[section.id].line}")
        sections[section.id] = section
        if table.get("dropped"):
            dropped.add(section.id)
    return sections, dropped


def tasks_of(data: dict, read: Reader, sections: dict[str, Section],
             unasked: set[str]) -> tuple[dict[str, Task], set[str]]:
    """The tasks by id, without those dropped; and the ids of these."""
    tasks: dict[str, Task] = {}
    dropped: set[str] = set()
    lines: dict[str, int] = {}
    for line, table in read.tables(data, "task"):
        if not read.keys(table, TASK_KEYS, line):
            continue
        id = table["id"]
        section, _, task_name = id.rpartition(".")
        if section not in sections or not NAME.fullmatch(task_name):
            read.fault(line, f"'{id}' is no id of a task, expected "
                       "SECTION.NAME of a section that stands above")
            continue
        if id in lines:
            read.fault(line, f"task {id} was there before: line {lines[id]}")
        lines[id] = line
        if table["points"] < 0:
            read.fault(line, f"{id}: points are negative")
        if table["needs"] not in NEEDS:
            read.fault(line, f"{id}: needs '{table['needs']}', expected "
                       "graph, cloth or step")
        tests = table.get("tests", [id])
        if not tests or not all(
                isinstance(t, str) and TEST.fullmatch(t) for t in tests):
            read.fault(line, f"{id}: tests are names of files in course/tests,"
                       " without .cpp")
        if table.get("dropped") or section in unasked:
            dropped.add(id)
            continue
        tasks[id] = Task(id, table["title"], table["points"], table["needs"],
                         table["says"], table["hint"], tuple(tests),
                         table.get("extra", False), sections[section], line)
    return tasks, dropped


def load(path: pathlib.Path | None = None) -> Course:
    """The Course of a file, by default this repository's."""
    path = pathlib.Path(path) if path else ROOT / FILE
    name = FILE if path == ROOT / FILE else str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8"
        raise TasksError([f"{name}: can't be read ({reason})"]) from None
    return parse(text, name)
