"""Build and run the tests of all tasks against a submission.

One unit holds all tests of a kind. If it does not compile, the tests that the
errors come from are built apart, so that what is missing costs its own task.
Cloth tests run on the kit's own graph first, so that a broken graph costs its
own tasks, and then, if they fail, on the submission's: either may pass.

A test shares its process with the submission, so what it says is not enough:
a task also passes only if its answers (check.hpp) are those of the solution,
which has been graded here before, in processes of its own.
"""

import concurrent.futures
import dataclasses
import itertools
import json
import os
import pathlib
import secrets
import shutil
import signal
import tempfile
import threading
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from typing import Any

import diagnosis
import markers
import mend
import names
import once
import ranking
import recognize
import sandbox
import units
import years

PROGRAM = {"mass_spring.hpp", "mass_spring.cpp"}
STEP = "mine.hpp"
LAST_STAGE, *STAGES_BEFORE = names.STAGES
LIMITS = sandbox.Limits()
# The kit's own program ends: on a busy machine it may take longer.
OWN_LIMITS = sandbox.Limits(cpu=40, wall=200)
BUDGET = 300        # seconds of processor time for a submission
OVER = "grading it takes more than 5 minutes of processor time"
STOPPED = {
    "time": f"it takes more than {LIMITS.cpu} s of processor time, or waits",
    "memory": f"it takes more than {LIMITS.memory >> 20} MB of memory",
    "output": f"it writes more than {LIMITS.output >> 20} MB",
    "threads": f"it has more than {LIMITS.threads} threads",
}
# From the worst to the best.
RANK = ["missing", "not compiled", "stopped", "crashed", "failed", "passed"]


@dataclass
class Result:
    """How a test ended."""
    status: str            # one of RANK
    text: str = ""         # what happened; nothing for "failed"
    expected: str = ""
    got: str = ""
    did: str = ""
    name: str = ""         # of the function in the test
    answers: sandbox.Answers = field(default_factory=dict)
    usual: recognize.Numbers = field(default_factory=dict)  # of the solution
    mark: list = field(default_factory=list)    # of a mistake: recognize.py
    recognized: recognize.Said = field(default_factory=list)
    doubtful: str = ""      # what a person should look at
    mended: bool = False    # "not compiled" is a function, not the submission

    @property
    def passed(self) -> bool:
        return self.status == "passed"


Results = dict[str, Result]     # by test


def result_of(test: str, outcome: sandbox.Outcome, names: Container[str],
              expected: sandbox.Answers | None) -> Result:
    """A test passed if it says so, ends in peace, and has answered what is
    expected: {name: (tolerance, numbers)}, or None if nobody knows that."""
    did, name = outcome.did, outcome.name
    verdict = outcome.verdict
    # The submission shares the process that says this: no words of its own.
    if diagnosis.foreign(did, name):
        did = name = ""
    if diagnosis.foreign(*verdict):
        return Result("failed", "", "words of the kit's test", "others",
                      diagnosis.short(did), name,
                      doubtful="makes a test of {task} say what it can't")
    if verdict[:1] == ["failed"] and len(verdict) == 3:
        return Result("failed", "", diagnosis.short(verdict[1]),
                      diagnosis.short(verdict[2]), diagnosis.short(did), name)
    if outcome.stopped:
        return Result("stopped", STOPPED[outcome.stopped],
                      did=diagnosis.short(did), name=name)
    if verdict[:1] == ["passed"] and len(verdict) == 3 and outcome.code == 0:
        if verdict[1] == "0":
            return Result("missing", "no such test is in the kit")
        if fault := wrong(outcome.answers, expected or {}):
            return Result(
                "failed", "", *fault, diagnosis.short(did), name,
                # Rounded to float, it is no forgery.
                doubtful="passed the tests of {task}, but can't compute what "
                "they ask for" if wrong(outcome.answers, {
                    name: (max(tolerance, 1e-5), numbers) for name, (
                        tolerance, numbers) in (expected or {}).items()})
                else "")
        if verdict[2] != "0":
            return Result("passed", answers=outcome.answers)
    return Result("crashed", diagnosis.crash(outcome, names),
                  did=diagnosis.short(did), name=name)


