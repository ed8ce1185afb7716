"""What the pages and the contracts promise is held by a mistake that breaks it.

A promise is a clause of a page's sections "What to write" and "The formulas",
or of the contract of a function with a region, that has one of the FORMS; a
clause is a sentence, an @tag of a contract, or a table's cell below a heading
that has such a form, as "FIRST CELL: CELL". An entry of course/wrong holds it:
its words are in `breaks` and it loses a task, or they are in `open`.

What the assignment requires, course/requirements.toml, is on a page of both
levels and held by a task, a row of the rubric, or a file of tests.
"""
import functools
import re
from collections.abc import Iterator

import markers
import mistakes
import pages
import tasks
from tasks import tomllib

FORMS = re.compile(
    r"\breturns?\b|\bbecomes\b|\b(?:is|are) (?:0|zero)\b| < |\bown [KL$]"
    r"|^@(?:return|post|param)\b")
SECTIONS = re.compile(r"^## (?:What to write|The formulas?)\n(.*?)(?=^## |\Z)",
                      re.DOTALL | re.MULTILINE)
CONTRACTS = re.compile(r"/\*\*((?:(?!\*/).)*)\*/((?:(?!/\*\*).)*)", re.DOTALL)
UNSEEN = re.compile(r"<!--.*?-->|```.*?```", re.DOTALL)
ENDS = r"(?<=[.;?])\s+|(?<=:)(?<!removed:)\s+"
TAGS = re.compile(r"(?=@(?:return|post|param|pre)\b)"
                  r"|(?=\b(?:Invalidates|Keeps|Complexity|Order|Throws)\b)")


def sentences(text: str, ends: str) -> Iterator[tuple[str, bool]]:
    """Each, and whether it promises."""
    tag = text.startswith(("@return", "@post", "@param"))
    yield from ((one.strip(), tag or bool(FORMS.search(one)))
                for one in re.split(ends, text) if one)


def of_page(text: str) -> Iterator[tuple[str, bool]]:
    for section in SECTIONS.findall(text):
        head: list[str] = []
        for part in re.split(r"\n\s*\n|\n(?=[-|])", UNSEEN.sub(" ", section)):
            part = " ".join(part.split())
            if not part.startswith("|"):
                head = []
                yield from sentences(part.removeprefix("- "), ENDS)
                continue
            cells = [cell.strip() for cell in part.strip("|").split("|")]
            yield from ((f"{cells[0]}: {cell}", bool(FORMS.search(
                f"{title} {cell}"))) for title, cell in zip(head[1:], cells[1:])
                if cell.strip("-"))
            head = head or cells


def of_source(text: str) -> Iterator[tuple[str, bool]]:
    for comment, code in CONTRACTS.findall(text):
        before, region, _ = code.partition("BEGIN SOLUTION")
        if region and " return " not in before:  # else most of it is given
            words = " ".join(re.sub(r"^\s*\*", "", comment, flags=re.M).split())
            for part in TAGS.split(words):
                whole = part.startswith(("@return", "@param"))
                yield from sentences(part, r"\Z" if whole else ENDS)


@functools.cache
def clauses() -> tuple[tuple[str, str, bool], ...]:
    """(file, clause, whether it promises) of all pages and contracts."""
    texts, course = markers.load()
    pages = {section.page for section in course.sections if section.page}
    return tuple(
        [(page, *one) for page in sorted(pages) for one in of_page(
            (tasks.ROOT / "course" / page).read_text("utf-8"))]
        + [(name, *one) for name, text in texts.items()
           for one in of_source(text)])


def unmet() -> Iterator[str]:
    """Requirements whose words a page lacks, or that nothing holds."""
    course = tasks.load()
    texts, folder = {}, tasks.ROOT / "course"
    rubric = (folder / "rubric.md").read_text("utf-8")
    file = "course/requirements.toml"
    for entry in tomllib.loads((tasks.ROOT / file).read_text("utf-8"))[
            "requirement"]:
        page = entry["page"]
        if page not in texts:
            text = (folder / page).read_text("utf-8")
            texts[page] = {level: " ".join(pages.of_level(text, level).split())
                           for level in pages.LEVELS}
        for level, text in texts[page].items():
            yield from (f"{file}: '{words}' is not on {page}, level {level}"
                        for words in entry["words"] if words not in text)
        for held in entry["held"] or [""]:
            if not (held in course.tasks.keys() | course.dropped
                    or held.startswith("**") and held in rubric
                    or held and (tasks.ROOT / held).is_file()):
                yield f"{file}: nothing holds '{entry['says']}': '{held}'"


def faults() -> list[str]:
    """Promises that nothing holds, and words of entries that nobody says."""
    found: list[str] = [*unmet()]
    held: dict[str, str] = {}
    left_open: dict[str, str] = {}
    for table in mistakes.tables():
        for one in mistakes.read(table):
            if one.name.startswith("allowed: ") and not one.open:
                found.append(f"{one.where}: allowed by no words: `open`")
            if one.breaks and not one.loses or one.open and one.loses:
                found.append(f"{one.where}: what breaks a promise loses a task,"
                             " what is left open none")
            held.update(dict.fromkeys(one.breaks, one.where))
            left_open.update(dict.fromkeys(one.open, one.where))
    for words, where in (held | left_open).items():
        if (number := sum(words in clause for clause in {
                clause for _, clause, _ in clauses()})) != 1:
            found.append(f"{where}: '{words}' is in {number} clauses of the "
                         "pages and contracts, expected one")
    for file, clause, promises in clauses():
        tested = [where for words, where in held.items() if words in clause]
        free = [where for words, where in left_open.items() if words in clause]
        if tested and free:
            found.append(f"{file}: '{clause}' is broken by {tested[0]}, and "
                         f"left open by {free[0]}")
        elif promises and not tested and not free:
            found.append(f"{file}: '{clause}' promises what no mistake of "
                         "course/wrong breaks: `breaks`, or `open`")
    return found
