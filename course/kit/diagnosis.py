"""What a compiler, a sanitizer or a crash says, in a line or two."""

import functools
import pathlib
import re
import signal
from collections.abc import Container, Mapping
from dataclasses import dataclass

import once
import sandbox
import submission

PLACE = re.compile(r"(?P<file>[^\s:][^:\n]*):(?P<line>\d+)(?::\d+)?: +"
                   r"(?P<text>.*)")
CHAIN = re.compile(r"(?:In file included| +) +from (?P<file>[^:]+):\d+[,:]")
HEADING = re.compile(r"[^:]+: (?:In|At) .*:$")
TEST = re.compile(r"course/tests/([^/]+)\.cpp")
ADDRESS = re.compile(r"0x[0-9a-f]+")
UNCLOSED = re.compile(r"error: expected '\}' at end of input\n"
                      r"(?:(?:In file included| +) +from .*\n){0,20}"
                      r"(?P<file>[^\s:]+):(?P<line>\d+):\d+: note: to match")
CONSTRUCTOR = re.compile(r"\b(\w+)<[^<>()]*>\(")
WORD = re.compile(r"[A-Za-z]{3,}")
LONGEST = 300


def short(text: str) -> str:
    """One line without addresses."""
    text = " ".join(ADDRESS.sub("0x...", text).split())
    text = text.encode("ascii", "replace").decode()
    return text if len(text) <= LONGEST else text[:LONGEST - 4] + " ..."


@functools.cache
def vocabulary() -> set[str]:
    """The words of the tests, without comments: what a test can say."""
    return {word for path in (*once.TESTS.glob("*.?pp"),
                              once.KIT / "runner.cpp")
            for word in WORD.findall(submission.without_comments(
                path.read_text("utf-8")))}


def foreign(*texts: str) -> bool:
    """Has a text that came from a submission's process other words?"""
    return not vocabulary().issuperset(WORD.findall(" ".join(texts)))


@dataclass
class Error:
    file: str
    line: int
    text: str
    tests: frozenset[str]   # names of the tests that led to it
    needed_by: str          # "FILE:LINE" in a test, or ""


def compile_errors(output: str) -> list[Error]:
    """The errors of g++, each with the tests whose code led to it.

    A second error in one instantiation has no lines of its own that say so:
    it belongs to what the first one belongs to.
    """
    errors = []
    tests: set[str] = set()
    needed_by = ""
    of_last_error: tuple[set[str], str] = (set(), "")
    for line in output.split("\n"):
        if HEADING.fullmatch(line):
            tests, needed_by = set(), ""
            tests |= named(line.partition(":")[0])
        elif chain := CHAIN.match(line):
            if line[0] == "I":
                tests, needed_by = set(), ""
            tests |= named(chain["file"])
        elif place := PLACE.match(line):
            text = place["text"]
            if text.startswith(("error: ", "fatal error: ")):
                tests |= named(place["file"])
                errors.append(Error(place["file"], int(place["line"]),
                                    text.partition(": ")[2], frozenset(tests),
                                    needed_by))
                of_last_error = (set(tests), needed_by)
            elif text.startswith(("note: ", "warning: ")):
                tests, needed_by = set(of_last_error[0]), of_last_error[1]
            elif "required " in text or "expansion of" in text:
                tests |= named(place["file"])
                if TEST.fullmatch(place["file"]):
                    needed_by = f"{place['file']}:{place['line']}"
    return errors


def named(file: str) -> set[str]:
    test = TEST.fullmatch(file)
    return {test[1]} if test else set()


def helpful(output: str, names: Container[str], test: str = "") -> Error | None:
    """The first error that a student can do something about, or None."""
    errors = compile_errors(output)
    if test:
        errors = [e for e in errors if test in e.tests] or errors
    for error in errors:
        if error.file in names or TEST.fullmatch(error.file):
            return error
    return next((e for e in errors if e.needed_by),
                errors[0] if errors else None)


def first_error(output: str, names: Container[str], test: str) -> str:
    """The same in a line; its place, if that is the student's."""
    error = helpful(output, names, test)
    if not error:
        return ""
    place = f"{error.file}:{error.line}: " if error.file in names else ""
    return place + short(error.text)


