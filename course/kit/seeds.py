"""Grade right submissions with many seeds:  python3 course/kit/seeds.py [N]

The solution and the other right ones of the kit pass all tests with the seeds
1 to N, 100 if N is not given. Each is compiled once. A fault names the seed.
"""

import copy
import pathlib
import secrets
import shutil
import sys
import tempfile
from collections.abc import Iterable

import build
import grade
import judge
import kit_check
import once
import report

JOBS = 2
Kits = dict[int | str, once.Kit]     # by seed


class OfSeeds(judge.Judge):
    """Runs each test with all seeds: {seed: a kit with answers or None}."""

    def __init__(self, kits: Kits, folder: pathlib.Path,
                 files: dict[str, bytes]):
        super().__init__(next(iter(kits.values())), folder, files, JOBS)
        self.kits = kits
        self.results: dict[int | str, judge.Results] = {
            seed: {} for seed in kits}

    def run_one(self, unit: build.Unit, names: set[str], test: str,
                kit: once.Kit, data: pathlib.Path) -> judge.Result:
        for seed, kit in self.kits.items():
            self.results[seed][test] = super().run_one(unit, names, test, kit,
                                                       kit.data)
        return min((self.results[seed][test] for seed in self.kits),
                   key=lambda result: judge.RANK.index(result.status))


def kits_of(kit: once.Kit, seeds: Iterable[int], folder: pathlib.Path) -> Kits:
    """A kit for each seed, with a cloth of its own."""
    kits: Kits = {}
    for seed in seeds:
        kits[seed] = one = copy.copy(kit)
        one.seed, one.answers = str(seed), None
        one.secret, one.data = secrets.token_bytes(32), folder / f"data{seed}"
        judge.draw_cloth(one.data, one)
    return kits


def grade_with(kits: Kits, files: dict[str, str],
               tests: dict[str, str]) -> dict[int | str, judge.Results]:
    """{seed: {test: Result}}; a test that does not compile has none."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-seeds-"))
    try:
        folder.chmod(0o755)
        of_seeds = OfSeeds(kits, folder, {
            name: text.encode() for name, text in files.items()})
        of_seeds.run(tests)
        return of_seeds.results
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main() -> bool:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    cases, kit = kit_check.Cases(), once.Kit()
    tests, failed = grade.tests_of(cases.course), 0
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kit-seeds-"))
    try:
        folder.chmod(0o755)
        kits = kits_of(kit, range(1, count + 1), folder)
        for name in kit_check.BASES:
            results = grade_with(kits, cases.base(name), tests)
            faults = [f"  SEED={seed}, {test}: " + (
                "not compiled" if test not in found else
                f"{found[test].did}: {report.outcome(found[test])}")
                for seed, found in results.items() for test in sorted(tests)
                if test not in found or not found[test].passed]
            print(f"{name}: {count} seeds, {len(tests)} tests, {len(faults)} "
                  "failed", *faults, sep="\n", flush=True)
            failed += len(faults)
            if name == "solution":      # what the others are asked for
                for seed, one in kits.items():
                    one.answers = {test: result.answers for test, result
                                   in results[seed].items()}
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return failed != 0


if __name__ == "__main__":
    sys.exit(main())
