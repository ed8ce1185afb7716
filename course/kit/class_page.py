"""A class as one page: points, and which sentences of the specification do not
hold. It names only the students whose step of page 8 has a rank, those whose
files are equal, and those who can't be graded, and asks nothing of a network.
"""

import collections
import datetime
import html
import statistics
from collections.abc import Iterable, Iterator, Sequence

import ranking
import recognize
import report
import tasks
import submission

STYLE = """
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #fff; --line: #ccc;
  --bar: #3465a4; --dim: #595959; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --paper: #161616;
  --line: #444; --bar: #729fcf; --dim: #a8a8a8; } }
body { font: 16px/1.45 system-ui, sans-serif; color: var(--ink);
  background: var(--paper); max-width: 46rem; margin: 0 auto;
  padding: 0 1rem 3rem;  overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.2rem; margin-top: 2rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .2rem; }
p, ul { margin: .3rem 0; } ul { padding-left: 1.2rem; }
.dim { color: var(--dim); }
.track { background: var(--line); height: .5rem; }
.track div { background: var(--bar); height: 100%; }
table { border-collapse: collapse; width: 100%; }
td, th { padding: .15rem .6rem .15rem 0; text-align: left; font-weight: normal;
  white-space: nowrap; }
td:last-child { width: 100%; }
"""
SHOWN = 3       # failures of a task, and three times as many of all
LONGEST = 300   # characters of a failure


def text(words: object) -> str:
    return html.escape(str(words))


def bar(share: float) -> str:
    return ('<div class="track"><div style="width:'
            f'{100 * share:.1f}%"></div></div>')


def distribution(points: list[int], of: int) -> Iterator[str]:
    """How many got how much, in tenths; all points apart."""
    bins = collections.Counter(
        min(10 * one // of, 9) if one < of else 10 for one in points)
    most = max(bins.values())
    yield "<table>"
    for tenth in range(11):
        least = -(-of * tenth // 10)
        last = of if tenth == 10 else -(-of * (tenth + 1) // 10) - 1
        name = f"{least}" if least == last else f"{least} to {last}"
        yield (f"<tr><th>{name}</th><td>{bins[tenth]}</td>"
               f"<td>{bar(bins[tenth] / most)}</td></tr>")
    yield "</table>"


def failures(course: tasks.Course, graded: Iterable) -> list[tuple[int, str]]:
    """[(how often, which mistake, or else what was said)] of tasks that failed;
    what several answer alike, and no table of mistakes has, is new."""
    said: collections.Counter = collections.Counter()
    for one in graded:
        known, alike = one.result.recognized, str(one.result.mark)
        said[(f"{one.task.shown}: {known[-1]}", "") if known[:1] == [
            recognize.KNOWN] else (course.say(*known), "") if known else (
            report.outcome(course, one.result).split("\n")[0][:LONGEST],
            alike)] += 1
    return sorted(((number, "new: " * (number > 1 and mark not in ("", "[]"))
                    + words) for (words, mark), number in said.items()),
                  key=lambda pair: (-pair[0], pair[1]))


def listed(found: list[tuple[int, str]]) -> Iterator[str]:
    yield "<ul>"
    for number, words in found:
        yield f"<li>{number} \u00d7 {text(words)}</li>"
    yield "</ul>"


def of_task(course: tasks.Course, graded: Sequence) -> Iterator[str]:
    """One sentence of the specification."""
    task = graded[0].task
    failed = [one for one in graded if not one.passed]
    yield f"<h3>{text(report.heading(task))}</h3>"
    yield bar(len(failed) / len(graded))
    worth = task.worth + ", extra" * task.extra
    yield (f"<p>{len(failed)} of {len(graded)} failed "
           f'<span class="dim">({worth})</span></p>')
    yield f'<p class="dim">{text(task.says)}</p>'
    if failed:
        yield from listed(failures(course, failed)[:SHOWN])


def of_steps(steps: dict[str, tuple[float, int]]) -> Iterator[str]:
    """Who has which rank by the step of page 8."""
    yield "<h2>A better step: ranks</h2>"
    yield ("<p>The error of <code>my_step</code> on two nets drawn at random, "
           "divided by that of symplectic Euler with 1,600 forces on each node."
           "</p><table><tr><th>rank</th><th>student</th><th>error</th>"
           "<th>forces on each node</th></tr>")
    for student, (rank, error, forces) in ranking.ranks(steps).items():
        yield (f"<tr><td>{rank}</td><td>{text(submission.shown(student))}</td>"
               f"<td>{error:.3g}</td><td>{forces}</td></tr>")
    yield "</table>"


def equal(rows: Iterable) -> list[list[str]]:
    """Students with the same files, by their names as they are shown."""
    groups: dict[str, list[str]] = {}
    for row in rows:
        if not row.reason:
            groups.setdefault(row.content, []).append(
                submission.shown(row.student))
    return [group for group in groups.values() if len(group) > 1]


def page(course: tasks.Course, rows: list, due: datetime.datetime | None,
         of_host: bool) -> str:
    """The page of whole_class.Row's; dates `of_host` or of students' clocks."""
    graded = [row.report for row in rows if row.report]
    refused = [row for row in rows if row.reason]
    title = f"{course.title}: the class"
    lines = ['<!DOCTYPE html>', '<html lang="en"><meta charset="utf-8">',
             '<meta name="viewport" content="width=device-width">',
             f"<title>{text(title)}</title><style>{STYLE}</style>",
             f"<h1>{text(title)}</h1>",
             f"<p>{len(rows)} submissions: {len(graded)} graded, "
             f"{len(refused)} that can't be.</p>"]
    if due:
        days = collections.Counter(row.late for row in rows if row.late)
        late = "".join(f", {number} by {day} day{'s' * (day != 1)}"
                       for day, number in sorted(days.items()))
        lines.append(f"<p>{sum(days.values())} after the deadline, "
                     f"{text(due.isoformat(' '))}{late}. Dates are "
                     + ("the host's where it has one (TIMES).</p>"
                        if of_host else
                        "what the student's clock said: a tag or a commit that "
                        "is set back counts as in time.</p>"))
    if graded:
        points = [one.points for one in graded]
        lines += ["<h2>Points</h2>",
                  f"<p>Median {statistics.median(points):g}, mean "
                  f"{statistics.fmean(points):.1f} of {graded[0].of}.</p>"]
        if graded[0].of:
            lines += distribution(points, graded[0].of)
        failed = [one for each in graded for one in each.graded
                  if not one.passed]
        if failed:
            lines.append("<h2>Most frequent mistakes and failures</h2>")
            lines += listed(failures(course, failed)[:3 * SHOWN])
        lines.append("<h2>Sentences of the specification</h2>")
        for same in zip(*(one.graded for one in graded)):
            lines += of_task(course, same)
    if steps := {row.student: row.step for row in rows if row.step}:
        lines += of_steps(steps)
    if same_files := equal(rows):
        lines += ["<h2>Equal files</h2>", "<ul>", *(
            f"<li>{text(', '.join(group))}</li>" for group in same_files),
            "</ul>"]
    if refused:
        lines += ["<h2>Not graded</h2>", "<ul>",
                  *(f"<li>{text(submission.shown(row.student))}: "
                    f"{text(row.reason)}</li>" for row in refused), "</ul>"]
    return "\n".join([*lines, "</html>", ""])