def wrong(answers: sandbox.Answers,
          expected: sandbox.Answers) -> tuple[str, str] | None:
    """What is expected and what came, of an answer that is needed and not
    there, or wrong; or None. check.hpp says what the last sign of a name
    means."""
    some_of, found = set(), set()
    for name, (tolerance, numbers) in expected.items():
        if name[-1] == "?":
            some_of.add(name.split()[0])
        given = answers.get(name, (0, []))[1]
        if name not in answers and name[-1] in "?~":
            continue
        found.add(name.split()[0])
        what = f"the solution's {len(numbers)} numbers of: {name.rstrip('?~')}"
        if len(given) != len(numbers):
            return what, str(len(given))
        for at, (a, b) in enumerate(zip(given, numbers), 1):
            if not abs(a - b) <= tolerance * max(1, abs(b)):    # NaN, too
                return f"{what}, {b:.12g} as number {at}", f"{a:.12g}"
    return next(((f"answers of: {name}", "none")
                 for name in sorted(some_of - found)), None)


def refused(unit: units.Unit) -> Result:
    """The result of a unit that was not even compiled."""
    return Result("stopped" if unit.refused == OVER else "not compiled",
                  unit.refused, doubtful=unit.doubtful)


def mended(result: Result) -> Result:
    """A crash in a function that does not compile tells the reason."""
    said = mend.said(result.text) if result.status == "crashed" else None
    if not said:
        return result
    return dataclasses.replace(result, status="not compiled", text=said, did="",
                               mended=True)


def solution() -> dict[str, bytes]:
    """{name: bytes} of the solution."""
    return {name: markers.solution(text, name).encode()
            for name, text in markers.read_sources().items()}


