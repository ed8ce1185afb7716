"""Tests of SEED: the tests' numbers with one, and what it is good for.

A minute of processor time: it compiles.
"""

import copy
import pathlib
import shutil
import tempfile
import unittest

import class_output
import grade
import judge
import kit_check
import once
import seeds
import submission

FEW = (1, 2, 1 << 62)
PUBLIC = ""


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

    def lost(self, kits, files, tests):
        """{seed: the tests that fail}, of their own: no question is compared.
        """
        results = seeds.grade_with(kits, files, tests)
        return {seed: {test for test in tests if not found[test].passed}
                for seed, found in results.items()}

    def test_tables_of_the_public_numbers_lose_by_a_seed_alone(self):
        kits: seeds.Kits = {
            PUBLIC: copy.copy(self.kit),
            **seeds.kits_of(self.kit, FEW, self.top)}
        kits[PUBLIC].data = once.TESTS / "data"
        kits[PUBLIC].secret = bytes(32)
        wrong = list(self.cases.wrong("tables"))
        self.assertEqual(len(wrong), 2)
        tests = {test: needs for test, needs in self.tests.items()
                 if test in wrong[0].lost | wrong[1].lost}
        for case in wrong:
            self.assertEqual(self.lost(kits, case.files, tests), {
                PUBLIC: set(), **{seed: set(case.lost) for seed in FEW}})
        self.assertEqual(self.lost(kits, self.cases.solution, self.tests),
                         {seed: set() for seed in kits})

    def test_a_seed_draws_the_same_cloth_again(self):
        def drawn(seed, name):
            kit = copy.copy(self.kit)
            kit.seed, kit.secret = seed, name.encode()
            judge.draw_cloth(self.top / name, kit)
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
            self.assertIn(lines[-1], judge.CORNERS)
            self.assertTrue(set(judge.CORNERS) <= set(lines))
            # No quad joins the cloth and the quad apart, whose z is 0.3.
            for quad in quads.splitlines():
                self.assertEqual(len({lines[int(i)].split()[2]
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
