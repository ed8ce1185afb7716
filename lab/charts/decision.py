"""The chart to look at first: a scene and the error that is wanted say which
method, and what it costs. Counted work decides, so no noise does."""
from __future__ import annotations

import re
import textwrap
from collections import Counter
import pathlib
from typing import Any

from panels import DARK, GRAY, Picture, digits, styles
from results import TRUSTED, Run, Table, cheapest, runs, tied

KINDS = (("linear", ("chain", "curtain")),
         ("cloth in free motion", ("grid1-short", "grid1", "grid0")),
         ("stiff cloth", ("stiff", "mixed", "graded")),
         ("contact", ("drape", "slide", "tear")))
WANTED = [10.0 ** -k for k in range(2, 10)]  # [m]
ROUGH = 1e-3  # the smallest of the errors that a title calls rough [m]
LEFT, CELL, ROW = 156, 80, 62  # [pixels]
SHORT = {"symplectic-euler": "symp. euler",
         "mollified-impulse": "impulse",
         "implicit-euler": "impl. euler",
         "fast-mass-spring": "fast spring"}


def times(run: Run) -> str:
    """The least and the median time of a run, as 1.2-1.5 ms or 380-490 us."""
    scale, unit = (1e3, "ms") if run.median >= 1e-3 else (1e6, "us")
    low, high = (f"{float(f'{scale * t:.2g}'):g}"
                 for t in (run.seconds, run.median))
    return f"{low}{'-' + high if high != low else ''} {unit}"


def lighter(color: str, share: float = 0.7) -> str:
    """A color mixed with so much white."""
    parts = [int(color[k:k + 2], 16) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(c + (255 - c) * share):02x}" for c in parts)


def work(run: Run) -> float:
    return run.work


def decision(csv: pathlib.Path, out: pathlib.Path) -> None:
    """A row for a scene, a column for an error; neighbors with one answer
    share a cell."""
    table, look = Table(csv), styles()
    known = {row["scene"]: runs(table.where(scene=row["scene"]))
             for row in table.rows}
    answers = {scene: answers_of(some) for scene, some in known.items()}
    kinds = [(kind, [s for s in scenes if s in known])
             for kind, scenes in KINDS]
    kinds = [(kind, scenes) for kind, scenes in kinds if scenes]
    height = 152 + ROW * sum(len(s) for _, s in kinds) + 22 * len(kinds)
    picture = Picture(out, LEFT + CELL * len(WANTED) + 4, height,
                      message(answers), "", "")
    for line, words in enumerate((
            "A cell: the method that keeps this error with the least work, as "
            "do all of its finer runs; that work; and its time.",
            "=: another method within 10 % of that work. Work: force "
            "evaluations, and solves by their instructions.")):
        picture.text(20, height - 42 - 15 * line, words, 11)
    y = height - 92
    picture.text(LEFT - 10, y + 8, "wanted error [m]:", 12, DARK, "right")
    for k, wanted in enumerate(WANTED):
        picture.text(LEFT + CELL * (k + 0.5), y + 8, digits(wanted), 12, DARK,
                     "center")
    for kind, scenes in kinds:
        y -= 22
        picture.text(20, y + 7, kind, 11, DARK, bold=True)
        for scene in scenes:
            y -= ROW
            about = table.note("scene " + scene).split(";")[0]
            picture.text(20, y + ROW - 12, scene, 11, DARK)
            # A number stays with its unit.
            about = re.sub(r"(\d) (s|N/m)\b", "\\1\u00a0\\2", about)
            for line, words in enumerate(textwrap.wrap(about, 21)):
                picture.text(20, y + ROW - 26 - 13 * line, words, 11, GRAY)
            cells(picture, y, known[scene], answers[scene], look)
    for line, words in enumerate((
            "Error: RMS of the positions; with contact, of center of mass and "
            "energy as a height.",
            "Time: the least of seven runs, and the median. "
            + table.footer())):
        picture.text(20, 28 - 15 * line, words, 11)
    picture.finish()


def answers_of(some: list[Run]) -> list[Any]:
    """The run of least work for each wanted error; None below the
    reference's."""
    return [cheapest(wanted, some, work)
            if wanted >= TRUSTED * some[0].floor else None
            for wanted in WANTED]


def message(answers: dict[str, list[Any]]) -> str:
    """What to take, for three questions: the method that answers most."""
    words = []
    for what, contact, fits in (
            ("Rough, to 1 mm", False, lambda e: e > 0.99 * ROUGH),
            ("Finer", False, lambda e: e < 0.99 * ROUGH),
            ("With contact", True, lambda e: True)):
        chosen = [run.method for kind, scenes in KINDS
                  if (kind == "contact") == contact for scene in scenes
                  for wanted, run in zip(WANTED, answers.get(scene, []))
                  if run and fits(wanted)]
        if chosen:
            words.append(f"{what}: {Counter(chosen).most_common(1)[0][0]}.")
    return " ".join(words)


def cells(picture: Picture, y: float, some: list[Run],
          answers: list[Any], look: dict[str, tuple[str, str]]) -> None:
    """A row of the table."""
    ties = [tied(wanted, some, work) if run else None
            for wanted, run in zip(WANTED, answers)]
    first = 0
    while first < len(WANTED):
        end = first
        while end < len(WANTED) and (answers[end], ties[end]) == (
                answers[first], ties[first]):
            end += 1
        x0, x1 = LEFT + CELL * first, LEFT + CELL * end
        run, others, first = answers[first], ties[first], end
        if not run:
            picture.text((x0 + x1) / 2, y + ROW / 2,
                         "below the reference's error"
                         if x1 - x0 > 2 * CELL else "unknown", 11, GRAY,
                         "center")
            continue
        picture.box(x0 + 1, y + 2, x1 - 1, y + ROW - 2,
                    lighter(look[run.method][0]))
        lines = [SHORT.get(run.method, run.method), f"{run.work:,.0f}",
                 times(run)]
        if others:
            lines.insert(1, "=" + (SHORT.get(others[0], others[0])
                                    if len(others) == 1 or end - first > 1
                                    else f"{len(others)} others"))
        top = y + ROW / 2 + 6.5 * (len(lines) - 1)
        for line, words in enumerate(lines):
            picture.text((x0 + x1) / 2, top - 13.5 * line, words, 11,
                         "#111111", "center", bold=line == 0)
