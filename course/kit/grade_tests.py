"""Grade tests that a student wrote:  make grade-tests FILE=mine.cpp [JSON=FILE]

FILE is as course/own-tests.md says: it includes own.hpp, or graph.hpp,
cloth.hpp or step.hpp, and has a TASK("7.1.remove_node", name) { ... } for each
test. A test counts if
each right submission of the kit passes it; one that may depart from a page's
words (`allowed:` in course/wrong) has no say. What it finds are wrong
submissions, those of course/wrong that lose the tasks which FILE names, and the
solution without one of them. The table shows who was found (x), who passed (.).
Exit status: 0 it was graded, whatever was found; 2 it can't be.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
from dataclasses import dataclass
from typing import NoReturn

import diagnosis
import grade
import judge
import kit_check
import markers
import once
import submission
import tasks
import units

TEST = re.compile(r'\bTASK\s{0,9}\(\s{0,9}"([\w.]{1,80})"\s{0,9},'
                  r'\s{0,9}([A-Za-z_]\w{0,80})\s{0,9}\)')
# Of course/wrong: no cheats.
FILES = ("graph", "cloth", "program", "step", "forms")
INCLUDE = re.compile(r'(#\s{0,9}include\s{0,9}")(\w{1,80}\.hpp")')
OWN = "own"     # the name of FILE where it is built


@dataclass
class Tests:
    text: str
    needs: str
    names: list[str]     # of the tests
    tasks: set[str]      # that they are of
    flags: list[submission.Flag]


def read(path: str, course: tasks.Course) -> Tests:
    def refuse(why: str) -> NoReturn:
        raise submission.BadInput(f"{submission.shown(path)}: {why}")

    if not path:
        raise submission.BadInput(
            "FILE is missing: make grade-tests FILE=mine.cpp")
    taken = submission.take_file(path)
    try:
        text = submission.without_comments(
            taken.files[os.path.basename(path)].decode("utf-8"))
    except UnicodeDecodeError:
        refuse("it is not UTF-8")
    found = TEST.findall(text)
    if not found:
        refuse('has no test, expected TASK("ID", name) { ... }')
    for id, _ in found:
        if id not in course.tasks:
            refuse(f"there is no task {id}")
    names = [name for _, name in found]
    if len(set(names)) < len(names):
        refuse("two tests have the same name")
    needs = next((name for name in ("step", "cloth", "own") if re.search(
        rf'#\s{{0,9}}include\s{{0,9}}"{name}\.hpp"', text)), "graph")
    needs = needs.replace("own", "cloth")
    # Each test is asked for by its name.
    text = TEST.sub(lambda test: f'TASK("{test[2]}", {test[2]})', text)
    text = INCLUDE.sub(
        lambda line: f"{line[1]}{once.TESTS}/{line[2]}"
        if (once.TESTS / line[2][:-1]).exists() else line[0], text)
    return Tests(text, needs, names, {id for id, _ in found}, taken.flags)


def cases(tests: Tests) -> tuple[list[kit_check.Case], list[kit_check.Case]]:
    """(right, wrong): cases of kit_check."""
    all_cases = kit_check.Cases()
    right, wrong = [], []
    for name in kit_check.BASES:
        right.append(kit_check.Case(name, all_cases.base(name), None))
    for task in sorted(tests.tasks & all_cases.regions.keys()):
        wrong.append(kit_check.Case(f"without {task}", {
            name: markers.stub(text, [task], all_cases.course, name)
            for name, text in all_cases.texts.items()}, None))
    for name in FILES:
        for case in all_cases.wrong(name):
            if not case.lost:
                right += [case] * (": allowed: " not in case.name)
            elif case.lost & tests.tasks:
                wrong.append(case)
    return right, wrong


def run(kit: once.Kit, case: kit_check.Case,
        tests: Tests) -> judge.Results | None:
    """{test: Result}, or None if the case does not compile by itself."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-grade-"))
    diagnosis.vocabulary().update(diagnosis.WORD.findall(tests.text))
    try:
        folder.chmod(0o755)
        files = {name: text.encode() for name, text in case.files.items()}
        one = judge.Judge(kit, folder, files, 1)
        room = one.rooms["graph"][0]    # the submission's own
        room.tests = (room.built,)
        (room.built / f"{OWN}.cpp").write_text(tests.text, encoding="utf-8")
        way = units.Way(tests.needs, "checked",
                        one.names if tests.needs != "graph" else ())
        unit = room.compile(way, [OWN])
        if unit.program:
            unit.tests = tests.names
            return one.run_all(unit, room.names)
        bridge = room.compile(way, [], link=False)
        if bridge.refused or diagnosis.compile_errors(bridge.output):
            return None
        why = unit.refused or unit.output[:2000]
        return {name: judge.Result("not compiled", why)
                for name in tests.names}
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def said(result: judge.Result) -> str:
    if result.status == "failed":
        return f"expected {result.expected}" + (
            f", got {result.got}" if result.got else "")
    return f"{result.status}: {result.text}".strip()


