"""Measure a step that you have written:

    make try FILE=mine.hpp [STEP=my_step]      lab/try/README.md

Writes try/report.html and says the same here. Exit status: 0 there is a report
(whatever it says of the step); 2 the file has no step that can be measured."""
import concurrent.futures
import os
import pathlib
import shutil
import sys
import time

import judge
import teacher
from workshop import PARTS, SECONDS, BadInput, Workshop, choose


def progress(text, end=False):
    if sys.stderr.isatty():
        print("\r\033[K" + ("" if end else text), end="", file=sys.stderr,
              flush=True)


def probe(shop, pool):
    """{part: its lines}; BadInput tells what went wrong in the first part
    that did not end."""
    progress("compiling ...")
    shop.compile()
    found, waiting = {}, {part: pool.submit(shop.run, part) for part in PARTS}
    for part, future in waiting.items():
        progress(f"measuring: {part} ({len(found) + 1} of {len(PARTS)}) ...")
        lines, outcome = future.result()
        if not any(name == "done" for name, _ in lines):
            # A later part has an excuse if it is only slow.
            if part in ("trace", "same", "order") or outcome.stopped != "time":
                raise BadInput(shop.why(part, outcome))
            shop.slow.append(part)
        found[part] = lines
    progress("", end=True)
    return found


def verdict_of(shop, found):
    where = f"{shop.path}:1: {shop.step}"
    verdict = judge.Verdict(shop.step)
    judge.trace(verdict, where, found["trace"], shop.arguments == 5)
    numbers = {part: judge.by_name(lines) for part, lines in found.items()}
    judge.keeps_state(where, numbers["same"])
    judge.identify(verdict, numbers["same"])
    for part in ("order", "physics", "limits", "contact"):
        if part in shop.slow:
            verdict.notes.append(f"{part} is not measured: it takes more than "
                                 f"{SECONDS.get(part, 8)} s")
        else:
            getattr(judge, part)(verdict, numbers[part])
    verdict.data["chart"] = numbers["chart"]
    teacher.conclude(verdict)
    return verdict


def main():
    path, wanted = os.environ.get("FILE", ""), os.environ.get("STEP", "")
    to = pathlib.Path(os.environ.get("TO") or "try")
    if not path:
        raise BadInput("make try: no file, expected FILE=mine.hpp")
    path = pathlib.Path(path)
    started = time.monotonic()
    step, arguments = choose(path, wanted)
    shop = Workshop(path, step, arguments)
    try:
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            try:
                found = probe(shop, pool)
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        verdict = verdict_of(shop, found)
    finally:
        progress("", end=True)
        shutil.rmtree(shop.folder, ignore_errors=True)
    print(teacher.words(verdict))
    del to
    print(f"({time.monotonic() - started:.0f} s)")


if __name__ == "__main__":
    try:
        main()
    except BadInput as error:
        print(error, file=sys.stderr)
        sys.exit(2)
