"""The submissions of a class as JPlag 6 wants them (github.com/jplag/JPlag): a
folder for each student, and the starter as its base code, which is no match.
Its option --mode RUN writes the result and opens no browser.
"""

import shlex
import shutil
from collections.abc import Callable
from typing import TYPE_CHECKING

import markers

if TYPE_CHECKING:
    from whole_class import Class


def lay_out(whole: "Class", rows: list,
            do_all: Callable[[list], object]) -> None:
    """Write jplag/ anew: submissions/STUDENT/ and base/."""
    folder = whole.out / "jplag"
    shutil.rmtree(folder, ignore_errors=True)
    base = folder / "base"
    base.mkdir(parents=True)
    texts, course = markers.load()
    for name, text in texts.items():
        (base / name).write_text(markers.starter(text, course, name), "utf-8")
    there = folder / "submissions"
    there.mkdir()
    do_all([("lay_out", row.student, str(there))
            for row in rows if not row.reason])


def command(whole: "Class") -> str:
    return shlex.join([
        "java", "-jar", "jplag.jar", "--language", "cpp",
        "--mode", "RUN", "--overwrite",
        "--base-code", str(whole.out / "jplag/base"),
        "--result-file", str(whole.out / "jplag/result"),
        str(whole.out / "jplag/submissions")])