def table(rows: dict[str, dict[str, bool]], names: list[str]) -> list[str]:
    """Who was found by which test."""
    wide = max(len(row) for row in rows)
    lines = [f"{'':{wide}}  {name}" if not at else
             f"{'':{wide}}  {'| ' * at}{name}" for at, name in enumerate(names)]
    for row, found in rows.items():
        lines.append(f"{row:{wide}}  " + " ".join(
            "x" if found[name] else "." for name in names))
    return lines


def grade_tests(kit: once.Kit, tests: Tests,
                jobs: int) -> list[dict[str, judge.Results]]:
    """{right: {test: Result}}, {wrong: {test: Result}}"""
    groups = cases(tests)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return [{case.name: results for case, results in zip(
            group, pool.map(lambda case: run(kit, case, tests), group))
            if results is not None} for group in groups]


def main() -> int:
    get = os.environ.get
    try:
        course = tasks.load()
        tests = read(get("FILE", ""), course)
        jobs = grade.number_of_jobs(get("JOBS"))
        kit = once.Kit()
        judge.prepare(kit, grade.tests_of(course), jobs)
        right, wrong = grade_tests(kit, tests, jobs)
    except (submission.BadInput, once.KitError, tasks.TasksError,
            markers.MarkerError) as error:
        print(f"grade-tests: {error}", file=sys.stderr)
        return 2
    bad: dict[str, str] = {}    # {test: why it does not count}
    for case, results in right.items():
        for name, result in results.items():
            # A test for the pages' classes need not fit those of other forms.
            if not result.passed and (case == "solution" or
                                      result.status != "not compiled"):
                bad.setdefault(name, f"the right submission '{case}' does not "
                               f"pass: {said(result)}")

    def finds(case: str, name: str, result: judge.Result) -> bool:
        fits = (result.status != "not compiled"
                or not case.startswith("forms: "))
        return name not in bad and not result.passed and fits
    found = {case: {name: finds(case, name, result)
                    for name, result in results.items()}
             for case, results in wrong.items()}
    lines = [f"{name} does not count: {why}" for name, why in bad.items()]
    if found:
        lines += table(found, tests.names)
    number = sum(any(one.values()) for one in found.values())
    lines.append(f"{number} of {len(found)} wrong submissions found by "
                 f"{len(tests.names) - len(bad)} of {len(tests.names)} tests, "
                 f"which {len(right)} right ones pass")
    lines += submission.to_look_at([
        flag for flag in tests.flags
        if flag[2] != submission.OF_THE_GRADER])     # which a test has to
    print("\n".join(lines))
    if file := get("JSON"):
        grade.write(file, json.dumps({
            "found": number, "of": len(found), "right": len(right),
            "not counted": bad, "matrix": found}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