def compile_message(output: str, names: Mapping[str, bytes],
                    test: str = "") -> str:
    """The same, and what led to it, of files with these texts."""
    for unclosed in UNCLOSED.finditer(output):  # what follows makes no sense
        if unclosed["file"] in names:
            return (f"{unclosed['file']}:{unclosed['line']}: this '{{' has no "
                    "'}'")
    error = helpful(output, names, test)
    if not error:
        return link_message(output)
    owner = "the kit's " if error.file == "Graph.hpp" not in names else ""
    text = f"{owner}{error.file}:{error.line}: {short(error.text)}"
    lines = names.get(error.file, b"").decode("utf-8", "replace").split("\n")
    if "expected ')' before" in text and (found := CONSTRUCTOR.search(
            "".join(lines[error.line - 1:error.line]))):
        text += (f"; since C++20 a constructor is {found[1]}(...), "
                 f"not {found[0]}...)")
    if error.needed_by:
        text += f"\nneeded by {error.needed_by}"
    return text


def link_message(output: str) -> str:
    for pattern in (r"undefined reference to .*", r"multiple definition of .*",
                    r"error: .*"):
        if found := re.search(pattern, output):
            return short(found[0])
    return "the compiler gives no reason"


def first_frame(output: str, names: Container[str]) -> str:
    """The first line of a trace that is in the submission: " at FILE:LINE". Or
    what the test did with what it was given, such as a null reference."""
    test = ""
    for frame in re.finditer(r"^ +#\d+ 0x[0-9a-f]+ (?:in )?(.*)$", output,
                             re.MULTILINE):
        place = re.search(r" (?:\./)?([^ ]+?):(\d+)(?::\d+)?$", frame[1])
        if place and place[1] in names:
            return f" at {place[1]}:{place[2]}"
        if place and not test:
            test = line_of_test(pathlib.Path(place[1]), int(place[2]))
    return test


def line_of_test(path: pathlib.Path, number: int) -> str:
    """What stands there; a submission may have named any file."""
    if path.parent != once.TESTS or ".." in path.parts or not path.is_file():
        return ""
    lines = path.read_text("utf-8").split("\n")
    return (f" where the test says: {lines[number - 1].strip()}"
            if 0 < number <= len(lines) else "")


def crash(outcome: sandbox.Outcome, names: Container[str]) -> str:
    """Why a program ended before it said how its test went."""
    output = outcome.output
    found = re.search(r"ERROR: (AddressSanitizer: .*)", output)
    # Not each machine tells AddressSanitizer which signal it was.
    aborted = found and (": ABRT " in found[1]
                         or re.search(r"^ +#\d+ 0x[0-9a-f]+ in \S*abort\b",
                                      output, re.MULTILINE))
    if found and not aborted:
        words = re.sub(r" on (unknown )?address .*| \(pc .*| \(T\d+\).*"
                       r"|: attempting .*", "", found[1])
        rest = output[found.end():]
        access = re.search(r"^(READ|WRITE) of size \d+", rest, re.MULTILINE)
        if access:
            words += f", {access[0]}"
        return short(words) + first_frame(rest, names)
    if found := re.search(r"^(?:\./)?([^\s:]+):(\d+):\d+: runtime error: (.*)",
                          output, re.MULTILINE):
        if found[1] in names:
            return f"{short(found[3])} at {found[1]}:{found[2]}"
        return short(found[3]) + first_frame(output[found.end():], names)
    if found := re.search(r"^[^\n]*?(?:\./)?([^\s:]+):(\d+): .*Assertion "
                          r"[`'](.*)' failed", output, re.MULTILINE):
        where = (f" at {found[1]}:{found[2]}" if found[1] in names
                 else first_frame(output, names))
        return f"assertion failed: {short(found[3])}{where}"
    if found := re.search(r"terminate called after throwing .*\n? *(what.*)?",
                          output):
        return (short(found[0]).replace("terminate called after throwing",
                                        "nothing catches")
                + first_frame(output, names))
    if aborted:
        return "ended by abort()" + first_frame(output, names)
    if outcome.code < 0:
        try:
            name = signal.Signals(-outcome.code).name
        except ValueError:
            name = str(-outcome.code)
        return f"ended by the signal {name}"
    if not outcome.begun:
        return "the program ended before main() began"
    return "the program ended before the test did"
