"""Tests of the grader: what it makes of errors and crashes, and its reports."""

import contextlib
import io
import json
import pathlib
import re
import tempfile
import unittest
import unittest.mock
import zipfile

import diagnosis
import inbox
import judge
import once
import recognize
import report
import sandbox
import submission
import tasks
import years


class Inbox(unittest.TestCase):
    """Zips of learning platforms, and their sheets."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    @staticmethod
    def zipped(files):
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as out:
            for name, content in files.items():
                out.writestr(name, content)
        return packed.getvalue()

    def unpacked(self, files):
        """{path in DIR: content}, or what is said of the zip."""
        (self.folder / "all.zip").write_bytes(self.zipped(files))
        out = self.folder / f"out{len(list(self.folder.iterdir()))}"
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                inbox.unpack(str(self.folder / "all.zip"), str(out))
        except inbox.InboxError as error:
            return str(error)
        self.assertFalse((self.folder / "evil.hpp").exists())
        return {p.relative_to(out).as_posix(): p.read_text()
                for p in out.rglob("*") if p.is_file()}

    def test_moodle_and_canvas_are_unpacked(self):
        hw = self.zipped({"hw2/Graph.hpp": "g", "../../evil.hpp": "",
                          "a.png": ""})
        self.assertEqual(self.unpacked({
            "Ann Lee_101_assignsubmission_file_/hw2.zip": hw,
            "Bo_102_assignsubmission_file/Graph.hpp": "h"}),
            {"Ann Lee_101/hw2/Graph.hpp": "g", "Bo_102/Graph.hpp": "h"})
        one, two, three = (self.zipped({"Graph.hpp": c}) for c in "123")
        one = self.zipped({"old.hpp": "", "Graph.hpp": "1"})
        self.assertEqual(self.unpacked({
            "leeann_101_9001_hw2.zip": one,
            "leeann_LATE_101_9003_hw2-2.zip": three,
            "leeann_101_9002_hw2-1.zip": two,
            "bo_102_9004_hw2.zip": "", "cy_103_9_a.hpp": "c" * 11_000_000}),
            {"leeann_101/Graph.hpp": "3"})
        self.assertEqual(self.unpacked({
            "ann_1_2_Graph.hpp": "old", "ann_1_3_Graph-1.hpp": "new",
            "ann_1_4_mine.hpp": "kept"}),
            {"ann_1/Graph.hpp": "new", "ann_1/mine.hpp": "kept"})
        # What nobody can write or read is its student's loss alone.
        broken = bytearray(self.zipped({"a.hpp": "abc"}))
        broken[8] = broken[broken.index(b"PK\1\2") + 10] = 12    # bzip2
        self.assertEqual(self.unpacked({
            "ann_1_2_hw2.zip": bytes(broken), "bo_2_2_hw2.zip": self.zipped({
                "a.hpp": "", "a.hpp/b.hpp": ""}), f"cy_3_2_{'c' * 300}.hpp": "",
            f"{'d' * 300}_4_2_a.hpp": "", "ed_5_2_a.hpp": "e",
            "fay_6_2_hw2.zip": self.zipped({
                f"{n}.hpp": "" for n in range(1001)})}), {"ed_5/a.hpp": "e"})
        self.assertIn("named neither as by Moodle", self.unpacked({"x": ""}))

    def test_points_go_into_the_sheet(self):
        (self.folder / "class.csv").write_text(
            "\ufeffstudent,points\nZo\xeb M\xfcller_101,88\nleebo_7,7\n")
        sheet = self.folder / "sheet.csv"
        sheet.write_text("Identifier,Name,Grade\nParticipant 101,A 7,\n"
                         "Participant 103,C 7,5\n\n")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            inbox.marks(str(self.folder), str(sheet), "Grade")
        self.assertEqual(said.getvalue(), "Identifier,Name,Grade\n"
                         "Participant 101,A 7,88\nParticipant 103,C 7,5\n\n")
        with self.assertRaisesRegex(inbox.InboxError, "no column 'Points'"):
            inbox.marks(str(self.folder), str(sheet), "Points")


class Say(unittest.TestCase):
    def test_a_crash_is_told_in_a_line(self):
        lines = (once.TESTS / "graph.hpp").read_text().split("\n")
        guard = lines.index("#ifndef KIT_GRAPH_HPP") + 1
        segv = ("==7==ERROR: AddressSanitizer: SEGV on unknown address 0x0\n"
                "    #0 0x5 in f() {}:" + f"{guard}\n")
        fault = ("/usr/include/c++/12/bits/stl_vector.h:1123: T& std::vector<T>"
                 "::operator[](std::size_t): Assertion '__n < this->size()' "
                 "failed.\n")
        abort = """\
