"""Tests of what makes pages and starters: tasks.py, markers.py, pages.py and
starter.py, on small texts and on this repository:
python3 course/kit/test_markers.py"""
import dataclasses
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest
import unittest.mock

import child
import constants
import markers
import pages
import starter
import submission
import tasks

TASKS = """title = "A course"
tag = "hw9"
[section."3.1"]
title = "First"
needs = "graph"
page = "3.1.md"
[section."7.1"]
title = "Last"
needs = "cloth"
[task."3.1.f"]
title = "f"
points = 4
says = "f() is 1."
hints = ["Return 1."]
[task."7.1.g"]
title = "g"
points = 1
says = "g(x) is \\"x\\"."
hints = ["Is a < b?", "A backslash: \\\\."]
tests = ["7.1.g", "7.1.g_more"]
"""
SOURCE = """struct S {
  // BEGIN SOLUTION 3.1.f
  int f() { return 1; }
  // STUB int f() {
  // STUB   return 0;
  // STUB }
  // END SOLUTION

  int g(int x) {
    // BEGIN SOLUTION 7.1.g
    return h(x);
    // STUB (void)x;
    // STUB return 0;
    // END SOLUTION
  }
  // BEGIN SOLUTION 7.1.g
  int h(int x) { return x; }
  // END SOLUTION
};
"""
PAGE = "# 3.1\n<!-- tasks 3.1 -->\nend\n"
FILLED = """# 3.1
- **f**, 4 points: f() is 1.

Together 4 points. `make test SECTION=3.1` shows which tests pass; `make hint
TASK=3.1.f` opens a hint, and each time the next one. Commit your work, then
hand it in: `make submit HW=hw9`.
end
"""
COURSE = tasks.parse(TASKS)
WITHOUT_7 = tasks.parse(TASKS.replace('"Last"', '"Last"\ndropped = true'))
EXTRA = tasks.parse(TASKS + "extra = true\n")


class Splitting(unittest.TestCase):
    """That a starter and a solution are right, kit_check.py shows."""

    def test_a_dropped_task_is_given(self):
        self.assertEqual(
            markers.starter(SOURCE, WITHOUT_7),
            markers.stub(SOURCE, ["3.1.f"], COURSE))
        self.assertEqual(list(WITHOUT_7.tasks), ["3.1.f"])
        self.assertEqual([s.id for s in WITHOUT_7.sections], ["3.1"])
        self.assertEqual(WITHOUT_7.points, 4)
        markers.check({"S.hpp": SOURCE}, WITHOUT_7)
        for test, unasked in (("7.1.g.cpp", True), ("3.1.f.cpp", False),
                              ("check.hpp", False)):
            self.assertEqual(starter.is_unasked(test, WITHOUT_7), unasked)
        # With all that is guided around it, or nothing.
        for opens, given in (("// OPEN int x;\n", markers.starter(
                SOURCE, WITHOUT_7)), ("", "// YOUR CODE 3.1.f: "
                                       "course page 3.1\n")):
            self.assertEqual(markers.starter(
                f"// BEGIN GUIDED\n{SOURCE}{opens}// END GUIDED\n", WITHOUT_7,
                "S.hpp", "open"), given)

    def test_faults(self):
        """Each has its line."""
        for old, new, line, words in (
                ("  // END SOLUTION\n};", "};", 16, "without an END SOLUTION"),
                ("    return h(x);\n", "    // BEGIN SOLUTION 7.1.g\n"
                 "    return h(x);\n", 11, "began in line 10"),
                ("    // STUB return 0;\n", "    // STUB return 0;\n"
                 "    return 1;\n", 14, "stubs stand last"),
                ("    return h(x);\n", "\n", 10, "no solution"),
                ("};", "}; // BEGIN SOLUTION 3.1.f", 19, "malformed"),
                ("};", "// STUB x();", 19, "outside of a region"),
                ("};", "// BEGIN GUIDED", 19, "without an END GUIDED"),
                ("};", "// OPEN x();", 19, "outside of BEGIN"),
                ("SOLUTION 3.1.f", "SOLUTION 3.1.x", 2, "no task '3.1.x'")):
            with self.assertRaises(markers.MarkerError) as caught:
                markers.check({"S.hpp": SOURCE.replace(old, new)}, COURSE)
            self.assertRegex(str(caught.exception),
                             rf"^S.hpp:{line}: .*{words}[^\n]*$")
        text = "".join(SOURCE.splitlines(keepends=True)[8:])
        with self.assertRaisesRegex(markers.MarkerError,
                                    "neither a region nor a test"):
            markers.check({"S.hpp": text}, COURSE)