class Judge:
    """Grades one submission in a folder of its own."""

    def __init__(self, kit: once.Kit, folder: pathlib.Path,
                 files: dict[str, bytes], jobs: int,
                 memory: Any = None,
                 year: years.Year | None = None):
        self.kit, self.memory = kit, memory     # kit_check.Memory
        self.jobs = threading.Semaphore(jobs)
        self.folder, self.files = folder, files
        self.seconds = 0.0      # of processor time so far
        self.numbers = itertools.count(1)
        self.data = folder / "data"
        shutil.copytree(kit.data, self.data)
        self.names = names.defines(files)
        if kit.answers is None:     # it answers all questions
            self.names += ("KIT_SOLUTION",)
        self.given = year.unpacked() / "given" if year else None
        own = units.Room(kit, folder / "own", files, self.given)
        self.rooms: dict[str, list[units.Room]] = {
            "graph": [own], "cloth": [own], "step": [own], "program": []}
        ours = {name: text for name, text in solution().items()
                if name in ("Graph.hpp", "mass_spring.hpp")}

        def with_ours(folder_name, *names_of_ours):
            room = units.Room(kit, folder / folder_name, {
                **files, **{name: ours[name] for name in names_of_ours}},
                self.given)
            for name in names_of_ours:
                room.names.pop(name, None)
            return room
        if files["Graph.hpp"] != ours["Graph.hpp"]:
            self.rooms["cloth"].insert(0, with_ours("given", "Graph.hpp"))
        # A main() and a step are judged by what they do with right forces, too.
        self.beside: units.Room | None = None
        if any(files.get(name) != text for name, text in ours.items()):
            self.beside = with_ours("beside", *ours)
            self.rooms["step"].insert(0, self.beside)
            if (PROGRAM <= files.keys()
                    and files["mass_spring.hpp"] != ours["mass_spring.hpp"]):
                self.rooms["program"].append(self.beside)

    def run(self, tests: dict[str, str]) -> Results:
        """{test: Result} of {test: what it needs}."""
        groups: dict[units.Way, list[str]] = {}
        for test, needs in tests.items():
            way = units.way_of(test, needs)
            if needs != "graph":
                way = dataclasses.replace(way, defines=way.defines + self.names)
            groups.setdefault(way, []).append(test)
        # What takes longest first.
        order = sorted(groups, key=lambda group: (-len(groups[group]), group))
        with concurrent.futures.ThreadPoolExecutor(len(groups) or 1) as pool:
            found = pool.map(lambda group: self.group(group, groups[group]),
                             order)
            return {test: result for part in found
                    for test, result in part.items()}

    def group(self, way: units.Way, tests: list[str]) -> Results:
        results: Results = {}
        if way.needs == "cloth" and not PROGRAM & self.files.keys():
            return {test: Result("missing", "there is no mass_spring.hpp and "
                                 "no mass_spring.cpp") for test in tests}
        if way.needs == "step" and STEP not in self.files:
            return dict.fromkeys(
                tests, Result("missing", f"there is no {STEP}"))
        for room, way in self.attempts(way, tests):
            left = [test for test in tests
                    if test not in results or not results[test].passed]
            # A file without main() gets no score.
            with_ours = (room in self.rooms["program"]
                         and way.needs != "step")
            if with_ours:
                left = [test for test in left if results[test].mended
                        or results[test].status != "not compiled"]
            for test, result in self.judged(room, way, left).items():
                best = results.setdefault(test, result)
                # A message about the kit's graph does not help if the task
                # also fails with the student's own graph.
                better = (RANK.index(result.status) - RANK.index(best.status)
                          or not with_ours and result.status in
                          ("not compiled", "crashed"))
                if better > 0:
                    results[test] = result
        return results

    def attempts(self, way: units.Way,
                 tests: list[str]) -> Iterator[tuple[units.Room, units.Way]]:
        """In what tests are built: each passes if it does in any of them."""
        own = units.way_of(tests[0], way.needs)
        main = "KIT_PROGRAM" in own.defines
        for room in self.rooms[way.needs] + main * self.rooms["program"]:
            yield room, (way if room is not self.beside else
                         dataclasses.replace(way, defines=own.defines
                                             + names.defines(room.files)))

    def judged(self, room: units.Room, way: units.Way,
               tests: list[str]) -> Results:
        """All stages of a main() in one unit, or else in one each: a header
        that may be included once is no part of the others."""
        results = self.remembered(room, way, tests)
        again = [test for test in results
                 if results[test].status == "not compiled"]
        if units.all_stages(way) and again:
            others = tuple(name for name in way.defines if name != "KIT_STAGES")
            for stage in (LAST_STAGE, *STAGES_BEFORE):
                found = self.remembered(room, dataclasses.replace(
                    way, defines=(*others, f"KIT_STAGE={stage}")), again)
                if stage != LAST_STAGE:     # else it is true of all
                    found = {test: dataclasses.replace(
                        result, did=result.did or f"built with STAGE={stage}")
                        for test, result in found.items()}
                results.update(found)
                again = [test for test in again if results[test].passed]
        return results

    def remembered(self, room: units.Room, way: units.Way,
                   tests: list[str]) -> Results:
        if not self.memory:
            return self.attempt(room, way, tests, set())
        known = self.memory.recall(way, tuple(tests), room.files)
        if known is None:
            read: set[str] = set()
            known = self.attempt(room, way, tests, read)
            self.memory.keep(way, tuple(tests), room.files, read, known)
        return known

    def attempt(self, room: units.Room, way: units.Way, tests: list[str],
                read: set[str]) -> Results:
        """Each test of a room, in as few units as compile. What they read of
        the submission is added to `read`."""
        if not tests:
            return {}
        unit = self.compile(room, way, tests, read)
        if unit.program:
            return self.explained(room, way, self.run_all(unit, room.names),
                                  read)
        if unit.refused:
            return {test: refused(unit) for test in tests}
        errors = diagnosis.compile_errors(unit.output)
        blamed: set[str] = set().union(*(error.tests for error in errors))
        if not all(error.tests for error in errors):
            bridge = self.compile(room, way, [], read, link=False)
            if bridge.refused:
                return {test: refused(bridge) for test in tests}
            if diagnosis.compile_errors(bridge.output):
                return self.mended(room, way, tests, bridge, read)
        results: Results = {}
        alone = [test for test in tests if test in blamed]
        others = [test for test in tests if test not in blamed]
        if alone and others:
            unit = self.compile(room, way, others, read)
        if unit.program:
            results = self.run_all(unit, room.names)
        else:
            alone = tests
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            results.update(zip(alone, pool.map(
                lambda test: self.alone(room, way, test, read), alone)))
        return self.explained(room, way, results, read)

    def mended(self, room: units.Room, way: units.Way, tests: list[str],
               bridge: units.Unit, read: set[str]) -> Results:
        """The same without the functions that do not compile."""
        told = Result("not compiled", diagnosis.compile_message(
            bridge.output, room.names))
        whole, files = room, room.files
        # All stages: what is wrong may be that they share a unit.
        for _ in range(0 if units.all_stages(way) else mend.ROUNDS):
            left = mend.without_broken(files, [
                error for error in diagnosis.compile_errors(bridge.output)
                if error.file in whole.names])
            if not left:
                break
            files = left
            room = units.Room(
                self.kit, self.folder / f"mended{next(self.numbers)}", files,
                whole.given)
            room.names = whole.names
            bridge = self.compile(room, way, [], read, link=False)
            if bridge.refused:
                break
            if not diagnosis.compile_errors(bridge.output):
                results = self.attempt(room, way, tests, read)
                return {test: mended(results[test]) for test in tests}
        return {test: told for test in tests}

    def explained(self, room: units.Room, way: units.Way, results: Results,
                  read: set[str]) -> Results:
        """With the compiler's own words for calls that do not compile, and with
        the place of a crash in what was built without sanitizers."""
        crashed = [test for test, result in results.items()
                   if result.status == "crashed" and way.kind == "counted"]
        if crashed:
            unit = self.compile(room, dataclasses.replace(
                way, kind="checked",
                defines=way.defines + ("KIT_UNCOUNTED",)), crashed, read)
            found = self.run_all(unit, room.names) if unit.program else {}
            results.update({test: dataclasses.replace(
                results[test], text=found[test].text)
                for test in found if found[test].status == "crashed"})
        way = dataclasses.replace(
            way, defines=way.defines + ("KIT_MUST_COMPILE",))
        for test, result in results.items():
            if result.status == "failed" and result.got == "an error":
                unit = self.compile(room, way, [test], read, link=False)
                error = diagnosis.first_error(unit.output, room.names, test)
                if error:
                    results[test] = dataclasses.replace(
                        result, got=f"an error: {error}")
        return results

    def alone(self, room: units.Room, way: units.Way, test: str,
              read: set[str]) -> Result:
        unit = self.compile(room, way, [test], read)
        if unit.program:
            return self.run_all(unit, room.names)[test]
        return refused(unit) if unit.refused else Result(
            "not compiled", diagnosis.compile_message(unit.output, room.names,
                                                      test))

    def compile(self, room: units.Room, way: units.Way, tests: list[str],
                read: set[str], link: bool = True) -> units.Unit:
        with self.jobs:
            unit = (units.Unit(None, refused=OVER) if self.seconds > BUDGET
                    else room.compile(way, tests, link))
            self.seconds += unit.seconds
        read |= unit.included
        return unit

    def run_all(self, unit: units.Unit, names: Container[str]) -> Results:
        """Each test of a program in a process of its own. Messages name places
        in these files first."""
        assert unit.program
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            results = dict(zip(unit.tests, pool.map(
                lambda test: self.run_one(unit, names, test, self.kit,
                                          self.data), unit.tests)))
        unit.program.unlink()
        return results

    def run_one(self, unit: units.Unit, names: Container[str], test: str,
                kit: once.Kit, data: pathlib.Path) -> Result:
        assert unit.program
        jail = [*kit.jail, *units.flags("--read", [
            "/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/proc/self",
            "/dev/null", "/dev/zero", "/dev/urandom", unit.program, data])]
        expected = kit.answers
        if expected is not None:    # what is asked is the last stage's
            expected = (expected.get(test, {})
                        if unit.stage in ("", LAST_STAGE) else {})
        crashing, tries = 0, 3
        while True:
            with self.jobs:
                if self.seconds > BUDGET:
                    return Result("stopped", OVER)
                outcome = sandbox.run_test(
                    jail, unit.program, test,
                    OWN_LIMITS if expected is None else LIMITS, kit, data,
                    crashing, expected is not None and test == ranking.TASK)
                self.seconds += outcome.seconds
            result = result_of(test, outcome, names, expected)
            self.recognize(test, result, outcome)
            # What earlier homework left crashes: without it once more.
            if (outcome.aspect & ~crashing
                    and result.status in ("crashed", "stopped")):
                crashing |= outcome.aspect
            # Where addresses are by chance, AddressSanitizer at times finds no
            # room for itself and ends before anything has run.
            elif outcome.begun or outcome.code != -signal.SIGSEGV:
                return result
            elif not (tries := tries - 1):
                return result


    def recognize(self, test: str, result: Result,
                  outcome: sandbox.Outcome) -> None:
        usual = recognize.numbers_of(outcome.usual)
        if self.kit.answers is None:
            result.usual = usual
        elif result.status == "failed":
            right = self.kit.usual.get(test, {})
            mark = recognize.mark((result.name, result.did, result.expected,
                                   result.got), usual)
            if recognize.tells(mark, right):
                result.mark, result.recognized = mark, recognize.recognized(
                    test, mark, usual, right)


