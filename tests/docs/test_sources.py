#!/usr/bin/env python3
"""docs/sources.md: every figure and table of the five texts has a row, and the row an answer."""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/sources.md"

# Figures of each text; the thesis counts them by chapter. Its list of figures has 4.22 twice: the second is 4.23.
FIGURES = {
    "Wang 2014": [f"{chapter}.{figure}" for chapter, last in ((2, 16), (3, 34), (4, 23)) for figure in range(1, last + 1)] +
                 ["table 4.1"],
    "Wyman 2005": [*map(str, range(1, 9)), "table 1"],
    "Kay and Greenberg 1979": [*map(str, range(1, 13))],
    "Chen": [*map(str, range(1, 9)), "table 1", "table 2"],
    "Ihrke et al. 2007": [*map(str, range(1, 9))],
}


def expanded(cell):
    """The figures that a first cell names: `3.5 to 3.7, 4.1` has four."""
    figures = []
    for part in cell.split(","):
        ends = part.strip().split(" to ")
        if len(ends) == 1:
            figures.append(ends[0])
            continue
        *chapter, first = ends[0].split(".")
        last = ends[1].split(".")[-1]
        figures += [".".join([*chapter, str(figure)]) for figure in range(int(first), int(last) + 1)]
    return figures


def rows():
    """(section, cells) of every row that answers figures."""
    found = []
    for section in re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        head, _, table = section.partition("| figure | shows |")
        for line in re.split(r"\n(?!\|)", table)[0].splitlines()[2:]:
            found.append((head.split("\n")[0], [cell.strip() for cell in line.strip("|").split("|")]))
    return found


class Sources(unittest.TestCase):
    def test_every_figure_has_a_row(self):
        answered = {}
        for section, cells in rows():
            answered.setdefault(section, []).extend(expanded(cells[0]))
        self.assertEqual({section: sorted(figures) for section, figures in answered.items()},
                         {section: sorted(figures) for section, figures in FIGURES.items()})

    def test_every_row_has_its_answer(self):
        for section, (figure, _, answer, command, published, ours) in rows():
            with self.subTest(section=section, figure=figure):
                if answer.startswith("not repeated: "):
                    self.assertEqual((command, published, ours), ("", "", ""))
                else:
                    self.assertTrue(answer.startswith("repeated"), answer)
                    self.assertRegex(command, r"^`[^`]+`")
                    self.assertTrue(published and ours)

    def test_wrong_claims_name_what_was_measured(self):
        section = PAGE.read_text(encoding="utf-8").split("## Where a source is wrong")[1].split("\n## ")[0]
        claims = [line.strip("|").split("|") for line in section.splitlines() if line.startswith("| ")][1:]
        self.assertGreater(len(claims), 5)
        for claim in claims:
            self.assertEqual([len(claim), all(cell.strip() for cell in claim)], [4, True], claim)


if __name__ == "__main__":
    sys.exit(unittest.main())
