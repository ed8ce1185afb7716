"""Tests of child.py: python3 course/kit/test_child.py"""

import unittest

import child


class Run(unittest.TestCase):
    def test_ends_all_at_the_limit(self):
        # The one that sleeps holds the pipe until it ends, too.
        with self.assertRaisesRegex(
                TimeoutError, "^sh -c 'sleep 1000 & wait': ended after 0.1 s, "
                "the time limit of a test$"):
            child.run(["sh", "-c", "sleep 1000 & wait"], 0.1,
                      capture_output=True)

    def test_is_subprocess_run(self):
        done = child.run(["sh", "-c", "cat; echo no >&2; exit 3"], text=True,
                         input="yes\n", capture_output=True)
        self.assertEqual((done.returncode, done.stdout, done.stderr),
                         (3, "yes\n", "no\n"))


if __name__ == "__main__":
    unittest.main()
