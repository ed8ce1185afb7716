"""The report on a submission: as text, as JSON and for Gradescope.

The same submission gives the same bytes: no time, no address, no process, no
name of a temporary folder stands in a report.
"""

import json
from dataclasses import dataclass

import judge
import submission
import tasks

VERSION = 1     # of the JSON
# How much of a report students see: FEEDBACK.
FEEDBACK = ("all", "names", "none")
RECEIVED = "Received. Points and tests are not shown."
BY_HAND = "Look at this by hand"
WHERE = {"graph": "Graph.hpp", "cloth": "mass_spring.hpp",
         "step": "mine.hpp"}


@dataclass
class Graded:
    """A task and how its first failed test ended, or its last one."""
    task: tasks.Task
    result: judge.Result

    @property
    def passed(self) -> bool:
        return self.result.passed

    @property
    def points(self) -> int:
        return self.task.points if self.passed else 0


@dataclass
class Report:
    course: tasks.Course
    name: str        # of the submission
    graded: list[Graded]
    notes: list
    flags: list      # (file, line, what)

    @property
    def points(self) -> int:
        return sum(g.points for g in self.graded if not g.task.extra)

    @property
    def of(self) -> int:
        return self.course.points


def combine(course: tasks.Course, name: str, taken: submission.Submission,
            results: dict[str, judge.Result]) -> Report:
    """A task passes if all of its tests do."""
    graded, flags = [], list(taken.flags)
    for task in course.tasks.values():
        mine = [results[test] for test in task.tests]
        failed = [result for result in mine if not result.passed]
        graded.append(Graded(task, (failed or mine)[0]))
        if doubtful := graded[-1].result.doubtful:
            flag = (WHERE[task.needs], 1, doubtful.format(task=task.shown))
            flags += [flag] * (flag not in flags)
    return Report(course, name, graded, taken.notes, flags)


OUTCOMES = {"missing": "Not tested: {}.", "stopped": "Stopped: {}.",
            "not compiled": "Does not compile: {}", "crashed": "Crashed: {}."}


def outcome(course: tasks.Course, result: judge.Result) -> str:
    """What was expected and what came: one or two lines."""
    if result.status == "failed":
        if result.got:
            return course.say("Expected {}, got {}.", result.expected,
                              result.got)
        return course.say("Expected: {}.", result.expected)
    return course.say(OUTCOMES[result.status], result.text)


def failure(course: tasks.Course, graded: Graded) -> list[str]:
    """The text of a task that failed."""
    task, result = graded.task, graded.result
    lines = [f"{heading(task)} {score(course, graded)}.",
             course.say('Specification: "{}"', task.says)]
    if result.did:
        lines.append(course.say("Did: {}.", result.did.rstrip(".")))
    lines += outcome(course, result).split("\n")
    if result.recognized:
        lines.append(course.say(*result.recognized))
    return lines


def alike(course: tasks.Course,
          graded: list[Graded]) -> list[tuple[Graded, list[Graded]]]:
    """Those that failed, each with the others that never ran for the same
    reason: a text that is said once."""
    together: dict[str, list[Graded]] = {}
    for one in graded:
        if not one.passed:
            reason = (outcome(course, one.result) if one.result.status in
                      ("missing", "not compiled") else one.task.id)
            together.setdefault(reason, []).append(one)
    return [(first, others) for first, *others in together.values()]


def heading(task: tasks.Task) -> str:
    return f"{task.section.number} {task.title}"


def score(course: tasks.Course, graded: Graded) -> str:
    if graded.task.points == 0:
        return course.say("passed" if graded.passed else "failed")
    form = "{} extra" if graded.task.extra else "{}"
    return course.say(form, f"{graded.points}/{graded.task.points}")


