"""Starters that were handed out, as course/years/VERSION.zip.

A submission begun with one of them is graded as it was then: its tasks have the
points of then, a task that its starter did not have is shown and not counted,
and files and names that it gave and CME212/ has no more are there. A zip holds

    starter.json     {"points": {task: points}, "numbers": those of tasks.toml,
                     "uses": regular expressions, of what only this starter has}
    given/           headers to be found before the kit's own; names.hpp
    open/, guided/   right submissions: they keep all their points for ever

The last one is of the version in tasks.toml, which a starter carries in its
file .starter. A commit that breaks its submissions gives tasks.toml another
version, adds what is gone to given/, and with `keep` the new starter:

    course/kit/years.py keep OPEN GUIDED     two folders of right submissions
"""

import dataclasses
import functools
import json
import pathlib
import re
import sys
import zipfile
from dataclasses import dataclass

import once
import submission
import tasks

FOLDER = tasks.ROOT / "course/years"
LEVELS = ("open", "guided")
KEPT = ("Graph.hpp", "mass_spring.hpp", "mass_spring.cpp", "mine.hpp")


@dataclass(frozen=True)
class Year:
    version: str
    points: dict[str, int]
    numbers: dict
    uses: tuple[str, ...]

    @property
    def zip(self) -> pathlib.Path:
        return FOLDER / f"{self.version}.zip"

    def unpacked(self) -> pathlib.Path:
        """The folder with what is in the zip."""
        return once.Kit.locked_part(f"year{self.version}", [self.zip],
                                    self.unpack)

    def unpack(self, folder: pathlib.Path) -> None:
        with zipfile.ZipFile(self.zip) as archive:
            archive.extractall(folder)
        (folder / "given").mkdir(exist_ok=True)
        for path in (folder, *folder.rglob("*")):
            path.chmod(0o755 if path.is_dir() else 0o644)

    def course(self, course: tasks.Course) -> tasks.Course:
        """The course with the points of then."""
        return dataclasses.replace(course, tasks={
            id: dataclasses.replace(task, points=self.points.get(
                id, task.points), extra=task.extra or id not in self.points)
            for id, task in course.tasks.items()})


@functools.cache
def years() -> dict[str, Year]:
    """{version: Year} of all that were handed out."""
    found = {}
    for path in sorted(FOLDER.glob("*.zip")):
        with zipfile.ZipFile(path) as archive:
            said = json.loads(archive.read("starter.json"))
        found[path.stem] = Year(path.stem, said["points"], said["numbers"],
                                tuple(said["uses"]))
    return found


def begun_with(taken: submission.Submission, course: tasks.Course,
               asked: str = "") -> Year | None:
    """The starter of a submission, which a note of it names: that of its line,
    or else the one asked for, or else one whose names it uses; None is today's.
    Throws BadInput if there is no such starter."""
    text = "\n".join(submission.without_comments(
        part.decode("utf-8", "replace")) for part in taken.files.values())
    version = taken.starter or asked or next((
        year.version for year in years().values()
        if any(re.search(use, text) for use in year.uses)), course.starter)
    if version == course.starter:
        return None
    if version not in years():
        raise submission.BadInput(
            f"begun with the starter of {submission.shown(version)}, which "
            "this kit does not know: grade it by the kit of then; it knows "
            + ", ".join(sorted({*years(), course.starter} - {""})))
    taken.notes.append(f"begun with the starter of {version}")
    return years()[version]


def keep(folders: list[str]) -> None:
    """Write the zip of this version."""
    course = tasks.load()
    said = {"points": {id: task.points for id, task in course.tasks.items()},
            "numbers": course.constants, "uses": []}
    path = FOLDER / f"{course.starter}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        def add(name, text):
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, text)
        add("starter.json", json.dumps(said, indent=1))
        for level, folder in zip(LEVELS, folders, strict=True):
            for name in KEPT:
                add(f"{level}/{name}",
                    (pathlib.Path(folder) / name).read_bytes())
    print(f"years: {path.relative_to(tasks.ROOT)}")


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] != "keep":
        sys.exit("usage: years.py keep OPEN GUIDED")
    keep(sys.argv[2:])
