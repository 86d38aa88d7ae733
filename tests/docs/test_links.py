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
    for path in re.findall(r"`((?:comparison|reference|tests|\.github)/[\w/.]+)`", page.read_text(encoding="utf-8")):
        assert page.parent != ROOT or (ROOT / path).exists(), path
