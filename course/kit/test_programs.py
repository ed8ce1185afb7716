"""Tests of the grader's programs, run as make runs them: whole gradings, the
same bytes twice and as Gradescope does it; tests that students write; a class
of clones, graded, ended and graded on.

Four minutes of processor time: they compile.
"""

import csv
import datetime
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import zipfile

import autograder
import child
import dates
import grade_tests
import judge
import markers
import once
import starter
import submission
import synthetic
import tasks

LIMIT = 600     # seconds: they compile
# A graph that crashes in some ways whose texts hold addresses or lines.
FAULTS = [
    ("    remove_edge(*it);\n    return it;",
     "    struct Down {\n"
     "      static int go(volatile int* p) { return *p + go(p) + *p; }\n"
     "    };\n"
     "    volatile int zero = 0;\n"
     "    return Down::go(&zero) ? it : edge_end();"),
    ("    remove_node(*it);\n    return it;",
     "    int* gone = new int(1);\n"
     "    delete gone;\n"
     "    return *gone ? it : node_end();"),
]


TESTS = """#include "own.hpp"
TASK("5.1.GravityForce", weight) {
  kit::Bodies b;
  b.add(Point(0.5, 0.5, 0.5), 2);
  kit::Cloth g;
  kit::fill(g, b);
  kit::with<KIT_FORCE(GravityForce)>("GravityForce", [&]<typename F>() {
    F gravity;
    CHECK_NEAR(kit::force_on(gravity, g, 0), Point(0, 0, 2 * -9.81), 1e-9);
  });
}
TASK("5.1.GravityForce", empty) {}
TASK("5.1.DampingForce", idle) {
  Cloth g;
  PinConstraint pin(g);  // as on the pages; a right submission has another form
  CHECK(true);
}
TASK("5.1.GravityForce", always_fails) { CHECK(false, "pigs to fly"); }
"""