==7==ERROR: AddressSanitizer: ABRT on unknown address 0x7 (pc 0x5 bp 0x0)
    #0 0x55 in raise (/lib/libc.so.6+0x8)
    #1 0x56 in std::vector<int>::operator[](unsigned long) /usr/inc/x.h:3
    #2 0x57 in Graph<int>::remove_node(int) ./Graph.hpp:41
"""
        # On some machines AddressSanitizer does not know the signal.
        unknown = abort.replace("ABRT", "UNKNOWN SIGNAL").replace(
            " in raise ", " in __GI_abort ")
        for output, said in (
                ("./Graph.hpp:9:4: runtime error: load of 0x7f12 is bad\n",
                 "load of 0x... is bad at Graph.hpp:9"),
                ("unit1: Graph.hpp:8: int f(): Assertion `a < b' failed.\n",
                 "assertion failed: a < b at Graph.hpp:8"),
                (segv.format(once.TESTS / "graph.hpp"),
                 "AddressSanitizer: SEGV where the test says: "
                 "#ifndef KIT_GRAPH_HPP"),
                (segv.format(once.KIT / "judge.py"), "AddressSanitizer: SEGV"),
                (segv.format(f"{once.TESTS}/../kit/judge.py"),
                 "AddressSanitizer: SEGV"),
                *((fault + stack, "assertion failed: __n < this->size() at "
                   "Graph.hpp:41") for stack in (abort, unknown)),
                (unknown, "ended by abort() at Graph.hpp:41")):
            outcome = sandbox.Outcome(code=1, output=output, begun=True)
            self.assertEqual(diagnosis.crash(outcome, {"Graph.hpp"}), said)
        for code, said in ((-11, "ended by the signal SIGSEGV"),
                           (0, "the program ended before the test did")):
            outcome = sandbox.Outcome(code=code, begun=True)
            self.assertEqual(diagnosis.crash(outcome, {}), said)

    def test_a_submission_has_no_words_in_the_judges_mouth(self):
        moved, forged = "num_nodes() == 4", "all points for this student"
        flag = "makes a test of {task} say what it can't"
        for words, did, told in ((moved, "remove n0", ("remove n0", "")),
                                 (moved, "cheated", ("", "")),
                                 (forged, "", ("", flag))):
            got = judge.result_of("7.1.cost", sandbox.Outcome(
                code=1, begun=True, verdict=["failed", words, "5"], did=did),
                {}, None)
            self.assertEqual((got.did, got.doubtful), told)
            self.assertEqual(got.expected == words, not got.doubtful)

    def test_a_call_that_does_not_compile_is_told_in_the_compilers_words(self):
        output = """\
course/tests/7.1.b.cpp: In function 'void f()':
course/tests/7.1.b.cpp:3:1: error: 'class Graph' has no member named 'take'
"""
        self.assertEqual(diagnosis.first_error(output, {"Graph.hpp"}, "7.1.b"),
                         "'class Graph' has no member named 'take'")
        self.assertEqual(diagnosis.first_error(
            "Graph.hpp:5:7: error: 'z' was not declared\n" + output,
            {"Graph.hpp"}, "7.2.c"), "Graph.hpp:5: 'z' was not declared")
        self.assertEqual(diagnosis.first_error("", {}, "7.1.b"), "")
        self.assertEqual(diagnosis.compile_message("""\
