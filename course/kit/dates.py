"""When a submission was made, and by how much it is late.

A deadline is '2026-02-14 16:30 -0800'. A submission counts from the later of
two dates: of its commit, and of its tag if that is annotated. A lightweight tag
has none. Both are what the student's clock said. A time of the host, TIMES,
comes before both.
"""

import datetime
import pathlib
import re
from collections.abc import Iterator
from dataclasses import dataclass

from submission import BadInput, git, shown

PERSON = re.compile(rb"^(?:committer|tagger) .*> (-?\d+) ([+-]\d{4})$",
                    re.MULTILINE)
DAY = datetime.timedelta(days=1)


def offset(text: str) -> datetime.timezone:
    """The zone that '-0800' names."""
    minutes = int(text[1:3]) * 60 + int(text[3:])
    return datetime.timezone(datetime.timedelta(
        minutes=-minutes if text[0] == "-" else minutes))


def deadline(text: str) -> datetime.datetime:
    """The moment that `text` says."""
    try:
        return datetime.datetime.strptime(text, "%Y-%m-%d %H:%M %z")
    except ValueError:
        raise BadInput(f"DUE is '{shown(text)}', expected a date, a time and "
                       "its offset, as in '2026-02-14 16:30 -0800'") from None


def times(file: str | None) -> dict[str, datetime.datetime]:
    """{commit: when it was pushed first} of a file with a line for each:
    a commit's 40 digits and a time with its zone, as ISO 8601 has them."""
    found: dict[str, datetime.datetime] = {}
    try:
        text = pathlib.Path(file).read_text("utf-8") if file else ""
    except (OSError, ValueError):
        raise BadInput(f"TIMES is '{shown(file)}', which can't be read") \
            from None
    for number, line in enumerate(text.splitlines(), 1):
        try:
            commit, word = line.split()
            time = datetime.datetime.fromisoformat(word)
            if not time.tzinfo or not re.fullmatch("[0-9a-f]{40}", commit):
                raise ValueError
        except ValueError:
            raise BadInput(f"{shown(file)}:{number}: expected a commit and a "
                           "time with its zone, as 2026-03-08T08:12:00Z") \
                from None
        found[commit] = min(time, found.get(commit, time))
    return found


def days_late(moment: datetime.datetime, due: datetime.datetime) -> int:
    """Days that have begun since the deadline."""
    return max(0, -((due - moment) // DAY))


@dataclass
class Made:
    """A submission by a tag. Dates are None where there are none."""
    commit: str = ""
    kind: str = ""           # of the tag: annotated or lightweight
    tagged: datetime.datetime | None = None
    committed: datetime.datetime | None = None
    pushed: datetime.datetime | None = None     # as the host says

    @property
    def time(self) -> datetime.datetime | None:
        return self.pushed or max(filter(None, (self.tagged, self.committed)),
                                  default=None)

    def doubts(self) -> Iterator[str]:
        if self.commit and not self.committed:
            yield "its commit has no date that can be read"
        if self.kind == "annotated" and not self.tagged:
            yield "its tag has no date that can be read"
        if self.tagged and self.committed and self.tagged < self.committed:
            yield "its tag is older than its commit"


def date_of(thing: bytes) -> datetime.datetime | None:
    """The date that a commit or a tag says, in the student's zone."""
    person = PERSON.search(thing.partition(b"\n\n")[0])
    if not person:
        return None
    try:
        seconds = int(person[1])
        if seconds >= 1 << 36:      # years after 4000: days are counted
            return None
        return datetime.datetime.fromtimestamp(
            seconds, offset(person[2].decode()))
    except (ValueError, OverflowError, OSError):
        return None


def made(folder: str, tag: str) -> Made:
    """What a tag of a clone says. It names a commit, as submission.take()
    found."""
    name = f"refs/tags/{tag}"
    commit = git(folder, "rev-parse", "--verify",
                 f"{name}^{{commit}}").decode().strip()
    found = Made(commit, "lightweight",
                 committed=date_of(git(folder, "cat-file", "commit", commit)))
    if git(folder, "cat-file", "-t", name).strip() == b"tag":
        found.kind = "annotated"
        found.tagged = date_of(git(folder, "cat-file", "tag", name))
    return found
