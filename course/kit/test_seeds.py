"""Tests of SEED: the tests' numbers with one, and what it is good for.

SEEDS=100 python3 course/kit/test_seeds.py grades all right submissions of the
kit with the seeds 1 to 100; else the solution alone, with three. Each is
compiled once. A minute of processor time.
"""

import copy
import os
import pathlib
import secrets
import shutil
import tempfile
import unittest
from collections.abc import Container, Iterable

import build
import class_output
import grade
import judge
import kit_check
import once
import report
import submission

JOBS = 2
FEW = (1, 2, 1 << 62)
PUBLIC = ""
Kits = dict[int | str, once.Kit]     # by seed


class OfSeeds(judge.Judge):
    """Runs each test with all seeds: {seed: a kit with answers or None}."""

    def __init__(self, kits: Kits, folder: pathlib.Path,
                 files: dict[str, bytes]):
        super().__init__(next(iter(kits.values())), folder, files, JOBS)
        self.kits = kits
        self.results: dict[int | str, judge.Results] = {
            seed: {} for seed in kits}

    def run_one(self, unit: build.Unit, names: Container[str], test: str,
                kit: once.Kit, data: pathlib.Path) -> judge.Result:
        for seed, kit in self.kits.items():
            self.results[seed][test] = super().run_one(unit, names, test, kit,
                                                       kit.data)
        return min((self.results[seed][test] for seed in self.kits),
                   key=lambda result: judge.RANK.index(result.status))


def kits_of(kit: once.Kit, seeds: Iterable[int], top: pathlib.Path) -> Kits:
    """A kit for each seed, with a cloth of its own."""
    kits: Kits = {}
    folder = pathlib.Path(tempfile.mkdtemp(dir=top))
    folder.chmod(0o755)
    for seed in seeds:
        kits[seed] = one = copy.copy(kit)
        one.seed, one.answers = str(seed), None
        one.secret, one.data = secrets.token_bytes(32), folder / f"data{seed}"
        once.draw_cloth(one.data, one)
    return kits


def grade_with(kits: Kits, files: dict[str, str],
               tests: dict[str, str]) -> dict[int | str, judge.Results]:
    """{seed: {test: Result}}; a test that does not compile has none."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-seeds-"))
    try:
        folder.chmod(0o755)
        of_seeds = OfSeeds(kits, folder, {
            name: text.encode() for name, text in files.items()})
        of_seeds.run(tests)
        return of_seeds.results
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Seeds(unittest.TestCase):
    top: pathlib.Path
    cases: kit_check.Cases
    kit: once.Kit
    tests: dict[str, str]

    @classmethod
    def setUpClass(cls):
        cls.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.top)
        cls.top.chmod(0o755)
        cls.cases, cls.kit = kit_check.Cases(), once.Kit()
        cls.tests = grade.tests_of(cls.cases.course)

    def test_tables_of_the_public_numbers_lose_by_a_seed_alone(self):
        kits: Kits = {PUBLIC: copy.copy(self.kit),
                      **kits_of(self.kit, FEW, self.top)}
        kits[PUBLIC].data = once.TESTS / "data"
        kits[PUBLIC].secret = bytes(32)
        case, = self.cases.wrong("tables")
        tests = {test: needs for test, needs in self.tests.items()
                 if test in case.lost}
        lost = {seed: {test for test in tests if not found[test].passed}
                for seed, found in grade_with(kits, case.files, tests).items()}
        self.assertEqual(lost, {
            PUBLIC: set(), **{seed: set(case.lost) for seed in FEW}})

    def test_right_submissions_lose_nothing(self):
        count = int(os.environ.get("SEEDS") or 0)
        kits = kits_of(self.kit, range(1, count + 1) if count else FEW,
                       self.top)
        for name in kit_check.BASES if count else ("solution",):
            results = grade_with(kits, self.cases.base(name), self.tests)
            self.assertEqual([], [
                f"{name}: SEED={seed}, {test}: {result.did}: "
                f"{report.outcome(result)}" for seed, found in results.items()
                for test, result in found.items() if not result.passed])
            if name == "solution":      # what the others are asked for
                for seed, one in kits.items():
                    one.answers = {test: result.answers for test, result
                                   in results[seed].items()}

    def test_a_seed_draws_the_same_cloth_again(self):
        def drawn(seed, name):
            kit = copy.copy(self.kit)
            kit.seed, kit.secret = seed, name.encode()
            once.draw_cloth(self.top / name, kit)
            return [(self.top / name / f"cloth.{end}").read_text()
                    for end in ("nodes", "tets")]
        first, again, other = drawn("7", "a"), drawn("7", "b"), drawn("8", "c")
        self.assertEqual(first, again)
        self.assertNotEqual(first[0], other[0])
        self.assertNotEqual(first[1], other[1])     # and the pins elsewhere
        public = drawn("", "d")
        self.assertEqual(public[1],
                         (once.TESTS / "data/cloth.tets").read_text())
        for nodes, quads in (first, other, public):
            lines = nodes.splitlines()
            self.assertEqual(len(lines), 16)
            self.assertIn(lines[-1], once.CORNERS)
            self.assertTrue(set(once.CORNERS) <= set(lines))
            # No quad joins the cloth and the quad apart, whose z is 0.3.
            for quad in quads.splitlines():
                self.assertEqual(len({float(lines[int(i)].split()[2]) > 0.2
                                      for i in quad.split()}), 1)

    def test_a_report_names_the_seed(self):
        self.assertEqual(list(class_output.seeds({"a": "7", "b": "7"})),
                         ["tests with the numbers of SEED=7"])
        self.assertEqual(list(class_output.seeds({"a": "", "b": ""})), [])
        # One task was graded anew with a seed, and no other.
        self.assertEqual(list(class_output.seeds({"a": "", "b": "7"})),
                         ["tests with the numbers of SEED=7: b"])
        self.assertEqual(grade.seed_of_tests("007"), "7")
        for none in ("", None):
            self.assertEqual(grade.seed_of_tests(none), "")
        for bad in ("x", "-1", "1.5", str(1 << 63), "9" * 30, "\u0663"):
            with self.assertRaisesRegex(submission.BadInput, "^SEED is '"):
                grade.seed_of_tests(bad)


if __name__ == "__main__":
    unittest.main()
