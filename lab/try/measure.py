"""Measure a step: build the probe, run its parts, judge the numbers."""

import concurrent.futures

import judge
import orders
import teacher
from workshop import PARTS, SECONDS, BadInput, Workshop, choose

NEEDED = ("trace", "same", "order")     # without these there is no report


def silent(_):
    pass


def probe(shop, parts, say):
    """{part: its lines}; BadInput tells what went wrong in the first part
    that did not end."""
    say("compiling ...")
    shop.compile()
    found = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        waiting = {part: pool.submit(shop.run, part) for part in parts}
        try:
            for part, future in waiting.items():
                say(f"measuring: {part} ({len(found) + 1} of {len(parts)}) ...")
                lines, outcome = future.result()
                if not any(name == "done" for name, _ in lines):
                    # A later part may be slow: then the others count.
                    if part in NEEDED or outcome.stopped != "time":
                        raise BadInput(shop.why(part, outcome))
                    shop.slow.append(part)
                found[part] = lines
                if part == "trace":     # the others follow from it
                    judge.events(shop.where, lines)
                elif part == "same":
                    judge.keeps_state(shop.where, judge.by_name(lines))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return found


def verdict_of(shop, found):
    verdict = judge.Verdict(shop.step)
    judge.trace(verdict, shop.where, found["trace"], shop.arguments == 5)
    numbers = {part: judge.by_name(lines) for part, lines in found.items()}
    judge.identify(verdict, numbers["same"])
    for part in ("order", "physics", "limits", "contact", "chart"):
        if part in shop.slow:
            verdict.notes.append(f"{part} is not measured: it takes more than "
                                 f"{SECONDS.get(part, 8)} s")
        elif part in numbers:
            getattr(judge, part)(verdict, numbers[part])
    verdict.faults += verdict.later
    teacher.conclude(verdict)
    return verdict


def dots(path, step, counts):
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


def measure(path, wanted="", parts=PARTS, say=silent):
    """The Verdict on a step in a file, or BadInput."""
    shop = Workshop(path, *choose(path, wanted))
    try:
        return verdict_of(shop, probe(shop, parts, say))
    finally:
        shop.close()