class Programs(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        self.addCleanup(shutil.rmtree, self.top)

    def run_kit(self, program, where=once.ROOT, status=0, **variables):
        """What a program of the kit says and complains of."""
        done = child.run(
            [sys.executable, once.KIT / program], LIMIT, cwd=where, text=True,
            capture_output=True, env={"PATH": os.environ["PATH"], **{
                key: str(value) for key, value in variables.items()}})
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout, done.stderr


class Grading(Programs):
    def setUp(self):
        super().setUp()
        text = markers.solution((once.ROOT / "Graph.hpp").read_text("utf-8"))
        for old, new in FAULTS:
            self.assertEqual(text.count(old), 1)
            text = text.replace(old, new)
        self.submission = self.top / "submission"
        self.submission.mkdir()
        (self.submission / "Graph.hpp").write_text(text, encoding="utf-8")

    def grade(self, folder, where):
        """The text and the two files."""
        files = [self.top / name for name in ("json", "results")]
        said, complaint = self.run_kit(
            "grade.py", where, DIR=folder,
            **{file.name.upper(): file for file in files})
        self.assertEqual(complaint, "")
        return [said, *(file.read_text("utf-8") for file in files)]

    def test_same_bytes_here_and_in_the_autograder(self):
        first = self.grade(self.submission, "/")
        second = self.grade("submission", self.top)
        self.assertEqual(first, second)
        self.hold(first)
        self.assertEqual(first[2], self.at_gradescope())

    def test_nothing_is_graded_where_the_solution_fails(self):
        def judged(*_):
            return {"a": judge.Result("passed"),
                    "b": judge.Result("failed", "", "1", "2")}
        kit = once.Kit()
        with unittest.mock.patch("judge.judge", judged):
            for _ in range(2):      # and it is not kept
                with self.assertRaisesRegex(once.KitError, (
                        r"^nothing is graded: this system is .*g\+\+.* "
                        r"otherwise in b, failed: expected 1, got 2\n")):
                    judge.prepare(kit, {"a": "graph", "b": "graph"}, 1)

    def hold(self, texts):
        text, data = texts[0], json.loads(texts[1])
        self.assertRegex(text, "7.1 remove_node\\(iterator\\) 0/3\\.\n(.*\n)+?"
                         "  Crashed: AddressSanitizer: heap-use-after-free, "
                         r"READ of size 4 at Graph\.hpp:\d+\.")
        self.assertRegex(text, "7.1 remove_edge\\(iterator\\) 0/3\\.\n(.*\n)+?"
                         "  Crashed: AddressSanitizer: stack-overflow at "
                         r"Graph\.hpp:\d+\.")
        self.assertIn("there is no mass_spring.hpp", text)
        of_graph = {task["id"]: task["status"] for task in data["tasks"]
                    if task["status"] != "missing"}
        self.assertEqual([id for id, how in of_graph.items()
                          if how != "passed"],
                         ["7.1.remove_node_iterator",
                          "7.1.remove_edge_iterator"])
        for word in ("0x", "/tmp", "unit1", "kit-grade"):
            self.assertNotIn(word, "".join(texts))

    def at_gradescope(self):
        """results.json of the zip, unpacked as Gradescope does."""
        root = self.top / "autograder"
        archive = self.top / "autograder.zip"
        digests = set()
        for _ in range(2):
            autograder.write(archive)
            digests.add(hashlib.sha256(archive.read_bytes()).hexdigest())
        self.assertEqual(len(digests), 1)
        with zipfile.ZipFile(archive) as content:
            content.extractall(root / "source")
            for info in content.infolist():
                os.chmod(root / "source" / info.filename,
                         info.external_attr >> 16 & 0o777)
        shutil.copytree(self.submission, root / "submission")
        (root / "results").mkdir()
        # Files that only their owner may read, below a folder that only he may
        # enter; and a build/ that was copied from elsewhere.
        self.top.chmod(0o700)
        shutil.copy(root / "source/run_autograder", root)
        old = root / "source/build/kit/include/CME212"
        old.parent.mkdir(parents=True)
        old.symlink_to("/nowhere/CME212")
        for command in ([root / "source/setup.sh", root],
                        [root / "run_autograder", root]):
            done = child.run(command, LIMIT, capture_output=True, text=True,
                             umask=0o077)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        hidden = root / "source/course/tests/3.1.position.cpp"
        self.assertEqual(hidden.stat().st_mode & 0o077, 0)
        return (root / "results/results.json").read_text("utf-8")


class Runner(Programs):
    """make test, of the graph of the level open, and the cloth solved."""
    def setUp(self):
        super().setUp()
        self.mine = self.top / "mine"
        starter.write(starter.tree("solution"), self.mine)
        self.graph = markers.solution(markers.open_graph(tasks.load()))

    def make_test(self, what, file, text, *edits):
        for old, new in edits:
            self.assertEqual(text.count(old), 1)
            text = text.replace(old, new)
        (self.mine / file).write_text(text, encoding="utf-8")
        return child.run(["make", "test", what, "VIEWER=0"], LIMIT,
                         cwd=self.mine, capture_output=True, text=True)

    def test_looks_away_as_the_grader_does(self):
        """A graph that may not be asked for a removed edge; and the test that
        the page on own tests shows."""
        page = (once.ROOT / "course/own-tests.md").read_text(encoding="utf-8")
        (self.mine / "tests/7.1.mine.cpp").write_text(
            page.split("```cpp\n")[1].split("```")[0], encoding="utf-8")
        done = self.make_test("SECTION=7.1", "Graph.hpp", self.graph, (
            "edge(const Edge& e) {",
            "edge(const Edge& e) { assert(e.index_ < num_edges());"), (
            "    remove_node(*it);\n", "    assert(!remove_node(*it));\n"))
        self.assertRegex(done.stdout, r"remove_node\(node\): passed  8/8\n")
        self.assertRegex(done.stdout, r"remove_edge\(edge\): passed  6/6\n")
        self.assertRegex(done.stdout, r"remove_node\(iterator\): FAILED  0/3"
                         r"(\n  .*)*\n  It crashed at Graph\.hpp:\d+; ")


class OwnTests(Programs):
    def grade(self, text, status=0):
        file, result = self.top / "own.cpp", self.top / "result.json"
        if text is not None:
            file.write_text(text, encoding="utf-8")
        _, complaint = self.run_kit("grade_tests.py", status=status,
                                    FILE=file, JSON=result)
        return complaint if status else json.loads(result.read_text())

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
        self.assertFalse(any(found["cloth: the acceleration given is ignored"]
                             .values()))

    def test_a_test_may_hold_a_page_to_its_words(self):
        right, _ = grade_tests.cases(
            grade_tests.Tests("", "cloth", [], set(), []))
        names = [case.name for case in right]
        self.assertIn("graph: remove_node looks at every edge of the graph, "
                      "which is allowed", names)
        self.assertFalse([name for name in names if ": allowed: " in name])

    def test_bad_input(self):
        for text, why in ((None, "No such file"), ("", "has no test"),
                          ('// TASK("5.1.GravityForce", a) {}', "has no test"),
                          ('TASK("9.f", a) {}', "there is no task 9.f"),
                          ('TASK("7.1.cost", a) {} TASK("7.1.cost", a) {}',
                           "two tests have the same name")):
            self.assertIn(why, self.grade(text, 2))


def at(text):
    return datetime.datetime.fromisoformat(text)


class Dates(unittest.TestCase):
    def test_times_of_a_host(self):
        file, commit = self.enterContext(tempfile.NamedTemporaryFile("w")), "a1"
        for text, why in (("x", ":1: expected a commit"), (
                f"{commit * 20} 2026-03-08T08:12:00", ":1: expected a commit")):
            pathlib.Path(file.name).write_text(text)
            with self.assertRaisesRegex(submission.BadInput, why):
                dates.times(file.name)
        pathlib.Path(file.name).write_text(
            f"{commit * 20} 2026-03-08T08:12:00Z\n"
            f"{commit * 20} 2026-03-08T08:10:00+00:00\n")
        pushed = dates.times(file.name)[commit * 20]
        self.assertEqual(pushed, at("2026-03-08T08:10:00Z"))
        self.assertEqual(dates.Made(tagged=at("2026-01-01T00:00:00Z"),
                                    pushed=pushed).time, pushed)
        self.assertEqual(dates.times(""), {})

    def test_dates_that_git_may_hold(self):
        def date(person):
            return dates.date_of(f"tree 1\n{person}\n\ncommitter x <> 5 +0000"
                                 .encode())
        self.assertEqual(date("committer A <a@b> 0 -0130"),
                         at("1969-12-31T22:30:00-01:30"))
        self.assertEqual(date("tagger > <> 7 +0000"),
                         at("1970-01-01T00:00:07+00:00"))
        for odd in ("", "committer A <a> 99999999999999 +0000", "committer <>",
                    "committer A <a> 5 +9999", "author A <a> 5 +0000"):
            self.assertIsNone(date(odd))


class Whole(Programs):
    def words(self, **more):
        return {"DIR": str(self.top / "clones"),
                "OUT": str(self.top / "grades"),
                "HW": "hw2", "DUE": synthetic.DUE, **more}

    def run_class(self, status=0, **more):
        return "".join(self.run_kit("whole_class.py", status=status,
                                    **self.words(**more)))

    def ended(self, **more):
        """A run that is killed when it has graded one content."""
        with subprocess.Popen(
                [sys.executable, once.KIT / "whole_class.py"], text=True,
                stdout=subprocess.PIPE, cwd=once.ROOT, start_new_session=True,
                env={"PATH": os.environ["PATH"], **self.words(**more)}) as run:
            assert run.stdout
            said = run.stdout.readline()
            os.killpg(run.pid, signal.SIGKILL)
        self.assertRegex(said, r"^1/\d ")
        return int(said[2])

    def files(self, out):
        """What a class leaves, by name."""
        shown = [out / "class.csv", out / "class.html",
                 *(out / "reports").iterdir()]
        self.assertEqual(list(out.rglob(".new-*")), [])
        return {path.relative_to(out): path.read_text("utf-8")
                for path in shown}

    def test_a_class(self):
        synthetic.make(self.top / "clones", 14)
        left = self.ended(OUT=str(self.top / "two"))
        self.assertEqual(self.ended(OUT=str(self.top / "two")), left - 1)
        said = self.run_class(OUT=str(self.top / "two"))
        of = re.match(r"1/(\d)", said)
        assert of
        self.assertEqual(int(of[1]), left - 2)
        second = self.files(self.top / "two")
        self.assertRegex(self.run_class(), rf"(?m)^1/{left} ")
        self.assertEqual(self.files(self.top / "grades"), second)
        self.assertFalse(os.path.lexists(synthetic.TOUCH))
        self.hold_rows(list(csv.DictReader(
            second[pathlib.Path("class.csv")].splitlines())))
        self.hold_page(second[pathlib.Path("class.html")])
        self.move_a_tag()

    def hold_rows(self, rows):
        self.assertEqual(
            [(row["points"], row["days late"]) for row in rows],
            [("100", "0"), ("29", "0"), ("100", "1"), ("", "0"), ("100", "1"),
             ("0", "0"), ("32", "0"), ("", ""), ("32", "2"), ("0", "0"),
             ("100", "0"), ("", "0"), ("100", "0"), ("29", "0")])
        self.assertEqual(rows[1]["7.1.remove_node_iterator"], "0")
        self.assertEqual(rows[4]["time"], "2026-03-09 01:29:59-08:00")
        self.assertEqual(rows[4]["tagged"], "2026-03-09 15:14:59+05:45")
        self.assertEqual(rows[4]["committed"], "2026-03-08 12:45:00+05:45")
        self.assertEqual((rows[2]["tagged"], rows[2]["kind of tag"]),
                         ("", "lightweight"))
        self.assertEqual([row["note"] for row in rows if not row["points"]],
                         ["holds no Graph.hpp", "has no tag hw2; tags: none",
                          "Graph.hpp is a symbolic link"])
        self.assertIn("its tag is older than its commit", rows[9]["note"])
        self.assertIn("lines to look at by hand", rows[6]["note"])

        self.assertEqual([row["8.my_step rank"] for row in rows], [
            "1", "", "1", "", "1", "", "", "", "6", "", "1", "", "1", ""])
        self.assertEqual(rows[8]["8.my_step forces"], "1600")
        self.assertLess(3 * float(rows[0]["8.my_step error"]),
                        float(rows[8]["8.my_step error"]))

    def hold_page(self, page):
        self.assertNotRegex(page, r"https?:|src=|@import|url\(|<script")
        self.assertIn("14 submissions: 11 graded, 3 that can't be", page)
        self.assertIn("student003: holds no Graph.hpp", page)
        before, ranks = page.split("<h2>A better step: ranks</h2>")
        self.assertNotIn("student000", before)
        self.assertRegex(ranks, r"<td>6</td><td>student008</td><td>0\.\d+</td>"
                         "<td>1600</td></tr>\n</table>")

    def move_a_tag(self):
        clone = self.top / "clones/student000"
        commit = child.run(
            ["git", "-C", clone, "-c", "user.name=a", "-c", "user.email=b",
             "commit-tree", "-p", "hw2^{commit}", "-m", "x", "hw2^{tree}"],
            check=True, capture_output=True, text=True, env=os.environ | {
                "GIT_COMMITTER_DATE": "2026-12-01T00:00:00Z"}).stdout.strip()
        child.run(["git", "-C", clone, "tag", "-f", "hw2", commit], check=True,
                  capture_output=True)
        self.run_class(FEEDBACK="names")
        row = next(csv.DictReader(
            (self.top / "grades/class.csv").read_text().splitlines()))
        self.assertRegex(row["note"],
                         "^its tag was on [0-9a-f]{10} when it was seen first; "
                         "the same files as student002")
        self.assertEqual(row["days late"], "268")
        text = (self.top / "grades/reports/student001.txt").read_text()
        self.assertRegex(text, r"remove_node\(iterator\) +0/3\n")
        self.assertNotIn("Specification", text)

    def test_bad_input(self):
        clones = self.top / "clones"
        self.assertIn("No such file", self.run_class(2))
        clones.mkdir()
        self.assertIn("holds no folder of a student", self.run_class(2))
        (clones / "a").mkdir()
        for out in ("clones", "clones/a/grades", "."):
            self.assertIn("lie in each other",
                          self.run_class(2, OUT=str(self.top / out)))
        self.assertIn("DUE needs HW", self.run_class(2, HW=""))
        self.assertIn("FEEDBACK is 'x'", self.run_class(2, FEEDBACK="x"))
        (self.top / "grades").mkdir()
        (self.top / "grades/mine").touch()
        self.assertIn("other files than grades", self.run_class(2))


if __name__ == "__main__":
    unittest.main()
