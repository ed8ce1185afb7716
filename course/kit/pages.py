#!/usr/bin/env python3
"""Hold the pages to tasks.toml.

    course/kit/pages.py            names what differs, FILE:LINE; status 1
    course/kit/pages.py --write    writes tasks and points into the pages

A page has a place for them: all between the lines <!-- tasks 3.2 --> and
<!-- end --> is made from the tasks of section 3.2; <!-- tasks --> is for a
table of all that count.
"""
import re
import sys
import textwrap

import tasks

COURSE = tasks.ROOT / "course"
PLACE = re.compile(r"^<!-- tasks *(\S*) -->\n(.*?)^<!-- end -->\n",
                   re.MULTILINE | re.DOTALL)
LONGEST = 80  # lines of a section's page


def worth(task):
    return f"{task.points} extra" if task.extra else task.worth


def of_section(id, course):
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
    return [*lines, "", *textwrap.wrap(
        f"Together {total} points. `make test SECTION={id}` shows which tests"
        " pass. Commit your work, then hand it in:"
        f" `make submit HW={course.tag}`.", 80, break_on_hyphens=False)]


def of_course(course):
    """A table of all tasks that count."""
    rows = ["| section | task | points |", "|---|---|---|"]
    for task in course.tasks.values():
        if task.points:
            shown = worth(task) if task.extra else task.points
            rows.append(f"| {task.section.id} | {task.title} | {shown} |")
    return rows + [f"| | together | {course.points} |"]


def filled(text, course):
    """The text of a page with its places filled."""
    def fill(place):
        id = place[1]
        head = f"<!-- tasks {id} -->" if id else "<!-- tasks -->"
        lines = of_section(id, course) if id else of_course(course)
        return "\n".join([head, *lines, "<!-- end -->"]) + "\n"

    return PLACE.sub(fill, text)


def first_difference(one, other):
    """The number of the first line that differs."""
    one, other = one.splitlines(), other.splitlines()
    return next((k for k, (a, b) in enumerate(zip(one, other), 1) if a != b),
                min(len(one), len(other)))


def faults(page, text, course):
    """What is wrong with a page, as LINE: what."""
    right = filled(text, course)
    if right != text:
        yield (f"{first_difference(text, right)}: differs from tasks.toml:"
               " course/kit/pages.py --write")
    lines = text.splitlines()
    for section in course.sections:
        if section.page == page:
            if len(lines) > LONGEST:
                yield (f"{LONGEST}: goes on to line {len(lines)}, expected at"
                       f" most {LONGEST}")
            if f"<!-- tasks {section.id} -->" not in lines:
                yield f"{len(lines)}: has no place for tasks {section.id}"


def main():
    write = sys.argv[1:] == ["--write"]
    if sys.argv[1:] and not write:
        sys.exit(__doc__.strip())
    try:
        course = tasks.load()
    except tasks.TasksError as error:
        sys.exit(str(error))
    wrong = [f"tasks.toml:{section.line}: there is no page {section.page}"
             for section in course.sections
             if section.page and not (COURSE / section.page).is_file()]
    for page in sorted(COURSE.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        if write and filled(text, course) != text:
            text = filled(text, course)
            page.write_text(text, encoding="utf-8")
            print(f"course/{page.name} written")
        wrong += [f"{page.name}:{fault}"
                  for fault in faults(page.name, text, course)]
    for fault in wrong:
        print(f"course/{fault}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
