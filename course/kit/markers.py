"""Split a source with markers into solution and starter.

    // BEGIN SOLUTION 7.1.remove_node
    ...
    // STUB (void)n;
    // STUB return 0;
    // END SOLUTION

The solution stands between BEGIN and the first STUB, if there is one. In a
starter a comment and the stubs stand in its place. Run as a program it checks
the repository's sources.

    // BEGIN GUIDED
    ...
    // OPEN code
    // END GUIDED

A starter of the level open leaves out what students are to design: all up to
the first OPEN, with the regions in it. Comments that name their tasks, and the
code behind each OPEN, stand in its place. If one of these tasks was dropped, so
that its solution is given, its block is that of the level guided, unless it has
no OPEN: then it is left out.
"""
import pathlib
import re
import sys
from collections.abc import Container
from dataclasses import dataclass

import tasks

# The sources with markers, in the order in which they are read.
SOURCES = ("Graph.hpp", "mass_spring.hpp", "mass_spring.cpp", "mine.hpp")
OPEN_GRAPH = "course/starter/open/Graph.hpp"  # another one, for the level open

BEGIN = re.compile(r"( *)// BEGIN SOLUTION (\S+)")
STUB = re.compile(r"( *)// STUB (\S.*| +\S.*)")
END = re.compile(r" *// END SOLUTION")
BEGIN_GUIDED = re.compile(r"( *)// BEGIN GUIDED")
END_GUIDED = re.compile(r" *// END GUIDED")
OPEN = re.compile(r"( *)// OPEN (\S.*| +\S.*)")
GUIDED = re.compile(r"^ *// BEGIN GUIDED\n(.*?)^ *// END GUIDED\n", re.M | re.S)
LOOKS_LIKE_ONE = re.compile(
    r"\b(begin|end)\W+(solution|guided)\b|//\W*(stub|open)\b",
    re.IGNORECASE)


class MarkerError(tasks.Faults):
    """Faults of a source with markers."""


@dataclass(frozen=True)
class Region:
    task: str
    indent: str
    solution: tuple[str, ...]  # lines
    stubs: tuple[str, ...]  # lines
    file: str
    line: int  # of BEGIN
    is_open: bool  # a guided one, at the level open


def split(text: str, file: str, level: str = "guided") -> list[str | Region]:
    """`text` as a list of lines and Regions; of what is guided, the level open
    has the code behind each OPEN, and of regions where they were.  Throws
    MarkerError."""
    pieces: list[str | Region] = []
    faults: list[str] = []
    # The line number and the match of an open region.
    begin: tuple[int, re.Match[str]] | None = None
    guided: tuple[int, str] | None = None  # likewise, and its indentation
    solution: list[str] = []
    stubs: list[str] = []

    def fault(what, at):
        faults.append(f"{file}:{at}: {what}")

    for number, line in enumerate(text.splitlines(keepends=True), 1):
        bare = line.rstrip("\r\n")
        if match := BEGIN.fullmatch(bare):
            if begin:
                fault("BEGIN SOLUTION in a region that began in line "
                      f"{begin[0]}: regions do not nest", number)
            begin, solution, stubs = (number, match), [], []
        elif END.fullmatch(bare):
            if not begin:
                fault("END SOLUTION without a BEGIN SOLUTION", number)
                continue
            at, head = begin
            if not "".join(solution).strip():
                fault("the region holds no solution", at)
            is_open = bool(guided) and level == "open"
            pieces.append(Region(
                head[2], guided[1] if guided and is_open else head[1],
                tuple(solution), tuple(stubs), file, at, is_open))
            begin = None
        elif match := BEGIN_GUIDED.fullmatch(bare):
            if begin or guided:
                fault("BEGIN GUIDED in a region", number)
            guided = number, match[1]
        elif END_GUIDED.fullmatch(bare):
            if begin or not guided:
                fault("END GUIDED without a BEGIN GUIDED", number)
            guided = None
        elif match := OPEN.fullmatch(bare):
            if begin or not guided:
                fault("OPEN outside of BEGIN GUIDED", number)
            elif level == "open":
                pieces.append(match[1] + match[2] + "\n")
        elif match := STUB.fullmatch(bare):
            if not begin:
                fault("STUB outside of a region", number)
            stubs.append(match[1] + match[2] + "\n")
        elif LOOKS_LIKE_ONE.search(bare):
            fault("this marker is malformed, expected '// BEGIN SOLUTION "
                  "TASK', '// STUB code' or '// END SOLUTION' on a line of its "
                  "own", number)
        elif not begin:
            pieces += [line] * (not guided or level == "guided")
        elif stubs:
            fault("code behind a STUB: stubs stand last in a region", number)
        else:
            solution.append(line)
    if begin:
        fault("BEGIN SOLUTION without an END SOLUTION", begin[0])
    if guided:
        fault("BEGIN GUIDED without an END GUIDED", guided[0])
    if faults:
        raise MarkerError(faults)
    return pieces


