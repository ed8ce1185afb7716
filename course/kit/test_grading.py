"""Tests of whole gradings: the same bytes twice, and as Gradescope does it.

A minute of processor time: they compile.
"""

import hashlib
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest
import unittest.mock
import zipfile

import autograder
import child
import judge
import markers
import once

# A graph that crashes in some ways whose texts hold addresses or lines.
BUILDS = 600  # seconds: the kit is compiled
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


class Grading(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        self.addCleanup(shutil.rmtree, self.top)
        text = markers.solution((once.ROOT / "Graph.hpp").read_text("utf-8"))
        for old, new in FAULTS:
            self.assertEqual(text.count(old), 1)
            text = text.replace(old, new)
        self.submission = self.top / "submission"
        self.submission.mkdir()
        (self.submission / "Graph.hpp").write_text(text, encoding="utf-8")

    def grade(self, folder, where):
        """The text and the three files."""
        files = [self.top / name for name in ("json", "junit", "results")]
        done = child.run(
            [sys.executable, once.KIT / "grade.py"], BUILDS, cwd=where,
            capture_output=True, text=True,
            env={"PATH": os.environ["PATH"], "DIR": str(folder),
                 **{file.name.upper(): str(file) for file in files}})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [done.stdout, *(file.read_text("utf-8") for file in files)]

    def test_same_bytes_here_and_in_the_autograder(self):
        first = self.grade(self.submission, "/")
        second = self.grade("submission", self.top)
        self.assertEqual(first, second)
        self.hold(first)
        self.assertEqual(first[3], self.at_gradescope())

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
            done = child.run(command, BUILDS, capture_output=True, text=True,
                             umask=0o077)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        hidden = root / "source/course/tests/3.1.position.cpp"
        self.assertEqual(hidden.stat().st_mode & 0o077, 0)
        return (root / "results/results.json").read_text("utf-8")


if __name__ == "__main__":
    unittest.main()