def as_text(report: Report, feedback: str = "all") -> str:
    """What students see: all, no more than the points of each task, or none."""
    course = report.course
    lines = [f"{course.title}: {report.name}", ""]
    if feedback == "none":
        return "\n".join([*lines, course.say(RECEIVED), ""])
    rows = [(g.task.section.number, g.task.title, score(course, g))
            for g in report.graded]
    wide = max((len(row[1]) for row in rows), default=5)
    far = max((len(row[2]) for row in rows), default=6)
    before = None
    for section, title, points in rows:
        shown = "" if section == before else section
        before = section
        lines.append(f"{shown:<4} {title:<{wide}}  {points:>{far}}")
    total = f"{report.points}/{report.of}"
    lines.append(f"{'':<4} {course.say('all'):<{wide}}  {total:>{far}}")
    if feedback == "names":
        return "\n".join([*lines, ""])
    for graded, others in alike(course, report.graded):
        lines.append("")
        if others:
            lines += outcome(course, graded.result).split("\n")
            lines += [f"  {heading(g.task)} {score(course, g)}"
                      for g in (graded, *others)]
        else:
            first, *rest = failure(course, graded)
            lines += [first, *("  " + line for line in rest)]
    if report.notes:
        lines += ["", *(course.say("Note: {}.", note) for note in report.notes)]
    if report.flags:
        lines += ["", course.say(BY_HAND) + ":"]
        lines += [f"  {file}:{line}: {course.translated(what)}"
                  for file, line, what in report.flags]
    return "\n".join(lines) + "\n"


def as_json(report: Report) -> str:
    """Our own format: course/README.md says what the keys mean."""
    found = []
    for graded in report.graded:
        task, result = graded.task, graded.result
        one = {"id": task.id, "section": task.section.number,
               "title": task.title,
               "points": graded.points, "of": task.points,
               "extra": task.extra, "status": result.status}
        if not graded.passed:
            one.update(specification=task.says, did=result.did,
                       expected=result.expected, got=result.got,
                       message=outcome(report.course, result), test=result.name,
                       recognized=report.course.say(
                           *result.recognized or [""]))
        found.append(one)
    return dump({"version": VERSION, "course": report.course.title,
                 "submission": report.name, "points": report.points,
                 "of": report.of, "tasks": found, "notes": report.notes,
                 "flags": [{"file": file, "line": line, "what": what}
                           for file, line, what in report.flags]})


def dump(data: object) -> str:
    return json.dumps(data, indent=1) + "\n"


def as_gradescope(report: Report, feedback: str = "all") -> str:
    """results.json of a Gradescope autograder. A task that does not count is
    shown as one of no points; its status says how it went, and the name of an
    extra one its points."""
    course, tests, hidden = report.course, [], feedback == "none"
    for graded in report.graded:
        silent = graded.passed or feedback == "names"
        extra = graded.task.extra
        tests.append({
            "name": graded.task.title + f" ({score(course, graded)})" * extra,
            "number": graded.task.shown,
            "score": 0.0 if extra else float(graded.points),
            "max_score": float(graded.task.counted),
            "status": "passed" if graded.passed else "failed",
            "output": "" if silent else "\n".join(failure(course, graded)),
            "output_format": "text",
            "visibility": "hidden" if hidden else "visible"})
    notes = "".join(course.say("Note: {}.", note) + "\n"
                    for note in report.notes)
    # Flags are for the teacher: in a test that students do not see.
    if report.flags:
        tests.append({
            "name": course.say(BY_HAND), "number": "flags", "score": 0.0,
            "max_score": 0.0, "status": "failed",
            "output": "\n".join(f"{file}:{line}: {what}"
                                for file, line, what in report.flags),
            "output_format": "text", "visibility": "hidden"})
    return gradescope(report.points, course.say(RECEIVED) if hidden else
                      course.say("{} of {} points", report.points, report.of)
                      + "\n" + notes, tests)


def gradescope(points: int, output: str, tests: list[dict]) -> str:
    return dump({"score": float(points), "output": output,
                 "output_format": "text", "visibility": "visible",
                 "stdout_visibility": "hidden", "tests": tests})


def refused(reason: str) -> str:
    """results.json of what can't be graded."""
    return gradescope(0, f"This can't be graded: {reason}", [])
