"""A child process of a test: it ends at a time limit, and with the test."""

import ctypes
import os
import shlex
import signal
import subprocess
from collections.abc import Iterable
from typing import Any

LIBC = ctypes.CDLL(None)
PR_SET_PDEATHSIG = 1


def run(command: Iterable[object], limit: float = 120, check: bool = False,
        capture_output: bool = False,
        **options: Any) -> subprocess.CompletedProcess:
    """As subprocess.run(). After `limit` seconds all that it started is killed:
    TimeoutError."""
    text = options.pop("input", None)
    if text is not None:
        options["stdin"] = subprocess.PIPE
    if capture_output:
        options |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    words = [str(word) for word in command]
    with subprocess.Popen(
            words, start_new_session=True, preexec_fn=lambda:
            LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL), **options) as child:
        try:
            output, errors = child.communicate(text, limit)
        except subprocess.TimeoutExpired:
            raise TimeoutError(f"{shlex.join(words)}: ended after {limit} s, "
                               "the time limit of a test") from None
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
    done: subprocess.CompletedProcess = subprocess.CompletedProcess(
        words, child.returncode, output, errors)
    if check:
        done.check_returncode()
    return done