unit1.cpp:2:1: error: expected '}' at end of input
In file included from course/tests/cloth.hpp:25:
Graph.hpp:5:7: note: to match this '{'
Graph.hpp:9:1: error: 'z' was not declared
""", {"Graph.hpp": b""}), "Graph.hpp:5: this '{' has no '}'")
        self.assertRegex(diagnosis.compile_message(
            "a.hpp:2:9: error: expected ')' before 'g'\n",
            {"a.hpp": b"struct Sum {\n  Sum<F>(F g);"}),
            r"since C\+\+20 a constructor is Sum\(...\), not Sum<F>\(...\)$")

    def test_answers_are_right_if_all_that_is_needed_is(self):
        expected: sandbox.Answers = {
            "x": (1e-9, [1, 1e6]), "K~": (0, [2]),
            "nodes by index?": (0, [3]), "nodes in a loop?": (0, [4])}
        def right(**change):
            answers: sandbox.Answers = {
                "x": (9e9, [1, 1e6]), "nodes in a loop?": (0, [4])}
            return judge.wrong({**answers, **change}, expected)
        self.assertIsNone(right())
        self.assertIsNone(right(x=(0, [1 + 1e-10, 1e6 + 1e-4]), more=(0, [1])))
        changes: tuple[dict, ...] = (
            {"x": (9, [1.1, 1e6])}, {"x": (9, [1])}, {"x": (9, [])},
            {"x": (9, [float("nan"), 1e6])}, {"K~": (0, [1])},
            {"nodes by index?": (0, [4])}, {"nodes in a loop?": (0, [5])})
        for wrong in changes:
            said = right(**wrong)
            assert said
            self.assertIn(f"of: {[*wrong][0].rstrip('?~')}", said[0])
        self.assertEqual(right(x=(9, [1.25, 1e6])), (
            "the solution's 2 numbers of: x, 1 as number 1", "1.25"))
        self.assertEqual(judge.wrong({"x": (0, [1, 1e6])}, expected),
                         ("answers of: nodes", "none"))
        self.assertEqual(judge.wrong({"nodes by index?": (0, [3])}, expected),
                         ("the solution's 2 numbers of: x", "0"))

    def test_the_starter_of_a_submission(self):
        """Its line says it, or what was asked for, or the names that it uses;
        a task has the points of then, or is shown and not counted."""
        course = tasks.load()
        old = "struct Node { Real mass; };"
        for text, line, asked, version in (
                ("", "", "", ""), ("", course.starter, "2026-11-25", ""),
                ("", "2026-11-27", "", "2026-11-27"),
                (old, "", "", "2026-11-25"),
                (old, "", "2026-11-27", "2026-11-27"),
                (old, "2026-11-27", "2026-11-25", "2026-11-27"),
                ("using Real = float;" + old, "", "", ""),
                ("// Real\n", "", "", "")):
            taken = submission.Submission({"a.hpp": text.encode()},
                                          starter=line)
            year = years.begun_with(taken, course, asked)
            self.assertEqual(year.version if year else "", version, text)
            self.assertEqual(taken.notes, [
                f"begun with the starter of {version}"] * bool(version))
        for line, asked in ("1999", ""), ("", "../x"):
            with self.assertRaisesRegex(submission.BadInput,
                                        "does not know: .*2026-11-25"):
                years.begun_with(submission.Submission({}, starter=line),
                                 course, asked)
        then = years.years()["2026-11-25"].course(course)
        self.assertEqual(then.points, 100)
        self.assertEqual(then.tasks["5.1.DampingForce"].points, 3)
        self.assertTrue(then.tasks["5.1.ZeroForce"].extra)
        # Each that was handed out is here, and today's last.
        self.assertEqual(max(years.years()), course.starter)


class Recognize(unittest.TestCase):
    def test_numbers_name_a_mistake_or_nothing(self):
        right = {"force": [1.0, 2.0, -3.0, 0.5, 4.0, -6.0], "mass": [0.2, 0.2]}

        def times(factor):
            return [factor * x for x in right["force"]]

        def said(**change):
            usual = right | change
            return recognize.recognized("t", recognize.mark(("f",), usual),
                                        usual, right)
        thrice = recognize.mark(("f",), right | {"force": times(3)})
        with unittest.mock.patch("recognize.known",
                                 lambda: {"t": {"thrice": thrice}}):
            self.assertEqual(said(force=times(3 + 1e-12)),
                             [recognize.KNOWN, "thrice"])
            self.assertEqual(said(force=times(9.8 / 9.81))[2:],
                             ["0.998981", ": 9.8 for 9.81"])
            self.assertIn("is 0: is 1 / N", said(mass=[0.0, 0.0])[0])
            self.assertEqual(said(force=[1, 2, 0, 0.5, 4, 0])[1:],
                             ["z", "force"])
            for change in ({"force": [*right["force"][:5], -6.1]},
                           {"force": times(2), "mass": [1.0, 1.0]},
                           {"force": times(0)}):
                self.assertEqual(said(**change), [])


class Reports(unittest.TestCase):
    def setUp(self):
        course = tasks.load()
        graded = [report.Graded(task, judge.Result("passed"))
                  for task in course.tasks.values()]
        graded[4].result = judge.Result(
            "failed", "", 'a < b && "c"', "<&>", "did ]]> it", "f",
            recognized=["Each {} is {} times the right one{}.", "x", "2", ""])
        self.lost = graded[4].task
        self.report = report.Report(course, "x", graded, ["a note"],
                                    [("Graph.hpp", 3, "writes assembler")])

    def test_text(self):
        text = report.as_text(self.report)
        self.assertIn(f'{self.lost.section.id} {self.lost.title} '
                      f'0/{self.lost.points}.\n  Specification: '
                      f'"{self.lost.says}"\n  Did: did ]]> it.\n  Expected '
                      f'a < b && "c", got <&>.\n  Each x is 2 times the '
                      'right one.\n', text)
        self.assertIn("\nLook at this by hand:\n  Graph.hpp:3: writes", text)

    def test_another_language_and_other_numbers(self):
        text = (tasks.ROOT / tasks.FILE).read_text(encoding="utf-8")
        made = self.report
        made.course = course = tasks.parse('language = "de"\n' + text.replace(
            '[section."3.1"]', '[section."3.1"]\nnumber = "2"'))
        for one in made.graded:
            one.task = course.tasks[one.task.id]
        made.graded[4].result = judge.Result(
            "failed", "", "the positions of all other nodes stay", "",
            "a node of mass 2 kg without edges",
            recognized=[recognize.KNOWN, "each spring counted twice"])
        said = report.as_text(made)
        self.assertIn("\n2 position() 0/4.\n  Vorgabe: ", said)
        self.assertIn("\n  Versuch: ein Knoten der Masse 2 kg ohne Kanten.\n"
                      "  Erwartet: alle anderen Knoten bleiben an ihrem Ort.\n"
                      "  Das sind die Antworten eines bekannten Fehlers: each",
                      said)
        self.assertIn('"number": "2.position"', report.as_gradescope(made))
        for english in "{}".join(course.words).split("{}"):
            if len(english.strip(" .:")) > 3:
                self.assertNotRegex(said, rf"\b{re.escape(english.strip())}")

    def test_what_is_doubtful_is_flagged_once(self):
        results = {test: judge.Result("passed") for task
                   in self.report.course.tasks.values() for test in task.tests}
        for test in ("5.1.GravityForce", "5.1.DampingForce", "7.1.cost"):
            results[test] = judge.Result("failed", doubtful="is odd")
        results["3.1.position"] = judge.Result("failed",
                                               doubtful="forges {task}")
        combined = report.combine(self.report.course, "x",
                                  submission.Submission({}), results)
        self.assertEqual(combined.flags, [
            ("Graph.hpp", 1, "forges 3.1.position"),
            ("mass_spring.hpp", 1, "is odd"), ("Graph.hpp", 1, "is odd")])

    def test_students_see_as_much_as_the_teacher_says(self):
        names = report.as_text(self.report, "names")
        self.assertIn(f"0/{self.lost.points}\n", names)
        self.assertTrue(names.endswith(f"/{self.report.of}\n"))
        self.assertNotIn("Specification", names)
        self.assertEqual(report.as_text(self.report, "none").split("\n", 2)[2],
                         f"{report.RECEIVED}\n")
        for feedback, outputs, seen in (
                ("all", 2, {"visible", "hidden"}),      # hidden: the flags
                ("names", 1, {"visible", "hidden"}), ("none", 2, {"hidden"})):
            data = json.loads(report.as_gradescope(self.report, feedback))
            self.check_gradescope(data)
            self.assertEqual({test["visibility"] for test in data["tests"]},
                             seen)
            self.assertEqual(sum(test["output"] != "" for test
                                 in data["tests"]), outputs)
        self.assertEqual(data["output"], report.RECEIVED)
        self.check_gradescope(json.loads(report.refused("no")))

    def check_gradescope(self, data):
        """As Gradescope's page "Autograder Specifications" has it."""
        self.assertLessEqual(data.keys(), {
            "score", "execution_time", "output", "output_format",
            "test_output_format", "test_name_format", "visibility",
            "stdout_visibility", "extra_data", "tests", "leaderboard"})
        for test in data["tests"]:
            self.assertLessEqual(test.keys(), {
                "score", "max_score", "status", "name", "name_format",
                "number", "output", "output_format", "tags", "visibility",
                "extra_data"})
            self.assertIn(test["status"], {"passed", "failed"})
            self.assertLessEqual(test["score"], test["max_score"])
        for one in (data, *data["tests"]):
            self.assertLessEqual({one["visibility"]}, {"hidden", "visible"})
            self.assertEqual(one["output_format"], "text")
            self.assertIsInstance(one["score"], float)
        self.assertEqual(data["score"], sum(t["score"] for t in data["tests"]))


if __name__ == "__main__":
    unittest.main()
