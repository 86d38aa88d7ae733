"""Texts of a scene in figures."""

from __future__ import annotations


def verbatim(text: str) -> str:
    """A text of a scene for matplotlib, which would read dollars as the marks of a formula."""
    return text.replace("$", r"\$")
