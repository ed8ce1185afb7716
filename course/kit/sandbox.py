"""Run a program that is not trusted, and say how it ended.

The program runs in jail.cpp. Here its time, memory, threads and output are
watched; whatever it does, the whole group of processes is ended and reaped.
"""

import contextlib
import os
import pathlib
import re
import selectors
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import once

PAGE = 4096     # bytes of runner.cpp's page; a text on each half
KEPT = 65536    # bytes of output kept at each end
SPOKEN = 1 << 18    # bytes of a verdict and its answers
LOOK = 0.01     # seconds between two looks at the memory
READ_AT_ONCE = 1 << 17
MEGABYTE = 1 << 20
TICKS = os.sysconf("SC_CLK_TCK")        # a second
PAGE_OF_MEMORY = os.sysconf("SC_PAGE_SIZE")
Answers = dict[str, tuple[float, list[float]]]  # name: (tolerance, numbers)


@dataclass
class Limits:
    cpu: int = 4                   # seconds of processor time
    wall: float = 20               # seconds on the clock: sleeping counts
    memory: int = 1024 * MEGABYTE  # bytes resident
    output: int = 16 * MEGABYTE    # bytes; KEPT are kept
    threads: int = 64
    size: int = 0                  # bytes of a file


@dataclass
class Outcome:
    """How a program ended: `stopped` is "", or the limit that it met."""
    stopped: str = ""
    code: int = 0                  # of exit, or -signal
    output: str = ""               # what it wrote to stderr (and stdout)
    begun: bool = False            # main() has begun
    verdict: list[str] = field(default_factory=list)    # its fields
    answers: Answers = field(default_factory=dict)
    usual: Answers = field(default_factory=dict)    # to the usual numbers
    name: str = ""                 # the function of the test
    did: str = ""                  # what it did last
    aspect: int = 0                # the one that it looked at: model.hpp
    seconds: float = 0             # of processor time, of all its processes


class Output:
    """The first and the last bytes of what a program writes."""

    def __init__(self, most: int, kept: int = KEPT):
        self.first, self.last, self.total, self.most = b"", b"", 0, most
        self.kept = kept

    def add(self, data: bytes) -> bool:
        """Is it still no more than the limit?"""
        self.total += len(data)
        room = max(0, self.kept - len(self.first))
        self.first += data[:room]
        self.last = (self.last + data[room:])[-self.kept:]
        return self.total <= self.most

    def text(self) -> str:
        return (self.first + self.last).decode("utf-8", "replace")


def clean_environment(folder: str | pathlib.Path) -> dict[str, str]:
    """Nothing of the teacher's environment reaches a compiler or a program."""
    return {
        "PATH": "/usr/bin:/bin", "LC_ALL": "C", "HOME": str(folder),
        "TMPDIR": str(folder),
        # Leaks are no fault in this course. What else stands here, the jail
        # would deny, or differs from run to run.
        "ASAN_OPTIONS": "detect_leaks=0:handle_abort=1:disable_coredump=0:"
                        "color=never:max_allocation_size_mb=1024:"
                        "detect_stack_use_after_return=1",
        "UBSAN_OPTIONS": "print_stacktrace=1:color=never:halt_on_error=1",
    }


