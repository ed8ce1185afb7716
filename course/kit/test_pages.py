"""Tests of pages.py: python3 course/kit/test_pages.py"""
import unittest

import pages
import tasks

COURSE = tasks.parse("""
[course]
title = "A course"
tag = "hw9"
[[section]]
id = "1"
title = "Before"
[[task]]
id = "1.free"
title = "free"
points = 0
needs = "graph"
says = "It is there."
hint = "Look."
[[section]]
id = "3.2"
title = "First"
page = "3.2.md"
[[section]]
id = "4"
title = "Second"
dropped = true
[[task]]
id = "3.2.one"
title = "one"
points = 1
needs = "graph"
says = "One is done."
hint = "Do it."
[[task]]
id = "3.2.two"
title = "two"
points = 4
needs = "graph"
says = "Two is done."
hint = "Do it."
[[task]]
id = "3.2.more"
title = "more"
points = 7
extra = true
needs = "graph"
says = "More is done."
hint = "Do it."
[[task]]
id = "4.none"
title = "none"
points = 8
needs = "graph"
says = "None is done."
hint = "Do it."
""", "test.toml")
EMPTY = "# 3.2\n<!-- tasks 3.2 -->\nold\n<!-- end -->\nend\n"
FULL = """# 3.2
<!-- tasks 3.2 -->
- **one**, 1 point: One is done.
- **two**, 4 points: Two is done.
- **more**, 7 extra: More is done.

Together 5 points. `make test SECTION=3.2` shows which tests pass. Commit your
work, then hand it in: `make submit HW=hw9`.
<!-- end -->
end
"""


class Filled(unittest.TestCase):
    def test_a_section_has_its_tasks_their_sum_and_no_extra_points(self):
        self.assertEqual(pages.filled(EMPTY, COURSE), FULL)

    def test_twice_equals_once(self):
        self.assertEqual(pages.filled(FULL, COURSE), FULL)

    def test_a_dropped_section_asks_for_nothing(self):
        self.assertEqual(
            pages.filled("<!-- tasks 4 -->\n<!-- end -->\n", COURSE),
            "<!-- tasks 4 -->\nNothing: this section is not part of the"
            " homework.\n<!-- end -->\n")

    def test_the_table_of_all_has_their_sum(self):
        table = pages.filled("<!-- tasks -->\n<!-- end -->\n", COURSE)
        self.assertIn("| 3.2 | two | 4 |\n", table)
        self.assertIn("| | together | 5 |\n", table)
        self.assertNotIn("none", table)
        self.assertNotIn("free", table)

    def test_all_else_stays(self):
        self.assertEqual(pages.filled("a\n<!-- b -->\nc\n", COURSE),
                         "a\n<!-- b -->\nc\n")


class Named(unittest.TestCase):
    def test_the_tag_is_what_stands_behind_HW(self):
        text = ("make submit HW=hw2 FORCE=1, `make submit HW=hw-2.b`\n"
                "HW     ?= hw2\noverride HW := $(value HW)\nHW=${HW:-}\n")
        self.assertEqual(
            pages.named("Makefile", text, COURSE),
            text.replace("hw2", "hw9").replace("hw-2.b", "hw9"))

    def test_the_title_is_the_first_line_of_the_starter(self):
        text = "# Homework 2\n\n# 2\n"
        self.assertEqual(pages.named(pages.STARTER, text, COURSE),
                         "# A course\n\n# 2\n")
        self.assertEqual(pages.named("README.md", text, COURSE), text)


class Level(unittest.TestCase):
    TEXT = "a\n<!-- guided -->\nb\n<!-- end guided -->\n<!-- open\nc\n-->\nd\n"

    def test_a_page_has_what_is_for_its_level(self):
        self.assertEqual(pages.of_level(self.TEXT, "guided"), "a\nb\nd\n")
        self.assertEqual(pages.of_level(self.TEXT, "open"), "a\nc\nd\n")

    def test_what_has_no_end_is_a_fault(self):
        for end in ("<!-- end guided -->\n", "-->\nd\n"):
            text = FULL + self.TEXT.replace(end, "")
            self.assertEqual(list(pages.faults("3.2.md", text, COURSE)),
                             ["1: <!-- guided --> or <!-- open has no end"])


class Faults(unittest.TestCase):
    def test_a_page_that_is_right_has_none(self):
        self.assertEqual(list(pages.faults("3.2.md", FULL, COURSE)), [])

    def test_old_points_are_named_by_their_line(self):
        old = FULL.replace("4 points:", "3 points:")
        self.assertEqual(
            list(pages.faults("3.2.md", old, COURSE)),
            ["4: differs from tasks.toml: course/kit/pages.py --write"])

    def test_a_long_page_and_one_without_a_place(self):
        self.assertEqual(
            list(pages.faults("3.2.md", "line\n" * 81, COURSE)),
            ["80: goes on to line 81, expected at most 80",
             "81: has no place for tasks 3.2"])


if __name__ == "__main__":
    unittest.main()
