"""Rank a class by the step of page 8: who has the smaller error for as many
forces. Errors are distances from the solution's answers, in runs of nets that
no submission knows before (course/asked/8.my_step.cpp)."""

import math

TASK = "8.my_step"
COLUMNS = tuple(f"{TASK} {what}" for what in ("rank", "error", "forces"))


def measured(answers: dict, expected: dict) -> tuple[float, int]:
    """The error of a step that passed, as a share of that of symplectic Euler,
    to three digits; and how many forces it asked for on each node. Both are
    read from {name: (tolerance, numbers)}; a tolerance is half of symplectic
    Euler's error."""
    error = max(abs(a - b) / (2 * tolerance)
                for name, (tolerance, numbers) in expected.items()
                for a, b in zip(answers[name][1], numbers))
    forces = answers.get("forces", (0, [0.0]))[1][0]
    return float(f"{error:.3g}"), round(forces) if math.isfinite(forces) else 0


def ranks(steps: dict) -> dict:
    """{student: (rank, error, forces)} of {student: measured()}, in their
    order. Equal errors share a rank."""
    errors = sorted(error for error, _ in steps.values())
    found = {student: (1 + errors.index(error), error, forces)
             for student, (error, forces) in steps.items()}
    return dict(sorted(found.items(), key=lambda one: (one[1][0], one[0])))
