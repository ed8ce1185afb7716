"""Measure a step, a force, a constraint or a graph that you have written:

    make try FILE=mine.hpp [STEP=my_step]      lab/try/README.md
    make try GRAPH=Graph.hpp

Writes try/report.html and says the same here. Exit status: 0 there is a report
(whatever it says); 2 the file has nothing that can be measured."""
import os
import pathlib
import sys
import time

import functor
import graphs
import measure
import report
import teacher
from workshop import BadInput, progress, steps_in


def measured(path, wanted):
    """The Verdict on the step in a file or, if that is none, on the force or
    constraint."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
        steps = steps_in(text)
        if wanted not in steps if wanted else not steps:
            if chosen := functor.choose(path, wanted):
                return functor.measure(path, *chosen)
            if not steps and (names := functor.functors_in(text)):
                raise BadInput(f"{path}:1: has no {wanted}; it has "
                               + ", ".join(names))
    except OSError:
        pass        # measure() says why
    return measure.measure(path, wanted, say=progress)


def main():
    graph = os.environ.get("GRAPH", "")
    path, wanted = os.environ.get("FILE") or graph, os.environ.get("STEP", "")
    if not path:
        raise BadInput("make try: no file, expected FILE=mine.hpp or "
                       "GRAPH=Graph.hpp")
    started = time.monotonic()
    try:
        verdict = (graphs.measure(pathlib.Path(path), progress)
                   if path == graph else measured(pathlib.Path(path), wanted))
        progress("drawing ...")
        out = report.write(verdict, pathlib.Path(os.environ.get("TO") or "try"),
                           path)
        if os.environ.get("WINDOW") or os.environ.get("RECORD"):
            if "raw" not in verdict.data:
                raise BadInput(f"{path}: {verdict.step} is no step: WINDOW= "
                               "and RECORD= show steps alone")
            progress("building the window ...")
            import window
            progress("")
            return window.show(verdict, pathlib.Path(path),
                               os.environ.get("RECORD", ""))
    finally:
        progress("")
    print(teacher.words(verdict))
    print(f"{out}: the same with pictures ({time.monotonic() - started:.0f} s)")


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BadInput as error:
        print(error, file=sys.stderr)
        sys.exit(2)
