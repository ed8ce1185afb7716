"""Hold the kit to what it promises:  make kit-check [ONLY=WORD] [EVERY=N]

The solution gets all points; the starter none of those that its stubs hold
back; each region stubbed alone turns red a test of its own section and none of
an earlier one; each mistake of course/wrong (mistakes.py) loses what it says
and nothing else; right submissions to older starters keep their points
(years.py). ONLY takes the cases whose names hold WORD; EVERY takes one in
N of the regions and mistakes, beginning with number FIRST, by default 0: all
FIRST < N together take each of them once. With the word `mistakes` it writes
course/wrong/answers.json instead: what each of them answers (recognize.py).
"""

import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import sys
import time
from collections.abc import Callable, Iterator, Set
from dataclasses import dataclass

import child
import grade
import judge
import markers
import mistakes
import once
import recognize
import report
import submission
import tasks
import units
import years

BASES = ("solution", "simple", "forms")     # submissions that are right
ESCAPED = [pathlib.Path(folder) / "kit-cheat"
           for folder in ("/tmp", "/var/tmp", "/dev/shm", "/")]

Faults = Callable[[set[str]], list[str]]    # of the tasks that were lost


@dataclass
class Case:
    name: str
    files: dict[str, str]
    faults: Faults | None
    lost: frozenset[str] = frozenset()  # tasks, of a wrong submission


class Cases:
    """All submissions that are made of the repository's own sources."""

    def __init__(self):
        self.texts, self.course = markers.load()
        self.solution = {name: markers.solution(text, name)
                         for name, text in self.texts.items()}
        self.order = {section.id: at for at, section
                      in enumerate(self.course.sections)}
        self.sample = (int(os.environ.get("FIRST") or 0), None,
                       int(os.environ.get("EVERY") or 1))
        # task: names of the files with its regions
        self.regions: dict[str, set[str]] = {}
        for name, text in self.texts.items():
            for region in markers.regions(text, name):
                if region.task in self.course.tasks:
                    self.regions.setdefault(region.task, set()).add(name)

    def all(self) -> Iterator[Case]:
        yield Case("solution", self.solution, self.loses())
        for name in self.in_turn(["starter", *BASES[1:]]):
            yield Case(name, self.base(name), self.starter
                       if name == "starter" else self.loses())
        yield from itertools.islice(self.many(), *self.sample)

    def in_turn(self, all_: list) -> list:
        """All of them; of a sample one."""
        first, _, every = self.sample
        return all_ if every == 1 else [all_[first % len(all_)]]

    def many(self) -> Iterator[Case]:
        for task in self.regions:
            yield Case(f"without {task}", {
                name: markers.stub(text, [task], self.course, name)
                for name, text in self.texts.items()}, self.without(task))
        for table in mistakes.tables():
            yield from self.wrong(table)

    def base(self, name: str) -> dict[str, str]:
        """The sources of a correct submission; what it lacks is ours."""
        if name == "starter":
            return {name: markers.starter(text, self.course, name)
                    for name, text in self.texts.items()}
        files = dict(self.solution)
        if name == "simple":
            files["Graph.hpp"] = markers.solution(
                markers.open_graph(self.course), markers.OPEN_GRAPH)
        if name == "forms":
            for path in (mistakes.FOLDER / "forms").iterdir():
                files[path.name] = path.read_text(encoding="utf-8")
        return files

    def wrong(self, table: str) -> Iterator[Case]:
        for mistake in mistakes.read(table):
            files = self.base(mistake.base)
            files[mistake.file] = mistake.edited(files.get(mistake.file, ""))
            name = f"{table}: {mistake.name}"
            if mistake.base == "starter":
                yield Case(name, files, self.starter)
                continue
            loses = self.ids(mistake)
            if loses or not mistake.loses:      # else its tasks are dropped
                yield Case(name, files, self.loses(loses), loses)

    def ids(self, mistake: mistakes.Mistake) -> frozenset[str]:
        if "*" in mistake.loses:
            needs = {"Graph.hpp": "graph", "mine.hpp": "step"}.get(
                mistake.file, "cloth")
            return frozenset(
                task.id for task in self.course.tasks.values()
                if task.needs == needs)
        asked = mistake.loses - self.course.dropped
        if unknown := asked - self.course.tasks.keys():
            raise mistakes.MistakeError(
                f"{mistake.where}: no tasks: {sorted(unknown)}")
        return asked

    def loses(self, expected: Set[str] = frozenset()) -> Faults:
        def faults(lost):
            return ([f"did not lose {task}" for task in sorted(expected - lost)]
                    + [f"lost {task}" for task in sorted(lost - expected)])
        return faults

    def starter(self, lost: set[str]) -> list[str]:
        return [f"did not lose {task}" for task in self.regions
                if task not in lost and self.course.tasks[task].points]

    def without(self, task: str) -> Faults:
        def section(id):
            return self.course.tasks[id].section.id

        def faults(lost):
            found = [f"lost {id} of an earlier section" for id in sorted(lost)
                     if self.order[section(id)] < self.order[section(task)]]
            if not any(section(id) == section(task) for id in lost):
                found.append(f"lost nothing of section {section(task)}")
            return found
        return faults