class Tasks(unittest.TestCase):
    def test_what_is_read(self):
        self.assertEqual((COURSE.points, EXTRA.points), (5, 4))
        g = COURSE.tasks["7.1.g"]
        self.assertEqual((g.section.id, g.needs, g.tests, g.says),
                         ("7.1", "cloth", ("7.1.g", "7.1.g_more"),
                          'g(x) is "x".'))
        self.assertEqual(COURSE.tasks["3.1.f"].tests, ("3.1.f",))

    def test_faults(self):
        for old, new, line, words in (
                ("points = 4", "points = four", 12, "at line 12"),
                ("points = 4\n", "", 10, "'points' is missing"),
                ("points = 4", "points = -4", 10, "negative"),
                ('says = "f() is 1."', 'says = ""', 10, "one line"),
                ('["Return', '[1, "Return', 10, "hint is not a text of one "),
                ('hints = ["Return', 'note = ["Return', 10, "unknown key 'n"),
                ("3.1.f", "3.2.f", 10, "'3.2.f' is no id of a task"),
                ("7.1.g\"]\ntitle", "3.1.f\"]\ntitle", 15, "at line 15"),
                ('n."3.1"', 'n."3/1"', 3, "no id of a section"),
                ('"cloth"', '"silk"', 7, "expected graph, cloth or step"),
                ('"7.1.g_more"', '"../x"', 15, "names of files"),
                ('[section."3.1"]', "[curse]", 1, "unknown key 'curse'"),
                ('title = "First"', 'title = "First"\nnumber = "7.1"', 1,
                 "two sections have the number 7.1"),
                ('title = "First"', 'title = "First"\nnumber = "7-1"', 3,
                 "number '7-1' is not one"),
                ('tag = "hw9"\n', "", 1, "'tag' is missing")):
            with self.assertRaises(tasks.TasksError) as caught:
                tasks.parse(TASKS.replace(old, new), "t.toml")
            self.assertRegex(caught.exception.faults[0],
                             rf"^t.toml:{line}: .*{words}")
        with self.assertRaisesRegex(tasks.TasksError, "No such file"):
            tasks.load(pathlib.Path("/nowhere/tasks.toml"))


class Pages(unittest.TestCase):
    def test_a_section_has_its_tasks_their_sum_and_no_extra_points(self):
        self.assertEqual(pages.filled(PAGE, COURSE), FILLED)
        self.assertEqual(pages.filled(FILLED, COURSE), FILLED)
        place = "<!-- tasks 7.1 -->\n"
        self.assertRegex(pages.filled(place, EXTRA), "^- \\*\\*g\\*\\*, 1 extra"
                         ": g\\(x\\) is \"x\".\n\n`make test SECTION=7.1` ")
        self.assertIn("Nothing: this section", pages.filled(place, WITHOUT_7))

    def test_hints_open_one_by_one(self):
        self.assertIn(
            '\n  <details><summary>Hint 1</summary>Is a &lt; b?<details>'
            "<summary>Hint 2</summary>A backslash: \\.</details></details>\n",
            pages.filled("<!-- tasks 7.1 -->\n", COURSE, hints=True))

    def test_faults(self):
        page = PAGE + "\n".join([*pages.PARTS, ""])
        for text, faults in (
                (page, ""),
                (page + "<!-- guided -->\nb\n", "1: <!-- guided --> or .*"),
                (page.replace("**Goal", ""), r"1: has no \*\*Goal"),
                (page + "line\n" * 102, "108: goes on to line 1.*")):
            self.assertRegex("\n".join(pages.faults(
                text, COURSE.sections[0], COURSE)), f"^{faults}$")


