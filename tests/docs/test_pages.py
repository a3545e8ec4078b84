#!/usr/bin/env python3
"""Pages of the project: their links lead somewhere, their tables render, and their files of data are there."""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", *sorted(ROOT.glob("docs/*.md")), *sorted(ROOT.glob("src/**/README.md")),
         *(ROOT / name / "README.md" for name in ("bench", "scenes"))]


def without_code(text):
    """Blocks of code become empty lines, so that the numbers of lines stay."""
    return re.sub(r"```.*?```", lambda block: "\n" * block.group().count("\n"), text, flags=re.DOTALL)


def anchors(page):
    """Of the headings, as GitHub makes them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", without_code(page.read_text(encoding="utf-8")), flags=re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", heading.lower())
        found.add(words.replace(" ", "-"))
    return found


class Pages(unittest.TestCase):
    def test_links_lead_somewhere(self):
        for page in PAGES:
            text = without_code(page.read_text(encoding="utf-8"))
            for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text)):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (page.parent / path).resolve() if path else page
                with self.subTest(page=page.relative_to(ROOT).as_posix(), link=target):
                    self.assertTrue(file.exists(), "leads nowhere")
                    if anchor and file.suffix == ".md":
                        self.assertIn(anchor, anchors(file), "there is no such heading")

    def test_rows_of_a_table_have_as_many_cells_as_its_head(self):
        for page in PAGES:
            columns = 0
            for number, line in enumerate(without_code(page.read_text(encoding="utf-8")).split("\n"), 1):
                if not line.startswith("|"):
                    columns = 0
                    continue
                cells = re.sub(r"\\\|", "", re.sub(r"`[^`]*`", "", line)).count("|") - 1
                columns = columns or cells
                with self.subTest(page=page.relative_to(ROOT).as_posix(), line=number):
                    self.assertEqual(cells, columns)

    def test_the_readme_fits_eighty_lines(self):
        self.assertLessEqual(len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()), 80)


if __name__ == "__main__":
    sys.exit(unittest.main())
