"""Read and check course/tasks.toml: the tasks of the assignment as data."""
import pathlib
import re
import sys
from collections.abc import Container, Iterator
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
HEADER = re.compile(r'\[(section|task)\."(.*)"\]')


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
    needs: str  # "graph": Graph.hpp alone; "cloth": mass_spring.*, too;
    #             "step": mine.hpp, too
    page: str | None  # a file in course/
    line: int
    number: str  # what the course shows for id


@dataclass(frozen=True)
class Task:
    id: str
    title: str
    points: int
    says: str
    hints: tuple  # opened one by one
    tests: tuple  # names in course/tests, without .cpp: all must pass
    extra: bool  # shown, never counted
    section: Section
    line: int

    @property
    def needs(self) -> str:
        return self.section.needs

    @property
    def counted(self) -> int:
        return 0 if self.extra else self.points

    @property
    def worth(self) -> str:
        return f"{self.points} point" + ("" if self.points == 1 else "s")

    @property
    def shown(self) -> str:
        return self.section.number + self.id[len(self.section.id):]


@dataclass(frozen=True)
class Course:
    title: str
    tag: str
    sections: tuple  # in the order of the file; without those dropped
    tasks: dict  # id -> Task, in the order of the file; likewise
    dropped: frozenset  # ids of tasks that are not asked for
    numbers: dict  # id of a section -> its number, where that is another
    starter: str  # the version of what is handed out
    constants: dict  # [numbers]
    language: str
    words: dict  # English sentence -> sentence of the language; {} is a part

    @property
    def points(self) -> int:
        return sum(task.counted for task in self.tasks.values())

    def say(self, sentence: str, *parts: object) -> str:
        """A sentence with its parts, in the language as far as it is known."""
        return self.words.get(sentence, sentence).format(
            *(self.translated(str(part)) for part in parts))

    def translated(self, text: str) -> str:
        """A text that was made of a sentence and its parts, by a test."""
        for sentence in self.words if len(text) < 500 else ():
            pattern = "(.+?)".join(map(re.escape, sentence.split("{}")))
            if found := re.fullmatch(pattern, text):
                return self.say(sentence, *found.groups())
        return text


# The keys of a table, by its kind: those that it must have, and others.
REQUIRED: dict[str, dict[str, type]] = {
    "": {"title": str, "tag": str, "section": dict, "task": dict},
    "section": {"title": str, "needs": str},
    "task": {"title": str, "points": int, "says": str}}
OPTIONAL: dict[str, dict[str, type]] = {
    "": {"numbers": dict, "language": str, "starter": str},
    "section": {"page": str, "dropped": bool, "number": str},
    "task": {"tests": list, "hints": list, "extra": bool, "dropped": bool}}
TYPES = {str: "a text", int: "a whole number", bool: "true or false",
         list: "a list", dict: "a table"}


def wrong_keys(kind: str, table: object) -> Iterator[str]:
    """What is wrong with the keys of a table and their types."""
    if type(table) is not dict:
        yield "expected a table"
        return
    keys = REQUIRED[kind] | OPTIONAL[kind]
    for key, value in table.items():
        if key not in keys:
            yield f"unknown key '{key}', expected one of: {' '.join(keys)}"
        elif type(value) is not keys[key]:
            yield f"'{key}' is not {TYPES[keys[key]]}"
        elif type(value) is str and not NO_CONTROLS.fullmatch(value):
            yield f"'{key}' is not a text of one line"
    for key in REQUIRED[kind]:
        if key not in table:
            yield f"'{key}' is missing"


