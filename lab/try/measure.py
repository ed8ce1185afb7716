"""Measure a step: build the probe, run its parts, judge the numbers."""

import concurrent.futures
import pathlib
from collections.abc import Callable, Sequence

import judge
import orders
import teacher
from workshop import (PARTS, SECONDS, BadInput, Lines, Workshop, choose,
                      submission)

NEEDED = ("trace", "same", "order")     # without these there is no report


def silent(_: str) -> None:
    pass


def probe(shop: Workshop, parts: Sequence[str],
          say: Callable[[str], None]) -> dict[str, Lines]:
    """{part: its lines}; BadInput tells what went wrong in the first part
    that did not end."""
    say("compiling ...")
    shop.compile()
    found: dict[str, Lines] = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        waiting = {part: pool.submit(shop.run, part) for part in parts}
        try:
            for part, future in waiting.items():
                say(f"measuring: {part} ({len(found) + 1} of {len(parts)}) ...")
                lines, outcome = future.result()
                if not any(name == "done" for name, _ in lines):
                    # The report leaves out a later part that is too slow.
                    if part in NEEDED or outcome.stopped != "time":
                        raise BadInput(shop.why(part, outcome))
                    shop.slow.append(part)
                found[part] = lines
                if part == "trace":     # the other parts depend on it
                    judge.events(shop.where, lines)
                elif part == "same":
                    judge.keeps_state(shop.where, judge.by_name(lines),
                                      shop.random())
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return found


def verdict_of(shop: Workshop, found: dict[str, Lines]) -> judge.Verdict:
    verdict = judge.Verdict(shop.step)
    judge.trace(verdict, shop.where, found["trace"], shop.arguments == 5)
    numbers = {part: judge.by_name(lines) for part, lines in found.items()}
    agree: judge.Numbers = {}
    if verdict.table:
        row = verdict.data["raw"].row()
        lines, outcome = shop.run("agree", "fast", *row)
        agree = judge.by_name(lines)
        if "done" not in agree and outcome.stopped != "time":
            raise BadInput(shop.why("agree", outcome, *row))
    judge.identify(verdict, numbers["same"], agree)
    for part in ("order", "physics", "limits", "contact", "chart"):
        if part in shop.slow:
            verdict.notes.append(f"{part} is not measured: it takes more than "
                                 f"{SECONDS.get(part, 8)} s")
        elif part in numbers:
            getattr(judge, part)(verdict, numbers[part])
    verdict.notes += submission.to_look_at(shop.taken.flags)
    verdict.faults += verdict.later
    teacher.conclude(verdict)
    return verdict


def dots(path: pathlib.Path, step: str,
         counts: list[int]) -> dict[int, dict[str, float]]:
    """{number of steps: {scene: the error [m]}} of a step in the charts."""
    shop = Workshop(path, *choose(path, step))
    try:
        shop.compile()
        found = {}
        for steps in counts:
            lines, outcome = shop.run("chart", "fast", steps)
            if not any(name == "done" for name, _ in lines):
                raise BadInput(shop.why("chart", outcome))
            numbers = judge.by_name(lines)
            found[steps] = {
                scene: orders.rms(numbers[f"chart.{scene}"][0][2:], solution)
                for scene, solution in judge.CHARTED.items()}
        return found
    finally:
        shop.close()


def measure(path: pathlib.Path, wanted: str = "", parts: Sequence[str] = PARTS,
            say: Callable[[str], None] = silent) -> judge.Verdict:
    """The Verdict on a step in a file, or BadInput."""
    shop = Workshop(path, *choose(path, wanted))
    try:
        return verdict_of(shop, probe(shop, parts, say))
    finally:
        shop.close()
