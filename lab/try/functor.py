"""Measure a force or a constraint: build functor.cpp with it, run it, judge the
numbers."""

import re

import constraints
import forces
import judge
from workshop import BadInput, Workshop, arguments, without_comments

ADVICE = ("It does what it says; add it by make_combined_force, and look at "
          "the energy of a run.",
          "It does what it says; if two constraints disagree, the last one in "
          "make_combined_constraints wins.")


# ---- Its name

def functors_in(text):
    """Names of classes with a call of two arguments."""
    text, found = without_comments(text), []
    for match in re.finditer(r"\b(?:struct|class)\s+(\w+)[^;{}()]*\{", text):
        depth, end = 1, match.end()
        while end < len(text) and depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        call = re.search(r"operator\s*\(\s*\)\s*(\()", text[match.end():end])
        words = call and arguments(text, match.end() + call.start(1))
        if words and len(words[0]) == 2 and "double" in words[0][1]:
            found.append(match[1])
    return found


FUNCTION = re.compile(r"\b(?:Point|void|auto)\s+(\w+)\s*(?:=\s*\[[^]]*\]\s*)?"
                      r"(\()")
NUMBERS = re.compile(r"(?:const )?(?:Point|double|float|int|unsigned|std)\b")


def functions_in(text):
    """Names of functions and lambdas that are called as a force or constraint,
    outside of classes."""
    text, found = without_comments(text), []
    for match in FUNCTION.finditer(text):
        before = text[:match.start()]
        words = arguments(text, match.start(2))
        if (words and len(words[0]) == 2 and "double" in words[0][1]
                and not NUMBERS.match(words[0][0])
                and before.count("{") == before.count("}")):
            found.append(match[1])
    return found


def type_of(path, name):
    """A class, or that of a function object which calls the function."""
    text = path.read_text(encoding="utf-8", errors="replace")
    if name not in functions_in(text):
        return name
    return (f"decltype([](auto&& x, double t) -> decltype({name}(x, t)) "
            f"{{ return {name}(x, t); }})")


def choose(path, wanted):
    """(name, how it is made or "") of a force or constraint in a file; None if
    there is none of that name."""
    text = path.read_text(encoding="utf-8", errors="replace")
    found = functors_in(text)
    functions = functions_in(text)
    if wanted in functions if wanted else not found:
        found = functions
    made = re.fullmatch(r"(\w+)\s*([({].*[)}])?", wanted)
    if wanted:
        return ((made[1], wanted if made[2] else "")
                if made and made[1] in found else None)
    if len(found) > 1:
        raise BadInput(f"{path}:1: has {len(found)} forces and constraints: "
                       "choose one by STEP=" + " or STEP=".join(found))
    return (found[0], "") if found else None


# ---- What it is

def measure(path, name, made=""):
    """The Verdict on a force or a constraint in a file, or BadInput."""
    shop = Workshop(path, name, 0, source="functor.cpp", defines=[
        f"-DTRY_NAME={type_of(path, name)}",
        *([f"-DTRY_MADE={made}"] if made else [])])
    try:
        shop.compile()
        lines, outcome = shop.run("functor")
        numbers = judge.by_name(lines)
        if "done" not in numbers:
            raise BadInput(shop.why("functor", outcome))
        v = judge.Verdict(made or name)
        is_force = numbers["kind"][0][0] == 1
        (forces if is_force else constraints).read(v, shop.where, numbers)
        v.advice = v.faults[0][1] if v.faults else (
            ADVICE[0] if is_force else ADVICE[1])
        return v
    finally:
        shop.close()