def parse(text: str, name: str = FILE) -> Course:
    """The Course that `text` says.  Throws TasksError."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"at line (\d+)", str(error))
        number = int(line[1]) if line else 1
        row = text.splitlines()[number - 1]
        raise TasksError([f"{name}:{number}: {error}" + (
            "; a number is written as 0.2 or -0.5"
            if re.search(r"=\s*\[?[-+.,\d]", row) else "")]) from None
    if wrong := [f"{name}:1: {fault}" for fault in wrong_keys("", data)]:
        raise TasksError(wrong)
    words = in_language(data["language"]) if "language" in data else {}
    numbers = {id: table["number"] for id, table in data["section"].items()
               if type(table) is dict and type(table.get("number")) is str}
    shown = [numbers.get(id, id) for id in data["section"]]
    if twice := [number for number in shown if shown.count(number) > 1]:
        raise TasksError([f"{name}:1: two sections have the number {twice[0]}"])

    def say(text):
        return numbered(words.get(text, text), numbers)

    lines = {header.groups(): number
             for number, line in enumerate(text.splitlines(), 1)
             if (header := HEADER.match(line))}
    faults: list[str] = []

    def tables(kind, find_faults):
        """Those without a fault, as (id, table, line)."""
        for id, table in data[kind].items():
            line = lines.get((kind, id), 1)
            found = [*wrong_keys(kind, table)] or [*find_faults(id, table)]
            faults.extend(f"{name}:{line}: {fault}" for fault in found)
            if not found:
                yield id, table, line

    all_sections = {id: Section(id, say(table["title"]), table["needs"],
                                table.get("page"), line,
                                table.get("number", id))
                    for id, table, line in tables("section", wrong_section)}
    tasks = {id: Task(id, say(table["title"]), table["points"],
                      say(table["says"]), (*map(say, table.get("hints", [])),),
                      tuple(table.get("tests", [id])),
                      table.get("extra", False),
                      all_sections[id.rpartition(".")[0]], line)
             for id, table, line in tables("task", lambda id, table:
                                           wrong_task(id, table, all_sections))}
    if faults:
        raise TasksError(faults)
    sections = [section for section in all_sections.values()
                if not data["section"][section.id].get("dropped")]
    dropped = {task.id for task in tasks.values() if task.section not in
               sections or data["task"][task.id].get("dropped")}
    return Course(say(data["title"]), data["tag"], tuple(sections),
                  {id: task for id, task in tasks.items() if id not in dropped},
                  frozenset(dropped), numbers, data.get("starter", ""),
                  data.get("numbers", {}), data.get("language", "en"),
                  words)


def numbered(text: str, numbers: dict[str, str]) -> str:
    """With the numbers that the course shows; names of files keep their ids."""
    if not numbers:
        return text
    every, dotted = ("|".join(re.escape(id) for id in numbers if sign in id)
                     or "(?!)" for sign in ("", "."))
    name = r"\.(?:md|png|svg)"
    return re.sub(
        rf"(?<![\w./-])(?:{every})(?=\.[A-Za-z_])(?!{name})"
        rf"|(?:(?<=SECTION=)|(?<=^# )|(?<=tests/))(?:{every})(?![\d-]|\.\d)"
        rf"|(?<![\w./$-])(?<!tasks )(?:{dotted})"
        rf"(?![\w$-]|\.\d|{name}| (?:m|s|kg|N|J)\b)",
        lambda found: numbers[found[0]], text, flags=re.MULTILINE)


def in_language(language: str) -> dict[str, str]:
    """What course/words/LANGUAGE.toml says in place of English sentences."""
    name = f"course/words/{language}.toml"
    try:
        words = tomllib.loads((ROOT / name).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", error)
        raise TasksError([f"{name}:1: {reason}"]) from None
    if wrong := [f"{name}:1: expected one text for '{sentence}', with its {{}}"
                 for sentence, said in words.items()
                 if not sentence.replace("{}", "").strip()
                 or type(said) is not str
                 or sentence.count("{}") != said.count("{}")
                 or re.search("[{}]", (sentence + said).replace("{}", ""))]:
        raise TasksError(wrong)
    return words


def wrong_section(id: str, table: dict) -> Iterator[str]:
    if not SECTION_ID.fullmatch(id):
        yield f"'{id}' is no id of a section, expected one as 7.1"
    if not SECTION_ID.fullmatch(number := table.get("number", "1")):
        yield f"{id}: number '{number}' is not one as 7.1"
    if table["needs"] not in NEEDS:
        yield (f"{id}: needs '{table['needs']}', expected graph, cloth or "
               "step")


def wrong_task(id: str, table: dict,
               sections: Container[str]) -> Iterator[str]:
    section, _, task = id.rpartition(".")
    if section not in sections or not NAME.fullmatch(task):
        yield (f"'{id}' is no id of a task, expected SECTION.NAME of a section "
               "in this file")
    if table["points"] < 0:
        yield f"{id}: points are negative"
    tests = table.get("tests", [id])
    if not tests or not all(
            isinstance(t, str) and TEST.fullmatch(t) for t in tests):
        yield (f"{id}: tests are names of files in course/tests, without "
               ".cpp")
    if not all(isinstance(hint, str) and NO_CONTROLS.fullmatch(hint)
               for hint in table.get("hints", [])):
        yield f"{id}: a hint is not a text of one line"


def load(path: pathlib.Path = ROOT / FILE) -> Course:
    """The Course of this repository."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8"
        raise TasksError([f"{FILE}: can't be read ({reason})"]) from None
    return parse(text)
