"""Build and run the tests of all tasks against a submission.

One unit holds all tests of a kind. If it does not compile, the tests that the
errors come from are built apart, so that what is missing costs its own task.
Cloth tests run on the kit's own graph first, so that a broken graph costs its
own tasks, and then, if they fail, on the submission's: either may pass.
"""

import concurrent.futures
import dataclasses
import pathlib
import shutil
import signal
import tempfile
import threading
from dataclasses import dataclass

import build
import diagnosis
import markers
import names
import once
import sandbox

PROGRAM = {"mass_spring.hpp", "mass_spring.cpp"}
LIMITS = sandbox.Limits()
STOPPED = {
    "time": f"it takes more than {LIMITS.cpu} s of processor time, or waits",
    "memory": f"it takes more than {LIMITS.memory >> 20} MB of memory",
    "output": f"it writes more than {LIMITS.output >> 20} MB",
    "threads": f"it has more than {LIMITS.threads} threads",
}
# From the worst to the best: what is shown if no graph makes a test pass.
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

    @property
    def passed(self):
        return self.status == "passed"


def result_of(outcome, names):
    """A test passed if it says so with the word, and ends in peace."""
    did, name = outcome.did, outcome.name
    verdict = outcome.verdict
    if verdict[:1] == ["failed"] and len(verdict) == 3:
        return Result("failed", "", *map(diagnosis.short, verdict[1:]),
                      diagnosis.short(did), name)
    if outcome.stopped:
        return Result("stopped", STOPPED[outcome.stopped],
                      did=diagnosis.short(did), name=name)
    if verdict[:1] == ["passed"] and len(verdict) == 3 and outcome.code == 0:
        if verdict[1] == "0":
            return Result("missing", "no such test is in the kit")
        if verdict[2] != "0":
            return Result("passed")
    return Result("crashed", diagnosis.crash(outcome, names),
                  did=diagnosis.short(did), name=name)


class Memory:
    """Results of tests of other submissions that read the same files: to
    grade many that differ little. Given to Judge, it saves most of the work."""

    def __init__(self):
        self.kept = {}

    def recall(self, way, tests, files):
        for names, read, results in self.kept.get((way, tests), []):
            if names == files.keys() and all(
                    files[name] == text for name, text in read.items()):
                return dict(results)
        return None

    def keep(self, way, tests, files, included, results):
        self.kept.setdefault((way, tests), []).append(
            (set(files), {name: files[name] for name in included}, results))


class Judge:
    """Grades one submission in a folder of its own."""

    def __init__(self, kit, folder, files, jobs, memory=None):
        self.kit, self.memory = kit, memory
        self.jobs = threading.Semaphore(jobs)
        self.files = files
        self.names = names.defines(files)
        own = build.Room(kit, folder / "own", files)
        self.rooms = {"graph": [own], "cloth": [own]}
        graph = markers.solution((once.ROOT / "Graph.hpp").read_text("utf-8"))
        if files["Graph.hpp"] != graph.encode():
            given = build.Room(kit, folder / "given",
                               {**files, "Graph.hpp": graph.encode()})
            given.names.remove("Graph.hpp")
            self.rooms["cloth"].insert(0, given)

    def run(self, tests):
        """{test: Result} of {test: what it needs}."""
        groups = {}
        for test, needs in tests.items():
            way = build.way_of(test, needs)
            if needs == "cloth":
                way = dataclasses.replace(way, defines=way.defines + self.names)
            groups.setdefault(way, []).append(test)
        # What takes longest first.
        order = sorted(groups, key=lambda group: (-len(groups[group]), group))
        with concurrent.futures.ThreadPoolExecutor(len(groups) or 1) as pool:
            found = pool.map(lambda group: self.group(group, groups[group]),
                             order)
            return {test: result for part in found
                    for test, result in part.items()}

    def group(self, way, tests):
        results = {}
        if way.needs == "cloth" and not PROGRAM & self.files.keys():
            return {test: Result("missing", "there is no mass_spring.hpp and "
                                 "no mass_spring.cpp") for test in tests}
        for room in self.rooms[way.needs]:
            left = [test for test in tests
                    if test not in results or not results[test].passed]
            for test, result in self.remembered(room, way, left).items():
                best = results.setdefault(test, result)
                if RANK.index(result.status) > RANK.index(best.status):
                    results[test] = result
        return results

    def remembered(self, room, way, tests):
        if not self.memory:
            return self.attempt(room, way, tests, set())
        known = self.memory.recall(way, tuple(tests), room.files)
        if known is None:
            read = set()
            known = self.attempt(room, way, tests, read)
            self.memory.keep(way, tuple(tests), room.files, read, known)
        return known

    def attempt(self, room, way, tests, read):
        """Each test of a room, in as few units as compile. What they read of
        the submission is added to `read`."""
        if not tests:
            return {}
        unit = self.compile(room, way, tests, read)
        if unit.program:
            return self.run_all(unit, room.names)
        if unit.refused:
            return {test: Result("not compiled", unit.refused)
                    for test in tests}
        errors = diagnosis.compile_errors(unit.output)
        blamed = set().union(*(error.tests for error in errors))
        if not all(error.tests for error in errors):
            bridge = self.compile(room, way, [], read, link=False)
            if diagnosis.compile_errors(bridge.output) or bridge.refused:
                text = bridge.refused or diagnosis.compile_message(
                    bridge.output, room.names)
                return {test: Result("not compiled", text) for test in tests}
        results, alone = {}, [test for test in tests if test in blamed]
        others = [test for test in tests if test not in blamed]
        if alone and others:
            unit = self.compile(room, way, others, read)
            if unit.program:
                results = self.run_all(unit, room.names)
            else:
                alone = tests
        else:
            alone = tests
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            results.update(zip(alone, pool.map(
                lambda test: self.alone(room, way, test, read), alone)))
        return results

    def alone(self, room, way, test, read):
        unit = self.compile(room, way, [test], read)
        if unit.program:
            return self.run_all(unit, room.names)[test]
        return Result("not compiled", unit.refused or diagnosis.compile_message(
            unit.output, room.names, test))

    def compile(self, room, way, tests, read, link=True):
        with self.jobs:
            unit = room.compile(way, tests, link)
        read |= unit.included
        return unit

    def run_all(self, unit, names):
        """Each test of a program in a process of its own. Messages name places
        in these files first."""
        def one(test):
            jail = [*self.kit.jail, *build.flags("--read", [
                "/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/proc/self",
                "/dev/null", "/dev/zero", "/dev/urandom", unit.program,
                once.TESTS / "data"])]
            crashing, tries = 0, 3
            while True:
                with self.jobs:
                    outcome = sandbox.run_test(
                        jail, unit.program, test, LIMITS, crashing)
                result = result_of(outcome, names)
                # What earlier homework left crashes: without it once more.
                if (outcome.aspect & ~crashing
                        and result.status in ("crashed", "stopped")):
                    crashing |= outcome.aspect
                # Where addresses are by chance, AddressSanitizer at times finds
                # no room for itself and ends before anything has run.
                elif outcome.begun or outcome.code != -signal.SIGSEGV:
                    return result
                elif not (tries := tries - 1):
                    return result
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            results = dict(zip(unit.tests, pool.map(one, unit.tests)))
        unit.program.unlink()
        return results


def judge(kit, files, tests, jobs, memory=None):
    """{test: Result} of a submission and {test: what it needs}."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-grade-"))
    try:
        folder.chmod(0o755)
        return Judge(kit, folder, files, jobs, memory).run(tests)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
