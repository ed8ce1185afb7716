"""Submissions from a learning platform, and points back to it:

    inbox.py unpack ZIP DIR             the zip with all submissions of a task
    inbox.py marks GRADES SHEET COLUMN  its list of marks, on standard output

Moodle names a submission NAME_NUMBER_assignsubmission_file..., Canvas
nameNUMBER_NUMBER_FILE-ATTEMPT.zip: DIR gets a folder NAME_NUMBER for each
student, with the files of the last attempt; `make class DIR=DIR OUT=GRADES`
grades it. SHEET is the CSV file that the platform gives; COLUMN of it gets the
points of the student whose NUMBER ends the cell in its column ID, else in its
first. Exit status: 0 done, 2 bad input, and then nothing was written."""
import csv
import io
import pathlib
import re
import sys
import zipfile
import zlib

LARGEST = 10_000_000    # bytes of a submission
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
        if sum(m.file_size for m in members) > LARGEST:
            raise InboxError(f"it unpacks to more than {LARGEST} bytes")
        return {m.filename: packed.read(m) for m in members}


def read(path: str) -> dict[str, Files]:
    """{student: files}, those of a later attempt in place of earlier ones."""
    found: dict[str, dict[tuple[str, int], Files]] = {}
    with zipfile.ZipFile(path) as packed:
        for member in (m for m in packed.infolist() if not m.is_dir()):
            if it := MOODLE.fullmatch(member.filename):
                student, file, attempt = it["name"], it["file"], 0
            elif it := CANVAS.fullmatch(member.filename):
                student = f"{it['name']}_{it['number']}"
                file, attempt = it["file"] + it["end"], int(it["attempt"] or 0)
            else:
                raise InboxError(f"{path}: '{member.filename}' is named "
                                 "neither as by Moodle nor as by Canvas")
            taken = found.setdefault(student, {})
            try:
                if member.file_size > LARGEST:
                    raise InboxError(f"it has more than {LARGEST} bytes")
                taken[file, attempt] = files_in(file, packed.read(member))
            except (InboxError, zipfile.BadZipFile, zlib.error,
                    RuntimeError) as error:     # as of one with a password
                print(f"{member.filename}: nothing is taken from it: {error}")
    return {student: {name: content for _, files in sorted(
        all_of.items(), key=lambda one: one[0][1]) for name, content
        in files.items()} for student, all_of in found.items()}


def unpack(path: str, out: str) -> None:
    students, folder = read(path), pathlib.Path(out)
    folder.mkdir(parents=True)
    for student, files in students.items():
        (folder / student).mkdir()
        for name, content in files.items():
            to = folder / student / name
            if (folder / student).resolve() in to.resolve().parents:
                to.parent.mkdir(parents=True, exist_ok=True)
                to.write_bytes(content)
    print(f"{len(students)} submissions in {out}")


def marks(grades: str, sheet: str, column: str) -> None:
    with open(pathlib.Path(grades) / "class.csv", newline="") as lines:
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
