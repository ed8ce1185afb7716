"""Hold the kit to what it promises:  make kit-check [ONLY=WORD] [EVERY=N]

The solution gets all points; the starter none of those that its stubs hold
back; each region stubbed alone turns red a test of its own section and none of
an earlier one; each submission of course/wrong/*.toml loses what it says and
nothing else. ONLY takes the cases whose names hold WORD; EVERY one in N of the
regions and wrong submissions, beginning with number FIRST, 0 if it is not
given: all FIRST < N together take each of them once.
"""

import concurrent.futures
import itertools
import os
import pathlib
import re
import sys
import time
from dataclasses import dataclass

import child
import grade
import judge
import markers
import once
import report
import submission
import tasks
from tasks import tomllib

WRONG = once.ROOT / "course/wrong"
BASES = ("solution", "simple", "forms")     # submissions that are right
KEYS = {"name", "file", "loses", "replace", "append", "prepend", "content",
        "base"}
ESCAPED = [pathlib.Path(folder) / "kit-cheat"
           for folder in ("/tmp", "/var/tmp", "/dev/shm", "/")]
LONGEST = judge.LIMITS.cpu // 2     # seconds; cheats that wait cost that much


@dataclass
class Case:
    name: str
    files: dict
    faults: object      # a function: {task: is it lost?} to a list of faults
    lost: frozenset = frozenset()       # tasks, of a wrong submission


class Cases:
    """All submissions that are made of the repository's own sources.

    A [[wrong]] of course/wrong has a `name`, the tasks that it `loses` (["*"]:
    all that its file serves; []: none, as it is right), and edits of a `file`,
    by default Graph.hpp: `replace` ([[old, new], ...], each old text occurring
    once), `prepend`, `append`, or its whole `content`. It starts from the
    solution, or from `base` = "simple": the graph of the level open, solved.
    One whose base is the starter gets no point that the starter does not get.
    """

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

    def all(self):
        yield Case("solution", self.solution, self.loses(set()))
        yield Case("starter", self.base("starter"), self.starter)
        for name in BASES[1:]:
            yield Case(name, self.base(name), self.loses(set()))
        yield from itertools.islice(self.many(), *self.sample)

    def many(self):
        for task in self.regions:
            yield Case(f"without {task}", {
                name: markers.stub(text, [task], self.course, name)
                for name, text in self.texts.items()}, self.without(task))
        for path in sorted(WRONG.glob("*.toml")):
            yield from self.wrong(path)

    def base(self, name):
        """The sources of a correct submission; what it lacks is ours."""
        if name == "starter":
            return {name: markers.starter(text, self.course, name)
                    for name, text in self.texts.items()}
        files = dict(self.solution)
        if name == "simple":
            files["Graph.hpp"] = markers.solution(
                markers.open_graph(self.course), markers.OPEN_GRAPH)
        if name == "forms":
            for path in (WRONG / "forms").iterdir():
                files[path.name] = path.read_text(encoding="utf-8")
        return files

    def wrong(self, path):
        at = path.relative_to(once.ROOT)
        entries = tomllib.loads(path.read_text("utf-8"))["wrong"]
        for entry in entries:
            where = f"{at}: {entry.get('name', 'an entry without a name')}"
            if unknown := entry.keys() - KEYS:
                raise SystemExit(f"{where}: unknown keys {sorted(unknown)}")
            files = self.base(entry.get("base", "solution"))
            file = entry.get("file", "Graph.hpp")
            text = entry.get("content", files.get(file, ""))
            for old, new in entry.get("replace", []):
                if text.count(old) != 1:
                    raise SystemExit(f"{where}: '{old}' occurs "
                                     f"{text.count(old)} times, expected once")
                text = text.replace(old, new)
            files[file] = (entry.get("prepend", "") + text
                           + entry.get("append", "") + "\n")
            if entry.get("base") == "starter":
                yield Case(f"{path.stem}: {entry['name']}", files, self.starter)
                continue
            loses = self.ids(entry["loses"], file, where)
            if loses or not entry["loses"]:     # else its tasks are dropped
                yield Case(f"{path.stem}: {entry['name']}", files,
                           self.loses(loses), frozenset(loses))

    def ids(self, loses, file, where):
        if loses == ["*"]:
            needs = {"Graph.hpp": "graph", "mine.hpp": "step"}.get(file,
                                                                  "cloth")
            return {task.id for task in self.course.tasks.values()
                    if task.needs == needs}
        asked = set(loses) - self.course.dropped
        if unknown := asked - self.course.tasks.keys():
            raise SystemExit(f"{where}: no tasks: {sorted(unknown)}")
        return asked

    def loses(self, expected):
        def faults(lost):
            return ([f"did not lose {task}" for task in sorted(expected - lost)]
                    + [f"lost {task}" for task in sorted(lost - expected)])
        return faults

    def starter(self, lost):
        return [f"did not lose {task}" for task in self.regions
                if task not in lost and self.course.tasks[task].points]

    def without(self, task):
        def section(id):
            return self.course.tasks[id].section.id

        def faults(lost):
            found = [f"lost {id} of an earlier section" for id in sorted(lost)
                     if self.order[section(id)] < self.order[section(task)]]
            if not any(section(id) == section(task) for id in lost):
                found.append(f"lost nothing of section {section(task)}")
            return found
        return faults


