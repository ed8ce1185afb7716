"""Hold the numbers of the text to the CSV files that they come from:

    python3 lab/charts/figures.py [--write]

figures.txt has the rules: a page, and below it pieces of its text in which
{expression:format} stands for a number. An expression uses the functions
below. Each number that is another one is reported as FILE:LINE, or written.
Exit status: 0 all are right, or were written; 1 some are not."""
from __future__ import annotations

import argparse
import re
import statistics
import sys
from typing import Any, Callable

import decision
import panels
import peers
from results import (ROOT, Run, Table, by_method, cheapest, cost_at, ns_a_node,
                     runs, tied)

sys.path.append(str(ROOT / "lab/advice"))
import suite

NUMBER = r"(?<![\d.])-?\d+(?:,\d{3})*(?:\.\d+)?(?:e-?\d+)?"
tables: dict[str, Table] = {}


def table(path: str) -> Table:
    """A table, read once; @a path from lab/."""
    if path not in tables:
        tables[path] = Table("lab/" + path)
    return tables[path]


# ---- What an expression may use

def methods() -> int:
    """How many methods there are."""
    return len(panels.styles())


def of(scene: str, method: str | None = None) -> list[Run]:
    """Runs of work_precision.csv; of peers.csv if scene is 'peers NAME'."""
    rows = (table("bench/results/peers.csv").where(problem=scene.split()[1])
            if scene.startswith("peers ") else
            table("charts/results/work_precision.csv").where(scene=scene))
    return [r for r in runs(rows) if method in (None, r.method)]


def at(scene: str, method: str, share: float = 1) -> Any:
    """The run whose step is nearest to a share of the largest stable one."""
    return min((r for r in of(scene, method) if r.ok and 0 < r.share < 1.01),
               key=lambda r: abs(r.share / share - 1))


def ratio(scene: str, worse: str, better: str, share: float = 1) -> float:
    """How many times as large one's error is, at their shares of the step."""
    return at(scene, worse, share).error / at(scene, better, share).error


def best(scene: str, error: float, method: str | None = None,
         cost: str = "seconds") -> Any:
    """The cheapest run that keeps an error."""
    return cheapest(error, of(scene, method), lambda r: getattr(r, cost))


def cells_of(method: str | None = None, shared: bool = False) -> int:
    """How many cells of the decision chart a method wins; or, being named
    second, shares; of all cells if no method is given."""
    count = 0
    for scenes in dict(decision.KINDS).values():
        for scene in scenes:
            some = of(scene)
            for wanted, run in zip(decision.WANTED,
                                   decision.answers_of(some)):
                count += bool(run) and (
                    method in tied(wanted, some, decision.work) if shared
                    else method in (None, run.method))
    return count


def coarsest(scene: str, method: str) -> Any:
    """The cheapest run that reached the end."""
    return next(r for r in by_method(of(scene))[method] if r.ok)


def floor(scene: str) -> float:
    return of(scene)[0].floor


def limits(pick: Callable[..., float], scale: str) -> float:
    """The largest or least measured limit over another one."""
    return pick(float(row["measured"]) / float(row[scale]) for row in
                table("charts/results/stability_limits.csv").rows
                if row["measured"])


def call(method: str) -> float:
    """The median time of a force evaluation of peers.csv, all told [us]."""
    return statistics.median(1e6 * r.seconds / r.evaluations
                             for r in of("peers grid1", method))


def cost_of(problem: str, error: float, method: str) -> float | None:
    """Force evaluations at an error, as the chart of peers has them."""
    return cost_at(error, of(f"peers {problem}", method),
                   lambda r: r.evaluations)


def lead(cost: str) -> float:
    """By how much a library costs less than ours at most [%]."""
    return 100 * max(peers.advantage(of(f"peers {problem}"),
                                     lambda r: getattr(r, cost))[0]
                     for problem in ("grid1", "curtain"))


def bench(nodes: str, name: str, beside: str) -> float:
    """The median of a figure of bench.json over another one's."""
    of = ns_a_node(ROOT / "lab/bench/results/amd-epyc-26-avx512/bench.json")
    return of[int(nodes), name][1] / of[int(nodes), beside][1]


def advice(which: str) -> float:
    """A figure of the suite of questions: lab/advice/suite.py."""
    return suite.rates(table("advice/results/adviser.csv").rows)[which]


def refined(what: str, column: str, k: int = -1) -> float:
    """A row of grid_refinement.csv."""
    return float(table("charts/results/grid_refinement.csv").where(
        refined=what)[k][column])


# ---- Text

def shown(value: float, form: str) -> str:
    """A number as the text has it: 1e-6, not 1e-06."""
    return re.sub(r"e(-?)\+?0*(\d)", r"e\1\2", format(value, form))


def compiled(piece: str, where: str) -> tuple[re.Pattern[str], list[str]]:
    """(regular expression, what its groups should be) of a rule."""
    parts, wanted = [], []
    for text in re.split(r"(?<!\^)(\{[^{}]*\})", piece):
        if text.startswith("{") and ":" in text:
            expression, _, form = text[1:-1].rpartition(":")
            try:
                wanted.append(shown(eval(expression, globals()), form))
            except Exception as error:
                raise SystemExit(f"{where}: {expression}: {error!r}, expected "
                                 "a number") from error
            parts.append(f"({NUMBER})")
        else:
            parts += [re.escape(word) if word.strip() else r"\s+"
                      for word in re.split(r"(\s+)", text) if word]
    return re.compile("".join(parts)), wanted


def corrected(page: str, text: str, rules: list[tuple[int, str]],
              faults: list[str]) -> str:
    """The text with the numbers of its rules; faults get those that differ."""
    for line, piece in rules:
        where = f"lab/charts/figures.txt:{line}"
        pattern, wanted = compiled(piece, where)
        found = pattern.search(text)
        if not found:
            faults.append(f"{where}: {page} does not have this text")
            continue
        for group in range(len(wanted), 0, -1):
            is_there, should = found[group], wanted[group - 1]
            if is_there == should:
                continue
            at_line = text.count("\n", 0, found.start(group)) + 1
            faults.append(f"{page}:{at_line}: {is_there}, expected {should}")
            text = text[:found.start(group)] + should + text[found.end(group):]
    return text


def main() -> bool:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    write = parser.parse_args().write
    pages: dict[str, list[tuple[int, str]]] = {}
    page: Any = None
    lines = (ROOT / "lab/charts/figures.txt").read_text().splitlines()
    for number, line in enumerate(lines, 1):
        if line.startswith("#") or not line.strip():
            continue
        if not line.startswith(" "):
            page = pages.setdefault(line.strip(), [])
        elif line.startswith("    ") and page:  # goes on
            page[-1] = page[-1][0], page[-1][1] + " " + line.strip()
        else:
            page.append((number, line.strip()))
    faults: list[str] = []
    for page, rules in pages.items():
        text = (ROOT / page).read_text()
        right = corrected(page, text, rules, faults)
        if write and right != text:
            (ROOT / page).write_text(right)
    print("\n".join(faults) or
          f"{sum(len(rules) for rules in pages.values())} passages are right")
    return bool([f for f in faults
                 if not write or f.startswith("lab/charts/figures.txt")])


if __name__ == "__main__":
    sys.exit(main())
