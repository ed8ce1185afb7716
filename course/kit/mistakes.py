"""Read the table of mistakes: course/wrong/*.toml.

Each [[wrong]] is a submission with one mistake, or a right one that looks odd.

    name      what is wrong
    loses     the tasks that it must lose, and no others; ["*"]: all tasks that
              its file serves; []: none, as it is right
    base      "solution"; "simple", the graph of the level open, solved; or
              "starter": then it must get no points that a starter does not get
    file      which file changes, by default Graph.hpp
    replace   [[old, new], ...]: each old text occurs once in the file
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
from dataclasses import dataclass, field

import tasks
from tasks import tomllib

FOLDER = tasks.ROOT / "course/wrong"


class MistakeError(Exception):
    pass


@dataclass(frozen=True)
class Mistake:
    table: str          # the name of its file, without .toml
    name: str
    loses: tuple = ()
    base: str = "solution"
    file: str = "Graph.hpp"
    replace: list = field(default_factory=list)
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
        edits = [*self.replace]
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
    content = tomllib.loads((FOLDER / f"{table}.toml").read_text("utf-8"))
    try:
        return [Mistake(table, **(content.get("default", {}) | entry))
                for entry in content["wrong"]]
    except TypeError as error:      # a key that no Mistake has, or no name
        raise MistakeError(f"course/wrong/{table}.toml: "
                           f"{str(error).partition(' ')[2]}") from None


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