class Memory:
    """judge.Results of tests of other submissions that read the same files: to
    grade many that differ little. Given to Judge, it saves most of the work."""

    def __init__(self):
        self.kept: dict[tuple[units.Way, tuple[str, ...]], list[
            tuple[set[str], dict[str, bytes], judge.Results]]] = {}

    def recall(self, way: units.Way, tests: tuple[str, ...],
               files: dict[str, bytes]) -> judge.Results | None:
        for there, read, results in self.kept.get((way, tests), []):
            if there == files.keys() and all(
                    files[name] == text for name, text in read.items()):
                return dict(results)
        return None

    def keep(self, way: units.Way, tests: tuple[str, ...],
             files: dict[str, bytes], included: set[str],
             results: judge.Results) -> None:
        self.kept.setdefault((way, tests), []).append(
            (set(files), {name: files[name] for name in included}, results))


class Check:
    """Grades the cases, two at a time, and counts."""

    def __init__(self, cases: Cases):
        self.cases = cases
        self.kit = once.Kit()
        self.tests = grade.tests_of(cases.course)
        judge.prepare(self.kit, self.tests, 2)
        self.memory = Memory()
        self.passed = self.failed = 0

    def judge(self, case: Case, tests: dict[str, str]) -> judge.Results:
        return judge.judge(self.kit, {
            name: text.encode() for name, text in case.files.items()}, tests,
            1, self.memory)

    def run(self, case: Case) -> tuple[list[str], float]:
        started = time.monotonic()
        graded = report.combine(
            self.cases.course, "case", submission.Submission({}),
            self.judge(case, self.tests)).graded
        assert case.faults
        faults = case.faults({g.task.id for g in graded if not g.passed})
        # The mistake that is named is the one that was made.
        faults += [f"{g.task.id} is called '{name}'" for g in graded
                   for _, name in [g.result.recognized[:2] or ("", "")]
                   if g.result.recognized[:1] == [recognize.KNOWN]
                   and not case.name.endswith(f": {name}")]
        # The report on tasks that should not be lost.
        for g in graded:
            if not g.passed and any(g.task.id in fault for fault in faults):
                faults += ["  " + line for line in
                           report.failure(self.cases.course, g)]
        faults += [f"{path} was written" for path in ESCAPED
                   if os.path.lexists(path)]
        return faults, time.monotonic() - started

    def older(self) -> None:
        """Submissions to starters that were handed out lose nothing."""
        for year in self.cases.in_turn([*years.years().values()]):
            course = year.course(self.cases.course)
            # Their numbers are those of then.
            for level in (self.cases.in_turn([*years.LEVELS])
                          if year.numbers == course.constants else ()):
                started = time.monotonic()
                taken = submission.Submission({
                    path.name: path.read_bytes() for path in
                    (year.unpacked() / level).iterdir()}, starter=year.version)
                begun = years.begun_with(taken, course)
                graded = report.combine(course, "case", taken, judge.judge(
                    self.kit, taken.files, self.tests, 2, year=begun))
                self.say(f"starter of {year.version}, {level}", [
                    line for one in graded.graded
                    if not one.passed and one.task.counted
                    for line in report.failure(course, one)],
                    time.monotonic() - started)

    def say(self, name: str, faults: list[str], seconds: float) -> None:
        self.passed += not faults
        self.failed += bool(faults)
        print(f"{'FAIL' if faults else 'ok  '}  {name}  ({seconds:.0f} s)",
              flush=True)
        for fault in faults:
            print(f"      {fault}", flush=True)

    def all(self, only: str) -> None:
        cases = [case for case in self.cases.all() if only in case.name]
        # First the solution, as most others share units with it.
        for case in cases[:1]:
            self.say(case.name, *self.run(case))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for case, done in zip(cases[1:], pool.map(self.run, cases[1:])):
                self.say(case.name, *done)


