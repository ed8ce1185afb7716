"""Measure a step that you have written:

    make try FILE=mine.hpp [STEP=my_step]      lab/try/README.md

Writes try/report.html and says the same here. Exit status: 0 there is a report
(whatever it says); 2 the file has no step that can be measured; 130 Ctrl-C."""
import os
import pathlib
import sys
import time

import measure
import report
import teacher
from panels import find_matplotlib
from results import ChartError
from workshop import BadInput, progress  # it knows the way to course/kit

from once import KitError


def main() -> int:
    path, wanted = os.environ.get("FILE", ""), os.environ.get("STEP", "")
    if not path:
        raise BadInput("make try: no file, expected FILE=mine.hpp")
    find_matplotlib()
    started = time.monotonic()
    try:
        verdict = measure.measure(pathlib.Path(path), wanted, say=progress)
        progress("drawing ...")
        out = report.write(verdict, pathlib.Path(os.environ.get("TO") or "try"),
                           path)
    finally:
        progress("")
    print(teacher.words(verdict))
    print(f"{out}: the same with pictures ({time.monotonic() - started:.0f} s)")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (BadInput, ChartError, KitError) as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("make try: interrupted; no report was written", file=sys.stderr)
        sys.exit(130)
