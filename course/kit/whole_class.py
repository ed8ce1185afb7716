"""Grade a class:  make class DIR=clones OUT=grades [HW=hw2] [DUE='...']

    DIR=DIR OUT=OUT [HW=TAG] [DUE=TIME] [TIMES=FILE]
      [FEEDBACK=names] [STARTER=VERSION] [SAFE=0] [JOBS=N]
      python3 course/kit/whole_class.py

DIR holds a folder for each student, as grade.py takes one; dates.py says what
DUE and TIMES are. OUT gets class.csv, class.html, reports/STUDENT.txt (for the
student, as FEEDBACK says) and .json (all). It keeps what each test said of each
content in kept/: equal submissions are graded once, and a class that was ended
goes on where it was. With another kit all tests are made anew.
Exit status: 0 it was graded; 2 it can't be, or some who could not have a reason
that is no fault of theirs.
"""

import concurrent.futures
import csv
import dataclasses
import datetime
import fcntl
import hashlib
import io
import json
import os
import pathlib
import resource
import signal
import statistics
import sys
from dataclasses import dataclass, field
from typing import Any

import child
import class_page
import dates
import grade
import judge
import once
import ranking
import report
import submission
import tasks
import years

KEPT = "kept"
COLUMNS = ("student", "commit", "tag", "kind of tag", "tagged", "committed",
           "pushed", "time", "days late", "points", "of")


@dataclass
class Row:
    """A student, and what became of the submission."""
    student: str               # the folder in DIR
    content: str = ""          # of its sources: a digest
    year: years.Year | None = None     # of an older starter
    made: dates.Made = field(default_factory=dates.Made)
    notes: list = field(default_factory=list)
    flags: list = field(default_factory=list)
    reason: str = ""           # why it can't be graded
    report: Any = None         # report.Report
    step: list | None = None   # of page 8: ranking.measured()
    late: int | None = None    # days


