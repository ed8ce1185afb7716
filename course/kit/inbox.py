"""Submissions from a learning platform, and points back to it:

    inbox.py unpack ZIP DIR             the zip with all submissions of a task
    inbox.py marks GRADES SHEET COLUMN  its list of marks, on standard output

Moodle names a submission NAME_NUMBER_assignsubmission_file..., Canvas
nameNUMBER_NUMBER_FILE-ATTEMPT.zip: DIR gets a folder NAME_NUMBER for each
student, with the files of the last attempt: of files of one name, and of zips,
the last. What can't be taken is said; `make class DIR=DIR OUT=GRADES` grades
it. SHEET is the CSV file that the platform gives; COLUMN of it gets the
points of the student whose NUMBER ends the cell in its column ID, else in its
first. Exit status: 0 done, 2 bad input, and then nothing was written."""
import contextlib
import csv
import errno
import io
import pathlib
import re
import shutil
import sys
import tempfile
import zipfile

from submission import shown

LARGEST = 10_000_000    # bytes of a submission
MOST = 1000             # members of a zip
MOODLE = re.compile(r"(?P<name>[^/]+_\d+)_assignsubmission_[a-z]+[_/]*"
                    r"(?P<file>.*)")
CANVAS = re.compile(r"(?P<name>[^/_]+)(?P<late>_LATE)?_(?P<number>\d+)_\d+_"
                    r"(?P<file>[^/]*?)(?:-(?P<attempt>\d+))?(?P<end>\.\w+)")
TAKEN = (".hpp", ".h", ".cpp")
Files = dict[str, bytes]


class InboxError(Exception):
    pass


def files_in(name: str, content: bytes) -> Files:
    """The sources in a file, which may be a zip."""
    if not name.endswith(".zip"):
        return {name: content} if name.endswith(TAKEN) else {}
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        members = [m for m in packed.infolist() if m.filename.endswith(TAKEN)]
        if len(members) > MOST:
            raise InboxError(f"it holds more than {MOST} sources")
        if sum(m.file_size for m in members) > LARGEST:
            raise InboxError(f"it unpacks to more than {LARGEST} bytes")
        return {m.filename: packed.read(m) for m in members}


def skip(what: str, why: object) -> None:
    print(f"{shown(what)}: nothing is taken from it: {shown(str(why))}")


def read(path: str) -> dict[str, Files]:
    """{student: files}, those of the last attempt."""
    last: dict[str, dict[str, tuple[int, Files]]] = {}
    with zipfile.ZipFile(path) as packed:
        for member in (m for m in packed.infolist() if not m.is_dir()):
            if it := MOODLE.fullmatch(member.filename):
                student, file, attempt = it["name"], it["file"], 0
            elif it := CANVAS.fullmatch(member.filename):
                student = f"{it['name']}_{it['number']}"
                file, attempt = it["file"] + it["end"], int(it["attempt"] or 0)
            else:
                raise InboxError(f"{path}: '{shown(member.filename)}' is named "
                                 "neither as by Moodle nor as by Canvas")
            taken = last.setdefault(student, {})
            try:
                if member.file_size > LARGEST:
                    raise InboxError(f"it has more than {LARGEST} bytes")
                files = files_in(file, packed.read(member))
            except Exception as error:  # of a stranger's file, whatever it is
                skip(member.filename, error)
                files = {}
            what = ".zip" if file.endswith(".zip") else file
            latest, beside = taken.get(what, (attempt, {}))
            if attempt >= latest:
                taken[what] = attempt, (beside | files if attempt == latest
                                        else files)
    return {student: {name: content for _, files in uploads.values()
                      for name, content in files.items()}
            for student, uploads in last.items()}


def write(folder: pathlib.Path, files: Files) -> None:
    """The files of a student; OSError if they can't stand beside each other."""
    folder.mkdir()
    for name, content in files.items():
        to = folder / name
        if folder.resolve() not in to.resolve().parents:
            skip(f"{folder.name}: {name}", "it lies outside of its folder")
            continue
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(content)


def unpack(path: str, out: str) -> None:
    students, folder = read(path), pathlib.Path(out)
    if folder.exists():
        raise InboxError(f"{out} exists: DIR is a folder that is new")
    count = 0
    with tempfile.TemporaryDirectory(dir=folder.absolute().parent,
                                     prefix=".new-") as name:
        new = pathlib.Path(name) / "students"
        new.mkdir()
        for student, files in students.items():
            try:
                write(new / student, files)
                count += 1
            except OSError as error:
                if error.errno == errno.ENOSPC:
                    raise
                shutil.rmtree(new / student, ignore_errors=True)
                skip(student, error.strerror)
                with contextlib.suppress(OSError):
                    (new / student).mkdir()     # a row of the class, still
        new.rename(folder)
    print(f"{count} submissions in {out}")


def marks(grades: str, sheet: str, column: str) -> None:
    with open(pathlib.Path(grades) / "class.csv", newline="",
              encoding="utf-8-sig") as lines:
        points = {row["student"].rsplit("_", 1)[-1]: row["points"]
                  for row in csv.DictReader(lines)}
    with open(sheet, newline="", encoding="utf-8-sig") as lines:
        rows = list(csv.reader(lines))
    if column not in rows[0]:
        raise InboxError(f"{sheet}: no column '{column}', expected one of: "
                         + ", ".join(rows[0]))
    at = rows[0].index(column)
    named = rows[0].index("ID") if "ID" in rows[0] else 0
    for row in filter(None, rows[1:]):
        if (number := re.findall(r"\d*$", row[named])[0]) in points:
            row[at] = points[number]
    csv.writer(sys.stdout, lineterminator="\n").writerows(rows)


if __name__ == "__main__":
    words = sys.argv[1:]
    try:
        if words[:1] == ["unpack"] and len(words) == 3:
            unpack(*words[1:])
        elif words[:1] == ["marks"] and len(words) == 4:
            marks(*words[1:])
        else:
            sys.exit(__doc__)
    except (InboxError, OSError, KeyError, zipfile.BadZipFile) as error:
        print(error, file=sys.stderr)
        sys.exit(2)
