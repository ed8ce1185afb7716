"""Tests of markers.py, tasks.py and starter.py, on small texts and on this
repository: python3 course/kit/test_markers.py"""
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import child
import markers
import pages
import starter
import submission
import tasks

TASKS = """[course]
title = "A course"
tag = "hw2"
[[section]]
id = "3.1"
title = "First"
page = "3.1.md"
[[section]]
id = "7.1"
title = "Last"
[[task]]
id = "3.1.f"
title = "f"
points = 4
needs = "graph"
says = "f() is 1."
hint = "Return 1."
[[task]]
id = "7.1.g"
title = "g"
points = 1
needs = "cloth"
says = "g(x) is \\"x\\"."
hint = "A backslash: \\\\."
tests = ["7.1.g", "7.1.g_more"]
"""
SOURCE = """struct S {
  // BEGIN SOLUTION 3.1.f 4pt
  int f() { return 1; }
  // STUB int f() {
  // STUB   return 0;
  // STUB }
  // END SOLUTION

  int g(int x) {
    // BEGIN SOLUTION 7.1.g 1pt
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
SOLUTION = """struct S {
  int f() { return 1; }

  int g(int x) {
    return h(x);
  }
  int h(int x) { return x; }
};
"""
STARTER = """struct S {
  // YOUR CODE 3.1.f (4 points): course page 3.1
  int f() {
    return 0;
  }

  int g(int x) {
    // YOUR CODE 7.1.g (1 point)
    (void)x;
    return 0;
  }
  // YOUR CODE 7.1.g, too
};
"""
COURSE = tasks.parse(TASKS)


class Splitting(unittest.TestCase):
    def test_a_solution_has_no_markers(self):
        self.assertEqual(markers.solution(SOURCE), SOLUTION)
        self.assertEqual(markers.solution(SOLUTION), SOLUTION)

    def test_a_starter_has_comments_and_stubs(self):
        self.assertEqual(markers.starter(SOURCE, COURSE), STARTER)

    def test_one_task_is_stubbed_alone(self):
        lines = STARTER.splitlines(keepends=True)
        mixed = SOLUTION.replace("  int f() { return 1; }\n",
                                 "".join(lines[1:5]))
        self.assertEqual(markers.stub(SOURCE, ["3.1.f"], COURSE), mixed)
        self.assertEqual(markers.stub(SOURCE, ["7.1.g"]), "".join(
            ["struct S {\n", "  int f() { return 1; }\n"] + lines[5:]).replace(
                " (1 point)", ""))
        self.assertEqual(markers.stub(SOURCE, []), SOLUTION)

    def test_a_dropped_task_is_given(self):
        course = tasks.parse(TASKS.replace('id = "7.1"',
                                           'id = "7.1"\ndropped = true'))
        self.assertEqual(
            markers.starter(SOURCE, course),
            markers.stub(SOURCE, ["3.1.f"], COURSE))
        self.assertEqual(list(course.tasks), ["3.1.f"])
        self.assertEqual([s.id for s in course.sections], ["3.1"])
        self.assertEqual(course.points, 4)
        markers.check({"S.hpp": SOURCE}, course)  # its points do not matter
        self.assertTrue(starter.is_unasked("7.1.g.cpp", course))
        self.assertFalse(starter.is_unasked("3.1.f.cpp", course))
        self.assertFalse(starter.is_unasked("check.hpp", course))


class Faults(unittest.TestCase):
    """Each has its line, and is seen among others."""

    def faults(self, text, course=COURSE, tests=()):
        with self.assertRaises(markers.MarkerError) as caught:
            markers.check({"S.hpp": text}, course, tests)
        return caught.exception.faults

    def one(self, text, line, words, **more):
        faults = self.faults(text, **more)
        self.assertEqual(len(faults), 1, faults)
        self.assertRegex(faults[0], rf"^{re.escape(line)}: ")
        self.assertIn(words, faults[0])

    def test_the_source_without_a_fault(self):
        markers.check({"S.hpp": SOURCE}, COURSE)

    def test_unbalanced(self):
        self.one(SOURCE.replace("  // END SOLUTION\n};", "};"), "S.hpp:16",
                 "without an END SOLUTION")
        self.one(SOURCE + "// END SOLUTION\n", "S.hpp:20",
                 "without a BEGIN SOLUTION")
        self.one(SOURCE + "// STUB x();\n", "S.hpp:20",
                 "outside of a region")

    def test_nested(self):
        self.one(SOURCE.replace(
            "    return h(x);\n", "    // BEGIN SOLUTION 7.1.g\n"
            "    return h(x);\n"), "S.hpp:11", "began in line 10")

    def test_guided(self):
        begin, end = "// BEGIN GUIDED\n", "// END GUIDED\n"
        self.one(SOURCE + begin, "S.hpp:20", "without an END GUIDED")
        self.one(SOURCE + end, "S.hpp:20", "without a BEGIN GUIDED")
        self.one(SOURCE + "// OPEN x();\n", "S.hpp:20", "outside of BEGIN")
        markers.check({"S.hpp": begin + SOURCE + end}, COURSE)

    def test_malformed(self):
        for line in ("// BEGIN SOLUTION", "// BEGIN SOLUTION 3.1.f 4",
                     "int x;  // BEGIN SOLUTION 3.1.f", "// begin solution a",
                     "// END SOLUTION 3.1.f", "// END OF SOLUTION? No: END "
                     "SOLUTION.", "// STUB", "//STUB return 0;",
                     "int x;  // STUB return 0;", "/* END SOLUTION */"):
            with self.subTest(line):
                self.one(SOURCE + line + "\n", "S.hpp:20", "malformed")

    def test_code_behind_a_stub(self):
        self.one(SOURCE.replace("    // STUB return 0;\n", "    // STUB "
                                "return 0;\n    return 1;\n"), "S.hpp:14",
                 "stubs stand last")

    def test_an_empty_region(self):
        self.one(SOURCE.replace("    return h(x);\n", "\n"), "S.hpp:10",
                 "no solution")

    def test_without_a_task(self):
        self.one(SOURCE + "// BEGIN SOLUTION 7.1.x\n;\n// END SOLUTION\n",
                 "S.hpp:20", "no task '7.1.x'")

    def test_points(self):
        self.one(SOURCE.replace("f 4pt", "f 5pt"), "S.hpp:2",
                 "5 points here and 4 in course/tasks.toml:11")
        self.one(SOURCE.replace("f 4pt", "f"), "S.hpp:2", "expected 4pt")
        self.one(SOURCE.replace("7.1.g\n", "7.1.g 1pt\n"), "S.hpp:16",
                 "first region, S.hpp:10")

    def test_neither_region_nor_test(self):
        text = "".join(SOURCE.splitlines(keepends=True)[8:])
        self.one(text, "course/tasks.toml:11", "neither a region nor a test")
        markers.check({"S.hpp": text}, COURSE, {"3.1.f"})
        free = tasks.parse(TASKS.replace("points = 4", "points = 0"))
        markers.check({"S.hpp": text}, free)  # nothing is asked

    def test_all_faults_at_once(self):
        text = "// STUB x\n" + SOURCE + "// BEGIN SOLUTION\n"
        self.assertEqual(len(self.faults(text)), 2)


class Tasks(unittest.TestCase):
    def fault(self, old, new, line, words):
        text = TASKS.replace(old, new)
        self.assertNotEqual(text, TASKS)
        with self.assertRaises(tasks.TasksError) as caught:
            tasks.parse(text, "t.toml")
        self.assertRegex(caught.exception.faults[0], rf"^t.toml:{line}: ")
        self.assertIn(words, caught.exception.faults[0])

    def test_what_is_read(self):
        self.assertEqual(COURSE.points, 5)
        g = COURSE.tasks["7.1.g"]
        self.assertEqual((g.section.id, g.needs, g.tests, g.says),
                         ("7.1", "cloth", ("7.1.g", "7.1.g_more"),
                          'g(x) is "x".'))
        self.assertEqual(COURSE.tasks["3.1.f"].tests, ("3.1.f",))
        self.assertEqual(COURSE.tasks_of(g.section), [g])

    def test_an_extra_is_not_counted(self):
        course = tasks.parse(TASKS + "extra = true\n")
        self.assertEqual(course.points, 4)
        self.assertEqual(course.tasks["7.1.g"].points, 1)

    def test_faults(self):
        self.fault("points = 4", "points = four", 14, "at line 14")
        self.fault("points = 4\n", "", 11, "'points' is missing")
        self.fault("points = 4", 'points = "4"', 11, "not a whole number")
        self.fault("points = 4", "points = true", 11, "not a whole number")
        self.fault("points = 4", "points = -4", 11, "negative")
        self.fault('says = "f() is 1."', 'says = ""', 11, "one line")
        self.fault('hint = "Return 1."', 'hint = "a\\nb"', 11, "one line")
        self.fault('hint = "Return', 'note = 1\nhint = "Return', 11,
                   "unknown key 'note'")
        self.fault("3.1.f", "3.2.f", 11, "'3.2.f' is no id of a task")
        self.fault("3.1.f", "3.1.f-g", 11, "is no id of a task")
        self.fault("7.1.g\"\ntitle", "3.1.f\"\ntitle", 18, "line 11")
        self.fault('id = "7.1"', 'id = "3.1"', 8, "line 4")
        self.fault('id = "3.1"', 'id = "3/1"', 4, "no id of a section")
        self.fault('"cloth"', '"silk"', 18, "expected graph, cloth or step")
        self.fault('"7.1.g_more"', '"../x"', 18, "names of files")
        self.fault("[course]", "[curse]", 1, "unknown table 'curse'")
        self.fault('tag = "hw2"\n', "", 1, "'tag' is missing")

    def test_a_file_that_is_not_there(self):
        with self.assertRaisesRegex(tasks.TasksError, "No such file"):
            tasks.load(pathlib.Path("/nowhere/tasks.toml"))


class Table(unittest.TestCase):
    def test_the_table_of_a_program(self):
        self.assertEqual(starter.table_of(COURSE).splitlines()[1:], [
            'X("3.1.f", "f", 4,', '  "f() is 1.",', '  "Return 1.")',
            'X("7.1.g", "g", 1,', '  "g(x) is \\"x\\".",',
            '  "A backslash: \\\\.")'])

    def test_a_link_to_nothing_is_words(self):
        text = ("[a](../x.md) [b](y.md#c) [c d](../lab/z.md) [e](https://f/g) "
                "[h](#i) ![j](../k.png) [l](p)")
        self.assertEqual(
            starter.without_dead_links(text, "docs/y.md",
                                       {"x.md": 0, "docs/p/q": 0}),
            text.replace("[c d](../lab/z.md)", "c d"))


class Repository(unittest.TestCase):
    """make starter and make solution, of this repository."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, kind, out, level=""):
        """The status and what was said."""
        done = child.run(
            [sys.executable, tasks.ROOT / "course/kit/starter.py", kind],
            env=os.environ | {"OUT": str(out), "LEVEL": level},
            capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def content(self, folder):
        return {str(p.relative_to(folder)): (p.read_bytes(), p.stat().st_mode)
                for p in folder.rglob("*") if p.is_file()}

    def test_same_call_same_bytes(self):
        for kind in ("starter", "solution"):
            for name in ("a b", "c/d"):
                status, said = self.make(kind, self.folder / kind / name)
                self.assertEqual(status, 0, said)
            first = self.content(self.folder / kind / "a b")
            self.assertEqual(first, self.content(self.folder / kind / "c/d"))
            self.assertEqual(sorted(os.listdir(self.folder / kind)),
                             ["a b", "c"])

    def test_a_renamed_homework_is_renamed_everywhere(self):
        copy = self.folder / "copy"
        for name in ("course", "CME212", "docs", "tools", "data"):
            shutil.copytree(tasks.ROOT / name, copy / name)
        for path in tasks.ROOT.glob("*"):
            if path.is_file():
                shutil.copy(path, copy)
        course = copy / "course/tasks.toml"
        text = course.read_text(encoding="utf-8")
        old = tasks.load()
        for key, value in (("tag", old.tag), ("title", old.title)):
            self.assertEqual(text.count(f'{key} = "{value}"'), 1)
            text = text.replace(f'{key} = "{value}"', f'{key} = "new-{key}"')
        course.write_text(text, encoding="utf-8")

        def run(program, *arguments):
            done = child.run([sys.executable, copy / "course/kit" / program,
                              *arguments], capture_output=True, text=True,
                             env=os.environ | {"OUT": str(self.folder / "s")})
            return done.returncode, done.stdout + done.stderr

        status, said = run("starter.py", "starter")
        self.assertEqual(status, 1)
        for name in ("README.md", "Makefile", "course/3.1.md",
                     "course/starter/README.md:1", "tools/submit.sh"):
            self.assertRegex(said, rf"(?m)^{name}\S*: differs from tasks")
        self.assertFalse((self.folder / "s").exists())
        self.assertEqual(run("pages.py", "--write")[0], 0)
        self.assertEqual(run("pages.py"), (0, ""))
        self.assertEqual(run("starter.py", "starter")[0], 0)
        files = self.content(self.folder / "s")
        for name, (content, _) in files.items():
            self.assertNotRegex(content, rf"\b{old.tag}\b".encode(), name)
        self.assertIn(b"# new-title\n", files["README.md"][0])
        self.assertIn(b"HW     ?= new-tag\n", files["Makefile"][0])
        for name in pages.NAMING:
            self.assertNotIn(old.tag, (copy / name).read_text("utf-8"), name)

    def test_a_starter_holds_what_it_should(self):
        self.make("starter", self.folder / "s")
        self.make("solution", self.folder / "t")
        files = self.content(self.folder / "s")
        solved = self.content(self.folder / "t")
        self.assertEqual(set(files), set(solved))
        self.assertEqual({f for f in files if files[f] != solved[f]},
                         set(markers.SOURCES))
        for name in ("LICENSE", ".gitignore", "Makefile", "README.md",
                     ".github/workflows/tests.yml", "tests/tasks.inc",
                     "test_nodes.cpp", "CME212/Point.hpp", "CME212/viewer.mk",
                     "data/grid1.nodes", "tools/submit.sh"):
            self.assertIn(name, files)
        for name in files:
            self.assertNotRegex(name, r"^lab|scenes|grid4|pages/README|"
                                r"(?<!web)\.py$")
        # The grader reads these files of a starter that is handed in.
        taken = submission.take(self.folder / "s")
        self.assertEqual(set(taken.files), {
            *markers.SOURCES, "test_nodes.cpp", "test_edges.cpp"})
        self.assertEqual(taken.flags, [])
        sources = b"".join(files[name][0] for name in markers.SOURCES)
        for task in tasks.load().tasks.values():
            # A task without a region asks for no code of its own.
            marked = f"SOLUTION {task.id} ".encode() in b"".join(
                text.encode() for text in markers.read_sources().values())
            self.assertEqual(f"YOUR CODE {task.id} ".encode() in sources,
                             marked, task.id)
        self.assertIsNone(markers.LOOKS_LIKE_ONE.search(sources.decode()))

    def test_the_open_level_gives_no_design_away(self):
        said = {level: self.make("starter", self.folder / level, level)
                for level in ("guided", "open", "none")}
        self.assertEqual([status for status, _ in said.values()], [0, 0, 1])
        self.assertIn("'none', expected guided or open", said["none"][1])
        guided, given = (self.content(self.folder / level)
                         for level in ("guided", "open"))
        self.assertEqual(set(guided) - set(given),
                         {"CME212/SlotMap.hpp", "docs/graph.md"})
        self.assertLess(set(given), set(guided))
        design = re.compile(rb"Zero(Force|Constraint)|Combined|shared_ptr|SlotM"
                            rb"ap|virtual ~|GUIDED|// OPEN|<!-- o")
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

    def test_a_starter_compiles_with_any_graph(self):
        for level, graph in (("open", ""), ("open", "lists"),
                             ("guided", "erase")):
            folder = self.folder / f"{level} {graph}"
            self.make("starter", folder, level)
            if graph:
                shutil.copy(tasks.ROOT / f"course/graphs/{graph}/Graph.hpp",
                            folder)
            child.run(["g++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra",
                       "-Werror", "-I.", "-DSTAGE=tear", "mass_spring.cpp"],
                      check=True, cwd=folder)

    def test_what_was_dropped_can_not_be_left_open(self):
        course = tasks.parse(TASKS.replace('id = "7.1"',
                                           'id = "7.1"\ndropped = true'))
        guided = f"// BEGIN GUIDED\n{SOURCE}// OPEN int x;\n// END GUIDED\n"
        self.assertEqual(markers.solution(guided), SOLUTION)
        self.assertEqual(
            markers.starter(guided, COURSE, level="open"),
            "// YOUR CODE 3.1.f (4 points): course page 3.1\n"
            "// YOUR CODE 7.1.g (1 point)\nint x;\n")
        with self.assertRaisesRegex(markers.MarkerError,
                                    "^S.hpp:11: 7.1.g was dropped"):
            markers.starter(guided, course, "S.hpp", "open")

    def test_every_link_of_a_starter_holds(self):
        self.make("starter", self.folder / "s")
        pages = list((self.folder / "s").rglob("*.md"))
        self.assertGreater(len(pages), 10)
        for page in pages:
            text = page.read_text(encoding="utf-8")
            for target in re.findall(r'(?:\]\(|src=")([^)"\s#]+)', text):
                if not target.startswith("http"):
                    self.assertTrue((page.parent / target).exists(),
                                    f"{page}: {target}")

    def test_how_a_starter_builds_its_own_programs(self):
        self.make("starter", self.folder / "s")
        own = self.folder / "s/own.cpp"

        def commands(text, *arguments):
            own.write_text(text + "\nint main() {}\n")
            done = child.run(["make", "-n", "own", *arguments],
                             cwd=own.parent, capture_output=True,
                             text=True, env=os.environ | {"MAKEFLAGS": ""})
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        plain = commands("", "VIEWER=1")
        self.assertIn(" -Og ", plain)
        self.assertNotRegex(plain, "NDEBUG|libviewer|gtest|fsanitize|VIEWER=0")
        fast = commands("", "FAST=1", "VIEWER=1")
        self.assertIn("-O3 -DNDEBUG", fast)
        self.assertIn("-fsanitize=address", commands("", "SANITIZE=1"))
        drawn = commands('#include "CME212/SFML_Viewer.hpp"', "VIEWER=1")
        self.assertRegex(drawn, r"own\.cpp \S*libviewer\.a -l")
        self.assertIn("without a window: VIEWER=0", commands("", "VIEWER=0"))

    def test_out_must_be_new_or_empty(self):
        (self.folder / "empty").mkdir()
        self.assertEqual(self.make("starter", self.folder / "empty")[0], 0)
        (self.folder / "full").mkdir()
        (self.folder / "full/x").touch()
        (self.folder / "file").touch()
        before = self.content(self.folder)
        for out, words in ((self.folder / "full", "is not empty"),
                           (self.folder / "file", "is a file"),
                           (self.folder / "file/below", "nothing was written"),
                           ("", "OUT is missing")):
            status, said = self.make("starter", out)
            self.assertEqual(status, 1)
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)
            self.assertEqual(self.content(self.folder), before)

    def test_a_fault_in_a_source_leaves_nothing(self):
        root = self.folder / "root"
        for name in ("course", "CME212"):
            shutil.copytree(tasks.ROOT / name, root / name)
        for name in markers.SOURCES:
            shutil.copy(markers.path_of(name), markers.path_of(name, root))
        with open(root / "mass_spring.cpp", "a", encoding="utf-8") as file:
            file.write("// END SOLUTION\n")
        last = len((root / "mass_spring.cpp").read_text().splitlines())
        with self.assertRaisesRegex(markers.MarkerError,
                                    f"^mass_spring.cpp:{last}: END SOLUTION"):
            starter.tree("starter", root=root)

    def test_a_write_that_fails_leaves_nothing(self):
        with self.assertRaises(OSError):
            starter.write({"a": (b"", False), "a/b": (b"", False)},
                          self.folder / "new")
        self.assertEqual(os.listdir(self.folder), [])

    def test_every_test_of_a_task_is_there(self):
        names = markers.names_of_tests()
        for task in tasks.load().tasks.values():
            for test in task.tests:
                self.assertIn(test, names, task.id)

    def test_the_assignment_has_100_points(self):
        self.assertEqual(markers.load()[1].points, 100)


if __name__ == "__main__":
    result = unittest.TextTestRunner(stream=sys.stdout).run(
        unittest.defaultTestLoader.loadTestsFromModule(
            sys.modules["__main__"]))
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad != 0)