class Class:
    def __init__(self, get):
        self.folder, self.tag = get("DIR", ""), get("HW", "")
        if not self.folder or not get("OUT"):
            raise submission.BadInput(
                "make class DIR=clones OUT=grades: DIR holds a folder for each "
                "student, OUT gets the grades")
        self.out = pathlib.Path(os.path.realpath(get("OUT")))
        clones = pathlib.Path(os.path.realpath(self.folder))
        if clones in (self.out, *self.out.parents) or (
                self.out in clones.parents):
            raise submission.BadInput(
                "OUT and DIR lie in each other: grades are not kept among "
                "submissions")
        try:
            self.students = sorted(entry.name for entry in os.scandir(clones)
                                   if entry.is_dir() and entry.name[0] != ".")
        except OSError as error:
            raise submission.BadInput(f"{submission.shown(self.folder)}: "
                                      f"{error.strerror}") from None
        if not self.students:
            raise submission.BadInput(f"{submission.shown(self.folder)} holds "
                                      "no folder of a student")
        if get("DUE") and not self.tag:
            raise submission.BadInput("DUE needs HW: a folder has no date")
        self.due = dates.deadline(get("DUE")) if get("DUE") else None
        self.times = dates.times(get("TIMES"))
        self.feedback = grade.feedback()
        self.jobs = grade.number_of_jobs(get("JOBS"))
        self.unsafe = get("SAFE") == "0"
        self.starter = get("STARTER") or ""
        self.course = tasks.load()
        self.tests = grade.tests_of(self.course)
        self.kept = self.out / KEPT
        if self.out.is_dir() and any(self.out.iterdir()) and (
                not self.kept.is_dir()):
            raise submission.BadInput(
                f"{submission.shown(get('OUT'))} holds other files than "
                "grades: OUT is a folder that is new")
        self.kept.mkdir(parents=True, exist_ok=True)

    def prepare(self) -> None:
        """The solution, graded once: workers begin with what it answered."""
        self.kit = once.Kit(self.unsafe)
        self.lacks = list(grade.less_safe(self.kit, self.unsafe))
        judge.prepare(self.kit, self.tests, self.jobs)
        assert self.kit.data
        self.version = self.kit.data.parent.name    # of all that judges

    # ------------------------------------------------------- By one worker

    def take(self, student: str) -> tuple[
            submission.Submission, years.Year | None, str]:
        """The submission, its starter and its digest."""
        signal.signal(signal.SIGALRM, grade.too_long)
        signal.alarm(grade.READING)
        try:
            taken = submission.take(os.path.join(self.folder, student),
                                    self.tag)
        finally:
            signal.alarm(0)
        year = years.begun_with(taken, self.course, self.starter)
        digest = hashlib.sha256(year.version.encode() if year else b"")
        for name, text in sorted(taken.files.items()):
            digest.update(f"{name}\0{len(text)}\0".encode() + text)
        return taken, year, digest.hexdigest()[:32]

    def read(self, student: str) -> Row:
        row, folder = Row(student), os.path.join(self.folder, student)
        try:
            if os.path.islink(folder):
                raise submission.BadInput("is a symbolic link")
            if self.tag and self.tag in submission.tags(folder, self.tag):
                row.made = dates.made(folder, self.tag)
                row.made.pushed = self.times.get(row.made.commit)
            taken, row.year, row.content = self.take(student)
            row.notes, row.flags = taken.notes, taken.flags
        except submission.BadInput as error:
            row.reason = str(error).removeprefix(
                f"{submission.shown(folder)}: ")
        except (OSError, MemoryError, RecursionError, ValueError) as error:
            row.reason = f"reading it fails: {type(error).__name__}"
        return row

    def place(self, content: str) -> pathlib.Path:
        return self.kept / f"{content}.json"

    def known(self, content: str) -> dict[str, dict]:
        """{test: what is kept of it}, of those that need not be made anew."""
        try:
            found = json.loads(self.place(content).read_text("ascii"))
        except FileNotFoundError:
            return {}
        return {test: result for test, result in found.items()
                if result["kit"] == self.version}

    def grade(self, student: str, content: str) -> tuple[str, float]:
        """Grade what is left of a content. @return why that fails, or '', and
        seconds of processor time"""
        known = self.known(content)
        left = {test: needs for test, needs in self.tests.items()
                if test not in known}
        if not left:
            return "", 0
        before = sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
        taken, year, now = self.take(student)
        if now != content:
            return "it changed while the class was graded", 0
        judge.prepare(self.kit, self.tests, 1)      # it is in use
        assert self.kit.answers
        for test, result in judge.judge(self.kit, taken.files, left, 1,
                                        year=year).items():
            kept = dataclasses.asdict(result)
            answers = kept.pop("answers")
            del kept["usual"]
            if test == ranking.TASK and result.passed:
                kept["step"] = ranking.measured(answers, self.kit.answers[test])
            known[test] = kept | {"kit": self.version}
        grade.write(self.place(content), json.dumps(known, indent=0,
                                                    sort_keys=True))
        return "", sum(resource.getrusage(
            resource.RUSAGE_CHILDREN)[:2]) - before

    # --------------------------------------------------------- The whole class

    def rows(self, pool: concurrent.futures.Executor) -> list[Row]:
        rows = list(pool.map(work, [("read", name) for name in self.students],
                             chunksize=4))
        self.watch_tags(rows)
        for row in rows:
            if self.due and row.made.time:
                row.late = dates.days_late(row.made.time, self.due)
            row.notes = [*row.notes, *row.made.doubts(), *self.lacks]
        return rows

    def watch_tags(self, rows: list[Row]) -> None:
        """Say of a tag where it was when it was seen first."""
        path = self.kept / "tags.json"
        seen = json.loads(path.read_text("ascii")) if path.exists() else {}
        for row in rows:
            if row.made.commit:
                first = seen.setdefault(f"{self.tag} {row.student}",
                                        row.made.commit)
                if first != row.made.commit:
                    row.notes.append(f"its tag was on {first[:10]} when it was "
                                     "seen first")
        grade.write(path, json.dumps(seen, indent=0, sort_keys=True))

    def left(self, rows: list[Row]) -> dict[str, list[Row]]:
        """{content: those who handed it in}, of what has to be graded."""
        groups: dict[str, list[Row]] = {}
        for row in rows:
            if row.content and not row.reason:
                groups.setdefault(row.content, []).append(row)
        return {content: group for content, group in groups.items()
                if self.tests.keys() - self.known(content).keys()}

    def grade_all(self, rows: list[Row],
                  pool: concurrent.futures.Executor) -> bool:
        groups = self.left(rows)
        waiting = {pool.submit(work, ("grade", group[0].student, content)):
                   group for content, group in groups.items()}
        done = concurrent.futures.as_completed(waiting)
        for number, one in enumerate(done, 1):
            first, *others = waiting[one]
            seconds = 0.0
            try:
                reason, seconds = one.result()
            except Exception as error:  # of one submission, whatever it is
                reason = ("the grader fails, which is no fault of the "
                          f"student's: {type(error).__name__}: {error}")
            for row in waiting[one]:
                row.reason = submission.shown(reason)
            print(f"{number}/{len(groups)} {submission.shown(first.student)}"
                  + (f" and {len(others)} with the same files" if others
                     else "") + (f": {row.reason}" if reason else "")
                  + (f": slow, {seconds:.0f} s of processor time"
                     if seconds > judge.BUDGET / 2 else ""),
                  flush=True)
        return all("the grader fails" not in row.reason for row in rows)


# ------------------------------------------------------------ What it leaves


