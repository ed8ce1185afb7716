"""A child process of a test: it ends at a time limit, and with the test."""

import ctypes
import os
import shlex
import signal
import subprocess

LIBC = ctypes.CDLL(None)
PR_SET_PDEATHSIG = 1


def run(command, limit=120, check=False, capture_output=False, **options):
    """As subprocess.run(). After `limit` seconds all that it started is killed:
    TimeoutError."""
    text = options.pop("input", None)
    if text is not None:
        options["stdin"] = subprocess.PIPE
    if capture_output:
        options |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    command = [str(word) for word in command]
    with subprocess.Popen(
            command, start_new_session=True, preexec_fn=lambda:
            LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL), **options) as child:
        try:
            output, errors = child.communicate(text, limit)
        except subprocess.TimeoutExpired:
            raise TimeoutError(f"{shlex.join(command)}: ended after {limit} s, "
                               "the time limit of a test") from None
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
    done = subprocess.CompletedProcess(command, child.returncode, output,
                                       errors)
    if check:
        done.check_returncode()
    return done
