"""Read the table of mistakes: course/wrong/*.toml.

The name of a table in a file is the tasks that each of its entries must lose,
and it loses no others: "7.1.remove_node 7.1.cost"; "*": all tasks that the
changed file serves; "nothing": right submissions that look odd. An entry is
NAME = [old, new, old, new ...], where each old text occurs once; or a table:

    edit      the same
    base      "solution"; "simple", the graph of the level open, solved; or
              "starter": then it must get no points that a starter does not get
    file      which file changes, by default Graph.hpp
    body      a text in place of the file's default `place`
    prepend, append, content      text before or behind the file, or all of it
    finds     what `make try` must say about a step in mine.hpp: regular
              expressions; `status` = 2: it can't be measured
    picture   the name of its picture (course/pictures, the figures of the
              pages), on top of the picture `onto`
    shows     the words below that figure

[default] holds values for all entries of a file.
"""
import functools
from dataclasses import dataclass

import tasks
from tasks import tomllib

FOLDER = tasks.ROOT / "course/wrong"


class MistakeError(Exception):
    pass


@dataclass(frozen=True)
class Mistake:
    table: str          # the name of its file, without .toml
    name: str
    loses: frozenset[str] = frozenset()
    edit: tuple = ()
    base: str = "solution"
    file: str = "Graph.hpp"
    place: str = ""
    body: str | None = None
    prepend: str = ""
    append: str = ""
    content: str | None = None
    finds: tuple = ()
    status: int = 0
    picture: str = ""
    onto: str = ""
    shows: str = ""

    @property
    def where(self) -> str:
        return f"course/wrong/{self.table}.toml: {self.name}"

    def edited(self, text: str) -> str:
        """`text`, which is that of its file, with the mistake."""
        if self.content is not None:
            text = self.content
        edits = [*zip(self.edit[::2], self.edit[1::2], strict=True)]
        if self.body is not None:
            edits.append((self.place, self.body))
        for old, new in edits:
            if text.count(old) != 1:
                raise MistakeError(f"{self.where}: '{old}' occurs "
                                   f"{text.count(old)} times, expected once")
            text = text.replace(old, new)
        return (self.prepend + text + self.append
                + "\n" * bool(self.append or self.content))


def read(table: str) -> list[Mistake]:
    """The mistakes of a file.  Throws MistakeError."""
    tables = tomllib.loads((FOLDER / f"{table}.toml").read_text("utf-8"))
    default, found = tables.pop("default", {}), []
    for tasks_lost, entries in tables.items():
        loses = frozenset(tasks_lost.split()) - {"nothing"}
        for name, entry in entries.items():
            keys = entry if isinstance(entry, dict) else {"edit": entry}
            try:
                found.append(Mistake(table, name, loses, **(default | keys)))
            except TypeError as error:      # a key that no Mistake has
                raise MistakeError(f"course/wrong/{table}.toml: {name}: "
                                   f"{str(error).partition(' ')[2]}") from None
    return found


def tables() -> list[str]:
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


@functools.cache
def pictured() -> dict[str, Mistake]:
    """{picture: Mistake} of those with a picture."""
    return {mistake.picture: mistake for table in tables()
            for mistake in read(table) if mistake.picture}


def with_picture(text: str, file: str, picture: str) -> str:
    """`text`, which is that of `file`, with the mistake of a picture, and with
    that of the picture on top of which this one is; as it is for ""."""
    if not picture:
        return text
    mistake = pictured()[picture]
    text = with_picture(text, file, mistake.onto)
    return mistake.edited(text) if mistake.file == file else text


def shows(picture: str) -> str:
    """The words below the figure of a picture."""
    return pictured()[picture].shows if picture else ""
