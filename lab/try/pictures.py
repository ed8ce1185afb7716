"""The picture of the page course/8.md: the report on the assignment's step.

    python3 lab/try/pictures.py"""

import measure
import report
from panels import find_matplotlib
from workshop import ROOT


def main() -> None:
    find_matplotlib()
    verdict = measure.measure(ROOT / "mass_spring.hpp", "symp_euler_step",
                              (*measure.NEEDED, "chart"))
    report.among_methods(verdict, ROOT / "course/pictures/8.svg")
    print("course/pictures/8.svg drawn")


if __name__ == "__main__":
    main()
