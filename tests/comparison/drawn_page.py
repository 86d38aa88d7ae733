"""
What the scripts of a report's pages draw and say for every scene, body and pair of models, as lines of text.

    PYTHONPATH=. python tests/comparison/drawn_page.py FOLDER
"""

import sys
from pathlib import Path

from browsers import LAPTOP, chromium
from places import HELPERS

SCRIPT = HELPERS / "drawn_page.js"


def drawn_lines(place: Path) -> list[str]:
    """The lines of both pages; they complain of nothing."""
    lines = []
    with chromium() as browser:
        for name in ("index.html", "verification.html"):
            page = browser.new_page(viewport={"width": LAPTOP, "height": 900})
            complaints: list[str] = []
            page.on("pageerror", lambda error, complaints=complaints: complaints.append(str(error)))
            page.add_init_script(SCRIPT.read_text(encoding="utf-8"))
            page.goto((place / name).as_uri())
            page.wait_for_selector("html[data-ready]", state="attached")
            assert complaints == []
            lines += [f"drawn {name}: {line}" for line in page.evaluate("toldPage()")]
    return lines


if __name__ == "__main__":
    sys.stdout.write("\n".join(drawn_lines(Path(sys.argv[1]))) + "\n")