def keep_answers(check: Check) -> None:
    """Write what each mistake answers, unless another one, or what a starter
    leaves out, answers the same."""
    course = check.cases.course
    found: dict[str, list[tuple[str, list]]] = {}
    starter = Case("starter", check.cases.base("starter"), None,
                   frozenset(course.tasks))
    for case in (starter, *check.cases.wrong("cloth"),
                 *check.cases.wrong("graph")):
        name = case.name.partition(": ")[2]
        print(case.name, flush=True)
        for test, result in check.judge(case, {
                test: check.tests[test] for id in case.lost
                for test in course.tasks[id].tests}).items():
            if result.mark and test not in recognize.DRAWN:
                found.setdefault(test, []).append((name, result.mark))
        write_answers(found)


def write_answers(found: dict[str, list[tuple[str, list]]]) -> None:
    tables = []
    for test, marks in sorted(found.items()):
        alone = {name: mark for name, mark in sorted(marks) if name and sum(
            recognize.same(mark, other) for _, other in marks) == 1}
        tables.append(f"{json.dumps(test)}: {{\n" + ",\n".join(
            f" {json.dumps(name)}: {json.dumps(mark)}"
            for name, mark in alone.items()) + "}")
    recognize.FILE.write_text("{" + ",\n".join(tables) + "}\n", "ascii")


def programs(check: Check) -> None:
    """What is held by programs of its own: they take cases by their names. Of
    the longest a sample takes one part in turn."""
    folder = once.KIT
    own = {name: value for name, value in os.environ.items()
           if name not in ("EVERY", "FIRST")}
    part = check.cases.in_turn(["Grading", "Whole",
                                "Runner OwnTests Dates"])
    for name, *only in (["pages.py"], ["test_report.py"], ["test_grader.py"],
                        ["test_programs.py", *" ".join(part).split()]):
        started = time.monotonic()
        done = child.run([sys.executable, folder / name, *only], 1500,
                         text=True, capture_output=True, env=own)
        output = done.stdout + done.stderr
        ran = re.search(r"^Ran (\d+) tests? ", output, re.MULTILINE)
        faults = output.strip().split("\n") if done.returncode else []
        check.say(name, faults, time.monotonic() - started)
        if ran and not faults:
            check.passed += int(ran[1]) - 1


def main() -> bool:
    only = os.environ.get("ONLY", "")
    try:
        check = Check(Cases())
        if sys.argv[1:] == ["mistakes"]:
            keep_answers(check)
            return False
        if not only:
            programs(check)
            check.older()
        check.all(only)
    except (markers.MarkerError, tasks.TasksError, once.KitError,
            mistakes.MistakeError) as error:
        sys.exit(f"kit-check: {error}")
    print(f"{check.passed} passed, {check.failed} failed")
    return check.failed != 0


if __name__ == "__main__":
    sys.exit(main())
