"""Tests of the grader: what it takes of a submission, and what it denies."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

import child
import once
import submission
import units

PROBE = r"""
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#define TRY(call) \
  do {                                                          \
    errno = 0;                                                  \
    const long result = long(call);                             \
    std::fprintf(stderr, "%s %ld %d\n", #call, result, errno);  \
  } while (false)
static void* nothing(void*) { return nullptr; }
int main(int, char** arg) {
  const char* file = arg[1];
  char one[] = "/bin/true", *command[] = {one, nullptr};
  rlimit more{1 << 20, 1 << 20};
  iovec piece{one, 1};
  pthread_t thread;
  TRY(open(file, O_WRONLY));
  TRY(open(file, O_RDWR));
  TRY(open("/tmp/kit-new", O_CREAT | O_RDONLY, 0666));
  TRY(open("/tmp", O_TMPFILE | O_RDWR, 0600));
  TRY(open(file, O_RDONLY | O_TRUNC));
  TRY(truncate(file, 0));
  TRY(unlink(file));
  TRY(rename(file, "/tmp/kit-new"));
  TRY(mkdir("/tmp/kit-new", 0777));
  TRY(symlink(file, "/tmp/kit-new"));
  TRY(link(file, "/tmp/kit-new"));
  TRY(chmod(file, 0777));
  TRY(socket(AF_INET, SOCK_STREAM, 0));
  TRY(socket(AF_UNIX, SOCK_DGRAM, 0));
  TRY(fork());
  TRY(vfork());
  TRY(execve(one, command, nullptr));
  TRY(syscall(SYS_execveat, AT_FDCWD, one, command, nullptr, 0));
  TRY(kill(getppid(), 0));
  TRY(kill(-1, 0));
  TRY(kill(0, 0));
  TRY(ptrace(PTRACE_TRACEME, 0, 0, 0));
  TRY(process_vm_readv(getppid(), &piece, 1, &piece, 1, 0));
  TRY(setrlimit(RLIMIT_FSIZE, &more));
  TRY(setsid());
  TRY(mount("none", "/mnt", "tmpfs", 0, nullptr));
  TRY(syscall(SYS_memfd_create, "x", 0));
  TRY(syscall(SYS_io_uring_setup, 1, nullptr));
  TRY(syscall(SYS_bpf, 0, nullptr, 0));
  TRY(setuid(0));
  std::fprintf(stderr, "--\n");
  TRY(pthread_create(&thread, nullptr, nothing, nullptr));
  TRY(kill(getpid(), 0));
  TRY(open("/dev/null", O_RDONLY) < 0);
  TRY(open("/proc/self/maps", O_RDONLY) < 0);
  std::fprintf(stderr, "--\n");
  TRY(open(file, O_RDONLY));
  TRY(open("/etc/passwd", O_RDONLY));
}
"""


class Folder(unittest.TestCase):
    """With a folder for a submission, which has a hostile name."""

    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="kit-test-"))
        self.addCleanup(shutil.rmtree, self.top)
        self.folder = self.top / "a 'b' \"c\" $(touch x); `touch y` \n%s \u00e9"
        self.folder.mkdir()

    def put(self, name, text=""):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def refused(self, words, tag=""):
        with self.assertRaises(submission.BadInput) as caught:
            submission.take(str(self.folder), tag)
        self.assertIn(words, str(caught.exception))
        self.assertTrue(str(caught.exception).isprintable())


class Take(Folder):
    def test_takes_sources_of_the_folder_and_nothing_else(self):
        for name in ("Graph.hpp", "mass_spring.cpp", "more/own.h", "notes.txt",
                     "CME212/Point.hpp", "tests/check.hpp", "Makefile",
                     "CS207/Util.hpp", "Point.hpp"):
            self.put(name, name)
        taken = submission.take(str(self.folder))
        self.assertEqual(taken.files, {
            "Graph.hpp": b"Graph.hpp", "mass_spring.cpp": b"mass_spring.cpp",
            "more/own.h": b"more/own.h"})
        self.assertEqual(taken.notes, [])

    def test_finds_the_folder_of_the_homework(self):
        self.put("hw1/Graph.hpp", "1")
        self.refused_several()
        self.put("hw2/Graph.hpp", "2")
        taken = submission.take(str(self.folder))
        self.assertEqual(taken.files, {"Graph.hpp": b"2"})
        self.assertEqual(taken.notes, ["the graded folder is hw2/"])

    def refused_several(self):
        taken = submission.take(str(self.folder))
        self.assertEqual(taken.files, {"Graph.hpp": b"1"})
        self.put("other/Graph.hpp", "3")
        self.refused("in several folders; name one of them: hw1/, other/")

    def git(self, *words, **options):
        return child.run(["git", "-C", self.folder, "-c", "user.name=a", "-c",
                          "user.email=b", *words], check=True, text=True,
                         capture_output=True, **options).stdout.strip()

    def commit(self):
        """All that is in the folder, tagged."""
        self.git("init", "-q"), self.git("add", ".")
        self.git("commit", "-qm", "x"), self.git("tag", "hw2")

    def test_a_tree_that_holds_itself_many_times_is_refused(self):
        self.git("init", "-q")
        blob = self.git("hash-object", "-w", "--stdin", input="")
        tree = self.git("mktree", input=f"100644 blob {blob}\tGraph.hpp\n")
        for _ in range(9):
            tree = self.git("mktree", input="".join(
                f"040000 tree {tree}\t{name}\n" for name in "abcdefghij"))
        commit = self.git("commit-tree", tree, "-m", "x")
        self.git("tag", "hw2", commit)
        self.refused("holds too many files", "hw2")

    def test_a_blob_that_is_missing_is_left_out(self):
        self.put("Graph.hpp", "1"), self.put("more.hpp", "2")
        self.commit()
        for name in ("more.hpp", "Graph.hpp"):
            blob = self.git("rev-parse", f"hw2:{name}")
            (self.folder / ".git/objects" / blob[:2] / blob[2:]).unlink()
            if name == "more.hpp":
                taken = submission.take(str(self.folder), "hw2")
                self.assertEqual(taken.files, {"Graph.hpp": b"1"})
                self.assertEqual(taken.notes,
                                 ["more.hpp is not in the clone: left out"])
        self.refused("Graph.hpp is not in the clone", "hw2")

    def test_many_folders_are_refused(self):
        for number in range(submission.MOST_ENTRIES + 1):
            (self.folder / str(number)).mkdir()
        self.refused("holds too many files")


LONG = [
    "x" * 500000, "struct a{" * 30000, "/*" * 200000, '"\\' * 200000,
    'R"a(' * 100000, "typedef Graph <" + " " * 400000, "#/*" * 100000,
    "typedef Graph <" * 30000, "GravityForce:" * 30000, "\\\n" * 200000,
    "class " * 150000 + "(", "void f() {}\n" * 80000, '"{' * 300000,
    "f() : a{}" + ", a{}" * 150000]


class Read(unittest.TestCase):
    """No text takes long: the program ends far before its limit."""

    def test_all_that_reads_sources(self):
        child.run([sys.executable, "-c", """
import json, sys
import mend, names, submission, units
for text in json.load(sys.stdin):
    files = {"mass_spring.hpp": text.encode()}
    submission.suspects("a.hpp", files["mass_spring.hpp"])
    list(mend.functions(text))
    names.defines(files)
    units.macros(files, units.words_of(units.TESTS))
"""], 100, cwd=once.KIT, input=json.dumps(LONG), text=True, check=True)

    def test_comments_end_and_strings_stay(self):
        self.assertEqual(submission.without_comments(
            'a /* b\n */ c // d \\\n e\nR"x( /* )x" "//" \'"\' /* f'),
            'a  \n c  \n\nR"x( /* )x" "//" \'"\'  ')

    def test_macros_for_words_of_the_tests_end(self):
        self.assertEqual(units.macros({
            "a.hpp": b"#define check_near(...)\n#  define N_OF_MINE 5\n",
            "b.hpp": b"#/**/define \\\nstatic_cast x\n%:define hold(a)"},
            units.words_of(units.TESTS)),
            ["check_near", "hold", "static_cast"])

    def test_a_compiler_blames_a_source_or_fails_by_itself(self):
        disk = "No space left on device"
        for said in (
                f"Graph.hpp:3:2: error: #error {disk}",
                "Graph.hpp:1:10: fatal error: a.hpp: No such file",
                "mine.hpp:9:1: internal compiler error: Segmentation fault",
                "ld: unit1.s:(.text+0x5): undefined reference to `f()'",
                "wasm-ld: error: a.o: undefined symbol: f()",
                "cc1plus: out of memory allocating 65536 bytes"):
            self.assertTrue(units.blames_source(said), said)
        for said in (
                "", "g++: fatal error: Killed signal terminated cc1plus",
                f"unit3.s: Fatal error: can't write 41 bytes: '{disk}'",
                f"unit1.cpp:2:1: fatal error: error writing to a.s: {disk}",
                "ld: final link failed: Input/output error\n"
                "collect2: error: ld returned 1 exit status"):
            self.assertFalse(units.blames_source(said), said)


class Deny(Folder):
    def test_a_program_in_the_jail(self):
        kit = once.Kit()
        file = self.put("file", "text")
        program = self.top / "probe"
        child.run([once.CXX, "-w", "-x", "c++", "-", "-o", program],
                  input=PROBE, text=True, check=True)
        # A network that could be reached.
        with socket.socket() as listening:
            listening.listen()
            done = child.run(
                [*kit.jail, *units.flags("--read", [
                    "/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/proc/self",
                    "/dev/null", program]), "--", program, file],
                stderr=subprocess.PIPE, text=True)
        denied, allowed, hidden = (part.strip().split("\n") for part
                                   in done.stderr.split("--\n"))
        self.assertEqual((len(denied), len(allowed)), (30, 4))
        for line in denied:
            self.assertRegex(line, r" -1 (1|13|38)$")
        for line in allowed:
            self.assertRegex(line, r" 0 0$")
        self.assertEqual(file.read_text(), "text")
        self.assertFalse(os.path.lexists("/tmp/kit-new"))
        if "landlock" in kit.has():
            for line in hidden:
                self.assertRegex(line, r" -1 13$")
        else:
            print("skipped: the kernel has no Landlock")

    def test_without_a_jail_there_is_no_grading(self):
        kit = once.Kit()
        kit.jail = ["/bin/sh", "-c", "echo jail: no seccomp >&2; exit 125"]
        with self.assertRaisesRegex(once.KitError, "no seccomp\n.*SAFE=0"):
            kit.probe()

    def test_bad_input_ends_with_status_2(self):
        def run(**variables):
            done = child.run(
                [sys.executable, once.KIT / "grade.py"], text=True,
                env={"PATH": os.environ["PATH"], **variables},
                capture_output=True)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            return done.stderr
        self.assertIn("DIR is missing", run())
        results = str(self.top / "results.json")
        self.assertIn("no Graph.hpp", run(DIR=str(self.folder),
                                          RESULTS=results))
        self.assertEqual(json.loads(pathlib.Path(results).read_text())["score"],
                         0)
        self.assertIn("can't be written (No such file", run(
            DIR=str(self.folder), JSON=str(self.top / "none/x.json")))
        for jobs in ("x", "0", "-1", "1e3", "9999999999"):
            self.assertEqual(
                run(DIR=str(self.folder), JOBS=jobs), f"grade: JOBS is '{jobs}'"
                ", expected a number from 1 to 1000\n")
        # A folder that nobody can write to, root neither.
        self.put("Graph.hpp")
        self.assertRegex(run(DIR=str(self.folder), JSON="/proc/x.json"),
                         "^grade: /proc/x.json: its folder can't be written "
                         "[^\n]*\n$")

    def test_make_runs_no_name(self):
        done = child.run(
            ["make", "-s", "-C", once.ROOT, "grade", f"DIR={self.folder}"],
            capture_output=True, text=True)
        self.assertIn("holds no Graph.hpp", done.stderr)
        for name in "xy":
            self.assertFalse((once.ROOT / name).exists())


if __name__ == "__main__":
    unittest.main()