class Check:
    """Grades the cases, two at a time, and counts."""

    def __init__(self, cases):
        self.cases = cases
        self.kit = once.Kit()
        self.tests = grade.tests_of(cases.course)
        judge.prepare(self.kit, self.tests, 2)
        self.memory = judge.Memory()
        self.passed = self.failed = 0

    def grade(self, files):
        taken = {name: text.encode() for name, text in files.items()}
        results = judge.judge(self.kit, taken, self.tests, 1, self.memory)
        return report.combine(self.cases.course, "case",
                              submission.Submission(taken), results)

    def run(self, case):
        started = time.monotonic()
        graded = self.grade(case.files).graded
        faults = case.faults({g.task.id for g in graded if not g.passed})
        # The grader's words about tasks that should not be lost.
        for g in graded:
            if not g.passed and any(g.task.id in fault for fault in faults):
                faults += ["  " + line for line in report.failure(g)]
        faults += [f"{path} was written" for path in ESCAPED
                   if os.path.lexists(path)]
        return faults, time.monotonic() - started

    def say(self, name, faults, seconds):
        self.passed += not faults
        self.failed += bool(faults)
        print(f"{'FAIL' if faults else 'ok  '}  {name}  ({seconds:.0f} s)",
              flush=True)
        for fault in faults:
            print(f"      {fault}", flush=True)

    def all(self, only):
        cases = [case for case in self.cases.all() if only in case.name]
        # First the solution, as most others share units with it.
        for case in cases[:1]:
            self.say(case.name, *self.run(case))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for case, done in zip(cases[1:], pool.map(self.run, cases[1:])):
                self.say(case.name, *done)


def programs(check):
    """What is held by programs of its own: they take cases by their names."""
    folder = once.KIT
    own = {name: value for name, value in os.environ.items()
           if name not in ("EVERY", "FIRST")}
    for name in ("pages.py", "test_report.py", "test_grader.py",
                 "test_grading.py", "test_class.py", "test_grade_tests.py",
                 "test_seeds.py"):
        if not (folder / name).exists():
            continue
        started = time.monotonic()
        done = child.run([sys.executable, folder / name], 1500, text=True,
                         capture_output=True, env=own)
        output = done.stdout + done.stderr
        ran = re.search(r"^Ran (\d+) tests? ", output, re.MULTILINE)
        faults = output.strip().split("\n") if done.returncode else []
        check.say(name, faults, time.monotonic() - started)
        if ran and not faults:
            check.passed += int(ran[1]) - 1


def main():
    only = os.environ.get("ONLY", "")
    judge.LIMITS.cpu, judge.LIMITS.wall = LONGEST, 10
    try:
        check = Check(Cases())
    except (markers.MarkerError, tasks.TasksError, once.KitError) as error:
        sys.exit(f"kit-check: {error}")
    if not only:
        programs(check)
    check.all(only)
    print(f"{check.passed} passed, {check.failed} failed")
    return check.failed != 0


if __name__ == "__main__":
    sys.exit(main())
