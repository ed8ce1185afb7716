"""Grade a submission:  make grade DIR=submission [HW=hw2]

    DIR=DIR [HW=TAG] [JSON=FILE] [RESULTS=FILE] [FEEDBACK=names]
      [STARTER=VERSION] [SAFE=0] [JOBS=N] python3 course/kit/grade.py

DIR holds Graph.hpp and mass_spring.hpp or mass_spring.cpp. With HW, DIR is a
clone, and graded is what its tag HW holds. The table goes to the standard
output; FILEs get it as JSON and as Gradescope's results.json. FEEDBACK says
what students see of the table and of results.json: all, the names of the tasks
with their points, or none. SAFE=0 runs the submission even where the kernel
allows no jail.
Exit status: 0 it was graded, whatever the points; 2 it can't be. The solution
is graded first, once for each kit: if it does not get all points, nothing is.
"""

import os
import pathlib
import signal
import sys
import tempfile
from collections.abc import Iterator
from typing import NoReturn

import judge
import once
import report
import submission
import tasks
import years


def tests_of(course: tasks.Course) -> dict[str, str]:
    """{test: what it needs}, each once."""
    tests: dict[str, str] = {}
    for task in course.tasks.values():
        for test in task.tests:
            if not (once.TESTS / f"{test}.cpp").is_file():
                raise once.KitError(
                    f"{tasks.FILE}:{task.line}: {task.id}: there is no "
                    f"course/tests/{test}.cpp")
            # A test that serves two tasks needs what either needs.
            tests[test] = max(tests.get(test, "graph"), task.needs,
                              key=tasks.NEEDS.index)
    return tests


READING = 120   # seconds, at most, to read a submission


def too_long(*_: object) -> NoReturn:
    raise submission.BadInput("the submission takes too long to read")


def number_of_jobs(text: str | None) -> int:
    if not text:
        return len(os.sched_getaffinity(0))
    if text.isascii() and text.isdecimal() and 0 < int(text) <= 1000:
        return int(text)
    raise submission.BadInput(f"JOBS is '{submission.shown(text)}', expected "
                              "a number from 1 to 1000")


def less_safe(kit: once.Kit, unsafe: bool) -> Iterator[str]:
    """What the jail has not, on this machine."""
    if unsafe:
        yield "it ran without a jail (SAFE=0)"
    if "landlock" not in kit.has():
        yield ("this kernel has no Landlock: a submission can read the files "
               "of this machine that the grader's user can read")


def grade(course: tasks.Course, kit: once.Kit, taken: submission.Submission,
          name: str, jobs: int) -> report.Report:
    tests = tests_of(course)
    year = years.begun_with(taken, course, os.environ.get("STARTER", ""))
    judge.prepare(kit, tests, jobs)
    results = judge.judge(kit, taken.files, tests, jobs, year=year)
    return report.combine(year.course(course) if year else course, name, taken,
                          results)


def write(path: str | pathlib.Path, text: str) -> None:
    """The whole text, or nothing."""
    path = pathlib.Path(path)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=".new-",
                                     delete=False, encoding="utf-8") as file:
        file.write(text)
    os.chmod(file.name, 0o644)
    os.replace(file.name, path)


def feedback() -> str:
    """How much students see."""
    asked = os.environ.get("FEEDBACK") or "all"
    if asked not in report.FEEDBACK:
        raise submission.BadInput(
            f"FEEDBACK is '{submission.shown(asked)}', expected one of: "
            + " ".join(report.FEEDBACK))
    return asked


def refuse(why: object) -> int:
    print(f"grade: {why}", file=sys.stderr)
    return 2


def main() -> int:
    get = os.environ.get
    folder, tag = get("DIR", ""), get("HW", "")
    seen: str       # set before a report is made
    outputs = {get("JSON"): report.as_json,
               get("RESULTS"): lambda made: report.as_gradescope(made, seen)}
    try:
        if not folder:
            raise submission.BadInput(
                "DIR is missing: make grade DIR=submission [HW=hw2]")
        for path in filter(None, outputs):
            try:    # before the work
                tempfile.TemporaryFile(dir=pathlib.Path(path).parent).close()
            except OSError as error:
                raise submission.BadInput(
                    f"{submission.shown(path)}: its folder can't be written "
                    f"({error.strerror})") from None
        jobs, seen = number_of_jobs(get("JOBS")), feedback()
        signal.signal(signal.SIGALRM, too_long)
        signal.alarm(READING)
        taken = submission.take(folder, tag)
        signal.alarm(0)
        course = tasks.load()
        tests_of(course)        # before anything is built for them
        unsafe = get("SAFE") == "0"
        kit = once.Kit(unsafe)
        taken.notes += less_safe(kit, unsafe)
        name = submission.shown(os.path.basename(os.path.realpath(folder)))
        graded = grade(course, kit, taken, name, jobs)
    except submission.BadInput as error:
        if results := get("RESULTS"):
            write(results, report.refused(str(error)))
        return refuse(error)
    except (once.KitError, tasks.TasksError) as error:
        return refuse(error)
    except OSError as error:
        return refuse(f"{submission.shown(error.filename or 'this machine')}: "
                      f"{error.strerror}")
    except MemoryError:
        return refuse("there is not enough memory")
    print(report.as_text(graded, seen), end="")
    try:
        for file, form in outputs.items():
            if file:
                write(file, form(graded))
    except OSError as error:
        return refuse(f"{submission.shown(error.filename)}: {error.strerror}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
