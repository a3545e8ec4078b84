#!/usr/bin/env python3
"""docs/trust.md: every promise names tests, and each of them exists."""
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
        if line.startswith("|") and len(cells) == 2 and cells[0] != "Promise" and not cells[0].startswith("-"):
            yield cells[0], re.findall(r"`([^`]+)`", cells[1])


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


if __name__ == "__main__":
    sys.exit(unittest.main())
