"""Grade a submission for Classroom 50: this file is autograder.py, beside the
autograder.zip of `make autograder`, in CLASSROOM/autograders/ASSIGNMENT of the
configuration repository. Its runner starts it in the student's checkout, and
reads result.json there (schema classroom50/result/v1).
"""

import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile
from typing import Any

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 1800


def run(*command: object, **more: Any) -> subprocess.CompletedProcess:
    return subprocess.run([str(word) for word in command], timeout=SECONDS,
                          check=True, **more)


def result(report: dict, feedback: str, committed: int) -> dict:
    """The result of a report: a task is a test. What students do not see is
    not in it, as they can read it."""
    get = os.environ.get
    tests = []
    for task in report["tasks"] if feedback != "none" else ():
        of = 0 if task["extra"] else task["of"]
        passed = task["status"] == "passed"
        tests.append({"test-name": f"{task['id']} {task['title']}",
                      "passed": passed, "score": of if passed else 0,
                      "max-score": of})
        if feedback == "all" and not passed:
            tests[-1]["output"] = f"{task['message']}\n{task['specification']}"
    return {
        "schema": "classroom50/result/v1", "classroom": get("CLASSROOM", ""),
        "assignment": get("ASSIGNMENT", ""),
        "assignment_type": get("ASSIGNMENT_TYPE") or "individual",
        "owner": get("OWNER") or get("USERNAME", ""),
        "submission": get("SUBMISSION_TAG", ""),
        "commit": get("COMMIT_URL", ""), "release": get("RELEASE_URL", ""),
        "review": get("REVIEW_URL") or get("COMMIT_URL", ""),
        "datetime": datetime.datetime.fromtimestamp(
            committed, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": sum(test["score"] for test in tests),
        "max-score": sum(test["max-score"] for test in tests), "tests": tests}


def read(file: pathlib.Path) -> dict:
    return json.loads(file.read_text("utf-8"))


def refusal(file: pathlib.Path) -> dict:
    """A report on what can't be graded: one task, which failed."""
    return {"tasks": [{"id": "0", "title": "the submission can be graded",
                       "of": 1, "extra": False, "status": "failed",
                       "message": read(file)["output"], "specification": ""}]}


def main() -> int:
    checkout = pathlib.Path.cwd()
    seconds = run("git", "show", "-s", "--no-show-signature", "--format=%ct",
                  "HEAD", capture_output=True, text=True).stdout
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        with zipfile.ZipFile(HERE / "autograder.zip") as archive:
            archive.extractall(folder / "source")
            for name in ("setup.sh", "tools/deps.sh"):
                (folder / "source" / name).chmod(0o755)
            run("bash", folder / "source/setup.sh", folder)
        report = folder / "report.json"
        refused = folder / "results.json"
        done = subprocess.run(
            [sys.executable, "course/kit/grade.py"], cwd=folder / "source",
            timeout=SECONDS, check=False, env=os.environ | {
                "DIR": str(checkout), "JSON": str(report), "HW": "",
                "RESULTS": str(refused), "FEEDBACK": "none"})
        if not refused.exists():        # no fault of the student's
            return done.returncode
        made = result(read(report) if report.exists() else refusal(refused),
                      (folder / "source/feedback").read_text().strip(),
                      int(seconds))
        new = checkout / "result.json"
        new.unlink(missing_ok=True)     # which the student may have made a link
        new.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
