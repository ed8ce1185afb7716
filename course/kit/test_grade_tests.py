"""Tests of make grade-tests: what a student's tests find of what is wrong.

Half a minute of processor time: they compile.
"""

import json
import os
import pathlib
import sys
import tempfile
import unittest

import child
import once

GRADES = 600    # seconds
TESTS = """#include "cloth.hpp"
TASK("5.1.GravityForce", weight) {
  kit::Bodies b;
  b.add(Point(0.5, 0.5, 0.5), 2);
  kit::Cloth g;
  kit::fill(g, b);
  kit::with<KIT_FORCE(GravityForce)>("GravityForce", [&]<typename F>() {
    F gravity;
    CHECK_NEAR(kit::force_on(gravity, g, 0), Point(0, 0, -19.62), 1e-9);
  });
}
TASK("5.1.GravityForce", empty) {}
TASK("5.1.DampingForce", idle) { CHECK(true, "nothing"); }
TASK("5.1.GravityForce", always_fails) { CHECK(false, "pigs to fly"); }
"""


class OwnTests(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def grade(self, text, status=0):
        file, result = self.folder / "own.cpp", self.folder / "result.json"
        if text is not None:
            file.write_text(text, encoding="utf-8")
        done = child.run(
            [sys.executable, once.KIT / "grade_tests.py"], GRADES, text=True,
            capture_output=True, env={"PATH": os.environ["PATH"],
                                      "FILE": str(file), "JSON": str(result)})
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr if status else json.loads(result.read_text())

    def test_what_is_found(self):
        result = self.grade(TESTS)
        self.assertEqual(set(result["not counted"]), {"empty", "always_fails"})
        self.assertIn("pigs to fly", result["not counted"]["always_fails"])
        found = result["matrix"]
        self.assertEqual((result["found"], result["of"]), (2, len(found)))
        self.assertGreaterEqual(result["right"], 3)
        for name in ("without 5.1.GravityForce",
                     "cloth: acceleration in place of weight"):
            self.assertEqual(found[name], {
                "weight": True, "empty": False, "idle": False,
                "always_fails": False})
        self.assertFalse(any(found["cloth: a force that is no ZeroForce"]
                             .values()))

    def test_bad_input(self):
        for text, why in ((None, "No such file"), ("", "has no test"),
                          ('// TASK("5.1.GravityForce", a) {}', "has no test"),
                          ('TASK("9.f", a) {}', "there is no task 9.f"),
                          ('TASK("7.1.cost", a) {} TASK("7.1.cost", a) {}',
                           "two tests have the same name")):
            self.assertIn(why, self.grade(text, 2))


if __name__ == "__main__":
    unittest.main()
