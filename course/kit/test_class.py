"""Tests of make class: a class of clones, graded, ended and graded on.

Two minutes of processor time: it compiles.
"""

import csv
import datetime
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

import child
import dates
import once
import ranking
import submission
import synthetic

GRADES = 600    # seconds


def at(text):
    return datetime.datetime.fromisoformat(text)


class Dates(unittest.TestCase):
    def late(self, due, *moments):
        return [dates.days_late(at(moment), dates.deadline(due))
                for moment in moments]

    def test_to_the_second_in_any_zone(self):
        self.assertEqual(self.late(
            "2026-02-14 16:30 -0800",
            "2026-02-14T16:30:00-08:00", "2026-02-15T00:30:00+00:00",
            "2026-02-15T00:30:01+00:00", "2026-02-15T06:15:01+05:45",
            "2026-02-15T16:30:00-08:00", "2026-02-15T16:30:01-08:00",
            "2026-02-15T14:30:00+14:00"), [0, 0, 1, 1, 1, 2, 0])

    def test_over_summer_time(self):
        # At 02:00 on March 8 clocks go on to 03:00; on November 1 back to 1:00.
        self.assertEqual(self.late(
            "2026-03-07 12:00 America/Los_Angeles",
            "2026-03-07T20:00:00+00:00", "2026-03-07T20:00:01+00:00",
            "2026-03-08T19:00:00+00:00", "2026-03-08T19:00:01+00:00",
            "2026-03-09T19:00:01+00:00"), [0, 1, 1, 2, 3])
        self.assertEqual(self.late(
            "2026-10-31 12:00 America/Los_Angeles",
            "2026-10-31T19:00:00+00:00", "2026-11-01T20:00:00+00:00",
            "2026-11-01T20:00:01+00:00"), [0, 1, 2])
        # An offset has no summer time.
        self.assertEqual(self.late(
            "2026-03-07 12:00 -0800", "2026-03-08T20:00:00+00:00"), [1])

    def test_bad_deadlines(self):
        for text, why in (
                ("2026-02-14 16:30", "expected a date, a time and a zone"),
                ("2026-02-30 16:30 -0800", "no time of a calendar"),
                ("2026-02-14 16:30 -9900", "no time of a calendar"),
                ("2026-02-14 16:30 Moon/Crater", "knows no such zone"),
                ("2026-03-08 02:30 America/Los_Angeles", "leaves out"),
                ("2026-11-01 01:30 America/Los_Angeles", "comes twice")):
            with self.assertRaisesRegex(submission.BadInput, why):
                dates.deadline(text)

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


class Ranks(unittest.TestCase):
    def test_ranks_by_the_share_of_symplectic_eulers_error(self):
        expected = {"first": (0.5, [1.0, 2.0]), "second": (0.05, [3.0])}
        for forces, shown in ((1599.96, 1600), (float("nan"), 0)):
            self.assertEqual(ranking.measured(
                {"first": (0, [1.0, 1.9]), "second": (0, [3.02]),
                 "forces": (0, [forces])}, expected), (0.2, shown))
        self.assertEqual(
            list(ranking.ranks({"d": (0.2, 3), "a": (0.1, 4), "c": (0.3, 5),
                                "b": (0.2, 6)}).items()),
            [("a", (1, 0.1, 4)), ("b", (2, 0.2, 6)), ("d", (2, 0.2, 3)),
             ("c", (4, 0.3, 5))])


class Whole(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        self.addCleanup(shutil.rmtree, self.top)

    def words(self, **more):
        return {"PATH": os.environ["PATH"], "DIR": str(self.top / "clones"),
                "OUT": str(self.top / "grades"), "HW": "hw2",
                "DUE": synthetic.DUE, **more}

    def run_class(self, status=0, **more):
        done = child.run(
            [sys.executable, once.KIT / "whole_class.py"], GRADES, text=True,
            capture_output=True, env=self.words(**more), cwd=once.ROOT)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def ended(self, **more):
        """A run that is killed when it has graded one content."""
        with subprocess.Popen(
                [sys.executable, once.KIT / "whole_class.py"], text=True,
                stdout=subprocess.PIPE, env=self.words(**more), cwd=once.ROOT,
                start_new_session=True) as run:
            assert run.stdout
            said = run.stdout.readline()
            os.killpg(run.pid, signal.SIGKILL)
        self.assertRegex(said, r"^1/\d ")
        return int(said[2])

    def files(self, out):
        """What a class leaves, by name."""
        shown = [out / "class.csv", out / "class.html",
                 *(out / "reports").iterdir(), *(out / "jplag").rglob("*.hpp")]
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
        self.one_task()

    def hold_rows(self, rows):
        self.assertEqual(
            [(row["points"], row["days late"]) for row in rows],
            [("100", "0"), ("29", "0"), ("100", "1"), ("", "0"), ("100", "1"),
             ("0", "0"), ("32", "0"), ("", ""), ("32", "2"), ("0", "0"),
             ("100", "0"), ("", "0"), ("100", "0"), ("29", "0")])
        self.assertEqual(rows[1]["7.1.remove_node_iterator"], "0")
        self.assertEqual(rows[4]["time"], "2026-03-09 01:29:59-07:00")
        self.assertEqual(rows[4]["tagged"], "2026-03-09 14:14:59+05:45")
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
                         "^its tag was on [0-9a-f]{10} when it was seen first$")
        self.assertEqual(row["days late"], "268")
        text = (self.top / "grades/reports/student001.txt").read_text()
        self.assertRegex(text, r"remove_node\(iterator\) +0/3\n")
        self.assertNotIn("Specification", text)

    def one_task(self):
        """TASK grades anew what another kit said of this task alone."""
        kept = self.top / "grades/kept"
        for path in kept.glob("?" * 32 + ".json"):
            results = json.loads(path.read_text())
            for result in results.values():
                result.update(kit="older", status="passed")
            path.write_text(json.dumps(results))
        self.run_class(TASK="7.1.remove_edge")
        rows = list(csv.DictReader(
            (self.top / "grades/class.csv").read_text().splitlines()))
        self.assertEqual([row["points"] for row in rows][5:10],
                         ["94", "100", "", "100", "94"])

    def test_bad_input(self):
        clones = self.top / "clones"
        self.assertIn("No such file", self.run_class(2))
        clones.mkdir()
        self.assertIn("holds no folder of a student", self.run_class(2))
        (clones / "a").mkdir()
        for out in ("clones", "clones/a/grades", "."):
            self.assertIn("lie in each other",
                          self.run_class(2, OUT=str(self.top / out)))
        self.assertIn("TASK is '9.9'", self.run_class(2, TASK="9.9"))
        self.assertIn("DUE needs HW", self.run_class(2, HW=""))
        self.assertIn("FEEDBACK is 'x'", self.run_class(2, FEEDBACK="x"))
        (self.top / "grades").mkdir()
        (self.top / "grades/mine").touch()
        self.assertIn("other files than grades", self.run_class(2))


if __name__ == "__main__":
    unittest.main()
