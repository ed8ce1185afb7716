"""Grade a submission:  make grade DIR=submission [HW=hw2]

    DIR=DIR [HW=TAG] [JSON=FILE] [JUNIT=FILE] [RESULTS=FILE] [SAFE=0] [JOBS=N]
      python3 course/kit/grade.py

DIR holds Graph.hpp and mass_spring.hpp or mass_spring.cpp. With HW, DIR is a
clone, and graded is what its tag HW holds. The table goes to the standard
output; FILEs get it as JSON, as JUnit XML and as Gradescope's results.json.
SAFE=0 runs the submission even where the kernel allows no jail.
Exit status: 0 it was graded, whatever the points; 2 it can't be.
"""

import os
import pathlib
import sys
import tempfile

import judge
import once
import report
import submission
import tasks


def tests_of(course):
    """{test: what it needs}, each once."""
    tests = {}
    for task in course.tasks.values():
        for test in task.tests:
            if not (once.TESTS / f"{test}.cpp").is_file():
                raise once.KitError(
                    f"{tasks.FILE}:{task.line}: {task.id}: there is no "
                    f"course/tests/{test}.cpp")
            # A test that serves two tasks needs what either needs.
            if tests.get(test) != "cloth":
                tests[test] = task.needs
    return tests


def grade(course, kit, taken, name, jobs):
    tests = tests_of(course)
    judge.prepare(kit, tests, jobs)
    results = judge.judge(kit, taken.files, tests, jobs)
    return report.combine(course, name, taken, results)


def write(path, text):
    """The whole text, or nothing."""
    path = pathlib.Path(path)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False,
                                     encoding="utf-8") as file:
        file.write(text)
    os.chmod(file.name, 0o644)
    os.replace(file.name, path)


def main():
    get = os.environ.get
    folder, tag = get("DIR", ""), get("HW", "")
    outputs = {get("JSON"): report.as_json, get("JUNIT"): report.as_junit,
               get("RESULTS"): report.as_gradescope}
    try:
        if not folder:
            raise submission.BadInput(
                "DIR is missing: make grade DIR=submission [HW=hw2]")
        for path in filter(None, outputs):
            if not pathlib.Path(path).parent.is_dir():
                raise submission.BadInput(f"{submission.shown(path)}: its "
                                          "folder does not exist")
        taken = submission.take(folder, tag)
        course = tasks.load()
        tests_of(course)        # before anything is built for them
        kit = once.Kit(unsafe=get("SAFE") == "0")
        jobs = int(get("JOBS") or 0) or len(os.sched_getaffinity(0))
        name = submission.shown(os.path.basename(os.path.realpath(folder)))
        graded = grade(course, kit, taken, name, jobs)
    except submission.BadInput as error:
        if get("RESULTS"):
            write(get("RESULTS"), report.refused(str(error)))
        print(f"grade: {error}", file=sys.stderr)
        return 2
    except (once.KitError, tasks.TasksError) as error:
        print(f"grade: {error}", file=sys.stderr)
        return 2
    print(report.as_text(graded), end="")
    for path, form in outputs.items():
        if path:
            write(path, form(graded))
    return 0


if __name__ == "__main__":
    sys.exit(main())
