#!/usr/bin/env python3
"""Hold the pages, and all that names the homework, to tasks.toml.

    course/kit/pages.py            names what differs, FILE:LINE; status 1
    course/kit/pages.py --write    writes tasks, points, tag and title

A page has a place for its tasks: all between the lines <!-- tasks 3.2 --> and
<!-- end --> is made from the tasks of section 3.2; <!-- tasks --> is for a
table of all that count. The tag is what stands behind HW= or HW ?=; the title
is the first line of the starter's README.

What a page says between the lines <!-- guided --> and <!-- end guided -->, a
starter of the level open leaves out. It has what stands between the lines
<!-- open and --> in its place.
"""
import re
import sys
import textwrap
from collections.abc import Iterable, Iterator

import tasks

COURSE = tasks.ROOT / "course"
PLACE = re.compile(r"^<!-- tasks *(\S*) -->\n(.*?)^<!-- end -->\n",
                   re.MULTILINE | re.DOTALL)
LONGEST = 80  # lines of a section's page
LEVELS = ("guided", "open")
GUIDED = re.compile(r"^<!-- guided -->\n(.*?)^<!-- end guided -->\n",
                    re.MULTILINE | re.DOTALL)
OPEN = re.compile(r"^<!-- open\n(.*?)^-->\n", re.MULTILINE | re.DOTALL)
# What names the homework, beside the pages.
STARTER = "course/starter/README.md"
NAMING = ("README.md", "Makefile", STARTER, "course/starter/Makefile",
          "tools/submit.sh", "tools/README.md")
TAG = re.compile(r"\b(HW *\??= *)[A-Za-z0-9][\w.-]*")


def worth(task: tasks.Task) -> str:
    return f"{task.points} extra" if task.extra else task.worth


def of_section(id: str, course: tasks.Course) -> list[str]:
    """What is handed in of a section."""
    own = [task for task in course.tasks.values() if task.section.id == id]
    if not own:
        return ["Nothing: this section is not part of the homework."]
    lines = []
    for task in own:
        lines += textwrap.wrap(
            f"- **{task.title}**, {worth(task)}: {task.says}", 80,
            subsequent_indent="  ", break_long_words=False,
            break_on_hyphens=False)
    total = sum(task.counted for task in own)
    together = "" if all(task.extra for task in own) else (
        f"Together {total} points. ")
    return [*lines, "", *textwrap.wrap(
        f"{together}`make test SECTION={id}` shows which tests"
        " pass. Commit your work, then hand it in:"
        f" `make submit HW={course.tag}`.", 80, break_on_hyphens=False)]


def of_course(course: tasks.Course) -> list[str]:
    """A table of all tasks that count."""
    rows = ["| section | task | points |", "|---|---|---|"]
    for task in course.tasks.values():
        if task.points:
            shown = worth(task) if task.extra else task.points
            rows.append(f"| {task.section.id} | {task.title} | {shown} |")
    return rows + [f"| | together | {course.points} |"]


def of_level(text: str, level: str) -> str:
    """A page without what is for the other level."""
    if level == "open":
        return OPEN.sub(r"\1", GUIDED.sub("", text))
    return OPEN.sub("", GUIDED.sub(r"\1", text))


def named(file: str, text: str, course: tasks.Course) -> str:
    """The text of a file with the tag and the title of the homework."""
    if file == STARTER:
        text = re.sub("^# .*", lambda _: f"# {course.title}", text, count=1)
    return TAG.sub(lambda found: found[1] + course.tag, text)


def filled(text: str, course: tasks.Course) -> str:
    """The text of a page with its places filled."""
    def fill(place):
        id = place[1]
        head = f"<!-- tasks {id} -->" if id else "<!-- tasks -->"
        lines = of_section(id, course) if id else of_course(course)
        return "\n".join([head, *lines, "<!-- end -->"]) + "\n"

    return PLACE.sub(fill, text)


def first_difference(one: str, other: str) -> int:
    """The number of the first line that differs."""
    lines, others = one.splitlines(), other.splitlines()
    return next(
        (k for k, (a, b) in enumerate(zip(lines, others), 1) if a != b),
        min(len(lines), len(others)))


def difference(text: str, right: str) -> Iterator[str]:
    """What is wrong with a text that should be `right`, as LINE: what."""
    if right != text:
        yield (f"{first_difference(text, right)}: differs from tasks.toml:"
               " course/kit/pages.py --write")


def faults(page: str, text: str, course: tasks.Course) -> Iterator[str]:
    """The same of a page."""
    yield from difference(text, filled(text, course))
    lines = text.splitlines()
    for section in course.sections:
        if section.page == page:
            longest = max(len(of_level(text, level).splitlines())
                          for level in LEVELS)
            if longest > LONGEST:
                yield (f"{LONGEST}: goes on to line {longest}, expected at"
                       f" most {LONGEST}")
            if re.search("^<!-- (end )?guided|^<!-- open|^-->",
                         of_level(text, "open"), re.MULTILINE):
                yield "1: <!-- guided --> or <!-- open has no end"
            if f"<!-- tasks {section.id} -->" not in lines:
                yield f"{len(lines)}: has no place for tasks {section.id}"


def check(course: tasks.Course, write: bool = False) -> list[str]:
    """What differs in the repository from its tasks.toml, FILE:LINE: what. The
    files that `write` changes it names on the standard output."""
    wrong = [f"course/tasks.toml:{section.line}: there is no page "
             f"{section.page}" for section in course.sections
             if section.page and not (COURSE / section.page).is_file()]
    pages = [f"course/{page.name}" for page in sorted(COURSE.glob("*.md"))]
    for file in (*pages, *NAMING):
        path = tasks.ROOT / file
        text = path.read_text(encoding="utf-8")
        right = named(file, text, course)
        if file in pages:
            right = filled(right, course)
        if write and right != text:
            text = right
            path.write_text(text, encoding="utf-8")
            print(f"{file} written")
        found: Iterable[str] = (
            faults(path.name, text, course) if file in pages else ())
        wrong += [f"{file}:{fault}" for fault in
                  dict.fromkeys((*difference(text, right), *found))]
    return wrong


def main() -> int:
    write = sys.argv[1:] == ["--write"]
    if sys.argv[1:] and not write:
        sys.exit(__doc__.strip())
    try:
        wrong = check(tasks.load(), write)
    except tasks.TasksError as error:
        sys.exit(str(error))
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
