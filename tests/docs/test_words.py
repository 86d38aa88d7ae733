"""Texts for readers use the words of the field."""

import ast
import re
from pathlib import Path

import pytest
from pages import PACKAGES, PAGES, ROOT

# what a text says, and what the field says in its place
WORDS = {
    r"taken up|takes? up": "included",
    r"held against": "compared with",
    r"entered (by the user|engine|model)": "user-supplied",
    r"\bthinned\b": "decimated",
    r"\bhills?\b": "local maximum",
    r"\bclimbs?\b(?!, reached : int)|climbing": "local search",
    r"\blanes?\b": "worker group",
    r"(?<!\.)\btiles?\b(?!/)": "batch",
    r"\brungs?\b": "level",
    r"own axes": "principal axes, or separate color scales",
    r"half of itself|no geometry": "the error, or the cause, in words",
    r"for (doubt|luck)": "the reason",
    r"instant of stopping": "peak at the stop",
    r"smoothed near rest": "regularized friction",
    r"\b(unanswered|silent) models?\b": "model without results",
    r"slowness|allotment|yardstick|\berrands?\b": "the quantity, by its name",
}
TEMPLATES = sorted((ROOT / "comparison").rglob("*.html.j2"))
SETTLED = {"decisions", "CHANGELOG.md"}  # decisions and changes are told as they were made
MODULES = [module for package in PACKAGES for module in sorted((ROOT / package).rglob("*.py"))]
TEXTS = [page for page in (*PAGES, *TEMPLATES) if not SETTLED & set(page.parts)]


@pytest.mark.parametrize("page", TEXTS, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_text_for_readers_has_the_words_of_the_field(page: Path) -> None:
    assert of_the_dialect(page.read_text(encoding="utf-8")) == {}


def test_messages_and_docstrings_have_the_words_of_the_field() -> None:
    found = {}
    for module in MODULES:
        nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
        texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        if words := of_the_dialect("\n".join(text for text in texts if " " in text)):
            found[str(module.relative_to(ROOT))] = words
    assert found == {}


def of_the_dialect(text: str) -> dict[str, str]:
    """The words that do not belong into a text, code in it left out, and what the field says."""
    text = re.sub(r"\{[{%#].*?[}%#]\}|<code>.*?</code>|`[^`]*`", "", text, flags=re.DOTALL)
    return {match[0]: better for word, better in WORDS.items() for match in re.finditer(word, text)}
