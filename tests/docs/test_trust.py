#!/usr/bin/env python3
"""docs/trust.md: every promise names tests, and each of them exists. No time is taken from a clock that may jump."""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "trust.md"


def rows():
    """(promise, names of tests) of every table."""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and cells[0] != "promise" and not cells[0].startswith("-"):
            yield cells[0], re.findall(r"`([^`]+)`", cells[-1])


def tests_of_library():
    text = "\n".join(file.read_text(encoding="utf-8") for file in ROOT.glob("tests/**/*.cpp"))
    return {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", text, re.MULTILINE)}


def tests_of_scripts():
    """`cli.Killed` and `cli.Killed.test_while_writing`, after the folder of the script."""
    found = set()
    for file in ROOT.glob("tests/*/test_*.py"):
        of_class = None
        for line in file.read_text(encoding="utf-8").splitlines():
            if match := re.match(r"class (\w+)", line):
                of_class = f"{file.parent.name}.{match[1]}"
                found.add(of_class)
            elif of_class and (match := re.match(r"    def (test_\w+)", line)):
                found.add(f"{of_class}.{match[1]}")
    return found


class Trust(unittest.TestCase):
    def test_named_tests_exist(self):
        known = tests_of_library() | tests_of_scripts()
        for promise, names in rows():
            for name in names:
                with self.subTest(promise=promise, test=name):
                    self.assertTrue(name in known, "there is no such test")

    def test_every_promise_has_a_test(self):
        promises = list(rows())
        self.assertGreater(len(promises), 20)
        for promise, names in promises:
            with self.subTest(promise=promise):
                self.assertTrue(names)


class Clocks(unittest.TestCase):
    def test_all_are_steady(self):
        jumping = re.compile(r"system_clock|high_resolution_clock|gettimeofday|CLOCK_REALTIME|std::time\(|utc_clock")
        files = [file for folder in ("src", "apps", "include", "python") for file in (ROOT / folder).glob("**/*")
                 if file.suffix in (".cpp", ".h")]
        self.assertGreater(len(files), 300)
        self.assertEqual([str(file) for file in files if jumping.search(file.read_text(encoding="utf-8"))], [])


if __name__ == "__main__":
    sys.exit(unittest.main())