class Repository(unittest.TestCase):
    """make starter and make solution, of this repository."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, kind, out, level="", status=0):
        """What was said."""
        done = child.run(
            [sys.executable, tasks.ROOT / "course/kit/starter.py", kind],
            env=os.environ | {"OUT": str(out), "LEVEL": level},
            capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def content(self, folder):
        return {str(p.relative_to(folder)): (p.read_bytes(), p.stat().st_mode)
                for p in folder.rglob("*") if p.is_file()}

    def test_a_renamed_homework_is_renamed_everywhere(self):
        old = tasks.load()
        new = dataclasses.replace(old, title="new title", tag="new-tag")
        texts = markers.read_sources()
        with unittest.mock.patch("markers.load", lambda: (texts, new)):
            files = starter.tree("starter")
        for name, (content, _) in files.items():
            self.assertNotRegex(content, rf"\b{old.tag}\b".encode(), name)
        self.assertTrue(files["README.md"][0].startswith(b"# new title\n"))
        self.assertIn(b"HW     ?= new-tag\n", files["Makefile"][0])

    def test_a_renumbered_course(self):
        text = (tasks.ROOT / tasks.FILE).read_text(encoding="utf-8")
        new = tasks.parse('language = "de"\n' + text.replace(
            '[section."7.1"]', '[section."7.1"]\nnumber = "2"').replace(
                '[section."3.2"]', '[section."3.2"]\nnumber = "9.9"'))
        self.assertEqual(pages.check(new), [])
        with unittest.mock.patch("markers.load", lambda: (
                markers.read_sources(), new)):
            files = starter.tree("starter")
        self.assertTrue(files["pages/7.1.md"][0].startswith(b"# 2 Removal"))
        self.assertIn("tests/2.remove_node.cpp", files)
        page = files["pages/3.1.md"][0].decode()
        self.assertTrue(page.startswith("# 3.1 Orte"))
        self.assertIn("\nZusammen 4 Punkte. `make test SECTION=3.1` z", page)
        for name, (content, _) in files.items():
            if name.endswith((".md", ".cpp", ".hpp", ".js", "mk", "Makefile")):
                self.assertNotRegex(content, rb"(?<![\d.$/-])(7\.1|3\.2)(?!"
                                    rb"[\d-]|\.md|\.png| m\b)", name)

    def test_a_starter_holds_what_it_should(self):
        files, solved = (starter.tree(kind) for kind in ("starter", "solution"))
        self.assertEqual(set(files), set(solved))
        self.assertEqual({f for f in files if files[f] != solved[f]},
                         set(markers.SOURCES))
        for name in ("LICENSE", ".gitignore", "Makefile", "README.md",
                     ".github/workflows/tests.yml", "tests/tasks.inc",
                     "CME212/Point.hpp", "CME212/viewer.mk",
                     "data/grid1.nodes", "tools/submit.sh"):
            self.assertIn(name, files)
        for name in files:
            self.assertNotRegex(name, r"^lab|scenes|grid4|(?<!web)\.py$|"
                                r"pages/(README|teach)")
        sources = b"".join(files[name][0] for name in markers.SOURCES)
        marked = "".join(markers.read_sources().values())
        for task in tasks.load().tasks.values():
            # A task without a region asks for no code of its own.
            self.assertEqual(f"YOUR CODE {task.id} ".encode() in sources,
                             f"SOLUTION {task.id} " in marked, task.id)
        self.assertIsNone(markers.LOOKS_LIKE_ONE.search(sources.decode()))

    def test_the_grader_reads_a_starter(self):
        for kind in ("starter", "solution"):
            starter.write(starter.tree(kind), self.folder / kind)
            taken = submission.take(self.folder / kind)
            self.assertEqual(set(taken.files), {
                *markers.SOURCES, "test_nodes.cpp", "test_edges.cpp"})
            self.assertEqual(taken.starter, tasks.load().starter)
            self.assertEqual(taken.flags, [])

    def test_make_hint_opens_one_more_each_time(self):
        starter.write(starter.tree("starter"), self.folder / "s")
        hints = tasks.load().tasks["3.1.position"].hints
        for opened in (1, 2, 3, 3):
            done = child.run(["make", "-s", "hint", "TASK=3.1.position"],
                             cwd=self.folder / "s", capture_output=True,
                             text=True)
            said = " ".join(done.stdout.split())
            for number, hint in enumerate(hints, 1):
                self.assertEqual(f"Hint {number}: {hint}" in said,
                                 number <= opened, said)
        for what, said in (("TASK=1", "TASK is '1', expected one of: 1.nodes"),
                           ("TASK=", "1.values: 1 left\n3.2.symp_euler")):
            done = child.run(["make", "-s", "hint", what], capture_output=True,
                             cwd=self.folder / "s", text=True)
            self.assertIn(said, done.stdout)

    def test_the_open_level_gives_no_design_away(self):
        self.assertIn("'none', expected guided or open", self.make(
            "starter", self.folder / "s", "none", status=1))
        guided, given = (starter.tree("starter", level)
                         for level in pages.LEVELS)
        self.assertEqual(set(guided) - set(given),
                         {"CME212/SlotMap.hpp", "docs/graph.md"})
        self.assertLess(set(given), set(guided))
        design = re.compile(rb"pointers? to\s+.Zero|struct Zero|shared_ptr"
                            rb"|SlotMap|virtual ~|GUIDED|// OPEN|<!-- o")
        for name, (text, _) in given.items():
            if not re.match(r"tests/|CME212/", name):
                self.assertIsNone(design.search(text), name)
        for name in ("pages/5.1.md", "mass_spring.hpp"):
            self.assertIsNotNone(design.search(guided[name][0]), name)
        # All that is asked in the one is asked in the other.
        asked = re.compile(rb"YOUR CODE ([\w.]+\w)")
        ids = [{found[0] for name in markers.SOURCES
                for found in asked.finditer(files[name][0])}
               for files in (guided, given)]
        self.assertEqual(ids[0], ids[1])

    def test_a_starter_compiles(self):
        for level in pages.LEVELS:
            folder = self.folder / level
            self.make("starter", folder, level)
            shutil.copy(tasks.ROOT / markers.OPEN_GRAPH, folder)
            child.run(["g++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra",
                       *os.environ.get("CXXFLAGS", "").split(),
                       "-I.", "-DSTAGE=tear", "mass_spring.cpp"],
                      check=True, cwd=folder)

    def test_every_link_of_a_starter_holds(self):
        text = ("[a](../x.md) [b](y.md#c) [c d](../lab/z.md) [e](https://f/g) "
                "[h](#i) ![j](../k.png) [l](p)")
        self.assertEqual(
            starter.without_dead_links(text, "docs/y.md",
                                       {"x.md": 0, "docs/p/q": 0}),
            text.replace("[c d](../lab/z.md)", "c d"))
        files = starter.tree("starter")
        there = {*files, *(str(folder) for name in files
                           for folder in pathlib.PurePath(name).parents)}
        for page in (name for name in files if name.endswith(".md")):
            for target in re.findall(r'(?:\]\(|src=")([^)"\s#]+)',
                                     files[page][0].decode()):
                if not target.startswith("http"):
                    self.assertIn(os.path.normpath(os.path.join(
                        os.path.dirname(page), target)), there, page)

    def test_out_must_be_new_or_empty(self):
        (self.folder / "empty").mkdir()
        self.make("starter", self.folder / "empty")
        (self.folder / "full").mkdir()
        (self.folder / "full/x").touch()
        (self.folder / "file").touch()
        before = self.content(self.folder)
        for out, words in ((self.folder / "full", "is not empty"),
                           (self.folder / "file", "is a file"),
                           (self.folder / "file/below", "nothing was written"),
                           ("", "OUT is missing")):
            said = self.make("starter", out, status=1)
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)
            self.assertEqual(self.content(self.folder), before)


class Constants(unittest.TestCase):
    TEXT = (tasks.ROOT / tasks.FILE).read_text("utf-8")
    OLD = TEXT[TEXT.index("gravity ="):TEXT.index("\n\n# ---")]

    def test_other_numbers(self):
        """They leave no old one, C++ and TOML can read them; and back."""
        old, new = (constants.values(self.TEXT.replace(self.OLD, numbers))
                    for numbers in (self.OLD, "gravity = 9.80665\nK = 2e6\n"
                                    "floor=-1\nradius=1e-5\ncenter=[0, 1, -2]"))
        places = dict(constants.places())
        for path in {*map(tasks.ROOT.joinpath, places), *(
                tasks.ROOT / "course").rglob("*.[chmt]*[dlp]")}:
            text = path.read_text("utf-8").replace(self.OLD, "")
            lines = places.get(str(path.relative_to(tasks.ROOT)), [])
            changed, missing = constants.written(text, lines, new)
            self.assertNotRegex(changed, r"9\.81?\b|[^,] -0\.75\b|"
                                r"(?<!nt )K = 100[; )]|omega = 10\b"
                                r"|0\.0002[67]|17\.1573", path)
            self.assertEqual([missing, *constants.written(changed, lines, old)],
                             ["", text, ""], path)

        for right, wrong, said in (
                ("0.15", "0,2", "13: Expected .*; a number is written as 0.2"),
                ("0.15", ".2", "13: Invalid .*; a number is written as 0.2"),
                ("-0.75", "1", "9"), ("[0.5, ", "[", "9"), ("K =", "k =", "9")):
            with self.assertRaisesRegex(tasks.TasksError,
                                        rf"\Acourse/tasks.toml:{said}.*\Z"):
                constants.values(self.TEXT.replace(right, wrong, 1))


if __name__ == "__main__":
    unittest.main()
