"""Generated parts of the pages in docs."""
import sys


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def write_between(page, begin, end, generated):
    """Replaces what stands between two markers of a page, and keeps the rest."""
    text = page.read_text(encoding="utf-8")
    if text.count(begin) != 1 or text.count(end) != 1:
        sys.exit(f"{page}: the markers of the generated part are missing")
    before, rest = text.split(begin)
    page.write_text(before + begin + "\n" + generated + "\n" + end + rest.split(end)[1], encoding="utf-8")
