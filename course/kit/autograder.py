"""Make the zip that Gradescope takes:
  make autograder [OUT=FILE.zip] [FEEDBACK=all|names|none]

It holds setup.sh, run_autograder and what the grader needs. The same files
give the same bytes.
"""

import os
import pathlib
import sys
import zipfile

import grade
import submission
from tasks import ROOT

GLOBS = ["LICENSE", "*.hpp", "mass_spring.cpp", "CME212/**/*.hpp",
         "tools/deps.sh", "course/tasks.toml", "course/words/*.toml",
         "course/kit/*.py", "course/kit/*.cpp", "course/tests/**/*",
         "course/asked/*", "course/mine.hpp", "course/wrong/*.json",
         "course/years/**/*"]
LEFT_OUT = {"kit_check.py", "mistakes.py", "grade_tests.py", "starter.py",
            "autograder.py", "synthetic.py", "constants.py"}    # and tests
AT_THE_TOP = ["course/autograder/setup.sh", "course/autograder/run_autograder"]


def content() -> dict[str, pathlib.Path]:
    """{name in the zip: path}"""
    files = {path.rpartition("/")[2]: ROOT / path for path in AT_THE_TOP}
    for glob in GLOBS:
        for path in ROOT.glob(glob):
            if path.is_file() and path.name not in LEFT_OUT and (
                    not path.name.startswith("test_")):
                files[path.relative_to(ROOT).as_posix()] = path
    return files


def write(out: str | pathlib.Path, feedback: str = "all") -> None:
    out = pathlib.Path(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    beside = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(zipfile.ZipInfo("feedback", (1980, 1, 1, 0, 0, 0)),
                             feedback + "\n")
            for name, path in sorted(content().items()):
                info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
                info.compress_type = zipfile.ZIP_DEFLATED
                info.create_system = 3      # modes are those of Unix
                program = path.stat().st_mode & 0o100
                info.external_attr = (0o100755 if program else 0o100644) << 16
                archive.writestr(info, path.read_bytes())
        beside.replace(out)
    finally:
        beside.unlink(missing_ok=True)


def main() -> None:
    out = os.environ.get("OUT") or "build/autograder.zip"
    try:
        write(out, grade.feedback())
    except submission.BadInput as error:
        sys.exit(f"autograder: {error}")
    except OSError as error:
        sys.exit(f"autograder: {error.filename}: {error.strerror}")
    print(f"autograder: {len(content())} files in {out}")


if __name__ == "__main__":
    main()
