"""Every door takes a stranger's file by one path: hostile.toml is sent through
grade, class, grade-tests, try and web. Each says one sentence, and reads
nothing that is not the stranger's."""

import contextlib
import io
import os
import pathlib
import re
import shutil
import sys
import tempfile
import types
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / room) for room in (
    "course/kit", "course/web", "lab/try")]
import child            # noqa: E402
import class_page       # noqa: E402
import grade_tests      # noqa: E402
import judge            # noqa: E402
import once             # noqa: E402
import submission       # noqa: E402
import tasks            # noqa: E402
import units            # noqa: E402
import web              # noqa: E402
import whole_class      # noqa: E402
import workshop         # noqa: E402

TABLE = tasks.tomllib.loads((HERE / "hostile.toml").read_text("utf-8"))
STEP = """template <typename G, typename F>
double my_step(G&, double t, double dt, F&&) { return t + dt; }
"""
TEST = '\nTASK("3.1.position", a) {}\n'


def of_class(folder, tag):
    """What becomes of a folder in a class."""
    whole = whole_class.Class.__new__(whole_class.Class)
    whole.folder, whole.tag = str(folder.parent), tag
    row = whole.read(folder.name)
    if row.reason:
        raise submission.BadInput(row.reason)
    return row


class Door(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        self.addCleanup(shutil.rmtree, self.top)
        self.top.chmod(0o755)

    def folder(self, name):
        path = self.top / name
        path.mkdir(parents=True)
        return path

    def shell(self, folder, text, **variables):
        child.run(["bash", "-c", text], cwd=folder, check=True, env={
            **os.environ, **{k: str(v) for k, v in variables.items()}})

    def refused(self, says, door, *arguments):
        with self.assertRaises(submission.BadInput) as caught:
            door(*arguments)
        self.assertRegex(str(caught.exception), rf"\A[ -~]*{says}[ -~]*\Z")

    def test_a_repository_lies_in_its_folder(self):
        other = self.folder("class/other")
        (other / "Graph.hpp").write_text("a classmate's")
        self.shell(other, "git init -q; git add .; git -c user.name=a "
                   "-c user.email=b commit -qm x; git tag hw2")
        for number, (name, (text, says)) in enumerate(TABLE["clone"].items()):
            folder = self.folder(f"class{number}/own")
            shutil.copytree(other, folder.parent / "other")
            self.shell(folder, text, OTHER=folder.parent / "other")
            for door in (submission.take, of_class):
                with self.subTest(name, door=door.__name__):
                    self.refused(says, door, folder, "hw2")
            self.assertFalse((folder.parent / "other/bad").exists())
        (other.parent / "link").symlink_to(other)
        self.refused("is a symbolic link", of_class, other.parent / "link", "")

    def test_a_file_is_taken_or_refused_in_a_sentence(self):
        doors = {
            "Graph.hpp": [submission.take, lambda one: of_class(one, "")],
            "mine.hpp": [lambda one: workshop.choose(one / "mine.hpp", "")],
            "mine.cpp": [lambda one: grade_tests.read(str(one / "mine.cpp"),
                                                      tasks.load())],
            "mass_spring.hpp": [lambda one: self.page(one)]}
        for number, (name, (text, says)) in enumerate(TABLE["file"].items()):
            for file, all_doors in doors.items():
                folder = self.folder(f"{number}/{file}")
                self.shell(folder, text, FILE=folder / file)
                says_here = ("(holds no Graph.hpp|" + says + ")"
                             if file == "Graph.hpp" else says)
                for door in all_doors:
                    with self.subTest(name, file=file):
                        self.refused(says_here, door, folder)

    def page(self, folder):
        with unittest.mock.patch.dict(os.environ, DIR=str(folder)):
            web.write_page(str(self.top / "web.html"), "tear")

    def test_names_reach_no_compiler(self):
        for name in TABLE["name"].values():
            file = self.folder(f"of {name[0]}") / name
            file.write_text(STEP + TEST)
            for door in (lambda: workshop.choose(file, ""),
                         lambda: grade_tests.read(str(file), tasks.load())):
                if re.fullmatch(submission.PLAIN, name):
                    door()
                else:
                    self.refused("has an unusual name", door)
            (file.parent / "Graph.hpp").touch()
            self.assertEqual(set(submission.take(file.parent).files) - {name},
                             {"Graph.hpp"})

    def test_no_file_of_another_is_included(self):
        kit = once.Kit()
        way = units.way_of(  # type: ignore[attr-defined]
            "3.1.position", "graph")
        for number, (name, text) in enumerate(TABLE["include"].items()):
            text = text.replace("ROOT", str(once.ROOT)) + "\n"
            folder = self.folder(f"{number}")
            for file, more in (("Graph.hpp", ""), ("mass_spring.hpp", ""),
                               ("mine.hpp", STEP)):
                (folder / file).write_text(text + more)
            files = submission.take(folder).files
            with self.subTest(name, door="grade, class, grade-tests"):
                room = units.Room(  # type: ignore[attr-defined]
                    kit, self.folder(f"room{number}"), files)
                unit = room.compile(way, [], link=False)
                self.hold(unit.refused or unit.output)
            with self.subTest(name, door="try"):
                shop = workshop.Workshop(folder / "mine.hpp", "my_step", 4)
                self.addCleanup(shop.close)
                with self.assertRaises(submission.BadInput) as caught:
                    shop.compile()
                self.hold(str(caught.exception))
            if os.path.isdir("/usr/lib/llvm-22") or os.environ.get("WASM_CXX"):
                with self.subTest(name, door="web"):
                    with contextlib.redirect_stderr(io.StringIO()) as said:
                        try:
                            self.assertIsNone(web.compiled(files))
                        except submission.BadInput as error:
                            print(error, file=sys.stderr)
                    self.hold(said.getvalue())

    def hold(self, said):
        """It was refused, and told nothing of the file."""
        self.assertRegex(said, "it is not yours|No such file|file not found")
        self.assertNotIn("root:", said)

    def test_equal_files_are_named(self):
        def row(name, content, reason=""):
            return whole_class.Row(name, content, reason=reason)
        rows = [row("=a", "1"), row("b", "1"), row("c", "2"),
                row("d", "", "holds no Graph.hpp")]
        self.assertEqual(class_page.equal(rows), [["=a", "b"]])
        whole = types.SimpleNamespace(due=None, tag="", course=tasks.load())
        table = whole_class.table(whole, rows).splitlines()
        self.assertRegex(table[1], "^'=a,.*the same files as b$")
        self.assertNotIn("same files", table[3])
        self.assertIn("<li>=a, b</li>", class_page.page(
            whole.course, rows, None, False))

    def test_a_budget_ends_the_judge(self):
        one = types.SimpleNamespace(seconds=judge.BUDGET + 1,
                                    jobs=unittest.mock.MagicMock())
        unit = judge.Judge.compile(one, None, None, [], set())
        self.assertEqual(judge.refused(unit).status, "stopped")
        self.assertIn("5 minutes of processor", judge.refused(unit).text)


if __name__ == "__main__":
    unittest.main()