def regions(text: str, file: str) -> list[Region]:
    return [piece for piece in split(text, file) if isinstance(piece, Region)]


def solution(text: str, file: str = "text") -> str:
    """`text` without its markers."""
    return stub(text, (), file=file)


def stub(text: str, only: Container[str], course: tasks.Course | None = None,
         file: str = "text", level: str = "guided") -> str:
    """`text` without its markers, and with stubs in place of the solutions of
    the tasks `only`. The comment above them names the page if the
    `course` is given.  Throws MarkerError."""
    out, left_open = [], set()

    def given(block: re.Match[str]) -> str:
        tasks_in = [found[2] for found in BEGIN.finditer(block[1])]
        code, opens = re.subn(r"(?m)^ *// OPEN .*\n", "", block[1])
        return (code if opens and any(task not in only for task in tasks_in)
                else block[0])

    if level == "open":
        text = GUIDED.sub(given, text)
    for piece in split(text, file, level):
        if not isinstance(piece, Region):
            out.append(piece)
        elif piece.task not in only:
            out += () if piece.is_open else piece.solution
        elif piece.task not in left_open:
            task = course.tasks.get(piece.task) if course else None
            page = (f": course page {task.section.number}"
                    if task and task.section.page else "")
            shown = task.shown if task else piece.task
            out.append(f"{piece.indent}// YOUR CODE {shown}{page}\n")
            if piece.is_open:
                left_open.add(piece.task)
            else:
                out += piece.stubs
    return "".join(out)


def starter(text: str, course: tasks.Course, file: str = "text",
            level: str = "guided") -> str:
    """`text` as the students get it: stubs for all tasks that are asked."""
    return stub(text, course.tasks, course, file, level)


def check(texts: dict[str, str], course: tasks.Course,
          tests: Container[str] = (), tasks_file: str = tasks.FILE) -> None:
    """Hold the regions of `texts`, {file: text}, to the tasks of `course`;
    `tests` are the names of the tests that there are. Throws MarkerError."""
    faults: list[str] = []
    there: set[str] = set()
    for file, text in texts.items():
        try:
            found = regions(text, file)
        except MarkerError as error:
            faults += error.faults
            continue
        for region in found:
            there.add(region.task)
            if region.task not in course.tasks.keys() | course.dropped:
                faults.append(f"{file}:{region.line}: there is no task "
                              f"'{region.task}' in {tasks_file}")
    if not faults:
        for id, task in course.tasks.items():
            if task.points and id not in there and not any(
                    test in tests for test in task.tests):
                faults.append(f"{tasks_file}:{task.line}: task {id} has "
                              "points, but neither a region nor a test")
    if faults:
        raise MarkerError(faults)


def path_of(name: str) -> pathlib.Path:
    """Where the repository has a source with markers: in its root, or, if only
    students have it there, in course/."""
    return tasks.ROOT / ("course" if name == "mine.hpp" else "") / name


def read_sources() -> dict[str, str]:
    """{file: text} of the sources with markers."""
    texts = {}
    for name in SOURCES:
        try:
            texts[name] = path_of(name).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8"
            raise MarkerError([f"{name}: can't be read ({reason})"]) from None
    return texts


def names_of_tests() -> set[str]:
    return {path.stem for path in (tasks.ROOT / "course/tests").glob("*.*.cpp")}


def load() -> tuple[dict[str, str], tasks.Course]:
    """The checked sources and tasks of the repository: (texts, course)."""
    course = tasks.load()
    texts = read_sources()
    check(texts, course, names_of_tests())
    return texts, course


def open_graph(course: tasks.Course) -> str:
    """The checked Graph.hpp of the level open, with its markers."""
    text = (tasks.ROOT / OPEN_GRAPH).read_text(encoding="utf-8")
    check({OPEN_GRAPH: text}, course, names_of_tests())
    return text


def main() -> None:
    try:
        texts, course = load()
        open_graph(course)
    except (tasks.TasksError, MarkerError) as error:
        sys.exit(str(error))
    found = [r for file, text in texts.items() for r in regions(text, file)]
    print(f"{len(found)} regions of {len({r.task for r in found})} tasks; "
          f"{len(course.tasks)} tasks, {course.points} points")


if __name__ == "__main__":
    main()
