"""Every link inside the documentation leads somewhere. Links to other sites are not opened: tests need no network."""

import re
from pathlib import Path

import pytest
from pages import PAGES, ROOT

LINK = re.compile(r"\]\((?!https?://|mailto:)([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]+`", flags=re.MULTILINE | re.DOTALL)


def anchors(page: Path) -> set[str]:
    """Names of the headings, as GitHub and the pages make them."""
    headings = re.findall(
        r"^#+ (.*)$", CODE.sub(lambda m: m[0] if m[0][:3] != "```" else "", page.read_text("utf-8")), re.M
    )
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_links_of_a_page_lead_to_files_and_headings(page: Path) -> None:
    text = CODE.sub("", page.read_text(encoding="utf-8"))
    for target in LINK.findall(text):
        file, _, heading = target.partition("#")
        place = (page.parent / file).resolve() if file else page
        assert place.exists(), target
        if heading:
            assert heading in anchors(place), target


def test_every_page_is_reached_from_the_first_one() -> None:
    """A page that no list of contents names would never be read."""
    tables = re.compile(r"```\{toctree\}\n(?P<options>(?::[^\n]*\n)*)\n?(?P<entries>.*?)```", flags=re.DOTALL)
    first = ROOT / "docs" / "index.md"
    reached, waiting = {first}, [first]
    while waiting:
        page = waiting.pop()
        for table in tables.finditer(page.read_text(encoding="utf-8")):
            for line in table["entries"].splitlines():
                entry = line.rpartition("<")[2].rstrip(">").strip()  # name, or title <name>
                for found in page.parent.glob(f"{entry}.md"):
                    if found not in reached:
                        reached.add(found)
                        waiting.append(found)
    lost = sorted(set((ROOT / "docs").rglob("*.md")) - reached)
    assert lost == [], "name it in a toctree, such as that of docs/evidence.md"
