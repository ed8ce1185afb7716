"""What a graded class leaves: a table, reports for students, a page."""

import csv
import datetime
import io
import statistics
from typing import TYPE_CHECKING

import grade
import judge
import ranking
import report
import submission
from class_page import equal, page

if TYPE_CHECKING:
    from whole_class import Class, Row

COLUMNS = ("student", "commit", "tag", "kind of tag", "tagged", "committed",
           "pushed", "time", "days late", "points", "of")


def made(whole: "Class", row: "Row") -> report.Report:
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


def write(whole: "Class", rows: list) -> None:
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
    grade.write(whole.out / "class.csv", table(whole, rows))
    grade.write(whole.out / "class.html", page(whole, rows))


def table(whole: "Class", rows: list) -> str:
    """A line for each student: CSV."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    ids = list(whole.course.tasks)
    ranked = ranking.COLUMNS if ranking.TASK in ids else ()
    ranks = ranking.ranks({row.student: row.step for row in rows if row.step})
    shown = (task.shown for task in whole.course.tasks.values())
    lines.writerow([*COLUMNS, *shown, *ranked, "note"])
    same = {name: group for group in equal(rows) for name in group}
    zone = whole.due.tzinfo if whole.due else datetime.timezone.utc
    for row in rows:
        made = row.made
        dates = [time and time.isoformat(" ") for time in (
            made.tagged, made.committed, made.pushed, made.time
            and made.time.astimezone(zone))]
        points = [""] * (2 + len(ids))
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


def summary(whole: "Class", rows: list) -> str:
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
