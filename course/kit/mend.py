"""Leave out the functions of a submission that do not compile.

An error inside the body of a function that is no template keeps the whole file
from being compiled. So the body is replaced by a line that ends the program
with the compiler's words: the function costs the tasks that call it.
"""

import bisect
import json
import re
from collections.abc import Iterator

import diagnosis
import names
import submission

LONGEST = 10000     # characters before a body
ROUNDS = 4      # errors may hide others
SAYS = "this function does not compile: "
SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum)\b"
                   r"|\bextern\s{0,100}\"C\"")
# What has no end goes to the end: each character is looked at once.
TEXT = re.compile(r"""(["'])(?:\\.|(?!\1)[^\\\n])*(?:\1|\\?\Z|(?=\\?\n))""")


def functions(text: str) -> Iterator[tuple[int, int]]:
    """(first place, the place behind the last) of each body of a function that
    is not in another one. `text` has no comments."""
    plain = TEXT.sub(lambda match: re.sub(r"[{};]", " ", match[0]), text)
    ends = names.bodies(plain)
    begin = 0       # of the present declaration
    inside = 0      # the end of a pair of braces in it
    for mark in re.finditer(r"[{};]", plain):
        at = mark.start()
        if at < max(begin, inside):
            continue
        head = plain[begin:at]
        behind_call = head[max(head.rfind("("), head.rfind(")")) + 1:]
        if (mark[0] == "{" and at in ends and len(head) < LONGEST
                and behind_call.lstrip()[:1] in (":", ",")
                and not head.rstrip().endswith("}")):
            inside = ends[at]   # a member of a constructor
            continue
        begin = mark.end()
        if mark[0] == "{" and at in ends and not SCOPE.search(behind_call):
            if len(behind_call) < len(head):
                yield at, ends[at]
            begin = ends[at]


def without_broken(files: dict[str, bytes],
                   errors: list[diagnosis.Error]) -> dict[str, bytes] | None:
    """The files without the functions in which errors are; None if no error is
    in any."""
    mended, found = dict(files), False
    for name in {error.file for error in errors} & files.keys():
        text = submission.without_comments(
            files[name].decode("utf-8", "replace"))
        ends_of_lines = [match.start() for match in re.finditer("\n", text)]
        mine = sorted((error.line, error.text) for error in errors
                      if error.file == name)
        for start, end in reversed(list(functions(text))):
            first, last = (1 + bisect.bisect_left(ends_of_lines, at)
                           for at in (start, end))
            at = bisect.bisect_left(mine, (first, ""))
            if at == len(mine) or mine[at][0] > last:
                continue
            body = text[start:end]
            if SAYS not in body:
                found = True
                line, words = mine[at]
                words = json.dumps(SAYS + words)
                body = (f'{{ ::__assert_fail({words}, "{name}", {line}, ""); '
                        + "\n" * body.count("\n") + "}")
                text = text[:start] + body + text[end:]
        mended[name] = text.encode()
    return mended if found else None


def said(text: str) -> str | None:
    """"FILE:LINE: the compiler's words" in the text of a crash, or None."""
    found = re.fullmatch(rf"assertion failed: {SAYS}(.*) at (\S+:\d+)", text)
    return f"{found[2]}: {found[1]}" if found else None