def made(whole: Class, row: Row) -> report.Report:
    """The report on a row, from what is kept of its content."""
    kept = whole.known(row.content)
    results = {test: judge.Result(**{
        key: value for key, value in kept[test].items()
        if key not in ("kit", "step")}) for test in whole.tests}
    row.step = kept.get(ranking.TASK, {}).get("step")
    taken = submission.Submission({}, row.notes, row.flags)
    course = row.year.course(whole.course) if row.year else whole.course
    return report.combine(course, submission.shown(row.student), taken,
                          results)


def write(whole: Class, rows: list[Row]) -> None:
    folder = whole.out / "reports"
    folder.mkdir(exist_ok=True)
    texts = {}
    for row in rows:
        text = f"This can't be graded: {row.reason}.\n"
        if not row.reason:
            row.report = made(whole, row)
            text = report.as_text(row.report, whole.feedback)
            texts[f"{row.student}.json"] = report.as_json(row.report)
        texts[f"{row.student}.txt"] = text
    for old in {path.name for path in folder.iterdir()} - texts.keys():
        (folder / old).unlink()
    for name, text in texts.items():
        grade.write(folder / name, text)
    # A spreadsheet knows by the first character that it is UTF-8.
    grade.write(whole.out / "class.csv", "\ufeff" + table(whole, rows))
    grade.write(whole.out / "class.html", class_page.page(
        whole.course, rows, whole.due, bool(whole.times)))


def table(whole: Class, rows: list[Row]) -> str:
    """A line for each student: CSV."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    ids = list(whole.course.tasks)
    ranked = ranking.COLUMNS if ranking.TASK in ids else ()
    ranks = ranking.ranks({row.student: row.step for row in rows if row.step})
    shown = (task.shown for task in whole.course.tasks.values())
    lines.writerow([*COLUMNS, *shown, *ranked, "note"])
    same = {name: group for group in class_page.equal(rows) for name in group}
    zone = whole.due.tzinfo if whole.due else datetime.timezone.utc
    for row in rows:
        made = row.made
        dates = [time and time.isoformat(" ") for time in (
            made.tagged, made.committed, made.pushed, made.time
            and made.time.astimezone(zone))]
        points: list = [""] * (2 + len(ids))
        notes = [row.reason] if row.reason else list(row.notes)
        if row.report:
            notes = list(row.report.notes)
            points = [row.report.points, row.report.of,
                      *(graded.points for graded in row.report.graded)]
            if row.report.flags:
                notes.append(f"{len(row.report.flags)} lines to look at by "
                             "hand: the report")
        name = submission.shown(row.student)
        others = [other for other in same.get(name, []) if other != name]
        if others:
            notes.append("the same files as " + " ".join(others))
        lines.writerow([
            # Not a formula, where a spreadsheet opens the table.
            "'" * name.startswith(tuple("=+-@")) + name, made.commit,
            whole.tag if made.commit else "", made.kind, *dates, row.late,
            *points, *ranks.get(row.student, [""] * len(ranked)),
            "; ".join(notes)])
    return text.getvalue()


def summary(whole: Class, rows: list[Row]) -> str:
    """What make class says at last."""
    graded = [row.report.points for row in rows if row.report]
    lines = [f"{len(rows)} submissions: {len(graded)} graded, "
             f"{len(rows) - len(graded)} that can't be"]
    if whole.due:
        late = sum(bool(row.late) for row in rows)
        lines[0] += f", {late} late (after {whole.due.isoformat(' ')})"
    if graded:
        lines.append(f"median {statistics.median(graded):g} of "
                     f"{whole.course.points} points")
    lines += [f"written: {whole.out}/class.csv class.html reports/"]
    return "\n".join(lines) + "\n"


THE_CLASS: Class    # of run(), in each worker, too


def work(job: tuple) -> Any:
    """What a worker does: a process of its own, which a signal may end."""
    name, *arguments = job
    return getattr(THE_CLASS, name)(*arguments)


def ends_with_us() -> None:
    child.LIBC.prctl(child.PR_SET_PDEATHSIG, signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def run() -> int:
    global THE_CLASS
    THE_CLASS = whole = Class(os.environ.get)
    with open(whole.kept / "lock", "w", encoding="ascii") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise submission.BadInput("another make class writes to OUT") \
                from None
        whole.prepare()
        with concurrent.futures.ProcessPoolExecutor(
                whole.jobs, initializer=ends_with_us) as pool:
            rows = whole.rows(pool)
            fine = whole.grade_all(rows, pool)
            write(whole, rows)
        for path in whole.out.rglob(".new-*"):      # of runs that were ended
            path.unlink()
        print(summary(whole, rows), end="")
    return 0 if fine else 2


def main() -> int:
    try:
        return run()
    except (submission.BadInput, once.KitError, tasks.TasksError) as error:
        print(f"class: {error}", file=sys.stderr)
    except OSError as error:
        print(f"class: {submission.shown(error.filename or 'this machine')}: "
              f"{error.strerror}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
