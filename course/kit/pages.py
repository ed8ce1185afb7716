#!/usr/bin/env python3
"""Fill the pages of the course from tasks.toml:

    course/kit/pages.py    names what is wrong with a page, FILE:LINE; status 1

In a starter and on the site the line <!-- tasks 3.2 --> of a page becomes the
tasks of section 3.2, and <!-- tasks --> a table of all that count. In a starter
the tag of the homework stands behind each HW= and HW ?=, and its title is the
first line of the README.

What a page says between the lines <!-- guided --> and <!-- end guided -->, a
starter of the level open leaves out. It has what stands between the lines
<!-- open and --> in its place.
"""
import html
import pathlib
import re
import sys
import textwrap
from collections.abc import Iterator

import tasks

COURSE = tasks.ROOT / "course"
PLACE = re.compile(r"^<!-- tasks *(\S*) -->$", re.MULTILINE)
LONGEST = 108  # lines of a section's page
# What each of these pages has, for the student.
PARTS = ("**Goal", "**Predict", "**Check", "## Usual mistakes", "## Go further")
LEVELS = ("guided", "open")
GUIDED = re.compile(r"^<!-- guided -->\n(.*?)^<!-- end guided -->\n",
                    re.MULTILINE | re.DOTALL)
OPEN = re.compile(r"^<!-- open\n(.*?)^-->\n", re.MULTILINE | re.DOTALL)
TAG = re.compile(r"\b(HW *\??= *)[A-Za-z0-9][\w.-]*")


def worth(task: tasks.Task, course: tasks.Course) -> str:
    if task.extra:
        return course.say("{} extra", task.points)
    return course.say("1 point" if task.points == 1 else "{} points",
                      task.points)


def opened(hints: tuple[str, ...], course: tasks.Course) -> str:
    """The hints of a task as HTML: each is inside of the one before it."""
    inner = ""
    for number, hint in reversed([*enumerate(hints, 1)]):
        inner = (f"<details><summary>{course.say('Hint {}', number)}"
                 "</summary>"
                 f"{html.escape(hint)}{inner}</details>")
    return inner


def of_section(id: str, course: tasks.Course, hints: bool) -> list[str]:
    """What is handed in of a section."""
    own = [task for task in course.tasks.values() if task.section.id == id]
    if not own:
        return [course.say(
            "Nothing: this section is not part of the homework.")]
    lines = []
    for task in own:
        lines += textwrap.wrap(
            f"- **{task.title}**, {worth(task, course)}: {task.says}", 80,
            subsequent_indent="  ", break_long_words=False,
            break_on_hyphens=False)
        lines += ["  " + opened(task.hints, course)] * hints
    total = sum(task.counted for task in own)
    together = "" if all(task.extra for task in own) else (
        course.say("Together {} points.", total) + " ")
    return [*lines, "", *textwrap.wrap(together + course.say(
        "{} shows which tests pass; {} opens a hint, and each time the next "
        "one. Commit your work, then hand it in: {}.",
        f"`make test SECTION={own[0].section.number}`",
        f"`make hint TASK={own[0].shown}`", f"`make submit HW={course.tag}`"),
        80, break_on_hyphens=False)]


def of_course(course: tasks.Course) -> list[str]:
    """A table of all tasks that count."""
    rows = [course.say("| section | task | points |"), "|---|---|---|"]
    for task in course.tasks.values():
        if task.points:
            shown = worth(task, course) if task.extra else task.points
            rows.append(f"| {task.section.number} | {task.title} | {shown} |")
    return rows + [course.say("| | together | {} |", course.points)]


def of_level(text: str, level: str) -> str:
    """A page without what is for the other level."""
    if level == "open":
        return OPEN.sub(r"\1", GUIDED.sub("", text))
    return OPEN.sub("", GUIDED.sub(r"\1", text))


def named(text: str, course: tasks.Course) -> str:
    """A text with the tag of the homework."""
    return TAG.sub(lambda found: found[1] + course.tag, text)


def translated(name: str, text: str, course: tasks.Course) -> str:
    """The page course/NAME in the language of the course, if it has one."""
    path = COURSE / "words" / course.language / name
    return (path.read_text(encoding="utf-8").replace("](../../", "](")
            if path.is_file() else text)


def filled(text: str, course: tasks.Course, hints: bool = False) -> str:
    """The text of a page with its places filled, and with the hints or not."""
    return PLACE.sub(lambda place: "\n".join(
        of_section(place[1], course, hints) if place[1]
        else of_course(course)), tasks.numbered(text, course.numbers))


def faults(text: str, section: tasks.Section,
           course: tasks.Course) -> Iterator[str]:
    """What is wrong with the page of a section, as LINE: what."""
    longest = max(len(of_level(filled(text, course), level).splitlines())
                  for level in LEVELS)
    if longest > LONGEST and course.language == "en":
        yield (f"{LONGEST}: goes on to line {longest}, expected at most"
               f" {LONGEST}")
    if re.search("^<!-- (end )?guided|^<!-- open|^-->", of_level(text, "open"),
                 re.MULTILINE):
        yield "1: <!-- guided --> or <!-- open has no end"
    if section.id not in PLACE.findall(text):
        yield f"1: has no place for tasks: <!-- tasks {section.id} -->"
    for part in PARTS:
        if course.say(part) not in text and part not in text:
            yield f"1: has no {course.say(part)}"


def check(course: tasks.Course) -> list[str]:
    """What is wrong with the pages of the repository, as FILE:LINE: what."""
    wrong = []
    for section in course.sections:
        page = COURSE / (section.page or "")
        if section.page and not page.is_file():
            wrong.append(f"{tasks.FILE}:{section.line}: there is no page "
                         f"{section.page}")
        elif section.page:
            wrong += [f"course/{section.page}:{fault}" for fault in faults(
                translated(section.page, page.read_text(encoding="utf-8"),
                           course), section, course)]
    return wrong


def unmet(course: tasks.Course) -> Iterator[str]:
    """Requirements of the assignment whose words a page lacks, or that neither
    a task, a row of the rubric nor a file of tests holds."""
    rubric = (COURSE / "rubric.md").read_text("utf-8")
    file = "course/requirements.toml"
    for entry in tasks.tomllib.loads((tasks.ROOT / file).read_text("utf-8"))[
            "requirement"]:
        text = (COURSE / entry["page"]).read_text("utf-8")
        for level in LEVELS:
            said = " ".join(of_level(text, level).split())
            yield from (f"{file}:1: '{words}' is not on {entry['page']}, level "
                        f"{level}" for words in entry["words"]
                        if words not in said)
        for held in entry["held"] or [""]:
            if not (held in course.tasks.keys() | course.dropped
                    or held.startswith("**") and held in rubric
                    or held and (tasks.ROOT / held).is_file()):
                yield (f"{file}:1: nothing holds '{entry['says']}': "
                       f"'{held}'")


def programs(page: pathlib.Path) -> list[str]:
    """The C++ of a page, without the words of its comments."""
    return [re.sub(r"\s*//.*", "", code) for code in re.findall(
        r"^```cpp\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)]


def strays(folder: pathlib.Path = COURSE / "words") -> Iterator[str]:
    """Pages in other languages whose programs are not those of the original."""
    for page in sorted(folder.glob("*/*.md")):
        if programs(page) != programs(COURSE / page.name):
            yield (f"course/words/{page.relative_to(folder)}:1: its programs "
                   f"are not those of course/{page.name}")


def main() -> int:
    try:
        course = tasks.load()
        wrong = [*check(course), *unmet(course), *strays()]
    except tasks.TasksError as error:
        sys.exit(str(error))
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
