"""
What the scripts of a report's pages draw and say for every scene, body and pair of models, as lines of text.

    PYTHONPATH=. python tests/comparison/drawn_page.py FOLDER
"""

import sys
from pathlib import Path

from browsers import LAPTOP, chromium, opened
from places import HELPERS

SCRIPT = HELPERS / "drawn_page.js"


def drawn_lines(place: Path) -> list[str]:
    """The lines of both pages; they complain of nothing."""
    lines = []
    with chromium() as browser:
        for name in ("index.html", "verification.html"):
            visit = opened(browser, place / name, LAPTOP, first=SCRIPT.read_text(encoding="utf-8"))
            lines += [f"drawn {name}: {line}" for line in visit.page.evaluate("toldPage()")]
            assert visit.complaints == []
    return lines


if __name__ == "__main__":
    sys.stdout.write("\n".join(drawn_lines(Path(sys.argv[1]))) + "\n")