def prepare(kit: once.Kit, tests: dict[str, str], jobs: int) -> None:
    """Grade the solution, once for each kit: its answers are expected."""
    def make(folder):
        kit.secret = secrets.token_bytes(32)
        kit.data = folder / "data"
        once.draw_cloth(kit.data, kit)
        results = judge(kit, files, tests, jobs)
        for test, result in sorted(results.items()):
            if not result.passed:
                raise once.KitError(
                    f"nothing is graded: {once.this_system()}, and the kit is "
                    f"checked with g++ {once.CHECKED}. Here the kit's own "
                    f"program ends otherwise in {test}, {result.status}: "
                    f"{result.text or f'expected {result.expected}'}"
                    + (f", got {result.got}" if result.got else "")
                    + "\nThat is no mistake of a student: grade on a system as "
                    "above, with [numbers] by which the cloth meets the ball")
        text = json.dumps({"secret": kit.secret.hex(), "answers": {
            test: result.answers for test, result in results.items()},
            "usual": {test: result.usual for test, result
                      in results.items()}})
        with open(os.open(folder / "answers.json", os.O_WRONLY | os.O_CREAT,
                          0o600), "w", encoding="ascii") as file:
            file.write(text)

    files = solution()
    kit.answers = None
    folder = kit.locked_part("solution", [
        *once.KIT.glob("*.*"), recognize.FILE, *once.TESTS.glob("*.*"),
        *units.ASKED.glob("*"),
        *map(markers.path_of, markers.SOURCES),
        *(once.ROOT / "CME212").rglob("*.hpp")], make,
        (sorted(tests.items()),))
    kept = json.loads((folder / "answers.json").read_text("ascii"))
    kit.data = folder / "data"
    kit.secret, kit.answers = bytes.fromhex(kept["secret"]), kept["answers"]
    kit.usual = kept["usual"]


def judge(kit: once.Kit, files: dict[str, bytes], tests: dict[str, str],
          jobs: int, memory: Any = None,
          year: years.Year | None = None) -> Results:
    """{test: Result} of a submission and {test: what it needs}; `year` is that
    of an older starter."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-grade-"))
    try:
        folder.chmod(0o755)
        return Judge(kit, folder, files, jobs, memory, year).run(tests)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
