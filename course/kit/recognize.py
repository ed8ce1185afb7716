"""Name the mistake behind a test that failed, by its answers:  make mistakes

A test goes on after a check that failed, so a submission answers the same
questions whatever is wrong (runner.cpp). course/wrong/answers.json holds what
each entry of course/wrong answers where it loses a task; `make mistakes` writes
it anew. Equal answers name the mistake; answers that are the right ones times a
number, or without a component, say so; others say nothing.
"""

import functools
import hashlib
import json
import random
import re

import once
import sandbox

FILE = once.ROOT / "course/wrong/answers.json"
# Each kit draws their cloth anew (once.draw_cloth): no answers of other kits.
DRAWN = ("4.2.build_cloth", "7.2.program")
LEAST = 6       # numbers: fewer name no mistake
NEAR = 1e-9     # of the largest number
DECIMAL = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+|nan|inf")
# A factor that says what it comes from.
FACTORS = {9.8 / 9.81: "9.8 for 9.81", -1: "the sign is the other one",
           2: "counted twice", 0.5: "only half"}
KNOWN = "These are the answers of a known mistake: {}."
Numbers = dict[str, list[float]]
Said = list[str]    # a sentence and its parts, as Course.say() takes them


def numbers_of(answers: sandbox.Answers) -> Numbers:
    """Finite ones: another stands for each that is not."""
    return {name: [x if abs(x) < 1e300 else 1e6 for x in numbers]
            for name, (_, numbers) in sorted(answers.items())}


@functools.cache
def weights(name: str, count: int) -> list[float]:
    dice = random.Random(name)
    return [dice.uniform(-1, 1) for _ in range(count)]


def mark(said: tuple[str, ...], usual: Numbers) -> list:
    """What answers and the words of the first failure are known by: a digest of
    the words, how many numbers, their size, three weighted sums of them."""
    words = DECIMAL.sub("#", "|".join(said))
    return [hashlib.sha256(words.encode()).hexdigest()[:12],
            *of_numbers(usual)]


def of_numbers(usual: Numbers) -> list:
    sums = [sum(w * x for name, all_ in usual.items()
                for w, x in zip(weights(name + sign, len(all_)), all_))
            for sign in "abc"]
    size = sum(abs(x) for all_ in usual.values() for x in all_)
    return [sum(map(len, usual.values())),
            *(float(f"{x:.13g}") for x in (size, *sums))]


def same(a: list, b: list) -> bool:
    return a[:2] == b[:2] and all(
        abs(x - y) <= NEAR * max(1, b[2]) for x, y in zip(a[2:], b[2:]))


@functools.cache
def known() -> dict[str, dict[str, list]]:
    """{test: {mistake: mark}}"""
    return json.loads(FILE.read_text("ascii")) if FILE.exists() else {}


def recognized(test: str, mark: list, usual: Numbers, right: Numbers) -> Said:
    """What is said of these answers; [] if nothing is known."""
    names = [name for name, other in known().get(test, {}).items()
             if same(mark, other)]
    if len(names) == 1:
        return [KNOWN, names[0]]
    return compared(usual, right)


def tells(mark: list, right: Numbers) -> bool:
    """Are there answers, enough of them, and others than the right ones?"""
    return mark[1] >= LEAST and not same(mark, [mark[0], *of_numbers(right)])


def compared(usual: Numbers, right: Numbers) -> Said:
    """How the only answers that are wrong differ from the right ones."""
    def near(a: list[float], b: list[float]) -> bool:
        most = NEAR * max(1.0, max(b, default=0.0), -min(b, default=0.0))
        return len(a) == len(b) and all(
            abs(x - y) <= most for x, y in zip(a, b))

    wrong = [name for name in right if not near(usual.get(name, []),
                                                right[name])]
    if len(wrong) != 1 or usual.keys() != right.keys():
        return []
    name, = wrong
    got, expected = usual[name], right[name]
    shown = name.rstrip("?~")
    if len(got) != len(expected) or sum(x != 0 for x in expected) < 2:
        return []
    factor = (sum(x * y for x, y in zip(got, expected))     # least squares
              / sum(y * y for y in expected))
    if near(got, [factor * y for y in expected]):
        if abs(factor) < NEAR:
            return (["Each {} is 0: is 1 / N a division of whole numbers?",
                     shown] if name == "mass" else [])
        why = next((why for known, why in FACTORS.items()
                    if abs(factor / known - 1) < NEAR), "")
        return ["Each {} is {} times the right one{}.", shown,
                f"{factor:.6g}", why and f": {why}"]
    for at, axis in enumerate("xyz" if len(got) % 3 == 0 else ""):
        if not any(got[at::3]) and near(got, [
                0 if k % 3 == at else y for k, y in enumerate(expected)]):
            return ["The {} component of each {} is missing.", axis, shown]
    return []

