"""Texts for readers use the words of the field."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import PAGES, ROOT

# what a text says, and what the field says in its place
WORDS = {
    r"taken up|takes? up": "included",
    r"held against": "compared with",
    r"entered (by the user|engine|model)": "user-supplied",
    r"\bthinned\b": "decimated",
    r"\bhills?\b": "local maximum",
    r"\bclimbs?\b|climbing": "local search",
    r"\blanes?\b": "worker group",
    r"\btiles?\b(?!/)": "batch",
    r"\brungs?\b": "level",
    r"own axes": "principal axes, or separate color scales",
    r"half of itself|no geometry": "the error, or the cause, in words",
    r"for (doubt|luck)": "the reason",
}
TEMPLATES = sorted((ROOT / "comparison").rglob("*.html.j2"))
SETTLED = {"decisions", "CHANGELOG.md"}  # decisions and changes are told as they were made
TEXTS = [page for page in (*PAGES, *TEMPLATES) if not SETTLED & set(page.parts)]


@pytest.mark.parametrize("page", TEXTS, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_text_for_readers_has_the_words_of_the_field(page: Path) -> None:
    text = re.sub(r"\{[{%#].*?[}%#]\}|<code>.*?</code>|`[^`]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    found = {match[0]: better for word, better in WORDS.items() for match in re.finditer(word, text)}
    assert found == {}