def words_of(pid: int) -> list[int]:
    """/proc/PID/stat from the process's state on, which is 0 here; or []."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            _, *words = file.read().rpartition(b")")[2].split()
        return [0, *map(int, words)]
    except (OSError, ValueError):
        return []


def watch(process: subprocess.Popen, limits: Limits,
          heard: dict[int, Callable[[bytes], bool]]) -> tuple[str, float]:
    """Drain the pipes until the program has ended or meets a limit.

    `heard` tells for each pipe what to do with its data; it returns False
    when that is too much. Returns the limit that was met, or "", and seconds of
    processor time.
    """
    selector = selectors.DefaultSelector()
    last = time.monotonic() + limits.wall
    stopped, ended = "", False
    try:
        for pipe in heard:
            os.set_blocking(pipe, False)
            selector.register(pipe, selectors.EVENT_READ)
        while not stopped:
            # Ended, and not reaped: its times can be read.
            ended = ended or os.waitid(os.P_PID, process.pid, os.WEXITED
                                       | os.WNOHANG | os.WNOWAIT) is not None
            ready = [key.fd for key, _ in selector.select(0 if ended else LOOK)]
            if ended and not ready:
                break           # drained; who else holds a pipe is ended below
            for pipe in ready:
                data = os.read(pipe, READ_AT_ONCE)
                if not data:
                    selector.unregister(pipe)
                elif not heard[pipe](data):
                    stopped = "output"
            words = words_of(process.pid)
            if words and words[21] * PAGE_OF_MEMORY > limits.memory:
                stopped = "memory"
            elif words and words[17] > limits.threads:
                stopped = "threads"
            elif time.monotonic() > last:
                stopped = "time"
    finally:
        selector.close()
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except OSError:
            pass
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        seconds = sum(words_of(process.pid)[11:15], 0) / TICKS
        process.wait()
    out_of_time = (-signal.SIGXCPU, -signal.SIGKILL)
    return (stopped or ("time" if process.returncode in out_of_time else ""),
            seconds)


def run_compiler(jail: list[str], command: list[str], folder: pathlib.Path,
                 scratch: pathlib.Path, limits: Limits) -> Outcome:
    """Run a compiler in a folder; both its outputs are one."""
    process = subprocess.Popen(
        [*jail, "--compiler", "--cpu", str(limits.cpu),
         "--size", str(limits.size), "--memory", str(limits.memory),
         "--", *command],
        cwd=folder, env=clean_environment(scratch), stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        start_new_session=True)
    output = Output(limits.output)
    assert process.stdout
    with process.stdout as pipe:
        stopped, seconds = watch(process, limits, {pipe.fileno(): output.add})
    return Outcome(stopped, process.returncode, output.text(), seconds=seconds)


def run_test(jail: list[str], program: pathlib.Path, task: str, limits: Limits,
             kit: once.Kit, data: pathlib.Path, crashing: int = 0,
             asks: bool = False) -> Outcome:
    """Run the test functions of a task in a process of its own, with the seed
    of a kit and the cloth in the folder `data`. One that `asks` gets no seed,
    but forces, of another process: law.cpp."""
    to_read, to_write = os.pipe()         # the seed, to the program
    from_read, from_write = os.pipe()     # how it ended
    page = os.memfd_create("page")
    os.ftruncate(page, PAGE)
    descriptors: tuple[int, ...] = (to_read, from_write, page)
    written, spoken = Output(limits.output), Output(SPOKEN, SPOKEN)

    def heard(data):
        if not spoken.total and data.startswith(b"begun\n"):
            try:
                os.write(to_write, bytes(32) if asks else kit.secret)
            except BrokenPipeError:
                pass
        return spoken.add(data)

    try:
        law = subprocess.Popen(
            [kit.law], bufsize=0, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE) if asks else None
        with law or contextlib.nullcontext():
            far: tuple[int, ...] = ()
            if law:
                assert law.stdin and law.stdout and law.stderr
                law.stdin.write(kit.secret)
                far = law.stdin.fileno(), law.stdout.fileno()
            process = subprocess.Popen(
                [*jail, "--cpu", str(limits.cpu), "--size", str(limits.size),
                 "--", str(program), task, *map(str, descriptors),
                 str(crashing), *map(str, far or (-1, -1))],
                cwd="/", env={**clean_environment("/nowhere"),
                              "KIT_DATA": str(data)},
                pass_fds=(*descriptors, *far),
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE, start_new_session=True)
            os.close(to_read)
            os.close(from_write)
            descriptors = (page,)
            if law and law.stdin and law.stdout:
                law.stdin.close()
                law.stdout.close()
            assert process.stderr
            with process.stderr as pipe:
                stopped, seconds = watch(process, limits, {
                    pipe.fileno(): written.add, from_read: heard})
            forces = law.stderr.read() if law and law.stderr else b""
        texts = os.pread(page, PAGE, 0)
    finally:
        for one in (*descriptors, to_write, from_read):
            os.close(one)
    begun, *lines = spoken.first.decode("utf-8", "replace").split("\n")
    said = [line.split("\t") for line in lines]
    # A failure counts, whatever else is said.
    verdict = sorted((words for words in said
                      if words[0] in ("failed", "passed")),
                     key=lambda words: words[0])
    name, did = (texts[at:at + PAGE // 2].partition(b"\0")[0]
                 .decode("ascii", "replace") for at in (0, PAGE // 2))
    name, _, aspect = name.partition(" ")
    answers = answers_of(said, "answer")
    if forces:
        answers["forces"] = 0, [float(forces)]
    return Outcome(stopped, process.returncode, written.text(),
                   begun == "begun", verdict[0] if verdict else [],
                   answers, answers_of(said, "usual"), name, did,
                   int(aspect) if re.fullmatch("[0-9]{1,4}", aspect) else 0,
                   seconds)


def answers_of(said: list[list[str]], kind: str) -> Answers:
    """{name: (tolerance, numbers)} of the lines of a program."""
    answers: Answers = {}
    for words in said:
        if words[0] == kind and len(words) == 4:
            try:
                answers[words[1]] = (float(words[2]),
                                     [float(x) for x in words[3].split(" ")])
            except ValueError:
                pass
    return answers
